/* How edges of the plane appear in a picture with a pitch: each becomes an edge of the picture separately. A part of
 * stroke.h.
 *
 * Positions in the plane are relative to the point that the camera looks at; positions in the picture ("seen") are
 * relative to its middle. */
#ifndef CAMBER_KERNELS_STROKE_PITCHED_H
#define CAMBER_KERNELS_STROKE_PITCHED_H

/* A straight edge in the picture, and how it cuts pixels: a pixel is at - (x, y) . pixel inside it. */
CAMBER_STRUCT(camber_seen_edge) {
    float at, x, y;
    camber_profile cuts;
};

CAMBER_FN camber_real camber_seen_inside(CAMBER_IN(camber_seen_edge) edge, camber_real x, camber_real y) {
    return edge->at - (x * edge->x + y * edge->y);
}

#ifdef CAMBER_GLSL
/* The coefficients that fragments read; they are explained below. */
CAMBER_STRUCT(camber_edge) {
    float ux, uy, length, half_width, by_cosine, fall, along_a, across_a;
    float ca, sa, cb, sb, flat_a, flat_b, round_a, round_b, tip_a, tip_b, owner_a, owner_b, wide_a, wide_b;
    camber_seen_edge cut_a, cut_b;
    camber_u32 end_a, end_b;
    camber_flag linear, thin, tips, capped, sharp, bends;
};
#else
/* How far a pixel is past a line of the plane, divided by its depth. This is linear in the picture: (x, y) . pixel -
 * at. */
typedef struct camber_form {
    float at, x, y;
} camber_form;
typedef struct camber_edge {
    float by_cosine, fall; /* 1 / cosine of the camera's pitch, and its fall (camber_eye) */
    float ux, uy, half_width, length;
    float along_a, across_a; /* position of A along the segment's direction and across it, in px */
    float ca, sa, cb, sb;
    camber_form x, y, past_b, fa, fb;
    camber_seen_edge left, right; /* the sides */
    camber_seen_edge cut_a, cut_b;
    float owner_a, owner_b, wide_a, wide_b; /* camber_pitch_cut; wide: the share of a cut */
    float flat_a, flat_b, round_a, round_b, tip_a, tip_b;
    float margin;
    float axis_x, axis_y, axis_at, aside_at, from, to, wide; /* the footprint */
    camber_u32 end_a, end_b;
    camber_flag linear, thin, tips, capped, sharp, bends, narrow;
} camber_edge;
#endif

/* A pixel relative to a segment, in px of the plane unless stated otherwise. */
CAMBER_STRUCT(camber_pixel) {
    camber_real seen_x, seen_y; /* in the picture, px */
    camber_real by_depth, ground_x, ground_y;
    camber_real x, y;                    /* along the segment, and across it */
    camber_real past_a, past_b;          /* past the ends, along the segment */
    camber_real fa, fb;                  /* past the bisectors */
    camber_real scale, seen_ux, seen_uy; /* px of the picture per px along the line, and the line's direction there */
    camber_profiles line;                /* of edges across the line */
    camber_real off, across;             /* from the nearest point of the line: along it, and across */
    camber_real d, side_x, side_y;       /* the same as one distance, and its direction in the plane */
    camber_real along;                   /* arc length */
#ifdef CAMBER_GLSL
    float tie; /* CAMBER_TIE */
#endif
};

/* Projects an edge of the plane, which is `lies` px along its unit normal. seen: its normal in the picture. Returns the
 * length in the picture, times the depth, of one px of the plane across the edge. */
CAMBER_FN camber_real camber_see_normal(CAMBER_IN(camber_edge) p, camber_real nx, camber_real ny, camber_real lies,
                                        CAMBER_OUT(camber_real) seen_x, CAMBER_OUT(camber_real) seen_y) {
    const camber_real y = (ny - p->fall * lies) * p->by_cosine, square = nx * nx + y * y, least = CAMBER_REAL(1e-30f);
    const camber_real scale = 1.0f / CAMBER_SQRT(CAMBER_MORE(square, least));
    CAMBER_AT(seen_x) = nx * scale;
    CAMBER_AT(seen_y) = y * scale;
    return scale;
}

