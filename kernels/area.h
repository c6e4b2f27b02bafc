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
 *          |\   /      |           Whether an edge passes left of a corner is decided once, by camber_edges_crossing,
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

/* Edges, one a lane, from their upper ends to their lower ones. */
typedef struct camber_ring_edges {
    camber_real x0, y0, x1, y1;
    camber_real down; /* 1 where the ring goes down along the edge, else -1 */
} camber_ring_edges;

CAMBER_FN void camber_ring_edges_of(camber_real ax, camber_real ay, camber_real bx, camber_real by,
                                    camber_ring_edges *e) {
    const camber_mask down = (by > ay) | ((by == ay) & (bx > ax));
    e->x0 = down ? ax : bx;
    e->y0 = down ? ay : by;
    e->x1 = down ? bx : ax;
    e->y1 = down ? by : ay;
    e->down = down ? CAMBER_REAL(1.0f) : CAMBER_REAL(-1.0f);
}

/* Whether edges cross the line at height y. One that ends on it does, and one that begins on it does not. */
CAMBER_FN camber_mask camber_edges_cross(const camber_ring_edges *e, float y) {
    return (e->y0 < y) & (e->y1 >= y);
}

/* Where they do. */
CAMBER_FN camber_real camber_edges_crossing(const camber_ring_edges *e, float y) {
    const camber_real x = e->x0 + (y - e->y0) * ((e->x1 - e->x0) / (e->y1 - e->y0));
    const camber_real least = CAMBER_LESS(e->x0, e->x1), most = CAMBER_MORE(e->x0, e->x1);
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
    return at >= 0.0f ? (at < (float)columns ? (int)at + 1 : columns) : 0; /* also of NaN */
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
        camber_ring_edges e; /* all lanes are this one */
        camber_ring_edges_of(CAMBER_REAL(segment[CAMBER_SEGMENT_AX]), CAMBER_REAL(segment[CAMBER_SEGMENT_AY]),
                             CAMBER_REAL(segment[CAMBER_SEGMENT_BX]), CAMBER_REAL(segment[CAMBER_SEGMENT_BY]), &e);
        if (segment[CAMBER_SEGMENT_HALF_WIDTH] != CAMBER_EDGE_PX || !CAMBER_ANY(camber_edges_cross(&e, top)))
            continue;
        const camber_real x = camber_edges_crossing(&e, top);
        const int column = camber_column_after(camber_lane_of(&x, 0), of.left, columns);
        if (column >= columns)
            continue;
        turns[column] += (int)camber_lane_of(&e.down, 0);
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

/* A row of cells is about to be changed: without edges so far, it changes nothing. */
CAMBER_FN void camber_area_take_row(camber_tile_state *c, int row) {
    const camber_u64 cells = (camber_u64)255 << (CAMBER_TILE_CELLS * row);
    if (c->edged & cells)
        return;
    c->edged |= cells;
    for (int i = CAMBER_TILE_CELLS * row; i < CAMBER_TILE_CELLS * (row + 1); i++)
        for (int k = 0; k < 3; k++)
            for (int v = 0; v < CAMBER_VECTORS; v++)
                c->sums[i][k][v] = CAMBER_REAL(0.0f);
}

/* Finds the numbers that edges change along the upper and the lower side of a cell, CAMBER_CORNERS_*. */
CAMBER_FN float *camber_area_corners(camber_tile_state *c, int row, int column) {
    return (float *)c->sums[CAMBER_TILE_CELLS * row + column][CAMBER_AREA_CORNERS];
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
        float *corners = camber_area_corners(c, row, 0);
        corners[CAMBER_CORNERS_LEFT] += row > begin ? times : 0.0f;
        corners[CAMBER_CORNERS_LEFT + 1] += times;
    }
}

/* How edges lie in a tile, one a lane, positions px from its corner. */
typedef struct camber_tile_edges {
    camber_ring_edges in;      /* from where they enter it at the top or through its left side */
    camber_real slope;         /* px to the side a px down */
    camber_real rise;          /* half of how high an edge is a px to the side, with its sign; 0 where it is upright */
    camber_real turn, turn_at; /* the left side is wound around so many times more from there on */
    camber_mask first, last;   /* rows of cells; the last lies before the first where an edge covers nothing */
    camber_mask left, right;   /* columns of cells; CAMBER_TILE_CELLS: right of the tile */
    camber_mask above, below;  /* the first and the last row of cells whose tops they cross; CAMBER_TILE_CELLS: the end
                                  of the tile */
} camber_tile_edges;

