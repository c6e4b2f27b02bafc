/* setup: makes a segment of each record that ends one, and finds the box of tiles around it. A work-item takes sixteen
 * records.
 *
 * Reads records[CAMBER_RECORD_WORDS * stride * record_count], rows[CAMBER_RASTER_ROW_WORDS * row count]. For the n
 * records of a range, rounded up to sixteens, it writes from element `base` on:
 *     segments[CAMBER_SEGMENT_WORDS * n]; with CAMBER_RASTER_PITCHED their footprints in the picture
 *     boxes[n]; CAMBER_NO_BOX for a record that ends no segment, or one that is not drawn
 *     arc_lengths[CAMBER_SEGMENT_ARC_LENGTHS * n], only with CAMBER_RASTER_RICH; 0 if the records have none
 *     planes[CAMBER_PLANE_WORDS * n], only with CAMBER_RASTER_PITCHED: the segments in their plane
 * setup_gpu.cl writes the same bytes, with a work-item for each record. */
#include "features.h"
#include "pitch_segment.h"
#include "record_at.cl"
#include "transpose.cl"

#if CAMBER_LANES == 16
/* The words of sixteen consecutive records, a vector for each word. */
typedef struct sixteen_records {
    uint16 x, y, join, info;
} sixteen_records;

/* Reads sixteen records from `first` on. Numbers outside the part stand for its nearest record. */
static inline void take_records(global const camber_u32 *records, int first, camber_setup_args r,
                                private sixteen_records *taken) {
    uint16 v[4];
    if (r.stride == 1 && first >= 0 && first + 16 <= (int)r.record_count) {
        for (size_t i = 0; i < 4; i++)
            v[i] = vload16(i, records + CAMBER_RECORD_WORDS * (size_t)first);
    } else {
        uint words[64];
        for (int k = 0; k < 16; k++)
            vstore4(record_at(records, first + k, r), (size_t)k, words);
        for (size_t i = 0; i < 4; i++)
            v[i] = vload16(i, words);
    }
    taken->x = (uint16)(v[0].s048c, v[1].s048c, v[2].s048c, v[3].s048c);
    taken->y = (uint16)(v[0].s159d, v[1].s159d, v[2].s159d, v[3].s159d);
    taken->join = (uint16)(v[0].s26ae, v[1].s26ae, v[2].s26ae, v[3].s26ae);
    taken->info = (uint16)(v[0].s37bf, v[1].s37bf, v[2].s37bf, v[3].s37bf);
}

/* Reads the rows of sixteen segments. Mostly they all have the same one. */
static inline void take_rows(global const float *rows, camber_u32 first, uint16 numbers, int16 drawn,
                             private float16 *row) {
    const uint16 known = drawn ? numbers : (uint16)(0u);
    const uint8 a = max(known.lo, known.hi);
    const uint4 b = max(a.lo, a.hi);
    const uint2 c = max(b.lo, b.hi);
    const uint most = max(c.x, c.y);
    if (all((known == most) | (drawn == 0))) {
        const float4 one = vload4(first + most, rows);
        row[0] = (float16)(one.s0);
        row[1] = (float16)(one.s1);
        row[2] = (float16)(one.s2);
        row[3] = (float16)(one.s3);
        return;
    }
    float words[CAMBER_RASTER_ROW_WORDS][16];
    uint number[16];
    vstore16(known, 0, number);
    for (int k = 0; k < 16; k++) {
        const float4 one = vload4(first + number[k], rows);
        words[0][k] = one.s0;
        words[1][k] = one.s1;
        words[2][k] = one.s2;
        words[3][k] = one.s3;
    }
    for (int k = 0; k < CAMBER_RASTER_ROW_WORDS; k++)
        row[k] = vload16(0, words[k]);
}

#if CAMBER_RASTER_RICH
static inline float2 arc_length_at(global const camber_u32 *records, int i, camber_setup_args r) {
    const int last = (int)r.record_count - 1, at = i < 0 ? 0 : i > last ? last : i;
    return r.stride == 2 ? as_float2(vload2(4 * (size_t)at + 2, records)) : (float2)(0.0f);
}

static inline void put_arc_lengths(global const camber_u32 *records, int first, camber_setup_args r,
                                   private const camber_segment *s, global float *arc_lengths) {
    float from[16], to[16], total[16];
    for (int k = 0; k < 16; k++) {
        const int is_dot = record_at(records, first + k, r).s2 >> CAMBER_JOIN_KIND_SHIFT == CAMBER_KIND_DOT;
        const float2 a = arc_length_at(records, is_dot ? first + k : first + k - 1, r);
        from[k] = a.s0;
        to[k] = arc_length_at(records, first + k, r).s0;
        total[k] = a.s1;
    }
    const float16 along = vload16(0, from);
    const float16 rates = camber_segment_rate(s, along, vload16(0, to));
    for (int k = 0; k < 16; k++)
        vstore4((float4)(from[k], ((private const float *)&rates)[k], total[k], 0.0f), (size_t)k, arc_lengths);
}
#endif

