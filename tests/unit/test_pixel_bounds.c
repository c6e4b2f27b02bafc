/* The bounds that pixels are held to: the oracle's own error, what few pixels may be off by and may not, and how areas
 * count that lie over each other. */
#include "validate/oracle.h"
#include "validate/samples.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* ---- The oracle ---- */

/* The area of the pixel at 0, 0 where a x + b y <= c: the pixel's corners, and where the edge crosses its sides. */
static double area_of(double a, double b, double c) {
    static const double corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    double kept[8][2], area = 0;
    int count = 0;
    for (int i = 0; i < 4; i++) {
        const double *p = corners[i], *q = corners[(i + 1) % 4];
        const double at_p = a * p[0] + b * p[1] - c, at_q = a * q[0] + b * q[1] - c;
        if (at_p <= 0)
            kept[count][0] = p[0], kept[count++][1] = p[1];
        if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) {
            const double t = at_p / (at_p - at_q);
            kept[count][0] = p[0] + t * (q[0] - p[0]), kept[count++][1] = p[1] + t * (q[1] - p[1]);
        }
    }
    for (int i = 0; i < count; i++) {
        const double *p = kept[i], *q = kept[(i + 1) % count];
        area += p[0] * q[1] - q[0] * p[1];
    }
    return fabs(area) / 2;
}

/* A stroke so wide that only one edge of it crosses the pixel, x cos + y sin <= c. In levels. */
static double error_of(camber_oracle_window *window, double angle, double c) {
    enum { HALF = 64 };
    const double a = cos(angle), b = sin(angle), x = a * (c - HALF), y = b * (c - HALF);
    const float points[] = {(float)(x - b * HALF), (float)(y + a * HALF), (float)(x + b * HALF), (float)(y - a * HALF)};
    const camber_oracle_style style = {.width_px = 2 * HALF};
    camber_oracle_clear(window);
    assert_true(camber_oracle_stroke(window, points, 2, &style));
    return 255 * fabs(camber_oracle_coverage(window, 0, 0) - area_of(a, b, c));
}

/* 8 is what bounds.c takes it for. */
static void test_oracle(void **state) {
    (void)state;
    camber_oracle_window window;
    double most = 0, of_diagonals = 0;
    assert_true(camber_oracle_open(&window, 0, 0, 1, 1));
    for (int direction = 0; direction < 360; direction++)
        for (int step = 0; step < 199; step++) {
            const double error = error_of(&window, direction * 3.14159265358979 / 180, (step - 99.63) / 70);
            most = fmax(most, error);
            of_diagonals = fmax(of_diagonals, direction % 90 == 45 ? error : 0);
        }
    camber_oracle_close(&window);
    print_message("the oracle is off by %.2f of 255 at most, on diagonals %.2f\n", most, of_diagonals);
    assert_true(most > 4 && most <= 8);
}

/* ---- Areas ---- */

enum { SIDE_PX = 200 };

/* How far off a picture is that has one level in a pixel of two equal squares of a quarter of it, and nothing else. */
static camber_pixel_error squares_error(uint8_t level, bool opposed) {
    static const float one[] = {150.25f, 120.25f, 150.75f, 120.25f, 150.75f,
                                120.75f, 150.25f, 120.75f, 150.25f, 120.25f};
    static uint8_t picture[SIDE_PX * SIDE_PX];
    static uint32_t offsets[] = {0, 5, 10};
    float points[20];
    for (size_t i = 0; i < 10; i++) {
        points[i] = one[i];
        points[10 + i] = one[opposed ? 8 - i / 2 * 2 + i % 2 : i];
    }
    const camber_subject rings = {
        .lines = {.points = points, .offsets = offsets, .point_count = 10, .polyline_count = 2},
        .keep_open = true,
        .fills = true,
        .width = SIDE_PX,
        .height = SIDE_PX};
    camber_samples samples;
    camber_pixel_error error;
    size_t worst;
    assert_int_equal(camber_samples_make(&rings, NULL, 8, &samples), CAMBER_OK);
    assert_int_equal(samples.count, 1);
    picture[120 * SIDE_PX + 150] = level;
    camber_samples_compare(&samples, CAMBER_TRUTH_UNION, picture, SIDE_PX, &error, &worst);
    camber_samples_free(&samples);
    return error;
}

/* Within a pixel two rings may count once or twice, or not at all where one runs the other way. */
static void test_overlaps(void **state) {
    (void)state;
    static const struct {
        uint8_t level;
        bool opposed;
        int error;
    } known[] = {{64, false, 0},   {100, false, 0}, {127, false, 0}, {30, false, 34},
                 {200, false, 72}, {0, true, 0},    {20, true, 20}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        assert_in_range(squares_error(known[i].level, known[i].opposed).max + 1, known[i].error, known[i].error + 2);
}

/* ---- Verdicts ---- */

/* A user's lines: so many pixels, all but far of them off by usual levels, and those by most. */
static bool is_passed(size_t pixels, double usual, size_t far, int most) {
    const double share = (double)far / (double)pixels;
    const camber_pixel_error error = {
        .of = {usual * (1 - share) + most * share, most > 16 ? share : 0, most > 64 ? share : 0},
        .pixels = pixels,
        .max = most};
    camber_pixel_bounds bounds;
    camber_finding finding = {0};
    assert_true(camber_bounds_of_pixels(NULL, 0, CAMBER_COVERAGE_EXACT, &bounds));
    bounds = camber_bounds_of_few(bounds, &error);
    const bool passed = camber_bounds_are_passed(&error.of, &bounds, &finding);
    assert_int_equal(passed, finding.field != NULL);
    return passed;
}

static void test_few_pixels(void **state) {
    (void)state;
    static const size_t counts[] = {1, 6, 64, 1000, 100000};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        const size_t n = counts[i];
        assert_false(is_passed(n, 0, 0, 0));
        assert_false(is_passed(n, 4.67, 0, 7)); /* a diagonal, of which all pixels are alike */
        assert_false(is_passed(n, 3, 1, n > 1 ? 24 : 8));
        /* Nothing drawn, drawn a quarter of a pixel beside, all of it too light, or one pixel of few left out. */
        assert_true(is_passed(n, 128, 1, 255));
        assert_true(is_passed(n, 32, 1, 64));
        assert_true(is_passed(n, 12, 1, 20));
        assert_true(is_passed(n, 2.5, 1, 25));
        assert_true(n > 64 || is_passed(n, 0, 1, 65));
    }
    /* Few of many may be off, as ends of lines are. */
    assert_false(is_passed(1000, 1, 1, 200));
}

/* Scenes that are built in have many edges, and bounds that were measured: nothing is added to those. */
static void test_scenes(void **state) {
    (void)state;
    camber_pixel_bounds bounds;
    camber_finding finding = {0};
    assert_true(camber_bounds_of_pixels("side by side", 0, CAMBER_COVERAGE_EXACT, &bounds));
    assert_true(camber_bounds_are_passed(&(camber_pixel_bounds){.mean = 2.1}, &bounds, &finding));
    assert_string_equal(finding.field, "mean");
    assert_false(camber_bounds_of_pixels("no scene", 0, CAMBER_COVERAGE_EXACT, &bounds));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_oracle),
        cmocka_unit_test(test_overlaps),
        cmocka_unit_test(test_few_pixels),
        cmocka_unit_test(test_scenes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
