/* Passes: coverage by hand, translucent lines flattened or not, paints, casing and fill, parts of a mesh. */
#include "pictures.h"

#include "draw/renderer.h"

enum { BENDS_PX = 512 };

static camber_mesh *make_mesh(fixture *s, const camber_made_scene *lines, const camber_stroke *strokes,
                              size_t stroke_count, camber_method method) {
    return fixture_mesh(s, fixture_any(s), lines, &(camber_tessellation_desc){strokes, stroke_count, method, 0, false});
}

static void line(camber_made_scene *s, size_t row, double x0, double y0, double x1, double y1) {
    camber_made_scene_point(s, x0, y0);
    camber_made_scene_point(s, x1, y1);
    camber_made_scene_end(s, row);
}

static picture draw(fixture *s, const camber_pass *passes, size_t pass_count) {
    return picture_draw(fixture_any(s),
                        &(camber_frame){.width = 64, .height = 64, .passes = passes, .pass_count = pass_count});
}

/* A picture of one pass over a mesh made for it; the strokes are as wide as the paints. */
static picture draw_lines(fixture *s, const camber_made_scene *lines, const camber_paint *paints, size_t count,
                          camber_overlap overlap) {
    camber_stroke strokes[8];
    for (size_t i = 0; i < count; i++)
        strokes[i] = (camber_stroke){paints[i].width_px, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    camber_mesh *mesh = make_mesh(s, lines, strokes, count, CAMBER_METHOD_STRIP);
    const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = count, .overlap = overlap};
    picture p = draw(s, &pass, 1);
    camber_mesh_destroy(mesh);
    return p;
}

static void assert_value(const picture *p, uint32_t x, uint32_t y, int channel, double wanted) {
    const double value = picture_value(p, x, y, channel);
    if (fabs(value - wanted) > 2.5 / 255)
        fail_msg("pixel %u, %u channel %d: %.3f, not %.3f", x, y, channel, value, wanted);
}

/* How much of [at, at + 1] lies in [from, to]. */
static double part(double at, double from, double to) {
    return fmax(fmin(at + 1, to) - fmax(at, from), 0);
}

/* A line along an axis with butt caps is a rectangle: its area in each pixel is known. */
static void test_rectangles(void **state) {
    fixture *s = *state;
    static const double widths[] = {0.3, 0.8, 1, 2.5, 4.5, 17};
    for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
        for (int vertical = 0; vertical < 2; vertical++) {
            for (int method = 0; method < 3; method++) {
                camber_made_scene lines = {0};
                const double from = 8.25, to = 50.5, middle = 20.25, half = widths[w] / 2;
                if (vertical)
                    line(&lines, 0, middle, from, middle, to);
                else
                    line(&lines, 0, from, middle, to, middle);
                const camber_stroke stroke = {(float)widths[w], CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
                const camber_paint paint = {.width_px = (float)widths[w], .color = {1, 0, 0.5f, 1}};
                camber_mesh *mesh = make_mesh(s, &lines, &stroke, 1, (camber_method)method);
                const camber_pass pass = {.mesh = mesh, .paints = &paint, .paint_count = 1};
                picture p = draw(s, &pass, 1);
                for (uint32_t y = 0; y < 64; y++) {
                    for (uint32_t x = 0; x < 64; x++) {
                        const double along = part(vertical ? y : x, from, to);
                        const double area = along * part(vertical ? x : y, middle - half, middle + half);
                        assert_value(&p, x, y, 3, area);
                        assert_value(&p, x, y, 0, area);
                        assert_value(&p, x, y, 1, 0);
                        assert_value(&p, x, y, 2, 0.5 * area);
                    }
                }
                picture_free(&p);
                camber_mesh_destroy(mesh);
                camber_made_scene_free(&lines);
            }
        }
    }
}

