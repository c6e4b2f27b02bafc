/* Polygons: computes how much of each pixel is inside a brush's rings, from the changes that their edges make in a tile
 * (area.h).
 *
 * Main idea: if the winding numbers in a pixel are only 0 and 1, their sum is exactly the area inside. If polygons of
 * one fill overlap or cross, a winding number of 2 must count as 1, which a sum hides. Cells with such pixels are found
 * by their sums and by the winding numbers at their corners; there are few. The edges that reach into such a cell cut
 * rows of samples at exact positions. The excess winding between them is subtracted from the sum:
 *
 *      once  twice  once
 *     ----+-------+-------    a row of samples: between the edges the sum is 2, which is 1 too much
 *         e1      e2
 *
 * So a pixel without such winding numbers keeps its sum. Here a lane is a row of samples. */
#ifndef CAMBER_KERNELS_AREA_INSIDE_H
#define CAMBER_KERNELS_AREA_INSIDE_H

#include "area.h"

/* Sums that are off by less than this belong to polygons that do not overlap. */
#define CAMBER_AREA_SLACK (CAMBER_AREA_ONE / 1024)
/* An area below this counts as 0, and an area that is less than this short of a whole pixel counts as the whole pixel.
 */
#define CAMBER_AREA_LEAST 1e-5f

/* Returns how much of each pixel is inside, given the sum of its winding numbers. */
CAMBER_FN camber_mask camber_area_inside(camber_mask sum, camber_u32 mode) {
    const camber_mask one = (camber_mask)(CAMBER_AREA_ONE);
    const camber_mask inside = sum < 0 ? -sum : sum, rest = inside & (2 * CAMBER_AREA_ONE - 1);
    if (mode == CAMBER_BRUSH_AREA_EVENODD)
        return rest > one ? 2 * one - rest : rest;
    return CAMBER_LESS(inside, one);
}

/* Whether a point with this winding number is inside. */
CAMBER_FN int camber_winding_is_inside(int winding, camber_u32 mode) {
    return mode == CAMBER_BRUSH_AREA_EVENODD ? winding & 1 : winding != 0;
}

/* ---- Overlaps ---- */

/* An edge in a cell: its line, and the heights between which it changes the winding of rows of samples. */
typedef struct camber_cell_edge {
    float x, y, slope, from, to, down;
} camber_cell_edge;

/* A cell in which rings may overlap: the winding numbers at which its rows of samples begin, and its edges. */
typedef struct camber_piled_cell {
    int row, column, edge_count;
    camber_real begin[CAMBER_CELL_PX][CAMBER_VECTORS]; /* for each row of pixels */
    camber_cell_edge edges[CAMBER_OVERLAP_EDGES];
} camber_piled_cell;

/* Returns the positions of the sixteen rows of samples of a row of pixels, in px from the tile's top. */
CAMBER_FN camber_real camber_piled_cell_rows(const camber_piled_cell *o, int row, int v) {
    return (float)(CAMBER_CELL_PX * o->row) + (camber_numbers(v) + ((float)(16 * row) + 0.5f)) * (1.0f / 16);
}

/* From y on, raises the winding number at which rows of samples begin. */
CAMBER_FN void camber_piled_cell_turn(camber_piled_cell *o, float y, float times) {
    for (int row = 0; row < CAMBER_CELL_PX; row++)
        for (int v = 0; v < CAMBER_VECTORS; v++)
            o->begin[row][v] += camber_piled_cell_rows(o, row, v) > y ? CAMBER_REAL(times) : CAMBER_REAL(0.0f);
}

/* Adds an edge to a cell. The part of it that is left of the cell is cut off, as at the tile's own left side. A flat
 * edge changes no row of samples, but below it rows may begin with another winding number. */
