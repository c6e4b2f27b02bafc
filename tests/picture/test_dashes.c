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

/* How much of a pixel's row the dashes of a level line cover. reach: how far square caps go on past both ends, px. */
static double covered_of_row(const drawing *d, double reach, double left) {
    const double begin = (double)d->points[0], total = (double)d->points[2] - begin;
    double covered = 0, at = 0;
    for (size_t i = 0; at < total; i++) {
        const double to = at + (double)d->dash.lengths[i % d->dash.count];
        const double first = begin + (at > 0 ? at : -reach), last = begin + (to < total ? to : total + reach);
        if (i % 2 == 0)
            covered += fmax(fmin(last, left + 1) - fmax(first, left), 0);
        at = to;
    }
    return covered;
}

static void check_row(fixture *s, const drawing *d, double reach) {
    picture p = along_draw(s, d);
    for (uint32_t x = 0; x < SIDE; x++) {
        const double drawn = 255 * picture_value(&p, x, 20, 3), truth = 255 * covered_of_row(d, reach, x);
        if (fabs(drawn - truth) > 2)
            fail_msg("cap %d, method %d, from %g to %g, lengths %g %g: %.0f in place of %.1f at %u", (int)d->stroke.cap,
                     (int)d->method, (double)d->points[0], (double)d->points[2], (double)d->dash.lengths[0],
                     (double)d->dash.lengths[1], drawn, truth, x);
    }
    picture_free(&p);
}

/* Where a line begins and ends within a pixel of a dash's end, the pixel has what lies between both. */
static void test_at_ends(void **state) {
    static const float dashes[][2] = {{1, 10}, {0.5f, 10}, {0.1f, 3}, {1.6f, 0.7f}, {7, 2.3f}};
    static const float begins[] = {10, 10.25f, 10.5f, 10.8f}, rests[] = {0.07f, 0.45f, 0.95f, 1.5f, 2.4f};
    for (int i = 0; i < 5 * 4 * 5 * 6; i++) {
        const float *dash = dashes[i % 5], begin = begins[i / 5 % 4];
        const float points[] = {begin, 20.5f, begin + 4 * (dash[0] + dash[1]) + rests[i / 20 % 5], 20.5f};
        const bool is_square = i / 100 % 2;
        const drawing d = {
            points,
            2,
            {10, CAMBER_JOIN_ROUND, is_square ? CAMBER_CAP_SQUARE : CAMBER_CAP_BUTT, 0},
            (camber_method)(i / 200),
            {.width_px = 10, .color = {1, 1, 1, 1}},
            .dash = {dash, 2},
        };
        check_row(*state, &d, is_square ? 5 : 0);
    }
}

/* The same of a line that lies askew, and of round dashes: none begins where the line has ended, however far it would
 * reach back. */
static void test_at_ends_askew(void **state) {
    static const float dashes[][2] = {{1, 10}, {0.4f, 7}, {1.7f, 4}, {10, 12}};
    for (size_t i = 0; i < 4 * 4 * 3; i++) {
        const bool is_round = i % 4 == 3;
        const double length = (double)(dashes[i % 4][0] + dashes[i % 4][1]) * (is_round ? 2 : 5);
        const double angle = 0.3 + 0.9 * (double)(i / 4 % 4), rest = is_round ? -1.5 : 0.6;
        const float points[] = {41.3f, 47.6f, (float)(41.3 + (length + rest) * cos(angle)),
                                (float)(47.6 + (length + rest) * sin(angle))};
        const drawing d = {points,
                           2,
                           {8, CAMBER_JOIN_ROUND, is_round ? CAMBER_CAP_ROUND : CAMBER_CAP_BUTT, 0},
                           (camber_method)(i / 16),
                           {.width_px = 8, .color = {1, 1, 1, 1}},
                           .dash = {dashes[i % 4], 2}};
        check(*state, &d, 3, is_round ? 30 : 24);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_straight), cmocka_unit_test(test_bent),    cmocka_unit_test(test_round),
        cmocka_unit_test(test_fine),     cmocka_unit_test(test_at_ends), cmocka_unit_test(test_at_ends_askew),
    };
    return FIXTURE_RUN(tests);
}
