/* Areas: what is inside of a brush's rings, from what their edges change in a tile (area.h).
 *
 * Main idea: where a pixel is wound around once or not at all, the sum of its windings is its area, exactly. Where
 * areas of one fill overlap or cross, windings of 2 count as 1, and a sum hides that. Cells that have such pixels are
 * found by their sums and by the windings around their corners; there are few. The edges that reach into such a cell
 * cut rows of samples at exact places. What windings are too much between them is taken from the sum:
 *
 *      once  twice  once
 *     ----+-------+-------    a row of samples: the sum has 2 between the edges, and 1 too much
 *         e1      e2
 *
 * So a pixel without such windings keeps its sum. Lanes are rows of samples here. */
#ifndef CAMBER_KERNELS_AREA_INSIDE_H
#define CAMBER_KERNELS_AREA_INSIDE_H

#include "area.h"

/* Sums that are off by less are those of areas that do not overlap. */
#define CAMBER_AREA_SLACK 1e-3f
/* A cell that more edges reach into keeps its sums, and so does a tile with more edges of one brush. */
#define CAMBER_OVERLAP_EDGES 64

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

/* ---- Overlaps ---- */

/* The edges of a brush in a tile: those of the tile's list, and those that were kept from slices before. */
typedef struct camber_area_edges {
    CAMBER_GLOBAL const float *segments;
    CAMBER_GLOBAL const camber_u32 *list;
    CAMBER_GLOBAL const float *kept; /* CAMBER_KEPT_WORDS each */
    camber_u32 count, kept_count;    /* kept_count: more than CAMBER_KEPT_MOST where not all could be kept */
} camber_area_edges;

/* Whether the edge of a segment or of a kept one matters in a tile. Lists have more where the area ends. */
CAMBER_FN int camber_edge_matters(CAMBER_GLOBAL const float *ends, camber_tile_rows where) {
    const float ax = ends[0] - where.left, ay = ends[1] - where.top;
    const float bx = ends[2] - where.left, by = ends[3] - where.top;
    const float side = (float)CAMBER_TILE_PX;
    return (ax >= 0.0f || bx >= 0.0f) && (ay >= 0.0f || by >= 0.0f) && (ax < side || bx < side) &&
           (ay < side || by < side);
}

/* An edge, and the cells that it passes. */
typedef struct camber_placed_edge {
    camber_tile_edge edge;
    float turn, turn_at;          /* camber_tile_edges */
    int first, last, left, right; /* rows and columns of cells */
} camber_placed_edge;

typedef struct camber_placed_edges {
    camber_placed_edge edges[CAMBER_KEPT_MOST];
    int count;
    int in_row[CAMBER_KEPT_MOST], row_count;     /* those that change a row of cells */
    float ends[CAMBER_KEPT_WORDS][CAMBER_LANES]; /* of those that wait: ax, ay, bx, by */
    int waiting;
} camber_placed_edges;

/* Places the edges that wait. */
CAMBER_FN void camber_place_waiting(camber_placed_edges *all, camber_tile_rows where) {
    const camber_tile_rows tile = {where.left, where.top, 0, CAMBER_TILE_CELLS - 1};
    camber_ring_edges e;
    camber_tile_edges t;
    for (int k = all->waiting; k < CAMBER_LANES && all->waiting > 0; k++)
        for (int i = 0; i < CAMBER_KEPT_WORDS; i++)
            all->ends[i][k] = all->ends[i][0];
    if (all->waiting == 0)
        return;
    camber_ring_edges_of(CAMBER_LOAD(0, all->ends[0]), CAMBER_LOAD(0, all->ends[1]), CAMBER_LOAD(0, all->ends[2]),
                         CAMBER_LOAD(0, all->ends[3]), &e);
    camber_tile_edges_of(&e, CAMBER_ALL_LANES(1), tile, &t);
    for (int k = 0; k < all->waiting; k++) {
        camber_placed_edge *to = all->edges + all->count++;
        camber_tile_edge_of(&t, k, &to->edge);
        to->turn = camber_lane_of(&t.turn, k);
        to->turn_at = camber_lane_of(&t.turn_at, k);
        to->first = camber_integer_of(&t.first, k);
        to->last = camber_integer_of(&t.last, k);
        to->left = camber_integer_of(&t.left, k);
        to->right = camber_integer_of(&t.right, k);
    }
    all->waiting = 0;
}

