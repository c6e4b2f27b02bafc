/* What the benchmark draws, and whom it draws it with. */
#ifndef CAMBER_BENCH_H
#define CAMBER_BENCH_H

#include "camber.h"

#include <stdbool.h>
#include <stddef.h>

enum { BENCH_SIDE_PX = 2048 };

/* Polylines in pixels of a BENCH_SIDE_PX square, as every renderer gets them. */
typedef struct bench_scene {
    char name[64];
    camber_lines lines;
    float width_px;
} bench_scene;

/* Random walks that turn like roads: seeded, the same on every machine. */
bool bench_scene_walks(camber_context *context, size_t polyline_count, double step_px, camber_lines *lines);
/* Roads of a map file, the middle 99 % of the points on each axis spanning the square. false: not there, or built
 * without maps. */
bool bench_scene_map(camber_context *context, const char *path, camber_lines *lines);

/* Milliseconds of one frame of Cairo: white, every polyline stroked by itself, black, round joins, butt caps,
 * tolerance 0.25 px. Below 0: not built in. */
double bench_cairo_ms(const bench_scene *scene);
/* "1.16.0", or NULL where it is not built in. */
const char *bench_cairo_version(void);

#endif
