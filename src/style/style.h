/* The compiled style, as src/map uses it. */
#ifndef CAMBER_STYLE_STYLE_H
#define CAMBER_STYLE_STYLE_H

#include "base/base.h"
#include "features/schema.h"

#include <jansson.h>

typedef struct camber_expression camber_expression; /* expression.h */

/* The images that patterns may name. */
typedef struct camber_style_images {
    uint32_t (*find)(void *user, const char *name); /* a number from 1. 0: there is no image of this name */
    void (*missing)(void *user, const char *name);
    void *user;
} camber_style_images;

typedef enum camber_layer_kind {
    CAMBER_LAYER_BACKGROUND,
    CAMBER_LAYER_LINE,
    CAMBER_LAYER_FILL,
    CAMBER_LAYER_CIRCLE,
    CAMBER_LAYER_SYMBOL,
} camber_layer_kind;

enum { CAMBER_LAYER_KINDS = CAMBER_LAYER_SYMBOL + 1 };

/* Layout and paint properties of layers, except visibility. properties.c describes each. */
typedef enum camber_property_id {
    CAMBER_LINE_CAP,
    CAMBER_LINE_JOIN,
    CAMBER_LINE_MITER_LIMIT,
    CAMBER_LINE_OFFSET,
    CAMBER_LINE_SORT_KEY,
    CAMBER_FILL_SORT_KEY,
    CAMBER_CIRCLE_SORT_KEY,
    CAMBER_LAYER_GEOMETRY, /* layers that differ in a property above share no polylines */
    CAMBER_LINE_WIDTH = CAMBER_LAYER_GEOMETRY,
    CAMBER_LINE_ROUND_LIMIT,
    CAMBER_LINE_GAP_WIDTH,
    CAMBER_LINE_BLUR,
    CAMBER_LINE_COLOR,
    CAMBER_LINE_OPACITY,
    CAMBER_LINE_LAYER_OPACITY,
    CAMBER_LINE_TRANSLATE,
    CAMBER_LINE_TRANSLATE_ANCHOR,
    CAMBER_LINE_DASHARRAY,
    CAMBER_LINE_PATTERN,
    CAMBER_LINE_GRADIENT,
    CAMBER_LINE_TRIM_OFFSET,
    CAMBER_LINE_BORDER_COLOR,
    CAMBER_LINE_BORDER_WIDTH,
    CAMBER_BACKGROUND_COLOR,
    CAMBER_BACKGROUND_OPACITY,
    CAMBER_BACKGROUND_PATTERN,
    CAMBER_FILL_ANTIALIAS,
    CAMBER_FILL_COLOR,
    CAMBER_FILL_OPACITY,
    CAMBER_FILL_LAYER_OPACITY,
    CAMBER_FILL_OUTLINE_COLOR,
    CAMBER_FILL_PATTERN,
    CAMBER_FILL_TRANSLATE,
    CAMBER_FILL_TRANSLATE_ANCHOR,
    CAMBER_CIRCLE_RADIUS,
    CAMBER_CIRCLE_COLOR,
    CAMBER_CIRCLE_BLUR,
    CAMBER_CIRCLE_OPACITY,
    CAMBER_CIRCLE_TRANSLATE,
    CAMBER_CIRCLE_TRANSLATE_ANCHOR,
    CAMBER_CIRCLE_PITCH_SCALE,
    CAMBER_CIRCLE_PITCH_ALIGNMENT,
    CAMBER_CIRCLE_STROKE_WIDTH,
    CAMBER_CIRCLE_STROKE_COLOR,
    CAMBER_CIRCLE_STROKE_OPACITY,
    /* Properties of symbol layers, which symbol.h evaluates. */
    CAMBER_SYMBOL_PLACEMENT,
    CAMBER_SYMBOL_SPACING,
    CAMBER_SYMBOL_AVOID_EDGES,
    CAMBER_SYMBOL_SORT_KEY,
    CAMBER_SYMBOL_Z_ORDER,
    CAMBER_ICON_ALLOW_OVERLAP,
    CAMBER_ICON_OVERLAP,
    CAMBER_ICON_IGNORE_PLACEMENT,
    CAMBER_ICON_OPTIONAL,
    CAMBER_ICON_ROTATION_ALIGNMENT,
    CAMBER_ICON_SIZE,
    CAMBER_ICON_TEXT_FIT,
    CAMBER_ICON_TEXT_FIT_PADDING,
    CAMBER_ICON_IMAGE,
    CAMBER_ICON_ROTATE,
    CAMBER_ICON_PADDING,
    CAMBER_ICON_KEEP_UPRIGHT,
    CAMBER_ICON_OFFSET,
    CAMBER_ICON_ANCHOR,
    CAMBER_ICON_PITCH_ALIGNMENT,
    CAMBER_TEXT_PITCH_ALIGNMENT,
    CAMBER_TEXT_ROTATION_ALIGNMENT,
    CAMBER_TEXT_FIELD,
    CAMBER_TEXT_FONT,
    CAMBER_TEXT_SIZE,
    CAMBER_TEXT_MAX_WIDTH,
    CAMBER_TEXT_LINE_HEIGHT,
    CAMBER_TEXT_LETTER_SPACING,
    CAMBER_TEXT_JUSTIFY,
    CAMBER_TEXT_RADIAL_OFFSET,
    CAMBER_TEXT_VARIABLE_ANCHOR,
    CAMBER_TEXT_VARIABLE_ANCHOR_OFFSET,
    CAMBER_TEXT_ANCHOR,
    CAMBER_TEXT_MAX_ANGLE,
    CAMBER_TEXT_WRITING_MODE,
    CAMBER_TEXT_ROTATE,
    CAMBER_TEXT_PADDING,
    CAMBER_TEXT_KEEP_UPRIGHT,
    CAMBER_TEXT_TRANSFORM,
    CAMBER_TEXT_OFFSET,
    CAMBER_TEXT_ALLOW_OVERLAP,
    CAMBER_TEXT_OVERLAP,
    CAMBER_TEXT_IGNORE_PLACEMENT,
    CAMBER_TEXT_OPTIONAL,
    CAMBER_ICON_OPACITY,
    CAMBER_ICON_COLOR,
    CAMBER_ICON_HALO_COLOR,
    CAMBER_ICON_HALO_WIDTH,
    CAMBER_ICON_HALO_BLUR,
    CAMBER_ICON_TRANSLATE,
    CAMBER_ICON_TRANSLATE_ANCHOR,
    CAMBER_TEXT_OPACITY,
    CAMBER_TEXT_COLOR,
    CAMBER_TEXT_HALO_COLOR,
    CAMBER_TEXT_HALO_WIDTH,
    CAMBER_TEXT_HALO_BLUR,
    CAMBER_TEXT_TRANSLATE,
    CAMBER_TEXT_TRANSLATE_ANCHOR,
    CAMBER_PROPERTIES
} camber_property_id;

