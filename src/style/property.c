/* Compiles the value of a property (a constant, an expression or a function) and checks what it may depend on.
 *
 * Input: JSON and the property's definition. Output: an expression, or an error that says what to write instead. */
#include "style/compiler.h"

#include <math.h>
#include <stdio.h>

/* ---- Zoom ---- */

/* The zoom curves in a node: none, one, or more than the rule allows. */
typedef struct curve {
    uint32_t node;
    enum { CURVE_NONE, CURVE_ONE, CURVE_NESTED, CURVE_SEVERAL } kind;
} curve;

static bool same_curve(curve a, curve b) {
    return a.kind == b.kind && a.node == b.node;
}

/* The specification's rule: zoom is the input of one step or interpolate, which is at the top or inside a let or a
 * coalesce at the top. Operands that do not read the zoom have no curve, so only the path to zoom is walked. */
static curve find_curve(const camber_expression *e, uint32_t index) {
    const camber_node *node = &e->nodes[index];
    const curve own = {index, CURVE_ONE};
    const bool is_curve = node->evaluate == camber_evaluate_step || node->evaluate == camber_evaluate_interpolate;
    curve result = {0, CURVE_NONE};
    if (is_curve && e->nodes[e->links[node->first]].evaluate == camber_evaluate_zoom)
        result = own;
    else if (node->evaluate == camber_evaluate_let)
        result = find_curve(e, e->links[node->first + node->count - 1]);
    for (uint32_t i = 0; i < node->count && result.kind <= CURVE_ONE; i++) {
        const uint32_t operand = e->links[node->first + i];
        if (!e->nodes[operand].reads_zoom || (node->evaluate == camber_evaluate_let && i + 1 == node->count))
            continue;
        const curve found = find_curve(e, operand);
        if (found.kind == CURVE_NONE)
            continue;
        if (found.kind > CURVE_ONE || (result.kind == CURVE_NONE && node->evaluate == camber_evaluate_coalesce))
            result = found;
        else if (result.kind == CURVE_NONE)
            result.kind = CURVE_NESTED;
        else if (!same_curve(result, found))
            result.kind = CURVE_SEVERAL;
    }
    return result;
}

static bool check_zoom(camber_compiler *c, const camber_property *property, uint32_t root) {
    const camber_expression *e = c->expression;
    if (!e->nodes[root].reads_zoom)
        return true;
    if (property->without_zoom)
        return camber_compiler_fail(c, "%s cannot depend on zoom; use a constant", property->name);
    const curve found = find_curve(e, root);
    if (found.kind == CURVE_SEVERAL)
        return camber_compiler_fail(c, "\"zoom\" is the input of more than one \"step\" or \"interpolate\"; join them");
    if (found.kind != CURVE_ONE)
        return camber_compiler_fail(c, "\"zoom\" may only be the input of one \"step\" or \"interpolate\" at the top; "
                                       "move that curve outwards");
    if (!property->interpolated && e->nodes[found.node].evaluate == camber_evaluate_interpolate)
        return camber_compiler_fail(c, "%s is not interpolated; use \"step\"", property->name);
    return true;
}

/* ---- Constants ---- */

static bool check_property(camber_compiler *c, const camber_property *property, uint32_t root) {
    const camber_node *node = camber_node_at(c, root);
    if (node->reads_feature && !property->data_driven)
        return camber_compiler_fail(c, "%s cannot depend on features; use a constant%s", property->name,
                                    property->without_zoom ? "" : " or zoom");
    if (node->reads_line_progress && !property->line_progress && !c->strict)
        return camber_compiler_fail(c, "%s cannot depend on \"line-progress\"; use it in line-gradient",
                                    property->name);
    return check_zoom(c, property, root) && (!camber_is_constant(node) || c->strict ||
                                             camber_property_check(c, property, &camber_node_at(c, root)->value));
}

/* ---- Constants that an expression may return ---- */

static bool check_outputs(camber_compiler *c, const camber_property *property, const json_t *json);

/* Checks the operands that may be the result: every step-th from first on, and the last. */
static bool check_operands(camber_compiler *c, const camber_property *property, const json_t *array, size_t first,
                           size_t step) {
    const size_t count = json_array_size(array);
    for (size_t i = first; i < count; i++) {
        if ((i - first) % step != 0 && i + 1 != count)
            continue;
        camber_compiler_enter_index(c, i);
        if (!check_outputs(c, property, json_array_get(array, i)))
            return false;
        camber_compiler_leave(c);
    }
    return true;
}

