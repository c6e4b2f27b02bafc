/* Trims: the part of a line that is left out, against samples. */
#include "along_picture.h"

#include <stdio.h>

static void check(fixture *s, const drawing *d, double mean_bound, double most_bound) {
    static along_truth truth;
    along_sample(d, truth);
    picture p = along_draw(s, d);
    const along_error e = along_compare(&p, truth);
    if (e.mean > mean_bound || e.most > most_bound)
        fail_msg("%zu points, width %g, cap %d, method %d, trim %g to %g: %.2f of 255 on average, %.0f at %zu, %zu",
                 d->count, (double)d->paint.width_px, (int)d->stroke.cap, (int)d->method, (double)d->paint.trim_start,
                 (double)d->paint.trim_end, e.mean, e.most, e.x, e.y);
    picture_free(&p);
}

static const float TRIMS[][2] = {{0, 0.4f}, {0.317f, 0.6f}, {0.71f, 1}, {0.5f, 0.505f}, {0.6f, 0.3f}};

static void check_line(fixture *s, int line, float width_px, camber_cap cap, int method, double most_bound) {
    for (size_t i = 0; i < sizeof TRIMS / sizeof *TRIMS; i++) {
        const drawing d = {
            .points = ALONG_LINES[line].points,
            .count = ALONG_LINES[line].count,
            .stroke = {width_px, CAMBER_JOIN_ROUND, cap, 0},
            .method = (camber_method)method,
            .paint = {.width_px = width_px, .color = {1, 1, 1, 1}, .trim_start = TRIMS[i][0], .trim_end = TRIMS[i][1]}};
        check(s, &d, 3, most_bound);
    }
}

static void test_straight(void **state) {
    for (int method = 0; method < 3; method++)
        for (int wide = 0; wide < 3; wide++)
            check_line(*state, 0, wide == 0 ? 1.3f : wide == 1 ? 3 : 12, CAMBER_CAP_BUTT, method, 24);
}

static void test_bent(void **state) {
    for (int method = 0; method < 3; method++)
        for (int line = 1; line < 3; line++)
            check_line(*state, line, 8, CAMBER_CAP_BUTT, method, 130);
}

/* A trim at an end takes the cap; inside there are none. */
static void test_caps(void **state) {
    for (int method = 0; method < 3; method++)
        check_line(*state, 0, 12, CAMBER_CAP_ROUND, method, 24);
}

/* All of a line, its caps as well. */
static void test_whole(void **state) {
    drawing d = {.points = ALONG_CURVED,
                 .count = 9,
                 .stroke = {9, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0},
                 .paint = {.width_px = 9, .color = {1, 1, 1, 1}, .trim_start = 0, .trim_end = 1}};
    picture p = along_draw(*state, &d);
    for (size_t k = 0; k < (size_t)4 * ALONG_SIDE * ALONG_SIDE; k++)
        assert_int_equal(p.rgba[k], 0);
    picture_free(&p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_straight),
        cmocka_unit_test(test_bent),
        cmocka_unit_test(test_caps),
        cmocka_unit_test(test_whole),
    };
    return FIXTURE_RUN(tests);
}
