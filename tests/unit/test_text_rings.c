/* Texts that a program places itself: the list of fonts, rings at points and along lines, boxes, places that are out of
 * range. */
#include "core.h"

#include "camber_text.h"

#include <math.h>

static const char *const noto_sans[] = {"Noto Sans"};

typedef struct maker {
    host h;
    camber_context *context;
    camber_fonts *fonts;
    camber_text_rings *rings;
} maker;

/* Only with the fonts that are shipped. */
static void make(maker *m) {
    m->context = host_context(&m->h);
    assert_int_equal(camber_fonts_create(m->context, &(camber_fonts_desc){.no_system = true}, &m->fonts), CAMBER_OK);
    assert_int_equal(camber_text_rings_create(m->fonts, &m->rings), CAMBER_OK);
}

static void unmake(maker *m) {
    camber_text_rings_destroy(m->rings);
    camber_fonts_destroy(m->fonts);
    host_done(&m->h, m->context);
}

static camber_text *shape_with(maker *m, const char *words, camber_text_desc desc) {
    const camber_text_run run = {.text = words, .size_bytes = strlen(words), .fonts = noto_sans, .font_count = 1};
    camber_text *text = NULL;
    desc.runs = &run;
    desc.run_count = 1;
    assert_int_equal(camber_text_shape(m->fonts, &desc, &text), CAMBER_OK);
    return text;
}

static camber_text *shape(maker *m, const char *words) {
    return shape_with(m, words, (camber_text_desc){0});
}

static camber_text_box add(maker *m, const camber_text *text, camber_text_position place) {
    camber_text_box box;
    assert_int_equal(camber_text_rings_add(m->rings, text, &place, &box), CAMBER_OK);
    return box;
}

static bool is_empty(camber_text_box box) {
    return box.left > box.right;
}

static void assert_box(camber_text_box a, double left, double top, double right, double bottom) {
    if (fabs((double)a.left - left) > 0.01 || fabs((double)a.top - top) > 0.01 ||
        fabs((double)a.right - right) > 0.01 || fabs((double)a.bottom - bottom) > 0.01)
        fail_msg("the box is %.3f %.3f %.3f %.3f, not %.3f %.3f %.3f %.3f", (double)a.left, (double)a.top,
                 (double)a.right, (double)a.bottom, left, top, right, bottom);
}

static void test_list(void **state) {
    (void)state;
    static const struct {
        const char *name;
        float weight;
        bool italic;
    } shipped[] = {{"Noto Sans", 400.0f, false}, {"Noto Sans Bold", 700.0f, false}, {"Noto Sans Italic", 400.0f, true}};
    maker m;
    camber_font_info info;
    make(&m);
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(camber_fonts_list(m.fonts, i, &info), CAMBER_OK);
        assert_string_equal(info.name, shipped[i].name);
        assert_null(info.path);
        assert_true(info.weight == shipped[i].weight && info.width == 100.0f && info.italic == shipped[i].italic);
    }
    assert_int_equal(camber_fonts_list(m.fonts, 3, &info), CAMBER_OK);
    assert_null(info.name);
    unmake(&m);
}

/* The fonts of a folder come first, and text that names one by its listed name is drawn with it. */
static void test_list_of_folder(void **state) {
    (void)state;
    static const char *const system = "/usr/share/fonts/truetype/dejavu";
    camber_font_info info;
    maker m = {.rings = NULL};
    if (access(system, R_OK)) {
        print_message("there is no %s (Debian: fonts-dejavu): a folder's fonts are not listed\n", system);
        skip();
    }
    m.context = host_context(&m.h);
    assert_int_equal(
        camber_fonts_create(m.context, &(camber_fonts_desc){.folders = &system, .folder_count = 1}, &m.fonts),
        CAMBER_OK);
    assert_int_equal(camber_fonts_list(m.fonts, 0, &info), CAMBER_OK);
    assert_non_null(strstr(info.name, "DejaVu"));
    assert_int_equal(strncmp(info.path, system, strlen(system)), 0);
    size_t count = 0, shipped = 0;
    while (camber_fonts_list(m.fonts, count, &info) == CAMBER_OK && info.name) {
        const camber_text_run run = {.text = "a", .size_bytes = 1, .fonts = &info.name, .font_count = 1};
        camber_text *text = NULL;
        assert_int_equal(camber_text_shape(m.fonts, &(camber_text_desc){.runs = &run, .run_count = 1}, &text),
                         CAMBER_OK);
        camber_text_destroy(text);
        shipped += !info.path;
        count++;
    }
    assert_int_equal(shipped, 3);
    assert_true(count > 4);
    assert_int_equal(m.h.warnings, 0); /* none is missing */
    unmake(&m);
}

