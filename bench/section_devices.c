/* Each scene's frame on each CPU device, in turn in one run: the back end cpu, and OpenCL's devices. Everything from
 * lines, from a simplified network, and areas. */
#include "bench.h"

#include "base/base.h"

#include <math.h>
#include <string.h>

enum { DEVICES_MAX = 4 };

/* A device, and the benchmark as it would be if that were its only one. */
typedef struct on_device {
    bench b;
    camber_fixture opened;
    char name[128];
} on_device;

typedef struct devices {
    on_device list[DEVICES_MAX];
    size_t count;
} devices;

static camber_status open_one(bench *b, uint32_t number, const camber_device_info *info, on_device *to) {
    const camber_fixture_desc desc = {.device = {.match = "cpu", .number = number},
                                      .drawers = CAMBER_FIXTURE_IN_OPENCL};
    to->b = *b;
    snprintf(to->name, sizeof to->name, "%s", info->name);
    camber_status status = camber_fixture_open(b->context, &desc, &to->opened);
    to->b.device = to->opened.device;
    to->b.cl_renderer = to->opened.renderer[CAMBER_FIXTURE_OPENCL];
    to->b.cl_mesh = NULL;
    if (status == CAMBER_OK)
        status = camber_mesh_create(to->b.device, to->b.cl_renderer, &to->b.cl_mesh);
    return status;
}

static void close_all(devices *on) {
    for (size_t i = 0; i < on->count; i++) {
        camber_mesh_destroy(on->list[i].b.cl_mesh);
        camber_fixture_close(&on->list[i].opened);
    }
}

static camber_status open_all(bench *b, devices *on) {
    const camber_device_info *info = NULL;
    camber_status status = camber_device_list(b->context, "cpu", 0, &info);
    while (status == CAMBER_OK && info && on->count < DEVICES_MAX) {
        status = open_one(b, (uint32_t)on->count + 1, info, &on->list[on->count]);
        on->count++;
        if (status == CAMBER_OK)
            status = camber_device_list(b->context, "cpu", on->count, &info);
    }
    return status;
}

/* A device's frames, and how many times each of them fits into the first device's frame before it: other programs that
 * come and go slow down both. */
typedef struct series {
    bench_series ms, cpu_ms, ratio, cpu_ratio;
} series;

static void add_run(series *to, double ms, double cpu_ms, const double first[2]) {
    bench_series_add(&to->ms, ms);
    bench_series_add(&to->cpu_ms, cpu_ms);
    bench_series_add(&to->ratio, first[0] / ms);
    bench_series_add(&to->cpu_ratio, first[1] / cpu_ms);
}

/* Measures a frame on every device, and adds a row of its medians and a figure of each device against the first. */
static camber_status measure_frame(devices *on, const char *key, const char *what, const bench_frame_desc *desc,
                                   json_t *result) {
    series all[DEVICES_MAX] = {0};
    const bench *b = &on->list[0].b;
    camber_status status = CAMBER_OK;
    for (size_t run = 0; run < b->warm_ups + b->runs && status == CAMBER_OK; run++) {
        double first[2] = {0};
        for (size_t i = 0; i < on->count && status == CAMBER_OK; i++) {
            bench_frame_times times = {0};
            status = bench_frame(&on->list[i].b, desc, &times);
            if (i == 0)
                first[0] = times.frame_ms, first[1] = times.cpu_ms;
            if (status == CAMBER_OK && run >= b->warm_ups)
                add_run(all + i, times.frame_ms, times.cpu_ms, first);
        }
    }
    if (status != CAMBER_OK)
        return status;
    json_t *list = json_array();
    for (size_t i = 0; i < on->count; i++) {
        const double ratio = bench_series_median(&all[i].ratio);
        json_array_append_new(list, json_pack("{s:s, s:o, s:o, s:f, s:f}", "device", on->list[i].name, "ms",
                                              bench_ms(bench_series_median(&all[i].ms)), "cpu_ms",
                                              bench_ms(bench_series_median(&all[i].cpu_ms)), "ratio", ratio,
                                              "cpu_ratio", bench_series_median(&all[i].cpu_ratio)));
        if (i > 0)
            bench_result_add_figure(result, &(bench_figure){key, what, on->list[i].name, ratio, true});
    }
    bench_result_add_row(result, json_pack("{s:s, s:s, s:o}", "key", key, "what", what, "devices", list));
    return CAMBER_OK;
}

static camber_status measure_scene(bench *b, const bench_scene *scene, void *user, json_t *result) {
    devices *on = user;
    bench_frame_desc desc = {.lines = &scene->lines, .width_px = scene->width_px, .picture = b->picture, .in_cl = true};
    camber_status status = measure_frame(on, scene->key, "frame", &desc, result);
    if (status == CAMBER_OK)
        status = bench_network_of_lines(b, &scene->lines, &desc.network);
    desc.camera = bench_camera(BENCH_SIMPLIFY_PX);
    if (status == CAMBER_OK)
        status = measure_frame(on, scene->key, "frame at 0.1 px", &desc, result);
    camber_network_destroy(desc.network);
    return status;
}

static camber_status measure_areas(bench *b, devices *on, const char *only, json_t *result) {
    bench_scene scenes[BENCH_SCENES_MAX];
    const size_t count = bench_areas_make(b, only, scenes);
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < count && status == CAMBER_OK; i++) {
        const bench_frame_desc desc = {.areas = scenes + i, .in_cl = true, .picture = b->picture};
        status = measure_frame(on, scenes[i].key, "areas", &desc, result);
    }
    bench_areas_free(scenes, count);
    return status;
}

static json_t *measure(bench *b, const char *only) {
    devices on = {.count = 0};
    json_t *result = NULL;
    if (open_all(b, &on) == CAMBER_OK)
        result = bench_measure_scenes(b, only, measure_scene, &on);
    if (result && measure_areas(b, &on, only, result) != CAMBER_OK) {
        json_decref(result);
        result = NULL;
    }
    close_all(&on);
    return result;
}

static void print(const json_t *result, FILE *to) {
    size_t i, k;
    const json_t *row, *device;
    double logs = 0, cpu_logs = 0;
    size_t count = 0;
    fprintf(
        to,
        "Frames on CPU devices, %d x %d px, from lines in memory to pixels in memory: ms; CPU time of all threads, "
        "ms; and\nhow many times a device's frame fits into the first device's, in time and in CPU time (the median "
        "of pairs).\n\n",
        BENCH_SIDE_PX, BENCH_SIDE_PX);
    json_array_foreach(bench_result_rows(result), i, row) {
        const json_t *list = json_object_get(row, "devices");
        fprintf(to, "%s, %s\n", bench_text(row, "key"), bench_text(row, "what"));
        json_array_foreach(list, k, device) {
            const double ratio = bench_number(device, "ratio"), cpu_ratio = bench_number(device, "cpu_ratio");
            fprintf(to, "    %-50.50s %8.2f ms %8.2f ms %6.2f %6.2f\n", bench_text(device, "device"),
                    bench_number(device, "ms"), bench_number(device, "cpu_ms"), ratio, cpu_ratio);
            if (k == 1) {
                logs += log(ratio);
                cpu_logs += log(cpu_ratio);
                count++;
            }
        }
    }
    if (count)
        fprintf(to, "\nGeometric means of the second device: %.3f, CPU time %.3f\n", exp(logs / (double)count),
                exp(cpu_logs / (double)count));
}

const bench_section bench_section_devices = {"devices", measure, print};
