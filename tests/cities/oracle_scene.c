/* Whole road networks against the oracle, with Cairo as the peer: every line stroked by itself, black on white, round
 * joins and butt ends; the mean difference from the union of all strokes over a square in the middle, as GL draws them
 * and as kernels do. Then the same lines as a network whose camera leaves points out. Needs the extracts under
 * $CAMBER_DATA/data; ends in 77 without them. */
#include "validate/oracle.h"

#include "camber_network.h"

#include <cairo.h>
#include <cpl_error.h>
#include <gdal.h>
#include <ogr_api.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_PX = 2048, CROP_AT_PX = 800, CROP_PX = 400, SKIPPED = 77 };
/* A map leaves out so much unless told otherwise. */
static const double SIMPLIFY_PX = 0.1;

/* World coordinates, then pixels of the picture. */
typedef struct network {
    double *world; /* pairs, 0 to 1 */
    float *points;
    size_t point_count, point_capacity;
    uint32_t *offsets;
    size_t line_count, line_capacity;
    camber_camera camera; /* of the same picture */
    camber_network *held; /* by which the device has it */
} network;

typedef struct core {
    camber_context *context;
    camber_surface *surface;
    camber_device *device;
    camber_renderer *renderer; /* GL */
    camber_mesh *mesh;
} core;

/* How much larger than GL's the error of what kernels draw may be: the two round differently. */
static const double CL_MOST = 1.005;

static void *must(void *block) {
    if (!block)
        abort();
    return block;
}

/* ---- Reading ---- */

static void add_line(network *n, OGRGeometryH line) {
    const double pi = 3.14159265358979323846;
    const int count = OGR_G_GetPointCount(line);
    if (n->line_count + 2 > n->line_capacity) {
        n->line_capacity = 2 * n->line_capacity + 1024;
        n->offsets = must(realloc(n->offsets, n->line_capacity * sizeof *n->offsets));
        n->offsets[0] = 0;
    }
    if (n->point_count + (size_t)count > n->point_capacity) {
        n->point_capacity = 2 * n->point_capacity + (size_t)count + 4096;
        n->world = must(realloc(n->world, n->point_capacity * 2 * sizeof *n->world));
    }
    for (int i = 0; i < count; i++) {
        const double latitude = OGR_G_GetY(line, i) * pi / 180;
        n->world[2 * n->point_count] = (OGR_G_GetX(line, i) + 180) / 360;
        n->world[2 * n->point_count++ + 1] = (1 - asinh(tan(latitude)) / pi) / 2;
    }
    n->offsets[++n->line_count] = (uint32_t)n->point_count;
}

/* The ways with a highway tag. false: the file is not there. */
static bool read_highways(network *n, const char *path) {
    GDALDatasetH dataset = GDALOpenEx(path, GDAL_OF_VECTOR | GDAL_OF_READONLY, NULL, NULL, NULL);
    if (!dataset)
        return false;
    OGRLayerH from = NULL;
    for (OGRFeatureH f; (f = GDALDatasetGetNextFeature(dataset, &from, NULL, NULL, NULL)) != NULL;) {
        OGRGeometryH line = OGR_F_GetGeometryRef(f);
        const int field = OGR_F_GetFieldIndex(f, "highway");
        if (strcmp(OGR_L_GetName(from), "lines") == 0 && line && field >= 0 && OGR_F_IsFieldSetAndNotNull(f, field))
            add_line(n, line);
        OGR_F_Destroy(f);
    }
    GDALClose(dataset);
    return n->line_count > 1000;
}

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Where the middle 99 % of the points begin and end on an axis. */
static void middle(const network *n, int axis, double *least, double *most) {
    double *sorted = must(malloc(n->point_count * sizeof *sorted));
    for (size_t i = 0; i < n->point_count; i++)
        sorted[i] = n->world[2 * i + (size_t)axis];
    qsort(sorted, n->point_count, sizeof *sorted, compare_doubles);
    *least = sorted[(size_t)((double)n->point_count * 0.005)];
    *most = sorted[(size_t)((double)n->point_count * 0.995)];
    free(sorted);
}

