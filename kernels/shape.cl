/* shape: sixteen records a work-item, the segments that end with them and the tiles that their boxes meet.
 * Reads records[CAMBER_RECORD_WORDS * stride * record_count], rows[CAMBER_COVER_ROW_WORDS * row count]; writes
 * shapes[CAMBER_SHAPE_WORDS * n] and boxes[n] from base on for the records from first on, n of them rounded up to
 * sixteens, with CAMBER_NO_BOX where no segment ends that is drawn. Of CAMBER_COVER_RICH writes measures[4 * n] too:
 * how far along its line A lies, how fast that grows, how long the line is; 0 where nothing is measured. Of
 * CAMBER_COVER_PITCHED shapes are bands of the picture, and planes[CAMBER_PLANE_WORDS * n] has what lies in the plane.
 */
#define STARTS (CAMBER_POINT_FIRST | CAMBER_RECORD_BREAK | CAMBER_RECORD_START)

typedef struct camber_shape_range {
    camber_u32 first, end, record_count; /* records: of the run, and all */
    camber_u32 stride, strips, linear;   /* stride: 2 where they are measured */
    camber_u32 base, first_row;          /* of the shapes, and of the table of rows */
    float left, top;                     /* of what is drawn, in the picture, px */
    camber_u32 columns, rows;            /* tiles */
    float horizon;                       /* in the picture, px from its top */
    camber_eye eye;
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
#pragma unroll
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

static inline void put_shapes(private float16 *words, global float *shapes, size_t a_shape) {
    turn_over(words);
    for (int k = 0; k < 16; k++)
        vstore16(words[k], 0, shapes + a_shape * (size_t)k);
}

#if CAMBER_COVER_PITCHED
#define PLANES , global float *restrict planes

static inline void put_planes(private const camber_shape *s, private const camber_plane *p, global float *planes) {
    const float16 none = (float16)(0.0f);
    float16 words[16] = {s->ax,  s->ay,  s->bx,         s->by,    s->ux,    s->uy,       s->nax,      s->nay,
                         s->nbx, s->nby, s->half_width, p->own_a, p->own_b, p->cut_a[0], p->cut_a[1], p->cut_a[2]};
    put_shapes(words, planes, CAMBER_PLANE_WORDS);
    float16 rest[16] = {p->cut_a[3], p->cut_b[0], p->cut_b[1], p->cut_b[2], p->cut_b[3], p->ends, p->margin, p->left[0],
                        p->left[1],  p->left[2],  p->right[0], p->right[1], p->right[2], none,    none,      none};
    put_shapes(rest, planes + 16, CAMBER_PLANE_WORDS);
}
#else
#define PLANES
#endif

kernel __attribute__((reqd_work_group_size(1, 1, 1))) void shape(global const camber_u32 *restrict records,
                                                                 global const float *restrict rows,
                                                                 global float *restrict shapes,
                                                                 global camber_u32 *restrict boxes,
                                                                 const camber_shape_range r MEASURES PLANES) {
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
#if CAMBER_COVER_PITCHED
        const float x = row.s1 - r.eye.x, y = row.s2 - r.eye.y;
#else
        const float x = row.s1, y = row.s2;
#endif
        px[k] = as_float(p.s0) + x;
        py[k] = as_float(p.s1) + y;
        ax[k] = as_float(a.s0) + x;
        ay[k] = as_float(a.s1) + y;
        bx[k] = as_float(b.s0) + x;
        by[k] = as_float(b.s1) + y;
        join_a[k] = a.s2;
        join_b[k] = b.s2;
    }
    camber_shape s =
        camber_shape_of(vload16(0, px), vload16(0, py), vload16(0, ax), vload16(0, ay), vload16(0, bx), vload16(0, by),
                        vload16(0, join_a), vload16(0, join_b), vload16(0, half_width), r.linear);
    int16 is_drawn = vload16(0, drawn);
    const size_t at = r.base / 16 + group;
#if CAMBER_COVER_PITCHED
    const camber_shape flat = s;
    camber_plane plane;
    is_drawn &= camber_pitch_shape_of(r.eye, r.horizon, &flat, &s, &plane);
#endif
    const uint16 box = camber_shape_box(&s, is_drawn, r.left, r.top, r.columns, r.rows);
    vstore16(box, at, boxes);
    /* Of a picture in several areas most segments lie in others. */
    if (all(box == CAMBER_NO_BOX))
        return;
#if CAMBER_COVER_PITCHED
    put_planes(&flat, &plane, planes + 16 * CAMBER_PLANE_WORDS * at);
    put_measures(records, first, r, &flat, measures + 64 * at);
#elif CAMBER_COVER_RICH
    put_measures(records, first, r, &s, measures + 64 * at);
#endif
    float16 words[16] = {s.ax,           s.ay,    s.bx,    s.by,    s.ux,
                         s.uy,           s.nax,   s.nay,   s.nbx,   s.nby,
                         s.half_width,   s.reach, s.slope, s.curve, as_float16(s.flags),
                         vload16(0, ink)};
    put_shapes(words, shapes + 16 * CAMBER_SHAPE_WORDS * at, CAMBER_SHAPE_WORDS);
}
