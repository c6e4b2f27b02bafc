/* bin_count: counts for each chunk of segments how many of them each tile has. A work-item takes a chunk.
 * Reads segments[CAMBER_SEGMENT_WORDS * segment_count], boxes[segment_count], tile_bits[segment_count]. Writes
 * counts[chunks * tiles]. */
#include "bin.h"

/* Counts a segment with a large box in each tile of it that it touches. */
static __attribute__((noinline)) void count_in_box(global const float *segment, camber_u32 box, camber_tile_grid of,
                                                   global camber_u32 *own) {
    camber_u32 first[CAMBER_LANES], last[CAMBER_LANES];
    for (camber_u32 y = CAMBER_BOX_FIRST_Y(box); y <= CAMBER_BOX_LAST_Y(box); y += CAMBER_LANES) {
        const camber_u32 rows = find_rows(segment, box, y, &of, first, last);
        for (camber_u32 j = 0; j < rows; j++)
            for (camber_u32 x = first[j]; x <= last[j]; x++)
                own[(y + j) * of.columns + x]++;
    }
}

CAMBER_KERNEL(1, bin_count,
              (global const float *restrict segments, global const camber_u32 *restrict boxes,
               global const camber_u32 *restrict tile_bits, global camber_u32 *restrict counts,
               const camber_bin_args c),
              (segments, boxes, tile_bits, counts, c)) {
    const size_t chunk = CAMBER_WORK_ITEM, first = chunk * c.a_chunk;
    const size_t end = first + c.a_chunk < c.segment_count ? first + c.a_chunk : c.segment_count;
    const camber_u32 columns = c.of.columns;
    global camber_u32 *own = counts + chunk * c.tiles;
    for (size_t i = 0; i < c.tiles / 16; i++)
        vstore16((uint16)(0u), i, own);
    for (size_t i = first; i < end; i++) {
        const camber_u32 bits = tile_bits[i];
        if (bits == CAMBER_TILE_BITS_ASK) {
            count_in_box(segments + CAMBER_SEGMENT_WORDS * i, boxes[i], c.of, own);
            continue;
        }
        global camber_u32 *from = own + CAMBER_BOX_FIRST_Y(boxes[i]) * columns + CAMBER_BOX_FIRST_X(boxes[i]);
        for (camber_u32 left = bits; left; left &= left - 1u)
            from[tile_of_bit(left, columns)]++;
    }
}
