/* Finds the lines outside a region that affect how lines in it are drawn.
 *
 * A line that leaves the region may continue in another line with which it is merged. Its points outside may be nodes
 * of other lines, which affect the nodes' importance. Therefore a reader that uses an index asks for more lines until
 * none is missing. */
#ifndef CAMBER_FEATURES_FRONTIER_H
#define CAMBER_FEATURES_FRONTIER_H

#include "features/features.h"

typedef struct camber_frontier camber_frontier;

/* Starts with the lines from first_polyline on, which must include all that touch the set's region. merges: lines that
 * meet end to end will be merged later. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_frontier_create(camber_features *features, size_t first_polyline, bool merges,
                                     camber_frontier **frontier);
void camber_frontier_destroy(camber_frontier *frontier);
/* Examines the lines that were added since the last call, and finds the points at which all lines must be known, but
 * may not be known yet: *count pairs of world coordinates in *points, valid until the next call. *count is 0 if nothing
 * is missing. The caller then adds all lines that contain one of the points. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_frontier_ask(camber_frontier *frontier, const double **points, size_t *count);
/* Whether a line contains one of the points that were asked for so far. */
bool camber_frontier_wants(const camber_frontier *frontier, const double *points, size_t count);

#endif
