/* Polygons in a tile that work-items share: each adds other edges to the winding changes, which are in local memory,
 * and then finds how much of each of its own four pixels is inside. The results are those of camber_area_find, to the
 * bit.
 *
 * For a cell in which polygons overlap, a CPU looks at the edges that the tile has kept. There is no room for them
 * here, so a work-item reads the brush's entries of the list again; there are few such cells. */
#ifndef CAMBER_AREA_GPU_CL
#define CAMBER_AREA_GPU_CL

#include "draw_cells.h"

typedef char camber_area_state_has_its_words[sizeof(camber_area_state) == 4u * CAMBER_SHARED_CHANGES_WORDS ? 1 : -1];

/* A brush whose edges work-items add: they share this. */
typedef struct shared_edges {
    camber_area_state changes;
    camber_u32 cells[CAMBER_CELLS]; /* camber_sums_exceed of each cell's pixels, and SUM_NOT_WHOLE */
} shared_edges;
#define SUM_NOT_WHOLE 16u /* a pixel that is not inside completely */

/* The brush whose edges are being added, and where these are. */
typedef struct edge_run {
    camber_u32 brush;               /* CAMBER_NO_EDGE: none */
    global const camber_u32 *lists; /* entries [first, end) of the lists */
    camber_u32 first, end;
    global const float *kept; /* edges of earlier slices, kept_count of them */
    camber_u32 kept_count;
} edge_run;

/* Begins a brush without edges. Barriers must be before and after it. */
CAMBER_FN CAMBER_INLINE void begin_edges(local shared_edges *s, camber_u32 item) {
    local camber_u32 *words = (local camber_u32 *)&s->changes;
    for (camber_u32 i = item; i < CAMBER_SHARED_CHANGES_WORDS; i += CAMBER_TILE_ITEMS)
        words[i] = 0;
    if (item < CAMBER_CELLS)
        s->cells[item] = 0;
}

/* The edges of an entry: of a bunch, those that have the brush and touch the tile. */
typedef struct entry_edges {
    size_t next, end;
    camber_u32 brush; /* CAMBER_NO_EDGE: all */
} entry_edges;

static inline entry_edges edges_of_entry(camber_u32 entry, camber_u32 brush) {
    const size_t which = camber_listed(entry), sixteen = which / 16u * 16u;
    const int is_bunch = (entry & CAMBER_LISTED_BUNCH) != 0u;
    const entry_edges edges = {which, is_bunch ? sixteen + 16u : which + 1u, is_bunch ? brush : CAMBER_NO_EDGE};
    return edges;
}

/* Takes the next edge of an entry. Returns whether there was one. */
CAMBER_NOINLINE int take_edge(const camber_drawn_tile *d, entry_edges *from, camber_ring_edges *e) {
    while (from->next < from->end) {
        const size_t which = from->next++;
        global const float *ends = d->from.edges + camber_edge_ends(which);
        if (from->brush != CAMBER_NO_EDGE && (as_uint(d->from.edges[camber_edge_brush(which)]) != from->brush ||
                                              !camber_boxes_touch_tile(ends[0], ends[1], ends[2], ends[3], d->where)))
            continue;
        camber_ring_edges_of(ends[0], ends[1], ends[2], ends[3], e);
        return 1;
    }
    return 0;
}

/* Adds the edges of an entry to the changes. */
CAMBER_FN CAMBER_INLINE void add_edges(local shared_edges *s, const camber_drawn_tile *d, camber_u32 entry,
                                       camber_u32 brush) {
    entry_edges from = edges_of_entry(entry, brush);
    camber_ring_edges e;
    while (take_edge(d, &from, &e))
        camber_area_add(&s->changes, &e, 1, d->where);
}

/* ---- Overlaps ---- */

/* Adds an edge to a cell if it passes it. Returns how many edges have passed the cell. */
static inline int pile_edge(const camber_placed_edges *placed, int passed, camber_piled_cell *o) {
    const float way = placed->words[4];
    const camber_tile_edge e = {placed->words[0], placed->words[1], placed->words[2], placed->words[3],
                                way > 0.0f ? 1 : -1};
    if (!(camber_passed_columns(placed, 1, o->row) >> o->column & 1u))
        return passed;
    if (passed < CAMBER_OVERLAP_EDGES)
        camber_piled_cell_place(o, &e, way);
    return passed + 1;
}

