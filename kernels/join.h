/* Join maths: the only place with formulas of joins. It uses only + - * / sqrt, each correctly rounded, so that device
 * and twin agree to the last bit if the device rounds correctly; except for the corners, which no kernel places.
 *
 * u and w are the directions into and out of a point, t the angle from u to w, positive from x to y. The half
 * turn's cosine c and sine s give all that a join needs:
 *
 *     tan(t/2) = s / c          how far along u the bisector cuts the edge
 *     tan(t/4) = s / (1 + c)    in -1 to 1 for every turn: what is stored, as 16 bits
 *     1 / c                     the miter length over the width */
#ifndef CAMBER_KERNELS_JOIN_H
#define CAMBER_KERNELS_JOIN_H

#include "layout.h"

/* 0: no row has a round limit, as a build for the device may know: classify then gathers one word less of a row. */
#ifndef CAMBER_ROUND_LIMITS
#define CAMBER_ROUND_LIMITS 1
#endif

/* The sine of half the turn: a join that turns by less, 0.011 degrees, has no triangles of its own in kite and fan.
 * Their corners would coincide, so that the rasteriser's rounding would decide which way they wind. */
#define CAMBER_STRAIGHT_SINE 1e-4f

CAMBER_STRUCT(camber_turn) {
    float c, s;         /* cosine (>= 0) and sine (signed) of half the turn */
    float dot;          /* cosine of the turn */
    float half_shorter; /* half the shorter of the two segments, px */
};

/* Returns half the length of the shorter of the segments into (dx, dy) and out of (ex, ey) a point, in px. */
CAMBER_FN float camber_half_shorter(float dx, float dy, float ex, float ey) {
    const float d2 = dx * dx + dy * dy, e2 = ex * ex + ey * ey;
    return 0.5f * CAMBER_SQRT(d2 < e2 ? d2 : e2);
}

/* Returns the turn between the two segments. The product of the lengths comes from (d.e)^2 + (d x e)^2 = |d|^2 |e|^2,
 * so that one root and one division are enough. A product below 1e-9 px times 1e-9 px counts as that; at the longest,
 * 3e9 px, it still fits into a float. */
CAMBER_FN camber_turn camber_turn_between(float dx, float dy, float ex, float ey) {
    const float along = dx * ex + dy * ey, aside = dx * ey - dy * ex;
    const float product = along * along + aside * aside; /* product of the squared lengths */
    const float scale = 1.0f / CAMBER_SQRT(product > 1e-36f ? product : 1e-36f);
    const float dot = along * scale, cross = aside * scale;
    /* The larger one of c and s is a root that loses no precision, and the smaller one follows from cross = 2 s c. */
    const float larger = CAMBER_SQRT(0.5f + 0.5f * CAMBER_FABS(dot));
    const float smaller = 0.5f * cross / larger;
    camber_turn turn;
    turn.dot = dot;
    turn.c = dot >= 0.0f ? larger : CAMBER_FABS(smaller);
    turn.s = dot >= 0.0f ? smaller : (cross < 0.0f ? -larger : larger);
    turn.half_shorter = camber_half_shorter(dx, dy, ex, ey);
    return turn;
}

/* Returns tan(t/4) as 16 bits. The result is never 0, which marks a cap: a straight join gets a turn of 0.007 degrees.
 */
CAMBER_FN camber_u32 camber_turn_pack(camber_turn turn) {
    const float q = turn.s / (1.0f + turn.c) * CAMBER_LARGEST_TURN;
    const float rounded = q + (q < 0.0f ? -0.5f : 0.5f);
    const float bounded = rounded > CAMBER_LARGEST_TURN    ? CAMBER_LARGEST_TURN
                          : rounded < -CAMBER_LARGEST_TURN ? -CAMBER_LARGEST_TURN
                                                           : rounded;
    const camber_i32 turns = CAMBER_CAST(camber_i32, bounded);
    return turns == 0 ? 1u : CAMBER_CAST(camber_u32, turns) & 0xffffu;
}

CAMBER_FN float camber_turn_unpack(camber_u32 join) {
    return CAMBER_CAST(float, CAMBER_CAST(camber_i32, join << 16) >> 16) * (1.0f / CAMBER_LARGEST_TURN);
}

