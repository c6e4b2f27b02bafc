/* The compiler turns JSON into expressions. It tracks its position in the document for messages. Only src/style
 * includes this. */
#ifndef CAMBER_STYLE_COMPILER_H
#define CAMBER_STYLE_COMPILER_H

#include "style/evaluation.h"
#include "style/json.h"

/* Deepest nesting of an expression. Compilation recurses to this depth. */
#define CAMBER_EXPRESSION_DEPTH 200
/* Most nodes on a path down through an expression and its variables. Evaluation recurses to this depth. */
#define CAMBER_NODE_HEIGHT 1000
/* Deepest path: "/layers/3/paint/line-width", followed by the path within an expression. */
#define CAMBER_PATH_DEPTH (CAMBER_EXPRESSION_DEPTH + 16)
/* Most feature properties that a style may read. */
#define CAMBER_PROPERTY_LIMIT 1024
/* Most variables that an expression may bind. */
#define CAMBER_BINDING_LIMIT 4096
/* Memory and work for folding the constants of all expressions of a compiler. */
#define CAMBER_FOLD_LIMIT ((size_t)64 << 20)
#define CAMBER_FOLD_WORK_LIMIT (10u * CAMBER_WORK_LIMIT)

/* Most warnings about constants in expressions: values that a property cannot have, and stops that are repeated. */
#define CAMBER_CONSTANT_WARNING_LIMIT 32

typedef struct camber_path_step {
    const char *key; /* NULL: the step is an index */
    size_t index;
} camber_path_step;

/* A property as the specification defines it. */
typedef struct camber_property {
    const char *name;
    camber_type type;          /* bool, number, string, color, array, image, formatted, padding or anchors */
    camber_type item;          /* type of an array's items */
    uint32_t length;           /* length of an array. 0: any */
    const char *const *values; /* the values of an enum, or of an array's items, NULL at the end. NULL: any string */
    const char *fallback;      /* the default as JSON, "1" or "\"butt\"". NULL: none */
    bool interpolated;         /* zoom curves may interpolate, as functions without a type do */
    bool data_driven;          /* may read the feature */
    bool without_zoom;         /* may not read the zoom */
    bool line_progress;        /* may read the line's progress */
    bool tokens;               /* in strings of older functions, {name} is replaced by that property */
    double low, high;          /* range of a number or of an array's items. Both 0: any */
} camber_property;

typedef struct camber_binding {
    const char *name;
    uint32_t node, slot;
    uint32_t next; /* another variable with the same hash, bound earlier; CAMBER_BINDING_LIMIT: none */
} camber_binding;

#define CAMBER_BINDING_HEADS 512

typedef struct camber_compiler camber_compiler;

struct camber_compiler {
    camber_context *context;
    camber_style *style;             /* collects the properties that expressions read */
    camber_property_readers readers; /* kinds of features that the current layer reads; 0 outside layers */
    const char *name;                /* the document's name, for messages */
    camber_status status;
    camber_path_step path[CAMBER_PATH_DEPTH];
    size_t path_length;
    camber_expression *expression; /* under construction */
    size_t depth;
    uint32_t *operands; /* a stack: operands of the nodes under construction */
    size_t operand_count, operand_capacity;
    camber_binding *bindings; /* a stack: the variables in scope */
    uint32_t *binding_heads;  /* CAMBER_BINDING_HEADS */
    size_t binding_count, binding_capacity;
    uint32_t *property_slots; /* a hash table of the style's properties: index + 1 */
    size_t folded_bytes;
    uint32_t folded_work;
    const json_t *state;        /* an object with the values of "global-state". NULL: no values */
    bool state_defaults;        /* its members are {"default": value}, as in a style */
    unsigned constant_warnings; /* warnings about constants so far, at most CAMBER_CONSTANT_WARNING_LIMIT */
    bool leaves_out;            /* the current layer has an operator that is not supported, so it is left out */
    bool checks;                /* a style is being checked: also warn about valid values that may surprise */
    bool strict; /* a property must be an expression or a function: no plain lists, no check of enum values */
    /* Receives messages instead of the log; path has the position. NULL: messages are logged */
    void (*report)(void *user, const camber_compiler *c, camber_log_level level, const char *message);
    void *report_user;
};

/* How an operand of unknown type is made to have the expected type. */
typedef enum camber_annotation {
    CAMBER_ANNOTATE_ASSERT = 0,
    CAMBER_ANNOTATE_COERCE,
    CAMBER_ANNOTATE_OMIT, /* it stays unknown, because an enclosing operator converts it */
} camber_annotation;

/* Enter and leave steps of the path. A step is left only on success, so that the path shows where a failure happened.
 */
void camber_compiler_enter_key(camber_compiler *c, const char *key);
void camber_compiler_enter_index(camber_compiler *c, size_t index);
void camber_compiler_leave(camber_compiler *c);
/* Frees the compiler's own memory. */
void camber_compiler_end(camber_compiler *c);
/* pointer.c: writes the path as a JSON pointer (RFC 6901), with "..." for the middle of more than 180 bytes. */
#define CAMBER_POINTER_SIZE 192
void camber_compiler_write_pointer(const camber_compiler *c, char pointer[CAMBER_POINTER_SIZE]);
/* Logs "NAME: /pointer: " and the message, and sets the status. Returns false. */
bool camber_compiler_fail(camber_compiler *c, const char *format, ...) CAMBER_PRINTF(2, 3);
/* Logs that memory ran out, for functions such as jansson's that do not log it themselves. */
bool camber_compiler_fail_memory(camber_compiler *c);
void camber_compiler_warn(camber_compiler *c, const char *format, ...) CAMBER_PRINTF(2, 3);

