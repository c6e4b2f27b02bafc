/* Makes polylines from areas: every ring closed, outer rings clockwise as seen, holes counter-clockwise.
 *
 * Input: rings of points in px, and which of them belong together. Output: one polyline per ring, as
 * camber_polylines_create makes them. Thus the winding numbers of neighbours agree: where areas of one colour overlap,
 * the numbers add up, and a hole subtracts what its own area added. */
#include "lines/lines.h"

#include <assert.h>

static camber_status check_rings(camber_context *context, const camber_areas_desc *desc) {
    assert(desc->ring_count == 0 || desc->offsets);
    assert(desc->point_count == 0 || desc->points);
    size_t before = 0;
    for (size_t i = 0; desc->ring_count && i <= desc->ring_count; i++) {
        if (desc->offsets[i] < before || desc->offsets[i] > desc->point_count || (i == 0 && desc->offsets[0] != 0))
            return camber_fail(context, CAMBER_ERROR_INPUT,
                               "ring %zu: its offset %u is not between %zu and %zu; offsets must ascend from 0", i,
                               desc->offsets[i], before, desc->point_count);
        before = desc->offsets[i];
    }
    before = 0;
    for (size_t i = 0; desc->rings && i <= desc->area_count; i++) {
        if (desc->rings[i] < before || desc->rings[i] > desc->ring_count || (i == 0 && desc->rings[0] != 0) ||
            (i == desc->area_count && desc->rings[i] != desc->ring_count))
            return camber_fail(context, CAMBER_ERROR_INPUT,
                               "area %zu: its first ring %u is not between %zu and %zu; rings must ascend from 0 "
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

static void put_areas(camber_polylines *made, const camber_areas_desc *desc) {
    const size_t count = desc->rings ? desc->area_count : desc->ring_count;
    for (size_t i = 0; i < count; i++) {
        const size_t first = desc->rings ? desc->rings[i] : i, end = desc->rings ? desc->rings[i + 1] : i + 1;
        for (size_t ring = first; ring < end; ring++) {
            const float *points = desc->points + 2 * (size_t)desc->offsets[ring];
            const size_t points_of_ring = desc->offsets[ring + 1] - desc->offsets[ring];
            camber_polylines_put_ring(made, ring, points, points_of_ring, ring > first, desc->rows ? desc->rows[i] : 0);
        }
    }
}

camber_status camber_areas_create(camber_context *context, const camber_areas_desc *desc, camber_polylines **areas) {
    camber_status status = check_rings(context, desc);
    if (status == CAMBER_OK)
        status = camber_polylines_begin(context, desc->point_count + 3 * desc->ring_count, desc->ring_count, areas);
    if (status == CAMBER_OK) {
        put_areas(*areas, desc);
        camber_polylines_end(*areas);
    }
    return status;
}
