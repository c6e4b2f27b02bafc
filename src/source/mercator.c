#include "source/mercator.h"

#include <math.h>

/* C11 has no M_PI. */
static const double pi = 3.14159265358979323846;

void camber_mercator_project(double longitude, double latitude, double *x, double *y) {
    *x = longitude / 360.0 + 0.5;
    /* asinh by its definition: faster, and as exact once 1/2 is added. */
    const double slope = tan(latitude * (pi / 180.0));
    const double stretched = copysign(log(fabs(slope) + sqrt(slope * slope + 1.0)), slope);
    *y = 0.5 - stretched / (2.0 * pi);
}

void camber_mercator_unproject(double x, double y, double *longitude, double *latitude) {
    *longitude = (x - 0.5) * 360.0;
    *latitude = atan(sinh(pi * (1.0 - 2.0 * y))) * (180.0 / pi);
}

void camber_mercator_from_metres(double east_m, double north_m, double *x, double *y) {
    const double circumference_m = 2.0 * pi * CAMBER_MERCATOR_RADIUS_M;
    *x = east_m / circumference_m + 0.5;
    *y = 0.5 - north_m / circumference_m;
}

double camber_mercator_wrap(double x) {
    return x >= 0 && x <= 1 ? x : x - floor(x);
}
