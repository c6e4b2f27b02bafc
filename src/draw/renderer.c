/* Creates and destroys renderers, and makes the buffers of the meshes that they draw. */
#include "draw/renderer.h"
#include "vertices/vertices.h"

#include "raster/raster.h"

#include <assert.h>

static void close_gl(camber_renderer *renderer) {
    const bool is_current = camber_surface_try_current(renderer->share.surface);
    if (!is_current)
        renderer->pixels.gl_name = 0; /* it is freed with its context */
    if (renderer->path)
        renderer->path->ops.release(&renderer->share, &renderer->pixels);
    camber_gl_release(renderer, is_current);
}

static camber_status open_gl(camber_renderer *made, camber_sharing sharing) {
    camber_surface *surface = made->share.surface;
    camber_status status = camber_surface_make_current(surface);
    if (status == CAMBER_OK)
        status = camber_share_choose(&made->share, sharing, &made->path);
    if (status != CAMBER_OK)
        return status;
    made->gl.shaders.surface = surface;
    surface->gl.GenVertexArrays(1, &made->gl.vertex_array);
    surface->gl.GenTextures(1, &made->gl.record_texture);
    status = camber_surface_check(surface, "opening");
    if (status != CAMBER_OK)
        close_gl(made);
    return status;
}

camber_status camber_renderer_create(camber_device *device, camber_surface *surface, const camber_renderer_desc *desc,
                                     camber_renderer **renderer) {
    const camber_renderer_desc full = desc ? *desc : (camber_renderer_desc){0};
    const bool in_hardware = surface && !surface->info.software;
    const bool in_cl =
        full.rasterizer == CAMBER_RASTERIZER_OPENCL || (full.rasterizer == CAMBER_RASTERIZER_AUTO && !in_hardware);
    assert(surface || in_cl);
    camber_status status = camber_check_process(device->context);
    camber_renderer *made = status == CAMBER_OK ? camber_alloc_zero(device->context, 1, sizeof *made) : NULL;
    if (!made)
        return status == CAMBER_OK ? CAMBER_ERROR_MEMORY : status;
    made->share = (camber_share){.device = device, .surface = surface};
    made->list.context = made->list.side_table.context = made->list.images.context = device->context;
    status = in_cl ? camber_raster_create(device, &made->raster) : CAMBER_OK;
    if (status == CAMBER_OK && surface)
        status = open_gl(made, full.sharing);
    if (status != CAMBER_OK) {
        camber_raster_destroy(made->raster);
        camber_free(device->context, made);
        return status;
    }
    *renderer = made;
    return CAMBER_OK;
}

void camber_renderer_destroy(camber_renderer *renderer) {
    if (!renderer)
        return;
    camber_context *context = renderer->share.device->context;
    if (renderer->share.surface)
        close_gl(renderer);
    camber_raster_destroy(renderer->raster);
    camber_raster_destroy(renderer->areas);
    camber_draw_list_free(&renderer->list);
    camber_free(context, renderer);
}

void camber_renderer_trim(camber_renderer *renderer) {
    if (renderer->raster)
        camber_raster_trim(renderer->raster);
    if (renderer->areas)
        camber_raster_trim(renderer->areas);
}

camber_sharing camber_renderer_get_sharing(const camber_renderer *renderer) {
    return renderer->path ? renderer->path->sharing : CAMBER_SHARING_AUTO;
}

camber_rasterizer camber_renderer_get_rasterizer(const camber_renderer *renderer) {
    return renderer->raster ? CAMBER_RASTERIZER_OPENCL : CAMBER_RASTERIZER_GL;
}

const char *camber_rasterizer_get_name(camber_rasterizer draw) {
    switch (draw) {
    case CAMBER_RASTERIZER_AUTO: return "auto";
    case CAMBER_RASTERIZER_GL: return "gl";
    case CAMBER_RASTERIZER_OPENCL: return "cl";
    }
    return "unknown";
}

/* ---- Meshes that a renderer draws: the GL context is current before GL buffers are touched ---- */

static camber_status current_reserve(void *user, camber_shared_buffer *buffer, size_t size_bytes) {
    camber_renderer *renderer = user;
    const camber_status status = camber_surface_make_current(renderer->share.surface);
    return status == CAMBER_OK ? renderer->path->ops.reserve(&renderer->share, buffer, size_bytes) : status;
}

static camber_status current_begin(void *user, camber_shared_buffer *buffers, size_t count) {
    camber_renderer *renderer = user;
    const camber_status status = camber_surface_make_current(renderer->share.surface);
    return status == CAMBER_OK ? renderer->path->ops.begin(&renderer->share, buffers, count) : status;
}

static camber_status current_finish(void *user, camber_shared_buffer *buffers, size_t count, bool written) {
    camber_renderer *renderer = user;
    return renderer->path->ops.finish(&renderer->share, buffers, count, written);
}

static void current_release(void *user, camber_shared_buffer *buffer) {
    camber_renderer *renderer = user;
    if (!buffer->buffer && !buffer->gl_name)
        return;
    if (!camber_surface_try_current(renderer->share.surface))
        buffer->gl_name = 0; /* it is freed with its context */
    renderer->path->ops.release(&renderer->share, buffer);
}

static const camber_shared_buffer_ops current_ops = {current_reserve, current_begin, current_finish, current_release};

camber_status camber_mesh_create(camber_device *device, camber_renderer *renderer, camber_mesh **mesh) {
    assert(!renderer || renderer->share.device == device);
    const bool in_gl = renderer && !renderer->raster;
    const camber_mesh_output *output = renderer && renderer->raster ? NULL : &camber_vertices;
    const camber_status status = camber_mesh_create_on(device, in_gl ? &current_ops : NULL, renderer, output, mesh);
    if (status != CAMBER_OK)
        return status;
    (*mesh)->owner = renderer;
    if (in_gl && renderer->path->sharing == CAMBER_SHARING_COPY)
        (*mesh)->buffer_copies = 2;
    return CAMBER_OK;
}

bool camber_pixel_target_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    const camber_pixel_target *place = user;
    for (size_t i = 0; i < row_count; i++)
        memcpy(place->rgba + (first_row + i) * place->stride_bytes, rgba + i * place->row_bytes, place->row_bytes);
    return true;
}
