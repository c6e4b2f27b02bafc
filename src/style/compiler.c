/* The compiler of expressions: tracks the position in the document, reports errors, makes typed nodes, and folds
 * constants.
 *
 * Input: JSON. Output: camber_expression. Operands are compiled first and wait on a stack; an operator takes its
 * operands from there. An operator whose operands are all constants is evaluated immediately and becomes a constant. */
#include "style/compiler.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- The position in the document, and errors there ---- */

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
    camber_free(c->context, c->bindings);
    camber_free(c->context, c->binding_heads);
    camber_free(c->context, c->property_slots);
    c->operands = c->binding_heads = c->property_slots = NULL;
    c->bindings = NULL;
    c->operand_capacity = c->binding_capacity = 0;
}

static void report(camber_compiler *c, camber_log_level level, const char *format, va_list list) {
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
    report(c, CAMBER_LOG_ERROR, format, list);
    va_end(list);
    c->status = CAMBER_ERROR_INPUT;
    return false;
}

void camber_compiler_warn(camber_compiler *c, const char *format, ...) {
    va_list list;
    va_start(list, format);
    report(c, CAMBER_LOG_WARNING, format, list);
    va_end(list);
}

/* Only sets the status, because camber_alloc has already logged the message. */
static bool fail_memory(camber_compiler *c) {
    c->status = CAMBER_ERROR_MEMORY;
    return false;
}

bool camber_compiler_fail_memory(camber_compiler *c) {
    c->status =
        camber_fail(c->context, CAMBER_ERROR_MEMORY, "%s: out of memory; make the expressions shorter", c->name);
    return false;
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

bool camber_push_label(camber_compiler *c, const camber_match_label *label) {
    camber_expression *e = c->expression;
    if (!grow(c, &e->labels, &e->label_capacity, e->label_count, sizeof *e->labels))
        return false;
    e->labels[e->label_count++] = *label;
    return true;
}

static int compare_labels(const void *left, const void *right) {
    const camber_match_label *a = left, *b = right;
    if (a->string)
        return strcmp(a->string, b->string);
    return a->number < b->number ? -1 : a->number > b->number;
}

bool camber_sort_labels(camber_compiler *c, size_t first, bool unique) {
    const size_t count = c->expression->label_count - first;
    if (count < 2)
        return true;
    camber_match_label *labels = &c->expression->labels[first];
    qsort(labels, count, sizeof *labels, compare_labels);
    for (size_t i = 1; i < count && unique; i++) {
        const camber_match_label *one = &labels[i - 1], *other = &labels[i];
        if (compare_labels(one, other) != 0)
            continue;
        camber_compiler_enter_index(c, one->position > other->position ? one->position : other->position);
        return one->string ? camber_compiler_fail(c, "the label \"%.64s\" occurs twice; take one out", one->string)
                           : camber_compiler_fail(c, "the label %.17g occurs twice; take one out", one->number);
    }
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
        const camber_node *from = &e->nodes[operand];
        e->links[e->link_count++] = operand;
        made.reads_zoom |= from->reads_zoom;
        made.reads_feature |= from->reads_feature;
        made.reads_line_progress |= from->reads_line_progress;
        if (from->height >= made.height)
            made.height = (uint16_t)(from->height + 1);
    }
    c->operand_count = first_operand;
    if (made.height > CAMBER_NODE_HEIGHT)
        return camber_compiler_fail(c, "variables refer to each other more than %d levels deep; nest fewer of them",
                                    CAMBER_NODE_HEIGHT);
    *node = (uint32_t)e->node_count;
    e->nodes[e->node_count++] = made;
    return true;
}

bool camber_wrap_node(camber_compiler *c, camber_evaluate_fn *evaluate, camber_typing type, uint32_t *node) {
    const size_t first_operand = c->operand_count;
    return camber_push_operand(c, *node) &&
           camber_make_node(c, &(camber_node){.evaluate = evaluate, .type = type}, first_operand, node);
}

