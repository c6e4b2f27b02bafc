/* rasterize for devices without vectors, such as GPUs: a work-item takes one cell of a tile, one pixel at a time. A
 * work-group is a job, which is a whole tile, so that its work-items walk the same list. rasterize.cl says what is read
 * and written. */
#include "spill.cl"

#if CAMBER_LANES == 1
#include "draw_cells.h"

/* Writes the pixels of the cell. Above the horizon is the sky. */
static inline void write_cell(camber_tile_state *c, camber_tile_rows where, global camber_u32 *pixels,
                              camber_target_args s) {
    const float back[4] = {s.r, s.g, s.b, s.a};
    const camber_u32 sky = camber_rgba(s.sky[0], s.sky[1], s.sky[2], s.sky[3]);
    const int has_pixels = camber_tile_has_pixels(c, 0);
    for (int y = 0; y < CAMBER_CELL_PX; y++) {
        camber_u32 row[CAMBER_CELL_PX];
        const int is_sky = CAMBER_RASTER_PITCHED && where.top + (float)(CAMBER_CELL_PX * where.first + y) < s.horizon;
        for (int x = 0; x < CAMBER_CELL_PX; x++)
            row[x] = is_sky       ? sky
                     : has_pixels ? camber_tile_pixels(c, 0, CAMBER_CELL_PX * y + x, back)
                                  : camber_bare_pixels(back);
        vstore4((uint4)(row[0], row[1], row[2], row[3]), 0, pixels + (size_t)y * s.stride);
    }
}

/* Draws entries [first, end) of the lists, from the last to the first, until nothing below them shows. */
static inline void draw_entries(camber_tile_state *c, camber_drawn_tile *d, camber_u32 first, camber_u32 end,
                                camber_u32 is_last) {
    for (camber_u32 k = end; k-- > first && !camber_tile_is_full(c);)
        camber_draw_listed(c, d, k);
    if (!camber_tile_is_full(c))
        camber_draw_areas_above(c, d, camber_areas_end(&d->left, is_last));
}

CAMBER_KERNEL(CAMBER_CELLS, rasterize,
              (global const float *restrict segments, global const float *restrict edges,
               global const camber_u32 *restrict starts, global const camber_u32 *restrict lists,
               global const camber_brush *restrict brushes, global const camber_u32 *restrict jobs,
               global camber_u32 *restrict pixels, const camber_target_args s, global float *restrict spill,
               const camber_spill_args slice, global const float *restrict arc_lengths,
               global const camber_brush_ext *restrict brush_ext, global const float *restrict side_table,
               global const float *restrict planes, global const camber_u32 *restrict crossings,
               global const camber_u32 *restrict ends),
              (segments, edges, starts, lists, brushes, jobs, pixels, s, spill, slice, arc_lengths, brush_ext,
               side_table, planes, crossings, ends)) {
    camber_tile_state c;
    global const camber_u32 *job = jobs + CAMBER_JOB_WORDS * (CAMBER_WORK_ITEM / CAMBER_CELLS);
    const camber_u32 tile = job[0], spilled = job[2], cell = (camber_u32)CAMBER_WORK_ITEM % CAMBER_CELLS;
    const camber_u32 column = tile % s.columns, row = tile / s.columns;
    const int cell_row = (int)cell / CAMBER_TILE_CELLS, cell_column = (int)cell % CAMBER_TILE_CELLS;
    const camber_eye flat = {0.0f, 0.0f, 0.0f, 0.0f};
    camber_drawn_tile d = {{segments, edges, arc_lengths, planes, side_table, brushes, brush_ext, lists, s.first_edge,
                            s.edge_count, CAMBER_RASTER_PITCHED ? s.eye : flat},
                           {crossings, 0, 0, column},
                           {s.left + (float)(column * CAMBER_TILE_PX), s.top + (float)(row * CAMBER_TILE_PX), cell_row,
                            cell_row, cell_column},
                           ~0u};
    global float *own_spill = spill + (size_t)(spilled & ~CAMBER_JOB_BEGINS) * slice.tile_words;
    camber_tile_begin(&c, 1, brushes);
#if CAMBER_RASTER_PITCHED
    if (d.where.top + (float)(CAMBER_CELL_PX * (cell_row + 1)) <= s.horizon) /* a cell above the horizon is done */
        c.done = ~0ul;
#endif
    if (s.first_row != ~0u) {
        d.left.first = starts[s.first_row + row] - starts[s.first_row];
        d.left.end = ends[row];
    }
    if (!(spilled & CAMBER_JOB_BEGINS)) {
        d.brush = restore_cells(&c, own_spill, brushes, slice, d.where);
        if (d.brush != ~0u && d.brush != CAMBER_SPILL_FULL) {
#if CAMBER_RASTER_RICH
            camber_tile_use_ext(&c, brush_ext[d.brush]);
#endif
            c.winding += camber_take_winding(&d.left, d.brush);
        }
    }
    draw_entries(&c, &d, starts[tile], starts[tile + 1], slice.is_last);
    const int is_full = camber_tile_is_full(&c);
    if (!slice.is_last && !is_full) {
        const camber_u32 open = (camber_u32)c.is_open[CAMBER_GROUP] << 30 | (camber_u32)c.is_open[CAMBER_LAYER] << 31;
        spill_cells(&c, own_spill, slice, d.where, (d.brush & CAMBER_SPILL_BRUSH) | open);
        return;
    }
    camber_end_area(&c, &d);
    camber_tile_end(&c);
    if (!slice.is_last) {
        camber_tile_close_brush(&c);
        c.done = ~0ul;
        spill_cells(&c, own_spill, slice, d.where, CAMBER_SPILL_FULL);
        return;
    }
    write_cell(&c, d.where,
               pixels + ((size_t)row * CAMBER_TILE_PX + (size_t)(CAMBER_CELL_PX * cell_row) + s.above) * s.stride +
                   (size_t)column * CAMBER_TILE_PX + (size_t)(CAMBER_CELL_PX * cell_column),
               s);
}

#endif
