/* Polylines in the form that the kernels read: kernels/layout.h tells the words. */
#ifndef CAMBER_LINES_H
#define CAMBER_LINES_H

#include "base/base.h"
#include "kernels/layout.h"

struct camber_polylines {
    camber_context *context;
    size_t holders;  /* meshes, beside who made them */
    uint64_t serial; /* unique in the context: a mesh knows by it what it has uploaded */
    /* slot_count + 2 each: a sentinel before and after the slots. slot_count is a multiple of CAMBER_BLOCK. */
    float *x, *y;
    uint32_t *info;
    size_t slot_count;
    camber_arc_length
        *measures; /* of each slot, where a measured network knows it. NULL: it is the sum over the points */
    /* Slots of polyline i: [first_slots[i], first_slots[i + 1]), counted without the leading sentinel. */
    uint32_t *first_slots;
    uint32_t *polyline_rows;
    size_t polyline_count;
    uint32_t row_count; /* highest row + 1 */
    camber_polylines_stats stats;
};

/* Farther away a float's steps are larger than a city block; the view cuts long before. */
#define CAMBER_FARTHEST_PX 1e9f

/* Whether a point is drawn: false for NaN. */
static inline bool camber_point_is_valid(const float *point) {
    return fabsf(point[0]) <= CAMBER_FARTHEST_PX && fabsf(point[1]) <= CAMBER_FARTHEST_PX;
}

/* Keeps polylines until another camber_polylines_destroy. */
void camber_polylines_hold(camber_polylines *polylines);

/* The polyline whose slots hold slot. */
size_t camber_polylines_find(const camber_polylines *polylines, size_t slot);

#endif
