/* The share of a pixel that a segment covers, in a picture with a pitch: coverage.h for a plane that is seen at an
 * angle.
 *
 * Input: the footprint and the plane of a segment, as setup writes them, and positions in the picture. Output: areas
 * from 0 to 1, and masks of the cells that the segment touches. shaders/stroke.frag holds the same formulas under
 * PITCHED.
 *
 * A distance from a line of the plane, n . p - n . a, divided by the depth there is linear in the picture. So straight
 * edges of the plane are straight in the picture, and far from the ends of a segment only its sides count. Near them a
 * pixel is projected into the plane. */
#ifndef CAMBER_KERNELS_PITCH_COVERAGE_H
#define CAMBER_KERNELS_PITCH_COVERAGE_H

#include "pitch_segment.h"

/* ---- Edges ---- */

/* How far a pixel lies past a line of the plane, divided by its depth. This is linear in the picture: x, y, less at. */
typedef struct camber_form {
    float at, x, y;
} camber_form;

/* A straight edge in the picture, and how it cuts pixels: edge_of in shaders/edge.glsl. */
typedef struct camber_seen_edge {
    float at, x, y;
    float extent, corner, slope, curve;
} camber_seen_edge;

/* The coefficients of a segment in a picture with a pitch. */
typedef struct camber_pitch_edge {
    float by_cosine, fall;
    float ux, uy, half_width, length;
    float along_a,
        across_a; /* where A lies along the segment's direction and across it, px from where the camera looks at */
    float ca, sa, cb, sb;
    camber_form x, y, past_b, fa, fb;
    camber_seen_edge left, right, cut_a, cut_b;
    float owner_a, owner_b, wide_a, wide_b; /* wide: the share of camber_pitch_cut */
    float flat_a, flat_b, round_a, round_b;
    float margin;
    float axis_x, axis_y, axis_at, aside_at, from, to, wide; /* the footprint */
    camber_u32 end_a, end_b, linear, tip_a, tip_b, flat, bends, sharp, narrow;
} camber_pitch_edge;

/* The form of a line of the plane: its unit normal, and its position along that. */
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

/* Works out how an edge of the picture cuts pixels. linear: coverage is a linear ramp. */
CAMBER_FN void camber_seen_edge_of(float at, float x, float y, camber_u32 linear, camber_seen_edge *edge) {
    const float nx = CAMBER_FABS(x), ny = CAMBER_FABS(y);
    const float q = nx < ny ? nx : ny, more = nx < ny ? ny : nx, p = more > 0.5f ? more : 0.5f;
    edge->at = at;
    edge->x = x;
    edge->y = y;
    edge->extent = linear ? 0.5f : 0.5f * (nx + ny);
    edge->corner = linear ? 0.0f : q;
    edge->slope = linear ? 1.0f : 1.0f / p;
    edge->curve = linear || q <= 1e-4f ? 0.0f : 0.5f / (p * q);
}

