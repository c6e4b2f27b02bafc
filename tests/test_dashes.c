/* Dashes: against each dash drawn by itself, as the oracle samples it. */
#include "picture.h"

#include "proof/oracle.h"

#include <stdio.h>

enum { SIDE = 96, PLACES_MAX = 64 };

static const float straight[] = {10.3f, 15.6f, 84.1f, 70.2f};
static const float bent[] = {14.3f, 20.6f, 42.1f, 30.2f, 44.8f, 70.4f, 80.7f, 76.9f};
static const float curved[] = {10, 80, 16, 68, 23, 57, 31, 47, 40, 38, 50, 31, 61, 26, 73, 23, 86, 22};

typedef struct drawing {
    const float *points;
    size_t count;
    camber_stroke stroke;
    camber_method method;
    camber_paint paint;
    camber_dash dash;
} drawing;

static picture draw(studio *s, const drawing *d) {
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
    const camber_pass pass = {.mesh = mesh, .paints = &d->paint, .paint_count = 1, .dashes = &d->dash, .dash_count = 1};
    picture p =
        picture_draw(studio_any(s), &(camber_frame){.width = SIDE, .height = SIDE, .passes = &pass, .pass_count = 1});
    camber_mesh_destroy(mesh);
    camber_polylines_destroy(polylines);
    return p;
}

/* The part of a line between two places along it. */
static size_t cut(const drawing *d, double from, double to, float *part) {
    size_t count = 0;
    double along = 0;
    for (size_t i = 0; i + 1 < d->count; i++) {
        const double ax = (double)d->points[2 * i], ay = (double)d->points[2 * i + 1];
        const double dx = (double)d->points[2 * i + 2] - ax, dy = (double)d->points[2 * i + 3] - ay;
        const double length = hypot(dx, dy), t0 = (from - along) / length, t1 = (to - along) / length;
        along += length;
        if (t0 >= 1 || t1 <= 0)
            continue;
        const double begin = fmax(t0, 0), end = fmin(t1, 1);
        if (count == 0) {
            part[0] = (float)(ax + begin * dx);
            part[1] = (float)(ay + begin * dy);
            count = 1;
        }
        part[2 * count] = (float)(ax + end * dx);
        part[2 * count + 1] = (float)(ay + end * dy);
        count++;
    }
    return count;
}

/* Sum over the dashes, which lie apart. */
static void add_truth(const drawing *d, double truth[SIDE * SIDE]) {
    const camber_oracle_style style = {
        .width_px = (double)d->paint.width_px, .join = d->stroke.join, .cap = d->stroke.cap, .miter_limit = 2};
    double total = 0, at = 0;
    for (size_t i = 1; i < d->count; i++)
        total +=
            hypot((double)d->points[2 * i] - d->points[2 * i - 2], (double)d->points[2 * i + 1] - d->points[2 * i - 1]);
    for (size_t i = 0; at < total; i++) {
        const double length = (double)d->dash.lengths[i % d->dash.count];
        float part[2 * PLACES_MAX];
        camber_oracle_window window;
        if (i % 2 == 0) {
            const size_t count = cut(d, at - 1e-3, fmin(at + length, total) + 1e-3, part); /* of dots too */
            assert_true(camber_oracle_open(&window, 0, 0, SIDE, SIDE));
            assert_true(camber_oracle_stroke(&window, part, count, &style));
            for (size_t k = 0; k < SIDE * SIDE; k++)
                truth[k] += camber_oracle_coverage(&window, (int)(k % SIDE), (int)(k / SIDE));
            camber_oracle_close(&window);
        }
        at += length;
    }
}

static void check(studio *s, const drawing *d, double mean_bound, double most_bound) {
    static double truth[SIDE * SIDE];
    memset(truth, 0, sizeof truth);
    add_truth(d, truth);
    picture p = draw(s, d);
    double sum = 0, most = 0;
    size_t touched = 0, worst = 0;
    for (size_t k = 0; k < SIDE * SIDE; k++) {
        const double drawn = p.rgba[4 * k + 3] / 255.0, error = fabs(drawn - fmin(truth[k], 1));
        touched += truth[k] > 0 || drawn > 0;
        sum += error;
        worst = error > most ? k : worst;
        most = fmax(most, error);
    }
    const double mean = 255 * sum / (double)touched;
    if (mean > mean_bound || 255 * most > most_bound)
        fail_msg("width %g, join %d, cap %d, method %d, %zu lengths from %g: %.2f of 255 on average, %.0f at %zu, %zu",
                 (double)d->paint.width_px, (int)d->stroke.join, (int)d->stroke.cap, (int)d->method, d->dash.count,
                 (double)d->dash.lengths[0], mean, 255 * most, worst % SIDE, worst / SIDE);
    picture_free(&p);
}

static const float even[] = {9, 6}, odd[] = {7.3f}, many[] = {12, 3, 1, 3, 5.5f, 4.5f}, dots[] = {0, 14};
static const camber_dash patterns[] = {{even, 2}, {odd, 1}, {many, 6}};

static void test_straight(void **state) {
    for (size_t i = 0; i < 3; i++)
        for (int method = 0; method < 3; method++)
            for (int wide = 0; wide < 3; wide++) {
                const float width = wide == 0 ? 1.3f : wide == 1 ? 3 : 8;
                const drawing d = {straight,
                                   2,
                                   {width, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                                   (camber_method)method,
                                   {.width_px = width, .color = {1, 1, 1, 1}, .dash = 1},
                                   patterns[i]};
                check(*state, &d, 3, 24);
            }
}

static void test_bent(void **state) {
    for (size_t i = 0; i < 3; i++)
        for (int method = 0; method < 3; method++)
            for (int line = 0; line < 2; line++) {
                const drawing d = {line ? curved : bent,
                                   line ? sizeof curved / sizeof *curved / 2 : sizeof bent / sizeof *bent / 2,
                                   {5, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                                   (camber_method)method,
                                   {.width_px = 5, .color = {1, 1, 1, 1}, .dash = 1},
                                   patterns[i]};
                check(*state, &d, 6, 255); /* at corners, the bisector says whose dash a pixel is */
            }
}

/* Round ends need room between them. */
static void test_round(void **state) {
    const float roomy[] = {10, 12};
    const camber_dash round[] = {{roomy, 2}, {dots, 2}};
    for (size_t i = 0; i < 2; i++)
        for (int method = 0; method < 3; method++)
            for (int line = 0; line < 2; line++) {
                const drawing d = {line ? straight : curved,
                                   line ? 2 : sizeof curved / sizeof *curved / 2,
                                   {6, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0},
                                   (camber_method)method,
                                   {.width_px = 6, .color = {1, 1, 1, 1}, .dash = 1},
                                   round[i]};
                check(*state, &d, 6, 90);
            }
}

/* Dashes far finer than pixels leave their share. */
static void test_fine(void **state) {
    const float fine[] = {0.1f, 0.3f};
    const drawing d = {straight,
                       2,
                       {6, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                       CAMBER_METHOD_STRIP,
                       {.width_px = 6, .color = {1, 1, 1, 1}, .dash = 1},
                       {fine, 2}};
    picture p = draw(*state, &d);
    assert_true(fabs(picture_value(&p, 47, 43, 3) - 0.25) <= 0.006);
    picture_free(&p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_straight),
        cmocka_unit_test(test_bent),
        cmocka_unit_test(test_round),
        cmocka_unit_test(test_fine),
    };
    char cache[64];
    if (!studio_begin(cache))
        return 77;
    const int failed = cmocka_run_group_tests(tests, studio_set_up, studio_tear_down);
    folder_remove(cache);
    return failed;
}
