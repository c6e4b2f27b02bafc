/* Checks networks with several cameras: compares what the device sees with the CPU twin, checks that no vertex is far
 * away, and compares pictures with lines that are projected from the definition. */
#include "validate/samples.h"

#include "validate/network_truth.h"

#include "kernels/cull.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A network, and the camera from which the others are derived. */
typedef struct job {
    camber_validation *v;
    const camber_subject *s;
    camber_network *network;
    camber_camera camera;
    camber_stroke *strokes; /* stroke_count of them */
    size_t stroke_count;
    bool is_own; /* made from the subject's lines, and described by: */
    camber_network_desc desc;
} job;

/* Some cameras see the whole network in a few pixels, some see a part of it, and some see a piece of a segment whose
 * ends are a million pixels away. */
static const struct {
    const char *name;
    double times, bearing_deg; /* relative to the camera with which the subject is seen */
    double simplify_px;        /* negative: the same as that camera's */
    const char *scene;         /* the scene whose bounds its pixels must keep; NULL: the subject's */
} cameras[] = {{"zoomed out", 0.2, 0, -1, NULL},
               {"cut", 1, 0, -1, NULL},
               {"simplified, turned", 2, 33.7, 2, NULL},
               {"zoomed in", 40, -145, -1, NULL},
               {"within a segment", 3e4, 90, -1, "a segment"}};

/* ---- A network of the subject's lines ---- */

/* Returns powers of two from 1/16 to 128 px, so that some are equal to tolerances. */
static float importance_of(size_t i) {
    const uint32_t hash = (uint32_t)i * 2654435761u;
    return ldexpf(0.0625f, (int)(hash >> 16) % 12);
}

static void close_own(job *j) {
    free((double *)(uintptr_t)j->desc.points);
    free((size_t *)(uintptr_t)j->desc.offsets);
    free((float *)(uintptr_t)j->desc.importance);
    free((camber_network_entry *)(uintptr_t)j->desc.entries);
    if (j->is_own)
        camber_network_destroy(j->network);
}

static camber_status make_own(job *j) {
    const camber_lines *lines = &j->s->lines;
    double *points = calloc(2 * lines->point_count + 1, sizeof *points);
    size_t *offsets = calloc(lines->polyline_count + 1, sizeof *offsets);
    float *importance = calloc(lines->point_count + 1, sizeof *importance);
    camber_network_entry *entries = calloc(lines->polyline_count + 1, sizeof *entries);
    j->is_own = true;
    j->desc = (camber_network_desc){.points = points,
                                    .offsets = offsets,
                                    .polyline_count = lines->polyline_count,
                                    .importance = importance,
                                    .entries = entries,
                                    .entry_count = lines->polyline_count,
                                    .keep_open = j->s->keep_open};
    if (!points || !offsets || !importance || !entries)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < lines->point_count; i++) {
        const float *from = lines->points + 2 * i;
        const bool valid = fabsf(from[0]) <= 1e9f && fabsf(from[1]) <= 1e9f; /* as in camber_polylines_create */
        points[2 * i] = valid ? (double)from[0] : (double)NAN;
        points[2 * i + 1] = (double)from[1];
        importance[i] = importance_of(i);
    }
    for (size_t i = 0; i < lines->polyline_count; i++) {
        offsets[i + 1] = lines->offsets[i + 1];
        entries[i] = (camber_network_entry){.polyline = (uint32_t)i, .row = j->s->rows ? j->s->rows[i] : 0};
    }
    return camber_network_create(j->v->desc->context, &j->desc, &j->network);
}

/* ---- Aiming ---- */

static bool lies_in(const camber_subject *s, const float *point) {
    return point[0] >= 0 && point[1] >= 0 && point[0] < (float)s->width && point[1] < (float)s->height;
}

/* Finds a point on a long segment in the picture, but not its middle. Each number finds another point. */
static void find_place(const camber_subject *s, size_t number, double *x, double *y) {
    enum { TRIES = 64 };
    static const double PART = 0.37;
    const camber_lines *lines = &s->lines;
    double longest = -1;
    *x = 0.5 * s->width;
    *y = 0.5 * s->height;
    for (size_t i = 0; i < TRIES && lines->point_count > 1; i++) {
        const size_t at = (number * TRIES + i) * 2654435761u % (lines->point_count - 1);
        const float *a = lines->points + 2 * at, *b = a + 2;
        const double length = hypot((double)b[0] - (double)a[0], (double)b[1] - (double)a[1]);
        if (at + 1 == lines->offsets[camber_polyline_of(lines, at) + 1] || !lies_in(s, a) || !lies_in(s, b) ||
            !(length > longest))
            continue;
        longest = length;
        *x = (double)a[0] + PART * ((double)b[0] - (double)a[0]);
        *y = (double)a[1] + PART * ((double)b[1] - (double)a[1]);
    }
}

static camber_camera aim(const job *j, size_t number) {
    camber_camera camera = j->camera;
    double x, y;
    find_place(j->s, number, &x, &y);
    if (cameras[number].times >= 1)
        camber_camera_center(&camera, x, y);
    camera.scale_px *= cameras[number].times;
    camera.bearing_deg += cameras[number].bearing_deg;
    camera.simplify_px = cameras[number].simplify_px < 0 ? camera.simplify_px : cameras[number].simplify_px;
    return camera;
}

