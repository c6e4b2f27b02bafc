/* The engine draws pictures of metatiles, each with a network and a camera of its own.
 *
 * Input: features, a renderer, and a tile's zoom, column and row. Output: the pixels of its metatile. Main idea: a
 * census lists the lines that reach into a metatile. The engine makes a scene of these lines, tessellates it and draws
 * it as one picture, from which tiles are cut. */
#include "tiles/engine.h"
#include "map/scene.h"

#include "tiles/mesh_area.h"

#include <math.h>

enum {
    LEAST_TILE_PX = 64,
    /* At higher zooms the census would grow without limit, because lines pass through more and more tiles. Tiles on
     * demand use a census in tiles of this zoom instead; each of these contains few lines. */
    FINEST_CENSUS_ZOOM = 16,
};
/* A mesh whose network has more points than this is freed at once, instead of being kept until the next one is made. */
static const size_t MANY_POINTS = (size_t)1 << 20;

/* ---- The engine ---- */

/* Returns the desc with its defaults filled in. */
static camber_tiles_engine_desc whole_desc(const camber_tiles_engine_desc *desc) {
    camber_tiles_engine_desc whole = *desc;
    whole.tile_size = desc->tile_size ? desc->tile_size : 256;
    whole.ratio = desc->ratio != 0.0 ? desc->ratio : 1.0;
    return whole;
}

double camber_engine_tile_px(const camber_tiles_engine_desc *desc) {
    const camber_tiles_engine_desc whole = whole_desc(desc);
    return floor(whole.tile_size * whole.ratio + 0.5);
}

camber_zoom_desc camber_engine_zoom_desc(const camber_tiles_engine_desc *desc, int zoom) {
    const camber_tiles_engine_desc whole = whole_desc(desc);
    return (camber_zoom_desc){.zoom = zoom - (whole.tile_size == 256 ? 1.0 : 0.0),
                              .scale_px = camber_engine_tile_px(desc) * exp2(zoom),
                              .ratio = whole.ratio,
                              .simplify_px = whole.simplify_px};
}

static camber_status check_desc(camber_tiles_engine *engine, const camber_tiles_engine_desc *desc) {
    camber_tiles_engine_desc *own = &engine->desc;
    *own = whole_desc(desc);
    if (own->tile_size != 256 && own->tile_size != 512)
        return camber_fail(engine->context, CAMBER_ERROR_ARGUMENT, "tiles: a tile size of %u; choose 256 or 512",
                           own->tile_size);
    const double tile_px = camber_engine_tile_px(own);
    if (!(tile_px >= LEAST_TILE_PX && tile_px <= CAMBER_PICTURE_PX))
        return camber_fail(engine->context, CAMBER_ERROR_ARGUMENT,
                           "tiles: a ratio of %g makes %g px of a tile of %u; choose a ratio that makes %d to %d",
                           own->ratio, tile_px, own->tile_size, LEAST_TILE_PX, CAMBER_PICTURE_PX);
    if (!(own->simplify_px >= 0.0 && isfinite(own->simplify_px)))
        return camber_fail(engine->context, CAMBER_ERROR_ARGUMENT,
                           "tiles: a simplification of %g px; choose 0 or a distance in pixels", own->simplify_px);
    if (own->meshes && !camber_mesh_is_built())
        return camber_fail(engine->context, CAMBER_ERROR_ARGUMENT,
                           "tiles: this build writes no mesh tiles (CAMBER_MESHOPT); build it with meshoptimizer");
    if (own->on_demand_side > CAMBER_METATILE_SIDE_MOST || own->on_demand_side & (own->on_demand_side - 1))
        return camber_fail(engine->context, CAMBER_ERROR_ARGUMENT,
                           "tiles: a metatile of %u tiles on a side; choose 1, 2, 4 or 8", own->on_demand_side);
    engine->tile_px = (uint32_t)tile_px;
    return CAMBER_OK;
}

