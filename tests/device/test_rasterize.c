/* Drawing in OpenCL: the device against the twin to the last bit, stage by stage; GL's pictures; the same bytes again
 * and in areas of any size; loads that lie in one tile or in one polyline. */
#include "raster_twin.h"

#include "draw/renderer.h"

enum { SIDE_PX = 360 };

/* ---- Scenes ---- */

typedef struct drawing {
    camber_made_scene lines;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    camber_paint paints[3][CAMBER_KERNEL_ROWS];
    camber_pass passes[3];
    camber_frame frame;
    bool has_arc_length;
} drawing;

static camber_color color_of(size_t i, float alpha) {
    return (camber_color){0.2f * (float)(i % 6), 1.0f - 0.2f * (float)(i % 5), 0.2f * (float)(i % 4), alpha};
}

/* Casing, fill, and a pass that a caller makes translucent; all joins and caps. */
static drawing begin_drawing(void) {
    drawing d = {.frame = {.width = SIDE_PX, .height = SIDE_PX - 37, .background = {0.8f, 0.6f, 1, 1}}};
    scene_strokes(d.strokes);
    for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++) {
        const float width = d.strokes[i].width_px;
        d.paints[0][i] = (camber_paint){.width_px = width, .color = {0, 0, 0, 1}};
        d.paints[1][i] = (camber_paint){.width_px = 0.6f * width, .color = color_of(i, 1), .translate_x_px = 3};
        d.paints[2][i] = (camber_paint){.width_px = 0.3f * width, .color = color_of(i + 2, 0.4f)};
    }
    return d;
}

static const camber_frame *end_drawing(drawing *d, camber_mesh *mesh, size_t pass_count) {
    for (size_t i = 0; i < 3; i++) {
        d->passes[i].mesh = mesh;
        d->passes[i].paints = d->paints[i];
        d->passes[i].paint_count = CAMBER_KERNEL_ROWS;
    }
    d->frame.passes = d->passes;
    d->frame.pass_count = pass_count;
    return &d->frame;
}

static void fill_scene(camber_made_scene *lines, int which) {
    uint64_t seed = 77 + (uint64_t)which;
    static void (*const fills[])(camber_made_scene *, uint64_t *) = {camber_scene_add_walks, camber_scene_add_blocks,
                                                                     camber_scene_add_rings, camber_scene_add_turns,
                                                                     camber_scene_add_degenerate};
    fills[which](lines, &seed);
}

enum { TURNS = 3, SCENES = 5 };

static camber_mesh *make_mesh(const fixture *e, camber_renderer *renderer, const drawing *d, camber_method method) {
    const camber_tessellation_desc desc = {d->strokes, CAMBER_KERNEL_ROWS, method, 0, d->has_arc_length};
    return fixture_mesh(e, renderer, &d->lines, &desc);
}

/* ---- Device and twin ---- */

static const double PITCHES[] = {1, 30, 60, 85};

/* A device, and the mesh of a scene on it. */
typedef struct subject {
    const fixture *on;
    camber_mesh *mesh;
} subject;

/* The stages of a picture as the twin has them, or those of a device that has been compared with the twin: the same to
 * the last bit. Gives the picture. */
static uint8_t *compare_stages(subject a, const subject *compared, const camber_raster_scene *drawn,
                               camber_raster_area area) {
    if (!compared)
        return raster_draw_twice(a.on, drawn, area);
    camber_raster_input inputs[8];
    camber_raster_scene there = *drawn;
    memcpy(inputs, drawn->inputs, drawn->input_count * sizeof *inputs);
    for (size_t i = 0; i < drawn->input_count; i++)
        inputs[i].mesh = compared->mesh;
    there.inputs = inputs;
    camber_raster_stages ours = raster_draw(a.on, drawn, area), theirs = raster_draw(compared->on, &there, area);
    raster_compare(&ours, &theirs);
    assert_memory_equal(ours.rgba, theirs.rgba, 4 * (size_t)area.width * area.height);
    camber_free(a.on->context, raster_take_picture(a.on, &theirs));
    return raster_take_picture(a.on, &ours);
}

/* A scene of the stages alone: one table, a brush a row, with layers and a group among them, and a fill. The rich
 * variant makes the same of what is plain. The picture is tilted by every other pitch, as the twin is slow then, and by
 * one where each number of lanes is compared. */
