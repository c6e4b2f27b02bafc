/* Scenes: a view of features in a style, ready to tessellate and draw.
 *
 * Input: features and a view. Output: a network of the lines that the style draws, the strokes and passes that a mesh
 * of it is drawn with, and the camera. Main idea: the plan says which style layers draw which features; the network is
 * made once for a plan, and stays while the view moves and the plan does not change. camber_scene_project makes the
 * same on the host, by the CPU twin. */
#include "map/plan_network.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* 2.4 GB. */
static const size_t MOST_PAINTS = (size_t)1 << 26;

/* The passes over the polylines of a mesh: by entries and pairs where a network was tessellated, by lines and rows
 * where polylines were. */
typedef struct pass_list {
    camber_pass *passes;
    size_t count;
    camber_paint *paints; /* the paints of all passes */
} pass_list;

struct camber_scene {
    camber_context *context;
    const camber_features *features;
    double simplify_px;

    camber_view view;
    camber_plan plan;
    camber_plan_network geometry;
    camber_stroke *pair_strokes;
    pass_list pair_passes;

    /* On the host: nothing until camber_scene_project. */
    bool is_projected;
    camber_visible_lines seen;
    size_t layer_count; /* how many layers draw something */
    camber_polylines *polylines;
    pass_list passes;
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

/* How a mesh numbers what the sets draw. */
typedef struct numbering {
    const camber_plan *plan;
    bool by_pair;                  /* else by row */
    const size_t *first_polylines; /* set_count + 1 */
    const bool *used;              /* by pair or row: a polyline has it */
} numbering;

static size_t first_of(const numbering *n, const camber_plan_set *set) {
    return n->by_pair ? set->first_pair : set->first_row;
}

static size_t end_of(const numbering *n, const camber_plan_set *set) {
    return n->by_pair ? set->first_pair + set->pair_count : set->first_row + set->row_count;
}

static camber_paint paint_of(const numbering *n, const camber_plan_layer *layer, size_t number) {
    const size_t row = n->by_pair ? n->plan->pair_rows[number] : number;
    return camber_plan_paint(n->plan, n->plan->sets + layer->set, row, layer->slot);
}

/* Consecutive layers that one pass draws. */
typedef struct layer_run {
    size_t first_layer, end_layer; /* of the plan */
    size_t first_polyline, end_polyline;
    size_t end_paint;
    float opacity; /* the layer's opacity; 1 where several layers are drawn at once */
    camber_overlap overlap;
    bool opaque;
    const camber_plan_fill *fill; /* NULL: none; else nothing of the above */
} layer_run;

/* Whether the layer draws anything, and only opaque lines, of what polylines have. */
static bool layer_draws(const numbering *n, const camber_plan_layer *layer, bool *opaque) {
    const camber_plan_set *set = n->plan->sets + layer->set;
    bool draws = false;
    *opaque = true;
    for (size_t i = first_of(n, set); i < end_of(n, set); i++) {
        const camber_paint paint = paint_of(n, layer, i);
        if (!n->used[i] || !(paint.width_px > 0.0f))
            continue;
        draws = true;
        *opaque &= paint.color.a >= 1.0f && !(paint.ramp && layer->translucent_ramp);
    }
    return draws;
}

/* Opaque layers whose polylines follow each other are drawn by one pass. A translucent layer has a pass of its own,
 * since it is flattened by itself. Fills come between. */
static size_t find_runs(const numbering *n, layer_run *runs, size_t *layer_count) {
    const camber_plan *plan = n->plan;
    size_t count = 0, fill = 0;
    *layer_count = 0;
    for (size_t i = 0; i <= plan->layer_count; i++) {
        bool opaque;
        for (; fill < plan->patterns.fill_count && plan->patterns.fills[fill].before == i; fill++)
            runs[count++] = (layer_run){.fill = plan->patterns.fills + fill};
        if (i == plan->layer_count)
            break;
        if (!layer_draws(n, plan->layers + i, &opaque))
            continue;
        *layer_count += !plan->layers[i].border;
        const camber_plan_set *set = plan->sets + plan->layers[i].set;
        const float opacity = (float)plan->layers[i].look.paint.layer_opacity;
        opaque = opaque && opacity >= 1.0f;
        const size_t first = n->first_polylines[plan->layers[i].set], end = n->first_polylines[plan->layers[i].set + 1];
        const camber_overlap overlap = plan->layers[i].look.layer->overlap;
        layer_run *last = count ? runs + count - 1 : NULL;
        if (last && last->opaque && opaque && last->overlap == overlap && last->end_polyline == first) {
            last->end_layer = i + 1;
            last->end_polyline = end;
            last->end_paint = end_of(n, set);
        } else {
            runs[count++] = (layer_run){i, i + 1, first, end, end_of(n, set), opacity, overlap, opaque, NULL};
        }
    }
    return count;
}

/* Lines that were cut do not know where their polylines begin, so patterns are dropped, and a gradient becomes the
 * colour of its middle. */
static void forget_progress(camber_paint *paint) {
    if (paint->ramp) {
        const float alpha = paint->color.a;
        paint->color = paint->ramp->stops[paint->ramp->count / 2].color;
        paint->color.a *= alpha;
    }
    paint->dash = NULL;
    paint->ramp = NULL;
    paint->image = NULL;
    paint->trim_start = paint->trim_end = 0.0f;
}

/* Writes the paints of a pass: one for each row below its end, of width 0 where the pass does not draw the row. */
static void put_paints(const numbering *n, const layer_run *run, camber_paint *paints) {
    memset(paints, 0, run->end_paint * sizeof *paints);
    for (size_t i = run->first_layer; i < run->end_layer; i++) {
        const camber_plan_layer *layer = n->plan->layers + i;
        const camber_plan_set *set = n->plan->sets + layer->set;
        bool opaque;
        if (!layer_draws(n, layer, &opaque))
            continue;
        for (size_t k = first_of(n, set); k < end_of(n, set); k++) {
            paints[k] = paint_of(n, layer, k);
            if (!n->by_pair)
                forget_progress(paints + k);
        }
    }
}

static camber_status make_passes(camber_context *context, const numbering *n, size_t *layer_count, pass_list *list) {
    camber_status status = CAMBER_ERROR_MEMORY;
    layer_run *runs = camber_alloc(context, n->plan->layer_count + n->plan->patterns.fill_count, sizeof *runs);
    if (!runs)
        return CAMBER_ERROR_MEMORY;
    const size_t count = find_runs(n, runs, layer_count);
    size_t paint_count = 0;
    for (size_t i = 0; i < count; i++)
        paint_count += runs[i].end_paint;
    if (paint_count > MOST_PAINTS) {
        status = camber_fail(context, CAMBER_ERROR_LIMIT, "style: %zu passes over %zu kinds of lines; use fewer layers",
                             count, runs[count - 1].end_paint);
        goto done;
    }
    if (!(list->paints = camber_alloc(context, paint_count, sizeof *list->paints)) ||
        !(list->passes = camber_alloc(context, count, sizeof *list->passes)))
        goto done;
    camber_paint *paints = list->paints;
    for (size_t i = 0; i < count; i++) {
        put_paints(n, runs + i, paints);
        list->passes[i] = (camber_pass){.first_polyline = runs[i].first_polyline,
                                        .polyline_count = runs[i].end_polyline - runs[i].first_polyline,
                                        .paints = paints,
                                        .paint_count = runs[i].end_paint,
                                        .overlap = runs[i].overlap,
                                        .opacity = runs[i].opacity};
        if (runs[i].fill) {
            list->passes[i].kind = CAMBER_PASS_FILL;
            list->passes[i].fill = runs[i].fill->fill;
        }
        paints += runs[i].end_paint;
    }
    list->count = count;
    status = CAMBER_OK;
done:
    camber_free(context, runs);
    return status;
}

static void free_passes(camber_context *context, pass_list *list) {
    camber_free(context, list->passes);
    camber_free(context, list->paints);
}

/* Makes the passes over the network, where every pair has an entry somewhere. */
static camber_status make_pair_passes(camber_scene *scene) {
    size_t layer_count;
    bool *used = camber_alloc_zero(scene->context, scene->plan.pair_count, sizeof *used);
    if (!used)
        return CAMBER_ERROR_MEMORY;
    const size_t count = scene->geometry.first_entries[scene->plan.set_count];
    for (size_t i = 0; i < count; i++)
        used[scene->geometry.pairs[i]] = true;
    const numbering n = {&scene->plan, true, scene->geometry.first_entries, used};
    const camber_status status = make_passes(scene->context, &n, &layer_count, &scene->pair_passes);
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
    free_passes(scene->context, &scene->passes);
    camber_polylines_destroy(scene->polylines);
    camber_visible_lines_destroy(&scene->seen);
    scene->passes = (pass_list){0};
    scene->polylines = NULL;
    scene->is_projected = false;
    scene->layer_count = 0;
}

static camber_status make_row_passes(camber_scene *scene) {
    bool *used = camber_alloc_zero(scene->context, scene->plan.row_count, sizeof *used);
    if (!used)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < scene->seen.lines.polyline_count; i++)
        used[scene->seen.rows[i]] = true;
    const numbering n = {&scene->plan, false, scene->seen.first_polylines, used};
    const camber_status status = make_passes(scene->context, &n, &scene->layer_count, &scene->passes);
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
    if (status == CAMBER_OK)
        scene->is_projected = true;
    else
        forget(scene);
    return status;
}

