/* Every kernel, method, join, cap, size of a work-group and border of a block on some hundred points, whole and in
 * parts, against the twin: small enough for a simulator that checks bounds and races. Run by test_oclgrind.sh. */
#include "camber_proof.h"
#include "residency/mesh.h"
#include "validate/scenes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { POINTS_MAX = 2048, LINES_MAX = 200, ROWS = 9 };

/* Joins with caps, narrow and wide, with limits that miters keep and exceed. Each rotation gives a line another row. */
static void rotate(camber_made_scene *s, camber_stroke strokes[ROWS], size_t rotation) {
    for (int row = 0; row < ROWS; row++)
        strokes[row] = (camber_stroke){row % 2 ? 25.0f : 6.0f, (camber_join)(row % 3), (camber_cap)(row / 3),
                                       row == 4   ? 1.05f
                                       : row == 7 ? 10.0f
                                                  : 0.0f};
    for (size_t i = 0; i < s->polyline_count; i++)
        s->rows[i] = (uint32_t)((i + rotation) % ROWS);
}

/* ---- Device against twin ---- */

/* A simulator need not divide as the twin does: numbers may differ in their last bits, integers may not. */
static bool same_meshes(const camber_mesh_data *device, const camber_mesh_data *twin) {
    if (device->info.vertex_count != twin->info.vertex_count || device->info.index_count != twin->info.index_count ||
        memcmp(device->indices, twin->indices, twin->info.index_count * sizeof *twin->indices) != 0)
        return false;
    for (size_t i = 0; i < twin->info.vertex_count; i++) {
        const camber_vertex a = device->vertices[i], b = twin->vertices[i];
        if (a.flags != b.flags || a.row != b.row || a.across != b.across || a.x != b.x || a.y != b.y ||
            !(fabsf(a.along - b.along) <= 1e-3f * (1 + fabsf(b.along))))
            return false;
    }
    return true;
}

static bool same_stages(const camber_stages *device, const camber_stages *twin) {
    if (device->point_count != twin->point_count)
        return false;
    for (size_t i = 0; i < twin->point_count; i++) {
        const camber_point_stages *a = device->points + i, *b = twin->points + i;
        /* The upper half is integers, the lower a rounded tangent. */
        if (a->polyline != b->polyline || a->point != b->point || a->join >> 16 != b->join >> 16 ||
            a->first_vertex != b->first_vertex || a->first_index != b->first_index)
            return false;
    }
    return true;
}

static bool check(camber_context *context, camber_mesh *mesh, const camber_polylines *polylines,
                  const camber_tessellation_desc *desc) {
    camber_mesh_data device = {0}, twin = {0};
    camber_stages device_stages = {0}, twin_stages = {0};
    const bool good = camber_mesh_tessellate(mesh, polylines, desc) == CAMBER_OK &&
                      camber_mesh_read(mesh, &device) == CAMBER_OK &&
                      camber_mesh_read_stages(mesh, &device_stages) == CAMBER_OK &&
                      camber_mesh_data_tessellate(context, polylines, desc, &twin) == CAMBER_OK &&
                      camber_stages_tessellate(context, polylines, desc, &twin_stages) == CAMBER_OK &&
                      same_meshes(&device, &twin) && same_stages(&device_stages, &twin_stages);
    camber_stages_destroy(&twin_stages);
    camber_stages_destroy(&device_stages);
    camber_mesh_data_destroy(&twin);
    camber_mesh_data_destroy(&device);
    return good;
}

static int check_methods(camber_context *context, camber_mesh *mesh, const camber_made_scene *s,
                         const camber_stroke *strokes, const char *what) {
    const camber_polylines_desc desc = camber_made_scene_polylines(s);
    camber_polylines *polylines = NULL;
    int failures = 0;
    if (camber_polylines_create(context, &desc, &polylines) != CAMBER_OK)
        return 1;
    for (int method = 0; method < 3; method++) {
        const camber_tessellation_desc tessellation = {
            .strokes = strokes, .stroke_count = ROWS, .method = (camber_method)method};
        if (check(context, mesh, polylines, &tessellation))
            continue;
        printf("not ok - %s, %s\n", camber_method_get_name(tessellation.method), what);
        failures++;
    }
    camber_polylines_destroy(polylines);
    return failures;
}

