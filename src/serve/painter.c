/* Draws tiles and pictures of a chart, on one thread.
 *
 * Engines are made for each theme and ratio that is asked for. While nobody waits, zooms that are looked at most are
 * opened beforehand, so that the first tile of each needs no census. */
#include "serve/painter.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_PREPARED_ZOOM = 10, LAST_PREPARED_ZOOM = 17 };

struct camber_painter {
    camber_tile_cache *cache;
    uint32_t side;
    pthread_mutex_t mutex; /* of the chart that comes next */
    camber_chart next;
    bool has_next;
    /* The painter's thread alone: */
    camber_chart chart;
    bool has_chart;
    camber_tiles_engine *engines[CAMBER_CHART_THEMES][CAMBER_CHART_MOST_RATIO];
    camber_scene *scenes[CAMBER_CHART_THEMES];
    camber_mesh *mesh; /* of scenes */
    int prepared_zoom;
};

/* ---- Charts ---- */

static void close_chart(camber_painter *painter) {
    for (int theme = 0; theme < CAMBER_CHART_THEMES; theme++) {
        for (int ratio = 0; ratio < CAMBER_CHART_MOST_RATIO; ratio++) {
            camber_tiles_engine_destroy(painter->engines[theme][ratio]);
            painter->engines[theme][ratio] = NULL;
        }
        camber_scene_destroy(painter->scenes[theme]);
        painter->scenes[theme] = NULL;
    }
    camber_mesh_destroy(painter->mesh);
    painter->mesh = NULL;
    if (painter->has_chart && painter->chart.close)
        painter->chart.close(painter->chart.owner);
    painter->has_chart = false;
}

static void take_next(camber_painter *painter) {
    pthread_mutex_lock(&painter->mutex);
    const bool has_next = painter->has_next;
    const camber_chart next = painter->next;
    painter->has_next = false;
    pthread_mutex_unlock(&painter->mutex);
    if (!has_next)
        return;
    close_chart(painter);
    painter->chart = next;
    painter->has_chart = true;
    painter->prepared_zoom = FIRST_PREPARED_ZOOM;
}

camber_painter *camber_painter_create(camber_tile_cache *cache, uint32_t side) {
    camber_painter *made = calloc(1, sizeof *made);
    if (!made)
        return NULL;
    made->cache = cache;
    made->side = side;
    pthread_mutex_init(&made->mutex, NULL);
    return made;
}

void camber_painter_destroy(camber_painter *painter) {
    if (!painter)
        return;
    take_next(painter);
    close_chart(painter);
    pthread_mutex_destroy(&painter->mutex);
    free(painter);
}

void camber_painter_put(camber_painter *painter, const camber_chart *chart) {
    pthread_mutex_lock(&painter->mutex);
    const bool unseen = painter->has_next;
    const camber_chart before = painter->next;
    painter->next = *chart;
    painter->has_next = true;
    pthread_mutex_unlock(&painter->mutex);
    /* A picture that begins from here on is the new chart's; one that has begun is of the generation before. */
    camber_tile_cache_clear(painter->cache, chart->input);
    if (unseen && before.close)
        before.close(before.owner);
}

/* Features have one style at a time; a chart without themes keeps its own. */
static camber_status take_theme(camber_painter *painter, bool dark) {
    const camber_chart *chart = &painter->chart;
    if (!chart->styles[1])
        return dark ? CAMBER_ERROR_ARGUMENT : CAMBER_OK;
    return camber_features_restyle(chart->features, chart->styles[dark]);
}

/* ---- Tiles ---- */

static camber_status find_engine(camber_painter *painter, bool dark, uint32_t ratio, camber_tiles_engine **engine) {
    const camber_chart *chart = &painter->chart;
    camber_tiles_engine **slot = &painter->engines[dark][ratio - 1];
    const camber_tiles_engine_desc desc = {.renderer = chart->renderer,
                                           .device = chart->device,
                                           .tile_size = 256,
                                           .ratio = ratio,
                                           .simplify_px = chart->simplify_px,
                                           .coverage = chart->coverage,
                                           .threads = chart->threads,
                                           .on_demand_side = painter->side};
    camber_status status = take_theme(painter, dark);
    if (status == CAMBER_OK && !*slot)
        status = camber_tiles_engine_create(chart->features, &desc, slot);
    *engine = *slot;
    return status;
}

