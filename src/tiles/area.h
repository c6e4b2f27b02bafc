/* Which tiles a run is to draw: those of a box, of a region, or of a list. */
#ifndef CAMBER_TILES_AREA_H
#define CAMBER_TILES_AREA_H

#include "camber_tiles.h"
#include "map/view.h"

typedef struct camber_tiles_area {
    camber_context *context;
    int min_zoom, max_zoom;
    camber_box box;    /* world coordinates; x1 is above 1 where it crosses the antimeridian. No tile lies beyond */
    camber_box bounds; /* the part of it that has data; where nothing bounds the tiles, empty ones are kept in here */
    const camber_features *region; /* polygons' outlines. NULL: none */
    camber_box region_box;
    uint64_t *tiles; /* tile_count numbers, ascending. NULL: no list */
    size_t tile_count;
} camber_tiles_area;

/* data: the box of all that may be drawn; empty: nothing is.
 * camber_tiles_area_free frees also what a failure left. Returns CAMBER_ERROR_ARGUMENT, CAMBER_ERROR_MEMORY. */
camber_status camber_tiles_area_make(camber_context *context, const camber_tiles_draw_desc *desc, camber_box data,
                                     camber_tiles_area *area);
/* Leaves out tiles of the list outside of zooms and of bounds in degrees. NULL: there are no bounds. Returns how many.
 */
size_t camber_tiles_area_keep(camber_tiles_area *area, int min_zoom, int max_zoom, const double bounds[4]);
/* Whether bounds, in degrees, meet the data's box. */
bool camber_tiles_bounds_meet(const double bounds[4], camber_box data);
void camber_tiles_area_free(camber_tiles_area *area);
/* The tiles of a metatile that are wanted, as bits of camber_metatile. */
uint64_t camber_tiles_area_pick(const camber_tiles_area *area, int zoom, uint32_t side, uint32_t column, uint32_t row);
/* The tiles of a metatile that are kept where they are empty: wanted ones within the bounds. */
uint64_t camber_tiles_area_pick_bounds(const camber_tiles_area *area, int zoom, uint32_t side, uint32_t column,
                                       uint32_t row);
/* The metatiles of a zoom that the bounds have: a rectangle, whose columns may go beyond the world. */
typedef struct camber_metatile_range {
    int64_t first_column, last_column, first_row, last_row;
} camber_metatile_range;
camber_metatile_range camber_tiles_area_metatiles(const camber_tiles_area *area, int zoom, uint32_t side);
/* Grows the bounds so that they meet a tile, which a wide line reaches from inside. */
void camber_tiles_area_meet(camber_tiles_area *area, int zoom, uint32_t column, uint32_t row);
/* The bounds: west, south, east, north in degrees. */
void camber_tiles_area_bounds(const camber_tiles_area *area, double bounds[4]);

#endif
