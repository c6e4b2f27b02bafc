/* Compresses and decompresses bodies with zlib, and parses Accept-Encoding. */
#include "serve/gzip.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <zlib.h>

enum { GZIP_WINDOW = 15 + 16, ANY_WINDOW = 15 + 32, MEMORY_LEVEL = 8, LEAST_BYTES = 256 };

static camber_body *make(unsigned char *bytes, size_t size_bytes, const char *encoding) {
    camber_body *made = camber_body_create(bytes, size_bytes);
    if (made)
        made->encoding = encoding;
    free(bytes);
    return made;
}

camber_body *camber_body_gzip(const camber_body *body) {
    z_stream stream = {0};
    if (body->size_bytes < LEAST_BYTES || body->size_bytes > INT_MAX ||
        deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, GZIP_WINDOW, MEMORY_LEVEL, Z_DEFAULT_STRATEGY) != Z_OK)
        return NULL;
    const size_t room = body->size_bytes / 10 * 9; /* it must save at least a tenth */
    unsigned char *packed = malloc(room);
    stream.next_in = (unsigned char *)body->bytes;
    stream.avail_in = (uInt)body->size_bytes;
    stream.next_out = packed;
    stream.avail_out = (uInt)room;
    const bool done = packed && deflate(&stream, Z_FINISH) == Z_STREAM_END;
    const size_t size_bytes = stream.total_out;
    deflateEnd(&stream);
    if (done)
        return make(packed, size_bytes, "gzip");
    free(packed);
    return NULL;
}

camber_body *camber_body_gunzip(const camber_body *body, size_t most_bytes) {
    z_stream stream = {0};
    if (body->size_bytes > INT_MAX || inflateInit2(&stream, ANY_WINDOW) != Z_OK)
        return NULL;
    unsigned char *bytes = NULL;
    size_t room = 4 * body->size_bytes + LEAST_BYTES;
    int result = Z_BUF_ERROR;
    stream.next_in = (unsigned char *)body->bytes;
    stream.avail_in = (uInt)body->size_bytes;
    while (result == Z_OK || result == Z_BUF_ERROR) {
        room = room < most_bytes ? room : most_bytes;
        unsigned char *grown = room > stream.total_out && room <= INT_MAX ? realloc(bytes, room) : NULL;
        if (!grown)
            break;
        bytes = grown;
        stream.next_out = bytes + stream.total_out;
        stream.avail_out = (uInt)(room - stream.total_out);
        result = inflate(&stream, Z_FINISH);
        if (stream.avail_out > 0) /* the data is truncated, corrupt, or complete */
            break;
        room *= 2;
    }
    const size_t size_bytes = stream.total_out;
    inflateEnd(&stream);
    if (result == Z_STREAM_END)
        return make(bytes, size_bytes, NULL);
    free(bytes);
    return NULL;
}

bool camber_accepts_gzip(const char *accept_encoding) {
    static const char blanks[] = " \t";
    for (const char *at = accept_encoding; at && *at;) {
        at += strspn(at, " \t,");
        const size_t length = strcspn(at, ",");
        const size_t name = strcspn(at, ",; \t");
        if ((name == 4 && strncasecmp(at, "gzip", 4) == 0) || (name == 1 && *at == '*')) {
            const char *rest = at + name + strspn(at + name, blanks);
            rest += *rest == ';';
            rest += strspn(rest, blanks);
            /* A weight of 0 means that gzip is not accepted. */
            return !(strncasecmp(rest, "q=0", 3) == 0 && strspn(rest + 3, ".0") == strcspn(rest + 3, ", \t"));
        }
        at += length;
    }
    return false;
}
