/* Types: assertions, conversions and colours.
 *
 * If the compiler cannot know a type, as with ["get", ...], a node asserts or converts it. Conversions follow
 * ECMAScript if the specification does. The table at the end has each operator's row. */
#include "style/color.h"
#include "style/evaluation.h"
#include "style/operators.h"
#include "style/text.h"

#include <math.h>
#include <string.h>

static const camber_typing any_type = {.type = CAMBER_TYPE_VALUE}, number_type = {.type = CAMBER_TYPE_NUMBER},
                           string_type = {.type = CAMBER_TYPE_STRING}, bool_type = {.type = CAMBER_TYPE_BOOL};

static bool fail(camber_evaluation *e, const char *cause) {
    return camber_evaluate_fail(e, cause);
}

/* ---- Assertions ---- */

/* The result is the first operand of the node's type. If there is none, evaluation fails. */
bool camber_evaluate_assert(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i < node->count; i++) {
        if (!camber_evaluate_operand(e, node, i, value))
            return false;
        if (value->type == CAMBER_VALUE_ARRAY && !camber_evaluate_work(e, value->count))
            return false;
        if (camber_typing_fits(node->type, camber_typing_of_value(value)))
            return true;
    }
    return fail(e, node->type.type == CAMBER_TYPE_NUMBER   ? "expected a number, and the value is not one"
                   : node->type.type == CAMBER_TYPE_STRING ? "expected a string, and the value is not one"
                   : node->type.type == CAMBER_TYPE_BOOL   ? "expected a boolean, and the value is not one"
                   : node->type.type == CAMBER_TYPE_ARRAY ? "expected an array of another type or length than the value"
                                                          : "expected an object, and the value is not one");
}

bool camber_evaluate_typeof(camber_evaluation *e, const camber_node *node, camber_value *value) {
    char name[CAMBER_TYPING_TEXT_SIZE];
    if (!camber_evaluate_operand(e, node, 0, value))
        return false;
    if (value->type == CAMBER_VALUE_ARRAY && !camber_evaluate_work(e, value->count))
        return false;
    camber_typing_write(camber_typing_of_value(value), name);
    const char *text = camber_arena_text(e->arena, name, strlen(name));
    if (!text)
        return camber_evaluate_no_memory(e);
    *value = camber_value_string(text);
    return true;
}

static bool read_item_type(camber_compiler *c, const json_t *array, camber_typing *item) {
    const char *name = json_string_value(json_array_get(array, 1));
    *item = name && strcmp(name, "number") == 0    ? number_type
            : name && strcmp(name, "string") == 0  ? string_type
            : name && strcmp(name, "boolean") == 0 ? bool_type
                                                   : any_type;
    if (item->type != CAMBER_TYPE_VALUE)
        return true;
    camber_compiler_enter_index(c, 1);
    return camber_compiler_fail(c,
                                "expected the items' type: \"number\", \"string\" or \"boolean\"; write one of them");
}

static bool read_length(camber_compiler *c, const json_t *array, uint32_t *length) {
    const json_t *json = json_array_get(array, 2);
    const double wanted = json_number_value(json);
    if (json_is_null(json))
        return true;
    if (json_is_number(json) && wanted >= 0.0 && wanted < UINT32_MAX && !(wanted > floor(wanted))) {
        *length = (uint32_t)wanted;
        return true;
    }
    camber_compiler_enter_index(c, 2);
    return camber_compiler_fail(c, "expected the array's length, a whole number of 0 or more; write it out");
}

/* Compiles ["array", value], ["array", type, value] or ["array", type, length, value, ...]. */
static bool compile_array(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                          uint32_t *node) {
    (void)expected;
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    camber_typing item = any_type;
    uint32_t length = CAMBER_ANY_LENGTH;
    if (size > 2 && !read_item_type(c, array, &item))
        return false;
    if (size > 3 && !read_length(c, array, &length))
        return false;
    for (size_t i = size > 3 ? 3 : size - 1; i < size; i++)
        if (!camber_compile_operand(c, array, i, any_type))
            return false;
    return camber_make_node(c, &(camber_node){.evaluate = row->evaluate, .type = camber_typing_array(item, length)},
                            first_operand, node);
}

/* ---- Strings and booleans ---- */

bool camber_evaluate_to_string(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!camber_evaluate_operand(e, node, 0, value))
        return false;
    if (value->type == CAMBER_VALUE_STRING) {
        value->boolean = false;
        return true;
    }
    camber_string text = {.e = e};
    return camber_string_add_value(&text, value) && camber_string_end(&text, value);
}

