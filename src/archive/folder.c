/* Folders of tiles: FOLDER/{z}/{x}/{y}.EXTENSION, rows from the north, and FOLDER/metadata.json. */
#define _XOPEN_SOURCE 700

#include "archive/folder.h"
#include "archive/output_file.h"
#include "archive/pmtiles.h"
#include "archive/tileset.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- Writing ---- */

static camber_status make_folder(const camber_archive_plan *plan, const char *path) {
    return mkdir(path, 0777) == 0 || errno == EEXIST ? CAMBER_OK : camber_output_fail(plan->context, path, errno);
}

static camber_status write_file(const camber_archive_plan *plan, const char *path, const void *bytes, size_t size) {
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0)
        return camber_output_fail(plan->context, path, errno);
    const camber_status status = camber_write_at(plan->context, path, file, bytes, size, 0);
    if (close(file) != 0 && status == CAMBER_OK)
        return camber_output_fail(plan->context, path, errno);
    return status;
}

/* Creates the tile's folders if they do not exist yet. */
static camber_status write_tile(const camber_archive_plan *plan, uint64_t number, const camber_bytes *bytes) {
    char path[PATH_MAX];
    const int zoom = camber_archive_zoom(number);
    uint32_t column, row;
    camber_pmtiles_locate(number - camber_archive_first(zoom), zoom, &column, &row);
    if (snprintf(path, sizeof path, "%s/%d/%u/%u.%s", plan->whole, zoom, column, row,
                 camber_tile_type_get_name(plan->desc->type)) >= (int)sizeof path)
        return camber_output_fail(plan->context, plan->whole, ENAMETOOLONG);
    char *file = strrchr(path, '/');
    *file = 0;
    if (access(path, F_OK) != 0) {
        char *folder = strrchr(path, '/');
        *folder = 0;
        camber_status status = make_folder(plan, path);
        *folder = '/';
        if (status == CAMBER_OK)
            status = make_folder(plan, path);
        if (status != CAMBER_OK)
            return status;
    }
    *file = '/';
    return write_file(plan, path, bytes->data, bytes->size_bytes);
}

static camber_status write_tiles(const camber_archive_plan *plan, camber_bytes *bytes) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < plan->run_count && status == CAMBER_OK; i++) {
        const camber_archive_run *run = &plan->runs[i];
        const camber_content *item = &plan->contents->items[run->content];
        if (!camber_bytes_resize(bytes, item->size_bytes))
            return CAMBER_ERROR_MEMORY;
        status = camber_contents_read(plan->contents, item->store, item->offset, bytes->data, item->size_bytes);
        for (uint64_t k = 0; k < run->length && status == CAMBER_OK; k++)
            status = write_tile(plan, run->number + k, bytes);
        camber_progress_count(plan->context, "writing tiles", "entries", i, plan->run_count);
    }
    return status;
}

static camber_status write_metadata(const camber_archive_plan *plan) {
    char path[PATH_MAX];
    json_t *metadata = json_copy(plan->metadata);
    camber_archive_put_texts(plan, metadata);
    char *text = json_dumps(metadata, JSON_INDENT(2) | JSON_SORT_KEYS);
    json_decref(metadata);
    if (!text)
        return camber_fail(plan->context, CAMBER_ERROR_MEMORY, "%s: not enough memory for the metadata; allow more",
                           plan->desc->path);
    camber_status status = CAMBER_OK;
    if (snprintf(path, sizeof path, "%s/metadata.json", plan->whole) >= (int)sizeof path)
        status = camber_output_fail(plan->context, plan->whole, ENAMETOOLONG);
    else
        status = write_file(plan, path, text, strlen(text));
    free(text);
    return status;
}

static camber_status write_beside(void *user, const char *name, const void *bytes, size_t size_bytes) {
    const camber_archive_plan *plan = user;
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s/%s", plan->whole, name) >= (int)sizeof path)
        return camber_output_fail(plan->context, plan->whole, ENAMETOOLONG);
    return write_file(plan, path, bytes, size_bytes);
}

