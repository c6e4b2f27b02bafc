/* The plan of a scene: which layers draw here, which of them share polylines, and with which strokes, paints and fills.
 *
 *     layers (in drawing order) -> sets (layers that draw the same polylines) -> rows (a stroke and its paints in a
 * set)
 */
#ifndef CAMBER_MAP_PLAN_H
#define CAMBER_MAP_PLAN_H

#include "features/features.h"
#include "map/plan_patterns.h"

#define CAMBER_NO_ROW UINT32_MAX

/* Layers that agree in source, filter, caps and joins: one geometry, cut for the widest of them. Areas are another one
 * than lines. */
typedef struct camber_plan_set {
    size_t first_layer, last_layer, layer_count; /* layers of the plan, linked by next */
    size_t first_row, row_count;
    size_t first_pair, pair_count; /* its classes, in order */
    size_t first_paint;            /* into paints: row_count tuples of layer_count */
    size_t first_area;             /* into the areas of patterns, which has as many, where the set is of areas */
    bool sorted;                   /* entries are in the order of pair_keys */
} camber_plan_set;

/* A part of a layer of the style. Lines and borders are one geometry. */
typedef enum camber_plan_part {
    CAMBER_PLAN_LINE = 0,
    CAMBER_PLAN_BORDER,  /* of the line that comes next */
    CAMBER_PLAN_AREA,    /* what lies inside of rings */
    CAMBER_PLAN_OUTLINE, /* of the area before */
    CAMBER_PLAN_CIRCLES, /* dots about points, and about the corners of lines and outlines */
} camber_plan_part;

typedef struct camber_plan_layer {
    camber_layer_look look;
    camber_layer_look below; /* at the whole zoom below, of a layer with dashes or a pattern */
    float translate_px[2];
    size_t set;
    size_t slot; /* which of the set's layers it is */
    camber_plan_part part;
    const camber_ramp *ramp; /* of the plan. NULL: none */
    bool translucent_ramp;
    size_t next; /* layer of the set */
} camber_plan_layer;

/* A polyline of the features that a set draws, with its pair: the set and the class. Pairs stay what they are while
 * zooming, until a filter or a width of 0 changes what is drawn; rows need not. */
typedef struct camber_plan_entry {
    uint32_t polyline, pair;
} camber_plan_entry;

/* Polylines by set: set s has [first_entries[s], first_entries[s + 1]). In a set they are in input order, or in that of
 * their features' keys where the set is sorted. */
typedef struct camber_plan_entries {
    camber_context *context;
    camber_plan_entry *entries;
    size_t *first_entries; /* set_count + 1 */
} camber_plan_entries;

typedef struct camber_set_pair {
    uint32_t set, pair;
} camber_set_pair;

/* The sets that draw a class: [first[class], first[class + 1]) of pairs. */
typedef struct camber_class_sets {
    size_t *first;
    camber_set_pair *pairs;
} camber_class_sets;

typedef struct camber_plan_dash {
    camber_dash dash; /* the lengths below */
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
    camber_stroke *strokes; /* by row: the widest of its paints, with both rails and the gap between them */
    size_t row_count, stroke_capacity;
    float translate_px;        /* the farthest */
    camber_plan_dash **dashes; /* dash_count, each once; paints point at them */
    size_t dash_count, dash_capacity;
    uint32_t *dash_slots; /* their numbers, hashed; dash_slot_count is a power of two */
    size_t dash_slot_count;
    camber_ramp *ramps; /* ramp_count: the style's */
    size_t ramp_count;
    bool has_arc_length; /* a paint has what lies along its lines */
    /* The dots of a circle, each a pair of its class, one over the other: that of its fill is the last, and where the
     * style has strokes, theirs is below it. Sets of anything else have the last alone. */
    size_t dot_count;
    bool has_corners;    /* circles are drawn about the corners of lines, of which all are needed */
    uint32_t *pair_rows; /* pair_count */
    double *pair_keys;   /* pair_count: their features' places in a sorted set */
    uint8_t *pair_dots;  /* pair_count: which of its class's dots a pair is, below dot_count */
    size_t pair_count;
    uint64_t
        key; /* a hash of the pairs' sets and classes: two plans of the same features with one key have equal entries */
    camber_class_sets by_class;
    /* These two are of all features; camber_plan_evaluate leaves them out. */
    camber_plan_entries all;
    size_t undrawn; /* features of which no layer draws anything */
} camber_plan;

