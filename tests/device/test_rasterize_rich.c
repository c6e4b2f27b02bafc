/* Features of frames beside widths and colours, drawn in OpenCL: bands, blur, dashes, trims, ramps and masked layers,
 * on the device and by the twin to the last bit, beside GL, and in areas of any size. */
#include "raster_twin.h"

#include "draw/renderer.h"

enum { SIDE_PX = 300, DASHES = 4, RAMPS = 4 };

/* ---- The pictures ---- */

static const float even[] = {9, 6}, odd[] = {7.3f}, many[] = {12, 3, 0, 3, 5.5f, 4.5f}, fine[] = {0.4f, 0.9f};
static const camber_dash dashes[DASHES] = {{even, 2}, {odd, 1}, {many, 6}, {fine, 2}};

static const camber_ramp_stop two[] = {{0, {1, 0, 0, 1}}, {1, {0, 1, 0, 1}}};
static const camber_ramp_stop steps[] = {{0.3f, {1, 1, 0, 1}}, {0.3f, {0, 0, 1, 1}}, {0.31f, {0, 1, 1, 1}},
                                         {0.6f, {1, 0, 1, 1}}, {0.6f, {1, 1, 1, 1}}, {0.9f, {0, 0, 0, 1}}};
static const camber_ramp_stop glass[] = {{0, {1, 0, 0, 0}}, {0.4f, {1, 0.5f, 0, 1}}, {1, {0, 0, 1, 0.3f}}};
enum { STRIPES = 40, STRIPES_MANY = 1300 };
static camber_ramp_stop stripes[STRIPES];

static void fill_stripes(void) {
    for (int i = 0; i < STRIPES; i++)
        stripes[i] = (camber_ramp_stop){(float)(i / 2 + 1) / (STRIPES / 2 + 2), {(float)(i / 2 % 2), 0.5f, 0, 1}};
}

static const camber_ramp ramps[RAMPS] = {{two, 2}, {steps, 6}, {glass, 3}, {stripes, STRIPES}};

/* One of many ways to draw a row. */
enum { WAYS = 16 };
static camber_paint paint_of(size_t way, float width_px) {
    static const float hues[6][3] = {{1, 0, 0}, {0, 0.6f, 0}, {0, 0, 1}, {0.8f, 0.6f, 0}, {0.5f, 0, 0.5f}, {0, 0, 0}};
    const float *hue = hues[way % 6];
    const bool gap = way == 1 || way == 3 || way == 8 || way == 9 || way == 13;
    camber_paint p = {.width_px = gap ? 0.3f * width_px : 0.9f * width_px, .color = {hue[0], hue[1], hue[2], 1}};
    p.gap_px = gap ? 0.4f * width_px : 0;
    p.blur_px = way == 2 ? 0.2f * width_px : way == 3 ? 1.5f : way == 10 ? 6 : 0;
    p.smooth_blur = way == 3;
    p.dash = way >= 4 && way < 10 ? dashes + way % DASHES : way == 14 ? dashes : NULL;
    p.dash_unit_px = way == 5 ? 2.5f : 0;
    p.trim_start = way == 6 || way == 11 ? 0.35f : 0;
    p.trim_end = way == 6 ? 0.7f : way == 7 ? 0.2f : way == 11 ? 1 : 0;
    p.ramp = way >= 12 ? ramps + way % RAMPS : NULL;
    p.translate_y_px = way == 4 ? 2.5f : 0;
    if (p.ramp)
        p.color = (camber_color){1, 1, 1, 1};
    return p;
}

typedef struct drawing {
    camber_made_scene lines;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    camber_paint paints[2][CAMBER_KERNEL_ROWS];
    camber_pass passes[2];
    camber_frame frame;
} drawing;

enum { SCENES = 5 };
static drawing begin_drawing(int which, size_t first_way) {
    static void (*const fills[SCENES])(camber_made_scene *, uint64_t *) = {
        camber_scene_add_walks, camber_scene_add_rings, camber_scene_add_turns, camber_scene_add_blocks,
        camber_scene_add_degenerate};
    drawing d = {.frame = {.width = SIDE_PX, .height = SIDE_PX - 37, .background = {0.8f, 0.6f, 1, 1}}};
    uint64_t seed = 31 + (uint64_t)which;
    scene_strokes(d.strokes);
    fills[which](&d.lines, &seed);
    for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++) {
        d.paints[0][i] = paint_of((first_way + i) % WAYS, d.strokes[i].width_px);
        d.paints[1][i] = paint_of((first_way + 3 * i + 5) % WAYS, 0.5f * d.strokes[i].width_px);
    }
    return d;
}

