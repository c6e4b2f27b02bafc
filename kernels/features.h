/* Gaps, blurs, dashes, trims and ramps: everything that varies along and across a stroke's line. Also the complete
 * formula of a pixel's area.
 *
 * Input: the coefficients of a segment, the coefficients of its brush (camber_extras), and a pixel as in stroke.h.
 * Output: the area that remains of the pixel, and its colour. C, OpenCL C and GLSL compile it; kernels draw features
 * only if they are built with CAMBER_RASTER_RICH. The macros below read dashes and stops from the side table, or from a
 * texture. */
#ifndef CAMBER_KERNELS_FEATURES_H
#define CAMBER_KERNELS_FEATURES_H

#include "stroke.h"

/* The features of a brush, as bits. A brush without any is drawn as in a plain frame. */
#define CAMBER_FEATURE_GAP 1u
#define CAMBER_FEATURE_BLUR 2u
#define CAMBER_FEATURE_DASH 4u
#define CAMBER_FEATURE_TRIM 8u
#define CAMBER_FEATURE_RAMP 16u
#define CAMBER_FEATURE_IMAGE 32u
/* features that change the colour from pixel to pixel */
#define CAMBER_FEATURES_COLORS (CAMBER_FEATURE_RAMP | CAMBER_FEATURE_IMAGE)
#define CAMBER_FEATURES_ALONG (CAMBER_FEATURE_DASH | CAMBER_FEATURE_TRIM | CAMBER_FEATURE_RAMP)

/* The most stops of a ramp that a cell, or in GL a pixel, reads. If it sees more, it merges several into one. */
#ifdef CAMBER_GLSL
#define CAMBER_STOPS_SEEN 16u
#else
#define CAMBER_STOPS_SEEN 1024u
#endif

/* The coefficients that a segment with features has besides its edge. */
CAMBER_STRUCT(camber_extras) {
    camber_u32 features;
    float half_gap, blur;     /* blur below 0: it fades by a smooth step */
    float along, rate, total; /* arc length of A, px; arc length per px; the line's whole length, px */
    float trim_from, trim_to; /* px along the line */
    float period, drawn;      /* the period of dashes, in px; the fraction of it that is drawn */
    camber_u32 dash_count, stop_count;
    camber_flag round_dashes;
#ifndef CAMBER_GLSL
    CAMBER_GLOBAL const float *dashes, *stops;
#endif
};

#ifdef CAMBER_GLSL
#define CAMBER_DASH_FROM(e, i) dash_at(i).x
#define CAMBER_DASH_TO(e, i) dash_at(i).y
#define CAMBER_STOP(e, i) (stop_at(i) * e.total)
#define CAMBER_STOP_COLOR(e, i, k) stop_color(i)[k]
#else
#define CAMBER_DASH_FROM(e, i) (e)->dashes[4u * (i)]
#define CAMBER_DASH_TO(e, i) (e)->dashes[4u * (i) + 1u]
#define CAMBER_STOP(e, i) ((e)->stops[8u * (i)] * (e)->total)
#define CAMBER_STOP_COLOR(e, i, k) (e)->stops[8u * (i) + 4u + (k)]
#endif

/* ---- Along the line ---- */

/* Returns the floor of numbers from 0 on. Floats from 2^23 on are integers already. */
CAMBER_FN camber_real camber_whole(camber_real x) {
#ifdef CAMBER_GLSL
    return floor(x);
#else
    const camber_real large = CAMBER_REAL(8388608.0f), bounded = x < large ? x : large;
    const camber_real whole = CAMBER_TRUNCATE(bounded);
    return x < large ? whole : x;
#endif
}

/* Returns how far along its line a pixel is, in px. Past an end of the segment it is as far as the end. */
CAMBER_FN camber_real camber_extras_along(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_extras) e, camber_real x) {
    const camber_real none = CAMBER_REAL(0.0f), most = CAMBER_REAL(p->length), least = x > 0.0f ? x : none;
    return e->along + (least < p->length ? least : most) * e->rate;
}

/* ---- Dashes ---- */

/* Dashes with a smaller period may fade to the fraction that they draw. With a pitch, how small they appear differs
 * from pixel to pixel. */
#if CAMBER_STROKE_PITCHED
#define CAMBER_SMALL_PERIOD_PX CAMBER_NEVER_PX
#else
#define CAMBER_SMALL_PERIOD_PX 2.0f
#endif

/* Returns the fraction of the period that dashes draw. */
CAMBER_FN float camber_dashes_drawn(CAMBER_IN(camber_extras) e) {
    float drawn = 0.0f;
    for (camber_u32 i = 0u; i < e->dash_count; i++) {
        const float from = CAMBER_DASH_FROM(e, i), to = CAMBER_DASH_TO(e, i);
        const float length = (to < e->period ? to : e->period) - (from > 0.0f ? from : 0.0f);
        drawn += length > 0.0f ? length : 0.0f;
    }
    return drawn / e->period;
}

