/* Reads a GeoJSON file that is given as input, if GDAL, which reads more of them, cannot be loaded.
 *
 * Input: a file with a FeatureCollection, a Feature or a geometry, in degrees. Output: its features, as GDAL gives
 * them.
 */
#include "features/gdal_calls.h"
#include "features/rings.h"
#include "formats/geojson.h"

#include <ctype.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Whether the file begins as a JSON object, after a byte order mark and space. A pipe is not looked at, because what is
 * read of it is gone. */
static bool knows(const char *path) {
    char head[64];
    struct stat about;
    const int file = stat(path, &about) == 0 && S_ISREG(about.st_mode) ? open(path, O_RDONLY | O_CLOEXEC) : -1;
    const ssize_t size = file < 0 ? 0 : read(file, head, sizeof head);
    if (file >= 0)
        close(file);
    ssize_t at = size >= 3 && memcmp(head, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    while (at < size && isspace((unsigned char)head[at]))
        at++;
    return at < size && head[at] == '{';
}

/* Without GDAL there is no filter, and no name of the only layer. */
static bool reads(const camber_source_desc *desc) {
    const char *why;
    return !desc->where && !desc->layer && !camber_gdal_find(&why);
}

static camber_status load(camber_context *context, const char *path, json_t **root) {
    char *text = NULL;
    size_t size = 0;
    json_error_t error;
    const camber_status status = camber_read_file(context, path, CAMBER_NAMED_BY_CALLER, &text, &size);
    if (status != CAMBER_OK)
        return status;
    const uint64_t needed = CAMBER_GEOJSON_BYTES_A_BYTE * (uint64_t)size;
    const size_t mark = size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    const bool has_room = camber_budget_has(context, needed);
    if (has_room)
        *root = json_loadb(text + mark, size - mark, JSON_DECODE_INT_AS_REAL | JSON_ALLOW_NUL, &error);
    camber_free(context, text);
    if (!has_room)
        return camber_budget_fail(context, needed);
    if (*root)
        return CAMBER_OK;
    if (json_error_code(&error) == json_error_out_of_memory)
        return camber_fail(context, CAMBER_ERROR_MEMORY, "%s: out of memory", path);
    return camber_fail(context, CAMBER_ERROR_INPUT, "%s: invalid JSON at line %d, column %d; get the file again", path,
                       error.line, error.column);
}

/* Old files may name a coordinate system other than degrees. */
static bool is_projected(const json_t *root) {
    const char *name =
        json_string_value(json_object_get(json_object_get(json_object_get(root, "crs"), "properties"), "name"));
    const size_t size = name ? strlen(name) : 0;
    return name && !strstr(name, "CRS84") && !(size >= 4 && strcmp(name + size - 4, "4326") == 0);
}

static camber_status read_root(camber_features *features, const camber_source_desc *source, const json_t *root,
                               camber_geojson_stats *stats) {
    camber_context *context = features->context;
    const char *path = source->path, *slash = strrchr(path, '/');
    const char *name = json_string_value(json_object_get(root, "name"));
    const size_t before = features->feature_count;
    if (is_projected(root))
        return camber_fail(
            context, CAMBER_ERROR_INPUT,
            "%s: its coordinates are not degrees, and without GDAL camber does not convert them; install "
            "GDAL, or convert the file with ogr2ogr -t_srs EPSG:4326",
            path);
    const camber_geojson_desc desc = {.what = path,
                                      .root = root,
                                      .layer = name    ? name
                                               : slash ? slash + 1
                                                       : path,
                                      .unsorted = true,
                                      .kinds = camber_features_kinds(features, true)};
    const camber_status status = camber_geojson_read(features, &desc, stats);
    if (status != CAMBER_OK || features->feature_count > before)
        return status;
    if (stats->damaged_features)
        return camber_fail(context, CAMBER_ERROR_INPUT, "%s: no feature can be read: %s; get the file again", path,
                           stats->damage);
    if (stats->skipped_features)
        return camber_fail(
            context, CAMBER_ERROR_INPUT,
            "%s: none of its %zu features is drawn by the style: they are points, areas or empty; choose "
            "another style",
            path, stats->skipped_features);
    return CAMBER_OK;
}

static void warn_of_losses(const camber_features *features, const char *path, const camber_geojson_stats *stats) {
    if (stats->damaged_features)
        camber_log(features->context, CAMBER_LOG_WARNING,
                   "%s: %zu damaged features (the first: %s); their readable parts are kept", path,
                   stats->damaged_features, stats->damage);
    if (stats->skipped_features)
        camber_log(features->context, CAMBER_LOG_INFO, "%s: left out what is %s of %zu features", path,
                   camber_features_left_out(camber_features_kinds(features, true)), stats->skipped_features);
    if (stats->invalid_points)
        camber_log(features->context, CAMBER_LOG_WARNING,
                   "%s: %zu points are not numbers and are left out; their lines are split there", path,
                   stats->invalid_points);
}

static camber_status read_file(camber_features *features, const camber_source_desc *desc, bool *declined) {
    *declined = false;
    const camber_features_mark before = camber_features_get_mark(features);
    const double start_ms = camber_now_ms();
    camber_geojson_stats stats = {0};
    json_t *root = NULL;
    camber_status status = load(features->context, desc->path, &root);
    if (status == CAMBER_OK)
        status = read_root(features, desc, root, &stats);
    json_decref(root);
    features->times.file_ms += camber_now_ms() - start_ms;
    if (status == CAMBER_OK)
        status = camber_features_merge_and_weigh(features, before.polyline_count, !desc->keep_apart, CAMBER_MERGE_ANY);
    if (status != CAMBER_OK) {
        camber_features_reset(features, &before);
        return status;
    }
    camber_features_count(features);
    features->stats.skipped_features += stats.skipped_features;
    features->stats.damaged_features += stats.damaged_features;
    features->stats.invalid_points += stats.invalid_points;
    warn_of_losses(features, desc->path, &stats);
    camber_rings_report(features, desc->path, before.polyline_count, &before.stats);
    camber_progress(features->context, "reading", 1);
    return CAMBER_OK;
}

static const char *format(size_t n) {
    return n == 0 ? "GeoJSON" : NULL;
}

const camber_reader camber_geojson_file_reader = {.knows = knows, .reads = reads, .read = read_file, .format = format};
