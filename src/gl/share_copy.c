/* A copy through host memory, which works between any OpenCL and any GL. */
#include "gl/share.h"

static bool is_possible(const camber_share *share) {
    (void)share;
    return true;
}

static camber_status reserve(void *user, camber_buffer *buffer, size_t size_bytes) {
    const camber_share *share = user;
    const camber_gl *gl = &share->surface->gl;
    if (size_bytes <= buffer->capacity_bytes)
        return CAMBER_OK;
    camber_share_release(user, buffer);
    camber_status status = camber_make_buffer(share->device, CL_MEM_READ_WRITE, size_bytes, NULL, &buffer->mem);
    if (status != CAMBER_OK)
        return status;
    gl->GenBuffers(1, &buffer->gl_name);
    gl->BindBuffer(GL_ARRAY_BUFFER, buffer->gl_name);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)size_bytes, NULL, GL_DYNAMIC_DRAW);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    status = camber_share_check(share, size_bytes);
    if (status == CAMBER_OK)
        buffer->capacity_bytes = size_bytes;
    return status;
}

static camber_status begin(void *user, camber_buffer *buffers, size_t count) {
    (void)user;
    (void)buffers;
    (void)count;
    return CAMBER_OK;
}

static camber_status finish(void *user, camber_buffer *buffers, size_t count, bool written) {
    const camber_share *share = user;
    const camber_gl *gl = &share->surface->gl;
    for (size_t i = 0; i < count && written; i++) {
        cl_int code;
        void *bytes = clEnqueueMapBuffer(share->device->queue, buffers[i].mem, CL_TRUE, CL_MAP_READ, 0,
                                         buffers[i].used_bytes, 0, NULL, NULL, &code);
        if (code != CL_SUCCESS)
            return camber_fail_cl(share->device->context, "clEnqueueMapBuffer", code);
        gl->BindBuffer(GL_ARRAY_BUFFER, buffers[i].gl_name);
        gl->BufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)buffers[i].used_bytes, bytes);
        gl->BindBuffer(GL_ARRAY_BUFFER, 0);
        code = clEnqueueUnmapMemObject(share->device->queue, buffers[i].mem, bytes, 0, NULL, NULL);
        if (code == CL_SUCCESS)
            code = clFinish(share->device->queue);
        const camber_status status = code == CL_SUCCESS ? camber_share_check(share, buffers[i].used_bytes)
                                                        : camber_fail_cl(share->device->context, "clFinish", code);
        if (status != CAMBER_OK)
            return status;
    }
    return CAMBER_OK;
}

const camber_share_path camber_share_copy = {
    CAMBER_SHARING_COPY, is_possible, {reserve, begin, finish, camber_share_release}};
