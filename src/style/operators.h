/* The operators of expressions. Each has one row, in the table of the file that compiles and evaluates it:
 *
 *     operators_inputs.c     literals, the feature, zoom, state, variables
 *     operators_types.c      assertions, conversions, colours
 *     operators_decisions.c  comparisons, all, case, match, coalesce
 *     operators_sequences.c  strings and arrays
 *     operators_curves.c     step, interpolate
 *     operators_maths.c      arithmetic and functions of a number
 *     operators_formats.c    formatted texts, images in them, and the types that only symbol layers have
 *     operators_numbers.c    numbers as texts for readers
 *
 * To add an operator, add its row there, and the functions that the row names. Only files of src/style that compile
 * expressions include this. */
#ifndef CAMBER_STYLE_OPERATORS_H
#define CAMBER_STYLE_OPERATORS_H

#include "style/compiler.h"

/* Makes a node of an expression. array has the operator first. The number of operands has already been checked. */
typedef bool camber_compile_fn(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                               uint32_t *node);

struct camber_operator {
    const char *name;
    camber_compile_fn *compile;
    camber_evaluate_fn *evaluate; /* NULL: it becomes a constant, or it is not supported */
    camber_type operands;         /* the type of all operands, if camber_compile_uniform compiles them */
    camber_type result;
    size_t least, most; /* smallest and largest number of operands */
    uint32_t variant;   /* distinguishes operators with the same functions: outcomes, or a colour space */
    double (*unary)(double);
    double (*binary)(double, double);
    double constant; /* the value of a constant, or the result if there are no operands */
};

typedef struct camber_operator_table {
    const camber_operator *rows;
    size_t count;
} camber_operator_table;

extern const camber_operator_table camber_input_operators, camber_type_operators, camber_decision_operators,
    camber_sequence_operators, camber_curve_operators, camber_maths_operators, camber_format_operators,
    camber_number_operators;

/* Short names for the rows. */
#define VALUE CAMBER_TYPE_VALUE
#define BOOL CAMBER_TYPE_BOOL
#define NUMBER CAMBER_TYPE_NUMBER
#define STRING CAMBER_TYPE_STRING
#define COLOR CAMBER_TYPE_COLOR
#define OBJECT CAMBER_TYPE_OBJECT
#define ARRAY CAMBER_TYPE_ARRAY
#define ANY_COUNT SIZE_MAX

/* Compiles operands of one type into a node with the row's result type. */
camber_compile_fn camber_compile_uniform;

/* The outcomes of a comparison. The variant of a comparison, and the index of its node, is the set of the outcomes for
 * which it is true. */
enum { CAMBER_OUTCOME_LESS = 1, CAMBER_OUTCOME_EQUAL = 2, CAMBER_OUTCOME_GREATER = 4 };

/* The type of a decision's or a curve's outputs: the expected type, if there is one, otherwise the first output's. */
typedef struct camber_output_type {
    camber_typing type;
    bool known;
} camber_output_type;

static inline camber_output_type camber_expect_outputs(camber_typing expected) {
    return (camber_output_type){expected, expected.type != CAMBER_TYPE_VALUE};
}
/* operators_decisions.c: pushes the output at index. */
bool camber_compile_output(camber_compiler *c, const json_t *array, size_t index, camber_output_type *type);
/* operators_decisions.c: pushes a label whose value is the string or number json. All labels have the same type, which
 * is unknown at first. */
bool camber_compile_label(camber_compiler *c, const json_t *json, camber_match_label label, camber_type *type);
/* operators_curves.c: whether values of the type can be interpolated. */
bool camber_is_interpolated(camber_typing type);

#endif
