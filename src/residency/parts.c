/* Divides a mesh's source into parts.
 *
 * Input: polylines in slots, or sections of a network, and the limits of the device: its largest buffer, and shares of
 * the memory limit. Output: mesh->parts, each with buffers of its own. Main idea: slots are known in advance, so
 * polylines are split by slot such that each part's input fits. A part whose points or output turn out too large is
 * halved.
 *
 * A part is cut between polylines only. A single polyline that does not fit is an error that names it. */
#include "residency/parts.h"
#include "residency/memory.h"

#include <string.h>

static void release_part(camber_mesh *mesh, camber_mesh_part *part) {
    camber_part_release_buffers(mesh, part);
    *part = (camber_mesh_part){0};
}

void camber_mesh_release_parts(camber_mesh *mesh) {
    for (size_t i = 0; i < mesh->part_capacity; i++)
        release_part(mesh, mesh->parts + i);
    camber_free(mesh->device->context, mesh->parts);
    mesh->parts = NULL;
    mesh->part_count = mesh->part_capacity = 0;
}

/* Makes room for `count` parts. Parts past part_count are zero, except the very first, which keeps its buffers for the
 * next polylines. */
static bool reserve_parts(camber_mesh *mesh, size_t count) {
    const size_t before = mesh->part_capacity;
    if (!camber_grow(mesh->device->context, &mesh->parts, &mesh->part_capacity, count, sizeof *mesh->parts))
        return false;
    memset(mesh->parts + before, 0, (mesh->part_capacity - before) * sizeof *mesh->parts);
    return true;
}

/* Sets a part's section and points of a network from its polylines. */
static void set_points(const camber_mesh *mesh, camber_mesh_part *part) {
    const struct camber_held_network *held = mesh->held;
    part->section = held->section_count - 1;
    while (held->sections[part->section].first_entry > part->first_polyline)
        part->section--;
    part->first_point = camber_network_first_point(held->network, part->first_polyline);
    part->end_point = camber_network_first_point(held->network, part->first_polyline + part->polyline_count);
}

/* Gives a part the polylines [first, end). The contents of its buffers are invalid from then on. */
static void set_polylines(const camber_mesh *mesh, camber_mesh_part *part, size_t first, size_t end) {
    const size_t block = mesh->device->block;
    const size_t slots = mesh->held ? 0 : mesh->first_slots[end] - mesh->first_slots[first];
    part->first_polyline = first;
    part->polyline_count = end - first;
    part->first_slot = mesh->held ? 0 : mesh->first_slots[first];
    part->given_count = part->slot_count = (slots + block - 1) / block * block;
    part->used_slots = slots;
    part->record_count = part->vertex_count = part->index_count = 0;
    part->uploaded = part->made = false;
    if (mesh->held)
        set_points(mesh, part);
}

