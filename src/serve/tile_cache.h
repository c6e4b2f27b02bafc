/* Encoded tiles in memory, those that were asked for last, up to a number of bytes. Any thread may call. */
#ifndef CAMBER_SERVE_TILE_CACHE_H
#define CAMBER_SERVE_TILE_CACHE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CAMBER_ETAG_SIZE = 40 };

/* Bytes of an answer, which never change. Each that keeps them holds them. */
typedef struct camber_body {
    atomic_uint holders;
    char etag[CAMBER_ETAG_SIZE]; /* strong, in quotes: of the bytes */
    const char *encoding;        /* Content-Encoding. NULL: none */
    size_t size_bytes;
    unsigned char bytes[];
} camber_body;

/* Copies bytes; the caller holds the body. NULL: no memory. */
camber_body *camber_body_create(const void *bytes, size_t size_bytes);
camber_body *camber_body_hold(camber_body *body);
/* The last holder frees it. body may be NULL. */
void camber_body_release(camber_body *body);

/* The name of a tile. */
typedef struct camber_tile_key {
    uint64_t place; /* zoom << 56 | column << 28 | row */
    uint64_t look;  /* theme, ratio, type: the caller's number */
} camber_tile_key;

typedef struct camber_tile_cache camber_tile_cache;
typedef struct camber_tile_folder camber_tile_folder;

typedef struct camber_tile_cache_stats {
    uint64_t hits, misses, tiles, size_bytes;
    uint64_t folder_hits; /* of the misses, those that the folder had */
} camber_tile_cache_stats;

/* most_bytes: of bodies and what the table takes for them. folder: has all tiles that were put, too; it must outlive
 * the cache. NULL: none. Returns NULL where there is no memory. */
camber_tile_cache *camber_tile_cache_create(size_t most_bytes, camber_tile_folder *folder);
void camber_tile_cache_destroy(camber_tile_cache *cache);
/* The tile, which the caller then holds. NULL: it is not there. */
camber_body *camber_tile_cache_get(camber_tile_cache *cache, camber_tile_key key);
/* Keeps a tile in place of one of this key; those that were not asked for longest go. A tile that is larger than the
 * cache, or that there is no memory for, is not kept. generation: as it was when the tile began to be drawn; tiles of
 * an earlier one are not kept. */
void camber_tile_cache_put(camber_tile_cache *cache, camber_tile_key key, camber_body *body, uint64_t generation);
uint64_t camber_tile_cache_get_generation(camber_tile_cache *cache);
/* Forgets all tiles in memory, and begins the next generation. input: a hash of what its tiles are drawn of, by which
 * the folder knows them. 0: the folder has none of them. */
void camber_tile_cache_clear(camber_tile_cache *cache, uint64_t input);
camber_tile_cache_stats camber_tile_cache_get_stats(camber_tile_cache *cache);

#endif
