/* Polygons ("areas" of rings): how the edges of rings cover the pixels of a tile.
 *
 * Input: a brush's edges in a tile, and how often its rings wind around the tile's top left corner. Output: the area of
 * each pixel that is inside the rings. Main idea: an edge changes the winding number of everything to its right in the
 * rows that it passes. So each edge adds to a pixel only its own change, exactly, as an area. A running sum from left
 * to right then gives the winding number of each pixel. Edges in opposite directions cancel, so that polygons that
 * share an edge have no seam.
 *
 *      corner                      e1 crosses the top left of the corner: wind counts it for the whole tile.
 *     e1 \ +-----------+           e2 enters through the left side: below that, the winding changes in whole rows.
 *         \|           |           e3 only changes what is to its right.
 *          \  e3 /     |
 *          |\   /      |           Whether an edge passes left of a corner is decided once, by camber_edges_crossing,
 *     e2 ---|\-/       |           so that what wind counts and what a tile counts always fit together.
 *          +-----------+
 *
 * While edges are cut, a lane is an edge; while edges change a cell, a lane is one of its pixels. All sums are
 * integers. */
#ifndef CAMBER_KERNELS_AREA_H
#define CAMBER_KERNELS_AREA_H

#include "tile_state.h"

/* If work-items share a tile, each adds other edges to it. Sums of integers do not depend on the order. */
#if CAMBER_SHARES_TILE
#define CAMBER_SHARED local
#define CAMBER_ADD_TO(sum, change) ((void)atomic_add(sum, change))
#define CAMBER_MARK_CELLS(s, row, cells)                                                                               \
    ((void)atomic_or((local uint *)&(s)->edged + (row) / 4, (uint)(cells) << CAMBER_TILE_CELLS * ((row) % 4)))
#else
#define CAMBER_SHARED
#define CAMBER_ADD_TO(sum, change) ((void)(*(sum) += (change)))
#define CAMBER_MARK_CELLS(s, row, cells) ((void)((s)->edged |= (camber_u64)(cells) << (CAMBER_TILE_CELLS * (row))))
#endif

/* Edges lower than this cover nothing. Edges that move sideways by less than this, in px per px down, count as
 * vertical. */
#define CAMBER_AREA_FLAT_PX 1e-12f
#define CAMBER_AREA_UPRIGHT 1e-12f

