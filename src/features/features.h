/* Features in memory: lines and areas in world coordinates, attributes as dictionary-coded columns.
 *
 * Features that agree in layer, geometry kind and every kept attribute form one class, so that a style's
 * filters are evaluated once a class and not once a feature: a city of 50,000 ways has a few hundred.
 */
#ifndef CAMBER_FEATURES_FEATURES_H
#define CAMBER_FEATURES_FEATURES_H

#include "features/region.h"
#include "features/schema.h"

#include <jansson.h>

typedef struct camber_feature_class {
    uint32_t source; /* index into the style's sources; CAMBER_NO_SOURCE: a file named as input */
    uint32_t layer;  /* index into layer_names */
    camber_geometry_kind geometry;
    size_t first_value;      /* into values: schema->property_count of them, in the schema's order */
    camber_value id;         /* null where the style does not want it */
    const camber_value *all; /* an object of all properties, where the style wants them. NULL: none */
    bool unsorted;           /* its file has no schema that says what is a road, a river, a building */
    bool plain;              /* no layer takes it, at whatever zoom: it is drawn by layers that are plain */
} camber_feature_class;

struct camber_features {
    camber_context *context;
    const camber_schema *schema; /* of the style */
    const camber_style *style;   /* what draws them; readers know its schema only */

    /* World coordinates: Web Mercator, x and y in 0 to 1 from the north-west, y down; pairs. */
    double *points;
    size_t point_count, point_capacity;
    /* point_count: how much each point matters, in world coordinates (lines/importance.h), set once a file is read.
     * Nodes that polylines of one file share have one importance. */
    float *importance;
    size_t importance_capacity;
    /* Polyline i has the points [offsets[i], offsets[i + 1]). polyline_count + 1 entries once not empty. */
    size_t *offsets;
    size_t polyline_count, polyline_capacity;
    uint32_t *polyline_feature; /* polyline_count: the feature that it belongs to, or the first of them; ascending */
    uint32_t *feature_counts; /* polyline_count: how many features have their first line in it; the sum is the number of
                                 features */
    /* 2 * polyline_count: line-progress at a polyline's first and last point; between them it grows with the length in
     * world coordinates. NULL: 0 and 1 for all. */
    float *progress;
    size_t progress_capacity;

    /* polyline_count: the points that a polyline had before the set was thinned (thin.c). NULL: it is not */
    uint32_t *whole_counts;

    uint32_t *feature_class; /* feature_count */
    size_t feature_count, feature_capacity;

    camber_feature_class *classes;
    size_t class_count, class_capacity;
    camber_value *values; /* class_count * schema->property_count; strings belong to this set */
    size_t value_count, value_capacity;

    char **layer_names; /* source layers, in the order in which they were found */
    size_t layer_count, layer_capacity;

    bool has_region;      /* files are read for the region alone */
    camber_region region; /* what a scene needs: read_for.c */
    uint32_t source;      /* the source of classes that are found from now on; CAMBER_NO_SOURCE at first */
    char *attribution;    /* attribution_size bytes and a 0; NULL: none yet */
    size_t attribution_size, attribution_capacity;
    camber_features_stats stats;
    camber_features_times times;

    struct camber_sprites *sprites; /* the images of patterns. NULL: not read */
    void (*free_sprites)(
        struct camber_sprites *sprites); /* a pointer, since the module that reads files has no sprites */

    void *interned; /* hash tables of strings and classes (features.c) */
};

/* Makes an empty set. The style and its schema must outlive it. */
camber_status camber_features_create_for(camber_context *context, const camber_schema *schema,
                                         const camber_style *style, camber_features **features);
/* Whether files would be read into the same set for another style: all that was read is of files, and the style reads
 * the same of them. */
bool camber_features_suit(const camber_features *features, const camber_schema *schema, const camber_style *style);
/* Frees the points of the lines, which take most of a set's memory, after its last scene was made: no other can be made
 * or moved, and nothing more can be read. */
void camber_features_release_points(camber_features *features);

/* ---- A set as it was, for what fails half way ---- */

typedef struct camber_features_mark {
    size_t point_count, polyline_count, feature_count;
    size_t attribution_size;
    camber_features_stats stats;
    uint32_t source;
} camber_features_mark;

camber_features_mark camber_features_get_mark(const camber_features *features);
/* Takes out all that was added since the mark; classes that nothing uses any more stay. */
void camber_features_reset(camber_features *features, const camber_features_mark *mark);

