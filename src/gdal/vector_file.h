/* Shared by the files that need GDAL: the geometry of one feature, an open file, what GDAL may reach, fields. */
#ifndef CAMBER_GDAL_VECTOR_FILE_H
#define CAMBER_GDAL_VECTOR_FILE_H

#include "features/features.h"
#include "features/osm_keys.h"
#include "features/rings.h"
#include "features/tile_stitcher.h"
#include "features/world_lines.h"

#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

/* ---- polylines.c: a feature's geometry as world polylines ---- */

typedef enum camber_projection_kind {
    CAMBER_PROJECTION_DEGREES = 0, /* longitude and latitude of WGS 84 */
    CAMBER_PROJECTION_METRES,      /* EPSG:3857 */
    CAMBER_PROJECTION_TRANSFORM,   /* anything else, through PROJ to degrees */
} camber_projection_kind;

typedef struct camber_feature_lines {
    camber_context *context;
    camber_projection_kind projection;
    bool latitude_first;                    /* degrees come as latitude, longitude */
    OGRCoordinateTransformationH transform; /* owned */
    unsigned kinds;                         /* CAMBER_KIND_*: what is read */
    camber_rings rings;
    bool directed; /* outlines go clockwise as seen, those of holes the other way */

    camber_world_lines world; /* the last feature's polylines */
    bool left_out;            /* some of its geometry is not drawn */
    bool damaged;

    /* Sums over all features. */
    size_t raw_points, strange_points; /* strange: not degrees on Earth */
    size_t invalid_points;

    double *raw; /* x of all points of a line, then y */
    size_t raw_capacity;
} camber_feature_lines;

/* Sets the projection for a layer; srs may be NULL: degrees. name stands in messages. */
camber_status camber_feature_lines_set_srs(camber_feature_lines *lines, OGRSpatialReferenceH srs, const char *name);
/* Collects the lines of a geometry, or the rings of its polygons; those of areas are as rings.h has them. */
camber_status camber_feature_lines_collect(camber_feature_lines *lines, OGRGeometryH geometry,
                                           camber_geometry_kind kind);
/* Collects a line that is the ring of an area. */
camber_status camber_feature_lines_collect_ring(camber_feature_lines *lines, OGRGeometryH line);
void camber_feature_lines_free(camber_feature_lines *lines);

/* ---- dataset.c: an open file ---- */

/* CAMBER_ERROR_INPUT: a file, or its coordinate system, leads to another file. */
camber_status camber_dataset_fail_elsewhere(camber_context *context, const char *name);

/* GDAL's failures since the last reset. */
typedef struct camber_gdal_errors {
    size_t failures;
    CPLErrorNum number; /* number of the first failure */
    char message[512];  /* the first */
} camber_gdal_errors;

typedef struct camber_dataset {
    camber_context *context;
    const camber_source_desc *desc;
    GDALDatasetH handle;
    bool osm;   /* the OSM driver */
    int zoom;   /* the zoom of vector tiles, below 0 for anything else */
    char *conf; /* OSM: the configuration, and where GDAL sees it */
    char conf_path[64];
    camber_gdal_errors errors;
} camber_dataset;

/* Opens desc->path, which stays named by the dataset. unsorted: OSM nodes come in no order. */
camber_status camber_dataset_open(camber_context *context, const camber_source_desc *desc, const camber_schema *schema,
                                  bool unsorted, camber_dataset *dataset);
void camber_dataset_close(camber_dataset *dataset);
/* The attribution: for OpenStreetMap's own formats what its licence asks for, for others what the file says. NULL:
 * none. */
const char *camber_dataset_attribution(const camber_dataset *dataset);
/* Indices of the layers to read; freed with camber_free. */
camber_status camber_dataset_layers(camber_dataset *dataset, const camber_features *features, int **layers,
                                    size_t *count);
/* CPLErrorHandler whose user data is a camber_gdal_errors. */
void CPL_STDCALL camber_gdal_collect(CPLErr level, CPLErrorNum number, const char *message);

/* ---- cures.c: files that GDAL does not open ---- */

typedef struct camber_gdal_cure {
    size_t at, size; /* where the bytes are that tell the kind of file, and how many */
    const char *bytes;
    const char *driver; /* GDAL's, if only some builds have it. NULL: GDAL has none */
    const char *what;   /* what the file is */
    const char *before; /* what to do */
    const char *after;  /* the rest of it, after the file's path. NULL: without the path */
} camber_gdal_cure;

/* NULL: its first bytes tell nothing. */
const camber_gdal_cure *camber_gdal_find_cure(const char *path);

/* ---- box.c: reading a layer by its index ---- */