static inline void put_segments(private float16 *words, global float *segments, size_t segment_words) {
    turn_over(words);
    for (int k = 0; k < 16; k++)
        vstore16(words[k], 0, segments + segment_words * (size_t)k);
}

#if CAMBER_RASTER_PITCHED
static inline void put_planes(private const camber_segment *s, private const camber_plane *p, global float *planes) {
    const float16 none = (float16)(0.0f);
    float16 words[16] = {s->ax,  s->ay,  s->bx,         s->by,      s->ux,      s->uy,       s->nax,      s->nay,
                         s->nbx, s->nby, s->half_width, p->owner_a, p->owner_b, p->cut_a[0], p->cut_a[1], p->cut_a[2]};
    put_segments(words, planes, CAMBER_PLANE_WORDS);
    float16 rest[16] = {p->cut_a[3], p->cut_b[0], p->cut_b[1], p->cut_b[2], p->cut_b[3], p->ends, p->margin, p->left[0],
                        p->left[1],  p->left[2],  p->right[0], p->right[1], p->right[2], none,    none,      none};
    put_segments(rest, planes + 16, CAMBER_PLANE_WORDS);
}
#endif

CAMBER_KERNEL(1, setup,
              (global const camber_u32 *restrict records, global const float *restrict rows,
               global float *restrict segments, global camber_u32 *restrict boxes, const camber_setup_args r,
               global float *restrict arc_lengths, global float *restrict planes),
              (records, rows, segments, boxes, r, arc_lengths, planes)) {
    const size_t group = CAMBER_WORK_ITEM;
    const int first = (int)(r.first + 16 * (uint)group);
    const int16 lanes = (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    sixteen_records b, before, second, third;
    float16 row[CAMBER_RASTER_ROW_WORDS];
    take_records(records, first, r, &b);
    take_records(records, first - 1, r, &before);
    take_records(records, first - 2, r, &second);
    take_records(records, first - 3, r, &third);
    const uint16 kind = b.join >> CAMBER_JOIN_KIND_SHIFT;
    const int16 is_dot = kind == CAMBER_KIND_DOT, again = (before.info & CAMBER_RECORD_START) != 0u;
    const int16 is_real =
        ((b.info & CAMBER_POINT_REAL) != 0u) & (kind != CAMBER_KIND_SENTINEL) & (lanes < (int16)((int)r.end - first));
    const int16 ends = (b.info & (r.strips ? STARTS : CAMBER_POINT_FIRST)) == 0u,
                is_end = r.strips ? ends : ends | is_dot;
    const int16 from_third = again & (before.join >> CAMBER_JOIN_KIND_SHIFT == CAMBER_KIND_TIGHT);
    take_rows(rows, r.first_row, b.info >> CAMBER_POINT_ROW_SHIFT, is_real & is_end, row);
#if CAMBER_RASTER_PITCHED
    const float16 x = row[1] - r.eye.x, y = row[2] - r.eye.y;
#else
    const float16 x = row[1], y = row[2];
#endif
    const float16 px = as_float16(from_third ? third.x : second.x) + x;
    const float16 py = as_float16(from_third ? third.y : second.y) + y;
    const float16 ax = as_float16(is_dot ? b.x : before.x) + x, ay = as_float16(is_dot ? b.y : before.y) + y;
    camber_segment s = camber_segment_of(px, py, ax, ay, as_float16(b.x) + x, as_float16(b.y) + y,
                                         is_dot ? b.join : before.join, b.join, row[0], r.linear);
    int16 is_drawn = is_real & is_end & (row[0] >= 0.0f);
    const size_t at = r.base / 16 + group;
#if CAMBER_RASTER_PITCHED
    const camber_segment flat = s;
    camber_plane plane;
    is_drawn &= camber_pitch_segment_of(r.eye, r.horizon, &flat, &s, &plane);
#endif
    const uint16 box = camber_segment_box(&s, is_drawn, r.left, r.top, r.columns, r.rows);
    vstore16(box, at, boxes);
    /* If a picture is drawn in several areas, most segments lie in others. */
    if (all(box == CAMBER_NO_BOX))
        return;
#if CAMBER_RASTER_PITCHED
    put_planes(&flat, &plane, planes + 16 * CAMBER_PLANE_WORDS * at);
    put_arc_lengths(records, first, r, &flat, arc_lengths + 64 * at);
#elif CAMBER_RASTER_RICH
    put_arc_lengths(records, first, r, &s, arc_lengths + 64 * at);
#endif
    float16 words[16] = {s.ax,         s.ay,    s.bx,    s.by,    s.ux,
                         s.uy,         s.nax,   s.nay,   s.nbx,   s.nby,
                         s.half_width, s.reach, s.slope, s.curve, as_float16(s.flags),
                         row[3]};
    put_segments(words, segments + 16 * CAMBER_SEGMENT_WORDS * at, CAMBER_SEGMENT_WORDS);
}
#endif
