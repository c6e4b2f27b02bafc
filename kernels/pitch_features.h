/* Gaps, blurs, dashes, trims, ramps and images in a picture with a pitch.
 *
 * Input and output are those of features.h, for pixels of pitch_coverage.h. Lengths along and across a line are px of
 * the plane; a blur is px of the picture. shaders/stroke.frag holds the same formulas under PITCHED. */
#ifndef CAMBER_KERNELS_PITCH_FEATURES_H
#define CAMBER_KERNELS_PITCH_FEATURES_H

#include "features.h"
#include "pitch_coverage.h"

/* The share of a pixel before a point of the line that lies so many px of the plane farther along it. */
CAMBER_FN camber_real camber_pitch_before(const camber_pitch_edge *p, const camber_pitch_pixel *at, camber_real px) {
    return camber_seen_covered(px * at->scale, at->along_x, at->along_y, p->linear);
}

/* How far along its line a pixel lies, px. Past an end of the segment it is as far as the end. */
CAMBER_FN camber_real camber_pitch_along(const camber_pitch_edge *p, const camber_extras *e,
                                         const camber_pitch_pixel *at) {
    const camber_real none = CAMBER_REAL(0.0f), most = CAMBER_REAL(p->length);
    const camber_real least = at->x > 0.0f ? at->x : none;
    return e->along + (least < p->length ? least : most) * e->rate;
}

/* ---- Dashes ---- */

/* How well dashes are seen apart, from 0 to 1. A pixel that holds more than a period sees their share alone. */
CAMBER_FN camber_real camber_pitch_apart(const camber_extras *e, const camber_pitch_pixel *at) {
    return camber_clamp_to_one(e->period * at->scale - 1.0f);
}

CAMBER_FN camber_real camber_pitch_dashes(const camber_pitch_edge *p, const camber_extras *e,
                                          const camber_pitch_pixel *at, camber_real t) {
    const camber_real apart = camber_pitch_apart(e, at);
    camber_real area = CAMBER_REAL(0.0f);
    for (camber_u32 i = 0; i < e->dash_count; i++)
        area += camber_pitch_before(p, at, t - e->dashes[4 * i]) - camber_pitch_before(p, at, t - e->dashes[4 * i + 1]);
    return e->drawn * (1.0f - apart) + area * apart;
}

/* The distance to the nearest dash, px along the line; below 0 if it lies ahead. */
CAMBER_FN camber_real camber_pitch_off_dash(const camber_extras *e, camber_real t) {
    camber_real nearest = CAMBER_REAL(1e6f);
    for (camber_u32 i = 0; i < e->dash_count; i++) {
        const camber_real from = CAMBER_REAL(e->dashes[4 * i]), to = CAMBER_REAL(e->dashes[4 * i + 1]);
        const camber_real least = t > from ? t : from, off = t - (least < to ? least : to);
        nearest = CAMBER_FABS(off) < CAMBER_FABS(nearest) ? off : nearest;
    }
    return nearest;
}

/* The share of a line's area that round dashes draw. */
CAMBER_FN float camber_round_dashes_drawn(const camber_extras *e, float half_width) {
    float drawn = 0.0f;
    for (camber_u32 i = 0; i < e->dash_count; i++) {
        const float from = e->dashes[4 * i], to = e->dashes[4 * i + 1];
        drawn += from >= 0.0f && to <= e->period ? to - from + 1.570796f * half_width : 0.0f;
    }
    return drawn < e->period ? drawn / e->period : 1.0f;
}

/* Blends round dashes smaller than a pixel into their share of the whole line. */
CAMBER_FN camber_real camber_pitch_blend_dashes(const camber_pitch_edge *p, const camber_extras *e,
                                                const camber_pitch_pixel *at, camber_real area) {
    const camber_real apart = camber_pitch_apart(e, at), none = CAMBER_REAL(0.0f), d = CAMBER_FABS(at->y);
    const camber_real side = at->y < 0.0f ? CAMBER_REAL(-1.0f) : CAMBER_REAL(1.0f);
    const camber_real nx = 0.0f - side * p->uy, ny = side * p->ux;
    const camber_real both = camber_plane_covered(p, at, p->half_width - d, nx, ny) +
                             camber_plane_covered(p, at, p->half_width + d, 0.0f - nx, 0.0f - ny) - 1.0f;
    const camber_real whole = (both > 0.0f ? both : none) * camber_round_dashes_drawn(e, p->half_width);
    return whole * (1.0f - apart) + area * apart;
}

/* ---- Pixels ---- */

/* How many px of the picture a px of the plane is, in the direction from the nearest point of the line. */
CAMBER_FN camber_real camber_pitch_scale(const camber_pitch_edge *p, const camber_pitch_pixel *at) {
    camber_real side[2];
    const camber_real lies = at->side_x * at->ground_x + at->side_y * at->ground_y;
    return camber_pitch_normal(p, at->side_x, at->side_y, lies, side) * at->by_depth;
}

/* How far inside the second line of a join, where there is one. */
CAMBER_FN camber_real camber_pitch_rim(const camber_pitch_edge *p, const camber_pitch_pixel *at, camber_real rim,
                                       int at_b) {
    const float c = at_b ? p->cb : p->ca;
    const camber_real past = at_b ? at->past_b : at->past_a;
    camber_second l;
    camber_second_of(at_b ? p->end_b : p->end_a, c, at_b ? p->sb : p->sa, &l);
    if (!l.bevel && !l.miter)
        return rim;
    const camber_real inside = camber_second_inside(&l, p->half_width, past, at->y, c);
    const camber_real nearer = CAMBER_LESS(rim, inside);
    if (l.bevel)
        return nearer;
    return ((past > -1.0f) & (at->y * l.outer > 0.0f)) ? nearer : rim;
}

