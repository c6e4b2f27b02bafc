/* Finds which features are drawn between two zooms, and the box around them.
 *
 * Input: features and zooms. Output: whether a class is drawn, and the box of everything that is drawn. A class is
 * tested at the last zoom first, because most styles draw everything there. */
#include "features/mercator.h"
#include "map/plan.h"

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

static bool labels_at(const camber_features *features, const camber_feature_class *class, double zoom) {
    for (size_t i = 0; i < features->style->layer_count; i++)
        if (camber_plan_labels(features, features->style->layers + i, zoom, class))
            return true;
    return false;
}

/* Whether features of the class have labels at any of the zooms, if labels are drawn. */
static bool labels(const camber_features *features, const camber_feature_class *class, double min_zoom,
                   double max_zoom) {
    if (!features->fonts || !class->labelled || !camber_geometry_is_label(class->geometry))
        return false;
    bool any = labels_at(features, class, max_zoom);
    for (double zoom = min_zoom; zoom < max_zoom && !any; zoom += 1.0)
        any = labels_at(features, class, zoom);
    return any;
}

/* ---- The box ---- */

static camber_box box_of(const camber_features *features, size_t polyline) {
    camber_box box = CAMBER_BOX_EMPTY;
    for (size_t i = features->offsets[polyline]; i < features->offsets[polyline + 1]; i++)
        if (isfinite(features->points[2 * i]) && isfinite(features->points[2 * i + 1]))
            camber_box_add(&box, features->points[2 * i], features->points[2 * i + 1]);
    return box;
}

static bool contains(const camber_box *box, const camber_box *other) {
    return other->x0 >= box->x0 && other->y0 >= box->y0 && other->x1 <= box->x1 && other->y1 <= box->y1;
}

static void join(camber_box *box, const camber_box *other) {
    camber_box_add(box, other->x0, other->y0);
    camber_box_add(box, other->x1, other->y1);
}

/* A class is tested only if one of its polylines makes the box larger. */
camber_status camber_plan_drawn_box(const camber_features *features, double min_zoom, double max_zoom,
                                    camber_box *box) {
    enum { UNKNOWN, DRAWN, HIDDEN };
    camber_box moved = CAMBER_BOX_EMPTY; /* with the western half of the world moved east of the eastern half */
    uint8_t *states = camber_alloc_zero(features->context, features->class_count, sizeof *states);
    *box = CAMBER_BOX_EMPTY;
    if (!states)
        return CAMBER_ERROR_MEMORY;
    for (size_t p = 0; p < features->polyline_count && features->points; p++) {
        const uint32_t class = features->feature_class[features->polyline_feature[p]];
        if (states[class] == HIDDEN)
            continue;
        const camber_box own = box_of(features, p);
        const double shift = 0.5 * (own.x0 + own.x1) < 0.5 ? 1.0 : 0.0;
        const camber_box own_moved = {own.x0 + shift, own.y0, own.x1 + shift, own.y1};
        if (own.x0 > own.x1 || (contains(box, &own) && contains(&moved, &own_moved)))
            continue;
        if (states[class] == UNKNOWN)
            states[class] = camber_plan_draws(features, features->classes + class, min_zoom, max_zoom) ||
                                    labels(features, features->classes + class, min_zoom, max_zoom)
                                ? DRAWN
                                : HIDDEN;
        if (states[class] == HIDDEN)
            continue;
        join(box, &own);
        join(&moved, &own_moved);
    }
    if (moved.x1 - moved.x0 < box->x1 - box->x0)
        *box = moved;
    camber_free(features->context, states);
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
