/* Launches kernels in OpenCL. */
#include "gpu/opencl/opencl.h"

#include <stdio.h>

static camber_status fail_stage(const camber_device *device, const char *call, const char *name, cl_int code) {
    char what[64];
    snprintf(what, sizeof what, "%s of %s", call, name);
    return camber_fail_cl(device->context, what, code);
}

static cl_int set_arg(cl_kernel kernel, cl_uint i, const camber_kernel_arg *arg) {
    cl_mem mem = arg->buffer ? arg->buffer->native : NULL;
    return arg->value ? camber_cl.SetKernelArg(kernel, i, arg->value_bytes, arg->value)
                      : camber_cl.SetKernelArg(kernel, i, sizeof mem, &mem);
}

camber_status camber_opencl_launch(const camber_device *device, const camber_launch *launch, camber_event **event) {
    const size_t groups = (launch->work_items + launch->group_size - 1) / launch->group_size;
    const size_t global = groups * launch->group_size, local = launch->group_size;
    cl_kernel kernel = (cl_kernel)launch->kernel;
    cl_event made = NULL;
    for (size_t i = 0; i < launch->arg_count; i++) {
        const cl_int code = set_arg(kernel, (cl_uint)i, launch->args + i);
        if (code != CL_SUCCESS)
            return fail_stage(device, "clSetKernelArg", launch->name, code);
    }
    const cl_int code = camber_cl.EnqueueNDRangeKernel(opencl_of(device)->queue, kernel, 1, NULL, &global, &local, 0,
                                                       NULL, event ? &made : NULL);
    if (code != CL_SUCCESS)
        return fail_stage(device, "clEnqueueNDRangeKernel", launch->name, code);
    if (event)
        *event = (camber_event *)made;
    return CAMBER_OK;
}

camber_status camber_opencl_wait(const camber_device *device, camber_event *event, const char *name) {
    cl_event waited = (cl_event)event;
    const cl_int code = camber_cl.WaitForEvents(1, &waited);
    return code == CL_SUCCESS ? CAMBER_OK : fail_stage(device, "clWaitForEvents", name, code);
}

double camber_opencl_end_event(camber_event *event) {
    cl_ulong begin = 0, end = 0;
    camber_cl.GetEventProfilingInfo((cl_event)event, CL_PROFILING_COMMAND_START, sizeof begin, &begin, NULL);
    camber_cl.GetEventProfilingInfo((cl_event)event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL);
    camber_cl.ReleaseEvent((cl_event)event);
    return (double)(end - begin) * 1e-6;
}
