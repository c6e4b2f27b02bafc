/* Scenes: a view of features in a style, ready to tessellate and draw.
 *
 * Input: features and a view. Output: a network of the lines that the style draws, the strokes and passes that a mesh
 * of it is drawn with, and the camera. Main idea: the plan says which style layers draw which features; the network is
 * made once for a plan, and stays while the view moves and the plan does not change. camber_scene_project makes the
 * same on the host, by the CPU twin. */
#include "map/passes.h"
#include "map/plan_areas.h"
#include "map/plan_network.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

struct camber_scene {
    camber_context *context;
    const camber_features *features;
    double simplify_px;
    bool still, lines_only;
    camber_features *spent; /* the features while their points may go; then NULL */

    camber_view view;
    camber_plan plan;
    camber_plan_network geometry;
    camber_stroke *pair_strokes;
    camber_pass_list pair_passes;

    /* On the host: nothing until camber_scene_project. */
    bool is_projected;
    camber_visible_lines seen;
    camber_scene_info counts; /* of what was projected, until the scene moves; the rest is 0 */
    camber_polylines *polylines;
    camber_pass_list passes;
};

/* ---- Strokes ---- */

static camber_status make_strokes(camber_scene *scene) {
    const camber_plan *plan = &scene->plan;
    scene->pair_strokes = camber_alloc(scene->context, plan->pair_count, sizeof *scene->pair_strokes);
    if (!scene->pair_strokes)
        return CAMBER_ERROR_MEMORY;
    for (size_t pair = 0; pair < plan->pair_count; pair++)
        scene->pair_strokes[pair] = plan->strokes[plan->pair_rows[pair]];
    return CAMBER_OK;
}

/* ---- Passes ---- */

/* Makes the passes over the network, where every pair has an entry somewhere. */
static camber_status make_pair_passes(camber_scene *scene) {
    size_t layer_count;
    bool *used = camber_alloc_zero(scene->context, scene->plan.pair_count, sizeof *used);
    if (!used)
        return CAMBER_ERROR_MEMORY;
    const size_t count = scene->geometry.first_entries[scene->plan.set_count];
    for (size_t i = 0; i < count; i++)
        used[scene->geometry.entries[i].row] = true;
    const camber_numbering n = {&scene->plan, true, scene->geometry.first_entries, used};
    const camber_status status = camber_passes_make(scene->context, &n, &layer_count, &scene->pair_passes);
    camber_free(scene->context, used);
    return status;
}

/* ---- On the host ---- */

static camber_camera camera_of(const camber_scene *scene) {
    const camber_view *view = &scene->view;
    return (camber_camera){.x = view->x,
                           .y = view->y,
                           .scale_px = view->scale_px,
                           .bearing_deg = view->bearing_deg,
                           .pitch_deg = view->pitch_deg,
                           .width = view->width,
                           .height = view->height,
                           .simplify_px = scene->simplify_px,
                           .translate_px = (double)scene->plan.translate_px};
}

static camber_tessellation_desc desc_of(const camber_scene *scene, camber_method method) {
    return (camber_tessellation_desc){.strokes = scene->pair_strokes,
                                      .stroke_count = scene->plan.pair_count,
                                      .method = method,
                                      .has_arc_length = scene->plan.has_arc_length};
}

static void forget(camber_scene *scene) {
    camber_passes_free(scene->context, &scene->passes);
    camber_polylines_destroy(scene->polylines);
    camber_visible_lines_destroy(&scene->seen);
    scene->passes = (camber_pass_list){0};
    scene->polylines = NULL;
    scene->is_projected = false;
}

static camber_status make_row_passes(camber_scene *scene) {
    bool *used = camber_alloc_zero(scene->context, scene->plan.row_count, sizeof *used);
    if (!used)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < scene->seen.lines.polyline_count; i++)
        used[scene->seen.rows[i]] = true;
    const camber_numbering n = {&scene->plan, false, scene->seen.first_polylines, used};
    const camber_status status = camber_passes_make(scene->context, &n, &scene->counts.layers, &scene->passes);
    camber_free(scene->context, used);
    return status;
}

