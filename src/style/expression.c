/* Evaluation: what is read, variables, comparisons and decisions. */
#include "style/expression.h"

#include "style/evaluation.h"
#include "style/letters.h"

#include <math.h>

static bool evaluate(camber_evaluation *e, const camber_node *node, camber_value *value);

bool camber_evaluate_node(camber_evaluation *e, uint32_t node, camber_value *value) {
    return evaluate(e, &e->expression->nodes[node], value);
}

bool camber_evaluate_fail(camber_evaluation *e, const char *cause) {
    e->cause = cause;
    return false;
}

bool camber_evaluate_no_memory(camber_evaluation *e) {
    return camber_evaluate_fail(e, "its texts and arrays take too much memory");
}

bool camber_evaluate_work(camber_evaluation *e, size_t amount) {
    if (amount > CAMBER_WORK_LIMIT - e->work)
        return camber_evaluate_fail(e, "it takes too long");
    e->work += (uint32_t)amount;
    return true;
}

bool camber_evaluate_number(camber_evaluation *e, const camber_node *node, uint32_t operand, double *number) {
    camber_value value;
    if (!camber_evaluate_operand(e, node, operand, &value))
        return false;
    *number = value.number;
    return value.type == CAMBER_VALUE_NUMBER || camber_evaluate_fail(e, "a number is wanted and the value is not one");
}

bool camber_evaluate_string(camber_evaluation *e, const camber_node *node, uint32_t operand, const char **string) {
    camber_value value;
    if (!camber_evaluate_operand(e, node, operand, &value))
        return false;
    *string = value.string;
    return value.type == CAMBER_VALUE_STRING || camber_evaluate_fail(e, "a string is wanted and the value is not one");
}

static bool evaluate_bool(camber_evaluation *e, const camber_node *node, uint32_t operand, bool *boolean) {
    camber_value value;
    if (!camber_evaluate_operand(e, node, operand, &value))
        return false;
    *boolean = value.boolean;
    return value.type == CAMBER_VALUE_BOOL || camber_evaluate_fail(e, "a boolean is wanted and the value is not one");
}

/* ---- What is read ---- */

static const camber_value nothing = {.type = CAMBER_VALUE_NULL};

static bool has(const camber_value *value) {
    return value->type != CAMBER_VALUE_NULL || value->boolean;
}

/* The member of the object, or of all properties of the feature where there is none. */
static bool evaluate_member(camber_evaluation *e, const camber_node *node, camber_value *value) {
    const char *key;
    const bool named = node->op == CAMBER_OP_GET_NAMED || node->op == CAMBER_OP_HAS_NAMED;
    camber_value object = nothing;
    if (!camber_evaluate_string(e, node, 0, &key))
        return false;
    if (!named && !camber_evaluate_operand(e, node, 1, &object))
        return false;
    if (!named && object.type != CAMBER_VALUE_OBJECT)
        return camber_evaluate_fail(e, "an object is wanted and the value is not one");
    if (named && e->feature->all)
        object = *e->feature->all;
    const camber_value *found = camber_object_get(&object, key);
    if (node->op == CAMBER_OP_HAS_NAMED || node->op == CAMBER_OP_HAS_MEMBER)
        *value = camber_value_bool(found != NULL);
    else
        *value = found ? *found : nothing;
    return true;
}

static bool evaluate_feature(camber_evaluation *e, const camber_node *node, camber_value *value) {
    static const camber_value empty = {.type = CAMBER_VALUE_OBJECT};
    const camber_feature_view *feature = e->feature;
    if (!feature)
        return camber_evaluate_fail(e, "there is no feature to read");
    switch (node->op) {
    case CAMBER_OP_GET: *value = feature->values[node->index]; return true;
    case CAMBER_OP_HAS: *value = camber_value_bool(has(&feature->values[node->index])); return true;
    case CAMBER_OP_ID: *value = feature->id; return true;
    case CAMBER_OP_HAS_ID: *value = camber_value_bool(feature->id.type != CAMBER_VALUE_NULL); return true;
    case CAMBER_OP_PROPERTIES: *value = feature->all ? *feature->all : empty; return true;
    case CAMBER_OP_GEOMETRY_TYPE:
        *value = feature->geometry_type ? camber_value_string(feature->geometry_type) : nothing;
        return true;
    default: return evaluate_member(e, node, value);
    }
}

/* A variable is evaluated when it is first read, and kept: else each that reads the one before twice would double the
 * time. */
static bool evaluate_var(camber_evaluation *e, const camber_node *node, camber_value *value) {
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

/* ---- Comparisons ---- */

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
    case CAMBER_VALUE_OBJECT: break;
    }
    return a->members == b->members && a->count == b->count;
}

