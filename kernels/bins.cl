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

/* 1 where a number is below 0, and where it is not 0. No comparisons: oclgrind 21.10 gets their negation wrong. */
#define BELOW_0(x) ((camber_u32)(x) >> 31)
#define NOT_0(x) min(x, 1u)

/* from: the first segment; base: the one from which on entries count. A loop, which the compiler makes vectors of. */
static inline void look_at_boxes(global const camber_u32 *boxes, camber_u32 from, camber_u32 base,
                                 const camber_bin_args *c, sixteen_boxes *b) {
    const camber_u32 columns = c->of.columns, rows = c->of.rows, edges = c->edge_count;
#pragma clang loop vectorize_width(16)
    for (camber_u32 k = 0; k < 16; k++) {
        const camber_u32 box = boxes[from + k], entry = from - base + k, edge = from - c->first_edge + k;
        const camber_u32 x0 = box & 255u, y0 = box >> 8 & 255u, x1 = box >> 16 & 255u, y1 = box >> 24;
        const camber_u32 wide = x1 - x0, high = y1 - y0, undrawn = BELOW_0(wide), at_top = BELOW_0(y0 - 1u);
        const camber_u32 among_edges = 1u - NOT_0(BELOW_0(edge) + BELOW_0(edges - 1u - edge));
        /* camber_tile_span: away from two sides of the area, a column of tiles or a row is all that is in the box. */
        const camber_u32 at_sides = BELOW_0(x0 - 1u) | BELOW_0(columns - 2u - x0);
        const camber_u32 at_ends = at_top | BELOW_0(rows - 2u - y0);
        const camber_u32 other =
            NOT_0(BELOW_0(1u - wide - high) | ((wide | at_sides) & (high | at_ends)) | (high & at_top));
        const camber_u32 plain = 1u - NOT_0(undrawn + other);
        b->first[k] = (y0 * columns + x0) << LISTED_BITS | entry;
        b->last[k] = (y1 * columns + x1) << LISTED_BITS | entry;
        b->top[k] = (columns * rows + y1) << LISTED_BITS | entry;
        b->has_first[k] = plain;
        b->has_last[k] = plain & (wide | high);
        b->has_top[k] = plain & among_edges & (high | at_top);
        b->is_other[k] = 1u - NOT_0(undrawn + plain);
    }
}

/* Puts the segments of a chunk into their lists, or counts them. */
static __attribute__((noinline)) void bin_chunk(global const float *segments, global const float *edges,
                                                global const camber_u32 *boxes, camber_u32 chunk,
                                                const camber_bin_args *c, const bins *to) {
    const camber_u32 from = chunk * c->a_chunk,
                     end = from + c->a_chunk < c->segment_count ? from + c->a_chunk : c->segment_count;
    listed l;
    l.count = 0;
    l.base = from;
    for (camber_u32 i = from; i < end; i += 16) {
        sixteen_boxes b;
        if (l.count > LISTED_MOST - 3 * 16 || i - l.base > (1u << LISTED_BITS) - 16)
            put_listed(to, &l, i);
        look_at_boxes(boxes, i, l.base, c, &b);
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
