/* The importance of points: what a tolerance keeps, against the book's recursive method. */
#include "core.h"

#include "camber_network.h"
#include "lines/importance.h"

#include <math.h>

enum { MOST = 150 };

static double random_of(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

static double distance_to_segment(const double *p, const double *a, const double *b) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], length2 = dx * dx + dy * dy;
    double t = length2 > 0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2 : 0;
    t = fmin(fmax(t, 0), 1);
    return hypot(a[0] + t * dx - p[0], a[1] + t * dy - p[1]);
}

/* The points that the method keeps for one tolerance, as the book has it. */
static void keep_between(const double *points, size_t a, size_t b, double tolerance, bool *keep) {
    size_t at = a;
    double largest = 0;
    for (size_t i = a + 1; i < b; i++) {
        const double d = distance_to_segment(points + 2 * i, points + 2 * a, points + 2 * b);
        if (d > largest) {
            largest = d;
            at = i;
        }
    }
    if (at == a || largest < tolerance)
        return;
    keep[at] = true;
    keep_between(points, a, at, tolerance, keep);
    keep_between(points, at, b, tolerance, keep);
}

/* The largest distance of a point of the line, sampled, from the other line. */
static double farthest_from(const double *line, size_t count, const double *other, size_t other_count) {
    enum { SAMPLES = 8 };
    double most = 0;
    for (size_t i = 0; i + 1 < count; i++) {
        for (int s = 0; s <= SAMPLES; s++) {
            const double t = (double)s / SAMPLES, *a = line + 2 * i;
            const double p[2] = {a[0] + t * (a[2] - a[0]), a[1] + t * (a[3] - a[1])};
            double nearest = INFINITY;
            for (size_t k = 0; k + 1 < other_count; k++)
                nearest = fmin(nearest, distance_to_segment(p, other + 2 * k, other + 2 * k + 2));
            most = fmax(most, nearest);
        }
    }
    return most;
}

static size_t take_kept(const double *points, const float *importance, size_t count, double tolerance, double *kept) {
    size_t left = 0;
    for (size_t i = 0; i < count; i++) {
        if (!((double)importance[i] >= tolerance))
            continue;
        memcpy(kept + 2 * left, points + 2 * i, 2 * sizeof *kept);
        left++;
    }
    return left;
}

static void check_hausdorff(const double *points, const float *importance, size_t count, double tolerance,
                            double factor) {
    double kept[2 * MOST];
    const size_t left = take_kept(points, importance, count, tolerance, kept);
    if (left < 2 || left > MOST)
        fail_msg("%zu points are left", left);
    const double there = farthest_from(points, count, kept, left), back = farthest_from(kept, left, points, count);
    assert_true(there <= factor * tolerance * (1 + 1e-9) && back <= factor * tolerance * (1 + 1e-9));
}

static void weigh_one(host *h, const double *points, size_t count, float *importance) {
    camber_context *context = host_context(h);
    const size_t offsets[] = {0, count};
    assert_int_equal(camber_importance_weigh(context, points, offsets, 1, importance), CAMBER_OK);
    host_done(h, context);
}

static size_t make_walk(unsigned *seed, double *points) {
    const size_t count = 2 + (size_t)(random_of(seed) * (MOST - 2));
    double x = 0.5, y = 0.5;
    for (size_t i = 0; i < count; i++) {
        points[2 * i] = x += (random_of(seed) - 0.3) * 1e-5;
        points[2 * i + 1] = y += (random_of(seed) - 0.5) * 1e-5;
    }
    return count;
}

static void test_brute_force(void **state) {
    (void)state;
    host h;
    unsigned seed = 5;
    for (int round = 0; round < 100; round++) {
        double points[2 * MOST] = {0};
        float importance[MOST];
        const size_t count = make_walk(&seed, points);
        weigh_one(&h, points, count, importance);
        for (int step = 0; step < 12; step++) {
            const double tolerance = 1e-7 * pow(2, step);
            bool keep[MOST] = {[0] = true};
            keep[count - 1] = true;
            keep_between(points, 0, count - 1, tolerance, keep);
            for (size_t i = 0; i < count; i++)
                assert_int_equal(keep[i], (double)importance[i] >= tolerance);
            check_hausdorff(points, importance, count, tolerance, 1.0);
        }
    }
}