/* Returns the fraction of a pixel inside an edge of the plane, whose outward normal is (nx, ny), with its centre s px
 * inside it. seen: that normal in the picture. */
CAMBER_FN camber_real camber_plane_covered(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real s,
                                           camber_real nx, camber_real ny, CAMBER_OUT(camber_real) seen_x,
                                           CAMBER_OUT(camber_real) seen_y) {
    const camber_real lies = nx * at->ground_x + ny * at->ground_y + s;
    camber_real x, y;
    camber_profiles e;
    const camber_real scale = camber_see_normal(p, nx, ny, lies, CAMBER_REF(x), CAMBER_REF(y));
    camber_profile_of(x, y, CAMBER_ALL_LANES(p->linear), CAMBER_REF(e));
    CAMBER_AT(seen_x) = x;
    CAMBER_AT(seen_y) = y;
    return camber_covered(s * scale * at->by_depth, CAMBER_REF(e));
}

/* Computes the normal of the stroke's edge beside the pixel, in the picture. Returns the px of the picture per px
 * across it. */
CAMBER_FN camber_real camber_see_side(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at,
                                      CAMBER_OUT(camber_real) seen_x, CAMBER_OUT(camber_real) seen_y) {
    const camber_real lies = at->side_x * at->ground_x + at->side_y * at->ground_y;
    camber_real x, y;
    const camber_real scale = camber_see_normal(p, at->side_x, at->side_y, lies, CAMBER_REF(x), CAMBER_REF(y));
    CAMBER_AT(seen_x) = x;
    CAMBER_AT(seen_y) = y;
    return scale * at->by_depth;
}

/* Returns how many px of the picture a distance along the line, or away from it, is. */
CAMBER_FN camber_real camber_seen_along(CAMBER_IN(camber_pixel) at, camber_real px) {
    return px * at->scale;
}

CAMBER_FN camber_real camber_seen_away(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real px) {
    camber_real x, y;
    return px * camber_see_side(p, at, CAMBER_REF(x), CAMBER_REF(y));
}

/* Returns the fraction of a pixel inside an edge across the line, with its centre s px inside it. */
CAMBER_FN camber_real camber_cut_along(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real s) {
    CAMBER_UNUSED(p)
    return camber_covered(s * at->scale, CAMBER_REF(at->line));
}

/* Returns the fraction of a pixel inside an edge of the stroke, whose normal points from the line to the pixel (facing:
 * 1) or back (-1). */
CAMBER_FN camber_real camber_cut_beside(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real s,
                                        float facing) {
    camber_real x, y;
    return camber_plane_covered(p, at, s, facing * at->side_x, facing * at->side_y, CAMBER_REF(x), CAMBER_REF(y));
}

/* Returns the fraction of a pixel inside a join's second line. cosine: the cosine of the angle between the line and the
 * stroke's edge. */
CAMBER_FN camber_real camber_cut_second(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at,
                                        CAMBER_IN(camber_second) l, float out_of, camber_real inside,
                                        CAMBER_OUT(camber_real) cosine) {
    const float nx = l->nx * out_of * p->ux - l->ny * p->uy, ny = l->nx * out_of * p->uy + l->ny * p->ux;
    camber_real x, y, side_x, side_y;
    const camber_real second =
        camber_plane_covered(p, at, inside, CAMBER_REAL(nx), CAMBER_REAL(ny), CAMBER_REF(x), CAMBER_REF(y));
    camber_see_side(p, at, CAMBER_REF(side_x), CAMBER_REF(side_y));
    CAMBER_AT(cosine) = x * side_x + y * side_y;
    return second;
}

/* Returns how far half a pixel reaches along the line. */
CAMBER_FN camber_real camber_extent_along(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at) {
    CAMBER_UNUSED(p)
    return at->line.extent / at->scale;
}

