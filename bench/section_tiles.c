/* Pyramids of tiles: cities beside Mapnik and renderd, which draw the same lines in the same widths and colours, and
 * one with the same areas and names, too; a made-up country with labels and without; and shards of one. For all of them
 * the clock starts when the map is loaded, and stops when the last tile is on the disk; camber's whole process is told
 * as well. Shards are whole processes. Tiles are those that camber's archive has. */
#include "bench.h"
#include "pyramid.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TILES_RUNS_MAX = 3, SHARDS = 16 };

/* ---- Cities ---- */

typedef enum way {
    WAY_PNG,
    WAY_PNG8,
    WAY_ONE_THREAD,
    WAY_MESH,
    WAY_MAPNIK,
    WAY_MAPNIK8,
    WAY_RENDERD,
    WAYS,
} way;

static const struct {
    const char *key, *name;
    const char *options[5]; /* of camber; of a peer its format */
} ways[WAYS] = {
    [WAY_PNG] = {"png", "camber, png", {"--threads", "2", NULL}},
    [WAY_PNG8] = {"png8", "camber, png8", {"--threads", "2", "--format", "png8", NULL}},
    [WAY_ONE_THREAD] = {"png_1", "camber, png, one thread", {"--threads", "1", NULL}},
    [WAY_MESH] = {"mesh", "camber, mesh tiles", {"--threads", "2", "--format", "glb", NULL}},
    [WAY_MAPNIK] = {"mapnik", "Mapnik, png32:z=1", {"png32:z=1"}},
    [WAY_MAPNIK8] = {"mapnik_png8", "Mapnik, png8:z=1", {"png8:z=1"}},
    [WAY_RENDERD] = {"renderd", "renderd, png32:z=1", {"png32:z=1"}},
};

typedef struct city_times {
    bench_series ms[WAYS], loading, encoding; /* encoding: its share of the processors' time */
    double tiles, mapnik_tiles, bytes[WAYS];  /* Mapnik has encoded so many */
    char version[64];                         /* of Mapnik; "": it is not here */
} city_times;

static double run_camber(const bench *b, const bench_pyramid *p, way by, city_times *times) {
    char name[64];
    snprintf(name, sizeof name, "%s.pmtiles", ways[by].key);
    json_t *said = bench_pyramid_draw(b, p, name, ways[by].options);
    if (!said)
        return -1;
    const double load_ms = bench_number(said, "load_ms"), ms = bench_number(said, "wall_ms") - load_ms;
    if (by == WAY_PNG) {
        bench_series_add(&times->encoding, bench_number(said, "encode_cpu_ms") / bench_number(said, "cpu_ms"));
        bench_series_add(&times->loading, load_ms);
    }
    const double tiles = bench_number(said, "tiles");
    times->tiles = by == WAY_MESH ? times->tiles : tiles; /* one that background covers to the last is none of them */
    times->bytes[by] = bench_number(said, "bytes") / tiles;
    json_decref(said);
    return ms;
}

static double run_peer(const bench_pyramid *p, way by, size_t runs, city_times *times) {
    const char *format = ways[by].options[0];
    json_t *said = by == WAY_RENDERD ? bench_pyramid_renderd(p, format) : bench_pyramid_mapnik(p, format, runs);
    if (!said)
        return -1;
    const double ms = bench_number(said, "ms");
    if (by != WAY_RENDERD) {
        times->mapnik_tiles = bench_number(said, "tiles");
        times->bytes[by] = bench_number(said, "bytes") / times->mapnik_tiles;
        snprintf(times->version, sizeof times->version, "%s", bench_text(said, "version"));
    }
    json_decref(said);
    return ms;
}

/* The bounds that the archive tells, for peers that draw a box. */
static bool read_box(const bench *b, bench_pyramid *p) {
    char path[128];
    snprintf(path, sizeof path, "%s/png.pmtiles", p->folder);
    const char *const arguments[] = {b->tool, "tiles", "show", path, "--json", NULL};
    const bench_child child = bench_child_run(arguments, NULL, NULL);
    json_t *said = child.output ? json_loads(child.output, 0, NULL) : NULL;
    const json_t *bounds = json_object_get(said, "bounds");
    const bool known = json_array_size(bounds) == 4;
    for (size_t i = 0; i < 4 && known; i++)
        p->box[i] = json_number_value(json_array_get(bounds, i));
    free(child.output);
    json_decref(said);
    return known;
}

