/* cover: the pixels of a tile, or of some rows of its cells, from the segments in its list.
 * Reads shapes, starts[tiles + 1], lists, inks, items[2 * n] (tile; first and last row of cells << 8), and of
 * CAMBER_COVER_RICH measures[4 * shape count], more (as many as inks) and what that names in tail; writes pixels, rows
 * of stride words; where shapes are cut into slices, kept[tiles * tile_words] for the next one instead. What is drawn
 * last is seen first: the list is walked from its end, and what lies below cells that are full is not looked at. Each
 * colour in turn is gathered as what it lets through, and then put under what is there. */
#define CELLS (CAMBER_TILE_CELLS * CAMBER_TILE_CELLS)
#define LEVELS 3 /* the picture, a group, a layer */

/* A list's segments lie anywhere: where the compiler is known, those to come are asked for ahead. */
#if defined(POCL_DEVICE_ADDRESS_BITS) && CAMBER_ITEM == CAMBER_BLOCK
#define AHEAD 6
#define ASK_FOR(address) __builtin_prefetch((const void *)(size_t)(address))
#else
#define AHEAD 0
#define ASK_FOR(address) ((void)0)
#endif

typedef struct camber_sheet {
    float left, top; /* of the first tile in the picture, px */
    camber_u32 columns, stride;
    float r, g, b, a; /* background, premultiplied */
    camber_u32 above; /* rows of pixels before these */
    float horizon;    /* of CAMBER_COVER_PITCHED: rows of pixels of the picture in which nothing is drawn */
    camber_eye eye;
    float sky[4]; /* what they have, premultiplied */
} camber_sheet;

/* Slices of the shapes are drawn one after the other, the last in drawing order first. Of a tile there is kept between
 * them: bits and counts of its cells, a word a row of cells, and planes of a cell's sixteen floats, from KEPT_WORDS on:
 * the ink, the picture's level, and from where it is said here, what unions, groups and layers have besides. */
typedef struct camber_slice {
    camber_u32 is_first, is_last; /* as they are drawn */
    camber_u32 tile_words, sums, group, layer;
} camber_slice;

#define KEPT_WORDS 48
#define KEPT_PUTS 48 /* bytes: six of a bit a cell lie before them */
#define KEPT_ROWS 28 /* words */
#define KEPT_INK 0x3fffffffu
#define KEPT_FULL 0x3ffffffeu /* a row of cells that nothing shows through */

typedef struct canvas {
    float16 ink[4][CELLS];           /* let through; of unions the sums of areas and of normals besides */
    float16 level[LEVELS][4][CELLS]; /* red, green, blue; let through */
    ulong inked, touched[LEVELS];    /* cells, a bit each */
    ulong done;                      /* nothing that lies below shows in these */
    ulong filled;                    /* nor of the same ink in these */
    int is_open[LEVELS], is_ready[LEVELS], has_sums;
    uchar puts[CELLS]; /* segments that came */
    camber_ink now;
#if CAMBER_COVER_RICH
    camber_ink_more more; /* of it */
#endif
} canvas;

static inline float most_of(float16 v) {
    const float8 a = v.lo > v.hi ? v.lo : v.hi;
    const float4 b = a.lo > a.hi ? a.lo : a.hi;
    const float2 c = b.lo > b.hi ? b.lo : b.hi;
    return c.x > c.y ? c.x : c.y;
}

static inline int lowest(ulong bits) {
    return 63 - (int)clz(bits & (~bits + 1));
}

static inline void clear_level(private canvas *c, int level) {
    for (int i = 0; i < CELLS; i++) {
        c->level[level][0][i] = c->level[level][1][i] = c->level[level][2][i] = (float16)(0.0f);
        c->level[level][3][i] = (float16)(1.0f);
    }
}

static inline void begin_canvas(private canvas *c, ulong cells) {
    for (int i = 0; i < CELLS; i++)
        c->ink[0][i] = (float16)(1.0f);
    clear_level(c, 0);
    for (int i = 0; i < CELLS / 16; i++)
        vstore16((uchar16)(0), i, c->puts);
    c->inked = c->filled = c->touched[0] = c->touched[1] = c->touched[2] = 0;
    c->done = ~cells;
    c->is_open[0] = c->is_ready[0] = 1;
    c->is_open[1] = c->is_open[2] = c->is_ready[1] = c->is_ready[2] = c->has_sums = 0;
}

