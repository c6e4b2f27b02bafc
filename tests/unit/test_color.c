/* Colours against what CSS Color Module Level 4 says of them. */
#include "style/color.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

typedef struct sample {
    const char *text;
    double r, g, b; /* 0 to 255 */
    double a;       /* 0 to 1 */
} sample;

static void check(const sample *samples, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const sample *s = &samples[i];
        camber_color color = {-1.0f, -1.0f, -1.0f, -1.0f};
        if (!camber_color_parse(s->text, &color))
            fail_msg("%s does not parse", s->text);
        if (fabs(color.r * 255.0 - s->r) > 0.51 || fabs(color.g * 255.0 - s->g) > 0.51 ||
            fabs(color.b * 255.0 - s->b) > 0.51 || fabs(color.a - s->a) > 0.003)
            fail_msg("%s is %g %g %g %g, not %g %g %g %g", s->text, color.r * 255.0, color.g * 255.0, color.b * 255.0,
                     (double)color.a, s->r, s->g, s->b, s->a);
    }
}

static void test_hex(void **state) {
    (void)state;
    static const sample samples[] = {
        {"#0f0", 0, 255, 0, 1},
        {"#00ff00", 0, 255, 0, 1},
        {"#0F08", 0, 255, 0, 136 / 255.0},
        {"#123", 17, 34, 51, 1},
        {"#12345678", 18, 52, 86, 120 / 255.0},
        {"#aBcDeF", 171, 205, 239, 1},
        {"  #fff\n", 255, 255, 255, 1},
    };
    check(samples, sizeof samples / sizeof *samples);
}

static void test_rgb(void **state) {
    (void)state;
    static const sample samples[] = {
        {"rgb(255, 0, 128)", 255, 0, 128, 1},
        {"rgb(255 0 128)", 255, 0, 128, 1},
        {"RGBA(1,2,3,0.5)", 1, 2, 3, 0.5},
        {"rgb(1,2,3,.25)", 1, 2, 3, 0.25},
        {"rgba(100%, 0%, 50%, 50%)", 255, 0, 127.5, 0.5},
        {"rgb(0% 0% 100% / 0)", 0, 0, 255, 0},
        {"rgb( 10 20 30 / 25% )", 10, 20, 30, 0.25},
        {"rgb(300, -20, 1e2)", 255, 0, 100, 1},
        {"rgba(0, 0, 0, 7)", 0, 0, 0, 1},
        {"rgb(1e999, 0, 0)", 255, 0, 0, 1},
    };
    check(samples, sizeof samples / sizeof *samples);
}

/* Section 7.1's examples, and colours whose hues are known. */
static void test_hsl(void **state) {
    (void)state;
    static const sample samples[] = {
        {"hsl(120deg, 100%, 50%)", 0, 255, 0, 1},      {"hsl(120, 100%, 25%)", 0, 127.5, 0, 1},
        {"hsl(120 75% 75%)", 143, 239, 143, 1},        {"hsl(0 100% 50% / 0.4)", 255, 0, 0, 0.4},
        {"hsla(240, 100%, 50%, 0.3)", 0, 0, 255, 0.3}, {"hsl(-120, 100%, 50%)", 0, 0, 255, 1},
        {"hsl(480, 100%, 50%)", 0, 255, 0, 1},         {"hsl(0.5turn 100% 50%)", 0, 255, 255, 1},
        {"hsl(200grad 100% 50%)", 0, 255, 255, 1},     {"hsl(3.14159265rad 100% 50%)", 0, 255, 255, 1},
        {"hsl(30, 0%, 40%)", 102, 102, 102, 1},        {"hsl(60, 200%, 50%)", 255, 255, 0, 1},
        {"hsl(39, 100%, 50%)", 255, 165.75, 0, 1},
    };
    check(samples, sizeof samples / sizeof *samples);
}

static void test_names(void **state) {
    (void)state;
    static const sample samples[] = {
        {"transparent", 0, 0, 0, 0},
        {"black", 0, 0, 0, 1},
        {"White", 255, 255, 255, 1},
        {"rebeccapurple", 102, 51, 153, 1},
        {"aliceblue", 240, 248, 255, 1},
        {"yellowgreen", 154, 205, 50, 1},
        {"lightgoldenrodyellow", 250, 250, 210, 1},
        {"DarkSlateGrey", 47, 79, 79, 1},
        {"orange", 255, 165, 0, 1},
    };
    check(samples, sizeof samples / sizeof *samples);
}

static void test_refused(void **state) {
    (void)state;
    static const char *const texts[] = {"",
                                        "   ",
                                        "#",
                                        "#12",
                                        "#12345",
                                        "#1234567",
                                        "#123456789",
                                        "#ggg",
                                        "nocolor",
                                        "rgb",
                                        "rgb(",
                                        "rgb()",
                                        "rgb(1,2)",
                                        "rgb(1,2,3",
                                        "rgb(1,2,3))",
                                        "rgb(1,2,3,4,5)",
                                        "rgb(1 2,3)",
                                        "rgb(1,2 3)",
                                        "rgb(10%, 2, 3)",
                                        "rgb(1,2,3 / 4)",
                                        "rgb(1 2 3 4)",
                                        "rgb(1 2 3 /)",
                                        "rgb(a,b,c)",
                                        "rgb(1deg,2,3)",
                                        "hsl(1,2,3)",
                                        "hsl(10%,20%,30%)",
                                        "hsl(1,2%,3%) x",
                                        "hsl(1e999,2%,3%)",
                                        "#\xff\xff\xff",
                                        "rgb(nan,0,0)",
                                        "rgb(inf,0,0)",
                                        "rgb(0x10,0,0)",
                                        "averyveryveryverylongnamethatisnocoloratall",
                                        "(",
                                        "rgb((1,2,3)"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        camber_color color = {0.5f, 0.5f, 0.5f, 0.5f};
        if (camber_color_parse(texts[i], &color))
            fail_msg("'%s' parses", texts[i]);
        assert_true(color.r == 0.5f && color.a == 0.5f);
    }
}

static void test_long(void **state) {
    (void)state;
    static char text[100001];
    camber_color color;
    memset(text, '9', sizeof text - 1);
    memcpy(text, "rgb(", 4);
    assert_false(camber_color_parse(text, &color));
    text[0] = '#';
    assert_false(camber_color_parse(text, &color));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hex),   cmocka_unit_test(test_rgb),     cmocka_unit_test(test_hsl),
        cmocka_unit_test(test_names), cmocka_unit_test(test_refused), cmocka_unit_test(test_long),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
