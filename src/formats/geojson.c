/* Reads a GeoJSON source of a style into a set of features.
 *
 * Input: a JSON document and the source's filter. Output: features with lines, outlines, areas or points, their classes
 * and their ids. Damage is counted and is not fatal: a line is split at points that are not valid, and the readable
 * parts of a feature are kept.
 */
#include "formats/geojson.h"
#include "features/mercator.h"
#include "features/rings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* how deep collections may be nested */
enum { DEEPEST = 32 };
enum { POLYGONS = CAMBER_KIND_POLYGON | CAMBER_KINDS_OF_AREAS };

/* A line may continue beyond the antimeridian, but not circle the Earth. */
static const double FARTHEST_DEG = 540.0;

typedef struct reader {
    camber_context *context;
    camber_features *features;
    const camber_geojson_desc *desc;
    camber_geojson_stats *stats; /* counts for the geometry that is being read: the caller's, or label_stats */
    camber_geojson_stats label_stats;
    camber_features_stats label_rings;
    const json_t *promote_id;
    bool generate_id;
    unsigned kinds; /* CAMBER_KIND_*: those that are read */
    camber_rings rings;
    camber_value *values;
    double *points; /* the points of the line that is being read */
    size_t capacity;

    /* The feature being read. */
    size_t index;
    bool in_collection;
    const char *damage;
    bool left_out, added; /* added: the feature was added with the kind that is being read */
    camber_geometry_kind kind;
    uint32_t class_index;
} reader;

static void note_damage(reader *self, const char *cause) {
    if (!self->damage)
        self->damage = cause;
}

/* ---- Properties ---- */

static camber_status read_value(reader *self, const json_t *json, camber_value *value) {
    *value = (camber_value){0};
    if (!json)
        return CAMBER_OK;
    switch (json_typeof(json)) {
    case JSON_STRING:
        value->type = CAMBER_VALUE_STRING;
        return camber_features_intern(self->features, json_string_value(json), &value->string);
    case JSON_INTEGER:
    case JSON_REAL: *value = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = json_number_value(json)}; break;
    case JSON_TRUE:
    case JSON_FALSE: *value = (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = json_is_true(json)}; break;
    case JSON_NULL: value->boolean = true; break;
    default: {
        const camber_value *kept;
        const camber_status status = camber_features_intern_json(self->features, json, &kept);
        if (status != CAMBER_OK)
            return status;
        *value = *kept;
    }
    }
    return CAMBER_OK;
}

/* Reads an id. As in other engines, a text that contains a number counts as a number. */
static camber_status read_id(reader *self, const json_t *feature, const json_t *properties, camber_value *id) {
    const json_t *json = json_object_get(feature, "id");
    if (self->promote_id)
        json = json_object_get(properties, json_string_value(self->promote_id));
    if (self->generate_id) {
        *id = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = (double)self->index};
        return CAMBER_OK;
    }
    char *end = NULL;
    const char *text = json_string_value(json);
    const double number = text ? strtod(text, &end) : 0;
    if (text && *text && *end == 0 && isfinite(number) && !self->promote_id) {
        *id = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = number};
        return CAMBER_OK;
    }
    if (json_is_array(json) || json_is_object(json) || json_is_null(json))
        json = NULL;
    return read_value(self, json, id);
}

/* Finds the feature's class for the current kind. *drawn: the source's filter accepts the feature. */
static camber_status find_class(reader *self, const json_t *feature, bool *drawn) {
    const camber_schema *schema = self->features->schema;
    const json_t *properties = json_object_get(feature, "properties");
    camber_feature_class wanted = {.geometry = self->kind, .unsorted = self->desc->unsorted};
    const char *layer = self->desc->layer ? self->desc->layer : "";
    camber_value id = {0};
    camber_status status = camber_features_find_layer(self->features, layer, &wanted.layer);
    for (size_t i = 0; i < schema->property_count; i++)
        self->values[i] = (camber_value){0};
    for (size_t i = 0; i < schema->property_count && status == CAMBER_OK; i++)
        if (camber_features_reads_property(self->features, i))
            status = read_value(self, json_object_get(properties, schema->properties[i]), &self->values[i]);
    if (status == CAMBER_OK)
        status = read_id(self, feature, properties, &id);
    if (status == CAMBER_OK && schema->wants_all_properties && json_is_object(properties))
        status = camber_features_intern_json(self->features, properties, &wanted.all);
    if (status != CAMBER_OK)
        return status;
    const camber_feature_view view = {
        .values = self->values, .geometry_type = camber_geometry_type(self->kind), .id = id, .all = wanted.all};
    *drawn = !self->desc->matches || self->desc->matches(self->desc->user, &view);
    if (schema->wants_id)
        wanted.id = id;
    if (*drawn)
        status = camber_features_find_class_of(self->features, &wanted, self->values, &self->class_index);
    if (*drawn && status == CAMBER_OK && camber_geometry_is_label(self->kind))
        *drawn = camber_features_draw_class(self->features, self->class_index);
    return status;
}

