/* Drawing in OpenCL as loads grow: walks of 10^4 to 3 * 10^7 points in one square, the same walks in squares of 512 to
 * 16384 px, and loads that lie on one tile or in one polyline. */
#include "bench.h"

#include "base/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum { WALK_POINTS = 40, POINTS_SIDE_PX = 2048, PIXELS_POINTS = 100000 };
#define WIDTH_PX 2.0f
/* Larger loads are drawn fewer times: twice at least, of which the first one does not count. */
#define PATIENCE_MS 4000.0

typedef enum load_kind {
    LOAD_POINTS, /* more of them in the same square */
    LOAD_PIXELS, /* the same points in more of them */
    LOAD_TILE,   /* all in one tile */
    LOAD_LINE,   /* one polyline, all over the square */
} load_kind;

typedef struct load {
    load_kind kind;
    size_t points;
    uint32_t side_px;
    bench_size least; /* the size of the benchmark that still has it */
} load;

static const char *const kind_names[] = {"points", "pixels", "tile", "line"};
static const load loads[] = {
    {LOAD_POINTS, 10000, POINTS_SIDE_PX, BENCH_TINY},     {LOAD_POINTS, 30000, POINTS_SIDE_PX, BENCH_TINY},
    {LOAD_POINTS, 100000, POINTS_SIDE_PX, BENCH_QUICK},   {LOAD_POINTS, 300000, POINTS_SIDE_PX, BENCH_QUICK},
    {LOAD_POINTS, 1000000, POINTS_SIDE_PX, BENCH_QUICK},  {LOAD_POINTS, 3000000, POINTS_SIDE_PX, BENCH_FULL},
    {LOAD_POINTS, 10000000, POINTS_SIDE_PX, BENCH_FULL},  {LOAD_POINTS, 30000000, POINTS_SIDE_PX, BENCH_FULL},
    {LOAD_PIXELS, PIXELS_POINTS, 512, BENCH_TINY},        {LOAD_PIXELS, PIXELS_POINTS, 1024, BENCH_TINY},
    {LOAD_PIXELS, PIXELS_POINTS, 2048, BENCH_QUICK},      {LOAD_PIXELS, PIXELS_POINTS, 4096, BENCH_QUICK},
    {LOAD_PIXELS, PIXELS_POINTS, 8192, BENCH_FULL},       {LOAD_PIXELS, PIXELS_POINTS, 16384, BENCH_FULL},
    {LOAD_PIXELS, 30 * PIXELS_POINTS, 16384, BENCH_FULL}, {LOAD_TILE, 100000, POINTS_SIDE_PX, BENCH_QUICK},
    {LOAD_LINE, 1000000, POINTS_SIDE_PX, BENCH_QUICK},
};
enum { LOADS = sizeof loads / sizeof *loads };

/* ---- Lines ---- */

static double uniform(uint64_t *state) {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) / 9007199254740992.0;
}

typedef struct walks {
    float *points;
    uint32_t *offsets;
    size_t polyline_count;
} walks;

/* Steps shrink as points grow in number, so that all of them together cover as much: 12 px of 10^5 in 2048 px. Those of
 * one tile stay in it. */
static bool make_walks(const load *l, walks *w) {
    const size_t a_walk = l->kind == LOAD_LINE ? l->points : WALK_POINTS;
    const bool in_tile = l->kind == LOAD_TILE;
    const double side = l->side_px, from = in_tile ? side / 2 : 0, range = in_tile ? 30 : side;
    const double step = in_tile ? 4 : 12 * side / POINTS_SIDE_PX * sqrt(1e5 / (double)l->points);
    uint64_t state = 88172645463325252ull;
    w->points = malloc(2 * sizeof *w->points * l->points);
    w->offsets = malloc(sizeof *w->offsets * (l->points / a_walk + 2));
    if (!w->points || !w->offsets)
        return false;
    double x = 0, y = 0, heading = 0;
    for (size_t i = 0; i < l->points; i++) {
        if (i % a_walk == 0) {
            w->offsets[w->polyline_count++] = (uint32_t)i;
            x = uniform(&state) * range;
            y = uniform(&state) * range;
            heading = uniform(&state) * 6.283;
        }
        heading += (uniform(&state) - 0.5) * (uniform(&state) < 0.1 ? 4 : 0.8);
        x += cos(heading) * step;
        y += sin(heading) * step;
        if (x < 0 || x > range || y < 0 || y > range)
            heading += 3.1416;
        x = fmin(fmax(x, 0), range);
        y = fmin(fmax(y, 0), range);
        w->points[2 * i] = (float)(from + x);
        w->points[2 * i + 1] = (float)(from + y);
    }
    w->offsets[w->polyline_count] = (uint32_t)l->points;
    return true;
}

