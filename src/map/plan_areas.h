/* Triangles of the areas that a plan draws. */
#ifndef CAMBER_MAP_PLAN_AREAS_H
#define CAMBER_MAP_PLAN_AREAS_H

#include "map/plan.h"

/* Makes triangles from the areas that the view sees, in drawing order. Call camber_area_data_destroy even after a
 * failure. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_DEVICE (GLU is not installed). */
camber_status camber_plan_triangulate(const camber_features *features, const camber_plan *plan, const camber_view *view,
                                      double simplify_px, camber_area_data *areas);

#endif
