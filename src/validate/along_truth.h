/* The truth about lines whose look changes along them: 256 samples per pixel, each coloured by the nearest position of
 * the line. Also says which position of a plane that is seen at an angle appears at a position in the picture. */
#ifndef CAMBER_VALIDATE_ALONG_TRUTH_H
#define CAMBER_VALIDATE_ALONG_TRUTH_H

#include "validate/coverage_truth.h"

/* A line whose parts are far apart from each other, with round joins, and round or butt caps. */
typedef struct camber_along_desc {
    const float *points; /* count pairs of x and y, px */
    size_t count;
    camber_cap cap;
    /* Dashes have the same caps as the line. An image must be opaque and have an image_px, but no stride; it cannot be
     * combined with a ramp. Only its red channel is computed. */
    const camber_paint *paint;
    double pitch_deg; /* 0: seen from above */
} camber_along_desc;

double camber_along_length(const float *points, size_t count);
/* Finds where the ray through a position in a picture of this size meets the plane. met is in px of the plane, which
 * equal the picture's px in its middle; depth is 1 in the middle. Returns false if the ray does not meet the plane in
 * front of the camera. The camera is where MapLibre's is. */
bool camber_ray_meets_plane(double pitch_deg, const double size[2], double x, double y, double met[2], double *depth);
/* Returns the red channel of an image without a stride, 0 to 1, at fractions u and v of its width and height. The image
 * is sampled bilinearly and repeated in both directions; u and v may be any finite numbers. */
double camber_image_red(const camber_image *image, double u, double v);
/* Adds the premultiplied colour of each pixel of the window to rgba: 4 * width * height values, rows from the top down.
 * With a pitch, the window must be the whole picture. */
void camber_along_add(const camber_along_desc *desc, camber_window window, float *rgba);

#endif
