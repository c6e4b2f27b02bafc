/* emit: per point, its records and, for kite and fan, its indices.
 * Reads x, y, info[n + 2], joins[n + 2], offsets[n], bases[2 * n / CAMBER_BLOCK] (each block's first vertex and first
 * index); writes records[CAMBER_RECORD_WORDS * record count], indices[index count]. Lists and their order:
 * camber_strip_records and camber_join_counts in join.h. */

static inline void put_record(global camber_u32 *restrict records, size_t k, float x, float y, camber_u32 join,
                              camber_u32 last) {
    vstore4((uint4)(as_uint(x), as_uint(y), join, last), k, records);
}

#if CAMBER_METHOD == CAMBER_STRIP

kernel __attribute__((reqd_work_group_size(CAMBER_BLOCK, 1, 1))) void emit(
    global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
    global const camber_row *restrict rows, global const camber_u32 *restrict joins,
    global const camber_u32 *restrict offsets, global const camber_u64 *restrict bases,
    global camber_u32 *restrict records, global camber_u32 *restrict indices) {
    const size_t i = get_global_id(0) + 1;
    const camber_u32 join = joins[i], kind = camber_join_kind(join), point = info[i];
    if (kind == CAMBER_KIND_GHOST)
        return;
    const size_t k = ((size_t)bases[2 * get_group_id(0) + 1] + (offsets[i - 1] >> 16)) / 2; /* two indices a record */
    const camber_u32 begins = point & CAMBER_POINT_FIRST ? 1u : 0u;
    put_record(records, k + begins, x[i], y[i], join, point);
    const camber_u32 inside = !(point & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST));
    if (begins) { /* a ring's first segment comes in from a ghost; an open line begins with itself */
        const size_t from = point & CAMBER_POINT_RING ? i - 1 : i;
        put_record(records, k, x[from], y[from], 0, CAMBER_RECORD_BREAK | (point & CAMBER_ROW_BITS));
    }
    if (kind == CAMBER_KIND_TIGHT && inside)
        put_record(records, k + 1, x[i], y[i], join, point | CAMBER_RECORD_START);
    if (kind == CAMBER_KIND_SPLIT && inside) {
        put_record(records, k + 1, x[i - 1], y[i - 1], 0, CAMBER_RECORD_BREAK | (point & CAMBER_ROW_BITS));
        put_record(records, k + 2, x[i], y[i], join, point | CAMBER_RECORD_START);
    }
    if (kind == CAMBER_KIND_DOT)
        put_record(records, k + 2, x[i], y[i], join, point & ~CAMBER_POINT_FIRST);
}

#else

static inline void put_triangle(global camber_u32 *indices, camber_u32 a, camber_u32 b, camber_u32 c) {
    indices[0] = a;
    indices[1] = b;
    indices[2] = c;
}

/* The body between the start's L, R (sl, sr) and the end's (e, e + 1); a and b are the centres where the ends are
 * joins. Every triangle ends with a vertex that carries the segment, and all wind alike:
 *
 *     sL--------eL
 *     A          B
 *     sR--------eR
 */
static inline camber_u32 put_body(global camber_u32 *indices, camber_u32 sl, camber_u32 sr, camber_u32 e, camber_u32 a,
                                  camber_u32 has_a, camber_u32 b, camber_u32 has_b) {
    if (has_a && has_b) {
        put_triangle(indices, sl, a, e);
        put_triangle(indices + 3, a, b, e);
        put_triangle(indices + 6, b, a, e + 1);
        put_triangle(indices + 9, a, sr, e + 1);
        return 12;
    }
    if (has_a) {
        put_triangle(indices, a, sr, e + 1);
        put_triangle(indices + 3, a, e + 1, e);
        put_triangle(indices + 6, sl, a, e);
        return 9;
    }
    if (has_b) {
        put_triangle(indices, b, e, sl);
        put_triangle(indices + 3, b, sl, sr);
        put_triangle(indices + 6, b, sr, e + 1);
        return 9;
    }
    put_triangle(indices, sl, sr, e);
    put_triangle(indices + 3, sr, e + 1, e);
    return 6;
}

