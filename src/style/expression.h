/* Expressions of the style specification, compiled: an array of typed nodes, operands before operators.
 *
 *     JSON -> compiler.c (types, assertions, constant folding) with operators*.c, filter.c, function.c
 *          -> camber_expression -> expression.c with convert.c, texts.c, curves.c, maths.c (evaluation)
 *
 * A new operator is a row in a table of operators*.c, a value of camber_op and its case where its kind is evaluated.
 */
#ifndef CAMBER_STYLE_EXPRESSION_H
#define CAMBER_STYLE_EXPRESSION_H

#include "style/arena.h"
#include "style/number.h"
#include "style/style.h"
#include "style/typing.h"

#include <jansson.h>

typedef enum camber_op {
    CAMBER_OP_CONSTANT,
    CAMBER_OP_STATE, /* value: of the style's state; no constant to types */
    CAMBER_OP_GET,   /* index: into the style's properties; so CAMBER_OP_HAS */
    CAMBER_OP_HAS,
    CAMBER_OP_GET_NAMED, /* a name: of any property of the feature */
    CAMBER_OP_HAS_NAMED,
    CAMBER_OP_GET_MEMBER, /* a name, an object */
    CAMBER_OP_HAS_MEMBER,
    CAMBER_OP_PROPERTIES,
    CAMBER_OP_ID,
    CAMBER_OP_HAS_ID,
    CAMBER_OP_GEOMETRY_TYPE,
    CAMBER_OP_ZOOM,
    CAMBER_OP_LINE_PROGRESS,
    CAMBER_OP_LET, /* bound nodes, then the result */
    CAMBER_OP_VAR, /* index: of the slot that keeps the value, index_count: the bound node */
    CAMBER_OP_ERROR,
    CAMBER_OP_QUIET, /* false where the operand fails: comparisons of the older filters */
    /* convert.c */
    CAMBER_OP_ASSERT, /* the first operand that is of the node's type, else an error */
    CAMBER_OP_TO_NUMBER,
    CAMBER_OP_TO_STRING,
    CAMBER_OP_TO_BOOL,
    CAMBER_OP_TO_COLOR,
    CAMBER_OP_TO_RGBA,
    CAMBER_OP_RGBA,
    CAMBER_OP_TYPEOF,
    /* Decisions */
    CAMBER_OP_COLLATOR, /* whether case and whether diacritics count */
    CAMBER_OP_EQUAL,    /* these six: two sides and perhaps a collator */
    CAMBER_OP_NOT_EQUAL,
    CAMBER_OP_LESS,
    CAMBER_OP_LESS_EQUAL,
    CAMBER_OP_GREATER,
    CAMBER_OP_GREATER_EQUAL,
    CAMBER_OP_NOT,
    CAMBER_OP_ALL,
    CAMBER_OP_ANY,
    CAMBER_OP_CASE,     /* condition, output, ..., otherwise */
    CAMBER_OP_MATCH,    /* input, output, ..., otherwise; index, index_count: labels, sorted */
    CAMBER_OP_AMONG,    /* input; index, index_count: labels, sorted */
    CAMBER_OP_COALESCE, /* the first that is not null, nor an image that is not there */
    /* texts.c */
    CAMBER_OP_IN,
    CAMBER_OP_INDEX_OF,
    CAMBER_OP_AT,
    CAMBER_OP_SLICE,
    CAMBER_OP_LENGTH,
    CAMBER_OP_LIST, /* an array of the operands */
    CAMBER_OP_SPLIT,
    CAMBER_OP_JOIN,
    CAMBER_OP_CONCAT,
    CAMBER_OP_UPCASE,
    CAMBER_OP_DOWNCASE,
    /* curves.c */
    CAMBER_OP_STEP,        /* input, output, ...; index, index_count: stops, one fewer than outputs */
    CAMBER_OP_INTERPOLATE, /* input, output, ...; index, index_count: stops, one an output; base in value.number */
    /* maths.c */
    CAMBER_OP_ADD,
    CAMBER_OP_SUBTRACT,
    CAMBER_OP_MULTIPLY,
    CAMBER_OP_DIVIDE,
    CAMBER_OP_MODULO,
    CAMBER_OP_POWER,
    CAMBER_OP_MIN,
    CAMBER_OP_MAX,
    CAMBER_OP_ABS,
    CAMBER_OP_ACOS,
    CAMBER_OP_ASIN,
    CAMBER_OP_ATAN,
    CAMBER_OP_CEIL,
    CAMBER_OP_COS,
    CAMBER_OP_FLOOR,
    CAMBER_OP_LN,
    CAMBER_OP_LOG10,
    CAMBER_OP_LOG2,
    CAMBER_OP_ROUND,
    CAMBER_OP_SIN,
    CAMBER_OP_SQRT,
    CAMBER_OP_TAN,
} camber_op;

