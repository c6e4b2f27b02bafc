#include "peers/peer.h"

const bench_peer *const bench_peers[] = {
#ifdef CAMBER_BENCH_CAIRO
    &bench_peer_cairo,
    &bench_peer_cairo_path,
    &bench_peer_cairo_stripes,
    &bench_peer_cairo_stripes_path,
#endif
#ifdef CAMBER_BENCH_AGG
    &bench_peer_agg,
    &bench_peer_agg_path,
    &bench_peer_agg_stripes,
    &bench_peer_agg_stripes_path,
#endif
#ifdef CAMBER_BENCH_MAPNIK
    &bench_peer_mapnik,
    &bench_peer_mapnik_stripes,
#endif
#ifdef CAMBER_BENCH_BLEND2D
    &bench_peer_blend2d,
    &bench_peer_blend2d_path,
    &bench_peer_blend2d_threads,
    &bench_peer_blend2d_threads_path,
    &bench_peer_blend2d_stripes,
    &bench_peer_blend2d_stripes_path,
    &bench_peer_blend2d_stripes_kept,
#endif
#ifdef CAMBER_BENCH_THORVG
    &bench_peer_thorvg,
    &bench_peer_thorvg_threads,
#endif
    NULL,
};

const size_t bench_peer_count = sizeof bench_peers / sizeof *bench_peers - 1;

const char *const bench_peers_missing = ""
#ifndef CAMBER_BENCH_CAIRO
                                        "Cairo (libcairo2-dev) "
#endif
#ifndef CAMBER_BENCH_AGG
                                        "AGG (libagg-dev) "
#endif
#ifndef CAMBER_BENCH_MAPNIK
                                        "Mapnik (libmapnik-dev) "
#endif
#ifndef CAMBER_BENCH_BLEND2D
                                        "Blend2D (no Debian package: blend2d_DIR) "
#endif
#ifndef CAMBER_BENCH_THORVG
                                        "ThorVG (no Debian package: CMAKE_PREFIX_PATH) "
#endif
    ;
