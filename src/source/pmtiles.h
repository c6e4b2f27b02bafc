/* The parts of a PMTiles file, for its reader and its tests. */
#ifndef CAMBER_SOURCE_PMTILES_H
#define CAMBER_SOURCE_PMTILES_H

#include "base/base.h"

typedef struct camber_pmtiles_entry {
    uint64_t number;     /* the number of its first tile */
    uint64_t run_length; /* how many tiles one after the other have these bytes; 0: a leaf directory */
    uint64_t offset, size;
} camber_pmtiles_entry;

/* The number of a tile: lower zooms come first, then the tile's position along the Hilbert curve. zoom: 0 to 31. */
uint64_t camber_pmtiles_number(int zoom, uint32_t column, uint32_t row);
/* Finds the tile at a position along the curve, counted from the first tile of its zoom. */
void camber_pmtiles_locate(uint64_t along, int zoom, uint32_t *column, uint32_t *row);

typedef struct camber_pmtiles_directory {
    camber_pmtiles_entry *entries; /* in ascending order; freed with camber_free */
    size_t count;
} camber_pmtiles_directory;

/* A directory, decompressed. Returns CAMBER_ERROR_INPUT with the cause in why, which is not logged;
 * CAMBER_ERROR_MEMORY. */
camber_status camber_pmtiles_parse(camber_context *context, const void *bytes, size_t size_bytes,
                                   camber_pmtiles_directory *parsed, const char **why);

#endif
