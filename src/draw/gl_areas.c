/* Fills polygons in a frame that GL draws. Shaders draw lines; kernels compute what is inside rings (kernels/area.h).
 *
 * Input: consecutive commands of polygons. Output: their picture, drawn in OpenCL on a transparent background and
 * composited onto the target as a layer. So GL and OpenCL draw the same polygons, up to the rounding of this layer. */
#include "draw/draw_cl.h"
#include "draw/renderer.h"

/* The longest side of a block, in px: half of the longest side that the rasterizer draws at once. */
enum { BLOCK_PX = CAMBER_TILE_PX * (CAMBER_TILES_MAX / 2) };

/* ---- Blocks of the area ---- */

/* Copies the last drawn block into the layer's texture. left and top: how many px of the block are before the area. */
static camber_status upload(camber_renderer *renderer, const camber_raster_area *block, const camber_gl_area *area) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const uint32_t left = block->x < area->x ? area->x - block->x : 0,
                   top = block->y < area->y ? area->y - block->y : 0;
    camber_raster_pixels pixels;
    const camber_status status = camber_raster_map(renderer->areas, &pixels);
    if (status != CAMBER_OK)
        return status;
    const uint8_t *first = pixels.rgba + top * pixels.row_bytes + 4 * (size_t)left;
    GLuint staging = 0;
    if (!renderer->share.surface->info.software) { /* half the time, because the GPU converts the texture's layout */
        gl->GenBuffers(1, &staging);
        gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, staging);
        gl->BufferData(GL_PIXEL_UNPACK_BUFFER, (GLsizeiptr)(pixels.row_bytes * block->height), pixels.rgba,
                       GL_STREAM_DRAW);
        first = staging ? (const uint8_t *)(uintptr_t)(first - pixels.rgba) : first;
    }
    gl->BindTexture(GL_TEXTURE_2D, renderer->gl.targets[CAMBER_TARGET_LAYER].texture);
    gl->PixelStorei(GL_UNPACK_ROW_LENGTH, (GLint)(pixels.row_bytes / 4));
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, (GLint)(block->x + left - area->x), (GLint)(block->y + top - area->y),
                      (GLsizei)(block->width - left), (GLsizei)(block->height - top), GL_RGBA, GL_UNSIGNED_BYTE, first);
    gl->PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    gl->DeleteBuffers(1, &staging);
    camber_raster_unmap(renderer->areas, pixels);
    return camber_gl_check(renderer, "areas into a layer");
}

static camber_status draw_blocks(camber_renderer *renderer, const camber_raster_scene *scene,
                                 const camber_gl_area *area) {
    const uint32_t end_x = area->x + area->width, end_y = area->y + area->height;
    camber_status status = CAMBER_OK;
    for (uint32_t y = area->y / CAMBER_TILE_PX * CAMBER_TILE_PX; y < end_y && status == CAMBER_OK; y += BLOCK_PX)
        for (uint32_t x = area->x / CAMBER_TILE_PX * CAMBER_TILE_PX; x < end_x && status == CAMBER_OK; x += BLOCK_PX) {
            const camber_raster_area block = {x, y, end_x - x < BLOCK_PX ? end_x - x : BLOCK_PX,
                                              end_y - y < BLOCK_PX ? end_y - y : BLOCK_PX};
            status = camber_raster_draw(renderer->areas, scene, &block);
            if (status == CAMBER_OK)
                status = upload(renderer, &block, area);
        }
    return status;
}

/* ---- Commands ---- */

/* Makes a separate list from the commands, whose images are in a side table that GL does not read. */
static camber_status make_list(const camber_draw_list *from, const camber_draw_command *first, size_t count,
                               camber_draw_list *list) {
    *list = *from;
    list->side_table = (camber_side_table){.context = from->context};
    list->command_count = count;
    list->group_count = 0;
    list->commands = camber_alloc(from->context, count, sizeof *list->commands);
    if (!list->commands)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        list->commands[i] = first[i];
        list->commands[i].group = 0; /* GL composites the group that they belong to */
    }
    return CAMBER_OK;
}

camber_status camber_gl_fill_layer(camber_renderer *renderer, const camber_draw_command *first,
                                   const camber_draw_command *end, const camber_gl_area *area) {
    const camber_frame nothing = {.coverage = area->coverage};
    camber_draw_list list;
    camber_cl_tables tables = {.context = renderer->list.context};
    camber_status status = renderer->areas ? CAMBER_OK : camber_raster_create(renderer->share.device, &renderer->areas);
    if (status != CAMBER_OK)
        return status;
    status = make_list(&renderer->list, first, (size_t)(end - first), &list);
    if (status == CAMBER_OK)
        status = camber_cl_tables_make(&list, &nothing, &tables);
    if (status == CAMBER_OK)
        status = draw_blocks(renderer, &tables.scene, area);
    camber_cl_tables_free(&tables);
    camber_side_table_free(&list.side_table);
    camber_free(renderer->list.context, list.commands);
    return status;
}
