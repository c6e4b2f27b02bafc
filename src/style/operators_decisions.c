/* Comparisons and decisions: ==, all, case, match, coalesce and so on.
 *
 * Only operands that affect the result are evaluated: "all" stops at the first false operand, "case" at the first true
 * condition. The labels of "match" are sorted when it is compiled, and searched when it is evaluated. The table at the
 * end has each operator's row. */
#include "style/evaluation.h"
#include "style/operators.h"
#include "style/unicode.h"

#include <math.h>
#include <string.h>

static const camber_typing any_type = {.type = CAMBER_TYPE_VALUE}, bool_type = {.type = CAMBER_TYPE_BOOL};

static const camber_value nothing = {.type = CAMBER_VALUE_NULL};

/* ---- Comparisons, when compiled ---- */

static bool is_order(uint32_t outcomes) {
    return outcomes != CAMBER_OUTCOME_EQUAL && outcomes != (CAMBER_OUTCOME_LESS | CAMBER_OUTCOME_GREATER);
}

static bool is_comparable(camber_type type, bool order) {
    switch (type) {
    case CAMBER_TYPE_VALUE:
    case CAMBER_TYPE_NUMBER:
    case CAMBER_TYPE_STRING: return true;
    case CAMBER_TYPE_BOOL:
    case CAMBER_TYPE_NULL: return !order;
    default: return false;
    }
}

/* Compiles one side without an expected type. */
static bool compile_side(camber_compiler *c, const camber_operator *row, const json_t *array, size_t index,
                         uint32_t *node) {
    const bool order = is_order(row->variant);
    char name[CAMBER_TYPING_TEXT_SIZE];
    if (!camber_compile_element(c, array, index, any_type, node))
        return false;
    const camber_typing type = camber_node_at(c, *node)->type;
    if (is_comparable(type.type, order))
        return true;
    camber_compiler_enter_index(c, index);
    return camber_compiler_fail(c, "\"%s\" does not compare %s; convert it first", row->name,
                                camber_typing_name(type, name));
}

static bool compile_collation(camber_compiler *c, const json_t *array, const camber_type types[2]) {
    bool strings = false;
    for (int i = 0; i < 2; i++)
        strings = strings || types[i] == CAMBER_TYPE_STRING || types[i] == CAMBER_TYPE_VALUE;
    if (!strings)
        return camber_compiler_fail(c, "a collator compares strings; leave it out");
    return camber_compile_operand(c, array, 3, camber_typing_of(CAMBER_TYPE_COLLATOR));
}

static bool compile_comparison(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                               uint32_t *node) {
    (void)expected;
    const bool order = is_order(row->variant);
    const size_t first_operand = c->operand_count;
    uint32_t sides[2] = {0};
    camber_type types[2];
    for (size_t i = 0; i < 2; i++) {
        if (!compile_side(c, row, array, i + 1, &sides[i]))
            return false;
        types[i] = camber_node_at(c, sides[i])->type.type;
    }
    if (types[0] != types[1] && types[0] != CAMBER_TYPE_VALUE && types[1] != CAMBER_TYPE_VALUE) {
        char a[CAMBER_TYPING_TEXT_SIZE], b[CAMBER_TYPING_TEXT_SIZE];
        return camber_compiler_fail(c, "\"%s\" compares %s with %s; convert one of them", row->name,
                                    camber_typing_name(camber_typing_of(types[0]), a),
                                    camber_typing_name(camber_typing_of(types[1]), b));
    }
    for (size_t i = 0; i < 2; i++)
        if ((order && !camber_annotate(c, camber_typing_of(types[1 - i]), CAMBER_ANNOTATE_ASSERT, &sides[i])) ||
            !camber_push_operand(c, sides[i]))
            return false;
    if (json_array_size(array) == 4 && !compile_collation(c, array, types))
        return false;
    return camber_make_node(c, &(camber_node){.evaluate = row->evaluate, .type = bool_type, .index = row->variant},
                            first_operand, node);
}