static void fill(camber_drawn *drawn, const uint8_t color[4]) {
    const size_t pixels = (size_t)drawn->width * drawn->height;
    for (size_t i = 0; i < pixels; i++)
        memcpy(drawn->rgba + 4 * i, color, 4);
}

static camber_status draw_tiles(camber_painter *painter, const camber_route_request *request, camber_drawn *drawn) {
    camber_tiles_engine *engine = NULL;
    camber_tiles_picture picture = {0};
    camber_status status = find_engine(painter, request->dark, request->ratio, &engine);
    if (status == CAMBER_OK)
        status = camber_tiles_engine_look(engine, request->zoom, request->column, request->row, &picture);
    if (status != CAMBER_OK)
        return status;
    drawn->side = picture.side;
    drawn->tile_px = picture.tile_px;
    drawn->width = drawn->height = picture.side * picture.tile_px;
    drawn->opaque = painter->chart.opaque;
    if (!camber_drawn_resize(drawn))
        return CAMBER_ERROR_MEMORY;
    if (picture.tiles == 0 && picture.has_background) {
        fill(drawn, picture.background);
        return CAMBER_OK;
    }
    return camber_tiles_engine_draw(engine, request->zoom, request->column, request->row, drawn->rgba, &picture);
}

/* ---- Pictures of a view ---- */

/* A scene is made once a theme, and then moved; one that could not be moved is made again. */
static camber_status move_scene(camber_painter *painter, const camber_route_request *request, camber_scene **scene) {
    const camber_chart *chart = &painter->chart;
    camber_scene **slot = &painter->scenes[request->dark];
    const camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_CENTER,
                                             .longitude = request->longitude,
                                             .latitude = request->latitude,
                                             .zoom = request->map_zoom,
                                             .bearing_deg = request->bearing_deg,
                                             .pitch_deg = request->pitch_deg,
                                             .width = request->width,
                                             .height = request->height,
                                             .ratio = request->ratio},
                                    .simplify_px = chart->simplify_px};
    camber_status status = take_theme(painter, request->dark);
    if (status == CAMBER_OK && !painter->mesh)
        status = camber_mesh_create(chart->device, chart->renderer, &painter->mesh);
    if (status == CAMBER_OK)
        status = *slot ? camber_scene_move(*slot, &desc.view) : camber_scene_create(chart->features, &desc, slot);
    *scene = *slot;
    return status;
}

static camber_status draw_view(camber_painter *painter, const camber_route_request *request, camber_drawn *drawn) {
    camber_scene *scene = NULL;
    camber_status status = move_scene(painter, request, &scene);
    if (status == CAMBER_OK)
        status = camber_scene_tessellate(scene, painter->mesh, CAMBER_METHOD_STRIP);
    if (status != CAMBER_OK)
        return status;
    camber_frame frame = camber_scene_get_frame(scene, painter->mesh);
    frame.coverage = painter->chart.coverage;
    drawn->width = frame.width;
    drawn->height = frame.height;
    drawn->opaque = camber_scene_get_info(scene).opaque;
    if (!camber_drawn_resize(drawn))
        return CAMBER_ERROR_MEMORY;
    return camber_renderer_render_into(painter->chart.renderer, &frame, drawn->rgba, 0, NULL);
}

/* ---- For the queue ---- */

camber_status camber_painter_draw(void *user, const camber_route_request *request, camber_drawn *drawn) {
    camber_painter *painter = user;
    take_next(painter);
    if (!painter->has_chart)
        return CAMBER_ERROR_NOT_FOUND;
    const camber_status status = request->route == CAMBER_ROUTE_STATIC ? draw_view(painter, request, drawn)
                                                                       : draw_tiles(painter, request, drawn);
    if (painter->chart.drawn)
        painter->chart.drawn(painter->chart.owner, status);
    return status;
}

bool camber_painter_prepare(void *user) {
    camber_painter *painter = user;
    camber_tiles_engine *engine = NULL;
    camber_tiles_picture picture;
    take_next(painter);
    if (!painter->has_chart || painter->prepared_zoom > LAST_PREPARED_ZOOM)
        return false;
    if (find_engine(painter, false, 1, &engine) != CAMBER_OK ||
        camber_tiles_engine_look(engine, painter->prepared_zoom, 0, 0, &picture) != CAMBER_OK)
        return false;
    return ++painter->prepared_zoom <= LAST_PREPARED_ZOOM;
}
