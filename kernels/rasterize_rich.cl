/* Draws segments of brushes with features: features.h and images.h have the formulas. */
#ifndef CAMBER_RASTERIZE_RICH_CL
#define CAMBER_RASTERIZE_RICH_CL

#include "area_inside.h"
#include "cells_of_one.cl"

#if CAMBER_RASTER_RICH

/* Fills cells with images: completely, or by the areas in their sums. */
static inline void fill_with_images(camber_tile_state *c, const positions *at, drawn_segment from,
                                    camber_area_cells cells) {
    camber_image_sampler m;
    camber_image_sampler_of(from.side_table, 4u * c->brush_ext.image, &m);
    for (ulong left = cells.partial | cells.whole; left; left &= left - 1) {
        const int i = camber_lowest(left), is_whole = (int)(cells.whole >> i & 1ul);
        camber_tile_take_level(c, camber_tile_level(c), i);
        for (int v = 0; v < CAMBER_VECTORS; v++) {
            const camber_real x = pixels_x(at, from, i), y = pixels_y(at, from, i, v);
            camber_image_spot spot;
            camber_real rgba[4];
#if CAMBER_RASTER_PITCHED
            camber_plane_spot(camber_fill_eye(&m, from.eye), x, y, &spot);
#else
            spot.x = x;
            spot.y = y;
            spot.distance = spot.reach_x = spot.reach_y = CAMBER_REAL(0.0f);
#endif
            camber_fill_image(&m, &spot, rgba);
            camber_tile_put_colors(c, i, v, is_whole ? CAMBER_REAL(1.0f) : c->sums[i][CAMBER_AREA_INSIDE][v], rgba);
        }
        camber_tile_count_colors(c, i, is_whole);
    }
}

/* A segment with everything that its features need. */
typedef struct rich_segment {
    camber_edge edge;
    camber_extras extras;
    camber_image_sampler image;
    drawn_segment from;
} rich_segment;

/* Finds the position of a cell relative to the features: CAMBER_CELL_*. range: where along the line the cell is, in px.
 * With a pitch all cells are drawn as if an end were near. */
static inline camber_u32 find_left(const rich_segment *t, const cell_sets *sets, int i, camber_tile_rows where,
                                   float range[2]) {
#if CAMBER_RASTER_PITCHED
    return CAMBER_CELL_NEAR_END;
#else
    const camber_edge *p = &t->edge;
    const float qx = where.left + (float)(CAMBER_CELL_PX * (i % CAMBER_TILE_CELLS)) + 0.5f * CAMBER_CELL_PX - p->ax;
    const float qy = where.top + (float)(CAMBER_CELL_PX * (i / CAMBER_TILE_CELLS)) + 0.5f * CAMBER_CELL_PX - p->ay;
    const float middle = qx * p->ux + qy * p->uy, aside = qy * p->ux - qx * p->uy;
    const camber_u32 far = sets->full >> i & 1ul ? CAMBER_CELL_FULL : CAMBER_CELL_PARTIAL;
    if (t->extras.features & CAMBER_FEATURE_RAMP)
        camber_extras_range(p, &t->extras, middle, range, range + 1);
    return camber_extras_cell(p, &t->extras, sets->near_end >> i & 1ul ? CAMBER_CELL_NEAR_END : far, middle, aside);
#endif
}

/* The positions of a cell's pixels relative to the segment, and their areas. */
typedef struct cell_pixels {
    camber_pixel at[CAMBER_VECTORS];
    camber_real area[CAMBER_VECTORS];
} cell_pixels;

static inline void find_areas_of_one(const rich_segment *t, const positions *at, int i, camber_u32 meets,
                                     cell_pixels *pixels) {
    const camber_edge *p = &t->edge;
    const camber_extras *e = &t->extras;
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        camber_pixel *one = pixels->at + v;
        camber_look(p, pixels_x(at, t->from, i), pixels_y(at, t->from, i, v), one);
        pixels->area[v] = CAMBER_REAL(1.0f);
        if (meets == CAMBER_CELL_NEAR_END)
            pixels->area[v] = camber_stroke_area(p, e, e->features, one, CAMBER_NO);
        else if (meets == CAMBER_CELL_PARTIAL)
            pixels->area[v] = camber_stroke_area(p, e, e->features, one, CAMBER_YES);
        else
            one->along = camber_extras_along(p, e, one->x);
    }
}

