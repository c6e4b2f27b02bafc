/* Computes a segment's coefficients from its words, the positions of pixels relative to it, and which cells of a tile
 * it touches.
 *
 * Input: a segment's 16 words as setup writes them, with CAMBER_STROKE_PITCHED also its words in the plane, and
 * positions of pixels and cells in the picture. Output: the input of stroke.h and features.h, and masks of cells. The
 * kernels and the twin compile it; shaders compute the position of a fragment themselves. */
#ifndef CAMBER_KERNELS_EDGE_H
#define CAMBER_KERNELS_EDGE_H

#include "brush_ext.h"
#include "images.h"
#include "pitch_segment.h"

/* A lane is partial if a segment may touch a cell, near_end if an end is close enough to matter, and full if the whole
 * cell is inside the stroke. */
typedef struct camber_cell_masks {
    camber_mask partial, near_end, full;
} camber_cell_masks;

#if CAMBER_STROKE_PITCHED

/* ---- With a pitch ---- */

/* Returns the form of a line of the plane, given its unit normal and its position along this normal. */
CAMBER_FN camber_form camber_form_of(camber_eye e, float nx, float ny, float at) {
    camber_form f;
    f.at = at;
    f.x = nx;
    f.y = (ny - e.fall * at) / e.cosine;
    return f;
}

CAMBER_FN camber_real camber_form_at(const camber_form *f, camber_real x, camber_real y) {
    return x * f->x + y * f->y - f->at;
}

CAMBER_FN void camber_seen_edge_of(float at, float x, float y, camber_flag linear, camber_seen_edge *edge) {
    edge->at = at;
    edge->x = x;
    edge->y = y;
    camber_profile_of(x, y, linear, &edge->cuts);
}

/* Computes the coefficients from the words of the footprint (segment) and the words of the plane, which has the cosine
 * and the fall of its own camera. */
