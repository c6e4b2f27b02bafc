/* Draws a frame and writes it. A large PNG is written row by row as it is drawn, so a picture of any size fits in
 * memory. Other formats need the whole picture in memory, and small pictures are drawn there in place. */
#include "cli/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SMALL_PX = 1 << 22 };
typedef struct writer {
    camber_report *report;
    camber_context *context;
    camber_output *output;
    uint32_t width, height;
    /* png or encoder is used, the other is NULL */
    camber_png *png;
    camber_encoder *encoder;
    uint8_t *rgba; /* the picture for the encoder */
    double write_ms;
    camber_status status; /* status of the first write that failed */
} writer;

static bool is_small(const writer *w) {
    return (uint64_t)w->width * w->height <= SMALL_PX;
}

static camber_status keep_rows(writer *w, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    const size_t row_bytes = 4 * (size_t)w->width;
    memcpy(w->rgba + row_bytes * first_row, rgba, row_bytes * row_count);
    return CAMBER_OK;
}

static bool write_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    writer *w = user;
    const double start_ms = camber_now_ms();
    w->status = w->png ? camber_png_write_rows(w->png, rgba, row_count) : keep_rows(w, rgba, first_row, row_count);
    w->write_ms += camber_now_ms() - start_ms;
    camber_report_step(w->report, "writing", "rows", first_row + row_count, w->height);
    /* When a write has failed, drawing stops with an error. It is not reported, because the failed write has been. */
    w->report->sealed = w->status != CAMBER_OK;
    return w->status == CAMBER_OK;
}

/* Returns the px per inch that a PNG tells. Without --dpi a CSS px is 1/96 inch, as in a PDF of the same picture. */
static double dots_per_inch(const camber_options *options) {
    return isnan(options->dpi) ? CAMBER_CSS_PX_PER_INCH * options->view.ratio : options->dpi;
}

static camber_status begin(writer *w, const camber_options *options, bool opaque, const char *attribution) {
    char software[64];
    snprintf(software, sizeof software, "camber %s", camber_version());
    const camber_png_text texts[] = {{"Software", software}, {"Copyright", attribution}};
    const size_t text_count = attribution ? 2 : 1;
    if (options->format == CAMBER_FORMAT_PNG && !is_small(w)) {
        const camber_png_desc desc = {.width = w->width,
                                      .height = w->height,
                                      .opaque = opaque,
                                      .texts = texts,
                                      .text_count = text_count,
                                      .dpi = dots_per_inch(options)};
        return camber_png_create(w->context, &desc, camber_output_sink(w->output), &w->png);
    }
    const camber_encoder_desc desc = {.encoding = camber_format_encoding(options->format),
                                      .opaque = opaque,
                                      .quality = (int)options->quality,
                                      .texts = texts,
                                      .text_count = text_count,
                                      .dpi = dots_per_inch(options)};
    const size_t bytes = 4 * (size_t)w->width * w->height, rest = bytes % CAMBER_PIXELS_ALIGNMENT;
    w->rgba = aligned_alloc(CAMBER_PIXELS_ALIGNMENT, rest ? bytes + CAMBER_PIXELS_ALIGNMENT - rest : bytes);
    return w->rgba ? camber_encoder_create(w->context, &desc, &w->encoder) : CAMBER_ERROR_MEMORY;
}

static camber_status finish(writer *w) {
    if (w->png)
        return camber_png_finish(w->png);
    const camber_pixels pixels = {.rgba = w->rgba, .width = w->width, .height = w->height};
    const camber_sink sink = camber_output_sink(w->output);
    const uint8_t *bytes = NULL;
    size_t size_bytes = 0;
    const camber_status status = camber_encoder_encode(w->encoder, &pixels, &bytes, &size_bytes);
    if (status != CAMBER_OK)
        return status;
    return sink.write(sink.user, bytes, size_bytes) ? CAMBER_OK : CAMBER_ERROR_IO;
}

