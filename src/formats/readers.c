/* The table of readers, which decides which reader reads a file. The first reader that knows the format and supports
 * the request reads the file. It may decline, which leaves the file to the readers after it. */
#include "features/features.h"
#include "formats/gdal.h"
#include "formats/geojson.h"
#include "formats/tile_reader.h"
#include "osm/osm.h"

#include <string.h>
#include <sys/stat.h>

static const camber_reader *const readers[] = {&camber_osm_reader, &camber_tile_file_reader,
                                               &camber_geojson_file_reader, &camber_gdal_reader};

enum { READERS = sizeof readers / sizeof *readers };

/* Finds the first reader for a file. There always is one, because GDAL takes any file. */
static const camber_reader *find_reader(const camber_source_desc *desc) {
    size_t i = 0;
    while (i + 1 < READERS && !camber_reader_takes(readers[i], desc))
        i++;
    return readers[i];
}

bool camber_source_needs_gdal(const camber_source_desc *desc) {
    return find_reader(desc) == &camber_gdal_reader;
}

bool camber_source_is_osm(const camber_source_desc *desc) {
    return find_reader(desc) == &camber_osm_reader;
}

static camber_status read_file(camber_features *features, const camber_source_desc *desc) {
    camber_status status = CAMBER_OK;
    bool declined = true;
    for (size_t i = 0; i < READERS && declined && status == CAMBER_OK; i++) {
        if (!readers[i]->knows(desc->path))
            continue;
        if (readers[i]->reads(desc))
            status = readers[i]->read(features, desc, &declined);
        if (status == CAMBER_OK && declined && readers[i]->leave)
            status = readers[i]->leave(features->context, desc);
    }
    return status;
}

camber_status camber_features_read(camber_features *features, const camber_source_desc *desc) {
    struct stat about;
    features->threads = desc->threads;
    const camber_status status = read_file(features, desc);
    if (status == CAMBER_OK && stat(desc->path, &about) == 0 && S_ISREG(about.st_mode))
        features->stats.input_bytes += (size_t)about.st_size;
    return status;
}

/* ---- Formats ---- */

static bool has_format(const camber_reader *reader, const char *name, size_t *count) {
    const char *one;
    for (*count = 0; (one = reader->format(*count)) != NULL; ++*count)
        if (name && strcmp(one, name) == 0)
            return true;
    return false;
}

/* GDAL's formats come first, then those that it does not read. */
const char *camber_format_list(size_t n) {
    const camber_reader *last = readers[READERS - 1];
    const char *name = last->format(n);
    size_t count;
    if (name)
        return name;
    (void)has_format(last, NULL, &count);
    n -= count;
    for (size_t r = 0; r + 1 < READERS; r++)
        for (size_t i = 0; (name = readers[r]->format(i)) != NULL; i++)
            if (!has_format(last, name, &count) && n-- == 0)
                return name;
    return NULL;
}
