/* Makes the buffers of parts large enough, and makes room for them. */
#include "residency/memory.h"
#include "residency/parts.h"

camber_status camber_part_reserve(camber_mesh *mesh, camber_mesh_part *part, size_t slots, bool borrowed) {
    const camber_device *device = mesh->device;
    const uint64_t wanted = camber_part_slots_bytes(mesh, part, slots);
    if (wanted > camber_device_share(device, 4))
        return camber_fail_memory(mesh, part->first_polyline, wanted);
    const uint64_t needed = wanted - (borrowed ? camber_point_bytes(slots) : 0);
    const uint64_t there = slots > part->slot_capacity ? camber_part_input_bytes(mesh, part) : 0;
    camber_status status = CAMBER_OK;
    if (!camber_part_has_input(mesh, part, slots, borrowed))
        status = camber_mesh_make_room(mesh, part, needed > there ? needed - there : 0);
    if (status == CAMBER_OK)
        status = camber_part_make_input(mesh, part, slots, borrowed);
    if (status == CAMBER_OK && !camber_grow(device->context, &part->host_bases, &part->base_capacity,
                                            2 * (part->slot_capacity / device->block + 1), sizeof *part->host_bases))
        status = CAMBER_ERROR_MEMORY;
    camber_part_count_bytes(mesh, part);
    return status;
}

camber_status camber_part_reserve_with_spare(camber_mesh *mesh, camber_mesh_part *part, size_t slots) {
    const size_t block = mesh->device->block, more = slots + slots / 4 / block * block;
    const bool enough =
        slots <= part->slot_capacity || !mesh->held ||
        4 * ((uint64_t)more + 2) > mesh->device->info.largest_buffer_bytes ||
        !camber_device_is_roomy(mesh->device, camber_input_bytes(mesh->device, mesh->mesh_info.has_arc_length, more));
    part->slot_count = slots;
    return camber_part_reserve(mesh, part, enough ? slots : more, false);
}

camber_status camber_part_reserve_source_lines(camber_mesh *mesh, camber_mesh_part *part, size_t slots) {
    const bool has_arc_length = mesh->mesh_info.has_arc_length;
    const camber_device *device = mesh->device;
    const uint64_t wanted = camber_source_line_bytes(has_arc_length, slots);
    if (slots <= part->source_line.slot_capacity && (!has_arc_length || part->source_line.arc_lengths))
        return CAMBER_OK;
    if (wanted > camber_device_share(device, 4))
        return camber_fail_memory(mesh, part->first_polyline, wanted);
    const uint64_t held =
        camber_source_line_bytes(part->source_line.arc_lengths != NULL, part->source_line.slot_capacity);
    camber_status status = camber_mesh_make_room(mesh, part, wanted > held ? wanted - held : 0);
    if (status == CAMBER_OK)
        status = camber_part_make_source_lines(mesh, part, slots);
    part->uploaded = false;
    camber_part_count_bytes(mesh, part);
    return status;
}

camber_status camber_part_reserve_output(camber_mesh *mesh, camber_mesh_part *part, size_t which, size_t size_bytes) {
    camber_shared_buffer *buffer = part->buffers + which;
    camber_status status = CAMBER_OK;
    if (size_bytes > buffer->capacity_bytes)
        status = camber_mesh_make_room(mesh, part, mesh->buffer_copies * (size_bytes - buffer->capacity_bytes));
    if (status == CAMBER_OK)
        status = mesh->ops->reserve(mesh->ops_user, buffer, size_bytes);
    camber_part_count_bytes(mesh, part);
    return status;
}
