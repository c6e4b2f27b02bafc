/* Cairo's image surface: every polyline stroked or every area filled by itself, or all of them as one path, which gives
 * their true union. */
#include "peers/peer.h"

#include "base/base.h"

#include <cairo.h>

static const char *version(void) {
    return cairo_version_string();
}

static const char *build(void) {
    return CAMBER_BENCH_CAIRO;
}

static void add_line(cairo_t *cairo, const camber_lines *lines, size_t polyline) {
    const size_t first = lines->offsets[polyline], end = lines->offsets[polyline + 1];
    if (end - first < 2)
        return;
    cairo_move_to(cairo, (double)lines->points[2 * first], (double)lines->points[2 * first + 1]);
    for (size_t k = first + 1; k < end; k++)
        cairo_line_to(cairo, (double)lines->points[2 * k], (double)lines->points[2 * k + 1]);
}

static double draw(const bench_peer_frame *frame, bool one_path) {
    cairo_surface_t *surface = cairo_image_surface_create_for_data(frame->rgba, CAIRO_FORMAT_RGB24, BENCH_SIDE_PX,
                                                                   BENCH_SIDE_PX, 4 * BENCH_SIDE_PX);
    cairo_t *cairo = cairo_create(surface);
    const double begin = camber_now_ms();
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_set_source_rgb(cairo, 0, 0, 0);
    cairo_set_line_width(cairo, (double)frame->width_px);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_tolerance(cairo, 0.25);
    void (*const put)(cairo_t *) = frame->areas ? cairo_fill : cairo_stroke;
    for (size_t i = 0; i < bench_peer_part_count(frame); i++) {
        for (size_t k = bench_peer_first_of(frame, i); k < bench_peer_first_of(frame, i + 1); k++)
            add_line(cairo, frame->lines, k);
        if (!one_path)
            put(cairo);
    }
    put(cairo);
    cairo_surface_flush(surface);
    const double ms = camber_now_ms() - begin;
    const bool done = cairo_status(cairo) == CAIRO_STATUS_SUCCESS;
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    return done ? ms : -1;
}

static double draw_lines(const bench_peer_frame *frame) {
    return draw(frame, false);
}

static double draw_path(const bench_peer_frame *frame) {
    return draw(frame, true);
}

const bench_peer bench_peer_cairo = {"cairo", "Cairo", "a line at a time", version, build, draw_lines};
const bench_peer bench_peer_cairo_path = {"cairo_path", "Cairo", "one path", version, build, draw_path};
