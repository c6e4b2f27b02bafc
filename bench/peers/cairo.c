/* Cairo's image surface: every polyline stroked or every area filled by itself, or all of them as one path, which gives
 * their true union; by one thread, and by stripes, with a surface and a path for each. */
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

static void put_all(cairo_t *cairo, const bench_peer_frame *frame, bool one_path) {
    void (*const put)(cairo_t *) = frame->areas ? cairo_fill : cairo_stroke;
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_set_source_rgb(cairo, 0, 0, 0);
    cairo_set_line_width(cairo, (double)frame->width_px);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_tolerance(cairo, 0.25);
    for (size_t i = 0; i < bench_peer_part_count(frame); i++) {
        for (size_t k = bench_peer_first_of(frame, i); k < bench_peer_first_of(frame, i + 1); k++)
            add_line(cairo, frame->lines, k);
        if (!one_path)
            put(cairo);
    }
    put(cairo);
}

static bool draw_rows(const bench_peer_frame *frame, bool one_path, int first, int end) {
    cairo_surface_t *surface =
        cairo_image_surface_create_for_data(frame->rgba + (size_t)4 * BENCH_SIDE_PX * (size_t)first, CAIRO_FORMAT_RGB24,
                                            BENCH_SIDE_PX, end - first, 4 * BENCH_SIDE_PX);
    cairo_surface_set_device_offset(surface, 0, -first);
    cairo_t *cairo = cairo_create(surface);
    put_all(cairo, frame, one_path);
    cairo_surface_flush(surface);
    const bool done = cairo_status(cairo) == CAIRO_STATUS_SUCCESS;
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    return done;
}

static double draw(const bench_peer_frame *frame, bool one_path) {
    const double begin = camber_now_ms();
    return draw_rows(frame, one_path, 0, BENCH_SIDE_PX) ? camber_now_ms() - begin : -1;
}

static double draw_lines(const bench_peer_frame *frame) {
    return draw(frame, false);
}

static double draw_path(const bench_peer_frame *frame) {
    return draw(frame, true);
}

static bool draw_stripe(void *frame, size_t part) {
    return draw_rows(frame, false, bench_stripe_first_row(part), bench_stripe_first_row(part + 1));
}

static bool draw_stripe_path(void *frame, size_t part) {
    return draw_rows(frame, true, bench_stripe_first_row(part), bench_stripe_first_row(part + 1));
}

static double draw_stripes(const bench_peer_frame *frame) {
    bench_peer_frame copy = *frame;
    return bench_stripes_draw(draw_stripe, &copy);
}

static double draw_stripes_path(const bench_peer_frame *frame) {
    bench_peer_frame copy = *frame;
    return bench_stripes_draw(draw_stripe_path, &copy);
}

const bench_peer bench_peer_cairo = {"cairo", "Cairo", "one thread, a line at a time", version, build, draw_lines};
const bench_peer bench_peer_cairo_path = {"cairo_path", "Cairo", "one thread, one path", version, build, draw_path};
const bench_peer bench_peer_cairo_stripes = {"cairo_stripes", "Cairo", "a stripe per thread, a line at a time",
                                             version,         build,   draw_stripes};
const bench_peer bench_peer_cairo_stripes_path = {
    "cairo_stripes_path", "Cairo", "a stripe per thread, one path", version, build, draw_stripes_path};
