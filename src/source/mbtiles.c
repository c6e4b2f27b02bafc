/* MBTiles: a SQLite database with a table (or view) of tiles, rows from the south, and one of metadata. */
#include "source/tile_set.h"

#include <errno.h>
#include <sqlite3.h>
#include <sys/stat.h>

/* A view can take for ever: so many millions of steps of SQLite's machine a query, some seconds; the metadata is small.
 */
enum { STEPS_A_CALL = 1 << 20, MOST_CALLS = 400, MOST_METADATA_CALLS = 8 };
static const int LARGEST_BLOB_BYTES = 64 << 20;

typedef struct database {
    sqlite3 *handle;
    sqlite3_stmt *get;
    int calls, most_calls; /* since the query began */
} database;

static int count_steps(void *user) {
    database *self = user;
    return ++self->calls > self->most_calls;
}

static camber_status fail(const camber_tile_set *set) {
    const database *self = set->self;
    const int code = self->handle ? sqlite3_errcode(self->handle) : SQLITE_NOMEM;
    const char *said = self->handle ? sqlite3_errmsg(self->handle) : "out of memory";
    switch (code) {
    case SQLITE_NOMEM: return camber_fail(set->context, CAMBER_ERROR_MEMORY, "%s: SQLite is out of memory", set->name);
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        return camber_fail(set->context, CAMBER_ERROR_IO,
                           "%s: cannot be read: %s; check its permissions, and who writes "
                           "to it",
                           set->name, said);
    case SQLITE_NOTADB:
        return camber_fail(set->context, CAMBER_ERROR_INPUT, "%s: no MBTiles: %s; name such a file, or get it again",
                           set->name, said);
    case SQLITE_INTERRUPT:
        return camber_fail(set->context, CAMBER_ERROR_INPUT,
                           "%s: a query takes too long; make an index on tiles (zoom_level, tile_column, tile_row)",
                           set->name);
    default:
        return camber_fail(set->context, CAMBER_ERROR_INPUT, "%s: damaged or cut off: %s; get the file again",
                           set->name, said);
    }
}

static camber_status prepare(camber_tile_set *set, const char *sql, sqlite3_stmt **statement) {
    database *self = set->self;
    self->calls = 0;
    return sqlite3_prepare_v2(self->handle, sql, -1, statement, NULL) == SQLITE_OK ? CAMBER_OK : fail(set);
}

/* ---- What it tells of itself ---- */

