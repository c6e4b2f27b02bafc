/* Steps and interpolations, when expressions are evaluated. */
#include "style/evaluation.h"
#include "style/spaces.h"

#include <math.h>

static bool fail(camber_evaluation *e, const char *cause) {
    return camber_evaluate_fail(e, cause);
}

/* How many of the node's stops are at or below input. */
static uint32_t count_stops(const camber_expression *expression, const camber_node *node, double input) {
    uint32_t low = 0, high = node->index_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (expression->stops[node->index + middle] <= input)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool evaluate_input(camber_evaluation *e, const camber_node *node, double *input) {
    if (!camber_evaluate_number(e, node, 0, input))
        return false;
    return !isnan(*input) || fail(e, "a number is wanted and the value is not one");
}

static bool evaluate_step(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double input = 0.0;
    if (!evaluate_input(e, node, &input))
        return false;
    return camber_evaluate_operand(e, node, 1 + count_stops(e->expression, node, input), value);
}

/* ---- Between two stops ---- */

static bool same(double a, double b) {
    return a >= b && a <= b;
}

/* How far input is from low to high, as the specification's exponential interpolation has it. */
static double exponential(double input, double base, double low, double high) {
    double span = high - low, progress = input - low;
    if (!isfinite(span)) { /* stops so far apart that only half of it is a number */
        span = high * 0.5 - low * 0.5;
        progress = input * 0.5 - low * 0.5;
    }
    if (same(base, 1.0))
        return progress / span;
    const double factor = (pow(base, progress) - 1.0) / (pow(base, span) - 1.0);
    return isfinite(factor) ? factor : progress / span;
}

/* One coordinate of the curve from 0 to 1 with control values a and b. */
static double bezier(double a, double b, double s) {
    const double r = 1.0 - s;
    return 3.0 * r * r * s * a + 3.0 * r * s * s * b + s * s * s;
}

/* y of the curve from (0, 0) to (1, 1) at x, by halving: x grows along it. */
static double bezier_at(const double controls[4], double x) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 48; i++) {
        const double middle = 0.5 * (low + high);
        if (bezier(controls[0], controls[2], middle) < x)
            low = middle;
        else
            high = middle;
    }
    return bezier(controls[1], controls[3], high);
}

static bool mix_arrays(camber_evaluation *e, const camber_value *low, const camber_value *high, double t,
                       camber_value *value) {
    const uint32_t count = low->count;
    camber_value *items = camber_arena_alloc(e->arena, count * sizeof *items);
    if (!items)
        return camber_evaluate_no_memory(e);
    if (high->count != count)
        return fail(e, "two arrays of one length are wanted");
    for (uint32_t i = 0; i < count; i++) {
        const camber_value *a = &low->items[i], *b = &high->items[i];
        if (a->type != CAMBER_VALUE_NUMBER || b->type != CAMBER_VALUE_NUMBER)
            return fail(e, "arrays of numbers are wanted");
        items[i] = camber_value_number(a->number + t * (b->number - a->number));
    }
    *value = (camber_value){.type = CAMBER_VALUE_ARRAY, .count = count, .items = items};
    return camber_evaluate_work(e, count);
}

static bool mix(camber_evaluation *e, const camber_node *node, const camber_value *low, const camber_value *high,
                double t, camber_value *value) {
    if (low->type == CAMBER_VALUE_NUMBER && high->type == CAMBER_VALUE_NUMBER) {
        *value = camber_value_number(low->number * (1.0 - t) + high->number * t);
        return true;
    }
    if (low->type == CAMBER_VALUE_ARRAY && high->type == CAMBER_VALUE_ARRAY)
        return mix_arrays(e, low, high, t, value);
    if (low->type != CAMBER_VALUE_COLOR || high->type != CAMBER_VALUE_COLOR)
        return fail(e, "two numbers, two colours or two arrays of numbers are wanted");
    *value = (camber_value){.type = CAMBER_VALUE_COLOR,
                            .color = camber_color_mix(low->color, high->color, t, (camber_color_space)node->space)};
    return true;
}

static bool evaluate_interpolate(camber_evaluation *e, const camber_node *node, camber_value *value) {
    double input = 0.0;
    if (node->index_count > 1 && !evaluate_input(e, node, &input))
        return false;
    const double *stops = &e->expression->stops[node->index];
    const uint32_t passed = node->index_count > 1 ? count_stops(e->expression, node, input) : 0;
    if (passed == 0)
        return camber_evaluate_operand(e, node, 1, value);
    const uint32_t lower = passed - 1;
    if (passed == node->index_count || same(stops[lower], input))
        return camber_evaluate_operand(e, node, 1 + lower, value);
    camber_value low, high;
    if (!camber_evaluate_operand(e, node, 1 + lower, &low) || !camber_evaluate_operand(e, node, 2 + lower, &high))
        return false;
    double t = exponential(input, node->value.number, stops[lower], stops[lower + 1]);
    if (node->bezier)
        t = bezier_at(stops + node->index_count, t);
    return mix(e, node, &low, &high, t, value);
}

bool camber_evaluate_curve(camber_evaluation *e, const camber_node *node, camber_value *value) {
    return node->op == CAMBER_OP_STEP ? evaluate_step(e, node, value) : evaluate_interpolate(e, node, value);
}
