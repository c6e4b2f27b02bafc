/* bin_scan: for each tile the segments in the chunks before, and in all of them; sixteen tiles a work-item.
 * Turns counts[chunks * tiles] into sums before each chunk; writes totals[tiles]. */
#include "segment.h"

#if CAMBER_LANES == 16
CAMBER_KERNEL(1, bin_scan,
              (global camber_u32 *restrict counts, global camber_u32 *restrict totals, const camber_u32 tiles,
               const camber_u32 chunks),
              (counts, totals, tiles, chunks)) {
    const size_t at = CAMBER_WORK_ITEM;
    uint16 sum = (uint16)(0u);
    for (camber_u32 i = 0; i < chunks; i++) {
        global camber_u32 *of_chunk = counts + (size_t)i * tiles;
        const uint16 here = vload16(at, of_chunk);
        vstore16(sum, at, of_chunk);
        sum += here;
    }
    vstore16(sum, at, totals);
}
#endif
