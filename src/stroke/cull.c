/* Culls a network: makes the slots that a camera sees, on a device, for a part of a mesh.
 *
 * Input: the points of a section and the camera's projection. Output: the part's x, y and info, as if the visible
 * lines had been uploaded as polylines. Main idea: two passes over the same walk (kernels/cull.h), in which each
 * work-item takes a chunk of points. The first pass counts the slots of each chunk; the host adds the counts up; the
 * second pass writes each chunk's slots from the position that the sum gives.
 *
 *     chunks        |   0   |   1   |   2   |   3   |
 *     cull_count        5       0       9       4          slots
 *     chunk_bases       0       5       5      14     18   slots before, and the total */
#include "residency/memory.h"
#include "residency/parts.h"
#include "stroke/stroke.h"

/* Describes a launch over the chunks of a part. */
static camber_launch over_chunks(const camber_device *device, const camber_projection *p, const char *name,
                                 camber_kernel *kernel) {
    return (camber_launch){.name = name,
                           .kernel = kernel,
                           .work_items = camber_projection_chunks(p),
                           .group_size = device->block * CAMBER_WALKERS / CAMBER_BLOCK};
}

/* Makes room for the counts of `chunks` chunks, on host and device. */
static camber_status reserve_chunks(camber_mesh *mesh, camber_mesh_part *part, size_t chunks) {
    struct camber_held_network *held = mesh->held;
    const uint64_t on_host = chunks < part->chunk_capacity ? 0 : 8 * (uint64_t)chunks + 64;
    camber_status status =
        camber_mesh_make_room(mesh, part, on_host + (chunks <= held->chunk_capacity ? 0 : 8 * (uint64_t)chunks + 4));
    if (status != CAMBER_OK)
        return status;
    const bool there = camber_grow(mesh->device->context, &part->chunk_bases, &part->chunk_capacity, chunks + 1,
                                   sizeof *part->chunk_bases);
    camber_part_count_bytes(mesh, part);
    if (!there)
        return CAMBER_ERROR_MEMORY;
    if (chunks <= held->chunk_capacity)
        return CAMBER_OK;
    camber_buffer_release(mesh->device, &held->counts);
    camber_buffer_release(mesh->device, &held->bases);
    held->chunk_capacity = 0;
    status = camber_buffer_create(mesh->device, CAMBER_BUFFER_OWN, 4 * chunks, NULL, &held->counts);
    if (status == CAMBER_OK)
        status = camber_buffer_create(mesh->device, CAMBER_BUFFER_OWN, 4 * (chunks + 1), NULL, &held->bases);
    if (status == CAMBER_OK)
        held->chunk_capacity = chunks;
    camber_mesh_count_bytes(mesh);
    return status;
}

/* Counts the part's slots, and computes how many are before each chunk. */
static camber_status count_chunk_slots(camber_mesh *mesh, camber_mesh_part *part, const camber_projection *p,
                                       uint64_t *slots) {
    const camber_device *device = mesh->device;
    const struct camber_held_network *held = mesh->held;
    const camber_section *section = held->sections + part->section;
    const size_t chunks = camber_projection_chunks(p);
    const camber_kernel_arg args[] = {CAMBER_ARG_BUFFER(section->x),
                                      CAMBER_ARG_BUFFER(section->y),
                                      CAMBER_ARG_BUFFER(section->importance),
                                      CAMBER_ARG_BUFFER(section->stretches),
                                      CAMBER_ARG_BUFFER(section->chunk_stretches),
                                      CAMBER_ARG_BUFFER(held->counts),
                                      CAMBER_ARG_VALUE(*p)};
    camber_launch launch = over_chunks(device, p, "cull_count", held->program->cull_count);
    camber_event *event = NULL;
    launch.args = args;
    launch.arg_count = sizeof args / sizeof *args;
    const uint32_t *counts;
    camber_status status = camber_launch_kernel(device, &launch, &event);
    if (status != CAMBER_OK)
        return status;
    status = camber_buffer_map(device, held->counts, CAMBER_MAP_READ, 4 * chunks, &counts);
    camber_mesh_add_time(mesh, CAMBER_STAGE_CULL_COUNT, event);
    if (status != CAMBER_OK)
        return status;
    *slots = 0;
    for (size_t i = 0; i <= chunks; i++) {
        part->chunk_bases[i] = (uint32_t)*slots;
        *slots += i < chunks ? counts[i] : 0;
    }
    camber_buffer_unmap(device, held->counts, counts);
    return CAMBER_OK;
}

