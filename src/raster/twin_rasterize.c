/* rasterize of the CPU twin: draws the pixels of an area, tile by tile, from the tiles' lists of segments.
 *
 * Input: the segments, lists and brushes of a camber_twin. Output: its area's pixels. As in kernels/tile_state.cl, each
 * brush is gathered as the light that it lets through and then put under its level. Cells matter because segments below
 * a full cell are not drawn. The order of operations is that of the kernels, so that all bytes are equal. */
#include "raster/twin.h"

#include <math.h>
#include <string.h>

enum { CELL_PIXELS = CAMBER_CELL_PX * CAMBER_CELL_PX, CELLS = CAMBER_TILE_CELLS * CAMBER_TILE_CELLS, LEVELS = 3 };

typedef struct level {
    float color[3], through;
} level;

typedef struct pixel {
    float brush, sum, normal[2]; /* let through; a union's sums of areas and of normals */
    float mask;                  /* of a masked layer: its alpha */
    level levels[LEVELS];
} pixel;

typedef struct cell {
    pixel pixels[CELL_PIXELS];
    bool brushed, touched[LEVELS];
    bool done, filled;
    uint8_t blend_count; /* segments that have been drawn into the cell */
} cell;

typedef struct tile_state {
    cell cells[CELLS];
    bool is_open[LEVELS];
    camber_brush now;
    camber_brush_ext brush_ext;
    float layer_alpha; /* of a masked layer's colour, which covers as if it were opaque; else 1 */
} tile_state;

/* A segment with all that it is drawn from. */
typedef struct drawn_segment {
    camber_edge edge;
    camber_extras extras; /* all 0 if the brush has no features */
    bool tilted;          /* the picture has a pitch: tilted_edge counts, not edge */
    camber_pitch_edge tilted_edge;
    camber_eye eye;
    camber_image_sampler image;
    const float *side_table;
    bool is_fill;
} drawn_segment;

static void look_at_cell(cell *c, int at) {
    float most = 0.0f;
    for (int i = 0; i < CELL_PIXELS; i++)
        most = CAMBER_MORE(c->pixels[i].levels[0].through, most);
    c->done = c->done || (at == 0 && most < CAMBER_NOTHING_PX);
}

static void close_brush(tile_state *c) {
    const int at = c->is_open[2] ? 2 : c->is_open[1] ? 1 : 0;
    const camber_brush *brush = &c->now;
    for (cell *one = c->cells; one < c->cells + CELLS; one++) {
        for (int i = 0; i < CELL_PIXELS && one->brushed; i++) {
            pixel *p = one->pixels + i;
            level *l = p->levels + at;
            float area = 1.0f - p->brush;
            if (brush->mode == CAMBER_BRUSH_UNION)
                area = camber_united(area, p->sum, p->normal[0], p->normal[1]) * brush->a;
            const float through = l->through, seen = through * area * c->layer_alpha;
            p->mask += brush->mode == CAMBER_BRUSH_MASKED ? seen : 0.0f;
            l->color[0] += seen * brush->r;
            l->color[1] += seen * brush->g;
            l->color[2] += seen * brush->b;
            l->through = through * (1.0f - area);
            p->brush = 1.0f;
            p->sum = p->normal[0] = p->normal[1] = 0.0f;
        }
        if (one->brushed)
            look_at_cell(one, at);
        one->touched[at] = one->touched[at] || one->brushed;
        one->brushed = one->filled = false;
    }
}

static void close_level(tile_state *c, int at, float opacity) {
    const int below = at == 2 && c->is_open[1] ? 1 : 0;
    const bool masked = at == 2 && c->now.mode == CAMBER_BRUSH_MASKED;
    for (cell *one = c->cells; one < c->cells + CELLS; one++) {
        for (int i = 0; i < CELL_PIXELS && one->touched[at]; i++) {
            level *from = one->pixels[i].levels + at, *to = one->pixels[i].levels + below;
            const float through = to->through, seen = through * opacity;
            const float alpha = masked ? one->pixels[i].mask : 1.0f - from->through;
            for (int k = 0; k < 3; k++)
                to->color[k] += seen * from->color[k];
            to->through = through * (1.0f - alpha * opacity);
            one->pixels[i].mask = masked ? 0.0f : one->pixels[i].mask;
            *from = (level){{0.0f, 0.0f, 0.0f}, 1.0f};
        }
        if (one->touched[at])
            look_at_cell(one, below);
        one->touched[below] = one->touched[below] || one->touched[at];
        one->touched[at] = false;
    }
    c->is_open[at] = false;
}

