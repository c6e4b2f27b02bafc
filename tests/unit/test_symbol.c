/* Symbol layers: what camber_layer_look_symbol makes of layout and paint, with values worked out by hand. */
#include "style/symbol.h"

#include "style/expression.h"
#include "style/json.h"
#include "style/properties.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { PROPERTIES_MAX = 16 };

typedef struct fixture {
    camber_context *context;
    camber_style *style;
    camber_arena arena, data; /* of symbols, and of features */
    camber_value values[PROPERTIES_MAX], all;
    char message[4096]; /* the last error or warning */
    size_t message_count;
    size_t blocks, allocations_left;
} fixture;

static void keep_message(void *user, camber_log_level level, const char *message) {
    fixture *f = user;
    if (level != CAMBER_LOG_ERROR && level != CAMBER_LOG_WARNING)
        return;
    snprintf(f->message, sizeof f->message, "%s", message);
    f->message_count++;
}

static void *reallocate(void *user, void *block, size_t size_bytes) {
    fixture *f = user;
    if (size_bytes == 0) {
        f->blocks -= block != NULL;
        free(block);
        return NULL;
    }
    if (f->allocations_left == 0)
        return NULL;
    f->allocations_left--;
    void *made = realloc(block, size_bytes);
    f->blocks += !block && made;
    return made;
}

static void setup(fixture *f) {
    memset(f, 0, sizeof *f);
    f->allocations_left = SIZE_MAX;
    const camber_context_desc desc = {
        .reallocate = reallocate, .allocator_user = f, .log = keep_message, .log_user = f, .cache_dir = ""};
    assert_int_equal(camber_context_create(&desc, &f->context), CAMBER_OK);
    f->arena = f->data = (camber_arena){.context = f->context, .limit = SIZE_MAX};
}

static void teardown(fixture *f) {
    camber_arena_free(&f->arena);
    camber_arena_free(&f->data);
    camber_style_destroy(f->style);
    camber_context_destroy(f->context);
    assert_int_equal(f->blocks, 0);
}

static camber_status parse_layer(fixture *f, const char *members) {
    char json[4096];
    camber_style_destroy(f->style);
    f->style = NULL;
    snprintf(json, sizeof json, "{\"version\": 8, \"layers\": [{\"id\": \"s\", \"type\": \"symbol\", %s}]}", members);
    return camber_style_parse(f->context, json, strlen(json), "labels.json", &f->style);
}

/* A feature's properties as JSON, in the order of the style's schema. */
static camber_feature_view view_of(fixture *f, const char *properties) {
    json_t *json = json_loads(properties, JSON_DECODE_INT_AS_REAL, NULL);
    assert_non_null(json);
    const camber_schema *schema = &f->style->schema;
    assert_true(schema->property_count <= PROPERTIES_MAX);
    for (size_t i = 0; i < schema->property_count; i++) {
        const json_t *value = json_object_get(json, schema->properties[i]);
        f->values[i] = (camber_value){0};
        if (value && json_is_string(value))
            f->values[i] = (camber_value){
                .type = CAMBER_VALUE_STRING,
                .string = camber_arena_text(&f->data, json_string_value(value), strlen(json_string_value(value)))};
        else if (value)
            assert_true(camber_json_to_value(&f->data, value, &f->values[i]));
    }
    json_decref(json);
    return (camber_feature_view){.values = f->values, .geometry_type = "Point"};
}

static camber_symbol look_at(fixture *f, double zoom, const char *properties) {
    const camber_feature_view view = view_of(f, properties);
    const camber_layer_look look = camber_style_layer_look(f->style->layers, zoom);
    camber_symbol symbol;
    assert_int_equal(camber_layer_look_symbol(&look, &view, NULL, &f->arena, &symbol), CAMBER_OK);
    return symbol;
}

/* The symbol of a layer with these members for a feature. */
static camber_symbol symbol_of(fixture *f, const char *members, double zoom, const char *properties) {
    if (parse_layer(f, members) != CAMBER_OK || f->message_count)
        fail_msg("%s: %s", members, f->message);
    return look_at(f, zoom, properties);
}

static bool same(double a, double b) {
    return fabs(a - b) < 1e-6;
}

#define LAYOUT(more) "\"layout\": {" more "}"
#define PAINT(more) "\"paint\": {" more "}"

/* ---- Plain layers ---- */

static void test_plain(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    const camber_symbol symbol =
        symbol_of(&f,
                  LAYOUT("\"text-field\": \"{name}\", \"text-size\": {\"stops\": [[10, 10], [12, 20]]}, \"text-font\": "
                         "[\"Noto "
                         "Sans Bold\", \"Noto Sans Regular\"], \"symbol-placement\": \"line\", \"icon-image\": "
                         "\"{class}_11\"") ", " PAINT("\"text-color\": \"#f00\", \"text-opacity\": 0.5, "
                                                      "\"text-halo-color\": \"#fff\", \"text-halo-width\": 2"),
                  11.0, "{\"name\": \"Elbe\", \"class\": \"river\"}");
    assert_int_equal(symbol.placement, CAMBER_SYMBOL_LINE);
    assert_int_equal(symbol.section_count, 1);
    assert_string_equal(symbol.sections[0].text, "Elbe");
    assert_null(symbol.sections[0].image);
    assert_int_equal(symbol.sections[0].font_count, 2);
    assert_string_equal(symbol.sections[0].fonts[1], "Noto Sans Regular");
    assert_true(same(symbol.sections[0].scale, 1.0) && !symbol.sections[0].has_color);
    assert_string_equal(symbol.icon_image, "river_11");
    assert_true(same(symbol.text_size_px, 15.0));
    assert_true(same(symbol.text.color.r, 1.0) && same(symbol.text.color.a, 0.5));
    assert_true(same(symbol.text.halo_color.a, 0.5) && same(symbol.text.halo_width_px, 2.0));
    assert_int_equal(f.style->schema.property_readers[0].kinds, camber_style_layer_kinds(CAMBER_LAYER_SYMBOL));
    /* No name, no text. */
    assert_int_equal(look_at(&f, 11.0, "{\"class\": 1}").section_count, 0);
    teardown(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_plain)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
