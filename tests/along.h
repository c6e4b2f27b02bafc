/* One line, drawn with what changes along it, and its truth: sampled many times a pixel, each sample by the segment
 * that is nearest. */
#ifndef CAMBER_TESTS_ALONG_H
#define CAMBER_TESTS_ALONG_H

#include "picture.h"

enum { ALONG_SIDE = 96, ALONG_SAMPLES = 16 };

static const float ALONG_STRAIGHT[] = {10.3f, 15.6f, 84.1f, 70.2f};
static const float ALONG_BENT[] = {14.3f, 20.6f, 42.1f, 30.2f, 44.8f, 70.4f, 80.7f, 76.9f};
static const float ALONG_CURVED[] = {10, 80, 16, 68, 23, 57, 31, 47, 40, 38, 50, 31, 61, 26, 73, 23, 86, 22};

typedef struct along_line {
    const float *points;
    size_t count;
} along_line;

static const along_line ALONG_LINES[] = {{ALONG_STRAIGHT, 2}, {ALONG_BENT, 4}, {ALONG_CURVED, 9}};

typedef struct drawing {
    const float *points;
    size_t count;
    camber_stroke stroke;
    camber_method method;
    camber_paint paint;
    camber_dash dash;
    camber_ramp ramp; /* no stops: none */
    camber_coverage coverage;
    camber_overlap overlap;
    float opacity;
} drawing;

static inline picture along_draw(studio *s, const drawing *d) {
    const uint32_t offsets[] = {0, (uint32_t)d->count};
    const camber_polylines_desc desc = {
        .points = d->points, .point_count = d->count, .offsets = offsets, .polyline_count = 1};
    const camber_tessellation_desc tessellation = {
        .strokes = &d->stroke, .stroke_count = 1, .method = d->method, .measured = true};
    camber_polylines *polylines = NULL;
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_polylines_create(s->context, &desc, &polylines), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->device, studio_any(s), &mesh), CAMBER_OK);
    assert_int_equal(camber_tessellate(mesh, polylines, &tessellation), CAMBER_OK);
    const camber_pass pass = {.mesh = mesh,
                              .paints = &d->paint,
                              .paint_count = 1,
                              .dashes = &d->dash,
                              .dash_count = d->dash.count > 0,
                              .ramps = &d->ramp,
                              .ramp_count = d->ramp.count > 0,
                              .overlap = d->overlap,
                              .opacity = d->opacity};
    picture p = picture_draw(
        studio_any(s),
        &(camber_frame){
            .width = ALONG_SIDE, .height = ALONG_SIDE, .passes = &pass, .pass_count = 1, .coverage = d->coverage});
    camber_mesh_destroy(mesh);
    camber_polylines_destroy(polylines);
    return p;
}

static inline double along_length(const drawing *d) {
    double total = 0;
    for (size_t i = 1; i < d->count; i++)
        total +=
            hypot((double)d->points[2 * i] - d->points[2 * i - 2], (double)d->points[2 * i + 1] - d->points[2 * i - 1]);
    return total;
}

/* ---- Truth ---- */

/* How far along the line the point lies nearest, how far from it, and whether past its ends. */
static inline double along_place(const drawing *d, double x, double y, double *distance, bool *past) {
    double place = 0, before = 0;
    *distance = INFINITY;
    *past = false;
    for (size_t i = 0; i + 1 < d->count; i++) {
        const double ax = (double)d->points[2 * i], ay = (double)d->points[2 * i + 1];
        const double dx = (double)d->points[2 * i + 2] - ax, dy = (double)d->points[2 * i + 3] - ay;
        const double length = hypot(dx, dy), at = ((x - ax) * dx + (y - ay) * dy) / length;
        const double within = fmin(fmax(at, 0), length);
        const double away = hypot(x - ax - within * dx / length, y - ay - within * dy / length);
        if (away < *distance) {
            *distance = away;
            place = before + within;
            *past = (i == 0 && at < 0) || (i + 2 == d->count && at > length);
        }
        before += length;
    }
    return place;
}

