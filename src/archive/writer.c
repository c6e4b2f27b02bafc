/* The writer of archives: accepts tiles in any order, and writes them in one order.
 *
 * Two files next to the archive collect the tiles: one has their bytes, each content once, and the other is a journal
 * of finished units. After the last tile was added, the tiles are sorted by number (by zoom, then along the Hilbert
 * curve), and runs are joined. A function for the format then writes the archive to a third path next to it, which is
 * renamed to the archive's path. A PMTiles archive whose tiles arrived in order is not written again: the first file
 * becomes the archive, and the third path is only a second name for it. */
#define _DEFAULT_SOURCE /* flock */
#define _FILE_OFFSET_BITS 64

#include "archive/writer.h"
#include "archive/checksum.h"
#include "archive/folder.h"
#include "archive/output_file.h"
#include "archive/pmtiles.h"
#include "archive/units.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <strings.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { TEMPORARY_TILES = 0, TEMPORARY_UNITS, TEMPORARY_WHOLE, TEMPORARY_COUNT };

typedef struct taken_archive {
    const char *path;
    uint32_t first_order;
} taken_archive;

struct camber_archive_writer {
    camber_context *context;
    camber_archive_desc desc; /* the writer owns its strings */
    char *path, *fingerprint;
    json_t *metadata;
    char *temporary_paths[TEMPORARY_COUNT];
    int tiles; /* a descriptor, which holds the lock; negative: not open */
    camber_contents contents;
    camber_units units;
    camber_archive_runs added, taken;
    taken_archive *archives;
    size_t archive_count, archive_capacity;
    uint64_t removed; /* how many tiles of the taken archives the finished archive lacks */
    bool done, keeps; /* keeps: a unit was finished, so the temporary files stay */
};

/* ---- Names ---- */

bool camber_archive_temporary_path(const char *path, size_t n, char *name, size_t size) {
    static const char *const endings[TEMPORARY_COUNT] = {".camber-tiles", ".camber-units", ".camber-whole"};
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/')
        length--;
    return n < TEMPORARY_COUNT && snprintf(name, size, "%.*s%s", (int)length, path, endings[n]) < (int)size;
}

/* ---- Opening ---- */

static bool leads_to(const char *name, int file) {
    struct stat opened, there;
    return fstat(file, &opened) == 0 && stat(name, &there) == 0 && opened.st_ino == there.st_ino &&
           opened.st_dev == there.st_dev;
}

/* Whether the locked file of tiles has already become the archive, which happens if a run is killed at its very end. If
 * so, removes the file's temporary name. */
static bool is_archive(const camber_archive_writer *writer, int file) {
    struct stat opened;
    (void)unlink(writer->temporary_paths[TEMPORARY_WHOLE]);
    return fstat(file, &opened) != 0 || opened.st_nlink > 1 || leads_to(writer->path, file);
}

/* Opens and locks the file of tiles. Between the two steps, another writer that had the lock may have removed the
 * file. */
static camber_status open_locked(camber_archive_writer *writer) {
    const char *name = writer->temporary_paths[TEMPORARY_TILES];
    for (int attempt = 0; attempt < 100; attempt++) {
        const int file = open(name, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file < 0)
            return camber_output_fail(writer->context, name, errno);
        if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            close(file);
            return camber_fail(writer->context, CAMBER_ERROR_IO,
                               "%s: another process is writing it; wait for that, or name another file", writer->path);
        }
        const bool same = leads_to(name, file);
        if (same && !is_archive(writer, file)) {
            writer->tiles = file;
            writer->keeps = writer->desc.resume; /* until the file has been examined */
            return CAMBER_OK;
        }
        close(file);
        if (same && unlink(name) != 0 && errno != ENOENT)
            return camber_output_fail(writer->context, name, errno);
    }
    return camber_output_fail(writer->context, name, EBUSY);
}

/* Opens temporary files that are left from a run that was killed just after it completed its archive. The next writer
 * that finds them removes them. */
static void open_leftovers(camber_archive_writer *writer) {
    camber_saved_log kept;
    struct stat about;
    if (stat(writer->temporary_paths[TEMPORARY_TILES], &about) != 0 &&
        stat(writer->temporary_paths[TEMPORARY_UNITS], &about) != 0)
        return;
    camber_log_demote_errors(writer->context, &kept);
    (void)open_locked(writer); /* if another process is writing them, they are in use */
    camber_log_restore(writer->context, &kept);
    writer->keeps = false;
}

