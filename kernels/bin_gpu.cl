/* bin_count, bin_scatter and bin_scan on a GPU. Each reads and writes the same bytes as the kernel of its name for
 * CPUs. In the first two a work-group takes a chunk, and its work-items take the segments in turn. In bin_scan a
 * work-item takes a tile. counts[2 * chunks * tiles] has a mark for each count, behind all the counts. */
#include "segment.h"

#if CAMBER_LANES == 1

#define BIN_LANES 32 /* as many as a mark has bits */

kernel __attribute__((reqd_work_group_size(BIN_LANES, 1, 1))) void bin_count(global const float *restrict segments,
                                                                             global const camber_u32 *restrict boxes,
                                                                             global camber_u32 *restrict counts,
                                                                             const camber_bin_args c) {
    const size_t chunk = get_group_id(0), first = chunk * c.a_chunk;
    const size_t end = first + c.a_chunk < c.segment_count ? first + c.a_chunk : c.segment_count;
    const camber_u32 lane = (camber_u32)get_local_id(0);
    const camber_tile_grid of = c.of;
    volatile global camber_u32 *own = counts + chunk * c.tiles, *marks = own + get_num_groups(0) * c.tiles;
    for (camber_u32 i = lane; i < c.tiles; i += BIN_LANES)
        own[i] = marks[i] = 0;
    barrier(CLK_GLOBAL_MEM_FENCE);
    for (size_t i = first + lane; i < end; i += BIN_LANES) {
        const camber_u32 box = boxes[i];
        for (camber_u32 y = CAMBER_BOX_FIRST_Y(box);
             CAMBER_BOX_FIRST_X(box) <= CAMBER_BOX_LAST_X(box) && y <= CAMBER_BOX_LAST_Y(box); y++) {
            const camber_u32 span = camber_tile_span(segments + (size_t)CAMBER_SEGMENT_WORDS * i, box, y, &of);
            for (camber_u32 x = span & 255u; x <= span >> 8; x++)
                atomic_inc(own + y * of.columns + x);
        }
    }
}

/* The turns that 32 segments take in each of their tiles. First each sets its bit in the tile's mark. Then each writes
 * itself into the list, behind those of lower lanes. At last the lowest lane adds all of them to the count. */
enum { TURN_MARK, TURN_PUT, TURN_END, TURNS };

static inline void take_turn(int turn, volatile global camber_u32 *own, volatile global camber_u32 *mark,
                             camber_u32 start, global camber_u32 *lists, camber_u32 i) {
    const camber_u32 bit = 1u << get_local_id(0), before = bit - 1u;
    if (turn == TURN_MARK) {
        atomic_or(mark, bit);
    } else if (turn == TURN_PUT) {
        lists[start + *own + popcount(*mark & before)] = i;
    } else {
        const camber_u32 all = atomic_or(mark, 0u); /* 0 if the lowest lane was here already */
        if ((all & bit) != 0u && (all & before) == 0u) {
            *own += popcount(all);
            atomic_xchg(mark, 0u);
        }
    }
}

kernel __attribute__((reqd_work_group_size(BIN_LANES, 1, 1))) void bin_scatter(global const float *restrict segments,
                                                                               global const camber_u32 *restrict boxes,
                                                                               global const camber_u32 *restrict starts,
                                                                               global camber_u32 *restrict counts,
                                                                               global camber_u32 *restrict lists,
                                                                               const camber_bin_args c) {
    const camber_tile_grid of = c.of;
    const camber_u32 chunk = (camber_u32)get_group_id(0), first = chunk * c.a_chunk;
    const camber_u32 end = first + c.a_chunk < c.segment_count ? first + c.a_chunk : c.segment_count;
    volatile global camber_u32 *own = counts + (size_t)chunk * c.tiles, *marks = own + get_num_groups(0) * c.tiles;
    for (camber_u32 from = first; from < end; from += BIN_LANES) {
        const camber_u32 i = from + (camber_u32)get_local_id(0), box = i < end ? boxes[i] : CAMBER_NO_BOX;
        for (int turn = 0; turn < TURNS; turn++) {
            for (camber_u32 y = CAMBER_BOX_FIRST_Y(box);
                 CAMBER_BOX_FIRST_X(box) <= CAMBER_BOX_LAST_X(box) && y <= CAMBER_BOX_LAST_Y(box); y++) {
                const camber_u32 span = camber_tile_span(segments + (size_t)CAMBER_SEGMENT_WORDS * i, box, y, &of);
                for (camber_u32 x = span & 255u; x <= span >> 8; x++) {
                    const camber_u32 tile = y * of.columns + x;
                    take_turn(turn, own + tile, marks + tile, starts[tile], lists, i);
                }
            }
            barrier(CLK_GLOBAL_MEM_FENCE);
        }
    }
}

#define BIN_SCAN_LANES 64

kernel __attribute__((reqd_work_group_size(BIN_SCAN_LANES, 1, 1))) void bin_scan(global camber_u32 *restrict counts,
                                                                                 global camber_u32 *restrict totals,
                                                                                 const camber_u32 tiles,
                                                                                 const camber_u32 chunks) {
    const size_t tile = get_global_id(0);
    camber_u32 sum = 0;
    for (camber_u32 i = 0; i < chunks && tile < tiles; i++) {
        const camber_u32 here = counts[(size_t)i * tiles + tile];
        counts[(size_t)i * tiles + tile] = sum;
        sum += here;
    }
    if (tile < tiles)
        totals[tile] = sum;
}
#endif
