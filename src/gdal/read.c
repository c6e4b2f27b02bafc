/* Reads the features of a file into a set of features with GDAL.
 *
 * Input: a path and a selection (layer, attribute filter). Output: features whose polylines are merged and have
 * importance, or an error, after which the set is unchanged. This file has the module's entry point: camber_gdal.
 */
#include "features/gdal_calls.h"
#include "gdal/vector_file.h"
#include "gdal/xml_order.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <string.h>

static const double PROGRESS_MS = 50;
/* The clock is read once per this many features. */
enum { PROGRESS_FEATURES = 64 };

/* A layer of the OSM driver that is read together with the lines: the areas that relations make from ways, or the
 * nodes. */
typedef struct osm_layer {
    OGRLayerH handle;
    uint32_t index;
    unsigned kinds; /* CAMBER_KIND_*: the kinds that are read from it */
    camber_columns columns;
} osm_layer;

enum { MOST_OTHERS = 2 };

typedef struct reader {
    camber_context *context;
    camber_features *features;
    const camber_source_desc *desc;
    camber_dataset dataset;
    camber_feature_lines lines;
    camber_tile_stitcher *stitcher; /* NULL: the file is not vector tiles */
    camber_tile_stitcher *labels;   /* the stitcher for labels, which must not change how other lines are joined */

    /* The layer that is being read. */
    OGRLayerH layer;
    uint32_t layer_index;
    camber_columns columns;

    camber_features_stats stats;   /* counts for this file */
    char damage[512];              /* a message about the first damaged feature */
    size_t read;                   /* how many features of this layer were read so far */
    osm_layer others[MOST_OTHERS]; /* other_count */
    size_t other_count;
    bool boxed;    /* the layer is read by its index, for a region */
    bool failed;   /* OGR reported a failure for the last feature */
    size_t passed; /* how many features of all layers were read so far */
    double shown_ms;
} reader;

/* ---- Set-up for a layer ---- */

/* Returns CAMBER_ERROR_ARGUMENT without logging anything if the attribute filter does not fit the layer. */
static camber_status begin_layer(reader *self, int index) {
    self->layer = GDALDatasetGetLayer(self->dataset.handle, index);
    OGRFeatureDefnH schema = OGR_L_GetLayerDefn(self->layer);
    camber_status status = camber_features_find_layer(self->features, OGR_L_GetName(self->layer), &self->layer_index);
    if (status == CAMBER_OK)
        status = camber_feature_lines_set_srs(&self->lines, OGR_L_GetSpatialRef(self->layer), self->desc->path);
    if (status == CAMBER_OK)
        status = camber_columns_find(&self->columns, self->features, schema, self->stitcher, self->dataset.osm);
    if (status != CAMBER_OK)
        return status;
    self->lines.kinds = camber_features_kinds(self->features, self->columns.unsorted);
    /* A filter may read any field, so if there is one, no field may be ignored. */
    if (!self->desc->where)
        camber_columns_ignore_others(&self->columns, self->layer);
    self->dataset.errors = (camber_gdal_errors){0};
    if (self->desc->where && OGR_L_SetAttributeFilter(self->layer, self->desc->where) != OGRERR_NONE)
        return CAMBER_ERROR_ARGUMENT;
    OGR_L_ResetReading(self->layer);
    return CAMBER_OK;
}

static camber_status begin_other(reader *self, OGRLayerH layer) {
    osm_layer *other = &self->others[self->other_count++];
    *other = (osm_layer){.handle = layer, .kinds = CAMBER_KINDS_OF_AREAS};
    if (strcmp(OGR_L_GetName(layer), "points") == 0)
        other->kinds = CAMBER_KINDS_OF_POINTS;
    if (self->desc->where)
        OGR_L_SetAttributeFilter(layer, self->desc->where); /* the layer of lines decides whether the filter fits */
    camber_status status = camber_features_find_layer(self->features, OGR_L_GetName(layer), &other->index);
    if (status == CAMBER_OK)
        status = camber_columns_find(&other->columns, self->features, OGR_L_GetLayerDefn(layer), false, false);
    other->columns.unsorted = false;
    return status;
}

