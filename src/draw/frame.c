/* Draws frames: each is resolved into the renderer's list, which GL or OpenCL draws. */
#include "draw/draw_cl.h"
#include "draw/renderer.h"

#include <assert.h>
#include <math.h>
#include <string.h>

camber_status camber_renderer_resolve(camber_renderer *renderer, const camber_frame *frame) {
    for (size_t i = 0; i < frame->pass_count; i++)
        assert(frame->passes[i].kind == CAMBER_PASS_FILL ||
               (frame->passes[i].mesh && frame->passes[i].mesh->owner == renderer));
    const camber_status status = camber_check_process(renderer->share.device->context);
    if (status != CAMBER_OK)
        return status;
    return camber_draw_list_build(&renderer->list, frame);
}

/* Draws a frame. place: memory for all rows. NULL: they are passed to `rows`. */
static camber_status render(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows, void *user,
                            camber_pixel_target *place, camber_frame_stats *stats) {
    camber_frame_stats made;
    camber_status status = camber_renderer_resolve(renderer, frame);
    if (status == CAMBER_OK)
        status = !renderer->raster ? camber_gl_render(renderer, frame, rows, user, &made)
                 : place           ? camber_cl_render_into(renderer, frame, place, &made)
                                   : camber_cl_render(renderer, frame, rows, user, &made);
    if (stats && status == CAMBER_OK)
        *stats = made;
    return status;
}

camber_status camber_renderer_render(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows,
                                     void *user, camber_frame_stats *stats) {
    return render(renderer, frame, rows, user, NULL, stats);
}

/* Whether the rows of a command are opaque and have a finite red, which alone is added up. */
static bool has_sums(const camber_draw_list *list, const camber_draw_command *command) {
    for (size_t i = 0; i < command->mesh->row_count; i++) {
        const camber_row_paint *row = list->rows + command->first_row + i;
        const float alpha = camber_draw_command_alpha(command, row);
        if (alpha >= 0.0f && !(alpha == 1.0f && isfinite(row->color.r)))
            return false;
    }
    return true;
}

/* Checks that a resolved frame can be summed: by a rasterizer that has sums, and only opaque lines. */
static camber_status check_sum(const camber_renderer *renderer, const camber_frame *frame) {
    camber_context *context = renderer->share.device->context;
    const unsigned wrong = CAMBER_FEATURE_RAMP | CAMBER_FEATURE_IMAGE;
    if (!renderer->raster)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "a sum: this renderer draws in GL; make one with CAMBER_RASTERIZER_OPENCL");
    if (frame->background.a > 0.0f)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "a sum: the frame has a background; leave it transparent");
    for (size_t i = 0; i < renderer->list.command_count; i++) {
        const camber_draw_command *command = renderer->list.commands + i;
        if (!command->mesh || command->composite != CAMBER_COMPOSITE_STRAIGHT || command->features & wrong)
            return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                               "a sum: a pass has a fill, an area, a ramp, an image or an alpha; give opaque lines");
        if (!has_sums(&renderer->list, command))
            return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                               "a sum: a paint has an alpha below 1 or a red that is not finite; give opaque paints");
    }
    return CAMBER_OK;
}

camber_status camber_renderer_sum(camber_renderer *renderer, const camber_frame *frame, float *sums,
                                  size_t stride_bytes, camber_frame_stats *stats) {
    const size_t row_bytes = sizeof *sums * (size_t)frame->width;
    camber_pixel_target place = {(uint8_t *)sums, row_bytes, stride_bytes ? stride_bytes : row_bytes};
    camber_frame_stats made;
    assert(sums && place.stride_bytes >= row_bytes);
    camber_status status = camber_renderer_resolve(renderer, frame);
    if (status == CAMBER_OK)
        status = check_sum(renderer, frame);
    if (status != CAMBER_OK)
        return status;
    renderer->list.is_sum = true;
    status = camber_cl_render_into(renderer, frame, &place, &made);
    renderer->list.is_sum = false;
    if (stats && status == CAMBER_OK)
        *stats = made;
    return status;
}

camber_status camber_renderer_render_into(camber_renderer *renderer, const camber_frame *frame, uint8_t *rgba,
                                          size_t stride_bytes, camber_frame_stats *stats) {
    const size_t row_bytes = 4 * (size_t)frame->width;
    camber_pixel_target place = {rgba, row_bytes, stride_bytes ? stride_bytes : row_bytes};
    assert(rgba && place.stride_bytes >= row_bytes);
    return render(renderer, frame, camber_pixel_target_rows, &place, &place, stats);
}
