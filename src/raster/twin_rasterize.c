/* rasterize of the CPU twin: draws the pixels of an area, tile by tile, from the tiles' lists of segments.
 *
 * Input: the segments, lists and brushes of a camber_twin. Output: its area's pixels. The twin only walks: every tile,
 * every segment of its list, every cell, every pixel, one after the other. What becomes of a pixel is in
 * kernels/tile_state.h, which it compiles for one lane, and so do the kernels for more. */
#include "raster/twin.h"

#include "kernels/area_inside.h"

#include <math.h>

/* A segment with all that it is drawn from. */
typedef struct drawn_segment {
    camber_edge edge;
#if !CAMBER_STROKE_PITCHED
    camber_cell_bounds bounds; /* of the edge */
#endif
    camber_extras extras; /* all 0 if the brush has no features */
    camber_eye eye;       /* 0 in a picture from above */
    camber_image_sampler image;
    bool is_fill;
} drawn_segment;

/* A cell of a tile: its number, and where its first pixel lies in the picture, with a pitch from the picture's middle.
 */
typedef struct cell_place {
    int number;
    float x, y;
} cell_place;

/* The pixels of a cell as the segment sees them, and their areas. */
typedef struct cell_pixels {
    camber_pixel at[CAMBER_VECTORS];
    float area[CAMBER_VECTORS];
} cell_pixels;

static float pixel_x(cell_place one, int i) {
    return one.x + (float)(i % CAMBER_CELL_PX);
}

static float pixel_y(cell_place one, int i) {
    return one.y + (float)(i / CAMBER_CELL_PX);
}

/* ---- Cells ---- */

/* How a cell lies to a segment, CAMBER_CELL_*, by its middle. range: where along the line it lies, px. */
static camber_u32 meets_cell(const drawn_segment *t, float x, float y, float range[2]) {
    const camber_edge *p = &t->edge;
    const camber_extras *e = &t->extras;
    camber_cell_masks m;
#if CAMBER_STROKE_PITCHED
    camber_cell_masks_of(p, x, y, &m);
#else
    camber_cell_masks_of(p, &t->bounds, x, y, &m);
#endif
    const camber_u32 far = m.full ? CAMBER_CELL_FULL : CAMBER_CELL_PARTIAL;
#if CAMBER_STROKE_PITCHED
    range[0] = INFINITY;
    range[1] = -INFINITY;
    return !m.partial ? CAMBER_CELL_OUTSIDE : m.near_end || e->features ? CAMBER_CELL_NEAR_END : far;
#else
    const camber_u32 meets = !m.partial ? CAMBER_CELL_OUTSIDE : m.near_end ? CAMBER_CELL_NEAR_END : far;
    if (!e->features)
        return meets;
    camber_pixel middle;
    camber_look(p, x, y, &middle);
    camber_extras_range(p, e, middle.x, range, range + 1);
    return camber_extras_cell(p, e, meets, middle.x, middle.y);
#endif
}

/* The area of a pixel at x, y. at: with a pitch a union's normal needs what the area is made from. */
static float area_of(const drawn_segment *t, camber_u32 meets, bool is_union, float x, float y, camber_pixel *at) {
    const bool aside = meets == CAMBER_CELL_PARTIAL;
    camber_look(&t->edge, x, y, at);
    if (t->extras.features && meets != CAMBER_CELL_FULL)
        return camber_stroke_area(&t->edge, &t->extras, t->extras.features, at, aside);
    at->along = camber_extras_along(&t->edge, &t->extras, at->x);
    if (meets == CAMBER_CELL_FULL)
        return 1.0f;
    if (!aside || (CAMBER_STROKE_PITCHED && is_union))
        return camber_edge_area(&t->edge, at);
    return camber_edge_side(&t->edge, x, y);
}

/* The normal of a segment from above that has no end near the pixel. Returns whether it is that. */
static bool find_side_normal(const drawn_segment *t, const camber_pixel *at, camber_u32 meets, float *nx, float *ny) {
    if (CAMBER_STROKE_PITCHED || meets == CAMBER_CELL_NEAR_END)
        return false;
    camber_side_normal(&t->edge, at->y, nx, ny);
    return true;
}

