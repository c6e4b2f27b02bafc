/* Reading OpenStreetMap's PBF files: points of lines a second, beside GDAL's reader in camber and beside libosmium in
 * this process, which finds the same lines' places and copies their tags. A city, and a country that camber_country
 * makes up. The same country as FlatGeobuf: the view of a city by the file's index, beside all of it. */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

#ifdef CAMBER_MAP

#include "camber_map.h"
#include "peers/osmium.h"

typedef struct subject {
    const char *key, *name;
    char path[1024];
} subject;

/* Reads a file, and gives the time; below 0: it does not read. by_gdal: by a path that camber's own reader does not
 * know. */
static double file_ms(bench *b, const char *path, bool by_gdal, size_t *points) {
    char behind[1100];
    camber_style *style = NULL;
    camber_features *features = NULL;
    double ms = -1;
    snprintf(behind, sizeof behind, "%s%s", by_gdal ? "/vsisubfile/0_1099511627776," : "", path);
    camber_status status = camber_style_create_builtin(b->context, CAMBER_THEME_LIGHT, &style);
    if (status == CAMBER_OK)
        status = camber_features_create(b->context, style, &features);
    if (status == CAMBER_OK)
        status = camber_features_read(features, &(camber_source_desc){.path = behind, .keep_apart = true});
    if (status == CAMBER_OK) {
        ms = camber_features_get_times(features).file_ms;
        *points = camber_features_get_stats(features).points;
    }
    camber_features_destroy(features);
    camber_style_destroy(style);
    return ms;
}

/* The lines that the built-in style draws. */
static double osmium_ms(const char *path, size_t *points) {
#ifdef CAMBER_BENCH_OSMIUM
    static const char *const keys[] = {"highway", "railway", "waterway"};
    return bench_osmium_read(path, keys, sizeof keys / sizeof *keys, points);
#else
    (void)path;
    *points = 0;
    return -1;
#endif
}

static void measure_subject(bench *b, const subject *s, json_t *result) {
    bench_series ours = {.count = 0}, gdals = {.count = 0}, osmiums = {.count = 0};
    size_t points = 0, theirs = 0, osmium_points = 0;
    for (size_t run = 0; run <= b->runs; run++) {
        const double mine = file_ms(b, s->path, false, &points), gdal = file_ms(b, s->path, true, &theirs),
                     osmium = osmium_ms(s->path, &osmium_points);
        if (run == 0 || mine < 0 || gdal < 0) /* the first takes the file from the disk */
            continue;
        bench_series_add(&ours, mine);
        bench_series_add(&gdals, gdal);
        if (osmium > 0)
            bench_series_add(&osmiums, osmium);
    }
    if (ours.count == 0 || points != theirs)
        return;
    const double ms = bench_series_median(&ours), gdal_ms = bench_series_median(&gdals),
                 osmium = osmiums.count ? bench_series_median(&osmiums) : 0;
    bench_result_add_row(result,
                         json_pack("{s:s, s:s, s:I, s:I, s:o, s:o, s:o}", "key", s->key, "name", s->name, "points",
                                   (json_int_t)points, "osmium_points", (json_int_t)osmium_points, "file_ms",
                                   bench_ms(ms), "ogr_ms", bench_ms(gdal_ms), "osmium_ms", bench_ms(osmium)));
    bench_result_add_figure(result, &(bench_figure){s->key, "reading lines", "OGR", gdal_ms / ms, false});
    bench_result_add_figure(result, &(bench_figure){s->key, "reading lines", "libosmium", osmium / ms, false});
}

/* ---- By an index ---- */

/* Lies in the country's first city, in its south-west. */
static const camber_scene_desc view_of_city = {
    .view =
        {.kind = CAMBER_VIEW_CENTER, .longitude = -19.8, .latitude = 20.1, .zoom = 12.0, .width = 1024, .height = 1024},
    .simplify_px = BENCH_SIMPLIFY_PX};

/* Reads a file for a view, or all of it, and gives the time with that of merging and weighing; below 0: it does not
 * read. */
