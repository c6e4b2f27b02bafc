/* Labels of a map beside texts that a program places itself: the same glyphs, halos, angles and order, drawn to the
 * same pixels. */
#include "map_picture.h"

enum { SIDE = 160, WORDS = 2 };

/* A point in the middle of the picture; a line through it that turns by a little. At zoom 4 a degree is 22.8 px. */
#define IN_THE_MIDDLE "{\"type\": \"Point\", \"coordinates\": [0, 0]}"
#define EASTWARD "{\"type\": \"LineString\", \"coordinates\": [[-3, 0], [-0.5, 0], [0.5, 0], [3, 0]]}"
#define WESTWARD "{\"type\": \"LineString\", \"coordinates\": [[3, 0], [-3, 0]]}"

typedef struct label_case {
    const char *what, *geometry, *layout, *paint;
    double ratio;
    camber_text_position position;
    float halo_px;
    camber_color color, halo;
    const char *words[WORDS]; /* drawn at the same place, the first one below. NULL: one label */
} label_case;

static const float through[] = {-80.0f, 80.0f, 240.0f, 80.0f};

static const label_case cases[] = {
    {.what = "a point",
     .geometry = IN_THE_MIDDLE,
     .layout = "\"text-size\": 20",
     .paint = "\"text-color\": \"#f00\"",
     .position = {.size_px = 20.0f, .x = 80.0f, .y = 80.0f},
     .color = {1, 0, 0, 1},
     .words = {"Elm"}},
    {.what = "a halo",
     .geometry = IN_THE_MIDDLE,
     .layout = "\"text-size\": 24",
     .paint = "\"text-color\": \"#00f\", \"text-halo-color\": \"rgba(0, 255, 0, 0.5)\", \"text-halo-width\": 3",
     .position = {.size_px = 24.0f, .x = 80.0f, .y = 80.0f},
     .halo_px = 3.0f,
     .color = {0, 0, 1, 1},
     .halo = {0, 1, 0, 0.5f},
     .words = {"Ash"}},
    {.what = "an angle",
     .geometry = IN_THE_MIDDLE,
     .layout = "\"text-size\": 20, \"text-rotate\": 33",
     .paint = "\"text-color\": \"rgba(255, 0, 0, 0.5)\"",
     .position = {.size_px = 20.0f, .x = 80.0f, .y = 80.0f, .turn_deg = 33.0f},
     .color = {1, 0, 0, 0.5f},
     .words = {"Oak"}},
    {.what = "two px per CSS px",
     .geometry = IN_THE_MIDDLE,
     .layout = "\"text-size\": 14",
     .paint = "\"text-color\": \"#000\", \"text-halo-color\": \"#fff\", \"text-halo-width\": 1",
     .ratio = 2.0,
     .position = {.size_px = 28.0f, .x = 160.0f, .y = 160.0f},
     .halo_px = 2.0f,
     .color = {0, 0, 0, 1},
     .halo = {1, 1, 1, 1},
     .words = {"Yew"}},
    {.what = "a line",
     .geometry = EASTWARD,
     .layout = "\"text-size\": 16, \"symbol-placement\": \"line-center\"",
     .paint = "\"text-color\": \"#000\"",
     .position = {.size_px = 16.0f, .points = through, .point_count = 2},
     .color = {0, 0, 0, 1},
     .words = {"Elm Street"}},
    {.what = "a line that runs to the left",
     .geometry = WESTWARD,
     .layout = "\"text-size\": 16, \"symbol-placement\": \"line-center\"",
     .paint = "\"text-color\": \"#000\"",
     .position = {.size_px = 16.0f, .points = through, .point_count = 2},
     .color = {0, 0, 0, 1},
     .words = {"Elm Street"}},
    {.what = "halos below both texts",
     .geometry = IN_THE_MIDDLE,
     .layout = "\"text-size\": 30, \"text-allow-overlap\": true, \"symbol-sort-key\": [\"get\", \"k\"]",
     .paint = "\"text-color\": \"#00f\", \"text-halo-color\": \"#fff\", \"text-halo-width\": 4",
     .position = {.size_px = 30.0f, .x = 80.0f, .y = 80.0f},
     .halo_px = 4.0f,
     .color = {0, 0, 1, 1},
     .halo = {1, 1, 1, 1},
     .words = {"Il", "O"}},
};

