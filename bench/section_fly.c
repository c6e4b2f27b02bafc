/* A fly-through of a city in the built-in style: pan and zoom, frame after frame, through the map's API. */
#include "bench.h"

#include "base/base.h"
#include "validate/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef CAMBER_MAP

#include "camber_map.h"

enum { WARM_UPS = 10 };

static const char *const cities[] = {"porto", "santa_cruz", NULL};

typedef enum part { PART_SCENE = 0, PART_TESSELLATE, PART_DRAW, PART_READ, PART_FRAME, PARTS } part;

static const char *const part_keys[PARTS] = {"scene", "tessellate", "draw", "read", "frame"};

typedef struct flight {
    bench *b;
    bool in_cl; /* drawn by kernels, else by GL */
    camber_style *style;
    camber_features *features;
    camber_scene *scene;
    camber_scene_info start;
    size_t frames;
    uint8_t *picture;
    double *times[PARTS]; /* frames each */
    double draw_calls, points;
} flight;

static camber_renderer *renderer_of(const flight *f) {
    return f->in_cl ? f->b->cl_renderer : f->b->renderer;
}

static camber_mesh *mesh_of(const flight *f) {
    return f->in_cl ? f->b->cl_mesh : f->b->mesh;
}

/* Where the flight is after a share of its way: it circles over the city and goes down to the streets and up again. */
static camber_view_desc view_at(const flight *f, double share) {
    const double turn = 2 * 3.14159265358979323846 * share;
    const double degrees_across = f->b->fly_width * 360.0 / (512 * exp2(f->start.zoom));
    return (camber_view_desc){.kind = CAMBER_VIEW_CENTER,
                              .width = f->b->fly_width,
                              .height = f->b->fly_height,
                              .zoom = f->start.zoom + 2 - 2 * cos(turn),
                              .longitude = f->start.longitude + 0.15 * degrees_across * sin(turn),
                              .latitude = f->start.latitude + 0.05 * degrees_across * sin(2 * turn)};
}

/* The scene for the next view, and its mesh. */
static camber_status move_to(flight *f, const camber_view_desc *view) {
    return camber_scene_move(f->scene, view);
}

static camber_status tessellate(const flight *f) {
    return camber_scene_tessellate(f->scene, mesh_of(f), CAMBER_METHOD_STRIP);
}

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    const flight *f = user;
    const size_t row_bytes = 4 * (size_t)f->b->fly_width;
    memcpy(f->picture + row_bytes * first_row, rgba, row_bytes * row_count);
    return true;
}

static camber_status fly_frame(flight *f, double share, double times[PARTS]) {
    const camber_view_desc view = view_at(f, share);
    camber_frame_stats stats = {0};
    const double begin = camber_now_ms();
    camber_status status = move_to(f, &view);
    const double moved = camber_now_ms();
    if (status == CAMBER_OK)
        status = tessellate(f);
    const double made = camber_now_ms();
    if (status == CAMBER_OK) {
        const camber_frame frame = camber_scene_get_frame(f->scene, mesh_of(f));
        status = camber_renderer_render(renderer_of(f), &frame, take_rows, f, &stats);
    }
    times[PART_FRAME] = camber_now_ms() - begin;
    times[PART_SCENE] = moved - begin;
    times[PART_TESSELLATE] = made - moved;
    times[PART_DRAW] = stats.draw_ms;
    times[PART_READ] = stats.read_ms;
    if (status == CAMBER_OK)
        status = camber_scene_project(f->scene);
    if (status == CAMBER_OK) {
        f->draw_calls += (double)stats.draw_calls / (double)f->frames;
        f->points += (double)camber_scene_get_info(f->scene).points_in / (double)f->frames;
    }
    return status;
}

static camber_status fly(flight *f) {
    camber_status status = CAMBER_OK;
    double times[PARTS];
    for (int i = 0; i < WARM_UPS && status == CAMBER_OK; i++)
        status = fly_frame(f, (double)i / WARM_UPS, times);
    f->draw_calls = f->points = 0;
    for (size_t i = 0; i < f->frames && status == CAMBER_OK; i++) {
        status = fly_frame(f, (double)i / (double)f->frames, times);
        for (int k = 0; k < PARTS; k++)
            f->times[k][i] = times[k];
    }
    return status;
}

