/* Blend2D: every polyline stroked or every area filled by itself, or all of them as one path; by one thread, and by as
 * many as there are. These are Blend2D's own threads, or threads of the program, each of which draws a stripe of the
 * picture with a context that is kept from frame to frame. */
#include "peers/peer.h"

#include <blend2d/blend2d.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
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

void add_all(BLPath &path, const bench_peer_frame &frame) {
    for (std::size_t i = 0; i < frame.lines->polyline_count; i++)
        add_line(path, *frame.lines, i);
}

BLResult put_all(BLContext &context, const bench_peer_frame &frame, bool one_path) {
    BLPath path;
    BLResult result = BL_SUCCESS;
    for (std::size_t i = 0; i < bench_peer_part_count(&frame) && result == BL_SUCCESS; i++) {
        for (std::size_t k = bench_peer_first_of(&frame, i); k < bench_peer_first_of(&frame, i + 1); k++)
            add_line(path, *frame.lines, k);
        if (one_path)
            continue;
        result = put(context, path, frame.areas != nullptr);
        path.clear();
    }
    return one_path ? put(context, path, frame.areas != nullptr) : result;
}

void set_stroke(BLContext &context, float width_px) {
    context.set_stroke_width(static_cast<double>(width_px));
    context.set_stroke_join(BL_STROKE_JOIN_ROUND);
    context.set_stroke_caps(BL_STROKE_CAP_BUTT);
    context.set_flatten_tolerance(tolerance_px);
}

BLResult draw_on(BLContext &context, const bench_peer_frame &frame, bool one_path) {
    context.fill_all(BLRgba32(0xffffffffu));
    set_stroke(context, frame.width_px);
    context.set_fill_rule(BL_FILL_RULE_NON_ZERO);
    return put_all(context, frame, one_path);
}

/* A context that may not use all of the processor compiles its code by itself, and keeps it for no other context: it
 * does so before the clock runs, over a picture that is then drawn over. */