static bool measure_ways(bench *b, bench_pyramid *p, city_times *times) {
    const size_t runs = b->runs < TILES_RUNS_MAX ? b->runs : TILES_RUNS_MAX;
    if (run_camber(b, p, WAY_PNG, times) < 0 || !read_box(b, p)) /* and the file comes from the disk */
        return false;
    times->encoding.count = times->loading.count = 0;
    const bool peers = b->size != BENCH_TINY && bench_pyramid_write_maps(p);
    for (size_t run = 0; run < runs; run++)
        for (int by = 0; by < WAYS; by++) {
            if (by >= WAY_MAPNIK && (!peers || run > 0)) /* these repeat it themselves */
                continue;
            const double ms = by < WAY_MAPNIK ? run_camber(b, p, (way)by, times) : run_peer(p, (way)by, runs, times);
            if (ms < 0 && by < WAY_MESH) /* a build may be without mesh tiles */
                return false;
            if (ms > 0)
                bench_series_add(&times->ms[by], ms);
        }
    return true;
}

static void add_ratio(json_t *result, const char *item, const char *what, const char *against, double value) {
    bench_result_add_figure(result, &(bench_figure){item, what, against, value, false});
}

static void add_city(const char *key, const char *name, const bench_pyramid *p, const city_times *times,
                     json_t *result) {
    double ms[WAYS];
    json_t *row = json_pack("{s:s, s:s, s:i, s:i, s:f, s:f, s:f, s:o, s:s}", "key", key, "name", name, "min_zoom",
                            p->min_zoom, "max_zoom", p->max_zoom, "tiles", times->tiles, "mapnik_tiles",
                            times->mapnik_tiles, "encoding_share", bench_series_median(&times->encoding), "load_ms",
                            bench_ms(bench_series_median(&times->loading)), "mapnik", times->version);
    for (int by = 0; by < WAYS; by++) {
        char field[64];
        ms[by] = bench_series_median(&times->ms[by]);
        if (ms[by] <= 0)
            continue;
        snprintf(field, sizeof field, "%s_ms", ways[by].key);
        json_object_set_new(row, field, bench_ms(ms[by]));
        snprintf(field, sizeof field, "%s_bytes", ways[by].key);
        if (times->bytes[by] > 0)
            json_object_set_new(row, field, json_integer((json_int_t)times->bytes[by]));
    }
    bench_result_add_row(result, row);
    add_ratio(result, key, "tiles, png", "Mapnik, png32:z=1", ms[WAY_MAPNIK] / ms[WAY_PNG]);
    add_ratio(result, key, "tiles, png8", "Mapnik, png8:z=1", ms[WAY_MAPNIK8] / ms[WAY_PNG8]);
    add_ratio(result, key, "tiles, png", "renderd", ms[WAY_RENDERD] / ms[WAY_PNG]);
    add_ratio(result, key, "tiles of two threads", "one", ms[WAY_ONE_THREAD] / ms[WAY_PNG]);
    add_ratio(result, key, "mesh tiles", "tiles, png", ms[WAY_PNG] / ms[WAY_MESH]);
    if (times->bytes[WAY_MAPNIK8] > 0)
        bench_result_add_figure(result, &(bench_figure){key, "bytes of png8", "Mapnik, png8",
                                                        times->bytes[WAY_PNG8] / times->bytes[WAY_MAPNIK8], true});
    bench_result_add_figure(
        result, &(bench_figure){key, "encoding", "all processors' time", bench_series_median(&times->encoding), true});
}

static bool measure_city(bench *b, const char *key, const char *name, json_t *result) {
    static const int deepest[] = {16, 14, 11}; /* by the size of the benchmark */
    bench_pyramid p = {.min_zoom = 10, .max_zoom = deepest[b->size]};
    city_times times = {.tiles = 0};
    if (!bench_scene_path(b, key, p.city, sizeof p.city))
        return true;
    const bool done = bench_pyramid_open(&p) && measure_ways(b, &p, &times);
    if (done)
        add_city(key, name, &p, &times, result);
    bench_pyramid_close(&p);
    return done;
}

/* ---- Labels ---- */

