/* Draws frames into the caller's textures. GL draws directly into the texture. OpenCL draws into a buffer shared with
 * GL, from which GL copies. A frame that is drawn over the texture's content, or upside down, is drawn into a target
 * first and then composited onto the texture. */
#include "draw/draw_cl.h"
#include "draw/renderer.h"

#include <assert.h>

static camber_status check_size(const camber_renderer *renderer, const camber_frame *frame) {
    camber_context *context = renderer->share.device->context;
    if (!renderer->share.surface)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "a texture for a renderer that has no GL; create it with a surface");
    const uint32_t largest = renderer->share.surface->info.largest_target_px;
    if (frame->width > largest || frame->height > largest)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "a frame of %u x %u px in a texture, where %s has up to %u a side; draw a smaller one",
                           frame->width, frame->height, renderer->share.surface->info.renderer, largest);
    return CAMBER_OK;
}

/* Binds the texture, if it has the right size and format. */
static camber_status check_texture(camber_renderer *renderer, const camber_frame *frame,
                                   const camber_texture *texture) {
    const camber_gl *gl = &renderer->share.surface->gl;
    GLint width = 0, height = 0, format = 0;
    if (texture->ready)
        gl->WaitSync((GLsync)texture->ready, 0, GL_TIMEOUT_IGNORED);
    gl->BindTexture(GL_TEXTURE_2D, 0); /* its size is 0, as for a name that is not in use */
    gl->BindTexture(GL_TEXTURE_2D, texture->name);
    gl->GetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    gl->GetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &height);
    gl->GetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
    const bool fits = texture->name && (uint32_t)width == frame->width && (uint32_t)height == frame->height;
    if (fits && (format == GL_RGBA8 || format == GL_RGBA))
        return camber_gl_check(renderer, "a texture");
    camber_surface_forget_errors(renderer->share.surface);
    if (renderer->share.surface->lost)
        return camber_surface_make_current(renderer->share.surface);
    return camber_fail(
        renderer->share.device->context, CAMBER_ERROR_ARGUMENT,
        "texture %u has %d x %d px of the format 0x%x; give one of GL_RGBA8 that is %u x %u px, like the "
        "frame",
        texture->name, (int)width, (int)height, (unsigned)format, frame->width, frame->height);
}

/* ---- Areas that OpenCL draws ---- */

/* Copies an area from the buffer into the bound texture. */
static camber_status upload(camber_renderer *renderer, const camber_raster_area *area) {
    const camber_gl *gl = &renderer->share.surface->gl;
    gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, renderer->pixels.gl_name);
    gl->PixelStorei(GL_UNPACK_ROW_LENGTH, (GLint)camber_raster_stride_px(area));
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, (GLint)area->x, (GLint)area->y, (GLsizei)area->width, (GLsizei)area->height,
                      GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    gl->PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    renderer->pixels.drawn_frame = renderer->share.frames_begun;
    return camber_gl_check(renderer, "pixels into a texture");
}

static camber_status draw_area(camber_renderer *renderer, const camber_raster_scene *scene,
                               const camber_raster_area *area, void *user) {
    const camber_shared_buffer_ops *ops = &renderer->path->ops;
    camber_shared_buffer *pixels = &renderer->pixels;
    (void)user;
    camber_status status = ops->reserve(&renderer->share, pixels, camber_raster_bytes(area));
    if (status != CAMBER_OK)
        return status;
    pixels->used_bytes = 4 * camber_raster_stride_px(area) * area->height;
    status = ops->begin(&renderer->share, pixels, 1);
    if (status != CAMBER_OK)
        return status;
    status = camber_raster_draw_into(renderer->raster, scene, area, pixels->buffer);
    camber_saved_log kept = {0};
    const bool told = status != CAMBER_OK; /* another error would be logged as a second message */
    if (told)
        camber_log_demote_errors(renderer->share.device->context, &kept);
    /* If memory was short, meshes of another surface may have released buffers, which made its context current. */
    camber_status finished = camber_surface_make_current(renderer->share.surface);
    if (finished == CAMBER_OK)
        finished = ops->finish(&renderer->share, pixels, 1, !told);
    if (told)
        camber_log_restore(renderer->share.device->context, &kept);
    if (!told)
        status = finished;
    return status == CAMBER_OK ? upload(renderer, area) : status;
}

