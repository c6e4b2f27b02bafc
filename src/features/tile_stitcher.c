/* Creates stitchers, and adds the pieces of lines and rings to them. */
#include "features/tile_stitcher.h"
#include <math.h>
#include <string.h>

camber_status camber_tile_stitcher_create(camber_context *context, int zoom, camber_tile_stitcher **stitcher) {
    camber_tile_stitcher *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->units = ldexp(CAMBER_TILE_UNITS, zoom);
    made->grid = 1;
    *stitcher = made;
    return CAMBER_OK;
}

void camber_tile_stitcher_destroy(camber_tile_stitcher *stitcher) {
    if (!stitcher)
        return;
    camber_context *context = stitcher->context;
    camber_free(context, stitcher->scratch);
    camber_free(context, stitcher->slots);
    camber_free(context, stitcher->features);
    camber_free(context, stitcher->lines);
    camber_free(context, stitcher->points);
    camber_free(context, stitcher);
}

bool camber_tile_stitcher_add_point(camber_tile_stitcher *stitcher, const double *point) {
    if (!camber_grow(stitcher->context, &stitcher->points, &stitcher->point_capacity, stitcher->point_count + 1,
                     2 * sizeof *stitcher->points))
        return false;
    memcpy(stitcher->points + 2 * stitcher->point_count++, point, 2 * sizeof *point);
    return true;
}

camber_status camber_tile_stitcher_add_line(camber_tile_stitcher *stitcher, const camber_cut_line *line) {
    if (stitcher->line_count >= UINT32_MAX / 2 - 1)
        return camber_fail(stitcher->context, CAMBER_ERROR_LIMIT,
                           "more than 2147483646 pieces in tiles; select fewer with an attribute filter");
    if (!camber_grow(stitcher->context, &stitcher->lines, &stitcher->line_capacity, stitcher->line_count + 1,
                     sizeof *stitcher->lines))
        return CAMBER_ERROR_MEMORY;
    stitcher->lines[stitcher->line_count++] = *line;
    return CAMBER_OK;
}
