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
    json_t *features;         /* have the strings of their values */
    camber_value values[PROPERTIES_MAX];
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
    f->features = json_array();
    f->arena = f->data = (camber_arena){.context = f->context, .limit = SIZE_MAX};
}

static void teardown(fixture *f) {
    camber_arena_free(&f->arena);
    camber_arena_free(&f->data);
    json_decref(f->features);
    camber_style_destroy(f->style);
    camber_context_destroy(f->context);
    assert_int_equal(f->blocks, 0);
}

static camber_status parse_layer(fixture *f, const char *members) {
    char json[16384];
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
        if (value)
            assert_true(camber_json_to_value(&f->data, value, &f->values[i]));
    }
    json_array_append_new(f->features, json);
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

/* ---- The reference ---- */

/* Whether the list has the same names as a text of them, in any order. */
static bool has_names(const char *const *values, const char *names) {
    size_t length = 0;
    for (size_t i = 0; values && values[i]; i++) {
        const char *at = strstr(names, values[i]);
        if (!at)
            return false;
        length += strlen(values[i]) + 1;
    }
    return length == strlen(names) + 1;
}

/* Every property of symbol layers in the specification's reference of August 2026, but visibility. */
static void test_reference(void **state) {
    (void)state;
    enum range { RANGE_ANY, RANGE_FROM_0, RANGE_FROM_1, RANGE_UNIT };
    static const struct {
        const char *name;
        bool layout;
        camber_type type;
        const char *fallback;
        uint32_t length;
        enum range range;
        const char *depends; /* zoom, feature, interpolated */
        const char *values;  /* NULL: any */
    } reference[] = {
        {"symbol-placement", true, CAMBER_TYPE_STRING, "\"point\"", 0, RANGE_ANY, "z", "point line line-center"},
        {"symbol-spacing", true, CAMBER_TYPE_NUMBER, "250", 0, RANGE_FROM_1, "zi", NULL},
        {"symbol-avoid-edges", true, CAMBER_TYPE_BOOL, "false", 0, RANGE_ANY, "z", NULL},
        {"symbol-sort-key", true, CAMBER_TYPE_NUMBER, NULL, 0, RANGE_ANY, "zf", NULL},
        {"symbol-z-order", true, CAMBER_TYPE_STRING, "\"auto\"", 0, RANGE_ANY, "z", "auto viewport-y source"},
        {"icon-allow-overlap", true, CAMBER_TYPE_BOOL, "false", 0, RANGE_ANY, "z", NULL},
        {"icon-overlap", true, CAMBER_TYPE_STRING, NULL, 0, RANGE_ANY, "z", "never always cooperative"},
        {"icon-ignore-placement", true, CAMBER_TYPE_BOOL, "false", 0, RANGE_ANY, "z", NULL},
        {"icon-optional", true, CAMBER_TYPE_BOOL, "false", 0, RANGE_ANY, "z", NULL},
        {"icon-rotation-alignment", true, CAMBER_TYPE_STRING, "\"auto\"", 0, RANGE_ANY, "z", "map viewport auto"},
        {"icon-size", true, CAMBER_TYPE_NUMBER, "1", 0, RANGE_FROM_0, "zfi", NULL},
        {"icon-text-fit", true, CAMBER_TYPE_STRING, "\"none\"", 0, RANGE_ANY, "z", "none width height both"},
        {"icon-text-fit-padding", true, CAMBER_TYPE_ARRAY, "[0, 0, 0, 0]", 4, RANGE_ANY, "zi", NULL},
        {"icon-image", true, CAMBER_TYPE_IMAGE, NULL, 0, RANGE_ANY, "zf", NULL},
        {"icon-rotate", true, CAMBER_TYPE_NUMBER, "0", 0, RANGE_ANY, "zfi", NULL},
        {"icon-padding", true, CAMBER_TYPE_PADDING, "[2]", 0, RANGE_ANY, "zfi", NULL},
        {"icon-keep-upright", true, CAMBER_TYPE_BOOL, "false", 0, RANGE_ANY, "z", NULL},
        {"icon-offset", true, CAMBER_TYPE_ARRAY, "[0, 0]", 2, RANGE_ANY, "zfi", NULL},
        {"icon-anchor", true, CAMBER_TYPE_STRING, "\"center\"", 0, RANGE_ANY, "zf",
         "center left right top bottom top-left top-right bottom-left bottom-right"},
        {"icon-pitch-alignment", true, CAMBER_TYPE_STRING, "\"auto\"", 0, RANGE_ANY, "z", "map viewport auto"},
        {"text-pitch-alignment", true, CAMBER_TYPE_STRING, "\"auto\"", 0, RANGE_ANY, "z", "map viewport auto"},
        {"text-rotation-alignment", true, CAMBER_TYPE_STRING, "\"auto\"", 0, RANGE_ANY, "z",
         "map viewport viewport-glyph auto"},
        {"text-field", true, CAMBER_TYPE_FORMATTED, "\"\"", 0, RANGE_ANY, "zf", NULL},
        {"text-font", true, CAMBER_TYPE_ARRAY, "[\"Open Sans Regular\", \"Arial Unicode MS Regular\"]", 0, RANGE_ANY,
         "zf", NULL},
        {"text-size", true, CAMBER_TYPE_NUMBER, "16", 0, RANGE_FROM_0, "zfi", NULL},
        {"text-max-width", true, CAMBER_TYPE_NUMBER, "10", 0, RANGE_FROM_0, "zfi", NULL},
        {"text-line-height", true, CAMBER_TYPE_NUMBER, "1.2", 0, RANGE_ANY, "zi", NULL},
        {"text-letter-spacing", true, CAMBER_TYPE_NUMBER, "0", 0, RANGE_ANY, "zfi", NULL},
        {"text-justify", true, CAMBER_TYPE_STRING, "\"center\"", 0, RANGE_ANY, "zf", "auto left center right"},
        {"text-radial-offset", true, CAMBER_TYPE_NUMBER, "0", 0, RANGE_ANY, "zfi", NULL},
        {"text-variable-anchor", true, CAMBER_TYPE_ARRAY, NULL, 0, RANGE_ANY, "z",
         "center left right top bottom top-left top-right bottom-left bottom-right"},
        {"text-variable-anchor-offset", true, CAMBER_TYPE_ANCHORS, NULL, 0, RANGE_ANY, "zfi", NULL},
        {"text-anchor", true, CAMBER_TYPE_STRING, "\"center\"", 0, RANGE_ANY, "zf",
         "center left right top bottom top-left top-right bottom-left bottom-right"},
        {"text-max-angle", true, CAMBER_TYPE_NUMBER, "45", 0, RANGE_ANY, "zi", NULL},
        {"text-writing-mode", true, CAMBER_TYPE_ARRAY, NULL, 0, RANGE_ANY, "z", "horizontal vertical"},
        {"text-rotate", true, CAMBER_TYPE_NUMBER, "0", 0, RANGE_ANY, "zfi", NULL},
        {"text-padding", true, CAMBER_TYPE_NUMBER, "2", 0, RANGE_FROM_0, "zi", NULL},
        {"text-keep-upright", true, CAMBER_TYPE_BOOL, "true", 0, RANGE_ANY, "z", NULL},
        {"text-transform", true, CAMBER_TYPE_STRING, "\"none\"", 0, RANGE_ANY, "zf", "none uppercase lowercase"},
        {"text-offset", true, CAMBER_TYPE_ARRAY, "[0, 0]", 2, RANGE_ANY, "zfi", NULL},
        {"text-allow-overlap", true, CAMBER_TYPE_BOOL, "false", 0, RANGE_ANY, "z", NULL},
        {"text-overlap", true, CAMBER_TYPE_STRING, NULL, 0, RANGE_ANY, "z", "never always cooperative"},
        {"text-ignore-placement", true, CAMBER_TYPE_BOOL, "false", 0, RANGE_ANY, "z", NULL},
        {"text-optional", true, CAMBER_TYPE_BOOL, "false", 0, RANGE_ANY, "z", NULL},
        {"icon-opacity", false, CAMBER_TYPE_NUMBER, "1", 0, RANGE_UNIT, "zfi", NULL},
        {"icon-color", false, CAMBER_TYPE_COLOR, "\"#000000\"", 0, RANGE_ANY, "zfi", NULL},
        {"icon-halo-color", false, CAMBER_TYPE_COLOR, "\"rgba(0, 0, 0, 0)\"", 0, RANGE_ANY, "zfi", NULL},
        {"icon-halo-width", false, CAMBER_TYPE_NUMBER, "0", 0, RANGE_FROM_0, "zfi", NULL},
        {"icon-halo-blur", false, CAMBER_TYPE_NUMBER, "0", 0, RANGE_FROM_0, "zfi", NULL},
        {"icon-translate", false, CAMBER_TYPE_ARRAY, "[0, 0]", 2, RANGE_ANY, "zi", NULL},
        {"icon-translate-anchor", false, CAMBER_TYPE_STRING, "\"map\"", 0, RANGE_ANY, "z", "map viewport"},
        {"text-opacity", false, CAMBER_TYPE_NUMBER, "1", 0, RANGE_UNIT, "zfi", NULL},
        {"text-color", false, CAMBER_TYPE_COLOR, "\"#000000\"", 0, RANGE_ANY, "zfi", NULL},
        {"text-halo-color", false, CAMBER_TYPE_COLOR, "\"rgba(0, 0, 0, 0)\"", 0, RANGE_ANY, "zfi", NULL},
        {"text-halo-width", false, CAMBER_TYPE_NUMBER, "0", 0, RANGE_FROM_0, "zfi", NULL},
        {"text-halo-blur", false, CAMBER_TYPE_NUMBER, "0", 0, RANGE_FROM_0, "zfi", NULL},
        {"text-translate", false, CAMBER_TYPE_ARRAY, "[0, 0]", 2, RANGE_ANY, "zi", NULL},
        {"text-translate-anchor", false, CAMBER_TYPE_STRING, "\"map\"", 0, RANGE_ANY, "z", "map viewport"},
    };
    size_t count = 0;
    for (size_t i = 0; i < sizeof reference / sizeof *reference; i++) {
        const char *name = reference[i].name, *depends = reference[i].depends;
        const camber_property_row *row = camber_property_find(CAMBER_LAYER_SYMBOL, reference[i].layout, name);
        if (!row)
            fail_msg("%s is not known", name);
        const camber_property *property = &row->property;
        json_t *fallback = reference[i].fallback ? json_loads(reference[i].fallback, JSON_DECODE_ANY, NULL) : NULL;
        json_t *own = property->fallback ? json_loads(property->fallback, JSON_DECODE_ANY, NULL) : NULL;
        const bool falls_back = json_equal(own, fallback) || (!own && !fallback);
        json_decref(fallback);
        json_decref(own);
        if (property->type != reference[i].type || property->length != reference[i].length || !falls_back ||
            !strchr(depends, 'z') != property->without_zoom || !strchr(depends, 'f') != !property->data_driven ||
            !strchr(depends, 'i') != !property->interpolated || property->line_progress ||
            row->offset != CAMBER_NO_OFFSET)
            fail_msg("%s differs from the reference", name);
        const double low = reference[i].range == RANGE_FROM_1 ? 1.0 : 0.0;
        const double high = reference[i].range == RANGE_ANY ? 0.0 : reference[i].range == RANGE_UNIT ? 1.0 : HUGE_VAL;
        if (property->low < low || property->low > low || property->high < high || property->high > high)
            fail_msg("%s has another range", name);
        if (reference[i].values ? !has_names(property->values, reference[i].values) : property->values != NULL)
            fail_msg("%s has other names", name);
    }
    for (size_t i = 0; i < CAMBER_PROPERTIES; i++)
        count += camber_property_rows[i].kind == CAMBER_LAYER_SYMBOL;
    assert_int_equal(count, sizeof reference / sizeof *reference);
}

