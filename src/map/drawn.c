/* Finds which features are drawn between two zooms, and the box around them.
 *
 * Input: features and zooms. Output: whether a class is drawn, and the box of everything that is drawn. A class is
 * tested at the last zoom first, because most styles draw everything there. */
#include "features/mercator.h"
#include "map/label_things.h"
#include "map/plan.h"
#include "style/expression.h"

#include <math.h>

static bool is_painted(const camber_style_layer *layer, double zoom, const camber_feature_view *feature) {
    const camber_layer_paint paint = camber_style_layer_paint(layer, zoom, feature);
    if (layer->kind == CAMBER_LAYER_CIRCLE)
        return (paint.color.a > 0.0f && paint.radius > 0.0) ||
               (paint.stroke_color.a > 0.0f && paint.stroke_width > 0.0);
    const bool visible = paint.color.a > 0.0f || paint.border_color.a > 0.0f ||
                         layer->properties[CAMBER_FILL_PATTERN] || layer->properties[CAMBER_LINE_PATTERN] ||
                         layer->ramp.count;
    return visible && paint.layer_opacity > 0.0 && (layer->kind == CAMBER_LAYER_FILL || paint.width > 0.0);
}

static bool draws_at(const camber_features *features, const camber_feature_class *class, double zoom) {
    const camber_feature_view feature = camber_plan_view_of(features, class);
    for (size_t i = 0; i < features->style->layer_count; i++) {
        const camber_style_layer *layer = features->style->layers + i;
        if (camber_plan_takes(features, layer, zoom, class) && is_painted(layer, zoom, &feature))
            return true;
    }
    return false;
}

bool camber_plan_draws(const camber_features *features, const camber_feature_class *class, double min_zoom,
                       double max_zoom) {
    if (camber_geometry_is_label(class->geometry))
        return false;
    bool any = draws_at(features, class, max_zoom);
    for (double zoom = min_zoom; zoom < max_zoom && !any; zoom += 1.0)
        any = draws_at(features, class, zoom);
    return any;
}

/* Whether a layer labels the class at any of the zooms. There are many classes, because names differ, so a filter that
 * does not read the zoom is evaluated once. */
static bool layer_labels(const camber_features *features, const camber_style_layer *layer,
                         const camber_feature_class *class, double min_zoom, double max_zoom) {
    const bool reads_zoom = layer->filter && layer->filter->reads_zoom;
    const bool active = layer->min_zoom <= max_zoom && (max_zoom < layer->max_zoom || layer->max_zoom >= 24.0);
    bool any = camber_plan_labels(features, layer, max_zoom, class);
    for (double zoom = min_zoom; zoom < max_zoom && !any && (reads_zoom || !active); zoom += 1.0)
        any = camber_plan_labels(features, layer, zoom, class);
    return any;
}

/* Whether features of the class have labels at any of the zooms, if labels are drawn. */
static bool labels(const camber_features *features, const camber_feature_class *class, double min_zoom,
                   double max_zoom) {
    if (!features->fonts || !class->labelled || !camber_geometry_is_label(class->geometry))
        return false;
    bool any = false;
    for (size_t i = 0; i < features->style->layer_count && !any; i++)
        any = layer_labels(features, features->style->layers + i, class, min_zoom, max_zoom);
    return any;
}

/* ---- The box ---- */

static void add_box(const camber_box *added, double shift, camber_box *box) {
    if (added->x0 > added->x1)
        return;
    camber_box_add(box, added->x0 + shift, added->y0);
    camber_box_add(box, added->x1 + shift, added->y1);
}

camber_status camber_plan_drawn_box(const camber_features *features, double min_zoom, double max_zoom,
                                    camber_box *box) {
    camber_box moved = CAMBER_BOX_EMPTY; /* with the western half of the world moved east of the eastern half */
    bool *drawn = camber_alloc_zero(features->context, features->class_count, sizeof *drawn);
    *box = CAMBER_BOX_EMPTY;
    if (!drawn)
        return CAMBER_ERROR_MEMORY;
    for (size_t c = 0; c < features->class_count; c++)
        drawn[c] = camber_plan_draws(features, features->classes + c, min_zoom, max_zoom) ||
                   labels(features, features->classes + c, min_zoom, max_zoom);
    for (size_t p = 0; p < features->polyline_count && features->points; p++) {
        if (!drawn[features->feature_class[features->polyline_feature[p]]])
            continue;
        const camber_box own = camber_label_box_of(features, p, p + 1);
        add_box(&own, 0.0, box);
        add_box(&own, 0.5 * (own.x0 + own.x1) < 0.5 ? 1.0 : 0.0, &moved);
    }
    if (moved.x1 - moved.x0 < box->x1 - box->x0)
        *box = moved;
    camber_free(features->context, drawn);
    return CAMBER_OK;
}

bool camber_plan_unproject_box(const camber_box *box, double bounds[4]) {
    if (box->x0 > box->x1)
        return false;
    camber_mercator_unproject(box->x0, box->y1, &bounds[0], &bounds[1]);
    camber_mercator_unproject(box->x1 > 1.0 ? box->x1 - 1.0 : box->x1, box->y0, &bounds[2], &bounds[3]);
    return true;
}

bool camber_features_get_drawn_bounds(const camber_features *features, double min_zoom, double max_zoom,
                                      double bounds[4]) {
    camber_box box;
    return camber_plan_drawn_box(features, min_zoom, max_zoom, &box) == CAMBER_OK &&
           camber_plan_unproject_box(&box, bounds);
}
