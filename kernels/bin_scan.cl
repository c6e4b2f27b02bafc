/* bin_scan: adds up each list's counts over the chunks. A work-item takes sixteen lists.
 * Replaces counts[chunks * lists] by the sums over the chunks before each. Writes totals[lists]. The host adds the
 * totals up to the starts of the lists. */
#include "cells.h"

#if !CAMBER_SHARES_TILE /* bins_gpu.cl has it for work-groups */
CAMBER_KERNEL(1, bin_scan,
              (global camber_u32 *restrict counts, global camber_u32 *restrict totals, const camber_u32 lists,
               const camber_u32 chunks),
              (counts, totals, lists, chunks)) {
    const size_t at = CAMBER_WORK_ITEM;
    uint16 sum = (uint16)(0u);
    for (camber_u32 i = 0; i < chunks; i++) {
        global camber_u32 *of_chunk = counts + (size_t)i * lists;
        const uint16 here = vload16(at, of_chunk);
        vstore16(sum, at, of_chunk);
        sum += here;
    }
    vstore16(sum, at, totals);
}
#endif
