/* Features in memory: lines and areas in world coordinates, and attributes as dictionary-coded columns.
 *
 * Features with the same layer, geometry kind and kept attributes form one class, so that a style's filters are
 * evaluated once per class instead of once per feature. A city of 50,000 ways has a few hundred classes.
 */
#ifndef CAMBER_FEATURES_FEATURES_H
#define CAMBER_FEATURES_FEATURES_H

#include "features/region.h"
#include "features/schema.h"

#include <jansson.h>

typedef struct camber_feature_class {
    uint32_t source; /* index into the style's sources; CAMBER_NO_SOURCE: a file that was given as input */
    uint32_t layer;  /* index into layer_names */
    camber_geometry_kind geometry;
    size_t first_value;      /* index into values: schema->property_count values in the order of the schema */
    camber_value id;         /* null if the style does not read it */
    const camber_value *all; /* an object with all properties, if the style needs them. NULL: none */
    bool unsorted;           /* its file has no schema that says which features are roads, rivers or buildings */
    bool plain;              /* no ordinary layer draws it at any zoom, so plain layers do */
    bool labelled;           /* for a label's kind: a symbol layer takes it */
    bool is_ends;            /* dots at the round ends of a class of lines (ends.c) */
} camber_feature_class;

/* Whether its features are counted with the features of a file: those of labels and of ends are there once more. */
static inline bool camber_feature_class_counts(const camber_feature_class *class) {
    return !class->is_ends && !camber_geometry_is_label(class->geometry);
}

struct camber_features {
    camber_context *context;
    const camber_schema *schema; /* the schema of the style */
    const camber_style *style;   /* the style that draws the features; readers know only its schema */
    /* How often files were read, something was removed or replaced, or the style changed (camber_features_key). */
    uint64_t changes;
    unsigned threads; /* the most that work on a file after it was read, as in camber_source_desc */

    /* Web Mercator world coordinates: pairs x, y from 0 to 1; the origin is the north-west corner, y grows southwards.
     */
    double *points;
    size_t point_count, point_capacity;
    /* point_count: how much each point matters, in world coordinates (camber_importance_weigh). It is computed after a
     * file was read. If several polylines of a file share a node, its importance is the same in all of them. */
    float *importance;
    size_t importance_capacity;
    /* polyline_count + 1 entries, or none while the set is empty: polyline i has the points
     * [offsets[i], offsets[i + 1]). */
    size_t *offsets;
    size_t polyline_count, polyline_capacity;
    uint32_t *polyline_feature; /* polyline_count, ascending: the feature that the polyline belongs to, or the first one
                                   if several features were merged into it */
    uint32_t *feature_counts; /* polyline_count: the number of features whose first line is in the polyline. The sum is
                                 the number of features */
    /* 2 * polyline_count: line-progress at a polyline's first and last point. Between them it grows with the length in
     * world coordinates. NULL: 0 and 1 for all polylines. */
    float *progress;
    size_t progress_capacity;

    /* polyline_count: the number of points that a polyline had before the set was thinned (thin.c). NULL: it was not
     * thinned */
    uint32_t *whole_counts;

    uint32_t *feature_class; /* feature_count */
    size_t feature_count, feature_capacity;

    camber_feature_class *classes;
    size_t class_count, class_capacity;
    camber_value *values; /* class_count * schema->property_count; the set owns the strings */
    size_t value_count, value_capacity;

    char **layer_names; /* source layers, in the order in which they were found */
    size_t layer_count, layer_capacity;

    size_t extract_first, extract_end; /* the polylines of extracts, which may reach far beyond what these are about */
    bool wants_labels;                 /* files are also read for symbol layers (labels.c) */
    bool has_region;                   /* readers keep only features that touch the region */
    camber_region region;              /* the region that a scene needs; read_for.c sets it */
    uint32_t source;                   /* the source of classes that are added from now on; CAMBER_NO_SOURCE at first */
    char *attribution;                 /* attribution_size bytes and a final 0; NULL: none yet */
    size_t attribution_size, attribution_capacity;
    camber_features_stats stats;
    camber_features_times times;

