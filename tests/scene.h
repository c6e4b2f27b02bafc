/* Polylines that the tests make up, and the rows to tessellate them with. */
#ifndef CAMBER_TESTS_SCENE_H
#define CAMBER_TESTS_SCENE_H

#include "core.h"

#include "lines/lines.h"

#include <math.h>

typedef struct scene {
    float *points;
    size_t point_count, point_capacity;
    uint32_t *offsets; /* polyline_count + 1 */
    uint32_t *rows;
    size_t polyline_count, polyline_capacity;
} scene;

static inline void scene_point(scene *s, double x, double y) {
    if (s->point_count == s->point_capacity) {
        s->point_capacity = s->point_capacity ? 2 * s->point_capacity : 256;
        s->points = realloc(s->points, 2 * s->point_capacity * sizeof *s->points);
        assert_non_null(s->points);
    }
    s->points[2 * s->point_count] = (float)x;
    s->points[2 * s->point_count++ + 1] = (float)y;
}

/* The points since the last call are a polyline. */
static inline void scene_end(scene *s, size_t row) {
    if (s->polyline_count + 2 > s->polyline_capacity) {
        s->polyline_capacity = s->polyline_capacity ? 2 * s->polyline_capacity : 64;
        s->offsets = realloc(s->offsets, s->polyline_capacity * sizeof *s->offsets);
        s->rows = realloc(s->rows, s->polyline_capacity * sizeof *s->rows);
        assert_true(s->offsets && s->rows);
    }
    s->offsets[0] = 0;
    s->rows[s->polyline_count] = (uint32_t)row;
    s->offsets[++s->polyline_count] = (uint32_t)s->point_count;
}

static inline void scene_free(scene *s) {
    free(s->rows);
    free(s->offsets);
    free(s->points);
    *s = (scene){0};
}

/* The first polylines of a scene. */
static inline camber_polylines *scene_first(camber_context *context, const scene *s, size_t count, bool keep_open) {
    const camber_polylines_desc desc = {s->points, count ? s->offsets[count] : 0, s->offsets, count, s->rows,
                                        keep_open};
    camber_polylines *polylines = NULL;
    assert_int_equal(camber_polylines_create(context, &desc, &polylines), CAMBER_OK);
    return polylines;
}

static inline camber_polylines *scene_polylines(camber_context *context, const scene *s) {
    return scene_first(context, s, s->polyline_count, false);
}

/* Nine rows: every join with every cap, widths from nothing to wide, limits from tight to none. */
enum { SCENE_ROWS = 9 };
static inline void scene_strokes(camber_stroke strokes[SCENE_ROWS]) {
    static const float widths[] = {0.0f, 0.3f, 1.0f, 2.0f, 3.5f, 8.0f, 12.0f, 40.0f, 200.0f};
    static const float limits[] = {0.0f, 1.0f, 1.4f, 2.0f, 4.0f, 10.0f, 1e9f, INFINITY, 2.5f};
    for (int i = 0; i < SCENE_ROWS; i++)
        strokes[i] = (camber_stroke){widths[i], (camber_join)(i % 3), (camber_cap)(i / 3), limits[i]};
}

static const double SCENE_PI = 3.14159265358979323846;

/* count points in steps of least to most px, each turning by up to turn radians. */
static inline void scene_walk(scene *s, uint64_t *seed, size_t count, const double step[2], double turn) {
    double x = random_between(seed, 0, 1000), y = random_between(seed, 0, 1000);
    double direction = random_between(seed, -SCENE_PI, SCENE_PI);
    for (size_t i = 0; i < count; i++) {
        scene_point(s, x, y);
        const double length = random_between(seed, step[0], step[1]);
        direction += random_between(seed, -turn, turn);
        x += length * cos(direction);
        y += length * sin(direction);
    }
}

static inline void scene_walks(scene *s, uint64_t *seed) {
    for (size_t i = 0; i < 300; i++) {
        scene_walk(s, seed, random_below(seed, 40), (const double[]){0.1, 60}, i % 2 ? 0.6 : SCENE_PI);
        scene_end(s, i % SCENE_ROWS);
    }
}

