/* MBTiles: a SQLite database with a table of tiles, whose tile rows count from the south, and a table of metadata.
 * Either table may be a view. A view is a program, so camber runs only views that join and select, and only for a
 * limited number of steps. */
#include "archive/database.h"
#include "archive/tile_set.h"

#include <sqlite3.h>
#include <stdlib.h>

enum { STEPS_A_CALL = 4096, LARGEST_BLOB_BYTES = 16 << 20 };

typedef struct database {
    sqlite3 *handle;
    sqlite3_stmt *get;
    camber_context *context;
    bool computes; /* one of its views does something that is not allowed */
} database;

static int count_steps(void *user) {
    const database *self = user;
    return !camber_budget_take_steps(self->context, STEPS_A_CALL);
}

/* Denies functions, which may take any amount of time for a text, and recursion, which generates rows without end. */
static int authorize(void *user, int action, const char *first, const char *second, const char *base,
                     const char *view) {
    static const char *const functions[] = {"abs", "coalesce", "count", "ifnull", "iif",   "length", "max",
                                            "min", "nullif",   "round", "sum",    "total", "typeof"};
    database *self = user;
    (void)first;
    (void)base;
    (void)view;
    if (action == SQLITE_SELECT || action == SQLITE_READ)
        return SQLITE_OK;
    for (size_t i = 0; action == SQLITE_FUNCTION && i < sizeof functions / sizeof *functions; i++)
        if (sqlite3_stricmp(second, functions[i]) == 0)
            return SQLITE_OK;
    self->computes = true;
    return SQLITE_DENY;
}

static camber_status fail_interrupted(const camber_tile_set *set) {
    return camber_fail(set->context, CAMBER_ERROR_INPUT,
                       "%s: the last program that wrote to it was interrupted; open it once with write access (sqlite3 "
                       "FILE .tables) to repair it",
                       set->name);
}

static camber_status fail(const camber_tile_set *set) {
    const database *self = set->self;
    const int code = self->handle ? sqlite3_errcode(self->handle) : SQLITE_NOMEM;
    const char *said = self->handle ? sqlite3_errmsg(self->handle) : "out of memory";
    if (self->computes)
        return camber_fail(set->context, CAMBER_ERROR_INPUT,
                           "%s: it has a view with recursion or functions, which camber does not run; copy the rows of "
                           "the view to tables",
                           set->name);
    switch (code & 0xff) {
    case SQLITE_NOMEM: return camber_fail(set->context, CAMBER_ERROR_MEMORY, "%s: SQLite is out of memory", set->name);
    case SQLITE_CANTOPEN:
    case SQLITE_IOERR:
    case SQLITE_PERM:
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        return camber_fail(set->context, CAMBER_ERROR_IO,
                           "%s: cannot be read: %s; check its permissions, and who writes to it", set->name, said);
    case SQLITE_READONLY: return fail_interrupted(set);
    case SQLITE_NOTADB:
        return camber_fail(set->context, CAMBER_ERROR_INPUT,
                           "%s: not an MBTiles archive: %s; check the path, or download it again", set->name, said);
    case SQLITE_INTERRUPT:
        return camber_fail(set->context, CAMBER_ERROR_LIMIT,
                           "%s: its queries take too many steps; create an index on tiles (zoom_level, tile_column, "
                           "tile_row)",
                           set->name);
    default:
        return camber_fail(set->context, CAMBER_ERROR_INPUT, "%s: damaged or cut off: %s; get the file again",
                           set->name, said);
    }
}

static camber_status prepare(camber_tile_set *set, const char *sql, sqlite3_stmt **statement) {
    const database *self = set->self;
    return sqlite3_prepare_v2(self->handle, sql, -1, statement, NULL) == SQLITE_OK ? CAMBER_OK : fail(set);
}

/* ---- Metadata ---- */

static bool is_wanted(const char *name) {
    static const char *const names[] = {"format", "bounds", "minzoom", "maxzoom", "attribution", "json"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0)
            return true;
    return false;
}

static void take_metadata_row(json_t *about, sqlite3_stmt *row) {
    const char *name = (const char *)sqlite3_column_text(row, 0);
    if (!name || !is_wanted(name))
        return;
    const char *value = (const char *)sqlite3_column_text(row, 1);
    if (!value)
        return;
    json_object_set_new(about, name, json_string(value));
    if (strcmp(name, "json") != 0)
        return;
    json_t *inner = json_loads(value, JSON_DECODE_INT_AS_REAL, NULL);
    json_t *layers = json_object_get(inner, "vector_layers");
    if (layers)
        json_object_set(about, "vector_layers", layers);
    json_decref(inner);
}

/* If a name occurs several times, the first row counts. */
static void keep_metadata_row(json_t *about, sqlite3_stmt *row) {
    const char *name = about ? (const char *)sqlite3_column_text(row, 0) : NULL;
    const char *value = name ? (const char *)sqlite3_column_text(row, 1) : NULL;
    if (value && !json_object_get(about, name))
        json_object_set_new(about, name, json_string(value));
}

