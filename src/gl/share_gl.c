/* cl_khr_gl_sharing: the GL buffer is the OpenCL buffer. */
#include "gl/share.h"

#include <CL/cl_gl.h>
#include <assert.h>

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

enum { BUFFERS_MAX = 2 };

static void list_mems(const camber_buffer *buffers, size_t count, cl_mem mems[BUFFERS_MAX]) {
    assert(count <= BUFFERS_MAX);
    for (size_t i = 0; i < count; i++)
        mems[i] = buffers[i].mem;
}

/* All at once: none is OpenCL's where one cannot be. */
static camber_status begin(void *user, camber_buffer *buffers, size_t count) {
    const camber_share *share = user;
    cl_mem mems[BUFFERS_MAX];
    list_mems(buffers, count, mems);
    camber_share_await(user, buffers, count);
    const cl_int code = clEnqueueAcquireGLObjects(share->device->queue, (cl_uint)count, mems, 0, NULL, NULL);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(share->device->context, "clEnqueueAcquireGLObjects", code);
}

static camber_status finish(void *user, camber_buffer *buffers, size_t count, bool written) {
    const camber_share *share = user;
    cl_mem mems[BUFFERS_MAX];
    (void)written;
    list_mems(buffers, count, mems);
    cl_int code = clEnqueueReleaseGLObjects(share->device->queue, (cl_uint)count, mems, 0, NULL, NULL);
    if (code != CL_SUCCESS)
        return camber_fail_cl(share->device->context, "clEnqueueReleaseGLObjects", code);
    code = clFinish(share->device->queue);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(share->device->context, "clFinish", code);
}

const camber_share_path camber_share_gl = {
    CAMBER_SHARING_GL, is_possible, {reserve, begin, finish, camber_share_release}};
