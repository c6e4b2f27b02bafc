/* Cleans polylines and lays them out in slots, as the kernels read them.
 *
 * Input: points in px, where each polyline begins, rows of the style table. Output: camber_polylines (lines.h). Main
 * idea: everything irregular is dealt with here, so that kernels need no branch for it. An invalid point (NaN, or too
 * far away) splits its polyline into stretches; in a ring of an area it is left out. A point that repeats the previous
 * one is dropped. A ring, whose first and last points are equal, gets sentinels that continue it past its seam:
 *
 *     points       A B C D A           the last point is the first again
 *     slots    (D) A B C D A (B)       in brackets: sentinels, so that neighbours are always i - 1 and i + 1
 *
 * Most polylines need none of that. So open ones are appended in bundles, all points of a bundle at once, in loops that
 * compilers vectorise. Only if a bundle turns out to have an irregular point are its polylines appended one by one. */
#include "lines/lines.h"

#include <assert.h>
#include <string.h>

/* BUNDLE_POINTS: few enough that a bundle stays in the first-level cache while it is copied and checked. AHEAD_POINTS:
 * how far ahead of a ring's points memory is prefetched; the next ring is usually there. */
enum { BUNDLE_POINTS = 1024, AHEAD_POINTS = 256 };

/* Points within 1e-9 px of each other count as the same. */
static const float REPEATED_PX2 = 1e-18f;

/* Whether b repeats a. */
static bool is_repeated(const float *a, const float *b) {
    const float dx = b[0] - a[0], dy = b[1] - a[1];
    return dx * dx + dy * dy <= REPEATED_PX2;
}

/* Whether a polyline's last point equals its first. */
static bool is_closed(const float *points, size_t count) {
    const float *last = points + 2 * (count - 1);
    return count > 2 && points[0] == last[0] && points[1] == last[1];
}

static camber_status check_desc(camber_context *context, const camber_polylines_desc *desc) {
    assert(desc->polyline_count == 0 || desc->offsets);
    assert(desc->point_count == 0 || desc->points);
    size_t before = 0;
    const size_t covered = desc->polyline_count ? desc->offsets[desc->polyline_count] : 0;
    if (covered != desc->point_count || (desc->polyline_count && desc->offsets[0] != 0))
        return camber_fail(
            context, CAMBER_ERROR_INPUT,
            "polylines: offsets run from %u to %zu, and there are %zu points; they must run from 0 to that",
            desc->polyline_count ? desc->offsets[0] : 0u, covered, desc->point_count);
    for (size_t i = 0; desc->polyline_count && i <= desc->polyline_count; i++) {
        if (desc->offsets[i] < before || desc->offsets[i] > desc->point_count)
            return camber_fail(context, CAMBER_ERROR_INPUT,
                               "polyline %zu: its offset %u is not between %zu and %zu; offsets must ascend", i,
                               desc->offsets[i], before, desc->point_count);
        before = desc->offsets[i];
    }
    for (size_t i = 0; desc->rows && i < desc->polyline_count; i++)
        if (desc->rows[i] >= 1u << 24)
            return camber_fail(context, CAMBER_ERROR_INPUT,
                               "polyline %zu: its row %u is not below %u; merge equal rows", i, desc->rows[i],
                               1u << 24);
    /* A ring has at least three points and takes two sentinels: at most 5/3 slots per point. */
    if (desc->point_count > (UINT32_MAX - 1024u) / 5 * 3 || desc->polyline_count > UINT32_MAX - 1024u)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "%zu points in %zu polylines are more than 32-bit slots hold; draw them in parts",
                           desc->point_count, desc->polyline_count);
    return CAMBER_OK;
}

static void put_slot(camber_polylines *p, const float *point, uint32_t info) {
    const size_t i = ++p->slot_count; /* index 0 is the leading sentinel */
    p->x[i] = point[0];
    p->y[i] = point[1];
    p->info[i] = info;
}

