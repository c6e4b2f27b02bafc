/* scan: computes exclusive prefix sums of the counts within each block of CAMBER_BLOCK points, by chunks of
 * CAMBER_POINT_CHUNK points, and each block's sum. There is one work-group per block, and one work-item per chunk: sums
 * over 32 lanes are a tenth of the work of sums over 256, and if one item takes the whole block, there is only its sum.
 * Reads joins[n + 2], info[n + 2]; writes offsets[n / CAMBER_POINT_CHUNK] and sums[n / CAMBER_BLOCK], both vertices |
 * indices << 16. There are few sums of blocks; the host adds them up in 64 bits, which gives the sizes. joins_before is
 * joins again, for the vectoriser's sake. */
#include "join.h"

#define LANES (CAMBER_BLOCK / CAMBER_POINT_CHUNK)

CAMBER_KERNEL(LANES, scan,
              (global const camber_u32 *restrict joins, global const camber_u32 *restrict joins_before,
               global const camber_u32 *restrict info, global camber_u32 *restrict offsets,
               global camber_u32 *restrict sums),
              (joins, joins_before, info, offsets, sums)) {
    const size_t first = CAMBER_WORK_ITEM * CAMBER_POINT_CHUNK + 1;
    camber_u32 own = 0;
#pragma clang loop vectorize_width(16)
    for (size_t n = 0; n < CAMBER_POINT_CHUNK; n++)
        own += camber_join_counts(joins[first + n], joins_before[first + n - 1], info[first + n], CAMBER_METHOD);
#if LANES == 1
    offsets[CAMBER_WORK_ITEM] = 0u;
    sums[CAMBER_WORK_ITEM] = own;
#else
    local camber_u32 total[2][LANES];
    const size_t lane = get_local_id(0);
    total[0][lane] = own;
    camber_u32 from = 0;
    for (camber_u32 step = 1; step < LANES; step *= 2) {
        barrier(CLK_LOCAL_MEM_FENCE);
        total[1 - from][lane] = total[from][lane] + (lane >= step ? total[from][lane >= step ? lane - step : 0] : 0u);
        from = 1 - from;
    }
    offsets[get_global_id(0)] = total[from][lane] - own;
    if (lane == LANES - 1)
        sums[get_group_id(0)] = total[from][lane];
#endif
}
