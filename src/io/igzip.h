/* DEFLATE in zlib's wrapper with ISA-L's igzip. It is much faster than any other library, but only one of its levels is
 * worth using. */
#ifndef CAMBER_IO_IGZIP_H
#define CAMBER_IO_IGZIP_H

#include "base/base.h"

typedef struct camber_igzip camber_igzip;

/* The bytes that are still to be compressed. */
typedef struct camber_uncompressed {
    const uint8_t *bytes;
    size_t size_bytes; /* less than 2^32 */
} camber_uncompressed;

/* Whether igzip is used for this level. false for all levels if the build lacks it. */
bool camber_igzip_has_level(int level);
/* Also begins the first block. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_igzip_create(camber_context *context, camber_igzip **igzip);
/* Begins another block. */
void camber_igzip_begin(camber_igzip *igzip);
/* Consumes input, up to all of it, and returns how many bytes it wrote. If it filled the room (less than 2^32), there
 * may be more to write, so call it again. last: no more input follows. If there are several inputs, the first must have
 * more than 8 bytes. */
size_t camber_igzip_compress(camber_igzip *igzip, camber_uncompressed *input, bool last, uint8_t *to,
                             size_t room_bytes);
/* Returns the most bytes to which a block of this size can be compressed. */
size_t camber_igzip_bound(size_t size_bytes);
void camber_igzip_destroy(camber_context *context, camber_igzip *igzip);

#endif
