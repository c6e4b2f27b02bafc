/* Which tiles of a zoom lines touch and areas cover, and which of them each metatile of tiles is drawn of. */
#ifndef CAMBER_TILES_CENSUS_H
#define CAMBER_TILES_CENSUS_H

#include "archive/tile_set.h"
#include "map/zoom_plan.h"
#include "tiles/workers.h"

/* A metatile is a square of tiles that is drawn as one picture: side x side of them, 8 at most. */
enum { CAMBER_METATILE_SIDE_MOST = 8 };

typedef struct camber_metatile {
    uint32_t column, row; /* in metatiles */
    uint64_t tiles;       /* bit side * row + column of each tile that a line touches, or that lies in an area */
    uint64_t points;      /* drawn points that lie in it, about */
    size_t first, end;    /* of the census's polylines */
} camber_metatile;

typedef struct camber_census {
    camber_context *context;
    int zoom;
    uint32_t side;
    camber_metatile *metatiles; /* metatile_count, along the Hilbert curve */
    size_t metatile_count;
    uint32_t *polylines; /* by metatile, ascending */
} camber_census;

/* The zoom whose tiles are metatiles of this one: side is a power of two. */
static inline int camber_metatile_level(int zoom, uint32_t side) {
    for (; side > 1; side /= 2)
        zoom--;
    return zoom;
}
/* Looks where the lines of a zoom lie; side divides the number of tiles, or is that number. Threads share the work.
 * camber_census_free frees also what a failure left. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_census_make(const camber_zoom_plan *plan, int zoom, uint32_t side, camber_workers *workers,
                                 camber_census *census);
void camber_census_free(camber_census *census);
/* NULL: no line touches the metatile. */
const camber_metatile *camber_census_find(const camber_census *census, uint32_t column, uint32_t row);

#endif
