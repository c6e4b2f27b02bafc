/* An LRU cache of encoded tiles: a hash table finds a tile, and a list keeps the tiles in the order of their last use.
 *
 *     newest <-> ... <-> oldest        tiles that do not fit are removed from the right end
 *
 * Buckets are chains. Their number doubles when there are more tiles than buckets. */
#include "serve/tile_folder.h"

#include "base/base.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_BUCKETS = 1024 };

/* ---- The cache ---- */

typedef struct cached_tile {
    camber_tile_key key;
    camber_body *body;
    struct cached_tile *next;          /* in its bucket */
    struct cached_tile *newer, *older; /* by last use */
} cached_tile;

struct camber_tile_cache {
    pthread_mutex_t mutex;
    cached_tile **buckets; /* bucket_count of them, a power of two */
    size_t bucket_count, most_bytes;
    cached_tile *newest, *oldest;
    struct {
        uint64_t generation, input;
    } * maps; /* by the index of the map */
    camber_tile_folder *folder;
    camber_tile_cache_stats stats;
};

static size_t bucket_of(const camber_tile_cache *cache, camber_tile_key key) {
    return (size_t)camber_mix(camber_mix(key.map, key.place), key.look) & (cache->bucket_count - 1);
}

static size_t cost_of(const camber_body *body) {
    return sizeof(cached_tile) + 2 * sizeof(cached_tile *) + sizeof *body + body->size_bytes;
}

camber_tile_cache *camber_tile_cache_create(size_t most_bytes, uint32_t map_count, camber_tile_folder *folder) {
    camber_tile_cache *cache = calloc(1, sizeof *cache);
    if (!cache || !(cache->buckets = calloc(FIRST_BUCKETS, sizeof(cached_tile *))) ||
        !(cache->maps = calloc(map_count, sizeof *cache->maps))) {
        free(cache ? cache->buckets : NULL);
        free(cache);
        return NULL;
    }
    cache->bucket_count = FIRST_BUCKETS;
    cache->most_bytes = most_bytes;
    cache->folder = folder;
    pthread_mutex_init(&cache->mutex, NULL);
    return cache;
}

static void unlist(camber_tile_cache *cache, cached_tile *tile) {
    *(tile->newer ? &tile->newer->older : &cache->newest) = tile->older;
    *(tile->older ? &tile->older->newer : &cache->oldest) = tile->newer;
}

static void list_first(camber_tile_cache *cache, cached_tile *tile) {
    tile->newer = NULL;
    tile->older = cache->newest;
    *(cache->newest ? &cache->newest->newer : &cache->oldest) = tile;
    cache->newest = tile;
}

/* Returns the link to the tile with this key; the link is NULL if there is no such tile. */
static cached_tile **find_link(camber_tile_cache *cache, camber_tile_key key) {
    cached_tile **link = cache->buckets + bucket_of(cache, key);
    while (*link && ((*link)->key.place != key.place || (*link)->key.look != key.look || (*link)->key.map != key.map))
        link = &(*link)->next;
    return link;
}

static void drop(camber_tile_cache *cache, cached_tile **link) {
    cached_tile *tile = *link;
    if (!tile)
        return;
    *link = tile->next;
    unlist(cache, tile);
    cache->stats.tiles--;
    cache->stats.size_bytes -= cost_of(tile->body);
    camber_body_release(tile->body);
    free(tile);
}

static void drop_map(camber_tile_cache *cache, uint32_t map) {
    for (cached_tile *tile = cache->oldest, *newer; tile; tile = newer) {
        newer = tile->newer;
        if (tile->key.map == map)
            drop(cache, find_link(cache, tile->key));
    }
}

void camber_tile_cache_destroy(camber_tile_cache *cache) {
    if (!cache)
        return;
    while (cache->oldest)
        drop(cache, find_link(cache, cache->oldest->key));
    pthread_mutex_destroy(&cache->mutex);
    free(cache->maps);
    free(cache->buckets);
    free(cache);
}