/* A set of properties. */
typedef struct camber_property_set {
    uint64_t words[(CAMBER_PROPERTIES + 63) / 64];
} camber_property_set;

static inline void camber_property_set_add(camber_property_set *set, camber_property_id id) {
    set->words[id / 64] |= UINT64_C(1) << id % 64;
}

static inline bool camber_property_set_has(const camber_property_set *set, camber_property_id id) {
    return set->words[id / 64] >> id % 64 & 1;
}

/* The colours of a line-gradient. */
typedef struct camber_layer_ramp {
    camber_ramp_stop *stops; /* count. 0: no gradient */
    size_t count;
    bool translucent; /* a stop is translucent */
} camber_layer_ramp;

typedef struct camber_style_layer {
    char *id;
    camber_layer_kind kind;
    char *source;              /* the source's name. NULL: any input */
    uint32_t source_index;     /* index among the style's sources; CAMBER_NO_SOURCE: it is not among them */
    char *source_layer;        /* NULL: any */
    char *filter_key;          /* the filter as compact JSON, "" for none: equal keys select the same features */
    double min_zoom, max_zoom; /* drawn if min <= zoom < max; 0 and 24 by default; 24: no limit */
    bool visible;
    camber_overlap overlap;    /* from its metadata, because the specification has no property for it */
    bool plain;                /* from its metadata: draws only features that no other layer draws */
    bool tucks;                /* from its metadata: round caps of lines are left out where the line goes on below */
    double least_area;         /* from its metadata: smaller rings are not filled, px^2 at the next lower whole zoom */
    double repeat_px;          /* from its metadata: the same words are not shown nearer than that. < 0: not given */
    camber_expression *filter; /* NULL: everything */
    camber_expression *properties[CAMBER_PROPERTIES]; /* NULL: the specification's default */
    camber_layer_ramp ramp, border_ramp;              /* of line-gradient, and of its border if that has no colour */
} camber_style_layer;

typedef struct camber_style_source {
    char *name;
    char *type;                /* "geojson", "vector", ... */
    json_t *json;              /* a reference to the source in the document */
    char *missing;             /* advice for a missing file, from the style's metadata camber:missing. NULL: none */
    camber_expression *filter; /* GeoJSON: selects the features that are read. NULL: all of them */
} camber_style_source;

/* A sprite of the style: pictures for patterns. */
typedef struct camber_style_sprite {
    char *id;  /* precedes the pictures' names, with a colon; "default": no prefix */
    char *url; /* without @2x, .json and .png */
} camber_style_sprite;

/* The document's own camera. */
typedef struct camber_style_camera {
    double longitude, latitude, zoom, bearing_deg, pitch_deg; /* 0 by default */
} camber_style_camera;

