/* Makes networks: cleans polylines in world coordinates and stores them as integers.
 *
 * Input: points in double, entries that say which polylines to draw with which rows, and importances. Output: a
 * camber_network. Main idea: positions are counted in steps of the data's bounding box, 2^31 - 2 along its longer side.
 * So the difference of two positions is an exact 32-bit integer, and the device projects relative to a point near the
 * camera without doubles.
 *
 *     1  check the entries, count their points, find their box
 *     2  store the points of each entry, stretch by stretch: an invalid point ends a stretch; repeated points and
 *        points of too little importance are dropped. With arc lengths, add up how far along its line each point is */
#include "points/network.h"

#include "base/maths.h"

#include <assert.h>
#include <math.h>

/* If all points have the same position, or nearly so, a step still needs a length. This one is far below a pixel at any
 * zoom, and is a normal float in px at zoom 0, where a world is 512 px. */
static const double LEAST_EXTENT = 1e-30;
/* Points farther out are invalid, so that no difference of two coordinates is infinite. */
static const double FARTHEST = 1e300;
/* This many points keep slot numbers within 32 bits, if each makes two slots. Where lines enter and leave the window,
 * and where long segments are halved, there may be more; parts check their sums. */
static const size_t MOST_POINTS = INT32_MAX;
/* A stretch that is a smaller fraction of its line says too little about the line's length. */
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

/* Whether a point is important enough to be stored. NaN counts as the highest importance, and a negative one as 0. */
static bool matters(const camber_network_desc *desc, size_t point) {
    return !desc->importance || !(desc->least_importance > 0.0f) || !(desc->importance[point] < desc->least_importance);
}

static bool is_place(const camber_network_desc *desc, camber_network_entry entry, size_t point) {
    return is_valid(desc->points[2 * point] + entry.shift_x, desc->points[2 * point + 1]);
}

/* Returns how many points may be stored: the important ones and the ends. The bounding box includes only these, so that
 * it is the same if the caller has already dropped the others; with arc lengths it includes all. */
static size_t add_polyline(const camber_network_desc *desc, camber_network_entry entry, bounds *box) {
    const size_t begin = desc->offsets[entry.polyline], end = desc->offsets[entry.polyline + 1];
    size_t stored = 2;
    for (size_t i = begin; i < end; i++) {
        const double x = desc->points[2 * i] + entry.shift_x, y = desc->points[2 * i + 1];
        if (!is_valid(x, y)) {
            stored += 2;
            continue;
        }
        const bool stays = entry.is_dots || matters(desc, i);
        stored += stays;
        if (!stays && !desc->has_arc_length && i > begin && i + 1 < end && is_place(desc, entry, i - 1) &&
            is_place(desc, entry, i + 1))
            continue;
        box->x0 = x < box->x0 ? x : box->x0;
        box->x1 = x > box->x1 ? x : box->x1;
        box->y0 = y < box->y0 ? y : box->y0;
        box->y1 = y > box->y1 ? y : box->y1;
    }
    return stored;
}

/* Sets the step, and the position of step 0: a multiple of the step if the caller gave one. */
static void choose_step(camber_network *n, double step, const bounds *box) {
    const double extent = fmax(box->x1 - box->x0, box->y1 - box->y0);
    n->x0 = box->x0;
    n->y0 = box->y0;
    n->step = fmax(extent, LEAST_EXTENT) / CAMBER_NETWORK_STEPS;
    if (!(step > 0.0) || !isfinite(step))
        return;
    while (extent / step > CAMBER_NETWORK_STEPS - 2.0)
        step *= 2.0;
    n->step = step;
    n->x0 = floor(box->x0 / step) * step;
    n->y0 = floor(box->y0 / step) * step;
}

/* Checks the entries, counts their points, and sets the box's origin and the step. */
static camber_status check_entries_and_find_box(camber_network *n, const camber_network_desc *desc, size_t *capacity) {
    size_t stored = 0;
    bounds box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < n->entry_count; i++) {
        const camber_network_entry entry = entry_of(desc, i);
        const camber_status status = check_entry(n->context, desc, &entry, i);
        if (status != CAMBER_OK)
            return status;
        stored += add_polyline(desc, entry, &box);
        n->stats.points += desc->offsets[entry.polyline + 1] - desc->offsets[entry.polyline];
    }
    n->stats.polylines = n->entry_count;
    *capacity = stored < n->stats.points ? stored : n->stats.points;
    if (*capacity > MOST_POINTS || n->entry_count > MOST_POINTS)
        return camber_fail(n->context, CAMBER_ERROR_LIMIT,
                           "network: %zu points in %zu polylines are more than 32-bit indices hold; draw them in parts",
                           *capacity, n->entry_count);
    if (box.x0 > box.x1)
        box = (bounds){0, 0, 0, 0};
    choose_step(n, desc->step, &box);
    return CAMBER_OK;
}

