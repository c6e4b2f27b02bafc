/* Makes a network from the polylines that a plan draws, and projects on the host the lines that a camera sees.
 *
 * Input: features, a view and its plan. Output: a network whose rows are the plan's pairs. Near the antimeridian, and
 * if the picture is wider than the world, a polyline has several entries, one for each copy of the world. The network
 * can be used for other views as long as their plans draw the same entries. */
#include "map/plan_network.h"

#include "base/maths.h"
#include "camber_proof.h"

#include <math.h>

/* Bounds the reach, so that an absurd miter limit does not defeat culling. */
static const double LARGEST_REACH_PX = 65536.0;
/* Copies of the world farther from the picture's centre are left out: they would only take memory and show as dots. */
static const double MOST_WORLDS = 8.0;

static double reach_of(const camber_stroke *stroke) {
    const double half = 0.5 * (double)stroke->width_px;
    double factor = stroke->cap == CAMBER_CAP_SQUARE ? 1.5 : 1.0; /* a corner is sqrt(2) away */
    if (stroke->join == CAMBER_JOIN_MITER)
        factor = fmax(factor, (double)stroke->miter_limit);
    if (stroke->join == CAMBER_JOIN_ROUND)
        factor =
            fmax(factor, (double)fminf(stroke->round_limit, stroke->miter_limit > 0.0f ? stroke->miter_limit : 2.0f));
    return fmin(half * factor, fmax(half, LARGEST_REACH_PX));
}

/* Returns how far a stroke with an offset is from its source line, including at corners. */
static double offset_of(const camber_stroke *stroke) {
    const double far = fabs((double)stroke->offset_px), limit = (double)stroke->miter_limit;
    return fmin(far * (stroke->join == CAMBER_JOIN_MITER ? fmax(limit, 1.1) : 1.1), fmax(far, LARGEST_REACH_PX));
}

double camber_plan_stroke_reach(const camber_stroke *stroke) {
    return reach_of(stroke) + offset_of(stroke);
}

double camber_plan_reach(const camber_plan *plan) {
    double reach = 0.0;
    for (size_t row = 0; row < plan->row_count; row++)
        reach = fmax(reach, camber_plan_stroke_reach(plan->strokes + row));
    return reach + (double)plan->translate_px;
}

/* ---- Copies of the world ---- */

/* The copies of the world that are in a picture, from the first to the last: a wide picture repeats the world, as web
 * maps do. For a window they are a range of x in world coordinates, unrolled to the west and the east, in which lines
 * touch the window. */
typedef struct copies {
    double first, last;
    bool is_window;
} copies;

static copies copies_in(const camber_view *view, const camber_plan *plan) {
    double corners[8], radius = 0.0;
    camber_view_corners(view, corners);
    for (int i = 0; i < 4; i++)
        radius = fmax(radius, camber_length(corners[2 * i] - view->x, corners[2 * i + 1] - view->y));
    radius += (camber_plan_reach(plan) + 1.0) / view->scale_px;
    radius = fmin(radius, MOST_WORLDS);
    return (copies){floor(view->x - radius), floor(view->x + radius), false};
}

static copies copies_of_window(const camber_view *window, double reach_px) {
    const double half = (0.5 * window->width + reach_px) / window->scale_px;
    return (copies){window->x - half, window->x + half, true};
}

static camber_box world_box(const double *points, size_t count) {
    camber_box box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++) {
        const double x = points[2 * i], y = points[2 * i + 1];
        box.x0 = x < box.x0 ? x : box.x0;
        box.x1 = x > box.x1 ? x : box.x1;
        box.y0 = y < box.y0 ? y : box.y0;
        box.y1 = y > box.y1 ? y : box.y1;
    }
    return box;
}

