/* The lists that segments go to: those of tiles, and, behind them, those of rows of tiles whose tops edges of rings may
 * cross. bin_count and bin_scatter take a chunk of segments each, in the same steps.
 *
 * Most boxes are one tile or two, away from the area's sides, and all segments that have such a box touch each of its
 * tiles. Sixteen of those are looked at together. What they go to is written down first, without a branch: no processor
 * foresees which box is one tile. The others are taken one by one. */
#ifndef CAMBER_BINS_CL
#define CAMBER_BINS_CL

#include "segment.h"

/* Entries of lists that wait to be put: a list's number above LISTED_BITS, below it which segment, from `base` on. A
 * row of tiles and its top have at most LISTED_ROOM, sixteen boxes 3 each. */
#define LISTED_MOST 512
#define LISTED_ROOM (CAMBER_TILES_MAX + 1)
#define LISTED_BITS 12

typedef struct listed {
    camber_u32 entries[LISTED_MOST], count, base;
} listed;

/* Where listed segments go. */
typedef struct bins {
    global const camber_u32 *starts;
    global camber_u32 *own, *lists; /* own: the chunk's counts. lists: NULL where segments are only counted */
} bins;

/* Puts all that waits. base: the segment from which on entries count next. */
static __attribute__((noinline)) void put_listed(const bins *to, listed *l, camber_u32 base) {
    const camber_u32 count = l->count, from = l->base;
    for (camber_u32 i = 0; i < count && !to->lists; i++)
        to->own[l->entries[i] >> LISTED_BITS]++;
    for (camber_u32 i = 0; i < count && to->lists; i++) {
        const camber_u32 list = l->entries[i] >> LISTED_BITS;
        to->lists[to->starts[list] + to->own[list]++] = from + (l->entries[i] & ((1u << LISTED_BITS) - 1u));
    }
    l->count = 0;
    l->base = base;
}

/* Lists segment `which` with any box. */
static __attribute__((noinline)) void list_any(global const float *segments, global const float *edges, camber_u32 box,
                                               camber_u32 which, const camber_bin_args *c, const bins *to, listed *l) {
    const int among_edges = which - c->first_edge < c->edge_count;
    const int is_edge = among_edges && as_uint(edges[camber_edge_brush(which)]) != CAMBER_NO_EDGE;
    global const float *words =
        is_edge ? edges + camber_edge_ends(which) : segments + (size_t)CAMBER_SEGMENT_WORDS * which;
    for (camber_u32 y = CAMBER_BOX_FIRST_Y(box); y <= CAMBER_BOX_LAST_Y(box); y++) {
        const camber_u32 span = camber_tile_span(words, is_edge, box, y, &c->of), row = y * c->of.columns;
        if (l->count > LISTED_MOST - LISTED_ROOM)
            put_listed(to, l, l->base);
        for (camber_u32 x = span & 255u; x <= span >> 8; x++)
            l->entries[l->count++] = (row + x) << LISTED_BITS | (which - l->base);
        if (among_edges && y >= camber_first_top(box))
            l->entries[l->count++] = (c->of.columns * c->of.rows + y) << LISTED_BITS | (which - l->base);
    }
}

/* Sixteen boxes: the entries of the first and the last tile, and of the row whose top lies between them; whether there
 * are these: 1 or 0. A box that is another has none. */
typedef struct sixteen_boxes {
    camber_u32 first[16], last[16], top[16], has_first[16], has_last[16], has_top[16], is_other[16];
} sixteen_boxes;

/* which: the first segment, from a list's base on. */
static inline void look_at_boxes(uint16 box, camber_u32 which, int16 among_edges, camber_tile_grid of,
                                 sixteen_boxes *b) {
    const uint16 numbers = (uint16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15), one = (uint16)(1u);
    const uint16 x0 = box & 255u, y0 = box >> 8 & 255u, x1 = box >> 16 & 255u, y1 = box >> 24;
    /* camber_tile_span: away from two sides of the area, a column of tiles or a row is all that is in the box. */
    const int16 drawn = x0 <= x1, column = (x0 == x1) & (x0 - 1u < of.columns - 2u),
                row = (y0 == y1) & (y0 - 1u < of.rows - 2u);
    const int16 inside = (x1 - x0 + (y1 - y0) <= 1u) & (column | row) & ((y0 == y1) | (y0 > 0u));
    const int16 plain = drawn & inside;
    const uint16 first = y0 * of.columns + x0, last = y1 * of.columns + x1, top = of.columns * of.rows + y1;
    vstore16(first << LISTED_BITS | which + numbers, 0, b->first);
    vstore16(last << LISTED_BITS | which + numbers, 0, b->last);
    vstore16(top << LISTED_BITS | which + numbers, 0, b->top);
    vstore16(as_uint16(plain) & one, 0, b->has_first);
    vstore16(as_uint16(plain & (first != last)) & one, 0, b->has_last);
    vstore16(as_uint16(plain & among_edges & ((y0 != y1) | (y0 == 0u))) & one, 0, b->has_top);
    vstore16(as_uint16(drawn & ~inside), 0, b->is_other);
}

/* Puts the segments of a chunk into their lists, or counts them. */
static __attribute__((noinline)) void bin_chunk(global const float *segments, global const float *edges,
                                                global const camber_u32 *boxes, camber_u32 chunk,
                                                const camber_bin_args *c, const bins *to) {
    const uint16 numbers = (uint16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const camber_u32 from = chunk * c->a_chunk,
                     end = from + c->a_chunk < c->segment_count ? from + c->a_chunk : c->segment_count;
    listed l;
    l.count = 0;
    l.base = from;
    for (camber_u32 i = from; i < end; i += 16) {
        sixteen_boxes b;
        if (l.count > LISTED_MOST - 3 * 16 || i - l.base > (1u << LISTED_BITS) - 16)
            put_listed(to, &l, i);
        look_at_boxes(vload16(0, boxes + i), i - l.base, i + numbers - c->first_edge < c->edge_count, c->of, &b);
        camber_u32 count = l.count;
        for (camber_u32 k = 0; k < 16; k++) {
            l.entries[count] = b.first[k];
            count += b.has_first[k];
            l.entries[count] = b.last[k];
            count += b.has_last[k];
            l.entries[count] = b.top[k];
            count += b.has_top[k];
            if (b.is_other[k]) {
                l.count = count;
                list_any(segments, edges, boxes[i + k], i + k, c, to, &l);
                if (l.count > LISTED_MOST - 3 * 16)
                    put_listed(to, &l, l.base);
                count = l.count;
            }
        }
        l.count = count;
    }
    put_listed(to, &l, end);
}

#endif
