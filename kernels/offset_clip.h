/* Clips offset segments and arcs where the source line comes nearer than the offset: offset.h has the rule. */
#ifndef CAMBER_KERNELS_OFFSET_CLIP_H
#define CAMBER_KERNELS_OFFSET_CLIP_H

#include "offset.h"

/* ---- Hidden intervals ---- */

/* A walk away from a slot: the segments of the line, cut where they leave its reach. */
typedef struct camber_neighbour_walk {
    camber_u32 at, left;
    float x, y, reach;    /* where the walk began, and its radius around that point */
    float ax, ay, bx, by; /* the segment */
} camber_neighbour_walk;

CAMBER_FN camber_neighbour_walk camber_neighbour_walk_from(const camber_source_line *c, camber_u32 slot, float offset) {
    camber_neighbour_walk p;
    p.at = slot;
    p.left = CAMBER_OFFSET_SEGMENTS;
    p.x = p.bx = c->x[slot];
    p.y = p.by = c->y[slot];
    p.ax = p.ay = 0.0f;
    p.reach = CAMBER_OFFSET_REACH * CAMBER_FABS(offset);
    return p;
}

/* Advances by a segment; 0: there is none. */
CAMBER_FN camber_u32 camber_neighbour_walk_on(const camber_source_line *c, camber_neighbour_walk *p, camber_u32 back) {
    if (p->left == 0u)
        return 0u;
    p->left--;
    p->at = back ? camber_slot_before(c, p->at, CAMBER_OFFSET_SEAM) : camber_slot_behind(c, p->at, CAMBER_OFFSET_SEAM);
    if (p->at == 0u) {
        p->left = 0u;
        return 0u;
    }
    p->ax = p->bx;
    p->ay = p->by;
    p->bx = c->x[p->at];
    p->by = c->y[p->at];
    const float ox = p->bx - p->x, oy = p->by - p->y;
    if (ox * ox + oy * oy <= p->reach * p->reach)
        return 1u;
    const float ex = p->bx - p->ax, ey = p->by - p->ay, fx = p->ax - p->x, fy = p->ay - p->y;
    const float qa = ex * ex + ey * ey, qb = fx * ex + fy * ey, qc = fx * fx + fy * fy - p->reach * p->reach;
    const float root = qb * qb - qa * qc;
    const float part = (CAMBER_SQRT(root > 0.0f ? root : 0.0f) - qb) / qa;
    const float t = part > 0.0f ? (part < 1.0f ? part : 1.0f) : 0.0f;
    p->bx = p->ax + camber_offset_round(ex * t);
    p->by = p->ay + camber_offset_round(ey * t);
    p->left = 0u;
    return 1u;
}

/* Computes the interval of a straight line that is nearer than `near` to a segment. The segment's ends are at ax and bx
 * along the line, and ha and hb below it. */
CAMBER_FN camber_u32 camber_hidden_interval(float near, float ax, float ha, float bx, float hb, float *lo, float *hi) {
    *lo = CAMBER_OFFSET_SEGMENT_WHOLE;
    *hi = -CAMBER_OFFSET_SEGMENT_WHOLE;
    const float ra = near * near - ha * ha, rb = near * near - hb * hb;
    if (ra > 0.0f) {
        const float w = CAMBER_SQRT(ra);
        *lo = ax - w;
        *hi = ax + w;
    }
    if (rb > 0.0f) {
        const float w = CAMBER_SQRT(rb);
        *lo = bx - w < *lo ? bx - w : *lo;
        *hi = bx + w > *hi ? bx + w : *hi;
    }
    const float ex = bx - ax, ey = ha - hb, length = CAMBER_SQRT(ex * ex + ey * ey);
    if (CAMBER_FABS(ey) > 1.0e-5f * length) {
        const float c = ex / length, s = ey / length;
        for (camber_u32 side = 0; side < 2u; side++) {
            const float x = (ha * c + (side ? near : -near)) / s;
            const float foot = x * c + ha * s;
            if (foot < 0.0f || foot > length)
                continue;
            *lo = ax + x < *lo ? ax + x : *lo;
            *hi = ax + x > *hi ? ax + x : *hi;
        }
    }
    return *lo < *hi ? 1u : 0u;
}

