/* Curves: step and the interpolations.
 *
 * The stops of a curve are sorted numbers, next to each other in the expression; its outputs are operands. The input is
 * looked up among the stops by bisection. The table at the end has each operator's row. */
#include "style/evaluation.h"
#include "style/operators.h"
#include "style/spaces.h"

#include <math.h>
#include <string.h>

static const camber_typing number_type = {.type = CAMBER_TYPE_NUMBER};

/* ---- When compiled ---- */

/* Reads the stop at an index of array, which must be above the previous one. *stop is the previous one, and becomes
 * this one. */
static bool read_stop(camber_compiler *c, const json_t *array, size_t index, double *stop) {
    const json_t *json = json_array_get(array, index);
    camber_compiler_enter_index(c, index);
    if (!json_is_number(json))
        return camber_compiler_fail(c, "a stop must be a number, found %s; write it out", camber_json_name(json));
    if (!(json_number_value(json) > *stop))
        return camber_compiler_fail(c, "the stop %g is not above the one before; sort the stops",
                                    json_number_value(json));
    *stop = json_number_value(json);
    camber_compiler_leave(c);
    return true;
}

/* Compiles both kinds of curves. input and pairs are the indices of the input and of the first pair of stop and output.
 * Stops are contiguous although outputs may contain curves of their own, because all stops are pushed first, followed
 * by the control values of a Bezier curve. */
static bool compile_curve(camber_compiler *c, const json_t *array, size_t input, camber_node *prototype,
                          const double controls[4], uint32_t *node) {
    const bool step = prototype->evaluate == camber_evaluate_step;
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    const size_t pairs = step ? input + 2 : input + 1;
    if (size < pairs || (size - pairs) % 2 != 0)
        return camber_compiler_fail(c, "a stop or an output is missing; write pairs of them");
    prototype->index = (uint32_t)c->expression->stop_count;
    double stop = -HUGE_VAL;
    for (size_t i = pairs; i < size; i += 2)
        if (!read_stop(c, array, i, &stop) || !camber_push_stop(c, stop))
            return false;
    prototype->index_count = (uint32_t)c->expression->stop_count - prototype->index;
    for (size_t i = 0; prototype->bezier && i < 4; i++)
        if (!camber_push_stop(c, controls[i]))
            return false;
    if (!camber_compile_operand(c, array, input, number_type))
        return false;
    camber_output_type type = camber_expect_outputs(prototype->type);
    if (step && !camber_compile_output(c, array, input + 1, &type))
        return false;
    for (size_t i = pairs; i < size; i += 2)
        if (!camber_compile_output(c, array, i + 1, &type))
            return false;
    prototype->type = type.type;
    return camber_make_node(c, prototype, first_operand, node);
}

static bool compile_step(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                         uint32_t *node) {
    camber_node prototype = {.evaluate = row->evaluate, .type = expected};
    return compile_curve(c, array, 1, &prototype, NULL, node);
}

static bool read_controls(camber_compiler *c, const json_t *json, double controls[4]) {
    bool fits = json_array_size(json) == 5;
    for (size_t i = 0; fits && i < 4; i++) {
        const json_t *one = json_array_get(json, i + 1);
        controls[i] = json_number_value(one);
        fits = json_is_number(one) && controls[i] >= 0.0 && controls[i] <= 1.0;
    }
    return fits || camber_compiler_fail(c, "expected four numbers from 0 to 1; write e.g. [\"cubic-bezier\", 0.4, 0, "
                                           "0.2, 1]");
}

