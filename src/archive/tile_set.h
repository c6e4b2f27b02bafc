/* An open set of vector tiles: files by a template, MBTiles, PMTiles. */
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
/* Makes room for this many bytes, and sets size_bytes. */
bool camber_bytes_resize(camber_bytes *bytes, size_t size_bytes);

typedef struct camber_tile_set camber_tile_set;

/* The functions of one kind of set. */
typedef struct camber_tile_set_calls {
    /* Reads the tile as it is stored, maybe compressed; size 0 where there is none. why: as camber_tile_set_get. */
    camber_status (*get)(camber_tile_set *set, int zoom, camber_tile_index tile, camber_bytes *bytes, const char **why);
    /* NULL: the kind cannot list its tiles. *tiles is freed with camber_free. */
    camber_status (*list)(camber_tile_set *set, int zoom, camber_tile_index **tiles, size_t *count);
    void (*close)(camber_tile_set *set);
} camber_tile_set_calls;

struct camber_tile_set {
    const camber_tile_set_calls *calls;
    camber_context *context;
    char *name;                /* in messages */
    camber_file_naming naming; /* how its files are named by the user or the style */
    int min_zoom, max_zoom;
    double bounds[4]; /* west, south, east, north, degrees; the whole world where nothing is said */
    bool has_bounds;
    char *attribution; /* as it stands there, maybe HTML. NULL: not told */
    bool takes_any;    /* tiles may be of any type, and about is kept */
    json_t *about;     /* the metadata as they are, an object. NULL: none, or not kept */
    json_t *layers;    /* an array of objects with an "id". NULL: not told */
    void *self;        /* the kind's own */
    camber_bytes raw;
};

/* Opens a file by its ending, .mbtiles or .pmtiles. Returns what camber_file_open does, CAMBER_ERROR_INPUT (another
 * format, tiles that are pictures), CAMBER_ERROR_MEMORY. */
camber_status camber_tile_set_open(camber_context *context, const char *path, camber_file_naming naming,
                                   camber_tile_set **set);
/* The same for tiles of any type, pictures too. */
camber_status camber_tile_set_open_any(camber_context *context, const char *path, camber_file_naming naming,
                                       camber_tile_set **set);
/* Whether the path ends as such a file. */
bool camber_tile_set_knows(const char *path);
/* The name of the n-th kind of such files, counted from 0. NULL: past the last. */
const char *camber_tile_set_format(size_t n);

typedef struct camber_tile_template {
    const char *name;     /* in messages */
    const char *path;     /* with {z}, {x}, {y} or {-y}, {quadkey}, {prefix}, {ratio} */
    bool south_first;     /* the rows of {y} count from the south: scheme tms */
    bool high_resolution; /* {ratio} is @2x, not nothing */
} camber_tile_template;

camber_status camber_tile_set_of_files(camber_context *context, const camber_tile_template *files,
                                       camber_tile_set **set);

/* Reads what TileJSON and the metadata of the other kinds have in common: minzoom, maxzoom, bounds, attribution,
 * vector_layers. Values that make no sense are ignored. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_tile_set_describe(camber_tile_set *set, const json_t *about);

/* Reads the tile's bytes, decompressed; size 0 where there is none. *why: NULL, or what is wrong with this one tile.
 * Returns CAMBER_ERROR_INPUT where the set itself is damaged, CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT (the budget),
 * CAMBER_ERROR_MEMORY. */
camber_status camber_tile_set_get(camber_tile_set *set, int zoom, camber_tile_index tile, camber_bytes *bytes,
                                  const char **why);
/* Lists the tiles of a zoom; they count against the budget's tiles. */
camber_status camber_tile_set_list(camber_tile_set *set, int zoom, camber_tile_index **tiles, size_t *count);
void camber_tile_set_close(camber_tile_set *set);

/* ---- For the kinds ---- */

camber_status camber_mbtiles_open(camber_tile_set *set, const char *path);
camber_status camber_pmtiles_open(camber_tile_set *set, const char *path);
/* Calls take_row for each row of a query to an MBTiles file, a SELECT alone. Each row may take as many steps as a
 * whole set of features elsewhere. A status that is not CAMBER_OK ends it. missing: NULL, or becomes true where the
 * query does not fit the tables, which is then no failure. */
struct sqlite3_stmt;
camber_status camber_mbtiles_query(camber_tile_set *set, const char *sql,
                                   camber_status (*take_row)(void *user, struct sqlite3_stmt *row), void *user,
                                   bool *missing);

/* Decompresses gzip or zlib, as far as the budget goes; limit_bytes is the most that comes out. *why: NULL, or why not.
 * Returns CAMBER_ERROR_LIMIT (the budget), CAMBER_ERROR_MEMORY. */
camber_status camber_tile_set_gunzip(camber_tile_set *set, const camber_bytes *packed, size_t limit_bytes,
                                     camber_bytes *out, const char **why);

#endif
