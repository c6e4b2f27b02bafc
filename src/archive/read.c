/* Reads archives of tiles: their metadata, and their tiles one after the other.
 *
 * PMTiles and MBTiles are read by the readers of vector tiles (tile_set.h), which this file asks for tiles of any type.
 * Metadata are converted to one form: the values that each format stores differently (bounds, centre, zooms, format)
 * become fields of the archive. */
#define _XOPEN_SOURCE 700

#include "archive/archive.h"
#include "archive/folder.h"
#include "archive/pmtiles.h"
#include "archive/tile_check.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- Metadata ---- */

static bool read_numbers(const char *text, size_t count, double *numbers) {
    for (size_t i = 0; text && i < count; i++) {
        char *end;
        numbers[i] = strtod(text, &end);
        if (end == text || *end != (i + 1 < count ? ',' : 0) || !isfinite(numbers[i]))
            return false;
        text = end + 1;
    }
    return text != NULL;
}

static const char *text_of(const json_t *about, const char *name) {
    return json_string_value(json_object_get(about, name));
}

/* Reads the texts that MBTiles and folders have instead of a header. */
static void take_texts(camber_archive *archive) {
    const json_t *about = archive->metadata;
    double center[3];
    const char *format = text_of(about, "format"), *low = text_of(about, "minzoom"), *high = text_of(about, "maxzoom");
    archive->type = format ? camber_tile_type_find(format) : CAMBER_TILE_OTHER;
    archive->gzipped = archive->type == CAMBER_TILE_MVT;
    archive->has_bounds = read_numbers(text_of(about, "bounds"), 4, archive->bounds);
    archive->min_zoom = low ? atoi(low) : archive->set ? archive->set->min_zoom : 0;
    archive->max_zoom = high ? atoi(high) : archive->set ? archive->set->max_zoom : 0;
    if (read_numbers(text_of(about, "center"), 3, center))
        archive->center = (camber_archive_center){true, center[0], center[1], (int)center[2]};
}

static void take_header(camber_archive *archive) {
    const camber_pmtiles_header header = camber_pmtiles_get_file(archive->set).header;
    const char *format = text_of(archive->metadata, "format");
    archive->type = header.tile_type <= CAMBER_TILE_MLT ? (camber_tile_type)header.tile_type : CAMBER_TILE_OTHER;
    if (archive->type == CAMBER_TILE_OTHER && format && camber_tile_type_find(format) == CAMBER_TILE_GLB)
        archive->type = CAMBER_TILE_GLB;
    archive->gzipped = header.tile_compression == CAMBER_PMTILES_GZIP;
    archive->min_zoom = header.min_zoom;
    archive->max_zoom = header.max_zoom;
    archive->has_bounds = true;
    for (size_t i = 0; i < 4; i++)
        archive->bounds[i] = header.bounds[i] * 1e-7;
    archive->center =
        (camber_archive_center){true, header.center[0] * 1e-7, header.center[1] * 1e-7, header.center_zoom};
}

/* MBTiles stores only texts; texts that contain JSON are parsed. */
static void parse_member(json_t *about, const char *name, bool into_itself) {
    const char *text = text_of(about, name);
    json_t *inner = text ? json_loads(text, 0, NULL) : NULL;
    if (json_is_object(inner) && into_itself) {
        json_object_update_missing(about, inner);
        json_object_del(about, name);
    } else if (json_is_object(inner)) {
        json_object_set(about, name, inner);
    }
    json_decref(inner);
}

static camber_status take_origin(camber_archive *archive) {
    const json_t *origin = json_object_get(archive->metadata, "camber");
    const char *fingerprint = text_of(origin, "fingerprint"), *shard = text_of(origin, "shard");
    const char *checksum = text_of(origin, "checksum");
    const json_t *zoom = json_object_get(origin, "center_zoom");
    unsigned part, parts;
    archive->whole_center_zoom = archive->center.zoom;
    if (checksum && strlen(checksum) == sizeof archive->checksum - 1)
        memcpy(archive->checksum, checksum, sizeof archive->checksum);
    if (fingerprint && !(archive->fingerprint = camber_copy_string(archive->context, fingerprint)))
        return CAMBER_ERROR_MEMORY;
    if (shard && sscanf(shard, "%9u/%9u", &part, &parts) == 2 && part >= 1 && part <= parts) {
        archive->shard = part;
        archive->shards = parts;
        if (json_is_integer(zoom))
            archive->whole_center_zoom = (int)json_integer_value(zoom);
    }
    return CAMBER_OK;
}