/* ---- Geometry ---- */

/* Whether the value stands for a number that JSON cannot express: null for NaN, or a number beyond a double's range for
 * an infinity. */
static bool is_no_number(const json_t *json) {
    return json_is_null(json) || fabs(json_number_value(json)) >= CAMBER_JSON_INFINITE;
}

/* Reads a position. A point that is not valid, as described at CAMBER_ERROR_INPUT, becomes a pair of NaN. Returns false
 * if this is not a position. */
static bool read_position(const json_t *json, double position[2]) {
    const json_t *longitude = json_array_get(json, 0), *latitude = json_array_get(json, 1);
    if (is_no_number(longitude) || is_no_number(latitude)) {
        position[0] = position[1] = NAN;
        return true;
    }
    if (!json_is_number(longitude) || !json_is_number(latitude))
        return false;
    const double lon = json_number_value(longitude), lat = json_number_value(latitude);
    if (!(fabs(lon) <= FARTHEST_DEG && isfinite(lat)))
        return false;
    camber_mercator_project(lon, fmin(fmax(lat, -CAMBER_MERCATOR_LATITUDE), CAMBER_MERCATOR_LATITUDE), &position[0],
                            &position[1]);
    return true;
}

static void add_bounds(double bounds[4], const double *points, size_t count) {
    const bool empty = bounds[0] > bounds[2];
    for (size_t i = 0; i < count; i++) {
        const double x = points[2 * i], y = points[2 * i + 1];
        const bool first = empty && i == 0;
        bounds[0] = first ? x : fmin(bounds[0], x);
        bounds[1] = first ? y : fmin(bounds[1], y);
        bounds[2] = first ? x : fmax(bounds[2], x);
        bounds[3] = first ? y : fmax(bounds[3], y);
    }
}

/* A feature with several lines is added once. */
static camber_status add_line(reader *self, const double *points, size_t count) {
    camber_status status = CAMBER_OK;
    if (!self->added)
        status = camber_features_add_feature(self->features, self->class_index);
    self->added = true;
    add_bounds(self->stats->bounds, points, count);
    return status == CAMBER_OK ? camber_features_add_polyline(self->features, points, count) : status;
}

/* Adds the line that was read, split at points that are not valid. */
static camber_status add_parts(reader *self, size_t count) {
    camber_status status = CAMBER_OK;
    size_t first = 0;
    for (size_t i = 0; i <= count && status == CAMBER_OK; i++) {
        if (i < count && !isnan(self->points[2 * i]))
            continue;
        if (i > first)
            status = add_line(self, self->points + 2 * first, i - first);
        self->stats->invalid_points += i < count;
        first = i + 1;
    }
    return status;
}

/* Turns a ring so that an outline goes clockwise on the map, with its inside to the right, and a hole
 * counter-clockwise. */
static void orient_ring(double *points, size_t count, bool hole) {
    double area = 0.0;
    for (size_t i = 0; i + 1 < count; i++) {
        const double part = (points[2 * i] - points[0]) * (points[2 * i + 3] - points[1]) -
                            (points[2 * i + 1] - points[1]) * (points[2 * i + 2] - points[0]);
        area += isnan(part) ? 0.0 : part;
    }
    if ((area < 0.0) != hole)
        camber_ring_turn(points, count);
}

/* Adds the ring that was read as a part of an area. If outlines are read, too, its invalid points were already counted
 * with the outline. */
static camber_status add_ring(reader *self, size_t count, bool hole) {
    for (size_t i = 0; i < count && !(self->kinds & CAMBER_KIND_POLYGON); i++)
        self->stats->invalid_points += isnan(self->points[2 * i]) != 0;
    count = camber_rings_take(&self->rings, self->points, count, hole);
    return count ? add_line(self, self->points, count) : CAMBER_OK;
}

