/* How important each point of a set of polylines is. Simplifying to any tolerance then takes one comparison per point.
 */
#ifndef CAMBER_LINES_IMPORTANCE_H
#define CAMBER_LINES_IMPORTANCE_H

#include "base/base.h"

/* importance[i] is the largest tolerance, in the points' unit, that keeps point i: a tolerance T keeps the points
 * whose importance is T or more, and T = 0 keeps all. A polyline's ends have INFINITY. A ring (first point == last
 * point) keeps its seam, and three distinct points if it has an area.
 *
 * Without shared nodes a tolerance T keeps the points that the Douglas-Peucker method keeps: the original is within T
 * of the simplified polyline, and vice versa. A node is a set of points whose coordinates are equal, bit for bit. All
 * of them get the largest of their importances, so that a node is kept everywhere or nowhere. Points kept for that
 * reason can raise the distance to 2 T.
 *
 * Polyline i has the points [offsets[i], offsets[i + 1]), so offsets has polyline_count + 1 entries. Points are pairs
 * of coordinates. The offsets are indices into points and importance. Points should be finite. Returns
 * CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (2^31 or more points). Cost: O(n log n), in the worst case too. */
camber_status camber_importance_weigh(camber_context *context, const double *points, const size_t *offsets,
                                      size_t polyline_count, float *importance);

#endif
