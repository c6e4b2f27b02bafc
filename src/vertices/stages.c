/* Reads the results of classify and scan back from the device, one struct per point, for checks against the CPU twin.
 *
 * Input: a tessellated mesh. Output: camber_stages, its points in the order of the polylines. The device's output is
 * not trusted: a broken kernel must show up as a difference, never as a read outside a buffer. */
#include "vertices/vertices.h"

/* A part's arrays, mapped into host memory. */
typedef struct arrays {
    const float *x, *y;
    const camber_arc_length *arc_lengths; /* NULL: the mesh has none */
    camber_slot_starts starts;
} arrays;

/* Maps words of a buffer. Does nothing after an earlier failure, so that calls can follow each other. */
static const void *map(const camber_mesh *mesh, camber_buffer *buffer, size_t words, camber_status *status) {
    const void *mapped = NULL;
    if (*status == CAMBER_OK)
        *status = camber_buffer_map(mesh->device, buffer, CAMBER_MAP_READ, 4 * words, &mapped);
    return mapped;
}

/* Appends the points of a part to stages. If a device has counted wrongly, a polyline's slots may be past the part's
 * end or overlap another's. So this function only moves forward, and reads no slot twice. */
static camber_status append_points(const camber_mesh *mesh, const camber_mesh_part *part, arrays *a,
                                   camber_stages *stages) {
    size_t count = 0;
    for (size_t slot = 0; slot < part->slot_count; slot++)
        count += a->starts.info[slot + 1] & CAMBER_POINT_REAL;
    camber_context *context = mesh->device->context;
    size_t capacity = stages->point_count, arc_length_capacity = capacity;
    if (!camber_grow(context, &stages->points, &capacity, stages->point_count + count, sizeof *stages->points) ||
        (a->arc_lengths && !camber_grow(context, &stages->arc_lengths, &arc_length_capacity,
                                        stages->point_count + count, sizeof *stages->arc_lengths)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0, slot = 0; i < part->polyline_count; i++) {
        const size_t polyline = part->first_polyline + i;
        const size_t begin = camber_slot_starts_slot(&a->starts, polyline);
        const size_t wanted = camber_slot_starts_slot(&a->starts, polyline + 1);
        const size_t end = wanted < part->slot_count ? wanted : part->slot_count;
        uint32_t point = 0;
        for (slot = begin > slot ? begin : slot; slot < end; slot++) {
            const size_t word = slot + 1, block = slot / mesh->device->block;
            if (!(a->starts.info[word] & CAMBER_POINT_REAL))
                continue;
            const uint64_t *base = part->host_bases + 2 * block;
            const uint32_t packed = camber_slot_starts_before(&a->starts, slot);
            if (a->arc_lengths)
                stages->arc_lengths[stages->point_count] = a->arc_lengths[slot];
            stages->points[stages->point_count++] = (camber_point_stages){
                .polyline = (uint32_t)polyline,
                .point = point++,
                .x = a->x[word],
                .y = a->y[word],
                .join = a->starts.joins[word],
                .info = a->starts.info[word],
                .first_vertex = part->first_vertex + base[0] + (packed & 0xffffu),
                .first_index = part->first_index + base[1] + (packed >> 16),
            };
        }
    }
    return CAMBER_OK;
}

camber_status camber_mesh_read_stages(camber_mesh *mesh, camber_stages *stages) {
    camber_stages made = {.context = mesh->device->context};
    camber_status status = camber_check_process(made.context);
    if (status == CAMBER_OK && !mesh->output)
        status = camber_mesh_count_joins(mesh);
    for (size_t i = 0; i < mesh->part_count && mesh->done && status == CAMBER_OK; i++) {
        camber_mesh_part *part = mesh->parts + i;
        if (part->slot_count == 0)
            continue;
        status = camber_part_ensure_counted(mesh, part);
        const size_t words = part->slot_count + 2;
        arrays seen = {
            .x = map(mesh, part->x, words, &status),
            .y = map(mesh, part->y, words, &status),
            .starts = camber_slot_starts_of(mesh, part),
        };
        if (mesh->mesh_info.has_arc_length)
            seen.arc_lengths = map(mesh, part->arc_lengths, 2 * part->slot_count, &status);
        if (status == CAMBER_OK)
            status = camber_slot_starts_map(&seen.starts);
        if (status == CAMBER_OK)
            status = append_points(mesh, part, &seen, &made);
        camber_slot_starts_unmap(&seen.starts);
        camber_buffer_unmap(mesh->device, part->x, seen.x);
        camber_buffer_unmap(mesh->device, part->y, seen.y);
        camber_buffer_unmap(mesh->device, part->arc_lengths, seen.arc_lengths);
    }
    if (status != CAMBER_OK) {
        camber_stages_destroy(&made);
        return status;
    }
    *stages = made;
    return CAMBER_OK;
}
