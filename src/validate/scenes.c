/* Functions for building scenes come first, then the scenes of each user. Points are floats in the order in which they
 * are made, from seeds in this file. Changing either changes golden pictures, bounds and published figures. */
#define _XOPEN_SOURCE 700 /* M_PI */

#include "validate/scenes.h"

#include "validate/random.h"

#include <math.h>
#include <stdlib.h>

/* ---- Building ---- */

void camber_made_scene_point(camber_made_scene *scene, double x, double y) {
    if (scene->point_count == scene->point_capacity && !scene->failed) {
        const size_t capacity = scene->point_capacity ? scene->point_capacity * 2 : 1024;
        float *grown = realloc(scene->points, capacity * 2 * sizeof *grown);
        scene->failed = !grown;
        scene->points = grown ? grown : scene->points;
        scene->point_capacity = grown ? capacity : scene->point_capacity;
    }
    if (scene->failed)
        return;
    scene->points[scene->point_count * 2] = (float)x;
    scene->points[scene->point_count * 2 + 1] = (float)y;
    scene->point_count++;
}

void camber_made_scene_end(camber_made_scene *scene, size_t row) {
    if (scene->polyline_count + 2 > scene->polyline_capacity && !scene->failed) {
        const size_t capacity = scene->polyline_capacity ? scene->polyline_capacity * 2 : 256;
        uint32_t *offsets = realloc(scene->offsets, capacity * sizeof *offsets);
        scene->offsets = offsets ? offsets : scene->offsets;
        uint32_t *rows = realloc(scene->rows, capacity * sizeof *rows);
        scene->rows = rows ? rows : scene->rows;
        scene->failed = !offsets || !rows;
        scene->polyline_capacity = scene->failed ? scene->polyline_capacity : capacity;
    }
    if (scene->failed)
        return;
    scene->offsets[0] = 0;
    scene->rows[scene->polyline_count] = (uint32_t)row;
    scene->offsets[++scene->polyline_count] = (uint32_t)scene->point_count;
}

void camber_made_scene_walk(camber_made_scene *scene, uint64_t *seed, size_t count, const double step[2], double turn) {
    double x = camber_random_between(seed, 0, 1000), y = camber_random_between(seed, 0, 1000);
    double direction = camber_random_between(seed, -M_PI, M_PI);
    for (size_t i = 0; i < count; i++) {
        camber_made_scene_point(scene, x, y);
        const double length = camber_random_between(seed, step[0], step[1]);
        direction += camber_random_between(seed, -turn, turn);
        x += length * cos(direction);
        y += length * sin(direction);
    }
}

camber_polylines_desc camber_made_scene_polylines(const camber_made_scene *scene) {
    return (camber_polylines_desc){.points = scene->points,
                                   .point_count = scene->point_count,
                                   .offsets = scene->offsets,
                                   .polyline_count = scene->polyline_count,
                                   .rows = scene->rows};
}

void camber_made_scene_free(camber_made_scene *scene) {
    free(scene->points);
    free(scene->offsets);
    free(scene->rows);
    *scene = (camber_made_scene){0};
}

/* ---- Checked scenes ---- */

static void end_line(camber_made_scene *scene) {
    camber_made_scene_end(scene, scene->polyline_count % CAMBER_SCENE_ROWS);
}

static void random_walks(camber_made_scene *scene, uint64_t *seed) {
    for (size_t i = 0; i < 120; i++) {
        camber_made_scene_walk(scene, seed, 2 + i % 50, (const double[]){0.5, 40}, M_PI);
        end_line(scene);
    }
}

static void roads(camber_made_scene *scene, uint64_t *seed) {
    for (size_t i = 0; i < 120; i++) {
        camber_made_scene_walk(scene, seed, 2 + i % 80, (const double[]){1, 12}, 0.5);
        end_line(scene);
    }
}

static void short_segments(camber_made_scene *scene, uint64_t *seed) {
    for (size_t i = 0; i < 80; i++) {
        camber_made_scene_walk(scene, seed, 40, (const double[]){1e-4, 0.5}, i % 2 ? M_PI : 0.3);
        end_line(scene);
    }
}

/* Finds the middle of a cell in a grid of columns x columns over the picture. */
static void cell(size_t number, size_t columns, double *x, double *y) {
    const double step = (double)CAMBER_SCENE_SIDE_PX / (double)columns;
    *x = ((double)(number % columns) + 0.5) * step;
    *y = ((double)(number / columns % columns) + 0.5) * step;
}

