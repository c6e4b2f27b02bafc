/* Lines and fills of images, drawn in OpenCL: on the device and by the twin to the last bit, beside GL, and in areas of
 * any size. test_patterns.c says where in its image a pixel lies. */
#include "raster_twin.h"

#include "draw/draw_cl.h"
#include "draw/renderer.h"

enum { SIDE_PX = 300, IMAGES = 6, BYTES_MAX = 4 * 70 * 70 };

typedef struct drawing {
    uint8_t rgba[IMAGES][BYTES_MAX];
    camber_image images[IMAGES];
    camber_made_scene lines;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    camber_paint paints[2][CAMBER_KERNEL_ROWS];
    camber_pass passes[4]; /* fill, lines, fill, lines */
    camber_frame frame;
} drawing;

static const float dash_lengths[] = {9, 6};
static const camber_dash dash = {dash_lengths, 2};
static const camber_ramp_stop stops[] = {{0, {1, 0, 0, 1}}, {1, {0, 1, 1, 1}}};
static const camber_ramp ramp = {stops, 2};

/* Opaque and translucent ones; one pixel, one row, one column, and one that is finer than pixels. noise: each pixel by
 * itself, where else colours go over into each other. */
static void make_images(drawing *d, bool noise) {
    static const uint32_t sizes[IMAGES][2] = {{16, 8}, {9, 9}, {1, 1}, {32, 1}, {1, 7}, {70, 70}};
    uint64_t seed = 3;
    for (size_t i = 0; i < IMAGES; i++) {
        const uint32_t width = sizes[i][0], height = sizes[i][1];
        for (uint32_t k = 0; k < width * height; k++) {
            const double x = 2 * SCENE_PI * (k % width) / width, y = 2 * SCENE_PI * (k / width) / height;
            const double alpha = noise ? camber_random_between(&seed, 0, 255) : 150 + 100 * sin(y);
            uint8_t *px = d->rgba[i] + 4 * (size_t)k;
            px[3] = (uint8_t)(i % 2 ? alpha : 255.0);
            for (int c = 0; c < 3; c++) {
                const double value = noise ? camber_random_between(&seed, 0, 1) : 0.5 + 0.5 * sin(x + (c + 1) * y + c);
                px[c] = (uint8_t)(value * px[3]);
            }
        }
        d->images[i] = (camber_image){d->rgba[i], width, height, 0};
    }
}

enum { SCENES = 5, WAYS = 12 };

static camber_paint paint_of(const drawing *d, size_t way, float width_px) {
    camber_paint p = {.width_px = 0.9f * width_px, .color = {1, 1, 1, 1}, .image = d->images + way % IMAGES};
    p.image_px = way == 1 ? 37.3f : way == 7 ? 3 : 0;
    if (way == 2 || way == 9) {
        p.width_px = 0.3f * width_px;
        p.gap_px = 0.3f * width_px;
    }
    p.blur_px = way == 4 ? 2.5f : 0;
    p.dash = way == 6 || way == 9 ? &dash : NULL;
    p.ramp = way == 8 ? &ramp : NULL;
    p.trim_end = way == 5 ? 0.3f : 0;
    p.translate_x_px = way == 3 ? 1.7f : 0;
    if (way == 11)
        p.image = NULL;
    return p;
}

static drawing *begin_drawing(int which, size_t first_way) {
    static void (*const fills[SCENES])(camber_made_scene *, uint64_t *) = {
        camber_scene_add_walks, camber_scene_add_rings, camber_scene_add_turns, camber_scene_add_blocks,
        camber_scene_add_degenerate};
    drawing *d = calloc(1, sizeof *d);
    uint64_t seed = 31 + (uint64_t)which;
    assert_non_null(d);
    d->frame = (camber_frame){.width = SIDE_PX, .height = SIDE_PX - 37, .background = {0.8f, 0.7f, 1, 1}};
    make_images(d, false);
    scene_strokes(d->strokes);
    fills[which](&d->lines, &seed);
    for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++) {
        d->paints[0][i] = paint_of(d, (first_way + i) % WAYS, d->strokes[i].width_px);
        d->paints[1][i] = paint_of(d, (first_way + 3 * i + 5) % WAYS, 0.5f * d->strokes[i].width_px);
    }
    d->passes[0].fill = (camber_fill){.color = {0, 0, 0, 1},
                                      .image = d->images + first_way % IMAGES,
                                      .width_px = 13.3f,
                                      .height_px = 21,
                                      .x_px = 5.5f,
                                      .y_px = -3,
                                      .bearing_deg = 20};
    d->passes[2].fill = (camber_fill){.color = {0, 0, 0, 0.4f}, .image = d->images + 1, .x_px = 100};
    d->frame.passes = d->passes;
    d->frame.pass_count = 4;
    return d;
}