/* Tiles with labels. cpu_ms: of all processors, which is what counts if others use them. */
typedef enum label_way {
    LABELS_CITY,
    LABELS_CITY_BARE,
    LABELS_SAME,
    LABELS_SAME_BARE,
    LABELS_MAPNIK,
    LABELS_RENDERD,
    LABEL_WAYS,
} label_way;

static const struct {
    const char *key, *name;
} label_ways[LABEL_WAYS] = {
    [LABELS_CITY] = {"city", "camber, style city"},       [LABELS_CITY_BARE] = {"city_bare", "the same without labels"},
    [LABELS_SAME] = {"same", "camber, the peers' style"}, [LABELS_SAME_BARE] = {"same_bare", "the same without labels"},
    [LABELS_MAPNIK] = {"mapnik", "Mapnik, png32:z=1"},    [LABELS_RENDERD] = {"renderd", "renderd, png32:z=1"},
};

typedef struct label_times {
    bench_series ms[LABEL_WAYS], cpu_ms[LABEL_WAYS];
    double tiles[LABEL_WAYS];
} label_times;

static json_t *run_labelled(const bench *b, bench_pyramid *p, label_way by) {
    static const char *const with[] = {"--threads", "2", NULL}, *const without[] = {"--threads", "2", "--no-labels",
                                                                                    NULL};
    if (by == LABELS_MAPNIK)
        return bench_pyramid_mapnik(p, "png32:z=1", 1);
    if (by == LABELS_RENDERD)
        return bench_pyramid_renderd(p, "png32:z=1");
    bench_pyramid own = *p;
    if (by <= LABELS_CITY_BARE)
        snprintf(own.style, sizeof own.style, "city");
    json_t *said = bench_pyramid_draw(b, &own, "png.pmtiles", by == LABELS_CITY || by == LABELS_SAME ? with : without);
    if (said) /* as peers measure it: from the loaded map on */
        json_object_set_new(said, "ms", json_real(bench_number(said, "wall_ms") - bench_number(said, "load_ms")));
    return said;
}

static bool measure_label_ways(bench *b, bench_pyramid *p, label_times *times, const label_way *of, size_t count) {
    const size_t runs = b->runs < TILES_RUNS_MAX ? b->runs : TILES_RUNS_MAX;
    for (size_t run = 0; run < runs; run++)
        for (size_t i = 0; i < count; i++) {
            if (of[i] >= LABELS_MAPNIK && run > 0)
                continue;
            json_t *said = run_labelled(b, p, of[i]);
            if (!said && of[i] < LABELS_MAPNIK)
                return false;
            if (!said)
                continue;
            bench_series_add(times->ms + of[i], bench_number(said, "ms"));
            bench_series_add(times->cpu_ms + of[i], bench_number(said, "cpu_ms"));
            times->tiles[of[i]] = bench_number(said, of[i] == LABELS_RENDERD ? "metatiles" : "tiles");
            json_decref(said);
        }
    times->tiles[LABELS_RENDERD] = times->tiles[LABELS_SAME];
    return true;
}

static void add_labelled(const char *key, const char *name, const bench_pyramid *p, const label_times *times,
                         json_t *result) {
    json_t *row = json_pack("{s:s, s:s, s:i, s:i, s:b}", "key", key, "name", name, "min_zoom", p->min_zoom, "max_zoom",
                            p->max_zoom, "labelled", 1);
    double ms[LABEL_WAYS];
    for (int by = 0; by < LABEL_WAYS; by++) {
        char field[64];
        ms[by] = bench_series_median(times->ms + by);
        if (ms[by] <= 0)
            continue;
        snprintf(field, sizeof field, "%s_ms", label_ways[by].key);
        json_object_set_new(row, field, bench_ms(ms[by]));
        snprintf(field, sizeof field, "%s_cpu_ms", label_ways[by].key);
        json_object_set_new(row, field, bench_ms(bench_series_median(times->cpu_ms + by)));
        snprintf(field, sizeof field, "%s_tiles", label_ways[by].key);
        json_object_set_new(row, field, json_real(times->tiles[by]));
    }
    bench_result_add_row(result, row);
    bench_result_add_figure(result, &(bench_figure){key, "tiles with labels, style city", "without",
                                                    ms[LABELS_CITY] / ms[LABELS_CITY_BARE], true});
    if (ms[LABELS_MAPNIK] > 0)
        add_ratio(result, key, "tiles with labels", "Mapnik, png32:z=1", ms[LABELS_MAPNIK] / ms[LABELS_SAME]);
    if (ms[LABELS_RENDERD] > 0)
        add_ratio(result, key, "tiles with labels", "renderd", ms[LABELS_RENDERD] / ms[LABELS_SAME]);
}

