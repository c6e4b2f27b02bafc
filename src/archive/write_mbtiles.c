/* Writes normalised MBTiles 1.3: the table images has each content once, the table map has the tiles, and the view
 * tiles joins the two.
 *
 * Rows are inserted in the order of tile numbers, so that equal tiles make equal files. Each transaction inserts many
 * rows. Indices are created at the end. SQLite keeps no journal, because the file gets its name only after it is
 * complete and synced. */
#include "archive/output_file.h"
#include "archive/pmtiles.h"
#include "archive/writer.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>

enum { ROWS_A_BATCH = 100000, MOST_TILES = 1 << 28 };

typedef struct writing {
    const camber_archive_plan *plan;
    sqlite3 *handle;
    sqlite3_stmt *put_image, *put_tile;
    uint32_t *ids; /* by content: its id; ids are in the order of the contents' first tiles; 0: not written yet */
    uint32_t image_count;
    uint64_t row_count;
    camber_bytes bytes;
} writing;

static const char BEFORE[] =
    "PRAGMA page_size = 4096; PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; PRAGMA application_id = 1297105496;"
    "CREATE TABLE metadata (name TEXT, value TEXT);"
    "CREATE TABLE images (tile_id TEXT, tile_data BLOB);"
    "CREATE TABLE map (zoom_level INTEGER, tile_column INTEGER, tile_row INTEGER, tile_id TEXT);"
    "CREATE VIEW tiles AS SELECT map.zoom_level AS zoom_level, map.tile_column AS tile_column, map.tile_row AS "
    "tile_row, images.tile_data AS tile_data FROM map JOIN images ON images.tile_id = map.tile_id;"
    "BEGIN";
static const char BATCH[] = "COMMIT; BEGIN";
static const char AFTER[] = "CREATE UNIQUE INDEX metadata_index ON metadata (name);"
                            "CREATE UNIQUE INDEX images_index ON images (tile_id);"
                            "CREATE UNIQUE INDEX map_index ON map (zoom_level, tile_column, tile_row);"
                            "COMMIT";

static camber_status fail(const writing *w) {
    const camber_archive_plan *plan = w->plan;
    const int code = w->handle ? sqlite3_extended_errcode(w->handle) : SQLITE_NOMEM;
    const int cause = w->handle ? sqlite3_system_errno(w->handle) : 0;
    if (code == SQLITE_NOMEM)
        return camber_fail(plan->context, CAMBER_ERROR_MEMORY, "%s: SQLite ran out of memory; allow more",
                           plan->desc->path);
    if ((code & 0xff) == SQLITE_FULL)
        return camber_output_fail(plan->context, plan->whole, cause == EFBIG ? EFBIG : ENOSPC);
    if (cause)
        return camber_output_fail(plan->context, plan->whole, cause);
    return camber_fail(plan->context, CAMBER_ERROR_IO, "%s: cannot be written: %s; write elsewhere", plan->whole,
                       sqlite3_errmsg(w->handle));
}

static camber_status run(const writing *w, const char *sql) {
    return sqlite3_exec(w->handle, sql, NULL, NULL, NULL) == SQLITE_OK ? CAMBER_OK : fail(w);
}

/* ---- Metadata ---- */

static void put_text(json_t *metadata, const char *name, const char *text) {
    json_object_set_new(metadata, name, json_string(text));
}

void camber_archive_put_texts(const camber_archive_plan *plan, json_t *metadata) {
    char text[128];
    const double *b = plan->bounds;
    put_text(metadata, "format", camber_tile_type_get_format(plan->desc->type));
    snprintf(text, sizeof text, "%.7f,%.7f,%.7f,%.7f", b[0], b[1], b[2], b[3]);
    put_text(metadata, "bounds", text);
    snprintf(text, sizeof text, "%.7f,%.7f,%d", plan->center.longitude, plan->center.latitude, plan->center.zoom);
    put_text(metadata, "center", text);
    snprintf(text, sizeof text, "%d", plan->min_zoom);
    put_text(metadata, "minzoom", text);
    snprintf(text, sizeof text, "%d", plan->max_zoom);
    put_text(metadata, "maxzoom", text);
    if (!json_object_get(metadata, "name"))
        put_text(metadata, "name", "tiles");
}

static camber_status put_row(const writing *w, sqlite3_stmt *put, const char *name, const char *value) {
    sqlite3_bind_text(put, 1, name, -1, SQLITE_TRANSIENT);
    sqlite3_bind_text(put, 2, value, -1, SQLITE_TRANSIENT);
    const camber_status status = sqlite3_step(put) == SQLITE_DONE ? CAMBER_OK : fail(w);
    sqlite3_reset(put);
    return status;
}

/* Moves the layers and statistics of vector tiles into one text with JSON, as MBTiles requires. */
static void fold_layers(json_t *metadata) {
    static const char *const names[] = {"vector_layers", "tilestats"};
    json_t *inner = json_object();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (json_object_get(metadata, names[i])) {
            json_object_set(inner, names[i], json_object_get(metadata, names[i]));
            json_object_del(metadata, names[i]);
        }
    if (json_object_size(inner))
        json_object_set(metadata, "json", inner);
    json_decref(inner);
}

