/* Values of expressions and of features' properties. */
#ifndef CAMBER_FEATURES_VALUE_H
#define CAMBER_FEATURES_VALUE_H

#include "base/base.h"

typedef enum camber_value_type {
    CAMBER_VALUE_NULL = 0, /* also: the feature does not have the property */
    CAMBER_VALUE_BOOL,
    CAMBER_VALUE_NUMBER,
    CAMBER_VALUE_STRING,
    CAMBER_VALUE_COLOR, /* from expressions; never from features */
    CAMBER_VALUE_ARRAY,
    CAMBER_VALUE_OBJECT,
    CAMBER_VALUE_FORMATTED, /* a text in sections, from expressions; never from features */
} camber_value_type;

typedef struct camber_value camber_value;
typedef struct camber_member camber_member;
typedef struct camber_text_section camber_text_section; /* style/section.h */

/* A value of an expression or of a property. It does not own the memory that it points to: its maker does. */
struct camber_value {
    camber_value_type type;
    uint32_t count; /* number of an array's items, an object's members or a formatted text's sections */
    bool boolean;   /* for a null: the feature has the property, and it is null; for a string: it names an image */
    double number;
    union {
        const char *string; /* UTF-8 */
        const camber_value *items;
        const camber_member *members; /* by key, as strcmp sorts them; each key once */
        camber_color color;
        const camber_text_section *sections;
    };
};

struct camber_member {
    const char *key;
    uint32_t position; /* position in the document, for the order in texts */
    camber_value value;
};

/* Stands in data for infinities and numbers beyond a double, which JSON does not have. */
#define CAMBER_JSON_INFINITE 1e308

/* The object's value of the key, NULL where it has none. Cost: a binary search. */
const camber_value *camber_object_get(const camber_value *object, const char *key);

#endif
