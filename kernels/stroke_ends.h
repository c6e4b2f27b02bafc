/* How segments end: the bits that say so, and what follows from a join's word and turn. C, OpenCL C and GLSL compile
 * it; in GLSL and C a camber_real is one segment's number, on a device it may be those of several segments. */
#ifndef CAMBER_KERNELS_STROKE_ENDS_H
#define CAMBER_KERNELS_STROKE_ENDS_H

#include "lanes.h"

/* Builds for the device, and variants of shaders, say what they have; in C the file that draws says it. */
#ifdef CAMBER_DEVICE
#ifndef CAMBER_RASTER_RICH
#define CAMBER_RASTER_RICH 0
#endif
#ifndef CAMBER_RASTER_PITCHED
#define CAMBER_RASTER_PITCHED 0
#endif
#define CAMBER_STROKE_PITCHED CAMBER_RASTER_PITCHED
#endif
#ifndef CAMBER_STROKE_PITCHED
#define CAMBER_STROKE_PITCHED 0
#endif

#define CAMBER_NEVER_PX 1e6f /* past an end by more px than any pixel lies there */
#define CAMBER_ALWAYS_PX (-1e30f)
/* In lines of a smaller half width round caps get their area by camber_edge_tips, and no join opens. */
#define CAMBER_TIPS_PX 1.85f
#define CAMBER_WIDE_PX 4.0f  /* in lines of a larger half width, what short pieces leave open is seen most */
#define CAMBER_UNION_PX 0.4f /* lines of a smaller half width have both edges in a pixel, and no one normal */

/* The 13 bits of an end: 0-2 camber_end, 3-4 class, 5-10 where a join is flat (camber_flat_join), 11 free, 12 the line
 * ends with the next segment. */
#define CAMBER_CLASS_CAP 0u
#define CAMBER_CLASS_CUT 1u
#define CAMBER_CLASS_TIGHT 2u
#define CAMBER_CLASS_SPLIT 3u
#define CAMBER_END_MASK 0x1fffu
#define CAMBER_END_CLASS_SHIFT 3
#define CAMBER_END_FLAT_SHIFT 5
#define CAMBER_END_LAST_SHIFT 12
#define CAMBER_END_KIND(end) ((end)&CAMBER_JOIN_END_MASK)
#define CAMBER_END_CLASS(end) ((end) >> CAMBER_END_CLASS_SHIFT & 3u)
#define CAMBER_END_FLAT(end) ((end) >> CAMBER_END_FLAT_SHIFT & CAMBER_STUB_MOST)
#define CAMBER_END_IS_LAST(end) CAMBER_HAS((end) >> CAMBER_END_LAST_SHIFT, 1u)
#define CAMBER_END_IS_ROUND_CAP(end)                                                                                   \
    (((end) & (CAMBER_JOIN_END_MASK | 3u << CAMBER_END_CLASS_SHIFT)) ==                                                \
     (CAMBER_ENDS_ROUND | CAMBER_CLASS_CAP << CAMBER_END_CLASS_SHIFT))

/* Flags of a segment: 13 bits of the end at A (stroke_ends.h), as many of that at B, then the flags below. LINEAR:
 * coverage is a linear ramp. */
#define CAMBER_SEGMENT_END_BITS 13
#define CAMBER_END_OF_A(flags) ((flags)&CAMBER_END_MASK)
#define CAMBER_END_OF_B(flags) ((flags) >> CAMBER_SEGMENT_END_BITS & CAMBER_END_MASK)
#define CAMBER_SEGMENT_LINEAR (1u << 26)
/* Past a tight or split end the segment draws its inner side as well, if it is wide there: camber_owner_side. */
#define CAMBER_SEGMENT_OWNER_A (1u << 27)
#define CAMBER_SEGMENT_OWNER_B (1u << 28)
/* At least one of its ends is: cut by a second line (SHARP), flat (FLAT), a round cap (ROUNDED). */
#define CAMBER_SEGMENT_SHARP (1u << 29)
#define CAMBER_SEGMENT_FLAT (1u << 30)
#define CAMBER_SEGMENT_ROUNDED (1u << 31)

/* The bits of an end from its join word, but for the last one. */
CAMBER_FN camber_words camber_segment_end(camber_words join) {
    const camber_words kind = join >> CAMBER_JOIN_KIND_SHIFT,
                       end = join >> CAMBER_JOIN_END_SHIFT & CAMBER_JOIN_END_MASK;
    const camber_words split = end == CAMBER_ENDS_ROUND   ? CAMBER_WORD(CAMBER_ENDS_SPLIT_ROUND)
                               : end == CAMBER_ENDS_BEVEL ? CAMBER_WORD(CAMBER_ENDS_SPLIT_BEVEL)
                                                          : CAMBER_WORD(CAMBER_ENDS_SPLIT_MITER);
    const camber_words drawn = CAMBER_BOTH(kind >= CAMBER_KIND_TIGHT, end < CAMBER_ENDS_SPLIT_ROUND) ? split : end;
    const camber_words ends_as = kind < CAMBER_KIND_CUT ? CAMBER_WORD(0u) : kind - 2u;
    return drawn | ends_as << CAMBER_END_CLASS_SHIFT;
}

/* tan(turn / 4) of join words, a lane each: camber_turn_unpack has it for one. */
CAMBER_FN camber_real camber_quarter_turn(camber_words join) {
    return CAMBER_TURNS(join) * (1.0f / CAMBER_LARGEST_TURN);
}

