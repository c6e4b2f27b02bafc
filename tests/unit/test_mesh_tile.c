/* Mesh tiles: lines cut and quantised, and what stands between them. No device: a picture of points is made by hand.
 */
#include "tiles/mesh_tile.h"

#include "kernels/layout.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

enum { TILE_PX = 256, MOST = 32 };

/* A plan of one set with one row, drawn so wide that it reaches some px. */
typedef struct fixture {
    camber_context *context;
    camber_zoom_plan zoom;
    camber_plan_set set;
    uint32_t pair_rows[1], row_pairs[1];
    float reach_px[1];
    bool has_arc_length[1];
    camber_mesh_plan plan;
    camber_mesh_point points[MOST];
    camber_mesh_line line;
    camber_mesh_picture picture;
    camber_mesh_tile tile;
} fixture;

static void make(fixture *f, const float (*points)[2], size_t count, uint32_t first_flags, uint32_t last_flags) {
    *f = (fixture){.reach_px = {4.0f}, .set = {.pair_count = 1}};
    assert_int_equal(camber_context_create(NULL, &f->context), CAMBER_OK);
    f->zoom.plan.sets = &f->set;
    f->zoom.plan.set_count = 1;
    f->plan = (camber_mesh_plan){.context = f->context,
                                 .zoom = &f->zoom,
                                 .pair_rows = f->pair_rows,
                                 .row_pairs = f->row_pairs,
                                 .row_count = 1,
                                 .reach_px = f->reach_px,
                                 .has_arc_length = f->has_arc_length};
    f->line = (camber_mesh_line){.count = count, .x0 = 1e9f, .y0 = 1e9f, .x1 = -1e9f, .y1 = -1e9f};
    for (size_t i = 0; i < count; i++) {
        const float x = points[i][0], y = points[i][1];
        f->points[i] = (camber_mesh_point){.x = x, .y = y, .info = CAMBER_POINT_REAL};
        f->line.x0 = x < f->line.x0 ? x : f->line.x0;
        f->line.y0 = y < f->line.y0 ? y : f->line.y0;
        f->line.x1 = x > f->line.x1 ? x : f->line.x1;
        f->line.y1 = y > f->line.y1 ? y : f->line.y1;
    }
    f->points[0].info |= CAMBER_POINT_FIRST | first_flags;
    f->points[count - 1].info |= CAMBER_POINT_LAST | last_flags;
    f->picture = (camber_mesh_picture){.plan = &f->plan, .lines = &f->line, .line_count = 1};
    f->picture.points = f->points;
    f->picture.point_count = count;
}

static void cut(fixture *f) {
    assert_int_equal(camber_mesh_tile_cut(f->context, &f->picture, TILE_PX, 0, 0, &f->tile), CAMBER_OK);
}

static void end(fixture *f) {
    camber_mesh_tile_free(&f->tile);
    camber_context_destroy(f->context);
}

static void check(const fixture *f, size_t at, int x, int y, unsigned flags) {
    assert_true(at < f->tile.record_count);
    const camber_mesh_record *r = f->tile.records + at;
    assert_int_equal(r->x, x);
    assert_int_equal(r->y, y);
    assert_int_equal(r->flags, flags);
    assert_int_equal(r->row, 0);
}

/* 128 units a px; the centre is 0, 0. Halves go up. */
static void test_units(void **state) {
    (void)state;
    static const float points[][2] = {{0, 0}, {128, 128}, {129.00390625f, 127.99609375f}, {255.99f, 10}};
    fixture f;
    make(&f, points, 4, 0, 0);
    cut(&f);
    assert_int_equal(f.tile.units, CAMBER_MESH_UNITS);
    assert_int_equal(f.tile.record_count, 6);
    assert_int_equal(f.tile.segments, 3);
    assert_true(f.tile.records[0].flags == CAMBER_MESH_SENTINEL && f.tile.records[5].flags == CAMBER_MESH_SENTINEL);
    check(&f, 1, -16384, -16384, CAMBER_MESH_FIRST);
    check(&f, 2, 0, 0, 0);
    check(&f, 3, 129, 0, 0); /* 128.5 and -0.5 */
    check(&f, 4, 16383, -15104, CAMBER_MESH_LAST);
    assert_int_equal(f.tile.range_count, 1);
    assert_int_equal(f.tile.ranges[0].first, 1);
    assert_int_equal(f.tile.ranges[0].end, 5);
    end(&f);
}