static void end_drawing(drawing *d) {
    camber_made_scene_free(&d->lines);
    free(d);
}

static camber_mesh *make_mesh(const fixture *e, camber_renderer *renderer, const drawing *d, camber_method method) {
    const camber_tessellation_desc desc = {d->strokes, CAMBER_KERNEL_ROWS, method, 0, true};
    return fixture_mesh(e, renderer, &d->lines, &desc);
}

static picture draw_with(const fixture *e, camber_renderer *renderer, drawing *d) {
    camber_mesh *mesh = make_mesh(e, renderer, d, CAMBER_METHOD_STRIP);
    for (size_t i = 0; i < 4; i++) {
        camber_pass *pass = d->passes + i;
        pass->kind = i % 2 ? CAMBER_PASS_LINES : CAMBER_PASS_FILL;
        pass->mesh = mesh;
        pass->paints = d->paints[i / 2];
        pass->paint_count = i % 2 ? CAMBER_KERNEL_ROWS : 0;
    }
    picture p = picture_draw(renderer, &d->frame);
    camber_mesh_destroy(mesh);
    return p;
}

/* ---- Device and twin ---- */

/* A scene of the stages alone: each row an image of its own, some of them in layers and groups, and two fills. */
static void compare_with_twin(const fixture *e, const drawing *d, camber_mesh *mesh, size_t first_way, bool linear) {
    enum { ROWS = 2 * CAMBER_KERNEL_ROWS, PASS = CAMBER_KERNEL_ROWS + 1, FIRST = 1, ALL = FIRST + 2 * PASS };
    float rows[ROWS][CAMBER_RASTER_ROW_WORDS] = {{0}};
    /* brush 0 draws nothing; then those of each pass begin with that of its fill */
    camber_brush brushes[ALL] = {{.fill = FIRST + PASS}};
    camber_brush_ext brush_ext[ALL] = {{0}};
    camber_side_table *table = &e->on.renderer[CAMBER_FIXTURE_OPENCL]->list.side_table;
    camber_cl_images images = {.table = table, .nearest = 1};
    camber_side_table_clear(table);
    for (uint32_t i = 0; i < ROWS; i++) {
        const uint32_t pass = i / CAMBER_KERNEL_ROWS, fill = FIRST + PASS * pass,
                       number = fill + 1 + i % CAMBER_KERNEL_ROWS;
        const float width = d->strokes[i % CAMBER_KERNEL_ROWS].width_px;
        const size_t image = (first_way + i) % IMAGES;
        const camber_image_use use =
            camber_image_use_on_line(d->images + image, image, width > 0 ? (double)width : 1, 0);
        rows[i][0] = width > 0.0f ? 0.5f * width : -1.0f;
        memcpy(rows[i] + 3, &number, sizeof number);
        brushes[number] =
            (camber_brush){.r = 1, .g = 1, .b = 1, .a = i % 2 ? 1 : 0.6f, .fill = fill, .layer_opacity = 0.8f};
        brushes[number].layer = i % 3 == 1 ? i : 0;
        brushes[number].group = pass;
        brushes[number].group_opacity = 0.7f;
        brush_ext[number].features = i % 5 == 4 ? 0 : CAMBER_FEATURE_IMAGE;
        assert_int_equal(camber_cl_images_add_line(&images, &use, &brush_ext[number].image), CAMBER_OK);
    }
    for (uint32_t pass = 0; pass < 2; pass++) {
        bool is_opaque;
        const uint32_t number = FIRST + PASS * pass;
        const camber_fill *fill = &d->passes[2 * pass].fill;
        camber_image_use uses[] = {
            camber_image_use_in_fill(fill->image, 0, (double)fill->width_px, (double)fill->height_px),
            camber_image_use_as_mean(fill->image, 0)};
        const camber_draw_list list = {.image_uses = uses};
        const camber_fill_paint paint = {fill->color,        true, 0, 1, fill->x_px, fill->y_px, fill->bearing_deg,
                                         .upright = pass > 0};
        brushes[number] = (camber_brush){.r = 1, .g = 1, .b = 1, .a = pass ? 1 : 0.6f, .mode = CAMBER_BRUSH_AREA};
        brushes[number].fill = pass ? FIRST : 0;
        brush_ext[number].features = CAMBER_FEATURE_IMAGE;
        assert_int_equal(camber_cl_images_add_fill(&images, &list, &paint, &brush_ext[number].image, &is_opaque),
                         CAMBER_OK);
        assert_int_equal(is_opaque, (fill->image - d->images) % 2 == 0);
    }
    const size_t count = mesh->polyline_count;
    const camber_raster_input runs[] = {{mesh, 0, count, 0},
                                        {mesh, count / 3, count, CAMBER_KERNEL_ROWS, .upright = true}};
    camber_raster_scene drawn = {.rows = rows[0],
                                 .row_count = ROWS,
                                 .brushes = brushes,
                                 .brush_count = ALL,
                                 .inputs = runs,
                                 .input_count = 2,
                                 .background = {0.2f, 0.3f, 0.4f, 1},
                                 .linear = linear,
                                 .brush_ext = brush_ext,
                                 .side_table = table->texels,
                                 .side_table_count = table->count};
    for (int pitched = 0; pitched < 2; pitched++) {
        if (pitched)
            raster_tilt(&drawn, first_way % 2 ? 40 : 75, SIDE_PX, SIDE_PX);
        uint8_t *rgba = raster_draw_twice(e, &drawn, (camber_raster_area){32, 32, 230, 200});
        camber_free(e->context, rgba);
    }
    camber_free(e->context, images.held);
}

