/* Reads the part of a layer that a region needs, by the layer's spatial index.
 *
 * Input: a layer whose format has a spatial index, and a set with a region. Output: the complete features that touch
 * the region, and those outside that affect how they are drawn (features/frontier.c), in the order of the file.
 *
 *     1  the region's box in the layer's own coordinates, found from points along its edges
 *     2  boxes in the middle of the world, because a line that jumps over the antimeridian crosses it in the index
 *     3  boxes around the points that the frontier asks for, until it asks for none */
#include "gdal/vector_file.h"

#include "features/frontier.h"
#include "features/mercator.h"

#include <math.h>
#include <stdlib.h>

/* Drivers whose feature numbers are in the order in which features are read without an index. */
static const char *const drivers[] = {"FlatGeobuf", "GPKG", "ESRI Shapefile"};

/* Points that the frontier asks for are grouped into cells. The longer side of the region has this many cells. */
static const double CELLS = 8.0;
/* Boxes are enlarged by a fraction of their coordinates, because of rounding, and by a fraction of their sides, because
 * their edges may be curved in the layer. */
static const double ROUNDING = 1e-9, BULGE = 0.02;
enum { EDGE_POINTS = 41, FIRST_SLOTS = 1024 };

typedef struct box_reader {
    const camber_box_reading *from;
    camber_context *context;
    camber_features *features;
    OGRCoordinateTransformationH to_layer; /* NULL: the layer is in degrees or metres */
    size_t first_polyline, first_feature;
    camber_frontier *frontier; /* NULL: every feature found is wanted */
    bool split_only;           /* only lines that were split at the antimeridian are wanted */
    int64_t *keys;             /* by feature of the set: its number in the file */
    size_t key_capacity;
    int64_t *taken; /* hash table of feature numbers; -1: free. slot_count is a power of two; at most half are in use */
    size_t slot_count, taken_count;
} box_reader;

/* ---- The extent of the layer ---- */

static bool has_index(const camber_box_reading *reading) {
    const char *driver = GDALGetDriverShortName(GDALGetDatasetDriver(reading->dataset));
    bool known = false;
    for (size_t i = 0; i < sizeof drivers / sizeof *drivers; i++)
        known = known || EQUAL(driver, drivers[i]);
    return known && OGR_L_TestCapability(reading->layer, OLCFastSpatialFilter);
}

static double half_world_of(camber_projection_kind kind) {
    return kind == CAMBER_PROJECTION_METRES ? 3.14159265358979323846 * CAMBER_MERCATOR_RADIUS_M : 180.0;
}

/* Finds out whether the layer is within one copy of the world, as most are. *wide: a line may cross the antimeridian. A
 * layer without a coordinate system is read as a whole, because only its numbers show whether they are degrees. */
static bool lies_in_world(const camber_box_reading *reading, bool *wide) {
    OGREnvelope box;
    if (!reading->has_srs || OGR_L_GetExtent(reading->layer, &box, FALSE) != OGRERR_NONE)
        return false;
    double x0 = box.MinX, y0 = box.MinY, x1 = box.MaxX, y1 = box.MaxY;
    if (reading->lines->latitude_first) {
        x0 = box.MinY;
        x1 = box.MaxY;
    }
    if (reading->lines->projection == CAMBER_PROJECTION_TRANSFORM &&
        !OCTTransformBounds(reading->lines->transform, box.MinX, box.MinY, box.MaxX, box.MaxY, &x0, &y0, &x1, &y1,
                            EDGE_POINTS))
        return false;
    const double half = half_world_of(reading->lines->projection);
    *wide = !(x1 - x0 < half);
    return x0 >= -half && x1 <= half && x0 <= x1 &&
           !(*wide && reading->lines->projection == CAMBER_PROJECTION_TRANSFORM);
}

/* Converts a box of the world to the layer's coordinates, slightly enlarged. Returns false if that is not possible. A
 * box that reaches Web Mercator's limit extends to the pole, because latitudes beyond the limit are moved to it. */
