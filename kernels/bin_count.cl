/* bin_count: counts for each chunk of segments how many of them touch each tile, and, after the tiles, how many edges
 * of rings may cross the top of each row of tiles. A work-item takes a chunk.
 * Reads segments, edges, boxes[segment_count] and bunches, as setup writes them. Writes counts[chunks * lists]. */
#include "bins.cl"

#if !CAMBER_SHARES_TILE /* bins_gpu.cl has it for work-groups */
CAMBER_KERNEL(1, bin_count,
              (global const float *restrict segments, global const float *restrict edges,
               global const camber_u32 *restrict boxes, global const camber_u32 *restrict bunches,
               global camber_u32 *restrict counts, const camber_bin_args c),
              (segments, edges, boxes, bunches, counts, c)) {
    const camber_u32 chunk = (camber_u32)CAMBER_WORK_ITEM;
    const bins to = {0, counts + (size_t)chunk * c.lists, 0};
    for (size_t i = 0; i < c.lists / 16; i++)
        vstore16((uint16)(0u), i, to.own);
    bin_chunk(segments, edges, boxes, bunches, chunk, &c, &to);
}
#endif
