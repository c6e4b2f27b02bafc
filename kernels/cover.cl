/* cover: the pixels of a tile, or of some rows of its cells, from the segments in its list.
 * Reads shapes, starts[tiles + 1], lists, inks, items[2 * n] (tile; first and last row of cells << 8), and of
 * CAMBER_COVER_RICH measures[4 * shape count], more (as many as inks) and what that names in tail; writes pixels, rows
 * of stride words; where shapes are cut into slices, kept[tiles * tile_words] for the next one instead. What is drawn
 * last is seen first: the list is walked from its end, and what lies below cells that are full is not looked at. Each
 * colour in turn is gathered as what it lets through, and then put under what is there. */

/* A list's segments lie anywhere: where the compiler is known, those to come are asked for ahead. */
#if defined(POCL_DEVICE_ADDRESS_BITS) && CAMBER_ITEM == CAMBER_BLOCK
#define AHEAD 6
#define ASK_FOR(address) __builtin_prefetch((const void *)(size_t)(address))
#else
#define AHEAD 0
#define ASK_FOR(address) ((void)0)
#endif

#if CAMBER_LANES == 16
/* Where pixels of cells, and cells of four by four of them, lie in the picture: by the first one's column or row. */
typedef struct places {
    float16 x[CAMBER_TILE_CELLS], y[CAMBER_TILE_CELLS];
    float16 middle_x[CAMBER_TILE_CELLS], middle_y[CAMBER_TILE_CELLS];
} places;