static int32_t to_step(double offset, double step) {
    const double steps = floor(offset / step + 0.5);
    return (int32_t)(steps < CAMBER_NETWORK_STEPS ? steps : CAMBER_NETWORK_STEPS);
}

/* A point in steps. */
typedef struct step_point {
    int32_t x, y;
} step_point;

static step_point step_of(const camber_network *n, const camber_network_desc *desc, camber_network_entry entry,
                          size_t point) {
    const double *from = desc->points + 2 * point;
    return (step_point){to_step(from[0] + entry.shift_x - n->x0, n->step), to_step(from[1] - n->y0, n->step)};
}

static double distance(step_point a, step_point b) {
    return camber_length((double)b.x - a.x, (double)b.y - a.y);
}

/* Stores a point, or drops it if it is on the same step as the previous one, which then gets the larger importance. An
 * importance that is NaN counts as infinite. */
static void store_point(camber_network *n, step_point at, double along, float importance) {
    camber_stretch *stretch = n->stretches + n->stretch_count;
    const float weight = importance >= 0.0f ? importance : importance < 0.0f ? 0.0f : INFINITY;
    if (n->point_count > stretch->first && n->x[n->point_count - 1] == at.x && n->y[n->point_count - 1] == at.y) {
        float *kept = n->importance + n->point_count - 1;
        *kept = weight > *kept ? weight : *kept;
        n->stats.repeated_points++;
        return;
    }
    n->x[n->point_count] = at.x;
    n->y[n->point_count] = at.y;
    if (n->lengths)
        n->lengths[n->point_count] = (float)along;
    n->importance[n->point_count++] = weight;
    stretch->x0 = at.x < stretch->x0 ? at.x : stretch->x0;
    stretch->x1 = at.x > stretch->x1 ? at.x : stretch->x1;
    stretch->y0 = at.y < stretch->y0 ? at.y : stretch->y0;
    stretch->y1 = at.y > stretch->y1 ? at.y : stretch->y1;
}

/* Finds the total length of the line that a stretch with arc lengths is part of, and how far along it the stretch
 * begins. Without progress the stretch is its whole line. With it, progress gives the fractions of the line's length at
 * which the stretch begins and ends, for example when tiles cut a line:
 *
 *     line      |--------------------------------|     total
 *     stretch         |-----------|                    length = (progress[1] - progress[0]) * total
 *                progress[0]   progress[1]
 *
 * Fractions that make no sense are ignored. */
static double measure_stretch(camber_network *n, const camber_network_desc *desc, camber_network_entry entry,
                              size_t first, size_t end) {
    const float *progress = desc->progress ? desc->progress + 2 * (size_t)entry.polyline : NULL;
    const double from = progress ? (double)progress[0] : 0.0, part = progress ? (double)progress[1] - from : 1.0;
    const bool is_part = from >= 0.0 && from < 1.0 && part > LEAST_PART && part <= 1.0 - from + LEAST_PART;
    double length = 0.0;
    step_point before = step_of(n, desc, entry, first);
    for (size_t i = first + 1; i < end; i++) {
        const step_point at = step_of(n, desc, entry, i);
        length += distance(before, at);
        before = at;
    }
    const double total = is_part ? length / part : length;
    n->totals[n->stretch_count] = (float)total;
    return is_part ? from * total : 0.0;
}

/* Stores the valid points [first, end) as a stretch. Its ends get infinite importance, so that they are always kept. */
static void store_stretch(camber_network *n, const camber_network_desc *desc, camber_network_entry entry, size_t first,
                          size_t end, bool may_close) {
    const double *from = desc->points + 2 * first, *last = desc->points + 2 * (end - 1);
    const bool closes = may_close && end - first > 2 && from[0] == last[0] && from[1] == last[1];
    camber_stretch *stretch = n->stretches + n->stretch_count;
    *stretch =
        (camber_stretch){(uint32_t)n->point_count, entry.row << CAMBER_POINT_ROW_SHIFT, INT32_MAX, INT32_MAX, -1, -1};
    double along = n->lengths ? measure_stretch(n, desc, entry, first, end) : 0.0;
    step_point before = step_of(n, desc, entry, first);
    for (size_t i = first; i < end; i++) {
        const bool stays = i == first || i + 1 == end || matters(desc, i);
        if (!stays && !n->lengths)
            continue;
        const step_point at = step_of(n, desc, entry, i);
        along += n->lengths ? distance(before, at) : 0.0;
        before = at;
        if (stays)
            store_point(n, at, along, desc->importance ? desc->importance[i] : INFINITY);
    }
    const size_t count = n->point_count - stretch->first;
    n->importance[stretch->first] = n->importance[n->point_count - 1] = INFINITY;
    if (closes && count > 2)
        stretch->word |= CAMBER_STRETCH_RING | (entry.is_area ? CAMBER_STRETCH_AREA : 0u);
    n->stats.kept_points += count;
    n->stats.kept_segments += count - 1;
    n->stats.dots += count == 1;
    n->stats.rings += closes && count > 2;
    n->stretch_count++;
}

