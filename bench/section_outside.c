/* Programs that others run: the Python module beside matplotlib on the same arrays, and the page of camber serve in
 * Chromium. Each is a script of its own; where it lacks something, a line says so. */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

static void leave_out(const char *what, const char *why) {
    printf("%s is left out: %s\n", what, why);
}

/* ---- Python ---- */

/* An interpreter that has both modules, as PYTHONPATH says and then Debian's. NULL: there is none. */
static const char *find_python(void) {
    static const char *const pythons[] = {"python3", "/usr/bin/python3"};
    for (size_t i = 0; i < sizeof pythons / sizeof *pythons; i++) {
        const char *const arguments[] = {pythons[i], "-c",
                                         "import importlib.util, sys\n"
                                         "sys.exit(not all(map(importlib.util.find_spec, ('camber', 'matplotlib'))))",
                                         NULL};
        const bench_child child = bench_child_run(arguments, NULL, NULL);
        free(child.output);
        if (child.status == 0)
            return pythons[i];
    }
    return NULL;
}

static void measure_python(bench *b, json_t *result) {
    char city[1024];
    const char *const python = find_python();
    if (!python || !bench_scene_path(b, "porto", city, sizeof city)) {
        leave_out("Python beside matplotlib",
                  python ? "CAMBER_DATA has no Porto"
                         : "no Python here has the modules camber (pip install, or PYTHONPATH) "
                           "and matplotlib (Debian: python3-matplotlib)");
        return;
    }
    bench_series ours = {.count = 0}, theirs = {.count = 0};
    double difference = 0;
    for (size_t run = 0; run < b->runs; run++) {
        const char *const arguments[] = {python, CAMBER_BENCH_EXAMPLES "/city.py", city, NULL};
        const bench_child child = bench_child_run(arguments, NULL, NULL);
        const char *first = child.output ? strstr(child.output, "camber: ") : NULL;
        const char *second = first ? strstr(first, "matplotlib: ") : NULL;
        double our_ms = 0, their_ms = 0, ratio;
        const bool read = child.status == 0 && second && sscanf(first, "camber: %lf ms", &our_ms) == 1 &&
                          sscanf(second, "matplotlib: %lf ms, %lf times as long; its pixels differ by %lf", &their_ms,
                                 &ratio, &difference) == 3;
        free(child.output);
        if (!read) {
            leave_out("Python beside matplotlib", "examples/city.py fails");
            return;
        }
        bench_series_add(&ours, our_ms);
        bench_series_add(&theirs, their_ms);
    }
    const double ms = bench_series_median(&ours), matplotlib_ms = bench_series_median(&theirs);
    bench_result_add_row(result, json_pack("{s:s, s:s, s:o, s:o, s:f}", "key", "python", "name",
                                           "examples/city.py, Porto", "camber_ms", bench_ms(ms), "matplotlib_ms",
                                           bench_ms(matplotlib_ms), "difference", difference));
    bench_result_add_figure(result,
                            &(bench_figure){"python", "Porto in Python", "matplotlib", matplotlib_ms / ms, false});
}

/* examples/table.py: lines of a GeoDataFrame coloured by a column, in one call. */
static void measure_table(json_t *result) {
    const char *const python = find_python();
    const char *const arguments[] = {python, CAMBER_BENCH_EXAMPLES "/table.py", NULL};
    const bench_child child = python ? bench_child_run(arguments, NULL, NULL) : (bench_child){.status = 1};
    const char *first = child.output ? strstr(child.output, "camber: ") : NULL;
    const char *second = first ? strstr(first, "matplotlib: ") : NULL;
    const char *third = second ? strstr(second, "datashader: ") : NULL;
    const char *density = first ? strstr(first, "density: ") : NULL;
    double our_ms = 0, their_ms = 0, shader_ms = 0, density_ms = 0;
    const bool read = child.status == 0 && second && sscanf(first, "camber: %lf ms", &our_ms) == 1 &&
                      sscanf(second, "matplotlib: %lf ms", &their_ms) == 1;
    if (third)
        (void)sscanf(third, "datashader: %lf ms", &shader_ms); /* 0: it is not there */
    if (density)
        (void)sscanf(density, "density: %lf ms", &density_ms);
    free(child.output);
    if (!read) {
        leave_out("a GeoDataFrame beside matplotlib", "Python here has no geopandas, or examples/table.py fails");
        return;
    }
    bench_result_add_row(result, json_pack("{s:s, s:s, s:o, s:o, s:o, s:o}", "key", "table", "name",
                                           "500,000 lines of a GeoDataFrame by a column", "camber_ms", bench_ms(our_ms),
                                           "matplotlib_ms", bench_ms(their_ms), "datashader_ms", bench_ms(shader_ms),
                                           "density_ms", bench_ms(density_ms)));
    bench_result_add_figure(result, &(bench_figure){"table", "GeoDataFrame", "matplotlib", their_ms / our_ms, false});
}

