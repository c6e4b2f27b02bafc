/* Makes networks: cleans polylines in world coordinates and stores them as integers.
 *
 * Input: points in double, entries that say which polylines to draw with which rows, and importances. Output: a
 * camber_network. Main idea: positions are counted in steps of the data's box, 2^31 - 2 over its longer side. So the
 * difference of two positions is an exact 32-bit integer, and the device projects relative to a point near the camera
 * without doubles.
 *
 *     1  check the entries, count their points, find their box
 *     2  store the points of each entry, stretch by stretch: an invalid point ends one, a repeated point is dropped
 *     3  with arc lengths: sum up how far along its line each point lies */
#include "tess/network.h"

#include <assert.h>
#include <math.h>

/* Where all points have one position, or nearly so, a step still needs a length. This one lies far below a pixel at any
 * zoom, and is a normal float in px at zoom 0, where a world is 512 px. */
static const double LEAST_EXTENT = 1e-30;
/* Points farther out are invalid, so that no difference of two coordinates is infinite. */
static const double FARTHEST = 1e300;
/* So that 32 bits number the slots: a point may make its own, a ring's sentinel, and an end where the window cuts. */
static const size_t MOST_POINTS = INT32_MAX;
/* A stretch that is a smaller share of its line says too little about how long the line is. */
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

/* A box in world coordinates. */
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

/* Checks the entries, counts their points, and sets the box's origin and the step. */
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
    n->step = fmax(extent, LEAST_EXTENT) / CAMBER_NETWORK_STEPS;
    return CAMBER_OK;
}

static int32_t to_step(double offset, double step) {
    const double steps = floor(offset / step + 0.5);
    return (int32_t)(steps < CAMBER_NETWORK_STEPS ? steps : CAMBER_NETWORK_STEPS);
}

/* Stores a point, or drops it if it lies on the same step as the one before, which then keeps the larger importance. An
 * importance that is NaN counts as infinite. */
static void store_point(camber_network *n, const double *point, double shift_x, float importance) {
    const int32_t x = to_step(point[0] + shift_x - n->x0, n->step), y = to_step(point[1] - n->y0, n->step);
    camber_stretch *stretch = n->stretches + n->stretch_count;
    const float weight = importance >= 0.0f ? importance : importance < 0.0f ? 0.0f : INFINITY;
    if (n->point_count > stretch->first && n->x[n->point_count - 1] == x && n->y[n->point_count - 1] == y) {
        float *kept = n->importance + n->point_count - 1;
        *kept = weight > *kept ? weight : *kept;
        n->stats.repeated_points++;
        return;
    }
    n->x[n->point_count] = x;
    n->y[n->point_count] = y;
    n->importance[n->point_count++] = weight;
    stretch->x0 = x < stretch->x0 ? x : stretch->x0;
    stretch->x1 = x > stretch->x1 ? x : stretch->x1;
    stretch->y0 = y < stretch->y0 ? y : stretch->y0;
    stretch->y1 = y > stretch->y1 ? y : stretch->y1;
}

/* Stores the valid points [first, end) as a stretch. Its ends have infinite importance: they always stay. */
static void store_stretch(camber_network *n, const camber_network_desc *desc, camber_network_entry entry, size_t first,
                          size_t end, bool may_close) {
    const double *from = desc->points + 2 * first, *last = desc->points + 2 * (end - 1);
    const bool closes = may_close && end - first > 2 && from[0] == last[0] && from[1] == last[1];
    camber_stretch *stretch = n->stretches + n->stretch_count;
    *stretch =
        (camber_stretch){(uint32_t)n->point_count, entry.row << CAMBER_POINT_ROW_SHIFT, INT32_MAX, INT32_MAX, -1, -1};
    for (size_t i = first; i < end; i++)
        store_point(n, desc->points + 2 * i, entry.shift_x, desc->importance ? desc->importance[i] : INFINITY);
    const size_t count = n->point_count - stretch->first;
    n->importance[stretch->first] = n->importance[n->point_count - 1] = INFINITY;
    if (closes && count > 2)
        stretch->word |= CAMBER_STRETCH_RING;
    n->stats.kept_points += count;
    n->stats.kept_segments += count - 1;
    n->stats.dots += count == 1;
    n->stats.rings += closes && count > 2;
    n->stretch_count++;
}

