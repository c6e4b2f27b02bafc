/* classify -> scan -> emit on a device. */
#include "tess/tess.h"

#include "kernels/join.h"

#include <string.h>

/* ---- Output buffers in OpenCL memory, for a mesh that no renderer draws ---- */

static camber_status plain_reserve(void *user, camber_buffer *buffer, size_t size_bytes) {
    const camber_device *device = user;
    if (size_bytes <= buffer->capacity_bytes)
        return CAMBER_OK;
    if (buffer->mem)
        clReleaseMemObject(buffer->mem);
    cl_int code;
    buffer->capacity_bytes = 0;
    buffer->mem = clCreateBuffer(device->cl, CL_MEM_READ_WRITE, size_bytes, NULL, &code);
    if (code != CL_SUCCESS) {
        buffer->mem = NULL;
        return camber_fail_cl(device->context, "mesh buffer", code);
    }
    buffer->capacity_bytes = size_bytes;
    return CAMBER_OK;
}

static camber_status plain_begin(void *user, camber_buffer *buffers, size_t count) {
    (void)user;
    (void)buffers;
    (void)count;
    return CAMBER_OK;
}

static camber_status plain_finish(void *user, camber_buffer *buffers, size_t count, bool written) {
    (void)written;
    return plain_begin(user, buffers, count);
}

static void plain_release(void *user, camber_buffer *buffer) {
    (void)user;
    if (buffer->mem)
        clReleaseMemObject(buffer->mem);
    *buffer = (camber_buffer){0};
}

static const camber_buffer_ops plain_ops = {plain_reserve, plain_begin, plain_finish, plain_release};

/* ---- Mesh ---- */

