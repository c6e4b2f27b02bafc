/* Lists the tiles that a view sees. */
#ifndef CAMBER_FORMATS_TILE_COVER_H
#define CAMBER_FORMATS_TILE_COVER_H

#include "formats/mvt.h"

/* The quadrangle of the world that a view sees: convex, with its corners in either direction, in world coordinates; x
 * may be outside 0 to 1. */
typedef struct camber_tile_cover {
    double zoom;
    double corners[8];
} camber_tile_cover;

/* Lists the tiles of a zoom that the quadrangle meets and that are within bounds (x0, y0, x1, y1; NULL: no bounds), row
 * by row from the north-west. A tile's side is open if the list does not have the neighbour at that side. Free
 * *addresses with camber_free. Returns CAMBER_ERROR_LIMIT (more than 65536), CAMBER_ERROR_MEMORY. */
camber_status camber_tile_cover_list(camber_context *context, const camber_tile_cover *cover, int zoom,
                                     const double *bounds, camber_tile_address **addresses, size_t *count);

#endif
