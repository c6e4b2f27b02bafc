/* emit: per point, its vertices and indices.
 * Reads x, y, info[n + 2], joins[n + 2], offsets[n], bases[2 * n / CAMBER_BLOCK] (each block's first vertex and
 * first index); writes vertices[CAMBER_VERTEX_WORDS * vertex count], indices[index count]. Lists and their
 * order: camber_join_counts in join.h. Without restrict on put_vertex and put_edges emit
 * takes half as long again; with it on the functions that call them oclgrind cannot run what becomes of it. */

/* What the vertices of one end of a segment share. */
typedef struct segment_end {
    float x, y, dx, dy, half_shorter, end;
    camber_u32 join, flags, turns, row;
} segment_end;

static inline void put_vertex(global camber_u32 *restrict vertices, size_t k, const segment_end *e, float along,
                              float limit_px, float across) {
    global camber_u32 *v = vertices + k * CAMBER_VERTEX_WORDS;
    v[0] = as_uint(e->x);
    v[1] = as_uint(e->y);
    v[2] = as_uint(e->dx);
    v[3] = as_uint(e->dy);
    v[4] = as_uint(along);
    v[5] = as_uint(limit_px);
    v[6] = ((camber_u32)(camber_i32)(across * 16384.0f) & 0xffffu) | e->flags << 16;
    v[7] = e->turns;
    v[8] = e->row;
}

static inline void put_edges(global camber_u32 *restrict vertices, size_t k, const segment_end *e) {
    put_vertex(vertices, k, e, camber_edge_along(e->join, e->end, 1.0f, CAMBER_METHOD),
               camber_edge_limit(e->join, e->half_shorter, 1.0f), 1.0f);
    put_vertex(vertices, k + 1, e, camber_edge_along(e->join, e->end, -1.0f, CAMBER_METHOD),
               camber_edge_limit(e->join, e->half_shorter, -1.0f), -1.0f);
}

static inline void put_triangle(global camber_u32 *indices, camber_u32 a, camber_u32 b, camber_u32 c) {
    indices[0] = a;
    indices[1] = b;
    indices[2] = c;
}

/* A dot's segment has no direction, no turns, and its cap at both ends. */
static inline void make_dot(segment_end *in, segment_end *out) {
    in->dx = in->dy = out->dx = out->dy = 0.0f;
    in->turns = out->turns = 0;
    out->flags = camber_join_end(in->join) * 9u;
    in->flags = out->flags | 64u;
}

#if CAMBER_METHOD == CAMBER_STRIP

/* A point of a strip. Its branches are what it costs on a CPU: two of them, at the beginning of a polyline and where
 * the strip breaks; everything else is a choice of values. */
static inline void put_strip_point(global camber_u32 *vertices, global camber_u32 *index, size_t k, camber_u32 point,
                                   const segment_end *in, const segment_end *out) {
    const camber_u32 kind = camber_join_kind(in->join), v = (camber_u32)k;
    const camber_u32 breaks = camber_strip_breaks(kind, point);
    /* Most points by far: a cut inside a polyline. */
    if (kind == CAMBER_KIND_CUT && !(point & CAMBER_POINT_FIRST)) {
        const float along = camber_edge_along(in->join, 1.0f, 1.0f, CAMBER_METHOD);
        index[0] = v;
        index[1] = v + 1;
        put_vertex(vertices, k, in, along, CAMBER_NO_LIMIT_PX, 1.0f);
        put_vertex(vertices, k + 1, in, -along, CAMBER_NO_LIMIT_PX, -1.0f);
        return;
    }
    if (point & CAMBER_POINT_FIRST) {
        index[0] = 0xffffffffu;
        index[1] = v;
        index[2] = v + 1;
        /* A ring's seam begins with the vertices that it ends with, to the last bit: no pixel falls between. No
         * triangle ends with them, so they may carry the other segment. */
        put_edges(vertices, k, kind == CAMBER_KIND_CUT ? in : out);
        if (breaks) { /* a dot */
            index[3] = v + 2;
            index[4] = v + 3;
            put_edges(vertices, k + 2, in);
        }
        return;
    }
    index[0] = v;
    index[1] = v + 1;
    put_edges(vertices, k, in);
    if (!breaks)
        return;
    index[2] = 0xffffffffu;
    if (kind == CAMBER_KIND_TIGHT) {
        const float side = camber_turn_unpack(in->join) > 0.0f ? 1.0f : -1.0f;
        index[3] = side > 0.0f ? v + 2 : v;
        index[4] = side > 0.0f ? v + 1 : v + 2;
        put_vertex(vertices, k + 2, out, camber_edge_along(out->join, -1.0f, side, CAMBER_METHOD),
                   camber_edge_limit(out->join, out->half_shorter, side), side);
    } else {
        index[3] = v + 2;
        index[4] = v + 3;
        put_edges(vertices, k + 2, out);
    }
}

