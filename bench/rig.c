/* camber at work: everything opened once, and a frame from lines in memory to pixels in memory. */
#include "bench.h"

#include "base/base.h"
#include "proof/statistics.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static void on_log(void *user, camber_log_level level, const char *message) {
    (void)user;
    if (level == CAMBER_LOG_ERROR)
        fprintf(stderr, "camber_bench: %s\n", message);
}

bool bench_open(bench *b) {
    const camber_context_desc desc = {.log = on_log};
    camber_status status = camber_context_create(&desc, &b->context);
    if (status == CAMBER_OK)
        status = camber_surface_create(b->context, NULL, &b->surface);
    if (status == CAMBER_OK)
        status = camber_device_create(b->context, NULL, b->surface, &b->device);
    if (status == CAMBER_OK)
        status = camber_renderer_create(b->device, b->surface, NULL, &b->renderer);
    if (status == CAMBER_OK)
        status = camber_mesh_create(b->device, b->renderer, &b->mesh);
    if (status != CAMBER_OK)
        return false;
    b->picture = calloc((size_t)BENCH_SIDE_PX * BENCH_SIDE_PX, 4);
    b->pictured = calloc((size_t)BENCH_SIDE_PX * BENCH_SIDE_PX, 4);
    return b->picture && b->pictured;
}

void bench_close(bench *b) {
    free(b->pictured);
    free(b->picture);
    camber_mesh_destroy(b->mesh);
    camber_renderer_destroy(b->renderer);
    camber_device_destroy(b->device);
    camber_surface_destroy(b->surface);
    camber_context_destroy(b->context);
}

/* ---- A frame ---- */

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    uint8_t *picture = user;
    memcpy(picture + 4 * (size_t)BENCH_SIDE_PX * first_row, rgba, 4 * (size_t)BENCH_SIDE_PX * row_count);
    return true;
}

static camber_status draw_mesh(bench *b, const bench_frame_desc *desc, camber_frame_stats *stats) {
    const camber_paint paint = {desc->width_px, {0, 0, 0, 1}};
    const camber_pass pass = {.mesh = b->mesh, .paints = &paint, .paint_count = 1, .overlap = desc->overlap};
    const camber_frame frame = {
        .width = BENCH_SIDE_PX, .height = BENCH_SIDE_PX, .background = {1, 1, 1, 1}, .passes = &pass, .pass_count = 1};
    return camber_render(b->renderer, &frame, desc->picture ? take_rows : NULL, desc->picture, stats);
}

static camber_status tessellate(bench *b, const bench_frame_desc *desc, const camber_lines *lines) {
    camber_polylines *polylines = NULL;
    const camber_stroke stroke = {.width_px = desc->width_px};
    const camber_polylines_desc made = {.points = lines->points,
                                        .point_count = lines->point_count,
                                        .offsets = lines->offsets,
                                        .polyline_count = lines->polyline_count,
                                        .keep_open = true};
    camber_status status = camber_polylines_create(b->context, &made, &polylines);
    if (status == CAMBER_OK)
        status =
            camber_tessellate(b->mesh, polylines, &(camber_tessellation_desc){.strokes = &stroke, .stroke_count = 1});
    camber_polylines_destroy(polylines);
    return status;
}

camber_status bench_frame(bench *b, const bench_frame_desc *desc, bench_frame_times *times) {
    camber_lines simple = {0};
    camber_frame_stats stats = {0};
    camber_status status = CAMBER_OK;
    const double begin = camber_now_ms();
    if (desc->simplify_px > 0)
        status = camber_lines_simplify(b->context, desc->lines, desc->simplify_px, &simple);
    if (status == CAMBER_OK)
        status = tessellate(b, desc, desc->simplify_px > 0 ? &simple : desc->lines);
    if (status == CAMBER_OK)
        status = draw_mesh(b, desc, &stats);
    times->frame_ms = camber_now_ms() - begin;
    times->draw_ms = stats.draw_ms;
    if (status == CAMBER_OK) {
        const camber_mesh_info info = camber_mesh_get_info(b->mesh);
        times->kernels_ms = info.classify_ms + info.scan_ms + info.emit_ms;
    }
    camber_lines_free(b->context, &simple);
    return status;
}

/* ---- Series ---- */

void bench_series_add(bench_series *series, double value) {
    if (series->count < BENCH_RUNS_MAX)
        series->values[series->count++] = value;
}

double bench_series_median(const bench_series *series) {
    bench_series sorted = *series;
    return sorted.count ? camber_statistics_median(sorted.values, sorted.count) : 0;
}

/* ---- What the memory can do ---- */

enum { COPY_THREADS_MAX = 64, COPY_REPEATS = 4 };

typedef struct copy_share {
    uint8_t *to;
    const uint8_t *from;
    size_t size_bytes;
} copy_share;

static void *copy(void *argument) {
    const copy_share *share = argument;
    for (int i = 0; i < COPY_REPEATS; i++)
        memcpy(share->to, share->from, share->size_bytes);
    return NULL;
}

static unsigned copy_threads(const bench *b) {
    const camber_device_info device = camber_device_get_info(b->device);
    return device.compute_units < COPY_THREADS_MAX ? device.compute_units : COPY_THREADS_MAX;
}

static double run_copies(copy_share *shares, unsigned count) {
    pthread_t threads[COPY_THREADS_MAX];
    bool started[COPY_THREADS_MAX] = {false};
    const double begin = camber_now_ms();
    for (unsigned i = 1; i < count; i++)
        started[i] = pthread_create(threads + i, NULL, copy, shares + i) == 0;
    copy(shares);
    bool all = true;
    for (unsigned i = 1; i < count; i++) {
        if (started[i])
            pthread_join(threads[i], NULL);
        all = all && started[i];
    }
    return all ? (camber_now_ms() - begin) / COPY_REPEATS : 0;
}

double bench_copy_ms(const bench *b, size_t size_bytes) {
    const unsigned count = copy_threads(b);
    const size_t each = (size_bytes + count - 1) / count;
    uint8_t *from = malloc(each * count), *to = malloc(each * count);
    bench_series series = {.count = 0};
    if (from && to) {
        copy_share shares[COPY_THREADS_MAX];
        memset(from, 1, each * count); /* pages that nothing wrote to are all one */
        memset(to, 2, each * count);
        for (unsigned i = 0; i < count; i++)
            shares[i] = (copy_share){to + i * each, from + i * each, each};
        for (size_t run = 0; run < b->runs; run++)
            bench_series_add(&series, run_copies(shares, count));
    }
    free(to);
    free(from);
    return bench_series_median(&series);
}

/* ---- The yardstick ---- */

bench_yardstick bench_yardstick_measure(bench *b) {
    enum { RUNS = 3, COPY_BYTES = 64 << 20 };
    const bench_scene *walks = bench_scene_find(b, "zoom");
    if (bench_peer_count == 0 || !walks)
        return (bench_yardstick){"memcpy of 64 MB", bench_copy_ms(b, COPY_BYTES)};
    bench_series series = {.count = 0};
    for (int run = 0; run < RUNS; run++)
        bench_series_add(&series, bench_peers[0]->draw(&walks->lines, walks->width_px, b->pictured));
    return (bench_yardstick){strcmp(bench_peers[0]->key, "cairo") == 0 ? "Cairo's long walks"
                                                                       : "the first peer's long walks",
                             bench_series_median(&series)};
}
