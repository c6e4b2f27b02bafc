/* Evaluates one expression for a list of inputs, in the format of the specification's own tests.
 *
 * Input: {"expression": ..., "propertySpec": ..., "inputs": [...]}. Output: JSON with the compiled type or the errors,
 * and an output for each input. `camber style eval` prints it. */
#include "style/compiler.h"
#include "style/section.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct evaluator {
    camber_compiler compiler;
    camber_style style; /* collects the properties that the expression reads */
    camber_expression *expression;
    json_t *document, *errors, *compiled, *outputs;
    camber_arena arena; /* memory of one input's values */
} evaluator;

/* ---- The use of a result ---- */

static bool has_text(const json_t *array, const char *text) {
    for (size_t i = 0; i < json_array_size(array); i++) {
        const char *item = json_string_value(json_array_get(array, i));
        if (item && strcmp(item, text) == 0)
            return true;
    }
    return false;
}

static camber_type type_of(const json_t *name) {
    static const struct {
        const char *name;
        camber_type type;
    } types[] = {{"boolean", CAMBER_TYPE_BOOL},
                 {"number", CAMBER_TYPE_NUMBER},
                 {"string", CAMBER_TYPE_STRING},
                 {"enum", CAMBER_TYPE_STRING},
                 {"color", CAMBER_TYPE_COLOR},
                 {"array", CAMBER_TYPE_ARRAY},
                 {"object", CAMBER_TYPE_OBJECT},
                 {"resolvedImage", CAMBER_TYPE_IMAGE},
                 {"formatted", CAMBER_TYPE_FORMATTED},
                 {"padding", CAMBER_TYPE_PADDING},
                 {"variableAnchorOffsetCollection", CAMBER_TYPE_ANCHORS}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (json_is_string(name) && strcmp(json_string_value(name), types[i].name) == 0)
            return types[i].type;
    return CAMBER_TYPE_VALUE;
}

/* Reads the property's definition. Missing members allow as much as possible. */
static camber_property read_property(const json_t *json) {
    const json_t *expression = json_object_get(json, "expression");
    const json_t *parameters = json_object_get(expression, "parameters");
    const char *kind = json_string_value(json_object_get(json, "property-type"));
    camber_property property = {.name = "the property",
                                .type = type_of(json_object_get(json, "type")),
                                .item = type_of(json_object_get(json, "value")),
                                .interpolated = true,
                                .data_driven = true,
                                .tokens = json_is_true(json_object_get(json, "tokens"))};
    const double length = json_number_value(json_object_get(json, "length"));
    if (length >= 1.0 && length < UINT32_MAX)
        property.length = (uint32_t)length;
    if (expression) {
        property.interpolated = json_is_true(json_object_get(expression, "interpolated"));
        property.without_zoom = !has_text(parameters, "zoom");
        property.line_progress = has_text(parameters, "line-progress");
    }
    if (kind)
        property.data_driven = strcmp(kind, "data-driven") == 0 || strcmp(kind, "cross-faded-data-driven") == 0;
    return property;
}

/* ---- Errors ---- */

static void keep_error(void *user, const camber_compiler *c, camber_log_level level, const char *message) {
    evaluator *e = user;
    char key[256] = "";
    size_t used = 0;
    for (size_t i = 0; i < c->path_length && i < CAMBER_PATH_DEPTH && used + 32 < sizeof key; i++)
        used += (size_t)(c->path[i].key ? snprintf(key + used, sizeof key - used, ".%.24s", c->path[i].key)
                                        : snprintf(key + used, sizeof key - used, "[%zu]", c->path[i].index));
    if (level == CAMBER_LOG_ERROR)
        json_array_append_new(e->errors, json_pack("{s:s, s:s}", "key", key, "error", message));
}

/* ---- Compiling ---- */

/* Returns the names of an enum, NULL at the end. NULL: out of memory. */
static const char **list_names(evaluator *e, const json_t *values) {
    const char **names = camber_alloc(e->compiler.context, json_object_size(values) + 1, sizeof *names);
    const char *key;
    json_t *value;
    size_t count = 0;
    if (!names) {
        e->compiler.status = CAMBER_ERROR_MEMORY;
        return NULL;
    }
    json_object_foreach((json_t *)(uintptr_t)values, key, value) {
        (void)value;
        names[count++] = key;
    }
    names[count] = NULL;
    return names;
}

static bool compile(evaluator *e) {
    camber_compiler *c = &e->compiler;
    const json_t *specification = json_object_get(e->document, "propertySpec");
    const json_t *values = json_object_get(specification, "values"),
                 *fallback = json_object_get(specification, "default");
    camber_property property = read_property(specification);
    const char **names = json_object_size(values) ? list_names(e, values) : NULL;
    char *text = fallback ? json_dumps(fallback, JSON_ENCODE_ANY) : NULL;
    property.values = names;
    property.fallback = text;
    c->report = keep_error;
    c->report_user = e;
    c->strict = true;
    c->state = json_object_get(e->document, "globalState");
    json_t *filter = json_object_get(e->document, "filter");
    const bool done =
        c->status == CAMBER_OK &&
        (filter ? camber_compile_filter(c, filter, &e->expression)
                : camber_compile_property(c, json_object_get(e->document, "expression"), &property, &e->expression));
    camber_free(c->context, names);
    free(text);
    return done;
}

static void describe(evaluator *e) {
    char type[CAMBER_TYPING_TEXT_SIZE];
    json_object_set_new(e->compiled, "result", json_string(e->expression ? "success" : "error"));
    if (!e->expression) {
        json_object_set(e->compiled, "errors", e->errors);
        return;
    }
    camber_typing_write(e->expression->nodes[e->expression->root].type, type);
    json_object_set_new(e->compiled, "type", json_string(type));
    json_object_set_new(e->compiled, "isFeatureConstant", json_boolean(!e->expression->reads_feature));
    json_object_set_new(e->compiled, "isZoomConstant", json_boolean(!e->expression->reads_zoom));
}

/* ---- Evaluating ---- */

/* Components are floats, whose first seven digits are exact. */
static json_t *component(double number) {
    char text[32];
    snprintf(text, sizeof text, "%.7g", number);
    return json_real(strtod(text, NULL));
}

/* Whether an image exists. user: the array of the names of images. */
static uint32_t find_image(void *user, const char *name) {
    return has_text(user, name);
}

/* images: which images exist. NULL: it is not known, and every image is reported as missing. */
static json_t *to_json(const camber_style_images *images, const camber_value *value);

/* Writes a colour as the specification's tests do: multiplied by alpha, and as an object if a colour was not expected.
 */
static json_t *color_to_json(camber_color color, bool expected) {
    static const char *const names[] = {"r", "g", "b", "a"};
    const double a = (double)color.a;
    const double parts[4] = {(double)color.r * a, (double)color.g * a, (double)color.b * a, a};
    json_t *made = expected ? json_array() : json_object();
    for (size_t i = 0; i < 4; i++)
        if (expected)
            json_array_append_new(made, component(parts[i]));
        else
            json_object_set_new(made, names[i], component(parts[i]));
    return made;
}

static json_t *object_to_json(const camber_style_images *images, const camber_value *value) {
    json_t *object = json_object();
    for (uint32_t place = 0; place < value->count; place++)
        json_object_set_new(object, value->members[place].key, to_json(images, &value->members[place].value));
    return object;
}

static json_t *string_to_json(const char *text) {
    json_t *string = json_string(text);
    return string ? string : json_string_nocheck("not UTF-8");
}

static json_t *image_to_json(const camber_style_images *images, const char *name) {
    const bool available = images && images->find(images->user, name) != 0;
    return json_pack("{s:o, s:b}", "name", string_to_json(name), "available", available);
}

/* Writes the names of fonts, separated by commas. */
static json_t *fonts_to_json(const camber_value *fonts) {
    char text[1024] = "";
    size_t used = 0;
    if (fonts->type != CAMBER_VALUE_ARRAY)
        return json_null();
    for (uint32_t i = 0; i < fonts->count && used < sizeof text; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", i ? "," : "",
                                 fonts->items[i].type == CAMBER_VALUE_STRING ? fonts->items[i].string : "");
    return string_to_json(text);
}

static json_t *formatted_to_json(const camber_style_images *images, const camber_value *value) {
    json_t *sections = json_array();
    for (uint32_t i = 0; i < value->count; i++) {
        const camber_text_section *section = value->sections + i;
        json_array_append_new(sections,
                              json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "text", string_to_json(section->text),
                                        "image", section->image ? image_to_json(images, section->image) : json_null(),
                                        "scale", to_json(images, &section->scale), "fontStack",
                                        fonts_to_json(&section->fonts), "textColor", to_json(images, &section->color),
                                        "verticalAlign", to_json(images, &section->align)));
    }
    return json_pack("{s:o}", "sections", sections);
}

