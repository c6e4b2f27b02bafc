/* The operators of expressions: a row each, with the function that compiles it. */
#include "style/compiler.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct camber_operator camber_operator;

/* array is the expression, its operator first; its length has been checked. */
typedef bool compile_fn(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                        uint32_t *node);

struct camber_operator {
    const char *name;
    compile_fn *compile;
    camber_op op;
    camber_type operands; /* of all of them, where compile_uniform compiles */
    camber_type result;
    size_t least, most; /* operands */
};

#define ANY_COUNT SIZE_MAX

/* Operands of one type, a result of another. */
static bool compile_uniform(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                            uint32_t *node) {
    (void)expected;
    const size_t first_operand = c->operand_count;
    for (size_t i = 1; i < json_array_size(array); i++)
        if (!camber_compile_element(c, array, i, operator->operands, node) || !camber_push_operand(c, *node))
            return false;
    return camber_make_node(c, &(camber_node){.op = operator->op, .type = operator->result}, first_operand, node);
}

static bool compile_none(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                         uint32_t *node) {
    const size_t first_operand = c->operand_count;
    return compile_uniform(c, operator, array, expected, node) && camber_push_operand(c, *node) &&
           camber_make_node(c, &(camber_node){.op = CAMBER_OP_NOT, .type = CAMBER_TYPE_BOOL}, first_operand, node);
}

static bool compile_to_string(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                              uint32_t *node) {
    (void)operator;
    (void)expected;
    if (!camber_compile_element(c, array, 1, CAMBER_TYPE_VALUE, node))
        return false;
    if (camber_node_at(c, *node)->type == CAMBER_TYPE_ARRAY)
        return camber_compiler_fail(c, "an array cannot be converted to a string; use a scalar");
    return camber_make_to_string(c, node);
}

static bool compile_zoom(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                         uint32_t *node) {
    (void)array;
    (void)expected;
    const camber_node prototype = {.op = operator->op, .type = operator->result, .reads_zoom = true};
    return camber_make_node(c, &prototype, c->operand_count, node);
}

static bool compile_geometry_type(camber_compiler *c, const camber_operator *operator, json_t * array,
                                  camber_type expected, uint32_t *node) {
    (void)array;
    (void)expected;
    const camber_node prototype = {.op = operator->op, .type = operator->result, .reads_feature = true};
    return camber_make_node(c, &prototype, c->operand_count, node);
}

/* get, has and !has: which properties are kept is known before features are read, so names are constants. */
static bool compile_get(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                        uint32_t *node) {
    (void)expected;
    if (json_array_size(array) == 3)
        return camber_compiler_fail(
            c, "\"%s\" of an object is not supported; read a property of the feature", operator->name);
    uint32_t name;
    if (!camber_compile_element(c, array, 1, CAMBER_TYPE_STRING, &name))
        return false;
    const camber_node *constant = camber_node_at(c, name);
    if (constant->op != CAMBER_OP_CONSTANT)
        return camber_compiler_fail(c, "the name of a property must be a constant; write it out as a string");
    if (!camber_make_property(c, operator->op, constant->value.string, node))
        return false;
    if (operator->name[0] != '!')
        return true;
    const size_t first_operand = c->operand_count;
    return camber_push_operand(c, *node) &&
           camber_make_node(c, &(camber_node){.op = CAMBER_OP_NOT, .type = CAMBER_TYPE_BOOL}, first_operand, node);
}

static bool compile_literal(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                            uint32_t *node) {
    (void)expected;
    json_t *value = json_array_get(array, 1);
    if (!json_is_array(value))
        return camber_make_json_constant(c, value, node);
    const size_t first_operand = c->operand_count;
    camber_compiler_enter_index(c, 1);
    for (size_t i = 0; i < json_array_size(value); i++) {
        camber_compiler_enter_index(c, i);
        if (!camber_make_json_constant(c, json_array_get(value, i), node) || !camber_push_operand(c, *node))
            return false;
        camber_compiler_leave(c);
    }
    camber_compiler_leave(c);
    return camber_make_node(c, &(camber_node){.op = operator->op, .type = operator->result}, first_operand, node);
}

/* ---- Comparisons ---- */

static bool is_comparable(camber_type type, bool order) {
    switch (type) {
    case CAMBER_TYPE_VALUE:
    case CAMBER_TYPE_NUMBER:
    case CAMBER_TYPE_STRING: return true;
    case CAMBER_TYPE_BOOL:
    case CAMBER_TYPE_NULL: return !order;
    case CAMBER_TYPE_COLOR:
    case CAMBER_TYPE_ARRAY:
    case CAMBER_TYPE_OBJECT:
    case CAMBER_TYPE_IMAGE: break;
    }
    return false;
}

