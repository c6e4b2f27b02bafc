/* A renderer that a user could pick instead: it draws the same polylines, black on white, with round joins and butt
 * caps, each polyline open, to a picture in memory on the CPU. C and C++ read this. */
#ifndef CAMBER_BENCH_PEERS_PEER_H
#define CAMBER_BENCH_PEERS_PEER_H

#include "camber_files.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { BENCH_SIDE_PX = 2048 };

typedef struct bench_peer {
    const char *key;  /* "cairo_path", in the JSON; what comes before _ names the library */
    const char *name; /* "Cairo, one path" */
    const char *(*version)(void);
    /* Draws lines, in pixels, to rgba: BENCH_SIDE_PX rows of as many pixels of four bytes whose first three are equal.
     * Gives the milliseconds from the library's own form of the lines in memory to the picture in memory; below 0
     * where it failed. */
    double (*draw)(const camber_lines *lines, float width_px, uint8_t *rgba);
} bench_peer;

/* bench_peer_count of them, those that are built in. */
extern const bench_peer *const bench_peers[];
extern const size_t bench_peer_count;
/* "Mapnik (libmapnik-dev), ...": what is not built in. "": nothing is missing. */
extern const char *const bench_peers_missing;

extern const bench_peer bench_peer_cairo, bench_peer_cairo_path, bench_peer_agg, bench_peer_agg_path, bench_peer_mapnik,
    bench_peer_blend2d, bench_peer_blend2d_path, bench_peer_blend2d_threads;

#ifdef __cplusplus
}
#endif

#endif