/* The coverage of a blurred stroke: it grows from half a pixel outside the edge inwards, and falls towards the gap. */
CAMBER_FN camber_real camber_pitch_blurred(const camber_pitch_edge *p, const camber_extras *e,
                                           const camber_pitch_pixel *at) {
    const camber_real across = camber_pitch_scale(p, at), outer = p->half_width - at->d;
    const camber_real at_a = camber_pitch_rim(p, at, outer, 0), at_b = camber_pitch_rim(p, at, outer, 1);
    camber_real rim = CAMBER_LESS(at_a, at_b) * across;
    if (e->features & CAMBER_FEATURE_GAP) {
        const camber_real inner = (at->d - e->half_gap) * across + e->blur;
        rim = CAMBER_LESS(rim, inner);
    }
    return camber_clamp_to_one((rim + 0.5f) / (e->blur + 1.0f));
}

/* The share of a pixel that a gap and a blur leave. */
CAMBER_FN camber_real camber_pitch_hollow(const camber_pitch_edge *p, const camber_extras *e,
                                          const camber_pitch_pixel *at, camber_real area) {
    if (e->features & CAMBER_FEATURE_BLUR)
        return camber_pitch_blurred(p, e, at);
    if (e->features & CAMBER_FEATURE_GAP) {
        camber_real gap = camber_pitch_within(p, at, CAMBER_REAL(e->half_gap));
        if (p->sharp)
            gap = camber_pitch_joins(p, at, gap, e->half_gap);
        return area > gap ? area - gap : CAMBER_REAL(0.0f);
    }
    return area;
}

/* camber_pitch_area for a brush with features. along: the pixel's arc length, px. */
CAMBER_FN camber_real camber_pitch_extras_area(const camber_pitch_edge *p, const camber_extras *e,
                                               camber_pitch_pixel *at, camber_real *along) {
    const camber_u32 dashed = e->features & CAMBER_FEATURE_DASH, rounded = dashed && e->round_dashes;
    camber_real tips = CAMBER_REAL(1.0f), place = tips;
    camber_pitch_arc_length(p, at);
    *along = camber_pitch_along(p, e, at);
    if (dashed)
        place = camber_dash_place(e, *along);
    if (p->tip_a || p->tip_b)
        tips = camber_pitch_tips(p, at);
    if (rounded)
        at->off += camber_pitch_off_dash(e, place);
    camber_pitch_turn(p, at);
    camber_real area = camber_pitch_within(p, at, CAMBER_REAL(p->half_width));
    if (rounded)
        area = camber_pitch_blend_dashes(p, e, at, area);
    area *= tips;
    if (p->sharp)
        area = camber_pitch_joins(p, at, area, p->half_width);
    area = camber_pitch_hollow(p, e, at, area);
    if (p->flat)
        area = camber_pitch_caps(p, at, area);
    if (dashed && !rounded)
        area *= camber_pitch_dashes(p, e, at, place);
    if (e->features & CAMBER_FEATURE_TRIM)
        area *=
            1.0f - camber_pitch_before(p, at, *along - e->trim_from) + camber_pitch_before(p, at, *along - e->trim_to);
    return area * camber_pitch_share(p, at);
}

/* ---- Colours ---- */

/* How far half a pixel reaches along the line, px of the plane. */
CAMBER_FN camber_real camber_pitch_extent(const camber_pitch_edge *p, const camber_pitch_pixel *at) {
    const camber_real px = 0.5f * (CAMBER_FABS(at->along_x) + CAMBER_FABS(at->along_y));
    return (p->linear ? CAMBER_REAL(0.5f) : px) / at->scale;
}

/* camber_ramp_over for pixels that see the ramp from low to high. */
CAMBER_FN void camber_pitch_ramp(const camber_pitch_edge *p, const camber_extras *e, const camber_pitch_pixel *at,
                                 camber_real along, const float range[2], camber_real color[4]) {
    const camber_u32 first = e->total > 0.0f ? camber_stops_up_to(e, range[0]) : 0;
    const camber_u32 end = e->total > 0.0f ? camber_stops_up_to(e, range[1]) : 0; /* a dot has its first */
    if (first == end) {
        camber_ramp_between(e, first, along, color);
        return;
    }
    const camber_real extent = camber_pitch_extent(p, at), from = along - extent, to = along + extent;
    const camber_u32 last = end < e->stop_count ? end : e->stop_count - 1;
    camber_u32 i = first ? first - 1 : 0;
    const camber_u32 stride = (last - i + CAMBER_STOPS_SEEN - 1) / CAMBER_STOPS_SEEN;
    float here = e->stops[8 * i] * e->total;
    camber_real past = camber_pitch_before(p, at, along - here);
    for (camber_u32 k = 0; k < 4; k++)
        color[k] = e->stops[8 * i + 4 + k] * (1.0f - past);
    while (i < last) {
        const camber_u32 next = i + stride < last ? i + stride : last;
        const float there = e->stops[8 * next] * e->total, length = there - here;
        const camber_real past_there = camber_pitch_before(p, at, along - there), share = past - past_there;
        const camber_real begin = from > here ? from : CAMBER_REAL(here), stop = to < there ? to : CAMBER_REAL(there);
        const camber_real middle = 0.5f * (begin + stop);
        const camber_real part = camber_clamp_to_one((middle - here) / (length > 1e-6f ? length : 1e-6f));
        for (camber_u32 k = 0; k < 4; k++)
            color[k] += (e->stops[8 * i + 4 + k] * (1.0f - part) + e->stops[8 * next + 4 + k] * part) * share;
        here = there;
        past = past_there;
        i = next;
    }
    for (camber_u32 k = 0; k < 4; k++)
        color[k] += e->stops[8 * last + 4 + k] * past;
}

#endif