/* Appends one stretch of valid points: drops repeated points, marks the ends, and gives a ring its sentinels. */
static void put_stretch(camber_polylines *p, const float *points, size_t count, uint32_t row, bool may_close) {
    const uint32_t real = row << CAMBER_POINT_ROW_SHIFT | CAMBER_POINT_REAL;
    const bool closes = may_close && is_closed(points, count);
    const size_t sentinel = p->slot_count + 1;
    if (closes)
        put_slot(p, points, 0);
    const size_t first = p->slot_count + 1;
    const float *kept = points;
    put_slot(p, points, real | CAMBER_POINT_FIRST);
    for (size_t i = 1; i < count; i++) {
        if (is_repeated(kept, points + 2 * i)) {
            p->stats.repeated_points++;
            continue;
        }
        kept = points + 2 * i;
        put_slot(p, kept, real);
    }
    const size_t end = p->slot_count, kept_count = end - first + 1;
    p->info[end] |= CAMBER_POINT_LAST;
    p->stats.kept_points += kept_count;
    p->stats.kept_segments += kept_count - 1;
    p->stats.dots += kept_count == 1;
    if (!closes || kept_count < 3)
        /* the stretch turned out not to be a ring: its leading slot remains a sentinel, which draws nothing */
        return;
    /* The last point may have been dropped because it repeats its neighbour. The ring still closes exactly. */
    p->x[end] = p->x[first];
    p->y[end] = p->y[first];
    p->info[first] |= CAMBER_POINT_RING;
    p->info[end] |= CAMBER_POINT_RING;
    p->x[sentinel] = p->x[end - 1];
    p->y[sentinel] = p->y[end - 1];
    put_slot(p, (const float[2]){p->x[first + 1], p->y[first + 1]}, 0);
    p->stats.rings++;
}

static void set_row(camber_polylines *p, size_t polyline, uint32_t row) {
    p->first_slots[polyline] = (uint32_t)p->slot_count;
    p->polyline_rows[polyline] = row;
    p->row_count = row + 1 > p->row_count ? row + 1 : p->row_count;
}

static void put_polyline(camber_polylines *p, const camber_polylines_desc *desc, size_t polyline) {
    const float *points = desc->points + 2 * (size_t)desc->offsets[polyline];
    const size_t count = desc->offsets[polyline + 1] - desc->offsets[polyline];
    const uint32_t row = desc->rows ? desc->rows[polyline] : 0;
    set_row(p, polyline, row);
    p->stats.empty_polylines += count == 0;
    size_t first = 0;
    for (size_t i = 0; i <= count; i++) {
        if (i < count && camber_point_is_valid(points + 2 * i))
            continue;
        if (i > first)
            put_stretch(p, points + 2 * first, i - first, row, !desc->keep_open && first == 0 && i == count);
        p->stats.invalid_points += i < count;
        first = i + 1;
    }
}

/* ---- Bundles of open polylines ---- */

/* Returns the end of the bundle that begins with the polyline first; all polylines of a bundle have the same row.
 * Returns first if this polyline is empty or closed. */
static size_t find_bundle_end(const camber_polylines_desc *desc, size_t first) {
    size_t end = first;
    for (; end < desc->polyline_count; end++) {
        const size_t from = desc->offsets[end], count = desc->offsets[end + 1] - from;
        const bool is_long = desc->offsets[end + 1] - desc->offsets[first] > BUNDLE_POINTS && end > first;
        const bool is_other = desc->rows && desc->rows[end] != desc->rows[first];
        if (count == 0 || is_long || is_other || (!desc->keep_open && is_closed(desc->points + 2 * from, count)))
            break;
    }
    return end;
}

/* Returns how many of these points repeat the previous one, or SIZE_MAX if a point is invalid. */
static size_t count_repeated(const float *x, const float *y, size_t count) {
    uint32_t invalid = 0, repeated = 0;
    for (size_t i = 0; i < count; i++)
        invalid |= !(fabsf(x[i]) <= CAMBER_FARTHEST_PX) | !(fabsf(y[i]) <= CAMBER_FARTHEST_PX);
    for (size_t i = 1; i < count; i++) {
        const float dx = x[i] - x[i - 1], dy = y[i] - y[i - 1];
        repeated += dx * dx + dy * dy <= REPEATED_PX2;
    }
    return invalid ? SIZE_MAX : repeated;
}

/* Copies the coordinates of points to x and y. */
static void put_coordinates(const float *restrict points, size_t count, float *restrict x, float *restrict y) {
    for (size_t i = 0; i < count; i++) {
        x[i] = points[2 * i];
        y[i] = points[2 * i + 1];
    }
}

/* Returns how many polylines, except the first, begin where the previous one ends. */
static size_t count_joined(const camber_polylines_desc *desc, size_t first, size_t end) {
    size_t count = 0;
    for (size_t i = first + 1; i < end; i++) {
        const float *point = desc->points + 2 * (size_t)desc->offsets[i];
        count += is_repeated(point - 2, point);
    }
    return count;
}

