/* The join maths of kernels/join.h against trigonometry in double precision. */
#include "core.h"

#include "kernels/join.h"
#include "kernels/offset.h"
#include "kernels/stroke_ends.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

typedef struct sample {
    float dx, dy, ex, ey;
    double turn; /* of the float vectors, exactly */
    double shorter;
} sample;

static sample make_sample(uint64_t *seed, double turn_deg) {
    const double base = camber_random_between(seed, -PI, PI), turn = turn_deg * PI / 180;
    /* From 1e-3 to 1e4 px, evenly in the exponent. */
    const double a = pow(10, camber_random_between(seed, -3, 4)), b = pow(10, camber_random_between(seed, -3, 4));
    sample s = {(float)(a * cos(base)),
                (float)(a * sin(base)),
                (float)(b * cos(base + turn)),
                (float)(b * sin(base + turn)),
                0,
                0};
    const double dx = s.dx, dy = s.dy, ex = s.ex, ey = s.ey;
    s.turn = atan2(dx * ey - dy * ex, dx * ex + dy * ey);
    s.shorter = fmin(hypot(dx, dy), hypot(ex, ey));
    return s;
}

static void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.12g is not %.12g within %g", a, b, tolerance);
}

static camber_row make_row(float width_px, camber_u32 join, float miter_limit, double step) {
    return (camber_row){.reach_px = 0.5f * width_px + CAMBER_PAD_PX,
                        .miter_limit = miter_limit,
                        .round_cos = 2.0f,
                        .fan_cos = (float)cos(step),
                        .fan_sin = (float)sin(step),
                        .join = join};
}

static camber_u32 join_word(camber_turn turn, camber_row row, camber_u32 method) {
    return camber_join_word(turn, &row, method);
}

enum { STEPS = 3600 }; /* a tenth of a degree each, -180 to 180 */

static void test_half_turn(void **state) {
    (void)state;
    uint64_t seed = 1;
    for (int k = 0; k <= STEPS; k++) {
        for (int repeat = 0; repeat < 20; repeat++) {
            const sample s = make_sample(&seed, k * 0.1 - 180);
            const camber_turn turn = camber_turn_between(s.dx, s.dy, s.ex, s.ey);
            /* The sign of a full reversal is the float rounding's. */
            const bool reversal = fabs(s.turn) > 179.999 * PI / 180;
            assert_true(turn.c >= 0.0f);
            assert_near(turn.c, cos(s.turn / 2), 6e-7);
            assert_near(reversal ? fabs(turn.s) : turn.s, reversal ? 1 : sin(s.turn / 2), 6e-7);
            assert_near(turn.dot, cos(s.turn), 6e-7);
            assert_near(turn.half_shorter / (0.5 * s.shorter), 1, 1e-6);
            const float q = camber_turn_unpack(camber_turn_pack(turn));
            assert_int_not_equal(camber_turn_pack(turn), 0); /* which marks a cap */
            const double step = fabs(q) > 1.5 / 32767 ? 0.5 / 32767 + 1e-6 : 1.0 / 32767 + 1e-6;
            assert_near(reversal ? fabs(q) : q, reversal ? 1 : tan(s.turn / 4), step);
            if (fabs(s.turn) <
                170 * PI / 180) { /* 16 bits: the slope of tan(t/2) over tan(t/4) is 2(1+q^2)/(1-q^2)^2 */
                const double slope = 2 * (1 + (double)q * q) / ((1 - (double)q * q) * (1 - (double)q * q));
                assert_near(camber_turn_tan_half(q), tan(s.turn / 2), 1.2 * slope * step);
            }
        }
    }
}

static void test_packing(void **state) {
    (void)state;
    /* Every 16-bit pattern comes back, and the ends of the range are -1 and 1. */
    for (camber_u32 bits = 0; bits < 65536; bits++) {
        const float q = camber_turn_unpack(bits);
        assert_near(q, (bits >= 32768 ? (double)bits - 65536 : (double)bits) / 32767, 1e-7);
        assert_true(isfinite(camber_turn_tan_half(q)));
        assert_true((camber_turn_tan_half(q) > 0) == (q > 0) && (camber_turn_tan_half(q) < 0) == (q < 0));
    }
    assert_int_equal(camber_turn_pack((camber_turn){.c = 0, .s = 1}), 32767);
    assert_int_equal(camber_turn_pack((camber_turn){.c = 0, .s = -1}), (camber_u32)-32767 & 0xffffu);
    assert_int_equal(camber_turn_pack((camber_turn){.c = 1, .s = 0}), 1);
    assert_int_equal(camber_turn_pack((camber_turn){.c = 0, .s = 1.001f}), 32767); /* rounding past 1 stays in range */
}

