/* gzip for answers. */
#ifndef CAMBER_SERVE_GZIP_H
#define CAMBER_SERVE_GZIP_H

#include "serve/tile_cache.h"

/* The same bytes, compressed. NULL: no memory, or they would hardly be fewer. */
camber_body *camber_body_gzip(const camber_body *body);
/* Bytes that are compressed, as they were. NULL: no memory, not gzip, or more than most_bytes. */
camber_body *camber_body_gunzip(const camber_body *body, size_t most_bytes);
/* Whether a request's Accept-Encoding, which may be NULL, takes gzip. */
bool camber_accepts_gzip(const char *accept_encoding);

#endif