/* Works out the coefficients from the words of the footprint (segment) and those of the plane. */
CAMBER_FN void camber_pitch_edge_of(camber_eye e, CAMBER_GLOBAL const float *segment, CAMBER_GLOBAL const float *plane,
                                    camber_u32 flags, camber_pitch_edge *p) {
    const float ax = plane[CAMBER_SEGMENT_AX], ay = plane[CAMBER_SEGMENT_AY], bx = plane[CAMBER_SEGMENT_BX];
    const float by = plane[CAMBER_SEGMENT_BY], nax = plane[CAMBER_SEGMENT_NAX], nay = plane[CAMBER_SEGMENT_NAY];
    const float nbx = plane[CAMBER_SEGMENT_NBX], nby = plane[CAMBER_SEGMENT_NBY], h = plane[CAMBER_SEGMENT_HALF_WIDTH];
    const camber_u32 end_a = CAMBER_END_OF_A(flags), end_b = CAMBER_END_OF_B(flags);
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
    p->flat_a = p->end_a == CAMBER_ENDS_BUTT ? 0.0f : p->end_a == CAMBER_ENDS_SQUARE ? h : CAMBER_NEVER_PX;
    p->flat_b = p->end_b == CAMBER_ENDS_BUTT ? 0.0f : p->end_b == CAMBER_ENDS_SQUARE ? h : CAMBER_NEVER_PX;
    p->round_a = p->end_a == CAMBER_ENDS_ROUND || p->end_a == CAMBER_ENDS_SPLIT_ROUND ? 0.0f : CAMBER_NEVER_PX;
    p->round_b = p->end_b == CAMBER_ENDS_ROUND || p->end_b == CAMBER_ENDS_SPLIT_ROUND ? 0.0f : CAMBER_NEVER_PX;
    p->tip_a = CAMBER_END_IS_ROUND_CAP(end_a);
    p->tip_b = CAMBER_END_IS_ROUND_CAP(end_b);
    p->flat = p->flat_a < CAMBER_NEVER_PX || p->flat_b < CAMBER_NEVER_PX;
    p->bends = CAMBER_FABS(p->sa) + CAMBER_FABS(p->sb) > 1e-3f;
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

/* ---- Cells ---- */

/* How far the middles of a cell's pixels lie from the cell's middle, along a normal. */
CAMBER_FN float camber_cell_reach(float nx, float ny) {
    return 1.5f * (CAMBER_FABS(nx) + CAMBER_FABS(ny));
}

/* How far a pixel lies inside an edge of the picture, px. */
CAMBER_FN camber_real camber_seen_inside(const camber_seen_edge *edge, camber_real x, camber_real y) {
    return edge->at - (x * edge->x + y * edge->y);
}

/* Whether a join's cut may pass through a pixel of a cell, whose middle is x, y. */
CAMBER_FN camber_mask camber_cut_is_near(const camber_seen_edge *cut, float wide, camber_real x, camber_real y) {
    return camber_seen_inside(cut, x, y) <=
           (wide < 1.0f ? camber_cell_reach(cut->x, cut->y) + 0.75f : CAMBER_ALWAYS_PX);
}

/* camber_cell_masks_of for a picture with a pitch, by the positions of the cells' middles. */
CAMBER_FN void camber_pitch_cell_masks_of(const camber_pitch_edge *p, camber_real x, camber_real y,
                                          camber_cell_masks *cells) {
    const float reach_a = camber_cell_reach(p->fa.x, p->fa.y), reach_b = camber_cell_reach(p->fb.x, p->fb.y);
    const float left = camber_cell_reach(p->left.x, p->left.y), right = camber_cell_reach(p->right.x, p->right.y);
    const float axis = camber_cell_reach(p->axis_x, p->axis_y);
    /* A bend at a join moves the line to the side by at most this. */
    const float past_left = p->bends ? CAMBER_PAD_PX : p->left.extent;
    const float past_right = p->bends ? CAMBER_PAD_PX : p->right.extent;
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
    cells->full = (in_left >= p->left.extent + left) & (in_right >= p->right.extent + right);
}

/* ---- Pixels ---- */

/* A pixel: its position in the picture, in the plane and relative to the segment, and the nearest point of the line. */
typedef struct camber_pitch_pixel {
    camber_real seen_x, seen_y, by_depth, ground_x, ground_y;
    camber_real x, y, past_a, past_b, fa, fb; /* along, across, past the ends and the bisectors: px of the plane */
    camber_real scale, along_x, along_y; /* px of the picture per px along the line, and the line's direction there */
    camber_real arc_a, arc_b;            /* how far past round ends, px of the plane */
    camber_real off;                     /* from the nearest point of the line, along the line, px of the plane */
    camber_real d, side_x, side_y;       /* the distance from that point, px of the plane, and its direction */
} camber_pitch_pixel;

/* The share of a pixel inside an edge of the picture, whose centre lies s px inside it; (nx, ny): the edge's normal. */
CAMBER_FN camber_real camber_seen_covered(camber_real s, camber_real nx, camber_real ny, camber_u32 linear) {
    const camber_real ax = CAMBER_FABS(nx), ay = CAMBER_FABS(ny), none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f);
    if (linear)
        return camber_clamp_to_one(s + 0.5f);
    const camber_real least = CAMBER_REAL(0.5f), larger = CAMBER_MORE(ax, ay), p = CAMBER_MORE(larger, least);
    const camber_real q = CAMBER_LESS(ax, ay), safe = q > 1e-4f ? q : one, scale = 1.0f / (p * safe);
    const camber_real left = 0.5f * (p + q) - CAMBER_FABS(s), rest = left > 0.0f ? left : none;
    const camber_real corner = CAMBER_LESS(rest, q), bend = q > 1e-4f ? 0.5f * scale : none;
    const camber_real area = corner * corner * bend + (rest - corner) * (safe * scale);
    return s < 0.0f ? area : 1.0f - area;
}

