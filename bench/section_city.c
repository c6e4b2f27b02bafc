/* The style city, areas and lines, beside Mapnik: whole frames of a city by kernels, from its network on the device to
 * pixels in memory, and the same layers by Mapnik. Mapnik gets the rings and lines as camber has simplified them, with
 * the same colours and widths, in the same order. They are those of a wider view of the same scale: a camera that cuts
 * a ring leaves pieces that other libraries do not take for one. */
#include "bench.h"

#include "base/base.h"

#include <stdlib.h>
#include <string.h>

#if defined(CAMBER_MAP) && defined(CAMBER_BENCH_MAPNIK)

#include "camber_map.h"
#include "peers/layers.h"

/* So wide that no ring that reaches into the picture is cut, px. */
enum { WIDE_PX = 5 * BENCH_SIDE_PX };

typedef struct view {
    const char *key, *name, *file;
    double longitude, latitude, zoom;
    bool own; /* the file lies in the repository */
} view;

static const view views[] = {
    {"monaco", "Monaco", CAMBER_MONACO, 7.4225, 43.7357, 15.2, true},
    {"nyc", "New York", "nyc.osm.pbf", -73.9975, 40.7195, 14.4, false},
    {"helsinki", "Helsinki", "Helsinki-1327152.osm.pbf", 24.9443, 60.1716, 14.9, false},
};

typedef struct trial {
    bench *b;
    camber_style *style;
    camber_features *features;
    camber_scene *scene, *wide;
    camber_mesh *mesh; /* of the wide scene, projected */
    camber_frame frame;
    bench_layer *layers;
    size_t layer_count, edges;
    bench_series ours, tessellate, mapnik;
    double difference;
} trial;

static camber_status open_scene(trial *t, const view *v, const char *path) {
    const camber_source_desc source = {.path = path};
    camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_CENTER,
                                       .longitude = v->longitude,
                                       .latitude = v->latitude,
                                       .zoom = v->zoom,
                                       .width = BENCH_SIDE_PX,
                                       .height = BENCH_SIDE_PX},
                              .simplify_px = BENCH_SIMPLIFY_PX};
    camber_status status = camber_style_create_builtin(t->b->context, CAMBER_THEME_LIGHT, &t->style);
    if (status == CAMBER_OK)
        status = camber_features_create(t->b->context, t->style, &t->features);
    if (status == CAMBER_OK)
        status = camber_features_read(t->features, &source);
    if (status == CAMBER_OK)
        status = camber_scene_create(t->features, &desc, &t->scene);
    desc.view.width = desc.view.height = WIDE_PX;
    if (status == CAMBER_OK)
        status = camber_scene_create(t->features, &desc, &t->wide);
    if (status == CAMBER_OK)
        status = camber_scene_project(t->scene);
    if (status == CAMBER_OK)
        status = camber_scene_project(t->wide);
    return status;
}

/* ---- Mapnik's layers ---- */

static bool looks_alike(const camber_paint *a, const camber_paint *b) {
    if (!a->fill != !b->fill)
        return false;
    if (a->fill)
        return memcmp(&a->fill->color, &b->fill->color, sizeof a->fill->color) == 0;
    return a->width_px == b->width_px && memcmp(&a->color, &b->color, sizeof a->color) == 0;
}

/* Polylines of a pass that follow each other and look alike are a layer. false: out of memory. */
static bool add_pass(trial *t, const camber_pass *pass) {
    const camber_lines *lines = camber_scene_get_lines(t->wide);
    const uint32_t *rows = camber_scene_get_rows(t->wide);
    size_t stroke_count;
    const camber_stroke *strokes = camber_scene_get_strokes(t->wide, &stroke_count);
    const size_t end = pass->polyline_count ? pass->first_polyline + pass->polyline_count : lines->polyline_count;
    const camber_paint *before = NULL;
    for (size_t i = pass->first_polyline; i < end; i++) {
        const camber_paint *paint = rows[i] < pass->paint_count ? pass->paints + rows[i] : NULL;
        if (!paint || (paint->width_px <= 0 && !paint->fill)) {
            before = NULL;
            continue;
        }
        if (before && looks_alike(before, paint)) {
            t->layers[t->layer_count - 1].end = i + 1;
            continue;
        }
        bench_layer *layers = realloc(t->layers, (t->layer_count + 1) * sizeof *layers);
        if (!layers)
            return false;
        t->layers = layers;
        layers[t->layer_count++] = (bench_layer){.lines = lines,
                                                 .first = i,
                                                 .end = i + 1,
                                                 .shift_px = (WIDE_PX - BENCH_SIDE_PX) / 2.0,
                                                 .width_px = paint->width_px,
                                                 .color = paint->fill ? paint->fill->color : paint->color,
                                                 .cap = strokes[rows[i]].cap,
                                                 .opacity = pass->opacity > 0 ? pass->opacity : 1,
                                                 .area = paint->fill != NULL};
        before = paint;
    }
    return true;
}

static camber_status make_layers(trial *t) {
    size_t stroke_count;
    const camber_stroke *strokes = camber_scene_get_strokes(t->wide, &stroke_count);
    const camber_tessellation_desc desc = {.strokes = strokes, .stroke_count = stroke_count};
    camber_status status = camber_mesh_create(t->b->device, t->b->cl_renderer, &t->mesh);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(t->mesh, camber_scene_get_polylines(t->wide), &desc);
    if (status != CAMBER_OK)
        return status;
    t->frame = camber_scene_get_frame(t->wide, t->mesh);
    for (size_t i = 0; i < t->frame.pass_count; i++)
        if (t->frame.passes[i].kind == CAMBER_PASS_LINES && !add_pass(t, t->frame.passes + i))
            return CAMBER_ERROR_MEMORY;
    t->edges = camber_scene_get_lines(t->scene)->point_count - camber_scene_get_lines(t->scene)->polyline_count;
    return CAMBER_OK;
}

