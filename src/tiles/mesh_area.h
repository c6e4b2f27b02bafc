/* Areas of mesh tiles: rings are cut into tiles, and triangulated by GLU's tessellator. */
#ifndef CAMBER_TILES_MESH_AREA_H
#define CAMBER_TILES_MESH_AREA_H

#include "tiles/mesh_tile.h"

/* Checks that GLU is available, if the plan fills areas. Returns CAMBER_ERROR_DEVICE. */
camber_status camber_mesh_plan_find_glu(const camber_mesh_plan *plan);
/* Copies the rings of some polylines that the style fills. polylines are in ascending order. Returns
 * CAMBER_ERROR_MEMORY. */
camber_status camber_mesh_picture_take_rings(camber_mesh_picture *picture, const uint32_t *polylines,
                                             size_t polyline_count, const camber_view *window);
/* Triangulates tile x, y, which must have been cut before. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT,
 * CAMBER_ERROR_DEVICE (GLU is not available). */
camber_status camber_mesh_tile_fill(const camber_mesh_picture *picture, uint32_t x, uint32_t y, camber_mesh_tile *tile);

#endif
