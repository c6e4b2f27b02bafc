/* Shared by the files that use GDAL: the geometry of a feature, an open file, what GDAL may access, filters, fields. */
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
    bool latitude_first;                    /* the file has latitude before longitude */
    OGRCoordinateTransformationH transform; /* owned */
    unsigned kinds;                         /* CAMBER_KIND_*: the kinds that are read */
    camber_rings rings;
    bool directed; /* outlines go clockwise on the map, and the outlines of holes counter-clockwise */

    camber_world_lines world; /* the last feature's polylines */
    bool left_out;            /* a part of its geometry is not drawn */
    bool damaged;

    /* Totals of all features. */
    size_t raw_points, strange_points; /* strange: not degrees on Earth */
    size_t invalid_points;

    double *raw; /* x of all points of a line, then y of all points */
    size_t raw_capacity;
} camber_feature_lines;

/* Sets the projection for a layer. If srs is NULL, the coordinates are degrees. name is for messages. */
camber_status camber_feature_lines_set_srs(camber_feature_lines *lines, OGRSpatialReferenceH srs, const char *name);
/* Collects the lines of a geometry, or the rings of its polygons. Rings of areas have the form described in rings.h. */
camber_status camber_feature_lines_collect(camber_feature_lines *lines, OGRGeometryH geometry,
                                           camber_geometry_kind kind);
/* Collects a line that is the ring of an area. */
camber_status camber_feature_lines_collect_ring(camber_feature_lines *lines, OGRGeometryH line);
void camber_feature_lines_free(camber_feature_lines *lines);

/* ---- dataset.c: an open file ---- */

/* Fails with CAMBER_ERROR_INPUT because a file, or its coordinate system, refers to another file. */
camber_status camber_dataset_fail_elsewhere(camber_context *context, const char *name);

/* Failures that GDAL reported since the last reset. */
typedef struct camber_gdal_errors {
    size_t failures;
    CPLErrorNum number; /* of the first failure */
    char message[512];  /* of the first failure */
} camber_gdal_errors;

typedef struct camber_dataset {
    camber_context *context;
    const camber_source_desc *desc;
    GDALDatasetH handle;
    bool osm;   /* the file is read by the OSM driver */
    int zoom;   /* the zoom of vector tiles; negative for anything else */
    char *conf; /* OSM: the driver's configuration, and the path at which GDAL finds it */
    char conf_path[64];
    camber_gdal_errors errors;
} camber_dataset;

/* Opens desc->path; desc must outlive the dataset. unsorted: OSM nodes may come in any order. */
camber_status camber_dataset_open(camber_context *context, const camber_source_desc *desc, const camber_schema *schema,
                                  bool unsorted, camber_dataset *dataset);
void camber_dataset_close(camber_dataset *dataset);
/* Returns the attribution: for OpenStreetMap's own formats the text that its licence requires, and for other formats
 * the text in the file. NULL: none. */
const char *camber_dataset_attribution(const camber_dataset *dataset);
/* Finds the indices of the layers to read; free them with camber_free. */
camber_status camber_dataset_layers(camber_dataset *dataset, const camber_features *features, int **layers,
                                    size_t *count);
/* A CPLErrorHandler whose user data is a camber_gdal_errors. */
void CPL_STDCALL camber_gdal_collect(CPLErr level, CPLErrorNum number, const char *message);

/* ---- cures.c: advice on files that GDAL cannot open ---- */

typedef struct camber_gdal_cure {
    size_t at, size; /* the position and size of the bytes that identify the kind of file */
    const char *bytes;
    const char *driver; /* the name of GDAL's driver, if only some builds have it. NULL: GDAL has none */
    const char *what;   /* what the file is */
    const char *before; /* what to do */
    const char *after;  /* continues after the file's path. NULL: the path is not written */
} camber_gdal_cure;

/* Returns NULL if the file's first bytes are not in the table. */
const camber_gdal_cure *camber_gdal_find_cure(const char *path);

/* ---- box.c: reading a layer by its index ---- */

typedef struct camber_box_reading {
    camber_features *features; /* a set with a region */
    camber_feature_lines *lines;
    GDALDatasetH dataset;
    OGRLayerH layer;
    bool has_srs, merges;
    void *user;
    /* Gets the next feature, or NULL at the end. */
    camber_status (*next)(void *user, OGRFeatureH *feature);
    /* Adds the feature to the set, or adds nothing if the feature has no lines. */
    camber_status (*add)(void *user, OGRFeatureH feature);
} camber_box_reading;

