/* The operators of expressions: a row each, with the function that compiles it. */
#include "style/operators.h"

#include <math.h>

bool camber_compile_uniform(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                            uint32_t *node) {
    (void)expected;
    const size_t first_operand = c->operand_count;
    for (size_t i = 1; i < json_array_size(array); i++)
        if (!camber_compile_operand(c, array, i, camber_typing_of(row->operands)))
            return false;
    return camber_make_node(c, &(camber_node){.op = row->op, .type = camber_typing_of(row->result)}, first_operand,
                            node);
}

static bool compile_none(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                         uint32_t *node) {
    return camber_compile_uniform(c, row, array, expected, node) &&
           camber_wrap_node(c, CAMBER_OP_NOT, camber_typing_of(CAMBER_TYPE_BOOL), node);
}

static bool compile_to_rgba(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                            uint32_t *node) {
    (void)expected;
    return camber_compile_element(c, array, 1, camber_typing_of(row->operands), node) &&
           camber_wrap_node(c, row->op, camber_typing_array(camber_typing_of(CAMBER_TYPE_NUMBER), 4), node);
}

static bool compile_constant(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                             uint32_t *node) {
    (void)array;
    (void)expected;
    const double number = row->name[0] == 'l'   ? 0.693147180559945309417
                          : row->name[0] == 'p' ? 3.141592653589793238463
                                                : 2.718281828459045235360;
    const camber_value value = {.type = CAMBER_VALUE_NUMBER, .number = number};
    return camber_make_constant(c, &value, camber_typing_of(CAMBER_TYPE_NUMBER), node);
}

/* Nobody sets the states of features of a picture: each is null. */
static bool compile_feature_state(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                                  uint32_t *node) {
    (void)expected;
    const camber_node prototype = {.op = row->op, .reads_feature = true};
    uint32_t name;
    return camber_compile_element(c, array, 1, camber_typing_of(row->operands), &name) &&
           camber_make_node(c, &prototype, c->operand_count, node);
}

/* What the specification has and lines have no use for. */
static bool compile_foreign(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                            uint32_t *node) {
    (void)array;
    (void)expected;
    (void)node;
    camber_compiler_enter_index(c, 0);
    return camber_compiler_fail(c, "\"%s\" is not supported for lines; leave it out", row->name);
}

static bool compile_script(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                           uint32_t *node) {
    (void)expected;
    const camber_value yes = {.type = CAMBER_VALUE_BOOL, .boolean = true};
    return camber_compile_element(c, array, 1, camber_typing_of(row->operands), node) &&
           camber_make_constant(c, &yes, camber_typing_of(CAMBER_TYPE_BOOL), node);
}

#define VALUE CAMBER_TYPE_VALUE
#define BOOL CAMBER_TYPE_BOOL
#define NUMBER CAMBER_TYPE_NUMBER
#define STRING CAMBER_TYPE_STRING
#define COLOR CAMBER_TYPE_COLOR
#define OBJECT CAMBER_TYPE_OBJECT
#define ARRAY CAMBER_TYPE_ARRAY
#define ANY_COUNT SIZE_MAX

