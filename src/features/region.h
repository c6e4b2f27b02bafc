/* The part of the world that a view needs: files are then read for it alone, by their index where they have one. */
#ifndef CAMBER_FEATURES_REGION_H
#define CAMBER_FEATURES_REGION_H

#include "base/base.h"

/* A box in world coordinates, less than a world wide. x may go beyond 0 to 1: the box then shows two copies of it. */
typedef struct camber_region {
    double x0, y0, x1, y1;
} camber_region;

/* The parts of a region that lie in the one world from 0 to 1: one, or two at the antimeridian. Returns how many. */
size_t camber_region_parts(const camber_region *region, camber_region parts[2]);
bool camber_region_has_point(const camber_region *region, const double *point);
/* Whether a polyline has a point in common with the region in any copy of the world. points: count pairs. */
bool camber_region_touches(const camber_region *region, const double *points, size_t count);
/* Whether an area has something in the region: a ring touches it, or the rings together wind around all of it. Rings
 * may lie beyond the edges of the world. Ring i has the points [offsets[i], offsets[i + 1]). */
bool camber_region_meets_area(const camber_region *region, const double *points, const size_t *offsets,
                              size_t ring_count);

#endif
