/* How much memory the meshes of a device and its OpenCL renderers may hold, and how much they hold.
 *
 * The memory limit for meshes is divided into eighths:
 *     1   strokes and counts
 *     1   the section of a network that is being read
 *     4   a part of a single polyline, which cannot be cut
 *     2   unused room in buffers that a part has taken over from another
 * A part of several polylines gets one eighth, so that the next part does not have to evict everything. */
#ifndef CAMBER_GPU_MEMORY_H
#define CAMBER_GPU_MEMORY_H

#include "gpu/device.h"

/* Returns the given eighths of the memory limit for the device's meshes, in bytes; UINT64_MAX if there is none. */
uint64_t camber_device_share(const camber_device *device, unsigned eighths);
/* Whether meshes would still hold at most half of their memory limit if they held size_bytes more. */
bool camber_device_is_roomy(const camber_device *device, uint64_t size_bytes);
/* Counts that a holder of *held_bytes now holds now_bytes, and sets *held_bytes to now_bytes. */
void camber_device_count_bytes(camber_device *device, uint64_t *held_bytes, uint64_t now_bytes);

/* How much the buffers of one OpenCL renderer may hold, and how much they hold. */
typedef struct camber_drawing_memory {
    uint64_t allowed_bytes; /* 0: no limit */
    uint64_t taken_bytes;   /* taken out of the memory limit for meshes */
    uint64_t held_bytes;
} camber_drawing_memory;

/* These reserve memory for a renderer, count what it holds, and give the memory back to meshes. If meshes have no
 * limit, the renderer has none either. */
void camber_drawing_open(camber_device *device, camber_drawing_memory *memory);
void camber_drawing_count_bytes(camber_device *device, camber_drawing_memory *memory, uint64_t now_bytes);
void camber_drawing_close(camber_device *device, camber_drawing_memory *memory);

#endif
