/* GDAL on demand. It comes with a hundred libraries: linking them takes longer than drawing a small map, and every
 * driver that is loaded after them looks through their names for its own. So the shared libcamber-map keeps the files
 * that need GDAL in a module, and loads it with the first file that is read. The static library has them in itself. */
#define _GNU_SOURCE /* dladdr */

#include "features/gdal_calls.h"
#include "formats/tile_reader.h"
#include "osm/osm.h"
#include "osm/xml_order.h"

#include <string.h>
#include <sys/stat.h>

#ifdef CAMBER_GDAL_MODULE
#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>

static const int MODE = RTLD_LAZY | RTLD_LOCAL;

/* Opens the module by its path: beside this library where it is built, in a folder beside it where it is installed. */
static void *open_beside(void) {
    static const char *const folders[] = {"", "camber/"};
    Dl_info here;
    void *module = NULL;
    if (!dladdr(folders, &here) || !here.dli_fname)
        return NULL;
    const char *slash = strrchr(here.dli_fname, '/');
    const int length = slash ? (int)(slash + 1 - here.dli_fname) : 0;
    for (size_t i = 0; i < sizeof folders / sizeof *folders && !module; i++) {
        char path[PATH_MAX];
        const int size = snprintf(path, sizeof path, "%.*s%s" CAMBER_GDAL_MODULE, length, here.dli_fname, folders[i]);
        if (size > 0 && (size_t)size < sizeof path)
            module = dlopen(path, MODE);
    }
    return module;
}

/* Opens the module by the library's RUNPATH, which a sanitizer's dlopen does not know. It stays loaded: GDAL's own
 * threads and caches live as long as the process. */
static const camber_gdal_calls *load(const char **why) {
    void *module = dlopen(CAMBER_GDAL_MODULE, MODE);
    if (!module)
        module = open_beside();
    const camber_gdal_calls *calls = module ? dlsym(module, "camber_gdal") : NULL;
    *why = calls ? NULL : dlerror();
    return calls;
}
#else
static const camber_gdal_calls *load(const char **why) {
    *why = NULL;
    return &camber_gdal;
}
#endif

/* The result is kept, since asking the loader again waits while another thread loads a driver. */
camber_status camber_gdal_load(camber_context *context) {
    const char *why = NULL;
    if (!context->gdal)
        context->gdal = load(&why);
    if (context->gdal)
        return CAMBER_OK;
    const camber_status status = camber_budget_check_drivers(context);
    if (status != CAMBER_OK)
        return status;
    return camber_fail(context, CAMBER_ERROR_IO, "GDAL cannot be loaded: %s; install camber and GDAL again",
                       why ? why : "no reason given");
}

/* Decides who reads a file. GDAL opens tiles one by one and knows no PMTiles, but it filters by attributes and reads
 * inside archives. */
bool camber_source_needs_gdal(const camber_source_desc *desc) {
    struct stat about;
    if (camber_osm_reads(desc))
        return false;
    if (!camber_tile_set_knows(desc->path) || strncmp(desc->path, "/vsi", 4) == 0)
        return true;
    return desc->where || (stat(desc->path, &about) == 0 && S_ISDIR(about.st_mode));
}

/* GDAL has read OpenStreetMap's XML: it says nothing of ways that it has left out since it had not met their nodes. */
static camber_status check_order(const camber_features *features, const camber_source_desc *desc, size_t before) {
    if (!camber_osm_xml_is_unordered(desc->path))
        return CAMBER_OK;
    if (features->feature_count == before)
        return camber_fail(features->context, CAMBER_ERROR_INPUT,
                           "%s: no lines: nodes come behind the ways that name them, or ways behind relations; sort it "
                           "by osmium sort",
                           desc->path);
    camber_log(features->context, CAMBER_LOG_WARNING,
               "%s: nodes come behind ways, or ways behind relations; some may be left out: sort it by osmium sort",
               desc->path);
    return CAMBER_OK;
}

static camber_status read_file(camber_features *features, const camber_source_desc *desc) {
    const size_t before = features->feature_count;
    bool declined = true;
    camber_status status = camber_osm_reads(desc) ? camber_osm_read(features, desc, &declined) : CAMBER_OK;
    if (!declined || status != CAMBER_OK)
        return status;
    if (!camber_osm_reads(desc) && !camber_source_needs_gdal(desc))
        return camber_features_read_tile_file(features, desc);
    status = camber_osm_check_for_gdal(features->context, desc);
    if (status == CAMBER_OK)
        status = camber_gdal_load(features->context);
    const camber_gdal_calls *calls = features->context->gdal;
    if (status == CAMBER_OK)
        status = calls->read(features, desc);
    return status == CAMBER_OK ? check_order(features, desc, before) : status;
}

camber_status camber_features_read(camber_features *features, const camber_source_desc *desc) {
    struct stat about;
    const camber_status status = read_file(features, desc);
    if (status == CAMBER_OK && stat(desc->path, &about) == 0 && S_ISREG(about.st_mode))
        features->stats.input_bytes += (size_t)about.st_size;
    return status;
}

const char *camber_format_list(size_t n) {
    const char *why;
    const camber_gdal_calls *calls = load(&why);
    return calls ? calls->format_name(n) : NULL;
}

const char *camber_gdal_get_version(void) {
    const char *why;
    const camber_gdal_calls *calls = load(&why);
    return calls ? calls->version() : NULL;
}
