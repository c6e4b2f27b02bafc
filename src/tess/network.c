/* Networks: cleaning polylines in world coordinates into steps of their box, and aiming a camera at them. */
#include "tess/network.h"
#include "base/perspective.h"

#include "kernels/offset.h"

#include <assert.h>
#include <math.h>

/* Steps over the longer side of the box: differences of two of them are 32-bit numbers. */
static const double STEPS = 2147483646.0;
/* Where all points lie in one place, or nearly so, a step still has a size: far below a pixel at any
 * zoom, and still a normal float in px at zoom 0, where a world is 512 px. */
static const double LEAST_EXTENT = 1e-30;
/* No difference of two coordinates is infinite. */
static const double FARTHEST = 1e300;
/* Of slots a point: its own, a ring's ghost, and the end of a piece. */
static const size_t MOST_POINTS = INT32_MAX;
/* A miter limit without reason must not undo the cutting. */
static const double LARGEST_REACH_PX = 65536.0;
/* How far from a place of an offset line, in offsets, lies what decides whether it is there: as far as a leg's end may
 * lie from what it hides, and what is looked at from there. kernels/offset.h */
static const double LOOKS = 2.0 * (double)CAMBER_OFFSET_REACH + 1.0;

/* No pixel of a projected point is infinite. */
static const double LARGEST_STEP_PX = 1e9, FARTHEST_PX = 1e30;

/* Shorter parts of a line do not tell how long that is. */
static const double LEAST_PART = 1e-6;

/* ---- Making ---- */

static camber_status check_entry(camber_context *context, const camber_network_desc *desc,
                                 const camber_network_entry *entry, size_t index) {
    if (entry->polyline >= desc->polyline_count)
        return camber_fail(context, CAMBER_ERROR_INPUT,
                           "network: entry %zu is polyline %u, and there are %zu; give one of these", index,
                           entry->polyline, desc->polyline_count);
    if (desc->offsets[entry->polyline + 1] < desc->offsets[entry->polyline])
        return camber_fail(context, CAMBER_ERROR_INPUT,
                           "network: polyline %u ends before it begins; offsets must ascend", entry->polyline);
    if (entry->row >= 1u << 24)
        return camber_fail(context, CAMBER_ERROR_INPUT,
                           "network: entry %zu: its row %u is not below %u; merge equal rows", index, entry->row,
                           1u << 24);
    return CAMBER_OK;
}

static camber_network_entry entry_of(const camber_network_desc *desc, size_t index) {
    return desc->entries ? desc->entries[index] : (camber_network_entry){.polyline = (uint32_t)index};
}

static bool is_valid(double x, double y) {
    return fabs(x) <= FARTHEST && fabs(y) <= FARTHEST;
}

typedef struct bounds {
    double x0, y0, x1, y1;
} bounds;

static void add_polyline(const camber_network_desc *desc, camber_network_entry entry, bounds *box) {
    for (size_t i = desc->offsets[entry.polyline]; i < desc->offsets[entry.polyline + 1]; i++) {
        const double x = desc->points[2 * i] + entry.shift_x, y = desc->points[2 * i + 1];
        if (!is_valid(x, y))
            continue;
        box->x0 = x < box->x0 ? x : box->x0;
        box->x1 = x > box->x1 ? x : box->x1;
        box->y0 = y < box->y0 ? y : box->y0;
        box->y1 = y > box->y1 ? y : box->y1;
    }
}

/* Checks the entries, counts their points and finds their box. */
static camber_status check_entries_and_find_box(camber_network *n, const camber_network_desc *desc) {
    bounds box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < n->entry_count; i++) {
        const camber_network_entry entry = entry_of(desc, i);
        const camber_status status = check_entry(n->context, desc, &entry, i);
        if (status != CAMBER_OK)
            return status;
        add_polyline(desc, entry, &box);
        n->stats.points += desc->offsets[entry.polyline + 1] - desc->offsets[entry.polyline];
    }
    n->stats.polylines = n->entry_count;
    if (n->stats.points > MOST_POINTS || n->entry_count > MOST_POINTS)
        return camber_fail(n->context, CAMBER_ERROR_LIMIT,
                           "network: %zu points in %zu polylines are more than 32-bit indices hold; draw them in parts",
                           n->stats.points, n->entry_count);
    if (box.x0 > box.x1)
        box = (bounds){0, 0, 0, 0};
    const double extent = fmax(box.x1 - box.x0, box.y1 - box.y0);
    n->x0 = box.x0;
    n->y0 = box.y0;
    n->step = fmax(extent, LEAST_EXTENT) / STEPS;
    return CAMBER_OK;
}