static camber_mesh *make_mesh(const fixture *e, camber_renderer *renderer, const drawing *d, camber_method method) {
    const camber_tessellation_desc desc = {d->strokes, CAMBER_KERNEL_ROWS, method, 0, true};
    return fixture_mesh(e, renderer, &d->lines, &desc);
}

static picture draw_with(const fixture *e, camber_renderer *renderer, drawing *d, camber_method method) {
    camber_mesh *mesh = make_mesh(e, renderer, d, method);
    for (size_t i = 0; i < 2; i++) {
        camber_pass *pass = d->passes + i;
        pass->mesh = mesh;
        pass->paints = d->paints[i];
        pass->paint_count = CAMBER_KERNEL_ROWS;
    }
    d->frame.passes = d->passes;
    d->frame.pass_count = 2;
    picture p = picture_draw(renderer, &d->frame);
    camber_mesh_destroy(mesh);
    return p;
}

/* ---- Device and twin ---- */

/* A scene of the stages alone, each row with other features. */
enum { TAIL_MAX = 32768 };
static camber_brush_ext more_of(size_t way, float width_px, float tail[4 * TAIL_MAX], size_t *tail_count) {
    const camber_paint p = paint_of(way, width_px);
    camber_brush_ext m = {.half_gap = 0.5f * p.gap_px, .blur = p.smooth_blur ? -p.blur_px : p.blur_px};
    m.features = (p.gap_px > 0 ? CAMBER_FEATURE_GAP : 0) | (p.blur_px > 0 ? CAMBER_FEATURE_BLUR : 0) |
                 (p.dash ? CAMBER_FEATURE_DASH : 0) | (p.trim_end > 0 ? CAMBER_FEATURE_TRIM : 0) |
                 (p.ramp ? CAMBER_FEATURE_RAMP : 0);
    m.trim_from = p.trim_start;
    m.trim_to = p.trim_end;
    if (p.dash) {
        m.period = p.dash == dashes + 1 ? 1.3f : 12;
        m.round_dashes = way % 2;
        m.first_dash = (uint32_t)*tail_count;
        m.dash_count = 3;
        for (int i = -1; i < 2; i++) {
            tail[4 * *tail_count] = (float)i * m.period;
            tail[4 * (*tail_count)++ + 1] = ((float)i + 0.6f) * m.period;
        }
    }
    if (p.ramp) {
        const camber_ramp *ramp = p.ramp;
        const bool is_striped = ramp == ramps + RAMPS - 1;
        m.first_stop = (uint32_t)*tail_count;
        m.stop_count = (uint32_t)(is_striped ? STRIPES_MANY : ramp->count); /* more than are looked at */
        for (size_t i = 0; i < m.stop_count; i++) {
            const camber_color c = ramp->stops[i % ramp->count].color;
            const float place = is_striped ? (float)i / STRIPES_MANY : ramp->stops[i].place;
            const float texels[8] = {place, 0, 0, 0, c.r * c.a, c.g * c.a, c.b * c.a, c.a};
            memcpy(tail + 4 * *tail_count, texels, sizeof texels);
            *tail_count += 2;
        }
    }
    return m;
}

