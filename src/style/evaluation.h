/* What the files that evaluate share. Only expression.c, convert.c, texts.c, curves.c and maths.c include this, and the
 * compiler, to fold constants. */
#ifndef CAMBER_STYLE_EVALUATION_H
#define CAMBER_STYLE_EVALUATION_H

#include "style/expression.h"

/* Heights of nodes are bounded by the compiler, and with them the recursion here. */
bool camber_evaluate_node(camber_evaluation *e, uint32_t node, camber_value *value);
bool camber_evaluate_fail(camber_evaluation *e, const char *cause);
bool camber_evaluate_no_memory(camber_evaluation *e);
/* Counts what is walked over; false past the limit. */
bool camber_evaluate_work(camber_evaluation *e, size_t amount);

static inline bool camber_evaluate_operand(camber_evaluation *e, const camber_node *node, uint32_t operand,
                                           camber_value *value) {
    return camber_evaluate_node(e, e->expression->links[node->first + operand], value);
}
bool camber_evaluate_number(camber_evaluation *e, const camber_node *node, uint32_t operand, double *number);
bool camber_evaluate_string(camber_evaluation *e, const camber_node *node, uint32_t operand, const char **string);

static inline camber_value camber_value_bool(bool boolean) {
    return (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = boolean};
}
static inline camber_value camber_value_number(double number) {
    return (camber_value){.type = CAMBER_VALUE_NUMBER, .number = number};
}
static inline camber_value camber_value_string(const char *string) {
    return (camber_value){.type = CAMBER_VALUE_STRING, .string = string};
}

/* Strict equality: no conversions; arrays and objects are only what they are. */
bool camber_values_equal(const camber_value *a, const camber_value *b);

bool camber_evaluate_conversion(camber_evaluation *e, const camber_node *node, camber_value *value);
bool camber_evaluate_text(camber_evaluation *e, const camber_node *node, camber_value *value);
bool camber_evaluate_curve(camber_evaluation *e, const camber_node *node, camber_value *value);
bool camber_evaluate_maths(camber_evaluation *e, const camber_node *node, camber_value *value);
/* A text that grows in the evaluation's memory. */
typedef struct camber_text {
    camber_evaluation *e;
    char *bytes;
    size_t length, capacity;
} camber_text;
bool camber_text_add(camber_text *text, const char *bytes, size_t length);
/* Puts a 0 behind it. */
bool camber_text_end(camber_text *text, camber_value *value);
/* convert.c: as "to-string" has it. */
bool camber_text_add_value(camber_text *text, const camber_value *value);

#endif