/* Edges, one per lane, from their upper ends to their lower ones. */
typedef struct camber_ring_edges {
    camber_real x0, y0, x1, y1;
    camber_real down; /* 1 if the ring goes down along the edge, else -1 */
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

/* Whether edges cross the horizontal line at y. An edge that ends on it does; one that begins on it does not. */
CAMBER_FN camber_mask camber_edges_cross(const camber_ring_edges *e, float y) {
    return (e->y0 < y) & (e->y1 >= y);
}

/* Returns how far right of `left` edges cross the horizontal line at y. Only differences of positions are added up, so
 * that the result is the same wherever in a picture they are. */
CAMBER_FN camber_real camber_edges_crossing(const camber_ring_edges *e, camber_real left, float y) {
    const camber_real x0 = e->x0 - left, x1 = e->x1 - left;
    const camber_real x = x0 + (y - e->y0) * ((e->x1 - e->x0) / (e->y1 - e->y0));
    const camber_real least = CAMBER_LESS(x0, x1), most = CAMBER_MORE(x0, x1);
    return x < least ? least : x > most ? most : x;
}

/* ---- wind: the winding numbers at the corners of a row's tiles ---- */

/* The words of a crossing of the top of a row of tiles. From its column on, the winding number at the corners of tiles
 * is higher by `times` for the rings of its brush. The crossings of a row are in drawing order. */
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

/* Returns the first column of tiles whose corners are right of where edges cross the horizontal line at y. left: of the
 * first column. The nearest corner is compared as its own tile does. */
CAMBER_FN camber_mask camber_columns_after(const camber_ring_edges *e, float left, float y, camber_u32 columns) {
    const camber_real none = CAMBER_REAL(0.0f), past = CAMBER_REAL((float)columns);
    const camber_real at = camber_edges_crossing(e, CAMBER_REAL(left), y) * (1.0f / CAMBER_TILE_PX) + 0.5f;
    const camber_real above = at > none ? at : none; /* also for NaN */
    const camber_mask near = CAMBER_TO_INTEGERS(above < past ? above : past);
    const camber_real corner = left + (float)CAMBER_TILE_PX * CAMBER_TO_REAL(near);
    return camber_edges_crossing(e, corner, y) < 0.0f ? near : near + 1;
}

/* Writes the crossings of one brush, and clears its turns. Returns how many crossings there are now. */
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

/* Segments of a list that may be edges, one per lane. */
typedef struct camber_listed_edges {
    camber_ring_edges edges;
    camber_mask are_edges;
    camber_u32 brushes[CAMBER_LANES];
} camber_listed_edges;

/* Reads the segments of a list from entry `first` on. Lanes past the list's end are not edges. */
CAMBER_FN void camber_take_listed(CAMBER_GLOBAL const float *edges, CAMBER_GLOBAL const camber_u32 *list,
                                  camber_u32 first, camber_u32 count, camber_listed_edges *l) {
    float words[4][CAMBER_LANES];
    for (camber_u32 k = 0; k < CAMBER_LANES; k++) {
        const camber_u32 which = list[first + k < count ? first + k : first];
        CAMBER_GLOBAL const float *ends = edges + camber_edge_ends(which);
        for (int i = 0; i < 4; i++)
            words[i][k] = ends[i];
        l->brushes[k] = first + k < count ? CAMBER_BITS(edges[camber_edge_brush(which)]) : CAMBER_NO_EDGE;
    }
    camber_ring_edges_of(CAMBER_LOAD(0, words[0]), CAMBER_LOAD(0, words[1]), CAMBER_LOAD(0, words[2]),
                         CAMBER_LOAD(0, words[3]), &l->edges);
    l->are_edges = CAMBER_LOAD(0, l->brushes) != CAMBER_NO_EDGE;
}

/* Makes the crossings of a row of tiles from the list of segments that may be edges and cross its top. For edges that
 * cross it in the same column only the sum is kept, which is usually zero. Returns how many crossings there are, at
 * most one per segment. */
CAMBER_FN camber_u32 camber_wind_row(CAMBER_GLOBAL const float *edges, CAMBER_GLOBAL const camber_u32 *list,
                                     camber_u32 edge_count, camber_tile_grid of, float top,
                                     CAMBER_GLOBAL camber_u32 *crossings) {
    int turns[CAMBER_TILES_MAX], first = CAMBER_TILES_MAX, last = -1;
    camber_u32 count = 0, brush = 0;
    const int columns = (int)of.columns;
    for (int i = 0; i < columns; i++)
        turns[i] = 0;
    for (camber_u32 at = 0; at < edge_count; at += CAMBER_LANES) {
        camber_listed_edges l;
        camber_take_listed(edges, list, at, edge_count, &l);
        const camber_mask cross = l.are_edges & camber_edges_cross(&l.edges, top);
        const camber_mask after = camber_columns_after(&l.edges, of.left, top, of.columns);
        for (int k = 0; k < CAMBER_LANES; k++) {
            if (!camber_integer_of(&cross, k))
                continue;
            if (l.brushes[k] != brush) {
                count = camber_put_crossings(turns, first, last, brush, crossings, count);
                first = CAMBER_TILES_MAX;
                last = -1;
                brush = l.brushes[k];
            }
            const int column = camber_integer_of(&after, k);
            if (column >= columns)
                continue;
            turns[column] += (int)camber_lane_of(&l.edges.down, k);
            first = column < first ? column : first;
            last = column > last ? column : last;
        }
    }
    return camber_put_crossings(turns, first, last, brush, crossings, count);
}

/* The crossings of a tile's row that no brush has taken yet: they belong to the brushes that follow, and those of the
 * next brush are last. */
typedef struct camber_crossings_left {
    CAMBER_GLOBAL const camber_u32 *words;
    camber_u32 first, end, column; /* column: the tile's column */
} camber_crossings_left;

/* Returns the brush of the next crossing, or 0, a brush without polygons, if there is none. */
CAMBER_FN camber_u32 camber_next_crossing(const camber_crossings_left *left) {
    return left->end > left->first
               ? left->words[CAMBER_CROSSING_WORDS * (size_t)(left->end - 1u) + CAMBER_CROSSING_BRUSH]
               : 0u;
}

/* Returns the brush of the next crossing or fill, an area that need not have edges in the tile; 0 if there is none. */
CAMBER_FN camber_u32 camber_next_area(const camber_crossings_left *left, const camber_brush *now) {
    const camber_u32 crossing = camber_next_crossing(left);
    return crossing > now->fill ? crossing : now->fill;
}

/* Returns the brush above which a slice draws areas after its lists. These areas are the slice's crossings and the
 * fills between them. Fills below wait until a slice draws something below them, or until the last slice. */
CAMBER_FN camber_u32 camber_areas_end(const camber_crossings_left *left, camber_u32 is_last) {
    if (is_last)
        return 0u;
    return left->end > left->first
               ? left->words[CAMBER_CROSSING_WORDS * (size_t)left->first + CAMBER_CROSSING_BRUSH] - 1u
               : ~0u;
}

/* Takes the crossings of a brush. Returns the winding number of its rings at the tile's corner. */
CAMBER_FN int camber_take_winding(camber_crossings_left *left, camber_u32 brush) {
    int winding = 0;
    for (; camber_next_crossing(left) == brush && brush != 0u; left->end--) {
        const camber_u32 place = left->words[CAMBER_CROSSING_WORDS * (size_t)(left->end - 1u) + CAMBER_CROSSING_PLACE];
        winding += camber_crossing_column(place) <= left->column ? camber_crossing_times(place) : 0;
    }
    return winding;
}

/* ---- Edges in a tile ---- */

CAMBER_FN int camber_brush_is_area(const camber_brush *brush) {
    return brush->mode >= CAMBER_BRUSH_AREA;
}

/* Edges relative to a tile, one per lane. Positions are in px from its corner. */
typedef struct camber_tile_edges {
    camber_ring_edges in; /* from where they enter the tile at the top or through its left side */
    camber_real slope;    /* px to the side per px down */
    camber_real twice_y0, half_slope, half_aside; /* aside: the slope's absolute value */
    camber_real down;          /* one px of height in fixed point (CAMBER_AREA_ONE), with the edge's sign */
    camber_real rise;          /* half of how far down an edge goes per px to the side; 0 if it is vertical */
    camber_real turn, turn_at; /* from turn_at on, the winding number along the left side is higher by turn */
    /* edges that change anything in the tile or in any row of its cells; or flat ones that cross sides of cells, below
     * which the winding differs */
    camber_mask matters;
    camber_mask flat;        /* edges that are horizontal in the tile, and change nothing */
    camber_mask first, last; /* rows of cells; the last is before the first if an edge covers nothing */
    /* the first and the last row of cells whose tops they cross (just below them); CAMBER_TILE_CELLS: the end of the
     * tile */
    camber_mask above, below;
    /* column of cells where they cross each of those tops; CAMBER_TILE_CELLS: right of the tile */
    camber_mask columns[CAMBER_TILE_CELLS + 1];
} camber_tile_edges;

/* Returns a position as a row or column of cells, of which there are `most`. */
CAMBER_FN camber_mask camber_cell_at(camber_real at, camber_mask counts, float most) {
    const camber_real none = CAMBER_REAL(0.0f), cell = (1.0f / CAMBER_CELL_PX) * at;
    return CAMBER_TO_INTEGERS((counts & (cell > none)) ? (cell < most ? cell : CAMBER_REAL(most)) : none);
}

/* Cuts the edges that enter the tile through its left side on their way down, and the edges that leave it through that
 * side. */
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

/* Returns which edges from A to B have boxes that touch a tile. */
CAMBER_FN camber_mask camber_boxes_touch_tile(camber_real ax, camber_real ay, camber_real bx, camber_real by,
                                              camber_tile_rows where) {
    const float left = where.left, top = where.top, right = left + CAMBER_TILE_PX, bottom = top + CAMBER_TILE_PX;
    return ((ax < right) | (bx < right)) & ((ax >= left) | (bx >= left)) & ((ay < bottom) | (by < bottom)) &
           ((ay >= top) | (by >= top));
}

/* Computes the wanted edges relative to a tile, or to those rows of its cells that are drawn. */
CAMBER_FN void camber_tile_edges_of(const camber_ring_edges *ring, camber_mask wanted, camber_tile_rows where,
                                    camber_tile_edges *t) {
    const float side = (float)CAMBER_TILE_PX, cells = (float)CAMBER_TILE_CELLS;
    camber_ring_edges *e = &t->in;
    const camber_mask crosses = camber_edges_cross(ring, where.top);
    *e = *ring;
    e->x0 = crosses ? camber_edges_crossing(ring, CAMBER_REAL(where.left), where.top) : e->x0 - where.left;
    e->x1 = e->x1 - where.left;
    e->y0 = (crosses ? CAMBER_REAL(where.top) : e->y0) - where.top;
    e->y1 = e->y1 - where.top;
    const camber_mask meets = wanted & (e->y1 >= 0.0f) & (e->y0 < side) & ((e->x0 >= 0.0f) | (e->x1 >= 0.0f));
    camber_cut_at_left(t, meets & (e->x0 < 0.0f), meets & (e->x1 < 0.0f));
    const camber_mask passes = meets & ((e->x0 < side) | (e->x1 < side));
    const camber_mask covers = passes & (e->y1 - e->y0 > CAMBER_AREA_FLAT_PX);
    const camber_real high = covers ? e->y1 - e->y0 : CAMBER_REAL(1.0f);
    t->slope = (e->x1 - e->x0) / high;
    const camber_real aside = CAMBER_FABS(t->slope);
    t->twice_y0 = 2.0f * e->y0;
    t->half_slope = 0.5f * t->slope;
    t->half_aside = 0.5f * aside;
    t->down = (float)CAMBER_AREA_ONE * e->down;
    t->rise = aside > CAMBER_AREA_UPRIGHT ? 0.5f * t->down / aside : CAMBER_REAL(0.0f);
    t->flat = passes & ~covers;
    const camber_mask from = camber_cell_at(e->x0, t->flat, cells), to = camber_cell_at(e->x1, t->flat, cells);
    const camber_real low = e->y1 < side ? e->x1 : e->x0 + (side - e->y0) * t->slope;
    t->matters = (covers & ((e->x0 < side) | (low < side))) | (t->turn != 0.0f) | (from != to);
    const camber_mask top = camber_cell_at(e->y0, covers, cells), bottom = camber_cell_at(e->y1, covers, cells);
    const camber_mask above = e->y0 > (float)CAMBER_CELL_PX * CAMBER_TO_REAL(top) ? top + 1 : top;
    const camber_mask below = e->y1 > (float)CAMBER_CELL_PX * CAMBER_TO_REAL(bottom) ? bottom : bottom - 1;
    const camber_mask end = (camber_mask)(where.last + 1), none = (camber_mask)(where.first - 1);
    t->first = top > where.first ? top : where.first;
    t->last = covers ? (below < where.last ? below : where.last) : none;
    t->above = above > where.first ? above : where.first;
    t->below = covers ? (below < end ? below : end) : none;
    for (int row = where.first; row <= where.last + 1; row++) {
        const camber_real at = CAMBER_REAL((float)(CAMBER_CELL_PX * row));
        const camber_real y = at < e->y0 ? e->y0 : at > e->y1 ? e->y1 : at;
        t->columns[row] = camber_cell_at(e->x0 + (y - e->y0) * t->slope, covers, cells);
    }
}

/* A single edge in a tile. If it is flat, y1 is y0, and slope is the x at which it ends. */
typedef struct camber_tile_edge {
    float x0, y0, y1, slope;
    int down;
} camber_tile_edge;

CAMBER_FN int camber_tile_edge_is_flat(const camber_tile_edge *e) {
    return e->y0 == e->y1;
}

/* Returns where an edge is at y, in px from the tile's left side. */
CAMBER_FN float camber_edge_at(const camber_tile_edge *e, float y) {
    const float at = y < e->y0 ? e->y0 : y > e->y1 ? e->y1 : y;
    return e->x0 + (at - e->y0) * e->slope;
}

/* Columns of cells; the last is before the first if there are none. */
typedef struct camber_cell_columns {
    int first, last;
} camber_cell_columns;

CAMBER_FN camber_mask camber_columns_at(camber_real x) {
    return camber_cell_at(x, x > 0.0f, (float)CAMBER_TILE_CELLS);
}

/* An edge as a tile keeps it, one per lane: its CAMBER_PLACED_WORDS words. */
typedef struct camber_placed_edges {
    camber_real words[CAMBER_PLACED_WORDS];
} camber_placed_edges;

/* Returns the columns that edges pass in a row of cells, one bit each. wanted: the lanes that count. */
CAMBER_FN camber_words camber_passed_columns(const camber_placed_edges *e, camber_mask wanted, int row) {
    const camber_words one = CAMBER_WORD(1u), two = CAMBER_WORD(2u), none = CAMBER_WORD(0u);
    const camber_real x0 = e->words[0], y0 = e->words[1], y1 = e->words[2], slope = e->words[3];
    const camber_real top = CAMBER_REAL((float)(CAMBER_CELL_PX * row)), bottom = top + (float)CAMBER_CELL_PX;
    const camber_mask passes = wanted & (y1 > top) & (y0 < bottom);
    if (!CAMBER_ANY(passes))
        return none;
    const camber_real from = top < y0 ? y0 : top > y1 ? y1 : top, to = bottom < y0 ? y0 : bottom > y1 ? y1 : bottom;
    const camber_mask upper = camber_columns_at(x0 + (from - y0) * slope);
    const camber_mask lower = camber_columns_at(y0 == y1 ? slope : x0 + (to - y0) * slope);
    const camber_words first = CAMBER_TO_WORDS(CAMBER_LESS(upper, lower)),
                       last = CAMBER_TO_WORDS(CAMBER_MORE(upper, lower));
    return passes ? ((two << last) - (one << first)) & 255u : none;
}

#if CAMBER_SHARES_TILE
/* The group clears all changes when it begins a brush. */
CAMBER_FN void camber_area_take_row(local camber_area_state *s, int row) {
    (void)s;
    (void)row;
}
#else
/* Prepares a row of cells for changes: if it has no edges so far, clears its changes. */
CAMBER_FN void camber_area_take_row(camber_area_state *s, int row) {
    if (s->edged >> (CAMBER_TILE_CELLS * row) & 255u)
        return;
    for (int x = 0; x <= CAMBER_TILE_CELLS; x++)
        for (int k = 0; k < 2; k++)
            for (int v = 0; v < CAMBER_VECTORS; v++)
                s->changes[row][x][k][v] = CAMBER_WORD(0u);
}

/* Begins a brush, which has no edges yet. */
CAMBER_FN void camber_area_begin(camber_area_state *s) {
    for (int row = 0; row <= CAMBER_TILE_CELLS; row++)
        for (int x = 0; x <= CAMBER_TILE_CELLS; x++)
            s->turns[row][x] = 0;
    s->has_edges = 1;
    s->edged = 0;
    s->placed_count = s->kept_count = 0;
}
#endif

#if CAMBER_HAS_VECTORS
/* For each row of pixels of a tile, its number for four pixels; for each column of cells, the right sides of its
 * pixels. To load these takes a third of the time of making them. */
#define CAMBER_FOUR_TIMES(y) y, y, y, y
#define CAMBER_FOUR_ROWS(y)                                                                                            \
    CAMBER_FOUR_TIMES(y), CAMBER_FOUR_TIMES(y + 1), CAMBER_FOUR_TIMES(y + 2), CAMBER_FOUR_TIMES(y + 3)
constant float TILE_ROWS[] = {CAMBER_FOUR_ROWS(0),  CAMBER_FOUR_ROWS(4),  CAMBER_FOUR_ROWS(8),
                              CAMBER_FOUR_ROWS(12), CAMBER_FOUR_ROWS(16), CAMBER_FOUR_ROWS(20),
                              CAMBER_FOUR_ROWS(24), CAMBER_FOUR_ROWS(28), CAMBER_FOUR_TIMES(32)};
#define CAMBER_FOUR_RIGHTS(x) x + 1, x + 2, x + 3, x + 4
#define CAMBER_RIGHTS(x) CAMBER_FOUR_RIGHTS(x), CAMBER_FOUR_RIGHTS(x), CAMBER_FOUR_RIGHTS(x), CAMBER_FOUR_RIGHTS(x)
constant float TILE_RIGHTS[] = {CAMBER_RIGHTS(0),  CAMBER_RIGHTS(4),  CAMBER_RIGHTS(8),  CAMBER_RIGHTS(12),
                                CAMBER_RIGHTS(16), CAMBER_RIGHTS(20), CAMBER_RIGHTS(24), CAMBER_RIGHTS(28)};
#endif

/* Return the tops and the bottoms of the pixels in a vector of a cell, in px from the tile's top. */
CAMBER_FN camber_real camber_area_tops(int row, int v) {
#if CAMBER_HAS_VECTORS
    return CAMBER_LOAD(0, TILE_ROWS + 16 * row + CAMBER_LANES * v);
#else
    return (float)(CAMBER_CELL_PX * row + v / CAMBER_CELL_PX);
#endif
}

CAMBER_FN camber_real camber_area_bottoms(int row, int v) {
#if CAMBER_HAS_VECTORS
    return CAMBER_LOAD(0, TILE_ROWS + 16 * row + CAMBER_LANES * v + CAMBER_CELL_PX);
#else
    return camber_area_tops(row, v) + 1.0f;
#endif
}

/* Returns the right sides of the pixels in a vector of a cell, in px from the tile's left side. */
CAMBER_FN camber_real camber_area_rights(int column, int v) {
#if CAMBER_HAS_VECTORS
    (void)v;
    return CAMBER_LOAD(0, TILE_RIGHTS + 16 * column);
#else
    return (float)(CAMBER_CELL_PX * column + v % CAMBER_CELL_PX + 1);
#endif
}

CAMBER_FN camber_real camber_between(camber_real x, float least, float most) {
    const camber_real above = x > least ? x : CAMBER_REAL(least);
    return above < most ? above : CAMBER_REAL(most);
}

/* From y on, in px from the tile's top, raises the winding number along the tile's left side. */
CAMBER_FN void camber_area_turn(CAMBER_SHARED camber_area_state *s, float y, float times, camber_tile_rows where) {
    int row = (int)y / CAMBER_CELL_PX;
    if (y > (float)(CAMBER_CELL_PX * row)) {
        if (row >= where.first && row <= where.last) {
            camber_area_take_row(s, row);
            CAMBER_MARK_CELLS(s, row, 1u);
            for (int v = 0; v < CAMBER_VECTORS; v++) {
                const camber_real rows = camber_between(camber_area_tops(row, v) + (1.0f - y), 0.0f, 1.0f);
                CAMBER_ADD_TO(&s->changes[row][0][CAMBER_AREA_ON][v],
                              CAMBER_ROUNDED_WORDS(times * (float)CAMBER_AREA_ONE * rows));
            }
        }
        row++;
    }
    for (; row <= CAMBER_TILE_CELLS; row++)
        CAMBER_ADD_TO(&s->turns[row][0], (int)times);
}

/* The piece of an edge in each row of pixels of a vector. height is in fixed point, with the edge's sign. */
typedef struct camber_edge_pieces {
    camber_real left, right, wide, height;
} camber_edge_pieces;

CAMBER_FN void camber_edge_pieces_of(const camber_tile_edges *t, int k, int row, int v, camber_edge_pieces *p) {
    const float x0 = camber_lane_of(&t->in.x0, k), y0 = camber_lane_of(&t->in.y0, k), y1 = camber_lane_of(&t->in.y1, k);
    const camber_real from = camber_between(camber_area_tops(row, v), y0, y1);
    const camber_real to = camber_between(camber_area_bottoms(row, v), y0, y1), height = to - from;
    const camber_real aside = height * camber_lane_of(&t->half_aside, k);
    p->wide = aside + aside;
    p->left = x0 + (from + to - camber_lane_of(&t->twice_y0, k)) * camber_lane_of(&t->half_slope, k) - aside;
    p->right = p->left + p->wide;
    p->height = height * camber_lane_of(&t->down, k);
}

/* Returns the area in the pieces' rows that is right of them and left of x, in fixed point. */
CAMBER_FN camber_real camber_edge_pieces_left_of(const camber_edge_pieces *p, float rise, camber_real x) {
    const camber_real none = CAMBER_REAL(0.0f);
    camber_real inner = x - p->left, past = x - p->right;
    inner = CAMBER_MORE(inner, none);
    inner = CAMBER_LESS(inner, p->wide);
    past = CAMBER_MORE(past, none);
    return rise * inner * inner + p->height * past;
}

/* Returns for each pixel the area to the left of its right side minus the area to the left of the previous pixel's
 * right side. before: the same areas for the previous cell. */
CAMBER_FN camber_real camber_of_pixels(const camber_real *all, const camber_real *before, int v) {
#if CAMBER_LANES == 1
    return all[v] - (v % CAMBER_CELL_PX ? all[v - 1] : before[v + CAMBER_CELL_PX - 1]);
#elif CAMBER_LANES == 16
    const float16 a = all[v], b = before[v];
    return a -
           (float16)(b.s3, a.s0, a.s1, a.s2, b.s7, a.s4, a.s5, a.s6, b.sb, a.s8, a.s9, a.sa, b.sf, a.sc, a.sd, a.se);
#elif CAMBER_LANES == 8
    const float8 a = all[v], b = before[v];
    return a - (float8)(b.s3, a.s0, a.s1, a.s2, b.s7, a.s4, a.s5, a.s6);
#else
    return all[v] - (float4)(before[v].s3, all[v].s012);
#endif
}

/* Returns how much of the pieces' rows is to the left of the right sides of the pixels in a column of cells. */
CAMBER_FN camber_real camber_edge_pieces_until(const camber_edge_pieces *p, float rise, int column, int v) {
    return camber_edge_pieces_left_of(p + v, rise, camber_area_rights(column, v));
}

/* Adds edge k of a vector to the columns of a row of cells, and to everything right of them. */
CAMBER_FN void camber_area_add_row(CAMBER_SHARED camber_area_state *s, const camber_tile_edges *t, int k, int row,
                                   const camber_cell_columns *at) {
    const int end = at->last < CAMBER_TILE_CELLS ? at->last + 1 : CAMBER_TILE_CELLS;
    const float rise = camber_lane_of(&t->rise, k);
    camber_edge_pieces p[CAMBER_VECTORS];
    camber_real before[CAMBER_VECTORS], all[CAMBER_VECTORS];
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        camber_edge_pieces_of(t, k, row, v, p + v);
        CAMBER_ADD_TO(&s->changes[row][end][CAMBER_AREA_ON][v], CAMBER_ROUNDED_WORDS(p[v].height));
        before[v] = CAMBER_REAL(0.0f);
    }
    for (int x = at->first; x < end; x++) {
        for (int v = 0; v < CAMBER_VECTORS; v++)
            all[v] = camber_edge_pieces_until(p, rise, x, v);
        for (int v = 0; v < CAMBER_VECTORS; v++)
            CAMBER_ADD_TO(&s->changes[row][x][CAMBER_AREA_HERE][v],
                          CAMBER_ROUNDED_WORDS(camber_of_pixels(all, before, v)));
        for (int v = 0; v < CAMBER_VECTORS; v++)
            before[v] = all[v];
    }
}

