/* Every kernel, method, join and cap on a few hundred points, against the twin: small enough for a simulator that
 * checks bounds and races. Run by test_oclgrind.sh; without the simulator it is a quick test of whatever device there
 * is. */
#include "camber.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { POINTS_MAX = 1024, LINES_MAX = 200 };

typedef struct scene {
    float points[2 * POINTS_MAX];
    uint32_t offsets[LINES_MAX + 1];
    size_t point_count, line_count;
} scene;

static void add_point(scene *s, double x, double y) {
    s->points[2 * s->point_count] = (float)x;
    s->points[2 * s->point_count + 1] = (float)y;
    s->point_count++;
}

static void end_line(scene *s) {
    s->offsets[++s->line_count] = (uint32_t)s->point_count;
}

/* Rings, stars whose turns are tight or past 127 degrees, dots, reversals, repeated points: past one block. */
static void fill(scene *s) {
    for (int ring = 0; ring < 12; ring++) {
        const int corners = 3 + ring % 7;
        for (int i = 0; i <= corners; i++) {
            const double angle = 6.283185307 * (i % corners) * (ring % 3 + 1) / corners;
            add_point(s, 100 + 11 * ring + (3 + ring) * cos(angle), 100 + (3 + ring) * sin(angle));
        }
        end_line(s);
    }
    for (int line = 0; line < 60; line++) {
        for (int i = 0; i <= line % 7; i++)
            add_point(s, 7.0 * line + i * 13 % 5, 50 + i * i * 7 % 23);
        end_line(s);
    }
    const double there_and_back[][2] = {{5, 5}, {25, 5}, {5, 5}, {5, 5}, {15, 5.001}};
    for (size_t i = 0; i < sizeof there_and_back / sizeof *there_and_back; i++)
        add_point(s, there_and_back[i][0], there_and_back[i][1]);
    end_line(s);
}

static int check(camber_context *context, camber_mesh *mesh, const camber_polylines *polylines, camber_stroke stroke,
                 camber_method method) {
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1, .method = method};
    camber_mesh_data device = {0}, twin = {0};
    int failed = camber_tessellate(mesh, polylines, &desc) != CAMBER_OK ||
                 camber_mesh_read(mesh, &device) != CAMBER_OK ||
                 camber_tessellate_on_host(context, polylines, &desc, &twin) != CAMBER_OK;
    failed = failed || device.info.vertex_count != twin.info.vertex_count ||
             device.info.index_count != twin.info.index_count ||
             memcmp(device.indices, twin.indices, twin.info.index_count * sizeof *twin.indices) != 0;
    /* A simulator need not divide as the twin does: numbers may differ in their last bits, integers may not. */
    for (size_t i = 0; !failed && i < twin.info.vertex_count; i++) {
        const camber_vertex a = device.vertices[i], b = twin.vertices[i];
        failed = a.flags != b.flags || a.row != b.row || a.across != b.across || a.x != b.x || a.y != b.y ||
                 fabsf(a.along - b.along) > 1e-3f * (1 + fabsf(b.along));
    }
    if (failed)
        printf("not ok - %s, join %d, cap %d\n", camber_method_name(method), (int)stroke.join, (int)stroke.cap);
    camber_mesh_data_free(context, &device);
    camber_mesh_data_free(context, &twin);
    return failed;
}

int main(void) {
    static scene s;
    const camber_context_desc quiet = {.cache_dir = ""};
    camber_context *context = NULL;
    camber_device *device = NULL;
    camber_mesh *mesh = NULL;
    camber_polylines *polylines = NULL;
    int failures = 1;
    fill(&s);
    const camber_polylines_desc desc = {
        .points = s.points, .point_count = s.point_count, .offsets = s.offsets, .polyline_count = s.line_count};
    if (camber_context_create(&quiet, &context) == CAMBER_OK &&
        camber_polylines_create(context, &desc, &polylines) == CAMBER_OK &&
        camber_device_create(context, NULL, NULL, &device) == CAMBER_OK &&
        camber_mesh_create(device, NULL, &mesh) == CAMBER_OK) {
        printf("%s, %zu points\n", camber_device_get_info(device).name, s.point_count);
        failures = 0;
        for (int method = 0; method < 3; method++)
            for (int join = 0; join < 3; join++)
                for (int cap = 0; cap < 3; cap++)
                    failures += check(context, mesh, polylines,
                                      (camber_stroke){.width_px = 6, .join = (camber_join)join, .cap = (camber_cap)cap},
                                      (camber_method)method);
    }
    camber_mesh_destroy(mesh);
    camber_device_destroy(device);
    camber_polylines_destroy(polylines);
    camber_context_destroy(context);
    printf("%d failures\n", failures);
    return failures ? 1 : 0;
}
