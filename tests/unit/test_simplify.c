/* Simplification of lines: which points stay, and how far those that go lie from what is left. */
#include "lines/simplify.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static double distance_to_segment(const double *p, const double *a, const double *b) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], length2 = dx * dx + dy * dy;
    double t = length2 > 0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2 : 0;
    t = fmin(fmax(t, 0), 1);
    return hypot(a[0] + t * dx - p[0], a[1] + t * dy - p[1]);
}

/* The points that are left are a subsequence with the ends, and every dropped point lies within tolerance of the
 * segment that replaces it. */
static size_t check(const double *points, size_t count, double tolerance) {
    double *left = malloc(2 * count * sizeof *left);
    unsigned char *keep = malloc(count);
    memcpy(left, points, 2 * count * sizeof *left);
    const size_t kept = camber_simplify(left, count, tolerance, keep);
    assert_true(kept >= 2 && kept <= count);
    assert_memory_equal(left, points, 2 * sizeof *left);
    assert_memory_equal(left + 2 * (kept - 1), points + 2 * (count - 1), 2 * sizeof *left);
    size_t segment = 0;
    for (size_t i = 0; i < count; i++) {
        if (segment + 1 < kept && memcmp(points + 2 * i, left + 2 * segment, 2 * sizeof *left) == 0 && i > 0 &&
            segment == 0)
            continue; /* repeated first points */
        if (segment + 1 < kept && i > 0 && memcmp(points + 2 * i, left + 2 * (segment + 1), 2 * sizeof *left) == 0)
            segment++;
        const size_t a = segment + 1 < kept ? segment : kept - 2;
        const double ahead = distance_to_segment(points + 2 * i, left + 2 * a, left + 2 * a + 2);
        const double behind = a > 0 ? distance_to_segment(points + 2 * i, left + 2 * a - 2, left + 2 * a) : ahead;
        assert_true(fmin(ahead, behind) <= tolerance * (1 + 1e-9));
    }
    free(keep);
    free(left);
    return kept;
}

static double random_of(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

static void test_tolerance_holds(void **state) {
    (void)state;
    unsigned seed = 3;
    for (int round = 0; round < 500; round++) {
        double points[2 * 300];
        const size_t count = 2 + (size_t)(random_of(&seed) * 298);
        double x = 0, y = 0;
        for (size_t i = 0; i < count; i++) {
            points[2 * i] = x += random_of(&seed) - 0.3;
            points[2 * i + 1] = y += random_of(&seed) - 0.5;
        }
        check(points, count, round % 5 == 0 ? 0.01 : 0.5);
    }
}

static void test_known_lines(void **state) {
    (void)state;
    double straight[2 * 50];
    for (int i = 0; i < 50; i++) {
        straight[2 * i] = i * 2;
        straight[2 * i + 1] = i;
    }
    assert_int_equal(check(straight, 50, 0.1), 2);
    const double bump[] = {0, 0, 5, 0.2, 10, 0};
    assert_int_equal(check(bump, 3, 0.25), 2);
    assert_int_equal(check(bump, 3, 0.15), 3);
    /* There and back: the far end must stay although it lies on the base line's continuation. */
    const double spike[] = {0, 0, 100, 0, 10, 0};
    assert_int_equal(check(spike, 3, 0.1), 3);
    double off[2 * 3];
    memcpy(off, bump, sizeof off);
    unsigned char keep[3];
    assert_int_equal(camber_simplify(off, 3, 0.0, keep), 3);
    assert_memory_equal(off, bump, sizeof off);
    assert_int_equal(camber_simplify(off, 3, (double)NAN, keep), 3);
}

static void test_rings(void **state) {
    (void)state;
    unsigned char keep[101];
    double circle[2 * 101];
    for (int i = 0; i <= 100; i++) {
        circle[2 * i] = 10 * cos(i % 100 * acos(-1.0) / 50);
        circle[2 * i + 1] = 10 * sin(i % 100 * acos(-1.0) / 50);
    }
    assert_true(check(circle, 101, 0.1) > 12);
    /* Far below the tolerance it stays an area: the seam twice and two more points. */
    assert_int_equal(camber_simplify(circle, 101, 1000.0, keep), 4);
    assert_true(circle[0] == circle[6] && circle[1] == circle[7]);
    const double area =
        (circle[2] - circle[0]) * (circle[5] - circle[1]) - (circle[4] - circle[0]) * (circle[3] - circle[1]);
    assert_true(fabs(area) > 100.0); /* half of the square's 200 and more */
    /* One without an area has nothing to keep but its far end. */
    double flat[] = {0, 0, 1, 0, 2, 0, 1, 0, 0, 0};
    assert_int_equal(camber_simplify(flat, 5, 0.1, keep), 3);
    double same[] = {4, 4, 4, 4, 4, 4, 4, 4};
    assert_int_equal(camber_simplify(same, 4, 0.1, keep), 2);
}

/* A comb of teeth that shrink has its farthest point next to its start each time: n splits of n points. It takes a
 * second; without the bound on splits it takes half an hour, and ctest ends it. */
static void test_worst_case_is_bounded(void **state) {
    (void)state;
    enum { COUNT = 2000000 };
    double *points = malloc(2 * COUNT * sizeof *points);
    unsigned char *keep = malloc(COUNT);
    for (int i = 0; i < COUNT; i++) {
        points[2 * i] = i * 1e-3;
        points[2 * i + 1] = (i % 2 ? 1.0 : -1.0) * (COUNT - i);
    }
    const size_t kept = camber_simplify(points, COUNT, 0.1, keep);
    assert_true(kept > COUNT / 2);
    free(keep);
    free(points);
}

static void test_not_numbers(void **state) {
    (void)state;
    double points[] = {0, 0, (double)NAN, 3, 5, (double)INFINITY, 7, 7, (double)NAN, (double)NAN};
    unsigned char keep[5];
    assert_true(camber_simplify(points, 5, 0.1, keep) <= 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tolerance_holds),       cmocka_unit_test(test_known_lines), cmocka_unit_test(test_rings),
        cmocka_unit_test(test_worst_case_is_bounded), cmocka_unit_test(test_not_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
