/* How far along its line a point is: the arc length from the line's first point, and the length of the whole line.
 *
 * Lengths of segments are rounded to fixed point and added up as integers. Such sums do not depend on the order, so
 * chunks are summed up separately, the host carries the sums from chunk to chunk, and the twin, which has no chunks,
 * computes the same bits. */
#ifndef CAMBER_KERNELS_ARC_LENGTH_H
#define CAMBER_KERNELS_ARC_LENGTH_H

#include "layout.h"

/* Points that a work-item measures. */
#define CAMBER_ARC_LENGTH_CHUNK 64
/* The unit of lengths, 1 / 1024 px, for slots, whose coordinates are px. */
#define CAMBER_LENGTH_UNITS 1024.0f

/* A chunk's sum, and whether a line begins in the chunk (or, counting backwards, ends in it), so that segments before
 * that are not part of it. */
#define CAMBER_SUM_SHIFT 1
#define CAMBER_SUM_CLOSED 1u

CAMBER_FN camber_u64 camber_length_of(float dx, float dy, float units) {
    return (camber_u64)(CAMBER_SQRT(dx * dx + dy * dy) * units + 0.5f);
}

/* Returns the length of the segment that ends at a slot; 0 for a line's first point, and for sentinels. */
CAMBER_FN camber_u64 camber_length_into(float dx, float dy, camber_u32 info) {
    const camber_u32 inside = (info & (CAMBER_POINT_REAL | CAMBER_POINT_FIRST)) == CAMBER_POINT_REAL;
    return inside ? camber_length_of(dx, dy, CAMBER_LENGTH_UNITS) : 0ul;
}

/* Returns a sum in px. */
CAMBER_FN float camber_length_px(camber_u64 sum) {
    return (float)sum * (1.0f / CAMBER_LENGTH_UNITS);
}

#endif