CAMBER_FN void camber_edge_of(camber_eye e, CAMBER_GLOBAL const float *segment, CAMBER_GLOBAL const float *plane,
                              camber_u32 flags, camber_edge *p) {
    const float ax = plane[CAMBER_SEGMENT_AX], ay = plane[CAMBER_SEGMENT_AY], bx = plane[CAMBER_SEGMENT_BX];
    const float by = plane[CAMBER_SEGMENT_BY], nax = plane[CAMBER_SEGMENT_NAX], nay = plane[CAMBER_SEGMENT_NAY];
    const float nbx = plane[CAMBER_SEGMENT_NBX], nby = plane[CAMBER_SEGMENT_NBY], h = plane[CAMBER_SEGMENT_HALF_WIDTH];
    const camber_u32 end_a = CAMBER_END_OF_A(flags), end_b = CAMBER_END_OF_B(flags);
    e.cosine = plane[CAMBER_PLANE_COSINE];
    e.fall = plane[CAMBER_PLANE_FALL];
    p->by_cosine = 1.0f / e.cosine;
    p->fall = e.fall;
    p->ux = plane[CAMBER_SEGMENT_UX];
    p->uy = plane[CAMBER_SEGMENT_UY];
    p->half_width = h;
    p->along_a = ax * p->ux + ay * p->uy;
    p->across_a = ay * p->ux - ax * p->uy;
    const float along_b = bx * p->ux + by * p->uy;
    p->length = along_b - p->along_a;
    p->ca = nax * p->ux + nay * p->uy;
    p->sa = nax * p->uy - nay * p->ux;
    p->cb = nbx * p->ux + nby * p->uy;
    p->sb = nby * p->ux - nbx * p->uy;
    p->x = camber_form_of(e, p->ux, p->uy, p->along_a);
    p->y = camber_form_of(e, -p->uy, p->ux, p->across_a);
    p->past_b = camber_form_of(e, p->ux, p->uy, along_b);
    p->fa = camber_form_of(e, nax, nay, ax * nax + ay * nay);
    p->fb = camber_form_of(e, nbx, nby, bx * nbx + by * nby);
    p->linear = flags & CAMBER_SEGMENT_LINEAR;
    CAMBER_GLOBAL const float *left = plane + CAMBER_PLANE_LEFT, *right = plane + CAMBER_PLANE_RIGHT;
    CAMBER_GLOBAL const float *cut_a = plane + CAMBER_PLANE_CUT_A, *cut_b = plane + CAMBER_PLANE_CUT_B;
    camber_seen_edge_of(left[0], left[1], left[2], p->linear, &p->left);
    camber_seen_edge_of(right[0], right[1], right[2], p->linear, &p->right);
    camber_seen_edge_of(cut_a[2], cut_a[0], cut_a[1], p->linear, &p->cut_a);
    camber_seen_edge_of(cut_b[2], cut_b[0], cut_b[1], p->linear, &p->cut_b);
    p->wide_a = cut_a[3];
    p->wide_b = cut_b[3];
    p->owner_a = plane[CAMBER_PLANE_OWNER_A];
    p->owner_b = plane[CAMBER_PLANE_OWNER_B];
    p->end_a = CAMBER_END_KIND(end_a);
    p->end_b = CAMBER_END_KIND(end_b);
    p->flat_a = camber_pitch_flat_from(end_a, h, p->wide_a);
    p->flat_b = camber_pitch_flat_from(end_b, h, p->wide_b);
    p->round_a = camber_round_from(p->end_a);
    p->round_b = camber_round_from(p->end_b);
    p->tip_a = camber_tip_from(CAMBER_END_IS_ROUND_CAP(end_a), h);
    p->tip_b = camber_tip_from(CAMBER_END_IS_ROUND_CAP(end_b), h);
    p->thin = CAMBER_YES;
    p->tips = CAMBER_END_IS_ROUND_CAP(end_a) || CAMBER_END_IS_ROUND_CAP(end_b);
    p->capped = p->flat_a < CAMBER_NEVER_PX || p->flat_b < CAMBER_NEVER_PX;
    p->bends = camber_line_bends(p->sa, p->sb);
    p->sharp = p->end_a == CAMBER_ENDS_MITER || p->end_a == CAMBER_ENDS_BEVEL || p->end_a > CAMBER_ENDS_SPLIT_ROUND ||
               p->end_b == CAMBER_ENDS_MITER || p->end_b == CAMBER_ENDS_BEVEL || p->end_b > CAMBER_ENDS_SPLIT_ROUND;
    p->narrow = p->wide_a < 1.0f || p->wide_b < 1.0f;
    p->margin = plane[CAMBER_PLANE_MARGIN];
    const float sx = segment[CAMBER_SEGMENT_AX] - e.x, sy = segment[CAMBER_SEGMENT_AY] - e.y;
    const float dx = segment[CAMBER_SEGMENT_BX] - segment[CAMBER_SEGMENT_AX],
                dy = segment[CAMBER_SEGMENT_BY] - segment[CAMBER_SEGMENT_AY];
    p->axis_x = segment[CAMBER_SEGMENT_UX];
    p->axis_y = segment[CAMBER_SEGMENT_UY];
    p->axis_at = sx * p->axis_x + sy * p->axis_y;
    p->aside_at = sy * p->axis_x - sx * p->axis_y;
    p->from = CAMBER_PITCH_SLACK_PX - plane[CAMBER_PLANE_ENDS];
    p->to = dx * p->axis_x + dy * p->axis_y - p->from;
    p->wide = segment[CAMBER_SEGMENT_HALF_WIDTH] + CAMBER_PAD_PX - CAMBER_PITCH_SLACK_PX;
}

/* Returns how far the middles of a cell's pixels are from the cell's middle, along a normal. */
CAMBER_FN float camber_cell_reach(float nx, float ny) {
    return 1.5f * (CAMBER_FABS(nx) + CAMBER_FABS(ny));
}

