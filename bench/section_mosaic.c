/* Copies of a city side by side in one picture, 10^4 points to 3 * 10^7: what a point costs as they grow in number, in
 * time and in memory. Each size is a process of its own, so that its peak of memory is its own. */
#include "bench.h"

#include "base/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH_PX 1.0f
/* The largest sizes are drawn fewer times: twice at least. */
#define PATIENCE_MS 6000.0

static const char *const cities[] = {"porto", "santa_cruz", "zoom", NULL};

static const char *city_of(const bench *b) {
    for (size_t i = 0; cities[i]; i++)
        if (bench_scene_find(b, cities[i]))
            return cities[i];
    return NULL;
}

/* ---- The child ---- */

/* Copies row by row into a grid, or a city thinned out; whole polylines, until there are as many points. */
static bool make_mosaic(const camber_lines *city, size_t points, bench_plane *mosaic) {
    const size_t copies = (points + city->point_count - 1) / city->point_count;
    const size_t side = (size_t)ceil(sqrt((double)copies)), stride = copies > 1 ? 1 : city->point_count / points;
    const double scale = 1.0 / (double)side;
    size_t made = 0;
    mosaic->points = malloc(2 * sizeof(double) * (points + city->point_count));
    mosaic->offsets = malloc(sizeof(size_t) * (copies * city->polyline_count + 1));
    if (!mosaic->points || !mosaic->offsets)
        return false;
    for (size_t i = 0; made < points && i < copies * city->polyline_count; i += stride) {
        const size_t copy = i / city->polyline_count, line = i % city->polyline_count;
        const double at[2] = {(double)(copy % side) * BENCH_SIDE_PX, (double)(copy / side) * BENCH_SIDE_PX};
        const size_t first = city->offsets[line], count = city->offsets[line + 1] - first;
        mosaic->offsets[mosaic->polyline_count++] = made;
        for (size_t k = 0; k < 2 * count; k++)
            mosaic->points[2 * made + k] = ((double)city->points[2 * first + k] + at[k % 2]) * scale;
        made += count;
    }
    mosaic->offsets[mosaic->polyline_count] = made;
    return true;
}

/* "VmHWM:": the peak of this process. */
static double memory_bytes(const char *key) {
    char line[256];
    double bytes = 0;
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, key, strlen(key)) == 0)
            bytes = strtod(line + strlen(key) + 1, NULL) * 1024;
    if (file)
        fclose(file);
    return bytes;
}

typedef struct trial {
    bench_series frame, draw, tessellate;
} trial;

static camber_status measure_cost(bench *b, camber_network *network, double simplify_px, trial *c) {
    const bench_frame_desc desc = {
        .network = network, .camera = bench_camera(simplify_px), .width_px = WIDTH_PX, .picture = b->picture};
    camber_status status = CAMBER_OK;
    const double begin = camber_now_ms();
    for (size_t run = 0; run < b->warm_ups + b->runs && status == CAMBER_OK; run++) {
        bench_frame_times times = {0};
        status = bench_frame(b, &desc, &times);
        const bool late = camber_now_ms() - begin > PATIENCE_MS;
        if (run == 0 || (run < b->warm_ups && !late)) /* the first uploads the network */
            continue;
        bench_series_add(&c->frame, times.frame_ms);
        bench_series_add(&c->draw, times.draw_ms);
        bench_series_add(&c->tessellate, times.tessellate_ms);
        if (late)
            break;
    }
    return status;
}

static json_t *cost_json(const trial *c, double fixed_ms, double points) {
    const double frame_ms = bench_series_median(&c->frame);
    return json_pack("{s:o, s:o, s:o, s:f}", "frame_ms", bench_ms(frame_ms), "draw_ms",
                     bench_ms(bench_series_median(&c->draw)), "tessellate_ms",
                     bench_ms(bench_series_median(&c->tessellate)), "ns_a_point",
                     fmax(frame_ms - fixed_ms, 0) * 1e6 / points);
}

static camber_status measure_empty(bench *b, trial *none) {
    camber_network *network = NULL;
    double nowhere[4] = {-1e6, -1e6, -1e6 - 1, -1e6};
    size_t offsets[2] = {0, 2};
    camber_status status =
        bench_network_make(b, &(bench_plane){.points = nowhere, .offsets = offsets, .polyline_count = 1}, &network);
    if (status == CAMBER_OK)
        status = measure_cost(b, network, 0, none);
    camber_network_destroy(network);
    return status;
}

static camber_status make_network(bench *b, size_t points, camber_network **network) {
    bench_plane mosaic = {0};
    camber_status status = make_mosaic(&b->scenes[0].lines, points, &mosaic) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        status = bench_network_make(b, &mosaic, network);
    bench_plane_free(&mosaic);
    return status;
}

