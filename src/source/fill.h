/* Filling a set of features, whatever they are read from. Failures are logged. */
#ifndef CAMBER_SOURCE_FILL_H
#define CAMBER_SOURCE_FILL_H

#include "source/features.h"

/* The set's own copy of text, the same pointer for equal texts. */
camber_status camber_features_intern(camber_features *features, const char *text, const char **interned);
camber_status camber_features_find_layer(camber_features *features, const char *name, uint32_t *layer);
/* The value as the set's own: the same pointer for values of the same text. */
camber_status camber_features_intern_json(camber_features *features, const json_t *json, const camber_value **value);
/* values: style->property_count of them, interned. */
camber_status camber_features_find_class(camber_features *features, uint32_t layer, camber_geometry_kind geometry,
                                         const camber_value *values, uint32_t *class_index);
/* The same with an id and all properties; wanted's source and first_value are not read. */
camber_status camber_features_find_class_of(camber_features *features, const camber_feature_class *wanted,
                                            const camber_value *values, uint32_t *class_index);
camber_status camber_features_add_feature(camber_features *features, uint32_t class_index);
/* A polyline of the feature added last. points: pairs of world coordinates. */
camber_status camber_features_add_polyline(camber_features *features, const double *points, size_t point_count);
/* The progress of the polyline added last. */
camber_status camber_features_set_progress(camber_features *features, double first, double last);
/* Adds to what camber_features_attribution says, plain text or HTML, unless it stands there; NULL: nothing. */
camber_status camber_features_sign(camber_features *features, const char *text);
/* Takes what was added since it had so many bytes, attribution_size, out again. */
void camber_features_unsign(camber_features *features, size_t size);

typedef enum camber_merge_rule {
    CAMBER_MERGE_ANY = 0,  /* where exactly two ends of a class meet */
    CAMBER_MERGE_DIRECTED, /* the same, but only the end of one with the start of another */
    CAMBER_MERGE_STRAIGHT, /* where two ends go on almost straight, whatever else meets there */
} camber_merge_rule;

/* Merges lines of first_polyline and after it. */
camber_status camber_features_merge(camber_features *features, size_t first_polyline, camber_merge_rule rule);
/* Sets the importance of the points of first_polyline and of those after it. */
camber_status camber_features_weigh(camber_features *features, size_t first_polyline);

#endif
