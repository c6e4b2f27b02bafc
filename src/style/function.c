/* Compiles functions, the form that styles used before expressions: of zoom, of a feature's property, or of both.
 *
 * Input: {"stops": ...} and the property's definition. Output: nodes of an expression, as the specification's own
 * conversion from functions to expressions makes them. */
#include "style/operators.h"

#include <math.h>
#include <stdio.h>

static const camber_typing number_type = {.type = CAMBER_TYPE_NUMBER}, string_type = {.type = CAMBER_TYPE_STRING},
                           bool_type = {.type = CAMBER_TYPE_BOOL};

typedef enum shape {
    SHAPE_EXPONENTIAL,
    SHAPE_INTERVAL,
    SHAPE_CATEGORICAL,
    SHAPE_IDENTITY,
} shape;

typedef struct function {
    camber_compiler *c;
    const camber_property *property;
    camber_typing type;
    const json_t *object, *stops;
    json_t *otherwise; /* NULL: none */
    const char *key;   /* the feature's property. NULL: a function of zoom only */
    bool composite;    /* a function of both zoom and key */
    shape shape;
    double base;
    camber_color_space space;
} function;

/* ---- Reading ---- */

static bool read_shape(function *f) {
    static const char *const names[] = {"exponential", "interval", "categorical", "identity"};
    const json_t *type = json_object_get(f->object, "type");
    f->shape = !f->stops ? SHAPE_IDENTITY : f->property->interpolated ? SHAPE_EXPONENTIAL : SHAPE_INTERVAL;
    if (!type)
        return true;
    const char *name = json_is_string(type) ? json_string_value(type) : "";
    size_t found = 0;
    while (found < 4 && strcmp(names[found], name) != 0)
        found++;
    camber_compiler_enter_key(f->c, "type");
    if (found == 4)
        return camber_compiler_fail(f->c, "the function's type is not known; use \"exponential\", \"interval\", "
                                          "\"categorical\" or \"identity\"");
    const bool needs_key = found >= SHAPE_CATEGORICAL && !f->key;
    const bool lenient = f->c->strict && f->key;
    if (needs_key || (found == SHAPE_EXPONENTIAL && !f->property->interpolated && !lenient))
        return camber_compiler_fail(f->c, "the function's type is wrong for %s; use %s\"interval\" with stops on zoom",
                                    f->property->name, f->property->interpolated ? "\"exponential\" or " : "");
    if (found != SHAPE_IDENTITY && !f->stops)
        return camber_compiler_fail(f->c, "a function of this type needs stops; write \"stops\": [[10, 1], [16, 8]]");
    f->shape = f->stops ? (shape)found : SHAPE_IDENTITY;
    camber_compiler_leave(f->c);
    return true;
}

static bool read_base(function *f) {
    const json_t *json = json_object_get(f->object, "base");
    f->base = 1.0;
    if (!json)
        return true;
    if (!json_is_number(json) || !(json_number_value(json) > 0.0))
        return camber_compiler_fail(f->c, "base: expected a number above 0; write e.g. 1.5");
    f->base = json_number_value(json);
    return true;
}

static bool read_space(function *f) {
    const json_t *json = json_object_get(f->object, "colorSpace");
    const char *name = json ? json_string_value(json) : "rgb";
    if (name && strcmp(name, "hcl") == 0)
        f->space = CAMBER_SPACE_HCL;
    else if (name && strcmp(name, "lab") == 0)
        f->space = CAMBER_SPACE_LAB;
    else if (!name || strcmp(name, "rgb") != 0)
        return camber_compiler_fail(f->c, "colorSpace: expected \"rgb\", \"hcl\" or \"lab\"; write one of them");
    if (f->space != CAMBER_SPACE_RGB && f->shape == SHAPE_EXPONENTIAL && f->property->type != CAMBER_TYPE_COLOR)
        return camber_compiler_fail(f->c, "colorSpace: %s is not a colour; leave it out", f->property->name);
    return true;
}