/* Cameras over the lines as a network: all of it, a cut and simplified part, also as a tilted
 * camera sees it, one segment whose ends lie far outside,
 * and none. */
static int check_networks(camber_context *context, camber_mesh *mesh, const camber_made_scene *s,
                          const camber_stroke *strokes) {
    static double points[2 * POINTS_MAX];
    static float importance[POINTS_MAX];
    static size_t offsets[LINES_MAX + 1];
    static camber_network_entry entries[LINES_MAX];
    static float progress[2 * LINES_MAX]; /* parts of lines, and whole ones */
    static const camber_camera cameras[] = {
        {.x = 400, .y = 400, .scale_px = 1, .width = 2000, .height = 1500},
        {.x = 150, .y = 120, .scale_px = 3, .bearing_deg = 30, .width = 100, .height = 60, .simplify_px = 2},
        {.x = 4, .y = 313.5, .scale_px = 3e4, .bearing_deg = 200, .width = 100, .height = 60},
        {.x = 150,
         .y = 120,
         .scale_px = 3,
         .bearing_deg = 30,
         .width = 100,
         .height = 60,
         .simplify_px = 2,
         .pitch_deg = 80},
        {.x = 1e6, .scale_px = 1, .width = 100, .height = 100}};
    for (size_t i = 0; i < s->point_count; i++) {
        points[2 * i] = (double)s->points[2 * i];
        points[2 * i + 1] = (double)s->points[2 * i + 1];
        importance[i] = (float)(i % 5) * 0.3f;
    }
    for (size_t i = 0; i <= s->polyline_count; i++)
        offsets[i] = s->offsets[i];
    for (size_t i = 0; i < s->polyline_count; i++)
        entries[i] = (camber_network_entry){.polyline = (uint32_t)i, .row = s->rows[i]};
    for (size_t i = 0; i < s->polyline_count; i++) {
        progress[2 * i] = (float)(i % 4) * 0.2f;
        progress[2 * i + 1] = i % 3 ? 1.0f : 0.8f;
    }
    const camber_network_desc desc = {.points = points,
                                      .offsets = offsets,
                                      .polyline_count = s->polyline_count,
                                      .importance = importance,
                                      .entries = entries,
                                      .entry_count = s->polyline_count,
                                      .has_arc_length = true,
                                      .progress = progress};
    const camber_tessellation_desc strips = {.strokes = strokes, .stroke_count = ROWS, .has_arc_length = true};
    camber_network *network = NULL;
    int failures = camber_network_create(context, &desc, &network) != CAMBER_OK;
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras && network; i++) {
        camber_stages device = {0}, twin = {0};
        camber_polylines *seen = NULL;
        const bool good = camber_network_project(network, cameras + i, &strips, &seen) == CAMBER_OK &&
                          camber_mesh_tessellate_network(mesh, network, cameras + i, &strips) == CAMBER_OK &&
                          camber_mesh_read_stages(mesh, &device) == CAMBER_OK &&
                          camber_stages_tessellate(context, seen, &strips, &twin) == CAMBER_OK &&
                          same_stages(&device, &twin);
        if (!good)
            printf("not ok - camera %zu\n", i);
        failures += !good;
        camber_stages_destroy(&device);
        camber_stages_destroy(&twin);
        camber_polylines_destroy(seen);
    }
    camber_network_destroy(network);
    return failures;
}

