/* Finds the cells of a tile that a segment touches, and draws a single segment of a union into them. */
#ifndef CAMBER_RASTERIZE_CELLS_CL
#define CAMBER_RASTERIZE_CELLS_CL

#include "tile_state.cl"

#if CAMBER_LANES == 16
/* Positions in the picture, px: of the pixels of a cell, and of the middles of 4 x 4 cells, by the column or row of the
 * (first) cell. */
typedef struct positions {
    float16 x[CAMBER_TILE_CELLS], y[CAMBER_TILE_CELLS];
    float16 middle_x[CAMBER_TILE_CELLS], middle_y[CAMBER_TILE_CELLS];
} positions;

constant float ACROSS[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
constant float DOWN[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

static inline void begin_positions(private positions *at, float left, float top) {
    const float16 across = vload16(0, ACROSS), down = vload16(0, DOWN);
    for (int i = 0; i < CAMBER_TILE_CELLS; i++) {
        const float from = (float)(CAMBER_CELL_PX * i), middle = 0.5f * CAMBER_CELL_PX;
        at->x[i] = left + from + 0.5f + across;
        at->y[i] = top + from + 0.5f + down;
        at->middle_x[i] = left + from + middle + CAMBER_CELL_PX * across;
        at->middle_y[i] = top + from + middle + CAMBER_CELL_PX * down;
    }
}

typedef struct cell_box {
    int from_x, from_y, to_x, to_y;
} cell_box;

/* Rows of cells [first, last] of a tile, and where the tile lies in the picture, px. */
typedef struct tile_rows {
    float left, top;
    int first, last;
} tile_rows;

/* The cells in the box of a segment, a bit each: row by row from the lowest bit. */
static inline ulong box_of(global const float *segment, tile_rows where, private cell_box *box) {
    const float left = where.left, top = where.top;
    const int first = where.first, last = where.last;
    const float ax = segment[CAMBER_SEGMENT_AX], ay = segment[CAMBER_SEGMENT_AY];
    const float bx = segment[CAMBER_SEGMENT_BX], by = segment[CAMBER_SEGMENT_BY], reach = segment[CAMBER_SEGMENT_REACH];
    const float a_cell = 1.0f / CAMBER_CELL_PX, side = (float)(CAMBER_TILE_CELLS - 1);
    const float x0 = ((ax < bx ? ax : bx) - reach - left + 0.5f) * a_cell;
    const float x1 = ((ax < bx ? bx : ax) + reach - left - 0.5f) * a_cell;
    const float y0 = ((ay < by ? ay : by) - reach - top + 0.5f) * a_cell;
    const float y1 = ((ay < by ? by : ay) + reach - top - 0.5f) * a_cell;
    if (x1 < 0.0f || y1 < (float)first || x0 >= side + 1.0f || y0 >= (float)last + 1.0f)
        return 0;
    const int from_x = x0 > 0.0f ? (int)x0 : 0, to_x = x1 < side ? (int)x1 : CAMBER_TILE_CELLS - 1;
    const int from_y = y0 > (float)first ? (int)y0 : first, to_y = y1 < (float)last ? (int)y1 : last;
    if (to_x < from_x || to_y < from_y)
        return 0;
    *box = (cell_box){from_x, from_y, to_x, to_y};
    const ulong row = (255ul >> (CAMBER_TILE_CELLS - 1 - to_x + from_x)) << from_x;
    return (row * (0x0101010101010101ul >> (CAMBER_TILE_CELLS * (CAMBER_TILE_CELLS - 1 - to_y + from_y))))
           << (CAMBER_TILE_CELLS * from_y);
}

/* Turns the masks of 4 x 4 cells into the bits of a tile's cells. */
static inline uint bits_of(int16 cells) {
    const uint16 each = (uint16)(0x1, 0x2, 0x4, 0x8, 0x100, 0x200, 0x400, 0x800, 0x10000, 0x20000, 0x40000, 0x80000,
                                 0x1000000, 0x2000000, 0x4000000, 0x8000000);
    const uint16 bits = as_uint16(cells) & each;
    const uint8 b = bits.lo | bits.hi;
    const uint4 d = b.lo | b.hi;
    const uint2 e = d.lo | d.hi;
    return e.x | e.y;
}

/* Cells, a bit each: those that a segment touches, those that an end is near to, and those that it fills. */
typedef struct cell_sets {
    ulong partial, near_end, full;
} cell_sets;

static inline void sort_cells(private const camber_edge *p, private const positions *at, cell_box box, ulong cells,
                              private cell_sets *sets) {
    const int may_be_inside = p->half_width > 2.0f;
    sets->partial = sets->near_end = sets->full = 0;
    for (int j = box.from_y; j <= box.to_y; j += 4)
        for (int i = box.from_x; i <= box.to_x; i += 4) {
            camber_cell_masks m;
            const int first = CAMBER_TILE_CELLS * j + i;
            if (!(cells >> first & 0x0f0f0f0ful))
                continue;
            camber_cell_masks_of(p, at->middle_x[i], at->middle_y[j], &m);
            sets->partial |= (ulong)bits_of(m.partial) << first;
            sets->near_end |= (ulong)bits_of(m.near_end) << first;
            if (may_be_inside)
                sets->full |= (ulong)bits_of(m.full) << first;
        }
    sets->partial &= cells;
    sets->near_end &= sets->partial;
    sets->full &= sets->partial & ~sets->near_end;
}

/* The pixels of a cell relative to a segment: x along it, y across, fa and fb past its bisectors, px. */
typedef struct pixel_set {
    float16 x, y, fa, fb;
} pixel_set;

static inline void find_pixels(private const camber_edge *p, private const positions *at, int i,
                               private pixel_set *set) {
    const float16 px = at->x[i % CAMBER_TILE_CELLS], py = at->y[i / CAMBER_TILE_CELLS];
    const float16 qx = px - p->ax, qy = py - p->ay;
    set->x = qx * p->ux + qy * p->uy;
    set->y = qy * p->ux - qx * p->uy;
    set->fa = qx * p->nax + qy * p->nay;
    set->fb = (px - p->bx) * p->nbx + (py - p->by) * p->nby;
}

/* Draws a single segment of a union. */
static inline void draw_segment(private tile_state *c, private const positions *at, global const float *segment,
                                tile_rows where) {
    cell_box box;
    cell_sets sets;
    camber_edge p;
    pixel_set set;
    const ulong cells = box_of(segment, where, &box) & ~(c->done | c->filled);
    if (!cells)
        return;
    camber_edge_of(segment, as_uint(segment[CAMBER_SEGMENT_FLAGS]), &p);
    sort_cells(&p, at, box, cells, &sets);
    for (ulong left = sets.partial & ~sets.full; left; left &= left - 1) {
        const int i = lowest(left);
        find_pixels(&p, at, i, &set);
        put_area(c, &p, i,
                 sets.near_end >> i & 1ul ? camber_edge_area(&p, set.x, set.y, set.fa, set.fb)
                                          : camber_edge_side(&p, set.y),
                 set.x, set.y);
    }
    if (sets.full)
        put_whole(c, sets.full);
    c->brushed |= sets.partial;
}
#endif

#endif