/* Premultiplied. */
static inline void along_color(const camber_ramp *ramp, double progress, double color[4]) {
    const camber_ramp_stop *stops = ramp->stops;
    size_t i = 0;
    while (i + 1 < ramp->count && (double)stops[i + 1].place <= progress)
        i++;
    const camber_ramp_stop *from = stops + i, *to = stops + (i + 1 < ramp->count ? i + 1 : i);
    const double span = (double)to->place - (double)from->place;
    const double t = span > 0 ? fmin(fmax((progress - (double)from->place) / span, 0), 1) : 0;
    const camber_color ends[] = {from->color, to->color};
    for (int c = 0; c < 4; c++)
        color[c] = 0;
    for (int e = 0; e < 2; e++) {
        const double share = e ? t : 1 - t, a = (double)ends[e].a * share;
        color[0] += (double)ends[e].r * a;
        color[1] += (double)ends[e].g * a;
        color[2] += (double)ends[e].b * a;
        color[3] += a;
    }
}

/* Adds what a sample sees; dashes and blur are not in it. */
static inline void along_add(const drawing *d, double total, double x, double y, double sum[4]) {
    double distance, color[4] = {1, 1, 1, 1};
    bool past;
    const double place = along_place(d, x, y, &distance, &past), progress = place / total;
    const double gap = (double)d->paint.gap_px, width = (double)d->paint.width_px;
    const double outer = gap > 0 ? 0.5 * gap + width : 0.5 * width;
    past = past && d->stroke.cap == CAMBER_CAP_BUTT;
    const bool trimmed = d->paint.trim_end > d->paint.trim_start && progress >= (double)d->paint.trim_start &&
                         progress <= (double)d->paint.trim_end;
    if (distance > outer || (gap > 0 && distance < 0.5 * gap) || trimmed || past)
        return;
    if (d->ramp.count)
        along_color(&d->ramp, progress, color);
    const camber_color c = d->paint.color;
    const double by[] = {(double)c.r, (double)c.g, (double)c.b, 1};
    for (int i = 0; i < 4; i++)
        sum[i] += color[i] * by[i] * (double)c.a;
}

typedef double along_truth[4 * ALONG_SIDE * ALONG_SIDE]; /* premultiplied, 0 to 1 */

static inline void along_sample(const drawing *d, along_truth truth) {
    const double total = along_length(d), share = 1.0 / (ALONG_SAMPLES * ALONG_SAMPLES);
    const double reach = (double)d->stroke.width_px + 1;
    for (size_t k = 0; k < (size_t)ALONG_SIDE * ALONG_SIDE; k++) {
        const double x = (double)(k % ALONG_SIDE), y = (double)(k / ALONG_SIDE);
        double sum[4] = {0}, distance;
        bool past;
        along_place(d, x + 0.5, y + 0.5, &distance, &past);
        for (int s = 0; s < ALONG_SAMPLES * ALONG_SAMPLES && distance < reach; s++)
            along_add(d, total, x + (s % ALONG_SAMPLES + 0.5) / ALONG_SAMPLES,
                      y + (s / ALONG_SAMPLES + 0.5) / ALONG_SAMPLES, sum);
        for (size_t c = 0; c < 4; c++)
            truth[4 * k + c] = sum[c] * share;
    }
}

/* ---- Differences, of 255 ---- */

typedef struct along_error {
    double mean, most; /* over the pixels that either touches */
    size_t x, y;       /* of the most */
} along_error;

static inline along_error along_compare(const picture *p, const along_truth truth) {
    along_error e = {0};
    double sum = 0;
    size_t touched = 0;
    for (size_t k = 0; k < (size_t)ALONG_SIDE * ALONG_SIDE; k++) {
        double error = 0;
        bool any = false;
        for (size_t c = 0; c < 4; c++) {
            error = fmax(error, fabs(p->rgba[4 * k + c] - 255 * fmin(truth[4 * k + c], 1)));
            any |= p->rgba[4 * k + c] || truth[4 * k + c] > 0;
        }
        touched += any;
        sum += error;
        if (error > e.most)
            e = (along_error){0, error, k % ALONG_SIDE, k / ALONG_SIDE};
    }
    assert_true(touched > 20);
    e.mean = sum / (double)touched;
    return e;
}

#endif
