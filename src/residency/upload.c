/* Brings the slots of polylines, and the sections of a network, to the device. */
#include "residency/memory.h"
#include "residency/parts.h"

/* Whether the buffers for the upload are complete, including the buffers for arc lengths if these are needed now. */
static bool has_upload_buffers(const camber_mesh *mesh, const camber_mesh_part *part) {
    return !mesh->mesh_info.has_arc_length || (mesh->has_offsets ? part->source_line.arc_lengths : part->arc_lengths);
}

void camber_mesh_return_points(camber_mesh *mesh) {
    for (size_t i = 0; i < mesh->part_capacity; i++) {
        camber_mesh_part *part = mesh->parts + i;
        if (!part->borrowed)
            continue;
        camber_device_settle(mesh->device); /* after this the device no longer uses them */
        part->uploaded = false;
        camber_part_release_points(mesh, part);
    }
}

/* Lets kernels borrow the polylines' arrays (zero copy), which begin with the part's sentinel. */
static camber_status borrow_points(camber_mesh *mesh, camber_mesh_part *part, size_t words) {
    const camber_polylines *polylines = mesh->polylines;
    const struct {
        camber_buffer **buffer;
        const void *words;
    } arrays[] = {{&part->x, polylines->x}, {&part->y, polylines->y}, {&part->info, polylines->info}};
    camber_status status = CAMBER_OK;
    camber_part_release_points(mesh, part);
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays && status == CAMBER_OK; i++)
        status =
            camber_buffer_create(mesh->device, CAMBER_BUFFER_BORROWED, 4 * words, arrays[i].words, arrays[i].buffer);
    part->borrowed = true;
    return status;
}

camber_status camber_part_upload(camber_mesh *mesh, camber_mesh_part *part) {
    static const uint32_t zeros[CAMBER_BLOCK + 2];
    const camber_device *device = mesh->device;
    const camber_polylines *polylines = mesh->polylines;
    part->slot_count = part->given_count;
    part->used_slots = mesh->first_slots[part->first_polyline + part->polyline_count] - part->first_slot;
    if (part->given_count == 0 || (part->uploaded && has_upload_buffers(mesh, part)))
        return CAMBER_OK;
    const camber_source_line_buffers *source_line = &part->source_line;
    const size_t words = part->given_count + 2, first = part->first_slot;
    const bool borrowed =
        device->host_memory && !mesh->has_offsets && mesh->part_count == 1 && words <= polylines->slot_count + 2;
    camber_status status = mesh->has_offsets ? camber_part_reserve_source_lines(mesh, part, part->given_count)
                                             : camber_part_reserve(mesh, part, part->given_count, borrowed);
    if (status == CAMBER_OK && borrowed)
        status = borrow_points(mesh, part, words);
    const size_t end = part->first_polyline + part->polyline_count;
    /* The words of a part are the one before its first slot, its slots, and sentinels. The last part takes sentinels
     * from the polylines' own padding; other parts, and whatever is still missing, get zeros. */
    size_t given = end < mesh->polyline_count ? mesh->first_slots[end] - first + 1 : polylines->slot_count + 2 - first;
    given = given < words ? given : words;
    const struct {
        camber_buffer *buffer;
        const void *bytes;
    } arrays[] = {{mesh->has_offsets ? source_line->x : part->x, polylines->x + first},
                  {mesh->has_offsets ? source_line->y : part->y, polylines->y + first},
                  {mesh->has_offsets ? source_line->info : part->info, polylines->info + first}};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays && !borrowed; i++) {
        if (status == CAMBER_OK)
            status = camber_buffer_write_later(device, arrays[i].buffer, 0, 4 * given, arrays[i].bytes);
        if (status == CAMBER_OK && given < words)
            status = camber_buffer_write_later(device, arrays[i].buffer, 4 * given, 4 * (words - given), zeros);
    }
    /* classify writes a join word for each slot. Neighbours also read the join words of the sentinels around the slots.
     */
    if (status == CAMBER_OK && !mesh->has_offsets)
        status = camber_buffer_write_later(device, part->joins, 0, 4, zeros);
    if (status == CAMBER_OK && !mesh->has_offsets)
        status = camber_buffer_write_later(device, part->joins, 4 * (words - 1), 4, zeros);
    part->uploaded = status == CAMBER_OK;
    return status;
}

camber_status camber_part_upload_section(camber_mesh *mesh, const camber_mesh_part *part) {
    const camber_device *device = mesh->device;
    const camber_network *network = mesh->held->network;
    camber_section *section = mesh->held->sections + part->section;
    if (section->x)
        return CAMBER_OK;
    camber_status status =
        camber_mesh_make_room(mesh, part, camber_section_bytes(network, section, !device->host_memory));
    if (status == CAMBER_OK)
        status = camber_section_upload(device, network, section);
    camber_section_count_bytes(mesh, section);
    return status;
}
