/* Triangles of the areas that a plan draws. */
#ifndef CAMBER_MAP_PLAN_AREAS_H
#define CAMBER_MAP_PLAN_AREAS_H

#include "map/plan.h"

/* Makes triangles of what the view sees, in drawing order. camber_area_data_destroy frees also what a failure left.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_DEVICE (GLU is not here). */
camber_status camber_plan_triangulate(const camber_features *features, const camber_plan *plan, const camber_view *view,
                                      double simplify_px, camber_area_data *areas);

#endif
