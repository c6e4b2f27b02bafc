/* Strings and arrays: in, index-of, at, slice, length, split, join, concat and so on.
 *
 * Strings are UTF-8, and lengths and indices count code points, not bytes. The table at the end has each operator's
 * row. */
#include "style/evaluation.h"
#include "style/operators.h"
#include "style/text.h"
#include "style/unicode.h"

#include <math.h>
#include <string.h>

static const camber_typing any_type = {.type = CAMBER_TYPE_VALUE}, number_type = {.type = CAMBER_TYPE_NUMBER},
                           string_type = {.type = CAMBER_TYPE_STRING}, bool_type = {.type = CAMBER_TYPE_BOOL};

static bool fail(camber_evaluation *e, const char *cause) {
    return camber_evaluate_fail(e, cause);
}

static size_t count_code_points(const char *text, const char *end) {
    size_t count = 0;
    uint32_t code;
    for (; *text && text < end; count++)
        text += camber_unicode_read(text, &code);
    return count;
}

/* Returns the position count code points after text, or its end. */
static const char *skip_code_points(const char *text, size_t count) {
    uint32_t code;
    for (size_t i = 0; i < count && *text; i++)
        text += camber_unicode_read(text, &code);
    return text;
}

/* ---- Search, when compiled ---- */

static bool is_needle_type(camber_type type) {
    return type == CAMBER_TYPE_VALUE || type == CAMBER_TYPE_NULL || type == CAMBER_TYPE_BOOL ||
           type == CAMBER_TYPE_NUMBER || type == CAMBER_TYPE_STRING;
}

enum { SORTED_FROM = 8 };

/* Whether the node is a constant array of strings, or of numbers, that is long enough to be worth sorting. */
static bool is_list(const camber_node *node) {
    const camber_value *list = &node->value;
    if (!camber_is_constant(node) || list->type != CAMBER_VALUE_ARRAY || list->count < SORTED_FROM)
        return false;
    for (uint32_t i = 0; i < list->count; i++)
        if (list->items[i].type != list->items[0].type)
            return false;
    return list->items[0].type == CAMBER_VALUE_STRING || list->items[0].type == CAMBER_VALUE_NUMBER;
}

/* Turns a test for membership in a long constant list into a search among sorted labels. */
static bool make_among(camber_compiler *c, size_t first_operand, uint32_t *node) {
    const camber_value list = camber_node_at(c, c->operands[c->operand_count - 1])->value;
    const size_t first = c->expression->label_count;
    for (uint32_t i = 0; i < list.count; i++) {
        const camber_value *item = &list.items[i];
        const bool text = item->type == CAMBER_VALUE_STRING;
        const camber_match_label label = {.string = text ? item->string : NULL, .number = text ? 0.0 : item->number};
        if (!camber_push_label(c, &label))
            return false;
    }
    c->operand_count--;
    const camber_node prototype = {
        .evaluate = camber_evaluate_among, .type = bool_type, .index = (uint32_t)first, .index_count = list.count};
    return camber_sort_labels(c, first, false) && camber_make_node(c, &prototype, first_operand, node);
}

/* Compiles in, !in and index-of. */
static bool compile_in(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                       uint32_t *node) {
    (void)expected;
    char found[CAMBER_TYPING_TEXT_SIZE];
    const size_t first_operand = c->operand_count;
    if (!camber_compile_operand(c, array, 1, any_type) || !camber_compile_element(c, array, 2, any_type, node) ||
        !camber_push_operand(c, *node))
        return false;
    const camber_typing needle = camber_node_at(c, c->operands[first_operand])->type;
    if (!is_needle_type(needle.type))
        return camber_compiler_fail(c,
                                    "\"%s\" looks for a string, a number, a boolean or null, found %s; write e.g. "
                                    "[\"in\", [\"get\", \"kind\"], [\"literal\", [\"a\", \"b\"]]]",
                                    row->name, camber_typing_name(needle, found));
    if (json_array_size(array) == 4 && !camber_compile_operand(c, array, 3, number_type))
        return false;
    const bool list = row->evaluate == camber_evaluate_in && is_list(camber_node_at(c, *node));
    const camber_node prototype = {.evaluate = row->evaluate, .type = camber_typing_of(row->result)};
    if (!(list ? make_among(c, first_operand, node) : camber_make_node(c, &prototype, first_operand, node)))
        return false;
    return row->name[0] != '!' || camber_wrap_node(c, camber_evaluate_not, bool_type, node);
}

/* ---- Search, when evaluated ---- */

static bool is_needle(const camber_value *value) {
    return value->type <= CAMBER_VALUE_STRING;
}

/* Makes the text of a needle like ECMAScript's indexOf, for which null is "null". */
static bool needle_text(camber_evaluation *e, const camber_value *needle, const char **string) {
    camber_string text = {.e = e};
    camber_value value;
    *string = needle->type == CAMBER_VALUE_STRING ? needle->string : "null";
    if (needle->type == CAMBER_VALUE_NULL || needle->type == CAMBER_VALUE_STRING)
        return true;
    if (!camber_string_add_value(&text, needle) || !camber_string_end(&text, &value))
        return false;
    *string = value.string;
    return true;
}

