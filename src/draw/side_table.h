/* The side table of a frame: texels (four floats each) that rows of paints refer to by number.
 *
 * Dashes take one texel each, ramps two texels per stop. The OpenCL renderer puts images after them, four pixels per
 * texel. The GL renderer appends the table to the rows of its row texture. */
#ifndef CAMBER_DRAW_SIDE_TABLE_H
#define CAMBER_DRAW_SIDE_TABLE_H

#include "base/base.h"
#include "camber.h"

enum { CAMBER_SIDE_TABLE_MAX = 1 << 24 }; /* texels: shaders keep their numbers in floats */

/* Position of a row's dashes in the table. */
typedef struct camber_side_dashes {
    uint32_t first, count; /* texels */
    float period_px;
    bool are_round;
} camber_side_dashes;

/* Position of a ramp's stops in the table. */
typedef struct camber_side_ramp {
    const camber_ramp *ramp;
    uint32_t first; /* texel */
} camber_side_ramp;

typedef struct camber_side_table {
    camber_context *context;
    float *texels;
    size_t count, capacity;
    camber_side_ramp *ramps; /* ramps that are in the table */
    size_t ramp_count, ramp_capacity;
    /* The dashes that were added last; consecutive rows usually have the same dashes. */
    const camber_dash *dash; /* NULL: none yet */
    float dash_unit_px;
    camber_side_dashes dashes;
} camber_side_table;

void camber_side_table_clear(camber_side_table *table);
void camber_side_table_free(camber_side_table *table);
/* Adds texels that are all 0; the pointer is valid until the next call. NULL: out of memory. */
float *camber_side_table_add(camber_side_table *table, size_t texels);

/* These add a dash, whose lengths are in the given unit, or a ramp, unless the table has it, and return its position.
 * They return CAMBER_ERROR_ARGUMENT (camber.h does not allow it), CAMBER_ERROR_LIMIT (the table is full),
 * CAMBER_ERROR_MEMORY. */
camber_status camber_side_table_add_dash(camber_side_table *table, const camber_dash *dash, float unit_px,
                                         bool is_round, camber_side_dashes *dashes);
camber_status camber_side_table_add_ramp(camber_side_table *table, const camber_ramp *ramp, uint32_t *first);

#endif
