/* Pieces of vector tiles: cut at the border, joined across it, drawn once. */
#include "features/tile_stitcher.h"
#include "style/style.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

enum { ZOOM = 3 };

/* Coordinates in the tests are units: tile (c, r) is 4096 c to 4096 (c + 1). */
static const double WORLD = 8 * 4096.0;

typedef struct fixture {
    camber_context *context;
    struct camber_style style;
    camber_features *features;
    camber_tile_stitcher *tiles;
    uint32_t classes[2];
} fixture;

static int set_up(void **state) {
    static char *properties[] = {"highway"};
    fixture *it = calloc(1, sizeof *it);
    assert_non_null(it);
    assert_int_equal(camber_context_create(NULL, &it->context), CAMBER_OK);
    it->style =
        (struct camber_style){.context = it->context, .schema = {.properties = properties, .property_count = 1}};
    assert_int_equal(camber_features_create(it->context, &it->style, &it->features), CAMBER_OK);
    assert_int_equal(camber_tile_stitcher_create(it->context, ZOOM, &it->tiles), CAMBER_OK);
    for (int i = 0; i < 2; i++) {
        const camber_value value = {.type = CAMBER_VALUE_NUMBER, .number = i};
        assert_int_equal(camber_features_find_class(it->features, 0, CAMBER_GEOMETRY_LINE, &value, &it->classes[i]),
                         CAMBER_OK);
    }
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    fixture *it = *state;
    camber_tile_stitcher_destroy(it->tiles);
    camber_features_destroy(it->features);
    camber_context_destroy(it->context);
    free(it);
    return 0;
}

/* id 0: none. */
static void add(fixture *it, uint32_t column, uint32_t row, uint64_t id, bool outline, size_t count,
                const double *units) {
    double points[64];
    assert_true(count <= 32);
    for (size_t i = 0; i < 2 * count; i++)
        points[i] = units[i] / WORLD;
    size_t end = count;
    const camber_tile_lines parts = {.points = points, .ends = &end, .line_count = 1};
    const camber_tile_feature feature = {
        .column = column, .row = row, .class_index = it->classes[0], .outline = outline, .has_id = id != 0, .id = id};
    assert_int_equal(camber_tile_stitcher_add(it->tiles, &feature, &parts), CAMBER_OK);
}

#define ADD(it, column, row, id, ...)                                                                                  \
    add(it, column, row, id, false, sizeof((double[]){__VA_ARGS__}) / sizeof(double) / 2, (double[]){__VA_ARGS__})

static void finish(fixture *it, size_t polylines, size_t joined) {
    assert_int_equal(camber_tile_stitcher_finish(it->tiles, it->features), CAMBER_OK);
    assert_int_equal(it->features->polyline_count, polylines);
    assert_int_equal(it->features->stats.joined_pieces, joined);
}

static void expect(const fixture *it, size_t polyline, size_t count, const double *units) {
    const camber_features *set = it->features;
    assert_int_equal(set->offsets[polyline + 1] - set->offsets[polyline], count);
    for (size_t i = 0; i < 2 * count; i++) {
        const double got = set->points[2 * set->offsets[polyline] + i] * WORLD;
        if (fabs(got - units[i]) > 1e-6)
            fail_msg("polyline %zu, ordinate %zu: %.9g is not %.9g", polyline, i, got, units[i]);
    }
}

#define EXPECT(it, polyline, ...)                                                                                      \
    expect(it, polyline, sizeof((double[]){__VA_ARGS__}) / sizeof(double) / 2, (double[]){__VA_ARGS__})

/* Both tiles hold the whole segment in their buffers: the segment comes out as it was, without a point between. */
static void test_join(void **state) {
    fixture *it = *state;
    ADD(it, 0, 0, 7, 100, 100, 4090, 200, 4110, 240);
    ADD(it, 1, 0, 7, 4090, 200, 4110, 240, 5000, 300);
    finish(it, 1, 1);
    EXPECT(it, 0, 100, 100, 4090, 200, 4110, 240, 5000, 300);
    assert_int_equal(it->features->feature_count, 1);
}

/* The buffer cuts the outer point off at 4176, rounded, so that the tiles disagree on the crossing. */
static void test_join_rounded(void **state) {
    fixture *it = *state;
    ADD(it, 0, 0, 7, 100, 100, 4000, 200, 4176, 217);
    ADD(it, 1, 0, 7, 4016, 202, 8000, 583);
    finish(it, 1, 1);
    EXPECT(it, 0, 100, 100, 4000, 200, 8000, 583);
}