/* Returns tan(t/2) from q = tan(t/4). At a full reversal it is large, but not infinite. */
CAMBER_FN float camber_turn_tan_half(float q) {
    const float below = 1.0f - q * q;
    return 2.0f * q / (below > 1e-6f ? below : 1e-6f);
}

CAMBER_FN camber_u32 camber_join_kind(camber_u32 join) {
    return join >> CAMBER_JOIN_KIND_SHIFT;
}

CAMBER_FN camber_u32 camber_join_end(camber_u32 join) {
    return join >> CAMBER_JOIN_END_SHIFT & CAMBER_JOIN_END_MASK;
}

/* Returns the bits of a join word that describe the line beyond the neighbouring points, from the info words of these
 * points. A ring has neither first nor last point, and a line that the window cuts does not end there. */
CAMBER_FN camber_u32 camber_line_ends(camber_u32 before, camber_u32 after) {
    const camber_u32 goes_on = CAMBER_POINT_RING | CAMBER_POINT_CUT;
    const camber_flag first = (before & (CAMBER_POINT_FIRST | goes_on)) == CAMBER_POINT_FIRST;
    const camber_flag last = (after & (CAMBER_POINT_LAST | goes_on)) == CAMBER_POINT_LAST;
    return (first ? CAMBER_JOIN_AFTER_FIRST : 0u) | (last ? CAMBER_JOIN_BEFORE_LAST : 0u);
}

CAMBER_FN camber_u32 camber_join_triangles(camber_u32 join) {
    return join >> CAMBER_JOIN_TRIANGLES_SHIFT & 127u;
}

/* Returns the bits of a join word for the stub and the caps. cap: the line's camber_cap. */
CAMBER_FN camber_u32 camber_stub_pack(camber_u32 cap, float half_shorter) {
    const float units = 2.0f * half_shorter * (1.0f / CAMBER_STUB_UNIT_PX),
                longest = CAMBER_CAST(float, CAMBER_STUB_MOST - 2u);
    const camber_u32 part = CAMBER_CAST(camber_u32, units < longest ? units : longest);
    const camber_u32 stub = 2.0f * half_shorter < CAMBER_STUB_PX ? 1u + part : CAMBER_STUB_MOST;
    return stub << CAMBER_JOIN_STUB_SHIFT | (cap == CAMBER_CAPS_BUTT ? CAMBER_JOIN_BUTT : 0u);
}

/* Returns camber_end for a cap: round 0, butt 1, square 2. */
CAMBER_FN camber_u32 camber_cap_end(camber_u32 cap) {
    return cap == CAMBER_CAPS_ROUND    ? CAMBER_ENDS_ROUND
           : cap == CAMBER_CAPS_SQUARE ? CAMBER_ENDS_SQUARE
                                       : CAMBER_ENDS_BUTT;
}

/* Returns the number of triangles of a round join as a fan: steps of the row's angle until they exceed the turn. cos
 * decreases from 0 to half a circle, so comparing cosines compares angles. */
CAMBER_FN camber_u32 camber_fan_triangles(float turn_cos, float step_cos, float step_sin) {
    float x = step_cos, y = step_sin;
    camber_u32 n = 1u;
    while (n < CAMBER_JOIN_TRIANGLES_MAX && x > turn_cos && y > 0.0f) {
        const float next = x * step_cos - y * step_sin;
        y = x * step_sin + y * step_cos;
        x = next;
        n++;
    }
    return n;
}

/* Returns the join word of a point where two segments meet.
 *
 *     cut: each segment's quad ends on the bisector M-C       tight: the inner side has no room, each quad goes on
 *     and holds its own part of the join                      past P there, by the pad: the fragment shader cuts
 *                                                             at P and the bisector what is past them
 *
 *        ______________ C                                        ______________ C
 *        in            /|                                        in            /|
 *        -------------P |                                        -------------P |
 *        ____________/  |                                        _________Mb Ma_|
 *                   M   |                                                  |out|
 *                   |out|
 *
 *     split: past |tan(t/2)| = 2 (127 degrees) C is too far off; both end past P, and the fragment shader gives each
 *     its side of the bisector */
