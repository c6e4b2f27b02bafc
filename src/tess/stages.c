/* What classify and scan left on the device, a point at a time, for proofs. */
#include "tess/tess.h"

/* The device's arrays as the host sees them, in the order of their buffers in map_arrays. */
typedef struct arrays {
    const float *x, *y;
    const cl_uint *info, *joins, *offsets;
} arrays;

enum { ARRAYS = 5 };

static void unmap_arrays(const camber_mesh *mesh, const cl_mem mems[ARRAYS], void *const maps[ARRAYS]) {
    for (size_t i = 0; i < ARRAYS; i++)
        if (maps[i])
            clEnqueueUnmapMemObject(mesh->device->queue, mems[i], maps[i], 0, NULL, NULL);
}

static camber_status map_arrays(const camber_mesh *mesh, size_t slot_count, const cl_mem mems[ARRAYS],
                                void *maps[ARRAYS], arrays *seen) {
    for (size_t i = 0; i < ARRAYS; i++) {
        const size_t words = i + 1 < ARRAYS ? slot_count + 2 : slot_count;
        cl_int code;
        maps[i] =
            clEnqueueMapBuffer(mesh->device->queue, mems[i], CL_TRUE, CL_MAP_READ, 0, 4 * words, 0, NULL, NULL, &code);
        if (code != CL_SUCCESS) {
            maps[i] = NULL;
            return camber_fail_cl(mesh->device->context, "clEnqueueMapBuffer", code);
        }
    }
    *seen = (arrays){maps[0], maps[1], maps[2], maps[3], maps[4]};
    return CAMBER_OK;
}

/* The points of a part, behind those that stages holds. */
static camber_status append_points(const camber_mesh *mesh, const camber_mesh_part *part, const arrays *a,
                                   camber_stages *stages) {
    size_t count = 0;
    for (size_t slot = 0; slot < part->slot_count; slot++)
        count += a->info[slot + 1] & CAMBER_POINT_REAL;
    size_t capacity = stages->point_count;
    if (!camber_grow(mesh->device->context, &stages->points, &capacity, stages->point_count + count,
                     sizeof *stages->points))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < part->polyline_count; i++) {
        const size_t polyline = part->first_polyline + i, end = mesh->first_slots[polyline + 1] - part->first_slot;
        uint32_t point = 0;
        for (size_t slot = mesh->first_slots[polyline] - part->first_slot; slot < end; slot++) {
            const size_t word = slot + 1, block = slot / mesh->device->block;
            if (!(a->info[word] & CAMBER_POINT_REAL))
                continue;
            const uint64_t *base = part->host_bases + 2 * block;
            stages->points[stages->point_count++] = (camber_point_stages){
                .polyline = (uint32_t)polyline,
                .point = point++,
                .x = a->x[word],
                .y = a->y[word],
                .join = a->joins[word],
                .first_vertex = (uint32_t)(part->first_vertex + base[0] + (a->offsets[slot] & 0xffffu)),
                .first_index = part->first_index + base[1] + (a->offsets[slot] >> 16),
            };
        }
    }
    return CAMBER_OK;
}

camber_status camber_mesh_read_stages(camber_mesh *mesh, camber_stages *stages) {
    camber_stages made = {0};
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < mesh->part_count && mesh->done && status == CAMBER_OK; i++) {
        const camber_mesh_part *part = mesh->parts + i;
        const cl_mem mems[ARRAYS] = {part->x, part->y, part->info, part->joins, part->offsets};
        void *maps[ARRAYS] = {NULL};
        arrays seen = {0};
        status = map_arrays(mesh, part->slot_count, mems, maps, &seen);
        if (status == CAMBER_OK)
            status = append_points(mesh, part, &seen, &made);
        unmap_arrays(mesh, mems, maps);
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