/* The point that a range is split by never goes before what lies in the range: a smaller tolerance keeps no fewer
 * points, and the last to stay is the farthest from the ends. */
static void test_known_lines(void **state) {
    (void)state;
    host h;
    float w[8];
    const double bumps[] = {0, 0, 2, 1, 5, 3, 7, 3, 10, 0};
    weigh_one(&h, bumps, 5, w);
    assert_true(isinf(w[0]) && isinf(w[4]) && w[2] == 3.0f && w[1] < w[2] && w[3] < w[2] && w[1] > 0 && w[3] > 0);
    /* The distances grow on the way down, the importances do not. */
    const double hook[] = {0, 0, 10, 1, -10, 1, 10, 0.5, 10, 0};
    weigh_one(&h, hook, 5, w);
    assert_true(w[1] <= w[2] && w[3] <= w[2]);
    const double straight[] = {0, 0, 1, 1, 2, 2, 3, 3};
    weigh_one(&h, straight, 4, w);
    assert_true(isinf(w[0]) && w[1] == 0 && w[2] == 0 && isinf(w[3]));
    const double spike[] = {0, 0, 100, 0, 10, 0};
    weigh_one(&h, spike, 3, w);
    assert_true(w[1] == 90.0f);
    weigh_one(&h, spike, 1, w);
    assert_true(isinf(w[0]));
    weigh_one(&h, spike, 0, w);
}

static size_t count_at_least(const float *w, size_t count, float tolerance) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        kept += w[i] >= tolerance;
    return kept;
}

static void test_rings(void **state) {
    (void)state;
    host h;
    double circle[2 * 101];
    float w[101];
    for (int i = 0; i <= 100; i++) {
        circle[2 * i] = 10 * cos(i % 100 * acos(-1.0) / 50);
        circle[2 * i + 1] = 10 * sin(i % 100 * acos(-1.0) / 50);
    }
    weigh_one(&h, circle, 101, w);
    assert_true(isinf(w[0]) && isinf(w[100]) && isinf(w[50]));
    assert_int_equal(count_at_least(w, 101, 1000.0f), 4); /* the seam twice and two more: an area however small */
    assert_int_equal(count_at_least(w, 101, 0.0f), 101);
    assert_true(count_at_least(w, 101, 0.1f) > 12 && count_at_least(w, 101, 0.1f) < 40);
    check_hausdorff(circle, w, 101, 0.1, 1.0);
    /* One without an area has nothing to keep but its far end, and the nodes that it passes twice have one weight. */
    const double flat[] = {0, 0, 1, 0, 2, 0, 1, 0, 0, 0};
    weigh_one(&h, flat, 5, w);
    assert_true(isinf(w[2]) && w[1] == 0 && w[3] == 0);
    const double same[] = {4, 4, 4, 4, 4, 4, 4, 4};
    weigh_one(&h, same, 4, w);
    assert_true(isinf(w[0]) && isinf(w[3]));
}

