/* A checksum of an archive's tiles, by which damage is found that leaves each tile what its type says.
 *
 * It is the sum of the hashes of all different contents: whatever their order, however often tiles have them, in any
 * format. Only what a tile has is told of, not which tile has it: PMTiles' directories have checksums of their own. */
#ifndef CAMBER_ARCHIVE_CHECKSUM_H
#define CAMBER_ARCHIVE_CHECKSUM_H

#include "base/base.h"

/* A zeroed checksum with a context is one of nothing. */
typedef struct camber_checksum {
    camber_context *context;
    uint64_t *hashes; /* of contents, also several times */
    size_t count, capacity;
} camber_checksum;

/* hash: camber_content_hash of what is stored. false: no memory. */
bool camber_checksum_add(camber_checksum *checksum, uint64_t hash);
/* Sums up, and forgets what was added. text: 16 hexadecimal digits. */
void camber_checksum_write(camber_checksum *checksum, char text[17]);

#endif