/* Finds the nearest point of the line, the line's scale and direction at that point, `off` and `across`. */
CAMBER_FN void camber_find_nearest(CAMBER_IN(camber_edge) p, CAMBER_INOUT(camber_pixel) at) {
    const camber_real none = CAMBER_REAL(0.0f), ux = CAMBER_REAL(p->ux), uy = CAMBER_REAL(p->uy);
    const camber_real arc_a = camber_arc(at->past_a, p->round_a), arc_b = camber_arc(at->past_b, p->round_b);
    camber_real x, y, across = at->y;
    const camber_real scale =
        camber_see_normal(p, ux, uy, at->x + p->along_a, CAMBER_REF(x), CAMBER_REF(y)) * at->by_depth;
    if (p->bends) {
        const camber_real arc = CAMBER_MORE(arc_a, arc_b), straight = 1.0f - arc * scale;
        const camber_real bend = camber_join_bend(at->fa * scale, p->sa) + camber_join_bend(-at->fb * scale, p->sb);
        /* A segment shorter than a pixel does not know how the line continues. */
        const camber_real knows = camber_clamp_to_one(p->length * scale - 1.0f);
        across = at->y - bend / scale * (straight > 0.0f ? straight : none) * knows;
    }
    camber_profile_of(x, y, CAMBER_ALL_LANES(p->linear), CAMBER_REF(at->line));
    at->scale = scale;
    at->seen_ux = x;
    at->seen_uy = y;
    at->off = arc_b * p->wide_b - arc_a * p->wide_a;
    at->across = across;
}

/* Adds the distance between the nearest point of the line and a dash. */
CAMBER_FN void camber_go_off(CAMBER_INOUT(camber_pixel) at, camber_real off) {
    at->off += off;
}

CAMBER_FN void camber_find_distance(CAMBER_IN(camber_edge) p, CAMBER_INOUT(camber_pixel) at) {
    const camber_real d = CAMBER_SQRT(at->off * at->off + at->across * at->across), one = CAMBER_REAL(1.0f);
    const camber_mask apart = d > 1e-4f;
    const camber_real scale = one / (apart ? d : one);
    const camber_real x = apart ? at->off * scale : CAMBER_REAL(0.0f), y = apart ? at->across * scale : one;
    at->d = d;
    at->side_x = x * p->ux - y * p->uy;
    at->side_y = x * p->uy + y * p->ux;
}

/* Round caps that are shorter than a pixel, and seen upright, end like flat ones of the same area. Returns the fraction
 * of a pixel that they leave along the line. */
CAMBER_FN camber_real camber_edge_tips(CAMBER_IN(camber_edge) p, CAMBER_INOUT(camber_pixel) at) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f);
    camber_real x, y;
    camber_see_normal(p, CAMBER_REAL(-p->uy), CAMBER_REAL(p->ux), at->y + p->across_a, CAMBER_REF(x), CAMBER_REF(y));
    const camber_real length = p->half_width * at->scale,
                      slant = 1.0f - 2.0f * CAMBER_FABS(at->seen_ux * x + at->seen_uy * y);
    const camber_real upright = slant > 0.0f ? slant : none;
    const camber_real as_flat = (1.0f - camber_clamp_to_one(2.0f * length - 1.0f)) * upright;
    const camber_real to_a = p->tip_a - at->past_a, to_b = p->tip_b - at->past_b, until = camber_cap_until(length);
    at->off *= CAMBER_LESS(to_a, to_b) < 0.0f ? 1.0f - as_flat : one;
    const camber_real tip_a = camber_clamp_to_one(until + to_a * at->scale);
    const camber_real tip_b = camber_clamp_to_one(until + to_b * at->scale);
    const camber_real left = (1.0f - upright + tip_a * upright) + (1.0f - upright + tip_b * upright) - 1.0f;
    return left > 0.0f ? left : none;
}

/* Returns the fraction of a pixel inside the cap of a flat join, as in stroke_flat.h. */
CAMBER_FN camber_real camber_cut_turned(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real s,
                                        float out_of, float turn_cosine, float turn_sine,
                                        CAMBER_OUT(camber_real) cosine) {
    const float along = out_of * turn_cosine;
    const float nx = along * p->ux - turn_sine * p->uy, ny = along * p->uy + turn_sine * p->ux;
    camber_real x, y;
    const camber_real cap =
        camber_plane_covered(p, at, s, CAMBER_REAL(nx), CAMBER_REAL(ny), CAMBER_REF(x), CAMBER_REF(y));
    CAMBER_AT(cosine) = out_of * (x * at->seen_ux + y * at->seen_uy);
    return cap;
}

#include "stroke_caps.inl"

