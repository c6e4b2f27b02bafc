/* What classify and scan left on the device, a point at a time, for proofs. */
#include "tess/mesh.h"

/* A part's arrays as the host sees them. */
typedef struct arrays {
    float *x, *y;
    cl_uint *info, *joins;
    cl_uint *places; /* NULL where the mesh has no offsets */
    camber_offsets offsets;
} arrays;

static void *map(const camber_mesh *mesh, cl_mem mem, size_t words, camber_status *status) {
    if (*status != CAMBER_OK)
        return NULL;
    cl_int code;
    void *bytes =
        clEnqueueMapBuffer(mesh->device->queue, mem, CL_TRUE, CL_MAP_READ, 0, 4 * words, 0, NULL, NULL, &code);
    if (code == CL_SUCCESS)
        return bytes;
    *status = camber_fail_cl(mesh->device->context, "clEnqueueMapBuffer", code);
    return NULL;
}

static void unmap(const camber_mesh *mesh, cl_mem mem, void *bytes) {
    if (bytes)
        clEnqueueUnmapMemObject(mesh->device->queue, mem, bytes, 0, NULL, NULL);
}

/* camber_part_slot, of which each call asks the device. */
static size_t slot_of(const camber_mesh *mesh, const camber_mesh_part *part, const arrays *a, size_t polyline) {
    const size_t given = camber_part_given_slot(mesh, part, polyline);
    if (!a->places)
        return given;
    const bool is_behind = given >= part->given_count || polyline >= part->first_polyline + part->polyline_count;
    return is_behind ? part->course.made_count : a->places[given];
}

/* The points of a part, behind those that stages holds. Where a device has counted wrongly, slots of polylines may lie
 * past the part's or before those of others: none is read twice. */
static camber_status append_points(const camber_mesh *mesh, const camber_mesh_part *part, arrays *a,
                                   camber_stages *stages) {
    size_t count = 0;
    for (size_t slot = 0; slot < part->slot_count; slot++)
        count += a->info[slot + 1] & CAMBER_POINT_REAL;
    size_t capacity = stages->point_count;
    if (!camber_grow(mesh->device->context, &stages->points, &capacity, stages->point_count + count,
                     sizeof *stages->points))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0, slot = 0; i < part->polyline_count; i++) {
        const size_t polyline = part->first_polyline + i;
        const size_t begin = slot_of(mesh, part, a, polyline), wanted = slot_of(mesh, part, a, polyline + 1);
        const size_t end = wanted < part->slot_count ? wanted : part->slot_count;
        uint32_t point = 0;
        for (slot = begin > slot ? begin : slot; slot < end; slot++) {
            const size_t word = slot + 1, block = slot / mesh->device->block;
            if (!(a->info[word] & CAMBER_POINT_REAL))
                continue;
            const uint64_t *base = part->host_bases + 2 * block;
            const uint32_t packed = camber_offset_before(&a->offsets, slot);
            stages->points[stages->point_count++] = (camber_point_stages){
                .polyline = (uint32_t)polyline,
                .point = point++,
                .x = a->x[word],
                .y = a->y[word],
                .join = a->joins[word],
                .first_vertex = (uint32_t)(part->first_vertex + base[0] + (packed & 0xffffu)),
                .first_index = part->first_index + base[1] + (packed >> 16),
            };
        }
    }
    return CAMBER_OK;
}

camber_status camber_mesh_read_stages(camber_mesh *mesh, camber_stages *stages) {
    camber_stages made = {0};
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < mesh->part_count && mesh->done && status == CAMBER_OK; i++) {
        camber_mesh_part *part = mesh->parts + i;
        if (part->slot_count == 0)
            continue;
        status = camber_part_use(mesh, part);
        const size_t words = part->slot_count + 2;
        arrays seen = {
            .x = map(mesh, part->x, words, &status),
            .y = map(mesh, part->y, words, &status),
            .info = map(mesh, part->info, words, &status),
            .joins = map(mesh, part->joins, words, &status),
        };
        if (mesh->offsets)
            seen.places = map(mesh, part->course.places, part->given_count, &status);
        if (status == CAMBER_OK)
            status = camber_offsets_map(mesh, part, 0, part->slot_count, &seen.offsets);
        if (seen.offsets.offsets) {
            status = append_points(mesh, part, &seen, &made);
            camber_offsets_unmap(&seen.offsets);
        }
        unmap(mesh, part->x, seen.x);
        unmap(mesh, part->y, seen.y);
        unmap(mesh, part->info, seen.info);
        unmap(mesh, part->joins, seen.joins);
        unmap(mesh, part->course.places, seen.places);
    }
    if (status != CAMBER_OK) {
        camber_stages_free(mesh->device->context, &made);
        return status;
    }
    *stages = made;
    return CAMBER_OK;
}

void camber_stages_free(camber_context *context, camber_stages *stages) {
    camber_free(context, stages->points);
    *stages = (camber_stages){0};
}
