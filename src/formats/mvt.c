/* Reads vector tiles (Mapbox Vector Tile 2) into a set of features.
 *
 * Input: the decompressed bytes of one tile after the other. Output: features. The stitcher gets their lines and rings,
 * and cuts them at the tiles' borders. protobuf-c unpacks messages into a pool of limited size. Damage is counted.
 */
#include "formats/mvt.h"
#include "features/rings.h"
#include "formats/mvt_geometry.h"

#include "vector_tile.pb-c.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* The most memory for a tile's unpacked messages. The largest tiles of real maps need a few megabytes. */
static const size_t LARGEST_TILE_BYTES = (size_t)256 << 20;

/* PEEKED_FEATURES: how many features are examined to find out whether a layer has lines. */
enum { PEEKED_FEATURES = 32, MOST_LAYERS = 1024 };

/* Properties that identify a feature in several tiles, apart from the format's own id. They are OSM's, a common one,
 * and TIGER's. */
static const char *const id_keys[] = {"osm_id", "id", "TLID"};
enum { ID_KEYS = 3 };

/* Properties of tiles that were made from GeoJSON with lineMetrics. They say where the line was clipped. */
static const char *const clip_keys[] = {"mapbox_clip_start", "mapbox_clip_end"};

typedef Camber__Tile__Layer tile_layer;
typedef Camber__Tile__Feature tile_feature;

struct camber_mvt {
    camber_context *context;
    camber_mvt_desc desc;
    camber_mvt_stats stats;
    camber_pool pool;
    uint32_t *sorted;     /* the style's properties, sorted by name */
    camber_value *values; /* the property values of one feature */
    camber_mvt_geometry geometry;
    camber_mvt_layer *layers;
    size_t layer_count, layer_capacity;

    /* The layer being read. */
    camber_tile_address address;
    const tile_layer *layer;
    unsigned kinds; /* CAMBER_KIND_* */
    char name[256];
    uint32_t layer_index;
    uint32_t *key_properties; /* layer->n_keys: index of the style's property; NONE: the style does not read it */
    camber_value *known;      /* layer->n_values */
    bool *is_known;
    uint32_t ids[ID_KEYS], promoted, clips[2]; /* indices of keys */
    bool unsorted;                             /* the style does not know the layer's schema */
};

#define NONE UINT32_MAX

static void note_damage(camber_mvt *mvt, const char *cause) {
    if (mvt->stats.damaged_features++ == 0)
        snprintf(mvt->stats.damage, sizeof mvt->stats.damage, "tile %d/%u/%u%s%.64s: %.80s", mvt->address.zoom,
                 mvt->address.column, mvt->address.row, mvt->name[0] ? ", layer " : "", mvt->name, cause);
}

/* Returns the status for a message that could not be unpacked, because it is damaged or because the pool is
 * exhausted. */
static camber_status judge_failure(camber_mvt *mvt, const char *cause) {
    if (mvt->pool.out_of_memory)
        return CAMBER_ERROR_MEMORY;
    note_damage(mvt, mvt->pool.exhausted ? "it takes more than 256 MB" : cause);
    return CAMBER_OK;
}

static bool is_text(ProtobufCBinaryData bytes, const char *text) {
    const size_t length = strlen(text);
    return bytes.len == length && (length == 0 || memcmp(bytes.data, text, length) == 0);
}

/* Copies the text into the pool and appends a 0. Returns NULL if the pool refuses. */
static char *to_text(camber_mvt *mvt, ProtobufCBinaryData bytes) {
    char *text = camber_pool_alloc(&mvt->pool, bytes.len + 1);
    if (!text)
        return NULL;
    if (bytes.len)
        memcpy(text, bytes.data, bytes.len);
    text[bytes.len] = 0;
    return text;
}

/* ---- A layer's keys and values ---- */

static int compare_names(const char *a, size_t a_size, const char *b) {
    const size_t b_size = strlen(b), least = a_size < b_size ? a_size : b_size;
    const int order = least ? memcmp(a, b, least) : 0;
    return order ? order : (a_size > b_size) - (a_size < b_size);
}

