/* Writes a tileset of 3D Tiles 1.1 with implicit tiling: a quadtree whose levels are zooms.
 *
 * Input: the runs of tiles in a folder. Output: tileset.json, and subtrees. A subtree has one bit for each tile on the
 * LEVELS levels from its root on, level by level, in Morton order. The main idea: at each zoom, the tiles below a root
 * are consecutive along the Hilbert curve, so runs are found by their numbers, and no table of all tiles is needed.
 *
 * The root is the square of Web Mercator, x east, y north, in metres. Its second axis points south, so that rows count
 * from the north, as they do in the folder. */
#include "archive/tileset.h"

#include "archive/pmtiles.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_LEVELS = 9 };
static const double WORLD_M = 40075016.685578488;
/* A viewer of 3D Tiles switches to the next zoom if the error is more than 16 px, which is the case if it shows a tile
 * at twice its size. */
static const double ERROR_PX = 16.0;

/* The roots of subtrees of a level, as ascending positions along the Hilbert curve. */
typedef struct roots {
    uint64_t *items;
    size_t count, capacity;
} roots;

typedef struct tileset {
    const camber_archive_plan *plan;
    camber_tileset_writer write;
    void *user;
    int levels;    /* the number of levels of a subtree */
    uint8_t *bits; /* the bits of one subtree: tiles, contents, children, each aligned to 8 bytes */
    size_t bytes;  /* how many bytes there are for the tiles, and again for the contents */
    size_t child_bytes;
} tileset;

static size_t align(size_t bytes) {
    return (bytes + 7) / 8 * 8;
}

static uint64_t end_of(const camber_archive_run *run) {
    return run->number + run->length;
}

static int compare(const void *left, const void *right) {
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return a < b ? -1 : a > b;
}

/* ---- Roots ---- */

/* Lists the roots on a level: the archive's tiles on that level, and the ancestors of its tiles below. */
static camber_status list_roots(const tileset *t, int level, roots *list) {
    list->count = 0;
    for (size_t i = 0; i < t->plan->run_count; i++) {
        const camber_archive_run *run = t->plan->runs + i;
        for (uint64_t number = run->number; number < end_of(run);) {
            const int zoom = camber_archive_zoom(number), below = 2 * (zoom - level);
            const uint64_t first = camber_archive_first(zoom), next = camber_archive_first(zoom + 1);
            if (zoom < level) {
                number = next;
                continue;
            }
            const uint64_t root = (number - first) >> below;
            if (!list->count || list->items[list->count - 1] != root) {
                if (!camber_grow(t->plan->context, &list->items, &list->capacity, list->count + 1, sizeof *list->items))
                    return CAMBER_ERROR_MEMORY;
                list->items[list->count++] = root;
            }
            number = first + ((root + 1) << below);
        }
    }
    if (list->count)
        qsort(list->items, list->count, sizeof *list->items, compare);
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++)
        if (!kept || list->items[kept - 1] != list->items[i])
            list->items[kept++] = list->items[i];
    list->count = kept;
    return CAMBER_OK;
}

/* ---- Bits ---- */

static uint64_t morton(uint32_t x, uint32_t y, unsigned bits) {
    uint64_t number = 0;
    for (unsigned i = 0; i < bits; i++)
        number |= (uint64_t)(x >> i & 1) << (2 * i) | (uint64_t)(y >> i & 1) << (2 * i + 1);
    return number;
}

static void set_bit(uint8_t *bits, uint64_t at) {
    bits[at / 8] |= (uint8_t)(1u << (at % 8));
}

/* Sets the bits of a tile and of its ancestors up to the root. place: the tile's position along the Hilbert curve of
 * its zoom. */
static void set_tile(const tileset *t, int level, int zoom, uint64_t place, bool content) {
    uint32_t column, row;
    camber_pmtiles_locate(place, zoom, &column, &row);
    const unsigned depth = (unsigned)(zoom - level);
    const uint32_t mask = ((uint32_t)1 << depth) - 1;
    const uint64_t own = morton(column & mask, row & mask, depth);
    if (content)
        set_bit(t->bits + t->bytes, (((uint64_t)1 << (2 * depth)) - 1) / 3 + own);
    else
        set_bit(t->bits + 2 * t->bytes, own); /* the tile is a child of this subtree, and the root of another */
    for (unsigned k = content ? depth + 1 : depth; k-- > 0;)
        set_bit(t->bits, (((uint64_t)1 << (2 * k)) - 1) / 3 + (own >> (2 * (depth - k))));
}

