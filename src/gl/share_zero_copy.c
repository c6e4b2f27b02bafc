/* Zero copy on the CPU: a persistent, coherent map of the GL buffer is page-aligned host memory, and an OpenCL buffer
 * on that memory lets the kernels write straight into it. */
#include "gl/share.h"

static bool is_possible(const camber_share *share) {
    return share->device->host_memory && share->surface->info.software && share->surface->gl.BufferStorage;
}

static camber_status reserve(void *user, camber_buffer *buffer, size_t size_bytes) {
    const camber_share *share = user;
    const camber_gl *gl = &share->surface->gl;
    const GLbitfield flags = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT_EXT | GL_MAP_COHERENT_BIT_EXT;
    if (size_bytes <= buffer->capacity_bytes)
        return CAMBER_OK;
    camber_share_release(user, buffer);
    gl->GenBuffers(1, &buffer->gl_name);
    gl->BindBuffer(GL_ARRAY_BUFFER, buffer->gl_name);
    gl->BufferStorage(GL_ARRAY_BUFFER, (GLsizeiptr)size_bytes, NULL, flags);
    buffer->map = gl->MapBufferRange(GL_ARRAY_BUFFER, 0, (GLsizeiptr)size_bytes, flags);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    camber_status status = camber_share_check(share, size_bytes);
    if (status != CAMBER_OK)
        return status;
    if (!buffer->map)
        return camber_fail(share->device->context, CAMBER_ERROR_MEMORY,
                           "a GL buffer of %zu bytes cannot be mapped; draw less at once", size_bytes);
    status = camber_make_buffer(share->device, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, size_bytes, buffer->map,
                                &buffer->mem);
    if (status == CAMBER_OK)
        buffer->capacity_bytes = size_bytes;
    return status;
}

static camber_status begin(void *user, camber_buffer *buffers, size_t count) {
    camber_share_await(user, buffers, count);
    return CAMBER_OK;
}

/* OpenCL promises what it wrote to host memory only to a map of it; on the devices at hand it costs nothing. */
static camber_status finish(void *user, camber_buffer *buffers, size_t count, bool written) {
    const camber_share *share = user;
    const char *call = "clEnqueueMapBuffer";
    cl_int code = CL_SUCCESS;
    for (size_t i = 0; i < count && written && code == CL_SUCCESS; i++) {
        void *seen = clEnqueueMapBuffer(share->device->queue, buffers[i].mem, CL_TRUE, CL_MAP_READ, 0,
                                        buffers[i].used_bytes, 0, NULL, NULL, &code);
        if (code == CL_SUCCESS)
            code = clEnqueueUnmapMemObject(share->device->queue, buffers[i].mem, seen, 0, NULL, NULL);
    }
    if (code == CL_SUCCESS) {
        call = "clFinish";
        code = clFinish(share->device->queue);
    }
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(share->device->context, call, code);
}

const camber_share_path camber_share_zero_copy = {
    CAMBER_SHARING_ZERO_COPY, is_possible, {reserve, begin, finish, camber_share_release}};
