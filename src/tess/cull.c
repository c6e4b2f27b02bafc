/* Culls a network: makes the slots that a camera sees, on a device, for a part of a mesh.
 *
 * Input: the points of a section and the camera's projection. Output: the part's x, y and info, as if the visible
 * lines had been uploaded as polylines. Main idea: two passes over the same walk (kernels/cull.h), a chunk of points
 * a work-item. The first counts the slots of each chunk; the host adds the counts up; the second writes each chunk's
 * slots where its sum says.
 *
 *     chunks        |   0   |   1   |   2   |   3   |
 *     cull_count        5       0       9       4          slots
 *     chunk_bases       0       5       5      14     18   slots before, and all */
#include "gpu/launch.h"
#include "tess/network.h"
#include "tess/offset.h"

/* ---- Parts ---- */

void camber_part_set_points(const camber_mesh *mesh, camber_mesh_part *part) {
    const struct camber_held_network *held = mesh->held;
    part->section = held->section_count - 1;
    while (held->sections[part->section].first_entry > part->first_polyline)
        part->section--;
    part->first_point = camber_network_first_point(held->network, part->first_polyline);
    part->end_point = camber_network_first_point(held->network, part->first_polyline + part->polyline_count);
}

/* The projection for a part's points, which are numbered from the start of their section. */
static camber_projection projection_of(const camber_mesh *mesh, const camber_mesh_part *part) {
    const size_t first = mesh->held->sections[part->section].first_point;
    camber_projection p = mesh->held->projection;
    p.first_point = (uint32_t)first;
    p.begin = (uint32_t)(part->first_point - first);
    p.end = (uint32_t)(part->end_point - first);
    return p;
}

/* How many chunks the points of the projection have. The first and the last may be incomplete. */
static size_t part_chunks(const camber_projection *p) {
    return camber_network_chunk_count(p->end) - p->begin / CAMBER_CULL_CHUNK;
}

size_t camber_part_network_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline) {
    const camber_projection p = projection_of(mesh, part);
    const size_t point = camber_network_first_point(mesh->held->network, polyline);
    if (part->given_count == 0 || point >= part->end_point)
        return part->given_count ? part->chunk_bases[part_chunks(&p)] : 0;
    const size_t chunk = (point - p.first_point) / CAMBER_CULL_CHUNK, start = p.first_point + chunk * CAMBER_CULL_CHUNK;
    const size_t begin = start > part->first_point ? start : part->first_point;
    return part->chunk_bases[chunk - p.begin / CAMBER_CULL_CHUNK] +
           (size_t)camber_network_count_slots(mesh->held->network, &p, begin, point);
}

/* ---- Stages ---- */

/* Describes a launch over the chunks of a part. */
static camber_launch over_chunks(const camber_device *device, const camber_projection *p, const char *name,
                                 camber_kernel *kernel) {
    return (camber_launch){.name = name,
                           .kernel = kernel,
                           .work_items = part_chunks(p),
                           .group_size = device->block * CAMBER_WALKERS / CAMBER_BLOCK};
}

/* Makes room for the counts of so many chunks, on host and device. */
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

/* Counts the part's slots, and sets how many come before each chunk. */
static camber_status count_chunk_slots(camber_mesh *mesh, camber_mesh_part *part, const camber_projection *p,
                                       uint64_t *slots) {
    const camber_device *device = mesh->device;
    const struct camber_held_network *held = mesh->held;
    const camber_section *section = held->sections + part->section;
    const size_t chunks = part_chunks(p);
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

/* Steps, each of which may fail:
 *
 *     1  upload the part's section, unless it is on the device
 *     2  count the slots of each chunk (cull_count); done where the camera sees none
 *     3  check that so many slots fit; if not, *fits is false and the caller cuts the part in two
 *     4  make room for them: as source lines where rows have an offset, else as the slots to classify
 *     5  write them (cull_emit) */
camber_status camber_part_project(camber_mesh *mesh, camber_mesh_part *part, bool *fits) {
    const camber_device *device = mesh->device;
    const camber_projection p = projection_of(mesh, part);
    const size_t block = device->block;
    uint64_t slots = 0;
    part->given_count = part->slot_count = part->used_slots = part->record_count = part->vertex_count =
        part->index_count = 0;
    if (p.begin == p.end)
        return CAMBER_OK;
    camber_status status = camber_part_upload_section(mesh, part);
    if (status == CAMBER_OK)
        status = reserve_chunks(mesh, part, part_chunks(&p));
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
        status = camber_buffer_write_later(device, mesh->held->bases, 0, 4 * (part_chunks(&p) + 1), part->chunk_bases);
    if (status != CAMBER_OK)
        return status;
    const camber_section *section = mesh->held->sections + part->section;
    /* The kernel zeroes the join words of two sentinels. Source lines have no join words, so it is given a buffer there
     * that the next stage overwrites. */
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
