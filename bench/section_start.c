/* Start-up of the tool as a whole, with empty caches and with what runs left in them, and reading, beside what OGR
 * takes to copy the same file. */
#define _XOPEN_SOURCE 700 /* mkdtemp */

#include "bench.h"

#include "base/base.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Start-up ---- */

typedef struct errand {
    const char *key, *name;
    const char *arguments[9]; /* behind the tool */
} errand;

static double run_errand(const bench *b, const errand *e, const char *folder) {
    const char *arguments[11] = {b->tool};
    for (size_t i = 0; e->arguments[i]; i++)
        arguments[i + 1] = e->arguments[i];
    bench_child child = bench_child_run(arguments, folder, NULL);
    free(child.output);
    return child.status == 0 ? child.wall_ms : -1;
}

static void measure_errand(const bench *b, const errand *e, const bench_yardstick *stick, json_t *result) {
    char folder[] = "/tmp/camber_bench.XXXXXX";
    if (!mkdtemp(folder))
        return;
    bench_series warm = {.count = 0};
    const double cold_ms = run_errand(b, e, folder);
    for (size_t run = 0; run < b->runs + 1; run++) {
        const double ms = run_errand(b, e, folder);
        if (ms > 0 && run > 0) /* the second run may still fill caches */
            bench_series_add(&warm, ms);
    }
    const char *const arguments[] = {"rm", "-rf", folder, NULL};
    free(bench_child_run(arguments, NULL, NULL).output);
    if (cold_ms < 0 || warm.count == 0) {
        fprintf(stderr, "camber_bench: %s %s fails\n", b->tool, e->arguments[0]);
        return;
    }
    const double warm_ms = bench_series_median(&warm);
    bench_result_add_row(result, json_pack("{s:s, s:s, s:o, s:o}", "key", e->key, "name", e->name, "cold_ms",
                                           bench_ms(cold_ms), "warm_ms", bench_ms(warm_ms)));
    bench_result_add_figure(result, &(bench_figure){e->key, "warm", stick->name, stick->ms / warm_ms, false});
}

/* Some streets, as GeoJSON. */
static bool write_small_map(const char *path) {
    FILE *file = fopen(path, "w");
    if (!file)
        return false;
    fputs("{\"type\":\"FeatureCollection\",\"features\":[", file);
    for (int i = 0; i < 40; i++) {
        const double at = 0.0005 * (i / 2), from = 0, to = 0.01;
        fprintf(file,
                "%s{\"type\":\"Feature\",\"properties\":{\"highway\":\"%s\"},\"geometry\":{\"type\":\"LineString\","
                "\"coordinates\":[[%.6f,%.6f],[%.6f,%.6f]]}}",
                i ? "," : "", i % 5 ? "residential" : "primary", i % 2 ? at : from, i % 2 ? from : at, i % 2 ? at : to,
                i % 2 ? to : at);
    }
    fputs("]}\n", file);
    return fclose(file) == 0;
}

static void measure_starts(bench *b, const char *only, json_t *result) {
    char folder[] = "/tmp/camber_bench.XXXXXX", map[64], picture[64];
    if (!mkdtemp(folder))
        return;
    snprintf(map, sizeof map, "%s/map.geojson", folder);
    snprintf(picture, sizeof picture, "%s/map.png", folder);
    const bench_yardstick stick = bench_yardstick_measure(b);
    const errand errands[] = {
        {"info", "camber info", {"info", "-q", NULL}},
        {"render_small", "camber render of 40 streets", {"render", "-q", "-f", map, "-o", picture, NULL}},
        {"render_gl", "  drawn in GL", {"render", "-q", "-f", map, "-o", picture, "--draw", "gl", NULL}},
        {"render_cl", "  in OpenCL, no GL", {"render", "-q", "-f", map, "-o", picture, "--draw", "cl", NULL}},
        {"render_city", "camber render of Santa Cruz", {"render", "-q", "-f", CAMBER_DEMO_CITY, "-o", picture, NULL}},
    };
    if (write_small_map(map))
        for (size_t i = 0; i < (b->size == BENCH_TINY ? 1 : sizeof errands / sizeof *errands); i++)
            if (!only || strcmp(only, errands[i].key) == 0)
                measure_errand(b, errands + i, &stick, result);
    remove(map);
    remove(picture);
    rmdir(folder);
}

/* ---- Reading ---- */

#ifdef CAMBER_MAP

#include "camber_map.h"

#include <gdal_utils.h>

/* The results of reading a file, and how long its parts took. */
typedef struct reading {
    camber_features_stats stats;
    camber_features_times times;
} reading;

static double read_ms(bench *b, const char *path, reading *read) {
    camber_style *style = NULL;
    camber_features *features = NULL;
    camber_status status = camber_style_create_builtin(b->context, CAMBER_THEME_LIGHT, &style);
    if (status == CAMBER_OK)
        status = camber_features_create(b->context, style, &features);
    const double begin = camber_now_ms();
    if (status == CAMBER_OK)
        status = camber_features_read(features, &(camber_source_desc){.path = path});
    const double ms = camber_now_ms() - begin;
    if (status == CAMBER_OK)
        *read = (reading){camber_features_get_stats(features), camber_features_get_times(features)};
    camber_features_destroy(features);
    camber_style_destroy(style);
    return status == CAMBER_OK ? ms : -1;
}

