/* The state of a tile while rasterize draws it, and how a tile spills it between slices and restores it.
 *
 * Drawing goes from front to back. Each brush is gathered first, as the share of light that it lets through. Then it is
 * put under what its level has so far: the picture, the open group, or the open layer. A closed layer or group goes
 * under the level below it in the same way. */
#ifndef CAMBER_TILE_STATE_CL
#define CAMBER_TILE_STATE_CL

#include "features.h"

#define CELLS (CAMBER_TILE_CELLS * CAMBER_TILE_CELLS)
#define LEVELS 3 /* the picture, a group, a layer */

#if CAMBER_LANES == 16
typedef struct tile_state {
    float16 brush[4][CELLS];         /* let through; a union's sums of areas and of normals, too */
    float16 level[LEVELS][4][CELLS]; /* red, green, blue, premultiplied; let through */
    ulong brushed, touched[LEVELS];  /* cells that the brush, and each level, has drawn in; a bit each */
    ulong done;                      /* cells in which nothing below shows */
    ulong filled;                    /* cells in which no more of the same brush shows */
    int is_open[LEVELS], is_ready[LEVELS], has_sums;
    uchar blend_count[CELLS]; /* segments that have been drawn into the cell */
    camber_brush now;
#if CAMBER_RASTER_RICH
    camber_brush_ext brush_ext; /* the same brush's extension */
    float layer_alpha;          /* of a masked layer's colour, which covers as if it were opaque; else 1 */
    float16 mask[CELLS];        /* of a masked layer: its alpha, as its level holds what it does not cover */
#endif
} tile_state;

#if CAMBER_RASTER_RICH
/* How much of the covered area is seen: a masked colour by its alpha. */
#define WITH_LAYER_ALPHA(c, i, seen) with_layer_alpha(c, i, seen)
static inline float16 with_layer_alpha(private tile_state *c, int i, float16 seen) {
    const float16 shown = seen * c->layer_alpha;
    if (c->now.mode == CAMBER_BRUSH_MASKED)
        c->mask[i] += shown;
    return shown;
}

/* The area that a layer covers; a masked one gives its mask, which is cleared. */
#define LAYER_AREA(c, i, level) layer_area(c, i, level)
static inline float16 layer_area(private tile_state *c, int i, int level) {
    const float16 alpha = c->mask[i];
    if (level != 2 || c->now.mode != CAMBER_BRUSH_MASKED)
        return 1.0f - c->level[level][3][i];
    c->mask[i] = (float16)(0.0f);
    return alpha;
}

static inline void use_brush_ext(private tile_state *c, camber_brush_ext brush_ext) {
    c->brush_ext = brush_ext;
    c->layer_alpha = 1.0f;
    if (c->now.mode == CAMBER_BRUSH_MASKED) {
        c->layer_alpha = c->now.a;
        c->now.a = 1.0f;
    }
}
#else
#define WITH_LAYER_ALPHA(c, i, seen) (seen)
#define LAYER_AREA(c, i, level) (1.0f - (c)->level[level][3][i])
#endif

static inline float most_of(float16 v) {
    const float8 a = v.lo > v.hi ? v.lo : v.hi;
    const float4 b = a.lo > a.hi ? a.lo : a.hi;
    const float2 c = b.lo > b.hi ? b.lo : b.hi;
    return c.x > c.y ? c.x : c.y;
}

static inline int lowest(ulong bits) {
    return (int)popcount((bits - 1) & ~bits);
}

static inline void clear_level(private tile_state *c, int level) {
    for (int i = 0; i < CELLS; i++) {
        c->level[level][0][i] = c->level[level][1][i] = c->level[level][2][i] = (float16)(0.0f);
        c->level[level][3][i] = (float16)(1.0f);
    }
}

static inline void begin_tile_state(private tile_state *c, ulong cells) {
#if CAMBER_RASTER_RICH
    for (int i = 0; i < CELLS; i++)
        c->mask[i] = (float16)(0.0f);
    c->layer_alpha = 1.0f;
#endif
    for (int i = 0; i < CELLS; i++)
        c->brush[0][i] = (float16)(1.0f);
    clear_level(c, 0);
    for (int i = 0; i < CELLS / 16; i++)
        vstore16((uchar16)(0), i, c->blend_count);
    c->brushed = c->filled = c->touched[0] = c->touched[1] = c->touched[2] = 0;
    c->done = ~cells;
    c->is_open[0] = c->is_ready[0] = 1;
    c->is_open[1] = c->is_open[2] = c->is_ready[1] = c->is_ready[2] = c->has_sums = 0;
}

/* Marks a cell as done if nothing shows through the picture's level. */
static inline void look_at_cell(private tile_state *c, int i, int level) {
    if (level == 0 && most_of(c->level[0][3][i]) < CAMBER_NOTHING_PX)
        c->done |= 1ul << i;
}

