/* Scenes: a view of features in a style, ready to be tessellated and drawn.
 *
 * Input: features and a view, or a zoom's plan and a window of it. Output: a network of the lines that the style draws
 * there, the passes that draw a mesh of it, and the camera. Main idea: the plan says which style layers draw which
 * features. The network is made once per plan, and is kept while the view moves and the plan does not change. So are
 * the plan and the texts of labels while only the place of the view changes. The network of a window has only the lines
 * that reach into it and the points that the zoom's simplification keeps, so the memory for drawing does not grow with
 * the data. camber_scene_project makes the same lines on the host, with the CPU twin. */
#include "map/scene.h"
#include "map/label_shapes.h"
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
    camber_zoom_plan *own; /* the same, if the scene owns it. NULL: the plan is shared with other windows */

    camber_view view;
    camber_plan_network geometry;
    camber_pass_list pair_passes;
    camber_label_book *book;    /* NULL: none yet, or the scene has only one view */
    camber_label_shapes labels; /* of the picture */
    camber_labels shown;        /* what they were made from */
    size_t label_count;

    /* On the host: empty until camber_scene_project. */
    bool is_projected;
    camber_visible_lines seen;
    camber_scene_info counts; /* of the projected lines, until the scene moves; the other fields are 0 */
    camber_polylines *polylines;
    camber_pass_list passes;
};

/* Makes the passes over the network. A pair is used if it has an entry anywhere. */
static camber_status make_pair_passes(camber_scene *scene) {
    size_t layer_count;
    const camber_plan *plan = &scene->zoom->plan;
    bool *used = camber_alloc_zero(scene->context, plan->pair_count, sizeof *used);
    if (!used)
        return CAMBER_ERROR_MEMORY;
    const size_t count = scene->geometry.first_entries[plan->set_count];
    for (size_t i = 0; i < count; i++)
        used[scene->geometry.entries[i].row] = true;
    const camber_mesh_rows rows = {.plan = plan,
                                   .by_pair = true,
                                   .first_polylines = scene->geometry.first_entries,
                                   .used = used,
                                   .labels = &scene->labels,
                                   .style_layers = scene->zoom->features->style->layers};
    const camber_status status = camber_passes_make(scene->context, &rows, &layer_count, &scene->pair_passes);
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

static void release_projection(camber_scene *scene) {
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
    const camber_mesh_rows rows = {.plan = plan, .first_polylines = scene->seen.first_polylines, .used = used};
    const camber_status status = camber_passes_make(scene->context, &rows, &scene->counts.layers, &scene->passes);
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
        release_projection(scene);
        scene->counts = (camber_scene_info){0};
        return status;
    }
    scene->is_projected = true;
    scene->counts.features = scene->seen.feature_count;
    scene->counts.polylines = scene->seen.lines.polyline_count - scene->seen.end_count;
    scene->counts.points = scene->seen.lines.point_count - scene->seen.end_count;
    scene->counts.points_in = scene->seen.points_in;
    return CAMBER_OK;
}

void camber_scene_release_lines(camber_scene *scene) {
    release_projection(scene);
}

/* ---- The scene ---- */

/* Makes the network. consumed_features (or NULL) are features that may lose their points: points that the view does not
 * need are dropped first, because otherwise most of them would be in memory together with the network. */
static camber_status make_geometry(camber_scene *scene, camber_features *consumed_features) {
    camber_zoom_plan *zoom = scene->zoom;
    const bool stays = scene->use == CAMBER_SCENE_ONE_VIEW;
    camber_status status = CAMBER_OK;
    if (consumed_features && !zoom->plan.has_arc_length && !zoom->plan.has_corners)
        status = camber_features_thin(consumed_features, zoom->least_importance);
    if (status == CAMBER_OK && !zoom->plan.all.first_entries) /* the former network has consumed them */
        status = camber_plan_list(zoom->features, &zoom->plan, NULL, zoom->features->polyline_count, &zoom->plan.all);
    if (status == CAMBER_OK)
        status = camber_plan_network_create(zoom, &scene->view, stays ? CAMBER_NETWORK_VIEW : CAMBER_NETWORK_VIEWS,
                                            &zoom->plan.all, &scene->geometry);
    if (status == CAMBER_OK && consumed_features)
        camber_features_release_points(consumed_features);
    return status;
}

/* Places the labels of the view, or takes those of the zoom, and makes their shapes, if fonts were read with the
 * features. placed NULL: the labels are those of the view. */
