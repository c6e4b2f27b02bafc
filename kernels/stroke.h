/* The fraction of a pixel that a segment's part of a stroke covers: the only formula, for C, OpenCL C and GLSL.
 *
 * Input: the coefficients of a segment (camber_edge) and a pixel as the segment sees it (camber_pixel). Output: areas
 * from 0 to 1. An area follows from the pixel's distance to the segment's sides, to its ends and to the bisectors of
 * its joins. All of it uses a few functions that project edges: the part "Projection" has them twice, for a picture
 * without a pitch, and with CAMBER_STROKE_PITCHED for one with a pitch. A build contains one of the two.
 *
 * With a pitch, lengths along and across a segment are px of the plane. A distance from a line of the plane, divided by
 * the depth there, is linear in the picture. So straight edges of the plane are straight in the picture. */
#ifndef CAMBER_KERNELS_STROKE_H
#define CAMBER_KERNELS_STROKE_H

#include "stroke_ends.h"
#include "union.h"

/* stroke_setup.inl for one segment. */
#define CAMBER_COEF float
#define CAMBER_COEF_WORDS camber_u32
#define CAMBER_COEF_MASK camber_flag
#define CAMBER_COEF_OF(x) (x)
#ifdef CAMBER_GLSL
#define CAMBER_COEF_NUMBER(words) float(words)
#else
#define CAMBER_COEF_NUMBER(words) ((float)(words))
#endif
#define CAMBER_PROFILE camber_profile
#define CAMBER_EDGE camber_edge
#include "stroke_setup.inl"

/* stroke_setup.inl for a vector of segments, or of edges as several pixels see them. */
#if CAMBER_HAS_VECTORS
#undef CAMBER_COEF
#undef CAMBER_COEF_WORDS
#undef CAMBER_COEF_MASK
#undef CAMBER_COEF_OF
#undef CAMBER_COEF_NUMBER
#undef CAMBER_PROFILE
#undef CAMBER_EDGE
#define CAMBER_COEF camber_real
#define CAMBER_COEF_WORDS camber_words
#define CAMBER_COEF_MASK camber_mask
#define CAMBER_COEF_OF(x) CAMBER_REAL(x)
#define CAMBER_COEF_NUMBER(words) CAMBER_TO_REAL(words)
#define CAMBER_PROFILE camber_profiles
#define CAMBER_EDGE camber_edges
#include "stroke_setup.inl"
#else
#define camber_profiles camber_profile
#define camber_edges camber_edge
#endif

/* Returns the fraction of a pixel inside two edges, each of which leaves a and b: the smaller if they run in the same
 * direction, the product at a right angle, and a + b - 1 if they face each other. cosine: the cosine of the angle
 * between their normals. */
CAMBER_FN camber_real camber_inside_both(camber_real a, camber_real b, camber_real cosine) {
    const camber_real weight = CAMBER_FABS(cosine), smaller = CAMBER_LESS(a, b), both = a + b - 1.0f;
    const camber_real least = both > 0.0f ? both : CAMBER_REAL(0.0f), bound = cosine > 0.0f ? smaller : least;
    return a * b * (1.0f - weight) + bound * weight;
}

/* Returns how far past a round end a pixel is. round_from: where the end begins to be round. */
CAMBER_FN camber_real camber_arc(camber_real past, float round_from) {
    const camber_real arc = past - round_from, none = CAMBER_REAL(0.0f);
    return CAMBER_MORE(arc, none);
}

/* Returns how far the next segment takes the line sideways, averaged over the pixel, given how far the pixel is before
 * the bisector, in px. A fraction f of the pixel is past the bisector, f / 2 px on average, and the line has turned by
 * about 2 s there: f * f / 2 * 2 s. It is 0 in the inner overlap. */
CAMBER_FN camber_real camber_join_bend(camber_real before, float sine) {
    const camber_real none = CAMBER_REAL(0.0f), rest = 0.5f - before, share = CAMBER_MORE(rest, none);
    return before < 0.0f ? none : sine * share * share;
}

/* The second line that cuts a miter's tip or bounds a bevel. A bevel's normal points along the bisector; a miter's line
 * is the neighbour's edge, which is turned by the whole turn. These values are the same from either end of the join. */