camber_status camber_mesh_create_on(camber_device *device, const camber_buffer_ops *ops, void *ops_user,
                                    camber_mesh **mesh) {
    camber_mesh *made = camber_alloc_zero(device->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->device = device;
    made->ops = ops ? ops : &plain_ops;
    made->ops_user = ops ? ops_user : device;
    made->empty = true;
    *mesh = made;
    return CAMBER_OK;
}

static void release_input(camber_mesh *mesh) {
    cl_mem *mems[] = {&mesh->x, &mesh->y, &mesh->info, &mesh->joins, &mesh->offsets, &mesh->sums, &mesh->bases};
    for (size_t i = 0; i < sizeof mems / sizeof *mems; i++) {
        if (*mems[i])
            clReleaseMemObject(*mems[i]);
        *mems[i] = NULL;
    }
    mesh->slot_capacity = 0;
    mesh->uploaded_serial = 0;
}

void camber_mesh_destroy(camber_mesh *mesh) {
    if (!mesh)
        return;
    camber_context *context = mesh->device->context;
    for (int i = 0; i < 2; i++)
        mesh->ops->release(mesh->ops_user, mesh->buffers + i);
    release_input(mesh);
    if (mesh->rows)
        clReleaseMemObject(mesh->rows);
    camber_free(context, mesh->host_bases);
    camber_free(context, mesh->polyline_rows);
    camber_free(context, mesh->first_slots);
    camber_free(context, mesh);
}

static camber_status make_buffer(camber_mesh *mesh, size_t size_bytes, cl_mem *mem) {
    cl_int code;
    cl_mem made = clCreateBuffer(mesh->device->cl, CL_MEM_READ_WRITE, size_bytes, NULL, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(mesh->device->context, "clCreateBuffer", code);
    *mem = made;
    return CAMBER_OK;
}

static camber_status reserve_input(camber_mesh *mesh, size_t slot_count) {
    if (slot_count <= mesh->slot_capacity)
        return CAMBER_OK;
    release_input(mesh);
    const size_t capacity = slot_count, blocks = capacity / CAMBER_BLOCK, words = capacity + 2;
    camber_status status = CAMBER_OK;
    const struct {
        cl_mem *mem;
        size_t size_bytes;
    } wanted[] = {
        {&mesh->x, 4 * words},       {&mesh->y, 4 * words},          {&mesh->info, 4 * words},
        {&mesh->joins, 4 * words},   {&mesh->offsets, 4 * capacity}, {&mesh->sums, 4 * blocks},
        {&mesh->bases, 16 * blocks},
    };
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted && status == CAMBER_OK; i++)
        status = make_buffer(mesh, wanted[i].size_bytes, wanted[i].mem);
    if (status != CAMBER_OK) {
        release_input(mesh);
        return status;
    }
    mesh->slot_capacity = capacity;
    return CAMBER_OK;
}

static camber_status write_buffer(camber_mesh *mesh, cl_mem mem, const void *bytes, size_t size_bytes) {
    const cl_int code = clEnqueueWriteBuffer(mesh->device->queue, mem, CL_TRUE, 0, size_bytes, bytes, 0, NULL, NULL);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(mesh->device->context, "clEnqueueWriteBuffer", code);
}

/* The polylines on the device, and where each begins on the host. */
static camber_status upload(camber_mesh *mesh, const camber_polylines *polylines) {
    if (mesh->uploaded_serial == polylines->serial)
        return CAMBER_OK;
    if (polylines->slot_count == 0) {
        mesh->uploaded_serial = mesh->polyline_count = mesh->slot_count = 0;
        return CAMBER_OK;
    }
    camber_status status = reserve_input(mesh, polylines->slot_count);
    mesh->uploaded_serial = 0;
    const size_t words = polylines->slot_count + 2, blocks = polylines->slot_count / CAMBER_BLOCK;
    const cl_uint zero = 0;
    if (status == CAMBER_OK)
        status = write_buffer(mesh, mesh->x, polylines->x, 4 * words);
    if (status == CAMBER_OK)
        status = write_buffer(mesh, mesh->y, polylines->y, 4 * words);
    if (status == CAMBER_OK)
        status = write_buffer(mesh, mesh->info, polylines->info, 4 * words);
    /* The words before and behind the points' are read by neighbours and written by nobody. */
    if (status == CAMBER_OK)
        status = write_buffer(mesh, mesh->joins, &zero, 4);
    if (status == CAMBER_OK) {
        const cl_int code =
            clEnqueueWriteBuffer(mesh->device->queue, mesh->joins, CL_TRUE, 4 * (words - 1), 4, &zero, 0, NULL, NULL);
        status = code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(mesh->device->context, "clEnqueueWriteBuffer", code);
    }
    camber_context *context = mesh->device->context;
    if (status == CAMBER_OK &&
        (!camber_grow(context, &mesh->first_slots, &mesh->polyline_capacity, polylines->polyline_count + 1,
                      sizeof *mesh->first_slots) ||
         !camber_grow(context, &mesh->polyline_rows, &mesh->row_list_capacity, polylines->polyline_count,
                      sizeof *mesh->polyline_rows) ||
         !camber_grow(context, &mesh->host_bases, &mesh->base_capacity, 2 * (blocks + 1), sizeof *mesh->host_bases)))
        status = CAMBER_ERROR_MEMORY;
    if (status != CAMBER_OK)
        return status;
    memcpy(mesh->first_slots, polylines->first_slots, (polylines->polyline_count + 1) * sizeof *mesh->first_slots);
    memcpy(mesh->polyline_rows, polylines->polyline_rows, polylines->polyline_count * sizeof *mesh->polyline_rows);
    mesh->polyline_count = polylines->polyline_count;
    mesh->row_count = polylines->row_count;
    mesh->slot_count = polylines->slot_count;
    mesh->uploaded_serial = polylines->serial;
    return CAMBER_OK;
}

static camber_status upload_rows(camber_mesh *mesh, const camber_row *rows, size_t row_count) {
    const size_t count = row_count + 1; /* never empty */
    if (count > mesh->row_capacity) {
        if (mesh->rows)
            clReleaseMemObject(mesh->rows);
        mesh->rows = NULL;
        mesh->row_capacity = 0;
        const camber_status status = make_buffer(mesh, count * sizeof *rows, &mesh->rows);
        if (status != CAMBER_OK)
            return status;
        mesh->row_capacity = count;
    }
    return write_buffer(mesh, mesh->rows, rows, count * sizeof *rows);
}

/* ---- Stages ---- */

static cl_int set_arguments(cl_kernel kernel, const cl_mem *mems, cl_uint count) {
    cl_int code = CL_SUCCESS;
    for (cl_uint i = 0; i < count && code == CL_SUCCESS; i++)
        code = clSetKernelArg(kernel, i, sizeof *mems, mems + i);
    return code;
}

/* A stage: a kernel, its arguments, and how many points a work-item takes. */
typedef struct stage {
    const char *name;
    cl_kernel kernel;
    const cl_mem *mems;
    cl_uint mem_count;
    size_t points;
} stage;

/* Runs a stage over all slots, a work-group a block. */
static camber_status run_stage(camber_mesh *mesh, stage s, cl_event *event) {
    const size_t global = mesh->slot_count / s.points, local = CAMBER_BLOCK / s.points;
    cl_int code = set_arguments(s.kernel, s.mems, s.mem_count);
    if (code == CL_SUCCESS)
        code = clEnqueueNDRangeKernel(mesh->device->queue, s.kernel, 1, NULL, &global, &local, 0, NULL, event);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(mesh->device->context, s.name, code);
}

static double event_ms(cl_event event) {
    cl_ulong begin = 0, end = 0;
    clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof begin, &begin, NULL);
    clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL);
    return (double)(end - begin) * 1e-6;
}

