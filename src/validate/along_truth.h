/* The truth about lines that change along them: 256 samples a pixel, each by the place of the line that is nearest. */
#ifndef CAMBER_VALIDATE_ALONG_TRUTH_H
#define CAMBER_VALIDATE_ALONG_TRUTH_H

#include "validate/coverage_truth.h"

/* A line whose parts lie apart from each other, with round joins, and round or butt caps. */
typedef struct camber_along_desc {
    const float *points; /* count pairs of x, y px */
    size_t count;
    camber_cap cap;
    const camber_paint *paint; /* the ends of its dashes are those of the line */
} camber_along_desc;

double camber_along_length(const float *points, size_t count);
/* Adds the premultiplied colour of each pixel of the window to rgba: 4 * width * height, rows from the top down. */
void camber_along_add(const camber_along_desc *desc, camber_window window, float *rgba);

#endif
