/* Evaluates compiled expressions: the entry point, its limits, and reading operands as a certain type. The operators
 * are evaluated in operators_*.c. */
#include "style/expression.h"

#include "style/evaluation.h"

#include <string.h>

bool camber_evaluate_fail(camber_evaluation *e, const char *cause) {
    e->cause = cause;
    return false;
}

bool camber_evaluate_no_memory(camber_evaluation *e) {
    return camber_evaluate_fail(e, "its strings and arrays take too much memory");
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
    return value.type == CAMBER_VALUE_NUMBER || camber_evaluate_fail(e, "expected a number, and the value is not one");
}

bool camber_evaluate_string(camber_evaluation *e, const camber_node *node, uint32_t operand, const char **string) {
    camber_value value;
    if (!camber_evaluate_operand(e, node, operand, &value))
        return false;
    *string = value.string;
    return value.type == CAMBER_VALUE_STRING || camber_evaluate_fail(e, "expected a string, and the value is not one");
}

bool camber_evaluate_bool(camber_evaluation *e, const camber_node *node, uint32_t operand, bool *boolean) {
    camber_value value;
    if (!camber_evaluate_operand(e, node, operand, &value))
        return false;
    *boolean = value.boolean;
    return value.type == CAMBER_VALUE_BOOL || camber_evaluate_fail(e, "expected a boolean, and the value is not one");
}

/* ---- The public functions ---- */

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
