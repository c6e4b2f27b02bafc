/* Pictures held against the truth in bands: the sums are those of one window, however many threads there are. */
#include "scene.h"

#include "validate/picture_error.h"

enum { WIDTH = 90, HEIGHT = 101, PICTURES = 2 };

typedef struct told {
    int calls;
    double last;
} told;

static void tell(void *user, double fraction) {
    told *t = user;
    assert_true(fraction > t->last && fraction <= 1);
    t->last = fraction;
    t->calls++;
}

static void test_bands(void **state) {
    (void)state;
    camber_made_scene s = {0};
    uint64_t seed = 7;
    for (int i = 0; i < 40; i++) {
        camber_made_scene_walk(&s, &seed, 12, (const double[]){0.5, 20}, 1.5);
        camber_made_scene_end(&s, (size_t)i % 2);
    }
    for (size_t i = 0; i < 2 * s.point_count; i++)
        s.points[i] /= 10; /* into the picture */
    const camber_lines lines = {
        .points = s.points, .offsets = s.offsets, .point_count = s.point_count, .polyline_count = s.polyline_count};
    const camber_stroke strokes[] = {{.width_px = 3}, {.width_px = 1, .cap = CAMBER_CAP_ROUND}};
    static float truth[WIDTH * HEIGHT];
    static uint8_t pictures[PICTURES][WIDTH * HEIGHT]; /* the truth with a pixel wrong, and noise */
    camber_picture_error_desc desc = {.truth = {.lines = &lines, .rows = s.rows, .strokes = strokes},
                                      .width = WIDTH,
                                      .height = HEIGHT,
                                      .pictures = {pictures[0], pictures[1]},
                                      .picture_count = PICTURES,
                                      .progress = tell};
    assert_true(camber_truth_make(&desc.truth, (camber_window){0, 0, WIDTH, HEIGHT}, truth));
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        pictures[0][i] = (uint8_t)lrintf(255 * truth[i]);
        pictures[1][i] = (uint8_t)camber_random_below(&seed, 256);
    }
    pictures[0][WIDTH * HEIGHT - 1] ^= 200; /* the last of all */
    for (unsigned threads = 0; threads < 9; threads += 1 + threads / 2) {
        told t = {0, 0};
        camber_difference found[PICTURES];
        desc.threads = threads;
        desc.user = &t;
        assert_true(camber_picture_errors_measure(&desc, found));
        for (int i = 0; i < PICTURES; i++) {
            const camber_difference whole = camber_difference_of(truth, pictures[i], WIDTH * HEIGHT);
            assert_true(found[i].sum == whole.sum && whole.sum > 0); /* of whole numbers */
            assert_int_equal(found[i].touched, whole.touched);
            assert_int_equal(found[i].past_16, whole.past_16);
            assert_int_equal(found[i].past_64, whole.past_64);
            assert_int_equal(found[i].max, whole.max);
            assert_int_equal(found[i].max_at, whole.max_at);
        }
        assert_int_equal(found[0].max,
                         abs((int)pictures[0][WIDTH * HEIGHT - 1] - (int)lrintf(255 * truth[WIDTH * HEIGHT - 1])));
        assert_true(threads != 1 || (t.calls == 4 && t.last == 1.0)); /* bands of 32 rows */
    }
    camber_made_scene_free(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_bands)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
