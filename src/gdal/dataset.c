/* declares stat64, which VSIStatBufL uses */
#define _LARGEFILE64_SOURCE

#include "archive/database.h"
#include "base/embedded.h"
#include "gdal/vector_file.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void CPL_STDCALL camber_gdal_collect(CPLErr level, CPLErrorNum number, const char *message) {
    camber_gdal_errors *errors = CPLGetErrorHandlerUserData();
    if (level < CE_Failure)
        return;
    if (errors->failures++ == 0) {
        errors->number = number;
        snprintf(errors->message, sizeof errors->message, "%s", message);
        /* GDAL's message becomes part of one of camber's sentences. */
        size_t length = strlen(errors->message);
        while (length && strchr(". \n", errors->message[length - 1]))
            errors->message[--length] = 0;
    }
}

/* ---- The OSM driver's configuration ---- */

typedef struct key_list {
    camber_context *context;
    char *text; /* "highway,bridge" */
    size_t size, capacity;
} key_list;

static bool has_key(const key_list *list, const char *key, size_t length) {
    for (const char *at = list->text; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL)
        if (strncmp(at, key, length) == 0 && (at[length] == ',' || at[length] == 0))
            return true;
    return false;
}

static bool add_key(key_list *list, const char *key, size_t length) {
    /* The key becomes part of a comma-separated line of the configuration. */
    if (!camber_osm_is_key(key, length) || (list->size && has_key(list, key, length)))
        return true;
    if (!camber_grow(list->context, &list->text, &list->capacity, list->size + length + 2, 1))
        return false;
    if (list->size)
        list->text[list->size++] = ',';
    memcpy(list->text + list->size, key, length);
    list->size += length;
    list->text[list->size] = 0;
    return true;
}

/* Columns that are not keys. The driver adds a column only if its configuration asks for it. */
static const char *const columns[] = {"osm_id",   "osm_version",   "osm_timestamp", "osm_uid",
                                      "osm_user", "osm_changeset", "other_tags",    "all_tags"};

enum { COLUMNS = sizeof columns / sizeof *columns };

static bool take_column(bool named[COLUMNS], const char *word, size_t length) {
    for (size_t i = 0; i < COLUMNS; i++)
        if (strlen(columns[i]) == length && strncmp(columns[i], word, length) == 0)
            return named[i] = true;
    return false;
}

/* Whether a word is one of OGR's own names for properties that every feature has. They are not keys. */
static bool is_ogrs(const char *word, size_t length) {
    return (length == 3 && EQUALN(word, "FID", 3)) || (length > 4 && EQUALN(word, "OGR_", 4));
}

/* Adds every word of an attribute filter, because any of them may be a key. Keywords of SQL do no harm as keys. */
static bool add_where_keys(key_list *list, const char *where, bool named[COLUMNS]) {
    size_t length;
    const char *word;
    while ((word = camber_where_next(&where, &length)) != NULL)
        if (!take_column(named, word, length) && !is_ogrs(word, length) && !add_key(list, word, length))
            return false;
    return true;
}

/* Replaces every occurrence of the mark in the template. */
static char *fill_template(camber_context *context, const char *text, const char *mark, const char *keys) {
    const size_t mark_size = strlen(mark), keys_size = strlen(keys);
    size_t marks = 0;
    for (const char *at = text; (at = strstr(at, mark)) != NULL; at += mark_size)
        marks++;
    char *filled = camber_alloc(context, strlen(text) + marks * keys_size + 1, 1);
    if (!filled)
        return NULL;
    char *out = filled;
    const char *from = text;
    for (const char *at; (at = strstr(from, mark)) != NULL; from = at + mark_size) {
        memcpy(out, from, (size_t)(at - from));
        out += at - from;
        memcpy(out, keys, keys_size);
        out += keys_size;
    }
    memcpy(out, from, strlen(from) + 1);
    return filled;
}

/* Writes the columns, one on each line. */
static void list_columns(const bool named[COLUMNS], char text[256]) {
    size_t used = 0;
    for (size_t i = 0; i < COLUMNS; i++)
        used += (size_t)snprintf(text + used, 256 - used, "%s=%s\n", columns[i], named[i] ? "yes" : "no");
}

static char *make_conf(camber_context *context, const char *keys, const bool named[COLUMNS]) {
    char columns_text[256];
    list_columns(named, columns_text);
    char *made = fill_template(context, camber_osmconf, "@attributes@", keys);
    char *filled = made ? fill_template(context, made, "@columns@\n", columns_text) : NULL;
    camber_free(context, made);
    return filled;
}

