/* The share of a pixel that a segment covers, for the rasterizer's kernels and their CPU twin.
 *
 * Input: a segment's 16 words, as setup writes them, and the positions of pixels or cells in the picture. Output: areas
 * from 0 to 1, and masks of the cells that the segment touches. camber_edge_of turns the words into coefficients once.
 * Then a pixel's area follows from its distance to the segment's sides, to its ends and to the bisectors of its joins.
 * shaders/stroke.vert, stroke.frag and flatten.frag hold the same formulas for triangles. */
#ifndef CAMBER_KERNELS_COVERAGE_H
#define CAMBER_KERNELS_COVERAGE_H

#include "segment.h"

/* The coefficients of a segment: all that is the same for each of its pixels. x runs along it, y across it, in px. */
typedef struct camber_edge {
    float ax, ay, bx, by, ux, uy, nax, nay, nbx, nby;
    float length, half_width;
    float extent, corner, slope, curve; /* how its sides cut pixels: edge_of in shaders/edge.glsl */
    float ca, sa, cb, sb;               /* cosine and sine of half the turn at A and at B */
    float flat_a, flat_b;               /* where flat caps lie, px past the end */
    float round_a, round_b;             /* where round ends begin, px past the end */
    float tip_a, tip_b;                 /* where the round caps of thin lines end, px past the end */
    float owner_a, owner_b; /* pixels behind the bisector and this far past the end are the neighbour's, px */
    float slope_a, slope_b, from_a, from_b; /* camber_tight_line */
    camber_u32 end_a, end_b;
    camber_u32 thin, tips, flat, tight, sharp;
} camber_edge;

/* How far past its end a segment still draws pixels that lie behind the bisector, px. */
CAMBER_FN float camber_owner_from(camber_u32 end, camber_u32 own) {
    const float own_from = own ? 0.0f : CAMBER_ALWAYS_PX;
    return end & CAMBER_END_CLASS_BITS ? own_from : CAMBER_NEVER_PX;
}

/* Where a round cap of a thin line ends, px past the end. It is cut straight there, and has a half circle's area. */
CAMBER_FN float camber_cap_tip(camber_u32 end, float half_width) {
    const float past = half_width > 0.5f ? 1.2f * (half_width - 0.5f) : 0.0f;
    return CAMBER_END_IS_ROUND_CAP(end) ? 0.5f + 0.785398f * half_width + past : CAMBER_NEVER_PX;
}

/* The line that bounds a tight join's inner side. It goes from the inner vertex, limit px before the end, to the outer
 * vertex on the bisector. For other ends it is placed where no pixel lies. */
CAMBER_FN void camber_tight_line(camber_u32 end, float c, float s, float half_width, float *slope, float *from) {
    const float reach = half_width + CAMBER_PAD_PX, limit = (float)(CAMBER_END_LIMIT(end)) * (CAMBER_PAD_PX / 127.0f);
    const float outer = CAMBER_FABS(s) * reach;
    const camber_u32 tight = (CAMBER_END_CLASS(end) == CAMBER_CLASS_TIGHT) & (limit * c < outer);
    const float scale = 0.5f / (tight ? reach * c : 1.0f);
    const float more = (outer + limit * c) * scale, less = (outer - limit * c) * scale;
    *slope = tight ? (s > 0.0f ? more : -more) : 0.0f;
    *from = tight ? less * reach : CAMBER_NEVER_PX;
}

/* Works out the coefficients of a segment from its words. The result goes through a pointer, because oclgrind does not
 * follow large results of inlined calls. It is always inlined, so that the compiler drops what the caller does not
 * read. */
