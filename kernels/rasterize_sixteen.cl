/* Draws segments of one brush without features, sixteen at a time.
 *
 * Input: the numbers of up to sixteen segments. Their coefficients and cells are computed side by side in vectors, with
 * the same bits as camber_edge_of computes for one. Then all their cells are put into one list and drawn. In one long
 * loop the processor can predict most branches. */
#include "cells.cl"
#include "tile_state.h"
#include "transpose.cl"

/* Segments of a brush are queued until there are this many. */
#define SIXTEEN 16

typedef struct segment_batch {
    uint which[SIXTEEN];
    uint count;
} segment_batch;

#if CAMBER_RASTER_PITCHED
/* With a pitch segments are drawn one by one. */
#define draw_segment_batch(c, at, segments, where, b) ((b)->count = 0)
#else

/* Classes of segments by what their ends need: nothing more, one flat cap or two, of which nothing else counts, or
 * something else, of which sharp joins need most. */
#define ENDS_PLAIN 0u
#define ENDS_CAP_A 1u
#define ENDS_CAP_B 2u
#define ENDS_CAPS 3u
#define ENDS_OTHER 4u
#define ENDS_SHARP 5u

/* Returns the class of each of a vector of segments. */
static inline camber_words ends_of(const camber_edges *p) {
    const camber_real never = CAMBER_REAL(CAMBER_NEVER_PX);
    const camber_mask joined_a = (p->flat_a < never) & p->goes_on_a, joined_b = (p->flat_b < never) & p->goes_on_b;
    const camber_words none = (camber_words)(ENDS_PLAIN), at_a = (camber_words)(ENDS_CAP_A),
                       at_b = (camber_words)(ENDS_CAP_B);
    const camber_words plain = (p->goes_on_a ? none : at_a) | (p->goes_on_b ? none : at_b);
    const camber_words rest = p->sharp ? (camber_words)(ENDS_SHARP) : (camber_words)(ENDS_OTHER);
    return (p->sharp | p->thin | p->tips | joined_a | joined_b) ? rest : plain;
}

/* Takes the coefficients of one of sixteen segments, as if none of its joins were sharp. */
static inline __attribute__((always_inline)) void take_edge(const camber_edges *from, uint k, camber_edge *p) {
    const camber_edges *all = from + k / CAMBER_LANES;
    const int lane = (int)(k % CAMBER_LANES);
#define TAKE(name) p->name = ((const float *)&all->name)[lane]
    TAKE(ax);
    TAKE(ay);
    TAKE(bx);
    TAKE(by);
    TAKE(ux);
    TAKE(uy);
    TAKE(nax);
    TAKE(nay);
    TAKE(nbx);
    TAKE(nby);
    TAKE(half_width);
    TAKE(length);
    TAKE(side.extent);
    TAKE(side.corner);
    TAKE(side.slope);
    TAKE(side.curve);
    TAKE(ca);
    TAKE(cb);
    TAKE(sa);
    TAKE(sb);
    TAKE(round_a);
    TAKE(round_b);
    TAKE(owner_a);
    TAKE(owner_b);
    TAKE(flat_a);
    TAKE(flat_b);
    TAKE(tip_a);
    TAKE(tip_b);
#undef TAKE
    p->end_a = ((const uint *)&all->end_a)[lane];
    p->end_b = ((const uint *)&all->end_b)[lane];
    p->linear = camber_integer_of(&all->linear, lane);
    p->thin = camber_integer_of(&all->thin, lane);
    p->tips = camber_integer_of(&all->tips, lane);
    p->capped = camber_integer_of(&all->capped, lane);
    p->goes_on_a = camber_integer_of(&all->goes_on_a, lane);
    p->goes_on_b = camber_integer_of(&all->goes_on_b, lane);
    p->sharp = 0;
}

/* ---- Cells ---- */

/* Moves four rows of four bits to one byte each. */
static inline camber_words spread(camber_words bits) {
    return (bits & 0xfu) | (bits & 0xf0u) << 4 | (bits & 0xf00u) << 8 | (bits & 0xf000u) << 12;
}

/* The cell_sets of sixteen segments. */
typedef struct batch_sets {
    ulong partial[SIXTEEN], near_end[SIXTEEN], full[SIXTEEN];
} batch_sets;

