#include "map/plan.h"

#include <math.h>

/* A zoom at which practically every road style draws all of its classes: the first guess at what will be drawn. */
static const double FIRST_ZOOM = 14.0;
static const double LARGEST_FIT_ZOOM = 22.0;
static const double FILL = 0.96; /* a margin of 2 % on each side */

static bool is_empty(camber_box box) {
    return box.x0 > box.x1;
}

/* Bounds in the view's turned axes, twice: of the data as it is, and with the western half of the world moved behind
 * the eastern one. The latter are smaller for data on both sides of the antimeridian. */
typedef struct two_bounds {
    camber_box plain, moved;
} two_bounds;

static void add_polyline(const camber_features *features, size_t polyline, const camber_view *view,
                         two_bounds *bounds) {
    camber_box box = CAMBER_BOX_EMPTY;
    double west = 1.0, east = 0.0;
    for (size_t i = features->offsets[polyline]; i < features->offsets[polyline + 1]; i++) {
        const double x = features->points[2 * i], y = features->points[2 * i + 1];
        if (!isfinite(x) || !isfinite(y))
            continue;
        camber_box_add(&box, x * view->cosine + y * view->sine, y * view->cosine - x * view->sine);
        west = fmin(west, x);
        east = fmax(east, x);
    }
    if (is_empty(box))
        return;
    const double worlds = 0.5 * (west + east) < 0.5 ? 1.0 : 0.0;
    const double du = worlds * view->cosine, dv = -worlds * view->sine;
    camber_box_add(&bounds->plain, box.x0, box.y0);
    camber_box_add(&bounds->plain, box.x1, box.y1);
    camber_box_add(&bounds->moved, box.x0 + du, box.y0 + dv);
    camber_box_add(&bounds->moved, box.x1 + du, box.y1 + dv);
}

/* The bounds of all features, with labels or without. */
static two_bounds bounds_of_all(const camber_features *features, const camber_view *view, bool labels) {
    two_bounds bounds = {CAMBER_BOX_EMPTY, CAMBER_BOX_EMPTY};
    for (size_t p = 0; p < features->polyline_count; p++)
        if (labels || !camber_geometry_is_label(camber_features_kind(features, p)))
            add_polyline(features, p, view, &bounds);
    return bounds;
}

/* The bounds of what the plan draws. */
static two_bounds bounds_of(const camber_features *features, const camber_view *view, const camber_plan *plan) {
    two_bounds bounds = {CAMBER_BOX_EMPTY, CAMBER_BOX_EMPTY};
    for (size_t s = 0; s < plan->set_count; s++)
        for (size_t i = plan->all.first_entries[s]; i < plan->all.first_entries[s + 1]; i++)
            add_polyline(features, plan->all.entries[i].polyline, view, &bounds);
    return bounds;
}

static void frame_bounds(camber_view *view, const two_bounds *bounds) {
    camber_view moved = *view;
    camber_view_frame(view, bounds->plain, FILL, LARGEST_FIT_ZOOM);
    camber_view_frame(&moved, bounds->moved, FILL, LARGEST_FIT_ZOOM);
    if (moved.zoom > view->zoom)
        *view = moved;
}

static bool same_bounds(camber_box a, camber_box b) {
    return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

camber_status camber_plan_fit(const camber_features *features, camber_view *view, camber_plan *plan) {
    camber_view guess = *view;
    guess.zoom = FIRST_ZOOM;
    camber_status status = camber_plan_create(features, &guess, plan);
    if (status != CAMBER_OK)
        return status;
    two_bounds bounds = bounds_of(features, view, plan);
    if (is_empty(bounds.plain))
        bounds = bounds_of_all(features, view, false);
    if (is_empty(bounds.plain))
        bounds = bounds_of_all(features, view, true);
    if (!is_empty(bounds.plain))
        frame_bounds(view, &bounds);
    camber_plan_destroy(plan);
    status = camber_plan_create(features, view, plan);
    if (status != CAMBER_OK)
        return status;
    const two_bounds drawn = bounds_of(features, view, plan);
    if (is_empty(drawn.plain) || same_bounds(drawn.plain, bounds.plain))
        return CAMBER_OK;
    frame_bounds(view, &drawn);
    camber_plan_destroy(plan);
    return camber_plan_create(features, view, plan);
}