/* Projects an edge of the plane, which lies `at` px along its unit normal. seen: its normal in the picture. Returns how
 * many px of the picture, times the depth, a px of the plane across the edge is. */
CAMBER_FN camber_real camber_pitch_normal(const camber_pitch_edge *p, camber_real nx, camber_real ny, camber_real at,
                                          camber_real seen[2]) {
    const camber_real y = (ny - p->fall * at) * p->by_cosine, square = nx * nx + y * y, least = CAMBER_REAL(1e-30f);
    const camber_real scale = 1.0f / CAMBER_SQRT(CAMBER_MORE(square, least));
    seen[0] = nx * scale;
    seen[1] = y * scale;
    return scale;
}

/* The share of a pixel inside an edge of the plane, if its centre shows a point s px of the plane inside. (nx, ny): the
 * edge's normal outwards. */
CAMBER_FN camber_real camber_plane_covered(const camber_pitch_edge *p, const camber_pitch_pixel *at, camber_real s,
                                           camber_real nx, camber_real ny) {
    camber_real seen[2];
    const camber_real lies = nx * at->ground_x + ny * at->ground_y + s;
    const camber_real scale = camber_pitch_normal(p, nx, ny, lies, seen);
    return camber_seen_covered(s * scale * at->by_depth, seen[0], seen[1], p->linear);
}

/* How far a join bends the line to the side: bend of shaders/stroke.frag. */
CAMBER_FN camber_real camber_pitch_bend(camber_real beyond, float sine) {
    const camber_real none = CAMBER_REAL(0.0f), share = 0.5f + beyond;
    return ((beyond > 0.0f) | (share < 0.0f)) ? none : sine * share * share;
}

/* Fills in a pixel's positions. x, y: its position from the picture's middle, px. */
CAMBER_FN void camber_pitch_look(const camber_pitch_edge *p, camber_real x, camber_real y, camber_pitch_pixel *at) {
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
    at->past_a = 0.0f - at->x;
    at->past_b = camber_form_at(&p->past_b, x, y) * depth;
    at->fa = camber_form_at(&p->fa, x, y) * depth;
    at->fb = camber_form_at(&p->fb, x, y) * depth;
}

/* Fills in the nearest point of the line: the line's scale and direction there, arc_a, arc_b, off, and the distance
 * across in d. */
