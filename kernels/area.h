/* Areas: how the edges of rings cover the pixels of a tile.
 *
 * Input: a brush's edges in a tile, and how often its rings wind around the tile's top left corner. Output: the area of
 * each pixel that lies inside the rings. Main idea: an edge changes the winding of all that lies to its right in the
 * rows that it passes. So each edge adds to a pixel only what it changes there, exactly, as an area. A sum from the
 * left to the right then gives how much each pixel is wound around. Edges that run to and fro add up to nothing: areas
 * that meet have no seam.
 *
 *      corner                      e1 crosses the top left of the corner: wind counts it for the whole tile.
 *     e1 \ +-----------+           e2 enters through the left side: below that, the winding changes in whole rows.
 *         \|           |           e3 only changes what is right of it.
 *          \  e3 /     |
 *          |\   /      |           Whether an edge passes left of a corner is decided once, by camber_edge_crossing,
 *     e2 ---|\-/       |           so that what wind counts and what a tile counts always fit together.
 *          +-----------+
 *
 * Lanes are the pixels of a cell. An edge goes through few cells: in each it changes all pixels together. */
#ifndef CAMBER_KERNELS_AREA_H
#define CAMBER_KERNELS_AREA_H

#include "tile_state.h"

/* Nearer to nothing or to a whole pixel than this, an area is that: what sums of floats lose. */
#define CAMBER_AREA_LEAST 1e-5f
/* Edges that are less high cover nothing. Those that go less to the side, px a px down, are upright. */
#define CAMBER_AREA_FLAT_PX 1e-12f
#define CAMBER_AREA_UPRIGHT 1e-12f

/* An edge from its upper end to its lower one. */
typedef struct camber_ring_edge {
    float x0, y0, x1, y1;
    float down; /* 1 where the ring goes down along it, else -1 */
} camber_ring_edge;

CAMBER_FN camber_ring_edge camber_ring_edge_of(CAMBER_GLOBAL const float *segment) {
    const float ax = segment[CAMBER_SEGMENT_AX], ay = segment[CAMBER_SEGMENT_AY], bx = segment[CAMBER_SEGMENT_BX],
                by = segment[CAMBER_SEGMENT_BY];
    const int down = by > ay || (by == ay && bx > ax);
    camber_ring_edge e;
    e.x0 = down ? ax : bx;
    e.y0 = down ? ay : by;
    e.x1 = down ? bx : ax;
    e.y1 = down ? by : ay;
    e.down = down ? 1.0f : -1.0f;
    return e;
}

/* Whether an edge crosses the line at height y. One that ends on it does, and one that begins on it does not. */
CAMBER_FN int camber_edge_crosses(const camber_ring_edge *e, float y) {
    return e->y0 < y && e->y1 >= y;
}

/* Where it does. */
CAMBER_FN float camber_edge_crossing(const camber_ring_edge *e, float y) {
    const float x = e->x0 + (y - e->y0) * ((e->x1 - e->x0) / (e->y1 - e->y0));
    const float least = CAMBER_LESS(e->x0, e->x1), most = CAMBER_MORE(e->x0, e->x1);
    return x < least ? least : x > most ? most : x;
}

/* ---- wind: what lies left of a row's tiles ---- */

/* A crossing of the top of a row of tiles: words. From its column on, the rings of its brush wind so many times more
 * around the corners of tiles. Those of a row are in drawing order. */
#define CAMBER_CROSSING_BRUSH 0u
#define CAMBER_CROSSING_PLACE 1u /* column | times << 16 */
#define CAMBER_CROSSING_WORDS 2u
#define CAMBER_CROSSING_MOST 32767

CAMBER_FN camber_u32 camber_crossing_column(camber_u32 place) {
    return place & 0xffffu;
}

CAMBER_FN int camber_crossing_times(camber_u32 place) {
    return (int)(place >> 16 ^ 0x8000u) - 0x8000;
}

/* The first column of tiles whose corners lie right of x. */
CAMBER_FN int camber_column_after(float x, float left, int columns) {
    const float at = (x - left) * (1.0f / CAMBER_TILE_PX);
    return at < 0.0f ? 0 : at >= (float)columns ? columns : (int)at + 1;
}

/* Writes the crossings of one brush, and forgets its turns. Returns how many there are now. */
CAMBER_FN camber_u32 camber_put_crossings(int *turns, int first, int last, camber_u32 brush,
                                          CAMBER_GLOBAL camber_u32 *crossings, camber_u32 count) {
    for (int column = first; column <= last; column++) {
        int left = turns[column];
        turns[column] = 0;
        while (left != 0) {
            const int times = left > CAMBER_CROSSING_MOST    ? CAMBER_CROSSING_MOST
                              : left < -CAMBER_CROSSING_MOST ? -CAMBER_CROSSING_MOST
                                                             : left;
            crossings[CAMBER_CROSSING_WORDS * count + CAMBER_CROSSING_BRUSH] = brush;
            crossings[CAMBER_CROSSING_WORDS * count + CAMBER_CROSSING_PLACE] =
                (camber_u32)column | (camber_u32)(times & 0xffff) << 16;
            count++;
            left -= times;
        }
    }
    return count;
}