camber_status camber_tiles_engine_create(const camber_features *features, const camber_tiles_engine_desc *desc,
                                         camber_tiles_engine **engine) {
    camber_tiles_engine *made = camber_alloc_zero(features->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = features->context;
    made->features = features;
    camber_status status = check_desc(made, desc);
    if (status == CAMBER_OK)
        status = camber_workers_make(made->context, desc->threads, &made->workers);
    if (status == CAMBER_OK)
        status = camber_mesh_create(desc->device, desc->renderer, &made->mesh);
    if (status == CAMBER_OK)
        *engine = made;
    else
        camber_tiles_engine_destroy(made);
    return status;
}

void camber_engine_forget_zoom(camber_tiles_engine *engine, int zoom) {
    if (zoom < 0 || zoom > CAMBER_LARGEST_TILE_ZOOM)
        return;
    camber_census_free(&engine->zooms[zoom].census);
    camber_zoom_labels_destroy(engine->zooms[zoom].labels);
    engine->zooms[zoom].labels = NULL;
    if (engine->zooms[zoom].mesh)
        camber_mesh_plan_destroy(engine->zooms[zoom].mesh);
    else
        camber_zoom_plan_destroy(engine->zooms[zoom].plan);
    engine->zooms[zoom].plan = NULL;
    engine->zooms[zoom].mesh = NULL;
}

void camber_tiles_engine_destroy(camber_tiles_engine *engine) {
    if (!engine)
        return;
    camber_mesh_destroy(engine->mesh);
    for (int zoom = 0; zoom <= CAMBER_LARGEST_TILE_ZOOM; zoom++)
        camber_engine_forget_zoom(engine, zoom);
    camber_label_things_free(&engine->things);
    camber_workers_free(&engine->workers);
    camber_free(engine->context, engine);
}

size_t camber_tiles_engine_get_picture_bytes(const camber_tiles_engine *engine) {
    const size_t side = (size_t)camber_engine_side(engine, CAMBER_LARGEST_TILE_ZOOM) * engine->tile_px;
    return engine->desc.meshes ? 1 : 4 * side * side;
}

/* ---- Zooms ---- */

/* Returns the zoom in whose tiles the census of a zoom is taken. */
static int census_zoom(const camber_tiles_engine *engine, int zoom) {
    return engine->desc.on_demand_side && zoom > FINEST_CENSUS_ZOOM ? FINEST_CENSUS_ZOOM : zoom;
}

/* Returns a metatile that has all lines of a picture, and possibly other lines near it. NULL: no line touches the
 * picture. */
static const camber_metatile *find_metatile(const camber_tiles_engine *engine, int zoom, uint32_t column,
                                            uint32_t row) {
    const int counted = census_zoom(engine, zoom);
    const uint32_t side = camber_engine_side(engine, counted);
    return camber_census_find(&engine->zooms[zoom].census, (column >> (zoom - counted)) / side,
                              (row >> (zoom - counted)) / side);
}

static bool take_first_pixel(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    (void)row_count;
    if (first_row == 0)
        memcpy(user, rgba, 4);
    return true;
}

/* Draws only the background, to learn the colour of its pixels. */
static camber_status find_background(camber_tiles_engine *engine, camber_engine_zoom *zoom) {
    const camber_plan_patterns *patterns = &zoom->plan->plan.patterns;
    zoom->has_background = !zoom->plan->has_images;
    camber_pass *passes = camber_alloc_zero(engine->context, patterns->fill_count, sizeof *passes);
    if (!passes)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < patterns->fill_count; i++)
        passes[i] = (camber_pass){.kind = CAMBER_PASS_FILL, .fill = patterns->fills[i].fill};
    const camber_frame frame = {.width = 32,
                                .height = 32,
                                .background = zoom->plan->plan.background,
                                .passes = passes,
                                .pass_count = patterns->fill_count};
    camber_status status = CAMBER_OK;
    if (zoom->has_background)
        status = camber_renderer_render(engine->desc.renderer, &frame, take_first_pixel, zoom->background, NULL);
    camber_free(engine->context, passes);
    return status;
}

camber_status camber_engine_plan_zoom(camber_tiles_engine *engine, int zoom, camber_engine_zoom **planned) {
    camber_engine_zoom *it = engine->zooms + zoom;
    camber_status status = CAMBER_OK;
    const double start_ms = camber_now_ms();
    if (!it->plan) {
        const camber_zoom_desc desc = camber_engine_zoom_desc(&engine->desc, zoom);
        if (engine->desc.meshes)
            status = camber_mesh_plan_create(engine->features, &desc, &it->mesh);
        else
            status = camber_zoom_plan_create(engine->features, &desc, &it->plan);
        if (it->mesh) {
            it->plan = it->mesh->zoom;
            it->has_background = true; /* then tiles without lines and areas are left out */
            status = camber_mesh_plan_find_glu(it->mesh);
        } else if (status == CAMBER_OK) {
            status = find_background(engine, it);
        }
        if (status != CAMBER_OK)
            camber_engine_forget_zoom(engine, zoom);
    }
    engine->census_ms += camber_now_ms() - start_ms;
    *planned = it;
    return status;
}

