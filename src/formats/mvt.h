/* Reads one vector tile after the other into a set: lines, outlines and areas of the wanted layers, cut at the tiles'
 * borders. */
#ifndef CAMBER_FORMATS_MVT_H
#define CAMBER_FORMATS_MVT_H

#include "features/features.h"
#include "features/tile_stitcher.h"
#include "formats/pool.h"

/* The address of a tile. */
typedef struct camber_tile_address {
    int zoom;
    uint32_t column, row; /* the column may be in the next copy of the world */
    unsigned open_sides;  /* CAMBER_SIDE_*: sides whose neighbour is not read */
} camber_tile_address;

typedef struct camber_mvt_desc {
    camber_features *features;
    camber_tile_stitcher *stitcher;
    camber_tile_stitcher *labels; /* for features that symbol layers label. NULL: none is read */
    const char *const *layers;    /* names of the wanted layers. NULL: only list the layers of the tiles */
    size_t layer_count;
    const unsigned *layer_kinds; /* layer_count: CAMBER_KIND_*, the kinds to read from each. NULL: decided by unsorted
                                    and no_schema */
    bool wants_polygons, wants_areas, wants_points;
    json_t *promote_id;  /* the property to use as id: a string, or an object with a string per layer. NULL: none */
    bool wants_progress; /* mapbox_clip_start and mapbox_clip_end give line-progress at a feature's ends */
    bool unsorted;       /* the style does not know the tiles' schema, except for layers that it names */
    bool no_schema;      /* the style does not know the tiles' schema, even if it names one of their layers */
} camber_mvt_desc;

/* Counts over all tiles so far. */
typedef struct camber_mvt_stats {
    size_t skipped_features; /* features whose geometry is not wanted */
    size_t damaged_features; /* features of which only the readable parts are kept; a tile or layer that cannot be
                                parsed counts as one */
    char damage[256];        /* the first damage: tile, layer, cause */
    size_t features;         /* features in the wanted layers */
    size_t kept_features;    /* features in the wanted layers of which at least one point was kept */
} camber_mvt_stats;

/* A layer that occurs in some tile. */
typedef struct camber_mvt_layer {
    char *name;
    bool has_lines; /* judged by the layer's first features */
} camber_mvt_layer;

typedef struct camber_mvt camber_mvt;

camber_status camber_mvt_create(camber_context *context, const camber_mvt_desc *desc, camber_mvt **mvt);
void camber_mvt_destroy(camber_mvt *mvt);
const camber_mvt_stats *camber_mvt_get_stats(const camber_mvt *mvt);
/* Returns the layers in the order in which they were found, if no layers were wanted. */
const camber_mvt_layer *camber_mvt_layers(const camber_mvt *mvt, size_t *count);
/* Reads a tile from its decompressed bytes. Damage is counted. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_mvt_read(camber_mvt *mvt, const camber_tile_address *address, const void *bytes,
                              size_t size_bytes);
/* Counts a tile that could not be read. */
void camber_mvt_spoil(camber_mvt *mvt, const camber_tile_address *address, const char *cause);

#endif
