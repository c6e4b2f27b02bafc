/* The functions of base/maths.h: as exact as the C library's, and the same bits on every processor. */
#include "core.h"

#include "base/maths.h"

enum { COUNT = 20000 };

/* Numbers from 0 to 1, the same everywhere. */
static double next(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

static void add_bits(uint64_t *sum, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    *sum = *sum * 31 + bits;
}

static void assert_near(double value, double right) {
    assert_true(fabs(value - right) <= 0x1p-51 * fmax(fabs(right), 1.0));
}

/* A compiler that contracts a product and a sum into one operation changes these sums. */
static void test_bits(void **state) {
    (void)state;
    uint64_t at = 44, powers = 0, turns = 0, lengths = 0;
    for (int i = 0; i < COUNT; i++) {
        const double x = 44.0 * next(&at) - 20.0, angle = 13.0 * next(&at) - 6.5;
        double sine, cosine;
        camber_sine_cosine(angle, &sine, &cosine);
        assert_near(sine, sin(angle));
        assert_near(cosine, cos(angle));
        assert_near(camber_exp2(x) / exp2(x), 1.0);
        assert_near(camber_length(x, angle), hypot(x, angle));
        add_bits(&powers, camber_exp2(x));
        add_bits(&turns, sine);
        add_bits(&turns, cosine);
        add_bits(&lengths, camber_length(x, angle));
    }
    assert_int_equal(powers, UINT64_C(0x250e3a14b2d0a1e1));
    assert_int_equal(turns, UINT64_C(0xdaab8b8c7a8418f9));
    assert_int_equal(lengths, UINT64_C(0x7b456738daf37991));
}

static void test_exact(void **state) {
    (void)state;
    double sine, cosine;
    for (int n = -40; n < 40; n++)
        assert_true(camber_exp2(n) == ldexp(1.0, n));
    camber_sine_cosine(0.0, &sine, &cosine);
    assert_true(sine == 0.0 && cosine == 1.0);
    for (int n = -9; n < 10; n++) {
        camber_sine_cosine(n * (3.14159265358979323846 / 2.0), &sine, &cosine);
        assert_true(fabs(sine) < 1e-14 ? fabs(cosine) == 1.0 : fabs(sine) == 1.0 && fabs(cosine) < 1e-14);
        assert_true((sine > 0.5) == ((n & 3) == 1) && (cosine > 0.5) == ((n & 3) == 0));
    }
}

static void test_odd_values(void **state) {
    (void)state;
    double sine, cosine;
    camber_sine_cosine((double)NAN, &sine, &cosine);
    assert_true(isnan(sine) && isnan(cosine));
    camber_sine_cosine((double)INFINITY, &sine, &cosine);
    assert_true(isnan(sine) && isnan(cosine));
    camber_sine_cosine(1e9, &sine, &cosine);
    assert_near(sine, sin(1e9));
    assert_true(isnan(camber_exp2((double)NAN)));
    assert_true(camber_exp2(-5000.0) == 0.0 && isinf(camber_exp2(5000.0)));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_bits), cmocka_unit_test(test_exact),
                                       cmocka_unit_test(test_odd_values)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
