/* Finds the tiles of a zoom that lines touch and areas cover, and the polylines that each metatile is drawn from. */
#ifndef CAMBER_TILES_CENSUS_H
#define CAMBER_TILES_CENSUS_H

#include "archive/tile_set.h"
#include "map/zoom_plan.h"
#include "tiles/workers.h"

/* A metatile is a square of side x side tiles, 8 x 8 at most, that is drawn as one picture. */
enum { CAMBER_METATILE_SIDE_MOST = 8 };

typedef struct camber_metatile {
    uint32_t column, row; /* in metatiles */
    uint64_t tiles;    /* bit side * row + column is set for each tile that a line touches, or that is inside an area */
    uint64_t points;   /* about how many drawn points are in it */
    size_t first, end; /* range of the census's polylines */
} camber_metatile;

typedef struct camber_census {
    camber_context *context;
    int zoom;
    uint32_t side;
    camber_metatile *metatiles; /* metatile_count of them, along the Hilbert curve */
    size_t metatile_count;
    uint32_t *polylines; /* grouped by metatile, ascending within each */
} camber_census;

/* Returns the zoom whose tiles are the metatiles of this zoom. side is a power of two. */
static inline int camber_metatile_level(int zoom, uint32_t side) {
    for (; side > 1; side /= 2)
        zoom--;
    return zoom;
}
/* Finds where the lines of a zoom are. side divides the number of tiles along a side of the world, or equals it. The
 * workers' threads share the work. After a failure, camber_census_free must be called too. Returns
 * CAMBER_ERROR_MEMORY. */
camber_status camber_census_make(const camber_zoom_plan *plan, int zoom, uint32_t side, camber_workers *workers,
                                 camber_census *census);
void camber_census_free(camber_census *census);
/* Tiles of a metatile that something other than a line touches. */
typedef struct camber_touched_tiles {
    uint32_t column, row; /* in metatiles */
    uint64_t tiles;
} camber_touched_tiles;
/* Marks more tiles as touched. The metatiles are all different. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_census_touch(camber_census *census, const camber_touched_tiles *touched, size_t count);
/* Returns NULL if no line touches the metatile. */
const camber_metatile *camber_census_find(const camber_census *census, uint32_t column, uint32_t row);

#endif