/* ---- Frames ---- */

static camber_status draw_ours(trial *t, bool counts) {
    bench_taking taking = {.picture = t->b->picture};
    const double begin = camber_now_ms();
    camber_status status = camber_scene_tessellate(t->scene, t->b->cl_mesh, CAMBER_METHOD_STRIP);
    const double tessellated = camber_now_ms();
    if (status == CAMBER_OK) {
        const camber_frame frame = camber_scene_get_frame(t->scene, t->b->cl_mesh);
        status = camber_renderer_render(t->b->cl_renderer, &frame, bench_take_rows, &taking, NULL);
    }
    if (counts) {
        bench_series_add(&t->ours, camber_now_ms() - begin - taking.kept_ms);
        bench_series_add(&t->tessellate, tessellated - begin);
    }
    return status;
}

/* Mean over all channels of the picture, 255ths. */
static double difference_of(const uint8_t *a, const uint8_t *b) {
    double sum = 0;
    for (size_t i = 0; i < 4 * (size_t)BENCH_SIDE_PX * BENCH_SIDE_PX; i++)
        sum += i % 4 < 3 ? abs(a[i] - b[i]) : 0;
    return sum / (3.0 * BENCH_SIDE_PX * BENCH_SIDE_PX);
}

static camber_status draw_both(trial *t) {
    camber_status status = CAMBER_OK;
    for (size_t run = 0; run < t->b->warm_ups + t->b->runs && status == CAMBER_OK; run++) {
        status = draw_ours(t, run >= t->b->warm_ups);
        const double ms = bench_mapnik_layers(t->layers, t->layer_count, t->frame.background, t->b->pictured);
        if (run >= t->b->warm_ups)
            bench_series_add(&t->mapnik, ms);
        else
            t->difference = difference_of(t->b->picture, t->b->pictured);
    }
    return status;
}

static void report(const trial *t, const view *v, json_t *result) {
    const double ours = bench_series_median(&t->ours), mapnik = bench_series_median(&t->mapnik);
    bench_result_add_row(result,
                         json_pack("{s:s, s:s, s:I, s:I, s:o, s:o, s:o, s:f}", "key", v->key, "scene", v->name,
                                   "layers", (json_int_t)t->layer_count, "edges", (json_int_t)t->edges, "cl_frame_ms",
                                   bench_ms(ours), "tessellate_ms", bench_ms(bench_series_median(&t->tessellate)),
                                   "mapnik_ms", bench_ms(mapnik), "difference", t->difference));
    bench_result_add_figure(result, &(bench_figure){v->key, "style city in OpenCL", "Mapnik", mapnik / ours, false});
}

static camber_status measure_view(bench *b, const view *v, json_t *result) {
    trial t = {.b = b};
    char path[1024];
    snprintf(path, sizeof path, "%s%s%s", v->own ? "" : b->data, v->own ? "" : "/data/", v->file);
    camber_status status = open_scene(&t, v, path);
    if (status == CAMBER_OK)
        status = make_layers(&t);
    if (status == CAMBER_OK)
        status = draw_both(&t);
    if (status == CAMBER_OK)
        report(&t, v, result);
    free(t.layers);
    camber_mesh_destroy(t.mesh);
    camber_scene_destroy(t.wide);
    camber_scene_destroy(t.scene);
    camber_features_destroy(t.features);
    camber_style_destroy(t.style);
    return status;
}

static json_t *measure(bench *b, const char *only) {
    json_t *result = bench_result_new();
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < sizeof views / sizeof *views && status == CAMBER_OK; i++) {
        const bool here = views[i].own || (b->data && b->size != BENCH_TINY);
        if (here && (!only || strcmp(only, views[i].key) == 0))
            status = measure_view(b, views + i, result);
    }
    if (status == CAMBER_OK)
        return result;
    json_decref(result);
    return NULL;
}

#else
#define measure NULL
#endif

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(
        to,
        "The style city, %d x %d px, at %g px: ms from the network on the device to pixels in memory, and of Mapnik "
        "by a stripe per thread from\nthe same rings and lines; mean difference of the pictures, of 255.\n\n%-12s %7s "
        "%8s %8s %8s %9s %6s "
        "%10s\n",
        BENCH_SIDE_PX, BENCH_SIDE_PX, BENCH_SIMPLIFY_PX, "city", "layers", "edges", "tess.", "frame", "Mapnik", "times",
        "difference");
    json_array_foreach(bench_result_rows(result), i, row) {
        const double ms = bench_number(row, "cl_frame_ms"), mapnik_ms = bench_number(row, "mapnik_ms");
        fprintf(to, "%-12s %7.0f %8.0f %8.1f %8.1f %9.1f %6.2f %10.2f\n", bench_text(row, "scene"),
                bench_number(row, "layers"), bench_number(row, "edges"), bench_number(row, "tessellate_ms"), ms,
                mapnik_ms, ms > 0 ? mapnik_ms / ms : 0, bench_number(row, "difference"));
    }
}

const bench_section bench_section_city = {"city", measure, print};