static bool read_function(function *f) {
    const json_t *key = json_object_get(f->object, "property");
    f->key = json_string_value(key);
    f->stops = json_object_get(f->object, "stops");
    f->otherwise = json_object_get(f->object, "default");
    if (key && !f->key)
        return camber_compiler_fail(f->c, "property: expected a property's name, a string; write it out");
    if (f->stops ? json_array_size(f->stops) == 0 : !f->key)
        return camber_compiler_fail(f->c, "expected a constant, an expression, or a function with a list of stops; "
                                          "write e.g. {\"stops\": [[10, 1], [16, 8]]}");
    f->composite = json_is_object(json_array_get(json_array_get(f->stops, 0), 0));
    if (f->composite && !f->key)
        return camber_compiler_fail(
            f->c, "the stops have a zoom and a value, but the function has no \"property\"; name one");
    return read_shape(f) && read_base(f) && read_space(f);
}

/* ---- Values ---- */

static bool compile_get(function *f, uint32_t *node) {
    return camber_make_property(f->c, camber_evaluate_get, f->key, node);
}

/* Pushes a part of the text. Its copy lives as long as the expression. */
static bool push_text(function *f, const char *start, size_t length) {
    uint32_t node = 0;
    if (length == 0)
        return true;
    const char *text = camber_arena_text(&f->c->expression->arena, start, length);
    const camber_value value = {.type = CAMBER_VALUE_STRING, .string = text};
    if (!text)
        return camber_compiler_fail_memory(f->c);
    return camber_make_constant(f->c, &value, string_type, &node) && camber_push_operand(f->c, node);
}

/* Compiles "a {name}": the property's value replaces the token. */
static bool compile_tokens(function *f, const char *text, uint32_t *node) {
    camber_compiler *c = f->c;
    const size_t first_operand = c->operand_count;
    const char *rest = text;
    for (const char *open = strchr(text, '{'); open; open = strchr(open + 1, '{')) {
        const size_t length = strcspn(open + 1, "{}");
        if (length == 0 || open[1 + length] != '}')
            continue;
        const char *name = camber_arena_text(&c->expression->arena, open + 1, length);
        if (!name)
            return camber_compiler_fail_memory(c);
        if (!push_text(f, rest, (size_t)(open - rest)) || !camber_make_property(c, camber_evaluate_get, name, node) ||
            !camber_push_operand(c, *node))
            return false;
        rest = open + length + 2;
    }
    return push_text(f, rest, strlen(rest)) &&
           camber_make_node(c, &(camber_node){.evaluate = camber_evaluate_concat, .type = string_type}, first_operand,
                            node);
}

/* Compiles a value of the function, which must be a constant. */
static bool compile_value(function *f, const json_t *json, uint32_t *node) {
    camber_compiler *c = f->c;
    const bool tokens = f->property->tokens && !f->key && json_is_string(json) && strchr(json_string_value(json), '{');
    const bool names = f->property->item == CAMBER_TYPE_STRING || f->property->type == CAMBER_TYPE_ANCHORS;
    if (json_is_array(json) && json_is_string(json_array_get(json, 0)) && !names)
        return camber_compiler_fail(c, "a function's value must be a constant, found %s; use an expression instead",
                                    camber_json_name(json));
    if (!(tokens ? compile_tokens(f, json_string_value(json), node) : camber_make_json_constant(c, json, node)))
        return false;
    if (!camber_annotate(c, f->type, CAMBER_ANNOTATE_ASSERT, node))
        return false;
    const camber_node *made = camber_node_at(c, *node);
    return c->strict || !camber_is_constant(made) || camber_property_check(c, f->property, &made->value);
}

static bool push_value(function *f, const json_t *json) {
    uint32_t node = 0;
    return compile_value(f, json, &node) && camber_push_operand(f->c, node);
}

