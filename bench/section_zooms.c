/* Cities at several widths and zooms: what is seen of them, drawn by camber and by the first peer, in turn. */
#include "bench.h"

#include "validate/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CITIES = 4, WIDTHS = 3, ZOOMS = 3, RUNS = 3 };

static const char *const cities[CITIES] = {"santa_cruz", "porto", "nyc", "beijing"};
static const float widths_px[WIDTHS] = {1, 3, 8};
static const int zooms[ZOOMS] = {0, 2, 4};

static double middle_of(const camber_lines *lines, size_t axis, double *values) {
    for (size_t i = 0; i < lines->point_count; i++)
        values[i] = (double)lines->points[2 * i + axis];
    return camber_statistics_median(values, lines->point_count);
}

/* Whether a polyline's box comes near the square. */
static bool is_seen(const float *points, size_t count) {
    float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < 2 * count; i++) {
        low[i % 2] = fminf(low[i % 2], points[i]);
        high[i % 2] = fmaxf(high[i % 2], points[i]);
    }
    const float margin = widths_px[WIDTHS - 1];
    return high[0] > -margin && high[1] > -margin && low[0] < BENCH_SIDE_PX + margin && low[1] < BENCH_SIDE_PX + margin;
}

/* Keeps the polylines that are seen 2^zoom times as large about the middle of the points; seen has room for all. */
static void magnify(const camber_lines *from, int zoom, const double middle[2], camber_lines *seen) {
    const double scale = ldexp(1, zoom);
    seen->point_count = seen->polyline_count = 0;
    for (size_t i = 0; i < from->polyline_count; i++) {
        const size_t first = from->offsets[i], count = from->offsets[i + 1] - first;
        float *to = seen->points + 2 * seen->point_count;
        for (size_t k = 0; k < 2 * count; k++)
            to[k] = (float)(((double)from->points[2 * first + k] - middle[k % 2]) * scale + BENCH_SIDE_PX / 2.0);
        seen->offsets[seen->polyline_count] = (uint32_t)seen->point_count;
        if (is_seen(to, count)) {
            seen->point_count += count;
            seen->polyline_count++;
        }
    }
    seen->offsets[seen->polyline_count] = (uint32_t)seen->point_count;
}

typedef struct trial {
    bench *b;
    const bench_scene *city;
    camber_network *network;
    double middle[2];
    camber_lines seen; /* at a zoom, for the peer */
} trial;

static camber_status measure_view(const trial *t, int zoom, float width_px, json_t *result) {
    bench *b = t->b;
    bench_frame_desc desc = {
        .network = t->network, .camera = bench_camera(BENCH_SIMPLIFY_PX), .width_px = width_px, .picture = b->picture};
    desc.camera.x = t->middle[0];
    desc.camera.y = t->middle[1];
    desc.camera.scale_px = ldexp(1, zoom);
    const bench_scene seen = {.lines = t->seen, .width_px = width_px};
    bench_series draw = {.count = 0}, frame = {.count = 0}, peer = {.count = 0};
    camber_status status = CAMBER_OK;
    for (int run = -1; run < RUNS && status == CAMBER_OK; run++) {
        bench_frame_times times = {0};
        status = bench_frame(b, &desc, &times);
        const double peer_ms = bench_peer_count ? bench_peer_draw(b, bench_peers[0], &seen) : 0;
        if (run < 0)
            continue;
        bench_series_add(&draw, times.draw_ms);
        bench_series_add(&frame, times.frame_ms);
        bench_series_add(&peer, peer_ms);
    }
    const double draw_ms = bench_series_median(&draw), peer_ms = bench_series_median(&peer);
    char what[64];
    snprintf(what, sizeof what, "draw at zoom +%d, %g px", zoom, (double)width_px);
    bench_result_add_row(result, json_pack("{s:s, s:s, s:f, s:f, s:I, s:I, s:o, s:o, s:o}", "key", t->city->key,
                                           "scene", t->city->name, "zoom", (double)zoom, "width_px", (double)width_px,
                                           "polylines", (json_int_t)t->seen.polyline_count, "points",
                                           (json_int_t)t->seen.point_count, "draw_ms", bench_ms(draw_ms), "frame_ms",
                                           bench_ms(bench_series_median(&frame)), "peer_ms", bench_ms(peer_ms)));
    if (bench_peer_count)
        bench_result_add_figure(result,
                                &(bench_figure){t->city->key, what, bench_peers[0]->name, peer_ms / draw_ms, false});
    return status;
}

static camber_status measure_views(trial *t, json_t *result) {
    const bool quick = t->b->size == BENCH_QUICK;
    camber_status status = CAMBER_OK;
    for (int i = 0; i < ZOOMS && status == CAMBER_OK; i++) {
        magnify(&t->city->lines, zooms[i], t->middle, &t->seen);
        for (int k = quick; k < WIDTHS - quick && status == CAMBER_OK; k++)
            status = measure_view(t, zooms[i], widths_px[k], result);
    }
    return status;
}

static camber_status measure_city(bench *b, const bench_scene *city, json_t *result) {
    trial t = {.b = b,
               .city = city,
               .seen = {.points = calloc(city->lines.point_count, 2 * sizeof(float)),
                        .offsets = calloc(city->lines.polyline_count + 1, sizeof(uint32_t))}};
    double *values = calloc(city->lines.point_count, sizeof *values);
    camber_status status = t.seen.points && t.seen.offsets && values ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        status = bench_network_of_lines(b, &city->lines, &t.network);
    if (status == CAMBER_OK) {
        t.middle[0] = middle_of(&city->lines, 0, values);
        t.middle[1] = middle_of(&city->lines, 1, values);
        status = measure_views(&t, result);
    }
    camber_network_destroy(t.network);
    free(values);
    free(t.seen.points);
    free(t.seen.offsets);
    return status;
}

static json_t *measure(bench *b, const char *only) {
    json_t *result = bench_result_new();
    camber_status status = CAMBER_OK;
    for (int i = 0; i < CITIES && status == CAMBER_OK; i++) {
        const bench_scene *city = bench_scene_find(b, cities[i]);
        if (city && (!only || strcmp(only, city->key) == 0))
            status = measure_city(b, city, result);
    }
    if (status == CAMBER_OK)
        return result;
    json_decref(result);
    return NULL;
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to,
            "Cities by zoom (above the whole city) and width, %d x %d px, at %g px, ms; the first peer on the same "
            "lines.\n\n"
            "%-12s %4s %3s %8s %8s %8s %8s %8s %6s\n",
            BENCH_SIDE_PX, BENCH_SIDE_PX, BENCH_SIMPLIFY_PX, "scene", "zoom", "px", "lines", "points", "draw", "frame",
            "peer", "ratio");
    json_array_foreach(bench_result_rows(result), i, row) {
        const double peer_ms = bench_number(row, "peer_ms"), draw_ms = bench_number(row, "draw_ms");
        fprintf(to, "%-12s  +%-2g %3g %8.0f %8.0f %8.1f %8.1f %8.1f %6.2f\n", bench_text(row, "scene"),
                bench_number(row, "zoom"), bench_number(row, "width_px"), bench_number(row, "polylines"),
                bench_number(row, "points"), draw_ms, bench_number(row, "frame_ms"), peer_ms,
                draw_ms > 0 ? peer_ms / draw_ms : 0);
    }
}

const bench_section bench_section_zooms = {"zooms", measure, print};