/* Writes whole numbers without a point, as ECMAScript does. */
static json_t *number_to_json(double number) {
    if (!isfinite(number))
        return json_null();
    return fabs(number) < 9e15 && !(number > floor(number)) ? json_integer((json_int_t)number) : json_real(number);
}

static json_t *to_json(const camber_style_images *images, const camber_value *value) {
    switch (value->type) {
    case CAMBER_VALUE_NULL: break;
    case CAMBER_VALUE_BOOL: return json_boolean(value->boolean);
    case CAMBER_VALUE_NUMBER: return number_to_json(value->number);
    case CAMBER_VALUE_STRING:
        return value->boolean ? image_to_json(images, value->string) : string_to_json(value->string);
    case CAMBER_VALUE_FORMATTED: return formatted_to_json(images, value);
    case CAMBER_VALUE_COLOR: return color_to_json(value->color, false);
    case CAMBER_VALUE_ARRAY: {
        json_t *array = json_array();
        for (uint32_t i = 0; i < value->count; i++)
            json_array_append_new(array, to_json(images, &value->items[i]));
        return array;
    }
    case CAMBER_VALUE_OBJECT: return object_to_json(images, value);
    }
    return json_null();
}

/* Fills in the values that the expression reads from the feature. values has room for all properties of the style. */
static bool read_feature(evaluator *e, const json_t *json, camber_value *values, camber_value *all,
                         camber_feature_view *feature) {
    static const camber_value empty = {.type = CAMBER_VALUE_OBJECT};
    const json_t *properties = json_object_get(json, "properties"), *id = json_object_get(json, "id");
    const json_t *geometry = json_object_get(json, "geometry");
    *all = empty;
    *feature = (camber_feature_view){.values = values, .all = all};
    feature->geometry_type = json_string_value(json_object_get(geometry, "type"));
    if (json_is_object(properties) && !camber_json_to_value(&e->arena, properties, all))
        return camber_compiler_fail_memory(&e->compiler);
    if (id && !camber_json_to_value(&e->arena, id, &feature->id))
        return camber_compiler_fail_memory(&e->compiler);
    for (size_t i = 0; i < e->style.schema.property_count; i++) {
        const camber_value *value = camber_object_get(all, e->style.schema.properties[i]);
        values[i] = value ? *value : (camber_value){.type = CAMBER_VALUE_NULL};
    }
    return true;
}

