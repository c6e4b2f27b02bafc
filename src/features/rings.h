/* Rings of areas, as fill layers draw them: closed, outer rings clockwise as seen, and holes the other way.
 *
 * A fill covers what all rings of its colour together wind around a number of times that is not 0. So a hole takes
 * away what its outer ring gives, areas may overlap, and a ring that crosses itself is drawn as it is. */
#ifndef CAMBER_FEATURES_RINGS_H
#define CAMBER_FEATURES_RINGS_H

#include "features/features.h"

/* A reader keeps this while it takes the rings of one area after the other. */
typedef struct camber_rings {
    camber_features_stats *stats;
    bool any_winding;  /* the format has no rule how rings wind */
    double outer_area; /* of the last outer ring as it was read. 0: it was left out */
} camber_rings;

/* Twice the area of a ring, whose last point is joined to its first: above 0 where it goes clockwise as seen. It is
 * exact where the ring goes to and fro on one line. */
double camber_ring_area(const double *points, size_t count);
/* Whether all points lie on one line, or fewer than three of them differ. */
bool camber_ring_is_flat(const double *points, size_t count);
void camber_ring_turn(double *points, size_t count);
/* Closes a ring in place, drops its points that are not numbers, and turns it. An outer ring comes before its holes.
 * points has room for count + 1. Returns how many points there are now; 0: nothing is left to draw. Counts what it
 * does. */
size_t camber_rings_take(camber_rings *rings, double *points, size_t count, bool hole);
/* Moves the points of a ring by whole worlds, so that it goes the short way from each to the next: it may then lie
 * beyond the edges of the world. An edge from one edge of the world to the other stays as it is. A ring around a pole
 * goes on along the pole, and one that goes round and round stays as it is. points has room for count + 4. Returns how
 * many points there are now. *crosses: the ring crosses the antimeridian. */
size_t camber_ring_unroll(double *points, size_t count, bool *crosses);
/* Whether two edges of a closed ring cross; those that touch do not. false, too, after 200 looks at each edge. */
bool camber_ring_crosses(const double *points, size_t count);
/* Whether an edge of a closed ring goes back the way that the one before it came. */
bool camber_ring_has_spike(const double *points, size_t count);
/* Counts the rings of a file that cross themselves or have a spike, and the holes that lie outside of their area. Says
 * what was done to all its rings since *before. Its polylines are those from the first one on. */
void camber_rings_report(camber_features *features, const char *name, size_t first_polyline,
                         const camber_features_stats *before);

#endif