CAMBER_FN camber_u32 camber_join_word(camber_turn turn, CAMBER_IN(camber_row) row, camber_u32 method) {
    const float sine = CAMBER_FABS(turn.s);
#if CAMBER_ROUND_LIMITS
    const camber_u32 asked = turn.c > row->round_cos ? CAMBER_JOINS_MITER : row->join;
#else
    const camber_u32 asked = row->join;
#endif
    const camber_flag miter = asked == CAMBER_JOINS_MITER && turn.c * row->miter_limit >= 1.0f;
    const camber_flag bevel = asked != CAMBER_JOINS_ROUND && !miter;
    const camber_flag split = !miter && sine > 2.0f * turn.c;
    const camber_flag tight = row->reach_px * sine > turn.half_shorter * turn.c;
    camber_u32 end = miter ? CAMBER_ENDS_MITER : bevel ? CAMBER_ENDS_BEVEL : CAMBER_ENDS_ROUND;
    camber_u32 triangles = 0u;
    if (method == CAMBER_STRIP) {
        const camber_u32 split_end = miter   ? CAMBER_ENDS_SPLIT_MITER
                                     : bevel ? CAMBER_ENDS_SPLIT_BEVEL
                                             : CAMBER_ENDS_SPLIT_ROUND;
        end = split || tight ? split_end : end;
    } else if (sine > CAMBER_STRAIGHT_SINE) {
        /* Beyond 120 degrees the kite's tip would be too far away, so there are two kites of half the angle. */
        const camber_u32 kites = !miter && sine > 1.7320508f * turn.c ? 4u : 2u;
        triangles = method == CAMBER_FAN && asked == CAMBER_JOINS_ROUND
                        ? camber_fan_triangles(turn.dot, row->fan_cos, row->fan_sin)
                        : kites;
    }
    const camber_u32 kind = split ? CAMBER_KIND_SPLIT : tight ? CAMBER_KIND_TIGHT : CAMBER_KIND_CUT;
    return camber_turn_pack(turn) | kind << CAMBER_JOIN_KIND_SHIFT | end << CAMBER_JOIN_END_SHIFT |
           triangles << CAMBER_JOIN_TRIANGLES_SHIFT;
}

/* Returns the join word of an end of an open polyline, or of a dot. */
CAMBER_FN camber_u32 camber_cap_word(camber_u32 cap, camber_u32 dot) {
    const camber_u32 kind = dot == 0u                 ? CAMBER_KIND_CAP
                            : cap == CAMBER_CAPS_BUTT ? CAMBER_KIND_SENTINEL
                                                      : CAMBER_KIND_DOT;
    return kind << CAMBER_JOIN_KIND_SHIFT | camber_cap_end(cap) << CAMBER_JOIN_END_SHIFT;
}

/* Returns how far along its segment an edge vertex is, in units of the reach. end: +1 at the segment's end, -1 at its
 * start; side: +1 or -1. This returns a float and not a struct: the device's compiler makes a float2 of two floats that
 * are returned together, and then does not vectorise. */
CAMBER_FN float camber_edge_along(camber_u32 join, float end, float side, camber_u32 method) {
    const camber_u32 kind = camber_join_kind(join);
    const float q = camber_turn_unpack(join);
    const float cut = -end * side * camber_turn_tan_half(q);
    const camber_flag is_inner = side * q > 0.0f;
    if (kind > CAMBER_KIND_CUT && is_inner && method != CAMBER_FAN)
        return end;
    if (method == CAMBER_STRIP)
        return kind == CAMBER_KIND_CUT || kind == CAMBER_KIND_TIGHT ? cut : end;
    if (method == CAMBER_KITE && kind == CAMBER_KIND_CUT && is_inner)
        return cut;
    return kind < CAMBER_KIND_CUT ? end : 0.0f;
}

/* Returns the limit on the result of camber_edge_along, in px: past a butt end, and past the inner side of a tight
 * join, it is the pad, however wide the line is. */
CAMBER_FN float camber_edge_limit(camber_u32 join, float side) {
    const camber_u32 kind = camber_join_kind(join);
    const camber_flag is_butt = kind < CAMBER_KIND_CUT && camber_join_end(join) == CAMBER_ENDS_BUTT;
    const camber_flag is_inner = kind == CAMBER_KIND_TIGHT && side * camber_turn_unpack(join) > 0.0f;
    return is_butt || is_inner ? CAMBER_PAD_PX : CAMBER_NO_LIMIT_PX;
}

