/* Fits a view to everything that a style draws.
 *
 * Input: features, and a view whose size, ratio and bearing are set. Output: the moved view and its plan. The features
 * that are drawn depend on the zoom, so the view is fitted to a first guess, and again if other features are drawn
 * then.
 *
 * Extracts of OpenStreetMap have whole ways and relations at their edges, so a river, a railway or the sea may reach
 * far beyond what the map is about. In extracts each side of the bounds is cut off at the place beyond which there are
 * only three lines in a thousand, if it is far outside:
 *
 *       +-----------------------------+  all lines
 *       | +-----------+        a      |
 *       | | 99 % of   |      river    |    the left, the upper and the lower side are near enough to stay; the right
 *       | | the lines |     ~~~~~~~~~~|    side moves to the inner box
 *       +-+-----------+---------------+
 */
#include "map/plan.h"

#include <math.h>
#include <stdlib.h>

/* Nearly every road style draws all of its classes at this zoom, so it is the first guess at which features will be
 * drawn. */
static const double FIRST_ZOOM = 14.0;
static const double LARGEST_FIT_ZOOM = 22.0;
static const double FILL = 0.96; /* a margin of 2 % on each side */

/* At most this many lines are looked at for the place beyond which there are few, spread over all of them. Bounds of
 * fewer lines than SAMPLES_MIN are not cut off. */
enum { SAMPLES_MAX = 4096, SAMPLES_MIN = 100 };
/* The share of lines that may be beyond a side, and how far a side may be from that place, as a share of the size of
 * the inner box, so that it stays. */
static const double OUTER_SHARE = 0.003, NEAR_SHARE = 0.25;
static const double INNER_MARGIN = 0.02;

static bool is_empty(camber_box box) {
    return box.x0 > box.x1;
}

/* Two bounds of the same data in the view's rotated axes: as it is, and with the western half of the world moved east
 * of the eastern half. The second one is smaller if the data is on both sides of the antimeridian. */
typedef struct two_bounds {
    camber_box plain, moved;
} two_bounds;

static two_bounds bounds_of_polyline(const camber_features *features, size_t polyline, const camber_view *view) {
    camber_box box = CAMBER_BOX_EMPTY, moved = CAMBER_BOX_EMPTY;
    double west = 1.0, east = 0.0;
    for (size_t i = features->offsets[polyline]; i < features->offsets[polyline + 1]; i++) {
        const double x = features->points[2 * i], y = features->points[2 * i + 1];
        if (!isfinite(x) || !isfinite(y))
            continue;
        camber_box_add(&box, x * view->cosine + y * view->sine, y * view->cosine - x * view->sine);
        west = fmin(west, x);
        east = fmax(east, x);
    }
    if (!is_empty(box)) {
        const double worlds = 0.5 * (west + east) < 0.5 ? 1.0 : 0.0;
        const double du = worlds * view->cosine, dv = -worlds * view->sine;
        moved = (camber_box){box.x0 + du, box.y0 + dv, box.x1 + du, box.y1 + dv};
    }
    return (two_bounds){box, moved};
}

static void unite(camber_box *box, camber_box other) {
    if (is_empty(other))
        return;
    camber_box_add(box, other.x0, other.y0);
    camber_box_add(box, other.x1, other.y1);
}

static void add_polyline(const camber_features *features, size_t polyline, const camber_view *view,
                         two_bounds *bounds) {
    const two_bounds added = bounds_of_polyline(features, polyline, view);
    unite(&bounds->plain, added.plain);
    unite(&bounds->moved, added.moved);
}

/* Whether the second bounds are the smaller ones. */
static bool is_moved_smaller(const two_bounds *bounds, const camber_view *view) {
    camber_view plain = *view, moved = *view;
    if (is_empty(bounds->plain))
        return false;
    camber_view_frame(&plain, bounds->plain, FILL, LARGEST_FIT_ZOOM);
    camber_view_frame(&moved, bounds->moved, FILL, LARGEST_FIT_ZOOM);
    return moved.zoom > plain.zoom;
}

/* Returns the bounds of all features, with labels or without. */
static camber_box bounds_of_all(const camber_features *features, const camber_view *view, bool labels) {
    two_bounds bounds = {CAMBER_BOX_EMPTY, CAMBER_BOX_EMPTY};
    for (size_t p = 0; p < features->polyline_count; p++)
        if (labels || !camber_geometry_is_label(camber_features_kind(features, p)))
            add_polyline(features, p, view, &bounds);
    return is_moved_smaller(&bounds, view) ? bounds.moved : bounds.plain;
}