/* The linear ramp has the same area and the same inside; it differs along the edges. */
static void test_coverages(void **state) {
    fixture *s = *state;
    camber_made_scene lines = {0};
    line(&lines, 0, 10, 12, 52, 45);
    const double length = hypot(42, 33), width = 7;
    const camber_stroke stroke = {(float)width, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_paint paint = {.width_px = (float)width, .color = {1, 1, 1, 1}};
    camber_mesh *mesh = make_mesh(s, &lines, &stroke, 1, CAMBER_METHOD_STRIP);
    const camber_pass pass = {.mesh = mesh, .paints = &paint, .paint_count = 1};
    picture pictures[2];
    for (int coverage = 0; coverage < 2; coverage++) {
        pictures[coverage] = picture_draw(
            fixture_any(s),
            &(camber_frame){
                .width = 64, .height = 64, .passes = &pass, .pass_count = 1, .coverage = (camber_coverage)coverage});
        double area = 0;
        for (size_t i = 0; i < 64 * 64; i++)
            area += pictures[coverage].rgba[4 * i + 3] / 255.0;
        assert_true(fabs(area - length * width) < (coverage ? 0.01 : 0.003) * length * width);
        assert_value(&pictures[coverage], 31, 28, 3, 1);
    }
    const difference d = picture_compare(&pictures[0], &pictures[1]);
    assert_in_range(d.most, 4, 40);
    picture_free(&pictures[0]);
    picture_free(&pictures[1]);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
}

/* ---- Overlap ---- */

/* A loop that crosses itself about 32, 32 and two lines that cross about 32, 12; no edge on a pixel's border, so that
 * partly covered pixels cross as well. */
static camber_made_scene crossing_scene(void) {
    camber_made_scene s = {0};
    camber_made_scene_point(&s, 10, 32.3);
    camber_made_scene_point(&s, 54.3, 32.3);
    camber_made_scene_point(&s, 54.3, 54.3);
    camber_made_scene_point(&s, 32.4, 54.3);
    camber_made_scene_point(&s, 32.4, 22);
    camber_made_scene_end(&s, 0);
    line(&s, 0, 10, 12.3, 54, 12.3);
    line(&s, 0, 32.4, 4, 32.4, 19);
    return s;
}

static void test_flatten_is_even(void **state) {
    fixture *s = *state;
    camber_made_scene lines = crossing_scene();
    const camber_paint paint = {.width_px = 8, .color = {1, 0.5f, 0, 0.4f}};
    picture opaque =
        draw_lines(s, &lines, &(camber_paint){.width_px = 8, .color = {1, 0.5f, 0, 1}}, 1, CAMBER_OVERLAP_FLATTEN);
    picture p = draw_lines(s, &lines, &paint, 1, CAMBER_OVERLAP_FLATTEN);
    for (uint32_t y = 0; y < 64; y++) { /* everywhere the opaque picture times the alpha, once */
        for (uint32_t x = 0; x < 64; x++)
            for (int c = 0; c < 4; c++)
                assert_value(&p, x, y, c, 0.4 * picture_value(&opaque, x, y, c));
    }
    assert_value(&p, 32, 32, 3, 0.4);
    assert_value(&p, 32, 12, 3, 0.4);
    assert_value(&p, 53, 53, 3, 0.4); /* in a corner */
    picture_free(&p);

    p = draw_lines(s, &lines, &paint, 1, CAMBER_OVERLAP_ACCUMULATE);
    const double twice = 1 - 0.6 * 0.6;
    assert_value(&p, 20, 32, 3, 0.4);
    assert_value(&p, 32, 32, 3, twice);
    assert_value(&p, 32, 12, 3, twice);
    assert_value(&p, 32, 12, 0, twice);
    assert_value(&p, 32, 12, 1, 0.5 * twice);
    picture_free(&p);
    picture_free(&opaque);
    camber_made_scene_free(&lines);
}

/* Equal alphas and two colours: one run, the later line hides the earlier where they cross. */
/* Two strokes side by side, their common edge in the middle of a pixel: together they leave nothing of it, one over the
 * other a quarter. A third one over the second adds nothing to its edge. */
static void test_united_edges(void **state) {
    fixture *s = *state;
    const camber_surface *surface = fixture_any(s)->share.surface;
    if (surface && !surface->half_float_targets)
        skip();
    camber_made_scene lines = {0};
    line(&lines, 0, 4, 20.5, 60, 20.5); /* 15.5 to 25.5 */
    line(&lines, 0, 4, 30.5, 60, 30.5); /* 25.5 to 35.5 */
    line(&lines, 0, 10, 30.5, 50, 30.5);
    for (int i = 0; i < 3; i++) {
        static const camber_overlap overlaps[] = {CAMBER_OVERLAP_UNITE, CAMBER_OVERLAP_FLATTEN, CAMBER_OVERLAP_FLATTEN};
        const float alpha = i == 1 ? 0.5f : 1.0f; /* opaque, FLATTEN draws line over line */
        picture p = draw_lines(s, &lines, &(camber_paint){.width_px = 10, .color = {1, 1, 1, alpha}}, 1, overlaps[i]);
        assert_value(&p, 55, 25, 3, i == 2 ? 0.75 : (double)alpha);
        assert_value(&p, 30, 35, 3, i == 2 ? 0.75 : 0.5 * (double)alpha);
        assert_value(&p, 55, 35, 3, 0.5 * (double)alpha);
        assert_value(&p, 30, 20, 3, (double)alpha);
        picture_free(&p);
    }
    camber_made_scene_free(&lines);
}

/* Where the driver has no such targets, one over the other. */
static void test_without_half_floats(void **state) {
    fixture *s = *state;
    camber_surface *surface = fixture_any(s)->share.surface;
    if (!surface)
        skip();
    const bool had = surface->half_float_targets;
    camber_made_scene lines = {0};
    line(&lines, 0, 4, 20.5, 60, 20.5);
    line(&lines, 0, 4, 30.5, 60, 30.5);
    camber_renderer *renderer = NULL, *old = fixture_any(s);
    surface->half_float_targets = false;
    assert_int_equal(camber_renderer_create(s->on.device, surface,
                                            &(camber_renderer_desc){.rasterizer = CAMBER_RASTERIZER_GL}, &renderer),
                     CAMBER_OK);
    const int which = s->on.renderer[0] ? 0 : 1;
    s->on.renderer[which] = renderer;
    picture p =
        draw_lines(s, &lines, &(camber_paint){.width_px = 10, .color = {1, 1, 1, 0.5f}}, 1, CAMBER_OVERLAP_FLATTEN);
    assert_value(&p, 30, 25, 3, 0.375);
    assert_value(&p, 30, 20, 3, 0.5);
    picture_free(&p);
    s->on.renderer[which] = old;
    surface->half_float_targets = had;
    camber_renderer_destroy(renderer);
    camber_made_scene_free(&lines);
}

static void test_colors_of_one_run(void **state) {
    fixture *s = *state;
    camber_made_scene lines = {0};
    line(&lines, 0, 4, 32, 60, 32);
    line(&lines, 1, 32, 4, 32, 60);
    const camber_paint paints[] = {{.width_px = 8, .color = {1, 0, 0, 0.5f}},
                                   {.width_px = 8, .color = {0, 0, 1, 0.5f}}};
    picture p = draw_lines(s, &lines, paints, 2, CAMBER_OVERLAP_FLATTEN);
    const double left[] = {0.5, 0, 0, 0.5}, below[] = {0, 0, 0.5, 0.5};
    for (int c = 0; c < 4; c++) {
        assert_value(&p, 16, 32, c, left[c]);
        assert_value(&p, 32, 50, c, below[c]);
        assert_value(&p, 32, 32, c, below[c]);
    }
    picture_free(&p);
    p = draw_lines(s, &lines, paints, 2, CAMBER_OVERLAP_ACCUMULATE);
    const double crossing[] = {0.25, 0, 0.5, 0.75};
    for (int c = 0; c < 4; c++)
        assert_value(&p, 32, 32, c, crossing[c]);
    picture_free(&p);
    camber_made_scene_free(&lines);
}

/* Different alphas in one pass: each run over what came before, in the order of the polylines. */
static void test_alphas_keep_order(void **state) {
    fixture *s = *state;
    camber_made_scene lines = {0};
    line(&lines, 0, 4, 16, 60, 16); /* red, half */
    line(&lines, 1, 4, 48, 60, 48); /* green, opaque */
    line(&lines, 2, 16, 4, 16, 60); /* blue, a quarter: over both */
    line(&lines, 0, 48, 4, 48, 60); /* red, half again, a run of its own: over green */
    const camber_paint paints[] = {{.width_px = 8, .color = {1, 0, 0, 0.5f}},
                                   {.width_px = 8, .color = {0, 1, 0, 1}},
                                   {.width_px = 8, .color = {0, 0, 1, 0.25f}}};
    picture p = draw_lines(s, &lines, paints, 3, CAMBER_OVERLAP_FLATTEN);
    const struct {
        uint32_t x, y;
        double wanted[4];
    } places[] = {
        {32, 16, {0.5, 0, 0, 0.5}},        {32, 48, {0, 1, 0, 1}},       {16, 32, {0, 0, 0.25, 0.25}},
        {16, 16, {0.375, 0, 0.25, 0.625}}, {16, 48, {0, 0.75, 0.25, 1}}, {48, 48, {0.5, 0.5, 0, 1}},
        {48, 16, {0.75, 0, 0, 0.75}},      {48, 32, {0.5, 0, 0, 0.5}},
    };
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        for (int c = 0; c < 4; c++)
            assert_value(&p, places[i].x, places[i].y, c, places[i].wanted[c]);
    picture_free(&p);
    camber_made_scene_free(&lines);
}

enum { STRIPES = 63 };

/* Stripes of the alphas that their rows have, in turn, and a line of the first row down over all of them; the calls
 * that they take. */
static size_t draw_stripes(fixture *s, const camber_paint *paints, size_t rows, picture *p) {
    camber_stroke strokes[STRIPES];
    camber_made_scene lines = {0};
    for (size_t i = 0; i < rows; i++)
        strokes[i] = (camber_stroke){.width_px = 1};
    for (size_t i = 0; i < STRIPES; i++)
        line(&lines, i % rows, 0, 0.5 + (double)i, 64, 0.5 + (double)i);
    line(&lines, 0, 40.5, 0, 40.5, 64);
    camber_mesh *mesh = make_mesh(s, &lines, strokes, rows, CAMBER_METHOD_STRIP);
    const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = rows};
    const camber_frame frame = {.width = 64, .height = 64, .passes = &pass, .pass_count = 1};
    camber_frame_stats stats;
    *p = draw(s, &pass, 1);
    assert_int_equal(camber_renderer_render(fixture_any(s), &frame, NULL, NULL, &stats), CAMBER_OK);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
    return stats.draw_calls;
}

