#include "bench.h"

#include "base/base.h"

#ifdef CAMBER_BENCH_CAIRO

#include <cairo.h>

const char *bench_cairo_version(void) {
    return cairo_version_string();
}

static void stroke_lines(cairo_t *cairo, const camber_lines *lines) {
    for (size_t i = 0; i < lines->polyline_count; i++) {
        const size_t first = lines->offsets[i], end = lines->offsets[i + 1];
        if (end - first < 2)
            continue;
        cairo_move_to(cairo, (double)lines->points[2 * first], (double)lines->points[2 * first + 1]);
        for (size_t k = first + 1; k < end; k++)
            cairo_line_to(cairo, (double)lines->points[2 * k], (double)lines->points[2 * k + 1]);
        cairo_stroke(cairo);
    }
}

double bench_cairo_ms(const bench_scene *scene) {
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, BENCH_SIDE_PX, BENCH_SIDE_PX);
    cairo_t *cairo = cairo_create(surface);
    const double begin = camber_now_ms();
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    cairo_set_source_rgb(cairo, 0, 0, 0);
    cairo_set_line_width(cairo, (double)scene->width_px);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_tolerance(cairo, 0.25);
    stroke_lines(cairo, &scene->lines);
    cairo_surface_flush(surface);
    const double ms = camber_now_ms() - begin;
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    return ms;
}

#else

const char *bench_cairo_version(void) {
    return NULL;
}

double bench_cairo_ms(const bench_scene *scene) {
    (void)scene;
    return -1;
}

#endif