/* ---- Defaults ---- */

static void check_defaults(const camber_symbol *s) {
    const camber_symbol_part *parts[] = {&s->icon, &s->text};
    assert_true(s->placement == CAMBER_SYMBOL_POINT && s->order == CAMBER_SYMBOL_ORDER_AUTO);
    assert_true(same(s->spacing_px, 250.0) && !s->avoid_edges && !s->has_sort_key && same(s->icon_size, 1.0));
    assert_true(s->icon_anchor == CAMBER_ANCHOR_CENTER && s->text_fit == CAMBER_FIT_NONE);
    assert_true(same(s->text_size_px, 16.0) && same(s->max_width_em, 10.0) && same(s->line_height_em, 1.2));
    assert_true(same(s->letter_spacing_em, 0.0) && s->justify == CAMBER_JUSTIFY_CENTER && same(s->max_angle_deg, 45.0));
    assert_true(s->text_anchor == CAMBER_ANCHOR_CENTER && s->variable_anchor_count == 0 && !s->has_radial_offset);
    assert_true(s->horizontal && !s->vertical && !s->vertical_first);
    assert_true(s->text.keep_upright && !s->icon.keep_upright);
    for (size_t i = 0; i < 2; i++) {
        const camber_symbol_part *part = parts[i];
        assert_true(part->overlap == CAMBER_OVERLAP_NEVER && !part->ignore_placement && !part->optional);
        assert_true(part->rotation_alignment == CAMBER_ALIGN_VIEWPORT &&
                    part->pitch_alignment == CAMBER_ALIGN_VIEWPORT);
        for (size_t k = 0; k < 4; k++)
            assert_true(same(part->padding_px[k], 2.0));
        assert_true(same(part->color.a, 1.0) && same(part->color.r, 0.0) && same(part->halo_color.a, 0.0));
        assert_true(same(part->halo_width_px, 0.0) && same(part->opacity, 1.0));
        assert_true(part->translate_anchor == CAMBER_TRANSLATE_MAP && same(part->translate_px[0], 0.0));
    }
}

