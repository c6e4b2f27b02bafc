/* camber_bench: every stage and a frame on real and made scenes, and Cairo on the same polylines, in turn in one run.
 * One table on standard output; a JSON line a scene with --json FILE. Times are medians. */
#include "bench.h"

#include "base/base.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum { WARM_UPS = 2, RUNS = 9, SCENES_MAX = 16 };

typedef struct bench {
    camber_context *context;
    camber_surface *surface;
    camber_device *device;
    camber_renderer *renderer;
    camber_mesh *mesh;
    FILE *json;
} bench;

typedef struct times {
    double classify[RUNS], scan[RUNS], emit[RUNS], tessellate[RUNS], draw[RUNS], united[RUNS], frame[RUNS], cairo[RUNS],
        copy[RUNS];
} times;

static void on_log(void *user, camber_log_level level, const char *message) {
    (void)user;
    if (level != CAMBER_LOG_INFO)
        fprintf(stderr, "camber_bench: %s\n", message);
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double values[RUNS]) {
    qsort(values, RUNS, sizeof *values, ascending);
    return values[RUNS / 2];
}

/* ---- One scene ---- */

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    uint8_t *picture = user;
    memcpy(picture + 4 * (size_t)BENCH_SIDE_PX * first_row, rgba, 4 * (size_t)BENCH_SIDE_PX * row_count);
    return true;
}

static camber_status make_polylines(bench *b, const bench_scene *scene, camber_polylines **polylines) {
    const camber_polylines_desc desc = {.points = scene->lines.points,
                                        .point_count = scene->lines.point_count,
                                        .offsets = scene->lines.offsets,
                                        .polyline_count = scene->lines.polyline_count,
                                        .keep_open = true};
    return camber_polylines_create(b->context, &desc, polylines);
}

static camber_status tessellate(bench *b, const bench_scene *scene, const camber_polylines *polylines) {
    const camber_stroke stroke = {.width_px = scene->width_px};
    return camber_tessellate(b->mesh, polylines, &(camber_tessellation_desc){.strokes = &stroke, .stroke_count = 1});
}

static camber_status draw(bench *b, const bench_scene *scene, camber_overlap overlap, uint8_t *picture,
                          camber_frame_stats *stats) {
    const camber_paint paint = {scene->width_px, {0, 0, 0, 1}};
    const camber_pass pass = {.mesh = b->mesh, .paints = &paint, .paint_count = 1, .overlap = overlap};
    const camber_frame frame = {
        .width = BENCH_SIDE_PX, .height = BENCH_SIDE_PX, .background = {1, 1, 1, 1}, .passes = &pass, .pass_count = 1};
    return camber_render(b->renderer, &frame, picture ? take_rows : NULL, picture, stats);
}

/* A frame, from lines in memory to pixels in memory; and its drawing once more, united. */
static camber_status run_frame(bench *b, const bench_scene *scene, uint8_t *picture, times *t, int run) {
    camber_polylines *polylines = NULL;
    camber_frame_stats stats = {0};
    const double begin = camber_now_ms();
    camber_status status = make_polylines(b, scene, &polylines);
    if (status == CAMBER_OK)
        status = tessellate(b, scene, polylines);
    if (status == CAMBER_OK)
        status = draw(b, scene, CAMBER_OVERLAP_FLATTEN, picture, &stats);
    if (status == CAMBER_OK && run >= 0) {
        t->frame[run] = camber_now_ms() - begin;
        t->draw[run] = stats.draw_ms;
    }
    if (status == CAMBER_OK)
        status = draw(b, scene, CAMBER_OVERLAP_UNITE, NULL, &stats);
    if (status == CAMBER_OK && run >= 0)
        t->united[run] = stats.draw_ms;
    camber_polylines_destroy(polylines);
    return status;
}

/* The tessellation alone, its input and output resident on the device. */
static camber_status run_tessellation(bench *b, const bench_scene *scene, times *t) {
    camber_polylines *polylines = NULL;
    camber_status status = make_polylines(b, scene, &polylines);
    for (int run = -WARM_UPS; run < RUNS && status == CAMBER_OK; run++) {
        const double begin = camber_now_ms();
        status = tessellate(b, scene, polylines);
        if (status != CAMBER_OK || run < 0)
            continue;
        t->tessellate[run] = camber_now_ms() - begin;
        const camber_mesh_info info = camber_mesh_get_info(b->mesh);
        t->classify[run] = info.classify_ms;
        t->scan[run] = info.scan_ms;
        t->emit[run] = info.emit_ms;
    }
    camber_polylines_destroy(polylines);
    return status;
}

