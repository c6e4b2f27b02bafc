/* Values of expressions and of features' properties. */
#ifndef CAMBER_FEATURES_VALUE_H
#define CAMBER_FEATURES_VALUE_H

#include "base/base.h"

typedef enum camber_value_type {
    CAMBER_VALUE_NULL = 0, /* null, or the feature does not have the property */
    CAMBER_VALUE_BOOL,
    CAMBER_VALUE_NUMBER,
    CAMBER_VALUE_STRING,
    CAMBER_VALUE_COLOR, /* from expressions only, never from features */
    CAMBER_VALUE_ARRAY,
    CAMBER_VALUE_OBJECT,
    CAMBER_VALUE_FORMATTED, /* a text in sections, from expressions; never from features */
} camber_value_type;

typedef struct camber_value camber_value;
typedef struct camber_member camber_member;
typedef struct camber_text_section camber_text_section; /* style/section.h */

/* A value of an expression or of a property. It does not own the memory that it points to. */
struct camber_value {
    camber_value_type type;
    uint32_t count; /* the number of items in an array, members in an object or sections in a formatted text */
    bool boolean;   /* for a null: the feature has the property, but it is null; for a string: it names an image */
    double number;
    union {
        const char *string; /* UTF-8 */
        const camber_value *items;
        const camber_member *members; /* sorted by key, in the order of strcmp; each key once */
        camber_color color;
        const camber_text_section *sections;
    };
};

struct camber_member {
    const char *key;
    uint32_t position; /* the member's position in the document, which the order in texts follows */
    camber_value value;
};

/* Stands for infinities and for numbers too large for a double, which JSON cannot express. */
#define CAMBER_JSON_INFINITE 1e308

/* Returns the object's value for the key, or NULL if it has none. Cost: a binary search. */
const camber_value *camber_object_get(const camber_value *object, const char *key);

#endif
