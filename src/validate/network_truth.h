/* The truth about networks: what a camera should show, from the definition alone: in double precision, a segment at a
 * time, cut far outside the picture. Shares no formula with kernels/cull.h but the steps that coordinates are
 * rounded to, which camber.h states. */
#ifndef CAMBER_VALIDATE_NETWORK_TRUTH_H
#define CAMBER_VALIDATE_NETWORK_TRUTH_H

#include "camber_proof.h"

/* Freed with camber_projected_free. */
typedef struct camber_projected {
    /* A polyline an entry, px. Points that are not numbers lie between its visible parts; a segment that is long is
     * given points on the way, so that there is one wherever a picture has something to look at. */
    camber_lines lines;
    uint32_t *rows;   /* of each polyline */
    uint32_t *places; /* of each point: the point of the entry's polyline that it is, or that begins its segment */
    size_t capacity;
} camber_projected;

/* The network has importance and entries. margin_px: how far outside the picture lines are cut, farther than any stroke
 * reaches. false: out of memory. */
bool camber_projected_make(const camber_network_desc *network, const camber_camera *camera, double margin_px,
                           camber_projected *made);
void camber_projected_free(camber_projected *made);

#endif
