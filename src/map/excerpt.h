/* Excerpts: what a style draws of some lines at one zoom, for pictures that are parts of a larger one.
 *
 * A zoom plan evaluates the style once a zoom. An excerpt of it is a network of the lines that reach into one window of
 * the world, at this zoom's simplification, with its passes. Neighbouring excerpts draw what one scene would draw:
 * dashes, gradients and patterns go by whole lines, and a line near the antimeridian is in both halves of the world. */
#ifndef CAMBER_MAP_EXCERPT_H
#define CAMBER_MAP_EXCERPT_H

#include "map/passes.h"

typedef struct camber_zoom_plan {
    camber_context *context;
    const camber_features *features;
    camber_view view; /* of the zoom, seen anywhere */
    double simplify_px;
    float least_importance; /* of points that are drawn between the ends of lines */
    camber_plan plan;
    camber_stroke *strokes; /* by pair */
    float *class_reach_px;  /* how far from its lines a class touches pixels. Negative: it is not drawn */
    float most_reach_px;
    bool has_images; /* the background shows images, so it differs from place to place */
    bool has_area_images;
    bool lines_only; /* excerpts leave areas out */
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
void camber_zoom_plan_destroy(camber_zoom_plan *zoom);
/* How far from a polyline pixels are touched, px; negative: it is not drawn. */
static inline float camber_zoom_plan_reach(const camber_zoom_plan *zoom, size_t polyline) {
    return zoom->class_reach_px[zoom->features->feature_class[zoom->features->polyline_feature[polyline]]];
}

/* A rectangle of pixels whose centre lies at x, y of the world. */
typedef struct camber_excerpt_window {
    double x, y;
    uint32_t width, height; /* px */
} camber_excerpt_window;

typedef struct camber_excerpt {
    camber_zoom_plan *zoom;
    camber_excerpt_window window;
    camber_network *network;
    size_t *first_entries; /* set_count + 1 */
    camber_pass_list passes;
} camber_excerpt;

/* polylines: ascending, and all that reach into the window; others may be among them.
 * camber_excerpt_free frees also what a failure left. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_excerpt_make(camber_zoom_plan *zoom, const uint32_t *polylines, size_t polyline_count,
                                  const camber_excerpt_window *window, camber_excerpt *excerpt);
void camber_excerpt_free(camber_excerpt *excerpt);
/* Returns what camber_mesh_tessellate_network returns. */
camber_status camber_excerpt_tessellate(const camber_excerpt *excerpt, camber_mesh *mesh);
/* The frame that draws the excerpt with the mesh that was tessellated. It is valid until the excerpt is freed, and the
 * images of fills lie in it as they do in its window until another frame of the zoom is asked for. */
camber_frame camber_excerpt_get_frame(camber_excerpt *excerpt, camber_mesh *mesh);

#endif