/* Pushes the function's default, or the specification's. */
static bool push_otherwise(function *f) {
    camber_compiler *c = f->c;
    if (f->otherwise)
        return push_value(f, f->otherwise);
    json_t *json = f->property->fallback ? json_loads(f->property->fallback, JSON_DECODE_ANY, NULL) : NULL;
    if (json) {
        const bool done = camber_expression_keep(c, json) && push_value(f, json);
        json_decref(json);
        return done;
    }
    if (c->strict)
        return camber_compiler_fail(c, "features that match no stop have no value; add a \"default\"");
    uint32_t node = 0;
    const camber_value cause = {.type = CAMBER_VALUE_STRING, .string = "no stop matches the feature"};
    return camber_make_constant(c, &cause, string_type, &node) &&
           camber_wrap_node(c, camber_evaluate_error, camber_typing_of(CAMBER_TYPE_ERROR), &node) &&
           camber_push_operand(c, node);
}

/* ---- Stops ---- */

/* Checks a stop: [input, value], or for both zoom and property [{"zoom": number, "value": input}, value]. */
static bool read_stop(function *f, size_t index, const json_t **input, double *zoom) {
    const json_t *stop = json_array_get(f->stops, index);
    *input = json_array_get(stop, 0);
    if (json_array_size(stop) != 2 || f->composite != json_is_object(*input))
        return camber_compiler_fail(f->c, "expected a stop [%s, value], found %s; correct it",
                                    f->composite ? "{\"zoom\": number, \"value\": input}"
                                    : f->key     ? "input"
                                                 : "zoom",
                                    camber_json_name(stop));
    if (f->composite) {
        const json_t *at = json_object_get(*input, "zoom");
        if (!json_is_number(at) || json_number_value(at) < *zoom)
            return camber_compiler_fail(f->c,
                                        "the stop's zoom is not a number, or is below the one before; sort the stops");
        *zoom = json_number_value(at);
        *input = json_object_get(*input, "value");
    }
    if (f->shape <= SHAPE_INTERVAL && !json_is_number(*input))
        return camber_compiler_fail(f->c,
                                    "expected a stop at a number, found %s; correct it, or write \"type\": "
                                    "\"categorical\"",
                                    camber_json_name(*input));
    return true;
}

/* The stops from first up to last, without last. They belong to one dimension. */
typedef struct span {
    size_t first, last;
} span;

/* Warns of a stop that has the same input as the previous one. */
static void warn_of_twin(function *f, const json_t *input) {
    char number[32];
    snprintf(number, sizeof number, "%g", json_number_value(input));
    if (f->c->constant_warnings >= CAMBER_CONSTANT_WARNING_LIMIT)
        return;
    f->c->constant_warnings++;
    camber_compiler_warn(f->c, "the previous stop is also at %.64s, and this one is used; remove one of them",
                         json_is_number(input)   ? number
                         : json_is_string(input) ? json_string_value(input)
                         : json_is_true(input)   ? "true"
                                                 : "false");
}

/* Pushes a stop's value and its position, which the first stop of a step does not have. */
static bool push_stop(function *f, size_t index, bool is_somewhere, double at) {
    if (is_somewhere && !camber_push_stop(f->c, at))
        return false;
    camber_compiler_enter_index(f->c, 1);
    if (!push_value(f, json_array_get(json_array_get(f->stops, index), 1)))
        return false;
    camber_compiler_leave(f->c);
    return true;
}

/* Pushes the stops and their values. Below its first stop a step has that stop's value. If several stops have the same
 * input, the last one applies from there on, and the first one below it, as in browsers; so a function may jump. At its
 * first input itself, browsers use the first value, hence the next double. The specification's tests of functions as
 * expressions keep only the first. */