/* Finds the sets of a vector of segments, and stores them at index v. */
static inline void find_sets(const camber_edges *p, const camber_cell_boxes *b, camber_tile_rows where, size_t v,
                             batch_sets *sets) {
    const int columns = camber_largest_of(b->columns), rows = camber_largest_of(b->rows);
    const camber_real left = (float)CAMBER_CELL_PX * CAMBER_TO_REAL(b->x) + (where.left + 0.5f * CAMBER_CELL_PX);
    const camber_real top = (float)CAMBER_CELL_PX * CAMBER_TO_REAL(b->y) + (where.top + 0.5f * CAMBER_CELL_PX);
    const camber_words none = (camber_words)(0u);
    camber_long_words partial = (camber_long_words)(0ul), near_end = partial, full = partial;
    camber_cell_bounds bounds;
    camber_cell_bounds_of(p, &bounds);
    for (int across = 0; across < columns; across += 4) {
        const int end = columns - across < 4 ? columns - across : 4;
        camber_cell_lines of_column[4];
        camber_words in_box[4];
        for (int i = 0; i < end; i++) {
            camber_cell_lines_across(p, left + (float)(CAMBER_CELL_PX * (across + i)), of_column + i);
            in_box[i] = b->columns > across + i ? (camber_words)(1u << i) : none;
        }
        for (int down = 0; down < rows; down += 4) {
            camber_words meets = none, nears = none, inside = none;
            for (int j = down; j < down + 4 && j < rows; j++) {
                camber_words meets_row = none, nears_row = none, inside_row = none;
                camber_cell_lines of_row;
                camber_cell_lines_down(p, top + (float)(CAMBER_CELL_PX * j), &of_row);
                for (int i = 0; i < end; i++) {
                    camber_cell_masks m;
                    camber_cell_masks_from(&bounds, of_column + i, &of_row, &m);
                    meets_row = m.partial ? meets_row | in_box[i] : meets_row;
                    nears_row = m.near_end ? nears_row | in_box[i] : nears_row;
                    inside_row = m.full ? inside_row | in_box[i] : inside_row;
                }
                const uint at = (uint)(4 * (j - down));
                meets |= (b->rows > j ? meets_row : none) << at;
                nears |= nears_row << at;
                inside |= inside_row << at;
            }
            const camber_long_words first = CAMBER_TO_LONG_WORDS(CAMBER_TILE_CELLS * (b->y + down) + b->x + across);
            partial |= CAMBER_TO_LONG_WORDS(spread(meets)) << first;
            near_end |= CAMBER_TO_LONG_WORDS(spread(nears & meets)) << first;
            full |= CAMBER_TO_LONG_WORDS(spread(inside & meets & ~nears)) << first;
        }
    }
    CAMBER_STORE(partial, v, sets->partial);
    CAMBER_STORE(near_end, v, sets->near_end);
    CAMBER_STORE(full, v, sets->full);
}

#define CELL_NEAR_END 64u
#define CELL_FULL 128u
#define CELL_SEGMENT 8

typedef struct cell_list {
    uint words[SIXTEEN * CAMBER_CELLS + 4]; /* cell | CELL_NEAR_END or CELL_FULL | k << CELL_SEGMENT */
    uint count;
} cell_list;

static inline void list_cells(cell_list *list, ulong cells, uint word) {
    uint at = list->count;
    list->count += (uint)popcount(cells);
#pragma unroll
    for (int i = 0; i < 4; i++, cells &= cells - 1)
        list->words[at++] = word | (uint)camber_lowest(cells);
    for (; cells; cells &= cells - 1)
        list->words[at++] = word | (uint)camber_lowest(cells);
}

/* If the brush is opaque, nothing that it draws shows in a cell that one of the segments fills, so that such a cell is
 * drawn at once, and no other segment into it. Returns the cells that are drawn. */
static inline ulong draw_filled(camber_tile_state *c, const batch_sets *sets, uint count, ulong shut) {
    ulong drawn = 0;
    for (uint k = 0; k < count; k++)
        drawn |= sets->full[k];
    drawn &= ~shut;
    if (!drawn || c->now.mode == CAMBER_BRUSH_UNION || c->now.a != 1.0f)
        return 0;
    for (ulong left = drawn; left; left &= left - 1)
        for (int v = 0; v < CAMBER_VECTORS; v++)
            c->brush[camber_lowest(left)][v] = CAMBER_REAL(0.0f);
    c->brushed |= drawn;
    c->filled |= drawn;
    c->whole |= c->now.mode == CAMBER_BRUSH_SUM ? 0 : drawn;
    return drawn;
}

/* Lists the cells of all segments, segment by segment, except closed cells, through which nothing below shows. Returns
 * which cells are listed. */