/* Returns the index of the first run whose last tile has the given number or a higher one. */
static size_t find_run(const tileset *t, uint64_t number) {
    size_t low = 0, high = t->plan->run_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (end_of(t->plan->runs + middle) > number)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

static void set_contents(const tileset *t, int level, uint64_t root) {
    for (int depth = 0; depth < t->levels && level + depth <= t->plan->max_zoom; depth++) {
        const uint64_t zoom_first = camber_archive_first(level + depth);
        const uint64_t first = zoom_first + (root << (2 * depth)), end = zoom_first + ((root + 1) << (2 * depth));
        for (size_t i = find_run(t, first); i < t->plan->run_count && t->plan->runs[i].number < end; i++) {
            const camber_archive_run *run = t->plan->runs + i;
            const uint64_t from = run->number > first ? run->number : first, to = end_of(run) < end ? end_of(run) : end;
            for (uint64_t number = from; number < to; number++)
                set_tile(t, level, level + depth, number - zoom_first, true);
        }
    }
}

static void set_children(const tileset *t, int level, uint64_t root, const roots *below) {
    const uint64_t first = root << (2 * t->levels), end = (root + 1) << (2 * t->levels);
    for (size_t i = 0; i < below->count; i++)
        if (below->items[i] >= first && below->items[i] < end)
            set_tile(t, level, level + t->levels, below->items[i], false);
}

static size_t count_bits(const uint8_t *bits, size_t bytes) {
    size_t count = 0;
    for (size_t i = 0; i < bytes; i++)
        for (unsigned byte = bits[i]; byte; byte &= byte - 1)
            count++;
    return count;
}

/* ---- Files ---- */

static void put(uint8_t *to, uint64_t value, int bytes) {
    for (int i = 0; i < bytes; i++)
        to[i] = (uint8_t)(value >> (8 * i));
}

/* Writes a subtree from its bits: a header of 24 bytes, JSON, and the bits. */
static camber_status write_subtree(const tileset *t, int level, uint64_t root) {
    char json[1024], path[96], children[64] = "{\"constant\":0}";
    uint32_t column, row;
    const size_t tiles = count_bits(t->bits, t->bytes), contents = count_bits(t->bits + t->bytes, t->bytes);
    const size_t child_count = count_bits(t->bits + 2 * t->bytes, t->child_bytes);
    const size_t size = 2 * t->bytes + (child_count ? t->child_bytes : 0);
    if (child_count)
        snprintf(children, sizeof children, "{\"bitstream\":2,\"availableCount\":%zu}", child_count);
    int length = snprintf(json, sizeof json,
                          "{\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,"
                          "\"byteLength\":%zu},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}",
                          size, t->bytes, t->bytes, t->bytes);
    if (child_count)
        length += snprintf(json + length, sizeof json - (size_t)length,
                           ",{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", 2 * t->bytes, t->child_bytes);
    length += snprintf(json + length, sizeof json - (size_t)length,
                       "],\"tileAvailability\":{\"bitstream\":0,\"availableCount\":%zu},\"contentAvailability\":"
                       "[{\"bitstream\":1,\"availableCount\":%zu}],\"childSubtreeAvailability\":%s}",
                       tiles, contents, children);
    const size_t text = align((size_t)length);
    uint8_t *file = camber_alloc(t->plan->context, 24 + text + size, 1);
    if (!file)
        return CAMBER_ERROR_MEMORY;
    put(file, 0x74627573u, 4); /* subt */
    put(file + 4, 1, 4);
    put(file + 8, text, 8);
    put(file + 16, size, 8);
    memset(file + 24, ' ', text);
    memcpy(file + 24, json, (size_t)length);
    memcpy(file + 24 + text, t->bits, size);
    camber_pmtiles_locate(root, level, &column, &row);
    snprintf(path, sizeof path, "subtrees/%d.%" PRIu32 ".%" PRIu32 ".subtree", level, column, row);
    const camber_status status = t->write(t->user, path, file, 24 + text + size);
    camber_free(t->plan->context, file);
    return status;
}

static camber_status write_subtrees(const tileset *t) {
    roots own = {0}, below = {0};
    camber_status status = list_roots(t, 0, &own);
    for (int level = 0; level <= t->plan->max_zoom && status == CAMBER_OK; level += t->levels) {
        status = list_roots(t, level + t->levels, &below);
        for (size_t i = 0; i < own.count && status == CAMBER_OK; i++) {
            memset(t->bits, 0, 2 * t->bytes + t->child_bytes);
            set_contents(t, level, own.items[i]);
            set_children(t, level, own.items[i], &below);
            status = write_subtree(t, level, own.items[i]);
        }
        const roots next = below;
        below = own;
        own = next;
    }
    camber_free(t->plan->context, own.items);
    camber_free(t->plan->context, below.items);
    return status;
}

static camber_status write_root(const tileset *t) {
    char json[1024];
    const double half = 0.5 * WORLD_M;
    const double tile_px = json_number_value(json_object_get(t->plan->metadata, "tileSize"));
    const double error = 0.5 * ERROR_PX * WORLD_M / (tile_px > 0.0 ? tile_px : 512.0);
    const int length =
        snprintf(json, sizeof json,
                 "{\"asset\":{\"version\":\"1.1\"},\"geometricError\":%.3f,\"root\":{\"boundingVolume\":{\"box\":"
                 "[0,0,0,%.6f,0,0,0,%.6f,0,0,0,100]},\"geometricError\":%.3f,\"refine\":\"REPLACE\",\"content\":"
                 "{\"uri\":\"{level}/{x}/{y}.glb\"},\"implicitTiling\":{\"subdivisionScheme\":\"QUADTREE\","
                 "\"subtreeLevels\":%d,\"availableLevels\":%d,\"subtrees\":"
                 "{\"uri\":\"subtrees/{level}.{x}.{y}.subtree\"}}}}\n",
                 error, half, -half, error, t->levels, t->plan->max_zoom + 1);
    return t->write(t->user, "tileset.json", json, (size_t)length);
}

camber_status camber_tileset_write(const camber_archive_plan *plan, camber_tileset_writer write, void *user) {
    const int levels = plan->max_zoom + 1, subtrees = (levels + MOST_LEVELS - 1) / MOST_LEVELS;
    tileset t = {.plan = plan, .write = write, .user = user, .levels = (levels + subtrees - 1) / subtrees};
    const size_t children = (size_t)1 << (2 * t.levels);
    t.bytes = align((children - 1) / 3 / 8 + 1);
    t.child_bytes = align((children + 7) / 8);
    if (!(t.bits = camber_alloc(plan->context, 2 * t.bytes + t.child_bytes, 1)))
        return CAMBER_ERROR_MEMORY;
    camber_status status = write_root(&t);
    if (status == CAMBER_OK)
        status = write_subtrees(&t);
    camber_free(plan->context, t.bits);
    return status;
}
