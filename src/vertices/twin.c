/* The CPU twin of classify, scan and emit: the specification that the kernels are compared with.
 *
 * Input: polylines and strokes. Output: camber_mesh_data, and camber_stages if wanted. Main idea: it walks each
 * polyline from its first point to its last and appends records and triangles. It needs no counts and no scan, and
 * shares only the formulas of kernels/join.h with the device. So a mistake in the kernels' bookkeeping cannot hide in a
 * copy of the same mistake.
 *
 * A strip's records, for an open line A B C D that has a tight join at B and a split join at C:
 *
 *     point        A             B           C                   D
 *     record   break start    end start   end break start       end
 *
 * A plain join has a single end, with which the strip continues. For kite and fan there is one record per slot, and the
 * walk appends triangles: the body of each segment when it reaches the segment's end, then that point's join. */
#include "points/rows.h"
#include "stroke/arc_length.h"
#include "stroke/offset.h"
#include "vertices/vertices.h"

#include "kernels/join.h"

#include <string.h>

/* The walk's state: what it reads, and what it appends to. */
typedef struct twin {
    const camber_polylines *polylines;
    const camber_row *rows;
    camber_u32 method;
    camber_mesh_data *data;
    const camber_arc_length *arc_lengths; /* one per slot. NULL: without arc lengths */
    camber_stages *stages;                /* NULL: not wanted */
    uint32_t polyline, point;             /* polyline and number of the next point in stages */
    size_t record_capacity, measure_capacity, index_capacity, stage_capacity, stage_arc_length_capacity;
    bool failed; /* out of memory, or out of 32-bit indices: nothing more is appended */
} twin;

/* The point that the walk has reached: its slot, info and join word, and the join word of the slot before. */
typedef struct visited_point {
    size_t slot;
    camber_u32 info, before, join;
} visited_point;

static bool grow_records(twin *t) {
    camber_context *context = t->polylines->context;
    const size_t count = t->data->info.record_count + 1;
    return camber_grow(context, &t->data->records, &t->record_capacity, count, sizeof *t->data->records) &&
           (!t->arc_lengths ||
            camber_grow(context, &t->data->arc_lengths, &t->measure_capacity, count, sizeof *t->arc_lengths));
}

/* Appends a record that belongs to a slot. Its coordinates may be another slot's. */
static void push_record(twin *t, size_t slot, camber_record record) {
    camber_mesh_info *info = &t->data->info;
    if (t->failed || info->record_count >= camber_records_max(t->data->info.method) || !grow_records(t)) {
        t->failed = true;
        return;
    }
    if (t->arc_lengths)
        t->data->arc_lengths[info->record_count] = t->arc_lengths[slot - 1];
    t->data->records[info->record_count++] = record;
}

static void push_index(twin *t, uint32_t index) {
    camber_mesh_info *info = &t->data->info;
    if (t->failed || !camber_grow(t->polylines->context, &t->data->corners, &t->index_capacity, info->index_count + 1,
                                  sizeof index)) {
        t->failed = true;
        return;
    }
    t->data->corners[info->index_count++] = index;
}

static void push_triangle(twin *t, uint32_t a, uint32_t b, uint32_t c) {
    push_index(t, a);
    push_index(t, b);
    push_index(t, c);
    t->data->info.triangle_count++;
}

/* Appends a record at the point itself. */
static void push_point(twin *t, const visited_point *p, camber_u32 join, camber_u32 last) {
    push_record(t, p->slot, (camber_record){t->polylines->x[p->slot], t->polylines->y[p->slot], join, last});
}

/* Makes the join word of a slot: 0 for a sentinel, a cap at the end of an open line, else a join. */
static camber_u32 join_word(const twin *t, size_t slot, float *half_shorter) {
    const camber_polylines *p = t->polylines;
    const camber_u32 info = p->info[slot];
    const camber_row *row = t->rows + (info >> CAMBER_POINT_ROW_SHIFT);
    const camber_turn turn = camber_turn_between(p->x[slot] - p->x[slot - 1], p->y[slot] - p->y[slot - 1],
                                                 p->x[slot + 1] - p->x[slot], p->y[slot + 1] - p->y[slot]);
    *half_shorter = turn.half_shorter;
    if (!(info & CAMBER_POINT_REAL) || info & CAMBER_POINT_AREA)
        return 0;
    if (info & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST) && !(info & CAMBER_POINT_RING))
        return camber_cap_word(row->cap, info & CAMBER_POINT_FIRST && info & CAMBER_POINT_LAST);
    const camber_u32 line_ends = camber_line_ends(p->info[slot - 1], p->info[slot + 1]);
    const camber_u32 join = camber_join_word(turn, row, t->method) | line_ends;
    return t->method == CAMBER_STRIP ? join | camber_stub_pack(row->cap, turn.half_shorter) : join;
}

