/* ThorVG's CPU engine, a shape a polyline or an area: by one thread, and by as many as there are cores: the
 * calling one fills the shapes that the others outline. All polylines in one shape take some 40 times as long, so that
 * way is left out: the cells of a row are a list that is walked for each cell. */
#include "peers/peer.h"

#include <thorvg.h>

#include <chrono>
#include <vector>

namespace {

void add_line(tvg::Shape *shape, const camber_lines &lines, std::size_t polyline) {
    for (std::size_t k = lines.offsets[polyline]; k < lines.offsets[polyline + 1]; k++) {
        const float x = lines.points[2 * k], y = lines.points[2 * k + 1];
        if (k == lines.offsets[polyline])
            shape->moveTo(x, y);
        else
            shape->lineTo(x, y);
    }
}

tvg::Shape *make_shape(const bench_peer_frame &frame, std::size_t part) {
    tvg::Shape *shape = tvg::Shape::gen();
    for (std::size_t k = bench_peer_first_of(&frame, part); k < bench_peer_first_of(&frame, part + 1); k++)
        add_line(shape, *frame.lines, k);
    if (frame.areas) {
        shape->fill(0, 0, 0);
        return shape;
    }
    shape->strokeWidth(frame.width_px);
    shape->strokeFill(0, 0, 0);
    shape->strokeJoin(tvg::StrokeJoin::Round);
    shape->strokeCap(tvg::StrokeCap::Butt);
    return shape;
}

/* A white ground, and the lines or areas over it: the library's own form of them. */
std::vector<tvg::Shape *> make_shapes(const bench_peer_frame &frame) {
    std::vector<tvg::Shape *> shapes{tvg::Shape::gen()};
    shapes[0]->appendRect(0, 0, BENCH_SIDE_PX, BENCH_SIDE_PX);
    shapes[0]->fill(255, 255, 255);
    for (std::size_t i = 0; i < bench_peer_part_count(&frame); i++)
        shapes.push_back(make_shape(frame, i));
    return shapes;
}

/* The canvas takes the shapes. */
bool draw_shapes(tvg::SwCanvas &canvas, const std::vector<tvg::Shape *> &shapes, uint8_t *rgba) {
    bool done = canvas.target(reinterpret_cast<uint32_t *>(rgba), BENCH_SIDE_PX, BENCH_SIDE_PX, BENCH_SIDE_PX,
                              tvg::ColorSpace::ABGR8888) == tvg::Result::Success;
    for (tvg::Shape *shape : shapes)
        done = canvas.add(shape) == tvg::Result::Success && done;
    return done && canvas.draw(true) == tvg::Result::Success && canvas.sync() == tvg::Result::Success;
}

/* threads: those beside the calling one, which are started and ended outside the time that counts. */
double draw(const bench_peer_frame *frame, unsigned threads) {
    if (tvg::Initializer::init(threads) != tvg::Result::Success)
        return -1;
    const std::vector<tvg::Shape *> shapes = make_shapes(*frame);
    const auto begin = std::chrono::steady_clock::now();
    /* None: without what would only draw again the parts of a picture that change. */
    tvg::SwCanvas *canvas = tvg::SwCanvas::gen(tvg::EngineOption::None);
    const bool done = canvas && draw_shapes(*canvas, shapes, frame->rgba);
    const auto end = std::chrono::steady_clock::now();
    delete canvas;
    tvg::Initializer::term();
    return done ? std::chrono::duration<double, std::milli>(end - begin).count() : -1;
}

double draw_alone(const bench_peer_frame *frame) {
    return draw(frame, 0);
}

double draw_threads(const bench_peer_frame *frame) {
    return draw(frame, static_cast<unsigned>(bench_stripe_count()) - 1);
}

const char *version() {
    return CAMBER_BENCH_THORVG;
}

const char *build() {
    return CAMBER_BENCH_BUILD;
}

} // namespace

extern "C" {
const bench_peer bench_peer_thorvg = {"thorvg", "ThorVG", "one thread", version, build, draw_alone};
const bench_peer bench_peer_thorvg_threads = {"thorvg_threads", "ThorVG", "a thread per core",
                                              version,          build,    draw_threads};
}