static bool push_stops(function *f, span stops) {
    camber_compiler *c = f->c;
    const bool step = f->shape == SHAPE_INTERVAL;
    double before = -HUGE_VAL, start = HUGE_VAL, zoom = -HUGE_VAL;
    camber_compiler_enter_key(c, "stops");
    for (size_t i = stops.first; i < stops.last; i++) {
        const json_t *input;
        camber_compiler_enter_index(c, i);
        if (!read_stop(f, i, &input, &zoom))
            return false;
        const double at = json_number_value(input);
        const bool first = i == stops.first;
        if (at < before)
            return camber_compiler_fail(c, "the stop %g is below the one before; sort the stops", at);
        const bool twin = !first && at <= before;
        if (twin)
            warn_of_twin(f, input);
        start = first ? at : start;
        before = at;
        if (!(twin && c->strict) &&
            !push_stop(f, i, !first || !step, first || at > start ? at : nextafter(at, HUGE_VAL)))
            return false;
        camber_compiler_leave(c);
    }
    camber_compiler_leave(c);
    return true;
}

/* Makes a curve whose input is *node. */
static bool make_curve(function *f, span stops, double base, uint32_t *node) {
    camber_compiler *c = f->c;
    const size_t first_operand = c->operand_count;
    camber_node prototype = {.evaluate =
                                 f->shape == SHAPE_INTERVAL ? camber_evaluate_step : camber_evaluate_interpolate,
                             .type = f->type,
                             .space = (uint8_t)f->space,
                             .index = (uint32_t)c->expression->stop_count,
                             .value = {.type = CAMBER_VALUE_NUMBER, .number = base}};
    if (!camber_push_operand(c, *node) || !push_stops(f, stops))
        return false;
    prototype.index_count = (uint32_t)c->expression->stop_count - prototype.index;
    if (f->type.type == CAMBER_TYPE_VALUE)
        prototype.type = camber_node_at(c, c->operands[first_operand + 1])->type;
    return camber_make_node(c, &prototype, first_operand, node);
}

/* Compiles the curve for features whose property is a number. Others get the default, if there is one. */
static bool compile_property_curve(function *f, span stops, double base, uint32_t *node) {
    camber_compiler *c = f->c;
    const size_t first_operand = c->operand_count;
    uint32_t type = 0, name = 0;
    const camber_value text = {.type = CAMBER_VALUE_STRING, .string = "number"};
    if (f->otherwise) {
        const size_t comparison = c->operand_count;
        if (!compile_get(f, &type) || !camber_wrap_node(c, camber_evaluate_typeof, string_type, &type) ||
            !camber_make_constant(c, &text, string_type, &name) || !camber_push_operand(c, type) ||
            !camber_push_operand(c, name) ||
            !camber_make_node(c,
                              &(camber_node){.evaluate = camber_evaluate_comparison,
                                             .type = bool_type,
                                             .index = CAMBER_OUTCOME_EQUAL},
                              comparison, &type) ||
            !camber_push_operand(c, type))
            return false;
    }
    if (!compile_get(f, node) || !camber_wrap_node(c, camber_evaluate_assert, number_type, node) ||
        !make_curve(f, stops, base, node))
        return false;
    if (!f->otherwise)
        return true;
    const camber_typing curve_type = camber_node_at(c, *node)->type;
    return camber_push_operand(c, *node) && push_otherwise(f) &&
           camber_make_node(c, &(camber_node){.evaluate = camber_evaluate_case, .type = curve_type}, first_operand,
                            node);
}

/* ---- Categories ---- */

/* Whether the stop has the same input as the previous one. */
static bool is_twin(const function *f, size_t index) {
    const json_t *a = json_array_get(json_array_get(f->stops, index - 1), 0),
                 *b = json_array_get(json_array_get(f->stops, index), 0);
    return f->composite ? json_equal(json_object_get(a, "value"), json_object_get(b, "value")) : json_equal(a, b);
}

/* Pushes a stop's condition if inputs are booleans, otherwise its label. */
static bool push_category(function *f, const json_t *input, camber_match_label label, camber_type *type) {
    camber_compiler *c = f->c;
    uint32_t node = 0;
    if (*type != CAMBER_TYPE_BOOL)
        return camber_compile_label(c, input, label, type);
    const size_t first_operand = c->operand_count;
    return compile_get(f, &node) && camber_push_operand(c, node) && camber_make_json_constant(c, input, &node) &&
           camber_push_operand(c, node) &&
           camber_make_node(
               c,
               &(camber_node){.evaluate = camber_evaluate_comparison, .type = bool_type, .index = CAMBER_OUTCOME_EQUAL},
               first_operand, &node) &&
           camber_push_operand(c, node);
}

