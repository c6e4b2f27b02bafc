/* Reads GeoJSON sources of a style, and GeoJSON files without GDAL: all properties as they are, with ids, and nothing
 * simplified. */
#ifndef CAMBER_FORMATS_GEOJSON_H
#define CAMBER_FORMATS_GEOJSON_H

#include "features/features.h"
#include "features/reader.h"

/* A parsed document takes about seven times as much memory as its text; jansson does not take it from the context. */
enum { CAMBER_GEOJSON_BYTES_A_BYTE = 8 };

typedef struct camber_geojson_desc {
    const char *what;         /* the source's name, for messages */
    const json_t *root;       /* the document */
    const json_t *promote_id; /* the name of the property to use as id, a string. NULL: none */
    bool generates_ids;       /* a feature's id is its index in the document */
    const char *layer;        /* the features' layer. NULL: one without a name */
    bool unsorted;            /* see camber_feature_class */
    unsigned kinds;           /* CAMBER_KIND_*: the kinds that are drawn. 0: all that the style reads */
    bool (*matches)(const void *user,
                    const camber_feature_view *feature); /* the source's filter. NULL: all features pass */
    const void *user;
} camber_geojson_desc;

typedef struct camber_geojson_stats {
    size_t skipped_features;
    size_t invalid_points;   /* points that are not numbers; lines are split there */
    size_t damaged_features; /* features of which only the readable parts are kept */
    char damage[160];        /* the first damage: its JSON pointer and cause */
    double bounds[4]; /* x0, y0, x1, y1: the box around the lines in world coordinates; x0 > x1: there are none */
} camber_geojson_stats;

/* Adds the lines, outlines and areas to the set, with features->source as their source. Returns CAMBER_ERROR_INPUT (not
 * GeoJSON), CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_geojson_read(camber_features *features, const camber_geojson_desc *desc,
                                  camber_geojson_stats *stats);

/* Reads files if GDAL cannot be loaded, and if neither a layer nor a filter is asked for. */
extern const camber_reader camber_geojson_file_reader;

#endif
