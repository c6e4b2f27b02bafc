/* Reads the lines of a PBF file of OpenStreetMap into a set of features.
 *
 * Input: a path. Output: the lines of GDAL's layer "lines" with the rules in gdal/osmconf.ini. They have the same
 * attributes and the same order as in GDAL, and their coordinates are equal to the last bit. The file is read in two
 * passes, and hardly any blob is read twice: first the ways, which are at its end, then the places of the nodes that
 * the ways name. So a node takes little more than eight bytes, whatever else the file contains. A third pass packs the
 * ways with these places and frees the nodes; a fourth makes world coordinates. Each pass uses several threads.
 *
 * If areas are wanted, the relations that name ways are read before the ways, and the sea is made from the ways of the
 * coast (coast.h). If points are wanted, the nodes are read once more to find those with tags, which are GDAL's layer
 * "points". If the kinds of entities are not in the usual order, reading starts again. Each pass then searches the
 * whole file for entities of its kind, which takes more time but no more memory. */
#include "osm/osm.h"

#include "base/threads.h"
#include "features/mercator.h"
#include "features/osm_keys.h"
#include "features/rings.h"
#include "features/world_lines.h"
#include "osm/beyond.h"
#include "osm/coast.h"
#include "osm/nodes.h"
#include "osm/packed.h"

#include <math.h>

static const double WAYS_SHARE = 0.3, NODES_SHARE = 0.75, PACKED_SHARE = 0.85; /* progress after each pass */
/* The names of the layers in OGR. */
static const char LAYER[] = "lines", RELATION_LAYER[] = "multipolygons", POINT_LAYER[] = "points";

typedef struct reader {
    camber_context *context;
    camber_features *features;
    const camber_source_desc *desc;
    camber_osm_where where;
    camber_osm_ways ways;
    camber_osm_coast coast; /* the ways of the coast, if the sea is wanted */
    size_t coast_key;       /* the index of the property "natural" in the style; SIZE_MAX: the sea is not wanted */
    const char *coastline;  /* the interned value of a coast */
    camber_value *values;   /* schema->property_count: a set of tags */
    uint32_t layer;
    unsigned kinds;                           /* CAMBER_KIND_*: the kinds that are read */
    uint32_t *classes[CAMBER_GEOMETRY_KINDS]; /* by kind, for each set of tags: its class + 1; 0: not needed yet */
    size_t met; /* how many of the relations' ways were added so far, in the order in which they were met */
    size_t skipped, clamped, splits;
    size_t nodes, missing; /* how many nodes ways name, and how many of these the file does not have */
    unsigned threads;
} reader;

static bool reads(const camber_source_desc *desc) {
    camber_osm_where where;
    return (!desc->where || camber_osm_where_parse(desc->where, &where)) &&
           (!desc->layer || strcmp(desc->layer, LAYER) == 0);
}

/* ---- Ways become lines, on any thread ---- */

typedef struct made_way {
    uint32_t tags;       /* the bits of the way, but the bit for areas is set only if the line is closed */
    uint32_t line_count; /* how many lines or outlines the way has; its ring comes after them */
    bool has_ring, is_coast;
    uint32_t place_count; /* for a coast or a way of a relation: how many places in the run it has */
    size_t first_place;
} made_way;

typedef struct made_run {
    camber_osm_block points, ends, ways; /* pairs of doubles, size_t, made_way */
    camber_osm_block places, world;      /* for the run's nodes: uint64_t, and pairs of doubles */
    size_t way_count;
    camber_world_lines lines;
    camber_features_stats stats; /* counts for the run's rings */
} made_run;

static void free_run(camber_context *context, void *slot) {
    made_run *run = slot;
    camber_free(context, run->world.bytes);
    camber_free(context, run->places.bytes);
    camber_free(context, run->ways.bytes);
    camber_free(context, run->ends.bytes);
    camber_free(context, run->points.bytes);
}

/* Unpacks the places of a run, and projects them in batches that stay in the cache. */
static void project_run(const camber_osm_ways *ways, const camber_osm_run *from, made_run *run) {
    enum { MOST = 256 };
    double longitudes[MOST], latitudes[MOST], *world = (double *)(void *)run->world.bytes;
    uint64_t *places = (uint64_t *)(void *)run->places.bytes;
    camber_osm_unpack_run(ways, from, places);
    for (size_t first = 0; first < from->node_count; first += MOST) {
        const size_t left = from->node_count - first, count = left < MOST ? left : MOST;
        for (size_t i = 0; i < count; i++) {
            longitudes[i] = camber_osm_longitude(places[first + i]) / 1.0e7;
            latitudes[i] = camber_osm_latitude(places[first + i]) / 1.0e7;
        }
        camber_world_points(longitudes, latitudes, count, world + 2 * first);
    }
}

