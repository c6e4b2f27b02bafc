/* cover: the pixels of a tile, or of some rows of its cells, from the segments in its list.
 * Reads shapes, starts[tiles + 1], lists, brushes, items[2 * n] (tile; first and last row of cells << 8), and of
 * CAMBER_RASTER_RICH measures[4 * shape count], more (as many as brushes) and what that names in tail; writes pixels,
 * rows of stride words; where shapes are cut into slices, kept[tiles * tile_words] for the next one instead. What is
 * drawn last is seen first: the list is walked from its end, and what lies below cells that are full is not looked at.
 * Each colour in turn is gathered as what it lets through, and then put under what is there. */

/* A list's segments lie anywhere: where the compiler is known, those to come are asked for ahead. */
#if defined(POCL_DEVICE_ADDRESS_BITS) && CAMBER_POINT_CHUNK == CAMBER_BLOCK
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
static inline ulong box_of(global const float *segment, place where, private cell_box *box) {
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
    ulong partial, near_end, full;
} cell_sets;

static inline void sort_cells(private const camber_edge *p, private const places *at, cell_box box, ulong cells,
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

/* Pixels as a segment has them: x along it, y across, and past the bisectors at its ends. */
typedef struct pixel_set {
    float16 x, y, fa, fb;
} pixel_set;

static inline void find_pixels(private const camber_edge *p, private const places *at, int i, private pixel_set *set) {
    const float16 px = at->x[i % CAMBER_TILE_CELLS], py = at->y[i / CAMBER_TILE_CELLS];
    const float16 qx = px - p->ax, qy = py - p->ay;
    set->x = qx * p->ux + qy * p->uy;
    set->y = qy * p->ux - qx * p->uy;
    set->fa = qx * p->nax + qy * p->nay;
    set->fb = (px - p->bx) * p->nbx + (py - p->by) * p->nby;
}

/* A segment at once: of unions. */
static inline void draw_segment(private tile_state *c, private const places *at, global const float *segment,
                                place where) {
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

/* Segments of a brush that is no union wait until there are so many. */
#define CAMBER_SIXTEEN 16

typedef struct sixteen {
    uint which[CAMBER_SIXTEEN];
    uint count;
} sixteen;

/* rasterize_sixteen.cl */
static void draw_sixteen(private tile_state *c, private const places *at, global const float *segments, place where,
                         private sixteen *b);

#if CAMBER_RASTER_PITCHED
/* A segment that is seen at an angle. */
typedef struct tilted {
    global const float *segment, *plane, *measure, *side_table;
    camber_eye eye;
} tilted;

/* rasterize_pitch.cl */
static inline void draw_tilted(private tile_state *c, private const places *at, place where, tilted from);
#endif

/* Whether nothing that is still to come shows. What is filled by a brush of a layer shows as much as the layer does. */
static inline int is_full(private const tile_state *c) {
    const int opaque = c->now.mode != CAMBER_BRUSH_UNION && !c->is_open[1] && !c->is_open[2];
    return (c->done | (opaque ? c->filled : 0ul)) == ~0ul;
}

static inline uint16 level_of(float16 value) {
    const float16 scaled = value * 255.0f + 0.5f, least = scaled > 0.0f ? scaled : (float16)(0.0f);
    return convert_uint16(least < 255.0f ? least : (float16)(255.0f));
}

static inline uint16 pixels_of(private const float16 *r, private const float16 *g, private const float16 *b,
                               float16 through, camber_target_args s) {
    return level_of(*r + through * s.r) | level_of(*g + through * s.g) << 8 | level_of(*b + through * s.b) << 16 |
           level_of(1.0f - through + through * s.a) << 24;
}

static inline void write_cells(private const tile_state *c, global camber_u32 *pixels, camber_target_args s, float top,
                               int first, int last) {
    const float16 none = (float16)(0.0f);
    const uint16 bare = pixels_of(&none, &none, &none, (float16)(1.0f), s);
#if CAMBER_RASTER_PITCHED
    const uint16 sky = level_of((float16)(s.sky[0])) | level_of((float16)(s.sky[1])) << 8 |
                       level_of((float16)(s.sky[2])) << 16 | level_of((float16)(s.sky[3])) << 24;
#endif
    for (int i = CAMBER_TILE_CELLS * first; i < CAMBER_TILE_CELLS * (last + 1); i++) {
        uint16 rgba = bare;
        if (c->touched[0] >> i & 1ul)
            rgba = pixels_of(c->level[0][0] + i, c->level[0][1] + i, c->level[0][2] + i, c->level[0][3][i], s);
#if CAMBER_RASTER_PITCHED
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

#if CAMBER_RASTER_RICH
#if CAMBER_RASTER_PITCHED
#define PLANES_TOO , global const float *restrict planes
#define MORE_GIVEN , measures, brush_ext, side_table, planes
#else
#define PLANES_TOO
#define MORE_GIVEN , measures, brush_ext, side_table
#endif
#define MORE                                                                                                           \
    , global const float *restrict measures, global const camber_brush_ext *restrict brush_ext,                        \
        global const float *restrict side_table PLANES_TOO

/* rasterize_rich.cl */
static void draw_rich(private tile_state *c, private const places *at, global const float *segment, place where,
                      global const float *measure, global const float *side_table);
#else
#define MORE
#define MORE_GIVEN
#endif

CAMBER_KERNEL(1, rasterize,
              (global const float *restrict segments, global const camber_u32 *restrict starts,
               global const camber_u32 *restrict lists, global const camber_brush *restrict brushes,
               global const camber_u32 *restrict jobs, global camber_u32 *restrict pixels, const camber_target_args s,
               global float *restrict spill, const camber_spill_args slice MORE),
              (segments, starts, lists, brushes, jobs, pixels, s, spill, slice MORE_GIVEN)) {
    tile_state c;
    places at;
    sixteen b;
    const size_t item = CAMBER_WORK_ITEM + s.first_job, tile = jobs[2 * item];
    const camber_u32 cells = jobs[2 * item + 1], column = (camber_u32)tile % s.columns,
                     row = (camber_u32)tile / s.columns;
    const int first = (int)(cells & 255u), last = (int)(cells >> 8);
    const float left = s.left + (float)(column * CAMBER_TILE_PX), top = s.top + (float)(row * CAMBER_TILE_PX);
    const ulong own = (~0ul >> (64 - CAMBER_TILE_CELLS * (last - first + 1))) << (CAMBER_TILE_CELLS * first);
    const place where = {left, top, first, last};
    camber_u32 current = ~0u;
    b.count = 0;
    begin_tile_state(&c, own);
    begin_places(&at, left, top);
#if CAMBER_RASTER_PITCHED
    for (int j = first; j <= last; j++) /* what shows nothing needs no looking at */
        if (top + (float)(CAMBER_CELL_PX * (j + 1)) <= s.horizon)
            c.done |= 255ul << (CAMBER_TILE_CELLS * j);
#endif
    c.now = brushes[0];
    global float *own_spill = spill + tile * slice.tile_words;
    if (!slice.is_first) {
        if (!slice.is_last && starts[tile] == starts[tile + 1])
            return;
        current = restore_cells(&c, own_spill, brushes, slice, first, last);
#if CAMBER_RASTER_RICH
        if (current != ~0u && current != SPILL_FULL)
            use_brush_ext(&c, brush_ext[current]);
#endif
    }
    for (camber_u32 k = starts[tile + 1]; k-- > starts[tile];) {
        global const float *segment = segments + (size_t)CAMBER_SEGMENT_WORDS * lists[k];
        ASK_FOR(segments + (size_t)CAMBER_SEGMENT_WORDS * lists[k > AHEAD ? k - AHEAD : 0]);
        const camber_u32 brush = as_uint(segment[CAMBER_SEGMENT_BRUSH]);
        if (brush != current) {
            draw_sixteen(&c, &at, segments, where, &b);
            change_brush(&c, brushes[brush]);
#if CAMBER_RASTER_RICH
            use_brush_ext(&c, brush_ext[brush]);
#endif
            current = brush;
        }
#if CAMBER_RASTER_PITCHED
        draw_tilted(&c, &at, where,
                    (tilted){segment, planes + (size_t)CAMBER_PLANE_WORDS * lists[k],
                             measures + CAMBER_SEGMENT_MEASURES * (size_t)lists[k], side_table, s.eye});
#else
#if CAMBER_RASTER_RICH
        if (c.brush_ext.features) {
            draw_rich(&c, &at, segment, where, measures + CAMBER_SEGMENT_MEASURES * (size_t)lists[k], side_table);
        } else
#endif
            if (c.now.mode == CAMBER_BRUSH_UNION) {
            draw_segment(&c, &at, segment, where);
        } else {
            b.which[b.count++] = lists[k];
            if (b.count < CAMBER_SIXTEEN)
                continue;
            draw_sixteen(&c, &at, segments, where, &b);
        }
#endif
        if (is_full(&c))
            break;
    }
    draw_sixteen(&c, &at, segments, where, &b);
    const int full = is_full(&c);
    if (!slice.is_last && !full) {
        const camber_u32 open = (camber_u32)c.is_open[1] << 30 | (camber_u32)c.is_open[2] << 31;
        spill_cells(&c, own_spill, slice, first, last, (current & SPILL_BRUSH) | open);
        return;
    }
    close_brush(&c);
    if (c.is_open[2])
        close_level(&c, 2, c.now.layer_opacity);
    if (c.is_open[1])
        close_level(&c, 1, c.now.group_opacity);
    if (!slice.is_last) {
        c.done = ~0ul;
        spill_cells(&c, own_spill, slice, first, last, SPILL_FULL);
        return;
    }
    write_cells(&c, pixels + ((size_t)row * CAMBER_TILE_PX + s.above) * s.stride + (size_t)column * CAMBER_TILE_PX, s,
                top, first, last);
}
#endif