/* A pixel's position in the dashes' period, and where in it the line begins and ends, in px. */
CAMBER_STRUCT(camber_dash_place) {
    camber_real at, first, last;
};

CAMBER_FN void camber_find_dash_place(CAMBER_IN(camber_extras) e, camber_real along,
                                      CAMBER_OUT(camber_dash_place) place) {
    const camber_real before = e->period * camber_whole(along / e->period);
    place->at = along - before;
    place->first = -before;
    place->last = e->total - before;
}

/* The fractions of a pixel that flat caps at A and B leave, and how far past them it is along the line, in px. */
CAMBER_STRUCT(camber_own_ends) {
    camber_real at_a, at_b, past;
};

/* aside: no end is near. */
CAMBER_FN void camber_find_own_ends(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_flag aside,
                                    CAMBER_OUT(camber_own_ends) ends) {
    const camber_real none = CAMBER_REAL(0.0f);
    ends->at_a = ends->at_b = CAMBER_REAL(1.0f);
    ends->past = none;
    if (aside || !p->capped)
        return;
    const float flat_a = camber_is_flat_join(p, -1.0f) ? CAMBER_NEVER_PX : p->flat_a;
    const float flat_b = camber_is_flat_join(p, 1.0f) ? CAMBER_NEVER_PX : p->flat_b;
    const camber_real past_a = CAMBER_MORE(at->past_a, none), past_b = CAMBER_MORE(at->past_b, none);
    ends->at_a = camber_cut_along(p, at, flat_a - at->past_a);
    ends->at_b = camber_cut_along(p, at, flat_b - at->past_b);
    ends->past = (flat_b < CAMBER_NEVER_PX ? past_b : none) - (flat_a < CAMBER_NEVER_PX ? past_a : none);
}

/* Returns the fraction of a pixel that dashes leave, after flat caps have left theirs. A dash that reaches an end of
 * the line is cut by the cap, and not also by its own edge: both would be in the same pixel, and the product of what
 * they leave would be too small. A pixel that spans more than a period gets the fraction of the period that is drawn.
 */
CAMBER_FN camber_real camber_dashes_cover(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_extras) e,
                                          CAMBER_IN(camber_pixel) at, camber_flag aside) {
    const camber_real none = CAMBER_REAL(0.0f), least = CAMBER_REAL(1e-6f);
    camber_real area = none;
    camber_dash_place place;
    camber_own_ends ends;
    camber_find_dash_place(e, at->along, CAMBER_REF(place));
    camber_find_own_ends(p, at, aside, CAMBER_REF(ends));
    for (camber_u32 i = 0u; i < e->dash_count; i++) {
        const float from = CAMBER_DASH_FROM(e, i), to = CAMBER_DASH_TO(e, i);
        const camber_real edge_from = camber_cut_along(p, at, place.at + ends.past - from);
        const camber_real edge_to = camber_cut_along(p, at, place.at + ends.past - to);
        const camber_real past_from = from <= place.first ? ends.at_a : edge_from;
        const camber_real past_to = to >= place.last ? 1.0f - ends.at_b : edge_to;
        area += CAMBER_BOTH(to > place.first, from < place.last) ? past_from - past_to : none;
    }
    const camber_real left = ends.at_a + ends.at_b - 1.0f;
    area = camber_clamp_to_one(area / CAMBER_MORE(left, least));
#if !CAMBER_STROKE_PITCHED
    if (e->period >= CAMBER_SMALL_PERIOD_PX)
        return area;
#endif
    const camber_real apart = camber_clamp_to_one(camber_seen_along(at, CAMBER_REAL(e->period)) - 1.0f);
    return e->drawn * (1.0f - apart) + area * apart;
}

/* Returns how far back along the line the nearest dash is, in px; negative if it is ahead. */
CAMBER_FN camber_real camber_off_dash(CAMBER_IN(camber_extras) e, camber_real along) {
    camber_dash_place place;
    camber_find_dash_place(e, along, CAMBER_REF(place));
    camber_real nearest = CAMBER_REAL(1e6f);
    for (camber_u32 i = 0u; i < e->dash_count; i++) {
        const camber_real from = CAMBER_REAL(CAMBER_DASH_FROM(e, i)), to = CAMBER_REAL(CAMBER_DASH_TO(e, i));
        const camber_real least = place.at > from ? place.at : from, off = place.at - (least < to ? least : to);
        /* No dash begins past the end of the line. */
        nearest = CAMBER_BOTH(CAMBER_FABS(off) < CAMBER_FABS(nearest), from < place.last) ? off : nearest;
    }
    return nearest;
}