/* Reads the features that the set's region needs, in the order of the file: the features that touch the region, and
 * those that affect how these are drawn. *served: false if the layer has no suitable index, or does not state its
 * extent well enough. The set is then unchanged, and the caller reads the whole layer. */
camber_status camber_box_read(const camber_box_reading *reading, bool *served);

/* ---- confine.c: what GDAL may access ---- */

/* Until camber_gdal_release, GDAL fetches nothing on this thread, unless the context allows network access, and writes
 * no files next to others. */
typedef struct camber_gdal_confined {
    char *kept[3]; /* previous values of the thread's options */
    bool http;
    size_t refused; /* the number of refused fetches */
} camber_gdal_confined;
camber_status camber_gdal_confine(camber_context *context, camber_gdal_confined *confined);
void camber_gdal_release(camber_context *context, camber_gdal_confined *confined);
/* Returns the names of the drivers that the context allows, for GDALOpenEx; free them with CSLDestroy. */
char **camber_gdal_drivers(const camber_context *context, const char *path);
bool camber_gdal_has_driver(const camber_context *context, const char *name);
/* Returns the driver of a file if the context does not allow it. NULL: it is allowed, or no driver recognises the file.
 */
const char *camber_gdal_refused(const camber_context *context, const char *path);
/* Whether a driver reads files that contain their own data. */
bool camber_gdal_reads_file(const char *driver);
/* Whether a driver reads files that describe other files. */
bool camber_gdal_describes(const char *driver);
/* Whether the text of a coordinate system refers to another file. PROJ opens the grids that the text names: a bare name
 * is looked up among PROJ's own files, but a path may lead anywhere. */
bool camber_gdal_names_path(const char *srs);
/* Whether GDAL would open other files before they can be checked, because the .prj next to a shapefile or a MapInfo
 * table of tables names them. */
bool camber_gdal_leads_elsewhere(const char *path);
/* Whether a path refers to the network. */
bool camber_gdal_is_remote(const char *path);

/* ---- where.c: attribute filters ---- */

/* Finds the next word of a filter that is outside '...' and so may be a key. Moves *at past the word. Returns NULL at
 * the end. */
const char *camber_where_next(const char **at, size_t *length);
/* Finds the first key in a filter that no feature of the layer has, for OpenStreetMap data in which nothing passes the
 * filter. Reads the file again without the filter. Returns false if all keys occur. */
bool camber_where_find_unknown(const camber_dataset *dataset, OGRLayerH layer, char *key, size_t size);
/* Lists the fields of the layer that a filter can use: "class, name, ...". */
void camber_where_list_fields(OGRLayerH layer, char *text, size_t size);

/* ---- fields.c: the fields of a layer that are read ---- */

/* The field from which a property of the style is read. */
typedef struct camber_column {
    int field; /* negative: the layer does not have it */
    OGRFieldType type;
    bool boolean;
} camber_column;

typedef struct camber_columns {
    camber_features *features;
    camber_column *items; /* schema->property_count */
    camber_value *values; /* schema->property_count */
    bool unsorted;        /* see camber_feature_class */
    int ids[4];           /* vector tiles: fields with an id, by preference */
    size_t id_count;
    int highway, area;
    int *areas; /* OSM: fields of camber_osm_area_keys */
    size_t area_count;
} camber_columns;

/* Finds the fields of a layer. Call this for each layer. */
camber_status camber_columns_find(camber_columns *columns, camber_features *features, OGRFeatureDefnH schema,
                                  bool tiles, bool osm);
void camber_columns_free(camber_columns *columns, camber_context *context);
/* Tells OGR that it need not decode the other fields. */
void camber_columns_ignore_others(const camber_columns *columns, OGRLayerH layer);
camber_status camber_columns_class(camber_columns *columns, OGRFeatureH feature, uint32_t layer,
                                   camber_geometry_kind kind, uint32_t *class_index);
/* Computes a hash of the feature's id, which is the same in every tile. Returns false if it has none. */
bool camber_columns_id(const camber_columns *columns, OGRFeatureH feature, uint64_t *id);
/* OSM: whether a feature is a closed way that has the key "area" or, unless it is a highway, another key that implies
 * an area. The configuration makes the driver leave this decision to the reader, because the driver would take any
 * closed highway with such a key for an area. */
bool camber_columns_is_area(const camber_columns *columns, OGRFeatureH feature, OGRGeometryH geometry);

#endif
