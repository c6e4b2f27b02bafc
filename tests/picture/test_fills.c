/* Fills of one colour among lines: what they hide and what shines through, drawn by GL and by OpenCL. */
#include "pictures.h"

enum { SIDE_PX = 300, PASSES_MAX = 7, COLORS = 3 };

typedef struct drawing {
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    camber_paint paints[COLORS][CAMBER_KERNEL_ROWS];
    camber_pass passes[PASSES_MAX];
    camber_frame frame;
    camber_made_scene lines;
    camber_method method;
} drawing;

static void begin_drawing(drawing *d) {
    *d = (drawing){.frame = {.width = SIDE_PX, .height = SIDE_PX - 11, .background = {0.8f, 0.6f, 1, 1}}};
    scene_strokes(d->strokes);
    for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++)
        d->strokes[i].width_px = fminf(d->strokes[i].width_px, 12);
    for (size_t k = 0; k < COLORS; k++)
        for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++)
            d->paints[k][i] = (camber_paint){.width_px = (1.0f - 0.3f * (float)k) * d->strokes[i].width_px,
                                             .color = {k == 0, k == 1, 0.2f * (float)(i % 6), k == 2 ? 0.5f : 1}};
    d->frame.passes = d->passes;
    uint64_t seed = 9;
    camber_scene_add_walks(&d->lines, &seed);
}

static void put_lines(drawing *d, size_t paints) {
    d->passes[d->frame.pass_count++] =
        (camber_pass){.paints = d->paints[paints], .paint_count = CAMBER_KERNEL_ROWS, .first_polyline = 3 * paints};
}

static void put_fill(drawing *d, camber_color color, float opacity) {
    d->passes[d->frame.pass_count++] =
        (camber_pass){.kind = CAMBER_PASS_FILL, .fill = {.color = color}, .opacity = opacity};
}

static picture draw(const fixture *s, camber_renderer *renderer, drawing *d, uint32_t piece_px) {
    const camber_tessellation_desc desc = {
        .strokes = d->strokes, .stroke_count = CAMBER_KERNEL_ROWS, .method = d->method};
    camber_mesh *mesh = fixture_mesh(s, renderer, &d->lines, &desc);
    for (size_t i = 0; i < d->frame.pass_count; i++)
        d->passes[i].mesh = d->passes[i].paints ? mesh : NULL;
    d->frame.largest_area_px = piece_px;
    picture p = picture_draw(renderer, &d->frame);
    camber_mesh_destroy(mesh);
    return p;
}

/* Fills below all lines, between them and above them, by themselves translucent and by their opacity. */
static void make_veils(drawing *d) {
    begin_drawing(d);
    put_fill(d, (camber_color){0, 0.3f, 0.2f, 0.25f}, 0);
    put_lines(d, 0);
    put_fill(d, (camber_color){1, 1, 1, 0.5f}, 0);
    put_lines(d, 1);
    put_fill(d, (camber_color){0, 0, 0.5f, 1}, 0.3f);
    put_lines(d, 2);
    put_fill(d, (camber_color){1, 0, 0, 0.75f}, 0.2f);
    d->passes[3].opacity = 0.7f; /* a group between two fills */
}

/* Nothing is left of what an opaque fill hides, and what comes after it lies on its colour. */
static void test_hidden(void **state) {
    const fixture *s = *state;
    static const camber_color green = {0, 0.8f, 0, 1};
    drawing all, rest, bare;
    begin_drawing(&all);
    put_lines(&all, 0);
    put_fill(&all, (camber_color){1, 1, 0, 0.5f}, 0);
    put_lines(&all, 1);
    put_fill(&all, green, 0);
    put_lines(&all, 2);
    begin_drawing(&rest);
    rest.frame.background = green;
    put_lines(&rest, 2);
    begin_drawing(&bare);
    put_lines(&bare, 0);
    put_fill(&bare, green, 1);
    picture p = draw(s, fixture_any(s), &all, 0), q = draw(s, fixture_any(s), &rest, 0);
    picture_assert_same(&p, &q);
    picture_free(&q);
    q = draw(s, fixture_any(s), &bare, 0);
    for (size_t i = 0; i < (size_t)q.width * q.height; i++)
        assert_memory_equal(q.rgba + 4 * i, "\x00\xcc\x00\xff", 4);
    assert_true(picture_compare(&p, &q).past_8 > 1000);
    picture_free(&q);
    picture_free(&p);
    camber_made_scene_free(&all.lines);
    camber_made_scene_free(&rest.lines);
    camber_made_scene_free(&bare.lines);
}