CAMBER_FN void camber_pitch_arc_length(const camber_pitch_edge *p, camber_pitch_pixel *at) {
    const camber_real none = CAMBER_REAL(0.0f), ux = CAMBER_REAL(p->ux), uy = CAMBER_REAL(p->uy);
    camber_real seen[2];
    at->scale = camber_pitch_normal(p, ux, uy, at->x + p->along_a, seen) * at->by_depth;
    at->along_x = seen[0];
    at->along_y = seen[1];
    const camber_real past_a = at->past_a - p->round_a, past_b = at->past_b - p->round_b;
    at->arc_a = past_a > 0.0f ? past_a : none;
    at->arc_b = past_b > 0.0f ? past_b : none;
    camber_real bent = at->y;
    if (p->bends) {
        const camber_real arc = CAMBER_MORE(at->arc_a, at->arc_b), left = 1.0f - arc * at->scale;
        const camber_real bend =
            camber_pitch_bend((0.0f - at->fa) * at->scale, p->sa) + camber_pitch_bend(at->fb * at->scale, p->sb);
        /* A segment shorter than a pixel has no share in the bend. */
        const camber_real knows = camber_clamp_to_one(p->length * at->scale - 1.0f);
        bent = at->y - bend / at->scale * (left > 0.0f ? left : none) * knows;
    }
    at->off = at->arc_b * p->wide_b - at->arc_a * p->wide_a;
    at->d = bent;
}

/* Round caps shorter than a pixel, and seen upright, end like flat ones of the same area. Returns the share of a pixel
 * that they leave along the line. */
CAMBER_FN camber_real camber_pitch_tips(const camber_pitch_edge *p, camber_pitch_pixel *at) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f);
    camber_real across[2];
    camber_pitch_normal(p, CAMBER_REAL(-p->uy), CAMBER_REAL(p->ux), at->y + p->across_a, across);
    const camber_real length = p->half_width * at->scale, more = length - 0.5f;
    const camber_real cosine = at->along_x * across[0] + at->along_y * across[1];
    const camber_real slant = 1.0f - 2.0f * CAMBER_FABS(cosine), upright = slant > 0.0f ? slant : none;
    const camber_real flat = (1.0f - camber_clamp_to_one(2.0f * length - 1.0f)) * upright;
    const camber_mask past_a = at->past_a > 0.0f, past_b = at->past_b > 0.0f;
    const camber_mask past = p->tip_a ? (p->tip_b ? past_a | past_b : past_a) : past_b;
    at->off *= past ? 1.0f - flat : one;
    const camber_real until = 0.5f + 0.785398f * length + 1.2f * (more > 0.0f ? more : none);
    const camber_real tip_a = p->tip_a ? camber_clamp_to_one(until - at->past_a * at->scale) : one;
    const camber_real tip_b = p->tip_b ? camber_clamp_to_one(until - at->past_b * at->scale) : one;
    const camber_real left = (1.0f - upright + tip_a * upright) + (1.0f - upright + tip_b * upright) - 1.0f;
    return left > 0.0f ? left : none;
}

/* Turns `off` and the distance across, which d holds, into the distance d and its direction. */
CAMBER_FN void camber_pitch_turn(const camber_pitch_edge *p, camber_pitch_pixel *at) {
    const camber_real across = at->d, d = CAMBER_SQRT(at->off * at->off + across * across), one = CAMBER_REAL(1.0f);
    const camber_mask apart = d > 1e-4f;
    const camber_real scale = one / (apart ? d : one);
    const camber_real x = apart ? at->off * scale : CAMBER_REAL(0.0f), y = apart ? across * scale : one;
    at->d = d;
    at->side_x = x * p->ux - y * p->uy;
    at->side_y = x * p->uy + y * p->ux;
}

/* The share of a pixel within half_width of the line, px of the plane. */
CAMBER_FN camber_real camber_pitch_within(const camber_pitch_edge *p, const camber_pitch_pixel *at,
                                          camber_real half_width) {
    const camber_real none = CAMBER_REAL(0.0f);
    const camber_real both = camber_plane_covered(p, at, half_width - at->d, at->side_x, at->side_y) +
                             camber_plane_covered(p, at, half_width + at->d, -at->side_x, -at->side_y) - 1.0f;
    return both > 0.0f ? both : none;
}

/* The share of a pixel inside two edges, which alone leave a and b, by the cosine of the angle between their normals.
 */