/* ---- strip ---- */

/* Begins a strip: a break at the slot `from`, where the segment into the point starts, then the point. */
static void push_start(twin *t, const visited_point *p, size_t from, camber_u32 last) {
    push_record(t, p->slot,
                (camber_record){t->polylines->x[from], t->polylines->y[from], 0,
                                (p->info & CAMBER_ROW_BITS) | CAMBER_RECORD_BREAK});
    push_point(t, p, p->join, last);
    t->data->info.vertex_count += 2;
}

/* Repeats the point at a tight join for the outgoing segment, which has an inner vertex of its own. */
static void push_tight_start(twin *t, const visited_point *p) {
    push_point(t, p, p->join, p->info | CAMBER_RECORD_START);
    t->data->info.vertex_count++;
}

/* Appends the records of a point. Their table is above camber_strip_records in kernels/join.h. */
static void walk_strip_point(twin *t, const visited_point *p) {
    const bool first = p->info & CAMBER_POINT_FIRST, last = p->info & CAMBER_POINT_LAST;
    if (first)
        push_start(t, p, p->info & CAMBER_POINT_RING ? p->slot - 1 : p->slot, p->info);
    if (first && !last)
        return;
    push_point(t, p, p->join, p->info & ~CAMBER_POINT_FIRST);
    t->data->info.vertex_count += 2;
    t->data->info.triangle_count += 2;
    if (!last && camber_join_kind(p->join) == CAMBER_KIND_TIGHT)
        push_tight_start(t, p);
    if (!last && camber_join_kind(p->join) == CAMBER_KIND_SPLIT)
        push_start(t, p, p->slot - 1, p->info | CAMBER_RECORD_START);
}

/* ---- kite and fan ---- */

static uint32_t corner_at(size_t slot, camber_u32 corner) {
    return (uint32_t)(slot - 1) << CAMBER_CORNER_BITS | corner;
}

/* Appends the triangles of a segment's body, which ends at the point. At a join the body has the point as a vertex (a,
 * b), so that the join's triangles can share this vertex; at a cap it is a plain quad's side.
 *
 *     left ----------------- end_left          both ends joined: four triangles around a and b
 *       |                        |             one joined: three
 *       a                        b             none: two
 *       |                        |
 *     right ---------------- end_right */
static void push_body(twin *t, const visited_point *p) {
    const uint32_t left = corner_at(p->slot - 1, camber_start_corner(p->before, 1.0f, t->method));
    const uint32_t right = corner_at(p->slot - 1, camber_start_corner(p->before, -1.0f, t->method));
    const uint32_t end_left = corner_at(p->slot, CAMBER_CORNER_IN_LEFT), end_right = end_left + 1;
    const uint32_t a = corner_at(p->slot - 1, CAMBER_CORNER_CENTRE), b = corner_at(p->slot, CAMBER_CORNER_CENTRE);
    const bool starts_joined = camber_join_kind(p->before) != CAMBER_KIND_CAP;
    const bool ends_joined = camber_join_kind(p->join) != CAMBER_KIND_CAP;
    if (starts_joined && ends_joined) {
        push_triangle(t, left, a, end_left);
        push_triangle(t, a, b, end_left);
        push_triangle(t, b, a, end_right);
        push_triangle(t, a, right, end_right);
    } else if (starts_joined) {
        push_triangle(t, a, right, end_right);
        push_triangle(t, a, end_right, end_left);
        push_triangle(t, left, a, end_left);
    } else if (ends_joined) {
        push_triangle(t, b, end_left, left);
        push_triangle(t, b, left, right);
        push_triangle(t, b, right, end_right);
    } else {
        push_triangle(t, left, right, end_left);
        push_triangle(t, right, end_right, end_left);
    }
}