/* ---- The scene ---- */

static camber_status look(camber_scene *scene, const camber_view_desc *desc, camber_plan_network *geometry) {
    camber_status status = camber_view_create(scene->context, desc, &scene->view);
    if (status != CAMBER_OK)
        return status;
    status = desc->kind == CAMBER_VIEW_FIT ? camber_plan_fit(scene->features, &scene->view, &scene->plan)
                                           : camber_plan_create(scene->features, &scene->view, &scene->plan);
    if (status != CAMBER_OK)
        return status;
    if (camber_plan_network_serves(geometry, &scene->view, &scene->plan)) {
        scene->geometry = *geometry;
        *geometry = (camber_plan_network){0};
    } else {
        status = camber_plan_network_create(scene->features, &scene->view, &scene->plan, &scene->geometry);
    }
    if (status == CAMBER_OK)
        status = make_strokes(scene);
    return status == CAMBER_OK ? make_pair_passes(scene) : status;
}

static void empty(camber_scene *scene) {
    forget(scene);
    free_passes(scene->context, &scene->pair_passes);
    camber_free(scene->context, scene->pair_strokes);
    camber_plan_network_destroy(&scene->geometry);
    camber_plan_destroy(&scene->plan);
}

static camber_scene bare_scene(const camber_features *features, double simplify_px) {
    return (camber_scene){.context = features->context,
                          .features = features,
                          .simplify_px = simplify_px,
                          .plan = {.context = features->context}};
}

