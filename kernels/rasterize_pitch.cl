/* Draws segments in a picture with a pitch: pitch_coverage.h has the formulas. */
#include "pitch_features.h"
#include "rasterize_rich.cl"

#if CAMBER_RASTER_PITCHED

/* All that a segment in a picture with a pitch is drawn from. */
typedef struct tilted {
    global const float *segment, *plane, *arc_length, *side_table;
    camber_eye eye;
} tilted;

static inline void put_tilted(private tile_state *c, private const camber_pitch_edge *p, int i, float16 area,
                              private const camber_pitch_pixel *at) {
    c->brush[0][i] *= 1.0f - area;
    float16 nx, ny;
    const int16 thick = camber_pitch_inward(p, at, &nx, &ny);
    const float16 none = (float16)(0.0f), edge = area * (1.0f - area);
    c->brush[1][i] += thick ? area : none;
    c->brush[2][i] += thick ? nx * edge : none;
    c->brush[3][i] += thick ? ny * edge : none;
}

/* sort_cells for a picture with a pitch. */
static inline void sort_tilted(private const camber_pitch_edge *p, private const positions *at, cell_box box,
                               ulong cells, camber_eye eye, private cell_sets *sets) {
    sets->partial = sets->near_end = sets->full = 0;
    for (int j = box.from_y; j <= box.to_y; j += 4)
        for (int i = box.from_x; i <= box.to_x; i += 4) {
            camber_cell_masks m;
            const int first = CAMBER_TILE_CELLS * j + i;
            if (!(cells >> first & 0x0f0f0f0ful))
                continue;
            camber_pitch_cell_masks_of(p, at->middle_x[i] - eye.x, at->middle_y[j] - eye.y, &m);
            sets->partial |= (ulong)bits_of(m.partial) << first;
            sets->near_end |= (ulong)bits_of(m.near_end) << first;
            sets->full |= (ulong)bits_of(m.full) << first;
        }
    sets->partial &= cells;
    sets->near_end &= sets->partial;
    sets->full &= sets->partial & ~sets->near_end;
}

/* Draws cells with a brush that has features. */
static __attribute__((noinline)) void draw_rich_tilted(private tile_state *c, private const positions *at,
                                                       private const camber_pitch_edge *p, ulong meets, tilted from) {
    camber_extras e;
    camber_image_sampler image;
    camber_extras_of(&c->brush_ext, 0, from.arc_length, from.side_table, &e);
    if (e.features & CAMBER_FEATURE_IMAGE)
        camber_pitch_image_of(from.side_table, 4u * c->brush_ext.image, from.arc_length, p, &image);
    for (ulong left = meets; left; left &= left - 1) {
        const int i = lowest(left);
        camber_pitch_pixel pixels;
        float16 along;
        camber_pitch_look(p, at->x[i % CAMBER_TILE_CELLS] - from.eye.x, at->y[i / CAMBER_TILE_CELLS] - from.eye.y,
                          &pixels);
        const float16 area = camber_pitch_extras_area(p, &e, &pixels, &along);
        if (e.features & CAMBER_FEATURES_COLORS) {
            const float16 reach = camber_pitch_extent(p, &pixels);
            const float range[2] = {-most_of(reach - along), most_of(along + reach)};
            float16 color[4] = {(float16)(1.0f), (float16)(1.0f), (float16)(1.0f), (float16)(1.0f)};
            if (e.features & CAMBER_FEATURE_RAMP)
                camber_pitch_ramp(p, &e, &pixels, along, range, color);
            if (e.features & CAMBER_FEATURE_IMAGE) {
                camber_image_spot spot;
                float16 rgba[4];
                camber_pitch_spot(p, &pixels, &spot);
                camber_line_image(from.side_table, &image, &spot, rgba);
                for (int channel = 0; channel < 4; channel++)
                    color[channel] *= rgba[channel];
            }
            put_colors(c, i, area, color, 0);
            continue;
        }
        c->brushed |= 1ul << i;
        if (c->now.mode == CAMBER_BRUSH_UNION)
            put_tilted(c, p, i, area, &pixels);
        else
            put_over(c, i, area, c->now.a);
    }
}

/* draw_segment for a picture with a pitch. */
static inline void draw_tilted(private tile_state *c, private const positions *at, tile_rows where, tilted from) {
    cell_box box;
    cell_sets sets;
    camber_pitch_edge p;
    const ulong cells = box_of(from.segment, where, &box) & ~(c->done | c->filled);
    const int is_union = c->now.mode == CAMBER_BRUSH_UNION;
    if (!cells)
        return;
    if (c->brush_ext.features & CAMBER_FEATURE_IMAGE && from.plane[CAMBER_PLANE_HALF_WIDTH] >= CAMBER_FILL_PX) {
        fill_with_images(c, at, from.eye, from.side_table);
        return;
    }
    camber_pitch_edge_of(from.eye, from.segment, from.plane, as_uint(from.segment[CAMBER_SEGMENT_FLAGS]), &p);
    sort_tilted(&p, at, box, cells, from.eye, &sets);
    if (c->brush_ext.features) {
        draw_rich_tilted(c, at, &p, sets.partial, from);
        return;
    }
    for (ulong left = sets.partial & ~sets.full; left; left &= left - 1) {
        const int i = lowest(left);
        const float16 x = at->x[i % CAMBER_TILE_CELLS] - from.eye.x, y = at->y[i / CAMBER_TILE_CELLS] - from.eye.y;
        camber_pitch_pixel pixels;
        if (!is_union && !(sets.near_end >> i & 1ul)) {
            put_over(c, i, camber_pitch_side(&p, x, y), c->now.a);
            continue;
        }
        camber_pitch_look(&p, x, y, &pixels);
        const float16 area = camber_pitch_area(&p, &pixels);
        if (is_union)
            put_tilted(c, &p, i, area, &pixels);
        else
            put_over(c, i, area, c->now.a);
    }
    if (sets.full)
        put_whole(c, sets.full);
    c->brushed |= sets.partial;
}

#endif
