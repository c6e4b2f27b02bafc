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

/* The cells whose sums are more than nothing. */
static inline ulong cells_with_sums(const camber_tile_state *c) {
    return c->now.mode == CAMBER_BRUSH_UNION ? c->brushed : c->edged;
}

/* Keeps edges of an area's brush for the slices to come. All jobs of a tile have the same and write the same. Returns
 * how many are kept, more than CAMBER_KEPT_MOST if not all are. */
static inline camber_u32 keep_edges(const camber_area_edges *edges, camber_tile_rows where, global float *kept) {
    camber_u32 count = edges->kept_count;
    for (camber_u32 k = 0; k < edges->count && count <= CAMBER_KEPT_MOST; k++) {
        global const float *segment = edges->segments + CAMBER_SEGMENT_WORDS * (size_t)edges->list[k];
        if (!camber_edge_matters(segment, where))
            continue;
        if (count < CAMBER_KEPT_MOST)
            vstore4(vload4(0, segment), count, kept);
        count++;
    }
    return count;
}

/* Spills the state of rows of cells [first, last]. now: the brush, and which levels are open. */
static inline void spill_cells(camber_tile_state *c, global float *spill, camber_spill_args s, int first, int last,
                               camber_u32 now, camber_u32 kept_count) {
    global uchar *bits = (global uchar *)spill, *blend_count = bits + CAMBER_SPILL_BLEND_COUNTS;
    global camber_u32 *rows = (global camber_u32 *)spill + CAMBER_SPILL_ROWS;
    global float *planes = spill + CAMBER_SPILL_WORDS;
    const ulong of[CAMBER_SPILL_SETS] = {c->brushed,    c->filled,     c->done, c->touched[0],
                                         c->touched[1], c->touched[2], c->edged};
    for (int j = first; j <= last; j++) {
        for (int k = 0; k < CAMBER_SPILL_SETS; k++)
            bits[CAMBER_TILE_CELLS * k + j] = (uchar)(of[k] >> (CAMBER_TILE_CELLS * j));
        vstore8(vload8((size_t)j, c->blend_count), (size_t)j, blend_count);
        rows[j] = now;
        rows[j + CAMBER_SPILL_WINDINGS - CAMBER_SPILL_ROWS] = (camber_u32)c->winding;
        rows[j + CAMBER_SPILL_KEPT - CAMBER_SPILL_ROWS] = kept_count;
    }
    spill_planes(planes, c->brush[0], 0, 1, c->brushed);
    spill_planes(planes, c->level[CAMBER_PICTURE][0][0], 1, 4, c->touched[CAMBER_PICTURE]);
    spill_planes(planes, c->sums[0][0], s.sums, 3, cells_with_sums(c));
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
                                       camber_spill_args s, int first, int last, camber_u32 *kept_count) {
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
    c->edged = of[6];
    for (int j = first; j <= last; j++)
        if (rows[j] != CAMBER_SPILL_FULL) {
            c->winding = (int)rows[j + CAMBER_SPILL_WINDINGS - CAMBER_SPILL_ROWS];
            *kept_count = rows[j + CAMBER_SPILL_KEPT - CAMBER_SPILL_ROWS];
        }
    restore_planes(planes, c->sums[0][0], s.sums, 3, cells_with_sums(c));
#if CAMBER_RASTER_RICH
    if (c->now.mode == CAMBER_BRUSH_MASKED)
        restore_planes(planes, c->mask[0], s.layer + 4, 1, c->touched[CAMBER_LAYER]);
#endif
    return now & CAMBER_SPILL_BRUSH;
}

#endif