/* Tells the OSM driver which layers are read. It then skips the others, which is twice as fast. The driver returns the
 * features of all layers in one stream. */
static camber_status begin_osm(reader *self, const int *layers, size_t count) {
    GDALDatasetH handle = self->dataset.handle;
    char names[64] = "";
    for (size_t i = 0; i < count; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i ? "," : "",
                 OGR_L_GetName(GDALDatasetGetLayer(handle, layers[i])));
    GDALDatasetReleaseResultSet(
        handle, GDALDatasetExecuteSQL(handle, CPLSPrintf("SET interest_layers = %s", names), NULL, NULL));
    camber_status status = CAMBER_OK;
    for (size_t i = 1; i < count && i <= MOST_OTHERS && status == CAMBER_OK; i++)
        status = begin_other(self, GDALDatasetGetLayer(handle, layers[i]));
    return status;
}

/* ---- One feature ---- */

/* Finds the tile that contains a feature. OGR's drivers encode it in the feature's number: the column in the low bits,
 * then the row, then the feature's number in the tile. If the tile contradicts the feature's coordinates, the middle of
 * the feature decides. */
static void find_tile(const reader *self, OGRFeatureH feature, camber_tile_feature *tile) {
    const int zoom = self->dataset.zoom;
    const double side = ldexp(1.0, zoom);
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < self->lines.world.point_count; i++) {
        for (int axis = 0; axis < 2; axis++) {
            low[axis] = fmin(low[axis], self->lines.world.points[2 * i + (size_t)axis] * side);
            high[axis] = fmax(high[axis], self->lines.world.points[2 * i + (size_t)axis] * side);
        }
    }
    const GIntBig number = OGR_F_GetFID(feature), mask = ((GIntBig)1 << zoom) - 1;
    tile->column = (uint32_t)(number & mask);
    tile->row = (uint32_t)(number >> zoom & mask);
    /* Buffers are at most half a tile wide. */
    if (number >= 0 && low[0] <= tile->column + 1.5 && high[0] >= tile->column - 0.5 && low[1] <= tile->row + 1.5 &&
        high[1] >= tile->row - 0.5)
        return;
    tile->column = (uint32_t)fmin(fmax(floor((low[0] + high[0]) / 2), 0), side - 1);
    tile->row = (uint32_t)fmin(fmax(floor((low[1] + high[1]) / 2), 0), side - 1);
}

/* Returns the other layer to which a feature belongs, or NULL if it belongs to the current one. */
static osm_layer *find_other(reader *self, OGRFeatureH feature) {
    for (size_t i = 0; i < self->other_count; i++)
        if (OGR_F_GetDefnRef(feature) == OGR_L_GetLayerDefn(self->others[i].handle))
            return &self->others[i];
    return NULL;
}

/* Finds the class of a feature. *kept: the feature belongs to the set. */
static camber_status find_class(reader *self, OGRFeatureH feature, camber_geometry_kind kind, uint32_t *index,
                                bool *kept) {
    osm_layer *other = find_other(self, feature);
    const camber_status status = camber_columns_class(other ? &other->columns : &self->columns, feature,
                                                      other ? other->index : self->layer_index, kind, index);
    *kept = status == CAMBER_OK && camber_features_draw_class(self->features, *index);
    return status;
}

/* Drops the points of a label that are outside their tile, because the neighbouring tile has them, too. */
static void keep_own_points(camber_world_lines *world, const camber_tile_feature *tile, int zoom) {
    size_t kept = 0;
    for (size_t i = 0; i < world->point_count; i++) {
        const double *point = world->points + 2 * i;
        if (floor(ldexp(point[0], zoom)) != tile->column || floor(ldexp(point[1], zoom)) != tile->row)
            continue;
        memmove(world->points + 2 * kept, point, 2 * sizeof *point);
        world->ends[kept] = kept + 1;
        kept++;
    }
    world->point_count = world->line_count = kept;
}