static void change_brush(tile_state *c, camber_brush next, const camber_brush_ext *brush_ext) {
    close_brush(c);
    if (c->is_open[2] && next.layer != c->now.layer)
        close_level(c, 2, c->now.layer_opacity);
    if (c->is_open[1] && next.group != c->now.group)
        close_level(c, 1, c->now.group_opacity);
    c->is_open[1] = c->is_open[1] || next.group;
    c->is_open[2] = c->is_open[2] || next.layer;
    c->now = next;
    c->brush_ext = brush_ext ? *brush_ext : (camber_brush_ext){0};
    c->layer_alpha = 1.0f;
    if (next.mode == CAMBER_BRUSH_MASKED) {
        c->layer_alpha = next.a;
        c->now.a = 1.0f;
    }
}

/* Where a pixel lies: along and across the segment, and past its bisectors, px. */
typedef struct position {
    float x, y, fa, fb;
    float px, py; /* in the picture */
} position;

static position position_at(const camber_edge *p, float px, float py) {
    const float qx = px - p->ax, qy = py - p->ay;
    return (position){qx * p->ux + qy * p->uy,
                      qy * p->ux - qx * p->uy,
                      qx * p->nax + qy * p->nay,
                      (px - p->bx) * p->nbx + (py - p->by) * p->nby,
                      px,
                      py};
}

static float area_of(const drawn_segment *t, position at, camber_u32 meets) {
    const bool aside = meets == CAMBER_CELL_PARTIAL;
    if (meets == CAMBER_CELL_FULL)
        return 1.0f;
    if (t->extras.features)
        return camber_extras_area(&t->edge, &t->extras, aside, at.x, at.y, at.fa, at.fb);
    return aside ? camber_edge_side(&t->edge, at.y) : camber_edge_area(&t->edge, at.x, at.y, at.fa, at.fb);
}

/* Adds a segment's area of a pixel to the brush. */
static void put_pixel(const tile_state *c, const camber_edge *edge, pixel *p, position at, float area) {
    if (c->now.mode != CAMBER_BRUSH_UNION) {
        p->brush *= 1.0f - area * c->now.a;
        return;
    }
    p->brush *= 1.0f - area;
    if (edge->half_width > 0.4f) {
        const float weight = area * (1.0f - area);
        float nx, ny;
        camber_edge_normal(edge, at.x, at.y, &nx, &ny);
        p->sum += area;
        p->normal[0] += nx * weight;
        p->normal[1] += ny * weight;
    }
}

static float most_through(const cell *c) {
    float most = 0.0f;
    for (int i = 0; i < CELL_PIXELS; i++)
        most = CAMBER_MORE(c->pixels[i].brush, most);
    return most;
}

static void fill_cell(const tile_state *c, cell *one) {
    const bool is_union = c->now.mode == CAMBER_BRUSH_UNION;
    for (int i = 0; i < CELL_PIXELS; i++)
        one->pixels[i].brush *= is_union ? 0.0f : 1.0f - c->now.a;
    one->filled = is_union || c->now.a == 1.0f;
}

/* Counts a segment of a cell. After every CAMBER_LOOK_EVERY it checks if the cell is filled. */
static void count_blend(const tile_state *c, cell *one) {
    if (c->now.mode != CAMBER_BRUSH_UNION && ++one->blend_count % CAMBER_LOOK_EVERY == 0 && c->now.a == 1.0f)
        one->filled = most_through(one) < CAMBER_NOTHING_PX;
}

static void multiply_by_image(const drawn_segment *t, const camber_image_spot *spot, float color[4]) {
    float rgba[4];
    if (t->is_fill)
        camber_fill_image(t->side_table, &t->image, spot, rgba);
    else
        camber_line_image(t->side_table, &t->image, spot, rgba);
    for (int k = 0; k < 4; k++)
        color[k] *= rgba[k];
}

