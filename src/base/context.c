/* The context: the caller's allocator, log and progress callbacks, and the budget. Every allocation of the library is
 * made by camber_resize_quietly, which counts its size in the budget. Logging turns a message into one line and hands
 * it to the callback. */
#include "base/base.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *reallocate_libc(void *user, void *block, size_t size_bytes) {
    (void)user;
    if (size_bytes == 0) {
        free(block);
        return NULL;
    }
    return realloc(block, size_bytes);
}

static bool copy_text(camber_context *context, const char *text, const char **copy) {
    *copy = text ? camber_copy_string(context, text) : NULL;
    return !text || *copy;
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
    made->budget = full.budget ? full.budget : &made->own_budget;
    camber_budget_init(&made->own_budget, NULL);
    made->desc.cache_dir = made->desc.access.root = NULL;
    memset(made->desc.access.outputs, 0, sizeof made->desc.access.outputs);
    bool copied = true;
    for (size_t i = 0; i < sizeof full.access.outputs / sizeof *full.access.outputs; i++)
        copied = copied && copy_text(made, full.access.outputs[i], &made->desc.access.outputs[i]);
    if (!copied || !copy_text(made, full.cache_dir, &made->desc.cache_dir) ||
        !copy_text(made, full.access.root, &made->desc.access.root)) {
        camber_context_destroy(made);
        return CAMBER_ERROR_MEMORY;
    }
    *context = made;
    return CAMBER_OK;
}

void camber_context_destroy(camber_context *context) {
    if (!context)
        return;
    const camber_context_desc desc = context->desc;
    camber_free(context, context->spare);
    camber_free(context, context->devices);
    camber_free(context, (char *)(uintptr_t)desc.cache_dir);
    camber_free(context, (char *)(uintptr_t)desc.access.root);
    for (size_t i = 0; i < sizeof desc.access.outputs / sizeof *desc.access.outputs; i++)
        camber_free(context, (char *)(uintptr_t)desc.access.outputs[i]);
    desc.reallocate(desc.allocator_user, context, 0);
}

const char *camber_method_get_name(camber_method method) {
    switch (method) {
    case CAMBER_METHOD_STRIP: return "strip";
    case CAMBER_METHOD_KITE: return "kite";
    case CAMBER_METHOD_FAN: return "fan";
    }
    return "unknown";
}

const char *camber_status_get_name(camber_status status) {
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

/* Each block starts with its size, which is given back to the budget when the block is freed. The head has 16 bytes so
 * that the block keeps the allocator's alignment. */
enum { HEAD_BYTES = 16 };

/* The sizes of blocks that are kept for the next frame: smaller blocks are cheap to make, and larger ones are for more
 * than 5 million points. */
static const size_t LEAST_SPARE_BYTES = 256 << 10, MOST_SPARE_BYTES = 64 << 20;

static size_t size_of(const void *block) {
    size_t size_bytes = 0;
    if (block)
        memcpy(&size_bytes, (const char *)block - HEAD_BYTES, sizeof size_bytes);
    return size_bytes;
}

static void drop_spare(camber_context *context) {
    void *spare = context->spare;
    context->spare = NULL;
    camber_free(context, spare);
}

void *camber_resize_quietly(camber_context *context, void *block, size_t size_bytes) {
    const size_t before = size_of(block), more = size_bytes > before ? size_bytes - before : 0;
    bool allowed = size_bytes <= SIZE_MAX - HEAD_BYTES && camber_budget_take(context, more);
    if (!allowed && context->spare) {
        drop_spare(context);
        allowed = size_bytes <= SIZE_MAX - HEAD_BYTES && camber_budget_take(context, more);
    }
    if (!allowed)
        return NULL;
    char *head = block ? (char *)block - HEAD_BYTES : NULL;
    char *made = context->desc.reallocate(context->desc.allocator_user, head, HEAD_BYTES + size_bytes);
    if (!made) {
        camber_budget_give(context, more);
        return NULL;
    }
    camber_budget_give(context, before > size_bytes ? before - size_bytes : 0);
    memcpy(made, &size_bytes, sizeof size_bytes);
    return made + HEAD_BYTES;
}

static void *resize(camber_context *context, void *block, size_t count, size_t size_bytes) {
    const bool fits = count <= SIZE_MAX / (size_bytes ? size_bytes : 1);
    void *made = fits ? camber_resize_quietly(context, block, count * size_bytes) : NULL;
    if (!made && fits && !camber_budget_has(context, count * size_bytes - size_of(block)))
        camber_budget_fail(context, count * size_bytes - size_of(block));
    else if (!made)
        camber_log(context, CAMBER_LOG_ERROR,
                   "out of memory: %zu elements of %zu bytes; give it less data or more memory", count, size_bytes);
    return made;
}

void *camber_alloc(camber_context *context, size_t count, size_t size_bytes) {
    return resize(context, NULL, count ? count : 1, size_bytes);
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
    block = resize(context, block, wanted, size_bytes);
    if (!block)
        return false;
    memcpy(items, &block, sizeof block);
    *capacity = wanted;
    return true;
}

void camber_free(camber_context *context, void *block) {
    if (!block)
        return;
    camber_budget_give(context, size_of(block));
    context->desc.reallocate(context->desc.allocator_user, (char *)block - HEAD_BYTES, 0);
}

void *camber_alloc_spare(camber_context *context, size_t count, size_t size_bytes) {
    void *spare = context->spare;
    const bool fits = size_of(spare) / size_bytes >= count && size_of(spare) / size_bytes / 4 <= count;
    if (spare && !fits)
        drop_spare(context);
    if (!spare || !fits)
        return camber_alloc(context, count, size_bytes);
    context->spare = NULL;
    return spare;
}

void camber_free_spare(camber_context *context, void *block) {
    const size_t size_bytes = size_of(block);
    const bool is_kept = !context->spare && !context->budget->desc.memory_bytes && size_bytes >= LEAST_SPARE_BYTES &&
                         size_bytes <= MOST_SPARE_BYTES;
    if (is_kept)
        context->spare = block;
    else
        camber_free(context, block);
}

char *camber_copy_string(camber_context *context, const char *text) {
    const size_t size_bytes = strlen(text) + 1;
    char *copy = camber_alloc(context, size_bytes, 1);
    if (copy)
        memcpy(copy, text, size_bytes);
    return copy;
}
