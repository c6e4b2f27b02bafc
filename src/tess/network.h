/* Networks as kernels read them (network.c), aiming at them (projection.c), and what lies on a device (sections.c). */
#ifndef CAMBER_TESS_NETWORK_H
#define CAMBER_TESS_NETWORK_H

#include "kernels/cull.h"
#include "tess/mesh.h"

/* Steps over the longer side of the box: differences of two of them are 32-bit numbers. */
#define CAMBER_NETWORK_STEPS 2147483646.0

/* Polylines in world coordinates. An entry is a polyline and its row. Stretches are what invalid points leave of it. */
struct camber_network {
    camber_context *context;
    size_t holders;  /* the creator, and the meshes that hold it */
    uint64_t serial; /* unique in the context, as that of polylines */
    /* Where step 0 lies, and how long a step is, in world coordinates. */
    double x0, y0, step;
    int32_t *x, *y; /* point_count, in 0 to 2^31 - 2 */
    float *importance;
    float *lengths; /* a point: how far along its line it lies, in steps. NULL: without arc lengths */
    float *totals;  /* a stretch: how long its whole line is, in steps */
    size_t point_count;
    camber_stretch *stretches; /* run_count stretches, and one behind the last */
    size_t stretch_count;
    uint32_t *entry_stretches; /* entry_count + 1: the first stretch of each entry */
    uint32_t *entry_rows;
    size_t entry_count;
    uint32_t row_count; /* highest row + 1 */
    camber_polylines_stats stats;
};

/* Checks the camera and makes the projection that the kernels need. The desc's strokes must have been checked. */
camber_status camber_network_aim(const camber_network *network, const camber_camera *camera,
                                 const camber_tessellation_desc *desc, camber_projection *projection);
/* How many slots the camera makes of the points [begin, end) of the network. The host walks them. */
uint64_t camber_network_count_slots(const camber_network *network, const camber_projection *projection, size_t begin,
                                    size_t end);
/* How many chunks so many points have. A work-item walks one chunk. */
static inline size_t camber_network_chunk_count(size_t points) {
    return (points + CAMBER_CULL_CHUNK - 1) / CAMBER_CULL_CHUNK;
}
/* A walk over the network in host memory. */
camber_walk camber_network_walk(const camber_network *network);
/* The first point of an entry; for the entry behind the last, the number of points. */
static inline size_t camber_network_first_point(const camber_network *network, size_t entry) {
    return network->stretches[network->entry_stretches[entry]].first;
}

/* Consecutive entries whose points are loaded to the device together. Most networks have one section; there are several
 * where the device's buffers or its bound on memory are too small. */
typedef struct camber_section {
    size_t first_entry, end_entry;
    size_t first_point, end_point;
    camber_buffer *x, *y, *importance, *stretches, *chunk_stretches; /* NULL: not on the device now */
    camber_buffer *lengths, *totals;                                 /* NULL where the network has no arc lengths */
    uint64_t held_bytes;
} camber_section;

/* A network that a mesh holds, its sections on the device, and how the camera last saw it. */
struct camber_held_network {
    camber_network *network;
    camber_projection projection; /* of the last tessellation */
    camber_program *program;
    camber_section *sections;
    size_t section_count, section_capacity;
    camber_buffer *counts, *bases; /* one a chunk of the part in work: slots, and slots before; all parts take turns */
    size_t chunk_capacity;
    camber_event *projected; /* the launch of cull_emit, until its time has been added */
};

/* Adds a holder: the network lives until each has called camber_network_destroy. */
void camber_network_hold(camber_network *network);
/* How many bytes a section takes on the device. Not copied: the device reads the points where the host has them. */
uint64_t camber_section_bytes(const camber_network *network, const camber_section *section, bool copied);
/* Uploads the section that a part's points lie in, unless it is there. */
camber_status camber_part_upload_section(camber_mesh *mesh, const camber_mesh_part *part);
void camber_section_count_bytes(const camber_mesh *mesh, camber_section *section);
void camber_section_release(const camber_mesh *mesh, camber_section *section);

#endif
