/* Inputs of an expression: literals, the feature, zoom, the style's state and variables. Also operators of the
 * specification that are not supported.
 *
 * Each operator has a function that compiles it, one that evaluates it, and its row in the table at the end. Reading is
 * cheap: a property with a constant name becomes an index into the style's properties. */
#include "style/evaluation.h"
#include "style/operators.h"

static const camber_typing any_type = {.type = CAMBER_TYPE_VALUE}, string_type = {.type = CAMBER_TYPE_STRING},
                           bool_type = {.type = CAMBER_TYPE_BOOL};

static const camber_value nothing = {.type = CAMBER_VALUE_NULL};

/* ---- Literals ---- */

bool camber_evaluate_constant(camber_evaluation *e, const camber_node *node, camber_value *value) {
    (void)e;
    *value = node->value;
    return true;
}

static bool compile_literal(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                            uint32_t *node) {
    (void)row;
    if (!camber_make_json_constant(c, json_array_get(array, 1), node))
        return false;
    /* An empty array fits any expected item type. */
    camber_typing *type = &camber_node_at(c, *node)->type;
    if (type->type == CAMBER_TYPE_ARRAY && type->lengths[0] == 0 && expected.type == CAMBER_TYPE_ARRAY &&
        (expected.lengths[0] == CAMBER_ANY_LENGTH || expected.lengths[0] == 0))
        *type = expected;
    return true;
}

static bool compile_semiliteral(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                                uint32_t *node) {
    const json_t *list = json_array_get(array, 1);
    if (!json_is_array(list))
        return compile_literal(c, row, array, expected, node);
    const size_t first_operand = c->operand_count, count = json_array_size(list);
    camber_typing item = any_type;
    camber_compiler_enter_index(c, 1);
    for (size_t i = 0; i < count; i++) {
        if (!camber_compile_operand(c, list, i, any_type))
            return false;
        const camber_typing found = camber_node_at(c, c->operands[c->operand_count - 1])->type;
        item = i == 0 ? found : camber_typing_merge(item, found);
    }
    camber_compiler_leave(c);
    return camber_make_node(
        c, &(camber_node){.evaluate = row->evaluate, .type = camber_typing_array(item, (uint32_t)count)}, first_operand,
        node);
}

/* ---- The feature ---- */

static bool fail_feature(camber_evaluation *e) {
    return camber_evaluate_fail(e, "there is no feature to read");
}

bool camber_evaluate_get(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!e->feature)
        return fail_feature(e);
    *value = e->feature->values[node->index];
    return true;
}

bool camber_evaluate_has(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!camber_evaluate_get(e, node, value))
        return false;
    *value = camber_value_bool(value->type != CAMBER_VALUE_NULL || value->boolean);
    return true;
}

/* Looks up a name that is known only during evaluation, in the object that follows it, or in the feature if there is
 * none. */
static bool evaluate_member(camber_evaluation *e, const camber_node *node, const camber_value **found) {
    const char *key;
    camber_value object = nothing;
    if (node->count == 1 && !e->feature)
        return fail_feature(e);
    if (!camber_evaluate_string(e, node, 0, &key))
        return false;
    if (node->count == 1 && e->feature->all)
        object = *e->feature->all;
    if (node->count > 1 && !camber_evaluate_operand(e, node, 1, &object))
        return false;
    if (node->count > 1 && object.type != CAMBER_VALUE_OBJECT)
        return camber_evaluate_fail(e, "expected an object, and the value is not one");
    *found = camber_object_get(&object, key);
    return true;
}

static bool evaluate_get_member(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const camber_value *found = NULL;
    if (!evaluate_member(e, node, &found))
        return false;
    *value = found ? *found : nothing;
    return true;
}

static bool evaluate_has_member(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const camber_value *found = NULL;
    if (!evaluate_member(e, node, &found))
        return false;
    *value = camber_value_bool(found != NULL);
    return true;
}

/* Compiles a member of an object, or a property of the feature whose name is known only during evaluation. */
static bool compile_member(camber_compiler *c, const camber_operator *row, const json_t *array, uint32_t name,
                           uint32_t *node) {
    const size_t first_operand = c->operand_count;
    const bool object = json_array_size(array) == 3;
    if (!camber_push_operand(c, name) ||
        (object && !camber_compile_operand(c, array, 2, camber_typing_of(CAMBER_TYPE_OBJECT))))
        return false;
    c->style->schema.wants_all_properties |= !object;
    const camber_node prototype = {.evaluate =
                                       row->evaluate == camber_evaluate_get ? evaluate_get_member : evaluate_has_member,
                                   .type = camber_typing_of(row->result),
                                   .reads_feature = !object};
    return camber_make_node(c, &prototype, first_operand, node);
}

