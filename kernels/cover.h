/* Drawing in OpenCL: what a segment covers of a pixel, in which tiles it does, and how what is covered is put together.
 * shaders/stroke.vert, stroke.frag and flatten.frag say the same of triangles. Only + - * / sqrt and comparisons, so
 * that device and twin agree to the last bit; a camber_real is the sixteen pixels of a cell, or sixteen segments, on
 * the device and one of them in the twin. */
#ifndef CAMBER_COVER_MATHS_H
#define CAMBER_COVER_MATHS_H

#include "layout.h"

/* The host has all there is; what the device is built for, its build says. */
#ifndef CAMBER_COVER_RICH
#define CAMBER_COVER_RICH 0
#endif
#ifndef CAMBER_COVER_PITCHED
#define CAMBER_COVER_PITCHED 0
#endif

/* Of the work-items of a device: 16 where one takes the pixels of a cell, 1 where it takes a pixel, as in the twin. */
#ifndef CAMBER_LANES
#define CAMBER_LANES 16
#endif

#if defined(__OPENCL_VERSION__) && CAMBER_LANES == 16
typedef float16 camber_real;
typedef uint16 camber_words;
typedef int16 camber_mask;
#define CAMBER_TURNS(joins) convert_float16(as_int16((joins) << 16) >> 16)
#else
typedef float camber_real;
typedef camber_u32 camber_words;
typedef int camber_mask;
#define CAMBER_TURNS(joins) ((float)((camber_i32)((joins) << 16) >> 16))
#endif
#define CAMBER_REAL(x) ((camber_real)(x))
#define CAMBER_MORE(a, b) ((a) > (b) ? (a) : (b))
#define CAMBER_LESS(a, b) ((a) < (b) ? (a) : (b))

/* A picture is tiles, each of which is drawn by itself, and a tile is cells of 4 x 4 pixels. */
#define CAMBER_TILE_PX 32
#define CAMBER_CELL_PX 4
#define CAMBER_TILE_CELLS 8               /* a side */
#define CAMBER_TILES_MAX 256              /* a side of what is drawn at once: a box has a byte for each */
#define CAMBER_LOOK_EVERY 16              /* segments of a cell: then it is looked whether it is full */
#define CAMBER_NOTHING_PX (1.0f / 512.0f) /* of what lies below, less than this is not seen */
#define CAMBER_NEVER_PX 1e6f
#define CAMBER_ALWAYS_PX (-1e30f)
#define CAMBER_TIPS_PX 1.85f /* half as wide, the ends of round caps are judged by themselves */
#define CAMBER_FILL_PX 1e6f  /* a fill is a line along y = 0, so long to either side and half so wide */

/* What is kept of a tile between slices of segments, at most: seventeen planes of its pixels, and a few words. */
#define CAMBER_KEPT_BYTES (17 * 4096 + 192)

/* Of a segment that is not drawn: its first tile lies behind the last one. */
#define CAMBER_NO_BOX 0xffu

/* Words of the table of rows. */
#define CAMBER_COVER_ROW_WORDS 4 /* half the width, below 0 where nothing is drawn; x, y translation; the ink */

/* How what is drawn lies over what is below. */
#define CAMBER_INK_OVER 0u  /* segments lie over each other */
#define CAMBER_INK_UNION 1u /* their areas are united first */
#define CAMBER_INK_MASKED                                                                                              \
    2u /* of a layer in which what is translucent replaces what lies below it. CAMBER_COVER_RICH */

/* A colour that segments are drawn in. Layers and groups are put onto what lies below as a whole: 0 is none. A layer
 * lies within its group. */
typedef struct camber_ink {
    float r, g, b, a; /* straight */
    camber_u32 mode, layer, group, spare;
    float layer_opacity, group_opacity, spares[2];
} camber_ink;

/* ---- Shapes: a segment as tiles and pixels read it ---- */

#define CAMBER_SECOND_ENDS 0xd8u /* ends that a second line cuts: miters and bevels, a bit each */
#define CAMBER_CLASS_CAP 0u
#define CAMBER_CLASS_CUT 1u
#define CAMBER_CLASS_TIGHT 2u
#define CAMBER_CLASS_SPLIT 3u

/* Of an end, 13 bits: camber_end 0-2, class 3-4, a tight join's limit 5-11, whether the line ends with the next segment
 * 12. The end at A, then that at B, then: coverage is a ramp. */
#define CAMBER_SHAPE_END_BITS 13
#define CAMBER_SHAPE_LINEAR (1u << 26)
/* Past a split end the segment has what is wide on its inner side too: camber_own_side. */
#define CAMBER_SHAPE_OWN_A (1u << 27)
#define CAMBER_SHAPE_OWN_B (1u << 28)
/* Of its ends: one is cut at a corner or tight, flat, a round cap. */
#define CAMBER_SHAPE_SHARP (1u << 29)
#define CAMBER_SHAPE_FLAT (1u << 30)
#define CAMBER_SHAPE_ROUNDED (1u << 31)

