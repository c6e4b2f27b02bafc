/* Counts the bytes that the meshes of a device hold (gpu/memory.h has the memory limit). */
#include "residency/memory.h"

#include "kernels/arc_length.h"
#include "kernels/offset_emit.h"

uint64_t camber_input_bytes(const camber_device *device, bool has_arc_length, size_t slots) {
    const uint64_t blocks = slots / device->block, words = slots ? (uint64_t)slots + 2 : 0;
    const uint64_t arc_lengths =
        sizeof(camber_arc_length) * (uint64_t)slots + 16 * ((uint64_t)slots / CAMBER_ARC_LENGTH_CHUNK);
    return (has_arc_length ? arc_lengths : 0) + 16 * words + 4 * ((uint64_t)slots / device->point_chunk) +
           (4 + 16) * blocks;
}

uint64_t camber_point_bytes(size_t slots) {
    return slots ? 12 * ((uint64_t)slots + 2) : 0;
}

uint64_t camber_source_line_bytes(bool has_arc_length, size_t slots) {
    const uint64_t words = slots ? (uint64_t)slots + 2 : 0;
    const uint64_t arc_lengths =
        sizeof(camber_arc_length) * (uint64_t)slots + 16 * ((uint64_t)slots / CAMBER_ARC_LENGTH_CHUNK);
    return (has_arc_length ? arc_lengths : 0) + (12 + sizeof(camber_offset_clip)) * words + 4 * (uint64_t)slots +
           (slots ? 4 * ((uint64_t)slots / CAMBER_OFFSET_CHUNK + 1) : 0);
}

uint64_t camber_part_input_bytes(const camber_mesh *mesh, const camber_mesh_part *part) {
    const bool own = part->x && !part->borrowed;
    return camber_input_bytes(mesh->device, part->arc_lengths != NULL, part->slot_capacity) -
           (own ? 0 : camber_point_bytes(part->slot_capacity));
}

void camber_part_count_bytes(const camber_mesh *mesh, camber_mesh_part *part) {
    uint64_t bytes = camber_part_input_bytes(mesh, part);
    bytes += camber_source_line_bytes(part->source_line.arc_lengths != NULL, part->source_line.slot_capacity);
    bytes += part->base_capacity * sizeof *part->host_bases + part->chunk_capacity * sizeof *part->chunk_bases;
    for (int i = 0; i < 2; i++)
        bytes += mesh->buffer_copies * (uint64_t)part->buffers[i].capacity_bytes;
    camber_device_count_bytes(mesh->device, &part->held_bytes, bytes);
}

void camber_section_count_bytes(const camber_mesh *mesh, camber_section *section) {
    const bool copied = !mesh->device->host_memory;
    camber_device_count_bytes(mesh->device, &section->held_bytes,
                              section->x ? camber_section_bytes(mesh->held->network, section, copied) : 0);
}

void camber_mesh_count_bytes(camber_mesh *mesh) {
    uint64_t bytes = mesh->row_capacity * sizeof *mesh->host_rows + mesh->host_row_capacity * sizeof *mesh->host_rows;
    bytes += mesh->offset_row_capacity * sizeof(camber_offset_row);
    if (mesh->held)
        bytes += 8 * (uint64_t)mesh->held->chunk_capacity;
    camber_device_count_bytes(mesh->device, &mesh->held_bytes, bytes);
}

camber_mesh_memory camber_mesh_get_memory(const camber_mesh *mesh) {
    camber_mesh_memory memory = {
        .parts = mesh->part_count, .remade_parts = mesh->remade_parts, .held_bytes = mesh->held_bytes};
    for (size_t i = 0; i < mesh->part_capacity; i++) {
        memory.held_bytes += mesh->parts[i].held_bytes;
        memory.resident_parts += i < mesh->part_count && mesh->parts[i].made;
    }
    for (size_t i = 0; mesh->held && i < mesh->held->section_count; i++)
        memory.held_bytes += mesh->held->sections[i].held_bytes;
    return memory;
}
