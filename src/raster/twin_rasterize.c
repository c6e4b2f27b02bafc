/* The CPU twin of rasterize: draws the pixels of an area, tile by tile, from the tiles' lists of segments.
 *
 * Input: the segments, lists and brushes of a camber_twin. Output: its area's pixels. The twin simply goes through
 * every tile, every segment of the tile's list, every cell and every pixel, one after another (kernels/draw_cells.h,
 * which GPUs also run). */
#include "raster/twin.h"

#include "kernels/draw_cells.h"

static camber_words pixel_of(const camber_twin *t, camber_tile_state *c, uint32_t x, uint32_t y) {
    const uint32_t cell = y % CAMBER_TILE_PX / CAMBER_CELL_PX * CAMBER_TILE_CELLS + x % CAMBER_TILE_PX / CAMBER_CELL_PX;
    const uint32_t pixel = y % CAMBER_CELL_PX * CAMBER_CELL_PX + x % CAMBER_CELL_PX;
    const float *sky = t->scene->sky;
    if (t->area->y + y < t->scene->horizon)
        return camber_rgba(sky[0], sky[1], sky[2], sky[3]);
    if (!camber_tile_has_pixels(c, (int)cell))
        return camber_bare_pixels(t->scene->background);
    return camber_tile_pixels(c, (int)cell, (int)pixel, t->scene->background);
}

/* Writes those pixels of a tile that are in the area. */
static void write_tile(const camber_twin *t, camber_tile_state *c, uint32_t column, uint32_t row) {
    const uint32_t left = column * CAMBER_TILE_PX, top = row * CAMBER_TILE_PX;
    for (uint32_t y = top; y < top + CAMBER_TILE_PX && y < t->area->height; y++)
        for (uint32_t x = left; x < left + CAMBER_TILE_PX && x < t->area->width; x++) {
            const camber_words rgba = pixel_of(t, c, x, y);
            uint8_t *to = t->stages->rgba + 4 * ((size_t)y * t->area->width + x);
            for (int k = 0; k < 4; k++)
                to[k] = (uint8_t)(rgba >> 8 * k);
        }
}

/* Draws the cells that a segment may touch. */
static void draw_segment(camber_tile_state *c, const camber_drawn_tile *d, size_t which) {
    camber_drawn_segment drawn;
    camber_footprint footprint;
    camber_cell_boxes box;
    int is_begun = 0;
    camber_footprint_of(d->from.segments + CAMBER_SEGMENT_WORDS * which, &footprint);
    camber_cell_boxes_of(&footprint, d->where, 1, &box);
    for (int row = box.y; row < box.y + box.rows; row++)
        for (int column = box.x; column < box.x + box.columns; column++) {
            const int cell = CAMBER_TILE_CELLS * row + column;
            if ((c->done | c->filled) >> cell & 1)
                continue;
            if (!is_begun)
                camber_begin_segment(&d->from, c, which, &drawn);
            is_begun = 1;
            camber_draw_cell(c, &drawn, camber_place_of(d->where, d->from.eye, cell));
        }
}

static void add_ring_edge(camber_tile_state *c, const camber_drawn_tile *d, size_t which) {
    const float *ends = d->from.edges + camber_edge_ends(which);
    camber_ring_edges e;
    camber_ring_edges_of(ends[0], ends[1], ends[2], ends[3], &e);
    camber_area_add(&c->area, &e, 1, d->where);
}

/* Adds those edges of a bunch whose boxes touch the tile. `first` is the number of its first edge. */
static void add_bunch(camber_tile_state *c, const camber_drawn_tile *d, size_t first) {
    for (size_t which = first; which < first / 16u * 16u + 16u; which++) {
        const float *ends = d->from.edges + camber_edge_ends(which);
        if (CAMBER_BITS(d->from.edges[camber_edge_brush(which)]) == d->brush &&
            camber_boxes_touch_tile(ends[0], ends[1], ends[2], ends[3], d->where))
            add_ring_edge(c, d, which);
    }
}