/* Appends a join's triangles. They turn around the centre on the outer side, from the outer edge of the incoming
 * segment to the outer edge of the outgoing one. A triangle's last vertex tells the shader its segment, so the order of
 * vertices depends on which vertex carries the right segment. The triangles wind like those of the bodies. */
static void push_join(twin *t, const visited_point *p) {
    const uint32_t triangles = camber_join_triangles(p->join), centre = corner_at(p->slot, CAMBER_CORNER_CENTRE);
    const bool left_is_outer = !(camber_turn_unpack(p->join) > 0.0f);
    const bool is_fan = t->method == CAMBER_FAN && camber_join_end(p->join) == CAMBER_END_ROUND;
    uint32_t from = corner_at(p->slot, left_is_outer ? CAMBER_CORNER_IN_LEFT : CAMBER_CORNER_IN_RIGHT);
    const uint32_t last = corner_at(p->slot, left_is_outer ? CAMBER_CORNER_OUT_LEFT : CAMBER_CORNER_OUT_RIGHT);
    for (uint32_t i = 0; i < triangles; i++) {
        const uint32_t own = corner_at(p->slot, camber_join_corner(i, triangles, is_fan));
        const uint32_t to = i + 1 < triangles ? own : last;
        const bool from_carries = i == 0 && triangles > 1;
        if (from_carries && left_is_outer)
            push_triangle(t, centre, to, from);
        else if (from_carries)
            push_triangle(t, to, centre, from);
        else if (left_is_outer)
            push_triangle(t, from, centre, to);
        else
            push_triangle(t, centre, from, to);
        from = to;
    }
}

static void walk_body_point(twin *t, const visited_point *p) {
    const uint32_t left = corner_at(p->slot, CAMBER_CORNER_OUT_LEFT), end = corner_at(p->slot, CAMBER_CORNER_IN_LEFT);
    if (camber_join_kind(p->join) == CAMBER_KIND_DOT) {
        push_triangle(t, left, left + 1, end);
        push_triangle(t, left + 1, end + 1, end);
    } else if (!(p->info & CAMBER_POINT_FIRST)) {
        push_body(t, p);
        if (camber_join_kind(p->join) != CAMBER_KIND_CAP)
            push_join(t, p);
    }
}

/* Notes the point's stages. Its vertices and indices begin after everything that has been appended so far. */
static void note_stages(twin *t, size_t slot, camber_u32 join) {
    const camber_polylines *p = t->polylines;
    camber_stages *stages = t->stages;
    if (!stages || t->failed)
        return;
    const size_t count = stages->point_count + 1;
    if (!camber_grow(p->context, &stages->points, &t->stage_capacity, count, sizeof *stages->points) ||
        (t->arc_lengths && !camber_grow(p->context, &stages->arc_lengths, &t->stage_arc_length_capacity, count,
                                        sizeof *stages->arc_lengths))) {
        t->failed = true;
        return;
    }
    if (t->arc_lengths)
        stages->arc_lengths[stages->point_count] = t->arc_lengths[slot - 1];
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
        .info = p->info[slot],
        .first_vertex = t->method == CAMBER_STRIP ? t->data->info.vertex_count : slot - 1,
        .first_index = t->method == CAMBER_STRIP ? 2 * t->data->info.record_count : t->data->info.index_count,
    };
}

static void walk_point(twin *t, const visited_point *p, float half_shorter) {
    const bool real = p->info & CAMBER_POINT_REAL, drawn = camber_join_kind(p->join) != CAMBER_KIND_SENTINEL;
    if (real) {
        note_stages(t, p->slot, p->join);
        camber_mesh_info_add_join(&t->data->info, p->join, p->info);
    }
    if (t->method != CAMBER_STRIP) /* a record for each slot, sentinels too */
        push_point(t, p, camber_record_join(p->join, t->rows[p->info >> CAMBER_POINT_ROW_SHIFT].cap, half_shorter),
                   p->info);
    if (real && drawn && t->method == CAMBER_STRIP)
        walk_strip_point(t, p);
    else if (real && drawn)
        walk_body_point(t, p);
}

