/* camber at work: everything opened once, and a frame from lines in memory to pixels in memory. */
#include "bench.h"

#include "base/base.h"
#include "camber_network.h"
#include "validate/statistics.h"

#include <stdlib.h>
#include <string.h>

static void on_log(void *user, camber_log_level level, const char *message) {
    (void)user;
    if (level == CAMBER_LOG_ERROR)
        fprintf(stderr, "camber_bench: %s\n", message);
}

/* Both GL and OpenCL draw on one device, which shares its meshes with GL where it can. */
static camber_status open_fixture(bench *b) {
    static const camber_fixture_desc desc = {
        .drawers = CAMBER_FIXTURE_IN_GL | CAMBER_FIXTURE_IN_OPENCL, .first_gl = true, .on_surface = true};
    const camber_status status = camber_fixture_open(b->context, &desc, &b->opened);
    const int gl = b->opened.surface[CAMBER_FIXTURE_EGL] ? CAMBER_FIXTURE_EGL : CAMBER_FIXTURE_OSMESA;
    b->device = b->opened.device;
    b->surface = b->opened.surface[gl];
    b->renderer = b->opened.renderer[gl];
    b->cl_renderer = b->opened.renderer[CAMBER_FIXTURE_OPENCL];
    return status == CAMBER_OK && !(b->renderer && b->cl_renderer) ? CAMBER_ERROR_DEVICE : status;
}

bool bench_open(bench *b) {
    const camber_context_desc desc = {.log = on_log};
    camber_status status = camber_context_create(&desc, &b->context);
    if (status == CAMBER_OK)
        status = open_fixture(b);
    if (status == CAMBER_OK)
        status = camber_mesh_create(b->device, b->renderer, &b->mesh);
    if (status == CAMBER_OK)
        status = camber_mesh_create(b->device, b->cl_renderer, &b->cl_mesh);
    if (status != CAMBER_OK)
        return false;
    b->picture = calloc((size_t)BENCH_SIDE_PX * BENCH_SIDE_PX, 4);
    b->pictured = calloc((size_t)BENCH_SIDE_PX * BENCH_SIDE_PX, 4);
    return b->picture && b->pictured;
}

void bench_close(bench *b) {
    free(b->pictured);
    free(b->picture);
    camber_mesh_destroy(b->cl_mesh);
    camber_mesh_destroy(b->mesh);
    camber_fixture_close(&b->opened);
    camber_context_destroy(b->context);
}

/* ---- A frame ---- */

bool bench_take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    bench_taking *t = user;
    const double begin = camber_now_ms(), cpu_begin = camber_clock_ms(CLOCK_THREAD_CPUTIME_ID);
    memcpy(t->picture + 4 * (size_t)BENCH_SIDE_PX * first_row, rgba, 4 * (size_t)BENCH_SIDE_PX * row_count);
    t->kept_ms += camber_now_ms() - begin;
    t->kept_cpu_ms += camber_clock_ms(CLOCK_THREAD_CPUTIME_ID) - cpu_begin;
    return true;
}

static camber_status draw_mesh(bench *b, const bench_frame_desc *desc, bench_taking *t, camber_frame_stats *stats) {
    const camber_fill fill = {.color = {0, 0, 0, 1}};
    const camber_paint paint = {.width_px = desc->width_px, .color = {0, 0, 0, 1}, .fill = desc->areas ? &fill : NULL};
    const camber_pass pass = {
        .mesh = desc->in_cl ? b->cl_mesh : b->mesh, .paints = &paint, .paint_count = 1, .overlap = desc->overlap};
    const camber_frame frame = {
        .width = BENCH_SIDE_PX, .height = BENCH_SIDE_PX, .background = {1, 1, 1, 1}, .passes = &pass, .pass_count = 1};
    return camber_renderer_render(desc->in_cl ? b->cl_renderer : b->renderer, &frame,
                                  desc->picture ? bench_take_rows : NULL, t, stats);
}