/* Writes a result. Types that have no form in JSON are written as the specification's tests do. */
static json_t *result_to_json(const evaluator *e, const camber_style_images *images, const camber_value *value) {
    switch (e->expression->nodes[e->expression->root].type.type) {
    case CAMBER_TYPE_COLOR:
        return value->type == CAMBER_VALUE_COLOR ? color_to_json(value->color, true) : to_json(images, value);
    case CAMBER_TYPE_PADDING:
    case CAMBER_TYPE_ANCHORS: return json_pack("{s:o}", "values", to_json(images, value));
    default: return to_json(images, value);
    }
}

static bool run_input(evaluator *e, const json_t *input, camber_value *values) {
    const json_t *globals = json_array_get(input, 0);
    camber_feature_view feature;
    camber_evaluation evaluation;
    camber_value all, value;
    if (!read_feature(e, json_array_get(input, 1), values, &all, &feature))
        return false;
    camber_evaluation_begin(&evaluation, json_number_value(json_object_get(globals, "zoom")), &feature);
    json_t *available = json_object_get(globals, "availableImages");
    const camber_style_images images = {.find = find_image, .user = available};
    evaluation.images = available ? &images : NULL;
    evaluation.line_progress = json_number_value(json_object_get(globals, "lineProgress"));
    const bool done = camber_expression_evaluate(e->expression, &evaluation, &value);
    json_t *output =
        done ? result_to_json(e, evaluation.images, &value) : json_pack("{s:s}", "error", evaluation.cause);
    const bool held = json_array_append_new(e->outputs, output) == 0;
    camber_evaluation_end(&evaluation);
    camber_arena_free(&e->arena);
    e->arena = (camber_arena){.context = e->compiler.context, .limit = SIZE_MAX};
    return held || camber_compiler_fail_memory(&e->compiler);
}

