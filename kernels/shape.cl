/* shape: sixteen records a work-item, the segments that end with them and the tiles that their boxes meet.
 * Reads records[CAMBER_RECORD_WORDS * stride * record_count], rows[CAMBER_COVER_ROW_WORDS * row count]; writes
 * shapes[CAMBER_SHAPE_WORDS * n] and boxes[n] from base on for the records from first on, n of them rounded up to
 * sixteens, with CAMBER_NO_BOX where no segment ends that is drawn. Of CAMBER_COVER_RICH writes measures[4 * n] too:
 * how far along its line A lies, how fast that grows, how long the line is; 0 where nothing is measured. */
#define STARTS (CAMBER_POINT_FIRST | CAMBER_RECORD_BREAK | CAMBER_RECORD_START)

typedef struct camber_shape_range {
    camber_u32 first, end, record_count; /* records: of the run, and all */
    camber_u32 stride, strips, linear;   /* stride: 2 where they are measured */
    camber_u32 base, first_row;          /* of the shapes, and of the table of rows */
    float left, top;                     /* of what is drawn, in the picture, px */
    camber_u32 columns, rows;            /* tiles */
} camber_shape_range;

static inline uint4 record_at(global const camber_u32 *records, int i, camber_shape_range r) {
    const int last = (int)r.record_count - 1, at = i < 0 ? 0 : i > last ? last : i;
    return vload4((size_t)at * r.stride, records);
}

static inline float16 put_together(float16 high, float16 low, int upper) {
    return upper ? (float16)(high.s8, low.s8, high.s9, low.s9, high.sa, low.sa, high.sb, low.sb, high.sc, low.sc,
                             high.sd, low.sd, high.se, low.se, high.sf, low.sf)
                 : (float16)(high.s0, low.s0, high.s1, low.s1, high.s2, low.s2, high.s3, low.s3, high.s4, low.s4,
                             high.s5, low.s5, high.s6, low.s6, high.s7, low.s7);
}

/* Sixteen words of sixteen segments: four perfect shuffles turn the square over. */
static inline void turn_over(private float16 *words) {
    for (int turn = 0; turn < 4; turn++) {
        float16 next[16];
#pragma unroll
        for (int i = 0; i < 8; i++) {
            next[2 * i] = put_together(words[i], words[i + 8], 0);
            next[2 * i + 1] = put_together(words[i], words[i + 8], 1);
        }
#pragma unroll
        for (int i = 0; i < 16; i++)
            words[i] = next[i];
    }
}

#if CAMBER_COVER_RICH
#define MEASURES , global float *restrict measures

static inline float2 measure_at(global const camber_u32 *records, int i, camber_shape_range r) {
    const int last = (int)r.record_count - 1, at = i < 0 ? 0 : i > last ? last : i;
    return r.stride == 2 ? as_float2(vload2(4 * (size_t)at + 2, records)) : (float2)(0.0f);
}

static inline void put_measures(global const camber_u32 *records, int first, camber_shape_range r,
                                private const camber_shape *s, global float *measures) {
    float from[16], to[16], total[16];
    for (int k = 0; k < 16; k++) {
        const int is_dot = record_at(records, first + k, r).s2 >> CAMBER_JOIN_KIND_SHIFT == CAMBER_KIND_DOT;
        const float2 a = measure_at(records, is_dot ? first + k : first + k - 1, r);
        from[k] = a.s0;
        to[k] = measure_at(records, first + k, r).s0;
        total[k] = a.s1;
    }
    const float16 along = vload16(0, from);
    const float16 rates = camber_shape_rate(s, along, vload16(0, to));
    for (int k = 0; k < 16; k++)
        vstore4((float4)(from[k], ((private const float *)&rates)[k], total[k], 0.0f), (size_t)k, measures);
}
#else
#define MEASURES
#endif

kernel __attribute__((reqd_work_group_size(1, 1, 1))) void shape(global const camber_u32 *restrict records,
                                                                 global const float *restrict rows,
                                                                 global float *restrict shapes,
                                                                 global camber_u32 *restrict boxes,
                                                                 const camber_shape_range r MEASURES) {
    float px[16], py[16], ax[16], ay[16], bx[16], by[16], half_width[16], ink[16];
    uint join_a[16], join_b[16];
    int drawn[16];
    const size_t group = get_global_id(0);
    const int first = (int)(r.first + 16 * (uint)group);
    for (int k = 0; k < 16; k++) {
        const int i = first + k;
        const uint4 b = record_at(records, i, r), before = record_at(records, i - 1, r);
        const uint kind = b.s2 >> CAMBER_JOIN_KIND_SHIFT;
        const int is_dot = kind == CAMBER_KIND_DOT, again = (before.s3 & CAMBER_RECORD_START) != 0u;
        const int is_real = (b.s3 & CAMBER_POINT_REAL) != 0u && kind != CAMBER_KIND_GHOST && i < (int)r.end;
        const int ends = r.strips ? (b.s3 & STARTS) == 0u : (b.s3 & CAMBER_POINT_FIRST) == 0u || is_dot;
        const uint4 a = is_dot ? b : before;
        const int from = again && before.s2 >> CAMBER_JOIN_KIND_SHIFT == CAMBER_KIND_TIGHT ? i - 3 : i - 2;
        const uint4 p = record_at(records, from, r);
        const float4 row = vload4(r.first_row + (is_real && ends ? b.s3 >> CAMBER_POINT_ROW_SHIFT : 0u), rows);
        drawn[k] = is_real && ends && row.s0 >= 0.0f ? -1 : 0;
        half_width[k] = row.s0;
        ink[k] = row.s3;
        px[k] = as_float(p.s0) + row.s1;
        py[k] = as_float(p.s1) + row.s2;
        ax[k] = as_float(a.s0) + row.s1;
        ay[k] = as_float(a.s1) + row.s2;
        bx[k] = as_float(b.s0) + row.s1;
        by[k] = as_float(b.s1) + row.s2;
        join_a[k] = a.s2;
        join_b[k] = b.s2;
    }
    const camber_shape s =
        camber_shape_of(vload16(0, px), vload16(0, py), vload16(0, ax), vload16(0, ay), vload16(0, bx), vload16(0, by),
                        vload16(0, join_a), vload16(0, join_b), vload16(0, half_width), r.linear);
    const uint16 box = camber_shape_box(&s, vload16(0, drawn), r.left, r.top, r.columns, r.rows);
    float16 words[16] = {s.ax,           s.ay,    s.bx,    s.by,    s.ux,
                         s.uy,           s.nax,   s.nay,   s.nbx,   s.nby,
                         s.half_width,   s.reach, s.slope, s.curve, as_float16(s.flags),
                         vload16(0, ink)};
    turn_over(words);
    const size_t at = r.base / 16 + group;
#if CAMBER_COVER_RICH
    put_measures(records, first, r, &s, measures + 64 * at);
#endif
    vstore16(box, at, boxes);
    for (int k = 0; k < 16; k++)
        vstore16(words[k], 16 * at + (size_t)k, shapes);
}
