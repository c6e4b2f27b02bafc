/* Buffers in OpenCL. Some drivers allocate memory only when a kernel first uses it, and then cannot report a lack of
 * memory: PoCL ends the process. So buffers are allocated at once in host memory (CL_MEM_ALLOC_HOST_PTR). */
#include "gpu/opencl/opencl.h"

static camber_status told(const camber_device *device, const char *call, cl_int code) {
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(device->context, call, code);
}

camber_status camber_opencl_make_buffer(const camber_device *device, camber_buffer_kind kind, size_t size_bytes,
                                        const void *bytes, void **native) {
    const cl_mem_flags of_kind[] = {[CAMBER_BUFFER_OWN] = CL_MEM_READ_WRITE,
                                    [CAMBER_BUFFER_READ_BACK] = CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR,
                                    [CAMBER_BUFFER_COPY] = CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                                    [CAMBER_BUFFER_BORROWED] = CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR,
                                    [CAMBER_BUFFER_BORROWED_TO_WRITE] = CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR};
    const bool at_once = device->host_memory && kind < CAMBER_BUFFER_BORROWED;
    const cl_mem_flags flags = of_kind[kind] | (at_once ? CL_MEM_ALLOC_HOST_PTR : 0);
    cl_int code;
    /* OpenCL wants a pointer that may be written; kernels only read bytes that callers pass as const. */
    cl_mem made = camber_cl.CreateBuffer(opencl_of(device)->cl, flags, size_bytes, (void *)(uintptr_t)bytes, &code);
    if (code == CL_SUCCESS)
        *native = made;
    return told(device, "clCreateBuffer", code);
}

camber_status camber_opencl_make_gl_buffer(const camber_device *device, unsigned gl_name, void **native) {
    cl_int code;
    cl_mem made = camber_cl.CreateFromGLBuffer(opencl_of(device)->cl, CL_MEM_READ_WRITE, gl_name, &code);
    if (code == CL_SUCCESS)
        *native = made;
    return told(device, "clCreateFromGLBuffer", code);
}

void camber_opencl_release_buffer(void *native) {
    camber_cl.ReleaseMemObject(native);
}

camber_status camber_opencl_write(const camber_device *device, void *native, const camber_byte_range *range,
                                  const void *bytes, bool waits) {
    return told(device, "clEnqueueWriteBuffer",
                camber_cl.EnqueueWriteBuffer(opencl_of(device)->queue, native, waits ? CL_TRUE : CL_FALSE,
                                             range->offset_bytes, range->size_bytes, bytes, 0, NULL, NULL));
}

camber_status camber_opencl_read(const camber_device *device, void *native, size_t size_bytes, void *bytes) {
    return told(
        device, "clEnqueueReadBuffer",
        camber_cl.EnqueueReadBuffer(opencl_of(device)->queue, native, CL_TRUE, 0, size_bytes, bytes, 0, NULL, NULL));
}

camber_status camber_opencl_map(const camber_device *device, void *native, camber_map_access access, size_t size_bytes,
                                void **bytes) {
    const cl_map_flags flags = CL_MAP_READ | (access == CAMBER_MAP_READ_WRITE ? CL_MAP_WRITE : 0);
    cl_int code;
    void *mapped = camber_cl.EnqueueMapBuffer(opencl_of(device)->queue, native, CL_TRUE, flags, 0, size_bytes, 0, NULL,
                                              NULL, &code);
    if (code == CL_SUCCESS)
        *bytes = mapped;
    return told(device, "clEnqueueMapBuffer", code);
}

camber_status camber_opencl_unmap(const camber_device *device, void *native, void *bytes, bool is_told) {
    const cl_int code = camber_cl.EnqueueUnmapMemObject(opencl_of(device)->queue, native, bytes, 0, NULL, NULL);
    return is_told ? told(device, "clEnqueueUnmapMemObject", code)
                   : (code == CL_SUCCESS ? CAMBER_OK : CAMBER_ERROR_DEVICE);
}

/* Converts handles to OpenCL's type. */
static cl_uint list_mems(void *const *natives, size_t count, cl_mem mems[CAMBER_GL_BUFFERS_MAX]) {
    for (size_t i = 0; i < count; i++)
        mems[i] = natives[i];
    return (cl_uint)count;
}

camber_status camber_opencl_acquire_gl(const camber_device *device, void *const *natives, size_t count) {
    cl_mem mems[CAMBER_GL_BUFFERS_MAX];
    const cl_uint mem_count = list_mems(natives, count, mems);
    return told(device, "clEnqueueAcquireGLObjects",
                camber_cl.EnqueueAcquireGLObjects(opencl_of(device)->queue, mem_count, mems, 0, NULL, NULL));
}

camber_status camber_opencl_release_gl(const camber_device *device, void *const *natives, size_t count) {
    cl_mem mems[CAMBER_GL_BUFFERS_MAX];
    const cl_uint mem_count = list_mems(natives, count, mems);
    return told(device, "clEnqueueReleaseGLObjects",
                camber_cl.EnqueueReleaseGLObjects(opencl_of(device)->queue, mem_count, mems, 0, NULL, NULL));
}
