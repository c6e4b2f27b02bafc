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
 * Lanes are rows of pixels here: the sums of sixteen rows go from left to right together. */
#ifndef CAMBER_KERNELS_AREA_H
#define CAMBER_KERNELS_AREA_H

#include "tile_state.h"

/* Nearer to nothing or to a whole pixel than this, an area is that: what sums of floats lose. */
#define CAMBER_AREA_LEAST 1e-5f

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

/* Makes the crossings of a row of tiles of the list of edges that cross its top. Of edges that cross it in one column,
 * only the sum is left: mostly nothing. Returns how many crossings there are, at most one an edge. */
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

/* A row of pixels is about to be changed: a row of cells without edges so far changes nothing. */
CAMBER_FN void camber_area_take_row(camber_tile_state *c, int row) {
    if (c->area_rows >> row & 1u)
        return;
    c->area_rows |= 1u << row;
    for (int x = 0; x < CAMBER_TILE_PX; x++)
        for (int y = CAMBER_CELL_PX * row; y < CAMBER_CELL_PX * (row + 1); y++)
            c->turns[x][y] = 0.0f;
}

/* Adds to a pixel and to all that are right of it. */
CAMBER_FN void camber_area_add(camber_tile_state *c, int x, int y, float area) {
    if (x < CAMBER_TILE_PX)
        c->turns[x][y] += area;
}

/* Adds a piece of an edge within a row of pixels, between from and to, px from the tile's left side. height: of the
 * piece, with the edge's sign. Right of the piece all pixels change by `height`. */
CAMBER_FN void camber_area_add_piece(camber_tile_state *c, int y, float from, float to, float height) {
    const float left = CAMBER_LESS(from, to), right = CAMBER_MORE(from, to);
    const int first = (int)left, last = (int)right;
    const float room = (float)(first + 1) - left, rest = right - (float)last;
    if (first == last) {
        const float area = height * (room - 0.5f * (right - left));
        camber_area_add(c, first, y, area);
        camber_area_add(c, first + 1, y, height - area);
        return;
    }
    const float a_px = height / (right - left);
    float area = 0.5f * room * room * a_px, before = 0.0f;
    for (int x = first; x < last; x++) {
        camber_area_add(c, x, y, area - before);
        before = area;
        area = a_px * (room + (float)(x - first) + 0.5f);
    }
    area = height - 0.5f * rest * rest * a_px;
    camber_area_add(c, last, y, area - before);
    camber_area_add(c, last + 1, y, height - area);
}

/* From y on, px from the tile's top, the left side of the tile is wound around so many times more. */
CAMBER_FN void camber_area_turn(camber_tile_state *c, float y, float times, int first, int end) {
    const int whole = (int)y;
    if (whole >= first && whole < end) {
        camber_area_take_row(c, whole / CAMBER_CELL_PX);
        camber_area_add(c, 0, whole, times * ((float)(whole + 1) - y));
    }
    for (int row = whole + 1 > first ? whole + 1 : first; row < end; row++) {
        camber_area_take_row(c, row / CAMBER_CELL_PX);
        camber_area_add(c, 0, row, times);
    }
}

