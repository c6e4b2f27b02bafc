/* Compiles filters: expressions, and the older form ["==", "highway", "primary"].
 *
 * Input: JSON. Output: an expression that is true or false. The two forms are distinguished by the specification's
 * rules. */
#include "style/operators.h"

#include <string.h>

static const camber_typing boolean = {.type = CAMBER_TYPE_BOOL};

static bool compile_filter(camber_compiler *c, json_t *json, size_t depth, uint32_t *node);

static bool is_word(const char *text, const char *word) {
    return text && strcmp(text, word) == 0;
}

static bool is_comparison(const char *op) {
    return is_word(op, "==") || is_word(op, "!=") || is_word(op, "<") || is_word(op, "<=") || is_word(op, ">") ||
           is_word(op, ">=");
}

/* The specification's isExpressionFilter, for arrays. all, any and none belong to both forms: each of their operands is
 * distinguished separately, so the two forms may be mixed. */
static bool is_expression(const json_t *json) {
    const char *op = json_string_value(json_array_get(json, 0));
    const size_t size = json_array_size(json);
    const json_t *second = json_array_get(json, 1), *third = json_array_get(json, 2);
    if (is_word(op, "has"))
        return size >= 2 && !is_word(json_string_value(second), "$id") && !is_word(json_string_value(second), "$type");
    if (is_word(op, "in"))
        return size >= 3 && (!json_is_string(second) || json_is_array(third));
    if (is_word(op, "!in") || is_word(op, "!has"))
        return json_is_array(second) || json_is_array(third);
    if (is_comparison(op))
        return size != 3 || json_is_array(second) || json_is_array(third);
    return true;
}

/* Compiles the key of an older filter: a property's name, $type or $id. */
static bool compile_key(camber_compiler *c, const json_t *array, camber_evaluate_fn *evaluate, uint32_t *node) {
    const char *key = json_string_value(json_array_get(array, 1));
    const camber_value yes = {.type = CAMBER_VALUE_BOOL, .boolean = true};
    if (!key) {
        camber_compiler_enter_index(c, 1);
        return camber_compiler_fail(c, "expected a property's name; write e.g. [\"==\", \"highway\", \"primary\"]");
    }
    if (strcmp(key, "$id") == 0)
        return evaluate == camber_evaluate_has ? camber_make_reader(c, camber_evaluate_has_id, CAMBER_TYPE_BOOL, node)
                                               : camber_make_reader(c, camber_evaluate_id, CAMBER_TYPE_VALUE, node);
    if (strcmp(key, "$type") != 0)
        return camber_make_property(c, evaluate, key, node);
    return evaluate == camber_evaluate_has
               ? camber_make_constant(c, &yes, boolean, node)
               : camber_make_reader(c, camber_evaluate_geometry_type, CAMBER_TYPE_STRING, node);
}

static bool compile_value(camber_compiler *c, const json_t *array, size_t index, uint32_t *node) {
    const json_t *json = json_array_get(array, index);
    camber_compiler_enter_index(c, index);
    if (json_is_array(json) || json_is_object(json))
        return camber_compiler_fail(c, "expected a string, number, boolean or null, found %s; take it out",
                                    camber_json_name(json));
    if (!camber_make_json_constant(c, json, node))
        return false;
    camber_compiler_leave(c);
    return true;
}

/* Makes the comparison with null false for features without the property. A feature without an id, however, has the id
 * null. */
static bool require_key(camber_compiler *c, const json_t *array, uint32_t *node) {
    const size_t first_operand = c->operand_count;
    uint32_t has = 0;
    if (is_word(json_string_value(json_array_get(array, 1)), "$id"))
        return true;
    return compile_key(c, array, camber_evaluate_has, &has) && camber_push_operand(c, has) &&
           camber_push_operand(c, *node) &&
           camber_make_node(c, &(camber_node){.evaluate = camber_evaluate_all, .type = boolean}, first_operand, node);
}

