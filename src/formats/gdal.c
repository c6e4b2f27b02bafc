/* Passes files to GDAL, which is loaded when the first of these files is read, because GDAL needs a hundred libraries.
 * Loading them takes longer than drawing a small map. It also slows down every driver that is loaded later, because the
 * loader searches them all for the driver's symbols. */
#include "formats/gdal.h"
#include "features/features.h"
#include "features/gdal_calls.h"

/* The result is kept, because asking the loader again would block while another thread loads a driver. path: the file
 * that needs GDAL, or NULL. */
static camber_status load(camber_context *context, const char *path) {
    const char *why = NULL;
    if (!context->gdal)
        context->gdal = camber_gdal_find(&why);
    if (context->gdal)
        return CAMBER_OK;
    const camber_status status = camber_budget_check_drivers(context);
    if (status != CAMBER_OK)
        return status;
    return camber_fail(context, CAMBER_ERROR_IO,
                       "%s%sGDAL cannot be loaded: %s; install it (Debian: gdal-bin), or give a GeoJSON or PBF file, "
                       "without a filter, which camber reads itself",
                       path ? path : "", path ? ": it is read by GDAL, and " : "", why ? why : "no reason given");
}

camber_status camber_gdal_load(camber_context *context) {
    return load(context, NULL);
}

static bool knows(const char *path) {
    (void)path;
    return true;
}

static bool reads(const camber_source_desc *desc) {
    (void)desc;
    return true;
}

static camber_status read_by_gdal(camber_features *features, const camber_source_desc *desc, bool *declined) {
    *declined = false;
    const camber_status status = load(features->context, desc->path);
    const camber_gdal_calls *calls = features->context->gdal;
    return status == CAMBER_OK ? calls->read(features, desc) : status;
}

static const char *format(size_t n) {
    const char *why;
    const camber_gdal_calls *calls = camber_gdal_find(&why);
    return calls ? calls->format_name(n) : NULL;
}

const char *camber_gdal_get_version(void) {
    const char *why;
    const camber_gdal_calls *calls = camber_gdal_find(&why);
    return calls ? calls->version() : NULL;
}

const camber_reader camber_gdal_reader = {.knows = knows, .reads = reads, .read = read_by_gdal, .format = format};
