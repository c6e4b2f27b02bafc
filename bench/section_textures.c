/* Where kernels' pixels go: to rows in host memory with no GL at all, or through a buffer that GL shares into a
 * texture, mapped or copied. Beside them GL's own frame in a texture. */
#include "bench.h"

#include "base/base.h"
#include "draw/renderer.h"

#include <string.h>

enum { WAY_ROWS, WAY_ZERO_COPY, WAY_COPY, WAY_GL, WAYS };

static const struct {
    const char *key, *name;
    camber_renderer_desc desc;
} ways[WAYS] = {
    {"rows_ms", "rows, no GL", {.rasterizer = CAMBER_RASTERIZER_OPENCL}},
    {"zero_copy_ms",
     "texture, zero copy",
     {.rasterizer = CAMBER_RASTERIZER_OPENCL, .sharing = CAMBER_SHARING_ZERO_COPY}},
    {"copy_ms", "texture, copy", {.rasterizer = CAMBER_RASTERIZER_OPENCL, .sharing = CAMBER_SHARING_COPY}},
    {"gl_ms", "texture, drawn by GL", {.rasterizer = CAMBER_RASTERIZER_GL}},
};

typedef struct trial {
    bench *b;
    const bench_scene *scene;
    camber_renderer *renderers[WAYS]; /* NULL: the way does not work here */
    camber_mesh *meshes[WAYS];
    uint32_t texture;
    bench_series series[WAYS];
} trial;

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    uint8_t *picture = user;
    memcpy(picture + 4 * (size_t)BENCH_SIDE_PX * first_row, rgba, 4 * (size_t)BENCH_SIDE_PX * row_count);
    return true;
}

static camber_status open_way(trial *t, int way, const camber_polylines *polylines) {
    const camber_stroke stroke = {.width_px = t->scene->width_px};
    const camber_tessellation_desc strokes = {.strokes = &stroke, .stroke_count = 1};
    camber_surface *surface = way == WAY_ROWS ? NULL : t->b->surface;
    camber_status status = camber_renderer_create(t->b->device, surface, &ways[way].desc, &t->renderers[way]);
    if (status == CAMBER_ERROR_DEVICE)
        return CAMBER_OK; /* and it has been said */
    if (status == CAMBER_OK)
        status = camber_mesh_create(t->b->device, t->renderers[way], &t->meshes[way]);
    return status == CAMBER_OK ? camber_mesh_tessellate(t->meshes[way], polylines, &strokes) : status;
}

static camber_status open_trial(trial *t) {
    const camber_gl *gl = &t->b->surface->gl;
    const camber_polylines_desc lines = {.points = t->scene->lines.points,
                                         .point_count = t->scene->lines.point_count,
                                         .offsets = t->scene->lines.offsets,
                                         .polyline_count = t->scene->lines.polyline_count,
                                         .keep_open = true};
    camber_polylines *polylines = NULL;
    camber_status status = camber_polylines_create(t->b->context, &lines, &polylines);
    for (int way = 0; way < WAYS && status == CAMBER_OK; way++)
        status = open_way(t, way, polylines);
    camber_polylines_destroy(polylines);
    if (status == CAMBER_OK)
        status = camber_surface_make_current(t->b->surface);
    if (status != CAMBER_OK)
        return status;
    gl->GenTextures(1, &t->texture);
    gl->BindTexture(GL_TEXTURE_2D, t->texture);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, BENCH_SIDE_PX, BENCH_SIDE_PX);
    return CAMBER_OK;
}

static void close_trial(trial *t) {
    if (camber_surface_try_current(t->b->surface))
        t->b->surface->gl.DeleteTextures(1, &t->texture);
    for (int way = 0; way < WAYS; way++) {
        camber_mesh_destroy(t->meshes[way]);
        camber_renderer_destroy(t->renderers[way]);
    }
}

static camber_status draw(trial *t, int way, bool counts) {
    const camber_paint paint = {.width_px = t->scene->width_px, .color = {0, 0, 0, 1}};
    const camber_pass pass = {.mesh = t->meshes[way], .paints = &paint, .paint_count = 1};
    const camber_frame frame = {
        .width = BENCH_SIDE_PX, .height = BENCH_SIDE_PX, .background = {1, 1, 1, 1}, .passes = &pass, .pass_count = 1};
    const double begin = camber_now_ms();
    const camber_status status =
        way == WAY_ROWS
            ? camber_renderer_render(t->renderers[way], &frame, take_rows, t->b->picture, NULL)
            : camber_renderer_render_texture(t->renderers[way], &frame, &(camber_texture){.name = t->texture}, NULL);
    if (status == CAMBER_OK && counts)
        bench_series_add(t->series + way, camber_now_ms() - begin);
    return status;
}

static camber_status measure_scene(bench *b, const bench_scene *scene, void *user, json_t *result) {
    trial t = {.b = b, .scene = scene};
    camber_status status = open_trial(&t);
    (void)user;
    for (size_t run = 0; run < b->warm_ups + b->runs; run++)
        for (int way = 0; way < WAYS && status == CAMBER_OK; way++)
            if (t.renderers[way])
                status = draw(&t, way, run >= b->warm_ups);
    close_trial(&t);
    if (status != CAMBER_OK)
        return status;
    const double rows_ms = bench_series_median(t.series + WAY_ROWS);
    json_t *row =
        json_pack("{s:s, s:s, s:f}", "key", scene->key, "scene", scene->name, "width_px", (double)scene->width_px);
    for (int way = 0; way < WAYS; way++) {
        const double ms = bench_series_median(t.series + way);
        json_object_set_new(row, ways[way].key, bench_ms(ms));
        if (way != WAY_ROWS && ms > 0)
            bench_result_add_figure(result,
                                    &(bench_figure){scene->key, ways[way].name, ways[0].name, rows_ms / ms, false});
    }
    bench_result_add_row(result, row);
    return CAMBER_OK;
}

static json_t *measure(bench *b, const char *only) {
    return bench_measure_scenes(b, only, measure_scene, NULL);
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to, "A frame of %d x %d px that kernels draw, ms: to rows in host memory, or into a texture of GL's.\n\n",
            BENCH_SIDE_PX, BENCH_SIDE_PX);
    fprintf(to, "%-12s", "scene");
    for (int way = 0; way < WAYS; way++)
        fprintf(to, " %20s", ways[way].name);
    fprintf(to, "\n");
    json_array_foreach(bench_result_rows(result), i, row) {
        fprintf(to, "%-12s", bench_text(row, "scene"));
        for (int way = 0; way < WAYS; way++)
            fprintf(to, " %20.1f", bench_number(row, ways[way].key));
        fprintf(to, "\n");
    }
}

const bench_section bench_section_textures = {"textures", measure, print};
