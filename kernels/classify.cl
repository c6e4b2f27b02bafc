/* classify: per point, which join it is.
 * Reads x, y, info[n + 2] (one sentinel before and after the n points), rows; writes joins[n + 2], of which the first
 * and the last stay 0. n is a multiple of CAMBER_BLOCK. CAMBER_METHOD and CAMBER_POINT_CHUNK are set by the build. A
 * work-group's items take its points by turns; where one takes them all, it is the loop that is vectorised, in
 * registers as wide as there are: that leaves more points in flight than the vectoriser would by itself. x_before,
 * x_after and their like are x and y once more: where the compiler can see that a point's two neighbours lie together,
 * it packs them into a float2, and PoCL does not vectorise over the points any more (5 times slower). */
#include "join.h"

#define LANES (CAMBER_BLOCK / CAMBER_POINT_CHUNK)

CAMBER_KERNEL(LANES, classify,
              (global const float *restrict x, global const float *restrict y, global const float *restrict x_before,
               global const float *restrict y_before, global const float *restrict x_after,
               global const float *restrict y_after, global const camber_u32 *restrict info,
               global const camber_u32 *restrict info_before, global const camber_u32 *restrict info_after,
               global const camber_row *restrict rows, global camber_u32 *restrict joins),
              (x, y, x_before, y_before, x_after, y_after, info, info_before, info_after, rows, joins)) {
    const size_t first = CAMBER_WORK_ITEM / LANES * CAMBER_BLOCK + CAMBER_WORK_ITEM % LANES + 1;
#pragma clang loop vectorize_width(16)
    for (size_t n = 0; n < CAMBER_BLOCK; n += LANES) {
        const size_t i = first + n;
        const camber_u32 point = info[i];
        global const camber_row *row = rows + (point >> CAMBER_POINT_ROW_SHIFT);
        const camber_turn turn = camber_turn_between(x[i] - x_before[i - 1], y[i] - y_before[i - 1],
                                                     x_after[i + 1] - x[i], y_after[i + 1] - y[i]);
        const camber_u32 ends = point & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST);
        const camber_u32 dot = ends == (CAMBER_POINT_FIRST | CAMBER_POINT_LAST);
        const camber_u32 cap = ends != 0u && (point & CAMBER_POINT_RING) == 0u;
        const camber_u32 line_ends = camber_line_ends(info_before[i - 1], info_after[i + 1]);
        const camber_u32 word =
            cap ? camber_cap_word(row->cap, dot) : camber_join_word(turn, row, CAMBER_METHOD) | line_ends;
        joins[i] = point & CAMBER_POINT_REAL ? word : 0u;
    }
}