/* Lines beside: of a mesh that is not measured and one that is. Where its points lie depends on every division. */
static bool check_counts(camber_context *context, camber_mesh *mesh, const camber_polylines *polylines,
                         const camber_tessellation_desc *desc) {
    camber_mesh_data device = {0}, twin = {0};
    const bool good = camber_mesh_tessellate(mesh, polylines, desc) == CAMBER_OK &&
                      camber_mesh_read(mesh, &device) == CAMBER_OK &&
                      camber_mesh_data_tessellate(context, polylines, desc, &twin) == CAMBER_OK &&
                      device.info.record_count == twin.info.record_count;
    camber_mesh_data_destroy(&twin);
    camber_mesh_data_destroy(&device);
    return good;
}

static int check_offsets(camber_context *context, camber_mesh *mesh, const camber_made_scene *s,
                         camber_stroke *strokes) {
    static const float offsets[] = {6.0f, -6.0f, 0.0f, 25.0f, -2.5f, 3.0f, -40.0f, 1.0f, -12.0f};
    const camber_polylines_desc desc = camber_made_scene_polylines(s);
    camber_polylines *polylines = NULL;
    int failures = camber_polylines_create(context, &desc, &polylines) != CAMBER_OK;
    for (size_t row = 0; row < ROWS; row++)
        strokes[row].offset_px = offsets[row % (sizeof offsets / sizeof *offsets)];
    for (int has_arc_length = 0; has_arc_length < 2 && polylines; has_arc_length++) {
        const camber_tessellation_desc strips = {
            .strokes = strokes, .stroke_count = ROWS, .has_arc_length = has_arc_length};
        if (check_counts(context, mesh, polylines, &strips))
            continue;
        printf("not ok - offsets%s\n", has_arc_length ? ", measured" : "");
        failures++;
    }
    for (size_t row = 0; row < ROWS; row++)
        strokes[row].offset_px = 0.0f;
    camber_polylines_destroy(polylines);
    return failures;
}

/* ---- Drawing ---- */

enum { PICTURE_WIDTH = 100, PICTURE_HEIGHT = 90, PICTURES = 5 };
typedef uint8_t picture[4 * PICTURE_WIDTH * PICTURE_HEIGHT];

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    memcpy((uint8_t *)user + 4 * PICTURE_WIDTH * (size_t)first_row, rgba, 4 * PICTURE_WIDTH * (size_t)row_count);
    return true;
}

/* Draws a picture, or, if there is none, a quarter of it, which nobody looks at. */
static bool render(camber_renderer *renderer, camber_frame frame, uint8_t *rgba) {
    const uint32_t parts = rgba ? 1 : 2;
    frame.width = PICTURE_WIDTH / parts;
    frame.height = PICTURE_HEIGHT / parts;
    return camber_renderer_render(renderer, &frame, rgba ? take_rows : NULL, rgba, NULL) == CAMBER_OK;
}

static const uint8_t texels[4 * 5 * 3] = {9, 0, 0, 9, 40, 50, 60, 200};
static const camber_image small_image = {texels, 5, 3, 0};

/* Ways to draw a row that plain frames do not have. */
static camber_paint rich_paint(int row, float width_px) {
    static const float lengths[] = {4, 3, 0, 2};
    static const camber_dash dash = {lengths, 4};
    static const camber_ramp_stop stops[] = {{0.1f, {1, 0, 0, 1}}, {0.5f, {0, 1, 0, 0}}, {0.5f, {0, 1, 1, 1}}};
    static const camber_ramp ramp = {stops, 3};
    camber_paint paint = {.width_px = 0.4f * width_px, .color = {0.1f * (float)row, 0, 1, row % 2 ? 0.5f : 1}};
    paint.gap_px = row % 3 == 0 ? 0.2f * width_px : 0;
    paint.blur_px = row % 4 == 1 ? 2 : 0;
    paint.dash = row % 3 == 1 ? &dash : NULL;
    paint.trim_start = 0.2f;
    paint.trim_end = row % 5 == 2 ? 0.6f : 0;
    paint.ramp = row % 3 == 2 ? &ramp : NULL;
    paint.image = row % 4 == 3 ? &small_image : NULL;
    return paint;
}

