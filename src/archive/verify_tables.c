/* Verifies MBTiles files and folders: tables, indices, metadata, names, tilesets, and each tile. */
#define _XOPEN_SOURCE 700

#include "archive/folder.h"
#include "archive/tileset.h"
#include "archive/verify.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include <unistd.h>

/* ---- Tiles ---- */

static camber_status take_tile(void *user, const camber_archive_tile *tile) {
    camber_verify *v = user;
    char name[80];
    snprintf(name, sizeof name, "%d/%" PRId64 "/%" PRId64, tile->zoom, tile->column, tile->row);
    if (tile->outside) {
        camber_verify_tell(v, CAMBER_VERIFY_PLACE, true, "tile %s does not exist: its zoom has no such column or row",
                           name);
        v->tally.entries++;
        return CAMBER_OK;
    }
    camber_verify_bounds(v, tile);
    camber_progress_count(v->context, "verifying", "tiles", v->tally.tiles, 0);
    const char *why;
    camber_status status = camber_archive_read(v->archive, tile, &v->bytes, &why);
    if (status == CAMBER_OK)
        status = camber_verify_bytes(v, name, &v->bytes);
    return status == CAMBER_OK ? camber_tally_take(&v->tally, tile) : status;
}

static void check_twice(camber_verify *v) {
    camber_tally_sum(&v->tally, v->archive->format);
    for (size_t i = 1; i < v->tally.place_count; i++) {
        char name[40];
        if (v->tally.places[i].number != v->tally.places[i - 1].number)
            continue;
        camber_verify_name(v->tally.places[i].number, name);
        camber_verify_tell(v, CAMBER_VERIFY_ORDER, true, "tile %s (rows from the north) occurs twice", name);
    }
}

/* ---- MBTiles ---- */

typedef struct tables {
    camber_verify *v;
    bool has_index, has_format, has_name, has_bounds, has_zooms;
    bool normal;   /* it has the tables images and map */
    uint64_t *ids; /* hashes of the ids in the table images, and after them of the ids in map */
    size_t count, capacity;
} tables;

static const char *text_at(sqlite3_stmt *row, int column) {
    const char *text = (const char *)sqlite3_column_text(row, column);
    return text ? text : "";
}

/* Looks for an index on the three columns of the table tiles, or of the table map if tiles is a view. */
static camber_status take_schema(void *user, sqlite3_stmt *row) {
    tables *t = user;
    const char *type = text_at(row, 0), *table = text_at(row, 1), *sql = text_at(row, 2);
    const bool of_tiles = strcasecmp(table, "tiles") == 0 || strcasecmp(table, "map") == 0;
    char upper[8];
    snprintf(upper, sizeof upper, "%.6s", strlen(sql) > 7 ? sql + 7 : "");
    if (strcmp(type, "index") == 0 && of_tiles && (!*sql || strcasecmp(upper, "UNIQUE") == 0))
        t->has_index = true; /* an index without SQL belongs to a primary key or to UNIQUE */
    return CAMBER_OK;
}

static camber_status take_metadata(void *user, sqlite3_stmt *row) {
    tables *t = user;
    camber_verify *v = t->v;
    static const char *const known[] = {"pbf", "png", "jpg", "webp"};
    const char *name = text_at(row, 0), *value = text_at(row, 1);
    double b[4];
    if (strcmp(name, "name") == 0)
        t->has_name = true;
    if (strcmp(name, "minzoom") == 0)
        t->has_zooms = true;
    if (strcmp(name, "bounds") == 0) {
        t->has_bounds = true;
        if (sscanf(value, "%lf,%lf,%lf,%lf", b, b + 1, b + 2, b + 3) != 4)
            camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "bounds in the metadata are not four numbers");
    }
    if (strcmp(name, "format") == 0) {
        bool found = strchr(value, '/') != NULL; /* a media type */
        t->has_format = true;
        for (size_t i = 0; i < sizeof known / sizeof *known; i++)
            found = found || strcmp(value, known[i]) == 0;
        if (!found)
            camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, false,
                               "format %.40s is neither pbf, png, jpg or webp nor a media type", value);
    }
    return CAMBER_OK;
}

static camber_status take_double(void *user, sqlite3_stmt *row) {
    const tables *t = user;
    camber_verify_tell(t->v, CAMBER_VERIFY_ARCHIVE, true, "%.80s occurs twice in the metadata", text_at(row, 0));
    return CAMBER_OK;
}

static camber_status take_id(void *user, sqlite3_stmt *row) {
    tables *t = user;
    const char *id = text_at(row, 0);
    if (!camber_grow(t->v->context, &t->ids, &t->capacity, t->count + 1, sizeof *t->ids))
        return CAMBER_ERROR_MEMORY;
    t->ids[t->count++] = camber_hash(CAMBER_HASH_START, id, strlen(id));
    return CAMBER_OK;
}