/* Where the words of a shape are. */
#define CAMBER_SHAPE_AX 0u
#define CAMBER_SHAPE_AY 1u
#define CAMBER_SHAPE_BX 2u
#define CAMBER_SHAPE_BY 3u
#define CAMBER_SHAPE_UX 4u
#define CAMBER_SHAPE_UY 5u
#define CAMBER_SHAPE_NAX 6u
#define CAMBER_SHAPE_NAY 7u
#define CAMBER_SHAPE_NBX 8u
#define CAMBER_SHAPE_NBY 9u
#define CAMBER_SHAPE_HALF_WIDTH 10u
#define CAMBER_SHAPE_REACH 11u
#define CAMBER_SHAPE_SLOPE 12u
#define CAMBER_SHAPE_CURVE 13u
#define CAMBER_SHAPE_FLAGS 14u
#define CAMBER_SHAPE_INK 15u
#define CAMBER_SHAPE_WORDS 16u

typedef struct camber_shape {
    camber_real ax, ay, bx, by, ux, uy; /* from A to B, and the direction */
    camber_real nax, nay, nbx, nby;     /* normals of the bisectors at A and B, along the line */
    camber_real half_width, reach;      /* reach: no pixel farther out of the box of A and B is touched */
    camber_real slope, curve;           /* of its edges' area: edge_of in shaders/edge.glsl */
    camber_words flags;
} camber_shape;

/* camber_end, class, limit of a join word's end. kite and fan say at which joins they split by the kind alone. */
CAMBER_FN camber_words camber_shape_end(camber_words join) {
    const camber_words kind = join >> CAMBER_JOIN_KIND_SHIFT, end = join >> CAMBER_JOIN_END_SHIFT & 7u;
    const camber_words split = end == 0u ? (camber_words)(5u) : end == 4u ? (camber_words)(6u) : (camber_words)(7u);
    const camber_words kept = ((kind >= CAMBER_KIND_TIGHT) & (end < 5u)) ? split : end;
    const camber_words class = kind < CAMBER_KIND_CUT ? (camber_words)(0u) : kind - 2u;
    const camber_words limit = kind == CAMBER_KIND_TIGHT ? join >> CAMBER_JOIN_LIMIT_SHIFT & 127u : (camber_words)(0u);
    return kept | class << 3 | limit << 5;
}

/* Whether a segment has more of a split end than its own side of the bisector: of what is wide, as stroke.vert has it.
 * c and s: of half the turn. */
CAMBER_FN camber_mask camber_own_side(camber_words end, camber_real c, camber_real s, camber_real half_width) {
    const camber_real bound = ((end >> 12 & 1u) != 0u ? CAMBER_REAL(0.35f) : CAMBER_REAL(0.6f)) * c;
    return ((end >> 3 & 3u) > CAMBER_CLASS_CUT) & (half_width * CAMBER_FABS(s) > bound);
}

CAMBER_FN camber_words camber_end_flags(camber_words end) {
    const camber_words none = (camber_words)(0u), kind = end & 7u, class = end >> 3 & 3u;
    const camber_mask sharp = (kind == 3u) | (kind == 4u) | (kind > 5u) | (class == CAMBER_CLASS_TIGHT);
    const camber_mask flat = (kind == 1u) | (kind == 2u), rounded = (kind == 0u) & (class == CAMBER_CLASS_CAP);
    return (sharp ? (camber_words)(CAMBER_SHAPE_SHARP) : none) | (flat ? (camber_words)(CAMBER_SHAPE_FLAT) : none) |
           (rounded ? (camber_words)(CAMBER_SHAPE_ROUNDED) : none);
}

/* What is known of the ends before any pixel is. */
CAMBER_FN void camber_shape_judge(camber_shape *s) {
    const camber_words none = (camber_words)(0u), end_a = s->flags & 0x1fffu,
                       end_b = s->flags >> CAMBER_SHAPE_END_BITS & 0x1fffu;
    const camber_real ca = s->nax * s->ux + s->nay * s->uy, sa = s->nax * s->uy - s->nay * s->ux;
    const camber_real cb = s->nbx * s->ux + s->nby * s->uy, sb = s->nby * s->ux - s->nbx * s->uy;
    s->flags |= camber_own_side(end_a, ca, sa, s->half_width) ? (camber_words)(CAMBER_SHAPE_OWN_A) : none;
    s->flags |= camber_own_side(end_b, cb, sb, s->half_width) ? (camber_words)(CAMBER_SHAPE_OWN_B) : none;
    s->flags |= camber_end_flags(end_a) | camber_end_flags(end_b);
}

/* How far an end reaches out of the box of A and B, in units of half the width and the pad. */
CAMBER_FN camber_real camber_shape_reach(camber_words join, camber_real q) {
    const camber_words end = join >> CAMBER_JOIN_END_SHIFT & 7u;
    const camber_real below = 1.0f - q * q;
    const camber_real miter = (1.0f + q * q) / CAMBER_MORE(below, CAMBER_REAL(1e-3f));
    const camber_real corner = end == 0u || end == 1u || end == 5u ? CAMBER_REAL(1.0f) : CAMBER_REAL(1.4143f);
    return ((end == 3u) | (end == 7u)) ? miter : corner;
}

