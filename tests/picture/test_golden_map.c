/* Golden pictures of a map: a crossing in Santa Cruz and houses of Monaco, each from its file through the built-in
 * style. The picture that README.md shows is drawn again, too. */
#include "golden.h"
#include "png_file.h"

#include "camber_map.h"

#include <math.h>

typedef struct place {
    const char *path;
    camber_view_desc view;
    bool labels;
} place;

static const place CROSSING = {CAMBER_TEST_DATA "/santa_cruz/osm.mbtiles",
                               {CAMBER_VIEW_CENTER, .longitude = -122.0268, .latitude = 36.9735, .zoom = 15.8,
                                .width = 300, .height = 200, .ratio = 1.25}};
/* Gardens, houses with outlines, a tunnel under one, and the sea. */
static const place GARDENS = {CAMBER_TEST_DATA "/monaco/monaco.osm.pbf",
                              {CAMBER_VIEW_CENTER, .longitude = 7.4291, .latitude = 43.7394, .zoom = 15.6, .width = 240,
                               .height = 160, .ratio = 1.25}};
/* As ./dev demo shows it. */
static const place DEMO = {
    CAMBER_TEST_DATA "/monaco/monaco.osm.pbf",
    {CAMBER_VIEW_CENTER, .longitude = 7.4235, .latitude = 43.7365, .zoom = 15.1, .width = 1000, .height = 640},
    .labels = true};

static camber_scene *load(camber_context *context, const place *shown, camber_theme theme, camber_style **style,
                          camber_features **features) {
    camber_scene *map = NULL;
    const camber_source_desc source = {.path = shown->path};
    const camber_scene_desc desc = {.view = shown->view, .simplify_px = 0.1};
    assert_int_equal(camber_style_create_builtin(context, theme, style), CAMBER_OK);
    assert_int_equal(camber_features_create(context, *style, features), CAMBER_OK);
    if (shown->labels)
        assert_int_equal(camber_features_read_fonts(*features, &(camber_fonts_desc){.no_system = true}, NULL),
                         CAMBER_OK);
    assert_int_equal(camber_features_read(*features, &source), CAMBER_OK);
    assert_int_equal(camber_scene_create(*features, &desc, &map), CAMBER_OK);
    return map;
}