/* Lines over a grid of 6 x 6 nodes: each node many times, ends among them. */
static void test_shared_nodes(void **state) {
    (void)state;
    enum { LINES = 12, POINTS = 20, TOTAL = LINES * POINTS };
    unsigned seed = 17;
    host h;
    for (int round = 0; round < 100; round++) {
        double points[2 * TOTAL];
        float shared[TOTAL], alone[TOTAL];
        size_t offsets[LINES + 1] = {0};
        camber_context *context = host_context(&h);
        for (size_t i = 0; i < LINES; i++) {
            offsets[i + 1] = (i + 1) * POINTS;
            for (size_t k = offsets[i]; k < offsets[i + 1]; k++) {
                /* Most points are of one line alone. */
                const bool node = random_of(&seed) < 0.3;
                points[2 * k] = node ? floor(random_of(&seed) * 6) : random_of(&seed) * 6;
                points[2 * k + 1] = node ? floor(random_of(&seed) * 6) : random_of(&seed) * 6;
            }
        }
        assert_int_equal(camber_importance_weigh(context, points, offsets, LINES, shared), CAMBER_OK);
        for (size_t i = 0; i < LINES; i++)
            assert_int_equal(camber_importance_weigh(context, points, offsets + i, 1, alone), CAMBER_OK);
        for (size_t k = 0; k < TOTAL; k++) {
            float most = 0;
            for (size_t j = 0; j < TOTAL; j++)
                if (memcmp(points + 2 * k, points + 2 * j, 2 * sizeof *points) == 0)
                    most = fmaxf(most, alone[j]);
            assert_true(shared[k] == most);
        }
        for (size_t i = 0; i < LINES; i++)
            for (double tolerance = 0.1; tolerance < 8; tolerance *= 2)
                check_hausdorff(points + 2 * offsets[i], shared + offsets[i], POINTS, tolerance, 2.0);
        host_done(&h, context);
    }
}

/* So many points that nodes are found share by share: a long line, and short ones that end at some of its points. */
static void test_many_nodes(void **state) {
    enum { LONG = 9000000, EACH = 1000, SHORT = LONG / EACH };
    const size_t total = LONG + 2 * SHORT;
    double *points = malloc(2 * total * sizeof *points);
    float *importance = malloc(total * sizeof *importance);
    size_t *offsets = malloc((SHORT + 2) * sizeof *offsets);
    host h;
    camber_context *context = host_context(&h);
    (void)state;
    assert_true(points && importance && offsets);
    for (size_t i = 0; i < LONG; i++) {
        points[2 * i] = (double)i;
        points[2 * i + 1] = (double)(i % 2);
    }
    offsets[0] = 0;
    for (size_t k = 0; k < SHORT; k++) {
        const size_t at = LONG + 2 * k;
        offsets[k + 1] = at;
        memcpy(points + 2 * at, points + 2 * (k * EACH + 500), 2 * sizeof *points);
        points[2 * at + 2] = (double)k;
        points[2 * at + 3] = -5.0;
    }
    offsets[SHORT + 1] = total;
    assert_int_equal(camber_importance_weigh(context, points, offsets, SHORT + 1, importance), CAMBER_OK);
    for (size_t i = 1; i < LONG - 1; i++)
        if (isinf(importance[i]) != (i % EACH == 500))
            fail_msg("point %zu: %g", i, (double)importance[i]);
    host_done(&h, context);
    free(offsets);
    free(importance);
    free(points);
}

/* Any number of threads gives the same, of lines that share many of their nodes, the first of which is not the first of
 * the arrays. */
static void test_threads(void **state) {
    enum { EACH = 37, COUNT = 4000 };
    const size_t total = (size_t)EACH * COUNT;
    double *points = malloc(2 * total * sizeof *points);
    float *one = malloc(total * sizeof *one), *several = malloc(total * sizeof *several);
    size_t *offsets = malloc((COUNT + 1) * sizeof *offsets);
    unsigned seed = 11;
    host h;
    camber_context *context = host_context(&h);
    (void)state;
    assert_true(points && one && several && offsets);
    for (size_t i = 0; i < 2 * total; i++)
        points[i] = floor(300.0 * random_of(&seed));
    for (size_t i = 0; i <= COUNT; i++)
        offsets[i] = EACH * i;
    camber_importance_desc desc = {points, offsets + 1, COUNT - 1, one, 1};
    assert_int_equal(camber_importance_weigh_by(context, &desc), CAMBER_OK);
    desc.importance = several;
    for (desc.threads = 2; desc.threads <= 7; desc.threads++) {
        memset(several, 0, total * sizeof *several);
        assert_int_equal(camber_importance_weigh_by(context, &desc), CAMBER_OK);
        assert_memory_equal(one + EACH, several + EACH, (total - EACH) * sizeof *one);
    }
    host_done(&h, context);
    free(offsets);
    free(several);
    free(one);
    free(points);
}

