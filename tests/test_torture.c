/* The flattened layer is uniform: one alpha everywhere inside a translucent stroke, however often it runs over itself.
 */
#include "torture.h"

/* Torn: at the crotch of a turn past 127 degrees two edges of neighbours leave a corner of one pixel each, and cover
 * together what neither covers alone. Meeting: the figures whose edges fall on each other, and the long line. */
static void check_method(void **state, camber_method method) {
    torture_set set = torture_make();
    torture_check(*state, &set, method, (torture_known){5, 87});
    torture_free(&set);
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

static int open_studio(void **state) {
    static studio s;
    *state = &s;
    return studio_open(&s) ? 0 : -1;
}

static int close_studio(void **state) {
    studio_close(*state);
    return 0;
}

int main(void) {
    char cache[64];
    pocl_cache_apart(cache);
    if (!device_is_there()) {
        printf("no OpenCL device\n");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_strips_are_uniform),
        cmocka_unit_test(test_kites_are_uniform),
        cmocka_unit_test(test_fans_are_uniform),
    };
    const int failed = cmocka_run_group_tests(tests, open_studio, close_studio);
    folder_remove(cache);
    return failed;
}
