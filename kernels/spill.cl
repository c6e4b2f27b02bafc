/* Spills the cells of a tile between two slices and restores them: raster_args.h has the layout. A work-item spills the
 * cells that it draws. */
#ifndef CAMBER_SPILL_CL
#define CAMBER_SPILL_CL

#include "area_inside.h"

/* The cells that a work-item draws share the winding changes of their rows and the edges of their tile. Work-items
 * share nothing, because one may spill before another restores. */
#if CAMBER_OWN_SIDE == 1
#define SHARES CAMBER_CELLS
#define SHARE_OF(row, column) (CAMBER_TILE_CELLS * (row) + (column))
#define PLACED_OF(row, column) ((size_t)SHARE_OF(row, column) * CAMBER_PLACED_WORDS * CAMBER_KEPT_MOST)
#else
#define SHARES CAMBER_TILE_CELLS
#define SHARE_OF(row, column) (row)
#define PLACED_OF(row, column) 0
#endif

/* The planes of a tile, and its words after them. */
typedef struct spilled_tile {
    global camber_u32 *cells;
    global float *planes;
    global int *turns;
    global float *placed;
} spilled_tile;

static inline spilled_tile spilled_tile_of(global float *spill, camber_spill_args s) {
    global float *planes = spill + CAMBER_SPILL_CELL_WORDS * CAMBER_CELLS,
                 *behind = planes + 16 * CAMBER_CELLS * s.behind;
    const spilled_tile tile = {(global camber_u32 *)spill, planes, (global int *)behind,
                               behind + CAMBER_TURN_WORDS * SHARES};
    return tile;
}

/* Returns the position of vector v of a cell of the tile in a plane. */
static inline size_t plane_at(camber_u32 plane, int cell, int v) {
    return ((size_t)plane * CAMBER_CELLS + (size_t)cell) * CAMBER_VECTORS + (size_t)v;
}

/* Spill and restore the vectors of a cell in `count` consecutive planes. */
static inline void spill_planes(global float *planes, const camber_real *from, camber_u32 plane, camber_u32 count,
                                int cell) {
    for (camber_u32 k = 0; k < count; k++)
        for (int v = 0; v < CAMBER_VECTORS; v++)
            CAMBER_STORE(from[CAMBER_VECTORS * (int)k + v], plane_at(plane + k, cell, v), planes);
}

static inline void restore_planes(global const float *planes, camber_real *to, camber_u32 plane, camber_u32 count,
                                  int cell) {
    for (camber_u32 k = 0; k < count; k++)
        for (int v = 0; v < CAMBER_VECTORS; v++)
            to[CAMBER_VECTORS * (int)k + v] = CAMBER_LOAD(plane_at(plane + k, cell, v), planes);
}

/* Returns the words of a cell of the tile. */
static inline global camber_u32 *cell_words(const spilled_tile *to, int row, int column) {
    return to->cells + CAMBER_SPILL_CELL_WORDS * (CAMBER_TILE_CELLS * row + column);
}

/* Spills the changes that the edges of a polygon make in a cell. */
static inline void spill_area(const camber_area_state *s, const spilled_tile *to, camber_u32 plane,
                              camber_tile_rows where, int row, int column) {
    const int cell = CAMBER_TILE_CELLS * row + column;
    for (camber_u32 k = 0; k < 2; k++)
        for (int v = 0; v < CAMBER_VECTORS; v++)
            CAMBER_STORE(s->changes[CAMBER_OWN_ROW(row)][CAMBER_OWN_COLUMN(column, where)][k][v],
                         plane_at(plane + k, cell, v), (global camber_u32 *)to->planes);
    if (column > CAMBER_FIRST_COLUMN(where))
        return;
    for (int k = 0; k < CAMBER_TURN_WORDS; k++)
        to->turns[CAMBER_TURN_WORDS * SHARE_OF(row, column) + k] =
            s->turns[row + k / (CAMBER_TILE_CELLS + 1)][k % (CAMBER_TILE_CELLS + 1)];
    for (int i = 0; i < CAMBER_PLACED_WORDS && row == where.first; i++)
        for (int k = 0; k < s->kept_count; k++)
            to->placed[PLACED_OF(row, column) + (size_t)(CAMBER_KEPT_MOST * i + k)] = s->placed[i][k];
}

