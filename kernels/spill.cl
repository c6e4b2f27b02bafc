/* How a tile spills its state between two slices and restores it: raster_args.h has the layout. */
#ifndef CAMBER_SPILL_CL
#define CAMBER_SPILL_CL

#include "area_inside.h"

static inline size_t plane_at(camber_u32 plane, int cell, int v) {
    return ((size_t)plane * CAMBER_CELLS + (size_t)cell) * CAMBER_VECTORS + (size_t)v;
}

/* from and to: count planes, those of a cell beside each other. */
static inline void spill_planes(global float *planes, const camber_real *from, camber_u32 plane, camber_u32 count,
                                ulong cells) {
    for (; cells; cells &= cells - 1)
        for (camber_u32 k = 0; k < count; k++)
            for (int i = camber_lowest(cells), v = 0; v < CAMBER_VECTORS; v++)
                CAMBER_STORE(from[(count * (camber_u32)i + k) * CAMBER_VECTORS + (camber_u32)v],
                             plane_at(plane + k, i, v), planes);
}

static inline void restore_planes(global const float *planes, camber_real *to, camber_u32 plane, camber_u32 count,
                                  ulong cells) {
    for (; cells; cells &= cells - 1)
        for (camber_u32 k = 0; k < count; k++)
            for (int i = camber_lowest(cells), v = 0; v < CAMBER_VECTORS; v++)
                to[(count * (camber_u32)i + k) * CAMBER_VECTORS + (camber_u32)v] =
                    CAMBER_LOAD(plane_at(plane + k, i, v), planes);
}

/* Spills what the edges of an area change in rows of cells [first, last]. changes: two planes. behind: the words behind
 * the planes. Edges are written by all jobs of a tile, which have the same. */
static inline void spill_area(const camber_area_state *s, global camber_u32 *changes, global float *behind, int first,
                              int last) {
    global int *turns = (global int *)behind;
    global float *placed = behind + CAMBER_TURN_WORDS * CAMBER_TILE_CELLS;
    for (int j = first; j <= last; j++) {
        for (int x = 0; x < CAMBER_TILE_CELLS; x++)
            for (camber_u32 k = 0; k < 2; k++)
                for (int v = 0; v < CAMBER_VECTORS; v++)
                    CAMBER_STORE(s->changes[j][x][k][v], plane_at(k, CAMBER_TILE_CELLS * j + x, v), changes);
        for (int k = 0; k < CAMBER_TURN_WORDS; k++)
            turns[CAMBER_TURN_WORDS * j + k] = s->turns[j + k / (CAMBER_TILE_CELLS + 1)][k % (CAMBER_TILE_CELLS + 1)];
    }
    for (int i = 0; i < CAMBER_PLACED_WORDS; i++)
        for (int k = 0; k < s->placed_count && k < CAMBER_PLACED_MOST; k++)
            placed[CAMBER_PLACED_MOST * i + k] = s->placed[i][k];
}

static inline void restore_area(camber_area_state *s, global const camber_u32 *changes, global const float *behind,
                                int first, int last, camber_u32 placed_word, ulong edged) {
    global const int *turns = (global const int *)behind;
    global const float *placed = behind + CAMBER_TURN_WORDS * CAMBER_TILE_CELLS;
    const int placed_count = (int)placed_word - 1;
    if (placed_count < 0)
        return;
    camber_area_begin(s);
    s->edged = edged;
    s->placed_count = placed_count;
    for (int j = first; j <= last; j++) {
        for (int x = 0; x < CAMBER_TILE_CELLS; x++)
            for (camber_u32 k = 0; k < 2; k++)
                for (int v = 0; v < CAMBER_VECTORS; v++)
                    s->changes[j][x][k][v] = CAMBER_LOAD(plane_at(k, CAMBER_TILE_CELLS * j + x, v), changes);
        for (int k = 0; k < CAMBER_TURN_WORDS; k++)
            s->turns[j + k / (CAMBER_TILE_CELLS + 1)][k % (CAMBER_TILE_CELLS + 1)] = turns[CAMBER_TURN_WORDS * j + k];
    }
    for (int i = 0; i < CAMBER_PLACED_WORDS; i++)
        for (int k = 0; k < placed_count && k < CAMBER_PLACED_MOST; k++)
            s->placed[i][k] = placed[CAMBER_PLACED_MOST * i + k];
}