/* Reads the metadata, if there is a table of metadata. */
static camber_status read_metadata(camber_tile_set *set) {
    database *self = set->self;
    sqlite3_stmt *rows = NULL;
    if (sqlite3_prepare_v2(self->handle, "SELECT name, value FROM metadata", -1, &rows, NULL) != SQLITE_OK)
        return sqlite3_errcode(self->handle) == SQLITE_ERROR && !self->computes ? CAMBER_OK : fail(set);
    json_t *about = json_object();
    int step;
    if (set->takes_any)
        set->about = json_object();
    while ((step = sqlite3_step(rows)) == SQLITE_ROW) {
        take_metadata_row(about, rows);
        keep_metadata_row(set->about, rows);
    }
    camber_status status = step == SQLITE_DONE ? CAMBER_OK : fail(set);
    sqlite3_finalize(rows);
    if (status == CAMBER_OK)
        status = camber_tile_set_describe(set, about);
    const char *format = json_string_value(json_object_get(about, "format"));
    if (status == CAMBER_OK && format && !set->takes_any && strcmp(format, "pbf") != 0 && strcmp(format, "mvt") != 0 &&
        strcmp(format, "application/x-protobuf") != 0 && strcmp(format, "application/vnd.mapbox-vector-tile") != 0)
        status = camber_fail(set->context, CAMBER_ERROR_INPUT,
                             "%s: its tiles are %s; camber reads vector tiles (format pbf)", set->name, format);
    json_decref(about);
    return status;
}

static camber_status find_zooms(camber_tile_set *set) {
    sqlite3_stmt *row = NULL;
    camber_status status =
        prepare(set, "SELECT (SELECT min(zoom_level) FROM tiles), (SELECT max(zoom_level) FROM tiles)", &row);
    if (status != CAMBER_OK)
        return status;
    if (sqlite3_step(row) != SQLITE_ROW)
        status = fail(set);
    else if (sqlite3_column_type(row, 0) == SQLITE_NULL && set->takes_any)
        status = CAMBER_OK;
    else if (sqlite3_column_type(row, 0) == SQLITE_NULL)
        status = camber_fail(set->context, CAMBER_ERROR_INPUT, "%s: it has no tiles; get the file again", set->name);
    if (status == CAMBER_OK) {
        const int low = sqlite3_column_int(row, 0), high = sqlite3_column_int(row, 1);
        set->min_zoom = low > 0 ? low : 0;
        set->max_zoom = high < CAMBER_LARGEST_TILE_ZOOM ? high : CAMBER_LARGEST_TILE_ZOOM;
    }
    sqlite3_finalize(row);
    return status;
}

/* ---- Tiles ---- */

static camber_status get_tile(camber_tile_set *set, int zoom, camber_tile_index tile, camber_bytes *bytes,
                              const char **why) {
    (void)why;
    const database *self = set->self;
    bytes->size_bytes = 0;
    sqlite3_bind_int(self->get, 1, zoom);
    sqlite3_bind_int64(self->get, 2, tile.column);
    sqlite3_bind_int64(self->get, 3, ((sqlite3_int64)1 << zoom) - 1 - tile.row);
    const int step = sqlite3_step(self->get);
    camber_status status = step == SQLITE_ROW || step == SQLITE_DONE ? CAMBER_OK : fail(set);
    if (step == SQLITE_ROW) {
        const void *blob = sqlite3_column_blob(self->get, 0);
        const size_t size = (size_t)sqlite3_column_bytes(self->get, 0);
        if (!blob && size)
            status = fail(set);
        else if (!camber_bytes_resize(bytes, size))
            status = CAMBER_ERROR_MEMORY;
        else if (size)
            memcpy(bytes->data, blob, size);
    }
    sqlite3_reset(self->get);
    return status;
}

static int compare_tiles(const void *left, const void *right) {
    const camber_tile_index *a = left, *b = right;
    if (a->column != b->column)
        return a->column < b->column ? -1 : 1;
    return a->row > b->row ? -1 : a->row < b->row;
}

/* Sorts the tiles by row in the table's order, from the south, and removes duplicates. The order matters, because lines
 * are drawn in the order in which they are read. */
static size_t sort_tiles(camber_tile_index *tiles, size_t count) {
    size_t kept = 0;
    if (count)
        qsort(tiles, count, sizeof *tiles, compare_tiles);
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || compare_tiles(tiles + kept - 1, tiles + i) != 0)
            tiles[kept++] = tiles[i];
    return kept;
}

static camber_status take_tile(camber_tile_set *set, sqlite3_stmt *at, int zoom, camber_tile_index **tiles,
                               size_t *count, size_t *capacity) {
    const int64_t side = INT64_C(1) << zoom;
    const int64_t column = sqlite3_column_int64(at, 0), row = side - 1 - sqlite3_column_int64(at, 1);
    const camber_status status = camber_budget_take_tiles(set->context, set->name, 1);
    if (status != CAMBER_OK || column < 0 || column >= side || row < 0 || row >= side)
        return status;
    if (!camber_grow(set->context, tiles, capacity, *count + 1, sizeof **tiles))
        return CAMBER_ERROR_MEMORY;
    (*tiles)[(*count)++] = (camber_tile_index){(uint32_t)column, (uint32_t)row};
    return CAMBER_OK;
}

