/* Counts what an archive contains and shows the numbers: tiles and bytes by zoom, entries, distinct contents.
 *
 * Input: the tiles of a walk. In PMTiles, a content is a range of the file that several tiles may share, so ranges are
 * collected and sorted. Memory: 24 bytes per entry. */
#include "archive/tally.h"

#include "archive/tile_schema.h"
#include "camber_tiles.h"

#include <sqlite3.h>
#include <stdlib.h>

/* Adds the tiles of a run to the counts of their zooms. A damaged run may extend past the last zoom, where there are no
 * tiles. */
static void count_run(camber_tally *tally, uint64_t number, uint64_t length) {
    for (int zoom = camber_archive_zoom(number); length && zoom <= CAMBER_LARGEST_TILE_ZOOM; zoom++) {
        const uint64_t room = camber_archive_first(zoom + 1) - number, taken = length < room ? length : room;
        tally->zoom_tiles[zoom] += taken;
        tally->tiles += taken;
        number += taken;
        length -= taken;
    }
}

camber_status camber_tally_take(camber_tally *tally, const camber_archive_tile *tile) {
    tally->entries++;
    if (tile->outside)
        return CAMBER_OK;
    count_run(tally, tile->number, tile->run_length);
    if (!camber_grow(tally->context, &tally->places, &tally->place_capacity, tally->place_count + 1,
                     sizeof *tally->places))
        return CAMBER_ERROR_MEMORY;
    tally->places[tally->place_count++] = (camber_tally_place){tile->offset, tile->size_bytes, tile->number};
    return CAMBER_OK;
}

static int compare_places(const void *left, const void *right) {
    const camber_tally_place *a = left, *b = right;
    if (a->offset != b->offset)
        return a->offset < b->offset ? -1 : 1;
    if (a->size_bytes != b->size_bytes)
        return a->size_bytes < b->size_bytes ? -1 : 1;
    return a->number < b->number ? -1 : a->number > b->number;
}

static int compare_numbers(const void *left, const void *right) {
    const camber_tally_place *a = left, *b = right;
    return a->number < b->number ? -1 : a->number > b->number;
}

void camber_tally_sum(camber_tally *tally, camber_archive_format format) {
    const bool shared = format == CAMBER_ARCHIVE_PMTILES;
    size_t kept = 0;
    if (tally->place_count)
        qsort(tally->places, tally->place_count, sizeof *tally->places, shared ? compare_places : compare_numbers);
    for (size_t i = 0; i < tally->place_count; i++) {
        const camber_tally_place *place = &tally->places[i];
        const camber_tally_place *last = kept ? &tally->places[kept - 1] : NULL;
        if (shared && last && last->offset == place->offset && last->size_bytes == place->size_bytes)
            continue;
        const int zoom = camber_archive_zoom(place->number);
        if (!shared || !last || last->offset != place->offset)
            tally->contents++;
        if (zoom <= CAMBER_LARGEST_TILE_ZOOM)
            tally->zoom_bytes[zoom] += place->size_bytes;
        tally->places[kept++] = *place;
    }
    tally->place_count = kept;
}

void camber_tally_free(camber_tally *tally) {
    camber_free(tally->context, tally->places);
}

/* ---- Showing ---- */

typedef struct shown {
    camber_tiles_info info; /* the part that is visible to the caller */
    camber_context *context;
    camber_archive *archive;
    char *metadata;
    camber_tiles_zoom zooms[CAMBER_LARGEST_TILE_ZOOM + 1];
} shown;

static camber_status take_tile(void *user, const camber_archive_tile *tile) {
    return camber_tally_take(user, tile);
}

static camber_status count_row(void *user, sqlite3_stmt *row) {
    (void)row;
    ++*(uint64_t *)user;
    return CAMBER_OK;
}

/* Counts the images of a normalised MBTiles file, which stores each content once. */
static camber_status count_images(camber_archive *archive, uint64_t *contents) {
    uint64_t count = 0;
    bool missing = false;
    if (archive->format != CAMBER_ARCHIVE_MBTILES)
        return CAMBER_OK;
    const camber_status status =
        camber_mbtiles_query(archive->set, "SELECT tile_id FROM images", count_row, &count, &missing);
    if (status == CAMBER_OK && !missing)
        *contents = count;
    return status;
}

static camber_status fill(shown *s) {
    static const char *const formats[] = {"pmtiles", "mbtiles", "folder"};
    camber_archive *archive = s->archive;
    camber_tally tally = {.context = s->context};
    camber_status status = camber_archive_walk(archive, take_tile, &tally);
    if (status == CAMBER_OK)
        camber_tally_sum(&tally, archive->format);
    if (status == CAMBER_OK)
        status = count_images(archive, &tally.contents);
    s->metadata = json_dumps(archive->metadata, JSON_COMPACT);
    s->info = (camber_tiles_info){.format = formats[archive->format],
                                  .type = camber_tile_type_get_name(archive->type),
                                  .compression = archive->gzipped ? "gzip" : "none",
                                  .min_zoom = archive->min_zoom,
                                  .max_zoom = archive->max_zoom,
                                  .tiles = tally.tiles,
                                  .entries = tally.entries,
                                  .contents = tally.contents,
                                  .has_bounds = archive->has_bounds,
                                  .has_center = archive->center.given,
                                  .center = {archive->center.longitude, archive->center.latitude, archive->center.zoom},
                                  .metadata = s->metadata,
                                  .fingerprint = archive->fingerprint,
                                  .shard = archive->shard,
                                  .shards = archive->shards,
                                  .zooms = s->zooms};
    s->info.schema = camber_tile_schema_of_layers(json_object_get(archive->metadata, "vector_layers"));
    memcpy(s->info.bounds, archive->bounds, sizeof s->info.bounds);
    for (int zoom = 0; zoom <= CAMBER_LARGEST_TILE_ZOOM; zoom++)
        if (tally.zoom_tiles[zoom])
            s->zooms[s->info.zoom_count++] = (camber_tiles_zoom){zoom, tally.zoom_tiles[zoom], tally.zoom_bytes[zoom]};
    camber_tally_free(&tally);
    if (status == CAMBER_OK && !s->metadata)
        return camber_fail(s->context, CAMBER_ERROR_MEMORY, "%s: not enough memory for the metadata; allow more",
                           archive->path);
    return status;
}

camber_status camber_tiles_show(camber_context *context, const char *path, camber_tiles_info **info) {
    shown *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    camber_budget_begin(context);
    camber_status status = camber_archive_open(context, path, &made->archive);
    if (status == CAMBER_OK)
        status = fill(made);
    if (status != CAMBER_OK) {
        camber_tiles_info_destroy(&made->info);
        return status;
    }
    *info = &made->info;
    return CAMBER_OK;
}

void camber_tiles_info_destroy(camber_tiles_info *info) {
    shown *s = (shown *)(void *)info; /* info is its first member */
    if (!s)
        return;
    camber_archive_close(s->archive);
    free(s->metadata);
    camber_free(s->context, s);
}