static camber_status take_metadata(camber_archive *archive) {
    static const char *const told[] = {"format", "bounds", "center", "minzoom", "maxzoom", "camber"};
    if (archive->format == CAMBER_ARCHIVE_MBTILES) {
        parse_member(archive->metadata, "json", true);
        parse_member(archive->metadata, "camber", false);
    }
    if (archive->format == CAMBER_ARCHIVE_PMTILES)
        take_header(archive);
    else
        take_texts(archive);
    const camber_status status = take_origin(archive);
    for (size_t i = 0; i < sizeof told / sizeof *told; i++)
        json_object_del(archive->metadata, told[i]);
    return status;
}

/* ---- Opening ---- */

static camber_status read_folder(camber_archive *archive) {
    char *bytes = NULL;
    size_t size_bytes = 0;
    const camber_status status =
        camber_read_file_below(archive->context, archive->path, "metadata.json", &bytes, &size_bytes);
    if (status != CAMBER_OK)
        return status == CAMBER_ERROR_NOT_FOUND ? CAMBER_OK : status;
    archive->metadata = json_loadb(bytes, size_bytes, 0, NULL);
    camber_free(archive->context, bytes);
    return CAMBER_OK;
}

static camber_status open_archive(camber_archive *archive) {
    struct stat about;
    if (!camber_archive_get_format(archive->path, &archive->format))
        return camber_fail(archive->context, CAMBER_ERROR_INPUT,
                           "%s: not an archive of tiles; name a .pmtiles file, an .mbtiles file or a folder",
                           archive->path);
    if (archive->format == CAMBER_ARCHIVE_FOLDER && stat(archive->path, &about) != 0)
        return camber_file_fail(archive->context, archive->path, errno);
    camber_status status =
        archive->format == CAMBER_ARCHIVE_FOLDER
            ? read_folder(archive)
            : camber_tile_set_open_any(archive->context, archive->path, CAMBER_NAMED_BY_CALLER, &archive->set);
    if (status != CAMBER_OK)
        return status;
    if (archive->set)
        archive->metadata = json_incref(archive->set->about);
    if (!json_is_object(archive->metadata)) {
        json_decref(archive->metadata);
        archive->metadata = json_object();
    }
    return archive->metadata ? take_metadata(archive) : CAMBER_ERROR_MEMORY;
}

camber_status camber_archive_open(camber_context *context, const char *path, camber_archive **archive) {
    camber_archive *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->path = camber_copy_string(context, path);
    size_t length = made->path ? strlen(path) : 0;
    while (length > 1 && path[length - 1] == '/')
        made->path[--length] = 0;
    const camber_status status = made->path ? open_archive(made) : CAMBER_ERROR_MEMORY;
    if (status != CAMBER_OK) {
        camber_archive_close(made);
        return status;
    }
    *archive = made;
    return CAMBER_OK;
}

void camber_archive_close(camber_archive *archive) {
    if (!archive)
        return;
    camber_tile_set_close(archive->set);
    json_decref(archive->metadata);
    camber_free(archive->context, archive->fingerprint);
    camber_free(archive->context, archive->path);
    camber_free(archive->context, archive);
}

/* ---- Tiles ---- */

typedef struct archive_walk {
    camber_archive *archive;
    camber_status (*take_tile)(void *user, const camber_archive_tile *tile);
    void *user;
} archive_walk;

static camber_status take_entry(void *user, const camber_pmtiles_entry *entry) {
    const archive_walk *walk = user;
    camber_archive_tile tile = {.number = entry->number,
                                .run_length = entry->run_length,
                                .offset = entry->offset,
                                .size_bytes = entry->size,
                                .zoom = camber_archive_zoom(entry->number)};
    uint32_t column, row;
    camber_pmtiles_locate(entry->number - camber_archive_first(tile.zoom), tile.zoom, &column, &row);
    tile.column = column;
    tile.row = row;
    return walk->take_tile(walk->user, &tile);
}

/* Computes the tile's number from its address as the archive stores it. */
static void number_tile(camber_archive_tile *tile, bool south_first) {
    const int64_t side = tile->zoom >= 0 && tile->zoom <= CAMBER_LARGEST_TILE_ZOOM ? INT64_C(1) << tile->zoom : 0;
    tile->run_length = 1;
    tile->outside = tile->column < 0 || tile->column >= side || tile->row < 0 || tile->row >= side;
    if (!tile->outside)
        tile->number = camber_pmtiles_number(tile->zoom, (uint32_t)tile->column,
                                             (uint32_t)(south_first ? side - 1 - tile->row : tile->row));
}

