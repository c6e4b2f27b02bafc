/* The part of the world that a view needs. Only features in it are read from files, with an index if the file has one.
 */
#ifndef CAMBER_FEATURES_REGION_H
#define CAMBER_FEATURES_REGION_H

#include "base/base.h"

/* A box in world coordinates, less than one world wide. x may be outside 0 to 1: the box then covers two copies of the
 * world. */
typedef struct camber_region {
    double x0, y0, x1, y1;
} camber_region;

/* Splits a region into its parts within the world from 0 to 1: one, or two at the antimeridian. Returns how many there
 * are. */
size_t camber_region_parts(const camber_region *region, camber_region parts[2]);
bool camber_region_has_point(const camber_region *region, const double *point);
/* Whether a polyline shares a point with the region in any copy of the world. points: count pairs. */
bool camber_region_touches(const camber_region *region, const double *points, size_t count);
/* Whether a part of an area is in the region: either a ring touches the region, or the rings together wind around all
 * of it. Rings may extend beyond the edges of the world. Ring i has the points [offsets[i], offsets[i + 1]). */
bool camber_region_meets_area(const camber_region *region, const double *points, const size_t *offsets,
                              size_t ring_count);

#endif
