/* Draws segments of one brush, which is not a union, sixteen at a time.
 *
 * Input: the numbers of up to sixteen segments. Their coefficients and cell masks are computed side by side in vectors,
 * to the same bits as camber_edge_of and camber_cell_masks_of find for one. Then all their cells are put into one list
 * and drawn. One long loop lets the processor predict most branches. */
#include "rasterize_cells.cl"
#include "transpose.cl"

#if CAMBER_LANES == 16
/* Segments of a brush that is not a union wait until there are so many. */
#define CAMBER_SIXTEEN 16

typedef struct sixteen {
    uint which[CAMBER_SIXTEEN];
    uint count;
} sixteen;

#define CELL_NEAR_END 64u
#define CELL_FULL 128u
#define CELL_LANE 8

typedef struct edges {
    float16 words[CAMBER_SEGMENT_WORDS];
    float16 length, extent, corner, sa, sb, round_a, round_b, owner_a, owner_b;
    float16 slope_a, slope_b, from_a, from_b, flat_a, flat_b;
    uint16 odd, flat, thin;
} edges;

#define WORD(p, name) (p)->words[CAMBER_SEGMENT_##name]

static inline void find_tight_lines(uint16 end, float16 c, float16 s, float16 h, private float16 *slope,
                                    private float16 *from) {
    const float16 reach = h + CAMBER_PAD_PX, limit = convert_float16(CAMBER_END_LIMIT(end)) * (CAMBER_PAD_PX / 127.0f);
    const float16 outer = fabs(s) * reach;
    const int16 tight = (CAMBER_END_CLASS(end) == CAMBER_CLASS_TIGHT) & (limit * c < outer);
    const float16 scale = 0.5f / (tight ? reach * c : (float16)(1.0f));
    const float16 more = (outer + limit * c) * scale, less = (outer - limit * c) * scale;
    *slope = tight ? (s > 0.0f ? more : -more) : (float16)(0.0f);
    *from = tight ? less * reach : (float16)(CAMBER_NEVER_PX);
}

static inline float16 find_owner_from(uint16 end, uint16 own) {
    const float16 from = own != 0u ? (float16)(0.0f) : (float16)(CAMBER_ALWAYS_PX);
    return (end & CAMBER_END_CLASS_BITS) != 0u ? from : (float16)(CAMBER_NEVER_PX);
}

static inline float16 find_round(uint16 kind) {
    return ((kind == CAMBER_ENDS_ROUND) | (kind == CAMBER_ENDS_SPLIT_ROUND)) ? (float16)(0.0f)
                                                                             : (float16)(CAMBER_NEVER_PX);
}

static inline float16 find_flat(uint16 kind, float16 h) {
    return kind == CAMBER_ENDS_BUTT ? (float16)(0.0f) : kind == CAMBER_ENDS_SQUARE ? h : (float16)(CAMBER_NEVER_PX);
}

/* Works out the coefficients from the words, which are there already. */
static inline void find_edges(private edges *p) {
    const uint16 flags = as_uint16(WORD(p, FLAGS)), one = (uint16)(1u);
    const uint16 end_a = CAMBER_END_OF_A(flags), end_b = CAMBER_END_OF_B(flags);
    const float16 ux = WORD(p, UX), uy = WORD(p, UY), nx = fabs(ux), ny = fabs(uy), h = WORD(p, HALF_WIDTH);
    const float16 nax = WORD(p, NAX), nay = WORD(p, NAY), nbx = WORD(p, NBX), nby = WORD(p, NBY);
    const int16 linear = (flags & CAMBER_SEGMENT_LINEAR) != 0u;
    p->length = (WORD(p, BX) - WORD(p, AX)) * ux + (WORD(p, BY) - WORD(p, AY)) * uy;
    p->extent = linear ? (float16)(0.5f) : 0.5f * (nx + ny);
    p->corner = linear ? (float16)(0.0f) : nx < ny ? nx : ny;
    p->sa = nax * uy - nay * ux;
    p->sb = nby * ux - nbx * uy;
    p->round_a = find_round(CAMBER_END_KIND(end_a));
    p->round_b = find_round(CAMBER_END_KIND(end_b));
    p->flat_a = find_flat(CAMBER_END_KIND(end_a), h);
    p->flat_b = find_flat(CAMBER_END_KIND(end_b), h);
    p->owner_a = find_owner_from(end_a, flags & CAMBER_SEGMENT_OWNER_A);
    p->owner_b = find_owner_from(end_b, flags & CAMBER_SEGMENT_OWNER_B);
    find_tight_lines(end_a, nax * ux + nay * uy, p->sa, h, &p->slope_a, &p->from_a);
    find_tight_lines(end_b, nbx * ux + nby * uy, p->sb, h, &p->slope_b, &p->from_b);
    const int16 tips = (h < CAMBER_TIPS_PX) & ((flags & CAMBER_SEGMENT_ROUNDED) != 0u);
    p->odd =
        as_uint16(tips) | ((one << (CAMBER_END_KIND(end_a)) | one << (CAMBER_END_KIND(end_b))) & CAMBER_SECOND_ENDS);
    p->flat = flags & CAMBER_SEGMENT_FLAT;
    p->thin = as_uint16(h < p->extent);
}

