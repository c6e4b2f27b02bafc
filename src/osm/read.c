/* Reads the lines of a PBF file of OpenStreetMap into a set of features.
 *
 * Input: a path. Output: what GDAL's layer "lines" gives by the rules of gdal/osmconf.ini: the same lines with the same
 * attributes in the same order, to the last bit. The file is read in two passes, and no blob of it twice but a few: the
 * ways first, which lie at its end, then the places of those nodes that ways name. So a node takes eight bytes and a
 * bit, whatever else the file has. A third pass packs the ways with these places, and frees the nodes; a fourth makes
 * world coordinates. Each pass has several threads. */
#include "osm/osm.h"

#include "osm/nodes.h"
#include "osm/packed.h"
#include "source/osm_keys.h"
#include "source/rings.h"
#include "source/tile_reader.h"
#include "source/world_lines.h"

#include <unistd.h>

static const double WAYS_SHARE = 0.3, NODES_SHARE = 0.75, PACKED_SHARE = 0.85; /* of the progress */
/* OGR's name of the layer. */
static const char LAYER[] = "lines";

typedef struct reader {
    camber_context *context;
    camber_features *features;
    const camber_source_desc *desc;
    camber_osm_where where;
    camber_osm_ways ways;
    uint32_t layer;
    uint32_t *classes[CAMBER_GEOMETRY_KINDS]; /* by kind, of each set of tags: index + 1; 0: not needed yet */
    size_t skipped, clamped, splits;
    unsigned threads;
} reader;

bool camber_osm_reads(const camber_source_desc *desc) {
    camber_osm_where where;
    return (!desc->where || camber_osm_where_parse(desc->where, &where)) &&
           (!desc->layer || strcmp(desc->layer, LAYER) == 0) && camber_osm_knows(desc->path);
}

static unsigned count_threads(const camber_source_desc *desc) {
    const long cores = desc->threads ? (long)desc->threads : sysconf(_SC_NPROCESSORS_ONLN);
    return cores > 0 ? (unsigned)(cores < 1024 ? cores : 1024) : 1;
}

/* ---- Ways become lines, on any thread ---- */

typedef struct made_way {
    uint32_t tags;       /* as the way has them, with the area's bit set only where the line is closed */
    uint32_t line_count; /* as a line, or as an outline; then comes its ring */
    bool has_ring;
} made_way;

typedef struct made_run {
    camber_osm_block points, ends, ways; /* pairs of doubles, size_t, made_way */
    size_t way_count;
    camber_world_lines lines;
    camber_features_stats stats; /* of its rings */
} made_run;

static void free_run(camber_context *context, void *slot) {
    made_run *run = slot;
    camber_free(context, run->ways.bytes);
    camber_free(context, run->ends.bytes);
    camber_free(context, run->points.bytes);
}

static void add_nodes(const camber_osm_way *way, camber_osm_unpacking *from, camber_world_lines *lines) {
    for (uint32_t i = 0; i < way->node_count; i++) {
        camber_osm_unpack_node(from);
        camber_world_lines_add_degrees(lines, (double)from->longitude / 1.0e7, (double)from->latitude / 1.0e7);
    }
}