static camber_status fail_existing(camber_archive_writer *writer, const camber_archive *there) {
    char names[256] = "fingerprint";
    if (there->fingerprint && writer->fingerprint)
        camber_fingerprint_compare(there->fingerprint, writer->fingerprint, names, sizeof names);
    return camber_fail(writer->context, CAMBER_ERROR_INPUT,
                       "%s: exists, and differs in its %s; name another file, or replace it with --force", writer->path,
                       names);
}

/* Checks that a folder contains nothing but an archive of tiles, because everything in the folder is replaced. */
static camber_status look_at_folder(camber_archive_writer *writer, const struct stat *about) {
    struct stat leads_to;
    if (S_ISLNK(about->st_mode) && stat(writer->path, &leads_to) == 0 && S_ISDIR(leads_to.st_mode))
        return camber_fail(writer->context, CAMBER_ERROR_IO, "%s: is a link to a folder; name the folder itself",
                           writer->path);
    return S_ISDIR(about->st_mode) ? camber_folder_may_go(writer->context, writer->path) : CAMBER_OK;
}

/* Decides what to do about an archive that exists at the path. */
static camber_status look_at_existing(camber_archive_writer *writer) {
    struct stat about;
    const camber_archive_desc *desc = &writer->desc;
    camber_archive *there = NULL;
    camber_saved_log kept;
    if (lstat(writer->path, &about) != 0)
        return CAMBER_OK;
    camber_status status = look_at_folder(writer, &about);
    if (status != CAMBER_OK || (desc->force && !desc->resume))
        return status;
    if (!desc->resume)
        return camber_fail(writer->context, CAMBER_ERROR_IO,
                           "%s: exists; name another file, or replace it with --force", writer->path);
    camber_log_demote_errors(writer->context, &kept);
    status = camber_archive_open(writer->context, writer->path, &there);
    camber_log_restore(writer->context, &kept);
    if (status == CAMBER_OK)
        writer->done = writer->fingerprint && there->fingerprint &&
                       strcmp(writer->fingerprint, there->fingerprint) == 0 && there->shard == desc->shard &&
                       there->shards == desc->shards;
    if (status == CAMBER_OK && !writer->done && !desc->force)
        status = fail_existing(writer, there);
    else if (status != CAMBER_OK && !desc->force)
        status = camber_fail(
            writer->context, CAMBER_ERROR_INPUT,
            "%s: exists, and is not an archive of tiles; name another file, or replace it with --force", writer->path);
    else
        status = CAMBER_OK;
    camber_archive_close(there);
    return status;
}

static camber_status put_tile(camber_archive_writer *writer, uint64_t number, uint32_t content) {
    camber_archive_runs *runs = &writer->added;
    if (runs->count >= UINT32_MAX)
        return camber_fail(writer->context, CAMBER_ERROR_LIMIT, "%s: more than 4,294,967,295 tiles; write shards",
                           writer->path);
    if (!camber_grow(writer->context, &runs->items, &runs->capacity, runs->count + 1, sizeof *runs->items))
        return CAMBER_ERROR_MEMORY;
    runs->items[runs->count] = (camber_archive_run){number, 1, content, (uint32_t)runs->count};
    runs->count++;
    return CAMBER_OK;
}

static camber_status take_resumed(void *user, uint64_t number, uint32_t content) {
    return put_tile(user, number, content);
}

