#include "style/expression.h"

#include "style/color.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The depth of nodes is bounded by the compiler, and with it the recursion here. */
static bool evaluate(camber_evaluation *e, const camber_node *node, camber_value *value);

static bool fail(camber_evaluation *e, const char *cause) {
    e->cause = cause;
    return false;
}

static bool evaluate_operand(camber_evaluation *e, const camber_node *node, uint32_t operand, camber_value *value) {
    const camber_expression *expression = e->expression;
    return evaluate(e, &expression->nodes[expression->links[node->first + operand]], value);
}

static camber_value from_bool(bool boolean) {
    return (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = boolean};
}

static camber_value from_number(double number) {
    return (camber_value){.type = CAMBER_VALUE_NUMBER, .number = number};
}

static camber_value from_string(const char *string) {
    return (camber_value){.type = CAMBER_VALUE_STRING, .string = string};
}

static bool has_type(const camber_value *value, camber_type type) {
    switch (type) {
    case CAMBER_TYPE_VALUE: return true;
    case CAMBER_TYPE_NULL: return value->type == CAMBER_VALUE_NULL;
    case CAMBER_TYPE_BOOL: return value->type == CAMBER_VALUE_BOOL;
    case CAMBER_TYPE_NUMBER: return value->type == CAMBER_VALUE_NUMBER;
    case CAMBER_TYPE_STRING: return value->type == CAMBER_VALUE_STRING;
    case CAMBER_TYPE_COLOR: return value->type == CAMBER_VALUE_COLOR;
    case CAMBER_TYPE_ARRAY:
    case CAMBER_TYPE_OBJECT:
    case CAMBER_TYPE_IMAGE: return false;
    }
    return false;
}

static bool evaluate_assert(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i < node->count; i++) {
        if (!evaluate_operand(e, node, i, value))
            return false;
        if (has_type(value, node->type))
            return true;
    }
    return fail(e, node->type == CAMBER_TYPE_NUMBER   ? "a number is wanted and the value is not one"
                   : node->type == CAMBER_TYPE_STRING ? "a string is wanted and the value is not one"
                                                      : "a boolean is wanted and the value is not one");
}

/* ---- Conversions ---- */

/* Number(string) of ECMAScript for decimal text; other notations are no numbers here. */
static bool string_to_number(const char *text, double *number) {
    text += strspn(text, " \t\r\n\f\v");
    if (*text == 0) {
        *number = 0.0;
        return true;
    }
    text = camber_number_parse(text, number);
    return text && text[strspn(text, " \t\r\n\f\v")] == 0;
}

static bool to_number(const camber_value *value, double *number) {
    switch (value->type) {
    case CAMBER_VALUE_NULL: *number = 0.0; return true;
    case CAMBER_VALUE_BOOL: *number = value->boolean ? 1.0 : 0.0; return true;
    case CAMBER_VALUE_NUMBER: *number = value->number; return !isnan(value->number);
    case CAMBER_VALUE_STRING: return string_to_number(value->string, number);
    case CAMBER_VALUE_COLOR:
    case CAMBER_VALUE_ARRAY:
    case CAMBER_VALUE_OBJECT: return false;
    }
    return false;
}

/* The value's text, in scratch where it has none of its own. */
static const char *to_text(const camber_value *value, char scratch[CAMBER_SCRATCH_SIZE]) {
    char number[CAMBER_NUMBER_TEXT_SIZE];
    switch (value->type) {
    case CAMBER_VALUE_NULL: return "";
    case CAMBER_VALUE_BOOL: return value->boolean ? "true" : "false";
    case CAMBER_VALUE_STRING: return value->string;
    case CAMBER_VALUE_NUMBER: camber_number_format(value->number, scratch); return scratch;
    case CAMBER_VALUE_COLOR:
        camber_number_format(round((double)value->color.a * 1e6) / 1e6, number);
        snprintf(scratch, CAMBER_SCRATCH_SIZE, "rgba(%.0f,%.0f,%.0f,%s)", round((double)value->color.r * 255.0),
                 round((double)value->color.g * 255.0), round((double)value->color.b * 255.0), number);
        return scratch;
    case CAMBER_VALUE_ARRAY:
    case CAMBER_VALUE_OBJECT: break;
    }
    return "";
}

