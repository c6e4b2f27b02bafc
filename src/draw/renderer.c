/* Renderers, meshes that they draw, and the frame: pieces, passes, rows. */
#include "draw/renderer.h"

#include <assert.h>

enum { SIDE_MAX_PX = 65535, PIECE_PX = 16 * 1024 * 1024 };

camber_status camber_renderer_create(camber_device *device, camber_surface *surface, const camber_renderer_desc *desc,
                                     camber_renderer **renderer) {
    camber_renderer *made = camber_alloc_zero(device->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->share = (camber_share){device, surface};
    camber_status status = camber_surface_make_current(surface);
    if (status == CAMBER_OK)
        status = camber_share_choose(&made->share, desc ? desc->sharing : CAMBER_SHARING_AUTO, &made->path);
    if (status != CAMBER_OK) {
        camber_free(device->context, made);
        return status;
    }
    surface->gl.GenVertexArrays(1, &made->vertex_array);
    surface->gl.GenTextures(1, &made->record_texture);
    status = camber_surface_check(surface, "opening");
    if (status != CAMBER_OK) {
        camber_renderer_destroy(made);
        return status;
    }
    *renderer = made;
    return CAMBER_OK;
}

void camber_renderer_destroy(camber_renderer *renderer) {
    if (!renderer)
        return;
    camber_context *context = renderer->share.device->context;
    const camber_gl *gl = &renderer->share.surface->gl;
    if (camber_surface_try_current(renderer->share.surface)) {
        for (int i = 0; i < CAMBER_VARIANTS; i++)
            gl->DeleteProgram(renderer->strokes[i].program);
        for (int i = 0; i < CAMBER_FLATTEN_KINDS; i++)
            gl->DeleteProgram(renderer->flatten[i].program);
        for (int i = 0; i < CAMBER_METHODS; i++)
            gl->DeleteProgram(renderer->counts[i].program);
        camber_renderer_release_targets(renderer);
        gl->DeleteTextures(1, &renderer->row_texture);
        gl->DeleteTextures(1, &renderer->record_texture);
        gl->DeleteVertexArrays(1, &renderer->vertex_array);
    }
    camber_free(context, renderer->batch.counts);
    camber_free(context, renderer->batch.firsts);
    camber_free(context, renderer->batch.ranges);
    camber_free(context, renderer->row_texels);
    camber_free(context, renderer);
}

camber_sharing camber_renderer_get_sharing(const camber_renderer *renderer) {
    return renderer->path->sharing;
}

/* ---- Meshes that a renderer draws: the GL context is current before GL buffers are touched ---- */

static camber_status current_reserve(void *user, camber_buffer *buffer, size_t size_bytes) {
    camber_renderer *renderer = user;
    const camber_status status = camber_surface_make_current(renderer->share.surface);
    return status == CAMBER_OK ? renderer->path->ops.reserve(&renderer->share, buffer, size_bytes) : status;
}

static camber_status current_begin(void *user, camber_buffer *buffers, size_t count) {
    camber_renderer *renderer = user;
    const camber_status status = camber_surface_make_current(renderer->share.surface);
    return status == CAMBER_OK ? renderer->path->ops.begin(&renderer->share, buffers, count) : status;
}

static camber_status current_finish(void *user, camber_buffer *buffers, size_t count, bool written) {
    camber_renderer *renderer = user;
    return renderer->path->ops.finish(&renderer->share, buffers, count, written);
}

static void current_release(void *user, camber_buffer *buffer) {
    camber_renderer *renderer = user;
    if (!buffer->mem && !buffer->gl_name)
        return;
    if (!camber_surface_try_current(renderer->share.surface))
        buffer->gl_name = 0; /* it goes with its context */
    renderer->path->ops.release(&renderer->share, buffer);
}

static const camber_buffer_ops current_ops = {current_reserve, current_begin, current_finish, current_release};

camber_status camber_mesh_create(camber_device *device, camber_renderer *renderer, camber_mesh **mesh) {
    assert(!renderer || renderer->share.device == device);
    const camber_status status = camber_mesh_create_on(device, renderer ? &current_ops : NULL, renderer, mesh);
    if (status == CAMBER_OK)
        (*mesh)->renderer = renderer;
    if (status == CAMBER_OK && renderer && renderer->path->sharing == CAMBER_SHARING_COPY)
        (*mesh)->buffer_copies = 2;
    return status;
}

/* ---- Frame ---- */

camber_status camber_renderer_check(camber_renderer *renderer, const char *what) {
    return camber_surface_check(renderer->share.surface, what);
}

static camber_status check_frame(camber_renderer *renderer, const camber_frame *frame) {
    if (frame->width < 1 || frame->width > SIDE_MAX_PX || frame->height < 1 || frame->height > SIDE_MAX_PX)
        return camber_fail(renderer->share.device->context, CAMBER_ERROR_ARGUMENT,
                           "a picture of %u x %u px; each side must be 1 to %d", frame->width, frame->height,
                           SIDE_MAX_PX);
    for (size_t i = 0; i < frame->pass_count; i++) {
        assert(frame->passes[i].mesh->renderer == renderer);
        assert(frame->passes[i].paint_count == 0 || frame->passes[i].paints);
    }
    return CAMBER_OK;
}

/* The largest piece: whole rows where the target reaches, and no more memory than needed. */
static camber_piece first_piece(const camber_renderer *renderer, const camber_frame *frame) {
    uint32_t side = renderer->share.surface->info.largest_target_px;
    if (frame->largest_piece_px && frame->largest_piece_px < side)
        side = frame->largest_piece_px;
    const uint32_t width = frame->width < side ? frame->width : side;
    const uint32_t fitting = (uint32_t)PIECE_PX / (width ? width : 1);
    const uint32_t rows = fitting < side ? fitting : side;
    return (camber_piece){
        .width = width, .height = frame->height < rows ? frame->height : rows, .coverage = frame->coverage};
}

static camber_status draw_piece(camber_renderer *renderer, const camber_frame *frame, const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_color back = frame->background;
    camber_status status =
        camber_renderer_bind_target(renderer, CAMBER_TARGET_PICTURE, (GLsizei)piece->width, (GLsizei)piece->height);
    if (status != CAMBER_OK)
        return status;
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA); /* but where layers are gathered */
    gl->Disable(GL_DITHER);
    gl->ClearColor(back.r * back.a, back.g * back.a, back.b * back.a, back.a);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    camber_batch_forget(renderer); /* of a frame that failed */
    for (size_t i = 0; i < frame->pass_count && status == CAMBER_OK; i++)
        status = camber_renderer_draw_pass(renderer, frame->passes + i, piece);
    if (status == CAMBER_OK)
        status = camber_batch_draw(renderer, 0, piece);
    gl->Finish();
    return status == CAMBER_OK ? camber_renderer_check(renderer, "drawing") : status;
}

