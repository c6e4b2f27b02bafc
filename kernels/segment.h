/* The rasterizer's segment: its words and flags, and the tiles that it touches.
 *
 * Input: the point before A, A and B with their join words, and the row that the segment is drawn with. Output:
 * camber_segment, the 16 words that all later stages read, and the box of tiles around it. Only + - * / sqrt and
 * comparisons are used, so that device and twin agree to the last bit. A camber_real has a segment, or a pixel, in each
 * of its lanes: lanes.h. */
#ifndef CAMBER_KERNELS_SEGMENT_H
#define CAMBER_KERNELS_SEGMENT_H

#include "raster_args.h"
#include "stroke.h"

/* A picture is cut into tiles, which are drawn independently, and a tile into cells of 4 x 4 pixels. */
#define CAMBER_TILE_PX 32
#define CAMBER_CELL_PX 4
#define CAMBER_TILE_CELLS 8               /* cells along each side of a tile */
#define CAMBER_TILES_MAX 256              /* tiles along each side of an area: a box has a byte for each coordinate */
#define CAMBER_FULL_CHECK_INTERVAL 16     /* after this many segments, a cell is checked for being full */
#define CAMBER_NOTHING_PX (1.0f / 512.0f) /* if less than this shows through, nothing below is drawn */

/* The box of a segment that is not drawn: its first tile is after the last one. */
#define CAMBER_NO_BOX 0xffu

/* Words of a row of the rasterizer's table. */
#define CAMBER_RASTER_ROW_WORDS 4 /* half width, px, below 0: not drawn; x, y translation, px; brush number */
/* The half width that marks the edge of a ring, and how far around the box of its ends tiles have to list it, in px. */
#define CAMBER_EDGE_PX 0.0f
#define CAMBER_EDGE_REACH_PX 0.5f
/* The middles of pixels are half a pixel inside their tile; a sixteenth is left for rounding. */
#define CAMBER_INSET_PX 0.4375f

/* How a brush's segments are combined. */
#define CAMBER_BRUSH_OVER 0u  /* each is drawn over the others */
#define CAMBER_BRUSH_UNION 1u /* their union is computed first, and drawn once */
#define CAMBER_BRUSH_MASKED                                                                                            \
    2u /* in a masked layer, a translucent colour replaces what is below it; only CAMBER_RASTER_RICH */
#define CAMBER_BRUSH_SUM 3u  /* each is drawn over the others, and their area times the brush's red is added up */
#define CAMBER_BRUSH_AREA 4u /* they are the edges of rings, and their inside is drawn: area.h */
#define CAMBER_BRUSH_AREA_EVENODD 5u /* the same, by CAMBER_FILL_EVENODD */

/* A colour and mode that segments are drawn with. Layers and groups are composited as a whole; number 0 is none. A
 * layer belongs to one group. A fill of the picture is an area without edges, inside which all of the picture is: only
 * its brush exists. If there are fills, brush 0 draws nothing, and its fill is the topmost one.
 *
 * If a brush is a sum, all of them are. Nothing hides anything then, and pixels are floats instead of colours. */
typedef struct camber_brush {
    float r, g, b, a;                    /* not premultiplied */
    camber_u32 mode, layer, group, fill; /* fill: the brush of the next fill below this one. 0: none */
    float layer_opacity, group_opacity, spares[2];
} camber_brush;

/* Returns how many changes of the brush, given as slots in ascending order, are at a slot or before it. */
CAMBER_FN camber_u32 camber_changes_until(CAMBER_GLOBAL const camber_u32 *changes, camber_u32 count, camber_u32 slot) {
    camber_u32 low = 0u, high = count;
    while (low < high) {
        const camber_u32 middle = low + (high - low) / 2u;
        if (changes[middle] <= slot)
            low = middle + 1u;
        else
            high = middle;
    }
    return low;
}

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

/* The edges of rings are stored apart from segments, in groups of sixteen: first the ends of each, ax, ay, bx, by, then
 * the brushes of all. An edge has the number of its segment, whose own words are not used. A segment of a line that is
 * among edges has CAMBER_NO_EDGE in place of its brush, and so have edges that are not drawn. */
#define CAMBER_SIXTEEN_EDGES_WORDS 80u
#define CAMBER_NO_EDGE 0xffffffffu

/* Return the word at which the ends of edge i are, and the word of its brush. */
CAMBER_FN size_t camber_edge_ends(size_t i) {
    return CAMBER_SIXTEEN_EDGES_WORDS * (i / 16u) + 4u * (i % 16u);
}

