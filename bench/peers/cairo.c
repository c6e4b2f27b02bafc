/* Cairo's image surface: every polyline stroked by itself, or all of them as one path, which gives their true union. */
#include "peers/peer.h"

#include "base/base.h"

#include <cairo.h>

static const char *version(void) {
    return cairo_version_string();
}

static void add_line(cairo_t *cairo, const camber_lines *lines, size_t polyline) {
    const size_t first = lines->offsets[polyline], end = lines->offsets[polyline + 1];
    if (end - first < 2)
        return;
    cairo_move_to(cairo, (double)lines->points[2 * first], (double)lines->points[2 * first + 1]);
    for (size_t k = first + 1; k < end; k++)
        cairo_line_to(cairo, (double)lines->points[2 * k], (double)lines->points[2 * k + 1]);
}

static double draw(const camber_lines *lines, float width_px, uint8_t *rgba, bool one_path) {
    cairo_surface_t *surface =
        cairo_image_surface_create_for_data(rgba, CAIRO_FORMAT_RGB24, BENCH_SIDE_PX, BENCH_SIDE_PX, 4 * BENCH_SIDE_PX);
    cairo_t *cairo = cairo_create(surface);
    const double begin = camber_now_ms();
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_set_source_rgb(cairo, 0, 0, 0);
    cairo_set_line_width(cairo, (double)width_px);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_tolerance(cairo, 0.25);
    for (size_t i = 0; i < lines->polyline_count; i++) {
        add_line(cairo, lines, i);
        if (!one_path)
            cairo_stroke(cairo);
    }
    cairo_stroke(cairo);
    cairo_surface_flush(surface);
    const double ms = camber_now_ms() - begin;
    const bool done = cairo_status(cairo) == CAIRO_STATUS_SUCCESS;
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    return done ? ms : -1;
}

static double draw_lines(const camber_lines *lines, float width_px, uint8_t *rgba) {
    return draw(lines, width_px, rgba, false);
}

static double draw_path(const camber_lines *lines, float width_px, uint8_t *rgba) {
    return draw(lines, width_px, rgba, true);
}

const bench_peer bench_peer_cairo = {"cairo", "Cairo", version, draw_lines};
const bench_peer bench_peer_cairo_path = {"cairo_path", "Cairo, one path", version, draw_path};
