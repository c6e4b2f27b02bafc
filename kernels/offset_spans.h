/* What of a leg and of an arc is left where the line passes nearer to it than the offset: offset.h says the rule. */
#ifndef CAMBER_KERNELS_OFFSET_SPANS_H
#define CAMBER_KERNELS_OFFSET_SPANS_H

#include "offset.h"

/* ---- What is hidden ---- */

/* A walk away from a slot: the segments of the line, cut where they leave its reach. */
typedef struct camber_prowl {
    camber_u32 at, left;
    float x, y, reach;    /* where it began, and how far it goes from there */
    float ax, ay, bx, by; /* the segment */
} camber_prowl;

CAMBER_FN camber_prowl camber_prowl_from(const camber_course *c, camber_u32 slot, float offset) {
    camber_prowl p;
    p.at = slot;
    p.left = CAMBER_OFFSET_SEGMENTS;
    p.x = p.bx = c->x[slot];
    p.y = p.by = c->y[slot];
    p.ax = p.ay = 0.0f;
    p.reach = CAMBER_OFFSET_REACH * CAMBER_FABS(offset);
    return p;
}

/* Goes on by a segment; 0: there is none. */
CAMBER_FN camber_u32 camber_prowl_on(const camber_course *c, camber_prowl *p, camber_u32 back) {
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
    p->bx = p->ax + ex * t;
    p->by = p->ay + ey * t;
    p->left = 0u;
    return 1u;
}

/* Where places of a straight lie nearer than near to a segment, whose ends lie at ax and bx along it and ha and hb
 * below it. */