static bool to_bool(const camber_value *value) {
    switch (value->type) {
    case CAMBER_VALUE_NULL: return false;
    case CAMBER_VALUE_BOOL: return value->boolean;
    case CAMBER_VALUE_NUMBER: return value->number < 0.0 || value->number > 0.0;
    case CAMBER_VALUE_STRING: return value->string[0] != 0;
    case CAMBER_VALUE_COLOR:
    case CAMBER_VALUE_ARRAY:
    case CAMBER_VALUE_FORMATTED:
    case CAMBER_VALUE_OBJECT: break;
    }
    return true;
}

static bool evaluate_to_bool(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!camber_evaluate_operand(e, node, 0, value))
        return false;
    *value = camber_value_bool(to_bool(value));
    return true;
}

/* ---- Numbers ---- */

static const char *skip_space(const char *text) {
    return text + strspn(text, " \t\r\n\f\v");
}

/* Parses the digits after 0x, 0o or 0b. NULL: there are none. */
static const char *parse_digits(const char *text, unsigned base, double *number) {
    const char *c = text;
    for (*number = 0.0;; c++) {
        const unsigned digit = *c >= '0' && *c <= '9'   ? (unsigned)(*c - '0')
                               : *c >= 'a' && *c <= 'f' ? (unsigned)(*c - 'a' + 10)
                               : *c >= 'A' && *c <= 'F' ? (unsigned)(*c - 'A' + 10)
                                                        : base;
        if (digit >= base)
            return c > text ? c : NULL;
        *number = *number * base + digit;
    }
}

/* Converts a string like Number(string) in ECMAScript. */
static bool string_to_number(const char *text, double *number) {
    text = skip_space(text);
    if (*text == 0) {
        *number = 0.0;
        return true;
    }
    const char kind = text[0] == '0' ? (char)(text[1] | 32) : 0;
    const char *sign = text + (*text == '+' || *text == '-');
    if (kind == 'x' || kind == 'o' || kind == 'b') {
        text = parse_digits(text + 2, kind == 'x' ? 16 : kind == 'o' ? 8 : 2, number);
    } else if (strncmp(sign, "Infinity", 8) == 0) {
        *number = *text == '-' ? -HUGE_VAL : HUGE_VAL;
        text = sign + 8;
    } else {
        text = camber_number_parse(text, number);
    }
    return text && *skip_space(text) == 0;
}

static bool to_number(const camber_value *value, double *number) {
    *number = 0.0;
    /* ECMAScript converts an array to text first. For one item this is the item's text. */
    while (value->type == CAMBER_VALUE_ARRAY && value->count == 1)
        value = &value->items[0];
    switch (value->type) {
    case CAMBER_VALUE_NULL: return true;
    case CAMBER_VALUE_BOOL: *number = value->boolean ? 1.0 : 0.0; return true;
    case CAMBER_VALUE_NUMBER: *number = value->number; return !isnan(value->number);
    case CAMBER_VALUE_STRING: return string_to_number(value->string, number);
    case CAMBER_VALUE_ARRAY: return value->count == 0;
    case CAMBER_VALUE_COLOR:
    case CAMBER_VALUE_FORMATTED:
    case CAMBER_VALUE_OBJECT: break;
    }
    return false;
}

static bool evaluate_to_number(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double number;
    for (uint32_t i = 0; i < node->count; i++) {
        if (!camber_evaluate_operand(e, node, i, value))
            return false;
        if (to_number(value, &number)) {
            *value = camber_value_number(number);
            return true;
        }
    }
    return fail(e, "the value is not a number, and not the text of one");
}

/* ---- Colours ---- */

/* Whether r, g and b are 0 to 255, and alpha is 0 to 1. */
static bool is_rgba(const double parts[4]) {
    for (int i = 0; i < 4; i++)
        if (!(parts[i] >= 0.0 && parts[i] <= (i < 3 ? 255.0 : 1.0)))
            return false;
    return true;
}

static camber_value from_rgba(const double parts[4], double divisor) {
    return (camber_value){.type = CAMBER_VALUE_COLOR,
                          .color = {(float)(parts[0] / divisor), (float)(parts[1] / divisor),
                                    (float)(parts[2] / divisor), (float)parts[3]}};
}

