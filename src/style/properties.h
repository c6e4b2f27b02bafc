/* The table of all layout and paint properties of layers. */
#ifndef CAMBER_STYLE_PROPERTIES_H
#define CAMBER_STYLE_PROPERTIES_H

#include "style/compiler.h"

typedef struct camber_property_row {
    camber_layer_kind kind;
    bool layout;             /* false: a paint property */
    bool directed;           /* depends on the line's direction */
    bool needs_line_metrics; /* its source needs "lineMetrics" */
    size_t offset;           /* of its field in camber_layer_paint. CAMBER_NO_OFFSET: it has none */
    camber_property property;
} camber_property_row;

#define CAMBER_NO_OFFSET SIZE_MAX

/* By camber_property_id. */
extern const camber_property_row camber_property_rows[CAMBER_PROPERTIES];
/* The specification's defaults, the same as property.fallback in JSON. */
extern const camber_layer_paint camber_default_paint;

/* NULL: the specification has no such property. */
const camber_property_row *camber_property_find(camber_layer_kind kind, bool layout, const char *name);
static inline camber_property_id camber_property_id_of(const camber_property_row *row) {
    return (camber_property_id)(row - camber_property_rows);
}

#endif
