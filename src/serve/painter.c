/* Draws tiles and pictures of a map on one thread.
 *
 * An engine is created for each theme and ratio when it is first requested. While nobody waits, the most used zooms are
 * prepared, so that the first tile of a zoom need not wait for its census. */
#include "serve/painter.h"

#include "serve/overlay.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_PREPARED_ZOOM = 10, LAST_PREPARED_ZOOM = 17 };

struct camber_painter {
    camber_tile_cache *cache;
    uint32_t map, side;
    pthread_mutex_t mutex; /* guards next and has_next */
    camber_map_source next;
    bool has_next;
    /* Only used by the painter's thread: */
    camber_map_source source;
    bool has_source;
    const camber_style *style; /* that the source's features have now */
    camber_tiles_engine *engines[CAMBER_MAP_SOURCE_THEMES][CAMBER_MAP_SOURCE_MOST_RATIO];
    camber_scene *scenes[CAMBER_MAP_SOURCE_THEMES];
    camber_mesh *mesh; /* for scenes */
    int prepared_zoom;
};

/* ---- Map sources ---- */

static void close_source(camber_painter *painter) {
    for (int theme = 0; theme < CAMBER_MAP_SOURCE_THEMES; theme++) {
        for (int ratio = 0; ratio < CAMBER_MAP_SOURCE_MOST_RATIO; ratio++) {
            camber_tiles_engine_destroy(painter->engines[theme][ratio]);
            painter->engines[theme][ratio] = NULL;
        }
        camber_scene_destroy(painter->scenes[theme]);
        painter->scenes[theme] = NULL;
    }
    camber_mesh_destroy(painter->mesh);
    painter->mesh = NULL;
    if (painter->has_source && painter->source.close)
        painter->source.close(painter->source.owner);
    painter->has_source = false;
}

static void take_next(camber_painter *painter) {
    pthread_mutex_lock(&painter->mutex);
    const bool has_next = painter->has_next;
    const camber_map_source next = painter->next;
    painter->has_next = false;
    pthread_mutex_unlock(&painter->mutex);
    if (!has_next)
        return;
    close_source(painter);
    painter->source = next;
    painter->has_source = true;
    painter->style = next.styles[0];
    painter->prepared_zoom = FIRST_PREPARED_ZOOM;
}

camber_painter *camber_painter_create(camber_tile_cache *cache, uint32_t map, uint32_t side) {
    camber_painter *made = calloc(1, sizeof *made);
    if (!made)
        return NULL;
    made->cache = cache;
    made->map = map;
    made->side = side;
    pthread_mutex_init(&made->mutex, NULL);
    return made;
}

void camber_painter_destroy(camber_painter *painter) {
    if (!painter)
        return;
    take_next(painter);
    close_source(painter);
    pthread_mutex_destroy(&painter->mutex);
    free(painter);
}

void camber_painter_put(camber_painter *painter, const camber_map_source *source) {
    pthread_mutex_lock(&painter->mutex);
    const bool unseen = painter->has_next;
    const camber_map_source before = painter->next;
    painter->next = *source;
    painter->has_next = true;
    pthread_mutex_unlock(&painter->mutex);
    /* Pictures that begin from now on belong to the new map. A picture that has already begun belongs to the previous
     * generation, and is not cached. */
    camber_tile_cache_clear(painter->cache, painter->map, source->input);
    if (unseen && before.close)
        before.close(before.owner);
}

/* Features can have only one style at a time. A map without themes keeps its own. Features that already have the style
 * are left as they are, because scenes keep what they know only as long as their features do not change. */
static camber_status take_theme(camber_painter *painter, bool dark) {
    const camber_map_source *source = &painter->source;
    if (!source->styles[1])
        return dark ? CAMBER_ERROR_ARGUMENT : CAMBER_OK;
    const camber_style *style = source->styles[dark];
    const camber_status status = style == painter->style ? CAMBER_OK : camber_features_restyle(source->features, style);
    if (status == CAMBER_OK)
        painter->style = style;
    return status;
}

/* ---- Tiles ---- */

static camber_status find_engine(camber_painter *painter, bool dark, uint32_t ratio, camber_tiles_engine **engine) {
    const camber_map_source *source = &painter->source;
    camber_tiles_engine **slot = &painter->engines[dark][ratio - 1];
    const camber_tiles_engine_desc desc = {.renderer = source->renderer,
                                           .device = source->device,
                                           .tile_size = 256,
                                           .ratio = ratio,
                                           .simplify_px = source->simplify_px,
                                           .coverage = source->coverage,
                                           .threads = source->threads,
                                           .on_demand_side = painter->side};
    camber_status status = take_theme(painter, dark);
    if (status == CAMBER_OK && !*slot)
        status = camber_tiles_engine_create(source->features, &desc, slot);
    *engine = *slot;
    return status;
}

static void fill(camber_rendered_picture *rendered, const uint8_t color[4]) {
    const size_t pixels = (size_t)rendered->width * rendered->height;
    for (size_t i = 0; i < pixels; i++)
        memcpy(rendered->rgba + 4 * i, color, 4);
}

static camber_status draw_tiles(camber_painter *painter, const camber_route_request *request,
                                camber_rendered_picture *rendered) {
    camber_tiles_engine *engine = NULL;
    camber_tiles_picture picture = {0};
    camber_status status = find_engine(painter, request->dark, request->ratio, &engine);
    if (status == CAMBER_OK)
        status = camber_tiles_engine_look(engine, request->zoom, request->column, request->row, &picture);
    if (status != CAMBER_OK)
        return status;
    rendered->side = picture.side;
    rendered->tile_px = picture.tile_px;
    rendered->width = rendered->height = picture.side * picture.tile_px;
    rendered->opaque = painter->source.opaque;
    if (!camber_rendered_picture_resize(rendered))
        return CAMBER_ERROR_MEMORY;
    if (picture.tiles == 0 && picture.has_background) {
        fill(rendered, picture.background);
        return CAMBER_OK;
    }
    return camber_tiles_engine_draw(engine, request->zoom, request->column, request->row, rendered->rgba, &picture);
}

