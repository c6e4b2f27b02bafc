#include "bench.h"

#include "base/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Random walks ---- */

enum { WALK_POINTS_MAX = 40 };

/* xorshift64 (Marsaglia 2003): 0 to 1. */
static double uniform(uint64_t *state) {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) / 9007199254740992.0;
}

bool bench_scene_walks(camber_context *context, size_t polyline_count, double step_px, camber_lines *lines) {
    uint64_t state = 0x2545f4914f6cdd1dull;
    camber_lines made = {.polyline_count = polyline_count};
    made.offsets = camber_alloc(context, polyline_count + 1, sizeof *made.offsets);
    made.points = camber_alloc(context, polyline_count * WALK_POINTS_MAX, 2 * sizeof *made.points);
    if (!made.offsets || !made.points) {
        camber_lines_free(context, &made);
        return false;
    }
    for (size_t i = 0; i < polyline_count; i++) {
        made.offsets[i] = (uint32_t)made.point_count;
        size_t count = 2 + (size_t)(-log(1 - uniform(&state)) * 5);
        count = count < WALK_POINTS_MAX ? count : WALK_POINTS_MAX;
        double x = uniform(&state) * BENCH_SIDE_PX, y = uniform(&state) * BENCH_SIDE_PX,
               heading = uniform(&state) * 6.283;
        for (size_t k = 0; k < count; k++) {
            made.points[2 * made.point_count] = (float)x;
            made.points[2 * made.point_count + 1] = (float)y;
            made.point_count++;
            const double length = step_px * (0.3 + 1.4 * uniform(&state));
            heading += (uniform(&state) - 0.5) * (uniform(&state) < 0.1 ? 4 : 0.8);
            x += cos(heading) * length;
            y += sin(heading) * length;
        }
    }
    made.offsets[polyline_count] = (uint32_t)made.point_count;
    *lines = made;
    return true;
}

/* ---- Maps ---- */

#ifdef CAMBER_MAP

#include "camber_map.h"

static int ascending(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Stretches one axis so that all but half a percent of the points at each end lie in 0 to the side; gives the scale. */
static double middle_of(const camber_lines *lines, size_t axis, float *sorted, double *low) {
    for (size_t i = 0; i < lines->point_count; i++)
        sorted[i] = lines->points[2 * i + axis];
    qsort(sorted, lines->point_count, sizeof *sorted, ascending);
    *low = (double)sorted[lines->point_count / 200];
    return (double)sorted[lines->point_count - 1 - lines->point_count / 200] - *low;
}

static bool fit(camber_context *context, camber_lines *lines) {
    float *sorted = camber_alloc(context, lines->point_count, sizeof *sorted);
    if (!sorted)
        return false;
    double low_x, low_y;
    const double across = middle_of(lines, 0, sorted, &low_x), down = middle_of(lines, 1, sorted, &low_y);
    const double scale = BENCH_SIDE_PX / (across > down ? across : down);
    for (size_t i = 0; i < lines->point_count; i++) {
        lines->points[2 * i] = (float)(((double)lines->points[2 * i] - low_x) * scale);
        lines->points[2 * i + 1] = (float)(((double)lines->points[2 * i + 1] - low_y) * scale);
    }
    camber_free(context, sorted);
    return lines->point_count > 0;
}

static bool copy_lines(camber_context *context, const camber_lines *from, camber_lines *to) {
    camber_lines made = {.polyline_count = from->polyline_count, .point_count = from->point_count};
    made.offsets = camber_alloc(context, from->polyline_count + 1, sizeof *made.offsets);
    made.points = camber_alloc(context, from->point_count, 2 * sizeof *made.points);
    if (!made.offsets || !made.points) {
        camber_lines_free(context, &made);
        return false;
    }
    memcpy(made.offsets, from->offsets, (from->polyline_count + 1) * sizeof *made.offsets);
    memcpy(made.points, from->points, from->point_count * 2 * sizeof *made.points);
    *to = made;
    return true;
}

bool bench_scene_map(camber_context *context, const char *path, camber_lines *lines) {
    camber_style *style = NULL;
    camber_features *features = NULL;
    camber_scene *scene = NULL;
    /* Large enough that floats keep what the fit needs, and nothing lies outside. */
    const camber_scene_desc view = {.view = {.width = 16384, .height = 16384}};
    const camber_source_desc source = {.path = path};
    bool done = camber_style_builtin(context, CAMBER_THEME_LIGHT, &style) == CAMBER_OK &&
                camber_features_create(context, style, &features) == CAMBER_OK &&
                camber_features_read(features, &source) == CAMBER_OK &&
                camber_scene_create(features, &view, &scene) == CAMBER_OK &&
                copy_lines(context, camber_scene_lines(scene), lines);
    if (done && !fit(context, lines)) {
        camber_lines_free(context, lines);
        done = false;
    }
    camber_scene_destroy(scene);
    camber_features_destroy(features);
    camber_style_destroy(style);
    return done;
}

#else

bool bench_scene_map(camber_context *context, const char *path, camber_lines *lines) {
    (void)context;
    (void)path;
    (void)lines;
    return false;
}

#endif