/* Adds the nodes of a way. first: the index of its first node in the run. */
static void add_nodes(const camber_osm_way *way, size_t first, made_run *run) {
    const double *world = (const double *)(const void *)run->world.bytes;
    const uint64_t *places = (const uint64_t *)(const void *)run->places.bytes;
    camber_world_lines_add_points(&run->lines, world + 2 * first, way->node_count);
    for (size_t i = first; i < first + way->node_count; i++)
        run->lines.clamped_points += fabs((double)camber_osm_latitude(places[i])) > CAMBER_MERCATOR_LATITUDE * 1.0e7;
}

/* Makes a ring from a closed way. counts: clamped points are counted, because they were not counted for an outline. */
static bool make_ring(const camber_osm_way *way, size_t node, made_run *run, bool counts) {
    camber_world_lines *lines = &run->lines;
    camber_rings rings = {.stats = &run->stats};
    const size_t first = lines->point_count, clamped = lines->clamped_points;
    bool crosses = false;
    lines->uncut = true;
    add_nodes(way, node, run);
    lines->uncut = false;
    size_t count = camber_ring_unroll(lines->points + 2 * first, lines->point_count - first, &crosses);
    count = camber_rings_take(&rings, lines->points + 2 * first, count, false);
    lines->clamped_points = counts ? lines->clamped_points : clamped;
    lines->antimeridian_splits += crosses;
    lines->point_count = first + count;
    lines->open = count > 0;
    camber_world_lines_end(lines);
    return count > 0;
}

static bool is_coast(const reader *self, const camber_osm_way *way) {
    const size_t set = way->tags / CAMBER_OSM_WAY_BITS;
    if (self->coast_key == SIZE_MAX || way->tags & CAMBER_OSM_WAY_BARE)
        return false;
    return self->ways.values[set * self->features->schema->property_count + self->coast_key] == self->coastline;
}

/* Makes the lines of a packed way, and its ring if it is an area. node: the index of its first node in the run. */
static void make_way(const reader *self, const camber_osm_way *way, size_t node, made_run *run) {
    camber_world_lines *lines = &run->lines;
    const size_t lines_before = lines->line_count;
    const bool area = way->tags & CAMBER_OSM_WAY_AREA, bare = way->tags & CAMBER_OSM_WAY_BARE;
    const bool has_lines = !bare && (!area || self->kinds & CAMBER_KIND_POLYGON);
    made_way made = {.tags = way->tags, .first_place = node, .is_coast = is_coast(self, way)};
    if (has_lines) {
        add_nodes(way, node, run);
        camber_world_lines_end(lines);
    }
    made.line_count = (uint32_t)(lines->line_count - lines_before);
    made.has_ring = area && self->kinds & CAMBER_KINDS_OF_AREAS && make_ring(way, node, run, !has_lines);
    if (made.is_coast || way->tags & CAMBER_OSM_WAY_MEMBER)
        made.place_count = way->node_count;
    ((made_way *)(void *)run->ways.bytes)[run->way_count++] = made;
}

static bool make_run(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    const reader *self = user;
    const camber_osm_ways *ways = &self->ways;
    const camber_osm_run *from = &ways->runs[part];
    made_run *run = slot;
    size_t points = camber_world_lines_most_points(from->node_count),
           ends = camber_world_lines_most_ends(from->node_count);
    if (self->kinds & CAMBER_KINDS_OF_AREAS) { /* a ring adds its points, and at most four more */
        points += from->node_count + 4 * from->way_count;
        ends += from->way_count;
    }
    if (!camber_osm_reserve(pass, &run->points, points * 2 * sizeof(double), failure) ||
        !camber_osm_reserve(pass, &run->ends, ends * sizeof(size_t), failure) ||
        !camber_osm_reserve(pass, &run->ways, from->way_count * sizeof(made_way), failure) ||
        !camber_osm_reserve(pass, &run->places, (from->node_count + 1) * sizeof(uint64_t), failure) ||
        !camber_osm_reserve(pass, &run->world, (from->node_count + 1) * 2 * sizeof(double), failure))
        return false;
    run->way_count = 0;
    run->stats = (camber_features_stats){0};
    run->lines =
        (camber_world_lines){.points = (double *)(void *)run->points.bytes, .ends = (size_t *)(void *)run->ends.bytes};
    project_run(ways, from, run);
    size_t node = 0;
    for (const camber_osm_way *way = ways->ways + from->first_way, *end = way + from->way_count; way < end; way++) {
        if (way->node_count || way->tags & CAMBER_OSM_WAY_MEMBER)
            make_way(self, way, node, run);
        node += way->node_count;
    }
    return true;
}