/* Makes a ring of a closed way. counts: what is counted of its points was not counted with an outline. */
static bool make_ring(const camber_osm_way *way, camber_osm_unpacking *from, made_run *run, bool counts) {
    camber_world_lines *lines = &run->lines;
    camber_rings rings = {.stats = &run->stats};
    const size_t first = lines->point_count, clamped = lines->clamped_points;
    bool crosses = false;
    lines->uncut = true;
    add_nodes(way, from, lines);
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

/* The lines of a way that was packed, and its ring if it is an area. */
static void make_way(const camber_style *style, const camber_osm_way *way, camber_osm_unpacking *from, made_run *run) {
    camber_world_lines *lines = &run->lines;
    const size_t lines_before = lines->line_count;
    const bool area = way->tags & 1, has_lines = !area || style->wants_polygons;
    made_way made = {.tags = way->tags};
    camber_osm_unpacking again = *from;
    if (has_lines) {
        add_nodes(way, from, lines);
        camber_world_lines_end(lines);
    }
    made.line_count = (uint32_t)(lines->line_count - lines_before);
    if (area && style->wants_areas) {
        made.has_ring = make_ring(way, &again, run, !has_lines);
        *from = again;
    }
    ((made_way *)(void *)run->ways.bytes)[run->way_count++] = made;
}

static bool make_run(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    const camber_osm_ways *ways = &((const reader *)user)->ways;
    const camber_style *style = ways->features->style;
    const camber_osm_run *from = &ways->runs[part];
    made_run *run = slot;
    size_t points = camber_world_lines_most_points(from->node_count),
           ends = camber_world_lines_most_ends(from->node_count);
    if (style->wants_areas) { /* a ring adds its points, and four at most */
        points += from->node_count + 4 * from->way_count;
        ends += from->way_count;
    }
    if (!camber_osm_reserve(pass, &run->points, points * 2 * sizeof(double), failure) ||
        !camber_osm_reserve(pass, &run->ends, ends * sizeof(size_t), failure) ||
        !camber_osm_reserve(pass, &run->ways, from->way_count * sizeof(made_way), failure))
        return false;
    run->way_count = 0;
    run->stats = (camber_features_stats){0};
    run->lines =
        (camber_world_lines){.points = (double *)(void *)run->points.bytes, .ends = (size_t *)(void *)run->ends.bytes};
    camber_osm_unpacking places = camber_osm_unpack_run(ways, from);
    for (const camber_osm_way *way = ways->ways + from->first_way, *end = way + from->way_count; way < end; way++)
        if (way->node_count)
            make_way(style, way, &places, run);
    return true;
}

/* ---- Lines become features ---- */

static camber_status find_class(reader *self, uint32_t set, camber_geometry_kind kind, uint32_t *index) {
    uint32_t *known = &self->classes[kind][set];
    if (*known == 0) {
        const camber_status status = camber_features_find_class(
            self->features, self->layer, kind, self->ways.values + set * self->features->style->property_count, index);
        if (status != CAMBER_OK)
            return status;
        *known = *index + 1;
    }
    *index = *known - 1;
    return CAMBER_OK;
}

/* Adds the next lines of a run as one feature. */
static camber_status add_lines(reader *self, uint32_t class_index, const camber_world_lines *lines, size_t *line,
                               uint32_t count) {
    camber_status status = camber_features_add_feature(self->features, class_index);
    for (uint32_t i = 0; i < count && status == CAMBER_OK; i++, ++*line) {
        const size_t first = *line ? lines->ends[*line - 1] : 0;
        status = camber_features_add_polyline(self->features, lines->points + 2 * first, lines->ends[*line] - first);
    }
    return status;
}

static camber_status add_way(reader *self, const made_way *way, const camber_world_lines *lines, size_t *line) {
    const camber_geometry_kind kind = way->tags & 1 ? CAMBER_GEOMETRY_POLYGON : CAMBER_GEOMETRY_LINE;
    uint32_t index;
    camber_status status = CAMBER_OK;
    if (way->line_count)
        status = find_class(self, way->tags / 2, kind, &index);
    if (way->line_count && status == CAMBER_OK)
        status = add_lines(self, index, lines, line, way->line_count);
    if (way->has_ring && status == CAMBER_OK)
        status = find_class(self, way->tags / 2, CAMBER_GEOMETRY_AREA, &index);
    if (way->has_ring && status == CAMBER_OK)
        status = add_lines(self, index, lines, line, 1);
    return status;
}

static camber_status add_run(void *user, size_t part, void *slot) {
    reader *self = user;
    const made_run *run = slot;
    const made_way *ways = (const made_way *)(const void *)run->ways.bytes;
    camber_status status = CAMBER_OK;
    size_t line = 0;
    (void)part;
    for (size_t i = 0; i < run->way_count && status == CAMBER_OK; i++)
        status = add_way(self, &ways[i], &run->lines, &line);
    self->features->stats.empty_rings += run->stats.empty_rings;
    self->clamped += run->lines.clamped_points;
    self->splits += run->lines.antimeridian_splits;
    return status;
}

static camber_status make_lines(reader *self) {
    camber_features *features = self->features;
    camber_osm_ways *ways = &self->ways;
    bool declined;
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
    const bool drops_areas = !features->style->wants_polygons && !features->style->wants_areas;
    const camber_osm_pack_desc pack = {self->desc->path, self->threads, drops_areas, NODES_SHARE, PACKED_SHARE};
    camber_status status = camber_osm_pack(ways, &pack, &self->skipped);
    if (status == CAMBER_OK)
        status = camber_features_find_layer(features, LAYER, &self->layer);
    return status == CAMBER_OK ? camber_osm_pass_run(&pass, &declined) : status;
}

/* ---- A file ---- */

static camber_status read_places(reader *self, const camber_osm_file *file, bool *declined) {
    size_t end = 0;
    camber_status status = camber_osm_nodes_end(file, &end, declined);
    if (status != CAMBER_OK || *declined)
        return status;
    /* The last blob that begins with nodes may go on with ways. */
    const camber_osm_ways_desc ways = {file, end ? end - 1 : 0, self->threads, 0.0, WAYS_SHARE};
    const camber_osm_nodes_desc nodes = {file, end, self->threads, WAYS_SHARE, NODES_SHARE};
    status = camber_osm_ways_read(&self->ways, &ways, declined);
    if (status == CAMBER_OK && !*declined)
        status = camber_osm_nodes_read(&self->ways.nodes, &nodes, declined);
    return status;
}

static camber_status check_result(const reader *self, size_t features_before) {
    if (self->features->feature_count > features_before || self->skipped == 0)
        return CAMBER_OK;
    return camber_fail(self->context, CAMBER_ERROR_INPUT,
                       "%s: no lines: %zu features have other geometry (points, areas, nothing); name another --layer, "
                       "or a style that draws outlines of polygons",
                       self->desc->path, self->skipped);
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
        status = read_places(self, &file, declined);
    if (status == CAMBER_OK && !*declined)
        status = make_lines(self);
    if (status == CAMBER_OK && !*declined)
        status = check_result(self, features_before);
    /* GDAL's reader finds out why nothing passes a filter. */
    *declined = *declined || (filters && status == CAMBER_OK && self->features->feature_count == features_before);
    camber_osm_ways_free(&self->ways);
    camber_osm_file_close(&file);
    for (int kind = 0; kind < CAMBER_GEOMETRY_KINDS; kind++)
        camber_free(self->context, self->classes[kind]);
    return status;
}

static void add_stats(const reader *self) {
    camber_features *features = self->features;
    features->stats.features = features->feature_count;
    features->stats.polylines = features->polyline_count;
    features->stats.points = features->point_count;
    features->stats.skipped_features += self->skipped;
    features->stats.clamped_points += self->clamped;
    features->stats.antimeridian_splits += self->splits;
    if (self->skipped)
        camber_log(self->context, CAMBER_LOG_INFO,
                   "%s: left out what is no line (points, areas, empty geometry) of %zu features", self->desc->path,
                   self->skipped);
    if (self->clamped)
        camber_log(self->context, CAMBER_LOG_WARNING, "%s: %zu points beyond latitude 85.051129 are moved there",
                   self->desc->path, self->clamped);
}

camber_status camber_osm_read(camber_features *features, const camber_source_desc *desc, bool *declined) {
    const camber_features_mark before = camber_features_get_mark(features);
    const double start_ms = camber_now_ms();
    reader self = {.context = features->context, .features = features, .desc = desc, .threads = count_threads(desc)};
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
    add_stats(&self);
    camber_rings_report(features, desc->path, &before.stats);
    camber_progress(self.context, "reading", 1);
    return CAMBER_OK;
}