/* The expression must already have compiled. */
static bool check_outputs(camber_compiler *c, const camber_property *property, const json_t *json) {
    static const struct {
        const char *name;
        size_t first, step;
    } operators[] = {{"step", 2, 2},  {"interpolate", 4, 2}, {"interpolate-hcl", 4, 2}, {"interpolate-lab", 4, 2},
                     {"match", 3, 2}, {"case", 2, 2},        {"coalesce", 1, 1}};
    const char *name = json_string_value(json_array_get(json, 0));
    const size_t count = json_array_size(json);
    if (!json_is_array(json))
        return camber_property_check_output(c, property, json);
    for (size_t i = 0; name && i < sizeof operators / sizeof *operators; i++)
        if (strcmp(name, operators[i].name) == 0)
            return check_operands(c, property, json, operators[i].first, operators[i].step);
    const bool literal = name && strcmp(name, "literal") == 0;
    if (!name || !(literal || strcmp(name, "let") == 0))
        return true;
    camber_compiler_enter_index(c, count - 1);
    const json_t *last = json_array_get(json, count - 1);
    if (!(literal ? camber_property_check_output(c, property, last) : check_outputs(c, property, last)))
        return false;
    camber_compiler_leave(c);
    return true;
}

/* ---- Values ---- */

/* Whether it is a list and not an expression. A list of names does not begin with the name of an operator. */
static bool is_list(const camber_property *property, const json_t *json) {
    const char *first = json_string_value(json_array_get(json, 0));
    const bool names = property->item == CAMBER_TYPE_STRING || property->type == CAMBER_TYPE_ANCHORS;
    return json_is_array(json) && (!first || (names && !camber_operator_exists(first)));
}

static bool takes_lists(camber_type type) {
    return type == CAMBER_TYPE_ARRAY || type == CAMBER_TYPE_PADDING || type == CAMBER_TYPE_ANCHORS;
}

static bool takes_constant(camber_type type, const json_t *json) {
    switch (type) {
    case CAMBER_TYPE_NUMBER:
    case CAMBER_TYPE_PADDING: return json_is_number(json);
    case CAMBER_TYPE_BOOL: return json_is_boolean(json);
    case CAMBER_TYPE_ARRAY:
    case CAMBER_TYPE_ANCHORS: return false;
    default: return json_is_string(json);
    }
}

static bool compile_list(camber_compiler *c, const json_t *json, const camber_property *property, uint32_t *root) {
    return camber_make_json_constant(c, json, root) &&
           camber_annotate(c, camber_property_typing(property), CAMBER_ANNOTATE_ASSERT, root);
}

static const char *example_of(const camber_property *property) {
    switch (property->type) {
    case CAMBER_TYPE_NUMBER: return "2";
    case CAMBER_TYPE_COLOR: return "\"#a0c4ff\"";
    case CAMBER_TYPE_BOOL: return "true";
    case CAMBER_TYPE_ARRAY: return property->item == CAMBER_TYPE_STRING ? "[\"left\", \"right\"]" : "[2, 4]";
    case CAMBER_TYPE_FORMATTED: return "\"{name}\"";
    case CAMBER_TYPE_PADDING: return "[2, 4]";
    case CAMBER_TYPE_ANCHORS: return "[\"top\", [0, 1]]";
    default: return "\"round\"";
    }
}

static bool compile_value(camber_compiler *c, json_t *json, const camber_property *property, uint32_t *root) {
    if (json_is_object(json))
        return camber_compile_function(c, json, property, root);
    if (is_list(property, json) && takes_lists(property->type) && !c->strict)
        return compile_list(c, json, property, root);
    if (json_is_string(json) && property->tokens && !c->strict)
        return camber_compile_tokens(c, json, property, root);
    if (!json_is_array(json) && !takes_constant(property->type, json) && !c->strict) {
        char name[CAMBER_TYPING_TEXT_SIZE];
        return camber_compiler_fail(c, "expected %s or an expression, found %s; write e.g. %s",
                                    camber_typing_name(camber_property_typing(property), name), camber_json_name(json),
                                    example_of(property));
    }
    const bool coerced = property->type == CAMBER_TYPE_STRING && !property->values;
    return camber_compile_as(c, json, camber_property_typing(property),
                             coerced ? CAMBER_ANNOTATE_COERCE : CAMBER_ANNOTATE_ASSERT, root);
}

bool camber_compile_property(camber_compiler *c, json_t *json, const camber_property *property,
                             camber_expression **expression) {
    uint32_t root = 0;
    if (!camber_expression_begin(c, json))
        return false;
    const bool done = compile_value(c, json, property, &root) && check_property(c, property, root) &&
                      (c->strict || is_list(property, json) || camber_is_constant(camber_node_at(c, root)) ||
                       !json_is_array(json) || check_outputs(c, property, json));
    return camber_expression_end(c, done, root, expression);
}