/* Properties that are not given, that cannot be evaluated, and that are written out have the same values. */
static void test_defaults(void **state) {
    (void)state;
    char text[8192];
    fixture f;
    setup(&f);
    camber_symbol symbol = symbol_of(&f, LAYOUT(""), 10.0, "{}");
    check_defaults(&symbol);
    assert_true(symbol.section_count == 0 && !symbol.icon_image);
    for (int driven = 0; driven < 2; driven++) {
        size_t used = 0;
        for (int layout = 1; layout >= 0; layout--) {
            const char *between = "";
            used += (size_t)snprintf(text + used, sizeof text - used, "\"%s\": {", layout ? "layout" : "paint");
            for (size_t i = 0; i < CAMBER_PROPERTIES; i++) {
                const camber_property_row *row = camber_property_rows + i;
                if (row->kind != CAMBER_LAYER_SYMBOL || row->layout != layout ||
                    (driven && !row->property.data_driven) || (!driven && !row->property.fallback))
                    continue;
                used += (size_t)snprintf(text + used, sizeof text - used, "%s\"%s\": %s", between, row->property.name,
                                         driven ? "[\"get\", \"missing\"]" : row->property.fallback);
                between = ", ";
            }
            used += (size_t)snprintf(text + used, sizeof text - used, layout ? "}, " : "}");
        }
        symbol = symbol_of(&f, text, 10.0, "{}");
        check_defaults(&symbol);
    }
    symbol = symbol_of(&f, LAYOUT("\"text-field\": \"a\""), 10.0, "{}");
    assert_int_equal(symbol.sections[0].font_count, 2);
    assert_string_equal(symbol.sections[0].fonts[0], "Open Sans Regular");
    teardown(&f);
}

/* ---- Each property ---- */

