/* Texts at points of a picture, with halos, as Mapnik draws them. C and C++ read this. */
#ifndef CAMBER_BENCH_PEERS_LABELS_H
#define CAMBER_BENCH_PEERS_LABELS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bench_label {
    const char *text; /* UTF-8 */
    double x, y;      /* its middle, px */
} bench_label;

typedef struct bench_labels {
    const bench_label *labels;
    size_t count;
    const char *font_file, *font; /* "Noto Sans Regular" */
    double size_px, halo_px;      /* black on white halos on grey */
} bench_labels;

/* Draws the labels by one thread, all of them, whether they overlap or not. Gives the milliseconds from Mapnik's own
 * form of them to the picture in memory; below 0 where it failed. */
double bench_mapnik_labels(const bench_labels *labels, uint8_t *rgba);

#ifdef __cplusplus
}
#endif

#endif