camber_status camber_scene_project(camber_scene *scene) {
    if (scene->is_projected)
        return CAMBER_OK;
    const camber_camera camera = camera_of(scene);
    const camber_tessellation_desc strokes = desc_of(scene, CAMBER_METHOD_STRIP);
    camber_status status =
        camber_plan_network_project(scene->features, &scene->geometry, &scene->plan, &camera, &strokes, &scene->seen);
    const camber_lines *lines = &scene->seen.lines;
    const camber_polylines_desc desc = {.points = lines->points,
                                        .point_count = lines->point_count,
                                        .offsets = lines->offsets,
                                        .polyline_count = lines->polyline_count,
                                        .rows = scene->seen.rows};
    if (status == CAMBER_OK)
        status = camber_polylines_create(scene->context, &desc, &scene->polylines);
    if (status == CAMBER_OK)
        status = make_row_passes(scene);
    if (status != CAMBER_OK) {
        forget(scene);
        scene->counts = (camber_scene_info){0};
        return status;
    }
    scene->is_projected = true;
    scene->counts.features = scene->seen.feature_count;
    scene->counts.polylines = scene->seen.lines.polyline_count;
    scene->counts.points = scene->seen.lines.point_count;
    scene->counts.points_in = scene->seen.points_in;
    return CAMBER_OK;
}

void camber_scene_release_lines(camber_scene *scene) {
    forget(scene);
}

/* ---- The scene ---- */

/* The network then has none of them. */
static void leave_out_areas(camber_plan *plan) {
    size_t count = 0;
    for (size_t s = 0, end = 0; s < plan->set_count; s++) {
        const size_t first = end;
        end = plan->all.first_entries[s + 1];
        plan->all.first_entries[s] = count;
        for (size_t i = first; i < end && !camber_plan_is_area(plan, plan->sets + s); i++)
            plan->all.entries[count++] = plan->all.entries[i];
    }
    plan->all.first_entries[plan->set_count] = count;
}

/* Makes the network. Points that the view leaves out go first, if the scene may drop them: else most of them would be
 * in memory beside the network. */
static camber_status make_geometry(camber_scene *scene) {
    /* As camber_network_aim has it: with a pitch the tolerance is smaller near the camera. */
    const bool flat = !(scene->view.pitch_deg > 0.0);
    const camber_still still = {flat ? (float)(scene->simplify_px / scene->view.scale_px) : 0.0f};
    if (scene->lines_only)
        leave_out_areas(&scene->plan);
    camber_status status = CAMBER_OK;
    if (scene->spent && !scene->plan.has_arc_length && !scene->plan.has_corners)
        status = camber_features_thin(scene->spent, still.least_importance);
    if (status == CAMBER_OK)
        status = camber_plan_network_create(scene->features, &scene->view, &scene->plan, scene->still ? &still : NULL,
                                            &scene->geometry);
    if (scene->spent && status == CAMBER_OK)
        camber_features_release_points(scene->spent);
    scene->spent = NULL;
    return status;
}

static camber_status look(camber_scene *scene, const camber_view_desc *desc, camber_plan_network *geometry) {
    camber_status status = camber_view_create(scene->context, desc, &scene->view);
    if (status == CAMBER_OK && scene->features->polyline_count && !scene->features->points)
        status = camber_fail(scene->context, CAMBER_ERROR_ARGUMENT,
                             "scene: the points of its features are released; read them into another set");
    if (status != CAMBER_OK)
        return status;
    status = desc->kind == CAMBER_VIEW_FIT ? camber_plan_fit(scene->features, &scene->view, &scene->plan)
                                           : camber_plan_create(scene->features, &scene->view, &scene->plan);
    if (status != CAMBER_OK)
        return status;
    if (!scene->still && camber_plan_network_serves(geometry, &scene->view, &scene->plan)) {
        scene->geometry = *geometry;
        *geometry = (camber_plan_network){0};
    } else {
        status = make_geometry(scene);
    }
    if (status == CAMBER_OK)
        status = make_strokes(scene);
    return status == CAMBER_OK ? make_pair_passes(scene) : status;
}