/* Returns whether there was room. */
CAMBER_FN int camber_place_edge(camber_placed_edges *all, CAMBER_GLOBAL const float *ends, camber_tile_rows where) {
    if (all->count + all->waiting == CAMBER_KEPT_MOST)
        return 0;
    for (int i = 0; i < CAMBER_KEPT_WORDS; i++)
        all->ends[i][all->waiting] = ends[i];
    if (++all->waiting == CAMBER_LANES)
        camber_place_waiting(all, where);
    return 1;
}

/* Places all edges that matter. Returns whether there are not too many. */
CAMBER_FN int camber_place_edges(const camber_area_edges *from, camber_tile_rows where, camber_placed_edges *all) {
    int has_room = from->kept_count <= CAMBER_KEPT_MOST;
    all->count = all->waiting = 0;
    for (camber_u32 k = 0; k < from->kept_count && has_room; k++)
        has_room = camber_place_edge(all, from->kept + CAMBER_KEPT_WORDS * (size_t)k, where);
    for (camber_u32 k = 0; k < from->count && has_room; k++) {
        CAMBER_GLOBAL const float *segment = from->segments + CAMBER_SEGMENT_WORDS * (size_t)from->list[k];
        if (camber_edge_matters(segment, where))
            has_room = camber_place_edge(all, segment, where);
    }
    camber_place_waiting(all, where);
    return has_room;
}

/* Lists those that change a row of cells. */
CAMBER_FN void camber_placed_in_row(camber_placed_edges *all, int row) {
    all->row_count = 0;
    for (int k = 0; k < all->count; k++) {
        const camber_placed_edge *e = all->edges + k;
        all->in_row[all->row_count] = k;
        all->row_count += (e->first <= row && e->last >= row) || e->turn != 0.0f;
    }
}

/* A cell in which rings may overlap: how often the rings wind around where its rows of samples begin, and the edges
 * that reach into it. */
typedef struct camber_piled_cell {
    int row, column, edge_count;                       /* more than CAMBER_OVERLAP_EDGES: not all are here */
    camber_real begin[CAMBER_CELL_PX][CAMBER_VECTORS]; /* of each row of pixels */
    camber_tile_edge edges[CAMBER_OVERLAP_EDGES];
} camber_piled_cell;

/* Where the sixteen rows of samples of a row of pixels lie, px from the tile's top. */
CAMBER_FN camber_real camber_piled_cell_rows(const camber_piled_cell *o, int row, int v) {
    return (float)(CAMBER_CELL_PX * o->row) + (camber_numbers(v) + ((float)(16 * row) + 0.5f)) * (1.0f / 16);
}

/* How often an edge turns rows of samples. */
CAMBER_FN camber_real camber_edge_turns(const camber_tile_edge *e, camber_real y) {
    const camber_mask turns = (e->y0 < y) & (e->y1 >= y);
    return turns ? CAMBER_REAL(e->down) : CAMBER_REAL(0.0f);
}

/* Adds how often an edge turns rows of samples to where these begin: on its whole height, or below where it enters or
 * leaves the tile through its left side. */
CAMBER_FN void camber_piled_cell_begin(camber_piled_cell *o, const camber_placed_edge *e, int is_left) {
    const float top = (float)(CAMBER_CELL_PX * o->row);
    for (int row = 0; row < CAMBER_CELL_PX; row++) {
        const float above = top + (float)row;
        const int turns = is_left && e->edge.y0 < above + 1.0f && e->edge.y1 >= above;
        for (int v = 0; v < CAMBER_VECTORS && (turns || e->turn != 0.0f); v++) {
            const camber_real y = camber_piled_cell_rows(o, row, v), none = CAMBER_REAL(0.0f);
            o->begin[row][v] += y > e->turn_at ? CAMBER_REAL(e->turn) : none;
            o->begin[row][v] += turns ? camber_edge_turns(&e->edge, y) : none;
        }
    }
}