static void draw_entry(camber_tile_state *c, camber_drawn_tile *d, camber_u32 entry) {
    const size_t which = camber_listed(entry);
    const camber_u32 edge = camber_brush_of_edge(&d->from, which);
    camber_draw_next_with(c, d, edge != CAMBER_NO_EDGE ? edge : camber_brush_of_segment(&d->from, which));
    if (edge == CAMBER_NO_EDGE)
        draw_segment(c, d, which);
    else if (entry & CAMBER_LISTED_BUNCH)
        add_bunch(c, d, which);
    else
        add_ring_edge(c, d, which);
}

/* Draws a tile, given the crossings of its row and their number. */
static void draw_tile(const camber_twin *t, camber_tile_state *c, camber_drawn_tile *d, uint32_t row,
                      camber_u32 crossing_count) {
    const uint32_t column = d->left.column;
    const uint32_t *starts = t->stages->starts + (size_t)row * t->columns + column;
    d->where = (camber_tile_rows){(float)t->area->x + (float)(column * CAMBER_TILE_PX),
                                  (float)t->area->y + (float)(row * CAMBER_TILE_PX), 0, CAMBER_TILE_CELLS - 1};
    d->left.end = crossing_count;
    d->brush = UINT32_MAX;
    camber_tile_begin(c, ~(camber_u64)0, t->scene->brushes);
    for (uint32_t k = starts[1]; k-- > starts[0];)
        draw_entry(c, d, t->stages->lists[k]);
    camber_draw_areas_above(c, d, 0);
    camber_end_area(c, d);
    camber_tile_end(c);
    write_tile(t, c, column, row);
}

/* Writes the crossings of a row of tiles. Returns how many there are. */
static camber_u32 wind_row(const camber_twin *t, uint32_t row, camber_u32 *crossings) {
    const camber_raster_stages *stages = t->stages;
    const camber_tile_grid of = {(float)t->area->x, (float)t->area->y, t->columns, t->rows};
    const uint32_t *starts = stages->starts + stages->tile_count + row;
    if (stages->list_count == stages->tile_count)
        return 0;
    return camber_wind_row(stages->edges, stages->lists + starts[0], starts[1] - starts[0], of,
                           of.top + (float)(row * CAMBER_TILE_PX), crossings);
}

#if CAMBER_STROKE_PITCHED
camber_status camber_twin_draw_pitched(const camber_twin *t) {
    const camber_eye eye = t->scene->eye;
#else
camber_status camber_twin_draw(const camber_twin *t) {
    const camber_eye eye = {0, 0, 0, 0};
#endif
    const camber_raster_stages *stages = t->stages;
    const size_t edges = stages->starts[stages->list_count] - stages->starts[stages->tile_count];
    camber_tile_state *state = camber_alloc(t->context, 1, sizeof *state);
    camber_u32 *crossings = camber_alloc(t->context, edges, CAMBER_CROSSING_WORDS * sizeof *crossings);
    const bool held = state && crossings;
    camber_drawn_tile d = {.from = {.segments = stages->segments,
                                    .edges = stages->edges,
                                    .arc_lengths = stages->arc_lengths,
                                    .planes = stages->planes,
                                    .side_table = t->scene->side_table,
                                    .brushes = t->scene->brushes,
                                    .brush_ext = t->scene->brush_ext,
                                    .first_edge = (uint32_t)t->first_edge,
                                    .edge_count = (uint32_t)(t->end_edge - t->first_edge),
                                    .eye = eye},
                           .left = {.words = crossings}};
    for (uint32_t row = 0; row < t->rows && held; row++) {
        const camber_u32 count = wind_row(t, row, crossings);
        for (d.left.column = 0; d.left.column < t->columns; d.left.column++)
            draw_tile(t, state, &d, row, count);
    }
    camber_free(t->context, crossings);
    camber_free(t->context, state);
    return held ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}
