/* Reads meshes and their counts back to the host. Parts that have lost their buffers are made again as they are needed,
 * one at a time. */
#include "vertices/vertices.h"

#include <string.h>

/* Counts joins and triangles from the join words on the device, unless that has been done. Few callers need them, so
 * this is done only on request. */
camber_status camber_mesh_count_joins(camber_mesh *mesh) {
    camber_mesh_info counts = mesh->mesh_info;
    camber_status status = camber_check_process(mesh->device->context);
    for (size_t i = 0; i < mesh->part_count && !mesh->joins_counted && status == CAMBER_OK; i++) {
        status = camber_part_ensure_counted(mesh, mesh->parts + i);
        if (status == CAMBER_OK && !mesh->output)
            status = camber_part_number(mesh, mesh->parts + i, &counts);
        if (status == CAMBER_OK)
            status = camber_part_count_joins(mesh, mesh->parts + i, &counts);
    }
    counts.times = mesh->mesh_info.times;
    if (status == CAMBER_OK)
        mesh->mesh_info = counts;
    mesh->joins_counted |= status == CAMBER_OK;
    return status;
}

camber_status camber_mesh_first_index(camber_mesh *mesh, size_t polyline, uint64_t *first_index) {
    size_t i = 0;
    while (i + 1 < mesh->part_count && mesh->parts[i + 1].first_polyline <= polyline)
        i++;
    uint64_t first = 0;
    camber_slot_starts starts = camber_slot_starts_of(mesh, mesh->parts + i);
    camber_status status = !mesh->output ? camber_mesh_count_joins(mesh) : CAMBER_OK;
    if (status == CAMBER_OK && mesh->part_count)
        status = camber_part_ensure_counted(mesh, mesh->parts + i);
    if (status == CAMBER_OK && mesh->part_count)
        status = camber_slot_starts_index(&starts, polyline, &first);
    camber_slot_starts_unmap(&starts);
    if (status == CAMBER_OK)
        *first_index = first + (mesh->part_count ? mesh->parts[i].first_index : 0);
    return status;
}

/* Reads the records of a part. With arc lengths a record has 32 bytes, and the first 16 are its words. */
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

/* Appends a part's records and corners to the records and corners of the previous parts, and continues the numbering of
 * the corners' records. */
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