/* Of the segment from A to B that is half_width wide; (px, py) is where the segment before it comes from. Both segments
 * at a join turn the bisector from the direction of the one before: its normal is the same to the last bit. */
CAMBER_FN camber_shape camber_shape_of(camber_real px, camber_real py, camber_real ax, camber_real ay, camber_real bx,
                                       camber_real by, camber_words join_a, camber_words join_b, camber_real half_width,
                                       camber_u32 linear) {
    camber_shape s;
    const camber_real one = CAMBER_REAL(1.0f), none = CAMBER_REAL(0.0f);
    const camber_real dx = bx - ax, dy = by - ay, ex = ax - px, ey = ay - py;
    const camber_real length = CAMBER_SQRT(dx * dx + dy * dy), before = CAMBER_SQRT(ex * ex + ey * ey);
    const camber_real scale = one / (length > 0.0f ? length : one), scale_in = one / (before > 0.0f ? before : one);
    s.ux = length > 0.0f ? dx * scale : one;
    s.uy = length > 0.0f ? dy * scale : none;
    const camber_real ix = before > 0.0f ? ex * scale_in : one, iy = before > 0.0f ? ey * scale_in : none;
    const camber_real qa = CAMBER_TURNS(join_a) * (1.0f / 32767.0f), qb = CAMBER_TURNS(join_b) * (1.0f / 32767.0f);
    const camber_real ta = one / (1.0f + qa * qa), tb = one / (1.0f + qb * qb);
    const camber_real ca = (1.0f - qa * qa) * ta, sa = 2.0f * qa * ta;
    const camber_real cb = (1.0f - qb * qb) * tb, sb = 2.0f * qb * tb;
    const camber_words end_a = camber_shape_end(join_a), end_b = camber_shape_end(join_b);
    const camber_mask cap_a = (end_a >> 3 & 3u) == CAMBER_CLASS_CAP;
    const camber_words soon_a = join_a & CAMBER_JOIN_AFTER_FIRST, soon_b = join_b & CAMBER_JOIN_BEFORE_LAST;
    s.nax = cap_a ? s.ux : ix * ca - iy * sa;
    s.nay = cap_a ? s.uy : ix * sa + iy * ca;
    s.nbx = s.ux * cb - s.uy * sb;
    s.nby = s.ux * sb + s.uy * cb;
    s.ax = ax;
    s.ay = ay;
    s.bx = bx;
    s.by = by;
    s.half_width = half_width;
    const camber_real reach_a = camber_shape_reach(join_a, qa), reach_b = camber_shape_reach(join_b, qb);
    s.reach = (half_width + CAMBER_PAD_PX) * CAMBER_MORE(reach_a, reach_b);
    const camber_real nx = CAMBER_FABS(s.ux), ny = CAMBER_FABS(s.uy);
    const camber_real p = CAMBER_MORE(nx, ny), q = CAMBER_LESS(nx, ny), safe = q > 1e-4f ? q : one;
    s.slope = linear ? one : one / p;
    const camber_real curve = q > 1e-4f ? CAMBER_REAL(0.5f) / (p * safe) : none;
    s.curve = linear ? none : curve;
    s.flags = end_a | soon_a >> 14 | (end_b | soon_b >> 15) << CAMBER_SHAPE_END_BITS;
    s.flags |= linear ? CAMBER_SHAPE_LINEAR : 0u;
    camber_shape_judge(&s);
    return s;
}

/* The tiles that the box of a segment meets: x and y of the first and of the last, a byte each. left and top: where the
 * first tile of what is drawn lies in the picture, px. */
