/* DEFLATE with igzip, libdeflate and zlib.
 *
 * igzip compresses the first level. For the other levels, libdeflate can only compress whole blocks, which cannot be
 * joined: the last block is marked by a bit whose position only decoding reveals. So pictures that are too large for
 * memory are streams, which zlib compresses on these levels. */
#include "io/deflate.h"
#include "io/igzip.h"

#ifdef CAMBER_LIBDEFLATE
#include <libdeflate.h>
#endif
#include <zlib.h>

enum { STREAM_BYTES = 1 << 16 };

static void *zlib_allocate(void *user, unsigned count, unsigned size_bytes) {
    return camber_resize_quietly(user, NULL, (size_t)count * size_bytes);
}

static void zlib_free(void *user, void *block) {
    camber_free(user, block);
}

static camber_status fail_memory(camber_context *context) {
    return camber_fail(context, CAMBER_ERROR_MEMORY, "out of memory for compression; write a smaller picture");
}

/* Fails only if there is no memory. */
static bool begin_zlib(camber_context *context, int level, z_stream *zlib) {
    *zlib = (z_stream){.zalloc = zlib_allocate, .zfree = zlib_free, .opaque = context};
    return deflateInit(zlib, level) == Z_OK;
}

/* See camber_igzip_compress. */
static size_t compress_zlib(z_stream *zlib, camber_uncompressed *input, bool last, uint8_t *to, size_t room_bytes) {
    zlib->next_in = (Bytef *)(uintptr_t)input->bytes; /* zlib only reads it */
    zlib->avail_in = (uInt)input->size_bytes;
    zlib->next_out = to;
    zlib->avail_out = (uInt)room_bytes;
    deflate(zlib, last ? Z_FINISH : Z_NO_FLUSH);
    *input = (camber_uncompressed){zlib->next_in, zlib->avail_in};
    return room_bytes - zlib->avail_out;
}

/* ---- Whole blocks ---- */

struct camber_deflater {
    camber_context *context;
    camber_igzip *igzip; /* NULL: one of the following is used */
#ifdef CAMBER_LIBDEFLATE
    struct libdeflate_compressor *compressor;
#else
    z_stream zlib;
#endif
};

#ifdef CAMBER_LIBDEFLATE

static bool begin_whole(camber_deflater *deflater, int level) {
    deflater->compressor = libdeflate_alloc_compressor(level);
    return deflater->compressor != NULL;
}

static void end_whole(camber_deflater *deflater) {
    libdeflate_free_compressor(deflater->compressor);
}

static size_t bound_whole(camber_deflater *deflater, size_t size_bytes) {
    return libdeflate_zlib_compress_bound(deflater->compressor, size_bytes);
}

static size_t compress_whole(camber_deflater *deflater, const uint8_t *from, size_t size_bytes, uint8_t *to) {
    return libdeflate_zlib_compress(deflater->compressor, from, size_bytes, to, bound_whole(deflater, size_bytes));
}

uint32_t camber_crc32(uint32_t crc, const void *bytes, size_t size_bytes) {
    return libdeflate_crc32(crc, bytes, size_bytes);
}

#else

static bool begin_whole(camber_deflater *deflater, int level) {
    return begin_zlib(deflater->context, level, &deflater->zlib);
}

static void end_whole(camber_deflater *deflater) {
    deflateEnd(&deflater->zlib);
}

static size_t bound_whole(camber_deflater *deflater, size_t size_bytes) {
    return deflateBound(&deflater->zlib, size_bytes);
}

static size_t compress_whole(camber_deflater *deflater, const uint8_t *from, size_t size_bytes, uint8_t *to) {
    camber_uncompressed input = {from, size_bytes};
    deflateReset(&deflater->zlib);
    return compress_zlib(&deflater->zlib, &input, true, to, bound_whole(deflater, size_bytes));
}

uint32_t camber_crc32(uint32_t crc, const void *bytes, size_t size_bytes) {
    return (uint32_t)crc32_z(crc, bytes, size_bytes);
}