#else

/* The edges of the segment out. Where a kite's bodies are cut they meet in one inner vertex: it is the segment in's, to
 * the last bit, so that no pixel falls between. No triangle ends with it. */
static inline void put_out_edges(global camber_u32 *vertices, size_t k, const segment_end *in, const segment_end *out) {
    const float q = camber_turn_unpack(out->join), side = q > 0.0f ? 1.0f : -1.0f;
    put_edges(vertices, k, out);
    if (CAMBER_METHOD == CAMBER_KITE && camber_join_kind(out->join) == CAMBER_KIND_CUT)
        put_vertex(vertices, k + (q > 0.0f ? 0 : 1), in, camber_edge_along(in->join, 1.0f, side, CAMBER_METHOD),
                   camber_edge_limit(in->join, in->half_shorter, side), side);
}

/* The body between the start's L, R (s, s + 1) and the end's (e, e + 1); a and b are the centres where the ends are
 * joins. Every triangle ends with a vertex that carries the segment, and all wind alike:
 *
 *     sL--------eL
 *     A          B
 *     sR--------eR
 */
static inline camber_u32 put_body(global camber_u32 *indices, camber_u32 s, camber_u32 e, camber_u32 has_a,
                                  camber_u32 b, camber_u32 has_b) {
    const camber_u32 a = s - 1;
    if (has_a && has_b) {
        put_triangle(indices, s, a, e);
        put_triangle(indices + 3, a, b, e);
        put_triangle(indices + 6, b, a, e + 1);
        put_triangle(indices + 9, a, s + 1, e + 1);
        return 12;
    }
    if (has_a) {
        put_triangle(indices, a, s + 1, e + 1);
        put_triangle(indices + 3, a, e + 1, e);
        put_triangle(indices + 6, s, a, e);
        return 9;
    }
    if (has_b) {
        put_triangle(indices, b, e, s);
        put_triangle(indices + 3, b, s, s + 1);
        put_triangle(indices + 6, b, s + 1, e + 1);
        return 9;
    }
    put_triangle(indices, s, s + 1, e);
    put_triangle(indices + 3, s + 1, e + 1, e);
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

/* The join's own vertices, from the outer edge of the segment in to that of the segment out:
 *   kite  1: C, where the outer edges meet;  3: C1, E on the bisector, C2 of two half turns
 *   fan   steps of the row's angle */
static inline void put_join_vertices(global camber_u32 *vertices, size_t k, const segment_end *in,
                                     const segment_end *out, camber_row row, float outer) {
    const camber_u32 triangles = camber_join_triangles(in->join);
    const float q = fabs(camber_turn_unpack(in->join));
    if (CAMBER_METHOD == CAMBER_FAN && row.join == 0u) {
        float c = row.fan_cos, s = row.fan_sin;
        for (camber_u32 i = 0; i + 1 < triangles; i++) {
            put_vertex(vertices, k + i, in, s * row.fan_scale, CAMBER_NO_LIMIT_PX, outer * c * row.fan_scale);
            const float next = c * row.fan_cos - s * row.fan_sin;
            s = c * row.fan_sin + s * row.fan_cos;
            c = next;
        }
    } else if (triangles == 2) {
        put_vertex(vertices, k, in, camber_turn_tan_half(q), CAMBER_NO_LIMIT_PX, outer);
    } else if (triangles == 4) {
        const float scale = 1.0f / (1.0f + q * q);
        put_vertex(vertices, k, in, q, CAMBER_NO_LIMIT_PX, outer);
        put_vertex(vertices, k + 1, in, 2.0f * q * scale, CAMBER_NO_LIMIT_PX, outer * (1.0f - q * q) * scale);
        put_vertex(vertices, k + 2, out, -q, CAMBER_NO_LIMIT_PX, outer);
    }
}

static inline void put_join_indices(global camber_u32 *indices, camber_u32 v, camber_u32 triangles, float outer) {
    const camber_u32 p = v + 2 + (triangles ? triangles - 1 : 0);
    const camber_u32 in_edge = outer > 0.0f ? v : v + 1, out_edge = outer > 0.0f ? p + 1 : p + 2;
    camber_u32 from = in_edge;
    for (camber_u32 i = 0; i < triangles; i++) {
        const camber_u32 to = i + 1 < triangles ? v + 2 + i : out_edge;
        /* A kite's tip belongs to neither segment: its first triangle is provoked by the edge vertex. */
        put_wedge(indices + 3 * i, p, from, to, i > 0 || triangles == 1, outer);
        from = to;
    }
}

#endif

kernel __attribute__((reqd_work_group_size(CAMBER_BLOCK, 1, 1))) void emit(
    global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
    global const camber_row *restrict rows, global const camber_u32 *restrict joins,
    global const camber_u32 *restrict offsets, global const camber_u64 *restrict bases,
    global camber_u32 *restrict vertices, global camber_u32 *restrict indices) {
    const size_t i = get_global_id(0) + 1;
    const camber_u32 join = joins[i], kind = camber_join_kind(join);
    if (kind == CAMBER_KIND_GHOST)
        return;
    const size_t block = get_group_id(0);
    const camber_u32 offset = offsets[i - 1];
    const size_t k = (size_t)bases[2 * block] + (offset & 0xffffu);
    global camber_u32 *restrict index = indices + (size_t)bases[2 * block + 1] + (offset >> 16);
    const camber_u32 point = info[i], before = joins[i - 1], after = joins[i + 1];
    const camber_u32 earlier = joins[i > 1 ? i - 2 : 0];
    const float dx = x[i] - x[i - 1], dy = y[i] - y[i - 1], ex = x[i + 1] - x[i], ey = y[i + 1] - y[i];
    const float half_shorter = camber_half_shorter(dx, dy, ex, ey);
    const camber_u32 row = point >> CAMBER_POINT_ROW_SHIFT;
    segment_end in = {x[i], y[i], dx, dy, half_shorter, 1.0f, join, 0, 0, row};
    in.flags =
        camber_join_end(before) | camber_join_end(join) << 3 | 64u | camber_line_ends(earlier, before, join, after);
    in.turns = (before & 0xffffu) | join << 16;
    segment_end out = {x[i], y[i], ex, ey, half_shorter, -1.0f, join, 0, 0, row};
    out.flags = camber_join_end(join) | camber_join_end(after) << 3;
    out.turns = (join & 0xffffu) | after << 16;
    if (kind == CAMBER_KIND_DOT)
        make_dot(&in, &out);

#if CAMBER_METHOD == CAMBER_STRIP
    put_strip_point(vertices, index, k, point, &in, &out);
#else
    const camber_u32 v = (camber_u32)k;
    if (kind == CAMBER_KIND_DOT) {
        put_edges(vertices, k, &out);
        put_edges(vertices, k + 2, &in);
        put_body(index, v, v + 2, 0, 0, 0);
        return;
    }
    const camber_u32 joined = kind != CAMBER_KIND_CAP;
    if (point & CAMBER_POINT_FIRST) {
        if (joined)
            put_vertex(vertices, k, &out, 0.0f, CAMBER_NO_LIMIT_PX, 0.0f);
        put_out_edges(vertices, k + joined, &in, &out);
        return;
    }
    const camber_u32 triangles = camber_join_triangles(join);
    const camber_u32 centre = v + 2 + (triangles ? triangles - 1 : 0);
    const float outer = camber_turn_unpack(join) > 0.0f ? -1.0f : 1.0f;
    put_edges(vertices, k, &in);
    index += put_body(index, v - 2, v, camber_join_kind(before) != CAMBER_KIND_CAP, centre, joined);
    if (!joined)
        return;
    put_join_vertices(vertices, k + 2, &in, &out, rows[row], outer);
    const size_t p = k + (centre - v);
    put_vertex(vertices, p, &out, 0.0f, CAMBER_NO_LIMIT_PX, 0.0f);
    put_out_edges(vertices, p + 1, &in, &out);
    put_join_indices(index, v, triangles, outer);
#endif
}