camber_status camber_engine_open_zoom(camber_tiles_engine *engine, int zoom, camber_engine_zoom **opened) {
    camber_status status = camber_engine_plan_zoom(engine, zoom, opened);
    const double start_ms = camber_now_ms();
    if (status == CAMBER_OK && !(*opened)->census.context)
        status = camber_census_make((*opened)->plan, census_zoom(engine, zoom),
                                    camber_engine_side(engine, census_zoom(engine, zoom)), &engine->workers,
                                    &(*opened)->census);
    if (status != CAMBER_OK)
        camber_engine_forget_zoom(engine, zoom);
    engine->census_ms += camber_now_ms() - start_ms;
    return status;
}

/* ---- Pictures ---- */

camber_tiles_picture camber_engine_describe(const camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row,
                                            const camber_metatile *metatile) {
    const camber_engine_zoom *it = engine->zooms + zoom;
    const uint32_t side = camber_engine_side(engine, zoom);
    camber_tiles_picture picture = {.zoom = zoom,
                                    .column = column * side,
                                    .row = row * side,
                                    .side = side,
                                    .tile_px = engine->tile_px,
                                    .tiles = !metatile                          ? 0
                                             : census_zoom(engine, zoom) < zoom ? UINT64_MAX >> (64 - side * side)
                                                                                : metatile->tiles,
                                    .has_background = it->has_background};
    memcpy(picture.background, it->background, sizeof picture.background);
    return picture;
}

/* Frees the memory that the mesh holds for a large network. */
static camber_status renew_mesh(camber_tiles_engine *engine) {
    camber_mesh_destroy(engine->mesh);
    engine->mesh = NULL;
    return camber_mesh_create(engine->desc.device, engine->desc.renderer, &engine->mesh);
}

static camber_view window_of(const camber_zoom_plan *plan, const camber_tiles_picture *picture) {
    const double across = exp2(picture->zoom), half = 0.5 * picture->side;
    camber_view window = plan->view;
    window.x = (picture->column + half) / across;
    window.y = (picture->row + half) / across;
    window.width = window.height = picture->side * picture->tile_px;
    return window;
}

/* Creates the scene of a metatile and tessellates it. */
static camber_status tessellate(camber_tiles_engine *engine, const camber_metatile *metatile,
                                const camber_tiles_picture *picture, camber_scene **scene) {
    static const uint32_t none[1] = {0};
    const camber_engine_zoom *zoom = engine->zooms + picture->zoom;
    const camber_view window = window_of(zoom->plan, picture);
    const double start_ms = camber_now_ms();
    camber_window_labels labels = {
        .square =
            camber_engine_square(engine, picture->zoom, picture->column / picture->side, picture->row / picture->side)};
    camber_status status = camber_engine_get_labels(engine, picture->zoom, &labels.labels);
    if (status == CAMBER_OK)
        status = camber_scene_create_window(zoom->plan, &window, &labels,
                                            metatile ? zoom->census.polylines + metatile->first : none,
                                            metatile ? metatile->end - metatile->first : 0, scene);
    engine->make_ms += camber_now_ms() - start_ms;
    return status == CAMBER_OK ? camber_scene_tessellate(*scene, engine->mesh, CAMBER_METHOD_STRIP) : status;
}

/* Destroys the scene, and frees the mesh's memory if the scene was large. */
static camber_status end_scene(camber_tiles_engine *engine, camber_scene *scene, camber_status status) {
    camber_camera camera;
    camber_tessellation_desc desc;
    const bool large =
        scene && camber_network_get_stats(camber_scene_get_network(scene, &camera, &desc)).kept_points > MANY_POINTS;
    camber_scene_destroy(scene);
    return status == CAMBER_OK && large ? renew_mesh(engine) : status;
}