typedef struct capacities {
    size_t stretches, totals;
} capacities;

static bool grow_stretches(camber_network *n, size_t count, capacities *room) {
    return camber_grow(n->context, &n->stretches, &room->stretches, count, sizeof *n->stretches) &&
           (!n->lengths || camber_grow(n->context, &n->totals, &room->totals, count, sizeof *n->totals));
}

/* Whether all points of a ring are valid. Counts the invalid ones. A ring with invalid points is left out, because open
 * pieces of it would fill everything to their right. */
static bool is_valid_ring(camber_network *n, const camber_network_desc *desc, camber_network_entry entry) {
    size_t invalid = 0;
    for (size_t i = desc->offsets[entry.polyline]; i < desc->offsets[entry.polyline + 1]; i++)
        invalid += !is_place(desc, entry, i);
    n->stats.invalid_points += invalid;
    return invalid == 0;
}

/* Stores an entry's points, with a stretch between each two invalid points, or one for each dot. */
static camber_status store_entry(camber_network *n, const camber_network_desc *desc, camber_network_entry entry,
                                 capacities *room) {
    const size_t begin = desc->offsets[entry.polyline], end = desc->offsets[entry.polyline + 1];
    n->stats.empty_polylines += begin == end;
    if (entry.is_area && !is_valid_ring(n, desc, entry))
        return CAMBER_OK;
    const bool may_close = !desc->keep_open && !entry.is_dots;
    size_t first = begin;
    for (size_t i = begin; i <= end; i++) {
        const bool valid = i < end && is_place(desc, entry, i);
        if (valid && !(entry.is_dots && i > first))
            continue;
        if (!grow_stretches(n, n->stretch_count + 2, room))
            return CAMBER_ERROR_MEMORY;
        if (i > first)
            store_stretch(n, desc, entry, first, i, may_close && first == begin && i == end);
        n->stats.invalid_points += i < end && !valid;
        first = valid ? i : i + 1;
    }
    return CAMBER_OK;
}

static camber_status store_entries(camber_network *n, const camber_network_desc *desc, size_t points) {
    camber_context *context = n->context;
    capacities room = {0};
    if (!(n->x = camber_alloc(context, points, sizeof *n->x)) ||
        !(n->y = camber_alloc(context, points, sizeof *n->y)) ||
        !(n->importance = camber_alloc(context, points, sizeof *n->importance)) ||
        !(n->entry_stretches = camber_alloc(context, n->entry_count + 1, sizeof *n->entry_stretches)) ||
        !(n->entry_rows = camber_alloc(context, n->entry_count, sizeof *n->entry_rows)) ||
        (desc->has_arc_length && !(n->lengths = camber_alloc(context, points, sizeof *n->lengths))) ||
        !grow_stretches(n, n->entry_count + 1, &room))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < n->entry_count; i++) {
        const camber_network_entry entry = entry_of(desc, i);
        n->entry_stretches[i] = (uint32_t)n->stretch_count;
        n->entry_rows[i] = entry.row;
        n->row_count = entry.row + 1 > n->row_count ? entry.row + 1 : n->row_count;
        const camber_status status = store_entry(n, desc, entry, &room);
        if (status != CAMBER_OK)
            return status;
    }
    n->entry_stretches[n->entry_count] = (uint32_t)n->stretch_count;
    n->stretches[n->stretch_count] = (camber_stretch){.first = (uint32_t)n->point_count};
    return CAMBER_OK;
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
    made->has_importance = desc->importance || desc->polyline_count == 0;
    made->serial = context->next_serial++;
    made->entry_count = desc->entries ? desc->entry_count : desc->polyline_count;
    size_t capacity = 0;
    camber_status status = check_entries_and_find_box(made, desc, &capacity);
    if (status == CAMBER_OK)
        status = store_entries(made, desc, capacity);
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
