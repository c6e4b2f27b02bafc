/* Draws segments of brushes with features: features.h and images.h have the formulas. */
#ifndef CAMBER_RASTERIZE_RICH_CL
#define CAMBER_RASTERIZE_RICH_CL

#include "pitch_images.h"
#include "rasterize_cells.cl"

#if CAMBER_RASTER_RICH

/* Puts colours that change from pixel to pixel straight under what the level has. */
static inline void put_colors(private tile_state *c, int i, float16 area, private const float16 *color, int whole) {
    const int level = c->is_open[2] ? 2 : c->is_open[1] ? 1 : 0;
    const float16 through = c->level[level][3][i], seen = through * area * c->now.a;
    c->level[level][0][i] += seen * c->layer_alpha * color[0] * c->now.r;
    c->level[level][1][i] += seen * c->layer_alpha * color[1] * c->now.g;
    c->level[level][2][i] += seen * c->layer_alpha * color[2] * c->now.b;
    if (c->now.mode == CAMBER_BRUSH_MASKED) {
        c->mask[i] += seen * c->layer_alpha * color[3];
        c->level[level][3][i] = through * (1.0f - area);
    } else {
        c->level[level][3][i] = through * (1.0f - area * c->now.a * color[3]);
    }
    c->touched[level] |= 1ul << i;
    if (++c->blend_count[i] % CAMBER_LOOK_EVERY && !whole)
        return;
    if (most_of(c->level[level][3][i]) < CAMBER_NOTHING_PX)
        *(level == 0 ? &c->done : &c->filled) |= 1ul << i;
}

/* Fills all cells that are not full with images. */
static inline void fill_with_images(private tile_state *c, private const positions *at, camber_eye eye,
                                    global const float *side_table) {
    camber_image_sampler m;
    camber_image_sampler_of(side_table, 4u * c->brush_ext.image, &m);
    for (ulong cells = ~c->done; cells; cells &= cells - 1) {
        const int i = lowest(cells);
        camber_image_spot spot;
        float16 rgba[4];
#if CAMBER_RASTER_PITCHED
        camber_plane_spot(eye, at->x[i % CAMBER_TILE_CELLS] - eye.x, at->y[i / CAMBER_TILE_CELLS] - eye.y, &spot);
#else
        spot.x = at->x[i % CAMBER_TILE_CELLS];
        spot.y = at->y[i / CAMBER_TILE_CELLS];
        spot.distance = spot.reach_x = spot.reach_y = (float16)(0.0f);
#endif
        camber_fill_image(side_table, &m, &spot, rgba);
        put_colors(c, i, (float16)(1.0f), rgba, 1);
    }
}

#if !CAMBER_RASTER_PITCHED
/* Multiplies the colours of a line's pixels by its image. */
static inline void image_line(global const float *side_table, private const camber_edge *p,
                              private const camber_image_sampler *m, float16 x, float16 y, private float16 *color) {
    const float16 none = (float16)(0.0f), past_a = -x - p->round_a, past_b = x - p->length - p->round_b;
    const float16 arc_a = past_a > 0.0f ? past_a : none, arc_b = past_b > 0.0f ? past_b : none;
    camber_image_spot at;
    float16 rgba[4];
    at.x = x;
    at.y = y;
    at.distance = sqrt(arc_a * arc_a + arc_b * arc_b + y * y);
    at.reach_x = at.reach_y = none;
    camber_line_image(side_table, m, &at, rgba);
    for (int channel = 0; channel < 4; channel++)
        color[channel] *= rgba[channel];
}

/* Draws a segment of a brush with features. */
static __attribute__((noinline)) void draw_rich(private tile_state *c, private const positions *at,
                                                global const float *segment, tile_rows where,
                                                global const float *arc_length, global const float *side_table) {
    cell_box box;
    cell_sets sets;
    camber_edge p;
    camber_extras e;
    camber_image_sampler image;
    pixel_set set;
    const ulong cells = box_of(segment, where, &box) & ~(c->done | c->filled);
    if (!cells)
        return;
    if (c->brush_ext.features & CAMBER_FEATURE_IMAGE && segment[CAMBER_SEGMENT_HALF_WIDTH] >= CAMBER_FILL_PX) {
        fill_with_images(c, at, (camber_eye){0, 0, 0, 0}, side_table);
        return;
    }
    camber_edge_of(segment, as_uint(segment[CAMBER_SEGMENT_FLAGS]), &p);
    if (c->brush_ext.features & CAMBER_FEATURE_IMAGE)
        camber_flat_image_of(side_table, 4u * c->brush_ext.image, arc_length, &p, &image);
    camber_extras_of(&c->brush_ext, &p, arc_length, side_table, &e);
    sort_cells(&p, at, box, cells, &sets);
    for (ulong left = sets.partial; left; left &= left - 1) {
        const int i = lowest(left);
        const float qx = where.left + (float)(CAMBER_CELL_PX * (i % CAMBER_TILE_CELLS)) + 0.5f * CAMBER_CELL_PX - p.ax;
        const float qy = where.top + (float)(CAMBER_CELL_PX * (i / CAMBER_TILE_CELLS)) + 0.5f * CAMBER_CELL_PX - p.ay;
        const float middle = qx * p.ux + qy * p.uy, aside = qy * p.ux - qx * p.uy;
        const camber_u32 far = sets.full >> i & 1ul ? CAMBER_CELL_FULL : CAMBER_CELL_PARTIAL;
        const camber_u32 meets =
            camber_extras_cell(&p, &e, sets.near_end >> i & 1ul ? CAMBER_CELL_NEAR_END : far, middle, aside);
        float16 area = (float16)(1.0f);
        if (meets == CAMBER_CELL_OUTSIDE)
            continue;
        find_pixels(&p, at, i, &set);
        if (meets != CAMBER_CELL_FULL)
            area = camber_extras_area(&p, &e, meets == CAMBER_CELL_PARTIAL, set.x, set.y, set.fa, set.fb);
        if (e.features & CAMBER_FEATURES_COLORS) {
            float low, high;
            float16 color[4] = {(float16)(1.0f), (float16)(1.0f), (float16)(1.0f), (float16)(1.0f)};
            if (e.features & CAMBER_FEATURE_RAMP) {
                camber_extras_range(&p, &e, middle, &low, &high);
                camber_ramp_over(&p, &e, camber_extras_along(&p, &e, set.x), low, high, color);
            }
            if (e.features & CAMBER_FEATURE_IMAGE)
                image_line(side_table, &p, &image, set.x, set.y, color);
            put_colors(c, i, area, color, meets == CAMBER_CELL_FULL);
            continue;
        }
        c->brushed |= 1ul << i;
        if (meets == CAMBER_CELL_FULL)
            put_whole(c, 1ul << i);
        else
            put_area(c, &p, i, area, set.x, set.y);
    }
}

#endif
#endif

#endif
