/* The tiles of a segment: its bits against its rows, and both against the segment's own distance to each tile. */
#include "core.h"

#include "kernels/segment.h"

#include <math.h>

enum { COLUMNS = 24, ROWS = 20, CASES = 20000 };

/* A segment whose ends reach so far past its box, as rows of tiles look at it. */
static camber_segment make_segment(double ax, double ay, double bx, double by, double half_width) {
    camber_segment s = {0};
    const double length = hypot(bx - ax, by - ay);
    s.ax = (float)ax;
    s.ay = (float)ay;
    s.bx = (float)bx;
    s.by = (float)by;
    s.ux = length > 0 ? (float)((bx - ax) / length) : 1.0f;
    s.uy = length > 0 ? (float)((by - ay) / length) : 0.0f;
    s.half_width = (float)half_width;
    s.reach = (float)half_width + CAMBER_PAD_PX;
    return s;
}

static camber_segment random_segment(uint64_t *seed) {
    const double x = camber_random_between(seed, -60, 32 * COLUMNS + 60),
                 y = camber_random_between(seed, -60, 32 * ROWS + 60);
    const double reach = camber_random_between(seed, 0, 1) < 0.2 ? 400 : 90,
                 turn = camber_random_between(seed, 0, 6.2832);
    const double length = camber_random_between(seed, 0, reach);
    return make_segment(x, y, x + length * cos(turn), y + length * sin(turn), camber_random_between(seed, 0.2, 30));
}

/* How far the nearest place of the segment is from the middle of a tile, px. */
static double distance_to(const camber_segment *s, uint32_t column, uint32_t row) {
    const double x = 32.0 * column + 16 - (double)s->ax, y = 32.0 * row + 16 - (double)s->ay;
    const double dx = (double)s->bx - (double)s->ax, dy = (double)s->by - (double)s->ay, length = dx * dx + dy * dy;
    const double along = length > 0 ? (x * dx + y * dy) / length : 0, at = along < 0 ? 0 : along > 1 ? 1 : along;
    return hypot(x - at * dx, y - at * dy);
}

static bool has_bit(uint32_t bits, uint32_t box, uint32_t column, uint32_t row) {
    const uint32_t x = column - CAMBER_BOX_FIRST_X(box), y = row - CAMBER_BOX_FIRST_Y(box);
    return x < CAMBER_TILE_BITS_COLUMNS && y < CAMBER_TILE_BITS_ROWS && bits >> (CAMBER_TILE_BITS_COLUMNS * y + x) & 1u;
}

static void check_segment(const camber_segment *s) {
    const camber_tile_grid of = {0.0f, 0.0f, COLUMNS, ROWS};
    const uint32_t box = camber_segment_box(s, 1, 0.0f, 0.0f, COLUMNS, ROWS), bits = camber_tile_bits(s, box, &of);
    const bool drawn = box != CAMBER_NO_BOX;
    const uint32_t across = CAMBER_BOX_LAST_X(box) - CAMBER_BOX_FIRST_X(box),
                   down = CAMBER_BOX_LAST_Y(box) - CAMBER_BOX_FIRST_Y(box);
    const bool large = drawn && (across >= CAMBER_TILE_BITS_COLUMNS || down >= CAMBER_TILE_BITS_ROWS);
    camber_slab slab;
    camber_slab_of(s, &slab);
    if (!drawn)
        assert_int_equal(bits, 0);
    if (large)
        assert_int_equal(bits, CAMBER_TILE_BITS_ASK);
    for (uint32_t row = 0; row < ROWS; row++)
        for (uint32_t column = 0; column < COLUMNS; column++) {
            const bool in_rows = drawn && row >= CAMBER_BOX_FIRST_Y(box) && row <= CAMBER_BOX_LAST_Y(box);
            const camber_tile_range tiles = camber_tiles_in_row(&slab, box, camber_touches_all(s, box, &of), row, &of);
            const bool touched = in_rows && column >= tiles.first && column <= tiles.last;
            if (!large)
                assert_int_equal(has_bit(bits, box, column, row), touched);
            /* A tile whose middle is covered is drawn, and none that lies far away. */
            if (distance_to(s, column, row) < (double)s->half_width)
                assert_true(touched);
            if (touched && across && down)
                assert_true(distance_to(s, column, row) < ((double)s->half_width + 1 + 16) * 1.4143 + 32);
        }
}

static void test_segments_at_random(void **state) {
    uint64_t seed = 17;
    (void)state;
    for (int i = 0; i < CASES; i++) {
        const camber_segment s = random_segment(&seed);
        check_segment(&s);
    }
}

/* Boxes as large as bits can say, and larger by a column or a row. */
static void test_largest_boxes(void **state) {
    const double sizes[][2] = {{250, 120}, {282, 120}, {250, 152}, {0, 120}, {250, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (double x = 33; x < 65; x += 3.7) {
            const camber_segment s = make_segment(x, x, x + sizes[i][0], x + sizes[i][1], 1.5);
            check_segment(&s);
        }
}

/* A segment that is not drawn touches nothing, wherever it lies. */
static void test_undrawn(void **state) {
    const camber_tile_grid of = {0.0f, 0.0f, COLUMNS, ROWS};
    const camber_segment s = make_segment(100, 100, 140, 120, 4);
    (void)state;
    assert_int_equal(camber_tile_bits(&s, CAMBER_NO_BOX, &of), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_segments_at_random),
        cmocka_unit_test(test_largest_boxes),
        cmocka_unit_test(test_undrawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
