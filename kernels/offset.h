/* Offset: the line that lies beside another, the one place where it is decided which points it has.
 *
 *     leg    the segment from a slot to the next, moved aside
 *     bend   where two legs meet: on the outer side an arc about the point, on the inner one where they cross
 *
 *         T0___T1                 outer: points on tangents, so that none lies nearer than the offset;
 *         /       \               the first and the last lie on the legs
 *        /    P----T2---- leg
 *       /    /                        leg ------J   P      inner: J, where both legs have room
 *      leg  /                                    \   \
 *
 * What has no room goes: of a leg, and of an arc, that is left which lies no nearer than the offset to what the line
 * passes within its reach, CAMBER_OFFSET_REACH offsets around the end of the leg. As a capsule is convex, it hides one
 * interval of a leg; the line before hides the leg's beginning up to there, that behind its end. What is left is linked
 * in the order of the line. So a line has no more pieces than it had, and what lies farther along it than its reach
 * does not count: a line that crosses itself is drawn through. */
#ifndef CAMBER_OFFSET_MATHS_H
#define CAMBER_OFFSET_MATHS_H

#include "join.h"

/* Slots whose points a work-item counts and puts. */
#define CAMBER_OFFSET_CHUNK 16
/* How far around a leg's end the line is looked at, in offsets, and how many segments of it at most. */
#define CAMBER_OFFSET_REACH 3.0f
#define CAMBER_OFFSET_SEGMENTS 128u
/* Slots that are passed at most to find a ring's other end, where its seam is looked across. */
#define CAMBER_OFFSET_SEAM 65536u
/* An arc's points lie no farther outside it; it has no more of them. */
#define CAMBER_ARC_TOLERANCE_PX 0.125f
#define CAMBER_ARC_POINTS_MAX 64u
/* What is left of a leg is longer. Pieces that are linked are so by one point where they end closer. */
#define CAMBER_LEG_SHORTEST_PX (1.0f / 1024.0f)
#define CAMBER_OFFSET_GAP_PX 0.25f
/* Legs that are cut may end so far from where they cross. */
#define CAMBER_OFFSET_SLACK_PX 1.0f
/* Of a leg that is not cut at its end. */
#define CAMBER_LEG_WHOLE 1.0e30f

/* What of a row an offset needs. */
typedef struct camber_shift {
    float offset_px; /* to the right, as seen with y down */
    float miter_limit;
    camber_u32 join; /* camber_join */
    camber_u32 spare;
} camber_shift;

/* What is left of the leg that begins at a slot, px along it, and of the arc there. */
typedef struct camber_span {
    float from, to; /* nothing where to is not above from */
    camber_u32 arc; /* its first point | the one behind its last << 8 | how many it would have << 16 */
} camber_span;

/* Lines as classify would read them, and what is known of them. */
typedef struct camber_course {
    CAMBER_GLOBAL const float *x, *y;
    CAMBER_GLOBAL const camber_u32 *info;
    CAMBER_GLOBAL const camber_shift *shifts;
    CAMBER_GLOBAL const camber_span *spans;
    CAMBER_GLOBAL const float *measures; /* camber_measure of each slot. NULL: not measured */
    camber_u32 slots;
} camber_course;

/* ---- Slots along a line ---- */

/* The other end of a ring, which is somewhere behind its first slot or before its last; 0: not found. */
CAMBER_FN camber_u32 camber_seam_last(const camber_course *c, camber_u32 first, camber_u32 most) {
    const camber_u32 wanted = CAMBER_POINT_LAST | CAMBER_POINT_RING;
    const camber_u32 end = c->slots - first > most ? first + most : c->slots;
    camber_u32 i = first;
    while (i <= end && (c->info[i] & wanted) != wanted)
        i++;
    return i <= end ? i : 0u;
}

CAMBER_FN camber_u32 camber_seam_first(const camber_course *c, camber_u32 last, camber_u32 most) {
    const camber_u32 wanted = CAMBER_POINT_FIRST | CAMBER_POINT_RING;
    const camber_u32 end = last > most ? last - most : 1u;
    camber_u32 i = last;
    while (i >= end && (c->info[i] & wanted) != wanted)
        i--;
    return i >= end ? i : 0u;
}