static bool compile_comparison(camber_compiler *c, const camber_operator *operator, json_t * array,
                               camber_type expected, uint32_t *node) {
    (void)expected;
    const bool order = operator->op != CAMBER_OP_EQUAL && operator->op != CAMBER_OP_NOT_EQUAL;
    const size_t first_operand = c->operand_count;
    uint32_t sides[2];
    camber_type types[2];
    for (size_t i = 0; i < 2; i++) {
        if (!camber_compile_element(c, array, i + 1, CAMBER_TYPE_VALUE, &sides[i]))
            return false;
        types[i] = camber_node_at(c, sides[i])->type;
        if (!is_comparable(types[i], order))
            return camber_compiler_fail(c, "\"%s\" does not compare %s; convert it first", operator->name,
                                        camber_type_name(types[i]));
    }
    if (types[0] != types[1] && types[0] != CAMBER_TYPE_VALUE && types[1] != CAMBER_TYPE_VALUE)
        return camber_compiler_fail(c, "\"%s\" compares %s with %s; convert one of them", operator->name,
                                    camber_type_name(types[0]), camber_type_name(types[1]));
    for (size_t i = 0; i < 2; i++)
        if ((order && !camber_annotate(c, types[1 - i], CAMBER_ANNOTATE_ASSERT, &sides[i])) ||
            !camber_push_operand(c, sides[i]))
            return false;
    return camber_make_node(c, &(camber_node){.op = operator->op, .type = CAMBER_TYPE_BOOL}, first_operand, node);
}

/* in and !in. */
static bool compile_in(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                       uint32_t *node) {
    (void)expected;
    const size_t first_operand = c->operand_count;
    for (size_t i = 1; i < 3; i++) {
        if (!camber_compile_element(c, array, i, CAMBER_TYPE_VALUE, node) || !camber_push_operand(c, *node))
            return false;
        const camber_type type = camber_node_at(c, *node)->type;
        const bool fits = i == 1 ? type != CAMBER_TYPE_COLOR && type != CAMBER_TYPE_ARRAY
                                 : type == CAMBER_TYPE_STRING || type == CAMBER_TYPE_ARRAY || type == CAMBER_TYPE_VALUE;
        if (!fits)
            return camber_compiler_fail(c,
                                        "\"%s\" looks for a scalar in a string or an array, found %s; write e.g. "
                                        "[\"in\", [\"get\", \"kind\"], [\"literal\", [\"a\", \"b\"]]]",
                                        operator->name, camber_type_name(type));
    }
    if (!camber_make_node(c, &(camber_node){.op = operator->op, .type = CAMBER_TYPE_BOOL}, first_operand, node))
        return false;
    return operator->name[0] !=
        '!' ||(camber_push_operand(c, *node) &&
               camber_make_node(c, &(camber_node){.op = CAMBER_OP_NOT, .type = CAMBER_TYPE_BOOL}, first_operand, node));
}

/* ---- Decisions and curves ---- */

/* The type of a decision's outputs: what is expected around it, else the first output's. */
typedef struct output_type {
    camber_type type;
    bool known;
} output_type;

static output_type expect_outputs(camber_type expected) {
    return (output_type){expected, expected != CAMBER_TYPE_VALUE};
}

static bool see_output(camber_compiler *c, uint32_t node, output_type *type) {
    const camber_type found = camber_node_at(c, node)->type;
    if (found == CAMBER_TYPE_ARRAY)
        return camber_compiler_fail(c, "an array cannot be an output; use scalars or colours");
    if (!type->known)
        *type = (output_type){found, true};
    return true;
}

static bool compile_output(camber_compiler *c, const json_t *array, size_t index, output_type *type) {
    uint32_t node;
    return camber_compile_element(c, array, index, type->type, &node) && camber_push_operand(c, node) &&
           see_output(c, node, type);
}

static bool compile_case(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                         uint32_t *node) {
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    if (size % 2 != 0)
        return camber_compiler_fail(c, "\"case\" has pairs of condition and output, then one output; add the last one");
    output_type type = expect_outputs(expected);
    for (size_t i = 1; i + 1 < size; i += 2)
        if (!camber_compile_element(c, array, i, CAMBER_TYPE_BOOL, node) || !camber_push_operand(c, *node) ||
            !compile_output(c, array, i + 1, &type))
            return false;
    return compile_output(c, array, size - 1, &type) &&
           camber_make_node(c, &(camber_node){.op = operator->op, .type = type.type}, first_operand, node);
}

