/* The compiler turns JSON into expressions. It knows where in the document it is, for messages. Only src/style
 * includes this. */
#ifndef CAMBER_STYLE_COMPILER_H
#define CAMBER_STYLE_COMPILER_H

#include "style/evaluation.h"
#include "style/json.h"

/* Deepest nesting of an expression: compilation recurses that far. */
#define CAMBER_EXPRESSION_DEPTH 200
/* Most nodes on a way down through an expression and its variables: evaluation recurses that far. */
#define CAMBER_NODE_HEIGHT 1000
/* "/layers/3/paint/line-width", and an expression's path behind it. */
#define CAMBER_PATH_DEPTH (CAMBER_EXPRESSION_DEPTH + 16)
/* Most feature properties that a style may read. */
#define CAMBER_PROPERTY_LIMIT 1024
/* Most variables that an expression may bind. */
#define CAMBER_BINDING_LIMIT 4096
/* Memory and work that the constants of all expressions of a compiler may take to be folded. */
#define CAMBER_FOLD_LIMIT ((size_t)64 << 20)
#define CAMBER_FOLD_WORK_LIMIT (10u * CAMBER_WORK_LIMIT)

/* Warnings of constants in expressions that a property cannot have. */
#define CAMBER_HELD_LIMIT 32

typedef struct camber_path_step {
    const char *key; /* NULL: index */
    size_t index;
} camber_path_step;

/* A property's type in the specification. */
typedef struct camber_property {
    const char *name;
    camber_type type;          /* bool, number, string, color, array, image, formatted, padding or anchors */
    camber_type item;          /* type of an array's items */
    uint32_t length;           /* length of an array. 0: any */
    const char *const *values; /* an enum: what a string, or an array's item, may be, NULL at the end. NULL: anything */
    const char *fallback;      /* the default as JSON, "1" or "\"butt\"". NULL: none */
    bool interpolated;         /* curves on zoom are allowed, and what older functions are without a type */
    bool data_driven;          /* may read the feature */
    bool without_zoom;         /* may not read the zoom */
    bool line_progress;        /* may read the line's progress */
    bool tokens;               /* "{name}" in strings of older functions stands for a property */
    double low, high;          /* range of a number or of an array's items. Both 0: any */
} camber_property;

typedef struct camber_binding {
    const char *name;
    uint32_t node, slot;
    uint32_t next; /* another with the same hash, bound before; CAMBER_BINDING_LIMIT: none */
} camber_binding;

#define CAMBER_BINDING_HEADS 512

typedef struct camber_compiler camber_compiler;

struct camber_compiler {
    camber_context *context;
    camber_style *style;             /* gets the properties that are read */
    camber_property_readers readers; /* of what the layer that is read reads properties. 0: none reads */
    const char *name;                /* name of the document */
    camber_status status;
    camber_path_step path[CAMBER_PATH_DEPTH];
    size_t path_length;
    camber_expression *expression; /* under construction */
    size_t depth;
    uint32_t *operands; /* a stack: those of the nodes under construction */
    size_t operand_count, operand_capacity;
    camber_binding *bindings; /* a stack: the variables in scope */
    uint32_t *binding_heads;  /* CAMBER_BINDING_HEADS */
    size_t binding_count, binding_capacity;
    uint32_t *property_slots; /* a hash of the style's properties: index + 1 */
    size_t folded_bytes;
    uint32_t folded_work;
    const json_t *state; /* an object of what "global-state" reads. NULL: nothing */
    bool state_defaults; /* its members are {"default": value}, as a style's are */
    unsigned held_count; /* warnings of constants that are held to their range; CAMBER_HELD_LIMIT at most */
    bool checks;         /* a style is checked: what is drawn as it says may be told, too, where it may surprise */
    bool strict;         /* what stands for a property is an expression or a function: no list, no enum's names */
    /* Receives messages instead of the log; path tells where. NULL: the log */
    void (*report)(void *user, const camber_compiler *c, camber_log_level level, const char *message);
    void *report_user;
};

/* How an operand of unknown type becomes one of the expected type. */
typedef enum camber_annotation {
    CAMBER_ANNOTATE_ASSERT = 0,
    CAMBER_ANNOTATE_COERCE,
    CAMBER_ANNOTATE_OMIT, /* an operator around it converts it */
} camber_annotation;