/* Whether a join's cut may pass through a pixel of a cell, whose middle is x, y. */
CAMBER_FN camber_mask camber_cut_is_near(const camber_seen_edge *cut, float wide, camber_real x, camber_real y) {
    return camber_seen_inside(cut, x, y) <=
           (wide < 1.0f ? camber_cell_reach(cut->x, cut->y) + CAMBER_PAD_PX : CAMBER_ALWAYS_PX);
}

/* Computes the positions of cells relative to a segment, given the positions of their middles. */
CAMBER_FN void camber_cell_masks_of(const camber_edge *p, camber_real x, camber_real y, camber_cell_masks *cells) {
    const float reach_a = camber_cell_reach(p->fa.x, p->fa.y), reach_b = camber_cell_reach(p->fb.x, p->fb.y);
    const float left = camber_cell_reach(p->left.x, p->left.y), right = camber_cell_reach(p->right.x, p->right.y);
    const float axis = camber_cell_reach(p->axis_x, p->axis_y);
    /* A bend at a join moves the line sideways by at most this. */
    const float past_left = p->bends ? CAMBER_PAD_PX : p->left.cuts.extent;
    const float past_right = p->bends ? CAMBER_PAD_PX : p->right.cuts.extent;
    const float far_a = !p->narrow && p->owner_a == CAMBER_ALWAYS_PX ? -reach_a : CAMBER_ALWAYS_PX;
    const float far_b = !p->narrow && p->owner_b == CAMBER_ALWAYS_PX ? reach_b : -CAMBER_ALWAYS_PX;
    const camber_real in_left = camber_seen_inside(&p->left, x, y), in_right = camber_seen_inside(&p->right, x, y);
    const camber_real along = x * p->axis_x + y * p->axis_y - p->axis_at;
    const camber_real aside = CAMBER_FABS(y * p->axis_x - x * p->axis_y - p->aside_at);
    const camber_real fa = camber_form_at(&p->fa, x, y), fb = camber_form_at(&p->fb, x, y);
    cells->partial = (in_left > -past_left - left) & (in_right > -past_right - right) & (along > p->from - axis) &
                     (along < p->to + axis) & (aside < p->wide + axis) & (fa >= far_a) & (fb < far_b);
    const float ends = p->sharp ? -CAMBER_ALWAYS_PX : p->margin, close = 0.5f * p->margin;
    const camber_real from = camber_form_at(&p->x, x, y), to = camber_form_at(&p->past_b, x, y);
    const float reach_from = camber_cell_reach(p->x.x, p->x.y);
    const float reach_to = camber_cell_reach(p->past_b.x, p->past_b.y);
    const camber_mask cut_a = camber_cut_is_near(&p->cut_a, p->wide_a, x, y);
    const camber_mask cut_b = camber_cut_is_near(&p->cut_b, p->wide_b, x, y);
    cells->near_end = (from < ends + reach_from) | (to > -ends - reach_to) | (fa < close + reach_a) |
                      (fb > -close - reach_b) | cut_a | cut_b;
    cells->full = (in_left >= p->left.cuts.extent + left) & (in_right >= p->right.cuts.extent + right);
}

/* Fills in a pixel's positions. x, y: its position from the picture's middle, px. */
CAMBER_FN void camber_look(const camber_edge *p, camber_real x, camber_real y, camber_pixel *at) {
    const camber_real least = CAMBER_REAL(CAMBER_PITCH_LEAST), one = CAMBER_REAL(1.0f);
    at->seen_x = x;
    at->seen_y = y;
    const camber_real by_depth = 1.0f + y * (p->fall * p->by_cosine);
    at->by_depth = CAMBER_MORE(by_depth, least);
    const camber_real depth = one / at->by_depth;
    at->ground_x = x * depth;
    at->ground_y = y * p->by_cosine * depth;
    at->x = camber_form_at(&p->x, x, y) * depth;
    at->y = camber_form_at(&p->y, x, y) * depth;
    at->past_a = -at->x;
    at->past_b = camber_form_at(&p->past_b, x, y) * depth;
    at->fa = camber_form_at(&p->fa, x, y) * depth;
    at->fb = camber_form_at(&p->fb, x, y) * depth;
}

