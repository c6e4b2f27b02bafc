/* The painter draws what the queue requests: tiles with engines, and pictures of any view with scenes. It draws one
 * map, which may be replaced while it works. */
#ifndef CAMBER_SERVE_PAINTER_H
#define CAMBER_SERVE_PAINTER_H

#include "serve/draw_queue.h"

#include "camber_tiles.h"

enum { CAMBER_MAP_SOURCE_THEMES = 2, CAMBER_MAP_SOURCE_MOST_RATIO = 8 };

/* A map to draw: features with one style, or with the light and the dark theme of one. After camber_painter_put, only
 * the painter's thread uses its members, until it is closed. */
typedef struct camber_map_source {
    camber_features *features;                      /* with the first of the styles */
    camber_style *styles[CAMBER_MAP_SOURCE_THEMES]; /* light or the only one, then dark. NULL: not available */
    camber_renderer *renderer;
    camber_device *device;
    double simplify_px;
    camber_coverage coverage;
    uint32_t threads; /* as in camber_tiles_engine_desc */
    bool opaque;      /* the background is opaque at each zoom */
    uint64_t input;   /* a hash of all of the above, for camber_tile_cache_clear */
    /* Called after a picture has been drawn, with the status; a failure has already been logged. May be NULL. */
    void (*drawn)(void *owner, camber_status status);
    /* Frees features, styles and whatever they need. NULL: the caller does it. */
    void (*close)(void *owner);
    void *owner; /* passed to both functions */
} camber_map_source;

typedef struct camber_painter camber_painter;

/* map: its index in the cache. side: as in camber_draw_queue_desc. Returns NULL if there is no memory. */
camber_painter *camber_painter_create(camber_tile_cache *cache, uint32_t map, uint32_t side);
/* Closes the remaining map sources. No other thread may use the painter any more. */
void camber_painter_destroy(camber_painter *painter);
/* Sets the map that is drawn from the next picture on, and clears the cache. Any thread may call this. */
void camber_painter_put(camber_painter *painter, const camber_map_source *source);

/* Draw and prepare as camber_draw_queue_desc says. */
camber_status camber_painter_draw(camber_painter *painter, const camber_route_request *request,
                                  camber_rendered_picture *rendered);
bool camber_painter_prepare(camber_painter *painter);

#endif
