#define _XOPEN_SOURCE 700 /* M_PI */

#include "validate/scenes.h"

#include <math.h>
#include <stdlib.h>

/* ---- Building ---- */

/* xorshift64*: S. Vigna, "An experimental exploration of Marsaglia's xorshift generators, scrambled". */
static double uniform(camber_made_scene *scene, double least, double most) {
    scene->random ^= scene->random >> 12;
    scene->random ^= scene->random << 25;
    scene->random ^= scene->random >> 27;
    const uint64_t bits = scene->random * 2685821657736338717ull;
    return least + (most - least) * (double)(bits >> 11) * 0x1p-53;
}

static void add_point(camber_made_scene *scene, double x, double y) {
    if (scene->point_count == scene->point_capacity && !scene->failed) {
        const size_t capacity = scene->point_capacity ? scene->point_capacity * 2 : 1024;
        float *grown = realloc(scene->points, capacity * 2 * sizeof *grown);
        if (!grown) {
            scene->failed = true;
            return;
        }
        scene->points = grown;
        scene->point_capacity = capacity;
    }
    if (scene->failed)
        return;
    scene->points[scene->point_count * 2] = (float)x;
    scene->points[scene->point_count * 2 + 1] = (float)y;
    scene->point_count++;
}

/* The points since the last polyline's end become one. */
static void end_polyline(camber_made_scene *scene) {
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
    scene->rows[scene->polyline_count] = (uint32_t)(scene->polyline_count % CAMBER_SCENE_ROWS);
    scene->offsets[++scene->polyline_count] = (uint32_t)scene->point_count;
}

/* count points from x, y in steps of least to most px; each turns by up to turn radians. */
static void walk(camber_made_scene *scene, size_t count, const double step[2], double turn) {
    double x = uniform(scene, 0, 1000), y = uniform(scene, 0, 1000);
    double direction = uniform(scene, -M_PI, M_PI);
    for (size_t i = 0; i < count; i++) {
        add_point(scene, x, y);
        const double length = uniform(scene, step[0], step[1]);
        direction += uniform(scene, -turn, turn);
        x += length * cos(direction);
        y += length * sin(direction);
    }
}

/* ---- Scenes ---- */

static void random_walks(camber_made_scene *scene) {
    for (size_t i = 0; i < 120; i++) {
        walk(scene, 2 + i % 50, (const double[]){0.5, 40}, M_PI);
        end_polyline(scene);
    }
}

static void roads(camber_made_scene *scene) {
    for (size_t i = 0; i < 120; i++) {
        walk(scene, 2 + i % 80, (const double[]){1, 12}, 0.5);
        end_polyline(scene);
    }
}

static void short_segments(camber_made_scene *scene) {
    for (size_t i = 0; i < 80; i++) {
        walk(scene, 40, (const double[]){1e-4, 0.5}, i % 2 ? M_PI : 0.3);
        end_polyline(scene);
    }
}

/* The middle of a cell of a grid of columns x columns over the picture. */
static void cell(size_t number, size_t columns, double *x, double *y) {
    const double step = (double)CAMBER_SCENE_SIDE_PX / (double)columns;
    *x = ((double)(number % columns) + 0.5) * step;
    *y = ((double)(number / columns % columns) + 0.5) * step;
}

/* Hairpins: every turn from 0 to 180 degrees by a quarter of one, to the left and to the right, with arms of 1 to
 * 60 px. */
static void turns(camber_made_scene *scene) {
    for (int i = -720; i <= 720; i++) {
        const double angle = i * 0.25 * M_PI / 180, arm = 1 + (i + 720) % 60, start = i;
        double x, y;
        cell((size_t)(i + 720), 38, &x, &y);
        add_point(scene, x - arm * cos(start), y - arm * sin(start));
        add_point(scene, x, y);
        add_point(scene, x + arm * cos(start + angle), y + arm * sin(start + angle));
        end_polyline(scene);
    }
}

static void reversals(camber_made_scene *scene) {
    for (size_t i = 0; i < 60; i++) {
        const double x = uniform(scene, 0, 500), y = uniform(scene, 0, 500);
        const double dx = uniform(scene, -50, 50), dy = i % 3 ? uniform(scene, -50, 50) : 0;
        for (size_t k = 0; k < 2 + i % 7; k++) /* there and back, on the same points */
            add_point(scene, x + (k % 2 ? dx : 0), y + (k % 2 ? dy : 0));
        add_point(scene, x + dx / 2, y + dy / 2);
        end_polyline(scene);
        for (size_t k = 0; k < 8; k++) /* U-turns, a step to the side at each end */
            add_point(scene, k % 4 == 1 || k % 4 == 2 ? 80 : 0, y + (double)(k / 2) * 0.01 * (double)(i + 1));
        end_polyline(scene);
    }
}

static void rings(camber_made_scene *scene) {
    for (size_t sides = 1; sides <= 40; sides++)
        for (size_t copies = 0; copies < 3; copies++) {
            const double radius = copies == 1 ? 0.4 : 5 + (double)sides;
            double middle_x, middle_y, x = 0, y = 0;
            cell(scene->polyline_count, 11, &middle_x, &middle_y);
            for (size_t i = 0; i < sides; i++) {
                x = middle_x + radius * cos(2 * M_PI * (double)i / (double)sides);
                y = middle_y + radius * sin(2 * M_PI * (double)i / (double)sides);
                add_point(scene, x, y);
            }
            for (size_t i = 0; i < copies; i++)
                add_point(scene, x, y); /* repeated before the seam */
            add_point(scene, middle_x + radius, middle_y);
            end_polyline(scene);
        }
}