static int compare_ids(const void *left, const void *right) {
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return a < b ? -1 : a > b;
}

static bool has_id(const uint64_t *ids, size_t count, uint64_t id) {
    return count && bsearch(&id, ids, count, sizeof *ids, compare_ids) != NULL;
}

/* Checks a normalised file: each image must belong to a tile, and each tile must have its image. */
static camber_status check_images(tables *t) {
    bool missing = false;
    camber_tile_set *set = t->v->archive->set;
    camber_status status = camber_mbtiles_query(set, "SELECT tile_id FROM images", take_id, t, &missing);
    const size_t images = t->count;
    if (status == CAMBER_OK && !missing)
        status = camber_mbtiles_query(set, "SELECT tile_id FROM map", take_id, t, &missing);
    if (status != CAMBER_OK || missing)
        return status;
    uint64_t *used = t->ids + images;
    const size_t uses = t->count - images;
    size_t unused = 0, lost = 0, again = 0;
    if (images)
        qsort(t->ids, images, sizeof *t->ids, compare_ids);
    if (uses)
        qsort(used, uses, sizeof *used, compare_ids);
    for (size_t i = 0; i < images; i++) {
        unused += !has_id(used, uses, t->ids[i]);
        again += i && t->ids[i] == t->ids[i - 1];
    }
    for (size_t i = 0; i < uses; i++)
        lost += !has_id(t->ids, images, used[i]);
    if (again)
        camber_verify_tell(t->v, CAMBER_VERIFY_ARCHIVE, true, "%zu ids of images occur twice", again);
    if (unused)
        camber_verify_tell(t->v, CAMBER_VERIFY_ARCHIVE, false, "%zu images belong to no tile", unused);
    if (lost)
        camber_verify_tell(t->v, CAMBER_VERIFY_ARCHIVE, true, "%zu tiles have no image", lost);
    return CAMBER_OK;
}

static camber_status check_tables(tables *t) {
    camber_verify *v = t->v;
    camber_tile_set *set = v->archive->set;
    bool missing = false;
    camber_status status =
        camber_mbtiles_query(set, "SELECT type, tbl_name, sql FROM sqlite_master", take_schema, t, NULL);
    if (status == CAMBER_OK && !t->has_index)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, false,
                           "no unique index finds tiles (zoom_level, tile_column, tile_row); reading them is slow");
    if (status == CAMBER_OK)
        status = camber_mbtiles_query(set, "SELECT name, value FROM metadata", take_metadata, t, &missing);
    if (status != CAMBER_OK)
        return status;
    if (missing) {
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "there is no table metadata (name, value)");
        return CAMBER_OK;
    }
    if (!t->has_name || !t->has_format)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, true, "the metadata have no %s", t->has_name ? "format" : "name");
    if (!t->has_bounds || !t->has_zooms)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, false, "the metadata have no %s",
                           t->has_bounds ? "minzoom" : "bounds");
    return camber_mbtiles_query(set, "SELECT name FROM metadata GROUP BY name HAVING count(*) > 1", take_double, t,
                                NULL);
}

camber_status camber_verify_mbtiles(camber_verify *v) {
    tables t = {.v = v};
    camber_status status = check_tables(&t);
    if (status == CAMBER_OK)
        status = check_images(&t);
    if (status == CAMBER_OK)
        status = camber_archive_walk(v->archive, take_tile, v);
    if (status == CAMBER_OK)
        check_twice(v);
    camber_free(v->context, t.ids);
    return status;
}

/* ---- Tilesets ---- */

typedef struct tileset {
    camber_verify *v;
    bool is_left;    /* tileset.json is missing, or is not camber's, so subtrees are not checked */
    uint64_t *names; /* hashes of the names of subtrees */
    size_t count, capacity;
} tileset;

/* Reports a tileset.json that is not the one that camber would write for these tiles. */
static void check_root(tileset *t, const char *found, size_t size_bytes, bool same) {
    json_t *read = same ? NULL : json_loadb(found, size_bytes, JSON_REJECT_DUPLICATES, NULL);
    t->is_left = !same;
    if (!same)
        camber_verify_tell(t->v, CAMBER_VERIFY_TILESET, !read, "tileset.json %s",
                           read ? "is not the one that camber tiles writes; subtrees are not checked" : "is not JSON");
    json_decref(read);
}

