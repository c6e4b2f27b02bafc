/* Cuts rings of areas to their vector tiles.
 *
 * Input: a ring that includes the buffer around its tile. Output: the part of it inside the tile, closed along the
 * tile's sides, by Sutherland-Hodgman clipping. The main idea: the piece in the neighbouring tile ends on the same side
 * of the tile and runs along it in the other direction. So the edges along the side cancel each other, and no seam is
 * drawn, however the buffers overlap.
 *
 *         tile A    |    tile B
 *     a ----------->|------------> b
 *                   v ^               both pieces have this edge, one down, one up
 *     d <-----------|<------------ c
 */
#include "features/rings.h"
#include "features/tile_stitcher.h"

#include <math.h>

enum { SIDES = 4 };

/* One side of the tile. The sides cut one after the other: each hands the points that pass it to the next. */
typedef struct side {
    double first[2], last[2];
    bool begun;
} side;

typedef struct clipper {
    camber_tile_stitcher *stitcher;
    const camber_tile_box *box;
    side sides[SIDES];
    size_t first; /* index of the ring's first point in the stitcher */
} clipper;

static double edge_of(const camber_tile_box *box, int number) {
    return number & 1 ? box->high[number / 2] : box->low[number / 2];
}

static bool lies_inside(const camber_tile_box *box, int number, const double *point) {
    const double at = point[number / 2], edge = edge_of(box, number);
    return number & 1 ? at <= edge : at >= edge;
}

/* Finds the point at which a segment crosses a side. The result does not depend on the segment's direction, so areas
 * that share the segment also share the new point. */
static void find_crossing(const camber_tile_box *box, int number, const double *p, const double *q, double at[2]) {
    const int axis = number / 2, other = 1 - axis;
    const double *low = p[axis] < q[axis] ? p : q, *high = p[axis] < q[axis] ? q : p;
    const double edge = edge_of(box, number), share = (edge - low[axis]) / (high[axis] - low[axis]);
    const double along = low[other] + (high[other] - low[other]) * share;
    at[axis] = edge;
    at[other] = fmin(fmax(along, fmin(p[other], q[other])), fmax(p[other], q[other]));
}

/* Hands a point to a side, or to the stitcher after the last side. Returns false if there is no memory. */
static bool give(clipper *self, int number, const double *point) {
    for (; number < SIDES; number++) {
        side *by = &self->sides[number];
        double before[2] = {by->last[0], by->last[1]}, crossing[2];
        const bool inside = lies_inside(self->box, number, point), begun = by->begun;
        if (!begun)
            memcpy(by->first, point, sizeof by->first);
        memcpy(by->last, point, sizeof by->last);
        by->begun = true;
        if (begun && inside != lies_inside(self->box, number, before)) {
            find_crossing(self->box, number, before, point, crossing);
            if (!give(self, number + 1, crossing))
                return false;
        }
        if (!inside)
            return true;
    }
    camber_tile_stitcher *stitcher = self->stitcher;
    if (stitcher->point_count > self->first &&
        camber_tile_stitcher_same(stitcher->points + 2 * (stitcher->point_count - 1), point))
        return true;
    return camber_tile_stitcher_add_point(stitcher, point);
}

/* Closes the ring that a side received. */
static bool close_ring(clipper *self, int number) {
    const side *by = &self->sides[number];
    double crossing[2];
    if (!by->begun || lies_inside(self->box, number, by->first) == lies_inside(self->box, number, by->last))
        return true;
    find_crossing(self->box, number, by->last, by->first, crossing);
    return give(self, number + 1, crossing);
}

camber_status camber_tile_stitcher_add_ring(camber_tile_stitcher *stitcher, const camber_cut_line *like,
                                            const camber_tile_box *box, size_t count) {
    clipper self = {.stitcher = stitcher, .box = box, .first = stitcher->point_count};
    bool fits = true;
    for (size_t i = 0; i + 1 < count && fits; i++)
        fits = give(&self, 0, stitcher->scratch + 2 * i);
    for (int number = 0; number < SIDES && fits; number++)
        fits = close_ring(&self, number);
    if (!fits)
        return CAMBER_ERROR_MEMORY;
    camber_cut_line ring = *like;
    ring.first = self.first;
    ring.count = stitcher->point_count - self.first;
    if (ring.count < 3 || camber_ring_is_flat(stitcher->points + 2 * self.first, ring.count)) {
        stitcher->point_count = self.first;
        return CAMBER_OK;
    }
    double first[2];
    memcpy(first, stitcher->points + 2 * self.first, sizeof first);
    if (!camber_tile_stitcher_same(first, stitcher->points + 2 * (stitcher->point_count - 1))) {
        if (!camber_tile_stitcher_add_point(stitcher, first))
            return CAMBER_ERROR_MEMORY;
        ring.count++;
    }
    return camber_tile_stitcher_add_line(stitcher, &ring);
}

void camber_features_pin_borders(camber_features *features, size_t first_polyline, int zoom) {
    const double tiles = ldexp(1.0, zoom);
    for (size_t p = first_polyline; p < features->polyline_count; p++) {
        if (!camber_geometry_is_area(camber_features_kind(features, p)))
            continue;
        for (size_t i = features->offsets[p]; i < features->offsets[p + 1]; i++) {
            const double x = features->points[2 * i] * tiles, y = features->points[2 * i + 1] * tiles;
            if (x == floor(x) || y == floor(y))
                features->importance[i] = INFINITY;
        }
    }
}
