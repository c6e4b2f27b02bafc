/* How much memory the meshes of a device and its OpenCL renderers may hold, and how much they hold.
 *
 * The bound on meshes is divided into eighths:
 *     1   strokes and counts
 *     1   the section of a network that is being read
 *     4   a part of a single polyline, which cannot be cut
 *     2   unused room in buffers that a part has taken over from another
 * A part of several polylines gets one eighth, so that the next part does not have to evict everything. */
#ifndef CAMBER_GPU_MEMORY_H
#define CAMBER_GPU_MEMORY_H

#include "gpu/device.h"

/* That many eighths of the bound on the device's meshes, in bytes; UINT64_MAX where there is no bound. */
uint64_t camber_device_share(const camber_device *device, unsigned eighths);
/* Whether meshes would still hold at most half of their bound with size_bytes more. */
bool camber_device_is_roomy(const camber_device *device, uint64_t size_bytes);
/* Counts that something which held *held_bytes now holds now_bytes, and sets *held_bytes to that. */
void camber_device_count_bytes(camber_device *device, uint64_t *held_bytes, uint64_t now_bytes);

/* How much the buffers of one OpenCL renderer may hold, and how much they hold. */
typedef struct camber_drawing_memory {
    uint64_t allowed_bytes; /* 0: no bound */
    uint64_t taken_bytes;   /* taken out of the bound on meshes */
    uint64_t held_bytes;
} camber_drawing_memory;

/* Reserves memory for a renderer, counts what it holds, and gives the memory back to meshes. Without a bound on meshes
 * the renderer has none either. */
void camber_drawing_open(camber_device *device, camber_drawing_memory *memory);
void camber_drawing_count_bytes(camber_device *device, camber_drawing_memory *memory, uint64_t now_bytes);
void camber_drawing_close(camber_device *device, camber_drawing_memory *memory);

#endif