static void compare_scene(const drawing *d, subject a, const subject *compared, int which, int method) {
    const bool linear = which % 2;
    const camber_raster_area area = {32 * (uint32_t)method, 64, which == TURNS ? 500 : 280, 333};
    camber_mesh *mesh = a.mesh;
    enum { FILL = CAMBER_KERNEL_ROWS + 1, BRUSHES = 2 * CAMBER_KERNEL_ROWS + 2 }; /* brush 0 draws nothing */
    static const camber_brush_ext nothing[BRUSHES];
    float rows[2 * CAMBER_KERNEL_ROWS][CAMBER_RASTER_ROW_WORDS] = {{0}};
    camber_brush brushes[BRUSHES] = {{.fill = FILL}};
    for (uint32_t i = 0; i < 2 * CAMBER_KERNEL_ROWS; i++) {
        const bool over = i >= CAMBER_KERNEL_ROWS;
        const float width = d->strokes[i % CAMBER_KERNEL_ROWS].width_px;
        rows[i][0] = width > 0.0f ? (over ? 0.3f : 0.5f) * width : -1.0f;
        rows[i][1] = over ? 1.5f : 0.0f;
        const uint32_t number = over ? i + 2 : i + 1;
        memcpy(rows[i] + 3, &number, sizeof number);
        const camber_color c = color_of(i, over ? 1.0f : 0.5f);
        camber_brush *brush = brushes + number;
        *brush = (camber_brush){.r = c.r, .g = c.g, .b = c.b, .a = c.a, .layer_opacity = 0.7f, .group_opacity = 0.6f};
        brush->mode = i % 3 == 0 && !over ? CAMBER_BRUSH_UNION : CAMBER_BRUSH_OVER;
        brush->group = over ? 1 : 0;
        brush->layer = i % 4 == 1 ? i : 0;
        brush->fill = over ? FILL : 0;
    }
    brushes[FILL] = (camber_brush){.r = 0.1f,
                                   .g = 0.9f,
                                   .b = 0.4f,
                                   .a = linear ? 1 : 0.3f,
                                   .mode = CAMBER_BRUSH_AREA,
                                   .group = 1,
                                   .group_opacity = 0.6f};
    const size_t count = mesh->polyline_count;
    const camber_raster_input runs[] = {{mesh, 0, count, 0}, {mesh, count / 3, count, CAMBER_KERNEL_ROWS}};
    camber_raster_scene drawn = {rows[0], 2 * CAMBER_KERNEL_ROWS, brushes, BRUSHES, runs,
                                 2,       {0.2f, 0.3f, 0.4f, 1},  linear};
    uint8_t *plain = compare_stages(a, compared, &drawn, area);
    drawn.brush_ext = nothing;
    camber_raster_stages stages = raster_draw(a.on, &drawn, area);
    uint8_t *rich = raster_take_picture(a.on, &stages);
    assert_memory_equal(plain, rich, 4 * (size_t)area.width * area.height);
    camber_free(a.on->context, rich);
    camber_free(a.on->context, plain);
    const size_t step = compared ? 4 : 2;
    for (size_t i = (size_t)(which + method) % step; i < sizeof PITCHES / sizeof *PITCHES; i += step) {
        raster_tilt(&drawn, PITCHES[i], SIDE_PX, SIDE_PX);
        camber_free(a.on->context, compare_stages(a, compared, &drawn, area));
    }
}

/* The same rows with their weights summed up, by brushes that each have a weight. */
static void compare_sums(const drawing *d, subject a, const subject *compared, int which, int method) {
    const camber_raster_area area = {32 * (uint32_t)method, 64, which == TURNS ? 500 : 280, 333};
    float rows[CAMBER_KERNEL_ROWS][CAMBER_RASTER_ROW_WORDS] = {{0}};
    camber_brush brushes[CAMBER_KERNEL_ROWS + 1] = {{.mode = CAMBER_BRUSH_SUM}};
    for (uint32_t i = 0; i < CAMBER_KERNEL_ROWS; i++) {
        const float width = d->strokes[i].width_px;
        const uint32_t number = i + 1;
        rows[i][0] = width > 0.0f ? 0.5f * width : -1.0f;
        memcpy(rows[i] + 3, &number, sizeof number);
        brushes[number] = (camber_brush){.r = 300.25f * (float)number, .a = 1, .mode = CAMBER_BRUSH_SUM};
    }
    const camber_raster_input run = {a.mesh, 0, a.mesh->polyline_count, 0};
    const camber_raster_scene drawn = {rows[0], CAMBER_KERNEL_ROWS, brushes, CAMBER_KERNEL_ROWS + 1, &run, 1,
                                       {0},     which % 2};
    uint8_t *sums = compare_stages(a, compared, &drawn, area);
    float most = 0;
    for (size_t i = 0; i < (size_t)area.width * area.height; i++) {
        float sum;
        memcpy(&sum, sums + 4 * i, sizeof sum);
        assert_true(sum >= 0.0f);
        most = fmaxf(most, sum);
    }
    assert_true(most > 300.0f);
    camber_free(a.on->context, sums);
}

static const camber_method METHODS[] = {CAMBER_METHOD_STRIP, CAMBER_METHOD_KITE, CAMBER_METHOD_FAN};

