/* Collects lines in world coordinates, point by point. Lines that cross the antimeridian are split there, and latitudes
 * beyond Web Mercator's limit are moved to it. */
#ifndef CAMBER_FEATURES_WORLD_LINES_H
#define CAMBER_FEATURES_WORLD_LINES_H

#include "base/base.h"

typedef struct camber_world_lines {
    camber_context *context;
    /* for tiles: coordinates stay as they are, even beyond the world's edges, because the stitcher cuts them later */
    bool whole;
    bool uncut;     /* for areas: lines are not split at the antimeridian */
    double *points; /* pairs x, y */
    size_t point_count, point_capacity;
    size_t *ends; /* line i ends before point ends[i] */
    size_t line_count, line_capacity;

    /* The open line. A single point between two cuts at the antimeridian is on it and is left out, because its
     * neighbours draw it. */
    size_t first; /* its first point */
    bool open;    /* the line has at least one point */
    bool begun_by_cut;
    double x, y; /* the last point */

    /* Totals of all lines. */
    size_t clamped_points, antimeridian_splits;
} camber_world_lines;

/* Removes all lines, and keeps the totals and the memory. */
void camber_world_lines_begin(camber_world_lines *lines);
/* Makes room for a line of point_count points. */
bool camber_world_lines_reserve(camber_world_lines *lines, size_t point_count);
/* These return how many points and ends a line of point_count points needs at most. */
size_t camber_world_lines_most_points(size_t point_count);
size_t camber_world_lines_most_ends(size_t point_count);
/* Adds a point to the open line, or opens one. The caller has reserved room. */
void camber_world_lines_add_degrees(camber_world_lines *lines, double longitude, double latitude);
/* Does the same with points that camber_world_points converted. */
void camber_world_lines_add_points(camber_world_lines *lines, const double *points, size_t count);
void camber_world_lines_add_metres(camber_world_lines *lines, double east, double north);
/* Ends the open line, if there is one. The next point opens another. */
void camber_world_lines_end(camber_world_lines *lines);
void camber_world_lines_free(camber_world_lines *lines);
/* Converts longitudes within 180 degrees and latitudes to the world coordinates that camber_world_lines_add_degrees
 * would add. Latitudes are moved to Web Mercator's limit in place. */
void camber_world_points(const double *longitudes, double *latitudes, size_t count, double *points);

#endif
