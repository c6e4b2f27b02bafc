/* Checks whether the bytes of a tile match its type. */
#ifndef CAMBER_ARCHIVE_TILE_CHECK_H
#define CAMBER_ARCHIVE_TILE_CHECK_H

#include "archive/archive.h"

/* Returns a description of a defect in a tile's decompressed bytes, or NULL if there is none. For pictures, sets the
 * size in px; for other types, sets it to 0. */
const char *camber_tile_check(camber_tile_type type, const unsigned char *bytes, size_t size_bytes, uint32_t *width,
                              uint32_t *height);

/* Returns the type that the stored bytes seem to have, or OTHER. Compressed bytes count as a vector tile. */
camber_tile_type camber_tile_sniff(const unsigned char *bytes, size_t size_bytes);

#endif