static void test_point(void **state) {
    (void)state;
    maker m;
    make(&m);
    camber_text *text = shape(&m, "o");
    camber_outline o;
    assert_int_equal(camber_fonts_get_outline(m.fonts, text->glyphs[0].glyph, 1.0f / 640.0f, &o), CAMBER_OK);
    const double x = (double)text->glyphs[0].x, y = (double)text->glyphs[0].y;
    const double left = 20.0 * (x + (double)o.left), right = 20.0 * (x + (double)o.right);
    const double top = 20.0 * (y + (double)o.top), bottom = 20.0 * (y + (double)o.bottom);
    assert_box(add(&m, text, (camber_text_position){.size_px = 20.0f, .x = 100.0f, .y = 50.0f, .row = 7}), 100.0 + left,
               50.0 + top, 100.0 + right, 50.0 + bottom);
    assert_box(add(&m, text, (camber_text_position){.size_px = 20.0f, .turn_deg = 90.0f}), -bottom, left, -top, right);
    const camber_polylines_desc desc = camber_text_rings_get(m.rings);
    assert_int_equal(desc.polyline_count, 4); /* the outside and the inside of each o */
    assert_int_equal(desc.offsets[0], 0);
    assert_int_equal(desc.offsets[4], desc.point_count);
    for (size_t i = 0; i < 4; i++) {
        const float *first = desc.points + 2 * (size_t)desc.offsets[i],
                    *last = desc.points + 2 * (desc.offsets[i + 1] - 1);
        assert_memory_equal(first, last, 2 * sizeof *first);
        assert_int_equal(desc.rows[i], i < 2 ? 7 : 0);
    }
    camber_polylines *polylines = NULL;
    assert_int_equal(camber_polylines_create(m.context, &desc, &polylines), CAMBER_OK);
    assert_int_equal(camber_polylines_get_stats(polylines).rings, 4);
    camber_polylines_destroy(polylines);
    camber_text_destroy(text);
    unmake(&m);
}

static void test_nothing(void **state) {
    (void)state;
    maker m;
    make(&m);
    camber_text *empty = shape(&m, ""), *spaces = shape(&m, "   ");
    static const float line[] = {0.0f, 0.0f, 500.0f, 0.0f};
    assert_true(is_empty(add(&m, empty, (camber_text_position){0})));
    assert_true(is_empty(add(&m, spaces, (camber_text_position){0})));
    assert_true(is_empty(add(&m, empty, (camber_text_position){.points = line, .point_count = 2})));
    const camber_polylines_desc desc = camber_text_rings_get(m.rings);
    camber_polylines *polylines = NULL;
    assert_int_equal(desc.polyline_count, 0);
    assert_int_equal(camber_polylines_create(m.context, &desc, &polylines), CAMBER_OK);
    camber_polylines_destroy(polylines);
    camber_text_destroy(empty);
    camber_text_destroy(spaces);
    unmake(&m);
}

static void test_remove_last(void **state) {
    (void)state;
    maker m;
    make(&m);
    camber_text *o = shape(&m, "o"), *l = shape(&m, "l");
    (void)add(&m, l, (camber_text_position){0});
    (void)add(&m, o, (camber_text_position){0});
    camber_text_rings_remove_last(m.rings);
    camber_text_rings_remove_last(m.rings);
    assert_int_equal(camber_text_rings_get(m.rings).polyline_count, 1);
    (void)add(&m, o, (camber_text_position){0});
    assert_int_equal(camber_text_rings_get(m.rings).polyline_count, 3);
    camber_text_rings_clear(m.rings);
    assert_int_equal(camber_text_rings_get(m.rings).polyline_count, 0);
    camber_text_rings_remove_last(m.rings);
    assert_int_equal(camber_text_rings_get(m.rings).point_count, 0);
    camber_text_destroy(o);
    camber_text_destroy(l);
    unmake(&m);
}

/* ---- Along lines ---- */

