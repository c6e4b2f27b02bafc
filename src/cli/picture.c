#include "cli/picture.h"

typedef struct writer {
    camber_report *report;
    camber_png *png;
    uint32_t height;
    double write_ms;
    camber_status status; /* of the first write that failed */
} writer;

static bool write_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    writer *w = user;
    const double start_ms = camber_clock_ms();
    w->status = camber_png_write_rows(w->png, rgba, row_count);
    w->write_ms += camber_clock_ms() - start_ms;
    camber_report_progress(w->report, "writing", (double)(first_row + row_count) / w->height);
    /* The error that the drawing stops is not reported: the failed write has been. */
    w->report->sealed = w->status != CAMBER_OK;
    return w->status == CAMBER_OK;
}

int camber_picture_write(camber_input *input, camber_mesh *mesh, camber_output *output, camber_picture_times *times) {
    camber_session *session = input->session;
    const camber_frame frame = camber_input_frame(input, mesh);
    char software[64];
    snprintf(software, sizeof software, "camber %s", camber_version());
    const camber_png_text texts[] = {{"Software", software}, {"Copyright", input->attribution}};
    const camber_png_desc desc = {.width = frame.width,
                                  .height = frame.height,
                                  .opaque = camber_input_opaque(input),
                                  .texts = texts,
                                  .text_count = input->attribution ? 2 : 1};
    camber_picture_times none;
    if (!times)
        times = &none;
    writer w = {.report = session->report, .height = frame.height, .status = CAMBER_OK};
    const double start_ms = camber_clock_ms();
    camber_status status = camber_png_create(session->context, &desc, camber_output_sink(output), &w.png);
    w.write_ms = camber_clock_ms() - start_ms;
    if (status == CAMBER_OK)
        status = camber_renderer_render(session->renderer, &frame, write_rows, &w, &times->frame);
    if (w.status != CAMBER_OK)
        status = w.status;
    const double finish_ms = camber_clock_ms();
    if (status == CAMBER_OK)
        status = camber_png_finish(w.png);
    camber_png_destroy(w.png);
    int exit_status = CAMBER_EXIT_DONE;
    if (status != CAMBER_OK)
        exit_status = camber_output_status(output, status);
    else
        exit_status = camber_output_publish(output);
    times->write_ms = w.write_ms + camber_clock_ms() - finish_ms;
    camber_report_erase_bar(session->report);
    return exit_status;
}