/* Marks the cells that a flat edge k of a vector passes: the winding number above it differs from that below it. */
CAMBER_FN void camber_area_mark_flat(CAMBER_SHARED camber_area_state *s, const camber_tile_edges *t, int k,
                                     camber_tile_rows where) {
    const float x0 = camber_lane_of(&t->in.x0, k), x1 = camber_lane_of(&t->in.x1, k), y = camber_lane_of(&t->in.y0, k);
    const float least = CAMBER_LESS(x0, x1), most = CAMBER_MORE(x0, x1), side = (float)CAMBER_TILE_PX - 1.0f;
    const int row = (int)y / CAMBER_CELL_PX, from = (int)CAMBER_LESS(least, side) / CAMBER_CELL_PX,
              to = (int)CAMBER_LESS(most, side) / CAMBER_CELL_PX;
    if (row < where.first || row > where.last)
        return;
    camber_area_take_row(s, row);
    CAMBER_MARK_CELLS(s, row, ((camber_u64)2 << to) - ((camber_u64)1 << from));
}

/* Adds edge k of a vector to the cells that it passes, and changes the winding at corners right of where it crosses
 * tops of cells. */
CAMBER_FN void camber_area_add_edge(CAMBER_SHARED camber_area_state *s, const camber_tile_edges *t, int k) {
    const int first = camber_integer_of(&t->first, k), last = camber_integer_of(&t->last, k);
    const int above = camber_integer_of(&t->above, k), below = camber_integer_of(&t->below, k);
    const int down = (int)camber_lane_of(&t->in.down, k);
    int upper = camber_integer_of(t->columns + first, k);
    if (above <= first && above <= below && upper < CAMBER_TILE_CELLS)
        CAMBER_ADD_TO(&s->turns[first][upper + 1], down);
    for (int row = first; row <= last; row++) {
        const int lower = camber_integer_of(t->columns + row + 1, k);
        const camber_cell_columns at = {CAMBER_LESS(upper, lower), CAMBER_MORE(upper, lower)};
        if (row < below && lower < CAMBER_TILE_CELLS)
            CAMBER_ADD_TO(&s->turns[row + 1][lower + 1], down);
        upper = lower;
        if (at.first == CAMBER_TILE_CELLS)
            continue;
        camber_area_take_row(s, row);
        CAMBER_MARK_CELLS(s, row, (((camber_u64)2 << at.last) - ((camber_u64)1 << at.first)) & 255u);
        camber_area_add_row(s, t, k, row, &at);
    }
}