static void test_twin(void **state) {
    const fixture *e = *state;
    if (raster_is_second())
        skip(); /* test_lanes has compared each width */
    for (int which = 0; which < SCENES; which++)
        for (int m = 0; m < 3; m++) {
            if (!raster_is_of_method(which, m))
                continue;
            drawing d = begin_drawing();
            fill_scene(&d.lines, which);
            d.has_arc_length = (which + m) % 2;
            camber_mesh *mesh = make_mesh(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, METHODS[m]);
            compare_scene(&d, (subject){e, mesh}, NULL, which, m);
            compare_sums(&d, (subject){e, mesh}, NULL, which, m);
            camber_mesh_destroy(mesh);
            camber_made_scene_free(&d.lines);
        }
}

/* A line along the x axis, 16 px wide. */
static void add_level(camber_made_scene *lines, size_t count, double y) {
    for (size_t i = 0; i < count; i++) {
        camber_made_scene_point(lines, -50, y);
        camber_made_scene_point(lines, 150, y);
        camber_made_scene_end(lines, 0);
    }
}

/* Sixteen lines nearly fill a cell, and the line below, which fills it, may be skipped or not. Of the pixels in its
 * lowest row, 0.17 % shows through the sixteen. That counts as nothing, or they would be a level darker. */
static void test_filled(void **state) {
    const fixture *e = *state;
    const camber_raster_area area = {.width = 96, .height = 64};
    const uint32_t number = 1;
    drawing d = begin_drawing();
    float rows[CAMBER_KERNEL_ROWS][CAMBER_RASTER_ROW_WORDS] = {{8}};
    const camber_brush brushes[] = {{0}, {.r = 0.5004f / 255, .a = 1}};
    add_level(&d.lines, 1, 10);
    add_level(&d.lines, 8, 3.33);
    add_level(&d.lines, 8, 28);
    add_level(&d.lines, 8, 3.33);
    memcpy(rows[0] + 3, &number, sizeof number);
    camber_mesh *mesh = make_mesh(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, CAMBER_METHOD_STRIP);
    const camber_raster_input run = {mesh, 0, mesh->polyline_count, 0};
    const camber_raster_scene drawn = {rows[0], CAMBER_KERNEL_ROWS, brushes, 2, &run, 1, {0, 0, 0, 1}, false};
    uint8_t *rgba = raster_draw_twice(e, &drawn, area);
    assert_int_equal(rgba[4 * (10 * area.width + 40)], 1);
    assert_int_equal(rgba[4 * (11 * area.width + 40)], 1);
    assert_int_equal(rgba[4 * (12 * area.width + 40)], 1);
    camber_free(e->context, rgba);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&d.lines);
}

/* ---- GL ---- */

static picture draw_with(const fixture *e, camber_renderer *renderer, drawing *d, size_t pass_count,
                         camber_method method) {
    camber_mesh *mesh = make_mesh(e, renderer, d, method);
    picture p = picture_draw(renderer, end_drawing(d, mesh, pass_count));
    camber_mesh_destroy(mesh);
    return p;
}

/* GL rounds to 8 bits at each line, which is a level or two. And it says by triangles which segment has a pixel,
 * kernels by the bisector itself: on it single pixels belong to another, which shows where joins are sharp and lines
 * wide. */
enum { MOST = 200, PIXELS_PAST_8 = 1000 };
static void compare_with_gl(const fixture *e, drawing *d, size_t pass_count, const char *what) {
    const double bound = d->passes[1].opacity > 0 ? 0.3 : 0.2; /* a group is rounded twice more */
    camber_renderer *gl = fixture_gl(e);
    picture a = draw_with(e, gl, d, pass_count, CAMBER_METHOD_STRIP),
            b = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], d, pass_count, CAMBER_METHOD_STRIP);
    const difference apart = picture_compare(&a, &b);
    printf("# %-40s %.4f of 255 on average, %d at most, %zu pixels past 8\n", what, apart.mean, apart.most,
           apart.past_8);

    assert_true(apart.drawn > 0 && apart.mean < bound && apart.most <= (d->frame.pitch_deg > 0 ? 255 : MOST));

    assert_true(apart.past_8 <= apart.drawn / PIXELS_PAST_8);
    picture_free(&a);
    picture_free(&b);
}

static void test_gl(void **state) {
    const fixture *e = *state;
    static const char *const names[SCENES] = {"walks", "blocks", "rings", "turns", "degenerate"};
    if (IS_SANITIZED || raster_is_second() || !fixture_gl(e))
        skip();
    for (int which = 0; which < SCENES; which++) {
        drawing d = begin_drawing();
        fill_scene(&d.lines, which);
        scene_shorten(&d.lines, 40);
        compare_with_gl(e, &d, 2, names[which]);
        d.passes[2].overlap = CAMBER_OVERLAP_FLATTEN;
        compare_with_gl(e, &d, 3, "  with a translucent pass");
        d.passes[0].overlap = CAMBER_OVERLAP_UNITE;
        d.passes[1].opacity = 0.5f;
        d.passes[2].overlap = CAMBER_OVERLAP_ACCUMULATE;
        d.passes[2].opacity = 0.8f;
        d.paints[1][3].color.a = 0.3f;
        compare_with_gl(e, &d, 3, "  with layers in groups");
        d.frame.coverage = CAMBER_COVERAGE_LINEAR;
        d.frame.background = (camber_color){0, 0, 0, 0};
        compare_with_gl(e, &d, 3, "  with ramps, on nothing");
        camber_made_scene_free(&d.lines);
    }
}

