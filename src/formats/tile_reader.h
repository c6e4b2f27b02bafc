/* Reads tiles of a set into features and joins their lines across the tiles' borders. */
#ifndef CAMBER_FORMATS_TILE_READER_H
#define CAMBER_FORMATS_TILE_READER_H

#include "archive/tile_set.h"
#include "features/reader.h"
#include "formats/mvt.h"

typedef struct camber_tile_reading {
    camber_tile_set *set;
    int zoom;
    const camber_tile_address *addresses;
    size_t address_count;
    camber_mvt_desc mvt; /* camber_features_read_tiles sets its stitcher */
} camber_tile_reading;

typedef struct camber_tile_result {
    camber_mvt_stats stats;
    size_t found; /* tiles that exist */
    size_t lost;  /* existing tiles that are damaged and give no features */
} camber_tile_result;

/* Adds features and their polylines, with features->source as their source. If this fails, the caller resets the set.
 */
camber_status camber_features_read_tiles(camber_features *features, const camber_tile_reading *reading,
                                         camber_tile_result *result);
/* Reads single files that contain all their tiles: MBTiles and PMTiles. It leaves requests with filters to GDAL, and
 * also folders, whose tiles GDAL opens one by one. */
extern const camber_reader camber_tile_file_reader;

#endif
