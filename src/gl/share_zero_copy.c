/* The zero-copy sharing path, on the CPU: a persistent, coherent mapping of the GL buffer is page-aligned host memory,
 * and an OpenCL buffer on that memory lets the kernels write straight into it. */
#include "gl/share.h"

static bool is_possible(const camber_share *share) {
    return share->device->host_memory && share->surface->info.software && share->surface->gl.BufferStorage;
}

static camber_status reserve(void *user, camber_shared_buffer *output, size_t size_bytes) {
    const camber_share *share = user;
    const camber_gl *gl = &share->surface->gl;
    const GLbitfield flags = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT_EXT | GL_MAP_COHERENT_BIT_EXT;
    if (size_bytes <= output->capacity_bytes)
        return CAMBER_OK;
    camber_share_release(user, output);
    gl->GenBuffers(1, &output->gl_name);
    gl->BindBuffer(GL_ARRAY_BUFFER, output->gl_name);
    gl->BufferStorage(GL_ARRAY_BUFFER, (GLsizeiptr)size_bytes, NULL, flags);
    output->map = gl->MapBufferRange(GL_ARRAY_BUFFER, 0, (GLsizeiptr)size_bytes, flags);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    camber_status status = camber_share_check(share, size_bytes);
    if (status != CAMBER_OK)
        return status;
    if (!output->map)
        return camber_fail(share->device->context, CAMBER_ERROR_MEMORY,
                           "a GL buffer of %zu bytes cannot be mapped; draw less at once", size_bytes);
    status =
        camber_buffer_create(share->device, CAMBER_BUFFER_BORROWED_TO_WRITE, size_bytes, output->map, &output->buffer);
    if (status == CAMBER_OK)
        output->capacity_bytes = size_bytes;
    return status;
}

static camber_status begin(void *user, camber_shared_buffer *outputs, size_t count) {
    camber_share_await(user, outputs, count);
    return CAMBER_OK;
}

/* OpenCL guarantees that its writes are in host memory only after the buffer was mapped; on the devices tried, mapping
 * costs nothing. */
static camber_status finish(void *user, camber_shared_buffer *outputs, size_t count, bool written) {
    const camber_share *share = user;
    for (size_t i = 0; i < count && written; i++) {
        const void *seen;
        const camber_status status =
            camber_buffer_map(share->device, outputs[i].buffer, CAMBER_MAP_READ, outputs[i].used_bytes, &seen);
        if (status != CAMBER_OK)
            return status;
        camber_buffer_unmap(share->device, outputs[i].buffer, seen);
    }
    return camber_device_finish(share->device);
}

const camber_share_path camber_share_zero_copy = {
    CAMBER_SHARING_ZERO_COPY, is_possible, {reserve, begin, finish, camber_share_release}};
