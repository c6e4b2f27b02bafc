/* Schemas: everything that a reader of features must know about a style. The style fills it in. */
#ifndef CAMBER_FEATURES_SCHEMA_H
#define CAMBER_FEATURES_SCHEMA_H

#include "camber_map.h"
#include "features/value.h"

typedef enum camber_geometry_kind {
    CAMBER_GEOMETRY_LINE = 0,
    CAMBER_GEOMETRY_POLYGON, /* its outline is drawn */
    CAMBER_GEOMETRY_AREA,    /* closed rings that are filled; all rings of a feature belong together (rings.h) */
    CAMBER_GEOMETRY_POINT,   /* lines of one point each */
    CAMBER_GEOMETRY_KINDS
} camber_geometry_kind;

/* Sets of kinds, as bits. Line layers draw lines and outlines. */
enum {
    CAMBER_KIND_LINE = 1 << CAMBER_GEOMETRY_LINE,
    CAMBER_KIND_POLYGON = 1 << CAMBER_GEOMETRY_POLYGON,
    CAMBER_KIND_AREA = 1 << CAMBER_GEOMETRY_AREA,
    CAMBER_KIND_POINT = 1 << CAMBER_GEOMETRY_POINT,
};

/* Returns the geometry type by which a style's filters know a kind. */
static inline const char *camber_geometry_type(camber_geometry_kind kind) {
    return kind == CAMBER_GEOMETRY_LINE ? "LineString" : kind == CAMBER_GEOMETRY_POINT ? "Point" : "Polygon";
}

/* A feature as an expression reads it. */
typedef struct camber_feature_view {
    const camber_value *values; /* property_count, in the order of the schema's properties */
    const char *geometry_type;  /* "Point", "LineString" or "Polygon" */
    camber_value id;            /* null if there is none, or if the style does not read it */
    const camber_value *all;    /* an object of all properties, if the style reads them. NULL: none */
} camber_feature_view;

/* The source of features from any input file, which no layer names. */
#define CAMBER_NO_SOURCE UINT32_MAX

/* The kinds of features for which a property is read, CAMBER_KIND_*. */
typedef struct camber_property_readers {
    unsigned kinds;       /* by layers that accept any source layer */
    unsigned named_kinds; /* by layers that name a source layer */
} camber_property_readers;

typedef struct camber_schema {
    char **properties; /* the feature properties that expressions read, each once */
    size_t property_count;
    /* property_count: the features for which each is read. No kinds if only a source's filter reads it. NULL: all
     * properties of all features. */
    camber_property_readers *property_readers;
    /* The source layers that style layers name, each once; first those of visible layers. The style layers own the
     * strings. */
    const char **source_layers;
    size_t source_layer_count, drawn_source_layer_count;
    bool wants_id;             /* an expression reads the feature's id */
    bool wants_all_properties; /* an expression reads properties without naming them */
    bool directed;       /* a line layer depends on the direction of lines: dashes, offsets, gradients, patterns */
    bool wants_polygons; /* outlines of polygons are drawn: by a line layer whose filter accepts polygons, by a fill
                            layer with an outline colour, or as corners by a circle layer */
    bool wants_areas;    /* a fill layer is drawn, so polygons are also read as rings */
    bool wants_points;   /* a circle layer whose filter accepts points is drawn */
    /* A plain layer is drawn (for areas or points: one that accepts them), so data without a schema is read for it. */
    bool wants_plain, wants_plain_areas, wants_plain_points;
    /* Whether a layer other than the plain ones draws such features of this source layer at any zoom. NULL: none does.
     */
    bool (*takes)(const camber_style *style, camber_geometry_kind kind, const char *source_layer,
                  const camber_feature_view *feature);
} camber_schema;

/* Whether a layer of the style names this source layer, so that the style knows what is in it. */
bool camber_schema_names_layer(const camber_schema *schema, const char *source_layer);
/* Returns the kinds of geometry that are read, CAMBER_KIND_*. unsorted: see camber_feature_class. */
unsigned camber_schema_kinds(const camber_schema *schema, bool unsorted);

#endif