static camber_status add_to_stitcher(reader *self, OGRFeatureH feature, camber_geometry_kind kind, uint32_t index) {
    camber_world_lines *world = &self->lines.world;
    camber_tile_feature tile = {
        .class_index = index, .outline = kind == CAMBER_GEOMETRY_POLYGON, .area = camber_geometry_is_area(kind)};
    find_tile(self, feature, &tile);
    tile.has_id = camber_columns_id(&self->columns, feature, &tile.id);
    if (kind == CAMBER_GEOMETRY_LABEL_POINT)
        keep_own_points(world, &tile, self->dataset.zoom);
    const camber_tile_lines lines = {world->points, world->ends, world->line_count};
    return camber_tile_stitcher_add(camber_geometry_is_label(kind) ? self->labels : self->stitcher, &tile, &lines);
}

/* Adds the collected geometry of a feature to the set or to a stitcher. */
static camber_status add_to_features(reader *self, OGRFeatureH feature, camber_geometry_kind kind, uint32_t index) {
    if (self->stitcher)
        return add_to_stitcher(self, feature, kind, index);
    camber_status status = camber_features_add_feature(self->features, index);
    size_t first = 0;
    for (size_t i = 0; i < self->lines.world.line_count && status == CAMBER_OK; i++) {
        status = camber_features_add_polyline(self->features, self->lines.world.points + 2 * first,
                                              self->lines.world.ends[i] - first);
        first = self->lines.world.ends[i];
    }
    return status;
}

/* Collects the geometry of one kind from a feature. way: the geometry is the ring of an area, which OGR takes for a
 * line. */
static camber_status collect(reader *self, OGRGeometryH geometry, camber_geometry_kind kind, bool way) {
    camber_feature_lines *lines = &self->lines;
    if (kind != CAMBER_GEOMETRY_AREA)
        return camber_feature_lines_collect(lines, geometry, way ? CAMBER_GEOMETRY_LINE : kind);
    const size_t invalid = lines->invalid_points, clamped = lines->world.clamped_points;
    const camber_status status =
        way ? camber_feature_lines_collect_ring(lines, geometry) : camber_feature_lines_collect(lines, geometry, kind);
    if (lines->kinds & CAMBER_KIND_POLYGON) { /* these points were already counted with the outlines */
        lines->invalid_points = invalid;
        lines->world.clamped_points = clamped;
    }
    return status;
}

static camber_status read_kind(reader *self, OGRFeatureH feature, camber_geometry_kind kind, bool way) {
    uint32_t index = 0;
    bool kept = true;
    camber_status status = collect(self, OGR_F_GetGeometryRef(feature), kind, way);
    if (status == CAMBER_OK && self->lines.world.line_count)
        status = find_class(self, feature, kind, &index, &kept);
    return status == CAMBER_OK && self->lines.world.line_count && kept ? add_to_features(self, feature, kind, index)
                                                                       : status;
}

/* Whether a geometry may contain labels of this kind; a collection may contain any kind. way: the geometry is the ring
 * of an area. */
static bool may_have(OGRGeometryH geometry, camber_geometry_kind kind, bool way) {
    const int dimension = way ? 2 : OGR_G_GetDimension(geometry);
    if (!way && wkbFlatten(OGR_G_GetGeometryType(geometry)) == wkbGeometryCollection)
        return true;
    return dimension == (kind == CAMBER_GEOMETRY_LABEL_POINT ? 0 : kind == CAMBER_GEOMETRY_LABEL_LINE ? 1 : 2);
}

/* Reads a feature for symbol layers, if one takes it. Its defects are not counted again, because they were counted when
 * the feature was read to be drawn. */