static uint32_t find_property(const camber_mvt *mvt, ProtobufCBinaryData key) {
    const camber_schema *schema = mvt->desc.features->schema;
    size_t low = 0, high = schema->property_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const int order = compare_names((const char *)key.data, key.len, schema->properties[mvt->sorted[middle]]);
        if (order == 0)
            return mvt->sorted[middle];
        if (order < 0)
            high = middle;
        else
            low = middle + 1;
    }
    return NONE;
}

static void sort_properties(camber_mvt *mvt) {
    const camber_schema *schema = mvt->desc.features->schema;
    for (uint32_t i = 0; i < schema->property_count; i++) {
        uint32_t at = i;
        for (; at > 0 && strcmp(schema->properties[mvt->sorted[at - 1]], schema->properties[i]) > 0; at--)
            mvt->sorted[at] = mvt->sorted[at - 1];
        mvt->sorted[at] = i;
    }
}

/* Returns the name of the property to use as id. */
static const char *promoted_name(const camber_mvt *mvt) {
    const json_t *promote = mvt->desc.promote_id;
    if (json_is_object(promote))
        promote = json_object_get(promote, mvt->name);
    return json_string_value(promote);
}

static bool find_keys(camber_mvt *mvt) {
    const tile_layer *layer = mvt->layer;
    const char *promoted = promoted_name(mvt);
    mvt->key_properties = camber_pool_alloc(&mvt->pool, (layer->n_keys + 1) * sizeof *mvt->key_properties);
    mvt->known = camber_pool_alloc(&mvt->pool, (layer->n_values + 1) * sizeof *mvt->known);
    mvt->is_known = camber_pool_alloc(&mvt->pool, layer->n_values + 1);
    if (!mvt->key_properties || !mvt->known || !mvt->is_known)
        return false;
    memset(mvt->is_known, 0, layer->n_values + 1);
    mvt->ids[0] = mvt->ids[1] = mvt->ids[2] = mvt->promoted = mvt->clips[0] = mvt->clips[1] = NONE;
    for (uint32_t k = 0; k < layer->n_keys; k++) {
        const ProtobufCBinaryData key = layer->keys[k];
        mvt->key_properties[k] = find_property(mvt, key);
        for (int i = 0; i < ID_KEYS; i++)
            mvt->ids[i] = is_text(key, id_keys[i]) ? k : mvt->ids[i];
        for (int i = 0; i < 2 && mvt->desc.wants_progress; i++)
            mvt->clips[i] = is_text(key, clip_keys[i]) ? k : mvt->clips[i];
        if (promoted && is_text(key, promoted))
            mvt->promoted = k;
    }
    return true;
}

static camber_value number_value(double number) {
    return isnan(number) ? (camber_value){0} : (camber_value){.type = CAMBER_VALUE_NUMBER, .number = number};
}

/* A text that is not UTF-8 counts as a missing value. */
static camber_status text_value(camber_mvt *mvt, ProtobufCBinaryData bytes, camber_value *value) {
    json_t *checked = json_stringn((const char *)bytes.data, bytes.len);
    if (bytes.len && !checked)
        return CAMBER_OK;
    value->type = CAMBER_VALUE_STRING;
    const camber_status status =
        camber_features_intern(mvt->desc.features, checked ? json_string_value(checked) : "", &value->string);
    json_decref(checked);
    return status;
}