    struct camber_sprites *sprites; /* images of patterns. NULL: not read */
    void (*free_sprites)(
        struct camber_sprites *sprites); /* a pointer, because the module that reads files does not contain sprites */

    struct camber_fonts *fonts;                    /* the fonts of labels. NULL: not read, so there are no labels */
    void *fonts_user;                              /* user data for reading their glyphs */
    void (*free_fonts)(camber_features *features); /* a pointer, as for sprites */

    void *interned; /* the hash tables of strings and classes (features.c) */
};

/* Makes an empty set. The style and its schema must outlive it. */
camber_status camber_features_create_for(camber_context *context, const camber_schema *schema,
                                         const camber_style *style, camber_features **features);
/* Whether reading the same files for another style would give the same set, because all features are from files and the
 * other style reads the same features and properties from them. */
bool camber_features_suit(const camber_features *features, const camber_schema *schema, const camber_style *style);
/* Marks the polylines from first_polyline on as an extract of OpenStreetMap. */
void camber_features_add_extract(camber_features *features, size_t first_polyline);
/* Returns a hash that changes when features are read, or the style, its sprites or its fonts are replaced. */
uint64_t camber_features_key(const camber_features *features);
/* Frees the points of the lines, which take most of a set's memory. Call this after the set's last scene was made,
 * because no other scene can be made or moved afterwards, and no file can be read. */
void camber_features_release_points(camber_features *features);

/* ---- Marks: the state to which a set returns if reading fails half way ---- */

typedef struct camber_features_mark {
    size_t point_count, polyline_count, feature_count;
    size_t attribution_size;
    camber_features_stats stats;
    uint32_t source;
} camber_features_mark;

camber_features_mark camber_features_get_mark(const camber_features *features);
/* Removes everything that was added since the mark, except for classes, which stay even if they are unused. */
void camber_features_reset(camber_features *features, const camber_features_mark *mark);

/* ---- Filling a set. Readers of all formats use these functions; failures are logged. ---- */

/* Returns the set's own copy of the text. Equal texts have the same pointer. */
camber_status camber_features_intern(camber_features *features, const char *text, const char **interned);
camber_status camber_features_find_layer(camber_features *features, const char *name, uint32_t *layer);
/* Returns the set's own copy of a JSON value. Values with the same text have the same pointer. */
camber_status camber_features_intern_json(camber_features *features, const json_t *json, const camber_value **value);
/* Finds the class with these values, or adds it. values: schema->property_count interned values. */
camber_status camber_features_find_class(camber_features *features, uint32_t layer, camber_geometry_kind geometry,
                                         const camber_value *values, uint32_t *class_index);
/* Does the same for a class that also has an id and an object with all properties. Ignores the source, first_value and
 * plain in `wanted`. */
camber_status camber_features_find_class_of(camber_features *features, const camber_feature_class *wanted,
                                            const camber_value *values, uint32_t *class_index);
/* Returns the kinds of geometry that are read, CAMBER_KIND_*. unsorted: see camber_feature_class. */
unsigned camber_features_kinds(const camber_features *features, bool unsorted);
/* Whether a property is read. Properties that only symbol layers read are read only if labels are wanted. */
bool camber_features_reads_property(const camber_features *features, size_t property);
/* Describes the features that are left out if only these kinds are read, in words that complete "left out what is". */
const char *camber_features_left_out(unsigned kinds);
/* Returns camber_schema.rank_ends of a class, CAMBER_NO_RANK if it has none. */
double camber_features_rank_ends(const camber_features *features, uint32_t class_index);
/* Whether features of this class are kept. Some kinds are read only because a class might be plain, and the kinds of
 * labels are read only because a symbol layer might take their features. */
bool camber_features_draw_class(const camber_features *features, uint32_t class_index);
camber_status camber_features_add_feature(camber_features *features, uint32_t class_index);
/* Adds a polyline to the feature that was added last. points: pairs of world coordinates. */
camber_status camber_features_add_polyline(camber_features *features, const double *points, size_t point_count);
/* Sets line-progress at the ends of the polyline that was added last. */
camber_status camber_features_set_progress(camber_features *features, double first, double last);
/* Adds an attribution, plain text or HTML, unless the set has it already. NULL adds nothing. */
camber_status camber_features_add_attribution(camber_features *features, const char *text);
/* Cuts the attribution back to size bytes, which must be an earlier attribution_size. */
void camber_features_cut_attribution(camber_features *features, size_t size);

