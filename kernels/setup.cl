/* setup: makes a segment, or the edge of a ring, from each point that ends one, and finds the box of tiles around it. A
 * work-item takes 128 slots of a range, or 16 on a GPU.
 *
 * Reads ranges[range_count] of one part, x, y, info, joins[slot_count + 2] of the part (one sentinel before and after
 * its slots), rows[CAMBER_RASTER_ROW_WORDS * row count], changes[first_change + change_count]. For the n slots of a
 * range, rounded up to sixteens, it writes from element `base` on:
 *     segments[CAMBER_SEGMENT_WORDS * n]; with CAMBER_RASTER_PITCHED their footprints in the picture
 *     edges[CAMBER_SIXTEEN_EDGES_WORDS * n / 16] instead, for slots that belong to rings; their brushes are
 *         CAMBER_NO_EDGE if they are not drawn
 *     bunches[n / 16] for slots between the first and the last edge
 *     boxes[n]; CAMBER_NO_BOX for a slot that ends no segment, or one that is not drawn
 *     arc_lengths[CAMBER_SEGMENT_ARC_LENGTHS * n], only with CAMBER_RASTER_RICH, from slot_arc_lengths[2 * slot_count];
 *         0 if the part has none
 *     planes[CAMBER_PLANE_WORDS * n], only with CAMBER_RASTER_PITCHED: the segments in their plane */
#include "brush_ext.h"
#include "cells.h"
#include "pitch_segment.h"
#include "transpose.cl"

/* The points of a part: arrays with one word per slot. */
typedef struct part_points {
    global const camber_u32 *x, *y, *info, *joins;
} part_points;

/* The words of consecutive points, one vector per word. */
typedef struct lane_points {
    camber_words x, y, join, info;
} lane_points;

/* Reads a vector of words from index `first` on. Indices outside the part give its nearest word. */
static inline camber_words take_words(global const camber_u32 *words, int first, const camber_setup_args *r) {
    const int last = (int)r->slot_count + 1;
    if (first >= 0 && first + CAMBER_LANES <= last + 1)
        return CAMBER_LOAD(0, words + first);
    uint taken[CAMBER_LANES];
    for (int k = 0; k < CAMBER_LANES; k++) {
        const int i = first + k;
        taken[k] = words[i < 0 ? 0 : i > last ? last : i];
    }
    return CAMBER_LOAD(0, taken);
}

/* Reads the rows of a vector of segments. Usually they all have the same one. */
static inline void take_rows(global const float *rows, camber_u32 first, camber_words numbers, camber_mask drawn,
                             camber_real *row) {
    const camber_words known = drawn ? numbers : (camber_words)(0u);
    const uint most = (uint)camber_largest_of(CAMBER_AS_INTEGERS(known)); /* a row has 24 bits */
    if (CAMBER_ALL((known == most) | (drawn == 0))) {
        const float4 one = vload4(first + most, rows);
        row[0] = CAMBER_REAL(one.s0);
        row[1] = CAMBER_REAL(one.s1);
        row[2] = CAMBER_REAL(one.s2);
        row[3] = CAMBER_REAL(one.s3);
        return;
    }
    float words[CAMBER_RASTER_ROW_WORDS][CAMBER_LANES];
    uint number[CAMBER_LANES];
    CAMBER_STORE(known, 0, number);
    for (int k = 0; k < CAMBER_LANES; k++) {
        const float4 one = vload4(first + number[k], rows);
        words[0][k] = one.s0;
        words[1][k] = one.s1;
        words[2][k] = one.s2;
        words[3][k] = one.s3;
    }
    for (int k = 0; k < CAMBER_RASTER_ROW_WORDS; k++)
        row[k] = CAMBER_LOAD(0, words[k]);
}

/* Returns the brushes of a vector of edges that end in the slots from `first` on, given the brushes of their rows. */
static inline camber_words take_brushes(global const camber_u32 *changes, camber_u32 first, const camber_setup_args *r,
                                        camber_real of_rows) {
    const uint numbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    camber_words brushes = CAMBER_AS_WORDS(of_rows) + r->changes_before;
    if (r->change_count == 0)
        return brushes;
    global const camber_u32 *own = changes + r->first_change;
    uint next = camber_changes_until(own, r->change_count, first);
    brushes += next;
    for (; next < r->change_count && own[next] - first < CAMBER_LANES; next++)
        brushes += CAMBER_LOAD(0, numbers) >= own[next] - first ? (camber_words)(1u) : (camber_words)(0u);
    return brushes;
}

