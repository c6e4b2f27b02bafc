/* Gzip compression of answers. */
#ifndef CAMBER_SERVE_GZIP_H
#define CAMBER_SERVE_GZIP_H

#include "serve/tile_cache.h"

/* Returns a compressed copy. Returns NULL if there is no memory, or if it would hardly be smaller. */
camber_body *camber_body_gzip(const camber_body *body);
/* Returns a decompressed copy. Returns NULL if there is no memory, if the body is not gzip, or if the result would be
 * larger than most_bytes. */
camber_body *camber_body_gunzip(const camber_body *body, size_t most_bytes);
/* Whether a request's Accept-Encoding, which may be NULL, allows gzip. */
bool camber_accepts_gzip(const char *accept_encoding);

#endif