/* A position as a row or column of cells, of which there are `most`. */
CAMBER_FN camber_mask camber_cell_at(camber_real at, camber_mask counts, float most) {
    const camber_real none = CAMBER_REAL(0.0f), cell = (1.0f / CAMBER_CELL_PX) * at;
    return CAMBER_TO_INTEGERS((counts & (cell > none)) ? (cell < most ? cell : CAMBER_REAL(most)) : none);
}

/* Cuts the edges that enter the tile through its left side on their way down, and those that leave it there. */
CAMBER_FN void camber_cut_at_left(camber_tile_edges *t, camber_mask enters, camber_mask leaves) {
    camber_ring_edges *e = &t->in;
    const camber_real none = CAMBER_REAL(0.0f), side = CAMBER_REAL((float)CAMBER_TILE_PX);
    const camber_real at = e->y0 - e->x0 * ((e->y1 - e->y0) / (e->x1 - e->x0));
    const camber_real y = at < e->y0 ? e->y0 : at > e->y1 ? e->y1 : at;
    t->turn = enters ? -e->down : leaves ? e->down : none;
    t->turn_at = (enters | leaves) ? y : none;
    t->turn = t->turn_at < side ? t->turn : none;
    e->x0 = enters ? none : e->x0;
    e->y0 = enters ? y : e->y0;
    e->x1 = leaves ? none : e->x1;
    e->y1 = leaves ? y : e->y1;
}

/* Finds how the wanted ones of edges lie in a tile, or in those rows of its cells that are drawn. */
CAMBER_FN void camber_tile_edges_of(const camber_ring_edges *ring, camber_mask wanted, camber_tile_rows where,
                                    camber_tile_edges *t) {
    const float side = (float)CAMBER_TILE_PX, cells = (float)CAMBER_TILE_CELLS;
    camber_ring_edges *e = &t->in;
    const camber_mask crosses = camber_edges_cross(ring, where.top);
    *e = *ring;
    e->x0 = (crosses ? camber_edges_crossing(ring, where.top) : e->x0) - where.left;
    e->x1 = e->x1 - where.left;
    e->y0 = (crosses ? CAMBER_REAL(where.top) : e->y0) - where.top;
    e->y1 = e->y1 - where.top;
    const camber_mask enters_top = crosses & (e->x0 >= 0.0f);
    const camber_mask meets = wanted & (e->y1 >= 0.0f) & (e->y0 < side) & ((e->x0 >= 0.0f) | (e->x1 >= 0.0f));
    camber_cut_at_left(t, meets & (e->x0 < 0.0f), meets & (e->x1 < 0.0f));
    const camber_mask covers = meets & (e->y1 - e->y0 > CAMBER_AREA_FLAT_PX) & ((e->x0 < side) | (e->x1 < side));
    const camber_real high = covers ? e->y1 - e->y0 : CAMBER_REAL(1.0f);
    t->slope = (e->x1 - e->x0) / high;
    const camber_real to_side = CAMBER_FABS(t->slope);
    t->rise = to_side > CAMBER_AREA_UPRIGHT ? 0.5f * e->down / to_side : CAMBER_REAL(0.0f);
    const camber_mask top = camber_cell_at(e->y0, covers, cells), bottom = camber_cell_at(e->y1, covers, cells);
    t->first = top > where.first ? top : where.first;
    t->last = covers ? (bottom < where.last ? bottom : where.last) : where.first - 1;
    const camber_mask above = enters_top ? (camber_mask)(0) : top + 1, end = (camber_mask)(where.last + 1);
    t->above = above > where.first ? above : where.first;
    t->below = covers ? (bottom < end ? bottom : end) : where.first - 1;
    t->left = camber_cell_at(CAMBER_LESS(e->x0, e->x1), covers, cells);
    t->right = camber_cell_at(CAMBER_MORE(e->x0, e->x1), covers, cells);
}

/* One of them. */
typedef struct camber_tile_edge {
    float x0, y0, y1, down, slope, rise;
} camber_tile_edge;

/* Edge k of a vector. */
CAMBER_FN void camber_tile_edge_of(const camber_tile_edges *t, int k, camber_tile_edge *e) {
    e->x0 = camber_lane_of(&t->in.x0, k);
    e->y0 = camber_lane_of(&t->in.y0, k);
    e->y1 = camber_lane_of(&t->in.y1, k);
    e->down = camber_lane_of(&t->in.down, k);
    e->slope = camber_lane_of(&t->slope, k);
    e->rise = camber_lane_of(&t->rise, k);
}

/* Where an edge is at y, as a column of cells. */
CAMBER_FN int camber_edge_column(const camber_tile_edge *e, float y) {
    const float at = y < e->y0 ? e->y0 : y > e->y1 ? e->y1 : y, x = e->x0 + (at - e->y0) * e->slope;
    return x > 0.0f ? (x < (float)CAMBER_TILE_PX ? (int)(x * (1.0f / CAMBER_CELL_PX)) : CAMBER_TILE_CELLS) : 0;
}

