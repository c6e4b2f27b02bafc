/* Strings and arrays, when expressions are evaluated. Letters are counted, not bytes. */
#include "style/evaluation.h"
#include "style/letters.h"

#include <math.h>

static bool fail(camber_evaluation *e, const char *cause) {
    return camber_evaluate_fail(e, cause);
}

static size_t count_letters(const char *text, const char *end) {
    size_t count = 0;
    uint32_t code;
    for (; *text && text < end; count++)
        text += camber_letter_read(text, &code);
    return count;
}

/* The place count letters behind text, or its end. */
static const char *skip_letters(const char *text, size_t count) {
    uint32_t code;
    for (size_t i = 0; i < count && *text; i++)
        text += camber_letter_read(text, &code);
    return text;
}

/* ---- Search ---- */

static bool is_needle(const camber_value *value) {
    return value->type <= CAMBER_VALUE_STRING;
}

/* A needle's text as ECMAScript's indexOf makes it: null is looked for as "null". */
static bool needle_text(camber_evaluation *e, const camber_value *needle, const char **string) {
    camber_text text = {.e = e};
    camber_value value;
    *string = needle->type == CAMBER_VALUE_STRING ? needle->string : "null";
    if (needle->type == CAMBER_VALUE_NULL || needle->type == CAMBER_VALUE_STRING)
        return true;
    if (!camber_text_add_value(&text, needle) || !camber_text_end(&text, &value))
        return false;
    *string = value.string;
    return true;
}

/* Where needle begins in haystack, from the from-th item or unit of UTF-16 on; -1: nowhere. */
static bool find(camber_evaluation *e, const camber_value *needle, const camber_value *haystack, double from,
                 double *found) {
    *found = -1.0;
    if (haystack->type == CAMBER_VALUE_ARRAY) {
        const double first = from < 0.0 ? fmax(from + haystack->count, 0.0) : from;
        if (!camber_evaluate_work(e, haystack->count))
            return false;
        for (uint32_t i = first < haystack->count ? (uint32_t)first : haystack->count; i < haystack->count; i++)
            if (camber_values_equal(needle, &haystack->items[i])) {
                *found = i;
                break;
            }
        return true;
    }
    const char *string, *start = haystack->string;
    uint32_t code;
    if (!needle_text(e, needle, &string) || !camber_evaluate_work(e, strlen(haystack->string)))
        return false;
    for (double units = 0.0; *start && units < from; units += code >= 0x10000 && code < CAMBER_STRAY_BYTE ? 2.0 : 1.0)
        start += camber_letter_read(start, &code);
    const char *at = strstr(start, string);
    if (at)
        *found = (double)count_letters(haystack->string, at);
    return true;
}

static bool evaluate_in(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value needle, haystack;
    double found = -1.0;
    if (!camber_evaluate_operand(e, node, 0, &needle) || !camber_evaluate_operand(e, node, 1, &haystack))
        return false;
    const bool nothing = haystack.type == CAMBER_VALUE_NULL ||
                         (haystack.type == CAMBER_VALUE_BOOL && !haystack.boolean) ||
                         (haystack.type == CAMBER_VALUE_NUMBER && !(fabs(haystack.number) > 0.0)) ||
                         (haystack.type == CAMBER_VALUE_STRING && !haystack.string[0]);
    if (!nothing && !is_needle(&needle))
        return fail(e, "\"in\" looks for a string, a number, a boolean or null");
    if (!nothing && haystack.type != CAMBER_VALUE_STRING && haystack.type != CAMBER_VALUE_ARRAY)
        return fail(e, "\"in\" looks in a string or an array");
    if (!nothing && !find(e, &needle, &haystack, 0.0, &found))
        return false;
    *value = camber_value_bool(found >= 0.0);
    return true;
}

static bool evaluate_index_of(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value needle, haystack;
    double from = 0.0, found;
    if (!camber_evaluate_operand(e, node, 0, &needle) || !camber_evaluate_operand(e, node, 1, &haystack))
        return false;
    if (!is_needle(&needle))
        return fail(e, "\"index-of\" looks for a string, a number, a boolean or null");
    if (node->count > 2 && !camber_evaluate_number(e, node, 2, &from))
        return false;
    if (haystack.type != CAMBER_VALUE_STRING && haystack.type != CAMBER_VALUE_ARRAY)
        return fail(e, "\"index-of\" looks in a string or an array");
    if (!find(e, &needle, &haystack, isnan(from) ? 0.0 : trunc(from), &found))
        return false;
    *value = camber_value_number(found);
    return true;
}

/* ---- Parts ---- */

static bool evaluate_at(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double index;
    camber_value array;
    if (!camber_evaluate_number(e, node, 0, &index) || !camber_evaluate_operand(e, node, 1, &array))
        return false;
    if (array.type != CAMBER_VALUE_ARRAY)
        return fail(e, "\"at\" takes an item of an array and the value is not one");
    if (!(index >= 0.0 && index < array.count))
        return fail(e, "the array has no item of this index");
    if (index > floor(index))
        return fail(e, "the index of an array's item is a whole number");
    *value = array.items[(uint32_t)index];
    return true;
}

/* An index of slice, counted from the end where it is negative, moved into 0 to count. */
static size_t slice_index(double index, size_t count) {
    if (isnan(index))
        return 0;
    index = trunc(index);
    if (index < 0.0)
        index += (double)count;
    return index <= 0.0 ? 0 : index >= (double)count ? count : (size_t)index;
}