#if CAMBER_RASTER_RICH
static inline float2 arc_length_at(global const float *slot_arc_lengths, int slot, const camber_setup_args *r) {
    const int last = (int)r->slot_count - 1, at = slot < 0 ? 0 : slot > last ? last : slot;
    return r->has_arc_length ? vload2((size_t)at, slot_arc_lengths) : (float2)(0.0f);
}

/* Writes arc lengths. A lane that is a dot gets the arc length of its point. */
static inline void put_arc_lengths(global const float *slot_arc_lengths, int first, camber_mask is_dot,
                                   const camber_setup_args *r, const camber_segment *s, global float *arc_lengths) {
    float from[CAMBER_LANES], to[CAMBER_LANES], total[CAMBER_LANES], rates[CAMBER_LANES];
    for (int k = 0; k < CAMBER_LANES; k++) {
        const int slot = first + k;
        const float2 a = arc_length_at(slot_arc_lengths, camber_integer_of(&is_dot, k) ? slot : slot - 1, r);
        from[k] = a.s0;
        to[k] = arc_length_at(slot_arc_lengths, slot, r).s0;
        total[k] = a.s1;
    }
    CAMBER_STORE(camber_segment_rate(s, CAMBER_LOAD(0, from), CAMBER_LOAD(0, to)), 0, rates);
    for (int k = 0; k < CAMBER_LANES; k++)
        vstore4((float4)(from[k], rates[k], total[k], 0.0f), (size_t)k, arc_lengths);
}
#endif

/* Writes sixteen words of each of a vector of segments, which are segment_words apart. */
static inline void put_segments(camber_real *words, global float *segments, size_t segment_words) {
#pragma unroll
    for (size_t from = 0; from < 16; from += CAMBER_LANES) {
        turn_over(words + from);
#pragma unroll
        for (size_t k = 0; k < CAMBER_LANES; k++)
            CAMBER_STORE(words[from + k], 0, segments + segment_words * k + from);
    }
}

#if CAMBER_RASTER_PITCHED
static inline void put_planes(const camber_segment *s, const camber_plane *p, camber_eye e, global float *planes) {
    const camber_real none = CAMBER_REAL(0.0f), cosine = CAMBER_REAL(e.cosine), fall = CAMBER_REAL(e.fall);
    camber_real words[16] = {s->ax,          s->ay,      s->bx,      s->by,      s->ux,         s->uy,
                             s->nax,         s->nay,     s->nbx,     s->nby,     s->half_width, p->cut_a.owner,
                             p->cut_b.owner, p->cut_a.x, p->cut_a.y, p->cut_a.at};
    put_segments(words, planes, CAMBER_PLANE_WORDS);
    camber_real rest[16] = {p->cut_a.wide, p->cut_b.x, p->cut_b.y, p->cut_b.at, p->cut_b.wide, p->ends,
                            p->margin,     p->left[0], p->left[1], p->left[2],  p->right[0],   p->right[1],
                            p->right[2],   cosine,     fall,       none};
    put_segments(rest, planes + 16, CAMBER_PLANE_WORDS);
}
#endif

/* Where the segments or edges of a vector of slots are written. */
typedef struct outputs {
    global float *segments;
    global camber_u32 *boxes;
    global float *arc_lengths, *planes, *ends;
    global camber_u32 *brushes; /* brushes of edges */
} outputs;

/* A vector of points that may end segments, and those before them. */
typedef struct ends {
    lane_points b, before;
    camber_real row[CAMBER_RASTER_ROW_WORDS], x, y; /* x, y: the translation */
    camber_mask is_dot, is_drawn;
} ends;

/* Reads the rows of the points that end segments, and drops segments that their row does not draw. */
static inline void look_up_rows(global const float *rows, const camber_setup_args *r, ends *e) {
    take_rows(rows, r->first_row, e->b.info >> CAMBER_POINT_ROW_SHIFT, e->is_drawn, e->row);
    e->is_drawn &= e->row[0] >= 0.0f;
#if CAMBER_RASTER_PITCHED
    e->x = e->row[1] - r->eye.x;
    e->y = e->row[2] - r->eye.y;
#else
    e->x = e->row[1];
    e->y = e->row[2];
#endif
}