static camber_status put_metadata(const writing *w, json_t *metadata) {
    sqlite3_stmt *put = NULL;
    camber_status status = CAMBER_OK;
    const char *name;
    json_t *value;
    if (sqlite3_prepare_v2(w->handle, "INSERT INTO metadata VALUES (?, ?)", -1, &put, NULL) != SQLITE_OK)
        return fail(w);
    fold_layers(metadata);
    camber_archive_put_texts(w->plan, metadata);
    /* Names are sorted, so that equal metadata make equal files. */
    char *text = json_dumps(metadata, JSON_SORT_KEYS);
    json_t *again = text ? json_loads(text, 0, NULL) : NULL;
    free(text);
    json_object_foreach(again, name, value) {
        char *dumped =
            json_is_string(value) ? NULL : json_dumps(value, JSON_COMPACT | JSON_ENCODE_ANY | JSON_SORT_KEYS);
        if (status == CAMBER_OK)
            status = put_row(w, put, name, dumped ? dumped : json_string_value(value));
        free(dumped);
    }
    json_decref(again);
    sqlite3_finalize(put);
    return status;
}

/* ---- Tiles ---- */

static camber_status next_row(writing *w) {
    return ++w->row_count % ROWS_A_BATCH == 0 ? run(w, BATCH) : CAMBER_OK;
}

static camber_status put_image(writing *w, uint32_t content) {
    const camber_content *item = &w->plan->contents->items[content];
    char id[16];
    if (!camber_bytes_resize(&w->bytes, item->size_bytes))
        return CAMBER_ERROR_MEMORY;
    camber_status status =
        camber_contents_read(w->plan->contents, item->store, item->offset, w->bytes.data, item->size_bytes);
    if (status != CAMBER_OK)
        return status;
    w->ids[content] = ++w->image_count;
    snprintf(id, sizeof id, "%u", w->ids[content]);
    sqlite3_bind_text(w->put_image, 1, id, -1, SQLITE_TRANSIENT);
    sqlite3_bind_blob64(w->put_image, 2, w->bytes.data, item->size_bytes, SQLITE_STATIC);
    status = sqlite3_step(w->put_image) == SQLITE_DONE ? next_row(w) : fail(w);
    sqlite3_reset(w->put_image);
    return status;
}

static camber_status put_tile(writing *w, uint64_t number, uint32_t content) {
    const int zoom = camber_archive_zoom(number);
    uint32_t column, row;
    char id[16];
    camber_pmtiles_locate(number - camber_archive_first(zoom), zoom, &column, &row);
    snprintf(id, sizeof id, "%u", w->ids[content]);
    sqlite3_bind_int(w->put_tile, 1, zoom);
    sqlite3_bind_int64(w->put_tile, 2, column);
    sqlite3_bind_int64(w->put_tile, 3, (sqlite3_int64)((INT64_C(1) << zoom) - 1 - row)); /* rows count from the south */
    sqlite3_bind_text(w->put_tile, 4, id, -1, SQLITE_TRANSIENT);
    const camber_status status = sqlite3_step(w->put_tile) == SQLITE_DONE ? next_row(w) : fail(w);
    sqlite3_reset(w->put_tile);
    return status;
}

static camber_status put_tiles(writing *w) {
    const camber_archive_plan *plan = w->plan;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < plan->run_count && status == CAMBER_OK; i++) {
        const camber_archive_run *run = &plan->runs[i];
        if (w->ids[run->content] == 0)
            status = put_image(w, run->content);
        for (uint64_t k = 0; k < run->length && status == CAMBER_OK; k++)
            status = put_tile(w, run->number + k, run->content);
        camber_progress_count(plan->context, "writing tiles", "entries", i, plan->run_count);
    }
    return status;
}

static camber_status write_rows(writing *w) {
    json_t *metadata = json_copy(w->plan->metadata);
    camber_status status = run(w, BEFORE);
    if (status == CAMBER_OK)
        status = put_metadata(w, metadata);
    json_decref(metadata);
    if (status == CAMBER_OK &&
        (sqlite3_prepare_v2(w->handle, "INSERT INTO images VALUES (?, ?)", -1, &w->put_image, NULL) != SQLITE_OK ||
         sqlite3_prepare_v2(w->handle, "INSERT INTO map VALUES (?, ?, ?, ?)", -1, &w->put_tile, NULL) != SQLITE_OK))
        status = fail(w);
    if (status == CAMBER_OK)
        status = put_tiles(w);
    sqlite3_finalize(w->put_image);
    sqlite3_finalize(w->put_tile);
    return status == CAMBER_OK ? run(w, AFTER) : status;
}

camber_status camber_archive_write_mbtiles(const camber_archive_plan *plan) {
    writing w = {.plan = plan, .bytes.context = plan->context};
    /* The runs of a malicious archive could expand to an endless number of rows. */
    if (plan->tile_count > MOST_TILES)
        return camber_fail(plan->context, CAMBER_ERROR_LIMIT,
                           "%s: %" PRIu64 " tiles are too many rows for MBTiles, which may have %d; write PMTiles",
                           plan->desc->path, plan->tile_count, MOST_TILES);
    w.ids = camber_alloc_zero(plan->context, plan->contents->count, sizeof *w.ids);
    if (!w.ids)
        return CAMBER_ERROR_MEMORY;
    const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
    camber_status status =
        sqlite3_open_v2(plan->whole, &w.handle, flags, NULL) == SQLITE_OK ? write_rows(&w) : fail(&w);
    if (sqlite3_close(w.handle) != SQLITE_OK && status == CAMBER_OK)
        status = fail(&w);
    camber_bytes_free(&w.bytes);
    camber_free(plan->context, w.ids);
    if (status != CAMBER_OK)
        return status;
    const int file = open(plan->whole, O_RDWR | O_CLOEXEC);
    return file < 0 ? camber_output_fail(plan->context, plan->whole, errno)
                    : camber_sync_and_close(plan->context, plan->whole, file);
}