/* Finds the first and the last shift of a polyline. false: it has no points, or it is not on earth. */
static bool find_shifts(const camber_features *features, const copies *worlds, size_t polyline, double *first,
                        double *last) {
    const size_t begin = features->offsets[polyline], end = features->offsets[polyline + 1];
    const camber_box box = world_box(features->points + 2 * begin, end - begin);
    if (!(box.x0 <= box.x1 && box.y0 <= box.y1 && box.x1 - box.x0 <= 2.0))
        return false;
    if (worlds->is_window) {
        *first = ceil(worlds->first - box.x1);
        *last = floor(worlds->last - box.x0);
        return true;
    }
    /* A line that ends on the border of two worlds belongs to the western one. */
    *first = worlds->first - fmax(ceil(box.x1) - 1.0, floor(box.x0));
    *last = worlds->last - floor(box.x0);
    return true;
}

static uint64_t key_of(const camber_view *view, const camber_plan *plan) {
    const copies worlds = copies_in(view, plan);
    const double ends[] = {worlds.first, worlds.last};
    return camber_hash(plan->key, ends, sizeof ends);
}

bool camber_plan_network_serves(const camber_plan_network *geometry, const camber_view *view, const camber_plan *plan) {
    return geometry->network && geometry->key == key_of(view, plan) &&
           (geometry->has_arc_length || !plan->has_arc_length);
}

/* ---- The network ---- */

typedef struct entry_list {
    camber_network_entry *entries;
    size_t count, capacity;
} entry_list;

static camber_status list_set(const camber_zoom_plan *zoom, const camber_plan_entries *listed, size_t set,
                              const copies *worlds, entry_list *list) {
    const bool is_area = camber_plan_is_area(&zoom->plan, zoom->plan.sets + set);
    const bool is_dots = camber_plan_is_circles(&zoom->plan, zoom->plan.sets + set);
    for (size_t i = listed->first_entries[set]; i < listed->first_entries[set + 1]; i++) {
        const camber_plan_entry entry = listed->entries[i];
        double first, last;
        if (!find_shifts(zoom->features, worlds, entry.polyline, &first, &last))
            continue;
        for (double shift = first; shift <= last; shift += 1.0) {
            if (!camber_grow(zoom->context, &list->entries, &list->capacity, list->count + 1, sizeof *list->entries) ||
                !list->entries)
                return CAMBER_ERROR_MEMORY;
            list->entries[list->count++] = (camber_network_entry){entry.polyline, entry.pair, shift, is_area, is_dots};
        }
    }
    return CAMBER_OK;
}

static camber_status make_network(const camber_zoom_plan *zoom, bool stays, size_t entry_count,
                                  camber_plan_network *geometry) {
    static const size_t none[1] = {0};
    static const camber_network_entry nothing;
    const camber_features *features = zoom->features;
    const camber_network_desc desc = {.points = features->points,
                                      .offsets = features->offsets ? features->offsets : none,
                                      .polyline_count = features->polyline_count,
                                      .importance = features->importance,
                                      .entries = geometry->entries ? geometry->entries : &nothing,
                                      .entry_count = entry_count,
                                      .progress = geometry->has_arc_length ? features->progress : NULL,
                                      .has_arc_length = geometry->has_arc_length,
                                      .least_importance = stays ? zoom->least_importance : 0.0f,
                                      .step = stays ? camber_plan_network_step(&zoom->view) : 0.0};
    return camber_network_create(geometry->context, &desc, &geometry->network);
}