/* Makes the crossings of a row of tiles of the list of segments that may be edges and cross its top. Of edges that
 * cross it in one column, only the sum is left: mostly nothing. Returns how many crossings there are, at most one a
 * segment. */
CAMBER_FN camber_u32 camber_wind_row(CAMBER_GLOBAL const float *segments, CAMBER_GLOBAL const camber_u32 *list,
                                     camber_u32 edge_count, camber_tile_grid of, float top,
                                     CAMBER_GLOBAL camber_u32 *crossings) {
    int turns[CAMBER_TILES_MAX], first = CAMBER_TILES_MAX, last = -1;
    camber_u32 count = 0, brush = 0;
    const int columns = (int)of.columns;
    for (int i = 0; i < columns; i++)
        turns[i] = 0;
    for (camber_u32 k = 0; k < edge_count; k++) {
        CAMBER_GLOBAL const float *segment = segments + (size_t)CAMBER_SEGMENT_WORDS * list[k];
        const camber_u32 own = CAMBER_BITS(segment[CAMBER_SEGMENT_BRUSH]);
        if (own != brush) {
            count = camber_put_crossings(turns, first, last, brush, crossings, count);
            first = CAMBER_TILES_MAX;
            last = -1;
            brush = own;
        }
        const camber_ring_edge e = camber_ring_edge_of(segment);
        if (segment[CAMBER_SEGMENT_HALF_WIDTH] != CAMBER_EDGE_PX || !camber_edge_crosses(&e, top))
            continue;
        const int column = camber_column_after(camber_edge_crossing(&e, top), of.left, columns);
        if (column >= columns)
            continue;
        turns[column] += (int)e.down;
        first = column < first ? column : first;
        last = column > last ? column : last;
    }
    return camber_put_crossings(turns, first, last, brush, crossings, count);
}

/* The crossings of a tile's row that no brush has taken yet: those of the brushes to come, the nearest last. */
typedef struct camber_crossings_left {
    CAMBER_GLOBAL const camber_u32 *words;
    camber_u32 first, end, column; /* column: of the tile */
} camber_crossings_left;

/* The brush of the next crossing; 0, which has no area: there is none. */
CAMBER_FN camber_u32 camber_next_area(const camber_crossings_left *left) {
    return left->end > left->first
               ? left->words[CAMBER_CROSSING_WORDS * (size_t)(left->end - 1u) + CAMBER_CROSSING_BRUSH]
               : 0u;
}

/* Takes the crossings of a brush. Returns how often its rings wind around the tile's corner. */
CAMBER_FN int camber_take_winding(camber_crossings_left *left, camber_u32 brush) {
    int winding = 0;
    for (; camber_next_area(left) == brush && brush != 0u; left->end--) {
        const camber_u32 place = left->words[CAMBER_CROSSING_WORDS * (size_t)(left->end - 1u) + CAMBER_CROSSING_PLACE];
        winding += camber_crossing_column(place) <= left->column ? camber_crossing_times(place) : 0;
    }
    return winding;
}

/* ---- Edges in a tile ---- */

CAMBER_FN int camber_brush_is_area(const camber_brush *brush) {
    return brush->mode >= CAMBER_BRUSH_AREA;
}

/* A brush of areas has two sums a pixel: what the edges in its cell change there, and what all in its row change from
 * its cell on. */
#define CAMBER_AREA_HERE 0
#define CAMBER_AREA_ON 1

/* A row of cells is about to be changed: without edges so far, it changes nothing. */
CAMBER_FN void camber_area_take_row(camber_tile_state *c, int row) {
    if (c->area_rows >> row & 1u)
        return;
    c->area_rows |= 1u << row;
    for (int i = CAMBER_TILE_CELLS * row; i < CAMBER_TILE_CELLS * (row + 1); i++)
        for (int v = 0; v < CAMBER_VECTORS; v++)
            c->sums[i][CAMBER_AREA_HERE][v] = c->sums[i][CAMBER_AREA_ON][v] = CAMBER_REAL(0.0f);
}

/* The tops of the pixels of a vector of a cell, px from the tile's top. */
CAMBER_FN camber_real camber_area_tops(int row, int v) {
    return (float)(CAMBER_CELL_PX * row) + camber_rows_of_cell(v);
}

CAMBER_FN camber_real camber_between(camber_real x, float least, float most) {
    const camber_real above = x > least ? x : CAMBER_REAL(least);
    return above < most ? above : CAMBER_REAL(most);
}