static camber_status write_conf(camber_dataset *dataset, const camber_schema *schema) {
    camber_context *context = dataset->context;
    key_list list = {.context = context};
    bool named[COLUMNS] = {false};
    /* The list must not be empty, because the driver has no default for it. */
    bool made = add_key(&list, "highway", strlen("highway"));
    for (size_t i = 0; made && i < schema->property_count; i++)
        made = add_key(&list, schema->properties[i], strlen(schema->properties[i]));
    for (size_t i = 0; made && camber_osm_area_keys[i]; i++)
        made = add_key(&list, camber_osm_area_keys[i], strlen(camber_osm_area_keys[i]));
    if (made && dataset->desc->where)
        made = add_where_keys(&list, dataset->desc->where, named);
    if (made)
        dataset->conf = make_conf(context, list.text, named);
    camber_free(context, list.text);
    if (!dataset->conf)
        return CAMBER_ERROR_MEMORY;
    snprintf(dataset->conf_path, sizeof dataset->conf_path, "/vsimem/camber-%p-%llu.ini", (void *)context,
             (unsigned long long)context->next_serial++);
    /* GDAL reads from our buffer, which lives as long as the dataset. */
    VSILFILE *file = VSIFileFromMemBuffer(dataset->conf_path, (GByte *)dataset->conf, strlen(dataset->conf), FALSE);
    if (!file)
        return camber_fail(context, CAMBER_ERROR_MEMORY,
                           "%s: not enough memory for the OSM driver's configuration; allow more", dataset->desc->path);
    VSIFCloseL(file);
    return CAMBER_OK;
}

/* ---- Opening ---- */

static bool ends_with(const char *text, const char *end) {
    const size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && EQUAL(text + length - end_length, end);
}

/* Whether this is not a path in the file system, but something like "PG:dbname=x" or standard input. Only the driver
 * knows whether such a thing exists. */
static bool is_connection(const char *path) {
    const char *colon = strchr(path, ':'), *slash = strchr(path, '/');
    return STARTS_WITH(path, "/vsistdin") || (colon && (!slash || colon < slash));
}

/* Finds the real file in a path with GDAL's file systems and prefixes: /a/b.zip in /vsizip//a/b.zip/c.shp, and a in
 * /vsisubfile/0_9,a and in GeoJSON:a. It does not look inside archives. */
static const char *find_file(const char *path) {
    while (STARTS_WITH(path, "/vsi")) {
        const char *slash = strchr(path + 1, '/');
        if (!slash)
            break;
        const char *comma = STARTS_WITH(path, "/vsisubfile") ? strchr(slash, ',') : NULL;
        path = (comma ? comma : slash) + 1;
        path += *path == '{';
    }
    struct stat about;
    const char *colon = strchr(path, ':');
    if (colon && stat(path, &about) != 0 && stat(colon + 1, &about) == 0)
        return colon + 1;
    return path;
}

/* Refuses databases with a log, which GDAL would merge into the file, and databases with virtual tables, which may open
 * other files. */
static camber_status check_database(camber_context *context, const char *path) {
    const camber_database_kind kind = camber_database_get_kind(path);
    if (kind == CAMBER_DATABASE_INTERRUPTED || kind == CAMBER_DATABASE_LOGGED)
        return camber_fail(
            context, CAMBER_ERROR_INPUT,
            "%s: has a log file next to it, so a program is writing to it or was interrupted; close that "
            "program, or open the file once with write access (sqlite3 FILE .tables) to repair it",
            path);
    if (!context->desc.access.vrt && camber_database_is_virtual(path))
        return camber_fail(context, CAMBER_ERROR_INPUT,
                           "%s: has virtual tables, which may name other files; allow it (--allow-vrt) if you trust it",
                           path);
    return CAMBER_OK;
}

static camber_status check_exists(camber_context *context, const char *path, bool *directory) {
    VSIStatBufL about;
    uint64_t size_bytes;
    *directory = false;
    if (!context->desc.access.remote && camber_gdal_is_remote(path))
        return camber_fail(context, CAMBER_ERROR_INPUT,
                           "%s: is a network address; download the file, or allow network access (--allow-remote)",
                           path);
    /* Devices and pipes may never end. */
    struct stat found;
    const char *file = find_file(path);
    if (!STARTS_WITH(path, "/vsistdin") && stat(file, &found) == 0 && !S_ISDIR(found.st_mode)) {
        camber_status status = camber_file_check(context, file, CAMBER_NAMED_BY_CALLER, &size_bytes);
        if (status == CAMBER_OK)
            status = check_database(context, file);
        if (status != CAMBER_OK)
            return status;
    }
    if (VSIStatL(path, &about) == 0) {
        *directory = VSI_ISDIR(about.st_mode);
        return access(path, R_OK) != 0 && errno == EACCES ? camber_file_fail(context, path, EACCES) : CAMBER_OK;
    }
    const int cause = errno;
    if (cause == EACCES || cause == EMFILE || cause == ENFILE)
        return camber_file_fail(context, path, cause);
    if (strcmp(path, "-") == 0 || is_connection(path))
        return CAMBER_OK;
    return camber_fail(context, CAMBER_ERROR_NOT_FOUND, "%s: no such file; check the path", path);
}