/* Puts the gathered brush under what its level has. */
static inline void close_brush(private tile_state *c) {
    const int level = c->is_open[2] ? 2 : c->is_open[1] ? 1 : 0;
    const int is_union = c->now.mode == CAMBER_BRUSH_UNION;
    for (ulong left = c->brushed; left; left &= left - 1) {
        const int i = lowest(left);
        float16 area = 1.0f - c->brush[0][i];
        if (is_union) {
            area = camber_united(area, c->brush[1][i], c->brush[2][i], c->brush[3][i]) * c->now.a;
            c->brush[1][i] = c->brush[2][i] = c->brush[3][i] = (float16)(0.0f);
        }
        const float16 through = c->level[level][3][i], seen = WITH_LAYER_ALPHA(c, i, through * area);
        c->level[level][0][i] += seen * c->now.r;
        c->level[level][1][i] += seen * c->now.g;
        c->level[level][2][i] += seen * c->now.b;
        c->level[level][3][i] = through * (1.0f - area);
        c->brush[0][i] = (float16)(1.0f);
        look_at_cell(c, i, level);
    }
    c->touched[level] |= c->brushed;
    c->brushed = c->filled = 0;
}

/* Puts a layer or a group under what the level below has. */
static inline void close_level(private tile_state *c, int level, float opacity) {
    const int below = level == 2 && c->is_open[1] ? 1 : 0;
    for (ulong left = c->touched[level]; left; left &= left - 1) {
        const int i = lowest(left);
        const float16 through = c->level[below][3][i], seen = through * opacity;
        for (int k = 0; k < 3; k++) {
            c->level[below][k][i] += seen * c->level[level][k][i];
            c->level[level][k][i] = (float16)(0.0f);
        }
        c->level[below][3][i] = through * (1.0f - LAYER_AREA(c, i, level) * opacity);
        c->level[level][3][i] = (float16)(1.0f);
        look_at_cell(c, i, below);
    }
    c->touched[below] |= c->touched[level];
    c->touched[level] = 0;
    c->is_open[level] = 0;
}

static inline void open_level(private tile_state *c, int level) {
    if (!c->is_ready[level])
        clear_level(c, level);
    c->is_open[level] = c->is_ready[level] = 1;
}

static inline void clear_sums(private tile_state *c) {
    for (int i = 0; i < CELLS; i++)
        c->brush[1][i] = c->brush[2][i] = c->brush[3][i] = (float16)(0.0f);
    c->has_sums = 1;
}

/* Closes the brush, and the layer and group that the next brush does not belong to. Opens those that it does. */
static inline void change_brush(private tile_state *c, camber_brush next) {
    close_brush(c);
    if (c->is_open[2] && next.layer != c->now.layer)
        close_level(c, 2, c->now.layer_opacity);
    if (c->is_open[1] && next.group != c->now.group)
        close_level(c, 1, c->now.group_opacity);
    if (next.group && !c->is_open[1])
        open_level(c, 1);
    if (next.layer && !c->is_open[2])
        open_level(c, 2);
    if (next.mode == CAMBER_BRUSH_UNION && !c->has_sums)
        clear_sums(c);
    c->now = next;
}

/* Adds a segment's area of a cell to a brush that is not a union. */
static inline void put_over(private tile_state *c, int i, float16 area, float opacity) {
    const float16 through = c->brush[0][i] * (1.0f - area * opacity);
    c->brush[0][i] = through;
    if (++c->blend_count[i] % CAMBER_LOOK_EVERY == 0 && opacity == 1.0f && most_of(through) < CAMBER_NOTHING_PX)
        c->filled |= 1ul << i;
}

static inline void put_area(private tile_state *c, private const camber_edge *p, int i, float16 area, float16 x,
                            float16 y) {
    if (c->now.mode != CAMBER_BRUSH_UNION) {
        put_over(c, i, area, c->now.a);
        return;
    }
    c->brush[0][i] *= 1.0f - area;
    if (p->half_width > 0.4f) {
        float16 nx, ny;
        camber_edge_normal(p, x, y, &nx, &ny);
        const float16 edge = area * (1.0f - area);
        c->brush[1][i] += area;
        c->brush[2][i] += nx * edge;
        c->brush[3][i] += ny * edge;
    }
}

/* Draws cells that lie inside the stroke as a whole. */
static inline void put_whole(private tile_state *c, ulong cells) {
    const int is_union = c->now.mode == CAMBER_BRUSH_UNION;
    const float through = is_union ? 0.0f : 1.0f - c->now.a;
    for (ulong left = cells; left; left &= left - 1)
        c->brush[0][lowest(left)] *= through;
    if (through == 0.0f)
        c->filled |= cells;
}

/* ---- Between slices ---- */

