/* emit: writes the records of each point and, for kite and fan, its indices.
 * Reads x, y, info[n + 2], joins[n + 2], offsets[n / CAMBER_POINT_CHUNK], bases[2 * n / CAMBER_BLOCK] (each block's
 * first vertex and first index); writes records[CAMBER_RECORD_WORDS * record count], indices[index count].
 * camber_strip_records and camber_join_counts in join.h define them and their order. A work-item takes a chunk of
 * CAMBER_POINT_CHUNK points. With CAMBER_HAS_ARC_LENGTH it reads arc_lengths[2 * n] as well, and records are twice as
 * long; else arc_lengths is NULL. */
#include "join.h"

#define LANES (CAMBER_BLOCK / CAMBER_POINT_CHUNK)

/* Functions that are inlined into kernels do not use restrict, because oclgrind does not support it in such functions.
 */

static inline void put_record(global camber_u32 *records, size_t k, float x, float y, camber_u32 join,
                              camber_u32 last) {
    vstore4((uint4)(as_uint(x), as_uint(y), join, last), (1 + CAMBER_HAS_ARC_LENGTH) * k, records);
}

#if CAMBER_HAS_ARC_LENGTH
/* Writes the arc length of point i to all count records. */
static inline void put_arc_lengths(global camber_u32 *records, size_t count, global const float *arc_lengths,
                                   size_t i) {
    const camber_u32 along = as_uint(arc_lengths[2 * i]), in_all = as_uint(arc_lengths[2 * i + 1]);
    for (size_t r = 0; r < count; r++)
        vstore4((uint4)(along, in_all, 0u, 0u), 2 * r + 1, records);
}
#endif

#if CAMBER_METHOD == CAMBER_STRIP

/* Whether a point's records are not those that put_two writes: for a ring's first point, a dot, a split join or a
 * sentinel. */
static inline camber_u32 is_rare(camber_u32 join, camber_u32 point) {
    const camber_u32 ring_begins = CAMBER_POINT_FIRST | CAMBER_POINT_RING;
    return (camber_join_kind(join) - CAMBER_KIND_CAP > CAMBER_KIND_TIGHT - CAMBER_KIND_CAP ? 1u : 0u) |
           ((point & ring_begins) == ring_begins ? 1u : 0u);
}

/* Writes all records of any point; returns how many. */
static inline size_t put_any(global const float *x, global const float *y, size_t i, camber_u32 join, camber_u32 point,
                             global camber_u32 *records) {
    const camber_u32 kind = camber_join_kind(join), begins = point & CAMBER_POINT_FIRST ? 1u : 0u;
    const camber_u32 inside = point & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST) ? 0u : 1u;
    const camber_u32 breaks = CAMBER_RECORD_BREAK | (point & CAMBER_ROW_BITS);
    if (kind == CAMBER_KIND_SENTINEL)
        return 0;
    put_record(records, begins, x[i], y[i], join, point);
    if (begins) { /* a ring's first segment comes from a sentinel; an open line begins with the point itself */
        const size_t from = point & CAMBER_POINT_RING ? i - 1 : i;
        put_record(records, 0, x[from], y[from], 0, breaks);
    }
    if (kind == CAMBER_KIND_DOT)
        put_record(records, 2, x[i], y[i], join, point & ~CAMBER_POINT_FIRST);
    if (kind == CAMBER_KIND_TIGHT && inside)
        put_record(records, 1, x[i], y[i], join, point | CAMBER_RECORD_START);
    if (kind == CAMBER_KIND_SPLIT && inside) {
        put_record(records, 1, x[i - 1], y[i - 1], 0, breaks);
        put_record(records, 2, x[i], y[i], join, point | CAMBER_RECORD_START);
    }
    return camber_strip_records(kind, point);
}

/* Writes the one or two records of most points, whose number no processor can predict. So two records are stored for
 * each point: first the possible second one, and then the first; if there is only one, both stores go to the same
 * position. begins and goes_on are a record's words if the other one comes before it, or after it, and else 0. Returns
 * where the next point's records go. */
static inline __attribute__((always_inline)) global camber_u32 *put_two(global camber_u32 *to, uint4 record,
                                                                        uint4 other, camber_u32 begins,
                                                                        camber_u32 goes_on) {
    vstore4(other, 0, to + goes_on);
    vstore4(record, 0, to + begins);
    return to + CAMBER_RECORD_WORDS + begins + goes_on;
}

/* First computes which records each point has, in vectors as wide as possible; then writes the records, four points at
 * a time. */
