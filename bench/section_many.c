/* A style of 300 layers over a city, read and evaluated for another zoom; and 100,000 squares of one colour and of a
 * thousand, in one frame. */
#include "bench.h"

#include "base/base.h"

#include <stdlib.h>
#include <string.h>

#ifdef CAMBER_MAP
#include "camber_map.h"
#endif

/* ---- Layers ---- */

#ifdef CAMBER_MAP

enum { LAYERS = 300 };

/* Casings and fills of kinds of roads, each with a width that depends on zoom and feature. */
static char *write_layers(size_t *size) {
    static const char *const roads[] = {"footway", "path",        "cycleway", "steps",   "track",
                                        "service", "residential", "tertiary", "primary", "motorway"};
    static const char *const others[] = {"bridge", "tunnel", "oneway", "lit", "junction"};
    char *text = NULL;
    FILE *to = open_memstream(&text, size);
    if (!to)
        return NULL;
    fputs("{\"version\": 8, \"layers\": [", to);
    for (int i = 0; i < LAYERS; i++)
        fprintf(
            to,
            "%s{\"id\": \"l%d\", \"type\": \"line\", \"filter\": [\"all\", [\"in\", [\"get\", \"highway\"], "
            "[\"literal\", [\"%s\", \"%s_link\"]]], [\"%s\", [\"get\", \"%s\"], \"yes\"]], \"layout\": "
            "{\"line-cap\": \"round\", \"line-join\": \"round\"}, \"paint\": {\"line-color\": [\"match\", [\"get\", "
            "\"surface\"], \"asphalt\", \"#%x48\", \"#%x9a\"], \"line-width\": [\"interpolate\", [\"exponential\", "
            "1.5], [\"zoom\"], 5, [\"case\", [\"==\", [\"get\", \"oneway\"], \"yes\"], 0.5, 1], 18, %d]}}",
            i ? "," : "", i, roads[i % 10], roads[i % 10], i / 150 ? "!=" : "==", others[i / 10 % 5], i % 16,
            i / 16 % 16, 40 - i / 10);
    fputs("]}", to);
    return fclose(to) == 0 ? text : NULL;
}

typedef struct styled {
    bench_series parse, evaluate;
    camber_style *style;
    camber_features *features;
    camber_scene *scene;
} styled;

static camber_status parse_layers(bench *b, styled *s, const char *text, size_t size) {
    camber_status status = CAMBER_OK;
    for (size_t run = 0; run <= b->runs && status == CAMBER_OK; run++) {
        camber_style_destroy(s->style);
        s->style = NULL;
        const double begin = camber_now_ms();
        status = camber_style_parse(b->context, text, size, "many", &s->style);
        if (run > 0)
            bench_series_add(&s->parse, camber_now_ms() - begin);
    }
    return status;
}

/* Each view is of another zoom: all features are evaluated again. */
static camber_status evaluate_layers(bench *b, styled *s, const char *city) {
    const camber_scene_desc desc = {.use = CAMBER_SCENE_VIEWS};
    camber_status status = camber_features_create(b->context, s->style, &s->features);
    if (status == CAMBER_OK)
        status = camber_features_read(s->features, &(camber_source_desc){.path = city});
    if (status == CAMBER_OK)
        status = camber_scene_create(s->features, &desc, &s->scene);
    for (size_t run = 0; run <= b->runs && status == CAMBER_OK; run++) {
        const camber_scene_info info = camber_scene_get_info(s->scene);
        const camber_view_desc view = {.kind = CAMBER_VIEW_CENTER,
                                       .longitude = info.longitude,
                                       .latitude = info.latitude,
                                       .zoom = info.zoom + 0.1};
        const double begin = camber_now_ms();
        status = camber_scene_move(s->scene, &view);
        if (run > 0)
            bench_series_add(&s->evaluate, camber_now_ms() - begin);
    }
    return status;
}

static void measure_layers(bench *b, json_t *result) {
    char city[1024];
    size_t size = 0;
    styled s = {.style = NULL};
    char *text = b->size != BENCH_TINY && bench_scene_path(b, "porto", city, sizeof city) ? write_layers(&size) : NULL;
    if (!text)
        return;
    const bench_yardstick stick = bench_yardstick_measure(b);
    camber_status status = parse_layers(b, &s, text, size);
    if (status == CAMBER_OK)
        status = evaluate_layers(b, &s, city);
    if (status == CAMBER_OK) {
        const double parse_ms = bench_series_median(&s.parse), evaluate_ms = bench_series_median(&s.evaluate);
        bench_result_add_row(result, json_pack("{s:s, s:s, s:o, s:o}", "key", "layers", "name", "300 layers over Porto",
                                               "parse_ms", bench_ms(parse_ms), "evaluate_ms", bench_ms(evaluate_ms)));
        bench_result_add_figure(result,
                                &(bench_figure){"layers", "parse a style", stick.name, stick.ms / parse_ms, false});
        bench_result_add_figure(result,
                                &(bench_figure){"layers", "evaluate it", stick.name, stick.ms / evaluate_ms, false});
    }
    camber_scene_destroy(s.scene);
    camber_features_destroy(s.features);
    camber_style_destroy(s.style);
    free(text);
}

#else

static void measure_layers(bench *b, json_t *result) {
    (void)b;
    (void)result;
}

#endif

/* ---- Fills ---- */

enum { FILLS = 1000 };

