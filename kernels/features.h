/* The features that only kernels built with CAMBER_RASTER_RICH draw: gaps, blurs, dashes, trims, ramps and images.
 *
 * Input: a brush's extension, the side table that it points into, and the segment's arc length. Output: the area that a
 * pixel keeps, its colour, and whether a cell needs a look at all. shaders/stroke.frag holds the same formulas. */
#ifndef CAMBER_KERNELS_FEATURES_H
#define CAMBER_KERNELS_FEATURES_H

#include "coverage.h"

#if defined(CAMBER_DEVICE) && CAMBER_LANES == 16
#define CAMBER_TRUNCATE(x) convert_float16(convert_int16(x))
#else
#define CAMBER_TRUNCATE(x) ((float)(camber_i32)(x))
#endif

/* Words of a segment's arc length: how far along its line A lies, px; how much of the line a px of the segment is; the
 * line's length, px; 0. */
#define CAMBER_SEGMENT_ARC_LENGTHS 4

/* The features of a brush, as bits. A brush without any is drawn as in a plain frame. */
#define CAMBER_FEATURE_GAP 1u
#define CAMBER_FEATURE_BLUR 2u
#define CAMBER_FEATURE_DASH 4u
#define CAMBER_FEATURE_TRIM 8u
#define CAMBER_FEATURE_RAMP 16u
#define CAMBER_FEATURE_IMAGE 32u
/* these change the colour from pixel to pixel */
#define CAMBER_FEATURES_COLORS (CAMBER_FEATURE_RAMP | CAMBER_FEATURE_IMAGE)
#define CAMBER_FEATURES_ALONG (CAMBER_FEATURE_DASH | CAMBER_FEATURE_TRIM | CAMBER_FEATURE_RAMP)

/* The most stops of a ramp that a cell reads. Where it sees more, it takes several for one. */
#define CAMBER_STOPS_SEEN 1024u

/* One for each brush. It points into the side table, which is counted in float4s. A dash takes one: where it begins and
 * ends, px; the list repeats the period's last dash before the first, and its first behind the last. A stop of a ramp
 * takes two: its position, and its premultiplied colour. */
typedef struct camber_brush_ext {
    camber_u32 features;
    float half_gap, blur, period; /* px */
    camber_u32 first_dash, dash_count, round_dashes, image;
    camber_u32 first_stop, stop_count;
    float trim_from, trim_to; /* as shares of the line's length */
} camber_brush_ext;

/* How much of the line's arc length a px of the segment is. */
CAMBER_FN camber_real camber_segment_rate(const camber_segment *s, camber_real from, camber_real to) {
    const camber_real dx = s->bx - s->ax, dy = s->by - s->ay, length = CAMBER_SQRT(dx * dx + dy * dy);
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f);
    return length > 0.0f ? (to - from) / (length > 0.0f ? length : one) : none;
}

/* ---- A segment ---- */

/* The coefficients that a segment with features has besides its edge. */
typedef struct camber_extras {
    camber_u32 features;
    float half_gap, blur;
    camber_edge hole;         /* the gap's sides, as joins cut them */
    float along, rate, total; /* arc length of A, px; arc length of a px; the line's whole length, px */
    float trim_from, trim_to; /* px along the line */
    float period, drawn,
        from; /* of dashes: the period, px; the share of it that is drawn; where it begins, px from the line's ends */
    camber_u32 dash_count, round_dashes, stop_count;
    CAMBER_GLOBAL const float *dashes, *stops;
} camber_extras;

/* The share of the period that dashes draw. */
CAMBER_FN float camber_dashes_drawn(CAMBER_GLOBAL const float *dashes, camber_u32 count, float period) {
    float drawn = 0.0f;
    for (camber_u32 i = 0; i < count; i++) {
        const float from = dashes[4 * i], to = dashes[4 * i + 1];
        const float length = (to < period ? to : period) - (from > 0.0f ? from : 0.0f);
        drawn += length > 0.0f ? length : 0.0f;
    }
    return drawn / period;
}

