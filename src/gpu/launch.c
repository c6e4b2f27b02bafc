/* Starts kernels and waits for them. */
#include "gpu/backend.h"

camber_status camber_launch_kernel(const camber_device *device, const camber_launch *launch, camber_event **event) {
    return device->backend->launch(device, launch, event);
}

camber_status camber_event_wait(const camber_device *device, camber_event *event, const char *name) {
    return event ? device->backend->wait(device, event, name) : CAMBER_OK;
}

void camber_event_end(const camber_device *device, camber_event *event, double *ms) {
    if (event)
        *ms += device->backend->end_event(event);
}
