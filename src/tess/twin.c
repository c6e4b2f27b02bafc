/* The CPU twin: what the kernels are held against. It walks each polyline from its first point to its last and appends,
 * with no counts, scans or offsets, and shares only the formulas of kernels/join.h with the device. */
#include "tess/tess.h"

#include "kernels/join.h"

#include <string.h>

typedef struct twin {
    const camber_polylines *polylines;
    const camber_row *rows;
    camber_u32 method;
    camber_mesh_data *data;
    camber_stages *stages;    /* NULL: not wanted */
    uint32_t polyline, point; /* of its next point */
    size_t vertex_capacity, index_capacity, stage_capacity;
    bool failed; /* out of memory, or of 32-bit indices */
    /* The segment under way: its start's left edge vertex, and its start's centre where that is a join. */
    uint32_t start, start_centre;
    bool start_joined;
} twin;

/* A segment's data as its vertices carry it. */
typedef struct segment {
    float dx, dy;
    uint32_t join_a, join_b, row;
    uint32_t line_ends; /* camber_line_ends */
} segment;

static uint32_t push_vertex(twin *t, camber_vertex vertex) {
    camber_mesh_info *info = &t->data->info;
    if (t->failed || info->vertex_count >= UINT32_MAX - 1 ||
        !camber_grow(t->polylines->context, &t->data->vertices, &t->vertex_capacity, info->vertex_count + 1,
                     sizeof vertex)) {
        t->failed = true;
        return 0;
    }
    t->data->vertices[info->vertex_count] = vertex;
    return (uint32_t)info->vertex_count++;
}

static void push_index(twin *t, uint32_t index) {
    camber_mesh_info *info = &t->data->info;
    if (t->failed || !camber_grow(t->polylines->context, &t->data->indices, &t->index_capacity, info->index_count + 1,
                                  sizeof index)) {
        t->failed = true;
        return;
    }
    t->data->indices[info->index_count++] = index;
}

static void push_triangle(twin *t, uint32_t a, uint32_t b, uint32_t c) {
    push_index(t, a);
    push_index(t, b);
    push_index(t, c);
}

static camber_vertex make_vertex(const twin *t, size_t slot, segment s, bool at_end) {
    return (camber_vertex){
        .x = t->polylines->x[slot],
        .y = t->polylines->y[slot],
        .dx = s.dx,
        .dy = s.dy,
        .limit_px = CAMBER_NO_LIMIT_PX,
        .flags =
            (uint16_t)(camber_join_end(s.join_a) | camber_join_end(s.join_b) << 3 | (at_end ? 64u | s.line_ends : 0u)),
        .turn_a = (int16_t)(uint16_t)(s.join_a & 0xffffu),
        .turn_b = (int16_t)(uint16_t)(s.join_b & 0xffffu),
        .row = s.row,
    };
}

static int16_t pack_across(float across) {
    return (int16_t)(across * 16384.0f);
}

/* The left and right edge vertices of a segment's end; gives the left one's index. */
static uint32_t push_edges(twin *t, size_t slot, segment s, bool at_end, camber_u32 join, float half_shorter) {
    uint32_t left = 0;
    for (int right = 0; right < 2; right++) {
        const float side = right ? -1.0f : 1.0f;
        camber_vertex vertex = make_vertex(t, slot, s, at_end);
        vertex.along = camber_edge_along(join, at_end ? 1.0f : -1.0f, side, t->method);
        vertex.limit_px = camber_edge_limit(join, half_shorter, side);
        vertex.across = pack_across(side);
        const uint32_t index = push_vertex(t, vertex);
        left = right ? left : index;
    }
    return left;
}

static uint32_t push_point(twin *t, size_t slot, segment s, bool at_end, float along, float across) {
    camber_vertex vertex = make_vertex(t, slot, s, at_end);
    vertex.along = along;
    vertex.across = pack_across(across);
    return push_vertex(t, vertex);
}

/* Rings and open ends are told apart by the flags of the point. */
static camber_u32 join_word(const twin *t, size_t slot, float *half_shorter) {
    const camber_polylines *p = t->polylines;
    const camber_u32 info = p->info[slot];
    const camber_row *row = t->rows + (info >> CAMBER_POINT_ROW_SHIFT);
    const camber_turn turn = camber_turn_between(p->x[slot] - p->x[slot - 1], p->y[slot] - p->y[slot - 1],
                                                 p->x[slot + 1] - p->x[slot], p->y[slot + 1] - p->y[slot]);
    *half_shorter = turn.half_shorter;
    if (!(info & CAMBER_POINT_REAL))
        return 0;
    if (info & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST) && !(info & CAMBER_POINT_RING))
        return camber_cap_word(row->cap, info & CAMBER_POINT_FIRST && info & CAMBER_POINT_LAST);
    return camber_join_word(turn, row, t->method);
}

