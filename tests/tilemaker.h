/* Vector tiles and sets of them, written for the tests: by the specifications, with nothing of the readers. */
#ifndef CAMBER_TESTS_TILEMAKER_H
#define CAMBER_TESTS_TILEMAKER_H

#include <sqlite3.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

typedef struct blob {
    unsigned char *bytes;
    size_t size, capacity;
} blob;

static inline void blob_put(blob *b, const void *bytes, size_t size) {
    if (b->size + size > b->capacity) {
        b->capacity = 2 * (b->size + size) + 64;
        b->bytes = realloc(b->bytes, b->capacity);
    }
    if (size)
        memcpy(b->bytes + b->size, bytes, size);
    b->size += size;
}

static inline void blob_free(blob *b) {
    free(b->bytes);
    *b = (blob){0};
}

static inline void put_varint(blob *b, uint64_t value) {
    do {
        const unsigned char byte = (unsigned char)((value & 127) | (value > 127 ? 128 : 0));
        blob_put(b, &byte, 1);
        value >>= 7;
    } while (value);
}

static inline void put_number(blob *b, unsigned field, uint64_t value) {
    put_varint(b, field << 3);
    put_varint(b, value);
}

static inline void put_bytes(blob *b, unsigned field, const void *bytes, size_t size) {
    put_varint(b, field << 3 | 2);
    put_varint(b, size);
    blob_put(b, bytes, size);
}

/* Takes the inner one. */
static inline void put_message(blob *b, unsigned field, blob *inner) {
    put_bytes(b, field, inner->bytes, inner->size);
    blob_free(inner);
}

static inline void put_packed(blob *b, unsigned field, const uint32_t *words, size_t count) {
    blob inner = {0};
    for (size_t i = 0; i < count; i++)
        put_varint(&inner, words[i]);
    put_message(b, field, &inner);
}

static inline uint32_t zigzag(int64_t value) {
    return (uint32_t)((uint64_t)value << 1 ^ (uint64_t)(value >> 63));
}

static inline size_t add_path(uint32_t *words, size_t at, const int *units, size_t count, bool ring, int cursor[2]) {
    for (size_t i = 0; i < count; i++) {
        if (i < 2)
            words[at++] = i == 0 ? 1 | 1 << 3 : (uint32_t)(2 | (count - 1) << 3);
        for (int axis = 0; axis < 2; axis++) {
            words[at++] = zigzag(units[2 * i + (size_t)axis] - cursor[axis]);
            cursor[axis] = units[2 * i + (size_t)axis];
        }
    }
    if (ring)
        words[at++] = 7 | 1 << 3;
    return at;
}

/* A feature of a line, or of a ring without its last point. id 0: none; tags: tag_words keys and values in turn. */
static inline void put_tagged(blob *layer, uint64_t id, const uint32_t *tags, size_t tag_words, bool ring,
                              const int *units, size_t count) {
    uint32_t words[512];
    int cursor[2] = {0, 0};
    blob feature = {0};
    if (id)
        put_number(&feature, 1, id);
    if (tag_words)
        put_packed(&feature, 2, tags, tag_words);
    put_number(&feature, 3, ring ? 3 : 2);
    put_packed(&feature, 4, words, add_path(words, 0, units, count, ring, cursor));
    put_message(layer, 2, &feature);
}

/* The same with one tag; below 0: none. */
static inline void put_feature(blob *layer, uint64_t id, int key, int value, bool ring, const int *units,
                               size_t count) {
    put_tagged(layer, id, (uint32_t[]){(uint32_t)key, (uint32_t)value}, key >= 0 ? 2 : 0, ring, units, count);
}

/* extent 0: none is written. */
static inline blob begin_layer(const char *name, unsigned extent) {
    blob layer = {0};
    put_number(&layer, 15, 2);
    put_bytes(&layer, 1, name, strlen(name));
    if (extent)
        put_number(&layer, 5, extent);
    return layer;
}

static inline void put_key(blob *layer, const char *key) {
    put_bytes(layer, 3, key, strlen(key));
}

static inline void put_text_value(blob *layer, const char *text) {
    blob value = {0};
    put_bytes(&value, 1, text, strlen(text));
    put_message(layer, 4, &value);
}

static inline void put_double_value(blob *layer, double number) {
    blob value = {0};
    put_varint(&value, 3 << 3 | 1);
    blob_put(&value, &number, 8);
    put_message(layer, 4, &value);
}

/* Takes the layer. */
static inline void put_layer(blob *tile, blob *layer) {
    put_message(tile, 3, layer);
}

