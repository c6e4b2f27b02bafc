/* Polylines as the kernels read them: arrays of padded slots. kernels/layout.h explains the info words. */
#ifndef CAMBER_LINES_LINES_H
#define CAMBER_LINES_LINES_H

#include "base/base.h"
#include "kernels/layout.h"

/* A polyline's points are in consecutive slots. There is a sentinel between two polylines if a point there needs a
 * neighbour to look at, and sentinels fill up the end:
 *
 *     slot        0         1 ...                                                       slot_count + 1
 *     holds   sentinel | open line | sentinel, ring, sentinel | open line | sentinels to a whole block | sentinel */
struct camber_polylines {
    camber_context *context;
    size_t holders;  /* meshes that hold them, not counting the creator */
    uint64_t serial; /* unique in the context; it tells a mesh whether it already has these polylines */
    /* slot_count + 2 each, with a sentinel before and after the slots. slot_count is a multiple of CAMBER_BLOCK. */
    float *x, *y;
    uint32_t *info;
    size_t slot_count;
    /* one per slot, if a network knows them. NULL: they are computed from the points */
    camber_arc_length *arc_lengths;
    /* Slots of polyline i: [first_slots[i], first_slots[i + 1]), counted without the leading sentinel. */
    uint32_t *first_slots;
    uint32_t *polyline_rows;
    size_t polyline_count;
    uint32_t row_count; /* highest row + 1 */
    camber_polylines_stats stats;
    void *block; /* the allocation with all arrays except arc_lengths; NULL: each array is its own allocation */
};

/* In px. Points farther out than this are invalid: float steps are too coarse there. Views clip long before that. */
#define CAMBER_FARTHEST_PX 1e9f

/* Whether a point can be drawn; false for NaN as well. */
static inline bool camber_point_is_valid(const float *point) {
    return fabsf(point[0]) <= CAMBER_FARTHEST_PX && fabsf(point[1]) <= CAMBER_FARTHEST_PX;
}

/* Begins a set of polylines, to which rings are then appended. slots is the number of slots to reserve, including two
 * sentinels per ring. */
camber_status camber_polylines_begin(camber_context *context, size_t slots, size_t polyline_count,
                                     camber_polylines **polylines);

/* Appends a ring of points, whose last may equal the first: an outer ring is made clockwise as seen, a hole
 * counter-clockwise. Drops invalid points, and points that repeat the previous one. */
void camber_polylines_put_ring(camber_polylines *polylines, size_t polyline, const float *points, size_t given,
                               bool is_hole, uint32_t row);

void camber_polylines_end(camber_polylines *polylines);

/* Adds a holder: the polylines live until each holder has called camber_polylines_destroy. */
void camber_polylines_hold(camber_polylines *polylines);

/* Returns the polyline that a slot belongs to. */
size_t camber_polylines_find(const camber_polylines *polylines, size_t slot);

#endif
