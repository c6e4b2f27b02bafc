/* PMTiles 3: a header of 127 bytes, a root directory, metadata, leaf directories, tiles. A directory is a compressed
 * list of tile numbers, as varints. Tiles are numbered zoom by zoom, along a Hilbert curve in each. */
#define _FILE_OFFSET_BITS 64

#include "archive/pmtiles.h"
#include "archive/archive.h"

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

enum { DEEPEST = 4 };

/* The format's numbers for types of tiles. The numbers between these two are pictures. */
enum { VECTOR_TILES = 1, MAPLIBRE_TILES = 6 };

/* The largest directory, and the largest range of other bytes, that is read. Directories of real files have some
 * hundred kilobytes. */
static const size_t LARGEST_DIRECTORY_BYTES = (size_t)16 << 20, LARGEST_BYTES = (size_t)64 << 20;
/* The number of budget steps for reading a directory. */
static const uint64_t DIRECTORY_STEPS = 4096;

typedef camber_pmtiles_range range;
typedef camber_pmtiles_directory directory;

typedef struct archive {
    int file;
    uint64_t size_bytes;
    camber_pmtiles_header header;
    directory parsed_root;
    directory leaf; /* the leaf that was read last */
    range leaf_range;
    camber_bytes packed, unpacked;
} archive;

/* ---- Numbers ---- */

uint64_t camber_pmtiles_number(int zoom, uint32_t column, uint32_t row) {
    uint64_t before = 0, along = 0;
    for (int z = 0; z < zoom; z++)
        before += UINT64_C(1) << 2 * z;
    uint32_t x = column, y = row;
    for (int z = zoom - 1; z >= 0; z--) {
        const uint32_t half = UINT32_C(1) << (z & 31), right = x & half ? 1 : 0, down = y & half ? 1 : 0;
        along += ((uint64_t)half * half) * ((3 * right) ^ down);
        /* Rotates the curve for this quarter of the square. */
        if (!down) {
            if (right) {
                x = half - 1 - (x & (half - 1));
                y = half - 1 - (y & (half - 1));
            }
            const uint32_t swapped = x;
            x = y;
            y = swapped;
        }
    }
    return before + along;
}

void camber_pmtiles_locate(uint64_t along, int zoom, uint32_t *column, uint32_t *row) {
    uint32_t x = 0, y = 0;
    for (int z = 0; z < zoom; z++, along >>= 2) {
        const uint32_t half = UINT32_C(1) << z, right = (uint32_t)(along >> 1) & 1,
                       down = (uint32_t)(along ^ right) & 1;
        if (!down) {
            if (right) {
                x = half - 1 - x;
                y = half - 1 - y;
            }
            const uint32_t swapped = x;
            x = y;
            y = swapped;
        }
        x += half * right;
        y += half * down;
    }
    *column = x;
    *row = y;
}

/* ---- Directories ---- */

typedef struct cursor {
    const unsigned char *at, *end;
    bool failed;
} cursor;

static uint64_t take_varint(cursor *c) {
    uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
        if (c->at == c->end)
            break;
        const unsigned char byte = *c->at++;
        value |= (uint64_t)(byte & 127) << shift;
        if (byte < 128)
            return value;
    }
    c->failed = true;
    return 0;
}

/* Returns why the entries are not valid, or NULL if they are. */
static const char *read_entries(cursor *c, camber_pmtiles_entry *made, size_t count) {
    const char *why = NULL;
    uint64_t number = 0;
    for (size_t i = 0; i < count; i++) {
        const uint64_t step = take_varint(c);
        if (i && (step == 0 || step > UINT64_MAX - number))
            why = "a directory is not in order";
        made[i].number = number += step;
    }
    for (size_t i = 0; i < count; i++)
        made[i].run_length = take_varint(c);
    for (size_t i = 0; i < count; i++)
        made[i].size = take_varint(c);
    for (size_t i = 0; i < count; i++) {
        const uint64_t offset = take_varint(c);
        if (offset == 0 && i == 0)
            why = "the first entry of a directory continues another one";
        made[i].offset = offset ? offset - 1 : i ? made[i - 1].offset + made[i - 1].size : 0;
    }
    return c->failed ? "a directory is cut off" : why;
}

