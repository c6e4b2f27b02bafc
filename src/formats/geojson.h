/* GeoJSON sources of a style: every property as it stands, ids, nothing of it split or simplified. */
#ifndef CAMBER_FORMATS_GEOJSON_H
#define CAMBER_FORMATS_GEOJSON_H

#include "features/features.h"

typedef struct camber_geojson_desc {
    const char *what;         /* the source, in messages */
    const json_t *root;       /* the document */
    const json_t *promote_id; /* the name of the property that is the id, a string. NULL: none */
    bool generates_ids;       /* a feature's id is its place in the document */
    unsigned kinds;           /* CAMBER_KIND_*: what is drawn of it. 0: all that the style wants */
    bool (*matches)(const void *user, const camber_feature_view *feature); /* which features exist. NULL: all */
    const void *user;
} camber_geojson_desc;

typedef struct camber_geojson_stats {
    size_t skipped_features;
    size_t invalid_points;   /* no numbers; their lines are split there */
    size_t damaged_features; /* the readable part of them is kept */
    char damage[160];        /* the first: its JSON pointer and the cause */
    double bounds[4];        /* x0, y0, x1, y1 of the lines, world coordinates; x0 > x1: none */
} camber_geojson_stats;

/* Adds the lines, outlines and areas to the set, as features of features->source. Returns CAMBER_ERROR_INPUT (no
 * GeoJSON), CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_geojson_read(camber_features *features, const camber_geojson_desc *desc,
                                  camber_geojson_stats *stats);

#endif
