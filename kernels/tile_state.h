/* The accumulator of a tile: the state that rasterize keeps for the tile's pixels while it draws segments into them.
 *
 * Input: areas of pixels, brush by brush, from front to back. Output: the tile's pixels. Each brush is accumulated
 * first, as the fraction of light that it lets through. Then it is composited under the colours that its level has so
 * far: the picture, the open group, or the open layer. A closed layer or group is composited under the level below it
 * in the same way.
 *
 * The sixteen pixels of a cell are in CAMBER_VECTORS vectors. The kernels have one or two, and the twin, which compiles
 * this file too, has sixteen of one lane. A work-item of a GPU has only the four pixels of its row. A cell that has
 * received nothing is not stored: the sets of cells say so. */
#ifndef CAMBER_KERNELS_TILE_STATE_H
#define CAMBER_KERNELS_TILE_STATE_H

#include "cells.h"

#ifdef CAMBER_DEVICE
typedef uchar camber_u8;
typedef ushort camber_u16;
#else
typedef uint8_t camber_u8;
typedef uint16_t camber_u16;
#endif

/* The levels, from the bottom up. */
#define CAMBER_PICTURE 0
#define CAMBER_GROUP 1
#define CAMBER_LAYER 2
#define CAMBER_LEVELS 3

/* The twin draws plain frames with the code for masked layers, of which it finds none. */
#if !defined(CAMBER_DEVICE) || CAMBER_RASTER_RICH
#define CAMBER_HAS_MASKS 1
#else
#define CAMBER_HAS_MASKS 0
#endif

/* Areas and winding numbers of a brush of polygons are integers in fixed point, with this for a whole pixel: their sums
 * do not depend on the order, and edges in opposite directions cancel. */
#define CAMBER_AREA_ONE 65536
/* A brush of polygons: how its edges change a tile (area.h). If work-items share a tile, they share this too. */
typedef struct camber_area_state {
    /* Changes of the winding: the edges of a cell change its pixels, and all edges left of a cell change it and the
     * cells right of it. The last column is right of the tile. */
    camber_words changes[CAMBER_TILE_CELLS][CAMBER_TILE_CELLS + 1][2][CAMBER_VECTORS];
    /* Just below the tops of rows of cells, and at the tile's lower end: the change of the winding number at a cell's
     * left side, for it and everything right of it. */
    int turns[CAMBER_TILE_CELLS + 1][CAMBER_TILE_CELLS + 1];
    int placed_count; /* edges of the brush in the tile */
    camber_u64 edged; /* cells that edges pass; rows of cells without them have no changes */
#if !CAMBER_SHARES_TILE
    int has_edges;  /* if false, nothing else is set */
    int kept_count; /* edges that are here: all unless they are more than CAMBER_PLACED_MOST */
    float placed[CAMBER_PLACED_WORDS][CAMBER_PLACED_MOST + CAMBER_LANES];
#endif
} camber_area_state;

#define CAMBER_AREA_HERE 0
#define CAMBER_AREA_ON 1
#define CAMBER_AREA_INSIDE 0
#define CAMBER_AREA_SUM 1

typedef struct camber_tile_state {
    /* Numbers of a cell that are used together are stored together, because planes of 4 KB conflict in the first-level
     * cache. */
    camber_real brush[CAMBER_OWN_CELLS][CAMBER_OWN_VECTORS]; /* let through */
    /* For a union: sums of areas and of normals. For polygons: what is inside each pixel, and the sums of the winding
     * numbers. */
    camber_real sums[CAMBER_OWN_CELLS][3][CAMBER_OWN_VECTORS];
    /* Red, green, blue, premultiplied; let through. */
    camber_real level[CAMBER_LEVELS][CAMBER_OWN_CELLS][4][CAMBER_OWN_VECTORS];
    camber_u64 brushed, touched[CAMBER_LEVELS]; /* cells that the brush, and each level, has drawn in; one bit each */
    camber_u64 done;                            /* cells in which nothing below shows through */
    camber_u64 filled;                          /* cells in which no more of the same brush would show */
    camber_u64 whole; /* cells that the brush covers completely and opaquely: they have one colour */
    int is_open[CAMBER_LEVELS];
    int winding;                             /* winding number of the brush's rings at the tile's top left corner */
    camber_u8 blend_count[CAMBER_OWN_CELLS]; /* segments that have been drawn into the cell */
    camber_brush now;
#if !CAMBER_SHARES_TILE
    camber_area_state area;
#endif
#if CAMBER_HAS_MASKS
    camber_brush_ext brush_ext; /* the same brush's extension */
    float layer_alpha;          /* alpha of a masked layer's colour, which covers as if it were opaque; else 1 */
    camber_real mask[CAMBER_OWN_CELLS][CAMBER_OWN_VECTORS]; /* alpha of a masked layer; its coverage is in its level */
#endif
} camber_tile_state;

