/* Texts that an evaluation makes. They grow in its memory, and any value can be appended. Numbers and JSON are written
 * as in ECMAScript. */
#include "style/text.h"

#include "style/section.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool camber_string_add(camber_string *text, const char *bytes, size_t length) {
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

bool camber_string_add_cased(camber_string *text, const char *string, camber_unicode_case_fn *change) {
    while (*string) {
        uint32_t code, other[2];
        char bytes[4];
        string += camber_unicode_read(string, &code);
        const size_t count = change(code, other);
        for (size_t i = 0; i < count; i++)
            if (!camber_string_add(text, bytes, camber_unicode_write(other[i], bytes)))
                return false;
    }
    return true;
}

bool camber_string_end(camber_string *text, camber_value *value) {
    const char end = 0;
    if (!camber_string_add(text, &end, 1))
        return false;
    *value = camber_value_string(text->bytes);
    return true;
}

static bool add(camber_string *text, const char *string) {
    return camber_string_add(text, string, strlen(string));
}

/* Finding the digits of a number takes as long as copying this many bytes. */
enum { NUMBER_WORK = 100 };

static bool add_number(camber_string *text, double number) {
    char digits[CAMBER_NUMBER_TEXT_SIZE];
    if (!camber_evaluate_work(text->e, NUMBER_WORK))
        return false;
    camber_number_format(number, digits);
    return add(text, digits);
}

/* Alpha is a float. It is written as a multiple of 1/255 if it is one, otherwise with six digits. */
static double true_alpha(double alpha) {
    const double step = round(alpha * 255.0) / 255.0;
    return fabs(alpha - step) < 1e-7 ? step : round(alpha * 1e6) / 1e6;
}

static bool add_color(camber_string *text, camber_color color) {
    char rgb[64];
    snprintf(rgb, sizeof rgb, "rgba(%.0f,%.0f,%.0f,", round((double)color.r * 255.0), round((double)color.g * 255.0),
             round((double)color.b * 255.0));
    return add(text, rgb) && add_number(text, true_alpha((double)color.a)) && add(text, ")");
}

/* Adds the text of all sections. Images have no text. */
static bool add_sections(camber_string *text, const camber_value *value) {
    for (uint32_t i = 0; i < value->count; i++)
        if (!add(text, value->sections[i].text))
            return false;
    return true;
}

/* ---- JSON, like ECMAScript's JSON.stringify ---- */

static bool add_json(camber_string *text, const camber_value *value);

static bool add_quoted(camber_string *text, const char *string) {
    static const char plain[] = "\"\\\b\f\n\r\t", letters[] = "\"\\bfnrt";
    if (!add(text, "\""))
        return false;
    for (const char *c = string; *c; c++) {
        const char *escaped = strchr(plain, *c);
        char escape[8] = {'\\', escaped ? letters[escaped - plain] : 0, 0};
        if (!escaped && (unsigned char)*c < ' ')
            snprintf(escape, sizeof escape, "\\u%04x", (unsigned)*c);
        if (!(escaped || (unsigned char)*c < ' ' ? add(text, escape) : camber_string_add(text, c, 1)))
            return false;
    }
    return add(text, "\"");
}

static int compare_positions(const void *left, const void *right) {
    const camber_member *a = *(const camber_member *const *)left, *b = *(const camber_member *const *)right;
    return a->position < b->position ? -1 : a->position > b->position;
}

static bool add_object(camber_string *text, const camber_value *object) {
    const camber_member **members = camber_arena_alloc(text->e->arena, object->count * sizeof *members);
    if (!members)
        return camber_evaluate_no_memory(text->e);
    for (uint32_t i = 0; i < object->count; i++)
        members[i] = &object->members[i];
    qsort(members, object->count, sizeof *members, compare_positions);
    if (!add(text, "{"))
        return false;
    for (uint32_t i = 0; i < object->count; i++)
        if ((i > 0 && !add(text, ",")) || !add_quoted(text, members[i]->key) || !add(text, ":") ||
            !add_json(text, &members[i]->value))
            return false;
    return add(text, "}");
}

static bool add_array(camber_string *text, const camber_value *array) {
    if (!add(text, "["))
        return false;
    for (uint32_t i = 0; i < array->count; i++)
        if ((i > 0 && !add(text, ",")) || !add_json(text, &array->items[i]))
            return false;
    return add(text, "]");
}

/* The recursion is bounded, because documents and the calls that make values have a limited depth. */
static bool add_json(camber_string *text, const camber_value *value) {
    switch (value->type) {
    case CAMBER_VALUE_NULL: return add(text, "null");
    case CAMBER_VALUE_BOOL: return add(text, value->boolean ? "true" : "false");
    case CAMBER_VALUE_NUMBER: return isfinite(value->number) ? add_number(text, value->number) : add(text, "null");
    case CAMBER_VALUE_STRING: return add_quoted(text, value->string);
    case CAMBER_VALUE_COLOR: return add(text, "\"") && add_color(text, value->color) && add(text, "\"");
    case CAMBER_VALUE_ARRAY: return add_array(text, value);
    case CAMBER_VALUE_FORMATTED: return add(text, "\"") && add_sections(text, value) && add(text, "\"");
    case CAMBER_VALUE_OBJECT: break;
    }
    return add_object(text, value);
}

bool camber_string_add_value(camber_string *text, const camber_value *value) {
    switch (value->type) {
    case CAMBER_VALUE_NULL: return true;
    case CAMBER_VALUE_STRING: return add(text, value->string);
    case CAMBER_VALUE_NUMBER: return add_number(text, value->number);
    case CAMBER_VALUE_COLOR: return add_color(text, value->color);
    case CAMBER_VALUE_FORMATTED: return add_sections(text, value);
    case CAMBER_VALUE_BOOL:
    case CAMBER_VALUE_ARRAY:
    case CAMBER_VALUE_OBJECT: break;
    }
    return add_json(text, value);
}
