/* Segments in a picture with a pitch: where in the picture a segment of the plane is seen.
 *
 * Input: a segment in the plane and the camera (src/base/perspective.h). Output: the segment's footprint, a rectangle
 * of the picture around all that it draws, in the words of a segment; and camber_plane, which its edge needs besides.
 * Positions in the plane count from the point that the camera looks at; those seen count from the picture's middle. The
 * footprint alone counts from the picture's corner. shaders/stroke.vert holds the same formulas under PITCHED.
 *
 * A distance from a line of the plane, n . p - n . a, times by_depth (1 / depth) is linear in the picture. So straight
 * edges of the plane are straight in the picture, and far from the ends of a segment only its sides count. */
#ifndef CAMBER_KERNELS_PITCH_SEGMENT_H
#define CAMBER_KERNELS_PITCH_SEGMENT_H

#include "coverage.h"

/* The words of a segment in the plane, in a buffer beside the footprints. */
#define CAMBER_PLANE_WORDS 32
#define CAMBER_PLANE_AX 0          /* to word 9: A, B, the direction, the bisectors' normals, as in a segment */
#define CAMBER_PLANE_HALF_WIDTH 10 /* px of the plane */
#define CAMBER_PLANE_OWNER_A 11    /* two words: camber_owner_side, by the width that is seen */
#define CAMBER_PLANE_OWNER_B 12
#define CAMBER_PLANE_CUT_A 13 /* four words each: camber_pitch_cut */
#define CAMBER_PLANE_CUT_B 17
#define CAMBER_PLANE_ENDS 21   /* how far the footprint reaches past its ends, px of the picture */
#define CAMBER_PLANE_MARGIN 22 /* at most so many px of the plane by depth make a px along the segment */
#define CAMBER_PLANE_LEFT 23   /* its sides in the picture, three words each: camber_pitch_project_edge */
#define CAMBER_PLANE_RIGHT 26

/* By how much the footprint is wider than what is drawn, so that rounding does not matter. */
#define CAMBER_PITCH_SLACK_PX 0.02f
/* The least depth at which a point is projected. */
#define CAMBER_PITCH_LEAST 1e-3f

/* ---- Footprints ---- */

typedef struct camber_plane {
    camber_real owner_a, owner_b, cut_a[4], cut_b[4];
    camber_real ends, margin, left[3], right[3];
} camber_plane;

CAMBER_FN camber_real camber_pitch_depth(camber_eye e, camber_real y) {
    const camber_real depth = 1.0f - e.fall * y, least = CAMBER_REAL(CAMBER_PITCH_LEAST);
    return CAMBER_MORE(depth, least);
}

CAMBER_FN void camber_pitch_see(camber_eye e, camber_real x, camber_real y, camber_real *seen_x, camber_real *seen_y) {
    const camber_real by_depth = 1.0f / camber_pitch_depth(e, y);
    *seen_x = x * by_depth;
    *seen_y = y * e.cosine * by_depth;
}

/* The width in the picture of a line through a point of the plane, px. */
CAMBER_FN camber_real camber_pitch_width(camber_eye e, camber_real x, camber_real y, camber_real ux, camber_real uy,
                                         camber_real half_width) {
    const camber_real across = (ux - e.fall * (y * ux - x * uy)) / e.cosine;
    const camber_real seen = CAMBER_SQRT(uy * uy + across * across), least = CAMBER_REAL(1e-15f);
    return 2.0f * half_width / (camber_pitch_depth(e, y) * CAMBER_MORE(seen, least));
}

/* The direction in the picture of the plane's direction u, at a point of the plane. */
CAMBER_FN void camber_pitch_direction(camber_eye e, const camber_real place[2], camber_real ux, camber_real uy,
                                      camber_real seen[2]) {
    const camber_real x = ux * camber_pitch_depth(e, place[1]) + e.fall * place[0] * uy, y = e.cosine * uy;
    const camber_real length = CAMBER_SQRT(x * x + y * y), least = CAMBER_REAL(1e-20f);
    const camber_real scale = 1.0f / CAMBER_MORE(length, least);
    seen[0] = x * scale;
    seen[1] = y * scale;
}