static const camber_operator operators[] = {
    {"literal", camber_compile_literal, CAMBER_OP_CONSTANT, VALUE, VALUE, 1, 1},
    {"semiliteral", camber_compile_semiliteral, CAMBER_OP_LIST, VALUE, ARRAY, 1, 1},
    {"get", camber_compile_get, CAMBER_OP_GET, STRING, VALUE, 1, 2},
    {"has", camber_compile_get, CAMBER_OP_HAS, STRING, BOOL, 1, 2},
    {"!has", camber_compile_get, CAMBER_OP_HAS, STRING, BOOL, 1, 2},
    {"properties", camber_compile_reader, CAMBER_OP_PROPERTIES, VALUE, OBJECT, 0, 0},
    {"id", camber_compile_reader, CAMBER_OP_ID, VALUE, VALUE, 0, 0},
    {"geometry-type", camber_compile_reader, CAMBER_OP_GEOMETRY_TYPE, VALUE, STRING, 0, 0},
    {"zoom", camber_compile_reader, CAMBER_OP_ZOOM, VALUE, NUMBER, 0, 0},
    {"line-progress", camber_compile_reader, CAMBER_OP_LINE_PROGRESS, VALUE, NUMBER, 0, 0},
    {"global-state", camber_compile_state, CAMBER_OP_STATE, STRING, VALUE, 1, 1},
    {"number", camber_compile_uniform, CAMBER_OP_ASSERT, VALUE, NUMBER, 1, ANY_COUNT},
    {"string", camber_compile_uniform, CAMBER_OP_ASSERT, VALUE, STRING, 1, ANY_COUNT},
    {"boolean", camber_compile_uniform, CAMBER_OP_ASSERT, VALUE, BOOL, 1, ANY_COUNT},
    {"object", camber_compile_uniform, CAMBER_OP_ASSERT, VALUE, OBJECT, 1, ANY_COUNT},
    {"array", camber_compile_array, CAMBER_OP_ASSERT, VALUE, ARRAY, 1, ANY_COUNT},
    {"to-number", camber_compile_uniform, CAMBER_OP_TO_NUMBER, VALUE, NUMBER, 1, ANY_COUNT},
    {"to-string", camber_compile_uniform, CAMBER_OP_TO_STRING, VALUE, STRING, 1, 1},
    {"to-boolean", camber_compile_uniform, CAMBER_OP_TO_BOOL, VALUE, BOOL, 1, 1},
    {"to-color", camber_compile_uniform, CAMBER_OP_TO_COLOR, VALUE, COLOR, 1, ANY_COUNT},
    {"to-rgba", compile_to_rgba, CAMBER_OP_TO_RGBA, COLOR, ARRAY, 1, 1},
    {"rgb", camber_compile_uniform, CAMBER_OP_RGBA, NUMBER, COLOR, 3, 3},
    {"rgba", camber_compile_uniform, CAMBER_OP_RGBA, NUMBER, COLOR, 4, 4},
    {"image", camber_compile_uniform, CAMBER_OP_TO_STRING, STRING, CAMBER_TYPE_IMAGE, 1, 1},
    {"typeof", camber_compile_uniform, CAMBER_OP_TYPEOF, VALUE, STRING, 1, 1},
    {"error", camber_compile_uniform, CAMBER_OP_ERROR, STRING, CAMBER_TYPE_ERROR, 1, 1},
    {"let", camber_compile_let, CAMBER_OP_LET, VALUE, VALUE, 3, ANY_COUNT},
    {"var", camber_compile_var, CAMBER_OP_VAR, STRING, VALUE, 1, 1},
    {"==", camber_compile_comparison, CAMBER_OP_EQUAL, VALUE, BOOL, 2, 3},
    {"!=", camber_compile_comparison, CAMBER_OP_NOT_EQUAL, VALUE, BOOL, 2, 3},
    {"<", camber_compile_comparison, CAMBER_OP_LESS, VALUE, BOOL, 2, 3},
    {"<=", camber_compile_comparison, CAMBER_OP_LESS_EQUAL, VALUE, BOOL, 2, 3},
    {">", camber_compile_comparison, CAMBER_OP_GREATER, VALUE, BOOL, 2, 3},
    {">=", camber_compile_comparison, CAMBER_OP_GREATER_EQUAL, VALUE, BOOL, 2, 3},
    {"collator", camber_compile_collator, CAMBER_OP_COLLATOR, OBJECT, CAMBER_TYPE_COLLATOR, 1, 1},
    {"!", camber_compile_uniform, CAMBER_OP_NOT, BOOL, BOOL, 1, 1},
    {"all", camber_compile_uniform, CAMBER_OP_ALL, BOOL, BOOL, 0, ANY_COUNT},
    {"any", camber_compile_uniform, CAMBER_OP_ANY, BOOL, BOOL, 0, ANY_COUNT},
    {"none", compile_none, CAMBER_OP_ANY, BOOL, BOOL, 0, ANY_COUNT},
    {"case", camber_compile_case, CAMBER_OP_CASE, VALUE, VALUE, 3, ANY_COUNT},
    {"match", camber_compile_match, CAMBER_OP_MATCH, VALUE, VALUE, 4, ANY_COUNT},
    {"coalesce", camber_compile_coalesce, CAMBER_OP_COALESCE, VALUE, VALUE, 1, ANY_COUNT},
    {"at", camber_compile_at, CAMBER_OP_AT, VALUE, VALUE, 2, 2},
    {"in", camber_compile_in, CAMBER_OP_IN, VALUE, BOOL, 2, 2},
    {"!in", camber_compile_in, CAMBER_OP_IN, VALUE, BOOL, 2, 2},
    {"index-of", camber_compile_in, CAMBER_OP_INDEX_OF, VALUE, NUMBER, 2, 3},
    {"slice", camber_compile_slice, CAMBER_OP_SLICE, VALUE, VALUE, 2, 3},
    {"length", camber_compile_length, CAMBER_OP_LENGTH, VALUE, NUMBER, 1, 1},
    {"split", camber_compile_split, CAMBER_OP_SPLIT, STRING, ARRAY, 2, 2},
    {"join", camber_compile_join, CAMBER_OP_JOIN, ARRAY, STRING, 2, 2},
    {"concat", camber_compile_uniform, CAMBER_OP_CONCAT, VALUE, STRING, 0, ANY_COUNT},
    {"upcase", camber_compile_uniform, CAMBER_OP_UPCASE, STRING, STRING, 1, 1},
    {"downcase", camber_compile_uniform, CAMBER_OP_DOWNCASE, STRING, STRING, 1, 1},
    {"step", camber_compile_step, CAMBER_OP_STEP, NUMBER, VALUE, 4, ANY_COUNT},
    {"interpolate", camber_compile_interpolate, CAMBER_OP_INTERPOLATE, NUMBER, VALUE, 4, ANY_COUNT},
    {"interpolate-hcl", camber_compile_interpolate, CAMBER_OP_INTERPOLATE, NUMBER, COLOR, 4, ANY_COUNT},
    {"interpolate-lab", camber_compile_interpolate, CAMBER_OP_INTERPOLATE, NUMBER, COLOR, 4, ANY_COUNT},
    {"+", camber_compile_uniform, CAMBER_OP_ADD, NUMBER, NUMBER, 0, ANY_COUNT},
    {"-", camber_compile_uniform, CAMBER_OP_SUBTRACT, NUMBER, NUMBER, 1, 2},
    {"*", camber_compile_uniform, CAMBER_OP_MULTIPLY, NUMBER, NUMBER, 0, ANY_COUNT},
    {"/", camber_compile_uniform, CAMBER_OP_DIVIDE, NUMBER, NUMBER, 2, 2},
    {"%", camber_compile_uniform, CAMBER_OP_MODULO, NUMBER, NUMBER, 2, 2},
    {"^", camber_compile_uniform, CAMBER_OP_POWER, NUMBER, NUMBER, 2, 2},
    {"min", camber_compile_uniform, CAMBER_OP_MIN, NUMBER, NUMBER, 0, ANY_COUNT},
    {"max", camber_compile_uniform, CAMBER_OP_MAX, NUMBER, NUMBER, 0, ANY_COUNT},
    {"abs", camber_compile_uniform, CAMBER_OP_ABS, NUMBER, NUMBER, 1, 1},
    {"acos", camber_compile_uniform, CAMBER_OP_ACOS, NUMBER, NUMBER, 1, 1},
    {"asin", camber_compile_uniform, CAMBER_OP_ASIN, NUMBER, NUMBER, 1, 1},
    {"atan", camber_compile_uniform, CAMBER_OP_ATAN, NUMBER, NUMBER, 1, 1},
    {"ceil", camber_compile_uniform, CAMBER_OP_CEIL, NUMBER, NUMBER, 1, 1},
    {"cos", camber_compile_uniform, CAMBER_OP_COS, NUMBER, NUMBER, 1, 1},
    {"floor", camber_compile_uniform, CAMBER_OP_FLOOR, NUMBER, NUMBER, 1, 1},
    {"ln", camber_compile_uniform, CAMBER_OP_LN, NUMBER, NUMBER, 1, 1},
    {"log10", camber_compile_uniform, CAMBER_OP_LOG10, NUMBER, NUMBER, 1, 1},
    {"log2", camber_compile_uniform, CAMBER_OP_LOG2, NUMBER, NUMBER, 1, 1},
    {"round", camber_compile_uniform, CAMBER_OP_ROUND, NUMBER, NUMBER, 1, 1},
    {"sin", camber_compile_uniform, CAMBER_OP_SIN, NUMBER, NUMBER, 1, 1},
    {"sqrt", camber_compile_uniform, CAMBER_OP_SQRT, NUMBER, NUMBER, 1, 1},
    {"tan", camber_compile_uniform, CAMBER_OP_TAN, NUMBER, NUMBER, 1, 1},
    {"e", compile_constant, CAMBER_OP_CONSTANT, VALUE, NUMBER, 0, 0},
    {"ln2", compile_constant, CAMBER_OP_CONSTANT, VALUE, NUMBER, 0, 0},
    {"pi", compile_constant, CAMBER_OP_CONSTANT, VALUE, NUMBER, 0, 0},
    {"is-supported-script", compile_script, CAMBER_OP_CONSTANT, STRING, BOOL, 1, 1},
    {"within", compile_foreign, CAMBER_OP_CONSTANT, VALUE, BOOL, 0, ANY_COUNT},
    {"distance", compile_foreign, CAMBER_OP_CONSTANT, VALUE, NUMBER, 0, ANY_COUNT},
    {"feature-state", compile_feature_state, CAMBER_OP_STATE, STRING, VALUE, 1, 1},
    {"heatmap-density", compile_foreign, CAMBER_OP_CONSTANT, VALUE, NUMBER, 0, ANY_COUNT},
    {"elevation", compile_foreign, CAMBER_OP_CONSTANT, VALUE, NUMBER, 0, ANY_COUNT},
    {"accumulated", compile_foreign, CAMBER_OP_CONSTANT, VALUE, VALUE, 0, ANY_COUNT},
    {"format", compile_foreign, CAMBER_OP_CONSTANT, VALUE, VALUE, 0, ANY_COUNT},
    {"number-format", compile_foreign, CAMBER_OP_CONSTANT, VALUE, STRING, 0, ANY_COUNT},
    {"resolved-locale", compile_foreign, CAMBER_OP_CONSTANT, VALUE, STRING, 0, ANY_COUNT},
};