/* On a straight line a text is where it is at a point, whichever way the line runs. */
static void test_straight(void **state) {
    (void)state;
    static const float lines[][8] = {{0.0f, 40.0f, 0.0f, 40.0f, 100.0f, 40.0f, 300.0f, 40.0f},
                                     {300.0f, 40.0f, 100.0f, 40.0f, 100.0f, 40.0f, 0.0f, 40.0f}};
    maker m;
    make(&m);
    camber_text *text = shape(&m, "Elm Street");
    const camber_text_box at = add(&m, text, (camber_text_position){.size_px = 18.0f, .x = 150.0f, .y = 40.0f});
    for (size_t i = 0; i < 2; i++) {
        camber_text_position place = {.size_px = 18.0f, .points = lines[i], .point_count = 4};
        assert_box(add(&m, text, place), (double)at.left, (double)at.top, (double)at.right, (double)at.bottom);
        place.shift_px = 30.0f;
        const double moved = i ? -30.0 : 30.0;
        assert_box(add(&m, text, place), (double)at.left + moved, (double)at.top, (double)at.right + moved,
                   (double)at.bottom);
        place.keep_direction = true;
        const camber_text_box kept = add(&m, text, place);
        if (i) /* it stands on its head */
            assert_box(kept, 270.0 - (double)at.right, 80.0 - (double)at.bottom, 270.0 - (double)at.left,
                       80.0 - (double)at.top);
        else
            assert_box(kept, (double)at.left + moved, (double)at.top, (double)at.right + moved, (double)at.bottom);
    }
    camber_text_destroy(text);
    unmake(&m);
}

/* Above its anchor is above the line, whichever way the line runs. */
static void test_above(void **state) {
    (void)state;
    static const float line[] = {300.0f, 40.0f, 0.0f, 40.0f};
    maker m;
    make(&m);
    camber_text *text = shape_with(&m, "Elm", (camber_text_desc){.anchor = CAMBER_ANCHOR_BOTTOM});
    assert_true(add(&m, text, (camber_text_position){.points = line, .point_count = 2}).bottom < 40.0f);
    camber_text_destroy(text);
    unmake(&m);
}

/* On a circle each letter is as far from the centre as the others, and upright on it. */
static void test_curved(void **state) {
    (void)state;
    float circle[2 * 181];
    maker m;
    make(&m);
    for (size_t i = 0; i <= 180; i++) {
        circle[2 * i] = -100.0f * cosf((float)i * 3.14159265f / 180.0f);
        circle[2 * i + 1] = -100.0f * sinf((float)i * 3.14159265f / 180.0f);
    }
    camber_text *text = shape_with(&m, "llllllll", (camber_text_desc){.letter_spacing_em = 0.7f});
    assert_false(
        is_empty(add(&m, text, (camber_text_position){.size_px = 20.0f, .points = circle, .point_count = 181})));
    const camber_polylines_desc desc = camber_text_rings_get(m.rings);
    assert_int_equal(desc.polyline_count, 8);
    double near = 0.0, far = 0.0, middle_of[8];
    for (size_t i = 0; i < 8; i++) {
        double least = INFINITY, most = 0.0, x = 0.0, y = 0.0;
        for (size_t p = desc.offsets[i]; p + 1 < desc.offsets[i + 1]; p++) {
            const double px = (double)desc.points[2 * p], py = (double)desc.points[2 * p + 1];
            least = fmin(least, hypot(px, py));
            most = fmax(most, hypot(px, py));
            x += px;
            y += py;
        }
        middle_of[i] = atan2(x, -y);
        near = i ? near : least;
        far = i ? far : most;
        assert_true(fabs(least - near) < 0.02 && fabs(most - far) < 0.02);
    }
    assert_true(far - near > 14.0 && far - near < 16.0); /* the height of an l */
    for (size_t i = 1; i < 8; i++)
        assert_true(fabs(middle_of[i] - middle_of[i - 1] - (middle_of[1] - middle_of[0])) < 0.002);
    assert_true(fabs(middle_of[0] + middle_of[7]) < 0.15); /* about the top; the last spacing is part of the text */
    camber_text_destroy(text);
    unmake(&m);
}