static void walk_dot(twin *t, size_t slot, camber_u32 join) {
    if (camber_join_kind(join) == CAMBER_KIND_GHOST)
        return;
    const camber_u32 end = join & 7u << CAMBER_JOIN_END_SHIFT;
    const segment s = {0.0f, 0.0f, end, end, t->polylines->info[slot] >> CAMBER_POINT_ROW_SHIFT, 0};
    const uint32_t a = push_edges(t, slot, s, false, join, 0.0f), b = push_edges(t, slot, s, true, join, 0.0f);
    if (t->method == CAMBER_STRIP) {
        push_index(t, CAMBER_RESTART_INDEX);
        for (uint32_t i = 0; i < 4; i++)
            push_index(t, a + i);
    } else {
        push_triangle(t, a, a + 1, b);
        push_triangle(t, a + 1, b + 1, b);
    }
    t->data->info.triangle_count += 2;
}

/* ---- strip ---- */

static void push_strip_edge(twin *t, uint32_t left) {
    push_index(t, left);
    push_index(t, left + 1);
}

/* Where a tight join's next strip begins: its own inner vertex, and the outer one that both segments have in common. */
static void push_tight_start(twin *t, size_t slot, segment out, camber_u32 join, float half_shorter, uint32_t in_left) {
    const bool left_is_inner = camber_turn_unpack(join) > 0.0f;
    const float side = left_is_inner ? 1.0f : -1.0f;
    camber_vertex vertex = make_vertex(t, slot, out, false);
    vertex.along = camber_edge_along(join, -1.0f, side, t->method);
    vertex.limit_px = camber_edge_limit(join, half_shorter, side);
    vertex.across = pack_across(side);
    const uint32_t inner = push_vertex(t, vertex);
    push_index(t, left_is_inner ? inner : in_left);
    push_index(t, left_is_inner ? in_left + 1 : inner);
}

static void walk_strip_point(twin *t, size_t slot, segment in, segment out, camber_u32 join, float half_shorter) {
    const camber_u32 info = t->polylines->info[slot], kind = camber_join_kind(join);
    if (info & CAMBER_POINT_FIRST) {
        /* A ring's seam begins with the very vertices that it ends with. */
        const bool seam = kind == CAMBER_KIND_CUT;
        push_index(t, CAMBER_RESTART_INDEX);
        push_strip_edge(t, push_edges(t, slot, seam ? in : out, seam, join, half_shorter));
        return;
    }
    const uint32_t in_left = push_edges(t, slot, in, true, join, half_shorter);
    push_strip_edge(t, in_left);
    t->data->info.triangle_count += 2;
    if (info & CAMBER_POINT_LAST || kind == CAMBER_KIND_CUT)
        return;
    push_index(t, CAMBER_RESTART_INDEX);
    if (kind == CAMBER_KIND_TIGHT)
        push_tight_start(t, slot, out, join, half_shorter, in_left);
    else
        push_strip_edge(t, push_edges(t, slot, out, false, join, half_shorter));
}

/* ---- kite and fan ---- */

static void push_body(twin *t, uint32_t end, uint32_t end_centre, bool end_joined) {
    const uint32_t s = t->start, e = end;
    if (t->start_joined && end_joined) {
        push_triangle(t, s, t->start_centre, e);
        push_triangle(t, t->start_centre, end_centre, e);
        push_triangle(t, end_centre, t->start_centre, e + 1);
        push_triangle(t, t->start_centre, s + 1, e + 1);
    } else if (t->start_joined) {
        push_triangle(t, t->start_centre, s + 1, e + 1);
        push_triangle(t, t->start_centre, e + 1, e);
        push_triangle(t, s, t->start_centre, e);
    } else if (end_joined) {
        push_triangle(t, end_centre, e, s);
        push_triangle(t, end_centre, s, s + 1);
        push_triangle(t, end_centre, s + 1, e + 1);
    } else {
        push_triangle(t, s, s + 1, e);
        push_triangle(t, s + 1, e + 1, e);
    }
    t->data->info.triangle_count += 2u + t->start_joined + end_joined;
}