/* A fill that does not show changes nothing, and each fill by itself does. */
static void test_order(void **state) {
    const fixture *s = *state;
    drawing d;
    make_veils(&d);
    picture whole = draw(s, fixture_any(s), &d, 0);
    for (size_t i = 0; i < PASSES_MAX; i++) {
        if (d.passes[i].paints)
            continue;
        const camber_pass kept = d.passes[i];
        d.passes[i].fill.color.a = 0;
        picture p = draw(s, fixture_any(s), &d, 0);
        assert_true(picture_compare(&whole, &p).mean > 2);
        d.passes[i] = kept;
        picture_free(&p);
    }
    d.frame.pass_count--;
    d.passes[0].fill.color.a = 0; /* not of the others' alpha, but of none */
    picture p = draw(s, fixture_any(s), &d, 0);
    d.passes[0] = (camber_pass){.kind = CAMBER_PASS_FILL};
    picture q = draw(s, fixture_any(s), &d, 0);
    picture_assert_same(&p, &q);
    picture_free(&q);
    picture_free(&p);
    picture_free(&whole);
    camber_made_scene_free(&d.lines);
}

static void test_pieces(void **state) {
    const fixture *s = *state;
    static const uint32_t sides[] = {33, 64, 299};
    drawing d;
    make_veils(&d);
    picture whole = draw(s, fixture_any(s), &d, 0);
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        picture p = draw(s, fixture_any(s), &d, sides[i]);
        if (draws_in_cl())
            picture_assert_same(&whole, &p);
        assert_in_range(picture_compare(&whole, &p).most, 0, 2);
        picture_free(&p);
    }
    picture_free(&whole);
    camber_made_scene_free(&d.lines);
}

static void compare_with_gl(const fixture *s, camber_renderer *cl, drawing *d, double bound) {
    picture p = draw(s, fixture_any(s), d, 0), q = draw(s, cl, d, 0);
    const difference apart = picture_compare(&p, &q);
    /* The bodies of a fan's segments overlap on the inner side of joins. */
    const size_t past_8_max = d->method == CAMBER_METHOD_FAN ? apart.drawn / 100 : apart.drawn / 1000;
    printf("# %.4f of 255 on average, %d at most, %zu pixels past 8\n", apart.mean, apart.most, apart.past_8);
    assert_true(apart.mean < bound && apart.past_8 <= past_8_max);
    picture_free(&q);
    picture_free(&p);
}

/* GL rounds to 8 bits at each line, each fill and each group, and a fill rounds the whole picture: with four of them
 * most pixels are a level off in one channel, and on a GPU some are with one fill. Single pixels on the bisectors of
 * sharp joins belong to another segment: test_rasterize.c. */
static void test_gl(void **state) {
    const fixture *s = *state;
    camber_renderer *cl = NULL;
    if (draws_in_cl())
        skip(); /* nothing to compare with */
    const double of_one = fixture_has_gpu(s) ? 0.4 : 0.2, of_all = 0.4;
    assert_int_equal(camber_renderer_create(s->on.device, NULL, NULL, &cl), CAMBER_OK);
    for (size_t only = 0; only <= PASSES_MAX; only++) {
        drawing d;
        make_veils(&d);
        for (size_t i = 0; i < PASSES_MAX && only < PASSES_MAX; i++)
            d.passes[i].fill.color.a *= i == only;
        compare_with_gl(s, cl, &d, only < PASSES_MAX ? of_one : of_all);
        d.frame.pitch_deg = 70; /* a colour is in the sky, too */
        compare_with_gl(s, cl, &d, only < PASSES_MAX ? of_one : of_all);
        camber_made_scene_free(&d.lines);
    }
    camber_renderer_destroy(cl);
}

/* Kernels that fill areas read the same points as GL's vertex buffers were made of, whatever the method. */
static void test_areas_of_methods(void **state) {
    const fixture *s = *state;
    static const camber_fill fill = {.color = {0, 0.5f, 0, 0.5f}};
    camber_renderer *cl = NULL;
    if (draws_in_cl())
        skip(); /* it has points alone */
    assert_int_equal(camber_renderer_create(s->on.device, NULL, NULL, &cl), CAMBER_OK);
    for (int method = CAMBER_METHOD_STRIP; method <= CAMBER_METHOD_FAN; method++) {
        drawing d;
        begin_drawing(&d);
        camber_paint areas[CAMBER_KERNEL_ROWS];
        for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++)
            areas[i] = (camber_paint){.fill = &fill};
        d.method = (camber_method)method;
        for (size_t k = 0; k < 2; k++) {
            put_lines(&d, k);
            d.passes[d.frame.pass_count++] = (camber_pass){
                .paints = areas, .paint_count = CAMBER_KERNEL_ROWS, .first_polyline = k, .polyline_count = 1};
        }
        put_lines(&d, 2);
        compare_with_gl(s, cl, &d, 0.5);
        camber_made_scene_free(&d.lines);
    }
    camber_renderer_destroy(cl);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_hidden), cmocka_unit_test(test_order),
                                       cmocka_unit_test(test_pieces), cmocka_unit_test(test_gl),
                                       cmocka_unit_test(test_areas_of_methods)};
    return FIXTURE_RUN(tests);
}
