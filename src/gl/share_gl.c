/* The sharing path cl_khr_gl_sharing: the OpenCL output is the GL buffer. */
#include "gl/share.h"

static bool is_possible(const camber_share *share) {
    return share->device->gl_context;
}

static camber_status reserve(void *user, camber_shared_buffer *output, size_t size_bytes) {
    const camber_share *share = user;
    const camber_gl *gl = &share->surface->gl;
    if (size_bytes <= output->capacity_bytes)
        return CAMBER_OK;
    camber_share_release(user, output);
    gl->GenBuffers(1, &output->gl_name);
    gl->BindBuffer(GL_ARRAY_BUFFER, output->gl_name);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)size_bytes, NULL, GL_STATIC_DRAW);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    gl->Finish();
    camber_status status = camber_share_check(share, size_bytes);
    if (status == CAMBER_OK)
        status = camber_buffer_create_of_gl(share->device, output->gl_name, &output->buffer);
    if (status == CAMBER_OK)
        output->capacity_bytes = size_bytes;
    return status;
}

static void list_buffers(const camber_shared_buffer *outputs, size_t count,
                         camber_buffer *buffers[CAMBER_GL_BUFFERS_MAX]) {
    for (size_t i = 0; i < count; i++)
        buffers[i] = outputs[i].buffer;
}

static camber_status begin(void *user, camber_shared_buffer *outputs, size_t count) {
    const camber_share *share = user;
    camber_buffer *buffers[CAMBER_GL_BUFFERS_MAX];
    list_buffers(outputs, count, buffers);
    camber_share_await(user, outputs, count);
    return camber_buffers_acquire(share->device, buffers, count);
}

static camber_status finish(void *user, camber_shared_buffer *outputs, size_t count, bool written) {
    const camber_share *share = user;
    camber_buffer *buffers[CAMBER_GL_BUFFERS_MAX];
    (void)written;
    list_buffers(outputs, count, buffers);
    const camber_status status = camber_buffers_give_back(share->device, buffers, count);
    return status == CAMBER_OK ? camber_device_finish(share->device) : status;
}

const camber_share_path camber_share_gl = {
    CAMBER_SHARING_GL, is_possible, {reserve, begin, finish, camber_share_release}};
