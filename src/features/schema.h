/* Schemas: a style fills one in, and readers of features know no more of the style than that. */
#ifndef CAMBER_FEATURES_SCHEMA_H
#define CAMBER_FEATURES_SCHEMA_H

#include "camber_map.h"
#include "features/value.h"

typedef enum camber_geometry_kind {
    CAMBER_GEOMETRY_LINE = 0,
    CAMBER_GEOMETRY_POLYGON, /* the outline is drawn */
    CAMBER_GEOMETRY_AREA,    /* closed rings that are filled, all those of a feature together (rings.h) */
    CAMBER_GEOMETRY_POINT,   /* lines of one point each */
    /* Symbol layers label these: the same geometry once more, in classes of its own, since names would split those of
     * lines and areas. Nothing else is drawn of it. */
    CAMBER_GEOMETRY_LABEL_LINE,
    CAMBER_GEOMETRY_LABEL_AREA, /* rings as those of AREA */
    CAMBER_GEOMETRY_LABEL_POINT,
    CAMBER_GEOMETRY_KINDS
} camber_geometry_kind;

/* Sets of kinds, as bits. Layers of lines draw lines and outlines. */
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
/* Whether its lines are the rings of an area. */
static inline bool camber_geometry_is_area(camber_geometry_kind kind) {
    return CAMBER_KINDS_OF_AREAS >> kind & 1;
}
/* The drawn kind that has the same geometry. */
static inline camber_geometry_kind camber_geometry_shape(camber_geometry_kind kind) {
    return kind == CAMBER_GEOMETRY_LABEL_LINE    ? CAMBER_GEOMETRY_LINE
           : kind == CAMBER_GEOMETRY_LABEL_AREA  ? CAMBER_GEOMETRY_AREA
           : kind == CAMBER_GEOMETRY_LABEL_POINT ? CAMBER_GEOMETRY_POINT
                                                 : kind;
}

/* The type that a style's filters know a kind by. */
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
    camber_value id;            /* if the style wants it; null: none */
    const camber_value *all;    /* an object of all properties, if the style wants them. NULL: none */
} camber_feature_view;

/* Stands for a source that no layer names: any input. */
#define CAMBER_NO_SOURCE UINT32_MAX

/* The kinds of features that a property is read of, CAMBER_KIND_*. */
typedef struct camber_property_readers {
    unsigned kinds;       /* by layers that take any source layer */
    unsigned named_kinds; /* by layers that name theirs */
} camber_property_readers;

typedef struct camber_schema {
    char **properties; /* feature properties that any expression reads, each once */
    size_t property_count;
    /* property_count: of what each is read; of nothing if only a source's filter reads it. NULL: all of everything. */
    camber_property_readers *property_readers;
    /* The source layers that layers name, each once; first those that a visible layer names which is no
     * symbol layer. They belong to the layers. */
    const char **source_layers;
    size_t source_layer_count, drawn_source_layer_count;
    size_t label_source_layer_count; /* those behind the drawn ones, which visible symbol layers name */
    bool wants_id;                   /* an expression reads the feature's id */
    bool wants_all_properties;       /* an expression reads properties that it does not name */
    bool directed; /* a line layer names what follows its lines' direction: dashes, offsets, gradients, patterns */
    bool wants_polygons; /* outlines are drawn: by a line layer whose filter does not leave polygons out, by a fill
                            layer that has a colour for them, or their corners by a circle layer */
    bool wants_areas;    /* a fill layer is drawn: polygons are read as rings too */
    bool wants_points;   /* a circle layer is drawn whose filter does not leave points out */
    /* A symbol layer is drawn whose filter does not leave lines, polygons or points out. */
    bool wants_label_lines, wants_label_areas, wants_label_points;
    /* A layer that is plain is drawn, of areas or of points among others: of data without a schema these are read. */
    bool wants_plain, wants_plain_areas, wants_plain_points;
    /* Whether a layer that is not plain draws such features of this source layer at any zoom; of label kinds, whether a
     * symbol layer may have a text or an icon for them. NULL: none does. */
    bool (*takes)(const camber_style *style, camber_geometry_kind kind, const char *source_layer,
                  const camber_feature_view *feature);
} camber_schema;

/* Whether the style has a layer of its own for this source layer, so that it knows what the layer holds. */
bool camber_schema_names_layer(const camber_schema *schema, const char *source_layer);
/* Whether other layers than symbol layers read a property, or the filter of a source does. */
bool camber_schema_draws_property(const camber_schema *schema, size_t property);
/* Whether visible layers name it, but none except symbol layers. */
bool camber_schema_only_labels_layer(const camber_schema *schema, const char *source_layer);

#endif
