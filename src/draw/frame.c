/* The frame: pieces of the picture, drawn one after the other, waited for, and read back into bands of rows. The first
 * piece of a frame is drawn when it begins; what is left is done when it ends. */
#include "base/perspective.h"
#include "draw/renderer.h"

#include <assert.h>
#include <string.h>

enum { SIDE_MAX_PX = 65535, PIECE_PX = 16 * 1024 * 1024 };

static const int targets[CAMBER_FRAMES_IN_FLIGHT] = {CAMBER_TARGET_PICTURE, CAMBER_TARGET_NEXT_PICTURE};

camber_status camber_renderer_check(camber_renderer *renderer, const char *what) {
    return camber_surface_check(renderer->share.surface, what);
}

static camber_status check_images(const camber_renderer *renderer, const camber_pass *pass) {
    for (size_t i = 0; i < pass->image_count; i++)
        if (!camber_image_is_valid(pass->images + i))
            return camber_fail(renderer->share.device->context, CAMBER_ERROR_ARGUMENT,
                               "image %zu: %u x %u px; give 1 to %d a side, and rows that do not overlap", i,
                               pass->images[i].width, pass->images[i].height, CAMBER_IMAGE_SIDE_MAX);
    assert(pass->fill.pattern <= pass->image_count);
    return CAMBER_OK;
}

static camber_status check_paints(const camber_renderer *renderer, const camber_pass *pass) {
    camber_context *context = renderer->share.device->context;
    for (size_t i = 0; i < pass->dash_count; i++)
        if (!camber_dash_is_valid(pass->dashes + i))
            return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                               "dash %zu: %zu lengths; give up to %d of 0 and more, and one above 0", i,
                               pass->dashes[i].count, CAMBER_DASH_LENGTHS_MAX);
    for (size_t i = 0; i < pass->ramp_count; i++)
        if (!camber_ramp_is_valid(pass->ramps + i))
            return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                               "ramp %zu: %zu stops; give 1 to %d in ascending places, and finite colours", i,
                               pass->ramps[i].count, CAMBER_RAMP_STOPS_MAX);
    for (size_t i = 0; i < pass->paint_count; i++) {
        const camber_paint *paint = pass->paints + i;
        assert(paint->dash <= pass->dash_count && paint->ramp <= pass->ramp_count &&
               paint->pattern <= pass->image_count);
        const char *what = paint->pattern ? "patterns" : paint->dash ? "dashes" : paint->ramp ? "ramps" : "trims";
        const bool trims = paint->trim_end > paint->trim_start;
        const bool measured = pass->mesh->mesh_info.measured || pass->mesh->empty;
        if (!measured && (paint->dash || paint->ramp || paint->pattern || trims))
            return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                               "%s of a mesh that is not measured; tessellate it measured", what);
    }
    return CAMBER_OK;
}

camber_status camber_frame_check(camber_renderer *renderer, const camber_frame *frame) {
    if (frame->width < 1 || frame->width > SIDE_MAX_PX || frame->height < 1 || frame->height > SIDE_MAX_PX)
        return camber_fail(renderer->share.device->context, CAMBER_ERROR_ARGUMENT,
                           "a picture of %u x %u px; each side must be 1 to %d", frame->width, frame->height,
                           SIDE_MAX_PX);
    if (!camber_pitch_is_valid(frame->pitch_deg))
        return camber_fail(renderer->share.device->context, CAMBER_ERROR_ARGUMENT,
                           "a picture with a pitch of %g degrees; choose 0 to %g", frame->pitch_deg,
                           CAMBER_PITCH_MAX_DEG);
    for (size_t i = 0; i < frame->pass_count; i++) {
        const camber_pass *pass = frame->passes + i;
        assert(!pass->mesh || pass->mesh->owner == renderer);
        assert(pass->paint_count == 0 || pass->paints);
        camber_status status = check_images(renderer, pass);
        if (status == CAMBER_OK && pass->mesh)
            status = check_paints(renderer, pass);
        if (status != CAMBER_OK)
            return status;
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

static void pitch_piece(const camber_frame *frame, camber_piece *piece) {
    if (!(frame->pitch_deg > 0.0))
        return;
    const camber_perspective p = camber_perspective_of(frame->pitch_deg, frame->height);
    piece->pitched = true;
    piece->eye[0] = 0.5f * (float)frame->width;
    piece->eye[1] = 0.5f * (float)frame->height;
    piece->eye[2] = (float)p.cosine;
    piece->eye[3] = (float)p.fall;
    piece->horizon = camber_perspective_horizon(&p, frame->height);
}

/* ---- A piece ---- */

/* Leaves a fence behind what it draws. */
static camber_status draw_piece(camber_renderer *renderer, camber_flight *flight, const camber_piece *piece) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_frame *frame = &flight->frame;
    const camber_color back = frame->background;
    camber_status status =
        camber_renderer_bind_target(renderer, piece->target, (GLsizei)piece->width, (GLsizei)piece->height);
    if (status != CAMBER_OK)
        return status;
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA); /* but where layers are gathered */
    gl->Disable(GL_DITHER);
    gl->ClearColor(back.r * back.a, back.g * back.a, back.b * back.a, back.a);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    camber_batch_forget(renderer); /* of a frame that failed */
    camber_patterns_begin(renderer, piece);
    for (size_t i = 0; i < frame->pass_count && status == CAMBER_OK; i++)
        status = camber_renderer_draw_pass(renderer, frame->passes + i, piece);
    if (status == CAMBER_OK)
        status = camber_batch_draw(renderer, 0, piece);
    flight->drawn = status == CAMBER_OK ? gl->FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0) : NULL;
    if (flight->drawn)
        gl->Flush();
    else
        gl->Finish();
    flight->stats.pieces++;
    return status == CAMBER_OK ? camber_renderer_check(renderer, "drawing") : status;
}

