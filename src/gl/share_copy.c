/* The sharing path that copies through host memory, which works between any OpenCL and any GL. */
#include "gl/share.h"

static bool is_possible(const camber_share *share) {
    (void)share;
    return true;
}

static camber_status reserve(void *user, camber_shared_buffer *output, size_t size_bytes) {
    const camber_share *share = user;
    const camber_gl *gl = &share->surface->gl;
    if (size_bytes <= output->capacity_bytes)
        return CAMBER_OK;
    camber_share_release(user, output);
    camber_status status = camber_buffer_create(share->device, CAMBER_BUFFER_OWN, size_bytes, NULL, &output->buffer);
    if (status != CAMBER_OK)
        return status;
    gl->GenBuffers(1, &output->gl_name);
    gl->BindBuffer(GL_ARRAY_BUFFER, output->gl_name);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)size_bytes, NULL, GL_DYNAMIC_DRAW);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    status = camber_share_check(share, size_bytes);
    if (status == CAMBER_OK)
        output->capacity_bytes = size_bytes;
    return status;
}

static camber_status begin(void *user, camber_shared_buffer *outputs, size_t count) {
    (void)user;
    (void)outputs;
    (void)count;
    return CAMBER_OK;
}

static camber_status finish(void *user, camber_shared_buffer *outputs, size_t count, bool written) {
    const camber_share *share = user;
    const camber_gl *gl = &share->surface->gl;
    for (size_t i = 0; i < count && written; i++) {
        const void *bytes;
        camber_status status =
            camber_buffer_map(share->device, outputs[i].buffer, CAMBER_MAP_READ, outputs[i].used_bytes, &bytes);
        if (status != CAMBER_OK)
            return status;
        gl->BindBuffer(GL_ARRAY_BUFFER, outputs[i].gl_name);
        gl->BufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)outputs[i].used_bytes, bytes);
        gl->BindBuffer(GL_ARRAY_BUFFER, 0);
        camber_buffer_unmap(share->device, outputs[i].buffer, bytes);
        status = camber_device_finish(share->device);
        if (status == CAMBER_OK)
            status = camber_share_check(share, outputs[i].used_bytes);
        if (status != CAMBER_OK)
            return status;
    }
    return CAMBER_OK;
}

const camber_share_path camber_share_copy = {
    CAMBER_SHARING_COPY, is_possible, {reserve, begin, finish, camber_share_release}};