CAMBER_FN void camber_piled_cell_of(const camber_placed_edges *from, int winding, camber_piled_cell *o) {
    const float top = (float)(CAMBER_CELL_PX * o->row);
    o->edge_count = 0;
    for (int row = 0; row < CAMBER_CELL_PX; row++)
        for (int v = 0; v < CAMBER_VECTORS; v++)
            o->begin[row][v] = CAMBER_REAL((float)winding);
    for (int k = 0; k < from->row_count; k++) {
        const camber_placed_edge *e = from->edges + from->in_row[k];
        const int meets = e->first <= o->row && e->last >= o->row && e->left <= o->column;
        if (!meets && e->turn == 0.0f)
            continue;
        const int upper = camber_edge_column(&e->edge, top), lower = camber_edge_column(&e->edge, top + CAMBER_CELL_PX);
        const int is_left = meets && CAMBER_MORE(upper, lower) < o->column;
        if (is_left || e->turn != 0.0f)
            camber_piled_cell_begin(o, e, is_left);
        if (!meets || is_left || CAMBER_LESS(upper, lower) > o->column)
            continue;
        if (o->edge_count < CAMBER_OVERLAP_EDGES)
            o->edges[o->edge_count] = e->edge;
        o->edge_count++;
    }
}

/* How much less is inside than a winding says, by its sign in this cell. */
CAMBER_FN camber_real camber_too_much(camber_real winding, float sign, camber_u32 mode) {
    const camber_real one = CAMBER_REAL(1.0f);
    camber_real inside = CAMBER_FABS(winding);
    if (mode == CAMBER_BRUSH_AREA_EVENODD)
        inside -= 2.0f * CAMBER_TRUNCATE(0.5f * inside);
    return sign * winding - CAMBER_LESS(inside, one);
}

/* The edges that turn the rows of samples of a row of pixels: where, px from the cell's left side, and how often. */
typedef struct camber_row_edges {
    camber_real at[CAMBER_OVERLAP_EDGES], turns[CAMBER_OVERLAP_EDGES];
    int count;
} camber_row_edges;

/* The same in vector v of a row. */
CAMBER_FN void camber_row_edges_of(const camber_piled_cell *o, int row, int v, camber_row_edges *s) {
    const camber_real y = camber_piled_cell_rows(o, row, v);
    const float left = (float)(CAMBER_CELL_PX * o->column);
    const float top = (float)(CAMBER_CELL_PX * o->row + row);
    s->count = 0;
    for (int k = 0; k < o->edge_count; k++) {
        const camber_tile_edge *e = o->edges + k;
        if (e->y1 < top || e->y0 > top + 1.0f)
            continue;
        s->at[s->count] = e->x0 + (y - e->y0) * e->slope - left;
        s->turns[s->count++] = camber_edge_turns(e, y);
    }
}

/* Adds to each pixel what its sum has too much in a vector of rows of samples. much: of the rows, for each column. */
CAMBER_FN void camber_add_too_much(const camber_row_edges *s, camber_real begin, float sign, camber_u32 mode,
                                   camber_real much[CAMBER_CELL_PX]) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f), from = camber_too_much(begin, sign, mode);
    for (int x = 0; x < CAMBER_CELL_PX; x++)
        much[x] = from;
    for (int k = 0; k < s->count; k++) {
        camber_real before = begin;
        for (int i = 0; i < s->count; i++)
            before += (i < k ? s->at[i] <= s->at[k] : s->at[i] < s->at[k]) ? s->turns[i] : none;
        const camber_real more =
            camber_too_much(before + s->turns[k], sign, mode) - camber_too_much(before, sign, mode);
        for (int x = 0; x < CAMBER_CELL_PX; x++) {
            camber_real right = (float)(x + 1) - s->at[k];
            right = CAMBER_MORE(right, none);
            much[x] += more * CAMBER_LESS(right, one);
        }
    }
}

/* Sums of sixteen rows of samples, in one order whatever the lanes. */
CAMBER_FN float camber_sum_of_rows(const camber_real *vectors) {
    const float *rows = (const float *)vectors;
    float sums[8];
    for (int i = 0; i < 8; i++)
        sums[i] = rows[i] + rows[i + 8];
    for (int left = 4; left > 0; left /= 2)
        for (int i = 0; i < left; i++)
            sums[i] += sums[i + left];
    return sums[0];
}

