/* bin_scatter: writes the list of each tile, its segments in drawing order. A work-item takes a chunk of segments. It
 * puts them where bin_count and bin_scan have made room, so that the order does not depend on the number of chunks.
 * Behind the tiles' lists come those of rows of tiles, whose tops edges of rings may cross.
 * Reads segments, edges, boxes[segment_count], as setup writes them, and starts[lists]. Advances
 * counts[chunks * lists] to each chunk's end. Writes lists[starts[lists]]. */
#include "segment.h"

/* Puts segment i into the list of each tile of its box that it touches. */
static __attribute__((noinline)) void put_in_tiles(global const float *words, int is_edge, camber_u32 box,
                                                   camber_tile_grid of, global const camber_u32 *starts,
                                                   global camber_u32 *own, global camber_u32 *lists, camber_u32 i) {
    for (camber_u32 y = CAMBER_BOX_FIRST_Y(box); y <= CAMBER_BOX_LAST_Y(box); y++) {
        const camber_u32 span = camber_tile_span(words, is_edge, box, y, &of);
        for (camber_u32 x = span & 255u; x <= span >> 8; x++) {
            const camber_u32 tile = y * of.columns + x;
            lists[starts[tile] + own[tile]++] = i;
        }
    }
}

CAMBER_KERNEL(1, bin_scatter,
              (global const float *restrict segments, global const float *restrict edges,
               global const camber_u32 *restrict boxes, global const camber_u32 *restrict starts,
               global camber_u32 *restrict counts, global camber_u32 *restrict lists, const camber_bin_args c),
              (segments, edges, boxes, starts, counts, lists, c)) {
    const size_t chunk = CAMBER_WORK_ITEM, first = chunk * c.a_chunk;
    const size_t end = first + c.a_chunk < c.segment_count ? first + c.a_chunk : c.segment_count;
    const camber_tile_grid of = c.of;
    global camber_u32 *own = counts + chunk * c.lists;
    for (size_t i = first; i < end; i++) {
        const camber_u32 box = boxes[i];
        if (CAMBER_BOX_FIRST_X(box) > CAMBER_BOX_LAST_X(box))
            continue;
        const int among_edges = (camber_u32)i - c.first_edge < c.edge_count;
        if (among_edges)
            for (camber_u32 y = camber_first_top(box); y <= CAMBER_BOX_LAST_Y(box); y++) {
                const camber_u32 list = of.columns * of.rows + y;
                lists[starts[list] + own[list]++] = (camber_u32)i;
            }
        if (camber_box_is_one_tile(box, of.columns)) {
            const camber_u32 tile = CAMBER_BOX_FIRST_Y(box) * of.columns + CAMBER_BOX_FIRST_X(box);
            lists[starts[tile] + own[tile]++] = (camber_u32)i;
            continue;
        }
        const int is_edge = among_edges && as_uint(edges[camber_edge_brush(i)]) != CAMBER_NO_EDGE;
        put_in_tiles(is_edge ? edges + camber_edge_ends(i) : segments + CAMBER_SEGMENT_WORDS * i, is_edge, box, of,
                     starts, own, lists, (camber_u32)i);
    }
}
