/* The state that the two files of the CPU twin share. */
#ifndef CAMBER_RASTER_TWIN_H
#define CAMBER_RASTER_TWIN_H

#include "raster/raster.h"

typedef struct camber_twin {
    camber_context *context;
    const camber_raster_scene *scene;
    const camber_raster_area *area;
    camber_raster_stages *stages;
    const uint32_t *changes;     /* slots at which the brush changes */
    uint32_t columns, rows;      /* tiles */
    size_t first_edge, end_edge; /* all edges of rings are among these segments */
} camber_twin;

/* Whether a segment is the edge of a ring. */
static inline bool camber_twin_is_edge(const camber_twin *t, size_t segment) {
    return segment >= t->first_edge && segment < t->end_edge &&
           camber_bits_of(t->stages->edges[camber_edge_brush(segment)]) != CAMBER_NO_EDGE;
}

/* These draw the area's tiles from the lists; the second one is for a picture with a pitch. */
camber_status camber_twin_draw(const camber_twin *twin);
camber_status camber_twin_draw_pitched(const camber_twin *twin);

#endif