/* Returns how many records a point of a strip has:
 *   break, start        a polyline's first point
 *   break, start, end   a dot
 *   end                 the last point, and a plain cut, at which the strip continues
 *   end, start          at a tight join inside a polyline: of the triangles between, one is Ma, C, Mb, which winds
 *                       the other way, as Mb is before the line through Ma and C, and is culled; one has no area
 *   end, break, start   at a split join there */
CAMBER_FN camber_u32 camber_strip_records(camber_u32 kind, camber_u32 info) {
    const camber_u32 first = CAMBER_HAS(info, CAMBER_POINT_FIRST) ? 1u : 0u;
    const camber_u32 inner = CAMBER_HAS(info, CAMBER_POINT_FIRST | CAMBER_POINT_LAST) ? 0u : 1u;
    const camber_u32 live = kind == CAMBER_KIND_SENTINEL ? 0u : kind == CAMBER_KIND_DOT ? 3u : 1u + first;
    return live + (kind > CAMBER_KIND_CUT ? inner : 0u) + (kind > CAMBER_KIND_TIGHT ? inner : 0u);
}

/* Whether a record begins a strip. */
CAMBER_FN camber_flag camber_record_starts(camber_u32 last) {
    return CAMBER_HAS(last, CAMBER_POINT_FIRST | CAMBER_RECORD_START);
}

/* Whether a start shares its edge vertex on a side with the end before it: at a ring's cut seam, so that no pixel falls
 * between them, and at the outer side of a tight join. */
CAMBER_FN camber_flag camber_edge_is_shared(camber_u32 join, camber_u32 last, float side) {
    const camber_u32 kind = camber_join_kind(join);
    const camber_flag seam = CAMBER_HAS(last, CAMBER_POINT_RING) && kind == CAMBER_KIND_CUT;
    const camber_flag outer = kind == CAMBER_KIND_TIGHT && side * camber_turn_unpack(join) < 0.0f;
    return CAMBER_HAS(last, CAMBER_POINT_FIRST) ? seam : outer;
}

/* Returns the join word for the records of kite and fan. cap: the line's camber_cap. */
CAMBER_FN camber_u32 camber_record_join(camber_u32 join, camber_u32 cap, float half_shorter) {
    const camber_u32 stub = camber_join_kind(join) < CAMBER_KIND_CUT ? 0u : camber_stub_pack(cap, half_shorter);
    return (join & ~(127u << CAMBER_JOIN_TRIANGLES_SHIFT)) | stub;
}

/* Returns the corner that a body begins with on a side. Cut bodies share corners with the end before: those of kites
 * share the inner corner, and straight ones share both. */
CAMBER_FN camber_u32 camber_start_corner(camber_u32 join, float side, camber_u32 method) {
    const camber_flag inner = method == CAMBER_KITE && side * camber_turn_unpack(join) > 0.0f;
    const camber_flag in_both =
        camber_join_kind(join) == CAMBER_KIND_CUT && (inner || camber_join_triangles(join) == 0u);
    return (in_both ? CAMBER_CORNER_IN_LEFT : CAMBER_CORNER_OUT_LEFT) + (side > 0.0f ? 0u : 1u);
}

/* Returns the i-th of a join's own vertices, of which it has triangles - 1. */
CAMBER_FN camber_u32 camber_join_corner(camber_u32 i, camber_u32 triangles, camber_flag is_fan) {
    return is_fan ? CAMBER_CORNER_FAN + i + 1u : triangles == 2u ? CAMBER_CORNER_TIP : CAMBER_CORNER_IN_TIP + i;
}

/* Whether the outgoing segment of the point places a corner. */
CAMBER_FN camber_flag camber_corner_goes_out(camber_u32 corner) {
    return corner == CAMBER_CORNER_CENTRE || corner == CAMBER_CORNER_OUT_LEFT || corner == CAMBER_CORNER_OUT_RIGHT ||
           corner == CAMBER_CORNER_OUT_TIP;
}