/* Returns the words with which a tile keeps the edges of a vector. */
CAMBER_FN camber_placed_edges camber_placed_edges_of(const camber_tile_edges *t) {
    const camber_real one = CAMBER_REAL(1.0f), way = t->turn == 0.0f         ? one
                                                     : t->turn == t->in.down ? CAMBER_REAL(CAMBER_PLACED_LEAVES)
                                                                             : CAMBER_REAL(CAMBER_PLACED_ENTERS);
    const camber_real y1 = t->flat ? t->in.y0 : t->in.y1, slope = t->flat ? t->in.x1 : t->slope;
    const camber_placed_edges e = {{t->in.x0, t->in.y0, y1, slope, way * t->in.down}};
    return e;
}

#if CAMBER_SHARES_TILE
/* Counts an edge. If polygons overlap, their edges are read again. */
CAMBER_FN void camber_area_place(local camber_area_state *s, const camber_tile_edges *t, int count) {
    (void)count;
    if (t->matters)
        CAMBER_ADD_TO(&s->placed_count, 1);
}
#else
/* Keeps the first `count` edges of a vector, in case polygons overlap. */
CAMBER_FN void camber_area_place(camber_area_state *s, const camber_tile_edges *t, int count) {
    const camber_placed_edges e = camber_placed_edges_of(t);
    const int all_matter = CAMBER_ALL(t->matters | (camber_numbers(0) >= (float)count));
    if (all_matter && s->placed_count + count <= CAMBER_PLACED_MOST) {
        for (int i = 0; i < CAMBER_PLACED_WORDS; i++)
            CAMBER_STORE(e.words[i], 0, s->placed[i] + s->placed_count);
        s->placed_count += count;
        s->kept_count = s->placed_count;
        return;
    }
    for (int k = 0; k < count && s->placed_count <= CAMBER_PLACED_MOST; k++) {
        if (!camber_integer_of(&t->matters, k))
            continue;
        s->placed_count++;
        if (s->kept_count == CAMBER_PLACED_MOST)
            continue;
        for (int i = 0; i < CAMBER_PLACED_WORDS; i++)
            s->placed[i][s->kept_count] = camber_lane_of(e.words + i, k);
        s->kept_count++;
    }
}
#endif