CAMBER_FN void camber_piled_cell_add(camber_piled_cell *o, const camber_tile_edge *e) {
    const float top = (float)(CAMBER_CELL_PX * o->row), left = (float)(CAMBER_CELL_PX * o->column);
    if (camber_tile_edge_is_flat(e)) {
        if (o->column > 0 && (e->x0 < left) != (e->slope < left))
            camber_piled_cell_turn(o, e->y0, (float)-e->down);
        return;
    }
    const float down = (float)e->down, y0 = CAMBER_MORE(e->y0, top), y1 = CAMBER_LESS(e->y1, top + CAMBER_CELL_PX);
    camber_cell_edge *to = o->edges + o->edge_count++;
    *to = (camber_cell_edge){e->x0 - left, e->y0, e->slope, e->y0, e->y1, down};
    if (o->column == 0)
        return;
    const float x0 = camber_edge_at(e, y0), x1 = camber_edge_at(e, y1);
    if ((x0 < left) == (x1 < left))
        return;
    const float at = e->y0 + (left - e->x0) / e->slope, y = at < y0 ? y0 : at > y1 ? y1 : at;
    camber_piled_cell_turn(o, y, x0 < left ? -down : down);
    to->from = x0 < left ? y : to->from;
    to->to = x0 < left ? to->to : y;
}

/* Begins a cell without edges. winding: the winding number at its upper left corner. */
CAMBER_FN void camber_piled_cell_begin(camber_piled_cell *o, int winding) {
    o->edge_count = 0;
    for (int row = 0; row < CAMBER_CELL_PX; row++)
        for (int v = 0; v < CAMBER_VECTORS; v++)
            o->begin[row][v] = CAMBER_REAL((float)winding);
}

/* Adds an edge that a tile has kept to a cell that it passes. way: the last of its words. */
CAMBER_FN void camber_piled_cell_place(camber_piled_cell *o, const camber_tile_edge *e, float way) {
    const float top = (float)(CAMBER_CELL_PX * o->row);
    camber_piled_cell_add(o, e);
    if (o->column == 0 && CAMBER_FABS(way) == CAMBER_PLACED_ENTERS && e->y0 > top)
        camber_piled_cell_turn(o, e->y0, (float)-e->down);
    if (o->column == 0 && CAMBER_FABS(way) == CAMBER_PLACED_LEAVES && e->y1 > top)
        camber_piled_cell_turn(o, e->y1, (float)e->down);
}

/* Returns by how much a winding number, times its sign in this cell, exceeds its value by the fill rule, 0 to 1. */
CAMBER_FN camber_real camber_too_much(camber_real winding, float sign, camber_u32 mode) {
    const camber_real one = CAMBER_REAL(1.0f);
    camber_real inside = CAMBER_FABS(winding);
    if (mode == CAMBER_BRUSH_AREA_EVENODD)
        inside -= 2.0f * CAMBER_TRUNCATE(0.5f * inside);
    return sign * winding - CAMBER_LESS(inside, one);
}

/* The edges that change the winding in the rows of samples of a row of pixels: where, in px from the cell's left side,
 * and by how much. */
typedef struct camber_row_edges {
    camber_real at[CAMBER_OVERLAP_EDGES], turns[CAMBER_OVERLAP_EDGES];
    int count;
} camber_row_edges;

/* Finds these edges for vector v of a row of pixels. */
CAMBER_FN void camber_row_edges_of(const camber_piled_cell *o, int row, int v, camber_row_edges *s) {
    const camber_real y = camber_piled_cell_rows(o, row, v), none = CAMBER_REAL(0.0f);
    const float top = (float)(CAMBER_CELL_PX * o->row + row);
    s->count = 0;
    for (int k = 0; k < o->edge_count; k++) {
        const camber_cell_edge *e = o->edges + k;
        if (e->to < top || e->from > top + 1.0f)
            continue;
        s->at[s->count] = e->x + (y - e->y) * e->slope;
        s->turns[s->count++] = ((y > e->from) & (y <= e->to)) ? CAMBER_REAL(e->down) : none;
    }
}

/* Adds to each pixel the excess of its sum in a vector of rows of samples. much: the excess of the rows, for each
 * column. */
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

/* Subtracts the excess from the sums of a row of pixels, which then become the areas inside. */
CAMBER_FN void camber_piled_cell_end(const camber_piled_cell *o, int row, float sign, camber_u32 mode,
                                     const float sums[CAMBER_CELL_PX], float inside[CAMBER_CELL_PX]) {
    camber_real much[CAMBER_VECTORS][CAMBER_CELL_PX], of_column[CAMBER_VECTORS];
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        camber_row_edges s;
        camber_row_edges_of(o, row, v, &s);
        camber_add_too_much(&s, o->begin[row][v], sign, mode, much[v]);
    }
    for (int x = 0; x < CAMBER_CELL_PX; x++) {
        for (int v = 0; v < CAMBER_VECTORS; v++)
            of_column[v] = much[v][x];
        const float area = sign * sums[x] - camber_sum_of_sixteen(of_column) * (1.0f / 16);
        inside[x] = area < CAMBER_AREA_LEAST ? 0.0f : area > 1.0f - CAMBER_AREA_LEAST ? 1.0f : area;
    }
}

