/* Draws frames in OpenCL: the list becomes a scene, which the rasterizer draws one area (a rectangle of the picture)
 * after another. The caller gets the pixels of the areas as rows. */
#include "draw/draw_cl.h"
#include "draw/renderer.h"

#include <string.h>

/* Largest sizes of an area: its memory depends on its number of tiles and of pixels. */
enum { AREA_PX = 16 * 1024 * 1024, AREA_SIDE_PX = CAMBER_TILE_PX * CAMBER_TILES_MAX };

/* Returns the area in the top left corner of the picture, as large as it can be: whole rows if they fit. */
static camber_raster_area first_area(const camber_renderer *renderer, const camber_frame *frame) {
    const camber_device *device = renderer->share.device;
    uint32_t side = AREA_SIDE_PX;
    if (frame->largest_area_px && frame->largest_area_px < side)
        side = frame->largest_area_px < CAMBER_TILE_PX ? CAMBER_TILE_PX
                                                       : frame->largest_area_px / CAMBER_TILE_PX * CAMBER_TILE_PX;
    if (camber_raster_widest(renderer->raster) < side)
        side = camber_raster_widest(renderer->raster);
    const uint32_t width = frame->width < side ? frame->width : side;
    const uint64_t most = device->info.largest_buffer_bytes / 4, pixels = most < AREA_PX ? most : AREA_PX;
    const uint32_t fitting = (uint32_t)(pixels / (width + CAMBER_TILE_PX)) / CAMBER_TILE_PX * CAMBER_TILE_PX;
    const uint32_t bound = fitting < side ? fitting : side, rows = bound > 0 ? bound : CAMBER_TILE_PX;
    return (camber_raster_area){.width = width, .height = frame->height < rows ? frame->height : rows};
}

/* Where the areas of a frame are written. */
typedef struct destination {
    camber_rows_fn *rows;
    void *user;
    camber_area_fn *draw; /* called for each area instead of drawing it. NULL: the rasterizer draws */
    /* the picture, if kernels write into it in place. NULL: they write into a buffer of the rasterizer */
    uint8_t *place;
    uint8_t *rgba; /* rows of the picture, assembled from several areas. NULL: the caller gets an area's own rows */
    uint32_t width;
    double user_ms; /* time that the caller's callback took, which does not count as reading back */
} destination;

/* Copies the area into rows of the picture, or passes its rows to the caller. */
static camber_status take_area(camber_renderer *renderer, const camber_raster_area *area, destination *to) {
    camber_raster_pixels pixels;
    const size_t width_bytes = 4 * (size_t)area->width, row_bytes = 4 * (size_t)to->width;
    const bool direct = !to->rgba;
    camber_status status = camber_raster_map(renderer->raster, &pixels);
    if (status != CAMBER_OK)
        return status;
    const double begin = camber_now_ms();
    if (direct && !to->rows(to->user, pixels.rgba, area->y, area->height))
        status = CAMBER_ERROR_IO;
    to->user_ms += camber_now_ms() - begin;
    for (size_t y = 0; !direct && y < area->height; y++)
        memcpy(to->rgba + y * row_bytes + 4 * (size_t)area->x, pixels.rgba + y * pixels.row_bytes, width_bytes);
    camber_raster_unmap(renderer->raster, pixels);
    return status;
}

/* Draws an area that is as wide as the picture in place. */
static camber_status draw_in_place(camber_renderer *renderer, const camber_raster_scene *scene,
                                   const camber_raster_area *area, const destination *to) {
    const camber_device *device = renderer->share.device;
    camber_raster_pixels pixels;
    camber_buffer *buffer = NULL;
    camber_status status = camber_buffer_create(device, CAMBER_BUFFER_BORROWED_TO_WRITE, camber_raster_bytes(area),
                                                to->place + 4 * (size_t)to->width * area->y, &buffer);
    if (status == CAMBER_OK)
        status = camber_raster_draw_into(renderer->raster, scene, area, buffer);
    if (status == CAMBER_OK)
        status = camber_raster_map(renderer->raster, &pixels); /* after this the host sees what kernels wrote */
    if (status == CAMBER_OK)
        camber_raster_unmap(renderer->raster, pixels);
    camber_device_settle(device); /* afterwards only the caller uses the memory */
    camber_buffer_release(device, &buffer);
    return status;
}