/* From y on, px from the tile's top, the left side of the tile is wound around so many times more. */
CAMBER_FN void camber_area_turn(camber_tile_state *c, float y, float times, camber_tile_rows where) {
    const int begin = (int)y / CAMBER_CELL_PX;
    for (int row = begin > where.first ? begin : where.first; row <= where.last; row++) {
        camber_area_take_row(c, row);
        for (int v = 0; v < CAMBER_VECTORS; v++)
            c->sums[CAMBER_TILE_CELLS * row][CAMBER_AREA_ON][v] +=
                times * camber_between(camber_area_tops(row, v) + (1.0f - y), 0.0f, 1.0f);
    }
}

/* The piece of an edge in each row of pixels of a vector, px from the tile's corner. height: with the edge's sign. */
typedef struct camber_edge_pieces {
    camber_real left, right, wide, height;
    float rise; /* half of how high the edge is a px to the side, with its sign; 0 where it is upright */
} camber_edge_pieces;

/* slope: px to the side a px down. */
CAMBER_FN void camber_edge_pieces_of(const camber_ring_edge *e, float slope, camber_real tops, camber_edge_pieces *p) {
    const camber_real from = camber_between(tops, e->y0, e->y1), to = camber_between(tops + 1.0f, e->y0, e->y1);
    const float to_side = CAMBER_FABS(slope);
    p->wide = (to - from) * to_side;
    p->left = e->x0 + (0.5f * (from + to) - e->y0) * slope - 0.5f * p->wide;
    p->right = p->left + p->wide;
    p->height = (to - from) * e->down;
}

/* How much the pieces change their pixels, whose left sides are at x: the area that is right of them. */
CAMBER_FN camber_real camber_edge_pieces_area(const camber_edge_pieces *p, camber_real x) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f);
    camber_real from = x - p->left, to = from + 1.0f, past = x + 1.0f - p->right;
    from = from > 0.0f ? from : none;
    from = from < p->wide ? from : p->wide;
    to = to > 0.0f ? to : none;
    to = to < p->wide ? to : p->wide;
    past = past > 0.0f ? past : none;
    past = past < 1.0f ? past : one;
    return p->rise * (to - from) * (to + from) + p->height * past;
}

/* Where an edge is at y, px from the tile's left side, as a column of cells. */
CAMBER_FN int camber_edge_column(const camber_ring_edge *e, float slope, float y) {
    const float at = y < e->y0 ? e->y0 : y > e->y1 ? e->y1 : y, x = e->x0 + (at - e->y0) * slope;
    return x < 0.0f ? 0 : x >= (float)CAMBER_TILE_PX ? CAMBER_TILE_CELLS : (int)(x * (1.0f / CAMBER_CELL_PX));
}

/* Adds the part of an edge that lies in the tile, positions px from the tile's corner, row of cells by row. */
CAMBER_FN void camber_area_add_rows(camber_tile_state *c, const camber_ring_edge *e, camber_tile_rows where) {
    const float slope = (e->x1 - e->x0) / (e->y1 - e->y0), to_side = CAMBER_FABS(slope);
    const int begin = (int)e->y0 / CAMBER_CELL_PX, end = (int)e->y1 / CAMBER_CELL_PX;
    const int last = end < where.last ? end : where.last;
    camber_edge_pieces p;
    p.rise = to_side > CAMBER_AREA_UPRIGHT ? 0.5f * e->down / to_side : 0.0f;
    for (int row = begin > where.first ? begin : where.first; row <= last; row++) {
        const float top = (float)(CAMBER_CELL_PX * row);
        const int upper = camber_edge_column(e, slope, top), lower = camber_edge_column(e, slope, top + CAMBER_CELL_PX);
        const int from = upper < lower ? upper : lower, to = upper < lower ? lower : upper;
        const int end_column = to < CAMBER_TILE_CELLS ? to + 1 : CAMBER_TILE_CELLS, i = CAMBER_TILE_CELLS * row;
        camber_area_take_row(c, row);
        for (int v = 0; v < CAMBER_VECTORS; v++) {
            camber_edge_pieces_of(e, slope, camber_area_tops(row, v), &p);
            for (int x = from; x < end_column; x++)
                c->sums[i + x][CAMBER_AREA_HERE][v] +=
                    camber_edge_pieces_area(&p, (float)(CAMBER_CELL_PX * x) + camber_columns_of_cell(v));
            if (end_column < CAMBER_TILE_CELLS)
                c->sums[i + end_column][CAMBER_AREA_ON][v] += p.height;
        }
    }
}

/* Where between its ends an edge is at x. */
CAMBER_FN float camber_edge_height(const camber_ring_edge *e, float x) {
    const float y = e->y0 + (x - e->x0) * ((e->y1 - e->y0) / (e->x1 - e->x0));
    return y < e->y0 ? e->y0 : y > e->y1 ? e->y1 : y;
}