/* Enter and leave steps of the path. They are left only on success: after a failure nothing follows. */
void camber_compiler_enter_key(camber_compiler *c, const char *key);
void camber_compiler_enter_index(camber_compiler *c, size_t index);
void camber_compiler_leave(camber_compiler *c);
/* Frees what the compiler has of its own. */
void camber_compiler_end(camber_compiler *c);
/* pointer.c: writes the path as a JSON pointer (RFC 6901), with "..." for the middle of more than 180 bytes. */
#define CAMBER_POINTER_SIZE 192
void camber_compiler_write_pointer(const camber_compiler *c, char pointer[CAMBER_POINTER_SIZE]);
/* Logs "NAME: /pointer: " and the message, and sets the status. Returns false. */
bool camber_compiler_fail(camber_compiler *c, const char *format, ...) CAMBER_PRINTF(2, 3);
/* Logs that memory ran out, for callees that do not log it themselves, such as jansson. */
bool camber_compiler_fail_memory(camber_compiler *c);
void camber_compiler_warn(camber_compiler *c, const char *format, ...) CAMBER_PRINTF(2, 3);

/* A value of a property: a constant, an expression or an older function. NULL in *expression on failure. */
bool camber_compile_property(camber_compiler *c, json_t *json, const camber_property *property,
                             camber_expression **expression);
/* filter.c: an expression or an older filter. */
bool camber_compile_filter(camber_compiler *c, json_t *json, camber_expression **expression);
/* Whether features of a type of geometry, "Polygon" or another one, may pass the filter. Call it on filters that
 * compile. */
bool camber_filter_may_take(const json_t *json, const char *type);

/* ---- For operators_*.c, filter.c, function.c and property.c ---- */

/* An empty expression to compile into; afterwards camber_expression_end hands it over or frees it. */
bool camber_expression_begin(camber_compiler *c, json_t *json);
bool camber_expression_end(camber_compiler *c, bool done, uint32_t root, camber_expression **expression);
/* Keeps a document whose strings constants point to. */
bool camber_expression_keep(camber_compiler *c, json_t *json);

bool camber_compile_as(camber_compiler *c, json_t *json, camber_typing expected, camber_annotation annotation,
                       uint32_t *node);
bool camber_compile(camber_compiler *c, json_t *json, camber_typing expected, uint32_t *node);
/* Compiles element index of array, annotated, and keeps the path in step. */
bool camber_compile_element(camber_compiler *c, const json_t *array, size_t index, camber_typing expected,
                            uint32_t *node);
/* Does the same and pushes the node as an operand. */
bool camber_compile_operand(camber_compiler *c, const json_t *array, size_t index, camber_typing expected);
/* Does the same, but an element of unknown type stays unknown: an operator around it converts it. */
bool camber_compile_loose_operand(camber_compiler *c, const json_t *array, size_t index, camber_typing expected);
/* Wraps node so that it has the expected type, or fails; constants stay constants. */
bool camber_annotate(camber_compiler *c, camber_typing expected, camber_annotation annotation, uint32_t *node);

/* The function that makes a value of the type of any other one, or fails. */
camber_evaluate_fn *camber_conversion_to(camber_type type);

bool camber_push_operand(camber_compiler *c, uint32_t node);
/* Makes a node of the operands past the first_operand-th, and pops them. */
bool camber_make_node(camber_compiler *c, const camber_node *prototype, size_t first_operand, uint32_t *node);
/* Wraps node into a node that has it as its only operand. */
bool camber_wrap_node(camber_compiler *c, camber_evaluate_fn *evaluate, camber_typing type, uint32_t *node);
bool camber_make_constant(camber_compiler *c, const camber_value *value, camber_typing type, uint32_t *node);
bool camber_make_json_constant(camber_compiler *c, const json_t *json, uint32_t *node);
/* Makes a node that reads a property of the feature, which the style then collects. evaluate: that of get or has. */
bool camber_make_property(camber_compiler *c, camber_evaluate_fn *evaluate, const char *name, uint32_t *node);
/* Makes a node without operands that reads the feature, the zoom or line-progress. */
bool camber_make_reader(camber_compiler *c, camber_evaluate_fn *evaluate, camber_type type, uint32_t *node);
bool camber_push_stop(camber_compiler *c, double stop);
bool camber_push_label(camber_compiler *c, const camber_match_label *label);
/* Sorts the labels from the first-th on; fails where one occurs twice and each must be one. */
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
/* function.c: {"stops": ..., "property": ..., "base": ..., "type": ..., "default": ..., "colorSpace": ...}. */
bool camber_compile_function(camber_compiler *c, json_t *object, const camber_property *property, uint32_t *node);
/* Compiles a string in which {name} stands for the property of that name. */
bool camber_compile_tokens(camber_compiler *c, const json_t *json, const camber_property *property, uint32_t *node);
/* property.c */
camber_typing camber_property_typing(const camber_property *property);
/* Whether the property may have the value: its names and ranges. */
bool camber_property_check(camber_compiler *c, const camber_property *property, const camber_value *value);
/* The same of a constant that an expression may result in. An array that is out of range has no meaning. */
bool camber_property_check_output(camber_compiler *c, const camber_property *property, const json_t *json);

#endif