static bool run_inputs(evaluator *e) {
    const json_t *inputs = json_object_get(e->document, "inputs");
    camber_value *values = camber_alloc(e->compiler.context, e->style.schema.property_count, sizeof *values);
    bool done = values != NULL;
    for (size_t i = 0; done && i < json_array_size(inputs); i++)
        done = run_input(e, json_array_get(inputs, i), values);
    if (!values)
        e->compiler.status = CAMBER_ERROR_MEMORY;
    camber_free(e->compiler.context, values);
    return done;
}

/* ---- Documents ---- */

static camber_status run_document(evaluator *e) {
    camber_compiler *c = &e->compiler;
    if (!json_object_get(e->document, "expression") && !json_object_get(e->document, "filter"))
        return camber_fail(c->context, CAMBER_ERROR_INPUT,
                           "%s: there is no \"expression\"; write {\"expression\": ..., \"inputs\": [...]}", c->name);
    if (!e->errors || !e->compiled || !e->outputs)
        return camber_fail(c->context, CAMBER_ERROR_MEMORY, "%s: out of memory; give it more", c->name);
    if (compile(e))
        run_inputs(e);
    describe(e);
    return c->status == CAMBER_ERROR_MEMORY ? c->status : CAMBER_OK;
}

static int write_text(const char *buffer, size_t size, void *data) {
    const camber_sink *sink = data;
    return sink->write(sink->user, buffer, size) ? 0 : -1;
}

static camber_status write_result(evaluator *e, camber_sink sink) {
    json_t *result = json_object();
    json_object_set(result, "compiled", e->compiled);
    if (e->expression)
        json_object_set(result, "outputs", e->outputs);
    const bool written = json_dump_callback(result, write_text, &sink, JSON_COMPACT | JSON_REAL_PRECISION(15)) == 0 &&
                         sink.write(sink.user, "\n", 1);
    json_decref(result);
    return written ? CAMBER_OK
                   : camber_fail(e->compiler.context, CAMBER_ERROR_IO, "%s: the result cannot be written; make room",
                                 e->compiler.name);
}

camber_status camber_style_evaluate(camber_context *context, const char *json, size_t size_bytes, const char *name,
                                    camber_sink sink) {
    evaluator e = {.compiler = {.context = context, .style = &e.style, .name = name},
                   .style = {.context = context},
                   .arena = {.context = context, .limit = SIZE_MAX}};
    camber_status status = camber_json_read(context, json, size_bytes, name, &e.document);
    if (status != CAMBER_OK)
        return status;
    e.errors = json_array();
    e.compiled = json_object();
    e.outputs = json_array();
    status = run_document(&e);
    if (status == CAMBER_OK)
        status = write_result(&e, sink);
    camber_expression_destroy(context, e.expression);
    camber_compiler_end(&e.compiler);
    for (size_t i = 0; i < e.style.schema.property_count; i++)
        camber_free(context, e.style.schema.properties[i]);
    camber_free(context, e.style.schema.properties);
    camber_arena_free(&e.arena);
    json_decref(e.errors);
    json_decref(e.compiled);
    json_decref(e.outputs);
    json_decref(e.document);
    return status;
}