/* ---- Extracts ---- */

typedef struct outer_sides {
    size_t count;
    double side[4][SAMPLES_MAX]; /* x0, y0, -x1 and -y1 of boxes, so that the smallest are the outermost */
} outer_sides;

static void add_sample(outer_sides *samples, camber_box box) {
    if (is_empty(box) || samples->count == SAMPLES_MAX)
        return;
    const double sides[4] = {box.x0, box.y0, -box.x1, -box.y1};
    for (int i = 0; i < 4; i++)
        samples->side[i][samples->count] = sides[i];
    samples->count++;
}

static int compare_numbers(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Moves the sides that are far outside of most lines. */
static camber_box cut_off(outer_sides *samples, camber_box all) {
    double inner[4], outer[4] = {all.x0, all.y0, -all.x1, -all.y1};
    const size_t beyond = 1 + (size_t)(OUTER_SHARE * (double)samples->count);
    if (samples->count < SAMPLES_MIN)
        return all;
    for (int i = 0; i < 4; i++) {
        qsort(samples->side[i], samples->count, sizeof *samples->side[i], compare_numbers);
        inner[i] = samples->side[i][beyond];
    }
    for (int i = 0; i < 4; i++) {
        const double size = -inner[i & 1] - inner[(i & 1) + 2];
        if (size > 0.0 && inner[i] - outer[i] > NEAR_SHARE * size)
            outer[i] = inner[i] - INNER_MARGIN * size;
    }
    return (camber_box){outer[0], outer[1], -outer[2], -outer[3]};
}

/* Finds the bounds of what the plan draws, without what reaches far beyond an extract. Which half of the world is moved
 * is decided before that: the few lines on the other side of a meridian may be next to all others. */
static camber_status bounds_of(const camber_features *features, const camber_view *view, const camber_plan *plan,
                               camber_box *bounds) {
    const size_t count = plan->all.first_entries[plan->set_count], step = count / SAMPLES_MAX + 1;
    two_bounds extract = {CAMBER_BOX_EMPTY, CAMBER_BOX_EMPTY}, others = extract;
    outer_sides *samples = camber_alloc_zero(features->context, 2, sizeof *samples);
    if (!samples)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        const uint32_t polyline = plan->all.entries[i].polyline;
        const bool cuts = polyline >= features->extract_first && polyline < features->extract_end;
        if (features->classes[features->feature_class[features->polyline_feature[polyline]]].is_ends)
            continue;
        const two_bounds one = bounds_of_polyline(features, polyline, view);
        unite(cuts ? &extract.plain : &others.plain, one.plain);
        unite(cuts ? &extract.moved : &others.moved, one.moved);
        if (cuts && i % step == 0) {
            add_sample(&samples[0], one.plain);
            add_sample(&samples[1], one.moved);
        }
    }
    two_bounds all = others;
    unite(&all.plain, extract.plain);
    unite(&all.moved, extract.moved);
    const bool moves = is_moved_smaller(&all, view);
    *bounds = moves ? others.moved : others.plain;
    unite(bounds, cut_off(&samples[moves], moves ? extract.moved : extract.plain));
    camber_free(features->context, samples);
    return CAMBER_OK;
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
    camber_box bounds, drawn;
    status = bounds_of(features, view, plan, &bounds);
    if (status != CAMBER_OK)
        return status;
    if (is_empty(bounds))
        bounds = bounds_of_all(features, view, false);
    if (is_empty(bounds))
        bounds = bounds_of_all(features, view, true);
    if (!is_empty(bounds))
        camber_view_frame(view, bounds, FILL, LARGEST_FIT_ZOOM);
    camber_plan_destroy(plan);
    status = camber_plan_create(features, view, plan);
    if (status == CAMBER_OK)
        status = bounds_of(features, view, plan, &drawn);
    if (status != CAMBER_OK)
        return status;
    if (is_empty(drawn) || same_bounds(drawn, bounds))
        return CAMBER_OK;
    camber_view_frame(view, drawn, FILL, LARGEST_FIT_ZOOM);
    camber_plan_destroy(plan);
    return camber_plan_create(features, view, plan);
}