static camber_status make_labels(camber_scene *scene, const camber_window_labels *placed) {
    const camber_features *features = scene->zoom->features;
    if (!features->fonts || scene->use == CAMBER_SCENE_LINES)
        return CAMBER_OK;
    camber_status status = CAMBER_OK;
    if (placed)
        status = camber_zoom_labels_draw(placed->labels, &placed->square, &scene->view, &scene->shown);
    else if (scene->use == CAMBER_SCENE_ONE_VIEW && camber_view_has_zoom_labels(features->style, &scene->view))
        status = camber_zoom_labels_place_view(features, &scene->view, scene->zoom->simplify_px, &scene->shown);
    else if (scene->use == CAMBER_SCENE_ONE_VIEW)
        status = camber_labels_place(features, &scene->view, features->fonts, features->sprites, &scene->shown);
    else if (scene->book || (status = camber_label_book_create(features, &scene->book)) == CAMBER_OK)
        status = camber_label_book_place(scene->book, &scene->view, &scene->shown);
    if (status == CAMBER_OK)
        status = camber_label_shapes_make(&scene->shown, features->fonts, &scene->labels);
    scene->label_count = scene->shown.label_count;
    return status;
}

/* Makes the plan. former: a plan that is moved and taken over if the view differs only in its place. NULL: none. */
static camber_status make_plan(camber_scene *scene, const camber_features *features, const camber_scene_desc *desc,
                               camber_zoom_plan *former) {
    camber_view view;
    if (!former || desc->view.kind == CAMBER_VIEW_FIT)
        return camber_zoom_plan_create_view(features, &desc->view, desc->simplify_px, &scene->own);
    const camber_status status = camber_view_create(scene->context, &desc->view, &view);
    if (status != CAMBER_OK)
        return status;
    if (!camber_zoom_plan_move(former, &view))
        return camber_zoom_plan_create_view(features, &desc->view, desc->simplify_px, &scene->own);
    scene->own = former;
    return CAMBER_OK;
}

/* Makes the scene of a whole view. former_plan and former are taken over if they can be used for this view, too. */
static camber_status make_view_scene(camber_scene *scene, const camber_features *features,
                                     const camber_scene_desc *desc, camber_zoom_plan *former_plan,
                                     camber_plan_network *former, camber_features *consumed_features) {
    camber_status status = make_plan(scene, features, desc, former_plan);
    if (status != CAMBER_OK)
        return status;
    scene->zoom = scene->own;
    scene->zoom->lines_only = scene->use == CAMBER_SCENE_LINES;
    scene->view = scene->zoom->view;
    status = make_labels(scene, NULL); /* first, because making the network may free the features' points */
    if (status != CAMBER_OK)
        return status;
    if (scene->use != CAMBER_SCENE_ONE_VIEW && camber_plan_network_serves(former, &scene->view, &scene->zoom->plan)) {
        scene->geometry = *former;
        *former = (camber_plan_network){0};
    } else {
        status = make_geometry(scene, consumed_features);
    }
    return status == CAMBER_OK ? make_pair_passes(scene) : status;
}