static double seen_ms(bench *b, const char *path, const camber_scene_desc *seen, size_t *points) {
    camber_style *style = NULL;
    camber_features *features = NULL;
    double ms = -1;
    camber_status status = camber_style_create_builtin(b->context, CAMBER_THEME_LIGHT, &style);
    if (status == CAMBER_OK)
        status = camber_features_create(b->context, style, &features);
    if (status == CAMBER_OK)
        status = camber_features_read_for(features, seen);
    if (status == CAMBER_OK)
        status = camber_features_read(features, &(camber_source_desc){.path = path});
    if (status == CAMBER_OK) {
        const camber_features_times times = camber_features_get_times(features);
        ms = times.file_ms + times.merge_ms + times.weigh_ms;
        *points = camber_features_get_stats(features).points;
    }
    camber_features_destroy(features);
    camber_style_destroy(style);
    return ms;
}

static void measure_view(bench *b, const subject *s, json_t *result) {
    bench_series views = {.count = 0}, wholes = {.count = 0};
    size_t points = 0, all = 0;
    for (size_t run = 0; run <= b->runs; run++) {
        const double view = seen_ms(b, s->path, &view_of_city, &points), whole = seen_ms(b, s->path, NULL, &all);
        if (run == 0 || view < 0 || whole < 0) /* the first takes the file from the disk */
            continue;
        bench_series_add(&views, view);
        bench_series_add(&wholes, whole);
    }
    if (views.count == 0 || points == 0)
        return;
    const double ms = bench_series_median(&views), whole_ms = bench_series_median(&wholes);
    bench_result_add_row(result, json_pack("{s:s, s:s, s:I, s:I, s:o, s:o}", "key", s->key, "name", s->name, "points",
                                           (json_int_t)points, "all_points", (json_int_t)all, "file_ms", bench_ms(ms),
                                           "whole_ms", bench_ms(whole_ms)));
    bench_result_add_figure(result, &(bench_figure){s->key, "reading a view", "all of the file", whole_ms / ms, false});
}

/* ---- The section ---- */

static json_t *measure(bench *b, const char *only) {
    static const double usual_millions[] = {10, 1, 0.1}; /* by the size of the benchmark */
    json_t *result = bench_result_new();
    subject city = {.key = "porto", .name = "Porto"}, country = {.key = "country", .name = "a made-up country"},
            indexed = {.key = "view", .name = "a view of the country"};
    if ((!only || strcmp(only, city.key) == 0) && bench_scene_path(b, city.key, city.path, sizeof city.path))
        measure_subject(b, &city, result);
    const double millions = b->country_millions > 0 ? b->country_millions : usual_millions[b->size];
    if ((!only || strcmp(only, country.key) == 0) &&
        bench_country_make(b, millions, ".osm.pbf", country.path, sizeof country.path)) {
        measure_subject(b, &country, result);
        remove(country.path);
    }
    if ((!only || strcmp(only, indexed.key) == 0) &&
        bench_country_make(b, millions, ".fgb", indexed.path, sizeof indexed.path)) {
        measure_view(b, &indexed, result);
        remove(indexed.path);
    }
    return result;
}

#else
#define measure NULL
#endif

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to, "Reading PBF files, from the file to points in world coordinates and their attributes; beside it the "
                "same through OGR,\nand by libosmium.\n\n");
    json_array_foreach(bench_result_rows(result), i, row) {
        const double points = bench_number(row, "points"), ms = bench_number(row, "file_ms");
        if (json_object_get(row, "whole_ms")) {
            fprintf(to, "%-20s %6.2f of %.2f M points of a FlatGeobuf %8.0f ms; all of it %5.1f times as long\n",
                    bench_text(row, "name"), points / 1e6, bench_number(row, "all_points") / 1e6, ms,
                    bench_number(row, "whole_ms") / ms);
            continue;
        }
        fprintf(to,
                "%-20s %6.2f M points %8.0f ms, %5.1f M points/s; OGR %5.2f times as long; libosmium %5.2f, of %.2f M "
                "points\n",
                bench_text(row, "name"), points / 1e6, ms, points / ms / 1e3, bench_number(row, "ogr_ms") / ms,
                bench_number(row, "osmium_ms") / ms, bench_number(row, "osmium_points") / 1e6);
    }
}

const bench_section bench_section_read = {"read", measure, print};
