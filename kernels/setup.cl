/* setup: makes a segment, or the edge of a ring, of each record that ends one, and finds the box of tiles around it. A
 * work-item takes 128 records of a range, and on a GPU 16.
 *
 * Reads ranges[range_count] of one part, records[CAMBER_RECORD_WORDS * stride * record_count],
 * rows[CAMBER_RASTER_ROW_WORDS * row count], changes[first_change + change_count]. For the n records of a range,
 * rounded up to sixteens, it writes from element `base` on:
 *     segments[CAMBER_SEGMENT_WORDS * n]; with CAMBER_RASTER_PITCHED their footprints in the picture
 *     edges[CAMBER_SIXTEEN_EDGES_WORDS * n / 16] instead, of records that belong to rings of areas
 *     boxes[n]; CAMBER_NO_BOX for a record that ends no segment, or one that is not drawn
 *     arc_lengths[CAMBER_SEGMENT_ARC_LENGTHS * n], only with CAMBER_RASTER_RICH; 0 if the records have none
 *     planes[CAMBER_PLANE_WORDS * n], only with CAMBER_RASTER_PITCHED: the segments in their plane */
#include "brush_ext.h"
#include "cells.h"
#include "pitch_segment.h"
#include "transpose.cl"

/* Flags of records that begin a polyline or a strip: no segment ends with them. */
#define STARTS (CAMBER_POINT_FIRST | CAMBER_RECORD_BREAK | CAMBER_RECORD_START)

/* Reads record i. A number outside the part stands for its nearest record. */
static inline uint4 record_at(global const camber_u32 *records, int i, const camber_setup_args *r) {
    const int last = (int)r->record_count - 1, at = i < 0 ? 0 : i > last ? last : i;
    return vload4((size_t)at * r->stride, records);
}

/* The words of consecutive records, a vector for each word. */
typedef struct lane_records {
    camber_words x, y, join, info;
} lane_records;

/* Reads a vector of records from `first` on. Numbers outside the part stand for its nearest record. */
static inline void take_records(global const camber_u32 *records, int first, const camber_setup_args *r,
                                lane_records *taken) {
    camber_words v[4];
    if (r->stride == 1 && first >= 0 && first + CAMBER_LANES <= (int)r->record_count) {
        for (size_t i = 0; i < 4; i++)
            v[i] = CAMBER_LOAD(i, records + CAMBER_RECORD_WORDS * (size_t)first);
    } else {
        uint of_lanes[4 * CAMBER_LANES];
        for (int k = 0; k < CAMBER_LANES; k++)
            vstore4(record_at(records, first + k, r), (size_t)k, of_lanes);
        for (size_t i = 0; i < 4; i++)
            v[i] = CAMBER_LOAD(i, of_lanes);
    }
    camber_words words[4];
    turn_fours_over(v, words);
    taken->x = words[0];
    taken->y = words[1];
    taken->join = words[2];
    taken->info = words[3];
}

/* Reads the rows of a vector of segments. Mostly they all have the same one. */
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

/* The brushes of a vector of edges that end with the records from `first` on, by those of their rows. */
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
static inline float2 arc_length_at(global const camber_u32 *records, int i, const camber_setup_args *r) {
    const int last = (int)r->record_count - 1, at = i < 0 ? 0 : i > last ? last : i;
    return r->stride == 2 ? as_float2(vload2(4 * (size_t)at + 2, records)) : (float2)(0.0f);
}

static inline void put_arc_lengths(global const camber_u32 *records, int first, const camber_setup_args *r,
                                   const camber_segment *s, global float *arc_lengths) {
    float from[CAMBER_LANES], to[CAMBER_LANES], total[CAMBER_LANES], rates[CAMBER_LANES];
    for (int k = 0; k < CAMBER_LANES; k++) {
        const int is_dot = record_at(records, first + k, r).s2 >> CAMBER_JOIN_KIND_SHIFT == CAMBER_KIND_DOT;
        const float2 a = arc_length_at(records, is_dot ? first + k : first + k - 1, r);
        from[k] = a.s0;
        to[k] = arc_length_at(records, first + k, r).s0;
        total[k] = a.s1;
    }
    CAMBER_STORE(camber_segment_rate(s, CAMBER_LOAD(0, from), CAMBER_LOAD(0, to)), 0, rates);
    for (int k = 0; k < CAMBER_LANES; k++)
        vstore4((float4)(from[k], rates[k], total[k], 0.0f), (size_t)k, arc_lengths);
}
#endif

