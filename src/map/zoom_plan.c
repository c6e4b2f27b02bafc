/* Evaluates a style for a zoom: makes its plan, and finds how far the strokes of each class reach.
 *
 * Input: features, and a zoom or a view. Output: camber_zoom_plan. Scenes are windows of it. */
#include "map/zoom_plan.h"

#include "map/plan_network.h"

#include <math.h>

static camber_status find_strokes(camber_zoom_plan *zoom) {
    const camber_plan *plan = &zoom->plan;
    if (!(zoom->strokes = camber_alloc(zoom->context, plan->pair_count, sizeof *zoom->strokes)))
        return CAMBER_ERROR_MEMORY;
    for (size_t pair = 0; pair < plan->pair_count; pair++)
        zoom->strokes[pair] = plan->strokes[plan->pair_rows[pair]];
    return CAMBER_OK;
}

/* Finds how far each class reaches. A class may have several pairs, and all of them draw it. */
static camber_status find_reaches(camber_zoom_plan *zoom) {
    const camber_plan *plan = &zoom->plan;
    const size_t class_count = zoom->features->class_count;
    if (!(zoom->class_reach_px = camber_alloc(zoom->context, class_count, sizeof *zoom->class_reach_px)))
        return CAMBER_ERROR_MEMORY;
    for (size_t c = 0; c < class_count; c++) {
        float reach = -1.0f;
        for (size_t k = plan->by_class.first[c]; k < plan->by_class.first[c + 1]; k++) {
            const camber_stroke *stroke = zoom->strokes + plan->by_class.pairs[k].pair;
            reach = fmaxf(reach, (float)camber_plan_stroke_reach(stroke) + plan->translate_px + 1.0f);
        }
        zoom->class_reach_px[c] = reach;
        zoom->most_reach_px = fmaxf(zoom->most_reach_px, reach);
    }
    for (size_t i = 0; i < plan->patterns.fill_count; i++)
        zoom->has_images = zoom->has_images || plan->patterns.fills[i].image;
    for (size_t i = 0; i < plan->patterns.area_count; i++)
        zoom->has_area_images = zoom->has_area_images || plan->patterns.areas[i].image;
    return CAMBER_OK;
}

camber_view camber_zoom_view(const camber_zoom_desc *desc) {
    return (camber_view){.x = 0.5,
                         .y = 0.5,
                         .zoom = desc->zoom,
                         .scale_px = desc->scale_px,
                         .cosine = 1.0,
                         .ratio = desc->ratio,
                         .width = 1,
                         .height = 1};
}

static camber_zoom_plan *make_bare(const camber_features *features, double simplify_px) {
    camber_zoom_plan *made = camber_alloc_zero(features->context, 1, sizeof *made);
    if (made) {
        made->context = made->plan.context = features->context;
        made->features = features;
        made->simplify_px = simplify_px;
    }
    return made;
}

camber_status camber_zoom_plan_create(const camber_features *features, const camber_zoom_desc *desc,
                                      camber_zoom_plan **zoom) {
    camber_zoom_plan *made = make_bare(features, desc->simplify_px);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->least_importance = (float)(desc->simplify_px / desc->scale_px);
    made->view = camber_zoom_view(desc);
    camber_status status = camber_plan_evaluate(features, &made->view, &made->plan);
    if (status == CAMBER_OK)
        status = find_strokes(made);
    if (status == CAMBER_OK)
        status = find_reaches(made);
    if (status == CAMBER_OK)
        *zoom = made;
    else
        camber_zoom_plan_destroy(made);
    return status;
}

camber_status camber_zoom_plan_create_view(const camber_features *features, const camber_view_desc *desc,
                                           double simplify_px, camber_zoom_plan **zoom) {
    camber_zoom_plan *made = make_bare(features, simplify_px);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    camber_status status = camber_view_create(features->context, desc, &made->view);
    made->features_key = camber_features_key(features);
    if (status == CAMBER_OK && features->polyline_count && !features->points)
        status = camber_fail(features->context, CAMBER_ERROR_ARGUMENT,
                             "scene: the points of its features have been released; read the features again");
    if (status == CAMBER_OK)
        status = desc->kind == CAMBER_VIEW_FIT ? camber_plan_fit(features, &made->view, &made->plan)
                                               : camber_plan_create(features, &made->view, &made->plan);
    /* Like camber_network_aim: with a pitch, the tolerance is smaller near the camera. */
    if (status == CAMBER_OK && !(made->view.pitch_deg > 0.0))
        made->least_importance = (float)(simplify_px / made->view.scale_px);
    if (status == CAMBER_OK)
        status = find_strokes(made);
    if (status == CAMBER_OK)
        *zoom = made;
    else
        camber_zoom_plan_destroy(made);
    return status;
}

bool camber_zoom_plan_move(camber_zoom_plan *zoom, const camber_view *view) {
    const camber_features *features = zoom->features;
    const bool has_points = features->points || !features->polyline_count; /* another network may need them */
    if (!has_points || zoom->features_key != camber_features_key(features) ||
        camber_view_key(view) != camber_view_key(&zoom->view))
        return false;
    zoom->view = *view;
    camber_plan_patterns_move(&zoom->plan.patterns, view);
    return true;
}

void camber_zoom_plan_destroy(camber_zoom_plan *zoom) {
    if (!zoom)
        return;
    camber_plan_destroy(&zoom->plan);
    camber_free(zoom->context, zoom->class_reach_px);
    camber_free(zoom->context, zoom->strokes);
    camber_free(zoom->context, zoom);
}