CAMBER_FN camber_words camber_shape_box(const camber_shape *s, camber_mask drawn, float left, float top,
                                        camber_u32 columns, camber_u32 rows) {
    const float a_tile = 1.0f / CAMBER_TILE_PX, right = (float)(columns - 1u), bottom = (float)(rows - 1u);
    /* To the middles of pixels, as cells have it, and a little farther: no cell's own box lies past its tile's. Tiles
     * are counted from the picture's first one before the area's are, so that they are the same in every area. */
    const float inset = 0.4375f, from_x = left * a_tile, from_y = top * a_tile;
    const camber_real none = CAMBER_REAL(0.0f);
    const camber_real x0 = (CAMBER_LESS(s->ax, s->bx) - s->reach + inset) * a_tile - from_x;
    const camber_real x1 = (CAMBER_MORE(s->ax, s->bx) + s->reach - inset) * a_tile - from_x;
    const camber_real y0 = (CAMBER_LESS(s->ay, s->by) - s->reach + inset) * a_tile - from_y;
    const camber_real y1 = (CAMBER_MORE(s->ay, s->by) + s->reach - inset) * a_tile - from_y;
    const camber_mask meets = drawn & (x0 < right + 1.0f) & (y0 < bottom + 1.0f) & (x1 >= 0.0f) & (y1 >= 0.0f);
    const camber_real fx = CAMBER_MORE(x0, none), fy = CAMBER_MORE(y0, none);
    const camber_real lx = x1 < right ? x1 : CAMBER_REAL(right), ly = y1 < bottom ? y1 : CAMBER_REAL(bottom);
#if defined(__OPENCL_VERSION__) && CAMBER_LANES == 16
    const camber_words box = convert_uint16(meets ? fx : none) | convert_uint16(meets ? fy : none) << 8 |
                             convert_uint16(meets ? lx : none) << 16 | convert_uint16(meets ? ly : none) << 24;
#else
    const camber_words box = (camber_u32)(meets ? fx : none) | (camber_u32)(meets ? fy : none) << 8 |
                             (camber_u32)(meets ? lx : none) << 16 | (camber_u32)(meets ? ly : none) << 24;
#endif
    return meets ? box : (camber_words)(CAMBER_NO_BOX);
}

/* ---- Tiles ---- */

/* Of a box's squares in one row of them, tiles or cells of side px, those that a segment's band meets: the first | the
 * last << 8. middle: of the row, px; left: of the first square; shape: its words. */
CAMBER_FN camber_u32 camber_row_span(CAMBER_GLOBAL const float *shape, float middle, float left, camber_u32 first,
                                     camber_u32 last, float side) {
    const float ax = shape[CAMBER_SHAPE_AX], ay = shape[CAMBER_SHAPE_AY], ux = shape[CAMBER_SHAPE_UX],
                uy = shape[CAMBER_SHAPE_UY];
    const float to_middle = 0.5f * side, a_square = 1.0f / side;
    const float slack = 1e-6f * (CAMBER_FABS(ax) + CAMBER_FABS(ay));
    const float reach =
        shape[CAMBER_SHAPE_HALF_WIDTH] + CAMBER_PAD_PX + to_middle * (CAMBER_FABS(ux) + CAMBER_FABS(uy)) + slack;
    if (CAMBER_FABS(uy) < 1e-3f)
        return first | last << 8;
    const float scale = 1.0f / uy, across = (middle - ay) * ux;
    const float one = ax + (across - reach) * scale, other = ax + (across + reach) * scale;
    /* Of the squares' middles. */
    const float from = ((one < other ? one : other) - to_middle) * a_square - left * a_square;
    const float to = ((one < other ? other : one) - to_middle) * a_square - left * a_square;
    if (from > (float)last || to < (float)first)
        return 1u; /* the last lies before the first */
    const camber_u32 begin = from > (float)first ? (camber_u32)from : first;
    return (from > (float)begin ? begin + 1u : begin) | (to < (float)last ? (camber_u32)to : last) << 8;
}

/* Whether the box of a segment lies in one column or in one row of tiles, as camber_shape_box has them before an area's
 * edges cut it. */
CAMBER_FN camber_u32 camber_same_tile(float from, float to) {
    const float a_tile = 1.0f / CAMBER_TILE_PX, least = -1e9f, most = 1e9f, inset = 0.4375f;
    const float a = (from + inset) * a_tile, b = (to - inset) * a_tile;
    const float lower = a < least ? least : a > most ? most : a, upper = b < least ? least : b > most ? most : b;
    const int first = (int)lower, last = (int)upper;
    return first - (lower < (float)first) == last - (upper < (float)last);
}

CAMBER_FN camber_u32 camber_shape_is_narrow(CAMBER_GLOBAL const float *shape) {
    const float ax = shape[CAMBER_SHAPE_AX], ay = shape[CAMBER_SHAPE_AY], bx = shape[CAMBER_SHAPE_BX],
                by = shape[CAMBER_SHAPE_BY], reach = shape[CAMBER_SHAPE_REACH];
    return camber_same_tile(CAMBER_LESS(ax, bx) - reach, CAMBER_MORE(ax, bx) + reach) ||
           camber_same_tile(CAMBER_LESS(ay, by) - reach, CAMBER_MORE(ay, by) + reach);
}

/* An area of the picture: its first tile, px, and its tiles. */
typedef struct camber_tiles {
    float left, top;
    camber_u32 columns, rows;
} camber_tiles;

/* Of a box, the tiles in row y that a segment meets, as camber_row_span has them: boxes of one column or row have all.
 * What lies at the area's edge may be cut, and must be as it is in any other area. */
CAMBER_FN camber_u32 camber_tile_span(CAMBER_GLOBAL const float *shape, camber_u32 box, camber_u32 y,
                                      const camber_tiles *of) {
    const camber_u32 first = box & 255u, last = box >> 16 & 255u, top = box >> 8 & 255u, bottom = box >> 24;
    const camber_u32 all = first | last << 8;
    if ((first == last && first - 1u < of->columns - 2u) || (top == bottom && top - 1u < of->rows - 2u))
        return all;
    if ((first == last || top == bottom) && camber_shape_is_narrow(shape))
        return all;
    const float middle = of->top + ((float)y + 0.5f) * CAMBER_TILE_PX;
    return camber_row_span(shape, middle, of->left, first, last, CAMBER_TILE_PX);
}

