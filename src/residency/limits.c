/* Computes how large parts are, and whether the device and their share of memory can hold them. */
#include "residency/memory.h"
#include "residency/parts.h"

#include "kernels/cull.h"
#include "kernels/offset_emit.h"

camber_status camber_fail_polyline(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes) {
    const camber_device *device = mesh->device;
    return camber_fail(device->context, CAMBER_ERROR_LIMIT,
                       "polyline %zu takes a buffer of %llu bytes, and %s makes none above %llu; cut it in two, or "
                       "simplify it",
                       polyline, (unsigned long long)size_bytes, device->info.name,
                       (unsigned long long)device->info.largest_buffer_bytes);
}

camber_status camber_fail_memory(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes) {
    const camber_device *device = mesh->device;
    return camber_fail(device->context, CAMBER_ERROR_LIMIT,
                       "polyline %zu takes %llu bytes, more than half of the %llu that meshes may hold; allow more "
                       "memory, cut the polyline in two, or simplify it",
                       polyline, (unsigned long long)size_bytes, (unsigned long long)device->memory_bytes);
}

/* The size of a part, or of a range of its polylines. */
typedef struct part_size {
    uint64_t slots, records, indices;
    uint64_t given; /* source slots, if lines have an offset */
} part_size;

/* Rounds up to whole blocks. */
static uint64_t whole_blocks(const camber_mesh *mesh, uint64_t slots) {
    const uint64_t block = mesh->device->block;
    return (slots + block - 1) / block * block;
}

/* Returns the bytes of a part's records. Kite and fan have one record per slot, and their kernel writes whole blocks.
 */
static uint64_t record_bytes(const camber_mesh *mesh, part_size size) {
    return (mesh->mesh_info.strips ? size.records : whole_blocks(mesh, size.records)) *
           camber_record_bytes(&mesh->mesh_info);
}

static uint64_t index_bytes(const camber_mesh *mesh, part_size size) {
    return mesh->mesh_info.strips ? 0 : 4 * (size.indices ? size.indices : 1); /* a buffer may not be empty */
}

/* Returns the bytes of a part's input and of the host's arrays for it. The arrays count double and a little more,
 * because camber_grow makes them larger than requested, and never tiny. */
uint64_t camber_part_slots_bytes(const camber_mesh *mesh, const camber_mesh_part *part, size_t slots) {
    const uint64_t chunks = mesh->held ? (part->end_point - part->first_point) / CAMBER_CULL_CHUNK + 3 : 0;
    const uint64_t blocks = slots / mesh->device->block;
    return camber_input_bytes(mesh->device, mesh->mesh_info.has_arc_length, slots) +
           2 * (16 * (blocks + 1) + 4 * chunks) + 256;
}

/* Returns the bytes that a part of this size needs, input and output. */
static uint64_t needed_bytes(const camber_mesh *mesh, const camber_mesh_part *part, part_size size) {
    const size_t given = (size_t)whole_blocks(mesh, size.given);
    return (mesh->has_offsets ? camber_source_line_bytes(mesh->mesh_info.has_arc_length, given) : 0) +
           camber_part_slots_bytes(mesh, part, (size_t)whole_blocks(mesh, size.slots)) +
           mesh->buffer_copies * (record_bytes(mesh, size) + index_bytes(mesh, size));
}

static part_size size_of(const camber_mesh_part *part) {
    return (part_size){part->slot_count, part->record_count, part->index_count, part->given_count};
}

uint64_t camber_part_needed_bytes(const camber_mesh *mesh, const camber_mesh_part *part) {
    return needed_bytes(mesh, part, size_of(part));
}

uint64_t camber_parts_needed_bytes(const camber_mesh *mesh, const camber_mesh_part parts[2]) {
    const part_size a = size_of(parts), b = size_of(parts + 1);
    const camber_mesh_part joint = {.first_point = parts[0].first_point, .end_point = parts[1].end_point};
    return needed_bytes(
        mesh, &joint, (part_size){a.slots + b.slots, a.records + b.records, a.indices + b.indices, a.given + b.given});
}

uint64_t camber_part_missing_output_bytes(const camber_mesh *mesh, const camber_mesh_part *part) {
    const part_size size = size_of(part);
    const uint64_t sizes[2] = {record_bytes(mesh, size), index_bytes(mesh, size)};
    uint64_t lacks = 0;
    for (size_t i = 0; i < camber_buffer_count(mesh); i++)
        if (sizes[i] > part->buffers[i].capacity_bytes)
            lacks += sizes[i] - part->buffers[i].capacity_bytes;
    return mesh->buffer_copies * lacks;
}

/* How many eighths of the memory limit a part may take: a part of a single polyline, and a part of several polylines
 * (gpu/memory.h). */
enum { ALONE = 4, TOGETHER = 1 };

/* Whether `slots` slots fit into the part's share of memory; always true for a single polyline, since it cannot be cut.
 */
static bool may_hold(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots) {
    return part->polyline_count == 1 || needed_bytes(mesh, part, (part_size){slots, slots, 0, part->given_count}) <=
                                            camber_device_share(mesh->device, TOGETHER);
}

camber_status camber_part_check_slots(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots,
                                      bool *fits) {
    const uint64_t size_bytes = 4 * (slots + 2);
    *fits = size_bytes <= mesh->device->info.largest_buffer_bytes && slots <= UINT32_MAX - 1024u;
    if (!*fits && part->polyline_count == 1)
        return camber_fail_polyline(mesh, part->first_polyline, size_bytes);
    *fits = *fits && may_hold(mesh, part, slots);
    return CAMBER_OK;
}

camber_status camber_part_check_source_lines(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots,
                                             bool *fits) {
    const uint64_t size_bytes = sizeof(camber_offset_clip) * (slots + 2);
    if (!mesh->has_offsets || size_bytes <= mesh->device->info.largest_buffer_bytes)
        return CAMBER_OK;
    *fits = false;
    return part->polyline_count > 1 ? CAMBER_OK : camber_fail_polyline(mesh, part->first_polyline, size_bytes);
}

camber_status camber_part_check_output(const camber_mesh *mesh, const camber_mesh_part *part, bool *fits) {
    const part_size size = size_of(part);
    const bool is_alone = part->polyline_count == 1;
    const uint64_t records = record_bytes(mesh, size), indices = index_bytes(mesh, size);
    const uint64_t larger = records > indices ? records : indices, needed = needed_bytes(mesh, part, size);
    const bool is_made = larger <= mesh->device->info.largest_buffer_bytes;
    *fits = is_made && needed <= camber_device_share(mesh->device, is_alone ? ALONE : TOGETHER);
    if (*fits || !is_alone)
        return CAMBER_OK;
    return is_made ? camber_fail_memory(mesh, part->first_polyline, needed)
                   : camber_fail_polyline(mesh, part->first_polyline, larger);
}