static void drop_fence(camber_renderer *renderer, camber_flight *flight) {
    if (flight->drawn)
        renderer->share.surface->gl.DeleteSync(flight->drawn);
    flight->drawn = NULL;
}

static camber_status wait_for_piece(camber_renderer *renderer, camber_flight *flight) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const GLuint64 second_ns = 1000000000;
    GLenum seen = GL_TIMEOUT_EXPIRED;
    while (flight->drawn && seen == GL_TIMEOUT_EXPIRED) /* a context that is lost answers, too */
        seen = gl->ClientWaitSync(flight->drawn, GL_SYNC_FLUSH_COMMANDS_BIT, second_ns);
    drop_fence(renderer, flight);
    if (seen == GL_WAIT_FAILED)
        gl->Finish();
    return camber_renderer_check(renderer, "drawing");
}

static camber_status read_piece(camber_renderer *renderer, const camber_piece *piece, uint8_t *band, uint32_t width) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_status status =
        camber_renderer_bind_target(renderer, piece->target, (GLsizei)piece->width, (GLsizei)piece->height);
    if (status != CAMBER_OK)
        return status;
    gl->PixelStorei(GL_PACK_ROW_LENGTH, (GLint)width);
    gl->ReadPixels(0, 0, (GLsizei)piece->width, (GLsizei)piece->height, GL_RGBA, GL_UNSIGNED_BYTE,
                   band + 4 * (size_t)piece->x);
    gl->PixelStorei(GL_PACK_ROW_LENGTH, 0);
    return camber_renderer_check(renderer, "reading back");
}

/* The pieces of a band, from left to right, into its rows. */
static camber_status draw_band(camber_renderer *renderer, camber_flight *flight, camber_piece piece, uint8_t *band) {
    const uint32_t widest = piece.width, width = flight->frame.width;
    camber_frame_stats *stats = &flight->stats;
    camber_status status = CAMBER_OK;
    piece.draw_calls = &stats->draw_calls;
    for (piece.x = 0; piece.x < width && status == CAMBER_OK; piece.x += widest) {
        piece.width = width - piece.x < widest ? width - piece.x : widest;
        const double begin = camber_now_ms();
        if (piece.x > 0 || piece.y > 0) /* the first was drawn when the frame began */
            status = draw_piece(renderer, flight, &piece);
        if (status == CAMBER_OK)
            status = wait_for_piece(renderer, flight);
        const double drawn = camber_now_ms();
        stats->draw_ms += drawn - begin;
        if (band && status == CAMBER_OK) {
            status = read_piece(renderer, &piece, band, width);
            stats->read_ms += camber_now_ms() - drawn;
        }
    }
    return status;
}

/* ---- A frame in flight ---- */

camber_status camber_frame_draw(camber_renderer *renderer, const camber_frame *frame, int target) {
    camber_flight flight = {.frame = *frame};
    camber_piece piece = {.width = frame->width,
                          .height = frame->height,
                          .coverage = frame->coverage,
                          .thinnest_px = camber_renderer_thinnest(frame),
                          .target = target,
                          .draw_calls = &flight.stats.draw_calls};
    pitch_piece(frame, &piece);
    const camber_status status = draw_piece(renderer, &flight, &piece);
    drop_fence(renderer, &flight);
    return status;
}

static bool has_one_piece(const camber_flight *flight) {
    return flight->first.width == flight->frame.width && flight->first.height == flight->frame.height;
}

/* Draws the first piece. */
static camber_status begin(camber_renderer *renderer, const camber_frame *frame, int target, camber_flight *flight) {
    camber_flight made = {.frame = *frame, .first = first_piece(renderer, frame)};
    camber_status status = camber_surface_make_current(renderer->share.surface);
    if (status != CAMBER_OK)
        return status;
    const double start = camber_now_ms();
    made.first.thinnest_px = camber_renderer_thinnest(frame);
    pitch_piece(frame, &made.first);
    made.first.target = target;
    made.number = ++renderer->share.frames_begun;
    camber_piece piece = made.first;
    piece.draw_calls = &made.stats.draw_calls;
    status = draw_piece(renderer, &made, &piece);
    made.stats.draw_ms = camber_now_ms() - start;
    if (status != CAMBER_OK) {
        drop_fence(renderer, &made);
        camber_surface_forget_errors(renderer->share.surface); /* the next frame's are its own */
        return status;
    }
    *flight = made;
    return CAMBER_OK;
}