/* Compares a file of the tileset with the one that the tiles require. */
static camber_status compare_file(void *user, const char *name, const void *bytes, size_t size_bytes) {
    tileset *t = user;
    const bool is_root = t->count == 0 && strcmp(name, "tileset.json") == 0;
    char *found = NULL;
    size_t found_bytes = 0;
    if (t->is_left)
        return CAMBER_OK;
    if (!is_root) {
        if (!camber_grow(t->v->context, &t->names, &t->capacity, t->count + 1, sizeof *t->names))
            return CAMBER_ERROR_MEMORY;
        const char *own = strchr(name, '/') + 1;
        t->names[t->count++] = camber_hash(CAMBER_HASH_START, own, strlen(own));
    }
    const camber_status status = camber_read_file_below(t->v->context, t->v->archive->path, name, &found, &found_bytes);
    if (status == CAMBER_ERROR_NOT_FOUND) {
        t->is_left = is_root;
        camber_verify_tell(t->v, CAMBER_VERIFY_TILESET, !is_root, "%s is missing%s", name,
                           is_root ? ": viewers of 3D Tiles find no tiles" : ", and with it the tiles that it lists");
        return CAMBER_OK;
    }
    if (status != CAMBER_OK)
        return status;
    const bool same = found_bytes == size_bytes && memcmp(found, bytes, size_bytes) == 0;
    if (is_root)
        check_root(t, found, found_bytes, same);
    else if (!same)
        camber_verify_tell(t->v, CAMBER_VERIFY_TILESET, true, "%s does not list the tiles that exist", name);
    camber_free(t->v->context, found);
    return CAMBER_OK;
}

/* Reports subtrees that have no tiles. */
static camber_status check_others(tileset *t) {
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s/subtrees", t->v->archive->path) >= (int)sizeof path)
        return camber_file_fail(t->v->context, t->v->archive->path, ENAMETOOLONG);
    DIR *opened = opendir(path);
    const struct dirent *entry;
    if (t->count)
        qsort(t->names, t->count, sizeof *t->names, compare_ids);
    while (opened && (entry = readdir(opened)) != NULL) {
        const uint64_t hash = camber_hash(CAMBER_HASH_START, entry->d_name, strlen(entry->d_name));
        if (entry->d_name[0] != '.' && !has_id(t->names, t->count, hash))
            camber_verify_tell(t->v, CAMBER_VERIFY_TILESET, true, "subtrees/%.80s lists no tile", entry->d_name);
    }
    if (opened)
        closedir(opened);
    return CAMBER_OK;
}

/* Compares the tileset with the one that the tiles require. The tally is sorted. */
static camber_status check_tileset(camber_verify *v) {
    tileset t = {.v = v};
    const camber_tally_place *places = v->tally.places;
    camber_archive_run *runs = camber_alloc(v->context, v->tally.place_count, sizeof *runs);
    camber_archive_plan plan = {.context = v->context, .runs = runs, .metadata = v->archive->metadata};
    if (!runs)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < v->tally.place_count; i++)
        if (plan.run_count && runs[plan.run_count - 1].number + runs[plan.run_count - 1].length >= places[i].number)
            runs[plan.run_count - 1].length = places[i].number + 1 - runs[plan.run_count - 1].number;
        else
            runs[plan.run_count++] = (camber_archive_run){.number = places[i].number, .length = 1};
    plan.max_zoom = camber_archive_zoom(places[v->tally.place_count - 1].number);
    camber_status status = camber_tileset_write(&plan, compare_file, &t);
    if (status == CAMBER_OK && !t.is_left)
        status = check_others(&t);
    camber_free(v->context, t.names);
    camber_free(v->context, runs);
    return status;
}

/* ---- Folders ---- */

static camber_status take_file(void *user, const camber_folder_file *file) {
    camber_verify *v = user;
    const char *extension = camber_tile_type_get_name(v->archive->type);
    if (v->archive->type != CAMBER_TILE_OTHER && strcmp(file->extension, extension) != 0 &&
        camber_tile_type_find(file->extension) != v->archive->type)
        camber_verify_tell(v, CAMBER_VERIFY_NAME, true, "%s: does not have the name of a tile of type %s", file->path,
                           extension);
    return CAMBER_OK;
}

static camber_status take_stranger(void *user, const char *path) {
    camber_verify_tell(user, CAMBER_VERIFY_NAME, true,
                       "%s: does not have the name of a tile, ZOOM/COLUMN/ROW.EXTENSION", path);
    return CAMBER_OK;
}

camber_status camber_verify_folder(camber_verify *v) {
    const camber_folder_visitor names = {v->context, take_file, take_stranger, v, v->archive->type == CAMBER_TILE_GLB};
    if (!json_object_size(v->archive->metadata) && !v->archive->has_bounds)
        camber_verify_tell(v, CAMBER_VERIFY_ARCHIVE, false, "there is no metadata.json with a JSON object");
    camber_status status = camber_folder_visit(v->archive->path, &names);
    if (status == CAMBER_OK)
        status = camber_archive_walk(v->archive, take_tile, v);
    if (status == CAMBER_OK)
        check_twice(v);
    return status == CAMBER_OK && v->archive->type == CAMBER_TILE_GLB && v->tally.place_count ? check_tileset(v)
                                                                                              : status;
}