/* Returns the area of a pixel that no end is near: only the sides count. */
CAMBER_FN camber_real camber_edge_side(const camber_edge *p, camber_real x, camber_real y) {
    const camber_seen_edge *l = &p->left, *r = &p->right;
    const camber_real in_left = camber_seen_inside(l, x, y), in_right = camber_seen_inside(r, x, y);
    const camber_real both = camber_covered(in_left, &l->cuts) + camber_covered(in_right, &r->cuts) - 1.0f;
    return both > 0.0f ? both : CAMBER_REAL(0.0f);
}

#else

/* ---- From above ---- */

/* Computes the coefficients of a segment from its words. */
CAMBER_FN CAMBER_INLINE void camber_edge_of(CAMBER_GLOBAL const float *segment, camber_u32 flags, camber_edge *p) {
    p->ax = segment[CAMBER_SEGMENT_AX];
    p->ay = segment[CAMBER_SEGMENT_AY];
    p->bx = segment[CAMBER_SEGMENT_BX];
    p->by = segment[CAMBER_SEGMENT_BY];
    p->ux = segment[CAMBER_SEGMENT_UX];
    p->uy = segment[CAMBER_SEGMENT_UY];
    p->nax = segment[CAMBER_SEGMENT_NAX];
    p->nay = segment[CAMBER_SEGMENT_NAY];
    p->nbx = segment[CAMBER_SEGMENT_NBX];
    p->nby = segment[CAMBER_SEGMENT_NBY];
    p->half_width = segment[CAMBER_SEGMENT_HALF_WIDTH];
    p->side.slope = segment[CAMBER_SEGMENT_SLOPE];
    p->side.curve = segment[CAMBER_SEGMENT_CURVE];
    camber_edge_finish(flags, p);
}

/* Fills in a pixel's positions. x, y: its position in the picture, px. */
CAMBER_FN void camber_look(const camber_edge *p, camber_real x, camber_real y, camber_pixel *at) {
    const camber_real qx = x - p->ax, qy = y - p->ay;
    at->x = qx * p->ux + qy * p->uy;
    at->y = qy * p->ux - qx * p->uy;
    at->past_a = -at->x;
    at->past_b = at->x - p->length;
    at->fa = qx * p->nax + qy * p->nay;
    at->fb = (x - p->bx) * p->nbx + (y - p->by) * p->nby;
}

/* Returns the area of a pixel that no end is near: only the sides count. */
CAMBER_FN camber_real camber_edge_side(const camber_edge *p, camber_real x, camber_real y) {
    const camber_real qx = x - p->ax, qy = y - p->ay, aside = qy * p->ux - qx * p->uy;
    camber_pixel at;
    at.d = CAMBER_FABS(aside);
    return camber_edge_within(p, &at);
}

#endif

/* Computes camber_edge_normal if no end is near: into the stroke from the nearer side. */
CAMBER_FN void camber_side_normal(const camber_edge *p, camber_real y, camber_real *nx, camber_real *ny) {
    *nx = y > 0.0f ? CAMBER_REAL(p->uy) : CAMBER_REAL(-p->uy);
    *ny = y > 0.0f ? CAMBER_REAL(-p->ux) : CAMBER_REAL(p->ux);
}

/* Returns the area of a pixel that a segment without features draws. camber_look must have filled in its positions. */
CAMBER_FN CAMBER_INLINE camber_real camber_edge_area(const camber_edge *p, camber_pixel *at) {
    return camber_stroke_area(p, (const camber_extras *)0, 0u, at, CAMBER_NO);
}

#endif