camber_status camber_pmtiles_parse(camber_context *context, const void *bytes, size_t size_bytes,
                                   camber_pmtiles_directory *parsed, const char **why) {
    cursor c = {bytes, (const unsigned char *)bytes + size_bytes, false};
    const uint64_t announced = take_varint(&c);
    if (c.failed || announced > size_bytes / CAMBER_PMTILES_LEAST_ENTRY_BYTES) {
        *why = "a directory has fewer entries than it announces";
        return CAMBER_ERROR_INPUT;
    }
    directory made = {.count = (size_t)announced};
    if (!(made.entries = camber_alloc(context, made.count + 1, sizeof *made.entries)))
        return CAMBER_ERROR_MEMORY;
    *why = read_entries(&c, made.entries, made.count);
    if (*why) {
        camber_free(context, made.entries);
        return CAMBER_ERROR_INPUT;
    }
    *parsed = made;
    return CAMBER_OK;
}

static camber_status fail(const camber_tile_set *set, const char *why) {
    return camber_fail(set->context, CAMBER_ERROR_INPUT, "%s: damaged or cut off: %s; get the file again", set->name,
                       why);
}

/* Reads a range of the file. *why is set if the range ends past the end of the file. */
static camber_status read_range(camber_tile_set *set, range at, size_t limit_bytes, camber_bytes *bytes,
                                const char **why) {
    const archive *self = set->self;
    if (at.offset > self->size_bytes || at.size > self->size_bytes - at.offset) {
        *why = "it ends past the end of the file";
        return CAMBER_OK;
    }
    if (at.size > limit_bytes) {
        *why = "it is too large";
        return CAMBER_OK;
    }
    if (!camber_bytes_resize(bytes, (size_t)at.size))
        return CAMBER_ERROR_MEMORY;
    for (size_t done = 0; done < at.size;) {
        const ssize_t got = pread(self->file, bytes->data + done, (size_t)at.size - done, (off_t)(at.offset + done));
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return camber_fail(set->context, CAMBER_ERROR_IO, "%s: cannot be read: %s; get the file again", set->name,
                               strerror(errno));
        if (got == 0) {
            *why = "it ends past the end of the file";
            return CAMBER_OK;
        }
        done += (size_t)got;
    }
    return CAMBER_OK;
}

/* Reads a compressed range, such as a directory, and decompresses it to *bytes. */
static camber_status read_packed(camber_tile_set *set, range at, const char *what, const camber_bytes **bytes) {
    archive *self = set->self;
    const char *why = NULL;
    camber_status status = read_range(set, at, LARGEST_DIRECTORY_BYTES, &self->packed, &why);
    if (status == CAMBER_OK && !why && self->header.directory_compression == CAMBER_PMTILES_GZIP)
        status = camber_tile_set_gunzip(set, &self->packed, LARGEST_DIRECTORY_BYTES, &self->unpacked, &why);
    if (status != CAMBER_OK)
        return status;
    *bytes = self->header.directory_compression == CAMBER_PMTILES_GZIP ? &self->unpacked : &self->packed;
    if (!why)
        return CAMBER_OK;
    return camber_fail(set->context, CAMBER_ERROR_INPUT, "%s: damaged or cut off: %s: %s; get the file again",
                       set->name, what, why);
}

static camber_status read_directory(camber_tile_set *set, range at, directory *parsed) {
    const camber_bytes *bytes;
    directory made = {0};
    camber_status status = read_packed(set, at, "a directory", &bytes);
    if (status != CAMBER_OK)
        return status;
    const char *why;
    status = camber_pmtiles_parse(set->context, bytes->data, bytes->size_bytes, &made, &why);
    if (status != CAMBER_OK)
        return status == CAMBER_ERROR_INPUT ? fail(set, why) : status;
    camber_free(set->context, parsed->entries);
    *parsed = made;
    return CAMBER_OK;
}

static range leaf_of(const archive *self, const camber_pmtiles_entry *entry) {
    const uint64_t room = UINT64_MAX - self->header.leaves.offset;
    return (range){entry->offset <= room ? self->header.leaves.offset + entry->offset : UINT64_MAX, entry->size};
}

/* Returns the last entry that begins at the given number or before it, or NULL if there is none. */
static const camber_pmtiles_entry *find_entry(const directory *in, uint64_t number) {
    size_t low = 0, high = in->count;
    while (in->entries && low < high) {
        const size_t middle = low + (high - low) / 2;
        if (in->entries[middle].number <= number)
            low = middle + 1;
        else
            high = middle;
    }
    return low ? &in->entries[low - 1] : NULL;
}

