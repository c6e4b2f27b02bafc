/* Rings of areas in the form that fill layers draw: closed, with outer rings clockwise on the map, and holes
 * counter-clockwise.
 *
 * A fill covers a place if the rings of its colour together wind around the place a number of times other than 0. So a
 * hole is cut out of its outer ring, areas may overlap, and a ring that crosses itself is drawn as it is. */
#ifndef CAMBER_FEATURES_RINGS_H
#define CAMBER_FEATURES_RINGS_H

#include "features/features.h"

/* A reader's state while it takes the rings of one area, one after the other. */
typedef struct camber_rings {
    camber_features_stats *stats;
    bool any_winding;  /* the format does not say in which direction rings wind */
    double outer_area; /* the area of the last outer ring, as it was read. 0: that ring was left out */
} camber_rings;

/* Returns twice the area of a ring, whose last point is joined to its first. It is positive if the ring goes clockwise
 * on the map, and exactly 0 for a ring that goes back and forth on one line. */
double camber_ring_area(const double *points, size_t count);
/* Whether all points are on one line, or fewer than three of them are different. */
bool camber_ring_is_flat(const double *points, size_t count);
void camber_ring_turn(double *points, size_t count);
/* Closes a ring in place, drops points that are not numbers, and turns it to the right direction. An outer ring comes
 * before its holes. points has room for count + 1. Returns the new number of points; 0: nothing is left to draw. Counts
 * its repairs. */
size_t camber_rings_take(camber_rings *rings, double *points, size_t count, bool hole);
/* Moves the points of a ring by whole worlds, so that each edge goes the short way. The ring may then extend beyond the
 * edges of the world. An edge from one edge of the world to the other stays as it is. A ring around a pole is continued
 * along the pole, and a ring that goes around the Earth several times stays as it is. points has room for count + 4.
 * Returns the new number of points. *crosses: the ring crosses the antimeridian. */
size_t camber_ring_unroll(double *points, size_t count, bool *crosses);
/* Whether two edges of a closed ring cross; touching does not count. Gives up and returns false after 200 comparisons
 * per edge. */
bool camber_ring_crosses(const double *points, size_t count);
/* Whether an edge of a closed ring goes straight back along the one before it. */
bool camber_ring_has_spike(const double *points, size_t count);
/* Counts the rings of a file that cross themselves or have a spike, and holes outside their area. Then logs all repairs
 * and defects of the file's rings that were counted since *before. The file's polylines begin with first_polyline. */
void camber_rings_report(camber_features *features, const char *name, size_t first_polyline,
                         const camber_features_stats *before);

#endif