/* Returns the number of the lowest bit that is set. */
CAMBER_FN int camber_lowest(camber_u64 bits) {
#ifdef CAMBER_DEVICE
    return (int)popcount((bits - 1) & ~bits);
#else
    int lowest = 0;
    for (int step = 32; step > 0; step /= 2)
        if (!(bits >> lowest & (((camber_u64)1 << step) - 1)))
            lowest += step;
    return lowest;
#endif
}

/* The lowest cell of a set of own cells. */
#define CAMBER_LOWEST_CELL(cells) (CAMBER_OWN_CELLS == 1 ? 0 : camber_lowest(cells))

/* Less than CAMBER_NOTHING_PX counts as nothing, in each pixel. So in a cell that lets nothing through, what is below
 * changes nothing: skipping it, whenever that is noticed, changes only the time. */
CAMBER_FN camber_real camber_let_through(camber_real through) {
    return through < CAMBER_NOTHING_PX ? CAMBER_REAL(0.0f) : through;
}

/* Whether all pixels of a cell let nothing through. */
CAMBER_FN int camber_lets_nothing(const camber_real *through) {
    camber_real most = through[0];
    for (int v = 1; v < CAMBER_OWN_VECTORS; v++)
        most = CAMBER_MORE(through[v], most);
    return camber_most_of(most) < CAMBER_NOTHING_PX;
}

/* Returns the level that a brush is drawn into. */
CAMBER_FN int camber_tile_level(const camber_tile_state *c) {
    return c->is_open[CAMBER_LAYER] ? CAMBER_LAYER : c->is_open[CAMBER_GROUP] ? CAMBER_GROUP : CAMBER_PICTURE;
}

/* Begins a tile. cells: those that are drawn. first: the first brush. */
CAMBER_FN void camber_tile_begin(camber_tile_state *c, camber_u64 cells, CAMBER_GLOBAL const camber_brush *first) {
    for (int i = 0; i < CAMBER_OWN_CELLS; i++)
        c->blend_count[i] = 0;
    c->brushed = c->filled = c->whole = 0;
#if !CAMBER_SHARES_TILE
    c->area.has_edges = 0;
#endif
    c->winding = 0;
    for (int k = 0; k < CAMBER_LEVELS; k++) {
        c->touched[k] = 0;
        c->is_open[k] = k == CAMBER_PICTURE;
    }
    c->done = ~cells;
    c->now = *first;
#if CAMBER_HAS_MASKS
    c->brush_ext.features = 0;
    c->layer_alpha = 1.0f;
#endif
}

/* Whether no further segment would show. A cell that is filled in a layer or group may still be translucent. */
CAMBER_FN int camber_tile_is_full(const camber_tile_state *c) {
    const int opaque =
        c->now.mode != CAMBER_BRUSH_UNION && c->now.mode != CAMBER_BRUSH_SUM && camber_tile_level(c) == CAMBER_PICTURE;
    return (c->done | (opaque ? c->filled : 0)) == ~(camber_u64)0;
}

/* ---- Brushes ---- */

/* Prepares cells that the brush is about to draw in, and has not drawn in yet. */
CAMBER_FN void camber_tile_take_cells(camber_tile_state *c, camber_u64 cells) {
    for (camber_u64 left = cells & ~c->brushed; left; left &= left - 1) {
        const int i = CAMBER_LOWEST_CELL(left);
        for (int v = 0; v < CAMBER_OWN_VECTORS; v++)
            c->brush[i][v] = CAMBER_REAL(1.0f);
        for (int k = 0; k < 3 && c->now.mode == CAMBER_BRUSH_UNION; k++)
            for (int v = 0; v < CAMBER_OWN_VECTORS; v++)
                c->sums[i][k][v] = CAMBER_REAL(0.0f);
    }
    c->brushed |= cells;
}

/* Adds a segment's area to a vector of a cell, for a brush that is not a union. */
CAMBER_FN void camber_tile_put_over(camber_tile_state *c, int i, int v, camber_real area) {
    c->brush[i][v] *= 1.0f - area * c->now.a;
}

/* Adds a segment's area for a union. (nx, ny): the normal of the nearest edge. thick: the pixels in which the line has
 * a normal. */
