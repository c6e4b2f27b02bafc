/* Sets of vector tiles: code that all kinds of sets share (files by a template, MBTiles and PMTiles), and the code for
 * files by a template.
 *
 * Input: a path or a template of paths. Output: the decompressed bytes of a tile, and the metadata of the set: zooms,
 * bounds, attribution, layers. The budget limits how much a tile may decompress to.
 */
#include "archive/tile_set.h"

#include <errno.h>
#include <math.h>
#include <strings.h>
#include <unistd.h>
#include <zlib.h>

/* The limit for one decompressed tile. Real tiles have at most a few megabytes, but a decompression bomb may have any
 * size. */
static const size_t LARGEST_TILE_BYTES = (size_t)64 << 20;

/* ---- Decompression ---- */

static bool is_compressed(const camber_bytes *bytes) {
    const unsigned char *b = bytes->data;
    if (bytes->size_bytes < 2)
        return false;
    /* The second test is for a zlib header. No valid tile begins with its bytes, which would be field 15 with wire type
     * 0. */
    return (b[0] == 0x1f && b[1] == 0x8b) || (b[0] == 0x78 && (b[0] * 256 + b[1]) % 31 == 0);
}

/* ---- Files by a template ---- */

typedef struct file_set {
    char *path;
    bool south_first, high_resolution;
} file_set;

static void put_quadkey(char *out, int zoom, camber_tile_index tile) {
    for (int z = zoom; z > 0; z--)
        *out++ = (char)('0' + (tile.column >> (z - 1) & 1) + 2 * (tile.row >> (z - 1) & 1));
    *out = 0;
}

/* Writes the text that replaces a token {...}. Returns false if the token is unknown, so that it stays as it is. */
static bool expand_token(const file_set *files, const char *token, size_t length, int zoom, camber_tile_index tile,
                         char out[40]) {
    const uint32_t turned = (UINT32_C(1) << zoom) - 1 - tile.row;
    static const char *const tokens[] = {"{z}", "{x}", "{y}", "{-y}", "{ratio}", "{quadkey}", "{prefix}"};
    size_t i = 0;
    while (i < sizeof tokens / sizeof *tokens &&
           (strlen(tokens[i]) != length || strncmp(tokens[i], token, length) != 0))
        i++;
    switch (i) {
    case 0: snprintf(out, 40, "%d", zoom); return true;
    case 1: snprintf(out, 40, "%u", tile.column); return true;
    case 2: snprintf(out, 40, "%u", files->south_first ? turned : tile.row); return true;
    case 3: snprintf(out, 40, "%u", turned); return true;
    case 4: snprintf(out, 40, "%s", files->high_resolution ? "@2x" : ""); return true;
    case 5: put_quadkey(out, zoom, tile); return true;
    case 6: snprintf(out, 40, "%x%x", tile.column % 16, tile.row % 16); return true;
    default: return false;
    }
}

static char *path_of(camber_tile_set *set, int zoom, camber_tile_index tile) {
    const file_set *files = set->self;
    camber_bytes path = {.context = set->context};
    for (const char *at = files->path; *at;) {
        char text[40];
        const char *end = *at == '{' ? strchr(at, '}') : NULL, *put = at;
        size_t taken = 1, size = 1;
        if (end && expand_token(files, at, (size_t)(end + 1 - at), zoom, tile, text)) {
            taken = (size_t)(end + 1 - at);
            size = strlen(text);
            put = text;
        }
        const size_t before = path.size_bytes;
        if (!camber_bytes_resize(&path, before + size)) {
            camber_bytes_free(&path);
            return NULL;
        }
        memcpy(path.data + before, put, size);
        at += taken;
    }
    if (!path.data && !camber_bytes_resize(&path, 0))
        return NULL;
    path.data[path.size_bytes] = 0;
    return (char *)path.data;
}

static camber_status read_tile(int file, camber_bytes *bytes, const char *name) {
    while (bytes->size_bytes <= LARGEST_TILE_BYTES) {
        const size_t before = bytes->size_bytes;
        if (!camber_bytes_resize(bytes, before + 65536))
            return CAMBER_ERROR_MEMORY;
        const ssize_t got = read(file, bytes->data + before, 65536);
        bytes->size_bytes = before + (got > 0 ? (size_t)got : 0);
        if (got < 0 && errno != EINTR)
            return camber_file_fail(bytes->context, name, errno);
        if (got == 0)
            break;
    }
    return CAMBER_OK;
}

/* Reads a tile's file. If it does not exist, the tile is empty. */
static camber_status get_file(camber_tile_set *set, int zoom, camber_tile_index tile, camber_bytes *bytes,
                              const char **why) {
    (void)why;
    char *path = path_of(set, zoom, tile);
    int file;
    uint64_t size_bytes;
    if (!path)
        return CAMBER_ERROR_MEMORY;
    bytes->size_bytes = 0;
    camber_status status = CAMBER_OK;
    if (!camber_file_is_reached(set->context, path) || access(path, F_OK) == 0 || errno == EACCES)
        status = camber_file_open(set->context, path, set->naming, &file, &size_bytes);
    else
        size_bytes = UINT64_MAX;
    if (status == CAMBER_OK && size_bytes != UINT64_MAX) {
        camber_budget_open(set->context, size_bytes);
        status = read_tile(file, bytes, path);
        close(file);
    }
    camber_free(set->context, path);
    return status;
}