static void take_row(json_t *about, sqlite3_stmt *row) {
    const char *name = (const char *)sqlite3_column_text(row, 0), *value = (const char *)sqlite3_column_text(row, 1);
    if (!name || !value)
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

/* Sets without the table are read all the same. */
static camber_status read_metadata(camber_tile_set *set) {
    database *self = set->self;
    sqlite3_stmt *rows = NULL;
    if (sqlite3_prepare_v2(self->handle, "SELECT name, value FROM metadata", -1, &rows, NULL) != SQLITE_OK)
        return sqlite3_errcode(self->handle) == SQLITE_ERROR ? CAMBER_OK : fail(set);
    self->calls = 0;
    self->most_calls = MOST_METADATA_CALLS;
    json_t *about = json_object();
    int step;
    while ((step = sqlite3_step(rows)) == SQLITE_ROW)
        take_row(about, rows);
    camber_status status = step == SQLITE_DONE ? CAMBER_OK : fail(set);
    sqlite3_finalize(rows);
    self->most_calls = MOST_CALLS;
    if (status == CAMBER_OK)
        status = camber_tile_set_describe(set, about);
    const char *format = json_string_value(json_object_get(about, "format"));
    if (status == CAMBER_OK && format && strcmp(format, "pbf") != 0 && strcmp(format, "mvt") != 0 &&
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

static camber_status get_tile(camber_tile_set *set, int zoom, camber_tile_place place, camber_bytes *bytes,
                              const char **why) {
    (void)why;
    database *self = set->self;
    self->calls = 0;
    bytes->size_bytes = 0;
    sqlite3_bind_int(self->get, 1, zoom);
    sqlite3_bind_int64(self->get, 2, place.column);
    sqlite3_bind_int64(self->get, 3, ((sqlite3_int64)1 << zoom) - 1 - place.row);
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

static camber_status list_tiles(camber_tile_set *set, int zoom, camber_tile_place **places, size_t *count) {
    sqlite3_stmt *rows = NULL;
    camber_tile_place *made = NULL;
    size_t found = 0, capacity = 0;
    const int64_t side = INT64_C(1) << zoom;
    camber_status status = prepare(set,
                                   "SELECT tile_column, tile_row FROM tiles WHERE zoom_level = ? "
                                   "ORDER BY tile_column, tile_row",
                                   &rows);
    if (status != CAMBER_OK)
        return status;
    sqlite3_bind_int(rows, 1, zoom);
    int step;
    while (status == CAMBER_OK && (step = sqlite3_step(rows)) != SQLITE_DONE) {
        if (step != SQLITE_ROW) {
            status = fail(set);
            break;
        }
        const int64_t column = sqlite3_column_int64(rows, 0), row = side - 1 - sqlite3_column_int64(rows, 1);
        if (column < 0 || column >= side || row < 0 || row >= side ||
            (found && made[found - 1].column == column && made[found - 1].row == row))
            continue;
        if (!camber_grow(set->context, &made, &capacity, found + 1, sizeof *made))
            status = CAMBER_ERROR_MEMORY;
        else
            made[found++] = (camber_tile_place){(uint32_t)column, (uint32_t)row};
    }
    sqlite3_finalize(rows);
    if (status != CAMBER_OK) {
        camber_free(set->context, made);
        return status;
    }
    *places = made;
    *count = found;
    return CAMBER_OK;
}

static void close_database(camber_tile_set *set) {
    database *self = set->self;
    sqlite3_finalize(self->get);
    sqlite3_close(self->handle);
    camber_free(set->context, self);
}

static const camber_tile_set_calls database_calls = {get_tile, list_tiles, close_database};

static camber_status check_file(const camber_tile_set *set, const char *path) {
    struct stat about;
    if (stat(path, &about) != 0) {
        const int cause = errno;
        return camber_fail(set->context, cause == ENOENT || cause == ENOTDIR ? CAMBER_ERROR_NOT_FOUND : CAMBER_ERROR_IO,
                           "%s: cannot be read: %s; check the path and its permissions", set->name, strerror(cause));
    }
    if (about.st_size == 0)
        return camber_fail(set->context, CAMBER_ERROR_INPUT, "%s: the file is empty; get it again", set->name);
    return CAMBER_OK;
}

camber_status camber_mbtiles_open(camber_tile_set *set, const char *path) {
    camber_status status = check_file(set, path);
    database *self = status == CAMBER_OK ? camber_alloc_zero(set->context, 1, sizeof *self) : NULL;
    if (!self)
        return status == CAMBER_OK ? CAMBER_ERROR_MEMORY : status;
    set->self = self;
    set->calls = &database_calls;
    set->min_zoom = set->max_zoom = -1;
    if (sqlite3_open_v2(path, &self->handle, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, NULL) != SQLITE_OK)
        return fail(set);
    sqlite3_progress_handler(self->handle, STEPS_A_CALL, count_steps, self);
    sqlite3_limit(self->handle, SQLITE_LIMIT_LENGTH, LARGEST_BLOB_BYTES);
    sqlite3_db_config(self->handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
    status = read_metadata(set);
    if (status == CAMBER_OK)
        status = prepare(set, "SELECT tile_data FROM tiles WHERE zoom_level = ? AND tile_column = ? AND tile_row = ?",
                         &self->get);
    if (status == CAMBER_OK && (set->min_zoom < 0 || set->max_zoom < set->min_zoom))
        status = find_zooms(set);
    return status;
}
