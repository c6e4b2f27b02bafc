/* The rasterizer's segment: its words and flags, and the tiles that it touches.
 *
 * Input: the points before A, A and B with their join words, and the row that the segment is drawn by. Output:
 * camber_segment, the 16 words that all later stages read, and the box of tiles around it. Only + - * / sqrt and
 * comparisons are used, so that device and twin agree to the last bit. A camber_real has a segment, or a pixel,
 * in each of its lanes: lanes.h. */
#ifndef CAMBER_KERNELS_SEGMENT_H
#define CAMBER_KERNELS_SEGMENT_H

#include "raster_args.h"
#include "stroke.h"

/* A picture is cut into tiles, which are drawn independently, and a tile into cells of 4 x 4 pixels. */
#define CAMBER_TILE_PX 32
#define CAMBER_CELL_PX 4
#define CAMBER_TILE_CELLS 8               /* along each side of a tile */
#define CAMBER_TILES_MAX 256              /* along each side of an area: a box has a byte for each */
#define CAMBER_LOOK_EVERY 16              /* a cell is checked for being full after so many segments */
#define CAMBER_NOTHING_PX (1.0f / 512.0f) /* where less than this shows through, what lies below is not drawn */
#define CAMBER_FILL_PX 1e6f /* a fill is a line along y = 0 that is this long to either side, and this half width */

/* The most bytes that a tile spills between slices: seventeen planes of its pixels, and a few words. */
#define CAMBER_SPILL_BYTES (17 * 4096 + 192)

/* The box of a segment that is not drawn: its first tile lies behind the last one. */
#define CAMBER_NO_BOX 0xffu

/* Words of a row of the rasterizer's table. */
#define CAMBER_RASTER_ROW_WORDS 4 /* half width, px, below 0: not drawn; x, y translation, px; brush number */

/* How a brush's segments come together. */
#define CAMBER_BRUSH_OVER 0u  /* each is drawn over the others */
#define CAMBER_BRUSH_UNION 1u /* their areas are united first, and drawn once */
#define CAMBER_BRUSH_MASKED                                                                                            \
    2u /* in a masked layer, a translucent colour replaces what lies below it; only CAMBER_RASTER_RICH */

/* A colour and mode that segments are drawn with. Layers and groups are put onto what lies below as a whole; number 0
 * is none. A layer belongs to one group. */
typedef struct camber_brush {
    float r, g, b, a; /* not premultiplied */
    camber_u32 mode, layer, group, spare;
    float layer_opacity, group_opacity, spares[2];
} camber_brush;

/* ---- A segment as tiles and pixels read it ---- */

/* The words of a segment, in the order in which setup writes them. */
#define CAMBER_SEGMENT_AX 0u
#define CAMBER_SEGMENT_AY 1u
#define CAMBER_SEGMENT_BX 2u
#define CAMBER_SEGMENT_BY 3u
#define CAMBER_SEGMENT_UX 4u
#define CAMBER_SEGMENT_UY 5u
#define CAMBER_SEGMENT_NAX 6u
#define CAMBER_SEGMENT_NAY 7u
#define CAMBER_SEGMENT_NBX 8u
#define CAMBER_SEGMENT_NBY 9u
#define CAMBER_SEGMENT_HALF_WIDTH 10u
#define CAMBER_SEGMENT_REACH 11u
#define CAMBER_SEGMENT_SLOPE 12u
#define CAMBER_SEGMENT_CURVE 13u
#define CAMBER_SEGMENT_FLAGS 14u
#define CAMBER_SEGMENT_BRUSH 15u
#define CAMBER_SEGMENT_WORDS 16u

typedef struct camber_segment {
    camber_real ax, ay, bx, by, ux, uy; /* A, B, and the direction from A to B */
    camber_real nax, nay, nbx, nby;     /* normals of the bisectors at A and B, which point along the line */
    camber_real half_width, reach; /* reach: no pixel is touched farther than this, px, outside the box of A and B */
    camber_real slope, curve;      /* how its sides cut pixels: camber_profile_of */
    camber_words flags;
} camber_segment;

