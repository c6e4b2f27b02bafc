/* Style documents: parsed, their layers evaluated over features with values of every kind, and drawn to a scene; and
 * documents of one expression, as style eval takes them. */
#include "fuzz_scene.h"

#include "features/features.h"
#include "style/symbol.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CLASSES = 8 };

static const camber_value values[] = {
    {.type = CAMBER_VALUE_NULL},
    {.type = CAMBER_VALUE_BOOL, .boolean = true},
    {.type = CAMBER_VALUE_BOOL, .boolean = false},
    {.type = CAMBER_VALUE_NUMBER, .number = 0.0},
    {.type = CAMBER_VALUE_NUMBER, .number = -1.0},
    {.type = CAMBER_VALUE_NUMBER, .number = 5.0},
    {.type = CAMBER_VALUE_NUMBER, .number = 0.1},
    {.type = CAMBER_VALUE_NUMBER, .number = 1e308},
    {.type = CAMBER_VALUE_NUMBER, .number = -1e308},
    {.type = CAMBER_VALUE_NUMBER, .number = 5e-324},
    {.type = CAMBER_VALUE_NUMBER, .number = HUGE_VAL},
    {.type = CAMBER_VALUE_NUMBER, .number = -HUGE_VAL},
    {.type = CAMBER_VALUE_STRING, .string = ""},
    {.type = CAMBER_VALUE_STRING, .string = "primary"},
    {.type = CAMBER_VALUE_STRING, .string = "yes"},
    {.type = CAMBER_VALUE_STRING, .string = "12.5"},
    {.type = CAMBER_VALUE_STRING, .string = "1e400"},
    {.type = CAMBER_VALUE_STRING, .string = "#f80"},
    {.type = CAMBER_VALUE_STRING, .string = "hsla(200, 50%, 50%, 0.5)"},
    {.type = CAMBER_VALUE_STRING, .string = "\xc3\xa9\xf0\x9f\x9b\xa3"},
};
enum { VALUES = sizeof values / sizeof *values };

/* World coordinates; 360 px at zoom 10 and less than one at 0. */
static const double shapes[][8] = {
    {0.5, 0.5, 0.5006, 0.5003, 0.5004, 0.5007, 0.5, 0.5},
    {0.4999, 0.5001, 0.5002, 0.5001, 0.5001, 0.5001, 0.50015, 0.50011},
    {0.01, 0.2, 0.9, 0.8, 0.1, 0.9, 0.1, 0.9},
};

/* Features whose class gives the properties values one after the other, so that each meets each in time. */
static bool add_features(fuzz_run *run, camber_features *features) {
    const size_t count = features->style->schema.property_count;
    camber_value all[1024] = {0};
    uint32_t layer = 0, class_index = 0;
    REQUIRE(count <= sizeof all / sizeof *all);
    for (size_t c = 0; c < CLASSES; c++) {
        for (size_t i = 0; i < count; i++) {
            all[i] = values[(run->hash + 7 * c + 3 * i) % VALUES];
            if (all[i].type == CAMBER_VALUE_STRING &&
                !fuzz_done(run, camber_features_intern(features, all[i].string, &all[i].string)))
                return false;
        }
        if (!fuzz_done(run, camber_features_find_layer(features, c % 3 ? "roads" : "other", &layer)) ||
            !fuzz_done(run,
                       camber_features_find_class(features, layer, (camber_geometry_kind)(c % 3), all, &class_index)) ||
            !fuzz_done(run, camber_features_add_feature(features, class_index)) ||
            !fuzz_done(run, camber_features_add_polyline(features, shapes[c % 3], 1 + c % 4)))
            return false;
    }
    return true;
}

/* Expressions that read an id or all properties find these. */
static const camber_value numbers[] = {{.type = CAMBER_VALUE_NUMBER, .number = 1.5},
                                       {.type = CAMBER_VALUE_STRING, .string = "a"}};