/* The slot before along the line, past a ring's seam; 0: none. */
CAMBER_FN camber_u32 camber_slot_before(const camber_course *c, camber_u32 at, camber_u32 most) {
    if (!(c->info[at] & CAMBER_POINT_FIRST))
        return at - 1u;
    const camber_u32 last = c->info[at] & CAMBER_POINT_RING ? camber_seam_last(c, at, most) : 0u;
    return last && !(c->info[last] & CAMBER_POINT_FIRST) ? last - 1u : 0u;
}

CAMBER_FN camber_u32 camber_slot_behind(const camber_course *c, camber_u32 at, camber_u32 most) {
    if (!(c->info[at] & CAMBER_POINT_LAST))
        return at + 1u;
    const camber_u32 first = c->info[at] & CAMBER_POINT_RING ? camber_seam_first(c, at, most) : 0u;
    return first && !(c->info[first] & CAMBER_POINT_LAST) ? first + 1u : 0u;
}

CAMBER_FN camber_u32 camber_is_dot(camber_u32 info) {
    const camber_u32 ends = CAMBER_POINT_FIRST | CAMBER_POINT_LAST;
    return (info & ends) == ends ? 1u : 0u;
}

CAMBER_FN camber_u32 camber_is_open_end(camber_u32 info) {
    return (info & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST)) && !(info & CAMBER_POINT_RING) ? 1u : 0u;
}

/* ---- Legs ---- */

typedef struct camber_leg {
    float x, y; /* of its begin, px; not moved */
    float ux, uy, length;
} camber_leg;

CAMBER_FN camber_leg camber_leg_at(const camber_course *c, camber_u32 slot) {
    camber_leg leg;
    leg.x = c->x[slot];
    leg.y = c->y[slot];
    const float dx = c->x[slot + 1u] - leg.x, dy = c->y[slot + 1u] - leg.y;
    leg.length = CAMBER_SQRT(dx * dx + dy * dy);
    leg.ux = dx / leg.length;
    leg.uy = dy / leg.length;
    return leg;
}

CAMBER_FN float camber_leg_x(const camber_leg *leg, float offset, float along) {
    return leg->x + leg->ux * along - leg->uy * offset;
}

CAMBER_FN float camber_leg_y(const camber_leg *leg, float offset, float along) {
    return leg->y + leg->uy * along + leg->ux * offset;
}

CAMBER_FN camber_u32 camber_span_has_leg(camber_span span) {
    return span.to > span.from ? 1u : 0u;
}

/* ---- Bends ---- */

typedef struct camber_bend {
    float c, s;    /* cosine and sine of half the turn that the offset makes, positive from x to y */
    float in, out; /* lengths of the legs */
    float ix, iy;  /* direction of the one that comes in */
    float x, y;    /* px */
    camber_u32 inner;
} camber_bend;

/* Of a slot that has neighbours. Legs that lie on each other, as of a way to a dead end and back, are gone around on
 * either side. */
CAMBER_FN camber_bend camber_bend_at(const camber_course *c, camber_u32 slot, float offset) {
    const float x = c->x[slot], y = c->y[slot];
    const float dx = x - c->x[slot - 1u], dy = y - c->y[slot - 1u];
    const float ex = c->x[slot + 1u] - x, ey = c->y[slot + 1u] - y;
    const camber_turn turn = camber_turn_between(dx, dy, ex, ey);
    const float reach = CAMBER_OFFSET_REACH * CAMBER_FABS(offset);
    camber_bend bend;
    bend.x = x;
    bend.y = y;
    bend.c = turn.c;
    bend.s = turn.s;
    bend.in = CAMBER_SQRT(dx * dx + dy * dy);
    bend.out = CAMBER_SQRT(ex * ex + ey * ey);
    bend.ix = dx / bend.in;
    bend.iy = dy / bend.in;
    const float shorter = 2.0f * turn.half_shorter < reach ? 2.0f * turn.half_shorter : reach;
    const float aside = CAMBER_FABS(2.0f * turn.s * turn.c);
    const camber_u32 folds = turn.dot < 0.0f && aside < 0.05f && aside * shorter < 0.25f ? 1u : 0u;
    bend.inner = offset * turn.s > 0.0f ? 1u : 0u;
    if (folds && bend.inner) {
        bend.c = -turn.c;
        bend.s = -turn.s;
        bend.inner = 0u;
    }
    return bend;
}