/* Adds the areas of a cell's pixels to the brush. */
static void put_pixels(camber_tile_state *c, const drawn_segment *t, int number, camber_u32 meets,
                       const cell_pixels *pixels) {
    for (int i = 0; i < CAMBER_VECTORS; i++) {
        const camber_pixel *at = pixels->at + i;
        bool thick = t->edge.half_width > CAMBER_UNION_PX;
        float nx, ny;
        if (c->now.mode != CAMBER_BRUSH_UNION) {
            camber_tile_put_over(c, number, i, pixels->area[i]);
            continue;
        }
        if (!find_side_normal(t, at, meets, &nx, &ny))
            thick = camber_edge_normal(&t->edge, at, &nx, &ny);
        camber_tile_put_union(c, number, i, pixels->area[i], thick, nx, ny);
    }
    camber_tile_count(c, number);
}

/* The colour of a pixel: of a ramp, and of an image along the line. range: where along the line the cell lies. */
static void find_color(const drawn_segment *t, const camber_pixel *at, const float range[2], float color[4]) {
    color[0] = color[1] = color[2] = color[3] = 1.0f;
    if (t->extras.features & CAMBER_FEATURE_RAMP)
        camber_ramp_over(&t->edge, &t->extras, at, range[0], range[1], color);
    if (t->extras.features & CAMBER_FEATURE_IMAGE) {
        camber_image_spot spot;
        float rgba[4];
        camber_line_spot(&t->edge, at, &spot);
        camber_line_image(&t->image, &spot, rgba);
        for (int k = 0; k < 4; k++)
            color[k] *= rgba[k];
    }
}

/* Puts colours that change from pixel to pixel under what a cell has. */
static void put_colors(camber_tile_state *c, const drawn_segment *t, int number, const cell_pixels *pixels,
                       float range[2]) {
#if CAMBER_STROKE_PITCHED
    for (int i = 0; i < CAMBER_VECTORS; i++) {
        const camber_pixel *at = pixels->at + i;
        const float reach = camber_extent_along(&t->edge, at);
        range[0] = CAMBER_LESS(range[0], at->along - reach);
        range[1] = CAMBER_MORE(range[1], at->along + reach);
    }
#endif
    camber_tile_take_level(c, camber_tile_level(c), number);
    for (int i = 0; i < CAMBER_VECTORS; i++) {
        float color[4];
        find_color(t, pixels->at + i, range, color);
        camber_tile_put_colors(c, number, i, pixels->area[i], color);
    }
}

/* Fills a cell with images: all of it, or the areas of its pixels. */
static void put_images(camber_tile_state *c, const drawn_segment *t, cell_place one, const float *areas) {
    camber_tile_take_level(c, camber_tile_level(c), one.number);
    for (int i = 0; i < CAMBER_VECTORS; i++) {
        const float x = pixel_x(one, i), y = pixel_y(one, i);
        camber_image_spot spot = {x, y, 0.0f, 0.0f, 0.0f};
        float color[4];
#if CAMBER_STROKE_PITCHED
        camber_plane_spot(t->eye, x, y, &spot);
#endif
        camber_fill_image(&t->image, &spot, color);
        camber_tile_put_colors(c, one.number, i, areas ? areas[i] : 1.0f, color);
    }
    camber_tile_count_colors(c, one.number, !areas);
}

static void draw_cell(camber_tile_state *c, const drawn_segment *t, cell_place one) {
    const bool is_union = c->now.mode == CAMBER_BRUSH_UNION;
    const bool has_colors = t->extras.features & CAMBER_FEATURES_COLORS;
    const float to_middle = 0.5f * (CAMBER_CELL_PX - 1);
    float range[2] = {0.0f, 0.0f};
    const camber_u32 meets = meets_cell(t, one.x + to_middle, one.y + to_middle, range);
    cell_pixels pixels;
    if (meets == CAMBER_CELL_OUTSIDE)
        return;
    if (t->is_fill && t->extras.features & CAMBER_FEATURE_IMAGE) {
        put_images(c, t, one, NULL);
        return;
    }
    if (!has_colors)
        camber_tile_take_cells(c, (camber_u64)1 << one.number);
    if (!has_colors && meets == CAMBER_CELL_FULL) {
        camber_tile_put_whole(c, one.number);
        return;
    }
    for (int i = 0; i < CAMBER_VECTORS; i++)
        pixels.area[i] = area_of(t, meets, is_union, pixel_x(one, i), pixel_y(one, i), pixels.at + i);
    if (has_colors) {
        put_colors(c, t, one.number, &pixels, range);
        camber_tile_count_colors(c, one.number, meets == CAMBER_CELL_FULL);
    } else {
        put_pixels(c, t, one.number, meets, &pixels);
    }
}