/* Multiplies a pixel's colour by the image that it shows. */
static void take_image(const drawn_segment *t, position at, float color[4]) {
    const camber_edge *p = &t->edge;
    const float past_a = -at.x - p->round_a, past_b = at.x - p->length - p->round_b;
    const float arc_a = past_a > 0.0f ? past_a : 0.0f, arc_b = past_b > 0.0f ? past_b : 0.0f;
    const camber_image_spot of_line = {at.x, at.y, sqrtf(arc_a * arc_a + arc_b * arc_b + at.y * at.y), 0.0f, 0.0f};
    const camber_image_spot of_plane = {at.px, at.py, 0.0f, 0.0f, 0.0f};
    multiply_by_image(t, t->is_fill ? &of_plane : &of_line, color);
}

static int level_now(const tile_state *c) {
    return c->is_open[2] ? 2 : c->is_open[1] ? 1 : 0;
}

/* Puts a colour that changes from pixel to pixel straight under what the level has. Returns what is still let through.
 */
static float put_color(const tile_state *c, pixel *p, float area, const float color[4]) {
    const bool masked = c->now.mode == CAMBER_BRUSH_MASKED;
    level *l = p->levels + level_now(c);
    const float through = l->through, seen = through * area * c->now.a;
    l->color[0] += seen * c->layer_alpha * color[0] * c->now.r;
    l->color[1] += seen * c->layer_alpha * color[1] * c->now.g;
    l->color[2] += seen * c->layer_alpha * color[2] * c->now.b;
    p->mask += masked ? seen * c->layer_alpha * color[3] : 0.0f;
    l->through = through * (1.0f - (masked ? area : area * c->now.a * color[3]));
    return l->through;
}

/* Counts a segment of such colours. most: the most that any pixel of the cell lets through. */
static void count_colors(const tile_state *c, cell *one, float most, bool inside) {
    const int at = level_now(c);
    one->touched[at] = true;
    if ((++one->blend_count % CAMBER_LOOK_EVERY == 0 || inside) && most < CAMBER_NOTHING_PX)
        *(at == 0 ? &one->done : &one->filled) = true;
}

static void put_colors(const tile_state *c, const drawn_segment *t, cell *one, const position positions[CELL_PIXELS],
                       float middle, camber_u32 meets) {
    float low, high, most = 0.0f;
    camber_extras_range(&t->edge, &t->extras, middle, &low, &high);
    for (int i = 0; i < CELL_PIXELS; i++) {
        float color[4] = {1.0f, 1.0f, 1.0f, 1.0f};
        if (t->extras.features & CAMBER_FEATURE_RAMP)
            camber_ramp_over(&t->edge, &t->extras, camber_extras_along(&t->edge, &t->extras, positions[i].x), low, high,
                             color);
        if (t->extras.features & CAMBER_FEATURE_IMAGE)
            take_image(t, positions[i], color);
        const float through = put_color(c, one->pixels + i, area_of(t, positions[i], meets), color);
        most = CAMBER_MORE(through, most);
    }
    count_colors(c, one, most, meets == CAMBER_CELL_FULL);
}

/* How a cell lies to a segment: CAMBER_CELL_*. */
static camber_u32 meets_cell(const drawn_segment *t, float middle_x, float middle_y) {
    const camber_edge *p = &t->edge;
    camber_cell_masks m;
    camber_cell_masks_of(p, middle_x, middle_y, &m);
    const bool inside = p->half_width > 2.0f && m.full;
    const camber_u32 far = inside ? CAMBER_CELL_FULL : CAMBER_CELL_PARTIAL;
    const camber_u32 meets = !m.partial ? CAMBER_CELL_OUTSIDE : m.near_end ? CAMBER_CELL_NEAR_END : far;
    const position middle = position_at(p, middle_x, middle_y);
    return t->extras.features ? camber_extras_cell(p, &t->extras, meets, middle.x, middle.y) : meets;
}

