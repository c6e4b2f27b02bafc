/* Join maths, the one place where a formula of a join stands. Only + - * / sqrt, each correctly rounded, so that
 * device and twin agree to the last bit where the device rounds correctly.
 *
 * u and w are the directions into and out of a point, t the angle from u to w, positive from x to y. The half
 * turn's cosine c and sine s give all that a join needs:
 *
 *     tan(t/2) = s / c          how far along u the bisector cuts the edge
 *     tan(t/4) = s / (1 + c)    in -1 to 1 for every turn: what is stored, as 16 bits
 *     1 / c                     the miter length over the width
 */
#ifndef CAMBER_JOIN_MATHS_H
#define CAMBER_JOIN_MATHS_H

#include "layout.h"

typedef struct camber_turn {
    float c, s;         /* cosine (>= 0) and sine (signed) of half the turn */
    float dot;          /* cosine of the turn */
    float half_shorter; /* half the shorter of the two segments, px */
} camber_turn;

/* Half the shorter of the segments into (dx, dy) and out of (ex, ey) a point, px. */
CAMBER_FN float camber_half_shorter(float dx, float dy, float ex, float ey) {
    const float d2 = dx * dx + dy * dy, e2 = ex * ex + ey * ey;
    return 0.5f * CAMBER_SQRT(d2 < e2 ? d2 : e2);
}

/* The turn between them. The product of the lengths comes from (d.e)^2 + (d x e)^2 = |d|^2 |e|^2: one root and one
 * division serve both. Below 1e-9 px by 1e-9 px it counts as that; at the longest, 3e9 px, it still fits a float. */
CAMBER_FN camber_turn camber_turn_between(float dx, float dy, float ex, float ey) {
    const float along = dx * ex + dy * ey, aside = dx * ey - dy * ex;
    const float product = along * along + aside * aside; /* of the squared lengths */
    const float scale = 1.0f / CAMBER_SQRT(product > 1e-36f ? product : 1e-36f);
    const float dot = along * scale, cross = aside * scale;
    /* Of c and s the larger comes from a root that loses nothing, the smaller from cross = 2 s c. */
    const float larger = CAMBER_SQRT(0.5f + 0.5f * CAMBER_FABS(dot));
    const float smaller = 0.5f * cross / larger;
    camber_turn turn;
    turn.dot = dot;
    turn.c = dot >= 0.0f ? larger : CAMBER_FABS(smaller);
    turn.s = dot >= 0.0f ? smaller : (cross < 0.0f ? -larger : larger);
    turn.half_shorter = camber_half_shorter(dx, dy, ex, ey);
    return turn;
}

/* tan(t/4) as 16 bits. Never 0, which marks a cap: a straight join turns by 0.007 degrees. */
CAMBER_FN camber_u32 camber_turn_pack(camber_turn turn) {
    const float q = turn.s / (1.0f + turn.c) * 32767.0f;
    const float rounded = q + (q < 0.0f ? -0.5f : 0.5f);
    const camber_i32 turns = (camber_i32)(rounded > 32767.0f ? 32767.0f : rounded < -32767.0f ? -32767.0f : rounded);
    return turns == 0 ? 1u : (camber_u32)turns & 0xffffu;
}

CAMBER_FN float camber_turn_unpack(camber_u32 join) {
    const camber_i32 q = (camber_i32)(join & 0xffffu);
    return (float)(q >= 32768 ? q - 65536 : q) * (1.0f / 32767.0f);
}

/* tan(t/2) from q = tan(t/4). Large, not infinite, at a full reversal. */
CAMBER_FN float camber_turn_tan_half(float q) {
    const float below = 1.0f - q * q;
    return 2.0f * q / (below > 1e-6f ? below : 1e-6f);
}

CAMBER_FN camber_u32 camber_join_kind(camber_u32 join) {
    return join >> CAMBER_JOIN_KIND_SHIFT;
}

CAMBER_FN camber_u32 camber_join_end(camber_u32 join) {
    return join >> CAMBER_JOIN_END_SHIFT & 7u;
}

/* Whether the line begins with the segment before A, or ends with that behind B, as bits 7 and 8 of a vertex's flags:
 * from the join words of a point before A, of A and B, and of a point behind B. Before a ring A is a ghost, and the
 * point before it is another polyline's. */
