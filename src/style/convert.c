/* Conversions and assertions, when expressions are evaluated. */
#include "style/color.h"
#include "style/evaluation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static bool fail(camber_evaluation *e, const char *cause) {
    return camber_evaluate_fail(e, cause);
}

/* ---- Texts ---- */

bool camber_text_add(camber_text *text, const char *bytes, size_t length) {
    if (length >= text->capacity - text->length) {
        const size_t capacity = 2 * (text->length + length) + 32;
        char *grown = camber_arena_alloc(text->e->arena, capacity);
        if (!grown)
            return camber_evaluate_no_memory(text->e);
        if (text->length)
            memcpy(grown, text->bytes, text->length);
        text->bytes = grown;
        text->capacity = capacity;
    }
    if (length)
        memcpy(text->bytes + text->length, bytes, length);
    text->length += length;
    return camber_evaluate_work(text->e, length);
}

bool camber_text_end(camber_text *text, camber_value *value) {
    const char end = 0;
    if (!camber_text_add(text, &end, 1))
        return false;
    *value = camber_value_string(text->bytes);
    return true;
}

static bool add(camber_text *text, const char *string) {
    return camber_text_add(text, string, strlen(string));
}

static bool add_number(camber_text *text, double number) {
    char digits[CAMBER_NUMBER_TEXT_SIZE];
    camber_number_format(number, digits);
    return add(text, digits);
}

/* Alpha is a float: its digits are those of the 255th that it is, or six. */
static double true_alpha(double alpha) {
    const double step = round(alpha * 255.0) / 255.0;
    return fabs(alpha - step) < 1e-7 ? step : round(alpha * 1e6) / 1e6;
}

static bool add_color(camber_text *text, camber_color color) {
    char rgb[64];
    snprintf(rgb, sizeof rgb, "rgba(%.0f,%.0f,%.0f,", round((double)color.r * 255.0), round((double)color.g * 255.0),
             round((double)color.b * 255.0));
    return add(text, rgb) && add_number(text, true_alpha((double)color.a)) && add(text, ")");
}

/* ---- JSON, as ECMAScript's JSON.stringify ---- */

static bool add_json(camber_text *text, const camber_value *value);

static bool add_quoted(camber_text *text, const char *string) {
    static const char plain[] = "\"\\\b\f\n\r\t", letters[] = "\"\\bfnrt";
    if (!add(text, "\""))
        return false;
    for (const char *c = string; *c; c++) {
        const char *escaped = strchr(plain, *c);
        char escape[8] = {'\\', escaped ? letters[escaped - plain] : 0, 0};
        if (!escaped && (unsigned char)*c < ' ')
            snprintf(escape, sizeof escape, "\\u%04x", (unsigned)*c);
        if (!(escaped || (unsigned char)*c < ' ' ? add(text, escape) : camber_text_add(text, c, 1)))
            return false;
    }
    return add(text, "\"");
}

static int compare_places(const void *left, const void *right) {
    const camber_member *a = *(const camber_member *const *)left, *b = *(const camber_member *const *)right;
    return a->place < b->place ? -1 : a->place > b->place;
}

static bool add_object(camber_text *text, const camber_value *object) {
    const camber_member **members = camber_arena_alloc(text->e->arena, object->count * sizeof *members);
    if (!members)
        return camber_evaluate_no_memory(text->e);
    for (uint32_t i = 0; i < object->count; i++)
        members[i] = &object->members[i];
    qsort(members, object->count, sizeof *members, compare_places);
    if (!add(text, "{"))
        return false;
    for (uint32_t i = 0; i < object->count; i++)
        if ((i > 0 && !add(text, ",")) || !add_quoted(text, members[i]->key) || !add(text, ":") ||
            !add_json(text, &members[i]->value))
            return false;
    return add(text, "}");
}

static bool add_array(camber_text *text, const camber_value *array) {
    if (!add(text, "["))
        return false;
    for (uint32_t i = 0; i < array->count; i++)
        if ((i > 0 && !add(text, ",")) || !add_json(text, &array->items[i]))
            return false;
    return add(text, "]");
}

/* Values come from documents and calls of bounded depth, and so does the recursion. */
static bool add_json(camber_text *text, const camber_value *value) {
    switch (value->type) {
    case CAMBER_VALUE_NULL: return add(text, "null");
    case CAMBER_VALUE_BOOL: return add(text, value->boolean ? "true" : "false");
    case CAMBER_VALUE_NUMBER: return isfinite(value->number) ? add_number(text, value->number) : add(text, "null");
    case CAMBER_VALUE_STRING: return add_quoted(text, value->string);
    case CAMBER_VALUE_COLOR: return add(text, "\"") && add_color(text, value->color) && add(text, "\"");
    case CAMBER_VALUE_ARRAY: return add_array(text, value);
    case CAMBER_VALUE_OBJECT: break;
    }
    return add_object(text, value);
}

