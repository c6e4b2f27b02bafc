/* How a camera with a pitch sees points, directions and ends of the plane.
 *
 * Positions in the plane are relative to the point that the camera looks at; positions in the picture ("seen") are
 * relative to its middle. C, OpenCL C and GLSL compile it. */
#ifndef CAMBER_KERNELS_PITCH_H
#define CAMBER_KERNELS_PITCH_H

#include "stroke.h"

/* The least depth at which a point is projected. */
#define CAMBER_PITCH_LEAST 1e-3f

/* The camera. */
CAMBER_STRUCT(camber_eye) {
    float x, y;   /* half the picture's size, px */
    float cosine; /* cosine of the pitch */
    float fall;   /* by how much depth falls per px of the plane towards the viewer */
};

/* Returns the same camera, but it sees the picture instead of the plane: all points are where they are seen. */
CAMBER_FN camber_eye camber_eye_upright(camber_eye e) {
    e.cosine = 1.0f;
    e.fall = 0.0f;
    return e;
}

CAMBER_FN camber_real camber_pitch_depth(camber_eye e, camber_real y) {
    const camber_real depth = 1.0f - e.fall * y, least = CAMBER_REAL(CAMBER_PITCH_LEAST);
    return CAMBER_MORE(depth, least);
}

CAMBER_FN void camber_pitch_see(camber_eye e, camber_real x, camber_real y, CAMBER_OUT(camber_real) seen_x,
                                CAMBER_OUT(camber_real) seen_y) {
    const camber_real by_depth = 1.0f / camber_pitch_depth(e, y);
    CAMBER_AT(seen_x) = x * by_depth;
    CAMBER_AT(seen_y) = y * e.cosine * by_depth;
}

/* Clips a segment to what the camera sees: from and to, in px along it from A, which is at ay. all_over: it may be seen
 * anywhere in the picture, like a wide line with one side behind the camera. Returns whether it is seen. */
CAMBER_FN camber_mask camber_pitch_clip(camber_eye e, camber_real ay, camber_real ux, camber_real uy,
                                        camber_real half_width, CAMBER_INOUT(camber_real) from,
                                        CAMBER_INOUT(camber_real) to, CAMBER_OUT(camber_mask) all_over) {
    /* A point that is nearer than the picture's bottom is not seen. A point at half that depth is not projected
     * exactly. */
    const float nearest = e.cosine / (e.cosine + e.fall * e.y), hidden = 0.5f * nearest;
    const camber_real spread = e.fall * CAMBER_FABS(ux) * half_width, rate = e.fall * uy;
    const camber_real room = 1.0f - e.fall * ay - spread - hidden;
    const camber_real at_from = room - rate * CAMBER_AT(from), at_to = room - rate * CAMBER_AT(to);
    const camber_real cut = room / (rate == 0.0f ? CAMBER_REAL(1.0f) : rate);
    const camber_mask everywhere = CAMBER_BOTH(2.0f * spread > nearest - hidden, CAMBER_LESS(at_from, at_to) < 0.0f);
    CAMBER_AT(to) = CAMBER_BOTH(rate > 0.0f, cut < CAMBER_AT(to)) ? cut : CAMBER_AT(to);
    CAMBER_AT(from) = CAMBER_BOTH(rate<0.0f, cut> CAMBER_AT(from)) ? cut : CAMBER_AT(from);
    CAMBER_AT(all_over) = everywhere;
    const camber_mask gone = CAMBER_EITHER(CAMBER_AT(from) > CAMBER_AT(to), CAMBER_BOTH(rate == 0.0f, room < 0.0f));
    return CAMBER_EITHER(everywhere, !gone);
}

/* Returns the width in the picture of a line through a point of the plane, in px. */
CAMBER_FN camber_real camber_pitch_width(camber_eye e, camber_real x, camber_real y, camber_real ux, camber_real uy,
                                         camber_real half_width) {
    const camber_real across = (ux - e.fall * (y * ux - x * uy)) / e.cosine;
    const camber_real seen = CAMBER_SQRT(uy * uy + across * across), least = CAMBER_REAL(1e-15f);
    return 2.0f * half_width / (camber_pitch_depth(e, y) * CAMBER_MORE(seen, least));
}

/* The end of a segment at a point of the plane. turns: 1 at B, -1 at A; c and s: cosine and sine of half the turn; own:
 * camber_owner_side. */
CAMBER_STRUCT(camber_pitch_end) {
    camber_real x, y, ux, uy, half_width, c, s;
    camber_words end;
    camber_mask own;
    float turns;
};

/* Computes the direction in the picture of the plane's direction u at the end. */
CAMBER_FN void camber_pitch_direction(camber_eye e, CAMBER_IN(camber_pitch_end) s, camber_real ux, camber_real uy,
                                      CAMBER_OUT(camber_real) seen_x, CAMBER_OUT(camber_real) seen_y) {
    const camber_real x = ux * camber_pitch_depth(e, s->y) + e.fall * s->x * uy, y = e.cosine * uy;
    const camber_real length = CAMBER_SQRT(x * x + y * y), least = CAMBER_REAL(1e-20f);
    const camber_real scale = 1.0f / CAMBER_MORE(length, least);
    CAMBER_AT(seen_x) = x * scale;
    CAMBER_AT(seen_y) = y * scale;
}