static inline void take_edge(private const edges *from, uint k, private camber_edge *p) {
#define LANE(vector) ((private const float *)&(vector))[k]
    p->ax = LANE(WORD(from, AX));
    p->ay = LANE(WORD(from, AY));
    p->bx = LANE(WORD(from, BX));
    p->by = LANE(WORD(from, BY));
    p->ux = LANE(WORD(from, UX));
    p->uy = LANE(WORD(from, UY));
    p->nax = LANE(WORD(from, NAX));
    p->nay = LANE(WORD(from, NAY));
    p->nbx = LANE(WORD(from, NBX));
    p->nby = LANE(WORD(from, NBY));
    p->half_width = LANE(WORD(from, HALF_WIDTH));
    p->slope = LANE(WORD(from, SLOPE));
    p->curve = LANE(WORD(from, CURVE));
    p->length = LANE(from->length);
    p->extent = LANE(from->extent);
    p->corner = LANE(from->corner);
    p->sa = LANE(from->sa);
    p->sb = LANE(from->sb);
    p->round_a = LANE(from->round_a);
    p->round_b = LANE(from->round_b);
    p->owner_a = LANE(from->owner_a);
    p->owner_b = LANE(from->owner_b);
    p->slope_a = LANE(from->slope_a);
    p->slope_b = LANE(from->slope_b);
    p->from_a = LANE(from->from_a);
    p->from_b = LANE(from->from_b);
    p->flat_a = LANE(from->flat_a);
    p->flat_b = LANE(from->flat_b);
    p->thin = as_uint(LANE(from->thin));
    p->flat = as_uint(LANE(from->flat));
    p->tight = 1u; /* the lines of other joins lie far from any pixel */
#undef LANE
}

/* Boxes of cells: the first cell, and how many cells along each side. */
typedef struct boxes {
    int16 x, y, columns, rows;
    int most_columns, most_rows;
} boxes;

static inline int most_of_all(int16 v) {
    const int8 a = max(v.lo, v.hi);
    const int4 b = max(a.lo, a.hi);
    const int2 c = max(b.lo, b.hi);
    return max(c.x, c.y);
}