/* Notes whether a cell of the picture is full. */
static inline void look_at_cell(private canvas *c, int i, int level) {
    if (level == 0 && most_of(c->level[0][3][i]) < CAMBER_NOTHING_PX)
        c->done |= 1ul << i;
}

/* What is inked goes under what the level has. */
static inline void close_ink(private canvas *c) {
    const int level = c->is_open[2] ? 2 : c->is_open[1] ? 1 : 0;
    const int is_union = c->now.mode == CAMBER_INK_UNION;
    for (ulong left = c->inked; left; left &= left - 1) {
        const int i = lowest(left);
        float16 area = 1.0f - c->ink[0][i];
        if (is_union) {
            area = camber_united(area, c->ink[1][i], c->ink[2][i], c->ink[3][i]) * c->now.a;
            c->ink[1][i] = c->ink[2][i] = c->ink[3][i] = (float16)(0.0f);
        }
        const float16 through = c->level[level][3][i], seen = through * area;
        c->level[level][0][i] += seen * c->now.r;
        c->level[level][1][i] += seen * c->now.g;
        c->level[level][2][i] += seen * c->now.b;
        c->level[level][3][i] = through * (1.0f - area);
        c->ink[0][i] = (float16)(1.0f);
        look_at_cell(c, i, level);
    }
    c->touched[level] |= c->inked;
    c->inked = c->filled = 0;
}

/* A layer or a group goes under what the level below it has. */
static inline void close_level(private canvas *c, int level, float opacity) {
    const int below = level == 2 && c->is_open[1] ? 1 : 0;
    for (ulong left = c->touched[level]; left; left &= left - 1) {
        const int i = lowest(left);
        const float16 through = c->level[below][3][i], seen = through * opacity;
        for (int k = 0; k < 3; k++) {
            c->level[below][k][i] += seen * c->level[level][k][i];
            c->level[level][k][i] = (float16)(0.0f);
        }
        c->level[below][3][i] = through * (1.0f - (1.0f - c->level[level][3][i]) * opacity);
        c->level[level][3][i] = (float16)(1.0f);
        look_at_cell(c, i, below);
    }
    c->touched[below] |= c->touched[level];
    c->touched[level] = 0;
    c->is_open[level] = 0;
}

static inline void open_level(private canvas *c, int level) {
    if (!c->is_ready[level])
        clear_level(c, level);
    c->is_open[level] = c->is_ready[level] = 1;
}

static inline void clear_sums(private canvas *c) {
    for (int i = 0; i < CELLS; i++)
        c->ink[1][i] = c->ink[2][i] = c->ink[3][i] = (float16)(0.0f);
    c->has_sums = 1;
}

/* Closes what the ink has nothing to do with, and opens what it lies in. */
static inline void change_ink(private canvas *c, camber_ink next) {
    close_ink(c);
    if (c->is_open[2] && next.layer != c->now.layer)
        close_level(c, 2, c->now.layer_opacity);
    if (c->is_open[1] && next.group != c->now.group)
        close_level(c, 1, c->now.group_opacity);
    if (next.group && !c->is_open[1])
        open_level(c, 1);
    if (next.layer && !c->is_open[2])
        open_level(c, 2);
    if (next.mode == CAMBER_INK_UNION && !c->has_sums)
        clear_sums(c);
    c->now = next;
}

static inline void put_over(private canvas *c, int i, float16 area) {
    c->ink[0][i] *= 1.0f - area * c->now.a;
    if (++c->puts[i] % CAMBER_LOOK_EVERY == 0 && c->now.a == 1.0f && most_of(c->ink[0][i]) < CAMBER_NOTHING_PX)
        c->filled |= 1ul << i;
}

static inline void put_area(private canvas *c, private const camber_pen *p, int i, float16 area, float16 x, float16 y) {
    if (c->now.mode != CAMBER_INK_UNION) {
        put_over(c, i, area);
        return;
    }
    c->ink[0][i] *= 1.0f - area;
    if (p->half_width > 0.4f) {
        float16 nx, ny;
        camber_pen_normal(p, x, y, &nx, &ny);
        const float16 edge = area * (1.0f - area);
        c->ink[1][i] += area;
        c->ink[2][i] += nx * edge;
        c->ink[3][i] += ny * edge;
    }
}