static void draw_place(void **state, const place *shown, const char *name, camber_theme theme) {
    const fixture *s = *state;
    camber_style *style = NULL;
    camber_features *features = NULL;
    camber_scene *map = load(s->context, shown, theme, &style, &features);
    bool good = true;
    for (int b = 0; b < CAMBER_FIXTURE_DRAWERS && good; b++) {
        if (!s->on.renderer[b])
            continue;
        camber_mesh *mesh = NULL;
        assert_int_equal(camber_mesh_create(s->on.device, s->on.renderer[b], &mesh), CAMBER_OK);
        /* Once more after the view was elsewhere. */
        for (int round = 0; round < 2 && good; round++) {
            assert_int_equal(camber_scene_tessellate(map, mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
            const camber_frame frame = camber_scene_get_frame(map, mesh);
            picture drawn = picture_draw(s->on.renderer[b], &frame);
            good = golden_judge(s, name, &drawn);
            if (!good)
                printf("%s: not as it should be with %s, round %d\n", name, fixture_name(b), round);
            picture_free(&drawn);
            const camber_view_desc elsewhere = {CAMBER_VIEW_CENTER, .longitude = -122.03, .latitude = 36.97,
                                                .zoom = 11.3, .bearing_deg = 40};
            assert_int_equal(camber_scene_move(map, &elsewhere), CAMBER_OK);
            assert_int_equal(camber_scene_tessellate(map, mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
            assert_int_equal(camber_scene_move(map, &shown->view), CAMBER_OK);
        }
        camber_mesh_destroy(mesh);
    }
    camber_scene_destroy(map);
    camber_features_destroy(features);
    camber_style_destroy(style);
    assert_true(good);
}

static void test_light(void **state) {
    draw_place(state, &CROSSING, "santa-cruz-light", CAMBER_THEME_LIGHT);
    draw_place(state, &GARDENS, "monaco-light", CAMBER_THEME_LIGHT);
}

static void test_dark(void **state) {
    draw_place(state, &CROSSING, "santa-cruz-dark", CAMBER_THEME_DARK);
    draw_place(state, &GARDENS, "monaco-dark", CAMBER_THEME_DARK);
}

/* Draws a scene's network. false: the back end is not here. */
static bool draw_scene(const fixture *s, int backend, camber_scene *map, picture *drawn) {
    camber_mesh *mesh = NULL;
    if (!s->on.renderer[backend])
        return false;
    assert_int_equal(camber_mesh_create(s->on.device, s->on.renderer[backend], &mesh), CAMBER_OK);
    assert_int_equal(camber_scene_tessellate(map, mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
    const camber_frame frame = camber_scene_get_frame(map, mesh);
    *drawn = picture_draw(s->on.renderer[backend], &frame);
    camber_mesh_destroy(mesh);
    return true;
}

/* Text of 10, 12 and 16 px in the scripts of the shipped font, dark on light with halos and light on dark; along a
 * line, and turned with a blurred halo. */
static void test_words(void **state) {
    const fixture *s = *state;
    const camber_scene_desc desc = {.view = {CAMBER_VIEW_CENTER, .zoom = 10, .width = 260, .height = 180},
                                    .simplify_px = 0.1};
    camber_style *style = NULL;
    camber_features *features = NULL;
    camber_scene *map = NULL;
    bool good = true;
    char words[8192];
    FILE *file = fopen(CAMBER_TEST_DATA "/styles/words.json", "r");
    assert_non_null(file);
    assert_int_equal(camber_style_parse(s->context, words, fread(words, 1, sizeof words, file), "words", &style),
                     CAMBER_OK);
    fclose(file);
    assert_int_equal(camber_features_create(s->context, style, &features), CAMBER_OK);
    assert_int_equal(camber_features_read_fonts(features, &(camber_fonts_desc){.no_system = true}, NULL), CAMBER_OK);
    assert_int_equal(camber_features_read_sources(features, &desc.view, NULL), CAMBER_OK);
    assert_int_equal(camber_scene_create(features, &desc, &map), CAMBER_OK);
    assert_int_equal(camber_scene_get_info(map).labels, 8);
    for (int b = 0; b < CAMBER_FIXTURE_DRAWERS && good; b++) {
        picture drawn;
        if (!draw_scene(s, b, map, &drawn))
            continue;
        good = golden_judge(s, "words", &drawn);
        if (!good)
            printf("words: not as they should be with %s\n", fixture_name(b));
        picture_free(&drawn);
    }
    camber_scene_destroy(map);
    camber_features_destroy(features);
    camber_style_destroy(style);
    assert_true(good);
}

/* The file has 256 colours, and no pixel is far from what is drawn. */
static void test_demo(void **state) {
    const fixture *s = *state;
    const png_pixels file = png_pixels_read(CAMBER_TEST_DATA "/monaco/monaco.png");
    const picture shown = {.width = file.width, .height = file.height, .rgba = file.rgba};
    camber_style *style = NULL;
    camber_features *features = NULL;
    camber_scene *map = load(s->context, &DEMO, CAMBER_THEME_LIGHT, &style, &features);
    assert_non_null(file.rgba);
    for (int b = 0; b < CAMBER_FIXTURE_DRAWERS; b++) {
        picture drawn;
        if (!draw_scene(s, b, map, &drawn))
            continue;
        const difference apart = picture_compare(&drawn, &shown);
        printf("# the demo with %s: %.4f of 255 on average, %d at most, %zu pixels past 8\n", fixture_name(b),
               apart.mean, apart.most, apart.past_8);
        assert_true(apart.mean < 1 && apart.past_8 <= apart.drawn / 50);
        picture_free(&drawn);
    }
    camber_scene_destroy(map);
    camber_features_destroy(features);
    camber_style_destroy(style);
    free(file.rgba);
}

static size_t polylines_of(camber_scene *map, camber_mesh *mesh) {
    const camber_frame frame = camber_scene_get_frame(map, mesh);
    size_t count = 0;
    for (size_t i = 0; i < frame.pass_count; i++)
        count += frame.passes[i].polyline_count;
    return count;
}

/* A view that moves and zooms while the same classes are drawn keeps its network, which the mesh then still holds. */
static void test_moves(void **state) {
    const fixture *s = *state;
    camber_style *style = NULL;
    camber_features *features = NULL;
    camber_scene *map = load(s->context, &CROSSING, CAMBER_THEME_LIGHT, &style, &features);
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_mesh_create(s->on.device, NULL, &mesh), CAMBER_OK);
    assert_int_equal(camber_scene_project(map), CAMBER_OK); /* the mesh holds no network yet */
    const size_t pieces = polylines_of(map, mesh);
    assert_int_equal(camber_scene_tessellate(map, mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
    const size_t entries = polylines_of(map, mesh);
    assert_true(entries > pieces); /* by entries, seen or not */
    camber_view_desc view = CROSSING.view;
    view.longitude += 1e-4;
    view.zoom += 0.05;
    view.bearing_deg = 3;
    assert_int_equal(camber_scene_move(map, &view), CAMBER_OK);
    assert_int_equal(polylines_of(map, mesh), entries);
    view.zoom -= 0.4;
    assert_int_equal(camber_scene_move(map, &view), CAMBER_OK);
    assert_int_equal(polylines_of(map, mesh), entries);
    view.zoom = 6; /* fewer classes are drawn, which need another network */
    assert_int_equal(camber_scene_move(map, &view), CAMBER_OK);
    assert_int_equal(camber_scene_tessellate(map, mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
    assert_true(polylines_of(map, mesh) < entries);
    view.longitude = 180; /* copies of the world need another network of the same plan; nothing is seen of it */
    assert_int_equal(camber_scene_move(map, &view), CAMBER_OK);
    assert_int_equal(camber_scene_project(map), CAMBER_OK); /* the mesh holds another network */
    assert_int_equal(polylines_of(map, mesh), 0);
    view.zoom = 100;
    assert_int_equal(camber_scene_move(map, &view), CAMBER_ERROR_ARGUMENT);
    assert_true(fabs(camber_scene_get_info(map).zoom - 6) < 1e-9); /* as before */
    assert_int_equal(camber_scene_tessellate(map, mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
    camber_mesh_destroy(mesh);
    camber_scene_destroy(map);
    camber_features_destroy(features);
    camber_style_destroy(style);
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_light), cmocka_unit_test(test_dark),
                                       cmocka_unit_test(test_demo), cmocka_unit_test(test_words),
                                       cmocka_unit_test(test_moves)};
    const int failed = cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
    return failed;
}