static camber_status read_label(reader *self, OGRFeatureH feature, camber_geometry_kind kind, bool way) {
    camber_feature_lines *lines = &self->lines;
    const camber_feature_lines before = *lines;
    camber_features_stats ignored = {0};
    uint32_t index;
    bool kept;
    if (!may_have(OGR_F_GetGeometryRef(feature), kind, way))
        return CAMBER_OK;
    camber_status status = find_class(self, feature, kind, &index, &kept);
    if (status != CAMBER_OK || !kept)
        return status;
    lines->rings.stats = &ignored;
    status = collect(self, OGR_F_GetGeometryRef(feature), camber_geometry_shape(kind), way);
    lines->rings.stats = before.rings.stats;
    lines->left_out = before.left_out;
    lines->damaged = before.damaged;
    lines->raw_points = before.raw_points;
    lines->strange_points = before.strange_points;
    lines->invalid_points = before.invalid_points;
    lines->world.clamped_points = before.world.clamped_points;
    lines->world.antimeridian_splits = before.world.antimeridian_splits;
    return status == CAMBER_OK && lines->world.line_count ? add_to_features(self, feature, kind, index) : status;
}

/* Reads a feature of the stream. failed: OGR reported a failure for this feature. */
static camber_status read_feature(reader *self, OGRFeatureH feature, bool failed) {
    camber_feature_lines *lines = &self->lines;
    OGRGeometryH geometry = OGR_F_GetGeometryRef(feature);
    lines->left_out = !geometry && !failed;
    lines->damaged = failed;
    const osm_layer *other = find_other(self, feature);
    const bool area = geometry && !other && camber_columns_is_area(&self->columns, feature, geometry);
    const unsigned areas = CAMBER_KIND_POLYGON | CAMBER_KINDS_OF_AREAS;
    const unsigned kinds = lines->kinds & (other ? other->kinds : area ? areas : ~0u);
    camber_status status = CAMBER_OK;
    for (int kind = 0; geometry && kind < CAMBER_GEOMETRY_KINDS && status == CAMBER_OK; kind++) {
        if (!(kinds >> kind & 1))
            continue;
        status = camber_geometry_is_label((camber_geometry_kind)kind)
                     ? read_label(self, feature, (camber_geometry_kind)kind, area)
                     : read_kind(self, feature, (camber_geometry_kind)kind, area);
    }
    self->stats.skipped_features += lines->left_out || (area && !(lines->kinds & areas));
    self->stats.damaged_features += lines->damaged;
    if (lines->damaged && self->damage[0] == 0)
        snprintf(self->damage, sizeof self->damage, "%s",
                 failed ? self->dataset.errors.message : "a geometry that does not parse");
    return status;
}

/* ---- The stream ---- */

/* If a shapefile is cut off, OGR returns each record past its end as a feature with a failure. That is a read error,
 * not damage to a feature. */
static bool is_read_error(const camber_gdal_errors *errors) {
    return errors->number == CPLE_FileIO || strstr(errors->message, "fread(") != NULL;
}

/* GDAL's message mentions OSM_USE_CUSTOM_INDEXING, but the driver's option is named USE_CUSTOM_INDEXING. */
static bool is_unsorted(const camber_gdal_errors *errors) {
    return strstr(errors->message, "USE_CUSTOM_INDEXING=NO") != NULL;
}

static camber_status fail_stream(reader *self, const char *cause) {
    return camber_fail(self->context, CAMBER_ERROR_INPUT,
                       "%s: cut off or damaged after %zu features: %s; get the file "
                       "again",
                       self->desc->path, self->read, cause);
}

/* expected: how many features there are; 0 if unknown. */
static void show_progress(reader *self, double fraction, uint64_t expected) {
    if (self->read % PROGRESS_FEATURES)
        return;
    const double now = camber_now_ms();
    if (now - self->shown_ms < PROGRESS_MS)
        return;
    self->shown_ms = now;
    camber_progress_tell(
        self->context,
        &(camber_progress_info){
            .stage = "reading", .fraction = fraction, .unit = "features", .done = self->read, .total = expected});
}

/* Reports progress while OpenStreetMap's nodes are read, which are not features. */
static int CPL_STDCALL show_node_progress(double fraction, const char *message, void *user) {
    reader *self = user;
    (void)message;
    const double now = camber_now_ms();
    if (now - self->shown_ms >= PROGRESS_MS) {
        self->shown_ms = now;
        camber_progress(self->context, "reading", fraction);
    }
    return TRUE;
}

