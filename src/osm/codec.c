/* Decompresses blobs: always with zlib or libdeflate, and with liblz4, libzstd and liblzma if the build includes them.
 *
 * Input: compressed bytes. Output: uncompressed bytes, at most 32 MiB, the format's limit. A blob need not state its
 * uncompressed size; then the buffer is doubled until the bytes fit. A few bytes of zstd or LZMA can expand to 32 MiB,
 * and a file may contain millions of such blobs. Therefore a blob may decompress to at most 256 KiB or 1,100 times its
 * compressed size, whichever is more. DEFLATE cannot reach that ratio. */
#include "osm/codec.h"

#ifdef CAMBER_LIBDEFLATE
#include <libdeflate.h>
#else
#include <zlib.h>
#endif
#ifdef CAMBER_LZ4
#include <lz4.h>
#endif
#ifdef CAMBER_ZSTD
#include <zstd.h>
#include <zstd_errors.h>
#endif
#ifdef CAMBER_LZMA
#include <lzma.h>
#endif

enum { MOST_BYTES = 32 << 20, SMALL_BYTES = 256 << 10, MOST_RATIO = 1100, FIRST_RATIO = 4 };

typedef enum outcome {
    DONE = 0,
    FULL, /* the buffer is too small, if the library can tell */
    BROKEN,
    NO_MEMORY,
} outcome;

/* Compressed bytes, and a buffer for the uncompressed bytes; size becomes their number. */
typedef struct job {
    camber_osm_pass *pass;
    const uint8_t *from;
    size_t from_size;
    uint8_t *to;
    size_t room, size;
} job;

/* ---- Codecs ---- */

static outcome unpack_zlib(job *self) {
#ifdef CAMBER_LIBDEFLATE
    struct libdeflate_decompressor *inflater = libdeflate_alloc_decompressor();
    if (!inflater)
        return NO_MEMORY;
    const enum libdeflate_result result =
        libdeflate_zlib_decompress(inflater, self->from, self->from_size, self->to, self->room, &self->size);
    libdeflate_free_decompressor(inflater);
    return result == LIBDEFLATE_SUCCESS ? DONE : result == LIBDEFLATE_INSUFFICIENT_SPACE ? FULL : BROKEN;
#else
    z_stream stream = {.next_in = (Bytef *)(uintptr_t)self->from,
                       .avail_in = (uInt)self->from_size,
                       .next_out = self->to,
                       .avail_out = (uInt)self->room};
    if (inflateInit(&stream) != Z_OK)
        return NO_MEMORY;
    const int result = inflate(&stream, Z_FINISH);
    const bool full = result == Z_BUF_ERROR && stream.avail_out == 0;
    self->size = self->room - stream.avail_out;
    inflateEnd(&stream);
    return result == Z_STREAM_END ? DONE : result == Z_MEM_ERROR ? NO_MEMORY : full ? FULL : BROKEN;
#endif
}

#ifdef CAMBER_LZ4
/* LZ4 does not distinguish damage from a buffer that is too small. */
static outcome unpack_lz4(job *self) {
    const int size =
        LZ4_decompress_safe((const char *)self->from, (char *)self->to, (int)self->from_size, (int)self->room);
    self->size = size < 0 ? 0 : (size_t)size;
    return size < 0 ? FULL : DONE;
}
#endif

#ifdef CAMBER_ZSTD
static outcome unpack_zstd(job *self) {
    self->size = ZSTD_decompress(self->to, self->room, self->from, self->from_size);
    if (!ZSTD_isError(self->size))
        return DONE;
    switch (ZSTD_getErrorCode(self->size)) {
    case ZSTD_error_dstSize_tooSmall: return FULL;
    case ZSTD_error_memory_allocation: return NO_MEMORY;
    default: return BROKEN;
    }
}
#endif

#ifdef CAMBER_LZMA
static void *allocate(void *user, size_t count, size_t size) {
    return count <= SIZE_MAX / (size ? size : 1) ? camber_osm_allocate(user, count * size) : NULL;
}

static void release(void *user, void *block) {
    camber_osm_release(user, block);
}

/* Accepts xz files and bare LZMA streams. By default, xz makes dictionaries of at most 64 MiB. They are allocated by
 * the context. */