/* ---- Pixels ---- */

/* What is constant over a segment. */
typedef struct camber_pen {
    float ax, ay, bx, by, ux, uy, nax, nay, nbx, nby;
    float length, half_width;
    float extent, corner, slope, curve; /* of an edge: edge_of */
    float ca, sa, cb, sb;               /* cosine and sine of half the turns */
    float flat_a, flat_b;               /* where flat caps lie, px past the end */
    float round_a, round_b;             /* from where on ends are round */
    float tip_a, tip_b;                 /* where the round caps of thin lines end */
    float own_a, own_b;                 /* past the bisector, what lies farther than this past the end is the other's */
    float slope_a, slope_b, from_a, from_b; /* of the lines that bound a tight join's inner side */
    camber_u32 end_a, end_b;
    camber_u32 thin, tips, flat, tight, sharp;
} camber_pen;

CAMBER_FN float camber_own_from(camber_u32 end, camber_u32 own) {
    const float own_from = own ? 0.0f : CAMBER_ALWAYS_PX;
    return end & 3u << 3 ? own_from : CAMBER_NEVER_PX;
}

CAMBER_FN float camber_cap_tip(camber_u32 end, float half_width) {
    const float past = half_width > 0.5f ? 1.2f * (half_width - 0.5f) : 0.0f;
    return (end & 31u) == 0u ? 0.5f + 0.785398f * half_width + past : CAMBER_NEVER_PX;
}

/* The line that bounds a tight join's inner side, from the inner vertex, limit px before the end, to the outer one on
 * the bisector. Of other ends it lies nowhere. */
CAMBER_FN void camber_tight_line(camber_u32 end, float c, float s, float half_width, float *slope, float *from) {
    const camber_u32 tight = (end >> 3 & 3u) == CAMBER_CLASS_TIGHT;
    const float reach = half_width + CAMBER_PAD_PX, limit = (float)(end >> 5 & 127u) * (CAMBER_PAD_PX / 127.0f);
    const float scale = 0.5f / (tight ? reach * c : 1.0f), outer = CAMBER_FABS(s) * reach;
    const float more = (outer + limit * c) * scale, less = (outer - limit * c) * scale;
    *slope = tight ? (s > 0.0f ? more : -more) : 0.0f;
    *from = tight ? less * reach : CAMBER_NEVER_PX;
}

/* Through a pointer: oclgrind does not know what compilers make of large results where a call is inlined. Inlined, it
 * makes what its caller needs. */
CAMBER_FN __attribute__((always_inline)) void camber_pen_of(CAMBER_GLOBAL const float *shape, camber_u32 flags,
                                                            camber_pen *p) {
    p->ax = shape[CAMBER_SHAPE_AX];
    p->ay = shape[CAMBER_SHAPE_AY];
    p->bx = shape[CAMBER_SHAPE_BX];
    p->by = shape[CAMBER_SHAPE_BY];
    p->ux = shape[CAMBER_SHAPE_UX];
    p->uy = shape[CAMBER_SHAPE_UY];
    p->nax = shape[CAMBER_SHAPE_NAX];
    p->nay = shape[CAMBER_SHAPE_NAY];
    p->nbx = shape[CAMBER_SHAPE_NBX];
    p->nby = shape[CAMBER_SHAPE_NBY];
    p->half_width = shape[CAMBER_SHAPE_HALF_WIDTH];
    p->slope = shape[CAMBER_SHAPE_SLOPE];
    p->curve = shape[CAMBER_SHAPE_CURVE];
    p->length = (p->bx - p->ax) * p->ux + (p->by - p->ay) * p->uy;
    const float nx = CAMBER_FABS(p->ux), ny = CAMBER_FABS(p->uy), h = p->half_width;
    const camber_u32 linear = flags & CAMBER_SHAPE_LINEAR;
    p->extent = linear ? 0.5f : 0.5f * (nx + ny);
    p->corner = linear ? 0.0f : nx < ny ? nx : ny;
    p->ca = p->nax * p->ux + p->nay * p->uy;
    p->sa = p->nax * p->uy - p->nay * p->ux;
    p->cb = p->nbx * p->ux + p->nby * p->uy;
    p->sb = p->nby * p->ux - p->nbx * p->uy;
    const camber_u32 end_a = flags & 0x1fffu, end_b = flags >> CAMBER_SHAPE_END_BITS & 0x1fffu;
    p->end_a = end_a & 7u;
    p->end_b = end_b & 7u;
    p->flat_a = p->end_a == 1u ? 0.0f : p->end_a == 2u ? h : CAMBER_NEVER_PX;
    p->flat_b = p->end_b == 1u ? 0.0f : p->end_b == 2u ? h : CAMBER_NEVER_PX;
    p->round_a = p->end_a == 0u || p->end_a == 5u ? 0.0f : CAMBER_NEVER_PX;
    p->round_b = p->end_b == 0u || p->end_b == 5u ? 0.0f : CAMBER_NEVER_PX;
    p->tip_a = camber_cap_tip(end_a, h);
    p->tip_b = camber_cap_tip(end_b, h);
    p->own_a = camber_own_from(end_a, flags & CAMBER_SHAPE_OWN_A);
    p->own_b = camber_own_from(end_b, flags & CAMBER_SHAPE_OWN_B);
    p->thin = h < p->extent;
    p->tips = h < CAMBER_TIPS_PX && flags & CAMBER_SHAPE_ROUNDED;
    p->flat = flags & CAMBER_SHAPE_FLAT;
    p->sharp = flags & CAMBER_SHAPE_SHARP;
    const camber_u32 tight_a = (end_a >> 3 & 3u) == CAMBER_CLASS_TIGHT,
                     tight_b = (end_b >> 3 & 3u) == CAMBER_CLASS_TIGHT;
    p->tight = tight_a | tight_b;
    camber_tight_line(end_a, p->ca, p->sa, h, &p->slope_a, &p->from_a);
    camber_tight_line(end_b, p->cb, p->sb, h, &p->slope_b, &p->from_b);
}

