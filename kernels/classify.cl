/* classify: computes the join word of each point.
 * Reads x, y, info[n + 2] (one sentinel before and after the n points), rows; writes joins[n + 2], of which the first
 * and the last stay 0. Points of areas get 0. n is a multiple of CAMBER_BLOCK. CAMBER_METHOD and CAMBER_POINT_CHUNK are
 * set by the build. A work-group's items take its points in turn; if one takes them all, its loops are vectorised.
 *
 *     rows    usually all points have the same row, which is read once: gathers are slow, and AVX2's are split up
 *     turns   roots and divisions that depend on each other: the shorter the loop, the more points are in flight
 *     words   from both
 *
 * x_before, x_after and the like are x and y again: if the compiler can see that a point's two neighbours are adjacent
 * in memory, it packs them into a float2, and PoCL no longer vectorises over the points (5 times slower). */
#include "join.h"

#define LANES (CAMBER_BLOCK / CAMBER_POINT_CHUNK)

/* The rows of a work-item's points: one array per field, so that they are loaded as vectors. */
typedef struct point_rows {
    float reach_px[CAMBER_POINT_CHUNK], miter_limit[CAMBER_POINT_CHUNK], round_cos[CAMBER_POINT_CHUNK];
    float fan_cos[CAMBER_POINT_CHUNK], fan_sin[CAMBER_POINT_CHUNK];
    camber_u32 join[CAMBER_POINT_CHUNK], cap[CAMBER_POINT_CHUNK];
} point_rows;

static inline void put_row(point_rows *to, size_t n, camber_row row) {
    to->reach_px[n] = row.reach_px;
    to->miter_limit[n] = row.miter_limit;
    to->join[n] = row.join;
    to->cap[n] = row.cap;
    if (CAMBER_ROUND_LIMITS)
        to->round_cos[n] = row.round_cos;
    if (CAMBER_METHOD == CAMBER_FAN) {
        to->fan_cos[n] = row.fan_cos;
        to->fan_sin[n] = row.fan_sin;
    }
}

static inline camber_row row_of(const point_rows *from, size_t n) {
    camber_row row = {
        .reach_px = from->reach_px[n], .miter_limit = from->miter_limit[n], .join = from->join[n], .cap = from->cap[n]};
    if (CAMBER_ROUND_LIMITS)
        row.round_cos = from->round_cos[n];
    if (CAMBER_METHOD == CAMBER_FAN) {
        row.fan_cos = from->fan_cos[n];
        row.fan_sin = from->fan_sin[n];
    }
    return row;
}

/* The bits that at least one point has, and those that all have. Sentinels have neither row nor flags. */
typedef struct point_bits {
    camber_u32 any, all;
} point_bits;

static inline point_bits read_bits(global const camber_u32 *info, size_t first) {
    point_bits bits = {0u, ~0u};
    for (size_t n = 0; n < CAMBER_POINT_CHUNK; n++) {
        const camber_u32 point = info[first + n * LANES];
        bits.any |= point;
        bits.all &= point & CAMBER_POINT_REAL ? point : ~0u;
    }
    return bits;
}

/* Reads the rows of the points first, first + LANES and so on. */
static inline void read_rows(global const camber_u32 *info, global const camber_row *rows, size_t first,
                             point_bits bits, point_rows *to) {
    if (((bits.any ^ bits.all) & CAMBER_ROW_BITS) == 0u) {
        const camber_row row = rows[bits.any >> CAMBER_POINT_ROW_SHIFT];
        for (size_t n = 0; n < CAMBER_POINT_CHUNK; n++)
            put_row(to, n, row);
        return;
    }
#pragma clang loop vectorize(disable) unroll(disable)
    for (size_t n = 0; n < CAMBER_POINT_CHUNK; n++)
        put_row(to, n, rows[info[first + n * LANES] >> CAMBER_POINT_ROW_SHIFT]);
}

CAMBER_KERNEL(LANES, classify,
              (global const float *restrict x, global const float *restrict y, global const float *restrict x_before,
               global const float *restrict y_before, global const float *restrict x_after,
               global const float *restrict y_after, global const camber_u32 *restrict info,
               global const camber_u32 *restrict info_before, global const camber_u32 *restrict info_after,
               global const camber_row *restrict rows, global camber_u32 *restrict joins),
              (x, y, x_before, y_before, x_after, y_after, info, info_before, info_after, rows, joins)) {
    const size_t first = CAMBER_WORK_ITEM / LANES * CAMBER_BLOCK + CAMBER_WORK_ITEM % LANES + 1;
    const point_bits bits = read_bits(info, first);
    point_rows r;
    if (bits.all & CAMBER_POINT_AREA) { /* this also holds if there are only sentinels */
        for (size_t n = 0; n < CAMBER_POINT_CHUNK; n++)
            joins[first + n * LANES] = 0u;
        return;
    }
    read_rows(info, rows, first, bits, &r);
    float c[CAMBER_POINT_CHUNK], s[CAMBER_POINT_CHUNK], dot[CAMBER_POINT_CHUNK], half_shorter[CAMBER_POINT_CHUNK];
#pragma clang loop vectorize_width(16)
    for (size_t n = 0; n < CAMBER_POINT_CHUNK; n++) {
        const size_t i = first + n * LANES;
        const camber_turn turn = camber_turn_between(x[i] - x_before[i - 1], y[i] - y_before[i - 1],
                                                     x_after[i + 1] - x[i], y_after[i + 1] - y[i]);
        c[n] = turn.c;
        s[n] = turn.s;
        dot[n] = turn.dot;
        half_shorter[n] = turn.half_shorter;
    }
#pragma clang loop vectorize_width(16)
    for (size_t n = 0; n < CAMBER_POINT_CHUNK; n++) {
        const size_t i = first + n * LANES;
        const camber_u32 point = info[i];
        const camber_turn turn = {c[n], s[n], dot[n], half_shorter[n]};
        const camber_row row = row_of(&r, n);
        const camber_u32 ends = point & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST);
        const camber_u32 is_dot = ends == (CAMBER_POINT_FIRST | CAMBER_POINT_LAST);
        const camber_u32 is_cap = ends != 0u && (point & CAMBER_POINT_RING) == 0u;
        const camber_u32 line_ends = camber_line_ends(info_before[i - 1], info_after[i + 1]);
        const camber_u32 stub = CAMBER_METHOD == CAMBER_STRIP ? camber_stub_pack(row.cap, half_shorter[n]) : 0u;
        const camber_u32 join = camber_join_word(turn, &row, CAMBER_METHOD) | line_ends | stub;
        const camber_u32 word = is_cap ? camber_cap_word(row.cap, is_dot) : join;
        joins[i] = (point & (CAMBER_POINT_REAL | CAMBER_POINT_AREA)) == CAMBER_POINT_REAL ? word : 0u;
    }
}
