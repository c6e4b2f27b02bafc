/* Operators on features, arrays, objects and strings. */
#include "style/operators.h"

#include <math.h>

static const camber_typing any = {.type = CAMBER_TYPE_VALUE}, number = {.type = CAMBER_TYPE_NUMBER},
                           string = {.type = CAMBER_TYPE_STRING}, boolean = {.type = CAMBER_TYPE_BOOL};

bool camber_compile_reader(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                           uint32_t *node) {
    (void)array;
    (void)expected;
    return camber_make_reader(c, row->op, row->result, node);
}

/* Of an object, or of a feature by a name that is known only when evaluated. */
static bool compile_member(camber_compiler *c, const camber_operator *row, const json_t *array, uint32_t name,
                           uint32_t *node) {
    const size_t first_operand = c->operand_count;
    const bool get = row->op == CAMBER_OP_GET, object = json_array_size(array) == 3;
    const camber_op op = object ? (get ? CAMBER_OP_GET_MEMBER : CAMBER_OP_HAS_MEMBER)
                                : (get ? CAMBER_OP_GET_NAMED : CAMBER_OP_HAS_NAMED);
    if (!camber_push_operand(c, name) ||
        (object && !camber_compile_operand(c, array, 2, camber_typing_of(CAMBER_TYPE_OBJECT))))
        return false;
    c->style->wants_all_properties |= !object;
    const camber_node prototype = {.op = op, .type = camber_typing_of(row->result), .reads_feature = !object};
    return camber_make_node(c, &prototype, first_operand, node);
}

/* get, has and !has. */
bool camber_compile_get(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                        uint32_t *node) {
    (void)expected;
    uint32_t name = 0;
    if (!camber_compile_element(c, array, 1, string, &name))
        return false;
    const camber_node *constant = camber_node_at(c, name);
    const bool known = json_array_size(array) == 2 && constant->op == CAMBER_OP_CONSTANT;
    if (!(known ? camber_make_property(c, row->op, constant->value.string, node)
                : compile_member(c, row, array, name, node)))
        return false;
    return row->name[0] != '!' || camber_wrap_node(c, CAMBER_OP_NOT, boolean, node);
}

/* The state does not change, but a style that reads it is written as if it did: its type is known when evaluated. */
bool camber_compile_state(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                          uint32_t *node) {
    (void)expected;
    const char *name = json_string_value(json_array_get(array, 1));
    if (!name) {
        camber_compiler_enter_index(c, 1);
        return camber_compiler_fail(c, "expected the name of a property of the state, a string; write it out");
    }
    json_t *found = json_object_get(c->state, name);
    if (c->state_defaults)
        found = json_object_get(found, "default");
    camber_node prototype = {.op = row->op};
    if (found && (!camber_expression_keep(c, found)))
        return false;
    if (found && !camber_json_to_value(&c->expression->arena, found, &prototype.value))
        return camber_compiler_fail_memory(c);
    return camber_make_node(c, &prototype, c->operand_count, node);
}

bool camber_compile_literal(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                            uint32_t *node) {
    (void)row;
    if (!camber_make_json_constant(c, json_array_get(array, 1), node))
        return false;
    /* An empty array is one of whatever items are wanted. */
    camber_typing *type = &camber_node_at(c, *node)->type;
    if (type->type == CAMBER_TYPE_ARRAY && type->lengths[0] == 0 && expected.type == CAMBER_TYPE_ARRAY &&
        (expected.lengths[0] == CAMBER_ANY_LENGTH || expected.lengths[0] == 0))
        *type = expected;
    return true;
}

bool camber_compile_semiliteral(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                                uint32_t *node) {
    const json_t *list = json_array_get(array, 1);
    if (!json_is_array(list))
        return camber_compile_literal(c, row, array, expected, node);
    const size_t first_operand = c->operand_count, count = json_array_size(list);
    camber_typing item = any;
    camber_compiler_enter_index(c, 1);
    for (size_t i = 0; i < count; i++) {
        if (!camber_compile_operand(c, list, i, any))
            return false;
        const camber_typing found = camber_node_at(c, c->operands[c->operand_count - 1])->type;
        item = i == 0 ? found : camber_typing_merge(item, found);
    }
    camber_compiler_leave(c);
    return camber_make_node(c, &(camber_node){.op = row->op, .type = camber_typing_array(item, (uint32_t)count)},
                            first_operand, node);
}

/* ---- Arrays ---- */

