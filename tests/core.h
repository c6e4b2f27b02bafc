/* What the tests of the core share: a context that keeps its log, counts its blocks and can refuse them; folders that
 * go again; random numbers; devices. */
#ifndef CAMBER_TESTS_CORE_H
#define CAMBER_TESTS_CORE_H

#ifndef _XOPEN_SOURCE
#define _XOPEN_SOURCE 700 /* nftw */
#endif

#include "base/base.h"
#include "camber_proof.h"

#include <ftw.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

/* ---- A host: allocator and log of a context ---- */

typedef struct host {
    size_t live_blocks, calls; /* calls that asked for memory */
    size_t refuse_first;       /* from this call on, counted from 1; 0: never */
    size_t refuse_count;       /* so many calls */
    size_t errors, warnings;
    char last[4096]; /* error */
} host;

static inline void *host_reallocate(void *user, void *block, size_t size_bytes) {
    host *h = user;
    if (size_bytes == 0) {
        h->live_blocks -= block != NULL;
        free(block);
        return NULL;
    }
    h->calls++;
    if (h->refuse_first && h->calls >= h->refuse_first && h->calls - h->refuse_first < h->refuse_count)
        return NULL;
    void *moved = realloc(block, size_bytes);
    h->live_blocks += !block && moved;
    return moved;
}

static inline void host_log(void *user, camber_log_level level, const char *message) {
    host *h = user;
    assert_null(strchr(message, '\n'));
    assert_true(message[0] != 0);
    h->warnings += level == CAMBER_LOG_WARNING;
    if (level != CAMBER_LOG_ERROR)
        return;
    h->errors++;
    snprintf(h->last, sizeof h->last, "%s", message);
}

static inline camber_context_desc host_desc(host *h) {
    return (camber_context_desc){.reallocate = host_reallocate, .allocator_user = h, .log = host_log, .log_user = h};
}

static inline camber_context *host_context(host *h) {
    *h = (host){0};
    const camber_context_desc desc = host_desc(h);
    camber_context *context = NULL;
    assert_int_equal(camber_context_create(&desc, &context), CAMBER_OK);
    return context;
}

static inline void host_done(host *h, camber_context *context) {
    camber_context_destroy(context);
    assert_int_equal(h->live_blocks, 0);
}

/* A failure has told its story: one line, with a cure behind a semicolon where one is wanted. */
static inline void assert_story(host *h, const char *part) {
    assert_int_equal(h->errors, 1);
    if (part && !strstr(h->last, part))
        fail_msg("'%s' does not stand in: %s", part, h->last);
    h->errors = 0;
}

/* Calls attempt with the n-th allocation refused, once and from there on, for every n until it asks for no more: it
 * says CAMBER_ERROR_MEMORY in one line, or does without, and keeps nothing. attempt frees what it got when it
 * succeeds. */
static inline void each_allocation_fails(host *h, camber_status (*attempt)(camber_context *context, void *user),
                                         camber_context *context, void *user) {
    const size_t live = h->live_blocks;
    for (int forever = 0; forever < 2; forever++) {
        for (size_t n = 1;; n++) {
            assert_true(n < 10000);
            const size_t refused = h->refuse_first = h->calls + n;
            h->refuse_count = forever ? SIZE_MAX : 1;
            h->errors = 0;
            const camber_status status = attempt(context, user);
            h->refuse_first = 0;
            assert_int_equal(h->live_blocks, live);
            if (status != CAMBER_OK) {
                assert_int_equal(status, CAMBER_ERROR_MEMORY);
                assert_story(h, "memory");
                continue;
            }
            assert_int_equal(h->errors, 0);
            if (h->calls < refused) {
                assert_true(n > 1);
                break;
            }
        }
    }
}

/* ---- Folders ---- */

static inline int remove_one(const char *path, const struct stat *about, int type, struct FTW *where) {
    (void)about;
    (void)type;
    (void)where;
    return remove(path);
}

static inline void folder_make(char path[64]) {
    snprintf(path, 64, "/tmp/camber-test-XXXXXX");
    assert_non_null(mkdtemp(path));
}

static inline void folder_remove(const char *path) {
    nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

/* Of a test of compiling: PoCL's own cache apart from what others have compiled. */
static inline void pocl_cache_apart(char path[64]) {
    snprintf(path, 64, "/tmp/camber-test-XXXXXX");
    if (mkdtemp(path))
        setenv("POCL_CACHE_DIR", path, 1);
}

/* ---- Random numbers: xorshift64*, S. Vigna ---- */

static inline uint64_t random_bits(uint64_t *seed) {
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return *seed * 2685821657736338717ull >> 11; /* 53 bits */
}

static inline double random_between(uint64_t *seed, double least, double most) {
    return least + (most - least) * (double)random_bits(seed) * 0x1p-53;
}

static inline size_t random_below(uint64_t *seed, size_t bound) {
    return (size_t)(random_bits(seed) % bound);
}

/* ---- Devices ---- */

/* Whether any OpenCL device is there. Outside of cmocka's tests: main may leave with 77. */
static inline bool device_is_there(void) {
    camber_context *context = NULL;
    size_t count = 0;
    if (camber_context_create(NULL, &context) == CAMBER_OK)
        camber_device_list(context, 0, NULL, &count);
    camber_context_destroy(context);
    return count > 0;
}

/* Whether OpenCL is to draw what the test draws: its second run, with CAMBER_TEST_DRAW=cl. */
static inline bool draws_in_cl(void) {
    const char *wish = getenv("CAMBER_TEST_DRAW");
    return wish && strcmp(wish, "cl") == 0;
}

/* ---- Sinks ---- */

typedef struct byte_list {
    unsigned char *bytes;
    size_t size, capacity;
    size_t refuse_at; /* this many bytes are taken, no more. SIZE_MAX: all */
} byte_list;

static inline bool byte_list_write(void *user, const void *bytes, size_t size_bytes) {
    byte_list *list = user;
    if (size_bytes > list->refuse_at - list->size)
        return false;
    if (list->size + size_bytes > list->capacity) {
        list->capacity = 2 * (list->size + size_bytes);
        list->bytes = realloc(list->bytes, list->capacity);
        assert_non_null(list->bytes);
    }
    if (size_bytes)
        memcpy(list->bytes + list->size, bytes, size_bytes);
    list->size += size_bytes;
    return true;
}

#endif
