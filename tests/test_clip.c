#include "map/clip.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 2000 };

typedef struct pieces {
    double points[2 * MOST];
    size_t point_count;
    size_t firsts[MOST + 1];
    size_t count;
} pieces;

static bool put(void *user, const double *point, bool first) {
    pieces *p = user;
    if (first)
        p->firsts[p->count++] = p->point_count;
    memcpy(p->points + 2 * p->point_count++, point, 2 * sizeof *point);
    p->firsts[p->count] = p->point_count;
    return true;
}

static void clip(const double *points, size_t count, pieces *p) {
    *p = (pieces){0};
    const camber_clip clip = {.seen = {-10, -10, 110, 110}, .far = {-100, -100, 200, 200}, .put = put, .user = p};
    assert_true(camber_clip_polyline(&clip, points, count));
}

static double distance_to_line(const double *p, const double *points, size_t count) {
    double best = INFINITY;
    for (size_t i = 0; i + 1 < count; i++) {
        const double *a = points + 2 * i, *b = a + 2;
        const double dx = b[0] - a[0], dy = b[1] - a[1], length2 = dx * dx + dy * dy;
        double t = length2 > 0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2 : 0;
        t = fmin(fmax(t, 0), 1);
        best = fmin(best, hypot(a[0] + t * dx - p[0], a[1] + t * dy - p[1]));
    }
    return best;
}

static double distance_to_pieces(const double *p, const pieces *all) {
    double best = INFINITY;
    for (size_t i = 0; i < all->count; i++)
        best = fmin(best, distance_to_line(p, all->points + 2 * all->firsts[i], all->firsts[i + 1] - all->firsts[i]));
    return best;
}

/* What the box shows of random lines and rings stays where it was, and nothing else appears. */
static void test_random_lines(void **state) {
    (void)state;
    unsigned seed = 11;
    static pieces p;
    for (int round = 0; round < 2000; round++) {
        double points[2 * 20];
        const size_t count = 2 + (size_t)round % 18;
        for (size_t i = 0; i < 2 * count; i++) {
            seed = seed * 1664525u + 1013904223u;
            points[i] = (seed >> 8) / 16777216.0 * (round % 3 ? 400 : 4000) - (round % 3 ? 150 : 1900);
        }
        const bool ring = count > 3 && round % 2;
        if (ring)
            memcpy(points + 2 * (count - 1), points, 2 * sizeof *points);
        clip(points, count, &p);
        for (size_t i = 0; i < p.point_count; i++) {
            const double *q = p.points + 2 * i;
            assert_true(distance_to_line(q, points, count) < 1e-9);
            assert_true(q[0] > -100.0001 && q[0] < 200.0001 && q[1] > -100.0001 && q[1] < 200.0001);
        }
        for (size_t i = 0; i < p.count; i++)
            assert_true(p.firsts[i + 1] - p.firsts[i] >= 2);
        for (size_t i = 0; i + 1 < count; i++) {
            for (int k = 0; k <= 50; k++) {
                const double t = k / 50.0, *a = points + 2 * i;
                const double q[2] = {a[0] + (a[2] - a[0]) * t, a[1] + (a[3] - a[1]) * t};
                if (q[0] >= -10 && q[0] <= 110 && q[1] >= -10 && q[1] <= 110)
                    assert_true(distance_to_pieces(q, &p) < 1e-9);
            }
        }
        /* A vertex that shows is never an end, but the ends of an open line: it keeps its join. */
        for (size_t i = 0; i < p.count; i++) {
            const double *ends[2] = {p.points + 2 * p.firsts[i], p.points + 2 * (p.firsts[i + 1] - 1)};
            const bool closed = memcmp(ends[0], ends[1], 2 * sizeof *points) == 0;
            for (int k = 0; k < 2; k++) {
                const double *q = ends[k];
                const bool shown = q[0] >= -10 && q[0] <= 110 && q[1] >= -10 && q[1] <= 110;
                const bool open_end = !ring && (memcmp(q, points, 2 * sizeof *q) == 0 ||
                                                memcmp(q, points + 2 * (count - 1), 2 * sizeof *q) == 0);
                assert_true(!shown || open_end || (ring && closed));
            }
        }
    }
}

static void test_untouched(void **state) {
    (void)state;
    static pieces p;
    const double ring[] = {0, 0, 100, 0, 100, 100, 0, 0};
    clip(ring, 4, &p);
    assert_int_equal(p.count, 1);
    assert_int_equal(p.point_count, 4);
    assert_memory_equal(p.points, ring, sizeof ring);
}

/* The seam lies inside and the ring leaves on the right: one piece, whose ends are outside. */
static void test_cut_ring_keeps_its_seam(void **state) {
    (void)state;
    static pieces p;
    const double ring[] = {50, 50, 150, 50, 150, 150, 50, 150, 50, 60, 20, 60, 50, 50};
    clip(ring, 7, &p);
    assert_int_equal(p.count, 1);
    const double wanted[] = {50, 150, 50, 60, 20, 60, 50, 50, 150, 50};
    assert_int_equal(p.point_count, 5);
    assert_memory_equal(p.points, wanted, sizeof wanted);
}

static void test_nothing_seen(void **state) {
    (void)state;
    static pieces p;
    const double around[] = {-50, -50, 150, -50, 150, 150, -50, 150, -50, -50};
    clip(around, 5, &p);
    assert_int_equal(p.count, 0);
    const double dot[] = {500, 5}, seen[] = {50, 5};
    clip(dot, 1, &p);
    assert_int_equal(p.count, 0);
    clip(seen, 1, &p);
    assert_int_equal(p.count, 1);
    clip(seen, 0, &p);
    assert_int_equal(p.count, 0);
}

static void test_far_ends_are_cut(void **state) {
    (void)state;
    static pieces p;
    const double line[] = {-1e12, 50, 1e12, 50};
    clip(line, 2, &p);
    assert_int_equal(p.point_count, 2);
    assert_true(fabs(p.points[0] + 100) < 1e-3 && fabs(p.points[2] - 200) < 1e-3);
    assert_true(p.points[1] == 50 && p.points[3] == 50);
}

static void test_not_numbers(void **state) {
    (void)state;
    static pieces p;
    const double line[] = {0, 0, 10, 10, (double)NAN, 20, 30, 30, 40, 40, (double)INFINITY, 40, 1, 0};
    clip(line, 7, &p);
    assert_int_equal(p.count, 2);
    assert_int_equal(p.point_count, 4);
    assert_true(p.points[4] == 30 && p.points[6] == 40);
}

static bool refuse(void *user, const double *point, bool first) {
    (void)point;
    (void)first;
    return --*(int *)user > 0;
}

static void test_stops_where_put_does(void **state) {
    (void)state;
    int left = 2;
    const double line[] = {0, 0, 10, 10, 20, 20, 30, 30};
    const camber_clip clip = {.seen = {0, 0, 100, 100}, .far = {0, 0, 100, 100}, .put = refuse, .user = &left};
    assert_false(camber_clip_polyline(&clip, line, 4));
    assert_int_equal(left, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_lines),
        cmocka_unit_test(test_untouched),
        cmocka_unit_test(test_cut_ring_keeps_its_seam),
        cmocka_unit_test(test_nothing_seen),
        cmocka_unit_test(test_far_ends_are_cut),
        cmocka_unit_test(test_not_numbers),
        cmocka_unit_test(test_stops_where_put_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
