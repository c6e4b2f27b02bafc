#include "base/base.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static void *reallocate_libc(void *user, void *block, size_t size_bytes) {
    (void)user;
    if (size_bytes == 0) {
        free(block);
        return NULL;
    }
    return realloc(block, size_bytes);
}

camber_status camber_context_create(const camber_context_desc *desc, camber_context **context) {
    const camber_context_desc zero = {0};
    camber_context_desc full = desc ? *desc : zero;
    if (!full.reallocate)
        full.reallocate = reallocate_libc;
    camber_context *made = full.reallocate(full.allocator_user, NULL, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    *made = (camber_context){.desc = full, .next_serial = 1};
    made->desc.cache_dir = NULL;
    if (full.cache_dir) {
        made->desc.cache_dir = camber_copy_string(made, full.cache_dir);
        if (!made->desc.cache_dir) {
            camber_context_destroy(made);
            return CAMBER_ERROR_MEMORY;
        }
    }
    *context = made;
    return CAMBER_OK;
}

void camber_context_destroy(camber_context *context) {
    if (!context)
        return;
    const camber_context_desc desc = context->desc;
    desc.reallocate(desc.allocator_user, (char *)(uintptr_t)desc.cache_dir, 0);
    desc.reallocate(desc.allocator_user, context, 0);
}

const char *camber_status_name(camber_status status) {
    switch (status) {
    case CAMBER_OK: return "ok";
    case CAMBER_ERROR_MEMORY: return "out of memory";
    case CAMBER_ERROR_ARGUMENT: return "bad argument";
    case CAMBER_ERROR_INPUT: return "bad input";
    case CAMBER_ERROR_NOT_FOUND: return "not found";
    case CAMBER_ERROR_DEVICE: return "no usable device";
    case CAMBER_ERROR_IO: return "input or output error";
    case CAMBER_ERROR_LIMIT: return "too large";
    }
    return "unknown status";
}

#define TEXT_OF(number) #number
#define TEXT(number) TEXT_OF(number)

const char *camber_version(void) {
    return TEXT(CAMBER_VERSION_MAJOR) "." TEXT(CAMBER_VERSION_MINOR) "." TEXT(CAMBER_VERSION_PATCH);
}

void *camber_alloc(camber_context *context, size_t count, size_t size_bytes) {
    void *block = NULL;
    const size_t elements = count ? count : 1;
    if (size_bytes <= SIZE_MAX / elements)
        block = context->desc.reallocate(context->desc.allocator_user, NULL, elements * size_bytes);
    if (!block)
        camber_log(context, CAMBER_LOG_ERROR,
                   "out of memory: %zu elements of %zu bytes; give it less data or more memory", count, size_bytes);
    return block;
}

void *camber_alloc_zero(camber_context *context, size_t count, size_t size_bytes) {
    void *block = camber_alloc(context, count, size_bytes);
    if (block)
        memset(block, 0, (count ? count : 1) * size_bytes);
    return block;
}

bool camber_grow(camber_context *context, void *items, size_t *capacity, size_t needed, size_t size_bytes) {
    if (needed <= *capacity)
        return true;
    size_t wanted = *capacity + *capacity / 2;
    if (wanted < needed)
        wanted = needed;
    if (wanted < 16)
        wanted = 16;
    void *block;
    memcpy(&block, items, sizeof block);
    if (wanted <= SIZE_MAX / size_bytes)
        block = context->desc.reallocate(context->desc.allocator_user, block, wanted * size_bytes);
    else
        block = NULL;
    if (!block) {
        camber_log(context, CAMBER_LOG_ERROR,
                   "out of memory: %zu elements of %zu bytes; give it less data or more memory", wanted, size_bytes);
        return false;
    }
    memcpy(items, &block, sizeof block);
    *capacity = wanted;
    return true;
}

void camber_free(camber_context *context, void *block) {
    if (block)
        context->desc.reallocate(context->desc.allocator_user, block, 0);
}

char *camber_copy_string(camber_context *context, const char *text) {
    const size_t size_bytes = strlen(text) + 1;
    char *copy = camber_alloc(context, size_bytes, 1);
    if (copy)
        memcpy(copy, text, size_bytes);
    return copy;
}

static void log_list(camber_context *context, camber_log_level level, const char *format, va_list list) {
    if (!context->desc.log)
        return;
    /* Long enough for any path and cause; a build log is cut, its beginning names the error. */
    char message[4096];
    vsnprintf(message, sizeof message, format, list);
    /* Text of a file may stand in it: one line, and nothing that a terminal obeys. */
    for (char *c = message; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f)
            *c = ' ';
    context->desc.log(context->desc.log_user, level, message);
}

void camber_log(camber_context *context, camber_log_level level, const char *format, ...) {
    va_list list;
    va_start(list, format);
    log_list(context, level, format, list);
    va_end(list);
}

camber_status camber_fail(camber_context *context, camber_status status, const char *format, ...) {
    va_list list;
    va_start(list, format);
    log_list(context, CAMBER_LOG_ERROR, format, list);
    va_end(list);
    return status;
}

static void log_softly(void *user, camber_log_level level, const char *message) {
    const camber_soft_log *kept = user;
    kept->log(kept->user, level == CAMBER_LOG_ERROR ? CAMBER_LOG_INFO : level, message);
}

void camber_log_soften(camber_context *context, camber_soft_log *kept) {
    *kept = (camber_soft_log){context->desc.log, context->desc.log_user};
    if (!kept->log)
        return;
    context->desc.log = log_softly;
    context->desc.log_user = kept;
}

void camber_log_restore(camber_context *context, const camber_soft_log *kept) {
    context->desc.log = kept->log;
    context->desc.log_user = kept->user;
}

void camber_progress(camber_context *context, const char *stage, double fraction) {
    if (context->desc.progress)
        context->desc.progress(context->desc.progress_user, stage, fraction);
}

double camber_now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}
