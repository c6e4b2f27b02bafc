/* The polyline interchange file: parsed, written back, simplified, cleaned and tessellated. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD_BYTES = 12 };

static bool same_point(const float *a, const float *b) {
    return memcmp(a, b, 2 * sizeof *a) == 0;
}

static bool is_drawn(const float *p) {
    return fabsf(p[0]) <= 1e9f && fabsf(p[1]) <= 1e9f;
}

static double distance_from(const float *p, const float *a, const float *b) {
    const double dx = (double)b[0] - (double)a[0], dy = (double)b[1] - (double)a[1];
    const double px = (double)p[0] - (double)a[0], py = (double)p[1] - (double)a[1];
    const double squared = dx * dx + dy * dy;
    const double t = squared > 0 ? fmin(fmax((px * dx + py * dy) / squared, 0), 1) : 0;
    return hypot(px - t * dx, py - t * dy);
}

static bool is_near_line(const float *p, const float *kept, size_t count, double distance_px) {
    bool near = false;
    for (size_t i = 1; i < count && !near; i++)
        near = distance_from(p, kept + 2 * i - 2, kept + 2 * i) <= distance_px;
    return near;
}

/* Ends stay, what stays is a part of what was, in order, and what goes lay within the tolerance of the rest. */
static void check_simplified(const camber_lines *from, const camber_lines *to, double tolerance_px) {
    REQUIRE(from->polyline_count == to->polyline_count && to->point_count <= from->point_count);
    fuzz_check_lines(to);
    for (size_t line = 0; line < from->polyline_count; line++) {
        const float *kept = to->points + 2 * (size_t)to->offsets[line];
        const size_t count = to->offsets[line + 1] - to->offsets[line];
        const uint32_t first = from->offsets[line], past = from->offsets[line + 1];
        size_t next = 0;
        REQUIRE((first == past) == (count == 0));
        for (uint32_t i = first; i < past; i++) {
            const float *point = from->points + 2 * (size_t)i;
            /* The last of equal points is left to the end. */
            if (next < count && same_point(point, kept + 2 * next) && (next + 1 < count || i + 1 == past)) {
                next++;
                continue;
            }
            REQUIRE(i > first && i + 1 < past && is_drawn(point));
            const double slack = 1e-6 + 1e-6 * (fabs((double)point[0]) + fabs((double)point[1]));
            REQUIRE(is_near_line(point, kept, count, tolerance_px + slack));
        }
        REQUIRE(next == count);
    }
}

static void use_lines(fuzz_run *run, const camber_lines *lines, bool keep_open) {
    const camber_polylines_desc desc = {.points = lines->points,
                                        .point_count = lines->point_count,
                                        .offsets = lines->offsets,
                                        .polyline_count = lines->polyline_count,
                                        .keep_open = keep_open};
    const camber_stroke stroke = {(float)(run->hash >> 8 & 63), (camber_join)(run->hash % 3),
                                  (camber_cap)(run->hash / 3 % 3), (float)(run->hash >> 16 & 7)};
    camber_polylines *polylines = NULL;
    if (!fuzz_done(run, camber_polylines_create(run->context, &desc, &polylines)))
        return;
    for (int method = 0; method < 3; method++) {
        const camber_tessellation_desc tessellation = {&stroke, 1, (camber_method)method, 0, false};
        fuzz_tessellate(run, polylines, &tessellation, NULL);
    }
    camber_polylines_destroy(polylines);
}

static void use_file(fuzz_run *run, const uint8_t *bytes, size_t size) {
    static const double tolerances_px[] = {0.0, 0.1, 3.0, 1e12};
    camber_lines lines = {0}, simplified = {0};
    if (!fuzz_done(run, camber_lines_parse(run->context, bytes, size, "fuzzed", &lines)))
        return;
    fuzz_check_lines(&lines);
    fuzz_bytes written = {0};
    if (fuzz_done(run, camber_lines_write(run->context, &lines, fuzz_sink(&written))))
        REQUIRE(written.size == size && memcmp(written.bytes, bytes, size) == 0);
    free(written.bytes);
    const double tolerance_px = tolerances_px[run->hash % 4];
    if (fuzz_done(run, camber_lines_simplify(run->context, &lines, tolerance_px, &simplified))) {
        check_simplified(&lines, &simplified, tolerance_px);
        use_lines(run, &simplified, false);
        camber_lines_destroy(&simplified);
    }
    use_lines(run, &lines, run->hash & 16);
    camber_lines_destroy(&lines);
}

static uint32_t get_u32(const uint8_t *bytes) {
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void put_u32(uint8_t *bytes, uint32_t value) {
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(value >> 8 * i);
}

/* A mutation seldom fits its head: this makes the counts those of the bytes and lets the offsets ascend. The size that
 * is left. */
static size_t repair(uint8_t *bytes, size_t size) {
    const uint32_t n = size < HEAD_BYTES + 4 ? 0 : (uint32_t)(get_u32(bytes + 4) % ((size - HEAD_BYTES) / 4));
    const uint32_t p = (uint32_t)((size - HEAD_BYTES - 4 * ((size_t)n + 1)) / 8);
    put_u32(bytes, 0x4c594c50);
    put_u32(bytes + 4, n);
    put_u32(bytes + 8, p);
    uint32_t before = 0;
    for (uint32_t i = 0; i <= n; i++) {
        uint8_t *at = bytes + HEAD_BYTES + 4 * (size_t)i;
        const uint32_t room = p - before;
        before += i == 0 ? 0 : i == n ? room : get_u32(at) % (room / (n - i) + 2) % (room + 1);
        put_u32(at, before);
    }
    if (n == 0 && p > 0)
        put_u32(bytes + 8, 0);
    return HEAD_BYTES + 4 * ((size_t)n + 1) + (n ? 8 * (size_t)p : 0);
}

static void use_repaired(fuzz_run *run, const uint8_t *bytes, size_t size) {
    uint8_t *copy = malloc(size);
    REQUIRE(copy);
    memcpy(copy, bytes, size);
    use_file(run, copy, repair(copy, size));
    free(copy);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use_file);
    if (size >= HEAD_BYTES + 4)
        fuzz_each(bytes, size, use_repaired);
    return 0;
}
