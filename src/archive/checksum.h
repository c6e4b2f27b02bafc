/* A checksum of an archive's tiles. It detects damage after which each tile still looks valid for its type.
 *
 * It is the sum of the hashes of all distinct contents, so it does not depend on their order, on how many tiles share
 * them, or on the format. It covers the contents of tiles, but not which tile has which content; PMTiles has checksums
 * for its directories. */
#ifndef CAMBER_ARCHIVE_CHECKSUM_H
#define CAMBER_ARCHIVE_CHECKSUM_H

#include "base/base.h"

/* A checksum that is zeroed apart from its context is the checksum of no contents. */
typedef struct camber_checksum {
    camber_context *context;
    uint64_t *hashes; /* hashes of contents; a content may occur several times */
    size_t count, capacity;
} camber_checksum;

/* hash: camber_content_hash of the bytes as stored. Returns false if there is no memory. */
bool camber_checksum_add(camber_checksum *checksum, uint64_t hash);
/* Writes the sum as 16 hexadecimal digits, and removes the hashes that were added. */
void camber_checksum_write(camber_checksum *checksum, char text[17]);

#endif