/* All of a cell's pixels lie inside the stroke. */
static inline void put_whole(private canvas *c, int i) {
    const int is_union = c->now.mode == CAMBER_INK_UNION;
    c->ink[0][i] *= is_union ? 0.0f : 1.0f - c->now.a;
    if (is_union || c->now.a == 1.0f)
        c->filled |= 1ul << i;
}

/* ---- Between slices ---- */

static inline void keep_planes(global float *planes, private const float16 (*from)[CELLS], camber_u32 plane,
                               camber_u32 count, ulong cells) {
    for (; cells; cells &= cells - 1)
        for (camber_u32 k = 0; k < count; k++)
            vstore16(from[k][lowest(cells)], (size_t)(plane + k) * CELLS + (size_t)lowest(cells), planes);
}

static inline void take_planes(global const float *planes, private float16 (*to)[CELLS], camber_u32 plane,
                               camber_u32 count, ulong cells) {
    for (; cells; cells &= cells - 1)
        for (camber_u32 k = 0; k < count; k++)
            to[k][lowest(cells)] = vload16((size_t)(plane + k) * CELLS + (size_t)lowest(cells), planes);
}

/* As far as cells are not what they begin as. */
static inline void keep_cells(private const canvas *c, global float *kept, camber_slice s, int first, int last,
                              camber_u32 now) {
    global uchar *bits = (global uchar *)kept, *puts = bits + KEPT_PUTS;
    global camber_u32 *rows = (global camber_u32 *)kept + KEPT_ROWS;
    global float *planes = kept + KEPT_WORDS;
    const ulong of[6] = {c->inked, c->filled, c->done, c->touched[0], c->touched[1], c->touched[2]};
    for (int j = first; j <= last; j++) {
        for (int k = 0; k < 6; k++)
            bits[CAMBER_TILE_CELLS * k + j] = (uchar)(of[k] >> (CAMBER_TILE_CELLS * j));
        vstore8(vload8((size_t)j, c->puts), (size_t)j, puts);
        rows[j] = now;
    }
    keep_planes(planes, c->ink, 0, 1, c->inked);
    keep_planes(planes, c->level[0], 1, 4, c->touched[0]);
    if (c->now.mode == CAMBER_INK_UNION)
        keep_planes(planes, c->ink + 1, s.sums, 3, c->inked);
    keep_planes(planes, c->level[1], s.group, 4, c->touched[1]);
    keep_planes(planes, c->level[2], s.layer, 4, c->touched[2]);
}

/* Gives the ink that was drawn last, or KEPT_FULL. Rows of cells that are not full have seen the same list, so that all
 * of them have the same ink and levels. */
static inline camber_u32 take_cells(private canvas *c, global const float *kept, global const camber_ink *inks,
                                    camber_slice s, int first, int last) {
    global const uchar *bits = (global const uchar *)kept, *puts = bits + KEPT_PUTS;
    global const camber_u32 *rows = (global const camber_u32 *)kept + KEPT_ROWS;
    global const float *planes = kept + KEPT_WORDS;
    ulong of[6] = {0, 0, 0, 0, 0, 0};
    camber_u32 now = KEPT_FULL;
    for (int j = first; j <= last; j++) {
        for (int k = 0; k < 6; k++)
            of[k] |= (ulong)bits[CAMBER_TILE_CELLS * k + j] << (CAMBER_TILE_CELLS * j);
        vstore8(vload8((size_t)j, puts), (size_t)j, c->puts);
        now = rows[j] == KEPT_FULL ? now : rows[j];
    }
    c->inked = of[0];
    c->filled = of[1];
    c->done |= of[2];
    for (int k = 0; k < LEVELS; k++)
        c->touched[k] = of[3 + k];
    take_planes(planes, c->ink, 0, 1, c->inked);
    take_planes(planes, c->level[0], 1, 4, c->touched[0]);
    if (now == KEPT_FULL)
        return now;
    for (int k = 1; k < LEVELS; k++)
        if (now >> (29 + k) & 1u) {
            open_level(c, k);
            take_planes(planes, c->level[k], k == 1 ? s.group : s.layer, 4, c->touched[k]);
        }
    if ((now & KEPT_INK) == KEPT_INK)
        return ~0u;
    c->now = inks[now & KEPT_INK];
    if (c->now.mode == CAMBER_INK_UNION) {
        clear_sums(c);
        take_planes(planes, c->ink + 1, s.sums, 3, c->inked);
    }
    return now & KEPT_INK;
}