/* From above, and under one pitch of three: there the twin is slow. */
static void compare_with_twin(const fixture *e, const drawing *d, camber_mesh *mesh, size_t first_way, int number) {
    static float tail[4 * TAIL_MAX];
    float rows[3 * CAMBER_KERNEL_ROWS][CAMBER_RASTER_ROW_WORDS] = {{0}};
    camber_brush brushes[3 * CAMBER_KERNEL_ROWS] = {{0}};
    camber_brush_ext brush_ext[3 * CAMBER_KERNEL_ROWS] = {{0}};
    size_t tail_count = 0;
    for (uint32_t i = 0; i < 3 * CAMBER_KERNEL_ROWS; i++) {
        const size_t way = (first_way + i) % WAYS;
        const float width = d->strokes[i % CAMBER_KERNEL_ROWS].width_px;
        rows[i][0] = width > 0.0f ? 0.5f * width : -1.0f;
        memcpy(rows[i] + 3, &i, sizeof i);
        brush_ext[i] = more_of(way, width, tail, &tail_count);
        brushes[i] = (camber_brush){.r = 0.1f * (float)(i % 10), .g = 0.7f, .b = 1, .a = i % 2 ? 1 : 0.6f};
        if (i >= CAMBER_KERNEL_ROWS && i < 2 * CAMBER_KERNEL_ROWS) { /* a masked layer in a group */
            brushes[i].mode = CAMBER_BRUSH_MASKED;
            brushes[i].layer = 1;
            brushes[i].layer_opacity = 0.8f;
        }
        if (i >= CAMBER_KERNEL_ROWS) {
            brushes[i].group = 1;
            brushes[i].group_opacity = 0.9f;
        }
        if (i % 7 == 3)
            brush_ext[i].features = 0;
    }
    assert_true(tail_count <= TAIL_MAX);
    const size_t count = mesh->polyline_count;
    const camber_raster_input runs[] = {{mesh, 0, count, 0},
                                        {mesh, count / 3, count, CAMBER_KERNEL_ROWS},
                                        {mesh, 0, count / 2, 2 * CAMBER_KERNEL_ROWS}};
    camber_raster_scene drawn = {.rows = rows[0],
                                 .row_count = 3 * CAMBER_KERNEL_ROWS,
                                 .brushes = brushes,
                                 .brush_count = 3 * CAMBER_KERNEL_ROWS,
                                 .inputs = runs,
                                 .input_count = 3,
                                 .background = {0.2f, 0.3f, 0.4f, 1},
                                 .linear = number % 2,
                                 .brush_ext = brush_ext,
                                 .side_table = tail,
                                 .side_table_count = tail_count};
    static const double pitches[] = {20, 60, 80};
    const camber_raster_area area = {32, 64, 400, 333};
    camber_free(e->context, raster_draw_twice(e, &drawn, area));
    raster_tilt(&drawn, pitches[number % 3], SIDE_PX, SIDE_PX);
    camber_free(e->context, raster_draw_twice(e, &drawn, area));
}

static void test_twin(void **state) {
    const fixture *e = *state;
    static const camber_method methods[] = {CAMBER_METHOD_STRIP, CAMBER_METHOD_KITE, CAMBER_METHOD_FAN};
    for (int which = 0; which < SCENES; which++)
        for (size_t m = 0; m < 3; m++) {
            if (!raster_is_of_method(which, (int)m))
                continue;
            const size_t first_way = 5 * m + 2 * (size_t)which;
            drawing d = begin_drawing(which, first_way);
            camber_mesh *mesh = make_mesh(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, methods[m]);
            compare_with_twin(e, &d, mesh, first_way, which + (int)m);
            camber_mesh_destroy(mesh);
            camber_made_scene_free(&d.lines);
        }
}

/* ---- GL ---- */

/* A group's layer is rounded to 8 bits twice more. On bisectors single pixels belong to another segment than GL's
 * triangles say, whose dash, band or colour is another: up to 255. */
enum { PIXELS_PAST_8 = 1000 };
static void compare_with_gl(const fixture *e, drawing *d, const char *what, size_t way) {
    picture a = draw_with(e, fixture_gl(e), d, CAMBER_METHOD_STRIP),
            b = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], d, CAMBER_METHOD_STRIP);
    const double bound = d->passes[1].opacity > 0 ? 0.3 : 0.2;
    /* A GPU rounds each time that it blends: 0.320 on an H200. */
    picture_assert_near(&a, &b, what, way, fixture_has_gpu(e) ? bound + 0.1 : bound, PIXELS_PAST_8);
}

