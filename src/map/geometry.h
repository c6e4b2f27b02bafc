/* The polylines of a plan in device pixels: projected, culled, simplified, clipped. */
#ifndef CAMBER_GEOMETRY_H
#define CAMBER_GEOMETRY_H

#include "map/plan.h"

typedef struct camber_geometry {
    camber_context *context;
    camber_lines lines; /* by set, and in input order in a set */
    size_t point_capacity, offset_capacity;
    uint32_t *rows; /* of the polylines */
    size_t row_capacity;
    size_t feature_count; /* of which something was kept, a set */
    size_t points_in;     /* of the polylines of which something was kept */
} camber_geometry;

/* Sets the polyline ranges of the plan's sets. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT.
 * camber_geometry_destroy frees also what a failure left. */
camber_status camber_geometry_create(const camber_features *features, const camber_view *view, double simplify_px,
                                     camber_plan *plan, camber_geometry *geometry);
void camber_geometry_destroy(camber_geometry *geometry);

#endif
