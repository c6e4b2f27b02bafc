/* Finds the outline of a glyph that is given as signed distances. */
#ifndef CAMBER_TEXT_CONTOURS_H
#define CAMBER_TEXT_CONTOURS_H

#include "text/outline.h"

typedef struct camber_contour_source {
    const float *values; /* width * height, rows from the top down; larger values are inside */
    uint32_t width, height;
    float left, top; /* position of the first value */
    float scale;     /* distance from one value to the next */
} camber_contour_source;

/* Adds the rings at which the distance is 0. */
void camber_contours_trace(const camber_contour_source *source, camber_outline_maker *maker);

#endif
