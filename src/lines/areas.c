/* Makes polylines of areas: each ring closed, outer rings clockwise as seen and holes the other way.
 *
 * Input: rings of points in px, and which of them belong together. Output: polylines, a ring each, as
 * camber_polylines_create makes them. So windings of neighbours agree: where areas of one colour overlap they add up,
 * and a hole takes away what its own area gave. */
#include "lines/lines.h"

#include <assert.h>

static camber_status check_rings(camber_context *context, const camber_areas_desc *desc) {
    assert(desc->ring_count == 0 || desc->offsets);
    assert(desc->point_count == 0 || desc->points);
    size_t before = 0;
    for (size_t i = 0; desc->ring_count && i <= desc->ring_count; i++) {
        if (desc->offsets[i] < before || desc->offsets[i] > desc->point_count || (i == 0 && desc->offsets[0] != 0))
            return camber_fail(context, CAMBER_ERROR_INPUT,
                               "ring %zu: its offset %u does not lie between %zu and %zu; offsets must ascend from 0",
                               i, desc->offsets[i], before, desc->point_count);
        before = desc->offsets[i];
    }
    before = 0;
    for (size_t i = 0; desc->rings && i <= desc->area_count; i++) {
        if (desc->rings[i] < before || desc->rings[i] > desc->ring_count || (i == 0 && desc->rings[0] != 0) ||
            (i == desc->area_count && desc->rings[i] != desc->ring_count))
            return camber_fail(context, CAMBER_ERROR_INPUT,
                               "area %zu: its first ring %u does not lie between %zu and %zu; rings must ascend from 0 "
                               "to all of them",
                               i, desc->rings[i], before, desc->ring_count);
        before = desc->rings[i];
    }
    return CAMBER_OK;
}

/* Closed rings as they are written. */
typedef struct ring_writer {
    float *points;
    uint32_t *offsets, *rows;
    size_t point_count, ring_count;
} ring_writer;

/* Twice the area that the points [first, end) wind around clockwise as seen. */
static double signed_area(const float *points, size_t first, size_t end) {
    double area = 0.0;
    const float *a = points + 2 * (end - 1);
    for (size_t i = first; i < end; i++) {
        const float *b = points + 2 * i;
        area += (double)a[0] * (double)b[1] - (double)b[0] * (double)a[1];
        a = b;
    }
    return area;
}

static void turn_over(float *points, size_t first, size_t end) {
    for (; first + 1 < end; first++, end--)
        for (size_t k = 0; k < 2; k++) {
            const float kept = points[2 * first + k];
            points[2 * first + k] = points[2 * (end - 1) + k];
            points[2 * (end - 1) + k] = kept;
        }
}

/* Writes the valid points of a ring, and the first of them again. */
static void write_ring(ring_writer *w, const camber_areas_desc *desc, size_t ring, bool is_hole, uint32_t row) {
    const size_t first = w->point_count;
    w->offsets[w->ring_count] = (uint32_t)first;
    w->rows[w->ring_count++] = row;
    for (size_t i = desc->offsets[ring]; i < desc->offsets[ring + 1]; i++) {
        const float *point = desc->points + 2 * i;
        if (!camber_point_is_valid(point))
            continue;
        w->points[2 * w->point_count] = point[0];
        w->points[2 * w->point_count++ + 1] = point[1];
    }
    const size_t last = w->point_count - 1;
    const bool is_closed = w->point_count > first + 1 && w->points[2 * first] == w->points[2 * last] &&
                           w->points[2 * first + 1] == w->points[2 * last + 1];
    w->point_count -= is_closed;
    if (w->point_count == first)
        return;
    const double area = signed_area(w->points, first, w->point_count);
    if (is_hole ? area > 0.0 : area < 0.0)
        turn_over(w->points, first, w->point_count);
    w->points[2 * w->point_count] = w->points[2 * first];
    w->points[2 * w->point_count + 1] = w->points[2 * first + 1];
    w->point_count++;
}

static void write_areas(ring_writer *w, const camber_areas_desc *desc) {
    const size_t count = desc->rings ? desc->area_count : desc->ring_count;
    for (size_t i = 0; i < count; i++) {
        const size_t first = desc->rings ? desc->rings[i] : i, end = desc->rings ? desc->rings[i + 1] : i + 1;
        for (size_t ring = first; ring < end; ring++)
            write_ring(w, desc, ring, ring > first, desc->rows ? desc->rows[i] : 0);
    }
    w->offsets[w->ring_count] = (uint32_t)w->point_count;
}

camber_status camber_areas_create(camber_context *context, const camber_areas_desc *desc, camber_polylines **areas) {
    camber_status status = check_rings(context, desc);
    if (status != CAMBER_OK)
        return status;
    if (desc->point_count + desc->ring_count > UINT32_MAX)
        return camber_fail(context, CAMBER_ERROR_LIMIT, "%zu points in %zu rings are more than 32-bit offsets hold",
                           desc->point_count, desc->ring_count);
    ring_writer w = {
        .points = camber_alloc(context, desc->point_count + desc->ring_count, 2 * sizeof *w.points),
        .offsets = camber_alloc(context, desc->ring_count + 1, sizeof *w.offsets),
        .rows = camber_alloc(context, desc->ring_count, sizeof *w.rows),
    };
    status = w.points && w.offsets && w.rows ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK) {
        write_areas(&w, desc);
        const camber_polylines_desc rings = {.points = w.points,
                                             .point_count = w.point_count,
                                             .offsets = w.offsets,
                                             .polyline_count = w.ring_count,
                                             .rows = w.rows};
        status = camber_polylines_create(context, &rings, areas);
    }
    camber_free(context, w.rows);
    camber_free(context, w.offsets);
    camber_free(context, w.points);
    return status;
}