static camber_status open_flight(flight *f, const char *path) {
    bench *b = f->b;
    const camber_source_desc source = {.path = path};
    const camber_scene_desc whole = {.view = {.width = f->b->fly_width, .height = f->b->fly_height},
                                     .simplify_px = BENCH_SIMPLIFY_PX};
    camber_status status = camber_style_create_builtin(b->context, CAMBER_THEME_LIGHT, &f->style);
    if (status == CAMBER_OK)
        status = camber_features_create(b->context, f->style, &f->features);
    if (status == CAMBER_OK)
        status = camber_features_read(f->features, &source);
    if (status == CAMBER_OK)
        status = camber_scene_create(f->features, &whole, &f->scene);
    if (status == CAMBER_OK)
        f->start = camber_scene_get_info(f->scene);
    f->picture = calloc((size_t)b->fly_width * b->fly_height, 4);
    if (!f->picture)
        status = CAMBER_ERROR_MEMORY;
    for (int k = 0; k < PARTS; k++)
        if (!(f->times[k] = calloc(f->frames, sizeof(double))))
            status = CAMBER_ERROR_MEMORY;
    return status;
}

static void close_flight(flight *f) {
    free(f->picture);
    for (int k = 0; k < PARTS; k++)
        free(f->times[k]);
    camber_scene_destroy(f->scene);
    camber_features_destroy(f->features);
    camber_style_destroy(f->style);
}

static void report(flight *f, const char *city, json_t *result) {
    json_t *row = json_pack("{s:s, s:s, s:I, s:I, s:I, s:f, s:f}", "city", city, "by", f->in_cl ? "cl" : "gl", "width",
                            (json_int_t)f->b->fly_width, "height", (json_int_t)f->b->fly_height, "frames",
                            (json_int_t)f->frames, "draw_calls", f->draw_calls, "points_in_view", f->points);
    for (int k = 0; k < PARTS; k++) {
        double *times = f->times[k];
        camber_statistics_sort(times, f->frames);
        json_object_set_new(row, part_keys[k],
                            json_pack("{s:o, s:o, s:o}", "p50_ms",
                                      bench_ms(camber_statistics_quantile(times, f->frames, 0.5)), "p99_ms",
                                      bench_ms(camber_statistics_quantile(times, f->frames, 0.99)), "max_ms",
                                      bench_ms(times[f->frames - 1])));
    }
    const bench_yardstick stick = bench_yardstick_measure(f->b);
    static const char *const shares[] = {"p50_ms", "p99_ms"};
    static const char *const names[2][2] = {{"p50", "p99"}, {"in OpenCL p50", "in OpenCL p99"}};
    for (int i = 0; i < 2; i++) {
        const double ms = bench_number(json_object_get(row, "frame"), shares[i]);
        bench_result_add_figure(result,
                                &(bench_figure){"flight", names[f->in_cl][i], stick.name, stick.ms / ms, false});
    }
    bench_result_add_row(result, row);
}

static json_t *measure(bench *b, const char *only) {
    static const size_t frames[] = {300, 60, 5};
    flight f = {.b = b, .frames = frames[b->size]};
    json_t *result = bench_result_new();
    char path[1024];
    size_t i = 0;
    (void)only; /* there is one */
    while (cities[i] && !(bench_scene_path(b, cities[i], path, sizeof path) && open_flight(&f, path) == CAMBER_OK)) {
        close_flight(&f);
        f = (flight){.b = b, .frames = frames[b->size]};
        i++;
    }
    bool done = cities[i];
    for (int in_cl = 1; in_cl >= 0 && done; in_cl--) {
        f.in_cl = in_cl;
        done = fly(&f) == CAMBER_OK;
        if (done)
            report(&f, i == 0 ? "Porto" : "Santa Cruz", result);
    }
    close_flight(&f);
    if (done)
        return result;
    json_decref(result);
    return NULL;
}

#else
#define measure NULL
#endif

static void print_flight(const json_t *row, FILE *to) {
    fprintf(to,
            "Fly-through of %s, built-in style, %.0f frames of %.0f x %.0f px, pan and zoom, at %g px: %.0f points in "
            "view and %.1f\n"
            "draw calls a frame on average. scene: style, project, cull, simplify; frame: from the view to pixels in "
            "memory.\nDrawn by %s.\n\n"
            "%-10s %8s %8s %8s   ms\n",
            bench_text(row, "city"), bench_number(row, "frames"), bench_number(row, "width"),
            bench_number(row, "height"), BENCH_SIMPLIFY_PX, bench_number(row, "points_in_view"),
            bench_number(row, "draw_calls"), strcmp(bench_text(row, "by"), "cl") == 0 ? "kernels" : "GL", "", "p50",
            "p99", "max");
    static const char *const keys[] = {"scene", "tessellate", "draw", "read", "frame"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        const json_t *times = json_object_get(row, keys[i]);
        fprintf(to, "%-10s %8.2f %8.2f %8.2f\n", keys[i], bench_number(times, "p50_ms"), bench_number(times, "p99_ms"),
                bench_number(times, "max_ms"));
    }
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    json_array_foreach(bench_result_rows(result), i, row) print_flight(row, to);
}

const bench_section bench_section_fly = {"fly", measure, print};
