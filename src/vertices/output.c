/* Makes the output of parts.
 *
 * Input: a part's points. Output: its records and indices, in buffers that GL may read, and its counts.
 *
 *     points
 *        |  scan          per chunk: vertices and indices before it in its block; per block: its sum
 *        |  the host adds the blocks' sums up, and checks that the part fits; if not, it is cut, and made again
 *        v  emit          per slot: its records and indices, where the sums say
 *     output buffers      GL draws them */
#include "vertices/vertices.h"

#include "stroke/stroke.h"

void camber_scan_blocks(const uint32_t *sums, size_t block_count, uint64_t *bases) {
    uint64_t vertices = 0, indices = 0;
    for (size_t i = 0; i <= block_count; i++) {
        bases[2 * i] = vertices;
        bases[2 * i + 1] = indices;
        if (i < block_count) {
            vertices += sums[i] & 0xffffu;
            indices += sums[i] >> 16;
        }
    }
}

/* Returns how many records a scanned part will have. */
static size_t count_records(const camber_mesh *mesh, const camber_mesh_part *part) {
    return mesh->mesh_info.strips ? part->index_count / 2
                                  : camber_part_slot(mesh, part, NULL, part->first_polyline + part->polyline_count);
}

/* Adds up the blocks' sums, and sets how much output the part has. */
static camber_status scan_blocks(const camber_mesh *mesh, camber_mesh_part *part) {
    const camber_device *device = mesh->device;
    const size_t blocks = part->slot_count / device->block;
    const uint32_t *sums;
    const camber_status status = camber_buffer_map(device, part->sums, CAMBER_MAP_READ, 4 * blocks, &sums);
    if (status != CAMBER_OK)
        return status;
    camber_scan_blocks(sums, blocks, part->host_bases);
    camber_buffer_unmap(device, part->sums, sums);
    part->vertex_count = (size_t)part->host_bases[2 * blocks];
    part->index_count = (size_t)part->host_bases[2 * blocks + 1];
    part->record_count = count_records(mesh, part);
    return CAMBER_OK;
}

/* Counts the output of a part; a part without points has none. */
static camber_status count_output(camber_mesh *mesh, camber_mesh_part *part) {
    camber_program *program = NULL;
    if (part->slot_count == 0)
        return CAMBER_OK;
    camber_status status = camber_mesh_program(mesh, mesh->mesh_info.method, &program);
    if (status != CAMBER_OK)
        return status;
    const camber_kernel_arg args[] = {CAMBER_ARG_BUFFER(part->joins), CAMBER_ARG_BUFFER(part->joins),
                                      CAMBER_ARG_BUFFER(part->info), CAMBER_ARG_BUFFER(part->offsets),
                                      CAMBER_ARG_BUFFER(part->sums)};
    status = camber_part_run(mesh, part,
                             (camber_launch){.name = "scan", .kernel = program->scan, .args = args, .arg_count = 5},
                             CAMBER_STAGE_SCAN);
    if (status == CAMBER_OK)
        status = scan_blocks(mesh, part);
    part->scanned = status == CAMBER_OK;
    return status;
}

/* Makes room in an output buffer. For a network it takes a quarter more if the device has plenty of memory, because the
 * next frame may need it. */
static camber_status reserve_buffer(camber_mesh *mesh, camber_mesh_part *part, size_t which, size_t size_bytes) {
    camber_shared_buffer *buffer = part->buffers + which;
    const size_t room = size_bytes + (mesh->held ? size_bytes / 4 : 0);
    const bool enough = size_bytes <= buffer->capacity_bytes || room > mesh->device->info.largest_buffer_bytes ||
                        !camber_device_is_roomy(mesh->device, mesh->buffer_copies * room);
    const camber_status status = camber_part_reserve_output(mesh, part, which, enough ? size_bytes : room);
    if (status == CAMBER_OK)
        buffer->used_bytes = size_bytes;
    return status;
}

static camber_status reserve_output(camber_mesh *mesh, camber_mesh_part *part) {
    const bool strips = mesh->mesh_info.strips;
    const size_t records = strips ? part->record_count : part->slot_count;
    const size_t indices = part->index_count ? part->index_count : 1; /* a buffer may not be empty */
    camber_status status =
        reserve_buffer(mesh, part, CAMBER_BUFFER_RECORDS, records * camber_record_bytes(&mesh->mesh_info));
    if (status == CAMBER_OK && !strips)
        status = reserve_buffer(mesh, part, CAMBER_BUFFER_INDICES, 4 * indices);
    return status == CAMBER_OK ? mesh->ops->begin(mesh->ops_user, part->buffers, camber_buffer_count(mesh)) : status;
}

camber_status camber_part_finish(const camber_mesh *mesh, camber_mesh_part *part, bool written, camber_status status) {
    camber_saved_log kept;
    if (status == CAMBER_OK)
        return mesh->ops->finish(mesh->ops_user, part->buffers, camber_buffer_count(mesh), written);
    camber_log_demote_errors(mesh->device->context, &kept);
    (void)mesh->ops->finish(mesh->ops_user, part->buffers, camber_buffer_count(mesh), written);
    camber_log_restore(mesh->device->context, &kept);
    return status;
}