/* Compiles a property's value: a constant, an expression or an older function. On failure, *expression is NULL. */
bool camber_compile_property(camber_compiler *c, json_t *json, const camber_property *property,
                             camber_expression **expression);
/* filter.c: compiles a filter, which is an expression or has the older form. */
bool camber_compile_filter(camber_compiler *c, json_t *json, camber_expression **expression);
/* Whether features of a geometry type, such as "Polygon", may pass the filter. The filter must have compiled. */
bool camber_filter_may_take(const json_t *json, const char *type);

/* ---- For operators_*.c, filter.c, function.c and property.c ---- */

/* Creates an empty expression to compile into. Afterwards camber_expression_end returns it, or frees it after a
 * failure. */
bool camber_expression_begin(camber_compiler *c, json_t *json);
bool camber_expression_end(camber_compiler *c, bool done, uint32_t root, camber_expression **expression);
/* Keeps a document alive whose strings constants point to. */
bool camber_expression_keep(camber_compiler *c, json_t *json);

bool camber_compile_as(camber_compiler *c, json_t *json, camber_typing expected, camber_annotation annotation,
                       uint32_t *node);
bool camber_compile(camber_compiler *c, json_t *json, camber_typing expected, uint32_t *node);
/* Compiles an element of array, converts it to the expected type, and keeps track of the path. */
bool camber_compile_element(camber_compiler *c, const json_t *array, size_t index, camber_typing expected,
                            uint32_t *node);
/* Does the same and pushes the node as an operand. */
bool camber_compile_operand(camber_compiler *c, const json_t *array, size_t index, camber_typing expected);
/* Does the same, but an element of unknown type stays unknown, because an enclosing operator converts it. */
bool camber_compile_loose_operand(camber_compiler *c, const json_t *array, size_t index, camber_typing expected);
/* Wraps node so that it has the expected type, or fails. Constants stay constants. */
bool camber_annotate(camber_compiler *c, camber_typing expected, camber_annotation annotation, uint32_t *node);

/* Returns the function that converts any value to this type, or fails to. */
camber_evaluate_fn *camber_conversion_to(camber_type type);

bool camber_push_operand(camber_compiler *c, uint32_t node);
/* Makes a node whose operands are those from first_operand on, and pops them. */
bool camber_make_node(camber_compiler *c, const camber_node *prototype, size_t first_operand, uint32_t *node);
/* Makes a node that has node as its only operand. */
bool camber_wrap_node(camber_compiler *c, camber_evaluate_fn *evaluate, camber_typing type, uint32_t *node);
bool camber_make_constant(camber_compiler *c, const camber_value *value, camber_typing type, uint32_t *node);
bool camber_make_json_constant(camber_compiler *c, const json_t *json, uint32_t *node);
/* Makes a node that reads a property of the feature, and adds the property to the style's. evaluate: the function of
 * get or of has. */
bool camber_make_property(camber_compiler *c, camber_evaluate_fn *evaluate, const char *name, uint32_t *node);
/* Makes a node without operands that reads the feature, the zoom or line-progress. */
bool camber_make_reader(camber_compiler *c, camber_evaluate_fn *evaluate, camber_type type, uint32_t *node);
bool camber_push_stop(camber_compiler *c, double stop);
bool camber_push_label(camber_compiler *c, const camber_match_label *label);
/* Sorts the labels from index first on. With unique, fails if a label occurs twice. */
bool camber_sort_labels(camber_compiler *c, size_t first, bool unique);
camber_node *camber_node_at(camber_compiler *c, uint32_t node);

/* The variables in scope. */
bool camber_bind(camber_compiler *c, const char *name, uint32_t node);
void camber_unbind(camber_compiler *c, size_t count);
const camber_binding *camber_find_binding(const camber_compiler *c, const char *name);

/* Compiles the expression [operator, operand, ...]. */
bool camber_compile_operator(camber_compiler *c, json_t *array, camber_typing expected, uint32_t *node);
/* Whether there is an operator of this name. */
bool camber_operator_exists(const char *name);
/* function.c: compiles {"stops": ..., "property": ..., "base": ..., "type": ..., "default": ..., "colorSpace": ...}. */
bool camber_compile_function(camber_compiler *c, json_t *object, const camber_property *property, uint32_t *node);
/* Compiles a string in which {name} is replaced by the property of that name. */
bool camber_compile_tokens(camber_compiler *c, const json_t *json, const camber_property *property, uint32_t *node);
/* property.c */
camber_typing camber_property_typing(const camber_property *property);
/* Checks that the property may have the value, by its enum and its range. */
bool camber_property_check(camber_compiler *c, const camber_property *property, const camber_value *value);
/* Does the same for a constant that an expression may return, but only warns. It fails for arrays that are out of
 * range, because they have no meaning. */
bool camber_property_check_output(camber_compiler *c, const camber_property *property, const json_t *json);

#endif