/* Appends the polylines [first, end). false: a point is invalid, or repeats the previous one of its polyline. */
static bool put_bundle(camber_polylines *p, const camber_polylines_desc *desc, size_t first, size_t end) {
    const size_t from = desc->offsets[first], count = desc->offsets[end] - from, slot = p->slot_count + 1;
    put_coordinates(desc->points + 2 * from, count, p->x + slot, p->y + slot);
    const size_t repeated = count_repeated(p->x + slot, p->y + slot, count);
    if (repeated > 0 && repeated != count_joined(desc, first, end))
        return false;
    const uint32_t row = desc->rows ? desc->rows[first] : 0;
    for (size_t i = 0; i < count; i++)
        p->info[slot + i] = row << CAMBER_POINT_ROW_SHIFT | CAMBER_POINT_REAL;
    for (size_t i = first; i < end; i++) {
        const size_t points = desc->offsets[i + 1] - desc->offsets[i];
        set_row(p, i, row);
        p->info[p->slot_count + 1] |= CAMBER_POINT_FIRST;
        p->slot_count += points;
        p->info[p->slot_count] |= CAMBER_POINT_LAST;
        p->stats.dots += points == 1;
    }
    p->stats.kept_points += count;
    p->stats.kept_segments += count - (end - first);
    return true;
}

static void put_polylines(camber_polylines *p, const camber_polylines_desc *desc) {
    for (size_t i = 0; i < desc->polyline_count;) {
        const size_t end = find_bundle_end(desc, i);
        if (end > i && put_bundle(p, desc, i, end))
            i = end;
        else
            do
                put_polyline(p, desc, i);
            while (++i < end);
    }
}

/* ---- Rings of areas ---- */

/* Copies the coordinates of a ring's points, whose values are `step` apart in memory, to x and y. Returns twice the
 * ring's signed area, positive if clockwise as seen; NAN if a point is invalid or repeats the previous one. One loop
 * does all of this, because most rings are short. */
static inline double put_around(const float *from_x, const float *from_y, size_t step, size_t count, float *x,
                                float *y) {
    uint32_t irregular = 0;
    double area = 0.0;
    float ax = from_x[step * (count - 1)], ay = from_y[step * (count - 1)];
    for (size_t i = 0; i < count; i++) {
        __builtin_prefetch(from_x + step * (i + AHEAD_POINTS));
        const float bx = from_x[step * i], by = from_y[step * i], dx = bx - ax, dy = by - ay;
        irregular |= !(fabsf(bx) <= CAMBER_FARTHEST_PX) | !(fabsf(by) <= CAMBER_FARTHEST_PX) |
                     (dx * dx + dy * dy <= REPEATED_PX2);
        area += (double)ax * (double)by - (double)bx * (double)ay;
        x[i] = ax = bx;
        y[i] = ay = by;
    }
    return irregular ? (double)NAN : area;
}

/* Drops the points of a ring that are invalid or repeat the previous one. Returns how many are left. */
static size_t drop_irregular(camber_polylines_stats *stats, float *x, float *y, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        const float point[2] = {x[i], y[i]};
        const bool valid = camber_point_is_valid(point);
        const bool repeated = valid && kept && is_repeated((const float[2]){x[kept - 1], y[kept - 1]}, point);
        stats->invalid_points += !valid;
        stats->repeated_points += repeated;
        x[kept] = point[0];
        y[kept] = point[1];
        kept += valid && !repeated;
    }
    for (; kept > 1 && is_repeated((const float[2]){x[kept - 1], y[kept - 1]}, (const float[2]){x[0], y[0]}); kept--)
        stats->repeated_points++;
    return kept;
}

static void turn_over(float *values, size_t count) {
    for (size_t first = 0, end = count; first + 1 < end; first++, end--) {
        const float kept = values[first];
        values[first] = values[end - 1];
        values[end - 1] = kept;
    }
}

/* Appends a ring of which fewer than two points are left. */
static void put_rest(camber_polylines *p, const float *x, const float *y, size_t count, uint32_t row) {
    p->stats.empty_polylines += count == 0;
    if (count == 0)
        return;
    put_slot(p, (const float[2]){*x, *y},
             row << CAMBER_POINT_ROW_SHIFT | CAMBER_POINT_REAL | CAMBER_POINT_FIRST | CAMBER_POINT_LAST);
    p->stats.kept_points++;
    p->stats.dots++;
}

void camber_polylines_put_ring(camber_polylines *p, size_t polyline, const float *points, size_t given, bool is_hole,
                               uint32_t row) {
    const bool repeats = given > 1 && points[0] == points[2 * given - 2] && points[1] == points[2 * given - 1];
    size_t count = given - repeats;
    const size_t sentinel = p->slot_count + 1;
    float *x = p->x + sentinel + 1, *y = p->y + sentinel + 1;
    uint32_t *info = p->info + sentinel + 1;
    set_row(p, polyline, row);
    p->stats.points += count;
    double area = count ? put_around(points, points + 1, 2, count, x, y) : 0.0;
    if (isnan(area)) {
        count = drop_irregular(&p->stats, x, y, count);
        area = count ? put_around(x, y, 1, count, x, y) : 0.0;
    }
    if (count < 2) {
        p->stats.points += repeats;
        p->stats.repeated_points += repeats;
        put_rest(p, x, y, count, row);
        return;
    }
    if (is_hole ? area > 0.0 : area < 0.0) {
        turn_over(x, count);
        turn_over(y, count);
    }
    x[count] = x[0];
    y[count] = y[0];
    p->x[sentinel] = x[count - 1];
    p->y[sentinel] = y[count - 1];
    x[count + 1] = x[1];
    y[count + 1] = y[1];
    for (size_t i = 0; i <= count; i++)
        info[i] = row << CAMBER_POINT_ROW_SHIFT | CAMBER_POINT_REAL;
    info[0] |= CAMBER_POINT_FIRST | CAMBER_POINT_RING;
    info[count] |= CAMBER_POINT_LAST | CAMBER_POINT_RING;
    p->info[sentinel] = info[count + 1] = 0;
    p->slot_count += count + 3;
    p->stats.points++; /* the first point, repeated */
    p->stats.kept_points += count + 1;
    p->stats.kept_segments += count;
    p->stats.rings++;
}