/* Evaluates the style, once a set and class, and lists nothing. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (2^24
 * rows). camber_plan_destroy frees also what a failure left. */
camber_status camber_plan_evaluate(const camber_features *features, const camber_view *view, camber_plan *plan);
/* Lists what the plan draws of some polylines, in ascending order. NULL: of the first polyline_count.
 * camber_plan_entries_free frees also what a failure left. */
camber_status camber_plan_list(const camber_features *features, const camber_plan *plan, const uint32_t *polylines,
                               size_t polyline_count, camber_plan_entries *list);
void camber_plan_entries_free(camber_plan_entries *list);
/* Does both, for all features. */
camber_feature_view camber_plan_view_of(const camber_features *features, const camber_feature_class *class);
/* Whether features of the class come to the layer's filter: those of its source and source layer do. */
bool camber_plan_comes_to(const camber_features *features, const camber_style_layer *layer,
                          const camber_feature_class *class);
/* Whether a layer takes features of the class at a zoom, which it may yet draw without width or colour. */
bool camber_plan_takes(const camber_features *features, const camber_style_layer *layer, double zoom,
                       const camber_feature_class *class);
/* Whether a symbol layer takes them, which is no part of a plan. */
bool camber_plan_labels(const camber_features *features, const camber_style_layer *layer, double zoom,
                        const camber_feature_class *class);
/* Whether anything of a class is drawn at one of the zooms (drawn.c); labels are not. */
bool camber_plan_draws(const camber_features *features, const camber_feature_class *class, double min_zoom,
                       double max_zoom);
/* The box of all that is drawn at one of the zooms, in world coordinates; beyond x = 1 where it is smaller across the
 * antimeridian; CAMBER_BOX_EMPTY: nothing is. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_plan_drawn_box(const camber_features *features, double min_zoom, double max_zoom, camber_box *box);
/* Writes such a box in degrees: west, south, east, north. false: it is empty. */
bool camber_plan_unproject_box(const camber_box *box, double bounds[4]);
/* camber_features_explain_nothing, and whether it draws any at these zooms (explain.c). Returns CAMBER_ERROR_MEMORY. */
camber_status camber_plan_explain_nothing(const camber_features *features, double min_zoom, double max_zoom, char *text,
                                          size_t size, bool *draws);
camber_status camber_plan_create(const camber_features *features, const camber_view *view, camber_plan *plan);
void camber_plan_destroy(camber_plan *plan);

/* ---- Using a plan ---- */

/* Whether the set's polylines are rings that are filled. */
static inline bool camber_plan_is_area(const camber_plan *plan, const camber_plan_set *set) {
    return plan->layers[set->first_layer].part == CAMBER_PLAN_AREA;
}

/* Whether each point of the set's polylines is a dot. */
static inline bool camber_plan_is_circles(const camber_plan *plan, const camber_plan_set *set) {
    return plan->layers[set->first_layer].part == CAMBER_PLAN_CIRCLES;
}

/* The paint that a row of the set has in the set's layer number slot. */
static inline camber_paint camber_plan_paint(const camber_plan *plan, const camber_plan_set *set, size_t row,
                                             size_t slot) {
    return plan->paints[set->first_paint + (row - set->first_row) * set->layer_count + slot];
}

/* The plan of a view moved over what the style draws, with a margin of 2 %; the view stays where there is nothing
 * to draw. What is drawn may depend on the zoom, so the view is fitted twice at most. */
camber_status camber_plan_fit(const camber_features *features, camber_view *view, camber_plan *plan);

#endif