static picture draw_map(fixture *s, const label_case *c) {
    char json[4096], features[1024] = "";
    for (size_t i = 0; i < WORDS && c->words[i]; i++)
        snprintf(features + strlen(features), sizeof features - strlen(features),
                 "%s{\"type\": \"Feature\", \"properties\": {\"name\": \"%s\", \"k\": %zu}, \"geometry\": %s}",
                 i ? ", " : "", c->words[i], i, c->geometry);
    snprintf(json, sizeof json,
             "{\"version\": 8, \"zoom\": 4, \"sources\": {\"s\": {\"type\": \"geojson\", \"data\": {\"type\": "
             "\"FeatureCollection\", \"features\": [%s]}}}, \"layers\": [{\"id\": \"l\", \"type\": \"symbol\", "
             "\"source\": \"s\", \"layout\": {\"text-field\": [\"get\", \"name\"], \"text-font\": [\"Noto Sans\"], "
             "%s}, \"paint\": {%s}}]}",
             features, c->layout, c->paint);
    camber_style *style = NULL;
    if (camber_style_parse(s->context, json, strlen(json), "test", &style) != CAMBER_OK)
        fail_msg("%s", s->h.last);
    camber_scene_desc desc = {.view = camber_style_get_view(style)};
    desc.view.width = desc.view.height = SIDE;
    desc.view.ratio = c->ratio;
    map m = {.style = style};
    assert_int_equal(camber_features_create(s->context, style, &m.features), CAMBER_OK);
    const camber_fonts_desc fonts = {.no_system = true};
    assert_int_equal(camber_features_read_fonts(m.features, &fonts, NULL), CAMBER_OK);
    assert_int_equal(camber_features_read_sources(m.features, &desc.view, NULL), CAMBER_OK);
    assert_int_equal(camber_scene_create(m.features, &desc, &m.scene), CAMBER_OK);
    assert_int_equal(camber_scene_get_info(m.scene).labels, c->words[1] ? 2 : 1);
    picture p = map_draw(s, &m);
    map_close(&m);
    return p;
}

static void add_words(camber_fonts *fonts, camber_text_rings *rings, const label_case *c) {
    static const char *const names[] = {"Noto Sans"};
    for (size_t i = 0; i < WORDS && c->words[i]; i++) {
        const camber_text_run run = {
            .text = c->words[i], .size_bytes = strlen(c->words[i]), .fonts = names, .font_count = 1};
        const camber_text_desc desc = {.runs = &run, .run_count = 1};
        camber_text *text = NULL;
        assert_int_equal(camber_text_shape(fonts, &desc, &text), CAMBER_OK);
        assert_int_equal(camber_text_rings_add(rings, text, &c->position, NULL), CAMBER_OK);
        camber_text_destroy(text);
    }
}

static picture draw_texts(fixture *s, const label_case *c) {
    const uint32_t side = (uint32_t)(SIDE * (c->ratio > 0.0 ? c->ratio : 1.0));
    camber_fonts *fonts = NULL;
    camber_text_rings *rings = NULL;
    camber_polylines *polylines = NULL;
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_fonts_create(s->context, &(camber_fonts_desc){.no_system = true}, &fonts), CAMBER_OK);
    assert_int_equal(camber_text_rings_create(fonts, &rings), CAMBER_OK);
    add_words(fonts, rings, c);
    const camber_polylines_desc outlines = camber_text_rings_get(rings);
    const camber_stroke stroke = {.width_px = 2.0f * c->halo_px};
    const camber_tessellation_desc shape = {.strokes = &stroke, .stroke_count = 1};
    assert_int_equal(camber_polylines_create(s->context, &outlines, &polylines), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->on.device, fixture_any(s), &mesh), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate(mesh, polylines, &shape), CAMBER_OK);
    const camber_fill fill = {.color = c->color};
    const camber_paint halo = {.width_px = 2.0f * c->halo_px, .color = c->halo}, text = {.fill = &fill};
    const camber_pass passes[] = {{.mesh = mesh, .paints = &halo, .paint_count = 1},
                                  {.mesh = mesh, .paints = &text, .paint_count = 1}};
    const camber_frame frame = {.width = side, .height = side, .passes = passes, .pass_count = 2};
    picture p = picture_draw(fixture_any(s), &frame);
    camber_mesh_destroy(mesh);
    camber_polylines_destroy(polylines);
    camber_text_rings_destroy(rings);
    camber_fonts_destroy(fonts);
    return p;
}

static void test_beside_placed_texts(void **state) {
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        picture of_map = draw_map(*state, cases + i), of_texts = draw_texts(*state, cases + i);
        picture_assert_near(&of_map, &of_texts, cases[i].what, i, 0.2, 1000);
    }
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_beside_placed_texts)};
    return cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
}