static bool to_bool(const camber_value *value) {
    switch (value->type) {
    case CAMBER_VALUE_NULL: return false;
    case CAMBER_VALUE_BOOL: return value->boolean;
    case CAMBER_VALUE_NUMBER: return value->number < 0.0 || value->number > 0.0;
    case CAMBER_VALUE_STRING: return value->string[0] != 0;
    case CAMBER_VALUE_COLOR:
    case CAMBER_VALUE_ARRAY:
    case CAMBER_VALUE_OBJECT: return true;
    }
    return false;
}

static bool evaluate_to_number(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double number;
    for (uint32_t i = 0; i < node->count; i++) {
        if (!evaluate_operand(e, node, i, value))
            return false;
        if (to_number(value, &number)) {
            *value = from_number(number);
            return true;
        }
    }
    return fail(e, "the value is not the text of a number");
}

static bool evaluate_to_color(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i < node->count; i++) {
        if (!evaluate_operand(e, node, i, value))
            return false;
        if (value->type == CAMBER_VALUE_COLOR)
            return true;
        camber_color color;
        if (value->type == CAMBER_VALUE_STRING && camber_color_parse(value->string, &color)) {
            *value = (camber_value){.type = CAMBER_VALUE_COLOR, .color = color};
            return true;
        }
    }
    return fail(e, "the value is not a CSS colour such as \"#a0c4ff\" or \"rgba(0, 0, 0, 0.5)\"");
}

/* ---- Comparisons and decisions ---- */

static bool numbers_equal(double a, double b) {
    return a >= b && a <= b;
}

static bool equal(const camber_value *a, const camber_value *b) {
    if (a->type != b->type)
        return false;
    switch (a->type) {
    case CAMBER_VALUE_NULL: return true;
    case CAMBER_VALUE_BOOL: return a->boolean == b->boolean;
    case CAMBER_VALUE_NUMBER: return numbers_equal(a->number, b->number);
    case CAMBER_VALUE_STRING: return strcmp(a->string, b->string) == 0;
    case CAMBER_VALUE_COLOR: /* the compiler refuses these */
    case CAMBER_VALUE_ARRAY:
    case CAMBER_VALUE_OBJECT: return false;
    }
    return false;
}

static bool evaluate_order(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value a, b;
    if (!evaluate_operand(e, node, 0, &a) || !evaluate_operand(e, node, 1, &b))
        return false;
    if (a.type != b.type || (a.type != CAMBER_VALUE_NUMBER && a.type != CAMBER_VALUE_STRING))
        return fail(e, "two numbers or two strings are wanted");
    bool less, greater;
    if (a.type == CAMBER_VALUE_NUMBER) {
        less = a.number < b.number;
        greater = a.number > b.number;
        if (isnan(a.number) || isnan(b.number)) {
            *value = from_bool(false);
            return true;
        }
    } else {
        const int order = strcmp(a.string, b.string);
        less = order < 0;
        greater = order > 0;
    }
    *value = from_bool(node->op == CAMBER_OP_LESS         ? less
                       : node->op == CAMBER_OP_LESS_EQUAL ? !greater
                       : node->op == CAMBER_OP_GREATER    ? greater
                                                          : !less);
    return true;
}

