#include "style/compiler.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- Where we are, and what is wrong there ---- */

void camber_compiler_enter_key(camber_compiler *c, const char *key) {
    if (c->path_length < CAMBER_PATH_DEPTH)
        c->path[c->path_length] = (camber_path_step){.key = key};
    c->path_length++;
}

void camber_compiler_enter_index(camber_compiler *c, size_t index) {
    if (c->path_length < CAMBER_PATH_DEPTH)
        c->path[c->path_length] = (camber_path_step){.index = index};
    c->path_length++;
}

void camber_compiler_leave(camber_compiler *c) {
    c->path_length--;
}

void camber_compiler_end(camber_compiler *c) {
    camber_free(c->context, c->operands);
    c->operands = NULL;
    c->operand_capacity = 0;
}

void camber_compiler_write_pointer(const camber_compiler *c, char pointer[CAMBER_POINTER_SIZE]) {
    size_t used = 0;
    for (size_t i = 0; i < c->path_length && i < CAMBER_PATH_DEPTH; i++) {
        char number[24];
        snprintf(number, sizeof number, "%zu", c->path[i].index);
        const char *step = c->path[i].key ? c->path[i].key : number;
        if (used + 1 < CAMBER_POINTER_SIZE)
            pointer[used++] = '/';
        for (; *step && used + 3 < CAMBER_POINTER_SIZE; step++) {
            if (*step == '~' || *step == '/') {
                pointer[used++] = '~';
                pointer[used++] = *step == '~' ? '0' : '1';
            } else {
                pointer[used++] = *step;
            }
        }
    }
    pointer[used] = 0;
}

static void say(camber_compiler *c, camber_log_level level, const char *format, va_list list) {
    char pointer[CAMBER_POINTER_SIZE], message[512];
    vsnprintf(message, sizeof message, format, list);
    if (c->report) {
        c->report(c->report_user, c, level, message);
        return;
    }
    camber_compiler_write_pointer(c, pointer);
    camber_log(c->context, level, "%s: %s%s%s", c->name, pointer, pointer[0] ? ": " : "", message);
}

bool camber_compiler_fail(camber_compiler *c, const char *format, ...) {
    va_list list;
    va_start(list, format);
    say(c, CAMBER_LOG_ERROR, format, list);
    va_end(list);
    c->status = CAMBER_ERROR_INPUT;
    return false;
}

void camber_compiler_warn(camber_compiler *c, const char *format, ...) {
    va_list list;
    va_start(list, format);
    say(c, CAMBER_LOG_WARNING, format, list);
    va_end(list);
}

/* camber_grow has told the log. */
static bool fail_memory(camber_compiler *c) {
    c->status = CAMBER_ERROR_MEMORY;
    return false;
}

const char *camber_type_name(camber_type type) {
    switch (type) {
    case CAMBER_TYPE_VALUE: return "any value";
    case CAMBER_TYPE_NULL: return "null";
    case CAMBER_TYPE_BOOL: return "a boolean";
    case CAMBER_TYPE_NUMBER: return "a number";
    case CAMBER_TYPE_STRING: return "a string";
    case CAMBER_TYPE_COLOR: return "a colour";
    case CAMBER_TYPE_ARRAY: return "an array";
    case CAMBER_TYPE_OBJECT: return "an object";
    case CAMBER_TYPE_IMAGE: return "an image";
    }
    return "nothing";
}

/* ---- Nodes ---- */

camber_node *camber_node_at(camber_compiler *c, uint32_t node) {
    return &c->expression->nodes[node];
}

static bool grow(camber_compiler *c, void *items, size_t *capacity, size_t count, size_t size_bytes) {
    if (count >= UINT32_MAX - 1)
        return camber_compiler_fail(c, "the expression has more than 2^32 parts; make it shorter");
    return camber_grow(c->context, items, capacity, count + 1, size_bytes) || fail_memory(c);
}

bool camber_push_operand(camber_compiler *c, uint32_t node) {
    if (!grow(c, &c->operands, &c->operand_capacity, c->operand_count, sizeof *c->operands))
        return false;
    c->operands[c->operand_count++] = node;
    return true;
}

bool camber_push_stop(camber_compiler *c, double stop) {
    camber_expression *e = c->expression;
    if (!grow(c, &e->stops, &e->stop_capacity, e->stop_count, sizeof *e->stops))
        return false;
    e->stops[e->stop_count++] = stop;
    return true;
}

bool camber_push_label(camber_compiler *c, const camber_label *label) {
    camber_expression *e = c->expression;
    if (!grow(c, &e->labels, &e->label_capacity, e->label_count, sizeof *e->labels))
        return false;
    e->labels[e->label_count++] = *label;
    return true;
}