/* Compiles the options {"case-sensitive": boolean, "diacritic-sensitive": boolean, "locale": string}. */
static bool compile_collator(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                             uint32_t *node) {
    static const char *const flags[] = {"case-sensitive", "diacritic-sensitive"};
    (void)expected;
    const size_t first_operand = c->operand_count;
    json_t *options = json_array_get(array, 1);
    camber_compiler_enter_index(c, 1);
    if (!json_is_object(options))
        return camber_compiler_fail(c, "expected an object, found %s; write {\"case-sensitive\": false}",
                                    camber_json_name(options));
    for (size_t i = 0; i < 2; i++) {
        json_t *flag = json_object_get(options, flags[i]);
        const camber_value no = {.type = CAMBER_VALUE_BOOL};
        camber_compiler_enter_key(c, flags[i]);
        if (!(flag ? camber_compile(c, flag, bool_type, node) : camber_make_constant(c, &no, bool_type, node)) ||
            !camber_push_operand(c, *node))
            return false;
        camber_compiler_leave(c);
    }
    json_t *locale = json_object_get(options, "locale");
    camber_compiler_enter_key(c, "locale");
    if (locale && !camber_compile(c, locale, camber_typing_of(CAMBER_TYPE_STRING), node))
        return false;
    camber_compiler_leave(c);
    camber_compiler_leave(c);
    return camber_make_node(c, &(camber_node){.evaluate = row->evaluate, .type = camber_typing_of(row->result)},
                            first_operand, node);
}

/* ---- Comparisons, when evaluated ---- */

bool camber_values_equal(const camber_value *a, const camber_value *b) {
    if (a->type != b->type)
        return false;
    switch (a->type) {
    case CAMBER_VALUE_NULL: return true;
    case CAMBER_VALUE_BOOL: return a->boolean == b->boolean;
    case CAMBER_VALUE_NUMBER: return a->number >= b->number && a->number <= b->number;
    case CAMBER_VALUE_STRING: return strcmp(a->string, b->string) == 0;
    case CAMBER_VALUE_COLOR: return false;
    case CAMBER_VALUE_ARRAY: return a->items == b->items && a->count == b->count;
    case CAMBER_VALUE_FORMATTED: return a->sections == b->sections;
    case CAMBER_VALUE_OBJECT: break;
    }
    return a->members == b->members && a->count == b->count;
}

enum { COLLATE_CASE = 1, COLLATE_DIACRITICS = 2 };

bool camber_evaluate_collator(camber_evaluation *e, const camber_node *node, camber_value *value) {
    bool by_case, by_diacritics;
    if (!camber_evaluate_bool(e, node, 0, &by_case) || !camber_evaluate_bool(e, node, 1, &by_diacritics))
        return false;
    *value = camber_value_number((by_case ? COLLATE_CASE : 0) + (by_diacritics ? COLLATE_DIACRITICS : 0));
    return true;
}

static int compare_strings(const char *a, const char *b, const camber_value *collator) {
    if (!collator)
        return strcmp(a, b);
    const int by = (int)collator->number;
    return camber_unicode_compare(a, b, by & COLLATE_CASE, by & COLLATE_DIACRITICS);
}

/* Whether the comparison is true for this outcome. */
static bool holds(uint32_t outcomes, bool less, bool equal) {
    return outcomes & (less ? CAMBER_OUTCOME_LESS : equal ? CAMBER_OUTCOME_EQUAL : CAMBER_OUTCOME_GREATER);
}

bool camber_evaluate_comparison(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value a, b, collator = nothing;
    if (!camber_evaluate_operand(e, node, 0, &a) || !camber_evaluate_operand(e, node, 1, &b) ||
        (node->count > 2 && !camber_evaluate_operand(e, node, 2, &collator)))
        return false;
    const bool strings = a.type == CAMBER_VALUE_STRING && b.type == CAMBER_VALUE_STRING;
    const bool numbers = a.type == CAMBER_VALUE_NUMBER && b.type == CAMBER_VALUE_NUMBER;
    const bool order = is_order(node->index);
    if (order && !strings && !numbers)
        return camber_evaluate_fail(e, "expected two numbers or two strings");
    if (strings) {
        const int sign = compare_strings(a.string, b.string, node->count > 2 ? &collator : NULL);
        *value = camber_value_bool(holds(node->index, sign < 0, sign == 0));
    } else if (order && (isnan(a.number) || isnan(b.number))) {
        *value = camber_value_bool(false);
    } else {
        *value = camber_value_bool(holds(node->index, numbers && a.number < b.number, camber_values_equal(&a, &b)));
    }
    return true;
}

