#include "validate/statistics.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void test_median(void **state) {
    (void)state;
    assert_true(camber_statistics_median((double[]){7}, 1) == 7);
    assert_true(camber_statistics_median((double[]){9, 1, 4}, 3) == 4);
    assert_true(camber_statistics_median((double[]){8, 1, 4, 2}, 4) == 3);
}

static void test_quantile(void **state) {
    (void)state;
    double values[] = {40, 10, 30, 20, 50};
    camber_statistics_sort(values, 5);
    for (size_t i = 0; i < 5; i++) {
        assert_true(values[i] == 10 * (double)(i + 1));
        assert_true(camber_statistics_quantile(values, 5, (double)i / 4) == values[i]);
    }
    assert_true(camber_statistics_quantile(values, 5, 0.125) == 15);
    assert_true(camber_statistics_quantile(values, 5, 0.875) == 45);
    assert_true(camber_statistics_quantile(values, 1, 0.99) == 10);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_median), cmocka_unit_test(test_quantile)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