/* Finds where needle begins in haystack, starting at the item or UTF-16 unit from. -1: it is not there. */
static bool find_needle(camber_evaluation *e, const camber_value *needle, const camber_value *haystack, double from,
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
        start += camber_unicode_read(start, &code);
    const char *at = strstr(start, string);
    if (at)
        *found = (double)count_code_points(haystack->string, at);
    return true;
}

bool camber_evaluate_in(camber_evaluation *e, const camber_node *node, camber_value *value) {
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
    if (!nothing && !find_needle(e, &needle, &haystack, 0.0, &found))
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
    if (!find_needle(e, &needle, &haystack, isnan(from) ? 0.0 : trunc(from), &found))
        return false;
    *value = camber_value_number(found);
    return true;
}

/* ---- Items and slices ---- */

static bool evaluate_at(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double index;
    camber_value array;
    if (!camber_evaluate_number(e, node, 0, &index) || !camber_evaluate_operand(e, node, 1, &array))
        return false;
    if (array.type != CAMBER_VALUE_ARRAY)
        return fail(e, "\"at\" takes an array, and the value is not one");
    if (!(index >= 0.0 && index < array.count))
        return fail(e, "the array has no item of this index");
    if (index > floor(index))
        return fail(e, "the index of an array's item must be a whole number");
    *value = array.items[(uint32_t)index];
    return true;
}

static bool compile_at(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                       uint32_t *node) {
    const size_t first_operand = c->operand_count;
    if (!camber_compile_operand(c, array, 1, number_type) ||
        !camber_compile_element(c, array, 2, camber_typing_array(expected, CAMBER_ANY_LENGTH), node) ||
        !camber_push_operand(c, *node))
        return false;
    const camber_typing type = camber_typing_item(camber_node_at(c, *node)->type);
    return camber_make_node(c, &(camber_node){.evaluate = row->evaluate, .type = type}, first_operand, node);
}

/* Clamps an index of slice to the range from 0 to count. Negative indices count from the end. */
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
        return fail(e, "\"slice\" takes a string or an array");
    if (string && !camber_evaluate_work(e, strlen(value->string)))
        return false;
    const size_t count =
        string ? count_code_points(value->string, value->string + strlen(value->string)) : value->count;
    const size_t first = slice_index(begin, count), last = slice_index(end, count);
    const size_t length = last > first ? last - first : 0;
    if (!string) {
        *value = (camber_value){.type = CAMBER_VALUE_ARRAY, .count = (uint32_t)length, .items = value->items + first};
        return true;
    }
    const char *from = skip_code_points(value->string, first);
    const char *text = camber_arena_text(e->arena, from, (size_t)(skip_code_points(from, length) - from));
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
        return fail(e, "\"length\" takes a string or an array");
    const size_t size = strlen(value->string);
    if (!camber_evaluate_work(e, size))
        return false;
    *value = camber_value_number((double)count_code_points(value->string, value->string + size));
    return true;
}

static bool fail_sequence(camber_compiler *c, const camber_operator *row, camber_typing found) {
    char name[CAMBER_TYPING_TEXT_SIZE];
    return camber_compiler_fail(c, "\"%s\" takes a string or an array, found %s; convert it", row->name,
                                camber_typing_name(found, name));
}

static bool is_sequence(camber_type type) {
    return type == CAMBER_TYPE_VALUE || type == CAMBER_TYPE_STRING || type == CAMBER_TYPE_ARRAY;
}

static bool compile_slice(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                          uint32_t *node) {
    (void)expected;
    const size_t first_operand = c->operand_count;
    if (!camber_compile_element(c, array, 1, any_type, node) || !camber_push_operand(c, *node))
        return false;
    camber_typing type = camber_node_at(c, *node)->type;
    for (size_t i = 2; i < json_array_size(array); i++)
        if (!camber_compile_operand(c, array, i, number_type))
            return false;
    return is_sequence(type.type)
               ? camber_make_node(c, &(camber_node){.evaluate = row->evaluate, .type = type}, first_operand, node)
               : fail_sequence(c, row, type);
}

static bool compile_length(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                           uint32_t *node) {
    (void)expected;
    if (!camber_compile_element(c, array, 1, any_type, node))
        return false;
    const camber_typing type = camber_node_at(c, *node)->type;
    return is_sequence(type.type) ? camber_wrap_node(c, row->evaluate, number_type, node) : fail_sequence(c, row, type);
}

/* ---- New arrays and strings ---- */

static bool make_array(camber_evaluation *e, size_t count, camber_value **items, camber_value *value) {
    *items = count < UINT32_MAX ? camber_arena_alloc(e->arena, count * sizeof **items) : NULL;
    if (!*items)
        return camber_evaluate_no_memory(e);
    *value = (camber_value){.type = CAMBER_VALUE_ARRAY, .count = (uint32_t)count, .items = *items};
    return camber_evaluate_work(e, count);
}

