/* Drops points that a line does not need at a given tolerance. */
#ifndef CAMBER_LINES_SIMPLIFY_H
#define CAMBER_LINES_SIMPLIFY_H

#include <stddef.h>

/* Simplifies in place by the Douglas-Peucker method (1973): no dropped point is farther than tolerance from the
 * simplified line.
 * points: count pairs; keep: count bytes of scratch. Ends are kept. A ring (first point == last point) keeps its seam,
 * and three distinct points if it has an area. Returns how many points are left. Cost: O(n log n). */
size_t camber_simplify(double *points, size_t count, double tolerance, unsigned char *keep);

#endif