/* ---- Lines become features ---- */

static camber_status find_class(reader *self, uint32_t set, camber_geometry_kind kind, uint32_t *index) {
    uint32_t *known = &self->classes[kind][set];
    if (*known == 0) {
        const size_t count = self->features->schema->property_count;
        const char *const *tags = self->ways.values + set * count;
        for (size_t i = 0; i < count; i++)
            self->values[i] =
                (camber_value){.type = tags[i] ? CAMBER_VALUE_STRING : CAMBER_VALUE_NULL, .string = tags[i]};
        const camber_status status = camber_features_find_class(self->features, self->layer, kind, self->values, index);
        if (status != CAMBER_OK)
            return status;
        *known = *index + 1;
    }
    *index = *known - 1;
    return CAMBER_OK;
}

/* The lines of one feature in a run, or its point. */
typedef struct line_span {
    const camber_world_lines *lines;
    size_t first, count;
} line_span;

/* Adds lines as one feature, if its kind is read. A feature of a label's kind is added only if a symbol layer takes
 * it. */
static camber_status add_lines(reader *self, uint32_t set, camber_geometry_kind kind, const line_span *span) {
    const camber_world_lines *lines = span->lines;
    uint32_t index;
    if (span->count == 0 || !(self->kinds >> kind & 1))
        return CAMBER_OK;
    camber_status status = find_class(self, set, kind, &index);
    if (status != CAMBER_OK || !camber_features_draw_class(self->features, index))
        return status;
    status = camber_features_add_feature(self->features, index);
    for (size_t i = span->first; i < span->first + span->count && status == CAMBER_OK; i++) {
        const size_t first = i ? lines->ends[i - 1] : 0;
        status = camber_features_add_polyline(self->features, lines->points + 2 * first, lines->ends[i] - first);
    }
    return status;
}

/* Adds the features of a way. filled: the way's ring is drawn; otherwise a relation is filled instead. */
static camber_status add_way(reader *self, const made_way *way, bool filled, const camber_world_lines *lines,
                             size_t *line) {
    const bool area = way->tags & CAMBER_OSM_WAY_AREA;
    const uint32_t set = way->tags / CAMBER_OSM_WAY_BITS;
    const line_span own = {lines, *line, way->line_count};
    const line_span ring = {lines, *line + way->line_count, way->has_ring && filled};
    camber_status status = add_lines(self, set, area ? CAMBER_GEOMETRY_POLYGON : CAMBER_GEOMETRY_LINE, &own);
    if (status == CAMBER_OK && !area)
        status = add_lines(self, set, CAMBER_GEOMETRY_LABEL_LINE, &own);
    if (status == CAMBER_OK)
        status = add_lines(self, set, CAMBER_GEOMETRY_AREA, &ring);
    if (status == CAMBER_OK)
        status = add_lines(self, set, CAMBER_GEOMETRY_LABEL_AREA, &ring);
    *line += (size_t)way->line_count + way->has_ring;
    return status;
}

