/* Expands records into vertices and indices on the host, as shaders/stroke.vert does on the fly.
 *
 * Input: the records of a mesh, and corners (record | which corner) for kite and fan. Output: one camber_vertex for
 * each distinct vertex, and indices that number them. The device's output is not trusted: records and corners that
 * contradict each other give a wrong mesh, which a check finds, but never a read outside an array.
 *
 * Strips: a record is a pair of vertices, left and right of its point. A strip begins with a break, and its first
 * record repeats the point for the outgoing segment:
 *
 *     records     break  start  end   end   break  start  end
 *     vertices           0 1    2 3   4 5          6 7    8 9
 *     indices     R R    0 1    2 3   4 5   R R    6 7    8 9        R: CAMBER_RESTART_INDEX
 *
 * At a tight join the start shares its outer vertex with the end before it, whose index is repeated there.
 *
 * Kite and fan: a record is a point, and triangles name its corners. Only corners that are named become vertices:
 *
 *        in                     out        1 IN_LEFT, 2 IN_RIGHT: of the segment into the point
 *     ---------1        3---------         3 OUT_LEFT, 4 OUT_RIGHT: of the segment out
 *              |   0    |                  0 CENTRE: the point
 *     ---------2        4---------         5 and more: a join's own corners */
#include "vertices/vertices.h"

#include "kernels/join.h"

#include <string.h>

#define CORNER_MASK ((1u << CAMBER_CORNER_BITS) - 1u)

/* Makes a vertex of record `at`. Its segment is the one out of the point if `out` is set, else the one into it; `other`
 * is the record at the segment's other end. */
static camber_vertex make_vertex(const camber_record *records, size_t at, size_t other, bool out) {
    const camber_record *p = records + at, *a = records + (out ? at : other), *b = records + (out ? other : at);
    const uint32_t first = a->join & CAMBER_JOIN_AFTER_FIRST ? 128u : 0u;
    const uint32_t last = b->join & CAMBER_JOIN_BEFORE_LAST ? 256u : 0u;
    return (camber_vertex){
        .x = p->x,
        .y = p->y,
        .dx = b->x - a->x,
        .dy = b->y - a->y,
        .limit_px = CAMBER_NO_LIMIT_PX,
        .flags = (uint16_t)(camber_join_end(a->join) | camber_join_end(b->join) << 3 | (out ? 0u : 64u) | first | last),
        .turn_a = (int16_t)(uint16_t)(a->join & 0xffffu),
        .turn_b = (int16_t)(uint16_t)(b->join & 0xffffu),
        .row = p->last >> CAMBER_POINT_ROW_SHIFT,
    };
}

/* Moves a vertex away from its point: along its segment, and across it to the left, in units of the reach. */
static void set_extrusion(camber_vertex *vertex, float along, float across) {
    vertex->along = along;
    vertex->across = (int16_t)(across * 16384.0f);
}

/* Makes a vertex on an edge of the segment's body. side: 1 left, -1 right. */
static camber_vertex make_edge(const camber_record *records, size_t at, size_t other, bool out, float side,
                               camber_u32 method) {
    camber_vertex vertex = make_vertex(records, at, other, out);
    set_extrusion(&vertex, camber_edge_along(records[at].join, out ? -1.0f : 1.0f, side, method), side);
    vertex.limit_px = camber_edge_limit(records[at].join, side);
    return vertex;
}

/* ---- Strips ---- */

/* Returns the record after or before another; the record itself at the ends of the list. */
static size_t neighbour(size_t record, size_t count, bool behind) {
    if (behind)
        return record + 1 < count ? record + 1 : record;
    return record > 0 ? record - 1 : record;
}

static camber_vertex strip_vertex(const camber_record *records, size_t count, size_t record, bool right) {
    const camber_record *r = records + record;
    const float side = right ? -1.0f : 1.0f;
    const bool out = camber_record_starts(r->last) && !camber_edge_is_shared(r->join, r->last, side);
    return make_edge(records, record, neighbour(record, count, out), out, side, CAMBER_STRIP);
}

/* Gives each record two indices: restarts for a break, else its two vertices. A start shares a vertex with the end
 * before it if camber_edge_is_shared says so. */
static void expand_strip(camber_mesh_data *data) {
    const size_t room = data->info.vertex_count;
    uint32_t count = 0;
    for (size_t i = 0; i < data->info.index_count; i++) {
        const camber_record *record = data->records + i / 2;
        const bool right = i % 2, restarts = record->last & CAMBER_RECORD_START;
        data->indices[i] = CAMBER_RESTART_INDEX;
        if (record->last & CAMBER_RECORD_BREAK)
            continue;
        if (restarts && i >= 2 && camber_edge_is_shared(record->join, record->last, right ? -1.0f : 1.0f)) {
            data->indices[i] = data->indices[i - 2];
        } else if (count < room) {
            data->vertices[count] = strip_vertex(data->records, data->info.record_count, i / 2, right);
            data->indices[i] = count++;
        }
    }
    memset(data->vertices + count, 0, (room - count) * sizeof *data->vertices);
}

/* ---- Corners ---- */