static camber_status tessellate_lines(bench *b, const bench_frame_desc *desc, const camber_tessellation_desc *strokes) {
    camber_polylines *polylines = NULL;
    const camber_polylines_desc made = {.points = desc->lines->points,
                                        .point_count = desc->lines->point_count,
                                        .offsets = desc->lines->offsets,
                                        .polyline_count = desc->lines->polyline_count,
                                        .keep_open = true};
    camber_status status = camber_polylines_create(b->context, &made, &polylines);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(desc->in_cl ? b->cl_mesh : b->mesh, polylines, strokes);
    camber_polylines_destroy(polylines);
    return status;
}

static camber_status tessellate_areas(bench *b, const bench_frame_desc *desc, const camber_tessellation_desc *strokes) {
    camber_polylines *rings = NULL;
    const camber_areas_desc made = {.points = desc->areas->lines.points,
                                    .point_count = desc->areas->lines.point_count,
                                    .offsets = desc->areas->lines.offsets,
                                    .ring_count = desc->areas->lines.polyline_count,
                                    .rings = desc->areas->areas,
                                    .area_count = desc->areas->area_count};
    camber_status status = camber_areas_create(b->context, &made, &rings);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(desc->in_cl ? b->cl_mesh : b->mesh, rings, strokes);
    camber_polylines_destroy(rings);
    return status;
}

static camber_status tessellate(bench *b, const bench_frame_desc *desc) {
    const camber_stroke stroke = {.width_px = desc->width_px};
    const camber_tessellation_desc strokes = {.strokes = &stroke, .stroke_count = 1};
    camber_mesh *mesh = desc->in_cl ? b->cl_mesh : b->mesh;
    if (desc->areas)
        return tessellate_areas(b, desc, &strokes);
    return desc->network ? camber_mesh_tessellate_network(mesh, desc->network, &desc->camera, &strokes)
                         : tessellate_lines(b, desc, &strokes);
}

camber_status bench_frame(bench *b, const bench_frame_desc *desc, bench_frame_times *times) {
    camber_frame_stats stats = {0};
    bench_taking t = {.picture = desc->picture};
    const double begin = camber_now_ms(), cpu_begin = camber_clock_ms(CLOCK_PROCESS_CPUTIME_ID);
    camber_status status = tessellate(b, desc);
    times->tessellate_ms = camber_now_ms() - begin;
    if (status == CAMBER_OK)
        status = draw_mesh(b, desc, &t, &stats);
    times->frame_ms = camber_now_ms() - begin - t.kept_ms;
    times->cpu_ms = camber_clock_ms(CLOCK_PROCESS_CPUTIME_ID) - cpu_begin - t.kept_cpu_ms;
    times->draw_ms = stats.draw_ms;
    return status;
}

/* ---- Networks ---- */

camber_camera bench_camera(double simplify_px) {
    return (camber_camera){.x = BENCH_SIDE_PX / 2.0,
                           .y = BENCH_SIDE_PX / 2.0,
                           .scale_px = 1,
                           .width = BENCH_SIDE_PX,
                           .height = BENCH_SIDE_PX,
                           .simplify_px = simplify_px};
}

camber_status bench_network_make(bench *b, const bench_plane *plane, camber_network **network) {
    float *importance = malloc((plane->offsets[plane->polyline_count] + 1) * sizeof *importance);
    const camber_network_desc desc = {.points = plane->points,
                                      .offsets = plane->offsets,
                                      .polyline_count = plane->polyline_count,
                                      .importance = importance,
                                      .keep_open = true};
    camber_status status = importance ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        status = camber_importance_weigh(b->context, plane->points, plane->offsets, plane->polyline_count, importance);
    if (status == CAMBER_OK)
        status = camber_network_create(b->context, &desc, network);
    free(importance);
    return status;
}

camber_status bench_network_of_lines(bench *b, const camber_lines *lines, camber_network **network) {
    bench_plane plane = {.points = malloc(2 * sizeof(double) * (lines->point_count + 1)),
                         .offsets = malloc(sizeof(size_t) * (lines->polyline_count + 1)),
                         .polyline_count = lines->polyline_count};
    camber_status status = plane.points && plane.offsets ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK) {
        for (size_t i = 0; i < 2 * lines->point_count; i++)
            plane.points[i] = (double)lines->points[i];
        for (size_t i = 0; i <= lines->polyline_count; i++)
            plane.offsets[i] = lines->offsets[i];
        status = bench_network_make(b, &plane, network);
    }
    bench_plane_free(&plane);
    return status;
}