/* Pictures of the lines, opaque and in a united layer over a translucent fill, seen from above and at an angle, and
 * with all that paints have. Then the same lines as rings of areas, by both rules and with an image, between lines.
 * pictures may be NULL. */
static bool draw(camber_device *device, camber_context *context, const camber_made_scene *s,
                 const camber_stroke *strokes, picture *pictures) {
    const camber_polylines_desc desc = camber_made_scene_polylines(s);
    const camber_tessellation_desc strips = {.strokes = strokes, .stroke_count = ROWS, .has_arc_length = true};
    const camber_fill fills[] = {{.color = {1, 0, 0, 0.5f}},
                                 {.color = {0, 1, 0, 1}, .rule = CAMBER_FILL_EVENODD},
                                 {.color = {0, 0, 0, 1}, .image = &small_image, .bearing_deg = 30}};
    camber_paint paints[4][ROWS];
    camber_polylines *polylines = NULL;
    camber_renderer *renderer = NULL;
    camber_mesh *mesh = NULL;
    for (int i = 0; i < ROWS; i++) {
        paints[0][i] = (camber_paint){.width_px = strokes[i].width_px, .color = {0, 0, 0.1f * (float)i, 1}};
        paints[1][i] = (camber_paint){.width_px = 0.1f * strokes[i].width_px, .color = {1, 1, 1, 0.5f}};
        paints[2][i] = rich_paint(i, strokes[i].width_px);
        paints[3][i] = i % 4 == 3 ? paints[1][i] : (camber_paint){.fill = fills + i % 4};
    }
    bool good = camber_polylines_create(context, &desc, &polylines) == CAMBER_OK &&
                camber_renderer_create(device, NULL, NULL, &renderer) == CAMBER_OK &&
                camber_mesh_create(device, renderer, &mesh) == CAMBER_OK &&
                camber_mesh_tessellate(mesh, polylines, &strips) == CAMBER_OK;
    const camber_pass passes[] = {{.mesh = mesh, .paints = paints[0], .paint_count = ROWS},
                                  {.kind = CAMBER_PASS_FILL, .fill = {.color = {0, 1, 0, 0.3f}}},
                                  {.mesh = mesh, .paints = paints[1], .paint_count = ROWS, .opacity = 0.5f}};
    const camber_pass rich_passes[] = {
        {.kind = CAMBER_PASS_FILL, .fill = {.color = {0, 0, 0, 1}, .image = &small_image, .bearing_deg = 30}},
        {.mesh = mesh, .paints = paints[2], .paint_count = ROWS}};
    const camber_pass areas = {.mesh = mesh,
                               .polyline_count = s->polyline_count / 8, /* where rings overlap takes it long */
                               .paints = paints[3],
                               .paint_count = ROWS,
                               .opacity = 0.7f};
    const camber_frame frames[PICTURES] = {{.passes = passes, .pass_count = 3},
                                           {.passes = passes, .pass_count = 3, .pitch_deg = 75},
                                           {.passes = rich_passes, .pass_count = 2},
                                           {.passes = &areas, .pass_count = 1},
                                           {.passes = &areas, .pass_count = 1, .pitch_deg = 75}};
    for (int i = 0; i < PICTURES; i++)
        good = good && render(renderer, frames[i], pictures ? pictures[i] : NULL);
    camber_mesh_destroy(mesh);
    camber_renderer_destroy(renderer);
    camber_polylines_destroy(polylines);
    return good;
}

