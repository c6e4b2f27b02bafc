/* Chooses which layers of a file are read: the layer that is named, the layer with roads, or all layers that contain
 * lines. */
#include "gdal/vector_file.h"

#include <cpl_string.h>
#include <string.h>

/* How many features are examined if a layer does not declare its geometry type. */
enum { PEEKED_FEATURES = 32 };

/* Whether a layer of this type may have features of kinds that are read. kinds: CAMBER_KIND_*. */
static bool holds_read(OGRwkbGeometryType type, unsigned kinds) {
    switch (wkbFlatten(type)) {
    case wkbUnknown:
    case wkbLineString:
    case wkbMultiLineString:
    case wkbGeometryCollection:
    case wkbCircularString:
    case wkbCompoundCurve:
    case wkbCurve:
    case wkbMultiCurve: return true;
    case wkbPolygon:
    case wkbMultiPolygon:
    case wkbCurvePolygon:
    case wkbMultiSurface:
    case wkbSurface:
    case wkbPolyhedralSurface:
    case wkbTIN:
    case wkbTriangle: return kinds & (CAMBER_KIND_POLYGON | CAMBER_KINDS_OF_AREAS);
    case wkbPoint:
    case wkbMultiPoint: return kinds & CAMBER_KINDS_OF_POINTS;
    default: return false;
    }
}

/* Whether the first features are lines. Needed for tiles, which declare no types. */
static bool begins_with_lines(OGRLayerH layer) {
    bool found = false;
    OGR_L_ResetReading(layer);
    for (int i = 0; i < PEEKED_FEATURES && !found; i++) {
        OGRFeatureH feature = OGR_L_GetNextFeature(layer);
        if (!feature)
            break;
        OGRGeometryH geometry = OGR_F_GetGeometryRef(feature);
        const OGRwkbGeometryType type = geometry ? wkbFlatten(OGR_G_GetGeometryType(geometry)) : wkbNone;
        found = type == wkbLineString || type == wkbMultiLineString;
        OGR_F_Destroy(feature);
    }
    OGR_L_ResetReading(layer);
    return found;
}

/* Finds the layer with roads by the names in common schemas: OpenMapTiles, Mapbox Streets, Shortbread, Tilezen, TIGER.
 */
static int find_roads(GDALDatasetH handle) {
    static const char *const names[] = {"transportation", "roads",   "road",     "streets",
                                        "street",         "highway", "highways", "tiger"};
    const int count = GDALDatasetGetLayerCount(handle);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        for (int i = 0; i < count; i++)
            if (EQUAL(OGR_L_GetName(GDALDatasetGetLayer(handle, i)), names[k]))
                return i;
    for (int i = 0; i < count; i++)
        if (begins_with_lines(GDALDatasetGetLayer(handle, i)))
            return i;
    return -1;
}

static int find_layer(GDALDatasetH handle, const char *name) {
    const int count = GDALDatasetGetLayerCount(handle);
    for (int i = 0; i < count; i++)
        if (strcmp(OGR_L_GetName(GDALDatasetGetLayer(handle, i)), name) == 0)
            return i;
    return -1;
}

static camber_status fail_layer(const camber_dataset *dataset) {
    char names[512] = "";
    size_t used = 0;
    const int count = GDALDatasetGetLayerCount(dataset->handle);
    for (int i = 0; i < count; i++) {
        const char *name = OGR_L_GetName(GDALDatasetGetLayer(dataset->handle, i));
        const size_t length = strlen(name);
        if (used + length + 7 > sizeof names) {
            memcpy(names + used, ", ...", 6);
            break;
        }
        if (i) {
            memcpy(names + used, ", ", 2);
            used += 2;
        }
        memcpy(names + used, name, length + 1);
        used += length;
    }
    if (dataset->desc->layer)
        return camber_fail(dataset->context, CAMBER_ERROR_INPUT, "%s: no layer \"%s\"; choose one of: %s",
                           dataset->desc->path, dataset->desc->layer, count ? names : "(it has no layers)");
    return camber_fail(dataset->context, CAMBER_ERROR_INPUT, "%s: no layer has lines; its layers are: %s",
                       dataset->desc->path, count ? names : "(none)");
}

camber_status camber_dataset_layers(camber_dataset *dataset, const camber_features *features, int **layers,
                                    size_t *count) {
    const unsigned kinds = camber_features_kinds(features, true), osm_kinds = camber_features_kinds(features, false);
    GDALDatasetH handle = dataset->handle;
    const int total = GDALDatasetGetLayerCount(handle);
    int *chosen = camber_alloc(dataset->context, (size_t)(total > 0 ? total : 1) + 2, sizeof *chosen);
    if (!chosen)
        return CAMBER_ERROR_MEMORY;
    const char *driver = GDALGetDriverShortName(GDALGetDatasetDriver(handle));
    size_t found = 0;
    int one = -1;
    if (dataset->desc->layer)
        one = find_layer(handle, dataset->desc->layer);
    else if (dataset->osm)
        one = find_layer(handle, "lines");
    else if (EQUAL(driver, "MBTiles") || EQUAL(driver, "MVT"))
        one = find_roads(handle);
    else
        for (int i = 0; i < total; i++)
            if (holds_read(OGR_L_GetGeomType(GDALDatasetGetLayer(handle, i)), kinds))
                chosen[found++] = i;
    if (one >= 0)
        chosen[found++] = one;
    /* Closed ways are in the layer of lines. Areas that relations make from ways have a layer of their own, and so have
     * nodes. */
    if (dataset->osm && !dataset->desc->layer && osm_kinds & CAMBER_KINDS_OF_AREAS &&
        (one = find_layer(handle, "multipolygons")) >= 0)
        chosen[found++] = one;
    if (dataset->osm && !dataset->desc->layer && osm_kinds & CAMBER_KINDS_OF_POINTS &&
        (one = find_layer(handle, "points")) >= 0)
        chosen[found++] = one;
    if (found == 0) {
        camber_free(dataset->context, chosen);
        return fail_layer(dataset);
    }
    *layers = chosen;
    *count = found;
    return CAMBER_OK;
}
