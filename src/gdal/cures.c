/* Advice on files that GDAL cannot open, but whose first bytes show their format.
 *
 * Input: the path of a file that could not be opened. Output: a row of the table, which has the advice.
 */
#include "gdal/vector_file.h"

#include <cpl_error.h>
#include <cpl_vsi.h>
#include <string.h>

#define PIPED " | camber render - -o OUT"
#define MADE_AGAIN "make it again from its source with ogr2ogr -f FlatGeobuf OUT.fgb SOURCE"
#define BY_OGR2OGR "convert it with ogr2ogr OUT.gpkg FILE of a GDAL that has it (conda: libgdal-arrow-parquet)"

/* One row for each kind of file. */
static const camber_gdal_cure cures[] = {
    {0, 3, "BZh", NULL, "compressed with bzip2, which GDAL cannot read", "draw it by bzcat ", PIPED},
    {0, 6, "\3757zXZ", NULL, "compressed with xz, which GDAL cannot read", "draw it by xzcat ", PIPED},
    {0, 4, "\x28\xb5\x2f\xfd", NULL, "compressed with zstd, which GDAL cannot read", "draw it by zstdcat ", PIPED},
    {0, 4, "\x04\x22\x4d\x18", NULL, "compressed with lz4, which GDAL cannot read", "draw it by lz4cat ", PIPED},
    {0, 2, "\x1f\x8b", NULL, "compressed with gzip, but not named .gz", "name it /vsigzip/",
     ", or /vsitar/ and its path if it is a .tgz"},
    {0, 4, "PK\3\4", NULL, "a zip archive", "name what is in it, as /vsizip/", "/NAME (unzip -l lists the names)"},
    {257, 5, "ustar", NULL, "a tar archive", "name what is in it, as /vsitar/", "/NAME (tar tf lists the names)"},
    {0, 6, "7z\xbc\xaf\x27\x1c", NULL, "a 7z archive", "unpack it with 7z x ", ", and name a file of it"},
    {0, 4, "Rar!", NULL, "a rar archive", "unpack it with unrar x ", ", and name a file of it"},
    {0, 6, "\xff\xe0\x04o5m", NULL, "OpenStreetMap's data as o5m, which GDAL does not read",
     "convert it with osmium cat -o OUT.osm.pbf ", ""},
    {0, 6, "\xff\xe0\x04o5c", NULL, "changes to OpenStreetMap's data (o5c), not a map",
     "apply them to one with osmium apply-changes -o OUT.osm.pbf MAP ", ""},
    {0, 4, "fgb\1", NULL, "version 1 of FlatGeobuf, and GDAL reads version 3", MADE_AGAIN, NULL},
    {0, 4, "fgb\2", NULL, "version 2 of FlatGeobuf, and GDAL reads version 3", MADE_AGAIN, NULL},
    {0, 4, "PAR1", "Parquet", "Parquet, whose driver this GDAL lacks", BY_OGR2OGR, NULL},
    {0, 6, "ARROW1", "Arrow", "Arrow, whose driver this GDAL lacks", BY_OGR2OGR, NULL},
};

const camber_gdal_cure *camber_gdal_find_cure(const char *path) {
    char head[262];
    CPLPushErrorHandler(CPLQuietErrorHandler);
    VSILFILE *file = VSIFOpenL(path, "rb");
    const size_t size = file ? VSIFReadL(head, 1, sizeof head, file) : 0;
    if (file)
        VSIFCloseL(file);
    CPLPopErrorHandler();
    for (size_t i = 0; i < sizeof cures / sizeof *cures; i++) {
        const camber_gdal_cure *cure = cures + i;
        if (cure->at + cure->size <= size && memcmp(head + cure->at, cure->bytes, cure->size) == 0 &&
            !(cure->driver && GDALGetDriverByName(cure->driver)))
            return cure;
    }
    return NULL;
}