static void test_order_and_direction(void **state) {
    fixture *it = *state;
    /* Three tiles, the middle one last, and the right one turned. */
    ADD(it, 2, 0, 7, 9000, 300, 8200, 300, 8180, 300);
    ADD(it, 0, 0, 7, 100, 100, 4096, 300, 4200, 300);
    ADD(it, 1, 0, 7, 4000, 300, 8300, 300);
    finish(it, 1, 2);
    const double *first = it->features->points;
    const bool from_left = first[0] * WORLD < 200;
    if (from_left)
        EXPECT(it, 0, 100, 100, 4096, 300, 8200, 300, 9000, 300);
    else
        EXPECT(it, 0, 9000, 300, 8200, 300, 4096, 300, 100, 100);
}

/* A road of both tiles lies above what either has below it. */
static void test_order_across_tiles(void **state) {
    fixture *it = *state;
    ADD(it, 0, 0, 1, 100, 100, 200, 100);
    ADD(it, 0, 0, 7, 100, 200, 4200, 200);
    ADD(it, 0, 0, 2, 100, 300, 200, 300);
    ADD(it, 1, 0, 3, 5000, 100, 5100, 100);
    ADD(it, 1, 0, 7, 4000, 200, 5100, 200);
    ADD(it, 1, 0, 4, 5000, 300, 5100, 300);
    finish(it, 5, 1);
    EXPECT(it, 0, 100, 100, 200, 100);
    EXPECT(it, 1, 5000, 100, 5100, 100);
    EXPECT(it, 2, 100, 200, 5100, 200);
    EXPECT(it, 3, 100, 300, 200, 300);
    EXPECT(it, 4, 5000, 300, 5100, 300);
}

/* A line that lies in the buffer only is the neighbour's. */
static void test_buffer_is_dropped(void **state) {
    fixture *it = *state;
    ADD(it, 0, 0, 7, 4100, 100, 4150, 200);
    ADD(it, 1, 0, 7, 4100, 100, 4150, 200);
    finish(it, 1, 0);
    EXPECT(it, 0, 4100, 100, 4150, 200);
}

static void test_different_features_stay_apart(void **state) {
    fixture *it = *state;
    ADD(it, 0, 0, 7, 100, 100, 4096, 200);
    ADD(it, 1, 0, 8, 4096, 200, 5000, 300);
    finish(it, 2, 0);
    assert_int_equal(it->features->feature_count, 2);
}

/* No ids: equal attributes. */
static void test_without_ids(void **state) {
    fixture *it = *state;
    ADD(it, 0, 0, 0, 100, 100, 4096, 200);
    ADD(it, 1, 0, 0, 4096, 200, 5000, 300);
    ADD(it, 1, 0, 0, 4096, 900, 5000, 900);
    finish(it, 2, 1);
    EXPECT(it, 0, 100, 100, 4096, 200, 5000, 300);
    EXPECT(it, 1, 4096, 900, 5000, 900);
}

/* A line that leaves a tile through its corner goes on in the one across. */
static void test_corner(void **state) {
    fixture *it = *state;
    ADD(it, 0, 0, 7, 4000, 4000, 4192, 4192);
    ADD(it, 1, 0, 7, 4000, 4000, 4192, 4192);
    ADD(it, 0, 1, 7, 4000, 4000, 4192, 4192);
    ADD(it, 1, 1, 7, 4000, 4000, 4192, 4192);
    finish(it, 1, 1);
    EXPECT(it, 0, 4000, 4000, 4192, 4192);
}

/* A point that touches the border from inside is no end. */
static void test_touch(void **state) {
    fixture *it = *state;
    ADD(it, 0, 0, 7, 4000, 100, 4096, 150, 4000, 200);
    ADD(it, 1, 0, 7, 4000, 100, 4096, 150, 4000, 200);
    finish(it, 1, 0);
    EXPECT(it, 0, 4000, 100, 4096, 150, 4000, 200);
}

/* A road along the border is in both tiles, and drawn once. */
static void test_along_border(void **state) {
    fixture *it = *state;
    for (uint32_t column = 0; column < 2; column++)
        ADD(it, column, 0, 7, 4000, 100, 4096, 200, 4096, 300, 4096, 400, 4200, 500);
    finish(it, 1, 2);
    EXPECT(it, 0, 4000, 100, 4096, 200, 4096, 300, 4096, 400, 4200, 500);
}