/* ---- Booleans ---- */

bool camber_evaluate_not(camber_evaluation *e, const camber_node *node, camber_value *value) {
    bool boolean;
    if (!camber_evaluate_bool(e, node, 0, &boolean))
        return false;
    *value = camber_value_bool(!boolean);
    return true;
}

static bool evaluate_junction(camber_evaluation *e, const camber_node *node, bool all, camber_value *value) {
    bool result = all;
    for (uint32_t i = 0; i < node->count && result == all; i++)
        if (!camber_evaluate_bool(e, node, i, &result))
            return false;
    *value = camber_value_bool(result);
    return true;
}

/* Stops at the first operand that is false. */
bool camber_evaluate_all(camber_evaluation *e, const camber_node *node, camber_value *value) {
    return evaluate_junction(e, node, true, value);
}

/* Stops at the first operand that is true. */
bool camber_evaluate_any(camber_evaluation *e, const camber_node *node, camber_value *value) {
    return evaluate_junction(e, node, false, value);
}

static bool compile_none(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                         uint32_t *node) {
    return camber_compile_uniform(c, row, array, expected, node) &&
           camber_wrap_node(c, camber_evaluate_not, camber_typing_of(CAMBER_TYPE_BOOL), node);
}

/* The result is false if the operand fails, as for comparisons in older filters. */
bool camber_evaluate_quiet(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!camber_evaluate_operand(e, node, 0, value))
        *value = camber_value_bool(false);
    return true;
}

/* ---- Outputs ---- */

bool camber_compile_output(camber_compiler *c, const json_t *array, size_t index, camber_output_type *type) {
    if (!camber_compile_operand(c, array, index, type->type))
        return false;
    if (!type->known)
        *type = (camber_output_type){camber_node_at(c, c->operands[c->operand_count - 1])->type, true};
    return true;
}

bool camber_evaluate_case(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i + 1 < node->count; i += 2) {
        bool condition;
        if (!camber_evaluate_bool(e, node, i, &condition))
            return false;
        if (condition)
            return camber_evaluate_operand(e, node, i + 1, value);
    }
    return camber_evaluate_operand(e, node, node->count - 1, value);
}

static bool compile_case(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                         uint32_t *node) {
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    if (size % 2 != 0)
        return camber_compiler_fail(c, "\"case\" has pairs of condition and output, then one output; add the last one");
    camber_output_type type = camber_expect_outputs(expected);
    for (size_t i = 1; i + 1 < size; i += 2)
        if (!camber_compile_operand(c, array, i, bool_type) || !camber_compile_output(c, array, i + 1, &type))
            return false;
    return camber_compile_output(c, array, size - 1, &type) &&
           camber_make_node(c, &(camber_node){.evaluate = row->evaluate, .type = type.type}, first_operand, node);
}

/* Strings that name images are marked. */
static bool is_there(const camber_evaluation *e, const camber_value *value) {
    if (value->type != CAMBER_VALUE_STRING || !value->boolean || !e->images)
        return value->type != CAMBER_VALUE_NULL;
    return e->images->find(e->images->user, value->string) != 0;
}

/* If all images are missing, the result is the first image. */
bool camber_evaluate_coalesce(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value first = nothing;
    *value = nothing;
    for (uint32_t i = 0; i < node->count; i++) {
        if (!camber_evaluate_operand(e, node, i, value))
            return false;
        if (is_there(e, value))
            return true;
        if (first.type == CAMBER_VALUE_NULL)
            first = *value;
    }
    *value = first;
    return true;
}

