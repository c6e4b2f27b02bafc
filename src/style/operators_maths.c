/* Arithmetic, functions of a number, and constants. Each has a row with the C function that computes it.
 *
 * Numbers are doubles and follow ECMAScript, whose rules for NaN sometimes differ from C's. */
#include "style/evaluation.h"
#include "style/operators.h"

#include <math.h>

static const double ln_2 = 0.693147180559945309417, ln_10 = 2.302585092994045684018;

static bool evaluate_unary(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double number;
    if (!camber_evaluate_number(e, node, 0, &number))
        return false;
    *value = camber_value_number(node->op->unary(number));
    return true;
}

/* Combines all operands from left to right. Without operands the result is the row's constant. */
static bool evaluate_chain(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double result = node->op->constant, number;
    for (uint32_t i = 0; i < node->count; i++) {
        if (!camber_evaluate_number(e, node, i, &number))
            return false;
        result = i == 0 ? number : node->op->binary(result, number);
    }
    *value = camber_value_number(result);
    return true;
}

/* With one operand the result is its negation. */
static bool evaluate_minus(camber_evaluation *e, const camber_node *node, camber_value *value) {
    if (!evaluate_chain(e, node, value))
        return false;
    if (node->count == 1)
        value->number = -value->number;
    return true;
}

static bool compile_constant(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                             uint32_t *node) {
    (void)array;
    (void)expected;
    const camber_value value = camber_value_number(row->constant);
    return camber_make_constant(c, &value, camber_typing_of(row->result), node);
}

static double add(double a, double b) {
    return a + b;
}

static double subtract(double a, double b) {
    return a - b;
}

static double multiply(double a, double b) {
    return a * b;
}

static double divide(double a, double b) {
    return a / b;
}

/* NaN makes the result NaN, which C's fmin and fmax would ignore. */
static double smaller(double a, double b) {
    return isnan(a) || a < b ? a : b;
}

static double larger(double a, double b) {
    return isnan(a) || a > b ? a : b;
}

/* C's pow returns 1 in cases in which ECMAScript returns NaN. */
static double power(double base, double exponent) {
    return isnan(exponent) || (isinf(exponent) && fabs(base) >= 1.0 && fabs(base) <= 1.0) ? NAN : pow(base, exponent);
}

static double log_10(double number) {
    return log(number) / ln_10;
}

static double log_2(double number) {
    return log(number) / ln_2;
}

#define CONSTANT compile_constant, NULL, VALUE, NUMBER, 0, 0
#define UNARY camber_compile_uniform, evaluate_unary, NUMBER, NUMBER, 1, 1
#define BINARY camber_compile_uniform, evaluate_chain, NUMBER, NUMBER, 2, 2
#define CHAIN camber_compile_uniform, evaluate_chain, NUMBER, NUMBER, 0, ANY_COUNT

static const camber_operator rows[] = {
    {"e", CONSTANT, .constant = 2.718281828459045235360},
    {"ln2", CONSTANT, .constant = 0.693147180559945309417},
    {"pi", CONSTANT, .constant = 3.141592653589793238463},
    {"+", CHAIN, .binary = add, .constant = 0.0},
    {"*", CHAIN, .binary = multiply, .constant = 1.0},
    {"min", CHAIN, .binary = smaller, .constant = HUGE_VAL},
    {"max", CHAIN, .binary = larger, .constant = -HUGE_VAL},
    {"-", camber_compile_uniform, evaluate_minus, NUMBER, NUMBER, 1, 2, .binary = subtract},
    {"/", BINARY, .binary = divide},
    {"%", BINARY, .binary = fmod},
    {"^", BINARY, .binary = power},
    {"abs", UNARY, .unary = fabs},
    {"acos", UNARY, .unary = acos},
    {"asin", UNARY, .unary = asin},
    {"atan", UNARY, .unary = atan},
    {"ceil", UNARY, .unary = ceil},
    {"cos", UNARY, .unary = cos},
    {"floor", UNARY, .unary = floor},
    {"ln", UNARY, .unary = log},
    {"log10", UNARY, .unary = log_10},
    {"log2", UNARY, .unary = log_2},
    {"round", UNARY, .unary = round},
    {"sin", UNARY, .unary = sin},
    {"sqrt", UNARY, .unary = sqrt},
    {"tan", UNARY, .unary = tan},
};

const camber_operator_table camber_maths_operators = {rows, sizeof rows / sizeof *rows};