bool camber_make_constant(camber_compiler *c, const camber_value *value, camber_typing type, uint32_t *node) {
    return camber_make_node(c, &(camber_node){.evaluate = camber_evaluate_constant, .type = type, .value = *value},
                            c->operand_count, node);
}

bool camber_make_json_constant(camber_compiler *c, const json_t *json, uint32_t *node) {
    camber_value value;
    if (!camber_json_to_value(&c->expression->arena, json, &value))
        return camber_compiler_fail_memory(c);
    return camber_make_constant(c, &value, camber_typing_of_value(&value), node);
}

bool camber_make_reader(camber_compiler *c, camber_evaluate_fn *evaluate, camber_type type, uint32_t *node) {
    const bool zoom = evaluate == camber_evaluate_zoom, progress = evaluate == camber_evaluate_line_progress;
    const camber_node prototype = {.evaluate = evaluate,
                                   .type = camber_typing_of(type),
                                   .reads_zoom = zoom,
                                   .reads_line_progress = progress,
                                   .reads_feature = !zoom && !progress};
    c->style->schema.wants_id |= evaluate == camber_evaluate_id || evaluate == camber_evaluate_has_id;
    return camber_make_node(c, &prototype, c->operand_count, node);
}

/* ---- Properties of features ---- */

/* Four slots per property keep probes short. */
enum { PROPERTY_SLOTS = 4 * CAMBER_PROPERTY_LIMIT };

static size_t property_slot(const camber_compiler *c, const char *name) {
    const uint64_t hash = camber_hash(CAMBER_HASH_START, name, strlen(name));
    size_t slot = (size_t)(hash ^ hash >> 32) % PROPERTY_SLOTS;
    while (c->property_slots[slot] && strcmp(c->style->schema.properties[c->property_slots[slot] - 1], name) != 0)
        slot = (slot + 1) % PROPERTY_SLOTS;
    return slot;
}

/* The style may already have properties from an earlier compiler. */
static bool hash_properties(camber_compiler *c) {
    if (c->property_slots)
        return true;
    c->property_slots = camber_alloc_zero(c->context, PROPERTY_SLOTS, sizeof *c->property_slots);
    if (!c->property_slots)
        return fail_memory(c);
    for (size_t i = 0; i < c->style->schema.property_count; i++)
        c->property_slots[property_slot(c, c->style->schema.properties[i])] = (uint32_t)i + 1;
    return true;
}

/* Adds the current layer to the readers of a property. */
static bool add_readers(camber_compiler *c, uint32_t property) {
    camber_schema *schema = &c->style->schema;
    if (!c->readers.kinds && !c->readers.named_kinds)
        return true;
    if (!schema->property_readers)
        schema->property_readers =
            camber_alloc_zero(c->context, CAMBER_PROPERTY_LIMIT, sizeof *schema->property_readers);
    if (!schema->property_readers)
        return false;
    schema->property_readers[property].kinds |= c->readers.kinds;
    schema->property_readers[property].named_kinds |= c->readers.named_kinds;
    return true;
}

bool camber_make_property(camber_compiler *c, camber_evaluate_fn *evaluate, const char *name, uint32_t *node) {
    camber_style *style = c->style;
    if (!hash_properties(c))
        return false;
    const size_t slot = property_slot(c, name);
    if (!c->property_slots[slot]) {
        if (style->schema.property_count >= CAMBER_PROPERTY_LIMIT)
            return camber_compiler_fail(c, "more than %d feature properties are read; use fewer",
                                        CAMBER_PROPERTY_LIMIT);
        /* The limit is small, so the array gets its full size at once and needs no capacity. */
        if (!style->schema.properties)
            style->schema.properties =
                camber_alloc(c->context, CAMBER_PROPERTY_LIMIT, sizeof *style->schema.properties);
        char *copy = style->schema.properties ? camber_copy_string(c->context, name) : NULL;
        if (!copy)
            return fail_memory(c);
        style->schema.properties[style->schema.property_count++] = copy;
        c->property_slots[slot] = (uint32_t)style->schema.property_count;
    }
    if (!add_readers(c, c->property_slots[slot] - 1))
        return fail_memory(c);
    const camber_node prototype = {
        .evaluate = evaluate,
        .type = camber_typing_of(evaluate == camber_evaluate_has ? CAMBER_TYPE_BOOL : CAMBER_TYPE_VALUE),
        .index = c->property_slots[slot] - 1,
        .reads_feature = true};
    return camber_make_node(c, &prototype, c->operand_count, node);
}