int bench_mosaic_child(bench *b, size_t points) {
    camber_network *network = NULL;
    trial none = {.frame = {.count = 0}}, simple = none, everything = none;
    for (size_t i = 0; cities[i] && b->scene_count == 0; i++)
        bench_scenes_make(b, cities[i]);
    if (b->scene_count == 0)
        return 1;
    camber_status status = measure_empty(b, &none);
    if (status == CAMBER_OK)
        status = make_network(b, points, &network);
    if (status == CAMBER_OK)
        status = measure_cost(b, network, BENCH_SIMPLIFY_PX, &simple);
    const double simple_peak = memory_bytes("VmHWM:");
    if (status == CAMBER_OK)
        status = measure_cost(b, network, 0, &everything);
    if (status == CAMBER_OK) {
        const camber_polylines_stats stats = camber_network_get_stats(network);
        const double fixed_ms = bench_series_median(&none.frame), count = (double)stats.points;
        json_t *row = json_pack("{s:s, s:I, s:I, s:o, s:f, s:f, s:o, s:o}", "city", b->scenes[0].name, "points",
                                (json_int_t)stats.points, "polylines", (json_int_t)stats.polylines, "fixed_ms",
                                bench_ms(fixed_ms), "peak_bytes", simple_peak, "everything_peak_bytes",
                                memory_bytes("VmHWM:"), "simple", cost_json(&simple, fixed_ms, count), "everything",
                                cost_json(&everything, fixed_ms, count));
        json_dumpf(row, stdout, JSON_COMPACT);
        json_decref(row);
    }
    camber_network_destroy(network);
    return status == CAMBER_OK ? 0 : 1;
}

/* ---- The section ---- */

static json_t *measure_size(const bench *b, size_t points) {
    static const char *const flags[] = {NULL, "--quick", "--tiny"};
    char count[32];
    snprintf(count, sizeof count, "%zu", points);
    const char *const arguments[] = {b->program, "--mosaic", count, flags[b->size], NULL};
    bench_child child = bench_child_run(arguments, NULL, NULL);
    json_t *row = child.status == 0 && child.output ? json_loads(child.output, 0, NULL) : NULL;
    free(child.output);
    return row;
}

/* The most by which a point costs more in a larger mosaic than in some smaller one. */
static double growth_of(const json_t *rows, const char *kind) {
    double least = INFINITY, growth = 1;
    size_t i;
    const json_t *row;
    json_array_foreach(rows, i, row) {
        const double cost = bench_number(json_object_get(row, kind), "ns_a_point");
        if (cost > 0) {
            growth = fmax(growth, cost / least);
            least = fmin(least, cost);
        }
    }
    return growth;
}

static json_t *measure(bench *b, const char *only) {
    static const size_t sizes[] = {10000, 30000, 100000, 300000, 1000000, 3000000, 10000000, 30000000};
    static const size_t counts[] = {8, 5, 2};
    json_t *result = bench_result_new();
    (void)only; /* the curve is one item */
    const bench_yardstick stick = bench_yardstick_measure(b);
    for (size_t i = 0; i < counts[b->size] && city_of(b); i++) {
        json_t *row = measure_size(b, sizes[i]);
        if (row)
            bench_result_add_row(result, row);
        else
            fprintf(stderr, "camber_bench: a mosaic of %zu points could not be drawn\n", sizes[i]);
    }
    const json_t *rows = bench_result_rows(result);
    const json_t *last = json_array_get(rows, json_array_size(rows) - 1);
    static const char *const kinds[] = {"simple", "everything"};
    for (int i = 0; i < 2; i++) {
        const double growth = growth_of(rows, kinds[i]);
        char what[64];
        snprintf(what, sizeof what, "%s_growth", kinds[i]);
        json_object_set_new(result, what, json_real(growth));
        snprintf(what, sizeof what, "frame of the largest%s", i == 0 ? " at 0.1 px" : "");
        const double frame_ms = bench_number(json_object_get(last, kinds[i]), "frame_ms");
        bench_result_add_figure(result, &(bench_figure){"all", what, stick.name, stick.ms / frame_ms, false});
    }
    const double bytes = bench_number(last, "peak_bytes") / bench_number(last, "points");
    bench_result_add_figure(result, &(bench_figure){"all", "peak bytes a point of the largest", NULL, bytes, true});
    return result;
}

static void print_cost(const json_t *cost, FILE *to) {
    fprintf(to, " | %9.1f %9.1f %8.1f %8.1f", bench_number(cost, "frame_ms"), bench_number(cost, "draw_ms"),
            bench_number(cost, "tessellate_ms"), bench_number(cost, "ns_a_point"));
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to,
            "Mosaic of copies of %s, %d x %d px, lines %g px wide, ms; a process a size. ns/point: of the frame, less "
            "that of an\n"
            "empty picture. Peak: resident memory of the process, drivers and input included.\n\n"
            "%9s | %9s %9s %8s %8s | %9s %9s %8s %8s | %8s %8s\n%9s | %37s | %37s | %8s %8s\n",
            bench_text(json_array_get(bench_result_rows(result), 0), "city"), BENCH_SIDE_PX, BENCH_SIDE_PX,
            (double)WIDTH_PX, "points", "frame", "draw", "tess.", "ns/point", "frame", "draw", "tess.", "ns/point",
            "peak MB", "B/point", "", "at 0.1 px", "everything", "0.1 px", "");
    json_array_foreach(bench_result_rows(result), i, row) {
        const double points = bench_number(row, "points"), peak = bench_number(row, "peak_bytes");
        fprintf(to, "%9.0f", points);
        print_cost(json_object_get(row, "simple"), to);
        print_cost(json_object_get(row, "everything"), to);
        fprintf(to, " | %8.0f %8.0f\n", peak / 1e6, peak / points);
    }
    fprintf(to, "A point costs at most %.2f times (everything: %.2f times) what it costs in any smaller mosaic.\n",
            bench_number(result, "simple_growth"), bench_number(result, "everything_growth"));
}

const bench_section bench_section_mosaic = {"mosaic", measure, print};
