/* Counts the tiles and contents of an archive, tile by tile. */
#ifndef CAMBER_ARCHIVE_TALLY_H
#define CAMBER_ARCHIVE_TALLY_H

#include "archive/archive.h"

/* The range of a content in PMTiles, or a tile in other formats. */
typedef struct camber_tally_place {
    uint64_t offset; /* PMTiles: the offset in the section of tiles. Otherwise 0 */
    uint64_t size_bytes, number;
} camber_tally_place;

typedef struct camber_tally {
    camber_context *context;
    uint64_t tiles, entries, contents;
    uint64_t zoom_tiles[CAMBER_LARGEST_TILE_ZOOM + 1], zoom_bytes[CAMBER_LARGEST_TILE_ZOOM + 1];
    camber_tally_place *places; /* sorted: in PMTiles, distinct ranges by offset and size; otherwise tiles by number */
    size_t place_count, place_capacity;
} camber_tally;

/* Counts a tile of a walk. Free the tally with camber_tally_free even if this fails. */
camber_status camber_tally_take(camber_tally *tally, const camber_archive_tile *tile);
/* Sorts the ranges, and counts contents and bytes. Call this after the walk. */
void camber_tally_sum(camber_tally *tally, camber_archive_format format);
void camber_tally_free(camber_tally *tally);

#endif
