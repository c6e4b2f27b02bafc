/* Makes lines from points as they are read.
 *
 * Input: points in degrees or metres, and the ends of lines. Output: lines in world coordinates. Between two points a
 * line goes the short way around the Earth, so it is split if that way crosses the antimeridian. Between two points on
 * opposite edges of the map, as on a parallel around the Earth, there is no short way, and the line crosses the map as
 * written.
 */
#include "features/world_lines.h"

#include "features/mercator.h"

#include <math.h>

/* Points this close to an edge of the world count as on it: 4 cm. */
static const double EDGE = 1e-9;

void camber_world_lines_begin(camber_world_lines *lines) {
    lines->point_count = lines->line_count = 0;
    lines->open = lines->begun_by_cut = false;
}

/* A line keeps its own points, gets two more at each crossing of the antimeridian, and becomes at most as many lines as
 * it has points. */
size_t camber_world_lines_most_points(size_t point_count) {
    return 3 * point_count;
}

size_t camber_world_lines_most_ends(size_t point_count) {
    return point_count + 1;
}

bool camber_world_lines_reserve(camber_world_lines *lines, size_t point_count) {
    return point_count <= SIZE_MAX / 64 - lines->point_count &&
           camber_grow(lines->context, &lines->points, &lines->point_capacity,
                       lines->point_count + camber_world_lines_most_points(point_count), 2 * sizeof *lines->points) &&
           camber_grow(lines->context, &lines->ends, &lines->line_capacity,
                       lines->line_count + camber_world_lines_most_ends(point_count), sizeof *lines->ends);
}

void camber_world_lines_free(camber_world_lines *lines) {
    camber_free(lines->context, lines->ends);
    camber_free(lines->context, lines->points);
    lines->points = NULL;
    lines->ends = NULL;
}

static void push(camber_world_lines *lines, double x, double y) {
    if (!lines->open) {
        lines->first = lines->point_count;
        lines->open = true;
    }
    lines->points[2 * lines->point_count] = x;
    lines->points[2 * lines->point_count + 1] = y;
    lines->point_count++;
}

static void end_line(camber_world_lines *lines, bool cut) {
    if (!lines->open)
        return;
    if (lines->point_count - lines->first == 1 && (cut || lines->begun_by_cut))
        lines->point_count = lines->first;
    else
        lines->ends[lines->line_count++] = lines->point_count;
    lines->open = false;
    lines->begun_by_cut = cut;
}

void camber_world_lines_end(camber_world_lines *lines) {
    end_line(lines, false);
    lines->begun_by_cut = false;
}

/* Called if the short way from the last point to (x, y) crosses x = 0 or 1. Ends the line there and begins one on the
 * other side. Interpolates linearly in world coordinates, in which the segment is drawn. */
static void cross_antimeridian(camber_world_lines *lines, double x, double y) {
    const double out = x < lines->x ? 1.0 : 0.0; /* the edge at which it leaves */
    const double beyond = x < lines->x ? x + 1.0 : x - 1.0;
    const double length = beyond - lines->x;
    const double crossing = length != 0 ? lines->y + (y - lines->y) * ((out - lines->x) / length) : y;
    if (lines->x != out)
        push(lines, out, crossing);
    end_line(lines, true);
    if (x != 1.0 - out)
        push(lines, 1.0 - out, crossing);
    lines->antimeridian_splits++;
}

/* Whether the way from the last point to x is as long as the world is wide. However, if a line arrived at the
 * antimeridian from inside the world, such as a ship's track, it continues beyond; then the two points are the same
 * place. */
static bool goes_across(const camber_world_lines *lines, double x) {
    const double before = lines->point_count - lines->first > 1 ? lines->points[2 * lines->point_count - 4] : lines->x;
    const double came = fabs(lines->x - before);
    return fabs(x - lines->x) > 1.0 - EDGE && !(came > 0.0 && came <= 0.5);
}

static void add(camber_world_lines *lines, double x, double y) {
    if (lines->open && !lines->whole && !lines->uncut && fabs(x - lines->x) > 0.5 && !goes_across(lines, x))
        cross_antimeridian(lines, x, y);
    push(lines, x, y);
    lines->x = x;
    lines->y = y;
}

void camber_world_lines_add_metres(camber_world_lines *lines, double east, double north) {
    double x, y;
    camber_mercator_from_metres(east, north, &x, &y);
    if (!lines->whole && (y < 0 || y > 1)) {
        lines->clamped_points++;
        y = y < 0 ? 0 : 1;
    }
    add(lines, lines->whole ? x : camber_mercator_wrap(x), y);
}

void camber_world_lines_add_degrees(camber_world_lines *lines, double longitude, double latitude) {
    double x, y;
    if (fabs(latitude) > CAMBER_MERCATOR_LATITUDE) {
        lines->clamped_points++;
        latitude = copysign(CAMBER_MERCATOR_LATITUDE, latitude);
    }
    camber_mercator_project(longitude, latitude, &x, &y);
    /* At the latitude's limit, y may be outside the world by a rounding error. */
    add(lines, camber_mercator_wrap(x), fmin(fmax(y, 0), 1));
}

void camber_world_points(const double *longitudes, double *latitudes, size_t count, double *points) {
    for (size_t i = 0; i < count; i++)
        latitudes[i] = fabs(latitudes[i]) > CAMBER_MERCATOR_LATITUDE ? copysign(CAMBER_MERCATOR_LATITUDE, latitudes[i])
                                                                     : latitudes[i];
    camber_mercator_project_many(longitudes, latitudes, count, points);
    for (size_t i = 0; i < count; i++) {
        const double y = points[2 * i + 1];
        points[2 * i + 1] = y < 0.0 ? 0.0 : y > 1.0 ? 1.0 : y;
    }
}

void camber_world_lines_add_points(camber_world_lines *lines, const double *points, size_t count) {
    for (size_t i = 0; i < count; i++)
        add(lines, points[2 * i], points[2 * i + 1]);
}
