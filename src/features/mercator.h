/* Web Mercator: degrees to world coordinates and back.
 *
 * The world is the unit square, x and y in 0 to 1 from the north-west corner, x to the east, y to the south:
 *     x = lon / 360 + 1/2        y = 1/2 - asinh(tan(lat)) / (2 pi)
 * (Snyder, Map Projections, USGS 1395, eq. 7-1 and 7-2 on the sphere, scaled by 1 / (2 pi R).)
 */
#ifndef CAMBER_FEATURES_MERCATOR_H
#define CAMBER_FEATURES_MERCATOR_H

#include <stddef.h>

/* The latitude of y = 0: atan(sinh(pi)), degrees. */
#define CAMBER_MERCATOR_LATITUDE 85.051128779806604

/* The sphere of EPSG:3857, metres. */
#define CAMBER_MERCATOR_RADIUS_M 6378137.0

/* x is not wrapped: 190 degrees east lies beyond 1. y is NaN at and beyond the poles. */
void camber_mercator_project(double longitude, double latitude, double *x, double *y);
/* As many places, none beyond the limit, as pairs of x and y: in vectors, with the same bits. */
void camber_mercator_project_many(const double *longitudes, const double *latitudes, size_t count, double *points);
void camber_mercator_unproject(double x, double y, double *longitude, double *latitude);

/* Metres of EPSG:3857, y up, to world coordinates. */
void camber_mercator_from_metres(double east_m, double north_m, double *x, double *y);

/* x moved by whole worlds into 0 to 1; 0 and 1 themselves, both edges of the map, stay. */
double camber_mercator_wrap(double x);

#endif