static camber_status read_value(camber_mvt *mvt, uint32_t index, camber_value *value) {
    if (mvt->is_known[index]) {
        *value = mvt->known[index];
        return CAMBER_OK;
    }
    const ProtobufCBinaryData bytes = mvt->layer->values[index];
    const camber_pool_mark mark = camber_pool_here(&mvt->pool);
    const Camber__Tile__Value *read = camber__tile__value__unpack(&mvt->pool.allocator, bytes.len, bytes.data);
    camber_status status = CAMBER_OK;
    *value = (camber_value){0};
    if (!read)
        status = judge_failure(mvt, "a value that does not parse");
    else if (read->has_string_value)
        status = text_value(mvt, read->string_value, value);
    else if (read->has_bool_value)
        *value = (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = read->bool_value};
    else if (read->has_float_value)
        *value = number_value((double)read->float_value);
    else if (read->has_double_value)
        *value = number_value(read->double_value);
    else if (read->has_int_value)
        *value = number_value((double)read->int_value);
    else if (read->has_uint_value)
        *value = number_value((double)read->uint_value);
    else if (read->has_sint_value)
        *value = number_value((double)read->sint_value);
    camber_pool_reset(&mvt->pool, mark);
    mvt->known[index] = *value;
    mvt->is_known[index] = true;
    return status;
}

/* ---- A feature ---- */

static json_t *to_json(const camber_value *value) {
    switch (value->type) {
    case CAMBER_VALUE_BOOL: return json_boolean(value->boolean);
    case CAMBER_VALUE_NUMBER: return json_real(value->number);
    case CAMBER_VALUE_STRING: return json_string(value->string);
    default: return json_null();
    }
}

static camber_status read_all_properties(camber_mvt *mvt, const tile_feature *feature, const camber_value **all) {
    json_t *object = json_object();
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i + 1 < feature->n_tags && status == CAMBER_OK; i += 2) {
        camber_value value;
        if (feature->tags[i] >= mvt->layer->n_keys || feature->tags[i + 1] >= mvt->layer->n_values)
            continue;
        status = read_value(mvt, feature->tags[i + 1], &value);
        const ProtobufCBinaryData key = mvt->layer->keys[feature->tags[i]];
        /* jansson refuses a key that is not UTF-8, so such a property is left out. */
        if (status == CAMBER_OK)
            json_object_setn_new(object, (const char *)key.data, key.len, to_json(&value));
    }
    if (status == CAMBER_OK)
        status = camber_features_intern_json(mvt->desc.features, object, all);
    json_decref(object);
    return status;
}

/* Reads the values of the style's properties, and the id that identifies the feature in other tiles. */
static camber_status read_tags(camber_mvt *mvt, const tile_feature *feature, camber_value *id,
                               camber_tile_feature *stitched, const char **damage) {
    const camber_schema *schema = mvt->desc.features->schema;
    int best = ID_KEYS;
    for (size_t i = 0; i < schema->property_count; i++)
        mvt->values[i] = (camber_value){0};
    for (size_t i = 0; i + 1 < feature->n_tags; i += 2) {
        const uint32_t key = feature->tags[i], index = feature->tags[i + 1];
        if (key >= mvt->layer->n_keys || index >= mvt->layer->n_values) {
            *damage = "a tag that its layer does not have";
            continue;
        }
        int rank = 0;
        while (rank < ID_KEYS && mvt->ids[rank] != key)
            rank++;
        if (rank < best) {
            const ProtobufCBinaryData bytes = mvt->layer->values[index];
            best = rank;
            stitched->has_id = true;
            stitched->id = camber_hash(camber_mix(CAMBER_HASH_START, (uint64_t)rank + 1), bytes.data, bytes.len);
        }
        const uint32_t property = mvt->key_properties[key];
        const bool clips = key == mvt->clips[0] || key == mvt->clips[1];
        if (property == NONE && key != mvt->promoted && !clips)
            continue;
        camber_value value;
        const camber_status status = read_value(mvt, index, &value);
        if (status != CAMBER_OK)
            return status;
        if (property != NONE)
            mvt->values[property] = value;
        if (key == mvt->promoted)
            *id = value;
        if (clips && value.type == CAMBER_VALUE_NUMBER && value.number >= 0 && value.number <= 1) {
            stitched->has_progress = true;
            stitched->progress[key == mvt->clips[1]] = value.number;
        }
    }
    if (feature->n_tags & 1)
        *damage = "a key without a value";
    if (feature->has_id && feature->id) {
        stitched->has_id = true;
        stitched->id = camber_mix(CAMBER_HASH_START, feature->id);
    }
    return CAMBER_OK;
}

