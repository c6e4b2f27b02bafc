/* Zoom plans: how a style draws features at one zoom. They serve pictures that are windows of a larger one, and single
 * pictures.
 *
 * The style is evaluated once per zoom, and scenes are windows of the result (scene.h). Neighbouring windows draw
 * exactly what one large scene would draw: dashes, gradients and patterns use the lengths of whole lines, and a line
 * near the antimeridian is drawn in both halves of the world. */
#ifndef CAMBER_MAP_ZOOM_PLAN_H
#define CAMBER_MAP_ZOOM_PLAN_H

#include "map/plan.h"

typedef struct camber_zoom_plan {
    camber_context *context;
    const camber_features *features;
    uint64_t features_key; /* of the features for which the plan of a single picture was made */
    camber_view view;      /* of the zoom, at any position, or of the single picture */
    double simplify_px;
    float least_importance; /* points between the ends of lines are drawn only if they have at least this importance */
    camber_plan plan;
    camber_stroke *strokes; /* by pair */
    /* By class: how far from its lines it touches pixels. Negative: it is not drawn. NULL for a single picture. */
    float *class_reach_px;
    float most_reach_px;
    bool has_images; /* the background shows images, so it differs from position to position */
    bool has_area_images;
    bool lines_only; /* scenes leave areas out */
} camber_zoom_plan;

typedef struct camber_zoom_desc {
    double zoom;     /* as in MapLibre; below 0 the style is evaluated at 0 */
    double scale_px; /* width of the world in device px */
    double ratio;
    double simplify_px;
} camber_zoom_desc;

/* Returns a view of the zoom, at any position. */
camber_view camber_zoom_view(const camber_zoom_desc *desc);
/* The features must outlive the plan. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_zoom_plan_create(const camber_features *features, const camber_zoom_desc *desc,
                                      camber_zoom_plan **zoom);
/* Makes the plan of a single picture. Also returns CAMBER_ERROR_ARGUMENT: a view out of range, or features whose points
 * have been released. */
camber_status camber_zoom_plan_create_view(const camber_features *features, const camber_view_desc *desc,
                                           double simplify_px, camber_zoom_plan **zoom);
/* Moves the plan of a single picture to another place. false: the view differs in more than its place and size, or the
 * features have changed, so that another plan is needed. */
bool camber_zoom_plan_move(camber_zoom_plan *zoom, const camber_view *view);
void camber_zoom_plan_destroy(camber_zoom_plan *zoom);
/* Returns how far from a polyline pixels are touched, in px. Negative: it is not drawn. */
static inline float camber_zoom_plan_reach(const camber_zoom_plan *zoom, size_t polyline) {
    return zoom->class_reach_px[zoom->features->feature_class[zoom->features->polyline_feature[polyline]]];
}

#endif