/* ---- Frames ---- */

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    (void)rgba;
    (void)first_row;
    *(uint64_t *)user += row_count;
    return true;
}

typedef struct cost {
    bench_series frame, tessellate, draw, shape, lists, cover, cores;
} cost;

static double processor_ms(void) {
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    return 1e3 * (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-3 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

static camber_status draw_once(bench *b, const load *l, const camber_polylines *polylines, cost *c) {
    const camber_stroke stroke = {.width_px = WIDTH_PX};
    const camber_tessellation_desc strokes = {.strokes = &stroke, .stroke_count = 1};
    const camber_paint paint = {.width_px = WIDTH_PX, .color = {0, 0, 0, 1}};
    const camber_pass pass = {.mesh = b->cl_mesh, .paints = &paint, .paint_count = 1};
    const camber_frame frame = {
        .width = l->side_px, .height = l->side_px, .background = {1, 1, 1, 1}, .passes = &pass, .pass_count = 1};
    camber_frame_stats stats = {0};
    uint64_t rows = 0;
    const double begin = camber_now_ms(), busy = processor_ms();
    camber_status status = camber_mesh_tessellate(b->cl_mesh, polylines, &strokes);
    const double tessellated = camber_now_ms();
    if (status == CAMBER_OK)
        status = camber_renderer_render(b->cl_renderer, &frame, take_rows, &rows, &stats);
    const double frame_ms = camber_now_ms() - begin;
    bench_series_add(&c->frame, frame_ms);
    bench_series_add(&c->tessellate, tessellated - begin);
    bench_series_add(&c->draw, stats.draw_ms);
    bench_series_add(&c->shape, camber_stage_times_get_ms(&stats.times, "setup"));
    bench_series_add(&c->lists, camber_stage_times_get_ms(&stats.times, "bin_count") +
                                    camber_stage_times_get_ms(&stats.times, "bin_scan") +
                                    camber_stage_times_get_ms(&stats.times, "bin_scatter"));
    bench_series_add(&c->cover, camber_stage_times_get_ms(&stats.times, "rasterize"));
    bench_series_add(&c->cores, (processor_ms() - busy) / frame_ms);
    return status;
}

static camber_status measure_load(bench *b, const load *l, cost *c) {
    walks w = {0};
    camber_polylines *polylines = NULL;
    camber_status status = make_walks(l, &w) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    const camber_polylines_desc desc = {.points = w.points,
                                        .point_count = l->points,
                                        .offsets = w.offsets,
                                        .polyline_count = w.polyline_count,
                                        .keep_open = true};
    if (status == CAMBER_OK)
        status = camber_polylines_create(b->context, &desc, &polylines);
    free(w.points);
    free(w.offsets);
    cost first = {.frame = {.count = 0}};
    if (status == CAMBER_OK)
        status = draw_once(b, l, polylines, &first);
    const double begin = camber_now_ms();
    for (size_t run = 0; run < b->runs && status == CAMBER_OK; run++) {
        status = draw_once(b, l, polylines, c);
        if (camber_now_ms() - begin > PATIENCE_MS)
            break;
    }
    camber_polylines_destroy(polylines);
    return status;
}

/* ---- The section ---- */

static double unit_cost(const load *l, double frame_ms) {
    const double count = l->kind == LOAD_PIXELS ? (double)l->side_px * l->side_px : (double)l->points;
    return frame_ms * 1e6 / count;
}

/* The most by which a point, or a pixel, costs more in a larger load than in some smaller one. */
static double growth_of(const json_t *rows, load_kind kind) {
    double least = INFINITY, growth = 1;
    size_t i;
    const json_t *row;
    json_array_foreach(rows, i, row) {
        if (strcmp(bench_text(row, "key"), kind_names[kind]) != 0 ||
            (kind == LOAD_PIXELS && bench_number(row, "points") > PIXELS_POINTS))
            continue;
        growth = fmax(growth, bench_number(row, "ns") / least);
        least = fmin(least, bench_number(row, "ns"));
    }
    return growth;
}

static void add_growth(json_t *result, load_kind kind, const char *member, const char *what) {
    const double growth = growth_of(bench_result_rows(result), kind);
    json_object_set_new(result, member, json_real(growth));
    bench_result_add_figure(result, &(bench_figure){kind_names[kind], what, NULL, growth, true});
}

static json_t *measure(bench *b, const char *only) {
    json_t *result = bench_result_new();
    for (size_t i = 0; i < LOADS; i++) {
        const load *l = loads + i;
        cost c = {.frame = {.count = 0}};
        if (b->size > l->least || (only && strcmp(only, kind_names[l->kind]) != 0))
            continue;
        if (measure_load(b, l, &c) != CAMBER_OK) {
            fprintf(stderr, "camber_bench: %zu points in %u px could not be drawn\n", l->points, l->side_px);
            continue;
        }
        const double frame_ms = bench_series_median(&c.frame), cores = bench_series_median(&c.cores);
        bench_result_add_row(
            result,
            json_pack("{s:s, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:f, s:f}", "key", kind_names[l->kind], "points",
                      (json_int_t)l->points, "side_px", (json_int_t)l->side_px, "frame_ms", bench_ms(frame_ms),
                      "tessellate_ms", bench_ms(bench_series_median(&c.tessellate)), "draw_ms",
                      bench_ms(bench_series_median(&c.draw)), "setup_ms", bench_ms(bench_series_median(&c.shape)),
                      "lists_ms", bench_ms(bench_series_median(&c.lists)), "rasterize_ms",
                      bench_ms(bench_series_median(&c.cover)), "ns", unit_cost(l, frame_ms), "cores", cores));
        if (l->kind == LOAD_TILE || l->kind == LOAD_LINE)
            bench_result_add_figure(result, &(bench_figure){kind_names[l->kind], "cores at work", NULL, cores, false});
    }
    if (!only || strcmp(only, "points") == 0)
        add_growth(result, LOAD_POINTS, "points_growth", "what a point costs more in larger loads");
    if (!only || strcmp(only, "pixels") == 0)
        add_growth(result, LOAD_PIXELS, "pixels_growth", "what a pixel costs more in larger pictures");
    return result;
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to,
            "Growth, drawn in OpenCL, lines %g px wide, ms: walks in a square, its pixels, all in one tile, one line.\n"
            "ns: of the frame, a point or (pixels) a pixel. Cores: at work on average.\n\n"
            "%-7s %9s %6s | %9s %9s %9s | %9s %9s %9s | %8s %5s\n",
            (double)WIDTH_PX, "", "points", "px", "frame", "tess.", "draw", "shape", "lists", "cover", "ns", "cores");
    json_array_foreach(bench_result_rows(result), i, row) {
        fprintf(to, "%-7s %9.0f %6.0f | %9.1f %9.1f %9.1f | %9.1f %9.1f %9.1f | %8.2f %5.2f\n", bench_text(row, "key"),
                bench_number(row, "points"), bench_number(row, "side_px"), bench_number(row, "frame_ms"),
                bench_number(row, "tessellate_ms"), bench_number(row, "draw_ms"), bench_number(row, "setup_ms"),
                bench_number(row, "lists_ms"), bench_number(row, "rasterize_ms"), bench_number(row, "ns"),
                bench_number(row, "cores"));
    }
    fprintf(to, "A point costs at most %.2f times what it costs in any smaller load, a pixel %.2f times.\n",
            bench_number(result, "points_growth"), bench_number(result, "pixels_growth"));
}

const bench_section bench_section_growth = {"growth", measure, print};
