/* Sprites: what their sheets and indices hold, and those that lie about it. */
#include "core.h"
#include "png_file.h"

#include "features/features.h"
#include "style/sprite.h"

typedef struct desk {
    host h;
    camber_context *context;
    camber_style *style;
    char folder[64], base[96];
} desk;

static void write_file(const desk *d, const char *name, const void *bytes, size_t size) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s", d->folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* Columns of red, half green, clear; side px high. */
static void write_sheet(const desk *d, const char *name, uint32_t side) {
    char path[256];
    uint8_t *rgba = calloc((size_t)3 * side * side, 4);
    assert_non_null(rgba);
    for (size_t i = 0; i < (size_t)3 * side * side; i++) {
        const size_t column = i % (3 * side) / side;
        memcpy(rgba + 4 * i,
               column == 0   ? "\xff\x00\x00\xff"
               : column == 1 ? "\x00\xff\x00\x80"
                             : "\x40\x40\x40\x00",
               4);
    }
    snprintf(path, sizeof path, "%s/%s", d->folder, name);
    assert_true(png_pixels_write(path, rgba, 3 * side, side));
    free(rgba);
}

static void write_index(const desk *d, const char *name, const char *json) {
    write_file(d, name, json, strlen(json));
}

static void open_desk(desk *d, const char *sprite) {
    char json[512];
    memset(d, 0, sizeof *d);
    d->context = host_context(&d->h);
    strcpy(d->folder, "/tmp/camber-sprite-XXXXXX");
    assert_non_null(mkdtemp(d->folder));
    snprintf(d->base, sizeof d->base, "%s/style.json", d->folder);
    snprintf(json, sizeof json, "{\"version\": 8, \"sprite\": %s, \"layers\": []}", sprite);
    assert_int_equal(camber_style_parse(d->context, json, strlen(json), "test", &d->style), CAMBER_OK);
}

static void close_desk(desk *d) {
    camber_style_destroy(d->style);
    folder_remove(d->folder);
    host_done(&d->h, d->context);
}

static const char *const good = "{\"b\": {\"x\": 4, \"y\": 0, \"width\": 4, \"height\": 4, \"pixelRatio\": 1},"
                                " \"a\": {\"x\": 0, \"y\": 1, \"width\": 4, \"height\": 3, \"sdf\": true}, \"dot\": "
                                "{\"x\": 11, \"y\": 3, \"width\": 1, \"height\": 1}}";

static void test_sheet_and_index(void **state) {
    (void)state;
    desk d;
    camber_sprites *sprites = NULL;
    open_desk(&d, "\"sheet\"");
    write_sheet(&d, "sheet.png", 4);
    write_index(&d, "sheet.json", good);
    assert_int_equal(camber_sprites_load(d.context, d.style, d.base, 2, &sprites), CAMBER_OK); /* without @2x */
    assert_int_equal(sprites->image_count, 3);
    const camber_sprite_image *a = camber_sprites_find(sprites, "a"), *b = camber_sprites_find(sprites, "b");
    assert_true(a && b && camber_sprites_find(sprites, "dot"));
    assert_null(camber_sprites_find(sprites, "c"));
    assert_null(camber_sprites_find(sprites, ""));
    assert_true(a->y == 1 && a->width == 4 && a->height == 3 && a->sdf && a->pixel_ratio >= 1 && a->pixel_ratio <= 1);
    assert_true(b->x == 4 && !b->sdf);
    const camber_sprite_sheet *sheet = sprites->sheets + b->sheet;
    assert_true(sheet->width == 12 && sheet->height == 4);
    assert_memory_equal(sheet->rgba + 4 * b->x, "\x00\x80\x00\x80", 4); /* premultiplied */
    assert_memory_equal(sheet->rgba + 4 * 8, "\x00\x00\x00\x00", 4);
    camber_sprites_destroy(sprites);
    write_sheet(&d, "sheet@2x.png", 8);
    write_index(&d, "sheet@2x.json", "{\"b\": {\"x\": 8, \"y\": 0, \"width\": 8, \"height\": 8, \"pixelRatio\": 2}}");
    assert_int_equal(camber_sprites_load(d.context, d.style, d.base, 1.5, &sprites), CAMBER_OK);
    assert_int_equal(sprites->image_count, 1);
    assert_true(sprites->images[0].pixel_ratio >= 2 && sprites->sheets[0].width == 24);
    camber_sprites_destroy(sprites);
    assert_int_equal(camber_sprites_load(d.context, d.style, d.base, 1, &sprites), CAMBER_OK);
    assert_int_equal(sprites->image_count, 3);
    camber_sprites_destroy(sprites);
    close_desk(&d);
}