/* The join's own vertices; gives how many. */
static uint32_t push_join_vertices(twin *t, size_t slot, segment in, segment out, camber_u32 join) {
    const camber_row row = t->rows[in.row];
    const uint32_t triangles = camber_join_triangles(join);
    const float q = camber_turn_unpack(join), outer = q > 0.0f ? -1.0f : 1.0f, a = fabsf(q);
    if (triangles == 0)
        return 0;
    if (t->method == CAMBER_FAN && row.join == CAMBER_JOIN_ROUND) {
        float c = row.fan_cos, s = row.fan_sin;
        for (uint32_t i = 0; i + 1 < triangles; i++) {
            push_point(t, slot, in, true, s * row.fan_scale, outer * c * row.fan_scale);
            const float next = c * row.fan_cos - s * row.fan_sin;
            s = c * row.fan_sin + s * row.fan_cos;
            c = next;
        }
    } else if (triangles == 2) {
        push_point(t, slot, in, true, camber_turn_tan_half(a), outer);
    } else {
        const float scale = 1.0f / (1.0f + a * a);
        push_point(t, slot, in, true, a, outer);
        push_point(t, slot, in, true, 2.0f * a * scale, outer * (1.0f - a * a) * scale);
        push_point(t, slot, out, false, -a, outer);
    }
    return triangles - 1;
}

/* Triangles about the centre from the outer edge of the segment in to that of the segment out, each ending with a
 * vertex that carries the right segment; the winding is that of the bodies. */
static void push_join(twin *t, uint32_t in_left, uint32_t join_vertices, uint32_t centre, camber_u32 join) {
    const uint32_t triangles = camber_join_triangles(join);
    const bool left_is_outer = !(camber_turn_unpack(join) > 0.0f);
    const uint32_t first = in_left + (left_is_outer ? 0 : 1), last = centre + (left_is_outer ? 1 : 2);
    for (uint32_t i = 0; i < triangles; i++) {
        const uint32_t from = i ? in_left + 1 + i : first;
        const uint32_t to = i < join_vertices ? in_left + 2 + i : last;
        const bool from_carries = i == 0 && triangles > 1;
        if (from_carries && left_is_outer)
            push_triangle(t, centre, to, from);
        else if (from_carries)
            push_triangle(t, to, centre, from);
        else if (left_is_outer)
            push_triangle(t, from, centre, to);
        else
            push_triangle(t, centre, from, to);
    }
    t->data->info.triangle_count += triangles;
}

static void walk_body_point(twin *t, size_t slot, segment in, segment out, camber_u32 join, float half_shorter) {
    const camber_u32 info = t->polylines->info[slot];
    const bool joined = camber_join_kind(join) != CAMBER_KIND_CAP;
    if (!(info & CAMBER_POINT_FIRST)) {
        const uint32_t in_left = push_edges(t, slot, in, true, join, half_shorter);
        const uint32_t join_vertices = joined ? push_join_vertices(t, slot, in, out, join) : 0;
        const uint32_t centre = in_left + 2 + join_vertices;
        push_body(t, in_left, centre, joined);
        if (joined)
            push_join(t, in_left, join_vertices, centre, join);
    }
    if (info & CAMBER_POINT_LAST && !joined)
        return;
    if (joined)
        t->start_centre = push_point(t, slot, out, false, 0.0f, 0.0f);
    t->start = push_edges(t, slot, out, false, join, half_shorter);
    t->start_joined = joined;
    if (t->method == CAMBER_KITE && camber_join_kind(join) == CAMBER_KIND_CUT && !t->failed) {
        /* Cut bodies meet in one inner vertex, the one of the segment that comes in. */
        const bool right = !(camber_turn_unpack(join) > 0.0f);
        camber_vertex vertex = make_vertex(t, slot, in, true);
        vertex.along = camber_edge_along(join, 1.0f, right ? -1.0f : 1.0f, t->method);
        vertex.limit_px = camber_edge_limit(join, half_shorter, right ? -1.0f : 1.0f);
        vertex.across = pack_across(right ? -1.0f : 1.0f);
        t->data->vertices[t->start + right] = vertex;
    }
}

