/* One vector tile after the other into a set: lines and outlines of the wanted layers, cut at the tiles' borders. */
#ifndef CAMBER_MVT_H
#define CAMBER_MVT_H

#include "source/features.h"
#include "source/pool.h"
#include "source/tile_stitcher.h"

/* Where a tile lies. */
typedef struct camber_tile_address {
    int zoom;
    uint32_t column, row; /* column: may lie in the next world */
    unsigned open_sides;  /* CAMBER_SIDE_* */
} camber_tile_address;

typedef struct camber_mvt_desc {
    camber_features *features;
    camber_tile_stitcher *stitcher;
    const char *const *layers; /* the wanted ones. NULL: none, what the tiles hold is looked at only */
    size_t layer_count;
    bool wants_polygons;
    json_t *promote_id;  /* the property that is the id, as a string, or by layer as an object. NULL: none */
    bool wants_progress; /* mapbox_clip_start and mapbox_clip_end are line-progress at a feature's ends */
    bool plain;          /* CAMBER_PLAIN_PROPERTY is true until a layer is seen to name another property */
} camber_mvt_desc;

/* What happened so far. */
typedef struct camber_mvt_stats {
    size_t skipped_features; /* other geometry than is wanted */
    size_t damaged_features; /* what of them reads is kept; a tile or a layer that does not parse counts as one */
    char damage[256];        /* the first: tile, layer, cause */
    size_t features;         /* of the wanted layers */
    size_t kept_features;    /* of these, those that gave any points */
    bool names_property;     /* a wanted layer has a key that the style names */
} camber_mvt_stats;

/* A layer that some tile has. */
typedef struct camber_mvt_layer {
    char *name;
    bool has_lines; /* among its first features */
} camber_mvt_layer;

typedef struct camber_mvt camber_mvt;

camber_status camber_mvt_create(camber_context *context, const camber_mvt_desc *desc, camber_mvt **mvt);
void camber_mvt_destroy(camber_mvt *mvt);
const camber_mvt_stats *camber_mvt_get_stats(const camber_mvt *mvt);
/* In the order they were met, where no layers are wanted. */
const camber_mvt_layer *camber_mvt_layers(const camber_mvt *mvt, size_t *count);
/* bytes: decompressed. What is damaged is counted. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_mvt_read(camber_mvt *mvt, const camber_tile_address *address, const void *bytes,
                              size_t size_bytes);
/* Counts a tile that cannot be had. */
void camber_mvt_spoil(camber_mvt *mvt, const camber_tile_address *address, const char *cause);

#endif