/* ---- Tiles ---- */

camber_pmtiles_file camber_pmtiles_get_file(const camber_tile_set *set) {
    const archive *self = set->self;
    return (camber_pmtiles_file){self->file, self->size_bytes, self->header};
}

camber_status camber_pmtiles_read_entry(camber_tile_set *set, const camber_pmtiles_entry *entry, camber_bytes *bytes,
                                        const char **why) {
    const archive *self = set->self;
    const uint64_t room = UINT64_MAX - self->header.tiles.offset;
    const range at = {entry->offset <= room ? self->header.tiles.offset + entry->offset : UINT64_MAX, entry->size};
    return read_range(set, at, LARGEST_BYTES, bytes, why);
}

static camber_status get_tile(camber_tile_set *set, int zoom, camber_tile_index tile, camber_bytes *bytes,
                              const char **why) {
    archive *self = set->self;
    const uint64_t number = camber_pmtiles_number(zoom, tile.column, tile.row);
    const directory *in = &self->parsed_root;
    bytes->size_bytes = 0;
    for (int depth = 0; depth < DEEPEST; depth++) {
        const camber_pmtiles_entry *entry = find_entry(in, number);
        if (!entry || (entry->run_length && number - entry->number >= entry->run_length))
            return CAMBER_OK;
        if (entry->run_length)
            return camber_pmtiles_read_entry(set, entry, bytes, why);
        const range at = leaf_of(self, entry);
        if (at.offset != self->leaf_range.offset || at.size != self->leaf_range.size || !self->leaf.entries) {
            const camber_status status = read_directory(set, at, &self->leaf);
            if (status != CAMBER_OK)
                return status;
            self->leaf_range = at;
        }
        in = &self->leaf;
    }
    return fail(set, "its directories form a cycle");
}

typedef struct listing {
    camber_tile_set *set;
    int zoom;
    uint64_t first, end; /* the first tile number of the zoom, and the number after its last tile */
    camber_tile_index *tiles;
    size_t count, capacity;
} listing;

static camber_status list_entry(void *user, const camber_pmtiles_entry *entry) {
    listing *list = user;
    const uint64_t last =
        entry->run_length - 1 <= UINT64_MAX - entry->number ? entry->number + (entry->run_length - 1) : UINT64_MAX;
    if (last < list->first || entry->number >= list->end)
        return CAMBER_OK;
    const uint64_t from = entry->number > list->first ? entry->number : list->first;
    const uint64_t end = last < list->end ? last + 1 : list->end;
    const camber_status status = camber_budget_take_tiles(list->set->context, list->set->name, end - from);
    if (status != CAMBER_OK)
        return status;
    for (uint64_t number = from; number < end; number++) {
        if (!camber_grow(list->set->context, &list->tiles, &list->capacity, list->count + 1, sizeof *list->tiles))
            return CAMBER_ERROR_MEMORY;
        camber_tile_index *tile = &list->tiles[list->count++];
        camber_pmtiles_locate(number - list->first, list->zoom, &tile->column, &tile->row);
    }
    return CAMBER_OK;
}

static camber_status walk_directory(camber_tile_set *set, const camber_pmtiles_visitor *visitor, const directory *in,
                                    int depth) {
    const archive *self = set->self;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < in->count && status == CAMBER_OK; i++) {
        const camber_pmtiles_entry *entry = &in->entries[i];
        if (entry->run_length) {
            status = visitor->take_entry(visitor->user, entry);
            continue;
        }
        const bool beyond =
            entry->number >= visitor->end || (i + 1 < in->count && in->entries[i + 1].number <= visitor->first);
        if (beyond)
            continue;
        directory leaf = {0};
        if (depth >= DEEPEST)
            return fail(set, "its directories form a cycle");
        if (!camber_budget_take_steps(set->context, DIRECTORY_STEPS))
            return camber_fail(set->context, CAMBER_ERROR_LIMIT,
                               "%s: its directories take too many steps, or form a cycle; get the file again",
                               set->name);
        if (visitor->take_leaf)
            status = visitor->take_leaf(visitor->user, entry, depth);
        if (status == CAMBER_OK)
            status = read_directory(set, leaf_of(self, entry), &leaf);
        if (status == CAMBER_OK)
            status = walk_directory(set, visitor, &leaf, depth + 1);
        camber_free(set->context, leaf.entries);
    }
    return status;
}

