/* bin_scan: adds up each tile's counts over the chunks. A work-item takes sixteen tiles.
 * Replaces counts[chunks * tiles] by the sums over the chunks before each. Writes totals[tiles]. The host adds the
 * totals up to the starts of the tiles' lists. */
#include "segment.h"

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