static inline ulong list_all(const batch_sets *sets, uint count, ulong shut, cell_list *list) {
    ulong listed = 0;
    list->count = 0;
    for (uint k = 0; k < count; k++) {
        const ulong cells = sets->partial[k] & ~shut, nears = sets->near_end[k] & cells, inside = sets->full[k] & cells;
        const ulong sides = cells & ~(nears | inside);
        listed |= cells;
        list_cells(list, nears, k << CELL_SEGMENT | CELL_NEAR_END);
        if (sides)
            list_cells(list, sides, k << CELL_SEGMENT);
        if (inside)
            list_cells(list, inside, k << CELL_SEGMENT | CELL_FULL);
    }
    return listed;
}

/* ---- Pixels ---- */

/* Everything that a list is drawn from. */
typedef struct list_source {
    const positions *at;
    const camber_edges *all; /* coefficients of sixteen segments */
    const uint *ends;        /* class of each segment's ends */
} list_source;

static inline camber_real list_x(const list_source *d, int i) {
    return d->at->x[i % CAMBER_TILE_CELLS];
}

static inline camber_real list_y(const list_source *d, int i, int v) {
    return d->at->y[i / CAMBER_TILE_CELLS][v];
}

/* Returns the part of an area that flat caps leave. */
static inline camber_real cut_caps(const camber_edge *p, const camber_pixel *at, camber_real area) {
    const camber_real all = CAMBER_REAL(1.0f);
    return camber_between_ends(area, p->goes_on_a ? all : camber_cut_along(p, at, p->flat_a - at->past_a),
                               p->goes_on_b ? all : camber_cut_along(p, at, p->flat_b - at->past_b));
}

/* Computes the areas of a cell's pixels near an end. `ends` is a constant, so that the compiler leaves out code that
 * such ends do not need. Caps are computed last: the area of a neighbour's pixel is 0 and stays 0. */
static inline __attribute__((always_inline)) void find_areas_by(const list_source *d, uint word, uint ends,
                                                                camber_real *area) {
    const int i = (int)(word % CAMBER_CELLS);
    camber_edge p;
    take_edge(d->all, word >> CELL_SEGMENT, &p);
    p.sharp = ends == ENDS_SHARP;
    if (ends <= ENDS_CAPS) {
        p.thin = p.tips = p.capped = 0;
        p.goes_on_a = ends == ENDS_PLAIN || ends == ENDS_CAP_B;
        p.goes_on_b = ends == ENDS_PLAIN || ends == ENDS_CAP_A;
    }
#pragma unroll
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        camber_pixel at;
        camber_look(&p, list_x(d, i), list_y(d, i, v), &at);
        area[v] = camber_edge_area(&p, &at);
        if (ends == ENDS_CAP_A || ends == ENDS_CAP_B || ends == ENDS_CAPS)
            area[v] = cut_caps(&p, &at, area[v]);
    }
}

/* The expensive cases are in a separate function; inlined, they would make the drawing of a list keep everything about
 * a pixel in memory instead of registers. */
static __attribute__((noinline)) void find_other_areas(const list_source *d, uint word, camber_real *area) {
    find_areas_by(d, word, ENDS_OTHER, area);
}

static __attribute__((noinline)) void find_sharp_areas(const list_source *d, uint word, camber_real *area) {
    find_areas_by(d, word, ENDS_SHARP, area);
}

/* Computes the areas of a cell's pixels. Each case takes the edge separately, so that the compiler spreads coefficients
 * over vectors as it loads them. */
static inline __attribute__((always_inline)) void find_areas(const list_source *d, uint word, camber_real *area) {
    const int i = (int)(word % CAMBER_CELLS);
    const uint k = word >> CELL_SEGMENT;
    if (!(word & CELL_NEAR_END)) {
        camber_edge p;
        take_edge(d->all, k, &p);
#pragma unroll
        for (int v = 0; v < CAMBER_VECTORS; v++)
            area[v] = camber_edge_side(&p, list_x(d, i), list_y(d, i, v));
    } else if (d->ends[k] == ENDS_PLAIN) {
        find_areas_by(d, word, ENDS_PLAIN, area);
    } else if (d->ends[k] == ENDS_CAP_A) {
        find_areas_by(d, word, ENDS_CAP_A, area);
    } else if (d->ends[k] == ENDS_CAP_B) {
        find_areas_by(d, word, ENDS_CAP_B, area);
    } else if (d->ends[k] == ENDS_CAPS) {
        find_areas_by(d, word, ENDS_CAPS, area);
    } else {
        camber_real found[CAMBER_VECTORS]; /* an argument by pointer has to be in memory: only this case's area is */
        if (d->ends[k] == ENDS_OTHER)
            find_other_areas(d, word, found);
        else
            find_sharp_areas(d, word, found);
#pragma unroll
        for (int v = 0; v < CAMBER_VECTORS; v++)
            area[v] = found[v];
    }
}