static const camber_member members[] = {
    {.key = "a", .position = 1, .value = {.type = CAMBER_VALUE_ARRAY, .count = 2, .items = numbers}},
    {.key = "k", .position = 0, .value = {.type = CAMBER_VALUE_NUMBER, .number = -2.0}}};
static const camber_value all_properties = {.type = CAMBER_VALUE_OBJECT, .count = 2, .members = members};

static void check_layers(const camber_style *style, const camber_features *features) {
    static const double zooms[] = {0.0, 9.75, 14.0, 24.0};
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = style->layers + i;
        REQUIRE(layer->id && layer->min_zoom >= 0.0 && layer->max_zoom <= 24.0);
        for (size_t c = 0; c < features->class_count; c++) {
            const camber_feature_view feature = {
                .values = features->values ? features->values + features->classes[c].first_value : NULL,
                .geometry_type = camber_geometry_type(features->classes[c].geometry),
                .id = c % 2 ? numbers[c / 2 % 2] : (camber_value){0},
                .all = c % 3 ? &all_properties : NULL};
            for (size_t z = 0; z < sizeof zooms / sizeof *zooms; z++) {
                camber_style_layer_matches(layer, zooms[z], &feature);
                const camber_layer_paint paint = camber_style_layer_paint(layer, zooms[z], &feature);
                REQUIRE(paint.width >= 0.0 && isfinite(paint.width));
                REQUIRE(paint.gap_width >= 0.0 && isfinite(paint.gap_width));
                REQUIRE(isfinite(paint.blur) && (paint.blur >= 0.0 || layer->kind == CAMBER_LAYER_CIRCLE));
                REQUIRE(isfinite(paint.miter_limit) && isfinite(paint.round_limit) && isfinite(paint.sort_key));
                REQUIRE(isfinite(paint.translate[0]) && isfinite(paint.translate[1]) && isfinite(paint.offset));
                REQUIRE(paint.cap <= CAMBER_CAP_SQUARE && paint.join <= CAMBER_JOIN_BEVEL);
                REQUIRE(paint.layer_opacity >= 0.0 && paint.layer_opacity <= 1.0);
                REQUIRE(paint.color.a >= 0.0f && paint.color.a <= 1.0f);
            }
        }
    }
}

static bool is_padding(const double px[4]) {
    return isfinite(px[0]) && isfinite(px[1]) && isfinite(px[2]) && isfinite(px[3]);
}

static bool is_part(const camber_symbol_part *part) {
    return is_padding(part->padding_px) && isfinite(part->rotate_deg) && part->halo_width_px >= 0.0 &&
           isfinite(part->halo_width_px) && isfinite(part->halo_blur_px) && part->color.a >= 0.0f &&
           part->color.a <= 1.0f && part->pitch_alignment <= CAMBER_ALIGN_VIEWPORT &&
           part->rotation_alignment <= CAMBER_ALIGN_VIEWPORT_GLYPH && part->overlap <= CAMBER_OVERLAP_COOPERATIVE;
}

static void check_symbol(const camber_symbol *symbol) {
    REQUIRE(is_part(&symbol->icon) && is_part(&symbol->text) && is_padding(symbol->text_fit_padding_px));
    REQUIRE(symbol->spacing_px >= 1.0 && isfinite(symbol->spacing_px) && isfinite(symbol->sort_key));
    REQUIRE(symbol->icon_size >= 0.0 && isfinite(symbol->icon_size) && symbol->text_size_px >= 0.0 &&
            isfinite(symbol->text_size_px));
    REQUIRE(symbol->placement <= CAMBER_SYMBOL_LINE_CENTER && symbol->text_anchor <= CAMBER_ANCHOR_BOTTOM_RIGHT);
    REQUIRE(symbol->variable_anchor_count <= CAMBER_SYMBOL_ANCHORS_MAX && (symbol->horizontal || symbol->vertical));
    REQUIRE(!symbol->icon_image || symbol->icon_image[0]);
    for (size_t i = 0; i < symbol->variable_anchor_count; i++)
        REQUIRE(isfinite(symbol->variable_offsets_em[i][0]) && isfinite(symbol->variable_offsets_em[i][1]));
    for (size_t i = 0; i < symbol->section_count; i++) {
        const camber_symbol_section *section = symbol->sections + i;
        REQUIRE(!section->text != !section->image && (section->text ? section->text : section->image)[0]);
        REQUIRE(section->scale >= 0.0 && isfinite(section->scale));
        for (size_t k = 0; k < section->font_count; k++)
            REQUIRE(section->fonts[k]);
    }
}