/* Draws a cell. px and py: its first pixel, px of the picture. */
static void draw_cell(tile_state *c, const drawn_segment *t, cell *one, float px, float py) {
    const float to_middle = 0.5f * (CAMBER_CELL_PX - 1);
    const camber_u32 meets = meets_cell(t, px + to_middle, py + to_middle);
    position positions[CELL_PIXELS];
    if (one->done || one->filled || meets == CAMBER_CELL_OUTSIDE)
        return;
    for (int i = 0; i < CELL_PIXELS; i++)
        positions[i] = position_at(&t->edge, px + (float)(i % CAMBER_CELL_PX), py + (float)(i / CAMBER_CELL_PX));
    if (t->extras.features & CAMBER_FEATURES_COLORS) {
        put_colors(c, t, one, positions, position_at(&t->edge, px + to_middle, py + to_middle).x, meets);
        return;
    }
    one->brushed = true;
    if (meets == CAMBER_CELL_FULL) {
        fill_cell(c, one);
        return;
    }
    for (int i = 0; i < CELL_PIXELS; i++)
        put_pixel(c, &t->edge, one->pixels + i, positions[i], area_of(t, positions[i], meets));
    count_blend(c, one);
}

static void put_tilted(const tile_state *c, const camber_pitch_edge *edge, pixel *p, float area,
                       const camber_pitch_pixel *at) {
    if (c->now.mode != CAMBER_BRUSH_UNION) {
        p->brush *= 1.0f - area * c->now.a;
        return;
    }
    const float weight = area * (1.0f - area);
    float nx, ny;
    p->brush *= 1.0f - area;
    if (camber_pitch_inward(edge, at, &nx, &ny)) {
        p->sum += area;
        p->normal[0] += nx * weight;
        p->normal[1] += ny * weight;
    }
}

/* Draws a cell of a picture with a pitch. x and y: its first pixel, px from the picture's middle, as below. */
static void draw_rich_tilted(const tile_state *c, const drawn_segment *t, cell *one, float x, float y) {
    const camber_pitch_edge *p = &t->tilted_edge;
    const camber_extras *e = &t->extras;
    const bool has_colors = e->features & CAMBER_FEATURES_COLORS;
    camber_pitch_pixel at[CELL_PIXELS];
    float area[CELL_PIXELS], along[CELL_PIXELS], range[2] = {INFINITY, -INFINITY}, most = 0.0f;
    for (int i = 0; i < CELL_PIXELS; i++) {
        camber_pitch_look(p, x + (float)(i % CAMBER_CELL_PX), y + (float)(i / CAMBER_CELL_PX), at + i);
        area[i] = camber_pitch_extras_area(p, e, at + i, along + i);
        const float reach = camber_pitch_extent(p, at + i);
        range[0] = CAMBER_LESS(range[0], along[i] - reach);
        range[1] = CAMBER_MORE(range[1], along[i] + reach);
    }
    for (int i = 0; i < CELL_PIXELS; i++) {
        float color[4] = {1.0f, 1.0f, 1.0f, 1.0f};
        if (!has_colors) {
            put_tilted(c, p, one->pixels + i, area[i], at + i);
            continue;
        }
        if (e->features & CAMBER_FEATURE_RAMP)
            camber_pitch_ramp(p, e, at + i, along[i], range, color);
        if (e->features & CAMBER_FEATURE_IMAGE) {
            camber_image_spot spot;
            camber_pitch_spot(p, at + i, &spot);
            multiply_by_image(t, &spot, color);
        }
        const float through = put_color(c, one->pixels + i, area[i], color);
        most = CAMBER_MORE(through, most);
    }
    if (has_colors) {
        count_colors(c, one, most, false);
    } else {
        one->brushed = true;
        count_blend(c, one);
    }
}

static void fill_tilted_cell(const tile_state *c, const drawn_segment *t, cell *one, float x, float y) {
    float most = 0.0f;
    for (int i = 0; i < CELL_PIXELS; i++) {
        float color[4] = {1.0f, 1.0f, 1.0f, 1.0f};
        camber_image_spot spot;
        camber_plane_spot(t->eye, x + (float)(i % CAMBER_CELL_PX), y + (float)(i / CAMBER_CELL_PX), &spot);
        multiply_by_image(t, &spot, color);
        const float through = put_color(c, one->pixels + i, 1.0f, color);
        most = CAMBER_MORE(through, most);
    }
    count_colors(c, one, most, true);
}

