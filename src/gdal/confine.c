/* Confines GDAL to the file that it reads. By default, GDAL follows references in files to servers and to other files.
 *
 * Only drivers whose files contain their data, or store it in other files of their format, are allowed. Network access
 * is refused unless the context allows it.
 */
#include "gdal/vector_file.h"

#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* Drivers for files, as opposed to programs, servers or descriptions of other files. A driver that is not listed here
 * requires network access, because new versions of GDAL bring new drivers, and those that parse with Xerces (NAS,
 * Interlis) fetch whatever a DOCTYPE names. */
static const char *const file_drivers[] = {
    "OSM",    "GeoJSON",      "GeoJSONSeq", "ESRIJSON",      "TopoJSON",  "JSONFG",   "ESRI Shapefile",
    "GPKG",   "SQLite",       "FlatGeobuf", "MBTiles",       "MVT",       "PMTiles",  "GML",
    "GPX",    "KML",          "LIBKML",     "CSV",           "Parquet",   "Arrow",    "OpenFileGDB",
    "CAD",    "MapInfo File", "DXF",        "DGN",           "GeoRSS",    "OGR_GMT",  "UK .NTF",
    "S57",    "LVBAG",        "WAsP",       "Geoconcept",    "VFK",       "EDIGEO",   "SVG",
    "Idrisi", "XLS",          "ODS",        "XLSX",          "SXF",       "Selafin",  "JML",
    "VDV",    "MapML",        "TIGER",      "AVCBin",        "AVCE00",    "OGR_SDTS", "SOSI",
    "PDF",    "netCDF",       "GTFS",       "MiraMonVector", "LIBERTIFF", "AIVector", "PCIDSK",
    "VICAR",  "JP2OpenJPEG",  "BAG",        "FITS",          "Memory",
};
static const char *const databases[] = {"GPKG", "SQLite", "MBTiles"};
/* Drivers for files that name other files. */
static const char *const describing_drivers[] = {"OGR_VRT", "VRT", "GDALG", "GTI", "GMLAS", "PDS4", "OGR_PDS"};

static bool is_in(const char *name, const char *const *list, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (EQUAL(name, list[i]))
            return true;
    return false;
}

bool camber_gdal_reads_file(const char *driver) {
    return is_in(driver, file_drivers, sizeof file_drivers / sizeof *file_drivers);
}

bool camber_gdal_describes(const char *driver) {
    return is_in(driver, describing_drivers, sizeof describing_drivers / sizeof *describing_drivers);
}

bool camber_gdal_has_driver(const camber_context *context, const char *name) {
    const camber_access *access = &context->desc.access;
    if (camber_gdal_reads_file(name))
        return true;
    return camber_gdal_describes(name) ? access->vrt : access->remote;
}

char **camber_gdal_drivers(const camber_context *context, const char *path) {
    char **names = NULL;
    for (int i = 0; i < GDALGetDriverCount(); i++) {
        const char *name = GDALGetDriverShortName(GDALGetDriver(i));
        /* A database inside an archive cannot be checked before it is opened. */
        const bool hidden = STARTS_WITH(path, "/vsi") && is_in(name, databases, sizeof databases / sizeof *databases);
        if (camber_gdal_has_driver(context, name) && (!hidden || context->desc.access.vrt))
            names = CSLAddString(names, name);
    }
    return names;
}

/* Asks only drivers that recognise their files by the first bytes. For other drivers, GDAL would open the file to find
 * out. */
const char *camber_gdal_refused(const camber_context *context, const char *path) {
    static const char *const asked[] = {"OGR_VRT",    "GMLAS", "PDS4",          "OGR_PDS", "WFS", "OAPIF",
                                        "PostgreSQL", "MySQL", "Elasticsearch", "CSW",     NULL};
    CPLPushErrorHandler(CPLQuietErrorHandler);
    GDALDriverH driver = GDALIdentifyDriverEx(path, GDAL_OF_VECTOR, asked, NULL);
    CPLPopErrorHandler();
    const char *name = driver ? GDALGetDriverShortName(driver) : NULL;
    return name && !camber_gdal_has_driver(context, name) ? name : NULL;
}

bool camber_gdal_names_path(const char *srs) {
    static const char *const words[] = {"PROJ4_GRIDS", "grids=", "PARAMETERFILE", "+init=", "+file="};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        for (const char *at = srs; (at = strstr(at, words[i])) != NULL; at++)
            if (strcspn(at, "/~\\") < strcspn(at, "]"))
                return true;
    return false;
}

