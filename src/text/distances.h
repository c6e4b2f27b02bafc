/* Refines a grid of signed distances. */
#ifndef CAMBER_TEXT_DISTANCES_H
#define CAMBER_TEXT_DISTANCES_H

#include "base/base.h"

/* How many steps there are from one original value to the next after refinement. */
enum { CAMBER_DISTANCE_STEPS = 4 };

/* Makes (steps * (width - 1) + 1) * (steps * (height - 1) + 1) values from width * height: the original values and the
 * values between them. Free them with camber_free. NULL: no memory. */
float *camber_distances_refine(camber_context *context, const uint8_t *values, size_t width, size_t height);

#endif
