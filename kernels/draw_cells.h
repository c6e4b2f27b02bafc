/* Draws cells of a tile, one segment and one pixel at a time: for rasterize on GPUs, and for the CPU twin.
 *
 * Input: a segment and everything that it is drawn from, or a brush. Output: a tile's state. Which segments a cell is
 * drawn from is up to twin_rasterize.c and rasterize_gpu.cl. On a CPU device, rasterize draws sixteen segments and
 * pixels side by side (rasterize.cl). All use tile_state.h for everything that happens to a pixel. */
#ifndef CAMBER_KERNELS_DRAW_CELLS_H
#define CAMBER_KERNELS_DRAW_CELLS_H

#include "area_inside.h"

/* Everything that a tile is drawn from. */
typedef struct camber_draw_source {
    CAMBER_GLOBAL const float *segments, *edges, *arc_lengths, *planes, *side_table;
    CAMBER_GLOBAL const camber_brush *brushes;
    CAMBER_GLOBAL const camber_brush_ext *brush_ext; /* NULL: no brush has features */
    camber_u32 first_edge, edge_count;               /* all edges of rings are among these segments */
    camber_eye eye;                                  /* 0 in a picture without a pitch */
} camber_draw_source;

/* A cell of a tile: its number in the tile's state, the position of its first pixel in the picture, with a pitch
 * relative to the picture's middle, and which of its pixels is the first one that is drawn. */
typedef struct camber_cell_place {
    int number;
    float x, y;
    int first;
} camber_cell_place;

/* The tile being drawn. */
typedef struct camber_drawn_tile {
    camber_draw_source from;
    camber_crossings_left left; /* crossings of its row that no brush has taken yet */
    camber_tile_rows where;
    camber_u32 brush; /* the current brush; ~0: none yet */
#if CAMBER_SHARES_TILE
    camber_cell_place own;
#endif
} camber_drawn_tile;

/* A segment with everything that it is drawn from. */
typedef struct camber_drawn_segment {
    camber_edge edge;
#if !CAMBER_STROKE_PITCHED
    camber_cell_bounds bounds; /* bounds for cells, from the edge */
#endif
    camber_eye eye;
#if CAMBER_HAS_MASKS
    camber_extras extras; /* all 0 if the brush has no features */
    camber_image_sampler image;
#endif
} camber_drawn_segment;

#if CAMBER_HAS_MASKS
#define CAMBER_FEATURES_OF(t) ((t)->extras.features)
#else
#define CAMBER_FEATURES_OF(t) 0u
#endif

/* Returns the place of a cell, given its number in the tile. */
CAMBER_FN camber_cell_place camber_place_of(camber_tile_rows where, camber_eye eye, int cell) {
    const float x = where.left + 0.5f + (float)(CAMBER_CELL_PX * (cell % CAMBER_TILE_CELLS));
    const float y = where.top + 0.5f + (float)(CAMBER_CELL_PX * (cell / CAMBER_TILE_CELLS));
    const camber_cell_place place = {cell, x - eye.x, y - eye.y, 0};
    return place;
}

/* The position of pixel i of those that are drawn. */
CAMBER_FN float camber_pixel_x(camber_cell_place one, int i) {
    return one.x + (float)((one.first + i) % CAMBER_CELL_PX);
}

CAMBER_FN float camber_pixel_y(camber_cell_place one, int i) {
    return one.y + (float)((one.first + i) / CAMBER_CELL_PX);
}

/* ---- Cells ---- */

/* Returns the position of a cell relative to a segment, CAMBER_CELL_*, given its middle. range: where along the line it
 * is, in px. */