static camber_status read_piece(camber_renderer *renderer, const camber_piece *piece, uint8_t *band, uint32_t width) {
    const camber_gl *gl = &renderer->share.surface->gl;
    gl->PixelStorei(GL_PACK_ROW_LENGTH, (GLint)width);
    gl->ReadPixels(0, 0, (GLsizei)piece->width, (GLsizei)piece->height, GL_RGBA, GL_UNSIGNED_BYTE,
                   band + 4 * (size_t)piece->x);
    gl->PixelStorei(GL_PACK_ROW_LENGTH, 0);
    return camber_renderer_check(renderer, "reading back");
}

/* The pieces of a band, from left to right, into its rows. */
static camber_status draw_band(camber_renderer *renderer, const camber_frame *frame, camber_piece piece, uint8_t *band,
                               camber_frame_stats *stats) {
    const uint32_t widest = piece.width;
    camber_status status = CAMBER_OK;
    for (piece.x = 0; piece.x < frame->width && status == CAMBER_OK; piece.x += widest) {
        piece.width = frame->width - piece.x < widest ? frame->width - piece.x : widest;
        const double begin = camber_now_ms();
        status = draw_piece(renderer, frame, &piece);
        const double drawn = camber_now_ms();
        stats->draw_ms += drawn - begin;
        stats->pieces++;
        if (band && status == CAMBER_OK) {
            status = read_piece(renderer, &piece, band, frame->width);
            stats->read_ms += camber_now_ms() - drawn;
        }
    }
    return status;
}

camber_status camber_render(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows, void *user,
                            camber_frame_stats *stats) {
    camber_context *context = renderer->share.device->context;
    camber_frame_stats counted = {0};
    uint8_t *band = NULL;
    camber_status status = check_frame(renderer, frame);
    if (status == CAMBER_OK)
        status = camber_surface_make_current(renderer->share.surface);
    if (status != CAMBER_OK)
        return status;
    camber_piece piece = first_piece(renderer, frame);
    piece.draw_calls = &counted.draw_calls;
    piece.thinnest_px = camber_renderer_thinnest(frame);
    const uint32_t tallest = piece.height;
    if (rows) {
        band = camber_alloc(context, (size_t)frame->width * tallest, 4);
        if (!band)
            return CAMBER_ERROR_MEMORY;
    }
    for (piece.y = 0; piece.y < frame->height && status == CAMBER_OK; piece.y += tallest) {
        piece.height = frame->height - piece.y < tallest ? frame->height - piece.y : tallest;
        status = draw_band(renderer, frame, piece, band, &counted);
        if (status == CAMBER_OK && rows && !rows(user, band, piece.y, piece.height))
            status = CAMBER_ERROR_IO;
        if (piece.height < frame->height)
            camber_progress(context, "drawing", (double)(piece.y + piece.height) / frame->height);
    }
    camber_free(context, band);
    if (status != CAMBER_OK)
        camber_surface_forget_errors(renderer->share.surface); /* the next frame's are its own */
    if (stats && status == CAMBER_OK)
        *stats = counted;
    return status;
}