/* ---- Pictures of a view ---- */

static camber_scene_desc describe_scene(const camber_painter *painter, const camber_route_request *request) {
    return (camber_scene_desc){.view = {.kind = CAMBER_VIEW_CENTER,
                                        .longitude = request->longitude,
                                        .latitude = request->latitude,
                                        .zoom = request->map_zoom,
                                        .bearing_deg = request->bearing_deg,
                                        .pitch_deg = request->pitch_deg,
                                        .width = request->width,
                                        .height = request->height,
                                        .ratio = request->ratio},
                               .simplify_px = painter->source.simplify_px};
}

/* A scene is created once per theme, and then moved. If moving fails, it is created again. */
static camber_status move_scene(camber_painter *painter, const camber_route_request *request, camber_scene **scene) {
    const camber_map_source *source = &painter->source;
    camber_scene **slot = &painter->scenes[request->dark];
    const camber_scene_desc desc = describe_scene(painter, request);
    camber_status status = take_theme(painter, request->dark);
    if (status == CAMBER_OK && !painter->mesh)
        status = camber_mesh_create(source->device, source->renderer, &painter->mesh);
    if (status == CAMBER_OK)
        status = *slot ? camber_scene_move(*slot, &desc.view) : camber_scene_create(source->features, &desc, slot);
    *scene = *slot;
    return status;
}

/* Draws a frame, and the overlay's passes after its own. */
static camber_status draw_over(camber_painter *painter, const camber_frame *frame, const camber_frame *over,
                               camber_rendered_picture *rendered) {
    camber_frame both = *frame;
    camber_pass *passes = calloc(frame->pass_count + over->pass_count + 1, sizeof *passes);
    if (!passes)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < frame->pass_count + over->pass_count; i++)
        passes[i] = i < frame->pass_count ? frame->passes[i] : over->passes[i - frame->pass_count];
    both.passes = passes;
    both.pass_count = frame->pass_count + over->pass_count;
    const camber_status status = camber_renderer_render_into(painter->source.renderer, &both, rendered->rgba, 0, NULL);
    free(passes);
    return status;
}

/* Draws a frame with what its request draws over it. */
static camber_status draw_overlay(camber_painter *painter, const camber_route_request *request,
                                  const camber_frame *frame, camber_rendered_picture *rendered) {
    const camber_map_source *source = &painter->source;
    camber_scene_desc desc = describe_scene(painter, request);
    desc.use = CAMBER_SCENE_ONE_VIEW;
    camber_scene *scene = NULL;
    camber_mesh *mesh = NULL; /* it keeps parts of the scene's network, and ends with it */
    camber_status status = camber_scene_create(camber_overlay_get_features(request->overlay), &desc, &scene);
    if (status == CAMBER_OK)
        status = camber_mesh_create(source->device, source->renderer, &mesh);
    if (status == CAMBER_OK)
        status = camber_scene_tessellate(scene, mesh, CAMBER_METHOD_STRIP);
    if (status == CAMBER_OK) {
        const camber_frame over = camber_scene_get_frame(scene, mesh);
        status = draw_over(painter, frame, &over, rendered);
    }
    camber_mesh_destroy(mesh);
    camber_scene_destroy(scene);
    return status;
}

static camber_status draw_view(camber_painter *painter, const camber_route_request *request,
                               camber_rendered_picture *rendered) {
    camber_scene *scene = NULL;
    camber_status status = move_scene(painter, request, &scene);
    if (status == CAMBER_OK)
        status = camber_scene_tessellate(scene, painter->mesh, CAMBER_METHOD_STRIP);
    if (status != CAMBER_OK)
        return status;
    camber_frame frame = camber_scene_get_frame(scene, painter->mesh);
    frame.coverage = painter->source.coverage;
    rendered->width = frame.width;
    rendered->height = frame.height;
    rendered->opaque = camber_scene_get_info(scene).opaque;
    if (!camber_rendered_picture_resize(rendered))
        return CAMBER_ERROR_MEMORY;
    return request->overlay ? draw_overlay(painter, request, &frame, rendered)
                            : camber_renderer_render_into(painter->source.renderer, &frame, rendered->rgba, 0, NULL);
}

/* ---- Functions for the queue ---- */

camber_status camber_painter_draw(camber_painter *painter, const camber_route_request *request,
                                  camber_rendered_picture *rendered) {
    take_next(painter);
    if (!painter->has_source)
        return CAMBER_ERROR_NOT_FOUND;
    const camber_status status = request->route == CAMBER_ROUTE_STATIC ? draw_view(painter, request, rendered)
                                                                       : draw_tiles(painter, request, rendered);
    if (painter->source.drawn)
        painter->source.drawn(painter->source.owner, status);
    return status;
}

bool camber_painter_prepare(camber_painter *painter) {
    camber_tiles_engine *engine = NULL;
    camber_tiles_picture picture;
    take_next(painter);
    if (!painter->has_source || painter->prepared_zoom > LAST_PREPARED_ZOOM)
        return false;
    if (find_engine(painter, false, 1, &engine) != CAMBER_OK ||
        camber_tiles_engine_look(engine, painter->prepared_zoom, 0, 0, &picture) != CAMBER_OK)
        return false;
    return ++painter->prepared_zoom <= LAST_PREPARED_ZOOM;
}
