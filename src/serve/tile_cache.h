/* An LRU cache of the encoded tiles of one or more maps in memory, limited by size. Any thread may call these
 * functions. */
#ifndef CAMBER_SERVE_TILE_CACHE_H
#define CAMBER_SERVE_TILE_CACHE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CAMBER_ETAG_SIZE = 40 };

/* The constant bytes of an answer, with a reference count. */
typedef struct camber_body {
    atomic_uint holders;
    char etag[CAMBER_ETAG_SIZE]; /* a strong tag of the bytes, in quotes */
    const char *encoding;        /* Content-Encoding. NULL: none */
    size_t size_bytes;
    unsigned char bytes[];
} camber_body;

/* Copies the bytes and returns a body that the caller holds. Returns NULL if there is no memory. */
camber_body *camber_body_create(const void *bytes, size_t size_bytes);
camber_body *camber_body_hold(camber_body *body);
/* Releases one reference; the last one frees the body. body may be NULL. */
void camber_body_release(camber_body *body);

/* Identifies a tile. */
typedef struct camber_tile_key {
    uint64_t place; /* zoom << 56 | column << 28 | row */
    uint64_t look;  /* theme, ratio and type, as a number that the caller chooses */
    uint32_t map;   /* index of the map that it belongs to */
} camber_tile_key;

typedef struct camber_tile_cache camber_tile_cache;
typedef struct camber_tile_folder camber_tile_folder;

typedef struct camber_tile_cache_stats {
    uint64_t hits, misses, tiles, size_bytes;
    uint64_t folder_hits; /* misses in memory for which the folder had the tile */
} camber_tile_cache_stats;

/* most_bytes: limit for the bodies and the table's own memory. folder: also stores all tiles; it must outlive the
 * cache. NULL: none. Returns NULL if there is no memory. */
camber_tile_cache *camber_tile_cache_create(size_t most_bytes, uint32_t map_count, camber_tile_folder *folder);
void camber_tile_cache_destroy(camber_tile_cache *cache);
/* Returns the tile, which the caller then holds; NULL if it is not in the cache. */
camber_body *camber_tile_cache_get(camber_tile_cache *cache, camber_tile_key key);
/* Stores a tile, replacing one with the same key, and removes the least recently used tiles. A tile that is larger than
 * the cache, or for which there is no memory, is not stored. generation: its map's when drawing the tile began; tiles
 * of an earlier generation are not stored. */
void camber_tile_cache_put(camber_tile_cache *cache, camber_tile_key key, camber_body *body, uint64_t generation);
uint64_t camber_tile_cache_get_generation(camber_tile_cache *cache, uint32_t map);
/* Removes a map's tiles from memory, and starts its next generation. input: a hash of everything that the tiles are
 * drawn from, by which the folder finds them. 0: the folder is not used. */
void camber_tile_cache_clear(camber_tile_cache *cache, uint32_t map, uint64_t input);
camber_tile_cache_stats camber_tile_cache_get_stats(camber_tile_cache *cache);

#endif