CAMBER_FN camber_words camber_end_flags(camber_words end) {
    const camber_words none = (camber_words)(0u), kind = CAMBER_END_KIND(end), ends_as = CAMBER_END_CLASS(end);
    const camber_mask sharp =
        (kind == CAMBER_ENDS_MITER) | (kind == CAMBER_ENDS_BEVEL) | (kind > CAMBER_ENDS_SPLIT_ROUND);
    const camber_mask flat = (kind == CAMBER_ENDS_BUTT) | (kind == CAMBER_ENDS_SQUARE) | (CAMBER_END_FLAT(end) != 0u),
                      rounded = (kind == CAMBER_ENDS_ROUND) & (ends_as == CAMBER_CLASS_CAP);
    return (sharp ? (camber_words)(CAMBER_SEGMENT_SHARP) : none) | (flat ? (camber_words)(CAMBER_SEGMENT_FLAT) : none) |
           (rounded ? (camber_words)(CAMBER_SEGMENT_ROUNDED) : none);
}

/* The bits of an end. soon: whether the line ends with the next segment; length: of the segment itself; c and s: cosine
 * and sine of half the turn. *own: camber_owner_side. */
CAMBER_FN camber_words camber_end_of(camber_words join, camber_mask soon, camber_real length, camber_real c,
                                     camber_real s, camber_real half_width, camber_mask *own) {
    const camber_words none = (camber_words)(0u), end = camber_segment_end(join);
    const camber_mask butt = soon & (CAMBER_JOIN_STUB(join) != 0u);
    *own = (CAMBER_END_CLASS(end) > CAMBER_CLASS_CUT) & camber_owner_side(soon, butt, c, s, half_width);
    return end | camber_flat_join(join, butt, *own, length) |
           (soon ? (camber_words)(1u << CAMBER_END_LAST_SHIFT) : none);
}

/* How far an end reaches outside the box of A and B, in units of half width + pad. */
CAMBER_FN camber_real camber_segment_reach(camber_words join, camber_real q) {
    const camber_words end = join >> CAMBER_JOIN_END_SHIFT & CAMBER_JOIN_END_MASK;
    const camber_real below = 1.0f - q * q;
    const camber_real miter = (1.0f + q * q) / CAMBER_MORE(below, CAMBER_REAL(1e-3f));
    const camber_real corner = end == CAMBER_ENDS_ROUND || end == CAMBER_ENDS_BUTT || end == CAMBER_ENDS_SPLIT_ROUND
                                   ? CAMBER_REAL(1.0f)
                                   : CAMBER_REAL(1.4143f);
    return ((end == CAMBER_ENDS_MITER) | (end == CAMBER_ENDS_SPLIT_MITER)) ? miter : corner;
}

/* Makes the segment from A to B, which is half_width to either side. (px, py) is where the segment before it begins.
 * Both segments at a join turn the bisector from the direction of the first, so that both get the same bits for its
 * normal. */
CAMBER_FN camber_segment camber_segment_of(camber_real px, camber_real py, camber_real ax, camber_real ay,
                                           camber_real bx, camber_real by, camber_words join_a, camber_words join_b,
                                           camber_real half_width, camber_u32 linear) {
    camber_segment s;
    const camber_real one = CAMBER_REAL(1.0f), none = CAMBER_REAL(0.0f);
    const camber_real dx = bx - ax, dy = by - ay, ex = ax - px, ey = ay - py;
    const camber_real length = CAMBER_SQRT(dx * dx + dy * dy), before = CAMBER_SQRT(ex * ex + ey * ey);
    const camber_real scale = one / (length > 0.0f ? length : one), scale_in = one / (before > 0.0f ? before : one);
    s.ux = length > 0.0f ? dx * scale : one;
    s.uy = length > 0.0f ? dy * scale : none;
    const camber_real ix = before > 0.0f ? ex * scale_in : one, iy = before > 0.0f ? ey * scale_in : none;
    const camber_real qa = camber_quarter_turn(join_a), qb = camber_quarter_turn(join_b);
    camber_real ca, sa, cb, sb;
    camber_half_turn(qa, &ca, &sa);
    camber_half_turn(qb, &cb, &sb);
    const camber_mask soon_a = (join_a & CAMBER_JOIN_AFTER_FIRST) != 0u,
                      soon_b = (join_b & CAMBER_JOIN_BEFORE_LAST) != 0u;
    camber_mask own_a, own_b;
    const camber_words end_a = camber_end_of(join_a, soon_a, length, ca, sa, half_width, &own_a);
    const camber_words end_b = camber_end_of(join_b, soon_b, length, cb, sb, half_width, &own_b);
    const camber_mask cap_a = CAMBER_END_CLASS(end_a) == CAMBER_CLASS_CAP;
    s.nax = cap_a ? s.ux : ix * ca - iy * sa;
    s.nay = cap_a ? s.uy : ix * sa + iy * ca;
    s.nbx = s.ux * cb - s.uy * sb;
    s.nby = s.ux * sb + s.uy * cb;
    s.ax = ax;
    s.ay = ay;
    s.bx = bx;
    s.by = by;
    s.half_width = half_width;
    const camber_real reach_a = camber_segment_reach(join_a, qa), reach_b = camber_segment_reach(join_b, qb);
    s.reach = (half_width + CAMBER_PAD_PX) * CAMBER_MORE(reach_a, reach_b);
    camber_profiles side;
    camber_profile_of(s.ux, s.uy, CAMBER_ALL_LANES(linear), &side);
    s.slope = side.slope;
    s.curve = side.curve;
    const camber_words nothing = (camber_words)(0u);
    s.flags = end_a | end_b << CAMBER_SEGMENT_END_BITS | camber_end_flags(end_a) | camber_end_flags(end_b);
    s.flags |= own_a ? (camber_words)(CAMBER_SEGMENT_OWNER_A) : nothing;
    s.flags |= own_b ? (camber_words)(CAMBER_SEGMENT_OWNER_B) : nothing;
    s.flags |= linear ? CAMBER_SEGMENT_LINEAR : 0u;
    return s;
}

