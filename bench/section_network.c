/* From a network on the device to a mesh: project to emit, everything, in points of the network a second. */
#include "bench.h"

#include "base/base.h"

#include <string.h>

enum { STAGES = 5, TOLERANCES = 2 };

/* Bytes a point of a network, read at least once: x, y, importance. */
#define NETWORK_POINT_BYTES 12.0

static const char *const stages[STAGES] = {"cull_count", "cull_emit", "classify", "scan", "emit"};
static const double tolerances_px[TOLERANCES] = {0, BENCH_SIMPLIFY_PX};

typedef struct trial {
    bench *b;
    const bench_scene *scene;
    camber_network *network;
    double copied_gb_s; /* by memcpy */
    bench_series series[STAGES], all;
    double mesh_bytes;
} trial;

static camber_status tessellate(trial *t, double simplify_px) {
    const camber_stroke stroke = {.width_px = t->scene->width_px};
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
    const camber_camera camera = bench_camera(simplify_px);
    camber_status status = CAMBER_OK;
    for (size_t run = 0; run < t->b->warm_ups + t->b->runs && status == CAMBER_OK; run++) {
        const double begin = camber_now_ms();
        status = camber_mesh_tessellate_network(t->b->mesh, t->network, &camera, &desc);
        const double ms = camber_now_ms() - begin;
        if (status != CAMBER_OK || run < t->b->warm_ups)
            continue;
        const camber_mesh_info info = camber_mesh_get_info(t->b->mesh);
        const double times[STAGES] = {
            camber_stage_times_get_ms(&info.times, "cull_count"), camber_stage_times_get_ms(&info.times, "cull_emit"),
            camber_stage_times_get_ms(&info.times, "classify"), camber_stage_times_get_ms(&info.times, "scan"),
            camber_stage_times_get_ms(&info.times, "emit")};
        for (int i = 0; i < STAGES; i++)
            bench_series_add(t->series + i, times[i]);
        bench_series_add(&t->all, ms);
        t->mesh_bytes = (double)info.bytes;
    }
    return status;
}

static void report(trial *t, double simplify_px, json_t *result) {
    const double points = (double)camber_network_get_stats(t->network).points, ms = bench_series_median(&t->all);
    const double moved = points * NETWORK_POINT_BYTES + t->mesh_bytes;
    const double copy_ms = t->copied_gb_s > 0 ? moved / t->copied_gb_s / 1e6 : 0;
    json_t *row =
        json_pack("{s:s, s:s, s:f, s:I, s:o, s:f, s:f, s:f}", "key", t->scene->key, "scene", t->scene->name,
                  "simplify_px", simplify_px, "points", (json_int_t)points, "all_ms", bench_ms(ms), "m_points_s",
                  ms > 0 ? points / ms / 1e3 : 0, "mesh_bytes", t->mesh_bytes, "share", ms > 0 ? copy_ms / ms : 0);
    for (int i = 0; i < STAGES; i++) {
        char key[32];
        snprintf(key, sizeof key, "%s_ms", stages[i]);
        json_object_set_new(row, key, bench_ms(bench_series_median(t->series + i)));
    }
    char what[64];
    snprintf(what, sizeof what, "project to emit at %g px", simplify_px);
    bench_result_add_figure(result, &(bench_figure){t->scene->key, what, "memcpy", copy_ms / ms, false});
    bench_result_add_row(result, row);
}

static camber_status measure_scene(bench *b, const bench_scene *scene, void *copied_gb_s, json_t *result) {
    trial t = {.b = b, .scene = scene, .copied_gb_s = *(const double *)copied_gb_s};
    camber_status status = bench_network_of_lines(b, &scene->lines, &t.network);
    for (int i = 0; i < TOLERANCES && status == CAMBER_OK; i++) {
        t.all.count = 0;
        for (int k = 0; k < STAGES; k++)
            t.series[k].count = 0;
        status = tessellate(&t, tolerances_px[i]);
        if (status == CAMBER_OK)
            report(&t, tolerances_px[i], result);
    }
    camber_network_destroy(t.network);
    return status;
}

static json_t *measure(bench *b, const char *only) {
    double copied_gb_s = bench_copy_gb_s(b);
    return bench_measure_scenes(b, only, measure_scene, &copied_gb_s);
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to,
            "Project to emit, lines on the device to a mesh: ms by stage, and of everything, what the host does "
            "included; points\n"
            "of the network a second; share of memcpy's bytes a second, counting %g bytes a point and the mesh.\n\n"
            "%-12s %4s %9s",
            NETWORK_POINT_BYTES, "scene", "at", "points");
    for (int k = 0; k < STAGES; k++)
        fprintf(to, " %8s", stages[k]);
    fprintf(to, " %8s %9s %6s\n", "all", "M point/s", "share");
    json_array_foreach(bench_result_rows(result), i, row) {
        fprintf(to, "%-12s %4g %9.0f", bench_text(row, "scene"), bench_number(row, "simplify_px"),
                bench_number(row, "points"));
        for (int k = 0; k < STAGES; k++) {
            char key[32];
            snprintf(key, sizeof key, "%s_ms", stages[k]);
            fprintf(to, " %8.3f", bench_number(row, key));
        }
        fprintf(to, " %8.3f %9.1f %5.0f%%\n", bench_number(row, "all_ms"), bench_number(row, "m_points_s"),
                100 * bench_number(row, "share"));
    }
}

const bench_section bench_section_network = {"network", measure, print};
