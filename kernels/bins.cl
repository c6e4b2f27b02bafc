/* The lists that segments are added to: one for each tile and, after these, one for each row of tiles, with the edges
 * of rings that may cross its top. bin_count and bin_scatter take a chunk of segments each, in the same steps.
 *
 * A bunch of edges gets one entry. Most boxes of other segments are one tile or two, away from the sides of the area;
 * a segment with such a box touches all of its tiles. These are handled sixteen at a time. First the entries are
 * written to a queue without a branch, since no processor can predict which box is a single tile. The other boxes are
 * handled one by one. */
#ifndef CAMBER_BINS_CL
#define CAMBER_BINS_CL

#include "cells.h"

#if !CAMBER_SHARES_TILE

/* Queued entries of lists: the list's number above LISTED_BITS, below it the segment's number relative to `base`, with
 * LISTED_BUNCH for a bunch. A row of tiles and its top have at most LISTED_ROOM entries, sixteen boxes have 3 each,
 * and a bunch and its edges have at most LISTED_SIXTEEN. */
#define LISTED_MOST 512
#define LISTED_ROOM (CAMBER_TILES_MAX + 1)
#define LISTED_BITS 13
#define LISTED_SIXTEEN (CAMBER_BUNCH_SIDE * (CAMBER_BUNCH_SIDE + 16))
#define LISTED_BUNCH 0x1000u

typedef struct listed {
    camber_u32 entries[LISTED_MOST], count, base;
} listed;

/* The lists that queued entries are added to, or their counts. */
typedef struct bins {
    global const camber_u32 *starts;
    global camber_u32 *own, *lists; /* own: the chunk's counts. lists: NULL if segments are only counted */
} bins;

/* Adds all queued entries to their lists, or counts them. base: the segment that further entries are relative to. */
static __attribute__((noinline)) void put_listed(const bins *to, listed *l, camber_u32 base) {
    const camber_u32 count = l->count, from = l->base;
    for (camber_u32 i = 0; i < count && !to->lists; i++)
        to->own[l->entries[i] >> LISTED_BITS]++;
    for (camber_u32 i = 0; i < count && to->lists; i++) {
        const camber_u32 list = l->entries[i] >> LISTED_BITS, which = l->entries[i] & (LISTED_BUNCH - 1u);
        const camber_u32 bunch = l->entries[i] & LISTED_BUNCH ? CAMBER_LISTED_BUNCH : 0u;
        to->lists[to->starts[list] + to->own[list]++] = (from + which) | bunch;
    }
    l->count = 0;
    l->base = base;
}

#ifdef CAMBER_AHEAD_OF_TIME /* with eight lanes Oclgrind comes to other tiles */
#define ROWS_ABREAST 8u
CAMBER_ROW_ENDS(float8)

/* Whether a box has two to eight rows and columns. */
static inline int has_few_rows(camber_u32 box) {
    const camber_u32 wide = CAMBER_BOX_LAST_X(box) - CAMBER_BOX_FIRST_X(box);
    const camber_u32 high = CAMBER_BOX_LAST_Y(box) - CAMBER_BOX_FIRST_Y(box);
    return wide - 1u < ROWS_ABREAST - 1u && high - 1u < ROWS_ABREAST - 1u;
}

/* Lists a segment with such a box that is not among edges. All rows are looked at side by side, as camber_row_span does
 * for one, and the tiles become the bits of a word, eight for each row, so that there is only one loop. */
static inline void list_in_rows(global const float *segment, camber_u32 box, camber_u32 which, const camber_bin_args *c,
                                listed *l) {
    const uint8 numbers = {0, 1, 2, 3, 4, 5, 6, 7}, one = (uint8)(1u), two = (uint8)(2u), none = (uint8)(0u);
    const camber_u32 x0 = CAMBER_BOX_FIRST_X(box), y0 = CAMBER_BOX_FIRST_Y(box), x1 = CAMBER_BOX_LAST_X(box),
                     y1 = CAMBER_BOX_LAST_Y(box), first = (y0 * c->of.columns + x0) << LISTED_BITS | (which - l->base);
    const float8 first_x = (float8)((float)x0), last_x = (float8)((float)x1);
    camber_tile_line line;
    camber_row_reach reach;
    float8 from = first_x, to = last_x;
    camber_tile_line_of(segment, &line);
    camber_row_reach_of(&line, c->of.left, &reach);
    if (!reach.level)
        camber_row_ends(&reach, c->of.top + (convert_float8(y0 + numbers) + 0.5f) * CAMBER_TILE_PX, &from, &to);
    const int8 touches = !(from > last_x) & !(to < first_x) & (numbers <= y1 - y0);
    const float8 begin = from > first_x ? from : first_x, end = to < last_x ? to : last_x;
    const uint8 whole = as_uint8(convert_int8(touches ? begin : first_x));
    const uint8 low = (convert_float8(whole) < begin ? whole + 1u : whole) - x0,
                high = as_uint8(convert_int8(touches ? end : first_x)) - x0;
    const uint8 rows = touches ? (two << high) - (one << low) : none;
    camber_u32 count = l->count;
    for (ulong left = __builtin_astype(__builtin_convertvector(rows, uchar8), ulong); left; left &= left - 1) {
        const camber_u32 tile = (camber_u32)popcount((left - 1) & ~left);
        l->entries[count++] = first + ((tile / ROWS_ABREAST * c->of.columns + tile % ROWS_ABREAST) << LISTED_BITS);
    }
    l->count = count;
}
#endif