/* A ring around a corner of four tiles closes again, and has no end where it happened to begin. */
static void test_ring(void **state) {
    fixture *it = *state;
    for (uint32_t row = 0; row < 2; row++)
        for (uint32_t column = 0; column < 2; column++)
            ADD(it, column, row, 7, 4050, 4050, 4150, 4050, 4150, 4150, 4050, 4150, 4050, 4050);
    finish(it, 1, 3);
    const camber_features *set = it->features;
    const size_t last = set->point_count - 1;
    assert_true(set->points[0] == set->points[2 * last] && set->points[1] == set->points[2 * last + 1]);
    /* Its four corners, in whatever order; the place where it closes may be a fifth point. */
    double length = 0;
    for (size_t i = 1; i < set->point_count; i++)
        length += hypot(set->points[2 * i] - set->points[2 * i - 2], set->points[2 * i + 1] - set->points[2 * i - 1]);
    assert_true(fabs(length * WORLD - 400) < 1e-6);
    assert_true(set->point_count <= 6);
}

/* Outlines of polygons: the edge that the tile's clipping made is not drawn. */
static void test_outline(void **state) {
    fixture *it = *state;
    const double left[] = {4000, 100, 4096, 100, 4096, 200, 4000, 200, 4000, 100};
    const double right[] = {4096, 100, 4200, 100, 4200, 200, 4096, 200, 4096, 100};
    add(it, 0, 0, 7, true, 5, left);
    add(it, 1, 0, 7, true, 5, right);
    assert_int_equal(camber_tile_stitcher_finish(it->tiles, it->features), CAMBER_OK);
    assert_int_equal(it->features->polyline_count, 1);
    double length = 0;
    const camber_features *set = it->features;
    for (size_t i = 1; i < set->point_count; i++)
        length += hypot(set->points[2 * i] - set->points[2 * i - 2], set->points[2 * i + 1] - set->points[2 * i - 1]);
    assert_true(fabs(length * WORLD - 600) < 1e-6);
}

static void test_nothing(void **state) {
    fixture *it = *state;
    finish(it, 0, 0);
}

/* A hundred thousand ends in one place: no more than a moment. */
static void test_hostile(void **state) {
    fixture *it = *state;
    for (uint64_t i = 1; i <= 100000; i++)
        ADD(it, 0, 0, i % 2 ? i : 0, 4000, 100, 4096, 200);
    assert_int_equal(camber_tile_stitcher_finish(it->tiles, it->features), CAMBER_OK);
    assert_int_equal(it->features->polyline_count, 100000);
}

/* A line along x from 0 to 8192, of which each tile has its part and a buffer of 100. */
static void test_progress(void **state) {
    fixture *it = *state;
    for (int only_east = 0; only_east < 2; only_east++) {
        for (uint32_t column = (uint32_t)only_east; column < 2; column++) {
            const double first = column ? 3996 : 0, last = column ? 8192 : 4196;
            const double points[] = {first / WORLD, 100 / WORLD, 4050 / WORLD, 100 / WORLD, last / WORLD, 100 / WORLD};
            const size_t end = 3;
            const camber_tile_lines parts = {.points = points, .ends = &end, .line_count = 1};
            const camber_tile_feature feature = {.column = column,
                                                 .class_index = it->classes[0],
                                                 .has_id = true,
                                                 .id = (uint64_t)only_east + 1,
                                                 .has_progress = true,
                                                 .progress = {first / 8192, last / 8192}};
            assert_int_equal(camber_tile_stitcher_add(it->tiles, &feature, &parts), CAMBER_OK);
        }
    }
    ADD(it, 0, 0, 9, 100, 100, 200, 200);
    finish(it, 3, 1);
    const float expected[] = {0, 1, 0.5f, 1, 0, 1};
    EXPECT(it, 1, 4096, 100, 8192, 100);
    for (int i = 0; i < 6; i++)
        assert_true(fabsf(it->features->progress[i] - expected[i]) < 1e-6f);
}

/* Where lines have a direction, two that begin where they meet stay two. */
static void test_directed(void **state) {
    fixture *it = *state;
    it->style.schema.directed = true;
    ADD(it, 0, 0, 7, 5000, 200, 100, 200);
    ADD(it, 1, 0, 7, 4000, 200, 5000, 200);
    finish(it, 2, 0);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_join),
        TEST(test_join_rounded),
        TEST(test_order_and_direction),
        TEST(test_order_across_tiles),
        TEST(test_buffer_is_dropped),
        TEST(test_different_features_stay_apart),
        TEST(test_without_ids),
        TEST(test_corner),
        TEST(test_touch),
        TEST(test_along_border),
        TEST(test_ring),
        TEST(test_outline),
        TEST(test_nothing),
        TEST(test_hostile),
        TEST(test_progress),
        TEST(test_directed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
