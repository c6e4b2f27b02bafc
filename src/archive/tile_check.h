/* Checks whether the bytes of a tile match its type. */
#ifndef CAMBER_ARCHIVE_TILE_CHECK_H
#define CAMBER_ARCHIVE_TILE_CHECK_H

#include "archive/archive.h"

/* Returns what is wrong with a tile's decompressed bytes, or NULL. For pictures, sets the size in px; for other types
 * it is 0. */
const char *camber_tile_check(camber_tile_type type, const unsigned char *bytes, size_t size_bytes, uint32_t *width,
                              uint32_t *height);

/* Returns the type that the stored bytes look like, or OTHER. Compressed bytes are taken for a vector tile. */
camber_tile_type camber_tile_sniff(const unsigned char *bytes, size_t size_bytes);

#endif
