/* A style's layers, with lines and areas of their own colours, as Mapnik draws them. C and C++ read this. */
#ifndef CAMBER_BENCH_PEERS_LAYERS_H
#define CAMBER_BENCH_PEERS_LAYERS_H

#include "camber_files.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bench_layer {
    const camber_lines *lines; /* of which it has the polylines [first, end), in pixels */
    size_t first, end;
    double shift_px; /* from where the picture lies among them to 0, 0 */
    bool area;       /* rings: those that run clockwise as seen each begin an area, and its holes follow */
    float width_px;
    camber_cap cap; /* joins are round */
    camber_color color;
    float opacity; /* of the whole layer */
} bench_layer;

/* Draws the layers by stripes. Gives the milliseconds from Mapnik's own form of them to the picture in memory; below
 * 0 where it failed. */
double bench_mapnik_layers(const bench_layer *layers, size_t count, camber_color background, uint8_t *rgba);

#ifdef __cplusplus
}
#endif

#endif
