/* How much memory a device's meshes and what draws in OpenCL may hold, and how much they do.
 *
 * A bound is shared out in eighths: one for strokes and counts, one for the network's section that is read, four for a
 * part of a single polyline, two for what is left over in buffers that a part takes from another. Parts of several
 * polylines take one, so that what is there need not all go for the next. */
#ifndef CAMBER_CL_MEMORY_H
#define CAMBER_CL_MEMORY_H

#include "cl/device.h"

/* So many eighths of what the device's meshes may hold; UINT64_MAX where there is no bound. */
uint64_t camber_device_share(const camber_device *device, unsigned eighths);
/* Whether there is room for that much many times over. */
bool camber_device_is_roomy(const camber_device *device, uint64_t size_bytes);
/* A holder that had *held_bytes now has now_bytes. */
void camber_device_count(camber_device *device, uint64_t *held_bytes, uint64_t now_bytes);

/* What a renderer's buffers may hold and do. */
typedef struct camber_drawing_memory {
    uint64_t allowed_bytes; /* 0: no bound */
    uint64_t taken_bytes;   /* of what meshes were allowed */
    uint64_t held_bytes;
} camber_drawing_memory;

void camber_drawing_open(camber_device *device, camber_drawing_memory *memory);
void camber_drawing_count(camber_device *device, camber_drawing_memory *memory, uint64_t now_bytes);
void camber_drawing_close(camber_device *device, camber_drawing_memory *memory);

#endif
