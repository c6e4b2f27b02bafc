/* Paints add to strokes: gaps, blurs and translations, and the opacity of a pass. */
#include "pictures.h"

#include "validate/oracle.h"

#include <stdio.h>

enum { SIDE = 96 };

/* A line with a gentle and a sharper turn; its segments are longer than it is wide. */
static const float bent[] = {14.3f, 20.6f, 42.1f, 30.2f, 44.8f, 70.4f, 80.7f, 76.9f};
enum { BENT = 4 };

typedef struct drawing {
    const float *points;
    size_t count;
    camber_stroke stroke;
    camber_method method;
    camber_paint paint;
    float opacity;
    camber_overlap overlap;
    camber_coverage coverage;
} drawing;

static picture draw(fixture *s, const drawing *d) {
    const camber_tessellation_desc tessellation = {.strokes = &d->stroke, .stroke_count = 1, .method = d->method};
    camber_mesh *mesh = fixture_line(s, d->points, d->count, &tessellation);
    const camber_pass pass = {
        .mesh = mesh, .paints = &d->paint, .paint_count = 1, .overlap = d->overlap, .opacity = d->opacity};
    picture p = picture_draw(
        fixture_any(s),
        &(camber_frame){.width = SIDE, .height = SIDE, .passes = &pass, .pass_count = 1, .coverage = d->coverage});
    camber_mesh_destroy(mesh);
    return p;
}

static double alpha_at(const picture *p, size_t pixel) {
    return p->rgba[4 * pixel + 3] / 255.0;
}

static camber_oracle_window truth_of(const drawing *d, double width_px) {
    camber_oracle_window window;
    const camber_oracle_style style = {.width_px = width_px,
                                       .join = d->stroke.join,
                                       .cap = d->stroke.cap,
                                       .miter_limit = d->stroke.miter_limit > 0 ? d->stroke.miter_limit : 2};
    assert_true(camber_oracle_open(&window, 0, 0, SIDE, SIDE));
    assert_true(camber_oracle_stroke(&window, d->points, d->count, &style));
    return window;
}

/* The whole stroke less that of the gap. */
static void test_gap(void **state) {
    fixture *s = *state;
    static const struct { float width, gap; } sizes[] = {{3, 7}, {1, 1}, {0.5f, 4.6f}, {6, 0.8f}, {4.3f, 9.1f}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int join = 0; join < 3; join++)
            for (int cap = 0; cap < 2; cap++)
                for (int method = 0; method < 3; method++) {
                    const float whole = sizes[i].gap + 2 * sizes[i].width;
                    const drawing d = {
                        .points = bent,
                        .count = BENT,
                        .stroke = {whole, (camber_join)join, (camber_cap)cap, 4},
                        .method = (camber_method)method,
                        .paint = {.width_px = sizes[i].width, .gap_px = sizes[i].gap, .color = {1, 1, 1, 1}}};
                    picture p = draw(s, &d);
                    camber_oracle_window outer = truth_of(&d, whole), inner = truth_of(&d, sizes[i].gap);
                    double sum = 0, most = 0;
                    size_t touched = 0;
                    for (size_t k = 0; k < SIDE * SIDE; k++) {
                        const double truth = camber_oracle_coverage(&outer, (int)(k % SIDE), (int)(k / SIDE)) -
                                             camber_oracle_coverage(&inner, (int)(k % SIDE), (int)(k / SIDE));
                        const double error = fabs(alpha_at(&p, k) - truth);
                        touched += truth > 0 || alpha_at(&p, k) > 0;
                        sum += error;
                        most = fmax(most, error);
                    }
                    if (sum / (double)touched > 2.5 / 255 || most > 0.25)
                        fail_msg("gap %g between %g, join %d, cap %d, method %d: %.2f of 255 on average, %.0f at most",
                                 (double)sizes[i].gap, (double)sizes[i].width, join, cap, method,
                                 255 * sum / (double)touched, 255 * most);
                    camber_oracle_close(&inner);
                    camber_oracle_close(&outer);
                    picture_free(&p);
                }
}

/* Square caps leave a gap open: two rectangles. */
static void test_gap_square(void **state) {
    fixture *s = *state;
    static const float straight[] = {30, 40.5f, 60, 40.5f};
    const drawing d = {.points = straight,
                       .count = 2,
                       .stroke = {12, CAMBER_JOIN_MITER, CAMBER_CAP_SQUARE, 0},
                       .paint = {.width_px = 4, .gap_px = 4, .color = {1, 1, 1, 1}}};
    picture p = draw(s, &d);
    for (size_t k = 0; k < SIDE * SIDE; k++) {
        const size_t x = k % SIDE, y = k / SIDE;
        const double along = x >= 24 && x < 66 ? 1 : 0;
        const double across = (y == 34 || y == 38 || y == 42 || y == 46) ? 0.5
                              : (y > 34 && y < 38) || (y > 42 && y < 46) ? 1
                                                                         : 0;
        if (fabs(alpha_at(&p, k) - along * across) > 2.5 / 255)
            fail_msg("pixel %zu, %zu: %.3f, not %.3f", x, y, alpha_at(&p, k), along * across);
    }
    picture_free(&p);
}