bool camber_text_add_value(camber_text *text, const camber_value *value) {
    switch (value->type) {
    case CAMBER_VALUE_NULL: return true;
    case CAMBER_VALUE_STRING: return add(text, value->string);
    case CAMBER_VALUE_NUMBER: return add_number(text, value->number);
    case CAMBER_VALUE_COLOR: return add_color(text, value->color);
    case CAMBER_VALUE_BOOL:
    case CAMBER_VALUE_ARRAY:
    case CAMBER_VALUE_OBJECT: break;
    }
    return add_json(text, value);
}

static bool evaluate_to_string(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!camber_evaluate_operand(e, node, 0, value))
        return false;
    if (value->type == CAMBER_VALUE_STRING)
        return true;
    camber_text text = {.e = e};
    return camber_text_add_value(&text, value) && camber_text_end(&text, value);
}

/* ---- Numbers ---- */

static const char *skip_space(const char *text) {
    return text + strspn(text, " \t\r\n\f\v");
}

/* Digits behind 0x, 0o or 0b. NULL: there are none. */
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

/* Number(string) of ECMAScript. */
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
    /* ECMAScript makes a text of an array: that of its item where it has one. */
    while (value->type == CAMBER_VALUE_ARRAY && value->count == 1)
        value = &value->items[0];
    switch (value->type) {
    case CAMBER_VALUE_NULL: return true;
    case CAMBER_VALUE_BOOL: *number = value->boolean ? 1.0 : 0.0; return true;
    case CAMBER_VALUE_NUMBER: *number = value->number; return !isnan(value->number);
    case CAMBER_VALUE_STRING: return string_to_number(value->string, number);
    case CAMBER_VALUE_ARRAY: return value->count == 0;
    case CAMBER_VALUE_COLOR:
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
    return fail(e, "the value is not the text of a number");
}

static bool to_bool(const camber_value *value) {
    switch (value->type) {
    case CAMBER_VALUE_NULL: return false;
    case CAMBER_VALUE_BOOL: return value->boolean;
    case CAMBER_VALUE_NUMBER: return value->number < 0.0 || value->number > 0.0;
    case CAMBER_VALUE_STRING: return value->string[0] != 0;
    case CAMBER_VALUE_COLOR:
    case CAMBER_VALUE_ARRAY:
    case CAMBER_VALUE_OBJECT: break;
    }
    return true;
}

/* ---- Colours ---- */

/* r, g and b from 0 to 255, alpha from 0 to 1. */
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

/* The specification's own engine takes an array's r, g and b to be multiplied by alpha already. */
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

static bool evaluate_to_color(camber_evaluation *e, const camber_node *node, camber_value *value) {
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
        return fail(e, "red, green and blue go from 0 to 255, alpha from 0 to 1");
    *value = from_rgba(parts, 255.0);
    return true;
}

/* Components are floats: digits past those that they have are noise. */
static bool evaluate_to_rgba(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!camber_evaluate_operand(e, node, 0, value))
        return false;
    if (value->type != CAMBER_VALUE_COLOR)
        return fail(e, "a colour is wanted and the value is not one");
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

/* ---- Types ---- */

static bool evaluate_assert(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i < node->count; i++) {
        if (!camber_evaluate_operand(e, node, i, value))
            return false;
        if (value->type == CAMBER_VALUE_ARRAY && !camber_evaluate_work(e, value->count))
            return false;
        if (camber_typing_fits(node->type, camber_typing_of_value(value)))
            return true;
    }
    return fail(e, node->type.type == CAMBER_TYPE_NUMBER   ? "a number is wanted and the value is not one"
                   : node->type.type == CAMBER_TYPE_STRING ? "a string is wanted and the value is not one"
                   : node->type.type == CAMBER_TYPE_BOOL   ? "a boolean is wanted and the value is not one"
                   : node->type.type == CAMBER_TYPE_ARRAY
                       ? "an array of another type or length is wanted than the value is"
                       : "an object is wanted and the value is not one");
}

static bool evaluate_typeof(camber_evaluation *e, const camber_node *node, camber_value *value) {
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

bool camber_evaluate_conversion(camber_evaluation *e, const camber_node *node, camber_value *value) {
    switch (node->op) {
    case CAMBER_OP_ASSERT: return evaluate_assert(e, node, value);
    case CAMBER_OP_TO_NUMBER: return evaluate_to_number(e, node, value);
    case CAMBER_OP_TO_STRING: return evaluate_to_string(e, node, value);
    case CAMBER_OP_TO_COLOR: return evaluate_to_color(e, node, value);
    case CAMBER_OP_TO_RGBA: return evaluate_to_rgba(e, node, value);
    case CAMBER_OP_RGBA: return evaluate_rgba(e, node, value);
    case CAMBER_OP_TYPEOF: return evaluate_typeof(e, node, value);
    default: break;
    }
    if (!camber_evaluate_operand(e, node, 0, value))
        return false;
    *value = camber_value_bool(to_bool(value));
    return true;
}
