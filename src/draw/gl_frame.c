/* Draws frames in GL: rectangles (areas) of the picture, drawn one after another, waited for, and read back as rows. */
#include "draw/renderer.h"

enum { AREA_PX = 16 * 1024 * 1024 };

void camber_gl_release(camber_renderer *renderer, bool is_current) {
    const camber_gl *gl = &renderer->share.surface->gl;
    camber_context *context = renderer->share.device->context;
    camber_gl_drawing *drawing = &renderer->gl;
    camber_atlas_release(renderer, is_current);
    if (is_current) {
        camber_shaders_release(&drawing->shaders);
        camber_targets_release(renderer);
        gl->DeleteTextures(1, &drawing->rows.texture);
        gl->DeleteTextures(1, &drawing->record_texture);
        gl->DeleteVertexArrays(1, &drawing->vertex_array);
    }
    camber_free(context, drawing->batch.counts);
    camber_free(context, drawing->batch.firsts);
    camber_free(context, drawing->batch.ranges);
    camber_free(context, drawing->rows.texels);
}

/* Returns an area of the given size in the top left corner of the picture. */
static camber_gl_area make_area(const camber_renderer *renderer, const camber_frame *frame, uint32_t width,
                                uint32_t height, size_t *draw_calls) {
    return (camber_gl_area){.width = width,
                            .height = height,
                            .target = CAMBER_TARGET_PICTURE,
                            .coverage = frame->coverage,
                            .thinnest_px = renderer->list.thinnest_px,
                            .view = renderer->list.view,
                            .draw_calls = draw_calls};
}

/* Returns the first area of a frame, as large as possible: whole rows if the target is wide enough, and no more memory
 * than needed. */
static camber_gl_area first_area(const camber_renderer *renderer, const camber_frame *frame, size_t *draw_calls) {
    uint32_t side = renderer->share.surface->info.largest_target_px;
    if (frame->largest_area_px && frame->largest_area_px < side)
        side = frame->largest_area_px;
    const uint32_t width = frame->width < side ? frame->width : side;
    const uint32_t fitting = (uint32_t)AREA_PX / (width ? width : 1);
    const uint32_t rows = fitting < side ? fitting : side;
    return make_area(renderer, frame, width, frame->height < rows ? frame->height : rows, draw_calls);
}

/* ---- An area ---- */

static camber_status draw_area(camber_renderer *renderer, const camber_frame *frame, const camber_gl_area *area) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_color back = frame->background;
    camber_status status = camber_target_bind(renderer, area->target, (GLsizei)area->width, (GLsizei)area->height);
    if (status != CAMBER_OK)
        return status;
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA); /* except while drawing into layers */
    gl->Disable(GL_DITHER);
    gl->ClearColor(back.r * back.a, back.g * back.a, back.b * back.a, back.a);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    camber_batch_clear(renderer); /* polylines may be left over from a frame that failed */
    status = camber_atlas_begin(renderer);
    if (status == CAMBER_OK)
        status = camber_gl_draw_commands(renderer, area);
    return status == CAMBER_OK ? camber_gl_check(renderer, "drawing") : status;
}

/* Reads an area into rows of the picture, which is width px wide. */
static camber_status read_area(camber_renderer *renderer, const camber_gl_area *area, uint8_t *rgba, uint32_t width) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_status status =
        camber_target_bind(renderer, area->target, (GLsizei)area->width, (GLsizei)area->height);
    if (status != CAMBER_OK)
        return status;
    gl->PixelStorei(GL_PACK_ROW_LENGTH, (GLint)width);
    gl->ReadPixels(0, 0, (GLsizei)area->width, (GLsizei)area->height, GL_RGBA, GL_UNSIGNED_BYTE,
                   rgba + 4 * (size_t)area->x);
    gl->PixelStorei(GL_PACK_ROW_LENGTH, 0);
    return camber_gl_check(renderer, "reading back");
}

/* ---- A frame ---- */

camber_status camber_gl_draw_frame(camber_renderer *renderer, const camber_frame *frame, int target) {
    size_t draw_calls = 0;
    camber_gl_area area = make_area(renderer, frame, frame->width, frame->height, &draw_calls);
    area.target = target;
    return draw_area(renderer, frame, &area);
}

/* Draws areas from left to right, starting with area, and reads them into rgba, which may be NULL. */
static camber_status draw_across(camber_renderer *renderer, const camber_frame *frame, camber_gl_area area,
                                 uint8_t *rgba, camber_frame_stats *stats) {
    const uint32_t widest = area.width, width = frame->width;
    camber_status status = CAMBER_OK;
    for (area.x = 0; area.x < width && status == CAMBER_OK; area.x += widest) {
        area.width = width - area.x < widest ? width - area.x : widest;
        const double begin = camber_now_ms();
        status = draw_area(renderer, frame, &area);
        renderer->share.surface->gl.Finish();
        if (status == CAMBER_OK)
            status = camber_gl_check(renderer, "drawing");
        const double drawn = camber_now_ms();
        stats->areas++;
        stats->draw_ms += drawn - begin;
        if (rgba && status == CAMBER_OK) {
            status = read_area(renderer, &area, rgba, width);
            stats->read_ms += camber_now_ms() - drawn;
        }
    }
    return status;
}

camber_status camber_gl_render(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows, void *user,
                               camber_frame_stats *stats) {
    camber_context *context = renderer->share.device->context;
    *stats = (camber_frame_stats){0};
    camber_gl_area area = first_area(renderer, frame, &stats->draw_calls);
    const uint32_t tallest = area.height, width = frame->width, height = frame->height;
    uint8_t *rgba = NULL;
    camber_status status = camber_surface_make_current(renderer->share.surface);
    if (status != CAMBER_OK)
        return status;
    renderer->share.frames_begun++;
    if (rows && !(rgba = camber_alloc(context, (size_t)width * tallest, 4)))
        status = CAMBER_ERROR_MEMORY;
    for (area.y = 0; area.y < height && status == CAMBER_OK; area.y += tallest) {
        area.height = height - area.y < tallest ? height - area.y : tallest;
        status = draw_across(renderer, frame, area, rgba, stats);
        if (status == CAMBER_OK && rows && !rows(user, rgba, area.y, area.height))
            status = CAMBER_ERROR_IO;
        if (area.height < height)
            camber_progress(context, "drawing", (double)(area.y + area.height) / height);
    }
    camber_free(context, rgba);
    if (status == CAMBER_OK)
        renderer->share.frames_done = renderer->share.frames_begun;
    else
        camber_surface_forget_errors(renderer->share.surface); /* the next frame must see only its own errors */
    return status;
}