/* Lists segment `which` with any box. */
static __attribute__((noinline)) void list_any(global const float *segments, global const float *edges, camber_u32 box,
                                               camber_u32 which, const camber_bin_args *c, const bins *to, listed *l) {
    const int among_edges = which - c->first_edge < c->edge_count;
    const int is_edge = among_edges && as_uint(edges[camber_edge_brush(which)]) != CAMBER_NO_EDGE;
    global const float *words =
        is_edge ? edges + camber_edge_ends(which) : segments + (size_t)CAMBER_SEGMENT_WORDS * which;
#ifdef CAMBER_AHEAD_OF_TIME
    if (l->count > LISTED_MOST - LISTED_ROOM)
        put_listed(to, l, l->base);
    if (!among_edges && has_few_rows(box)) {
        list_in_rows(words, box, which, c, l);
        return;
    }
#endif
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

/* Lists a bunch of edges in all tiles of its box, and each of its edges in the rows whose tops it may cross. boxes:
 * those of the sixteen edges, of which `from` is the number of the first. */
static inline void list_bunch(global const camber_u32 *boxes, camber_u32 bunch, camber_u32 from,
                              const camber_bin_args *c, listed *l) {
    const camber_u32 entry = LISTED_BUNCH | (from - l->base + CAMBER_BUNCH_FIRST(bunch));
    for (camber_u32 y = CAMBER_BUNCH_Y(bunch); y <= CAMBER_BUNCH_LAST_Y(bunch); y++) {
        const camber_u32 top = (c->of.columns * c->of.rows + y) << LISTED_BITS;
        for (camber_u32 x = CAMBER_BUNCH_X(bunch); x <= CAMBER_BUNCH_LAST_X(bunch); x++)
            l->entries[l->count++] = (y * c->of.columns + x) << LISTED_BITS | entry;
        for (camber_u32 k = 0; k < 16 && (y == 0 || y > CAMBER_BUNCH_Y(bunch)); k++) {
            const camber_u32 box = boxes[k];
            l->entries[l->count] = top | (from - l->base + k);
            l->count += box != CAMBER_NO_BOX && y >= camber_first_top(box) && y <= CAMBER_BOX_LAST_Y(box);
        }
    }
}

/* Sixteen boxes: the entries of the first and the last tile, and of the row whose top is between them; and whether each
 * of them exists, 1 or 0. A box of another kind has none of them. */
typedef struct sixteen_boxes {
    camber_u32 first[16], last[16], top[16], has_first[16], has_last[16], has_top[16], is_other[16];
} sixteen_boxes;

/* 1 if a number is below 0, and 1 if it is not 0. These are not comparisons, because oclgrind 21.10 gets their negation
 * wrong. */
#define BELOW_0(x) ((camber_u32)(x) >> 31)
#define NOT_0(x) min(x, 1u)

/* Finds the entries of sixteen boxes. from: the first segment; base: the segment that entries are relative to. The
 * compiler vectorises this loop. */
static inline void look_at_boxes(global const camber_u32 *boxes, camber_u32 from, camber_u32 base,
                                 const camber_bin_args *c, sixteen_boxes *b) {
    const camber_u32 columns = c->of.columns, rows = c->of.rows, edges = c->edge_count;
#pragma clang loop vectorize_width(16)
    for (camber_u32 k = 0; k < 16; k++) {
        const camber_u32 box = boxes[from + k], entry = from - base + k, edge = from - c->first_edge + k;
        const camber_u32 x0 = box & 255u, y0 = box >> 8 & 255u, x1 = box >> 16 & 255u, y1 = box >> 24;
        const camber_u32 wide = x1 - x0, high = y1 - y0, undrawn = BELOW_0(wide), at_top = BELOW_0(y0 - 1u);
        const camber_u32 among_edges = 1u - NOT_0(BELOW_0(edge) + BELOW_0(edges - 1u - edge));
        /* camber_tile_span: away from two sides of the area, a box of one column or row of tiles has all of its tiles.
         */
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

/* Prefetches sixteen segments. Those whose box is neither one tile nor two are read next. */
static inline void ask_for_segments(global const float *segments) {
#ifdef CAMBER_AHEAD_OF_TIME
    for (size_t k = 0; k < 16; k++)
        __builtin_prefetch(segments + CAMBER_SEGMENT_WORDS * k);
#else
    (void)segments;
#endif
}

/* Adds the segments of a chunk to their lists, or counts them. */
static __attribute__((noinline)) void bin_chunk(global const float *segments, global const float *edges,
                                                global const camber_u32 *boxes, global const camber_u32 *bunches,
                                                camber_u32 chunk, const camber_bin_args *c, const bins *to) {
    const camber_u32 from = chunk * c->a_chunk,
                     end = from + c->a_chunk < c->segment_count ? from + c->a_chunk : c->segment_count;
    listed l;
    l.count = 0;
    l.base = from;
    for (camber_u32 i = from; i < end; i += 16) {
        sixteen_boxes b;
        if (l.count > LISTED_MOST - LISTED_SIXTEEN || i - l.base > LISTED_BUNCH - 16)
            put_listed(to, &l, i);
        const camber_u32 bunch = i - c->first_edge < c->edge_count ? bunches[i / 16] : CAMBER_NO_BUNCH;
        if (bunch != CAMBER_NO_BUNCH) {
            list_bunch(boxes + i, bunch, i, c, &l);
            continue;
        }
        if (i - c->first_edge >= c->edge_count)
            ask_for_segments(segments + CAMBER_SEGMENT_WORDS * (size_t)(i + 16));
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

#endif