CAMBER_FN camber_u32 camber_segment_meets(const camber_drawn_segment *t, float x, float y, float range[2]) {
    const camber_edge *p = &t->edge;
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
    return !m.partial ? CAMBER_CELL_OUTSIDE : m.near_end || CAMBER_FEATURES_OF(t) ? CAMBER_CELL_NEAR_END : far;
#else
    const camber_u32 meets = !m.partial ? CAMBER_CELL_OUTSIDE : m.near_end ? CAMBER_CELL_NEAR_END : far;
    (void)range;
#if CAMBER_HAS_MASKS
    if (t->extras.features) {
        camber_pixel middle;
        camber_look(p, x, y, &middle);
        camber_extras_range(p, &t->extras, middle.x, range, range + 1);
        return camber_extras_cell(p, &t->extras, meets, middle.x, middle.y);
    }
#endif
    return meets;
#endif
}

/* Returns the area of a pixel at x, y. at is an output, because with a pitch a union's normal needs the values that the
 * area is computed from. */
CAMBER_FN float camber_drawn_area(const camber_drawn_segment *t, camber_u32 meets, int is_union, float x, float y,
                                  camber_pixel *at) {
    const int with_all = CAMBER_STROKE_PITCHED & is_union;
    camber_look(&t->edge, x, y, at);
#if CAMBER_HAS_MASKS
    if (t->extras.features && meets != CAMBER_CELL_FULL)
        return camber_stroke_area(&t->edge, &t->extras, t->extras.features, at, meets == CAMBER_CELL_PARTIAL);
    at->along = camber_extras_along(&t->edge, &t->extras, at->x);
#endif
    if (meets == CAMBER_CELL_FULL)
        return 1.0f;
    if (meets == CAMBER_CELL_NEAR_END || with_all)
        return camber_edge_area(&t->edge, at);
    return camber_edge_side(&t->edge, x, y);
}

/* The pixels of a cell as the segment sees them, and their areas. */
typedef struct camber_cell_pixels {
    camber_pixel at[CAMBER_OWN_VECTORS];
    float area[CAMBER_OWN_VECTORS];
} camber_cell_pixels;

/* Adds the areas of a cell's pixels to the brush. */
CAMBER_FN void camber_put_pixels(camber_tile_state *c, const camber_drawn_segment *t, int number, camber_u32 meets,
                                 const camber_cell_pixels *pixels) {
    const int near_end = CAMBER_STROKE_PITCHED | (meets == CAMBER_CELL_NEAR_END);
    for (int i = 0; i < CAMBER_OWN_VECTORS; i++) {
        const camber_pixel *at = pixels->at + i;
        int thick = t->edge.half_width > CAMBER_UNION_PX;
        float nx, ny;
        if (c->now.mode != CAMBER_BRUSH_UNION) {
            camber_tile_put_over(c, number, i, pixels->area[i]);
            continue;
        }
        if (near_end)
            thick = camber_edge_normal(&t->edge, at, &nx, &ny);
        else
            camber_side_normal(&t->edge, at->y, &nx, &ny);
        camber_tile_put_union(c, number, i, pixels->area[i], thick, nx, ny);
    }
    camber_tile_count(c, number);
}

#if CAMBER_HAS_MASKS
/* Returns the colour of a pixel, from a ramp or from an image along the line. range: where along the line the cell is.
 */