/* Alphas that change with every line take a layer each, not one a line; the faintest lies lowest. */
static void test_alphas_in_turn(void **state) {
    fixture *s = *state;
    static const camber_paint paints[] = {{.width_px = 1, .color = {1, 0, 0, 0.25f}},
                                          {.width_px = 1, .color = {0, 1, 0, 1}},
                                          {.width_px = 1, .color = {0, 0, 1, 0.5f}}};
    picture p;
    const size_t calls = draw_stripes(s, paints, 3, &p);
    assert_true(draws_in_cl() ? calls == 0 : calls >= 3 && calls <= 5);
    for (uint32_t i = 0; i < STRIPES; i++) {
        const camber_color c = paints[i % 3].color;
        const float wanted[4] = {c.r * c.a, c.g * c.a, c.b * c.a, c.a};
        for (int k = 0; k < 4; k++) {
            assert_value(&p, 20, i, k, (double)wanted[k]);
            /* The line down is of one layer with its like, and lies below the others. */
            const double below = i % 3 == 0 ? 0.0 : 0.25 * (1.0 - (double)c.a);
            assert_value(&p, 40, i, k, (double)wanted[k] + (k == 0 || k == 3 ? below : 0.0));
        }
    }
    picture_free(&p);
}

/* Past a number of alphas one layer has them all, and the line that is drawn last hides what lies below it there. */
static void test_many_alphas(void **state) {
    fixture *s = *state;
    camber_paint paints[STRIPES];
    for (size_t i = 0; i < STRIPES; i++)
        paints[i] = (camber_paint){.width_px = 1, .color = {1, 1, 1, (float)(i + 1) / (STRIPES + 1)}};
    picture p;
    const size_t calls = draw_stripes(s, paints, STRIPES, &p);
    assert_true(draws_in_cl() ? calls == 0 : calls >= 1 && calls <= 2);
    for (uint32_t i = 0; i < STRIPES; i++) {
        assert_value(&p, 20, i, 3, (double)paints[i].color.a);
        assert_value(&p, 40, i, 3, (double)paints[0].color.a);
    }
    picture_free(&p);
}

