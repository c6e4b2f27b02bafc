/* Draws frames, in one call or in two steps that overlap. Each frame is resolved into the renderer's list, which GL or
 * OpenCL draws.
 *
 * A frame in flight that is not completely drawn when it begins is resolved again when it ends: its meshes may have
 * changed, and another frame may have taken the list. Its passes and paints are copied, because the caller's may be
 * gone by then. */
#include "draw/draw_cl.h"
#include "draw/renderer.h"

#include <assert.h>
#include <string.h>

static const int targets[CAMBER_FRAMES_IN_FLIGHT] = {CAMBER_TARGET_PICTURE, CAMBER_TARGET_NEXT_PICTURE};

camber_status camber_renderer_resolve(camber_renderer *renderer, const camber_frame *frame) {
    for (size_t i = 0; i < frame->pass_count; i++)
        assert(frame->passes[i].kind == CAMBER_PASS_FILL ||
               (frame->passes[i].mesh && frame->passes[i].mesh->owner == renderer));
    const camber_status status = camber_check_process(renderer->share.device->context);
    if (status != CAMBER_OK)
        return status;
    return camber_draw_list_build(&renderer->list, frame);
}

static camber_status begin(camber_renderer *renderer, int target, camber_flight *flight) {
    return renderer->raster ? camber_cl_begin_frame(renderer, flight) : camber_gl_begin_frame(renderer, target, flight);
}

static camber_status end(camber_renderer *renderer, camber_flight *flight, camber_rows_fn *rows, void *user) {
    return renderer->raster ? camber_cl_end_frame(renderer, flight, rows, user)
                            : camber_gl_end_frame(renderer, flight, rows, user);
}

static camber_status render_in_gl(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows,
                                  void *user, camber_frame_stats *stats) {
    camber_flight flight = {.frame = *frame};
    camber_status status = begin(renderer, CAMBER_TARGET_PICTURE, &flight);
    if (status == CAMBER_OK)
        status = end(renderer, &flight, rows, user);
    *stats = flight.stats;
    return status;
}

/* Draws a frame. place: memory that all rows go to. NULL: they are passed to rows. */
static camber_status render(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows, void *user,
                            camber_place *place, camber_frame_stats *stats) {
    assert(renderer->flight_count == 0);
    camber_frame_stats made;
    camber_status status = camber_renderer_resolve(renderer, frame);
    if (status == CAMBER_OK)
        status = !renderer->raster ? render_in_gl(renderer, frame, rows, user, &made)
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

camber_status camber_renderer_render_into(camber_renderer *renderer, const camber_frame *frame, uint8_t *rgba,
                                          size_t stride_bytes, camber_frame_stats *stats) {
    const size_t row_bytes = 4 * (size_t)frame->width;
    camber_place place = {rgba, row_bytes, stride_bytes ? stride_bytes : row_bytes};
    assert(rgba && place.stride_bytes >= row_bytes);
    return render(renderer, frame, camber_place_rows, &place, &place, stats);
}

/* ---- Frames that overlap ---- */

static camber_status copy_passes(camber_renderer *renderer, camber_flight *flight) {
    const camber_frame *frame = &flight->frame;
    camber_context *context = renderer->share.device->context;
    size_t paint_count = 0;
    for (size_t i = 0; i < frame->pass_count; i++)
        paint_count += frame->passes[i].paint_count;
    flight->passes = camber_alloc(context, frame->pass_count + 1, sizeof *flight->passes);
    flight->paints = camber_alloc(context, paint_count + 1, sizeof *flight->paints);
    if (!flight->passes || !flight->paints)
        return CAMBER_ERROR_MEMORY;
    camber_paint *paints = flight->paints;
    for (size_t i = 0; i < frame->pass_count; i++) {
        const camber_pass *pass = frame->passes + i;
        flight->passes[i] = *pass;
        flight->passes[i].paints = paints;
        if (pass->paint_count)
            memcpy(paints, pass->paints, pass->paint_count * sizeof *paints);
        paints += pass->paint_count;
    }
    flight->frame.passes = flight->passes;
    return CAMBER_OK;
}

/* Drops a flight. is_current: the GL context is current, so that the fence can be deleted. */
static void drop_flight(camber_renderer *renderer, camber_flight *flight, bool is_current) {
    camber_context *context = renderer->share.device->context;
    if (is_current)
        camber_gl_drop_fence(renderer, flight);
    camber_free(context, flight->paints);
    camber_free(context, flight->passes);
    camber_free(context, flight->rgba);
    flight->rgba = NULL;
    flight->paints = NULL;
    flight->passes = NULL;
}

camber_status camber_renderer_begin(camber_renderer *renderer, const camber_frame *frame) {
    assert(renderer->flight_count < CAMBER_FRAMES_IN_FLIGHT);
    if (renderer->flight_count == 0)
        renderer->first_flight = 0;
    const size_t at = (renderer->first_flight + renderer->flight_count) % CAMBER_FRAMES_IN_FLIGHT;
    camber_flight flight = {.frame = *frame};
    camber_status status = camber_renderer_resolve(renderer, frame);
    if (status == CAMBER_OK)
        status = begin(renderer, targets[at], &flight);
    if (status != CAMBER_OK)
        return status;
    if (!flight.is_drawn)
        status = copy_passes(renderer, &flight);
    if (status != CAMBER_OK) {
        drop_flight(renderer, &flight, true);
        return status;
    }
    renderer->flights[at] = flight;
    renderer->flight_count++;
    return CAMBER_OK;
}

camber_status camber_renderer_end(camber_renderer *renderer, camber_rows_fn *rows, void *user,
                                  camber_frame_stats *stats) {
    assert(renderer->flight_count > 0);
    camber_flight *flight = renderer->flights + renderer->first_flight;
    camber_status status = flight->is_drawn ? camber_check_process(renderer->share.device->context)
                                            : camber_renderer_resolve(renderer, &flight->frame);
    if (status == CAMBER_OK)
        status = end(renderer, flight, rows, user);
    /* A fence is left only if the frame was not resolved. */
    drop_flight(renderer, flight, flight->drawn && camber_surface_try_current(renderer->share.surface));
    renderer->first_flight = (renderer->first_flight + 1) % CAMBER_FRAMES_IN_FLIGHT;
    renderer->flight_count--;
    if (stats && status == CAMBER_OK)
        *stats = flight->stats;
    return status;
}

void camber_renderer_drop_flights(camber_renderer *renderer, bool is_current) {
    for (size_t i = 0; i < CAMBER_FRAMES_IN_FLIGHT; i++)
        drop_flight(renderer, renderer->flights + i, is_current);
}