/* Writes the tileset of 3D Tiles for mesh tiles. */
static camber_status write_tileset(const camber_archive_plan *plan) {
    char path[PATH_MAX];
    camber_archive_plan own = *plan;
    if (plan->desc->type != CAMBER_TILE_GLB || !plan->run_count)
        return CAMBER_OK;
    if (snprintf(path, sizeof path, "%s/subtrees", plan->whole) >= (int)sizeof path)
        return camber_output_fail(plan->context, plan->whole, ENAMETOOLONG);
    const camber_status status = make_folder(plan, path);
    return status == CAMBER_OK ? camber_tileset_write(plan, write_beside, &own) : status;
}

/* The files are not synced one by one, because there may be millions. So a power failure may lose some of them, but the
 * end of the process does not. */
camber_status camber_archive_write_folder(const camber_archive_plan *plan) {
    enum { MOST_FILES = 1 << 26 };
    camber_bytes bytes = {.context = plan->context};
    if (plan->tile_count > MOST_FILES)
        return camber_fail(plan->context, CAMBER_ERROR_LIMIT,
                           "%s: %" PRIu64 " tiles are more than the %d files that a folder may have; write PMTiles",
                           plan->desc->path, plan->tile_count, MOST_FILES);
    camber_status status = make_folder(plan, plan->whole);
    if (status == CAMBER_OK)
        status = write_metadata(plan);
    if (status == CAMBER_OK)
        status = write_tiles(plan, &bytes);
    if (status == CAMBER_OK)
        status = write_tileset(plan);
    camber_bytes_free(&bytes);
    return status;
}

/* ---- Names ---- */

typedef struct name {
    uint32_t number;
    char extension[8];
} name;

typedef struct names {
    name *items;
    size_t count, capacity;
} names;

static int compare_names(const void *left, const void *right) {
    const name *a = left, *b = right;
    if (a->number != b->number)
        return a->number < b->number ? -1 : 1;
    return strcmp(a->extension, b->extension);
}

/* Parses a number in its canonical form: no sign, no leading zeros. */
static bool parse_name(const char *text, bool file, name *made) {
    const size_t digits = strspn(text, "0123456789");
    if (digits == 0 || digits > 9 || (digits > 1 && text[0] == '0'))
        return false;
    const char *rest = text + digits;
    if (file ? *rest != '.' || strlen(rest + 1) >= sizeof made->extension : *rest != 0)
        return false;
    made->number = (uint32_t)strtoul(text, NULL, 10);
    snprintf(made->extension, sizeof made->extension, "%s", file ? rest + 1 : "");
    return true;
}

/* Whether a file with this name may be in the folder in addition to the tiles. */
static bool is_companion(const char *entry, bool has_tileset) {
    return strcmp(entry, "metadata.json") == 0 ||
           (has_tileset && (strcmp(entry, "tileset.json") == 0 || strcmp(entry, "subtrees") == 0));
}

static bool is_dots(const char *entry) {
    return strcmp(entry, ".") == 0 || strcmp(entry, "..") == 0;
}

/* ---- Replacing ---- */

/* Whether no other folder can take the name of this folder, because it is the root, a mount point, "." or "..". */
static bool is_fixed(const char *path) {
    const char *slash = strrchr(path, '/'), *last = slash ? slash + 1 : path;
    char above[PATH_MAX];
    struct stat own, its;
    return is_dots(last) || snprintf(above, sizeof above, "%s/..", path) >= (int)sizeof above ||
           stat(path, &own) != 0 || stat(above, &its) != 0 || own.st_dev != its.st_dev || own.st_ino == its.st_ino;
}

camber_status camber_folder_may_go(camber_context *context, const char *path) {
    if (is_fixed(path))
        return camber_fail(context, CAMBER_ERROR_IO, "%s: this folder cannot be replaced; name a new one in it", path);
    DIR *opened = opendir(path);
    camber_status status = opened ? CAMBER_OK : camber_output_fail(context, path, errno);
    const struct dirent *entry;
    bool is_empty = true, has_metadata = false;
    while (status == CAMBER_OK && (entry = readdir(opened)) != NULL) {
        name zoom;
        is_empty = is_empty && is_dots(entry->d_name);
        has_metadata = has_metadata || strcmp(entry->d_name, "metadata.json") == 0;
        if (!is_dots(entry->d_name) && !is_companion(entry->d_name, true) && !parse_name(entry->d_name, false, &zoom))
            status =
                camber_fail(context, CAMBER_ERROR_IO,
                            "%s: has %s, which is not part of an archive of tiles, and would be lost; name another "
                            "folder",
                            path, entry->d_name);
    }
    if (opened)
        closedir(opened);
    if (status == CAMBER_OK && !is_empty && !has_metadata)
        return camber_fail(context, CAMBER_ERROR_IO,
                           "%s: has no metadata.json, so it may not be an archive of tiles, and its files would be "
                           "lost; name another folder",
                           path);
    return status;
}