static double distance(const float *points, size_t count, double x, double y) {
    double least = INFINITY;
    for (size_t i = 0; i + 1 < count; i++) {
        const double ax = (double)points[2 * i], ay = (double)points[2 * i + 1];
        const double dx = (double)points[2 * i + 2] - ax, dy = (double)points[2 * i + 3] - ay;
        const double t = fmin(fmax(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0), 1);
        least = fmin(least, hypot(x - ax - t * dx, y - ay - t * dy));
    }
    return least;
}

/* The definition: from half a pixel outside the edge inwards, over the blur and a pixel; on the other side of a band
 * from half a pixel inside it into the gap. */
static void test_blur(void **state) {
    fixture *s = *state;
    static const struct {
        float width, gap, blur;
        bool smooth;
    } sizes[] = {{9, 0, 1, false},    {9, 0, 4, false}, {6, 0, 11, false}, {4, 9, 2, false},
                 {3, 6, 7.5f, false}, {12, 0, 5, true}, {4, 9, 2, true}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int method = 0; method < 3; method++) {
            const float gap = sizes[i].gap, width = sizes[i].width, blur = sizes[i].blur;
            const float whole = gap > 0 ? gap + 2 * width : width;
            const drawing d = {.points = bent,
                               .count = BENT,
                               .stroke = {whole, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0},
                               .method = (camber_method)method,
                               .paint = {.width_px = width,
                                         .gap_px = gap,
                                         .blur_px = blur,
                                         .smooth_blur = sizes[i].smooth,
                                         .color = {1, 1, 1, 1}}};
            picture p = draw(s, &d);
            double sum = 0;
            for (size_t k = 0; k < SIDE * SIDE; k++) {
                const double r = distance(bent, BENT, (double)(k % SIDE) + 0.5, (double)(k / SIDE) + 0.5);
                double truth = (double)whole / 2 + 0.5 - r;
                if (gap > 0)
                    truth = fmin(truth, r - ((double)gap / 2 + 0.5 - ((double)blur + 1)));
                truth = fmin(fmax(truth / ((double)blur + 1), 0), 1);
                truth = sizes[i].smooth ? truth * truth * (3 - 2 * truth) : truth;
                const double error = fabs(alpha_at(&p, k) - truth);
                sum += error;
                /* Where segments meet one is drawn over the other, and their gaps bend. */
                if (error > 0.25)
                    fail_msg("blur %g, width %g, gap %g, method %d: %.3f, not %.3f at %zu, %zu", (double)blur,
                             (double)width, (double)gap, method, alpha_at(&p, k), truth, k % SIDE, k / SIDE);
            }
            assert_true(sum / (SIDE * SIDE) < 0.004);
            picture_free(&p);
        }
}

/* A mitred corner fades along both of its edges, a bevelled one along the cut as well. */
static void test_blur_corner(void **state) {
    fixture *s = *state;
    static const float corner[] = {10.5f, 70.5f, 70.5f, 70.5f, 70.5f, 10.5f};
    drawing d = {.points = corner,
                 .count = 3,
                 .stroke = {20, CAMBER_JOIN_MITER, CAMBER_CAP_BUTT, 4},
                 .paint = {.width_px = 20, .blur_px = 9, .color = {1, 1, 1, 1}}};
    picture miter = draw(s, &d);
    d.stroke.join = CAMBER_JOIN_BEVEL;
    picture bevel = draw(s, &d);
    for (size_t i = 70; i < 84; i++) {
        const double x = (double)i + 0.5 - 70.5, edge = 10 - x, cut = 10 * sqrt(0.5) - x * sqrt(2);
        assert_true(fabs(alpha_at(&miter, i * SIDE + i) - fmin(fmax((edge + 0.5) / 10, 0), 1)) < 0.06);
        assert_true(fabs(alpha_at(&bevel, i * SIDE + i) - fmin(fmax((fmin(edge, cut) + 0.5) / 10, 0), 1)) < 0.06);
    }
    picture_free(&bevel);
    picture_free(&miter);
}