/* Adds the part of an edge that lies in the tile, positions px from the tile's corner, row of pixels by row. */
CAMBER_FN void camber_area_add_rows(camber_tile_state *c, const camber_ring_edge *e, int first, int end) {
    const float slope = (e->x1 - e->x0) / (e->y1 - e->y0);
    const float least = CAMBER_LESS(e->x0, e->x1), most = CAMBER_MORE(e->x0, e->x1);
    const int from = (int)e->y0 > first ? (int)e->y0 : first;
    float top = (float)from > e->y0 ? (float)from : e->y0, x = e->x0 + (top - e->y0) * slope;
    x = x < least ? least : x > most ? most : x;
    for (int row = from; row < end && top < e->y1; row++) {
        const float bottom = (float)(row + 1) < e->y1 ? (float)(row + 1) : e->y1;
        float next = bottom < e->y1 ? e->x0 + (bottom - e->y0) * slope : e->x1;
        next = next < least ? least : next > most ? most : next;
        camber_area_take_row(c, row / CAMBER_CELL_PX);
        camber_area_add_piece(c, row, x, next, e->down * (bottom - top));
        top = bottom;
        x = next;
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
    const int first = CAMBER_CELL_PX * where.first, end = CAMBER_CELL_PX * (where.last + 1);
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
            camber_area_turn(c, y, to_left ? e.down : -e.down, first, end);
        e.x0 = from_left ? 0.0f : e.x0;
        e.y0 = from_left ? y : e.y0;
        e.x1 = to_left ? 0.0f : e.x1;
        e.y1 = to_left ? y : e.y1;
    }
    if (e.x0 > side && e.x1 > side)
        return;
    if (e.x0 > side || e.x1 > side) {
        const float y = camber_edge_height(&e, side);
        const int from_right = e.x0 > side;
        e.y0 = from_right ? y : e.y0;
        e.x0 = from_right ? side : e.x0;
        e.y1 = from_right ? e.y1 : y;
        e.x1 = from_right ? e.x1 : side;
    }
    if (e.y0 < e.y1)
        camber_area_add_rows(c, &e, first, end);
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

/* Puts four columns of a vector of rows, from row y on, into the cells that they belong to, of which i is the first. */
CAMBER_FN void camber_area_put_cells(camber_tile_state *c, const camber_real *columns, int i, int y) {
#if CAMBER_LANES == 1
    for (int x = 0; x < CAMBER_CELL_PX; x++)
        c->sums[i][0][CAMBER_CELL_PX * (y % CAMBER_CELL_PX) + x] = columns[x];
#else
#define CAMBER_ROW(n) columns[0].n, columns[1].n, columns[2].n, columns[3].n
#if CAMBER_LANES == 16
    c->sums[i][0][0] = (float16)(CAMBER_ROW(s0), CAMBER_ROW(s1), CAMBER_ROW(s2), CAMBER_ROW(s3));
    c->sums[i + 8][0][0] = (float16)(CAMBER_ROW(s4), CAMBER_ROW(s5), CAMBER_ROW(s6), CAMBER_ROW(s7));
    c->sums[i + 16][0][0] = (float16)(CAMBER_ROW(s8), CAMBER_ROW(s9), CAMBER_ROW(sa), CAMBER_ROW(sb));
    c->sums[i + 24][0][0] = (float16)(CAMBER_ROW(sc), CAMBER_ROW(sd), CAMBER_ROW(se), CAMBER_ROW(sf));
#else
    c->sums[i][0][0] = (float8)(CAMBER_ROW(s0), CAMBER_ROW(s1));
    c->sums[i][0][1] = (float8)(CAMBER_ROW(s2), CAMBER_ROW(s3));
    c->sums[i + 8][0][0] = (float8)(CAMBER_ROW(s4), CAMBER_ROW(s5));
    c->sums[i + 8][0][1] = (float8)(CAMBER_ROW(s6), CAMBER_ROW(s7));
#endif
#undef CAMBER_ROW
#endif
}

/* Adds the turns of a vector of rows up, from row y on: the sums of their cells become what is inside of the pixels. */
CAMBER_FN void camber_area_find_rows(camber_tile_state *c, int y) {
    camber_real sum = CAMBER_REAL((float)c->winding), columns[CAMBER_CELL_PX];
    for (int x = 0; x < CAMBER_TILE_PX; x++) {
        sum += CAMBER_LOAD(0, c->turns[x] + y);
        columns[x % CAMBER_CELL_PX] = camber_area_inside(sum, c->now.mode);
        if (x % CAMBER_CELL_PX == CAMBER_CELL_PX - 1)
            camber_area_put_cells(c, columns, y / CAMBER_CELL_PX * CAMBER_TILE_CELLS + x / CAMBER_CELL_PX, y);
    }
}

/* Finds the inside of all rows of cells that have edges. Rows that share a vector are taken together. */
CAMBER_FN void camber_area_find_all(camber_tile_state *c) {
    const int a_vector = CAMBER_LANES > CAMBER_CELL_PX ? CAMBER_LANES / CAMBER_CELL_PX : 1;
    for (int row = 0; row < CAMBER_TILE_CELLS; row += a_vector) {
        if (!(c->area_rows >> row & ((1u << a_vector) - 1u)))
            continue;
        for (int k = row; k < row + a_vector; k++)
            camber_area_take_row(c, k);
        for (int y = CAMBER_CELL_PX * row; y < CAMBER_CELL_PX * (row + a_vector); y += CAMBER_LANES)
            camber_area_find_rows(c, y);
    }
}

/* Finds the cells that have something inside of the brush's rings, and ends the rings. The sums of those that it
 * returns are the areas of their pixels then; those of *whole lie inside as a whole. */
CAMBER_FN camber_u64 camber_area_find(camber_tile_state *c, camber_tile_rows where, camber_u64 *whole) {
    const int is_inside = camber_most_of(camber_area_inside(CAMBER_REAL((float)c->winding), c->now.mode)) > 0.0f;
    const camber_u32 with_edges = c->area_rows;
    camber_u64 found = 0;
    *whole = 0;
    camber_area_find_all(c);
    for (int row = where.first; row <= where.last; row++) {
        const int has_edges = (int)(with_edges >> row & 1u);
        const camber_u64 cells = (camber_u64)255 << (CAMBER_TILE_CELLS * row) & ~(c->done | c->filled);
        if (!has_edges && is_inside)
            *whole |= cells;
        for (camber_u64 left = has_edges ? cells : 0; left; left &= left - 1) {
            const int i = camber_lowest(left);
            camber_real most = c->sums[i][0][0];
            for (int v = 1; v < CAMBER_VECTORS; v++)
                most = CAMBER_MORE(c->sums[i][0][v], most);
            found |= camber_most_of(most) > 0.0f ? (camber_u64)1 << i : 0;
        }
    }
    c->area_rows = 0;
    c->winding = 0;
    return found;
}

/* Draws what the brush's rings have inside, before the brush is closed. */
CAMBER_FN void camber_area_draw(camber_tile_state *c, camber_tile_rows where) {
    camber_u64 whole;
    const camber_u64 cells = camber_area_find(c, where, &whole);
    camber_tile_take_cells(c, cells | whole);
    for (camber_u64 left = cells; left; left &= left - 1) {
        const int i = camber_lowest(left);
        for (int v = 0; v < CAMBER_VECTORS; v++)
            camber_tile_put_over(c, i, v, c->sums[i][0][v]);
    }
    for (; whole; whole &= whole - 1)
        camber_tile_put_whole(c, camber_lowest(whole));
}

#endif