/* Spills the state of rows of cells [first, last]. now: the brush, and which levels are open. */
static inline void spill_cells(camber_tile_state *c, global float *spill, camber_spill_args s, int first, int last,
                               camber_u32 now) {
    global uchar *bits = (global uchar *)spill, *blend_count = bits + CAMBER_SPILL_BLEND_COUNTS;
    global camber_u32 *rows = (global camber_u32 *)spill + CAMBER_SPILL_ROWS;
    global float *planes = spill + CAMBER_SPILL_WORDS;
    const camber_u32 placed = c->area.has_edges ? (camber_u32)c->area.placed_count + 1u : 0u;
    const ulong of[CAMBER_SPILL_SETS] = {
        c->brushed, c->filled, c->done, c->touched[0], c->touched[1], c->touched[2], placed ? c->area.edged : 0ul};
    for (int j = first; j <= last; j++) {
        for (int k = 0; k < CAMBER_SPILL_SETS; k++)
            bits[CAMBER_TILE_CELLS * k + j] = (uchar)(of[k] >> (CAMBER_TILE_CELLS * j));
        vstore8(vload8((size_t)j, c->blend_count), (size_t)j, blend_count);
        rows[j] = now;
        rows[j + CAMBER_SPILL_WINDINGS - CAMBER_SPILL_ROWS] = (camber_u32)c->winding;
        rows[j + CAMBER_SPILL_PLACED - CAMBER_SPILL_ROWS] = placed;
    }
    spill_planes(planes, c->brush[0], 0, 1, c->brushed);
    spill_planes(planes, c->level[CAMBER_PICTURE][0][0], 1, 4, c->touched[CAMBER_PICTURE]);
    if (c->now.mode == CAMBER_BRUSH_UNION)
        spill_planes(planes, c->sums[0][0], s.sums, 3, c->brushed);
    if (placed)
        spill_area(&c->area, (global camber_u32 *)planes + plane_at(s.sums, 0, 0) * CAMBER_LANES,
                   planes + plane_at(s.behind, 0, 0) * CAMBER_LANES, first, last);
    spill_planes(planes, c->level[CAMBER_GROUP][0][0], s.group, 4, c->touched[CAMBER_GROUP]);
    spill_planes(planes, c->level[CAMBER_LAYER][0][0], s.layer, 4, c->touched[CAMBER_LAYER]);
#if CAMBER_RASTER_RICH
    if (c->now.mode == CAMBER_BRUSH_MASKED)
        spill_planes(planes, c->mask[0], s.layer + 4, 1, c->touched[CAMBER_LAYER]);
#endif
}

/* Restores rows of cells [first, last]. Returns the brush that was drawn last, ~0 if none was, or CAMBER_SPILL_FULL.
 * All rows that are not full have been drawn from the same list, so they have the same brush and open levels. */
static inline camber_u32 restore_cells(camber_tile_state *c, global float *spill, global const camber_brush *brushes,
                                       camber_spill_args s, int first, int last) {
    global const uchar *bits = (global const uchar *)spill, *blend_count = bits + CAMBER_SPILL_BLEND_COUNTS;
    global const camber_u32 *rows = (global const camber_u32 *)spill + CAMBER_SPILL_ROWS;
    global float *planes = spill + CAMBER_SPILL_WORDS;
    ulong of[CAMBER_SPILL_SETS] = {0};
    camber_u32 now = CAMBER_SPILL_FULL;
    for (int j = first; j <= last; j++) {
        for (int k = 0; k < CAMBER_SPILL_SETS; k++)
            of[k] |= (ulong)bits[CAMBER_TILE_CELLS * k + j] << (CAMBER_TILE_CELLS * j);
        vstore8(vload8((size_t)j, blend_count), (size_t)j, c->blend_count);
        now = rows[j] == CAMBER_SPILL_FULL ? now : rows[j];
    }
    c->brushed = of[0];
    c->filled = of[1];
    c->done |= of[2];
    for (int k = 0; k < CAMBER_LEVELS; k++)
        c->touched[k] = of[3 + k];
    restore_planes(planes, c->brush[0], 0, 1, c->brushed);
    restore_planes(planes, c->level[CAMBER_PICTURE][0][0], 1, 4, c->touched[CAMBER_PICTURE]);
    if (now == CAMBER_SPILL_FULL)
        return now;
    for (int k = CAMBER_GROUP; k < CAMBER_LEVELS; k++) {
        c->is_open[k] = (int)(now >> (29 + k) & 1u);
        if (c->is_open[k])
            restore_planes(planes, c->level[k][0][0], k == CAMBER_GROUP ? s.group : s.layer, 4, c->touched[k]);
    }
    if ((now & CAMBER_SPILL_BRUSH) == CAMBER_SPILL_BRUSH)
        return ~0u;
    c->now = brushes[now & CAMBER_SPILL_BRUSH];
    camber_u32 placed = 0;
    for (int j = first; j <= last; j++)
        if (rows[j] != CAMBER_SPILL_FULL) {
            c->winding = (int)rows[j + CAMBER_SPILL_WINDINGS - CAMBER_SPILL_ROWS];
            placed = rows[j + CAMBER_SPILL_PLACED - CAMBER_SPILL_ROWS];
        }
    if (c->now.mode == CAMBER_BRUSH_UNION)
        restore_planes(planes, c->sums[0][0], s.sums, 3, c->brushed);
    restore_area(&c->area, (global const camber_u32 *)planes + plane_at(s.sums, 0, 0) * CAMBER_LANES,
                 planes + plane_at(s.behind, 0, 0) * CAMBER_LANES, first, last, placed, of[6]);
#if CAMBER_RASTER_RICH
    if (c->now.mode == CAMBER_BRUSH_MASKED)
        restore_planes(planes, c->mask[0], s.layer + 4, 1, c->touched[CAMBER_LAYER]);
#endif
    return now & CAMBER_SPILL_BRUSH;
}

#endif
