/* The plan of a scene: which layers are drawn, which of them share polylines, and with which strokes, paints and fills.
 *
 *     layers, in drawing order -> sets: layers that draw the same polylines -> rows: a stroke and its paints in a set
 */
#ifndef CAMBER_MAP_PLAN_H
#define CAMBER_MAP_PLAN_H

#include "features/features.h"
#include "map/plan_patterns.h"

#define CAMBER_NO_ROW UINT32_MAX

/* Layers with the same source, filter, caps and joins. They share one geometry, which is tessellated for the widest of
 * them. Areas and lines are in different sets. */
typedef struct camber_plan_set {
    size_t first_layer, last_layer, layer_count; /* a list of the plan's layers, linked by next */
    size_t first_row, row_count;
    size_t first_pair, pair_count; /* one pair for each of its classes, in order */
    size_t first_paint;            /* in paints: row_count tuples of layer_count paints */
    size_t first_area;             /* in patterns.areas, laid out like paints, if this is a set of areas */
    bool sorted;                   /* entries are ordered by pair_keys */
    double least_area;             /* smaller rings are left out, in world coordinates; 0: none is */
} camber_plan_set;

/* A part of a layer of the style. Lines and their borders share one geometry. */
typedef enum camber_plan_part {
    CAMBER_PLAN_LINE = 0,
    CAMBER_PLAN_BORDER,  /* border of the line that is the next layer of the plan */
    CAMBER_PLAN_AREA,    /* the inside of rings */
    CAMBER_PLAN_OUTLINE, /* outline of the area that is the previous layer of the plan */
    CAMBER_PLAN_CIRCLES, /* dots at points, and at the corners of lines and outlines */
} camber_plan_part;

typedef struct camber_plan_layer {
    camber_layer_look look;
    camber_layer_look below; /* at the next lower integer zoom, if the layer has dashes or a pattern */
    float translate_px[2];
    size_t set;
    size_t slot; /* its position among the set's layers */
    camber_plan_part part;
    const camber_ramp *ramp; /* one of the plan's ramps. NULL: none */
    bool translucent_ramp;
    size_t next; /* the next layer of the set */
} camber_plan_layer;

/* A polyline that a set draws, and its pair: the combination of the set and the polyline's class. While zooming, pairs
 * stay the same until a filter or a width of 0 changes which features are drawn; rows may change. */
typedef struct camber_plan_entry {
    uint32_t polyline, pair;
} camber_plan_entry;

/* Polylines by set: set s has [first_entries[s], first_entries[s + 1]). Within a set they are in input order, or, if
 * the set is sorted, in the order of their features' keys. */
typedef struct camber_plan_entries {
    camber_context *context;
    camber_plan_entry *entries;
    size_t *first_entries; /* set_count + 1 */
} camber_plan_entries;

typedef struct camber_set_pair {
    uint32_t set, pair;
} camber_set_pair;

/* The sets that draw each class, with their pairs: class c has [first[c], first[c + 1]) of pairs. */
typedef struct camber_class_sets {
    size_t *first;
    camber_set_pair *pairs;
} camber_class_sets;

typedef struct camber_plan_dash {
    camber_dash dash; /* points to the lengths in from */
    camber_layer_dashes from;
} camber_plan_dash;

typedef struct camber_plan {
    camber_context *context;
    camber_color background;
    camber_plan_patterns patterns;
    camber_plan_layer *layers;
    size_t layer_count;
    camber_plan_set *sets; /* in the order of their first layers */
    size_t set_count;
    camber_paint *paints;
    size_t paint_count, paint_capacity;
    camber_stroke *strokes; /* by row: as wide as the widest of its paints, with both rails and the gap */
    size_t row_count, stroke_capacity;
    float translate_px;        /* the longest translation */
    camber_plan_dash **dashes; /* dash_count, all different; paints point to them */
    size_t dash_count, dash_capacity;
    uint32_t *dash_slots; /* a hash table of their numbers + 1; dash_slot_count is a power of two */
    size_t dash_slot_count;
    camber_ramp *ramps; /* ramp_count: they refer to the style's stops */
    size_t ramp_count;
    bool has_arc_length; /* a paint has dashes, a gradient, a pattern or a trim */
    /* How many dots a circle has: 2 if the style has circle strokes, the stroke's dot below the fill's, otherwise 1.
     * Each dot is a pair of its class. Sets without circles use only the last dot. */
    size_t dot_count;
    bool has_corners;    /* circles are drawn at the corners of lines, so all corners are needed */
    uint32_t *pair_rows; /* pair_count */
    double *pair_keys;   /* pair_count: the keys of their features, in a sorted set */
    uint8_t *pair_dots;  /* pair_count: which dot of its class a pair is, below dot_count */
    size_t pair_count;
    uint64_t key; /* a hash of all sets and classes: plans of the same features with equal keys have equal entries */
    camber_class_sets by_class;
    /* These two are about all features; camber_plan_evaluate does not set them. */
    camber_plan_entries all;
    size_t undrawn; /* features that no layer draws */
} camber_plan;