/* ---- Variables ---- */

static size_t binding_head(const char *name) {
    const uint64_t hash = camber_hash(CAMBER_HASH_START, name, strlen(name));
    return (size_t)(hash ^ hash >> 32) % CAMBER_BINDING_HEADS;
}

bool camber_bind(camber_compiler *c, const char *name, uint32_t node) {
    if (!c->binding_heads) {
        c->binding_heads = camber_alloc(c->context, CAMBER_BINDING_HEADS, sizeof *c->binding_heads);
        if (!c->binding_heads)
            return fail_memory(c);
        for (size_t i = 0; i < CAMBER_BINDING_HEADS; i++)
            c->binding_heads[i] = CAMBER_BINDING_LIMIT;
    }
    if (c->expression->slot_count >= CAMBER_BINDING_LIMIT)
        return camber_compiler_fail(c, "more than %d variables are bound in one expression; bind fewer",
                                    CAMBER_BINDING_LIMIT);
    if (!grow(c, &c->bindings, &c->binding_capacity, c->binding_count, sizeof *c->bindings))
        return false;
    uint32_t *head = &c->binding_heads[binding_head(name)];
    c->bindings[c->binding_count] = (camber_binding){name, node, c->expression->slot_count++, *head};
    *head = (uint32_t)c->binding_count++;
    return true;
}

void camber_unbind(camber_compiler *c, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const camber_binding *last = &c->bindings[--c->binding_count];
        c->binding_heads[binding_head(last->name)] = last->next;
    }
}

const camber_binding *camber_find_binding(const camber_compiler *c, const char *name) {
    uint32_t at = c->binding_heads ? c->binding_heads[binding_head(name)] : CAMBER_BINDING_LIMIT;
    while (at != CAMBER_BINDING_LIMIT && strcmp(c->bindings[at].name, name) != 0)
        at = c->bindings[at].next;
    return at == CAMBER_BINDING_LIMIT ? NULL : &c->bindings[at];
}

/* ---- Folding ---- */

/* Whether a node may be replaced by its value now. It may not be if it reads the state, whose type counts as unknown;
 * if it is an error, which must fail only if it is reached; if it is a collator, whose value is not a value of the
 * language; or if it is a variable, whose value belongs to one evaluation. */
static bool is_foldable(const camber_expression *e, const camber_node *node) {
    static camber_evaluate_fn *const kept[] = {camber_evaluate_constant, camber_evaluate_state, camber_evaluate_var,
                                               camber_evaluate_error, camber_evaluate_collator};
    if (node->reads_zoom || node->reads_feature || node->reads_line_progress)
        return false;
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++)
        if (node->evaluate == kept[i])
            return false;
    for (uint32_t i = 0; i < node->count; i++) {
        const camber_node *operand = &e->nodes[e->links[node->first + i]];
        if (!camber_is_constant(operand) ||
            (node->evaluate == camber_evaluate_coalesce && operand->type.type == CAMBER_TYPE_IMAGE))
            return false; /* it is not known yet which images exist */
    }
    return true;
}

