/* Shared by the files of the OpenCL back end. A buffer's native handle is a cl_mem, a program's a cl_program, a
 * camber_kernel is a cl_kernel, and a camber_event a cl_event. */
#ifndef CAMBER_GPU_OPENCL_OPENCL_H
#define CAMBER_GPU_OPENCL_OPENCL_H

#include "gpu/backend.h"
#include "gpu/opencl/cl.h"

typedef struct camber_opencl_device {
    cl_platform_id platform;
    cl_device_id id;
    cl_context cl;
    cl_command_queue queue;
} camber_opencl_device;

static inline const camber_opencl_device *opencl_of(const camber_device *device) {
    return device->native;
}

/* Logs "CALL: OpenCL NAME (code); hint" and returns the status for that code. */
camber_status camber_fail_cl(camber_context *context, const char *call, cl_int code);

camber_status camber_opencl_make_buffer(const camber_device *device, camber_buffer_kind kind, size_t size_bytes,
                                        const void *bytes, void **native);
camber_status camber_opencl_make_gl_buffer(const camber_device *device, unsigned gl_name, void **native);
void camber_opencl_release_buffer(void *native);
camber_status camber_opencl_write(const camber_device *device, void *native, const camber_byte_range *range,
                                  const void *bytes, bool waits);
camber_status camber_opencl_read(const camber_device *device, void *native, size_t size_bytes, void *bytes);
camber_status camber_opencl_map(const camber_device *device, void *native, camber_map_access access, size_t size_bytes,
                                void **bytes);
camber_status camber_opencl_unmap(const camber_device *device, void *native, void *bytes, bool is_told);
camber_status camber_opencl_acquire_gl(const camber_device *device, void *const *natives, size_t count);
camber_status camber_opencl_release_gl(const camber_device *device, void *const *natives, size_t count);

camber_status camber_opencl_make_program(camber_device *device, const camber_program_source *from,
                                         camber_program *program);
void camber_opencl_release_program(void *native);
camber_status camber_opencl_make_kernel(const camber_device *device, void *program, const char *name,
                                        camber_kernel **kernel);
void camber_opencl_release_kernel(camber_kernel *kernel);
camber_status camber_opencl_launch(const camber_device *device, const camber_launch *launch, camber_event **event);
camber_status camber_opencl_wait(const camber_device *device, camber_event *event, const char *name);
double camber_opencl_end_event(camber_event *event);

#endif