static bool same(float a, float b) {
    return a >= b && a <= b;
}

/* How a text is fitted into an image. */
static void test_fit(void **state) {
    (void)state;
    desk d;
    camber_sprites *sprites = NULL;
    open_desk(&d, "\"s\"");
    write_sheet(&d, "s.png", 4);
    write_index(&d, "s.json",
                "{\"a\": {\"x\": 0, \"y\": 0, \"width\": 8, \"height\": 4, \"stretchX\": [[1, 2.5], [4, 6]], "
                "\"stretchY\": [[0, 4]], \"content\": [1, 0.5, 7, 3]}, \"b\": {\"x\": 0, \"y\": 0, \"width\": 3, "
                "\"height\": 2, \"stretchX\": []}}");
    assert_int_equal(camber_sprites_load(d.context, d.style, d.base, 1, &sprites), CAMBER_OK);
    const camber_sprite_image *a = camber_sprites_find(sprites, "a"), *b = camber_sprites_find(sprites, "b");
    assert_int_equal(a->stretch_x_count, 2);
    assert_true(same(a->stretch_x[0][1], 2.5f) && same(a->stretch_x[1][0], 4.0f));
    assert_true(a->stretch_y_count == 1 && same(a->stretch_y[0][1], 4.0f));
    assert_true(a->has_content && same(a->content[0], 1.0f) && same(a->content[1], 0.5f) && same(a->content[2], 7.0f) &&
                same(a->content[3], 3.0f));
    assert_true(!b->has_content && b->stretch_x_count == 0 && b->stretch_y_count == 0);
    assert_true(same(b->content[0], 0.0f) && same(b->content[2], 3.0f) && same(b->content[3], 2.0f));
    camber_sprites_destroy(sprites);
    close_desk(&d);
}

static void test_several(void **state) {
    (void)state;
    desk d;
    camber_sprites *sprites = NULL;
    open_desk(&d, "[{\"id\": \"default\", \"url\": \"one\"}, {\"id\": \"more\", \"url\": \"two\"}]");
    write_sheet(&d, "one.png", 4);
    write_index(&d, "one.json", good);
    write_sheet(&d, "two.png", 5);
    write_index(&d, "two.json", "{\"a\": {\"x\": 0, \"y\": 0, \"width\": 15, \"height\": 5}}");
    assert_int_equal(camber_sprites_load(d.context, d.style, d.base, 1, &sprites), CAMBER_OK);
    assert_int_equal(camber_sprites_find(sprites, "a")->width, 4);
    assert_int_equal(camber_sprites_find(sprites, "more:a")->width, 15);
    assert_int_equal(camber_sprites_find(sprites, "more:a")->sheet, 1);
    camber_sprites_destroy(sprites);
    close_desk(&d);
}

