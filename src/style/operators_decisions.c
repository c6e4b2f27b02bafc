/* Comparisons, decisions and variables. */
#include "style/operators.h"

#include <math.h>

static const camber_typing any = {.type = CAMBER_TYPE_VALUE}, boolean = {.type = CAMBER_TYPE_BOOL};

/* ---- Comparisons ---- */

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

/* Compiles one side, still of any type. */
static bool compile_side(camber_compiler *c, const camber_operator *row, const json_t *array, size_t index,
                         uint32_t *node) {
    const bool order = row->op != CAMBER_OP_EQUAL && row->op != CAMBER_OP_NOT_EQUAL;
    char name[CAMBER_TYPING_TEXT_SIZE];
    if (!camber_compile_element(c, array, index, any, node))
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

bool camber_compile_comparison(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                               uint32_t *node) {
    (void)expected;
    const bool order = row->op != CAMBER_OP_EQUAL && row->op != CAMBER_OP_NOT_EQUAL;
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
    return camber_make_node(c, &(camber_node){.op = row->op, .type = boolean}, first_operand, node);
}

/* {"case-sensitive": boolean, "diacritic-sensitive": boolean, "locale": string}. */
bool camber_compile_collator(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
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
        if (!(flag ? camber_compile(c, flag, boolean, node) : camber_make_constant(c, &no, boolean, node)) ||
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
    return camber_make_node(c, &(camber_node){.op = row->op, .type = camber_typing_of(row->result)}, first_operand,
                            node);
}

/* ---- Decisions ---- */

bool camber_compile_output(camber_compiler *c, const json_t *array, size_t index, camber_output_type *type) {
    if (!camber_compile_operand(c, array, index, type->type))
        return false;
    if (!type->known)
        *type = (camber_output_type){camber_node_at(c, c->operands[c->operand_count - 1])->type, true};
    return true;
}

bool camber_compile_case(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                         uint32_t *node) {
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    if (size % 2 != 0)
        return camber_compiler_fail(c, "\"case\" has pairs of condition and output, then one output; add the last one");
    camber_output_type type = camber_expect_outputs(expected);
    for (size_t i = 1; i + 1 < size; i += 2)
        if (!camber_compile_operand(c, array, i, boolean) || !camber_compile_output(c, array, i + 1, &type))
            return false;
    return camber_compile_output(c, array, size - 1, &type) &&
           camber_make_node(c, &(camber_node){.op = row->op, .type = type.type}, first_operand, node);
}

bool camber_compile_coalesce(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
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
    return camber_make_node(c, &(camber_node){.op = row->op, .type = fits ? type.type : any}, first_operand, node);
}

/* 2^53 - 1, the largest integer to which all below it are doubles. */
#define LARGEST_LABEL 9007199254740991.0

bool camber_compile_label(camber_compiler *c, const json_t *json, camber_label label, camber_type *type) {
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

/* One label or an array of them. */
static bool compile_branch(camber_compiler *c, const json_t *json, uint32_t index, camber_type *type) {
    const camber_label label = {.output = index / 2, .place = index};
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

/* Labels are contiguous though outputs may hold matches of their own: they are compiled first. */
bool camber_compile_match(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                          uint32_t *node) {
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    if (size % 2 == 0)
        return camber_compiler_fail(c, "\"match\" has pairs of label and output, then one output; add the last one");
    camber_node prototype = {.op = row->op, .index = (uint32_t)c->expression->label_count};
    camber_type input = CAMBER_TYPE_VALUE;
    camber_output_type type = camber_expect_outputs(expected);
    for (size_t i = 2; i + 1 < size; i += 2) {
        camber_compiler_enter_index(c, i);
        if (!compile_branch(c, json_array_get(array, i), (uint32_t)i, &input))
            return false;
        camber_compiler_leave(c);
    }
    prototype.index_count = (uint32_t)(c->expression->label_count - prototype.index);
    if (!camber_sort_labels(c, prototype.index, true) || !camber_compile_element(c, array, 1, any, node))
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

/* ---- Variables ---- */

static bool read_name(camber_compiler *c, const json_t *array, size_t index, const char **name) {
    const json_t *json = json_array_get(array, index);
    *name = json_string_value(json);
    bool fits = *name != NULL;
    for (const char *at = *name; fits && *at; at++)
        fits = (*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z') || (*at >= '0' && *at <= '9') || *at == '_';
    if (fits)
        return true;
    camber_compiler_enter_index(c, index);
    return camber_compiler_fail(c, "expected a variable's name, a string of letters, digits and _; rename it");
}

/* ["let", name, value, ..., result]: values do not see the names beside them, so that there are no cycles. */
bool camber_compile_let(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                        uint32_t *node) {
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    size_t bound = 0;
    for (size_t i = 1; i + 1 < size; i += 2) {
        const char *name;
        if (!read_name(c, array, i, &name) || !camber_compile_operand(c, array, i + 1, any))
            return false;
        bound++;
    }
    for (size_t i = 0; i < bound; i++)
        if (!camber_bind(c, json_string_value(json_array_get(array, 1 + 2 * i)), c->operands[first_operand + i]))
            return false;
    if (!camber_compile_operand(c, array, size - 1, expected))
        return false;
    camber_unbind(c, bound);
    const camber_typing type = camber_node_at(c, c->operands[c->operand_count - 1])->type;
    return camber_make_node(c, &(camber_node){.op = row->op, .type = type}, first_operand, node);
}

bool camber_compile_var(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                        uint32_t *node) {
    (void)expected;
    const char *name = json_string_value(json_array_get(array, 1));
    const camber_binding *binding = name ? camber_find_binding(c, name) : NULL;
    if (!binding) {
        camber_compiler_enter_index(c, 1);
        return name ? camber_compiler_fail(c, "no \"let\" around this binds \"%.64s\"; bind it or correct the name",
                                           name)
                    : camber_compiler_fail(c, "expected a variable's name, a string; write it out");
    }
    const camber_node *from = camber_node_at(c, binding->node);
    if (from->op == CAMBER_OP_CONSTANT) {
        const camber_node constant = *from;
        return camber_make_constant(c, &constant.value, constant.type, node);
    }
    const camber_node prototype = {.op = row->op,
                                   .type = from->type,
                                   .reads_zoom = from->reads_zoom,
                                   .reads_feature = from->reads_feature,
                                   .reads_line_progress = from->reads_line_progress,
                                   .height = (uint16_t)(from->height + 1),
                                   .index = binding->slot,
                                   .index_count = binding->node};
    return camber_make_node(c, &prototype, c->operand_count, node);
}
