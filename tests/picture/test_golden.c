/* Golden pictures of what the core draws. What is black on white is held against the oracle as well, so that a picture
 * is no truth just because it was drawn yesterday. ./dev golden renews them. */
#include "golden.h"
#include "torture_judge.h"

static const camber_color WHITE = {1, 1, 1, 1};

static golden begin(const char *name, uint32_t width, uint32_t height) {
    return (golden){.name = name, .width = width, .height = height, .background = WHITE, .pass_count = 1};
}

static void finish(void **state, golden *g) {
    assert_true(golden_draw(*state, g));
}

/* A point off the grid of pixels, so that edges fall on every part of one. */
static void add_point(golden *g, double x, double y) {
    camber_made_scene_point(&g->lines, x + 0.37, y + 0.61);
}

static void add_arm(golden *g, const double from[2], double length, double direction_deg) {
    const double angle = direction_deg * SCENE_PI / 180;
    add_point(g, from[0] + length * cos(angle), from[1] + length * sin(angle));
}

/* ---- Joins, caps, rings, dots ---- */

/* Turns of 15 to 180 degrees from left to right, to either side, at four widths; the last row on short arms. */
static void draw_turns(void **state, const char *name, camber_join join, camber_method method) {
    static const float widths_px[] = {1.5f, 5, 12, 16};
    static const double arms_px[] = {18, 18, 18, 7};
    golden g = begin(name, 12 * 52, 4 * 52);
    g.method = method;
    g.oracle_mean = 1.25;
    for (int i = 0; i < 48; i++) {
        const int row = i / 12;
        const double turn = 15 * (i % 12 + 1), base = 20 + 7 * i;
        const double centre[] = {26 + 52 * (i % 12), 26 + 52 * row};
        const size_t style = golden_row(&g, (camber_stroke){widths_px[row], join, CAMBER_CAP_BUTT, 4});
        add_arm(&g, centre, arms_px[row], base + 180);
        add_point(&g, centre[0], centre[1]);
        add_arm(&g, centre, arms_px[row], base + (i % 2 ? turn : -turn));
        camber_made_scene_end(&g.lines, style);
    }
    finish(state, &g);
}

static void test_round_joins(void **state) {
    draw_turns(state, "joins-round", CAMBER_JOIN_ROUND, CAMBER_METHOD_STRIP);
}

static void test_miter_joins(void **state) {
    draw_turns(state, "joins-miter", CAMBER_JOIN_MITER, CAMBER_METHOD_STRIP);
}

static void test_bevel_joins(void **state) {
    draw_turns(state, "joins-bevel", CAMBER_JOIN_BEVEL, CAMBER_METHOD_STRIP);
}

static void test_kite(void **state) {
    draw_turns(state, "joins-round-kite", CAMBER_JOIN_ROUND, CAMBER_METHOD_KITE);
}

static void test_fan(void **state) {
    draw_turns(state, "joins-round-fan", CAMBER_JOIN_ROUND, CAMBER_METHOD_FAN);
}

/* Butt, round and square from the top down, wider and wider, turned further and further. */
static void test_caps(void **state) {
    static const float widths_px[] = {0.5f, 1, 2, 4, 8, 14, 20, 26};
    golden g = begin("caps", 8 * 60, 3 * 60);
    g.oracle_mean = 0.4;
    for (int i = 0; i < 24; i++) {
        const double centre[] = {30 + 60 * (i % 8), 30 + 60 * (i / 8)};
        const size_t style =
            golden_row(&g, (camber_stroke){widths_px[i % 8], CAMBER_JOIN_ROUND, (camber_cap)(i / 8), 0});
        add_arm(&g, centre, 14, 11 * i);
        add_arm(&g, centre, 14, 11 * i + 180);
        camber_made_scene_end(&g.lines, style);
    }
    finish(state, &g);
}

/* Rings of three sides and more with each join; the smallest are narrower than their line. */
static void test_rings(void **state) {
    static const int sides[] = {3, 4, 5, 6, 8, 24};
    static const double radii_px[] = {22, 20, 21, 12, 6, 4};
    golden g = begin("rings", 6 * 60, 3 * 60);
    g.oracle_mean = 0.4;
    for (int i = 0; i < 18; i++) {
        const double centre[] = {30 + 60 * (i % 6), 30 + 60 * (i / 6)};
        const size_t style = golden_row(&g, (camber_stroke){9, (camber_join)(i / 6), CAMBER_CAP_BUTT, 3});
        const int n = sides[i % 6];
        for (int k = 0; k <= n; k++)
            add_arm(&g, centre, radii_px[i % 6], 10 + 360.0 / n * (k % n));
        camber_made_scene_end(&g.lines, style);
    }
    finish(state, &g);
}