/* ---- The inside ---- */

/* Cells of a tile, one bit each: those that are completely inside, and those that may be partly inside. */
typedef struct camber_area_cells {
    camber_u64 whole, partial;
} camber_area_cells;

/* The least and the greatest winding number at the corners of a cell. */
typedef struct camber_corners {
    int least, most;
} camber_corners;

/* Bounds that the sums of a cell's pixels exceed, one bit each. */
#define CAMBER_SUM_BELOW 1u     /* 0 */
#define CAMBER_SUM_FAR_BELOW 2u /* -1 */
#define CAMBER_SUM_ABOVE 4u     /* 0 */
#define CAMBER_SUM_FAR_ABOVE 8u /* 1 */

CAMBER_FN camber_u32 camber_sums_exceed(const camber_mask *sums, int vectors) {
    const int one = CAMBER_AREA_ONE, slack = CAMBER_AREA_SLACK;
    camber_u32 found = 0;
    for (int v = 0; v < vectors; v++) {
        if (CAMBER_ANY(sums[v] < -slack))
            found |= CAMBER_ANY(sums[v] < -one - slack) ? CAMBER_SUM_BELOW | CAMBER_SUM_FAR_BELOW : CAMBER_SUM_BELOW;
        if (CAMBER_ANY(sums[v] > slack))
            found |= CAMBER_ANY(sums[v] > one + slack) ? CAMBER_SUM_ABOVE | CAMBER_SUM_FAR_ABOVE : CAMBER_SUM_ABOVE;
    }
    return found;
}

/* Whether overlaps do not matter in a cell, because all of it is inside by the nonzero rule. */
CAMBER_FN int camber_cell_is_simple(camber_corners of, camber_u32 mode, int is_whole) {
    return is_whole && mode != CAMBER_BRUSH_AREA_EVENODD && (of.most <= -1 || of.least >= 1);
}

/* Whether rings may overlap in a cell that is not simple, given what its sums exceed and its corners. */
CAMBER_FN int camber_cell_overlaps(camber_u32 sums, camber_corners of) {
    if (sums & CAMBER_SUM_BELOW)
        of.least = sums & CAMBER_SUM_FAR_BELOW ? -2 : CAMBER_LESS(of.least, -1);
    if (sums & CAMBER_SUM_ABOVE)
        of.most = sums & CAMBER_SUM_FAR_ABOVE ? 2 : CAMBER_MORE(of.most, 1);
    return of.least < -1 || of.most > 1 || of.most - of.least > 1;
}

/* Draws the inside of the brush's rings in cells that have been found. */
CAMBER_FN void camber_area_put(camber_tile_state *c, camber_area_cells found) {
    camber_tile_take_cells(c, found.partial | found.whole);
    for (; found.partial; found.partial &= found.partial - 1) {
        const int i = CAMBER_LOWEST_CELL(found.partial);
        for (int v = 0; v < CAMBER_OWN_VECTORS; v++)
            camber_tile_put_over(c, i, v, c->sums[i][CAMBER_AREA_INSIDE][v]);
    }
    for (; found.whole; found.whole &= found.whole - 1)
        camber_tile_put_whole(c, CAMBER_LOWEST_CELL(found.whole));
}

#if !CAMBER_SHARES_TILE

/* ---- Tiles of one work-item, which keep their edges ---- */

CAMBER_FN camber_placed_edges camber_kept_edges(const camber_area_state *s, int k) {
    camber_placed_edges e;
    for (int i = 0; i < CAMBER_PLACED_WORDS; i++)
        e.words[i] = CAMBER_LOAD(0, s->placed[i] + k);
    return e;
}

/* The edges that pass the cells of one row. counts: more than CAMBER_OVERLAP_EDGES if not all edges are listed here. */
typedef struct camber_row_lists {
    int counts[CAMBER_TILE_CELLS];
    camber_u16 edges[CAMBER_TILE_CELLS][CAMBER_OVERLAP_EDGES];
} camber_row_lists;