static camber_status end(camber_renderer *renderer, camber_flight *flight, camber_rows_fn *rows, void *user) {
    camber_context *context = renderer->share.device->context;
    camber_piece piece = flight->first;
    const uint32_t tallest = piece.height, width = flight->frame.width, height = flight->frame.height;
    uint8_t *band = NULL;
    camber_status status = camber_surface_make_current(renderer->share.surface);
    if (status == CAMBER_OK && rows && !(band = camber_alloc(context, (size_t)width * tallest, 4)))
        status = CAMBER_ERROR_MEMORY;
    for (piece.y = 0; piece.y < height && status == CAMBER_OK; piece.y += tallest) {
        piece.height = height - piece.y < tallest ? height - piece.y : tallest;
        status = draw_band(renderer, flight, piece, band);
        if (status == CAMBER_OK && rows && !rows(user, band, piece.y, piece.height))
            status = CAMBER_ERROR_IO;
        if (piece.height < height)
            camber_progress(context, "drawing", (double)(piece.y + piece.height) / height);
    }
    camber_free(context, band);
    if (status == CAMBER_OK) {
        if (renderer->share.frames_done < flight->number)
            renderer->share.frames_done = flight->number;
    } else {
        if (camber_surface_try_current(renderer->share.surface))
            drop_fence(renderer, flight);
        camber_surface_forget_errors(renderer->share.surface);
    }
    return status;
}

camber_status camber_render(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows, void *user,
                            camber_frame_stats *stats) {
    assert(renderer->flight_count == 0);
    camber_flight flight = {0};
    camber_status status = camber_frame_check(renderer, frame);
    if (status == CAMBER_OK && renderer->cover) {
        status = camber_covered_render(renderer, frame, rows, user, &flight.stats);
    } else {
        if (status == CAMBER_OK)
            status = begin(renderer, frame, CAMBER_TARGET_PICTURE, &flight);
        if (status == CAMBER_OK)
            status = end(renderer, &flight, rows, user);
    }
    if (stats && status == CAMBER_OK)
        *stats = flight.stats;
    return status;
}

/* ---- Frames that overlap ---- */

/* What the pieces after the first are drawn from: the caller's passes and paints may be gone by then. */
static camber_status keep_passes(camber_renderer *renderer, camber_flight *flight) {
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

static void drop_passes(camber_renderer *renderer, camber_flight *flight) {
    camber_free(renderer->share.device->context, flight->paints);
    camber_free(renderer->share.device->context, flight->passes);
    camber_free(renderer->share.device->context, flight->rgba);
    flight->rgba = NULL;
    flight->paints = NULL;
    flight->passes = NULL;
}

camber_status camber_render_begin(camber_renderer *renderer, const camber_frame *frame) {
    assert(renderer->flight_count < CAMBER_FRAMES_IN_FLIGHT);
    if (renderer->flight_count == 0)
        renderer->first_flight = 0;
    const size_t at = (renderer->first_flight + renderer->flight_count) % CAMBER_FRAMES_IN_FLIGHT;
    camber_flight *flight = renderer->flights + at;
    camber_status status = camber_frame_check(renderer, frame);
    if (status == CAMBER_OK)
        status = renderer->cover ? camber_covered_begin(renderer, frame, flight)
                                 : begin(renderer, frame, targets[at], flight);
    if (status != CAMBER_OK)
        return status;
    if (!has_one_piece(flight))
        status = keep_passes(renderer, flight);
    if (status != CAMBER_OK) {
        drop_fence(renderer, flight);
        drop_passes(renderer, flight);
        return status;
    }
    renderer->flight_count++;
    return CAMBER_OK;
}

camber_status camber_render_end(camber_renderer *renderer, camber_rows_fn *rows, void *user,
                                camber_frame_stats *stats) {
    assert(renderer->flight_count > 0);
    camber_flight *flight = renderer->flights + renderer->first_flight;
    const camber_status status =
        renderer->cover ? camber_covered_end(renderer, flight, rows, user) : end(renderer, flight, rows, user);
    drop_passes(renderer, flight);
    renderer->first_flight = (renderer->first_flight + 1) % CAMBER_FRAMES_IN_FLIGHT;
    renderer->flight_count--;
    if (stats && status == CAMBER_OK)
        *stats = flight->stats;
    return status;
}

void camber_frames_forget(camber_renderer *renderer, bool is_current) {
    for (size_t i = 0; i < CAMBER_FRAMES_IN_FLIGHT; i++) {
        if (is_current)
            drop_fence(renderer, renderer->flights + i);
        drop_passes(renderer, renderer->flights + i);
    }
}