/* GL's segments do not agree to the last bit where a join parts them: single pixels of wide lines stay empty. */
static void test_gl_tilted(void **state) {
    const fixture *e = *state;
    static const char *const names[SCENES] = {"walks", "blocks", "rings", "turns", "degenerate"};
    if (IS_SANITIZED || raster_is_second() || !fixture_gl(e))
        skip();
    for (int which = 0; which < SCENES; which++)
        for (size_t i = (size_t)which % 2; i < sizeof PITCHES / sizeof *PITCHES; i += 2) {
            char what[64];
            drawing d = begin_drawing();
            fill_scene(&d.lines, which);
            scene_shorten(&d.lines, 40);
            d.frame.pitch_deg = PITCHES[i];
            snprintf(what, sizeof what, "%s at %g degrees", names[which], PITCHES[i]);
            compare_with_gl(e, &d, 2, what);
            d.passes[2].overlap = CAMBER_OVERLAP_FLATTEN;
            compare_with_gl(e, &d, 3, "  with a translucent pass");
            d.passes[0].overlap = CAMBER_OVERLAP_UNITE;
            d.passes[1].opacity = 0.5f;
            d.frame.coverage = CAMBER_COVERAGE_LINEAR;
            compare_with_gl(e, &d, 3, "  united, with ramps");
            camber_made_scene_free(&d.lines);
        }
}

/* ---- The same bytes ---- */

static void compare_areas(const fixture *e, double pitch_deg) {
    static const uint32_t sides[] = {33, 64, 320, 359};
    for (int which = 0; which < SCENES; which++) {
        drawing d = begin_drawing();
        fill_scene(&d.lines, which);
        d.passes[0].overlap = which % 2 ? CAMBER_OVERLAP_UNITE : CAMBER_OVERLAP_ACCUMULATE;
        d.passes[1].opacity = 0.5f;
        d.frame.pitch_deg = pitch_deg;
        picture whole = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, 3, CAMBER_METHOD_STRIP);
        for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
            d.frame.largest_area_px = sides[i];
            picture p = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, 3, CAMBER_METHOD_STRIP);
            picture_assert_same(&whole, &p);
            picture_free(&p);
        }
        picture_free(&whole);
        camber_made_scene_free(&d.lines);
    }
}

/* The same picture on another device; gives the slices of its last area. */
static uint32_t compare_on(const fixture *e, const camber_device_desc *desc, drawing *d, size_t pass_count,
                           const picture *whole) {
    fixture small = {.context = e->context};
    assert_int_equal(camber_device_create(e->context, desc, &small.on.device), CAMBER_OK);
    assert_int_equal(camber_renderer_create(small.on.device, NULL, NULL, &small.on.renderer[CAMBER_FIXTURE_OPENCL]),
                     CAMBER_OK);
    picture p = draw_with(&small, small.on.renderer[CAMBER_FIXTURE_OPENCL], d, pass_count, CAMBER_METHOD_STRIP);
    const uint32_t slices = camber_raster_slice_count(small.on.renderer[CAMBER_FIXTURE_OPENCL]->raster);
    picture_assert_same(whole, &p);
    picture_free(&p);
    camber_renderer_destroy(small.on.renderer[CAMBER_FIXTURE_OPENCL]);
    camber_device_destroy(small.on.device);
    return slices;
}

static void test_areas(void **state) {
    compare_areas(*state, 0);
    compare_areas(*state, 50);
    compare_areas(*state, 80);
}

/* Where lists and pixels may take little, rows of tiles are drawn by halves. */
static void test_little_memory(void **state) {
    const fixture *e = *state;
    drawing d = begin_drawing();
    uint64_t seed = 8;
    for (int i = 0; i < 60; i++) {
        camber_made_scene_walk(&d.lines, &seed, 12, (const double[]){20, 90}, 1);
        camber_made_scene_end(&d.lines, i % 2 ? 8 : (size_t)i % CAMBER_KERNEL_ROWS); /* every other one very wide */
    }
    picture whole = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, 3, CAMBER_METHOD_STRIP);
    static const uint64_t largest[] = {2048 * 1024, 256 * 1024, 96 * 1024};
    for (size_t i = 0; i < sizeof largest / sizeof *largest; i++) {
        const camber_device_desc desc = {.largest_buffer_bytes = largest[i], .memory_bytes = 1 << (19 - i)};
        compare_on(e, &desc, &d, 3, &whole);
    }
    picture_free(&whole);
    camber_made_scene_free(&d.lines);
}