static bool evaluate_slice(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double begin, end = HUGE_VAL;
    if (!camber_evaluate_operand(e, node, 0, value) || !camber_evaluate_number(e, node, 1, &begin) ||
        (node->count > 2 && !camber_evaluate_number(e, node, 2, &end)))
        return false;
    const bool string = value->type == CAMBER_VALUE_STRING;
    if (!string && value->type != CAMBER_VALUE_ARRAY)
        return fail(e, "\"slice\" takes a part of a string or an array");
    if (string && !camber_evaluate_work(e, strlen(value->string)))
        return false;
    const size_t count = string ? count_letters(value->string, value->string + strlen(value->string)) : value->count;
    const size_t first = slice_index(begin, count), last = slice_index(end, count);
    const size_t length = last > first ? last - first : 0;
    if (!string) {
        *value = (camber_value){.type = CAMBER_VALUE_ARRAY, .count = (uint32_t)length, .items = value->items + first};
        return true;
    }
    const char *from = skip_letters(value->string, first);
    const char *text = camber_arena_text(e->arena, from, (size_t)(skip_letters(from, length) - from));
    if (!text)
        return camber_evaluate_no_memory(e);
    *value = camber_value_string(text);
    return true;
}

static bool evaluate_length(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!camber_evaluate_operand(e, node, 0, value))
        return false;
    if (value->type == CAMBER_VALUE_ARRAY) {
        *value = camber_value_number(value->count);
        return true;
    }
    if (value->type != CAMBER_VALUE_STRING)
        return fail(e, "\"length\" is that of a string or an array");
    const size_t size = strlen(value->string);
    if (!camber_evaluate_work(e, size))
        return false;
    *value = camber_value_number((double)count_letters(value->string, value->string + size));
    return true;
}

/* ---- Making ---- */

static bool make_array(camber_evaluation *e, size_t count, camber_value **items, camber_value *value) {
    *items = count < UINT32_MAX ? camber_arena_alloc(e->arena, count * sizeof **items) : NULL;
    if (!*items)
        return camber_evaluate_no_memory(e);
    *value = (camber_value){.type = CAMBER_VALUE_ARRAY, .count = (uint32_t)count, .items = *items};
    return camber_evaluate_work(e, count);
}

static bool evaluate_list(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value *items;
    if (!make_array(e, node->count, &items, value))
        return false;
    for (uint32_t i = 0; i < node->count; i++)
        if (!camber_evaluate_operand(e, node, i, &items[i]))
            return false;
    return true;
}

/* The end of the piece that begins at text: its separator, or its letter where there is none. */
static const char *piece_end(const char *text, const char *separator) {
    const char *end = separator[0] ? strstr(text, separator) : skip_letters(text, 1);
    return end ? end : text + strlen(text);
}

static bool evaluate_split(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const char *text, *separator;
    if (!camber_evaluate_string(e, node, 0, &text) || !camber_evaluate_string(e, node, 1, &separator) ||
        !camber_evaluate_work(e, 2 * strlen(text)))
        return false;
    const size_t skipped = strlen(separator);
    size_t count = skipped || *text ? 1 : 0;
    for (const char *end = piece_end(text, separator); *end; end = piece_end(end + skipped, separator))
        count++;
    camber_value *items;
    if (!make_array(e, count, &items, value))
        return false;
    for (size_t i = 0; i < count; i++) {
        const char *end = piece_end(text, separator);
        const char *piece = camber_arena_text(e->arena, text, (size_t)(end - text));
        if (!piece)
            return camber_evaluate_no_memory(e);
        items[i] = camber_value_string(piece);
        text = end + (*end ? skipped : 0);
    }
    return true;
}

static bool evaluate_join(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value array;
    const char *separator;
    camber_text text = {.e = e};
    if (!camber_evaluate_operand(e, node, 0, &array) || !camber_evaluate_string(e, node, 1, &separator))
        return false;
    if (array.type != CAMBER_VALUE_ARRAY)
        return fail(e, "\"join\" joins the strings of an array and the value is not one");
    const size_t length = strlen(separator);
    for (uint32_t i = 0; i < array.count; i++)
        if ((i > 0 && !camber_text_add(&text, separator, length)) || !camber_text_add_value(&text, &array.items[i]))
            return false;
    return camber_text_end(&text, value);
}

static bool evaluate_concat(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_text text = {.e = e};
    for (uint32_t i = 0; i < node->count; i++)
        if (!camber_evaluate_operand(e, node, i, value) || !camber_text_add_value(&text, value))
            return false;
    return camber_text_end(&text, value);
}

static bool evaluate_case(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const char *string;
    camber_text text = {.e = e};
    if (!camber_evaluate_string(e, node, 0, &string))
        return false;
    while (*string) {
        uint32_t code, other[2];
        char bytes[4];
        string += camber_letter_read(string, &code);
        const size_t count =
            node->op == CAMBER_OP_UPCASE ? camber_letter_upper(code, other) : camber_letter_lower(code, other);
        for (size_t i = 0; i < count; i++)
            if (!camber_text_add(&text, bytes, camber_letter_write(other[i], bytes)))
                return false;
    }
    return camber_text_end(&text, value);
}

bool camber_evaluate_text(camber_evaluation *e, const camber_node *node, camber_value *value) {
    switch (node->op) {
    case CAMBER_OP_IN: return evaluate_in(e, node, value);
    case CAMBER_OP_INDEX_OF: return evaluate_index_of(e, node, value);
    case CAMBER_OP_AT: return evaluate_at(e, node, value);
    case CAMBER_OP_SLICE: return evaluate_slice(e, node, value);
    case CAMBER_OP_LENGTH: return evaluate_length(e, node, value);
    case CAMBER_OP_LIST: return evaluate_list(e, node, value);
    case CAMBER_OP_SPLIT: return evaluate_split(e, node, value);
    case CAMBER_OP_JOIN: return evaluate_join(e, node, value);
    case CAMBER_OP_CONCAT: return evaluate_concat(e, node, value);
    default: return evaluate_case(e, node, value);
    }
}