/* A line that leaves the reach of the tile and comes back is two, whose inner ends are cuts. */
static void test_leaves(void **state) {
    (void)state;
    static const float points[][2] = {{10, 10}, {10, 300}, {60, 300}, {60, 10}};
    fixture f;
    make(&f, points, 4, 0, 0);
    cut(&f);
    assert_int_equal(f.tile.record_count, 7);
    check(&f, 1, -15104, -15104, CAMBER_MESH_FIRST);
    check(&f, 2, -15104, 22016, CAMBER_MESH_LAST | CAMBER_MESH_CUT);
    assert_int_equal(f.tile.records[3].flags, CAMBER_MESH_SENTINEL);
    check(&f, 4, -8704, 22016, CAMBER_MESH_FIRST | CAMBER_MESH_CUT);
    check(&f, 5, -8704, -15104, CAMBER_MESH_LAST);
    end(&f);
}

/* A segment that leaves what 16 bits hold is cut there, on the line. */
static void test_far(void **state) {
    (void)state;
    static const float points[][2] = {{-1000, -1000}, {1256, 1256}};
    fixture f;
    make(&f, points, 2, 0, 0);
    cut(&f);
    assert_int_equal(f.tile.record_count, 4);
    check(&f, 1, -32767, -32767, CAMBER_MESH_FIRST | CAMBER_MESH_CUT);
    check(&f, 2, 32767, 32767, CAMBER_MESH_LAST | CAMBER_MESH_CUT);
    end(&f);
}

/* Where strokes reach farther than half a tile, units are coarser. */
static void test_wide(void **state) {
    (void)state;
    static const float points[][2] = {{-200, 128}, {456, 128}};
    fixture f;
    make(&f, points, 2, 0, 0);
    f.reach_px[0] = 200.0f;
    cut(&f);
    assert_int_equal(f.tile.units, CAMBER_MESH_UNITS / 2);
    check(&f, 1, -20992, 0, CAMBER_MESH_FIRST);
    end(&f);
}

static void test_beside(void **state) {
    (void)state;
    static const float points[][2] = {{-300, -4.5f}, {600, -4.5f}};
    fixture f;
    make(&f, points, 2, 0, 0);
    cut(&f);
    assert_int_equal(f.tile.segments, 0);
    assert_int_equal(f.tile.record_count, 0);
    f.reach_px[0] = 4.5f;
    cut(&f);
    assert_int_equal(f.tile.segments, 1);
    end(&f);
}

/* Points that fall together are one; a line that falls together is a dot. */
static void test_small(void **state) {
    (void)state;
    static const float points[][2] = {{20, 20}, {20.001f, 20}, {30, 20}, {30, 20.002f}};
    static const float dot[][2] = {{20, 20}, {20.001f, 20}};
    fixture f;
    make(&f, points, 4, 0, 0);
    cut(&f);
    assert_int_equal(f.tile.record_count, 4);
    check(&f, 2, -12544, -13824, CAMBER_MESH_LAST);
    end(&f);
    make(&f, dot, 2, 0, 0);
    cut(&f);
    assert_int_equal(f.tile.record_count, 4);
    check(&f, 1, -13824, -13824, CAMBER_MESH_FIRST);
    check(&f, 2, -13824, -13824, CAMBER_MESH_LAST);
    end(&f);
}