static void test_gl(void **state) {
    const fixture *e = *state;
    static const char *const names[SCENES] = {"walks", "rings", "turns", "blocks", "degenerate"};
    if (IS_SANITIZED || raster_is_second() || !fixture_gl(e))
        skip();
    for (size_t way = 0; way < WAYS; way++) {
        const int which = (int)way % SCENES;
        drawing d = begin_drawing(which, way);
        scene_shorten(&d.lines, 40);
        compare_with_gl(e, &d, names[which], way);
        d.passes[0].overlap = CAMBER_OVERLAP_UNITE;
        d.passes[1].opacity = 0.6f;
        for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++)
            d.paints[0][i].color.a = 0.5f;
        compare_with_gl(e, &d, "  translucent", way);
        d.frame.coverage = CAMBER_COVERAGE_LINEAR;
        for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++) { /* coverage is gathered, and coloured once */
            d.paints[0][i] = paint_of(way < 12 ? way : way - 4, d.strokes[i].width_px);
            d.paints[0][i].color = (camber_color){0, 0.4f, 0, 0.5f};
        }
        d.passes[0].opacity = 0.7f;
        d.passes[1].overlap = CAMBER_OVERLAP_ACCUMULATE;
        compare_with_gl(e, &d, "  of one colour, linear", way);
        camber_made_scene_free(&d.lines);
    }
}

static void test_gl_tilted(void **state) {
    const fixture *e = *state;
    static const double pitches[] = {30, 60, 80};
    if (IS_SANITIZED || raster_is_second() || !fixture_gl(e))
        skip();
    for (size_t way = 0; way < WAYS; way++) {
        drawing d = begin_drawing((int)way % SCENES, way);
        scene_shorten(&d.lines, 40);
        char what[64];
        d.frame.pitch_deg = pitches[way % 3];
        snprintf(what, sizeof what, "at %g degrees%s", d.frame.pitch_deg, way % 2 ? ", translucent" : "");
        if (way % 2) {
            d.passes[0].overlap = CAMBER_OVERLAP_UNITE;
            d.passes[1].opacity = 0.6f;
            for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++)
                d.paints[0][i].color.a = 0.5f;
        }
        compare_with_gl(e, &d, what, way);
        camber_made_scene_free(&d.lines);
    }
}

/* Lines of more alphas than layers: one layer, in which a line hides those below it. */
static void test_many_alphas(void **state) {
    const fixture *e = *state;
    enum { LINES = 80 };
    static camber_stroke strokes[LINES];
    static camber_paint paints[LINES];
    camber_made_scene lines = {0};
    uint64_t seed = 4;
    if (raster_is_second() || !fixture_gl(e))
        skip();
    for (size_t i = 0; i < LINES; i++) {
        strokes[i].width_px = 9;
        paints[i] = (camber_paint){.width_px = 9, .color = {(float)(i % 3) / 2, 0.5f, (float)(i % 2), 0}};
        paints[i].color.a = (float)(i + 1) / (LINES + 1);
        camber_made_scene_walk(&lines, &seed, 12, (const double[]){20, 60}, 1);
        camber_made_scene_end(&lines, i);
    }
    picture p[2];
    for (int i = 0; i < 2; i++) {
        camber_renderer *renderer = i ? e->on.renderer[CAMBER_FIXTURE_OPENCL] : fixture_gl(e);
        camber_mesh *mesh = fixture_mesh(e, renderer, &lines, &(camber_tessellation_desc){strokes, LINES, 0, 0, 0});
        const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = LINES, .opacity = 0.9f};
        const camber_frame frame = {.width = SIDE_PX, .height = SIDE_PX, .passes = &pass, .pass_count = 1};
        p[i] = picture_draw(renderer, &frame);
        camber_mesh_destroy(mesh);
    }
    const difference apart = picture_compare(&p[0], &p[1]);
    printf("# many alphas %.4f of 255 on average, %d at most\n", apart.mean, apart.most);
    assert_true(apart.drawn > 10000 && apart.past_8 <= apart.drawn / PIXELS_PAST_8);
    assert_true(apart.mean < 0.5); /* GL's layer has 8 bits, and so has that of the group */
    picture_free(&p[0]);
    picture_free(&p[1]);
    camber_made_scene_free(&lines);
}

/* ---- The same bytes ---- */