/* Finds the colours of pixels: of a ramp, or of an image along the line. */
static inline void find_colors(const rich_segment *t, const camber_pixel *pixels, const float range[2],
                               camber_real *color) {
    for (int channel = 0; channel < 4; channel++)
        color[channel] = CAMBER_REAL(1.0f);
    if (t->extras.features & CAMBER_FEATURE_RAMP)
        camber_ramp_over(&t->edge, &t->extras, pixels, range[0], range[1], color);
    if (t->extras.features & CAMBER_FEATURE_IMAGE) {
        camber_image_spot spot;
        camber_real rgba[4];
        camber_line_spot(&t->edge, pixels, &spot);
        camber_line_image(&t->image, &spot, rgba);
        for (int channel = 0; channel < 4; channel++)
            color[channel] *= rgba[channel];
    }
}

/* Composites colours that change from pixel to pixel under the colours that a cell already has. */
static inline void put_colors(camber_tile_state *c, const rich_segment *t, int i, const cell_pixels *pixels,
                              float range[2]) {
#if CAMBER_RASTER_PITCHED
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        const camber_real along = pixels->at[v].along, reach = camber_extent_along(&t->edge, pixels->at + v);
        range[0] = CAMBER_LESS(range[0], -camber_most_of(reach - along));
        range[1] = CAMBER_MORE(range[1], camber_most_of(along + reach));
    }
#endif
    camber_tile_take_level(c, camber_tile_level(c), i);
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        camber_real color[4];
        find_colors(t, pixels->at + v, range, color);
        camber_tile_put_colors(c, i, v, pixels->area[v], color);
    }
}

/* Draws a cell that the segment touches. */
static inline void draw_rich_cell(camber_tile_state *c, const positions *at, const rich_segment *t, int i,
                                  camber_u32 meets, float range[2]) {
    const int whole = meets == CAMBER_CELL_FULL;
    cell_pixels pixels;
    if (t->extras.features & CAMBER_FEATURES_COLORS) {
        find_areas_of_one(t, at, i, meets, &pixels);
        put_colors(c, t, i, &pixels, range);
        camber_tile_count_colors(c, i, whole);
        return;
    }
    camber_tile_take_cells(c, 1ul << i);
    if (whole) {
        camber_tile_put_whole(c, i);
        return;
    }
    find_areas_of_one(t, at, i, meets, &pixels);
    for (int v = 0; v < CAMBER_VECTORS; v++)
        put_area(c, &t->edge, i, v, pixels.area[v], pixels.at + v);
    camber_tile_count(c, i);
}

/* Draws a segment of a brush with features. */
static __attribute__((noinline)) void draw_rich(camber_tile_state *c, const positions *at, camber_tile_rows where,
                                                drawn_segment from) {
    cell_sets sets;
    rich_segment t;
    const ulong cells = box_of(from.segment, where) & ~(c->done | c->filled);
    if (!cells)
        return;
    t.from = from;
    begin_edge(from, &t.edge);
    if (c->brush_ext.features & CAMBER_FEATURE_IMAGE)
        camber_image_line_of(from.side_table, 4u * c->brush_ext.image, from.arc_length, &t.edge, &t.image);
    camber_extras_of(&c->brush_ext, from.arc_length, from.side_table, &t.extras);
    sort_cells(from, &t.edge, at, cells, &sets);
    for (ulong left = sets.partial; left; left &= left - 1) {
        const int i = camber_lowest(left);
        float range[2] = {0.0f, 0.0f};
        const camber_u32 meets = find_left(&t, &sets, i, where, range);
        if (meets != CAMBER_CELL_OUTSIDE)
            draw_rich_cell(c, at, &t, i, meets, range);
    }
}

#endif

#endif
