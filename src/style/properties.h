/* The table of all layout and paint properties of layers. */
#ifndef CAMBER_STYLE_PROPERTIES_H
#define CAMBER_STYLE_PROPERTIES_H

#include "style/compiler.h"

typedef struct camber_property_row {
    camber_layer_kind kind;
    bool layout;             /* false: of the paint */
    bool directed;           /* follows its line's direction */
    bool needs_line_metrics; /* of its source layer */
    size_t offset;           /* into camber_layer_paint, where it has its type's form. CAMBER_NO_OFFSET: not there */
    camber_property property;
} camber_property_row;

#define CAMBER_NO_OFFSET SIZE_MAX

/* By camber_property_id. */
extern const camber_property_row camber_property_rows[CAMBER_PROPERTIES];
/* The specification's default, the same as property.fallback in JSON. */
extern const camber_layer_paint camber_default_paint;

/* NULL: the specification has no such property. */
const camber_property_row *camber_property_find(camber_layer_kind kind, bool layout, const char *name);
/* Stores a value in a field of the property's form: a double or doubles, a bool, a colour, dashes, or an enum in the
 * order of the property's names. false: the value is of another type, and the field is as before. */
bool camber_property_store(const camber_property_row *row, const camber_value *value, void *field);
static inline camber_property_id camber_property_id_of(const camber_property_row *row) {
    return (camber_property_id)(row - camber_property_rows);
}

#endif