/* Takes what is too much from the sums of a row of a cell's pixels, which become what is inside. */
CAMBER_FN void camber_piled_cell_end(camber_tile_state *c, const camber_piled_cell *o, int row, float sign) {
    const int i = CAMBER_TILE_CELLS * o->row + o->column, first = CAMBER_CELL_PX * row;
    const float *sums = (const float *)c->sums[i][CAMBER_AREA_ON];
    float *inside = (float *)c->sums[i][CAMBER_AREA_HERE];
    camber_real much[CAMBER_VECTORS][CAMBER_CELL_PX], of_column[CAMBER_VECTORS];
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        camber_row_edges s;
        camber_row_edges_of(o, row, v, &s);
        camber_add_too_much(&s, o->begin[row][v], sign, c->now.mode, much[v]);
    }
    for (int x = 0; x < CAMBER_CELL_PX; x++) {
        int has_any = 0;
        for (int v = 0; v < CAMBER_VECTORS; v++) {
            of_column[v] = much[v][x];
            has_any |= CAMBER_ANY(much[v][x] != 0.0f);
        }
        const float left = has_any ? camber_sum_of_rows(of_column) * (1.0f / 16) : 0.0f;
        const float area = sign * sums[first + x] - left;
        inside[first + x] = area < CAMBER_AREA_LEAST ? 0.0f : area > 1.0f - CAMBER_AREA_LEAST ? 1.0f : area;
    }
}

/* Finds what is inside of the pixels of cells in which rings may overlap. Their sums are what camber_area_find_row
 * leaves. */
CAMBER_FN void camber_area_find_overlaps(camber_tile_state *c, camber_tile_rows where, const camber_area_edges *from,
                                         int winding, camber_u64 cells) {
    camber_placed_edges edges;
    camber_piled_cell o;
    if (!camber_place_edges(from, where, &edges))
        return;
    o.row = -1;
    for (; cells; cells &= cells - 1) {
        const int i = camber_lowest(cells);
        const float *sums = (const float *)c->sums[i][CAMBER_AREA_ON];
        float all = 0.0f;
        for (int k = 0; k < CAMBER_CELL_PX * CAMBER_CELL_PX; k++)
            all += sums[k];
        if (o.row != i / CAMBER_TILE_CELLS)
            camber_placed_in_row(&edges, i / CAMBER_TILE_CELLS);
        o.row = i / CAMBER_TILE_CELLS;
        o.column = i % CAMBER_TILE_CELLS;
        camber_piled_cell_of(&edges, winding, &o);
        for (int row = 0; row < CAMBER_CELL_PX && o.edge_count <= CAMBER_OVERLAP_EDGES; row++)
            camber_piled_cell_end(c, &o, row, all < 0.0f ? -1.0f : 1.0f);
    }
}

/* ---- The inside ---- */

/* The cells of a row, a bit each. */
typedef struct camber_area_row {
    camber_u32 found;    /* any of it lies inside */
    camber_u32 overlaps; /* rings may overlap there */
} camber_area_row;

/* Whether rings may overlap in a cell, by its sums and by the windings around its corners, of which these are the least
 * and the most. Where all of it lies inside by the rule that is not even-odd, that changes nothing. */
CAMBER_FN int camber_cell_overlaps(const camber_tile_state *c, int i, float least, float most) {
    int is_whole = c->now.mode != CAMBER_BRUSH_AREA_EVENODD && (most <= -1.0f || least >= 1.0f);
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        const camber_real sum = c->sums[i][CAMBER_AREA_ON][v];
        is_whole = is_whole && CAMBER_ALL(c->sums[i][CAMBER_AREA_HERE][v] >= 1.0f);
        least = CAMBER_ANY(sum < -1.0f - CAMBER_AREA_SLACK)             ? -2.0f
                : least >= 0.0f && CAMBER_ANY(sum < -CAMBER_AREA_SLACK) ? -1.0f
                                                                        : least;
        most = CAMBER_ANY(sum > 1.0f + CAMBER_AREA_SLACK)            ? 2.0f
               : most <= 0.0f && CAMBER_ANY(sum > CAMBER_AREA_SLACK) ? 1.0f
                                                                     : most;
    }
    return !is_whole && (least < -1.0f || most > 1.0f || most - least > 1.0f);
}