/* Where no buffer has room for all segments, so that they are drawn in slices. */
static void compare_in_slices(const fixture *e, drawing *d, const picture *whole) {
    const camber_device_desc desc = {.largest_buffer_bytes = 256 * 1024};
    fixture small = {.context = e->context};
    assert_int_equal(camber_device_create(e->context, &desc, &small.on.device), CAMBER_OK);
    assert_int_equal(camber_renderer_create(small.on.device, NULL, NULL, &small.on.renderer[CAMBER_FIXTURE_OPENCL]),
                     CAMBER_OK);
    picture p = draw_with(&small, small.on.renderer[CAMBER_FIXTURE_OPENCL], d, CAMBER_METHOD_STRIP);
    assert_true(camber_raster_slice_count(small.on.renderer[CAMBER_FIXTURE_OPENCL]->raster) > 1);
    picture_assert_same(whole, &p);
    picture_free(&p);
    camber_renderer_destroy(small.on.renderer[CAMBER_FIXTURE_OPENCL]);
    camber_device_destroy(small.on.device);
}

static void test_areas(void **state) {
    const fixture *e = *state;
    static const uint32_t sides[] = {33, 64, 200};
    drawing d = begin_drawing(0, 1);
    d.passes[1].opacity = 0.5f;
    for (int i = 0; i < 2; i++) {
        picture whole = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, CAMBER_METHOD_STRIP);
        for (size_t k = 0; k < sizeof sides / sizeof *sides; k++) {
            d.frame.largest_area_px = sides[k];
            picture p = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, CAMBER_METHOD_STRIP);
            picture_assert_same(&whole, &p);
            picture_free(&p);
        }
        d.frame.largest_area_px = 0;
        compare_in_slices(e, &d, &whole);
        picture_free(&whole);
        for (size_t k = 0; k < CAMBER_KERNEL_ROWS; k++)
            d.paints[0][k] = paint_of(8 + k % 8, d.strokes[k].width_px);
        d.frame.pitch_deg = 65;
    }
    camber_made_scene_free(&d.lines);
}

/* Frames of every kind in turn, by one renderer: what one of them leaves counts in the next one's bound. */
static void test_bound(void **state) {
    const fixture *e = *state;
    enum { DRAWING_BYTES = 4 << 20 }; /* what a renderer gets of the least bound */
    const camber_device_desc desc = {.memory_bytes = 16 << 20};
    fixture bound = {.context = e->context};
    drawing d = begin_drawing(0, 1);
    assert_int_equal(camber_device_create(e->context, &desc, &bound.on.device), CAMBER_OK);
    assert_int_equal(camber_renderer_create(bound.on.device, NULL, NULL, &bound.on.renderer[CAMBER_FIXTURE_OPENCL]),
                     CAMBER_OK);
    uint64_t seed = 5;
    for (size_t i = 0; i < 60; i++) {
        camber_made_scene_walk(&d.lines, &seed, 1000, (const double[]){1, 6}, 1);
        camber_made_scene_end(&d.lines, i % CAMBER_KERNEL_ROWS);
    }
    for (int i = 0; i < 6; i++) {
        d.frame.pitch_deg = i % 3 == 1 ? 65 : 0;
        for (size_t k = 0; k < CAMBER_KERNEL_ROWS; k++)
            d.paints[0][k] = d.paints[1][k] =
                i % 3 < 2 ? paint_of(8 + k % 8, d.strokes[k].width_px)
                          : (camber_paint){.width_px = d.strokes[k].width_px, .color = {0, 0, 0, 1}};
        picture whole = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, CAMBER_METHOD_STRIP);
        picture p = draw_with(&bound, bound.on.renderer[CAMBER_FIXTURE_OPENCL], &d, CAMBER_METHOD_STRIP);
        picture_assert_same(&whole, &p);
        const uint64_t held = camber_device_get_memory(bound.on.device).held_bytes;
        printf("# %u slices, %llu bytes of drawing\n",
               camber_raster_slice_count(bound.on.renderer[CAMBER_FIXTURE_OPENCL]->raster), (unsigned long long)held);
        assert_true(held > DRAWING_BYTES / 4 && held <= DRAWING_BYTES);
        picture_free(&whole);
        picture_free(&p);
    }
    camber_renderer_destroy(bound.on.renderer[CAMBER_FIXTURE_OPENCL]);
    camber_device_destroy(bound.on.device);
    camber_made_scene_free(&d.lines);
}

int main(void) {
    fill_stripes();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_twin),        cmocka_unit_test(test_gl),    cmocka_unit_test(test_gl_tilted),
        cmocka_unit_test(test_many_alphas), cmocka_unit_test(test_areas), cmocka_unit_test(test_bound),
    };
    return FIXTURE_CL_RUN(tests);
}