static camber_status list_tiles(camber_tile_set *set, int zoom, camber_tile_index **tiles, size_t *count) {
    sqlite3_stmt *rows = NULL;
    camber_tile_index *made = NULL;
    size_t found = 0, capacity = 0;
    camber_status status = prepare(set, "SELECT tile_column, tile_row FROM tiles WHERE zoom_level = ?", &rows);
    if (status != CAMBER_OK)
        return status;
    sqlite3_bind_int(rows, 1, zoom);
    int step;
    while (status == CAMBER_OK && (step = sqlite3_step(rows)) != SQLITE_DONE)
        status = step == SQLITE_ROW ? take_tile(set, rows, zoom, &made, &found, &capacity) : fail(set);
    sqlite3_finalize(rows);
    if (status != CAMBER_OK) {
        camber_free(set->context, made);
        return status;
    }
    *count = sort_tiles(made, found);
    *tiles = made;
    return CAMBER_OK;
}

camber_status camber_mbtiles_query(camber_tile_set *set, const char *sql,
                                   camber_status (*take_row)(void *user, sqlite3_stmt *row), void *user,
                                   bool *missing) {
    const database *self = set->self;
    sqlite3_stmt *rows = NULL;
    if (missing && sqlite3_prepare_v2(self->handle, sql, -1, &rows, NULL) == SQLITE_ERROR && !self->computes) {
        *missing = true;
        return CAMBER_OK;
    }
    camber_status status = rows ? CAMBER_OK : prepare(set, sql, &rows);
    int step;
    while (status == CAMBER_OK && (step = sqlite3_step(rows)) != SQLITE_DONE) {
        status = step == SQLITE_ROW ? take_row(user, rows) : fail(set);
        set->context->spent.steps = 0;
    }
    sqlite3_finalize(rows);
    return status;
}

static void close_database(camber_tile_set *set) {
    database *self = set->self;
    sqlite3_finalize(self->get);
    sqlite3_close(self->handle);
    camber_free(set->context, self);
}

static const camber_tile_set_calls database_calls = {get_tile, list_tiles, close_database};

/* ---- Opening ---- */

/* SQLite creates files next to a database in WAL mode, and leaves them there. */
static camber_status open_handle(camber_tile_set *set, const char *path) {
    database *self = set->self;
    const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX;
    const camber_database_kind kind = camber_database_get_kind(path);
    if (kind == CAMBER_DATABASE_INTERRUPTED)
        return fail_interrupted(set);
    if (kind != CAMBER_DATABASE_AT_REST)
        return sqlite3_open_v2(path, &self->handle, flags, NULL) == SQLITE_OK ? CAMBER_OK : fail(set);
    char uri[3 * 4096];
    if (!camber_database_uri(path, uri, sizeof uri))
        return camber_fail(set->context, CAMBER_ERROR_IO, "%s: the path is too long; copy it elsewhere", set->name);
    return sqlite3_open_v2(uri, &self->handle, flags | SQLITE_OPEN_URI, NULL) == SQLITE_OK ? CAMBER_OK : fail(set);
}

camber_status camber_mbtiles_open(camber_tile_set *set, const char *path) {
    uint64_t size_bytes;
    camber_status status = camber_file_check(set->context, path, set->naming, &size_bytes);
    if (status == CAMBER_OK && size_bytes == 0)
        status = camber_fail(set->context, CAMBER_ERROR_INPUT, "%s: the file is empty; get it again", set->name);
    database *self = status == CAMBER_OK ? camber_alloc_zero(set->context, 1, sizeof *self) : NULL;
    if (!self)
        return status == CAMBER_OK ? CAMBER_ERROR_MEMORY : status;
    camber_budget_open(set->context, size_bytes);
    self->context = set->context;
    set->self = self;
    set->calls = &database_calls;
    set->min_zoom = set->max_zoom = -1;
    status = open_handle(set, path);
    if (status != CAMBER_OK)
        return status;
    sqlite3_progress_handler(self->handle, STEPS_A_CALL, count_steps, self);
    sqlite3_limit(self->handle, SQLITE_LIMIT_LENGTH, LARGEST_BLOB_BYTES);
    sqlite3_db_config(self->handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
    sqlite3_set_authorizer(self->handle, authorize, self);
    status = read_metadata(set);
    if (status == CAMBER_OK)
        status = prepare(set, "SELECT tile_data FROM tiles WHERE zoom_level = ? AND tile_column = ? AND tile_row = ?",
                         &self->get);
    if (status == CAMBER_OK && (set->min_zoom < 0 || set->max_zoom < set->min_zoom))
        status = find_zooms(set);
    return status;
}