/* The piece of an edge in each row of pixels of a vector. height: with the edge's sign. */
typedef struct camber_edge_pieces {
    camber_real left, right, wide, height;
} camber_edge_pieces;

CAMBER_FN void camber_edge_pieces_of(const camber_tile_edge *e, camber_real tops, camber_edge_pieces *p) {
    const camber_real from = camber_between(tops, e->y0, e->y1), to = camber_between(tops + 1.0f, e->y0, e->y1);
    p->wide = (to - from) * CAMBER_FABS(e->slope);
    p->left = e->x0 + (0.5f * (from + to) - e->y0) * e->slope - 0.5f * p->wide;
    p->right = p->left + p->wide;
    p->height = (to - from) * e->down;
}

/* How much the pieces change their pixels, whose left sides are at x: the area that is right of them. */
CAMBER_FN camber_real camber_edge_pieces_area(const camber_tile_edge *e, const camber_edge_pieces *p, camber_real x) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f);
    camber_real from = x - p->left, to = from + 1.0f, past = x + 1.0f - p->right;
    from = CAMBER_MORE(from, none);
    from = CAMBER_LESS(from, p->wide);
    to = CAMBER_MORE(to, none);
    to = CAMBER_LESS(to, p->wide);
    past = CAMBER_MORE(past, none);
    past = CAMBER_LESS(past, one);
    return e->rise * (to - from) * (to + from) + p->height * past;
}

/* Adds an edge to the columns [from, to] of a row of cells, and to all that is right of them. */
CAMBER_FN void camber_area_add_row(camber_tile_state *c, const camber_tile_edge *e, int row, int from, int to) {
    const int end = to < CAMBER_TILE_CELLS ? to + 1 : CAMBER_TILE_CELLS, i = CAMBER_TILE_CELLS * row;
    camber_area_take_row(c, row);
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        camber_edge_pieces p;
        camber_edge_pieces_of(e, camber_area_tops(row, v), &p);
        for (int x = from; x < end; x++)
            c->sums[i + x][CAMBER_AREA_HERE][v] +=
                camber_edge_pieces_area(e, &p, (float)(CAMBER_CELL_PX * x) + camber_columns_of_cell(v));
        if (end < CAMBER_TILE_CELLS)
            c->sums[i + end][CAMBER_AREA_ON][v] += p.height;
    }
}

/* Adds edge k of a vector to the tops of rows of cells that it crosses. */
CAMBER_FN void camber_area_cross_rows(camber_tile_state *c, const camber_tile_edges *t, int k, camber_tile_rows where) {
    const int below = camber_integer_of(&t->below, k);
    camber_tile_edge e;
    camber_tile_edge_of(t, k, &e);
    for (int row = camber_integer_of(&t->above, k); row <= below; row++) {
        const int column = camber_edge_column(&e, (float)(CAMBER_CELL_PX * row));
        if (column == CAMBER_TILE_CELLS)
            continue;
        if (row <= where.last)
            camber_area_corners(c, row, column)[CAMBER_CORNERS_HERE] += e.down;
        if (row > where.first)
            camber_area_corners(c, row - 1, column)[CAMBER_CORNERS_HERE + 1] += e.down;
    }
}

/* Adds edge k of a vector to the rows of cells of a tile that are drawn. */
CAMBER_FN void camber_area_add_edge(camber_tile_state *c, const camber_tile_edges *t, int k, camber_tile_rows where) {
    const float turn = camber_lane_of(&t->turn, k);
    const int first = camber_integer_of(&t->first, k), last = camber_integer_of(&t->last, k);
    const int left = camber_integer_of(&t->left, k), right = camber_integer_of(&t->right, k);
    const camber_tile_edge e = {camber_lane_of(&t->in.x0, k), camber_lane_of(&t->in.y0, k),
                                camber_lane_of(&t->in.y1, k), camber_lane_of(&t->in.down, k),
                                camber_lane_of(&t->slope, k), camber_lane_of(&t->rise, k)};
    if (turn != 0.0f)
        camber_area_turn(c, camber_lane_of(&t->turn_at, k), turn, where);
    for (int row = first; row <= last; row++) {
        if (left == right) {
            camber_area_add_row(c, &e, row, left, right);
            continue;
        }
        const float top = (float)(CAMBER_CELL_PX * row);
        const int upper = camber_edge_column(&e, top), lower = camber_edge_column(&e, top + CAMBER_CELL_PX);
        camber_area_add_row(c, &e, row, CAMBER_LESS(upper, lower), CAMBER_MORE(upper, lower));
    }
}

#endif