/* The end of a segment at a point: which side of the bisector the segment draws, and its cut in the picture. Where the
 * join is seen narrower than a pixel, the cut divides the pixels between both segments. Its four words are the normal,
 * its position, and a share: 1 where the line is wide and the plane's bisector divides the pixels, down to 0. turns: 1
 * at B, -1 at A; c and s: cosine and sine of half the turn. */
CAMBER_FN void camber_pitch_cut(camber_eye e, const camber_segment *s, const camber_real place[2], camber_words end,
                                float turns, camber_real c, camber_real sine, camber_real *own, camber_real cut[4]) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f), h = s->half_width;
    const camber_real cosine = c * c - sine * sine, turned = 2.0f * turns * c * sine;
    const camber_real other_x = s->ux * cosine - s->uy * turned, other_y = s->ux * turned + s->uy * cosine;
    const camber_real width = camber_pitch_width(e, place[0], place[1], s->ux, s->uy, h);
    const camber_real other = camber_pitch_width(e, place[0], place[1], other_x, other_y, h);
    const camber_real narrowest = CAMBER_LESS(width, other);
    camber_real along[2], behind[2], seen_x, seen_y;
    camber_pitch_direction(e, place, s->ux, s->uy, along);
    camber_pitch_direction(e, place, other_x, other_y, behind);
    camber_pitch_see(e, place[0], place[1], &seen_x, &seen_y);
    const camber_real sum_x = along[0] + behind[0], sum_y = along[1] + behind[1];
    const camber_real length = CAMBER_SQRT(sum_x * sum_x + sum_y * sum_y);
    const camber_mask bends = length > 1e-5f;
    const camber_real scale = one / (bends ? length : one);
    const camber_real x = bends ? sum_x * scale : along[0], y = bends ? sum_y * scale : along[1];
    const camber_words class = CAMBER_END_CLASS(end);
    const camber_mask is_cap = class == CAMBER_CLASS_CAP;
    const camber_mask wide = is_cap | (1.0f - e.fall * place[1] < CAMBER_PITCH_LEAST);
    cut[0] = wide ? none : turns * x;
    cut[1] = wide ? none : turns * y;
    cut[2] = wide ? none : turns * (x * seen_x + y * seen_y);
    cut[3] = wide ? one : camber_clamp_to_one(1.5f * narrowest - 0.75f);
    const camber_real soon = CAMBER_END_IS_LAST(end) ? CAMBER_REAL(0.35f) : CAMBER_REAL(0.6f);
    const camber_mask spill = (class != CAMBER_CLASS_CUT) & (0.5f * narrowest * CAMBER_FABS(sine) > soon * c);
    const camber_real own_side = spill ? none : CAMBER_REAL(CAMBER_ALWAYS_PX);
    *own = is_cap ? CAMBER_REAL(CAMBER_NEVER_PX) : own_side;
}

/* How far a stroke reaches past an end, px of the plane. */
CAMBER_FN camber_real camber_pitch_reach(camber_words end, camber_real c, camber_real sine, camber_real half_width) {
    const camber_real one = CAMBER_REAL(1.0f), least = CAMBER_REAL(1e-5f), aside = CAMBER_FABS(sine);
    const camber_words kind = CAMBER_END_KIND(end), class = CAMBER_END_CLASS(end);
    const camber_real tip =
        ((kind == CAMBER_ENDS_MITER) | (kind == CAMBER_ENDS_SPLIT_MITER)) ? aside / CAMBER_MORE(c, least) : aside;
    const camber_real whole = CAMBER_MORE(tip, one), cap = kind == CAMBER_ENDS_BUTT ? CAMBER_REAL(0.0f) : one;
    return half_width * (class == CAMBER_CLASS_CAP ? cap : class == CAMBER_CLASS_SPLIT ? whole : tip);
}

