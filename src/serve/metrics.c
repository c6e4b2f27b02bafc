/* Counters and histograms, and their text format. */
#include "serve/metrics.h"

#include <inttypes.h>
#include <stdlib.h>
#include <unistd.h>

/* Statuses that the server sends. The last kind counts all others. */
static const int statuses[CAMBER_STATUS_KINDS - 1] = {200, 204, 304, 308, 400, 404, 405, 408, 410, 413, 431, 500, 503};
static const double ends_s[CAMBER_HISTOGRAM_BUCKETS] = {0.0005, 0.001, 0.0025, 0.005, 0.01,
                                                        0.025,  0.05,  0.1,    0.25,  1.0};

void camber_metrics_count_request(camber_request_counts *counts, camber_route route, int status) {
    int kind = 0;
    while (kind < CAMBER_STATUS_KINDS - 1 && statuses[kind] != status)
        kind++;
    counts->of[route][kind]++;
}

void camber_histogram_observe(camber_histogram *histogram, double seconds) {
    int bucket = 0;
    while (bucket < CAMBER_HISTOGRAM_BUCKETS && seconds > ends_s[bucket])
        bucket++;
    histogram->buckets[bucket]++;
    histogram->microseconds += (uint64_t)(seconds * 1e6);
}

/* ---- Text ---- */

static void begin(FILE *file, const char *name, const char *type, const char *help) {
    fprintf(file, "# HELP camber_%s %s\n# TYPE camber_%s %s\n", name, help, name, type);
}

static void write_one(FILE *file, const char *name, const char *type, const char *help, double value) {
    begin(file, name, type, help);
    fprintf(file, "camber_%s %.15g\n", name, value);
}

/* label: of the map, with a comma; or "". */
static void write_counts(const camber_request_counts *counts, const char *label, FILE *file) {
    for (int route = 0; route < CAMBER_ROUTES; route++)
        for (int kind = 0; kind < CAMBER_STATUS_KINDS; kind++) {
            const uint64_t count = counts->of[route][kind];
            char status[16] = "other";
            if (kind < CAMBER_STATUS_KINDS - 1)
                snprintf(status, sizeof status, "%d", statuses[kind]);
            if (count)
                fprintf(file, "camber_requests_total{%sroute=\"%s\",status=\"%s\"} %" PRIu64 "\n", label,
                        camber_route_get_name((camber_route)route), status, count);
        }
}

/* The names of maps have letters, digits, '-', '_' and '/', so nothing in a label has to be escaped. */
static void write_requests(const camber_metrics *metrics, const camber_metrics_now *now, FILE *file) {
    begin(file, "requests_total", "counter", "Requests that were answered, by map, route and status.");
    write_counts(&metrics->requests, "", file);
    for (uint32_t i = 0; i < now->map_count; i++) {
        char label[256];
        snprintf(label, sizeof label, "map=\"%s\",", now->maps[i].name);
        write_counts(now->maps[i].requests, label, file);
    }
}

static void write_ready(const camber_metrics_now *now, FILE *file) {
    write_one(file, "ready", "gauge", "Whether the input has been read.", now->ready);
    if (now->map_count)
        begin(file, "map_ready", "gauge", "Whether the input of a map has been read.");
    for (uint32_t i = 0; i < now->map_count; i++)
        fprintf(file, "camber_map_ready{map=\"%s\"} %d\n", now->maps[i].name, now->maps[i].ready);
}

static void write_histogram(camber_histogram *histogram, FILE *file, const char *name, const char *help) {
    uint64_t sum = 0;
    begin(file, name, "histogram", help);
    for (int i = 0; i < CAMBER_HISTOGRAM_BUCKETS; i++) {
        sum += histogram->buckets[i];
        fprintf(file, "camber_%s_bucket{le=\"%g\"} %" PRIu64 "\n", name, ends_s[i], sum);
    }
    sum += histogram->buckets[CAMBER_HISTOGRAM_BUCKETS];
    fprintf(file, "camber_%s_bucket{le=\"+Inf\"} %" PRIu64 "\ncamber_%s_sum %.6f\ncamber_%s_count %" PRIu64 "\n", name,
            sum, name, 1e-6 * (double)histogram->microseconds, name, sum);
}

static double resident_bytes(void) {
    unsigned long long all = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (file && fscanf(file, "%llu %llu", &all, &resident) != 2)
        resident = 0;
    if (file)
        fclose(file);
    return (double)resident * (double)sysconf(_SC_PAGESIZE);
}

void camber_metrics_write(camber_metrics *metrics, const camber_metrics_now *now, FILE *file) {
    write_ready(now, file);
    write_one(file, "uptime_seconds", "gauge", "Seconds since the server began to listen.", now->uptime_s);
    write_requests(metrics, now, file);
    write_one(file, "sent_bytes_total", "counter", "Bytes of answers, without their headers.",
              (double)metrics->sent_bytes);
    write_one(file, "requests_in_flight", "gauge", "Requests that are not answered yet, including this one.",
              (double)now->in_flight);
    write_one(file, "connections", "gauge", "Connections that are open.", (double)metrics->connections);
    write_one(file, "queue", "gauge", "Pictures that wait to be drawn.", (double)metrics->queued);
    write_one(file, "queue_refused_total", "counter", "Requests that found the queue full.", (double)metrics->refused);
    write_one(file, "queue_dropped_total", "counter", "Pictures that nobody waited for any more.",
              (double)metrics->dropped);
    write_histogram(&metrics->draw, file, "draw_seconds", "Seconds that a picture took to be drawn.");
    write_histogram(&metrics->encode, file, "encode_seconds", "Seconds that a tile took to be encoded.");
    write_one(file, "cache_hits_total", "counter", "Tiles that were found in memory.", (double)now->cache.hits);
    write_one(file, "cache_folder_hits_total", "counter", "Tiles that were found only in the folder.",
              (double)now->cache.folder_hits);
    write_one(file, "cache_misses_total", "counter", "Tiles that were found in neither.", (double)now->cache.misses);
    write_one(file, "cache_tiles", "gauge", "Tiles in memory.", (double)now->cache.tiles);
    write_one(file, "cache_bytes", "gauge", "Bytes of the tiles in memory.", (double)now->cache.size_bytes);
    write_one(file, "resident_bytes", "gauge", "Memory of the process.", resident_bytes());
}
