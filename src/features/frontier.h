/* Which lines outside a region decide how those that touch it are drawn.
 *
 * A line that leaves the region may go on in another with which it is merged. Its points outside may be nodes of other
 * lines, which decide how much the node matters. So a reader by an index asks for more until nothing is missing. */
#ifndef CAMBER_FEATURES_FRONTIER_H
#define CAMBER_FEATURES_FRONTIER_H

#include "features/features.h"

typedef struct camber_frontier camber_frontier;

/* Begins with the lines of first_polyline and after it, which are to include all that touch the region of the set.
 * merges: lines that meet end to end will become one. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_frontier_create(camber_features *features, size_t first_polyline, bool merges,
                                     camber_frontier **frontier);
void camber_frontier_destroy(camber_frontier *frontier);
/* Takes in the lines that were added since, and finds the points of which all lines must be known and are not yet:
 * *points has *count pairs of world coordinates, valid until the next call. None: nothing is missing. The caller adds
 * all lines that have one of the points. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_frontier_ask(camber_frontier *frontier, const double **points, size_t *count);
/* Whether a line has one of the points asked for so far. */
bool camber_frontier_wants(const camber_frontier *frontier, const double *points, size_t count);

#endif