static OGRFeatureH next_feature(reader *self, double *fraction) {
    if (self->dataset.errors.failures) {
        self->dataset.errors = (camber_gdal_errors){0};
        CPLErrorReset();
    }
    if (!self->dataset.osm)
        return OGR_L_GetNextFeature(self->layer);
    OGRLayerH layer = NULL;
    return GDALDatasetGetNextFeature(self->dataset.handle, &layer, fraction, show_node_progress, self);
}

/* Reads the features of a layer. expected: how many features the layer announces; negative if unknown. *unsorted: the
 * caller must start again and allow nodes in any order; then nothing is logged. */
static camber_status read_layer(reader *self, GIntBig expected, bool *unsorted) {
    camber_status status = CAMBER_OK;
    double fraction = -1;
    self->read = 0;
    while (status == CAMBER_OK) {
        OGRFeatureH feature = next_feature(self, &fraction);
        const camber_gdal_errors *errors = &self->dataset.errors;
        const bool failed = errors->failures && CPLGetLastErrorType() >= CE_Failure;
        if (failed && self->dataset.osm && is_unsorted(errors) && !*unsorted) {
            *unsorted = true;
            OGR_F_Destroy(feature);
            return CAMBER_ERROR_INPUT;
        }
        if (failed && (!feature || is_read_error(errors)))
            status = fail_stream(self, errors->message);
        if (!feature)
            break;
        if (status == CAMBER_OK) {
            self->read++;
            const bool counted = !self->dataset.osm && expected > 0 && self->read <= (size_t)expected;
            if (counted)
                fraction = (double)self->read / (double)expected;
            self->passed++;
            status = read_feature(self, feature, failed);
            show_progress(self, fraction, counted ? (uint64_t)expected : 0);
        }
        OGR_F_Destroy(feature);
    }
    return status;
}

/* ---- Reading by the index ---- */

static camber_status next_of_box(void *user, OGRFeatureH *feature) {
    reader *self = user;
    double fraction;
    *feature = next_feature(self, &fraction);
    const camber_gdal_errors *errors = &self->dataset.errors;
    self->failed = errors->failures && CPLGetLastErrorType() >= CE_Failure;
    return self->failed && (!*feature || is_read_error(errors)) ? fail_stream(self, errors->message) : CAMBER_OK;
}

static camber_status add_of_box(void *user, OGRFeatureH feature) {
    reader *self = user;
    self->read++;
    return read_feature(self, feature, self->failed);
}

/* Reads the layer for the set's region, if that is possible. If only features without lines are found, the whole layer
 * is read to find out the reason. */
static camber_status read_by_box(reader *self) {
    const camber_box_reading reading = {.features = self->features,
                                        .lines = &self->lines,
                                        .dataset = self->dataset.handle,
                                        .layer = self->layer,
                                        .has_srs = OGR_L_GetSpatialRef(self->layer) != NULL,
                                        .merges = !self->desc->keep_apart || self->features->wants_labels,
                                        .user = self,
                                        .next = next_of_box,
                                        .add = add_of_box};
    const size_t features = self->features->feature_count;
    self->read = 0;
    const camber_status status = camber_box_read(&reading, &self->boxed);
    const bool nothing =
        self->features->feature_count == features && (self->stats.skipped_features || self->stats.damaged_features);
    if (status != CAMBER_OK || (self->boxed && !nothing))
        return status;
    self->boxed = false;
    self->stats = (camber_features_stats){0};
    self->damage[0] = 0;
    return CAMBER_OK;
}

/* ---- Layers ---- */

/* A FlatGeobuf that is cut off simply ends, but its header states how many features there are. */
static camber_status check_count(reader *self, GIntBig expected) {
    const char *driver = GDALGetDriverShortName(GDALGetDatasetDriver(self->dataset.handle));
    if (self->desc->where || !EQUAL(driver, "FlatGeobuf") || expected < 0 || self->read >= (size_t)expected)
        return CAMBER_OK;
    return fail_stream(self, "its header announces more");
}

