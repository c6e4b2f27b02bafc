/* Evaluation as operators see it: how operands are evaluated, and the functions that the compiler puts into nodes. Only
 * src/style includes this. */
#ifndef CAMBER_STYLE_EVALUATION_H
#define CAMBER_STYLE_EVALUATION_H

#include "style/expression.h"

/* The compiler limits how deeply nodes are nested, and therefore also the recursion here. */
static inline bool camber_evaluate_node(camber_evaluation *e, uint32_t node, camber_value *value) {
    const camber_node *at = &e->expression->nodes[node];
    return at->evaluate(e, at, value);
}
bool camber_evaluate_fail(camber_evaluation *e, const char *cause);
bool camber_evaluate_no_memory(camber_evaluation *e);
/* Counts work. false: the limit is exceeded. */
bool camber_evaluate_work(camber_evaluation *e, size_t amount);

static inline bool camber_evaluate_operand(camber_evaluation *e, const camber_node *node, uint32_t operand,
                                           camber_value *value) {
    return camber_evaluate_node(e, e->expression->links[node->first + operand], value);
}
bool camber_evaluate_number(camber_evaluation *e, const camber_node *node, uint32_t operand, double *number);
bool camber_evaluate_string(camber_evaluation *e, const camber_node *node, uint32_t operand, const char **string);
bool camber_evaluate_bool(camber_evaluation *e, const camber_node *node, uint32_t operand, bool *boolean);

static inline camber_value camber_value_bool(bool boolean) {
    return (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = boolean};
}
static inline camber_value camber_value_number(double number) {
    return (camber_value){.type = CAMBER_VALUE_NUMBER, .number = number};
}
static inline camber_value camber_value_string(const char *string) {
    return (camber_value){.type = CAMBER_VALUE_STRING, .string = string};
}

/* Strict equality, without conversions. Arrays and objects are equal only to themselves. */
bool camber_values_equal(const camber_value *a, const camber_value *b);

/* ---- Evaluation functions of the nodes that the compiler makes by itself; they are in operators_*.c ---- */

camber_evaluate_fn camber_evaluate_constant, camber_evaluate_state, camber_evaluate_let, camber_evaluate_var,
    camber_evaluate_error;
/* The node's index is the property's index among the style's properties. */
camber_evaluate_fn camber_evaluate_get, camber_evaluate_has;
camber_evaluate_fn camber_evaluate_id, camber_evaluate_has_id, camber_evaluate_geometry_type, camber_evaluate_zoom,
    camber_evaluate_line_progress;
camber_evaluate_fn camber_evaluate_assert, camber_evaluate_typeof, camber_evaluate_to_string, camber_evaluate_to_color,
    camber_evaluate_to_image, camber_evaluate_to_formatted, camber_evaluate_to_padding, camber_evaluate_to_anchors;
camber_evaluate_fn camber_evaluate_collator, camber_evaluate_comparison, camber_evaluate_not, camber_evaluate_all,
    camber_evaluate_any, camber_evaluate_case, camber_evaluate_match, camber_evaluate_coalesce;
/* Whether the input is one of the node's labels. */
camber_evaluate_fn camber_evaluate_among;
/* False if the operand fails, for comparisons in older filters. */
camber_evaluate_fn camber_evaluate_quiet;
camber_evaluate_fn camber_evaluate_in, camber_evaluate_list, camber_evaluate_concat, camber_evaluate_step,
    camber_evaluate_interpolate;

static inline bool camber_is_constant(const camber_node *node) {
    return node->evaluate == camber_evaluate_constant;
}

#endif