/* ---- Labels (labels.c): the same features once more, with kinds of their own ---- */

/* Files that are read from now on are also read for symbol layers. */
void camber_features_want_labels(camber_features *features);
/* Returns the kinds of labels that are read, CAMBER_KIND_*. 0: none. */
unsigned camber_features_label_kinds(const camber_features *features);
/* Returns the first polyline of labels from first_polyline on, or polyline_count if there is none. Labels must come
 * after all other features. */
size_t camber_features_find_labels(const camber_features *features, size_t first_polyline);
/* Moves the features of labels after all other features from first_polyline on, so that labels do not change the lines
 * that are drawn. These polylines must not have importance yet. */
camber_status camber_features_part_labels(camber_features *features, size_t first_polyline);
/* Returns the number of features that are neither labels nor ends. */
size_t camber_features_count_drawn(const camber_features *features);
/* Counts features, polylines and points for the statistics, without labels and ends. */
void camber_features_count(camber_features *features);

typedef enum camber_merge_rule {
    CAMBER_MERGE_ANY = 0,  /* at points at which exactly two ends of a class meet */
    CAMBER_MERGE_DIRECTED, /* at such points, if one of the two lines ends and the other starts there */
    CAMBER_MERGE_STRAIGHT, /* at points at which two lines continue almost straight, whatever else meets there */
} camber_merge_rule;

/* Adds dots at the ends, from first_polyline on, that are round in layers which tuck their ends (ends.c). */
camber_status camber_features_add_ends(camber_features *features, size_t first_polyline);

/* If merges is set, merges the lines (not the areas) from first_polyline on. Then adds their ends, computes the
 * importance of the points, and drops lines outside the set's region. It measures the time that both steps take. If the
 * style depends on the direction of lines, ANY becomes DIRECTED. Lines of labels are always merged. Their directions
 * count only if icons show them. */
camber_status camber_features_merge_and_weigh(camber_features *features, size_t first_polyline, bool merges,
                                              camber_merge_rule rule);
/* Merges the lines from first_polyline on. */
camber_status camber_features_merge(camber_features *features, size_t first_polyline, camber_merge_rule rule);
/* Computes the importance of the points from first_polyline on. */
camber_status camber_features_set_importance(camber_features *features, size_t first_polyline);
/* Whether the line or area that begins with this polyline touches the region. *next is the polyline after the line, or
 * after the rings of the area. */
bool camber_features_touch(const camber_features *features, const camber_region *region, size_t polyline, size_t *next);
/* Drops the lines and areas from first_polyline on that do not touch the region (region.c). */
camber_status camber_features_confine(camber_features *features, size_t first_polyline, const camber_region *region);
/* Sorts the features from first_feature on by their keys, and keeps the order of features with equal keys. Their lines
 * begin with first_polyline, and must not have importance or progress yet. */
camber_status camber_features_reorder(camber_features *features, size_t first_polyline, size_t first_feature,
                                      const int64_t *keys);
/* Frees the unused capacity of the arrays of lines and points. */
void camber_features_shrink(camber_features *features);
/* Drops points of lower importance, except for the ends of lines. Afterwards, the set may only be used for pictures
 * that leave such points out anyway. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_features_thin(camber_features *features, float least_importance);
/* Returns how many points a polyline had when it was read. */
static inline size_t camber_features_whole_count(const camber_features *features, size_t polyline) {
    return features->whole_counts ? features->whole_counts[polyline]
                                  : features->offsets[polyline + 1] - features->offsets[polyline];
}
static inline camber_geometry_kind camber_features_kind(const camber_features *features, size_t polyline) {
    return features->classes[features->feature_class[features->polyline_feature[polyline]]].geometry;
}
/* Drops classes without features, and numbers the others by their first feature. */
camber_status camber_features_renumber_classes(camber_features *features);

#endif
