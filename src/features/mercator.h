/* Web Mercator: converts degrees to world coordinates and back.
 *
 * The world is the unit square: x and y from 0 to 1, with the origin in the north-west, x to the east, y to the south:
 *     x = lon / 360 + 1/2        y = 1/2 - asinh(tan(lat)) / (2 pi)
 * (Snyder, Map Projections, USGS 1395, eq. 7-1 and 7-2 on the sphere, scaled by 1 / (2 pi R).)
 */
#ifndef CAMBER_FEATURES_MERCATOR_H
#define CAMBER_FEATURES_MERCATOR_H

#include <stddef.h>

/* The latitude at y = 0: atan(sinh(pi)), in degrees. */
#define CAMBER_MERCATOR_LATITUDE 85.051128779806604

/* The radius of EPSG:3857's sphere, in metres. */
#define CAMBER_MERCATOR_RADIUS_M 6378137.0

/* x is not wrapped: for a longitude of 190 degrees it is greater than 1. y is NaN at and beyond the poles. */
void camber_mercator_project(double longitude, double latitude, double *x, double *y);
/* Projects count places, all within the limits of latitude, to pairs x, y. It uses vector instructions, and gives the
 * same bits as camber_mercator_project. */
void camber_mercator_project_many(const double *longitudes, const double *latitudes, size_t count, double *points);
void camber_mercator_unproject(double x, double y, double *longitude, double *latitude);

/* Converts metres of EPSG:3857, with y up, to world coordinates. */
void camber_mercator_from_metres(double east_m, double north_m, double *x, double *y);

/* Moves x by whole worlds into the range from 0 to 1. 0 and 1, the two edges of the map, stay as they are. */
double camber_mercator_wrap(double x);

#endif