CAMBER_FN camber_real camber_inside_both(camber_real a, camber_real b, camber_real cosine) {
    const camber_real weight = CAMBER_FABS(cosine), smaller = CAMBER_LESS(a, b), both = a + b - 1.0f;
    const camber_real least = both > 0.0f ? both : CAMBER_REAL(0.0f), bound = cosine > 0.0f ? smaller : least;
    return a * b * (1.0f - weight) + bound * weight;
}

/* The share that the join at B, or at A, leaves of what lies within half_width of the line. */
CAMBER_FN camber_real camber_pitch_join(const camber_pitch_edge *p, const camber_pitch_pixel *at, camber_real area,
                                        float half_width, int at_b) {
    const float c = at_b ? p->cb : p->ca, out = at_b ? 1.0f : -1.0f;
    const camber_real past = at_b ? at->past_b : at->past_a;
    camber_real seen[2], side[2];
    camber_second line;
    camber_second_of(at_b ? p->end_b : p->end_a, c, at_b ? p->sb : p->sa, &line);
    if (!line.bevel && !line.miter)
        return area;
    const float x = line.nx * out * p->ux - line.ny * p->uy, y = line.nx * out * p->uy + line.ny * p->ux;
    const camber_real inside = camber_second_inside(&line, half_width, past, at->y, c);
    const camber_real lies = x * at->ground_x + y * at->ground_y + inside;
    const camber_real scale = camber_pitch_normal(p, CAMBER_REAL(x), CAMBER_REAL(y), lies, seen);
    const camber_real second = camber_seen_covered(inside * scale * at->by_depth, seen[0], seen[1], p->linear);
    camber_pitch_normal(p, at->side_x, at->side_y, at->side_x * at->ground_x + at->side_y * at->ground_y, side);
    const camber_real joined = camber_inside_both(area, second, seen[0] * side[0] + seen[1] * side[1]);
    if (line.bevel)
        return joined;
    return ((past > -1.0f) & (at->y * line.outer > 0.0f)) ? joined : area;
}

CAMBER_FN camber_real camber_pitch_joins(const camber_pitch_edge *p, const camber_pitch_pixel *at, camber_real area,
                                         float half_width) {
    area = camber_pitch_join(p, at, area, half_width, 0);
    return camber_pitch_join(p, at, area, half_width, 1);
}

/* The share that flat caps leave. Seen at an angle they meet the sides at any angle. A line thinner than the pixel has
 * no such corner. */
CAMBER_FN camber_real camber_pitch_caps(const camber_pitch_edge *p, const camber_pitch_pixel *at, camber_real area) {
    camber_real side[2];
    const camber_real lies = at->side_x * at->ground_x + at->side_y * at->ground_y;
    const camber_real across = camber_pitch_normal(p, at->side_x, at->side_y, lies, side) * at->by_depth;
    const camber_real angle = at->along_x * side[0] + at->along_y * side[1];
    const camber_real cosine = p->half_width * across > 0.5f ? angle : CAMBER_REAL(0.0f);
    const camber_real in_a = (p->flat_a - at->past_a) * at->scale, in_b = (p->flat_b - at->past_b) * at->scale;
    const camber_real cut_a = camber_seen_covered(in_a, at->along_x, at->along_y, p->linear);
    const camber_real cut_b = camber_seen_covered(in_b, at->along_x, at->along_y, p->linear);
    return camber_inside_both(camber_inside_both(area, cut_a, 0.0f - cosine), cut_b, cosine);
}

/* The share of a pixel that a segment draws at one of its ends. Where the line is wide, the segment draws all of a
 * pixel whose centre lies before the join. Where it is thin, many segments may meet in a pixel, and each takes its
 * share. */
CAMBER_FN camber_real camber_pitch_owner(const camber_pitch_pixel *at, const camber_seen_edge *cut, float wide,
                                         camber_mask others) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f), whole = others ? none : one;
    if (wide >= 1.0f)
        return whole;
    const camber_real inside = camber_seen_inside(cut, at->seen_x, at->seen_y);
    const camber_real share = camber_covered(inside, cut->extent, cut->corner, cut->slope, cut->curve);
    return share * (1.0f - wide) + whole * wide;
}