/* Makes an array of the operands. */
bool camber_evaluate_list(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value *items;
    if (!make_array(e, node->count, &items, value))
        return false;
    for (uint32_t i = 0; i < node->count; i++)
        if (!camber_evaluate_operand(e, node, i, &items[i]))
            return false;
    return true;
}

/* Returns the end of the part that begins at text: its separator, or the end of its first code point if separator is
 * empty. */
static const char *part_end(const char *text, const char *separator) {
    const char *end = separator[0] ? strstr(text, separator) : skip_code_points(text, 1);
    return end ? end : text + strlen(text);
}

static bool evaluate_split(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const char *text, *separator;
    if (!camber_evaluate_string(e, node, 0, &text) || !camber_evaluate_string(e, node, 1, &separator) ||
        !camber_evaluate_work(e, 2 * strlen(text)))
        return false;
    const size_t skipped = strlen(separator);
    size_t count = skipped || *text ? 1 : 0;
    for (const char *end = part_end(text, separator); *end; end = part_end(end + skipped, separator))
        count++;
    camber_value *items;
    if (!make_array(e, count, &items, value))
        return false;
    for (size_t i = 0; i < count; i++) {
        const char *end = part_end(text, separator);
        const char *part = camber_arena_text(e->arena, text, (size_t)(end - text));
        if (!part)
            return camber_evaluate_no_memory(e);
        items[i] = camber_value_string(part);
        text = end + (*end ? skipped : 0);
    }
    return true;
}

static bool compile_split(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                          uint32_t *node) {
    (void)expected;
    const size_t first_operand = c->operand_count;
    const camber_node prototype = {.evaluate = row->evaluate,
                                   .type = camber_typing_array(string_type, CAMBER_ANY_LENGTH)};
    return camber_compile_operand(c, array, 1, string_type) && camber_compile_operand(c, array, 2, string_type) &&
           camber_make_node(c, &prototype, first_operand, node);
}

static bool evaluate_join(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value array;
    const char *separator;
    camber_string text = {.e = e};
    if (!camber_evaluate_operand(e, node, 0, &array) || !camber_evaluate_string(e, node, 1, &separator))
        return false;
    if (array.type != CAMBER_VALUE_ARRAY)
        return fail(e, "\"join\" takes an array of strings, and the value is not one");
    const size_t length = strlen(separator);
    for (uint32_t i = 0; i < array.count; i++)
        if ((i > 0 && !camber_string_add(&text, separator, length)) || !camber_string_add_value(&text, &array.items[i]))
            return false;
    return camber_string_end(&text, value);
}

static bool compile_join(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                         uint32_t *node) {
    (void)expected;
    const size_t first_operand = c->operand_count;
    return camber_compile_operand(c, array, 1, camber_typing_array(string_type, CAMBER_ANY_LENGTH)) &&
           camber_compile_operand(c, array, 2, string_type) &&
           camber_make_node(c, &(camber_node){.evaluate = row->evaluate, .type = string_type}, first_operand, node);
}

bool camber_evaluate_concat(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_string text = {.e = e};
    for (uint32_t i = 0; i < node->count; i++)
        if (!camber_evaluate_operand(e, node, i, value) || !camber_string_add_value(&text, value))
            return false;
    return camber_string_end(&text, value);
}

static bool change_case(camber_evaluation *e, const camber_node *node, camber_unicode_case_fn *change,
                        camber_value *value) {
    const char *string;
    camber_string text = {.e = e};
    return camber_evaluate_string(e, node, 0, &string) && camber_string_add_cased(&text, string, change) &&
           camber_string_end(&text, value);
}

static bool evaluate_upcase(camber_evaluation *e, const camber_node *node, camber_value *value) {
    return change_case(e, node, camber_unicode_upper, value);
}

static bool evaluate_downcase(camber_evaluation *e, const camber_node *node, camber_value *value) {
    return change_case(e, node, camber_unicode_lower, value);
}

static const camber_operator rows[] = {
    {"at", compile_at, evaluate_at, VALUE, VALUE, 2, 2},
    {"in", compile_in, camber_evaluate_in, VALUE, BOOL, 2, 2},
    {"!in", compile_in, camber_evaluate_in, VALUE, BOOL, 2, 2},
    {"index-of", compile_in, evaluate_index_of, VALUE, NUMBER, 2, 3},
    {"slice", compile_slice, evaluate_slice, VALUE, VALUE, 2, 3},
    {"length", compile_length, evaluate_length, VALUE, NUMBER, 1, 1},
    {"split", compile_split, evaluate_split, STRING, ARRAY, 2, 2},
    {"join", compile_join, evaluate_join, ARRAY, STRING, 2, 2},
    {"concat", camber_compile_uniform, camber_evaluate_concat, VALUE, STRING, 0, ANY_COUNT},
    {"upcase", camber_compile_uniform, evaluate_upcase, STRING, STRING, 1, 1},
    {"downcase", camber_compile_uniform, evaluate_downcase, STRING, STRING, 1, 1},
};

const camber_operator_table camber_sequence_operators = {rows, sizeof rows / sizeof *rows};
