/* Scenes: a view of features in a style, ready to tessellate and draw.
 *
 * Input: features and a view, or a plan of a zoom and a window of it. Output: a network of the lines that the style
 * draws there, the passes that a mesh of it is drawn with, and the camera. Main idea: the plan says which style layers
 * draw which features; the network is made once for a plan, and stays while the view moves and the plan does not
 * change. Of a window it has only the lines that reach into it, and the points that the zoom's simplification keeps, so
 * the memory that drawing takes does not grow with the data. camber_scene_project makes the same on the host, by the
 * CPU twin. */
#include "map/scene.h"
#include "map/passes.h"
#include "map/plan_areas.h"
#include "map/plan_network.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

struct camber_scene {
    camber_context *context;
    camber_scene_use use;
    camber_zoom_plan *zoom;
    camber_zoom_plan *own; /* the same if it goes with the scene. NULL: it has other windows, too */

    camber_view view;
    camber_plan_network geometry;
    camber_pass_list pair_passes;

    /* On the host: nothing until camber_scene_project. */
    bool is_projected;
    camber_visible_lines seen;
    camber_scene_info counts; /* of what was projected, until the scene moves; the rest is 0 */
    camber_polylines *polylines;
    camber_pass_list passes;
};

/* Makes the passes over the network, where every pair has an entry somewhere. */
static camber_status make_pair_passes(camber_scene *scene) {
    size_t layer_count;
    const camber_plan *plan = &scene->zoom->plan;
    bool *used = camber_alloc_zero(scene->context, plan->pair_count, sizeof *used);
    if (!used)
        return CAMBER_ERROR_MEMORY;
    const size_t count = scene->geometry.first_entries[plan->set_count];
    for (size_t i = 0; i < count; i++)
        used[scene->geometry.entries[i].row] = true;
    const camber_numbering n = {plan, true, scene->geometry.first_entries, used};
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
                           .simplify_px = scene->zoom->simplify_px,
                           .translate_px = (double)scene->zoom->plan.translate_px};
}

static camber_tessellation_desc desc_of(const camber_scene *scene, camber_method method) {
    return (camber_tessellation_desc){.strokes = scene->zoom->strokes,
                                      .stroke_count = scene->zoom->plan.pair_count,
                                      .method = method,
                                      .has_arc_length = scene->zoom->plan.has_arc_length};
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
    const camber_plan *plan = &scene->zoom->plan;
    bool *used = camber_alloc_zero(scene->context, plan->row_count, sizeof *used);
    if (!used)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < scene->seen.lines.polyline_count; i++)
        used[scene->seen.rows[i]] = true;
    const camber_numbering n = {plan, false, scene->seen.first_polylines, used};
    const camber_status status = camber_passes_make(scene->context, &n, &scene->counts.layers, &scene->passes);
    camber_free(scene->context, used);
    return status;
}