/* How an interpolation's colours are mixed. */
typedef enum camber_color_space {
    CAMBER_SPACE_RGB = 0,
    CAMBER_SPACE_HCL,
    CAMBER_SPACE_LAB,
} camber_color_space;

typedef struct camber_node {
    camber_op op;
    bool reads_zoom, reads_feature, reads_line_progress; /* itself or an operand */
    bool bezier;     /* an interpolation along a curve, whose 4 numbers stand behind the stops */
    uint8_t space;   /* camber_color_space */
    uint16_t height; /* nodes on the longest way down, through variables too */
    camber_typing type;
    uint32_t first, count;       /* operands, in links */
    uint32_t index, index_count; /* see camber_op */
    camber_value value;          /* of a constant */
} camber_node;

typedef struct camber_label {
    const char *string; /* NULL: a number */
    double number;
    uint32_t output; /* operand of the match */
    uint32_t place;  /* in the document: its branch or stop */
} camber_label;

struct camber_expression {
    camber_context *context;
    const json_t *document; /* what it was compiled from; documents keeps it */
    json_t *documents;      /* references that keep the strings of constants and labels */
    camber_node *nodes;
    uint32_t *links;
    double *stops;
    camber_label *labels;
    camber_arena arena; /* of constants that are no scalars */
    size_t node_count, node_capacity;
    size_t link_count, link_capacity;
    size_t stop_count, stop_capacity;
    size_t label_count, label_capacity;
    uint32_t root;
    uint32_t slot_count;                                 /* values of variables that an evaluation keeps */
    bool reads_zoom, reads_feature, reads_line_progress; /* what it depends on; none of them: a constant */
};

/* An evaluation's texts and arrays, its variables among them, take so much memory at most. */
#define CAMBER_EVALUATION_LIMIT ((size_t)16 << 20)
/* Bytes and items that one evaluation walks over, at most: some tens of milliseconds. */
#define CAMBER_WORK_LIMIT 10000000u
#define CAMBER_EVALUATION_ROOM 512

typedef struct camber_evaluation {
    double zoom, line_progress;
    const camber_feature_view *feature;  /* NULL: none, and what reads it fails */
    const camber_style_images *images;   /* that there are. NULL: any that is named */
    const char *cause;                   /* why it failed, a phrase */
    const camber_expression *expression; /* from here on set by the evaluation */
    camber_arena *arena;
    camber_value *slots; /* NULL: not needed yet */
    bool *known;         /* whether a slot has its value */
    uint32_t work;
    camber_arena own;
    _Alignas(8) char room[CAMBER_EVALUATION_ROOM]; /* what own hands out first: most texts fit */
} camber_evaluation;

/* feature may be NULL. What values point to lives until the end. */
void camber_evaluation_begin(camber_evaluation *evaluation, double zoom, const camber_feature_view *feature);
void camber_evaluation_end(camber_evaluation *evaluation);
/* false: the value cannot be computed, as when a string stands where a number must. What the value points to lives as
 * long as the expression, the feature and the evaluation. Cost: linear in the nodes visited; no allocation but for
 * texts and arrays of more than CAMBER_EVALUATION_ROOM bytes. */
bool camber_expression_evaluate(const camber_expression *expression, camber_evaluation *evaluation,
                                camber_value *value);
void camber_expression_destroy(camber_context *context, camber_expression *expression);

#endif