/* Takes the next edge of an entry that changes anything in the tile, as a tile keeps it. */
CAMBER_NOINLINE int take_placed(const camber_drawn_tile *d, entry_edges *from, camber_placed_edges *placed) {
    camber_ring_edges e;
    while (take_edge(d, from, &e)) {
        camber_tile_edges t;
        camber_tiny_edges tiny;
        camber_area_cut(&e, 1, d->where, &t, &tiny);
        *placed = camber_placed_edges_of(&t);
        if (t.matters)
            return 1;
    }
    return 0;
}

/* Finds all edges of a cell, in their order. Returns whether it has room for them. */
static inline int pile_edges(const camber_drawn_tile *d, const edge_run *run, camber_piled_cell *o) {
    int passed = 0;
    for (camber_u32 k = 0; k < run->kept_count; k++) {
        camber_placed_edges placed;
        for (camber_u32 i = 0; i < CAMBER_PLACED_WORDS; i++)
            placed.words[i] = run->kept[CAMBER_PLACED_WORDS * k + i];
        passed = pile_edge(&placed, passed, o);
    }
    for (camber_u32 k = run->end; k-- > run->first;) {
        entry_edges from = edges_of_entry(run->lists[k], run->brush);
        camber_placed_edges placed;
        while (take_placed(d, &from, &placed))
            passed = pile_edge(&placed, passed, o);
    }
    return passed <= CAMBER_OVERLAP_EDGES;
}

/* Computes the areas inside for a row of the pixels of a cell in which rings may overlap. sums: those of all pixels. */
CAMBER_NOINLINE void find_piled(const camber_drawn_tile *d, const edge_run *run, camber_piled_cell *o, camber_u32 mode,
                                const float *sums, int row, float *inside) {
    float all = 0.0f;
    if (!pile_edges(d, run, o))
        return;
    for (int k = 0; k < CAMBER_CELL_PX * CAMBER_CELL_PX; k++)
        all += sums[k];
    camber_piled_cell_end(o, row, all < 0.0f ? -1.0f : 1.0f, mode, sums + CAMBER_CELL_PX * row, inside);
}

/* ---- The inside ---- */

/* A cell in a tile, and the row of its pixels that a work-item draws. */
typedef struct own_row {
    int cell_row, cell_column, row;
} own_row;

/* Returns the sum of the winding numbers of a pixel of a cell, as camber_area_find_row adds it up. */
CAMBER_FN CAMBER_INLINE camber_mask sum_of_pixel(local const camber_area_state *s, int winding, int row, int column,
                                                 int pixel) {
    camber_u32 sum = (camber_u32)(winding + s->turns[row][0]) * CAMBER_AREA_ONE;
    for (int x = 0; x <= column; x++)
        sum += s->changes[row][x][CAMBER_AREA_ON][pixel];
    return (camber_mask)(sum + s->changes[row][column][CAMBER_AREA_HERE][pixel]);
}

/* Finds the least and the greatest winding number at the corners of a cell. */
CAMBER_FN CAMBER_INLINE void find_corners(local const camber_area_state *s, int winding, int row, int column,
                                          camber_corners *of) {
    int top = winding, bottom = winding;
    for (int x = 0; x <= column; x++) {
        top += s->turns[row][x];
        bottom += s->turns[row + 1][x];
    }
    const int right_top = top + s->turns[row][column + 1], right_bottom = bottom + s->turns[row + 1][column + 1];
    of->least = min(min(top, bottom), min(right_top, right_bottom));
    of->most = max(max(top, bottom), max(right_top, right_bottom));
}

/* Returns whether an edge passes a cell, or any cell of its row. */
CAMBER_FN CAMBER_INLINE int is_edged(local const camber_area_state *s, int row, int column) {
    return (int)(s->edged >> (CAMBER_TILE_CELLS * row + column) & 1ul);
}

CAMBER_FN CAMBER_INLINE int row_is_edged(local const camber_area_state *s, int row) {
    return (s->edged >> (CAMBER_TILE_CELLS * row) & 255ul) != 0ul;
}

/* Computes how much of a work-item's pixels is inside if their cell does not overlap, and tells the others of the cell
 * what that depends on. A barrier must follow. */