static bool evaluate_in(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const camber_expression *expression = e->expression;
    camber_value needle, haystack;
    if (!evaluate_operand(e, node, 0, &needle))
        return false;
    if (needle.type == CAMBER_VALUE_COLOR)
        return fail(e, "a colour cannot be looked for");
    const camber_node *array = &expression->nodes[expression->links[node->first + 1]];
    bool found = false;
    if (array->op == CAMBER_OP_ARRAY) {
        for (uint32_t i = 0; i < array->count && !found; i++)
            found = equal(&needle, &expression->nodes[expression->links[array->first + i]].value);
    } else {
        if (!evaluate(e, array, &haystack))
            return false;
        if (haystack.type != CAMBER_VALUE_STRING && haystack.type != CAMBER_VALUE_NULL)
            return fail(e, "\"in\" looks in a string or an array");
        char scratch[CAMBER_SCRATCH_SIZE];
        /* As ECMAScript's indexOf, which looks for "null". */
        const char *text = needle.type == CAMBER_VALUE_NULL ? "null" : to_text(&needle, scratch);
        found = haystack.type == CAMBER_VALUE_STRING && haystack.string[0] && strstr(haystack.string, text);
    }
    *value = from_bool(found);
    return true;
}

static bool evaluate_bool(camber_evaluation *e, const camber_node *node, uint32_t operand, bool *boolean) {
    camber_value value;
    if (!evaluate_operand(e, node, operand, &value))
        return false;
    if (value.type != CAMBER_VALUE_BOOL)
        return fail(e, "a boolean is wanted and the value is not one");
    *boolean = value.boolean;
    return true;
}

/* all stops at the first false, any at the first true. */
static bool evaluate_junction(camber_evaluation *e, const camber_node *node, camber_value *value) {
    bool result = node->op == CAMBER_OP_ALL;
    for (uint32_t i = 0; i < node->count; i++) {
        if (!evaluate_bool(e, node, i, &result))
            return false;
        if (result != (node->op == CAMBER_OP_ALL))
            break;
    }
    *value = from_bool(result);
    return true;
}

static bool evaluate_case(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i + 1 < node->count; i += 2) {
        bool condition;
        if (!evaluate_bool(e, node, i, &condition))
            return false;
        if (condition)
            return evaluate_operand(e, node, i + 1, value);
    }
    return evaluate_operand(e, node, node->count - 1, value);
}

static int compare_label(const camber_value *value, const camber_label *label) {
    if (label->string)
        return strcmp(value->string, label->string);
    return value->number < label->number ? -1 : value->number > label->number;
}

static bool evaluate_match(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value input;
    if (!evaluate_operand(e, node, 0, &input))
        return false;
    const camber_label *labels = &e->expression->labels[node->index];
    const bool strings = labels[0].string != NULL;
    uint32_t low = 0, high = node->index_count;
    if (input.type != (strings ? CAMBER_VALUE_STRING : CAMBER_VALUE_NUMBER) || (!strings && isnan(input.number)))
        high = 0;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const int order = compare_label(&input, &labels[middle]);
        if (order == 0)
            return evaluate_operand(e, node, labels[middle].output, value);
        if (order > 0)
            low = middle + 1;
        else
            high = middle;
    }
    return evaluate_operand(e, node, node->count - 1, value);
}

static bool evaluate_coalesce(camber_evaluation *e, const camber_node *node, camber_value *value) {
    *value = (camber_value){.type = CAMBER_VALUE_NULL};
    for (uint32_t i = 0; i < node->count && value->type == CAMBER_VALUE_NULL; i++)
        if (!evaluate_operand(e, node, i, value))
            return false;
    return true;
}

/* ---- Curves ---- */