typedef struct squares {
    float *points;
    uint32_t *offsets, *rows;
    size_t count;
} squares;

/* Squares of up to 20 px all over the picture; no two that follow each other have the same fill. */
static bool make_squares(squares *s, size_t count, uint32_t fills) {
    uint32_t seed = 77;
    *s = (squares){malloc(10 * count * sizeof *s->points), malloc((count + 1) * sizeof *s->offsets),
                   malloc(count * sizeof *s->rows), count};
    if (!s->points || !s->offsets || !s->rows)
        return false;
    for (size_t i = 0; i < count; i++) {
        uint32_t numbers[3];
        for (int k = 0; k < 3; k++)
            numbers[k] = (seed = seed * 1664525u + 1013904223u) >> 16;
        const uint32_t x = numbers[0] % BENCH_SIDE_PX, y = numbers[1] % BENCH_SIDE_PX, side = 1 + numbers[2] % 20;
        const float right = (float)(x + side), down = (float)(y + side), left = (float)x, up = (float)y;
        memcpy(s->points + 10 * i, (float[10]){left, up, right, up, right, down, left, down, left, up},
               10 * sizeof(float));
        s->offsets[i] = (uint32_t)(5 * i);
        s->rows[i] = (uint32_t)(7 * i % fills);
    }
    s->offsets[count] = (uint32_t)(5 * count);
    return true;
}

static void free_squares(squares *s) {
    free(s->points);
    free(s->offsets);
    free(s->rows);
}

/* A frame's milliseconds. */
static camber_status draw_squares(bench *b, const squares *s, double *frame_ms) {
    static const camber_stroke strokes[FILLS];
    camber_fill fills[FILLS];
    camber_paint paints[FILLS];
    for (int i = 0; i < FILLS; i++) {
        fills[i] = (camber_fill){.color = {(float)(i % 10) / 9, (float)(i / 10 % 10) / 9, (float)(i / 100) / 9, 1}};
        paints[i] = (camber_paint){.fill = fills + i};
    }
    const camber_polylines_desc lines = {.points = s->points,
                                         .point_count = 5 * s->count,
                                         .offsets = s->offsets,
                                         .polyline_count = s->count,
                                         .rows = s->rows};
    const camber_tessellation_desc how = {.strokes = strokes, .stroke_count = FILLS};
    const camber_pass pass = {.mesh = b->cl_mesh, .paints = paints, .paint_count = FILLS};
    const camber_frame frame = {
        .width = BENCH_SIDE_PX, .height = BENCH_SIDE_PX, .background = {1, 1, 1, 1}, .passes = &pass, .pass_count = 1};
    camber_polylines *polylines = NULL;
    camber_status status = camber_polylines_create(b->context, &lines, &polylines);
    bench_series series = {.count = 0};
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(b->cl_mesh, polylines, &how);
    for (size_t run = 0; run < b->warm_ups + b->runs && status == CAMBER_OK; run++) {
        bench_taking taking = {.picture = b->picture};
        const double begin = camber_now_ms();
        status = camber_renderer_render(b->cl_renderer, &frame, bench_take_rows, &taking, NULL);
        if (run >= b->warm_ups)
            bench_series_add(&series, camber_now_ms() - begin - taking.kept_ms);
    }
    camber_polylines_destroy(polylines);
    *frame_ms = bench_series_median(&series);
    return status;
}

static camber_status measure_fills(bench *b, json_t *result) {
    const size_t count = b->size == BENCH_TINY ? 1000 : 100000;
    double ms[2] = {0, 0};
    camber_status status = CAMBER_OK;
    for (int many = 0; many < 2 && status == CAMBER_OK; many++) {
        squares s;
        status = make_squares(&s, count, many ? FILLS : 1) ? draw_squares(b, &s, ms + many) : CAMBER_ERROR_MEMORY;
        free_squares(&s);
    }
    if (status != CAMBER_OK)
        return status;
    bench_result_add_row(result, json_pack("{s:s, s:s, s:I, s:o, s:o}", "key", "fills", "name", "squares", "areas",
                                           (json_int_t)count, "one_ms", bench_ms(ms[0]), "many_ms", bench_ms(ms[1])));
    bench_result_add_figure(result, &(bench_figure){"fills", "1,000 fills", "one fill", ms[1] / ms[0], true});
    return CAMBER_OK;
}

/* ---- Both ---- */

static json_t *measure(bench *b, const char *only) {
    json_t *result = bench_result_new();
    if (!only || strcmp(only, "layers") == 0)
        measure_layers(b, result);
    if ((!only || strcmp(only, "fills") == 0) && measure_fills(b, result) != CAMBER_OK) {
        json_decref(result);
        return NULL;
    }
    return result;
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to, "Many at once.\n\n");
    json_array_foreach(bench_result_rows(result), i, row) {
        if (strcmp(bench_text(row, "key"), "layers") == 0)
            fprintf(to, "%s: parsed in %.1f ms, evaluated for another zoom in %.1f ms\n", bench_text(row, "name"),
                    bench_number(row, "parse_ms"), bench_number(row, "evaluate_ms"));
        else
            fprintf(to, "%.0f squares: of one fill %.1f ms, of %d fills %.1f ms\n", bench_number(row, "areas"),
                    bench_number(row, "one_ms"), FILLS, bench_number(row, "many_ms"));
    }
}

const bench_section bench_section_many = {"many", measure, print};