bool camber_make_node(camber_compiler *c, const camber_node *prototype, size_t first_operand, uint32_t *node) {
    camber_expression *e = c->expression;
    const size_t count = c->operand_count - first_operand;
    if (!grow(c, &e->nodes, &e->node_capacity, e->node_count, sizeof *e->nodes) ||
        !grow(c, &e->links, &e->link_capacity, e->link_count + count, sizeof *e->links))
        return false;
    camber_node made = *prototype;
    made.first = (uint32_t)e->link_count;
    made.count = (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        const uint32_t operand = c->operands[first_operand + i];
        e->links[e->link_count++] = operand;
        made.reads_zoom |= e->nodes[operand].reads_zoom;
        made.reads_feature |= e->nodes[operand].reads_feature;
    }
    c->operand_count = first_operand;
    *node = (uint32_t)e->node_count;
    e->nodes[e->node_count++] = made;
    return true;
}

static camber_type type_of(const camber_value *value) {
    switch (value->type) {
    case CAMBER_VALUE_NULL: return CAMBER_TYPE_NULL;
    case CAMBER_VALUE_BOOL: return CAMBER_TYPE_BOOL;
    case CAMBER_VALUE_NUMBER: return CAMBER_TYPE_NUMBER;
    case CAMBER_VALUE_STRING: return CAMBER_TYPE_STRING;
    case CAMBER_VALUE_COLOR: return CAMBER_TYPE_COLOR;
    case CAMBER_VALUE_ARRAY: return CAMBER_TYPE_ARRAY;
    case CAMBER_VALUE_OBJECT: return CAMBER_TYPE_OBJECT;
    }
    return CAMBER_TYPE_NULL;
}

bool camber_make_constant(camber_compiler *c, const camber_value *value, uint32_t *node) {
    return camber_make_node(c, &(camber_node){.op = CAMBER_OP_CONSTANT, .type = type_of(value), .value = *value},
                            c->operand_count, node);
}

bool camber_make_json_constant(camber_compiler *c, const json_t *json, uint32_t *node) {
    camber_value value = {.type = CAMBER_VALUE_NULL};
    if (json_is_boolean(json))
        value = (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = json_is_true(json)};
    else if (json_is_number(json))
        value = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = json_number_value(json)};
    else if (json_is_string(json))
        value = (camber_value){.type = CAMBER_VALUE_STRING, .string = json_string_value(json)};
    else if (!json_is_null(json))
        return camber_compiler_fail(c, "expected a string, number, boolean or null, found %s; take it out",
                                    camber_json_name(json));
    return camber_make_constant(c, &value, node);
}

bool camber_make_property(camber_compiler *c, camber_op op, const char *name, uint32_t *node) {
    camber_style *style = c->style;
    size_t index = 0;
    while (index < style->property_count && strcmp(style->properties[index], name) != 0)
        index++;
    if (index == style->property_count) {
        if (index >= CAMBER_PROPERTY_LIMIT)
            return camber_compiler_fail(c, "more than %d feature properties are read; use fewer",
                                        CAMBER_PROPERTY_LIMIT);
        /* The limit is small, so the array has its full size from the beginning and needs no capacity. */
        if (!style->properties)
            style->properties = camber_alloc(c->context, CAMBER_PROPERTY_LIMIT, sizeof *style->properties);
        char *copy = style->properties ? camber_copy_string(c->context, name) : NULL;
        if (!copy)
            return fail_memory(c);
        style->properties[style->property_count++] = copy;
    }
    return camber_make_node(c,
                            &(camber_node){.op = op,
                                           .type = op == CAMBER_OP_HAS ? CAMBER_TYPE_BOOL : CAMBER_TYPE_VALUE,
                                           .index = (uint32_t)index,
                                           .reads_feature = true},
                            c->operand_count, node);
}

/* ---- Types ---- */

static bool wrap(camber_compiler *c, const camber_node *prototype, uint32_t *node) {
    const size_t first_operand = c->operand_count;
    return camber_push_operand(c, *node) && camber_make_node(c, prototype, first_operand, node);
}

bool camber_make_to_string(camber_compiler *c, uint32_t *node) {
    camber_node prototype = {.op = CAMBER_OP_TO_STRING, .type = CAMBER_TYPE_STRING};
    if (c->expression->scratch_count == CAMBER_SCRATCH_COUNT)
        return camber_compiler_fail(c, "more than %d conversions to strings in one expression; use fewer",
                                    CAMBER_SCRATCH_COUNT);
    prototype.index = c->expression->scratch_count++;
    return wrap(c, &prototype, node);
}

