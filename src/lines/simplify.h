/* Drops points that a line does not need at a given tolerance. */
#ifndef CAMBER_LINES_SIMPLIFY_H
#define CAMBER_LINES_SIMPLIFY_H

#include <stddef.h>

/* Douglas and Peucker 1973, in place: no dropped point lies farther than tolerance from the line that is left.
 * points: count pairs; keep: count bytes of scratch. Ends stay. A ring (first point == last point) keeps its seam,
 * and three distinct points where it has an area. Returns how many points are left. Cost: O(n log n). */
size_t camber_simplify(double *points, size_t count, double tolerance, unsigned char *keep);

#endif
