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
    for (size_t i = 0; desc->rows && i < (desc->rings ? desc->area_count : desc->ring_count); i++)
        if (desc->rows[i] >= 1u << 24)
            return camber_fail(context, CAMBER_ERROR_INPUT, "area %zu: its row %u is not below %u; merge equal rows", i,
                               desc->rows[i], 1u << 24);
    if (desc->point_count > UINT32_MAX - 3 * (uint64_t)desc->ring_count - 1024u || desc->ring_count > UINT32_MAX / 4)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "%zu points in %zu rings are more than 32-bit slots hold; draw them in parts",
                           desc->point_count, desc->ring_count);
    return CAMBER_OK;
}

/* Rings as they are put. */
typedef struct ring_writer {
    camber_polylines *made;
    size_t ring_count;
    float *points; /* room for any ring, closed */
} ring_writer;

/* Twice the area that points wind around clockwise as seen. Four sums, as each addition waits for the one before. */
static double signed_area(const float *points, size_t count) {
    double areas[4] = {0.0};
    const float *a = points + 2 * (count - 1);
    for (size_t i = 0; i < count; i++) {
        const float *b = points + 2 * i;
        areas[i % 4] += (double)a[0] * (double)b[1] - (double)b[0] * (double)a[1];
        a = b;
    }
    return (areas[0] + areas[1]) + (areas[2] + areas[3]);
}

/* Whether a ring runs the other way than it should. */
static bool is_turned(const float *points, size_t count, bool is_hole) {
    const double area = count ? signed_area(points, count) : 0.0;
    return is_hole ? area > 0.0 : area < 0.0;
}

/* Without the last point where it is the first again. */
static size_t count_open(const float *points, size_t count) {
    if (count < 2)
        return count;
    const float *last = points + 2 * (count - 1);
    return count - (points[0] == last[0] && points[1] == last[1]);
}

static void turn_over(float *points, size_t count) {
    for (size_t first = 0, end = count; first + 1 < end; first++, end--)
        for (size_t k = 0; k < 2; k++) {
            const float kept = points[2 * first + k];
            points[2 * first + k] = points[2 * (end - 1) + k];
            points[2 * (end - 1) + k] = kept;
        }
}

/* Puts the valid points of a ring, and the first of them again. */
static void put_valid(ring_writer *w, const float *points, size_t count, bool is_hole, uint32_t row) {
    size_t valid = 0;
    for (size_t i = 0; i < count; i++) {
        if (!camber_point_is_valid(points + 2 * i))
            continue;
        w->points[2 * valid] = points[2 * i];
        w->points[2 * valid++ + 1] = points[2 * i + 1];
    }
    valid = count_open(w->points, valid);
    if (is_turned(w->points, valid, is_hole))
        turn_over(w->points, valid);
    w->points[2 * valid] = w->points[0];
    w->points[2 * valid + 1] = w->points[1];
    camber_polylines_put_closed(w->made, w->ring_count, w->points, valid ? valid + 1 : 0, row);
}

static void put_ring(ring_writer *w, const camber_areas_desc *desc, size_t ring, bool is_hole, uint32_t row) {
    const float *points = desc->points + 2 * (size_t)desc->offsets[ring];
    const size_t count = desc->offsets[ring + 1] - desc->offsets[ring], open = count_open(points, count);
    const bool turned = is_turned(points, open, is_hole);
    if (!camber_polylines_put_ring(w->made, w->ring_count, points, open, turned, row))
        put_valid(w, points, count, is_hole, row);
    w->ring_count++;
}

static void put_areas(ring_writer *w, const camber_areas_desc *desc) {
    const size_t count = desc->rings ? desc->area_count : desc->ring_count;
    for (size_t i = 0; i < count; i++) {
        const size_t first = desc->rings ? desc->rings[i] : i, end = desc->rings ? desc->rings[i + 1] : i + 1;
        for (size_t ring = first; ring < end; ring++)
            put_ring(w, desc, ring, ring > first, desc->rows ? desc->rows[i] : 0);
    }
}

static size_t longest_ring(const camber_areas_desc *desc) {
    size_t most = 0;
    for (size_t i = 0; i < desc->ring_count; i++)
        most = desc->offsets[i + 1] - desc->offsets[i] > most ? desc->offsets[i + 1] - desc->offsets[i] : most;
    return most;
}

camber_status camber_areas_create(camber_context *context, const camber_areas_desc *desc, camber_polylines **areas) {
    camber_status status = check_rings(context, desc);
    if (status != CAMBER_OK)
        return status;
    ring_writer w = {.points = camber_alloc(context, longest_ring(desc) + 1, 2 * sizeof *w.points)};
    status = w.points
                 ? camber_polylines_begin(context, desc->point_count + 3 * desc->ring_count, desc->ring_count, &w.made)
                 : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK) {
        put_areas(&w, desc);
        camber_polylines_end(w.made);
        *areas = w.made;
    }
    camber_free(context, w.points);
    return status;
}