constant float ACROSS[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
constant float DOWN[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

static inline void begin_places(private places *at, float left, float top) {
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

/* A tile, or some rows of its cells, in the picture. */
typedef struct place {
    float left, top;
    int first, last;
} place;

/* The cells in the box of a segment, a bit each. */
static inline ulong box_of(global const float *shape, place where, private cell_box *box) {
    const float left = where.left, top = where.top;
    const int first = where.first, last = where.last;
    const float ax = shape[CAMBER_SHAPE_AX], ay = shape[CAMBER_SHAPE_AY];
    const float bx = shape[CAMBER_SHAPE_BX], by = shape[CAMBER_SHAPE_BY], reach = shape[CAMBER_SHAPE_REACH];
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

/* Of four by four cells, the bits as a tile has them. */
static inline uint bits_of(int16 cells) {
    const uint16 each = (uint16)(0x1, 0x2, 0x4, 0x8, 0x100, 0x200, 0x400, 0x800, 0x10000, 0x20000, 0x40000, 0x80000,
                                 0x1000000, 0x2000000, 0x4000000, 0x8000000);
    const uint16 bits = as_uint16(cells) & each;
    const uint8 b = bits.lo | bits.hi;
    const uint4 d = b.lo | b.hi;
    const uint2 e = d.lo | d.hi;
    return e.x | e.y;
}

/* Of a box's cells, those that the segment meets, those near its ends, and those all inside the stroke. */
typedef struct cell_sets {
    ulong meets, nears, inside;
} cell_sets;

static inline void sort_cells(private const camber_pen *p, private const places *at, cell_box box, ulong cells,
                              private cell_sets *sets) {
    const int may_be_inside = p->half_width > 2.0f;
    sets->meets = sets->nears = sets->inside = 0;
    for (int j = box.from_y; j <= box.to_y; j += 4)
        for (int i = box.from_x; i <= box.to_x; i += 4) {
            camber_meeting m;
            const int first = CAMBER_TILE_CELLS * j + i;
            if (!(cells >> first & 0x0f0f0f0ful))
                continue;
            camber_cells_meet(p, at->middle_x[i], at->middle_y[j], &m);
            sets->meets |= (ulong)bits_of(m.meets) << first;
            sets->nears |= (ulong)bits_of(m.nears) << first;
            if (may_be_inside)
                sets->inside |= (ulong)bits_of(m.inside) << first;
        }
    sets->meets &= cells;
    sets->nears &= sets->meets;
    sets->inside &= sets->meets & ~sets->nears;
}

/* Pixels as a segment has them: x along it, y across, and past the bisectors at its ends. */
typedef struct pixel_set {
    float16 x, y, fa, fb;
} pixel_set;

static inline void find_pixels(private const camber_pen *p, private const places *at, int i, private pixel_set *set) {
    const float16 px = at->x[i % CAMBER_TILE_CELLS], py = at->y[i / CAMBER_TILE_CELLS];
    const float16 qx = px - p->ax, qy = py - p->ay;
    set->x = qx * p->ux + qy * p->uy;
    set->y = qy * p->ux - qx * p->uy;
    set->fa = qx * p->nax + qy * p->nay;
    set->fb = (px - p->bx) * p->nbx + (py - p->by) * p->nby;
}

/* A segment at once: of unions. */
static inline void draw_segment(private canvas *c, private const places *at, global const float *shape, place where) {
    cell_box box;
    cell_sets sets;
    camber_pen p;
    pixel_set set;
    const ulong cells = box_of(shape, where, &box) & ~(c->done | c->filled);
    if (!cells)
        return;
    camber_pen_of(shape, as_uint(shape[CAMBER_SHAPE_FLAGS]), &p);
    sort_cells(&p, at, box, cells, &sets);
    for (ulong left = sets.meets & ~sets.inside; left; left &= left - 1) {
        const int i = lowest(left);
        find_pixels(&p, at, i, &set);
        put_area(c, &p, i,
                 sets.nears >> i & 1ul ? camber_pen_area(&p, set.x, set.y, set.fa, set.fb) : camber_pen_side(&p, set.y),
                 set.x, set.y);
    }
    if (sets.inside)
        put_whole(c, sets.inside);
    c->inked |= sets.meets;
}

/* Segments of an ink that is no union wait until there are so many. */
#define CAMBER_BATCH 16

typedef struct batch {
    uint which[CAMBER_BATCH];
    uint count;
} batch;

/* cover_batch.cl */
static void draw_batch(private canvas *c, private const places *at, global const float *shapes, place where,
                       private batch *b);

#if CAMBER_COVER_PITCHED
/* A segment that is seen at an angle. */
typedef struct tilted {
    global const float *shape, *plane, *measure, *tail;
    camber_eye eye;
} tilted;

/* cover_pitch.cl */
static inline void draw_tilted(private canvas *c, private const places *at, place where, tilted from);
#endif

/* Whether nothing that is still to come shows. What is filled by an ink of a layer shows as much as the layer does. */
static inline int is_full(private const canvas *c) {
    const int opaque = c->now.mode != CAMBER_INK_UNION && !c->is_open[1] && !c->is_open[2];
    return (c->done | (opaque ? c->filled : 0ul)) == ~0ul;
}

static inline uint16 level_of(float16 value) {
    const float16 scaled = value * 255.0f + 0.5f, least = scaled > 0.0f ? scaled : (float16)(0.0f);
    return convert_uint16(least < 255.0f ? least : (float16)(255.0f));
}

static inline uint16 pixels_of(private const float16 *r, private const float16 *g, private const float16 *b,
                               float16 through, camber_sheet s) {
    return level_of(*r + through * s.r) | level_of(*g + through * s.g) << 8 | level_of(*b + through * s.b) << 16 |
           level_of(1.0f - through + through * s.a) << 24;
}

static inline void write_cells(private const canvas *c, global camber_u32 *pixels, camber_sheet s, float top, int first,
                               int last) {
    const float16 none = (float16)(0.0f);
    const uint16 bare = pixels_of(&none, &none, &none, (float16)(1.0f), s);
#if CAMBER_COVER_PITCHED
    const uint16 sky = level_of((float16)(s.sky[0])) | level_of((float16)(s.sky[1])) << 8 |
                       level_of((float16)(s.sky[2])) << 16 | level_of((float16)(s.sky[3])) << 24;
#endif
    for (int i = CAMBER_TILE_CELLS * first; i < CAMBER_TILE_CELLS * (last + 1); i++) {
        uint16 rgba = bare;
        if (c->touched[0] >> i & 1ul)
            rgba = pixels_of(c->level[0][0] + i, c->level[0][1] + i, c->level[0][2] + i, c->level[0][3][i], s);
#if CAMBER_COVER_PITCHED
        const float16 y = top + (float)(CAMBER_CELL_PX * (i / CAMBER_TILE_CELLS)) + vload16(0, DOWN);
        rgba = y < s.horizon ? sky : rgba;
#endif
        global camber_u32 *at = pixels + (size_t)(i / CAMBER_TILE_CELLS * CAMBER_CELL_PX) * s.stride +
                                i % CAMBER_TILE_CELLS * CAMBER_CELL_PX;
        vstore4(rgba.s0123, 0, at);
        vstore4(rgba.s4567, 0, at + s.stride);
        vstore4(rgba.s89ab, 0, at + 2 * (size_t)s.stride);
        vstore4(rgba.scdef, 0, at + 3 * (size_t)s.stride);
    }
}

#if CAMBER_COVER_RICH
#if CAMBER_COVER_PITCHED
#define PLANES_TOO , global const float *restrict planes
#define MORE_GIVEN , arc_lengths, more, tail, planes
#else
#define PLANES_TOO
#define MORE_GIVEN , arc_lengths, more, tail
#endif
#define MORE                                                                                                           \
    , global const float *restrict arc_lengths, global const camber_ink_more *restrict more,                           \
        global const float *restrict tail PLANES_TOO

/* cover_rich.cl */
static void draw_rich(private canvas *c, private const places *at, global const float *shape, place where,
                      global const float *measure, global const float *tail);
#else
#define MORE
#define MORE_GIVEN
#endif

CAMBER_KERNEL(1, cover,
              (global const float *restrict shapes, global const camber_u32 *restrict starts,
               global const camber_u32 *restrict lists, global const camber_ink *restrict inks,
               global const camber_u32 *restrict items, global camber_u32 *restrict pixels, const camber_sheet s,
               global float *restrict kept, const camber_slice slice MORE),
              (shapes, starts, lists, inks, items, pixels, s, kept, slice MORE_GIVEN)) {
    canvas c;
    places at;
    batch b;
    const size_t item = CAMBER_ITEM_ID + s.first_item, tile = items[2 * item];
    const camber_u32 cells = items[2 * item + 1], column = (camber_u32)tile % s.columns,
                     row = (camber_u32)tile / s.columns;
    const int first = (int)(cells & 255u), last = (int)(cells >> 8);
    const float left = s.left + (float)(column * CAMBER_TILE_PX), top = s.top + (float)(row * CAMBER_TILE_PX);
    const ulong own = (~0ul >> (64 - CAMBER_TILE_CELLS * (last - first + 1))) << (CAMBER_TILE_CELLS * first);
    const place where = {left, top, first, last};
    camber_u32 current = ~0u;
    b.count = 0;
    begin_canvas(&c, own);
    begin_places(&at, left, top);
#if CAMBER_COVER_PITCHED
    for (int j = first; j <= last; j++) /* what shows nothing needs no looking at */
        if (top + (float)(CAMBER_CELL_PX * (j + 1)) <= s.horizon)
            c.done |= 255ul << (CAMBER_TILE_CELLS * j);
#endif
    c.now = inks[0];
    global float *own_kept = kept + tile * slice.tile_words;
    if (!slice.is_first) {
        if (!slice.is_last && starts[tile] == starts[tile + 1])
            return;
        current = take_cells(&c, own_kept, inks, slice, first, last);
#if CAMBER_COVER_RICH
        if (current != ~0u && current != KEPT_FULL)
            use_more(&c, more[current]);
#endif
    }
    for (camber_u32 k = starts[tile + 1]; k-- > starts[tile];) {
        global const float *shape = shapes + (size_t)CAMBER_SHAPE_WORDS * lists[k];
        ASK_FOR(shapes + (size_t)CAMBER_SHAPE_WORDS * lists[k > AHEAD ? k - AHEAD : 0]);
        const camber_u32 ink = as_uint(shape[CAMBER_SHAPE_INK]);
        if (ink != current) {
            draw_batch(&c, &at, shapes, where, &b);
            change_ink(&c, inks[ink]);
#if CAMBER_COVER_RICH
            use_more(&c, more[ink]);
#endif
            current = ink;
        }
#if CAMBER_COVER_PITCHED
        draw_tilted(&c, &at, where,
                    (tilted){shape, planes + (size_t)CAMBER_PLANE_WORDS * lists[k],
                             arc_lengths + CAMBER_SHAPE_MEASURES * (size_t)lists[k], tail, s.eye});
#else
#if CAMBER_COVER_RICH
        if (c.more.features) {
            draw_rich(&c, &at, shape, where, arc_lengths + CAMBER_SHAPE_MEASURES * (size_t)lists[k], tail);
        } else
#endif
            if (c.now.mode == CAMBER_INK_UNION) {
            draw_segment(&c, &at, shape, where);
        } else {
            b.which[b.count++] = lists[k];
            if (b.count < CAMBER_BATCH)
                continue;
            draw_batch(&c, &at, shapes, where, &b);
        }
#endif
        if (is_full(&c))
            break;
    }
    draw_batch(&c, &at, shapes, where, &b);
    const int full = is_full(&c);
    if (!slice.is_last && !full) {
        const camber_u32 open = (camber_u32)c.is_open[1] << 30 | (camber_u32)c.is_open[2] << 31;
        keep_cells(&c, own_kept, slice, first, last, (current & KEPT_INK) | open);
        return;
    }
    close_ink(&c);
    if (c.is_open[2])
        close_level(&c, 2, c.now.layer_opacity);
    if (c.is_open[1])
        close_level(&c, 1, c.now.group_opacity);
    if (!slice.is_last) {
        c.done = ~0ul;
        keep_cells(&c, own_kept, slice, first, last, KEPT_FULL);
        return;
    }
    write_cells(&c, pixels + ((size_t)row * CAMBER_TILE_PX + s.above) * s.stride + (size_t)column * CAMBER_TILE_PX, s,
                top, first, last);
}
#endif
