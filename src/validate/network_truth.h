/* The truth about networks: what a camera should show according to the definition. It is computed in double precision,
 * one segment at a time, and cut far outside the picture. Shares no formula with kernels/cull.h, except the steps to
 * which coordinates are rounded, which camber.h specifies. */
#ifndef CAMBER_VALIDATE_NETWORK_TRUTH_H
#define CAMBER_VALIDATE_NETWORK_TRUTH_H

#include "camber_proof.h"

/* Free it with camber_projected_free. */
typedef struct camber_projected {
    /* One polyline per entry, px. Invalid points separate its visible parts. Long segments are divided by additional
     * points, so that there is a point wherever a picture may have something to compare. */
    camber_lines lines;
    uint32_t *rows;   /* for each polyline */
    uint32_t *places; /* for each point: the index of the corresponding point in the entry's polyline, or of the point
                         at which its segment starts */
    size_t capacity;
} camber_projected;

/* The network must have importance and entries. margin_px: how far outside the picture lines are cut, more than any
 * stroke's reach. Returns false if memory is exhausted. */
bool camber_projected_make(const camber_network_desc *network, const camber_camera *camera, double margin_px,
                           camber_projected *made);
void camber_projected_free(camber_projected *made);

#endif