typedef struct camber_box_reading {
    camber_features *features; /* with a region */
    camber_feature_lines *lines;
    GDALDatasetH dataset;
    OGRLayerH layer;
    bool has_srs, merges;
    void *user;
    /* Gives the next feature; NULL at the end. */
    camber_status (*next)(void *user, OGRFeatureH *feature);
    /* Adds the feature to the set, or nothing where it has no lines. */
    camber_status (*add)(void *user, OGRFeatureH feature);
} camber_box_reading;

/* Reads the features that the set's region needs: those that touch it, and those that decide how these are drawn, in
 * the order of the file. *served: false where the layer has no such index, or says too little about where it lies; the
 * set is then as before, and the layer is to be read whole. */
camber_status camber_box_read(const camber_box_reading *reading, bool *served);

/* ---- confine.c: what GDAL may reach ---- */

/* Until the end nothing is fetched on this thread, unless the context's access has it, and nothing is written beside
 * files. */
typedef struct camber_gdal_confined {
    char *kept[3]; /* former values of the thread's options */
    bool http;
    size_t refused; /* fetches */
} camber_gdal_confined;
camber_status camber_gdal_confine(camber_context *context, camber_gdal_confined *confined);
void camber_gdal_release(camber_context *context, camber_gdal_confined *confined);
/* Names of the drivers that the context's access has, for GDALOpenEx; freed with CSLDestroy. */
char **camber_gdal_drivers(const camber_context *context, const char *path);
bool camber_gdal_has_driver(const camber_context *context, const char *name);
/* The driver of a file, where the context's access does not allow it. NULL: it does, or no driver knows the file. */
const char *camber_gdal_refused(const camber_context *context, const char *path);
/* Whether a driver reads files that have their data in themselves. */
bool camber_gdal_reads_file(const char *driver);
/* Whether a driver reads descriptions of what lies in other files. */
bool camber_gdal_describes(const char *driver);
/* Whether the text of a coordinate system leads to another file: PROJ opens the grids that it names, by their names
 * among its own, by a path anywhere. */
bool camber_gdal_names_path(const char *srs);
/* Whether GDAL would open other files before it tells of them: by the .prj beside a shapefile, as a MapInfo table of
 * tables. */
bool camber_gdal_leads_elsewhere(const char *path);
/* Whether a path leads to the network. */
bool camber_gdal_is_remote(const char *path);

/* ---- where.c: attribute filters ---- */

/* The next word of a filter outside '...': it may be a key. *at moves behind it. NULL: there is no more. */
const char *camber_where_next(const char **at, size_t *length);
/* Finds the first key of a filter that no feature of the layer has, for OpenStreetMap data where nothing passes the
 * filter. Reads the file again, without the filter. false: all keys are there. */
bool camber_where_find_unknown(const camber_dataset *dataset, OGRLayerH layer, char *key, size_t size);
/* "class, name, ...": the fields that a filter of the layer can compare. */
void camber_where_list_fields(OGRLayerH layer, char *text, size_t size);

/* ---- fields.c: the fields of a layer that are read ---- */

/* The field that a property of the style is read from. */
typedef struct camber_column {
    int field; /* below 0: the layer does not have it */
    OGRFieldType type;
    bool boolean;
} camber_column;

typedef struct camber_columns {
    camber_features *features;
    camber_column *items; /* schema->property_count */
    camber_value *values; /* schema->property_count */
    bool unsorted;        /* as a class has it */
    int ids[4];           /* vector tiles: fields with an id, the best first */
    size_t id_count;
    int highway, area;
    int *areas; /* OSM: fields of camber_osm_area_keys */
    size_t area_count;
} camber_columns;

/* Finds the fields of a layer; again for the next layer. */
camber_status camber_columns_find(camber_columns *columns, camber_features *features, OGRFeatureDefnH schema,
                                  bool tiles, bool osm);
void camber_columns_free(camber_columns *columns, camber_context *context);
/* Tells OGR that the other fields need not be decoded. */
void camber_columns_ignore_others(const camber_columns *columns, OGRLayerH layer);
camber_status camber_columns_class(camber_columns *columns, OGRFeatureH feature, uint32_t layer,
                                   camber_geometry_kind kind, uint32_t *class_index);
/* A hash of the feature's id, the same in every tile; false: it has none. */
bool camber_columns_id(const camber_columns *columns, OGRFeatureH feature, uint64_t *id);
/* OSM: a closed way with the key area, or with another key of areas where it is no highway. The driver is told to leave
 * them to us, for it takes closed highways with any such key for areas. */
bool camber_columns_is_area(const camber_columns *columns, OGRFeatureH feature, OGRGeometryH geometry);

#endif