/* Compiles [op, key, value]. Values of different types cannot be compared, and then the filter is false. */
static bool compile_comparison(camber_compiler *c, const json_t *array, const char *op, uint32_t *node) {
    static const struct {
        const char *name;
        uint32_t outcomes;
    } ops[] = {{"==", CAMBER_OUTCOME_EQUAL},  {"!=", CAMBER_OUTCOME_EQUAL},
               {"<", CAMBER_OUTCOME_LESS},    {"<=", CAMBER_OUTCOME_LESS | CAMBER_OUTCOME_EQUAL},
               {">", CAMBER_OUTCOME_GREATER}, {">=", CAMBER_OUTCOME_GREATER | CAMBER_OUTCOME_EQUAL}};
    const size_t first_operand = c->operand_count;
    if (!compile_key(c, array, camber_evaluate_get, node) || !camber_push_operand(c, *node) ||
        !compile_value(c, array, 2, node) || !camber_push_operand(c, *node))
        return false;
    camber_node prototype = {.evaluate = camber_evaluate_comparison, .type = boolean};
    for (size_t i = 0; i < sizeof ops / sizeof *ops; i++)
        if (strcmp(ops[i].name, op) == 0)
            prototype.index = ops[i].outcomes;
    if (!camber_make_node(c, &prototype, first_operand, node) ||
        !camber_wrap_node(c, camber_evaluate_quiet, boolean, node))
        return false;
    if (json_is_null(json_array_get(array, 2)) && !require_key(c, array, node))
        return false;
    return !is_word(op, "!=") || camber_wrap_node(c, camber_evaluate_not, boolean, node);
}

/* Whether all values are strings, or all are numbers. Then they become labels. */
static bool are_labels(const json_t *array) {
    for (size_t i = 2; i < json_array_size(array); i++) {
        const json_t *json = json_array_get(array, i);
        if (json_is_string(json) != json_is_string(json_array_get(array, 2)) ||
            !(json_is_string(json) || json_is_number(json)))
            return false;
    }
    return true;
}

/* Compiles ["in", key, value, ...] and !in. */
static bool compile_in(camber_compiler *c, const json_t *array, bool negated, uint32_t *node) {
    const size_t first_operand = c->operand_count, first = c->expression->label_count;
    const bool labels = are_labels(array);
    uint32_t value = 0;
    if (!compile_key(c, array, camber_evaluate_get, node) || !camber_push_operand(c, *node))
        return false;
    for (size_t i = 2; i < json_array_size(array); i++) {
        const json_t *json = json_array_get(array, i);
        if (labels ? !camber_push_label(
                         c, &(camber_match_label){.string = json_string_value(json), .number = json_number_value(json)})
                   : !compile_value(c, array, i, &value) || !camber_push_operand(c, value))
            return false;
    }
    const camber_node among = {.evaluate = camber_evaluate_among,
                               .type = boolean,
                               .index = (uint32_t)first,
                               .index_count = (uint32_t)(c->expression->label_count - first)};
    const camber_node list = {.evaluate = camber_evaluate_list, .type = camber_typing_of(CAMBER_TYPE_ARRAY)};
    const camber_node in = {.evaluate = camber_evaluate_in, .type = boolean};
    const bool made = labels ? camber_sort_labels(c, first, false) && camber_make_node(c, &among, first_operand, node)
                             : camber_make_node(c, &list, first_operand + 1, node) && camber_push_operand(c, *node) &&
                                   camber_make_node(c, &in, first_operand, node);
    bool nulls = false;
    for (size_t i = 2; i < json_array_size(array); i++)
        nulls = nulls || json_is_null(json_array_get(array, i));
    return made && camber_wrap_node(c, camber_evaluate_quiet, boolean, node) &&
           (!nulls || require_key(c, array, node)) &&
           (!negated || camber_wrap_node(c, camber_evaluate_not, boolean, node));
}

/* Compiles all, any and none. */
static bool compile_junction(camber_compiler *c, const json_t *array, const char *op, size_t depth, uint32_t *node) {
    const size_t first_operand = c->operand_count;
    for (size_t i = 1; i < json_array_size(array); i++) {
        camber_compiler_enter_index(c, i);
        if (!compile_filter(c, json_array_get(array, i), depth + 1, node) || !camber_push_operand(c, *node))
            return false;
        camber_compiler_leave(c);
    }
    const camber_node junction = {.evaluate = is_word(op, "all") ? camber_evaluate_all : camber_evaluate_any,
                                  .type = boolean};
    return camber_make_node(c, &junction, first_operand, node) &&
           (!is_word(op, "none") || camber_wrap_node(c, camber_evaluate_not, boolean, node));
}