CAMBER_FN void camber_drawn_color(const camber_drawn_segment *t, const camber_pixel *at, const float range[2],
                                  float color[4]) {
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

#if CAMBER_STROKE_PITCHED
/* Returns where along the line all pixels of a cell are, also those that another work-item draws. */
CAMBER_FN void camber_cell_range(const camber_drawn_segment *t, camber_cell_place one, camber_u32 meets,
                                 float range[2]) {
    one.first = 0;
    for (int i = 0; i < CAMBER_VECTORS; i++) {
        camber_pixel at;
        camber_drawn_area(t, meets, 0, camber_pixel_x(one, i), camber_pixel_y(one, i), &at);
        const float reach = camber_extent_along(&t->edge, &at);
        range[0] = CAMBER_LESS(range[0], at.along - reach);
        range[1] = CAMBER_MORE(range[1], at.along + reach);
    }
}
#endif

/* Composites colours that change from pixel to pixel under the colours that a cell already has. range: where along the
 * line the cell is. */
CAMBER_FN void camber_put_colors(camber_tile_state *c, const camber_drawn_segment *t, int number,
                                 const camber_cell_pixels *pixels, const float range[2]) {
    camber_tile_take_level(c, camber_tile_level(c), number);
    for (int i = 0; i < CAMBER_OWN_VECTORS; i++) {
        float color[4];
        camber_drawn_color(t, pixels->at + i, range, color);
        camber_tile_put_colors(c, number, i, pixels->area[i], color);
    }
}

/* Fills a cell with images: all of it, or only the areas of its pixels. */
CAMBER_FN void camber_put_images(camber_tile_state *c, const camber_drawn_segment *t, camber_cell_place one,
                                 const float *areas) {
    camber_tile_take_level(c, camber_tile_level(c), one.number);
    for (int i = 0; i < CAMBER_OWN_VECTORS; i++) {
        const float x = camber_pixel_x(one, i), y = camber_pixel_y(one, i);
        camber_image_spot spot = {x, y, 0.0f, 0.0f, 0.0f};
        float color[4];
#if CAMBER_STROKE_PITCHED
        camber_plane_spot(camber_fill_eye(&t->image, t->eye), x, y, &spot);
#endif
        camber_fill_image(&t->image, &spot, color);
        camber_tile_put_colors(c, one.number, i, areas ? areas[i] : 1.0f, color);
    }
    camber_tile_count_colors(c, one.number, !areas);
}
#endif

CAMBER_FN void camber_draw_cell(camber_tile_state *c, const camber_drawn_segment *t, camber_cell_place one) {
    const int is_union = c->now.mode == CAMBER_BRUSH_UNION;
    const float to_middle = 0.5f * (CAMBER_CELL_PX - 1);
    float range[2] = {0.0f, 0.0f};
    const camber_u32 meets = camber_segment_meets(t, one.x + to_middle, one.y + to_middle, range);
    const int has_colors = CAMBER_HAS(CAMBER_FEATURES_OF(t), CAMBER_FEATURES_COLORS);
    camber_cell_pixels pixels;
    if (meets == CAMBER_CELL_OUTSIDE)
        return;
    if (!has_colors)
        camber_tile_take_cells(c, (camber_u64)1 << one.number);
    if (!has_colors && meets == CAMBER_CELL_FULL) {
        camber_tile_put_whole(c, one.number);
        return;
    }
    for (int i = 0; i < CAMBER_OWN_VECTORS; i++)
        pixels.area[i] =
            camber_drawn_area(t, meets, is_union, camber_pixel_x(one, i), camber_pixel_y(one, i), pixels.at + i);
#if CAMBER_HAS_MASKS
    if (has_colors) {
#if CAMBER_STROKE_PITCHED
        camber_cell_range(t, one, meets, range);
#endif
        camber_put_colors(c, t, one.number, &pixels, range);
        camber_tile_count_colors(c, one.number, meets == CAMBER_CELL_FULL);
        return;
    }
#endif
    camber_put_pixels(c, t, one.number, meets, &pixels);
}

/* ---- Segments ---- */

CAMBER_FN void camber_begin_segment(const camber_draw_source *from, const camber_tile_state *c, size_t which,
                                    camber_drawn_segment *t) {
    CAMBER_GLOBAL const float *segment = from->segments + CAMBER_SEGMENT_WORDS * which;
    const camber_u32 flags = CAMBER_BITS(segment[CAMBER_SEGMENT_FLAGS]);
    t->eye = from->eye;
#if CAMBER_STROKE_PITCHED
    camber_edge_of(from->eye, segment, from->planes + CAMBER_PLANE_WORDS * which, flags, &t->edge);
#else
    camber_edge_of(segment, flags, &t->edge);
    camber_cell_bounds_of(&t->edge, &t->bounds);
#endif
#if CAMBER_HAS_MASKS
    CAMBER_GLOBAL const float *arc_length = from->arc_lengths + CAMBER_SEGMENT_ARC_LENGTHS * which;
    const camber_extras none = {0};
    t->extras = none;
    if (c->brush_ext.features)
        camber_extras_of(&c->brush_ext, arc_length, from->side_table, &t->extras);
    if (t->extras.features & CAMBER_FEATURE_IMAGE)
        camber_image_line_of(from->side_table, 4u * c->brush_ext.image, arc_length, &t->edge, &t->image);
#else
    (void)c;
#endif
}

/* Returns the brush of an edge of a ring, or CAMBER_NO_EDGE if segment `which` is none. */
CAMBER_FN camber_u32 camber_brush_of_edge(const camber_draw_source *from, size_t which) {
    return (camber_u32)which - from->first_edge < from->edge_count ? CAMBER_BITS(from->edges[camber_edge_brush(which)])
                                                                   : CAMBER_NO_EDGE;
}

CAMBER_FN camber_u32 camber_brush_of_segment(const camber_draw_source *from, size_t which) {
    return CAMBER_BITS(from->segments[CAMBER_SEGMENT_WORDS * which + CAMBER_SEGMENT_BRUSH]);
}

/* ---- Areas ---- */

/* Draws the inside of a polygon in cells that have been found. */
CAMBER_NOINLINE void camber_draw_found(camber_tile_state *c, const camber_drawn_tile *d, camber_area_cells found) {
#if CAMBER_HAS_MASKS
    if (c->brush_ext.features & CAMBER_FEATURE_IMAGE) {
        camber_drawn_segment by;
        by.eye = d->from.eye;
        camber_image_sampler_of(d->from.side_table, 4u * c->brush_ext.image, &by.image);
        for (camber_u64 left = found.partial | found.whole; left; left &= left - 1) {
            const int i = CAMBER_LOWEST_CELL(left);
#if CAMBER_SHARES_TILE
            const camber_cell_place one = d->own;
#else
            const camber_cell_place one = camber_place_of(d->where, by.eye, i);
#endif
            camber_put_images(c, &by, one, found.whole >> i & 1 ? 0 : c->sums[i][CAMBER_AREA_INSIDE]);
        }
        return;
    }
#endif
    (void)d;
    camber_area_put(c, found);
}

/* Draws the polygon whose edges have been added. */
CAMBER_FN void camber_end_area(camber_tile_state *c, const camber_drawn_tile *d) {
    camber_area_cells found;
    if (!camber_brush_is_area(&c->now))
        return;
    camber_area_find(c, d->where, &found);
    camber_draw_found(c, d, found);
}

/* ---- Tiles ---- */

CAMBER_NOINLINE void camber_draw_with(camber_tile_state *c, camber_drawn_tile *d, camber_u32 brush) {
    camber_end_area(c, d);
    camber_tile_change_brush(c, d->from.brushes[brush]);
#if CAMBER_HAS_MASKS
    camber_brush_ext none = {0};
    camber_tile_use_ext(c, d->from.brush_ext ? d->from.brush_ext[brush] : none);
#endif
    d->brush = brush;
}

/* Draws the areas above a brush that have no edges in the tile. */
CAMBER_FN void camber_draw_areas_above(camber_tile_state *c, camber_drawn_tile *d, camber_u32 brush) {
    for (camber_u32 next = camber_next_area(&d->left, &c->now); next > brush;
         next = camber_next_area(&d->left, &c->now)) {
        const int winding = camber_take_winding(&d->left, next) + (next == c->now.fill);
        if (winding == 0)
            continue;
        camber_draw_with(c, d, next);
        c->winding = winding;
    }
}

/* Changes to the brush of a segment or edge. */
CAMBER_FN void camber_draw_next_with(camber_tile_state *c, camber_drawn_tile *d, camber_u32 brush) {
    if (brush == d->brush)
        return;
    camber_draw_areas_above(c, d, brush);
    camber_draw_with(c, d, brush);
    c->winding = camber_take_winding(&d->left, brush);
}

#endif