CAMBER_STRUCT(camber_second) {
    camber_flag bevel, miter;
    float outer, nx, ny; /* the side of the segment that it is on, 1 or -1; its normal along and across the segment */
};

CAMBER_FN void camber_second_of(camber_u32 end, float c, float s, CAMBER_OUT(camber_second) l) {
    const float sine = CAMBER_FABS(s);
    l->bevel = end == CAMBER_ENDS_BEVEL || end == CAMBER_ENDS_SPLIT_BEVEL;
    l->miter = end == CAMBER_ENDS_MITER || end == CAMBER_ENDS_SPLIT_MITER;
    l->outer = s > 0.0f ? -1.0f : 1.0f;
    l->nx = l->bevel ? sine : 2.0f * sine * c;
    l->ny = l->bevel ? l->outer * c : l->outer * (c * c - sine * sine);
}

/* Returns how far inside the second line a pixel is. past: px past the end. */
CAMBER_FN camber_real camber_second_inside(CAMBER_IN(camber_second) l, float half_width, camber_real past,
                                           camber_real y, float c) {
    return (l->bevel ? half_width * c : half_width) - (past * l->nx + y * l->ny);
}

/* Returns how much of `whole` the second line leaves, given `cut`, which is the part that it leaves if it applies. A
 * miter's line cuts only the tip. */
CAMBER_FN camber_real camber_second_cuts(CAMBER_IN(camber_second) l, camber_real past, camber_real y, camber_real whole,
                                         camber_real cut) {
    const camber_real tip = CAMBER_BOTH(past > -1.0f, y * l->outer > 0.0f) ? cut : whole;
    return l->bevel ? cut : tip;
}

/* How far past a bisector a pixel still belongs to both segments, in px. Kernels get the same bits from either side. */
#ifdef CAMBER_GLSL
#define CAMBER_TIE(at) at.tie
#else
#define CAMBER_TIE(at) 0.0f
#endif

/* ---- Projection ---- */

#if CAMBER_STROKE_PITCHED
#include "stroke_pitched.h"
#else
#include "stroke_flat.h"
#endif

/* ---- Parts of a stroke ---- */

/* Returns the fraction of a pixel within half_width of the line, if both sides may be in it. */
CAMBER_FN camber_real camber_edge_band(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, float half_width) {
    const camber_real both =
        camber_cut_beside(p, at, half_width - at->d, 1.0f) + camber_cut_beside(p, at, half_width + at->d, -1.0f) - 1.0f;
    return both > 0.0f ? both : CAMBER_REAL(0.0f);
}

CAMBER_FN camber_real camber_edge_within(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at) {
    return p->thin ? camber_edge_band(p, at, p->half_width) : camber_cut_beside(p, at, p->half_width - at->d, 1.0f);
}

/* Returns the area that the second line of the join at an end leaves. out: 1 at B, -1 at A; c and s: camber_half_turn.
 */
CAMBER_FN camber_real camber_cut_join(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real area,
                                      float half_width, float out_of) {
    const float c = out_of > 0.0f ? p->cb : p->ca, s = out_of > 0.0f ? p->sb : p->sa;
    const camber_real past = out_of > 0.0f ? at->past_b : at->past_a;
    camber_second l;
    camber_real cosine;
    camber_second_of(out_of > 0.0f ? p->end_b : p->end_a, c, s, CAMBER_REF(l));
    if (!l.bevel && !l.miter)
        return area;
    const camber_real inside = camber_second_inside(CAMBER_REF(l), half_width, past, at->y, c);
    const camber_real second = camber_cut_second(p, at, CAMBER_REF(l), out_of, inside, CAMBER_REF(cosine));
    return camber_second_cuts(CAMBER_REF(l), past, at->y, area, camber_inside_both(area, second, cosine));
}

CAMBER_FN camber_real camber_cut_joins(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, camber_real area,
                                       float half_width) {
    const camber_real first = camber_cut_join(p, at, area, half_width, -1.0f);
    return camber_cut_join(p, at, first, half_width, 1.0f);
}

#endif