/* Reads ["linear"], ["exponential", base] or ["cubic-bezier", x1, y1, x2, y2]. */
static bool read_interpolation(camber_compiler *c, const json_t *json, camber_node *prototype, double controls[4]) {
    const char *name = json_string_value(json_array_get(json, 0));
    prototype->value = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = 1.0};
    if (name && strcmp(name, "linear") == 0)
        return true;
    if (name && strcmp(name, "cubic-bezier") == 0) {
        prototype->bezier = true;
        return read_controls(c, json, controls);
    }
    if (!name || strcmp(name, "exponential") != 0)
        return camber_compiler_fail(c, "the interpolation is not known; use [\"linear\"], [\"exponential\", 1.5] or "
                                       "[\"cubic-bezier\", 0.4, 0, 0.2, 1]");
    const json_t *base = json_array_get(json, 1);
    if (!json_is_number(base)) {
        camber_compiler_enter_index(c, 1);
        return camber_compiler_fail(c, "expected a base, a number; write e.g. [\"exponential\", 1.5]");
    }
    prototype->value.number = json_number_value(base);
    return true;
}

bool camber_is_interpolated(camber_typing type) {
    return type.type == CAMBER_TYPE_NUMBER || type.type == CAMBER_TYPE_COLOR || type.type == CAMBER_TYPE_PADDING ||
           type.type == CAMBER_TYPE_ANCHORS ||
           (type.depth == 1 && type.item == CAMBER_TYPE_NUMBER && type.lengths[0] != CAMBER_ANY_LENGTH);
}

/* Compiles the three interpolations. Their rows have the colour space. */
static bool compile_interpolate(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                                uint32_t *node) {
    double controls[4] = {0.0};
    camber_node prototype = {.evaluate = row->evaluate,
                             .type = row->result == CAMBER_TYPE_VALUE ? expected : camber_typing_of(row->result),
                             .space = (uint8_t)row->variant};
    camber_compiler_enter_index(c, 1);
    if (!read_interpolation(c, json_array_get(array, 1), &prototype, controls))
        return false;
    camber_compiler_leave(c);
    if (!compile_curve(c, array, 2, &prototype, controls, node))
        return false;
    if (camber_is_interpolated(prototype.type))
        return true;
    char name[CAMBER_TYPING_TEXT_SIZE];
    return camber_compiler_fail(c,
                                "only numbers, colours and arrays of equally many numbers are interpolated, found %s; "
                                "use \"step\", or \"to-number\" or \"to-color\" on them",
                                camber_typing_name(prototype.type, name));
}

/* ---- When evaluated ---- */

static bool fail(camber_evaluation *e, const char *cause) {
    return camber_evaluate_fail(e, cause);
}

/* Counts the node's stops that are at or below input. */
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
    if (!camber_evaluate_number(e, node, 0, input))
        return false;
    return !isnan(*input) || fail(e, "expected a number, and the value is not one");
}

bool camber_evaluate_step(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double input = 0.0;
    if (!evaluate_input(e, node, &input))
        return false;
    return camber_evaluate_operand(e, node, 1 + count_stops(e->expression, node, input), value);
}

static bool same(double a, double b) {
    return a >= b && a <= b;
}

/* Returns how far input is from low to high, as the specification defines it for exponential interpolation. */
static double exponential(double input, double base, double low, double high) {
    double span = high - low, progress = input - low;
    if (!isfinite(span)) { /* the stops are so far apart that only half of the span is finite */
        span = high * 0.5 - low * 0.5;
        progress = input * 0.5 - low * 0.5;
    }
    if (same(base, 1.0))
        return progress / span;
    const double factor = (pow(base, progress) - 1.0) / (pow(base, span) - 1.0);
    return isfinite(factor) ? factor : progress / span;
}

/* Returns one coordinate of the curve from 0 to 1 with control values a and b, at the parameter s. */
static double bezier(double a, double b, double s) {
    const double r = 1.0 - s;
    return 3.0 * r * r * s * a + 3.0 * r * s * s * b + s * s * s;
}

/* Returns y at x on the curve from (0, 0) to (1, 1). x increases along it, so bisection finds it. */
static double bezier_at(const double controls[4], double x) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 48; i++) {
        const double middle = 0.5 * (low + high);
        if (bezier(controls[0], controls[2], middle) < x)
            low = middle;
        else
            high = middle;
    }
    return bezier(controls[1], controls[3], high);
}

static bool mix_arrays(camber_evaluation *e, const camber_value *low, const camber_value *high, double t,
                       camber_value *value);

