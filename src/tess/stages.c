/* Reads back what classify and scan left on the device, a record a point, for checks against the CPU twin.
 *
 * Input: a tessellated mesh. Output: camber_stages, its points in the order of the polylines. Nothing that the device
 * left is trusted: a broken kernel must show up as a difference, never as a read outside of a buffer. */
#include "tess/mesh.h"

/* A part's arrays, mapped into host memory. */
typedef struct arrays {
    float *x, *y;
    camber_slot_starts starts;
} arrays;

/* Maps a buffer for reading. Does nothing after an earlier failure, so that calls can follow each other. */
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

/* Appends the points of a part to stages. Where a device has counted wrongly, a polyline's slots may lie past the
 * part's end or overlap another's: slots only ever go forward, so that none is read twice. */
static camber_status append_points(const camber_mesh *mesh, const camber_mesh_part *part, arrays *a,
                                   camber_stages *stages) {
    size_t count = 0;
    for (size_t slot = 0; slot < part->slot_count; slot++)
        count += a->starts.info[slot + 1] & CAMBER_POINT_REAL;
    size_t capacity = stages->point_count;
    if (!camber_grow(mesh->device->context, &stages->points, &capacity, stages->point_count + count,
                     sizeof *stages->points))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0, slot = 0; i < part->polyline_count; i++) {
        const size_t polyline = part->first_polyline + i;
        const size_t begin = camber_slot_starts_slot(&a->starts, polyline);
        const size_t wanted = camber_slot_starts_slot(&a->starts, polyline + 1);
        const size_t end = wanted < part->slot_count ? wanted : part->slot_count;
        uint32_t point = 0;
        for (slot = begin > slot ? begin : slot; slot < end; slot++) {
            const size_t word = slot + 1, block = slot / mesh->device->block;
            if (!(a->starts.info[word] & CAMBER_POINT_REAL))
                continue;
            const uint64_t *base = part->host_bases + 2 * block;
            const uint32_t packed = camber_slot_starts_before(&a->starts, slot);
            stages->points[stages->point_count++] = (camber_point_stages){
                .polyline = (uint32_t)polyline,
                .point = point++,
                .x = a->x[word],
                .y = a->y[word],
                .join = a->starts.joins[word],
                .first_vertex = (uint32_t)(part->first_vertex + base[0] + (packed & 0xffffu)),
                .first_index = part->first_index + base[1] + (packed >> 16),
            };
        }
    }
    return CAMBER_OK;
}

camber_status camber_mesh_read_stages(camber_mesh *mesh, camber_stages *stages) {
    camber_stages made = {.context = mesh->device->context};
    camber_status status = camber_check_process(made.context);
    if (status == CAMBER_OK && mesh->draws_points)
        status = camber_mesh_count_joins(mesh);
    for (size_t i = 0; i < mesh->part_count && mesh->done && status == CAMBER_OK; i++) {
        camber_mesh_part *part = mesh->parts + i;
        if (part->slot_count == 0)
            continue;
        status = camber_part_ensure_counted(mesh, part);
        const size_t words = part->slot_count + 2;
        arrays seen = {
            .x = map(mesh, part->x, words, &status),
            .y = map(mesh, part->y, words, &status),
            .starts = camber_slot_starts_of(mesh, part),
        };
        if (status == CAMBER_OK)
            status = camber_slot_starts_map(&seen.starts);
        if (status == CAMBER_OK)
            status = append_points(mesh, part, &seen, &made);
        camber_slot_starts_unmap(&seen.starts);
        unmap(mesh, part->x, seen.x);
        unmap(mesh, part->y, seen.y);
    }
    if (status != CAMBER_OK) {
        camber_stages_destroy(&made);
        return status;
    }
    *stages = made;
    return CAMBER_OK;
}

/* Reads words of a buffer into an array that is made for them. Does nothing after an earlier failure. */
static void read_words(const camber_mesh *mesh, cl_mem mem, size_t words, void *array, camber_status *status) {
    const camber_device *device = mesh->device;
    void **made = array;
    if (*status != CAMBER_OK)
        return;
    if (!(*made = camber_alloc(device->context, words, 4))) {
        *status = CAMBER_ERROR_MEMORY;
        return;
    }
    const cl_int code = clEnqueueReadBuffer(device->queue, mem, CL_TRUE, 0, 4 * words, *made, 0, NULL, NULL);
    if (code != CL_SUCCESS)
        *status = camber_fail_cl(device->context, "clEnqueueReadBuffer", code);
}

camber_status camber_part_read_points(camber_mesh *mesh, camber_mesh_part *part, camber_part_points *points) {
    camber_part_points made = {0};
    camber_status status = camber_part_ensure_points(mesh, part);
    const size_t words = part->slot_count + 2;
    read_words(mesh, part->x, words, &made.x, &status);
    read_words(mesh, part->y, words, &made.y, &status);
    read_words(mesh, part->info, words, &made.info, &status);
    read_words(mesh, part->joins, words, &made.joins, &status);
    if (mesh->mesh_info.has_arc_length)
        read_words(mesh, part->arc_lengths, 2 * part->slot_count, &made.arc_lengths, &status);
    if (status == CAMBER_OK)
        *points = made;
    else
        camber_part_points_free(mesh->device->context, &made);
    return status;
}

void camber_part_points_free(camber_context *context, camber_part_points *points) {
    camber_free(context, points->x);
    camber_free(context, points->y);
    camber_free(context, points->info);
    camber_free(context, points->joins);
    camber_free(context, points->arc_lengths);
    *points = (camber_part_points){0};
}

void camber_stages_destroy(camber_stages *stages) {
    if (stages->context)
        camber_free(stages->context, stages->points);
    *stages = (camber_stages){0};
}