static void test_no_room(void **state) {
    (void)state;
    static const float line[] = {0.0f, 0.0f, 60.0f, 0.0f, 120.0f, 0.0f},
                       corner[] = {0.0f, 0.0f, 60.0f, 0.0f, 60.0f, 60.0f};
    static const float beyond[] = {0.0f, 0.0f, NAN, 0.0f, 120.0f, 0.0f}, far[] = {0.0f, 0.0f, 2e9f, 0.0f, 120.0f, 0.0f};
    static const float dot[] = {5.0f, 5.0f, 5.0f, 5.0f, 5.0f, 5.0f};
    maker m;
    make(&m);
    camber_text *text = shape(&m, "Elm Street");
    camber_text_position place = {.size_px = 12.0f, .points = line, .point_count = 3};
    assert_false(is_empty(add(&m, text, place)));
    camber_text_rings_clear(m.rings);
    place.shift_px = 40.0f;
    assert_true(is_empty(add(&m, text, place)));
    place = (camber_text_position){.size_px = 40.0f, .points = line, .point_count = 3};
    assert_true(is_empty(add(&m, text, place)));
    place = (camber_text_position){.size_px = 12.0f, .points = line, .point_count = 1};
    assert_true(is_empty(add(&m, text, place)));
    const float *const lines[] = {corner, beyond, far, dot};
    for (size_t i = 0; i < 4; i++) {
        place = (camber_text_position){.size_px = 12.0f, .points = lines[i], .point_count = 3};
        assert_true(is_empty(add(&m, text, place)));
    }
    assert_int_equal(camber_text_rings_get(m.rings).polyline_count, 0);
    place = (camber_text_position){.size_px = 12.0f, .points = corner, .point_count = 3, .max_turn_deg = 100.0f};
    assert_false(is_empty(add(&m, text, place)));
    camber_text_destroy(text);
    unmake(&m);
}

/* ---- Failures ---- */

static void test_out_of_range(void **state) {
    (void)state;
    static const float line[] = {0.0f, 0.0f, 300.0f, 0.0f};
    static const struct {
        camber_text_position place;
        const char *story;
    } wrong[] = {
        {{.size_px = NAN}, "size"},
        {{.size_px = -1.0f}, "size"},
        {{.size_px = 20000.0f}, "size"},
        {{.x = NAN}, "position"},
        {{.y = INFINITY}, "position"},
        {{.x = 2e9f}, "position"},
        {{.turn_deg = NAN}, "position"},
        {{.points = line, .point_count = 2, .shift_px = NAN}, "position"},
        {{.points = line, .point_count = 2, .max_turn_deg = 181.0f}, "turn"},
        {{.points = line, .point_count = 2, .max_turn_deg = NAN}, "turn"},
    };
    maker m;
    make(&m);
    camber_text *text = shape(&m, "o"), *vertical = shape_with(&m, "o", (camber_text_desc){.vertical = true});
    (void)add(&m, text, (camber_text_position){0});
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(camber_text_rings_add(m.rings, text, &wrong[i].place, NULL), CAMBER_ERROR_ARGUMENT);
        assert_story(&m.h, wrong[i].story);
    }
    const camber_text_position along = {.points = line, .point_count = 2};
    assert_int_equal(camber_text_rings_add(m.rings, vertical, &along, NULL), CAMBER_ERROR_ARGUMENT);
    assert_story(&m.h, "vertical");
    assert_int_equal(camber_text_rings_get(m.rings).polyline_count, 2);
    camber_text_destroy(text);
    camber_text_destroy(vertical);
    unmake(&m);
}

static camber_status add_once(camber_context *context, void *user) {
    static const float line[] = {0.0f, 0.0f, 300.0f, 0.0f};
    const camber_text_run run = {.text = "Oslo", .size_bytes = 4, .fonts = noto_sans, .font_count = 1};
    const camber_text_position places[] = {{.x = 10.0f}, {.points = line, .point_count = 2}};
    camber_fonts *fonts = NULL;
    camber_text *text = NULL;
    camber_text_rings *rings = NULL;
    camber_font_info info;
    (void)user;
    camber_status status = camber_fonts_create(context, &(camber_fonts_desc){.no_system = true}, &fonts);
    if (!status)
        status = camber_fonts_list(fonts, 0, &info);
    if (!status)
        status = camber_text_shape(fonts, &(camber_text_desc){.runs = &run, .run_count = 1}, &text);
    if (!status)
        status = camber_text_rings_create(fonts, &rings);
    for (size_t i = 0; i < 2 && !status; i++) {
        const size_t before = camber_text_rings_get(rings).polyline_count;
        status = camber_text_rings_add(rings, text, &places[i], NULL);
        assert_true(!status || camber_text_rings_get(rings).polyline_count == before);
    }
    camber_text_rings_destroy(rings);
    camber_text_destroy(text);
    camber_fonts_destroy(fonts);
    return status;
}

static void test_no_memory(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    each_allocation_fails(&h, add_once, context, NULL);
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_list),         cmocka_unit_test(test_list_of_folder), cmocka_unit_test(test_point),
        cmocka_unit_test(test_nothing),      cmocka_unit_test(test_remove_last),    cmocka_unit_test(test_straight),
        cmocka_unit_test(test_above),        cmocka_unit_test(test_curved),         cmocka_unit_test(test_no_room),
        cmocka_unit_test(test_out_of_range), cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