/* The middle 99 % of the points span the picture. */
static void fit(network *n) {
    double left, right, top, bottom;
    middle(n, 0, &left, &right);
    middle(n, 1, &top, &bottom);
    const double scale = SIDE_PX / fmax(right - left, bottom - top);
    n->camera = (camber_camera){.x = left + 0.5 * SIDE_PX / scale,
                                .y = top + 0.5 * SIDE_PX / scale,
                                .scale_px = scale,
                                .width = SIDE_PX,
                                .height = SIDE_PX,
                                .simplify_px = SIMPLIFY_PX};
    n->points = must(malloc(n->point_count * 2 * sizeof *n->points));
    for (size_t i = 0; i < n->point_count; i++) {
        n->points[2 * i] = (float)((n->world[2 * i] - left) * scale);
        n->points[2 * i + 1] = (float)((n->world[2 * i + 1] - top) * scale);
    }
}

static bool make_network(network *n, camber_context *context) {
    size_t *offsets = must(calloc(n->line_count + 1, sizeof *offsets));
    float *importance = must(calloc(n->point_count + 1, sizeof *importance));
    for (size_t i = 0; i <= n->line_count; i++)
        offsets[i] = n->offsets[i];
    const camber_network_desc desc = {.points = n->world,
                                      .offsets = offsets,
                                      .polyline_count = n->line_count,
                                      .importance = importance,
                                      .keep_open = true};
    camber_status status = camber_importance_weigh(context, n->world, offsets, n->line_count, importance);
    if (status == CAMBER_OK)
        status = camber_network_create(context, &desc, &n->held);
    free(importance);
    free(offsets);
    return status == CAMBER_OK;
}

static void free_network(network *n) {
    camber_network_destroy(n->held);
    free(n->world);
    free(n->points);
    free(n->offsets);
}

/* ---- Drawing: 255 is ink ---- */

static bool keep_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    uint8_t *levels = user;
    for (size_t i = 0; i < (size_t)row_count * SIDE_PX; i++)
        levels[(size_t)first_row * SIDE_PX + i] = (uint8_t)(255 - rgba[4 * i]);
    return true;
}

/* Lines to draw: all points of all of them, or those that the camera keeps. */
typedef enum source {
    ALL_POINTS,
    SIMPLIFIED,
} source;

static bool draw(const core *c, const network *n, source from, double width_px, camber_overlap overlap,
                 uint8_t *levels) {
    const camber_stroke stroke = {(float)width_px, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_paint paint = {.width_px = (float)width_px, .color = {0, 0, 0, 1}};
    const camber_polylines_desc desc = {n->points, n->point_count, n->offsets, n->line_count, NULL, true};
    const camber_tessellation_desc tessellation = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    camber_polylines *polylines = NULL;
    camber_status status = CAMBER_OK;
    if (from == ALL_POINTS) {
        status = camber_polylines_create(c->context, &desc, &polylines);
        if (status == CAMBER_OK)
            status = camber_mesh_tessellate(c->mesh, polylines, &tessellation);
    } else {
        status = camber_mesh_tessellate_network(c->mesh, n->held, &n->camera, &tessellation);
    }
    if (status == CAMBER_OK) {
        const camber_pass pass = {.mesh = c->mesh, .paints = &paint, .paint_count = 1, .overlap = overlap};
        const camber_frame frame = {
            .width = SIDE_PX, .height = SIDE_PX, .background = {1, 1, 1, 1}, .passes = &pass, .pass_count = 1};
        status = camber_renderer_render(c->renderer, &frame, keep_rows, levels, NULL);
    }
    camber_polylines_destroy(polylines);
    return status == CAMBER_OK;
}

static void draw_with_cairo(const network *n, double width_px, uint8_t *levels) {
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, SIDE_PX, SIDE_PX);
    cairo_t *cairo = cairo_create(surface);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_set_source_rgb(cairo, 0, 0, 0);
    cairo_set_line_width(cairo, width_px);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_tolerance(cairo, 0.25);
    for (size_t i = 0; i < n->line_count; i++) {
        for (uint32_t k = n->offsets[i]; k < n->offsets[i + 1]; k++)
            (k == n->offsets[i] ? cairo_move_to : cairo_line_to)(cairo, n->points[2 * k], n->points[2 * k + 1]);
        cairo_stroke(cairo);
    }
    cairo_surface_flush(surface);
    const unsigned char *pixels = cairo_image_surface_get_data(surface);
    const size_t stride = (size_t)cairo_image_surface_get_stride(surface);
    for (size_t y = 0; y < SIDE_PX; y++)
        for (size_t x = 0; x < SIDE_PX; x++)
            levels[y * SIDE_PX + x] = (uint8_t)(255 - pixels[y * stride + 4 * x]);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
}