static bool compile_filter(camber_compiler *c, json_t *json, size_t depth, uint32_t *node) {
    if (depth >= CAMBER_EXPRESSION_DEPTH)
        return camber_compiler_fail(c, "nested deeper than %d levels; flatten the filter", CAMBER_EXPRESSION_DEPTH);
    if (!json_is_array(json) && !json_is_boolean(json))
        return camber_compiler_fail(
            c, "expected a filter, found %s; write e.g. [\"==\", [\"get\", \"highway\"], \"primary\"]",
            camber_json_name(json));
    const char *op = json_string_value(json_array_get(json, 0));
    if (is_word(op, "all") || is_word(op, "any") || is_word(op, "none"))
        return compile_junction(c, json, op, depth, node);
    if (json_is_array(json) && json_array_size(json) == 0)
        return camber_make_constant(c, &(camber_value){.type = CAMBER_VALUE_BOOL, .boolean = true}, boolean, node);
    if (json_is_boolean(json) || is_expression(json)) {
        c->depth = depth;
        return camber_compile(c, json, boolean, node);
    }
    if (json_array_size(json) < 2)
        return camber_compiler_fail(
            c, "\"%s\" without a property's name; write e.g. [\"==\", \"highway\", \"primary\"]", op);
    if (is_word(op, "has"))
        return compile_key(c, json, camber_evaluate_has, node);
    if (is_word(op, "!has"))
        return compile_key(c, json, camber_evaluate_has, node) &&
               camber_wrap_node(c, camber_evaluate_not, boolean, node);
    if (is_word(op, "in") || is_word(op, "!in"))
        return compile_in(c, json, op[0] == '!', node);
    return compile_comparison(c, json, op, node);
}

/* ---- Evaluating ---- */

static bool evaluate(const camber_expression *filter, double zoom, const camber_feature_view *feature) {
    camber_evaluation evaluation;
    camber_evaluation_begin(&evaluation, zoom, feature);
    camber_value value;
    const bool matches =
        camber_expression_evaluate(filter, &evaluation, &value) && value.type == CAMBER_VALUE_BOOL && value.boolean;
    camber_evaluation_end(&evaluation);
    return matches;
}

/* Whether a filter without zoom reads nothing of features but the type of geometry and some properties, which this
 * lists. */
static bool list_properties(const camber_expression *e, camber_filter_shortcut *shortcut) {
    for (size_t i = 0; i < e->node_count; i++) {
        const camber_node *node = e->nodes + i;
        const bool property = node->evaluate == camber_evaluate_get || node->evaluate == camber_evaluate_has;
        if (!property && node->reads_feature && node->count == 0 && node->evaluate != camber_evaluate_geometry_type)
            return false;
        uint16_t at = 0;
        while (property && at < shortcut->count && shortcut->properties[at] != node->index)
            at++;
        if (!property || at < shortcut->count)
            continue;
        if (at == CAMBER_SHORTCUT_PROPERTIES)
            return false;
        shortcut->properties[shortcut->count++] = (uint16_t)node->index;
    }
    return true;
}

static bool find_shortcut(camber_compiler *c, camber_expression *filter) {
    _Static_assert(CAMBER_PROPERTY_LIMIT <= UINT16_MAX, "a property's index has 16 bits");
    static const char *const types[] = {"Point", "LineString", "Polygon"};
    camber_filter_shortcut *shortcut = &filter->shortcut;
    if (!filter->reads_feature || filter->reads_zoom || filter->reads_line_progress ||
        c->style->schema.wants_all_properties || !list_properties(filter, shortcut))
        return true;
    camber_value *absent = camber_alloc_zero(c->context, c->style->schema.property_count, sizeof *absent);
    if (!absent) { /* camber_alloc has logged it */
        c->status = CAMBER_ERROR_MEMORY;
        return false;
    }
    for (int i = 0; i < 3; i++)
        shortcut->results[i] =
            evaluate(filter, 0.0, &(camber_feature_view){.values = absent, .geometry_type = types[i]});
    shortcut->exists = true;
    camber_free(c->context, absent);
    return true;
}

/* Whether a feature has none of a shortcut's properties. A null that a feature has counts as one. */
static bool has_none(const camber_filter_shortcut *shortcut, const camber_feature_view *feature) {
    for (uint16_t i = 0; i < shortcut->count; i++) {
        const camber_value *value = feature->values + shortcut->properties[i];
        if (value->type != CAMBER_VALUE_NULL || value->boolean)
            return false;
    }
    return true;
}

