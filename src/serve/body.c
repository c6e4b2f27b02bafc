/* Bodies of answers, with reference counts and entity tags. */
#include "base/base.h"
#include "serve/tile_folder.h"
#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t hash_bytes(uint64_t hash, const unsigned char *bytes, size_t size) {
    uint64_t word = 0;
    for (; size >= sizeof word; size -= sizeof word, bytes += sizeof word) {
        memcpy(&word, bytes, sizeof word);
        hash = camber_mix(hash, word);
    }
    word = 0;
    if (size)
        memcpy(&word, bytes, size);
    return camber_mix(hash, word);
}

camber_body *camber_body_create(const void *bytes, size_t size_bytes) {
    camber_body *body = size_bytes < SIZE_MAX / 2 ? malloc(sizeof *body + size_bytes) : NULL;
    if (!body)
        return NULL;
    atomic_init(&body->holders, 1);
    body->encoding = NULL;
    body->size_bytes = size_bytes;
    if (size_bytes)
        memcpy(body->bytes, bytes, size_bytes);
    /* Two hashes with different start values: the chance that two different bodies have the same tag is about 2^-96. */
    const uint64_t first = camber_mix(CAMBER_HASH_START, size_bytes), second = camber_mix(~CAMBER_HASH_START, first);
    snprintf(body->etag, sizeof body->etag, "\"%016" PRIx64 "%08" PRIx32 "\"",
             hash_bytes(first, body->bytes, size_bytes), (uint32_t)(hash_bytes(second, body->bytes, size_bytes) >> 32));
    return body;
}

camber_body *camber_body_hold(camber_body *body) {
    atomic_fetch_add_explicit(&body->holders, 1, memory_order_relaxed);
    return body;
}

void camber_body_release(camber_body *body) {
    if (body && atomic_fetch_sub_explicit(&body->holders, 1, memory_order_acq_rel) == 1)
        free(body);
}
