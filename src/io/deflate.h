/* DEFLATE in zlib's wrapper, and the CRC of chunks. Level 1 is igzip's. Other levels, and that one where igzip is
 * missing: whole blocks go through libdeflate, or through zlib where that is missing; streams through zlib. */
#ifndef CAMBER_IO_DEFLATE_H
#define CAMBER_IO_DEFLATE_H

#include "base/base.h"

/* Compresses one whole block after another. */
typedef struct camber_deflater camber_deflater;

/* level is 1 to 9. */
camber_status camber_deflater_create(camber_context *context, int level, camber_deflater **deflater);
/* The bytes that a block of this size comes to at most. */
size_t camber_deflater_bound(camber_deflater *deflater, size_t size_bytes);
/* Returns how many bytes it wrote, at most camber_deflater_bound, which `to` has room for. */
size_t camber_deflater_compress(camber_deflater *deflater, const uint8_t *from, size_t size_bytes, uint8_t *to);
void camber_deflater_destroy(camber_deflater *deflater);

/* Compresses one block in pieces, with bounded memory. sink takes the compressed bytes, up to 64 KB at once. */
typedef struct camber_deflate_stream camber_deflate_stream;

camber_status camber_deflate_stream_create(camber_context *context, int level, camber_sink sink,
                                           camber_deflate_stream **stream);
/* false: the sink refused. */
bool camber_deflate_stream_write(camber_deflate_stream *stream, const uint8_t *bytes, size_t size_bytes);
bool camber_deflate_stream_finish(camber_deflate_stream *stream);
void camber_deflate_stream_destroy(camber_deflate_stream *stream);

/* Goes on from the CRC of the bytes before; 0 at the beginning. */
uint32_t camber_crc32(uint32_t crc, const void *bytes, size_t size_bytes);

#endif