static bool fail_count(camber_compiler *c, const camber_operator *row, size_t count) {
    return camber_compiler_fail(c, "\"%s\" with %zu operand%s; it takes %zu%s", row->name, count, count == 1 ? "" : "s",
                                row->least,
                                row->most == ANY_COUNT   ? " or more"
                                : row->most > row->least ? " or one more"
                                                         : "");
}

bool camber_compile_operator(camber_compiler *c, json_t *array, camber_typing expected, uint32_t *node) {
    const char *name = json_string_value(json_array_get(array, 0));
    if (!name) {
        if (json_array_size(array) > 0)
            camber_compiler_enter_index(c, 0);
        return camber_compiler_fail(
            c, "expected an expression [operator, ...], found an array without an operator's name; "
               "write [\"literal\", [...]] for a list");
    }
    for (size_t i = 0; i < sizeof operators / sizeof *operators; i++) {
        const camber_operator *row = &operators[i];
        if (row->name[0] != name[0] || strcmp(row->name, name) != 0)
            continue;
        const size_t count = json_array_size(array) - 1;
        if (count < row->least || count > row->most)
            return fail_count(c, row, count);
        return row->compile(c, row, array, expected, node);
    }
    camber_compiler_enter_index(c, 0);
    return camber_compiler_fail(c, "unknown operator \"%.64s\"; correct it, or write [\"literal\", [...]] for a list",
                                name);
}
