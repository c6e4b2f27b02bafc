/* The step of Douglas and Peucker 1973 that simplification and importance share. */
#ifndef CAMBER_FARTHEST_H
#define CAMBER_FARTHEST_H

#include <stddef.h>

/* Ranges are split at their farthest point; past this depth in the middle, so that a spiral made for the worst
 * case costs n log n too. The result keeps its tolerance either way. */
#define CAMBER_FARTHEST_SPLITS 48

/* The squared distance of p from the segment a-b. */
static inline double camber_distance_squared(const double *p, const double *a, const double *b) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], px = p[0] - a[0], py = p[1] - a[1];
    const double length_squared = dx * dx + dy * dy, along = px * dx + py * dy;
    if (along <= 0.0 || length_squared == 0.0)
        return px * px + py * py;
    if (along >= length_squared)
        return (p[0] - b[0]) * (p[0] - b[0]) + (p[1] - b[1]) * (p[1] - b[1]);
    const double cross = px * dy - py * dx;
    return cross * cross / length_squared;
}

/* The point strictly between first and last that lies farthest from their segment; first where all lie on it. */
static inline size_t camber_farthest(const double *points, size_t first, size_t last, double *largest) {
    size_t found = first;
    *largest = 0.0;
    for (size_t i = first + 1; i < last; i++) {
        const double d = camber_distance_squared(points + 2 * i, points + 2 * first, points + 2 * last);
        if (d > *largest) {
            *largest = d;
            found = i;
        }
    }
    return found;
}

#endif