/* Works out the coefficients. p: the segment's edge; NULL in a picture with a pitch. */
CAMBER_FN void camber_extras_of(const camber_brush_ext *brush_ext, const camber_edge *p,
                                CAMBER_GLOBAL const float *arc_length, CAMBER_GLOBAL const float *side_table,
                                camber_extras *e) {
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
    e->round_dashes = brush_ext->round_dashes;
    e->dashes = side_table + 4 * brush_ext->first_dash;
    e->drawn = 1.0f;
    if ((e->features & CAMBER_FEATURE_DASH) && (!p || e->period < 2.0f))
        e->drawn = camber_dashes_drawn(e->dashes, e->dash_count, e->period);
    e->from = 0.5f * e->total < 0.75f ? 0.5f * e->total : 0.75f;
    e->stops = side_table + 4 * brush_ext->first_stop;
    e->stop_count = brush_ext->stop_count;
    if ((e->features & CAMBER_FEATURE_GAP) && p && p->sharp) {
        e->hole = *p;
        e->hole.half_width = e->half_gap;
    }
}

/* ---- Along the line ---- */

/* floor of numbers from 0 on. Floats from 2^23 on are whole already. */
CAMBER_FN camber_real camber_whole(camber_real x) {
    const camber_real large = CAMBER_REAL(8388608.0f), bounded = x < large ? x : large;
    const camber_real whole = CAMBER_TRUNCATE(bounded);
    return x < large ? whole : x;
}

/* How far along its line a pixel lies, px. Past an end of the segment it is as far as the end. */
CAMBER_FN camber_real camber_extras_along(const camber_edge *p, const camber_extras *e, camber_real x) {
    const camber_real none = CAMBER_REAL(0.0f), most = CAMBER_REAL(p->length);
    const camber_real least = x > 0.0f ? x : none;
    return e->along + (least < p->length ? least : most) * e->rate;
}

/* Where in the dashes' period a pixel lies, px. At an end of the line the cap cuts, so up to there the dashes go on as
 * they are a little before the end. */
CAMBER_FN camber_real camber_dash_place(const camber_extras *e, camber_real along) {
    const float last = e->total - e->from;
    const camber_real least = along > e->from ? along : CAMBER_REAL(e->from);
    const camber_real inside = least < last ? least : CAMBER_REAL(last), at = e->round_dashes ? along : inside;
    return at - e->period * camber_whole(at / e->period);
}

/* The share of a pixel that dashes leave, by where in the period it lies. A pixel that holds more than a period gets
 * the share of the period that is drawn. */
CAMBER_FN camber_real camber_dashes_cover(const camber_edge *p, const camber_extras *e, camber_real t) {
    camber_real area = CAMBER_REAL(0.0f);
    for (camber_u32 i = 0; i < e->dash_count; i++)
        area += camber_inside_edge(p, t - e->dashes[4 * i]) - camber_inside_edge(p, t - e->dashes[4 * i + 1]);
    if (e->period >= 2.0f)
        return area;
    const float weight = e->period > 1.0f ? e->period - 1.0f : 0.0f;
    return e->drawn * (1.0f - weight) + area * weight;
}

/* The distance to the nearest dash, px along the line. */
CAMBER_FN camber_real camber_dash_distance(const camber_extras *e, camber_real t) {
    camber_real nearest = CAMBER_REAL(1e6f);
    for (camber_u32 i = 0; i < e->dash_count; i++) {
        const camber_real before = e->dashes[4 * i] - t, behind = t - e->dashes[4 * i + 1];
        const camber_real farther = CAMBER_MORE(before, behind);
        nearest = CAMBER_LESS(nearest, farther);
    }
    return nearest > 0.0f ? nearest : CAMBER_REAL(0.0f);
}

/* ---- Pixels ---- */

/* The share of a pixel inside the gap. Both sides of the gap may lie in one pixel. */
CAMBER_FN camber_real camber_gap_area(const camber_edge *p, float half_gap, camber_real d) {
    const camber_real both = camber_inside_edge(p, half_gap - d) + camber_inside_edge(p, half_gap + d) - 1.0f;
    return both > 0.0f ? both : CAMBER_REAL(0.0f);
}

/* How far inside the second lines of its joins a pixel lies, px; far where there are none. */
CAMBER_FN camber_real camber_rim_at(const camber_edge *p, camber_real rim, camber_u32 end, camber_real past,
                                    camber_real y, float c, float s) {
    camber_second l;
    camber_second_of(end, c, s, &l);
    if (!l.bevel && !l.miter)
        return rim;
    const camber_real inside = camber_second_inside(&l, p->half_width, past, y, c), nearer = CAMBER_LESS(rim, inside);
    if (l.bevel)
        return nearer;
    return ((past > -1.0f) & (y * l.outer > 0.0f)) ? nearer : rim;
}