/* How many of the node's stops are at or below input. */
static uint32_t count_stops(const camber_expression *expression, const camber_node *node, double input) {
    uint32_t low = 0, high = node->index_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (expression->stops[node->index + middle] <= input)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool evaluate_input(camber_evaluation *e, const camber_node *node, double *input) {
    camber_value value;
    if (!evaluate_operand(e, node, 0, &value))
        return false;
    if (value.type != CAMBER_VALUE_NUMBER || isnan(value.number))
        return fail(e, "a number is wanted and the value is not one");
    *input = value.number;
    return true;
}

static bool evaluate_step(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double input;
    if (!evaluate_input(e, node, &input))
        return false;
    const uint32_t passed = count_stops(e->expression, node, input);
    return evaluate_operand(e, node, 1 + passed, value);
}

/* How far input is from low to high, as the specification's exponential interpolation has it. */
static double interpolation_factor(double input, double base, double low, double high) {
    double span = high - low, progress = input - low;
    if (!isfinite(span)) { /* stops so far apart that only half of it is a number */
        span = high * 0.5 - low * 0.5;
        progress = input * 0.5 - low * 0.5;
    }
    if (numbers_equal(base, 1.0))
        return progress / span;
    const double factor = (pow(base, progress) - 1.0) / (pow(base, span) - 1.0);
    return isfinite(factor) ? factor : progress / span;
}

static float mix(float a, float b, double t) {
    return (float)((double)a * (1.0 - t) + (double)b * t);
}

static bool evaluate_interpolate(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double input;
    if (!evaluate_input(e, node, &input))
        return false;
    const double *stops = &e->expression->stops[node->index];
    const uint32_t passed = count_stops(e->expression, node, input);
    if (passed == 0)
        return evaluate_operand(e, node, 1, value);
    const uint32_t lower = passed - 1;
    if (passed == node->index_count || numbers_equal(stops[lower], input))
        return evaluate_operand(e, node, 1 + lower, value);
    camber_value low, high;
    if (!evaluate_operand(e, node, 1 + lower, &low) || !evaluate_operand(e, node, 2 + lower, &high))
        return false;
    const double t = interpolation_factor(input, node->value.number, stops[lower], stops[lower + 1]);
    if (low.type == CAMBER_VALUE_NUMBER && high.type == CAMBER_VALUE_NUMBER) {
        *value = from_number(low.number * (1.0 - t) + high.number * t);
        return true;
    }
    if (low.type != CAMBER_VALUE_COLOR || high.type != CAMBER_VALUE_COLOR)
        return fail(e, "two numbers or two colours are wanted");
    /* Straight components are mixed, not premultiplied ones: so do the specification's own tests. */
    const camber_color a = low.color, b = high.color;
    *value = (camber_value){.type = CAMBER_VALUE_COLOR,
                            .color = {mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t), mix(a.a, b.a, t)}};
    return true;
}

static bool evaluate_arithmetic(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double result = node->op == CAMBER_OP_MULTIPLY ? 1.0 : 0.0;
    for (uint32_t i = 0; i < node->count; i++) {
        camber_value operand;
        if (!evaluate_operand(e, node, i, &operand))
            return false;
        if (operand.type != CAMBER_VALUE_NUMBER)
            return fail(e, "a number is wanted and the value is not one");
        const double number = operand.number;
        if (i == 0 && node->op != CAMBER_OP_ADD && node->op != CAMBER_OP_MULTIPLY)
            result = node->count == 1 ? -number : number;
        else if (node->op == CAMBER_OP_ADD)
            result += number;
        else if (node->op == CAMBER_OP_SUBTRACT)
            result -= number;
        else if (node->op == CAMBER_OP_MULTIPLY)
            result *= number;
        else
            result /= number;
    }
    *value = from_number(result);
    return true;
}

static bool evaluate_feature(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!e->feature)
        return fail(e, "there is no feature to read");
    if (node->op == CAMBER_OP_GEOMETRY_TYPE)
        *value = from_string(e->feature->geometry_type);
    else if (node->op == CAMBER_OP_HAS)
        *value = from_bool(e->feature->values[node->index].type != CAMBER_VALUE_NULL);
    else
        *value = e->feature->values[node->index];
    return true;
}

static bool evaluate_equality(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value a, b;
    if (!evaluate_operand(e, node, 0, &a) || !evaluate_operand(e, node, 1, &b))
        return false;
    *value = from_bool(equal(&a, &b) == (node->op == CAMBER_OP_EQUAL));
    return true;
}