/* Makes the slots of a part in these steps, each of which may fail:
 *
 *     1  upload the part's section, unless it is on the device
 *     2  count the slots of each chunk (cull_count); stop if the camera sees none
 *     3  check that the slots fit; if not, *fits is false and the caller cuts the part in two
 *     4  make room for them: as source lines if rows have an offset, else as the slots to classify
 *     5  write them (cull_emit) */
camber_status camber_part_project(camber_mesh *mesh, camber_mesh_part *part, bool *fits) {
    const camber_device *device = mesh->device;
    const camber_projection p = camber_part_projection(mesh, part);
    const size_t block = device->block;
    uint64_t slots = 0;
    part->given_count = part->slot_count = part->used_slots = part->record_count = part->vertex_count =
        part->index_count = 0;
    if (p.begin == p.end)
        return CAMBER_OK;
    camber_status status = camber_part_upload_section(mesh, part);
    if (status == CAMBER_OK)
        status = reserve_chunks(mesh, part, camber_projection_chunks(&p));
    if (status == CAMBER_OK)
        status = count_chunk_slots(mesh, part, &p, &slots);
    if (status != CAMBER_OK || slots == 0)
        return status;
    const size_t padded = (size_t)((slots + block - 1) / block * block);
    part->given_count = padded;
    part->used_slots = (size_t)slots;
    status = camber_part_check_slots(mesh, part, padded, fits);
    if (status == CAMBER_OK && *fits)
        status = camber_part_check_source_lines(mesh, part, padded, fits);
    if (status != CAMBER_OK || !*fits)
        return status;
    status = mesh->has_offsets ? camber_part_reserve_source_lines(mesh, part, padded)
                               : camber_part_reserve_with_spare(mesh, part, padded);
    if (status == CAMBER_OK)
        status = camber_buffer_write_later(device, mesh->held->bases, 0, 4 * (camber_projection_chunks(&p) + 1),
                                           part->chunk_bases);
    if (status != CAMBER_OK)
        return status;
    const camber_section *section = mesh->held->sections + part->section;
    /* The kernel zeroes the join words of two sentinels. Source lines have no join words, so the kernel gets a buffer
     * for them that the next stage overwrites. */
    const camber_source_line_buffers *source_line = &part->source_line;
    const bool beside = mesh->has_offsets, along = mesh->mesh_info.has_arc_length;
    const camber_kernel_arg args[] = {CAMBER_ARG_BUFFER(section->x),
                                      CAMBER_ARG_BUFFER(section->y),
                                      CAMBER_ARG_BUFFER(section->importance),
                                      CAMBER_ARG_BUFFER(section->stretches),
                                      CAMBER_ARG_BUFFER(section->chunk_stretches),
                                      CAMBER_ARG_BUFFER(mesh->held->bases),
                                      CAMBER_ARG_BUFFER(beside ? source_line->x : part->x),
                                      CAMBER_ARG_BUFFER(beside ? source_line->y : part->y),
                                      CAMBER_ARG_BUFFER(beside ? source_line->info : part->info),
                                      CAMBER_ARG_BUFFER(beside ? source_line->clips : part->joins),
                                      CAMBER_ARG_BUFFER(along ? section->lengths : NULL),
                                      CAMBER_ARG_BUFFER(along ? section->totals : NULL),
                                      CAMBER_ARG_BUFFER(!along   ? NULL
                                                        : beside ? source_line->arc_lengths
                                                                 : part->arc_lengths),
                                      CAMBER_ARG_VALUE(p)};
    camber_launch launch = over_chunks(device, &p, "cull_emit", mesh->held->program->cull_emit);
    launch.args = args;
    launch.arg_count = sizeof args / sizeof *args;
    return camber_launch_kernel(device, &launch, &mesh->held->projected);
}
