/* What GDAL may reach while it reads a file: by itself it follows what files say to servers and to other files. Drivers
 * are those whose files have their data in themselves and in the parts of their format; fetching is refused. */
#include "source/source.h"

#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <string.h>

/* Files, and no programs, servers or descriptions of other files. What is not listed is for who allows the network:
 * GDAL grows new drivers. */
static const char *const file_drivers[] = {
    "OSM",       "GeoJSON",      "GeoJSONSeq", "ESRIJSON",   "TopoJSON",    "JSONFG",  "ESRI Shapefile",
    "GPKG",      "SQLite",       "FlatGeobuf", "MBTiles",    "MVT",         "PMTiles", "GML",
    "GPX",       "KML",          "LIBKML",     "CSV",        "Parquet",     "Arrow",   "OpenFileGDB",
    "CAD",       "MapInfo File", "DXF",        "DGN",        "GeoRSS",      "OGR_GMT", "UK .NTF",
    "S57",       "LVBAG",        "NAS",        "Interlis 1", "Interlis 2",  "WAsP",    "Geoconcept",
    "VFK",       "EDIGEO",       "SVG",        "Idrisi",     "XLS",         "ODS",     "XLSX",
    "SXF",       "Selafin",      "JML",        "VDV",        "MapML",       "TIGER",   "AVCBin",
    "AVCE00",    "OGR_SDTS",     "SOSI",       "PDF",        "netCDF",      "GTFS",    "MiraMonVector",
    "LIBERTIFF", "AIVector",     "PCIDSK",     "VICAR",      "JP2OpenJPEG", "BAG",     "FITS",
    "Memory",
};
/* Their files name others. */
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

char **camber_gdal_drivers(const camber_context *context) {
    char **names = NULL;
    for (int i = 0; i < GDALGetDriverCount(); i++) {
        const char *name = GDALGetDriverShortName(GDALGetDriver(i));
        if (camber_gdal_has_driver(context, name))
            names = CSLAddString(names, name);
    }
    return names;
}

const char *camber_gdal_refused(const camber_context *context, const char *path) {
    CPLPushErrorHandler(CPLQuietErrorHandler);
    GDALDriverH driver = GDALIdentifyDriverEx(path, GDAL_OF_VECTOR, NULL, NULL);
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

bool camber_gdal_projects_by_path(const char *path) {
    char text[8192] = "";
    if (!EQUAL(CPLGetExtension(path), "shp"))
        return false;
    VSILFILE *file = VSIFOpenL(CPLResetExtension(path, "prj"), "rb");
    if (!file)
        file = VSIFOpenL(CPLResetExtension(path, "PRJ"), "rb");
    if (!file)
        return false;
    text[VSIFReadL(text, 1, sizeof text - 1, file)] = 0;
    VSIFCloseL(file);
    return camber_gdal_names_path(text);
}

bool camber_gdal_is_remote(const char *path) {
    static const char *const systems[] = {"/vsicurl", "/vsis3",    "/vsigs",   "/vsiaz",     "/vsiadls",
                                          "/vsioss",  "/vsiswift", "/vsihdfs", "/vsiwebhdfs"};
    for (size_t i = 0; i < sizeof systems / sizeof *systems; i++)
        if (strstr(path, systems[i]))
            return true;
    return strstr(path, "://") != NULL && !STARTS_WITH_CI(path, "file://");
}

/* ---- While a file is read ---- */

static const struct {
    const char *name, *value;
    bool is_of_network;
} options[] = {
    /* Or GDAL writes a .properties file beside a .gz. */
    {"CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO", false},
    /* Its file systems of the network have this one file, which nobody names. */
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
            camber_free(context, confined->kept[0]);
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