static void test_dots(void **state) {
    golden g = begin("dots", 12 * 32, 2 * 32);
    g.oracle_mean = 0.8;
    for (int i = 0; i < 24; i++) {
        const float width = 0.4f * powf(1.43f, (float)(i % 12));
        const size_t style =
            golden_row(&g, (camber_stroke){width, CAMBER_JOIN_ROUND, i < 12 ? CAMBER_CAP_ROUND : CAMBER_CAP_SQUARE, 0});
        add_point(&g, 16 + 32 * (i % 12) + 0.09 * i, 16 + 32 * (i / 12) + 0.05 * i);
        camber_made_scene_end(&g.lines, style);
    }
    finish(state, &g);
}

/* Steps shorter than the width, from a comb to a crawl. */
static void test_zigzags(void **state) {
    static const double steps_px[] = {30, 14, 8, 5, 3, 1.5};
    golden g = begin("zigzags-narrower-than-their-line", 3 * 130, 2 * 70);
    g.oracle_mean = 4.8;
    for (int i = 0; i < 6; i++) {
        const size_t style = golden_row(&g, (camber_stroke){12, (camber_join)(i % 3), CAMBER_CAP_ROUND, 2});
        const double left = 16 + 130 * (i % 3), middle = 34 + 70 * (i / 3);
        const int count = (int)(90 / (0.42 * steps_px[i]));
        for (int k = 0; k <= count; k++)
            add_point(&g, left + 0.42 * steps_px[i] * k, middle + (k % 2 ? 0.45 : -0.45) * steps_px[i]);
        camber_made_scene_end(&g.lines, style);
    }
    finish(state, &g);
}

/* ---- Coverage ---- */

/* Lines from 0.1 to 2 px in a star: they get paler, not thinner. */
static void draw_star(void **state, const char *name, camber_coverage coverage, double bound) {
    golden g = begin(name, 240, 240);
    g.coverage = coverage;
    g.oracle_mean = bound;
    for (int i = 0; i < 40; i++) {
        const size_t style =
            golden_row(&g, (camber_stroke){0.1f + 0.05f * (float)(i % 40), CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0});
        add_arm(&g, (const double[]){120, 120}, 30, 9 * i);
        add_arm(&g, (const double[]){120, 120}, 116, 9 * i);
        camber_made_scene_end(&g.lines, style);
    }
    finish(state, &g);
}

static void test_thin_lines(void **state) {
    draw_star(state, "thin-lines", CAMBER_COVERAGE_EXACT, 1.2);
}

static void test_linear_coverage(void **state) {
    draw_star(state, "thin-lines-linear-coverage", CAMBER_COVERAGE_LINEAR, 4);
}

/* ---- Translucent and coloured ---- */

/* A line that crosses itself, another that turns back on itself, and two that cross. */
static void add_crossings(golden *g, double left) {
    static const double loop[][2] = {{10, 90}, {60, 30}, {100, 60}, {60, 95}, {18, 32}};
    static const double back[][2] = {{20, 128}, {96, 122}, {30, 134}, {100, 146}};
    for (int k = 0; k < 5; k++)
        add_point(g, left + loop[k][0], loop[k][1]);
    camber_made_scene_end(&g->lines, 0);
    for (int k = 0; k < 4; k++)
        add_point(g, left + back[k][0], back[k][1]);
    camber_made_scene_end(&g->lines, 1);
    for (int k = 0; k < 2; k++) {
        add_point(g, left + 50, k ? 165 : 8);
        add_point(g, left + 62, k ? 8 : 165);
        camber_made_scene_end(&g->lines, 0);
    }
}

/* The same lines on the left with every overlap darker, on the right flattened. */
static void test_translucent(void **state) {
    golden g = begin("translucent-accumulated-and-flattened", 240, 174);
    golden_row(&g, (camber_stroke){14, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0});
    golden_row(&g, (camber_stroke){12, CAMBER_JOIN_MITER, CAMBER_CAP_BUTT, 4});
    add_crossings(&g, 0);
    add_crossings(&g, 120);
    g.pass_count = 2;
    for (int i = 0; i < 2; i++) {
        g.paints[i][0] = (camber_paint){.width_px = 14, .color = {0.1f, 0.3f, 0.7f, 0.5f}};
        g.paints[i][1] = (camber_paint){.width_px = 12, .color = {0.7f, 0.2f, 0.1f, 0.5f}};
        g.first_polyline[i] = 4 * (size_t)i;
        g.polyline_count[i] = 4;
        g.overlap[i] = i ? CAMBER_OVERLAP_FLATTEN : CAMBER_OVERLAP_ACCUMULATE;
    }
    finish(state, &g);
}