/* ---- Paints ---- */

static void test_paints_that_draw_nothing(void **state) {
    fixture *s = *state;
    camber_made_scene lines = crossing_scene();
    const camber_stroke strokes[] = {{8, CAMBER_JOIN_ROUND, CAMBER_CAP_SQUARE, 0}};
    camber_mesh *mesh = make_mesh(s, &lines, strokes, 1, CAMBER_METHOD_STRIP);
    const camber_paint nothing[] = {{.width_px = 0, .color = {1, 1, 1, 1}}, {.width_px = 8, .color = {1, 1, 1, 0}}};
    camber_pass passes[4];
    for (int i = 0; i < 4; i++)
        passes[i] = (camber_pass){.mesh = mesh,
                                  .paints = i < 2 ? nothing + i : nothing,
                                  .paint_count = i < 2, /* then no paint for row 0 */
                                  .overlap = i % 2 ? CAMBER_OVERLAP_FLATTEN : CAMBER_OVERLAP_ACCUMULATE};
    picture p = draw(s, passes, 4);
    for (size_t i = 0; i < 4 * 64 * 64; i++)
        assert_int_equal(p.rgba[i], 0);
    picture_free(&p);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
}

/* A row past the paints between rows that are drawn: not drawn, whatever another picture drew it with. */
static void test_row_past_the_paints(void **state) {
    fixture *s = *state;
    camber_made_scene lines = {0};
    for (size_t i = 0; i < 3; i++)
        line(&lines, i % 2, 4, 10 + 20 * (double)i, 60, 10 + 20 * (double)i);
    const camber_stroke strokes[] = {{8, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                                     {8, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0}};
    const camber_paint paints[] = {{.width_px = 8, .color = {1, 0, 0, 1}}, {.width_px = 8, .color = {0, 1, 0, 1}}};
    camber_mesh *mesh = make_mesh(s, &lines, strokes, 2, CAMBER_METHOD_STRIP);
    for (size_t count = 2; count >= 1; count--) {
        const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = count};
        picture p = draw(s, &pass, 1);
        assert_value(&p, 32, 10, 0, 1);
        assert_value(&p, 32, 30, 1, count == 2);
        assert_value(&p, 32, 30, 3, count == 2);
        assert_value(&p, 32, 50, 0, 1);
        picture_free(&p);
    }
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
}

