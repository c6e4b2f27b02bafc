/* Lines of a picture, cut into a mesh tile.
 *
 *     u8 tile's column | row << 4 | 256 px instead of 512 << 3, f32 reach px, then lines: u8 points % 16 | ring << 4 |
 *     cut at its ends << 5, and two f32 for each point
 *
 * What a device gives is finite, and so is this. */
#include "fuzz.h"

#include "kernels/layout.h"
#include "tiles/mesh_tile.h"

#include <math.h>
#include <string.h>

enum { POINTS_MOST = 256, LINES_MOST = 32 };

typedef struct input {
    camber_mesh_point points[POINTS_MOST];
    camber_mesh_line lines[LINES_MOST];
    size_t point_count, line_count;
} input;

static float take_px(fuzz_reader *from) {
    const float px = fuzz_take_float(from);
    return isfinite(px) ? fminf(fmaxf(px, -1e6f), 1e6f) : 0.0f;
}

static void take_line(fuzz_reader *from, input *made) {
    const unsigned head = (unsigned)fuzz_take(from, 1);
    const size_t count = 2 + (head & 15);
    camber_mesh_line *line = made->lines + made->line_count++;
    camber_mesh_point *points = made->points + made->point_count;
    *line = (camber_mesh_line){
        .first = made->point_count, .count = count, .x0 = 1e9f, .y0 = 1e9f, .x1 = -1e9f, .y1 = -1e9f};
    for (size_t i = 0; i < count; i++) {
        points[i] = (camber_mesh_point){.x = take_px(from), .y = take_px(from), .info = CAMBER_POINT_REAL};
        line->x0 = fminf(line->x0, points[i].x);
        line->y0 = fminf(line->y0, points[i].y);
        line->x1 = fmaxf(line->x1, points[i].x);
        line->y1 = fmaxf(line->y1, points[i].y);
    }
    const uint32_t ends = (head & 16 ? CAMBER_POINT_RING : 0) | (head & 32 ? CAMBER_POINT_CUT : 0);
    if (head & 16) { /* it ends where it begins */
        points[count - 1].x = points[0].x;
        points[count - 1].y = points[0].y;
    }
    points[0].info |= CAMBER_POINT_FIRST | ends;
    points[count - 1].info |= CAMBER_POINT_LAST | ends;
    made->point_count += count;
}

/* Lines lie between sentinels, each from a first to a last record, and within what 16 bits hold. */
static void check_tile(const camber_mesh_tile *tile) {
    const unsigned known =
        CAMBER_MESH_SENTINEL | CAMBER_MESH_FIRST | CAMBER_MESH_LAST | CAMBER_MESH_RING | CAMBER_MESH_CUT;
    const size_t count = tile->record_count;
    bool is_inside = false;
    size_t segments = 0;
    REQUIRE(count != 1 && count != 2);
    for (size_t i = 0; i < count; i++) {
        const unsigned flags = tile->records[i].flags;
        REQUIRE(flags <= known && tile->records[i].row < tile->row_count + (flags & CAMBER_MESH_SENTINEL));
        REQUIRE(((flags & CAMBER_MESH_FIRST) != 0) == (!is_inside && !(flags & CAMBER_MESH_SENTINEL)));
        segments += is_inside && !(flags & (CAMBER_MESH_SENTINEL | CAMBER_MESH_FIRST));
        is_inside = !(flags & (CAMBER_MESH_SENTINEL | CAMBER_MESH_LAST));
    }
    REQUIRE(!count || (tile->records[0].flags & tile->records[count - 1].flags & CAMBER_MESH_SENTINEL));
    REQUIRE(segments == tile->segments && (segments != 0) == (count != 0));
    for (size_t i = 0; i < tile->range_count; i++)
        REQUIRE(tile->ranges[i].first < tile->ranges[i].end && tile->ranges[i].end <= count);
}

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    static input made;
    fuzz_reader from = {bytes, size};
    const unsigned head = (unsigned)fuzz_take(&from, 1);
    float reach_px = fminf(fmaxf(take_px(&from), 0.0f), 4096.0f);
    uint32_t pair_rows[] = {0}, row_pairs[] = {0};
    bool has_arc_length[] = {false};
    camber_plan_set set = {.pair_count = 1};
    camber_zoom_plan zoom = {.plan = {.sets = &set, .set_count = 1}};
    const camber_mesh_plan plan = {.context = run->context,
                                   .zoom = &zoom,
                                   .pair_rows = pair_rows,
                                   .row_pairs = row_pairs,
                                   .row_count = 1,
                                   .reach_px = &reach_px,
                                   .has_arc_length = has_arc_length};
    camber_mesh_tile tile = {0};
    made.point_count = made.line_count = 0;
    while (from.size && made.line_count < LINES_MOST && made.point_count + 17 <= POINTS_MOST)
        take_line(&from, &made);
    camber_mesh_picture picture = {.plan = &plan, .lines = made.lines, .line_count = made.line_count};
    picture.points = made.points;
    picture.point_count = made.point_count;
    for (int again = 0; again < 2; again++) /* a tile keeps its room */
        if (fuzz_done(run,
                      camber_mesh_tile_cut(run->context, &picture, head & 8 ? 256 : 512, head & 7, head >> 4, &tile)))
            check_tile(&tile);
    camber_mesh_tile_free(&tile);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