#if CAMBER_STROKE_PITCHED
/* Returns the fraction of a line's area that round dashes draw. */
CAMBER_FN float camber_round_dashes_drawn(CAMBER_IN(camber_extras) e, float half_width) {
    float drawn = 0.0f;
    for (camber_u32 i = 0u; i < e->dash_count; i++) {
        const float from = CAMBER_DASH_FROM(e, i), to = CAMBER_DASH_TO(e, i);
        drawn += from >= 0.0f && to <= e->period ? to - from + 1.570796f * half_width : 0.0f;
    }
    return drawn < e->period ? drawn / e->period : 1.0f;
}

/* Blends round dashes smaller than a pixel into their fraction of the whole line, whose area is `whole`. */
CAMBER_FN camber_real camber_blend_round_dashes(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_extras) e,
                                                CAMBER_IN(camber_pixel) at, camber_real area, camber_real whole) {
    const camber_real apart = camber_clamp_to_one(camber_seen_along(at, CAMBER_REAL(e->period)) - 1.0f);
    return whole * camber_round_dashes_drawn(e, p->half_width) * (1.0f - apart) + area * apart;
}
#endif

/* Returns the area of round dashes. */
CAMBER_FN camber_real camber_round_dashes_within(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_extras) e,
                                                 CAMBER_INOUT(camber_pixel) at) {
#if CAMBER_STROKE_PITCHED
    camber_find_distance(p, at);
    const camber_real whole = camber_edge_within(p, at);
#endif
    camber_go_off(at, camber_off_dash(e, at->along));
    camber_find_distance(p, at);
    const camber_real area = camber_edge_within(p, at);
#if CAMBER_STROKE_PITCHED
    return camber_blend_round_dashes(p, e, at, area, whole);
#else
    return area;
#endif
}

/* ---- Beside the line ---- */

/* Returns how far a pixel is inside the second line of the join at an end; `rim` if there is no second line. */
CAMBER_FN camber_real camber_rim_at(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real rim,
                                    float out_of) {
    const float c = out_of > 0.0f ? p->cb : p->ca, s = out_of > 0.0f ? p->sb : p->sa;
    const camber_real past = out_of > 0.0f ? at->past_b : at->past_a;
    camber_second l;
    camber_second_of(out_of > 0.0f ? p->end_b : p->end_a, c, s, CAMBER_REF(l));
    if (!l.bevel && !l.miter)
        return rim;
    const camber_real inside = camber_second_inside(CAMBER_REF(l), p->half_width, past, at->y, c);
    return camber_second_cuts(CAMBER_REF(l), past, at->y, rim, CAMBER_LESS(rim, inside));
}

/* Returns the coverage of a blurred stroke: it grows inwards from half a pixel outside the edge, and falls towards the
 * gap. sharp: joins may cut the pixel. */
CAMBER_FN camber_real camber_blurred(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_extras) e, CAMBER_IN(camber_pixel) at,
                                     camber_flag sharp) {
    const float blur = CAMBER_FABS(e->blur);
    const camber_real outer = p->half_width - at->d;
    camber_real rim = outer;
    if (sharp) {
        const camber_real at_a = camber_rim_at(p, at, outer, -1.0f), at_b = camber_rim_at(p, at, outer, 1.0f);
        rim = CAMBER_LESS(at_a, at_b);
    }
    rim = camber_seen_away(p, at, rim);
    if (CAMBER_HAS(e->features, CAMBER_FEATURE_GAP)) {
        const camber_real inner = camber_seen_away(p, at, at->d - e->half_gap) + blur;
        rim = CAMBER_LESS(rim, inner);
    }
    const camber_real fade = camber_clamp_to_one((rim + 0.5f) / (blur + 1.0f));
    return e->blur < 0.0f ? fade * fade * (3.0f - 2.0f * fade) : fade;
}

/* ---- Areas ---- */

/* Returns the area of a pixel that the segment draws: the one formula that all functions of stroke.h are parts of.
 * features: the features of e, or 0 if none are to be drawn. aside: no end is near, so that only the sides count. */
