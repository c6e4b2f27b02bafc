/* Sections of a network: spans of its points that are on a device together. */
#ifndef CAMBER_POINTS_SECTION_H
#define CAMBER_POINTS_SECTION_H

#include "gpu/buffer.h"
#include "points/network.h"

/* Consecutive entries whose points are loaded to the device together. Most networks have one section; there are several
 * where the device's buffers or its bound on memory are too small. */
typedef struct camber_section {
    size_t first_entry, end_entry;
    size_t first_point, end_point;
    camber_buffer *x, *y, *importance, *stretches, *chunk_stretches; /* NULL: not on the device now */
    camber_buffer *lengths, *totals;                                 /* NULL where the network has no arc lengths */
    uint64_t held_bytes;                                             /* counted by who holds the section */
} camber_section;

/* The section of the entries [first, end), without buffers. */
camber_section camber_section_of(const camber_network *network, size_t first, size_t end);
/* How many bytes a section takes on the device. Not copied: the device reads the points where the host has them. */
uint64_t camber_section_bytes(const camber_network *network, const camber_section *section, bool copied);
/* The size of its largest buffer. */
uint64_t camber_section_largest_bytes(const camber_network *network, const camber_section *section);
/* Uploads the section. A device that works in host memory reads the network's own arrays, without a copy. */
camber_status camber_section_upload(const camber_device *device, const camber_network *network,
                                    camber_section *section);
void camber_section_release(const camber_device *device, camber_section *section);

#endif