/* Each a sheet (NULL: one of 12 x 4 px), an index and what is said. */
static void test_lies(void **state) {
    (void)state;
    static const struct {
        const char *sheet, *index, *said;
    } lies[] = {
        {NULL, "{\"a\": {\"x\": 9, \"y\": 0, \"width\": 4, \"height\": 4}}", "outside its sheet of 12 x 4 px"},
        {NULL, "{\"a\": {\"x\": 0, \"y\": 1, \"width\": 4, \"height\": 4}}", "outside its sheet"},
        {NULL, "{\"a\": {\"x\": 16384, \"y\": 0, \"width\": 16384, \"height\": 1}}", "outside its sheet"},
        {NULL, "{\"a\": {\"x\": -1, \"y\": 0, \"width\": 4, \"height\": 4}}", "whole pixels"},
        {NULL, "{\"a\": {\"x\": 4294967296, \"y\": 0, \"width\": 4, \"height\": 4}}", "whole pixels"},
        {NULL, "{\"a\": {\"x\": 0.5, \"y\": 0, \"width\": 4, \"height\": 4}}", "whole pixels"},
        {NULL, "{\"a\": {\"x\": \"0\", \"y\": 0, \"width\": 4, \"height\": 4}}", "whole pixels"},
        {NULL, "{\"a\": {\"x\": 0, \"y\": 0, \"width\": 4, \"height\": 4, \"pixelRatio\": 0}}", "pixelRatio"},
        {NULL, "{\"a\": {\"x\": 0, \"y\": 0, \"width\": 4, \"height\": 4, \"pixelRatio\": \"2\"}}", "pixelRatio"},
        {NULL, "{\"a\": {\"x\": 0, \"y\": 0, \"width\": 0, \"height\": 4}}", "at least 1"},
        {NULL, "{\"a\": {\"x\": 0, \"y\": 0, \"width\": 4, \"height\": -4}}", "at least 1"},
        {NULL, "{\"a\": {\"x\": 0, \"y\": 0, \"width\": 4}}", "at least 1"},
        {NULL, "{\"a\": {\"x\": 0, \"y\": 0, \"width\": 1e300, \"height\": 4}}", "at least 1"},
        {NULL, "{\"a\": {\"x\": 0, \"y\": 0, \"width\": 4, \"height\": 4, \"pixelRatio\": 1e-300}}", "pixelRatio"},
        {NULL, "{\"a\": {\"x\": 0, \"y\": 0, \"width\": 4, \"height\": 4, \"pixelRatio\": -1}}", "pixelRatio"},
#define SMALL(more) "{\"a\": {\"x\": 0, \"y\": 0, \"width\": 4, \"height\": 4, " more "}}"
        {NULL, SMALL("\"stretchX\": 3"), "lists of [from, to]"},
        {NULL, SMALL("\"stretchX\": [3]"), "lists of [from, to]"},
        {NULL, SMALL("\"stretchX\": [[3, 2]]"), "lists of [from, to]"},
        {NULL, SMALL("\"stretchY\": [[1, 5]]"), "lists of [from, to]"},
        {NULL, SMALL("\"stretchY\": [[1, 3], [2, 4]]"), "lists of [from, to]"},
        {NULL, SMALL("\"content\": [0, 0, 4]"), "lists of [from, to]"},
        {NULL, SMALL("\"content\": [0, 0, 4, 5]"), "lists of [from, to]"},
        {NULL, SMALL("\"content\": [0, -1, 4, 4]"), "lists of [from, to]"},
        {NULL, SMALL("\"content\": [0, null, 4, 4]"), "lists of [from, to]"},
#undef SMALL
        {NULL, "{\"a\": 7}", "at least 1"},
        {NULL, "{\"a\": {\"x\": NaN, \"y\": 0, \"width\": 4, \"height\": 4}}", "line 1, column"},
        {NULL, "[1]", "an object of images"},
        {NULL, "{\"a\": ", "line 1, column"},
        {"", "{}", "not a PNG"},
        {"\x89PNG\r\n\x1a\n", "{}", "not a PNG"},
        {"GIF89a and what comes behind", "{}", "not a PNG"},
    };
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        desk d;
        camber_sprites *sprites = NULL;
        open_desk(&d, "\"s\"");
        if (lies[i].sheet)
            write_file(&d, "s.png", lies[i].sheet, strlen(lies[i].sheet));
        else
            write_sheet(&d, "s.png", 4);
        write_index(&d, "s.json", lies[i].index);
        assert_int_equal(camber_sprites_load(d.context, d.style, d.base, 1, &sprites), CAMBER_ERROR_INPUT);
        assert_story(&d.h, lies[i].said);
        assert_null(sprites);
        close_desk(&d);
    }
}

/* A PNG whose head claims more than its data, and one that is too large to be true. */
static void test_false_sizes(void **state) {
    (void)state;
    desk d;
    camber_sprites *sprites = NULL;
    char path[256];
    uint8_t bytes[4096];
    open_desk(&d, "\"s\"");
    write_sheet(&d, "s.png", 4);
    write_index(&d, "s.json", "{}");
    snprintf(path, sizeof path, "%s/s.png", d.folder);
    FILE *file = fopen(path, "rb");
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    write_file(&d, "s.png", bytes, size - 20); /* cut off */
    assert_int_equal(camber_sprites_load(d.context, d.style, d.base, 1, &sprites), CAMBER_ERROR_INPUT);
    assert_story(&d.h, "get the sprite again");
    bytes[18] = 0x7f; /* the width, and its sum with it */
    write_file(&d, "s.png", bytes, size);
    assert_int_not_equal(camber_sprites_load(d.context, d.style, d.base, 1, &sprites), CAMBER_OK);
    assert_story(&d.h, NULL);
    close_desk(&d);
    open_desk(&d, "\"none\"");
    assert_int_equal(camber_sprites_load(d.context, d.style, d.base, 2, &sprites), CAMBER_ERROR_NOT_FOUND);
    assert_story(&d.h, "none.png: no such file");
    close_desk(&d);
    open_desk(&d, "\"https://example.org/sprite\"");
    assert_int_equal(camber_sprites_load(d.context, d.style, d.base, 1, &sprites), CAMBER_OK);
    assert_int_equal(sprites->image_count, 0);
    assert_int_equal(d.h.warnings, 1);
    camber_sprites_destroy(sprites);
    close_desk(&d);
    open_desk(&d, "\"gopher://example.org/sprite\"");
    assert_int_equal(camber_sprites_load(d.context, d.style, d.base, 1, &sprites), CAMBER_ERROR_INPUT);
    assert_story(&d.h, "gopher");
    close_desk(&d);
}

