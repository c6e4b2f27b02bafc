/* The painter draws what the queue asks for: tiles by engines, pictures of any view by scenes, of one chart, which is
 * replaced while it works. */
#ifndef CAMBER_SERVE_PAINTER_H
#define CAMBER_SERVE_PAINTER_H

#include "serve/draw_queue.h"

#include "camber_tiles.h"

enum { CAMBER_CHART_THEMES = 2, CAMBER_CHART_MOST_RATIO = 8 };

/* A chart is what is drawn: features in one style, or in the two themes of one. The painter's thread alone uses what it
 * names from when it is put until it is closed. */
typedef struct camber_chart {
    camber_features *features;
    camber_style *styles[CAMBER_CHART_THEMES]; /* light or the only one; dark. NULL: there is none */
    camber_renderer *renderer;
    camber_device *device;
    double simplify_px;
    camber_coverage coverage;
    uint32_t threads; /* as camber_tiles_engine_desc has it */
    bool opaque;      /* the background covers everything at each zoom */
    uint64_t input;   /* a hash of all of the above, as camber_tile_cache_clear has it */
    /* Tells how drawing a picture has ended, behind what the library has said. NULL: nobody is told. */
    void (*drawn)(void *owner, camber_status status);
    /* Frees features, styles and whatever they need. NULL: the caller does so. */
    void (*close)(void *owner);
    void *owner; /* of both */
} camber_chart;

typedef struct camber_painter camber_painter;

/* side: as camber_draw_queue_desc has it. NULL: no memory. */
camber_painter *camber_painter_create(camber_tile_cache *cache, uint32_t side);
/* Closes the charts that are left; no other thread uses the painter any more. */
void camber_painter_destroy(camber_painter *painter);
/* Hands a chart over, from any thread. It is drawn from the next picture on, and
 * the cache is empty. */
void camber_painter_put(camber_painter *painter, const camber_chart *chart);

/* For camber_draw_queue_desc: user is the painter. */
camber_status camber_painter_draw(void *user, const camber_route_request *request, camber_drawn *drawn);
bool camber_painter_prepare(void *user);

#endif
