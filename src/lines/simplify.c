/* Simplifies lines by the Douglas-Peucker method: one line in double coordinates, or a set of lines in px.
 *
 * Input: points and a tolerance in their unit. Output: the points that are kept, in order. A range of points is split
 * at the point that is farthest from the segment between its ends, until all points are within the tolerance. */
#include "lines/simplify.h"

#include "base/base.h"
#include "lines/farthest.h"
#include "lines/lines.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

typedef struct range {
    size_t first, last;
    unsigned depth;
} range;

/* Marks the points to keep strictly between the ends of a range. */
static void mark(const double *points, range whole, double tolerance_squared, unsigned char *keep) {
    /* This is a stack instead of a recursion. The larger half waits while the smaller half is split, so that at most
     * log2(count) ranges wait. */
    range waiting[64];
    size_t count = 0;
    range now = whole;
    for (;;) {
        double largest;
        size_t at = camber_farthest(points, now.first, now.last, &largest);
        if (largest <= tolerance_squared) {
            if (count == 0)
                return;
            now = waiting[--count];
            continue;
        }
        if (now.depth >= CAMBER_FARTHEST_SPLITS)
            at = now.first + (now.last - now.first) / 2;
        keep[at] = 1;
        const range a = {now.first, at, now.depth + 1}, b = {at, now.last, now.depth + 1};
        const bool a_larger = at - now.first > now.last - at;
        waiting[count++] = a_larger ? a : b;
        now = a_larger ? b : a;
    }
}

/* A ring begins and ends at the same point, so that the segment between its ends has no length. It is split first at
 * the point farthest from the seam. If no other point is kept, the point farthest from the line between these two
 * points is kept as well, so that an area remains an area, however small it is. */
static void mark_ring(const double *points, size_t count, double tolerance_squared, unsigned char *keep) {
    double largest;
    const size_t far = camber_farthest(points, 0, count - 1, &largest);
    if (far == 0)
        return; /* all points have the same position */
    keep[far] = 1;
    mark(points, (range){0, far, 0}, tolerance_squared, keep);
    mark(points, (range){far, count - 1, 0}, tolerance_squared, keep);
    for (size_t i = 1; i + 1 < count; i++)
        if (keep[i] && i != far)
            return;
    double before, after;
    const size_t a = camber_farthest(points, 0, far, &before), b = camber_farthest(points, far, count - 1, &after);
    if (before > 0.0 || after > 0.0)
        keep[before >= after ? a : b] = 1;
}

size_t camber_simplify(double *points, size_t count, double tolerance, unsigned char *keep) {
    if (count < 3 || !(tolerance > 0.0))
        return count;
    const double *last = points + 2 * (count - 1);
    memset(keep, 0, count);
    keep[0] = keep[count - 1] = 1;
    if (count > 3 && points[0] == last[0] && points[1] == last[1])
        mark_ring(points, count, tolerance * tolerance, keep);
    else
        mark(points, (range){0, count - 1, 0}, tolerance * tolerance, keep);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (!keep[i])
            continue;
        points[2 * kept] = points[2 * i];
        points[2 * kept + 1] = points[2 * i + 1];
        kept++;
    }
    return kept;
}

/* Simplifies valid points in double. Points that are kept are copied from their source, so that no bit changes. Returns
 * how many are kept. */
static size_t simplify_stretch(const float *from, size_t count, double tolerance_px, double *points,
                               unsigned char *keep, float *to) {
    for (size_t i = 0; i < 2 * count; i++)
        points[i] = (double)from[i];
    memset(keep, 1, count);
    camber_simplify(points, count, tolerance_px, keep);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (!keep[i])
            continue;
        memcpy(to + 2 * kept, from + 2 * i, 2 * sizeof *to);
        kept++;
    }
    return kept;
}

/* Simplifies one polyline. Invalid points split it into stretches. They are kept, so that cleaning counts them. */
static uint32_t simplify_line(const float *from, size_t count, double tolerance_px, double *points, unsigned char *keep,
                              float *to) {
    size_t kept = 0, first = 0;
    for (size_t i = 0; i <= count; i++) {
        if (i < count && camber_point_is_valid(from + 2 * i))
            continue;
        kept += simplify_stretch(from + 2 * first, i - first, tolerance_px, points, keep, to + 2 * kept);
        if (i < count) {
            memcpy(to + 2 * kept, from + 2 * i, 2 * sizeof *to);
            kept++;
        }
        first = i + 1;
    }
    return (uint32_t)kept;
}

camber_status camber_lines_simplify(camber_context *context, const camber_lines *lines, double tolerance_px,
                                    camber_lines *simplified) {
    if (!(tolerance_px >= 0.0))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "a tolerance of %g px; it must be 0 or more", tolerance_px);
    size_t longest = 0;
    for (size_t i = 0; i < lines->polyline_count; i++) {
        const size_t count = lines->offsets[i + 1] - lines->offsets[i];
        longest = count > longest ? count : longest;
    }
    camber_status status = CAMBER_ERROR_MEMORY;
    camber_lines made = {.context = context, .polyline_count = lines->polyline_count};
    double *points;
    unsigned char *keep = NULL;
    if (!(points = camber_alloc(context, longest, 2 * sizeof *points)) || !(keep = camber_alloc(context, longest, 1)) ||
        !(made.points = camber_alloc(context, lines->point_count, 2 * sizeof *made.points)) ||
        !(made.offsets = camber_alloc(context, lines->polyline_count + 1, sizeof *made.offsets)))
        goto done;
    made.offsets[0] = 0;
    for (size_t i = 0; i < lines->polyline_count; i++) {
        const size_t first = lines->offsets[i];
        made.point_count += simplify_line(lines->points + 2 * first, lines->offsets[i + 1] - first, tolerance_px,
                                          points, keep, made.points + 2 * made.point_count);
        made.offsets[i + 1] = (uint32_t)made.point_count;
    }
    *simplified = made;
    made = (camber_lines){0};
    status = CAMBER_OK;
done:
    camber_lines_destroy(&made);
    camber_free(context, keep);
    camber_free(context, points);
    return status;
}

void camber_lines_destroy(camber_lines *lines) {
    camber_context *context = lines->context;
    if (!context)
        return;
    camber_free(context, lines->entries);
    camber_free(context, lines->offsets);
    camber_free(context, lines->points);
    *lines = (camber_lines){0};
}