static bool compile_coalesce(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                             uint32_t *node) {
    const size_t first_operand = c->operand_count;
    output_type type = expect_outputs(expected);
    bool mixed = false;
    for (size_t i = 1; i < json_array_size(array); i++) {
        if (!camber_compile_loose_element(c, array, i, type.type, node) || !camber_push_operand(c, *node) ||
            !see_output(c, *node, &type))
            return false;
        mixed = mixed || camber_node_at(c, *node)->type != type.type;
    }
    return camber_make_node(c, &(camber_node){.op = operator->op, .type = mixed ? CAMBER_TYPE_VALUE : type.type},
                            first_operand, node);
}

static int compare_labels(const void *left, const void *right) {
    const camber_label *a = left, *b = right;
    if (a->string)
        return strcmp(a->string, b->string);
    return a->number < b->number ? -1 : a->number > b->number;
}

/* 2^53 - 1, the largest integer to which all below it are doubles. */
#define LARGEST_LABEL 9007199254740991.0

static bool compile_label(camber_compiler *c, const json_t *json, uint32_t output, camber_type *type) {
    const camber_type found = json_is_string(json)   ? CAMBER_TYPE_STRING
                              : json_is_number(json) ? CAMBER_TYPE_NUMBER
                                                     : CAMBER_TYPE_VALUE;
    if (found == CAMBER_TYPE_VALUE)
        return camber_compiler_fail(c, "a label must be a string or a number, found %s; use \"case\" for other tests",
                                    camber_json_name(json));
    if (*type != CAMBER_TYPE_VALUE && *type != found)
        return camber_compiler_fail(c, "expected %s like the labels before, found %s; use labels of one type",
                                    camber_type_name(*type), camber_type_name(found));
    *type = found;
    camber_label label = {.string = json_string_value(json), .output = output};
    if (!label.string) {
        label.number = json_number_value(json);
        if (label.number < floor(label.number) || label.number > floor(label.number) ||
            fabs(label.number) > LARGEST_LABEL)
            return camber_compiler_fail(c, "a label that is a number must be an integer below 2^53; use \"case\"");
    }
    return camber_push_label(c, &label);
}

/* One label or an array of them. */
static bool compile_branch(camber_compiler *c, const json_t *json, uint32_t output, camber_type *type) {
    if (!json_is_array(json))
        return compile_label(c, json, output, type);
    if (json_array_size(json) == 0)
        return camber_compiler_fail(c, "a branch has no label; name one or take the branch out");
    for (size_t i = 0; i < json_array_size(json); i++) {
        camber_compiler_enter_index(c, i);
        if (!compile_label(c, json_array_get(json, i), output, type))
            return false;
        camber_compiler_leave(c);
    }
    return true;
}

static bool sort_labels(camber_compiler *c, uint32_t first, size_t count) {
    camber_label *labels = &c->expression->labels[first];
    qsort(labels, count, sizeof *labels, compare_labels);
    for (size_t i = 1; i < count; i++)
        if (compare_labels(&labels[i - 1], &labels[i]) == 0)
            return labels[i].string
                       ? camber_compiler_fail(c, "the label \"%.64s\" occurs twice; take one out", labels[i].string)
                       : camber_compiler_fail(c, "the label %.17g occurs twice; take one out", labels[i].number);
    return true;
}

/* Labels are contiguous though outputs may hold matches of their own: they are compiled first. */
static bool compile_match(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                          uint32_t *node) {
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    if (size % 2 == 0)
        return camber_compiler_fail(c, "\"match\" has pairs of label and output, then one output; add the last one");
    camber_node prototype = {.op = operator->op, .index = (uint32_t)c->expression->label_count};
    camber_type input = CAMBER_TYPE_VALUE;
    output_type type = expect_outputs(expected);
    for (size_t i = 2; i + 1 < size; i += 2) {
        camber_compiler_enter_index(c, i);
        if (!compile_branch(c, json_array_get(array, i), (uint32_t)(i / 2), &input))
            return false;
        camber_compiler_leave(c);
    }
    const size_t count = c->expression->label_count - prototype.index;
    prototype.index_count = (uint32_t)count;
    if (!sort_labels(c, prototype.index, count) || !camber_compile_element(c, array, 1, CAMBER_TYPE_VALUE, node))
        return false;
    const camber_type found = camber_node_at(c, *node)->type;
    if (found != CAMBER_TYPE_VALUE && found != input)
        return camber_compiler_fail(c, "the labels are of another type than the input, which is %s; convert it",
                                    camber_type_name(found));
    if (!camber_push_operand(c, *node))
        return false;
    for (size_t i = 3; i < size; i += 2)
        if (!compile_output(c, array, i, &type))
            return false;
    if (!compile_output(c, array, size - 1, &type))
        return false;
    prototype.type = type.type;
    return camber_make_node(c, &prototype, first_operand, node);
}

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
 * outputs may hold curves of their own: they are pushed first. */