/* ---- Putting the frame onto a texture ---- */

static camber_status put_onto(camber_renderer *renderer, const camber_frame *frame, const camber_texture *texture) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_shader *shader;
    camber_status status = camber_shaders_flatten(
        &renderer->gl.shaders, texture->bottom_up ? CAMBER_FLATTEN_FLIPPED : CAMBER_FLATTEN_COLORS, &shader);
    if (status == CAMBER_OK)
        status = camber_target_bind(renderer, CAMBER_TARGET_GIVEN, (GLsizei)frame->width, (GLsizei)frame->height);
    if (status != CAMBER_OK)
        return status;
    gl->Disable(GL_CULL_FACE);
    gl->Disable(GL_DITHER);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, texture->keep ? GL_ONE_MINUS_SRC_ALPHA : GL_ZERO);
    gl->UseProgram(shader->program);
    gl->Uniform4f(shader->layer_color, 1.0f, 1.0f, 1.0f, 1.0f);
    gl->BindTexture(GL_TEXTURE_2D, renderer->gl.targets[CAMBER_TARGET_PICTURE].texture);
    gl->BindVertexArray(renderer->gl.vertex_array);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    gl->BindVertexArray(0);
    return camber_gl_check(renderer, "drawing into a texture");
}

static camber_status draw(camber_renderer *renderer, const camber_frame *frame, const camber_texture *texture) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const GLsizei width = (GLsizei)frame->width, height = (GLsizei)frame->height;
    const bool direct = !texture->keep && !texture->bottom_up;
    camber_status status = CAMBER_OK;
    if (!direct || !renderer->raster)
        status = camber_target_give(renderer, texture->name, width, height);
    if (status != CAMBER_OK)
        return status;
    if (renderer->raster) {
        if (!direct)
            status = camber_target_bind(renderer, CAMBER_TARGET_PICTURE, width, height);
        gl->BindTexture(GL_TEXTURE_2D, direct ? texture->name : renderer->gl.targets[CAMBER_TARGET_PICTURE].texture);
        if (status == CAMBER_OK)
            status = camber_cl_each_area(renderer, frame, draw_area, NULL);
    } else {
        status = camber_gl_draw_frame(renderer, frame, direct ? CAMBER_TARGET_GIVEN : CAMBER_TARGET_PICTURE);
    }
    if (status == CAMBER_OK && !direct)
        status = put_onto(renderer, frame, texture);
    camber_target_take_back(renderer);
    return status;
}

/* Leaves a fence, or waits. */
static void end(camber_renderer *renderer, void **drawn) {
    const camber_gl *gl = &renderer->share.surface->gl;
    GLsync fence = drawn ? gl->FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0) : NULL;
    if (fence) {
        gl->Flush();
    } else {
        gl->Finish();
        renderer->share.frames_done = renderer->share.frames_begun;
    }
    if (drawn)
        *drawn = (void *)fence;
}

camber_status camber_renderer_render_texture(camber_renderer *renderer, const camber_frame *frame,
                                             const camber_texture *texture, void **drawn) {
    camber_status status = camber_renderer_resolve(renderer, frame);
    if (status == CAMBER_OK)
        status = check_size(renderer, frame);
    if (status == CAMBER_OK)
        status = camber_surface_make_current(renderer->share.surface);
    if (status != CAMBER_OK)
        return status;
    renderer->share.frames_begun++;
    status = check_texture(renderer, frame, texture);
    if (status == CAMBER_OK)
        status = draw(renderer, frame, texture);
    if (status == CAMBER_OK)
        end(renderer, drawn);
    else
        camber_surface_forget_errors(renderer->share.surface); /* the next frame must only see its own */
    return status;
}
