/* Contents: tiles with equal bytes share one content.
 *
 * A table finds a content by a 64-bit hash of its bytes; if hashes are equal, the bytes are compared. Contents are in
 * stores: store 0 is a file to which the writer appends, and the others are archives whose tiles are taken over
 * unchanged. */
#define _XOPEN_SOURCE 700 /* pread, pwrite */
#define _FILE_OFFSET_BITS 64

#include "archive/contents.h"
#include "archive/output_file.h"

#include <unistd.h>

enum { TAIL_BYTES = 1 << 20, FIRST_TABLE = 1024 };

/* ---- Hash ---- */

/* The hash is the same on every machine, because archives contain sums of hashes. */
static uint64_t load_word(const unsigned char *b) {
    const uint64_t low = (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
    const uint64_t high = (uint32_t)b[4] | (uint32_t)b[5] << 8 | (uint32_t)b[6] << 16 | (uint32_t)b[7] << 24;
    return low | high << 32;
}

/* There are four lanes, so that their multiplications overlap. */
uint64_t camber_content_hash(const void *bytes, size_t size_bytes) {
    const unsigned char *at = bytes;
    uint64_t lanes[4] = {size_bytes, 1, 2, 3};
    size_t left = size_bytes;
    for (; left >= 32; left -= 32, at += 32)
        for (size_t i = 0; i < 4; i++)
            lanes[i] = camber_mix(lanes[i], load_word(at + 8 * i));
    uint64_t hash = camber_mix(camber_mix(lanes[0], lanes[1]), camber_mix(lanes[2], lanes[3]));
    for (; left >= 8; left -= 8, at += 8)
        hash = camber_mix(hash, load_word(at));
    unsigned char rest[8] = {0};
    if (left)
        memcpy(rest, at, left);
    return camber_mix(camber_mix(hash, load_word(rest)), size_bytes);
}

/* ---- Stores ---- */

camber_status camber_contents_add_store(camber_contents *contents, int descriptor, uint64_t offset, const char *name,
                                        uint32_t *store) {
    char *copy = camber_copy_string(contents->context, name);
    if (!copy || !camber_grow(contents->context, &contents->stores, &contents->store_capacity,
                              contents->store_count + 1, sizeof *contents->stores)) {
        camber_free(contents->context, copy);
        return CAMBER_ERROR_MEMORY;
    }
    *store = (uint32_t)contents->store_count;
    contents->stores[contents->store_count++] = (camber_content_store){descriptor, offset, copy};
    return CAMBER_OK;
}

camber_status camber_contents_init(camber_contents *contents, camber_context *context, int descriptor,
                                   const char *name) {
    uint32_t own;
    *contents = (camber_contents){.context = context, .table_size = FIRST_TABLE};
    camber_status status = CAMBER_OK;
    if (!(contents->tail = camber_alloc(context, TAIL_BYTES, 1)) ||
        !(contents->table = camber_alloc_zero(context, contents->table_size, sizeof *contents->table)))
        status = CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        status = camber_contents_add_store(contents, descriptor, CAMBER_STORE_BEGIN, name, &own);
    if (status != CAMBER_OK)
        camber_contents_free(contents);
    return status;
}

void camber_contents_free(camber_contents *contents) {
    camber_context *context = contents->context;
    if (!context)
        return;
    for (size_t i = 0; i < contents->store_count; i++)
        camber_free(context, contents->stores[i].name);
    camber_free(context, contents->stores);
    camber_free(context, contents->items);
    camber_free(context, contents->table);
    camber_free(context, contents->tail);
    camber_free(context, contents->compared);
    *contents = (camber_contents){0};
}

camber_status camber_contents_flush(camber_contents *contents) {
    const camber_content_store *own = &contents->stores[0];
    const camber_status status = camber_write_at(contents->context, own->name, own->descriptor, contents->tail,
                                                 contents->tail_bytes, own->offset + contents->written_bytes);
    if (status != CAMBER_OK)
        return status;
    contents->written_bytes += contents->tail_bytes;
    contents->tail_bytes = 0;
    return CAMBER_OK;
}

static camber_status append(camber_contents *contents, const void *bytes, size_t size_bytes) {
    const camber_content_store *own = &contents->stores[0];
    camber_status status = CAMBER_OK;
    if (contents->tail_bytes + size_bytes > TAIL_BYTES)
        status = camber_contents_flush(contents);
    if (status != CAMBER_OK)
        return status;
    if (size_bytes <= TAIL_BYTES) {
        memcpy(contents->tail + contents->tail_bytes, bytes, size_bytes);
        contents->tail_bytes += size_bytes;
        return CAMBER_OK;
    }
    status = camber_write_at(contents->context, own->name, own->descriptor, bytes, size_bytes,
                             own->offset + contents->written_bytes);
    if (status == CAMBER_OK)
        contents->written_bytes += size_bytes;
    return status;
}

static camber_status read_file(camber_contents *contents, const camber_content_store *from, uint64_t offset,
                               unsigned char *bytes, size_t size_bytes) {
    size_t done;
    const int cause = camber_file_read(from->descriptor, bytes, size_bytes, from->offset + offset, &done);
    if (cause)
        return camber_file_fail(contents->context, from->name, cause);
    if (done < size_bytes)
        return camber_fail(contents->context, CAMBER_ERROR_INPUT,
                           "%s: was truncated while it was being read; get it again", from->name);
    return CAMBER_OK;
}

camber_status camber_contents_read(camber_contents *contents, uint32_t store, uint64_t offset, void *bytes,
                                   size_t size_bytes) {
    if (store == 0 && offset >= contents->written_bytes) {
        memcpy(bytes, contents->tail + (offset - contents->written_bytes), size_bytes);
        return CAMBER_OK;
    }
    return read_file(contents, &contents->stores[store], offset, bytes, size_bytes);
}

/* ---- Table ---- */

static size_t slot_of(const camber_contents *contents, uint64_t hash) {
    return (size_t)(hash ^ hash >> 32) & (contents->table_size - 1);
}

static void put_slot(camber_contents *contents, uint32_t index) {
    size_t slot = slot_of(contents, contents->items[index].hash);
    while (contents->table[slot])
        slot = (slot + 1) & (contents->table_size - 1);
    contents->table[slot] = index + 1;
}

static void index_all(camber_contents *contents) {
    for (size_t i = 0; i < contents->count; i++)
        put_slot(contents, (uint32_t)i);
}

static bool grow_table(camber_contents *contents) {
    if (contents->count < contents->table_size / 2)
        return true;
    const size_t size = 2 * contents->table_size;
    uint32_t *table = camber_alloc_zero(contents->context, size, sizeof *table);
    if (!table)
        return false;
    camber_free(contents->context, contents->table);
    contents->table = table;
    contents->table_size = size;
    index_all(contents);
    return true;
}

void camber_contents_cut(camber_contents *contents, uint64_t end) {
    size_t kept = contents->count;
    while (kept && contents->items[kept - 1].store == 0 && contents->items[kept - 1].offset >= end)
        kept--;
    contents->count = kept;
    contents->written_bytes = end;
    contents->tail_bytes = 0;
    memset(contents->table, 0, contents->table_size * sizeof *contents->table);
    index_all(contents);
}

static camber_status compare(camber_contents *contents, const camber_content *with, const void *bytes, bool *equal) {
    if (!camber_grow(contents->context, &contents->compared, &contents->compared_capacity, with->size_bytes, 1))
        return CAMBER_ERROR_MEMORY;
    const camber_status status =
        camber_contents_read(contents, with->store, with->offset, contents->compared, with->size_bytes);
    *equal = status == CAMBER_OK && memcmp(contents->compared, bytes, with->size_bytes) == 0;
    return status;
}

camber_status camber_contents_find(camber_contents *contents, const void *bytes, size_t size_bytes, uint64_t hash,
                                   uint32_t *index) {
    *index = CAMBER_NO_CONTENT;
    for (size_t slot = slot_of(contents, hash); contents->table[slot]; slot = (slot + 1) & (contents->table_size - 1)) {
        const camber_content *item = &contents->items[contents->table[slot] - 1];
        bool equal = false;
        if (item->hash != hash || item->size_bytes != size_bytes)
            continue;
        const camber_status status = compare(contents, item, bytes, &equal);
        if (status != CAMBER_OK)
            return status;
        if (equal) {
            *index = contents->table[slot] - 1;
            return CAMBER_OK;
        }
    }
    return CAMBER_OK;
}

camber_status camber_contents_note(camber_contents *contents, const camber_content *content, uint32_t *index) {
    if (contents->count >= CAMBER_NO_CONTENT - 1)
        return camber_fail(contents->context, CAMBER_ERROR_LIMIT,
                           "%s: more than 4,294,967,294 different tiles; write several archives",
                           contents->stores[0].name);
    if (!grow_table(contents) || !camber_grow(contents->context, &contents->items, &contents->capacity,
                                              contents->count + 1, sizeof *contents->items))
        return CAMBER_ERROR_MEMORY;
    *index = (uint32_t)contents->count;
    contents->items[contents->count++] = *content;
    put_slot(contents, *index);
    return CAMBER_OK;
}

camber_status camber_contents_put(camber_contents *contents, const void *bytes, size_t size_bytes, uint32_t *index) {
    const uint64_t hash = camber_content_hash(bytes, size_bytes);
    camber_status status = camber_contents_find(contents, bytes, size_bytes, hash, index);
    if (status != CAMBER_OK || *index != CAMBER_NO_CONTENT)
        return status;
    status = append(contents, bytes, size_bytes);
    if (status != CAMBER_OK)
        return status;
    const uint64_t end = contents->written_bytes + contents->tail_bytes;
    const camber_content made = {hash, end - size_bytes, (uint32_t)size_bytes, 0};
    return camber_contents_note(contents, &made, index);
}