static void repeated_points(camber_made_scene *scene) {
    for (size_t i = 0; i < 80; i++) {
        end_polyline(scene); /* without a point */
        const double x = uniform(scene, 0, 500), y = uniform(scene, 0, 500);
        for (size_t k = 0; k <= i % 4; k++)
            add_point(scene, x, y); /* a dot */
        end_polyline(scene);
        for (size_t k = 0; k < 20; k++)
            for (size_t copy = 0; copy <= (i + k) % 5; copy++)
                add_point(scene, x + (double)(k * (k % 3)), y + (double)k);
        end_polyline(scene);
    }
}

static void invalid_points(camber_made_scene *scene) {
    const double bad[] = {NAN, INFINITY, -INFINITY, 1e30, -1e12, 2e9};
    for (size_t i = 0; i < 120; i++) {
        for (size_t k = 0; k < i % 13; k++) {
            const double x = uniform(scene, 0, 500), y = uniform(scene, 0, 500);
            const bool spoil = uniform(scene, 0, 1) < 0.3;
            add_point(scene, spoil && k % 2 ? bad[(i + k) % 6] : x, spoil && k % 2 == 0 ? bad[(i + k) % 6] : y);
        }
        end_polyline(scene);
    }
}

/* Steps of coordinates far from 0 and close to it, where floats are coarse and where products underflow. */
static void extreme_coordinates(camber_made_scene *scene) {
    const double scales[] = {1e-30, 1e-19, 1e-10, 1e-3, 1e4, 1e6, 1e8, 9.9e8};
    for (size_t i = 0; i < 160; i++) {
        const double scale = scales[i % 8];
        for (size_t k = 0; k < 3 + i % 10; k++)
            add_point(scene, uniform(scene, -scale, scale), uniform(scene, i % 3 ? -scale : scale * 0.999, scale));
        end_polyline(scene);
    }
}

static void grid(camber_made_scene *scene) {
    for (size_t i = 0; i < 40; i++) {
        double x, y;
        cell(i, 7, &x, &y);
        x = floor(x);
        y = floor(y);
        for (size_t k = 0; k < 30; k++) /* stairs: right angles, and straight on at every third */
            add_point(scene, x + (double)((k + 1) / 2 * 8) - 60, y + (double)(k / 2 * 8 + (k % 3 ? 0 : i)) - 60);
        end_polyline(scene);
        for (size_t k = 0; k < 30; k++)
            add_point(scene, x + (double)k * 0.1 * (double)(i + 1), y + (double)i);
        end_polyline(scene);
    }
}

/* Pairs of lines of one width, edge to edge or one on the other, at every angle: what united layers are for. */
static void side_by_side(camber_made_scene *scene) {
    for (size_t i = 0; i < 49; i++) {
        const double angle = uniform(scene, 0, M_PI), dx = 50 * cos(angle), dy = 50 * sin(angle);
        double x, y;
        cell(i, 7, &x, &y);
        x += uniform(scene, -2, 2);
        for (size_t line = 0; line < 2; line++) {
            const double aside = line && i % 2 ? CAMBER_SCENE_WIDTH_PX / 50.0 : 0;
            for (int k = -1; k <= 1; k++)
                add_point(scene, x + k * dx - aside * dy, y + k * dy + aside * dx);
            end_polyline(scene);
            if (!scene->failed)
                scene->rows[scene->polyline_count - 1] = CAMBER_SCENE_WIDTH_ROW;
        }
    }
}

/* Rings whose joins all have room, and the seam with them: no pixel is drawn twice. */
static void smooth_rings(camber_made_scene *scene) {
    for (size_t i = 0; i < 121; i++) {
        const size_t sides = 12 + i % 24;
        const double start = uniform(scene, 0, 2 * M_PI);
        double x, y;
        cell(i, 11, &x, &y);
        const double radius = uniform(scene, 25, 40), first = (double)scene->point_count;
        x += uniform(scene, -2, 2);
        for (size_t k = 0; k < sides; k++)
            add_point(scene, x + radius * cos(start + 2 * M_PI * (double)k / (double)sides),
                      y + radius * sin(start + 2 * M_PI * (double)k / (double)sides));
        if (!scene->failed)
            add_point(scene, (double)scene->points[2 * (size_t)first], (double)scene->points[2 * (size_t)first + 1]);
        end_polyline(scene);
        if (!scene->failed)
            scene->rows[scene->polyline_count - 1] = CAMBER_SCENE_WIDTH_ROW;
    }
}

/* Longer than a work-group's and a scan's block, so that their borders lie within one line. */
static void one_long_line(camber_made_scene *scene) {
    walk(scene, 20011, (const double[]){0.2, 9}, 1.2);
    end_polyline(scene);
}

static const struct {
    const char *name;
    void (*make)(camber_made_scene *scene);
} makers[] = {
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

size_t camber_builtin_count(void) {
    return sizeof makers / sizeof *makers;
}

bool camber_builtin_make(size_t number, camber_made_scene *scene) {
    *scene = (camber_made_scene){.name = makers[number].name, .random = 0x9e3779b97f4a7c15ull + number};
    makers[number].make(scene);
    return !scene->failed;
}

void camber_builtin_free(camber_made_scene *scene) {
    free(scene->points);
    free(scene->offsets);
    free(scene->rows);
    *scene = (camber_made_scene){0};
}
