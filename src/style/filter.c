/* Filters: expressions, and the older form ["==", "highway", "primary"], told apart as the specification does. */
#include "style/compiler.h"

#include <string.h>

static bool compile_filter(camber_compiler *c, json_t *json, size_t depth, uint32_t *node);

static bool is(const char *text, const char *word) {
    return text && strcmp(text, word) == 0;
}

static bool is_comparison(const char *op) {
    return is(op, "==") || is(op, "!=") || is(op, "<") || is(op, "<=") || is(op, ">") || is(op, ">=");
}

/* The specification's isExpressionFilter, of an array. all, any and none are neither: each of their operands is told
 * apart by itself, so that the two forms may stand side by side. */
static bool is_expression(const json_t *json) {
    const char *op = json_string_value(json_array_get(json, 0));
    const size_t size = json_array_size(json);
    const json_t *second = json_array_get(json, 1), *third = json_array_get(json, 2);
    if (is(op, "has"))
        return size >= 2 && !is(json_string_value(second), "$id") && !is(json_string_value(second), "$type");
    if (is(op, "in"))
        return size >= 3 && (!json_is_string(second) || json_is_array(third));
    if (is(op, "!in") || is(op, "!has"))
        return json_is_array(second) || json_is_array(third);
    if (is_comparison(op))
        return size != 3 || json_is_array(second) || json_is_array(third);
    return true;
}

static bool make_operand(camber_compiler *c, camber_op op, uint32_t *node) {
    const size_t first_operand = c->operand_count;
    return camber_push_operand(c, *node) &&
           camber_make_node(c, &(camber_node){.op = op, .type = CAMBER_TYPE_BOOL}, first_operand, node);
}

/* The key of an older filter: a property's name or $type. */
static bool compile_key(camber_compiler *c, const json_t *array, camber_op op, uint32_t *node) {
    const char *key = json_string_value(json_array_get(array, 1));
    camber_compiler_enter_index(c, 1);
    if (!key)
        return camber_compiler_fail(c, "expected a property's name; write e.g. [\"==\", \"highway\", \"primary\"]");
    if (strcmp(key, "$id") == 0)
        return camber_compiler_fail(c, "\"$id\" is not supported; filter on a property");
    camber_compiler_leave(c);
    if (strcmp(key, "$type") != 0)
        return camber_make_property(c, op, key, node);
    if (op == CAMBER_OP_HAS)
        return camber_make_constant(c, &(camber_value){.type = CAMBER_VALUE_BOOL, .boolean = true}, node);
    const camber_node type = {.op = CAMBER_OP_GEOMETRY_TYPE, .type = CAMBER_TYPE_STRING, .reads_feature = true};
    return camber_make_node(c, &type, c->operand_count, node);
}

static bool compile_value(camber_compiler *c, const json_t *array, size_t index, uint32_t *node) {
    camber_compiler_enter_index(c, index);
    if (!camber_make_json_constant(c, json_array_get(array, index), node) || !camber_push_operand(c, *node))
        return false;
    camber_compiler_leave(c);
    return true;
}

/* [op, key, value]; values of different types do not compare, and then it is false. */
static bool compile_comparison(camber_compiler *c, const json_t *array, const char *op, uint32_t *node) {
    static const struct {
        const char *name;
        camber_op op;
    } ops[] = {{"==", CAMBER_OP_EQUAL},      {"!=", CAMBER_OP_NOT_EQUAL}, {"<", CAMBER_OP_LESS},
               {"<=", CAMBER_OP_LESS_EQUAL}, {">", CAMBER_OP_GREATER},    {">=", CAMBER_OP_GREATER_EQUAL}};
    const size_t first_operand = c->operand_count;
    if (!compile_key(c, array, CAMBER_OP_GET, node) || !camber_push_operand(c, *node) ||
        !compile_value(c, array, 2, node))
        return false;
    camber_node prototype = {.type = CAMBER_TYPE_BOOL};
    for (size_t i = 0; i < sizeof ops / sizeof *ops; i++)
        if (strcmp(ops[i].name, op) == 0)
            prototype.op = ops[i].op;
    return camber_make_node(c, &prototype, first_operand, node) && make_operand(c, CAMBER_OP_QUIET, node);
}