static bool compile_coalesce(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                             uint32_t *node) {
    const size_t first_operand = c->operand_count;
    camber_output_type type = camber_expect_outputs(expected);
    bool fits = true;
    for (size_t i = 1; i < json_array_size(array); i++) {
        if (!camber_compile_loose_operand(c, array, i, type.type))
            return false;
        const camber_typing found = camber_node_at(c, c->operands[c->operand_count - 1])->type;
        fits = fits && camber_typing_fits(expected, found);
        if (!type.known)
            type = (camber_output_type){found, true};
    }
    return camber_make_node(c, &(camber_node){.evaluate = row->evaluate, .type = fits ? type.type : any_type},
                            first_operand, node);
}

/* ---- Match ---- */

/* 2^53 - 1: doubles represent all integers up to this one exactly. */
#define LARGEST_LABEL 9007199254740991.0

bool camber_compile_label(camber_compiler *c, const json_t *json, camber_match_label label, camber_type *type) {
    char name[CAMBER_TYPING_TEXT_SIZE];
    const camber_type found = json_is_string(json)   ? CAMBER_TYPE_STRING
                              : json_is_number(json) ? CAMBER_TYPE_NUMBER
                                                     : CAMBER_TYPE_VALUE;
    if (found == CAMBER_TYPE_VALUE)
        return camber_compiler_fail(c, "a label must be a string or a number, found %s; use \"case\" for other tests",
                                    camber_json_name(json));
    if (*type != CAMBER_TYPE_VALUE && *type != found)
        return camber_compiler_fail(c, "expected %s like the labels before, found %s; use labels of one type",
                                    camber_typing_name(camber_typing_of(*type), name), camber_json_name(json));
    *type = found;
    label.string = json_string_value(json);
    if (!label.string) {
        label.number = json_number_value(json);
        if (label.number < floor(label.number) || label.number > floor(label.number) ||
            fabs(label.number) > LARGEST_LABEL)
            return camber_compiler_fail(c, "a label that is a number must be an integer below 2^53; use \"case\"");
    }
    return camber_push_label(c, &label);
}

/* Compiles one label or an array of labels. */
static bool compile_branch(camber_compiler *c, const json_t *json, uint32_t index, camber_type *type) {
    const camber_match_label label = {.output = index / 2, .position = index};
    if (!json_is_array(json))
        return camber_compile_label(c, json, label, type);
    if (json_array_size(json) == 0)
        return camber_compiler_fail(c, "a branch has no label; name one or take the branch out");
    for (size_t i = 0; i < json_array_size(json); i++) {
        camber_compiler_enter_index(c, i);
        if (!camber_compile_label(c, json_array_get(json, i), label, type))
            return false;
        camber_compiler_leave(c);
    }
    return true;
}

/* Labels are contiguous although outputs may contain matches of their own, because all labels are compiled first. */
static bool compile_match(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                          uint32_t *node) {
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    if (size % 2 == 0)
        return camber_compiler_fail(c, "\"match\" has pairs of label and output, then one output; add the last one");
    camber_node prototype = {.evaluate = row->evaluate, .index = (uint32_t)c->expression->label_count};
    camber_type input = CAMBER_TYPE_VALUE;
    camber_output_type type = camber_expect_outputs(expected);
    for (size_t i = 2; i + 1 < size; i += 2) {
        camber_compiler_enter_index(c, i);
        if (!compile_branch(c, json_array_get(array, i), (uint32_t)i, &input))
            return false;
        camber_compiler_leave(c);
    }
    prototype.index_count = (uint32_t)(c->expression->label_count - prototype.index);
    if (!camber_sort_labels(c, prototype.index, true) || !camber_compile_element(c, array, 1, any_type, node))
        return false;
    const camber_typing found = camber_node_at(c, *node)->type;
    if (found.type != CAMBER_TYPE_VALUE && !camber_typing_fits(camber_typing_of(input), found)) {
        char name[CAMBER_TYPING_TEXT_SIZE];
        camber_compiler_enter_index(c, 1);
        return camber_compiler_fail(c, "the labels are of another type than the input, which is %s; convert it",
                                    camber_typing_name(found, name));
    }
    if (!camber_push_operand(c, *node))
        return false;
    for (size_t i = 3; i < size; i += 2)
        if (!camber_compile_output(c, array, i, &type))
            return false;
    if (!camber_compile_output(c, array, size - 1, &type))
        return false;
    prototype.type = type.type;
    return camber_make_node(c, &prototype, first_operand, node);
}