/* Fails for a format that is supported but refers to something outside its file. */
static camber_status fail_driver(const camber_dataset *dataset, const char *driver) {
    const bool describes = camber_gdal_describes(driver);
    return camber_fail(dataset->context, CAMBER_ERROR_INPUT,
                       describes ? "%s: is %s, which names other files; allow it (--allow-vrt) if you trust it"
                                 : "%s: is %s, which accesses servers or programs; allow it (--allow-remote) if you "
                                   "trust it",
                       dataset->desc->path, driver);
}

/* Removes quotations from GDAL's message, because the quoted text may be from any file that somebody named. */
static void leave_out_quotes(char *message) {
    char *out = message;
    for (const char *at = message; *at; at++) {
        const char *end = strchr("'\"`", *at) ? strchr(at + 1, *at == '`' ? '\'' : *at) : NULL;
        const bool opens = end && (at == message || !isalnum((unsigned char)at[-1]));
        *out++ = *at;
        if (!opens)
            continue;
        for (int i = 0; i < 3 && out < end; i++)
            *out++ = '.';
        *out++ = *end;
        at = end;
    }
    *out = 0;
}

/* Says why a file could not be opened. gdal_path: the path that GDAL was asked to open. */
static camber_status fail_open(camber_dataset *dataset, const char *gdal_path, bool directory) {
    const char *path = dataset->desc->path, *said = dataset->errors.message;
    VSIStatBufL about;
    if (directory)
        return camber_fail(dataset->context, CAMBER_ERROR_INPUT,
                           "%s: a folder without data that GDAL can read; name a file in it", path);
    const char *driver = camber_gdal_refused(dataset->context, path);
    if (driver)
        return fail_driver(dataset, driver);
    const bool there = VSIStatL(path, &about) == 0;
    if (!there && strstr(said, "No such file"))
        return camber_fail(dataset->context, CAMBER_ERROR_NOT_FOUND, "%s: no such file; check the path", path);
    if (there && about.st_size == 0)
        return camber_fail(dataset->context, CAMBER_ERROR_INPUT, "%s: the file is empty; get it again", path);
    /* The beginning of standard input has already been consumed, and the advice is about the file that the user named.
     */
    const camber_gdal_cure *cure =
        is_connection(gdal_path) || STARTS_WITH(path, "/vsi") ? NULL : camber_gdal_find_cure(gdal_path);
    if (cure)
        return camber_fail(dataset->context, CAMBER_ERROR_INPUT, "%s: %s; %s%s%s", path, cure->what, cure->before,
                           cure->after ? path : "", cure->after ? cure->after : "");
    if (ends_with(path, ".pmtiles") && dataset->desc->where)
        return camber_fail(dataset->context, CAMBER_ERROR_INPUT,
                           "%s: this GDAL cannot filter PMTiles; leave out the filter, or convert the file to MBTiles",
                           path);
    if (dataset->errors.failures == 0 || strstr(said, "not recognized as "))
        return camber_fail(
            dataset->context, CAMBER_ERROR_INPUT,
            "%s: not a map in a format that camber reads; name another file (camber info lists the formats)", path);
    leave_out_quotes(dataset->errors.message);
    return camber_fail(dataset->context, CAMBER_ERROR_INPUT, "%s: damaged or cut off: %s; get the file again", path,
                       said);
}

/* Returns the zoom of a dataset of tiles. MBTiles files state it, and a directory of tiles has it as its name. */
static int zoom_of(const camber_dataset *dataset) {
    const char *driver = GDALGetDriverShortName(GDALGetDatasetDriver(dataset->handle)), *text = NULL;
    if (EQUAL(driver, "MBTiles"))
        text = GDALGetMetadataItem(dataset->handle, "ZOOM_LEVEL", NULL);
    else if (EQUAL(driver, "MVT"))
        text = CPLGetFilename(dataset->desc->path);
    char *end = NULL;
    const long zoom = text && isdigit((unsigned char)*text) ? strtol(text, &end, 10) : -1;
    return end && *end == 0 && zoom >= 0 && zoom <= 30 ? (int)zoom : -1;
}

