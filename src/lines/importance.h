/* How much each point of a set of polylines matters. Simplifying to any tolerance is then one comparison a point. */
#ifndef CAMBER_LINES_IMPORTANCE_H
#define CAMBER_LINES_IMPORTANCE_H

#include "base/base.h"

/* importance[i] is the largest tolerance, in the points' unit, that keeps point i: a tolerance T keeps the points
 * whose importance is T or more, and T = 0 keeps all. A polyline's ends have INFINITY. A ring (first point == last
 * point) keeps its seam, and three distinct points where it has an area.
 *
 * Without shared nodes a tolerance T keeps the points that Douglas and Peucker's method keeps: the original lies within
 * T of the simplified polyline, and the other way round. A node is a place where several points have equal coordinates,
 * bit for bit. All of them get the largest of their importances, so that a node is kept everywhere or nowhere. Points
 * kept for that reason can raise the distance to 2 T.
 *
 * Polyline i has the points [offsets[i], offsets[i + 1]), polyline_count + 1 entries; points are pairs, and points
 * and importance are indexed by the offsets as they are. Points should be finite. Returns CAMBER_ERROR_MEMORY,
 * CAMBER_ERROR_LIMIT (2^31 points and more). Cost: O(n log n), in the worst case too. */
camber_status camber_importance_weigh(camber_context *context, const double *points, const size_t *offsets,
                                      size_t polyline_count, float *importance);

#endif