/* memcpy of as many bytes as the mesh has, on one thread: what writing them costs at least. */
static double copy_ms(void *to, const void *from, size_t size_bytes) {
    const double begin = camber_now_ms();
    memcpy(to, from, size_bytes);
    return camber_now_ms() - begin;
}

static void print_row(bench *b, const bench_scene *scene, times *t) {
    const camber_mesh_info info = camber_mesh_get_info(b->mesh);
    size_t segments = 0;
    for (size_t i = 0; i < scene->lines.polyline_count; i++) {
        const uint32_t count = scene->lines.offsets[i + 1] - scene->lines.offsets[i];
        segments += count > 1 ? count - 1 : 0;
    }
    const double bytes = (double)info.bytes;
    const double tessellate = median(t->tessellate), frame = median(t->frame), cairo = median(t->cairo),
                 draw_ms = median(t->draw), united = median(t->united);
    const double classify = median(t->classify), scan = median(t->scan), emit = median(t->emit), copy = median(t->copy);
    const double millions = (double)segments / 1e3;
    printf("%-22s %7zu %8zu %5.1f %6.2f %6.2f %6.2f %7.2f %7.1f %6.1f %6.2f %7.1f %7.1f %7.1f", scene->name,
           scene->lines.polyline_count, segments, bytes / (double)segments, classify, scan, emit, tessellate,
           millions / (classify + scan + emit), bytes / 1e6 / (classify + scan + emit), copy / emit, draw_ms, united,
           frame);
    if (cairo > 0)
        printf(" %7.1f %6.2f", cairo, cairo / frame);
    printf("\n");
    fflush(stdout);
    if (b->json)
        fprintf(
            b->json,
            "{\"scene\":\"%s\",\"width_px\":%g,\"polylines\":%zu,\"segments\":%zu,\"vertices\":%zu,\"triangles\":%zu,"
            "\"bytes\":%.0f,\"classify_ms\":%.4f,\"scan_ms\":%.4f,\"emit_ms\":%.4f,\"tessellate_ms\":%.4f,"
            "\"memcpy_ms\":%.4f,\"draw_ms\":%.3f,\"draw_united_ms\":%.3f,\"frame_ms\":%.3f,\"cairo_ms\":%.3f}\n",
            scene->name, (double)scene->width_px, scene->lines.polyline_count, segments, info.vertex_count,
            info.triangle_count, bytes, classify, scan, emit, tessellate, copy, draw_ms, united, frame, cairo);
}

/* memcpy of the vertices, as often as the tessellation ran. */
static camber_status run_copy(bench *b, times *t) {
    camber_mesh_data data = {0};
    camber_status status = camber_mesh_read(b->mesh, &data);
    void *copy = camber_alloc(b->context, data.info.vertex_count, sizeof *data.vertices);
    if (status == CAMBER_OK && !copy)
        status = CAMBER_ERROR_MEMORY;
    for (int run = -WARM_UPS; run < RUNS && status == CAMBER_OK; run++) {
        const double ms = copy_ms(copy, data.vertices, data.info.vertex_count * sizeof *data.vertices);
        if (run >= 0)
            t->copy[run] = ms;
    }
    camber_free(b->context, copy);
    camber_mesh_data_free(b->context, &data);
    return status;
}

static camber_status run_scene(bench *b, const bench_scene *scene) {
    times t;
    uint8_t *picture = camber_alloc(b->context, (size_t)BENCH_SIDE_PX * BENCH_SIDE_PX, 4);
    camber_status status = picture ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    /* In turn, so that a machine whose speed drifts is fair to both. */
    for (int run = -WARM_UPS; run < RUNS && status == CAMBER_OK; run++) {
        status = run_frame(b, scene, picture, &t, run);
        const double cairo_ms = bench_cairo_ms(scene);
        if (run >= 0)
            t.cairo[run] = cairo_ms;
    }
    if (status == CAMBER_OK)
        status = run_tessellation(b, scene, &t);
    if (status == CAMBER_OK)
        status = run_copy(b, &t);
    if (status == CAMBER_OK)
        print_row(b, scene, &t);
    camber_free(b->context, picture);
    return status;
}

/* ---- All scenes ---- */

typedef struct scene_list {
    bench_scene scenes[SCENES_MAX];
    size_t count;
} scene_list;

#ifdef CAMBER_DEMO_CITY
static void add_map(bench *b, scene_list *list, const char *name, const char *path, float width_px) {
    bench_scene *scene = list->scenes + list->count;
    if (!bench_scene_map(b->context, path, &scene->lines)) {
        fprintf(stderr, "camber_bench: %s is left out: %s cannot be read\n", name, path);
        return;
    }
    snprintf(scene->name, sizeof scene->name, "%s, %g px", name, (double)width_px);
    scene->width_px = width_px;
    list->count++;
}
#endif