/* Whether this is a vector tile that GDAL cannot locate. It can locate tiles whose path ends in zoom/column/row. */
static bool is_bare_tile(GDALDatasetH handle) {
    OGRLayerH layer = GDALDatasetGetLayer(handle, 0);
    return EQUAL(GDALGetDriverShortName(GDALGetDatasetDriver(handle)), "MVT") && layer && !OGR_L_GetSpatialRef(layer);
}

/* Returns the path in the form that GDAL needs: a .gz file is read through GDAL's decompressor, and - is standard
 * input. */
static char *gdal_path(camber_context *context, const char *path, bool directory) {
    const size_t size = strlen(path) + sizeof "/vsistdin/";
    char *made = camber_alloc(context, size, 1);
    if (!made)
        return NULL;
    if (strcmp(path, "-") == 0)
        snprintf(made, size, "/vsistdin/");
    else if (ends_with(path, ".gz") && !STARTS_WITH(path, "/vsi") && !directory)
        snprintf(made, size, "/vsigzip/%s", path);
    else
        snprintf(made, size, "%s", path);
    return made;
}

camber_status camber_dataset_fail_elsewhere(camber_context *context, const char *name) {
    return camber_fail(context, CAMBER_ERROR_INPUT,
                       "%s: it or its coordinate system refers to another file; convert it to GeoJSON or GeoPackage",
                       name);
}

camber_status camber_dataset_open(camber_context *context, const camber_source_desc *desc, const camber_schema *schema,
                                  bool unsorted, camber_dataset *dataset) {
    *dataset = (camber_dataset){.context = context, .desc = desc, .zoom = -1};
    bool directory;
    char *path = NULL, **options = NULL, **drivers = NULL;
    camber_status status = check_exists(context, desc->path, &directory);
    if (status == CAMBER_OK && camber_gdal_leads_elsewhere(desc->path))
        status = camber_dataset_fail_elsewhere(context, desc->path);
    if (status == CAMBER_OK)
        status = write_conf(dataset, schema);
    if (status != CAMBER_OK)
        goto done;
    status = CAMBER_ERROR_MEMORY;
    path = gdal_path(context, desc->path, directory);
    if (!path)
        goto done;
    options = CSLSetNameValue(options, "CONFIG_FILE", dataset->conf_path);
    if (unsorted)
        options = CSLSetNameValue(options, "USE_CUSTOM_INDEXING", "NO");
    /* CLIP=NO keeps the tiles' buffers. The stitcher needs them, because it cuts lines exactly where it joins them. */
    options = CSLSetNameValue(options, "CLIP", "NO");
    /* GDAL must not create files next to the one that it reads. */
    options = CSLSetNameValue(options, "WRITE_GFS", "NO");
    if (camber_database_get_kind(desc->path) == CAMBER_DATABASE_AT_REST)
        options = CSLSetNameValue(options, "IMMUTABLE", "YES");
    drivers = camber_gdal_drivers(context, path);
    CPLPushErrorHandlerEx(camber_gdal_collect, &dataset->errors);
    /* A driver warns about options that it does not know. Warnings are dropped, and failures are collected. */
    dataset->handle = GDALOpenEx(path, GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                 (const char *const *)drivers, (const char *const *)options, NULL);
    CPLPopErrorHandler();
    if (!dataset->handle) {
        status = fail_open(dataset, path, directory);
        goto done;
    }
    if (!directory && is_bare_tile(dataset->handle)) {
        status = camber_fail(context, CAMBER_ERROR_INPUT,
                             "%s: a vector tile whose path does not say which one; name it ZOOM/COLUMN/ROW.pbf, or "
                             "draw it by a style that has a source with \"tiles\": [\"tiles/{z}/{x}/{y}.pbf\"]",
                             desc->path);
        goto done;
    }
    dataset->osm = EQUAL(GDALGetDriverShortName(GDALGetDatasetDriver(dataset->handle)), "OSM");
    dataset->zoom = zoom_of(dataset);
    status = CAMBER_OK;
done:
    CSLDestroy(drivers);
    CSLDestroy(options);
    camber_free(context, path);
    if (status != CAMBER_OK)
        camber_dataset_close(dataset);
    return status;
}

void camber_dataset_close(camber_dataset *dataset) {
    CPLPushErrorHandlerEx(camber_gdal_collect, &dataset->errors);
    if (dataset->handle)
        GDALClose(dataset->handle);
    CPLPopErrorHandler();
    dataset->handle = NULL;
    if (dataset->conf)
        VSIUnlink(dataset->conf_path);
    camber_free(dataset->context, dataset->conf);
    dataset->conf = NULL;
}

const char *camber_dataset_attribution(const camber_dataset *dataset) {
    return dataset->osm ? CAMBER_OSM_ATTRIBUTION : GDALGetMetadataItem(dataset->handle, "attribution", NULL);
}
