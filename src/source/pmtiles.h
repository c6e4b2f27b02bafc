/* What a PMTiles file is made of, for its reader and its tests. */
#ifndef CAMBER_PMTILES_H
#define CAMBER_PMTILES_H

#include "base/base.h"

typedef struct camber_pmtiles_entry {
    uint64_t number; /* of the first tile */
    uint64_t run;    /* tiles with these bytes, in a row; 0: a leaf directory */
    uint64_t offset, size;
} camber_pmtiles_entry;

/* The number of a tile: those of lower zooms come first, then its place along the Hilbert curve. zoom: 0 to 31. */
uint64_t camber_pmtiles_number(int zoom, uint32_t column, uint32_t row);
/* along: from the first of its zoom. */
void camber_pmtiles_place(uint64_t along, int zoom, uint32_t *column, uint32_t *row);

/* A directory, decompressed, to entries in ascending order; freed with camber_free. NULL, or why not. */
const char *camber_pmtiles_parse(camber_context *context, const void *bytes, size_t size_bytes,
                                 camber_pmtiles_entry **entries, size_t *count);

#endif
