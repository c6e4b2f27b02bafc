/* A renderer that a user could pick instead: it draws the same polylines, black on white, with round joins and butt
 * caps, each polyline open, to a picture in memory on the CPU. Or it fills the same areas, by the non-zero rule. C and
 * C++ read this. */
#ifndef CAMBER_BENCH_PEERS_PEER_H
#define CAMBER_BENCH_PEERS_PEER_H

#include "camber_files.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { BENCH_SIDE_PX = 2048 };

typedef struct bench_peer_frame {
    const camber_lines *lines; /* in pixels */
    float width_px;
    /* Area i has the polylines [areas[i], areas[i + 1]), rings whose last point is the first: outer ones wind one way,
     * holes the other. NULL: lines are stroked. */
    const uint32_t *areas;
    size_t area_count;
    bool avx2_only; /* a peer that makes its code at run time makes none that needs more than AVX2 */
    uint8_t *rgba;  /* BENCH_SIDE_PX rows of as many pixels of four bytes, whose first three will be equal */
} bench_peer_frame;

typedef struct bench_peer {
    const char *key;  /* "cairo_path", in the JSON; what comes before _ names the library */
    const char *name; /* "Cairo"; its ways to draw have one name */
    const char *way;  /* "two threads, one path": what tells this way from the library's others; "": it has one */
    const char *(*version)(void);
    /* "gcc 12.2.0 -O2": what the library was compiled with, as far as the library tells. */
    const char *(*build)(void);
    /* Gives the milliseconds from the library's own form of the lines in memory to the picture in memory; below 0
     * where it failed. */
    double (*draw)(const bench_peer_frame *frame);
} bench_peer;

/* bench_peer_count of them, those that are built in. */
extern const bench_peer *const bench_peers[];
extern const size_t bench_peer_count;
/* "Mapnik (libmapnik-dev), ...": what is not built in. "": nothing is missing. */
extern const char *const bench_peers_missing;

/* Whether the lines are those of another frame, from which something has been kept. */
static inline bool bench_peer_is_same(const bench_peer_frame *a, const bench_peer_frame *b) {
    return a->lines && a->lines->points == b->lines->points && a->lines->point_count == b->lines->point_count &&
           a->areas == b->areas && a->width_px == b->width_px;
}

/* Parts are drawn one after the other, unless everything is one path: lines, or areas with their holes. */
static inline size_t bench_peer_part_count(const bench_peer_frame *frame) {
    return frame->areas ? frame->area_count : frame->lines->polyline_count;
}

static inline size_t bench_peer_first_of(const bench_peer_frame *frame, size_t part) {
    return frame->areas ? frame->areas[part] : part;
}

/* ---- stripes.c: the benchmark's own threads, for libraries that have none, or whose own do worse ---- */

/* Draws a part of a picture. false: that failed. */
typedef bool bench_stripe_fn(void *user, size_t part);

/* A stripe per core that the process may use. */
size_t bench_stripe_count(void);
/* BENCH_SIDE_PX of the part after the last one. */
int bench_stripe_first_row(size_t part);
/* Each thread, of which the caller is the first, draws a stripe. The others are kept from call to call. Gives the
 * milliseconds until all have ended; below 0: one has failed. */
double bench_stripes_draw(bench_stripe_fn *draw, void *user);

extern const bench_peer bench_peer_cairo, bench_peer_cairo_path, bench_peer_cairo_stripes,
    bench_peer_cairo_stripes_path, bench_peer_agg, bench_peer_agg_path, bench_peer_agg_stripes,
    bench_peer_agg_stripes_path, bench_peer_mapnik, bench_peer_mapnik_stripes, bench_peer_blend2d,
    bench_peer_blend2d_path, bench_peer_blend2d_threads, bench_peer_blend2d_threads_path, bench_peer_blend2d_stripes,
    bench_peer_blend2d_stripes_path, bench_peer_blend2d_stripes_kept, bench_peer_thorvg, bench_peer_thorvg_threads;

#ifdef __cplusplus
}
#endif

#endif