/* How far along both legs the place lies where they cross. */
CAMBER_FN float camber_bend_room(const camber_bend *bend, float offset) {
    const float c = bend->c > 1.0e-6f ? bend->c : 1.0e-6f;
    return CAMBER_FABS(offset * bend->s) / c;
}

/* How much of a leg its neighbour over an inner bend hides. That may be too short to reach where both cross: then it is
 * the disc about its other end that does. */
CAMBER_FN float camber_bend_hides(const camber_bend *bend, float offset, float neighbour) {
    const float d = CAMBER_FABS(offset), reach = CAMBER_OFFSET_REACH * d;
    const float length = neighbour < reach ? neighbour : reach, room = camber_bend_room(bend, offset);
    if (room <= length)
        return room;
    const float aside = length * CAMBER_FABS(2.0f * bend->s * bend->c);
    const float rest = aside * (2.0f * d - aside);
    const float hidden = CAMBER_SQRT(rest > 0.0f ? rest : 0.0f) - length * (bend->c * bend->c - bend->s * bend->s);
    return hidden > 0.0f ? hidden : 0.0f;
}

/* An arc: where its next point lies from the bend, and the turn to the one behind. */
typedef struct camber_arc {
    float vx, vy;
    float c, s;
    camber_u32 count;
} camber_arc;

CAMBER_FN void camber_arc_step(camber_arc *arc) {
    const float vx = arc->vx * arc->c - arc->vy * arc->s;
    arc->vy = arc->vx * arc->s + arc->vy * arc->c;
    arc->vx = vx;
}

/* Of an outer bend; none of a bevel. One point is the tip. */
CAMBER_FN camber_arc camber_arc_of(const camber_bend *bend, camber_shift shift) {
    const float d = CAMBER_FABS(shift.offset_px);
    float c = bend->c, s = bend->s;
    camber_arc arc = {0.0f, 0.0f, 1.0f, 0.0f, 1u};
    const camber_u32 gentle = d * (1.0f - c) <= CAMBER_ARC_TOLERANCE_PX * c ? 1u : 0u;
    if (!gentle && shift.join != 0u)
        arc.count = shift.join == 1u && c * shift.miter_limit >= 1.0f ? 1u : 0u;
    if (shift.join == 0u)
        while (d * (1.0f - c) > CAMBER_ARC_TOLERANCE_PX * c && arc.count < CAMBER_ARC_POINTS_MAX) {
            const float cosine = CAMBER_SQRT(0.5f + 0.5f * c);
            s = 0.5f * s / cosine;
            c = cosine;
            arc.count *= 2u;
        }
    if (arc.count == 0u)
        return arc;
    const float nx = -bend->iy * shift.offset_px / c, ny = bend->ix * shift.offset_px / c;
    arc.vx = nx * c - ny * s;
    arc.vy = nx * s + ny * c;
    arc.c = c * c - s * s;
    arc.s = 2.0f * s * c;
    return arc;
}

CAMBER_FN camber_u32 camber_arc_first(camber_u32 word) {
    return word & 255u;
}

CAMBER_FN camber_u32 camber_arc_end(camber_u32 word) {
    return word >> 8 & 255u;
}

CAMBER_FN camber_u32 camber_arc_count(camber_u32 word) {
    return word >> 16;
}

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

/* ---- Pieces: what is left, in the order of the line ---- */

#define CAMBER_PIECE_NONE 0u
#define CAMBER_PIECE_LEG 1u
#define CAMBER_PIECE_ARC 2u

typedef struct camber_piece {
    camber_u32 kind, slot;
    camber_u32 steps; /* slots back */
    camber_u32 seam;  /* 1: a ring's seam lies between */
} camber_piece;