static bool read_item_type(camber_compiler *c, const json_t *array, camber_typing *item) {
    const char *name = json_string_value(json_array_get(array, 1));
    *item = name && strcmp(name, "number") == 0    ? number
            : name && strcmp(name, "string") == 0  ? string
            : name && strcmp(name, "boolean") == 0 ? boolean
                                                   : any;
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

/* ["array", value], ["array", type, value] or ["array", type, length, value, ...]. */
bool camber_compile_array(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                          uint32_t *node) {
    (void)expected;
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    camber_typing item = any;
    uint32_t length = CAMBER_ANY_LENGTH;
    if (size > 2 && !read_item_type(c, array, &item))
        return false;
    if (size > 3 && !read_length(c, array, &length))
        return false;
    for (size_t i = size > 3 ? 3 : size - 1; i < size; i++)
        if (!camber_compile_operand(c, array, i, any))
            return false;
    return camber_make_node(c, &(camber_node){.op = row->op, .type = camber_typing_array(item, length)}, first_operand,
                            node);
}

bool camber_compile_at(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                       uint32_t *node) {
    const size_t first_operand = c->operand_count;
    if (!camber_compile_operand(c, array, 1, number) ||
        !camber_compile_element(c, array, 2, camber_typing_array(expected, CAMBER_ANY_LENGTH), node) ||
        !camber_push_operand(c, *node))
        return false;
    const camber_typing type = camber_typing_item(camber_node_at(c, *node)->type);
    return camber_make_node(c, &(camber_node){.op = row->op, .type = type}, first_operand, node);
}

static bool is_needle(camber_type type) {
    return type == CAMBER_TYPE_VALUE || type == CAMBER_TYPE_NULL || type == CAMBER_TYPE_BOOL ||
           type == CAMBER_TYPE_NUMBER || type == CAMBER_TYPE_STRING;
}

enum { SORTED_FROM = 8 };

/* Whether the node is a constant array of strings, or of numbers, that is worth sorting. */
static bool is_list(const camber_node *node) {
    const camber_value *list = &node->value;
    if (node->op != CAMBER_OP_CONSTANT || list->type != CAMBER_VALUE_ARRAY || list->count < SORTED_FROM)
        return false;
    for (uint32_t i = 0; i < list->count; i++)
        if (list->items[i].type != list->items[0].type)
            return false;
    return list->items[0].type == CAMBER_VALUE_STRING || list->items[0].type == CAMBER_VALUE_NUMBER;
}

/* A look into a long list of constants becomes a search among labels. */
static bool make_among(camber_compiler *c, size_t first_operand, uint32_t *node) {
    const camber_value list = camber_node_at(c, c->operands[c->operand_count - 1])->value;
    const size_t first = c->expression->label_count;
    for (uint32_t i = 0; i < list.count; i++) {
        const camber_value *item = &list.items[i];
        const bool text = item->type == CAMBER_VALUE_STRING;
        const camber_label label = {.string = text ? item->string : NULL, .number = text ? 0.0 : item->number};
        if (!camber_push_label(c, &label))
            return false;
    }
    c->operand_count--;
    const camber_node prototype = {
        .op = CAMBER_OP_AMONG, .type = boolean, .index = (uint32_t)first, .index_count = list.count};
    return camber_sort_labels(c, first, false) && camber_make_node(c, &prototype, first_operand, node);
}

/* in, !in and index-of. */
bool camber_compile_in(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                       uint32_t *node) {
    (void)expected;
    char found[CAMBER_TYPING_TEXT_SIZE];
    const size_t first_operand = c->operand_count;
    if (!camber_compile_operand(c, array, 1, any) || !camber_compile_element(c, array, 2, any, node) ||
        !camber_push_operand(c, *node))
        return false;
    const camber_typing needle = camber_node_at(c, c->operands[first_operand])->type;
    if (!is_needle(needle.type))
        return camber_compiler_fail(c,
                                    "\"%s\" looks for a string, a number, a boolean or null, found %s; write e.g. "
                                    "[\"in\", [\"get\", \"kind\"], [\"literal\", [\"a\", \"b\"]]]",
                                    row->name, camber_typing_name(needle, found));
    if (json_array_size(array) == 4 && !camber_compile_operand(c, array, 3, number))
        return false;
    const bool list = row->op == CAMBER_OP_IN && is_list(camber_node_at(c, *node));
    const camber_node prototype = {.op = row->op, .type = camber_typing_of(row->result)};
    if (!(list ? make_among(c, first_operand, node) : camber_make_node(c, &prototype, first_operand, node)))
        return false;
    return row->name[0] != '!' || camber_wrap_node(c, CAMBER_OP_NOT, boolean, node);
}

static bool fail_sequence(camber_compiler *c, const camber_operator *row, camber_typing found) {
    char name[CAMBER_TYPING_TEXT_SIZE];
    return camber_compiler_fail(c, "\"%s\" takes a string or an array, found %s; convert it", row->name,
                                camber_typing_name(found, name));
}

static bool is_sequence(camber_type type) {
    return type == CAMBER_TYPE_VALUE || type == CAMBER_TYPE_STRING || type == CAMBER_TYPE_ARRAY;
}

bool camber_compile_slice(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                          uint32_t *node) {
    (void)expected;
    const size_t first_operand = c->operand_count;
    if (!camber_compile_element(c, array, 1, any, node) || !camber_push_operand(c, *node))
        return false;
    camber_typing type = camber_node_at(c, *node)->type;
    for (size_t i = 2; i < json_array_size(array); i++)
        if (!camber_compile_operand(c, array, i, number))
            return false;
    return is_sequence(type.type)
               ? camber_make_node(c, &(camber_node){.op = row->op, .type = type}, first_operand, node)
               : fail_sequence(c, row, type);
}

bool camber_compile_length(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                           uint32_t *node) {
    (void)expected;
    if (!camber_compile_element(c, array, 1, any, node))
        return false;
    const camber_typing type = camber_node_at(c, *node)->type;
    return is_sequence(type.type) ? camber_wrap_node(c, row->op, number, node) : fail_sequence(c, row, type);
}

bool camber_compile_split(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                          uint32_t *node) {
    (void)expected;
    const size_t first_operand = c->operand_count;
    const camber_node prototype = {.op = row->op, .type = camber_typing_array(string, CAMBER_ANY_LENGTH)};
    return camber_compile_operand(c, array, 1, string) && camber_compile_operand(c, array, 2, string) &&
           camber_make_node(c, &prototype, first_operand, node);
}

bool camber_compile_join(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                         uint32_t *node) {
    (void)expected;
    const size_t first_operand = c->operand_count;
    return camber_compile_operand(c, array, 1, camber_typing_array(string, CAMBER_ANY_LENGTH)) &&
           camber_compile_operand(c, array, 2, string) &&
           camber_make_node(c, &(camber_node){.op = row->op, .type = string}, first_operand, node);
}
