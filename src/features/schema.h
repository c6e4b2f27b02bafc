/* Schemas: everything that a reader of features must know about a style. The style fills it in. */
#ifndef CAMBER_FEATURES_SCHEMA_H
#define CAMBER_FEATURES_SCHEMA_H

#include "camber_map.h"
#include "features/value.h"

typedef enum camber_geometry_kind {
    CAMBER_GEOMETRY_LINE = 0,
    CAMBER_GEOMETRY_POLYGON, /* an outline, which is drawn */
    CAMBER_GEOMETRY_AREA,    /* closed rings that are filled; all rings of a feature belong together (rings.h) */
    CAMBER_GEOMETRY_POINT,   /* lines of one point each */
    /* Symbol layers label these kinds. They have the same geometry once more, in classes of their own, because names
     * would split the classes of lines and areas. Only labels are drawn from them. */
    CAMBER_GEOMETRY_LABEL_LINE,
    CAMBER_GEOMETRY_LABEL_AREA, /* rings, as for AREA */
    CAMBER_GEOMETRY_LABEL_POINT,
    CAMBER_GEOMETRY_KINDS
} camber_geometry_kind;

/* Sets of kinds, as bits. Line layers draw lines and outlines. */
enum {
    CAMBER_KIND_LINE = 1 << CAMBER_GEOMETRY_LINE,
    CAMBER_KIND_POLYGON = 1 << CAMBER_GEOMETRY_POLYGON,
    CAMBER_KIND_AREA = 1 << CAMBER_GEOMETRY_AREA,
    CAMBER_KIND_POINT = 1 << CAMBER_GEOMETRY_POINT,
    CAMBER_KIND_LABEL_LINE = 1 << CAMBER_GEOMETRY_LABEL_LINE,
    CAMBER_KIND_LABEL_AREA = 1 << CAMBER_GEOMETRY_LABEL_AREA,
    CAMBER_KIND_LABEL_POINT = 1 << CAMBER_GEOMETRY_LABEL_POINT,
    CAMBER_KINDS_OF_LABELS = CAMBER_KIND_LABEL_LINE | CAMBER_KIND_LABEL_AREA | CAMBER_KIND_LABEL_POINT,
    CAMBER_KINDS_OF_AREAS = CAMBER_KIND_AREA | CAMBER_KIND_LABEL_AREA,
    CAMBER_KINDS_OF_POINTS = CAMBER_KIND_POINT | CAMBER_KIND_LABEL_POINT,
};

static inline bool camber_geometry_is_label(camber_geometry_kind kind) {
    return CAMBER_KINDS_OF_LABELS >> kind & 1;
}
/* Whether the lines of a kind are the rings of areas. */
static inline bool camber_geometry_is_area(camber_geometry_kind kind) {
    return CAMBER_KINDS_OF_AREAS >> kind & 1;
}
/* Returns the drawn kind that has the same geometry. */
static inline camber_geometry_kind camber_geometry_shape(camber_geometry_kind kind) {
    return kind == CAMBER_GEOMETRY_LABEL_LINE    ? CAMBER_GEOMETRY_LINE
           : kind == CAMBER_GEOMETRY_LABEL_AREA  ? CAMBER_GEOMETRY_AREA
           : kind == CAMBER_GEOMETRY_LABEL_POINT ? CAMBER_GEOMETRY_POINT
                                                 : kind;
}

/* Returns the geometry type by which a style's filters know a kind. */
static inline const char *camber_geometry_type(camber_geometry_kind kind) {
    switch (kind) {
    case CAMBER_GEOMETRY_LINE:
    case CAMBER_GEOMETRY_LABEL_LINE: return "LineString";
    case CAMBER_GEOMETRY_POINT:
    case CAMBER_GEOMETRY_LABEL_POINT: return "Point";
    default: return "Polygon";
    }
}

/* A feature as an expression reads it. */
typedef struct camber_feature_view {
    const camber_value *values; /* property_count, in the order of the schema's properties */
    const char *geometry_type;  /* "Point", "LineString" or "Polygon" */
    camber_value id;            /* null if there is none, or if the style does not read it */
    const camber_value *all;    /* an object with all properties, if the style needs them. NULL: none */
} camber_feature_view;

/* The rank of a line whose ends are not tucked. Ranks are 0 or more. */
#define CAMBER_NO_RANK (-1.0)

/* The source of features from an input file, which no layer of the style names. */
#define CAMBER_NO_SOURCE UINT32_MAX

/* The kinds of features for which a property is read, CAMBER_KIND_*. */
typedef struct camber_property_readers {
    unsigned kinds;       /* kinds for which layers that accept any source layer read it */
    unsigned named_kinds; /* kinds for which layers that name a source layer read it */
} camber_property_readers;

typedef struct camber_schema {
    char **properties; /* the names of the feature properties that expressions read, each once */
    size_t property_count;
    /* property_count: the features for which each property is read. It has no kinds if only a source's filter reads the
     * property. NULL: all properties of all features. */
    camber_property_readers *property_readers;
    /* The source layers that style layers name, each once. Those that visible layers other than symbol layers name come
     * first. The style layers own the strings. */
    const char **source_layers;
    size_t source_layer_count, drawn_source_layer_count;
    size_t label_source_layer_count; /* how many more source layers, after these, visible symbol layers name */
    bool wants_id;                   /* an expression reads the feature's id */
    bool wants_all_properties;       /* an expression reads properties without naming them */
    bool directed;        /* a line layer depends on the direction of lines: dashes, offsets, gradients, patterns */
    bool labels_directed; /* an icon turns with its line, and so shows the line's direction */
    bool wants_polygons;  /* outlines of polygons are drawn: by a line layer whose filter accepts polygons, by a fill
                             layer with an outline colour, or as corners by a circle layer */
    bool wants_areas;     /* a fill layer is drawn, so polygons are also read as rings */
    bool wants_points;    /* a circle layer whose filter accepts points is drawn */
    /* For each: a symbol layer is drawn whose filter accepts such features. */
    bool wants_label_lines, wants_label_areas, wants_label_points;
    /* A plain layer is drawn (for areas or points: a plain layer that accepts them), so data without a schema is read
     * for it. */
    bool wants_plain, wants_plain_areas, wants_plain_points;
    /* Whether a layer other than the plain ones draws such a feature of this source layer at any zoom. For a label's
     * kind: whether a symbol layer takes the feature. NULL: no layer does. */
    bool (*takes)(const camber_style *style, camber_geometry_kind kind, const char *source_layer,
                  const camber_feature_view *feature);
    /* Returns the rank of a line among those that layers draw which tuck their ends: the later such a layer is, and
     * within a layer the larger the sort key, the higher. CAMBER_NO_RANK: no such layer draws it. NULL: the style has
     * no such layer. */
    double (*rank_ends)(const camber_style *style, const char *source_layer, const camber_feature_view *feature);
} camber_schema;

/* Whether a layer of the style names this source layer, so that the style knows what is in it. */
bool camber_schema_names_layer(const camber_schema *schema, const char *source_layer);
/* Whether a layer other than symbol layers, or the filter of a source, reads a property. */
bool camber_schema_draws_property(const camber_schema *schema, size_t property);
/* Whether a visible symbol layer names this source layer, and no other visible layer does. */
bool camber_schema_only_labels_layer(const camber_schema *schema, const char *source_layer);

#endif