/* Compiles conditions for booleans, or a match of strings or numbers. If several stops have the same input, the last
 * one is used. */
static bool compile_categories(function *f, span stops, uint32_t *node) {
    camber_compiler *c = f->c;
    const size_t first_operand = c->operand_count, first_label = c->expression->label_count;
    const json_t *input = NULL;
    double zoom = -HUGE_VAL;
    if (!read_stop(f, stops.first, &input, &zoom))
        return false;
    camber_type type = json_is_boolean(input) ? CAMBER_TYPE_BOOL : CAMBER_TYPE_VALUE;
    camber_evaluate_fn *const evaluate = type == CAMBER_TYPE_BOOL ? camber_evaluate_case : camber_evaluate_match;
    if (evaluate == camber_evaluate_match && (!compile_get(f, node) || !camber_push_operand(c, *node)))
        return false;
    camber_compiler_enter_key(c, "stops");
    for (size_t i = stops.first; i < stops.last; i++) {
        camber_compiler_enter_index(c, i);
        if (!read_stop(f, i, &input, &zoom))
            return false;
        const camber_match_label label = {.output = (uint32_t)(c->operand_count - first_operand),
                                          .position = (uint32_t)i};
        if (i > stops.first && is_twin(f, i))
            warn_of_twin(f, input);
        const bool counts = c->strict ? i == stops.first || !is_twin(f, i) : i + 1 == stops.last || !is_twin(f, i + 1);
        if (counts &&
            (!push_category(f, input, label, &type) || !push_value(f, json_array_get(json_array_get(f->stops, i), 1))))
            return false;
        camber_compiler_leave(c);
    }
    if (!camber_sort_labels(c, first_label, true))
        return false;
    camber_compiler_leave(c);
    const camber_typing found = camber_node_at(c, c->operands[first_operand + 1])->type;
    const camber_node prototype = {.evaluate = evaluate,
                                   .type = f->type.type == CAMBER_TYPE_VALUE ? found : f->type,
                                   .index = (uint32_t)first_label,
                                   .index_count = (uint32_t)(c->expression->label_count - first_label)};
    return push_otherwise(f) && camber_make_node(c, &prototype, first_operand, node);
}

/* ---- Kinds ---- */

/* Compiles an identity function. The default replaces values of another type, and values that an enum does not have. */
static bool compile_identity(function *f, uint32_t *node) {
    camber_compiler *c = f->c;
    const size_t first_operand = c->operand_count, first_label = c->expression->label_count;
    const camber_type type = f->property->type;
    if (!compile_get(f, node))
        return false;
    if (!f->otherwise)
        return camber_annotate(c, f->type, CAMBER_ANNOTATE_ASSERT, node);
    if (!camber_push_operand(c, *node))
        return false;
    if (f->property->values) {
        for (size_t i = 0; f->property->values[i]; i++)
            if (!camber_push_label(c, &(camber_match_label){.string = f->property->values[i], .output = 1}))
                return false;
        const camber_node prototype = {.evaluate = camber_evaluate_match,
                                       .type = string_type,
                                       .index = (uint32_t)first_label,
                                       .index_count = (uint32_t)(c->expression->label_count - first_label)};
        return camber_sort_labels(c, first_label, true) && compile_get(f, node) &&
               camber_annotate(c, string_type, CAMBER_ANNOTATE_ASSERT, node) && camber_push_operand(c, *node) &&
               push_otherwise(f) && camber_make_node(c, &prototype, first_operand, node);
    }
    const camber_node prototype = {
        .evaluate = type == CAMBER_TYPE_VALUE ? camber_evaluate_coalesce : camber_conversion_to(type), .type = f->type};
    return push_otherwise(f) && camber_make_node(c, &prototype, first_operand, node);
}

