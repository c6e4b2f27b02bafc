/* Culls a network: makes the slots that a camera sees, on a device, for a part of a mesh.
 *
 * Input: the points of a section and the camera's projection. Output: the part's x, y and info, as if the visible
 * lines had been uploaded as polylines. Main idea: two passes over the same walk (kernels/network.h), a chunk of points
 * a work-item. The first counts the slots of each chunk; the host adds the counts up; the second writes each chunk's
 * slots where its sum says.
 *
 *     chunks        |   0   |   1   |   2   |   3   |
 *     cull_count        5       0       9       4          slots
 *     chunk_bases       0       5       5      14     18   slots before, and all */
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
    return camber_network_chunk_count(p->end) - p->begin / CAMBER_CHUNK;
}

size_t camber_part_network_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline) {
    const camber_projection p = projection_of(mesh, part);
    const size_t point = camber_network_first_point(mesh->held->network, polyline);
    if (part->given_count == 0 || point >= part->end_point)
        return part->given_count ? part->chunk_bases[part_chunks(&p)] : 0;
    const size_t chunk = (point - p.first_point) / CAMBER_CHUNK, start = p.first_point + chunk * CAMBER_CHUNK;
    const size_t begin = start > part->first_point ? start : part->first_point;
    return part->chunk_bases[chunk - p.begin / CAMBER_CHUNK] +
           (size_t)camber_network_count_slots(mesh->held->network, &p, begin, point);
}

/* ---- Stages ---- */

typedef struct stage {
    const char *name;
    cl_kernel kernel;
    const cl_mem *mems;
    cl_uint mem_count;
} stage;

/* Launches a stage over the chunks of a part. The projection is its last argument. */
static camber_status run_stage(const camber_device *device, const camber_projection *p, stage s, cl_event *event) {
    const size_t local = device->block * CAMBER_WALKERS / CAMBER_BLOCK;
    const size_t global = (part_chunks(p) + local - 1) / local * local;
    cl_int code = CL_SUCCESS;
    for (cl_uint i = 0; i < s.mem_count && code == CL_SUCCESS; i++)
        code = clSetKernelArg(s.kernel, i, sizeof *s.mems, s.mems + i);
    if (code == CL_SUCCESS)
        code = clSetKernelArg(s.kernel, s.mem_count, sizeof *p, p);
    if (code != CL_SUCCESS)
        return camber_fail_stage(device, "clSetKernelArg", s.name, code);
    code = clEnqueueNDRangeKernel(device->queue, s.kernel, 1, NULL, &global, &local, 0, NULL, event);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_stage(device, "clEnqueueNDRangeKernel", s.name, code);
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
    camber_release_buffer(mesh->device, &held->counts);
    camber_release_buffer(mesh->device, &held->bases);
    held->chunk_capacity = 0;
    status = camber_make_buffer(mesh->device, CL_MEM_READ_WRITE, 4 * chunks, NULL, &held->counts);
    if (status == CAMBER_OK)
        status = camber_make_buffer(mesh->device, CL_MEM_READ_WRITE, 4 * (chunks + 1), NULL, &held->bases);
    if (status == CAMBER_OK)
        held->chunk_capacity = chunks;
    camber_mesh_count_bytes(mesh);
    return status;
}

/* Counts the part's slots, and sets how many come before each chunk. */
static camber_status survey(camber_mesh *mesh, camber_mesh_part *part, const camber_projection *p, uint64_t *slots) {
    const camber_device *device = mesh->device;
    const struct camber_held_network *held = mesh->held;
    const camber_section *section = held->sections + part->section;
    const size_t chunks = part_chunks(p);
    const cl_mem mems[] = {section->x,    section->y,          section->importance,
                           section->runs, section->chunk_runs, held->counts};
    cl_event event = NULL;
    const camber_status status = run_stage(device, p, (stage){"survey", held->program->survey, mems, 6}, &event);
    if (status != CAMBER_OK)
        return status;
    cl_int code;
    const cl_uint *counts =
        clEnqueueMapBuffer(device->queue, held->counts, CL_TRUE, CL_MAP_READ, 0, 4 * chunks, 0, NULL, NULL, &code);
    camber_add_ms(event, &mesh->mesh_info.survey_ms);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clEnqueueMapBuffer", code);
    *slots = 0;
    for (size_t i = 0; i <= chunks; i++) {
        part->chunk_bases[i] = (uint32_t)*slots;
        *slots += i < chunks ? counts[i] : 0;
    }
    clEnqueueUnmapMemObject(device->queue, held->counts, (void *)(uintptr_t)counts, 0, NULL, NULL);
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
    part->given_count = part->slot_count = part->record_count = part->vertex_count = part->index_count = 0;
    if (p.begin == p.end)
        return CAMBER_OK;
    camber_status status = camber_part_upload_section(mesh, part);
    if (status == CAMBER_OK)
        status = reserve_chunks(mesh, part, part_chunks(&p));
    if (status == CAMBER_OK)
        status = survey(mesh, part, &p, &slots);
    if (status != CAMBER_OK || slots == 0)
        return status;
    const size_t padded = (size_t)((slots + block - 1) / block * block);
    part->given_count = padded;
    status = camber_part_check_slots(mesh, part, padded, fits);
    if (status == CAMBER_OK && *fits)
        status = camber_part_check_course(mesh, part, padded, fits);
    if (status != CAMBER_OK || !*fits)
        return status;
    status = mesh->has_offsets ? camber_part_reserve_course(mesh, part, padded)
                               : camber_part_reserve_with_spare(mesh, part, padded);
    if (status == CAMBER_OK)
        status = camber_write_buffer(device, mesh->held->bases, 0, 4 * (part_chunks(&p) + 1), part->chunk_bases);
    if (status != CAMBER_OK)
        return status;
    const camber_section *section = mesh->held->sections + part->section;
    /* The kernel zeroes the join words of two sentinels. Source lines have no join words, so it is given a buffer there
     * that the next stage overwrites. */
    const camber_part_course *course = &part->course;
    const cl_mem mems[] = {section->x,
                           section->y,
                           section->importance,
                           section->runs,
                           section->chunk_runs,
                           mesh->held->bases,
                           mesh->has_offsets ? course->x : part->x,
                           mesh->has_offsets ? course->y : part->y,
                           mesh->has_offsets ? course->info : part->info,
                           mesh->has_offsets ? course->spans : part->joins,
                           section->lengths,
                           section->totals,
                           mesh->has_offsets ? course->measures : part->measures};
    const cl_uint mem_count = mesh->mesh_info.measured ? 13 : 10;
    return run_stage(device, &p, (stage){"project", mesh->held->program->project, mems, mem_count},
                     &mesh->held->projected);
}