CAMBER_FN camber_u32 camber_hidden_part(float near, float ax, float ha, float bx, float hb, float *lo, float *hi) {
    *lo = CAMBER_LEG_WHOLE;
    *hi = -CAMBER_LEG_WHOLE;
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

/* What counts as nearer than the offset: rounding does not. */
CAMBER_FN float camber_offset_near(float offset) {
    const float d = CAMBER_FABS(offset);
    const float least = d < 0.5f ? d * (1.0f / 16.0f) : 1.0f / 32.0f, coarse = d * (1.0f / 65536.0f);
    return d - (coarse > least ? coarse : least);
}

/* What a line passes is looked at both ways in turn: of a ring that lies within the reach each way sees half. */
typedef struct camber_prowls {
    camber_prowl back, ahead;
    camber_u32 turn; /* 1: back went last */
} camber_prowls;

CAMBER_FN void camber_prowls_meet(camber_prowls *p) {
    if (p->back.bx == p->ahead.bx && p->back.by == p->ahead.by)
        p->back.left = p->ahead.left = 0u;
}

/* From two slots, past the segments that lie at them. */
CAMBER_FN camber_prowls camber_prowls_from(const camber_course *c, camber_u32 back, camber_u32 ahead, float offset) {
    camber_prowls p;
    p.back = camber_prowl_from(c, back, offset);
    p.ahead = camber_prowl_from(c, ahead, offset);
    p.turn = 0u;
    camber_prowl_on(c, &p.back, 1u);
    camber_prowl_on(c, &p.ahead, 0u);
    camber_prowls_meet(&p);
    return p;
}

/* Goes on by a segment, which is in p->back or p->ahead; 0: there is none. */
CAMBER_FN camber_u32 camber_prowls_on(const camber_course *c, camber_prowls *p) {
    for (camber_u32 i = 0; i < 2u; i++) {
        p->turn = 1u - p->turn;
        if (camber_prowl_on(c, p->turn ? &p->back : &p->ahead, p->turn)) {
            camber_prowls_meet(p);
            return 1u;
        }
    }
    return 0u;
}

/* Cuts a leg by what the line passes before it and behind it, but for the neighbours of the leg. */
CAMBER_FN void camber_leg_cut(const camber_course *c, camber_u32 slot, const camber_leg *leg, float offset, float *from,
                              float *to) {
    const float d = CAMBER_FABS(offset), near = camber_offset_near(offset), side = offset < 0.0f ? -1.0f : 1.0f;
    camber_prowls p = camber_prowls_from(c, slot, slot + 1u, offset);
    while (camber_prowls_on(c, &p)) {
        const camber_prowl *way = p.turn ? &p.back : &p.ahead;
        const float ax = way->ax - leg->x, ay = way->ay - leg->y, bx = way->bx - leg->x, by = way->by - leg->y;
        const float ha = d - side * (ay * leg->ux - ax * leg->uy), hb = d - side * (by * leg->ux - bx * leg->uy);
        float lo, hi;
        if ((ha >= near && hb >= near) || (ha <= -near && hb <= -near))
            continue; /* mostly */
        if (!camber_hidden_part(near, ax * leg->ux + ay * leg->uy, ha, bx * leg->ux + by * leg->uy, hb, &lo, &hi))
            continue;
        if (lo >= leg->length || hi <= 0.0f)
            continue;
        if (p.turn)
            *from = hi > *from ? hi : *from;
        else
            *to = lo < *to ? lo : *to;
    }
}

/* What is left of an arc: as with a leg, what comes before hides its beginning. */
CAMBER_FN void camber_arc_cut(const camber_course *c, camber_u32 slot, const camber_bend *bend, const camber_arc *arc,
                              float offset, camber_u32 *first, camber_u32 *end) {
    const float near = camber_offset_near(offset);
    camber_prowls p = camber_prowls_from(c, slot, slot, offset);
    while (camber_prowls_on(c, &p)) {
        const camber_prowl *way = p.turn ? &p.back : &p.ahead;
        const float ex = way->bx - way->ax, ey = way->by - way->ay, length2 = ex * ex + ey * ey;
        camber_arc at = *arc;
        for (camber_u32 i = 0; i < arc->count; i++) {
            const float px = bend->x + at.vx - way->ax, py = bend->y + at.vy - way->ay;
            const float along = px * ex + py * ey;
            const float t = along <= 0.0f || length2 <= 0.0f ? 0.0f : along >= length2 ? 1.0f : along / length2;
            const float qx = px - ex * t, qy = py - ey * t;
            const camber_u32 hidden = qx * qx + qy * qy < near * near ? 1u : 0u;
            if (hidden && p.turn)
                *first = i + 1u > *first ? i + 1u : *first;
            else if (hidden)
                *end = i < *end ? i : *end;
            camber_arc_step(&at);
        }
    }
}

/* ---- Spans ---- */

/* Of the leg from a slot to the next. */
CAMBER_FN void camber_span_leg(const camber_course *c, camber_u32 slot, float offset, camber_span *span) {
    const camber_leg leg = camber_leg_at(c, slot);
    float to = leg.length;
    camber_u32 folds = 0;
    float room = 0.0f;
    if (!camber_is_open_end(c->info[slot])) {
        const camber_bend bend = camber_bend_at(c, slot, offset);
        span->from = bend.inner ? camber_bend_hides(&bend, offset, bend.in) : 0.0f;
        folds = bend.inner && CAMBER_FABS(bend.s) < 0.5f ? 1u : 0u;
        room = camber_bend_room(&bend, offset);
    }
    if (!camber_is_open_end(c->info[slot + 1u])) {
        const camber_bend bend = camber_bend_at(c, slot + 1u, offset);
        to = bend.inner ? leg.length - camber_bend_hides(&bend, offset, bend.out) : leg.length;
        folds = folds && bend.inner && CAMBER_FABS(bend.s) < 0.5f ? 1u : 0u;
        room += camber_bend_room(&bend, offset);
    }
    /* The inside of a narrow curve: the leg would run backwards. */
    if (folds && room > leg.length)
        to = span->from;
    if (to > span->from)
        camber_leg_cut(c, slot, &leg, offset, &span->from, &to);
    span->to = to - span->from > CAMBER_LEG_SHORTEST_PX ? (to >= leg.length ? CAMBER_LEG_WHOLE : to) : -1.0f;
}

/* Of the arc at a slot. */
CAMBER_FN camber_u32 camber_span_arc(const camber_course *c, camber_u32 slot, camber_shift shift) {
    const camber_bend bend = camber_bend_at(c, slot, shift.offset_px);
    if (bend.inner)
        return 0u;
    const camber_arc arc = camber_arc_of(&bend, shift);
    camber_u32 first = 0, end = arc.count;
    if (arc.count > 1u)
        camber_arc_cut(c, slot, &bend, &arc, shift.offset_px, &first, &end);
    return end > first ? first | end << 8 | arc.count << 16 : 0u;
}

/* What is left at a slot: of the leg that begins there, and of the arc, which a ring's last point leaves to its first.
 * An arc of a single point needs a leg behind it. */
CAMBER_FN camber_span camber_span_of(const camber_course *c, camber_u32 slot) {
    const camber_u32 info = c->info[slot];
    camber_span span = {0.0f, -1.0f, 0u};
    if (!(info & CAMBER_POINT_REAL) || camber_is_dot(info))
        return span;
    const camber_shift shift = c->shifts[info >> CAMBER_POINT_ROW_SHIFT];
    if (!(shift.offset_px < 0.0f || shift.offset_px > 0.0f) || (info & CAMBER_POINT_LAST))
        return span;
    camber_span_leg(c, slot, shift.offset_px, &span);
    if (!camber_is_open_end(info))
        span.arc = camber_span_arc(c, slot, shift);
    if (!camber_span_has_leg(span) && camber_arc_end(span.arc) - camber_arc_first(span.arc) < 2u)
        span.arc = 0u;
    return span;
}

#endif