enum { COLLATE_CASE = 1, COLLATE_DIACRITICS = 2 };

static bool evaluate_collator(camber_evaluation *e, const camber_node *node, camber_value *value) {
    bool by_case, by_diacritics;
    if (!evaluate_bool(e, node, 0, &by_case) || !evaluate_bool(e, node, 1, &by_diacritics))
        return false;
    *value = camber_value_number((by_case ? COLLATE_CASE : 0) + (by_diacritics ? COLLATE_DIACRITICS : 0));
    return true;
}

static int compare_strings(const char *a, const char *b, const camber_value *collator) {
    if (!collator)
        return strcmp(a, b);
    const int by = (int)collator->number;
    return camber_letters_compare(a, b, by & COLLATE_CASE, by & COLLATE_DIACRITICS);
}

static bool holds(camber_op op, bool less, bool equal) {
    switch (op) {
    case CAMBER_OP_EQUAL: return equal;
    case CAMBER_OP_NOT_EQUAL: return !equal;
    case CAMBER_OP_LESS: return less;
    case CAMBER_OP_LESS_EQUAL: return less || equal;
    case CAMBER_OP_GREATER: return !less && !equal;
    default: return !less;
    }
}

static bool evaluate_comparison(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value a, b, collator = nothing;
    if (!camber_evaluate_operand(e, node, 0, &a) || !camber_evaluate_operand(e, node, 1, &b) ||
        (node->count > 2 && !camber_evaluate_operand(e, node, 2, &collator)))
        return false;
    const bool strings = a.type == CAMBER_VALUE_STRING && b.type == CAMBER_VALUE_STRING;
    const bool numbers = a.type == CAMBER_VALUE_NUMBER && b.type == CAMBER_VALUE_NUMBER;
    const bool order = node->op != CAMBER_OP_EQUAL && node->op != CAMBER_OP_NOT_EQUAL;
    if (order && !strings && !numbers)
        return camber_evaluate_fail(e, "two numbers or two strings are wanted");
    if (strings) {
        const int sign = compare_strings(a.string, b.string, node->count > 2 ? &collator : NULL);
        *value = camber_value_bool(holds(node->op, sign < 0, sign == 0));
    } else if (order && (isnan(a.number) || isnan(b.number))) {
        *value = camber_value_bool(false);
    } else {
        *value = camber_value_bool(holds(node->op, numbers && a.number < b.number, camber_values_equal(&a, &b)));
    }
    return true;
}

/* ---- Decisions ---- */

/* all stops at the first false, any at the first true. */
static bool evaluate_junction(camber_evaluation *e, const camber_node *node, camber_value *value) {
    bool result = node->op == CAMBER_OP_ALL;
    for (uint32_t i = 0; i < node->count; i++) {
        if (!evaluate_bool(e, node, i, &result))
            return false;
        if (result != (node->op == CAMBER_OP_ALL))
            break;
    }
    *value = camber_value_bool(result);
    return true;
}

static bool evaluate_case(camber_evaluation *e, const camber_node *node, camber_value *value) {
    for (uint32_t i = 0; i + 1 < node->count; i += 2) {
        bool condition;
        if (!evaluate_bool(e, node, i, &condition))
            return false;
        if (condition)
            return camber_evaluate_operand(e, node, i + 1, value);
    }
    return camber_evaluate_operand(e, node, node->count - 1, value);
}

static int compare_label(const camber_value *value, const camber_label *label) {
    if (label->string)
        return strcmp(value->string, label->string);
    return value->number < label->number ? -1 : value->number > label->number;
}

/* The node's label that the value is; NULL: none. */
static const camber_label *find_label(const camber_expression *expression, const camber_node *node,
                                      const camber_value *value) {
    uint32_t low = 0, high = node->index_count;
    if (high == 0)
        return NULL;
    const camber_label *labels = &expression->labels[node->index];
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

static bool evaluate_match(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value input;
    if (!camber_evaluate_operand(e, node, 0, &input))
        return false;
    const camber_label *label = find_label(e->expression, node, &input);
    if (node->op == CAMBER_OP_MATCH)
        return camber_evaluate_operand(e, node, label ? label->output : node->count - 1, value);
    if (input.type > CAMBER_VALUE_STRING)
        return camber_evaluate_fail(e, "\"in\" looks for a string, a number, a boolean or null");
    *value = camber_value_bool(label != NULL);
    return true;
}

static bool is_there(const camber_evaluation *e, const camber_node *operand, const camber_value *value) {
    if (value->type == CAMBER_VALUE_NULL || !e->images || operand->type.type != CAMBER_TYPE_IMAGE)
        return value->type != CAMBER_VALUE_NULL;
    return value->type == CAMBER_VALUE_STRING && e->images->find(e->images->user, value->string) != 0;
}

/* Of images that are all missing the first is the one that is missed. */
static bool evaluate_coalesce(camber_evaluation *e, const camber_node *node, camber_value *value) {
    camber_value first = nothing;
    *value = nothing;
    for (uint32_t i = 0; i < node->count; i++) {
        if (!camber_evaluate_operand(e, node, i, value))
            return false;
        if (is_there(e, &e->expression->nodes[e->expression->links[node->first + i]], value))
            return true;
        if (first.type == CAMBER_VALUE_NULL)
            first = *value;
    }
    *value = first;
    return true;
}

static bool evaluate_not(camber_evaluation *e, const camber_node *node, camber_value *value) {
    bool boolean;
    if (!evaluate_bool(e, node, 0, &boolean))
        return false;
    *value = camber_value_bool(!boolean);
    return true;
}

static bool evaluate_quiet(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!camber_evaluate_operand(e, node, 0, value))
        *value = camber_value_bool(false);
    return true;
}

