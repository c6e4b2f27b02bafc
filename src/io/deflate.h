/* DEFLATE in zlib's wrapper, and the CRC of PNG chunks. igzip compresses level 1, if the build has it. Otherwise, and
 * for other levels, whole blocks are compressed with libdeflate, or with zlib if the build lacks that, and streams with
 * zlib. */
#ifndef CAMBER_IO_DEFLATE_H
#define CAMBER_IO_DEFLATE_H

#include "base/base.h"

/* Compresses whole blocks, one after another. */
typedef struct camber_deflater camber_deflater;

/* level: 1 to 9. */
camber_status camber_deflater_create(camber_context *context, int level, camber_deflater **deflater);
/* Returns the most bytes to which a block of this size can be compressed. */
size_t camber_deflater_bound(camber_deflater *deflater, size_t size_bytes);
/* Returns how many bytes it wrote: at most camber_deflater_bound, for which `to` has room. */
size_t camber_deflater_compress(camber_deflater *deflater, const uint8_t *from, size_t size_bytes, uint8_t *to);
void camber_deflater_destroy(camber_deflater *deflater);

/* Compresses one block in pieces, with limited memory. sink receives the compressed bytes, up to 64 KB at a time. */
typedef struct camber_deflate_stream camber_deflate_stream;

camber_status camber_deflate_stream_create(camber_context *context, int level, camber_sink sink,
                                           camber_deflate_stream **stream);
/* Returns false if the sink refused the bytes. */
bool camber_deflate_stream_write(camber_deflate_stream *stream, const uint8_t *bytes, size_t size_bytes);
bool camber_deflate_stream_finish(camber_deflate_stream *stream);
void camber_deflate_stream_destroy(camber_deflate_stream *stream);

/* Continues from the CRC of the bytes before; 0 at the start. */
uint32_t camber_crc32(uint32_t crc, const void *bytes, size_t size_bytes);

#endif