/* Compiles get, has and !has. */
static bool compile_get(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                        uint32_t *node) {
    (void)expected;
    uint32_t name = 0;
    if (!camber_compile_element(c, array, 1, string_type, &name))
        return false;
    const camber_node *constant = camber_node_at(c, name);
    const bool known = json_array_size(array) == 2 && camber_is_constant(constant);
    if (!(known ? camber_make_property(c, row->evaluate, constant->value.string, node)
                : compile_member(c, row, array, name, node)))
        return false;
    return row->name[0] != '!' || camber_wrap_node(c, camber_evaluate_not, bool_type, node);
}

static bool evaluate_properties(camber_evaluation *e, const camber_node *node, camber_value *value) {
    static const camber_value empty = {.type = CAMBER_VALUE_OBJECT};
    (void)node;
    if (!e->feature)
        return fail_feature(e);
    *value = e->feature->all ? *e->feature->all : empty;
    return true;
}

bool camber_evaluate_id(camber_evaluation *e, const camber_node *node, camber_value *value) {
    (void)node;
    if (!e->feature)
        return fail_feature(e);
    *value = e->feature->id;
    return true;
}

bool camber_evaluate_has_id(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!camber_evaluate_id(e, node, value))
        return false;
    *value = camber_value_bool(value->type != CAMBER_VALUE_NULL);
    return true;
}

bool camber_evaluate_geometry_type(camber_evaluation *e, const camber_node *node, camber_value *value) {
    (void)node;
    if (!e->feature)
        return fail_feature(e);
    *value = e->feature->geometry_type ? camber_value_string(e->feature->geometry_type) : nothing;
    return true;
}

bool camber_evaluate_zoom(camber_evaluation *e, const camber_node *node, camber_value *value) {
    (void)node;
    *value = camber_value_number(e->zoom);
    return true;
}

bool camber_evaluate_line_progress(camber_evaluation *e, const camber_node *node, camber_value *value) {
    (void)node;
    *value = camber_value_number(e->line_progress);
    return true;
}

static bool compile_reader(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                           uint32_t *node) {
    (void)array;
    (void)expected;
    c->style->schema.wants_all_properties |= row->evaluate == evaluate_properties;
    return camber_make_reader(c, row->evaluate, row->result, node);
}

/* ---- The style's state ---- */

/* Works like a constant, but needs a separate function: it must not be folded, because its type counts as unknown until
 * it is evaluated. */
bool camber_evaluate_state(camber_evaluation *e, const camber_node *node, camber_value *value) {
    (void)e;
    *value = node->value;
    return true;
}

/* The state does not change here, but a style that reads it expects that it may, so its type is unknown until
 * evaluation. */
static bool compile_state(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
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
    camber_node prototype = {.evaluate = row->evaluate};
    if (found && (!camber_expression_keep(c, found)))
        return false;
    if (found && !camber_json_to_value(&c->expression->arena, found, &prototype.value))
        return camber_compiler_fail_memory(c);
    return camber_make_node(c, &prototype, c->operand_count, node);
}

/* feature-state is always null, because nothing sets states of features in a picture. */
static bool compile_feature_state(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                                  uint32_t *node) {
    (void)expected;
    const camber_node prototype = {.evaluate = row->evaluate, .reads_feature = true};
    uint32_t name;
    return camber_compile_element(c, array, 1, camber_typing_of(row->operands), &name) &&
           camber_make_node(c, &prototype, c->operand_count, node);
}

/* ---- Variables ---- */

bool camber_evaluate_let(camber_evaluation *e, const camber_node *node, camber_value *value) {
    return camber_evaluate_operand(e, node, node->count - 1, value);
}

/* A variable is evaluated when it is first read, and its value is kept. Otherwise each variable that reads the previous
 * one twice would double the time. */
bool camber_evaluate_var(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const size_t count = e->expression->slot_count;
    if (!e->slots) {
        camber_value *slots = camber_arena_alloc(e->arena, count * sizeof *slots);
        bool *known = slots ? camber_arena_alloc(e->arena, count * sizeof *known) : NULL;
        if (!known)
            return camber_evaluate_no_memory(e);
        memset(known, 0, count * sizeof *known);
        e->slots = slots;
        e->known = known;
    }
    if (!e->known[node->index]) {
        if (!camber_evaluate_node(e, node->index_count, &e->slots[node->index]))
            return false;
        e->known[node->index] = true;
    }
    *value = e->slots[node->index];
    return true;
}

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