static int compare_label(const camber_value *value, const camber_match_label *label) {
    if (label->string)
        return strcmp(value->string, label->string);
    return value->number < label->number ? -1 : value->number > label->number;
}

/* Returns the node's label that equals the value. NULL: there is none. */
static const camber_match_label *find_label(const camber_expression *expression, const camber_node *node,
                                            const camber_value *value) {
    uint32_t low = 0, high = node->index_count;
    if (high == 0)
        return NULL;
    const camber_match_label *labels = &expression->labels[node->index];
    const bool strings = labels[0].string != NULL;
    if (value->type != (strings ? CAMBER_VALUE_STRING : CAMBER_VALUE_NUMBER) || (!strings && isnan(value->number)))
        return NULL;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const int order = compare_label(value, &labels[middle]);
        if (order == 0)
            return &labels[middle];
        if (order > 0)
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
}

bool camber_evaluate_match(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value input;
    if (!camber_evaluate_operand(e, node, 0, &input))
        return false;
    const camber_match_label *label = find_label(e->expression, node, &input);
    return camber_evaluate_operand(e, node, label ? label->output : node->count - 1, value);
}

bool camber_evaluate_among(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value input;
    if (!camber_evaluate_operand(e, node, 0, &input))
        return false;
    const camber_match_label *label = find_label(e->expression, node, &input);
    if (input.type > CAMBER_VALUE_STRING)
        return camber_evaluate_fail(e, "\"in\" looks for a string, a number, a boolean or null");
    *value = camber_value_bool(label != NULL);
    return true;
}

enum { LESS = CAMBER_OUTCOME_LESS, EQUAL = CAMBER_OUTCOME_EQUAL, GREATER = CAMBER_OUTCOME_GREATER };

static const camber_operator rows[] = {
    {"==", compile_comparison, camber_evaluate_comparison, VALUE, BOOL, 2, 3, .variant = EQUAL},
    {"!=", compile_comparison, camber_evaluate_comparison, VALUE, BOOL, 2, 3, .variant = LESS | GREATER},
    {"<", compile_comparison, camber_evaluate_comparison, VALUE, BOOL, 2, 3, .variant = LESS},
    {"<=", compile_comparison, camber_evaluate_comparison, VALUE, BOOL, 2, 3, .variant = LESS | EQUAL},
    {">", compile_comparison, camber_evaluate_comparison, VALUE, BOOL, 2, 3, .variant = GREATER},
    {">=", compile_comparison, camber_evaluate_comparison, VALUE, BOOL, 2, 3, .variant = GREATER | EQUAL},
    {"collator", compile_collator, camber_evaluate_collator, OBJECT, CAMBER_TYPE_COLLATOR, 1, 1},
    {"!", camber_compile_uniform, camber_evaluate_not, BOOL, BOOL, 1, 1},
    {"all", camber_compile_uniform, camber_evaluate_all, BOOL, BOOL, 0, ANY_COUNT},
    {"any", camber_compile_uniform, camber_evaluate_any, BOOL, BOOL, 0, ANY_COUNT},
    {"none", compile_none, camber_evaluate_any, BOOL, BOOL, 0, ANY_COUNT},
    {"case", compile_case, camber_evaluate_case, VALUE, VALUE, 3, ANY_COUNT},
    {"match", compile_match, camber_evaluate_match, VALUE, VALUE, 4, ANY_COUNT},
    {"coalesce", compile_coalesce, camber_evaluate_coalesce, VALUE, VALUE, 1, ANY_COUNT},
};

const camber_operator_table camber_decision_operators = {rows, sizeof rows / sizeof *rows};