/* Hairpins: every turn from 0 to 180 degrees in quarter degrees, to the left and to the right, with arms of 1 to 60
 * px. */
static void turns(camber_made_scene *scene, uint64_t *seed) {
    (void)seed;
    for (int i = -720; i <= 720; i++) {
        const double angle = i * 0.25 * M_PI / 180, arm = 1 + (i + 720) % 60, start = i;
        double x, y;
        cell((size_t)(i + 720), 38, &x, &y);
        camber_made_scene_point(scene, x - arm * cos(start), y - arm * sin(start));
        camber_made_scene_point(scene, x, y);
        camber_made_scene_point(scene, x + arm * cos(start + angle), y + arm * sin(start + angle));
        end_line(scene);
    }
}

static void reversals(camber_made_scene *scene, uint64_t *seed) {
    for (size_t i = 0; i < 60; i++) {
        const double x = camber_random_between(seed, 0, 500), y = camber_random_between(seed, 0, 500);
        const double dx = camber_random_between(seed, -50, 50), dy = i % 3 ? camber_random_between(seed, -50, 50) : 0;
        for (size_t k = 0; k < 2 + i % 7; k++) /* there and back, on the same points */
            camber_made_scene_point(scene, x + (k % 2 ? dx : 0), y + (k % 2 ? dy : 0));
        camber_made_scene_point(scene, x + dx / 2, y + dy / 2);
        end_line(scene);
        for (size_t k = 0; k < 8; k++) /* U-turns, with a step to the side at each end */
            camber_made_scene_point(scene, k % 4 == 1 || k % 4 == 2 ? 80 : 0,
                                    y + (double)(k / 2) * 0.01 * (double)(i + 1));
        end_line(scene);
    }
}

static void rings(camber_made_scene *scene, uint64_t *seed) {
    (void)seed;
    for (size_t sides = 1; sides <= 40; sides++)
        for (size_t copies = 0; copies < 3; copies++) {
            const double radius = copies == 1 ? 0.4 : 5 + (double)sides;
            double middle_x, middle_y, x = 0, y = 0;
            cell(scene->polyline_count, 11, &middle_x, &middle_y);
            for (size_t i = 0; i < sides; i++) {
                x = middle_x + radius * cos(2 * M_PI * (double)i / (double)sides);
                y = middle_y + radius * sin(2 * M_PI * (double)i / (double)sides);
                camber_made_scene_point(scene, x, y);
            }
            for (size_t i = 0; i < copies; i++)
                camber_made_scene_point(scene, x, y); /* repeated before the seam */
            camber_made_scene_point(scene, middle_x + radius, middle_y);
            end_line(scene);
        }
}

static void repeated_points(camber_made_scene *scene, uint64_t *seed) {
    for (size_t i = 0; i < 80; i++) {
        end_line(scene); /* without a point */
        const double x = camber_random_between(seed, 0, 500), y = camber_random_between(seed, 0, 500);
        for (size_t k = 0; k <= i % 4; k++)
            camber_made_scene_point(scene, x, y); /* a dot */
        end_line(scene);
        for (size_t k = 0; k < 20; k++)
            for (size_t copy = 0; copy <= (i + k) % 5; copy++)
                camber_made_scene_point(scene, x + (double)(k * (k % 3)), y + (double)k);
        end_line(scene);
    }
}

static void invalid_points(camber_made_scene *scene, uint64_t *seed) {
    const double bad[] = {NAN, INFINITY, -INFINITY, 1e30, -1e12, 2e9};
    for (size_t i = 0; i < 120; i++) {
        for (size_t k = 0; k < i % 13; k++) {
            const double x = camber_random_between(seed, 0, 500), y = camber_random_between(seed, 0, 500);
            const bool spoil = camber_random_between(seed, 0, 1) < 0.3;
            camber_made_scene_point(scene, spoil && k % 2 ? bad[(i + k) % 6] : x,
                                    spoil && k % 2 == 0 ? bad[(i + k) % 6] : y);
        }
        end_line(scene);
    }
}

/* Each statement draws only one random number, because compilers evaluate arguments in different orders. */