/* ---- Segments ---- */

/* Draws the cells of a tile that a segment may touch. */
static void draw_cells(camber_tile_state *c, const float *segment, const drawn_segment *t, camber_tile_rows where) {
    camber_footprint footprint;
    camber_cell_boxes box;
    camber_footprint_of(segment, &footprint);
    camber_cell_boxes_of(&footprint, where, 1, &box);
    for (int j = box.y; j < box.y + box.rows; j++)
        for (int k = box.x; k < box.x + box.columns; k++) {
            const float x = where.left + 0.5f + (float)(CAMBER_CELL_PX * k);
            const float y = where.top + 0.5f + (float)(CAMBER_CELL_PX * j);
            const int number = CAMBER_TILE_CELLS * j + k;
            if (!((c->done | c->filled) >> number & 1))
                draw_cell(c, t, (cell_place){number, x - t->eye.x, y - t->eye.y});
        }
}

static void draw_segment(camber_tile_state *c, const camber_twin *t, uint32_t which, camber_tile_rows where) {
    static const float no_lengths[CAMBER_SEGMENT_ARC_LENGTHS] = {0};
    const camber_raster_stages *stages = t->stages;
    const float *segment = stages->segments + (size_t)CAMBER_SEGMENT_WORDS * which;
    const float *arc_length =
        stages->arc_lengths ? stages->arc_lengths + CAMBER_SEGMENT_ARC_LENGTHS * (size_t)which : no_lengths;
    const camber_u32 flags = CAMBER_BITS(segment[CAMBER_SEGMENT_FLAGS]);
    drawn_segment by = {.extras = {0}, .eye = {0, 0, 0, 0}};
#if CAMBER_STROKE_PITCHED
    by.eye = t->scene->eye;
    camber_edge_of(by.eye, segment, stages->planes + (size_t)CAMBER_PLANE_WORDS * which, flags, &by.edge);
#else
    camber_edge_of(segment, flags, &by.edge);
    camber_cell_bounds_of(&by.edge, &by.bounds);
#endif
    by.is_fill = by.edge.half_width >= CAMBER_FILL_PX;
    if (c->brush_ext.features)
        camber_extras_of(&c->brush_ext, arc_length, t->scene->side_table, &by.extras);
    if (c->brush_ext.features & CAMBER_FEATURE_IMAGE)
        camber_image_line_of(t->scene->side_table, 4u * c->brush_ext.image, arc_length, &by.edge, &by.image);
    draw_cells(c, segment, &by, where);
}

/* ---- Tiles ---- */

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

/* Writes the pixels of a tile that lie in the area. */
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

/* A tile that is drawn. */
typedef struct drawn_tile {
    const camber_twin *twin;
    camber_tile_state *state;
    camber_crossings_left crossings; /* those of its row that are left */
    camber_tile_rows where;
    uint32_t column;
} drawn_tile;

static void add_edge(camber_tile_state *c, const float *ends, camber_tile_rows where) {
    camber_ring_edges e;
    camber_tile_edges t;
    camber_ring_edges_of(ends[0], ends[1], ends[2], ends[3], &e);
    camber_tile_edges_of(&e, 1, where, &t);
    camber_area_add(&c->area, &t, 1, where);
}

