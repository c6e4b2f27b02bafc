/* The one way to start a kernel: arguments by position, each a buffer or a value, over so many work-items. */
#ifndef CAMBER_CL_LAUNCH_H
#define CAMBER_CL_LAUNCH_H

#include "cl/device.h"

/* An argument is a value where that is not NULL, and else a buffer, which may be NULL. */
typedef struct camber_kernel_arg {
    cl_mem buffer;
    const void *value;
    size_t value_bytes;
} camber_kernel_arg;

#define CAMBER_ARG_BUFFER(mem)                                                                                         \
    { .buffer = (mem) }
#define CAMBER_ARG_VALUE(variable)                                                                                     \
    { .value = &(variable), .value_bytes = sizeof(variable) }

typedef struct camber_launch {
    const char *name; /* of the stage: errors name it */
    cl_kernel kernel;
    const camber_kernel_arg *args; /* all that the kernel has */
    size_t arg_count;
    size_t work_items; /* rounded up to whole work-groups */
    size_t group_size;
} camber_launch;

/* Queues the kernel. event, which may be NULL, takes its event. */
camber_status camber_launch_kernel(const camber_device *device, const camber_launch *launch, cl_event *event);

/* Adds the time of a command to ms and releases the event, which may be NULL. */
void camber_add_ms(cl_event event, double *ms);

camber_status camber_fail_stage(const camber_device *device, const char *call, const char *name, cl_int code);

#endif
