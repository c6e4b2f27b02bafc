/* Makes, fills, maps and releases buffers, and counts buffers in the host's memory against the budget. */
#include "gpu/backend.h"

#include <assert.h>

/* Makes a buffer's struct. Some drivers allocate memory only when a kernel first uses it, and then it is too late to
 * report a lack of memory. So this function asks the budget first, and back ends allocate host memory at once. */
static camber_buffer *take_bytes(const camber_device *device, size_t counted_bytes, camber_status *status) {
    camber_context *context = device->context;
    *status = CAMBER_OK;
    if (!camber_budget_take(context, counted_bytes)) {
        *status = camber_budget_fail(context, counted_bytes);
        return NULL;
    }
    camber_buffer *made = camber_alloc_zero(context, 1, sizeof *made);
    if (made)
        made->counted_bytes = counted_bytes;
    else
        camber_budget_give(context, counted_bytes);
    *status = made ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    return made;
}

static void give_bytes(const camber_device *device, camber_buffer *buffer) {
    camber_budget_give(device->context, buffer->counted_bytes);
    camber_free(device->context, buffer);
}

camber_status camber_buffer_create(const camber_device *device, camber_buffer_kind kind, size_t size_bytes,
                                   const void *bytes, camber_buffer **buffer) {
    const bool counts = device->host_memory && kind < CAMBER_BUFFER_BORROWED && !device->backend->counts_memory;
    camber_status status;
    camber_buffer *made = take_bytes(device, counts ? size_bytes : 0, &status);
    if (!made)
        return status;
    status = device->backend->make_buffer(device, kind, size_bytes, bytes, &made->native);
    if (status == CAMBER_OK)
        *buffer = made;
    else
        give_bytes(device, made);
    return status;
}

camber_status camber_buffer_create_of_gl(const camber_device *device, unsigned gl_name, camber_buffer **buffer) {
    camber_status status;
    camber_buffer *made = take_bytes(device, 0, &status);
    if (!made)
        return status;
    status = device->backend->make_gl_buffer(device, gl_name, &made->native);
    if (status == CAMBER_OK)
        *buffer = made;
    else
        give_bytes(device, made);
    return status;
}

void camber_buffer_release(const camber_device *device, camber_buffer **buffer) {
    camber_buffer *held = *buffer;
    if (!held)
        return;
    *buffer = NULL;
    device->backend->release_buffer(held->native);
    give_bytes(device, held);
}

camber_status camber_buffer_write(const camber_device *device, camber_buffer *buffer, size_t offset_bytes,
                                  size_t size_bytes, const void *bytes) {
    return device->backend->write(device, buffer->native, &(camber_byte_range){offset_bytes, size_bytes}, bytes, true);
}

camber_status camber_buffer_write_later(const camber_device *device, camber_buffer *buffer, size_t offset_bytes,
                                        size_t size_bytes, const void *bytes) {
    return device->backend->write(device, buffer->native, &(camber_byte_range){offset_bytes, size_bytes}, bytes, false);
}

camber_status camber_buffer_read(const camber_device *device, camber_buffer *buffer, size_t size_bytes, void *bytes) {
    return size_bytes ? device->backend->read(device, buffer->native, size_bytes, bytes) : CAMBER_OK;
}

camber_status camber_buffer_map(const camber_device *device, camber_buffer *buffer, camber_map_access access,
                                size_t size_bytes, void *bytes) {
    void **at = bytes, *mapped = NULL;
    const camber_status status = device->backend->map(device, buffer->native, access, size_bytes, &mapped);
    if (status == CAMBER_OK)
        *at = mapped;
    return status;
}

void camber_buffer_unmap(const camber_device *device, camber_buffer *buffer, const void *bytes) {
    if (bytes)
        (void)device->backend->unmap(device, buffer->native, (void *)(uintptr_t)bytes, false);
}

camber_status camber_buffer_unmap_written(const camber_device *device, camber_buffer *buffer, void *bytes) {
    return device->backend->unmap(device, buffer->native, bytes, true);
}

static void list_natives(camber_buffer *const *buffers, size_t count, void *natives[CAMBER_GL_BUFFERS_MAX]) {
    assert(count <= CAMBER_GL_BUFFERS_MAX);
    for (size_t i = 0; i < count; i++)
        natives[i] = buffers[i]->native;
}

camber_status camber_buffers_acquire(const camber_device *device, camber_buffer *const *buffers, size_t count) {
    void *natives[CAMBER_GL_BUFFERS_MAX];
    list_natives(buffers, count, natives);
    return device->backend->acquire_gl(device, natives, count);
}

camber_status camber_buffers_give_back(const camber_device *device, camber_buffer *const *buffers, size_t count) {
    void *natives[CAMBER_GL_BUFFERS_MAX];
    list_natives(buffers, count, natives);
    return device->backend->release_gl(device, natives, count);
}
