/* Flat ends of a segment: caps, or joins that it does not share with its neighbour. A part of stroke.h: each projection
 * includes it after its functions that cut pixels, so it is not a header. */

/* The position of a pixel relative to a flat end: a cap, or a flat join (camber_flat_join). At a flat join the
 * segment's body ends in an edge of its own past the bisector; before the bisector the segment draws everything inside
 * this edge or inside the cap, which is turned. */
CAMBER_STRUCT(camber_flat_end) {
    camber_real body, cap; /* how far inside each of the two, in px */
    camber_mask behind;    /* past the bisector */
    float cosine, sine;    /* cosine and sine of the turn from one to the other */
};

/* Whether the end at B (out_of: 1) or at A (-1) is a flat join. */
CAMBER_FN camber_flag camber_is_flat_join(CAMBER_IN(camber_edge) p, float out_of) {
    return out_of > 0.0f ? p->sb != 0.0f && p->flat_b < CAMBER_NEVER_PX : p->sa != 0.0f && p->flat_a < CAMBER_NEVER_PX;
}

CAMBER_FN void camber_find_flat_end(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, float out_of,
                                    CAMBER_OUT(camber_flat_end) f) {
    const camber_flag at_b = out_of > 0.0f;
    const float c = at_b ? p->cb : p->ca, s = at_b ? p->sb : p->sa, from = at_b ? p->flat_b : p->flat_a;
    const camber_real past = at_b ? at->past_b : at->past_a;
    f->behind = at_b ? at->fb >= CAMBER_TIE(at) : at->fa < -CAMBER_TIE(at);
    f->cosine = c * c - s * s;
    f->sine = 2.0f * s * c;
    f->body = -past;
    f->cap = from - past * f->cosine - at->y * f->sine;
}

/* Returns the fraction of a pixel inside a flat end. llvmpipe runs both sides of a branch, so in shaders a cap is
 * treated as a join whose two edges coincide, apart from the effect of a pitch; if there is no stub, its cap is far
 * away. */
CAMBER_FN CAMBER_INLINE camber_real camber_cut_end(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at, float out_of) {
    const float from = out_of > 0.0f ? p->flat_b : p->flat_a;
    const camber_flag is_join = camber_is_flat_join(p, out_of);
    const camber_flag is_far = is_join && from >= CAMBER_STUB_PX - 0.5f * CAMBER_STUB_UNIT_PX;
    camber_flat_end f;
    camber_find_flat_end(p, at, out_of, CAMBER_REF(f));
    const camber_real body = camber_cut_along(p, at, is_join ? f.body : from + f.body);
#ifdef CAMBER_GLSL
    const camber_flag has_cap = CAMBER_YES;
#else
    const camber_flag has_cap = !is_far;
    if (!is_join)
        return body;
#endif
    camber_real before = CAMBER_REAL(1.0f);
    if (has_cap) {
        camber_real cosine;
        const camber_real inside = is_far ? CAMBER_REAL(CAMBER_NEVER_PX) : f.cap;
        const camber_real cap = camber_cut_turned(p, at, inside, out_of, f.cosine, f.sine, CAMBER_REF(cosine));
        before -= camber_inside_both(1.0f - body, 1.0f - cap, cosine);
    }
    return f.behind ? body : before;
}
