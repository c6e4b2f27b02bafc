/* The static types of expressions. */
#ifndef CAMBER_STYLE_TYPING_H
#define CAMBER_STYLE_TYPING_H

#include "features/value.h"

typedef enum camber_type {
    CAMBER_TYPE_VALUE = 0, /* known only during evaluation */
    CAMBER_TYPE_NULL,
    CAMBER_TYPE_BOOL,
    CAMBER_TYPE_NUMBER,
    CAMBER_TYPE_STRING,
    CAMBER_TYPE_COLOR,
    CAMBER_TYPE_ARRAY,
    CAMBER_TYPE_OBJECT,
    CAMBER_TYPE_IMAGE, /* a string that names an image, and is marked so (value.h) */
    CAMBER_TYPE_FORMATTED,
    CAMBER_TYPE_PADDING,  /* four numbers: top, right, bottom, left */
    CAMBER_TYPE_ANCHORS,  /* an array of an anchor's name, its offset, the next name, ... */
    CAMBER_TYPE_COLLATOR, /* how strings are compared; its value is a number */
    CAMBER_TYPE_ERROR,    /* has no value, so it fits anywhere */
} camber_type;

/* Arrays nested more deeply are arrays of values. */
#define CAMBER_ARRAY_DEPTH 3
#define CAMBER_ANY_LENGTH UINT32_MAX

typedef struct camber_typing {
    camber_type type;                     /* an array if depth is not 0 */
    camber_type item;                     /* item type of the innermost array */
    uint32_t depth;                       /* how deep arrays are nested; 0: no array */
    uint32_t lengths[CAMBER_ARRAY_DEPTH]; /* the outermost first */
} camber_typing;

static inline camber_typing camber_typing_of(camber_type type) {
    return (camber_typing){.type = type};
}
camber_typing camber_typing_array(camber_typing item, uint32_t length);
/* Returns the type of an array's items. */
camber_typing camber_typing_item(camber_typing array);
/* Returns the type of an evaluated value. */
camber_typing camber_typing_of_value(const camber_value *value);

/* Returns the common type of two items: their type if it is the same, otherwise any value. Arrays have no common type.
 */
camber_typing camber_typing_merge(camber_typing a, camber_typing b);
/* Whether a value of type actual may be used where expected is required. */
bool camber_typing_fits(camber_typing expected, camber_typing actual);

/* Writes the specification's name for a type, such as "array<number, 2>". */
#define CAMBER_TYPING_TEXT_SIZE 96
const char *camber_typing_write(camber_typing typing, char text[CAMBER_TYPING_TEXT_SIZE]);
/* Returns the name of a type for messages, such as "a number" or "an array<number, 2>". */
const char *camber_typing_name(camber_typing typing, char text[CAMBER_TYPING_TEXT_SIZE]);

#endif
