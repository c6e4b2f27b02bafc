/* What a PMTiles file is made of, for its reader and its tests. */
#ifndef CAMBER_PMTILES_H
#define CAMBER_PMTILES_H

#include "base/base.h"

typedef struct camber_pmtiles_entry {
    uint64_t number;     /* of the first tile */
    uint64_t run_length; /* tiles with these bytes, in a row; 0: a leaf directory */
    uint64_t offset, size;
} camber_pmtiles_entry;

/* The number of a tile: those of lower zooms come first, then its place along the Hilbert curve. zoom: 0 to 31. */
uint64_t camber_pmtiles_number(int zoom, uint32_t column, uint32_t row);
/* along: from the first of its zoom. */
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
