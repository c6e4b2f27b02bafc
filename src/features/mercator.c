#include "features/mercator.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* C11 has no M_PI. */
static const double pi = 3.14159265358979323846;

/* Four terms of a series, for 1, w, w^2 and w^3, with short dependency chains, because latency costs more here than
 * operations. */
static inline double sum(double w, double a, double b, double c, double d) {
    return (a + b * w) + w * w * (c + d * w);
}

/* The natural logarithm of a value of at least 1: the logarithm of a power of two plus the logarithm of the remaining
 * factor m, which is between sqrt(1/2) and sqrt(2). log(m) = 2 atanh(z), z = (m - 1) / (m + 1). The terms of its series
 * after z^19 are below a double's precision. */
static inline double logarithm(double value) {
    const uint64_t root_half = UINT64_C(0x3fe6a09e667f3bcd), two_to_52 = UINT64_C(0x4330000000000000);
    uint64_t bits;
    double m, power;
    memcpy(&bits, &value, sizeof bits);
    const uint64_t exponent = (bits - root_half) >> 52, rest = bits - (exponent << 52), number = two_to_52 | exponent;
    memcpy(&m, &rest, sizeof m);
    memcpy(&power, &number, sizeof power);
    const double z = (m - 1.0) / (m + 1.0), w = z * z, w4 = w * w * (w * w);
    const double tail = sum(w, 1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9) +
                        w4 * (sum(w, 1.0 / 11, 1.0 / 13, 1.0 / 15, 1.0 / 17) + w4 * (1.0 / 19));
    return (power - 0x1p52) * 0.69314718055994530942 + (2.0 * z + 2.0 * z * w * tail);
}

/* asinh(tan(lat)) = log((cos + sin) / (cos - sin)), with the sine and cosine of half the latitude. These are series up
 * to the 17th power. Only + - * / are used, so that the result has the same bits on all machines. */
static inline double project_latitude(double latitude) {
    const double half = fabs(latitude) * (pi / 360.0), w = half * half, w4 = w * w * (w * w);
    const double cosine =
        sum(w, 1.0, -1.0 / 2, 1.0 / 24, -1.0 / 720) +
        w4 * (sum(w, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600, -1.0 / 87178291200) + w4 * (1.0 / 20922789888000));
    const double sine =
        half + half * w *
                   (sum(w, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880) +
                    w4 * sum(w, -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000));
    return 0.5 - copysign(logarithm((cosine + sine) / (cosine - sine)) / (2.0 * pi), latitude);
}

void camber_mercator_project(double longitude, double latitude, double *x, double *y) {
    *x = longitude / 360.0 + 0.5;
    *y = fabs(latitude) < 90.0 ? project_latitude(latitude) : (double)NAN;
}

void camber_mercator_project_many(const double *longitudes, const double *latitudes, size_t count, double *points) {
    for (size_t i = 0; i < count; i++) {
        points[2 * i] = longitudes[i] / 360.0 + 0.5;
        points[2 * i + 1] = project_latitude(latitudes[i]);
    }
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