bool camber_filter_passes(const camber_expression *filter, double zoom, const camber_feature_view *feature) {
    const camber_filter_shortcut *shortcut = &filter->shortcut;
    const char *type = feature ? feature->geometry_type : NULL;
    if (!shortcut->exists || !type || !has_none(shortcut, feature))
        return evaluate(filter, zoom, feature);
    return shortcut->results[type[0] == 'L' ? 1 : type[2] == 'l' ? 2 : 0];
}

bool camber_compile_filter(camber_compiler *c, json_t *json, camber_expression **expression) {
    uint32_t root = 0;
    if (!camber_expression_begin(c, json))
        return false;
    const bool done = compile_filter(c, json, 0, &root);
    return camber_expression_end(c, done, root, expression) && find_shortcut(c, *expression);
}

/* ---- Types of geometry ---- */

/* The result of a filter for features of one geometry type, if it is known without their properties. */
typedef enum verdict { NEVER = -1, MAYBE = 0, ALWAYS = 1 } verdict;

static verdict reverse(verdict one) {
    return (verdict) - (int)one;
}

static bool is_geometry_type(const json_t *json) {
    return is_word(json_string_value(json), "$type") ||
           is_word(json_string_value(json_array_get(json, 0)), "geometry-type");
}

/* Whether it is the type, its multi-part form as in "MultiPolygon", or a list that contains one of them. */
static bool names_type(const json_t *json, const char *type) {
    const char *text = json_string_value(json);
    if (text && strcmp(strncmp(text, "Multi", 5) == 0 ? text + 5 : text, type) == 0)
        return true;
    for (size_t i = 0; i < json_array_size(json); i++)
        if (names_type(json_array_get(json, i), type))
            return true;
    return false;
}

/* Judges comparisons with the type, in both forms of the language. Other comparisons are MAYBE. */
static verdict judge_type(const char *op, const json_t *json, const char *type) {
    bool about_type = false, named = false;
    for (size_t i = 1; i < json_array_size(json) && !about_type; i++)
        about_type = is_geometry_type(json_array_get(json, i));
    for (size_t i = 1; i < json_array_size(json) && !named; i++)
        named = names_type(json_array_get(json, i), type);
    if (!about_type)
        return MAYBE;
    if (is_word(op, "==") || is_word(op, "in"))
        return named ? ALWAYS : NEVER;
    return is_word(op, "!=") || is_word(op, "!in") ? (named ? NEVER : ALWAYS) : MAYBE;
}

/* Judges ["match", ["geometry-type"], labels, output, ..., fallback]. */
static verdict judge_match(const json_t *json, const char *type) {
    const size_t size = json_array_size(json);
    if (!is_geometry_type(json_array_get(json, 1)) || size < 5)
        return MAYBE;
    const json_t *output = json_array_get(json, size - 1);
    for (size_t i = 2; i + 1 < size; i += 2)
        if (names_type(json_array_get(json, i), type)) {
            output = json_array_get(json, i + 1);
            break;
        }
    return json_is_true(output) ? ALWAYS : json_is_false(output) ? NEVER : MAYBE;
}

static verdict judge(const json_t *json, const char *type);

/* "all" is NEVER if one of its members is; "any" is ALWAYS if one of its members is. */
static verdict judge_members(const json_t *json, const char *type, verdict decides) {
    verdict made = reverse(decides);
    for (size_t i = 1; i < json_array_size(json); i++) {
        const verdict one = judge(json_array_get(json, i), type);
        if (one == decides)
            return decides;
        made = one == MAYBE ? MAYBE : made;
    }
    return made;
}

static verdict judge(const json_t *json, const char *type) {
    const char *op = json_string_value(json_array_get(json, 0));
    if (json_is_boolean(json))
        return json_is_true(json) ? ALWAYS : NEVER;
    if (!op)
        return MAYBE;
    if (is_word(op, "all"))
        return judge_members(json, type, NEVER);
    if (is_word(op, "any"))
        return judge_members(json, type, ALWAYS);
    if (is_word(op, "none"))
        return reverse(judge_members(json, type, ALWAYS));
    if (is_word(op, "!"))
        return reverse(judge(json_array_get(json, 1), type));
    return is_word(op, "match") ? judge_match(json, type) : judge_type(op, json, type);
}

bool camber_filter_may_take(const json_t *json, const char *type) {
    return judge(json, type) != NEVER;
}
