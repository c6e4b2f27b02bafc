/* line-pattern and background-pattern of styles, from sprites in a folder to pixels. */
#include "pictures.h"
#include "png_file.h"

#include "camber_map.h"

#include <stdio.h>

enum { SIDE = 256 };

/* A folder with a sprite: "a" is 4 x 4 px in columns of red, green, blue and white; "b" is yellow, "tall" 2 x 4 px of a
 * black and a white column; of the large form "a" is twice as large. */
typedef struct folder {
    char path[64], base[96];
} folder;

static const uint8_t column_colors[4][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}};

static void write_sprite(const folder *f, const char *name, uint32_t scale) {
    char path[256], json[512];
    const uint32_t width = 10 * scale, height = 4 * scale;
    uint8_t *rgba = calloc((size_t)width * height, 4);
    assert_non_null(rgba);
    for (uint32_t i = 0; i < width * height; i++) {
        const uint32_t x = i % width / scale;
        uint8_t *px = rgba + 4 * (size_t)i;
        memcpy(px, x < 4 ? column_colors[x] : x < 8 ? (const uint8_t[]){255, 255, 0} : (const uint8_t[]){0, 0, 0}, 3);
        memset(px, x == 9 ? 255 : px[0], 1);
        if (x == 9)
            memset(px, 255, 3);
        px[3] = 255;
    }
    snprintf(path, sizeof path, "%s/%s.png", f->path, name);
    assert_true(png_pixels_write(path, rgba, width, height));
    free(rgba);
    snprintf(json, sizeof json,
             "{\"a\":{\"x\":0,\"y\":0,\"width\":%u,\"height\":%u,\"pixelRatio\":%u},"
             "\"b\":{\"x\":%u,\"y\":0,\"width\":%u,\"height\":%u,\"pixelRatio\":%u,\"sdf\":true},"
             "\"tall\":{\"x\":%u,\"y\":0,\"width\":%u,\"height\":%u,\"pixelRatio\":%u}}",
             4 * scale, 4 * scale, scale, 4 * scale, 4 * scale, 4 * scale, scale, 8 * scale, 2 * scale, 4 * scale,
             scale);
    snprintf(path, sizeof path, "%s/%s.json", f->path, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs(json, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void make_folder(folder *f) {
    strcpy(f->path, "/tmp/camber-patterns-XXXXXX");
    assert_non_null(mkdtemp(f->path));
    snprintf(f->base, sizeof f->base, "%s/style.json", f->path);
    write_sprite(f, "s", 1);
    write_sprite(f, "s@2x", 2);
}

/* ---- Maps ---- */

/* World px at zoom 1 are 360 / 1024 degrees. Two lines over the middle of the map: from 100 px left of it to 100 px
 * right of it along the equator, and from far left to far right 40 px above. */
#define SOURCES                                                                                                        \
    "\"sources\":{\"g\":{\"type\":\"geojson\",\"data\":{\"type\":\"FeatureCollection\",\"features\":["                 \
    "{\"type\":\"Feature\",\"properties\":{\"kind\":\"a\",\"low\":1},\"geometry\":{\"type\":\"LineString\","           \
    "\"coordinates\":[[-35.15625,0],[35.15625,0]]}},"                                                                  \
    "{\"type\":\"Feature\",\"properties\":{\"kind\":\"b\"},\"geometry\":{\"type\":\"LineString\","                     \
    "\"coordinates\":[[-140.625,13.9234],[-20,13.9234],[140.625,13.9234]]}}]}}}"

typedef struct map {
    camber_style *style;
    camber_features *features;
    camber_scene *scene;
    camber_status status;
} map;

static const char *sprite = "s";

static void close_map(map *m) {
    camber_scene_destroy(m->scene);
    camber_features_destroy(m->features);
    camber_style_destroy(m->style);
}

static map open_with(camber_context *context, const char *base, const char *layers, camber_view_desc view) {
    static char json[8192];
    map m = {0};
    snprintf(json, sizeof json, "{\"version\":8,\"sprite\":\"%s\"," SOURCES ",\"layers\":[%s]}", sprite, layers);
    const camber_scene_desc desc = {.view = view};
    m.status = camber_style_parse(context, json, strlen(json), "test", &m.style);
    if (m.status == CAMBER_OK)
        m.status = camber_features_create(context, m.style, &m.features);
    if (m.status == CAMBER_OK && strstr(layers, "symbol"))
        m.status = camber_features_read_fonts(m.features, &(camber_fonts_desc){.no_system = true}, NULL);
    if (m.status == CAMBER_OK)
        m.status = camber_features_read_sources(m.features, &view, base);
    if (m.status == CAMBER_OK)
        m.status = camber_features_read_sprites(m.features, view.ratio, base);
    if (m.status == CAMBER_OK)
        m.status = camber_scene_create(m.features, &desc, &m.scene);
    if (m.status == CAMBER_OK)
        m.status = camber_scene_project(m.scene);
    return m;
}

static camber_view_desc view_at(double zoom) {
    return (camber_view_desc){.kind = CAMBER_VIEW_CENTER, .zoom = zoom, .width = SIDE, .height = SIDE, .ratio = 1};
}

static picture draw(fixture *s, const map *m, size_t *calls) {
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_mesh_create(s->on.device, fixture_any(s), &mesh), CAMBER_OK);
    assert_int_equal(camber_scene_tessellate(m->scene, mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
    const camber_frame frame = camber_scene_get_frame(m->scene, mesh);
    camber_frame_stats stats;
    picture p = {.width = frame.width, .height = frame.height};
    p.rgba = calloc((size_t)p.width * p.height, 4);
    assert_non_null(p.rgba);
    assert_int_equal(camber_renderer_render(fixture_any(s), &frame, picture_rows, &p, &stats), CAMBER_OK);
    if (calls)
        *calls = stats.draw_calls;
    camber_mesh_destroy(mesh);
    return p;
}

static folder *shared;

static picture draw_layers(fixture *s, const char *layers, camber_view_desc view) {
    map m = open_with(s->context, shared->base, layers, view);
    assert_int_equal(m.status, CAMBER_OK);
    picture p = draw(s, &m, NULL);
    close_map(&m);
    return p;
}

#define LINE(paint)                                                                                                    \
    "{\"id\":\"l\",\"type\":\"line\",\"source\":\"g\",\"filter\":[\"has\",\"low\"],\"paint\":{" paint "}}"
#define BOTH(paint) "{\"id\":\"l\",\"type\":\"line\",\"source\":\"g\",\"paint\":{" paint "}}"

/* ---- Lines ---- */

/* The column of "a" that is drawn along the line on the equator. */
static void check_columns(const picture *p, double one_px, double ratio) {
    size_t checked = 0;
    for (uint32_t x = 0; x < p->width; x++) {
        const double along = (x + 0.5 - 0.5 * p->width) / ratio + 100, place = fmod(along, one_px) / one_px * 4;
        if (along < 1 || along > 199 || fabs(place - floor(place) - 0.5) > 0.2)
            continue;
        const uint8_t *px = picture_at(p, x, p->height / 2);
        for (int c = 0; c < 3; c++)
            if (abs(px[c] - column_colors[(int)place][c]) > 54) /* between two columns they mix */
                fail_msg("%g px an image: %u %u %u at %u, not column %d", one_px, px[0], px[1], px[2], x, (int)place);
        checked++;
    }
    assert_true(checked > 50);
}

static void test_line(void **state) {
    picture p = draw_layers(*state, LINE("\"line-width\":16,\"line-pattern\":\"a\""), view_at(1));
    check_columns(&p, 16, 1);
    assert_int_equal(picture_at(&p, 128, 135)[3], 255); /* as wide as the line */
    assert_int_equal(picture_at(&p, 128, 137)[3], 0);
    assert_int_equal(picture_at(&p, 10, 128)[3], 0);
    picture_free(&p);
    camber_view_desc fine = view_at(1);
    fine.ratio = 2;
    p = draw_layers(*state, LINE("\"line-width\":16,\"line-pattern\":\"a\""), fine);
    check_columns(&p, 16, 2);
    picture_free(&p);
    /* The paint that it replaces. */
    p = draw_layers(*state, LINE("\"line-width\":16,\"line-pattern\":\"a\""), view_at(1));
    picture q = draw_layers(*state,
                            LINE("\"line-width\":16,\"line-pattern\":\"a\",\"line-dasharray\":[1,1],"
                                 "\"line-color\":\"rgba(1,2,3,0)\""),
                            view_at(1));
    picture_assert_same(&p, &q);
    picture_free(&q);
    q = draw_layers(*state, LINE("\"line-width\":16,\"line-pattern\":\"a\",\"line-opacity\":0.5"), view_at(1));
    for (size_t i = 0; i < 4 * SIDE * SIDE; i++)
        assert_in_range(abs(p.rgba[i] - 2 * q.rgba[i]), 0, 3);
    picture_free(&q);
    picture_free(&p);
}

/* Between whole zooms the image is that of the zoom below in width, and grows with the map; a step is looked at there.
 */
static void test_zooms(void **state) {
    static const char *const layer =
        LINE("\"line-width\":{\"stops\":[[1,16],[2,32]]},\"line-pattern\":{\"stops\":[[0,\"b\"],[1,\"a\"],[2,\"b\"]]}");
    camber_view_desc view = view_at(1.5);
    map m = open_with(((fixture *)*state)->context, shared->base, layer, view);
    assert_int_equal(m.status, CAMBER_OK);
    picture p = draw(*state, &m, NULL);
    size_t right = 0, wrong = 0;
    for (uint32_t x = 8; x < SIDE - 8; x++) {
        const double along = (x + 0.5 - 128) + 100 * sqrt(2), place = fmod(along, 16 * sqrt(2)) / (16 * sqrt(2)) * 4;
        const uint8_t *px = picture_at(&p, x, 128);
        if (along < 1 || fabs(place - floor(place) - 0.5) > 0.2)
            continue;
        bool same = true;
        for (int c = 0; c < 3; c++)
            same = same && abs(px[c] - column_colors[(int)place][c]) <= 54;
        right += same;
        wrong += !same;
    }
    assert_true(right > 50 && wrong == 0);
    assert_int_equal(picture_at(&p, 128, 128 + 11)[3], 255); /* 24 px wide */
    assert_int_equal(picture_at(&p, 128, 128 + 13)[3], 0);
    picture_free(&p);
    view.zoom = 2.25;
    assert_int_equal(camber_scene_move(m.scene, &view), CAMBER_OK);
    p = draw(*state, &m, NULL);
    assert_memory_equal(picture_at(&p, 128, 128), "\xff\xff\x00\xff", 4);
    picture_free(&p);
    close_map(&m);
    p = draw_layers(*state, LINE("\"line-width\":16,\"line-pattern\":[\"step\",[\"zoom\"],\"b\",1.5,\"a\"]"),
                    view_at(1.9));
    assert_memory_equal(picture_at(&p, 128, 128), "\xff\xff\x00\xff", 4);
    picture_free(&p);
}

/* Each names "b" for the line on the equator, or nothing. */
static void test_expressions(void **state) {
    static const struct {
        const char *pattern;
        bool drawn;
        size_t warnings;
    } cases[] = {
        {"\"b\"", true, 0},
        {"[\"image\",\"b\"]", true, 0},
        {"[\"coalesce\",[\"image\",\"none\"],[\"image\",\"b\"]]", true, 0},
        {"[\"coalesce\",[\"image\",[\"to-string\",[\"get\",\"nothing\"]]],[\"image\",[\"concat\",[\"get\",\"kind\"],"
         "\"x\"]],[\"image\","
         "\"b\"]]",
         true, 0},
        {"[\"coalesce\",[\"image\",\"none\"],[\"image\",\"neither\"]]", false, 1},
        {"[\"match\",[\"get\",\"kind\"],\"a\",\"b\",\"tall\"]", true, 0},
        {"{\"property\":\"kind\",\"type\":\"categorical\",\"stops\":[[\"a\",\"b\"]]}", true, 0},
        {"{\"property\":\"low\",\"type\":\"interval\",\"stops\":[[0,\"a\"],[1,\"b\"]]}", true, 0},
        {"[\"get\",\"nothing\"]", false, 0},
        {"\"{nothing}b\"", true, 0},
        {"\"{kind}\"", true, 0}, /* "a" */
        {"\"\"", false, 0},
        {"\"no such image\"", false, 1},
    };
    fixture *s = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char layer[1024];
        snprintf(layer, sizeof layer, LINE("\"line-width\":16,\"line-pattern\":%s"), cases[i].pattern);
        s->h.warnings = 0;
        picture p = draw_layers(s, layer, view_at(1));
        const uint8_t *px = picture_at(&p, 130, 128);
        if ((px[3] == 255) != cases[i].drawn || s->h.warnings != cases[i].warnings)
            fail_msg("%s: alpha %u, %zu warnings", cases[i].pattern, px[3], (size_t)s->h.warnings);
        if (cases[i].drawn && strcmp(cases[i].pattern, "\"{kind}\"") != 0)
            assert_memory_equal(px, "\xff\xff\x00\xff", 4);
        picture_free(&p);
    }
}

/* Features of different images, one of them missing, are one draw; what is missing is told once, in all views. */
static void test_features(void **state) {
    fixture *s = *state;
    size_t calls = 0;
    map m =
        open_with(s->context, shared->base, BOTH("\"line-width\":16,\"line-pattern\":[\"get\",\"kind\"]"), view_at(1));
    picture p = draw(s, &m, &calls);
    assert_int_equal(calls, 1);
    check_columns(&p, 16, 1);
    assert_memory_equal(picture_at(&p, 128, 88), "\xff\xff\x00\xff", 4);
    picture_free(&p);
    close_map(&m);
    s->h.warnings = 0;
    m = open_with(s->context, shared->base,
                  BOTH("\"line-width\":16,\"line-pattern\":[\"match\",[\"get\",\"kind\"],\"a\",\"a\",\"gone\"]"),
                  view_at(1));
    p = draw(s, &m, &calls);
    check_columns(&p, 16, 1);
    assert_int_equal(picture_at(&p, 128, 88)[3], 0);
    picture_free(&p);
    camber_view_desc view = view_at(2);
    for (int i = 0; i < 3; i++, view.zoom += 0.3)
        assert_int_equal(camber_scene_move(m.scene, &view), CAMBER_OK);
    assert_int_equal(s->h.warnings, 1);
    close_map(&m);
}

/* Another window on the same line: the images stay where they are. */
static void test_windows(void **state) {
    static const char *const layer =
        "{\"id\":\"l\",\"type\":\"line\",\"source\":\"g\",\"filter\":[\"==\",\"kind\",\"b\"],"
        "\"paint\":{\"line-width\":14,\"line-pattern\":\"a\"}}";
    camber_view_desc view = view_at(1);
    map m = open_with(((fixture *)*state)->context, shared->base, layer, view);
    picture p = draw(*state, &m, NULL);
    static const int shifts[] = {1, 37, 150, -90};
    for (size_t i = 0; i < 4; i++) {
        view.longitude = shifts[i] * 360.0 / 1024;
        assert_int_equal(camber_scene_move(m.scene, &view), CAMBER_OK);
        picture q = draw(*state, &m, NULL);
        for (int x = 0; x < SIDE; x++) {
            const int from = x + shifts[i];
            if (from < 0 || from >= SIDE)
                continue;
            for (uint32_t y = 0; y < SIDE; y++)
                for (int c = 0; c < 4; c++)
                    assert_in_range(abs(picture_at(&p, (uint32_t)from, y)[c] - picture_at(&q, (uint32_t)x, y)[c]), 0,
                                    4);
        }
        assert_true(picture_at(&q, 128, 88)[3] == 255);
        picture_free(&q);
    }
    picture_free(&p);
    close_map(&m);
}

/* ---- Backgrounds ---- */

#define BACKGROUND(paint) "{\"id\":\"b\",\"type\":\"background\",\"paint\":{" paint "}}"

/* The world's corner lies whole images away from the middle. */
static void test_background(void **state) {
    camber_view_desc view = view_at(1);
    picture p = draw_layers(*state, BACKGROUND("\"background-pattern\":\"a\""), view);
    for (uint32_t x = 0; x < SIDE; x++)
        for (int c = 0; c < 3; c++)
            assert_in_range(abs(picture_at(&p, x, 77)[c] - column_colors[x % 4][c]), 0, 3);
    picture_free(&p);
    view.bearing_deg = 90; /* east is up */
    p = draw_layers(*state, BACKGROUND("\"background-pattern\":\"a\""), view);
    for (uint32_t y = 0; y < SIDE; y++)
        for (int c = 0; c < 3; c++)
            assert_in_range(abs(picture_at(&p, 33, y)[c] - column_colors[3 - y % 4][c]), 0, 3);
    picture_free(&p);
    view.bearing_deg = 0;
    view.ratio = 2;
    p = draw_layers(*state, BACKGROUND("\"background-pattern\":\"a\",\"background-opacity\":0.5"), view);
    for (uint32_t x = 0; x < 2 * SIDE; x++)
        for (int c = 0; c < 3; c++)
            assert_in_range(abs(2 * picture_at(&p, x, 77)[c] - column_colors[x / 2 % 4][c]), 0, 4);
    picture_free(&p);
    /* One that is missing leaves what lies below. */
    fixture *s = *state;
    s->h.warnings = 0;
    p = draw_layers(s,
                    BACKGROUND("\"background-color\":\"#f00\"") ",{\"id\":\"c\",\"type\":\"background\",\"paint\":{"
                                                                "\"background-pattern\":\"gone\"}}",
                    view_at(1));
    assert_memory_equal(picture_at(&p, 9, 9), "\xff\x00\x00\xff", 4);
    assert_int_equal(s->h.warnings, 1);
    picture_free(&p);
}

/* Between lines, in the style's order. */
static void test_order(void **state) {
    picture p = draw_layers(*state,
                            BACKGROUND("\"background-color\":\"#fff\"") "," LINE(
                                "\"line-width\":20,\"line-color\":\"#f00\"") ",{\"id\":\"v\",\"type\":\"background\","
                                                                             "\"paint\":{\"background-pattern\":\"b\","
                                                                             "\"background-opacity\":0.5}},"
                                                                             "{\"id\":\"t\",\"type\":\"line\","
                                                                             "\"source\":\"g\",\"paint\":{\"line-"
                                                                             "width\":8,\"line-color\":\"#00f\"}}",
                            view_at(1));
    const uint8_t *over_white = picture_at(&p, 5, 5), *over_red = picture_at(&p, 128, 136),
                  *blue = picture_at(&p, 128, 128);
    assert_true(over_white[0] == 255 && over_white[1] == 255 && abs(over_white[2] - 128) <= 1);
    assert_true(over_red[0] == 255 && abs(over_red[1] - 128) <= 1 && over_red[2] == 0);
    assert_true(blue[0] == 0 && blue[2] == 255);
    picture_free(&p);
}

/* ---- Sprites ---- */

static void test_sprites(void **state) {
    fixture *s = *state;
    static const char *const layer = LINE("\"line-width\":16,\"line-pattern\":\"a\""), *const plain =
                                                                                           LINE("\"line-width\":16");
    sprite = "https://example.org/sprite";
    s->h.errors = 0;
    s->h.warnings = 0;
    picture p = draw_layers(s, layer, view_at(1));
    assert_int_equal(picture_at(&p, 128, 128)[3], 0);
    assert_int_equal(s->h.warnings, 2); /* the sprite, and its image */
    picture_free(&p);
    s->h.warnings = 0;
    p = draw_layers(s, plain, view_at(1)); /* nothing of it is wanted */
    assert_int_equal(s->h.warnings, 0);
    picture_free(&p);
    sprite = "not-there";
    map m = open_with(s->context, shared->base, layer, view_at(1));
    assert_int_equal(m.status, CAMBER_ERROR_NOT_FOUND);
    assert_story(&s->h, "not-there.png: no such file");
    close_map(&m);
    sprite = "s";
    /* Not read at all. */
    m = open_with(s->context, shared->base, plain, view_at(1));
    close_map(&m);
    s->h.warnings = 0;
    const char *json = "{\"version\":8,\"layers\":[" BACKGROUND("\"background-pattern\":\"a\"") "]}";
    m = (map){0};
    assert_int_equal(camber_style_parse(s->context, json, strlen(json), "test", &m.style), CAMBER_OK);
    assert_int_equal(camber_features_create(s->context, m.style, &m.features), CAMBER_OK);
    const camber_scene_desc desc = {.view = view_at(1)};
    assert_int_equal(camber_scene_create(m.features, &desc, &m.scene), CAMBER_OK);
    assert_int_equal(s->h.warnings, 1);
    close_map(&m);
}

/* ---- Icons ---- */

#define SYMBOLS(id, kind, layout)                                                                                      \
    "{\"id\":\"" id "\",\"type\":\"symbol\",\"source\":\"g\",\"filter\":[\"==\",\"kind\",\"" kind "\"],\"layout\":{"   \
    "\"symbol-placement\":\"line-center\"," layout "}}"

/* Icons are drawn as they are, whatever labels are below them. */
static void test_icons(void **state) {
    static const char icons[] = SYMBOLS("i", "a", "\"icon-image\":\"a\",\"icon-size\":4");
    static const char texts_below[] =
        SYMBOLS("t", "b", "\"text-field\":\"below\"") "," SYMBOLS("i", "a", "\"icon-image\":\"a\",\"icon-size\":4");
    picture alone = draw_layers(*state, icons, view_at(1)), above = draw_layers(*state, texts_below, view_at(1));
    size_t inked = 0;
    for (uint32_t x = 0; x < SIDE; x++)
        for (uint32_t y = 0; y < SIDE; y++)
            inked += y < 100 && picture_at(&above, x, y)[3] == 255;
    assert_true(inked > 10); /* the text */
    for (int column = 1; column < 3; column++) {
        const uint8_t *a = picture_at(&alone, (uint32_t)(122 + 4 * column), 128);
        assert_memory_equal(a, picture_at(&above, (uint32_t)(122 + 4 * column), 128), 4);
        assert_int_equal(a[3], 255);
    }
    picture_free(&alone);
    picture_free(&above);
}

static camber_status try_map(camber_context *context, void *user) {
    const char *layers = user;
    map m = open_with(context, shared->base, layers, view_at(1));
    if (m.status == CAMBER_OK)
        (void)camber_scene_get_frame(m.scene, NULL);
    close_map(&m);
    return m.status;
}

static void test_memory(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    each_allocation_fails(&h, try_map, context,
                          BOTH("\"line-width\":16,\"line-pattern\":[\"get\",\"kind\"]") "," BACKGROUND(
                              "\"background-pattern\":\"tall\"") ",{\"id\":\"c\",\"type\":\"background\",\"paint\":{"
                                                                 "\"background-pattern\":\"gone\"}}");
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_line),     cmocka_unit_test(test_zooms),   cmocka_unit_test(test_expressions),
        cmocka_unit_test(test_features), cmocka_unit_test(test_windows), cmocka_unit_test(test_background),
        cmocka_unit_test(test_order),    cmocka_unit_test(test_sprites), cmocka_unit_test(test_icons),
        cmocka_unit_test(test_memory),
    };
    static folder f;
    if (!fixture_begin())
        return 77;
    make_folder(&f);
    shared = &f;
    const int failed = cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
    folder_remove(f.path);
    return failed;
}
