/* Areas of mesh tiles: rings cut into tiles, and made triangles of by the tessellator of GLU. */
#ifndef CAMBER_TILES_MESH_AREA_H
#define CAMBER_TILES_MESH_AREA_H

#include "tiles/mesh_tile.h"

/* Looks for GLU, where the plan fills areas. Returns CAMBER_ERROR_DEVICE. */
camber_status camber_mesh_plan_find_glu(const camber_mesh_plan *plan);
/* Takes the rings that the style fills of some polylines, ascending. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_mesh_picture_take_rings(camber_mesh_picture *picture, const uint32_t *polylines,
                                             size_t polyline_count, const camber_view *window);
/* Makes the triangles of tile x, y, which was cut already. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT,
 * CAMBER_ERROR_DEVICE (GLU is not here). */
camber_status camber_mesh_tile_fill(const camber_mesh_picture *picture, uint32_t x, uint32_t y, camber_mesh_tile *tile);

#endif