/* Replaces a node with constant operands by its value, which uses the expression's memory. */
static bool fold(camber_compiler *c, uint32_t *node) {
    camber_expression *e = c->expression;
    if (!is_foldable(e, &e->nodes[*node]))
        return true;
    camber_evaluation evaluation;
    camber_value value;
    camber_evaluation_begin(&evaluation, 0.0, NULL);
    evaluation.expression = e;
    evaluation.arena = &e->arena;
    evaluation.slots = NULL;
    evaluation.work = 0;
    const size_t used = e->arena.used, left = CAMBER_FOLD_LIMIT - c->folded_bytes;
    e->arena.limit = used + (left < CAMBER_EVALUATION_LIMIT ? left : CAMBER_EVALUATION_LIMIT);
    const bool done = camber_evaluate_node(&evaluation, *node, &value);
    e->arena.limit = SIZE_MAX;
    c->folded_bytes += e->arena.used - used;
    c->folded_work += evaluation.work;
    if (!done && e->arena.starved)
        return camber_compiler_fail_memory(c);
    if (!done)
        return camber_compiler_fail(c, "cannot be evaluated: %.200s; correct the value", evaluation.cause);
    if (c->folded_work > CAMBER_FOLD_WORK_LIMIT)
        return camber_compiler_fail(
            c, "the style's constant expressions take too long to evaluate; write their values instead");
    const camber_typing type = e->nodes[*node].type;
    return camber_make_constant(c, &value, type, node);
}

/* ---- Types ---- */

camber_evaluate_fn *camber_conversion_to(camber_type type) {
    switch (type) {
    case CAMBER_TYPE_COLOR: return camber_evaluate_to_color;
    case CAMBER_TYPE_IMAGE: return camber_evaluate_to_image;
    case CAMBER_TYPE_FORMATTED: return camber_evaluate_to_formatted;
    case CAMBER_TYPE_PADDING: return camber_evaluate_to_padding;
    case CAMBER_TYPE_ANCHORS: return camber_evaluate_to_anchors;
    default: return camber_evaluate_assert;
    }
}

/* Whether values of a known type are converted to another type if that is expected. */
static bool is_converted(camber_type expected, camber_type actual) {
    switch (expected) {
    case CAMBER_TYPE_PADDING: return actual == CAMBER_TYPE_NUMBER || actual == CAMBER_TYPE_ARRAY;
    case CAMBER_TYPE_ANCHORS: return actual == CAMBER_TYPE_ARRAY;
    default: return actual == CAMBER_TYPE_STRING;
    }
}

bool camber_annotate(camber_compiler *c, camber_typing expected, camber_annotation annotation, uint32_t *node) {
    const camber_typing actual = camber_node_at(c, *node)->type;
    const bool unknown = actual.type == CAMBER_TYPE_VALUE, omit = annotation == CAMBER_ANNOTATE_OMIT;
    char wanted[CAMBER_TYPING_TEXT_SIZE], found[CAMBER_TYPING_TEXT_SIZE];
    switch (expected.type) {
    case CAMBER_TYPE_BOOL:
    case CAMBER_TYPE_NUMBER:
    case CAMBER_TYPE_STRING:
    case CAMBER_TYPE_ARRAY:
    case CAMBER_TYPE_OBJECT:
        if (!unknown)
            break;
        return omit || (camber_wrap_node(c,
                                         annotation == CAMBER_ANNOTATE_COERCE && expected.type == CAMBER_TYPE_STRING
                                             ? camber_evaluate_to_string
                                             : camber_evaluate_assert,
                                         expected, node) &&
                        fold(c, node));
    case CAMBER_TYPE_COLOR:
    case CAMBER_TYPE_IMAGE:
    case CAMBER_TYPE_FORMATTED:
    case CAMBER_TYPE_PADDING:
    case CAMBER_TYPE_ANCHORS:
        if (!unknown && !is_converted(expected.type, actual.type))
            break;
        return omit || (camber_wrap_node(c, camber_conversion_to(expected.type), expected, node) && fold(c, node));
    case CAMBER_TYPE_VALUE:
    case CAMBER_TYPE_NULL:
    case CAMBER_TYPE_COLLATOR:
    case CAMBER_TYPE_ERROR: break;
    }
    return camber_typing_fits(expected, actual) ||
           camber_compiler_fail(c, "expected %s, found %s; change the value or convert it",
                                camber_typing_name(expected, wanted), camber_typing_name(actual, found));
}

/* ---- Compilation ---- */

/* Drops the nodes from which a constant was made. */
static bool drop_since(camber_compiler *c, const camber_expression *before, uint32_t *node) {
    camber_expression *e = c->expression;
    const camber_node constant = e->nodes[*node];
    if (!camber_is_constant(&constant))
        return true;
    e->node_count = before->node_count;
    e->link_count = before->link_count;
    e->stop_count = before->stop_count;
    e->label_count = before->label_count;
    return camber_make_constant(c, &constant.value, constant.type, node);
}