static void draw_tilted_cell(tile_state *c, const drawn_segment *t, cell *one, float x, float y) {
    const camber_pitch_edge *p = &t->tilted_edge;
    const bool is_union = c->now.mode == CAMBER_BRUSH_UNION;
    camber_cell_masks m;
    camber_pitch_cell_masks_of(p, x + 1.5f, y + 1.5f, &m);
    if (one->done || one->filled || !m.partial)
        return;
    if (t->extras.features & CAMBER_FEATURE_IMAGE && t->is_fill) {
        fill_tilted_cell(c, t, one, x, y);
        return;
    }
    if (t->extras.features) {
        draw_rich_tilted(c, t, one, x, y);
        return;
    }
    one->brushed = true;
    if (m.full && !m.near_end) {
        fill_cell(c, one);
        return;
    }
    for (int i = 0; i < CELL_PIXELS; i++) {
        const float px = x + (float)(i % CAMBER_CELL_PX), py = y + (float)(i / CAMBER_CELL_PX);
        camber_pitch_pixel at;
        if (!m.near_end && !is_union) {
            one->pixels[i].brush *= 1.0f - camber_pitch_side(p, px, py) * c->now.a;
        } else {
            camber_pitch_look(p, px, py, &at);
            put_tilted(c, p, one->pixels + i, camber_pitch_area(p, &at), &at);
        }
    }
    count_blend(c, one);
}

/* Draws the cells of a tile that a segment may touch. */
static void draw_cells(tile_state *c, const float *segment, const drawn_segment *t, float left, float top) {
    const float reach = segment[CAMBER_SEGMENT_REACH], a_cell = 1.0f / CAMBER_CELL_PX,
                side = (float)(CAMBER_TILE_CELLS - 1);
    const float ax = segment[CAMBER_SEGMENT_AX], ay = segment[CAMBER_SEGMENT_AY], bx = segment[CAMBER_SEGMENT_BX],
                by = segment[CAMBER_SEGMENT_BY];
    const float x0 = (CAMBER_LESS(ax, bx) - reach - left + 0.5f) * a_cell;
    const float x1 = (CAMBER_MORE(ax, bx) + reach - left - 0.5f) * a_cell;
    const float y0 = (CAMBER_LESS(ay, by) - reach - top + 0.5f) * a_cell;
    const float y1 = (CAMBER_MORE(ay, by) + reach - top - 0.5f) * a_cell;
    if (x1 < 0.0f || y1 < 0.0f || x0 >= side + 1.0f || y0 >= side + 1.0f)
        return;
    const int from_x = x0 > 0.0f ? (int)x0 : 0, to_x = x1 < side ? (int)x1 : CAMBER_TILE_CELLS - 1;
    const int from_y = y0 > 0.0f ? (int)y0 : 0, to_y = y1 < side ? (int)y1 : CAMBER_TILE_CELLS - 1;
    for (int j = from_y; j <= to_y; j++)
        for (int k = from_x; k <= to_x; k++) {
            cell *one = c->cells + CAMBER_TILE_CELLS * j + k;
            const float x = left + 0.5f + (float)(CAMBER_CELL_PX * k), y = top + 0.5f + (float)(CAMBER_CELL_PX * j);
            if (t->tilted)
                draw_tilted_cell(c, t, one, x - t->eye.x, y - t->eye.y);
            else
                draw_cell(c, t, one, x, y);
        }
}

static void begin_image(const tile_state *c, const float *arc_length, drawn_segment *by) {
    const camber_u32 at = 4u * c->brush_ext.image;
    if (by->tilted)
        camber_pitch_image_of(by->side_table, at, arc_length, &by->tilted_edge, &by->image);
    else
        camber_flat_image_of(by->side_table, at, arc_length, &by->edge, &by->image);
}

static void draw_segment(tile_state *c, const camber_twin *t, uint32_t which, float left, float top) {
    const camber_raster_stages *stages = t->stages;
    const float *segment = stages->segments + (size_t)CAMBER_SEGMENT_WORDS * which;
    const uint32_t flags = camber_as_word(segment[CAMBER_SEGMENT_FLAGS]);
    drawn_segment by;
    by.eye = t->scene->eye;
    by.tilted = stages->planes;
    by.extras.features = 0;
    if (by.tilted)
        camber_pitch_edge_of(by.eye, segment, stages->planes + (size_t)CAMBER_PLANE_WORDS * which, flags,
                             &by.tilted_edge);
    else
        camber_edge_of(segment, flags, &by.edge);
    const float *arc_length = stages->arc_lengths + CAMBER_SEGMENT_ARC_LENGTHS * (size_t)which;
    by.side_table = t->scene->side_table;
    by.is_fill = (by.tilted ? by.tilted_edge.half_width : by.edge.half_width) >= CAMBER_FILL_PX;
    if (c->brush_ext.features)
        camber_extras_of(&c->brush_ext, by.tilted ? NULL : &by.edge, arc_length, by.side_table, &by.extras);
    if (c->brush_ext.features & CAMBER_FEATURE_IMAGE)
        begin_image(c, arc_length, &by);
    draw_cells(c, segment, &by, left, top);
}

