/* Internals of the engine, for the files that draw archives. */
#ifndef CAMBER_TILES_ENGINE_H
#define CAMBER_TILES_ENGINE_H

#include "camber_tiles.h"
#include "map/zoom_labels.h"
#include "tiles/area.h"
#include "tiles/census.h"
#include "tiles/mesh_tile.h"

/* The longest side of a picture of several tiles. */
enum { CAMBER_PICTURE_PX = 2048 };

typedef struct camber_engine_zoom {
    camber_zoom_plan *plan;     /* NULL: not evaluated yet */
    camber_mesh_plan *mesh;     /* if tiles are meshes: the mesh plan, which owns plan. NULL: tiles are pictures */
    camber_census census;       /* context is NULL until it is made */
    camber_zoom_labels *labels; /* NULL: none, or not yet */
    bool has_background;
    uint8_t background[4];
} camber_engine_zoom;

struct camber_tiles_engine {
    camber_context *context;
    const camber_features *features;
    camber_tiles_engine_desc desc; /* with its defaults filled in */
    uint32_t tile_px;
    camber_workers workers;
    camber_mesh *mesh;
    camber_label_things things; /* context is NULL until they are found */
    camber_label_shelf shelf;
    camber_engine_zoom zooms[CAMBER_LARGEST_TILE_ZOOM + 1];
    double census_ms, make_ms, draw_ms;
};

/* Frees all data that is kept for a zoom. */
void camber_engine_forget_zoom(camber_tiles_engine *engine, int zoom);
/* Evaluates the style for the zoom, unless that has been done. */
camber_status camber_engine_plan_zoom(camber_tiles_engine *engine, int zoom, camber_engine_zoom **planned);
/* Does the same, and also takes the census of the zoom. */
camber_status camber_engine_open_zoom(camber_tiles_engine *engine, int zoom, camber_engine_zoom **opened);
/* Returns the size of a tile in device px; less than 1 if the desc is invalid. */
double camber_engine_tile_px(const camber_tiles_engine_desc *desc);
/* Returns how the style is evaluated for tiles of a zoom. */
camber_zoom_desc camber_engine_zoom_desc(const camber_tiles_engine_desc *desc, int zoom);
/* Returns how many tiles a picture has on a side. For archives, a metatile of the census has the same size. */
static inline uint32_t camber_engine_side(const camber_tiles_engine *engine, int zoom) {
    const uint32_t most = engine->desc.on_demand_side ? engine->desc.on_demand_side : CAMBER_METATILE_SIDE_MOST;
    uint32_t side = 1;
    for (int i = 0; i < zoom && side < most && 2 * side * engine->tile_px <= CAMBER_PICTURE_PX; i++)
        side *= 2;
    return side;
}
/* Finds the labels of a zoom whose plan has been evaluated; NULL if no fonts were read with the features, or if tiles
 * are meshes (label_tiles.c). */
camber_status camber_engine_get_labels(camber_tiles_engine *engine, int zoom, camber_zoom_labels **labels);
/* Returns the square of the map that a metatile shows. */
camber_label_square camber_engine_square(const camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row);
/* Finds the tiles of a metatile that labels touch, as bits in the order of camber_metatile.tiles. */
camber_status camber_engine_find_label_tiles(camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row,
                                             uint64_t *tiles);
/* Adds the tiles that labels touch to the census of an open zoom, as far as they are in the area. */
camber_status camber_engine_add_label_tiles(camber_tiles_engine *engine, int zoom, const camber_tiles_area *area);
/* Describes the picture of a metatile without drawing it. The zoom must be open. metatile NULL: no line touches it. */
camber_tiles_picture camber_engine_describe(const camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row,
                                            const camber_metatile *metatile);
/* Tessellates a metatile of an open zoom, if tiles are meshes. Free lines with camber_mesh_picture_free, also after a
 * failure. */
camber_status camber_engine_tessellate_metatile(camber_tiles_engine *engine, const camber_metatile *metatile,
                                                camber_tiles_picture *picture, camber_mesh_picture *lines);
/* Draws a metatile of an open zoom into rgba. */
camber_status camber_engine_draw_metatile(camber_tiles_engine *engine, const camber_metatile *metatile, uint8_t *rgba,
                                          camber_tiles_picture *picture);

#endif
