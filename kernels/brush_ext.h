/* The extension of a brush with features, as the kernels and the twin read it, and how features cut the cells of a
 * tile.
 *
 * Input: a brush's extension, the side table that it points into, and the segment's arc length. Output: camber_extras,
 * and whether a cell needs to be considered at all. */
#ifndef CAMBER_KERNELS_BRUSH_EXT_H
#define CAMBER_KERNELS_BRUSH_EXT_H

#include "features.h"
#include "segment.h"

/* Words of a segment's arc length: how far along its line A is, in px; the arc length of the line per px of the
 * segment; the line's length, in px; 0. */
#define CAMBER_SEGMENT_ARC_LENGTHS 4

/* The extension of a brush; each brush has one. It points into the side table, which is counted in float4s. A dash
 * takes one: where it begins and ends, in px; the list repeats the period's last dash before the first, and its first
 * after the last. A stop of a ramp takes two: its position, and its premultiplied colour. */
typedef struct camber_brush_ext {
    camber_u32 features;
    float half_gap, blur, period; /* px; a blur below 0 fades by a smooth step */
    camber_u32 first_dash, dash_count, round_dashes, image;
    camber_u32 first_stop, stop_count;
    float trim_from, trim_to; /* as fractions of the line's length */
} camber_brush_ext;

/* Returns the arc length of the line per px of the segment. */
CAMBER_FN camber_real camber_segment_rate(const camber_segment *s, camber_real from, camber_real to) {
    const camber_real dx = s->bx - s->ax, dy = s->by - s->ay, length = CAMBER_SQRT(dx * dx + dy * dy);
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f);
    return length > 0.0f ? (to - from) / (length > 0.0f ? length : one) : none;
}

/* Computes the coefficients of a segment's features. */
CAMBER_FN void camber_extras_of(const camber_brush_ext *brush_ext, CAMBER_GLOBAL const float *arc_length,
                                CAMBER_GLOBAL const float *side_table, camber_extras *e) {
    e->features = brush_ext->features;
    e->half_gap = brush_ext->half_gap;
    e->blur = brush_ext->blur;
    e->along = arc_length[0];
    e->rate = arc_length[1];
    e->total = arc_length[2];
    const float span = e->total > 1e-6f ? e->total : 1e-6f;
    e->trim_from = brush_ext->trim_from * span;
    e->trim_to = brush_ext->trim_to * span;
    e->period = brush_ext->period;
    e->dash_count = brush_ext->dash_count;
    e->round_dashes = brush_ext->round_dashes != 0u;
    e->dashes = side_table + 4 * brush_ext->first_dash;
    e->drawn = 1.0f;
    if (CAMBER_HAS(e->features, CAMBER_FEATURE_DASH) && e->period < CAMBER_SMALL_PERIOD_PX)
        e->drawn = camber_dashes_drawn(e);
    e->stops = side_table + 4 * brush_ext->first_stop;
    e->stop_count = brush_ext->stop_count;
}

/* ---- Cells ---- */

/* The position of a cell relative to a segment: outside it, near an end of it, across one of its sides, or completely
 * inside it. */
#define CAMBER_CELL_OUTSIDE 0u
#define CAMBER_CELL_NEAR_END 1u
#define CAMBER_CELL_PARTIAL 2u
#define CAMBER_CELL_FULL 3u

#if !CAMBER_STROKE_PITCHED
/* Computes the range of arc lengths of a cell's pixels, in px, from the position of its middle. */
CAMBER_FN void camber_extras_range(const camber_edge *p, const camber_extras *e, float x, float *low, float *high) {
    const float reach = 1.5f * (CAMBER_FABS(p->ux) + CAMBER_FABS(p->uy)), from = x - reach, to = x + reach;
    const float first = from > 0.0f ? from : 0.0f, last = to > 0.0f ? to : 0.0f;
    const float at_first = e->along + (first < p->length ? first : p->length) * e->rate;
    const float at_last = e->along + (last < p->length ? last : p->length) * e->rate;
    *low = (at_first < at_last ? at_first : at_last) - p->side.extent - 0.01f;
    *high = (at_first < at_last ? at_last : at_first) + p->side.extent + 0.01f;
}

/* Returns whether dashes leave a cell empty, cut it, or leave all of it. */
CAMBER_FN camber_u32 camber_dashes_meet(const camber_edge *p, const camber_extras *e, float low, float high) {
    const float spread = e->round_dashes ? p->half_width + p->side.extent : 0.0f;
    const float periods = low / e->period;
    if (!(periods >= 0.0f && periods < 8388608.0f))
        return CAMBER_CELL_NEAR_END;
    const float before = e->period * (float)(camber_i32)periods;
    camber_u32 whole = 0, some = 0;
    low -= before;
    high -= before;
    if (high > e->period)
        return CAMBER_CELL_NEAR_END;
    for (camber_u32 i = 0; i < e->dash_count; i++) {
        const float from = e->dashes[4 * i], to = e->dashes[4 * i + 1];
        whole |= from <= low && high <= to;
        some |= from - spread < high && to + spread > low;
    }
    return whole ? CAMBER_CELL_FULL : some ? CAMBER_CELL_NEAR_END : CAMBER_CELL_OUTSIDE;
}

/* Returns the position of a cell relative to a segment with features, given `meets`, its position relative to a plain
 * one. x and y: the cell's middle, along and across the segment. */
CAMBER_FN camber_u32 camber_extras_cell(const camber_edge *p, const camber_extras *e, camber_u32 meets, float x,
                                        float y) {
    const float aside = CAMBER_FABS(y), blur = CAMBER_FABS(e->blur),
                reach = 1.5f * (CAMBER_FABS(p->ux) + CAMBER_FABS(p->uy));
    const camber_u32 blurs = e->features & CAMBER_FEATURE_BLUR;
    camber_u32 inside = meets == CAMBER_CELL_FULL;
    if (meets == CAMBER_CELL_OUTSIDE || meets == CAMBER_CELL_NEAR_END)
        return meets;
    if (e->features & CAMBER_FEATURE_GAP) {
        if (aside + reach <= e->half_gap - (blurs ? blur + 0.5f : p->side.extent))
            return CAMBER_CELL_OUTSIDE;
        inside &= aside - reach >= e->half_gap + (blurs ? 0.5f : p->side.extent);
    }
    if (blurs)
        inside &= aside + reach <= p->half_width - blur - 0.5f;
    if (e->features & (CAMBER_FEATURE_DASH | CAMBER_FEATURE_TRIM)) {
        float low, high;
        camber_extras_range(p, e, x, &low, &high);
        if (e->features & CAMBER_FEATURE_TRIM) {
            if (low >= e->trim_from && high <= e->trim_to)
                return CAMBER_CELL_OUTSIDE;
            inside &= high <= e->trim_from || low >= e->trim_to;
        }
        if (e->features & CAMBER_FEATURE_DASH) {
            const camber_u32 left = camber_dashes_meet(p, e, low, high);
            if (left == CAMBER_CELL_OUTSIDE)
                return left;
            inside &= left == CAMBER_CELL_FULL;
        }
    }
    return inside ? CAMBER_CELL_FULL : CAMBER_CELL_PARTIAL;
}

#endif

#ifdef CAMBER_DEVICE
typedef char camber_brush_ext_is_whole_vectors[sizeof(camber_brush_ext) % 16 == 0 ? 1 : -1];
#else
_Static_assert(sizeof(camber_brush_ext) % 16 == 0, "the device reads whole float4s");
#endif

#endif
