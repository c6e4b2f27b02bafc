/* arc_length_scan: computes how far along its line each slot is, and how long the line is.
 * Reads x, y, info[n + 2] and carries[2 * chunks]: the length of the chunk's first line before the chunk, and of its
 * last line after it. Writes arc_lengths[2 * n]: the distance along the line, and the length of the whole line, in px.
 * A work-item takes a chunk of CAMBER_ARC_LENGTH_CHUNK slots; the host turns arc_length_sum's sums into the carries. */
#include "arc_length.h"

CAMBER_KERNEL(CAMBER_BLOCK / CAMBER_ARC_LENGTH_CHUNK, arc_length_scan,
              (global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
               global const camber_u64 *restrict carries, global float *restrict arc_lengths),
              (x, y, info, carries, arc_lengths)) {
    const size_t chunk = CAMBER_WORK_ITEM, first = chunk * CAMBER_ARC_LENGTH_CHUNK + 1;
    camber_u64 along[CAMBER_ARC_LENGTH_CHUNK];
    camber_u64 sum = carries[2 * chunk];
    for (size_t k = 0; k < CAMBER_ARC_LENGTH_CHUNK; k++) {
        const size_t i = first + k;
        sum = info[i] & CAMBER_POINT_FIRST ? 0 : sum + camber_length_into(x[i] - x[i - 1], y[i] - y[i - 1], info[i]);
        along[k] = sum;
    }
    sum = carries[2 * chunk + 1];
    for (size_t k = CAMBER_ARC_LENGTH_CHUNK; k-- > 0;) {
        const size_t i = first + k;
        sum = info[i] & CAMBER_POINT_LAST ? 0 : sum;
        const camber_u32 real = info[i] & CAMBER_POINT_REAL;
        arc_lengths[2 * (i - 1)] = real ? camber_length_px(along[k]) : 0.0f;
        arc_lengths[2 * (i - 1) + 1] = real ? camber_length_px(along[k] + sum) : 0.0f;
        sum += camber_length_into(x[i] - x[i - 1], y[i] - y[i - 1], info[i]);
    }
}