/* Steps between coordinates far from 0, where floats are coarse, and close to 0, where products underflow. */
static void extreme_coordinates(camber_made_scene *scene, uint64_t *seed) {
    const double scales[] = {1e-30, 1e-19, 1e-10, 1e-3, 1e4, 1e6, 1e8, 9.9e8};
    for (size_t i = 0; i < 160; i++) {
        const double scale = scales[i % 8];
        for (size_t k = 0; k < 3 + i % 10; k++) {
            const double y = camber_random_between(seed, i % 3 ? -scale : scale * 0.999, scale);
            camber_made_scene_point(scene, camber_random_between(seed, -scale, scale), y);
        }
        end_line(scene);
    }
}

static void grid(camber_made_scene *scene, uint64_t *seed) {
    (void)seed;
    for (size_t i = 0; i < 40; i++) {
        double x, y;
        cell(i, 7, &x, &y);
        x = floor(x);
        y = floor(y);
        for (size_t k = 0; k < 30; k++) /* stairs: right angles, with every third point straight on */
            camber_made_scene_point(scene, x + (double)((k + 1) / 2 * 8) - 60,
                                    y + (double)(k / 2 * 8 + (k % 3 ? 0 : i)) - 60);
        end_line(scene);
        for (size_t k = 0; k < 30; k++)
            camber_made_scene_point(scene, x + (double)k * 0.1 * (double)(i + 1), y + (double)i);
        end_line(scene);
    }
}

/* Pairs of lines with the same width, edge to edge or one on the other, at every angle. United layers are made for
 * these. */
static void side_by_side(camber_made_scene *scene, uint64_t *seed) {
    for (size_t i = 0; i < 49; i++) {
        const double angle = camber_random_between(seed, 0, M_PI), dx = 50 * cos(angle), dy = 50 * sin(angle);
        double x, y;
        cell(i, 7, &x, &y);
        x += camber_random_between(seed, -2, 2);
        for (size_t line = 0; line < 2; line++) {
            const double aside = line && i % 2 ? CAMBER_SCENE_WIDTH_PX / 50.0 : 0;
            for (int k = -1; k <= 1; k++)
                camber_made_scene_point(scene, x + k * dx - aside * dy, y + k * dy + aside * dx);
            end_line(scene);
            if (!scene->failed)
                scene->rows[scene->polyline_count - 1] = CAMBER_SCENE_WIDTH_ROW;
        }
    }
}

/* Rings whose joins, including the seam, all have room: no pixel is drawn twice. */
static void smooth_rings(camber_made_scene *scene, uint64_t *seed) {
    for (size_t i = 0; i < 121; i++) {
        const size_t sides = 12 + i % 24;
        const double start = camber_random_between(seed, 0, 2 * M_PI);
        double x, y;
        cell(i, 11, &x, &y);
        const double radius = camber_random_between(seed, 25, 40), first = (double)scene->point_count;
        x += camber_random_between(seed, -2, 2);
        for (size_t k = 0; k < sides; k++)
            camber_made_scene_point(scene, x + radius * cos(start + 2 * M_PI * (double)k / (double)sides),
                                    y + radius * sin(start + 2 * M_PI * (double)k / (double)sides));
        if (!scene->failed)
            camber_made_scene_point(scene, (double)scene->points[2 * (size_t)first],
                                    (double)scene->points[2 * (size_t)first + 1]);
        end_line(scene);
        if (!scene->failed)
            scene->rows[scene->polyline_count - 1] = CAMBER_SCENE_WIDTH_ROW;
    }
}

/* A line that is longer than a block of a work-group and than a block of scan, so that the borders of blocks are inside
 * the line. */
static void one_long_line(camber_made_scene *scene, uint64_t *seed) {
    camber_made_scene_walk(scene, seed, 20011, (const double[]){0.2, 9}, 1.2);
    end_line(scene);
}

static const struct {
    const char *name;
    camber_scene_builder *add;
} checked[] = {
    {"random walks", random_walks},
    {"roads", roads},
    {"short segments", short_segments},
    {"turns", turns},
    {"reversals", reversals},
    {"rings", rings},
    {"repeated points", repeated_points},
    {"invalid points", invalid_points},
    {"extreme coordinates", extreme_coordinates},
    {"grid", grid},
    {"side by side", side_by_side},
    {CAMBER_SCENE_DRAWN_ONCE, smooth_rings},
    {"one long line", one_long_line},
};

size_t camber_checked_scene_count(void) {
    return sizeof checked / sizeof *checked;
}

