/* The coefficients of strokes: everything that is the same for all pixels of a segment.
 *
 * Input: a segment's words, or some of them. Output: camber_edge, from which stroke.h computes areas. The same code is
 * compiled for one segment (camber_edge) and, on a device, for as many as a vector has lanes (camber_edges): stroke.h
 * includes this file for each, after defining CAMBER_COEF and the like. So it is not a header. In shaders the vertex
 * stage calls its functions one by one, because varyings hold their results. */

/* How a straight edge cuts pixels: half a pixel's extent along its normal, the smaller component of that, and how the
 * covered area grows, linearly and over a pixel's corners. */
CAMBER_STRUCT(CAMBER_PROFILE) {
    CAMBER_COEF extent, corner, slope, curve;
};

/* The part of a profile that needs no division, from the edge's unit normal or its direction. linear: coverage is a
 * linear ramp. */
CAMBER_FN CAMBER_SAME_NAME CAMBER_INLINE void camber_profile_begin(CAMBER_COEF x, CAMBER_COEF y,
                                                                   CAMBER_COEF_MASK linear,
                                                                   CAMBER_INOUT(CAMBER_PROFILE) e) {
    const CAMBER_COEF nx = CAMBER_FABS(x), ny = CAMBER_FABS(y), extent = 0.5f * (nx + ny);
    const CAMBER_COEF less = CAMBER_LESS(nx, ny);
    e->extent = linear ? CAMBER_COEF_OF(0.5f) : extent;
    e->corner = linear ? CAMBER_COEF_OF(0.0f) : less;
}

CAMBER_FN CAMBER_SAME_NAME CAMBER_INLINE void camber_profile_of(CAMBER_COEF x, CAMBER_COEF y, CAMBER_COEF_MASK linear,
                                                                CAMBER_INOUT(CAMBER_PROFILE) e) {
    const CAMBER_COEF nx = CAMBER_FABS(x), ny = CAMBER_FABS(y), half_px = CAMBER_COEF_OF(0.5f);
    const CAMBER_COEF q = CAMBER_LESS(nx, ny), larger = CAMBER_MORE(nx, ny), p = CAMBER_MORE(larger, half_px);
    const CAMBER_COEF none = CAMBER_COEF_OF(0.0f), one = CAMBER_COEF_OF(1.0f), safe = q > 1e-4f ? q : one;
    const CAMBER_COEF scale = one / (p * safe), slope = safe * scale, bent = half_px * scale,
                      curve = q > 1e-4f ? bent : none;
    camber_profile_begin(x, y, linear, e);
    e->slope = linear ? one : slope;
    e->curve = linear ? none : curve;
}

/* Returns the fraction of a pixel inside an edge, with its centre s px inside it (below 0: outside). */
CAMBER_FN CAMBER_SAME_NAME CAMBER_INLINE camber_real camber_covered(camber_real s, CAMBER_IN(CAMBER_PROFILE) e) {
    const camber_real none = CAMBER_REAL(0.0f), corner = CAMBER_REAL(e->corner);
    const camber_real left = e->extent - CAMBER_FABS(s), rest = CAMBER_MORE(left, none);
    const camber_real bend = CAMBER_LESS(rest, corner);
    const camber_real area = bend * bend * e->curve + (rest - bend) * e->slope;
    return s < 0.0f ? area : 1.0f - area;
}

/* ---- Ends ---- */

/* Returns where a flat cap is, in px past the end. */
CAMBER_FN CAMBER_SAME_NAME CAMBER_COEF camber_flat_from(CAMBER_COEF_WORDS kind, CAMBER_COEF half_width) {
    const CAMBER_COEF none = CAMBER_COEF_OF(0.0f), never = CAMBER_COEF_OF(CAMBER_NEVER_PX);
    return kind == CAMBER_ENDS_BUTT ? none : kind == CAMBER_ENDS_SQUARE ? half_width : never;
}

/* Returns where a round end begins, in px past the end. */
CAMBER_FN CAMBER_SAME_NAME CAMBER_COEF camber_round_from(CAMBER_COEF_WORDS kind) {
    const CAMBER_COEF none = CAMBER_COEF_OF(0.0f), never = CAMBER_COEF_OF(CAMBER_NEVER_PX);
    return CAMBER_EITHER(kind == CAMBER_ENDS_ROUND, kind == CAMBER_ENDS_SPLIT_ROUND) ? none : never;
}

/* Returns where the cap of a thin line ends, in px past the end. The formula for arcs would treat such a line as one
 * that crosses the whole pixel. So the line is cut straight at a position where the cap has the area of a half circle:
 * pi / 4 of half the width. */
CAMBER_FN CAMBER_SAME_NAME CAMBER_COEF camber_cap_until(CAMBER_COEF half_width) {
    const CAMBER_COEF more = half_width - 0.5f, past = more > 0.0f ? more : CAMBER_COEF_OF(0.0f);
    return 0.5f + 0.785398f * half_width + 1.2f * past;
}

/* Returns camber_cap_until for an end that may not be a round cap. With a pitch, the width of a line in the picture
 * differs from pixel to pixel, so it is computed from what is seen. */
CAMBER_FN CAMBER_SAME_NAME CAMBER_COEF camber_tip_from(CAMBER_COEF_MASK is_round_cap, CAMBER_COEF half_width) {
#if CAMBER_STROKE_PITCHED
    CAMBER_UNUSED(half_width)
    const CAMBER_COEF until = CAMBER_COEF_OF(0.0f);
#else
    const CAMBER_COEF until = camber_cap_until(half_width);
#endif
    return is_round_cap ? until : CAMBER_COEF_OF(CAMBER_NEVER_PX);
}