static camber_status add_run(void *user, size_t part, void *slot) {
    reader *self = user;
    const made_run *run = slot;
    const made_way *ways = (const made_way *)(const void *)run->ways.bytes;
    const uint64_t *places = (const uint64_t *)(const void *)run->places.bytes;
    camber_osm_relations *relations = &self->ways.relations;
    camber_status status = CAMBER_OK;
    size_t line = 0;
    (void)part;
    for (size_t i = 0; i < run->way_count && status == CAMBER_OK; i++) {
        const bool member = ways[i].tags & CAMBER_OSM_WAY_MEMBER;
        const bool filled = !member || !relations->ways[relations->met[self->met]].is_outer;
        status = add_way(self, &ways[i], filled, &run->lines, &line);
        if (ways[i].is_coast && status == CAMBER_OK)
            status = camber_osm_coast_add(&self->coast, places + ways[i].first_place, ways[i].place_count,
                                          ways[i].tags & CAMBER_OSM_WAY_GAPS);
        if (!member || status != CAMBER_OK)
            continue;
        status =
            camber_osm_relations_add_places(relations, self->met++, places + ways[i].first_place, ways[i].place_count);
    }
    self->features->stats.empty_rings += run->stats.empty_rings;
    self->clamped += run->lines.clamped_points;
    self->splits += run->lines.antimeridian_splits;
    return status;
}

/* ---- Nodes become points ---- */

/* Makes points from the nodes with tags. They come before the lines and have a layer of their own, as in GDAL. */
static camber_status make_points(reader *self) {
    camber_osm_ways *ways = &self->ways;
    camber_world_lines world = {.context = self->context};
    camber_status status = CAMBER_OK;
    if (ways->point_count)
        status = camber_features_find_layer(self->features, POINT_LAYER, &self->layer);
    if (status == CAMBER_OK && !camber_world_lines_reserve(&world, 1))
        status = CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < ways->point_count && status == CAMBER_OK; i++) {
        const camber_osm_point *point = &ways->points[i];
        camber_world_lines_begin(&world);
        camber_world_lines_add_degrees(&world, point->longitude, point->latitude);
        camber_world_lines_end(&world);
        const line_span span = {&world, 0, 1};
        status = add_lines(self, point->set, CAMBER_GEOMETRY_POINT, &span);
        if (status == CAMBER_OK)
            status = add_lines(self, point->set, CAMBER_GEOMETRY_LABEL_POINT, &span);
    }
    self->clamped += world.clamped_points;
    camber_world_lines_free(&world);
    camber_free(self->context, ways->points);
    ways->points = NULL;
    ways->point_count = ways->point_capacity = 0;
    return status;
}

/* ---- Relations become areas ---- */

/* Boundaries of all levels together name each way about ten times. Without a limit, a file of one megabyte could make
 * relations with 10^10 places. */
static const size_t MOST_USES = 32, MOST_PLACES = (size_t)1 << 20;

/* The area of a relation. */
typedef struct made_area {
    camber_osm_assembly assembly;
    camber_world_lines lines; /* one ring */
    camber_rings rings;
    size_t place_count; /* of all relations so far */
    uint32_t class_index;
    bool added;
    bool is_sea; /* rings are inside a box: their edges are kept as they are, however long they are */
} made_area;

static camber_status add_ring(reader *self, made_area *area, const camber_osm_ring *ring) {
    camber_world_lines *lines = &area->lines;
    camber_status status = CAMBER_OK;
    bool crosses = false;
    camber_world_lines_begin(lines);
    if (!camber_world_lines_reserve(lines, ring->count))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = ring->first; i < ring->first + ring->count; i++) {
        const uint64_t place = area->assembly.places[i];
        camber_world_lines_add_degrees(lines, camber_osm_longitude(place) / 1.0e7, camber_osm_latitude(place) / 1.0e7);
    }
    size_t count = lines->point_count;
    if (!area->is_sea)
        count = camber_ring_unroll(lines->points, count, &crosses);
    self->splits += crosses;
    count = camber_rings_take(&area->rings, lines->points, count, ring->role == CAMBER_OSM_ROLE_INNER);
    if (count && !area->added)
        status = camber_features_add_feature(self->features, area->class_index);
    area->added = area->added || count;
    return count && status == CAMBER_OK ? camber_features_add_polyline(self->features, lines->points, count) : status;
}

/* Adds the assembled rings as one area of its class. */
static camber_status add_rings(reader *self, made_area *area) {
    camber_status status = CAMBER_OK;
    area->added = false;
    area->rings = (camber_rings){.stats = &self->features->stats, .any_winding = true};
    for (size_t i = 0; i < area->assembly.ring_count && status == CAMBER_OK; i++)
        status = add_ring(self, area, &area->assembly.rings[i]);
    return status;
}

