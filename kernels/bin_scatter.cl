/* bin_scatter: writes the list of each tile, its segments in drawing order. A work-item takes a chunk of segments. It
 * writes them to the positions that bin_count and bin_scan have computed, so that the order does not depend on the
 * number of chunks.
 * The tiles' lists are followed by lists for rows of tiles, with the edges of rings that may cross their tops.
 * Reads segments, edges, boxes[segment_count] and bunches, as setup writes them, and starts[lists]. Advances
 * counts[chunks * lists] to each chunk's end. Writes lists[starts[lists]]. */
#include "bins.cl"

#if !CAMBER_SHARES_TILE /* bins_gpu.cl has it for work-groups */
CAMBER_KERNEL(1, bin_scatter,
              (global const float *restrict segments, global const float *restrict edges,
               global const camber_u32 *restrict boxes, global const camber_u32 *restrict bunches,
               global const camber_u32 *restrict starts, global camber_u32 *restrict counts,
               global camber_u32 *restrict lists, const camber_bin_args c),
              (segments, edges, boxes, bunches, starts, counts, lists, c)) {
    const camber_u32 chunk = (camber_u32)CAMBER_WORK_ITEM;
    const bins to = {starts, counts + (size_t)chunk * c.lists, lists};
    bin_chunk(segments, edges, boxes, bunches, chunk, &c, &to);
}
#endif