/* Offsets that do not begin at 0: what lies before is left alone. */
static void test_part_of_a_set(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const double points[] = {9, 9, 9, 9, 0, 0, 1, 1, 2, 0, 1, 1, 5, 5};
    float w[7] = {-1, -1, -1, -1, -1, -1, -1};
    const size_t offsets[] = {2, 5, 7};
    assert_int_equal(camber_importance_weigh(context, points, offsets, 2, w), CAMBER_OK);
    assert_true(w[0] == -1 && w[1] == -1);
    assert_true(isinf(w[2]) && isinf(w[3]) && isinf(w[4]) && isinf(w[5]) && isinf(w[6]));
    const size_t wrong[] = {2, 5, 4};
    assert_int_equal(camber_importance_weigh(context, points, wrong, 2, w), CAMBER_ERROR_INPUT);
    assert_story(&h, "importance: offset 2");
    host_done(&h, context);
}

/* A comb of teeth that shrink has its farthest point next to its start each time: n splits of n points. In the spiral
 * every turn is inside the last. Each takes a second; without the bound it takes hours, and ctest ends it. */
static void test_worst_case_is_bounded(void **state) {
    (void)state;
    enum { COUNT = 1000000 };
    double *points = malloc(2 * COUNT * sizeof *points);
    float *w = malloc(COUNT * sizeof *w);
    host h;
    for (int shape = 0; shape < 2; shape++) {
        for (int i = 0; i < COUNT; i++) {
            const double left = 1.0 - (double)i / COUNT;
            points[2 * i] = shape ? left * cos(i * 0.7) : i * 1e-9;
            points[2 * i + 1] = shape ? left * sin(i * 0.7) : (i % 2 ? left : -left);
        }
        weigh_one(&h, points, COUNT, w);
        assert_true(count_at_least(w, COUNT, 1e-7f) > COUNT / 2);
    }
    free(w);
    free(points);
}

static void test_not_numbers(void **state) {
    (void)state;
    host h;
    float w[6];
    const double points[] = {0, 0, (double)NAN, 3, 5, (double)INFINITY, 7, 7, (double)NAN, (double)NAN, 0, 1};
    weigh_one(&h, points, 6, w);
    for (int i = 0; i < 6; i++)
        assert_true(w[i] >= 0.0f);
}

static void test_memory(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const size_t calls = h.calls;
    const double points[] = {0, 0, 1, 1, 2, 0, 1, 1, 5, 5};
    const size_t offsets[] = {0, 3, 5};
    float w[5];
    assert_int_equal(camber_importance_weigh(context, points, offsets, 2, w), CAMBER_OK);
    const size_t wanted = h.calls - calls;
    assert_true(wanted >= 2);
    for (size_t n = 1; n <= wanted; n++) {
        const size_t live = h.live_blocks;
        h.refuse_first = h.calls + n;
        h.refuse_count = 1;
        assert_int_equal(camber_importance_weigh(context, points, offsets, 2, w), CAMBER_ERROR_MEMORY);
        assert_int_equal(h.live_blocks, live);
    }
    h.refuse_first = 0;
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_brute_force),   cmocka_unit_test(test_known_lines),
        cmocka_unit_test(test_rings),         cmocka_unit_test(test_shared_nodes),
        cmocka_unit_test(test_many_nodes),    cmocka_unit_test(test_threads),
        cmocka_unit_test(test_part_of_a_set), cmocka_unit_test(test_worst_case_is_bounded),
        cmocka_unit_test(test_not_numbers),   cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