/* Like the specification's own engine, takes the r, g and b of an array as already multiplied by alpha. */
static bool array_to_color(const camber_value *array, camber_value *color) {
    double parts[4] = {0.0, 0.0, 0.0, 1.0};
    if (array->count < 3 || array->count > 4)
        return false;
    for (uint32_t i = 0; i < array->count; i++) {
        if (array->items[i].type != CAMBER_VALUE_NUMBER)
            return false;
        parts[i] = array->items[i].number;
    }
    if (!is_rgba(parts))
        return false;
    *color = from_rgba(parts, parts[3] > 0.0 ? 255.0 * parts[3] : HUGE_VAL);
    return true;
}

bool camber_evaluate_to_color(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i < node->count; i++) {
        camber_color color;
        if (!camber_evaluate_operand(e, node, i, value))
            return false;
        if (value->type == CAMBER_VALUE_COLOR || (value->type == CAMBER_VALUE_ARRAY && array_to_color(value, value)))
            return true;
        if (value->type == CAMBER_VALUE_STRING && camber_color_parse(value->string, &color)) {
            *value = (camber_value){.type = CAMBER_VALUE_COLOR, .color = color};
            return true;
        }
    }
    return fail(e, "the value is not a CSS colour such as \"#a0c4ff\" or \"rgba(0, 0, 0, 0.5)\"");
}

static bool evaluate_rgba(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double parts[4] = {0.0, 0.0, 0.0, 1.0};
    for (uint32_t i = 0; i < node->count; i++)
        if (!camber_evaluate_number(e, node, i, &parts[i]))
            return false;
    if (!is_rgba(parts))
        return fail(e, "red, green and blue must be 0 to 255, and alpha 0 to 1");
    *value = from_rgba(parts, 255.0);
    return true;
}

/* Components are floats, so digits past their precision are noise and are rounded off. */
static bool evaluate_to_rgba(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!camber_evaluate_operand(e, node, 0, value))
        return false;
    if (value->type != CAMBER_VALUE_COLOR)
        return fail(e, "expected a colour, and the value is not one");
    camber_value *items = camber_arena_alloc(e->arena, 4 * sizeof *items);
    if (!items)
        return camber_evaluate_no_memory(e);
    const camber_color color = value->color;
    const float parts[4] = {color.r, color.g, color.b, color.a};
    for (int i = 0; i < 4; i++)
        items[i] = camber_value_number(round((double)parts[i] * (i < 3 ? 255e4 : 1e6)) / (i < 3 ? 1e4 : 1e6));
    *value = (camber_value){.type = CAMBER_VALUE_ARRAY, .count = 4, .items = items};
    return true;
}

static bool compile_to_rgba(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                            uint32_t *node) {
    (void)expected;
    return camber_compile_element(c, array, 1, camber_typing_of(row->operands), node) &&
           camber_wrap_node(c, row->evaluate, camber_typing_array(camber_typing_of(CAMBER_TYPE_NUMBER), 4), node);
}

static const camber_operator rows[] = {
    {"number", camber_compile_uniform, camber_evaluate_assert, VALUE, NUMBER, 1, ANY_COUNT},
    {"string", camber_compile_uniform, camber_evaluate_assert, VALUE, STRING, 1, ANY_COUNT},
    {"boolean", camber_compile_uniform, camber_evaluate_assert, VALUE, BOOL, 1, ANY_COUNT},
    {"object", camber_compile_uniform, camber_evaluate_assert, VALUE, OBJECT, 1, ANY_COUNT},
    {"array", compile_array, camber_evaluate_assert, VALUE, ARRAY, 1, ANY_COUNT},
    {"typeof", camber_compile_uniform, camber_evaluate_typeof, VALUE, STRING, 1, 1},
    {"to-number", camber_compile_uniform, evaluate_to_number, VALUE, NUMBER, 1, ANY_COUNT},
    {"to-string", camber_compile_uniform, camber_evaluate_to_string, VALUE, STRING, 1, 1},
    {"to-boolean", camber_compile_uniform, evaluate_to_bool, VALUE, BOOL, 1, 1},
    {"to-color", camber_compile_uniform, camber_evaluate_to_color, VALUE, COLOR, 1, ANY_COUNT},
    {"to-rgba", compile_to_rgba, evaluate_to_rgba, COLOR, ARRAY, 1, 1},
    {"rgb", camber_compile_uniform, evaluate_rgba, NUMBER, COLOR, 3, 3},
    {"rgba", camber_compile_uniform, evaluate_rgba, NUMBER, COLOR, 4, 4},
};

const camber_operator_table camber_type_operators = {rows, sizeof rows / sizeof *rows};