static void release_contents(camber_scene *scene) {
    release_projection(scene);
    camber_passes_free(scene->context, &scene->pair_passes);
    camber_label_shapes_free(&scene->labels);
    if (scene->shown.context)
        camber_labels_free(&scene->shown);
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

/* Warns if a style draws nothing at all; leaving out some features is up to the style. Missing images of patterns have
 * already caused a warning. */
static camber_status warn_if_nothing_is_drawn(const camber_scene *scene) {
    const camber_features *features = scene->zoom->features;
    const size_t undrawn = scene->zoom->plan.undrawn, all = camber_features_count_drawn(features);
    const double zoom = scene->view.zoom;
    char why[1024];
    bool draws;
    if (has_patterns(&scene->zoom->plan))
        return CAMBER_OK;
    if (undrawn && undrawn < all)
        camber_log(scene->context, CAMBER_LOG_INFO, "style: no layer draws %zu of the %zu features", undrawn, all);
    if (!undrawn || undrawn < all || scene->label_count)
        return CAMBER_OK;
    const camber_status status = camber_plan_explain_nothing(features, zoom, zoom, why, sizeof why, &draws);
    if (status == CAMBER_OK)
        camber_log(scene->context, CAMBER_LOG_WARNING, "nothing is drawn: %s", why);
    return status;
}

/* Warns that circles are drawn flat on the map, unless their layers ask for that. */
static void warn_about_flat_circles(const camber_scene *scene) {
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

static camber_status create(const camber_features *features, const camber_scene_desc *desc,
                            camber_features *consumed_features, camber_scene **scene) {
    camber_context *context = features->context;
    if (!(desc->simplify_px >= 0.0 && isfinite(desc->simplify_px)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "scene: the simplification is %g px; choose 0 or a distance in pixels", desc->simplify_px);
    camber_scene *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    camber_plan_network none = {0};
    made->context = context;
    made->use = desc->use;
    camber_status status = make_view_scene(made, features, desc, NULL, &none, consumed_features);
    if (status == CAMBER_OK)
        status = warn_if_nothing_is_drawn(made);
    if (status != CAMBER_OK) {
        camber_scene_destroy(made);
        return status;
    }
    warn_about_flat_circles(made);
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

camber_status camber_scene_create_window(camber_zoom_plan *zoom, const camber_view *window,
                                         const camber_window_labels *labels, const uint32_t *polylines,
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
    if (status == CAMBER_OK && labels && labels->labels)
        status = make_labels(made, labels);
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
    camber_scene moved = {.context = scene->context, .use = scene->use, .book = scene->book};
    /* The network always belongs to only one of the two scenes. */
    camber_plan_network geometry = scene->geometry;
    const camber_status status = make_view_scene(&moved, scene->zoom->features, &desc, scene->own, &geometry, NULL);
    const bool keeps_plan = moved.own == scene->own;
    scene->book = moved.book;
    if (status != CAMBER_OK) {
        if (!geometry.context)
            moved.geometry = (camber_plan_network){0};
        if (keeps_plan) {
            moved.own = NULL;
            (void)camber_zoom_plan_move(scene->own, &scene->view);
        }
        release_contents(&moved);
        return status;
    }
    scene->geometry = geometry;
    if (keeps_plan)
        scene->own = NULL;
    release_contents(scene);
    *scene = moved;
    return CAMBER_OK;
}

camber_status camber_scene_tessellate(const camber_scene *scene, camber_mesh *mesh, camber_method method) {
    const camber_camera camera = camera_of(scene);
    const camber_tessellation_desc desc = desc_of(scene, method);
    const camber_status status = camber_mesh_tessellate_network(mesh, scene->geometry.network, &camera, &desc);
    return status == CAMBER_OK ? camber_label_shapes_tessellate(&scene->labels, mesh, method) : status;
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
    release_contents(scene);
    camber_label_book_destroy(scene->book);
    camber_free(context, scene);
}

/* ---- Getters ---- */

camber_scene_parts camber_scene_get_parts(camber_scene *scene) {
    return (camber_scene_parts){.zoom = scene->zoom,
                                .view = &scene->view,
                                .geometry = &scene->geometry,
                                .passes = &scene->pair_passes,
                                .labels = &scene->shown,
                                .shapes = &scene->labels};
}

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
    info.labels = scene->label_count;
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

/* Moves fills of images to this window. If several windows share the plan, it has placed them for a view at an
 * arbitrary position. */
static void move_fills(camber_scene *scene) {
    camber_plan_patterns *patterns = &scene->zoom->plan.patterns;
    camber_plan_patterns_move(patterns, &scene->view);
    for (size_t i = 0, fill = 0; i < scene->pair_passes.count; i++)
        if (scene->pair_passes.passes[i].kind == CAMBER_PASS_FILL)
            scene->pair_passes.passes[i].fill = patterns->fills[fill++].fill;
}

/* Sets the meshes of passes. Passes of labels draw companions of the scene's mesh, which camber_scene_tessellate fills.
 * Without that call the companions are empty, and these passes draw nothing. */
static void set_meshes(const camber_pass_list *list, camber_mesh *mesh) {
    camber_mesh *meshes[] = {mesh, NULL, NULL};
    for (size_t i = 0; i < list->count; i++) {
        for (size_t k = 1; k <= list->meshes[i] && meshes[k - 1]; k++)
            if (!meshes[k] && camber_mesh_get_companion(meshes[k - 1], meshes + k) != CAMBER_OK)
                meshes[k] = NULL;
        list->passes[i].mesh = meshes[list->meshes[i]];
        list->passes[i].kind = list->passes[i].mesh || !list->meshes[i] ? list->passes[i].kind : CAMBER_PASS_FILL;
    }
}

camber_frame camber_scene_get_frame(camber_scene *scene, camber_mesh *mesh) {
    const bool of_network = mesh && camber_mesh_holds_network(mesh, scene->geometry.network);
    assert(of_network || scene->is_projected);
    if (!scene->own && (scene->zoom->has_images || scene->zoom->has_area_images))
        move_fills(scene);
    const camber_pass_list *list = of_network ? &scene->pair_passes : &scene->passes;
    set_meshes(list, mesh);
    return (camber_frame){.width = scene->view.width,
                          .height = scene->view.height,
                          .background = scene->zoom->plan.background,
                          .passes = list->passes,
                          .pass_count = list->count,
                          .pitch_deg = scene->view.pitch_deg};
}