#ifndef CAMBER_DEVICE
/* Places a join's own vertices, along and across its segment from the point P, in units of the reach. q is
 * tan(turn / 4); step: the row's fan_step. For host and shaders: kernels have no sine.
 *
 *              TIP                IN_TIP -- BISECTOR -- OUT_TIP            FAN+1 .. FAN+2
 *            /     \                /                       \             .               .
 *     ----- L       L' -----   --- L                         L' ---      L                 L'
 *            \     /                 \                     /               \             /
 *               P                               P                                 P
 *
 *     kite                     two kites, past 120 degrees              fan: steps on the arc
 *
 * L and L' are the outer edge vertices of the segments in and out. A fan's chords touch the padded arc from outside
 * instead of cutting it, hence 1 / cos. */
CAMBER_FN void camber_join_corner_at(camber_u32 corner, float q, float step, CAMBER_OUT(float) along,
                                     CAMBER_OUT(float) across) {
    const float outer = q > 0.0f ? -1.0f : 1.0f, a = CAMBER_FABS(q), scale = 1.0f / (1.0f + a * a);
    const float angle =
        step * CAMBER_CAST(float, CAMBER_CAST(camber_i32, corner) - CAMBER_CAST(camber_i32, CAMBER_CORNER_FAN));
    const float arc = 1.0f / CAMBER_COS(0.5f * step), cosine = CAMBER_COS(angle) * arc;
    CAMBER_AT(along) = corner == CAMBER_CORNER_CENTRE     ? 0.0f
                       : corner == CAMBER_CORNER_TIP      ? camber_turn_tan_half(a)
                       : corner == CAMBER_CORNER_IN_TIP   ? a
                       : corner == CAMBER_CORNER_BISECTOR ? 2.0f * a * scale
                       : corner == CAMBER_CORNER_OUT_TIP  ? -a
                                                          : CAMBER_SIN(angle) * arc;
    CAMBER_AT(across) = outer * (corner == CAMBER_CORNER_CENTRE     ? 0.0f
                                 : corner == CAMBER_CORNER_BISECTOR ? (1.0f - a * a) * scale
                                 : corner > CAMBER_CORNER_OUT_TIP   ? cosine
                                                                    : 1.0f);
}
#endif

/* Returns how many vertices and indices a point emits, as vertices | indices << 16. Only distinct vertices count:
 *   strip       L, R of each start and end, except the outer one that they share at a tight join
 *   kite, fan   in L, R | join's own | P if there is a join | out L, R, unless the polyline ends, and except those
 *               that camber_start_corner shares
 * A strip has two indices per record, stored or not. */
CAMBER_FN camber_u32 camber_join_counts(camber_u32 join, camber_u32 before, camber_u32 info, camber_u32 method) {
    const camber_u32 kind = camber_join_kind(join);
    if (method == CAMBER_STRIP) {
        const camber_u32 records = camber_strip_records(kind, info);
        const camber_flag ends = CAMBER_HAS(info, CAMBER_POINT_FIRST | CAMBER_POINT_LAST);
        const camber_u32 vertices = records == 3u ? 4u : ends ? 2u : 1u + records;
        return records == 0u ? 0u : vertices | records << 17;
    }
    if (kind == CAMBER_KIND_SENTINEL)
        return 0u;
    if (kind == CAMBER_KIND_DOT)
        return 4u | 6u << 16;
    if (CAMBER_HAS(info, CAMBER_POINT_FIRST))
        return kind == CAMBER_KIND_CAP ? 2u : 3u;
    const camber_u32 triangles = camber_join_triangles(join);
    const camber_u32 joined = kind != CAMBER_KIND_CAP ? 1u : 0u;
    const camber_u32 centred = joined + (camber_join_kind(before) != CAMBER_KIND_CAP ? 1u : 0u);
    const camber_u32 inner = triangles == 0u ? 2u : method == CAMBER_KITE ? 1u : 0u;
    const camber_u32 in_both = kind == CAMBER_KIND_CUT ? inner : 0u;
    const camber_u32 own = triangles == 0u ? 0u : triangles - 1u, last = triangles == 0u ? 0u : 1u;
    const camber_u32 out_of = CAMBER_HAS(info, CAMBER_POINT_LAST) ? last : 2u - in_both;
    const camber_u32 vertices = 2u + joined * (1u + own + out_of);
    return vertices | (3u * (2u + centred) + 3u * triangles) << 16;
}

#endif