/* Appends sentinels up to the end of the last block, and one after it. They are at the origin, so that no kernel meets
 * a NaN. */
static void put_padding(camber_polylines *p) {
    const size_t used = p->slot_count + 1;
    p->slot_count = (p->slot_count + CAMBER_BLOCK - 1) / CAMBER_BLOCK * CAMBER_BLOCK;
    const size_t padding = p->slot_count + 2 - used;
    memset(p->x + used, 0, padding * sizeof *p->x);
    memset(p->y + used, 0, padding * sizeof *p->y);
    memset(p->info + used, 0, padding * sizeof *p->info);
}

/* Makes the arrays, in one block. */
static bool reserve(camber_polylines *p, size_t slots) {
    p->block = camber_alloc_spare(p->context, 3 * slots + 2 * p->polyline_count + 1, sizeof *p->info);
    if (!p->block)
        return false;
    p->x = p->block;
    p->y = p->x + slots;
    p->info = (uint32_t *)(p->y + slots);
    p->first_slots = p->info + slots;
    p->polyline_rows = p->first_slots + p->polyline_count + 1;
    return true;
}

camber_status camber_polylines_begin(camber_context *context, size_t slots, size_t polyline_count,
                                     camber_polylines **polylines) {
    camber_polylines *p = camber_alloc_zero(context, 1, sizeof *p);
    if (!p)
        return CAMBER_ERROR_MEMORY;
    p->context = context;
    p->serial = context->next_serial++;
    p->polyline_count = polyline_count;
    p->stats.polylines = polyline_count;
    if (!reserve(p, slots + 2 + CAMBER_BLOCK)) {
        camber_polylines_destroy(p);
        return CAMBER_ERROR_MEMORY;
    }
    p->x[0] = p->y[0] = 0;
    p->info[0] = 0;
    *polylines = p;
    return CAMBER_OK;
}

void camber_polylines_end(camber_polylines *p) {
    p->first_slots[p->polyline_count] = (uint32_t)p->slot_count;
    put_padding(p);
}

camber_status camber_polylines_create(camber_context *context, const camber_polylines_desc *desc,
                                      camber_polylines **polylines) {
    camber_status status = check_desc(context, desc);
    if (status != CAMBER_OK)
        return status;
    size_t rings = 0;
    for (size_t i = 0; i < desc->polyline_count; i++)
        rings += desc->offsets[i + 1] - desc->offsets[i] > 2;
    status = camber_polylines_begin(context, desc->point_count + 2 * (desc->keep_open ? 0 : rings),
                                    desc->polyline_count, polylines);
    if (status != CAMBER_OK)
        return status;
    (*polylines)->stats.points = desc->point_count;
    put_polylines(*polylines, desc);
    camber_polylines_end(*polylines);
    return CAMBER_OK;
}

void camber_polylines_hold(camber_polylines *polylines) {
    polylines->holders++;
}

void camber_polylines_destroy(camber_polylines *polylines) {
    if (!polylines || polylines->holders > 0) {
        if (polylines)
            polylines->holders--;
        return;
    }
    camber_context *context = polylines->context;
    void *const arrays[] = {polylines->x, polylines->y, polylines->info, polylines->first_slots,
                            polylines->polyline_rows};
    for (size_t i = 0; !polylines->block && i < sizeof arrays / sizeof *arrays; i++)
        camber_free(context, arrays[i]);
    camber_free_spare(context, polylines->block);
    camber_free(context, polylines->arc_lengths);
    camber_free(context, polylines);
}

camber_polylines_stats camber_polylines_get_stats(const camber_polylines *polylines) {
    return polylines->stats;
}

size_t camber_polylines_find(const camber_polylines *polylines, size_t slot) {
    size_t low = 0, high = polylines->polyline_count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (polylines->first_slots[middle] <= slot)
            low = middle;
        else
            high = middle;
    }
    return low;
}