/* Vectors no longer than the repeated points that cleaning drops, and sentinels: no NaN comes of them. */
static void test_degenerate_vectors(void **state) {
    (void)state;
    static const float sizes[] = {0.0f, 1e-45f, 1e-20f, 1e-18f, 1.0f, 2e9f};
    for (size_t i = 0; i < 6; i++) {
        for (size_t j = 0; j < 6; j++) {
            for (int k = 0; k < 16; k++) {
                const float dx = sizes[i] * (float)(k % 2 ? 1 : -1), ey = sizes[j] * (float)(k / 2 % 2 ? 1 : -1);
                const camber_turn turn = camber_turn_between(dx, k & 4 ? dx : 0.0f, k & 8 ? ey : 0.0f, ey);
                assert_true(turn.c >= 0.0f && turn.c <= 1.001f && fabsf(turn.s) <= 1.001f);
                assert_true(turn.half_shorter >= 0.0f && isfinite(turn.half_shorter));
                for (camber_u32 method = 0; method < 3; method++)
                    for (camber_u32 join = 0; join < 3; join++)
                        assert_true(camber_join_kind(join_word(turn, make_row(2, join, 2, 0.1), method)) >= 3);
            }
        }
    }
}

/* true where value is so near threshold that rounding decides. */
static bool is_near(double value, double threshold) {
    return fabs(value - threshold) <= 4e-6 * (1 + fabs(threshold));
}

/* Kinds, ends and triangles from the angle, as the drawings in join.h and the public header tell. */
static void check_word(const sample *s, camber_row row, camber_u32 method) {
    const camber_turn turn = camber_turn_between(s->dx, s->dy, s->ex, s->ey);
    const camber_u32 word = join_word(turn, row, method);
    const double t = fabs(s->turn), tan_half = tan(fmin(t, PI - 1e-9) / 2), length = 1 / cos(fmin(t, PI - 1e-9) / 2);
    if (is_near(tan_half, 2) || is_near(tan_half, sqrt(3)) || is_near(length, row.miter_limit) ||
        is_near(length, 1 / (double)row.round_cos) ||
        fabs(row.reach_px * tan_half - 0.5 * s->shorter) <= 1e-4 * s->shorter || t > 179.9 * PI / 180)
        return;
    const bool is_round = row.join == CAMBER_JOIN_ROUND && length >= 1 / (double)row.round_cos;
    const bool miter = row.join != CAMBER_JOIN_BEVEL && !is_round && length <= row.miter_limit;
    const bool bevel = !is_round && !miter;
    const bool split = !miter && tan_half > 2, tight = row.reach_px * tan_half > 0.5 * s->shorter;
    assert_int_equal(camber_join_kind(word), split ? CAMBER_KIND_SPLIT : tight ? CAMBER_KIND_TIGHT : CAMBER_KIND_CUT);
    if (method == CAMBER_STRIP && (split || tight))
        assert_int_equal(camber_join_end(word), miter   ? CAMBER_END_SPLIT_MITER
                                                : bevel ? CAMBER_END_SPLIT_BEVEL
                                                        : CAMBER_END_SPLIT_ROUND);
    else
        assert_int_equal(camber_join_end(word), miter ? CAMBER_END_MITER : bevel ? CAMBER_END_BEVEL : CAMBER_END_ROUND);
    const camber_u32 triangles = camber_join_triangles(word);
    if (method == CAMBER_STRIP || fabsf(turn.s) <= CAMBER_STRAIGHT_SINE)
        assert_int_equal(triangles, 0);
    else if (method == CAMBER_KITE || !is_round)
        assert_int_equal(triangles, !miter && t > 120 * PI / 180 ? 4 : 2);
}

/* A join tells how long a stub is, and whether the line has butt caps. Before such a cap the longer segment takes the
 * stub for its end. Elsewhere one that goes on beside a stub ends in an edge: in wide lines either, in thin ones none.
 */