/* Ends of polylines on, before and behind the borders of blocks, and one line over many blocks. */
static inline void scene_blocks(scene *s, uint64_t *seed) {
    static const size_t counts[] = {256, 255, 257, 1, 511, 1, 1, 254, 513, 5000, 2, 128, 128, 300};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        scene_walk(s, seed, counts[i], (const double[]){1, 30}, 2.5);
        scene_end(s, i % SCENE_ROWS);
    }
}

static inline void scene_rings(scene *s, uint64_t *seed) {
    for (size_t i = 0; i < 120; i++) {
        const size_t sides = 2 + random_below(seed, 30);
        const double x = random_between(seed, 0, 1000), y = random_between(seed, 0, 1000);
        const double radius = random_between(seed, 0.1, 100), turns = (double)(1 + random_below(seed, 3));
        const size_t first = s->point_count;
        for (size_t k = 0; k < sides; k++) {
            const double angle = 2 * SCENE_PI * turns * (double)k / (double)sides * (i % 2 ? 1 : -1);
            scene_point(s, x + radius * cos(angle), y + radius * sin(angle));
        }
        scene_point(s, (double)s->points[2 * first], (double)s->points[2 * first + 1]);
        scene_end(s, i % SCENE_ROWS);
    }
}

/* Turns of every whole degree, with long and short neighbours; reversals; zigzags shorter than their width. */
static inline void scene_turns(scene *s, uint64_t *seed) {
    for (int degree = -180; degree <= 180; degree++) {
        const double angle = degree * SCENE_PI / 180, base = random_between(seed, -SCENE_PI, SCENE_PI);
        const double in = pow(10, random_between(seed, -2, 2.5)), out = pow(10, random_between(seed, -2, 2.5));
        scene_point(s, 500 - in * cos(base), 500 - in * sin(base));
        scene_point(s, 500, 500);
        scene_point(s, 500 + out * cos(base + angle), 500 + out * sin(base + angle));
        scene_end(s, random_below(seed, SCENE_ROWS));
    }
    for (size_t row = 0; row < SCENE_ROWS; row++) {
        for (int i = 0; i < 300; i++) /* there and back on the axes: exact reversals */
            scene_point(s, i % 2 ? 10 : 30, 40);
        scene_end(s, row);
        for (int i = 0; i < 100; i++)
            scene_point(s, 0.5 * i, i % 2 ? 0.7 : 0);
        scene_end(s, row);
        for (int i = 0; i < 50; i++) /* straight */
            scene_point(s, 3 * i, 3 * i);
        scene_end(s, row);
    }
}

/* Dots, empty polylines, repeated and invalid points, rings of two segments. */
static inline void scene_degenerate(scene *s, uint64_t *seed) {
    for (size_t i = 0; i < 400; i++) {
        const size_t count = random_below(seed, 8);
        for (size_t k = 0; k < count; k++) {
            const size_t kind = random_below(seed, 12);
            scene_point(s,
                        kind == 0   ? (double)NAN
                        : kind == 1 ? (double)INFINITY
                                    : (double)random_below(seed, 3),
                        kind == 2 ? 2e9 : (double)random_below(seed, 3));
        }
        scene_end(s, i % SCENE_ROWS);
    }
}

static inline void scene_sizes(scene *s, uint64_t *seed) {
    for (int exponent = -45; exponent <= 9; exponent++) { /* floats from the least to the farthest that is kept */
        const double size = pow(10, exponent);
        for (int repeat = 0; repeat < 4; repeat++) {
            for (int k = 0; k < 12; k++)
                scene_point(s, random_between(seed, -size, size), random_between(seed, -size, size));
            scene_end(s, random_below(seed, SCENE_ROWS));
        }
    }
}

typedef void scene_builder(scene *s, uint64_t *seed);
static scene_builder *const SCENE_BUILDERS[] = {scene_walks, scene_blocks,     scene_rings,
                                                scene_turns, scene_degenerate, scene_sizes};
enum { SCENE_COUNT = 6 };

static inline scene scene_make(size_t which) {
    scene s = {0};
    uint64_t seed = 1000 + which;
    SCENE_BUILDERS[which](&s, &seed);
    return s;
}

#endif