/* The box of tiles that a segment may touch: x and y of the first tile, then x and y of the last, a byte each. left and
 * top: where the area's first tile lies in the picture, px. */
CAMBER_FN camber_words camber_segment_box(const camber_segment *s, camber_mask drawn, float left, float top,
                                          camber_u32 columns, camber_u32 rows) {
    const float a_tile = 1.0f / CAMBER_TILE_PX, right = (float)(columns - 1u), bottom = (float)(rows - 1u);
    /* The box reaches to the middles of pixels, and a little farther, so that no cell's box lies outside its tile's.
     * Tiles are counted from the picture's first one, and then from the area's, so that every area finds the same. */
    const float inset = 0.4375f, from_x = left * a_tile, from_y = top * a_tile;
    const camber_real none = CAMBER_REAL(0.0f);
    const camber_real x0 = (CAMBER_LESS(s->ax, s->bx) - s->reach + inset) * a_tile - from_x;
    const camber_real x1 = (CAMBER_MORE(s->ax, s->bx) + s->reach - inset) * a_tile - from_x;
    const camber_real y0 = (CAMBER_LESS(s->ay, s->by) - s->reach + inset) * a_tile - from_y;
    const camber_real y1 = (CAMBER_MORE(s->ay, s->by) + s->reach - inset) * a_tile - from_y;
    const camber_mask meets = drawn & (x0 < right + 1.0f) & (y0 < bottom + 1.0f) & (x1 >= 0.0f) & (y1 >= 0.0f);
    const camber_real fx = CAMBER_MORE(x0, none), fy = CAMBER_MORE(y0, none);
    const camber_real lx = x1 < right ? x1 : CAMBER_REAL(right), ly = y1 < bottom ? y1 : CAMBER_REAL(bottom);
    const camber_words box = CAMBER_TO_WORDS(meets ? fx : none) | CAMBER_TO_WORDS(meets ? fy : none) << 8 |
                             CAMBER_TO_WORDS(meets ? lx : none) << 16 | CAMBER_TO_WORDS(meets ? ly : none) << 24;
    return meets ? box : (camber_words)(CAMBER_NO_BOX);
}

/* ---- Tiles ---- */

/* The words of a segment that say which tiles it touches, in all lanes the same. */
CAMBER_FN void camber_segment_place(CAMBER_GLOBAL const float *segment, camber_segment *s) {
    s->ax = CAMBER_REAL(segment[CAMBER_SEGMENT_AX]);
    s->ay = CAMBER_REAL(segment[CAMBER_SEGMENT_AY]);
    s->bx = CAMBER_REAL(segment[CAMBER_SEGMENT_BX]);
    s->by = CAMBER_REAL(segment[CAMBER_SEGMENT_BY]);
    s->ux = CAMBER_REAL(segment[CAMBER_SEGMENT_UX]);
    s->uy = CAMBER_REAL(segment[CAMBER_SEGMENT_UY]);
    s->half_width = CAMBER_REAL(segment[CAMBER_SEGMENT_HALF_WIDTH]);
    s->reach = CAMBER_REAL(segment[CAMBER_SEGMENT_REACH]);
}

/* All that lies within reach of a segment's endless line, as rows of tiles cut it. */
typedef struct camber_slab {
    camber_real ax, ay, ux, scale, reach; /* ux: x of the direction; scale: 1 over its y; reach: px */
    camber_mask level;                    /* it runs along the row, and may touch all of it */
} camber_slab;