/* The share of a pixel that the segment draws, with both ends. */
CAMBER_FN camber_real camber_pitch_share(const camber_pitch_edge *p, const camber_pitch_pixel *at) {
    const camber_real none = CAMBER_REAL(0.0f);
    const camber_mask foreign_a = (at->fa < 0.0f) & (at->past_a > p->owner_a);
    const camber_mask foreign_b = (at->fb >= 0.0f) & (at->past_b > p->owner_b);
    const camber_real share = camber_pitch_owner(at, &p->cut_a, p->wide_a, foreign_a) +
                              camber_pitch_owner(at, &p->cut_b, p->wide_b, foreign_b) - 1.0f;
    const camber_real along = at->seen_x * p->axis_x + at->seen_y * p->axis_y - p->axis_at;
    const camber_real aside = at->seen_y * p->axis_x - at->seen_x * p->axis_y - p->aside_at;
    const camber_mask out = (along <= p->from) | (along >= p->to) | (CAMBER_FABS(aside) >= p->wide);
    return (out | (share < 0.0f)) ? none : share;
}

/* The area of a pixel that the segment draws. camber_pitch_look has filled in its positions. */
CAMBER_FN camber_real camber_pitch_area(const camber_pitch_edge *p, camber_pitch_pixel *at) {
    camber_real tips = CAMBER_REAL(1.0f);
    camber_pitch_arc_length(p, at);
    if (p->tip_a || p->tip_b)
        tips = camber_pitch_tips(p, at);
    camber_pitch_turn(p, at);
    camber_real area = camber_pitch_within(p, at, CAMBER_REAL(p->half_width)) * tips;
    if (p->sharp)
        area = camber_pitch_joins(p, at, area, p->half_width);
    if (p->flat)
        area = camber_pitch_caps(p, at, area);
    return area * camber_pitch_share(p, at);
}

/* The same for a pixel that no end is near to: only the sides count. */
CAMBER_FN camber_real camber_pitch_side(const camber_pitch_edge *p, camber_real x, camber_real y) {
    const camber_seen_edge *l = &p->left, *r = &p->right;
    const camber_real in_left = camber_seen_inside(l, x, y), in_right = camber_seen_inside(r, x, y);
    const camber_real both = camber_covered(in_left, l->extent, l->corner, l->slope, l->curve) +
                             camber_covered(in_right, r->extent, r->corner, r->slope, r->curve) - 1.0f;
    return both > 0.0f ? both : CAMBER_REAL(0.0f);
}

/* The normal of the nearest edge, into the stroke, in the picture. Returns whether there is one: a line thinner than a
 * pixel has two. at: as camber_pitch_area has filled it in. */
CAMBER_FN camber_mask camber_pitch_inward(const camber_pitch_edge *p, const camber_pitch_pixel *at, camber_real *nx,
                                          camber_real *ny) {
    camber_real side[2];
    const camber_real lies = at->side_x * at->ground_x + at->side_y * at->ground_y, d = CAMBER_FABS(at->y);
    const camber_real across = camber_pitch_normal(p, at->side_x, at->side_y, lies, side) * at->by_depth;
    *nx = 0.0f - side[0];
    *ny = 0.0f - side[1];
    if (p->flat) {
        const camber_real cap_a = p->flat_a - at->past_a, cap_b = p->flat_b - at->past_b;
        const camber_mask flat = CAMBER_LESS(cap_a, cap_b) * at->scale < (p->half_width - d) * across;
        const camber_mask first = cap_a < cap_b;
        *nx = flat ? (first ? at->along_x : 0.0f - at->along_x) : *nx;
        *ny = flat ? (first ? at->along_y : 0.0f - at->along_y) : *ny;
    }
    return p->half_width * across > 0.4f;
}

#endif