/* The area of a pixel whose centre lies s px inside an edge. */
CAMBER_FN camber_real camber_covered(camber_real s, float extent, float corner, float slope, float curve) {
    const camber_real left = extent - CAMBER_FABS(s), rest = left > 0.0f ? left : CAMBER_REAL(0.0f);
    const camber_real bend = rest < corner ? rest : CAMBER_REAL(corner);
    const camber_real area = bend * bend * curve + (rest - bend) * slope;
    return s < 0.0f ? area : 1.0f - area;
}

CAMBER_FN camber_real camber_inside_edge(const camber_pen *p, camber_real s) {
    return camber_covered(s, p->extent, p->corner, p->slope, p->curve);
}

CAMBER_FN camber_real camber_clamp_to_one(camber_real x) {
    const camber_real least = x > 0.0f ? x : CAMBER_REAL(0.0f);
    return least < 1.0f ? least : CAMBER_REAL(1.0f);
}

/* Of the second line across a sharp join: what does not turn over with the end of it that is looked out of. */
typedef struct camber_second {
    camber_u32 bevel, miter;
    float outer, nx, ny; /* the side it lies on; its normal along and across */
} camber_second;

/* second_line of stroke.frag. */
CAMBER_FN void camber_second_of(camber_u32 end, float c, float s, camber_second *l) {
    const float sine = CAMBER_FABS(s);
    l->bevel = end == 4u || end == 6u;
    l->miter = end == 3u || end == 7u;
    l->outer = s > 0.0f ? -1.0f : 1.0f;
    l->nx = l->bevel ? sine : 2.0f * sine * c;
    l->ny = l->bevel ? l->outer * c : l->outer * (c * c - sine * sine);
}

CAMBER_FN camber_real camber_second_inside(const camber_second *l, float half_width, camber_real past, camber_real y,
                                           float c) {
    return (l->bevel ? half_width * c : half_width) - (past * l->nx + y * l->ny);
}

/* cut_join of stroke.frag: (ux, uy) looks out of the end. */
CAMBER_FN camber_real camber_cut_join(camber_real area, const camber_pen *p, camber_u32 end, camber_real past,
                                      camber_real y, float c, float s, float ux, float uy) {
    camber_second l;
    camber_second_of(end, c, s, &l);
    if (!l.bevel && !l.miter)
        return area;
    const camber_real inside = camber_second_inside(&l, p->half_width, past, y, c);
    const float seen_x = CAMBER_FABS(l.nx * ux - l.ny * uy), seen_y = CAMBER_FABS(l.nx * uy + l.ny * ux);
    const float more = seen_x > seen_y ? seen_x : seen_y, less = seen_x > seen_y ? seen_y : seen_x;
    const camber_u32 linear = p->corner == 0.0f && p->extent == 0.5f && p->slope == 1.0f;
    const float extent = linear ? 0.5f : 0.5f * (more + less), slope = linear ? 1.0f : 1.0f / more;
    const float curve = linear || less <= 1e-4f ? 0.0f : 0.5f / (more * less);
    const camber_real second = camber_covered(inside, extent, linear ? 0.0f : less, slope, curve);
    /* The area inside two edges: the smaller, the product, or what both leave, by the angle between them. */
    const float cosine = l.outer * l.ny, weight = CAMBER_FABS(cosine);
    const camber_real smaller = CAMBER_LESS(area, second), product = area * second, both = area + second - 1.0f;
    const camber_real bound = cosine > 0.0f ? smaller : (both > 0.0f ? both : CAMBER_REAL(0.0f));
    const camber_real joined = product * (1.0f - weight) + bound * weight;
    if (l.bevel)
        return joined;
    return ((past > -1.0f) & (y * l.outer > 0.0f)) ? joined : area;
}

