/* Blend2D: every polyline stroked or every area filled by itself, or all of them as one path; by one thread, by
 * Blend2D's own threads, and by threads of the program, each of which draws a stripe of the picture. Contexts are kept
 * from frame to frame, as camber keeps its renderer; paths are made again in the memory of the frame before, as
 * camber's mesh is, or kept, too. */
#include "peers/peer.h"

#include <blend2d/blend2d.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

namespace {

/* Round joins are flattened as coarsely as the other peers' are. */
constexpr double tolerance_px = 0.25;

/* Each of these without those before it would be no processor. */
constexpr uint32_t up_to_avx2 = BL_RUNTIME_CPU_FEATURE_X86_SSE2 | BL_RUNTIME_CPU_FEATURE_X86_SSE3 |
                                BL_RUNTIME_CPU_FEATURE_X86_SSSE3 | BL_RUNTIME_CPU_FEATURE_X86_SSE4_1 |
                                BL_RUNTIME_CPU_FEATURE_X86_SSE4_2 | BL_RUNTIME_CPU_FEATURE_X86_AVX |
                                BL_RUNTIME_CPU_FEATURE_X86_AVX2;

void add_line(BLPath &path, const camber_lines &lines, std::size_t polyline) {
    const std::size_t first = lines.offsets[polyline], end = lines.offsets[polyline + 1];
    if (end - first < 2)
        return;
    path.move_to(static_cast<double>(lines.points[2 * first]), static_cast<double>(lines.points[2 * first + 1]));
    for (std::size_t k = first + 1; k < end; k++)
        path.line_to(static_cast<double>(lines.points[2 * k]), static_cast<double>(lines.points[2 * k + 1]));
}

BLResult put(BLContext &context, const BLPath &path, bool area) {
    const BLRgba32 black(0xff000000u);
    return area ? context.fill_path(path, black) : context.stroke_path(path, black);
}

void set_stroke(BLContext &context, float width_px) {
    context.set_stroke_width(static_cast<double>(width_px));
    context.set_stroke_join(BL_STROKE_JOIN_ROUND);
    context.set_stroke_caps(BL_STROKE_CAP_BUTT);
    context.set_flatten_tolerance(tolerance_px);
}

BLContextCreateInfo create_info(const bench_peer_frame &frame, unsigned threads) {
    BLContextCreateInfo info{};
    info.thread_count = threads;
    if (frame.avx2_only) {
        info.flags = BL_CONTEXT_CREATE_FLAG_ISOLATED_JIT_RUNTIME | BL_CONTEXT_CREATE_FLAG_OVERRIDE_CPU_FEATURES;
        info.cpu_features = up_to_avx2;
    }
    return info;
}

/* A way to draw. pool: Blend2D's threads; 0 draws at once. */
struct way {
    bool one_path, keeps_path, stripes;
    unsigned pool;
};

/* What is kept from frame to frame: a picture, a context and a path per stripe. */
class painter {
  public:
    explicit painter(const way &by) : by(by) {
    }

    double draw(const bench_peer_frame &frame) {
        if (!prepare(frame))
            return -1;
        makes_paths = !by.keeps_path || !bench_peer_is_same(&of, &frame);
        of = frame;
        if (by.stripes)
            return bench_stripes_draw(
                [](void *user, std::size_t part) { return static_cast<painter *>(user)->draw_part(part); }, this);
        const auto begin = std::chrono::steady_clock::now();
        const bool done = draw_part(0);
        const auto end = std::chrono::steady_clock::now();
        return done ? std::chrono::duration<double, std::milli>(end - begin).count() : -1;
    }

  private:
    struct stripe {
        int first_row;
        BLImage image;
        BLContext context;
        BLPath path;
    };

    const way by;
    std::vector<stripe> parts;
    bool makes_paths = true;
    bench_peer_frame of{}; /* the frame that is drawn, whose lines the paths have */

    /* Before the clock runs, makes the stripes, unless they are there for this picture. */
    bool prepare(const bench_peer_frame &frame) {
        if (of.rgba == frame.rgba)
            return true;
        parts = std::vector<stripe>(by.stripes ? bench_stripe_count() : 1);
        for (std::size_t i = 0; i < parts.size(); i++) {
            stripe &one = parts[i];
            one.first_row = by.stripes ? bench_stripe_first_row(i) : 0;
            const int end = by.stripes ? bench_stripe_first_row(i + 1) : BENCH_SIDE_PX;
            uint8_t *rows =
                frame.rgba + static_cast<std::size_t>(4 * BENCH_SIDE_PX) * static_cast<std::size_t>(one.first_row);
            if (one.image.create_from_data(BENCH_SIDE_PX, end - one.first_row, BL_FORMAT_PRGB32, rows,
                                           4 * BENCH_SIDE_PX) != BL_SUCCESS ||
                one.context.begin(one.image, create_info(frame, by.pool)) != BL_SUCCESS || !compile(one, frame))
                return false;
        }
        return true;
    }