void bench_plane_free(bench_plane *plane) {
    free(plane->points);
    free(plane->offsets);
    *plane = (bench_plane){0};
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

/* ---- Peers ---- */

double bench_peer_draw(const bench *b, const bench_peer *peer, const bench_scene *scene) {
    const bench_peer_frame frame = {.lines = &scene->lines,
                                    .width_px = scene->width_px,
                                    .areas = scene->areas,
                                    .area_count = scene->area_count,
                                    .avx2_only = b->avx2_only,
                                    .rgba = b->pictured};
    return peer->draw(&frame);
}

bool bench_goes_on(const bench *b, size_t run, double begin_ms) {
    enum { LEAST_RUNS = 3 };
    const bool is_late = camber_now_ms() - begin_ms > BENCH_PATIENCE_MS;
    return run < b->warm_ups + (is_late ? LEAST_RUNS : b->runs);
}

static bool is_alike(const bench_peers_trial *trial, size_t peer) {
    return trial->differences[peer] >= 0 && trial->differences[peer] <= BENCH_DIFFERENCE_MAX;
}

static bool is_of_library(size_t peer, size_t other) {
    const size_t length = strcspn(bench_peers[peer]->key, "_");
    return strcspn(bench_peers[other]->key, "_") == length &&
           strncmp(bench_peers[peer]->key, bench_peers[other]->key, length) == 0;
}

/* Whether another way of the library is so much faster that this one is not going to be its best. */
static bool is_slow(const bench_peers_trial *trial, size_t peer) {
    const double much = 1.3;
    for (size_t i = 0; i < bench_peer_count; i++)
        if (is_of_library(peer, i) && is_alike(trial, i) && trial->warm_ms[i] * much < trial->warm_ms[peer])
            return true;
    return false;
}

void bench_peers_draw(const bench *b, bench_peers_trial *trial, const bench_scene *scene, bool counts,
                      bench_difference_fn *difference, const void *user) {
    for (size_t i = 0; i < bench_peer_count && i < BENCH_PEERS_MAX; i++) {
        if (counts && (trial->warm_ms[i] < 0 || is_slow(trial, i))) {
            if (trial->ms[i].count == 0 && trial->warm_ms[i] >= 0)
                bench_series_add(&trial->ms[i], trial->warm_ms[i]);
            continue;
        }
        const double ms = bench_peer_draw(b, bench_peers[i], scene);
        if (!counts) {
            trial->warm_ms[i] = ms;
            trial->differences[i] = ms >= 0 ? difference(b, user) : -1;
        } else if (ms >= 0) {
            bench_series_add(&trial->ms[i], ms);
        }
    }
}

json_t *bench_peers_report(const bench_peers_trial *trial, const bench_scene *scene, const char *what) {
    json_t *peers = json_object();
    for (size_t i = 0; i < bench_peer_count && i < BENCH_PEERS_MAX; i++) {
        if (!is_alike(trial, i))
            fprintf(stderr, "camber_bench: %s on %s does not count: its picture is off by %.0f of 255\n",
                    bench_peers[i]->key, scene->name, trial->differences[i]);
        json_object_set_new(peers, bench_peers[i]->key,
                            json_pack("{s:o, s:f, s:b}", "ms", bench_ms(bench_series_median(&trial->ms[i])), what,
                                      trial->differences[i], "alike", is_alike(trial, i)));
    }
    return peers;
}

/* ---- The yardstick ---- */

bench_yardstick bench_yardstick_measure(bench *b) {
    enum { RUNS = 3 };
    const bench_scene *walks = bench_scene_find(b, "zoom");
    if (bench_peer_count == 0 || !walks)
        return (bench_yardstick){"memcpy of 1 GB", 2e3 / bench_copy_gb_s(b)};
    bench_series series = {.count = 0};
    for (int run = 0; run < RUNS; run++)
        bench_series_add(&series, bench_peer_draw(b, bench_peers[0], walks));
    return (bench_yardstick){strcmp(bench_peers[0]->key, "cairo") == 0 ? "Cairo's long walks"
                                                                       : "the first peer's long walks",
                             bench_series_median(&series)};
}