/* Adds the rings once more for symbol layers, if one takes the area. This time nothing is counted. */
static camber_status add_label(reader *self, uint32_t set, made_area *area) {
    const camber_features_stats stats = self->features->stats;
    const size_t splits = self->splits, clamped = area->lines.clamped_points;
    camber_status status = find_class(self, set, CAMBER_GEOMETRY_LABEL_AREA, &area->class_index);
    if (status == CAMBER_OK && camber_features_draw_class(self->features, area->class_index))
        status = add_rings(self, area);
    self->features->stats = stats;
    self->splits = splits;
    area->lines.clamped_points = clamped;
    return status;
}

static camber_status add_relation(reader *self, size_t relation, made_area *area) {
    const camber_osm_relations *relations = &self->ways.relations;
    const uint32_t set = relations->items[relation].set;
    if (set == 0)
        return CAMBER_OK;
    area->place_count += camber_osm_relations_count_places(relations, relation);
    if (area->place_count > MOST_PLACES + MOST_USES * relations->place_count)
        return camber_fail(
            self->context, CAMBER_ERROR_LIMIT,
            "%s: its multipolygons name their ways more than %zu times each; get it from a source that you "
            "trust",
            self->desc->path, MOST_USES);
    camber_status status = camber_osm_relations_assemble(&self->ways.relations, relation, &area->assembly);
    self->features->stats.open_relations += status == CAMBER_OK && area->assembly.open;
    const bool drawn = self->kinds & CAMBER_KIND_AREA, any = area->assembly.ring_count > 0;
    if (status == CAMBER_OK && drawn && any)
        status = find_class(self, set - 1, CAMBER_GEOMETRY_AREA, &area->class_index);
    if (status == CAMBER_OK && drawn)
        status = add_rings(self, area);
    self->features->stats.dropped_relations += status == CAMBER_OK && drawn && !area->added;
    return status == CAMBER_OK && any && self->kinds & CAMBER_KIND_LABEL_AREA ? add_label(self, set - 1, area) : status;
}

/* Finds the class of the sea, which is water, as ponds are. */
static camber_status find_sea_class(reader *self, uint32_t *index) {
    const size_t count = self->features->schema->property_count;
    camber_value *values = camber_alloc_zero(self->context, count, sizeof *values);
    if (!values)
        return CAMBER_ERROR_MEMORY;
    values[self->coast_key].type = CAMBER_VALUE_STRING;
    camber_status status = camber_features_intern(self->features, "water", &values[self->coast_key].string);
    if (status == CAMBER_OK)
        status = camber_features_find_class(self->features, self->layer, CAMBER_GEOMETRY_AREA, values, index);
    camber_free(self->context, values);
    return status;
}

/* Makes an area for the sea from the coast. */
static camber_status make_sea(reader *self, made_area *area) {
    area->is_sea = true;
    camber_status status = camber_osm_coast_fill(&self->coast, &area->assembly);
    if (status == CAMBER_OK && area->assembly.open)
        camber_log(
            self->context, CAMBER_LOG_WARNING,
            "%s: no sea is drawn: %s; cut an extract by a box, with complete ways, or give a file of water areas as "
            "another input",
            self->desc->path,
            self->coast.box.left < self->coast.box.right ? "its coast is incomplete in the box that its header names"
                                                         : "its header names no box, or one across the antimeridian");
    camber_osm_coast_free(&self->coast);
    if (status == CAMBER_OK && area->assembly.ring_count)
        status = find_sea_class(self, &area->class_index);
    return status == CAMBER_OK ? add_rings(self, area) : status;
}

/* Makes areas after all ways have become lines. They have a layer of their own, as in GDAL. */
static camber_status make_areas(reader *self) {
    camber_osm_ways *ways = &self->ways;
    made_area area = {.assembly.context = self->context, .lines = {.context = self->context, .uncut = true}};
    if (ways->relations.count == 0 && self->coast.way_count == 0)
        return CAMBER_OK;
    camber_free(self->context, ways->packed);
    ways->packed = NULL;
    ways->packed_count = ways->packed_capacity = 0;
    for (int kind = 0; kind < CAMBER_GEOMETRY_KINDS && ways->set_count; kind++)
        if (CAMBER_KINDS_OF_AREAS >> kind & 1)
            memset(self->classes[kind], 0, ways->set_count * sizeof **self->classes);
    camber_features *features = self->features;
    camber_status status = camber_features_find_layer(features, RELATION_LAYER, &self->layer);
    for (size_t i = 0; i < ways->relations.count && status == CAMBER_OK; i++)
        status = add_relation(self, i, &area);
    features->stats.missing_ways += camber_osm_relations_count_missing(&ways->relations);
    if (self->coast.way_count && status == CAMBER_OK)
        status = make_sea(self, &area);
    self->clamped += area.lines.clamped_points;
    camber_world_lines_free(&area.lines);
    camber_osm_assembly_free(&area.assembly);
    return status;
}

