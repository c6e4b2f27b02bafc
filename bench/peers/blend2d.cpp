/* Blend2D: every polyline stroked by itself, or all of them as one path; by one thread, and by as many as there are. */
#include "peers/peer.h"

#include <blend2d/blend2d.h>

#include <chrono>
#include <cstdio>
#include <thread>

namespace {

/* Round joins are flattened as coarsely as the other peers' are. */
constexpr double tolerance_px = 0.25;

void add_line(BLPath &path, const camber_lines &lines, std::size_t polyline) {
    const std::size_t first = lines.offsets[polyline], end = lines.offsets[polyline + 1];
    if (end - first < 2)
        return;
    path.move_to(static_cast<double>(lines.points[2 * first]), static_cast<double>(lines.points[2 * first + 1]));
    for (std::size_t k = first + 1; k < end; k++)
        path.line_to(static_cast<double>(lines.points[2 * k]), static_cast<double>(lines.points[2 * k + 1]));
}

BLResult stroke_all(BLContext &context, const camber_lines &lines, bool one_path) {
    BLPath path;
    BLResult result = BL_SUCCESS;
    for (std::size_t i = 0; i < lines.polyline_count && result == BL_SUCCESS; i++) {
        add_line(path, lines, i);
        if (one_path)
            continue;
        result = context.stroke_path(path, BLRgba32(0xff000000u));
        path.clear();
    }
    return one_path ? context.stroke_path(path, BLRgba32(0xff000000u)) : result;
}

/* threads: 0 draws at once. */
double draw(const camber_lines *lines, float width_px, uint8_t *rgba, unsigned threads, bool one_path) {
    BLImage image;
    BLContextCreateInfo info{};
    info.thread_count = threads;
    if (image.create_from_data(BENCH_SIDE_PX, BENCH_SIDE_PX, BL_FORMAT_PRGB32, rgba, 4 * BENCH_SIDE_PX) != BL_SUCCESS)
        return -1;
    const auto begin = std::chrono::steady_clock::now();
    BLContext context;
    BLResult result = context.begin(image, info);
    if (result != BL_SUCCESS)
        return -1;
    context.fill_all(BLRgba32(0xffffffffu));
    context.set_stroke_width(static_cast<double>(width_px));
    context.set_stroke_join(BL_STROKE_JOIN_ROUND);
    context.set_stroke_caps(BL_STROKE_CAP_BUTT);
    context.set_flatten_tolerance(tolerance_px);
    result = stroke_all(context, *lines, one_path);
    context.end();
    const auto end = std::chrono::steady_clock::now();
    return result == BL_SUCCESS ? std::chrono::duration<double, std::milli>(end - begin).count() : -1;
}

double draw_lines(const camber_lines *lines, float width_px, uint8_t *rgba) {
    return draw(lines, width_px, rgba, 0, false);
}

double draw_path(const camber_lines *lines, float width_px, uint8_t *rgba) {
    return draw(lines, width_px, rgba, 0, true);
}

double draw_threads(const camber_lines *lines, float width_px, uint8_t *rgba) {
    return draw(lines, width_px, rgba, std::thread::hardware_concurrency(), false);
}

const char *version() {
    static char text[32];
    BLRuntimeBuildInfo info;
    BLRuntime::query_build_info(&info);
    std::snprintf(text, sizeof text, "%u.%u.%u", info.major_version, info.minor_version, info.patch_version);
    return text;
}

} // namespace

extern "C" {
const bench_peer bench_peer_blend2d = {"blend2d", "Blend2D", version, draw_lines};
const bench_peer bench_peer_blend2d_path = {"blend2d_path", "Blend2D, one path", version, draw_path};
const bench_peer bench_peer_blend2d_threads = {"blend2dthreads", "Blend2D, threads", version, draw_threads};
}