#endif

camber_status camber_deflater_create(camber_context *context, int level, camber_deflater **deflater) {
    camber_deflater *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    camber_status status = CAMBER_OK;
    if (camber_igzip_has_level(level))
        status = camber_igzip_create(context, &made->igzip);
    else if (!begin_whole(made, level))
        status = fail_memory(context);
    if (status == CAMBER_OK)
        *deflater = made;
    else
        camber_free(context, made);
    return status;
}

void camber_deflater_destroy(camber_deflater *deflater) {
    if (!deflater)
        return;
    if (deflater->igzip)
        camber_igzip_destroy(deflater->context, deflater->igzip);
    else
        end_whole(deflater);
    camber_free(deflater->context, deflater);
}

size_t camber_deflater_bound(camber_deflater *deflater, size_t size_bytes) {
    return deflater->igzip ? camber_igzip_bound(size_bytes) : bound_whole(deflater, size_bytes);
}

size_t camber_deflater_compress(camber_deflater *deflater, const uint8_t *from, size_t size_bytes, uint8_t *to) {
    if (!deflater->igzip)
        return compress_whole(deflater, from, size_bytes, to);
    camber_uncompressed input = {from, size_bytes};
    camber_igzip_begin(deflater->igzip);
    return camber_igzip_compress(deflater->igzip, &input, true, to, camber_igzip_bound(size_bytes));
}

/* ---- Streams ---- */

struct camber_deflate_stream {
    camber_context *context;
    camber_sink sink;
    camber_igzip *igzip; /* NULL: zlib is used */
    z_stream zlib;
    uint8_t packed[STREAM_BYTES];
    size_t packed_bytes;
};

camber_status camber_deflate_stream_create(camber_context *context, int level, camber_sink sink,
                                           camber_deflate_stream **stream) {
    camber_deflate_stream *made = camber_alloc(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->sink = sink;
    made->igzip = NULL;
    made->packed_bytes = 0;
    camber_status status = CAMBER_OK;
    if (camber_igzip_has_level(level))
        status = camber_igzip_create(context, &made->igzip);
    else if (!begin_zlib(context, level, &made->zlib))
        status = fail_memory(context);
    if (status == CAMBER_OK)
        *stream = made;
    else
        camber_free(context, made);
    return status;
}

static bool give_packed(camber_deflate_stream *stream) {
    const size_t size_bytes = stream->packed_bytes;
    stream->packed_bytes = 0;
    return size_bytes == 0 || stream->sink.write(stream->sink.user, stream->packed, size_bytes);
}

/* Compresses all of the input. Passes the output to the sink whenever the buffer is full. */
static bool compress_all(camber_deflate_stream *stream, camber_uncompressed input, bool last) {
    for (;;) {
        uint8_t *to = stream->packed + stream->packed_bytes;
        const size_t room = STREAM_BYTES - stream->packed_bytes;
        stream->packed_bytes += stream->igzip ? camber_igzip_compress(stream->igzip, &input, last, to, room)
                                              : compress_zlib(&stream->zlib, &input, last, to, room);
        if (stream->packed_bytes < STREAM_BYTES)
            return true;
        if (!give_packed(stream))
            return false;
    }
}

bool camber_deflate_stream_write(camber_deflate_stream *stream, const uint8_t *bytes, size_t size_bytes) {
    return compress_all(stream, (camber_uncompressed){bytes, size_bytes}, false);
}

bool camber_deflate_stream_finish(camber_deflate_stream *stream) {
    return compress_all(stream, (camber_uncompressed){NULL, 0}, true) && give_packed(stream);
}

void camber_deflate_stream_destroy(camber_deflate_stream *stream) {
    if (!stream)
        return;
    if (stream->igzip)
        camber_igzip_destroy(stream->context, stream->igzip);
    else
        deflateEnd(&stream->zlib);
    camber_free(stream->context, stream);
}