CAMBER_FN void camber_slab_of(const camber_segment *s, camber_slab *slab) {
    const float to_middle = 0.5f * CAMBER_TILE_PX;
    const camber_real one = CAMBER_REAL(1.0f), slack = 1e-6f * (CAMBER_FABS(s->ax) + CAMBER_FABS(s->ay));
    slab->ax = s->ax;
    slab->ay = s->ay;
    slab->ux = s->ux;
    slab->level = CAMBER_FABS(s->uy) < 1e-3f;
    slab->scale = one / (slab->level ? one : s->uy);
    slab->reach = s->half_width + CAMBER_PAD_PX + to_middle * (CAMBER_FABS(s->ux) + CAMBER_FABS(s->uy)) + slack;
}

/* Columns of tiles [first, last]; none where the last lies before the first. */
typedef struct camber_tile_range {
    camber_words first, last;
} camber_tile_range;

/* The tiles of one row of a box that a slab touches. box: the columns that the box has. middle: y of the row's middle,
 * px; left: where the first column begins, px. */
CAMBER_FN camber_tile_range camber_slab_in_row(const camber_slab *s, camber_tile_range box, camber_real middle,
                                               float left) {
    const float to_middle = 0.5f * CAMBER_TILE_PX, a_tile = 1.0f / CAMBER_TILE_PX;
    const camber_real across = (middle - s->ay) * s->ux;
    const camber_real before = s->ax + (across - s->reach) * s->scale, behind = s->ax + (across + s->reach) * s->scale;
    /* Counted from the tiles' middles. */
    const camber_real from = (CAMBER_LESS(before, behind) - to_middle) * a_tile - left * a_tile;
    const camber_real to = (CAMBER_MORE(before, behind) - to_middle) * a_tile - left * a_tile;
    const camber_real first = CAMBER_TO_REAL(CAMBER_AS_INTEGERS(box.first)),
                      last = CAMBER_TO_REAL(CAMBER_AS_INTEGERS(box.last));
    const camber_mask none = (from > last) | (to < first);
    const camber_real begin = CAMBER_MORE(from, first), end = CAMBER_LESS(to, last);
    const camber_words lowest = CAMBER_TO_WORDS(none ? last : begin), highest = CAMBER_TO_WORDS(none ? first : end);
    const camber_words past = CAMBER_TO_REAL(CAMBER_AS_INTEGERS(lowest)) < from ? lowest + 1u : lowest;
    camber_tile_range tiles;
    tiles.first = s->level ? box.first : none ? box.last + 1u : past;
    tiles.last = s->level ? box.last : highest;
    return tiles;
}

/* Whether from and to lie in the same column, or row, of tiles, as camber_segment_box counts them before the area's
 * edges cut the box. */
CAMBER_FN camber_mask camber_same_tile(camber_real from, camber_real to) {
    const float a_tile = 1.0f / CAMBER_TILE_PX, inset = 0.4375f;
    const camber_real least = CAMBER_REAL(-1e9f), most = CAMBER_REAL(1e9f);
    const camber_mask none = CAMBER_TO_INTEGERS(CAMBER_REAL(0.0f)), one = CAMBER_TO_INTEGERS(CAMBER_REAL(1.0f));
    const camber_real a = (from + inset) * a_tile, b = (to - inset) * a_tile;
    const camber_real lower = a < least ? least : a > most ? most : a, upper = b < least ? least : b > most ? most : b;
    const camber_mask first = CAMBER_TO_INTEGERS(lower), last = CAMBER_TO_INTEGERS(upper);
    const camber_mask first_down = lower < CAMBER_TO_REAL(first) ? one : none;
    const camber_mask last_down = upper < CAMBER_TO_REAL(last) ? one : none;
    return first - first_down == last - last_down;
}

/* Whether the box of a segment lies in one column or in one row of tiles. */
CAMBER_FN camber_mask camber_segment_is_narrow(const camber_segment *s) {
    const camber_real x0 = CAMBER_LESS(s->ax, s->bx) - s->reach, x1 = CAMBER_MORE(s->ax, s->bx) + s->reach;
    const camber_real y0 = CAMBER_LESS(s->ay, s->by) - s->reach, y1 = CAMBER_MORE(s->ay, s->by) + s->reach;
    return camber_same_tile(x0, x1) | camber_same_tile(y0, y1);
}