/* Rows that a pass leaves out do not end a run, and their lines stay away. */
static void test_some_rows(void **state) {
    fixture *s = *state;
    camber_made_scene lines = {0};
    line(&lines, 0, 4, 16, 60, 16);
    line(&lines, 1, 4, 32, 60, 32);
    line(&lines, 0, 4, 48, 60, 48);
    const camber_stroke strokes[] = {{6, 0, 0, 0}, {6, 0, 0, 0}};
    camber_mesh *mesh = make_mesh(s, &lines, strokes, 2, CAMBER_METHOD_STRIP);
    const camber_paint paints[] = {{.width_px = 6, .color = {1, 1, 1, 0.5f}}, {.width_px = 0, .color = {1, 1, 1, 1}}};
    const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = 2};
    const camber_frame frame = {.width = 64, .height = 64, .passes = &pass, .pass_count = 1};
    picture p = picture_draw(fixture_any(s), &frame);
    camber_frame_stats stats;
    assert_int_equal(camber_renderer_render(fixture_any(s), &frame, NULL, NULL, &stats), CAMBER_OK);
    assert_int_equal(stats.draw_calls, draws_in_cl() ? 0 : 2); /* the run and its flattening */
    assert_value(&p, 32, 16, 3, 0.5);
    assert_value(&p, 32, 32, 3, 0);
    assert_value(&p, 32, 48, 3, 0.5);
    picture_free(&p);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
}

/* More rows than a row of the texture of rows holds: 1024. */
static void test_thousands_of_rows(void **state) {
    fixture *s = *state;
    enum { ROWS = 5000 };
    camber_stroke *strokes = calloc(ROWS, sizeof *strokes);
    camber_paint *paints = calloc(ROWS, sizeof *paints);
    assert_true(strokes && paints);
    static const size_t rows[] = {0, 1, 1023, 1024, 1025, 2047, 2048, 4999};
    camber_made_scene lines = {0};
    for (size_t i = 0; i < ROWS; i++) {
        strokes[i].width_px = 4;
        paints[i] = (camber_paint){.width_px = 4, .color = {0, 1, 0, 1}};
    }
    for (size_t i = 0; i < 8; i++) {
        line(&lines, rows[i], 4, 4 + 8 * (double)i, 60, 4 + 8 * (double)i);
        paints[rows[i]] = (camber_paint){.width_px = 4, .color = {(float)i / 7, 0, 1, 1}};
    }
    camber_mesh *mesh = make_mesh(s, &lines, strokes, ROWS, CAMBER_METHOD_STRIP);
    const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = ROWS};
    picture p = draw(s, &pass, 1);
    for (uint32_t i = 0; i < 8; i++) {
        assert_value(&p, 30, 4 + 8 * i, 0, i / 7.0);
        assert_value(&p, 30, 4 + 8 * i, 1, 0);
        assert_value(&p, 30, 4 + 8 * i, 2, 1);
    }
    picture_free(&p);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
    free(paints);
    free(strokes);
}