static inline void restore_area(camber_area_state *s, const spilled_tile *from, camber_u32 plane,
                                camber_tile_rows where, int row, int column) {
    const int cell = CAMBER_TILE_CELLS * row + column;
    for (camber_u32 k = 0; k < 2; k++)
        for (int v = 0; v < CAMBER_VECTORS; v++)
            s->changes[CAMBER_OWN_ROW(row)][CAMBER_OWN_COLUMN(column, where)][k][v] =
                CAMBER_LOAD(plane_at(plane + k, cell, v), (global const camber_u32 *)from->planes);
    if (column > CAMBER_FIRST_COLUMN(where))
        return;
    for (int k = 0; k < CAMBER_TURN_WORDS; k++)
        s->turns[row + k / (CAMBER_TILE_CELLS + 1)][k % (CAMBER_TILE_CELLS + 1)] =
            from->turns[CAMBER_TURN_WORDS * SHARE_OF(row, column) + k];
    for (int i = 0; i < CAMBER_PLACED_WORDS && row == where.first; i++)
        for (int k = 0; k < s->kept_count; k++)
            s->placed[i][k] = from->placed[PLACED_OF(row, column) + (size_t)(CAMBER_KEPT_MOST * i + k)];
}

/* Returns the sets of a state, in the order of their bits in a cell's first word. */
static inline camber_u32 sets_of(const camber_tile_state *c, int i) {
    const ulong of[CAMBER_SPILL_SETS] = {c->brushed, c->filled, c->done, c->touched[0], c->touched[1], c->touched[2]};
    camber_u32 bits = 0;
    for (int k = 0; k < CAMBER_SPILL_SETS; k++)
        bits |= (camber_u32)(of[k] >> i & 1ul) << k;
    return bits;
}

static inline void spill_cell(const camber_tile_state *c, const spilled_tile *to, camber_spill_args s,
                              camber_tile_rows where, int row, int column) {
    const int i = CAMBER_OWN_CELL(row, column, where), cell = CAMBER_TILE_CELLS * row + column;
    const camber_u32 sets = sets_of(c, i);
    if (sets & CAMBER_SPILL_BRUSHED)
        spill_planes(to->planes, c->brush[i], 0, 1, cell);
    if (sets & CAMBER_SPILL_BRUSHED && c->now.mode == CAMBER_BRUSH_UNION)
        spill_planes(to->planes, c->sums[i][0], s.sums, 3, cell);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_PICTURE))
        spill_planes(to->planes, c->level[CAMBER_PICTURE][i][0], 1, 4, cell);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_GROUP))
        spill_planes(to->planes, c->level[CAMBER_GROUP][i][0], s.group, 4, cell);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_LAYER))
        spill_planes(to->planes, c->level[CAMBER_LAYER][i][0], s.layer, 4, cell);
#if CAMBER_RASTER_RICH
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_LAYER) && c->now.mode == CAMBER_BRUSH_MASKED)
        spill_planes(to->planes, c->mask[i], s.layer + 4, 1, cell);
#endif
    if (c->area.has_edges)
        spill_area(&c->area, to, s.sums, where, row, column);
}

/* Spills the cells of the drawn rows. now: the brush, and which levels are open. */
static inline void spill_cells(const camber_tile_state *c, global float *spill, camber_spill_args s,
                               camber_tile_rows where, camber_u32 now) {
    const spilled_tile to = spilled_tile_of(spill, s);
    const camber_area_state *a = &c->area;
    for (int row = where.first; row <= where.last; row++)
        for (int column = CAMBER_FIRST_COLUMN(where); column <= CAMBER_LAST_COLUMN(where); column++) {
            const int i = CAMBER_OWN_CELL(row, column, where);
            global camber_u32 *words = cell_words(&to, row, column);
            const camber_u32 edged = a->has_edges ? (camber_u32)(a->edged >> (CAMBER_TILE_CELLS * row) & 255ul) : 0u;
            words[CAMBER_SPILL_STATE] = sets_of(c, i) | edged << CAMBER_SPILL_EDGED_SHIFT;
            words[CAMBER_SPILL_NOW] = now;
            words[CAMBER_SPILL_WINDING] = (camber_u32)c->winding;
            words[CAMBER_SPILL_PLACED] =
                a->has_edges ? (camber_u32)(a->placed_count + 1) | (camber_u32)a->kept_count << 16 : 0u;
            spill_cell(c, &to, s, where, row, column);
        }
}