camber_status camber_scan_blocks(camber_context *context, const uint32_t *sums, size_t block_count, uint64_t *bases) {
    uint64_t vertices = 0, indices = 0;
    for (size_t i = 0; i <= block_count; i++) {
        bases[2 * i] = vertices;
        bases[2 * i + 1] = indices;
        if (i < block_count) {
            vertices += sums[i] & 0xffffu;
            indices += sums[i] >> 16;
        }
    }
    if (vertices >= UINT32_MAX)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "%llu vertices are more than 32-bit indices reach; tessellate in parts",
                           (unsigned long long)vertices);
    return CAMBER_OK;
}

static camber_status scan_blocks(camber_mesh *mesh) {
    cl_command_queue queue = mesh->device->queue;
    const size_t blocks = mesh->slot_count / CAMBER_BLOCK;
    cl_int code;
    const cl_uint *sums =
        clEnqueueMapBuffer(queue, mesh->sums, CL_TRUE, CL_MAP_READ, 0, 4 * blocks, 0, NULL, NULL, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(mesh->device->context, "clEnqueueMapBuffer", code);
    const camber_status status = camber_scan_blocks(mesh->device->context, sums, blocks, mesh->host_bases);
    clEnqueueUnmapMemObject(queue, mesh->sums, (void *)(uintptr_t)sums, 0, NULL, NULL);
    if (status != CAMBER_OK)
        return status;
    mesh->mesh_info.vertex_count = (size_t)mesh->host_bases[2 * blocks];
    mesh->mesh_info.index_count = (size_t)mesh->host_bases[2 * blocks + 1];
    return write_buffer(mesh, mesh->bases, mesh->host_bases, 16 * blocks);
}

/* Kinds of joins and triangles, from the join words. */
static camber_status count_joins(camber_mesh *mesh) {
    mesh->joins_counted = true;
    cl_command_queue queue = mesh->device->queue;
    const size_t size_bytes = 4 * (mesh->slot_count + 2);
    cl_int code;
    const cl_uint *joins =
        clEnqueueMapBuffer(queue, mesh->joins, CL_TRUE, CL_MAP_READ, 0, size_bytes, 0, NULL, NULL, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(mesh->device->context, "clEnqueueMapBuffer", code);
    const cl_uint *info =
        clEnqueueMapBuffer(queue, mesh->info, CL_TRUE, CL_MAP_READ, 0, size_bytes, 0, NULL, NULL, &code);
    if (code == CL_SUCCESS) {
        size_t segments = 0;
        for (size_t i = 1; i <= mesh->slot_count; i++) {
            camber_mesh_info_count(&mesh->mesh_info, joins[i], info[i]);
            segments += info[i] & CAMBER_POINT_REAL && !(info[i] & CAMBER_POINT_FIRST);
            segments += camber_join_kind(joins[i]) == CAMBER_KIND_DOT;
        }
        mesh->mesh_info.triangle_count = mesh->mesh_info.strips ? 2 * segments : mesh->mesh_info.index_count / 3;
        clEnqueueUnmapMemObject(queue, mesh->info, (void *)(uintptr_t)info, 0, NULL, NULL);
    }
    clEnqueueUnmapMemObject(queue, mesh->joins, (void *)(uintptr_t)joins, 0, NULL, NULL);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(mesh->device->context, "clEnqueueMapBuffer", code);
}

camber_mesh_info camber_mesh_get_info(camber_mesh *mesh) {
    if (!mesh->joins_counted && mesh->uploaded_serial != 0)
        (void)count_joins(mesh); /* on failure the log tells, and the counts stay 0 */
    return mesh->mesh_info;
}

static camber_status reserve_output(camber_mesh *mesh) {
    const size_t sizes[2] = {mesh->mesh_info.vertex_count * sizeof(camber_vertex), mesh->mesh_info.index_count * 4};
    for (int i = 0; i < 2; i++) {
        const camber_status status = mesh->ops->reserve(mesh->ops_user, mesh->buffers + i, sizes[i]);
        if (status != CAMBER_OK)
            return status;
        mesh->buffers[i].used_bytes = sizes[i];
    }
    return mesh->ops->begin(mesh->ops_user, mesh->buffers, 2);
}

static camber_status run_stages(camber_mesh *mesh, camber_program *program) {
    cl_event events[3] = {NULL, NULL, NULL};
    const cl_mem classify[] = {mesh->x, mesh->y,    mesh->x,    mesh->y,    mesh->x,
                               mesh->y, mesh->info, mesh->rows, mesh->joins};
    const cl_mem scan[] = {mesh->joins, mesh->info, mesh->offsets, mesh->sums};
    camber_status status = run_stage(mesh, (stage){"classify", program->classify, classify, 9, 1}, events);
    if (status == CAMBER_OK)
        status = run_stage(mesh, (stage){"scan", program->scan, scan, 4, CAMBER_SCAN_POINTS}, events + 1);
    if (status == CAMBER_OK)
        status = scan_blocks(mesh);
    mesh->empty = status != CAMBER_OK || mesh->mesh_info.vertex_count == 0;
    if (mesh->empty)
        goto done;
    status = reserve_output(mesh);
    if (status != CAMBER_OK)
        goto done;
    const cl_mem emit[] = {mesh->x,
                           mesh->y,
                           mesh->info,
                           mesh->rows,
                           mesh->joins,
                           mesh->offsets,
                           mesh->bases,
                           mesh->buffers[CAMBER_BUFFER_VERTICES].mem,
                           mesh->buffers[CAMBER_BUFFER_INDICES].mem};
    status = run_stage(mesh, (stage){"emit", program->emit, emit, 9, 1}, events + 2);
    const cl_int code = clFinish(mesh->device->queue);
    if (status == CAMBER_OK && code != CL_SUCCESS)
        status = camber_fail_cl(mesh->device->context, "clFinish", code);
    const camber_status finished = mesh->ops->finish(mesh->ops_user, mesh->buffers, 2, true);
    status = status == CAMBER_OK ? finished : status;
done:
    if (status == CAMBER_OK) {
        double *times[] = {&mesh->mesh_info.classify_ms, &mesh->mesh_info.scan_ms, &mesh->mesh_info.emit_ms};
        for (int i = 0; i < 3; i++)
            *times[i] = events[i] ? event_ms(events[i]) : 0.0;
    }
    for (int i = 0; i < 3; i++)
        if (events[i])
            clReleaseEvent(events[i]);
    return status;
}

camber_status camber_tessellate(camber_mesh *mesh, const camber_polylines *polylines,
                                const camber_tessellation_desc *desc) {
    camber_context *context = mesh->device->context;
    camber_row *rows = NULL;
    camber_program *program = NULL;
    mesh->empty = mesh->joins_counted = true;
    mesh->done = false;
    mesh->sharp_joins = mesh->flat_caps = false;
    for (size_t i = 0; i < desc->stroke_count; i++) {
        mesh->sharp_joins |= desc->strokes[i].join != CAMBER_JOIN_ROUND;
        mesh->flat_caps |= desc->strokes[i].cap != CAMBER_CAP_ROUND;
    }
    mesh->mesh_info = (camber_mesh_info){.method = desc->method, .strips = desc->method == CAMBER_METHOD_STRIP};
    camber_status status = camber_rows_create(context, polylines, desc, &rows);
    if (status == CAMBER_OK)
        status = upload(mesh, polylines);
    if (status == CAMBER_OK && polylines->slot_count > 0) {
        status = camber_device_program(mesh->device, desc->method, &program);
        if (status == CAMBER_OK)
            status = upload_rows(mesh, rows, desc->stroke_count);
        if (status == CAMBER_OK)
            status = run_stages(mesh, program);
        mesh->joins_counted = status != CAMBER_OK;
        if (status == CAMBER_OK && !mesh->empty)
            camber_program_save(mesh->device, program);
    }
    mesh->done = status == CAMBER_OK;
    mesh->empty = mesh->empty || !mesh->done;
    camber_free(context, rows);
    return status;
}

static camber_status read_buffer(camber_mesh *mesh, int which, void *bytes, size_t size_bytes) {
    const cl_int code = clEnqueueReadBuffer(mesh->device->queue, mesh->buffers[which].mem, CL_TRUE, 0, size_bytes,
                                            bytes, 0, NULL, NULL);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(mesh->device->context, "clEnqueueReadBuffer", code);
}

camber_status camber_mesh_read(camber_mesh *mesh, camber_mesh_data *data) {
    camber_context *context = mesh->device->context;
    camber_mesh_data made = {.info = camber_mesh_get_info(mesh)};
    camber_status status = CAMBER_OK;
    made.vertices = camber_alloc(context, made.info.vertex_count, sizeof *made.vertices);
    if (made.vertices)
        made.indices = camber_alloc(context, made.info.index_count, sizeof *made.indices);
    if (!made.indices)
        status = CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK && !mesh->empty) {
        status = mesh->ops->begin(mesh->ops_user, mesh->buffers, 2);
        if (status == CAMBER_OK)
            status = read_buffer(mesh, CAMBER_BUFFER_VERTICES, made.vertices,
                                 made.info.vertex_count * sizeof *made.vertices);
        if (status == CAMBER_OK)
            status =
                read_buffer(mesh, CAMBER_BUFFER_INDICES, made.indices, made.info.index_count * sizeof *made.indices);
        const camber_status finished = mesh->ops->finish(mesh->ops_user, mesh->buffers, 2, false);
        status = status == CAMBER_OK ? finished : status;
    }
    if (status != CAMBER_OK) {
        camber_mesh_data_free(context, &made);
        return status;
    }
    *data = made;
    return CAMBER_OK;
}

camber_status camber_mesh_first_index(camber_mesh *mesh, size_t polyline, uint64_t *first_index) {
    const size_t slot = mesh->first_slots[polyline];
    const size_t block = slot / CAMBER_BLOCK;
    cl_uint packed = 0;
    if (slot < mesh->slot_count && slot % CAMBER_BLOCK != 0) {
        const cl_int code =
            clEnqueueReadBuffer(mesh->device->queue, mesh->offsets, CL_TRUE, 4 * slot, 4, &packed, 0, NULL, NULL);
        if (code != CL_SUCCESS)
            return camber_fail_cl(mesh->device->context, "clEnqueueReadBuffer", code);
    }
    *first_index = mesh->host_bases[2 * block + 1] + (packed >> 16);
    return CAMBER_OK;
}