/* A mesh that is wide enough for the casing draws the fill as one made for the fill does: to 1/255 where joins have
 * room. */
static void test_casing_and_fill(void **state) {
    fixture *s = *state;
    for (int method = 0; method < 2; method++) {
        for (int sharp = 0; sharp < 3; sharp++) {
            camber_made_scene lines = {0};
            camber_made_scene_point(&lines, 6, 50);
            camber_made_scene_point(&lines, 30, 12);
            camber_made_scene_point(&lines, 56, 40);
            camber_made_scene_end(&lines, 0);
            const camber_stroke wide = {12, (camber_join)sharp, (camber_cap)sharp, 0},
                                narrow = {5, wide.join, wide.cap, 0};
            camber_mesh *both = make_mesh(s, &lines, &wide, 1, (camber_method)method);
            camber_mesh *fill = make_mesh(s, &lines, &narrow, 1, (camber_method)method);
            const camber_paint casing_paint = {.width_px = 12, .color = {0, 0, 0, 1}},
                               fill_paint = {.width_px = 5, .color = {1, 1, 1, 1}};
            const camber_pass passes[] = {{.mesh = both, .paints = &casing_paint, .paint_count = 1},
                                          {.mesh = both, .paints = &fill_paint, .paint_count = 1},
                                          {.mesh = fill, .paints = &fill_paint, .paint_count = 1}};
            picture from_both = draw(s, passes + 1, 1), from_fill = draw(s, passes + 2, 1), cased = draw(s, passes, 2);
            const difference d = picture_compare(&from_both, &from_fill);
            assert_in_range(d.most, 0, 1);
            assert_true(d.drawn > 300);
            /* Across the line from 30, 12 to 6, 50: white inside, black to 6 px, nothing past it. */
            const double length = hypot(24, 38), nx = 38 / length, ny = 24 / length;
            for (int off = -9; off <= 9; off++) {
                const uint32_t x = (uint32_t)(18 + off * nx), y = (uint32_t)(31 + off * ny);
                const double away = fabs((x + 0.5 - 18) * nx + (y + 0.5 - 31) * ny);
                if (away < 1.7 || (away > 3.3 && away < 5.2) || away > 6.8) {
                    assert_value(&cased, x, y, 0, away < 1.7 ? 1 : 0);
                    assert_value(&cased, x, y, 3, away < 5.2 ? 1 : 0);
                }
            }
            picture_free(&cased);
            picture_free(&from_fill);
            picture_free(&from_both);
            camber_mesh_destroy(fill);
            camber_mesh_destroy(both);
            camber_made_scene_free(&lines);
        }
    }
}

