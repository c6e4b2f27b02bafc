/* camber serve under load beside Debian's mod_tile and renderd, which draw the same lines in the same widths and
 * colours, without labels and with them, and the same areas; what it has in memory after many requests, and how soon it
 * answers. peers/serve_load.py drives all of it. */
#include "bench.h"
#include "pyramid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *when, *name, *name_behind;
} news[] = {{"first", "the first tiles", "the first tiles by mod_tile"}, {"all", "all tiles", "all tiles by mod_tile"}};

static json_t *load(bench *b, const bench_pyramid *p, const char *what) {
    static const char program[] = CAMBER_BENCH_PEERS "/serve_load.py", *const seconds[] = {"15", "3", "1"};
    char xml[128], start[1024] = "";
    (void)bench_scene_path(b, "nyc", start, sizeof start);
    snprintf(xml, sizeof xml, "%s/shape.xml", p->folder);
    const char *const arguments[] = {"python3", program,          p->folder, b->tool, p->city, p->style,
                                     xml,       seconds[b->size], start,     what,    NULL};
    const bench_child child = bench_child_run(arguments, NULL, NULL);
    json_t *said = child.status == 0 && child.output ? json_loads(child.output, 0, NULL) : NULL;
    free(child.output);
    if (!said && child.status != 77)
        fprintf(stderr, "%s: exit status %d\n", program, child.status);
    return said;
}

static double number_of(const json_t *row, const char *way, const char *when, const char *key) {
    return bench_number(json_object_get(json_object_get(row, way), when), key);
}

static void add_figure(json_t *result, const json_t *row, const char *what, const char *against, double value,
                       bool less) {
    if (isfinite(value) && value > 0)
        bench_result_add_figure(result, &(bench_figure){bench_text(row, "key"), what, against, value, less});
}

static void add_row(json_t *result, json_t *row, const char *key, const char *name) {
    const json_t *memory = json_object_get(row, "memory");
    json_object_set_new(row, "key", json_string(key));
    json_object_set_new(row, "name", json_string(name));
    for (size_t i = 0; i < sizeof news / sizeof *news; i++) {
        const double renderd = number_of(row, "renderd", news[i].when, "a_second");
        add_figure(result, row, news[i].name, "mod_tile and renderd",
                   number_of(row, "camber", news[i].when, "a_second") / renderd, false);
        add_figure(result, row, news[i].name_behind, "renderd",
                   number_of(row, "behind", news[i].when, "a_second") / renderd, false);
    }
    add_figure(result, row, "tiles from memory", "mod_tile",
               number_of(row, "camber", "cached", "a_second") / number_of(row, "renderd", "cached", "a_second"), false);
    add_figure(result, row, "memory after 10^6 requests", "10^4",
               bench_number(memory, "many_bytes") / bench_number(memory, "few_bytes"), true);
    bench_result_add_row(result, row);
}

/* what: the measurements, as peers/serve_load.py names them. */
static void measure_map(bench *b, json_t *result, bool labelled, const char *what) {
    bench_pyramid p = {.min_zoom = 12, .max_zoom = 16, .labelled = labelled};
    if (!bench_scene_path(b, "porto", p.city, sizeof p.city) || !bench_pyramid_open(&p))
        return;
    if (b->size != BENCH_TINY)
        (void)bench_pyramid_write_maps(&p); /* else there is no peer */
    json_t *row = load(b, &p, b->size == BENCH_TINY ? "camber" : what);
    if (row)
        add_row(result, row, labelled ? "porto_labels" : "porto", labelled ? "Porto with labels" : "Porto");
    bench_pyramid_close(&p);
}

static json_t *measure(bench *b, const char *only) {
    json_t *result = bench_result_new();
    if (!only || strcmp(only, "porto") == 0)
        measure_map(b, result, false, "camber,behind,renderd,memory,start");
    if (!only || strcmp(only, "porto_labels") == 0)
        measure_map(b, result, true, "camber,renderd");
    return result;
}

static void print_load(const json_t *row, const char *way, const char *when, const char *name, FILE *to) {
    if (number_of(row, way, when, "a_second") > 0)
        fprintf(to,
                "  %-40s %7.0f a second, %7.2f ms in the middle, %7.2f ms at 99 %%, %.2f ms of processors, %.0f "
                "failed\n",
                name, number_of(row, way, when, "a_second"), number_of(row, way, when, "p50_ms"),
                number_of(row, way, when, "p99_ms"), number_of(row, way, when, "cpu_ms"),
                number_of(row, way, when, "failed"));
}

static void print_row(const json_t *row, FILE *to) {
    const json_t *memory = json_object_get(row, "memory"), *start = json_object_get(row, "start");
    fprintf(to, "\nTiles of %s over HTTP, by wrk -t2 -c16 on the same processors\n", bench_text(row, "name"));
    for (size_t i = 0; i < sizeof news / sizeof *news; i++) {
        char names[3][64];
        snprintf(names[0], sizeof names[0], "camber, %s", news[i].name);
        snprintf(names[1], sizeof names[1], "mod_tile and camber, %s", news[i].name);
        snprintf(names[2], sizeof names[2], "mod_tile and renderd, %s", news[i].name);
        print_load(row, "camber", news[i].when, names[0], to);
        print_load(row, "behind", news[i].when, names[1], to);
        print_load(row, "renderd", news[i].when, names[2], to);
    }
    print_load(row, "camber", "cached", "camber, from memory", to);
    print_load(row, "renderd", "cached", "mod_tile, from its folder", to);
    print_load(row, "camber", "known", "camber, not modified", to);
    if (memory)
        fprintf(to, "  memory after %.0f requests %.1f MB, after %.0f %.1f MB\n", bench_number(memory, "few_requests"),
                bench_number(memory, "few_bytes") / 1e6, bench_number(memory, "many_requests"),
                bench_number(memory, "many_bytes") / 1e6);
    if (start)
        fprintf(to, "  the first tile of New York is there %.0f ms after the start, %.0f ms at most\n",
                bench_number(start, "median_ms"), bench_number(start, "most_ms"));
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    json_array_foreach(bench_result_rows(result), i, row) print_row(row, to);
}

const bench_section bench_section_serve = {"serve", measure, print};