/* Returns the distance below which something is nearer than the offset, with a margin for rounding. */
CAMBER_FN float camber_offset_near(float offset) {
    const float d = CAMBER_FABS(offset);
    const float least = d < 0.5f ? d * (1.0f / 16.0f) : 1.0f / 32.0f, coarse = d * (1.0f / 65536.0f);
    return d - (coarse > least ? coarse : least);
}

/* Walks in both directions in turn: if a whole ring is within the reach, each direction sees half of it. */
typedef struct camber_neighbour_walks {
    camber_neighbour_walk back, ahead;
    camber_u32 turn; /* 1: back advanced last */
} camber_neighbour_walks;

CAMBER_FN void camber_neighbour_walks_meet(camber_neighbour_walks *p) {
    if (p->back.bx == p->ahead.bx && p->back.by == p->ahead.by)
        p->back.left = p->ahead.left = 0u;
}

/* Begins at two slots, past the segments at them. */
CAMBER_FN camber_neighbour_walks camber_neighbour_walks_from(const camber_source_line *c, camber_u32 back,
                                                             camber_u32 ahead, float offset) {
    camber_neighbour_walks p;
    p.back = camber_neighbour_walk_from(c, back, offset);
    p.ahead = camber_neighbour_walk_from(c, ahead, offset);
    p.turn = 0u;
    camber_neighbour_walk_on(c, &p.back, 1u);
    camber_neighbour_walk_on(c, &p.ahead, 0u);
    camber_neighbour_walks_meet(&p);
    return p;
}

/* Advances by a segment, which is then in p->back or p->ahead; 0: there is none. */
CAMBER_FN camber_u32 camber_neighbour_walks_on(const camber_source_line *c, camber_neighbour_walks *p) {
    for (camber_u32 i = 0; i < 2u; i++) {
        p->turn = 1u - p->turn;
        if (camber_neighbour_walk_on(c, p->turn ? &p->back : &p->ahead, p->turn)) {
            camber_neighbour_walks_meet(p);
            return 1u;
        }
    }
    return 0u;
}

/* Cuts a segment by the parts of the line before and after it, except the segment's neighbours. */
CAMBER_FN void camber_offset_segment_cut(const camber_source_line *c, camber_u32 slot,
                                         const camber_offset_segment *segment, float offset, float *from, float *to) {
    const float d = CAMBER_FABS(offset), near = camber_offset_near(offset), side = offset < 0.0f ? -1.0f : 1.0f;
    camber_neighbour_walks p = camber_neighbour_walks_from(c, slot, slot + 1u, offset);
    while (camber_neighbour_walks_on(c, &p)) {
        const camber_neighbour_walk *way = p.turn ? &p.back : &p.ahead;
        const float ax = way->ax - segment->x, ay = way->ay - segment->y, bx = way->bx - segment->x,
                    by = way->by - segment->y;
        const float ha = d - side * (ay * segment->ux - ax * segment->uy),
                    hb = d - side * (by * segment->ux - bx * segment->uy);
        float lo, hi;
        if ((ha >= near && hb >= near) || (ha <= -near && hb <= -near))
            continue; /* mostly */
        if (!camber_hidden_interval(near, ax * segment->ux + ay * segment->uy, ha, bx * segment->ux + by * segment->uy,
                                    hb, &lo, &hi))
            continue;
        if (lo >= segment->length || hi <= 0.0f)
            continue;
        if (p.turn)
            *from = hi > *from ? hi : *from;
        else
            *to = lo < *to ? lo : *to;
    }
}

/* Clips an arc: as with a segment, the line before hides its beginning. */
CAMBER_FN void camber_offset_arc_cut(const camber_source_line *c, camber_u32 slot, const camber_offset_corner *corner,
                                     const camber_offset_arc *arc, float offset, camber_u32 *first, camber_u32 *end) {
    const float near = camber_offset_near(offset);
    camber_neighbour_walks p = camber_neighbour_walks_from(c, slot, slot, offset);
    while (camber_neighbour_walks_on(c, &p)) {
        const camber_neighbour_walk *way = p.turn ? &p.back : &p.ahead;
        const float ex = way->bx - way->ax, ey = way->by - way->ay, length2 = ex * ex + ey * ey;
        camber_offset_arc at = *arc;
        for (camber_u32 i = 0; i < arc->count; i++) {
            const float px = corner->x - way->ax + at.vx, py = corner->y - way->ay + at.vy;
            const float along = px * ex + py * ey;
            const float t = along <= 0.0f || length2 <= 0.0f ? 0.0f : along >= length2 ? 1.0f : along / length2;
            const float qx = px - ex * t, qy = py - ey * t;
            const camber_u32 hidden = qx * qx + qy * qy < near * near ? 1u : 0u;
            if (hidden && p.turn)
                *first = i + 1u > *first ? i + 1u : *first;
            else if (hidden)
                *end = i < *end ? i : *end;
            camber_offset_arc_step(&at);
        }
    }
}