static void close_files(camber_tile_set *set) {
    file_set *files = set->self;
    camber_free(set->context, files->path);
    camber_free(set->context, files);
}

static const camber_tile_set_calls file_calls = {get_file, NULL, close_files};

/* ---- All kinds ---- */

static camber_status make_set(camber_context *context, const char *name, camber_tile_set **set) {
    camber_tile_set *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    *made = (camber_tile_set){.context = context,
                              .max_zoom = 22,
                              .bounds = {-180, -90, 180, 90},
                              .name = camber_copy_string(context, name),
                              .raw.context = context};
    if (!made->name) {
        camber_free(context, made);
        return CAMBER_ERROR_MEMORY;
    }
    *set = made;
    return CAMBER_OK;
}

camber_status camber_tile_set_of_files(camber_context *context, const camber_tile_template *files,
                                       camber_tile_set **set) {
    camber_tile_set *made;
    if (make_set(context, files->name, &made) != CAMBER_OK)
        return CAMBER_ERROR_MEMORY;
    file_set *self = camber_alloc(context, 1, sizeof *self);
    char *path = self ? camber_copy_string(context, files->path) : NULL;
    if (!path) {
        camber_free(context, self);
        camber_tile_set_close(made);
        return CAMBER_ERROR_MEMORY;
    }
    *self = (file_set){path, files->south_first, files->high_resolution};
    made->self = self;
    made->calls = &file_calls;
    made->naming = CAMBER_NAMED_BY_STYLE;
    *set = made;
    return CAMBER_OK;
}

static bool ends_with(const char *text, const char *end) {
    const size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && strcasecmp(text + length - end_length, end) == 0;
}

static const struct {
    const char *name, *ending;
    camber_status (*open)(camber_tile_set *set, const char *path);
} kinds[] = {{"MBTiles", ".mbtiles", camber_mbtiles_open}, {"PMTiles", ".pmtiles", camber_pmtiles_open}};

enum { KINDS = sizeof kinds / sizeof *kinds };

/* Returns the index of the kind that has the path's extension, or KINDS if there is none. */
static size_t find_kind(const char *path) {
    size_t kind = 0;
    while (kind < KINDS && !ends_with(path, kinds[kind].ending))
        kind++;
    return kind;
}

bool camber_tile_set_knows(const char *path) {
    return find_kind(path) < KINDS;
}

const char *camber_tile_set_format(size_t n) {
    return n < KINDS ? kinds[n].name : NULL;
}

static camber_status open_file(camber_context *context, const char *path, camber_file_naming naming, bool takes_any,
                               camber_tile_set **set) {
    camber_tile_set *made;
    if (make_set(context, path, &made) != CAMBER_OK)
        return CAMBER_ERROR_MEMORY;
    made->naming = naming;
    made->takes_any = takes_any;
    const camber_status status =
        kinds[find_kind(path) % KINDS].open(made, path); /* a file with another extension is opened as the first kind */
    if (status != CAMBER_OK) {
        camber_tile_set_close(made);
        return status;
    }
    *set = made;
    return CAMBER_OK;
}

camber_status camber_tile_set_open(camber_context *context, const char *path, camber_file_naming naming,
                                   camber_tile_set **set) {
    return open_file(context, path, naming, false, set);
}

camber_status camber_tile_set_open_any(camber_context *context, const char *path, camber_file_naming naming,
                                       camber_tile_set **set) {
    return open_file(context, path, naming, true, set);
}

camber_status camber_tile_set_get(camber_tile_set *set, int zoom, camber_tile_index tile, camber_bytes *bytes,
                                  const char **why) {
    *why = NULL;
    bytes->size_bytes = 0;
    const camber_status status = set->calls->get(set, zoom, tile, &set->raw, why);
    if (status != CAMBER_OK || *why)
        return status;
    if (is_compressed(&set->raw))
        return camber_tile_set_gunzip(set, &set->raw, LARGEST_TILE_BYTES, bytes, why);
    if (set->raw.size_bytes > LARGEST_TILE_BYTES) {
        *why = "it is larger than 64 MB";
        return CAMBER_OK;
    }
    const camber_bytes swapped = *bytes;
    *bytes = set->raw;
    set->raw = swapped;
    return camber_budget_unfold(set->context, set->name, bytes->size_bytes);
}

camber_status camber_tile_set_list(camber_tile_set *set, int zoom, camber_tile_index **tiles, size_t *count) {
    return set->calls->list(set, zoom, tiles, count);
}

void camber_tile_set_close(camber_tile_set *set) {
    if (!set)
        return;
    if (set->self)
        set->calls->close(set);
    json_decref(set->layers);
    json_decref(set->about);
    camber_free(set->context, set->attribution);
    camber_bytes_free(&set->raw);
    camber_free(set->context, set->name);
    camber_free(set->context, set);
}
