#include "map/geometry.h"

#include <math.h>
#include <string.h>

struct camber_scene {
    camber_context *context;
    camber_scene_info info;
    camber_color background;
    camber_geometry geometry;
    camber_polylines *polylines;
    camber_stroke *strokes;
    size_t stroke_count;
    camber_pass *passes;
    size_t pass_count;
    camber_paint *paints; /* of all passes */
};

static camber_status make_strokes(camber_scene *scene, const camber_plan *plan) {
    scene->strokes = camber_alloc(scene->context, plan->row_count, sizeof *scene->strokes);
    if (!scene->strokes)
        return CAMBER_ERROR_MEMORY;
    for (size_t s = 0; s < plan->set_count; s++) {
        const camber_plan_set *set = plan->sets + s;
        for (size_t row = set->first_row; row < set->first_row + set->row_count; row++) {
            float width_px = 0.0f;
            for (size_t slot = 0; slot < set->layer_count; slot++)
                width_px = fmaxf(width_px, camber_plan_paint(plan, set, row, slot).width_px);
            /* A limit of 1 bevels every turn, and so do those below; 0 would mean the default. */
            scene->strokes[row] =
                (camber_stroke){width_px, set->layer->join, set->layer->cap, fmaxf(set->layer->miter_limit, 1.0f)};
        }
    }
    scene->stroke_count = plan->row_count;
    return CAMBER_OK;
}

/* ---- Passes ---- */

/* Consecutive layers that one pass draws. */
typedef struct layer_run {
    size_t first_layer, end_layer; /* of the plan */
    size_t first_polyline, end_polyline;
    size_t end_row;
    bool opaque;
} layer_run;

/* Whether the layer draws anything, and only opaque lines, of the rows that polylines in view have. */
static bool layer_draws(const camber_plan *plan, const camber_plan_layer *layer, const bool *row_used, bool *opaque) {
    const camber_plan_set *set = plan->sets + layer->set;
    bool draws = false;
    *opaque = true;
    for (size_t row = set->first_row; row < set->first_row + set->row_count; row++) {
        const camber_paint paint = camber_plan_paint(plan, set, row, layer->slot);
        if (!row_used[row] || !(paint.width_px > 0.0f))
            continue;
        draws = true;
        *opaque &= paint.color.a >= 1.0f;
    }
    return draws;
}

/* Opaque layers whose polylines follow each other become one run. A translucent layer is one by itself: it is
 * flattened by itself. */
static size_t find_runs(camber_scene *scene, const camber_plan *plan, const bool *row_used, layer_run *runs) {
    size_t count = 0;
    for (size_t i = 0; i < plan->layer_count; i++) {
        bool opaque;
        if (!layer_draws(plan, plan->layers + i, row_used, &opaque))
            continue;
        scene->info.layers++;
        const camber_plan_set *set = plan->sets + plan->layers[i].set;
        const size_t end = set->first_polyline + set->polyline_count, end_row = set->first_row + set->row_count;
        layer_run *last = count ? runs + count - 1 : NULL;
        if (last && last->opaque && opaque && last->end_polyline == set->first_polyline) {
            last->end_layer = i + 1;
            last->end_polyline = end;
            last->end_row = end_row;
        } else {
            runs[count++] = (layer_run){i, i + 1, set->first_polyline, end, end_row, opaque};
        }
    }
    return count;
}

/* The paints of a run: rows below its end, of width 0 where it does not draw them. */
static void put_paints(const camber_plan *plan, const layer_run *run, const bool *row_used, camber_paint *paints) {
    memset(paints, 0, run->end_row * sizeof *paints);
    for (size_t i = run->first_layer; i < run->end_layer; i++) {
        const camber_plan_layer *layer = plan->layers + i;
        const camber_plan_set *set = plan->sets + layer->set;
        bool opaque;
        if (!layer_draws(plan, layer, row_used, &opaque))
            continue;
        for (size_t row = set->first_row; row < set->first_row + set->row_count; row++)
            paints[row] = camber_plan_paint(plan, set, row, layer->slot);
    }
}