static camber_status make_lines(reader *self) {
    camber_features *features = self->features;
    camber_osm_ways *ways = &self->ways;
    bool declined;
    if (!(self->values = camber_alloc(self->context, features->schema->property_count, sizeof *self->values)))
        return CAMBER_ERROR_MEMORY;
    for (int kind = 0; kind < CAMBER_GEOMETRY_KINDS; kind++)
        if (!(self->classes[kind] = camber_alloc_zero(self->context, ways->set_count, sizeof **self->classes)))
            return CAMBER_ERROR_MEMORY;
    const camber_osm_pass_desc pass = {.context = self->context,
                                       .name = self->desc->path,
                                       .part_count = ways->run_count,
                                       .threads = self->threads,
                                       .slot_bytes = sizeof(made_run),
                                       .user = self,
                                       .work = make_run,
                                       .commit = add_run,
                                       .free_slot = free_run,
                                       .from = PACKED_SHARE,
                                       .to = 1.0};
    const bool drops_areas = !(self->kinds & (CAMBER_KIND_POLYGON | CAMBER_KINDS_OF_AREAS));
    const camber_osm_pack_desc pack = {self->desc->path, self->threads, drops_areas, NODES_SHARE, PACKED_SHARE};
    camber_status status = camber_osm_pack(ways, &pack, &self->skipped);
    if (status == CAMBER_OK)
        status = make_points(self);
    if (status == CAMBER_OK)
        status = camber_features_find_layer(features, LAYER, &self->layer);
    size_t points = features->point_count;
    for (size_t i = 0; i < ways->run_count; i++)
        points += ways->runs[i].node_count;
    /* Grows once, because an array that grows step by step is copied, and takes half as much again. */
    if (status == CAMBER_OK &&
        !camber_grow(self->context, &features->points, &features->point_capacity, points, 2 * sizeof *features->points))
        status = CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        status = camber_osm_pass_run(&pass, &declined);
    return status == CAMBER_OK ? make_areas(self) : status;
}

/* ---- A file ---- */

/* Reads relations if they are wanted, then ways, then the places of their nodes. *declined: the file is not in order,
 * or not for this reader. */
static camber_status read_kinds(reader *self, camber_osm_file *file, bool any_order, bool *declined) {
    const bool areas = self->kinds & CAMBER_KINDS_OF_AREAS && !self->desc->layer;
    camber_osm_ends ends;
    camber_status status = CAMBER_OK;
    if (!any_order)
        status = camber_osm_find_ends(file, areas, &ends, declined);
    if (status != CAMBER_OK || *declined)
        return status;
    camber_osm_ways_desc relations = {.file = file, .any_order = any_order, .threads = self->threads};
    camber_osm_ways_desc ways = relations;
    camber_osm_nodes_desc nodes = {.file = file,
                                   .blob_count = file->blob_count,
                                   .relations = areas,
                                   .threads = self->threads,
                                   .from = WAYS_SHARE,
                                   .to = NODES_SHARE};
    ways.to = WAYS_SHARE;
    if (!any_order) {
        /* The last blob that begins with ways may end with relations, and the last that begins with nodes may end with
         * ways. */
        relations.first_blob = ends.ways ? ends.ways - 1 : 0;
        ways.first_blob = ends.nodes ? ends.nodes - 1 : 0;
        relations.end_blob = ways.end_blob = ends.ways;
        nodes.blob_count = nodes.node_blobs = file->blob_count ? ways.first_blob + 1 : 0;
    }
    if (areas)
        status = camber_osm_relations_read(&self->ways, &relations, declined);
    if (status == CAMBER_OK && !*declined)
        status = camber_osm_ways_read(&self->ways, &ways, declined);
    if (self->ways.has_places) {
        nodes.on_ways = true;
        nodes.blob_count = file->blob_count;
    }
    if (status == CAMBER_OK && !*declined)
        status = camber_osm_nodes_read(&self->ways.nodes, &nodes, declined);
    camber_osm_ways_desc points = {
        .file = file, .end_blob = nodes.blob_count, .threads = self->threads, .from = NODES_SHARE, .to = NODES_SHARE};
    if (self->kinds & CAMBER_KINDS_OF_POINTS && !self->desc->layer && status == CAMBER_OK && !*declined)
        status = camber_osm_points_read(&self->ways, &points, declined);
    self->nodes = self->ways.nodes.node_count;
    self->missing = self->nodes - self->ways.nodes.found_count;
    return status;
}