/* Draws the area whose edges have been added. */
static void end_area(const drawn_tile *d) {
    const camber_raster_scene *scene = d->twin->scene;
    camber_tile_state *c = d->state;
    drawn_segment by = {.eye = {0, 0, 0, 0}};
    if (!camber_brush_is_area(&c->now))
        return;
    if (!(c->brush_ext.features & CAMBER_FEATURE_IMAGE)) {
        camber_area_draw(c, d->where);
        return;
    }
    camber_area_cells found;
    camber_area_find(c, d->where, &found);
#if CAMBER_STROKE_PITCHED
    by.eye = scene->eye;
#endif
    camber_image_sampler_of(scene->side_table, 4u * c->brush_ext.image, &by.image);
    for (int i = 0; i < CAMBER_CELLS; i++) {
        const float x = d->where.left + 0.5f + (float)(CAMBER_CELL_PX * (i % CAMBER_TILE_CELLS)),
                    y = d->where.top + 0.5f + (float)(CAMBER_CELL_PX * (i / CAMBER_TILE_CELLS));
        if ((found.partial | found.whole) >> i & 1)
            put_images(c, &by, (cell_place){i, x - by.eye.x, y - by.eye.y},
                       found.whole >> i & 1 ? NULL : c->sums[i][CAMBER_AREA_INSIDE]);
    }
}

static void change_brush(drawn_tile *d, camber_u32 brush) {
    static const camber_brush_ext none = {0};
    const camber_raster_scene *scene = d->twin->scene;
    end_area(d);
    camber_tile_change_brush(d->state, scene->brushes[brush]);
    camber_tile_use_ext(d->state, scene->brush_ext ? scene->brush_ext[brush] : none);
}

/* Draws the areas above a brush of which the tile has no edges. */
static void draw_areas_above(drawn_tile *d, camber_u32 brush) {
    for (camber_u32 next = camber_next_area(&d->crossings); next > brush; next = camber_next_area(&d->crossings)) {
        const int winding = camber_take_winding(&d->crossings, next);
        if (winding == 0)
            continue;
        change_brush(d, next);
        d->state->winding = winding;
    }
}

static void draw_tile(drawn_tile *d, uint32_t row, camber_u32 crossing_count) {
    const camber_twin *t = d->twin;
    const camber_raster_stages *stages = t->stages;
    camber_tile_state *c = d->state;
    const size_t tile = (size_t)row * t->columns + d->column;
    uint32_t current = UINT32_MAX;
    d->where = (camber_tile_rows){(float)t->area->x + (float)(d->column * CAMBER_TILE_PX),
                                  (float)t->area->y + (float)(row * CAMBER_TILE_PX), 0, CAMBER_TILE_CELLS - 1};
    d->crossings.end = crossing_count;
    d->crossings.column = d->column;
    camber_tile_begin(c, ~(camber_u64)0, t->scene->brushes);
    for (uint32_t k = stages->starts[tile + 1]; k-- > stages->starts[tile];) {
        const size_t which = stages->lists[k];
        const bool is_edge = camber_twin_is_edge(t, which);
        const uint32_t brush =
            camber_bits_of(is_edge ? stages->edges[camber_edge_brush(which)]
                                   : stages->segments[CAMBER_SEGMENT_WORDS * which + CAMBER_SEGMENT_BRUSH]);
        if (brush != current) {
            draw_areas_above(d, brush);
            change_brush(d, brush);
            c->winding = camber_take_winding(&d->crossings, brush);
        }
        current = brush;
        if (is_edge)
            add_edge(c, stages->edges + camber_edge_ends(which), d->where);
        else
            draw_segment(c, t, stages->lists[k], d->where);
    }
    draw_areas_above(d, 0);
    end_area(d);
    camber_tile_end(c);
    write_tile(t, c, d->column, row);
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
#else
camber_status camber_twin_draw(const camber_twin *t) {
#endif
    const camber_raster_stages *stages = t->stages;
    const size_t edges = stages->starts[stages->list_count] - stages->starts[stages->tile_count];
    drawn_tile d = {.twin = t, .state = camber_alloc(t->context, 1, sizeof *d.state)};
    camber_u32 *crossings = camber_alloc(t->context, edges, CAMBER_CROSSING_WORDS * sizeof *crossings);
    const bool held = d.state && crossings;
    d.crossings.words = crossings;
    for (uint32_t row = 0; row < t->rows && held; row++) {
        const camber_u32 count = wind_row(t, row, crossings);
        for (d.column = 0; d.column < t->columns; d.column++)
            draw_tile(&d, row, count);
    }
    camber_free(t->context, crossings);
    camber_free(t->context, d.state);
    return held ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}
