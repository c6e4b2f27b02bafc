/* Meshes: creating them, their counts, where polylines begin in their output, and reading them back to the host.
 *
 * Input: a mesh that tessellate.c has filled. Output: camber_mesh_info and camber_mesh_data. Parts that have lost their
 * buffers are made again as they are needed, one at a time. */
#include "tess/mesh.h"

#include "kernels/join.h"

#include <string.h>

/* ---- Mesh ---- */

camber_status camber_mesh_create_on(camber_device *device, const camber_shared_buffer_ops *ops, void *ops_user,
                                    camber_mesh **mesh) {
    const camber_status status = camber_check_process(device->context);
    camber_mesh *made = status == CAMBER_OK ? camber_alloc_zero(device->context, 1, sizeof *made) : NULL;
    if (!made)
        return status == CAMBER_OK ? CAMBER_ERROR_MEMORY : status;
    made->device = device;
    made->ops = ops ? ops : &camber_shared_buffer_plain;
    made->ops_user = ops ? ops_user : device;
    made->buffer_copies = 1;
    made->empty = true;
    made->next = device->meshes;
    device->meshes = made;
    *mesh = made;
    return CAMBER_OK;
}

void camber_mesh_destroy(camber_mesh *mesh) {
    if (!mesh)
        return;
    camber_context *context = mesh->device->context;
    camber_mesh_return_points(mesh);
    camber_mesh_release_parts(mesh);
    camber_mesh_release_source(mesh);
    camber_buffer_release(mesh->device, &mesh->rows);
    camber_buffer_release(mesh->device, &mesh->offset_rows);
    camber_mesh **link = &mesh->device->meshes;
    while (*link != mesh)
        link = &(*link)->next;
    *link = mesh->next;
    camber_free(context, mesh->host_rows);
    mesh->row_capacity = mesh->host_row_capacity = mesh->offset_row_capacity = 0;
    camber_mesh_count_bytes(mesh);
    camber_free(context, mesh->polyline_rows);
    camber_free(context, mesh->first_slots);
    camber_free(context, mesh);
}

/* ---- Counts ---- */

/* Adds up the joins and segments of slots, from their join and info words. */
static void count_words(const uint32_t *joins, const uint32_t *info, size_t slot_count, camber_mesh_info *counts,
                        size_t *segments) {
    for (size_t i = 1; i <= slot_count; i++) {
        camber_mesh_info_add_join(counts, joins[i], info[i]);
        *segments += (info[i] & (CAMBER_POINT_REAL | CAMBER_POINT_FIRST | CAMBER_POINT_AREA)) == CAMBER_POINT_REAL;
        *segments += camber_join_kind(joins[i]) == CAMBER_KIND_DOT;
    }
}

camber_status camber_part_count_joins(const camber_mesh *mesh, const camber_mesh_part *part, camber_mesh_info *counts,
                                      size_t *segments) {
    const camber_device *device = mesh->device;
    const size_t size_bytes = 4 * (part->slot_count + 2);
    const uint32_t *joins = NULL, *info = NULL;
    if (part->slot_count == 0)
        return CAMBER_OK;
    camber_status status = camber_buffer_map(device, part->joins, CAMBER_MAP_READ, size_bytes, &joins);
    if (status == CAMBER_OK)
        status = camber_buffer_map(device, part->info, CAMBER_MAP_READ, size_bytes, &info);
    if (status == CAMBER_OK)
        count_words(joins, info, part->slot_count, counts, segments);
    camber_buffer_unmap(device, part->info, info);
    camber_buffer_unmap(device, part->joins, joins);
    return status;
}

void camber_mesh_set_counts(camber_mesh *mesh, camber_mesh_info counts, size_t segments) {
    counts.triangle_count = counts.strips ? 2 * segments : counts.index_count / 3;
    mesh->mesh_info = counts;
    mesh->joins_counted = true;
}

/* Counts joins and triangles from the join words on the device, unless that has been done. Few callers want them, so
 * that this waits until one asks. */
camber_status camber_mesh_count_joins(camber_mesh *mesh) {
    camber_mesh_info counts = mesh->mesh_info;
    camber_status status = camber_check_process(mesh->device->context);
    size_t segments = 0;
    for (size_t i = 0; i < mesh->part_count && !mesh->joins_counted && status == CAMBER_OK; i++) {
        status = camber_part_ensure_counted(mesh, mesh->parts + i);
        if (status == CAMBER_OK && mesh->draws_points)
            status = camber_part_number(mesh, mesh->parts + i, &counts);
        if (status == CAMBER_OK)
            status = camber_part_count_joins(mesh, mesh->parts + i, &counts, &segments);
    }
    counts.times = mesh->mesh_info.times;
    if (status == CAMBER_OK && !mesh->joins_counted)
        camber_mesh_set_counts(mesh, counts, segments);
    return status;
}

camber_mesh_info camber_mesh_get_info(const camber_mesh *mesh) {
    return mesh->mesh_info;
}

