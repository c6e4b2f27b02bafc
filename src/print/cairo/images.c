/* Images of a page: those of the style, and layers that the renderer draws because Cairo cannot.
 *
 * Input: premultiplied RGBA8. Output: Cairo's surfaces, whose pixels are premultiplied words of ARGB. */
#include "print/page.h"

/* ---- Images of the style ---- */

cairo_surface_t *camber_page_image(camber_page_map *map, const camber_image *image) {
    for (size_t i = 0; i < map->image_count; i++)
        if (map->images[i].key == image->rgba)
            return map->images[i].surface;
    if (!camber_grow(map->context, &map->images, &map->image_capacity, map->image_count + 1, sizeof *map->images))
        return NULL;
    cairo_surface_t *made = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, (int)image->width, (int)image->height);
    if (cairo_surface_status(made) != CAIRO_STATUS_SUCCESS) {
        cairo_surface_destroy(made);
        return NULL;
    }
    cairo_surface_flush(made);
    const size_t stride = image->stride_bytes ? image->stride_bytes : (size_t)4 * image->width;
    uint8_t *to = cairo_image_surface_get_data(made);
    const size_t to_stride = (size_t)cairo_image_surface_get_stride(made);
    for (uint32_t y = 0; y < image->height; y++)
        for (uint32_t x = 0; x < image->width; x++) {
            const uint8_t *from = image->rgba + y * stride + 4 * (size_t)x;
            const uint32_t argb = camber_page_argb(from);
            memcpy(to + y * to_stride + 4 * (size_t)x, &argb, sizeof argb);
        }
    cairo_surface_mark_dirty(made);
    map->images[map->image_count].key = image->rgba;
    map->images[map->image_count++].surface = made;
    return made;
}

/* ---- Layers as images ---- */

/* A picture of some passes, in Cairo's order of bytes. */
typedef struct layer_image {
    uint8_t *argb;
    uint32_t width;
    uint32_t x0, y0, x1, y1; /* the part that is not empty */
} layer_image;

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    layer_image *image = user;
    for (uint32_t y = first_row; y < first_row + row_count; y++)
        for (uint32_t x = 0; x < image->width; x++, rgba += 4) {
            const uint32_t argb = camber_page_argb(rgba);
            memcpy(image->argb + 4 * ((size_t)y * image->width + x), &argb, sizeof argb);
            if (!argb)
                continue;
            image->x0 = x < image->x0 ? x : image->x0;
            image->x1 = x >= image->x1 ? x + 1 : image->x1;
            image->y0 = y < image->y0 ? y : image->y0;
            image->y1 = y + 1;
        }
    return true;
}

static void paint_tile(cairo_t *cr, const layer_image *image, uint32_t x, uint32_t y) {
    const uint32_t width = image->x1 - x < CAMBER_PAGE_TILE_PX ? image->x1 - x : CAMBER_PAGE_TILE_PX;
    const uint32_t height = image->y1 - y < CAMBER_PAGE_TILE_PX ? image->y1 - y : CAMBER_PAGE_TILE_PX;
    cairo_surface_t *surface =
        cairo_image_surface_create_for_data(image->argb + 4 * ((size_t)y * image->width + x), CAIRO_FORMAT_ARGB32,
                                            (int)width, (int)height, (int)(4 * image->width));
    cairo_set_source_surface(cr, surface, x, y);
    cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST);
    cairo_paint(cr);
    cairo_set_source_rgb(cr, 0.0, 0.0, 0.0);
    cairo_surface_finish(surface); /* what Cairo has recorded becomes a copy */
    cairo_surface_destroy(surface);
}

static void paint_image(cairo_t *cr, const layer_image *image) {
    for (uint32_t y = image->y0; y < image->y1; y += CAMBER_PAGE_TILE_PX)
        for (uint32_t x = image->x0; x < image->x1; x += CAMBER_PAGE_TILE_PX)
            paint_tile(cr, image, x, y);
}

static void tell(camber_page_map *map) {
    bool *told = map->renderer ? &map->told_images : &map->told_left_out;
    if (!*told)
        camber_log(map->context, CAMBER_LOG_WARNING,
                   map->frame.pitch_deg > 0.0 ? "page: a view with a pitch is %s"
                                              : "page: lines with a blur or a pattern are %s",
                   map->renderer ? "drawn as an image" : "left out, because there is no renderer to draw them");
    *told = true;
}

camber_status camber_page_draw_image(camber_page_map *map, size_t first_pass, size_t pass_count) {
    tell(map);
    if (!map->renderer)
        return CAMBER_OK;
    const uint32_t width = map->parts.view->width, height = map->parts.view->height;
    camber_status status = CAMBER_OK;
    if (!map->is_tessellated)
        status = camber_scene_tessellate(map->scene, map->mesh, CAMBER_METHOD_STRIP);
    if (status != CAMBER_OK)
        return status;
    map->is_tessellated = true;
    camber_frame frame = camber_scene_get_frame(map->scene, map->mesh);
    if (!(frame.pitch_deg > 0.0))
        frame.background = (camber_color){0};
    frame.passes += first_pass;
    frame.pass_count = pass_count;
    layer_image image = {.width = width, .x0 = width, .y0 = height};
    image.argb = camber_alloc(map->context, (size_t)width * height, 4);
    if (!image.argb)
        return CAMBER_ERROR_MEMORY;
    status = camber_renderer_render(map->renderer, &frame, take_rows, &image, NULL);
    if (status == CAMBER_OK)
        paint_image(map->cr, &image);
    camber_free(map->context, image.argb);
    return status;
}

void camber_page_map_free(camber_page_map *map) {
    for (size_t i = 0; i < map->image_count; i++)
        cairo_surface_destroy(map->images[i].surface);
    camber_free(map->context, map->images);
    camber_free(map->context, map->glyphs);
    camber_free(map->context, map->bytes);
    camber_page_lines_free(&map->lines);
    camber_page_lines_free(&map->beside);
    camber_page_lines_free(&map->part);
    camber_page_fonts_free(&map->fonts);
}