camber_status camber_engine_tessellate_metatile(camber_tiles_engine *engine, const camber_metatile *metatile,
                                                camber_tiles_picture *picture, camber_mesh_picture *lines) {
    camber_scene *scene = NULL;
    const camber_engine_zoom *zoom = engine->zooms + picture->zoom;
    const double start_ms = camber_now_ms(), made_ms = engine->make_ms;
    camber_status status = tessellate(engine, metatile, picture, &scene);
    if (status == CAMBER_OK)
        status = camber_mesh_picture_take(zoom->mesh, engine->mesh, lines);
    if (status == CAMBER_OK && metatile) {
        const camber_view window = window_of(zoom->plan, picture);
        status = camber_mesh_picture_take_rings(lines, zoom->census.polylines + metatile->first,
                                                metatile->end - metatile->first, &window);
    }
    status = end_scene(engine, scene, status);
    engine->draw_ms += camber_now_ms() - start_ms - (engine->make_ms - made_ms);
    return status;
}

camber_status camber_engine_draw_metatile(camber_tiles_engine *engine, const camber_metatile *metatile, uint8_t *rgba,
                                          camber_tiles_picture *picture) {
    const double start_ms = camber_now_ms(), made_ms = engine->make_ms;
    camber_scene *scene = NULL;
    camber_status status = tessellate(engine, metatile, picture, &scene);
    if (status == CAMBER_OK) {
        camber_frame frame = camber_scene_get_frame(scene, engine->mesh);
        frame.coverage = engine->desc.coverage;
        status = camber_renderer_render_into(engine->desc.renderer, &frame, rgba, 0, NULL);
    }
    status = end_scene(engine, scene, status);
    engine->draw_ms += camber_now_ms() - start_ms - (engine->make_ms - made_ms);
    picture->rgba = status == CAMBER_OK ? rgba : NULL;
    return status;
}

static camber_status find(camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row,
                          const camber_metatile **metatile, camber_tiles_picture *picture) {
    camber_engine_zoom *opened;
    if (zoom < 0 || zoom > CAMBER_LARGEST_TILE_ZOOM || column >> zoom || row >> zoom)
        return camber_fail(engine->context, CAMBER_ERROR_ARGUMENT,
                           "tiles: there is no tile %d/%u/%u; zooms are 0 to %d, with 2^zoom columns and rows", zoom,
                           column, row, CAMBER_LARGEST_TILE_ZOOM);
    const camber_status status = camber_engine_open_zoom(engine, zoom, &opened);
    if (status != CAMBER_OK)
        return status;
    const uint32_t side = camber_engine_side(engine, zoom);
    *metatile = find_metatile(engine, zoom, column, row);
    uint64_t labelled = 0;
    const camber_status found = camber_engine_find_label_tiles(engine, zoom, column / side, row / side, &labelled);
    if (found != CAMBER_OK)
        return found;
    *picture = camber_engine_describe(engine, zoom, column / side, row / side, *metatile);
    picture->tiles |= labelled;
    return CAMBER_OK;
}

camber_status camber_tiles_engine_look(camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row,
                                       camber_tiles_picture *picture) {
    const camber_metatile *metatile = NULL;
    return find(engine, zoom, column, row, &metatile, picture);
}

camber_status camber_tiles_engine_draw(camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row,
                                       uint8_t *rgba, camber_tiles_picture *picture) {
    const camber_metatile *metatile = NULL;
    camber_tiles_picture made = {.side = 1};
    if (engine->desc.meshes)
        return camber_fail(engine->context, CAMBER_ERROR_ARGUMENT,
                           "tiles: the engine's tiles are meshes; make one of pictures, or draw an archive");
    camber_status status = find(engine, zoom, column, row, &metatile, &made);
    if (status == CAMBER_OK)
        status = camber_engine_draw_metatile(engine, metatile, rgba, &made);
    if (status == CAMBER_OK)
        *picture = made;
    return status;
}

void camber_tiles_picture_get_tile(const camber_tiles_picture *picture, uint32_t x, uint32_t y, camber_pixels *pixels) {
    const size_t stride = 4 * (size_t)picture->side * picture->tile_px;
    *pixels = (camber_pixels){.rgba = picture->rgba + stride * picture->tile_px * y + 4 * (size_t)picture->tile_px * x,
                              .width = picture->tile_px,
                              .height = picture->tile_px,
                              .stride_bytes = stride};
}