CAMBER_KERNEL(LANES, emit,
              (global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
               global const camber_row *restrict rows, global const camber_u32 *restrict joins,
               global const camber_u32 *restrict offsets, global const camber_u64 *restrict bases,
               global camber_u32 *restrict records, global camber_u32 *restrict indices,
               global const float *restrict arc_lengths),
              (x, y, info, rows, joins, offsets, bases, records, indices, arc_lengths)) {
    const size_t first = CAMBER_WORK_ITEM * CAMBER_POINT_CHUNK + 1,
                 words = (1 + CAMBER_HAS_ARC_LENGTH) * CAMBER_RECORD_WORDS;
    camber_u32 rare[CAMBER_POINT_CHUNK], begins[CAMBER_POINT_CHUNK], goes_on[CAMBER_POINT_CHUNK];
    camber_u32 other_join[CAMBER_POINT_CHUNK], other_last[CAMBER_POINT_CHUNK];
#pragma clang loop vectorize_width(16)
    for (size_t n = 0; n < CAMBER_POINT_CHUNK; n++) {
        const camber_u32 join = joins[first + n], point = info[first + n], is_first = point & CAMBER_POINT_FIRST;
        const camber_u32 ends = point & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST);
        rare[n] = is_rare(join, point);
        begins[n] = is_first ? CAMBER_RECORD_WORDS : 0u;
        goes_on[n] = ((camber_join_kind(join) ^ CAMBER_KIND_TIGHT) | ends) == 0u ? CAMBER_RECORD_WORDS : 0u;
        other_join[n] = is_first ? 0u : join;
        other_last[n] = is_first ? CAMBER_RECORD_BREAK | (point & CAMBER_ROW_BITS) : CAMBER_RECORD_START | point;
    }
    /* two indices per record */
    const size_t k = ((size_t)bases[2 * (CAMBER_WORK_ITEM / LANES) + 1] + (offsets[CAMBER_WORK_ITEM] >> 16)) / 2;
    global camber_u32 *to = records + words * k;
    for (size_t n = 0; n < CAMBER_POINT_CHUNK; n += 4) {
        const size_t i = first + n;
        if (CAMBER_HAS_ARC_LENGTH | rare[n] | rare[n + 1] | rare[n + 2] | rare[n + 3]) {
            for (size_t p = i; p < i + 4; p++) {
                const size_t count = put_any(x, y, p, joins[p], info[p], to);
#if CAMBER_HAS_ARC_LENGTH
                put_arc_lengths(to, count, arc_lengths, p - 1);
#endif
                to += words * count;
            }
            continue;
        }
        const uint4 px = as_uint4(vload4(0, x + i)), py = as_uint4(vload4(0, y + i));
        const uint4 xy_low = (uint4)(px.s0, py.s0, px.s1, py.s1), xy_high = (uint4)(px.s2, py.s2, px.s3, py.s3);
        const uint4 join = vload4(0, joins + i), last = vload4(0, info + i);
        const uint4 low = (uint4)(join.s0, last.s0, join.s1, last.s1);
        const uint4 high = (uint4)(join.s2, last.s2, join.s3, last.s3);
        const uint4 join_2 = vload4(0, other_join + n), last_2 = vload4(0, other_last + n);
        const uint4 low_2 = (uint4)(join_2.s0, last_2.s0, join_2.s1, last_2.s1);
        const uint4 high_2 = (uint4)(join_2.s2, last_2.s2, join_2.s3, last_2.s3);
        to = put_two(to, (uint4)(xy_low.lo, low.lo), (uint4)(xy_low.lo, low_2.lo), begins[n], goes_on[n]);
        to = put_two(to, (uint4)(xy_low.hi, low.hi), (uint4)(xy_low.hi, low_2.hi), begins[n + 1], goes_on[n + 1]);
        to = put_two(to, (uint4)(xy_high.lo, high.lo), (uint4)(xy_high.lo, high_2.lo), begins[n + 2], goes_on[n + 2]);
        to = put_two(to, (uint4)(xy_high.hi, high.hi), (uint4)(xy_high.hi, high_2.hi), begins[n + 3], goes_on[n + 3]);
    }
}

#else

static inline void put_triangle(global camber_u32 *indices, camber_u32 a, camber_u32 b, camber_u32 c) {
    indices[0] = a;
    indices[1] = b;
    indices[2] = c;
}

/* Writes the body between the start's L, R (sl, sr) and the end's (e, e + 1); a and b are the centres if the ends are
 * joins. Every triangle ends with a vertex that carries the segment, and all wind in the same direction:
 *
 *     sL--------eL
 *     A          B
 *     sR--------eR */
static inline camber_u32 put_body(global camber_u32 *indices, camber_u32 sl, camber_u32 sr, camber_u32 e, camber_u32 a,
                                  camber_u32 has_a, camber_u32 b, camber_u32 has_b) {
    if (has_a && has_b) {
        put_triangle(indices, sl, a, e);
        put_triangle(indices + 3, a, b, e);
        put_triangle(indices + 6, b, a, e + 1);
        put_triangle(indices + 9, a, sr, e + 1);
        return 12;
    }
    if (has_a) {
        put_triangle(indices, a, sr, e + 1);
        put_triangle(indices + 3, a, e + 1, e);
        put_triangle(indices + 6, sl, a, e);
        return 9;
    }
    if (has_b) {
        put_triangle(indices, b, e, sl);
        put_triangle(indices + 3, b, sl, sr);
        put_triangle(indices + 6, b, sr, e + 1);
        return 9;
    }
    put_triangle(indices, sl, sr, e);
    put_triangle(indices + 3, sr, e + 1, e);
    return 6;
}