static int32_t to_step(double offset, double step) {
    const double steps = floor(offset / step + 0.5);
    return (int32_t)(steps < STEPS ? steps : STEPS);
}

static void store_point(camber_network *n, const double *point, double shift_x, float importance) {
    const int32_t x = to_step(point[0] + shift_x - n->x0, n->step), y = to_step(point[1] - n->y0, n->step);
    camber_run *run = n->runs + n->run_count;
    const float weight = importance >= 0.0f ? importance : importance < 0.0f ? 0.0f : INFINITY;
    if (n->point_count > run->first && n->x[n->point_count - 1] == x && n->y[n->point_count - 1] == y) {
        float *kept = n->importance + n->point_count - 1;
        *kept = weight > *kept ? weight : *kept;
        n->stats.repeated_points++;
        return;
    }
    n->x[n->point_count] = x;
    n->y[n->point_count] = y;
    n->importance[n->point_count++] = weight;
    run->x0 = x < run->x0 ? x : run->x0;
    run->x1 = x > run->x1 ? x : run->x1;
    run->y0 = y < run->y0 ? y : run->y0;
    run->y1 = y > run->y1 ? y : run->y1;
}

/* Valid points [first, end) of the desc. */
static void store_stretch(camber_network *n, const camber_network_desc *desc, camber_network_entry entry, size_t first,
                          size_t end, bool may_close) {
    const double *from = desc->points + 2 * first, *last = desc->points + 2 * (end - 1);
    const bool closes = may_close && end - first > 2 && from[0] == last[0] && from[1] == last[1];
    camber_run *run = n->runs + n->run_count;
    *run = (camber_run){(uint32_t)n->point_count, entry.row << CAMBER_POINT_ROW_SHIFT, INT32_MAX, INT32_MAX, -1, -1};
    for (size_t i = first; i < end; i++)
        store_point(n, desc->points + 2 * i, entry.shift_x, desc->importance ? desc->importance[i] : INFINITY);
    const size_t count = n->point_count - run->first;
    n->importance[run->first] = n->importance[n->point_count - 1] = INFINITY;
    if (closes && count > 2)
        run->word |= CAMBER_RUN_RING;
    n->stats.kept_points += count;
    n->stats.kept_segments += count - 1;
    n->stats.dots += count == 1;
    n->stats.rings += closes && count > 2;
    n->run_count++;
}

static camber_status store_entry(camber_network *n, const camber_network_desc *desc, camber_network_entry entry,
                                 size_t *run_capacity) {
    const size_t begin = desc->offsets[entry.polyline], end = desc->offsets[entry.polyline + 1];
    n->stats.empty_polylines += begin == end;
    size_t first = begin;
    for (size_t i = begin; i <= end; i++) {
        if (i < end && is_valid(desc->points[2 * i] + entry.shift_x, desc->points[2 * i + 1]))
            continue;
        if (!camber_grow(n->context, &n->runs, run_capacity, n->run_count + 2, sizeof *n->runs))
            return CAMBER_ERROR_MEMORY;
        if (i > first)
            store_stretch(n, desc, entry, first, i, !desc->keep_open && first == begin && i == end);
        n->stats.invalid_points += i < end;
        first = i + 1;
    }
    return CAMBER_OK;
}

static double length_into(const camber_network *n, size_t point) {
    return hypot((double)n->x[point] - n->x[point - 1], (double)n->y[point] - n->y[point - 1]);
}

/* A run that is all of its line, or, by two shares of that one's length, a part of it. */
static void measure_stretch(camber_network *n, size_t run, const float *progress) {
    const size_t first = n->runs[run].first, end = n->runs[run + 1].first;
    const double from = progress ? (double)progress[0] : 0.0, part = progress ? (double)progress[1] - from : 1.0;
    const bool is_part = from >= 0.0 && from < 1.0 && part > LEAST_PART && part <= 1.0 - from + LEAST_PART;
    double length = 0.0;
    for (size_t i = first + 1; i < end; i++)
        length += length_into(n, i);
    const double total = is_part ? length / part : length;
    double along = is_part ? from * total : 0.0;
    for (size_t i = first; i < end; i++) {
        along += i > first ? length_into(n, i) : 0.0;
        n->lengths[i] = (float)along;
    }
    n->totals[run] = (float)total;
}

