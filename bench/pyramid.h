/* Pyramids of one set of lines, drawn by camber's tool and by its peers, each a process of its own. */
#ifndef CAMBER_BENCH_PYRAMID_H
#define CAMBER_BENCH_PYRAMID_H

#include "bench.h"

/* The lines, the zooms, and a folder that has all files. */
typedef struct bench_pyramid {
    char folder[64], city[1024], style[128];
    int min_zoom, max_zoom;
    bool labelled; /* areas below the lines and names above them are drawn, too */
    double box[4]; /* west, south, east, north of what is drawn, in degrees */
} bench_pyramid;

/* Makes the folder and camber's style of it. false: that cannot be done. */
bool bench_pyramid_open(bench_pyramid *pyramid);
/* Removes the folder. */
void bench_pyramid_close(const bench_pyramid *pyramid);

/* Runs camber tiles with what options say, which end with NULL, into FOLDER/NAME. Gives what it prints as JSON with
 * "wall_ms" of the whole process; NULL: it failed, which is printed. */
json_t *bench_pyramid_draw(const bench *b, const bench_pyramid *pyramid, const char *name, const char *const *options);
/* Runs a shell command in the folder. Gives its milliseconds; below 0: it failed. */
double bench_pyramid_shell(const bench_pyramid *pyramid, const char *command);

/* The same lines, areas, names, widths and colours in the peers' forms, by ogr2ogr. false: it is not here, or fails. */
bool bench_pyramid_write_maps(const bench_pyramid *pyramid);
/* These print a line of JSON, of npm's Mapnik (peers/mapnik_tiles.mjs) and of renderd, each after a run to warm up; of
 * Mapnik, medians of so many runs. NULL: not here. */
json_t *bench_pyramid_mapnik(const bench_pyramid *pyramid, const char *format, size_t runs);
json_t *bench_pyramid_renderd(const bench_pyramid *pyramid, const char *format);

#endif