/* Returns the part of an area that flat ends leave. Seen with a pitch, they meet the sides at any angle. A line thinner
 * than the pixel has no such corner. */
CAMBER_FN camber_real camber_edge_caps(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real area) {
    camber_real x, y;
    const camber_real across = camber_see_side(p, at, CAMBER_REF(x), CAMBER_REF(y));
    const camber_real angle = at->seen_ux * x + at->seen_uy * y;
    const camber_real cosine = p->half_width * across > 0.5f ? angle : CAMBER_REAL(0.0f);
    const camber_real cut_a = camber_cut_end(p, at, -1.0f), cut_b = camber_cut_end(p, at, 1.0f);
    return camber_inside_both(camber_inside_both(area, cut_a, -cosine), cut_b, cosine);
}

/* Returns the fraction of a pixel that a segment draws at one of its ends. If the line is wide, the segment draws all
 * of a pixel whose centre is before the join. If it is thin, many segments may meet in a pixel, and each takes its
 * share. */
CAMBER_FN camber_real camber_cut_share(CAMBER_IN(camber_pixel) at, CAMBER_IN(camber_seen_edge) cut, float wide,
                                       camber_mask others) {
    const camber_real whole = others ? CAMBER_REAL(0.0f) : CAMBER_REAL(1.0f);
    if (wide >= 1.0f)
        return whole;
    const camber_real share = camber_covered(camber_seen_inside(cut, at->seen_x, at->seen_y), CAMBER_REF(cut->cuts));
    return share * (1.0f - wide) + whole * wide;
}

/* Returns the part of the area that the segment draws, and no neighbour. */
CAMBER_FN camber_real camber_edge_owner(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real area) {
    const camber_mask at_a = CAMBER_BOTH(at->fa<-CAMBER_TIE(at), at->past_a> p->owner_a);
    const camber_mask at_b = CAMBER_BOTH(at->fb >= CAMBER_TIE(at), at->past_b > p->owner_b);
    const camber_real share = camber_cut_share(at, CAMBER_REF(p->cut_a), p->wide_a, at_a) +
                              camber_cut_share(at, CAMBER_REF(p->cut_b), p->wide_b, at_b) - 1.0f;
#ifdef CAMBER_GLSL
    const camber_mask out_of_reach = false; /* the triangles limit it */
#else
    const camber_real along = at->seen_x * p->axis_x + at->seen_y * p->axis_y - p->axis_at;
    const camber_real aside = at->seen_y * p->axis_x - at->seen_x * p->axis_y - p->aside_at;
    const camber_mask out_of_reach = (along <= p->from) | (along >= p->to) | (CAMBER_FABS(aside) >= p->wide);
#endif
    return CAMBER_EITHER(out_of_reach, share < 0.0f) ? CAMBER_REAL(0.0f) : area * share;
}

/* Computes the normal of the nearest edge, into the stroke, in the picture; if that edge is a flat join's, the normal
 * of the side. Returns whether it has one. */
CAMBER_FN camber_mask camber_edge_normal(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at,
                                         CAMBER_OUT(camber_real) nx, CAMBER_OUT(camber_real) ny) {
    camber_real x, y;
    const camber_real across = camber_see_side(p, at, CAMBER_REF(x), CAMBER_REF(y));
    CAMBER_AT(nx) = -x;
    CAMBER_AT(ny) = -y;
    if (p->capped) {
        const float flat_a = camber_is_flat_join(p, -1.0f) ? CAMBER_NEVER_PX : p->flat_a;
        const float flat_b = camber_is_flat_join(p, 1.0f) ? CAMBER_NEVER_PX : p->flat_b;
        const camber_real cap_a = flat_a - at->past_a, cap_b = flat_b - at->past_b;
        const camber_mask first = cap_a < cap_b;
        const camber_mask at_cap =
            CAMBER_LESS(cap_a, cap_b) * at->scale < (p->half_width - CAMBER_FABS(at->y)) * across;
        CAMBER_AT(nx) = at_cap ? (first ? at->seen_ux : -at->seen_ux) : -x;
        CAMBER_AT(ny) = at_cap ? (first ? at->seen_uy : -at->seen_uy) : -y;
    }
    return p->half_width * across > CAMBER_UNION_PX;
}

#endif
