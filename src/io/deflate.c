/* DEFLATE by libdeflate and zlib.
 *
 * libdeflate compresses whole blocks alone, and its blocks cannot be joined: the last one is marked as such, at a bit
 * that only decoding finds. So pictures that are too large to hold are streams, and zlib's. */
#include "io/deflate.h"

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
    return camber_fail(context, CAMBER_ERROR_MEMORY, "compression: out of memory; write a smaller picture");
}

/* Fails for want of memory alone. */
static bool begin_zlib(camber_context *context, int level, z_stream *zlib) {
    *zlib = (z_stream){.zalloc = zlib_allocate, .zfree = zlib_free, .opaque = context};
    return deflateInit(zlib, level) == Z_OK;
}

/* ---- Whole blocks ---- */

struct camber_deflater {
    camber_context *context;
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

size_t camber_deflater_bound(camber_deflater *deflater, size_t size_bytes) {
    return libdeflate_zlib_compress_bound(deflater->compressor, size_bytes);
}

size_t camber_deflater_compress(camber_deflater *deflater, const uint8_t *from, size_t size_bytes, uint8_t *to) {
    return libdeflate_zlib_compress(deflater->compressor, from, size_bytes, to,
                                    camber_deflater_bound(deflater, size_bytes));
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

size_t camber_deflater_bound(camber_deflater *deflater, size_t size_bytes) {
    return deflateBound(&deflater->zlib, size_bytes);
}

size_t camber_deflater_compress(camber_deflater *deflater, const uint8_t *from, size_t size_bytes, uint8_t *to) {
    z_stream *zlib = &deflater->zlib;
    deflateReset(zlib);
    zlib->next_in = (Bytef *)(uintptr_t)from; /* which zlib only reads */
    zlib->avail_in = (uInt)size_bytes;
    zlib->next_out = to;
    zlib->avail_out = (uInt)deflateBound(zlib, size_bytes);
    deflate(zlib, Z_FINISH);
    return zlib->total_out;
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
    if (!begin_whole(made, level)) {
        camber_free(context, made);
        return fail_memory(context);
    }
    *deflater = made;
    return CAMBER_OK;
}

void camber_deflater_destroy(camber_deflater *deflater) {
    if (!deflater)
        return;
    end_whole(deflater);
    camber_free(deflater->context, deflater);
}

/* ---- Streams ---- */

struct camber_deflate_stream {
    camber_context *context;
    camber_sink sink;
    z_stream zlib;
    uint8_t packed[STREAM_BYTES];
};

camber_status camber_deflate_stream_create(camber_context *context, int level, camber_sink sink,
                                           camber_deflate_stream **stream) {
    camber_deflate_stream *made = camber_alloc(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->sink = sink;
    if (!begin_zlib(context, level, &made->zlib)) {
        camber_free(context, made);
        return fail_memory(context);
    }
    made->zlib.next_out = made->packed;
    made->zlib.avail_out = STREAM_BYTES;
    *stream = made;
    return CAMBER_OK;
}

static bool give_packed(camber_deflate_stream *stream) {
    const size_t size_bytes = STREAM_BYTES - stream->zlib.avail_out;
    stream->zlib.next_out = stream->packed;
    stream->zlib.avail_out = STREAM_BYTES;
    return size_bytes == 0 || stream->sink.write(stream->sink.user, stream->packed, size_bytes);
}

bool camber_deflate_stream_write(camber_deflate_stream *stream, const uint8_t *bytes, size_t size_bytes) {
    z_stream *zlib = &stream->zlib;
    zlib->next_in = (Bytef *)(uintptr_t)bytes; /* which zlib only reads */
    zlib->avail_in = (uInt)size_bytes;
    while (zlib->avail_in > 0) {
        deflate(zlib, Z_NO_FLUSH);
        if (zlib->avail_out == 0 && !give_packed(stream))
            return false;
    }
    return true;
}

bool camber_deflate_stream_finish(camber_deflate_stream *stream) {
    while (deflate(&stream->zlib, Z_FINISH) != Z_STREAM_END)
        if (!give_packed(stream))
            return false;
    return give_packed(stream);
}

void camber_deflate_stream_destroy(camber_deflate_stream *stream) {
    if (!stream)
        return;
    deflateEnd(&stream->zlib);
    camber_free(stream->context, stream);
}