camber_status camber_pmtiles_walk(camber_tile_set *set, const camber_pmtiles_visitor *visitor) {
    const archive *self = set->self;
    return walk_directory(set, visitor, &self->parsed_root, 1);
}

static camber_status list_tiles(camber_tile_set *set, int zoom, camber_tile_index **tiles, size_t *count) {
    listing list = {.set = set, .zoom = zoom, .first = camber_pmtiles_number(zoom, 0, 0)};
    list.end = list.first + (UINT64_C(1) << 2 * zoom);
    const camber_pmtiles_visitor visitor = {list.first, list.end, list_entry, NULL, &list};
    const camber_status status = camber_pmtiles_walk(set, &visitor);
    if (status != CAMBER_OK) {
        camber_free(set->context, list.tiles);
        return status;
    }
    *tiles = list.tiles;
    *count = list.count;
    return CAMBER_OK;
}

static void close_archive(camber_tile_set *set) {
    archive *self = set->self;
    if (self->file >= 0)
        close(self->file);
    camber_free(set->context, self->parsed_root.entries);
    camber_free(set->context, self->leaf.entries);
    camber_bytes_free(&self->packed);
    camber_bytes_free(&self->unpacked);
    camber_free(set->context, self);
}

static const camber_tile_set_calls archive_calls = {get_tile, list_tiles, close_archive};

/* ---- Opening ---- */

static uint64_t read_number(const unsigned char *bytes, int size) {
    uint64_t number = 0;
    for (int i = 0; i < size; i++)
        number |= (uint64_t)bytes[i] << 8 * i;
    return number;
}

static range read_header_range(const unsigned char *bytes) {
    return (range){read_number(bytes, 8), read_number(bytes + 8, 8)};
}

static int32_t read_coordinate(const unsigned char *bytes) {
    return (int32_t)(uint32_t)read_number(bytes, 4);
}

void camber_pmtiles_parse_header(const unsigned char bytes[CAMBER_PMTILES_HEADER_BYTES],
                                 camber_pmtiles_header *header) {
    *header = (camber_pmtiles_header){.root = read_header_range(bytes + 8),
                                      .metadata = read_header_range(bytes + 24),
                                      .leaves = read_header_range(bytes + 40),
                                      .tiles = read_header_range(bytes + 56),
                                      .addressed = read_number(bytes + 72, 8),
                                      .entries = read_number(bytes + 80, 8),
                                      .contents = read_number(bytes + 88, 8),
                                      .clustered = bytes[96],
                                      .directory_compression = bytes[97],
                                      .tile_compression = bytes[98],
                                      .tile_type = bytes[99],
                                      .min_zoom = bytes[100],
                                      .max_zoom = bytes[101],
                                      .center_zoom = bytes[118],
                                      .center = {read_coordinate(bytes + 119), read_coordinate(bytes + 123)}};
    for (int i = 0; i < 4; i++)
        header->bounds[i] = read_coordinate(bytes + 102 + 4 * i);
}

static const char *const compressions[] = {"unknown", "none", "gzip", "brotli", "zstd"};

static camber_status check_compression(const camber_tile_set *set, int compression, const char *what) {
    if (compression == CAMBER_PMTILES_PLAIN || compression == CAMBER_PMTILES_GZIP)
        return CAMBER_OK;
    return camber_fail(set->context, CAMBER_ERROR_INPUT,
                       "%s: its %s are compressed with %s; camber reads gzip and none: make it again with one of them",
                       set->name, what, compressions[compression >= 0 && compression <= 4 ? compression : 0]);
}

/* Tiles of an unknown type may be vector tiles. */
static camber_status check_type(const camber_tile_set *set) {
    const int type = ((const archive *)set->self)->header.tile_type;
    if (set->takes_any || type == VECTOR_TILES || type == 0)
        return CAMBER_OK;
    if (type == MAPLIBRE_TILES)
        return camber_fail(set->context, CAMBER_ERROR_INPUT,
                           "%s: its tiles are MLT (MapLibre tiles), and camber reads MVT; make it again with MVT",
                           set->name);
    if (type < MAPLIBRE_TILES)
        return camber_fail(set->context, CAMBER_ERROR_INPUT, "%s: its tiles are pictures; camber reads vector tiles",
                           set->name);
    return camber_fail(set->context, CAMBER_ERROR_INPUT,
                       "%s: its tiles are of type %d, which camber does not know; make it again with MVT (type 1)",
                       set->name, type);
}

