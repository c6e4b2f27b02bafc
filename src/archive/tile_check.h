/* Whether the bytes of a tile are what its type says. */
#ifndef CAMBER_ARCHIVE_TILE_CHECK_H
#define CAMBER_ARCHIVE_TILE_CHECK_H

#include "archive/archive.h"

/* Returns what is wrong with a tile's bytes, which are decompressed; NULL: nothing. Pictures give their size in px,
 * other types 0. */
const char *camber_tile_check(camber_tile_type type, const unsigned char *bytes, size_t size_bytes, uint32_t *width,
                              uint32_t *height);

/* The type that bytes look like as they are stored. OTHER: none that is known. What is compressed is a vector tile. */
camber_tile_type camber_tile_sniff(const unsigned char *bytes, size_t size_bytes);

#endif