static camber_status read_places(reader *self, camber_osm_file *file, bool *declined) {
    const camber_osm_where *where = self->ways.where;
    camber_status status = read_kinds(self, file, false, declined);
    if (status != CAMBER_OK || !*declined)
        return status;
    camber_osm_ways_free(&self->ways);
    status = camber_osm_ways_init(&self->ways, self->features, where, declined);
    if (status == CAMBER_OK && !*declined)
        status = read_kinds(self, file, true, declined);
    if (status == CAMBER_OK && !*declined)
        camber_log(self->context, CAMBER_LOG_INFO,
                   "%s: nodes, ways and relations are not sorted, so the whole file was read once for each; osmium "
                   "sort makes this faster",
                   file->path);
    return status;
}

static camber_status check_result(const reader *self, size_t features_before) {
    if (self->features->feature_count > features_before)
        return CAMBER_OK;
    if (self->nodes > 0 && self->missing == self->nodes)
        return camber_fail(
            self->context, CAMBER_ERROR_INPUT,
            "%s: has none of the %zu nodes to which its ways refer; extract it again with its nodes, as osmium "
            "extract and osmium getid -r do",
            self->desc->path, self->nodes);
    if (self->skipped == 0)
        return CAMBER_OK;
    return camber_fail(self->context, CAMBER_ERROR_INPUT,
                       "%s: no lines; its %zu features are points, areas or empty; choose another --layer, or a style "
                       "that draws outlines of polygons",
                       self->desc->path, self->skipped);
}

/* Enables the sea if areas are wanted, the style reads its key, and the whole coast is read. box: from the file's
 * header, cut off at the limits of Web Mercator. */
static camber_status want_sea(reader *self, camber_osm_box box) {
    const camber_schema *schema = self->features->schema;
    const int32_t most = (int32_t)(CAMBER_MERCATOR_LATITUDE * 1.0e7);
    const bool wanted = schema->wants_areas && !self->desc->layer && !self->desc->where;
    box.bottom = box.bottom > -most ? box.bottom : -most;
    box.top = box.top < most ? box.top : most;
    self->coast.box = box;
    self->coast_key = SIZE_MAX;
    for (size_t i = 0; i < schema->property_count && wanted; i++)
        if (strcmp(schema->properties[i], "natural") == 0 && camber_schema_draws_property(schema, i))
            self->coast_key = i;
    return camber_features_intern(self->features, "coastline", &self->coastline);
}

/* If nothing passes a filter, leaves the file to GDAL's reader, which explains why, provided that GDAL can read it. */
static camber_status explain_filter(const reader *self, const camber_osm_file *file, bool *declined) {
    camber_osm_beyond beyond;
    const camber_status status = camber_osm_find_beyond(file, self->threads, &beyond);
    *declined = status == CAMBER_OK && !camber_osm_is_beyond(&beyond);
    if (status == CAMBER_OK && !*declined)
        camber_log(self->context, CAMBER_LOG_WARNING, "%s: nothing passes the filter \"%s\"; check its keys and values",
                   self->desc->path, self->desc->where);
    return status;
}

static camber_status read_lines(reader *self, bool *declined) {
    camber_osm_file file;
    const size_t features_before = self->features->feature_count;
    camber_status status = camber_osm_file_open(self->context, self->desc->path, &file, declined);
    if (status != CAMBER_OK || *declined)
        return status;
    const bool filters = self->desc->where && camber_osm_where_parse(self->desc->where, &self->where);
    status = camber_osm_ways_init(&self->ways, self->features, filters ? &self->where : NULL, declined);
    if (status == CAMBER_OK && !*declined)
        status = want_sea(self, file.box);
    if (status == CAMBER_OK && !*declined)
        status = read_places(self, &file, declined);
    if (status == CAMBER_OK && !*declined)
        status = make_lines(self);
    if (status == CAMBER_OK && !*declined)
        status = check_result(self, features_before);
    if (filters && status == CAMBER_OK && !*declined && self->features->feature_count == features_before)
        status = explain_filter(self, &file, declined);
    camber_osm_coast_free(&self->coast);
    camber_osm_ways_free(&self->ways);
    camber_osm_file_close(&file);
    for (int kind = 0; kind < CAMBER_GEOMETRY_KINDS; kind++)
        camber_free(self->context, self->classes[kind]);
    camber_free(self->context, self->values);
    return status;
}