/* Where the walk is: what has been appended so far is where this point's vertices and indices begin. */
static void note_stages(twin *t, size_t slot, camber_u32 join) {
    const camber_polylines *p = t->polylines;
    camber_stages *stages = t->stages;
    if (!stages || t->failed)
        return;
    if (!camber_grow(p->context, &stages->points, &t->stage_capacity, stages->point_count + 1,
                     sizeof *stages->points)) {
        t->failed = true;
        return;
    }
    while (p->first_slots[t->polyline + 1] < slot) {
        t->polyline++;
        t->point = 0;
    }
    stages->points[stages->point_count++] = (camber_point_stages){
        .polyline = t->polyline,
        .point = t->point++,
        .x = p->x[slot],
        .y = p->y[slot],
        .join = join,
        .first_vertex = (uint32_t)t->data->info.vertex_count,
        .first_index = t->data->info.index_count,
    };
}

static void walk(twin *t) {
    const camber_polylines *p = t->polylines;
    camber_u32 earlier = 0, before = 0, join = 0, after = 0;
    float half_shorter = 0.0f, half_after = 0.0f;
    after = join_word(t, 1, &half_after);
    for (size_t slot = 1; slot <= p->slot_count && !t->failed; slot++) {
        earlier = before;
        before = join;
        join = after;
        half_shorter = half_after;
        after = slot < p->slot_count ? join_word(t, slot + 1, &half_after) : 0;
        if (!(p->info[slot] & CAMBER_POINT_REAL))
            continue;
        note_stages(t, slot, join);
        camber_mesh_info_count(&t->data->info, join, p->info[slot]);
        const camber_u32 row = p->info[slot] >> CAMBER_POINT_ROW_SHIFT;
        const segment in = {p->x[slot] - p->x[slot - 1],
                            p->y[slot] - p->y[slot - 1],
                            before,
                            join,
                            row,
                            camber_line_ends(earlier, before, join, after)};
        const segment out = {p->x[slot + 1] - p->x[slot], p->y[slot + 1] - p->y[slot], join, after, row, 0};
        if (camber_join_kind(join) <= CAMBER_KIND_DOT)
            walk_dot(t, slot, join);
        else if (t->method == CAMBER_STRIP)
            walk_strip_point(t, slot, in, out, join, half_shorter);
        else
            walk_body_point(t, slot, in, out, join, half_shorter);
    }
}

/* Tessellates into data, and into stages where they are wanted; both are empty on failure. */
static camber_status run(camber_context *context, const camber_polylines *polylines,
                         const camber_tessellation_desc *desc, camber_mesh_data *data, camber_stages *stages) {
    camber_row *rows = NULL;
    const camber_status status = camber_rows_create(context, polylines, desc, &rows);
    if (status != CAMBER_OK)
        return status;
    data->info = (camber_mesh_info){.method = desc->method, .strips = desc->method == CAMBER_METHOD_STRIP};
    twin t = {.polylines = polylines, .rows = rows, .method = (camber_u32)desc->method, .data = data, .stages = stages};
    walk(&t);
    camber_free(context, rows);
    if (!t.failed)
        return CAMBER_OK;
    const bool full = data->info.vertex_count >= UINT32_MAX - 1;
    camber_mesh_data_free(context, data);
    if (stages)
        camber_stages_free(context, stages);
    return full ? camber_fail(context, CAMBER_ERROR_LIMIT, "2^32 - 1 vertices or more; tessellate in parts")
                : CAMBER_ERROR_MEMORY;
}

camber_status camber_tessellate_on_host(camber_context *context, const camber_polylines *polylines,
                                        const camber_tessellation_desc *desc, camber_mesh_data *data) {
    camber_mesh_data made = {0};
    const camber_status status = run(context, polylines, desc, &made, NULL);
    if (status == CAMBER_OK)
        *data = made;
    return status;
}

camber_status camber_stages_on_host(camber_context *context, const camber_polylines *polylines,
                                    const camber_tessellation_desc *desc, camber_stages *stages) {
    camber_mesh_data mesh = {0};
    camber_stages made = {0};
    const camber_status status = run(context, polylines, desc, &mesh, &made);
    camber_mesh_data_free(context, &mesh);
    if (status == CAMBER_OK)
        *stages = made;
    return status;
}

void camber_mesh_data_free(camber_context *context, camber_mesh_data *data) {
    camber_free(context, data->indices);
    camber_free(context, data->vertices);
    *data = (camber_mesh_data){0};
}