/* At zooms 12 to 16 streets have names. Porto's file has next to no areas. */
static bool measure_labelled_city(bench *b, const char *scene, const char *key, const char *name, json_t *result) {
    static const label_way all[] = {LABELS_CITY,      LABELS_CITY_BARE, LABELS_SAME,
                                    LABELS_SAME_BARE, LABELS_MAPNIK,    LABELS_RENDERD};
    static const int deepest[] = {16, 14, 12};
    bench_pyramid p = {.min_zoom = 12, .max_zoom = deepest[b->size], .labelled = true};
    label_times times = {.tiles = {0}};
    if (!bench_scene_path(b, scene, p.city, sizeof p.city))
        return true;
    json_t *said = bench_pyramid_open(&p) ? run_labelled(b, &p, LABELS_SAME) : NULL; /* the file comes from the disk */
    bool done = said && read_box(b, &p);
    json_decref(said);
    const bool peers = done && b->size != BENCH_TINY && bench_pyramid_write_maps(&p);
    done = done && measure_label_ways(b, &p, &times, all, peers ? LABEL_WAYS : LABELS_MAPNIK);
    if (done)
        add_labelled(key, name, &p, &times, result);
    bench_pyramid_close(&p);
    return done;
}

static bool measure_labelled_country(bench *b, json_t *result) {
    static const label_way all[] = {LABELS_CITY, LABELS_CITY_BARE};
    static const double usual_millions[] = {10, 1, 0.05};
    static const int deepest[] = {14, 12, 9};
    bench_pyramid p = {.min_zoom = 0, .max_zoom = deepest[b->size]};
    label_times times = {.tiles = {0}};
    const double millions = b->country_millions > 0 ? b->country_millions : usual_millions[b->size];
    if (!bench_country_make(b, millions, ".osm.pbf", p.city, sizeof p.city))
        return true;
    const bool done = bench_pyramid_open(&p) && measure_label_ways(b, &p, &times, all, sizeof all / sizeof *all);
    if (done)
        add_labelled("country_labels", "a made-up country with labels", &p, &times, result);
    bench_pyramid_close(&p);
    remove(p.city);
    return done;
}

static void print_labelled(const json_t *row, FILE *to) {
    fprintf(to, "%s, zooms %.0f to %.0f\n", bench_text(row, "name"), bench_number(row, "min_zoom"),
            bench_number(row, "max_zoom"));
    for (int by = 0; by < LABEL_WAYS; by++) {
        char field[64];
        snprintf(field, sizeof field, "%s_ms", label_ways[by].key);
        const double ms = bench_number(row, field);
        snprintf(field, sizeof field, "%s_cpu_ms", label_ways[by].key);
        const double cpu_ms = bench_number(row, field);
        snprintf(field, sizeof field, "%s_tiles", label_ways[by].key);
        const double tiles = bench_number(row, field);
        if (ms > 0)
            fprintf(to, "  %-26s %7.0f tiles, %7.0f tiles/s, %.2f ms of a processor's time a tile\n",
                    label_ways[by].name, tiles, 1e3 * tiles / ms, cpu_ms / tiles);
    }
}

/* ---- Shards ---- */

typedef struct shard_times {
    double single_ms, single_cpu_ms, schedule_cpu_ms, slowest_ms, sum_ms, sum_cpu_ms, merge_ms, cat_ms, points;
} shard_times;

