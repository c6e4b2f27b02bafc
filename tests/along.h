/* One line, drawn with what changes along it, and its truth: sampled many times a pixel, each sample by the segment
 * that is nearest. */
#ifndef CAMBER_TESTS_ALONG_H
#define CAMBER_TESTS_ALONG_H

#include "picture.h"

#include "proof/along.h"

enum { ALONG_SIDE = 96 };

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
    const camber_tessellation_desc tessellation = {
        .strokes = &d->stroke, .stroke_count = 1, .method = d->method, .measured = true};
    camber_mesh *mesh = studio_line(s, d->points, d->count, &tessellation);
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
    return p;
}

/* ---- Truth ---- */

typedef float along_truth[4 * ALONG_SIDE * ALONG_SIDE]; /* premultiplied, 0 to 1 */

static inline void along_sample(const drawing *d, along_truth truth) {
    const camber_along_desc desc = {d->points, d->count, d->stroke.cap, &d->paint, &d->dash, &d->ramp};
    memset(truth, 0, sizeof(along_truth));
    camber_along_add(&desc, (camber_window){0, 0, ALONG_SIDE, ALONG_SIDE}, truth);
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
            error = fmax(error, fabs(p->rgba[4 * k + c] - 255 * fmin((double)truth[4 * k + c], 1)));
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
