/* Checks strokes and makes their rows. */
#include "points/rows.h"

#include <assert.h>
#include <math.h>

static const float WIDEST_PX = 16384.0f;

static camber_status check_stroke(camber_context *context, const camber_stroke *stroke, size_t row) {
    if (!(stroke->width_px >= 0.0f && stroke->width_px <= WIDEST_PX))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "stroke %zu: a width of %g px; it must be 0 to %g", row,
                           (double)stroke->width_px, (double)WIDEST_PX);
    if (!(stroke->miter_limit >= 0.0f))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "stroke %zu: a miter limit of %g; it must be 0 or more", row,
                           (double)stroke->miter_limit);
    if (!(fabsf(stroke->offset_px) <= WIDEST_PX))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "stroke %zu: an offset of %g px; it must be %g to %g", row,
                           (double)stroke->offset_px, -(double)WIDEST_PX, (double)WIDEST_PX);
    if (!(stroke->round_limit >= 0.0f))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "stroke %zu: a round limit of %g; it must be 0 or more", row,
                           (double)stroke->round_limit);
    if ((unsigned)stroke->join > CAMBER_JOIN_BEVEL || (unsigned)stroke->cap > CAMBER_CAP_SQUARE)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "stroke %zu: join %d, cap %d; see camber_join and camber_cap", row, (int)stroke->join,
                           (int)stroke->cap);
    return CAMBER_OK;
}

/* Makes a stroke's row: its reach, and the step of a fan whose chords stay within the tolerance. */
static camber_row make_row(const camber_stroke *stroke, float tolerance_px) {
    const double reach = (double)stroke->width_px / 2 + (double)CAMBER_PAD_PX;
    /* A chord over the angle a is up to reach * (1 - cos(a / 2)) inside its arc. */
    const double below = 1 - (double)tolerance_px / reach;
    const double least = 3.14159265358979 / CAMBER_JOIN_TRIANGLES_MAX;
    double step = 2 * acos(below > 0 ? below : 0);
    step = step < least ? least : step > 1.5707963 ? 1.5707963 : step;
    return (camber_row){
        .reach_px = (float)reach,
        .miter_limit = stroke->miter_limit > 0.0f ? stroke->miter_limit : 2.0f,
        .fan_cos = (float)cos(step),
        .fan_sin = (float)sin(step),
        .round_cos =
            stroke->join == CAMBER_JOIN_ROUND && stroke->round_limit > 1.0f ? 1.0f / stroke->round_limit : 2.0f,
        .join = (camber_u32)stroke->join,
        .cap = (camber_u32)stroke->cap,
        .fan_step = (float)step,
    };
}

camber_status camber_rows_create(camber_context *context, uint32_t row_count, const camber_tessellation_desc *desc,
                                 camber_row **rows) {
    assert(desc->stroke_count == 0 || desc->strokes);
    if (row_count > desc->stroke_count)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "a polyline has row %u, and there are %zu strokes; give one a row", row_count - 1,
                           desc->stroke_count);
    const float tolerance = desc->fan_tolerance_px == 0.0f ? 0.25f : desc->fan_tolerance_px;
    if (!(tolerance > 0.0f) || (unsigned)desc->method > CAMBER_METHOD_FAN)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "a fan tolerance of %g px, method %d; see camber_tessellation_desc", (double)tolerance,
                           (int)desc->method);
    for (size_t i = 0; i < desc->stroke_count; i++) {
        const camber_status status = check_stroke(context, desc->strokes + i, i);
        if (status != CAMBER_OK)
            return status;
    }
    camber_row *made = camber_alloc_zero(context, desc->stroke_count + 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < desc->stroke_count; i++)
        made[i] = make_row(desc->strokes + i, tolerance);
    *rows = made;
    return CAMBER_OK;
}