static void test_stubs(void **state) {
    (void)state;
    const float thin = CAMBER_TIPS_PX, usual = CAMBER_WIDE_PX, wide = CAMBER_WIDE_PX + 1;
    for (int i = 0; i <= 400; i++) {
        const float length = (float)i * 0.005f, longer = length + 1.0f;
        const camber_u32 word = camber_stub_pack(CAMBER_CAPS_BUTT, 0.5f * length);
        const bool stub = length < CAMBER_STUB_PX;
        assert_int_equal(camber_stub_pack(CAMBER_CAPS_ROUND, 0.5f * length), word & ~CAMBER_JOIN_BUTT);
        assert_true(word & CAMBER_JOIN_BUTT);
        assert_int_equal(camber_opens(word, longer, thin), 0);
        assert_int_equal(camber_opens(word, longer, usual), stub);
        assert_int_equal(camber_opens(word, length, usual), 0);
        assert_int_equal(camber_opens(word, length, wide), stub);
        assert_int_equal(camber_is_longer(word, longer), stub);
        assert_int_equal(camber_is_longer(word, length), 0);
        assert_int_equal(camber_flat_join(word, 0, 0, 1, longer), 0);
        assert_int_equal(camber_flat_join(word, 0, 1, 0, longer), 0);
        assert_int_equal(CAMBER_END_FLAT(camber_flat_join(word, 0, 1, 1, longer)), CAMBER_STUB_MOST);
        const camber_u32 flat = CAMBER_END_FLAT(camber_flat_join(word, 1, 0, 1, longer));
        if (stub)
            assert_near(((double)flat - 1) * CAMBER_STUB_UNIT_PX, length, (double)CAMBER_STUB_UNIT_PX);
        else
            assert_int_equal(flat, 0);
        /* A segment that is no longer than the stub is it. */
        assert_int_equal(camber_flat_join(word, 1, 0, 1, length), 0);
        assert_int_equal(CAMBER_END_FLAT(camber_flat_join(word, 1, 1, 0, length)), CAMBER_STUB_MOST);
    }
}

static void test_words(void **state) {
    (void)state;
    static const float limits[] = {1.0f, 1.5f, 2.0f, 10.0f, 1e9f};
    uint64_t seed = 2;
    for (int k = 0; k <= STEPS; k++)
        for (camber_u32 method = 0; method < 3; method++)
            for (camber_u32 join = 0; join < 3; join++) {
                const sample s = make_sample(&seed, k * 0.1 - 180);
                const float width = (float)pow(10, camber_random_between(&seed, -1, 3));
                camber_row row = make_row(width, join, limits[camber_random_below(&seed, 5)], 0.3);
                row.round_cos =
                    k % 2 || join != CAMBER_JOIN_ROUND ? 2.0f : 1.0f / limits[camber_random_below(&seed, 5)];
                check_word(&s, row, method);
            }
}

/* On each side of every threshold, close by. */
static void test_thresholds(void **state) {
    (void)state;
    const double splits = 2 * atan(2), kites = 120 * PI / 180;
    for (int above = 0; above < 2; above++) {
        const double by = above ? 1e-5 : -1e-5;
        for (int sign = -1; sign < 2; sign += 2) {
            /* Long segments: never tight. */
            const camber_turn past_split =
                camber_turn_between(1e5f, 0, (float)(1e5 * cos(splits + by)), (float)(sign * 1e5 * sin(splits + by)));
            const camber_u32 word = join_word(past_split, make_row(4, CAMBER_JOIN_ROUND, 2, 0.3), CAMBER_STRIP);
            assert_int_equal(camber_join_kind(word), above ? CAMBER_KIND_SPLIT : CAMBER_KIND_CUT);
            const camber_turn past_kite =
                camber_turn_between(1e5f, 0, (float)(1e5 * cos(kites + by)), (float)(sign * 1e5 * sin(kites + by)));
            const camber_u32 kite = join_word(past_kite, make_row(4, CAMBER_JOIN_ROUND, 2, 0.3), CAMBER_KITE);
            assert_int_equal(camber_join_triangles(kite), above ? 4 : 2);
            /* A limit of 2 is a turn of 120 degrees, as SVG has it. */
            const camber_u32 miter = join_word(past_kite, make_row(4, CAMBER_JOIN_MITER, 2, 0.3), CAMBER_STRIP);
            assert_int_equal(camber_join_end(miter), above ? CAMBER_END_BEVEL : CAMBER_END_MITER);
            /* A right angle, half of its shorter segment a little less or more than the reach. */
            const float shorter = (float)(2 * (2 + 0.75) * (1 - by));
            const camber_turn right = camber_turn_between(100, 0, 0, (float)sign * shorter);
            const camber_u32 tight = join_word(right, make_row(4, CAMBER_JOIN_ROUND, 2, 0.3), CAMBER_STRIP);
            assert_int_equal(camber_join_kind(tight), above ? CAMBER_KIND_TIGHT : CAMBER_KIND_CUT);
        }
    }
}