CAMBER_FN camber_u32 camber_line_ends(camber_u32 before, camber_u32 a, camber_u32 b, camber_u32 behind) {
    const camber_u32 begins =
        camber_join_kind(before) == CAMBER_KIND_CAP && camber_join_kind(a) > CAMBER_KIND_CAP ? 128u : 0u;
    const camber_u32 ends =
        camber_join_kind(behind) == CAMBER_KIND_CAP && camber_join_kind(b) != CAMBER_KIND_CAP ? 256u : 0u;
    return begins | ends;
}

CAMBER_FN camber_u32 camber_join_triangles(camber_u32 join) {
    return join >> CAMBER_JOIN_TRIANGLES_SHIFT & 127u;
}

/* camber_end past a cap: round 0, butt 1, square 2. */
CAMBER_FN camber_u32 camber_cap_end(camber_u32 cap) {
    return cap == 1u ? 0u : cap == 2u ? 2u : 1u;
}

/* Triangles of a round join as a fan: steps of the row's angle until they pass the turn. cos falls from 0 to
 * half a circle, so comparing cosines compares angles. */
CAMBER_FN camber_u32 camber_fan_triangles(float turn_cos, float step_cos, float step_sin) {
    float x = step_cos, y = step_sin;
    camber_u32 n = 1;
    while (n < CAMBER_JOIN_TRIANGLES_MAX && x > turn_cos && y > 0.0f) {
        const float next = x * step_cos - y * step_sin;
        y = x * step_sin + y * step_cos;
        x = next;
        n++;
    }
    return n;
}

/* The join word of a point where two segments meet.
 *
 *     cut: each segment's quad ends on the bisector M-C       tight: the inner side has no room, each quad keeps
 *     and holds its own part of the join                      its own M. Ma-C misses P: the fragment shader cuts
 *                                                             at P and the bisector what lies past them
 *
 *        ______________ C                                        ______________ C
 *        in            /|                                        in            /|
 *        -------------P |                                        -------------P |
 *        ____________/  |                                        _________Ma Mb_|
 *                   M   |                                                  |out|
 *                   |out|
 *
 *     split: past |tan(t/2)| = 2 (127 degrees) C runs away; both end past P, and the fragment shader gives each
 *     its side of the bisector
 */
CAMBER_FN camber_u32 camber_join_word(camber_turn turn, CAMBER_GLOBAL const camber_row *row, camber_u32 method) {
    const float sine = CAMBER_FABS(turn.s);
    const camber_u32 miter = row->join == 1u && turn.c * row->miter_limit >= 1.0f;
    const camber_u32 bevel = row->join != 0u && !miter;
    const camber_u32 split = !miter && sine > 2.0f * turn.c;
    const camber_u32 tight = row->reach_px * sine > turn.half_shorter * turn.c;
    camber_u32 end = miter ? 3u : bevel ? 4u : 0u;
    camber_u32 triangles = 0;
    if (method == CAMBER_STRIP) {
        end = split || tight ? (miter ? 7u : bevel ? 6u : 5u) : end;
    } else if (sine > 0.0f) {
        /* Past 120 degrees the kite's tip runs away: two kites of half the angle. */
        const camber_u32 kites = !miter && sine > 1.7320508f * turn.c ? 4u : 2u;
        triangles = method == CAMBER_FAN && row->join == 0u ? camber_fan_triangles(turn.dot, row->fan_cos, row->fan_sin)
                                                            : kites;
    }
    const camber_u32 kind = split ? CAMBER_KIND_SPLIT : tight ? CAMBER_KIND_TIGHT : CAMBER_KIND_CUT;
    return camber_turn_pack(turn) | kind << CAMBER_JOIN_KIND_SHIFT | end << CAMBER_JOIN_END_SHIFT |
           triangles << CAMBER_JOIN_TRIANGLES_SHIFT;
}

/* The join word of an end of an open polyline, or of a dot. */
CAMBER_FN camber_u32 camber_cap_word(camber_u32 cap, camber_u32 dot) {
    const camber_u32 kind = !dot ? CAMBER_KIND_CAP : cap == 0u ? CAMBER_KIND_GHOST : CAMBER_KIND_DOT;
    return kind << CAMBER_JOIN_KIND_SHIFT | camber_cap_end(cap) << CAMBER_JOIN_END_SHIFT;
}

