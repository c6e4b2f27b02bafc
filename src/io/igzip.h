/* DEFLATE in zlib's wrapper by ISA-L's igzip, which is much faster than any other library, and has one level that is
 * worth it. */
#ifndef CAMBER_IO_IGZIP_H
#define CAMBER_IO_IGZIP_H

#include "base/base.h"

typedef struct camber_igzip camber_igzip;

/* Bytes that are left to compress. */
typedef struct camber_uncompressed {
    const uint8_t *bytes;
    size_t size_bytes; /* below 2^32 */
} camber_uncompressed;

/* Whether it compresses for this level. false for all levels where camber is built without it. */
bool camber_igzip_has_level(int level);
/* Begins a block, too. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_igzip_create(camber_context *context, camber_igzip **igzip);
/* Begins another block. */
void camber_igzip_begin(camber_igzip *igzip);
/* Takes of the input, up to all of it, and returns how many bytes it wrote. Where there was no more room (below 2^32)
 * there may be more to write: call it again. last: no input comes behind this. The first of several inputs has more
 * than 8 bytes. */
size_t camber_igzip_compress(camber_igzip *igzip, camber_uncompressed *input, bool last, uint8_t *to,
                             size_t room_bytes);
/* The bytes that a block of this size comes to at most. */
size_t camber_igzip_bound(size_t size_bytes);
void camber_igzip_destroy(camber_context *context, camber_igzip *igzip);

#endif
