/* The truth about lines that change along them: 256 samples a pixel, each by the place of the line that is nearest; and
 * where a place of a picture lies in a plane that is seen at an angle. */
#ifndef CAMBER_VALIDATE_ALONG_TRUTH_H
#define CAMBER_VALIDATE_ALONG_TRUTH_H

#include "validate/coverage_truth.h"

/* A line whose parts lie apart from each other, with round joins, and round or butt caps. */
typedef struct camber_along_desc {
    const float *points; /* count pairs of x, y px */
    size_t count;
    camber_cap cap;
    /* The ends of its dashes are those of the line. An image is opaque, without a stride or a ramp beside it, and with
     * its image_px; its red alone is right. */
    const camber_paint *paint;
    double pitch_deg; /* 0: from above */
} camber_along_desc;

double camber_along_length(const float *points, size_t count);
/* Where the ray through a place of a picture of this size meets the plane, px of the plane, which in the picture's
 * middle are those of the picture; and how deep, 1 in the middle. false: nowhere in front of the camera, which stands
 * where MapLibre's does. */
bool camber_ray_meets_plane(double pitch_deg, const double size[2], double x, double y, double met[2], double *depth);
/* The red of an image without a stride, 0 to 1, at shares u and v of its width and height, any finite numbers:
 * bilinear, and repeated both ways. */
double camber_image_red(const camber_image *image, double u, double v);
/* Adds the premultiplied colour of each pixel of the window to rgba: 4 * width * height, rows from the top down. With a
 * pitch the window is the whole picture. */
void camber_along_add(const camber_along_desc *desc, camber_window window, float *rgba);

#endif
