/* Spills the cells of a tile between two slices and restores them: raster_args.h has the layout. A work-item spills the
 * cells that it draws. */
#ifndef CAMBER_SPILL_CL
#define CAMBER_SPILL_CL

#include "spill_cell.cl"

/* The planes of a tile, and its words after them: winding changes, which the cells of a row share, and edges, which
 * those of the tile share. */
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
                               behind + CAMBER_TURN_WORDS * CAMBER_TILE_CELLS};
    return tile;
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
            CAMBER_STORE(s->changes[row][column][k][v], plane_at(plane + k, cell, v), (global camber_u32 *)to->planes);
    if (column > 0)
        return;
    for (int k = 0; k < CAMBER_TURN_WORDS; k++)
        to->turns[CAMBER_TURN_WORDS * row + k] =
            s->turns[row + k / (CAMBER_TILE_CELLS + 1)][k % (CAMBER_TILE_CELLS + 1)];
    for (int i = 0; i < CAMBER_PLACED_WORDS && row == where.first; i++)
        for (int k = 0; k < s->kept_count; k++)
            to->placed[CAMBER_PLACED_MOST * i + k] = s->placed[i][k];
}

static inline void restore_area(camber_area_state *s, const spilled_tile *from, camber_u32 plane,
                                camber_tile_rows where, int row, int column) {
    const int cell = CAMBER_TILE_CELLS * row + column;
    for (camber_u32 k = 0; k < 2; k++)
        for (int v = 0; v < CAMBER_VECTORS; v++)
            s->changes[row][column][k][v] =
                CAMBER_LOAD(plane_at(plane + k, cell, v), (global const camber_u32 *)from->planes);
    if (column > 0)
        return;
    for (int k = 0; k < CAMBER_TURN_WORDS; k++)
        s->turns[row + k / (CAMBER_TILE_CELLS + 1)][k % (CAMBER_TILE_CELLS + 1)] =
            from->turns[CAMBER_TURN_WORDS * row + k];
    for (int i = 0; i < CAMBER_PLACED_WORDS && row == where.first; i++)
        for (int k = 0; k < s->kept_count; k++)
            s->placed[i][k] = from->placed[CAMBER_PLACED_MOST * i + k];
}

/* Spills the cells of the drawn rows. now: the brush, and which levels are open. */
static inline void spill_cells(const camber_tile_state *c, global float *spill, camber_spill_args s,
                               camber_tile_rows where, camber_u32 now) {
    const spilled_tile to = spilled_tile_of(spill, s);
    const camber_area_state *a = &c->area;
    for (int row = where.first; row <= where.last; row++)
        for (int column = 0; column < CAMBER_TILE_CELLS; column++) {
            const int i = CAMBER_TILE_CELLS * row + column;
            global camber_u32 *words = cell_words(&to, row, column);
            const camber_u32 edged = a->has_edges ? (camber_u32)(a->edged >> (CAMBER_TILE_CELLS * row) & 255ul) : 0u;
            const camber_u32 sets = sets_of(c, i);
            words[CAMBER_SPILL_STATE] = sets | edged << CAMBER_SPILL_EDGED_SHIFT;
            words[CAMBER_SPILL_NOW] = now;
            words[CAMBER_SPILL_WINDING] = (camber_u32)c->winding;
            words[CAMBER_SPILL_PLACED] =
                a->has_edges ? (camber_u32)(a->placed_count + 1) | (camber_u32)a->kept_count << 16 : 0u;
            spill_cell(c, sets, i, s, to.planes, i);
            if (a->has_edges)
                spill_area(a, &to, s.sums, where, row, column);
        }
}

/* Restores the sets of the rows' cells from their words. Those that are not full have been drawn from the same list, so
 * they have the same brush and open levels. Returns the words of such a cell, or 0 if all are full. */
static inline global const camber_u32 *restore_words(camber_tile_state *c, const spilled_tile *from,
                                                     camber_tile_rows where) {
    global const camber_u32 *open = 0;
    c->area.edged = 0;
    for (int row = where.first; row <= where.last; row++)
        for (int column = 0; column < CAMBER_TILE_CELLS; column++) {
            global const camber_u32 *words = cell_words(from, row, column);
            restore_sets(c, words[CAMBER_SPILL_STATE], CAMBER_TILE_CELLS * row + column);
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
        for (int column = 0; column < CAMBER_TILE_CELLS; column++) {
            const int i = CAMBER_TILE_CELLS * row + column;
            restore_cell(c, cell_words(&from, row, column)[CAMBER_SPILL_STATE], i, s, from.planes, i);
            if (c->area.has_edges)
                restore_area(&c->area, &from, s.sums, where, row, column);
        }
    return now == CAMBER_SPILL_FULL ? now : brush == CAMBER_SPILL_BRUSH ? ~0u : brush;
}

#endif
