/* The flattened layer is uniform: one alpha everywhere inside a translucent stroke, however often it runs over itself.
 */
#include "torture_judge.h"

typedef struct overlap_test {
    fixture fixture;
    camber_torture_set set;
} overlap_test;

/* Torn: on the inner side of a sharp turn two neighbours leave a corner of one pixel each, and what both leave is not
 * nothing by a level or two; one is the apex of a notch of 10 degrees, which the line does not wholly cover. Meeting:
 * the figures whose edges fall on each other, and the dense ones. */
static void check_method(void **state, camber_method method) {
    overlap_test *b = *state;
    torture_check(&b->fixture, &b->set, method, (torture_known){4, 1, 5});
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
    static overlap_test b;
    b.set = camber_torture_make();
    *state = &b;
    return fixture_open(&b.fixture) ? 0 : -1;
}

static int tear_down(void **state) {
    overlap_test *b = *state;
    camber_torture_free(&b->set);
    fixture_close(&b->fixture);
    return 0;
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_strips_are_uniform),
        cmocka_unit_test(test_kites_are_uniform),
        cmocka_unit_test(test_fans_are_uniform),
    };
    const int failed = cmocka_run_group_tests(tests, set_up, tear_down);
    return failed;
}