/* Writes sixteen words of each of a vector of segments, which lie segment_words apart. */
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
static inline void put_planes(const camber_segment *s, const camber_plane *p, global float *planes) {
    const camber_real none = CAMBER_REAL(0.0f);
    camber_real words[16] = {s->ax,          s->ay,      s->bx,      s->by,      s->ux,         s->uy,
                             s->nax,         s->nay,     s->nbx,     s->nby,     s->half_width, p->cut_a.owner,
                             p->cut_b.owner, p->cut_a.x, p->cut_a.y, p->cut_a.at};
    put_segments(words, planes, CAMBER_PLANE_WORDS);
    camber_real rest[16] = {p->cut_a.wide, p->cut_b.x, p->cut_b.y, p->cut_b.at, p->cut_b.wide, p->ends,
                            p->margin,     p->left[0], p->left[1], p->left[2],  p->right[0],   p->right[1],
                            p->right[2],   none,       none,       none};
    put_segments(rest, planes + 16, CAMBER_PLANE_WORDS);
}
#endif

/* Where the segments or edges of a vector of records go. */
typedef struct outputs {
    global float *segments;
    global camber_u32 *boxes;
    global float *arc_lengths, *planes, *ends;
    global camber_u32 *brushes; /* of edges */
} outputs;

/* A vector of records that may end segments, and those before them. */
typedef struct ends {
    lane_records b, before;
    camber_real row[CAMBER_RASTER_ROW_WORDS], x, y; /* x, y: the translation */
    camber_mask is_dot, is_drawn;
} ends;