static void test_layout(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    camber_symbol s = symbol_of(
        &f,
        LAYOUT("\"symbol-placement\": \"line-center\", \"symbol-spacing\": 100, \"symbol-avoid-edges\": true, "
               "\"symbol-sort-key\": [\"get\", \"rank\"], \"symbol-z-order\": \"source\", \"icon-size\": 2, "
               "\"icon-text-fit\": \"both\", \"icon-text-fit-padding\": [1, 2, 3, 4], \"icon-rotate\": 30, "
               "\"icon-padding\": [5, 6], \"icon-keep-upright\": true, \"icon-offset\": [7, 8], \"icon-anchor\": "
               "\"bottom-right\", \"icon-ignore-placement\": true, \"icon-optional\": true"),
        10.0, "{\"rank\": 4}");
    assert_true(s.placement == CAMBER_SYMBOL_LINE_CENTER && same(s.spacing_px, 100.0) && s.avoid_edges);
    assert_true(s.has_sort_key && same(s.sort_key, 4.0) && s.order == CAMBER_SYMBOL_ORDER_SOURCE);
    assert_true(same(s.icon_size, 2.0) && s.text_fit == CAMBER_FIT_BOTH && same(s.text_fit_padding_px[3], 4.0));
    assert_true(same(s.icon.rotate_deg, 30.0) && same(s.icon.padding_px[2], 5.0) && same(s.icon.padding_px[3], 6.0));
    assert_true(s.icon.keep_upright && same(s.icon_offset_px[1], 8.0) && s.icon_anchor == CAMBER_ANCHOR_BOTTOM_RIGHT);
    assert_true(s.icon.ignore_placement && s.icon.optional && same(s.max_width_em, 0.0));
    assert_false(look_at(&f, 10.0, "{\"rank\": \"first\"}").has_sort_key);
    s = symbol_of(&f,
                  LAYOUT("\"text-size\": 20, \"text-max-width\": 5, \"text-line-height\": 1.5, "
                         "\"text-letter-spacing\": 0.1, \"text-justify\": \"auto\", \"text-radial-offset\": 0.5, "
                         "\"text-anchor\": \"top-left\", \"text-max-angle\": 30, \"text-rotate\": -45, "
                         "\"text-padding\": 3, \"text-keep-upright\": false, \"text-offset\": [1, -2], "
                         "\"text-ignore-placement\": true, \"text-optional\": true"),
                  10.0, "{}");
    assert_true(same(s.text_size_px, 20.0) && same(s.max_width_em, 5.0) && same(s.line_height_em, 1.5));
    assert_true(same(s.letter_spacing_em, 0.1) && s.justify == CAMBER_JUSTIFY_AUTO && s.has_radial_offset);
    assert_true(same(s.radial_offset_em, 0.5) && s.text_anchor == CAMBER_ANCHOR_TOP_LEFT);
    assert_true(same(s.max_angle_deg, 30.0) && same(s.text.rotate_deg, -45.0) && same(s.text.padding_px[1], 3.0));
    assert_true(!s.text.keep_upright && same(s.text_offset_em[1], -2.0) && s.text.ignore_placement && s.text.optional);
    assert_false(symbol_of(&f, LAYOUT("\"text-radial-offset\": 0"), 10.0, "{}").has_radial_offset);
    teardown(&f);
}

static void test_paint(void **state) {
    (void)state;
#define OF(part)                                                                                                       \
    PAINT("\"" part "-opacity\": [\"get\", \"o\"], \"" part "-color\": \"rgba(255, 0, 0, 0.5)\", \"" part              \
          "-halo-color\": \"#00f\", \"" part "-halo-width\": 2, \"" part "-halo-blur\": 1, \"" part                    \
          "-translate\": [3, 4], \"" part "-translate-anchor\": \"viewport\"")
    fixture f;
    setup(&f);
    for (int i = 0; i < 2; i++) {
        const camber_symbol symbol = symbol_of(&f, i ? OF("text") : OF("icon"), 10.0, "{\"o\": 0.5}");
        const camber_symbol_part *p = i ? &symbol.text : &symbol.icon;
        assert_true(same(p->opacity, 0.5) && same(p->color.r, 1.0) && same(p->color.a, 0.25));
        assert_true(same(p->halo_color.b, 1.0) && same(p->halo_color.a, 0.5) && same(p->halo_width_px, 2.0));
        assert_true(same(p->halo_blur_px, 1.0) && same(p->translate_px[1], 4.0));
        assert_int_equal(p->translate_anchor, CAMBER_TRANSLATE_VIEWPORT);
    }
#undef OF
    teardown(&f);
}

/* "auto" goes by the placement, and a pitch by the rotation. */
static void test_alignments(void **state) {
    (void)state;
    static const struct {
        const char *layout;
        camber_symbol_alignment icon, icon_pitch, text, text_pitch;
    } cases[] = {
        {"\"symbol-placement\": \"point\"", CAMBER_ALIGN_VIEWPORT, CAMBER_ALIGN_VIEWPORT, CAMBER_ALIGN_VIEWPORT,
         CAMBER_ALIGN_VIEWPORT},
        {"\"symbol-placement\": \"line\"", CAMBER_ALIGN_MAP, CAMBER_ALIGN_MAP, CAMBER_ALIGN_MAP, CAMBER_ALIGN_MAP},
        {"\"icon-rotation-alignment\": \"map\", \"text-rotation-alignment\": \"map\"", CAMBER_ALIGN_MAP,
         CAMBER_ALIGN_MAP, CAMBER_ALIGN_MAP, CAMBER_ALIGN_MAP},
        {"\"symbol-placement\": \"line\", \"text-rotation-alignment\": \"viewport-glyph\"", CAMBER_ALIGN_MAP,
         CAMBER_ALIGN_MAP, CAMBER_ALIGN_VIEWPORT_GLYPH, CAMBER_ALIGN_VIEWPORT},
        {"\"icon-pitch-alignment\": \"map\", \"text-pitch-alignment\": \"map\"", CAMBER_ALIGN_VIEWPORT,
         CAMBER_ALIGN_MAP, CAMBER_ALIGN_VIEWPORT, CAMBER_ALIGN_MAP},
        {"\"symbol-placement\": \"line\", \"icon-pitch-alignment\": \"viewport\", \"text-rotation-alignment\": "
         "\"viewport\"",
         CAMBER_ALIGN_MAP, CAMBER_ALIGN_VIEWPORT, CAMBER_ALIGN_VIEWPORT, CAMBER_ALIGN_VIEWPORT},
    };
    fixture f;
    setup(&f);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char members[512];
        snprintf(members, sizeof members, LAYOUT("%s"), cases[i].layout);
        const camber_symbol symbol = symbol_of(&f, members, 10.0, "{}");
        if (symbol.icon.rotation_alignment != cases[i].icon || symbol.icon.pitch_alignment != cases[i].icon_pitch ||
            symbol.text.rotation_alignment != cases[i].text || symbol.text.pitch_alignment != cases[i].text_pitch)
            fail_msg("%s", cases[i].layout);
    }
    teardown(&f);
}

