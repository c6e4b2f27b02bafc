/* How much each point of a set of polylines matters, so that any tolerance keeps points by one comparison. */
#ifndef CAMBER_LINES_IMPORTANCE_H
#define CAMBER_LINES_IMPORTANCE_H

#include "base/base.h"

/* importance[i] is the largest tolerance, in the points' unit, that keeps point i: a tolerance T keeps the points
 * with importance >= T, and T = 0 all. INFINITY at a polyline's ends; a ring (first point == last point) keeps its
 * seam and three distinct points where it has an area.
 *
 * Without shared nodes, what T keeps is what Douglas and Peucker's method keeps: within T of the polyline, and it of
 * what is kept. A node (equal coordinates, bit for bit) that occurs more than once has the largest of its
 * importances, so that it is kept everywhere or nowhere; points kept for its sake can make 2 T of that.
 *
 * Polyline i has the points [offsets[i], offsets[i + 1]), polyline_count + 1 entries; points are pairs, and points
 * and importance are indexed by the offsets as they are. Points should be finite. Returns CAMBER_ERROR_MEMORY,
 * CAMBER_ERROR_LIMIT (2^31 points and more). Cost: O(n log n), also where the input is made for the worst. */
camber_status camber_importance_weigh(camber_context *context, const double *points, const size_t *offsets,
                                      size_t polyline_count, float *importance);

#endif
