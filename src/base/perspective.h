/* A camera that looks at the plane of the map at an angle, as MapLibre's does. It turns about the centre of the
 * picture, where one px of the plane is one px of the picture. Its field of view is measured vertically.
 *
 *     x, y   px of the plane, from the centre, y down          seen_x = x / depth
 *     depth  1 - fall * y: 1 in the middle, more beyond it     seen_y = cosine * y / depth */
#ifndef CAMBER_BASE_PERSPECTIVE_H
#define CAMBER_BASE_PERSPECTIVE_H

#include "base/maths.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define CAMBER_PITCH_MAX_DEG 85.0

typedef struct camber_perspective {
    double cosine, fall;
    double nearest, farthest; /* depth at the picture's bottom, and the depth beyond which nothing is drawn */
    double far_y;             /* y of the farthest depth in the picture, in px from its centre; negative */
} camber_perspective;

static inline double camber_perspective_depth(const camber_perspective *p, double seen_y) {
    return p->cosine / (p->cosine + p->fall * seen_y);
}

/* Makes the perspective for a picture's height and a pitch above 0. The far plane is MapLibre's: at 85 % of the way
 * from the centre to the horizon, or at the picture's top if that is nearer, and 1 % farther. */
static inline camber_perspective camber_perspective_of(double pitch_deg, double height_px) {
    const double tan_half_view = 1.0 / 3.0; /* the field of view is 0.6435011087932844 rad */
    const double angle = pitch_deg * (3.14159265358979323846 / 180.0), half = 0.5 * height_px;
    camber_perspective p;
    camber_sine_cosine(angle, &p.fall, &p.cosine);
    p.fall *= tan_half_view / half;
    const double top = p.cosine - p.fall * half, horizon = 1.0 / (1.0 - 0.85);
    p.nearest = camber_perspective_depth(&p, half);
    p.farthest = 1.01 * (top * horizon > p.cosine ? p.cosine / top : horizon);
    p.far_y = -(p.cosine / p.fall) * (1.0 - 1.0 / p.farthest);
    return p;
}

/* Counts the scanlines at the top of the picture that stay empty because their middles are beyond the far plane. */
static inline uint32_t camber_perspective_horizon(const camber_perspective *p, uint32_t height_px) {
    const double row = floor(0.5 * height_px + p->far_y + 0.5);
    return row > 0.0 ? (uint32_t)row : 0;
}

static inline bool camber_pitch_is_valid(double pitch_deg) {
    return pitch_deg >= 0.0 && pitch_deg <= CAMBER_PITCH_MAX_DEG; /* false for NaN */
}

#endif