CAMBER_FN __attribute__((always_inline)) void camber_edge_of(CAMBER_GLOBAL const float *segment, camber_u32 flags,
                                                             camber_edge *p) {
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
    p->slope = segment[CAMBER_SEGMENT_SLOPE];
    p->curve = segment[CAMBER_SEGMENT_CURVE];
    p->length = (p->bx - p->ax) * p->ux + (p->by - p->ay) * p->uy;
    const float nx = CAMBER_FABS(p->ux), ny = CAMBER_FABS(p->uy), h = p->half_width;
    const camber_u32 linear = flags & CAMBER_SEGMENT_LINEAR;
    p->extent = linear ? 0.5f : 0.5f * (nx + ny);
    p->corner = linear ? 0.0f : nx < ny ? nx : ny;
    p->ca = p->nax * p->ux + p->nay * p->uy;
    p->sa = p->nax * p->uy - p->nay * p->ux;
    p->cb = p->nbx * p->ux + p->nby * p->uy;
    p->sb = p->nby * p->ux - p->nbx * p->uy;
    const camber_u32 end_a = CAMBER_END_OF_A(flags), end_b = CAMBER_END_OF_B(flags);
    p->end_a = CAMBER_END_KIND(end_a);
    p->end_b = CAMBER_END_KIND(end_b);
    p->flat_a = p->end_a == CAMBER_ENDS_BUTT ? 0.0f : p->end_a == CAMBER_ENDS_SQUARE ? h : CAMBER_NEVER_PX;
    p->flat_b = p->end_b == CAMBER_ENDS_BUTT ? 0.0f : p->end_b == CAMBER_ENDS_SQUARE ? h : CAMBER_NEVER_PX;
    p->round_a = p->end_a == CAMBER_ENDS_ROUND || p->end_a == CAMBER_ENDS_SPLIT_ROUND ? 0.0f : CAMBER_NEVER_PX;
    p->round_b = p->end_b == CAMBER_ENDS_ROUND || p->end_b == CAMBER_ENDS_SPLIT_ROUND ? 0.0f : CAMBER_NEVER_PX;
    p->tip_a = camber_cap_tip(end_a, h);
    p->tip_b = camber_cap_tip(end_b, h);
    p->owner_a = camber_owner_from(end_a, flags & CAMBER_SEGMENT_OWNER_A);
    p->owner_b = camber_owner_from(end_b, flags & CAMBER_SEGMENT_OWNER_B);
    p->thin = h < p->extent;
    p->tips = h < CAMBER_TIPS_PX && flags & CAMBER_SEGMENT_ROUNDED;
    p->flat = flags & CAMBER_SEGMENT_FLAT;
    p->sharp = flags & CAMBER_SEGMENT_SHARP;
    const camber_u32 tight_a = CAMBER_END_CLASS(end_a) == CAMBER_CLASS_TIGHT,
                     tight_b = CAMBER_END_CLASS(end_b) == CAMBER_CLASS_TIGHT;
    p->tight = tight_a | tight_b;
    camber_tight_line(end_a, p->ca, p->sa, h, &p->slope_a, &p->from_a);
    camber_tight_line(end_b, p->cb, p->sb, h, &p->slope_b, &p->from_b);
}

/* The share of a pixel inside an edge, whose centre lies s px inside it (below 0: outside). */
CAMBER_FN camber_real camber_covered(camber_real s, float extent, float corner, float slope, float curve) {
    const camber_real left = extent - CAMBER_FABS(s), rest = left > 0.0f ? left : CAMBER_REAL(0.0f);
    const camber_real bend = rest < corner ? rest : CAMBER_REAL(corner);
    const camber_real area = bend * bend * curve + (rest - bend) * slope;
    return s < 0.0f ? area : 1.0f - area;
}

CAMBER_FN camber_real camber_inside_edge(const camber_edge *p, camber_real s) {
    return camber_covered(s, p->extent, p->corner, p->slope, p->curve);
}

CAMBER_FN camber_real camber_clamp_to_one(camber_real x) {
    const camber_real least = x > 0.0f ? x : CAMBER_REAL(0.0f);
    return least < 1.0f ? least : CAMBER_REAL(1.0f);
}

/* The second line that cuts a miter's tip or bounds a bevel. These values are the same from either end of the join. */
typedef struct camber_second {
    camber_u32 bevel, miter;
    float outer, nx, ny; /* the side of the segment that it lies on, 1 or -1; its normal along and across the segment */
} camber_second;

