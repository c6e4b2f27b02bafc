/* Ramps: colours along lines, against samples of what they should be. */
#include "along_picture.h"

#include <stdio.h>

enum { SIDE = ALONG_SIDE };

static const camber_color RED = {1, 0, 0, 1}, GREEN = {0, 1, 0, 1}, BLUE = {0, 0, 1, 1}, WHITE = {1, 1, 1, 1};

static drawing drawing_of(int line, float width_px, camber_method method, camber_ramp ramp) {
    return (drawing){.points = ALONG_LINES[line].points,
                     .count = ALONG_LINES[line].count,
                     .stroke = {width_px, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                     .method = method,
                     .paint = {.width_px = width_px, .color = WHITE},
                     .ramp = ramp};
}

static void check(fixture *s, const drawing *d, double mean_bound, double most_bound) {
    static along_truth truth;
    along_sample(d, truth);
    picture p = along_draw(s, d);
    const along_error e = along_compare(&p, truth);
    if (e.mean > mean_bound || e.most > most_bound)
        fail_msg("%zu points, width %g, method %d, %zu stops: %.2f of 255 on average, %.0f at %zu, %zu", d->count,
                 (double)d->paint.width_px, (int)d->method, d->ramp.count, e.mean, e.most, e.x, e.y);
    picture_free(&p);
}

/* ---- Ramps ---- */

static camber_ramp_stop smooth[] = {{0, {1, 0, 0, 1}}, {0.3f, {1, 1, 0, 1}}, {0.55f, {0, 1, 1, 1}}, {1, {0, 0, 1, 1}}};
static camber_ramp_stop steps[] = {{0.21f, {1, 0, 0, 1}},  {0.21f, {0, 0, 1, 1}}, {0.513f, {0, 0, 1, 1}},
                                   {0.513f, {0, 1, 0, 1}}, {0.87f, {0, 1, 0, 1}}, {0.87f, {1, 1, 1, 1}}};
static camber_ramp_stop glass[] = {
    {0.1f, {1, 0, 0, 0}}, {0.5f, {0, 1, 0, 0.8f}}, {0.5f, {0, 0, 1, 0.5f}}, {0.9f, {1, 1, 1, 1}}};
static camber_ramp_stop many[1000]; /* about ten a pixel */
static const camber_ramp RAMPS[] = {{smooth, 4}, {steps, 6}, {glass, 4}, {many, 1000}};

static void fill_many(void) {
    for (size_t i = 0; i < 1000; i++) {
        const double t = (double)i / 999;
        many[i] = (camber_ramp_stop){(float)t,
                                     {(float)(0.5 + 0.5 * sin(20 * t)), (float)(0.5 + 0.5 * cos(31 * t)), (float)t, 1}};
    }
}

static void test_straight(void **state) {
    for (size_t i = 0; i < 4; i++)
        for (int method = 0; method < 3; method++)
            for (int wide = 0; wide < 3; wide++) {
                const drawing d = drawing_of(0, wide == 0 ? 1.3f : wide == 1 ? 4 : 14, (camber_method)method, RAMPS[i]);
                check(*state, &d, 1.6, 17);
            }
}

/* On the inner side of a bend both segments have the place to say: a step there is a matter of opinion, and in a fan,
 * whose triangles do not go by the bisector, a smooth ramp's colour too. */
static void test_bent(void **state) {
    for (size_t i = 0; i < 4; i++)
        for (int method = 0; method < 3; method++)
            for (int line = 1; line < 3; line++) {
                const drawing d = drawing_of(line, 9, (camber_method)method, RAMPS[i]);
                check(*state, &d, 3, line == 1 || i == 1 || i == 2 ? 130 : method == CAMBER_METHOD_FAN ? 48 : 40);
            }
}

/* Every angle, with the step in the middle: where red ends lies within a tenth of a pixel. */
static void test_step_place(void **state) {
    const camber_ramp_stop stops[] = {{0.5f, {1, 0, 0, 1}}, {0.5f, {0, 0, 1, 1}}};
    uint64_t seed = 3;
    for (int i = 0; i < 40; i++) {
        const double angle = i == 0 ? 0 : camber_random_between(&seed, 0, 6.283),
                     x = camber_random_between(&seed, 45, 50), y = camber_random_between(&seed, 45, 50),
                     before = camber_random_between(&seed, 20, 35);
        const float points[] = {(float)(x - before * cos(angle)), (float)(y - before * sin(angle)),
                                (float)(x + before * cos(angle)), (float)(y + before * sin(angle))};
        drawing d = drawing_of(0, 10, CAMBER_METHOD_STRIP, (camber_ramp){stops, 2});
        d.points = points;
        picture p = along_draw(*state, &d);
        double red = 0, blue = 0;
        for (size_t k = 0; k < (size_t)SIDE * SIDE; k++) {
            red += p.rgba[4 * k] / 255.0;
            blue += p.rgba[4 * k + 2] / 255.0;
        }
        /* Areas are lengths times the width, and the ends are the same. */
        if (fabs(red - blue) > 2 * 0.1 * 10)
            fail_msg("angle %g: %.2f px of red, %.2f px of blue", angle, red / 10, blue / 10);
        picture_free(&p);
    }
}

/* A line of three pixels with a thousand stops, and a dot. */
static void test_short(void **state) {
    const float points[] = {40, 40, 43, 40};
    drawing d = drawing_of(0, 20, CAMBER_METHOD_STRIP, (camber_ramp){many, 1000});
    d.points = points;
    check(*state, &d, 14, 60);
    const float dot[] = {40, 40, 40, 40};
    d.points = dot;
    d.stroke.cap = CAMBER_CAP_ROUND;
    d.ramp = (camber_ramp){smooth, 4};
    picture p = along_draw(*state, &d);
    for (int c = 0; c < 4; c++)
        assert_true(picture_value(&p, 40, 40, c) == (c == 0 || c == 3));
    picture_free(&p);
}

static void test_caps(void **state) {
    for (size_t i = 0; i < 4; i++)
        for (int line = 0; line < 3; line += 2) {
            drawing d = drawing_of(line, 11, CAMBER_METHOD_STRIP, RAMPS[i]);
            d.stroke.cap = CAMBER_CAP_ROUND;
            check(*state, &d, 3, 130);
        }
}

/* With half a gap, with the cheaper coverage, below another color, and through a layer. */
static void test_with_others(void **state) {
    for (size_t i = 0; i < 4; i++) {
        drawing d = drawing_of(0, 14, CAMBER_METHOD_STRIP, RAMPS[i]);
        d.paint.width_px = 4;
        d.paint.gap_px = 6;
        check(*state, &d, 2, 24);
        d = drawing_of(0, 8, CAMBER_METHOD_STRIP, RAMPS[i]);
        d.coverage = CAMBER_COVERAGE_LINEAR;
        check(*state, &d, 3, 40);
        d.coverage = CAMBER_COVERAGE_EXACT;
        d.paint.color = (camber_color){0.5f, 1, 0.25f, 0.4f};
        check(*state, &d, 2, 17);
        d.overlap = CAMBER_OVERLAP_ACCUMULATE;
        check(*state, &d, 2, 17);
        d.overlap = CAMBER_OVERLAP_UNITE;
        check(*state, &d, 2, 17);
    }
}

/* ---- Lines over themselves ---- */

/* There and back, sharply, so that the way back lies on the way there: where both are, the alpha is that of one. */
static void test_translucent_folds(void **state) {
    const float hairpin[] = {10, 30, 80, 34, 12, 42, 78, 47, 30, 60, 34, 62, 31, 64, 60, 80};
    const camber_ramp_stop half[] = {{0, {1, 0, 0, 0.5f}}, {1, {0, 0, 1, 0.5f}}};
    for (int method = 0; method < 3; method++)
        for (int opacity = 0; opacity < 2; opacity++)
            for (int join = 0; join < 3; join++) {
                drawing d = drawing_of(0, 12, (camber_method)method, (camber_ramp){half, 2});
                d.points = hairpin;
                d.count = 8;
                d.stroke.join = (camber_join)join;
                d.opacity = opacity ? 0.5f : 0;
                picture p = along_draw(*state, &d);
                const int most = opacity ? 65 : 129;
                size_t inside = 0;
                for (size_t k = 0; k < (size_t)SIDE * SIDE; k++) {
                    const uint8_t *q = p.rgba + 4 * k;
                    inside += q[3] >= most - 3;
                    if (q[3] > most || q[0] + q[2] > most + 2)
                        fail_msg("method %d, join %d: %d of red, %d of blue, %d in all at %zu, %zu", method, join, q[0],
                                 q[2], q[3], k % SIDE, k / SIDE);
                }
                assert_true(inside > 1500);
                picture_free(&p);
            }
}

/* The part that is farther along lies on top and hides what is below, translucent or not. */
static void test_crossing(void **state) {
    const float loop[] = {10, 48, 86, 48, 86, 86, 48, 86, 48, 10};
    const camber_ramp_stop stops[] = {{0.3f, {1, 0, 0, 0.6f}}, {0.7f, {0, 0, 1, 0.4f}}};
    drawing d = drawing_of(0, 10, CAMBER_METHOD_STRIP, (camber_ramp){stops, 2});
    d.points = loop;
    d.count = 5;
    picture p = along_draw(*state, &d);
    assert_true(fabs(picture_value(&p, 48, 48, 0)) < 0.02);
    assert_true(fabs(picture_value(&p, 48, 48, 2) - 0.4) < 0.02);
    assert_true(fabs(picture_value(&p, 48, 48, 3) - 0.4) < 0.02);
    picture_free(&p);
}

/* A row without a ramp in a layer with one. */
static void test_beside_plain(void **state) {
    fixture *s = *state;
    camber_made_scene lines = {0};
    for (int i = 0; i < 2; i++) {
        camber_made_scene_point(&lines, 10, 30 + 30 * i);
        camber_made_scene_point(&lines, 80, 30 + 30 * i);
        camber_made_scene_end(&lines, (size_t)i);
    }
    const camber_stroke strokes[] = {{10, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                                     {10, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0}};
    const camber_tessellation_desc desc = {.strokes = strokes, .stroke_count = 2, .has_arc_length = true};
    camber_mesh *mesh = fixture_mesh(s, fixture_any(s), &lines, &desc);
    const camber_ramp_stop stops[] = {{0, {1, 0, 0, 0.5f}}};
    const camber_ramp ramp = {stops, 1};
    const camber_paint paints[] = {{.width_px = 10, .color = GREEN}, {.width_px = 10, .color = WHITE, .ramp = &ramp}};
    const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = 2};
    picture p =
        picture_draw(fixture_any(s), &(camber_frame){.width = SIDE, .height = SIDE, .passes = &pass, .pass_count = 1});
    for (int c = 0; c < 4; c++) {
        const double plain = picture_value(&p, 40, 30, c), ramped = picture_value(&p, 40, 60, c);
        assert_true(plain == (c == 1 || c == 3));
        assert_true(fabs(ramped - (c == 0 || c == 3 ? 0.5 : 0)) < 0.01);
    }
    picture_free(&p);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
}

/* ---- Networks ---- */

/* The whole, and what two cameras see of its halves: the same colours at the same places, to the rounding of cuts. */
static void test_halves(void **state) {
    fixture *s = *state;
    const double points[] = {-900, 20, -30, 60, 20, 30, 50, 130, 90, 20, 180, 110, 2000, 300};
    const size_t offsets[] = {0, 7};
    const camber_network_desc desc = {
        .points = points, .offsets = offsets, .polyline_count = 1, .has_arc_length = true};
    const camber_stroke stroke = {12, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_tessellation_desc tessellation = {.strokes = &stroke, .stroke_count = 1, .has_arc_length = true};
    camber_ramp_stop stops[40];
    for (size_t i = 0; i < 40; i++) /* a step every 80 px, or so */
        stops[i] = (camber_ramp_stop){(float)(i / 2 + i % 2) / 20, i / 2 % 3 == 0   ? RED
                                                                   : i / 2 % 3 == 1 ? GREEN
                                                                                    : BLUE};
    const camber_ramp ramp = {stops, 40};
    const camber_paint paint = {.width_px = 12, .color = WHITE, .ramp = &ramp};
    camber_network *network = NULL;
    camber_mesh *mesh = NULL;
    picture pictures[3];
    assert_int_equal(camber_network_create(s->context, &desc, &network), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->on.device, fixture_any(s), &mesh), CAMBER_OK);
    for (int i = 0; i < 3; i++) {
        const camber_camera camera = {.x = i == 0   ? 100
                                           : i == 1 ? 50
                                                    : 150,
                                      .y = 80,
                                      .scale_px = 1,
                                      .width = i == 0 ? 200 : 100,
                                      .height = 160};
        assert_int_equal(camber_mesh_tessellate_network(mesh, network, &camera, &tessellation), CAMBER_OK);
        const camber_pass pass = {.mesh = mesh, .paints = &paint, .paint_count = 1};
        pictures[i] = picture_draw(
            fixture_any(s), &(camber_frame){.width = camera.width, .height = 160, .passes = &pass, .pass_count = 1});
    }
    size_t drawn = 0;
    for (uint32_t y = 0; y < 160; y++)
        for (uint32_t x = 0; x < 200; x++)
            for (int c = 0; c < 4; c++) {
                const double whole = picture_value(pictures, x, y, c),
                             half = picture_value(pictures + 1 + x / 100, x % 100, y, c);
                drawn += whole > 0;
                if (fabs(whole - half) > 3.1 / 255)
                    fail_msg("channel %d at %u, %u: %g and %g", c, x, y, whole, half);
            }
    assert_true(drawn > 5000);
    for (int i = 0; i < 3; i++)
        picture_free(pictures + i);
    camber_mesh_destroy(mesh);
    camber_network_destroy(network);
}

/* ---- Refusals ---- */

static void test_refused(void **state) {
    fixture *s = *state;
    camber_ramp_stop nan_place[] = {{NAN, {1, 0, 0, 1}}}, back[] = {{0.5f, {1, 0, 0, 1}}, {0.4f, {1, 0, 0, 1}}},
                     nan_color[] = {{0, {1, NAN, 0, 1}}};
    const camber_ramp bad[] = {
        {nan_place, 1}, {back, 2}, {nan_color, 1}, {smooth, 0}, {smooth, CAMBER_RAMP_STOPS_MAX + 1}};
    const float points[] = {10, 10, 50, 50};
    const uint32_t offsets[] = {0, 2};
    const camber_polylines_desc desc = {.points = points, .point_count = 2, .offsets = offsets, .polyline_count = 1};
    const camber_stroke stroke = {3, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    camber_polylines *polylines = NULL;
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_polylines_create(s->context, &desc, &polylines), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->on.device, fixture_any(s), &mesh), CAMBER_OK);
    for (size_t i = 0; i < 6; i++) {
        const camber_tessellation_desc tessellation = {.strokes = &stroke, .stroke_count = 1, .has_arc_length = i < 5};
        assert_int_equal(camber_mesh_tessellate(mesh, polylines, &tessellation), CAMBER_OK);
        const camber_ramp ramp = i < 5 ? bad[i] : (camber_ramp){smooth, 4};
        const camber_paint paint = {.width_px = 3, .color = WHITE, .ramp = &ramp};
        const camber_pass pass = {.mesh = mesh, .paints = &paint, .paint_count = 1};
        const camber_frame frame = {.width = 64, .height = 64, .passes = &pass, .pass_count = 1};
        assert_int_equal(camber_renderer_render(fixture_any(s), &frame, NULL, NULL, NULL), CAMBER_ERROR_ARGUMENT);
        assert_story(&s->h, i < 5 ? "a ramp of" : "ramps of a mesh without arc lengths");
    }
    camber_mesh_destroy(mesh);
    camber_polylines_destroy(polylines);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_straight),
        cmocka_unit_test(test_bent),
        cmocka_unit_test(test_step_place),
        cmocka_unit_test(test_short),
        cmocka_unit_test(test_caps),
        cmocka_unit_test(test_with_others),
        cmocka_unit_test(test_translucent_folds),
        cmocka_unit_test(test_crossing),
        cmocka_unit_test(test_beside_plain),
        cmocka_unit_test(test_halves),
        cmocka_unit_test(test_refused),
    };
    if (!fixture_begin())
        return 77;
    fill_many();
    const int failed = cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
    return failed;
}