/* Takes the records from `first` on. */
static inline void take_ends(global const camber_u32 *records, global const float *rows, int first,
                             const camber_setup_args *r, ends *e) {
    const int numbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    take_records(records, first, r, &e->b);
    take_records(records, first - 1, r, &e->before);
    const camber_words kind = e->b.join >> CAMBER_JOIN_KIND_SHIFT;
    const camber_mask is_real = ((e->b.info & CAMBER_POINT_REAL) != 0u) & (kind != CAMBER_KIND_SENTINEL) &
                                (CAMBER_LOAD(0, numbers) < (int)r->end - first);
    const camber_mask goes_on = (e->b.info & (r->strips ? STARTS : CAMBER_POINT_FIRST)) == 0u;
    e->is_dot = kind == CAMBER_KIND_DOT;
    e->is_drawn = is_real & (r->strips ? goes_on : goes_on | e->is_dot);
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

/* Where a segment begins and ends. */
typedef struct lane_ends {
    camber_real ax, ay, bx, by;
} lane_ends;

static inline void place_ends(const ends *e, lane_ends *l) {
    l->ax = CAMBER_AS_REAL(e->is_dot ? e->b.x : e->before.x) + e->x;
    l->ay = CAMBER_AS_REAL(e->is_dot ? e->b.y : e->before.y) + e->y;
    l->bx = CAMBER_AS_REAL(e->b.x) + e->x;
    l->by = CAMBER_AS_REAL(e->b.y) + e->y;
}

/* Makes the segments of the records from `first` on, and writes them. */
static inline void make_segments(global const camber_u32 *records, global const float *rows, int first,
                                 const camber_setup_args *r, outputs to) {
    ends e;
    lane_records second, third;
    lane_ends l;
    camber_segment s;
    take_ends(records, rows, first, r, &e);
    take_records(records, first - 2, r, &second);
    take_records(records, first - 3, r, &third);
    place_ends(&e, &l);
    const camber_mask from_third =
        ((e.before.info & CAMBER_RECORD_START) != 0u) & (e.before.join >> CAMBER_JOIN_KIND_SHIFT == CAMBER_KIND_TIGHT);
    camber_segment_of(CAMBER_AS_REAL(from_third ? third.x : second.x) + e.x,
                      CAMBER_AS_REAL(from_third ? third.y : second.y) + e.y, l.ax, l.ay, l.bx, l.by,
                      e.is_dot ? e.b.join : e.before.join, e.b.join, e.row[0], r->linear, &s);
#if CAMBER_RASTER_PITCHED
    const camber_segment flat = s;
    camber_plane plane;
    e.is_drawn &= camber_pitch_segment_of(r->eye, r->horizon, &flat, &s, &plane);
#endif
    const camber_words box = camber_segment_box(&s, e.is_drawn, r->left, r->top, r->columns, r->rows);
    CAMBER_STORE(box, 0, to.boxes);
    /* If a picture is drawn in several areas, most segments lie in others. */
    if (CAMBER_ALL(box == CAMBER_NO_BOX))
        return;
#if CAMBER_RASTER_PITCHED
    put_planes(&flat, &plane, to.planes);
    put_arc_lengths(records, first, r, &flat, to.arc_lengths);
#elif CAMBER_RASTER_RICH
    put_arc_lengths(records, first, r, &s, to.arc_lengths);
#endif
    camber_real words[16] = {s.ax,         s.ay,    s.bx,    s.by,    s.ux,
                             s.uy,         s.nax,   s.nay,   s.nbx,   s.nby,
                             s.half_width, s.reach, s.slope, s.curve, CAMBER_AS_REAL(s.flags),
                             e.row[3]};
    put_segments(words, to.segments, CAMBER_SEGMENT_WORDS);
    if (r->makes == CAMBER_MAKES_SEGMENTS_AMONG_EDGES)
        CAMBER_STORE((camber_words)(CAMBER_NO_EDGE), 0, to.brushes);
}

/* The same of edges. */
static inline void make_edges(global const camber_u32 *records, global const float *rows,
                              global const camber_u32 *changes, int first, const camber_setup_args *r, outputs to) {
    ends e;
    lane_ends l;
    camber_segment s;
    take_ends(records, rows, first, r, &e);
    place_ends(&e, &l);
    camber_edge_segment(l.ax, l.ay, l.bx, l.by, &s);
#if CAMBER_RASTER_PITCHED
    const camber_segment flat = s;
    e.is_drawn &= camber_pitch_edge_of(r->eye, &flat, &s);
#endif
    const camber_words box = camber_segment_box(&s, e.is_drawn, r->left, r->top, r->columns, r->rows);
    CAMBER_STORE(box, 0, to.boxes);
    if (CAMBER_ALL(box == CAMBER_NO_BOX))
        return;
    const camber_real x0 = put_together(s.ax, s.bx, 0), y0 = put_together(s.ay, s.by, 0);
    const camber_real x1 = put_together(s.ax, s.bx, 1), y1 = put_together(s.ay, s.by, 1);
    CAMBER_STORE(put_together(x0, y0, 0), 0, to.ends);
    CAMBER_STORE(put_together(x0, y0, 1), 1, to.ends);
    CAMBER_STORE(put_together(x1, y1, 0), 2, to.ends);
    CAMBER_STORE(put_together(x1, y1, 1), 3, to.ends);
    CAMBER_STORE(take_brushes(changes, (camber_u32)first, r, e.row[3]), 0, to.brushes);
}

/* The range whose records a work-item takes. */
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
              (global const camber_u32 *restrict records, global const float *restrict rows,
               global float *restrict segments, global camber_u32 *restrict boxes,
               global const camber_setup_args *restrict ranges, const uint range_count,
               global float *restrict arc_lengths, global float *restrict planes,
               global const camber_u32 *restrict changes, global float *restrict edges),
              (records, rows, segments, boxes, ranges, range_count, arc_lengths, planes, changes, edges)) {
    const camber_setup_args r = ranges[range_of(ranges, range_count, (uint)CAMBER_WORK_ITEM)];
    const uint most = CAMBER_SETUP_RECORDS(CAMBER_LANES), from = most * ((uint)CAMBER_WORK_ITEM - r.first_item),
               left = (r.end - r.first - from + 15) / 16 * 16;
    const uint count = left < most ? left : most;
    for (uint i = from; i < from + count; i += CAMBER_LANES) {
        const size_t at = (size_t)r.base + i;
        const int first = (int)(r.first + i);
        const outputs to = {segments + CAMBER_SEGMENT_WORDS * at,
                            boxes + at,
                            arc_lengths + CAMBER_SEGMENT_ARC_LENGTHS * at,
                            planes + CAMBER_PLANE_WORDS * at,
                            edges + camber_edge_ends(at),
                            (global camber_u32 *)edges + camber_edge_brush(at)};
        if (r.makes == CAMBER_MAKES_EDGES)
            make_edges(records, rows, changes, first, &r, to);
        else
            make_segments(records, rows, first, &r, to);
    }
}