static camber_status measure_stretches(camber_network *n, const camber_network_desc *desc) {
    if (!(n->lengths = camber_alloc(n->context, n->point_count, sizeof *n->lengths)) ||
        !(n->totals = camber_alloc(n->context, n->run_count, sizeof *n->totals)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < n->entry_count; i++)
        for (size_t r = n->entry_runs[i]; r < n->entry_runs[i + 1]; r++)
            measure_stretch(n, r, desc->progress ? desc->progress + 2 * entry_of(desc, i).polyline : NULL);
    return CAMBER_OK;
}

static camber_status store_entries(camber_network *n, const camber_network_desc *desc) {
    camber_context *context = n->context;
    const size_t points = n->stats.points;
    size_t run_capacity = 0;
    if (!(n->x = camber_alloc(context, points, sizeof *n->x)) ||
        !(n->y = camber_alloc(context, points, sizeof *n->y)) ||
        !(n->importance = camber_alloc(context, points, sizeof *n->importance)) ||
        !(n->entry_runs = camber_alloc(context, n->entry_count + 1, sizeof *n->entry_runs)) ||
        !(n->entry_rows = camber_alloc(context, n->entry_count, sizeof *n->entry_rows)) ||
        !camber_grow(context, &n->runs, &run_capacity, n->entry_count + 1, sizeof *n->runs))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < n->entry_count; i++) {
        const camber_network_entry entry = entry_of(desc, i);
        n->entry_runs[i] = (uint32_t)n->run_count;
        n->entry_rows[i] = entry.row;
        n->row_count = entry.row + 1 > n->row_count ? entry.row + 1 : n->row_count;
        const camber_status status = store_entry(n, desc, entry, &run_capacity);
        if (status != CAMBER_OK)
            return status;
    }
    n->entry_runs[n->entry_count] = (uint32_t)n->run_count;
    n->runs[n->run_count] = (camber_run){.first = (uint32_t)n->point_count};
    return desc->measured ? measure_stretches(n, desc) : CAMBER_OK;
}

camber_status camber_network_create(camber_context *context, const camber_network_desc *desc,
                                    camber_network **network) {
    assert(desc->polyline_count == 0 || desc->offsets);
    assert(desc->entry_count == 0 || desc->entries);
    camber_network *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->holders = 1;
    made->serial = context->next_serial++;
    made->entry_count = desc->entries ? desc->entry_count : desc->polyline_count;
    camber_status status = check_entries_and_find_box(made, desc);
    if (status == CAMBER_OK)
        status = store_entries(made, desc);
    if (status == CAMBER_OK)
        *network = made;
    else
        camber_network_destroy(made);
    return status;
}

void camber_network_hold(camber_network *network) {
    network->holders++;
}

void camber_network_destroy(camber_network *network) {
    if (!network || --network->holders > 0)
        return;
    camber_context *context = network->context;
    camber_free(context, network->entry_rows);
    camber_free(context, network->entry_runs);
    camber_free(context, network->runs);
    camber_free(context, network->totals);
    camber_free(context, network->lengths);
    camber_free(context, network->importance);
    camber_free(context, network->y);
    camber_free(context, network->x);
    camber_free(context, network);
}

camber_polylines_stats camber_network_get_stats(const camber_network *network) {
    return network->stats;
}

/* ---- Aiming ---- */