static void add_stats(const reader *self) {
    camber_features *features = self->features;
    camber_features_count(features);
    features->stats.skipped_features += self->skipped;
    features->stats.missing_nodes += self->missing;
    features->stats.clamped_points += self->clamped;
    features->stats.antimeridian_splits += self->splits;
    if (self->skipped)
        camber_log(self->context, CAMBER_LOG_INFO, "%s: left out what is %s of %zu features", self->desc->path,
                   camber_features_left_out(self->kinds), self->skipped);
    if (self->missing)
        camber_log(self->context, CAMBER_LOG_INFO, "%s: ways refer to %zu nodes that the file does not have",
                   self->desc->path, self->missing);
    if (self->clamped)
        camber_log(self->context, CAMBER_LOG_WARNING, "%s: %zu points beyond latitude 85.051129 are moved there",
                   self->desc->path, self->clamped);
}

static camber_status read_pbf(camber_features *features, const camber_source_desc *desc, bool *declined) {
    const camber_features_mark before = camber_features_get_mark(features);
    const double start_ms = camber_now_ms();
    reader self = {.context = features->context,
                   .features = features,
                   .desc = desc,
                   .kinds = camber_features_kinds(features, false),
                   .threads = (unsigned)camber_threads_count(desc->threads)};
    self.coast.context = features->context;
    *declined = false;
    camber_status status = read_lines(&self, declined);
    features->times.file_ms += camber_now_ms() - start_ms;
    if (status == CAMBER_OK && !*declined)
        status = camber_features_add_attribution(features, CAMBER_OSM_ATTRIBUTION);
    if (status == CAMBER_OK && !*declined)
        status = camber_features_merge_and_weigh(features, before.polyline_count, !desc->keep_apart, CAMBER_MERGE_ANY);
    if (status != CAMBER_OK || *declined) {
        camber_features_reset(features, &before);
        return status;
    }
    camber_features_add_extract(features, before.polyline_count);
    add_stats(&self);
    camber_rings_report(features, desc->path, before.polyline_count, &before.stats);
    camber_progress(self.context, "reading", 1);
    return CAMBER_OK;
}

/* Fails if GDAL would misread the file that this reader leaves to it. */
static camber_status leave(camber_context *context, const camber_source_desc *desc) {
    camber_osm_file file;
    camber_osm_beyond beyond;
    bool declined = false;
    camber_status status = camber_osm_file_open(context, desc->path, &file, &declined);
    if (status != CAMBER_OK || declined)
        return status;
    status = camber_osm_find_beyond(&file, (unsigned)camber_threads_count(desc->threads), &beyond);
    camber_osm_file_close(&file);
    if (status != CAMBER_OK || !camber_osm_is_beyond(&beyond))
        return status;
    char packing[32];
    snprintf(packing, sizeof packing, "compression with %s", camber_osm_codec_get_name(beyond.codec));
    return camber_fail(context, CAMBER_ERROR_INPUT,
                       "%s: only GDAL can read it for this layer, filter or style, but GDAL does not support %s; %s",
                       desc->path,
                       beyond.codec       ? packing
                       : beyond.no_size   ? "blobs without their size"
                       : beyond.unordered ? "an order other than nodes, ways, relations"
                                          : "places on ways",
                       beyond.codec || beyond.no_size ? "compress it again with osmium cat -f pbf,pbf_compression=zlib"
                       : beyond.unordered             ? "sort it with osmium sort"
                                                      : "draw it without these, or use the file from which "
                                                        "osmium add-locations-to-ways made it");
}

static const char *format(size_t n) {
    return n == 0 ? "OSM" : NULL;
}

const camber_reader camber_osm_reader = {
    .knows = camber_osm_knows, .reads = reads, .read = read_pbf, .leave = leave, .format = format};