CAMBER_FN void camber_tile_put_union(camber_tile_state *c, int i, int v, camber_real area, camber_mask thick,
                                     camber_real nx, camber_real ny) {
    const camber_real none = CAMBER_REAL(0.0f), edge = area * (1.0f - area);
    c->brush[i][v] *= 1.0f - area;
    c->sums[i][0][v] += thick ? area : none;
    c->sums[i][1][v] += thick ? nx * edge : none;
    c->sums[i][2][v] += thick ? ny * edge : none;
}

/* Counts a segment that was drawn into a cell. After every CAMBER_FULL_CHECK_INTERVAL it checks if the cell is filled.
 * Unions and sums are exact, so they do not stop early. */
CAMBER_FN void camber_tile_count(camber_tile_state *c, int i) {
    if (c->now.mode != CAMBER_BRUSH_UNION && c->now.mode != CAMBER_BRUSH_SUM &&
        ++c->blend_count[i] % CAMBER_FULL_CHECK_INTERVAL == 0 && c->now.a == 1.0f && camber_lets_nothing(c->brush[i]))
        c->filled |= (camber_u64)1 << i;
}

/* Draws a cell that is completely inside the stroke. */
CAMBER_FN void camber_tile_put_whole(camber_tile_state *c, int i) {
    const float through = c->now.mode == CAMBER_BRUSH_UNION ? 0.0f : 1.0f - c->now.a;
    for (int v = 0; v < CAMBER_OWN_VECTORS; v++)
        c->brush[i][v] *= through;
    if (through == 0.0f) {
        c->filled |= (camber_u64)1 << i;
        /* A union's opacity is applied later, and a sum has more than one colour. */
        c->whole |= c->now.mode == CAMBER_BRUSH_UNION || c->now.mode == CAMBER_BRUSH_SUM ? 0 : (camber_u64)1 << i;
    }
}

/* ---- Levels ---- */

/* Prepares a level that is about to be drawn in: clears the level's values of the cell, unless something was drawn
 * there before. */
CAMBER_FN void camber_tile_take_level(camber_tile_state *c, int level, int i) {
    const camber_u64 bit = (camber_u64)1 << i;
    if (c->touched[level] & bit)
        return;
    c->touched[level] |= bit;
    for (int v = 0; v < CAMBER_OWN_VECTORS; v++) {
        c->level[level][i][0][v] = c->level[level][i][1][v] = c->level[level][i][2][v] = CAMBER_REAL(0.0f);
        c->level[level][i][3][v] = CAMBER_REAL(1.0f);
#if CAMBER_HAS_MASKS
        if (level == CAMBER_LAYER)
            c->mask[i][v] = CAMBER_REAL(0.0f);
#endif
    }
}

/* Marks a cell as done if nothing shows through the picture's level. */
CAMBER_FN void camber_tile_look(camber_tile_state *c, int level, int i) {
    if (level == CAMBER_PICTURE && camber_lets_nothing(c->level[CAMBER_PICTURE][i][3]))
        c->done |= (camber_u64)1 << i;
}

/* Returns the fraction of light that a level lets through in a vector. is_new: the level has nothing of the cell yet,
 * and nothing is stored. */
CAMBER_FN camber_real camber_tile_through(const camber_tile_state *c, int level, int i, int v, int is_new) {
    return is_new ? CAMBER_REAL(1.0f) : c->level[level][i][3][v];
}

/* Adds a value to the stored one, or stores it if it is the first. */
CAMBER_FN void camber_tile_add(camber_real *stored, camber_real more, int is_new) {
    *stored = is_new ? more : *stored + more;
}

