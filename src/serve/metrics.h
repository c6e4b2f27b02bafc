/* Counters of the server's work, for Prometheus. Any thread may count. */
#ifndef CAMBER_SERVE_METRICS_H
#define CAMBER_SERVE_METRICS_H

#include "serve/route.h"
#include "serve/tile_cache.h"

#include <stdio.h>

enum { CAMBER_HISTOGRAM_BUCKETS = 10, CAMBER_STATUS_KINDS = 14 };

/* A histogram of durations, in seconds. */
typedef struct camber_histogram {
    /* each counts only its own range; the last has no upper bound */
    _Atomic uint64_t buckets[CAMBER_HISTOGRAM_BUCKETS + 1];
    _Atomic uint64_t microseconds;
} camber_histogram;

/* Requests by route and status. */
typedef struct camber_request_counts {
    _Atomic uint64_t of[CAMBER_ROUTES][CAMBER_STATUS_KINDS];
} camber_request_counts;

/* A zeroed struct is valid, and means that nothing has been counted. */
typedef struct camber_metrics {
    camber_request_counts requests; /* those that concern no map with a name */
    /* dropped: no client waited for the picture any more; refused: the queue was full */
    _Atomic uint64_t sent_bytes, dropped, refused;
    camber_histogram draw, encode;
    _Atomic int64_t connections, queued; /* current values */
} camber_metrics;

/* A map that has a name. */
typedef struct camber_map_metrics {
    const char *name;
    bool ready;
    const camber_request_counts *requests;
} camber_map_metrics;

/* Values that are read when the metrics are requested. */
typedef struct camber_metrics_now {
    const camber_map_metrics *maps; /* map_count of them */
    uint32_t map_count;
    camber_tile_cache_stats cache;
    bool ready;
    int64_t in_flight; /* requests that have not been answered yet */
    double uptime_s;
} camber_metrics_now;

void camber_metrics_count_request(camber_request_counts *counts, camber_route route, int status);
void camber_histogram_observe(camber_histogram *histogram, double seconds);
/* Writes all metrics in Prometheus' text format. */
void camber_metrics_write(camber_metrics *metrics, const camber_metrics_now *now, FILE *file);

#endif
