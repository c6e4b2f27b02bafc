/* arc_length_sum: computes how long the lines are within each chunk of slots.
 * Reads x, y, info[n + 2]; writes sums[2 * chunks], with one work-item per chunk of CAMBER_ARC_LENGTH_CHUNK slots. The
 * first sum of a chunk covers the segments after the last point in it that begins a line, and the second sum covers the
 * segments before the first point that ends a line. The lowest bit of the first sum says whether a line begins in the
 * chunk, and the lowest bit of the second says whether a line ends in it. */
#include "arc_length.h"

CAMBER_KERNEL(CAMBER_BLOCK / CAMBER_ARC_LENGTH_CHUNK, arc_length_sum,
              (global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
               global camber_u64 *restrict sums),
              (x, y, info, sums)) {
    const size_t chunk = CAMBER_WORK_ITEM, first = chunk * CAMBER_ARC_LENGTH_CHUNK + 1;
    camber_u64 ahead = 0, behind = 0;
    camber_u32 begins = 0, ends = 0;
    for (size_t i = first; i < first + CAMBER_ARC_LENGTH_CHUNK; i++) {
        const camber_u64 length = camber_length_into(x[i] - x[i - 1], y[i] - y[i - 1], info[i]);
        ahead = info[i] & CAMBER_POINT_FIRST ? 0 : ahead + length;
        behind += ends ? 0 : length;
        begins |= info[i] & CAMBER_POINT_FIRST ? CAMBER_SUM_CLOSED : 0u;
        ends |= info[i] & CAMBER_POINT_LAST ? CAMBER_SUM_CLOSED : 0u;
    }
    sums[2 * chunk] = ahead << CAMBER_SUM_SHIFT | begins;
    sums[2 * chunk + 1] = behind << CAMBER_SUM_SHIFT | ends;
}
