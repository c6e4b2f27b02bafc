/* Makes, fills and releases OpenCL buffers; and camber_buffer_plain, output buffers that GL does not read. */
#include "cl/buffer.h"

/* Some drivers allocate memory only when a kernel first uses it, and then cannot report that there is none: PoCL ends
 * the process. So host memory is asked for at once (CL_MEM_ALLOC_HOST_PTR), after the budget has agreed. */
camber_status camber_make_buffer(const camber_device *device, cl_mem_flags flags, size_t size_bytes,
                                 const void *host_bytes, cl_mem *mem) {
    camber_context *context = device->context;
    const bool counts = device->host_memory && !(flags & CL_MEM_USE_HOST_PTR);
    const cl_mem_flags at_once = counts ? CL_MEM_ALLOC_HOST_PTR : 0;
    cl_int code;
    if (counts && !camber_budget_take(context, size_bytes))
        return camber_budget_fail(context, size_bytes);
    /* OpenCL wants a pointer that may be written; what callers give as const bytes is only read. */
    cl_mem made = clCreateBuffer(device->cl, flags | at_once, size_bytes, (void *)(uintptr_t)host_bytes, &code);
    if (code == CL_SUCCESS) {
        *mem = made;
        return CAMBER_OK;
    }
    if (counts)
        camber_budget_give(context, size_bytes);
    return camber_fail_cl(context, "clCreateBuffer", code);
}

/* The bytes that the budget counts for this buffer; 0 where it counts none. */
static size_t counted_bytes(const camber_device *device, cl_mem mem) {
    cl_mem_flags flags = 0;
    size_t size_bytes = 0;
    if (!device->host_memory || clGetMemObjectInfo(mem, CL_MEM_FLAGS, sizeof flags, &flags, NULL) != CL_SUCCESS ||
        (flags & CL_MEM_USE_HOST_PTR) ||
        clGetMemObjectInfo(mem, CL_MEM_SIZE, sizeof size_bytes, &size_bytes, NULL) != CL_SUCCESS)
        return 0;
    return size_bytes;
}

void camber_release_buffer(const camber_device *device, cl_mem *mem) {
    cl_mem held = *mem;
    if (!held)
        return;
    *mem = NULL;
    camber_budget_give(device->context, counted_bytes(device, held));
    clReleaseMemObject(held);
}

static camber_status write_buffer(const camber_device *device, cl_mem mem, cl_bool waits, size_t offset_bytes,
                                  size_t size_bytes, const void *bytes) {
    const cl_int code = clEnqueueWriteBuffer(device->queue, mem, waits, offset_bytes, size_bytes, bytes, 0, NULL, NULL);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(device->context, "clEnqueueWriteBuffer", code);
}

camber_status camber_write_buffer(const camber_device *device, cl_mem mem, size_t offset_bytes, size_t size_bytes,
                                  const void *bytes) {
    return write_buffer(device, mem, CL_TRUE, offset_bytes, size_bytes, bytes);
}

camber_status camber_write_buffer_later(const camber_device *device, cl_mem mem, size_t offset_bytes, size_t size_bytes,
                                        const void *bytes) {
    return write_buffer(device, mem, CL_FALSE, offset_bytes, size_bytes, bytes);
}

/* ---- Output buffers that GL does not read ---- */

static camber_status plain_reserve(void *user, camber_buffer *buffer, size_t size_bytes) {
    const camber_device *device = user;
    if (size_bytes <= buffer->capacity_bytes)
        return CAMBER_OK;
    camber_release_buffer(device, &buffer->mem);
    buffer->capacity_bytes = 0;
    const camber_status status = camber_make_buffer(device, CL_MEM_READ_WRITE, size_bytes, NULL, &buffer->mem);
    if (status == CAMBER_OK)
        buffer->capacity_bytes = size_bytes;
    return status;
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
    camber_release_buffer(user, &buffer->mem);
    *buffer = (camber_buffer){0};
}

const camber_buffer_ops camber_buffer_plain = {plain_reserve, plain_begin, plain_finish, plain_release};