bool camber_annotate(camber_compiler *c, camber_type expected, camber_annotation annotation, uint32_t *node) {
    const camber_type actual = camber_node_at(c, *node)->type;
    const bool omit = annotation == CAMBER_ANNOTATE_OMIT;
    if (expected == CAMBER_TYPE_VALUE || actual == expected)
        return true;
    const bool scalar =
        expected == CAMBER_TYPE_NUMBER || expected == CAMBER_TYPE_STRING || expected == CAMBER_TYPE_BOOL;
    if (scalar && actual == CAMBER_TYPE_VALUE) {
        if (omit)
            return true;
        if (annotation == CAMBER_ANNOTATE_COERCE && expected == CAMBER_TYPE_STRING)
            return camber_make_to_string(c, node);
        return wrap(c, &(camber_node){.op = CAMBER_OP_ASSERT, .type = expected}, node);
    }
    if (expected == CAMBER_TYPE_COLOR && (actual == CAMBER_TYPE_VALUE || actual == CAMBER_TYPE_STRING))
        return omit || wrap(c, &(camber_node){.op = CAMBER_OP_TO_COLOR, .type = expected}, node);
    return camber_compiler_fail(c, "expected %s, found %s; change the value or convert it", camber_type_name(expected),
                                camber_type_name(actual));
}

/* ---- Folding ---- */

typedef struct mark {
    size_t nodes, links, stops, labels;
    uint32_t scratch;
} mark;

static mark set_mark(const camber_expression *e) {
    return (mark){e->node_count, e->link_count, e->stop_count, e->label_count, e->scratch_count};
}

static bool is_foldable(const camber_expression *e, const camber_node *node) {
    switch (node->op) {
    case CAMBER_OP_CONSTANT:
    case CAMBER_OP_ARRAY:
    case CAMBER_OP_GET:
    case CAMBER_OP_HAS:
    case CAMBER_OP_ZOOM:
    case CAMBER_OP_GEOMETRY_TYPE: return false;
    default: break;
    }
    for (uint32_t i = 0; i < node->count; i++) {
        const camber_op op = e->nodes[e->links[node->first + i]].op;
        if (op != CAMBER_OP_CONSTANT && op != CAMBER_OP_ARRAY)
            return false;
    }
    return true;
}

/* The text of a folded constant must outlive the evaluation that made it. */
static bool keep_text(camber_compiler *c, camber_value *value) {
    camber_expression *e = c->expression;
    if (!grow(c, &e->texts, &e->text_capacity, e->text_count, sizeof *e->texts))
        return false;
    char *copy = camber_copy_string(c->context, value->string);
    if (!copy)
        return fail_memory(c);
    e->texts[e->text_count++] = copy;
    value->string = copy;
    return true;
}

/* Replaces a node all of whose operands are constants by its value, and drops what was made since the mark. */
static bool fold(camber_compiler *c, mark before, uint32_t *node) {
    camber_expression *e = c->expression;
    if (!is_foldable(e, &e->nodes[*node]))
        return true;
    camber_evaluation evaluation = {.zoom = 0.0};
    camber_value value;
    const bool makes_text = e->nodes[*node].op == CAMBER_OP_TO_STRING;
    const camber_type type = e->nodes[*node].type;
    if (!camber_expression_evaluate_node(e, *node, &evaluation, &value))
        return camber_compiler_fail(c, "cannot be evaluated: %s; correct the value", evaluation.cause);
    if (makes_text && !keep_text(c, &value))
        return false;
    e->node_count = before.nodes;
    e->link_count = before.links;
    e->stop_count = before.stops;
    e->label_count = before.labels;
    e->scratch_count = before.scratch;
    if (!camber_make_constant(c, &value, node))
        return false;
    /* Branches of several types have no one type, whichever of them was taken. */
    if (type == CAMBER_TYPE_VALUE && value.type != CAMBER_VALUE_NULL)
        e->nodes[*node].type = type_of(&value);
    return true;
}

/* ---- Compilation ---- */

static bool compile_as(camber_compiler *c, json_t *json, camber_type expected, camber_annotation annotation,
                       uint32_t *node) {
    if (c->depth >= CAMBER_EXPRESSION_DEPTH)
        return camber_compiler_fail(c, "nested deeper than %d levels; flatten the expression", CAMBER_EXPRESSION_DEPTH);
    const mark before = set_mark(c->expression);
    c->depth++;
    bool done;
    if (json_is_array(json))
        done = camber_compile_operator(c, json, expected, node);
    else if (json_is_object(json))
        done = camber_compiler_fail(c, "an object is not an expression; write a constant or an array [operator, ...]");
    else
        done = camber_make_json_constant(c, json, node);
    /* Folded before annotation too, so that the types of constants are known. */
    done = done && fold(c, before, node) && camber_annotate(c, expected, annotation, node) && fold(c, before, node);
    c->depth--;
    return done;
}

bool camber_compile(camber_compiler *c, json_t *json, camber_type expected, uint32_t *node) {
    return compile_as(c, json, expected, CAMBER_ANNOTATE_ASSERT, node);
}

