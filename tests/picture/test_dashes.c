/* Dashes: against each dash drawn by itself, as the oracle samples it. */
#include "along_picture.h"

#include "validate/oracle.h"

#include <stdio.h>

enum { SIDE = ALONG_SIDE, PLACES_MAX = 64 };

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
    const double total = camber_along_length(d->points, d->count);
    double at = 0;
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

static void check(fixture *s, const drawing *d, double mean_bound, double most_bound) {
    static double area[SIDE * SIDE];
    static along_truth truth;
    memset(area, 0, sizeof area);
    add_truth(d, area);
    for (size_t k = 0; k < sizeof truth / sizeof *truth; k++)
        truth[k] = (float)area[k / 4];
    picture p = along_draw(s, d);
    const along_error e = along_compare(&p, truth);
    if (e.mean > mean_bound || e.most > most_bound)
        fail_msg("width %g, join %d, cap %d, method %d, %zu lengths from %g: %.2f of 255 on average, %.0f at %zu, %zu",
                 (double)d->paint.width_px, (int)d->stroke.join, (int)d->stroke.cap, (int)d->method, d->dash.count,
                 (double)d->dash.lengths[0], e.mean, e.most, e.x, e.y);
    picture_free(&p);
}

static const float even[] = {9, 6}, odd[] = {7.3f}, many[] = {12, 3, 1, 3, 5.5f, 4.5f}, dots[] = {0, 14};
static const camber_dash patterns[] = {{even, 2}, {odd, 1}, {many, 6}};

static void test_straight(void **state) {
    for (size_t i = 0; i < 3; i++)
        for (int method = 0; method < 3; method++)
            for (int wide = 0; wide < 3; wide++) {
                const float width = wide == 0 ? 1.3f : wide == 1 ? 3 : 8;
                const drawing d = {ALONG_STRAIGHT,
                                   2,
                                   {width, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                                   (camber_method)method,
                                   {.width_px = width, .color = {1, 1, 1, 1}},
                                   .dash = patterns[i]};
                check(*state, &d, 3, 24);
            }
}

static void test_bent(void **state) {
    for (size_t i = 0; i < 3; i++)
        for (int method = 0; method < 3; method++)
            for (int line = 0; line < 2; line++) {
                const drawing d = {line ? ALONG_CURVED : ALONG_BENT,           line ? 9 : 4,
                                   {5, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0}, (camber_method)method,
                                   {.width_px = 5, .color = {1, 1, 1, 1}},     .dash = patterns[i]};
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
                const drawing d = {line ? ALONG_STRAIGHT : ALONG_CURVED,        line ? 2 : 9,
                                   {6, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0}, (camber_method)method,
                                   {.width_px = 6, .color = {1, 1, 1, 1}},      .dash = round[i]};
                check(*state, &d, 6, 90);
            }
}

/* Dashes far finer than pixels leave their share. */
static void test_fine(void **state) {
    const float fine[] = {0.1f, 0.3f};
    const drawing d = {ALONG_STRAIGHT,
                       2,
                       {6, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                       CAMBER_METHOD_STRIP,
                       {.width_px = 6, .color = {1, 1, 1, 1}},
                       .dash = {fine, 2}};
    picture p = along_draw(*state, &d);
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
    return FIXTURE_RUN(tests);
}