static bool find_box(const box_reader *self, const camber_region *part, OGREnvelope *box) {
    const camber_feature_lines *lines = self->from->lines;
    double west, south, east, north;
    if (lines->projection == CAMBER_PROJECTION_METRES) {
        const double world = 2.0 * half_world_of(lines->projection);
        west = (part->x0 - 0.5) * world;
        east = (part->x1 - 0.5) * world;
        north = part->y0 > 1e-9 ? (0.5 - part->y0) * world : 1e30;
        south = part->y1 < 1.0 - 1e-9 ? (0.5 - part->y1) * world : -1e30;
    } else {
        camber_mercator_unproject(part->x0, fmax(part->y0, 0.0), &west, &north);
        camber_mercator_unproject(part->x1, fmin(part->y1, 1.0), &east, &south);
        north = part->y0 > 1e-9 ? north : 90.0;
        south = part->y1 < 1.0 - 1e-9 ? south : -90.0;
    }
    double x0 = west, y0 = south, x1 = east, y1 = north;
    if (self->to_layer &&
        !OCTTransformBounds(self->to_layer, west, south, east, north, &x0, &y0, &x1, &y1, EDGE_POINTS))
        return false;
    if (!(isfinite(x0) && isfinite(y0) && isfinite(x1) && isfinite(y1) && x0 <= x1 && y0 <= y1))
        return false;
    const double farthest = fmax(fmax(fabs(x0), fabs(x1)), fmin(fmax(fabs(y0), fabs(y1)), 1e9));
    const double bulge = self->to_layer ? BULGE : 0.0;
    const double more_x = ROUNDING * farthest + bulge * (x1 - x0), more_y = ROUNDING * farthest + bulge * (y1 - y0);
    *box = (OGREnvelope){.MinX = x0 - more_x, .MaxX = x1 + more_x, .MinY = y0 - more_y, .MaxY = y1 + more_y};
    if (lines->latitude_first)
        *box = (OGREnvelope){.MinX = y0 - more_y, .MaxX = y1 + more_y, .MinY = x0 - more_x, .MaxY = x1 + more_x};
    return true;
}

/* ---- Features, each once ---- */

static size_t find_slot(const box_reader *self, int64_t number) {
    size_t slot = (size_t)camber_mix(0, (uint64_t)number) & (self->slot_count - 1);
    while (self->taken[slot] >= 0 && self->taken[slot] != number)
        slot = (slot + 1) & (self->slot_count - 1);
    return slot;
}

static bool make_slots(box_reader *self, size_t count) {
    int64_t *old = self->taken;
    const size_t old_count = self->slot_count;
    int64_t *made = camber_alloc(self->context, count, sizeof *made);
    if (!made)
        return false;
    memset(made, 0xff, count * sizeof *made);
    self->taken = made;
    self->slot_count = count;
    for (size_t i = 0; i < old_count; i++)
        if (old[i] >= 0)
            made[find_slot(self, old[i])] = old[i];
    camber_free(self->context, old);
    return true;
}

static bool take(box_reader *self, int64_t number) {
    if (2 * self->taken_count >= self->slot_count && !make_slots(self, 2 * self->slot_count))
        return false;
    self->taken[find_slot(self, number)] = number;
    self->taken_count++;
    return true;
}

/* Whether the features that were added since the mark are wanted. */
static bool is_wanted(const box_reader *self, const camber_features_mark *before, size_t splits) {
    const camber_features *f = self->features;
    if (self->split_only)
        return self->from->lines->world.antimeridian_splits > splits;
    for (size_t p = before->polyline_count; self->frontier && p < f->polyline_count; p++)
        if (camber_frontier_wants(self->frontier, f->points + 2 * f->offsets[p], f->offsets[p + 1] - f->offsets[p]))
            return true;
    return !self->frontier;
}

static camber_status add(box_reader *self, OGRFeatureH feature) {
    camber_features *f = self->features;
    const int64_t number = OGR_F_GetFID(feature);
    if (number < 0 || self->taken[find_slot(self, number)] == number)
        return CAMBER_OK;
    const camber_features_mark before = camber_features_get_mark(f);
    const size_t splits = self->from->lines->world.antimeridian_splits;
    camber_status status = self->from->add(self->from->user, feature);
    if (status != CAMBER_OK)
        return status;
    if (!is_wanted(self, &before, splits)) {
        f->feature_count = before.feature_count;
        f->polyline_count = before.polyline_count;
        f->point_count = before.point_count;
        f->stats = before.stats;
        return CAMBER_OK;
    }
    if (!take(self, number) || !camber_grow(self->context, &self->keys, &self->key_capacity,
                                            f->feature_count - self->first_feature, sizeof *self->keys))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = before.feature_count; i < f->feature_count; i++)
        self->keys[i - self->first_feature] = number;
    return CAMBER_OK;
}

/* Reads the wanted features in a box. *served: false if the box cannot be expressed in the layer's coordinate system.
 */