static void add_times(const camber_renderer *renderer, camber_frame_stats *stats) {
    const camber_raster_times times = camber_raster_get_times(renderer->raster);
    camber_stage_times_add(&stats->times, CAMBER_STAGE_SETUP, times.setup_ms);
    camber_stage_times_add(&stats->times, CAMBER_STAGE_BIN_COUNT, times.bin_count_ms);
    camber_stage_times_add(&stats->times, CAMBER_STAGE_BIN_SCAN, times.bin_scan_ms);
    camber_stage_times_add(&stats->times, CAMBER_STAGE_BIN_SCATTER, times.bin_scatter_ms);
    if (times.wind_ms > 0.0)
        camber_stage_times_add(&stats->times, CAMBER_STAGE_WIND, times.wind_ms);
    camber_stage_times_add(&stats->times, CAMBER_STAGE_RASTERIZE, times.rasterize_ms);
}

/* Draws areas from left to right, starting with area. */
static camber_status draw_across(camber_renderer *renderer, const camber_raster_scene *scene, camber_raster_area area,
                                 destination *to, camber_frame_stats *stats) {
    const uint32_t widest = area.width;
    camber_status status = CAMBER_OK;
    for (area.x = 0; area.x < to->width && status == CAMBER_OK; area.x += widest) {
        const double begin = camber_now_ms();
        to->user_ms = 0;
        area.width = to->width - area.x < widest ? to->width - area.x : widest;
        status = to->draw    ? to->draw(renderer, scene, &area, to->user)
                 : to->place ? draw_in_place(renderer, scene, &area, to)
                             : camber_raster_draw(renderer->raster, scene, &area);
        const double drawn = camber_now_ms();
        stats->draw_ms += drawn - begin;
        stats->areas++;
        add_times(renderer, stats);
        if (status == CAMBER_OK && to->rows)
            status = take_area(renderer, &area, to);
        stats->read_ms += camber_now_ms() - drawn - to->user_ms;
    }
    if (status == CAMBER_OK && to->rgba && to->rows && !to->rows(to->user, to->rgba, area.y, area.height))
        status = CAMBER_ERROR_IO;
    return status;
}

static camber_status draw_areas(camber_renderer *renderer, const camber_frame *frame, const camber_raster_scene *scene,
                                destination *to, camber_frame_stats *stats) {
    camber_context *context = renderer->share.device->context;
    camber_raster_area area = first_area(renderer, frame);
    const uint32_t tallest = area.height;
    camber_status status = CAMBER_OK;
    to->width = frame->width;
    if (to->rows && (area.width < frame->width || frame->width % CAMBER_TILE_PX)) {
        to->rgba = camber_alloc(context, (size_t)frame->width * tallest, 4);
        status = to->rgba ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    }
    for (; area.y < frame->height && status == CAMBER_OK; area.y += tallest) {
        area.height = frame->height - area.y < tallest ? frame->height - area.y : tallest;
        status = draw_across(renderer, scene, area, to, stats);
        if (tallest < frame->height)
            camber_progress(context, "drawing", (double)(area.y + area.height) / frame->height);
    }
    camber_free(context, to->rgba);
    return status;
}

static camber_status render_to(camber_renderer *renderer, const camber_frame *frame, destination *to,
                               camber_frame_stats *stats) {
    camber_frame_stats made = {0};
    camber_cl_tables tables;
    camber_status status = camber_cl_tables_make(&renderer->list, frame, &tables);
    if (status == CAMBER_OK)
        status = draw_areas(renderer, frame, &tables.scene, to, &made);
    if (status == CAMBER_OK)
        *stats = made;
    camber_cl_tables_free(&tables);
    return status;
}

camber_status camber_cl_render(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows, void *user,
                               camber_frame_stats *stats) {
    destination to = {.rows = rows, .user = user};
    return render_to(renderer, frame, &to, stats);
}

/* Whether kernels can write a picture in place: it has whole tiles and no gaps, and kernels can reach its memory. */
static bool can_be_in_place(const camber_renderer *renderer, const camber_frame *frame,
                            const camber_pixel_target *place) {
    return renderer->share.device->host_memory && first_area(renderer, frame).width == frame->width &&
           frame->width % CAMBER_TILE_PX == 0 && frame->height % CAMBER_TILE_PX == 0 &&
           place->stride_bytes == place->row_bytes && (uintptr_t)place->rgba % CAMBER_PIXELS_ALIGNMENT == 0;
}

camber_status camber_cl_render_into(camber_renderer *renderer, const camber_frame *frame, camber_pixel_target *place,
                                    camber_frame_stats *stats) {
    destination to = {.place = place->rgba};
    return can_be_in_place(renderer, frame, place)
               ? render_to(renderer, frame, &to, stats)
               : camber_cl_render(renderer, frame, camber_pixel_target_rows, place, stats);
}

camber_status camber_cl_each_area(camber_renderer *renderer, const camber_frame *frame, camber_area_fn *draw,
                                  void *user) {
    destination to = {.draw = draw, .user = user};
    camber_frame_stats stats;
    return render_to(renderer, frame, &to, &stats);
}
