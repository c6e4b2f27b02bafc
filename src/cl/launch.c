/* Starting kernels, and what became of them. */
#include "cl/launch.h"

#include <stdio.h>

camber_status camber_fail_stage(const camber_device *device, const char *call, const char *name, cl_int code) {
    char what[64];
    snprintf(what, sizeof what, "%s of %s", call, name);
    return camber_fail_cl(device->context, what, code);
}

camber_status camber_launch_kernel(const camber_device *device, const camber_launch *launch, cl_event *event) {
    const size_t groups = (launch->work_items + launch->group_size - 1) / launch->group_size;
    const size_t global = groups * launch->group_size, local = launch->group_size;
    for (size_t i = 0; i < launch->arg_count; i++) {
        const camber_kernel_arg *arg = launch->args + i;
        const cl_int code = clSetKernelArg(launch->kernel, (cl_uint)i, arg->value ? arg->value_bytes : sizeof(cl_mem),
                                           arg->value ? arg->value : &arg->buffer);
        if (code != CL_SUCCESS)
            return camber_fail_stage(device, "clSetKernelArg", launch->name, code);
    }
    const cl_int code = clEnqueueNDRangeKernel(device->queue, launch->kernel, 1, NULL, &global, &local, 0, NULL, event);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_stage(device, "clEnqueueNDRangeKernel", launch->name, code);
}

void camber_add_ms(cl_event event, double *ms) {
    cl_ulong begin = 0, end = 0;
    if (!event)
        return;
    clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof begin, &begin, NULL);
    clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL);
    clReleaseEvent(event);
    *ms += (double)(end - begin) * 1e-6;
}
