/* Compiled expressions of the style specification: an array of typed nodes, operands before operators.
 *
 *     JSON -> compiler.c (types, assertions, constant folding) with operators_*.c, filter.c, function.c
 *          -> camber_expression -> expression.c (evaluation) with operators_*.c
 *
 * Input: JSON, compiled once. Output: a value for a feature at a zoom. A node points to the function that evaluates it,
 * and this function also identifies the kind of node. operators.h says where to add a new operator. */
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

/* The colour space in which an interpolation mixes colours. */
typedef enum camber_color_space {
    CAMBER_SPACE_RGB = 0,
    CAMBER_SPACE_HCL,
    CAMBER_SPACE_LAB,
} camber_color_space;

struct camber_node {
    camber_evaluate_fn *evaluate;
    const camber_operator *op;                           /* its row, if all operands have the same type */
    bool reads_zoom, reads_feature, reads_line_progress; /* the node itself or an operand */
    bool bezier;     /* an interpolation along a Bezier curve, whose 4 numbers are after the stops */
    uint8_t space;   /* camber_color_space */
    uint16_t height; /* number of nodes on the longest path down, also through variables */
    camber_typing type;
    uint32_t first, count; /* operands, in links */
    /* Property: index among the style's. Variable: index of the slot that keeps its value, and the bound node.
     * Comparison: the outcomes for which it is true. Match: its labels, sorted. Curve: its stops; an interpolation has
     * one stop for each output, a step has one stop fewer. */
    uint32_t index, index_count;
    camber_value value; /* a constant's value, the style's state, or an interpolation's base */
};

typedef struct camber_match_label {
    const char *string; /* NULL: a number */
    double number;
    uint32_t output;   /* the operand of the match to return */
    uint32_t position; /* index in the document of its branch or stop */
} camber_match_label;

/* The most properties that a filter with a shortcut reads. */
enum { CAMBER_SHORTCUT_PROPERTIES = 24 };

/* The results of a filter for all features that have none of its properties, by type of geometry. Most features lack
 * what most filters read, and looking for the properties is quicker than evaluating. */
typedef struct camber_filter_shortcut {
    bool exists;     /* false for filters that read something else, such as the zoom */
    bool results[3]; /* points, lines, polygons */
    uint16_t count, properties[CAMBER_SHORTCUT_PROPERTIES];
} camber_filter_shortcut;

struct camber_expression {
    camber_context *context;
    const json_t *document; /* the JSON that it was compiled from; documents keeps it alive */
    json_t *documents;      /* references that keep alive the strings of constants and labels */
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
    uint32_t slot_count;                                 /* the number of variables whose values an evaluation keeps */
    bool reads_zoom, reads_feature, reads_line_progress; /* all false: a constant */
    camber_filter_shortcut shortcut;                     /* if it is a filter */
};

/* The most memory for an evaluation's texts and arrays, including its variables. */
#define CAMBER_EVALUATION_LIMIT ((size_t)16 << 20)
/* The most bytes and items that one evaluation may visit, which takes some tens of milliseconds. Formatting a number
 * counts as a hundred. */
#define CAMBER_WORK_LIMIT 10000000u
#define CAMBER_EVALUATION_ROOM 512

struct camber_evaluation {
    double zoom, line_progress;
    const camber_feature_view *feature;  /* NULL: none, and operators that read it fail */
    const camber_style_images *images;   /* images that exist. NULL: every image counts as existing */
    const char *cause;                   /* a phrase that says why it failed */
    const camber_expression *expression; /* the fields from here on are set by the evaluation */
    camber_arena *arena;
    camber_value *slots; /* NULL: not needed yet */
    bool *known;         /* whether a slot has its value */
    uint32_t work;
    camber_arena own;
    _Alignas(8) char room[CAMBER_EVALUATION_ROOM]; /* the first memory of own; most texts fit into it */
};

/* feature may be NULL. Memory that values point to is valid until camber_evaluation_end. */
void camber_evaluation_begin(camber_evaluation *evaluation, double zoom, const camber_feature_view *feature);
void camber_evaluation_end(camber_evaluation *evaluation);
/* Evaluates the expression. false: the value cannot be computed, for example because an operand is a string instead of
 * a number. Memory that the value points to is valid as long as the expression, the feature and the evaluation are.
 * Cost: linear in the number of nodes visited. It allocates memory only if texts and arrays take more than
 * CAMBER_EVALUATION_ROOM bytes. */
bool camber_expression_evaluate(const camber_expression *expression, camber_evaluation *evaluation,
                                camber_value *value);
/* Evaluates a filter; one that fails is false. */
bool camber_filter_passes(const camber_expression *filter, double zoom, const camber_feature_view *feature);
void camber_expression_destroy(camber_context *context, camber_expression *expression);

#endif