/* Shapes that no buffer has room for are drawn in slices: with layers, unions and groups open between them, in tiles
 * that are heavy in some slices only, and where nothing of a slice is. */
static void test_slices(void **state) {
    const fixture *e = *state;
    static const uint64_t largest[] = {1024 * 1024, 300 * 1024, 140 * 1024};
    for (int which = 0; which < 4; which++) {
        drawing d = begin_drawing();
        uint64_t seed = 21;
        if (which == 3)
            for (int i = 0; i < 1500; i++) {
                camber_made_scene_walk(&d.lines, &seed, 7, (const double[]){66, 90}, 1);
                camber_made_scene_end(&d.lines, 1 + (size_t)i % 2);
            }
        fill_scene(&d.lines, which);
        d.passes[0].overlap = which == 0 ? CAMBER_OVERLAP_UNITE : CAMBER_OVERLAP_ACCUMULATE;
        d.passes[1].opacity = which % 2 ? 0.5f : 1.0f;
        d.passes[2].overlap = which < 2 ? CAMBER_OVERLAP_FLATTEN : CAMBER_OVERLAP_UNITE;
        d.passes[2].opacity = 0.8f;
        d.paints[1][3].color.a = 0.3f;
        d.frame.pitch_deg = which == 2 ? 60 : 0;
        d.paints[1][2].blur_px = which == 1 ? 2.0f : 0.0f;
        d.paints[0][1].gap_px = which == 1 ? 1.5f : 0.0f;
        d.frame.pitch_deg = which == 2 ? 30.0 : 0.0;
        picture whole = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, 3, CAMBER_METHOD_STRIP);
        assert_int_equal(camber_raster_slice_count(e->on.renderer[CAMBER_FIXTURE_OPENCL]->raster), 1);
        uint32_t most = 0;
        for (size_t i = 0; i < sizeof largest / sizeof *largest; i++) {
            const camber_device_desc desc = {.largest_buffer_bytes = largest[i]};
            const uint32_t slices = compare_on(e, &desc, &d, 3, &whole);
            most = slices > most ? slices : most;
        }
        printf("# %u slices at most\n", most);
        assert_true(most > 3);
        picture_free(&whole);
        camber_made_scene_free(&d.lines);
    }
}

/* Memory that drawing holds counts: a quarter of what is allowed, and meshes have the rest. */
static void test_bound(void **state) {
    const fixture *e = *state;
    const uint64_t allowed = 24 * 1024 * 1024;
    const camber_device_desc desc = {.memory_bytes = allowed};
    fixture bound = {.context = e->context};
    drawing d = begin_drawing();
    uint64_t seed = 4;
    for (int i = 0; i < 3000; i++) {
        camber_made_scene_walk(&d.lines, &seed, 40, (const double[]){20, 500}, 1);
        camber_made_scene_end(&d.lines, (size_t)i % 3);
    }
    picture whole = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, 3, CAMBER_METHOD_STRIP);
    assert_int_equal(camber_device_create(e->context, &desc, &bound.on.device), CAMBER_OK);
    assert_int_equal(camber_renderer_create(bound.on.device, NULL, NULL, &bound.on.renderer[CAMBER_FIXTURE_OPENCL]),
                     CAMBER_OK);
    assert_true(camber_device_get_memory(bound.on.device).allowed_bytes == allowed);
    picture p = draw_with(&bound, bound.on.renderer[CAMBER_FIXTURE_OPENCL], &d, 3, CAMBER_METHOD_STRIP);
    picture_assert_same(&whole, &p);
    const camber_device_memory memory = camber_device_get_memory(bound.on.device);
    printf("# %u slices, %llu of %llu bytes at most\n",
           camber_raster_slice_count(bound.on.renderer[CAMBER_FIXTURE_OPENCL]->raster),
           (unsigned long long)memory.most_bytes, (unsigned long long)memory.allowed_bytes);
    assert_true(camber_raster_slice_count(bound.on.renderer[CAMBER_FIXTURE_OPENCL]->raster) > 3);
    assert_true(memory.held_bytes > allowed / 16 && memory.most_bytes <= allowed);
    camber_renderer_destroy(bound.on.renderer[CAMBER_FIXTURE_OPENCL]);
    assert_true(camber_device_get_memory(bound.on.device).held_bytes == 0);
    assert_true(camber_device_get_memory(bound.on.device).allowed_bytes == allowed);
    camber_device_destroy(bound.on.device);
    picture_free(&p);
    picture_free(&whole);
    camber_made_scene_free(&d.lines);
}