/* second_line of shaders/stroke.frag says the same. */
CAMBER_FN void camber_second_of(camber_u32 end, float c, float s, camber_second *l) {
    const float sine = CAMBER_FABS(s);
    l->bevel = end == CAMBER_ENDS_BEVEL || end == CAMBER_ENDS_SPLIT_BEVEL;
    l->miter = end == CAMBER_ENDS_MITER || end == CAMBER_ENDS_SPLIT_MITER;
    l->outer = s > 0.0f ? -1.0f : 1.0f;
    l->nx = l->bevel ? sine : 2.0f * sine * c;
    l->ny = l->bevel ? l->outer * c : l->outer * (c * c - sine * sine);
}

CAMBER_FN camber_real camber_second_inside(const camber_second *l, float half_width, camber_real past, camber_real y,
                                           float c) {
    return (l->bevel ? half_width * c : half_width) - (past * l->nx + y * l->ny);
}

/* The area that the join's second line leaves of a pixel, as cut_join of shaders/stroke.frag. past: px past the end;
 * (ux, uy): the direction out of it. */
CAMBER_FN camber_real camber_cut_join(camber_real area, const camber_edge *p, camber_u32 end, camber_real past,
                                      camber_real y, float c, float s, float ux, float uy) {
    camber_second l;
    camber_second_of(end, c, s, &l);
    if (!l.bevel && !l.miter)
        return area;
    const camber_real inside = camber_second_inside(&l, p->half_width, past, y, c);
    const float seen_x = CAMBER_FABS(l.nx * ux - l.ny * uy), seen_y = CAMBER_FABS(l.nx * uy + l.ny * ux);
    const float more = seen_x > seen_y ? seen_x : seen_y, less = seen_x > seen_y ? seen_y : seen_x;
    const camber_u32 linear = p->corner == 0.0f && p->extent == 0.5f && p->slope == 1.0f;
    const float extent = linear ? 0.5f : 0.5f * (more + less), slope = linear ? 1.0f : 1.0f / more;
    const float curve = linear || less <= 1e-4f ? 0.0f : 0.5f / (more * less);
    const camber_real second = camber_covered(inside, extent, linear ? 0.0f : less, slope, curve);
    /* The area inside both edges is between the smaller one, the product and the sum less 1, by the angle between
     * them. */
    const float cosine = l.outer * l.ny, weight = CAMBER_FABS(cosine);
    const camber_real smaller = CAMBER_LESS(area, second), product = area * second, both = area + second - 1.0f;
    const camber_real bound = cosine > 0.0f ? smaller : (both > 0.0f ? both : CAMBER_REAL(0.0f));
    const camber_real joined = product * (1.0f - weight) + bound * weight;
    if (l.bevel)
        return joined;
    return ((past > -1.0f) & (y * l.outer > 0.0f)) ? joined : area;
}

CAMBER_FN camber_real camber_cut_joins(const camber_edge *p, camber_real area, camber_real x, camber_real y) {
    area = camber_cut_join(area, p, p->end_a, -x, y, p->ca, p->sa, -p->ux, p->uy);
    return camber_cut_join(area, p, p->end_b, x - p->length, y, p->cb, p->sb, p->ux, p->uy);
}

/* Returns how far past a round end a pixel lies, px; 0 before the ends. *bent is how far it lies to the side of the
 * line, which bends where the next segment begins. x: along the segment; y: across; fa and fb: past the bisectors. */
CAMBER_FN camber_real camber_edge_off(const camber_edge *p, camber_real x, camber_real y, camber_real fa,
                                      camber_real fb, camber_real *bent) {
    const camber_real none = CAMBER_REAL(0.0f), arc_a = -x - p->round_a, arc_b = x - p->length - p->round_b;
    const camber_real farther = CAMBER_MORE(arc_a, arc_b), arc = farther > 0.0f ? farther : none;
    const camber_real near_a = 0.5f - fa, near_b = 0.5f + fb, straight = 1.0f - arc;
    const camber_real share_a = ((fa < 0.0f) | (near_a < 0.0f)) ? none : near_a;
    const camber_real share_b = ((fb > 0.0f) | (near_b < 0.0f)) ? none : near_b;
    const camber_real bend = p->sa * share_a * share_a + p->sb * share_b * share_b;
    *bent = y - bend * (straight > 0.0f ? straight : none);
    return arc;
}

