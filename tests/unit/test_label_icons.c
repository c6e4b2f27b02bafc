/* The forms of icons: images with a border, stretched where their sprite says so, outlines of distances, and equal
 * forms made once. */
#include "core.h"

#include "map/label_icons.h"

#include <math.h>

enum { SIDE = 8, MANY = 300 };

/* An icon of SIDE x SIDE px: red where x < 4, blue elsewhere. */
static uint8_t two_colors[4 * SIDE * SIDE];

static camber_sprite_image icon_of(uint8_t *rgba, bool sdf) {
    return (camber_sprite_image){.name = "icon",
                                 .width = SIDE,
                                 .height = SIDE,
                                 .pixel_ratio = 1.0,
                                 .sdf = sdf,
                                 .image = {.rgba = rgba, .width = SIDE, .height = SIDE}};
}

static camber_sprite_image make_two_colors(void) {
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        two_colors[4 * i] = i % SIDE < SIDE / 2 ? 255 : 0;
        two_colors[4 * i + 2] = i % SIDE < SIDE / 2 ? 0 : 255;
        two_colors[4 * i + 3] = 255;
    }
    return icon_of(two_colors, false);
}

/* An item that shows an icon, with this size in the picture. px: of the picture per px of the icon, if it is fitted to
 * a text; otherwise 0. */
static camber_label_item item_of(const camber_sprite_image *icon, float width_px, float height_px, float px) {
    return (camber_label_item){
        .glyph = CAMBER_NO_GLYPH, .icon = icon, .xx = width_px, .yy = height_px, .unstretched_px = px};
}

static const camber_icon_form *find(camber_icon_forms *forms, const camber_label_item *item) {
    size_t index = SIZE_MAX;
    assert_int_equal(camber_icon_forms_find(forms, item, &index), CAMBER_OK);
    assert_true(index < forms->count);
    return forms->forms + index;
}

static const uint8_t *px_of(const camber_icon_form *form, size_t x, size_t y) {
    return form->image.rgba + 4 * (y * form->image.width + x);
}

static void test_border(void **state) {
    (void)state;
    host h;
    camber_icon_forms forms = {.context = host_context(&h)};
    const camber_sprite_image icon = make_two_colors();
    const camber_label_item item = item_of(&icon, 20.0f, 20.0f, 0.0f); /* scaled when it is drawn */
    const camber_icon_form *form = find(&forms, &item);
    assert_int_equal(form->width, SIDE);
    assert_int_equal(form->image.width, SIDE + 2);
    assert_int_equal(form->image.height, SIDE + 2);
    for (size_t y = 0; y < SIDE + 2; y++)
        for (size_t x = 0; x < SIDE + 2; x++) {
            const bool outside = x == 0 || y == 0 || x == SIDE + 1 || y == SIDE + 1;
            const uint8_t clear[4] = {0}, red[4] = {255, 0, 0, 255}, blue[4] = {0, 0, 255, 255};
            assert_memory_equal(px_of(form, x, y), outside ? clear : x <= SIDE / 2 ? red : blue, 4);
        }
    camber_context *context = forms.context;
    camber_icon_forms_free(&forms);
    host_done(&h, context);
}

/* Only the zone is stretched: the rest keeps its px. */
static void test_stretched(void **state) {
    (void)state;
    host h;
    camber_icon_forms forms = {.context = host_context(&h)};
    float zone[][2] = {{0.0f, 2.0f}};
    camber_sprite_image icon = make_two_colors();
    icon.stretch_x = zone;
    icon.stretch_x_count = 1;
    const camber_label_item wide = item_of(&icon, 2.0f * 24.0f, 2.0f * SIDE, 2.0f);
    const camber_icon_form *form = find(&forms, &wide);
    assert_int_equal(form->width, 24);
    assert_int_equal(form->height, SIDE);
    size_t red = 0, blue = 0;
    for (size_t x = 1; x <= 24; x++) {
        red += px_of(form, x, 3)[0] == 255;
        blue += px_of(form, x, 3)[2] == 255;
    }
    assert_int_equal(blue, SIDE / 2);
    assert_int_equal(red, 24 - SIDE / 2);
    icon.stretch_x_count = 0; /* the whole side: the colours meet in the middle */
    camber_context *context = forms.context;
    camber_icon_forms_free(&forms);
    forms.context = context;
    form = find(&forms, &wide);
    assert_int_equal(px_of(form, 12, 3)[0] > 128, 1);
    assert_int_equal(px_of(form, 13, 3)[2] > 128, 1);
    camber_icon_forms_free(&forms);
    host_done(&h, context);
}

