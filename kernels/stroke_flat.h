/* How edges appear in a picture without a pitch: unchanged. A part of stroke.h. */
#ifndef CAMBER_KERNELS_STROKE_FLAT_H
#define CAMBER_KERNELS_STROKE_FLAT_H

#ifdef CAMBER_GLSL
/* The coefficients that fragments read. */
CAMBER_STRUCT(camber_edge) {
    float ux, uy, length, half_width;
    camber_profile side;
    float ca, sa, cb, sb, flat_a, flat_b, round_a, round_b, tip_a, tip_b, owner_a, owner_b;
    camber_u32 end_a, end_b;
    camber_flag linear, thin, tips, capped, sharp;
};
#endif

/* A pixel relative to a segment, in px. */
CAMBER_STRUCT(camber_pixel) {
    camber_real x, y;           /* along the segment, and across it */
    camber_real past_a, past_b; /* past the ends, along the segment */
    camber_real fa, fb;         /* past the bisectors */
    camber_real off, across;    /* from the nearest point of the line: along it, and across */
    camber_real d;              /* the same as one distance */
    camber_real along;          /* arc length */
#ifdef CAMBER_GLSL
    float tie; /* CAMBER_TIE */
#endif
};

/* Returns how many px of the picture a distance along the line, or away from it, is. */
CAMBER_FN camber_real camber_seen_along(CAMBER_IN(camber_pixel) at, camber_real px) {
    CAMBER_UNUSED(at)
    return px;
}

CAMBER_FN camber_real camber_seen_away(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real px) {
    CAMBER_UNUSED(p)
    CAMBER_UNUSED(at)
    return px;
}

/* Returns the fraction of a pixel inside an edge across the line, with its centre s px inside it. */
CAMBER_FN camber_real camber_cut_along(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real s) {
    CAMBER_UNUSED(at)
    return camber_covered(s, CAMBER_REF(p->side));
}

/* Returns the fraction of a pixel inside an edge of the stroke, whose normal points from the line to the pixel (facing:
 * 1) or back (-1). */
CAMBER_FN camber_real camber_cut_beside(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real s,
                                        float facing) {
    CAMBER_UNUSED(at)
    CAMBER_UNUSED(facing)
    return camber_covered(s, CAMBER_REF(p->side));
}

/* Returns the fraction of a pixel inside a join's second line. cosine: the cosine of the angle between the line and the
 * stroke's edge. */
CAMBER_FN camber_real camber_cut_second(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at,
                                        CAMBER_IN(camber_second) l, float out_of, camber_real inside,
                                        CAMBER_OUT(camber_real) cosine) {
    CAMBER_UNUSED(at)
    camber_profile e;
    camber_profile_of(l->nx * out_of * p->ux - l->ny * p->uy, l->nx * out_of * p->uy + l->ny * p->ux, p->linear,
                      CAMBER_REF(e));
    CAMBER_AT(cosine) = CAMBER_REAL(l->outer * l->ny);
    return camber_covered(inside, CAMBER_REF(e));
}

/* Returns how far half a pixel reaches along the line. */
CAMBER_FN camber_real camber_extent_along(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at) {
    CAMBER_UNUSED(at)
    return CAMBER_REAL(p->side.extent);
}

/* Whether an end is no flat cap, of which nothing but its own edge counts. Shaders need not know. */
#ifdef CAMBER_GLSL
#define CAMBER_GOES_ON_A(p) true
#define CAMBER_GOES_ON_B(p) true
#else
#define CAMBER_GOES_ON_A(p) ((p)->goes_on_a)
#define CAMBER_GOES_ON_B(p) ((p)->goes_on_b)
#endif

/* Finds the nearest point of the line: fills in `off` and `across`. */
CAMBER_FN void camber_find_nearest(CAMBER_IN(camber_edge) p, CAMBER_INOUT(camber_pixel) at) {
    const camber_real none = CAMBER_REAL(0.0f), arc_a = CAMBER_GOES_ON_A(p) ? at->past_a - p->round_a : none,
                      arc_b = CAMBER_GOES_ON_B(p) ? at->past_b - p->round_b : none;
    const camber_real bend_a = CAMBER_GOES_ON_A(p) ? camber_join_bend(at->fa, p->sa) : none,
                      bend_b = CAMBER_GOES_ON_B(p) ? camber_join_bend(-at->fb, p->sb) : none;
    const camber_real farther = CAMBER_MORE(arc_a, arc_b), arc = CAMBER_MORE(farther, none);
    /* More than a pixel onto an arc, past the segment's end, only the distance counts. */
    const camber_real straight = 1.0f - arc, bend = bend_a + bend_b;
    at->off = arc;
    at->across = at->y - bend * CAMBER_MORE(straight, none);
}

/* Adds the distance between the nearest point of the line and a dash. */
CAMBER_FN void camber_go_off(CAMBER_INOUT(camber_pixel) at, camber_real off) {
    at->off += CAMBER_FABS(off);
}

CAMBER_FN void camber_find_distance(CAMBER_IN(camber_edge) p, CAMBER_INOUT(camber_pixel) at) {
    CAMBER_UNUSED(p)
    at->d = CAMBER_SQRT(at->off * at->off + at->across * at->across);
}