static camber_status take_row(void *user, sqlite3_stmt *row) {
    const archive_walk *walk = user;
    camber_archive_tile tile = {.column = sqlite3_column_int64(row, 1), .row = sqlite3_column_int64(row, 2)};
    const int64_t zoom = sqlite3_column_int64(row, 0);
    tile.zoom = zoom >= 0 && zoom < 100 ? (int)zoom : 99;
    tile.bytes = sqlite3_column_blob(row, 3);
    tile.size_bytes = (uint64_t)sqlite3_column_bytes(row, 3);
    if (!tile.bytes && tile.size_bytes)
        return CAMBER_ERROR_MEMORY;
    if (!tile.bytes)
        tile.bytes = (const unsigned char *)"";
    number_tile(&tile, true);
    return walk->take_tile(walk->user, &tile);
}

static camber_status take_file(void *user, const camber_folder_file *file) {
    const archive_walk *walk = user;
    char *bytes = NULL;
    size_t size_bytes;
    camber_status status = camber_read_file_below(walk->archive->context, walk->archive->path,
                                                  file->path + strlen(walk->archive->path) + 1, &bytes, &size_bytes);
    if (status == CAMBER_ERROR_NOT_FOUND)
        return camber_file_fail(walk->archive->context, file->path, ENOENT);
    if (status != CAMBER_OK)
        return status;
    camber_archive_tile tile = {.zoom = (int)file->zoom,
                                .column = file->column,
                                .row = file->row,
                                .bytes = (const unsigned char *)bytes,
                                .size_bytes = size_bytes};
    number_tile(&tile, false);
    /* If a folder has no metadata, the extension of its files shows the type. */
    if (walk->archive->type == CAMBER_TILE_OTHER)
        walk->archive->type = camber_tile_type_find(file->extension);
    status = walk->take_tile(walk->user, &tile);
    camber_free(walk->archive->context, bytes);
    return status;
}

camber_status camber_archive_walk(camber_archive *archive,
                                  camber_status (*take_tile)(void *user, const camber_archive_tile *tile), void *user) {
    archive_walk walk = {archive, take_tile, user};
    const camber_pmtiles_visitor visitor = {0, UINT64_MAX, take_entry, NULL, &walk};
    const camber_folder_visitor files = {archive->context, take_file, NULL, &walk};
    switch (archive->format) {
    case CAMBER_ARCHIVE_PMTILES: return camber_pmtiles_walk(archive->set, &visitor);
    case CAMBER_ARCHIVE_MBTILES:
        return camber_mbtiles_query(archive->set, "SELECT zoom_level, tile_column, tile_row, tile_data FROM tiles",
                                    take_row, &walk, NULL);
    case CAMBER_ARCHIVE_FOLDER: break;
    }
    return camber_folder_visit(archive->path, &files);
}

typedef struct sniffing {
    camber_archive *archive;
    bool done;
} sniffing;

/* Returns an error in order to end the walk, because one tile is enough. */
static camber_status sniff_tile(void *user, const camber_archive_tile *tile) {
    sniffing *self = user;
    camber_archive *archive = self->archive;
    camber_bytes bytes = {.context = archive->context};
    const char *why = NULL;
    self->done = tile->size_bytes > CAMBER_ARCHIVE_LARGEST_TILE_BYTES;
    if (self->done)
        return CAMBER_ERROR_LIMIT;
    const camber_status status = camber_archive_read(archive, tile, &bytes, &why);
    self->done = status == CAMBER_OK;
    if (self->done && !why) {
        archive->type = camber_tile_sniff(bytes.data, bytes.size_bytes);
        archive->gzipped = archive->type == CAMBER_TILE_MVT && bytes.data[0] == 0x1f;
    }
    camber_bytes_free(&bytes);
    return self->done ? CAMBER_ERROR_LIMIT : status;
}

camber_status camber_archive_sniff(camber_archive *archive) {
    sniffing self = {archive, false};
    if (archive->type != CAMBER_TILE_OTHER)
        return CAMBER_OK;
    const camber_status status = camber_archive_walk(archive, sniff_tile, &self);
    archive->sniffed = archive->type != CAMBER_TILE_OTHER;
    if (archive->format !=
        CAMBER_ARCHIVE_PMTILES) /* MBTiles and folders: uncompressed tiles are compressed while they are taken */
        archive->gzipped = archive->type == CAMBER_TILE_MVT;
    return self.done ? CAMBER_OK : status;
}

camber_status camber_archive_read(camber_archive *archive, const camber_archive_tile *tile, camber_bytes *bytes,
                                  const char **why) {
    *why = NULL;
    if (!tile->bytes) {
        const camber_pmtiles_entry entry = {tile->number, tile->run_length, tile->offset, tile->size_bytes};
        return camber_pmtiles_read_entry(archive->set, &entry, bytes, why);
    }
    if (!camber_bytes_resize(bytes, (size_t)tile->size_bytes))
        return CAMBER_ERROR_MEMORY;
    memcpy(bytes->data, tile->bytes, (size_t)tile->size_bytes);
    return CAMBER_OK;
}