static inline blob gzip_of(const blob *b) {
    z_stream stream = {0};
    blob out = {0};
    deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    out.capacity = deflateBound(&stream, b->size) + 64;
    out.bytes = malloc(out.capacity);
    stream.next_in = b->bytes;
    stream.avail_in = (uInt)b->size;
    stream.next_out = out.bytes;
    stream.avail_out = (uInt)out.capacity;
    deflate(&stream, Z_FINISH);
    out.size = stream.total_out;
    deflateEnd(&stream);
    return out;
}

static inline bool blob_write(const blob *b, const char *path) {
    FILE *file = fopen(path, "wb");
    const bool written = file && fwrite(b->bytes, 1, b->size, file) == b->size;
    return file && fclose(file) == 0 && written;
}

typedef struct made_tile {
    int zoom;
    uint32_t column, row; /* from the north-west */
    blob content;
} made_tile;

static inline bool write_mbtiles(const char *path, const made_tile *tiles, size_t count, const char *metadata_sql) {
    sqlite3 *db = NULL;
    sqlite3_stmt *insert = NULL;
    bool good = sqlite3_open(path, &db) == SQLITE_OK &&
                sqlite3_exec(db,
                             "CREATE TABLE metadata (name text, value text);"
                             "CREATE TABLE tiles (zoom_level integer, tile_column integer, tile_row integer, "
                             "tile_data blob);",
                             NULL, NULL, NULL) == SQLITE_OK &&
                (!metadata_sql || sqlite3_exec(db, metadata_sql, NULL, NULL, NULL) == SQLITE_OK) &&
                sqlite3_prepare_v2(db, "INSERT INTO tiles VALUES (?, ?, ?, ?)", -1, &insert, NULL) == SQLITE_OK;
    for (size_t i = 0; good && i < count; i++) {
        sqlite3_bind_int(insert, 1, tiles[i].zoom);
        sqlite3_bind_int64(insert, 2, tiles[i].column);
        sqlite3_bind_int64(insert, 3, (INT64_C(1) << tiles[i].zoom) - 1 - tiles[i].row);
        sqlite3_bind_blob(insert, 4, tiles[i].content.bytes, (int)tiles[i].content.size, SQLITE_STATIC);
        good = sqlite3_step(insert) == SQLITE_DONE;
        sqlite3_reset(insert);
    }
    sqlite3_finalize(insert);
    sqlite3_close(db);
    return good;
}

/* ---- PMTiles ---- */

typedef struct made_entry {
    uint64_t number, run, offset, size;
} made_entry;

static inline blob directory_of(const made_entry *entries, size_t count) {
    blob b = {0};
    put_varint(&b, count);
    for (size_t i = 0; i < count; i++)
        put_varint(&b, entries[i].number - (i ? entries[i - 1].number : 0));
    for (size_t i = 0; i < count; i++)
        put_varint(&b, entries[i].run);
    for (size_t i = 0; i < count; i++)
        put_varint(&b, entries[i].size);
    for (size_t i = 0; i < count; i++) {
        const bool follows = i && entries[i].offset == entries[i - 1].offset + entries[i - 1].size;
        put_varint(&b, follows ? 0 : entries[i].offset + 1);
    }
    return b;
}

typedef struct made_archive {
    blob root, metadata, leaves, tiles;                                    /* as they are kept */
    int directory_compression, tile_compression, type, min_zoom, max_zoom; /* 1: none, 2: gzip; type 1: vector */
    int32_t bounds[4];
} made_archive;

static inline void put_word(unsigned char *at, uint64_t value, int size) {
    for (int i = 0; i < size; i++)
        at[i] = (unsigned char)(value >> 8 * i);
}

static inline blob archive_of(const made_archive *a) {
    unsigned char head[127] = "PMTiles\3";
    blob b = {0};
    uint64_t at = 127;
    const blob *const parts[] = {&a->root, &a->metadata, &a->leaves, &a->tiles};
    for (int i = 0; i < 4; i++) {
        put_word(head + 8 + 16 * i, at, 8);
        put_word(head + 16 + 16 * i, parts[i]->size, 8);
        at += parts[i]->size;
    }
    head[96] = 1;
    head[97] = (unsigned char)a->directory_compression;
    head[98] = (unsigned char)a->tile_compression;
    head[99] = (unsigned char)a->type;
    head[100] = (unsigned char)a->min_zoom;
    head[101] = (unsigned char)a->max_zoom;
    for (int i = 0; i < 4; i++)
        put_word(head + 102 + 4 * i, (uint64_t)(uint32_t)a->bounds[i], 4);
    blob_put(&b, head, sizeof head);
    for (int i = 0; i < 4; i++)
        blob_put(&b, parts[i]->bytes, parts[i]->size);
    return b;
}

#endif