static void empty(camber_scene *scene) {
    forget(scene);
    camber_passes_free(scene->context, &scene->pair_passes);
    camber_free(scene->context, scene->pair_strokes);
    camber_plan_network_destroy(&scene->geometry);
    camber_plan_destroy(&scene->plan);
}

static camber_scene bare_scene(const camber_features *features, double simplify_px, bool lines_only) {
    return (camber_scene){.context = features->context,
                          .features = features,
                          .simplify_px = simplify_px,
                          .lines_only = lines_only,
                          .plan = {.context = features->context}};
}

static bool has_patterns(const camber_plan *plan) {
    for (size_t i = 0; i < plan->layer_count; i++)
        if (plan->layers[i].look.layer->properties[CAMBER_LINE_PATTERN] ||
            plan->layers[i].look.layer->properties[CAMBER_FILL_PATTERN])
            return true;
    return false;
}

/* Warns where a style draws nothing at all; what else it leaves out is its own business. Images of patterns that are
 * not there were warned of already. */
static camber_status tell_undrawn(const camber_scene *scene) {
    const size_t undrawn = scene->plan.undrawn, all = scene->features->feature_count;
    const double zoom = scene->view.zoom;
    char why[1024];
    bool draws;
    if (has_patterns(&scene->plan))
        return CAMBER_OK;
    if (undrawn && undrawn < all)
        camber_log(scene->context, CAMBER_LOG_INFO, "style: draws nothing of %zu of %zu features", undrawn, all);
    if (!undrawn || undrawn < all)
        return CAMBER_OK;
    const camber_status status = camber_plan_explain_nothing(scene->features, zoom, zoom, why, sizeof why, &draws);
    if (status == CAMBER_OK)
        camber_log(scene->context, CAMBER_LOG_WARNING, "nothing is drawn: %s", why);
    return status;
}

/* Says that circles lie on the map, unless their layers ask for that. */
static void tell_pitch(const camber_scene *scene) {
    const camber_plan *plan = &scene->plan;
    for (size_t i = 0; i < plan->layer_count && scene->view.pitch_deg > 0.0; i++) {
        const camber_layer_paint *paint = &plan->layers[i].look.paint;
        if (plan->layers[i].part != CAMBER_PLAN_CIRCLES ||
            (paint->pitch_alignment == CAMBER_TRANSLATE_MAP && paint->pitch_scale == CAMBER_TRANSLATE_MAP))
            continue;
        camber_log(scene->context, CAMBER_LOG_WARNING,
                   "style: with a pitch circles lie flat on the map, as circle-pitch-alignment and circle-pitch-scale "
                   "\"map\" have it; give these to layer \"%.64s\" if that is meant",
                   plan->layers[i].look.layer->id);
        return;
    }
}