/* The newer property counts if both are there. */
static void test_overlap(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    const char *both =
        LAYOUT("\"icon-allow-overlap\": true, \"text-allow-overlap\": true, \"text-overlap\": \"never\"");
    camber_symbol symbol = symbol_of(&f, both, 10.0, "{}");
    assert_true(symbol.icon.overlap == CAMBER_OVERLAP_ALWAYS && symbol.text.overlap == CAMBER_OVERLAP_NEVER);
    symbol = symbol_of(&f, LAYOUT("\"icon-overlap\": \"cooperative\", \"text-overlap\": \"always\""), 10.0, "{}");
    assert_true(symbol.icon.overlap == CAMBER_OVERLAP_COOPERATIVE && symbol.text.overlap == CAMBER_OVERLAP_ALWAYS);
    teardown(&f);
}

static void test_anchors(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    camber_symbol s = symbol_of(
        &f, LAYOUT("\"text-variable-anchor\": [\"top\", \"bottom-left\", \"center\"], \"text-offset\": [1, -2]"), 10.0,
        "{}");
    assert_true(s.variable_anchor_count == 3 && !s.has_variable_offsets && !s.has_radial_offset);
    assert_true(s.variable_anchors[1] == CAMBER_ANCHOR_BOTTOM_LEFT && same(s.variable_offsets_em[1][0], 1.0));
    assert_true(same(s.variable_offsets_em[1][1], -2.0) && same(s.variable_offsets_em[0][1], 2.0));
    assert_true(same(s.variable_offsets_em[0][0], 0.0) && same(s.variable_offsets_em[2][1], 0.0));
    s = symbol_of(&f, LAYOUT("\"text-variable-anchor\": [\"top-right\", \"left\"], \"text-radial-offset\": 2"), 10.0,
                  "{}");
    assert_true(s.has_radial_offset && same(s.variable_offsets_em[0][0], -sqrt(2.0)));
    assert_true(same(s.variable_offsets_em[0][1], sqrt(2.0)) && same(s.variable_offsets_em[1][0], 2.0));
    const char *list = LAYOUT("\"text-variable-anchor-offset\": [\"top\", [0, 4], \"left\", [3, 0]], "
                              "\"text-variable-anchor\": [\"center\"]");
    s = symbol_of(&f, list, 10.0, "{}");
    assert_true(s.variable_anchor_count == 2 && s.has_variable_offsets && s.variable_anchors[1] == CAMBER_ANCHOR_LEFT);
    assert_true(same(s.variable_offsets_em[0][1], 4.0) && same(s.variable_offsets_em[1][0], 3.0));
    const char *mixed = LAYOUT("\"text-variable-anchor-offset\": [\"interpolate\", [\"linear\"], [\"zoom\"], 0, "
                               "[\"literal\", [\"top\", [0, 0]]], 10, [\"literal\", [\"top\", [2, 4]]]]");
    s = symbol_of(&f, mixed, 5.0, "{}");
    assert_true(s.variable_anchor_count == 1 && same(s.variable_offsets_em[0][0], 1.0));
    assert_true(same(s.variable_offsets_em[0][1], 2.0));
    teardown(&f);
}

static void test_writing_modes(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    camber_symbol s = symbol_of(&f, LAYOUT("\"text-writing-mode\": [\"vertical\", \"horizontal\"]"), 10.0, "{}");
    assert_true(s.horizontal && s.vertical && s.vertical_first);
    s = symbol_of(&f, LAYOUT("\"text-writing-mode\": [\"vertical\"]"), 10.0, "{}");
    assert_true(!s.horizontal && s.vertical && s.vertical_first);
    s = symbol_of(&f, LAYOUT("\"symbol-placement\": \"line\""), 10.0, "{}");
    assert_true(s.horizontal && s.vertical && !s.vertical_first);
    teardown(&f);
}

/* ---- Texts ---- */

