/* How segments end: the bits that encode it, and what follows from a join's word and turn. C, OpenCL C and GLSL compile
 * it; in GLSL and C a camber_real is one segment's number, on a device it may hold the numbers of several segments. */
#ifndef CAMBER_KERNELS_STROKE_ENDS_H
#define CAMBER_KERNELS_STROKE_ENDS_H

#include "lanes.h"

/* Builds for the device, and variants of shaders, define what they have; in C the drawing file does. */
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

#define CAMBER_NEVER_PX 1e6f /* farther past an end, in px, than any pixel */
#define CAMBER_ALWAYS_PX (-1e30f)
/* In lines with a smaller half width, camber_edge_tips gives the area of round caps, and no join opens. */
#define CAMBER_TIPS_PX 1.85f
#define CAMBER_WIDE_PX 4.0f  /* in lines with a larger half width, gaps beside short segments are most visible */
#define CAMBER_UNION_PX 0.4f /* lines with a smaller half width have both edges in a pixel, and so no single normal */

/* The 13 bits of an end: 0-2 camber_end, 3-4 class, 5-10 position of a flat join (camber_flat_join), 11 free, 12 the
 * line ends with the next segment. */
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

/* Flags of a segment: 13 bits for the end at A (stroke_ends.h), 13 for the end at B, then the flags below. LINEAR:
 * coverage is a linear ramp. */
#define CAMBER_SEGMENT_END_BITS 13
#define CAMBER_END_OF_A(flags) ((flags)&CAMBER_END_MASK)
#define CAMBER_END_OF_B(flags) ((flags) >> CAMBER_SEGMENT_END_BITS & CAMBER_END_MASK)
#define CAMBER_SEGMENT_LINEAR (1u << 26)
/* Past a tight or split end, the segment also draws its inner side if it is wide there: camber_owner_side. */
#define CAMBER_SEGMENT_OWNER_A (1u << 27)
#define CAMBER_SEGMENT_OWNER_B (1u << 28)
/* At least one of its ends is cut by a second line (SHARP), flat (FLAT), or a round cap (ROUNDED). */
#define CAMBER_SEGMENT_SHARP (1u << 29)
#define CAMBER_SEGMENT_FLAT (1u << 30)
#define CAMBER_SEGMENT_ROUNDED (1u << 31)

/* Returns the bits of an end from its join word, except the last one. */
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

/* Returns tan(turn / 4) of join words, one per lane; camber_turn_unpack does it for a single one. */
CAMBER_FN camber_real camber_quarter_turn(camber_words join) {
    return CAMBER_TURNS(join) * (1.0f / CAMBER_LARGEST_TURN);
}

/* Computes the cosine and sine of half a turn from the tangent of a quarter of it. */
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

/* Whether possibly nothing covers the part past the bisector that a segment of this length leaves, because the other
 * segment is a stub, or because in a wide line either of the two is. In thin lines the gap is too small to be seen. */
CAMBER_FN camber_mask camber_opens(camber_words join, camber_real length, camber_real half_width) {
    const camber_mask longer = CAMBER_BOTH(half_width > CAMBER_TIPS_PX, camber_is_longer(join, length));
    const camber_mask either = CAMBER_BOTH(half_width > CAMBER_WIDE_PX, CAMBER_JOIN_STUB(join) < CAMBER_STUB_MOST);
    return CAMBER_EITHER(longer, either);
}

/* Whether a segment draws more of a tight or split end than its own side of the bisector. If the part of its body past
 * the bisector on the inner side is narrow, the segment gives it up: such gentle bends follow each other on curves, and
 * their edges would be drawn twice. It keeps a wider part. The limit is about half as large if the segment is alone
 * (the line ends soon, or the line is wide and the neighbour is a stub), because possibly nothing else covers that
 * part. Before a butt cap it ends in an edge of its own, which nothing draws twice, so there it keeps nearly all. c and
 * s: cosine and sine of half the turn. */
CAMBER_FN camber_mask camber_owner_side(camber_mask alone, camber_mask butt, camber_real c, camber_real s,
                                        camber_real half_width) {
    const camber_real soon = alone ? CAMBER_REAL(0.35f) : CAMBER_REAL(0.6f);
    const camber_real bound = butt ? CAMBER_REAL(0.1f) : soon;
    return half_width * CAMBER_FABS(s) > bound * c;
}

/* Returns the bits of an end that say where a join is flat: camber_cut_end. Before a butt cap the next segment may be
 * too short to cover the part past the body on its inner side, and likewise if the join opens. A segment that is no
 * longer than the stub does not know the length of the other one, which is then assumed to be long. butt: the line ends
 * with the next segment, in a butt cap; own: camber_owner_side; opens: camber_opens; length: of the segment itself. */
CAMBER_FN camber_words camber_flat_join(camber_words join, camber_mask butt, camber_mask own, camber_mask opens,
                                        camber_real length) {
    const camber_words none = CAMBER_WORD(0u), most = CAMBER_WORD(CAMBER_STUB_MOST);
    const camber_words behind = CAMBER_BOTH(butt, camber_is_longer(join, length)) ? CAMBER_JOIN_STUB(join) : most;
    const camber_mask open = CAMBER_BOTH(own, CAMBER_EITHER(butt, opens));
    return CAMBER_EITHER(behind < most, open) ? behind << CAMBER_END_FLAT_SHIFT : none;
}

/* Returns all bits of an end. soon: whether the line ends with the next segment; length: the length of the segment
 * itself; c and s: cosine and sine of half the turn. own: camber_owner_side. */
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

/* Whether a segment's neighbours take the line sideways, given the sines of half its turns. */
CAMBER_FN camber_flag camber_line_bends(float sine_a, float sine_b) {
    return CAMBER_FABS(sine_a) + CAMBER_FABS(sine_b) > 1e-3f;
}

/* Returns the tangent of half a turn, by which images bend at joins; 0 if the line goes straight on. */
CAMBER_FN float camber_image_tangent(float cosine, float sine) {
    const float tangent = sine / (cosine > 1e-3f ? cosine : 1e-3f);
    return CAMBER_FABS(tangent) < 1e-6f ? 0.0f : tangent;
}

#endif