static camber_status read_header(camber_tile_set *set) {
    archive *self = set->self;
    const char *why = NULL;
    camber_status status = read_range(set, (range){0, CAMBER_PMTILES_HEADER_BYTES}, LARGEST_BYTES, &self->packed, &why);
    if (status != CAMBER_OK)
        return status;
    const unsigned char *head = self->packed.data;
    if (why || memcmp(head, "PMTiles", 7) != 0)
        return camber_fail(set->context, CAMBER_ERROR_INPUT,
                           "%s: not a PMTiles archive; check the path, or download it again", set->name);
    if (head[7] != 3)
        return camber_fail(set->context, CAMBER_ERROR_INPUT, "%s: has version %d of PMTiles; convert it to version 3",
                           set->name, head[7]);
    camber_pmtiles_parse_header(head, &self->header);
    set->min_zoom = self->header.min_zoom;
    set->max_zoom = self->header.max_zoom;
    for (int i = 0; i < 4; i++)
        set->bounds[i] = (double)self->header.bounds[i] * 1e-7;
    set->has_bounds = set->bounds[0] < set->bounds[2] && set->bounds[1] < set->bounds[3] && set->bounds[0] >= -180 &&
                      set->bounds[2] <= 180 && set->bounds[1] >= -90 && set->bounds[3] <= 90;
    if (!set->has_bounds)
        memcpy(set->bounds, (double[4]){-180, -90, 180, 90}, sizeof set->bounds);
    if (check_type(set) != CAMBER_OK)
        return CAMBER_ERROR_INPUT;
    if (set->min_zoom > set->max_zoom || set->max_zoom > CAMBER_LARGEST_TILE_ZOOM)
        return fail(set, "its zooms are out of range");
    status = check_compression(set, self->header.directory_compression, "directories");
    return status == CAMBER_OK ? check_compression(set, self->header.tile_compression, "tiles") : status;
}

static camber_status read_metadata(camber_tile_set *set) {
    archive *self = set->self;
    const camber_bytes *bytes;
    if (self->header.metadata.size == 0)
        return CAMBER_OK;
    camber_status status = read_packed(set, self->header.metadata, "its metadata", &bytes);
    if (status != CAMBER_OK)
        return status;
    json_t *about = json_loadb((const char *)bytes->data, bytes->size_bytes, JSON_DECODE_INT_AS_REAL, NULL);
    if (set->takes_any)
        set->about = json_loadb((const char *)bytes->data, bytes->size_bytes, 0, NULL);
    if (json_is_object(about)) {
        /* The zooms and bounds in the header take precedence, so they are set last. */
        json_object_del(about, "minzoom");
        json_object_del(about, "maxzoom");
        json_object_del(about, "bounds");
        status = camber_tile_set_describe(set, about);
    }
    json_decref(about);
    return status;
}

camber_status camber_pmtiles_open(camber_tile_set *set, const char *path) {
    archive *self = camber_alloc_zero(set->context, 1, sizeof *self);
    if (!self)
        return CAMBER_ERROR_MEMORY;
    self->file = -1;
    set->self = self;
    set->calls = &archive_calls;
    self->packed.context = self->unpacked.context = set->context;
    camber_status status = camber_file_open(set->context, path, set->naming, &self->file, &self->size_bytes);
    if (status != CAMBER_OK)
        return status;
    camber_budget_open(set->context, self->size_bytes);
    status = read_header(set);
    if (status == CAMBER_OK)
        status = read_directory(set, self->header.root, &self->parsed_root);
    if (status == CAMBER_OK)
        status = read_metadata(set);
    return status;
}

uint64_t camber_archive_first(int zoom) {
    return camber_pmtiles_number(zoom, 0, 0);
}

int camber_archive_zoom(uint64_t number) {
    int zoom = 0;
    while (zoom < 31 && camber_archive_first(zoom + 1) <= number)
        zoom++;
    return zoom;
}