/* Symbol layers have a symbol for each feature, or memory is short. */
static void check_symbols(fuzz_run *run, const camber_style *style, const camber_features *features) {
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = style->layers + i;
        const camber_layer_look look = camber_style_layer_look(layer, 9.75);
        for (size_t c = 0; c < features->class_count && layer->kind == CAMBER_LAYER_SYMBOL; c++) {
            const camber_feature_view feature = {
                .values = features->values ? features->values + features->classes[c].first_value : NULL,
                .geometry_type = "Point",
                .all = c % 3 ? &all_properties : NULL};
            camber_arena arena = {.context = run->context, .limit = 1 << 20};
            camber_symbol symbol;
            camber_style_layer_may_label(layer, &feature);
            if (fuzz_done(run, camber_layer_look_symbol(&look, &feature, NULL, &arena, &symbol)))
                check_symbol(&symbol);
            camber_arena_free(&arena);
        }
    }
}

static void use_style(fuzz_run *run, const camber_style *style) {
    static const double zooms[] = {0.0, 10.0, 14.5, 24.0};
    camber_features *features = NULL;
    if (!fuzz_done(run, camber_features_create(run->context, style, &features)))
        return;
    if (add_features(run, features)) {
        check_layers(style, features);
        check_symbols(run, style, features);
        const camber_view_desc fitted = {.width = 64, .height = 48, .ratio = run->hash & 1 ? 2.0 : 0.0};
        const camber_view_desc centred = {.kind = CAMBER_VIEW_CENTER, .zoom = zooms[run->hash >> 4 & 3], .width = 300};
        fuzz_scene(run, features, &(camber_scene_desc){.view = fitted});
        fuzz_scene(run, features, &(camber_scene_desc){.view = centred, .simplify_px = 0.1});
    }
    camber_features_destroy(features);
}

static void use_expression(fuzz_run *run, const uint8_t *bytes, size_t size) {
    fuzz_bytes answer = {0};
    if (fuzz_done(run, camber_style_evaluate(run->context, (const char *)bytes, size, "fuzzed", fuzz_sink(&answer))))
        REQUIRE(answer.size > 2 && answer.bytes[0] == '{');
    free(answer.bytes);
}

/* Everything that is wrong has its place; a style without errors parses. */
static void use_report(fuzz_run *run, const uint8_t *bytes, size_t size, bool *right) {
    camber_style_report *report = NULL;
    *right = false;
    if (!fuzz_done(run, camber_style_check(run->context, (const char *)bytes, size, "fuzzed", &report)))
        return;
    size_t errors = 0;
    for (size_t i = 0; i < report->finding_count; i++) {
        const camber_style_finding *finding = report->findings + i;
        REQUIRE(finding->pointer[0] == 0 || finding->pointer[0] == '/');
        REQUIRE(finding->message[0]);
        errors += finding->error;
    }
    REQUIRE(errors == report->error_count);
    *right = errors == 0;
    camber_style_report_destroy(report);
}

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    camber_style *style = NULL;
    bool right;
    use_expression(run, bytes, size);
    use_report(run, bytes, size, &right);
    const camber_status status = camber_style_parse(run->context, (const char *)bytes, size, "fuzzed", &style);
    REQUIRE(!right || status != CAMBER_ERROR_INPUT);
    if (!fuzz_done(run, status))
        return;
    use_style(run, style);
    camber_style_destroy(style);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