/* Composites the brush's accumulated coverage of a vector under the colours of its level. */
CAMBER_FN void camber_tile_close_vector(camber_tile_state *c, int level, int i, int v, int is_new) {
    /* Only segments that are drawn over each other may be skipped. */
    const int skips = c->now.mode == CAMBER_BRUSH_OVER || c->now.mode == CAMBER_BRUSH_MASKED;
    camber_real area = 1.0f - (skips ? camber_let_through(c->brush[i][v]) : c->brush[i][v]);
    if (c->now.mode == CAMBER_BRUSH_UNION)
        area = camber_united(area, c->sums[i][0][v], c->sums[i][1][v], c->sums[i][2][v]) * c->now.a;
    const camber_real through = camber_tile_through(c, level, i, v, is_new);
    camber_real seen = through * area;
    if (c->now.mode == CAMBER_BRUSH_SUM) { /* the level goes on letting everything through */
        camber_tile_add(&c->level[level][i][0][v], area * c->now.r, is_new);
        c->level[level][i][1][v] = c->level[level][i][2][v] = CAMBER_REAL(0.0f);
        c->level[level][i][3][v] = through;
        return;
    }
#if CAMBER_HAS_MASKS
    seen *= c->layer_alpha;
    if (is_new || c->now.mode == CAMBER_BRUSH_MASKED)
        camber_tile_add(&c->mask[i][v], c->now.mode == CAMBER_BRUSH_MASKED ? seen : CAMBER_REAL(0.0f), is_new);
#endif
    camber_tile_add(&c->level[level][i][0][v], seen * c->now.r, is_new);
    camber_tile_add(&c->level[level][i][1][v], seen * c->now.g, is_new);
    camber_tile_add(&c->level[level][i][2][v], seen * c->now.b, is_new);
    c->level[level][i][3][v] = camber_let_through(through * (1.0f - area));
}

CAMBER_FN void camber_tile_close_cell(camber_tile_state *c, int level, int i, int is_new) {
    for (int v = 0; v < CAMBER_OWN_VECTORS; v++)
        camber_tile_close_vector(c, level, i, v, is_new);
}

CAMBER_FN void camber_tile_close_brush(camber_tile_state *c) {
    const int level = camber_tile_level(c);
    for (camber_u64 left = c->brushed; left; left &= left - 1) {
        const int i = CAMBER_LOWEST_CELL(left);
        if (c->touched[level] >> i & 1u)
            camber_tile_close_cell(c, level, i, 0);
        else
            camber_tile_close_cell(c, level, i, 1);
        camber_tile_look(c, level, i);
    }
    c->touched[level] |= c->brushed;
    c->brushed = c->filled = c->whole = 0;
}

/* Returns the area of a vector's pixels that a layer or group covers. */
CAMBER_FN camber_real camber_tile_covered(const camber_tile_state *c, int level, int i, int v) {
#if CAMBER_HAS_MASKS
    if (level == CAMBER_LAYER && c->now.mode == CAMBER_BRUSH_MASKED)
        return c->mask[i][v];
#endif
    return 1.0f - c->level[level][i][3][v];
}

/* Composites a layer or a group under the colours of the level below. */
CAMBER_FN void camber_tile_close_level(camber_tile_state *c, int level, float opacity) {
    const int below = level == CAMBER_LAYER && c->is_open[CAMBER_GROUP] ? CAMBER_GROUP : CAMBER_PICTURE;
    for (camber_u64 left = c->touched[level]; left; left &= left - 1) {
        const int i = CAMBER_LOWEST_CELL(left);
        camber_tile_take_level(c, below, i);
        for (int v = 0; v < CAMBER_OWN_VECTORS; v++) {
            const camber_real through = c->level[below][i][3][v], seen = through * opacity;
            for (int k = 0; k < 3; k++)
                c->level[below][i][k][v] += seen * c->level[level][i][k][v];
            c->level[below][i][3][v] =
                camber_let_through(through * (1.0f - camber_tile_covered(c, level, i, v) * opacity));
        }
        camber_tile_look(c, below, i);
    }
    c->touched[level] = 0;
    c->is_open[level] = 0;
}

/* Closes the brush, and the layer and group if the next brush does not belong to them. Opens those that it belongs to.
 */
CAMBER_FN void camber_tile_change_brush(camber_tile_state *c, camber_brush next) {
    camber_tile_close_brush(c);
    if (c->is_open[CAMBER_LAYER] && next.layer != c->now.layer)
        camber_tile_close_level(c, CAMBER_LAYER, c->now.layer_opacity);
    if (c->is_open[CAMBER_GROUP] && next.group != c->now.group)
        camber_tile_close_level(c, CAMBER_GROUP, c->now.group_opacity);
    c->is_open[CAMBER_GROUP] |= next.group != 0u;
    c->is_open[CAMBER_LAYER] |= next.layer != 0u;
    c->now = next;
}

/* Closes everything that is open, except a brush that draws directly into the picture, which camber_tile_pixels closes.
 */
CAMBER_FN void camber_tile_end(camber_tile_state *c) {
    if (camber_tile_level(c) == CAMBER_PICTURE)
        return;
    camber_tile_close_brush(c);
    if (c->is_open[CAMBER_LAYER])
        camber_tile_close_level(c, CAMBER_LAYER, c->now.layer_opacity);
    if (c->is_open[CAMBER_GROUP])
        camber_tile_close_level(c, CAMBER_GROUP, c->now.group_opacity);
}