/* The four bytes of a box: camber_segment_box. */
#define CAMBER_BOX_FIRST_X(box) ((box)&255u)
#define CAMBER_BOX_FIRST_Y(box) ((box) >> 8 & 255u)
#define CAMBER_BOX_LAST_X(box) ((box) >> 16 & 255u)
#define CAMBER_BOX_LAST_Y(box) ((box) >> 24)

/* Whether a segment touches all tiles of its box. It does where that has one column or row. At the area's edge the box
 * may be cut, but what it touches must be as in any other area. */
CAMBER_FN camber_mask camber_touches_all(const camber_segment *s, camber_words box, const camber_tile_grid *of) {
    const camber_words x0 = CAMBER_BOX_FIRST_X(box), y0 = CAMBER_BOX_FIRST_Y(box), one = (camber_words)(1u);
    const camber_mask column = x0 == CAMBER_BOX_LAST_X(box), row = y0 == CAMBER_BOX_LAST_Y(box);
    const camber_mask inside = (column & (x0 - one < of->columns - 2u)) | (row & (y0 - one < of->rows - 2u));
    if (!CAMBER_ANY((box != CAMBER_NO_BOX) & (column | row) & (inside == 0)))
        return inside;
    return inside | ((column | row) & camber_segment_is_narrow(s));
}

/* The tiles of row y of a box that a segment touches. whole: camber_touches_all. */
CAMBER_FN camber_tile_range camber_tiles_in_row(const camber_slab *s, camber_words box, camber_mask whole,
                                                camber_words y, const camber_tile_grid *of) {
    const camber_tile_range row = {CAMBER_BOX_FIRST_X(box), CAMBER_BOX_LAST_X(box)};
    const camber_real middle = of->top + (CAMBER_TO_REAL(CAMBER_AS_INTEGERS(y)) + 0.5f) * CAMBER_TILE_PX;
    camber_tile_range tiles = camber_slab_in_row(s, row, middle, of->left);
    tiles.first = whole ? row.first : tiles.first;
    tiles.last = whole ? row.last : tiles.last;
    return tiles;
}

/* The tiles that segments touch, as bits: eight columns of four rows from the first tile of the box on. In a larger box
 * all bits are set, and camber_tiles_in_row has to be asked row by row. */
#define CAMBER_TILE_BITS_COLUMNS 8u
#define CAMBER_TILE_BITS_ROWS 4u
#define CAMBER_TILE_BITS_ASK 0xffffffffu

CAMBER_FN camber_words camber_tile_bits(const camber_segment *s, camber_words box, const camber_tile_grid *of) {
    const camber_words none = (camber_words)(0u), one = (camber_words)(1u), two = (camber_words)(2u);
    const camber_words x0 = CAMBER_BOX_FIRST_X(box), y0 = CAMBER_BOX_FIRST_Y(box);
    const camber_words across = CAMBER_BOX_LAST_X(box) - x0, down = CAMBER_BOX_LAST_Y(box) - y0;
    const camber_mask drawn = box != CAMBER_NO_BOX, whole = camber_touches_all(s, box, of);
    const camber_mask large = drawn & ((across >= CAMBER_TILE_BITS_COLUMNS) | (down >= CAMBER_TILE_BITS_ROWS));
    camber_words bits = drawn ? one : none;
    if (CAMBER_ANY(drawn & (((across | down) != 0u) | (whole == 0)))) {
        camber_slab slab;
        camber_slab_of(s, &slab);
        bits = none;
        for (camber_u32 j = 0; j < CAMBER_TILE_BITS_ROWS; j++) {
            const camber_mask has_row = drawn & (large == 0) & (down >= j);
            if (!CAMBER_ANY(has_row))
                break;
            const camber_tile_range tiles = camber_tiles_in_row(&slab, box, whole, y0 + j, of);
            const camber_words first = tiles.first - x0, last = tiles.last - x0;
            const camber_words row = ((two << (last & 7u)) - (one << (first & 7u))) << (CAMBER_TILE_BITS_COLUMNS * j);
            bits |= has_row & (tiles.first <= tiles.last) ? row : none;
        }
    }
    return large ? (camber_words)(CAMBER_TILE_BITS_ASK) : bits;
}

#ifdef CAMBER_DEVICE
typedef char camber_brush_is_48_bytes[sizeof(camber_brush) == 48 ? 1 : -1];
#else
_Static_assert(sizeof(camber_brush) == 48, "the device reads brushes of 48 bytes");
#endif

#endif
