/* bin_count, bin_scan and bin_scatter for GPUs: bin_count.cl, bin_scan.cl and bin_scatter.cl say what is read and
 * written. A work-group takes a chunk, and each of its work-items one segment at a time.
 *
 * A segment and a list that it is added to are a pair. The work-items of a group write their pairs to local memory, in
 * the order of the segments, as many as there is room for. A pair's rank is how many pairs before it have the same
 * list: it says where in the list the segment belongs, and the last pair of a list, how many there are. So lists have
 * the order of the segments, as those of a CPU, without an atomic. */
#ifndef CAMBER_BINS_GPU_CL
#define CAMBER_BINS_GPU_CL

#include "segment.h"

#include "cells.h"

#if CAMBER_SHARES_TILE

#define WINDOW (2u * CAMBER_TILE_ITEMS)

typedef struct pair_window {
    camber_u32 lists[WINDOW], entries[WINDOW];
    camber_u32 ends[CAMBER_TILE_ITEMS]; /* the pairs of each work-item and of those before it */
} pair_window;

/* A segment, and what it is added to. */
typedef struct listed_segment {
    camber_u32 which, entry; /* entry: of lists of tiles */
    camber_u32 box, first_top;
    camber_u32 has_tiles, has_tops, has_all; /* has_all: all tiles of the box, which is that of a bunch */
    camber_u32 is_edge;
    global const float *words;
} listed_segment;

static inline listed_segment listed_segment_of(global const float *segments, global const float *edges,
                                               global const camber_u32 *boxes, global const camber_u32 *bunches,
                                               const camber_bin_args *c, camber_u32 which) {
    const camber_u32 among_edges = which - c->first_edge < c->edge_count ? 1u : 0u;
    const camber_u32 bunch = among_edges ? bunches[which / 16u] : CAMBER_NO_BUNCH, box = boxes[which];
    const camber_u32 is_edge = among_edges && as_uint(edges[camber_edge_brush(which)]) != CAMBER_NO_EDGE;
    listed_segment s = {which,
                        which,
                        box,
                        camber_first_top(box),
                        box != CAMBER_NO_BOX,
                        box != CAMBER_NO_BOX && among_edges,
                        0u,
                        is_edge,
                        is_edge ? edges + camber_edge_ends(which) : segments + (size_t)CAMBER_SEGMENT_WORDS * which};
    if (bunch != CAMBER_NO_BUNCH) {
        s.has_tiles = which % 16u == CAMBER_BUNCH_FIRST(bunch);
        s.has_all = 1u;
        s.entry = which | CAMBER_LISTED_BUNCH;
    }
    return s;
}

/* Returns the tiles of a row that a segment touches: first | last << 8. */
static inline camber_u32 span_of(const listed_segment *s, camber_u32 box, camber_u32 y, const camber_bin_args *c) {
    return s->has_all ? CAMBER_BOX_FIRST_X(box) | CAMBER_BOX_LAST_X(box) << 8
                      : camber_tile_span(s->words, s->is_edge, box, y, &c->of);
}

/* Returns the box of the tiles that a segment, or its bunch, may touch. */
static inline camber_u32 tiles_of(const listed_segment *s, global const camber_u32 *bunches) {
    if (!s->has_all)
        return s->box;
    const camber_u32 bunch = bunches[s->which / 16u];
    return CAMBER_BUNCH_X(bunch) | CAMBER_BUNCH_Y(bunch) << 8 | CAMBER_BUNCH_LAST_X(bunch) << 16 |
           CAMBER_BUNCH_LAST_Y(bunch) << 24;
}

/* Returns how many pairs a segment has. */
CAMBER_NOINLINE camber_u32 count_pairs(const listed_segment *s, global const camber_u32 *bunches,
                                       const camber_bin_args *c) {
    camber_u32 count = 0;
    const camber_u32 box = s->has_tiles ? tiles_of(s, bunches) : 0u;
    for (camber_u32 y = CAMBER_BOX_FIRST_Y(box); s->has_tiles && y <= CAMBER_BOX_LAST_Y(box); y++) {
        const camber_u32 span = span_of(s, box, y, c);
        count += (span >> 8) + 1u > (span & 255u) ? (span >> 8) + 1u - (span & 255u) : 0u;
    }
    if (s->has_tops && CAMBER_BOX_LAST_Y(s->box) + 1u > s->first_top)
        count += CAMBER_BOX_LAST_Y(s->box) + 1u - s->first_top;
    return count;
}