/* ---- Colours that change from pixel to pixel ---- */

#if CAMBER_HAS_MASKS
/* Sets the brush's extension. Call it after setting the brush. */
CAMBER_FN void camber_tile_use_ext(camber_tile_state *c, camber_brush_ext brush_ext) {
    c->brush_ext = brush_ext;
    c->layer_alpha = 1.0f;
    if (c->now.mode == CAMBER_BRUSH_MASKED) {
        c->layer_alpha = c->now.a;
        c->now.a = 1.0f;
    }
}

/* Composites a vector of these colours directly under the colours of the level. The level must have been prepared. */
CAMBER_FN void camber_tile_put_colors(camber_tile_state *c, int i, int v, camber_real area, const camber_real *color) {
    const int level = camber_tile_level(c);
    const camber_real through = c->level[level][i][3][v], seen = through * area * c->now.a;
    c->level[level][i][0][v] += seen * c->layer_alpha * color[0] * c->now.r;
    c->level[level][i][1][v] += seen * c->layer_alpha * color[1] * c->now.g;
    c->level[level][i][2][v] += seen * c->layer_alpha * color[2] * c->now.b;
    if (c->now.mode == CAMBER_BRUSH_MASKED) {
        c->mask[i][v] += seen * c->layer_alpha * color[3];
        c->level[level][i][3][v] = camber_let_through(through * (1.0f - area));
    } else {
        c->level[level][i][3][v] = camber_let_through(through * (1.0f - area * c->now.a * color[3]));
    }
}

/* Counts a segment with these colours that was drawn into a cell; whole: the cell is inside the stroke. */
CAMBER_FN void camber_tile_count_colors(camber_tile_state *c, int i, int whole) {
    const int level = camber_tile_level(c);
    if (++c->blend_count[i] % CAMBER_FULL_CHECK_INTERVAL && !whole)
        return;
    if (camber_lets_nothing(c->level[level][i][3])) {
        if (level == CAMBER_PICTURE)
            c->done |= (camber_u64)1 << i;
        else
            c->filled |= (camber_u64)1 << i;
    }
}
#endif

/* ---- Pixels ---- */

/* Returns a channel from 0 to 255, rounded. */
CAMBER_FN camber_words camber_channel(camber_real value) {
    const camber_real scaled = value * 255.0f + 0.5f, least = scaled > 0.0f ? scaled : CAMBER_REAL(0.0f);
    return CAMBER_TO_WORDS(least < 255.0f ? least : CAMBER_REAL(255.0f));
}

/* Returns RGBA8 of premultiplied colours, red in the lowest byte. */
CAMBER_FN camber_words camber_rgba(camber_real r, camber_real g, camber_real b, camber_real a) {
    return camber_channel(r) | camber_channel(g) << 8 | camber_channel(b) << 16 | camber_channel(a) << 24;
}

/* Whether anything was drawn in a cell of the picture. */
CAMBER_FN int camber_tile_has_pixels(const camber_tile_state *c, int i) {
    return ((c->touched[CAMBER_PICTURE] | c->brushed) >> i & 1u) != 0u;
}

/* Returns the pixels of a vector, over the background: colours, or the bits of sums. Call it after camber_tile_end,
 * once for each vector. */
CAMBER_FN camber_words camber_tile_pixels(camber_tile_state *c, int i, int v, const float *back) {
    if (c->brushed >> i & 1u)
        camber_tile_close_vector(c, CAMBER_PICTURE, i, v, !(c->touched[CAMBER_PICTURE] >> i & 1u));
    if (c->now.mode == CAMBER_BRUSH_SUM)
        return CAMBER_AS_WORDS(c->level[CAMBER_PICTURE][i][0][v]);
    const camber_real through = c->level[CAMBER_PICTURE][i][3][v];
    return camber_rgba(c->level[CAMBER_PICTURE][i][0][v] + through * back[0],
                       c->level[CAMBER_PICTURE][i][1][v] + through * back[1],
                       c->level[CAMBER_PICTURE][i][2][v] + through * back[2], 1.0f - through + through * back[3]);
}

/* Returns the pixels of a cell that nothing was drawn in. */
CAMBER_FN camber_words camber_bare_pixels(const float *back) {
    const camber_real none = CAMBER_REAL(0.0f), through = CAMBER_REAL(1.0f);
    return camber_rgba(none + through * back[0], none + through * back[1], none + through * back[2],
                       1.0f - through + through * back[3]);
}

#endif
