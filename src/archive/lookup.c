/* Looks tiles up in an archive, one at a time, as a server does.
 *
 * Input: a path, then tile addresses. Output: bytes as they are stored. PMTiles and MBTiles are read through the reader
 * of vector tiles; a file in a folder is found by its name. Each look-up starts with the full budget of steps, because
 * the number of look-ups by a server has no limit. */
#define _XOPEN_SOURCE 700

#include "archive/archive.h"
#include "archive/folder.h"

#include "camber_tiles.h"

#include <stdio.h>
#include <stdlib.h>

struct camber_tiles_reader {
    camber_context *context;
    camber_archive *archive;
    camber_tiles_info info;
    char *metadata;
    camber_bytes bytes;
    char *file_bytes; /* the bytes of the tile's file in a folder */
};

/* ---- The type of a folder without metadata ---- */

static camber_status take_file(void *user, const camber_folder_file *file) {
    camber_archive *archive = user;
    archive->type = camber_tile_type_find(file->extension);
    archive->gzipped = archive->type == CAMBER_TILE_MVT;
    return CAMBER_ERROR_LIMIT; /* stops, because one tile is enough */
}

static camber_status find_type(camber_tiles_reader *reader) {
    camber_archive *archive = reader->archive;
    const camber_folder_visitor visitor = {reader->context, take_file, NULL, archive};
    if (archive->format != CAMBER_ARCHIVE_FOLDER || archive->type != CAMBER_TILE_OTHER)
        return CAMBER_OK;
    archive->max_zoom = CAMBER_LARGEST_TILE_ZOOM;
    const camber_status status = camber_folder_visit(archive->path, &visitor);
    if (archive->type == CAMBER_TILE_OTHER && status == CAMBER_OK)
        return camber_fail(reader->context, CAMBER_ERROR_INPUT,
                           "%s: contains no tiles; name a folder with {z}/{x}/{y}.png or the like", archive->path);
    return archive->type != CAMBER_TILE_OTHER ? CAMBER_OK : status;
}

/* ---- The reader ---- */

static camber_status describe(camber_tiles_reader *reader) {
    static const char *const formats[] = {"pmtiles", "mbtiles", "folder"};
    const camber_archive *archive = reader->archive;
    if (!(reader->metadata = json_dumps(archive->metadata, JSON_SORT_KEYS | JSON_COMPACT)))
        return camber_fail(reader->context, CAMBER_ERROR_MEMORY, "%s: not enough memory for the metadata; allow more",
                           archive->path);
    reader->info = (camber_tiles_info){
        .format = formats[archive->format],
        .type = camber_tile_type_get_name(archive->type),
        .compression = archive->gzipped ? "gzip" : "none",
        .min_zoom = archive->min_zoom,
        .max_zoom = archive->max_zoom,
        .has_bounds = archive->has_bounds,
        .has_center = archive->center.given,
        .center = {archive->center.longitude, archive->center.latitude, (double)archive->center.zoom},
        .metadata = reader->metadata,
        .fingerprint = archive->fingerprint,
        .shard = archive->shard,
        .shards = archive->shards};
    memcpy(reader->info.bounds, archive->bounds, sizeof reader->info.bounds);
    return CAMBER_OK;
}

camber_status camber_tiles_reader_create(camber_context *context, const char *path, camber_tiles_reader **reader) {
    camber_tiles_reader *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = made->bytes.context = context;
    camber_budget_begin(context);
    camber_status status = camber_archive_open(context, path, &made->archive);
    if (status == CAMBER_OK)
        status = find_type(made);
    if (status == CAMBER_OK)
        status = camber_archive_sniff(made->archive);
    if (status == CAMBER_OK)
        status = describe(made);
    if (status == CAMBER_OK)
        *reader = made;
    else
        camber_tiles_reader_destroy(made);
    return status;
}

void camber_tiles_reader_destroy(camber_tiles_reader *reader) {
    if (!reader)
        return;
    camber_archive_close(reader->archive);
    camber_bytes_free(&reader->bytes);
    camber_free(reader->context, reader->file_bytes);
    free(reader->metadata);
    camber_free(reader->context, reader);
}

const camber_tiles_info *camber_tiles_reader_get_info(const camber_tiles_reader *reader) {
    return &reader->info;
}

/* ---- Tiles ---- */

static camber_status read_file(camber_tiles_reader *reader, const camber_tiles_place *place, size_t *size_bytes) {
    char name[64];
    *size_bytes = 0;
    camber_free(reader->context, reader->file_bytes);
    reader->file_bytes = NULL;
    snprintf(name, sizeof name, "%d/%u/%u.%s", place->zoom, place->column, place->row,
             camber_tile_type_get_name(reader->archive->type));
    const camber_status status =
        camber_read_file_below(reader->context, reader->archive->path, name, &reader->file_bytes, size_bytes);
    return status == CAMBER_ERROR_NOT_FOUND ? CAMBER_OK : status; /* the tile does not exist */
}

camber_status camber_tiles_reader_read(camber_tiles_reader *reader, const camber_tiles_place *place,
                                       const uint8_t **bytes, size_t *size_bytes) {
    size_t size = 0;
    const char *why = NULL;
    camber_status status = CAMBER_OK;
    const int zoom = place->zoom;
    if (zoom < 0 || zoom > CAMBER_LARGEST_TILE_ZOOM || place->column >> zoom || place->row >> zoom)
        return camber_fail(reader->context, CAMBER_ERROR_ARGUMENT, "tiles: there is no tile %d/%u/%u", zoom,
                           place->column, place->row);
    camber_tile_set *set = reader->archive->set;
    camber_budget_begin(reader->context);
    if (!set) {
        status = read_file(reader, place, &size);
    } else {
        reader->bytes.size_bytes = 0;
        status = set->calls->get(set, zoom, (camber_tile_index){place->column, place->row}, &reader->bytes, &why);
        size = reader->bytes.size_bytes;
    }
    if (status == CAMBER_OK && why)
        return camber_fail(reader->context, CAMBER_ERROR_INPUT,
                           "%s: tile %d/%u/%u: %s; check the archive with camber tiles verify", reader->archive->path,
                           zoom, place->column, place->row, why);
    if (status != CAMBER_OK)
        return status;
    *bytes = set ? reader->bytes.data : (const uint8_t *)reader->file_bytes;
    *size_bytes = size;
    return CAMBER_OK;
}