static picture draw_fill_of(fixture *s, const camber_made_scene *lines, float mesh_px, float fill_px) {
    const camber_stroke stroke = {mesh_px, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    const camber_paint paint = {.width_px = fill_px, .color = {1, 1, 1, 1}};
    camber_mesh *mesh = make_mesh(s, lines, &stroke, 1, CAMBER_METHOD_STRIP);
    const camber_pass pass = {.mesh = mesh, .paints = &paint, .paint_count = 1};
    picture p = picture_draw(fixture_any(s),
                             &(camber_frame){.width = BENDS_PX, .height = BENDS_PX, .passes = &pass, .pass_count = 1});
    camber_mesh_destroy(mesh);
    return p;
}

/* The same of lines whose bends are closer together than they are wide: what makes room for the widest stroke leaves no
 * holes in a narrower one, but for a pixel that lies on the line where a join parts two segments. */
static void test_fill_of_bends(void **state) {
    fixture *s = *state;
    static const float fills_px[] = {1, 1.8f, 3, 6}, ratios[] = {1.2f, 1.33f, 2, 4};
    for (size_t k = 0; k < 16; k++) {
        const float fill_px = fills_px[k / 4], mesh_px = ratios[k % 4] * fill_px;
        uint64_t seed = 11 + k;
        camber_made_scene lines = {0};
        for (int i = 0; i < 150; i++) {
            camber_made_scene_walk(&lines, &seed, 8, (const double[]){0.3, 3}, 1.2);
            camber_made_scene_end(&lines, 0);
        }
        for (size_t i = 0; i < 2 * lines.point_count; i++)
            lines.points[i] *= BENDS_PX / 1000.0f;
        picture from_both = draw_fill_of(s, &lines, mesh_px, fill_px),
                from_fill = draw_fill_of(s, &lines, fill_px, fill_px);
        const difference d = picture_compare(&from_both, &from_fill);
        if (d.past_8 > 1)
            fail_msg("%g px within %g px: %zu pixels differ by up to %d", (double)fill_px, (double)mesh_px, d.past_8,
                     d.most);
        assert_true(d.drawn > 500);
        picture_free(&from_fill);
        picture_free(&from_both);
        camber_made_scene_free(&lines);
    }
}

/* ---- Parts of a mesh ---- */

static void test_polyline_range(void **state) {
    fixture *s = *state;
    camber_made_scene lines = {0};
    for (int i = 0; i < 8; i++) {
        if (i % 3 == 1)
            camber_made_scene_end(&lines, 0); /* empty ones count as well */
        line(&lines, 0, 4, 4 + 8 * i, 60, 4 + 8 * i);
    }
    const camber_stroke stroke = {4, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    const camber_paint paint = {.width_px = 4, .color = {1, 1, 1, 1}};
    for (int method = 0; method < 3; method++) {
        camber_mesh *mesh = make_mesh(s, &lines, &stroke, 1, (camber_method)method);
        for (size_t first = 0; first <= lines.polyline_count + 1; first++) {
            for (size_t count = 0; count <= lines.polyline_count + 2; count += 3) {
                const camber_pass pass = {
                    .mesh = mesh, .first_polyline = first, .polyline_count = count, .paints = &paint, .paint_count = 1};
                const size_t end = count ? first + count : lines.polyline_count;
                picture p = draw(s, &pass, 1);
                for (size_t i = 0; i < lines.polyline_count; i++) {
                    if (lines.offsets[i] == lines.offsets[i + 1])
                        continue;
                    const uint32_t y = (uint32_t)lines.points[2 * lines.offsets[i] + 1];
                    assert_value(&p, 30, y, 3, i >= first && i < end ? 1 : 0);
                }
                picture_free(&p);
            }
        }
        camber_mesh_destroy(mesh);
    }
    camber_made_scene_free(&lines);
}

/* Re-tessellating a mesh that has been drawn: smaller, larger, with other joins. */
static void test_mesh_changes(void **state) {
    fixture *s = *state;
    const camber_paint paint = {.width_px = 6, .color = {1, 1, 1, 1}};
    camber_made_scene large = {0};
    uint64_t seed = 3;
    for (int i = 0; i < 200; i++) {
        camber_made_scene_walk(&large, &seed, 30, (const double[]){1, 10}, 1);
        camber_made_scene_end(&large, 0);
    }
    camber_made_scene small = crossing_scene();
    const camber_made_scene *scenes[] = {&small, &large, &small, &large};
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_mesh_create(s->on.device, fixture_any(s), &mesh), CAMBER_OK);
    for (int i = 0; i < 4; i++) {
        const camber_stroke stroke = {6, (camber_join)(i % 3), (camber_cap)(2 - i % 3), 0};
        const camber_tessellation_desc desc = {&stroke, 1, (camber_method)(i % 3), 0, false};
        camber_polylines *polylines = scene_polylines(s->context, scenes[i]);
        assert_int_equal(camber_mesh_tessellate(mesh, polylines, &desc), CAMBER_OK);
        camber_mesh *fresh = make_mesh(s, scenes[i], &stroke, 1, desc.method);
        const camber_pass a = {.mesh = mesh, .paints = &paint, .paint_count = 1};
        const camber_pass b = {.mesh = fresh, .paints = &paint, .paint_count = 1};
        picture p = draw(s, &a, 1), wanted = draw(s, &b, 1);
        picture_assert_same(&p, &wanted);
        picture_free(&wanted);
        picture_free(&p);
        camber_mesh_destroy(fresh);
        camber_polylines_destroy(polylines);
    }
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&small);
    camber_made_scene_free(&large);
}