BLResult compile(BLContext &context, const bench_peer_frame &frame, bool one_path) {
    float points[] = {8, 8, 200, 300, 700, 100};
    uint32_t offsets[] = {0, 3};
    camber_lines line{};
    line.points = points;
    line.offsets = offsets;
    line.point_count = 3;
    line.polyline_count = 1;
    bench_peer_frame small = frame;
    small.lines = &line;
    const uint32_t area[] = {0, 1};
    small.areas = frame.areas ? area : nullptr;
    small.area_count = 1;
    const BLResult result = draw_on(context, small, one_path);
    return result == BL_SUCCESS ? context.flush(BL_CONTEXT_FLUSH_SYNC) : result;
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

/* threads: 0 draws at once. */
double draw(const bench_peer_frame *frame, unsigned threads, bool one_path) {
    BLImage image;
    BLContext context;
    const BLContextCreateInfo info = create_info(*frame, threads);
    if (image.create_from_data(BENCH_SIDE_PX, BENCH_SIDE_PX, BL_FORMAT_PRGB32, frame->rgba, 4 * BENCH_SIDE_PX) !=
        BL_SUCCESS)
        return -1;
    auto begin = std::chrono::steady_clock::now();
    BLResult result = context.begin(image, info);
    if (result == BL_SUCCESS && frame->avx2_only) {
        result = compile(context, *frame, one_path);
        begin = std::chrono::steady_clock::now();
    }
    if (result == BL_SUCCESS)
        result = draw_on(context, *frame, one_path);
    context.end();
    const auto end = std::chrono::steady_clock::now();
    return result == BL_SUCCESS ? std::chrono::duration<double, std::milli>(end - begin).count() : -1;
}

double draw_lines(const bench_peer_frame *frame) {
    return draw(frame, 0, false);
}

double draw_path(const bench_peer_frame *frame) {
    return draw(frame, 0, true);
}

double draw_threads(const bench_peer_frame *frame) {
    return draw(frame, std::thread::hardware_concurrency(), false);
}

double draw_threads_path(const bench_peer_frame *frame) {
    return draw(frame, std::thread::hardware_concurrency(), true);
}

/* Threads of the program, each with a stripe of the picture, a context, and a path of everything. All of this is kept
 * from frame to frame. The caller draws the first stripe. */
class stripes {
  public:
    ~stripes() {
        {
            const std::lock_guard<std::mutex> hold(lock);
            frames = UINT64_MAX;
        }
        begins.notify_all();
        for (std::thread &thread : threads)
            thread.join();
    }

    /* keeps_paths: paths keep their points for as long as the lines are the same; else each frame makes them again, in
     * the memory of the frame before. */
    double draw(const bench_peer_frame &frame, bool keeps_paths) {
        if (!prepare(frame))
            return -1;
        makes_paths = !keeps_paths || !is_same(frame);
        of = frame;
        point_count = frame.lines->point_count;
        const auto begin = std::chrono::steady_clock::now();
        draw_all();
        const auto end = std::chrono::steady_clock::now();
        for (const stripe &one : parts)
            if (one.result != BL_SUCCESS)
                return -1;
        return std::chrono::duration<double, std::milli>(end - begin).count();
    }

  private:
    struct stripe {
        int first_row;
        BLImage image;
        BLContext context;
        BLPath path;
        BLResult result;
    };

    std::vector<stripe> parts;
    std::vector<std::thread> threads;
    bool makes_paths = true;
    bench_peer_frame of{};       /* the frame that is drawn, whose lines the paths have */
    std::size_t point_count = 0; /* of these lines: others may get the memory of lines that were freed */
    uint8_t *rgba = nullptr;     /* the picture that the contexts draw on */
    std::mutex lock;
    std::condition_variable begins, ends;
    uint64_t frames = 0; /* that have begun; UINT64_MAX: there are no more */
    std::size_t drawing = 0;

    bool is_same(const bench_peer_frame &frame) const {
        return of.lines == frame.lines && of.areas == frame.areas && of.width_px == frame.width_px &&
               point_count == frame.lines->point_count;
    }

    /* Before the clock runs, makes the stripes, unless they are there for this picture. */
    bool prepare(const bench_peer_frame &frame) {
        const int count = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
        if (rgba == frame.rgba)
            return true;
        parts = std::vector<stripe>(static_cast<std::size_t>(count));
        for (int i = 0; i < count; i++) {
            stripe &one = parts[static_cast<std::size_t>(i)];
            one.first_row = BENCH_SIDE_PX * i / count;
            const int rows = BENCH_SIDE_PX * (i + 1) / count - one.first_row;
            one.result = one.image.create_from_data(BENCH_SIDE_PX, rows, BL_FORMAT_PRGB32,
                                                    frame.rgba + static_cast<std::size_t>(4 * BENCH_SIDE_PX) *
                                                                     static_cast<std::size_t>(one.first_row),
                                                    4 * BENCH_SIDE_PX);
            if (one.result == BL_SUCCESS)
                one.result = one.context.begin(one.image, create_info(frame, 0));
            if (one.result == BL_SUCCESS)
                one.result = compile(one.context, frame, true);
            if (one.result != BL_SUCCESS)
                return false;
        }
        for (std::size_t i = threads.size() + 1; i < parts.size(); i++)
            threads.emplace_back([this, i] { work(i); });
        rgba = frame.rgba;
        return true;
    }

    void draw_stripe(stripe &one) const {
        if (makes_paths) {
            one.path.clear();
            add_all(one.path, of);
        }
        one.context.reset_transform();
        one.context.translate(0, -one.first_row);
        one.context.fill_all(BLRgba32(0xffffffffu));
        set_stroke(one.context, of.width_px);
        one.context.set_fill_rule(BL_FILL_RULE_NON_ZERO);
        one.result = put(one.context, one.path, of.areas != nullptr);
        if (one.result == BL_SUCCESS)
            one.result = one.context.flush(BL_CONTEXT_FLUSH_SYNC);
    }

    void draw_all() {
        {
            const std::lock_guard<std::mutex> hold(lock);
            frames++;
            drawing = threads.size();
        }
        begins.notify_all();
        draw_stripe(parts[0]);
        std::unique_lock<std::mutex> hold(lock);
        ends.wait(hold, [this] { return drawing == 0; });
    }

    void work(std::size_t part) {
        for (uint64_t drawn = 0;;) {
            std::unique_lock<std::mutex> hold(lock);
            begins.wait(hold, [&] { return frames != drawn; });
            if (frames == UINT64_MAX)
                return;
            drawn = frames;
            hold.unlock();
            draw_stripe(parts[part]);
            hold.lock();
            if (--drawing == 0)
                ends.notify_one();
        }
    }
};

double draw_stripes(const bench_peer_frame *frame, bool keeps_path) {
    static stripes all;
    return all.draw(*frame, keeps_path);
}

double draw_stripes_path(const bench_peer_frame *frame) {
    return draw_stripes(frame, false);
}

double draw_stripes_kept(const bench_peer_frame *frame) {
    return draw_stripes(frame, true);
}

const char *version() {
    static char text[32];
    BLRuntimeBuildInfo info;
    BLRuntime::query_build_info(&info);
    std::snprintf(text, sizeof text, "%u.%u.%u", info.major_version, info.minor_version, info.patch_version);
    return text;
}

/* Its own CMakeLists.txt has -O2; what fills pixels is made as it runs. */
const char *build() {
    static char text[96];
    BLRuntimeBuildInfo info;
    BLRuntime::query_build_info(&info);
    std::snprintf(text, sizeof text, "%s -O2, JIT", info.compiler_info);
    return text;
}

} // namespace

extern "C" {
const bench_peer bench_peer_blend2d = {"blend2d", "Blend2D", "one thread, a line at a time",
                                       version,   build,     draw_lines};
const bench_peer bench_peer_blend2d_path = {"blend2d_path", "Blend2D", "one thread, one path",
                                            version,        build,     draw_path};
const bench_peer bench_peer_blend2d_threads = {"blend2d_threads", "Blend2D", "threads, a line at a time",
                                               version,           build,     draw_threads};
const bench_peer bench_peer_blend2d_threads_path = {
    "blend2d_threads_path", "Blend2D", "threads, one path", version, build, draw_threads_path};
const bench_peer bench_peer_blend2d_stripes = {"blend2d_stripes", "Blend2D", "a stripe per thread, one path",
                                               version,           build,     draw_stripes_path};
const bench_peer bench_peer_blend2d_stripes_kept = {
    "blend2d_stripes_kept", "Blend2D", "a stripe per thread, one path, kept", version, build, draw_stripes_kept};
}