/* Compiles ["let", name, value, ..., result]. A value cannot use the names of the same "let", so there are no cycles.
 */
static bool compile_let(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                        uint32_t *node) {
    const size_t size = json_array_size(array), first_operand = c->operand_count;
    size_t bound = 0;
    for (size_t i = 1; i + 1 < size; i += 2) {
        const char *name;
        if (!read_name(c, array, i, &name) || !camber_compile_operand(c, array, i + 1, any_type))
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
    return camber_make_node(c, &(camber_node){.evaluate = row->evaluate, .type = type}, first_operand, node);
}

static bool compile_var(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
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
    if (camber_is_constant(from)) {
        const camber_node constant = *from;
        return camber_make_constant(c, &constant.value, constant.type, node);
    }
    const camber_node prototype = {.evaluate = row->evaluate,
                                   .type = from->type,
                                   .reads_zoom = from->reads_zoom,
                                   .reads_feature = from->reads_feature,
                                   .reads_line_progress = from->reads_line_progress,
                                   .height = (uint16_t)(from->height + 1),
                                   .index = binding->slot,
                                   .index_count = binding->node};
    return camber_make_node(c, &prototype, c->operand_count, node);
}

/* ---- Errors, and operators that are not supported ---- */

/* The message may be in the evaluation's memory, which lives long enough. */
bool camber_evaluate_error(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const char *message;
    (void)value;
    return camber_evaluate_string(e, node, 0, &message) && camber_evaluate_fail(e, message);
}

/* Operators that the specification has, but that are not supported: a layer that uses one is left out. Some of them
 * need a feature's geometry, while layers are evaluated once for all features with the same properties. */
static bool compile_unsupported(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                                uint32_t *node) {
    (void)array;
    (void)expected;
    (void)node;
    camber_compiler_enter_index(c, 0);
    if (!c->readers.kinds && !c->readers.named_kinds)
        return camber_compiler_fail(c, "\"%s\" is not supported; leave it out", row->name);
    if (!c->leaves_out)
        camber_compiler_warn(c, "\"%s\" is not supported, so the layer is left out", row->name);
    c->leaves_out = true;
    c->status = CAMBER_ERROR_INPUT;
    return false;
}

static const camber_operator rows[] = {
    {"literal", compile_literal, camber_evaluate_constant, VALUE, VALUE, 1, 1},
    {"semiliteral", compile_semiliteral, camber_evaluate_list, VALUE, ARRAY, 1, 1},
    {"get", compile_get, camber_evaluate_get, STRING, VALUE, 1, 2},
    {"has", compile_get, camber_evaluate_has, STRING, BOOL, 1, 2},
    {"!has", compile_get, camber_evaluate_has, STRING, BOOL, 1, 2},
    {"properties", compile_reader, evaluate_properties, VALUE, OBJECT, 0, 0},
    {"id", compile_reader, camber_evaluate_id, VALUE, VALUE, 0, 0},
    {"geometry-type", compile_reader, camber_evaluate_geometry_type, VALUE, STRING, 0, 0},
    {"zoom", compile_reader, camber_evaluate_zoom, VALUE, NUMBER, 0, 0},
    {"line-progress", compile_reader, camber_evaluate_line_progress, VALUE, NUMBER, 0, 0},
    {"global-state", compile_state, camber_evaluate_state, STRING, VALUE, 1, 1},
    {"feature-state", compile_feature_state, camber_evaluate_state, STRING, VALUE, 1, 1},
    {"let", compile_let, camber_evaluate_let, VALUE, VALUE, 3, ANY_COUNT},
    {"var", compile_var, camber_evaluate_var, STRING, VALUE, 1, 1},
    {"error", camber_compile_uniform, camber_evaluate_error, STRING, CAMBER_TYPE_ERROR, 1, 1},
    {"within", compile_unsupported, NULL, VALUE, BOOL, 0, ANY_COUNT},
    {"distance", compile_unsupported, NULL, VALUE, NUMBER, 0, ANY_COUNT},
    {"heatmap-density", compile_unsupported, NULL, VALUE, NUMBER, 0, ANY_COUNT},
    {"elevation", compile_unsupported, NULL, VALUE, NUMBER, 0, ANY_COUNT},
    {"accumulated", compile_unsupported, NULL, VALUE, VALUE, 0, ANY_COUNT},
    {"resolved-locale", compile_unsupported, NULL, VALUE, STRING, 0, ANY_COUNT},
};

const camber_operator_table camber_input_operators = {rows, sizeof rows / sizeof *rows};