static camber_status open_units(camber_archive_writer *writer) {
    char key[1024];
    camber_units *units = &writer->units;
    const camber_archive_desc *desc = &writer->desc;
    snprintf(key, sizeof key, "%s type=%d.%d shard=%u/%u", writer->fingerprint ? writer->fingerprint : "",
             (int)desc->type, desc->gzipped, desc->shard, desc->shards);
    units->context = writer->context;
    units->name = writer->temporary_paths[TEMPORARY_UNITS];
    units->descriptor = open(units->name, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (units->descriptor < 0)
        return camber_output_fail(writer->context, units->name, errno);
    if (desc->resume) {
        const camber_unit_taker taker = {take_resumed, writer};
        const camber_status status = camber_units_resume(units, key, &writer->contents, &taker);
        writer->keeps = status != CAMBER_OK || units->done_count;
        return status;
    }
    if (ftruncate(writer->tiles, 0) != 0)
        return camber_output_fail(writer->context, writer->temporary_paths[TEMPORARY_TILES], errno);
    return camber_units_begin(units, key);
}

static camber_status copy_desc(camber_archive_writer *writer, const camber_archive_desc *desc) {
    camber_context *context = writer->context;
    size_t length = strlen(desc->path);
    writer->desc = *desc;
    writer->path = camber_copy_string(context, desc->path);
    writer->fingerprint = writer->path && desc->fingerprint ? camber_copy_string(context, desc->fingerprint) : NULL;
    writer->metadata = desc->metadata ? json_deep_copy(desc->metadata) : json_object();
    if (!writer->path || (desc->fingerprint && !writer->fingerprint) || !writer->metadata)
        return CAMBER_ERROR_MEMORY;
    while (length > 1 && writer->path[length - 1] == '/')
        writer->path[--length] = 0;
    for (size_t i = 0; i < TEMPORARY_COUNT; i++) {
        char name[4096];
        if (!camber_archive_temporary_path(writer->path, i, name, sizeof name))
            return camber_output_fail(context, writer->path, ENAMETOOLONG);
        if (!(writer->temporary_paths[i] = camber_copy_string(context, name)))
            return CAMBER_ERROR_MEMORY;
    }
    writer->desc.path = writer->path;
    writer->desc.fingerprint = writer->fingerprint;
    writer->desc.metadata = writer->metadata;
    return CAMBER_OK;
}

camber_status camber_archive_writer_create(camber_context *context, const camber_archive_desc *desc,
                                           camber_archive_writer **writer) {
    camber_archive_writer *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->tiles = made->units.descriptor = -1;
    camber_status status = copy_desc(made, desc);
    if (status == CAMBER_OK)
        status = look_at_existing(made);
    if (status == CAMBER_OK && made->done)
        open_leftovers(made);
    else if (status == CAMBER_OK)
        status = open_locked(made);
    if (status == CAMBER_OK && !made->done)
        status = camber_contents_init(&made->contents, context, made->tiles, made->temporary_paths[TEMPORARY_TILES]);
    if (status == CAMBER_OK && !made->done)
        status = open_units(made);
    if (status != CAMBER_OK) {
        camber_archive_writer_destroy(made);
        return status;
    }
    *writer = made;
    return CAMBER_OK;
}

void camber_archive_writer_destroy(camber_archive_writer *writer) {
    if (!writer)
        return;
    camber_context *context = writer->context;
    if (writer->tiles >= 0 && !writer->keeps) {
        unlink(writer->temporary_paths[TEMPORARY_UNITS]);
        unlink(writer->temporary_paths[TEMPORARY_TILES]);
    }
    if (writer->units.descriptor >= 0)
        close(writer->units.descriptor);
    if (writer->tiles >= 0)
        close(writer->tiles); /* releases the lock */
    camber_units_free(&writer->units);
    camber_contents_free(&writer->contents);
    camber_free(context, writer->added.items);
    camber_free(context, writer->taken.items);
    camber_free(context, writer->archives);
    for (size_t i = 0; i < TEMPORARY_COUNT; i++)
        camber_free(context, writer->temporary_paths[i]);
    json_decref(writer->metadata);
    camber_free(context, writer->fingerprint);
    camber_free(context, writer->path);
    camber_free(context, writer);
}

/* ---- Tiles ---- */

bool camber_archive_writer_is_done(const camber_archive_writer *writer) {
    return writer->done;
}

bool camber_archive_writer_has_unit(const camber_archive_writer *writer, uint64_t unit) {
    return camber_units_has(&writer->units, unit);
}

camber_status camber_archive_writer_add(camber_archive_writer *writer, int zoom, camber_tile_index tile,
                                        const void *bytes, size_t size_bytes) {
    uint32_t content = CAMBER_NO_CONTENT;
    const uint64_t number = camber_pmtiles_number(zoom, tile.column, tile.row);
    if (size_bytes == 0 || size_bytes > CAMBER_ARCHIVE_LARGEST_TILE_BYTES)
        return camber_fail(writer->context, CAMBER_ERROR_LIMIT,
                           "%s: tile %d/%u/%u has %zu bytes; a tile must have 1 to %d", writer->path, zoom, tile.column,
                           tile.row, size_bytes, CAMBER_ARCHIVE_LARGEST_TILE_BYTES);
    camber_status status = camber_contents_put(&writer->contents, bytes, size_bytes, &content);
    if (status == CAMBER_OK)
        status = put_tile(writer, number, content);
    if (status != CAMBER_OK)
        return status;
    const camber_content *item = &writer->contents.items[content];
    const camber_unit_record record = {CAMBER_UNIT_TILE, item->size_bytes, number, item->offset, item->hash};
    return camber_units_add(&writer->units, &record);
}

camber_status camber_archive_writer_remove(camber_archive_writer *writer, int zoom, camber_tile_index tile) {
    const uint64_t number = camber_pmtiles_number(zoom, tile.column, tile.row);
    const camber_unit_record record = {.kind = CAMBER_UNIT_REMOVED, .number = number};
    const camber_status status = put_tile(writer, number, CAMBER_NO_CONTENT);
    return status == CAMBER_OK ? camber_units_add(&writer->units, &record) : status;
}

camber_status camber_archive_writer_end_unit(camber_archive_writer *writer, uint64_t unit) {
    const camber_status status = camber_contents_flush(&writer->contents);
    if (status != CAMBER_OK)
        return status;
    writer->keeps = true;
    return camber_units_end(&writer->units, unit, writer->contents.written_bytes);
}

/* ---- Other archives ---- */

/* An entry of PMTiles to be taken. Entries are sorted by offset, so that the file is read from start to end. */
typedef struct taken_entry {
    uint64_t offset, number, run_length;
    uint32_t size_bytes;
} taken_entry;

typedef struct taking {
    camber_archive_writer *writer;
    camber_archive *archive;
    taken_entry *entries;
    size_t count, capacity;
    uint32_t store;
    camber_bytes plain, packed; /* a tile whose compression differs from the archive's */
    camber_checksum checksum;   /* the checksum of a part's tiles */
    camber_bytes window;        /* bytes of the file's tiles, from window_offset on */
    uint64_t window_offset, tiles_bytes;
} taking;

static camber_status fail_tile(const taking *t, const camber_archive_tile *tile, const char *why) {
    return camber_fail(t->writer->context, CAMBER_ERROR_INPUT,
                       "%s: damaged or cut off: tile %d/%" PRId64 "/%" PRId64 " %s; get the file again",
                       t->archive->path, tile->zoom, tile->column, tile->row, why);
}

static camber_status take_run(taking *t, const taken_entry *entry, uint32_t content) {
    camber_archive_runs *runs = &t->writer->taken;
    if (!camber_grow(t->writer->context, &runs->items, &runs->capacity, runs->count + 1, sizeof *runs->items))
        return CAMBER_ERROR_MEMORY;
    runs->items[runs->count] = (camber_archive_run){entry->number, entry->run_length, content, (uint32_t)runs->count};
    runs->count++;
    return CAMBER_OK;
}

/* Compresses a tile with gzip, unless it already is. The vector tiles in MBTiles and folders should be compressed with
 * gzip, but some tools write uncompressed tiles or use zlib's header. */
static camber_status pack(taking *t, const camber_archive_tile *tile, camber_bytes *bytes) {
    const unsigned char *b = tile->bytes;
    const size_t size_bytes = (size_t)tile->size_bytes;
    const char *why = NULL;
    *bytes = (camber_bytes){.data = (unsigned char *)(uintptr_t)b, .size_bytes = size_bytes};
    if (!t->writer->desc.gzipped || (size_bytes > 1 && b[0] == 0x1f && b[1] == 0x8b))
        return CAMBER_OK;
    camber_bytes from = *bytes;
    if (size_bytes > 1 && b[0] == 0x78 && (b[0] * 256 + b[1]) % 31 == 0) {
        camber_tile_set naming = {.context = t->writer->context, .name = t->archive->path};
        const camber_status status =
            camber_tile_set_gunzip(&naming, &from, CAMBER_ARCHIVE_LARGEST_TILE_BYTES, &t->plain, &why);
        if (status != CAMBER_OK || why)
            return status != CAMBER_OK ? status : fail_tile(t, tile, why);
        from = t->plain;
    }
    t->packed.size_bytes = 0;
    const camber_status status = camber_archive_gzip(t->writer->path, from.data, from.size_bytes, &t->packed);
    *bytes = t->packed;
    return status;
}

static camber_status take_bytes(taking *t, const camber_archive_tile *tile) {
    uint32_t content;
    camber_bytes bytes;
    if (tile->outside)
        return fail_tile(t, tile, "is outside its zoom");
    if (tile->size_bytes == 0 || tile->size_bytes > CAMBER_ARCHIVE_LARGEST_TILE_BYTES)
        return fail_tile(t, tile, "is empty or larger than 64 MB");
    if (t->archive->shards &&
        !camber_checksum_add(&t->checksum, camber_content_hash(tile->bytes, (size_t)tile->size_bytes)))
        return CAMBER_ERROR_MEMORY;
    camber_status status = pack(t, tile, &bytes);
    if (status == CAMBER_OK)
        status = camber_contents_put(&t->writer->contents, bytes.data, bytes.size_bytes, &content);
    const taken_entry entry = {.number = tile->number, .run_length = 1};
    return status == CAMBER_OK ? take_run(t, &entry, content) : status;
}

static camber_status take_tile(void *user, const camber_archive_tile *tile) {
    taking *t = user;
    if (tile->bytes || tile->outside)
        return take_bytes(t, tile);
    const uint64_t end = camber_archive_first(CAMBER_LARGEST_TILE_ZOOM + 1);
    if (tile->number >= end || tile->run_length > end - tile->number)
        return fail_tile(t, tile, "is beyond zoom 24");
    if (tile->size_bytes == 0 || tile->size_bytes > CAMBER_ARCHIVE_LARGEST_TILE_BYTES)
        return fail_tile(t, tile, "is empty or larger than 64 MB");
    if (tile->offset > t->tiles_bytes || tile->size_bytes > t->tiles_bytes - tile->offset)
        return fail_tile(t, tile, "ends past the end of the tiles");
    if (!camber_grow(t->writer->context, &t->entries, &t->capacity, t->count + 1, sizeof *t->entries))
        return CAMBER_ERROR_MEMORY;
    t->entries[t->count++] = (taken_entry){tile->offset, tile->number, tile->run_length, (uint32_t)tile->size_bytes};
    return CAMBER_OK;
}

static int compare_entries(const void *left, const void *right) {
    const taken_entry *a = left, *b = right;
    if (a->offset != b->offset)
        return a->offset < b->offset ? -1 : 1;
    return a->size_bytes < b->size_bytes ? -1 : a->size_bytes > b->size_bytes;
}

/* Moves the window so that it contains the entry's bytes and those after them. */
static camber_status move_window(taking *t, const taken_entry *entry) {
    enum { WINDOW = 1 << 20 };
    const uint64_t end = t->window_offset + t->window.size_bytes, left = t->tiles_bytes - entry->offset;
    if (t->window.data && entry->offset >= t->window_offset && entry->offset + entry->size_bytes <= end)
        return CAMBER_OK;
    uint64_t size = entry->size_bytes > WINDOW ? entry->size_bytes : WINDOW;
    size = size < left ? size : left;
    if (!camber_bytes_resize(&t->window, (size_t)size))
        return CAMBER_ERROR_MEMORY;
    t->window_offset = entry->offset;
    return camber_contents_read(&t->writer->contents, t->store, entry->offset, t->window.data, (size_t)size);
}

static camber_status take_content(taking *t, const taken_entry *entry, uint32_t *content) {
    camber_contents *contents = &t->writer->contents;
    camber_status status = move_window(t, entry);
    if (status != CAMBER_OK)
        return status;
    const unsigned char *bytes = t->window.data + (entry->offset - t->window_offset);
    const uint64_t hash = camber_content_hash(bytes, entry->size_bytes);
    if (t->archive->shards && !camber_checksum_add(&t->checksum, hash))
        return CAMBER_ERROR_MEMORY;
    status = camber_contents_find(contents, bytes, entry->size_bytes, hash, content);
    if (status != CAMBER_OK || *content != CAMBER_NO_CONTENT)
        return status;
    const camber_content made = {hash, entry->offset, entry->size_bytes, t->store};
    return camber_contents_note(contents, &made, content);
}

static camber_status take_entries(taking *t) {
    const camber_pmtiles_file file = camber_pmtiles_get_file(t->archive->set);
    camber_status status = camber_contents_add_store(&t->writer->contents, file.descriptor, file.header.tiles.offset,
                                                     t->archive->path, &t->store);
    if (t->count)
        qsort(t->entries, t->count, sizeof *t->entries, compare_entries);
    uint32_t content = CAMBER_NO_CONTENT;
    for (size_t i = 0; i < t->count && status == CAMBER_OK; i++) {
        const taken_entry *entry = &t->entries[i];
        if (i == 0 || compare_entries(entry - 1, entry) != 0)
            status = take_content(t, entry, &content);
        if (status == CAMBER_OK)
            status = take_run(t, entry, content);
    }
    return status;
}

/* Compares the checksum that a shard states with the sum of its tiles. Only camber writes such checksums. */
static camber_status check_part(taking *t) {
    const camber_archive *archive = t->archive;
    char text[17];
    camber_checksum_write(&t->checksum, text);
    if (!archive->shards || !archive->checksum[0] || strcmp(archive->checksum, text) == 0)
        return CAMBER_OK;
    return camber_fail(
        t->writer->context, CAMBER_ERROR_INPUT,
        "%s: damaged: the checksum of its tiles is %s, and was %s when they were written; copy it again, "
        "or draw this part again",
        archive->path, text, archive->checksum);
}

camber_status camber_archive_writer_take(camber_archive_writer *writer, camber_archive *archive) {
    taking t = {.writer = writer,
                .archive = archive,
                .window.context = writer->context,
                .plain.context = writer->context,
                .packed.context = writer->context,
                .checksum.context = writer->context};
    if (!camber_grow(writer->context, &writer->archives, &writer->archive_capacity, writer->archive_count + 1,
                     sizeof *writer->archives))
        return CAMBER_ERROR_MEMORY;
    writer->archives[writer->archive_count++] = (taken_archive){archive->path, (uint32_t)writer->taken.count};
    if (archive->format == CAMBER_ARCHIVE_PMTILES) {
        const camber_pmtiles_file file = camber_pmtiles_get_file(archive->set);
        const uint64_t offset = file.header.tiles.offset;
        const uint64_t room = offset < file.size_bytes ? file.size_bytes - offset : 0;
        t.tiles_bytes = file.header.tiles.size < room ? file.header.tiles.size : room;
    }
    camber_status status = camber_archive_walk(archive, take_tile, &t);
    if (status == CAMBER_OK && archive->format == CAMBER_ARCHIVE_PMTILES)
        status = take_entries(&t);
    if (status == CAMBER_OK)
        status = check_part(&t);
    camber_free(writer->context, t.checksum.hashes);
    camber_free(writer->context, t.entries);
    camber_bytes_free(&t.window);
    camber_bytes_free(&t.plain);
    camber_bytes_free(&t.packed);
    return status;
}

/* ---- Finishing ---- */

static const char *archive_of(const camber_archive_writer *writer, uint32_t order) {
    const char *path = writer->path;
    for (size_t i = 0; i < writer->archive_count && writer->archives[i].first_order <= order; i++)
        path = writer->archives[i].path;
    return path;
}

static camber_status fail_conflict(const camber_archive_writer *writer, const camber_archive_conflict *conflict) {
    const int zoom = camber_archive_zoom(conflict->number);
    const char *one = archive_of(writer, conflict->orders[0]), *other = archive_of(writer, conflict->orders[1]);
    uint32_t column, row;
    camber_pmtiles_locate(conflict->number - camber_archive_first(zoom), zoom, &column, &row);
    if (one == other)
        return camber_fail(writer->context, CAMBER_ERROR_INPUT,
                           "%s: has tile %d/%u/%u twice, with different bytes; get the file again", one, zoom, column,
                           row);
    return camber_fail(writer->context, CAMBER_ERROR_INPUT,
                       "%s and %s: both have tile %d/%u/%u, with different bytes; merge archives whose tiles differ",
                       one, other, zoom, column, row);
}

static void describe(camber_archive_plan *plan, const camber_archive_writer *writer) {
    static const double world[4] = {-180, -85.0511287798066, 180, 85.0511287798066};
    const camber_archive_desc *desc = &writer->desc;
    const double *bounds = desc->bounds[0] < desc->bounds[2] ? desc->bounds : world;
    memcpy(plan->bounds, bounds, sizeof plan->bounds);
    plan->min_zoom = desc->min_zoom;
    plan->max_zoom = desc->max_zoom;
    if (plan->run_count) {
        const camber_archive_run *last = &plan->runs[plan->run_count - 1];
        plan->min_zoom = camber_archive_zoom(plan->runs[0].number);
        plan->max_zoom = camber_archive_zoom(last->number + last->length - 1);
    }
    plan->center = desc->center;
    if (!desc->center.given)
        plan->center =
            (camber_archive_center){true, (bounds[0] + bounds[2]) / 2, (bounds[1] + bounds[3]) / 2, plan->min_zoom};
    const int zoom = plan->center.zoom;
    plan->center.zoom = zoom < plan->min_zoom ? plan->min_zoom : zoom > plan->max_zoom ? plan->max_zoom : zoom;
    for (size_t i = 0; i < plan->run_count; i++)
        plan->tile_count += plan->runs[i].length;
}

static camber_status sum_up(const camber_archive_plan *plan, char text[17]) {
    camber_checksum checksum = {.context = plan->context};
    bool added = true;
    for (size_t i = 0; i < plan->run_count && added; i++)
        added = camber_checksum_add(&checksum, plan->contents->items[plan->runs[i].content].hash);
    camber_checksum_write(&checksum, text);
    return added ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

/* Adds the origin of the tiles to the metadata. A part keeps the zoom of its own centre, so the zoom of the whole
 * archive's centre is stored in this object. */
static camber_status put_origin(camber_archive_plan *plan, const camber_archive_writer *writer) {
    const camber_archive_desc *desc = &writer->desc;
    char checksum[17];
    if (sum_up(plan, checksum) != CAMBER_OK)
        return CAMBER_ERROR_MEMORY;
    json_t *origin = json_pack("{s:s}", "checksum", checksum);
    if (writer->fingerprint)
        json_object_set_new(origin, "fingerprint", json_string(writer->fingerprint));
    if (desc->shards) {
        char shard[32];
        snprintf(shard, sizeof shard, "%u/%u", desc->shard, desc->shards);
        json_object_set_new(origin, "shard", json_string(shard));
        if (desc->center.given)
            json_object_set_new(origin, "center_zoom", json_integer(desc->center.zoom));
    }
    plan->metadata = json_copy(writer->metadata);
    if (!plan->metadata || !origin) {
        json_decref(origin);
        return camber_fail(writer->context, CAMBER_ERROR_MEMORY, "%s: not enough memory for the metadata; allow more",
                           writer->path);
    }
    json_object_set(plan->metadata, "camber", origin);
    if (!json_object_get(plan->metadata, "format"))
        json_object_set_new(plan->metadata, "format", json_string(camber_tile_type_get_name(desc->type)));
    json_decref(origin);
    return CAMBER_OK;
}

static camber_status write_whole(const camber_archive_plan *plan) {
    camber_remove_tree(plan->context, plan->whole);
    switch (plan->desc->format) {
    case CAMBER_ARCHIVE_PMTILES: return camber_archive_write_pmtiles(plan);
    case CAMBER_ARCHIVE_MBTILES: return camber_archive_write_mbtiles(plan);
    case CAMBER_ARCHIVE_FOLDER: break;
    }
    return camber_archive_write_folder(plan);
}

uint64_t camber_archive_writer_get_removed(const camber_archive_writer *writer) {
    return writer->removed;
}

camber_status camber_archive_writer_finish(camber_archive_writer *writer) {
    camber_archive_runs runs = {0};
    camber_archive_conflict conflict = {0};
    if (writer->done)
        return CAMBER_OK;
    camber_status status = camber_contents_flush(&writer->contents);
    if (status == CAMBER_OK)
        status = camber_archive_resolve(writer->context, &writer->added, &writer->taken, &runs, &conflict);
    if (status == CAMBER_OK && conflict.found)
        status = fail_conflict(writer, &conflict);
    writer->removed = runs.removed;
    camber_archive_plan plan = {.context = writer->context,
                                .desc = &writer->desc,
                                .whole = writer->temporary_paths[TEMPORARY_WHOLE],
                                .contents = &writer->contents,
                                .runs = runs.items,
                                .run_count = runs.count};
    describe(&plan, writer);
    if (status == CAMBER_OK)
        status = put_origin(&plan, writer);
    if (status == CAMBER_OK)
        status = write_whole(&plan);
    if (status == CAMBER_OK)
        status = camber_give_name(writer->context, plan.whole, writer->path, writer->desc.force);
    if (status == CAMBER_OK)
        writer->keeps = false;
    else
        camber_remove_tree(writer->context, plan.whole);
    json_decref(plan.metadata);
    camber_free(writer->context, runs.items);
    return status;
}