static camber_status read_line(reader *self, const json_t *json, bool hole) {
    const bool ring = self->kind != CAMBER_GEOMETRY_LINE, area = self->kind == CAMBER_GEOMETRY_AREA;
    const size_t announced = json_array_size(json);
    size_t count = 0;
    if (!camber_grow(self->context, &self->points, &self->capacity, announced + 1, 2 * sizeof *self->points))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < announced; i++) {
        if (read_position(json_array_get(json, i), self->points + 2 * count))
            count++;
        else
            note_damage(self, "a position that is not a longitude and a latitude");
    }
    if (count < 2) {
        note_damage(self, "a line of fewer than two positions");
        return CAMBER_OK;
    }
    const double *last = self->points + 2 * (count - 1);
    if (ring &&
        (fabs(last[0] - self->points[0]) > 0 || fabs(last[1] - self->points[1]) > 0)) { /* both points are valid */
        note_damage(self, "a ring that is not closed");
        if (!area)
            memcpy(self->points + 2 * count++, self->points, 2 * sizeof *self->points);
    }
    if (area)
        return add_ring(self, count, hole);
    if (ring && self->features->schema->directed)
        orient_ring(self->points, count, hole);
    return add_parts(self, count);
}

/* A point becomes a line of one point. */
static camber_status read_point(reader *self, const json_t *json) {
    double position[2];
    if (!read_position(json, position)) {
        note_damage(self, "a position that is not a longitude and a latitude");
        return CAMBER_OK;
    }
    if (!isnan(position[0]))
        return add_line(self, position, 1);
    self->stats->invalid_points++;
    return CAMBER_OK;
}

/* Reads lines or points. depth: how deep they are nested in the coordinates. hole: the lines after the first are holes
 * of a polygon. */
static camber_status read_lines(reader *self, const json_t *json, int depth, bool hole) {
    if (!json_is_array(json)) {
        note_damage(self, "coordinates that are not an array");
        return CAMBER_OK;
    }
    if (depth == 0)
        return self->kind == CAMBER_GEOMETRY_POINT ? read_point(self, json) : read_line(self, json, hole);
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < json_array_size(json) && status == CAMBER_OK; i++)
        status = read_lines(self, json_array_get(json, i), depth - 1, depth == 1 && i > 0);
    return status;
}

static camber_status read_geometry(reader *self, const json_t *geometry, int depth) {
    static const struct {
        const char *name;
        int depth;
        unsigned kinds;
    } types[] = {{"LineString", 0, CAMBER_KIND_LINE},
                 {"MultiLineString", 1, CAMBER_KIND_LINE},
                 {"Polygon", 1, POLYGONS},
                 {"MultiPolygon", 2, POLYGONS},
                 {"Point", 0, CAMBER_KIND_POINT},
                 {"MultiPoint", 1, CAMBER_KIND_POINT}};
    const char *type = json_string_value(json_object_get(geometry, "type"));
    if (type && strcmp(type, "GeometryCollection") == 0 && depth < DEEPEST) {
        const json_t *parts = json_object_get(geometry, "geometries");
        camber_status status = CAMBER_OK;
        for (size_t i = 0; i < json_array_size(parts) && status == CAMBER_OK; i++)
            status = read_geometry(self, json_array_get(parts, i), depth + 1);
        return status;
    }
    size_t i = 0;
    while (i < sizeof types / sizeof *types && (!type || strcmp(types[i].name, type) != 0))
        i++;
    if (i == sizeof types / sizeof *types) {
        note_damage(self, "a geometry of an unknown type");
        return CAMBER_OK;
    }
    if (!(types[i].kinds >> self->kind & 1))
        return CAMBER_OK;
    return read_lines(self, json_object_get(geometry, "coordinates"), types[i].depth, false);
}

/* Whether a geometry, or any part of a collection, is of this kind. */
static bool has_kind(const json_t *geometry, camber_geometry_kind kind, int depth) {
    const char *type = json_string_value(json_object_get(geometry, "type"));
    if (!type)
        return false;
    if (strcmp(type, "GeometryCollection") == 0 && depth < DEEPEST) {
        const json_t *parts = json_object_get(geometry, "geometries");
        for (size_t i = 0; i < json_array_size(parts); i++)
            if (has_kind(json_array_get(parts, i), kind, depth + 1))
                return true;
        return false;
    }
    return strstr(type, camber_geometry_type(kind)) != NULL;
}

/* ---- Features ---- */

static void end_feature(reader *self) {
    camber_geojson_stats *stats = self->stats;
    stats->skipped_features += self->left_out;
    if (!self->damage || stats->damaged_features++)
        return;
    if (self->in_collection)
        snprintf(stats->damage, sizeof stats->damage, "/features/%zu: %s", self->index, self->damage);
    else
        snprintf(stats->damage, sizeof stats->damage, "%s", self->damage);
}