/* box_of for sixteen segments. */
static inline void find_boxes(private const edges *p, tile_rows where, uint count, private boxes *b) {
    const float16 ax = WORD(p, AX), ay = WORD(p, AY), bx = WORD(p, BX), by = WORD(p, BY), reach = WORD(p, REACH);
    const float a_cell = 1.0f / CAMBER_CELL_PX;
    const float16 none = (float16)(0.0f), side = (float16)(CAMBER_TILE_CELLS - 1);
    const float16 top = (float16)((float)where.first), bottom = (float16)((float)where.last);
    const float16 x0 = ((ax < bx ? ax : bx) - reach - where.left + 0.5f) * a_cell;
    const float16 x1 = ((ax < bx ? bx : ax) + reach - where.left - 0.5f) * a_cell;
    const float16 y0 = ((ay < by ? ay : by) - reach - where.top + 0.5f) * a_cell;
    const float16 y1 = ((ay < by ? by : ay) + reach - where.top - 0.5f) * a_cell;
    const int16 lanes = (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const int16 meets =
        (x1 >= 0.0f) & (y1 >= top) & (x0 < side + 1.0f) & (y0 < bottom + 1.0f) & (lanes < (int16)((int)count));
    b->x = convert_int16((meets & (x0 > none)) ? x0 : none);
    b->y = convert_int16((meets & (y0 > top)) ? y0 : top);
    b->columns = meets ? convert_int16((meets & (x1 < side)) ? x1 : side) + 1 - b->x : (int16)(0);
    b->rows = meets ? convert_int16((meets & (y1 < bottom)) ? y1 : bottom) + 1 - b->y : (int16)(0);
    b->most_columns = most_of_all(b->columns);
    b->most_rows = most_of_all(b->rows);
}

/* Moves four rows of four bits to a byte each. */
static inline uint16 spread(uint16 bits) {
    return (bits & 0xfu) | (bits & 0xf0u) << 4 | (bits & 0xf00u) << 8 | (bits & 0xf000u) << 12;
}

/* The cell_sets of sixteen segments. */
typedef struct sixteen_masks {
    ulong16 partial, near_end, full;
} sixteen_masks;

/* sort_cells for sixteen segments. */
static inline void find_masks(private const edges *p, private const boxes *b, tile_rows where,
                              private sixteen_masks *m) {
    const float16 ux = WORD(p, UX), uy = WORD(p, UY), h = WORD(p, HALF_WIDTH), always = (float16)(CAMBER_ALWAYS_PX);
    const float16 nax = WORD(p, NAX), nay = WORD(p, NAY), nbx = WORD(p, NBX), nby = WORD(p, NBY);
    const float16 reach = 1.5f * (fabs(ux) + fabs(uy));
    const float16 reach_a = 1.5f * (fabs(nax) + fabs(nay)), reach_b = 1.5f * (fabs(nbx) + fabs(nby));
    const float16 far_a = p->owner_a == always ? -reach_a : always, far_b = p->owner_b == always ? reach_b : -always;
    const int16 sharp = (as_uint16(WORD(p, FLAGS)) & CAMBER_SEGMENT_SHARP) != 0u;
    const float16 near = sharp ? (float16)(CAMBER_NEVER_PX) : reach + 0.75f;
    const float16 near_b = p->length - near, near_fa = reach_a + 0.5f, near_fb = -0.5f - reach_b;
    const float16 bend_a = fabs(p->sa), bend_b = fabs(p->sb), bend = 0.25f * (bend_a > bend_b ? bend_a : bend_b);
    const float16 wide = h + p->extent + reach + bend, full = h - p->extent - reach;
    const float16 left = (float)CAMBER_CELL_PX * convert_float16(b->x) + (where.left + 0.5f * CAMBER_CELL_PX);
    const float16 top = (float)CAMBER_CELL_PX * convert_float16(b->y) + (where.top + 0.5f * CAMBER_CELL_PX);
    const uint16 none = (uint16)(0u);
    m->partial = m->near_end = m->full = (ulong16)(0ul);
    for (int down = 0; down < b->most_rows; down += 4)
        for (int across = 0; across < b->most_columns; across += 4) {
            uint16 meets = none, nears = none, inside = none;
            for (int j = down; j < down + 4 && j < b->most_rows; j++) {
                const float16 my = top + (float)(CAMBER_CELL_PX * j), qy = my - WORD(p, AY), ry = my - WORD(p, BY);
                const float16 qy_uy = qy * uy, qy_ux = qy * ux, qy_na = qy * nay, ry_nb = ry * nby;
                for (int i = across; i < across + 4 && i < b->most_columns; i++) {
                    const float16 mx = left + (float)(CAMBER_CELL_PX * i), qx = mx - WORD(p, AX);
                    const float16 x = qx * ux + qy_uy, aside = fabs(qy_ux - qx * uy);
                    const float16 fa = qx * nax + qy_na, fb = (mx - WORD(p, BX)) * nbx + ry_nb;
                    const uint16 bit = (uint16)(1u << (4 * (j - down) + i - across));
                    const int16 is_own =
                        (b->columns > i) & (b->rows > j) & (aside < wide) & (fa >= far_a) & (fb < far_b);
                    meets |= is_own ? bit : none;
                    nears |= ((x < near) | (x > near_b) | (fa < near_fa) | (fb > near_fb)) ? bit : none;
                    inside |= aside <= full ? bit : none;
                }
            }
            const ulong16 first = convert_ulong16(CAMBER_TILE_CELLS * (b->y + down) + b->x + across);
            m->partial |= convert_ulong16(spread(meets)) << first;
            m->near_end |= convert_ulong16(spread(nears & meets)) << first;
            m->full |= convert_ulong16(spread(inside & meets & ~nears)) << first;
        }
}

typedef struct cell_list {
    uint words[CAMBER_SIXTEEN * CELLS + 4]; /* cell | CELL_NEAR_END or CELL_FULL | lane << CELL_LANE */
    uint count;
} cell_list;

static inline void list_cells(private cell_list *list, ulong cells, uint word) {
    uint at = list->count;
    list->count += (uint)popcount(cells);
#pragma unroll
    for (int i = 0; i < 4; i++, cells &= cells - 1)
        list->words[at++] = word | (uint)lowest(cells);
    for (; cells; cells &= cells - 1)
        list->words[at++] = word | (uint)lowest(cells);
}

/* Lists the cells of all segments, segment by segment. shut: cells that are full already. */
static inline void list_all(private const sixteen_masks *m, uint count, ulong shut, private cell_list *list) {
    ulong nears[CAMBER_SIXTEEN], sides[CAMBER_SIXTEEN], inside[CAMBER_SIXTEEN];
    vstore16(m->near_end & ~shut, 0, nears);
    vstore16(m->partial & ~(m->near_end | m->full | shut), 0, sides);
    vstore16(m->full & ~shut, 0, inside);
    list->count = 0;
    for (uint k = 0; k < count; k++) {
        list_cells(list, nears[k], k << CELL_LANE | CELL_NEAR_END);
        if (sides[k])
            list_cells(list, sides[k], k << CELL_LANE);
        if (inside[k])
            list_cells(list, inside[k], k << CELL_LANE | CELL_FULL);
    }
}

static __attribute__((noinline)) float16 odd_area(global const float *segment, float16 x, float16 y, float16 fa,
                                                  float16 fb) {
    camber_edge p;
    camber_edge_of(segment, as_uint(segment[CAMBER_SEGMENT_FLAGS]), &p);
    return camber_edge_area(&p, x, y, fa, fb);
}

static inline float16 area_of(private const camber_edge *p, float16 x, float16 y, float16 fa, float16 fb) {
    float16 bent;
    const float16 arc = camber_edge_off(p, x, y, fa, fb, &bent);
    float16 area = camber_edge_within(p, p->half_width, sqrt(arc * arc + bent * bent));
    if (p->flat)
        area *= camber_edge_caps(p, x);
    return camber_edge_owner(p, area, x, y, fa, fb);
}

static inline void draw_list(private tile_state *c, private const positions *at, private const edges *all,
                             private const cell_list *list, global const float *segments, private const uint *which) {
    const float opacity = c->now.a;
    ulong shut = c->done | c->filled, brushed = 0;
    for (uint n = 0; n < list->count; n++) {
        const uint word = list->words[n], lane = word >> CELL_LANE;
        const int i = (int)(word % CELLS);
        camber_edge p;
        pixel_set set;
        float16 area;
        if (shut >> i & 1ul)
            continue;
        brushed |= 1ul << i;
        if (word & CELL_FULL) {
            put_whole(c, 1ul << i);
            shut |= c->filled;
            continue;
        }
        take_edge(all, lane, &p);
        if (word & CELL_NEAR_END) {
            find_pixels(&p, at, i, &set);
            area = ((private const uint *)&all->odd)[lane]
                       ? odd_area(segments + (size_t)CAMBER_SEGMENT_WORDS * which[lane], set.x, set.y, set.fa, set.fb)
                       : area_of(&p, set.x, set.y, set.fa, set.fb);
        } else {
            const float16 qx = at->x[i % CAMBER_TILE_CELLS] - p.ax, qy = at->y[i / CAMBER_TILE_CELLS] - p.ay;
            area = camber_edge_side(&p, qy * p.ux - qx * p.uy);
        }
        put_over(c, i, area, opacity);
        shut |= c->filled;
    }
    c->brushed |= brushed;
}

static __attribute__((noinline)) void draw_sixteen(private tile_state *c, private const positions *at,
                                                   global const float *segments, tile_rows where, private sixteen *b) {
    edges p;
    boxes box;
    sixteen_masks m;
    cell_list list;
    if (b->count == 0)
        return;
    for (uint k = b->count; k < CAMBER_SIXTEEN; k++)
        b->which[k] = b->which[0];
#pragma unroll
    for (uint k = 0; k < CAMBER_SIXTEEN; k++)
        p.words[k] = vload16((size_t)b->which[k], segments);
    turn_over(p.words);
    find_edges(&p);
    find_boxes(&p, where, b->count, &box);
    find_masks(&p, &box, where, &m);
    list_all(&m, b->count, c->done | c->filled, &list);
    draw_list(c, at, &p, &list, segments, b->which);
    b->count = 0;
}
#endif