/* ---- Edges inside a pixel ---- */

/* Edges that are each inside a single pixel, one per lane. Detailed outlines have little else. */
typedef struct camber_tiny_edges {
    camber_mask are;           /* which lanes have such an edge */
    camber_mask row, column;   /* its pixel in the tile */
    camber_words here, height; /* in fixed point: how much of the pixel is right of the edge between its ends, and how
                                * much of the pixel's height is between them */
} camber_tiny_edges;

/* Finds such edges, given relative to the tile, in the rows of cells that are drawn. An edge that begins on the border
 * of two rows of pixels is none of them, so they cross no top of a cell. */
CAMBER_FN void camber_tiny_edges_of(const camber_ring_edges *e, camber_mask wanted, camber_tile_rows where,
                                    camber_tiny_edges *tiny) {
    const float side = (float)CAMBER_TILE_PX, first = (float)(CAMBER_CELL_PX * where.first),
                end = (float)(CAMBER_CELL_PX * (where.last + 1));
    const camber_real none = CAMBER_REAL(0.0f), height = e->y1 - e->y0, middle = 0.5f * (e->x0 + e->x1);
    const camber_mask inside = wanted & (e->y0 > first) & (e->y1 < end) & (e->x0 >= 0.0f) & (e->x1 >= 0.0f) &
                               (e->x0 < side) & (e->x1 < side) & (height > CAMBER_AREA_FLAT_PX);
    const camber_real x0 = inside ? e->x0 : none, x1 = inside ? e->x1 : none;
    const camber_real y0 = inside ? e->y0 : none, y1 = inside ? e->y1 : none;
    tiny->row = CAMBER_TO_INTEGERS(y0);
    tiny->column = CAMBER_TO_INTEGERS(x0);
    tiny->are = inside & (CAMBER_TO_INTEGERS(x1) == tiny->column) & (CAMBER_TO_INTEGERS(y1) == tiny->row) &
                (y0 > CAMBER_TO_REAL(tiny->row));
    const camber_real high = (inside ? height : none) * (float)CAMBER_AREA_ONE * e->down;
    const camber_real right = CAMBER_TO_REAL(tiny->column) + 1.0f - (inside ? middle : none);
    tiny->here = CAMBER_ROUNDED_WORDS(high * right);
    tiny->height = CAMBER_ROUNDED_WORDS(high);
}