/* Returns the end (exclusive) of the polylines that fit into a part of slots_max slots that begins with `first`. */
static size_t find_part_end(const camber_mesh *mesh, size_t first, size_t slots_max) {
    const uint32_t *slots = mesh->first_slots;
    size_t low = first, high = mesh->polyline_count;
    if (slots[high] - slots[first] <= slots_max)
        return high;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (slots[middle] - slots[first] <= slots_max)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void camber_mesh_trim_parts(camber_mesh *mesh) {
    for (size_t i = mesh->part_count ? mesh->part_count : 1; i < mesh->part_capacity; i++)
        release_part(mesh, mesh->parts + i);
}

/* Returns how many slots fit into a part's share of memory if each makes a record or a little more; at least one block.
 */
static uint64_t shared_slots(const camber_mesh *mesh) {
    const size_t block = mesh->device->block;
    const uint64_t block_bytes =
        camber_input_bytes(mesh->device, mesh->mesh_info.has_arc_length, block) + 20 * mesh->buffer_copies * block +
        (mesh->has_offsets ? camber_source_line_bytes(mesh->mesh_info.has_arc_length, block) : 0);
    const uint64_t blocks = camber_device_share(mesh->device, 1) / block_bytes;
    return (blocks ? blocks : 1) * block;
}

camber_status camber_mesh_lay_out_parts(camber_mesh *mesh) {
    const size_t block = mesh->device->block, sentinels = 2;
    const uint64_t words = mesh->device->info.largest_buffer_bytes / 4, shared = shared_slots(mesh);
    const uint64_t room = words > sentinels ? (words - sentinels) / block * block : 0;
    const size_t slots_max = room < UINT32_MAX ? (size_t)room : UINT32_MAX;
    const size_t slots = shared < slots_max ? (size_t)shared : slots_max;
    const size_t polyline_count = mesh->first_slots[mesh->polyline_count] ? mesh->polyline_count : 0;
    for (size_t first = 0; first < polyline_count; mesh->part_count++) {
        size_t end = find_part_end(mesh, first, slots);
        if (end == first && mesh->first_slots[first + 1] - mesh->first_slots[first] <= slots_max)
            end = first + 1;
        if (end == first)
            return camber_fail_polyline(
                mesh, first, 4 * ((uint64_t)mesh->first_slots[first + 1] - mesh->first_slots[first] + sentinels));
        if (!reserve_parts(mesh, mesh->part_count + 1))
            return CAMBER_ERROR_MEMORY;
        set_polylines(mesh, mesh->parts + mesh->part_count, first, end);
        first = end;
    }
    camber_mesh_trim_parts(mesh);
    return CAMBER_OK;
}

camber_status camber_mesh_add_part(camber_mesh *mesh, size_t first_polyline, size_t end_polyline) {
    if (!reserve_parts(mesh, mesh->part_count + 1))
        return CAMBER_ERROR_MEMORY;
    set_polylines(mesh, mesh->parts + mesh->part_count++, first_polyline, end_polyline);
    return CAMBER_OK;
}

/* Merges a part with the next one, which loses its buffers. The slots of both are made again. */
static void merge_with_next(camber_mesh *mesh, size_t which) {
    camber_mesh_part *part = mesh->parts + which;
    const size_t end = part[1].first_polyline + part[1].polyline_count;
    camber_part_release_buffers(mesh, part + 1);
    memmove(part + 1, part + 2, (mesh->part_count - which - 2) * sizeof *part);
    mesh->part_count--;
    memset(mesh->parts + mesh->part_count, 0, sizeof *part);
    set_polylines(mesh, part, part->first_polyline, end);
}

void camber_mesh_compact_parts(camber_mesh *mesh) {
    const uint64_t most = camber_device_share(mesh->device, 1) / 2;
    if (!mesh->device->memory_bytes)
        return;
    for (size_t i = 0; i < mesh->part_count && mesh->is_full; i++)
        if (mesh->parts[i].held_bytes / 2 > camber_part_needed_bytes(mesh, mesh->parts + i))
            camber_part_release_buffers(mesh, mesh->parts + i);
    for (size_t i = 0; i + 1 < mesh->part_count; i++) {
        const camber_mesh_part *part = mesh->parts + i;
        /* The size of the merged part is known only after the next frame; before that it is not merged again. */
        if (part[0].section == part[1].section && camber_parts_needed_bytes(mesh, part) <= most)
            merge_with_next(mesh, i);
    }
}

camber_status camber_mesh_halve(camber_mesh *mesh, size_t which) {
    if (!reserve_parts(mesh, mesh->part_count + 1))
        return CAMBER_ERROR_MEMORY;
    camber_mesh_part *part = mesh->parts + which;
    const size_t first = part->first_polyline, end = first + part->polyline_count;
    const size_t middle = first + part->polyline_count / 2;
    memmove(part + 2, part + 1, (mesh->part_count - which - 1) * sizeof *part);
    memset(part + 1, 0, sizeof *part);
    mesh->part_count++;
    set_polylines(mesh, part, first, middle);
    set_polylines(mesh, part + 1, middle, end);
    return CAMBER_OK;
}