static camber_status make_passes(camber_scene *scene, const camber_plan *plan) {
    camber_context *context = scene->context;
    camber_status status = CAMBER_ERROR_MEMORY;
    bool *row_used = camber_alloc_zero(context, plan->row_count, sizeof *row_used);
    layer_run *runs = row_used ? camber_alloc(context, plan->layer_count, sizeof *runs) : NULL;
    if (!runs)
        goto done;
    for (size_t i = 0; i < scene->geometry.lines.polyline_count; i++)
        row_used[scene->geometry.rows[i]] = true;
    const size_t count = find_runs(scene, plan, row_used, runs);
    size_t paint_count = 0;
    for (size_t i = 0; i < count; i++)
        paint_count += runs[i].end_row;
    if (!(scene->paints = camber_alloc(context, paint_count, sizeof *scene->paints)) ||
        !(scene->passes = camber_alloc(context, count, sizeof *scene->passes)))
        goto done;
    camber_paint *paints = scene->paints;
    for (size_t i = 0; i < count; i++) {
        put_paints(plan, runs + i, row_used, paints);
        scene->passes[i] = (camber_pass){.first_polyline = runs[i].first_polyline,
                                         .polyline_count = runs[i].end_polyline - runs[i].first_polyline,
                                         .paints = paints,
                                         .paint_count = runs[i].end_row};
        paints += runs[i].end_row;
    }
    scene->pass_count = count;
    status = CAMBER_OK;
done:
    camber_free(context, runs);
    camber_free(context, row_used);
    return status;
}

/* ---- The scene ---- */

static camber_status fill_scene(camber_scene *scene, const camber_features *features, double simplify_px,
                                const camber_view *view, camber_plan *plan) {
    camber_status status = camber_geometry_create(features, view, simplify_px, plan, &scene->geometry);
    if (status != CAMBER_OK)
        return status;
    const camber_lines *lines = &scene->geometry.lines;
    const camber_polylines_desc desc = {.points = lines->points,
                                        .point_count = lines->point_count,
                                        .offsets = lines->offsets,
                                        .polyline_count = lines->polyline_count,
                                        .rows = scene->geometry.rows};
    status = camber_polylines_create(scene->context, &desc, &scene->polylines);
    if (status == CAMBER_OK)
        status = make_strokes(scene, plan);
    if (status == CAMBER_OK)
        status = make_passes(scene, plan);
    if (status != CAMBER_OK)
        return status;
    scene->background = plan->background;
    camber_view_center(view, &scene->info.longitude, &scene->info.latitude);
    scene->info.zoom = view->zoom;
    scene->info.width = view->width;
    scene->info.height = view->height;
    scene->info.features = scene->geometry.feature_count;
    scene->info.polylines = lines->polyline_count;
    scene->info.points = lines->point_count;
    scene->info.points_in = scene->geometry.points_in;
    scene->info.opaque = plan->background.a >= 1.0f;
    if (plan->misplaced_background)
        camber_log(scene->context, CAMBER_LOG_WARNING,
                   "style: a translucent background above lines is drawn below them; place it before the line layers");
    return CAMBER_OK;
}

camber_status camber_scene_create(const camber_features *features, const camber_scene_desc *desc,
                                  camber_scene **scene) {
    camber_context *context = features->context;
    if (!(desc->simplify_px >= 0.0 && isfinite(desc->simplify_px)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "scene: a simplification of %g px; choose 0 or a distance in pixels", desc->simplify_px);
    camber_view view;
    camber_status status = camber_view_create(context, &desc->view, &view);
    if (status != CAMBER_OK)
        return status;
    camber_scene *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->geometry.context = context;
    camber_plan plan;
    status = desc->view.kind == CAMBER_VIEW_FIT ? camber_plan_fit(features, &view, &plan)
                                                : camber_plan_create(features, &view, &plan);
    if (status == CAMBER_OK)
        status = fill_scene(made, features, desc->simplify_px, &view, &plan);
    camber_plan_destroy(&plan);
    if (status == CAMBER_OK)
        *scene = made;
    else
        camber_scene_destroy(made);
    return status;
}

void camber_scene_destroy(camber_scene *scene) {
    if (!scene)
        return;
    camber_free(scene->context, scene->passes);
    camber_free(scene->context, scene->paints);
    camber_free(scene->context, scene->strokes);
    camber_polylines_destroy(scene->polylines);
    camber_geometry_destroy(&scene->geometry);
    camber_free(scene->context, scene);
}

camber_scene_info camber_scene_get_info(const camber_scene *scene) {
    return scene->info;
}

const camber_polylines *camber_scene_polylines(const camber_scene *scene) {
    return scene->polylines;
}

const uint32_t *camber_scene_rows(const camber_scene *scene) {
    return scene->geometry.rows;
}

const camber_lines *camber_scene_lines(const camber_scene *scene) {
    return &scene->geometry.lines;
}

const camber_stroke *camber_scene_strokes(const camber_scene *scene, size_t *count) {
    *count = scene->stroke_count;
    return scene->strokes;
}

camber_frame camber_scene_frame(camber_scene *scene, camber_mesh *mesh) {
    for (size_t i = 0; i < scene->pass_count; i++)
        scene->passes[i].mesh = mesh;
    return (camber_frame){.width = scene->info.width,
                          .height = scene->info.height,
                          .background = scene->background,
                          .passes = scene->passes,
                          .pass_count = scene->pass_count};
}
