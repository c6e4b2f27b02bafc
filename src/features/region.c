/* Tests whether lines and areas touch a region, and reduces a set of features to a region.
 *
 * Input: a set whose lines are merged and have importance. Output: the same set without lines outside the region, and
 * without classes that are no longer used. The result is the same whether the file was read with an index or as a
 * whole. */
#include "features/region.h"

#include "features/features.h"

#include <math.h>

static bool has(const camber_region *box, double x, double y) {
    return x >= box->x0 && x <= box->x1 && y >= box->y0 && y <= box->y1;
}

size_t camber_region_parts(const camber_region *region, camber_region parts[2]) {
    const double world = floor(region->x0);
    const double x0 = region->x0 - world, x1 = region->x1 - world;
    parts[0] = (camber_region){x0, region->y0, fmin(x1, 1.0), region->y1};
    /* x = 0 and x = 1 are the same edge of the world. */
    if (x1 >= 1.0) {
        parts[1] = (camber_region){0.0, region->y0, x1 - 1.0, region->y1};
        return 2;
    }
    if (x0 > 0.0)
        return 1;
    parts[1] = (camber_region){1.0, region->y0, 1.0, region->y1};
    return 2;
}

bool camber_region_has_point(const camber_region *region, const double *point) {
    camber_region parts[2];
    const size_t count = camber_region_parts(region, parts);
    return has(&parts[0], point[0], point[1]) || (count > 1 && has(&parts[1], point[0], point[1]));
}

/* A part of a segment is from *first to *last. Narrows it to the half plane distance + share * slope >= 0. */
static bool cut(double distance, double slope, double *first, double *last) {
    if (!(slope > 0.0 || slope < 0.0))
        return distance >= 0.0;
    const double at = -distance / slope;
    if (slope > 0.0)
        *first = fmax(*first, at);
    else
        *last = fmin(*last, at);
    return *first <= *last;
}

/* Whether a segment touches the box, by Liang-Barsky clipping. */
static bool segment_touches(const camber_region *box, const double *from, const double *to) {
    const double dx = to[0] - from[0], dy = to[1] - from[1];
    double first = 0.0, last = 1.0;
    return cut(from[0] - box->x0, dx, &first, &last) && cut(box->x1 - from[0], -dx, &first, &last) &&
           cut(from[1] - box->y0, dy, &first, &last) && cut(box->y1 - from[1], -dy, &first, &last);
}

static bool part_touches(const camber_region *box, const double *points, size_t count) {
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
    for (size_t i = 0; i < count; i++) { /* like fmin and fmax, which would be function calls */
        const double x = points[2 * i], y = points[2 * i + 1];
        x0 = x < x0 ? x : x0;
        x1 = x > x1 ? x : x1;
        y0 = y < y0 ? y : y0;
        y1 = y > y1 ? y : y1;
    }
    if (!(x0 <= box->x1 && x1 >= box->x0 && y0 <= box->y1 && y1 >= box->y0))
        return false;
    for (size_t i = 0; i < count; i++)
        if (has(box, points[2 * i], points[2 * i + 1]) ||
            (i > 0 && segment_touches(box, points + 2 * (i - 1), points + 2 * i)))
            return true;
    return false;
}

bool camber_region_touches(const camber_region *region, const double *points, size_t count) {
    camber_region parts[2];
    const size_t part_count = camber_region_parts(region, parts);
    return part_touches(&parts[0], points, count) || (part_count > 1 && part_touches(&parts[1], points, count));
}

/* ---- Areas ---- */

/* Rings are at most two worlds wide, and regions are narrower than one world. A wider ring is not on Earth. */
static const double MOST_WORLDS = 4.0;

/* Returns how often a ring winds around a place that it does not touch. */
static int winding_of(const double *points, size_t count, double x, double y) {
    int winding = 0;
    for (size_t i = 0; i + 1 < count; i++) {
        const double *p = points + 2 * i, *q = p + 2;
        if ((p[1] > y) == (q[1] > y) || !(x < p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0])))
            continue;
        winding += q[1] > p[1] ? 1 : -1;
    }
    return winding;
}

static bool box_meets_area(const camber_region *box, const double *points, const size_t *offsets, size_t ring_count) {
    int winding = 0;
    for (size_t i = 0; i < ring_count; i++) {
        const double *ring = points + 2 * offsets[i];
        const size_t count = offsets[i + 1] - offsets[i];
        if (part_touches(box, ring, count))
            return true;
        winding += winding_of(ring, count, 0.5 * (box->x0 + box->x1), 0.5 * (box->y0 + box->y1));
    }
    return winding != 0;
}