/* Mixes two items of arrays: numbers are mixed, arrays, such as an anchor's offset, are mixed item by item, and
 * anything else, such as an anchor's name, must be equal. */
static bool mix_items(camber_evaluation *e, const camber_value *low, const camber_value *high, double t,
                      camber_value *value) {
    *value = *low;
    if (low->type == CAMBER_VALUE_NUMBER && high->type == CAMBER_VALUE_NUMBER)
        *value = camber_value_number(low->number + t * (high->number - low->number));
    else if (low->type == CAMBER_VALUE_ARRAY && high->type == CAMBER_VALUE_ARRAY)
        return mix_arrays(e, low, high, t, value);
    else
        return camber_values_equal(low, high) || fail(e, "expected arrays of numbers, or of the same anchors");
    return true;
}

static bool mix_arrays(camber_evaluation *e, const camber_value *low, const camber_value *high, double t,
                       camber_value *value) {
    const uint32_t count = low->count;
    camber_value *items = camber_arena_alloc(e->arena, count * sizeof *items);
    if (!items)
        return camber_evaluate_no_memory(e);
    if (high->count != count)
        return fail(e, "expected two arrays of the same length");
    for (uint32_t i = 0; i < count; i++)
        if (!mix_items(e, &low->items[i], &high->items[i], t, &items[i]))
            return false;
    *value = (camber_value){.type = CAMBER_VALUE_ARRAY, .count = count, .items = items};
    return camber_evaluate_work(e, count);
}

static bool mix_values(camber_evaluation *e, const camber_node *node, const camber_value *low, const camber_value *high,
                       double t, camber_value *value) {
    if (low->type == CAMBER_VALUE_NUMBER && high->type == CAMBER_VALUE_NUMBER) {
        *value = camber_value_number(low->number * (1.0 - t) + high->number * t);
        return true;
    }
    if (low->type == CAMBER_VALUE_ARRAY && high->type == CAMBER_VALUE_ARRAY)
        return mix_arrays(e, low, high, t, value);
    if (low->type != CAMBER_VALUE_COLOR || high->type != CAMBER_VALUE_COLOR)
        return fail(e, "expected two numbers, two colours or two arrays of numbers");
    *value = (camber_value){.type = CAMBER_VALUE_COLOR,
                            .color = camber_color_mix(low->color, high->color, t, (camber_color_space)node->space)};
    return true;
}

bool camber_evaluate_interpolate(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double input = 0.0;
    if (node->index_count > 1 && !evaluate_input(e, node, &input))
        return false;
    const double *stops = &e->expression->stops[node->index];
    const uint32_t passed = node->index_count > 1 ? count_stops(e->expression, node, input) : 0;
    if (passed == 0)
        return camber_evaluate_operand(e, node, 1, value);
    const uint32_t lower = passed - 1;
    if (passed == node->index_count || same(stops[lower], input))
        return camber_evaluate_operand(e, node, 1 + lower, value);
    camber_value low, high;
    if (!camber_evaluate_operand(e, node, 1 + lower, &low) || !camber_evaluate_operand(e, node, 2 + lower, &high))
        return false;
    double t = exponential(input, node->value.number, stops[lower], stops[lower + 1]);
    if (node->bezier)
        t = bezier_at(stops + node->index_count, t);
    return mix_values(e, node, &low, &high, t, value);
}

static const camber_operator rows[] = {
    {"step", compile_step, camber_evaluate_step, NUMBER, VALUE, 4, ANY_COUNT},
    {"interpolate", compile_interpolate, camber_evaluate_interpolate, NUMBER, VALUE, 4, ANY_COUNT},
    {"interpolate-hcl", compile_interpolate, camber_evaluate_interpolate, NUMBER, COLOR, 4, ANY_COUNT,
     .variant = CAMBER_SPACE_HCL},
    {"interpolate-lab", compile_interpolate, camber_evaluate_interpolate, NUMBER, COLOR, 4, ANY_COUNT,
     .variant = CAMBER_SPACE_LAB},
};

const camber_operator_table camber_curve_operators = {rows, sizeof rows / sizeof *rows};