/* By medians: of sixteen single runs the slowest would be the one that something else held up. */
static bool draw_shard(const bench *b, const bench_pyramid *p, const char *schedule, int k, shard_times *t) {
    char shard[32], part[128];
    bench_series ms = {.count = 0}, cpu_ms = {.count = 0};
    snprintf(shard, sizeof shard, "%d/%d", k, SHARDS);
    snprintf(part, sizeof part, "%s/country.%d-of-%d.pmtiles", p->folder, k, SHARDS);
    const char *const options[] = {"--threads", "1", "--schedule", schedule, "--shard", shard, NULL};
    for (size_t run = 0; run < (b->runs < TILES_RUNS_MAX ? b->runs : TILES_RUNS_MAX); run++) {
        (void)unlink(part); /* as bench_pyramid_draw does where there is one part */
        json_t *said = bench_pyramid_draw(b, p, "country.pmtiles", options);
        if (!said)
            return false;
        bench_series_add(&ms, bench_number(said, "wall_ms"));
        bench_series_add(&cpu_ms, bench_number(said, "cpu_ms"));
        json_decref(said);
    }
    const double median_ms = bench_series_median(&ms);
    t->slowest_ms = median_ms > t->slowest_ms ? median_ms : t->slowest_ms;
    t->sum_ms += median_ms;
    t->sum_cpu_ms += bench_series_median(&cpu_ms);
    return true;
}

static bool draw_shards(const bench *b, const bench_pyramid *p, shard_times *t) {
    const char *const whole[] = {"--threads", "1", NULL};
    json_t *said = bench_pyramid_draw(b, p, "single/country.pmtiles", whole);
    if (!said)
        return false;
    t->single_ms = bench_number(said, "wall_ms");
    t->single_cpu_ms = bench_number(said, "cpu_ms");
    t->points = bench_number(said, "points_in");
    json_decref(said);
    char schedule[128];
    snprintf(schedule, sizeof schedule, "%s/country.schedule", p->folder);
    const char *const looking[] = {"--threads", "1", "--dry-run", "--schedule", schedule, NULL};
    if (!(said = bench_pyramid_draw(b, p, "country.pmtiles", looking)))
        return false;
    t->schedule_cpu_ms = bench_number(said, "cpu_ms");
    json_decref(said);
    for (int k = 1; k <= SHARDS; k++)
        if (!draw_shard(b, p, schedule, k, t))
            return false;
    return true;
}

/* Both to the disk: camber syncs what it has written. */
static bool merge_shards(const bench *b, const bench_pyramid *p, shard_times *t) {
    char command[1200];
    bench_series merges = {.count = 0}, cats = {.count = 0};
    snprintf(command, sizeof command, "%s tiles merge -q -f country.*-of-%d.pmtiles -o country.pmtiles", b->tool,
             SHARDS);
    for (size_t run = 0; run < b->runs; run++) {
        const double cat = bench_pyramid_shell(p, "cat country.*-of-16.pmtiles >joined && sync joined"),
                     merge = bench_pyramid_shell(p, command);
        if (cat < 0 || merge < 0)
            return false;
        bench_series_add(&cats, cat);
        bench_series_add(&merges, merge);
    }
    t->merge_ms = bench_series_median(&merges);
    t->cat_ms = bench_series_median(&cats);
    if (bench_pyramid_shell(p, "cmp country.pmtiles single/country.pmtiles") >= 0)
        return true;
    fprintf(stderr, "the merge of %d shards is not what a single run writes\n", SHARDS);
    return false;
}

static bool measure_country(bench *b, json_t *result) {
    static const double usual_millions[] = {10, 1, 0.05};
    static const int deepest[] = {14, 12, 9};
    bench_pyramid p = {.min_zoom = 0, .max_zoom = deepest[b->size]};
    shard_times t = {.single_ms = 0};
    const double millions = b->country_millions > 0 ? b->country_millions : usual_millions[b->size];
    if (!bench_country_make(b, millions, ".osm.pbf", p.city, sizeof p.city))
        return true;
    const bool done = bench_pyramid_open(&p) && bench_pyramid_shell(&p, "mkdir single") >= 0 &&
                      draw_shards(b, &p, &t) && merge_shards(b, &p, &t);
    if (done) {
        bench_result_add_row(
            result, json_pack("{s:s, s:s, s:i, s:i, s:f, s:f, s:o, s:o, s:f, s:f, s:f, s:o, s:o}", "key", "country",
                              "name", "a made-up country", "min_zoom", p.min_zoom, "max_zoom", p.max_zoom, "shards",
                              (double)SHARDS, "points", t.points, "single_ms", bench_ms(t.single_ms), "single_cpu_ms",
                              bench_ms(t.single_cpu_ms), "slowest_over_mean", t.slowest_ms * SHARDS / t.sum_ms,
                              "cpu_over_single", t.sum_cpu_ms / t.single_cpu_ms, "schedule_over_single",
                              t.schedule_cpu_ms / t.single_cpu_ms, "merge_ms", bench_ms(t.merge_ms), "cat_ms",
                              bench_ms(t.cat_ms)));
        const bench_figure slowest = {"country", "slowest of 16 shards", "mean", t.slowest_ms * SHARDS / t.sum_ms,
                                      true},
                           cpu = {"country", "time of 16 shards", "single run", t.sum_cpu_ms / t.single_cpu_ms, true},
                           merge = {"country", "merge of 16 parts", "cat", t.cat_ms / t.merge_ms, false};
        bench_result_add_figure(result, &slowest);
        bench_result_add_figure(result, &cpu);
        bench_result_add_figure(result, &merge);
    }
    bench_pyramid_close(&p);
    remove(p.city);
    return done;
}