/* The share of a pixel within half_width of the line, if its centre lies d px from it. */
CAMBER_FN camber_real camber_edge_within(const camber_edge *p, float half_width, camber_real d) {
    const camber_real area = camber_inside_edge(p, half_width - d);
    if (!p->thin)
        return area;
    const camber_real both = area + camber_inside_edge(p, half_width + d) - 1.0f;
    return both > 0.0f ? both : CAMBER_REAL(0.0f);
}

/* The share of a pixel that the round caps of a thin line leave. */
CAMBER_FN camber_real camber_edge_tips(const camber_edge *p, camber_real x) {
    const camber_real past_a = -x, past_b = x - p->length;
    const camber_real tips = camber_clamp_to_one(p->tip_a - past_a) + camber_clamp_to_one(p->tip_b - past_b) - 1.0f;
    return tips > 0.0f ? tips : CAMBER_REAL(0.0f);
}

/* The share of a pixel that flat caps leave: one, or both ends of a short segment. */
CAMBER_FN camber_real camber_edge_caps(const camber_edge *p, camber_real x) {
    const camber_u32 at_a = p->flat_a < CAMBER_NEVER_PX, both = at_a && p->flat_b < CAMBER_NEVER_PX;
    const camber_real past_a = -x, past_b = x - p->length;
    const camber_real one = camber_inside_edge(p, at_a ? p->flat_a - past_a : p->flat_b - past_b);
    if (!both)
        return one;
    const camber_real caps = one + camber_inside_edge(p, p->flat_b - past_b) - 1.0f;
    return caps > 0.0f ? caps : CAMBER_REAL(0.0f);
}

/* The area, or 0 where the pixel lies on the neighbour's side of a bisector and the neighbour draws it. */
CAMBER_FN camber_real camber_edge_owner(const camber_edge *p, camber_real area, camber_real x, camber_real y,
                                        camber_real fa, camber_real fb) {
    const camber_real past_a = -x, past_b = x - p->length;
    camber_mask others = ((fa < 0.0f) & (past_a > p->owner_a)) | ((fb >= 0.0f) & (past_b > p->owner_b));
    if (p->tight)
        others |= (past_a + p->slope_a * y > p->from_a) | (past_b + p->slope_b * y > p->from_b);
    return others ? CAMBER_REAL(0.0f) : area;
}

/* The area of a pixel that the segment draws: the one formula that all the functions above are parts of. */
CAMBER_FN camber_real camber_edge_area(const camber_edge *p, camber_real x, camber_real y, camber_real fa,
                                       camber_real fb) {
    camber_real bent;
    const camber_real arc = camber_edge_off(p, x, y, fa, fb, &bent);
    camber_real area = camber_edge_within(p, p->half_width, CAMBER_SQRT(arc * arc + bent * bent));
    if (p->tips)
        area *= camber_edge_tips(p, x);
    if (p->sharp)
        area = camber_cut_joins(p, area, x, y);
    if (p->flat)
        area *= camber_edge_caps(p, x);
    return camber_edge_owner(p, area, x, y, fa, fb);
}

/* The same for a pixel that no end is near to: only the sides count. */
CAMBER_FN camber_real camber_edge_side(const camber_edge *p, camber_real y) {
    return camber_edge_within(p, p->half_width, CAMBER_FABS(y));
}

/* The normal of the nearest edge, into the stroke, in the picture. */
CAMBER_FN void camber_edge_normal(const camber_edge *p, camber_real x, camber_real y, camber_real *nx,
                                  camber_real *ny) {
    const camber_real none = CAMBER_REAL(0.0f), past_a = -x, past_b = x - p->length;
    const camber_real arc_a = past_a - p->round_a, arc_b = past_b - p->round_b;
    const camber_real off_x = (arc_b > 0.0f ? arc_b : none) - (arc_a > 0.0f ? arc_a : none);
    const camber_real length = CAMBER_SQRT(off_x * off_x + y * y), least = CAMBER_REAL(1e-3f);
    const camber_real scale = -1.0f / CAMBER_MORE(length, least);
    camber_real in_x = off_x * scale, in_y = y * scale;
    if (p->flat) {
        const camber_real cap_a = p->flat_a - past_a, cap_b = p->flat_b - past_b;
        const camber_mask flat = CAMBER_LESS(cap_a, cap_b) < p->half_width - CAMBER_FABS(y);
        in_x = flat ? (cap_a < cap_b ? CAMBER_REAL(1.0f) : CAMBER_REAL(-1.0f)) : in_x;
        in_y = flat ? none : in_y;
    }
    *nx = in_x * p->ux - in_y * p->uy;
    *ny = in_x * p->uy + in_y * p->ux;
}