/* Stores an entry's points, a stretch between each two invalid points. */
static camber_status store_entry(camber_network *n, const camber_network_desc *desc, camber_network_entry entry,
                                 size_t *stretch_capacity) {
    const size_t begin = desc->offsets[entry.polyline], end = desc->offsets[entry.polyline + 1];
    n->stats.empty_polylines += begin == end;
    size_t first = begin;
    for (size_t i = begin; i <= end; i++) {
        if (i < end && is_valid(desc->points[2 * i] + entry.shift_x, desc->points[2 * i + 1]))
            continue;
        if (!camber_grow(n->context, &n->stretches, stretch_capacity, n->stretch_count + 2, sizeof *n->stretches))
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

/* Sums up arc lengths along a stretch. Without progress the stretch is its whole line. With it, progress gives the
 * shares of the line's length at which the stretch begins and ends, as where tiles cut a line:
 *
 *     line      |--------------------------------|     total
 *     stretch         |-----------|                    length = (progress[1] - progress[0]) * total
 *                progress[0]   progress[1]
 *
 * Shares that make no sense are ignored. */
static void measure_stretch(camber_network *n, size_t stretch, const float *progress) {
    const size_t first = n->stretches[stretch].first, end = n->stretches[stretch + 1].first;
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
    n->totals[stretch] = (float)total;
}

static camber_status measure_stretches(camber_network *n, const camber_network_desc *desc) {
    if (!(n->lengths = camber_alloc(n->context, n->point_count, sizeof *n->lengths)) ||
        !(n->totals = camber_alloc(n->context, n->stretch_count, sizeof *n->totals)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < n->entry_count; i++)
        for (size_t r = n->entry_stretches[i]; r < n->entry_stretches[i + 1]; r++)
            measure_stretch(n, r, desc->progress ? desc->progress + 2 * entry_of(desc, i).polyline : NULL);
    return CAMBER_OK;
}

static camber_status store_entries(camber_network *n, const camber_network_desc *desc) {
    camber_context *context = n->context;
    const size_t points = n->stats.points;
    size_t stretch_capacity = 0;
    if (!(n->x = camber_alloc(context, points, sizeof *n->x)) ||
        !(n->y = camber_alloc(context, points, sizeof *n->y)) ||
        !(n->importance = camber_alloc(context, points, sizeof *n->importance)) ||
        !(n->entry_stretches = camber_alloc(context, n->entry_count + 1, sizeof *n->entry_stretches)) ||
        !(n->entry_rows = camber_alloc(context, n->entry_count, sizeof *n->entry_rows)) ||
        !camber_grow(context, &n->stretches, &stretch_capacity, n->entry_count + 1, sizeof *n->stretches))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < n->entry_count; i++) {
        const camber_network_entry entry = entry_of(desc, i);
        n->entry_stretches[i] = (uint32_t)n->stretch_count;
        n->entry_rows[i] = entry.row;
        n->row_count = entry.row + 1 > n->row_count ? entry.row + 1 : n->row_count;
        const camber_status status = store_entry(n, desc, entry, &stretch_capacity);
        if (status != CAMBER_OK)
            return status;
    }
    n->entry_stretches[n->entry_count] = (uint32_t)n->stretch_count;
    n->stretches[n->stretch_count] = (camber_stretch){.first = (uint32_t)n->point_count};
    return desc->has_arc_length ? measure_stretches(n, desc) : CAMBER_OK;
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
    camber_free(context, network->entry_stretches);
    camber_free(context, network->stretches);
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