static camber_status check_camera(const camber_network *network, const camber_camera *camera) {
    camber_context *context = network->context;
    const double sides = (double)camera->width * camera->height;
    if (!(isfinite(camera->x) && isfinite(camera->y) && isfinite(camera->bearing_deg)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "camera: at %g, %g with a bearing of %g; give numbers",
                           camera->x, camera->y, camera->bearing_deg);
    if (!(camera->scale_px > 0.0 && isfinite(camera->scale_px)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "camera: %g px a world unit; choose a number above 0",
                           camera->scale_px);
    if (!(camera->translate_px >= 0.0 && isfinite(camera->translate_px)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "camera: a translation of %g px; choose 0 or a distance",
                           camera->translate_px);
    if (!(network->step * camera->scale_px <= LARGEST_STEP_PX))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "camera: %g px a world unit make %g px of a step of the network; choose a smaller scale",
                           camera->scale_px, network->step * camera->scale_px);
    if (!(camera->simplify_px >= 0.0 && isfinite(camera->simplify_px)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "camera: a simplification of %g px; choose 0 or a distance in pixels", camera->simplify_px);
    if (!camber_pitch_is_valid(camera->pitch_deg))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "camera: a pitch of %g degrees; choose 0 to %g",
                           camera->pitch_deg, CAMBER_PITCH_MAX_DEG);
    if (sides < 1.0 || camera->width > 65535u || camera->height > 65535u)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "camera: a picture of %u x %u px; choose sides of 1 to 65535", camera->width,
                           camera->height);
    return CAMBER_OK;
}

/* How far from its polyline a stroke touches pixels. */
static double reach_of(const camber_stroke *stroke) {
    const double half = 0.5 * (double)stroke->width_px;
    double factor = stroke->cap == CAMBER_CAP_SQUARE ? 1.5 : 1.0; /* a corner lies sqrt(2) away */
    if (stroke->join == CAMBER_JOIN_MITER)
        factor = fmax(factor, stroke->miter_limit > 0.0f ? (double)stroke->miter_limit : 2.0);
    if (stroke->join == CAMBER_JOIN_ROUND)
        factor =
            fmax(factor, (double)fminf(stroke->round_limit, stroke->miter_limit > 0.0f ? stroke->miter_limit : 2.0f));
    return fmin(half * factor, fmax(half, LARGEST_REACH_PX));
}

/* How far from its polyline a stroke with an offset runs. */
static double offset_of(const camber_stroke *stroke) {
    const double limit = stroke->miter_limit > 0.0f ? (double)stroke->miter_limit : 2.0;
    const double far = fabs((double)stroke->offset_px);
    if (!(far > 0.0))
        return 0.0;
    return fmin(far * (stroke->join == CAMBER_JOIN_MITER ? fmax(limit, 1.1) : 1.1), fmax(far, LARGEST_REACH_PX));
}

/* Steps of the network, rounded outwards, down where by is below 0, and bound to 32 bits. What is too far or too small
 * for a double is all of it. */
static int32_t outwards(double offset, double step, double by) {
    const double steps = floor(offset / step) + by;
    if (isnan(steps))
        return by < 0.0 ? INT32_MIN : INT32_MAX;
    return steps <= (double)INT32_MIN ? INT32_MIN : steps >= (double)INT32_MAX ? INT32_MAX : (int32_t)steps;
}

static double origin_of(double offset, double step) {
    const double steps = floor(offset / step + 0.5);
    return !(steps > 0.0) ? 0.0 : steps >= STEPS ? STEPS : steps;
}

static double bound_px(double px) {
    return fmin(fmax(px, -FARTHEST_PX), FARTHEST_PX);
}

/* What is seen of the plane, px from where the camera looks at: |x| up to side - slope * y, y from far to near. */
typedef struct trapezoid {
    double side, slope, far_y, near_y;
} trapezoid;

/* With what reaches into the picture from outside. A pixel more on each side; and past the far plane no more than twice
 * its depth, since a pixel may reach the horizon. */
static trapezoid trapezoid_of(const camber_camera *camera, const camber_perspective *p, double reach) {
    const double half_x = 0.5 * camera->width + 1.0, half_y = 0.5 * camera->height + 1.0, slope = p->fall * half_x;
    const double seen_y = p->far_y - 1.5, near = half_y * camber_perspective_depth(p, half_y) / p->cosine;
    const bool is_below = p->cosine + p->fall * seen_y > 0.5 * p->cosine / p->farthest;
    const double far_depth = is_below ? camber_perspective_depth(p, seen_y) : 2.0 * p->farthest;
    return (trapezoid){.side = half_x + (reach + 4.0) * hypot(1.0, slope),
                       .slope = slope,
                       .far_y = (1.0 - far_depth) / p->fall - reach - 4.0,
                       .near_y = near + reach + 4.0};
}

static void aim_pitched(const camber_network *network, const camber_camera *camera, double reach,
                        camber_projection *p) {
    const camber_perspective perspective = camber_perspective_of(camera->pitch_deg, camera->height);
    const trapezoid seen = trapezoid_of(camera, &perspective, reach);
    const double half_x = 0.5 * camera->width, half_y = 0.5 * camera->height, step = network->step;
    const double widest = seen.side - seen.slope * seen.far_y, narrowest = seen.side - seen.slope * seen.near_y;
    const double cosine = (double)p->across_x / (step * camera->scale_px),
                 sine = (double)p->down_x / (step * camera->scale_px);
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
    for (int i = 0; i < 4; i++) {
        const double v = i < 2 ? seen.far_y : seen.near_y,
                     u = (i % 2 ? 1.0 : -1.0) * (i < 2 ? widest : fmax(narrowest, 0.0));
        const double x = (u * cosine - v * sine) / camera->scale_px, y = (u * sine + v * cosine) / camera->scale_px;
        x0 = fmin(x0, x);
        x1 = fmax(x1, x);
        y0 = fmin(y0, y);
        y1 = fmax(y1, y);
    }
    p->window_x0 = (float)(half_x - narrowest);
    p->window_x1 = (float)(half_x + narrowest);
    p->window_y0 = (float)(half_y + seen.far_y);
    p->window_y1 = (float)(half_y + seen.near_y);
    p->slope = (float)seen.slope;
    p->middle_y = (float)half_y;
    p->fall = (float)perspective.fall;
    p->nearest = (float)perspective.nearest;
    p->inverse_cosine = (float)(1.0 / perspective.cosine);
    p->seen_x0 = outwards(camera->x + x0 - network->x0, step, -2.0);
    p->seen_y0 = outwards(camera->y + y0 - network->y0, step, -2.0);
    p->seen_x1 = outwards(camera->x + x1 - network->x0, step, 3.0);
    p->seen_y1 = outwards(camera->y + y1 - network->y0, step, 3.0);
}

camber_status camber_network_aim(const camber_network *network, const camber_camera *camera,
                                 const camber_tessellation_desc *desc, camber_projection *projection) {
    const camber_status status = check_camera(network, camera);
    if (status != CAMBER_OK)
        return status;
    if (desc->measured && !network->lengths && network->point_count)
        return camber_fail(network->context, CAMBER_ERROR_ARGUMENT,
                           "a measured mesh of a network that is not; make the network measured");
    const double angle = fmod(camera->bearing_deg, 360.0) * (3.14159265358979323846 / 180.0);
    const bool quarters = remainder(camera->bearing_deg, 90.0) == 0.0; /* axis-parallel lines stay so */
    const double cosine = quarters ? round(cos(angle)) : cos(angle), sine = quarters ? round(sin(angle)) : sin(angle);
    const double step = network->step, scale = step * camera->scale_px;
    const double origin_x = origin_of(camera->x - network->x0, step),
                 origin_y = origin_of(camera->y - network->y0, step);
    const double dx = bound_px((network->x0 + origin_x * step - camera->x) * camera->scale_px);
    const double dy = bound_px((network->y0 + origin_y * step - camera->y) * camera->scale_px);
    const double half_x = 0.5 * camera->width, half_y = 0.5 * camera->height;
    double reach = 0.0, looks = 0.0;
    for (size_t i = 0; i < desc->stroke_count; i++) {
        reach = fmax(reach, reach_of(desc->strokes + i) + offset_of(desc->strokes + i));
        looks = fmax(looks, LOOKS * fabs((double)desc->strokes[i].offset_px));
    }
    reach += camera->translate_px;
    const double margin = fmax(reach + looks + 16.0, 64.0);
    /* Half the box of the turned picture and what strokes reach around it, in world units. */
    const double across = half_x + reach + 1.0, down = half_y + reach + 1.0;
    const double seen_x = (across * fabs(cosine) + down * fabs(sine)) / camera->scale_px;
    const double seen_y = (across * fabs(sine) + down * fabs(cosine)) / camera->scale_px;
    *projection = (camber_projection){
        .origin_x = (int32_t)origin_x,
        .origin_y = (int32_t)origin_y,
        .across_x = (float)(scale * cosine),
        .down_x = (float)(scale * sine),
        .at_x = (float)(dx * cosine + dy * sine + half_x),
        .across_y = (float)(-scale * sine),
        .down_y = (float)(scale * cosine),
        .at_y = (float)(dy * cosine - dx * sine + half_y),
        .tolerance = (float)(camera->simplify_px / camera->scale_px),
        .window_x0 = (float)-margin,
        .window_y0 = (float)-margin,
        .window_x1 = (float)(camera->width + margin),
        .window_y1 = (float)(camera->height + margin),
        .seen_x0 = outwards(camera->x - seen_x - network->x0, step, -2.0),
        .seen_y0 = outwards(camera->y - seen_y - network->y0, step, -2.0),
        .seen_x1 = outwards(camera->x + seen_x - network->x0, step, 3.0),
        .seen_y1 = outwards(camera->y + seen_y - network->y0, step, 3.0),
        .end = (uint32_t)network->point_count,
        .step_px = (float)scale,
    };
    if (camera->pitch_deg > 0.0)
        aim_pitched(network, camera, reach + looks, projection);
    return CAMBER_OK;
}