/* Makes the vertex that an index (record and corner) names. */
static camber_vertex corner_vertex(const camber_mesh_data *data, uint32_t index, const camber_row *rows) {
    const camber_record *records = data->records;
    const size_t at = index >> CAMBER_CORNER_BITS;
    const camber_u32 corner = index & CORNER_MASK, join = records[at].join;
    const bool out = camber_corner_goes_out(corner);
    const bool dot = camber_join_kind(join) == CAMBER_KIND_DOT;
    const size_t other = dot ? at : neighbour(at, data->info.record_count, out);
    if (corner >= CAMBER_CORNER_IN_LEFT && corner <= CAMBER_CORNER_OUT_RIGHT)
        return make_edge(records, at, other, out, (corner & 1u) ? 1.0f : -1.0f, (camber_u32)data->info.method);
    camber_vertex vertex = make_vertex(records, at, other, out);
    float along, across;
    camber_join_corner_at(corner, camber_turn_unpack(join), rows[vertex.row].fan_step, &along, &across);
    set_extrusion(&vertex, along, across);
    return vertex;
}

/* The corners of a record that indices refer to, as 128 bits. */
typedef struct corner_set {
    uint64_t bits[2];
} corner_set;

/* Returns how many corners of a set have a smaller number. */
static unsigned count_below(const corner_set *set, camber_u32 corner) {
    const uint64_t below = (1ull << (corner & 63u)) - 1u;
    const unsigned low = (unsigned)__builtin_popcountll(set->bits[0] & (corner < 64 ? below : ~0ull));
    return corner < 64 ? low : low + (unsigned)__builtin_popcountll(set->bits[1] & below);
}

/* Finds which corners of each record are named, and the number of each record's first vertex. An index that names no
 * record is set to 0. */
static camber_status find_corners(camber_context *context, camber_mesh_data *data, corner_set **sets,
                                  uint32_t **first_vertices) {
    const size_t records = data->info.record_count;
    corner_set *found = camber_alloc_zero(context, records + 1, sizeof *found);
    uint32_t *first = found ? camber_alloc(context, records + 1, sizeof *first) : NULL;
    if (!first) {
        camber_free(context, found);
        return CAMBER_ERROR_MEMORY;
    }
    for (size_t i = 0; i < data->info.index_count; i++) {
        const camber_u32 corner = data->corners[i] & CORNER_MASK;
        if (data->corners[i] >> CAMBER_CORNER_BITS >= records)
            data->corners[i] = 0;
        found[data->corners[i] >> CAMBER_CORNER_BITS].bits[corner / 64] |= 1ull << (corner & 63u);
    }
    first[0] = 0;
    for (size_t r = 0; r < records; r++)
        first[r + 1] = first[r] + (unsigned)__builtin_popcountll(found[r].bits[0]) +
                       (unsigned)__builtin_popcountll(found[r].bits[1]);
    *sets = found;
    *first_vertices = first;
    return CAMBER_OK;
}

camber_status camber_mesh_data_find_first_vertices(camber_context *context, camber_mesh_data *data,
                                                   uint32_t **first_vertices) {
    corner_set *sets;
    const camber_status status = find_corners(context, data, &sets, first_vertices);
    if (status == CAMBER_OK)
        camber_free(context, sets);
    return status;
}

/* Numbers the vertices in the order of records, and of corners within a record; then makes them. */
static camber_status expand_corners(camber_context *context, const camber_row *rows, camber_mesh_data *data) {
    corner_set *sets;
    uint32_t *first;
    camber_status status = find_corners(context, data, &sets, &first);
    if (status != CAMBER_OK)
        return status;
    data->info.vertex_count = first[data->info.record_count];
    data->vertices = camber_alloc(context, data->info.vertex_count, sizeof *data->vertices);
    status = data->vertices ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    for (size_t i = 0; status == CAMBER_OK && i < data->info.index_count; i++) {
        const uint32_t index = data->corners[i];
        const size_t r = index >> CAMBER_CORNER_BITS;
        data->indices[i] = first[r] + count_below(sets + r, index & CORNER_MASK);
        data->vertices[data->indices[i]] = corner_vertex(data, index, rows);
    }
    camber_free(context, first);
    camber_free(context, sets);
    return status;
}

bool camber_mesh_data_draws(const camber_mesh_data *data, size_t first_index) {
    const size_t count = data->info.index_count, even = first_index / 2 * 2;
    if (first_index > count || count - first_index < 3)
        return false;
    if (!data->info.strips)
        return first_index % 3 == 0;
    const uint32_t *i = data->indices + first_index, *pair = data->indices + even;
    if (i[0] == CAMBER_RESTART_INDEX || i[1] == CAMBER_RESTART_INDEX || i[2] == CAMBER_RESTART_INDEX)
        return false;
    return pair[0] != pair[2] && !(even + 3 < count && pair[1] == pair[3]);
}

camber_status camber_mesh_expand(camber_context *context, const camber_row *rows, camber_mesh_data *data) {
    data->indices = camber_alloc(context, data->info.index_count, sizeof *data->indices);
    if (!data->indices)
        return CAMBER_ERROR_MEMORY;
    if (data->info.method != CAMBER_METHOD_STRIP)
        return expand_corners(context, rows, data);
    data->vertices = camber_alloc(context, data->info.vertex_count, sizeof *data->vertices);
    if (!data->vertices)
        return CAMBER_ERROR_MEMORY;
    expand_strip(data);
    return CAMBER_OK;
}