CAMBER_FN size_t camber_edge_brush(size_t i) {
    return CAMBER_SIXTEEN_EDGES_WORDS * (i / 16u) + 64u + i % 16u;
}

/* An entry of a list is the number of a segment or edge, or, with CAMBER_LISTED_BUNCH, that of the first edge of a
 * bunch: all edges of one sixteen that have its brush. */
#define CAMBER_LISTED_BUNCH 0x80000000u

/* Returns the number of the segment or edge that an entry names. */
CAMBER_FN size_t camber_listed(camber_u32 entry) {
    return entry & ~CAMBER_LISTED_BUNCH;
}

typedef struct camber_segment {
    camber_real ax, ay, bx, by, ux, uy; /* A, B, and the direction from A to B */
    camber_real nax, nay, nbx, nby;     /* normals of the bisectors at A and B, pointing along the line */
    camber_real half_width, reach; /* reach: no pixel farther than this, in px, outside the box of A and B is touched */
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

/* Returns how far an end reaches outside the box of A and B, in units of half width + pad. */
CAMBER_FN camber_real camber_segment_reach(camber_words join, camber_real q) {
    const camber_words end = join >> CAMBER_JOIN_END_SHIFT & CAMBER_JOIN_END_MASK;
    const camber_real below = 1.0f - q * q;
    const camber_real miter = (1.0f + q * q) / CAMBER_MORE(below, CAMBER_REAL(1e-3f));
    const camber_real corner = end == CAMBER_ENDS_ROUND || end == CAMBER_ENDS_BUTT || end == CAMBER_ENDS_SPLIT_ROUND
                                   ? CAMBER_REAL(1.0f)
                                   : CAMBER_REAL(CAMBER_DIAGONAL);
    return ((end == CAMBER_ENDS_MITER) | (end == CAMBER_ENDS_SPLIT_MITER)) ? miter : corner;
}

/* Computes the direction of a vector; a dot has the direction of the x axis. Returns its length. */
CAMBER_FN camber_real camber_direction(camber_real dx, camber_real dy, camber_real *ux, camber_real *uy) {
    const camber_real one = CAMBER_REAL(1.0f), none = CAMBER_REAL(0.0f), length = CAMBER_SQRT(dx * dx + dy * dy);
    const camber_real scale = one / (length > 0.0f ? length : one);
    *ux = length > 0.0f ? dx * scale : one;
    *uy = length > 0.0f ? dy * scale : none;
    return length;
}

/* Makes the segment from A to B, which is half_width to either side. (px, py) is where the segment before it begins.
 * Both segments at a join compute the bisector from the direction of the first one, so that both get the same bits for
 * its normal. */
CAMBER_FN void camber_segment_of(camber_real px, camber_real py, camber_real ax, camber_real ay, camber_real bx,
                                 camber_real by, camber_words join_a, camber_words join_b, camber_real half_width,
                                 camber_u32 linear, camber_segment *s) {
    camber_real ix, iy;
    camber_direction(ax - px, ay - py, &ix, &iy);
    const camber_real length = camber_direction(bx - ax, by - ay, &s->ux, &s->uy);
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
    s->nax = cap_a ? s->ux : ix * ca - iy * sa;
    s->nay = cap_a ? s->uy : ix * sa + iy * ca;
    s->nbx = s->ux * cb - s->uy * sb;
    s->nby = s->ux * sb + s->uy * cb;
    s->ax = ax;
    s->ay = ay;
    s->bx = bx;
    s->by = by;
    s->half_width = half_width;
    const camber_real reach_a = camber_segment_reach(join_a, qa), reach_b = camber_segment_reach(join_b, qb);
    s->reach = (half_width + CAMBER_PAD_PX) * CAMBER_MORE(reach_a, reach_b);
    camber_profiles side;
    camber_profile_of(s->ux, s->uy, CAMBER_ALL_LANES(linear), &side);
    s->slope = side.slope;
    s->curve = side.curve;
    const camber_words nothing = (camber_words)(0u);
    s->flags = end_a | end_b << CAMBER_SEGMENT_END_BITS | camber_end_flags(end_a) | camber_end_flags(end_b);
    s->flags |= own_a ? (camber_words)(CAMBER_SEGMENT_OWNER_A) : nothing;
    s->flags |= own_b ? (camber_words)(CAMBER_SEGMENT_OWNER_B) : nothing;
    s->flags |= linear ? CAMBER_SEGMENT_LINEAR : 0u;
}

/* Makes the edge of a ring from A to B: a segment without width, joins and sides, of which only ends and direction
 * count. */
CAMBER_FN void camber_edge_segment(camber_real ax, camber_real ay, camber_real bx, camber_real by, camber_segment *s) {
    camber_direction(bx - ax, by - ay, &s->ux, &s->uy);
    s->ax = ax;
    s->ay = ay;
    s->bx = bx;
    s->by = by;
    s->half_width = CAMBER_REAL(CAMBER_EDGE_PX);
    s->reach = CAMBER_REAL(CAMBER_EDGE_REACH_PX);
}

/* Returns the box of tiles that a segment may touch: x and y of the first tile, then x and y of the last, one byte
 * each. left and top: position of the area's first tile in the picture, in px. */
CAMBER_FN camber_words camber_segment_box(const camber_segment *s, camber_mask drawn, float left, float top,
                                          camber_u32 columns, camber_u32 rows) {
    const float a_tile = 1.0f / CAMBER_TILE_PX, right = (float)(columns - 1u), bottom = (float)(rows - 1u);
    /* The box extends to the middles of pixels, and a little farther, so that no cell's box is outside its tile's.
     * Tiles are counted from the picture's first one, and then from the area's, so that every area gets the same
     * result. */
    const float inset = CAMBER_INSET_PX, from_x = left * a_tile, from_y = top * a_tile;
    const camber_real none = CAMBER_REAL(0.0f);
    const camber_real x0 = (CAMBER_LESS(s->ax, s->bx) - s->reach + inset) * a_tile - from_x;
    const camber_real x1 = (CAMBER_MORE(s->ax, s->bx) + s->reach - inset) * a_tile - from_x;
    const camber_real y0 = (CAMBER_LESS(s->ay, s->by) - s->reach + inset) * a_tile - from_y;
    const camber_real y1 = (CAMBER_MORE(s->ay, s->by) + s->reach - inset) * a_tile - from_y;
    /* An edge left of the area still changes the winding of its tiles. */
    const camber_real far = s->half_width == CAMBER_EDGE_PX ? CAMBER_MORE(x1, none) : x1;
    const camber_mask meets = drawn & (x0 < right + 1.0f) & (y0 < bottom + 1.0f) & (far >= 0.0f) & (y1 >= 0.0f);
    const camber_real fx = CAMBER_MORE(x0, none), fy = CAMBER_MORE(y0, none);
    const camber_real lx = far < right ? far : CAMBER_REAL(right), ly = y1 < bottom ? y1 : CAMBER_REAL(bottom);
    const camber_words box = CAMBER_TO_WORDS(meets ? fx : none) | CAMBER_TO_WORDS(meets ? fy : none) << 8 |
                             CAMBER_TO_WORDS(meets ? lx : none) << 16 | CAMBER_TO_WORDS(meets ? ly : none) << 24;
    return meets ? box : (camber_words)(CAMBER_NO_BOX);
}

/* ---- Tiles ---- */

/* The values of a segment that finding its tiles needs: A, B, its direction, half width and reach. */
typedef struct camber_tile_line {
    float ax, ay, bx, by, ux, uy, half_width, reach;
} camber_tile_line;

CAMBER_FN void camber_tile_line_of(CAMBER_GLOBAL const float *segment, camber_tile_line *l) {
    l->ax = segment[CAMBER_SEGMENT_AX];
    l->ay = segment[CAMBER_SEGMENT_AY];
    l->bx = segment[CAMBER_SEGMENT_BX];
    l->by = segment[CAMBER_SEGMENT_BY];
    l->ux = segment[CAMBER_SEGMENT_UX];
    l->uy = segment[CAMBER_SEGMENT_UY];
    l->half_width = segment[CAMBER_SEGMENT_HALF_WIDTH];
    l->reach = segment[CAMBER_SEGMENT_REACH];
}

/* Makes the same from an edge, given its ends. */
CAMBER_FN void camber_tile_line_of_edge(CAMBER_GLOBAL const float *ends, camber_tile_line *l) {
    l->ax = ends[0];
    l->ay = ends[1];
    l->bx = ends[2];
    l->by = ends[3];
    const float dx = l->bx - l->ax, dy = l->by - l->ay, length = CAMBER_SQRT(dx * dx + dy * dy);
    const float scale = 1.0f / (length > 0.0f ? length : 1.0f);
    l->ux = length > 0.0f ? dx * scale : 1.0f;
    l->uy = length > 0.0f ? dy * scale : 0.0f;
    l->half_width = CAMBER_EDGE_PX;
    l->reach = CAMBER_EDGE_REACH_PX;
}

/* How far a segment with its reach is to either side of its line along a row of tiles, and how fast the line moves
 * along the row, in px. */
typedef struct camber_row_reach {
    float ax, ay, ux, beside, scale, left;
    camber_flag level; /* it runs along the row, all of which it may touch */
} camber_row_reach;

/* left: where the first tile begins, in px. */
CAMBER_FN void camber_row_reach_of(const camber_tile_line *l, float left, camber_row_reach *r) {
    const float to_middle = 0.5f * CAMBER_TILE_PX, far_b = CAMBER_FABS(l->bx) + CAMBER_FABS(l->by);
    const float slack =
        1e-6f * (CAMBER_FABS(l->ax) + CAMBER_FABS(l->ay) + (l->half_width == CAMBER_EDGE_PX ? far_b : 0.0f));
    r->ax = l->ax;
    r->ay = l->ay;
    r->ux = l->ux;
    r->beside = l->half_width + CAMBER_PAD_PX + to_middle * (CAMBER_FABS(l->ux) + CAMBER_FABS(l->uy)) + slack;
    r->level = CAMBER_FABS(l->uy) < 1e-3f;
    r->scale = 1.0f / (r->level ? 1.0f : l->uy);
    r->left = left;
}

/* Finds where a segment is in rows of tiles, in tiles from the middle of the row's first one. middle: y of the rows'
 * middles, in px. */
#define CAMBER_ROW_ENDS(reals)                                                                                         \
    CAMBER_FN CAMBER_SAME_NAME void camber_row_ends(const camber_row_reach *r, reals middle, reals *from, reals *to) { \
        const float to_middle = 0.5f * CAMBER_TILE_PX, a_tile = 1.0f / CAMBER_TILE_PX;                                 \
        const reals across = (middle - r->ay) * r->ux;                                                                 \
        const reals one = r->ax + (across - r->beside) * r->scale, other = r->ax + (across + r->beside) * r->scale;    \
        *from = (CAMBER_LESS(one, other) - to_middle) * a_tile - r->left * a_tile;                                     \
        *to = ((one < other ? other : one) - to_middle) * a_tile - r->left * a_tile;                                   \
    }
CAMBER_ROW_ENDS(float)

/* Returns the tiles of one row of a box that a segment with its reach touches: first | last << 8. */
CAMBER_FN camber_u32 camber_row_span(const camber_row_reach *r, float middle, camber_u32 first, camber_u32 last) {
    float from, to;
    if (r->level)
        return first | last << 8;
    camber_row_ends(r, middle, &from, &to);
    if (from > (float)last || to < (float)first)
        return 1u; /* none: the last is before the first */
    const camber_u32 begin = from > (float)first ? (camber_u32)from : first;
    return (from > (float)begin ? begin + 1u : begin) | (to < (float)last ? (camber_u32)to : last) << 8;
}

/* Whether from and to are in the same column, or row, of tiles, as camber_segment_box counts them before it clips the
 * box to the area. */
CAMBER_FN camber_u32 camber_same_tile(float from, float to) {
    const float a_tile = 1.0f / CAMBER_TILE_PX, least = -1e9f, most = 1e9f, inset = CAMBER_INSET_PX;
    const float a = (from + inset) * a_tile, b = (to - inset) * a_tile;
    const float lower = a < least ? least : a > most ? most : a, upper = b < least ? least : b > most ? most : b;
    const int first = (int)lower, last = (int)upper;
    return first - (lower < (float)first) == last - (upper < (float)last);
}

/* Whether the box of a segment is in one column or in one row of tiles. */
CAMBER_FN camber_u32 camber_line_is_narrow(const camber_tile_line *l) {
    return camber_same_tile(CAMBER_LESS(l->ax, l->bx) - l->reach, CAMBER_MORE(l->ax, l->bx) + l->reach) ||
           camber_same_tile(CAMBER_LESS(l->ay, l->by) - l->reach, CAMBER_MORE(l->ay, l->by) + l->reach);
}

/* The four bytes of a box: camber_segment_box. */
#define CAMBER_BOX_FIRST_X(box) ((box)&255u)
#define CAMBER_BOX_FIRST_Y(box) ((box) >> 8 & 255u)
#define CAMBER_BOX_LAST_X(box) ((box) >> 16 & 255u)
#define CAMBER_BOX_LAST_Y(box) ((box) >> 24)

/* Returns the tiles of a box in row y that a segment touches: first | last << 8. If the box is one column or row, these
 * are all its tiles. At the area's edge the box may be cut, but the span must be the same as in any other area. words:
 * the words of the segment, or the ends of an edge. */
CAMBER_FN camber_u32 camber_tile_span(CAMBER_GLOBAL const float *words, camber_flag is_edge, camber_u32 box,
                                      camber_u32 y, const camber_tile_grid *of) {
    const camber_u32 first = box & 255u, last = box >> 16 & 255u, top = box >> 8 & 255u, bottom = box >> 24;
    const camber_u32 all = first | last << 8;
    camber_tile_line line;
    camber_row_reach reach;
    if ((first == last && first - 1u < of->columns - 2u) || (top == bottom && top - 1u < of->rows - 2u))
        return all;
    if (is_edge)
        camber_tile_line_of_edge(words, &line);
    else
        camber_tile_line_of(words, &line);
    if ((first == last || top == bottom) && camber_line_is_narrow(&line))
        return all;
    camber_row_reach_of(&line, of->left, &reach);
    return camber_row_span(&reach, of->top + ((float)y + 0.5f) * CAMBER_TILE_PX, first, last);
}

/* Returns the first row of tiles whose top a segment with this box may cross; the last such row is the box's last row.
 */
CAMBER_FN camber_u32 camber_first_top(camber_u32 box) {
    return CAMBER_BOX_FIRST_Y(box) == 0u ? 0u : CAMBER_BOX_FIRST_Y(box) + 1u;
}

/* ---- Bunches of edges ---- */

/* A bunch in one word: x and y of its box's first tile, one byte each, then how many tiles follow along each side, in
 * two bits, and which of the sixteen edges is its first. */
#define CAMBER_NO_BUNCH 0xffffffffu
#define CAMBER_BUNCH_SIDE 4u
#define CAMBER_BUNCH_X(bunch) ((bunch)&255u)
#define CAMBER_BUNCH_Y(bunch) ((bunch) >> 8 & 255u)
#define CAMBER_BUNCH_LAST_X(bunch) (CAMBER_BUNCH_X(bunch) + ((bunch) >> 16 & 3u))
#define CAMBER_BUNCH_LAST_Y(bunch) (CAMBER_BUNCH_Y(bunch) + ((bunch) >> 18 & 3u))
#define CAMBER_BUNCH_FIRST(bunch) ((bunch) >> 20)

/* Sixteen edges that are stored together are a bunch if all that are drawn have one brush, and if they would have at
 * least four times as many entries in the lists of tiles as their common box has tiles. It has one entry in each of
 * these lists instead. Returns the bunch, or CAMBER_NO_BUNCH. */
CAMBER_FN camber_u32 camber_bunch_of(CAMBER_GLOBAL const camber_u32 *boxes, CAMBER_GLOBAL const camber_u32 *brushes) {
    camber_u32 x0 = 255u, y0 = 255u, x1 = 0u, y1 = 0u, entries = 0u, first = 16u, least = CAMBER_NO_EDGE, most = 0u;
#ifdef CAMBER_AHEAD_OF_TIME /* Oclgrind knows no reductions of vectors */
#pragma clang loop vectorize_width(16)
#endif
    for (camber_u32 k = 0u; k < 16u; k++) {
        const camber_u32 box = boxes[k], brush = brushes[k], undrawn = box == CAMBER_NO_BOX ? ~0u : 0u;
        const camber_u32 fx = CAMBER_BOX_FIRST_X(box), fy = CAMBER_BOX_FIRST_Y(box) | undrawn,
                         lx = CAMBER_BOX_LAST_X(box), ly = CAMBER_BOX_LAST_Y(box), which = k | undrawn;
        x0 = CAMBER_LESS(x0, fx);
        y0 = CAMBER_LESS(y0, fy);
        x1 = CAMBER_MORE(x1, lx);
        y1 = CAMBER_MORE(y1, ly);
        entries += ((lx - fx + 1u) * (ly - fy + 1u)) & ~undrawn;
        first = CAMBER_LESS(first, which);
        least = CAMBER_LESS(least, brush | undrawn);
        most = CAMBER_MORE(most, brush & ~undrawn);
    }
    const camber_u32 wide = x1 - x0 + 1u, high = y1 - y0 + 1u;
    return least == most && wide <= CAMBER_BUNCH_SIDE && high <= CAMBER_BUNCH_SIDE && entries >= 4u * wide * high
               ? x0 | y0 << 8 | (wide - 1u) << 16 | (high - 1u) << 18 | first << 20
               : CAMBER_NO_BUNCH;
}

#ifdef CAMBER_DEVICE
typedef char camber_brush_is_48_bytes[sizeof(camber_brush) == 48 ? 1 : -1];
#else
_Static_assert(sizeof(camber_brush) == 48, "the device reads brushes of 48 bytes");
#endif

#endif