#if CAMBER_HAS_VECTORS
/* All bits for the pixel of a row of a cell, by its column, and for the pixels right of it. */
constant camber_u32 PIXEL[CAMBER_CELL_PX][CAMBER_CELL_PX] = {
    {~0u, 0, 0, 0}, {0, ~0u, 0, 0}, {0, 0, ~0u, 0}, {0, 0, 0, ~0u}};
constant camber_u32 BEHIND[CAMBER_CELL_PX][CAMBER_CELL_PX] = {
    {0, ~0u, ~0u, ~0u}, {0, 0, ~0u, ~0u}, {0, 0, 0, ~0u}, {0, 0, 0, 0}};
#endif

/* Returns what a tiny edge in a column of a row of a cell changes in pixel i of the row. */
CAMBER_FN camber_u32 camber_tiny_change(camber_u32 column, camber_u32 i, camber_u32 here, camber_u32 height) {
#if CAMBER_HAS_VECTORS
    return (here & PIXEL[column][i]) | (height & BEHIND[column][i]);
#else
    return i < column ? 0u : i == column ? here : height;
#endif
}

/* Adds tiny edge k of a vector to its pixel, and to everything to the right of it. */
CAMBER_FN void camber_area_add_tiny(CAMBER_SHARED camber_area_state *s, const camber_tiny_edges *tiny, int k) {
    const camber_u32 y = (camber_u32)camber_integer_of(&tiny->row, k),
                     x = (camber_u32)camber_integer_of(&tiny->column, k);
    const camber_u32 first = y % CAMBER_CELL_PX * CAMBER_CELL_PX, row = y / CAMBER_CELL_PX, column = x / CAMBER_CELL_PX;
    const camber_u32 here = ((const camber_u32 *)&tiny->here)[k], height = ((const camber_u32 *)&tiny->height)[k];
    camber_area_take_row(s, (int)row);
    CAMBER_MARK_CELLS(s, row, (camber_u64)1 << column);
    CAMBER_SHARED camber_u32 *on = (CAMBER_SHARED camber_u32 *)s->changes[row][column + 1][CAMBER_AREA_ON],
                             *in = (CAMBER_SHARED camber_u32 *)s->changes[row][column][CAMBER_AREA_HERE];
    for (camber_u32 i = 0; i < CAMBER_CELL_PX; i++)
        CAMBER_ADD_TO(on + first + i, height);
    for (camber_u32 i = 0; i < CAMBER_CELL_PX; i++)
        CAMBER_ADD_TO(in + first + i, camber_tiny_change(x % CAMBER_CELL_PX, i, here, height));
}