/* Writes those of a segment's pairs that are in the window. at: the place of its first one in the window, modulo 2^32.
 */
CAMBER_FN CAMBER_INLINE void write_pairs(local pair_window *w, const listed_segment *s,
                                         global const camber_u32 *bunches, const camber_bin_args *c, camber_u32 at) {
    const camber_u32 box = s->has_tiles ? tiles_of(s, bunches) : 0u;
    for (camber_u32 y = CAMBER_BOX_FIRST_Y(box); s->has_tiles && y <= CAMBER_BOX_LAST_Y(box); y++) {
        const camber_u32 span = span_of(s, box, y, c);
        for (camber_u32 x = span & 255u; x <= span >> 8; x++, at++)
            if (at < WINDOW) {
                w->lists[at] = y * c->of.columns + x;
                w->entries[at] = s->entry;
            }
    }
    for (camber_u32 y = s->first_top; s->has_tops && y <= CAMBER_BOX_LAST_Y(s->box); y++, at++)
        if (at < WINDOW) {
            w->lists[at] = c->of.columns * c->of.rows + y;
            w->entries[at] = s->which;
        }
}

/* Where a pair is among those of its list in the window. */
typedef struct pair_rank {
    camber_u32 before; /* how many are before it */
    camber_u32 is_last;
} pair_rank;

CAMBER_FN CAMBER_INLINE void find_rank(local const pair_window *w, camber_u32 pair, camber_u32 count, pair_rank *rank) {
    const camber_u32 list = w->lists[pair];
    camber_u32 before = 0, after = 0;
    for (camber_u32 i = 0; i < count; i++) {
        const camber_u32 same = w->lists[i] == list ? 1u : 0u;
        before += i < pair ? same : 0u;
        after += i > pair ? same : 0u;
    }
    rank->before = before;
    rank->is_last = after == 0u;
}

/* Adds a work-item's count up over all before it. Barriers are inside; the first is for those who still read the ends
 * that were there before. */
