/* bin_scatter: writes the list of each tile, its segments in drawing order. A work-item takes a chunk of segments. It
 * puts them where bin_count and bin_scan have made room, so that the order does not depend on the number of chunks.
 * Reads segments[CAMBER_SEGMENT_WORDS * segment_count], boxes[segment_count], tile_bits[segment_count], starts[tiles].
 * Advances counts[chunks * tiles] to each chunk's end. Writes lists[starts[tiles]]. */
#include "bin.h"

/* Puts segment i, which has a large box, into the list of each tile of it that it touches. */
static __attribute__((noinline)) void put_in_box(global const float *segment, camber_u32 box, camber_tile_grid of,
                                                 global const camber_u32 *starts, global camber_u32 *own,
                                                 global camber_u32 *lists, camber_u32 i) {
    camber_u32 first[CAMBER_LANES], last[CAMBER_LANES];
    for (camber_u32 y = CAMBER_BOX_FIRST_Y(box); y <= CAMBER_BOX_LAST_Y(box); y += CAMBER_LANES) {
        const camber_u32 rows = find_rows(segment, box, y, &of, first, last);
        for (camber_u32 j = 0; j < rows; j++)
            for (camber_u32 x = first[j]; x <= last[j]; x++) {
                const camber_u32 tile = (y + j) * of.columns + x;
                lists[starts[tile] + own[tile]++] = i;
            }
    }
}

CAMBER_KERNEL(1, bin_scatter,
              (global const float *restrict segments, global const camber_u32 *restrict boxes,
               global const camber_u32 *restrict tile_bits, global const camber_u32 *restrict starts,
               global camber_u32 *restrict counts, global camber_u32 *restrict lists, const camber_bin_args c),
              (segments, boxes, tile_bits, starts, counts, lists, c)) {
    const size_t chunk = CAMBER_WORK_ITEM, first = chunk * c.a_chunk;
    const size_t end = first + c.a_chunk < c.segment_count ? first + c.a_chunk : c.segment_count;
    const camber_u32 columns = c.of.columns;
    global camber_u32 *own = counts + chunk * c.tiles;
    for (size_t i = first; i < end; i++) {
        const camber_u32 bits = tile_bits[i];
        if (bits == CAMBER_TILE_BITS_ASK) {
            put_in_box(segments + CAMBER_SEGMENT_WORDS * i, boxes[i], c.of, starts, own, lists, (camber_u32)i);
            continue;
        }
        const camber_u32 from = CAMBER_BOX_FIRST_Y(boxes[i]) * columns + CAMBER_BOX_FIRST_X(boxes[i]);
        for (camber_u32 left = bits; left; left &= left - 1u) {
            const camber_u32 tile = from + tile_of_bit(left, columns);
            lists[starts[tile] + own[tile]++] = (camber_u32)i;
        }
    }
}