/* Fails for a filter that does not fit the layer. In OpenStreetMap data, every key is a field. */
static camber_status fail_where(const reader *self) {
    char fields[512] = "keys of OpenStreetMap, as in highway = 'primary'";
    if (!self->dataset.osm)
        camber_where_list_fields(self->layer, fields, sizeof fields);
    return camber_fail(self->context, CAMBER_ERROR_ARGUMENT,
                       "%s: the filter \"%s\" does not fit: %s; put values in single quotes, and use fields of layer "
                       "\"%s\": %s",
                       self->desc->path, self->desc->where,
                       self->dataset.errors.failures ? self->dataset.errors.message : "it cannot be parsed",
                       OGR_L_GetName(self->layer), fields);
}

/* Warns about a tag that no feature has. It is usually misspelt, or is a value that was put in double quotes. */
static void warn_where(const reader *self) {
    char key[256];
    if (self->dataset.osm && camber_where_find_unknown(&self->dataset, self->layer, key, sizeof key))
        camber_log(self->context, CAMBER_LOG_WARNING,
                   "%s: nothing passes the filter \"%s\": no feature has the tag \"%s\"; check it, and put values in "
                   "single quotes, as in highway = 'primary'",
                   self->desc->path, self->desc->where, key);
    else
        camber_log(self->context, CAMBER_LOG_WARNING,
                   "%s: nothing passes the filter \"%s\"; check the values that it compares with", self->desc->path,
                   self->desc->where);
}

static camber_status read_layers(reader *self, const int *layers, size_t count, bool *unsorted) {
    bool any = false;
    for (size_t i = 0; i < count; i++) {
        camber_status status = begin_layer(self, layers[i]);
        if (status == CAMBER_ERROR_ARGUMENT && count > 1)
            continue;
        if (status == CAMBER_ERROR_ARGUMENT)
            break;
        if (status != CAMBER_OK)
            return status;
        any = true;
        if (count == 1 && self->features->has_region && !self->stitcher && !self->dataset.osm)
            status = read_by_box(self);
        if (status != CAMBER_OK || self->boxed)
            return status;
        const bool counts = !self->desc->where && OGR_L_TestCapability(self->layer, OLCFastFeatureCount);
        const GIntBig expected = counts && !self->dataset.osm ? OGR_L_GetFeatureCount(self->layer, FALSE) : -1;
        status = read_layer(self, expected, unsorted);
        if (status == CAMBER_OK)
            status = check_count(self, expected);
        if (status != CAMBER_OK)
            return status;
    }
    return any ? CAMBER_OK : fail_where(self);
}

/* ---- A file ---- */

/* Warns about losses. Points and areas that are not drawn are not worth a warning, because nobody asked for them. */
static void warn_of_losses(const reader *self) {
    const camber_features_stats *stats = &self->stats;
    const char *path = self->desc->path;
    if (stats->damaged_features)
        camber_log(self->context, CAMBER_LOG_WARNING,
                   "%s: %zu damaged features (the first: %s); their readable parts are kept", path,
                   stats->damaged_features, self->damage);
    if (stats->skipped_features)
        camber_log(self->context, CAMBER_LOG_INFO, "%s: left out what is %s of %zu features", path,
                   camber_features_left_out(self->lines.kinds), stats->skipped_features);
    if (stats->invalid_points)
        camber_log(self->context, CAMBER_LOG_WARNING,
                   "%s: %zu points are not numbers and are left out; their lines are split there", path,
                   stats->invalid_points);
    if (stats->clamped_points)
        camber_log(self->context, CAMBER_LOG_WARNING, "%s: %zu points beyond latitude 85.051129 are moved there", path,
                   stats->clamped_points);
}