/* Returns where any flat end is, in px past it: a cap, or a join by camber_flat_join. */
CAMBER_FN CAMBER_SAME_NAME CAMBER_COEF camber_flat_end_from(CAMBER_COEF_WORDS end, CAMBER_COEF half_width) {
    const CAMBER_COEF stub = (CAMBER_COEF_NUMBER(CAMBER_END_FLAT(end)) - 1.0f) * CAMBER_STUB_UNIT_PX;
    return stub < 0.0f ? camber_flat_from(CAMBER_END_KIND(end), half_width) : stub;
}

/* Returns how far past its end a segment still draws pixels beyond the bisector, in px. own: camber_owner_side;
 * is_flat: it ends in an edge there. */
CAMBER_FN CAMBER_SAME_NAME CAMBER_COEF camber_owner_from(CAMBER_COEF_MASK is_cap, CAMBER_COEF_MASK own,
                                                         CAMBER_COEF_MASK is_flat) {
    const CAMBER_COEF past = is_flat ? CAMBER_COEF_OF(CAMBER_PAD_PX) : CAMBER_COEF_OF(0.0f);
    const CAMBER_COEF from = own ? past : CAMBER_COEF_OF(CAMBER_ALWAYS_PX);
    return is_cap ? CAMBER_COEF_OF(CAMBER_NEVER_PX) : from;
}

#if !defined(CAMBER_GLSL) && !CAMBER_STROKE_PITCHED
/* ---- Segments ---- */

/* The coefficients. x runs along the segment, y across it, in px. */
CAMBER_STRUCT(CAMBER_EDGE) {
    CAMBER_COEF ax, ay, bx, by, ux, uy, nax, nay, nbx, nby;
    CAMBER_COEF length, half_width;
    CAMBER_PROFILE side;          /* profile of its sides, and of flat caps */
    CAMBER_COEF ca, sa, cb, sb;   /* cosine and sine of half the turn at A and at B */
    CAMBER_COEF flat_a, flat_b;   /* camber_flat_end_from */
    CAMBER_COEF round_a, round_b; /* camber_round_from */
    CAMBER_COEF tip_a, tip_b;     /* camber_tip_from */
    /* beyond the bisector and farther than this past the end, pixels are the neighbour's, in px */
    CAMBER_COEF owner_a, owner_b;
    CAMBER_COEF_WORDS end_a, end_b;
    CAMBER_COEF_MASK linear, thin, tips, capped, sharp;
    /* Whether the end at A, and that at B, is no flat cap, of which nothing but its own edge counts. */
    CAMBER_COEF_MASK goes_on_a, goes_on_b;
};

/* Computes everything that is not in the segment's words. It is always inlined, so that the compiler drops what the
 * caller does not read. The result is returned through a pointer, because oclgrind does not handle large return values.
 */
CAMBER_FN CAMBER_SAME_NAME CAMBER_INLINE void camber_edge_finish(CAMBER_COEF_WORDS flags, CAMBER_EDGE *p) {
    const CAMBER_COEF_WORDS end_a = CAMBER_END_OF_A(flags), end_b = CAMBER_END_OF_B(flags);
    const CAMBER_COEF h = p->half_width;
    p->linear = CAMBER_HAS(flags, CAMBER_SEGMENT_LINEAR);
    p->length = (p->bx - p->ax) * p->ux + (p->by - p->ay) * p->uy;
    camber_profile_begin(p->ux, p->uy, p->linear, &p->side);
    p->ca = p->nax * p->ux + p->nay * p->uy;
    p->sa = p->nax * p->uy - p->nay * p->ux;
    p->cb = p->nbx * p->ux + p->nby * p->uy;
    p->sb = p->nby * p->ux - p->nbx * p->uy;
    p->end_a = CAMBER_END_KIND(end_a);
    p->end_b = CAMBER_END_KIND(end_b);
    p->flat_a = camber_flat_end_from(end_a, h);
    p->flat_b = camber_flat_end_from(end_b, h);
    p->round_a = camber_round_from(p->end_a);
    p->round_b = camber_round_from(p->end_b);
    p->tip_a = camber_tip_from(CAMBER_END_IS_ROUND_CAP(end_a), h);
    p->tip_b = camber_tip_from(CAMBER_END_IS_ROUND_CAP(end_b), h);
    p->owner_a = camber_owner_from(CAMBER_END_CLASS(end_a) == CAMBER_CLASS_CAP,
                                   CAMBER_HAS(flags, CAMBER_SEGMENT_OWNER_A), CAMBER_END_FLAT(end_a) != 0u);
    p->owner_b = camber_owner_from(CAMBER_END_CLASS(end_b) == CAMBER_CLASS_CAP,
                                   CAMBER_HAS(flags, CAMBER_SEGMENT_OWNER_B), CAMBER_END_FLAT(end_b) != 0u);
    p->goes_on_a = CAMBER_EITHER(p->owner_a < CAMBER_NEVER_PX, p->flat_a == CAMBER_NEVER_PX);
    p->goes_on_b = CAMBER_EITHER(p->owner_b < CAMBER_NEVER_PX, p->flat_b == CAMBER_NEVER_PX);
    p->thin = h < p->side.extent;
    p->tips = (h < CAMBER_TIPS_PX) & CAMBER_HAS(flags, CAMBER_SEGMENT_ROUNDED);
    p->capped = CAMBER_HAS(flags, CAMBER_SEGMENT_FLAT);
    p->sharp = CAMBER_HAS(flags, CAMBER_SEGMENT_SHARP);
}
#endif