/* Takes the points of the slots from `first` on. The words of the slots follow the word of the leading sentinel. */
static inline void take_points(part_points from, int first, const camber_setup_args *r, ends *e) {
    const int numbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const int at = first + 1;
    e->b.x = take_words(from.x, at, r);
    e->b.y = take_words(from.y, at, r);
    e->b.info = take_words(from.info, at, r);
    e->before.x = take_words(from.x, at - 1, r);
    e->before.y = take_words(from.y, at - 1, r);
    e->is_drawn = ((e->b.info & CAMBER_POINT_REAL) != 0u) & (CAMBER_LOAD(0, numbers) < (int)r->end - first);
}

static inline void take_ends(part_points from, global const float *rows, int first, const camber_setup_args *r,
                             ends *e) {
    take_points(from, first, r, e);
    e->b.join = take_words(from.joins, first + 1, r);
    e->before.join = take_words(from.joins, first, r);
    const camber_words kind = e->b.join >> CAMBER_JOIN_KIND_SHIFT;
    e->is_dot = kind == CAMBER_KIND_DOT;
    e->is_drawn &= (kind != CAMBER_KIND_SENTINEL) & (((e->b.info & CAMBER_POINT_FIRST) == 0u) | e->is_dot);
    look_up_rows(rows, r, e);
}

/* Takes the ends of edges of rings, which have no joins. */
static inline void take_edge_ends(part_points from, global const float *rows, int first, const camber_setup_args *r,
                                  ends *e) {
    const camber_words none = (camber_words)(0u), some = (camber_words)(1u);
    take_points(from, first, r, e);
    e->is_dot = none == some;
    e->is_drawn &= (e->b.info & CAMBER_POINT_FIRST) == 0u;
    look_up_rows(rows, r, e);
}

/* The points at which segments begin and end. */
typedef struct lane_ends {
    camber_real ax, ay, bx, by;
} lane_ends;

static inline void place_ends(const ends *e, lane_ends *l) {
    l->ax = CAMBER_AS_REAL(e->is_dot ? e->b.x : e->before.x) + e->x;
    l->ay = CAMBER_AS_REAL(e->is_dot ? e->b.y : e->before.y) + e->y;
    l->bx = CAMBER_AS_REAL(e->b.x) + e->x;
    l->by = CAMBER_AS_REAL(e->b.y) + e->y;
}

/* Makes the segments that end in the slots from `first` on, and writes them. */
static inline void make_segments(part_points from, global const float *rows, global const float *slot_arc_lengths,
                                 int first, const camber_setup_args *r, outputs to) {
    ends e;
    lane_ends l;
    camber_segment s;
    take_ends(from, rows, first, r, &e);
    place_ends(&e, &l);
    /* The previous segment begins two points before the end; for a cap it does not matter. */
    const camber_words px = take_words(from.x, first - 1, r), py = take_words(from.y, first - 1, r);
    camber_segment_of(CAMBER_AS_REAL(px) + e.x, CAMBER_AS_REAL(py) + e.y, l.ax, l.ay, l.bx, l.by,
                      e.is_dot ? e.b.join : e.before.join, e.b.join, e.row[0], r->linear, &s);
#if CAMBER_RASTER_PITCHED
    const camber_segment flat = s;
    camber_plane plane;
    e.is_drawn &= camber_pitch_segment_of(r->eye, r->horizon, &flat, &s, &plane);
#endif
    const camber_words box = camber_segment_box(&s, e.is_drawn, r->left, r->top, r->columns, r->rows);
    CAMBER_STORE(box, 0, to.boxes);
    /* If a picture is drawn in several areas, most segments are in other areas. */
    if (CAMBER_ALL(box == CAMBER_NO_BOX))
        return;
#if CAMBER_RASTER_PITCHED
    put_planes(&flat, &plane, r->eye, to.planes);
    put_arc_lengths(slot_arc_lengths, first, e.is_dot, r, &flat, to.arc_lengths);
#elif CAMBER_RASTER_RICH
    put_arc_lengths(slot_arc_lengths, first, e.is_dot, r, &s, to.arc_lengths);
#endif
    camber_real words[16] = {s.ax,         s.ay,    s.bx,    s.by,    s.ux,
                             s.uy,         s.nax,   s.nay,   s.nbx,   s.nby,
                             s.half_width, s.reach, s.slope, s.curve, CAMBER_AS_REAL(s.flags),
                             e.row[3]};
    put_segments(words, to.segments, CAMBER_SEGMENT_WORDS);
    if (r->among_edges)
        CAMBER_STORE((camber_words)(CAMBER_NO_EDGE), 0, to.brushes);
}

