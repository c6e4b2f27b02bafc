/* The operators of expressions: how each is compiled. */
#ifndef CAMBER_STYLE_OPERATORS_H
#define CAMBER_STYLE_OPERATORS_H

#include "style/compiler.h"

typedef struct camber_operator camber_operator;

/* array is the expression, its operator first; its length has been checked. */
typedef bool camber_compile_fn(camber_compiler *c, const camber_operator *row, json_t *array, camber_typing expected,
                               uint32_t *node);

struct camber_operator {
    const char *name;
    camber_compile_fn *compile;
    camber_op op;
    camber_type operands; /* of all of them, where camber_compile_uniform compiles */
    camber_type result;
    size_t least, most; /* operands */
};

/* Operands of one type, a result of another. */
camber_compile_fn camber_compile_uniform;

/* operators_data.c: features, arrays, objects and strings. */
camber_compile_fn camber_compile_reader, camber_compile_get, camber_compile_state, camber_compile_literal,
    camber_compile_semiliteral, camber_compile_array, camber_compile_at, camber_compile_in, camber_compile_slice,
    camber_compile_length, camber_compile_split, camber_compile_join;

/* operators_decisions.c */
camber_compile_fn camber_compile_comparison, camber_compile_collator, camber_compile_case, camber_compile_match,
    camber_compile_coalesce, camber_compile_let, camber_compile_var;

/* operators_curves.c */
camber_compile_fn camber_compile_step, camber_compile_interpolate;

/* The type of a decision's or a curve's outputs: what is expected around it, else the first output's. */
typedef struct camber_output_type {
    camber_typing type;
    bool known;
} camber_output_type;

static inline camber_output_type camber_expect_outputs(camber_typing expected) {
    return (camber_output_type){expected, expected.type != CAMBER_TYPE_VALUE};
}
/* Pushes the output at index. */
bool camber_compile_output(camber_compiler *c, const json_t *array, size_t index, camber_output_type *type);

/* operators_decisions.c: pushes a label with the string or number that json is; all are of one type, unknown at first.
 */
bool camber_compile_label(camber_compiler *c, const json_t *json, camber_label label, camber_type *type);

#endif