/* If there is no memory for more buckets, the chains get longer. */
static void grow_buckets(camber_tile_cache *cache) {
    const size_t count = 2 * cache->bucket_count;
    cached_tile **buckets = cache->stats.tiles >= cache->bucket_count ? calloc(count, sizeof(cached_tile *)) : NULL;
    if (!buckets)
        return;
    free(cache->buckets);
    cache->buckets = buckets;
    cache->bucket_count = count;
    for (cached_tile *tile = cache->newest; tile; tile = tile->older) {
        cached_tile **link = buckets + bucket_of(cache, tile->key);
        tile->next = *link;
        *link = tile;
    }
}

/* Returns the input whose tiles are in the folder; 0 if there are none, or there is no folder. */
static uint64_t stored_input(const camber_tile_cache *cache, uint32_t map) {
    return cache->folder ? cache->maps[map].input : 0;
}

/* Keeps a tile in memory, if there is room. Returns the input under which the folder should store it; 0 if it should
 * not. */
static uint64_t keep(camber_tile_cache *cache, camber_tile_key key, camber_body *body, uint64_t generation,
                     bool from_folder) {
    cached_tile *tile = cost_of(body) <= cache->most_bytes ? malloc(sizeof *tile) : NULL;
    if (tile)
        *tile = (cached_tile){.key = key, .body = body};
    pthread_mutex_lock(&cache->mutex);
    const bool current = generation == cache->maps[key.map].generation;
    const uint64_t input = current ? stored_input(cache, key.map) : 0;
    cache->stats.folder_hits += from_folder;
    if (current && tile) {
        drop(cache, find_link(cache, key));
        while (cache->oldest && cache->stats.size_bytes + cost_of(body) > cache->most_bytes)
            drop(cache, find_link(cache, cache->oldest->key));
        grow_buckets(cache);
        cached_tile **link = cache->buckets + bucket_of(cache, key);
        tile->next = *link;
        *link = tile;
        list_first(cache, tile);
        camber_body_hold(body);
        cache->stats.tiles++;
        cache->stats.size_bytes += cost_of(body);
    }
    pthread_mutex_unlock(&cache->mutex);
    if (!current)
        free(tile);
    return input;
}

void camber_tile_cache_put(camber_tile_cache *cache, camber_tile_key key, camber_body *body, uint64_t generation) {
    const uint64_t input = keep(cache, key, body, generation, false);
    if (input)
        camber_tile_folder_put(cache->folder, input, key, body);
}

camber_body *camber_tile_cache_get(camber_tile_cache *cache, camber_tile_key key) {
    pthread_mutex_lock(&cache->mutex);
    cached_tile *tile = *find_link(cache, key);
    if (tile && tile != cache->newest) {
        unlist(cache, tile);
        list_first(cache, tile);
    }
    cache->stats.hits += tile != NULL;
    cache->stats.misses += tile == NULL;
    camber_body *body = tile ? camber_body_hold(tile->body) : NULL;
    const uint64_t input = stored_input(cache, key.map), generation = cache->maps[key.map].generation;
    pthread_mutex_unlock(&cache->mutex);
    if (!body && input && (body = camber_tile_folder_get(cache->folder, input, key)) != NULL)
        (void)keep(cache, key, body, generation, true);
    return body;
}

uint64_t camber_tile_cache_get_generation(camber_tile_cache *cache, uint32_t map) {
    pthread_mutex_lock(&cache->mutex);
    const uint64_t generation = cache->maps[map].generation;
    pthread_mutex_unlock(&cache->mutex);
    return generation;
}

void camber_tile_cache_clear(camber_tile_cache *cache, uint32_t map, uint64_t input) {
    pthread_mutex_lock(&cache->mutex);
    drop_map(cache, map);
    cache->maps[map].input = input;
    cache->maps[map].generation++;
    pthread_mutex_unlock(&cache->mutex);
}

camber_tile_cache_stats camber_tile_cache_get_stats(camber_tile_cache *cache) {
    pthread_mutex_lock(&cache->mutex);
    const camber_tile_cache_stats stats = cache->stats;
    pthread_mutex_unlock(&cache->mutex);
    return stats;
}