static void add_walks(bench *b, scene_list *list, const char *name, size_t polylines, double step_px, float width_px) {
    bench_scene *scene = list->scenes + list->count;
    if (!bench_scene_walks(b->context, polylines, step_px, &scene->lines))
        return;
    snprintf(scene->name, sizeof scene->name, "%s, %g px", name, (double)width_px);
    scene->width_px = width_px;
    list->count++;
}

static void fill(bench *b, scene_list *list) {
#ifdef CAMBER_DEMO_CITY
    add_map(b, list, "Santa Cruz", CAMBER_DEMO_CITY, 2);
    const char *data = getenv("CAMBER_DATA");
    static const struct {
        const char *name, *file;
        float width_px;
    } cities[] = {{"Porto", "porto_portugal.osm.pbf", 2},
                  {"New York", "nyc.osm.pbf", 4},
                  {"Columbus", "columbus.osm.pbf", 2},
                  {"Beijing", "beijing-2013.geojson", 4}};
    for (size_t i = 0; data && i < sizeof cities / sizeof *cities; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/data/%s", data, cities[i].file);
        add_map(b, list, cities[i].name, path, cities[i].width_px);
    }
    if (!data)
        fprintf(stderr, "camber_bench: CAMBER_DATA is unset: the larger cities are left out\n");
#endif
    add_walks(b, list, "long walks", 10000, 32, 8);
    add_walks(b, list, "short walks", 200000, 3.2, 2);
}

static camber_status run_all(bench *b) {
    scene_list list = {.count = 0};
    camber_status status = CAMBER_OK;
    fill(b, &list);
    const char *cairo = bench_cairo_version();
    const camber_device_info device = camber_device_get_info(b->device);
    const camber_surface_info surface = camber_surface_get_info(b->surface);
    printf("%s (%s %s), %u units; %s; sharing: %s; camber %s%s%s\n", device.name, device.platform, device.driver,
           device.compute_units, surface.renderer, camber_sharing_name(camber_renderer_get_sharing(b->renderer)),
           camber_version(), cairo ? "; Cairo " : "", cairo ? cairo : "");
    printf("%d x %d px, round joins, butt caps, black on white; ms, medians of %d after %d. M/s: segments through the "
           "kernels.\n"
           "GB/s: bytes written by the kernels; cpy/emit: memcpy of the vertices on one thread against emit.\n\n",
           BENCH_SIDE_PX, BENCH_SIDE_PX, RUNS, WARM_UPS);
    printf("%-22s %7s %8s %5s %6s %6s %6s %7s %7s %6s %6s %7s %7s %7s%s\n", "scene", "lines", "segments", "B/seg",
           "class.", "scan", "emit", "tess.", "M/s", "GB/s", "cpy/em", "draw", "united", "frame",
           cairo ? "   Cairo  ratio" : "");
    for (size_t i = 0; i < list.count && status == CAMBER_OK; i++)
        status = run_scene(b, list.scenes + i);
    for (size_t i = 0; i < list.count; i++)
        camber_lines_free(b->context, &list.scenes[i].lines);
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        printf("\npeak memory %.0f MB\n", (double)usage.ru_maxrss / 1e3);
    return status;
}

static camber_status open_bench(bench *b) {
    const camber_context_desc desc = {.log = on_log};
    camber_status status = camber_context_create(&desc, &b->context);
    if (status == CAMBER_OK)
        status = camber_surface_create(b->context, NULL, &b->surface);
    if (status == CAMBER_OK)
        status = camber_device_create(b->context, NULL, b->surface, &b->device);
    if (status == CAMBER_OK)
        status = camber_renderer_create(b->device, b->surface, NULL, &b->renderer);
    if (status == CAMBER_OK)
        status = camber_mesh_create(b->device, b->renderer, &b->mesh);
    return status;
}

int main(int argc, char **argv) {
    bench b = {0};
    if (argc != 1 && !(argc == 3 && strcmp(argv[1], "--json") == 0)) {
        fprintf(stderr, "usage: camber_bench [--json FILE]\n");
        return 2;
    }
    if (argc == 3 && !(b.json = fopen(argv[2], "w"))) {
        perror(argv[2]);
        return 73;
    }
    /* As the tool does: a core for each of PoCL's threads. */
    setenv("POCL_AFFINITY", "1", 0);
    camber_status status = open_bench(&b);
    if (status == CAMBER_OK)
        status = run_all(&b);
    camber_mesh_destroy(b.mesh);
    camber_renderer_destroy(b.renderer);
    camber_device_destroy(b.device);
    camber_surface_destroy(b.surface);
    camber_context_destroy(b.context);
    if (b.json && fclose(b.json) != 0)
        status = CAMBER_ERROR_IO;
    return status == CAMBER_OK ? 0 : 1;
}