static outcome unpack_lzma(job *self) {
    static const uint64_t most_memory = UINT64_C(80) << 20;
    const lzma_allocator allocator = {.alloc = allocate, .free = release, .opaque = self->pass};
    lzma_stream stream = LZMA_STREAM_INIT;
    stream.allocator = &allocator;
    stream.next_in = self->from;
    stream.avail_in = self->from_size;
    stream.next_out = self->to;
    stream.avail_out = self->room;
    lzma_ret result = lzma_auto_decoder(&stream, most_memory, 0);
    while (result == LZMA_OK && (stream.avail_in || stream.avail_out))
        result = lzma_code(&stream, LZMA_FINISH);
    const bool full = stream.avail_out == 0 && (result == LZMA_OK || result == LZMA_BUF_ERROR);
    self->size = self->room - stream.avail_out;
    lzma_end(&stream);
    if (result == LZMA_STREAM_END || result == LZMA_MEM_ERROR)
        return result == LZMA_STREAM_END ? DONE : NO_MEMORY;
    return full ? FULL : BROKEN; /* or the stream needs a larger dictionary */
}
#endif

typedef struct codec_facts {
    camber_osm_codec codec;
    const char *name, *library;
    outcome (*unpack)(job *self); /* NULL: the library is not in this build */
} codec_facts;

static const codec_facts codecs[] = {
    {CAMBER_OSM_CODEC_ZLIB, "zlib", "zlib", unpack_zlib},
#ifdef CAMBER_LZ4
    {CAMBER_OSM_CODEC_LZ4, "lz4", "liblz4", unpack_lz4},
#else
    {CAMBER_OSM_CODEC_LZ4, "lz4", "liblz4", NULL},
#endif
#ifdef CAMBER_ZSTD
    {CAMBER_OSM_CODEC_ZSTD, "zstd", "libzstd", unpack_zstd},
#else
    {CAMBER_OSM_CODEC_ZSTD, "zstd", "libzstd", NULL},
#endif
#ifdef CAMBER_LZMA
    {CAMBER_OSM_CODEC_LZMA, "lzma", "liblzma", unpack_lzma},
#else
    {CAMBER_OSM_CODEC_LZMA, "lzma", "liblzma", NULL},
#endif
};

const char *camber_osm_codec_get_name(camber_osm_codec codec) {
    for (size_t i = 0; i < sizeof codecs / sizeof *codecs; i++)
        if (codecs[i].codec == codec)
            return codecs[i].name;
    return "";
}

/* ---- Blobs ---- */

static size_t most_bytes(size_t packed_bytes) {
    const size_t most = packed_bytes < MOST_BYTES / MOST_RATIO ? packed_bytes * MOST_RATIO : MOST_BYTES;
    return most > SMALL_BYTES ? most : SMALL_BYTES;
}

static bool fail_codec(camber_osm_codec codec, const codec_facts *facts, camber_osm_failure *failure) {
    if (facts)
        return camber_osm_refuse(
            failure,
            "compressed with %s, and this camber was built without %s; compress it again with osmium cat -f "
            "pbf,pbf_compression=zlib, or build camber with %s",
            facts->name, facts->library, facts->library);
    if (codec == CAMBER_OSM_CODEC_BZIP2)
        return camber_osm_refuse(failure,
                                 "compressed with bzip2, which PBF no longer allows; write it again with zlib");
    return camber_osm_fail(failure, "a blob that does not parse");
}

bool camber_osm_codec_unpack(camber_osm_codec codec, camber_osm_pass *pass, const camber_wire *packed,
                             uint64_t size_bytes, camber_osm_block *block, camber_wire *plain,
                             camber_osm_failure *failure) {
    job one = {.pass = pass, .from = packed->at, .from_size = (size_t)(packed->end - packed->at)};
    const codec_facts *facts = NULL;
    for (size_t i = 0; i < sizeof codecs / sizeof *codecs; i++)
        facts = codecs[i].codec == codec ? &codecs[i] : facts;
    if (!facts || !facts->unpack)
        return fail_codec(codec, facts, failure);
    const size_t most = most_bytes(one.from_size);
    if (size_bytes > most)
        return camber_osm_fail(failure, "a blob that would decompress to far more than its size");
    const size_t guess = FIRST_RATIO * one.from_size < SMALL_BYTES ? SMALL_BYTES : FIRST_RATIO * one.from_size;
    one.room = size_bytes ? (size_t)size_bytes : guess < most ? guess : most;
    for (outcome result = FULL; result != DONE; one.room = one.room < most / 2 ? 2 * one.room : most) {
        if (!camber_osm_reserve(pass, block, one.room + 1, failure))
            return false;
        one.to = block->bytes;
        result = facts->unpack(&one);
        if (result == NO_MEMORY) {
            failure->status = CAMBER_ERROR_MEMORY;
            return false;
        }
        if (result == BROKEN || (result == FULL && (size_bytes || one.room == most)) ||
            (result == DONE && size_bytes && one.size != size_bytes))
            return camber_osm_fail(failure, "a blob that cannot be decompressed");
    }
    *plain = (camber_wire){block->bytes, block->bytes + one.size, false};
    return true;
}