/* ---- Judging ---- */

/* In 255ths, over the crop. */
static double mean_error(const camber_oracle_window *truth, const uint8_t *levels) {
    double sum = 0;
    for (int y = 0; y < CROP_PX; y++)
        for (int x = 0; x < CROP_PX; x++) {
            const int level = levels[(size_t)(CROP_AT_PX + y) * SIDE_PX + (size_t)(CROP_AT_PX + x)];
            sum += abs((int)lrint(255 * camber_oracle_coverage(truth, x, y)) - level);
        }
    return sum / (CROP_PX * CROP_PX);
}

/* How much of Cairo's error may be left: drawn line over line, and united; and how much larger than line over line it
 * may be where points are left out. */
typedef struct bounds {
    double over, united, simplified;
} bounds;

/* Bytes a segment that the mesh takes on the device, with every point at the first width. */
static bool judge_bytes(const core *c, const network *n, double width_px, double most) {
    uint8_t *levels = must(malloc((size_t)SIDE_PX * SIDE_PX));
    const bool drawn = draw(c, n, ALL_POINTS, width_px, CAMBER_OVERLAP_FLATTEN, levels);
    const double bytes =
        (double)camber_mesh_get_info(c->mesh).bytes / (double)camber_network_get_stats(n->held).kept_segments;
    const bool good = drawn && bytes <= most;
    printf("%s - %g px: %.1f bytes a segment (bound %.0f)\n", good ? "ok" : "not ok", width_px, bytes, most);
    free(levels);
    return good;
}

static bool judge(const core *c, const core *in_cl, const network *n, double width_px, bounds most) {
    const camber_oracle_style style = {width_px, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 2, false};
    uint8_t *levels = must(malloc((size_t)SIDE_PX * SIDE_PX));
    camber_oracle_window truth;
    if (!camber_oracle_open(&truth, CROP_AT_PX, CROP_AT_PX, CROP_PX, CROP_PX))
        abort();
    for (size_t i = 0; i < n->line_count; i++)
        if (!camber_oracle_stroke(&truth, n->points + 2 * (size_t)n->offsets[i], n->offsets[i + 1] - n->offsets[i],
                                  &style))
            abort();
    bool good = draw(c, n, ALL_POINTS, width_px, CAMBER_OVERLAP_FLATTEN, levels);
    const double over = mean_error(&truth, levels);
    good = draw(c, n, ALL_POINTS, width_px, CAMBER_OVERLAP_UNITE, levels) && good;
    const double united = mean_error(&truth, levels);
    good = draw(c, n, SIMPLIFIED, width_px, CAMBER_OVERLAP_FLATTEN, levels) && good;
    const double simplified = mean_error(&truth, levels);
    good = draw(in_cl, n, ALL_POINTS, width_px, CAMBER_OVERLAP_FLATTEN, levels) && good;
    const double cl_over = mean_error(&truth, levels);
    good = draw(in_cl, n, ALL_POINTS, width_px, CAMBER_OVERLAP_UNITE, levels) && good;
    const double cl_united = mean_error(&truth, levels);
    draw_with_cairo(n, width_px, levels);
    const double cairo = mean_error(&truth, levels);
    good = good && over <= most.over * cairo && united <= most.united * cairo && simplified <= most.simplified * over &&
           cl_over <= CL_MOST * over && cl_united <= CL_MOST * united;
    printf("%s - %g px: mean error %.3f, united %.3f, Cairo %.3f: %.3f (bound %.2f) and %.3f (%.2f) of it\n",
           good ? "ok" : "not ok", width_px, over, united, cairo, over / cairo, most.over, united / cairo, most.united);
    printf("#   in OpenCL: %.3f, united %.3f: %.4f and %.4f of GL's (bound %.3f)\n", cl_over, cl_united, cl_over / over,
           cl_united / united, CL_MOST);
    printf("#   at %g px of simplification: %.3f, %.3f of it (bound %.2f)\n", SIMPLIFY_PX, simplified,
           simplified / over, most.simplified);
    camber_oracle_close(&truth);
    free(levels);
    return good;
}