struct camber_style {
    camber_context *context;
    uint64_t hash; /* of the document's text */
    char *name;    /* from the document; NULL: none */
    char *glyphs;  /* the URL of the glyphs, with {fontstack} and {range}. NULL: none */
    camber_style_camera camera;
    json_t *state; /* for ["global-state", key]: objects with a default. NULL: none */
    camber_style_sprite *sprites;
    size_t sprite_count;
    camber_style_layer *layers; /* in drawing order */
    size_t layer_count;
    camber_style_source *sources; /* in the document's order */
    size_t source_count;
    camber_schema schema; /* what readers of data need to know */
    bool accumulates;     /* a line layer accumulates: overlapping lines and their ends show through each other */
};

/* Returns the kinds of features, CAMBER_KIND_*, whose properties layers of a kind read. Only plain layers and circles
 * draw points. */
unsigned camber_style_layer_kinds(camber_layer_kind kind);
/* Updates the schema's description of the layers. Call it after all layers have been read, and again if visibility
 * changes. */
void camber_style_describe_layers(camber_style *style);

/* Whether the feature passes the source's filter. A filter that cannot be evaluated counts as false. */
bool camber_style_source_matches(const camber_style_source *source, const camber_feature_view *feature);

/* Whether the layer draws features of this class at this zoom: visibility, zoom range and filter. A filter that fails
 * to evaluate is false. */
bool camber_style_layer_matches(const camber_style_layer *layer, double zoom, const camber_feature_view *feature);
/* Whether the layer may draw features of a geometry type, such as "Polygon". */
bool camber_style_layer_may_take(const camber_style_layer *layer, const char *type);
/* Whether the layer is visible and the feature passes its filter, evaluated at the layer's lowest zoom. If the filter
 * of a symbol layer reads the zoom, every feature passes. */
bool camber_style_layer_takes(const camber_style_layer *layer, const camber_feature_view *feature);

typedef enum camber_translate_anchor {
    CAMBER_TRANSLATE_MAP = 0,
    CAMBER_TRANSLATE_VIEWPORT,
} camber_translate_anchor;

/* Lengths that are alternately drawn and left out, in line widths. In a style, the last dash of an odd list runs into
 * its first one; here the list ends with a gap of 0 instead. */
typedef struct camber_layer_dashes {
    uint32_t count; /* even; 0: solid */
    float lengths[CAMBER_DASH_LENGTHS_MAX];
} camber_layer_dashes;

/* How a layer draws a feature at a zoom, in CSS px. The blur of circles is a fraction of the radius including the
 * stroke. Numbers are finite and within the specification's ranges. */
typedef struct camber_layer_paint {
    camber_cap cap;
    camber_join join;
    double miter_limit, round_limit;
    double sort_key;
    double width, gap_width, offset, blur;
    camber_color color; /* the alpha includes the opacity */
    double opacity;
    double border_width;       /* part of the line's own width, on each side */
    camber_color border_color; /* the alpha includes the opacity; of a fill: its outline's colour */
    double radius;             /* of a circle; its stroke is outside */
    double stroke_width, stroke_opacity;
    camber_color stroke_color; /* the alpha includes the opacity */
    camber_layer_dashes dashes;
    /* These are the same for all features. */
    bool antialias; /* of a fill: its outline may be drawn */
    double layer_opacity;
    double translate[2];
    double trim[2]; /* the line is not drawn between these fractions of its length */
    camber_translate_anchor translate_anchor;
    camber_translate_anchor pitch_scale, pitch_alignment; /* of circles */
} camber_layer_paint;

/* A layer at a zoom. All properties that do not depend on features have been evaluated. */
typedef struct camber_layer_look {
    const camber_style_layer *layer;
    double zoom;
    camber_layer_paint paint;
    bool reads_feature; /* some properties depend on features, namely by_feature */
    camber_property_set by_feature;
} camber_layer_look;

camber_layer_look camber_style_layer_look(const camber_style_layer *layer, double zoom);
/* feature may be NULL for a background. A property that cannot be evaluated has its default. */
camber_layer_paint camber_layer_look_paint(const camber_layer_look *look, const camber_feature_view *feature);
/* Evaluates a layer for a zoom and a feature, in one call. */
camber_layer_paint camber_style_layer_paint(const camber_style_layer *layer, double zoom,
                                            const camber_feature_view *feature);
/* Returns the border's colour for a line that has none. */
camber_color camber_border_color(camber_color color);
/* Finds the image that a layer's pattern names at a zoom. *image is a number from 1, as images->find returns it. 0: it
 * names no image, or a missing image, for which images->missing is called. false: the layer has no pattern. feature may
 * be NULL for a background. */
bool camber_style_layer_pattern(const camber_style_layer *layer, double zoom, const camber_feature_view *feature,
                                const camber_style_images *images, uint32_t *image);
/* Whether two layers give each feature the same geometry: caps, joins, limits, offset, order. */
bool camber_layer_look_shares(const camber_layer_look *a, const camber_layer_look *b);

#endif