camber_status camber_plan_network_create(const camber_zoom_plan *zoom, const camber_view *view,
                                         camber_network_views views, camber_plan_entries *listed,
                                         camber_plan_network *geometry) {
    const camber_plan *plan = &zoom->plan;
    const bool is_window = views == CAMBER_NETWORK_WINDOW;
    const copies worlds = is_window ? copies_of_window(view, (double)zoom->most_reach_px) : copies_in(view, plan);
    entry_list list = {0};
    camber_status status = CAMBER_OK;
    *geometry = (camber_plan_network){.context = zoom->context,
                                      .set_count = plan->set_count,
                                      .has_arc_length = plan->has_arc_length,
                                      .key = is_window ? 0 : key_of(view, plan)};
    geometry->first_entries = camber_alloc(geometry->context, plan->set_count + 1, sizeof *geometry->first_entries);
    if (!geometry->first_entries)
        return CAMBER_ERROR_MEMORY;
    for (size_t s = 0; status == CAMBER_OK && s < plan->set_count; s++) {
        geometry->first_entries[s] = list.count;
        if (!zoom->lines_only || !camber_plan_is_area(plan, plan->sets + s))
            status = list_set(zoom, listed, s, &worlds, &list);
    }
    geometry->first_entries[plan->set_count] = list.count;
    geometry->entries = list.entries;
    camber_plan_entries_free(listed);
    return status == CAMBER_OK ? make_network(zoom, views != CAMBER_NETWORK_VIEWS, list.count, geometry) : status;
}

void camber_plan_network_destroy(camber_plan_network *geometry) {
    if (!geometry->context)
        return;
    camber_network_destroy(geometry->network);
    camber_free(geometry->context, geometry->first_entries);
    camber_free(geometry->context, geometry->entries);
    *geometry = (camber_plan_network){0};
}

/* ---- The visible part ---- */

/* Counts each polyline once per set, however often the world repeats and however many pieces the camera cuts it into.
 */
static void count_set(const camber_features *features, const camber_plan_network *geometry, size_t first, size_t end,
                      camber_visible_lines *seen) {
    uint32_t before = UINT32_MAX, counted = UINT32_MAX;
    for (size_t i = first; i < end; i++) {
        const uint32_t polyline = geometry->entries[seen->lines.entries[i]].polyline;
        const uint32_t class = features->feature_class[features->polyline_feature[polyline]];
        const bool is_end = features->classes[class].is_ends;
        seen->end_count += is_end;
        if (polyline == before || is_end)
            continue;
        before = polyline;
        seen->points_in += camber_features_whole_count(features, polyline);
        /* If a feature's first line is not visible, a later line counts for the feature. */
        const uint32_t feature = features->polyline_feature[polyline], count = features->feature_counts[polyline];
        seen->feature_count += count || feature == counted ? count : 1;
        counted = feature;
    }
}

/* Fills in the row of each polyline, and the first polyline of each set. */
static camber_status fill_rows(const camber_plan_network *geometry, const camber_plan *plan,
                               camber_visible_lines *seen) {
    const size_t count = seen->lines.polyline_count;
    if (!(seen->rows = camber_alloc(geometry->context, count, sizeof *seen->rows)) ||
        !(seen->first_polylines =
              camber_alloc(geometry->context, geometry->set_count + 1, sizeof *seen->first_polylines)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++)
        seen->rows[i] = plan->pair_rows[geometry->entries[seen->lines.entries[i]].row];
    size_t at = 0;
    for (size_t s = 0; s <= geometry->set_count; s++) {
        while (at < count && seen->lines.entries[at] < geometry->first_entries[s])
            at++;
        seen->first_polylines[s] = at;
    }
    return CAMBER_OK;
}

camber_status camber_plan_network_project(const camber_zoom_plan *zoom, const camber_plan_network *geometry,
                                          const camber_camera *camera, const camber_tessellation_desc *desc,
                                          camber_visible_lines *seen) {
    *seen = (camber_visible_lines){.context = geometry->context};
    camber_status status = camber_network_project_lines(geometry->network, camera, desc, &seen->lines);
    if (status == CAMBER_OK)
        status = fill_rows(geometry, &zoom->plan, seen);
    for (size_t s = 0; status == CAMBER_OK && s < geometry->set_count; s++)
        count_set(zoom->features, geometry, seen->first_polylines[s], seen->first_polylines[s + 1], seen);
    return status;
}

void camber_visible_lines_destroy(camber_visible_lines *seen) {
    if (!seen->context)
        return;
    camber_free(seen->context, seen->first_polylines);
    camber_free(seen->context, seen->rows);
    camber_lines_destroy(&seen->lines);
    *seen = (camber_visible_lines){0};
}