/* Lists the edges of the given cells of a row, which are one bit each. */
CAMBER_FN void camber_list_row(const camber_area_state *s, int row, camber_u32 cells, camber_row_lists *lists) {
    for (int x = 0; x < CAMBER_TILE_CELLS; x++)
        lists->counts[x] = 0;
    for (int from = 0; from < s->kept_count; from += CAMBER_LANES) {
        const camber_placed_edges e = camber_kept_edges(s, from);
        const camber_mask wanted = camber_numbers(0) < (float)(s->kept_count - from);
        const camber_words passed = camber_passed_columns(&e, wanted, row) & cells;
        for (camber_u32 left = camber_lanes_set(passed != 0u); left; left &= left - 1u) {
            const int k = camber_lowest(left);
            for (camber_u32 columns = ((const camber_u32 *)&passed)[k]; columns; columns &= columns - 1u) {
                const int x = camber_lowest(columns);
                if (lists->counts[x] < CAMBER_OVERLAP_EDGES)
                    lists->edges[x][lists->counts[x]] = (camber_u16)(from + k);
                lists->counts[x]++;
            }
        }
    }
}

/* Finds the edges of a cell. winding: the winding number at its upper left corner. */
CAMBER_FN void camber_piled_cell_of(const camber_area_state *s, const camber_row_lists *lists, int winding,
                                    camber_piled_cell *o) {
    camber_piled_cell_begin(o, winding);
    for (int k = 0; k < lists->counts[o->column]; k++) {
        const int i = lists->edges[o->column][k];
        const float way = s->placed[4][i];
        const camber_tile_edge e = {s->placed[0][i], s->placed[1][i], s->placed[2][i], s->placed[3][i],
                                    way > 0.0f ? 1 : -1};
        camber_piled_cell_place(o, &e, way);
    }
}

/* Computes the areas inside for the pixels of those cells of a row in which rings may overlap. Their sums must have
 * been computed. */
CAMBER_FN void camber_area_find_overlaps(camber_tile_state *c, int row, camber_u32 cells) {
    const camber_area_state *s = &c->area;
    camber_row_lists lists;
    camber_piled_cell o;
    int winding = c->winding;
    if (s->placed_count > CAMBER_PLACED_MOST)
        return;
    camber_list_row(s, row, cells, &lists);
    o.row = row;
    for (o.column = 0; o.column < CAMBER_TILE_CELLS; o.column++) {
        float all = 0.0f;
        winding += s->turns[row][o.column];
        if (!(cells >> o.column & 1u) || lists.counts[o.column] > CAMBER_OVERLAP_EDGES)
            continue;
        const int i = CAMBER_TILE_CELLS * row + o.column;
        const float *sums = (const float *)c->sums[i][CAMBER_AREA_SUM];
        float *inside = (float *)c->sums[i][CAMBER_AREA_INSIDE];
        for (int k = 0; k < CAMBER_CELL_PX * CAMBER_CELL_PX; k++)
            all += sums[k];
        camber_piled_cell_of(s, &lists, winding, &o);
        for (int y = 0; y < CAMBER_CELL_PX; y++)
            camber_piled_cell_end(&o, y, all < 0.0f ? -1.0f : 1.0f, c->now.mode, sums + CAMBER_CELL_PX * y,
                                  inside + CAMBER_CELL_PX * y);
    }
}

/* Computes the areas inside for a cell that edges pass. sums: the sums of its pixels' winding numbers. Returns whether
 * rings may overlap in the cell. */
CAMBER_FN int camber_area_find_cell(camber_tile_state *c, int i, const camber_mask *sums, camber_corners of,
                                    camber_area_cells *found) {
    const float part = 1.0f / CAMBER_AREA_ONE;
    int is_whole = 1, is_empty = 1;
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        const camber_mask inside = camber_area_inside(sums[v], c->now.mode);
        c->sums[i][CAMBER_AREA_INSIDE][v] = part * CAMBER_TO_REAL(inside);
        is_whole = is_whole && CAMBER_ALL(inside >= CAMBER_AREA_ONE);
        is_empty = is_empty && !CAMBER_ANY(inside > 0);
    }
    if (!camber_cell_is_simple(of, c->now.mode, is_whole) &&
        camber_cell_overlaps(camber_sums_exceed(sums, CAMBER_VECTORS), of)) {
        for (int v = 0; v < CAMBER_VECTORS; v++)
            c->sums[i][CAMBER_AREA_SUM][v] = part * CAMBER_TO_REAL(sums[v]);
        found->partial |= (camber_u64)1 << i;
        return 1;
    }
    found->whole |= is_whole ? (camber_u64)1 << i : 0;
    found->partial |= is_whole || is_empty ? 0 : (camber_u64)1 << i;
    return 0;
}