camber_status camber_mesh_first_index(camber_mesh *mesh, size_t polyline, uint64_t *first_index) {
    size_t i = 0;
    while (i + 1 < mesh->part_count && mesh->parts[i + 1].first_polyline <= polyline)
        i++;
    uint64_t first = 0;
    camber_slot_starts starts = camber_slot_starts_of(mesh, mesh->parts + i);
    camber_status status = mesh->draws_points ? camber_mesh_count_joins(mesh) : CAMBER_OK;
    if (status == CAMBER_OK && mesh->part_count)
        status = camber_part_ensure_counted(mesh, mesh->parts + i);
    if (status == CAMBER_OK && mesh->part_count)
        status = camber_slot_starts_index(&starts, polyline, &first);
    camber_slot_starts_unmap(&starts);
    if (status == CAMBER_OK)
        *first_index = first + (mesh->part_count ? mesh->parts[i].first_index : 0);
    return status;
}

/* ---- Reading back ---- */

camber_status camber_part_finish(const camber_mesh *mesh, camber_mesh_part *part, bool written, camber_status status) {
    camber_soft_log kept;
    if (status == CAMBER_OK)
        return mesh->ops->finish(mesh->ops_user, part->buffers, camber_buffer_count(mesh), written);
    camber_log_soften(mesh->device->context, &kept);
    (void)mesh->ops->finish(mesh->ops_user, part->buffers, camber_buffer_count(mesh), written);
    camber_log_restore(mesh->device->context, &kept);
    return status;
}

/* Reads the records of a part. With arc lengths one has 32 bytes, of which the first 16 are its words. */
static camber_status read_records(const camber_mesh *mesh, const camber_mesh_part *part, camber_mesh_data *data) {
    camber_buffer *buffer = part->buffers[CAMBER_BUFFER_RECORDS].buffer;
    camber_record *records = data->records + part->first_record;
    const size_t count = part->record_count, record_bytes = camber_record_bytes(&mesh->mesh_info);
    const uint8_t *mapped;
    if (!mesh->mesh_info.has_arc_length)
        return camber_buffer_read(mesh->device, buffer, count * record_bytes, records);
    const camber_status status =
        camber_buffer_map(mesh->device, buffer, CAMBER_MAP_READ, count * record_bytes, &mapped);
    if (status != CAMBER_OK)
        return status;
    for (size_t i = 0; i < count; i++) {
        memcpy(records + i, mapped + i * record_bytes, sizeof *records);
        memcpy(data->arc_lengths + part->first_record + i, mapped + i * record_bytes + sizeof *records,
               sizeof *data->arc_lengths);
    }
    camber_buffer_unmap(mesh->device, buffer, mapped);
    return CAMBER_OK;
}

/* Reads a part's records and corners behind those of the parts before, and numbers the corners' records on. */
static camber_status read_part(camber_mesh *mesh, camber_mesh_part *part, camber_mesh_data *data) {
    const size_t buffer_count = camber_buffer_count(mesh);
    camber_status status = camber_part_ensure_output(mesh, part);
    if (status == CAMBER_OK)
        status = mesh->ops->begin(mesh->ops_user, part->buffers, buffer_count);
    if (status != CAMBER_OK)
        return status;
    status = read_records(mesh, part, data);
    if (status == CAMBER_OK && data->corners)
        status = camber_buffer_read(mesh->device, part->buffers[CAMBER_BUFFER_INDICES].buffer, 4 * part->index_count,
                                    data->corners + part->first_index);
    status = camber_part_finish(mesh, part, false, status);
    const uint32_t base = (uint32_t)part->first_record << CAMBER_CORNER_BITS;
    for (size_t i = 0; data->corners && status == CAMBER_OK && i < part->index_count; i++)
        data->corners[part->first_index + i] += base;
    return status;
}

camber_status camber_mesh_read(camber_mesh *mesh, camber_mesh_data *data) {
    camber_context *context = mesh->device->context;
    camber_status status = camber_mesh_count_joins(mesh);
    camber_mesh_data made = {.context = context, .info = mesh->mesh_info};
    if (status != CAMBER_OK)
        return status;
    made.records = camber_alloc(context, made.info.record_count, sizeof *made.records);
    if (made.records && !made.info.strips)
        made.corners = camber_alloc(context, made.info.index_count, sizeof *made.corners);
    if (made.records && made.info.has_arc_length)
        made.arc_lengths = camber_alloc(context, made.info.record_count, sizeof *made.arc_lengths);
    if (!made.records || (!made.info.strips && !made.corners) || (made.info.has_arc_length && !made.arc_lengths))
        status = CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < mesh->part_count && mesh->done && status == CAMBER_OK; i++)
        if (mesh->parts[i].record_count > 0)
            status = read_part(mesh, mesh->parts + i, &made);
    if (status == CAMBER_OK)
        status = camber_mesh_expand(context, mesh->host_rows, &made);
    if (status != CAMBER_OK) {
        camber_mesh_data_destroy(&made);
        return status;
    }
    *data = made;
    return CAMBER_OK;
}