/* Whether a point belongs to this tile. A point in the tile's buffer belongs to the neighbouring tile, unless that tile
 * is not read. */
static bool is_own(const camber_tile_address *address, const double *point) {
    const double side = ldexp(1.0, address->zoom);
    const double column = floor(point[0] * side) - address->column, row = floor(point[1] * side) - address->row;
    const unsigned beyond = (column < 0 ? CAMBER_SIDE_WEST : 0u) | (column > 0 ? CAMBER_SIDE_EAST : 0u) |
                            (row < 0 ? CAMBER_SIDE_NORTH : 0u) | (row > 0 ? CAMBER_SIDE_SOUTH : 0u);
    return !(beyond & ~address->open_sides);
}

/* Drops the points that belong to other tiles from the geometry. */
static void keep_own_points(camber_mvt *mvt) {
    camber_mvt_geometry *geometry = &mvt->geometry;
    size_t kept = 0;
    for (size_t i = 0; i < geometry->point_count; i++) {
        double *point = geometry->points + 2 * i;
        if (!is_own(&mvt->address, point))
            continue;
        memmove(geometry->points + 2 * kept, point, 2 * sizeof *point);
        geometry->ends[kept] = kept + 1;
        kept++;
    }
    geometry->point_count = geometry->line_count = kept;
}

static camber_status add_points(camber_mvt *mvt, uint32_t class_index) {
    const camber_mvt_geometry *geometry = &mvt->geometry;
    camber_status status = CAMBER_OK;
    bool added = false;
    for (size_t i = 0; i < geometry->point_count && status == CAMBER_OK; i++) {
        const double *point = geometry->points + 2 * i;
        if (!is_own(&mvt->address, point))
            continue;
        if (!added)
            status = camber_features_add_feature(mvt->desc.features, class_index);
        added = true;
        if (status == CAMBER_OK)
            status = camber_features_add_polyline(mvt->desc.features, point, 1);
    }
    return status;
}

/* Finds the class of a feature, and describes the feature to the stitcher. */
static camber_status find_class(camber_mvt *mvt, const tile_feature *feature, camber_geometry_kind kind,
                                camber_tile_feature *stitched, const char **damage) {
    const camber_schema *schema = mvt->desc.features->schema;
    *stitched = (camber_tile_feature){.column = mvt->address.column,
                                      .row = mvt->address.row,
                                      .outline = kind == CAMBER_GEOMETRY_POLYGON,
                                      .area = camber_geometry_is_area(kind),
                                      .progress = {0, 1},
                                      .open_sides = mvt->address.open_sides};
    camber_feature_class wanted = {.layer = mvt->layer_index, .geometry = kind, .unsorted = mvt->unsorted};
    camber_value promoted = {0};
    camber_status status = read_tags(mvt, feature, &promoted, stitched, damage);
    if (schema->wants_id && promoted_name(mvt))
        wanted.id = promoted;
    else if (schema->wants_id && feature->has_id)
        wanted.id = number_value((double)feature->id);
    if (status == CAMBER_OK && schema->wants_all_properties)
        status = read_all_properties(mvt, feature, &wanted.all);
    return status == CAMBER_OK
               ? camber_features_find_class_of(mvt->desc.features, &wanted, mvt->values, &stitched->class_index)
               : status;
}

static camber_status add_to_stitcher(camber_mvt *mvt, const tile_feature *feature, camber_geometry_kind kind,
                                     const char **damage) {
    camber_tile_feature stitched;
    const camber_status status = find_class(mvt, feature, kind, &stitched, damage);
    if (status != CAMBER_OK || !camber_features_draw_class(mvt->desc.features, stitched.class_index))
        return status;
    if (kind == CAMBER_GEOMETRY_POINT)
        return add_points(mvt, stitched.class_index);
    const camber_tile_lines lines = {mvt->geometry.points, mvt->geometry.ends, mvt->geometry.line_count};
    return camber_tile_stitcher_add(mvt->desc.stitcher, &stitched, &lines);
}