static void test_twin(void **state) {
    const fixture *e = *state;
    static const camber_method methods[] = {CAMBER_METHOD_STRIP, CAMBER_METHOD_KITE, CAMBER_METHOD_FAN};
    for (int which = 0; which < SCENES; which++)
        for (size_t m = 0; m < 3; m++) {
            if (!raster_is_of_method(which, (int)m))
                continue;
            const size_t first_way = 5 * m + 2 * (size_t)which;
            drawing *d = begin_drawing(which, first_way);
            camber_mesh *mesh = make_mesh(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], d, methods[m]);
            compare_with_twin(e, d, mesh, first_way, which % 2);
            camber_mesh_destroy(mesh);
            end_drawing(d);
        }
}

/* ---- GL ---- */

/* On bisectors single pixels belong to another segment than GL's triangles say, and there its image is another: up to
 * all that black and white are apart. And GL has 8 bits for what a filter gives, as for each line and fill that lies
 * over another, which shows where each pixel of an image is another colour. */
enum { PIXELS_PAST_8 = 300 };
static void compare_with_gl(const fixture *e, drawing *d, const char *what, size_t way, double bound) {
    picture a = draw_with(e, fixture_gl(e), d), b = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], d);
    picture_assert_near(&a, &b, what, way, bound, PIXELS_PAST_8);
}