bool camber_region_meets_area(const camber_region *region, const double *points, const size_t *offsets,
                              size_t ring_count) {
    double west = INFINITY, east = -INFINITY;
    for (size_t i = offsets[0]; i < offsets[ring_count]; i++) {
        const double x = points[2 * i];
        west = x < west ? x : west;
        east = x > east ? x : east;
    }
    const double first = ceil(region->x0 - east), worlds = fmin(floor(region->x1 - west) - first, MOST_WORLDS);
    for (double world = 0.0; world <= worlds; world += 1.0) {
        const double shift = first + world;
        const camber_region box = {region->x0 - shift, region->y0, region->x1 - shift, region->y1};
        if (box_meets_area(&box, points, offsets, ring_count))
            return true;
    }
    return false;
}

/* ---- Confining a set ---- */

typedef struct confining {
    camber_features *features;
    uint32_t *feature_class; /* by new index of a feature that stays */
    size_t polylines, points, feature_count;
    uint32_t last_old, last; /* the old and the new index of the feature that has the last polyline that stayed */
} confining;

/* Moves a polyline down, to the end of those that stay. All features that were merged into it are counted with it, so
 * each of them gets a new index. */
static void keep_polyline(confining *self, size_t polyline) {
    camber_features *f = self->features;
    const size_t begin = f->offsets[polyline], count = f->offsets[polyline + 1] - begin;
    const uint32_t old = f->polyline_feature[polyline];
    const bool follows = old == self->last_old;
    const uint32_t counted = f->feature_counts[polyline] ? f->feature_counts[polyline] : !follows;
    self->last = follows ? self->last : (uint32_t)self->feature_count;
    for (uint32_t i = 0; i < counted; i++)
        self->feature_class[self->feature_count++] = f->feature_class[old];
    memmove(f->points + 2 * self->points, f->points + 2 * begin, 2 * count * sizeof *f->points);
    memmove(f->importance + self->points, f->importance + begin, count * sizeof *f->importance);
    if (f->progress)
        memmove(f->progress + 2 * self->polylines, f->progress + 2 * polyline, 2 * sizeof *f->progress);
    f->offsets[self->polylines] = self->points;
    f->polyline_feature[self->polylines] = self->last;
    f->feature_counts[self->polylines] = counted;
    self->last_old = old;
    self->points += count;
    f->offsets[++self->polylines] = self->points;
}

bool camber_features_touch(const camber_features *features, const camber_region *region, size_t polyline,
                           size_t *next) {
    const size_t *offsets = features->offsets + polyline;
    *next = polyline + 1;
    if (!camber_geometry_is_area(camber_features_kind(features, polyline)))
        return camber_region_touches(region, features->points + 2 * offsets[0], offsets[1] - offsets[0]);
    while (*next < features->polyline_count &&
           features->polyline_feature[*next] == features->polyline_feature[polyline])
        ++*next;
    return camber_region_meets_area(region, features->points, offsets, *next - polyline);
}

camber_status camber_features_confine(camber_features *features, size_t first_polyline, const camber_region *region) {
    if (first_polyline == features->polyline_count)
        return camber_features_renumber_classes(features);
    const size_t first_feature = features->polyline_feature[first_polyline], end = features->polyline_count;
    confining self = {.features = features,
                      .polylines = first_polyline,
                      .points = features->offsets[first_polyline],
                      .feature_count = first_feature,
                      .last_old = UINT32_MAX};
    /* If the first line of a feature is dropped, or was merged into another feature's, the feature is counted with its
     * next line. */
    const size_t most = features->feature_count + (end - first_polyline);
    if (!(self.feature_class = camber_alloc(features->context, most, sizeof *self.feature_class)))
        return CAMBER_ERROR_MEMORY;
    if (first_feature)
        memcpy(self.feature_class, features->feature_class, first_feature * sizeof *self.feature_class);
    for (size_t p = first_polyline, next; p < end; p = next) {
        const bool stays = camber_features_touch(features, region, p, &next);
        for (; p < next && stays; p++)
            keep_polyline(&self, p);
    }
    camber_free(features->context, features->feature_class);
    features->feature_class = self.feature_class;
    features->feature_capacity = most;
    features->feature_count = self.feature_count;
    features->polyline_count = self.polylines;
    features->point_count = self.points;
    camber_features_shrink(features);
    return camber_features_renumber_classes(features);
}
