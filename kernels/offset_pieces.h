/* The points of what is left of a line beside another, in the order of the line. */
#ifndef CAMBER_KERNELS_OFFSET_PIECES_H
#define CAMBER_KERNELS_OFFSET_PIECES_H

#include "offset_spans.h"

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

#endif