/* The coverage of a blurred stroke: it grows from half a pixel outside the edge inwards, and falls towards the gap. */
CAMBER_FN camber_real camber_blurred(const camber_edge *p, const camber_extras *e, camber_u32 aside, camber_real d,
                                     camber_real x, camber_real y) {
    camber_real rim = p->half_width - d;
    if (p->sharp && !aside) {
        const camber_real outer = rim;
        const camber_real at_a = camber_rim_at(p, outer, p->end_a, -x, y, p->ca, p->sa);
        const camber_real at_b = camber_rim_at(p, outer, p->end_b, x - p->length, y, p->cb, p->sb);
        rim = CAMBER_LESS(at_a, at_b);
    }
    if (e->features & CAMBER_FEATURE_GAP) {
        const camber_real inner = d - e->half_gap + e->blur;
        rim = CAMBER_LESS(rim, inner);
    }
    return camber_clamp_to_one((rim + 0.5f) / (e->blur + 1.0f));
}

/* The area of a pixel that the segment draws: camber_edge_area with features. aside: no end is near, as in
 * camber_edge_side. */
CAMBER_FN camber_real camber_extras_area(const camber_edge *p, const camber_extras *e, camber_u32 aside, camber_real x,
                                         camber_real y, camber_real fa, camber_real fb) {
    const camber_u32 dashed = e->features & CAMBER_FEATURE_DASH;
    camber_real bent = y, arc = CAMBER_REAL(0.0f), along = arc, place = arc;
    if (!aside)
        arc = camber_edge_off(p, x, y, fa, fb, &bent);
    if (e->features & CAMBER_FEATURES_ALONG)
        along = camber_extras_along(p, e, x);
    if (dashed)
        place = camber_dash_place(e, along);
    if (dashed && e->round_dashes)
        arc += camber_dash_distance(e, place);
    const camber_real d = CAMBER_SQRT(arc * arc + bent * bent);
    camber_real area = camber_edge_within(p, p->half_width, d);
    if (p->tips && !aside)
        area *= camber_edge_tips(p, x);
    if (p->sharp && !aside)
        area = camber_cut_joins(p, area, x, y);
    if (e->features & CAMBER_FEATURE_GAP) {
        camber_real gap = camber_gap_area(p, e->half_gap, d);
        if (p->sharp && !aside)
            gap = camber_cut_joins(&e->hole, gap, x, y);
        area = area > gap ? area - gap : CAMBER_REAL(0.0f);
    }
    if (e->features & CAMBER_FEATURE_BLUR)
        area = camber_blurred(p, e, aside, d, x, y);
    if (p->flat && !aside)
        area *= camber_edge_caps(p, x);
    if (dashed && !e->round_dashes)
        area *= camber_dashes_cover(p, e, place);
    if (e->features & CAMBER_FEATURE_TRIM)
        area *= 1.0f - camber_inside_edge(p, along - e->trim_from) + camber_inside_edge(p, along - e->trim_to);
    return aside ? area : camber_edge_owner(p, area, x, y, fa, fb);
}

/* ---- Cells ---- */

/* How a cell lies to a segment: outside it, near an end of it, across one of its sides, or all inside it. */
#define CAMBER_CELL_OUTSIDE 0u
#define CAMBER_CELL_NEAR_END 1u
#define CAMBER_CELL_PARTIAL 2u
#define CAMBER_CELL_FULL 3u

/* The arc lengths between which the pixels of a cell lie, px, by the position of its middle. */
CAMBER_FN void camber_extras_range(const camber_edge *p, const camber_extras *e, float x, float *low, float *high) {
    const float reach = 1.5f * (CAMBER_FABS(p->ux) + CAMBER_FABS(p->uy)), from = x - reach, to = x + reach;
    const float first = from > 0.0f ? from : 0.0f, last = to > 0.0f ? to : 0.0f;
    const float at_first = e->along + (first < p->length ? first : p->length) * e->rate;
    const float at_last = e->along + (last < p->length ? last : p->length) * e->rate;
    *low = (at_first < at_last ? at_first : at_last) - p->extent - 0.01f;
    *high = (at_first < at_last ? at_last : at_first) + p->extent + 0.01f;
}