/* A ring's sentinels have its neighbours. One that leaves the tile is a line that begins where it comes back. */
static void test_ring(void **state) {
    (void)state;
    static const float whole[][2] = {{100, 100}, {150, 100}, {150, 150}, {100, 150}, {100, 100}};
    static const float cut_off[][2] = {{100, 100}, {150, 100}, {150, 400}, {100, 400}, {100, 100}};
    fixture f;
    make(&f, whole, 5, CAMBER_POINT_RING, CAMBER_POINT_RING);
    cut(&f);
    assert_int_equal(f.tile.record_count, 7);
    check(&f, 0, -3584, 2816, CAMBER_MESH_SENTINEL);
    check(&f, 1, -3584, -3584, CAMBER_MESH_FIRST | CAMBER_MESH_RING);
    check(&f, 5, -3584, -3584, CAMBER_MESH_LAST | CAMBER_MESH_RING);
    check(&f, 6, 2816, -3584, CAMBER_MESH_SENTINEL);
    end(&f);
    make(&f, cut_off, 5, CAMBER_POINT_RING, CAMBER_POINT_RING);
    cut(&f);
    assert_int_equal(f.tile.record_count, 6);
    check(&f, 1, -3584, 32767, CAMBER_MESH_FIRST | CAMBER_MESH_CUT);
    check(&f, 2, -3584, -3584, 0);
    check(&f, 3, 2816, -3584, 0);
    check(&f, 4, 2816, 32767, CAMBER_MESH_LAST | CAMBER_MESH_CUT);
    end(&f);
}

/* A line that the picture cuts does not end there. */
static void test_cut_by_picture(void **state) {
    (void)state;
    static const float points[][2] = {{-60, 40}, {100, 40}};
    fixture f;
    make(&f, points, 2, CAMBER_POINT_CUT, 0);
    cut(&f);
    check(&f, 1, -24064, -11264, CAMBER_MESH_FIRST | CAMBER_MESH_CUT);
    check(&f, 2, -3584, -11264, CAMBER_MESH_LAST);
    end(&f);
}

/* A ring's piece that begins at its seam has the last piece's neighbour, pulled to what 16 bits hold. */
static void test_seam(void **state) {
    (void)state;
    static const float points[][2] = {{100, 100}, {150, 100}, {100, 500}};
    fixture f;
    make(&f, points, 2, CAMBER_POINT_RING, CAMBER_POINT_CUT);
    f.points[2] = (camber_mesh_point){.x = points[2][0], .y = points[2][1]};
    f.line.before = 3;
    cut(&f);
    assert_int_equal(f.tile.record_count, 4);
    check(&f, 0, -3584, 32767, CAMBER_MESH_SENTINEL);
    check(&f, 1, -3584, -3584, CAMBER_MESH_FIRST | CAMBER_MESH_RING);
    check(&f, 2, 2816, -3584, CAMBER_MESH_LAST | CAMBER_MESH_CUT);
    end(&f);
}

/* Records have 15 bits for a row: one more is refused, and those that are there keep their numbers. */
static void test_rows(void **state) {
    (void)state;
    static const float points[][2] = {{20, 20}, {30, 20}};
    fixture f;
    uint16_t number = 0;
    make(&f, points, 2, 0, 0);
    f.plan.row_count = 70000;
    f.picture.line_count = 0;
    cut(&f);
    for (uint32_t row = 0; row < INT16_MAX; row++) {
        assert_int_equal(camber_mesh_tile_number(&f.tile, 69999 - row, &number), CAMBER_OK);
        assert_int_equal(number, row);
    }
    assert_int_equal(camber_mesh_tile_number(&f.tile, 0, &number), CAMBER_ERROR_LIMIT);
    assert_int_equal(camber_mesh_tile_number(&f.tile, 69999, &number), CAMBER_OK);
    assert_int_equal(number, 0);
    end(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_units), cmocka_unit_test(test_leaves),         cmocka_unit_test(test_far),
        cmocka_unit_test(test_wide),  cmocka_unit_test(test_beside),         cmocka_unit_test(test_small),
        cmocka_unit_test(test_ring),  cmocka_unit_test(test_cut_by_picture), cmocka_unit_test(test_seam),
        cmocka_unit_test(test_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