/* ["in", key, value, ...] and !in. */
static bool compile_in(camber_compiler *c, const json_t *array, bool negated, uint32_t *node) {
    const size_t first_operand = c->operand_count;
    if (!compile_key(c, array, CAMBER_OP_GET, node) || !camber_push_operand(c, *node))
        return false;
    for (size_t i = 2; i < json_array_size(array); i++)
        if (!compile_value(c, array, i, node))
            return false;
    const camber_node list = {.op = CAMBER_OP_ARRAY, .type = CAMBER_TYPE_ARRAY};
    const camber_node in = {.op = CAMBER_OP_IN, .type = CAMBER_TYPE_BOOL};
    return camber_make_node(c, &list, first_operand + 1, node) && camber_push_operand(c, *node) &&
           camber_make_node(c, &in, first_operand, node) && (!negated || make_operand(c, CAMBER_OP_NOT, node));
}

/* all, any and none. */
static bool compile_junction(camber_compiler *c, const json_t *array, const char *op, size_t depth, uint32_t *node) {
    const size_t first_operand = c->operand_count;
    for (size_t i = 1; i < json_array_size(array); i++) {
        camber_compiler_enter_index(c, i);
        if (!compile_filter(c, json_array_get(array, i), depth + 1, node) || !camber_push_operand(c, *node))
            return false;
        camber_compiler_leave(c);
    }
    const camber_node junction = {.op = is(op, "all") ? CAMBER_OP_ALL : CAMBER_OP_ANY, .type = CAMBER_TYPE_BOOL};
    return camber_make_node(c, &junction, first_operand, node) &&
           (!is(op, "none") || make_operand(c, CAMBER_OP_NOT, node));
}

static bool compile_filter(camber_compiler *c, json_t *json, size_t depth, uint32_t *node) {
    if (depth >= CAMBER_EXPRESSION_DEPTH)
        return camber_compiler_fail(c, "nested deeper than %d levels; flatten the filter", CAMBER_EXPRESSION_DEPTH);
    if (!json_is_array(json) && !json_is_boolean(json))
        return camber_compiler_fail(
            c, "expected a filter, found %s; write e.g. [\"==\", [\"get\", \"highway\"], \"primary\"]",
            camber_json_name(json));
    const char *op = json_string_value(json_array_get(json, 0));
    if (is(op, "all") || is(op, "any") || is(op, "none"))
        return compile_junction(c, json, op, depth, node);
    if (json_is_array(json) && json_array_size(json) == 0)
        return camber_make_constant(c, &(camber_value){.type = CAMBER_VALUE_BOOL, .boolean = true}, node);
    if (json_is_boolean(json) || is_expression(json)) {
        c->depth = depth;
        return camber_compile(c, json, CAMBER_TYPE_BOOL, node);
    }
    if (json_array_size(json) < 2)
        return camber_compiler_fail(
            c, "\"%s\" without a property's name; write e.g. [\"==\", \"highway\", \"primary\"]", op);
    if (is(op, "has"))
        return compile_key(c, json, CAMBER_OP_HAS, node);
    if (is(op, "!has"))
        return compile_key(c, json, CAMBER_OP_HAS, node) && make_operand(c, CAMBER_OP_NOT, node);
    if (is(op, "in") || is(op, "!in"))
        return compile_in(c, json, op[0] == '!', node);
    return compile_comparison(c, json, op, node);
}

bool camber_compile_filter(camber_compiler *c, json_t *json, camber_expression **expression) {
    uint32_t root = 0;
    if (!camber_expression_begin(c, json))
        return false;
    const bool done = compile_filter(c, json, 0, &root);
    return camber_expression_end(c, done, root, expression);
}

/* ---- Polygons ---- */

static bool names_polygon(const json_t *json) {
    const char *text = json_string_value(json);
    if (is(text, "Polygon") || is(text, "MultiPolygon"))
        return true;
    for (size_t i = 0; i < json_array_size(json); i++)
        if (names_polygon(json_array_get(json, i)))
            return true;
    return false;
}

static bool is_geometry_type(const json_t *json) {
    return is(json_string_value(json), "$type") || is(json_string_value(json_array_get(json, 0)), "geometry-type");
}

bool camber_filter_asks_polygons(const json_t *json) {
    const char *op = json_string_value(json_array_get(json, 0));
    if (!op || op[0] == '!' || is(op, "none"))
        return false;
    bool about_type = false, asks = false;
    for (size_t i = 1; i < json_array_size(json); i++)
        about_type = about_type || is_geometry_type(json_array_get(json, i));
    for (size_t i = 1; i < json_array_size(json) && !asks; i++)
        asks =
            about_type ? names_polygon(json_array_get(json, i)) : camber_filter_asks_polygons(json_array_get(json, i));
    return asks;
}
