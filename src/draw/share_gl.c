/* cl_khr_gl_sharing: the GL buffer is the OpenCL buffer. */
#include "draw/share.h"

#include <CL/cl_gl.h>

static bool is_possible(const camber_share *share) {
    return share->device->gl_context;
}

static camber_status reserve(void *user, camber_buffer *buffer, size_t size_bytes) {
    const camber_share *share = user;
    const camber_gl *gl = &share->surface->gl;
    if (size_bytes <= buffer->capacity_bytes)
        return CAMBER_OK;
    camber_share_release(user, buffer);
    gl->GenBuffers(1, &buffer->gl_name);
    gl->BindBuffer(GL_ARRAY_BUFFER, buffer->gl_name);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)size_bytes, NULL, GL_STATIC_DRAW);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    gl->Finish();
    const camber_status status = camber_share_check(share, size_bytes);
    if (status != CAMBER_OK)
        return status;
    cl_int code;
    buffer->mem = clCreateFromGLBuffer(share->device->cl, CL_MEM_READ_WRITE, buffer->gl_name, &code);
    if (code != CL_SUCCESS) {
        buffer->mem = NULL;
        return camber_fail_cl(share->device->context, "clCreateFromGLBuffer", code);
    }
    buffer->capacity_bytes = size_bytes;
    return CAMBER_OK;
}

static camber_status begin(void *user, camber_buffer *buffers, size_t count) {
    const camber_share *share = user;
    share->surface->gl.Finish();
    for (size_t i = 0; i < count; i++) {
        const cl_int code = clEnqueueAcquireGLObjects(share->device->queue, 1, &buffers[i].mem, 0, NULL, NULL);
        if (code != CL_SUCCESS)
            return camber_fail_cl(share->device->context, "clEnqueueAcquireGLObjects", code);
    }
    return CAMBER_OK;
}

static camber_status finish(void *user, camber_buffer *buffers, size_t count, bool written) {
    const camber_share *share = user;
    (void)written;
    cl_int code = CL_SUCCESS;
    for (size_t i = 0; i < count && code == CL_SUCCESS; i++)
        code = clEnqueueReleaseGLObjects(share->device->queue, 1, &buffers[i].mem, 0, NULL, NULL);
    if (code == CL_SUCCESS)
        code = clFinish(share->device->queue);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(share->device->context, "clEnqueueReleaseGLObjects", code);
}

const camber_share_path camber_share_gl = {
    CAMBER_SHARING_GL, is_possible, {reserve, begin, finish, camber_share_release}};
