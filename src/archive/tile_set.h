/* An open set of vector tiles: files by a template of paths, MBTiles, or PMTiles. */
#ifndef CAMBER_ARCHIVE_TILE_SET_H
#define CAMBER_ARCHIVE_TILE_SET_H

#include "base/base.h"

#include <jansson.h>

enum { CAMBER_LARGEST_TILE_ZOOM = 24 };

typedef struct camber_tile_index {
    uint32_t column, row; /* from the north-west */
} camber_tile_index;

/* A buffer that is reused. */
typedef struct camber_bytes {
    camber_context *context;
    unsigned char *data;
    size_t size_bytes, capacity;
} camber_bytes;

void camber_bytes_free(camber_bytes *bytes);
/* Makes room for size_bytes bytes, and sets the buffer's size to it. */
bool camber_bytes_resize(camber_bytes *bytes, size_t size_bytes);

typedef struct camber_tile_set camber_tile_set;

/* The functions of one kind of set. */
typedef struct camber_tile_set_calls {
    /* Reads the tile's bytes as they are stored, perhaps compressed. The size is 0 if the tile does not exist. why: see
     * camber_tile_set_get. */
    camber_status (*get)(camber_tile_set *set, int zoom, camber_tile_index tile, camber_bytes *bytes, const char **why);
    /* Lists the tiles of a zoom. Free *tiles with camber_free. NULL: this kind cannot list its tiles. */
    camber_status (*list)(camber_tile_set *set, int zoom, camber_tile_index **tiles, size_t *count);
    void (*close)(camber_tile_set *set);
} camber_tile_set_calls;

struct camber_tile_set {
    const camber_tile_set_calls *calls;
    camber_context *context;
    char *name;                /* for messages */
    camber_file_naming naming; /* whether the user or the style named its files */
    int min_zoom, max_zoom;
    double bounds[4]; /* west, south, east, north, degrees; the whole world if unknown */
    bool has_bounds;
    char *attribution; /* as stored, possibly HTML. NULL: unknown */
    bool takes_any;    /* tiles may have any type, and about is kept */
    json_t *about;     /* the unchanged metadata, an object. NULL: none, or not kept */
    json_t *layers;    /* an array of objects with an "id". NULL: unknown */
    void *self;        /* data for this kind of set */
    camber_bytes raw;
};

/* Opens a file by its extension, .mbtiles or .pmtiles. Returns the errors of camber_file_open, CAMBER_ERROR_INPUT
 * (another format, or tiles that are pictures), CAMBER_ERROR_MEMORY. */
camber_status camber_tile_set_open(camber_context *context, const char *path, camber_file_naming naming,
                                   camber_tile_set **set);
/* Does the same for tiles of any type, including pictures. */
camber_status camber_tile_set_open_any(camber_context *context, const char *path, camber_file_naming naming,
                                       camber_tile_set **set);
/* Whether the path has the extension of such a file. */
bool camber_tile_set_knows(const char *path);
/* Returns the name of the n-th kind of such files, counted from 0, or NULL after the last. */
const char *camber_tile_set_format(size_t n);

typedef struct camber_tile_template {
    const char *name;     /* for messages */
    const char *path;     /* with {z}, {x}, {y} or {-y}, {quadkey}, {prefix}, {ratio} */
    bool south_first;     /* scheme tms: the rows of {y} count from the south */
    bool high_resolution; /* {ratio} becomes @2x instead of nothing */
} camber_tile_template;

camber_status camber_tile_set_of_files(camber_context *context, const camber_tile_template *files,
                                       camber_tile_set **set);

/* Reads the metadata that TileJSON and the other kinds have in common: minzoom, maxzoom, bounds, attribution,
 * vector_layers. Invalid values are ignored. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_tile_set_describe(camber_tile_set *set, const json_t *about);

/* Reads and decompresses a tile. Its size is 0 if the tile does not exist. *why: NULL, or the reason why this tile
 * cannot be used. Returns CAMBER_ERROR_INPUT if the set itself is damaged, CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT (the
 * budget), CAMBER_ERROR_MEMORY. */
camber_status camber_tile_set_get(camber_tile_set *set, int zoom, camber_tile_index tile, camber_bytes *bytes,
                                  const char **why);
/* Lists the tiles of a zoom, which count against the budget for tiles. */
camber_status camber_tile_set_list(camber_tile_set *set, int zoom, camber_tile_index **tiles, size_t *count);
void camber_tile_set_close(camber_tile_set *set);

/* ---- Functions for the kinds of sets ---- */

camber_status camber_mbtiles_open(camber_tile_set *set, const char *path);
camber_status camber_pmtiles_open(camber_tile_set *set, const char *path);
/* Calls take_row for each row of a query to an MBTiles file, which must be a SELECT. The budget of steps for each row
 * is as large as for a whole set of features elsewhere. A status other than CAMBER_OK ends the query. missing: may be
 * NULL; otherwise it becomes true if the query does not match the tables, and this is not a failure. */
struct sqlite3_stmt;
camber_status camber_mbtiles_query(camber_tile_set *set, const char *sql,
                                   camber_status (*take_row)(void *user, struct sqlite3_stmt *row), void *user,
                                   bool *missing);

/* Decompresses gzip or zlib bytes within the budget, to at most limit_bytes. *why: NULL, or the reason why it failed.
 * Returns CAMBER_ERROR_LIMIT (the budget), CAMBER_ERROR_MEMORY. */
camber_status camber_tile_set_gunzip(camber_tile_set *set, const camber_bytes *packed, size_t limit_bytes,
                                     camber_bytes *out, const char **why);

#endif