/* Finds the cells of a row in which rings may overlap. odd: some sums do not lie between 0 and -1. */
CAMBER_FN camber_u32 camber_area_find_overlap(const camber_tile_state *c, int row, int odd) {
    camber_u32 overlaps = 0;
    float top = (float)c->winding, bottom = top;
    for (int x = 0; x < CAMBER_TILE_CELLS; x++) {
        const int i = CAMBER_TILE_CELLS * row + x;
        const float *corners = (const float *)c->sums[i][CAMBER_AREA_CORNERS];
        top += corners[CAMBER_CORNERS_LEFT];
        bottom += corners[CAMBER_CORNERS_LEFT + 1];
        float least = CAMBER_LESS(top, bottom), most = CAMBER_MORE(top, bottom);
        top += corners[CAMBER_CORNERS_HERE];
        bottom += corners[CAMBER_CORNERS_HERE + 1];
        least = CAMBER_LESS(least, CAMBER_LESS(top, bottom));
        most = CAMBER_MORE(most, CAMBER_MORE(top, bottom));
        if ((odd || least < -1.0f || most > 0.0f) && camber_cell_overlaps(c, i, least, most))
            overlaps |= 1u << x;
    }
    return overlaps;
}

/* Adds up what the edges of a row of cells change, from left to right: the sums become what is inside of the pixels,
 * and what was added up. */
CAMBER_FN void camber_area_find_row(camber_tile_state *c, int row, camber_area_row *r) {
    camber_mask beyond = CAMBER_ALL_LANES(0);
    int odd = 0;
    r->found = 0;
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        camber_real sum = CAMBER_REAL((float)c->winding);
        for (int x = 0; x < CAMBER_TILE_CELLS; x++) {
            const int i = CAMBER_TILE_CELLS * row + x;
            sum += c->sums[i][CAMBER_AREA_ON][v];
            const camber_real here = sum + c->sums[i][CAMBER_AREA_HERE][v];
            const camber_real inside = camber_area_inside(here, c->now.mode);
            c->sums[i][CAMBER_AREA_HERE][v] = inside;
            c->sums[i][CAMBER_AREA_ON][v] = here;
            beyond |= (here > CAMBER_AREA_SLACK) | (here < -1.0f - CAMBER_AREA_SLACK);
            r->found |= CAMBER_ANY(inside > 0.0f) ? 1u << x : 0u;
        }
        odd |= CAMBER_ANY(beyond);
    }
    r->overlaps = camber_area_find_overlap(c, row, odd);
}

/* Finds the cells that have something inside of the brush's rings, and ends the rings. The sums of those that it
 * returns are the areas of their pixels then; those of *whole lie inside as a whole. */
CAMBER_FN camber_u64 camber_area_find(camber_tile_state *c, camber_tile_rows where, const camber_area_edges *from,
                                      camber_u64 *whole) {
    const int is_inside = camber_most_of(camber_area_inside(CAMBER_REAL((float)c->winding), c->now.mode)) > 0.0f;
    camber_u64 found = 0, overlaps = 0;
    *whole = 0;
    for (int row = where.first; row <= where.last; row++) {
        const camber_u64 cells = (camber_u64)255 << (CAMBER_TILE_CELLS * row);
        if (c->edged & cells) {
            camber_area_row r;
            camber_area_find_row(c, row, &r);
            found |= (camber_u64)r.found << (CAMBER_TILE_CELLS * row);
            overlaps |= (camber_u64)r.overlaps << (CAMBER_TILE_CELLS * row);
        } else if (is_inside) {
            *whole |= cells;
        }
    }
    *whole &= ~(c->done | c->filled);
    overlaps &= ~(c->done | c->filled);
    if (overlaps)
        camber_area_find_overlaps(c, where, from, c->winding, overlaps);
    c->edged = 0;
    c->winding = 0;
    return (found | overlaps) & ~(c->done | c->filled);
}

/* Draws what the brush's rings have inside, before the brush is closed. */
CAMBER_FN void camber_area_draw(camber_tile_state *c, camber_tile_rows where, const camber_area_edges *from) {
    camber_u64 whole;
    const camber_u64 cells = camber_area_find(c, where, from, &whole);
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
