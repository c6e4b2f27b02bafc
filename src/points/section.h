/* Sections of a network: spans of its points that are on a device together. */
#ifndef CAMBER_POINTS_SECTION_H
#define CAMBER_POINTS_SECTION_H

#include "gpu/buffer.h"
#include "points/network.h"

/* Consecutive entries whose points are loaded to the device together. Most networks have one section; there are several
 * if the device's buffers or its memory limit are too small. */
typedef struct camber_section {
    size_t first_entry, end_entry;
    size_t first_point, end_point;
    camber_buffer *x, *y, *importance, *stretches, *chunk_stretches; /* NULL: not on the device at present */
    camber_buffer *lengths, *totals;                                 /* NULL if the network has no arc lengths */
    uint64_t held_bytes;                                             /* counted by the holder of the section */
} camber_section;

/* Returns the section of the entries [first, end), without buffers. */
camber_section camber_section_of(const camber_network *network, size_t first, size_t end);
/* Returns how many bytes a section takes on the device. If it is not copied, the device borrows the points from the
 * host. */
uint64_t camber_section_bytes(const camber_network *network, const camber_section *section, bool copied);
/* Returns the size of the section's largest buffer. */
uint64_t camber_section_largest_bytes(const camber_network *network, const camber_section *section);
/* Uploads the section. A device that uses host memory borrows the network's own arrays (zero copy). */
camber_status camber_section_upload(const camber_device *device, const camber_network *network,
                                    camber_section *section);
void camber_section_release(const camber_device *device, camber_section *section);

#endif
