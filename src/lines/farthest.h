/* The step of the Douglas-Peucker method (1973) that simplification and importance share. */
#ifndef CAMBER_LINES_FARTHEST_H
#define CAMBER_LINES_FARTHEST_H

#include <stddef.h>

/* Ranges of points are split at their farthest point. Past this depth they are split in the middle, so that even a
 * spiral made for the worst case costs n log n. The result keeps its tolerance either way. */
#define CAMBER_FARTHEST_SPLITS 48

/* Returns the point strictly between first and last that is farthest from the segment between these two, and its
 * squared distance. Returns first if all points are on the segment.
 *
 * For a point alongside the segment, the distance is that to its line; before a or beyond b, the distance to that end:
 *
 *            alongside
 *     before a--------b beyond
 *
 * Which case holds varies from point to point, so that a branch would often be guessed wrong. The loop therefore
 * computes all three and selects. */
static inline size_t camber_farthest(const double *points, size_t first, size_t last, double *largest) {
    const double *a = points + 2 * first, *b = points + 2 * last;
    const double dx = b[0] - a[0], dy = b[1] - a[1], length_squared = dx * dx + dy * dy;
    /* If the segment has no length, every point counts as beyond its end. */
    const double inverse = length_squared > 0.0 ? 1.0 / length_squared : 0.0;
    size_t found = first;
    double most = 0.0;
    for (size_t i = first + 1; i < last; i++) {
        const double *p = points + 2 * i;
        const double px = p[0] - a[0], py = p[1] - a[1], qx = p[0] - b[0], qy = p[1] - b[1];
        const double along = px * dx + py * dy, cross = px * dy - py * dx;
        const double alongside = cross * cross * inverse, before = px * px + py * py, beyond = qx * qx + qy * qy;
        const double past = along <= 0.0 ? before : beyond;
        const double d = ((along > 0.0) & (along < length_squared)) ? alongside : past;
        if (d > most) {
            most = d;
            found = i;
        }
    }
    *largest = most;
    return found;
}

#endif