/* ---- The page ---- */

static void measure_page(bench *b, json_t *result) {
    static const char program[] = CAMBER_BENCH_PEERS "/page_drags.mjs", modules[] = "NODE_PATH=" CAMBER_BENCH_NPM;
    char city[1024];
    if (!bench_scene_path(b, "porto", city, sizeof city)) {
        leave_out("the page of camber serve", "CAMBER_DATA has no Porto");
        return;
    }
    const char *const arguments[] = {"env", modules, "node", program, b->tool, city, NULL};
    const bench_yardstick stick = bench_yardstick_measure(b);
    const bench_child child = bench_child_run(arguments, NULL, NULL);
    json_t *row = child.status == 0 && child.output ? json_loads(child.output, 0, NULL) : NULL;
    if (!row)
        leave_out("the page of camber serve", child.output && *child.output ? child.output : "node does not run it");
    free(child.output);
    if (!row)
        return;
    json_object_set_new(row, "key", json_string("page"));
    json_object_set_new(row, "name", json_string("tiles on the screen after a drag, Porto"));
    bench_result_add_figure(
        result, &(bench_figure){"page", "95 of 100 drags", stick.name, stick.ms / bench_number(row, "late_ms"), false});
    bench_result_add_row(result, row);
}

/* ---- Both ---- */

static json_t *measure(bench *b, const char *only) {
    json_t *result = bench_result_new();
    if (b->size != BENCH_TINY && (!only || strcmp(only, "python") == 0))
        measure_python(b, result);
    if (b->size != BENCH_TINY && (!only || strcmp(only, "table") == 0))
        measure_table(result);
    if (b->size != BENCH_TINY && (!only || strcmp(only, "page") == 0))
        measure_page(b, result);
    return result;
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to, "From outside: the Python module, and the page of camber serve in Chromium.\n\n");
    json_array_foreach(bench_result_rows(result), i, row) {
        if (strcmp(bench_text(row, "key"), "python") == 0)
            fprintf(to, "%s: camber %.1f ms, matplotlib %.1f ms, %.1f times as long; pixels differ by %.2f of 255\n",
                    bench_text(row, "name"), bench_number(row, "camber_ms"), bench_number(row, "matplotlib_ms"),
                    bench_number(row, "matplotlib_ms") / bench_number(row, "camber_ms"),
                    bench_number(row, "difference"));
        else if (strcmp(bench_text(row, "key"), "table") == 0)
            fprintf(
                to,
                "%s: camber %.0f ms, matplotlib %.0f ms, datashader %.0f ms (0: not installed); density of 10 million "
                "points %.0f ms\n",
                bench_text(row, "name"), bench_number(row, "camber_ms"), bench_number(row, "matplotlib_ms"),
                bench_number(row, "datashader_ms"), bench_number(row, "density_ms"));
        else
            fprintf(to, "%s: %.0f ms in the middle, %.0f ms for 95 of 100, %.0f ms at most, of %.0f drags\n",
                    bench_text(row, "name"), bench_number(row, "median_ms"), bench_number(row, "late_ms"),
                    bench_number(row, "most_ms"), bench_number(row, "drags"));
    }
}

const bench_section bench_section_outside = {"outside", measure, print};