/* Tiles of which nothing is drawn spill nothing: a tall picture of few tiles takes no more slices than a low one. */
static void test_spills(void **state) {
    const fixture *e = *state;
    const camber_device_desc desc = {.memory_bytes = 24 * 1024 * 1024};
    drawing d = begin_drawing();
    uint64_t seed = 6;
    uint32_t slices[2];
    for (int i = 0; i < 3000; i++) {
        for (int k = 0; k < 40; k++) {
            const double y = camber_random_between(&seed, 20, 110);
            camber_made_scene_point(&d.lines, camber_random_between(&seed, 20, 110), y);
        }
        camber_made_scene_end(&d.lines, (size_t)i % 3);
    }
    for (int i = 0; i < 2; i++) {
        d.frame.width = 512;
        d.frame.height = i ? 128 : SIDE_PX;
        picture whole = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, 3, CAMBER_METHOD_STRIP);
        slices[i] = compare_on(e, &desc, &d, 3, &whole);
        picture_free(&whole);
    }
    printf("# %u and %u slices\n", slices[0], slices[1]);
    assert_true(slices[0] > 3);
    assert_int_equal(slices[0], slices[1]);
    camber_made_scene_free(&d.lines);
}

/* Vectors of every width, in OpenCL: the bytes of the device's own width, which test_twin compares with the twin's, and
 * the same picture, in slices too. */
static void compare_lanes(const fixture *e, uint32_t lanes) {
    fixture other = {.context = e->context};
    const camber_device_desc desc = {.lanes = lanes}, small = {.lanes = lanes, .largest_buffer_bytes = 200 * 1024};
    assert_int_equal(camber_device_create(e->context, &desc, &other.on.device), CAMBER_OK);
    assert_int_equal(other.on.device->lanes, lanes);
    assert_int_equal(camber_renderer_create(other.on.device, NULL, NULL, &other.on.renderer[CAMBER_FIXTURE_OPENCL]),
                     CAMBER_OK);
    for (int which = 0; which < SCENES; which++) {
        const int m = which % 3;
        drawing d = begin_drawing();
        fill_scene(&d.lines, which);
        d.has_arc_length = (which + m) % 2;
        camber_mesh *mesh = make_mesh(&other, other.on.renderer[CAMBER_FIXTURE_OPENCL], &d, METHODS[m]),
                    *own = make_mesh(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, METHODS[m]);
        compare_scene(&d, (subject){&other, mesh}, &(subject){e, own}, which, m);
        compare_sums(&d, (subject){&other, mesh}, &(subject){e, own}, which, m);
        camber_mesh_destroy(mesh);
        camber_mesh_destroy(own);
        d.has_arc_length = false;
        d.passes[0].overlap = which % 2 ? CAMBER_OVERLAP_ACCUMULATE : CAMBER_OVERLAP_UNITE;
        d.passes[1].opacity = 0.5f;
        d.passes[2].overlap = which < 2 ? CAMBER_OVERLAP_FLATTEN : CAMBER_OVERLAP_UNITE;
        d.passes[2].opacity = 0.8f;
        d.paints[1][3].color.a = 0.3f;
        picture whole = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, 3, CAMBER_METHOD_STRIP);
        assert_int_equal(compare_on(e, &desc, &d, 3, &whole), 1);
        assert_true(compare_on(e, &small, &d, 3, &whole) > 1);
        d.frame.pitch_deg = 50;
        picture tilted = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, 3, CAMBER_METHOD_STRIP);
        assert_int_equal(compare_on(e, &desc, &d, 3, &tilted), 1);
        picture_free(&tilted);
        picture_free(&whole);
        camber_made_scene_free(&d.lines);
    }
    camber_renderer_destroy(other.on.renderer[CAMBER_FIXTURE_OPENCL]);
    camber_device_destroy(other.on.device);
}

/* The lanes that a device of OpenCL itself has are those of all other tests. */
static void test_lanes(void **state) {
    const fixture *e = *state;
    static const uint32_t lanes[] = {16, 8, 1};
    if (IS_SANITIZED || raster_is_second())
        skip(); /* the twin has one lane */
    if (camber_device_get_info(e->on.device).type != CAMBER_DEVICE_TYPE_CPU)
        skip(); /* a GPU has one lane, and its compiler takes minutes over vectors */
    for (size_t i = 0; i < sizeof lanes / sizeof *lanes; i++)
        if (lanes[i] != e->on.device->lanes || camber_device_get_info(e->on.device).fixed_kernels)
            compare_lanes(e, lanes[i]);
}

/* Kernels as they are built for a GPU draw the same picture. */
static void test_groups(void **state) {
    const fixture *e = *state;
    const camber_device_desc desc = {.work_group_size = 64};
    drawing d = begin_drawing();
    fill_scene(&d.lines, 3);
    picture whole = draw_with(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, 2, CAMBER_METHOD_STRIP);
    assert_int_equal(compare_on(e, &desc, &d, 2, &whole), 1);
    picture_free(&whole);
    camber_made_scene_free(&d.lines);
}

/* ---- Loads ---- */

