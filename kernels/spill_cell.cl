/* Spills a cell of a tile's state between two slices and restores it: raster_args.h has the layout. */
#ifndef CAMBER_SPILL_CELL_CL
#define CAMBER_SPILL_CELL_CL

#include "area_inside.h"

/* A share of a tile is a cell, or, if work-items share the tile, the pixels of one of them. A plane has the vectors of
 * one share after those of another. */
#define SHARES (CAMBER_CELLS * CAMBER_VECTORS / CAMBER_OWN_VECTORS)

/* Returns the position of vector v of a share in a plane. */
static inline size_t plane_at(camber_u32 plane, int share, int v) {
    return ((size_t)plane * SHARES + (size_t)share) * CAMBER_OWN_VECTORS + (size_t)v;
}

/* Spill and restore the vectors of a share in `count` consecutive planes. */
static inline void spill_planes(global float *planes, const camber_real *from, camber_u32 plane, camber_u32 count,
                                int share) {
    for (camber_u32 k = 0; k < count; k++)
        for (int v = 0; v < CAMBER_OWN_VECTORS; v++)
            CAMBER_STORE(from[CAMBER_OWN_VECTORS * (int)k + v], plane_at(plane + k, share, v), planes);
}

static inline void restore_planes(global const float *planes, camber_real *to, camber_u32 plane, camber_u32 count,
                                  int share) {
    for (camber_u32 k = 0; k < count; k++)
        for (int v = 0; v < CAMBER_OWN_VECTORS; v++)
            to[CAMBER_OWN_VECTORS * (int)k + v] = CAMBER_LOAD(plane_at(plane + k, share, v), planes);
}

/* Returns the sets of cell i of a state, in the order of their bits in a share's first word. */
static inline camber_u32 sets_of(const camber_tile_state *c, int i) {
    const ulong of[CAMBER_SPILL_SETS] = {c->brushed, c->filled, c->done, c->touched[0], c->touched[1], c->touched[2]};
    camber_u32 bits = 0;
    for (int k = 0; k < CAMBER_SPILL_SETS; k++)
        bits |= (camber_u32)(of[k] >> i & 1ul) << k;
    return bits;
}

static inline void restore_sets(camber_tile_state *c, camber_u32 state, int i) {
    ulong *const of[CAMBER_SPILL_SETS] = {&c->brushed,    &c->filled,     &c->done,
                                          &c->touched[0], &c->touched[1], &c->touched[2]};
    for (int k = 0; k < CAMBER_SPILL_SETS; k++)
        *of[k] |= (ulong)(state >> k & 1u) << i;
}

/* Spill and restore the values of cell i of a state: those of the current brush, if any, and of its levels. */
static inline void spill_cell(const camber_tile_state *c, camber_u32 sets, int i, camber_spill_args s,
                              global float *planes, int share) {
    if (sets & CAMBER_SPILL_BRUSHED)
        spill_planes(planes, c->brush[i], 0, 1, share);
    if (sets & CAMBER_SPILL_BRUSHED && c->now.mode == CAMBER_BRUSH_UNION)
        spill_planes(planes, c->sums[i][0], s.sums, 3, share);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_PICTURE))
        spill_planes(planes, c->level[CAMBER_PICTURE][i][0], 1, 4, share);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_GROUP))
        spill_planes(planes, c->level[CAMBER_GROUP][i][0], s.group, 4, share);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_LAYER))
        spill_planes(planes, c->level[CAMBER_LAYER][i][0], s.layer, 4, share);
#if CAMBER_RASTER_RICH
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_LAYER) && c->now.mode == CAMBER_BRUSH_MASKED)
        spill_planes(planes, c->mask[i], s.layer + 4, 1, share);
#endif
}

static inline void restore_cell(camber_tile_state *c, camber_u32 sets, int i, camber_spill_args s,
                                global const float *planes, int share) {
    if (sets & CAMBER_SPILL_BRUSHED)
        restore_planes(planes, c->brush[i], 0, 1, share);
    if (sets & CAMBER_SPILL_BRUSHED && c->now.mode == CAMBER_BRUSH_UNION)
        restore_planes(planes, c->sums[i][0], s.sums, 3, share);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_PICTURE))
        restore_planes(planes, c->level[CAMBER_PICTURE][i][0], 1, 4, share);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_GROUP))
        restore_planes(planes, c->level[CAMBER_GROUP][i][0], s.group, 4, share);
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_LAYER))
        restore_planes(planes, c->level[CAMBER_LAYER][i][0], s.layer, 4, share);
#if CAMBER_RASTER_RICH
    if (sets & CAMBER_SPILL_TOUCHED(CAMBER_LAYER) && c->now.mode == CAMBER_BRUSH_MASKED)
        restore_planes(planes, c->mask[i], s.layer + 4, 1, share);
#endif
}

#endif