/* An arc that is one point, the tip, is there where both its legs reach it. */
CAMBER_FN camber_u32 camber_has_arc(const camber_course *c, camber_u32 slot) {
    const camber_span span = c->spans[slot];
    if (camber_arc_count(span.arc) != 1u)
        return camber_arc_end(span.arc) > camber_arc_first(span.arc) ? 1u : 0u;
    const camber_u32 before = camber_slot_before(c, slot, c->slots);
    return before && camber_span_has_leg(span) && span.from <= 0.0f && c->spans[before].to >= CAMBER_LEG_WHOLE ? 1u
                                                                                                               : 0u;
}

/* The last piece before a slot's own. */
CAMBER_FN camber_piece camber_piece_before(const camber_course *c, camber_u32 slot) {
    camber_piece piece = {CAMBER_PIECE_NONE, slot, 0u, 0u};
    camber_u32 around = c->info[slot] & CAMBER_POINT_LAST ? 1u : 0u; /* all of a ring has been seen at its seam */
    for (;;) {
        const camber_u32 begins = c->info[piece.slot] & CAMBER_POINT_FIRST ? 1u : 0u;
        if (begins && around)
            return piece;
        around |= begins;
        piece.seam |= begins;
        piece.slot = camber_slot_before(c, piece.slot, c->slots);
        piece.steps++;
        if (piece.slot == 0u || piece.slot == slot)
            return piece;
        if (camber_span_has_leg(c->spans[piece.slot]))
            piece.kind = CAMBER_PIECE_LEG;
        else if (camber_has_arc(c, piece.slot))
            piece.kind = CAMBER_PIECE_ARC;
        if (piece.kind != CAMBER_PIECE_NONE)
            return piece;
    }
}

/* ---- Points ---- */

/* Takes points, and remembers the first two and the last. */
typedef struct camber_pen {
    CAMBER_GLOBAL float *x, *y;
    CAMBER_GLOBAL camber_u32 *info;
    CAMBER_GLOBAL float *measures;
    camber_u32 puts;        /* 0: points are counted, 1: and put */
    camber_u32 at;          /* the next slot */
    camber_u32 word, flags; /* of the next point; flags are for one */
    camber_u32 count;
    float x0, y0, x1, y1, last_x, last_y;
    float total;
} camber_pen;

CAMBER_FN void camber_pen_slot(camber_pen *pen, float x, float y, camber_u32 info, float along) {
    if (pen->puts) {
        pen->x[pen->at] = x;
        pen->y[pen->at] = y;
        pen->info[pen->at] = info;
        if (pen->measures) {
            pen->measures[2u * (pen->at - 1u)] = info ? along : 0.0f;
            pen->measures[2u * (pen->at - 1u) + 1u] = info ? pen->total : 0.0f;
        }
    }
    pen->at++;
}

CAMBER_FN void camber_pen_point(camber_pen *pen, float x, float y, float along) {
    camber_pen_slot(pen, x, y, pen->word | pen->flags, along);
    pen->flags = 0u;
    if (pen->count == 0u) {
        pen->x0 = x;
        pen->y0 = y;
    } else if (pen->count == 1u) {
        pen->x1 = x;
        pen->y1 = y;
    }
    pen->last_x = x;
    pen->last_y = y;
    pen->count++;
}

CAMBER_FN float camber_along_slot(const camber_course *c, camber_u32 slot) {
    return c->measures ? c->measures[2u * (slot - 1u)] : 0.0f;
}

CAMBER_FN float camber_along_leg(const camber_course *c, camber_u32 slot, const camber_leg *leg, float along) {
    const float from = camber_along_slot(c, slot), to = camber_along_slot(c, slot + 1u);
    return from + (to - from) * (along / leg->length);
}

/* Where a piece ends. */
typedef struct camber_place {
    float x, y, along;
} camber_place;