/* Adds an edge to the rows of cells of a tile that are drawn. */
CAMBER_FN void camber_area_add_edge(camber_tile_state *c, CAMBER_GLOBAL const float *segment, camber_tile_rows where) {
    const float side = (float)CAMBER_TILE_PX;
    camber_ring_edge e = camber_ring_edge_of(segment);
    if (e.y1 < where.top || e.y0 >= where.top + side)
        return;
    if (camber_edge_crosses(&e, where.top)) {
        e.x0 = camber_edge_crossing(&e, where.top);
        e.y0 = where.top;
    }
    const int from_left = e.x0 < where.left, to_left = e.x1 < where.left;
    e.x0 -= where.left;
    e.x1 -= where.left;
    e.y0 -= where.top;
    e.y1 -= where.top;
    if (from_left && to_left)
        return;
    if (from_left || to_left) {
        const float y = camber_edge_height(&e, 0.0f);
        if (y < side)
            camber_area_turn(c, y, to_left ? e.down : -e.down, where);
        e.x0 = from_left ? 0.0f : e.x0;
        e.y0 = from_left ? y : e.y0;
        e.x1 = to_left ? 0.0f : e.x1;
        e.y1 = to_left ? y : e.y1;
    }
    if (e.y1 - e.y0 > CAMBER_AREA_FLAT_PX && (e.x0 < side || e.x1 < side))
        camber_area_add_rows(c, &e, where);
}

/* ---- The inside ---- */

/* How much of a pixel is inside, by the sum of its windings. */
CAMBER_FN camber_real camber_area_inside(camber_real sum, camber_u32 mode) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f);
    camber_real inside = CAMBER_FABS(sum);
    if (mode == CAMBER_BRUSH_AREA_EVENODD) {
        inside -= 2.0f * CAMBER_TRUNCATE(0.5f * inside);
        inside = inside > 1.0f ? 2.0f - inside : inside;
    }
    inside = inside > 1.0f - CAMBER_AREA_LEAST ? one : inside;
    return inside < CAMBER_AREA_LEAST ? none : inside;
}

/* Adds up what the edges of a row of cells change, from left to right: the sums become what is inside of the pixels.
 * Returns the cells that have any of it, a bit each. */
CAMBER_FN camber_u32 camber_area_find_row(camber_tile_state *c, int row) {
    camber_u32 found = 0;
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        camber_real sum = CAMBER_REAL((float)c->winding);
        for (int x = 0; x < CAMBER_TILE_CELLS; x++) {
            const int i = CAMBER_TILE_CELLS * row + x;
            sum += c->sums[i][CAMBER_AREA_ON][v];
            const camber_real inside = camber_area_inside(sum + c->sums[i][CAMBER_AREA_HERE][v], c->now.mode);
            c->sums[i][CAMBER_AREA_HERE][v] = inside;
            found |= CAMBER_ANY(inside > 0.0f) ? 1u << x : 0u;
        }
    }
    return found;
}

/* Finds the cells that have something inside of the brush's rings, and ends the rings. The sums of those that it
 * returns are the areas of their pixels then; those of *whole lie inside as a whole. */
CAMBER_FN camber_u64 camber_area_find(camber_tile_state *c, camber_tile_rows where, camber_u64 *whole) {
    const int is_inside = camber_most_of(camber_area_inside(CAMBER_REAL((float)c->winding), c->now.mode)) > 0.0f;
    camber_u64 found = 0;
    *whole = 0;
    for (int row = where.first; row <= where.last; row++) {
        if (c->area_rows >> row & 1u)
            found |= (camber_u64)camber_area_find_row(c, row) << (CAMBER_TILE_CELLS * row);
        else if (is_inside)
            *whole |= (camber_u64)255 << (CAMBER_TILE_CELLS * row);
    }
    *whole &= ~(c->done | c->filled);
    c->area_rows = 0;
    c->winding = 0;
    return found & ~(c->done | c->filled);
}

/* Draws what the brush's rings have inside, before the brush is closed. */
CAMBER_FN void camber_area_draw(camber_tile_state *c, camber_tile_rows where) {
    camber_u64 whole;
    const camber_u64 cells = camber_area_find(c, where, &whole);
    camber_tile_take_cells(c, cells | whole);
    for (camber_u64 left = cells; left; left &= left - 1) {
        const int i = camber_lowest(left);
        for (int v = 0; v < CAMBER_VECTORS; v++)
            camber_tile_put_over(c, i, v, c->sums[i][CAMBER_AREA_HERE][v]);
    }
    for (; whole; whole &= whole - 1)
        camber_tile_put_whole(c, camber_lowest(whole));
}

#endif
