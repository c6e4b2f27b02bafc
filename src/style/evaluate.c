/* One expression over inputs, as the specification's own tests have it. */
#include "style/compiler.h"

#include <math.h>
#include <stdio.h>

typedef struct evaluator {
    camber_compiler compiler;
    camber_style style; /* gets the properties that are read */
    camber_expression *expression;
    json_t *document, *errors, *compiled, *outputs;
    camber_arena arena; /* of one input's values */
} evaluator;

/* ---- What it is for ---- */

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
    } types[] = {{"boolean", CAMBER_TYPE_BOOL},  {"number", CAMBER_TYPE_NUMBER},      {"string", CAMBER_TYPE_STRING},
                 {"enum", CAMBER_TYPE_STRING},   {"color", CAMBER_TYPE_COLOR},        {"array", CAMBER_TYPE_ARRAY},
                 {"object", CAMBER_TYPE_OBJECT}, {"resolvedImage", CAMBER_TYPE_IMAGE}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (json_is_string(name) && strcmp(json_string_value(name), types[i].name) == 0)
            return types[i].type;
    return CAMBER_TYPE_VALUE;
}

/* Members that are missing are the most general. */
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

/* ---- Documents ---- */

static bool compile(evaluator *e) {
    camber_compiler *c = &e->compiler;
    json_t *json = json_object_get(e->document, "expression");
    const camber_property property = read_property(json_object_get(e->document, "propertySpec"));
    c->report = keep_error;
    c->report_user = e;
    c->state = json_object_get(e->document, "globalState");
    const bool done = camber_compile_property(c, json, &property, &e->expression);
    json_object_set_new(e->compiled, "result", json_string(done ? "success" : "error"));
    if (!done)
        json_object_set(e->compiled, "errors", e->errors);
    return done;
}

static camber_status run(evaluator *e) {
    camber_compiler *c = &e->compiler;
    if (!json_object_get(e->document, "expression"))
        return camber_fail(c->context, CAMBER_ERROR_INPUT,
                           "%s: has no \"expression\"; write {\"expression\": ..., \"inputs\": [...]}", c->name);
    if (!e->errors || !e->compiled || !e->outputs)
        return camber_fail(c->context, CAMBER_ERROR_MEMORY, "%s: out of memory; give it more", c->name);
    compile(e);
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
    status = run(&e);
    if (status == CAMBER_OK)
        status = write_result(&e, sink);
    camber_expression_destroy(context, e.expression);
    camber_compiler_end(&e.compiler);
    for (size_t i = 0; i < e.style.property_count; i++)
        camber_free(context, e.style.properties[i]);
    camber_free(context, e.style.properties);
    camber_arena_free(&e.arena);
    json_decref(e.errors);
    json_decref(e.compiled);
    json_decref(e.outputs);
    json_decref(e.document);
    return status;
}