/* Sprites are read where a layer that is seen has a pattern. */
static void test_wanted(void **state) {
    (void)state;
    static const struct {
        const char *layer;
        bool wanted;
    } cases[] = {
        {"\"type\": \"line\", \"paint\": {\"line-pattern\": \"a\"}", true},
        {"\"type\": \"fill\", \"paint\": {\"fill-pattern\": \"a\"}", true},
        {"\"type\": \"background\", \"paint\": {\"background-pattern\": \"a\"}", true},
        {"\"type\": \"fill\", \"paint\": {\"fill-color\": \"red\"}", false},
        {"\"type\": \"fill\", \"layout\": {\"visibility\": \"none\"}, \"paint\": {\"fill-pattern\": \"a\"}", false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        desk d;
        char json[512];
        camber_features *features = NULL;
        open_desk(&d, "\"sheet\"");
        write_sheet(&d, "sheet.png", 4);
        write_index(&d, "sheet.json", good);
        camber_style_destroy(d.style);
        snprintf(json, sizeof json, "{\"version\": 8, \"sprite\": \"sheet\", \"layers\": [{\"id\": \"a\", %s}]}",
                 cases[i].layer);
        assert_int_equal(camber_style_parse(d.context, json, strlen(json), "test", &d.style), CAMBER_OK);
        assert_int_equal(camber_features_create(d.context, d.style, &features), CAMBER_OK);
        assert_int_equal(camber_features_read_sprites(features, 1, d.base), CAMBER_OK);
        if ((features->sprites != NULL) != cases[i].wanted)
            fail_msg("sprites for %s: %d", cases[i].layer, !cases[i].wanted);
        camber_features_destroy(features);
        close_desk(&d);
    }
}

static camber_status attempt(camber_context *context, void *user) {
    const desk *d = user;
    camber_sprites *sprites = NULL;
    const camber_status status = camber_sprites_load(context, d->style, d->base, 1, &sprites);
    camber_sprites_destroy(sprites);
    return status;
}

static void test_memory(void **state) {
    (void)state;
    desk d;
    open_desk(&d, "\"sheet\"");
    write_sheet(&d, "sheet.png", 4);
    write_index(&d, "sheet.json", good);
    each_allocation_fails(&d.h, attempt, d.context, &d);
    close_desk(&d);
}

/* The sprite of the styles that ship needs no files. Its signs are signed distances: inside in the middle, outside at
 * the corners. */
static void test_signs(void **state) {
    (void)state;
    static const char *const names[] = {"box", "dot", "square", "triangle"};
    desk d;
    camber_sprites *sprites = NULL;
    open_desk(&d, "\"camber:signs\"");
    assert_int_equal(camber_sprites_load(d.context, d.style, d.base, 2, &sprites), CAMBER_OK);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const camber_sprite_image *image = camber_sprites_find(sprites, names[i]);
        assert_non_null(image);
        assert_true(image->sdf && image->pixel_ratio > 1.0);
        const uint8_t *rgba = image->image.rgba;
        const size_t middle = image->height / 2 * image->image.stride_bytes + (size_t)4 * (image->width / 2);
        assert_true(rgba[3] < 128 && rgba[middle + 3] > 192);
    }
    assert_true(camber_sprites_find(sprites, "box")->stretch_x_count == 1);
    assert_true(camber_sprites_find(sprites, "box")->has_content);
    each_allocation_fails(&d.h, attempt, d.context, &d);
    camber_sprites_destroy(sprites);
    close_desk(&d);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sheet_and_index),
                                       cmocka_unit_test(test_several),
                                       cmocka_unit_test(test_fit),
                                       cmocka_unit_test(test_lies),
                                       cmocka_unit_test(test_false_sizes),
                                       cmocka_unit_test(test_wanted),
                                       cmocka_unit_test(test_signs),
                                       cmocka_unit_test(test_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
