/* Expressions of the style specification, compiled: an array of typed nodes, operands before operators.
 *
 *     JSON -> compiler.c (types, assertions, constant folding) with operators_*.c, filter.c, function.c
 *          -> camber_expression -> expression.c (evaluation) with operators_*.c
 *
 * Input: JSON, compiled once. Output: a value for a feature at a zoom. A node points to the function that evaluates it,
 * and that function is also what tells kinds of nodes apart. operators.h tells where a new operator goes.
 */
#ifndef CAMBER_STYLE_EXPRESSION_H
#define CAMBER_STYLE_EXPRESSION_H

#include "style/arena.h"
#include "style/number.h"
#include "style/style.h"
#include "style/typing.h"

#include <jansson.h>

typedef struct camber_node camber_node;
typedef struct camber_operator camber_operator; /* operators.h */
typedef struct camber_evaluation camber_evaluation;

/* Computes a node's value. On failure it returns false and sets the evaluation's cause. */
typedef bool camber_evaluate_fn(camber_evaluation *e, const camber_node *node, camber_value *value);

/* How an interpolation's colours are mixed. */
typedef enum camber_color_space {
    CAMBER_SPACE_RGB = 0,
    CAMBER_SPACE_HCL,
    CAMBER_SPACE_LAB,
} camber_color_space;

struct camber_node {
    camber_evaluate_fn *evaluate;
    const camber_operator *op;                           /* its row, where operands of one type were compiled */
    bool reads_zoom, reads_feature, reads_line_progress; /* itself or an operand */
    bool bezier;     /* an interpolation along a curve, whose 4 numbers stand behind the stops */
    uint8_t space;   /* camber_color_space */
    uint16_t height; /* nodes on the longest way down, through variables too */
    camber_typing type;
    uint32_t first, count; /* operands, in links */
    /* A property: index of the style's. A variable: index of the slot that keeps its value, and the bound node.
     * A comparison: the outcomes for which it holds. A match: its labels, sorted. A curve: its stops, one for each
     * output of an interpolation, one fewer for a step. */
    uint32_t index, index_count;
    camber_value value; /* a constant's value, the style's state, or an interpolation's base */
};

typedef struct camber_match_label {
    const char *string; /* NULL: a number */
    double number;
    uint32_t output;   /* operand of the match */
    uint32_t position; /* in the document: its branch or stop */
} camber_match_label;

struct camber_expression {
    camber_context *context;
    const json_t *document; /* the JSON that it was compiled from; documents keeps it */
    json_t *documents;      /* references that keep the strings of constants and labels */
    camber_node *nodes;
    uint32_t *links;
    double *stops;
    camber_match_label *labels;
    camber_arena arena; /* memory of constants that are not scalars */
    size_t node_count, node_capacity;
    size_t link_count, link_capacity;
    size_t stop_count, stop_capacity;
    size_t label_count, label_capacity;
    uint32_t root;
    uint32_t slot_count;                                 /* values of variables that an evaluation keeps */
    bool reads_zoom, reads_feature, reads_line_progress; /* all false: a constant */
};

/* An evaluation's texts and arrays, its variables among them, take so much memory at most. */
#define CAMBER_EVALUATION_LIMIT ((size_t)16 << 20)
/* Bytes and items that one evaluation walks over, at most, a number's text counted as a hundred: some tens of
 * milliseconds. */
#define CAMBER_WORK_LIMIT 10000000u
#define CAMBER_EVALUATION_ROOM 512

struct camber_evaluation {
    double zoom, line_progress;
    const camber_feature_view *feature;  /* NULL: none, and operators that read it fail */
    const camber_style_images *images;   /* images that exist. NULL: any that is named */
    const char *cause;                   /* why it failed, a phrase */
    const camber_expression *expression; /* from here on set by the evaluation */
    camber_arena *arena;
    camber_value *slots; /* NULL: not needed yet */
    bool *known;         /* whether a slot has its value */
    uint32_t work;
    camber_arena own;
    _Alignas(8) char room[CAMBER_EVALUATION_ROOM]; /* the first memory of own: most texts fit */
};

/* feature may be NULL. Memory that values point to lives until the end. */
void camber_evaluation_begin(camber_evaluation *evaluation, double zoom, const camber_feature_view *feature);
void camber_evaluation_end(camber_evaluation *evaluation);
/* Evaluates the expression. false: the value cannot be computed, as when a string stands where a number must. Memory
 * that the value points to lives as long as the expression, the feature and the evaluation. Cost: linear in the
 * nodes visited; it allocates only for texts and arrays of more than CAMBER_EVALUATION_ROOM bytes. */
bool camber_expression_evaluate(const camber_expression *expression, camber_evaluation *evaluation,
                                camber_value *value);
void camber_expression_destroy(camber_context *context, camber_expression *expression);

#endif