CAMBER_FN camber_place camber_piece_end(const camber_course *c, camber_piece piece, camber_shift shift) {
    camber_place place;
    const camber_span span = c->spans[piece.slot];
    if (piece.kind == CAMBER_PIECE_LEG) {
        const camber_leg leg = camber_leg_at(c, piece.slot);
        const float to = span.to < leg.length ? span.to : leg.length;
        place.x = camber_leg_x(&leg, shift.offset_px, to);
        place.y = camber_leg_y(&leg, shift.offset_px, to);
        place.along = camber_along_leg(c, piece.slot, &leg, to);
        return place;
    }
    const camber_bend bend = camber_bend_at(c, piece.slot, shift.offset_px);
    camber_arc arc = camber_arc_of(&bend, shift);
    for (camber_u32 i = 1; i < camber_arc_end(span.arc); i++)
        camber_arc_step(&arc);
    place.x = bend.x + arc.vx;
    place.y = bend.y + arc.vy;
    place.along = camber_along_slot(c, piece.slot);
    return place;
}

CAMBER_FN camber_u32 camber_is_close(camber_place place, float x, float y) {
    const float dx = x - place.x, dy = y - place.y;
    return dx * dx + dy * dy <= CAMBER_OFFSET_GAP_PX * CAMBER_OFFSET_GAP_PX ? 1u : 0u;
}

CAMBER_FN void camber_put_end(const camber_course *c, camber_piece piece, camber_shift shift, camber_pen *pen) {
    const camber_place place = camber_piece_end(c, piece, shift);
    camber_pen_point(pen, place.x, place.y, place.along);
}

/* What is left of an arc, but for its last point, which what follows puts. */
CAMBER_FN void camber_put_arc(const camber_course *c, camber_piece before, camber_u32 slot, camber_shift shift,
                              camber_pen *pen) {
    const camber_span span = c->spans[slot];
    const camber_bend bend = camber_bend_at(c, slot, shift.offset_px);
    camber_arc arc = camber_arc_of(&bend, shift);
    const camber_u32 joins = before.kind == CAMBER_PIECE_LEG && before.steps == 1u && camber_arc_first(span.arc) == 0u;
    const camber_u32 goes_on = joins && c->spans[before.slot].to >= CAMBER_LEG_WHOLE ? 1u : 0u;
    for (camber_u32 i = 0; i < camber_arc_end(span.arc); i++) {
        const float x = bend.x + arc.vx, y = bend.y + arc.vy;
        if (i == camber_arc_first(span.arc) && before.kind != CAMBER_PIECE_NONE && !goes_on) {
            const camber_place end = camber_piece_end(c, before, shift);
            if (!camber_is_close(end, x, y))
                camber_pen_point(pen, end.x, end.y, end.along);
        }
        if (i >= camber_arc_first(span.arc) && i + 1u < camber_arc_end(span.arc))
            camber_pen_point(pen, x, y, camber_along_slot(c, slot));
        camber_arc_step(&arc);
    }
}

/* Whether legs end about where they cross, and each keeps the half that lies away from there. */
CAMBER_FN camber_u32 camber_crossing_holds(float p, float q, camber_span a, float a_length, camber_span b,
                                           float b_length) {
    const float a_to = a.to < a_length ? a.to : a_length, b_to = b.to < b_length ? b.to : b_length;
    return CAMBER_FABS(p - a_to) <= CAMBER_OFFSET_SLACK_PX && CAMBER_FABS(q - b.from) <= CAMBER_OFFSET_SLACK_PX &&
                   p > 0.5f * (a.from + a_to) && q < 0.5f * (b.from + b_to)
               ? 1u
               : 0u;
}