/* Fails if the whole file contained nothing that can be drawn. */
static camber_status check_result(reader *self, size_t features_before) {
    const camber_feature_lines *lines = &self->lines;
    if (lines->strange_points > lines->raw_points / 2)
        return camber_fail(
            self->context, CAMBER_ERROR_INPUT,
            "%s: its coordinates are not degrees, and it names no other coordinate system; add one (a "
            ".prj next to a shapefile) or convert the file with ogr2ogr -s_srs EPSG:... -t_srs EPSG:4326",
            self->desc->path);
    if (self->features->feature_count == features_before && !self->stitcher && self->stats.damaged_features)
        return camber_fail(self->context, CAMBER_ERROR_INPUT, "%s: no feature can be read: %s; get the file again",
                           self->desc->path, self->damage);
    if (self->features->feature_count == features_before && self->stats.skipped_features)
        return camber_fail(
            self->context, CAMBER_ERROR_INPUT,
            self->lines.kinds & CAMBER_KINDS_OF_AREAS
                ? "%s: no lines or areas; its %zu features are points or empty; choose another --layer"
                : "%s: no lines; its %zu features are points, areas or empty; choose another --layer, or a style "
                  "that draws outlines of polygons",
            self->desc->path, self->stats.skipped_features);
    return CAMBER_OK;
}

static camber_status read_dataset(reader *self, bool *unsorted) {
    camber_context *context = self->context;
    const camber_schema *schema = self->features->schema;
    const size_t features_before = self->features->feature_count;
    int *layers = NULL;
    size_t count = 0;
    camber_status status = camber_dataset_layers(&self->dataset, self->features, &layers, &count);
    if (status == CAMBER_OK && self->dataset.zoom >= 0)
        status = camber_tile_stitcher_create(context, self->dataset.zoom, &self->stitcher);
    if (status == CAMBER_OK && self->dataset.zoom >= 0)
        status = camber_tile_stitcher_create(context, self->dataset.zoom, &self->labels);
    if (status != CAMBER_OK)
        goto done;
    self->lines = (camber_feature_lines){.context = context,
                                         .world = {.context = context, .whole = self->stitcher},
                                         .rings.stats = &self->features->stats,
                                         .directed = schema->directed};
    if (self->dataset.osm)
        status = begin_osm(self, layers, count);
    if (status == CAMBER_OK)
        status = read_layers(self, layers, self->dataset.osm ? 1 : count, unsorted);
    if (status == CAMBER_OK && self->stitcher)
        status = camber_tile_stitcher_finish(self->stitcher, self->features);
    if (status == CAMBER_OK && self->labels)
        status = camber_tile_stitcher_finish_labels(self->labels, self->features);
    if (status == CAMBER_OK)
        status = check_result(self, features_before);
    if (status == CAMBER_OK && self->desc->where && self->passed == 0 && !self->boxed)
        warn_where(self);
    if (status == CAMBER_OK)
        status = camber_features_add_attribution(self->features, camber_dataset_attribution(&self->dataset));
done:
    camber_free(context, layers);
    return status;
}

static void close_reader(reader *self) {
    camber_feature_lines_free(&self->lines);
    camber_tile_stitcher_destroy(self->labels);
    camber_tile_stitcher_destroy(self->stitcher);
    for (size_t i = 0; i < self->other_count; i++)
        camber_columns_free(&self->others[i].columns, self->context);
    camber_columns_free(&self->columns, self->context);
    camber_dataset_close(&self->dataset);
}

static void add_stats(camber_features *features, const reader *self) {
    camber_features_stats *sum = &features->stats;
    camber_features_count(features);
    sum->skipped_features += self->stats.skipped_features;
    sum->damaged_features += self->stats.damaged_features;
    sum->invalid_points += self->stats.invalid_points;
    sum->clamped_points += self->stats.clamped_points;
    sum->antimeridian_splits += self->stats.antimeridian_splits;
}