static void test_gl(void **state) {
    const fixture *e = *state;
    static const char *const names[SCENES] = {"walks", "rings", "turns", "blocks", "degenerate"};
    if (IS_SANITIZED || raster_is_second() || !fixture_gl(e))
        skip();
    for (size_t way = 0; way < WAYS; way++) {
        const int which = (int)way % SCENES;
        drawing *d = begin_drawing(which, way);
        scene_shorten(&d->lines, 40);
        d->passes[2].fill.color.a = 0;
        compare_with_gl(e, d, names[which], way, 0.3);
        make_images(d, true);
        compare_with_gl(e, d, "  of noise", way, 0.5);
        make_images(d, false);
        d->passes[2].fill.color.a = 0.4f; /* rounds the whole picture once more */
        d->passes[1].overlap = CAMBER_OVERLAP_UNITE;
        d->passes[3].opacity = 0.6f;
        for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++)
            d->paints[0][i].color.a = 0.5f;
        if (way % 2)
            compare_with_gl(e, d, "  translucent", way, 0.4);
        d->frame.coverage = CAMBER_COVERAGE_LINEAR;
        d->passes[3].overlap = CAMBER_OVERLAP_ACCUMULATE;
        if (way % 2 == 0)
            compare_with_gl(e, d, "  translucent, linear", way, 0.4);
        d->frame.pitch_deg = way % 2 ? 50 : 75;
        compare_with_gl(e, d, "  at an angle", way, 0.4);
        end_drawing(d);
    }
}

/* ---- The same bytes ---- */

static void test_areas(void **state) {
    const fixture *e = *state;
    static const uint32_t sides[] = {33, 64, 200};
    drawing *d = begin_drawing(0, 1);
    d->passes[1].opacity = 0.5f;
    picture whole = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], d);
    for (size_t k = 0; k < 2 * sizeof sides / sizeof *sides; k++) {
        if (k == sizeof sides / sizeof *sides) {
            picture_free(&whole);
            d->frame.pitch_deg = 60;
            d->frame.largest_area_px = 0;
            whole = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], d);
        }
        d->frame.largest_area_px = sides[k % (sizeof sides / sizeof *sides)];
        picture p = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], d);
        picture_assert_same(&whole, &p);
        picture_free(&p);
    }
    picture_free(&whole);
    end_drawing(d);
}

/* ---- Images as they should not be ---- */

/* Whatever is too long, too fine or no number is drawn as GL draws it: without a hang and in bounds. */
static void test_hostile(void **state) {
    const fixture *e = *state;
    static uint8_t strip[4 * CAMBER_IMAGE_SIDE_MAX];
    static const float odd[] = {NAN, INFINITY, -1, 0, 1e-30f, 1e30f, 1e-3f, 16384};
    for (size_t i = 0; i < sizeof strip; i++)
        strip[i] = i % 4 == 3 ? 255 : (uint8_t)(i / 64);
    const camber_image images[] = {{strip, CAMBER_IMAGE_SIDE_MAX, 1, 0}, {strip, 1, CAMBER_IMAGE_SIDE_MAX, 0}};
    for (size_t i = 0; i < 2 * sizeof odd / sizeof *odd; i++) {
        const float size = odd[i / 2];
        drawing *d = begin_drawing(2, i);
        d->frame.width = d->frame.height = 150;
        scene_shorten(&d->lines, 40);
        memcpy(d->images, images, sizeof images);
        d->passes[0].fill = (camber_fill){.color = {0, 0, 0, 1},
                                          .image = d->images + i % 2,
                                          .width_px = size,
                                          .height_px = 30,
                                          .x_px = i % 2 ? size : 0,
                                          .bearing_deg = i % 3 ? 0 : 1e9};
        for (size_t k = 0; k < CAMBER_KERNEL_ROWS; k++) {
            d->paints[0][k].image = d->paints[1][k].image = d->images + (i + k) % 2;
            d->paints[0][k].image_px = size;
        }
        picture p = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], d),
                q = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], d);
        picture_assert_same(&p, &q);
        picture_free(&q);
        if (fixture_gl(e) && !raster_is_second()) {
            q = draw_with(e, fixture_gl(e), d);
            const difference apart = picture_compare(&p, &q);
            printf("# size %g: %.4f of 255 on average, %d at most\n", (double)size, apart.mean, apart.most);
            picture_free(&q);
        }
        picture_free(&p);
        end_drawing(d);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_twin),
        cmocka_unit_test(test_gl),
        cmocka_unit_test(test_areas),
        cmocka_unit_test(test_hostile),
    };
    return FIXTURE_CL_RUN(tests);
}