/* Cosine and sine of half a turn from the tangent of a quarter of it. */
CAMBER_FN void camber_half_turn(camber_real q, CAMBER_OUT(camber_real) c, CAMBER_OUT(camber_real) s) {
    const camber_real scale = 1.0f / (1.0f + q * q);
    CAMBER_AT(c) = (1.0f - q * q) * scale;
    CAMBER_AT(s) = 2.0f * q * scale;
}

/* Whether the other segment of a join is the shorter one, and a stub. length: of the segment itself. */
CAMBER_FN camber_mask camber_is_longer(camber_words join, camber_real length) {
    const camber_mask stub = CAMBER_JOIN_STUB(join) < CAMBER_STUB_MOST;
    return CAMBER_BOTH(stub, length > (CAMBER_TO_REAL(CAMBER_JOIN_STUB(join)) + 1.0f) * CAMBER_STUB_UNIT_PX);
}

/* Whether nothing may cover what a segment of a length leaves past the bisector: the other one is a stub, or in a wide
 * line either. In thin lines that is too little to be seen. */
CAMBER_FN camber_mask camber_opens(camber_words join, camber_real length, camber_real half_width) {
    const camber_mask longer = CAMBER_BOTH(half_width > CAMBER_TIPS_PX, camber_is_longer(join, length));
    const camber_mask either = CAMBER_BOTH(half_width > CAMBER_WIDE_PX, CAMBER_JOIN_STUB(join) < CAMBER_STUB_MOST);
    return CAMBER_EITHER(longer, either);
}

/* Whether a segment draws more of a tight or split end than its own side of the bisector. What its body has past the
 * bisector on the inner side it gives up where that is narrow: bends that gentle follow each other on curves, and their
 * edges would be drawn twice. More it keeps, and half of that where it is alone, as the line ends soon, or it is wide
 * and the neighbour a stub: nothing may cover it. Before a butt cap it ends in an edge of its own, which nothing draws
 * twice: there it keeps nearly all. c and s: cosine and sine of half the turn. */
CAMBER_FN camber_mask camber_owner_side(camber_mask alone, camber_mask butt, camber_real c, camber_real s,
                                        camber_real half_width) {
    const camber_real soon = alone ? CAMBER_REAL(0.35f) : CAMBER_REAL(0.6f);
    const camber_real bound = butt ? CAMBER_REAL(0.1f) : soon;
    return half_width * CAMBER_FABS(s) > bound * c;
}

/* The bits of an end that say where a join is flat: camber_cut_end. Before a butt cap the next segment may be too short
 * to cover what lies past the body on its inner side, and so where the join opens. A segment that is no longer than the
 * stub does not know the other one's length: it is taken for a long one. butt: the line ends with the next segment, in
 * a butt cap; own: camber_owner_side; opens: camber_opens; length: of the segment itself. */
CAMBER_FN camber_words camber_flat_join(camber_words join, camber_mask butt, camber_mask own, camber_mask opens,
                                        camber_real length) {
    const camber_words none = CAMBER_WORD(0u), most = CAMBER_WORD(CAMBER_STUB_MOST);
    const camber_words behind = CAMBER_BOTH(butt, camber_is_longer(join, length)) ? CAMBER_JOIN_STUB(join) : most;
    const camber_mask open = CAMBER_BOTH(own, CAMBER_EITHER(butt, opens));
    return CAMBER_EITHER(behind < most, open) ? behind << CAMBER_END_FLAT_SHIFT : none;
}

/* All bits of an end. soon: whether the line ends with the next segment; length: of the segment itself; c and s: cosine
 * and sine of half the turn. own: camber_owner_side. */
CAMBER_FN camber_words camber_end_of(camber_words join, camber_mask soon, camber_real length, camber_real c,
                                     camber_real s, camber_real half_width, CAMBER_OUT(camber_mask) own) {
    const camber_words none = CAMBER_WORD(0u), end = camber_segment_end(join);
    const camber_words last = CAMBER_WORD(1u << CAMBER_END_LAST_SHIFT);
    const camber_mask butt = CAMBER_BOTH(soon, CAMBER_HAS(join, CAMBER_JOIN_BUTT));
    const camber_mask opens = camber_opens(join, length, half_width);
    const camber_mask keeps = CAMBER_BOTH(half_width > CAMBER_WIDE_PX, camber_is_longer(join, length));
    const camber_mask more = camber_owner_side(CAMBER_EITHER(soon, keeps), butt, c, s, half_width);
    const camber_mask owns = CAMBER_BOTH(CAMBER_END_CLASS(end) > CAMBER_CLASS_CUT, more);
    CAMBER_AT(own) = owns;
    return end | camber_flat_join(join, butt, owns, opens, length) | (soon ? last : none);
}

/* Whether a segment's neighbours take the line to the side, by the sines of half its turns. */
CAMBER_FN camber_flag camber_line_bends(float sine_a, float sine_b) {
    return CAMBER_FABS(sine_a) + CAMBER_FABS(sine_b) > 1e-3f;
}

/* The tangent of half a turn, as images bend at joins; 0 where the line goes straight on. */
CAMBER_FN float camber_image_tangent(float cosine, float sine) {
    const float tangent = sine / (cosine > 1e-3f ? cosine : 1e-3f);
    return CAMBER_FABS(tangent) < 1e-6f ? 0.0f : tangent;
}

#endif