static camber_status read_box(box_reader *self, const camber_region *part, bool *served) {
    OGREnvelope box;
    camber_status status = CAMBER_OK;
    *served = find_box(self, part, &box);
    if (!*served)
        return CAMBER_OK;
    OGR_L_SetSpatialFilterRect(self->from->layer, box.MinX, box.MinY, box.MaxX, box.MaxY);
    OGR_L_ResetReading(self->from->layer);
    while (status == CAMBER_OK) {
        OGRFeatureH feature = NULL;
        status = self->from->next(self->from->user, &feature);
        if (!feature)
            break;
        if (status == CAMBER_OK)
            status = add(self, feature);
        OGR_F_Destroy(feature);
    }
    return status;
}

/* ---- The frontier ---- */

typedef struct cell_point {
    int64_t column, row;
    double x, y;
} cell_point;

static int compare_cells(const void *left, const void *right) {
    const cell_point *a = left, *b = right;
    if (a->row != b->row)
        return a->row < b->row ? -1 : 1;
    return a->column < b->column ? -1 : a->column > b->column;
}

static camber_status read_cells(box_reader *self, const cell_point *points, size_t count, bool *served) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0, end; i < count && status == CAMBER_OK && *served; i = end) {
        camber_region box = {points[i].x, points[i].y, points[i].x, points[i].y};
        for (end = i; end < count && compare_cells(points + i, points + end) == 0; end++) {
            box.x0 = fmin(box.x0, points[end].x);
            box.x1 = fmax(box.x1, points[end].x);
            box.y0 = fmin(box.y0, points[end].y);
            box.y1 = fmax(box.y1, points[end].y);
        }
        status = read_box(self, &box, served);
    }
    return status;
}

static camber_status read_asked(box_reader *self, const double *asked, size_t count, bool *served) {
    const camber_region *region = &self->features->region;
    const double cell = fmax(region->x1 - region->x0, region->y1 - region->y0) / CELLS;
    cell_point *points = camber_alloc(self->context, count, sizeof *points);
    if (!points)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++)
        points[i] = (cell_point){(int64_t)floor(asked[2 * i] / cell), (int64_t)floor(asked[2 * i + 1] / cell),
                                 asked[2 * i], asked[2 * i + 1]};
    qsort(points, count, sizeof *points, compare_cells);
    const camber_status status = read_cells(self, points, count, served);
    camber_free(self->context, points);
    return status;
}

static camber_status read_frontier(box_reader *self, bool *served) {
    camber_status status =
        camber_frontier_create(self->features, self->first_polyline, self->from->merges, &self->frontier);
    while (status == CAMBER_OK && *served) {
        const double *asked;
        size_t count;
        status = camber_frontier_ask(self->frontier, &asked, &count);
        if (status != CAMBER_OK || count == 0)
            break;
        status = read_asked(self, asked, count, served);
    }
    camber_frontier_destroy(self->frontier);
    return status;
}

/* ---- A layer ---- */

static camber_status read_region(box_reader *self, bool wide, bool *served) {
    static const camber_region middle = {0.5, 0.0, 0.5, 1.0};
    camber_region parts[2];
    const size_t count = camber_region_parts(&self->features->region, parts);
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < count && status == CAMBER_OK && *served; i++)
        status = read_box(self, &parts[i], served);
    if (status == CAMBER_OK && *served && wide) {
        self->split_only = true;
        status = read_box(self, &middle, served);
        self->split_only = false;
    }
    if (status == CAMBER_OK && *served)
        status = read_frontier(self, served);
    if (status == CAMBER_OK && *served && self->features->feature_count > self->first_feature)
        status = camber_features_reorder(self->features, self->first_polyline, self->first_feature, self->keys);
    return status;
}

camber_status camber_box_read(const camber_box_reading *reading, bool *served) {
    const camber_features_mark before = camber_features_get_mark(reading->features);
    box_reader self = {.from = reading,
                       .context = reading->features->context,
                       .features = reading->features,
                       .first_polyline = before.polyline_count,
                       .first_feature = before.feature_count};
    bool wide = false;
    *served = has_index(reading) && lies_in_world(reading, &wide);
    if (*served && reading->lines->projection == CAMBER_PROJECTION_TRANSFORM)
        *served = (self.to_layer = OCTGetInverse(reading->lines->transform)) != NULL;
    camber_status status = !*served || make_slots(&self, FIRST_SLOTS) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK && *served)
        status = read_region(&self, wide, served);
    OGR_L_SetSpatialFilter(reading->layer, NULL);
    OGR_L_ResetReading(reading->layer);
    OCTDestroyCoordinateTransformation(self.to_layer);
    camber_free(self.context, self.taken);
    camber_free(self.context, self.keys);
    if (status == CAMBER_OK && !*served)
        camber_features_reset(reading->features, &before);
    return status;
}