/* With vectors of both widths, at once and in slices: the same bytes. */
static int check_drawing(camber_context *context, camber_made_scene *s) {
    static const struct {
        uint32_t lanes;
        uint64_t largest_bytes;
    } ways[] = {{16, 0}, {8, 0}, {8, 96 * 1024}};
    static picture first[PICTURES], seen[PICTURES];
    camber_stroke strokes[ROWS];
    int failures = 0;
    rotate(s, strokes, 0);
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        const camber_device_desc desc = {.lanes = ways[i].lanes, .largest_buffer_bytes = ways[i].largest_bytes};
        camber_device *device = NULL;
        bool good = camber_device_create(context, &desc, &device) == CAMBER_OK;
        if (good)
            good = draw(device, context, s, strokes, i ? seen : first);
        good = good && (i == 0 || memcmp(first, seen, sizeof seen) == 0);
        if (!good)
            printf("not ok - drawing with %u lanes, buffers of up to %llu bytes\n", ways[i].lanes,
                   (unsigned long long)ways[i].largest_bytes);
        failures += !good;
        camber_device_destroy(device);
    }
    return failures;
}

/* As on a GPU, in slices: other tests compare the bytes, these look for races between work-items. */
static int check_one_lane(camber_context *context, camber_made_scene *s) {
    const camber_device_desc desc = {.lanes = 1, .largest_buffer_bytes = 384 * 1024};
    camber_device *device = NULL;
    camber_stroke strokes[ROWS];
    rotate(s, strokes, 0);
    const bool good =
        camber_device_create(context, &desc, &device) == CAMBER_OK && draw(device, context, s, strokes, NULL);
    if (!good)
        printf("not ok - drawing with one lane\n");
    camber_device_destroy(device);
    return !good;
}

/* Every step-th rotation. */
static int check_device(camber_context *context, camber_made_scene *s, const camber_device_desc *desc, size_t first,
                        size_t step) {
    camber_device *device = NULL;
    camber_mesh *mesh = NULL;
    camber_stroke strokes[ROWS];
    int failures = 1;
    if (camber_device_create(context, desc, &device) == CAMBER_OK &&
        camber_mesh_create(device, NULL, &mesh) == CAMBER_OK) {
        failures = 0;
        printf("%s, work-groups of %u, buffers of up to %llu bytes\n", camber_device_get_info(device).name,
               desc->work_group_size, (unsigned long long)camber_device_get_info(device).largest_buffer_bytes);
        for (size_t rotation = first; rotation < ROWS; rotation += step) {
            char what[64];
            snprintf(what, sizeof what, "work-groups of %u, rotation %zu", desc->work_group_size, rotation);
            rotate(s, strokes, rotation);
            failures += check_methods(context, mesh, s, strokes, what);
            if (rotation == first)
                failures += check_networks(context, mesh, s, strokes) + check_offsets(context, mesh, s, strokes);
        }
    }
    camber_mesh_destroy(mesh);
    camber_device_destroy(device);
    return failures;
}

static void print_log(void *user, camber_log_level level, const char *message) {
    (void)user;
    if (level == CAMBER_LOG_ERROR)
        printf("# %s\n", message);
}

int main(int argument_count, char **arguments) {
    enum { SIZES = 3 };
    static const uint32_t sizes[SIZES] = {64, 128, 256};
    camber_made_scene s;
    const camber_context_desc desc = {.log = print_log};
    camber_context *context = NULL;
    int failures = 0;
    if (!camber_small_scene_make(&s) || camber_context_create(&desc, &context) != CAMBER_OK)
        return 1;
    printf("%zu points in %zu lines\n", s.point_count, s.polyline_count);
    const bool is_one_lane = argument_count > 1 && strcmp(arguments[1], "--one-lane") == 0;
    for (size_t i = 0; i < SIZES && !is_one_lane; i++) {
        const camber_device_desc whole = {.work_group_size = sizes[i]};
        const camber_device_desc parts = {.work_group_size = sizes[i], .largest_buffer_bytes = 65536};
        failures += check_device(context, &s, &whole, i, SIZES); /* together, each line with each row */
        failures += check_device(context, &s, &parts, 0, ROWS);
    }
    failures += is_one_lane ? check_one_lane(context, &s) : check_drawing(context, &s);
    camber_context_destroy(context);
    camber_made_scene_free(&s);
    printf("%d failures\n", failures);
    return failures ? 1 : 0;
}