/* ---- All edges ---- */

/* Adds edge k of a vector, which is not inside a pixel. */
CAMBER_FN void camber_area_add_larger(CAMBER_SHARED camber_area_state *s, const camber_tile_edges *t, int k,
                                      camber_tile_rows where) {
    const float turn = camber_lane_of(&t->turn, k);
    if (turn != 0.0f)
        camber_area_turn(s, camber_lane_of(&t->turn_at, k), turn, where);
    /* An edge that begins where the last row of cells ends changes the winding at the corners of that end. */
    if (camber_integer_of(&t->first, k) <= camber_integer_of(&t->last, k) ||
        camber_integer_of(&t->above, k) <= camber_integer_of(&t->below, k))
        camber_area_add_edge(s, t, k);
    else if (camber_integer_of(&t->flat, k))
        camber_area_mark_flat(s, t, k, where);
}

/* Cuts wanted edges to a tile, and finds those that are inside a pixel. */
CAMBER_FN void camber_area_cut(const camber_ring_edges *ring, camber_mask wanted, camber_tile_rows where,
                               camber_tile_edges *t, camber_tiny_edges *tiny) {
    t->in = *ring;
    t->in.x0 = ring->x0 - where.left;
    t->in.x1 = ring->x1 - where.left;
    t->in.y0 = ring->y0 - where.top;
    t->in.y1 = ring->y1 - where.top;
    camber_tiny_edges_of(&t->in, wanted, where, tiny);
    if (CAMBER_ANY(wanted & ~tiny->are)) {
        camber_tile_edges_of(ring, wanted, where, t);
        return;
    }
    t->slope = (t->in.x1 - t->in.x0) / (tiny->are ? t->in.y1 - t->in.y0 : CAMBER_REAL(1.0f));
    t->turn = CAMBER_REAL(0.0f);
    t->matters = tiny->are;
    t->flat = tiny->are & ~tiny->are;
}

/* Adds the first `count` edges of a vector. */
CAMBER_FN void camber_area_add(CAMBER_SHARED camber_area_state *s, const camber_ring_edges *ring, int count,
                               camber_tile_rows where) {
    camber_tile_edges t;
    camber_tiny_edges tiny;
#if !CAMBER_SHARES_TILE
    if (!s->has_edges)
        camber_area_begin(s);
#endif
    camber_area_cut(ring, camber_numbers(0) < (float)count, where, &t, &tiny);
    for (int k = 0; k < count; k++) {
        if (camber_integer_of(&tiny.are, k))
            camber_area_add_tiny(s, &tiny, k);
        else
            camber_area_add_larger(s, &t, k, where);
    }
    camber_area_place(s, &t, count);
}

#endif