/* Evaluates the style once for each set and class, without listing polylines. Call camber_plan_destroy even after a
 * failure. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (2^24 rows). */
camber_status camber_plan_evaluate(const camber_features *features, const camber_view *view, camber_plan *plan);
/* Lists which of some polylines the plan draws. polylines: ascending. NULL: the first polyline_count polylines. Call
 * camber_plan_entries_free even after a failure. */
camber_status camber_plan_list(const camber_features *features, const camber_plan *plan, const uint32_t *polylines,
                               size_t polyline_count, camber_plan_entries *list);
void camber_plan_entries_free(camber_plan_entries *list);
/* Returns a class as the style's expressions see it. */
camber_feature_view camber_plan_view_of(const camber_features *features, const camber_feature_class *class);
/* Whether the layer's filter is applied to features of the class: it is if they are from its source and source layer.
 */
bool camber_plan_comes_to(const camber_features *features, const camber_style_layer *layer,
                          const camber_feature_class *class);
/* Whether a layer takes features of the class at a zoom. It may still draw them without width or colour. */
bool camber_plan_takes(const camber_features *features, const camber_style_layer *layer, double zoom,
                       const camber_feature_class *class);
/* Whether a symbol layer takes features of the class. A plan does not contain labels. */
bool camber_plan_labels(const camber_features *features, const camber_style_layer *layer, double zoom,
                        const camber_feature_class *class);
/* Whether features of the class are drawn at any of the zooms (drawn.c). Labels do not count. */
bool camber_plan_draws(const camber_features *features, const camber_feature_class *class, double min_zoom,
                       double max_zoom);
/* Finds the box of everything that is drawn at any of the zooms, and, if fonts were read, of everything that may have a
 * label, in world coordinates. It extends past x = 1 if the box
 * across the antimeridian is smaller. CAMBER_BOX_EMPTY: nothing is drawn. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_plan_drawn_box(const camber_features *features, double min_zoom, double max_zoom, camber_box *box);
/* Converts such a box to degrees: west, south, east, north. false: it is empty. */
bool camber_plan_unproject_box(const camber_box *box, double bounds[4]);
/* Does the work of camber_features_explain_nothing, and sets *draws if any features are drawn at these zooms
 * (explain.c). Returns CAMBER_ERROR_MEMORY. */
camber_status camber_plan_explain_nothing(const camber_features *features, double min_zoom, double max_zoom, char *text,
                                          size_t size, bool *draws);
/* Evaluates the style, and lists the polylines of all features. Returns the errors of camber_plan_evaluate. */
camber_status camber_plan_create(const camber_features *features, const camber_view *view, camber_plan *plan);
void camber_plan_destroy(camber_plan *plan);

/* ---- Using a plan ---- */

/* Whether the set's polylines are rings to be filled. */
static inline bool camber_plan_is_area(const camber_plan *plan, const camber_plan_set *set) {
    return plan->layers[set->first_layer].part == CAMBER_PLAN_AREA;
}

/* Whether each point of the set's polylines is drawn as a dot. */
static inline bool camber_plan_is_circles(const camber_plan *plan, const camber_plan_set *set) {
    return plan->layers[set->first_layer].part == CAMBER_PLAN_CIRCLES;
}

/* Returns the paint of a row in the set's layer number slot. */
static inline camber_paint camber_plan_paint(const camber_plan *plan, const camber_plan_set *set, size_t row,
                                             size_t slot) {
    return plan->paints[set->first_paint + (row - set->first_row) * set->layer_count + slot];
}

/* Moves the view so that it shows everything that the style draws, with a margin of 2 %, and makes its plan. If nothing
 * is drawn, the view stays as it is. Because the zoom affects which features are drawn, the view is fitted up to twice.
 */
camber_status camber_plan_fit(const camber_features *features, camber_view *view, camber_plan *plan);

#endif