/* All in one tile, and one polyline over all: both take many work-items. */
static void test_loads(void **state) {
    const fixture *e = *state;
    drawing d = begin_drawing();
    uint64_t seed = 3;
    for (int i = 0; i < 20000; i++) {
        for (int k = 0; k < 5; k++) {
            const double y = camber_random_between(&seed, 66, 94);
            camber_made_scene_point(&d.lines, camber_random_between(&seed, 66, 94), y);
        }
        camber_made_scene_end(&d.lines, 1 + (size_t)i % 2);
    }
    for (int i = 0; i < 1000000; i++)
        camber_made_scene_point(&d.lines, 300 + 2e-4 * i * cos(1e-2 * i), 280 + 2e-4 * i * sin(1e-2 * i));
    camber_made_scene_end(&d.lines, 2);
    for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++)
        d.paints[0][i].color.a = 0.5f;
    d.passes[0].overlap = CAMBER_OVERLAP_ACCUMULATE;
    camber_mesh *mesh = make_mesh(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, CAMBER_METHOD_STRIP);
    picture p = picture_draw(e->on.renderer[CAMBER_FIXTURE_OPENCL], end_drawing(&d, mesh, 1)),
            q = picture_draw(e->on.renderer[CAMBER_FIXTURE_OPENCL], &d.frame);
    picture_assert_same(&p, &q);
    assert_true(picture_at(&p, 80, 80)[0] < 2); /* the background does not show */
    picture_free(&p);
    picture_free(&q);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&d.lines);
}

/* ---- Sums ---- */

enum { SUMMED = 300, SUMMED_PX = 200 };

/* Lines of which each has its own row, and a weight of 1 to 3. */
typedef struct summed {
    camber_made_scene lines;
    camber_stroke strokes[SUMMED];
    camber_paint paints[SUMMED];
    camber_pass pass;
    camber_frame frame;
} summed;

static void fill_summed(summed *s) {
    uint64_t seed = 12;
    *s = (summed){.frame = {.width = SUMMED_PX, .height = SUMMED_PX, .passes = &s->pass, .pass_count = 1}};
    for (size_t i = 0; i < SUMMED; i++) {
        s->strokes[i] = (camber_stroke){.width_px = 0.5f + 0.25f * (float)(i % 20), .cap = (camber_cap)(i % 3)};
        s->paints[i] = (camber_paint){.width_px = s->strokes[i].width_px, .color = {1.0f + (float)(i % 3), 0, 0, 1}};
        for (int k = 0; k < 40; k++) {
            const double y = camber_random_between(&seed, -10, SUMMED_PX);
            camber_made_scene_point(&s->lines, camber_random_between(&seed, 0, SUMMED_PX + 10), y);
        }
        camber_made_scene_end(&s->lines, i);
    }
    s->pass.paints = s->paints;
    s->pass.paint_count = SUMMED;
}

static float *sum_on(const fixture *e, camber_renderer *renderer, summed *s, size_t first, size_t count) {
    const camber_tessellation_desc desc = {s->strokes, SUMMED, CAMBER_METHOD_STRIP, 0, false};
    float *sums = malloc(sizeof *sums * SUMMED_PX * SUMMED_PX);
    assert_non_null(sums);
    if (!s->pass.mesh)
        s->pass.mesh = fixture_mesh(e, renderer, &s->lines, &desc);
    s->pass.first_polyline = first;
    s->pass.polyline_count = count;
    assert_int_equal(camber_renderer_sum(renderer, &s->frame, sums, 0, NULL), CAMBER_OK);
    return sums;
}

/* A line's sum is what its picture covers, to half a level. */
static void compare_with_picture(camber_renderer *renderer, const summed *s, size_t line, const float *sums) {
    picture p = picture_draw(renderer, &s->frame);
    for (uint32_t y = 0; y < SUMMED_PX; y++)
        for (uint32_t x = 0; x < SUMMED_PX; x++) {
            const float area = sums[y * SUMMED_PX + x] / s->paints[line].color.r;
            if (!(fabsf(area - (float)picture_at(&p, x, y)[3] / 255.0f) < 0.51f / 255.0f))
                fail_msg("line %zu at %u, %u: %g instead of %u", line, x, y, (double)area, picture_at(&p, x, y)[3]);
        }
    picture_free(&p);
}