static inline void spill_planes(global float *planes, private const float16 (*from)[CELLS], camber_u32 plane,
                                camber_u32 count, ulong cells) {
    for (; cells; cells &= cells - 1)
        for (camber_u32 k = 0; k < count; k++)
            vstore16(from[k][lowest(cells)], (size_t)(plane + k) * CELLS + (size_t)lowest(cells), planes);
}

static inline void restore_planes(global const float *planes, private float16 (*to)[CELLS], camber_u32 plane,
                                  camber_u32 count, ulong cells) {
    for (; cells; cells &= cells - 1)
        for (camber_u32 k = 0; k < count; k++)
            to[k][lowest(cells)] = vload16((size_t)(plane + k) * CELLS + (size_t)lowest(cells), planes);
}

/* Spills the state of rows of cells [first, last]. now: the brush, and which levels are open. */
static inline void spill_cells(private const tile_state *c, global float *spill, camber_spill_args s, int first,
                               int last, camber_u32 now) {
    global uchar *bits = (global uchar *)spill, *blend_count = bits + CAMBER_SPILL_BLEND_COUNTS;
    global camber_u32 *rows = (global camber_u32 *)spill + CAMBER_SPILL_ROWS;
    global float *planes = spill + CAMBER_SPILL_WORDS;
    const ulong of[6] = {c->brushed, c->filled, c->done, c->touched[0], c->touched[1], c->touched[2]};
    for (int j = first; j <= last; j++) {
        for (int k = 0; k < 6; k++)
            bits[CAMBER_TILE_CELLS * k + j] = (uchar)(of[k] >> (CAMBER_TILE_CELLS * j));
        vstore8(vload8((size_t)j, c->blend_count), (size_t)j, blend_count);
        rows[j] = now;
    }
    spill_planes(planes, c->brush, 0, 1, c->brushed);
    spill_planes(planes, c->level[0], 1, 4, c->touched[0]);
    if (c->now.mode == CAMBER_BRUSH_UNION)
        spill_planes(planes, c->brush + 1, s.sums, 3, c->brushed);
    spill_planes(planes, c->level[1], s.group, 4, c->touched[1]);
    spill_planes(planes, c->level[2], s.layer, 4, c->touched[2]);
#if CAMBER_RASTER_RICH
    if (c->now.mode == CAMBER_BRUSH_MASKED)
        spill_planes(planes, &c->mask, s.layer + 4, 1, c->touched[2]);
#endif
}

/* Restores rows of cells [first, last]. Returns the brush that was drawn last, ~0 if none was, or CAMBER_SPILL_FULL.
 * All rows that are not full have been drawn from the same list, so they have the same brush and open levels. */
static inline camber_u32 restore_cells(private tile_state *c, global const float *spill,
                                       global const camber_brush *brushes, camber_spill_args s, int first, int last) {
    global const uchar *bits = (global const uchar *)spill, *blend_count = bits + CAMBER_SPILL_BLEND_COUNTS;
    global const camber_u32 *rows = (global const camber_u32 *)spill + CAMBER_SPILL_ROWS;
    global const float *planes = spill + CAMBER_SPILL_WORDS;
    ulong of[6] = {0, 0, 0, 0, 0, 0};
    camber_u32 now = CAMBER_SPILL_FULL;
    for (int j = first; j <= last; j++) {
        for (int k = 0; k < 6; k++)
            of[k] |= (ulong)bits[CAMBER_TILE_CELLS * k + j] << (CAMBER_TILE_CELLS * j);
        vstore8(vload8((size_t)j, blend_count), (size_t)j, c->blend_count);
        now = rows[j] == CAMBER_SPILL_FULL ? now : rows[j];
    }
    c->brushed = of[0];
    c->filled = of[1];
    c->done |= of[2];
    for (int k = 0; k < LEVELS; k++)
        c->touched[k] = of[3 + k];
    restore_planes(planes, c->brush, 0, 1, c->brushed);
    restore_planes(planes, c->level[0], 1, 4, c->touched[0]);
    if (now == CAMBER_SPILL_FULL)
        return now;
    for (int k = 1; k < LEVELS; k++)
        if (now >> (29 + k) & 1u) {
            open_level(c, k);
            restore_planes(planes, c->level[k], k == 1 ? s.group : s.layer, 4, c->touched[k]);
        }
    if ((now & CAMBER_SPILL_BRUSH) == CAMBER_SPILL_BRUSH)
        return ~0u;
    c->now = brushes[now & CAMBER_SPILL_BRUSH];
    if (c->now.mode == CAMBER_BRUSH_UNION) {
        clear_sums(c);
        restore_planes(planes, c->brush + 1, s.sums, 3, c->brushed);
    }
#if CAMBER_RASTER_RICH
    if (c->now.mode == CAMBER_BRUSH_MASKED)
        restore_planes(planes, &c->mask, s.layer + 4, 1, c->touched[2]);
#endif
    return now & CAMBER_SPILL_BRUSH;
}
#endif

#endif