/* Clips a segment to what the camera sees: from where to where, px along it from A. all_over: it may be seen anywhere
 * in the picture, as a wide line with one side behind the camera. Returns whether it is seen. */
CAMBER_FN camber_mask camber_pitch_clip(camber_eye e, const camber_segment *s, camber_real *from, camber_real *to,
                                        camber_mask *all_over) {
    /* A point that is nearer than the picture's bottom is not seen. One half as deep is not projected exactly. */
    const float nearest = e.cosine / (e.cosine + e.fall * e.y), hidden = 0.5f * nearest;
    const camber_real spread = e.fall * CAMBER_FABS(s->ux) * s->half_width, rate = e.fall * s->uy;
    const camber_real room = 1.0f - e.fall * s->ay - spread - hidden;
    const camber_real at_from = room - rate * *from, at_to = room - rate * *to;
    const camber_real cut = room / (rate == 0.0f ? CAMBER_REAL(1.0f) : rate);
    *all_over = (2.0f * spread > nearest - hidden) & (CAMBER_LESS(at_from, at_to) < 0.0f);
    *to = ((rate > 0.0f) & (cut < *to)) ? cut : *to;
    *from = ((rate < 0.0f) & (cut > *from)) ? cut : *from;
    return *all_over | !((*from > *to) | ((rate == 0.0f) & (room < 0.0f)));
}

/* The footprint of a segment: the rectangle along it in the picture that holds its corners, and half a pixel around
 * them. from and to: px along the segment in the plane. */
CAMBER_FN void camber_pitch_footprint(camber_eye e, const camber_segment *s, camber_real from, camber_real to,
                                      camber_mask all_over, camber_segment *footprint, camber_real *ends) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f), h = s->half_width;
    const camber_real start_x = s->ax + s->ux * from, start_y = s->ay + s->uy * from;
    const camber_real stop_x = s->ax + s->ux * to, stop_y = s->ay + s->uy * to;
    camber_real x0, y0, x1, y1, low_x = none, high_x = none, low_y = none, high_y = none;
    camber_pitch_see(e, start_x, start_y, &x0, &y0);
    camber_pitch_see(e, stop_x, stop_y, &x1, &y1);
    const camber_real dx = x1 - x0, dy = y1 - y0, length = CAMBER_SQRT(dx * dx + dy * dy);
    const camber_mask inputs = (length > 1e-3f) & !all_over;
    const camber_real scale = one / (inputs ? length : one);
    const camber_real axis_x = inputs ? dx * scale : one, axis_y = inputs ? dy * scale : none;
    for (int i = 0; i < 4; i++) {
        const float side = i & 1 ? -1.0f : 1.0f;
        camber_real x, y;
        camber_pitch_see(e, (i & 2 ? stop_x : start_x) - side * s->uy * h,
                         (i & 2 ? stop_y : start_y) + side * s->ux * h, &x, &y);
        const camber_real along = (x - x0) * axis_x + (y - y0) * axis_y, aside = (y - y0) * axis_x - (x - x0) * axis_y;
        low_x = i == 0 || along < low_x ? along : low_x;
        high_x = i == 0 || along > high_x ? along : high_x;
        low_y = i == 0 || aside < low_y ? aside : low_y;
        high_y = i == 0 || aside > high_y ? aside : high_y;
    }
    const camber_real middle = 0.5f * (low_x + high_x), aside = 0.5f * (low_y + high_y);
    const camber_real deep = 0.5f * (high_x - low_x) + CAMBER_PAD_PX + CAMBER_PITCH_SLACK_PX;
    const camber_real wide = 0.5f * (high_y - low_y) + CAMBER_PAD_PX + CAMBER_PITCH_SLACK_PX;
    const camber_real past = CAMBER_LESS(deep, wide), rest = deep - past;
    const camber_real from_x = x0 + axis_x * middle - axis_y * aside, from_y = y0 + axis_y * middle + axis_x * aside;
    const camber_real nx = CAMBER_FABS(axis_x), ny = CAMBER_FABS(axis_y);
    const camber_real across = nx * past + ny * wide, down = ny * past + nx * wide;
    const camber_real x = e.x + (all_over ? none : from_x), y = e.y + (all_over ? none : from_y);
    const camber_real whole = CAMBER_REAL(4.0f * (e.x + e.y));
    footprint->ux = axis_x;
    footprint->uy = axis_y;
    footprint->ax = x - (all_over ? none : axis_x * rest);
    footprint->ay = y - (all_over ? none : axis_y * rest);
    footprint->bx = x + (all_over ? none : axis_x * rest);
    footprint->by = y + (all_over ? none : axis_y * rest);
    footprint->half_width = (all_over ? whole : wide) - CAMBER_PAD_PX;
    footprint->reach = all_over ? whole : CAMBER_MORE(across, down);
    *ends = all_over ? whole : past;
}

