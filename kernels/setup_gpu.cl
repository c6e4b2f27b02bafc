/* setup on a GPU: a work-item takes a record. It reads what setup.cl reads and writes the same bytes. Segments go
 * through local memory, so that neighbouring work-items write neighbouring words. */
#include "record_at.cl"
#include "segment.h"

#if CAMBER_LANES == 1

#define SETUP_LANES 64
/* odd, so that the lanes' words lie in different banks of local memory */
#define SETUP_STRIDE (CAMBER_SEGMENT_WORDS + 1)

static inline void segment_at(global const camber_u32 *records, global const float *rows, int i, camber_setup_args r,
                              local float *words, global camber_u32 *box) {
    const uint4 b = record_at(records, i, r), before = record_at(records, i - 1, r);
    const uint kind = b.s2 >> CAMBER_JOIN_KIND_SHIFT;
    const int is_dot = kind == CAMBER_KIND_DOT, again = (before.s3 & CAMBER_RECORD_START) != 0u;
    const int is_real = (b.s3 & CAMBER_POINT_REAL) != 0u && kind != CAMBER_KIND_SENTINEL && i < (int)r.end;
    const int ends = is_real && (r.strips ? (b.s3 & STARTS) == 0u : (b.s3 & CAMBER_POINT_FIRST) == 0u || is_dot);
    const uint4 a = is_dot ? b : before;
    const uint4 p =
        record_at(records, again && before.s2 >> CAMBER_JOIN_KIND_SHIFT == CAMBER_KIND_TIGHT ? i - 3 : i - 2, r);
    const float4 row = vload4(r.first_row + (ends ? b.s3 >> CAMBER_POINT_ROW_SHIFT : 0u), rows);
    const camber_segment s = camber_segment_of(
        as_float(p.s0) + row.s1, as_float(p.s1) + row.s2, as_float(a.s0) + row.s1, as_float(a.s1) + row.s2,
        as_float(b.s0) + row.s1, as_float(b.s1) + row.s2, a.s2, b.s2, row.s0, r.linear);
    *box = camber_segment_box(&s, ends && row.s0 >= 0.0f, r.left, r.top, r.columns, r.rows);
    words[CAMBER_SEGMENT_AX] = s.ax;
    words[CAMBER_SEGMENT_AY] = s.ay;
    words[CAMBER_SEGMENT_BX] = s.bx;
    words[CAMBER_SEGMENT_BY] = s.by;
    words[CAMBER_SEGMENT_UX] = s.ux;
    words[CAMBER_SEGMENT_UY] = s.uy;
    words[CAMBER_SEGMENT_NAX] = s.nax;
    words[CAMBER_SEGMENT_NAY] = s.nay;
    words[CAMBER_SEGMENT_NBX] = s.nbx;
    words[CAMBER_SEGMENT_NBY] = s.nby;
    words[CAMBER_SEGMENT_HALF_WIDTH] = s.half_width;
    words[CAMBER_SEGMENT_REACH] = s.reach;
    words[CAMBER_SEGMENT_SLOPE] = s.slope;
    words[CAMBER_SEGMENT_CURVE] = s.curve;
    words[CAMBER_SEGMENT_FLAGS] = as_float(s.flags);
    words[CAMBER_SEGMENT_BRUSH] = row.s3;
}

kernel __attribute__((reqd_work_group_size(SETUP_LANES, 1, 1))) void setup(
    global const camber_u32 *restrict records, global const float *restrict rows, global float *restrict segments,
    global camber_u32 *restrict boxes, const camber_setup_args r, global float *restrict arc_lengths,
    global float *restrict planes) {
    local float words[SETUP_LANES * SETUP_STRIDE];
    const camber_u32 lane = (camber_u32)get_local_id(0), at = (camber_u32)get_global_id(0);
    const camber_u32 count = (r.end - r.first + 15u) / 16u * 16u, first = at - lane;
    if (at < count)
        segment_at(records, rows, (int)(r.first + at), r, words + SETUP_STRIDE * lane, boxes + r.base + at);
    barrier(CLK_LOCAL_MEM_FENCE);
    const camber_u32 mine = count - first < SETUP_LANES ? count - first : SETUP_LANES;
    global float *to = segments + (size_t)CAMBER_SEGMENT_WORDS * (r.base + first);
    for (camber_u32 i = lane; i < CAMBER_SEGMENT_WORDS * mine; i += SETUP_LANES)
        to[i] = words[SETUP_STRIDE * (i / CAMBER_SEGMENT_WORDS) + i % CAMBER_SEGMENT_WORDS];
}
#endif