bool camber_compile_element(camber_compiler *c, const json_t *array, size_t index, camber_type expected,
                            uint32_t *node) {
    camber_compiler_enter_index(c, index);
    if (!camber_compile(c, json_array_get(array, index), expected, node))
        return false;
    camber_compiler_leave(c);
    return true;
}

bool camber_compile_loose_element(camber_compiler *c, const json_t *array, size_t index, camber_type expected,
                                  uint32_t *node) {
    camber_compiler_enter_index(c, index);
    if (!compile_as(c, json_array_get(array, index), expected, CAMBER_ANNOTATE_OMIT, node))
        return false;
    camber_compiler_leave(c);
    return true;
}

bool camber_expression_begin(camber_compiler *c, json_t *json) {
    c->expression = camber_alloc_zero(c->context, 1, sizeof *c->expression);
    if (!c->expression)
        return fail_memory(c);
    c->expression->document = json_incref(json);
    c->depth = 0;
    c->operand_count = 0;
    return true;
}

bool camber_expression_end(camber_compiler *c, bool done, uint32_t root, camber_expression **expression) {
    if (done) {
        c->expression->root = root;
        c->expression->reads_zoom = c->expression->nodes[root].reads_zoom;
        c->expression->reads_feature = c->expression->nodes[root].reads_feature;
        *expression = c->expression;
    } else {
        camber_expression_destroy(c->context, c->expression);
    }
    c->expression = NULL;
    return done;
}

/* The specification: zoom is read by one step or interpolate at the top, or in a coalesce there. */
static bool zoom_is_at_top(const camber_expression *e, uint32_t index) {
    const camber_node *node = &e->nodes[index];
    uint32_t readers = 0;
    for (uint32_t i = 0; i < node->count; i++)
        readers += e->nodes[e->links[node->first + i]].reads_zoom;
    if (readers != 1)
        return readers == 0 && node->op != CAMBER_OP_ZOOM;
    if (node->op == CAMBER_OP_STEP || node->op == CAMBER_OP_INTERPOLATE)
        return e->nodes[e->links[node->first]].op == CAMBER_OP_ZOOM;
    if (node->op != CAMBER_OP_COALESCE)
        return false;
    uint32_t i = 0;
    while (!e->nodes[e->links[node->first + i]].reads_zoom)
        i++;
    return zoom_is_at_top(e, e->links[node->first + i]);
}

static bool check_property(camber_compiler *c, const camber_property *property, uint32_t root) {
    const camber_node *node = camber_node_at(c, root);
    if (!zoom_is_at_top(c->expression, root))
        return camber_compiler_fail(c, "\"zoom\" may only be the input of one \"step\" or \"interpolate\" at the top; "
                                       "move that curve outwards");
    if (node->reads_feature && !property->data_driven)
        return camber_compiler_fail(c, "%s cannot depend on features; use a constant or zoom", property->name);
    if (node->op != CAMBER_OP_CONSTANT || property->type != CAMBER_TYPE_NUMBER)
        return true;
    const double number = node->value.number;
    if ((property->low < 0.0 || property->high > 0.0) && !(number >= property->low && number <= property->high))
        return camber_compiler_fail(c, "%g is out of range; use %g to %g", number, property->low, property->high);
    return true;
}

static bool compile_property(camber_compiler *c, json_t *json, const camber_property *property, uint32_t *root) {
    if (json_is_object(json))
        return camber_compile_function(c, json, property, root) && check_property(c, property, *root);
    const bool fits = json_is_array(json) || (property->type == CAMBER_TYPE_NUMBER ? json_is_number(json)
                                              : property->type == CAMBER_TYPE_BOOL ? json_is_boolean(json)
                                                                                   : json_is_string(json));
    if (!fits)
        return camber_compiler_fail(c, "expected %s or an expression, found %s; write e.g. %s",
                                    camber_type_name(property->type), camber_json_name(json),
                                    property->type == CAMBER_TYPE_NUMBER  ? "2"
                                    : property->type == CAMBER_TYPE_COLOR ? "\"#a0c4ff\""
                                                                          : "\"round\"");
    const camber_annotation annotation =
        property->type == CAMBER_TYPE_STRING ? CAMBER_ANNOTATE_COERCE : CAMBER_ANNOTATE_ASSERT;
    return compile_as(c, json, property->type, annotation, root) && check_property(c, property, *root);
}

bool camber_compile_property(camber_compiler *c, json_t *json, const camber_property *property,
                             camber_expression **expression) {
    uint32_t root = 0;
    if (!camber_expression_begin(c, json))
        return false;
    const bool done = compile_property(c, json, property, &root);
    return camber_expression_end(c, done, root, expression);
}