CAMBER_FN CAMBER_INLINE void sum_up(local camber_u32 *ends, camber_u32 item, camber_u32 count) {
    barrier(CLK_LOCAL_MEM_FENCE);
    ends[item] = count;
    for (camber_u32 step = 1u; step < CAMBER_TILE_ITEMS; step *= 2u) {
        barrier(CLK_LOCAL_MEM_FENCE);
        const camber_u32 more = item >= step ? ends[item - step] : 0u;
        barrier(CLK_LOCAL_MEM_FENCE);
        ends[item] += more;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

/* The lists that pairs are added to, or their counts. */
typedef struct bins {
    global const camber_u32 *starts;
    global camber_u32 *own, *lists; /* own: the chunk's counts. lists: NULL if pairs are only counted */
} bins;

/* Adds the first `count` pairs of the window to their lists, or counts them. Barriers are inside; one must be before.
 */
CAMBER_FN CAMBER_INLINE void put_pairs(local const pair_window *w, camber_u32 count, camber_u32 item, const bins *to) {
    pair_rank ranks[WINDOW / CAMBER_TILE_ITEMS];
    for (camber_u32 i = 0, pair = item; pair < count; i++, pair += CAMBER_TILE_ITEMS) {
        const camber_u32 list = w->lists[pair];
        find_rank(w, pair, count, ranks + i);
        if (to->lists)
            to->lists[to->starts[list] + to->own[list] + ranks[i].before] = w->entries[pair];
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    for (camber_u32 i = 0, pair = item; pair < count; i++, pair += CAMBER_TILE_ITEMS)
        if (ranks[i].is_last)
            to->own[w->lists[pair]] += ranks[i].before + 1u;
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
}

/* Adds the segments of a chunk to their lists, or counts them. */
CAMBER_FN CAMBER_INLINE void bin_chunk(local pair_window *w, global const float *segments, global const float *edges,
                                       global const camber_u32 *boxes, global const camber_u32 *bunches,
                                       camber_u32 chunk, const camber_bin_args *c, const bins *to) {
    const camber_u32 item = (camber_u32)get_local_id(0);
    const camber_u32 from = chunk * c->a_chunk, end = min(from + c->a_chunk, c->segment_count);
    for (camber_u32 first = from; first < end; first += CAMBER_TILE_ITEMS) {
        const camber_u32 which = min(first + item, end - 1u);
        const listed_segment s = listed_segment_of(segments, edges, boxes, bunches, c, which);
        const camber_u32 count = first + item < end ? count_pairs(&s, bunches, c) : 0u;
        sum_up(w->ends, item, count);
        const camber_u32 all = w->ends[CAMBER_TILE_ITEMS - 1u], at = w->ends[item] - count;
        for (camber_u32 begin = 0; begin < all; begin += WINDOW) {
            if (count)
                write_pairs(w, &s, bunches, c, at - begin);
            barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
            put_pairs(w, min(all - begin, WINDOW), item, to);
        }
    }
}

kernel __attribute__((reqd_work_group_size(CAMBER_TILE_ITEMS, 1, 1))) void bin_count(
    global const float *restrict segments, global const float *restrict edges, global const camber_u32 *restrict boxes,
    global const camber_u32 *restrict bunches, global camber_u32 *restrict counts, const camber_bin_args c) {
    local pair_window window;
    const camber_u32 chunk = (camber_u32)get_group_id(0);
    const bins to = {0, counts + (size_t)chunk * c.lists, 0};
    for (camber_u32 i = (camber_u32)get_local_id(0); i < c.lists; i += CAMBER_TILE_ITEMS)
        to.own[i] = 0;
    bin_chunk(&window, segments, edges, boxes, bunches, chunk, &c, &to);
}

/* Sixteen lists in each of sixteen parts of the chunks. */
kernel __attribute__((reqd_work_group_size(CAMBER_TILE_ITEMS, 1, 1))) void bin_scan(global camber_u32 *restrict counts,
                                                                                    global camber_u32 *restrict totals,
                                                                                    const camber_u32 lists,
                                                                                    const camber_u32 chunks) {
    local camber_u32 sums[CAMBER_TILE_ITEMS];
    const camber_u32 item = (camber_u32)get_local_id(0), part = item / 16u, a_part = (chunks + 15u) / 16u;
    const camber_u32 first = min(part * a_part, chunks), end = min(first + a_part, chunks);
    global camber_u32 *of_list = counts + 16u * get_group_id(0) + item % 16u;
    camber_u32 sum = 0;
    for (camber_u32 i = first; i < end; i++)
        sum += of_list[(size_t)i * lists];
    sums[item] = sum;
    barrier(CLK_LOCAL_MEM_FENCE);
    sum = 0;
    for (camber_u32 i = 0; i < part; i++)
        sum += sums[16u * i + item % 16u];
    for (camber_u32 i = first; i < end; i++) {
        const camber_u32 here = of_list[(size_t)i * lists];
        of_list[(size_t)i * lists] = sum;
        sum += here;
    }
    if (part == 15u)
        totals[16u * get_group_id(0) + item % 16u] = sum;
}

kernel __attribute__((reqd_work_group_size(CAMBER_TILE_ITEMS, 1, 1))) void bin_scatter(
    global const float *restrict segments, global const float *restrict edges, global const camber_u32 *restrict boxes,
    global const camber_u32 *restrict bunches, global const camber_u32 *restrict starts,
    global camber_u32 *restrict counts, global camber_u32 *restrict lists, const camber_bin_args c) {
    local pair_window window;
    const camber_u32 chunk = (camber_u32)get_group_id(0);
    const bins to = {starts, counts + (size_t)chunk * c.lists, lists};
    bin_chunk(&window, segments, edges, boxes, bunches, chunk, &c, &to);
}

#endif

#endif