/* ---- Clips ---- */

/* Clips the segment from a slot to the next. */
CAMBER_FN void camber_offset_clip_segment(const camber_source_line *c, camber_u32 slot, float offset,
                                          camber_offset_clip *clip) {
    const camber_offset_segment segment = camber_offset_segment_at(c, slot);
    float to = segment.length;
    camber_u32 folds = 0;
    float room = 0.0f;
    if (!camber_is_open_end(c->info[slot])) {
        const camber_offset_corner corner = camber_offset_corner_at(c, slot, offset);
        clip->from = corner.inner ? camber_offset_corner_hides(&corner, offset, corner.in) : 0.0f;
        folds = corner.inner && CAMBER_FABS(corner.s) < 0.5f ? 1u : 0u;
        room = camber_offset_corner_overlap(&corner, offset);
    }
    if (!camber_is_open_end(c->info[slot + 1u])) {
        const camber_offset_corner corner = camber_offset_corner_at(c, slot + 1u, offset);
        to = corner.inner ? segment.length - camber_offset_corner_hides(&corner, offset, corner.out) : segment.length;
        folds = folds && corner.inner && CAMBER_FABS(corner.s) < 0.5f ? 1u : 0u;
        room += camber_offset_corner_overlap(&corner, offset);
    }
    /* On the inside of a narrow curve the segment would run backwards. */
    if (folds && room > segment.length)
        to = clip->from;
    if (to > clip->from)
        camber_offset_segment_cut(c, slot, &segment, offset, &clip->from, &to);
    clip->to = to - clip->from > CAMBER_OFFSET_SEGMENT_SHORTEST_PX
                   ? (to >= segment.length ? CAMBER_OFFSET_SEGMENT_WHOLE : to)
                   : -1.0f;
}

/* Clips the arc at a slot. */
CAMBER_FN camber_u32 camber_offset_clip_arc(const camber_source_line *c, camber_u32 slot, camber_offset_row row) {
    const camber_offset_corner corner = camber_offset_corner_at(c, slot, row.offset_px);
    if (corner.inner)
        return 0u;
    const camber_offset_arc arc = camber_offset_arc_of(&corner, row);
    camber_u32 first = 0, end = arc.count;
    if (arc.count > 1u)
        camber_offset_arc_cut(c, slot, &corner, &arc, row.offset_px, &first, &end);
    return end > first ? first | end << 8 | arc.count << 16 : 0u;
}

/* Clips the segment that begins at a slot, and the arc at the slot; a ring's last point leaves the arc to its first. An
 * arc of a single point needs a segment after it. */
CAMBER_FN camber_offset_clip camber_offset_clip_of(const camber_source_line *c, camber_u32 slot) {
    const camber_u32 info = c->info[slot];
    camber_offset_clip clip = {0.0f, -1.0f, 0u};
    if (!(info & CAMBER_POINT_REAL) || camber_is_dot(info))
        return clip;
    const camber_offset_row row = c->offset_rows[info >> CAMBER_POINT_ROW_SHIFT];
    if (!(row.offset_px < 0.0f || row.offset_px > 0.0f) || (info & CAMBER_POINT_LAST))
        return clip;
    camber_offset_clip_segment(c, slot, row.offset_px, &clip);
    if (!camber_is_open_end(info))
        clip.arc = camber_offset_clip_arc(c, slot, row);
    if (!camber_offset_has_segment(clip) && camber_offset_arc_end(clip.arc) - camber_offset_arc_first(clip.arc) < 2u)
        clip.arc = 0u;
    return clip;
}

#endif