static camber_status read_geometry(camber_mvt *mvt, const tile_feature *feature, camber_geometry_kind kind) {
    const camber_mvt_commands commands = {.words = feature->geometry,
                                          .count = feature->n_geometry,
                                          .kind = camber_geometry_shape(kind),
                                          .column = mvt->address.column,
                                          .row = mvt->address.row,
                                          .extent = mvt->layer->extent,
                                          .side = ldexp(1.0, mvt->address.zoom)};
    return camber_mvt_geometry_read(&mvt->geometry, &commands);
}

/* Turns a feature's rings into areas. If the first ring winds the other way, as in the tiles of some programs, all
 * rings do, and the holes are the rings that go clockwise. */
static void take_rings(camber_mvt *mvt, camber_features_stats *stats) {
    camber_mvt_geometry *geometry = &mvt->geometry;
    camber_rings rings = {.stats = stats};
    size_t first = 0, points = 0, lines = 0;
    double sign = 0.0;
    stats->closed_rings += geometry->closed_rings;
    for (size_t i = 0; i < geometry->line_count; i++) {
        double *ring = geometry->points + 2 * first;
        const double area = camber_ring_area(ring, geometry->ends[i] - first);
        sign = sign != 0.0 ? sign : area;
        const size_t count = camber_rings_take(&rings, ring, geometry->ends[i] - first, area * sign < 0.0);
        stats->turned_rings += count && sign < 0.0;
        memmove(geometry->points + 2 * points, ring, 2 * count * sizeof *ring);
        first = geometry->ends[i];
        points += count;
        if (count)
            geometry->ends[lines++] = points;
    }
    geometry->line_count = lines;
    geometry->point_count = points;
}

/* Reads a feature that is to be drawn. *kept: the feature has points. */
static camber_status read_kind(camber_mvt *mvt, const tile_feature *feature, camber_geometry_kind kind, bool *kept,
                               const char **damage) {
    const camber_status status = read_geometry(mvt, feature, kind);
    *damage = *damage ? *damage : mvt->geometry.damage;
    *kept = *kept || mvt->geometry.line_count;
    if (status == CAMBER_OK && kind == CAMBER_GEOMETRY_AREA)
        take_rings(mvt, &mvt->desc.features->stats);
    return status == CAMBER_OK && mvt->geometry.line_count ? add_to_stitcher(mvt, feature, kind, damage) : status;
}

/* Reads a feature for symbol layers, if one takes it. The stitcher gets a point as a line of one point. */
static camber_status read_label(camber_mvt *mvt, const tile_feature *feature, camber_geometry_kind kind, bool *kept,
                                const char **damage) {
    camber_features_stats ignored = {0};
    camber_tile_feature stitched;
    camber_status status = find_class(mvt, feature, kind, &stitched, damage);
    const bool taken = status == CAMBER_OK && camber_features_draw_class(mvt->desc.features, stitched.class_index);
    *kept = *kept || (status == CAMBER_OK && !taken);
    if (!taken)
        return status;
    status = read_geometry(mvt, feature, kind);
    *damage = *damage ? *damage : mvt->geometry.damage;
    *kept = *kept || mvt->geometry.line_count;
    if (status != CAMBER_OK || !mvt->geometry.line_count)
        return status;
    if (kind == CAMBER_GEOMETRY_LABEL_AREA)
        take_rings(mvt, &ignored);
    if (kind == CAMBER_GEOMETRY_LABEL_POINT)
        keep_own_points(mvt);
    stitched.has_progress = false;
    const camber_tile_lines lines = {mvt->geometry.points, mvt->geometry.ends, mvt->geometry.line_count};
    return camber_tile_stitcher_add(mvt->desc.labels, &stitched, &lines);
}

