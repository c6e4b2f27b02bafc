/* DEFLATE with ISA-L, if the build has it, and a workaround for a fault in it. */
#include "io/igzip.h"

#ifdef CAMBER_ISAL

#include <assert.h>
#include <isa-l/igzip_lib.h>

enum {
    LEVEL = 1,
    ISAL_LEVEL = 2, /* files are 1 % smaller than on its level 1, in the same time */
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

/* At the first byte of a stream, igzip (2.30 to 2.32; igzip_icf_body_h1_gr_bt.asm, .write_first_byte) stores a hash of
 * its state's address in its table of matches, so the output would depend on that address. Therefore the first bytes
 * are passed separately, because the end of each input is compressed by another function, which does not have this
 * fault. */
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
    stream->next_in = (uint8_t *)(uintptr_t)input->bytes; /* igzip only reads it */
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

/* Huffman codes take at most nine bits per byte, and each block has a header. */
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