static bool compile_dimension(function *f, span stops, double base, uint32_t *node) {
    return f->shape == SHAPE_CATEGORICAL ? compile_categories(f, stops, node)
                                         : compile_property_curve(f, stops, base, node);
}

/* Compiles a curve over zoom. Its outputs are functions of the property, each with the stops of one zoom. */
static bool compile_composite(function *f, uint32_t *node) {
    camber_compiler *c = f->c;
    const size_t count = json_array_size(f->stops), first_operand = c->operand_count;
    const bool step = !f->property->interpolated;
    /* The base and the colour space apply to the zoom. */
    const camber_color_space space = f->space;
    f->space = CAMBER_SPACE_RGB;
    if (!camber_make_reader(c, camber_evaluate_zoom, CAMBER_TYPE_NUMBER, node) || !camber_push_operand(c, *node))
        return false;
    double *zooms = camber_alloc(c->context, count, sizeof *zooms);
    size_t zoom_count = 0;
    bool done = zooms != NULL;
    for (size_t i = 0; done && i < count;) {
        const double at = json_number_value(json_object_get(json_array_get(json_array_get(f->stops, i), 0), "zoom"));
        span stops = {i, i + 1};
        while (stops.last < count && !(json_number_value(json_object_get(
                                           json_array_get(json_array_get(f->stops, stops.last), 0), "zoom")) > at))
            stops.last++;
        if (zoom_count > 0 && at < zooms[zoom_count - 1])
            done = camber_compiler_fail(c, "stops: the zoom %g is below the one before; sort the stops", at);
        zooms[zoom_count++] = at;
        done = done && compile_dimension(f, stops, 1.0, node) && camber_push_operand(c, *node);
        i = stops.last;
    }
    camber_node prototype = {.evaluate = step ? camber_evaluate_step : camber_evaluate_interpolate,
                             .type = f->type,
                             .space = (uint8_t)space,
                             .index = (uint32_t)c->expression->stop_count,
                             .value = {.type = CAMBER_VALUE_NUMBER, .number = c->strict ? 1.0 : f->base}};
    for (size_t i = step; done && i < zoom_count; i++)
        done = camber_push_stop(c, zooms[i]);
    prototype.index_count = (uint32_t)c->expression->stop_count - prototype.index;
    if (!zooms)
        c->status = CAMBER_ERROR_MEMORY;
    camber_free(c->context, zooms);
    return done && camber_make_node(c, &prototype, first_operand, node);
}

static bool compile_stops(function *f, uint32_t *node) {
    const span all = {0, json_array_size(f->stops)};
    if (f->composite)
        return compile_composite(f, node);
    if (f->key)
        return compile_dimension(f, all, f->base, node);
    return camber_make_reader(f->c, camber_evaluate_zoom, CAMBER_TYPE_NUMBER, node) &&
           make_curve(f, all, f->base, node);
}

bool camber_compile_function(camber_compiler *c, json_t *object, const camber_property *property, uint32_t *node) {
    function f = {.c = c, .property = property, .type = camber_property_typing(property), .object = object};
    const size_t first_node = c->expression->node_count;
    if (!read_function(&f))
        return false;
    if (f.shape == SHAPE_IDENTITY)
        return compile_identity(&f, node);
    if (!compile_stops(&f, node))
        return false;
    for (size_t i = first_node; i < c->expression->node_count; i++)
        if (c->expression->nodes[i].evaluate == camber_evaluate_interpolate &&
            !camber_is_interpolated(c->expression->nodes[i].type))
            return camber_compiler_fail(c, "%s is not interpolated; write \"type\": \"interval\"", property->name);
    return true;
}

bool camber_compile_tokens(camber_compiler *c, const json_t *json, const camber_property *property, uint32_t *node) {
    function f = {.c = c, .property = property, .type = camber_property_typing(property)};
    return compile_value(&f, json, node);
}