static camber_status read_feature(camber_mvt *mvt, ProtobufCBinaryData bytes) {
    const tile_feature *feature = camber__tile__feature__unpack(&mvt->pool.allocator, bytes.len, bytes.data);
    if (!feature)
        return judge_failure(mvt, "a feature that does not parse");
    mvt->stats.features++;
    const unsigned polygons = CAMBER_KIND_POLYGON | CAMBER_KINDS_OF_AREAS;
    const unsigned of_type[] = {0, CAMBER_KINDS_OF_POINTS, CAMBER_KIND_LINE | CAMBER_KIND_LABEL_LINE, polygons};
    const unsigned kinds = mvt->kinds & of_type[(unsigned)feature->type <= 3 ? feature->type : 0];
    mvt->stats.skipped_features += !kinds;
    camber_status status = CAMBER_OK;
    const char *damage = NULL;
    bool kept = false;
    for (int kind = 0; kind < CAMBER_GEOMETRY_KINDS && status == CAMBER_OK; kind++) {
        if (!(kinds >> kind & 1))
            continue;
        status = camber_geometry_is_label((camber_geometry_kind)kind)
                     ? read_label(mvt, feature, (camber_geometry_kind)kind, &kept, &damage)
                     : read_kind(mvt, feature, (camber_geometry_kind)kind, &kept, &damage);
    }
    mvt->stats.kept_features += kept;
    if (damage)
        note_damage(mvt, damage);
    return status;
}

/* ---- A layer ---- */

/* Returns the kinds of geometry to read from the layer. */
static unsigned wanted_kinds(const camber_mvt *mvt) {
    const camber_mvt_desc *desc = &mvt->desc;
    const unsigned labels = desc->labels ? camber_features_label_kinds(desc->features) : 0u;
    for (size_t i = 0; i < desc->layer_count; i++) {
        if (strcmp(desc->layers[i], mvt->name) != 0)
            continue;
        if (desc->layer_kinds)
            return desc->layer_kinds[i];
        if (mvt->unsorted)
            return camber_features_kinds(desc->features, true);
        if (camber_schema_only_labels_layer(desc->features->schema, mvt->name))
            return labels;
        return labels | CAMBER_KIND_LINE | (desc->wants_polygons ? CAMBER_KIND_POLYGON : 0u) |
               (desc->wants_areas ? CAMBER_KIND_AREA : 0u) | (desc->wants_points ? CAMBER_KIND_POINT : 0u);
    }
    return 0;
}

/* Adds the layer to the list of layers, if the caller named no layers and wants to know which there are. */
static camber_status list_layer(camber_mvt *mvt) {
    size_t i = 0;
    while (i < mvt->layer_count && strcmp(mvt->layers[i].name, mvt->name) != 0)
        i++;
    if (i == MOST_LAYERS || (i < mvt->layer_count && mvt->layers[i].has_lines))
        return CAMBER_OK;
    if (i == mvt->layer_count) {
        if (!camber_grow(mvt->context, &mvt->layers, &mvt->layer_capacity, i + 1, sizeof *mvt->layers))
            return CAMBER_ERROR_MEMORY;
        mvt->layers[i] = (camber_mvt_layer){.name = camber_copy_string(mvt->context, mvt->name)};
        if (!mvt->layers[i].name)
            return CAMBER_ERROR_MEMORY;
        mvt->layer_count++;
    }
    const size_t count = mvt->layer->n_features < PEEKED_FEATURES ? mvt->layer->n_features : PEEKED_FEATURES;
    for (size_t k = 0; k < count && !mvt->layers[i].has_lines; k++) {
        const ProtobufCBinaryData bytes = mvt->layer->features[k];
        const tile_feature *feature = camber__tile__feature__unpack(&mvt->pool.allocator, bytes.len, bytes.data);
        mvt->layers[i].has_lines = feature && feature->type == 2;
    }
    return mvt->pool.out_of_memory ? CAMBER_ERROR_MEMORY : CAMBER_OK;
}