/* Projects a straight edge of the plane, by its unit normal out of the stroke and its position along that. In the
 * picture a pixel lies at[0] - at[1] x - at[2] y px inside it. */
CAMBER_FN void camber_pitch_project_edge(camber_eye e, camber_real nx, camber_real ny, camber_real at,
                                         camber_real edge[3]) {
    const camber_real x = nx, y = (ny - e.fall * at) / e.cosine, least = CAMBER_REAL(1e-15f);
    const camber_real length = CAMBER_SQRT(x * x + y * y), scale = 1.0f / CAMBER_MORE(length, least);
    edge[0] = at * scale;
    edge[1] = x * scale;
    edge[2] = y * scale;
}

/* Makes a segment's footprint, and the words of its plane. Returns whether it is seen. Nothing is seen above the
 * horizon, px from the picture's top. */
CAMBER_FN camber_mask camber_pitch_segment_of(camber_eye e, float horizon, const camber_segment *s,
                                              camber_segment *footprint, camber_plane *plane) {
    const camber_real h = s->half_width, none = CAMBER_REAL(0.0f);
    const camber_words end_a = CAMBER_END_OF_A(s->flags), end_b = CAMBER_END_OF_B(s->flags);
    const camber_real ca = s->nax * s->ux + s->nay * s->uy, sa = s->nax * s->uy - s->nay * s->ux;
    const camber_real cb = s->nbx * s->ux + s->nby * s->uy, sb = s->nby * s->ux - s->nbx * s->uy;
    const camber_real a[2] = {s->ax, s->ay}, b[2] = {s->bx, s->by};
    const camber_real along_a = s->ax * s->ux + s->ay * s->uy, along_b = s->bx * s->ux + s->by * s->uy;
    const camber_real across = s->ay * s->ux - s->ax * s->uy;
    camber_pitch_cut(e, s, a, end_a, -1.0f, ca, sa, &plane->owner_a, plane->cut_a);
    camber_pitch_cut(e, s, b, end_b, 1.0f, cb, sb, &plane->owner_b, plane->cut_b);
    camber_pitch_project_edge(e, -s->uy, s->ux, across + h, plane->left);
    camber_pitch_project_edge(e, s->uy, -s->ux, h - across, plane->right);
    const camber_real slant_a = CAMBER_FABS(s->uy - e.fall * along_a), slant_b = CAMBER_FABS(s->uy - e.fall * along_b);
    plane->margin = CAMBER_FABS(s->ux) + CAMBER_MORE(slant_a, slant_b) / e.cosine;
    camber_real from = none - camber_pitch_reach(end_a, ca, sa, h);
    camber_real to = along_b - along_a + camber_pitch_reach(end_b, cb, sb, h);
    camber_mask all_over;
    const camber_mask seen = camber_pitch_clip(e, s, &from, &to, &all_over);
    *footprint = *s;
    camber_pitch_footprint(e, s, from, to, all_over, footprint, &plane->ends);
    return seen & (CAMBER_MORE(footprint->ay, footprint->by) + footprint->reach > horizon);
}

#endif