/* ---- Checks ---- */

/* Returns how far from its polyline the widest stroke is drawn. */
static double reach_of(const job *j) {
    double reach = 0;
    for (size_t i = 0; i < j->stroke_count; i++) {
        const camber_stroke *stroke = j->strokes + i;
        const double limit = stroke->miter_limit > 0 ? (double)stroke->miter_limit : 2;
        /* With an offset, points may be as far away as the tip of a miter join, and the window is extended by the same
         * distance again. */
        const double offset = fabs((double)stroke->offset_px);
        reach = fmax(reach, 0.5 * (double)stroke->width_px * fmax(limit, 1.5) + offset * (2 * fmax(limit, 1.1) + 7));
    }
    return reach;
}

/* Checks the promise of camber_mesh_tessellate_network about the window, for every point that the twin sees. */
static camber_status check_window(job *j, const camber_subject *s) {
    camber_check check = camber_check_start(NULL, NULL, "%s: no point far outside the picture", s->name);
    const camber_tessellation_desc desc = {j->strokes, j->stroke_count, s->method, 0, false};
    /* A piece that touches the window may end outside, and so may the next one. Pieces may be turned by 45 degrees. */
    const double most = 64 + 16 + reach_of(j) + s->camera.translate_px + 2 * 1.4143 * (double)CAMBER_PIECE_PX;
    camber_stages stages = {0};
    const camber_status status = camber_stages_tessellate(j->v->desc->context, s->polylines, &desc, &stages);
    if (status != CAMBER_OK)
        return status;
    for (size_t i = 0; i < stages.point_count; i++) {
        const camber_point_stages *at = stages.points + i;
        const double x = (double)at->x, y = (double)at->y;
        const double out = fmax(fmax(-x, x - s->width), fmax(-y, y - s->height));
        if (out <= most)
            continue;
        check.result = CAMBER_RESULT_FAILED;
        check.finding =
            (camber_finding){"project", true, at->polyline, at->point, x, y, "distance", out, most, "", NULL};
        snprintf(check.finding.what, sizeof check.finding.what,
                 "project: polyline %u, point %u at (%.9g, %.9g) is %.9g px outside the picture, at most %.9g",
                 at->polyline, at->point, x, y, out, most);
        break;
    }
    camber_stages_destroy(&stages);
    camber_results_add(&j->v->results, &check);
    return status;
}

/* The subject is what the camera sees. has_shape: false if the camera is so far out that lines are smaller than a
 * pixel, so that their pixels cannot be checked. */
static camber_status check_seen(job *j, camber_subject *s, bool has_shape) {
    const camber_tessellation_desc desc = {j->strokes, j->stroke_count, s->method, 0, false};
    camber_polylines *twin = NULL;
    camber_status status = camber_network_project(j->network, &s->camera, &desc, &twin);
    s->polylines = twin;
    if (status == CAMBER_OK)
        status = camber_check_meshes(j->v, s);
    if (status == CAMBER_OK)
        status = check_window(j, s);
    if (status == CAMBER_OK && j->is_own && has_shape)
        status = camber_check_pixels(j->v, s);
    camber_polylines_destroy(twin);
    return status;
}

static camber_status check_camera(job *j, size_t number) {
    const int wanted = j->v->desc->method;
    char name[512];
    snprintf(name, sizeof name, "%.400s: network, %s", j->s->name, cameras[number].name);
    camber_projected seen = {0};
    camber_subject s = *j->s;
    s.name = name;
    s.scene = cameras[number].scene && j->s->scene ? cameras[number].scene : j->s->scene;
    s.strokes = s.drawn_strokes = j->strokes;
    s.stroke_count = j->stroke_count;
    s.network = j->network;
    s.camera = aim(j, number);
    s.method = wanted < 0 ? (camber_method)(number % 3) : (camber_method)wanted;
    if (j->is_own && !camber_projected_make(&j->desc, &s.camera, 1000 + 2 * reach_of(j), &seen))
        return CAMBER_ERROR_MEMORY;
    s.lines = seen.lines;
    s.rows = seen.rows;
    const camber_status status = check_seen(j, &s, cameras[number].times >= 1);
    camber_projected_free(&seen);
    return status;
}

camber_status camber_check_networks(camber_validation *validation, const camber_subject *subject,
                                    camber_network *network, const camber_camera *camera,
                                    const camber_tessellation_desc *desc) {
    job j = {.v = validation, .s = subject, .network = network};
    const camber_stroke *strokes = network ? desc->strokes : subject->drawn_strokes;
    j.stroke_count = network ? desc->stroke_count : subject->stroke_count;
    j.strokes = camber_strokes_styled(strokes, j.stroke_count, camber_style_mixed, 0);
    j.camera = network ? *camera
                       : (camber_camera){.x = 0.5 * subject->width,
                                         .y = 0.5 * subject->height,
                                         .scale_px = 1,
                                         .width = subject->width,
                                         .height = subject->height};
    if (!j.strokes)
        return CAMBER_ERROR_MEMORY;
    camber_status status = network ? CAMBER_OK : make_own(&j);
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras && status == CAMBER_OK; i++)
        status = check_camera(&j, i);
    close_own(&j);
    free(j.strokes);
    return status;
}