/* The same for edges of rings. */
static inline void make_edges(part_points from, global const float *rows, global const camber_u32 *changes, int first,
                              const camber_setup_args *r, outputs to) {
    ends e;
    lane_ends l;
    camber_segment s;
    take_edge_ends(from, rows, first, r, &e);
    place_ends(&e, &l);
    camber_edge_segment(l.ax, l.ay, l.bx, l.by, &s);
#if CAMBER_RASTER_PITCHED
    const camber_segment flat = s;
    e.is_drawn &= camber_pitch_edge_of(r->eye, &flat, &s);
#endif
    const camber_words box = camber_segment_box(&s, e.is_drawn, r->left, r->top, r->columns, r->rows);
    const camber_words brushes = take_brushes(changes, (camber_u32)first, r, e.row[3]);
    CAMBER_STORE(box, 0, to.boxes);
    CAMBER_STORE(box == CAMBER_NO_BOX ? (camber_words)(CAMBER_NO_EDGE) : brushes, 0, to.brushes);
    if (CAMBER_ALL(box == CAMBER_NO_BOX))
        return;
    const camber_real x0 = put_together(s.ax, s.bx, 0), y0 = put_together(s.ay, s.by, 0);
    const camber_real x1 = put_together(s.ax, s.bx, 1), y1 = put_together(s.ay, s.by, 1);
    CAMBER_STORE(put_together(x0, y0, 0), 0, to.ends);
    CAMBER_STORE(put_together(x0, y0, 1), 1, to.ends);
    CAMBER_STORE(put_together(x1, y1, 0), 2, to.ends);
    CAMBER_STORE(put_together(x1, y1, 1), 3, to.ends);
}

/* Returns the range whose slots a work-item takes. */
static inline uint range_of(global const camber_setup_args *ranges, uint count, uint item) {
    uint first = 0;
    while (count > 1) {
        const uint below = count / 2;
        const bool is_above = ranges[first + below].first_item <= item;
        first += is_above ? below : 0;
        count = is_above ? count - below : below;
    }
    return first;
}

CAMBER_KERNEL(1, setup,
              (global const camber_u32 *restrict x, global const camber_u32 *restrict y,
               global const camber_u32 *restrict info, global const camber_u32 *restrict joins,
               global const float *restrict slot_arc_lengths, global const float *restrict rows,
               global float *restrict segments, global camber_u32 *restrict boxes,
               global const camber_setup_args *restrict ranges, const uint range_count,
               global float *restrict arc_lengths, global float *restrict planes,
               global const camber_u32 *restrict changes, global float *restrict edges,
               global camber_u32 *restrict bunches),
              (x, y, info, joins, slot_arc_lengths, rows, segments, boxes, ranges, range_count, arc_lengths, planes,
               changes, edges, bunches)) {
    const camber_setup_args r = ranges[range_of(ranges, range_count, (uint)CAMBER_WORK_ITEM)];
    const uint most = CAMBER_SETUP_SLOTS(CAMBER_LANES), from = most * ((uint)CAMBER_WORK_ITEM - r.first_item),
               left = (r.end - r.first - from + 15) / 16 * 16;
    const uint count = left < most ? left : most;
    const part_points points = {x, y, info, joins};
    for (uint i = from; i < from + count; i += CAMBER_LANES) {
        const size_t at = (size_t)r.base + i;
        const int first = (int)(r.first + i);
        const outputs to = {segments + CAMBER_SEGMENT_WORDS * at,
                            boxes + at,
                            arc_lengths + CAMBER_SEGMENT_ARC_LENGTHS * at,
                            planes + CAMBER_PLANE_WORDS * at,
                            edges + camber_edge_ends(at),
                            (global camber_u32 *)edges + camber_edge_brush(at)};
        if (r.makes_edges)
            make_edges(points, rows, changes, first, &r, to);
        else
            make_segments(points, rows, slot_arc_lengths, first, &r, to);
        if ((i + CAMBER_LANES) % 16 != 0 || !(r.makes_edges || r.among_edges))
            continue;
        const size_t sixteen = at / 16 * 16;
        global const camber_u32 *brushes = (global const camber_u32 *)edges + camber_edge_brush(sixteen);
        bunches[at / 16] = r.makes_edges ? camber_bunch_of(boxes + sixteen, brushes) : CAMBER_NO_BUNCH;
    }
}