static bool evaluate_unary(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const bool done = evaluate_operand(e, node, 0, value);
    if (node->op == CAMBER_OP_QUIET) {
        if (!done)
            *value = from_bool(false);
        return true;
    }
    if (!done)
        return false;
    if (node->op == CAMBER_OP_TO_STRING)
        *value = from_string(to_text(value, e->scratch[node->index]));
    else if (node->op == CAMBER_OP_TO_BOOL)
        *value = from_bool(to_bool(value));
    else if (value->type != CAMBER_VALUE_BOOL)
        return fail(e, "a boolean is wanted and the value is not one");
    else
        value->boolean = !value->boolean;
    return true;
}

static bool evaluate(camber_evaluation *e, const camber_node *node, camber_value *value) {
    switch (node->op) {
    case CAMBER_OP_CONSTANT: *value = node->value; return true;
    case CAMBER_OP_ARRAY: return fail(e, "an array is not a value here");
    case CAMBER_OP_GET:
    case CAMBER_OP_HAS:
    case CAMBER_OP_GEOMETRY_TYPE: return evaluate_feature(e, node, value);
    case CAMBER_OP_ZOOM: *value = from_number(e->zoom); return true;
    case CAMBER_OP_ASSERT: return evaluate_assert(e, node, value);
    case CAMBER_OP_TO_NUMBER: return evaluate_to_number(e, node, value);
    case CAMBER_OP_TO_COLOR: return evaluate_to_color(e, node, value);
    case CAMBER_OP_TO_STRING:
    case CAMBER_OP_TO_BOOL:
    case CAMBER_OP_NOT:
    case CAMBER_OP_QUIET: return evaluate_unary(e, node, value);
    case CAMBER_OP_EQUAL:
    case CAMBER_OP_NOT_EQUAL: return evaluate_equality(e, node, value);
    case CAMBER_OP_LESS:
    case CAMBER_OP_LESS_EQUAL:
    case CAMBER_OP_GREATER:
    case CAMBER_OP_GREATER_EQUAL: return evaluate_order(e, node, value);
    case CAMBER_OP_IN: return evaluate_in(e, node, value);
    case CAMBER_OP_ALL:
    case CAMBER_OP_ANY: return evaluate_junction(e, node, value);
    case CAMBER_OP_CASE: return evaluate_case(e, node, value);
    case CAMBER_OP_MATCH: return evaluate_match(e, node, value);
    case CAMBER_OP_COALESCE: return evaluate_coalesce(e, node, value);
    case CAMBER_OP_STEP: return evaluate_step(e, node, value);
    case CAMBER_OP_INTERPOLATE: return evaluate_interpolate(e, node, value);
    case CAMBER_OP_ADD:
    case CAMBER_OP_SUBTRACT:
    case CAMBER_OP_MULTIPLY:
    case CAMBER_OP_DIVIDE: return evaluate_arithmetic(e, node, value);
    }
    return fail(e, "an operator is not known");
}

void camber_evaluation_begin(camber_evaluation *evaluation, double zoom, const camber_feature_view *feature) {
    evaluation->zoom = zoom;
    evaluation->line_progress = 0.0;
    evaluation->feature = feature;
    evaluation->cause = NULL;
}

void camber_evaluation_end(camber_evaluation *evaluation) {
    (void)evaluation;
}

bool camber_expression_evaluate_node(const camber_expression *expression, uint32_t node, camber_evaluation *evaluation,
                                     camber_value *value) {
    evaluation->expression = expression;
    return evaluate(evaluation, &expression->nodes[node], value);
}

bool camber_expression_evaluate(const camber_expression *expression, camber_evaluation *evaluation,
                                camber_value *value) {
    return camber_expression_evaluate_node(expression, expression->root, evaluation, value);
}

void camber_expression_destroy(camber_context *context, camber_expression *expression) {
    if (!expression)
        return;
    for (size_t i = 0; i < expression->text_count; i++)
        camber_free(context, expression->texts[i]);
    camber_free(context, expression->texts);
    camber_free(context, expression->labels);
    camber_free(context, expression->stops);
    camber_free(context, expression->links);
    camber_free(context, expression->nodes);
    json_decref(expression->document);
    camber_free(context, expression);
}