/* Keys that the style reads, some of them: "highway, MTFCC, ..."; "": none. */
static void list_properties(const camber_style *style, char *text, size_t size) {
    size_t used = 0, listed = 0;
    *text = 0;
    for (size_t i = 0; i < style->property_count; i++) {
        const char *name = style->properties[i];
        if (strcmp(name, CAMBER_PLAIN_PROPERTY) == 0)
            continue;
        const bool fits = listed < 8 && used + strlen(name) + sizeof ", , ..." <= size;
        used += (size_t)snprintf(text + used, size - used, "%s%s", listed++ ? ", " : "", fits ? name : "...");
        if (!fits)
            return;
    }
}

static bool has_patterns(const camber_plan *plan) {
    for (size_t i = 0; i < plan->layer_count; i++)
        if (plan->layers[i].look.layer->properties[CAMBER_LINE_PATTERN])
            return true;
    return false;
}

/* Warns where a style draws nothing at all; what else it leaves out is its own business. Images of patterns that are
 * not there were warned of already. */
static void tell_undrawn(const camber_scene *scene) {
    const size_t undrawn = scene->plan.undrawn, all = scene->features->feature_count;
    char keys[256];
    if (has_patterns(&scene->plan))
        return;
    if (undrawn && undrawn < all)
        camber_log(scene->context, CAMBER_LOG_INFO, "style: draws nothing of %zu of %zu features", undrawn, all);
    if (!undrawn || undrawn < all)
        return;
    list_properties(scene->features->style, keys, sizeof keys);
    camber_log(scene->context, CAMBER_LOG_WARNING,
               "style: no layer draws any of the %zu feature%s at this zoom%s%s; name a style that does with --style",
               all, all == 1 ? "" : "s", *keys ? ": it goes by " : "", keys);
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
    *made = bare_scene(features, desc->simplify_px);
    camber_status status = look(made, &desc->view, &none);
    if (status == CAMBER_OK && !desc->on_device)
        status = camber_scene_project(made);
    if (status != CAMBER_OK) {
        camber_scene_destroy(made);
        return status;
    }
    tell_undrawn(made);
    if (made->plan.patterns.unread)
        camber_log(context, CAMBER_LOG_WARNING,
                   "style: its patterns are left out, for its sprites are not read; read them with the features");
    *scene = made;
    return CAMBER_OK;
}

camber_status camber_scene_move(camber_scene *scene, const camber_view_desc *view) {
    camber_scene moved = bare_scene(scene->features, scene->simplify_px);
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
    info.layers = scene->layer_count;
    info.features = scene->seen.feature_count;
    info.polylines = scene->seen.lines.polyline_count;
    info.points = scene->seen.lines.point_count;
    info.points_in = scene->seen.points_in;
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
    const pass_list *list = holds_network ? &scene->pair_passes : &scene->passes;
    for (size_t i = 0; i < list->count; i++)
        list->passes[i].mesh = mesh;
    return (camber_frame){.width = scene->view.width,
                          .height = scene->view.height,
                          .background = scene->plan.background,
                          .passes = list->passes,
                          .pass_count = list->count,
                          .pitch_deg = scene->view.pitch_deg};
}