/* How far past an end the segment draws pixels beyond the bisector (camber_owner_from), and its cut in the picture. If
 * the join is seen narrower than a pixel, the cut divides the pixels between both segments: it has a normal, a
 * position, and a share, which is 1 if the line is wide and the plane's bisector divides the pixels, and falls to 0 as
 * the line becomes thinner. */
CAMBER_STRUCT(camber_pitch_cut) {
    camber_real owner, x, y, at, wide;
};

CAMBER_FN void camber_pitch_cut_of(camber_eye e, CAMBER_IN(camber_pitch_end) s, CAMBER_OUT(camber_pitch_cut) cut) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f), h = s->half_width;
    const camber_real cosine = s->c * s->c - s->s * s->s, turned = 2.0f * s->turns * s->c * s->s;
    const camber_real other_x = s->ux * cosine - s->uy * turned, other_y = s->ux * turned + s->uy * cosine;
    const camber_real width = camber_pitch_width(e, s->x, s->y, s->ux, s->uy, h);
    const camber_real other = camber_pitch_width(e, s->x, s->y, other_x, other_y, h);
    const camber_real narrowest = CAMBER_LESS(width, other);
    camber_real along_x, along_y, behind_x, behind_y, seen_x, seen_y;
    camber_pitch_direction(e, s, s->ux, s->uy, CAMBER_REF(along_x), CAMBER_REF(along_y));
    camber_pitch_direction(e, s, other_x, other_y, CAMBER_REF(behind_x), CAMBER_REF(behind_y));
    camber_pitch_see(e, s->x, s->y, CAMBER_REF(seen_x), CAMBER_REF(seen_y));
    const camber_real sum_x = along_x + behind_x, sum_y = along_y + behind_y;
    const camber_real length = CAMBER_SQRT(sum_x * sum_x + sum_y * sum_y);
    /* Beyond a right angle the bisector runs along the line, and would cut off half of a segment even where its
     * neighbour, which may be short, does not cover it. Such a segment is cut at its end instead. */
    const camber_mask bends = CAMBER_BOTH(length > 1e-5f, CAMBER_FABS(s->s) < s->c);
    const camber_real scale = one / (bends ? length : one);
    const camber_real x = bends ? sum_x * scale : along_x, y = bends ? sum_y * scale : along_y;
    const camber_mask is_cap = CAMBER_END_CLASS(s->end) == CAMBER_CLASS_CAP;
    const camber_mask wide = CAMBER_EITHER(is_cap, 1.0f - e.fall * s->y < CAMBER_PITCH_LEAST);
    const camber_mask no = CAMBER_ALL_LANES(CAMBER_NO), soon = CAMBER_END_IS_LAST(s->end);
    const camber_mask kept = camber_owner_side(soon, no, s->c, s->s, 0.5f * narrowest);
    cut->x = wide ? none : s->turns * x;
    cut->y = wide ? none : s->turns * y;
    cut->at = wide ? none : s->turns * (x * seen_x + y * seen_y);
    cut->wide = wide ? one : camber_clamp_to_one(1.5f * narrowest - 0.75f);
    /* A flat join ends in an edge, so that the segment may draw everything that it has past the bisector. Whether it
     * does depends on the width in the plane as well, like the position where it is flat. */
    const camber_mask is_flat = CAMBER_BOTH(CAMBER_END_FLAT(s->end) != 0u, cut->wide >= 1.0f);
    cut->owner = camber_owner_from(CAMBER_EITHER(is_cap, CAMBER_BOTH(is_flat, CAMBER_EITHER(s->own, kept))),
                                   CAMBER_BOTH(CAMBER_END_CLASS(s->end) != CAMBER_CLASS_CUT, kept), no);
}

/* Returns where an end is flat, in px of the plane past it; wide: the share of its cut. A join that is seen narrower
 * than a pixel is not flat: both segments share the pixel. */
CAMBER_FN float camber_pitch_flat_from(camber_u32 end, float half_width, float wide) {
    return wide < 1.0f ? camber_flat_from(CAMBER_END_KIND(end), half_width) : camber_flat_end_from(end, half_width);
}

/* Returns how far a stroke reaches past an end, in px of the plane. */
CAMBER_FN camber_real camber_pitch_reach(camber_words end, camber_real c, camber_real sine, camber_real half_width) {
    const camber_real one = CAMBER_REAL(1.0f), least = CAMBER_REAL(1e-5f), aside = CAMBER_FABS(sine);
    const camber_words kind = CAMBER_END_KIND(end), ends_as = CAMBER_END_CLASS(end);
    const camber_real tip = CAMBER_EITHER(kind == CAMBER_ENDS_MITER, kind == CAMBER_ENDS_SPLIT_MITER)
                                ? aside / CAMBER_MORE(c, least)
                                : aside;
    const camber_real whole = CAMBER_MORE(tip, one), cap = kind == CAMBER_ENDS_BUTT ? CAMBER_REAL(0.0f) : one;
    return half_width * (ends_as == CAMBER_CLASS_CAP ? cap : ends_as == CAMBER_CLASS_SPLIT ? whole : tip);
}

#endif