/* Opaque passes of one mesh are one draw call, as many as passes where the driver has no multi-draw or the mesh is
 * indexed, and what is drawn is what meshes of their own, each drawn by itself, give. */
static void test_passes_of_one_mesh(void **state) {
    fixture *s = *state;
    enum { PASSES = 6, ROWS = 3 };
    camber_made_scene lines = {0};
    for (size_t i = 0; i < 12; i++)
        line(&lines, i % ROWS, 3 + 5 * (double)i, 4, 60 - 4 * (double)i, 60);
    const camber_stroke strokes[ROWS] = {{9, 0, 0, 0}, {9, 0, 1, 0}, {9, 1, 0, 0}};
    camber_paint paints[PASSES][ROWS];
    for (int p = 0; p < PASSES; p++)
        for (int r = 0; r < ROWS; r++)
            paints[p][r] =
                (camber_paint){.width_px = (float)(9 - p - r % 2), .color = {(float)p / PASSES, (float)r / ROWS, 1, 1}};
    for (int method = 0; method < 3; method++) {
        camber_mesh *meshes[PASSES], *shared = make_mesh(s, &lines, strokes, ROWS, (camber_method)method);
        camber_pass together[PASSES], apart[PASSES];
        for (size_t p = 0; p < PASSES; p++) {
            meshes[p] = make_mesh(s, &lines, strokes, ROWS, (camber_method)method);
            together[p] = (camber_pass){.mesh = shared,
                                        .first_polyline = p,
                                        .polyline_count = 12 - 2 * p,
                                        .paints = paints[p],
                                        .paint_count = ROWS};
            apart[p] = together[p];
            apart[p].mesh = meshes[p];
        }
        picture one = draw(s, together, PASSES), many = draw(s, apart, PASSES);
        assert_memory_equal(one.rgba, many.rgba, (size_t)4 * 64 * 64);
        const camber_frame frame = {.width = 64, .height = 64, .passes = together, .pass_count = PASSES};
        camber_surface *surface = fixture_any(s)->share.surface;
        camber_gl_multi_draw_arrays_fn *multi = surface ? surface->gl.MultiDrawArrays : NULL;
        camber_frame_stats stats;
        assert_int_equal(camber_renderer_render(fixture_any(s), &frame, NULL, NULL, &stats), CAMBER_OK);
        assert_int_equal(stats.draw_calls, !surface ? 0 : multi && method == 0 ? 1 : PASSES);
        if (surface) {
            surface->gl.MultiDrawArrays = NULL;
            picture looped = draw(s, together, PASSES);
            surface->gl.MultiDrawArrays = multi;
            assert_memory_equal(one.rgba, looped.rgba, (size_t)4 * 64 * 64);
            picture_free(&looped);
        }
        picture_free(&many);
        picture_free(&one);
        for (size_t p = 0; p < PASSES; p++)
            camber_mesh_destroy(meshes[p]);
        camber_mesh_destroy(shared);
    }
    camber_made_scene_free(&lines);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rectangles),          cmocka_unit_test(test_coverages),
        cmocka_unit_test(test_united_edges),        cmocka_unit_test(test_without_half_floats),
        cmocka_unit_test(test_flatten_is_even),     cmocka_unit_test(test_colors_of_one_run),
        cmocka_unit_test(test_alphas_keep_order),   cmocka_unit_test(test_alphas_in_turn),
        cmocka_unit_test(test_many_alphas),         cmocka_unit_test(test_paints_that_draw_nothing),
        cmocka_unit_test(test_some_rows),           cmocka_unit_test(test_thousands_of_rows),
        cmocka_unit_test(test_casing_and_fill),     cmocka_unit_test(test_fill_of_bends),
        cmocka_unit_test(test_polyline_range),      cmocka_unit_test(test_mesh_changes),
        cmocka_unit_test(test_row_past_the_paints), cmocka_unit_test(test_passes_of_one_mesh),
    };
    return FIXTURE_RUN(tests);
}
