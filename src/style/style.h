/* The compiled style: what the map layer asks of it. */
#ifndef CAMBER_STYLE_H
#define CAMBER_STYLE_H

#include "base/base.h"
#include "camber_map.h"
#include "style/value.h"

#include <jansson.h>

/* The style's pseudo property that a source sets to true on every feature of a layer whose schema has none of
 * the other properties that the style names, and leaves null elsewhere: such lines cannot be classified. */
#define CAMBER_PLAIN_PROPERTY "camber:plain"

/* What an expression is evaluated over. */
typedef struct camber_feature_view {
    const camber_value *values; /* style->property_count, in the order of style->properties */
    const char *geometry_type;  /* "LineString" or "Polygon" */
    camber_value id;            /* where the style wants it; null: none */
    const camber_value *all;    /* an object of all properties, where the style wants them. NULL: none */
} camber_feature_view;

typedef struct camber_expression camber_expression; /* expression.h */

typedef enum camber_layer_kind {
    CAMBER_LAYER_BACKGROUND,
    CAMBER_LAYER_LINE,
} camber_layer_kind;

typedef struct camber_style_layer {
    char *id;
    camber_layer_kind kind;
    char *source;              /* its name. NULL: any input */
    uint32_t source_index;     /* into the style's sources; CAMBER_NO_SOURCE where they do not have it */
    char *source_layer;        /* NULL: any */
    char *filter_key;          /* the filter as compact JSON, "" for none: equal keys draw equal features */
    double min_zoom, max_zoom; /* drawn where min <= zoom < max; 0 and 24 by default; 24: no end */
    bool visible;
    camber_expression *filter; /* NULL: everything */
    camber_cap cap;
    camber_join join;
    float miter_limit;
    camber_expression *color, *opacity, *width; /* NULL: the specification's default */
} camber_style_layer;

/* What no layer names: any input. */
#define CAMBER_NO_SOURCE UINT32_MAX

typedef struct camber_style_source {
    char *name;
    char *type;   /* "geojson", "vector", ... */
    json_t *json; /* a reference to the source as it stands in the document */
} camber_style_source;

struct camber_style {
    camber_context *context;
    camber_style_layer *layers; /* in drawing order */
    size_t layer_count;
    camber_style_source *sources; /* in the document's order */
    size_t source_count;
    char **properties; /* feature properties that any expression reads, each once */
    size_t property_count;
    bool wants_id;             /* an expression reads the feature's id */
    bool wants_all_properties; /* an expression reads properties that it does not name */
    bool directed; /* a line layer names what follows its lines' direction: dashes, offsets, gradients, patterns */
    bool wants_polygons; /* a line layer's filter asks for outlines: it names the geometry type Polygon */
};

/* Whether the layer draws features of this class at this zoom (visible, zoom range, filter). A filter that
 * fails to evaluate is false. */
bool camber_style_layer_matches(const camber_style_layer *layer, double zoom, const camber_feature_view *feature);

/* Paint at a zoom. feature may be NULL for a background. Width is in CSS px; the colour's alpha includes the
 * opacity. */
typedef struct camber_layer_paint {
    double width;
    camber_color color;
} camber_layer_paint;
camber_layer_paint camber_style_layer_paint(const camber_style_layer *layer, double zoom,
                                            const camber_feature_view *feature);

#endif