/* Links a leg to one behind it: by the place where they cross, else by both ends. */
CAMBER_FN void camber_put_crossing(const camber_course *c, camber_piece before, camber_u32 slot, const camber_leg *leg,
                                   camber_shift shift, camber_pen *pen) {
    const camber_leg other = camber_leg_at(c, before.slot);
    const camber_span a = c->spans[before.slot], b = c->spans[slot];
    const float offset = shift.offset_px, d = CAMBER_FABS(offset);
    if (before.steps == 1u) {
        const camber_bend bend = camber_bend_at(c, slot, offset);
        const float room = camber_bend_room(&bend, offset);
        if (bend.inner && room <= CAMBER_OFFSET_REACH * d &&
            camber_crossing_holds(other.length - room, room, a, other.length, b, leg->length)) {
            const float nx = -bend.iy * offset / bend.c, ny = bend.ix * offset / bend.c;
            camber_pen_point(pen, bend.x + (nx * bend.c - ny * bend.s), bend.y + (nx * bend.s + ny * bend.c),
                             camber_along_slot(c, slot));
            return;
        }
    }
    const float aside = other.ux * leg->uy - other.uy * leg->ux;
    const float wx = camber_leg_x(leg, offset, 0.0f) - camber_leg_x(&other, offset, 0.0f);
    const float wy = camber_leg_y(leg, offset, 0.0f) - camber_leg_y(&other, offset, 0.0f);
    const float safe = CAMBER_FABS(aside) > 1.0e-3f ? aside : 1.0f;
    const float p = (wx * leg->uy - wy * leg->ux) / safe, q = (wx * other.uy - wy * other.ux) / safe;
    if (CAMBER_FABS(aside) > 1.0e-3f && camber_crossing_holds(p, q, a, other.length, b, leg->length)) {
        const float along = camber_along_leg(c, before.slot, &other, p);
        camber_pen_point(pen, camber_leg_x(leg, offset, q), camber_leg_y(leg, offset, q),
                         0.5f * (along + camber_along_leg(c, slot, leg, q)));
        return;
    }
    const camber_place end = camber_piece_end(c, before, shift);
    const float x = camber_leg_x(leg, offset, b.from), y = camber_leg_y(leg, offset, b.from);
    if (!camber_is_close(end, x, y))
        camber_pen_point(pen, end.x, end.y, end.along);
    camber_pen_point(pen, x, y, camber_along_leg(c, slot, leg, b.from));
}

CAMBER_FN void camber_put_leg(const camber_course *c, camber_piece before, camber_u32 slot, camber_shift shift,
                              camber_pen *pen) {
    const camber_leg leg = camber_leg_at(c, slot);
    const camber_span span = c->spans[slot];
    if (before.kind == CAMBER_PIECE_LEG) {
        camber_put_crossing(c, before, slot, &leg, shift, pen);
        return;
    }
    const camber_span arc = c->spans[before.slot];
    const camber_u32 joins = before.kind == CAMBER_PIECE_ARC && before.slot == slot && span.from <= 0.0f &&
                                     camber_arc_end(arc.arc) == camber_arc_count(arc.arc)
                                 ? 1u
                                 : 0u;
    const float x = camber_leg_x(&leg, shift.offset_px, span.from), y = camber_leg_y(&leg, shift.offset_px, span.from);
    if (before.kind == CAMBER_PIECE_ARC) {
        const camber_place end = camber_piece_end(c, before, shift);
        if (joins || !camber_is_close(end, x, y))
            camber_pen_point(pen, end.x, end.y, end.along);
        if (joins)
            return;
    }
    camber_pen_point(pen, x, y, camber_along_leg(c, slot, &leg, span.from));
}

/* The points that a slot's arc and leg make, linked to the piece before: none, or one at least. */
CAMBER_FN void camber_put_pieces(const camber_course *c, camber_piece before, camber_u32 slot, camber_shift shift,
                                 camber_pen *pen) {
    if (camber_has_arc(c, slot)) {
        camber_put_arc(c, before, slot, shift, pen);
        before.kind = CAMBER_PIECE_ARC;
        before.slot = slot;
        before.steps = 0u;
    }
    if (camber_span_has_leg(c->spans[slot]))
        camber_put_leg(c, before, slot, shift, pen);
}

CAMBER_FN camber_u32 camber_has_pieces(const camber_course *c, camber_u32 slot) {
    return camber_span_has_leg(c->spans[slot]) || camber_has_arc(c, slot) ? 1u : 0u;
}

CAMBER_FN camber_pen camber_pen_counting(void) {
    camber_pen pen = {0};
    return pen;
}

/* The last point of a line: the end of its last piece, or, where that is linked to a ring's first over the seam, the
 * first point again, and a ghost of the second. */