static void print_log(void *user, camber_log_level level, const char *message) {
    (void)user;
    if (level == CAMBER_LOG_ERROR)
        printf("# %s\n", message);
}

static bool open_renderer(core *c, camber_rasterizer draws) {
    const camber_renderer_desc desc = {.rasterizer = draws};
    return camber_renderer_create(c->device, c->surface, &desc, &c->renderer) == CAMBER_OK &&
           camber_mesh_create(c->device, c->renderer, &c->mesh) == CAMBER_OK;
}

static bool open_core(core *c) {
    const camber_context_desc desc = {.log = print_log};
    return camber_context_create(&desc, &c->context) == CAMBER_OK &&
           camber_surface_create(c->context, NULL, &c->surface) == CAMBER_OK &&
           camber_device_create(c->context, &(camber_device_desc){.gl = camber_surface_get_handles(c->surface)},
                                &c->device) == CAMBER_OK &&
           open_renderer(c, CAMBER_RASTERIZER_GL);
}

static void close_renderer(core *c) {
    camber_mesh_destroy(c->mesh);
    camber_renderer_destroy(c->renderer);
}

static void close_core(core *c) {
    close_renderer(c);
    camber_device_destroy(c->device);
    camber_surface_destroy(c->surface);
    camber_context_destroy(c->context);
}

int main(void) {
    static const struct {
        const char *name, *file;
        double most_bytes; /* a segment at 8 px */
        bounds most[3];    /* at 8, 3 and 1 px */
    } scenes[] = {
        {"nyc", "nyc.osm.pbf", 34, {{0.7, 0.45, 1.4}, {0.9, 0.4, 1.4}, {0.7, 0.55, 1.55}}},
        {"porto", "porto_portugal.osm.pbf", 30, {{1.0, 0.55, 1.44}, {1.1, 0.7, 1.4}, {1.15, 0.8, 1.43}}},
    };
    static const double widths_px[3] = {8, 3, 1};
    const char *folder = getenv("CAMBER_DATA");
    if (!folder) {
        puts("CAMBER_DATA is not set: no scenes to judge");
        return SKIPPED;
    }
    core c = {0}, in_cl = {0};
    bool good = true;
    int status = SKIPPED;
    CPLSetErrorHandler(CPLQuietErrorHandler); /* GDAL warns of every area that does not close */
    GDALAllRegister();
    if (!open_core(&c))
        goto done;
    in_cl = (core){.context = c.context, .device = c.device};
    if (!open_renderer(&in_cl, CAMBER_RASTERIZER_OPENCL))
        goto done;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        network n = {0};
        char path[4096];
        snprintf(path, sizeof path, "%s/data/%s", folder, scenes[i].file);
        if (!read_highways(&n, path)) {
            printf("# %s cannot be read: not judged\n", path);
        } else {
            fit(&n);
            printf("# %s: %zu lines, %zu points\n", scenes[i].name, n.line_count, n.point_count);
            good = make_network(&n, c.context) && good;
            good = n.held && judge_bytes(&c, &n, widths_px[0], scenes[i].most_bytes) && good;
            for (int w = 0; w < 3 && n.held; w++)
                good = judge(&c, &in_cl, &n, widths_px[w], scenes[i].most[w]) && good;
            status = good ? 0 : 1;
        }
        free_network(&n);
    }
done:
    close_renderer(&in_cl);
    close_core(&c);
    return status;
}
