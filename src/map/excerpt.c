/* Excerpts of a zoom's plan: networks of the lines of a window, with their passes.
 *
 * Input: features, a zoom, and which polylines reach into the window. Output: a network that holds these alone, and
 * only the points that the zoom's simplification keeps. So the memory that drawing takes does not grow with the data.
 */
#include "map/excerpt.h"

#include "map/plan_network.h"

#include <math.h>

/* ---- A zoom ---- */

/* Finds how far each class reaches; a class is drawn by all pairs that it has. */
static camber_status find_reaches(camber_zoom_plan *zoom) {
    const camber_plan *plan = &zoom->plan;
    const size_t class_count = zoom->features->class_count;
    if (!(zoom->class_reach_px = camber_alloc(zoom->context, class_count, sizeof *zoom->class_reach_px)) ||
        !(zoom->strokes = camber_alloc(zoom->context, plan->pair_count, sizeof *zoom->strokes)))
        return CAMBER_ERROR_MEMORY;
    for (size_t pair = 0; pair < plan->pair_count; pair++)
        zoom->strokes[pair] = plan->strokes[plan->pair_rows[pair]];
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

camber_status camber_zoom_plan_create(const camber_features *features, const camber_zoom_desc *desc,
                                      camber_zoom_plan **zoom) {
    camber_zoom_plan *made = camber_alloc_zero(features->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = made->plan.context = features->context;
    made->features = features;
    made->simplify_px = desc->simplify_px;
    made->least_importance = (float)(desc->simplify_px / desc->scale_px);
    made->view = camber_zoom_view(desc);
    camber_status status = camber_plan_evaluate(features, &made->view, &made->plan);
    if (status == CAMBER_OK)
        status = find_reaches(made);
    if (status == CAMBER_OK)
        *zoom = made;
    else
        camber_zoom_plan_destroy(made);
    return status;
}

void camber_zoom_plan_destroy(camber_zoom_plan *zoom) {
    if (!zoom)
        return;
    camber_plan_destroy(&zoom->plan);
    camber_free(zoom->context, zoom->class_reach_px);
    camber_free(zoom->context, zoom->strokes);
    camber_free(zoom->context, zoom);
}

/* ---- An excerpt ---- */

typedef struct entry_list {
    camber_network_entry *entries;
    size_t count, capacity;
} entry_list;

/* The part of the world, unrolled to the west and to the east, in which lines touch the window. */
typedef struct reached {
    double west, east;
} reached;

static bool add_copies(const camber_zoom_plan *zoom, const camber_plan_set *set, camber_plan_entry entry,
                       const reached *window, entry_list *list) {
    const camber_features *features = zoom->features;
    const bool is_area = camber_plan_is_area(&zoom->plan, set), is_dots = camber_plan_is_circles(&zoom->plan, set);
    double west = INFINITY, east = -INFINITY;
    for (size_t i = features->offsets[entry.polyline]; i < features->offsets[entry.polyline + 1]; i++) {
        const double x = features->points[2 * i];
        west = x < west ? x : west;
        east = x > east ? x : east;
    }
    if (!(east - west <= 2.0)) /* no points, or no place on earth */
        return true;
    for (double shift = ceil(window->west - east); shift <= floor(window->east - west); shift += 1.0) {
        if (!camber_grow(zoom->context, &list->entries, &list->capacity, list->count + 1, sizeof *list->entries))
            return false;
        list->entries[list->count++] = (camber_network_entry){entry.polyline, entry.pair, shift, is_area, is_dots};
    }
    return true;
}

/* Makes one entry for each copy of the world in which a polyline reaches the window. */
static camber_status list_copies(camber_excerpt *excerpt, const camber_plan_entries *listed, entry_list *list) {
    const camber_zoom_plan *zoom = excerpt->zoom;
    const double half = (0.5 * excerpt->window.width + (double)zoom->most_reach_px) / zoom->view.scale_px;
    const reached window = {excerpt->window.x - half, excerpt->window.x + half};
    for (size_t s = 0; s < zoom->plan.set_count; s++) {
        excerpt->first_entries[s] = list->count;
        if (zoom->lines_only && camber_plan_is_area(&zoom->plan, zoom->plan.sets + s))
            continue;
        for (size_t i = listed->first_entries[s]; i < listed->first_entries[s + 1]; i++)
            if (!add_copies(zoom, zoom->plan.sets + s, listed->entries[i], &window, list))
                return CAMBER_ERROR_MEMORY;
    }
    excerpt->first_entries[zoom->plan.set_count] = list->count;
    return CAMBER_OK;
}

static camber_status make_network(camber_excerpt *excerpt, const entry_list *list) {
    static const size_t none[1] = {0};
    static const camber_network_entry nothing;
    const camber_features *features = excerpt->zoom->features;
    const bool has_arc_length = excerpt->zoom->plan.has_arc_length;
    const camber_network_desc desc = {.points = features->points,
                                      .offsets = features->offsets ? features->offsets : none,
                                      .polyline_count = features->polyline_count,
                                      .importance = features->importance,
                                      .entries = list->entries ? list->entries : &nothing,
                                      .entry_count = list->count,
                                      .progress = has_arc_length ? features->progress : NULL,
                                      .has_arc_length = has_arc_length,
                                      .least_importance = excerpt->zoom->least_importance,
                                      .step = camber_plan_network_step(&excerpt->zoom->view)};
    return camber_network_create(excerpt->zoom->context, &desc, &excerpt->network);
}

static camber_status make_passes(camber_excerpt *excerpt, const entry_list *list) {
    const camber_zoom_plan *zoom = excerpt->zoom;
    size_t layer_count;
    bool *used = camber_alloc_zero(zoom->context, zoom->plan.pair_count, sizeof *used);
    if (!used)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < list->count; i++)
        used[list->entries[i].row] = true;
    const camber_numbering n = {&zoom->plan, true, excerpt->first_entries, used};
    const camber_status status = camber_passes_make(zoom->context, &n, &layer_count, &excerpt->passes);
    camber_free(zoom->context, used);
    return status;
}

camber_status camber_excerpt_make(camber_zoom_plan *zoom, const uint32_t *polylines, size_t polyline_count,
                                  const camber_excerpt_window *window, camber_excerpt *excerpt) {
    camber_context *context = zoom->context;
    camber_plan_entries listed = {0};
    entry_list list = {0};
    *excerpt = (camber_excerpt){.zoom = zoom, .window = *window};
    if (!(excerpt->first_entries = camber_alloc(context, zoom->plan.set_count + 1, sizeof *excerpt->first_entries)))
        return CAMBER_ERROR_MEMORY;
    camber_status status = camber_plan_list(zoom->features, &zoom->plan, polylines, polyline_count, &listed);
    if (status == CAMBER_OK)
        status = list_copies(excerpt, &listed, &list);
    camber_plan_entries_free(&listed);
    if (status == CAMBER_OK)
        status = make_network(excerpt, &list);
    if (status == CAMBER_OK)
        status = make_passes(excerpt, &list);
    camber_free(context, list.entries);
    return status;
}

void camber_excerpt_free(camber_excerpt *excerpt) {
    if (!excerpt->zoom)
        return;
    camber_context *context = excerpt->zoom->context;
    camber_passes_free(context, &excerpt->passes);
    camber_network_destroy(excerpt->network);
    camber_free(context, excerpt->first_entries);
    *excerpt = (camber_excerpt){0};
}

camber_status camber_excerpt_tessellate(const camber_excerpt *excerpt, camber_mesh *mesh) {
    const camber_zoom_plan *zoom = excerpt->zoom;
    const camber_camera camera = {.x = excerpt->window.x,
                                  .y = excerpt->window.y,
                                  .scale_px = zoom->view.scale_px,
                                  .width = excerpt->window.width,
                                  .height = excerpt->window.height,
                                  .simplify_px = zoom->simplify_px,
                                  .translate_px = (double)zoom->plan.translate_px};
    const camber_tessellation_desc desc = {
        .strokes = zoom->strokes, .stroke_count = zoom->plan.pair_count, .has_arc_length = zoom->plan.has_arc_length};
    return camber_mesh_tessellate_network(mesh, excerpt->network, &camera, &desc);
}

/* Fills were planned for a view anywhere: those of images are moved to where the window lies. */
static void move_fills(camber_excerpt *excerpt) {
    camber_zoom_plan *zoom = excerpt->zoom;
    camber_view view = zoom->view;
    view.x = excerpt->window.x;
    view.y = excerpt->window.y;
    view.width = excerpt->window.width;
    view.height = excerpt->window.height;
    camber_plan_patterns_move(&zoom->plan.patterns, &view);
    for (size_t i = 0, fill = 0; i < excerpt->passes.count; i++)
        if (excerpt->passes.passes[i].kind == CAMBER_PASS_FILL)
            excerpt->passes.passes[i].fill = zoom->plan.patterns.fills[fill++].fill;
}

camber_frame camber_excerpt_get_frame(camber_excerpt *excerpt, camber_mesh *mesh) {
    if (excerpt->zoom->has_images || excerpt->zoom->has_area_images)
        move_fills(excerpt);
    for (size_t i = 0; i < excerpt->passes.count; i++)
        excerpt->passes.passes[i].mesh = mesh;
    return (camber_frame){.width = excerpt->window.width,
                          .height = excerpt->window.height,
                          .background = excerpt->zoom->plan.background,
                          .passes = excerpt->passes.passes,
                          .pass_count = excerpt->passes.count};
}