CAMBER_FN camber_real camber_cut_joins(const camber_pen *p, camber_real area, camber_real x, camber_real y) {
    area = camber_cut_join(area, p, p->end_a, -x, y, p->ca, p->sa, -p->ux, p->uy);
    return camber_cut_join(area, p, p->end_b, x - p->length, y, p->cb, p->sb, p->ux, p->uy);
}

/* How far past its round ends a pixel lies, px, and how far across the line, with what that bends aside by the joins:
 * x along the segment, y across, fa and fb past the bisectors at A and B. */
CAMBER_FN camber_real camber_pen_off(const camber_pen *p, camber_real x, camber_real y, camber_real fa, camber_real fb,
                                     camber_real *bent) {
    const camber_real none = CAMBER_REAL(0.0f), arc_a = -x - p->round_a, arc_b = x - p->length - p->round_b;
    const camber_real farther = CAMBER_MORE(arc_a, arc_b), arc = farther > 0.0f ? farther : none;
    const camber_real near_a = 0.5f - fa, near_b = 0.5f + fb, straight = 1.0f - arc;
    const camber_real share_a = ((fa < 0.0f) | (near_a < 0.0f)) ? none : near_a;
    const camber_real share_b = ((fb > 0.0f) | (near_b < 0.0f)) ? none : near_b;
    const camber_real bend = p->sa * share_a * share_a + p->sb * share_b * share_b;
    *bent = y - bend * (straight > 0.0f ? straight : none);
    return arc;
}

/* The area of pixels that lies half_width from the line at most, where they lie d from it. */
CAMBER_FN camber_real camber_pen_band(const camber_pen *p, float half_width, camber_real d) {
    const camber_real area = camber_inside_edge(p, half_width - d);
    if (!p->thin)
        return area;
    const camber_real both = area + camber_inside_edge(p, half_width + d) - 1.0f;
    return both > 0.0f ? both : CAMBER_REAL(0.0f);
}

/* What the round caps of thin lines leave of pixels, and flat caps. */
CAMBER_FN camber_real camber_pen_tips(const camber_pen *p, camber_real x) {
    const camber_real past_a = -x, past_b = x - p->length;
    const camber_real tips = camber_clamp_to_one(p->tip_a - past_a) + camber_clamp_to_one(p->tip_b - past_b) - 1.0f;
    return tips > 0.0f ? tips : CAMBER_REAL(0.0f);
}

CAMBER_FN camber_real camber_pen_caps(const camber_pen *p, camber_real x) {
    const camber_u32 at_a = p->flat_a < CAMBER_NEVER_PX, both = at_a && p->flat_b < CAMBER_NEVER_PX;
    const camber_real past_a = -x, past_b = x - p->length;
    const camber_real one = camber_inside_edge(p, at_a ? p->flat_a - past_a : p->flat_b - past_b);
    if (!both)
        return one;
    const camber_real caps = one + camber_inside_edge(p, p->flat_b - past_b) - 1.0f;
    return caps > 0.0f ? caps : CAMBER_REAL(0.0f);
}

/* The area where a pixel is the segment's. */
CAMBER_FN camber_real camber_pen_own(const camber_pen *p, camber_real area, camber_real x, camber_real y,
                                     camber_real fa, camber_real fb) {
    const camber_real past_a = -x, past_b = x - p->length;
    camber_mask foreign = ((fa < 0.0f) & (past_a > p->own_a)) | ((fb >= 0.0f) & (past_b > p->own_b));
    if (p->tight)
        foreign |= (past_a + p->slope_a * y > p->from_a) | (past_b + p->slope_b * y > p->from_b);
    return foreign ? CAMBER_REAL(0.0f) : area;
}

/* The area of pixels that are the segment's. */
CAMBER_FN camber_real camber_pen_area(const camber_pen *p, camber_real x, camber_real y, camber_real fa,
                                      camber_real fb) {
    camber_real bent;
    const camber_real arc = camber_pen_off(p, x, y, fa, fb, &bent);
    camber_real area = camber_pen_band(p, p->half_width, CAMBER_SQRT(arc * arc + bent * bent));
    if (p->tips)
        area *= camber_pen_tips(p, x);
    if (p->sharp)
        area = camber_cut_joins(p, area, x, y);
    if (p->flat)
        area *= camber_pen_caps(p, x);
    return camber_pen_own(p, area, x, y, fa, fb);
}

/* The same where the ends are too far away to matter. */
CAMBER_FN camber_real camber_pen_side(const camber_pen *p, camber_real y) {
    return camber_pen_band(p, p->half_width, CAMBER_FABS(y));
}