/* Returns the fraction of a pixel that the round caps of a thin line leave. */
CAMBER_FN camber_real camber_edge_tips(CAMBER_IN(camber_edge) p, CAMBER_INOUT(camber_pixel) at) {
    const camber_real tips =
        camber_clamp_to_one(p->tip_a - at->past_a) + camber_clamp_to_one(p->tip_b - at->past_b) - 1.0f;
    return tips > 0.0f ? tips : CAMBER_REAL(0.0f);
}

/* Returns the fraction of a pixel inside the cap of a flat join, which is turned by an angle from the segment's own
 * end: it is cut like an edge across the segment. cosine: the cosine of the angle between the two in the picture. */
CAMBER_FN camber_real camber_cut_turned(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real s,
                                        float out_of, float turn_cosine, float turn_sine,
                                        CAMBER_OUT(camber_real) cosine) {
    CAMBER_UNUSED(out_of)
    CAMBER_UNUSED(turn_sine)
    CAMBER_AT(cosine) = CAMBER_REAL(turn_cosine);
    return camber_cut_along(p, at, s);
}

#include "stroke_caps.inl"

/* Returns the part of an area between both ends. at_a, at_b: the fractions that each of them leaves. */
CAMBER_FN camber_real camber_between_ends(camber_real area, camber_real at_a, camber_real at_b) {
    const camber_real both = at_a + at_b - 1.0f;
    return area * (both > 0.0f ? both : CAMBER_REAL(0.0f));
}

/* Returns the part of an area that flat ends leave: one end, or both of a short segment. Ends that are not flat leave
 * the whole area. */
CAMBER_FN camber_real camber_edge_caps(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real area) {
    return camber_between_ends(area, camber_cut_end(p, at, -1.0f), camber_cut_end(p, at, 1.0f));
}

/* Returns the area, or 0 if the pixel is on the neighbour's side of a bisector and the neighbour draws it. */
CAMBER_FN camber_real camber_edge_owner(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real area) {
    const camber_mask no = CAMBER_ALL_LANES(CAMBER_NO);
    const camber_mask at_a = CAMBER_GOES_ON_A(p) ? CAMBER_BOTH(at->fa<-CAMBER_TIE(at), at->past_a> p->owner_a) : no;
    const camber_mask at_b = CAMBER_GOES_ON_B(p) ? CAMBER_BOTH(at->fb >= CAMBER_TIE(at), at->past_b > p->owner_b) : no;
    return CAMBER_EITHER(at_a, at_b) ? CAMBER_REAL(0.0f) : area;
}

/* Returns how far inside a flat end a pixel is, and the end's normal along and across the segment. */
CAMBER_FN camber_real camber_end_normal(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, float out_of,
                                        CAMBER_OUT(camber_real) nx, CAMBER_OUT(camber_real) ny) {
    const camber_real cap = out_of > 0.0f ? p->flat_b - at->past_b : p->flat_a - at->past_a;
    camber_flat_end f;
    CAMBER_AT(nx) = CAMBER_REAL(-out_of);
    CAMBER_AT(ny) = CAMBER_REAL(0.0f);
    if (!camber_is_flat_join(p, out_of))
        return cap;
    camber_find_flat_end(p, at, out_of, CAMBER_REF(f));
    const camber_mask is_cap = CAMBER_BOTH(!f.behind, f.cap > f.body);
    CAMBER_AT(nx) = is_cap ? CAMBER_REAL(-out_of * f.cosine) : CAMBER_AT(nx);
    CAMBER_AT(ny) = is_cap ? CAMBER_REAL(-f.sine) : CAMBER_AT(ny);
    return is_cap ? f.cap : f.body;
}

/* Computes the normal of the nearest edge, into the stroke, in the picture. Returns whether it has one. */
CAMBER_FN camber_mask camber_edge_normal(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at,
                                         CAMBER_OUT(camber_real) nx, CAMBER_OUT(camber_real) ny) {
    const camber_real least = CAMBER_REAL(1e-3f);
    const camber_real off_x = camber_arc(at->past_b, p->round_b) - camber_arc(at->past_a, p->round_a);
    const camber_real length = CAMBER_SQRT(off_x * off_x + at->y * at->y), scale = -1.0f / CAMBER_MORE(length, least);
    camber_real in_x = off_x * scale, in_y = at->y * scale;
    if (p->capped) {
        camber_real ax, ay, bx, by;
        const camber_real in_a = camber_end_normal(p, at, -1.0f, CAMBER_REF(ax), CAMBER_REF(ay));
        const camber_real in_b = camber_end_normal(p, at, 1.0f, CAMBER_REF(bx), CAMBER_REF(by));
        const camber_mask at_a = in_a < in_b, at_end = CAMBER_LESS(in_a, in_b) < p->half_width - CAMBER_FABS(at->y);
        const camber_real end_x = at_a ? ax : bx, end_y = at_a ? ay : by;
        in_x = at_end ? end_x : in_x;
        in_y = at_end ? end_y : in_y;
    }
    CAMBER_AT(nx) = in_x * p->ux - in_y * p->uy;
    CAMBER_AT(ny) = in_x * p->uy + in_y * p->ux;
    return CAMBER_ALL_LANES(p->half_width > CAMBER_UNION_PX);
}

#endif