/* Whether dashes leave a cell empty, cut it, or leave all of it. */
CAMBER_FN camber_u32 camber_dashes_meet(const camber_edge *p, const camber_extras *e, float low, float high) {
    const float last = e->total - e->from, spread = e->round_dashes ? p->half_width + p->extent : 0.0f;
    if (!e->round_dashes) {
        low = low > e->from ? low : e->from;
        low = low < last ? low : last;
        high = high > e->from ? high : e->from;
        high = high < last ? high : last;
    }
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

/* How a cell lies to a segment with features, if `meets` is how it lies to a plain one. x and y: the cell's middle,
 * along and across the segment. */
CAMBER_FN camber_u32 camber_extras_cell(const camber_edge *p, const camber_extras *e, camber_u32 meets, float x,
                                        float y) {
    const float aside = CAMBER_FABS(y), reach = 1.5f * (CAMBER_FABS(p->ux) + CAMBER_FABS(p->uy));
    const camber_u32 blurs = e->features & CAMBER_FEATURE_BLUR;
    camber_u32 inside = meets == CAMBER_CELL_FULL;
    if (meets == CAMBER_CELL_OUTSIDE || meets == CAMBER_CELL_NEAR_END)
        return meets;
    if (e->features & CAMBER_FEATURE_GAP) {
        if (aside + reach <= e->half_gap - (blurs ? e->blur + 0.5f : p->extent))
            return CAMBER_CELL_OUTSIDE;
        inside &= aside - reach >= e->half_gap + (blurs ? 0.5f : p->extent);
    }
    if (blurs)
        inside &= aside + reach <= p->half_width - e->blur - 0.5f;
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

/* ---- Colours ---- */

/* How many stops lie up to a position on the line. */
CAMBER_FN camber_u32 camber_stops_up_to(const camber_extras *e, float place) {
    camber_u32 low = 0, high = e->stop_count;
    while (low < high) {
        const camber_u32 middle = (low + high) / 2;
        if (e->stops[8 * middle] * e->total > place)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

CAMBER_FN void camber_ramp_between(const camber_extras *e, camber_u32 i, camber_real along, camber_real color[4]) {
    const camber_u32 next = i < e->stop_count ? i : i - 1, before = i ? i - 1 : 0;
    CAMBER_GLOBAL const float *from = e->stops + 8 * before, *to = e->stops + 8 * next;
    const float here = from[0] * e->total, length = to[0] * e->total - here;
    const camber_real part = camber_clamp_to_one((along - here) / (length > 1e-6f ? length : 1e-6f));
    for (camber_u32 k = 0; k < 4; k++)
        color[k] = from[4 + k] * (1.0f - part) + to[4 + k] * part;
}

/* The mean colour of the ramp over each pixel of a cell, which sees the ramp from low to high. Between two stops a
 * pixel has the colour in the middle of the stretch of the ramp that it sees. */
CAMBER_FN void camber_ramp_over(const camber_edge *p, const camber_extras *e, camber_real along, float low, float high,
                                camber_real color[4]) {
    const camber_u32 first = e->total > 0.0f ? camber_stops_up_to(e, low) : 0;
    const camber_u32 end = e->total > 0.0f ? camber_stops_up_to(e, high) : 0; /* a dot has its first */
    if (first == end) {
        camber_ramp_between(e, first, along, color);
        return;
    }
    const camber_u32 last = end < e->stop_count ? end : e->stop_count - 1;
    camber_u32 i = first ? first - 1 : 0;
    const camber_u32 stride = (last - i + CAMBER_STOPS_SEEN - 1) / CAMBER_STOPS_SEEN;
    const camber_real from = along - p->extent, to = along + p->extent;
    float here = e->stops[8 * i] * e->total;
    camber_real past = camber_inside_edge(p, along - here);
    for (camber_u32 k = 0; k < 4; k++)
        color[k] = e->stops[8 * i + 4 + k] * (1.0f - past);
    while (i < last) {
        const camber_u32 next = i + stride < last ? i + stride : last;
        const float there = e->stops[8 * next] * e->total, length = there - here;
        const camber_real past_there = camber_inside_edge(p, along - there), share = past - past_there;
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

#ifdef CAMBER_DEVICE
typedef char camber_brush_ext_is_whole_vectors[sizeof(camber_brush_ext) % 16 == 0 ? 1 : -1];
#else
_Static_assert(sizeof(camber_brush_ext) % 16 == 0, "the device reads whole float4s");
#endif

#endif