static uint8_t level_of(float value) {
    const float scaled = value * 255.0f + 0.5f, least = scaled > 0.0f ? scaled : 0.0f;
    return (uint8_t)(least < 255.0f ? least : 255.0f);
}

/* Writes the pixels of a tile that lie in the area. */
static void write_tile(const camber_twin *t, const tile_state *c, uint32_t column, uint32_t row) {
    const float *back = t->scene->background;
    const uint32_t left = column * CAMBER_TILE_PX, top = row * CAMBER_TILE_PX;
    for (uint32_t y = top; y < top + CAMBER_TILE_PX && y < t->area->height; y++)
        for (uint32_t x = left; x < left + CAMBER_TILE_PX && x < t->area->width; x++) {
            const uint32_t cx = (x - left) / CAMBER_CELL_PX, cy = (y - top) / CAMBER_CELL_PX;
            const uint32_t i = (y - top) % CAMBER_CELL_PX * CAMBER_CELL_PX + (x - left) % CAMBER_CELL_PX;
            const level *l = c->cells[CAMBER_TILE_CELLS * cy + cx].pixels[i].levels;
            uint8_t *rgba = t->stages->rgba + 4 * ((size_t)y * t->area->width + x);
            const float *sky = t->scene->sky;
            if (t->area->y + y < t->scene->horizon) {
                for (int k = 0; k < 4; k++)
                    rgba[k] = level_of(sky[k]);
                continue;
            }
            for (int k = 0; k < 3; k++)
                rgba[k] = level_of(l->color[k] + l->through * back[k]);
            rgba[3] = level_of(1.0f - l->through + l->through * back[3]);
        }
}

static void draw_tile(const camber_twin *t, tile_state *c, uint32_t column, uint32_t row) {
    const camber_raster_stages *stages = t->stages;
    const size_t tile = (size_t)row * t->columns + column;
    const float left = (float)t->area->x + (float)(column * CAMBER_TILE_PX);
    const float top = (float)t->area->y + (float)(row * CAMBER_TILE_PX);
    uint32_t current = UINT32_MAX;
    memset(c, 0, sizeof *c);
    for (int i = 0; i < CELLS * CELL_PIXELS; i++) {
        pixel *p = c->cells[i / CELL_PIXELS].pixels + i % CELL_PIXELS;
        p->brush = 1.0f;
        for (int k = 0; k < LEVELS; k++)
            p->levels[k].through = 1.0f;
    }
    c->now = t->scene->brushes[0];
    c->layer_alpha = 1.0f;
    for (uint32_t k = stages->starts[tile + 1]; k-- > stages->starts[tile];) {
        const float *segment = stages->segments + (size_t)CAMBER_SEGMENT_WORDS * stages->lists[k];
        const uint32_t brush = camber_as_word(segment[CAMBER_SEGMENT_BRUSH]);
        if (brush != current)
            change_brush(c, t->scene->brushes[brush], t->scene->brush_ext ? t->scene->brush_ext + brush : NULL);
        current = brush;
        draw_segment(c, t, stages->lists[k], left, top);
    }
    close_brush(c);
    if (c->is_open[2])
        close_level(c, 2, c->now.layer_opacity);
    if (c->is_open[1])
        close_level(c, 1, c->now.group_opacity);
    write_tile(t, c, column, row);
}

camber_status camber_twin_draw(const camber_twin *t) {
    tile_state *c = camber_alloc(t->context, 1, sizeof *c);
    if (!c)
        return CAMBER_ERROR_MEMORY;
    for (uint32_t row = 0; row < t->rows; row++)
        for (uint32_t column = 0; column < t->columns; column++)
            draw_tile(t, c, column, row);
    camber_free(t->context, c);
    return CAMBER_OK;
}
