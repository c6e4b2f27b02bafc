/* Segments in a picture with a pitch: computes where in the picture a segment of the plane is seen.
 *
 * Input: a segment in the plane and the camera (src/base/perspective.h). Output: the segment's footprint, a rectangle
 * of the picture around everything that it draws, in the words of a segment; and camber_plane, which its edge needs in
 * addition. Positions in the plane are relative to the point that the camera looks at, and positions in the picture to
 * its middle; only the footprint is relative to the picture's corner. shaders/stroke.vert uses a trapezoid instead.
 *
 * A distance from a line of the plane, n . p - n . a, times by_depth (1 / depth) is linear in the picture. So straight
 * edges of the plane are straight in the picture, and far from the ends of a segment only its sides count. */
#ifndef CAMBER_KERNELS_PITCH_SEGMENT_H
#define CAMBER_KERNELS_PITCH_SEGMENT_H

#include "pitch.h"
#include "segment.h"

/* The words of a segment in the plane, in a buffer beside the footprints. */
#define CAMBER_PLANE_WORDS 32
#define CAMBER_PLANE_AX 0          /* to word 9: A, B, the direction, the bisectors' normals, as in a segment */
#define CAMBER_PLANE_HALF_WIDTH 10 /* px of the plane */
#define CAMBER_PLANE_OWNER_A 11    /* two words: camber_pitch_cut, owner */
#define CAMBER_PLANE_OWNER_B 12
#define CAMBER_PLANE_CUT_A 13 /* four words each: camber_pitch_cut */
#define CAMBER_PLANE_CUT_B 17
#define CAMBER_PLANE_ENDS 21   /* how far the footprint reaches past its ends, px of the picture */
#define CAMBER_PLANE_MARGIN 22 /* the most px of the plane / depth per px along the segment */
#define CAMBER_PLANE_LEFT 23   /* its sides in the picture, three words each: camber_pitch_project_edge */
#define CAMBER_PLANE_RIGHT 26
#define CAMBER_PLANE_COSINE 29 /* camber_eye, cosine and fall: 1 and 0 if the segment is upright */
#define CAMBER_PLANE_FALL 30

/* By how much the footprint is wider than what is drawn, so that rounding does not matter. */
#define CAMBER_PITCH_SLACK_PX 0.02f

/* ---- Footprints ---- */

typedef struct camber_plane {
    camber_pitch_cut cut_a, cut_b;
    camber_real ends, margin, left[3], right[3];
} camber_plane;

/* Computes the footprint of a segment: the rectangle along it in the picture that contains its corners and half a pixel
 * around them. from and to: px along the segment in the plane. */
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

/* Projects a straight edge of the plane, given its unit normal out of the stroke and its position along this normal. In
 * the picture a pixel is at[0] - at[1] x - at[2] y px inside it. */
CAMBER_FN void camber_pitch_project_edge(camber_eye e, camber_real nx, camber_real ny, camber_real at,
                                         camber_real edge[3]) {
    const camber_real x = nx, y = (ny - e.fall * at) / e.cosine, least = CAMBER_REAL(1e-15f);
    const camber_real length = CAMBER_SQRT(x * x + y * y), scale = 1.0f / CAMBER_MORE(length, least);
    edge[0] = at * scale;
    edge[1] = x * scale;
    edge[2] = y * scale;
}

/* Projects the edge of a ring, which is a straight line in the picture too. Parts behind the camera are below the
 * picture, and change nothing in it. An end that two edges share stays the same point. Returns whether it is seen. */
CAMBER_FN camber_mask camber_pitch_edge_of(camber_eye e, const camber_segment *s, camber_segment *footprint) {
    const camber_real length = (s->bx - s->ax) * s->ux + (s->by - s->ay) * s->uy;
    camber_real from = CAMBER_REAL(0.0f), to = length, x0, y0, x1, y1;
    camber_mask all_over;
    const camber_mask seen = camber_pitch_clip(e, s->ay, s->ux, s->uy, s->half_width, &from, &to, &all_over),
                      is_whole = to >= length;
    camber_pitch_see(e, s->ax + s->ux * from, s->ay + s->uy * from, &x0, &y0);
    camber_pitch_see(e, is_whole ? s->bx : s->ax + s->ux * to, is_whole ? s->by : s->ay + s->uy * to, &x1, &y1);
    camber_edge_segment(e.x + x0, e.y + y0, e.x + x1, e.y + y1, footprint);
    return seen;
}

/* Makes a segment's footprint, and the words of its plane. Returns whether it is seen. Nothing is seen above the
 * horizon, px from the picture's top. */
CAMBER_FN camber_mask camber_pitch_segment_of(camber_eye e, float horizon, const camber_segment *s,
                                              camber_segment *footprint, camber_plane *plane) {
    const camber_real h = s->half_width, none = CAMBER_REAL(0.0f);
    const camber_words end_a = CAMBER_END_OF_A(s->flags), end_b = CAMBER_END_OF_B(s->flags);
    const camber_real ca = s->nax * s->ux + s->nay * s->uy, sa = s->nax * s->uy - s->nay * s->ux;
    const camber_real cb = s->nbx * s->ux + s->nby * s->uy, sb = s->nby * s->ux - s->nbx * s->uy;
    const camber_mask own_a = (s->flags & CAMBER_SEGMENT_OWNER_A) != 0u,
                      own_b = (s->flags & CAMBER_SEGMENT_OWNER_B) != 0u;
    const camber_pitch_end a = {s->ax, s->ay, s->ux, s->uy, h, ca, sa, end_a, own_a, -1.0f};
    const camber_pitch_end b = {s->bx, s->by, s->ux, s->uy, h, cb, sb, end_b, own_b, 1.0f};
    const camber_real along_a = s->ax * s->ux + s->ay * s->uy, along_b = s->bx * s->ux + s->by * s->uy;
    const camber_real across = s->ay * s->ux - s->ax * s->uy;
    camber_pitch_cut_of(e, &a, &plane->cut_a);
    camber_pitch_cut_of(e, &b, &plane->cut_b);
    camber_pitch_project_edge(e, -s->uy, s->ux, across + h, plane->left);
    camber_pitch_project_edge(e, s->uy, -s->ux, h - across, plane->right);
    const camber_real slant_a = CAMBER_FABS(s->uy - e.fall * along_a), slant_b = CAMBER_FABS(s->uy - e.fall * along_b);
    plane->margin = CAMBER_FABS(s->ux) + CAMBER_MORE(slant_a, slant_b) / e.cosine;
    camber_real from = none - camber_pitch_reach(end_a, ca, sa, h);
    camber_real to = along_b - along_a + camber_pitch_reach(end_b, cb, sb, h);
    camber_mask all_over;
    const camber_mask seen = camber_pitch_clip(e, s->ay, s->ux, s->uy, s->half_width, &from, &to, &all_over);
    *footprint = *s;
    camber_pitch_footprint(e, s, from, to, all_over, footprint, &plane->ends);
    return seen & (CAMBER_MORE(footprint->ay, footprint->by) + footprint->reach > horizon);
}

#endif
