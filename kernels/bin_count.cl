/* bin_count: counts for each chunk of segments how many of them each tile has, and, behind the tiles, how many of
 * those among which the edges of rings are may cross the top of each row of tiles. A work-item takes a chunk.
 * Reads segments, edges, boxes[segment_count], as setup writes them. Writes counts[chunks * lists]. */
#include "segment.h"

/* Counts a segment in each tile of its box that it touches. A function of its own, so that the loop over segments, most
 * of which lie in one tile, keeps its numbers in registers. */
static __attribute__((noinline)) void count_in_tiles(global const float *words, int is_edge, camber_u32 box,
                                                     camber_tile_grid of, global camber_u32 *own) {
    for (camber_u32 y = CAMBER_BOX_FIRST_Y(box); y <= CAMBER_BOX_LAST_Y(box); y++) {
        const camber_u32 span = camber_tile_span(words, is_edge, box, y, &of);
        for (camber_u32 x = span & 255u; x <= span >> 8; x++)
            own[y * of.columns + x]++;
    }
}

CAMBER_KERNEL(1, bin_count,
              (global const float *restrict segments, global const float *restrict edges,
               global const camber_u32 *restrict boxes, global camber_u32 *restrict counts, const camber_bin_args c),
              (segments, edges, boxes, counts, c)) {
    const size_t chunk = CAMBER_WORK_ITEM, first = chunk * c.a_chunk;
    const size_t end = first + c.a_chunk < c.segment_count ? first + c.a_chunk : c.segment_count;
    const camber_tile_grid of = c.of;
    global camber_u32 *own = counts + chunk * c.lists;
    for (size_t i = 0; i < c.lists / 16; i++)
        vstore16((uint16)(0u), i, own);
    for (size_t i = first; i < end; i++) {
        const camber_u32 box = boxes[i];
        if (CAMBER_BOX_FIRST_X(box) > CAMBER_BOX_LAST_X(box))
            continue;
        const int among_edges = (camber_u32)i - c.first_edge < c.edge_count;
        if (among_edges)
            for (camber_u32 y = camber_first_top(box); y <= CAMBER_BOX_LAST_Y(box); y++)
                own[of.columns * of.rows + y]++;
        if (camber_box_is_one_tile(box, of.columns)) {
            own[CAMBER_BOX_FIRST_Y(box) * of.columns + CAMBER_BOX_FIRST_X(box)]++;
            continue;
        }
        const int is_edge = among_edges && as_uint(edges[camber_edge_brush(i)]) != CAMBER_NO_EDGE;
        count_in_tiles(is_edge ? edges + camber_edge_ends(i) : segments + CAMBER_SEGMENT_WORDS * i, is_edge, box, of,
                       own);
    }
}