bool camber_compile_as(camber_compiler *c, json_t *json, camber_typing expected, camber_annotation annotation,
                       uint32_t *node) {
    if (c->depth >= CAMBER_EXPRESSION_DEPTH)
        return camber_compiler_fail(c, "nested deeper than %d levels; flatten the expression", CAMBER_EXPRESSION_DEPTH);
    const camber_expression before = *c->expression;
    c->depth++;
    bool done;
    if (json_is_array(json))
        done = camber_compile_operator(c, json, expected, node) && fold(c, node) && drop_since(c, &before, node);
    else if (json_is_object(json))
        done = camber_compiler_fail(c, "an object is not an expression; write [\"literal\", {...}]");
    else
        done = camber_make_json_constant(c, json, node);
    done = done && camber_annotate(c, expected, annotation, node);
    c->depth--;
    return done;
}

bool camber_compile(camber_compiler *c, json_t *json, camber_typing expected, uint32_t *node) {
    return camber_compile_as(c, json, expected, CAMBER_ANNOTATE_ASSERT, node);
}

bool camber_compile_element(camber_compiler *c, const json_t *array, size_t index, camber_typing expected,
                            uint32_t *node) {
    camber_compiler_enter_index(c, index);
    if (!camber_compile(c, json_array_get(array, index), expected, node))
        return false;
    camber_compiler_leave(c);
    return true;
}

bool camber_compile_operand(camber_compiler *c, const json_t *array, size_t index, camber_typing expected) {
    uint32_t node = 0;
    return camber_compile_element(c, array, index, expected, &node) && camber_push_operand(c, node);
}

bool camber_compile_loose_operand(camber_compiler *c, const json_t *array, size_t index, camber_typing expected) {
    uint32_t node = 0;
    camber_compiler_enter_index(c, index);
    if (!camber_compile_as(c, json_array_get(array, index), expected, CAMBER_ANNOTATE_OMIT, &node))
        return false;
    camber_compiler_leave(c);
    return camber_push_operand(c, node);
}

/* ---- Whole expressions ---- */

bool camber_expression_keep(camber_compiler *c, json_t *json) {
    return json_array_append(c->expression->documents, json) == 0 || camber_compiler_fail_memory(c);
}

bool camber_expression_begin(camber_compiler *c, json_t *json) {
    c->depth = 0;
    c->operand_count = 0;
    camber_unbind(c, c->binding_count);
    c->expression = camber_alloc_zero(c->context, 1, sizeof *c->expression);
    if (!c->expression)
        return fail_memory(c);
    c->expression->context = c->context;
    c->expression->arena = (camber_arena){.context = c->context, .limit = SIZE_MAX};
    c->expression->document = json;
    c->expression->documents = json_array();
    if (c->expression->documents && camber_expression_keep(c, json))
        return true;
    camber_expression_destroy(c->context, c->expression);
    c->expression = NULL;
    return c->status == CAMBER_ERROR_MEMORY ? false : camber_compiler_fail_memory(c);
}

/* Most of a style's expressions are constants of one node, but the array began with room for more. */
static void trim_nodes(camber_expression *e) {
    camber_node *trimmed = camber_resize_quietly(e->context, e->nodes, e->node_count * sizeof *e->nodes);
    if (!trimmed)
        return;
    e->nodes = trimmed;
    e->node_capacity = e->node_count;
}

bool camber_expression_end(camber_compiler *c, bool done, uint32_t root, camber_expression **expression) {
    camber_expression *e = c->expression;
    c->expression = NULL;
    if (!done) {
        camber_expression_destroy(c->context, e);
        return false;
    }
    trim_nodes(e);
    e->root = root;
    e->reads_zoom = e->nodes[root].reads_zoom;
    e->reads_feature = e->nodes[root].reads_feature;
    e->reads_line_progress = e->nodes[root].reads_line_progress;
    *expression = e;
    return true;
}
