/* The only way to start a kernel: with arguments by position, each a buffer or a value, and a number of work-items. */
#ifndef CAMBER_GPU_LAUNCH_H
#define CAMBER_GPU_LAUNCH_H

#include "gpu/buffer.h"

typedef struct camber_kernel camber_kernel;
typedef struct camber_event camber_event; /* a command that was queued */

/* An argument is a value if `value` is not NULL, and else a buffer, which may be NULL. */
typedef struct camber_kernel_arg {
    camber_buffer *buffer;
    const void *value;
    size_t value_bytes;
} camber_kernel_arg;

#define CAMBER_ARG_BUFFER(which)                                                                                       \
    { .buffer = (which) }
#define CAMBER_ARG_VALUE(variable)                                                                                     \
    { .value = &(variable), .value_bytes = sizeof(variable) }

typedef struct camber_launch {
    const char *name; /* name of the stage, for error messages */
    camber_kernel *kernel;
    const camber_kernel_arg *args; /* all arguments of the kernel */
    size_t arg_count;
    size_t work_items; /* rounded up to whole work-groups */
    size_t group_size;
} camber_launch;

/* Queues the kernel. *event receives its event, which camber_event_end frees; event may be NULL. */
camber_status camber_launch_kernel(const camber_device *device, const camber_launch *launch, camber_event **event);

/* Waits for a command; name is the name of its stage. NULL counts as an event that has ended. */
camber_status camber_event_wait(const camber_device *device, camber_event *event, const char *name);

/* Adds the time that a command took to *ms and releases the event, which may be NULL. The caller must have waited for
 * the command. */
void camber_event_end(const camber_device *device, camber_event *event, double *ms);

#endif