/* How far along its segment an edge vertex lies, in units of the reach. end: +1 at the segment's end, -1 at its start;
 * side: +1 or -1. Floats and no struct: two of them returned together are a float2 to the device's compiler, which then
 * does not vectorise. */
CAMBER_FN float camber_edge_along(camber_u32 join, float end, float side, camber_u32 method) {
    const camber_u32 kind = camber_join_kind(join);
    const float q = camber_turn_unpack(join);
    const float cut = -end * side * camber_turn_tan_half(q);
    const camber_u32 is_cut = kind == CAMBER_KIND_CUT || kind == CAMBER_KIND_TIGHT;
    if (method == CAMBER_STRIP)
        return is_cut ? cut : end;
    if (method == CAMBER_KITE && is_cut && side * q > 0.0f)
        return cut;
    return kind < CAMBER_KIND_CUT ? end : 0.0f;
}

/* The bound on that, px: past a butt end the pad, however wide the line; on the inner side of a tight join half the
 * shorter segment, and the pad at most, since what it gives up the other segment may be too short to cover. */
CAMBER_FN float camber_edge_limit(camber_u32 join, float half_shorter, float side) {
    const camber_u32 kind = camber_join_kind(join);
    const camber_u32 is_butt = kind < CAMBER_KIND_CUT && camber_join_end(join) == 1u;
    const camber_u32 is_inner = kind == CAMBER_KIND_TIGHT && side * camber_turn_unpack(join) > 0.0f;
    const float inner = half_shorter < CAMBER_PAD_PX ? half_shorter : CAMBER_PAD_PX;
    return is_butt ? CAMBER_PAD_PX : is_inner ? inner : CAMBER_NO_LIMIT_PX;
}

/* Whether a strip breaks at a point, which then has two pairs of vertices: inside a polyline at any join but a plain
 * cut. A dot breaks too: it has two pairs. */
CAMBER_FN camber_u32 camber_strip_breaks(camber_u32 kind, camber_u32 info) {
    const camber_u32 inner = info & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST) ? 0u : 1u;
    const camber_u32 uncut = kind == CAMBER_KIND_TIGHT || kind == CAMBER_KIND_SPLIT ? inner : 0u;
    return kind == CAMBER_KIND_DOT ? 1u : uncut;
}

/* How many vertices and indices a point emits, vertices | indices << 16. Lists of a point, in order:
 *   strip       in L, R | restart before a polyline and where the strip breaks | out L, R; at a tight
 *               join out's inner one only, as both segments have the outer one in common
 *   kite, fan   in L, R | join | P | out L, R       P only where there is a join
 */
CAMBER_FN camber_u32 camber_join_counts(camber_u32 join, camber_u32 before, camber_u32 info, camber_u32 method) {
    const camber_u32 kind = camber_join_kind(join);
    const camber_u32 first = info & CAMBER_POINT_FIRST;
    const camber_u32 live = kind != CAMBER_KIND_GHOST ? 1u : 0u;
    if (method == CAMBER_STRIP) {
        const camber_u32 breaks = camber_strip_breaks(kind, info);
        const camber_u32 restart = first && !breaks ? 1u : 0u;
        const camber_u32 more = breaks ? (kind == CAMBER_KIND_TIGHT ? 1u : 2u) : 0u;
        return live * ((2u + more) | (2u + 3u * breaks + restart) << 16);
    }
    if (!live)
        return 0;
    if (kind == CAMBER_KIND_DOT)
        return 4u | 6u << 16;
    if (first)
        return kind == CAMBER_KIND_CAP ? 2u : 3u;
    const camber_u32 triangles = camber_join_triangles(join);
    const camber_u32 centred =
        (kind != CAMBER_KIND_CAP ? 1u : 0u) + (camber_join_kind(before) != CAMBER_KIND_CAP ? 1u : 0u);
    const camber_u32 join_vertices = triangles ? triangles - 1u : 0u;
    const camber_u32 vertices = kind == CAMBER_KIND_CAP ? 2u : 5u + join_vertices;
    return vertices | (3u * (2u + centred) + 3u * triangles) << 16;
}

#endif
