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
    uint32_t column, row; /* column: may lie in the next world */
    unsigned open_sides;  /* CAMBER_SIDE_* */
} camber_tile_address;

typedef struct camber_mvt_desc {
    camber_features *features;
    camber_tile_stitcher *stitcher;
    camber_tile_stitcher *labels; /* for what symbol layers label. NULL: none of it is read */
    const char *const
        *layers; /* the names of the wanted layers. NULL: none; the layers that the tiles hold are only listed */
    size_t layer_count;
    const unsigned *layer_kinds; /* layer_count: CAMBER_KIND_*, what is read of each. NULL: as the next two say */
    bool wants_polygons, wants_areas, wants_points;
    json_t *promote_id;  /* the property that is the id, as a string, or by layer as an object. NULL: none */
    bool wants_progress; /* mapbox_clip_start and mapbox_clip_end are line-progress at a feature's ends */
    bool unsorted;       /* the tiles may have no schema that the style knows, unless it names their layers */
    bool no_schema;      /* they have none, even if a layer has a name that the style knows */
} camber_mvt_desc;

/* Counts of all tiles so far. */
typedef struct camber_mvt_stats {
    size_t skipped_features; /* their geometry is not wanted */
    size_t
        damaged_features; /* the readable part of them is kept; a tile or a layer that does not parse counts as one */
    char damage[256];     /* the first: tile, layer, cause */
    size_t features;      /* in the wanted layers */
    size_t kept_features; /* those of them that gave any points */
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
/* The layers in the order in which they were found, where no layers are wanted. */
const camber_mvt_layer *camber_mvt_layers(const camber_mvt *mvt, size_t *count);
/* Reads a tile; bytes are decompressed. Damage is counted. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_mvt_read(camber_mvt *mvt, const camber_tile_address *address, const void *bytes,
                              size_t size_bytes);
/* Counts a tile that cannot be had. */
void camber_mvt_spoil(camber_mvt *mvt, const camber_tile_address *address, const char *cause);

#endif