static void end(writer *w) {
    camber_png_destroy(w->png);
    camber_encoder_destroy(w->encoder);
    free(w->rgba);
}

/* ---- Sheets ---- */

#ifdef CAMBER_MAP
static bool has_page(const camber_input *input) {
    return input->page != NULL;
}

static camber_page_info info_of(const camber_input *input) {
    return camber_page_get_info(input->page);
}

static camber_status render_page(camber_input *input, camber_mesh *mesh, writer *w, camber_frame_stats *stats) {
    return camber_page_render(input->page, input->scene, input->session->renderer, mesh, write_rows, w, stats);
}

int camber_picture_write_page(camber_input *input, camber_mesh *mesh, camber_output *output,
                              camber_picture_times *times) {
    camber_session *session = input->session;
    const double start_ms = camber_now_ms();
    const camber_page_format format = session->options->format == CAMBER_FORMAT_SVG ? CAMBER_PAGE_SVG : CAMBER_PAGE_PDF;
    const camber_status status =
        camber_page_write(input->page, input->scene, session->renderer, mesh, format, camber_output_sink(output));
    const int exit_status = status == CAMBER_OK ? camber_output_publish(output) : camber_output_status(output, status);
    times->write_ms = camber_now_ms() - start_ms;
    camber_report_erase_bar(session->report);
    return exit_status;
}
#else
/* Polylines in pixels are not drawn on sheets. */
static bool has_page(const camber_input *input) {
    (void)input;
    return false;
}

static camber_page_info info_of(const camber_input *input) {
    (void)input;
    return (camber_page_info){0};
}

static camber_status render_page(camber_input *input, camber_mesh *mesh, writer *w, camber_frame_stats *stats) {
    (void)input;
    (void)mesh;
    (void)w;
    (void)stats;
    return CAMBER_ERROR_ARGUMENT;
}
#endif

/* Small pictures by one call, without rows that are copied. */
static camber_status render_frame(camber_input *input, const camber_frame *frame, writer *w,
                                  camber_frame_stats *stats) {
    camber_renderer *renderer = input->session->renderer;
    return is_small(w) ? camber_renderer_render_into(renderer, frame, w->rgba, 0, stats)
                       : camber_renderer_render(renderer, frame, write_rows, w, stats);
}

int camber_picture_write(camber_input *input, camber_mesh *mesh, camber_output *output, camber_picture_times *times) {
    camber_session *session = input->session;
    const camber_frame frame = camber_input_frame(input, mesh);
    const bool on_sheet = has_page(input);
    const camber_page_info sheet = on_sheet ? info_of(input) : (camber_page_info){0};
    camber_picture_times none;
    if (!times)
        times = &none;
    writer w = {.report = session->report,
                .context = session->context,
                .output = output,
                .width = on_sheet ? sheet.width : frame.width,
                .height = on_sheet ? sheet.height : frame.height,
                .status = CAMBER_OK};
    const double start_ms = camber_now_ms();
    camber_status status = begin(&w, session->options, on_sheet || camber_input_opaque(input), input->attribution);
    w.write_ms = camber_now_ms() - start_ms;
    if (status == CAMBER_OK)
        status =
            on_sheet ? render_page(input, mesh, &w, &times->frame) : render_frame(input, &frame, &w, &times->frame);
    if (w.status != CAMBER_OK)
        status = w.status;
    const double finish_ms = camber_now_ms();
    camber_renderer_trim(session->renderer); /* this frame is the last, and compressing takes memory too */
    if (status == CAMBER_OK)
        status = finish(&w);
    end(&w);
    int exit_status = CAMBER_EXIT_DONE;
    if (status != CAMBER_OK)
        exit_status = camber_output_status(output, status);
    else
        exit_status = camber_output_publish(output);
    times->write_ms = w.write_ms + camber_now_ms() - finish_ms;
    camber_report_erase_bar(session->report);
    return exit_status;
}
