/* The names of archive formats and of tile types. */
#define _DEFAULT_SOURCE /* flock */
#define _FILE_OFFSET_BITS 64
#include "archive/checksum.h"
#include "archive/folder.h"
#include "archive/output_file.h"
#include "archive/pmtiles.h"
#include "archive/units.h"
#include "archive/writer.h"
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <strings.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static bool ends_with(const char *text, const char *end) {
    const size_t length = strlen(text), end_length = strlen(end);
    return length > end_length && strcasecmp(text + length - end_length, end) == 0;
}

bool camber_archive_get_format(const char *path, camber_archive_format *format) {
    struct stat about;
    const size_t length = strlen(path);
    if (length && (path[length - 1] == '/' || (stat(path, &about) == 0 && S_ISDIR(about.st_mode))))
        *format = CAMBER_ARCHIVE_FOLDER;
    else if (ends_with(path, ".pmtiles"))
        *format = CAMBER_ARCHIVE_PMTILES;
    else if (ends_with(path, ".mbtiles"))
        *format = CAMBER_ARCHIVE_MBTILES;
    else
        return false;
    return true;
}

static const char *const type_names[] = {"bin", "pbf", "png", "jpg", "webp", "avif", "mlt", "glb"};

const char *camber_tile_type_get_name(camber_tile_type type) {
    return type_names[type];
}

/* MBTiles uses media types for types that it does not define itself. */
static const char *const media_types[] = {[CAMBER_TILE_OTHER] = "application/octet-stream",
                                          [CAMBER_TILE_AVIF] = "image/avif",
                                          [CAMBER_TILE_MLT] = "application/vnd.maplibre-vector-tile",
                                          [CAMBER_TILE_GLB] = "model/gltf-binary"};

const char *camber_tile_type_get_format(camber_tile_type type) {
    return media_types[type] ? media_types[type] : type_names[type];
}

camber_tile_type camber_tile_type_find(const char *name) {
    if (strcmp(name, "mvt") == 0)
        return CAMBER_TILE_MVT;
    if (strcmp(name, "jpeg") == 0)
        return CAMBER_TILE_JPEG;
    for (size_t i = 1; i < sizeof type_names / sizeof *type_names; i++)
        if (strcasecmp(name, type_names[i]) == 0 || (media_types[i] && strcasecmp(name, media_types[i]) == 0))
            return (camber_tile_type)i;
    return CAMBER_TILE_OTHER;
}