/* ---- The section ---- */

static json_t *measure(bench *b, const char *only) {
    static const char *const cities[][2] = {{"porto", "Porto"}, {"nyc", "New York"}};
    json_t *result = bench_result_new();
    bool done = true;
    for (size_t i = 0; i < (b->size == BENCH_TINY ? 1 : 2) && done; i++)
        if (!only || strcmp(only, cities[i][0]) == 0)
            done = measure_city(b, cities[i][0], cities[i][1], result);
    if (done && (!only || strcmp(only, "porto_labels") == 0))
        done = measure_labelled_city(b, "porto", "porto_labels", "Porto with labels", result);
    if (done && b->size != BENCH_TINY && (!only || strcmp(only, "nyc_labels") == 0))
        done = measure_labelled_city(b, "nyc", "nyc_labels", "New York with areas and labels", result);
    if (done && (!only || strcmp(only, "country_labels") == 0))
        done = measure_labelled_country(b, result);
    if (done && (!only || strcmp(only, "country") == 0))
        done = measure_country(b, result);
    if (done)
        return result;
    json_decref(result);
    return NULL;
}

static void print_city(const json_t *row, FILE *to) {
    const double tiles = bench_number(row, "tiles"), first = bench_number(row, "png_ms");
    fprintf(to,
            "%s, zooms %.0f to %.0f: %.0f tiles, behind %.0f ms of start and loading; encoding takes %.0f %% of the "
            "processors' time\n",
            bench_text(row, "name"), bench_number(row, "min_zoom"), bench_number(row, "max_zoom"), tiles,
            bench_number(row, "load_ms"), 100 * bench_number(row, "encoding_share"));
    for (int by = 0; by < WAYS; by++) {
        char field[64];
        snprintf(field, sizeof field, "%s_ms", ways[by].key);
        const double ms = bench_number(row, field);
        snprintf(field, sizeof field, "%s_bytes", ways[by].key);
        if (ms > 0)
            fprintf(to, "  %-26s %7.0f tiles/s %8.0f bytes a tile %6.2f times as long\n", ways[by].name,
                    1e3 * tiles / ms, bench_number(row, field), ms / first);
    }
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to,
            "\nPyramids of tiles of 256 px from a loaded map, on two threads; peers draw the same lines, widths and "
            "colours\n");
    json_array_foreach(bench_result_rows(result), i, row) {
        if (json_is_true(json_object_get(row, "labelled"))) {
            print_labelled(row, to);
            continue;
        }
        if (bench_number(row, "shards") == 0) {
            print_city(row, to);
            continue;
        }
        fprintf(
            to,
            "%s of %.1f M points, zooms %.0f to %.0f, in %.0f shards: the slowest takes %.2f times the mean, all "
            "together %.2f times a single run's time, and the schedule that they read %.2f; their merge %.0f ms, cat "
            "%.0f ms\n",
            bench_text(row, "name"), bench_number(row, "points") / 1e6, bench_number(row, "min_zoom"),
            bench_number(row, "max_zoom"), bench_number(row, "shards"), bench_number(row, "slowest_over_mean"),
            bench_number(row, "cpu_over_single"), bench_number(row, "schedule_over_single"),
            bench_number(row, "merge_ms"), bench_number(row, "cat_ms"));
    }
}

const bench_section bench_section_tiles = {"tiles", measure, print};