/* The sum of all lines is the sum of each of them, to float rounding, and the same on a device that draws slices. */
static void test_sums(void **state) {
    const fixture *e = *state;
    camber_renderer *renderer = e->on.renderer[CAMBER_FIXTURE_OPENCL];
    static double expected[SUMMED_PX * SUMMED_PX];
    summed s;
    fill_summed(&s);
    float *all = sum_on(e, renderer, &s, 0, 0);
    memset(expected, 0, sizeof expected);
    for (size_t i = 0; i < SUMMED; i++) {
        float *one = sum_on(e, renderer, &s, i, 1);
        for (size_t k = 0; k < SUMMED_PX * SUMMED_PX; k++)
            expected[k] += (double)one[k];
        if (i % 16 == 0)
            compare_with_picture(renderer, &s, i, one);
        free(one);
    }
    double most = 0;
    for (size_t k = 0; k < SUMMED_PX * SUMMED_PX; k++) {
        most = fmax(most, expected[k]);
        assert_true(fabs((double)all[k] - expected[k]) <= 1e-5 * fmax(expected[k], 1.0));
    }
    assert_true(most > 255.0); /* more than a picture can say */
    camber_mesh_destroy(s.pass.mesh);
    s.pass.mesh = NULL;
    const camber_device_desc desc = {.largest_buffer_bytes = 140 * 1024};
    fixture small = {.context = e->context};
    assert_int_equal(camber_device_create(e->context, &desc, &small.on.device), CAMBER_OK);
    assert_int_equal(camber_renderer_create(small.on.device, NULL, NULL, &small.on.renderer[CAMBER_FIXTURE_OPENCL]),
                     CAMBER_OK);
    float *sliced = sum_on(&small, small.on.renderer[CAMBER_FIXTURE_OPENCL], &s, 0, 0);
    assert_true(camber_raster_slice_count(small.on.renderer[CAMBER_FIXTURE_OPENCL]->raster) > 1);
    assert_memory_equal(all, sliced, sizeof *all * SUMMED_PX * SUMMED_PX);
    free(sliced);
    free(all);
    camber_mesh_destroy(s.pass.mesh);
    camber_renderer_destroy(small.on.renderer[CAMBER_FIXTURE_OPENCL]);
    camber_device_destroy(small.on.device);
    camber_made_scene_free(&s.lines);
}

/* Frames of more than opaque lines are refused. */
static void test_sums_refused(void **state) {
    fixture *e = *state;
    camber_renderer *renderer = e->on.renderer[CAMBER_FIXTURE_OPENCL];
    summed s;
    fill_summed(&s);
    float *sums = sum_on(e, renderer, &s, 0, 0);
    const camber_fill fill = {.color = {1, 0, 0, 1}};
    summed wrong[] = {s, s, s, s, s, s, s};
    wrong[0].frame.background = (camber_color){1, 1, 1, 1};
    wrong[1].pass = (camber_pass){.kind = CAMBER_PASS_FILL, .fill = fill};
    wrong[2].pass.opacity = 0.5f;
    for (size_t i = 0; i < SUMMED; i++)
        wrong[3].paints[i].fill = &fill;
    wrong[4].paints[SUMMED / 2].color.r = NAN;
    wrong[5].paints[SUMMED / 2].color.r = -INFINITY;
    wrong[6].paints[SUMMED / 2].color.a = 0.5f;
    wrong[6].pass.overlap = CAMBER_OVERLAP_ACCUMULATE;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        wrong[i].frame.passes = &wrong[i].pass;
        wrong[i].pass.paints = wrong[i].paints;
        assert_int_equal(camber_renderer_sum(renderer, &wrong[i].frame, sums, 0, NULL), CAMBER_ERROR_ARGUMENT);
        assert_story(&e->h, "a sum: ");
    }
    free(sums);
    camber_mesh_destroy(s.pass.mesh);
    camber_made_scene_free(&s.lines);
}

/* ---- Refusals ---- */

static void test_refused(void **state) {
    fixture *e = *state;
    drawing d = begin_drawing();
    camber_made_scene_point(&d.lines, 10, 10);
    camber_made_scene_point(&d.lines, 90, 10);
    camber_made_scene_end(&d.lines, 5);
    camber_mesh *mesh = make_mesh(e, e->on.renderer[CAMBER_FIXTURE_OPENCL], &d, CAMBER_METHOD_STRIP);
    d.frame.pitch_deg = 30;
    d.paints[0][5].blur_px = 2;
    assert_int_equal(
        camber_renderer_render(e->on.renderer[CAMBER_FIXTURE_OPENCL], end_drawing(&d, mesh, 1), NULL, NULL, NULL),
        CAMBER_OK);
    assert_int_equal(camber_renderer_get_rasterizer(e->on.renderer[CAMBER_FIXTURE_OPENCL]), CAMBER_RASTERIZER_OPENCL);
    assert_int_equal(camber_renderer_get_sharing(e->on.renderer[CAMBER_FIXTURE_OPENCL]), CAMBER_SHARING_AUTO);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&d.lines);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_twin),          cmocka_unit_test(test_lanes),
        cmocka_unit_test(test_groups),        cmocka_unit_test(test_gl),
        cmocka_unit_test(test_gl_tilted),     cmocka_unit_test(test_areas),
        cmocka_unit_test(test_little_memory), cmocka_unit_test(test_loads),
        cmocka_unit_test(test_slices),        cmocka_unit_test(test_bound),
        cmocka_unit_test(test_refused),       cmocka_unit_test(test_spills),
        cmocka_unit_test(test_sums),          cmocka_unit_test(test_sums_refused),
        cmocka_unit_test(test_filled),
    };
    return FIXTURE_CL_RUN(tests);
}