/* How cells lie to a segment. partial: it may touch the cell; near_end: an end is close enough to matter; full: the
 * whole cell lies inside the stroke. */
typedef struct camber_cell_masks {
    camber_mask partial, near_end, full;
} camber_cell_masks;

/* Finds the masks by the positions of the cells' middles, px. */
CAMBER_FN void camber_cell_masks_of(const camber_edge *p, camber_real mx, camber_real my, camber_cell_masks *cells) {
    const float reach = 1.5f * (CAMBER_FABS(p->ux) + CAMBER_FABS(p->uy));
    const float reach_a = 1.5f * (CAMBER_FABS(p->nax) + CAMBER_FABS(p->nay));
    const float reach_b = 1.5f * (CAMBER_FABS(p->nbx) + CAMBER_FABS(p->nby));
    const float far_a = p->owner_a == CAMBER_ALWAYS_PX ? -reach_a : CAMBER_ALWAYS_PX;
    const float far_b = p->owner_b == CAMBER_ALWAYS_PX ? reach_b : -CAMBER_ALWAYS_PX;
    /* A sharp or tight join may cut pixels that lie far from it. */
    const float near = p->sharp ? CAMBER_NEVER_PX : reach + 0.75f;
    const camber_real qx = mx - p->ax, qy = my - p->ay, rx = mx - p->bx, ry = my - p->by;
    const camber_real x = qx * p->ux + qy * p->uy, aside = CAMBER_FABS(qy * p->ux - qx * p->uy);
    const camber_real fa = qx * p->nax + qy * p->nay, fb = rx * p->nbx + ry * p->nby;
    /* A join bends the edge outwards by at most this: camber_edge_off. */
    const float bend_a = CAMBER_FABS(p->sa), bend_b = CAMBER_FABS(p->sb), bend = 0.25f * CAMBER_MORE(bend_a, bend_b);
    cells->partial = (aside < p->half_width + p->extent + reach + bend) & (fa >= far_a) & (fb < far_b);
    cells->near_end = (x < near) | (x > p->length - near) | (fa < reach_a + 0.5f) | (fb > -0.5f - reach_b);
    cells->full = aside <= p->half_width - p->extent - reach;
}

/* ---- Layers ---- */

/* The area of a pixel that all strokes of a layer cover together, as shaders/flatten.frag. over: the area if each were
 * drawn over the others; sum: the sum of their areas a; the normal: the sum of their normals times a (1 - a). */
CAMBER_FN camber_real camber_united(camber_real over, camber_real sum, camber_real nx, camber_real ny) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f), tiny = CAMBER_REAL(1e-6f);
    const camber_real excess = sum - over, inner = sum * sum - 4.0f * (excess > 0.0f ? excess : none);
    const camber_real root = CAMBER_SQRT(inner > 0.0f ? inner : none);
    const camber_real large = 0.5f * (sum + root), small = 0.5f * (sum - root);
    const camber_real more = large < 1.0f ? large : one, less = camber_clamp_to_one(small);
    const camber_real a = more * (1.0f - more), b = less * (1.0f - less), below = 2.0f * a * b;
    const camber_real slant = (nx * nx + ny * ny - a * a - b * b) / CAMBER_MORE(below, tiny);
    const camber_real bounded = slant < 1.0f ? slant : one, cosine = bounded > -1.0f ? bounded : -one;
    const camber_real apart = sum < 1.0f ? sum : one, target = cosine < 0.0f ? apart : more;
    const camber_real weight = CAMBER_FABS(cosine), area = over * (1.0f - weight) + target * weight;
    return sum <= over ? over : (area > 0.99f ? one : area);
}

#endif