CAMBER_FN void camber_put_last(const camber_course *c, camber_piece before, camber_u32 slot, camber_shift shift,
                               camber_pen *pen) {
    const camber_u32 first = c->info[slot] & CAMBER_POINT_RING ? camber_seam_first(c, slot, c->slots) : 0u;
    camber_pen begin = camber_pen_counting();
    camber_u32 at = first;
    for (; at && begin.count < 2u && at != slot; at++) {
        if (camber_has_pieces(c, at)) {
            const camber_piece linked = camber_piece_before(c, at);
            if (begin.count == 0u && linked.kind == CAMBER_PIECE_NONE)
                break;
            camber_put_pieces(c, linked, at, shift, &begin);
        }
        if (c->info[at] & CAMBER_POINT_LAST) {
            if (begin.count == 1u)
                camber_put_end(c, camber_piece_before(c, at), shift, &begin);
            break;
        }
    }
    if (begin.count == 0u) {
        pen->flags |= CAMBER_POINT_LAST;
        camber_put_end(c, before, shift, pen);
        return;
    }
    pen->flags |= CAMBER_POINT_LAST | CAMBER_POINT_RING;
    camber_pen_point(pen, begin.x0, begin.y0, camber_along_slot(c, slot));
    camber_pen_slot(pen, begin.count > 1u ? begin.x1 : begin.x0, begin.count > 1u ? begin.y1 : begin.y0, 0u, 0.0f);
}

/* A slot of a line without offset stays as it is. */
CAMBER_FN void camber_put_same(const camber_course *c, camber_u32 slot, camber_pen *pen) {
    const camber_u32 info = c->info[slot], ring = info & CAMBER_POINT_RING;
    if (ring && (info & CAMBER_POINT_FIRST))
        camber_pen_slot(pen, c->x[slot - 1u], c->y[slot - 1u], 0u, 0.0f);
    camber_pen_slot(pen, c->x[slot], c->y[slot], info, camber_along_slot(c, slot));
    if (ring && (info & CAMBER_POINT_LAST))
        camber_pen_slot(pen, c->x[slot + 1u], c->y[slot + 1u], 0u, 0.0f);
}

/* The slots that are made of one: its own points, a ring's ghosts, a line's last point. */
CAMBER_FN void camber_put_beside(const camber_course *c, camber_u32 slot, camber_pen *pen) {
    const camber_u32 info = c->info[slot];
    if (!(info & CAMBER_POINT_REAL))
        return;
    const camber_shift shift = c->shifts[info >> CAMBER_POINT_ROW_SHIFT];
    pen->total = c->measures ? c->measures[2u * (slot - 1u) + 1u] : 0.0f;
    if (!(shift.offset_px < 0.0f || shift.offset_px > 0.0f) || camber_is_dot(info)) {
        camber_put_same(c, slot, pen);
        return;
    }
    const camber_u32 last = info & CAMBER_POINT_LAST;
    if (!last && !camber_has_pieces(c, slot))
        return;
    const camber_piece before = camber_piece_before(c, slot);
    pen->word = (info & CAMBER_ROW_BITS) | CAMBER_POINT_REAL;
    if (last) {
        if (before.kind != CAMBER_PIECE_NONE)
            camber_put_last(c, before, slot, shift, pen);
        return;
    }
    if (before.kind == CAMBER_PIECE_NONE)
        pen->flags = CAMBER_POINT_FIRST;
    if (before.kind != CAMBER_PIECE_NONE && before.seam) {
        camber_pen end = camber_pen_counting();
        camber_put_pieces(c, camber_piece_before(c, before.slot), before.slot, shift, &end);
        camber_pen_slot(pen, end.last_x, end.last_y, 0u, 0.0f);
        pen->flags = CAMBER_POINT_FIRST | CAMBER_POINT_RING;
    }
    camber_put_pieces(c, before, slot, shift, pen);
}

#ifdef __OPENCL_VERSION__
typedef char camber_shift_is_16_bytes[sizeof(camber_shift) == 16 ? 1 : -1];
typedef char camber_span_is_12_bytes[sizeof(camber_span) == 12 ? 1 : -1];
#else
_Static_assert(sizeof(camber_shift) == 16, "the device reads shifts of 16 bytes");
_Static_assert(sizeof(camber_span) == 12, "the device writes spans of 12 bytes");
#endif

#endif