/* A whole number of pixels moves the picture and changes nothing in it. */
static void test_translate(void **state) {
    fixture *s = *state;
    for (int kind = 0; kind < 4; kind++)
        for (int method = 0; method < 3; method++) {
            drawing d = {.points = bent,
                         .count = BENT,
                         .stroke = {11, kind % 2 ? CAMBER_JOIN_MITER : CAMBER_JOIN_ROUND, (camber_cap)(kind % 3), 0},
                         .method = (camber_method)method,
                         .paint = {.width_px = kind == 2 ? 3 : 11,
                                   .gap_px = kind == 2 ? 5 : 0,
                                   .color = {1, 1, 1, kind == 3 ? 0.5f : 1}}};
            picture still = draw(s, &d);
            d.paint.translate_x_px = -9;
            d.paint.translate_y_px = 6;
            picture moved = draw(s, &d);
            size_t drawn = 0;
            for (size_t y = 0; y + 6 < SIDE; y++)
                for (size_t x = 9; x < SIDE; x++) {
                    const double before = alpha_at(&still, y * SIDE + x);
                    drawn += before > 0;
                    assert_true(fabs(before - alpha_at(&moved, (y + 6) * SIDE + x - 9)) < 1.5 / 255);
                }
            assert_in_range(drawn, 500, 5000);
            picture_free(&moved);
            picture_free(&still);
        }
}

/* An opaque pass with an opacity is a translucent colour; rows of different alphas, which draw over each other, have it
 * all together. */
static void test_opacity(void **state) {
    fixture *s = *state;
    drawing d = {.points = bent,
                 .count = BENT,
                 .stroke = {11, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0},
                 .paint = {.width_px = 11, .color = {1, 0.5f, 0, 0.5f}}};
    picture translucent = draw(s, &d);
    d.paint.color.a = 1;
    d.opacity = 0.5f;
    picture grouped = draw(s, &d);
    assert_in_range(picture_compare(&translucent, &grouped).most, 0, 1);
    d.overlap = CAMBER_OVERLAP_ACCUMULATE;
    picture accumulated = draw(s, &d);
    assert_in_range(picture_compare(&translucent, &accumulated).most, 0, 40); /* gathered by another rule at joins */
    for (size_t k = 0; k < SIDE * SIDE; k++)
        assert_true(alpha_at(&accumulated, k) < 0.51);
    picture_free(&accumulated);
    picture_free(&grouped);
    picture_free(&translucent);
}

static void test_opacity_of_rows(void **state) {
    fixture *s = *state;
    static const float points[] = {10, 48, 86, 48, 48, 10, 48, 86};
    static const uint32_t offsets[] = {0, 2, 4}, rows[] = {0, 1};
    static const camber_stroke strokes[] = {{20, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                                            {20, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0}};
    static const camber_paint paints[] = {{.width_px = 20, .color = {1, 0, 0, 1}},
                                          {.width_px = 20, .color = {0, 0, 1, 0.5f}}};
    const camber_polylines_desc desc = {
        .points = points, .point_count = 4, .offsets = offsets, .polyline_count = 2, .rows = rows};
    camber_polylines *polylines = NULL;
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_polylines_create(s->context, &desc, &polylines), CAMBER_OK);
    for (int b = 0; b < CAMBER_FIXTURE_DRAWERS; b++) {
        if (!s->on.renderer[b])
            continue;
        assert_int_equal(camber_mesh_create(s->on.device, s->on.renderer[b], &mesh), CAMBER_OK);
        assert_int_equal(
            camber_mesh_tessellate(mesh, polylines, &(camber_tessellation_desc){.strokes = strokes, .stroke_count = 2}),
            CAMBER_OK);
        const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = 2, .opacity = 0.6f};
        const camber_frame frame = {
            .width = SIDE, .height = SIDE, .background = {1, 1, 1, 1}, .passes = &pass, .pass_count = 1};
        picture p = picture_draw(s->on.renderer[b], &frame);
        /* On white: red alone, half blue alone, half blue over red, all at six tenths. */
        const double seen[3][3] = {{1, 0.4, 0.4}, {0.7, 0.7, 1}, {0.7, 0.4, 0.7}};
        const uint32_t places[3][2] = {{20, 48}, {48, 20}, {48, 48}};
        for (int i = 0; i < 3; i++)
            for (int c = 0; c < 3; c++)
                assert_true(fabs(picture_value(&p, places[i][0], places[i][1], c) - seen[i][c]) < 2.5 / 255);
        picture_free(&p);
        camber_mesh_destroy(mesh);
    }
    camber_polylines_destroy(polylines);
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gap),
        cmocka_unit_test(test_gap_square),
        cmocka_unit_test(test_blur),
        cmocka_unit_test(test_blur_corner),
        cmocka_unit_test(test_translate),
        cmocka_unit_test(test_opacity),
        cmocka_unit_test(test_opacity_of_rows),
    };
    const int failed = cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
    return failed;
}