/* Restores the sets of a cell. */
static inline void restore_sets(camber_tile_state *c, camber_u32 state, int i) {
    ulong *const of[CAMBER_SPILL_SETS] = {&c->brushed,    &c->filled,     &c->done,
                                          &c->touched[0], &c->touched[1], &c->touched[2]};
    for (int k = 0; k < CAMBER_SPILL_SETS; k++)
        *of[k] |= (ulong)(state >> k & 1u) << i;
}

/* Restores a cell's values of the current brush, if any, and of its levels. */
static inline void restore_cell(camber_tile_state *c, const spilled_tile *from, camber_spill_args s, camber_u32 sets,
                                camber_tile_rows where, int row, int column) {
    const int i = CAMBER_OWN_CELL(row, column, where), cell = CAMBER_TILE_CELLS * row + column;
    if (sets & CAMBER_SPILL_BRUSHED)
        restore_planes(from->planes, c->brush[i], 0, 1, cell);
    if (sets & CAMBER_SPILL_BRUSHED && c->now.mode == CAMBER_BRUSH_UNION)
        restore_planes(from->planes, c->sums[i][0], s.sums, 3, cell);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_PICTURE))
        restore_planes(from->planes, c->level[CAMBER_PICTURE][i][0], 1, 4, cell);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_GROUP))
        restore_planes(from->planes, c->level[CAMBER_GROUP][i][0], s.group, 4, cell);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_LAYER))
        restore_planes(from->planes, c->level[CAMBER_LAYER][i][0], s.layer, 4, cell);
#if CAMBER_RASTER_RICH
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_LAYER) && c->now.mode == CAMBER_BRUSH_MASKED)
        restore_planes(from->planes, c->mask[i], s.layer + 4, 1, cell);
#endif
    if (c->area.has_edges)
        restore_area(&c->area, from, s.sums, where, row, column);
}

/* Restores the sets of the rows' cells from their words. Those that are not full have been drawn from the same list, so
 * they have the same brush and open levels. Returns the words of such a cell, or 0 if all are full. */
static inline global const camber_u32 *restore_words(camber_tile_state *c, const spilled_tile *from,
                                                     camber_tile_rows where) {
    global const camber_u32 *open = 0;
    c->area.edged = 0;
    for (int row = where.first; row <= where.last; row++)
        for (int column = CAMBER_FIRST_COLUMN(where); column <= CAMBER_LAST_COLUMN(where); column++) {
            global const camber_u32 *words = cell_words(from, row, column);
            restore_sets(c, words[CAMBER_SPILL_STATE], CAMBER_OWN_CELL(row, column, where));
            c->area.edged |= (ulong)(words[CAMBER_SPILL_STATE] >> CAMBER_SPILL_EDGED_SHIFT & 255u)
                             << (CAMBER_TILE_CELLS * row);
            open = words[CAMBER_SPILL_NOW] == CAMBER_SPILL_FULL ? open : words;
        }
    return open;
}

/* Restores the cells of rows. Returns the last brush that was drawn, ~0 if there was none, or CAMBER_SPILL_FULL. */
static inline camber_u32 restore_cells(camber_tile_state *c, global float *spill, global const camber_brush *brushes,
                                       camber_spill_args s, camber_tile_rows where) {
    const spilled_tile from = spilled_tile_of(spill, s);
    global const camber_u32 *open = restore_words(c, &from, where);
    const camber_u32 now = open ? open[CAMBER_SPILL_NOW] : CAMBER_SPILL_FULL, brush = now & CAMBER_SPILL_BRUSH;
    if (open) {
        const ulong edged = c->area.edged;
        const camber_u32 placed = open[CAMBER_SPILL_PLACED];
        for (int k = CAMBER_GROUP; k < CAMBER_LEVELS; k++)
            c->is_open[k] = (int)(now >> (29 + k) & 1u);
        if (brush != CAMBER_SPILL_BRUSH)
            c->now = brushes[brush];
        c->winding = (int)open[CAMBER_SPILL_WINDING];
        if (placed) {
            camber_area_begin(&c->area);
            c->area.edged = edged;
            c->area.placed_count = (int)(placed & 0xffffu) - 1;
            c->area.kept_count = (int)(placed >> 16);
        }
    }
    for (int row = where.first; row <= where.last; row++)
        for (int column = CAMBER_FIRST_COLUMN(where); column <= CAMBER_LAST_COLUMN(where); column++)
            restore_cell(c, &from, s, cell_words(&from, row, column)[CAMBER_SPILL_STATE], where, row, column);
    return now == CAMBER_SPILL_FULL ? now : brush == CAMBER_SPILL_BRUSH ? ~0u : brush;
}

#endif