/* Adds the areas of a cell to a union. */
static inline __attribute__((always_inline)) void unite(camber_tile_state *c, const list_source *d, uint word,
                                                        const camber_real *area) {
    const int i = (int)(word % CAMBER_CELLS);
    camber_edge p;
    take_edge(d->all, word >> CELL_SEGMENT, &p);
    const camber_mask thick = CAMBER_ALL_LANES(p.half_width > CAMBER_UNION_PX);
#pragma unroll
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        camber_pixel at;
        camber_real nx, ny;
        camber_look(&p, list_x(d, i), list_y(d, i, v), &at);
        if (word & CELL_NEAR_END)
            camber_edge_normal(&p, &at, &nx, &ny);
        else
            camber_side_normal(&p, at.y, &nx, &ny);
        camber_tile_put_union(c, i, v, area[v], thick, nx, ny);
    }
}

static inline void draw_list(camber_tile_state *c, const list_source *d, const cell_list *list) {
    const int is_union = c->now.mode == CAMBER_BRUSH_UNION;
    for (uint n = 0; n < list->count; n++) {
        const uint word = list->words[n];
        const int i = (int)(word % CAMBER_CELLS);
        camber_real area[CAMBER_VECTORS];
        if ((c->done | c->filled) >> i & 1ul)
            continue;
        if (word & CELL_FULL) {
            camber_tile_put_whole(c, i);
            continue;
        }
        find_areas(d, word, area);
        if (is_union) {
            unite(c, d, word, area);
            continue;
        }
#pragma unroll
        for (int v = 0; v < CAMBER_VECTORS; v++)
            camber_tile_put_over(c, i, v, area[v]);
        camber_tile_count(c, i);
    }
}

/* ---- Sixteen segments ---- */

/* Reads vector v of sixteen segments, one per lane, and computes their coefficients. */
static inline void take_segments(global const float *segments, const uint *which, size_t v, camber_edges *p,
                                 camber_footprint *f) {
#define WORD(name) words[CAMBER_SEGMENT_##name]
    camber_real words[CAMBER_SEGMENT_WORDS];
#pragma unroll
    for (size_t from = 0; from < CAMBER_VECTORS; from++) {
#pragma unroll
        for (size_t k = 0; k < CAMBER_LANES; k++)
            words[CAMBER_LANES * from + k] =
                CAMBER_LOAD(CAMBER_VECTORS * (size_t)which[CAMBER_LANES * v + k] + from, segments);
        turn_over(words + CAMBER_LANES * from);
    }
    p->ax = f->ax = WORD(AX);
    p->ay = f->ay = WORD(AY);
    p->bx = f->bx = WORD(BX);
    p->by = f->by = WORD(BY);
    p->ux = WORD(UX);
    p->uy = WORD(UY);
    p->nax = WORD(NAX);
    p->nay = WORD(NAY);
    p->nbx = WORD(NBX);
    p->nby = WORD(NBY);
    p->half_width = WORD(HALF_WIDTH);
    p->side.slope = WORD(SLOPE);
    p->side.curve = WORD(CURVE);
    f->reach = WORD(REACH);
    camber_edge_finish(CAMBER_AS_WORDS(WORD(FLAGS)), p);
#undef WORD
}

static __attribute__((noinline)) void draw_segment_batch(camber_tile_state *c, const positions *at,
                                                         global const float *segments, camber_tile_rows where,
                                                         segment_batch *b) {
    const int numbers[SIXTEEN] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    camber_edges all[CAMBER_VECTORS];
    batch_sets sets;
    cell_list list;
    uint ends[SIXTEEN];
    const list_source from = {at, all, ends};
    if (b->count == 0)
        return;
    for (uint k = b->count; k < SIXTEEN; k++)
        b->which[k] = b->which[0];
    for (size_t v = 0; v < CAMBER_VECTORS; v++) {
        const camber_mask wanted = CAMBER_LOAD(v, numbers) < (int)b->count;
        camber_footprint footprint;
        camber_cell_boxes boxes;
        take_segments(segments, b->which, v, all + v, &footprint);
        CAMBER_STORE(ends_of(all + v), v, ends);
        camber_cell_boxes_of(&footprint, where, wanted, &boxes);
        find_sets(all + v, &boxes, where, v, &sets);
    }
    const ulong shut = c->done | c->filled;
    camber_tile_take_cells(c, list_all(&sets, b->count, shut | draw_filled(c, &sets, b->count, shut), &list));
    draw_list(c, &from, &list);
    b->count = 0;
}

#endif
