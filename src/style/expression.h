/* Expressions of the style specification, compiled: an array of typed nodes, operands before operators.
 *
 *     JSON -> compiler.c (types, assertions, constant folding) with operators.c, filter.c, function.c
 *          -> camber_expression -> expression.c (evaluation, which allocates nothing)
 *
 * A new operator is a row in operators.c, a value of camber_op and its case in expression.c.
 */
#ifndef CAMBER_EXPRESSION_H
#define CAMBER_EXPRESSION_H

#include "style/number.h"
#include "style/style.h"

#include <jansson.h>

typedef enum camber_type {
    CAMBER_TYPE_VALUE = 0, /* known only when evaluated */
    CAMBER_TYPE_NULL,
    CAMBER_TYPE_BOOL,
    CAMBER_TYPE_NUMBER,
    CAMBER_TYPE_STRING,
    CAMBER_TYPE_COLOR,
    CAMBER_TYPE_ARRAY,
    CAMBER_TYPE_OBJECT,
    CAMBER_TYPE_IMAGE, /* a string that names one */
} camber_type;

typedef enum camber_op {
    CAMBER_OP_CONSTANT,
    CAMBER_OP_ARRAY, /* operands are constants; read by CAMBER_OP_IN */
    CAMBER_OP_GET,   /* index: into the style's properties; so CAMBER_OP_HAS */
    CAMBER_OP_HAS,
    CAMBER_OP_ZOOM,
    CAMBER_OP_GEOMETRY_TYPE,
    CAMBER_OP_ASSERT, /* the first operand that is of the node's type, else an error */
    CAMBER_OP_TO_NUMBER,
    CAMBER_OP_TO_STRING, /* index: of the evaluation's text that it may write */
    CAMBER_OP_TO_BOOL,
    CAMBER_OP_TO_COLOR,
    CAMBER_OP_EQUAL,
    CAMBER_OP_NOT_EQUAL,
    CAMBER_OP_LESS,
    CAMBER_OP_LESS_EQUAL,
    CAMBER_OP_GREATER,
    CAMBER_OP_GREATER_EQUAL,
    CAMBER_OP_IN,
    CAMBER_OP_NOT,
    CAMBER_OP_ALL,
    CAMBER_OP_ANY,
    CAMBER_OP_CASE,        /* condition, output, ..., otherwise */
    CAMBER_OP_MATCH,       /* input, output, ..., otherwise; index, index_count: labels, sorted */
    CAMBER_OP_COALESCE,    /* the first that is not null */
    CAMBER_OP_STEP,        /* input, output, ...; index, index_count: stops, one fewer than outputs */
    CAMBER_OP_INTERPOLATE, /* input, output, ...; index, index_count: stops, one an output; base in value.number */
    CAMBER_OP_ADD,
    CAMBER_OP_SUBTRACT,
    CAMBER_OP_MULTIPLY,
    CAMBER_OP_DIVIDE,
    CAMBER_OP_QUIET, /* false where the operand fails: comparisons of the older filters */
} camber_op;

typedef struct camber_node {
    camber_op op;
    camber_type type;
    bool reads_zoom, reads_feature; /* itself or an operand */
    uint32_t first, count;          /* operands, in links */
    uint32_t index, index_count;    /* see camber_op */
    camber_value value;             /* of a constant */
} camber_node;

typedef struct camber_label {
    const char *string; /* NULL: a number */
    double number;
    uint32_t output; /* operand of the match */
} camber_label;

struct camber_expression {
    json_t *document; /* a reference, which keeps the strings of constants and labels */
    camber_node *nodes;
    uint32_t *links;
    double *stops;
    camber_label *labels;
    char **texts; /* of folded constants */
    size_t node_count, node_capacity;
    size_t link_count, link_capacity;
    size_t stop_count, stop_capacity;
    size_t label_count, label_capacity;
    size_t text_count, text_capacity;
    uint32_t root;
    bool reads_zoom, reads_feature, reads_line_progress; /* what it depends on; none of them: a constant */
    uint32_t scratch_count; /* texts that an evaluation may write, up to CAMBER_SCRATCH_COUNT */
};

/* Conversions to text in one expression, each with room for "rgba(255,255,255,0.12345678901234567)". */
#define CAMBER_SCRATCH_COUNT 8
#define CAMBER_SCRATCH_SIZE 64

typedef struct camber_evaluation {
    double zoom, line_progress;
    const camber_feature_view *feature;  /* NULL: none, and what reads it fails */
    const char *cause;                   /* why it failed, a phrase */
    const camber_expression *expression; /* from here on set by the evaluation */
    char scratch[CAMBER_SCRATCH_COUNT][CAMBER_SCRATCH_SIZE];
} camber_evaluation;

/* feature may be NULL. What a value points to lives until the end. */
void camber_evaluation_begin(camber_evaluation *evaluation, double zoom, const camber_feature_view *feature);
void camber_evaluation_end(camber_evaluation *evaluation);
/* false: the value cannot be computed, as when a string stands where a number must. A string result lives as
 * long as the expression, the feature and the evaluation. Cost: no allocation, linear in the nodes visited. */
bool camber_expression_evaluate(const camber_expression *expression, camber_evaluation *evaluation,
                                camber_value *value);
bool camber_expression_evaluate_node(const camber_expression *expression, uint32_t node, camber_evaluation *evaluation,
                                     camber_value *value);
void camber_expression_destroy(camber_context *context, camber_expression *expression);

#endif