CAMBER_FN CAMBER_INLINE void find_own(camber_tile_state *c, local shared_edges *s, own_row own) {
    local const camber_area_state *changes = &s->changes;
    const int row = own.cell_row, column = own.cell_column;
    camber_mask sums[CAMBER_CELL_PX];
    int is_whole = 1;
    if (!is_edged(changes, row, column))
        return;
    for (int i = 0; i < CAMBER_CELL_PX; i++) {
        sums[i] = sum_of_pixel(changes, c->winding, row, column, CAMBER_CELL_PX * own.row + i);
        const camber_mask inside = camber_area_inside(sums[i], c->now.mode);
        c->sums[0][CAMBER_AREA_INSIDE][i] = 1.0f / CAMBER_AREA_ONE * (float)inside;
        is_whole = is_whole && inside >= CAMBER_AREA_ONE;
    }
    atomic_or(&s->cells[CAMBER_TILE_CELLS * row + column],
              camber_sums_exceed(sums, CAMBER_CELL_PX) | (is_whole ? 0u : SUM_NOT_WHOLE));
}

/* Whether rings may overlap in a cell that edges pass. */
CAMBER_FN CAMBER_INLINE int is_piled(const camber_tile_state *c, local const shared_edges *s, own_row own) {
    const camber_u32 sums = s->cells[CAMBER_TILE_CELLS * own.cell_row + own.cell_column];
    camber_corners of;
    find_corners(&s->changes, c->winding, own.cell_row, own.cell_column, &of);
    return !camber_cell_is_simple(of, c->now.mode, !(sums & SUM_NOT_WHOLE)) &&
           camber_cell_overlaps(sums & ~SUM_NOT_WHOLE, of);
}

/* Computes the areas inside again for a cell in which rings may overlap. */
CAMBER_FN CAMBER_INLINE void find_overlaps(camber_tile_state *c, const camber_drawn_tile *d,
                                           local const shared_edges *s, const edge_run *run, own_row own) {
    local const camber_area_state *changes = &s->changes;
    float sums[CAMBER_CELL_PX * CAMBER_CELL_PX], inside[CAMBER_CELL_PX];
    camber_piled_cell o;
    int winding = c->winding;
    if (changes->placed_count > CAMBER_PLACED_MOST)
        return;
    for (int x = 0; x <= own.cell_column; x++)
        winding += changes->turns[own.cell_row][x];
    for (int i = 0; i < CAMBER_CELL_PX * CAMBER_CELL_PX; i++)
        sums[i] = 1.0f / CAMBER_AREA_ONE * (float)sum_of_pixel(changes, c->winding, own.cell_row, own.cell_column, i);
    for (int i = 0; i < CAMBER_CELL_PX; i++)
        inside[i] = c->sums[0][CAMBER_AREA_INSIDE][i];
    o.row = own.cell_row;
    o.column = own.cell_column;
    camber_piled_cell_begin(&o, winding);
    find_piled(d, run, &o, c->now.mode, sums, own.row, inside);
    for (int i = 0; i < CAMBER_CELL_PX; i++)
        c->sums[0][CAMBER_AREA_INSIDE][i] = inside[i];
}

/* Draws what is inside a work-item's pixels, and ends the rings. find_own and a barrier must be before it. */
CAMBER_FN CAMBER_INLINE void draw_inside(camber_tile_state *c, const camber_drawn_tile *d, local const shared_edges *s,
                                         const edge_run *run, own_row own) {
    local const camber_area_state *changes = &s->changes;
    const int row = own.cell_row, column = own.cell_column, is_hidden = (int)((c->done | c->filled) & 1ul);
    camber_area_cells found = {0, 0};
    if (!is_hidden && is_edged(changes, row, column)) {
        int full = 0, empty = 0;
        if (is_piled(c, s, own))
            find_overlaps(c, d, s, run, own);
        for (int i = 0; i < CAMBER_CELL_PX; i++) {
            full += c->sums[0][CAMBER_AREA_INSIDE][i] == 1.0f;
            empty += c->sums[0][CAMBER_AREA_INSIDE][i] == 0.0f;
        }
        found.whole = full == CAMBER_CELL_PX;
        found.partial = full != CAMBER_CELL_PX && empty != CAMBER_CELL_PX;
    } else if (!is_hidden) {
        const int winding = row_is_edged(changes, row)
                                ? (sum_of_pixel(changes, c->winding, row, column, 0) + CAMBER_AREA_ONE / 2) >> 16
                                : c->winding + changes->turns[row][0];
        found.whole = camber_winding_is_inside(winding, c->now.mode) ? 1 : 0;
    }
    c->winding = 0;
    camber_draw_found(c, d, found);
}

#endif