static bool has_word(const char *text, const char *word) {
    for (; *text; text++)
        if (EQUALN(text, word, strlen(word)))
            return true;
    return false;
}

/* Reads the beginning of a file next to path. */
static bool read_companion(const char *path, const char *ending, char *text, size_t size) {
    VSILFILE *file = VSIFOpenL(CPLResetExtension(path, ending), "rb");
    if (!file)
        return false;
    text[VSIFReadL(text, 1, size - 1, file)] = 0;
    VSIFCloseL(file);
    return true;
}

bool camber_gdal_leads_elsewhere(const char *path) {
    char text[8192] = "";
    const char *ending = CPLGetExtension(path);
    if (EQUAL(ending, "shp") &&
        (read_companion(path, "prj", text, sizeof text) || read_companion(path, "PRJ", text, sizeof text)))
        return camber_gdal_names_path(text);
    char kept[8];
    snprintf(kept, sizeof kept, "%s", ending);
    if (EQUAL(kept, "tab") && read_companion(path, kept, text, sizeof text))
        return has_word(text, "open table") || has_word(text, "isseamless");
    return false;
}

/* Checks each of GDAL's file systems in a path such as /vsizip//vsicurl/... */
bool camber_gdal_is_remote(const char *path) {
    static const char *const systems[] = {"curl", "s3", "gs", "az", "adls", "oss", "swift", "hdfs", "webhdfs"};
    const char *at = path;
    for (const char *slash; STARTS_WITH(at, "/vsi") && (slash = strchr(at + 1, '/')) != NULL;
         at = slash + (slash[1] == '/'))
        for (size_t i = 0; i < sizeof systems / sizeof *systems; i++) {
            const size_t length = strlen(systems[i]);
            if (EQUALN(at + 4, systems[i], length) && strchr("/_?", at[4 + length]))
                return true;
        }
    struct stat about;
    return strstr(path, "://") && !STARTS_WITH_CI(path, "file://") && stat(path, &about) != 0;
}

/* ---- While a file is read ---- */

static const struct {
    const char *name, *value;
    bool is_of_network;
} options[] = {
    /* otherwise GDAL writes a .properties file next to a .gz */
    {"CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO", false},
    /* the other parser fetches whatever a DOCTYPE names */
    {"GML_PARSER", "EXPAT", false},
    /* limits GDAL's network file systems to this one file, which nothing refers to */
    {"CPL_VSIL_CURL_ALLOWED_FILENAME", "/vsicurl/none", true},
};

enum { OPTIONS = sizeof options / sizeof *options };

static CPLHTTPResult *refuse_fetch(const char *url, CSLConstList wanted, GDALProgressFunc progress, void *progress_user,
                                   CPLHTTPFetchWriteFunc write, void *write_user, void *user) {
    (void)url;
    (void)wanted;
    (void)progress;
    (void)progress_user;
    (void)write;
    (void)write_user;
    camber_gdal_confined *confined = user;
    confined->refused++;
    CPLHTTPResult *result = CPLCalloc(1, sizeof *result);
    result->nStatus = 1;
    result->pszErrBuf = CPLStrdup("not allowed");
    return result;
}

camber_status camber_gdal_confine(camber_context *context, camber_gdal_confined *confined) {
    *confined = (camber_gdal_confined){.http = !context->desc.access.remote};
    for (size_t i = 0; i < OPTIONS; i++) {
        const char *old = CPLGetThreadLocalConfigOption(options[i].name, NULL);
        if (old && !(confined->kept[i] = camber_copy_string(context, old))) {
            for (size_t k = 0; k < i; k++)
                camber_free(context, confined->kept[k]);
            return CAMBER_ERROR_MEMORY;
        }
    }
    for (size_t i = 0; i < OPTIONS; i++)
        if (confined->http || !options[i].is_of_network)
            CPLSetThreadLocalConfigOption(options[i].name, options[i].value);
    confined->http = confined->http && CPLHTTPPushFetchCallback(refuse_fetch, confined);
    return CAMBER_OK;
}

void camber_gdal_release(camber_context *context, camber_gdal_confined *confined) {
    if (confined->http)
        CPLHTTPPopFetchCallback();
    for (size_t i = 0; i < OPTIONS; i++) {
        CPLSetThreadLocalConfigOption(options[i].name, confined->kept[i]);
        camber_free(context, confined->kept[i]);
    }
}