/* The pixels of a cell, from its first one. */
constant float ACROSS[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
constant float DOWN[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

/* The cells, of rows first to last, that a segment may meet, a bit each: those of its box, and where that is large, of
 * its band. */
static inline ulong box_of(global const float *shape, float left, float top, int first, int last) {
    const float ax = shape[CAMBER_SHAPE_AX], ay = shape[CAMBER_SHAPE_AY], bx = shape[CAMBER_SHAPE_BX],
                by = shape[CAMBER_SHAPE_BY], reach = shape[CAMBER_SHAPE_REACH];
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
    if (to_x - from_x > 1 && to_y - from_y > 1) {
        ulong cells = 0;
        for (int j = from_y; j <= to_y; j++) {
            const float middle = top + CAMBER_CELL_PX * ((float)j + 0.5f);
            const camber_u32 span =
                camber_row_span(shape, middle, left, (camber_u32)from_x, (camber_u32)to_x, CAMBER_CELL_PX);
            const camber_u32 begin = span & 255u, end = span >> 8;
            if (begin <= end)
                cells |= ((255ul >> (CAMBER_TILE_CELLS - 1u - end + begin)) << begin) << (CAMBER_TILE_CELLS * j);
        }
        return cells;
    }
    const ulong row = (255ul >> (CAMBER_TILE_CELLS - 1 - to_x + from_x)) << from_x;
    return (row * (0x0101010101010101ul >> (CAMBER_TILE_CELLS * (CAMBER_TILE_CELLS - 1 - to_y + from_y))))
           << (CAMBER_TILE_CELLS * from_y);
}

static inline void draw_segment(private canvas *c, global const float *shape, float left, float top, int first,
                                int last) {
    ulong cells = box_of(shape, left, top, first, last) & ~(c->done | c->filled), inked = 0;
    if (!cells)
        return;
    camber_pen p;
    camber_pen_of(shape, as_uint(shape[CAMBER_SHAPE_FLAGS]), &p);
    const float16 across = vload16(0, ACROSS), down = vload16(0, DOWN);
    const float16 lane_x = across * p.ux + down * p.uy, lane_y = down * p.ux - across * p.uy;
    const float16 lane_a = across * p.nax + down * p.nay, lane_b = across * p.nbx + down * p.nby;
    for (; cells; cells &= cells - 1) {
        const int i = lowest(cells);
        const float px = left + 0.5f + (float)(CAMBER_CELL_PX * (i % CAMBER_TILE_CELLS)), qx = px - p.ax;
        const float py = top + 0.5f + (float)(CAMBER_CELL_PX * (i / CAMBER_TILE_CELLS)), qy = py - p.ay;
        const float x = qx * p.ux + qy * p.uy, y = qy * p.ux - qx * p.uy;
        const float fa = qx * p.nax + qy * p.nay, fb = (px - p.bx) * p.nbx + (py - p.by) * p.nby;
        const camber_u32 meets = camber_cell_meets(&p, x + 1.5f * (p.ux + p.uy), y + 1.5f * (p.ux - p.uy),
                                                   fa + 1.5f * (p.nax + p.nay), fb + 1.5f * (p.nbx + p.nby));
        if (meets == CAMBER_CELL_OUTSIDE)
            continue;
        inked |= 1ul << i;
        if (meets == CAMBER_CELL_INSIDE) {
            put_whole(c, i);
            continue;
        }
        const float16 xs = x + lane_x, ys = y + lane_y;
        const float16 area = meets == CAMBER_CELL_ASIDE ? camber_pen_side(&p, ys)
                                                        : camber_pen_area(&p, xs, ys, fa + lane_a, fb + lane_b);
        put_area(c, &p, i, area, xs, ys);
    }
    c->inked |= inked;
}

#if CAMBER_COVER_PITCHED
static inline void put_tilted(private canvas *c, private const camber_pitch_pen *p, int i, float16 area,
                              private const camber_pitch_pixel *at) {
    c->ink[0][i] *= 1.0f - area;
    float16 nx, ny;
    const int16 thick = camber_pitch_inward(p, at, &nx, &ny);
    const float16 none = (float16)(0.0f), edge = area * (1.0f - area);
    c->ink[1][i] += thick ? area : none;
    c->ink[2][i] += thick ? nx * edge : none;
    c->ink[3][i] += thick ? ny * edge : none;
}

/* Rows of cells of a tile, which lies in the picture. */
typedef struct tilted_tile {
    float left, top;
    int first, last;
    camber_eye eye;
} tilted_tile;

static inline void draw_tilted(private canvas *c, global const float *shape, global const float *plane,
                               tilted_tile to) {
    ulong cells = box_of(shape, to.left, to.top, to.first, to.last) & ~(c->done | c->filled), inked = 0;
    const int is_union = c->now.mode == CAMBER_INK_UNION;
    if (!cells)
        return;
    camber_pitch_pen p;
    camber_pitch_pen_of(to.eye, shape, plane, as_uint(shape[CAMBER_SHAPE_FLAGS]), &p);
    const float16 across = vload16(0, ACROSS), down = vload16(0, DOWN);
    for (; cells; cells &= cells - 1) {
        const int i = lowest(cells);
        const float x = to.left + 0.5f + (float)(CAMBER_CELL_PX * (i % CAMBER_TILE_CELLS)) - to.eye.x;
        const float y = to.top + 0.5f + (float)(CAMBER_CELL_PX * (i / CAMBER_TILE_CELLS)) - to.eye.y;
        const camber_u32 meets = camber_pitch_cell_meets(&p, x + 1.5f, y + 1.5f);
        if (meets == CAMBER_CELL_OUTSIDE)
            continue;
        inked |= 1ul << i;
        if (meets == CAMBER_CELL_INSIDE) {
            put_whole(c, i);
        } else if (meets == CAMBER_CELL_ASIDE && !is_union) {
            put_over(c, i, camber_pitch_side(&p, x, y, across, down));
        } else {
            camber_pitch_pixel at;
            camber_pitch_look(&p, x, y, across, down, &at);
            const float16 area = camber_pitch_area(&p, &at);
            if (is_union)
                put_tilted(c, &p, i, area, &at);
            else
                put_over(c, i, area);
        }
    }
    c->inked |= inked;
}
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
#else
#define PLANES_TOO
#endif
#define MORE                                                                                                           \
    , global const float *restrict measures, global const camber_ink_more *restrict more,                              \
        global const float4 *restrict tail PLANES_TOO
#else
#define MORE
#endif

kernel __attribute__((reqd_work_group_size(1, 1, 1))) void cover(
    global const float *restrict shapes, global const camber_u32 *restrict starts,
    global const camber_u32 *restrict lists, global const camber_ink *restrict inks,
    global const camber_u32 *restrict items, global camber_u32 *restrict pixels, const camber_sheet s,
    global float *restrict kept, const camber_slice slice MORE) {
    canvas c;
    const size_t tile = items[2 * get_global_id(0)];
    const camber_u32 cells = items[2 * get_global_id(0) + 1], column = (camber_u32)tile % s.columns,
                     row = (camber_u32)tile / s.columns;
    const int first = (int)(cells & 255u), last = (int)(cells >> 8);
    const float left = s.left + (float)(column * CAMBER_TILE_PX), top = s.top + (float)(row * CAMBER_TILE_PX);
    const ulong own = (~0ul >> (64 - CAMBER_TILE_CELLS * (last - first + 1))) << (CAMBER_TILE_CELLS * first);
    camber_u32 current = ~0u;
    begin_canvas(&c, own);
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
            c.more = more[current];
#endif
    }
    for (camber_u32 k = starts[tile + 1]; k-- > starts[tile];) {
        global const float *shape = shapes + (size_t)CAMBER_SHAPE_WORDS * lists[k];
        ASK_FOR(shapes + (size_t)CAMBER_SHAPE_WORDS * lists[k > AHEAD ? k - AHEAD : 0]);
        const camber_u32 ink = as_uint(shape[CAMBER_SHAPE_INK]);
        if (ink != current) {
            change_ink(&c, inks[ink]);
#if CAMBER_COVER_RICH
            c.more = more[ink];
#endif
            current = ink;
        }
#if CAMBER_COVER_PITCHED
        draw_tilted(&c, shape, planes + (size_t)CAMBER_PLANE_WORDS * lists[k],
                    (tilted_tile){left, top, first, last, s.eye});
#else
        draw_segment(&c, shape, left, top, first, last);
#endif
        if (is_full(&c))
            break;
    }
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