/* Reads the feature's geometry of the current kind. If the kind is a label's, a symbol layer must take the feature, and
 * its defects are counted separately. */
static camber_status read_kind(reader *self, const json_t *feature, const json_t *geometry) {
    const camber_geometry_kind kind = self->kind;
    const bool label = camber_geometry_is_label(kind);
    camber_geojson_stats *stats = self->stats;
    camber_features_stats *rings = self->rings.stats;
    bool drawn = false;
    self->added = false;
    camber_status status = find_class(self, feature, &drawn);
    if (status != CAMBER_OK || !drawn)
        return status;
    self->kind = camber_geometry_shape(kind);
    self->stats = label ? &self->label_stats : stats;
    self->rings.stats = label ? &self->label_rings : rings;
    status = read_geometry(self, geometry, 0);
    self->stats = stats;
    self->rings.stats = rings;
    return status;
}

static camber_status read_feature(reader *self, const json_t *feature, const json_t *geometry) {
    self->damage = NULL;
    self->left_out = !geometry || json_is_null(geometry);
    camber_status status = CAMBER_OK;
    bool any = self->left_out;
    unsigned read = 0, unread = 0;
    for (int kind = 0; kind < CAMBER_GEOMETRY_KINDS && status == CAMBER_OK; kind++) {
        self->kind = (camber_geometry_kind)kind;
        if (!has_kind(geometry, self->kind, 0))
            continue;
        any = true;
        if (!(self->kinds >> kind & 1)) {
            unread |= 1u << kind;
            continue;
        }
        read |= 1u << kind;
        status = read_kind(self, feature, geometry);
    }
    self->kind = CAMBER_GEOMETRY_LINE;
    if (!any)
        status = read_geometry(self, geometry, 0); /* this reports the unknown type */
    self->left_out |= (unread & CAMBER_KIND_LINE && !(read & CAMBER_KIND_LABEL_LINE)) ||
                      (unread & CAMBER_KIND_POINT && !(read & CAMBER_KIND_LABEL_POINT)) ||
                      (unread & POLYGONS && !(read & POLYGONS));
    end_feature(self);
    return status;
}

static camber_status read_root(reader *self) {
    const json_t *root = self->desc->root, *list = json_object_get(root, "features");
    const char *type = json_string_value(json_object_get(root, "type"));
    if (type && strcmp(type, "Feature") == 0)
        return read_feature(self, root, json_object_get(root, "geometry"));
    if (type && (json_is_array(json_object_get(root, "coordinates")) || strcmp(type, "GeometryCollection") == 0))
        return read_feature(self, NULL, root);
    if (!type || strcmp(type, "FeatureCollection") != 0 || !json_is_array(list))
        return camber_fail(self->context, CAMBER_ERROR_INPUT,
                           "%s: not GeoJSON; it must be a FeatureCollection with features, a Feature or a geometry",
                           self->desc->what);
    camber_status status = CAMBER_OK;
    self->in_collection = true;
    for (; self->index < json_array_size(list) && status == CAMBER_OK; self->index++) {
        const json_t *feature = json_array_get(list, self->index);
        status = read_feature(self, feature, json_object_get(feature, "geometry"));
    }
    return status;
}

camber_status camber_geojson_read(camber_features *features, const camber_geojson_desc *desc,
                                  camber_geojson_stats *stats) {
    reader self = {.context = features->context,
                   .features = features,
                   .desc = desc,
                   .stats = stats,
                   .promote_id = json_is_string(desc->promote_id) ? desc->promote_id : NULL,
                   .generate_id = desc->generates_ids,
                   .rings.stats = &features->stats};
    self.kinds = desc->kinds;
    if (!desc->kinds)
        self.kinds = CAMBER_KIND_POLYGON | camber_features_kinds(features, false);
    *stats = self.label_stats = (camber_geojson_stats){.bounds = {1, 1, 0, 0}};
    self.values = camber_alloc(features->context, features->schema->property_count, sizeof *self.values);
    const camber_status status = self.values ? read_root(&self) : CAMBER_ERROR_MEMORY;
    if (stats->bounds[0] > stats->bounds[2]) /* it has only labels */
        memcpy(stats->bounds, self.label_stats.bounds, sizeof stats->bounds);
    camber_free(features->context, self.points);
    camber_free(features->context, self.values);
    return status;
}