camber_status camber_scene_project(camber_scene *scene) {
    if (scene->is_projected)
        return CAMBER_OK;
    const camber_camera camera = camera_of(scene);
    const camber_tessellation_desc strokes = desc_of(scene, CAMBER_METHOD_STRIP);
    camber_status status = camber_plan_network_project(scene->zoom, &scene->geometry, &camera, &strokes, &scene->seen);
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

/* Makes the network. Points that the view leaves out go first, if those of the features may go: else most of them would
 * be in memory beside the network. */
static camber_status make_geometry(camber_scene *scene, camber_features *spent) {
    camber_zoom_plan *zoom = scene->zoom;
    const bool stays = scene->use == CAMBER_SCENE_ONE_VIEW;
    camber_status status = CAMBER_OK;
    if (spent && !zoom->plan.has_arc_length && !zoom->plan.has_corners)
        status = camber_features_thin(spent, zoom->least_importance);
    if (status == CAMBER_OK)
        status = camber_plan_network_create(zoom, &scene->view, stays ? CAMBER_NETWORK_VIEW : CAMBER_NETWORK_VIEWS,
                                            &zoom->plan.all, &scene->geometry);
    if (status == CAMBER_OK && spent)
        camber_features_release_points(spent);
    return status;
}

/* Makes the scene of a whole view. former: a network that is taken if it serves this view, too. */
static camber_status look(camber_scene *scene, const camber_features *features, const camber_scene_desc *desc,
                          camber_plan_network *former, camber_features *spent) {
    camber_status status = camber_zoom_plan_create_view(features, &desc->view, desc->simplify_px, &scene->own);
    if (status != CAMBER_OK)
        return status;
    scene->zoom = scene->own;
    scene->zoom->lines_only = scene->use == CAMBER_SCENE_LINES;
    scene->view = scene->zoom->view;
    if (scene->use != CAMBER_SCENE_ONE_VIEW && camber_plan_network_serves(former, &scene->view, &scene->zoom->plan)) {
        scene->geometry = *former;
        *former = (camber_plan_network){0};
    } else {
        status = make_geometry(scene, spent);
    }
    return status == CAMBER_OK ? make_pair_passes(scene) : status;
}

static void empty(camber_scene *scene) {
    forget(scene);
    camber_passes_free(scene->context, &scene->pair_passes);
    camber_plan_network_destroy(&scene->geometry);
    camber_zoom_plan_destroy(scene->own);
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
    const camber_features *features = scene->zoom->features;
    const size_t undrawn = scene->zoom->plan.undrawn, all = features->feature_count;
    const double zoom = scene->view.zoom;
    char why[1024];
    bool draws;
    if (has_patterns(&scene->zoom->plan))
        return CAMBER_OK;
    if (undrawn && undrawn < all)
        camber_log(scene->context, CAMBER_LOG_INFO, "style: no layer draws %zu of the %zu features", undrawn, all);
    if (!undrawn || undrawn < all)
        return CAMBER_OK;
    const camber_status status = camber_plan_explain_nothing(features, zoom, zoom, why, sizeof why, &draws);
    if (status == CAMBER_OK)
        camber_log(scene->context, CAMBER_LOG_WARNING, "nothing is drawn: %s", why);
    return status;
}

/* Says that circles lie on the map, unless their layers ask for that. */
static void tell_pitch(const camber_scene *scene) {
    const camber_plan *plan = &scene->zoom->plan;
    for (size_t i = 0; i < plan->layer_count && scene->view.pitch_deg > 0.0; i++) {
        const camber_layer_paint *paint = &plan->layers[i].look.paint;
        if (plan->layers[i].part != CAMBER_PLAN_CIRCLES ||
            (paint->pitch_alignment == CAMBER_TRANSLATE_MAP && paint->pitch_scale == CAMBER_TRANSLATE_MAP))
            continue;
        camber_log(scene->context, CAMBER_LOG_WARNING,
                   "style: with a pitch, circles lie flat on the map, as if circle-pitch-alignment and "
                   "circle-pitch-scale were \"map\"; set these in layer \"%.64s\" if that is meant",
                   plan->layers[i].look.layer->id);
        return;
    }
}

static camber_status create(const camber_features *features, const camber_scene_desc *desc, camber_features *spent,
                            camber_scene **scene) {
    camber_context *context = features->context;
    if (!(desc->simplify_px >= 0.0 && isfinite(desc->simplify_px)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "scene: a simplification of %g px; choose 0 or a distance in pixels", desc->simplify_px);
    camber_scene *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    camber_plan_network none = {0};
    made->context = context;
    made->use = desc->use;
    camber_status status = look(made, features, desc, &none, spent);
    if (status == CAMBER_OK)
        status = tell_undrawn(made);
    if (status != CAMBER_OK) {
        camber_scene_destroy(made);
        return status;
    }
    tell_pitch(made);
    if (made->zoom->plan.patterns.unread)
        camber_log(context, CAMBER_LOG_WARNING,
                   "style: its patterns are left out, because its sprites were not read; read them with the features");
    *scene = made;
    return CAMBER_OK;
}

camber_status camber_scene_create(const camber_features *features, const camber_scene_desc *desc,
                                  camber_scene **scene) {
    return create(features, desc, NULL, scene);
}

camber_status camber_scene_create_last(camber_features *features, const camber_scene_desc *desc, camber_scene **scene) {
    camber_scene_desc once = *desc;
    once.use = CAMBER_SCENE_ONE_VIEW;
    return create(features, &once, features, scene);
}

camber_status camber_scene_create_window(camber_zoom_plan *zoom, const camber_view *window, const uint32_t *polylines,
                                         size_t polyline_count, camber_scene **scene) {
    camber_plan_entries listed = {0};
    camber_scene *made = camber_alloc_zero(zoom->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    *made = (camber_scene){.context = zoom->context, .use = CAMBER_SCENE_ONE_VIEW, .zoom = zoom, .view = *window};
    camber_status status = camber_plan_list(zoom->features, &zoom->plan, polylines, polyline_count, &listed);
    if (status == CAMBER_OK)
        status = camber_plan_network_create(zoom, window, CAMBER_NETWORK_WINDOW, &listed, &made->geometry);
    camber_plan_entries_free(&listed);
    if (status == CAMBER_OK)
        status = make_pair_passes(made);
    if (status == CAMBER_OK)
        *scene = made;
    else
        camber_scene_destroy(made);
    return status;
}

camber_status camber_scene_move(camber_scene *scene, const camber_view_desc *view) {
    assert(scene->own);
    const camber_scene_desc desc = {.view = *view, .simplify_px = scene->zoom->simplify_px};
    camber_scene moved = {.context = scene->context, .use = scene->use};
    /* The network belongs to one of the two, never to both. */
    camber_plan_network geometry = scene->geometry;
    const camber_status status = look(&moved, scene->zoom->features, &desc, &geometry, NULL);
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
    const camber_zoom_plan *zoom = scene->zoom;
    return camber_plan_triangulate(zoom->features, &zoom->plan, &scene->view, zoom->simplify_px, areas);
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
                              .opaque = scene->zoom->plan.background.a >= 1.0f,
                              .undrawn = scene->zoom->plan.undrawn};
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
    *count = scene->zoom->plan.row_count;
    return scene->zoom->plan.strokes;
}

/* Fills of a plan with other windows were planned for a view anywhere: those of images are moved to this one. */
static void move_fills(camber_scene *scene) {
    camber_plan_patterns *patterns = &scene->zoom->plan.patterns;
    camber_plan_patterns_move(patterns, &scene->view);
    for (size_t i = 0, fill = 0; i < scene->pair_passes.count; i++)
        if (scene->pair_passes.passes[i].kind == CAMBER_PASS_FILL)
            scene->pair_passes.passes[i].fill = patterns->fills[fill++].fill;
}

camber_frame camber_scene_get_frame(camber_scene *scene, camber_mesh *mesh) {
    const bool of_network = mesh && camber_mesh_get_info(mesh).of_network;
    assert(of_network || scene->is_projected);
    if (!scene->own && (scene->zoom->has_images || scene->zoom->has_area_images))
        move_fills(scene);
    const camber_pass_list *list = of_network ? &scene->pair_passes : &scene->passes;
    for (size_t i = 0; i < list->count; i++)
        list->passes[i].mesh = mesh;
    return (camber_frame){.width = scene->view.width,
                          .height = scene->view.height,
                          .background = scene->zoom->plan.background,
                          .passes = list->passes,
                          .pass_count = list->count,
                          .pitch_deg = scene->view.pitch_deg};
}