camber_status camber_scene_create(const camber_features *features, const camber_scene_desc *desc,
                                  camber_scene **scene) {
    camber_context *context = features->context;
    if (!(desc->simplify_px >= 0.0 && isfinite(desc->simplify_px)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "scene: a simplification of %g px; choose 0 or a distance in pixels", desc->simplify_px);
    camber_scene *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    camber_plan_network none = {0};
    *made = bare_scene(features, desc->simplify_px, desc->lines_only);
    assert(!desc->spent || (desc->still && desc->spent == features));
    made->still = desc->still;
    made->spent = desc->spent;
    camber_status status = look(made, &desc->view, &none);
    if (status == CAMBER_OK && !desc->on_device)
        status = camber_scene_project(made);
    if (status == CAMBER_OK)
        status = tell_undrawn(made);
    if (status != CAMBER_OK) {
        camber_scene_destroy(made);
        return status;
    }
    tell_pitch(made);
    if (made->plan.patterns.unread)
        camber_log(context, CAMBER_LOG_WARNING,
                   "style: its patterns are left out, for its sprites are not read; read them with the features");
    *scene = made;
    return CAMBER_OK;
}

camber_status camber_scene_move(camber_scene *scene, const camber_view_desc *view) {
    camber_scene moved = bare_scene(scene->features, scene->simplify_px, scene->lines_only);
    moved.still = scene->still;
    /* The network belongs to one of the two, never to both. */
    camber_plan_network geometry = scene->geometry;
    const camber_status status = look(&moved, view, &geometry);
    if (status != CAMBER_OK) {
        if (!geometry.context)
            moved.geometry = (camber_plan_network){0};
        empty(&moved);
        return status;
    }
    scene->geometry = geometry;
    empty(scene);
    *scene = moved;
    return CAMBER_OK;
}

camber_status camber_scene_tessellate(const camber_scene *scene, camber_mesh *mesh, camber_method method) {
    const camber_camera camera = camera_of(scene);
    const camber_tessellation_desc desc = desc_of(scene, method);
    return camber_mesh_tessellate_network(mesh, scene->geometry.network, &camera, &desc);
}

camber_network *camber_scene_get_network(const camber_scene *scene, camber_camera *camera,
                                         camber_tessellation_desc *desc) {
    *camera = camera_of(scene);
    *desc = desc_of(scene, CAMBER_METHOD_STRIP);
    return scene->geometry.network;
}

camber_status camber_scene_triangulate(const camber_scene *scene, camber_area_data *areas) {
    return camber_plan_triangulate(scene->features, &scene->plan, &scene->view, scene->simplify_px, areas);
}

void camber_scene_destroy(camber_scene *scene) {
    if (!scene)
        return;
    camber_context *context = scene->context;
    empty(scene);
    camber_free(context, scene);
}

/* ---- Getters ---- */

camber_scene_info camber_scene_get_info(const camber_scene *scene) {
    camber_scene_info info = {.zoom = scene->view.zoom,
                              .bearing_deg = scene->view.bearing_deg,
                              .pitch_deg = scene->view.pitch_deg,
                              .width = scene->view.width,
                              .height = scene->view.height,
                              .opaque = scene->plan.background.a >= 1.0f,
                              .undrawn = scene->plan.undrawn};
    camber_view_center(&scene->view, &info.longitude, &info.latitude);
    info.layers = scene->counts.layers;
    info.features = scene->counts.features;
    info.polylines = scene->counts.polylines;
    info.points = scene->counts.points;
    info.points_in = scene->counts.points_in;
    return info;
}

const camber_polylines *camber_scene_get_polylines(const camber_scene *scene) {
    assert(scene->is_projected);
    return scene->polylines;
}

const uint32_t *camber_scene_get_rows(const camber_scene *scene) {
    assert(scene->is_projected);
    return scene->seen.rows;
}

const camber_lines *camber_scene_get_lines(const camber_scene *scene) {
    assert(scene->is_projected);
    return &scene->seen.lines;
}

const camber_stroke *camber_scene_get_strokes(const camber_scene *scene, size_t *count) {
    *count = scene->plan.row_count;
    return scene->plan.strokes;
}

camber_frame camber_scene_get_frame(camber_scene *scene, camber_mesh *mesh) {
    const bool holds_network = mesh && camber_mesh_holds_network(mesh, scene->geometry.network);
    assert(holds_network || scene->is_projected);
    const camber_pass_list *list = holds_network ? &scene->pair_passes : &scene->passes;
    for (size_t i = 0; i < list->count; i++)
        list->passes[i].mesh = mesh;
    return (camber_frame){.width = scene->view.width,
                          .height = scene->view.height,
                          .background = scene->plan.background,
                          .passes = list->passes,
                          .pass_count = list->count,
                          .pitch_deg = scene->view.pitch_deg};
}