CAMBER_FN CAMBER_INLINE camber_real camber_stroke_area(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_extras) e,
                                                       camber_u32 features, CAMBER_INOUT(camber_pixel) at,
                                                       camber_flag aside) {
    const camber_flag dashed = CAMBER_HAS(features, CAMBER_FEATURE_DASH), sharp = p->sharp && !aside;
    const camber_flag is_rounded = dashed && e->round_dashes, has_tips = p->tips && !aside;
    camber_real tips = CAMBER_REAL(1.0f);
    at->off = CAMBER_REAL(0.0f);
    at->across = at->y;
    if (!aside)
        camber_find_nearest(p, at);
    if (CAMBER_HAS(features, CAMBER_FEATURES_ALONG))
        at->along = camber_extras_along(p, e, at->x);
    if (has_tips)
        tips = camber_edge_tips(p, at);
    camber_real area;
    if (is_rounded) {
        area = camber_round_dashes_within(p, e, at);
    } else {
        camber_find_distance(p, at);
        area = camber_edge_within(p, at);
    }
    if (has_tips)
        area *= tips;
    if (sharp)
        area = camber_cut_joins(p, at, area, p->half_width);
    if (CAMBER_HAS(features, CAMBER_FEATURE_GAP)) {
        camber_real gap = camber_edge_band(p, at, e->half_gap);
        if (sharp)
            gap = camber_cut_joins(p, at, gap, e->half_gap);
        area = area > gap ? area - gap : CAMBER_REAL(0.0f);
    }
    if (CAMBER_HAS(features, CAMBER_FEATURE_BLUR))
        area = camber_blurred(p, e, at, sharp);
    if (p->capped && !aside)
        area = camber_edge_caps(p, at, area);
    if (dashed && !is_rounded)
        area *= camber_dashes_cover(p, e, at, aside);
    if (CAMBER_HAS(features, CAMBER_FEATURE_TRIM))
        area *=
            1.0f - camber_cut_along(p, at, at->along - e->trim_from) + camber_cut_along(p, at, at->along - e->trim_to);
    return aside ? area : camber_edge_owner(p, at, area);
}

/* ---- Colours ---- */

/* Returns how many stops are at or before a position on the line, in px. */
CAMBER_FN camber_u32 camber_stops_up_to(CAMBER_IN(camber_extras) e, float place) {
    camber_u32 low = 0u, high = e->stop_count;
    while (low < high) {
        const camber_u32 middle = (low + high) / 2u;
        if (CAMBER_STOP(e, middle) > place)
            high = middle;
        else
            low = middle + 1u;
    }
    return low;
}

/* Returns the colour between stop i - 1 and stop i. */
CAMBER_FN void camber_ramp_between(CAMBER_IN(camber_extras) e, camber_u32 i, camber_real along, CAMBER_COLOR(color)) {
    const camber_u32 next = i < e->stop_count ? i : i - 1u, before = i > 0u ? i - 1u : 0u;
    const float here = CAMBER_STOP(e, before), length = CAMBER_STOP(e, next) - here;
    const camber_real part = camber_clamp_to_one((along - here) / (length > 1e-6f ? length : 1e-6f));
    for (camber_u32 k = 0u; k < 4u; k++)
        color[k] = CAMBER_STOP_COLOR(e, before, k) * (1.0f - part) + CAMBER_STOP_COLOR(e, next, k) * part;
}

/* Returns the mean colour of the ramp over each pixel; all pixels are within the range of the ramp from low to high.
 * Between two stops a pixel has the colour in the middle of the part of the ramp that it sees. */
CAMBER_FN void camber_ramp_over(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_extras) e, CAMBER_IN(camber_pixel) at,
                                float low, float high, CAMBER_COLOR(color)) {
    const camber_u32 first = e->total > 0.0f ? camber_stops_up_to(e, low) : 0u;
    const camber_u32 end = e->total > 0.0f ? camber_stops_up_to(e, high) : 0u; /* a dot has the first stop's colour */
    const camber_real along = at->along, extent = camber_extent_along(p, at);
    if (first == end) {
        camber_ramp_between(e, first, along, color);
        return;
    }
    const camber_u32 last = end < e->stop_count ? end : e->stop_count - 1u;
    camber_u32 i = first > 0u ? first - 1u : 0u;
    const camber_u32 stride = (last - i + CAMBER_STOPS_SEEN - 1u) / CAMBER_STOPS_SEEN;
    const camber_real from = along - extent, to = along + extent;
    float here = CAMBER_STOP(e, i);
    camber_real past = camber_cut_along(p, at, along - here);
    for (camber_u32 k = 0u; k < 4u; k++)
        color[k] = CAMBER_STOP_COLOR(e, i, k) * (1.0f - past);
    while (i < last) {
        const camber_u32 next = i + stride < last ? i + stride : last;
        const float there = CAMBER_STOP(e, next), length = there - here;
        const camber_real past_there = camber_cut_along(p, at, along - there), share = past - past_there;
        const camber_real begin = from > here ? from : CAMBER_REAL(here), stop = to < there ? to : CAMBER_REAL(there);
        const camber_real part =
            camber_clamp_to_one((0.5f * (begin + stop) - here) / (length > 1e-6f ? length : 1e-6f));
        for (camber_u32 k = 0u; k < 4u; k++)
            color[k] += (CAMBER_STOP_COLOR(e, i, k) * (1.0f - part) + CAMBER_STOP_COLOR(e, next, k) * part) * share;
        here = there;
        past = past_there;
        i = next;
    }
    for (camber_u32 k = 0u; k < 4u; k++)
        color[k] += CAMBER_STOP_COLOR(e, last, k) * past;
}

#endif