/* ---- Reading ---- */

static camber_status tell_stranger(const camber_folder_visitor *visitor, const char *folder, const char *entry) {
    char path[PATH_MAX];
    if (!visitor->take_stranger)
        return CAMBER_OK;
    snprintf(path, sizeof path, "%.2000s/%s", folder, entry);
    return visitor->take_stranger(visitor->user, path);
}

/* The path of the archive may be a link, but a folder inside the archive may not. */
static DIR *open_folder(const char *path, bool top) {
    struct stat about;
    const int opened = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC | (top ? 0 : O_NOFOLLOW));
    DIR *made = opened >= 0 ? fdopendir(opened) : NULL;
    if (made)
        return made;
    const int cause =
        opened < 0 && errno == ENOTDIR && lstat(path, &about) == 0 && S_ISLNK(about.st_mode) ? ELOOP : errno;
    if (opened >= 0)
        close(opened);
    errno = cause;
    return NULL;
}

/* Lists the entries of a folder whose names are numbers, in ascending order. The visitor gets all other names. */
static camber_status list(const camber_folder_visitor *visitor, const char *folder, bool files, bool top,
                          names *found) {
    camber_context *context = visitor->context;
    DIR *opened = open_folder(folder, top);
    camber_status status = opened ? CAMBER_OK : camber_file_fail(context, folder, errno);
    const struct dirent *entry;
    while (status == CAMBER_OK && (entry = readdir(opened)) != NULL) {
        name made;
        if (is_dots(entry->d_name) || (top && is_companion(entry->d_name, visitor->has_tileset)))
            continue;
        if (!parse_name(entry->d_name, files, &made))
            status = tell_stranger(visitor, folder, entry->d_name);
        else if (!camber_grow(context, &found->items, &found->capacity, found->count + 1, sizeof *found->items))
            status = CAMBER_ERROR_MEMORY;
        else
            found->items[found->count++] = made;
    }
    if (opened)
        closedir(opened);
    if (found->count)
        qsort(found->items, found->count, sizeof *found->items, compare_names);
    return status;
}

static camber_status visit_column(const camber_folder_visitor *visitor, const char *folder, uint32_t zoom,
                                  uint32_t column) {
    names rows = {0};
    camber_status status = list(visitor, folder, true, false, &rows);
    for (size_t i = 0; i < rows.count && status == CAMBER_OK; i++) {
        char path[PATH_MAX];
        snprintf(path, sizeof path, "%.4000s/%u.%s", folder, rows.items[i].number, rows.items[i].extension);
        const camber_folder_file file = {path, rows.items[i].extension, zoom, column, rows.items[i].number};
        status = visitor->take_file(visitor->user, &file);
    }
    camber_free(visitor->context, rows.items);
    return status;
}

static camber_status visit_zoom(const camber_folder_visitor *visitor, const char *folder, uint32_t zoom) {
    names columns = {0};
    camber_status status = list(visitor, folder, false, false, &columns);
    for (size_t i = 0; i < columns.count && status == CAMBER_OK; i++) {
        char path[PATH_MAX];
        snprintf(path, sizeof path, "%.4000s/%u", folder, columns.items[i].number);
        status = visit_column(visitor, path, zoom, columns.items[i].number);
    }
    camber_free(visitor->context, columns.items);
    return status;
}

camber_status camber_folder_visit(const char *path, const camber_folder_visitor *visitor) {
    names zooms = {0};
    camber_status status = list(visitor, path, false, true, &zooms);
    for (size_t i = 0; i < zooms.count && status == CAMBER_OK; i++) {
        char folder[PATH_MAX];
        snprintf(folder, sizeof folder, "%.4000s/%u", path, zooms.items[i].number);
        status = visit_zoom(visitor, folder, zooms.items[i].number);
    }
    camber_free(visitor->context, zooms.items);
    return status;
}