/* OGR's own copy of all lines of the file to FlatGeobuf, in memory. */
static double copy_ms(const char *path, bool osm) {
    char form[] = "-f", fgb[] = "FlatGeobuf", skip[] = "-skipfailures", type[] = "-nlt", any[] = "GEOMETRY",
         lines[] = "lines", roads[] = "roads";
    char *arguments[] = {form, fgb, skip, type, any, osm ? lines : roads, NULL};
    const char *const to = "/vsimem/camber_bench.fgb";
    GDALVectorTranslateOptions *options = GDALVectorTranslateOptionsNew(arguments, NULL);
    CPLPushErrorHandler(CPLQuietErrorHandler);
    const double begin = camber_now_ms();
    GDALDatasetH from = GDALOpenEx(path, GDAL_OF_VECTOR, NULL, NULL, NULL);
    GDALDatasetH made = from ? GDALVectorTranslate(to, NULL, 1, &from, options, NULL) : NULL;
    if (made)
        GDALClose(made);
    const double ms = camber_now_ms() - begin;
    if (from)
        GDALClose(from);
    CPLPopErrorHandler();
    GDALVectorTranslateOptionsFree(options);
    VSIUnlink(to);
    return made ? ms : -1;
}

static void measure_reading(bench *b, const char *key, const char *name, json_t *result) {
    char path[1024];
    bench_series ours = {.count = 0}, theirs = {.count = 0};
    reading last = {0};
    if (!bench_scene_path(b, key, path, sizeof path))
        return;
    GDALAllRegister();
    for (size_t run = 0; run <= b->runs; run++) {
        const double read = read_ms(b, path, &last), copied = copy_ms(path, strstr(path, ".pbf") != NULL);
        if (run == 0 || read < 0) /* the first takes the file from the disk */
            continue;
        bench_series_add(&ours, read);
        if (copied > 0)
            bench_series_add(&theirs, copied);
    }
    if (ours.count == 0)
        return;
    const double ms = bench_series_median(&ours), ogr_ms = bench_series_median(&theirs);
    const json_int_t points = (json_int_t)last.stats.points, polylines = (json_int_t)last.stats.polylines;
    bench_result_add_row(result, json_pack("{s:s, s:s, s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:f}", "key", key, "reading",
                                           name, "points", points, "polylines", polylines, "merged_polylines",
                                           (json_int_t)last.stats.merged_polylines, "read_ms", bench_ms(ms), "merge_ms",
                                           bench_ms(last.times.merge_ms), "weigh_ms", bench_ms(last.times.weigh_ms),
                                           "ogr_ms", bench_ms(ogr_ms), "m_points_s", (double)points / ms / 1e3));
    bench_result_add_figure(result, &(bench_figure){key, "reading", "OGR's copy", ogr_ms / ms, false});
}

#else

static void measure_reading(bench *b, const char *key, const char *name, json_t *result) {
    (void)b;
    (void)key;
    (void)name;
    (void)result;
}

#endif

static json_t *measure(bench *b, const char *only) {
    static const char *const cities[][2] = {{"porto", "Porto"}, {"santa_cruz", "Santa Cruz"}};
    json_t *result = bench_result_new();
    measure_starts(b, only, result);
    for (size_t i = 0; i < 2 && b->size != BENCH_TINY; i++)
        if (!only || strcmp(only, cities[i][0]) == 0)
            measure_reading(b, cities[i][0], cities[i][1], result);
    return result;
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to, "Start-up, wall time of the whole program, ms: with empty caches, and after that.\n\n");
    json_array_foreach(bench_result_rows(result), i, row) if (*bench_text(row, "name"))
        fprintf(to, "%-30s cold %8.0f   warm %8.0f\n", bench_text(row, "name"), bench_number(row, "cold_ms"),
                bench_number(row, "warm_ms"));
    const json_t *last = json_array_get(bench_result_rows(result), json_array_size(bench_result_rows(result)) - 1);
    if (!*bench_text(last, "reading"))
        return;
    fprintf(to, "\nReading, from the file to points in world coordinates and their attributes; beside it OGR's own "
                "copy of the file's lines\n"
                "to FlatGeobuf in memory.\n\n");
    json_array_foreach(bench_result_rows(result), i, row) if (*bench_text(row, "reading")) fprintf(
        to,
        "%-30s %8.0f ms, %.1f M points/s (%.0f ms merge %.0f lines to %.0f, %.0f ms weigh points); OGR %8.0f ms, "
        "%.2f times as long\n",
        bench_text(row, "reading"), bench_number(row, "read_ms"), bench_number(row, "m_points_s"),
        bench_number(row, "merge_ms"), bench_number(row, "polylines") + bench_number(row, "merged_polylines"),
        bench_number(row, "polylines"), bench_number(row, "weigh_ms"), bench_number(row, "ogr_ms"),
        bench_number(row, "ogr_ms") / bench_number(row, "read_ms"));
}

const bench_section bench_section_start = {"start", measure, print};
