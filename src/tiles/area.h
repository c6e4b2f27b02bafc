/* The tiles that a run draws: the tiles in a box, in a region, or in a list. */
#ifndef CAMBER_TILES_AREA_H
#define CAMBER_TILES_AREA_H

#include "camber_tiles.h"
#include "map/view.h"

typedef struct camber_tiles_area {
    camber_context *context;
    int min_zoom, max_zoom;
    /* world coordinates; x1 is above 1 if it crosses the antimeridian. No tile outside it is drawn */
    camber_box box;
    camber_box bounds; /* the part of the box that has data. If nothing restricts the tiles, empty tiles inside the
                          bounds are kept */
    const camber_features *region; /* outlines of polygons. NULL: no region */
    camber_box region_box;
    uint64_t *tiles; /* tile_count numbers, ascending. NULL: no list */
    size_t tile_count;
} camber_tiles_area;

/* data: the box of everything that may be drawn; an empty box means nothing is drawn. After a failure,
 * camber_tiles_area_free must be called too. Returns CAMBER_ERROR_ARGUMENT, CAMBER_ERROR_MEMORY. */
camber_status camber_tiles_area_make(camber_context *context, const camber_tiles_draw_desc *desc, camber_box data,
                                     camber_tiles_area *area);
/* Removes from the list the tiles that are outside the zooms, or outside the bounds, in degrees (NULL: there are no
 * bounds). Returns how many it removed. */
size_t camber_tiles_area_keep(camber_tiles_area *area, int min_zoom, int max_zoom, const double bounds[4]);
/* Whether bounds, in degrees, overlap the data's box. */
bool camber_tiles_bounds_meet(const double bounds[4], camber_box data);
void camber_tiles_area_free(camber_tiles_area *area);
/* Returns which tiles of a metatile are wanted, as bits in the order of camber_metatile.tiles. */
uint64_t camber_tiles_area_pick(const camber_tiles_area *area, int zoom, uint32_t side, uint32_t column, uint32_t row);
/* Returns the tiles of a metatile that are kept even if they are empty: wanted ones within the bounds. */
uint64_t camber_tiles_area_pick_bounds(const camber_tiles_area *area, int zoom, uint32_t side, uint32_t column,
                                       uint32_t row);
/* The metatiles of a zoom that overlap the bounds: a rectangle, whose columns may extend beyond the world. */
typedef struct camber_metatile_range {
    int64_t first_column, last_column, first_row, last_row;
} camber_metatile_range;
camber_metatile_range camber_tiles_area_metatiles(const camber_tiles_area *area, int zoom, uint32_t side);
/* Extends the bounds to include a tile that a wide line reaches from inside them. */
void camber_tiles_area_meet(camber_tiles_area *area, int zoom, uint32_t column, uint32_t row);
/* Returns the bounds as west, south, east, north in degrees. */
void camber_tiles_area_bounds(const camber_tiles_area *area, double bounds[4]);

#endif