static bool compile_curve(camber_compiler *c, const json_t *array, size_t input, camber_node *prototype,
                          uint32_t *node) {
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
    if (!camber_compile_element(c, array, input, CAMBER_TYPE_NUMBER, node) || !camber_push_operand(c, *node))
        return false;
    output_type type = expect_outputs(prototype->type);
    if (step && !compile_output(c, array, input + 1, &type))
        return false;
    for (size_t i = pairs; i < size; i += 2)
        if (!compile_output(c, array, i + 1, &type))
            return false;
    prototype->type = type.type;
    return camber_make_node(c, prototype, first_operand, node);
}

static bool compile_step(camber_compiler *c, const camber_operator *operator, json_t * array, camber_type expected,
                         uint32_t *node) {
    camber_node prototype = {.op = operator->op, .type = expected};
    return compile_curve(c, array, 1, &prototype, node);
}

/* ["linear"] or ["exponential", base]. */
static bool read_interpolation(camber_compiler *c, const json_t *json, double *base) {
    const char *name = json_string_value(json_array_get(json, 0));
    *base = 1.0;
    if (name && strcmp(name, "linear") == 0)
        return true;
    if (!name || strcmp(name, "exponential") != 0)
        return camber_compiler_fail(c, "the interpolation is not known; use [\"linear\"] or [\"exponential\", 1.5]");
    const json_t *number = json_array_get(json, 1);
    if (!json_is_number(number) || !(json_number_value(number) > 0.0))
        return camber_compiler_fail(c, "expected a base, a number above 0; write e.g. [\"exponential\", 1.5]");
    *base = json_number_value(number);
    return true;
}

static bool compile_interpolate(camber_compiler *c, const camber_operator *operator, json_t * array,
                                camber_type expected, uint32_t *node) {
    camber_node prototype = {.op = operator->op, .type = expected, .value = {.type = CAMBER_VALUE_NUMBER}};
    camber_compiler_enter_index(c, 1);
    if (!read_interpolation(c, json_array_get(array, 1), &prototype.value.number))
        return false;
    camber_compiler_leave(c);
    if (!compile_curve(c, array, 2, &prototype, node))
        return false;
    if (prototype.type != CAMBER_TYPE_NUMBER && prototype.type != CAMBER_TYPE_COLOR)
        return camber_compiler_fail(c,
                                    "outputs are interpolated where they are numbers or colours, found %s; use "
                                    "\"step\", or \"to-number\" or \"to-color\" on them",
                                    camber_type_name(prototype.type));
    return true;
}

#define VALUE CAMBER_TYPE_VALUE
#define BOOL CAMBER_TYPE_BOOL
#define NUMBER CAMBER_TYPE_NUMBER
#define STRING CAMBER_TYPE_STRING
#define COLOR CAMBER_TYPE_COLOR