static void test_texts(void **state) {
    (void)state;
    static const struct {
        const char *layout, *properties, *text; /* NULL: none */
    } cases[] = {
        {"\"text-field\": \"{name} ({ref})\"", "{\"name\": \"A\", \"ref\": 7}", "A (7)"},
        {"\"text-field\": \"{name:latin}{{x}\"", "{\"name:latin\": \"Kyiv\", \"x\": true}", "Kyiv{true"},
        {"\"text-field\": \"{}{a\"", "{}", "{}{a"},
        {"\"text-field\": \"{name}\"", "{}", NULL},
        {"\"text-field\": {\"stops\": [[0, \"{a}\"], [5, \"{b}\"]]}", "{\"a\": \"low\", \"b\": \"high\"}", "high"},
        {"\"text-field\": {\"type\": \"identity\", \"property\": \"a\"}", "{\"a\": \"same\"}", "same"},
        {"\"text-field\": {\"type\": \"identity\", \"property\": \"a\", \"default\": \"other\"}", "{}", "other"},
        {"\"text-field\": {\"type\": \"categorical\", \"property\": \"a\", \"stops\": [[\"x\", \"X\"]]}",
         "{\"a\": \"x\"}", "X"},
        {"\"text-field\": [\"get\", \"a\"]", "{\"a\": [1, \"b\"]}", "[1,\"b\"]"},
        {"\"text-field\": [\"concat\", [\"get\", \"a\"], \"\\n\", [\"get\", \"b\"]]", "{\"a\": 1.5, \"b\": false}",
         "1.5\nfalse"},
        {"\"text-field\": [\"step\", [\"zoom\"], \"\", 5, [\"get\", \"a\"]]", "{\"a\": \"z\"}", "z"},
        {"\"text-field\": [\"coalesce\", [\"get\", \"a\"], [\"get\", \"b\"]]", "{\"b\": \"second\"}", "second"},
        {"\"text-field\": \"Stra\xc3\x9f"
         "e\", \"text-transform\": \"uppercase\"",
         "{}", "STRASSE"},
        {"\"text-field\": \"\xc3\x84RA\", \"text-transform\": [\"get\", \"how\"]", "{\"how\": \"lowercase\"}",
         "\xc3\xa4ra"},
        {"\"text-field\": [\"number-format\", [\"get\", \"ele\"], {\"unit\": \"meter\"}]", "{\"ele\": 4807.81}",
         "4,807.81 m"},
        {"\"text-field\": [\"number\", [\"get\", \"a\"]]", NULL, NULL},
    };
    fixture f;
    setup(&f);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char members[512];
        snprintf(members, sizeof members, LAYOUT("%s"), cases[i].layout);
        if (!cases[i].properties) {
            assert_int_equal(parse_layer(&f, members), CAMBER_ERROR_INPUT);
            f.message_count = 0;
            continue;
        }
        const camber_symbol symbol = symbol_of(&f, members, 10.0, cases[i].properties);
        assert_int_equal(symbol.section_count, cases[i].text ? 1 : 0);
        if (cases[i].text)
            assert_string_equal(symbol.sections[0].text, cases[i].text);
    }
    teardown(&f);
}

static void test_format(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    const camber_symbol s = symbol_of(
        &f,
        LAYOUT("\"text-field\": [\"format\", [\"get\", \"name\"], {}, [\"get\", \"none\"], {\"font-scale\": 3}, "
               "\"\\n\", "
               "[\"get\", \"ref\"], {\"font-scale\": 0.5, \"text-font\": [\"literal\", [\"Noto Sans Bold\"]], "
               "\"text-color\": \"rgba(0, 255, 0, 0.5)\", \"vertical-align\": \"top\"}, [\"image\", [\"get\", "
               "\"shield\"]], {\"vertical-align\": \"center\"}, [\"image\", \"\"]], \"text-transform\": "
               "\"uppercase\"") ", " PAINT("\"text-opacity\": 0.5"),
        10.0, "{\"name\": \"ab\", \"ref\": 7, \"shield\": \"road\"}");
    assert_int_equal(s.section_count, 4);
    assert_string_equal(s.sections[0].text, "AB");
    assert_true(same(s.sections[0].scale, 1.0) && !s.sections[0].has_color && s.sections[0].font_count == 2);
    assert_string_equal(s.sections[1].text, "\n");
    assert_string_equal(s.sections[2].text, "7");
    assert_true(same(s.sections[2].scale, 0.5) && s.sections[2].align == CAMBER_ALIGN_TOP);
    assert_true(s.sections[2].has_color && same(s.sections[2].color.g, 1.0) && same(s.sections[2].color.a, 0.25));
    assert_int_equal(s.sections[2].font_count, 1);
    assert_string_equal(s.sections[2].fonts[0], "Noto Sans Bold");
    assert_null(s.sections[3].text);
    assert_string_equal(s.sections[3].image, "road");
    assert_int_equal(s.sections[3].align, CAMBER_ALIGN_CENTER);
    assert_true(camber_style_layer_names_images(f.style->layers));
    teardown(&f);
}

/* ---- Images ---- */

static uint32_t find_image(void *user, const char *name) {
    return strcmp(name, user) == 0;
}

static void test_images(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    assert_int_equal(parse_layer(&f, LAYOUT("\"icon-image\": [\"coalesce\", [\"image\", [\"concat\", [\"get\", \"a\"], "
                                            "\"_11\"]], [\"image\", \"b\"]]")),
                     CAMBER_OK);
    const camber_feature_view view = view_of(&f, "{\"a\": \"bar\"}");
    const camber_layer_look look = camber_style_layer_look(f.style->layers, 10.0);
    static char there[] = "b", neither[] = "c";
    const camber_style_images some = {.find = find_image, .user = there}, none = {.find = find_image, .user = neither};
    camber_symbol symbol;
    assert_int_equal(camber_layer_look_symbol(&look, &view, NULL, &f.arena, &symbol), CAMBER_OK);
    assert_string_equal(symbol.icon_image, "bar_11");
    assert_int_equal(camber_layer_look_symbol(&look, &view, &some, &f.arena, &symbol), CAMBER_OK);
    assert_string_equal(symbol.icon_image, "b");
    assert_int_equal(camber_layer_look_symbol(&look, &view, &none, &f.arena, &symbol), CAMBER_OK);
    assert_string_equal(symbol.icon_image, "bar_11"); /* so that it is the one that is missed */
    assert_true(camber_style_layer_names_images(f.style->layers));
    symbol = symbol_of(&f,
                       LAYOUT("\"icon-image\": {\"property\": \"a\", \"type\": \"categorical\", \"stops\": [[\"x\", "
                              "\"cross\"]], \"default\": \"\"}"),
                       10.0, "{\"a\": \"x\"}");
    assert_string_equal(symbol.icon_image, "cross");
    assert_null(look_at(&f, 10.0, "{}").icon_image);
    assert_null(symbol_of(&f, LAYOUT("\"text-field\": \"{a}\""), 10.0, "{}").icon_image);
    assert_false(camber_style_layer_names_images(f.style->layers));
    teardown(&f);
}

