/* Evicts parts and sections to keep meshes within the memory limit (gpu/memory.h).
 *
 * Main idea: everything that is evicted can be made again: parts from their source, and sections from host memory. So
 * when bytes are needed, camber_mesh_evict_for goes through this list until they are free, and starts again at the top
 * after each eviction:
 *
 *     1  parts of this mesh that hold buffers but no valid output
 *     2  parts, then sections, of the device's other meshes
 *     3  sections of this mesh, except the requesting part's
 *     4  parts of this mesh with valid output, unless spare_made
 *
 * Within step 4 the victim is the part that will be needed last. A frame uses the parts in order, and the next frame
 * begins again at the first; so, counting from the requesting part (keep), the part needed last is the one before keep:
 *
 *     parts      0   1   2  [3 keep]  4   5
 *     needed     4.  5.  6. now       2.  3.     so part 2 is evicted first */
#include "residency/memory.h"

/* Returns the part to evict among those that hold something: one without valid output, else the one that is needed last
 * in a cycle through the parts that starts at keep. NULL: there is none. */
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
            camber_section_release(mesh->device, mesh->held->sections + i);
            camber_section_count_bytes(mesh, mesh->held->sections + i);
            return true;
        }
    return false;
}

/* Evicts one part. If it had valid output, marks the mesh as full. */
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

/* Whether more_bytes more bytes would exceed the device's memory limit or the budget of the run. */
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
                       "meshes hold %llu bytes that cannot be freed, %llu more are needed, and %llu are allowed; allow "
                       "more memory, or destroy meshes",
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
