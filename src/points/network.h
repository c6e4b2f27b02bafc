/* Networks as kernels read them (network.c), and aiming a camera at them (projection.c). */
#ifndef CAMBER_POINTS_NETWORK_H
#define CAMBER_POINTS_NETWORK_H

#include "base/base.h"
#include "kernels/cull.h"
#include "lines/lines.h"

#include "camber_proof.h"

/* Steps along the longer side of the bounding box, so that differences of two positions fit into 32 bits. */
#define CAMBER_NETWORK_STEPS 2147483646.0

/* Polylines in world coordinates. An entry is a polyline and its row. Invalid points divide it into stretches. */
struct camber_network {
    camber_context *context;
    size_t holders;  /* the creator, and the meshes that hold it */
    uint64_t serial; /* unique in the context, among networks and polylines */
    /* The position of step 0 and the length of a step, in world coordinates. */
    double x0, y0, step;
    int32_t *x, *y; /* point_count coordinates, from 0 to 2^31 - 2 */
    float *importance;
    bool has_importance; /* false: it is unknown, and all points have INFINITY */
    float *lengths;      /* one per point: how far along its line it is, in steps. NULL: without arc lengths */
    float *totals;       /* one per stretch: how long its whole line is, in steps */
    size_t point_count;
    camber_stretch *stretches; /* stretch_count stretches, and one after the last */
    size_t stretch_count;
    uint32_t *entry_stretches; /* entry_count + 1: the first stretch of each entry */
    uint32_t *entry_rows;
    size_t entry_count;
    uint32_t row_count; /* highest row + 1 */
    camber_polylines_stats stats;
};

/* Checks the camera and makes the projection that the kernels need. The desc's strokes must already have been checked.
 */
camber_status camber_network_aim(const camber_network *network, const camber_camera *camera,
                                 const camber_tessellation_desc *desc, camber_projection *projection);
/* Returns how many slots the points [begin, end) of the network give for the camera. The host walks the points. */
uint64_t camber_network_count_slots(const camber_network *network, const camber_projection *projection, size_t begin,
                                    size_t end);
/* Returns how many chunks `points` points have. A work-item walks one chunk. */
static inline size_t camber_network_chunk_count(size_t points) {
    return (points + CAMBER_CULL_CHUNK - 1) / CAMBER_CULL_CHUNK;
}
/* Returns a walk over the network in host memory. */
camber_walk camber_network_walk(const camber_network *network);
/* Returns the first point of an entry; for the entry after the last, the number of points. */
static inline size_t camber_network_first_point(const camber_network *network, size_t entry) {
    return network->stretches[network->entry_stretches[entry]].first;
}

/* Adds a holder: the network lives until each has called camber_network_destroy. */
void camber_network_hold(camber_network *network);

#endif
