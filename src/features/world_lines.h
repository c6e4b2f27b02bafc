/* Lines in world coordinates as they are read, point by point. Lines that cross the antimeridian are split there, and
 * latitudes beyond Web Mercator's limit are moved to it. */
#ifndef CAMBER_FEATURES_WORLD_LINES_H
#define CAMBER_FEATURES_WORLD_LINES_H

#include "base/base.h"

typedef struct camber_world_lines {
    camber_context *context;
    /* of tiles: coordinates stay where they are, beyond the world's edges too; they are cut later */
    bool whole;
    bool uncut;     /* of areas: lines are not split at the antimeridian */
    double *points; /* pairs of x and y */
    size_t point_count, point_capacity;
    size_t *ends; /* line i ends before point ends[i] */
    size_t line_count, line_capacity;

    /* The open line. A point alone between two cuts at the antimeridian lies on it and is left out: its neighbours
     * draw it. */
    size_t first; /* the point that it begins with */
    bool open;    /* it has a point */
    bool begun_by_cut;
    double x, y; /* the last point */

    /* Sums over all lines. */
    size_t clamped_points, antimeridian_splits;
} camber_world_lines;

/* Forgets the lines, and keeps sums and memory. */
void camber_world_lines_begin(camber_world_lines *lines);
/* Makes room for a line of so many points. */
bool camber_world_lines_reserve(camber_world_lines *lines, size_t point_count);
/* How many points and ends a line of so many points takes at most. */
size_t camber_world_lines_most_points(size_t point_count);
size_t camber_world_lines_most_ends(size_t point_count);
/* Adds a point to the open line, or opens one. Room has been made. */
void camber_world_lines_add_degrees(camber_world_lines *lines, double longitude, double latitude);
/* The same for points whose world coordinates camber_world_points made. */
void camber_world_lines_add_points(camber_world_lines *lines, const double *points, size_t count);
void camber_world_lines_add_metres(camber_world_lines *lines, double east, double north);
/* Ends the line, if one is open; the next point opens another. */
void camber_world_lines_end(camber_world_lines *lines);
void camber_world_lines_free(camber_world_lines *lines);
/* World coordinates of longitudes within 180 degrees, and of latitudes, which are moved to Web Mercator's limit: those
 * that camber_world_lines_add_degrees adds. */
void camber_world_points(const double *longitudes, double *latitudes, size_t count, double *points);

#endif
