/* Output buffers that GL does not read. */
#include "gpu/shared_buffer.h"

static camber_status reserve(void *user, camber_shared_buffer *output, size_t size_bytes) {
    const camber_device *device = user;
    if (size_bytes <= output->capacity_bytes)
        return CAMBER_OK;
    camber_buffer_release(device, &output->buffer);
    output->capacity_bytes = 0;
    const camber_status status = camber_buffer_create(device, CAMBER_BUFFER_OWN, size_bytes, NULL, &output->buffer);
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
    (void)written;
    return begin(user, outputs, count);
}

static void release(void *user, camber_shared_buffer *output) {
    camber_buffer_release(user, &output->buffer);
    *output = (camber_shared_buffer){0};
}

const camber_shared_buffer_ops camber_shared_buffer_plain = {reserve, begin, finish, release};
