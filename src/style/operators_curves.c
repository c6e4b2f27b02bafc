/* step and the interpolations. */
#include "style/operators.h"

#include <math.h>

static const camber_typing number = {.type = CAMBER_TYPE_NUMBER};

/* The stop at index of array, above the one before; stop is the one before and becomes this one. */
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

/* Both curves: input at index input, then pairs of stop and output from index pairs on. Stops are contiguous though
 * outputs may hold curves of their own: they are pushed first, the controls of a curve behind them. */
static bool compile_curve(camber_compiler *c, const json_t *array, size_t input, camber_node *prototype,
                          const double controls[4], uint32_t *node) {
    const bool step = prototype->op == CAMBER_OP_STEP;
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
    if (!camber_compile_operand(c, array, input, number))
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

bool camber_compile_step(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                         uint32_t *node) {
    camber_node prototype = {.op = row->op, .type = expected};
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

/* ["linear"], ["exponential", base] or ["cubic-bezier", x1, y1, x2, y2]. */
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

static bool is_interpolated(camber_typing type) {
    return type.type == CAMBER_TYPE_NUMBER || type.type == CAMBER_TYPE_COLOR ||
           (type.depth == 1 && type.item == CAMBER_TYPE_NUMBER && type.lengths[0] != CAMBER_ANY_LENGTH);
}

/* The three interpolations; their names end with the colour space. */
bool camber_compile_interpolate(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                                uint32_t *node) {
    const bool plain = row->result == CAMBER_TYPE_VALUE;
    double controls[4] = {0.0};
    camber_node prototype = {.op = row->op, .type = plain ? expected : camber_typing_of(CAMBER_TYPE_COLOR)};
    if (!plain)
        prototype.space = strstr(row->name, "hcl") ? CAMBER_SPACE_HCL : CAMBER_SPACE_LAB;
    camber_compiler_enter_index(c, 1);
    if (!read_interpolation(c, json_array_get(array, 1), &prototype, controls))
        return false;
    camber_compiler_leave(c);
    if (!compile_curve(c, array, 2, &prototype, controls, node))
        return false;
    if (is_interpolated(prototype.type))
        return true;
    char name[CAMBER_TYPING_TEXT_SIZE];
    return camber_compiler_fail(
        c,
        "outputs are interpolated where they are numbers, colours or arrays of so many numbers, "
        "found %s; use \"step\", or \"to-number\" or \"to-color\" on them",
        camber_typing_name(prototype.type, name));
}