/* Its message is the style's; the evaluation keeps it. */
static bool evaluate_error(camber_evaluation *e, const camber_node *node) {
    const char *message;
    return camber_evaluate_string(e, node, 0, &message) && camber_evaluate_fail(e, message);
}

static bool evaluate(camber_evaluation *e, const camber_node *node, camber_value *value) {
    switch (node->op) {
    case CAMBER_OP_CONSTANT:
    case CAMBER_OP_STATE: *value = node->value; return true;
    case CAMBER_OP_ZOOM: *value = camber_value_number(e->zoom); return true;
    case CAMBER_OP_LINE_PROGRESS: *value = camber_value_number(e->line_progress); return true;
    case CAMBER_OP_GET_MEMBER:
    case CAMBER_OP_HAS_MEMBER: return evaluate_member(e, node, value);
    case CAMBER_OP_LET: return camber_evaluate_operand(e, node, node->count - 1, value);
    case CAMBER_OP_VAR: return evaluate_var(e, node, value);
    case CAMBER_OP_ERROR: return evaluate_error(e, node);
    case CAMBER_OP_QUIET: return evaluate_quiet(e, node, value);
    case CAMBER_OP_COLLATOR: return evaluate_collator(e, node, value);
    case CAMBER_OP_NOT: return evaluate_not(e, node, value);
    case CAMBER_OP_ALL:
    case CAMBER_OP_ANY: return evaluate_junction(e, node, value);
    case CAMBER_OP_CASE: return evaluate_case(e, node, value);
    case CAMBER_OP_MATCH:
    case CAMBER_OP_AMONG: return evaluate_match(e, node, value);
    case CAMBER_OP_COALESCE: return evaluate_coalesce(e, node, value);
    default: break;
    }
    if (node->op <= CAMBER_OP_GEOMETRY_TYPE)
        return evaluate_feature(e, node, value);
    if (node->op <= CAMBER_OP_TYPEOF)
        return camber_evaluate_conversion(e, node, value);
    if (node->op <= CAMBER_OP_GREATER_EQUAL)
        return evaluate_comparison(e, node, value);
    if (node->op <= CAMBER_OP_DOWNCASE)
        return camber_evaluate_text(e, node, value);
    if (node->op <= CAMBER_OP_INTERPOLATE)
        return camber_evaluate_curve(e, node, value);
    return camber_evaluate_maths(e, node, value);
}

/* ---- From outside ---- */

void camber_evaluation_begin(camber_evaluation *evaluation, double zoom, const camber_feature_view *feature) {
    evaluation->zoom = zoom;
    evaluation->line_progress = 0.0;
    evaluation->feature = feature;
    evaluation->images = NULL;
    evaluation->cause = NULL;
    evaluation->arena = &evaluation->own;
    evaluation->own = (camber_arena){.at = evaluation->room, .left = sizeof evaluation->room};
}

void camber_evaluation_end(camber_evaluation *evaluation) {
    camber_arena_free(&evaluation->own);
}

bool camber_expression_evaluate(const camber_expression *expression, camber_evaluation *evaluation,
                                camber_value *value) {
    evaluation->expression = expression;
    evaluation->slots = NULL;
    evaluation->work = 0;
    evaluation->own.context = expression->context;
    evaluation->own.limit = CAMBER_EVALUATION_LIMIT;
    return camber_evaluate_node(evaluation, expression->root, value);
}

void camber_expression_destroy(camber_context *context, camber_expression *expression) {
    if (!expression)
        return;
    camber_arena_free(&expression->arena);
    camber_free(context, expression->labels);
    camber_free(context, expression->stops);
    camber_free(context, expression->links);
    camber_free(context, expression->nodes);
    json_decref(expression->documents);
    camber_free(context, expression);
}