static void test_fan_triangles(void **state) {
    (void)state;
    uint64_t seed = 3;
    for (int k = 0; k <= STEPS; k++) {
        for (int repeat = 0; repeat < 10; repeat++) {
            const sample s = make_sample(&seed, k * 0.1 - 180);
            const double step = camber_random_between(&seed, PI / CAMBER_JOIN_TRIANGLES_MAX, PI / 2);
            const camber_row row = make_row(4, CAMBER_JOIN_ROUND, 2, step);
            const camber_turn turn = camber_turn_between(s.dx, s.dy, s.ex, s.ey);
            const double n = camber_fan_triangles(turn.dot, row.fan_cos, row.fan_sin);
            const double exact = fabs(s.turn) / step;
            const double wanted = fmin(fmax(ceil(exact), 1), CAMBER_JOIN_TRIANGLES_MAX);
            /* A cosine near -1 or 1 leaves 5e-4 rad of the angle open. */
            if (fabs(exact - round(exact)) < 1e-3 / step)
                assert_near(n, wanted, 1);
            else
                assert_true(n == wanted);
        }
    }
}

/* The bound that makes a block's index count fit 16 bits: join_counts at its worst. */
static void test_counts_fit(void **state) {
    (void)state;
    uint64_t seed = 4;
    camber_u32 most_vertices = 0, most_indices = 0;
    for (int i = 0; i < 200000; i++) {
        const sample s = make_sample(&seed, camber_random_between(&seed, -180, 180));
        const camber_row row =
            make_row(1000, (camber_u32)camber_random_below(&seed, 3), 2, PI / CAMBER_JOIN_TRIANGLES_MAX);
        const camber_u32 method = (camber_u32)camber_random_below(&seed, 3);
        const camber_u32 word = join_word(camber_turn_between(s.dx, s.dy, s.ex, s.ey), row, method);
        const camber_u32 counts = camber_join_counts(word, word, CAMBER_POINT_REAL, method);
        most_vertices = (counts & 0xffffu) > most_vertices ? counts & 0xffffu : most_vertices;
        most_indices = counts >> 16 > most_indices ? counts >> 16 : most_indices;
    }
    assert_true(most_indices >= 3 * CAMBER_JOIN_TRIANGLES_MAX); /* the worst was met */
    assert_true(most_vertices * CAMBER_BLOCK < 65536 && most_indices * CAMBER_BLOCK < 65536);
}

/* Beside a line points have steps; what is no number or too far for an integer stays as it is. */
static void test_offset_steps(void **state) {
    (void)state;
    static const float as_it_is[] = {65537.25f, -65537.25f, 1e30f, -1e30f, INFINITY, -INFINITY};
    for (size_t i = 0; i < sizeof as_it_is / sizeof *as_it_is; i++)
        assert_true(camber_offset_round(as_it_is[i]) == as_it_is[i]);
    assert_true(isnan(camber_offset_round(NAN)));
    uint64_t seed = 3;
    for (int i = 0; i < 10000; i++) {
        const float px = (float)camber_random_between(&seed, -65536, 65536), rounded = camber_offset_round(px);
        assert_true(fabsf(rounded - px) <= 1.0f / 4096 && fmodf(rounded * 4096, 1) == 0);
        assert_true(camber_offset_round(-px) == -rounded);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_half_turn), cmocka_unit_test(test_packing),    cmocka_unit_test(test_degenerate_vectors),
        cmocka_unit_test(test_words),     cmocka_unit_test(test_thresholds), cmocka_unit_test(test_fan_triangles),
        cmocka_unit_test(test_stubs),     cmocka_unit_test(test_counts_fit), cmocka_unit_test(test_offset_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