bool camber_checked_scene_make(size_t number, camber_made_scene *scene) {
    uint64_t seed = 0x9e3779b97f4a7c15ull + number;
    *scene = (camber_made_scene){.name = checked[number].name};
    checked[number].add(scene, &seed);
    return !scene->failed;
}

/* ---- Kernel scenes ---- */

void camber_scene_add_walks(camber_made_scene *s, uint64_t *seed) {
    for (size_t i = 0; i < 300; i++) {
        camber_made_scene_walk(s, seed, camber_random_below(seed, 40), (const double[]){0.1, 60}, i % 2 ? 0.6 : M_PI);
        camber_made_scene_end(s, i % CAMBER_KERNEL_ROWS);
    }
}

void camber_scene_add_blocks(camber_made_scene *s, uint64_t *seed) {
    static const size_t counts[] = {256, 255, 257, 1, 511, 1, 1, 254, 513, 5000, 2, 128, 128, 300};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        camber_made_scene_walk(s, seed, counts[i], (const double[]){1, 30}, 2.5);
        camber_made_scene_end(s, i % CAMBER_KERNEL_ROWS);
    }
}

void camber_scene_add_rings(camber_made_scene *s, uint64_t *seed) {
    for (size_t i = 0; i < 120; i++) {
        const size_t sides = 2 + camber_random_below(seed, 30);
        const double x = camber_random_between(seed, 0, 1000), y = camber_random_between(seed, 0, 1000);
        const double radius = camber_random_between(seed, 0.1, 100), turns = (double)(1 + camber_random_below(seed, 3));
        const size_t first = s->point_count;
        for (size_t k = 0; k < sides; k++) {
            const double angle = 2 * M_PI * turns * (double)k / (double)sides * (i % 2 ? 1 : -1);
            camber_made_scene_point(s, x + radius * cos(angle), y + radius * sin(angle));
        }
        camber_made_scene_point(s, (double)s->points[2 * first], (double)s->points[2 * first + 1]);
        camber_made_scene_end(s, i % CAMBER_KERNEL_ROWS);
    }
}

void camber_scene_add_turns(camber_made_scene *s, uint64_t *seed) {
    for (int degree = -180; degree <= 180; degree++) {
        const double angle = degree * M_PI / 180, base = camber_random_between(seed, -M_PI, M_PI);
        const double in = pow(10, camber_random_between(seed, -2, 2.5)),
                     out = pow(10, camber_random_between(seed, -2, 2.5));
        camber_made_scene_point(s, 500 - in * cos(base), 500 - in * sin(base));
        camber_made_scene_point(s, 500, 500);
        camber_made_scene_point(s, 500 + out * cos(base + angle), 500 + out * sin(base + angle));
        camber_made_scene_end(s, camber_random_below(seed, CAMBER_KERNEL_ROWS));
    }
    for (size_t row = 0; row < CAMBER_KERNEL_ROWS; row++) {
        for (int i = 0; i < 300; i++) /* there and back on the axes: exact reversals */
            camber_made_scene_point(s, i % 2 ? 10 : 30, 40);
        camber_made_scene_end(s, row);
        for (int i = 0; i < 100; i++)
            camber_made_scene_point(s, 0.5 * i, i % 2 ? 0.7 : 0);
        camber_made_scene_end(s, row);
        for (int i = 0; i < 50; i++) /* straight lines */
            camber_made_scene_point(s, 3 * i, 3 * i);
        camber_made_scene_end(s, row);
    }
}

void camber_scene_add_degenerate(camber_made_scene *s, uint64_t *seed) {
    for (size_t i = 0; i < 400; i++) {
        const size_t count = camber_random_below(seed, 8);
        for (size_t k = 0; k < count; k++) {
            const size_t kind = camber_random_below(seed, 12);
            const double y = kind == 2 ? 2e9 : (double)camber_random_below(seed, 3);
            const double x = kind == 0   ? (double)NAN
                             : kind == 1 ? (double)INFINITY
                                         : (double)camber_random_below(seed, 3);
            camber_made_scene_point(s, x, y);
        }
        camber_made_scene_end(s, i % CAMBER_KERNEL_ROWS);
    }
}