/* Runs emit and waits for it. */
static camber_status emit(camber_mesh *mesh, camber_mesh_part *part, const camber_program *program) {
    const camber_device *device = mesh->device;
    camber_status status =
        camber_buffer_write_later(device, part->bases, 0, 16 * (part->slot_count / device->block), part->host_bases);
    if (status == CAMBER_OK)
        status = reserve_output(mesh, part);
    if (status != CAMBER_OK)
        return status;
    camber_event *event = NULL;
    /* strips have no indices */
    const size_t second = mesh->mesh_info.strips ? CAMBER_BUFFER_RECORDS : CAMBER_BUFFER_INDICES;
    const camber_kernel_arg args[] = {CAMBER_ARG_BUFFER(part->x),
                                      CAMBER_ARG_BUFFER(part->y),
                                      CAMBER_ARG_BUFFER(part->info),
                                      CAMBER_ARG_BUFFER(mesh->rows),
                                      CAMBER_ARG_BUFFER(part->joins),
                                      CAMBER_ARG_BUFFER(part->offsets),
                                      CAMBER_ARG_BUFFER(part->bases),
                                      CAMBER_ARG_BUFFER(part->buffers[CAMBER_BUFFER_RECORDS].buffer),
                                      CAMBER_ARG_BUFFER(part->buffers[second].buffer),
                                      CAMBER_ARG_BUFFER(mesh->mesh_info.has_arc_length ? part->arc_lengths : NULL)};
    const camber_launch launch = {
        "emit", program->emit, args, 10, part->slot_count / device->point_chunk, device->block / device->point_chunk};
    status = camber_launch_kernel(device, &launch, &event);
    if (status == CAMBER_OK)
        status = camber_device_finish(device);
    else
        camber_device_settle(device);
    status = camber_part_finish(mesh, part, true, status);
    camber_mesh_add_time(mesh, CAMBER_STAGE_EMIT, event);
    return status;
}

/* Emits a part that has been counted. */
static camber_status emit_unless_empty(camber_mesh *mesh, camber_mesh_part *part) {
    camber_program *program = NULL;
    camber_status status = CAMBER_OK;
    if (part->record_count > 0) {
        status = camber_mesh_program(mesh, mesh->mesh_info.method, &program);
        if (status == CAMBER_OK)
            status = emit(mesh, part, program);
    }
    part->emitted = status == CAMBER_OK;
    return status;
}

camber_status camber_part_number(const camber_mesh *mesh, camber_mesh_part *part, camber_mesh_info *counts) {
    part->first_record = counts->record_count;
    part->first_vertex = counts->vertex_count;
    part->first_index = counts->index_count;
    counts->record_count += part->record_count;
    counts->vertex_count += part->vertex_count;
    counts->index_count += part->index_count;
    return counts->record_count > camber_records_max(counts->method)
               ? camber_fail_records(mesh->device->context, counts->method)
               : CAMBER_OK;
}

/* Counts a part's output, and its joins as well if parts may be evicted later. */
static camber_status count(camber_mesh *mesh, camber_mesh_part *part, bool *fits) {
    camber_status status = count_output(mesh, part);
    if (status == CAMBER_OK)
        status = camber_part_check_output(mesh, part, fits);
    if (status != CAMBER_OK || !*fits)
        return status;
    status = camber_part_number(mesh, part, &mesh->mesh_info);
    return status == CAMBER_OK && camber_mesh_counts_early(mesh) ? camber_part_count_joins(mesh, part, &mesh->mesh_info)
                                                                 : status;
}

static camber_status remake(camber_mesh *mesh, camber_mesh_part *part) {
    const size_t records = part->record_count, vertices = part->vertex_count, indices = part->index_count;
    camber_status status = count_output(mesh, part);
    if (status == CAMBER_OK && (part->record_count != records || part->index_count != indices))
        status = camber_part_fail_remade(mesh, part, part->slot_count, records);
    part->record_count = records;
    part->vertex_count = vertices;
    part->index_count = indices;
    return status == CAMBER_OK ? emit_unless_empty(mesh, part) : status;
}

const camber_mesh_output camber_vertices = {count, emit_unless_empty, remake};

camber_status camber_part_ensure_counted(camber_mesh *mesh, camber_mesh_part *part) {
    const size_t records = part->record_count, indices = part->index_count;
    camber_status status = camber_part_ensure_classified(mesh, part, mesh->mesh_info.method);
    if (status != CAMBER_OK || part->scanned)
        return status;
    status = count_output(mesh, part);
    /* Callers that read the mesh have allocated memory for the earlier counts. */
    if (status == CAMBER_OK && mesh->joins_counted && (part->record_count != records || part->index_count != indices))
        status = camber_part_fail_remade(mesh, part, part->slot_count, records);
    if (status != CAMBER_OK)
        part->scanned = false;
    return status;
}

camber_status camber_part_ensure_output(camber_mesh *mesh, camber_mesh_part *part) {
    const camber_status status = camber_part_ensure_counted(mesh, part);
    return status == CAMBER_OK && !part->emitted ? emit_unless_empty(mesh, part) : status;
}
