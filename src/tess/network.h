/* Networks as the kernels read them, and what of them lies on a device. */
#ifndef CAMBER_TESS_NETWORK_H
#define CAMBER_TESS_NETWORK_H

#include "kernels/network.h"
#include "tess/mesh.h"

struct camber_network {
    camber_context *context;
    size_t holders;  /* who made it, and the meshes that hold it */
    uint64_t serial; /* as that of polylines */
    /* World coordinates of step 0, and how many of them a step takes. */
    double x0, y0, step;
    int32_t *x, *y; /* point_count, in 0 to 2^31 - 2 */
    float *importance;
    float *lengths; /* of the points: along the line of their run, steps. NULL: not measured */
    float *totals;  /* of the runs, as many: how long that line is */
    size_t point_count;
    camber_run *runs; /* run_count and one behind them */
    size_t run_count;
    uint32_t *entry_runs; /* entry_count + 1: the first run of each */
    uint32_t *entry_rows;
    size_t entry_count;
    uint32_t row_count; /* highest row + 1 */
    camber_polylines_stats stats;
};

/* Checks the camera and makes what the kernels need of it. The strokes are valid. */
camber_status camber_network_aim(const camber_network *network, const camber_camera *camera,
                                 const camber_tessellation_desc *desc, camber_projection *projection);
/* How many slots the points [begin, end) make; both lie in the network. */
uint64_t camber_network_count(const camber_network *network, const camber_projection *projection, size_t begin,
                              size_t end);
/* A walk over the network in host memory. */
camber_walk camber_network_walk(const camber_network *network);
/* The first point of an entry; of the one behind the last, the number of points. */
static inline size_t camber_network_first_point(const camber_network *network, size_t entry) {
    return network->runs[network->entry_runs[entry]].first;
}

/* Entries whose points are in buffers of their own: all, unless the device's largest buffer is too small. */
typedef struct camber_section {
    size_t first_entry, end_entry;
    size_t first_point, end_point;
    cl_mem x, y, importance, runs, chunk_runs; /* NULL: not there */
    cl_mem lengths, totals;                    /* NULL where the network is not measured */
    uint64_t held_bytes;
} camber_section;

/* What a mesh holds of a network. */
struct camber_held_network {
    camber_network *network;
    camber_projection projection; /* of the last tessellation */
    camber_program *program;
    camber_section *sections;
    size_t section_count, section_capacity;
    cl_mem counts, bases; /* of a part's chunks, one part after the other */
    size_t chunk_capacity;
    cl_event projected; /* of project, until its time has been taken */
};

void camber_network_hold(camber_network *network);
/* What a section takes; copied: the device does not read the network's own memory. */
uint64_t camber_section_bytes(const camber_network *network, const camber_section *section, bool copied);
void camber_section_count(const camber_mesh *mesh, camber_section *section);
void camber_section_release(const camber_mesh *mesh, camber_section *section);

#endif
