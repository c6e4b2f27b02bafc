/* Counts the memory that is held on a device, and divides its memory limit as memory.h says. */
#include "gpu/memory.h"

/* An OpenCL renderer gets a quarter of the memory limit for meshes. If a quarter is less than DRAWING_LEAST_BYTES, the
 * renderer gets that many bytes in addition, and meshes keep their whole limit. */
static const uint64_t DRAWING_LEAST_BYTES = 4 * 1024 * 1024;

uint64_t camber_device_share(const camber_device *device, unsigned eighths) {
    return device->memory_bytes ? device->memory_bytes / 8 * eighths : UINT64_MAX;
}

bool camber_device_is_roomy(const camber_device *device, uint64_t size_bytes) {
    return !device->memory_bytes || device->held_bytes + size_bytes <= camber_device_share(device, 4);
}

void camber_device_count_bytes(camber_device *device, uint64_t *held_bytes, uint64_t now_bytes) {
    device->held_bytes += now_bytes - *held_bytes;
    *held_bytes = now_bytes;
    if (device->held_bytes + device->drawing_bytes > device->most_held_bytes)
        device->most_held_bytes = device->held_bytes + device->drawing_bytes;
}

camber_device_memory camber_device_get_memory(const camber_device *device) {
    return (camber_device_memory){device->memory_bytes + device->drawing_allowed_bytes,
                                  device->held_bytes + device->drawing_bytes, device->most_held_bytes};
}

void camber_drawing_open(camber_device *device, camber_drawing_memory *memory) {
    const uint64_t quarter = device->memory_bytes / 4;
    if (!device->memory_bytes)
        return;
    *memory = (camber_drawing_memory){.allowed_bytes = quarter, .taken_bytes = quarter};
    if (quarter < DRAWING_LEAST_BYTES)
        *memory = (camber_drawing_memory){.allowed_bytes = DRAWING_LEAST_BYTES};
    device->memory_bytes -= memory->taken_bytes;
    device->drawing_allowed_bytes += memory->allowed_bytes;
}

void camber_drawing_count_bytes(camber_device *device, camber_drawing_memory *memory, uint64_t now_bytes) {
    device->drawing_bytes += now_bytes - memory->held_bytes;
    memory->held_bytes = now_bytes;
    camber_device_count_bytes(device, &device->held_bytes, device->held_bytes);
}

void camber_drawing_close(camber_device *device, camber_drawing_memory *memory) {
    camber_drawing_count_bytes(device, memory, 0);
    device->memory_bytes += memory->taken_bytes;
    device->drawing_allowed_bytes -= memory->allowed_bytes;
}
