/* Computes the region of the world that a scene needs.
 *
 * Input: a style and a scene's view. Output: a box in world coordinates. No line outside it reaches the picture. Main
 * idea: the widths and offsets that the style can produce at the view's zoom are bounded before any feature is read.
 * The box is much larger than they require, because reading a few lines too many costs little. */
#include "map/view.h"

#include "base/perspective.h"
#include "features/features.h"
#include "map/zoom_labels.h"
#include "style/bounds.h"

#include <math.h>

/* The same values as in plan.c and projection.c. */
static const double WIDEST_PX = 16384.0, LARGEST_REACH_PX = 65536.0;
/* A margin for effects of the camera near a picture's edges, px. */
static const double SLACK_PX = 64.0;
/* How far outside a picture the anchor of a label may be if the label reaches into the picture, CSS px; and how far
 * what is there may matter to the labels of a zoom that are in the picture (zoom_labels.c). */
static const double LABEL_PX = 256.0, ZOOM_LABEL_PX = 1024.0;

static double bound(const camber_style_layer *layer, camber_property_id property, double zoom) {
    return camber_style_layer_bound(layer, property, zoom);
}

/* Returns the largest distance from its polylines that a layer reaches, in px. For a line this is half of its width,
 * its gap and both rails, at the tips of its joins, and its offset, which joins also lengthen. A fill has the defaults
 * of these properties, which are enough for its outline. A circle's reach is the sum of its radius and its stroke's
 * width. */
static double reach_of(const camber_style_layer *layer, const camber_view *view) {
    const double zoom = camber_view_style_zoom(view), ratio = view->ratio;
    const double width = fmin(bound(layer, CAMBER_LINE_WIDTH, zoom) * ratio, WIDEST_PX);
    const double gap = fmin(bound(layer, CAMBER_LINE_GAP_WIDTH, zoom) * ratio, WIDEST_PX);
    const double blur = fmin(bound(layer, CAMBER_LINE_BLUR, zoom) * ratio, WIDEST_PX);
    const double offset = fmin(bound(layer, CAMBER_LINE_OFFSET, zoom) * ratio, WIDEST_PX);
    const double limit =
        fmax(fmax(bound(layer, CAMBER_LINE_MITER_LIMIT, zoom), bound(layer, CAMBER_LINE_ROUND_LIMIT, zoom)), 2.0);
    const camber_layer_look look = camber_style_layer_look(layer, zoom);
    const double circle = fmin(
        (bound(layer, CAMBER_CIRCLE_RADIUS, zoom) + bound(layer, CAMBER_CIRCLE_STROKE_WIDTH, zoom)) * ratio, WIDEST_PX);
    const double half = layer->kind == CAMBER_LAYER_CIRCLE ? circle : 0.5 * gap + width + blur;
    const double moved = hypot(look.paint.translate[0], look.paint.translate[1]) * ratio;
    return fmin(half * limit, fmax(half, LARGEST_REACH_PX)) + fmin(offset * limit, fmax(offset, LARGEST_REACH_PX)) +
           fmin(moved, WIDEST_PX);
}

/* Returns the reach of all layers, or only of those with circles. */
static double reach_of_style(const camber_style *style, const camber_view *view, bool circles_only) {
    const double zoom = camber_view_style_zoom(view);
    double reach = 0.0;
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = style->layers + i;
        const bool out = zoom < layer->min_zoom || (zoom >= layer->max_zoom && layer->max_zoom < 24.0);
        const bool counts = layer->kind == CAMBER_LAYER_CIRCLE || !circles_only;
        if (layer->kind != CAMBER_LAYER_BACKGROUND && layer->kind != CAMBER_LAYER_SYMBOL && layer->visible && !out &&
            counts)
            reach = fmax(reach, reach_of(layer, view));
    }
    return reach;
}

/* Returns how much of the ground a pixel at the far plane covers if the view has a pitch, in px. */
static double far_pixel(const camber_view *view) {
    if (!(view->pitch_deg > 0.0))
        return 0.0;
    const camber_perspective p = camber_perspective_of(view->pitch_deg, view->height);
    return 4.0 * p.farthest * p.farthest / p.cosine;
}

double camber_view_margin(const camber_style *style, const camber_view *view, double simplify_px) {
    const double simplified = simplify_px >= 0.0 ? 2.0 * simplify_px : INFINITY;
    return (1.25 * reach_of_style(style, view, false) + simplified + far_pixel(view) + SLACK_PX) / view->scale_px;
}

double camber_view_circle_reach(const camber_style *style, const camber_view *view) {
    return reach_of_style(style, view, true);
}

double camber_view_label_reach(const camber_features *features, const camber_view *view) {
    return camber_features_label_kinds(features) ? LABEL_PX * view->ratio : 0.0;
}

camber_status camber_features_read_for(camber_features *features, const camber_scene_desc *scene) {
    camber_view view;
    double corners[8];
    features->has_region = false;
    if (!scene)
        return CAMBER_OK;
    const camber_status status = camber_view_create(features->context, &scene->view, &view);
    if (status != CAMBER_OK || scene->view.kind == CAMBER_VIEW_FIT)
        return status;
    camber_view_corners(&view, corners);
    camber_region region = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (int i = 0; i < 4; i++) {
        region.x0 = fmin(region.x0, corners[2 * i]);
        region.x1 = fmax(region.x1, corners[2 * i]);
        region.y0 = fmin(region.y0, corners[2 * i + 1]);
        region.y1 = fmax(region.y1, corners[2 * i + 1]);
    }
    double reach = camber_view_label_reach(features, &view);
    if (reach > 0.0 && camber_view_has_zoom_labels(features->style, &view))
        reach = ZOOM_LABEL_PX * view.ratio;
    const double margin = fmax(camber_view_margin(features->style, &view, scene->simplify_px), reach / view.scale_px);
    region = (camber_region){region.x0 - margin, region.y0 - margin, region.x1 + margin, region.y1 + margin};
    /* A picture about as wide as the world needs everything. */
    features->region = region;
    features->has_region = region.x1 - region.x0 < 0.5; /* false also if it is not finite */
    return CAMBER_OK;
}
