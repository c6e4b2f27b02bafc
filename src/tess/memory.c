/* Counts what the meshes of a device hold, and evicts parts and sections where that is bounded (gpu/memory.h).
 *
 * Main idea: everything evicted can be made again, parts from their source and sections from host memory. So when bytes
 * are needed, camber_mesh_evict_for goes through this list until they are free, one step at a time, and starts again at
 * the top after each eviction:
 *
 *     1  parts of this mesh that hold buffers but no valid output
 *     2  parts, then sections, of the device's other meshes
 *     3  sections of this mesh, but for that of the part that asks
 *     4  parts of this mesh with valid output, unless spare_made
 *
 * Within step 4 the victim is the part that will be needed last. A frame goes through the parts in order, then begins
 * again; so after the part that asks (keep) the cycle goes round, and the victim is the last before keep:
 *
 *     parts      0   1   2  [3 keep]  4   5
 *     needed     4.  5.  6. now       2.  3.     so part 2 goes first */
#include "kernels/arc_length.h"
#include "tess/network.h"
#include "tess/offset.h"

/* ---- Counting ---- */

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
    const bool own = part->x && !part->lent;
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

/* ---- Giving way ---- */

/* Returns the part to evict, among those that hold something: one without valid output, else the one that a cycle
 * through the parts from keep on needs last. NULL: there is none. */
static camber_mesh_part *find_victim(const camber_mesh *mesh, const camber_mesh_part *keep, bool spare_made) {
    const size_t from = keep ? (size_t)(keep - mesh->parts) : 0;
    camber_mesh_part *victim = NULL;
    for (size_t i = 1; i <= mesh->part_capacity; i++) {
        camber_mesh_part *part = mesh->parts + (from + i) % mesh->part_capacity;
        if (part == keep || part->held_bytes == 0 || (spare_made && part->made))
            continue;
        if (!victim || victim->made || !part->made)
            victim = part;
    }
    return victim;
}

/* Releases one section of a network. Its points are in host memory and can be uploaded again. */
static bool drop_section(camber_mesh *mesh, const camber_mesh_part *keep) {
    for (size_t i = 0; mesh->held && i < mesh->held->section_count; i++)
        if (mesh->held->sections[i].held_bytes && !(keep && keep->section == i)) {
            camber_section_release(mesh, mesh->held->sections + i);
            return true;
        }
    return false;
}

/* Evicts one part. If it had valid output, the mesh is full. */
static bool drop_part(camber_mesh *mesh, const camber_mesh_part *keep, bool spare_made) {
    camber_mesh_part *victim = find_victim(mesh, keep, spare_made);
    if (!victim)
        return false;
    mesh->is_full |= victim->made;
    camber_part_release_buffers(mesh, victim);
    return true;
}

/* Evicts one part or section of the device's other meshes. */
static bool drop_from_others(const camber_mesh *mesh) {
    for (camber_mesh *other = mesh->device->meshes; other; other = other->next)
        if (other != mesh && (drop_part(other, NULL, false) || drop_section(other, NULL)))
            return true;
    return false;
}

/* Whether so many bytes more would pass the device's bound, or the budget of the whole run. */
static bool lacks_room(const camber_device *device, uint64_t more_bytes) {
    return device->held_bytes + more_bytes > device->memory_bytes ||
           (device->host_memory && !camber_budget_has(device->context, more_bytes));
}

bool camber_mesh_evict_for(camber_mesh *mesh, const camber_mesh_part *keep, uint64_t more_bytes, bool spare_made) {
    const camber_device *device = mesh->device;
    while (device->memory_bytes && lacks_room(device, more_bytes))
        if (!drop_part(mesh, keep, true) && !drop_from_others(mesh) && !drop_section(mesh, keep) &&
            (spare_made || !drop_part(mesh, keep, false)))
            return false;
    return true;
}

camber_status camber_mesh_make_room(camber_mesh *mesh, const camber_mesh_part *keep, uint64_t more_bytes) {
    const camber_device *device = mesh->device;
    if (camber_mesh_evict_for(mesh, keep, more_bytes, false))
        return CAMBER_OK;
    return camber_fail(device->context, CAMBER_ERROR_LIMIT,
                       "meshes hold %llu bytes that cannot go, %llu more are needed, and %llu are allowed; allow more "
                       "memory, or destroy meshes",
                       (unsigned long long)device->held_bytes, (unsigned long long)more_bytes,
                       (unsigned long long)device->memory_bytes);
}

void camber_part_recycle_buffers(camber_mesh *mesh, camber_mesh_part *part, uint64_t wanted_bytes) {
    const camber_device *device = mesh->device;
    if (!device->memory_bytes)
        return;
    if (part->held_bytes > camber_device_share(device, 2))
        camber_part_release_buffers(mesh, part);
    if (part->held_bytes || device->held_bytes + wanted_bytes <= device->memory_bytes)
        return;
    camber_mesh_part *victim = find_victim(mesh, part, false);
    if (!victim || victim->held_bytes > camber_device_share(device, 2))
        return;
    mesh->is_full |= victim->made;
    camber_part_move_buffers(part, victim);
    camber_part_count_bytes(mesh, victim);
    camber_part_count_bytes(mesh, part);
}