static void test_hairpins(void **state) {
    golden g = begin("hairpins-flattened", 300, 190);
    for (int i = 0; i < 12; i++) {
        const size_t style = golden_row(&g, (camber_stroke){16, (camber_join)(i % 3), (camber_cap)(i / 4), 3});
        const double left = 18 + 48 * (i % 6), top = 14 + 92 * (i / 6), gap = 0.2 * pow(2.1, i % 6);
        g.paints[0][style] = (camber_paint){.width_px = 16, .color = {0, 0.35f, 0.3f, 0.5f}};
        add_point(&g, left, top);
        add_point(&g, left + 5, top + 62);
        if (i < 6)
            add_point(&g, left + 5 + gap, top + 62);
        add_point(&g, left + gap, top + 8);
        camber_made_scene_end(&g.lines, style);
    }
    finish(state, &g);
}

/* Three streets, one mesh: all casings first, then all fills, narrower. */
static void test_casing(void **state) {
    static const double streets[3][4][2] = {{{-10, 60}, {70, 50}, {120, 90}, {250, 80}},
                                            {{60, -10}, {70, 50}, {60, 150}, {60, 150}},
                                            {{120, 90}, {150, 20}, {170, 130}, {260, 140}}};
    golden g = begin("casing-and-fill", 240, 150);
    g.background = (camber_color){0.95f, 0.94f, 0.9f, 1};
    g.pass_count = 2;
    for (int i = 0; i < 3; i++) {
        const float width = i == 0 ? 20 : 14;
        const size_t style = golden_row(&g, (camber_stroke){width, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0});
        g.paints[0][style] = (camber_paint){.width_px = width, .color = {0.75f, 0.55f, 0.3f, 1}};
        g.paints[1][style] = (camber_paint){.width_px = width - 5, .color = {1, 0.93f, 0.7f, 1}};
        for (int k = 0; k < 4; k++)
            add_point(&g, streets[i][k][0], streets[i][k][1]);
        camber_made_scene_end(&g.lines, style);
    }
    finish(state, &g);
}

/* Ninety rows: a width and a colour of its own for each line, every fifth half transparent. */
static void test_rows(void **state) {
    golden g = begin("widths-and-colours-by-row", 300, 200);
    for (int i = 0; i < 90; i++) {
        const float width = 0.5f + 0.11f * (float)i;
        const size_t style = golden_row(&g, (camber_stroke){width, (camber_join)(i % 3), CAMBER_CAP_ROUND, 0});
        const float red = (float)(i % 10) / 9, green = (float)(i / 10) / 9;
        g.paints[0][style] = (camber_paint){.width_px = width, .color = {red, green, 1 - red, i % 5 ? 1 : 0.5f}};
        const double x = 15 + 30 * (i % 10), y = 8 + 21 * (i / 10.0);
        add_point(&g, x - 12, y + 4);
        add_point(&g, x, y - 5 + i % 7);
        add_point(&g, x + 14, y + 9);
        camber_made_scene_end(&g.lines, style);
    }
    finish(state, &g);
}

/* ---- The torture set ---- */

/* For people: each figure translucent and flattened, and its own line over it where that can be made
 * out. */
static void test_torture(void **state) {
    const fixture *s = *state;
    camber_torture_set set = camber_torture_make();
    golden g = begin("torture", (uint32_t)set.width, (uint32_t)set.height);
    for (size_t i = 0; i < set.count; i++) {
        const size_t style = golden_row(
            &g, (camber_stroke){(float)set.figures[i].width_px, (camber_join)(i % 3), (camber_cap)(i / 3 % 3), 2});
        g.paints[0][style] = (camber_paint){.width_px = g.strokes[style].width_px, .color = {0.3f, 0.3f, 0.3f, 0.5f}};
        const uint32_t points = set.lines.offsets[i + 1] - set.lines.offsets[i];
        g.paints[1][style] = (camber_paint){.width_px = points < 40 ? 0.6f : 0, .color = {0, 0, 0, 1}};
    }
    g.pass_count = 2;
    g.lines = set.lines;
    set.lines = (camber_made_scene){0};
    assert_true(golden_draw(s, &g));
    camber_torture_free(&set);
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_joins),
        cmocka_unit_test(test_miter_joins),
        cmocka_unit_test(test_bevel_joins),
        cmocka_unit_test(test_kite),
        cmocka_unit_test(test_fan),
        cmocka_unit_test(test_caps),
        cmocka_unit_test(test_rings),
        cmocka_unit_test(test_dots),
        cmocka_unit_test(test_zigzags),
        cmocka_unit_test(test_thin_lines),
        cmocka_unit_test(test_linear_coverage),
        cmocka_unit_test(test_translucent),
        cmocka_unit_test(test_hairpins),
        cmocka_unit_test(test_casing),
        cmocka_unit_test(test_rows),
        cmocka_unit_test(test_torture),
    };
    const int failed = cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
    return failed;
}