    /* A context that may not use all of the processor compiles its code by itself, and keeps it for no other context:
     * it does so before the clock runs, over a picture that is then drawn over. */
    bool compile(stripe &one, const bench_peer_frame &frame) const {
        float points[] = {8, 8, 200, 300, 700, 100};
        uint32_t offsets[] = {0, 3};
        const uint32_t area[] = {0, 1};
        camber_lines line{};
        line.points = points;
        line.offsets = offsets;
        line.point_count = 3;
        line.polyline_count = 1;
        bench_peer_frame small = frame;
        small.lines = &line;
        small.area_count = 1;
        bool done = true;
        for (const uint32_t *areas : {static_cast<const uint32_t *>(nullptr), static_cast<const uint32_t *>(area)}) {
            small.areas = areas;
            done = done && draw_lines(one, small, true) == BL_SUCCESS;
        }
        return done;
    }

    BLResult draw_lines(stripe &one, const bench_peer_frame &frame, bool makes_path) const {
        one.context.reset_transform();
        one.context.translate(0, -one.first_row);
        one.context.fill_all(BLRgba32(0xffffffffu));
        set_stroke(one.context, frame.width_px);
        one.context.set_fill_rule(BL_FILL_RULE_NON_ZERO);
        if (makes_path)
            one.path.clear();
        BLResult result = BL_SUCCESS;
        for (std::size_t i = 0; makes_path && i < bench_peer_part_count(&frame) && result == BL_SUCCESS; i++) {
            for (std::size_t k = bench_peer_first_of(&frame, i); k < bench_peer_first_of(&frame, i + 1); k++)
                add_line(one.path, *frame.lines, k);
            if (by.one_path)
                continue;
            result = put(one.context, one.path, frame.areas != nullptr);
            one.path.clear();
        }
        if (by.one_path && result == BL_SUCCESS)
            result = put(one.context, one.path, frame.areas != nullptr);
        return result == BL_SUCCESS ? one.context.flush(BL_CONTEXT_FLUSH_SYNC) : result;
    }

    bool draw_part(std::size_t part) {
        return draw_lines(parts[part], of, makes_paths) == BL_SUCCESS;
    }
};

double draw_lines(const bench_peer_frame *frame) {
    static painter kept({false, false, false, 0});
    return kept.draw(*frame);
}

double draw_path(const bench_peer_frame *frame) {
    static painter kept({true, false, false, 0});
    return kept.draw(*frame);
}

double draw_threads(const bench_peer_frame *frame) {
    static painter kept({false, false, false, static_cast<unsigned>(bench_stripe_count())});
    return kept.draw(*frame);
}

double draw_threads_path(const bench_peer_frame *frame) {
    static painter kept({true, false, false, static_cast<unsigned>(bench_stripe_count())});
    return kept.draw(*frame);
}

double draw_stripes(const bench_peer_frame *frame) {
    static painter kept({false, false, true, 0});
    return kept.draw(*frame);
}

double draw_stripes_path(const bench_peer_frame *frame) {
    static painter kept({true, false, true, 0});
    return kept.draw(*frame);
}

double draw_stripes_kept(const bench_peer_frame *frame) {
    static painter kept({true, true, true, 0});
    return kept.draw(*frame);
}

const char *version() {
    static char text[32];
    BLRuntimeBuildInfo info;
    BLRuntime::query_build_info(&info);
    std::snprintf(text, sizeof text, "%u.%u.%u", info.major_version, info.minor_version, info.patch_version);
    return text;
}

const char *build() {
    static std::string text;
    BLRuntimeBuildInfo info;
    BLRuntime::query_build_info(&info);
    text = (*CAMBER_BENCH_BUILD ? CAMBER_BENCH_BUILD : info.compiler_info) + std::string(", JIT");
    return text.c_str();
}

} // namespace

extern "C" {
const bench_peer bench_peer_blend2d = {"blend2d", "Blend2D", "one thread, a line at a time",
                                       version,   build,     draw_lines};
const bench_peer bench_peer_blend2d_path = {"blend2d_path", "Blend2D", "one thread, one path",
                                            version,        build,     draw_path};
const bench_peer bench_peer_blend2d_threads = {"blend2d_threads", "Blend2D", "its threads, a line at a time",
                                               version,           build,     draw_threads};
const bench_peer bench_peer_blend2d_threads_path = {
    "blend2d_threads_path", "Blend2D", "its threads, one path", version, build, draw_threads_path};
const bench_peer bench_peer_blend2d_stripes = {"blend2d_stripes", "Blend2D", "a stripe per thread, a line at a time",
                                               version,           build,     draw_stripes};
const bench_peer bench_peer_blend2d_stripes_path = {
    "blend2d_stripes_path", "Blend2D", "a stripe per thread, one path", version, build, draw_stripes_path};
const bench_peer bench_peer_blend2d_stripes_kept = {
    "blend2d_stripes_kept", "Blend2D", "a stripe per thread, one path, kept", version, build, draw_stripes_kept};
}