/* A triangle of a join about the centre p, ending with the vertex that carries its segment. outer < 0: the turn is to
 * the left, the outer side is the right one. */
static inline void put_wedge(global camber_u32 *indices, camber_u32 p, camber_u32 from, camber_u32 to,
                             camber_u32 to_carries, float outer) {
    const camber_u32 carries = to_carries ? to : from, other = to_carries ? from : to;
    const camber_u32 flip = (outer > 0.0f) == (to_carries != 0u);
    put_triangle(indices, flip ? other : p, flip ? p : other, carries);
}

/* From the outer edge of the segment in to that of the segment out. A kite's tip belongs to neither: its first triangle
 * is provoked by the edge. */
static inline void put_join(global camber_u32 *indices, camber_u32 record, camber_u32 triangles, camber_u32 is_fan,
                            float outer) {
    const camber_u32 p = record | CAMBER_CORNER_CENTRE;
    const camber_u32 out_edge = record | (outer > 0.0f ? CAMBER_CORNER_OUT_LEFT : CAMBER_CORNER_OUT_RIGHT);
    camber_u32 from = record | (outer > 0.0f ? CAMBER_CORNER_IN_LEFT : CAMBER_CORNER_IN_RIGHT);
    for (camber_u32 i = 0; i < triangles; i++) {
        const camber_u32 own = record | camber_join_corner(i, triangles, is_fan);
        const camber_u32 to = i + 1 < triangles ? own : out_edge;
        put_wedge(indices + 3 * i, p, from, to, i > 0 || triangles == 1, outer);
        from = to;
    }
}

kernel __attribute__((reqd_work_group_size(CAMBER_BLOCK, 1, 1))) void emit(
    global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
    global const camber_row *restrict rows, global const camber_u32 *restrict joins,
    global const camber_u32 *restrict offsets, global const camber_u64 *restrict bases,
    global camber_u32 *restrict records, global camber_u32 *restrict indices) {
    const size_t i = get_global_id(0) + 1;
    const camber_u32 join = joins[i], kind = camber_join_kind(join), point = info[i];
    const camber_u32 before = joins[i - 1];
    /* A record a slot, ghosts too: a ring's are where its seam's neighbours lie. */
    put_record(records, i - 1, x[i], y[i],
               camber_record_join(
                   join, camber_half_shorter(x[i] - x[i - 1], y[i] - y[i - 1], x[i + 1] - x[i], y[i + 1] - y[i])),
               point);
    if (kind == CAMBER_KIND_GHOST || (point & CAMBER_POINT_FIRST && kind != CAMBER_KIND_DOT))
        return;
    const size_t block = get_group_id(0);
    global camber_u32 *restrict index = indices + (size_t)bases[2 * block + 1] + (offsets[i - 1] >> 16);
    const camber_u32 here = (camber_u32)(i - 1) << CAMBER_CORNER_BITS, in_left = here | CAMBER_CORNER_IN_LEFT;
    if (kind == CAMBER_KIND_DOT) {
        put_body(index, here | CAMBER_CORNER_OUT_LEFT, here | CAMBER_CORNER_OUT_RIGHT, in_left, 0, 0, 0, 0);
        return;
    }
    const camber_u32 start = (camber_u32)(i - 2) << CAMBER_CORNER_BITS, joined = kind != CAMBER_KIND_CAP;
    index += put_body(index, start | camber_start_corner(before, 1.0f, CAMBER_METHOD),
                      start | camber_start_corner(before, -1.0f, CAMBER_METHOD), in_left, start | CAMBER_CORNER_CENTRE,
                      camber_join_kind(before) != CAMBER_KIND_CAP, here | CAMBER_CORNER_CENTRE, joined);
    if (joined)
        put_join(index, here, camber_join_triangles(join), CAMBER_METHOD == CAMBER_FAN && rows[point >> 8].join == 0u,
                 camber_turn_unpack(join) > 0.0f ? -1.0f : 1.0f);
}

#endif