void camber_scene_add_sizes(camber_made_scene *s, uint64_t *seed) {
    for (int exponent = -45; exponent <= 9; exponent++) { /* floats from the smallest to the largest that is kept */
        const double size = pow(10, exponent);
        for (int repeat = 0; repeat < 4; repeat++) {
            for (int k = 0; k < 12; k++) {
                const double y = camber_random_between(seed, -size, size);
                camber_made_scene_point(s, camber_random_between(seed, -size, size), y);
            }
            camber_made_scene_end(s, camber_random_below(seed, CAMBER_KERNEL_ROWS));
        }
    }
}

bool camber_kernel_scene_make(size_t number, camber_made_scene *scene) {
    static camber_scene_builder *const builders[CAMBER_KERNEL_SCENES] = {
        camber_scene_add_walks, camber_scene_add_blocks,     camber_scene_add_rings,
        camber_scene_add_turns, camber_scene_add_degenerate, camber_scene_add_sizes};
    uint64_t seed = 1000 + number;
    *scene = (camber_made_scene){0};
    builders[number](scene, &seed);
    return !scene->failed;
}

/* ---- A small scene ---- */

/* Lines that end before, at and after the borders of blocks of 64, 128 and 256 points, with cut, tight and split joins
 * there, and dots on both sides. */
static void add_small_blocks(camber_made_scene *s) {
    static const int counts[] = {63, 1, 1, 63, 64, 65, 62, 1, 192, 257, 255, 2, 126, 129};
    for (size_t line = 0; line < sizeof counts / sizeof *counts; line++) {
        for (int i = 0; i < counts[line]; i++)
            camber_made_scene_point(s, 3 * i + i % 7 * 5, 300 + 40.0 * (double)line + (i % 3 ? 2 * (i % 5) : 25));
        camber_made_scene_end(s, 0);
    }
}

/* Rings, stars with turns that are tight or exceed 127 degrees, dots, reversals, repeated points. */
static void add_small_shapes(camber_made_scene *s) {
    for (int ring = 0; ring < 12; ring++) {
        const int corners = 3 + ring % 7;
        for (int i = 0; i <= corners; i++) {
            const double angle = 6.283185307 * (i % corners) * (ring % 3 + 1) / corners;
            camber_made_scene_point(s, 100 + 11 * ring + (3 + ring) * cos(angle), 100 + (3 + ring) * sin(angle));
        }
        camber_made_scene_end(s, 0);
    }
    for (int line = 0; line < 60; line++) {
        for (int i = 0; i <= line % 7; i++)
            camber_made_scene_point(s, 7.0 * line + i * 13 % 5, 50 + i * i * 7 % 23);
        camber_made_scene_end(s, 0);
    }
    const double there_and_back[][2] = {{5, 5}, {25, 5}, {5, 5}, {5, 5}, {15, 5.001}};
    for (size_t i = 0; i < sizeof there_and_back / sizeof *there_and_back; i++)
        camber_made_scene_point(s, there_and_back[i][0], there_and_back[i][1]);
    camber_made_scene_end(s, 0);
}

bool camber_small_scene_make(camber_made_scene *scene) {
    *scene = (camber_made_scene){0};
    add_small_blocks(scene);
    add_small_shapes(scene);
    return !scene->failed;
}

/* ---- Benchmark ---- */

enum { ROAD_POINTS_MAX = 40 };

/* xorshift64 (Marsaglia 2003), from 0 to 1. Published figures use these walks, which another generator would change. */
static double uniform(uint64_t *state) {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) / 9007199254740992.0;
}

bool camber_road_walks_make(size_t polyline_count, double side_px, double step_px, camber_made_scene *scene) {
    uint64_t state = 88172645463325252ull;
    *scene = (camber_made_scene){0};
    for (size_t i = 0; i < polyline_count; i++) {
        size_t count = 2 + (size_t)(-log(1 - uniform(&state)) * 5);
        count = count < ROAD_POINTS_MAX ? count : ROAD_POINTS_MAX;
        double x = uniform(&state) * side_px;
        double y = uniform(&state) * side_px;
        double heading = uniform(&state) * 6.283;
        for (size_t k = 0; k < count; k++) {
            camber_made_scene_point(scene, x, y);
            const double length = step_px * (0.3 + 1.4 * uniform(&state));
            const double turn = uniform(&state) - 0.5;
            heading += turn * (uniform(&state) < 0.1 ? 4 : 0.8);
            x += cos(heading) * length;
            y += sin(heading) * length;
        }
        camber_made_scene_end(scene, 0);
    }
    return !scene->failed;
}