/* Tries to read the file once. On failure the set is unchanged, except for unused classes. */
static camber_status read_once(camber_features *features, const camber_source_desc *desc, bool *unsorted) {
    reader self = {.context = features->context,
                   .features = features,
                   .desc = desc,
                   .lines = {.context = features->context, .world.context = features->context}};
    const size_t points = features->point_count, polylines = features->polyline_count, count = features->feature_count;
    const size_t signed_size = features->attribution_size;
    const camber_features_stats stats = features->stats;
    const double start_ms = camber_now_ms();
    camber_status status = camber_dataset_open(features->context, desc, features->schema, *unsorted, &self.dataset);
    if (status != CAMBER_OK)
        return status;
    CPLPushErrorHandlerEx(camber_gdal_collect, &self.dataset.errors);
    status = read_dataset(&self, unsorted);
    CPLPopErrorHandler();
    self.stats.invalid_points = self.lines.invalid_points;
    self.stats.clamped_points = self.lines.world.clamped_points;
    self.stats.antimeridian_splits = self.lines.world.antimeridian_splits;
    const int zoom = self.dataset.zoom;
    const bool is_extract = self.dataset.osm;
    /* GDAL's memory is freed before the lines are copied. */
    close_reader(&self);
    features->times.file_ms += camber_now_ms() - start_ms;
    if (status == CAMBER_OK)
        status = camber_features_merge_and_weigh(features, polylines, !desc->keep_apart, CAMBER_MERGE_ANY);
    if (status == CAMBER_OK) {
        if (is_extract)
            camber_features_add_extract(features, polylines);
        if (zoom >= 0)
            camber_features_pin_borders(features, polylines, zoom);
        add_stats(features, &self);
        warn_of_losses(&self);
        camber_rings_report(features, desc->path, polylines, &stats);
        camber_progress(features->context, "reading", 1);
    } else {
        features->point_count = points;
        features->polyline_count = polylines;
        features->feature_count = count;
        camber_features_cut_attribution(features, signed_size);
        features->stats = stats;
    }
    return status;
}

/* Registers drivers once per process, because all threads of a process share the list of drivers. GDAL's documentation
 * says that registering in two threads at once is not safe. */
static void register_drivers(void) {
    static pthread_once_t registered = PTHREAD_ONCE_INIT;
    pthread_once(&registered, GDALAllRegister);
}

/* Checks the order of OpenStreetMap's XML, because GDAL silently leaves out ways whose nodes come after them. */
static camber_status check_order(const camber_features *features, const camber_source_desc *desc, size_t before) {
    if (!camber_osm_xml_is_unordered(desc->path))
        return CAMBER_OK;
    if (features->feature_count == before)
        return camber_fail(features->context, CAMBER_ERROR_INPUT,
                           "%s: no lines, because nodes come after the ways that use them, or ways after relations; "
                           "sort it with osmium sort",
                           desc->path);
    camber_log(features->context, CAMBER_LOG_WARNING,
               "%s: nodes come after ways, or ways after relations, so some may be left out; sort it with osmium sort",
               desc->path);
    return CAMBER_OK;
}

static camber_status read_file(camber_features *features, const camber_source_desc *desc) {
    const size_t before = features->feature_count;
    camber_gdal_confined confined;
    register_drivers();
    camber_status status = camber_gdal_confine(features->context, &confined);
    if (status != CAMBER_OK)
        return status;
    bool unsorted = false;
    status = read_once(features, desc, &unsorted);
    if (status != CAMBER_OK && unsorted)
        status = read_once(features, desc, &unsorted);
    camber_gdal_release(features->context, &confined);
    if (status == CAMBER_OK && confined.refused)
        camber_log(features->context, CAMBER_LOG_WARNING,
                   "%s: refers to the network, and network access is off; data from there is left out; allow "
                   "it (--allow-remote) if you trust it",
                   desc->path);
    return status == CAMBER_OK ? check_order(features, desc, before) : status;
}

/* ---- Formats ---- */

static const char *format_name(size_t n) {
    register_drivers();
    const int count = GDALGetDriverCount();
    for (int i = 0; i < count; i++) {
        GDALDriverH driver = GDALGetDriver(i);
        const char *name = GDALGetDriverShortName(driver);
        if (GDALGetMetadataItem(driver, GDAL_DCAP_VECTOR, NULL) && GDALGetMetadataItem(driver, GDAL_DCAP_OPEN, NULL) &&
            camber_gdal_reads_file(name) && n-- == 0)
            return name;
    }
    return NULL;
}

static const char *version(void) {
    return GDALVersionInfo("--version");
}

const camber_gdal_calls camber_gdal = {read_file, format_name, version};

const camber_gdal_calls *camber_gdal_find(const char **why) {
    *why = NULL;
    return &camber_gdal;
}
