/* Spills a tile that work-items share between two slices and restores it: raster_args.h has the layout. */
#ifndef CAMBER_SPILL_GPU_CL
#define CAMBER_SPILL_GPU_CL

#include "area_gpu.cl"
#include "spill_cell.cl"

/* The parts of a tile's spill. */
typedef struct spilled_tile {
    global camber_u32 *items; /* a work-item's sets, then all others'; their brushes; their winding numbers */
    global float *planes;
    global camber_u32 *area, *changes; /* area: the brush, and how many edges are kept */
    global float *kept;
} spilled_tile;

static inline spilled_tile spilled_tile_of(global float *spill, camber_spill_args s) {
    global float *planes = spill + CAMBER_TILE_ITEMS_WORDS, *area = planes + 16 * CAMBER_CELLS * s.behind;
    const spilled_tile tile = {(global camber_u32 *)spill, planes, (global camber_u32 *)area,
                               (global camber_u32 *)area + 2, area + 2 + CAMBER_SHARED_CHANGES_WORDS};
    return tile;
}

/* Spill and restore what a work-item draws. brush: its brush, or ~0 if there is none yet. */
CAMBER_NOINLINE void spill_own(const camber_tile_state *c, const spilled_tile *to, camber_spill_args s, camber_u32 item,
                               camber_u32 brush) {
    const camber_u32 sets = sets_of(c, 0);
    to->items[item] = sets;
    to->items[CAMBER_TILE_ITEMS + item] = (brush & CAMBER_SPILL_BRUSH) | (camber_u32)c->is_open[CAMBER_GROUP] << 30 |
                                          (camber_u32)c->is_open[CAMBER_LAYER] << 31;
    to->items[2u * CAMBER_TILE_ITEMS + item] = (camber_u32)c->winding;
    spill_cell(c, sets, 0, s, to->planes, (int)item);
}

CAMBER_NOINLINE camber_u32 restore_own(camber_tile_state *c, const spilled_tile *from, camber_spill_args s,
                                       camber_u32 item, global const camber_brush *brushes) {
    const camber_u32 sets = from->items[item], now = from->items[CAMBER_TILE_ITEMS + item];
    const camber_u32 brush = now & CAMBER_SPILL_BRUSH;
    restore_sets(c, sets, 0);
    for (int k = CAMBER_GROUP; k < CAMBER_LEVELS; k++)
        c->is_open[k] = (int)(now >> (29 + k) & 1u);
    if (brush != CAMBER_SPILL_BRUSH)
        c->now = brushes[brush];
    c->winding = (int)from->items[2u * CAMBER_TILE_ITEMS + item];
    restore_cell(c, sets, 0, s, from->planes, (int)item);
    return brush == CAMBER_SPILL_BRUSH ? ~0u : brush;
}

/* Keeps the edges of a run in the spill, for overlaps that a later slice finds. */
CAMBER_NOINLINE void keep_edges(const camber_drawn_tile *d, const edge_run *run, const spilled_tile *to) {
    camber_u32 count = run->kept_count;
    for (camber_u32 k = run->end; k-- > run->first;) {
        entry_edges from = edges_of_entry(run->lists[k], run->brush);
        camber_placed_edges placed;
        for (; count < CAMBER_PLACED_MOST && take_placed(d, &from, &placed); count++)
            for (camber_u32 i = 0; i < CAMBER_PLACED_WORDS; i++)
                to->kept[CAMBER_PLACED_WORDS * count + i] = placed.words[i];
    }
    to->area[1] = count;
}

/* Spill and restore a brush whose edges are being added. A barrier must be before and after it. */
CAMBER_FN CAMBER_INLINE void spill_edges(local const shared_edges *s, const camber_drawn_tile *d, const edge_run *run,
                                         const spilled_tile *to, camber_u32 item) {
    local const camber_u32 *words = (local const camber_u32 *)&s->changes;
    if (item == 0)
        to->area[0] = run->brush;
    if (run->brush == CAMBER_NO_EDGE)
        return;
    for (camber_u32 i = item; i < CAMBER_SHARED_CHANGES_WORDS; i += CAMBER_TILE_ITEMS)
        to->changes[i] = words[i];
    if (item == 0)
        keep_edges(d, run, to);
}

CAMBER_FN CAMBER_INLINE void restore_edges(local shared_edges *s, edge_run *run, const spilled_tile *from,
                                           camber_u32 item) {
    local camber_u32 *words = (local camber_u32 *)&s->changes;
    run->brush = from->area[0];
    if (run->brush == CAMBER_NO_EDGE)
        return;
    for (camber_u32 i = item; i < CAMBER_SHARED_CHANGES_WORDS; i += CAMBER_TILE_ITEMS)
        words[i] = from->changes[i];
    if (item < CAMBER_CELLS)
        s->cells[item] = 0;
    run->kept = from->kept;
    run->kept_count = from->area[1];
}

#endif
