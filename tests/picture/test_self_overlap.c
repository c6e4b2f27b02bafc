/* The flattened layer is uniform: one alpha everywhere inside a translucent stroke, however often it runs over itself.
 */
#include "torture.h"

typedef struct bench {
    studio studio;
    torture_set set;
} bench;

/* Torn: on the inner side of a sharp turn two neighbours leave a corner of one pixel each, and what both leave is not
 * nothing by a level or two. Meeting: the figures whose edges fall on each other, and the dense ones. */
static void check_method(void **state, camber_method method) {
    bench *b = *state;
    torture_check(&b->studio, &b->set, method, (torture_known){3, 1, 5});
}

static void test_strips_are_uniform(void **state) {
    check_method(state, CAMBER_METHOD_STRIP);
}

static void test_kites_are_uniform(void **state) {
    check_method(state, CAMBER_METHOD_KITE);
}

static void test_fans_are_uniform(void **state) {
    check_method(state, CAMBER_METHOD_FAN);
}

static int set_up(void **state) {
    static bench b;
    b.set = torture_make();
    *state = &b;
    return studio_open(&b.studio) ? 0 : -1;
}

static int tear_down(void **state) {
    bench *b = *state;
    torture_free(&b->set);
    studio_close(&b->studio);
    return 0;
}

int main(void) {
    if (!studio_begin())
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_strips_are_uniform),
        cmocka_unit_test(test_kites_are_uniform),
        cmocka_unit_test(test_fans_are_uniform),
    };
    const int failed = cmocka_run_group_tests(tests, set_up, tear_down);
    return failed;
}