/* Adds up the changes by the edges of a row of cells, from left to right, and computes the areas inside. A cell that no
 * edge passes is completely inside or outside, like any of its pixels. */
CAMBER_FN void camber_area_find_row(camber_tile_state *c, int row, camber_u64 hidden, camber_area_cells *found) {
    const int *turns_above = c->area.turns[row], *turns_below = c->area.turns[row + 1];
    int top = c->winding + turns_above[0], bottom = c->winding + turns_below[0];
    camber_corners left = {CAMBER_LESS(top, bottom), CAMBER_MORE(top, bottom)};
    camber_words on[CAMBER_VECTORS];
    camber_mask sums[CAMBER_VECTORS];
    camber_u32 overlaps = 0;
    for (int v = 0; v < CAMBER_VECTORS; v++)
        on[v] = CAMBER_WORD((camber_u32)top * CAMBER_AREA_ONE);
    for (int x = 0; x < CAMBER_TILE_CELLS; x++) {
        const int i = CAMBER_TILE_CELLS * row + x;
        top += turns_above[x + 1];
        bottom += turns_below[x + 1];
        const camber_corners right = {CAMBER_LESS(top, bottom), CAMBER_MORE(top, bottom)};
        const camber_corners of = {CAMBER_LESS(left.least, right.least), CAMBER_MORE(left.most, right.most)};
        left = right;
        for (int v = 0; v < CAMBER_VECTORS; v++) {
            const camber_words *changes = &c->area.changes[row][x][0][0];
            on[v] += changes[CAMBER_VECTORS * CAMBER_AREA_ON + v];
            sums[v] = CAMBER_AS_INTEGERS(on[v] + changes[CAMBER_VECTORS * CAMBER_AREA_HERE + v]);
        }
        if (hidden >> i & 1)
            continue;
        if (c->area.edged >> i & 1)
            overlaps |= camber_area_find_cell(c, i, sums, of, found) ? 1u << x : 0u;
        else if (camber_winding_is_inside((camber_integer_of(sums, 0) + CAMBER_AREA_ONE / 2) >> 16, c->now.mode))
            found->whole |= (camber_u64)1 << i;
    }
    if (overlaps)
        camber_area_find_overlaps(c, row, overlaps);
}

/* Finds the cells that have something inside the brush's rings, and ends the rings. For cells that may be partly
 * inside, c->sums then has the areas inside. A row of cells that no edge passes is completely inside or outside. */
CAMBER_FN void camber_area_find(camber_tile_state *c, camber_tile_rows where, camber_area_cells *found) {
    const camber_u64 hidden = c->done | c->filled, edged = c->area.has_edges ? c->area.edged : 0;
    found->whole = found->partial = 0;
    for (int row = where.first; row <= where.last; row++) {
        const int winding = c->winding + (c->area.has_edges ? c->area.turns[row][0] : 0);
        if (edged >> (CAMBER_TILE_CELLS * row) & 255)
            camber_area_find_row(c, row, hidden, found);
        else if (camber_winding_is_inside(winding, c->now.mode))
            found->whole |= (camber_u64)255 << (CAMBER_TILE_CELLS * row) & ~hidden;
    }
    c->area.has_edges = 0;
    c->winding = 0;
}

#else

/* The same for a cell that shares its tile, and a brush that has no edges in it. */
CAMBER_FN void camber_area_find(camber_tile_state *c, camber_tile_rows where, camber_area_cells *found) {
    (void)where;
    found->partial = 0;
    found->whole = camber_winding_is_inside(c->winding, c->now.mode) ? 1u & ~(c->done | c->filled) : 0;
    c->winding = 0;
}

#endif

#endif