/* ---- Filling a set, from whatever features are read. Failures are logged. ---- */

/* Gives the set's own copy of the text: the same pointer for equal texts. */
camber_status camber_features_intern(camber_features *features, const char *text, const char **interned);
camber_status camber_features_find_layer(camber_features *features, const char *name, uint32_t *layer);
/* Gives the value as the set's own: the same pointer for values of the same text. */
camber_status camber_features_intern_json(camber_features *features, const json_t *json, const camber_value **value);
/* values: schema->property_count of them, interned. */
camber_status camber_features_find_class(camber_features *features, uint32_t layer, camber_geometry_kind geometry,
                                         const camber_value *values, uint32_t *class_index);
/* Does the same with an id and all properties; wanted's source, first_value and plain are not read. */
camber_status camber_features_find_class_of(camber_features *features, const camber_feature_class *wanted,
                                            const camber_value *values, uint32_t *class_index);
/* Names what is left out if these kinds are read, to follow "left out what is". */
const char *camber_features_left_out(unsigned kinds);
/* Whether features of a class are kept: those of some kinds are read in case that they are plain. */
bool camber_features_draw_class(const camber_features *features, uint32_t class_index);
camber_status camber_features_add_feature(camber_features *features, uint32_t class_index);
/* Adds a polyline to the feature that was added last. points: pairs of world coordinates. */
camber_status camber_features_add_polyline(camber_features *features, const double *points, size_t point_count);
/* Sets line-progress at the ends of the polyline that was added last. */
camber_status camber_features_set_progress(camber_features *features, double first, double last);
/* Adds an attribution, plain text or HTML, unless the set has it already. NULL: nothing. */
camber_status camber_features_add_attribution(camber_features *features, const char *text);
/* Cuts the attribution back to this many bytes, a former attribution_size. */
void camber_features_cut_attribution(camber_features *features, size_t size);

typedef enum camber_merge_rule {
    CAMBER_MERGE_ANY = 0,  /* where exactly two ends of a class meet */
    CAMBER_MERGE_DIRECTED, /* the same, but only the end of one with the start of another */
    CAMBER_MERGE_STRAIGHT, /* where two ends go on almost straight, whatever else meets there */
} camber_merge_rule;

/* Merges the lines of first_polyline and after it, if merges, and not the areas, and weighs their points; counts the
 * time of both. Where the style goes by directions, ANY is DIRECTED. Lines outside the region of the set go. */
camber_status camber_features_merge_and_weigh(camber_features *features, size_t first_polyline, bool merges,
                                              camber_merge_rule rule);
/* Merges lines of first_polyline and after it. */
camber_status camber_features_merge(camber_features *features, size_t first_polyline, camber_merge_rule rule);
/* Sets the importance of the points of first_polyline and of those after it. */
camber_status camber_features_set_importance(camber_features *features, size_t first_polyline);
/* Whether a line touches the region, or the area whose rings begin with this polyline does. *next: the polyline behind
 * the line, or behind the area's rings. */
bool camber_features_touch(const camber_features *features, const camber_region *region, size_t polyline, size_t *next);
/* Drops the lines and areas of first_polyline and after it that do not touch the region (region.c). */
camber_status camber_features_confine(camber_features *features, size_t first_polyline, const camber_region *region);
/* Sorts the features of first_feature and after it, whose lines begin with first_polyline and have neither importance
 * nor progress yet, by their keys; those of one key stay as they were. */
camber_status camber_features_reorder(camber_features *features, size_t first_polyline, size_t first_feature,
                                      const int64_t *keys);
/* Gives back the memory that lines and points do not fill. */
void camber_features_shrink(camber_features *features);
/* Drops the points of less importance, but for the ends of lines: for pictures that leave them out, and none but such
 * are drawn of the set from now on. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_features_thin(camber_features *features, float least_importance);
/* The points that a polyline was read with. */
static inline size_t camber_features_whole_count(const camber_features *features, size_t polyline) {
    return features->whole_counts ? features->whole_counts[polyline]
                                  : features->offsets[polyline + 1] - features->offsets[polyline];
}
static inline camber_geometry_kind camber_features_kind(const camber_features *features, size_t polyline) {
    return features->classes[features->feature_class[features->polyline_feature[polyline]]].geometry;
}
/* Drops classes that no feature has, and numbers the others in the order in which features have them. */
camber_status camber_features_renumber_classes(camber_features *features);

#endif