/* The normal into the stroke across the nearest edge, in the picture. */
CAMBER_FN void camber_pen_normal(const camber_pen *p, camber_real x, camber_real y, camber_real *nx, camber_real *ny) {
    const camber_real none = CAMBER_REAL(0.0f), past_a = -x, past_b = x - p->length;
    const camber_real arc_a = past_a - p->round_a, arc_b = past_b - p->round_b;
    const camber_real off_x = (arc_b > 0.0f ? arc_b : none) - (arc_a > 0.0f ? arc_a : none);
    const camber_real length = CAMBER_SQRT(off_x * off_x + y * y), least = CAMBER_REAL(1e-3f);
    const camber_real scale = -1.0f / CAMBER_MORE(length, least);
    camber_real in_x = off_x * scale, in_y = y * scale;
    if (p->flat) {
        const camber_real cap_a = p->flat_a - past_a, cap_b = p->flat_b - past_b;
        const camber_mask flat = CAMBER_LESS(cap_a, cap_b) < p->half_width - CAMBER_FABS(y);
        in_x = flat ? (cap_a < cap_b ? CAMBER_REAL(1.0f) : CAMBER_REAL(-1.0f)) : in_x;
        in_y = flat ? none : in_y;
    }
    *nx = in_x * p->ux - in_y * p->uy;
    *ny = in_x * p->uy + in_y * p->ux;
}

/* Of cells, by their middles: which a segment may meet; which of them lie near its ends, so that these matter; which
 * lie all inside the stroke. */
typedef struct camber_meeting {
    camber_mask meets, nears, inside;
} camber_meeting;

CAMBER_FN void camber_cells_meet(const camber_pen *p, camber_real mx, camber_real my, camber_meeting *cells) {
    const float reach = 1.5f * (CAMBER_FABS(p->ux) + CAMBER_FABS(p->uy));
    const float reach_a = 1.5f * (CAMBER_FABS(p->nax) + CAMBER_FABS(p->nay));
    const float reach_b = 1.5f * (CAMBER_FABS(p->nbx) + CAMBER_FABS(p->nby));
    const float far_a = p->own_a == CAMBER_ALWAYS_PX ? -reach_a : CAMBER_ALWAYS_PX;
    const float far_b = p->own_b == CAMBER_ALWAYS_PX ? reach_b : -CAMBER_ALWAYS_PX;
    /* What corners and tight joins cut off may lie far from them. */
    const float near = p->sharp ? CAMBER_NEVER_PX : reach + 0.75f;
    const camber_real qx = mx - p->ax, qy = my - p->ay, rx = mx - p->bx, ry = my - p->by;
    const camber_real x = qx * p->ux + qy * p->uy, aside = CAMBER_FABS(qy * p->ux - qx * p->uy);
    const camber_real fa = qx * p->nax + qy * p->nay, fb = rx * p->nbx + ry * p->nby;
    /* A join bends the edge outwards by so much: camber_pen_off. */
    const float bend_a = CAMBER_FABS(p->sa), bend_b = CAMBER_FABS(p->sb), bend = 0.25f * CAMBER_MORE(bend_a, bend_b);
    cells->meets = (aside < p->half_width + p->extent + reach + bend) & (fa >= far_a) & (fb < far_b);
    cells->nears = (x < near) | (x > p->length - near) | (fa < reach_a + 0.5f) | (fb > -0.5f - reach_b);
    cells->inside = aside <= p->half_width - p->extent - reach;
}

/* ---- Layers ---- */

/* The area under all strokes of a pixel, from the sum of their areas a, what they cover one over the other, and the sum
 * of their normals by a (1 - a): flatten.frag. */
CAMBER_FN camber_real camber_united(camber_real over, camber_real sum, camber_real nx, camber_real ny) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f), tiny = CAMBER_REAL(1e-6f);
    const camber_real excess = sum - over, inner = sum * sum - 4.0f * (excess > 0.0f ? excess : none);
    const camber_real root = CAMBER_SQRT(inner > 0.0f ? inner : none);
    const camber_real large = 0.5f * (sum + root), small = 0.5f * (sum - root);
    const camber_real more = large < 1.0f ? large : one, less = camber_clamp_to_one(small);
    const camber_real a = more * (1.0f - more), b = less * (1.0f - less), below = 2.0f * a * b;
    const camber_real slant = (nx * nx + ny * ny - a * a - b * b) / CAMBER_MORE(below, tiny);
    const camber_real bounded = slant < 1.0f ? slant : one, cosine = bounded > -1.0f ? bounded : -one;
    const camber_real apart = sum < 1.0f ? sum : one, target = cosine < 0.0f ? apart : more;
    const camber_real weight = CAMBER_FABS(cosine), area = over * (1.0f - weight) + target * weight;
    return sum <= over ? over : (area > 0.99f ? one : area);
}

#ifdef __OPENCL_VERSION__
typedef char camber_ink_is_48_bytes[sizeof(camber_ink) == 48 ? 1 : -1];
#else
_Static_assert(sizeof(camber_ink) == 48, "the device reads inks of 48 bytes");
#endif

#endif