/* Writes a triangle of a join about the centre p, ending with the vertex that carries its segment. outer < 0: the turn
 * is to the left, and the outer side is the right one. */
static inline void put_wedge(global camber_u32 *indices, camber_u32 p, camber_u32 from, camber_u32 to,
                             camber_u32 to_carries, float outer) {
    const camber_u32 carries = to_carries ? to : from, other = to_carries ? from : to;
    const camber_u32 flip = (outer > 0.0f) == (to_carries != 0u);
    put_triangle(indices, flip ? other : p, flip ? p : other, carries);
}

/* Writes a join's triangles from the outer edge of the incoming segment to the outer edge of the outgoing one. A kite's
 * tip belongs to neither: the edge is the provoking vertex of its first triangle. */
static inline void put_join(global camber_u32 *indices, camber_u32 record, camber_u32 triangles, camber_u32 is_fan,
                            float outer) {
    const camber_u32 p = record | CAMBER_CORNER_CENTRE;
    const camber_u32 out_edge = record | (outer > 0.0f ? CAMBER_CORNER_OUT_LEFT : CAMBER_CORNER_OUT_RIGHT);
    camber_u32 from = record | (outer > 0.0f ? CAMBER_CORNER_IN_LEFT : CAMBER_CORNER_IN_RIGHT);
    for (camber_u32 i = 0; i < triangles; i++) {
        const camber_u32 own = record | camber_join_corner(i, triangles, is_fan);
        const camber_u32 to = i + 1 < triangles ? own : out_edge;
        put_wedge(indices + 3 * i, p, from, to, i > 0 || triangles == 1, outer);
        from = to;
    }
}

/* Writes a point's record and indices; returns how many indices. */
static inline size_t put_point(global const float *x, global const float *y, global const camber_u32 *info,
                               global const camber_row *rows, global const camber_u32 *joins, size_t i,
                               global camber_u32 *records, global camber_u32 *index) {
    const camber_u32 join = joins[i], kind = camber_join_kind(join), point = info[i];
    const camber_u32 before = joins[i - 1], cap = rows[point >> CAMBER_POINT_ROW_SHIFT].cap;
    /* One record per slot, including sentinels: the sentinels of a ring are the neighbours of its seam. */
    put_record(records, i - 1, x[i], y[i],
               camber_record_join(
                   join, cap, camber_half_shorter(x[i] - x[i - 1], y[i] - y[i - 1], x[i + 1] - x[i], y[i + 1] - y[i])),
               point);
    if (kind == CAMBER_KIND_SENTINEL || (point & CAMBER_POINT_FIRST && kind != CAMBER_KIND_DOT))
        return 0;
    const camber_u32 here = (camber_u32)(i - 1) << CAMBER_CORNER_BITS, in_left = here | CAMBER_CORNER_IN_LEFT;
    if (kind == CAMBER_KIND_DOT)
        return put_body(index, here | CAMBER_CORNER_OUT_LEFT, here | CAMBER_CORNER_OUT_RIGHT, in_left, 0, 0, 0, 0);
    const camber_u32 start = (camber_u32)(i - 2) << CAMBER_CORNER_BITS, joined = kind != CAMBER_KIND_CAP;
    const camber_u32 body =
        put_body(index, start | camber_start_corner(before, 1.0f, CAMBER_METHOD),
                 start | camber_start_corner(before, -1.0f, CAMBER_METHOD), in_left, start | CAMBER_CORNER_CENTRE,
                 camber_join_kind(before) != CAMBER_KIND_CAP, here | CAMBER_CORNER_CENTRE, joined);
    if (!joined)
        return body;
    put_join(index + body, here, camber_join_triangles(join),
             CAMBER_METHOD == CAMBER_FAN && camber_join_end(join) == CAMBER_ENDS_ROUND,
             camber_turn_unpack(join) > 0.0f ? -1.0f : 1.0f);
    return body + 3u * camber_join_triangles(join);
}

CAMBER_KERNEL(LANES, emit,
              (global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
               global const camber_row *restrict rows, global const camber_u32 *restrict joins,
               global const camber_u32 *restrict offsets, global const camber_u64 *restrict bases,
               global camber_u32 *restrict records, global camber_u32 *restrict indices,
               global const float *restrict arc_lengths),
              (x, y, info, rows, joins, offsets, bases, records, indices, arc_lengths)) {
    const size_t first = CAMBER_WORK_ITEM * CAMBER_POINT_CHUNK + 1;
    size_t at = (size_t)bases[2 * (CAMBER_WORK_ITEM / LANES) + 1] + (offsets[CAMBER_WORK_ITEM] >> 16);
    for (size_t i = first; i < first + CAMBER_POINT_CHUNK; i++) {
        at += put_point(x, y, info, rows, joins, i, records, indices + at);
#if CAMBER_HAS_ARC_LENGTH
        put_arc_lengths(records + 2 * CAMBER_RECORD_WORDS * (i - 1), 1, arc_lengths, i - 1);
#endif
    }
}

#endif