static void walk(twin *t) {
    const camber_polylines *lines = t->polylines;
    const size_t slots = lines->first_slots[lines->polyline_count]; /* the padding after them is not part of the mesh */
    visited_point p = {0};
    for (p.slot = 1; p.slot <= slots && !t->failed; p.slot++) {
        float half_shorter = 0.0f;
        p.info = lines->info[p.slot];
        p.before = p.join;
        p.join = join_word(t, p.slot, &half_shorter);
        walk_point(t, &p, half_shorter);
    }
}

/* Replaces records by vertices in the stages of kite and fan. The walk could only note a point's record, because it is
 * not known which of the record's corners become vertices until all triangles have been made. */
static camber_status number_vertices(camber_context *context, camber_mesh_data *data, camber_stages *stages) {
    uint32_t *first_vertices;
    const camber_status status = camber_mesh_data_find_first_vertices(context, data, &first_vertices);
    for (size_t i = 0; status == CAMBER_OK && i < stages->point_count; i++)
        stages->points[i].first_vertex = first_vertices[stages->points[i].first_vertex];
    if (status == CAMBER_OK)
        camber_free(context, first_vertices);
    return status;
}

/* Tessellates into data, and into stages unless that is NULL. Both are empty on failure. */
static camber_status tessellate(camber_context *context, const camber_polylines *polylines,
                                const camber_tessellation_desc *desc, camber_mesh_data *data, camber_stages *stages) {
    camber_row *rows = NULL;
    camber_status status = camber_rows_create(context, polylines->row_count, desc, &rows);
    if (status != CAMBER_OK)
        return status;
    if (stages)
        stages->context = context;
    camber_arc_length *arc_lengths = NULL;
    camber_polylines *beside = NULL;
    if (desc->has_arc_length)
        status = camber_polylines_sum_arc_lengths(polylines, &arc_lengths);
    if (status == CAMBER_OK && camber_desc_has_offsets(desc)) {
        status = camber_polylines_offset(polylines, desc, arc_lengths, &beside);
        if (beside)
            polylines = beside;
    }
    data->context = context;
    data->info = (camber_mesh_info){
        .method = desc->method, .strips = desc->method == CAMBER_METHOD_STRIP, .has_arc_length = desc->has_arc_length};
    twin t = {.polylines = polylines,
              .rows = rows,
              .method = (camber_u32)desc->method,
              .data = data,
              .arc_lengths = beside ? beside->arc_lengths : arc_lengths,
              .stages = stages};
    if (status == CAMBER_OK)
        walk(&t);
    camber_mesh_info *info = &data->info;
    if (t.failed)
        status = info->record_count >= camber_records_max(desc->method) ? camber_fail_records(context, desc->method)
                                                                        : CAMBER_ERROR_MEMORY;
    if (info->strips)
        info->index_count = 2 * info->record_count;
    info->bytes = info->record_count * camber_record_bytes(info) + (info->strips ? 0 : 4 * info->index_count);
    if (status == CAMBER_OK)
        status = camber_mesh_expand(context, rows, data);
    if (status == CAMBER_OK && stages && !info->strips)
        status = number_vertices(context, data, stages);
    camber_polylines_destroy(beside);
    camber_free(context, arc_lengths);
    camber_free(context, rows);
    if (status == CAMBER_OK)
        return status;
    camber_mesh_data_destroy(data);
    if (stages)
        camber_stages_destroy(stages);
    return status;
}

camber_status camber_mesh_data_tessellate(camber_context *context, const camber_polylines *polylines,
                                          const camber_tessellation_desc *desc, camber_mesh_data *data) {
    camber_mesh_data made = {0};
    const camber_status status = tessellate(context, polylines, desc, &made, NULL);
    if (status == CAMBER_OK)
        *data = made;
    return status;
}

camber_status camber_stages_tessellate(camber_context *context, const camber_polylines *polylines,
                                       const camber_tessellation_desc *desc, camber_stages *stages) {
    camber_mesh_data mesh = {0};
    camber_stages made = {0};
    const camber_status status = tessellate(context, polylines, desc, &mesh, &made);
    camber_mesh_data_destroy(&mesh);
    if (status == CAMBER_OK)
        *stages = made;
    return status;
}