/* A disc of distances: its outline is where the distance is that of the edge, 192 of 255. */
static void test_distances(void **state) {
    (void)state;
    host h;
    uint8_t rgba[4 * SIDE * SIDE] = {0};
    camber_icon_forms forms = {.context = host_context(&h)};
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        const double x = (double)(i % SIDE) + 0.5 - 4.0, y = (double)(i / SIDE) + 0.5 - 4.0;
        rgba[4 * i + 3] = (uint8_t)fmax(fmin(192.0 + 32.0 * (2.5 - hypot(x, y)), 255.0), 0.0);
    }
    const camber_sprite_image icon = icon_of(rgba, true);
    const camber_label_item item = item_of(&icon, 8.0f, 8.0f, 0.0f);
    const camber_icon_form *form = find(&forms, &item);
    assert_null(form->image.rgba);
    assert_int_equal(form->outline.ring_count, 1);
    for (size_t i = 0; i < form->outline.offsets[1]; i++) {
        const float *p = form->outline.points + 2 * i;
        const double radius = 8.0 * hypot((double)p[0] - 0.5, (double)p[1] - 0.5);
        if (fabs(radius - 2.5) > 0.2)
            fail_msg("a point of the outline is %.3f px from the middle, not 2.5", radius);
    }
    camber_context *context = forms.context;
    camber_icon_forms_free(&forms);
    host_done(&h, context);
}

static void test_once(void **state) {
    (void)state;
    host h;
    camber_icon_forms forms = {.context = host_context(&h)};
    const camber_sprite_image icon = make_two_colors(), other = make_two_colors();
    for (size_t pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < MANY; i++) {
            const camber_label_item item = item_of(i % 2 ? &icon : &other, (float)(1 + i / 2), 8.0f, 1.0f);
            const camber_icon_form *form = find(&forms, &item);
            assert_ptr_equal(form->icon, item.icon);
            assert_int_equal(form->width, 1 + i / 2);
            assert_int_equal(form - forms.forms, i);
        }
        assert_int_equal(forms.count, MANY);
    }
    camber_context *context = forms.context;
    camber_icon_forms_free(&forms);
    host_done(&h, context);
}

static void test_limit(void **state) {
    (void)state;
    host h;
    camber_icon_forms forms = {.context = host_context(&h)};
    const camber_sprite_image icon = make_two_colors();
    const float sides[] = {5000.0f, 1e30f, INFINITY};
    for (size_t i = 0; i < 3; i++) {
        const camber_label_item item = item_of(&icon, sides[i], 8.0f, 1.0f);
        size_t index;
        assert_int_equal(camber_icon_forms_find(&forms, &item, &index), CAMBER_ERROR_LIMIT);
        assert_story(&h, "4096 px");
    }
    const camber_label_item item = item_of(&icon, 16.0f, 8.0f, 1.0f);
    (void)find(&forms, &item); /* goes on */
    assert_int_equal(forms.count, 1);
    camber_context *context = forms.context;
    camber_icon_forms_free(&forms);
    host_done(&h, context);
}

static camber_status find_two(camber_context *context, void *user) {
    camber_icon_forms forms = {.context = context};
    const camber_sprite_image *icons = user;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < 2 && !status; i++) {
        const camber_label_item item = item_of(icons + i, 12.0f, 12.0f, 1.0f);
        size_t index;
        status = camber_icon_forms_find(&forms, &item, &index);
    }
    camber_icon_forms_free(&forms);
    return status;
}

static void test_no_memory(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_sprite_image icons[] = {make_two_colors(), make_two_colors()};
    icons[1].sdf = true;
    each_allocation_fails(&h, find_two, context, icons);
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_border), cmocka_unit_test(test_stretched), cmocka_unit_test(test_distances),
        cmocka_unit_test(test_once),   cmocka_unit_test(test_limit),     cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