static camber_status read_layer(camber_mvt *mvt, ProtobufCBinaryData bytes) {
    tile_layer *layer = camber__tile__layer__unpack(&mvt->pool.allocator, bytes.len, bytes.data);
    if (!layer)
        return judge_failure(mvt, "a layer that does not parse");
    const char *name = to_text(mvt, layer->name);
    if (!name)
        return judge_failure(mvt, "a layer's name");
    snprintf(mvt->name, sizeof mvt->name, "%s", name);
    mvt->layer = layer;
    if (!mvt->desc.layers)
        return list_layer(mvt);
    mvt->unsorted = mvt->desc.unsorted &&
                    (mvt->desc.no_schema || !camber_schema_names_layer(mvt->desc.features->schema, mvt->name));
    mvt->kinds = wanted_kinds(mvt);
    if (!mvt->kinds)
        return CAMBER_OK;
    if (layer->extent == 0 || (layer->has_version && (layer->version < 1 || layer->version > 2))) {
        note_damage(mvt, layer->extent ? "its version is neither 1 nor 2" : "its extent is 0");
        return CAMBER_OK;
    }
    mvt->desc.stitcher->grid = fmax(mvt->desc.stitcher->grid, CAMBER_TILE_UNITS / layer->extent);
    if (mvt->desc.labels)
        mvt->desc.labels->grid = mvt->desc.stitcher->grid;
    camber_status status = camber_features_find_layer(mvt->desc.features, mvt->name, &mvt->layer_index);
    if (status == CAMBER_OK && !find_keys(mvt))
        status = judge_failure(mvt, "a layer's keys");
    if (status != CAMBER_OK || mvt->pool.exhausted)
        return status;
    const camber_pool_mark mark = camber_pool_here(&mvt->pool);
    for (size_t i = 0; i < layer->n_features && status == CAMBER_OK; i++) {
        status = read_feature(mvt, layer->features[i]);
        camber_pool_reset(&mvt->pool, mark);
    }
    return status;
}

camber_status camber_mvt_read(camber_mvt *mvt, const camber_tile_address *address, const void *bytes,
                              size_t size_bytes) {
    const camber_pool_mark start = {0};
    camber_pool_reset(&mvt->pool, start);
    mvt->address = *address;
    mvt->name[0] = 0;
    const Camber__Tile__Tile *tile = camber__tile__tile__unpack(&mvt->pool.allocator, size_bytes, bytes);
    if (!tile)
        return judge_failure(mvt, "it is not a vector tile");
    const camber_pool_mark mark = camber_pool_here(&mvt->pool);
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < tile->n_layers && status == CAMBER_OK; i++) {
        mvt->name[0] = 0;
        status = read_layer(mvt, tile->layers[i]);
        camber_pool_reset(&mvt->pool, mark);
    }
    return status;
}

void camber_mvt_spoil(camber_mvt *mvt, const camber_tile_address *address, const char *cause) {
    mvt->address = *address;
    mvt->name[0] = 0;
    note_damage(mvt, cause);
}

/* ---- Reader ---- */

camber_status camber_mvt_create(camber_context *context, const camber_mvt_desc *desc, camber_mvt **mvt) {
    const size_t properties = desc->features->schema->property_count;
    camber_mvt *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = made->geometry.context = context;
    made->desc = *desc;
    camber_pool_init(&made->pool, context, LARGEST_TILE_BYTES);
    if (!(made->sorted = camber_alloc(context, properties, sizeof *made->sorted)) ||
        !(made->values = camber_alloc(context, properties, sizeof *made->values))) {
        camber_mvt_destroy(made);
        return CAMBER_ERROR_MEMORY;
    }
    sort_properties(made);
    *mvt = made;
    return CAMBER_OK;
}

void camber_mvt_destroy(camber_mvt *mvt) {
    if (!mvt)
        return;
    camber_context *context = mvt->context;
    for (size_t i = 0; i < mvt->layer_count; i++)
        camber_free(context, mvt->layers[i].name);
    camber_free(context, mvt->layers);
    camber_mvt_geometry_free(&mvt->geometry);
    camber_free(context, mvt->values);
    camber_free(context, mvt->sorted);
    camber_pool_free(&mvt->pool);
    camber_free(context, mvt);
}

const camber_mvt_stats *camber_mvt_get_stats(const camber_mvt *mvt) {
    return &mvt->stats;
}

const camber_mvt_layer *camber_mvt_layers(const camber_mvt *mvt, size_t *count) {
    *count = mvt->layer_count;
    return mvt->layers;
}
