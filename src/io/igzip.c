/* DEFLATE by ISA-L, where camber is built with it, and a way around its fault. */
#include "io/igzip.h"

#ifdef CAMBER_ISAL

#include <assert.h>
#include <isa-l/igzip_lib.h>

enum {
    LEVEL = 1,
    ISAL_LEVEL = 2, /* bytes fewer than its level 1 by a hundredth, in the same time */
    FIRST_BYTES = 8,
};

struct camber_igzip {
    struct isal_zstream stream;
    uint8_t tables[ISAL_DEF_LVL2_DEFAULT];
};

bool camber_igzip_has_level(int level) {
    return level == LEVEL;
}

void camber_igzip_begin(camber_igzip *igzip) {
    struct isal_zstream *stream = &igzip->stream;
    isal_deflate_init(stream);
    stream->level = ISAL_LEVEL;
    stream->level_buf = igzip->tables;
    stream->level_buf_size = sizeof igzip->tables;
    stream->gzip_flag = IGZIP_ZLIB;
}

camber_status camber_igzip_create(camber_context *context, camber_igzip **igzip) {
    *igzip = camber_alloc(context, 1, sizeof **igzip);
    if (!*igzip)
        return CAMBER_ERROR_MEMORY;
    camber_igzip_begin(*igzip);
    return CAMBER_OK;
}

/* At a stream's first byte igzip (2.30 to 2.32; igzip_icf_body_h1_gr_bt.asm, .write_first_byte) puts a hash of its
 * state's address into its table of matches: the bytes would depend on where the state lies. The first bytes are given
 * alone, because the end of what it is given is compressed by another of its functions, which has no such fault. */
static void compress_first(struct isal_zstream *stream) {
    const uint32_t rest = stream->avail_in - FIRST_BYTES;
    stream->avail_in = FIRST_BYTES;
    stream->flush = SYNC_FLUSH;
    isal_deflate(stream);
    stream->avail_in += rest;
    stream->flush = NO_FLUSH;
}

size_t camber_igzip_compress(camber_igzip *igzip, camber_uncompressed *input, bool last, uint8_t *to,
                             size_t room_bytes) {
    struct isal_zstream *stream = &igzip->stream;
    stream->next_in = (uint8_t *)(uintptr_t)input->bytes; /* which it only reads */
    stream->avail_in = (uint32_t)input->size_bytes;
    stream->next_out = to;
    stream->avail_out = (uint32_t)room_bytes;
    if (stream->total_in == 0 && stream->avail_in > FIRST_BYTES)
        compress_first(stream);
    assert(last || stream->total_in > 0);
    stream->end_of_stream = last;
    const int done = isal_deflate(stream);
    assert(done == COMP_OK);
    (void)done;
    *input = (camber_uncompressed){stream->next_in, stream->avail_in};
    return room_bytes - stream->avail_out;
}

/* Huffman's codes take nine bits a byte at most, and each block has a head. */
size_t camber_igzip_bound(size_t size_bytes) {
    return size_bytes + size_bytes / 8 + 4096;
}

#else

bool camber_igzip_has_level(int level) {
    (void)level;
    return false;
}

camber_status camber_igzip_create(camber_context *context, camber_igzip **igzip) {
    (void)context, (void)igzip;
    return CAMBER_OK;
}

void camber_igzip_begin(camber_igzip *igzip) {
    (void)igzip;
}

size_t camber_igzip_compress(camber_igzip *igzip, camber_uncompressed *input, bool last, uint8_t *to,
                             size_t room_bytes) {
    (void)igzip, (void)input, (void)last, (void)to, (void)room_bytes;
    return 0;
}

size_t camber_igzip_bound(size_t size_bytes) {
    return size_bytes;
}

#endif

void camber_igzip_destroy(camber_context *context, camber_igzip *igzip) {
    camber_free(context, igzip);
}