/* ---- Layers in a style ---- */

static void test_wants(void **state) {
    (void)state;
    static const struct {
        const char *members;
        bool lines, areas, points;
    } cases[] = {
        {LAYOUT("\"text-field\": \"{a}\""), true, true, true},
        {LAYOUT("\"icon-image\": \"a\"") ", \"filter\": [\"==\", \"$type\", \"Point\"]", false, false, true},
        {LAYOUT("\"icon-image\": \"a\"") ", \"filter\": [\"!=\", \"$type\", \"Point\"]", true, true, false},
        {LAYOUT("\"text-size\": 2"), false, false, false},
        {LAYOUT("\"text-field\": \"{a}\", \"visibility\": \"none\""), false, false, false},
    };
    fixture f;
    setup(&f);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(parse_layer(&f, cases[i].members), CAMBER_OK);
        const camber_schema *schema = &f.style->schema;
        if (schema->wants_label_lines != cases[i].lines || schema->wants_label_areas != cases[i].areas ||
            schema->wants_label_points != cases[i].points || schema->wants_polygons || schema->wants_areas ||
            schema->wants_points)
            fail_msg("%s", cases[i].members);
    }
    teardown(&f);
}

/* Lines keep their directions for icons that turn with them. */
static void test_directions(void **state) {
    (void)state;
    static const struct {
        const char *members;
        bool directed;
    } cases[] = {
        {LAYOUT("\"icon-image\": \"a\", \"symbol-placement\": \"line\""), true},
        {LAYOUT("\"icon-image\": \"a\", \"symbol-placement\": [\"step\", [\"zoom\"], \"point\", 9, \"line\"]"), true},
        {LAYOUT("\"icon-image\": \"a\", \"symbol-placement\": \"point\""), false},
        {LAYOUT("\"icon-image\": \"a\", \"symbol-placement\": \"line\", \"icon-rotation-alignment\": \"viewport\""),
         false},
        {LAYOUT("\"icon-image\": \"a\""), false},
        {LAYOUT("\"text-field\": \"a\", \"symbol-placement\": \"line\""), false},
    };
    fixture f;
    setup(&f);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(parse_layer(&f, cases[i].members), CAMBER_OK);
        if (f.style->schema.labels_directed != cases[i].directed)
            fail_msg("%s", cases[i].members);
    }
    teardown(&f);
}

static bool takes(fixture *f, camber_geometry_kind kind, const char *source_layer, const char *properties) {
    camber_feature_view view = view_of(f, properties);
    view.geometry_type = camber_geometry_type(kind);
    return f->style->schema.takes(f->style, kind, source_layer, &view);
}

static void test_takes(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    assert_int_equal(
        parse_layer(&f,
                    LAYOUT("\"text-field\": \"{name}\", \"icon-image\": \"{icon}\"") ", \"source-layer\": "
                                                                                     "\"poi\", \"filter\": [\"==\", "
                                                                                     "\"class\", \"inn\"]"),
        CAMBER_OK);
    assert_true(takes(&f, CAMBER_GEOMETRY_LABEL_POINT, "poi", "{\"class\": \"inn\", \"name\": \"Sun\"}"));
    assert_true(takes(&f, CAMBER_GEOMETRY_LABEL_AREA, "poi", "{\"class\": \"inn\", \"icon\": \"bed\"}"));
    assert_false(takes(&f, CAMBER_GEOMETRY_LABEL_POINT, "poi", "{\"class\": \"inn\"}"));
    assert_false(takes(&f, CAMBER_GEOMETRY_LABEL_POINT, "poi", "{\"class\": \"bar\", \"name\": \"Sun\"}"));
    assert_false(takes(&f, CAMBER_GEOMETRY_LABEL_POINT, "place", "{\"class\": \"inn\", \"name\": \"Sun\"}"));
    assert_false(takes(&f, CAMBER_GEOMETRY_POINT, "poi", "{\"class\": \"inn\", \"name\": \"Sun\"}"));
    assert_false(takes(&f, CAMBER_GEOMETRY_LINE, "poi", "{\"class\": \"inn\", \"name\": \"Sun\"}"));
    /* At some zoom it may have a text. */
    assert_int_equal(parse_layer(&f, LAYOUT("\"text-field\": [\"step\", [\"zoom\"], \"\", 14, [\"get\", \"name\"]]")),
                     CAMBER_OK);
    assert_true(takes(&f, CAMBER_GEOMETRY_LABEL_LINE, "any", "{}"));
    teardown(&f);
}

