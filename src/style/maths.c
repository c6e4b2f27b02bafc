/* Arithmetic and functions of numbers, when expressions are evaluated. */
#include "style/evaluation.h"

#include <math.h>

static const double ln_2 = 0.693147180559945309417, ln_10 = 2.302585092994045684018;

/* A number that is none makes the result none, which C's fmin and fmax would hide. */
static double smaller(double a, double b) {
    return isnan(a) || a < b ? a : b;
}

static double larger(double a, double b) {
    return isnan(a) || a > b ? a : b;
}

/* C has 1 where ECMAScript has no number. */
static double power(double base, double exponent) {
    return isnan(exponent) || (isinf(exponent) && fabs(base) >= 1.0 && fabs(base) <= 1.0) ? NAN : pow(base, exponent);
}

static double combine(camber_op op, double a, double b) {
    switch (op) {
    case CAMBER_OP_ADD: return a + b;
    case CAMBER_OP_SUBTRACT: return a - b;
    case CAMBER_OP_MULTIPLY: return a * b;
    case CAMBER_OP_DIVIDE: return a / b;
    case CAMBER_OP_MODULO: return fmod(a, b);
    case CAMBER_OP_POWER: return power(a, b);
    case CAMBER_OP_MIN: return smaller(a, b);
    default: return larger(a, b);
    }
}

static double apply(camber_op op, double number) {
    switch (op) {
    case CAMBER_OP_ABS: return fabs(number);
    case CAMBER_OP_ACOS: return acos(number);
    case CAMBER_OP_ASIN: return asin(number);
    case CAMBER_OP_ATAN: return atan(number);
    case CAMBER_OP_CEIL: return ceil(number);
    case CAMBER_OP_COS: return cos(number);
    case CAMBER_OP_FLOOR: return floor(number);
    case CAMBER_OP_LN: return log(number);
    case CAMBER_OP_LOG10: return log(number) / ln_10;
    case CAMBER_OP_LOG2: return log(number) / ln_2;
    case CAMBER_OP_ROUND: return round(number);
    case CAMBER_OP_SIN: return sin(number);
    case CAMBER_OP_SQRT: return sqrt(number);
    default: return tan(number);
    }
}

/* What the operator has without operands. */
static double neutral(camber_op op) {
    switch (op) {
    case CAMBER_OP_MULTIPLY: return 1.0;
    case CAMBER_OP_MIN: return HUGE_VAL;
    case CAMBER_OP_MAX: return -HUGE_VAL;
    default: return 0.0;
    }
}

bool camber_evaluate_maths(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double result = neutral(node->op), number;
    for (uint32_t i = 0; i < node->count; i++) {
        if (!camber_evaluate_number(e, node, i, &number))
            return false;
        result = i == 0 ? number : combine(node->op, result, number);
    }
    if (node->op >= CAMBER_OP_ABS)
        result = apply(node->op, result);
    else if (node->op == CAMBER_OP_SUBTRACT && node->count == 1)
        result = -result;
    *value = camber_value_number(result);
    return true;
}
