/* Anti-Grain Geometry: conv_stroke or rings into the scanline rasterizer, every part by itself or all of them in one;
 * by one thread, and by stripes. */
#include "peers/peer.h"

#include <agg_conv_stroke.h>
#include <agg_pixfmt_rgba.h>
#include <agg_rasterizer_scanline_aa.h>
#include <agg_renderer_scanline.h>
#include <agg_rendering_buffer.h>
#include <agg_scanline_u.h>

#include <chrono>

namespace {

/* A polyline where it lies. */
class line_source {
  public:
    line_source(const float *points, std::size_t count) : points_(points), count_(count) {
    }
    void rewind(unsigned) {
        next_ = 0;
    }
    unsigned vertex(double *x, double *y) {
        if (next_ == count_)
            return agg::path_cmd_stop;
        *x = static_cast<double>(points_[2 * next_]);
        *y = static_cast<double>(points_[2 * next_ + 1]);
        return next_++ == 0 ? agg::path_cmd_move_to : agg::path_cmd_line_to;
    }

  private:
    const float *points_;
    std::size_t count_, next_ = 0;
};

using pixels = agg::pixfmt_rgba32;
using rasterizer = agg::rasterizer_scanline_aa<>;

void add_line(rasterizer &cells, const bench_peer_frame &frame, std::size_t polyline) {
    const camber_lines &lines = *frame.lines;
    const std::size_t first = lines.offsets[polyline], end = lines.offsets[polyline + 1];
    if (end - first < 2)
        return;
    line_source source(lines.points + 2 * first, end - first);
    if (frame.areas) {
        cells.add_path(source);
        return;
    }
    agg::conv_stroke<line_source> stroke(source);
    stroke.width(static_cast<double>(frame.width_px));
    stroke.line_join(agg::round_join);
    stroke.line_cap(agg::butt_cap);
    stroke.approximation_scale(0.5); /* arcs may be off by 0.25 px, as the other peers' may: 1 is for half of that */
    cells.add_path(stroke);
}

/* The rows [first, end). */
void draw_rows(const bench_peer_frame &frame, bool one_path, int first, int end) {
    agg::rendering_buffer buffer(frame.rgba, BENCH_SIDE_PX, BENCH_SIDE_PX, 4 * BENCH_SIDE_PX);
    pixels format(buffer);
    agg::renderer_base<pixels> base(format);
    base.clip_box(0, first, BENCH_SIDE_PX - 1, end - 1);
    base.copy_bar(0, first, BENCH_SIDE_PX - 1, end - 1, agg::rgba8(255, 255, 255));
    rasterizer cells(one_path ? 65536 : 1024); /* blocks of cells: all lines at once take more than its usual limit */
    cells.clip_box(0, first, BENCH_SIDE_PX, end);
    agg::scanline_u8 scanline;
    for (std::size_t i = 0; i < bench_peer_part_count(&frame); i++) {
        for (std::size_t k = bench_peer_first_of(&frame, i); k < bench_peer_first_of(&frame, i + 1); k++)
            add_line(cells, frame, k);
        if (!one_path)
            agg::render_scanlines_aa_solid(cells, scanline, base, agg::rgba8(0, 0, 0));
    }
    if (one_path)
        agg::render_scanlines_aa_solid(cells, scanline, base, agg::rgba8(0, 0, 0));
}

double draw(const bench_peer_frame *frame, bool one_path) {
    const auto begin = std::chrono::steady_clock::now();
    draw_rows(*frame, one_path, 0, BENCH_SIDE_PX);
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

double draw_lines(const bench_peer_frame *frame) {
    return draw(frame, false);
}

double draw_path(const bench_peer_frame *frame) {
    return draw(frame, true);
}

template <bool one_path> bool draw_stripe(void *user, std::size_t part) {
    draw_rows(*static_cast<const bench_peer_frame *>(user), one_path, bench_stripe_first_row(part),
              bench_stripe_first_row(part + 1));
    return true;
}

template <bool one_path> double draw_stripes(const bench_peer_frame *frame) {
    bench_peer_frame copy = *frame;
    return bench_stripes_draw(draw_stripe<one_path>, &copy);
}

const char *version() {
    return CAMBER_BENCH_AGG;
}

const char *build() {
    return CAMBER_BENCH_BUILD;
}

} // namespace

extern "C" {
const bench_peer bench_peer_agg = {"agg", "AGG", "one thread, a line at a time", version, build, draw_lines};
const bench_peer bench_peer_agg_path = {"agg_path", "AGG", "one thread, one path", version, build, draw_path};
const bench_peer bench_peer_agg_stripes = {"agg_stripes", "AGG", "a stripe per thread, a line at a time",
                                           version,       build, draw_stripes<false>};
const bench_peer bench_peer_agg_stripes_path = {
    "agg_stripes_path", "AGG", "a stripe per thread, one path", version, build, draw_stripes<true>};
}