static void test_document(void **state) {
    (void)state;
    static const char *const wrong[] = {
        LAYOUT("\"text-size\": -1"),
        LAYOUT("\"symbol-spacing\": 0"),
        LAYOUT("\"text-field\": 5"),
        LAYOUT("\"text-font\": \"Noto Sans\""),
        LAYOUT("\"text-font\": [1, 2]"),
        LAYOUT("\"text-anchor\": \"middle\""),
        LAYOUT("\"text-variable-anchor\": [\"top\", \"middle\"]"),
        LAYOUT("\"text-variable-anchor\": [\"literal\", [\"top\", \"middle\"]]"),
        LAYOUT("\"text-variable-anchor-offset\": [\"top\", [1]]"),
        LAYOUT("\"text-variable-anchor-offset\": [\"top\"]"),
        LAYOUT("\"text-writing-mode\": [\"diagonal\"]"),
        LAYOUT("\"icon-padding\": [1, 2, 3, 4, 5]"),
        LAYOUT("\"icon-padding\": \"2\""),
        LAYOUT("\"icon-offset\": [1]"),
        LAYOUT("\"symbol-placement\": [\"get\", \"a\"]"),
        LAYOUT("\"text-padding\": [\"get\", \"a\"]"),
        LAYOUT("\"text-field\": [\"image\", \"a\"]"),
        LAYOUT("\"text-field\": [\"format\", {}]"),
        PAINT("\"text-opacity\": 1.5"),
        PAINT("\"icon-halo-width\": -1"),
    };
    fixture f;
    setup(&f);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (parse_layer(&f, wrong[i]) != CAMBER_ERROR_INPUT)
            fail_msg("%s is read", wrong[i]);
    f.message_count = 0;
    static const char json[] = "{\"version\": 8, \"glyphs\": \"file:///g/{fontstack}/{range}.pbf\", \"layers\": []}";
    assert_int_equal(camber_style_parse(f.context, json, strlen(json), "labels.json", &f.style), CAMBER_OK);
    assert_string_equal(f.style->glyphs, "file:///g/{fontstack}/{range}.pbf");
    assert_int_equal(parse_layer(&f, LAYOUT("\"text-field\": \"a\"")), CAMBER_OK);
    assert_null(f.style->glyphs);
    assert_int_equal(f.message_count, 0);
    teardown(&f);
}

/* Symbols that differ only in their texts are the same bytes, so that they can be compared. */
static void test_bytes(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    const char *members =
        LAYOUT("\"text-field\": \"{a}\", \"text-variable-anchor\": [\"top\"], \"text-size\": [\"get\", "
               "\"s\"], \"icon-padding\": [\"get\", \"p\"]");
    assert_int_equal(parse_layer(&f, members), CAMBER_OK);
    const camber_feature_view view = view_of(&f, "{\"a\": \"x\", \"s\": 7}");
    const camber_layer_look look = camber_style_layer_look(f.style->layers, 10.0);
    camber_symbol symbols[2];
    for (int i = 0; i < 2; i++) {
        memset(symbols + i, 17 * i, sizeof *symbols);
        assert_int_equal(camber_layer_look_symbol(&look, &view, NULL, &f.arena, symbols + i), CAMBER_OK);
        symbols[i].sections = NULL;
    }
    assert_memory_equal(symbols, symbols + 1, sizeof *symbols);
    teardown(&f);
}

/* ---- Memory ---- */

/* With any number of allocations the symbol is there, or memory is said to be short. */
static void test_memory(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    char text[16384];
    memset(text, 'x', sizeof text - 1);
    text[sizeof text - 1] = 0;
    assert_int_equal(parse_layer(&f, LAYOUT("\"text-field\": [\"format\", [\"concat\", [\"get\", \"a\"], \"b\"], {}, "
                                            "[\"get\", \"a\"]], \"text-transform\": \"uppercase\", \"icon-image\": "
                                            "\"{a}\"")),
                     CAMBER_OK);
    f.values[0] = (camber_value){.type = CAMBER_VALUE_STRING, .string = text};
    const camber_feature_view view = {.values = f.values, .geometry_type = "Point"};
    const camber_layer_look look = camber_style_layer_look(f.style->layers, 10.0);
    camber_status status = CAMBER_ERROR_MEMORY;
    for (size_t count = 0; count < 64 && status != CAMBER_OK; count++) {
        camber_arena arena = {.context = f.context, .limit = SIZE_MAX};
        camber_symbol symbol;
        f.allocations_left = count;
        f.message_count = 0;
        status = camber_layer_look_symbol(&look, &view, NULL, &arena, &symbol);
        assert_true(status == CAMBER_OK || (status == CAMBER_ERROR_MEMORY && f.message_count == 1));
        camber_arena_free(&arena);
    }
    assert_int_equal(status, CAMBER_OK);
    teardown(&f);
}

/* The same while a style is read. */
static void test_memory_of_styles(void **state) {
    (void)state;
    static const char *const layer =
        LAYOUT("\"text-field\": [\"format\", \"a\", {\"text-font\": [\"literal\", [\"F\"]], \"font-scale\": 2}, "
               "[\"image\", \"b\"]], \"icon-padding\": [1, 2], \"text-variable-anchor-offset\": [\"top\", [0, 1]], "
               "\"icon-image\": \"{a}_{b}\", \"text-size\": [\"number-format\", 7, {}]");
    fixture f;
    setup(&f);
    camber_status status = CAMBER_ERROR_MEMORY;
    for (size_t count = 0; count < 400 && status == CAMBER_ERROR_MEMORY; count++) {
        f.allocations_left = count;
        f.message_count = 0;
        status = parse_layer(&f, layer);
        assert_true(status != CAMBER_OK && f.message_count == 1);
    }
    assert_int_equal(status, CAMBER_ERROR_INPUT); /* a text is no size */
    f.allocations_left = SIZE_MAX;
    teardown(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plain),
        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_layout),
        cmocka_unit_test(test_paint),
        cmocka_unit_test(test_alignments),
        cmocka_unit_test(test_overlap),
        cmocka_unit_test(test_anchors),
        cmocka_unit_test(test_writing_modes),
        cmocka_unit_test(test_texts),
        cmocka_unit_test(test_format),
        cmocka_unit_test(test_images),
        cmocka_unit_test(test_wants),
        cmocka_unit_test(test_directions),
        cmocka_unit_test(test_takes),
        cmocka_unit_test(test_document),
        cmocka_unit_test(test_bytes),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_memory_of_styles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