static const camber_operator operators[] = {
    {"literal", compile_literal, CAMBER_OP_ARRAY, VALUE, CAMBER_TYPE_ARRAY, 1, 1},
    {"get", compile_get, CAMBER_OP_GET, STRING, VALUE, 1, 2},
    {"has", compile_get, CAMBER_OP_HAS, STRING, BOOL, 1, 2},
    {"!has", compile_get, CAMBER_OP_HAS, STRING, BOOL, 1, 2},
    {"zoom", compile_zoom, CAMBER_OP_ZOOM, VALUE, NUMBER, 0, 0},
    {"geometry-type", compile_geometry_type, CAMBER_OP_GEOMETRY_TYPE, VALUE, STRING, 0, 0},
    {"number", compile_uniform, CAMBER_OP_ASSERT, VALUE, NUMBER, 1, ANY_COUNT},
    {"string", compile_uniform, CAMBER_OP_ASSERT, VALUE, STRING, 1, ANY_COUNT},
    {"boolean", compile_uniform, CAMBER_OP_ASSERT, VALUE, BOOL, 1, ANY_COUNT},
    {"to-number", compile_uniform, CAMBER_OP_TO_NUMBER, VALUE, NUMBER, 1, ANY_COUNT},
    {"to-string", compile_to_string, CAMBER_OP_TO_STRING, VALUE, STRING, 1, 1},
    {"to-boolean", compile_uniform, CAMBER_OP_TO_BOOL, VALUE, BOOL, 1, 1},
    {"to-color", compile_uniform, CAMBER_OP_TO_COLOR, VALUE, COLOR, 1, ANY_COUNT},
    {"==", compile_comparison, CAMBER_OP_EQUAL, VALUE, BOOL, 2, 2},
    {"!=", compile_comparison, CAMBER_OP_NOT_EQUAL, VALUE, BOOL, 2, 2},
    {"<", compile_comparison, CAMBER_OP_LESS, VALUE, BOOL, 2, 2},
    {"<=", compile_comparison, CAMBER_OP_LESS_EQUAL, VALUE, BOOL, 2, 2},
    {">", compile_comparison, CAMBER_OP_GREATER, VALUE, BOOL, 2, 2},
    {">=", compile_comparison, CAMBER_OP_GREATER_EQUAL, VALUE, BOOL, 2, 2},
    {"in", compile_in, CAMBER_OP_IN, VALUE, BOOL, 2, 2},
    {"!in", compile_in, CAMBER_OP_IN, VALUE, BOOL, 2, 2},
    {"!", compile_uniform, CAMBER_OP_NOT, BOOL, BOOL, 1, 1},
    {"all", compile_uniform, CAMBER_OP_ALL, BOOL, BOOL, 0, ANY_COUNT},
    {"any", compile_uniform, CAMBER_OP_ANY, BOOL, BOOL, 0, ANY_COUNT},
    {"none", compile_none, CAMBER_OP_ANY, BOOL, BOOL, 0, ANY_COUNT},
    {"case", compile_case, CAMBER_OP_CASE, VALUE, VALUE, 3, ANY_COUNT},
    {"match", compile_match, CAMBER_OP_MATCH, VALUE, VALUE, 4, ANY_COUNT},
    {"coalesce", compile_coalesce, CAMBER_OP_COALESCE, VALUE, VALUE, 1, ANY_COUNT},
    {"step", compile_step, CAMBER_OP_STEP, VALUE, VALUE, 2, ANY_COUNT},
    {"interpolate", compile_interpolate, CAMBER_OP_INTERPOLATE, VALUE, VALUE, 4, ANY_COUNT},
    {"+", compile_uniform, CAMBER_OP_ADD, NUMBER, NUMBER, 0, ANY_COUNT},
    {"-", compile_uniform, CAMBER_OP_SUBTRACT, NUMBER, NUMBER, 1, 2},
    {"*", compile_uniform, CAMBER_OP_MULTIPLY, NUMBER, NUMBER, 0, ANY_COUNT},
    {"/", compile_uniform, CAMBER_OP_DIVIDE, NUMBER, NUMBER, 2, 2},
};

bool camber_compile_operator(camber_compiler *c, json_t *array, camber_type expected, uint32_t *node) {
    const char *name = json_string_value(json_array_get(array, 0));
    if (!name)
        return camber_compiler_fail(
            c, "expected an expression [operator, ...], found an array without an operator's name; "
               "write [\"literal\", [...]] for a list");
    for (size_t i = 0; i < sizeof operators / sizeof *operators; i++) {
        const camber_operator *operator= & operators[i];
        if (strcmp(operator->name, name) != 0)
            continue;
        const size_t count = json_array_size(array) - 1;
        if (count < operator->least || count> operator->most)
            return camber_compiler_fail(c, "\"%s\" with %zu operand%s; it takes %zu%s", name, count,
                                        count == 1 ? "" : "s", operator->least,
                                                               operator->most == ANY_COUNT     ? " or more" :
                                                               operator->most> operator->least ? " or one more"
                                                                                               : "");
        return operator->compile(c, operator, array, expected, node);
    }
    camber_compiler_enter_index(c, 0);
    return camber_compiler_fail(c, "unknown operator \"%.64s\"; correct it, or write [\"literal\", [...]] for a list",
                                name);
}
