/* Zoom plans: what a style draws of features at one zoom, for pictures that are windows of a larger one, and for one
 * picture.
 *
 * The style is evaluated once a zoom. Scenes are windows of it (scene.h). Neighbouring ones draw what one scene would
 * draw: dashes, gradients and patterns go by whole lines, and a line near the antimeridian is in both halves of the
 * world. */
#ifndef CAMBER_MAP_ZOOM_PLAN_H
#define CAMBER_MAP_ZOOM_PLAN_H

#include "map/plan.h"

typedef struct camber_zoom_plan {
    camber_context *context;
    const camber_features *features;
    camber_view view; /* of the zoom, seen anywhere, or of the one picture */
    double simplify_px;
    float least_importance; /* of points that are drawn between the ends of lines */
    camber_plan plan;
    camber_stroke *strokes; /* by pair */
    /* How far from its lines a class touches pixels. Negative: it is not drawn. NULL for one picture. */
    float *class_reach_px;
    float most_reach_px;
    bool has_images; /* the background shows images, so it differs from place to place */
    bool has_area_images;
    bool lines_only; /* scenes leave areas out */
} camber_zoom_plan;

typedef struct camber_zoom_desc {
    double zoom;     /* MapLibre's; below 0 the style is evaluated at 0 */
    double scale_px; /* device px that the world is wide */
    double ratio;
    double simplify_px;
} camber_zoom_desc;

/* The zoom as a view of it, seen anywhere. */
camber_view camber_zoom_view(const camber_zoom_desc *desc);
/* The features must outlive the plan. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_zoom_plan_create(const camber_features *features, const camber_zoom_desc *desc,
                                      camber_zoom_plan **zoom);
/* Makes the plan of one picture. Returns also CAMBER_ERROR_ARGUMENT: a view out of range, or features whose points are
 * released. */
camber_status camber_zoom_plan_create_view(const camber_features *features, const camber_view_desc *desc,
                                           double simplify_px, camber_zoom_plan **zoom);
void camber_zoom_plan_destroy(camber_zoom_plan *zoom);
/* How far from a polyline pixels are touched, px; negative: it is not drawn. */
static inline float camber_zoom_plan_reach(const camber_zoom_plan *zoom, size_t polyline) {
    return zoom->class_reach_px[zoom->features->feature_class[zoom->features->polyline_feature[polyline]]];
}

#endif
