/* The sea of a coast: at places all over the box it is where no land is, whatever ways the coast is cut into. Lands are
 * stars beside each other, so that what is land is known without the coast. */
#include "osm/coast.h"
#include "osm/node_set.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

enum { CELLS = 5, CELL = 100000, MOST_POINTS = 40, MOST_LANDS = CELLS * CELLS, PLACES = 400 };

typedef struct land {
    uint64_t points[MOST_POINTS + 1]; /* counter-clockwise, closed */
    size_t count;                     /* without the last */
} land;

typedef struct fixture {
    camber_context *context;
    camber_osm_coast coast;
    camber_osm_assembly sea;
    camber_osm_box box;
    land lands[MOST_LANDS];
    size_t land_count;
    uint32_t random;
    size_t refuse_at, calls; /* the call for memory that is refused; 0: none */
} fixture;

static void *reallocate(void *user, void *block, size_t size_bytes) {
    fixture *f = user;
    if (size_bytes == 0) {
        free(block);
        return NULL;
    }
    return ++f->calls == f->refuse_at ? NULL : realloc(block, size_bytes);
}

static int set_up(void **state) {
    static fixture f;
    f = (fixture){.random = 1, .box = {-20000, 430000, -30000, 410000}};
    const camber_context_desc desc = {.reallocate = reallocate, .allocator_user = &f};
    assert_int_equal(camber_context_create(&desc, &f.context), CAMBER_OK);
    f.coast.context = f.sea.context = f.context;
    *state = &f;
    return 0;
}

static int tear_down(void **state) {
    fixture *f = *state;
    camber_osm_coast_free(&f->coast);
    camber_osm_assembly_free(&f->sea);
    camber_context_destroy(f->context);
    return 0;
}

static uint32_t draw(fixture *f, uint32_t below) {
    f->random = f->random * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)(f->random >> 8) * below >> 24);
}

/* ---- Lands ---- */

/* A star in a cell of a grid whose outer cells reach beyond the box. */
static void add_land(fixture *f, int column, int row) {
    land *l = f->lands + f->land_count++;
    const double x = (column + 0.5) * CELL - 50000.0, y = (row + 0.5) * CELL - 50000.0;
    l->count = 3 + draw(f, MOST_POINTS - 3);
    for (size_t i = 0; i < l->count; i++) {
        const double angle = 6.283185307179586 * (double)i / (double)l->count,
                     far = CELL * (0.15 + 0.33 * draw(f, 1000) / 1000.0);
        l->points[i] = camber_osm_place((int32_t)(x + far * cos(angle)), (int32_t)(y + far * sin(angle)));
    }
    l->points[l->count] = l->points[0];
}

static void add_lands(fixture *f) {
    f->land_count = 0;
    for (int i = 0; i < CELLS * CELLS; i++)
        if (draw(f, 3))
            add_land(f, i % CELLS, i / CELLS);
}

static void add_way(fixture *f, const uint64_t *points, size_t count) {
    f->coast.box = f->box;
    assert_int_equal(camber_osm_coast_add(&f->coast, points, count, false), CAMBER_OK);
}

/* Adds a land's coast as ways that begin anywhere, in any order. reversed: it is a sea in land. */
static void add_coast(fixture *f, const land *l, bool reversed) {
    uint64_t points[2 * MOST_POINTS + 1];
    const size_t start = draw(f, (uint32_t)l->count);
    for (size_t i = 0; i <= l->count; i++)
        points[i] = l->points[(reversed ? start + l->count - i : start + i) % l->count];
    const size_t cut = 1 + draw(f, (uint32_t)l->count),
                 other = cut < l->count ? cut + draw(f, (uint32_t)(l->count - cut)) : cut;
    add_way(f, points + other, l->count + 1 - other);
    add_way(f, points, cut + 1);
    if (other > cut)
        add_way(f, points + cut, other - cut + 1);
}

static void add_coasts(fixture *f, bool reversed) {
    for (size_t i = f->land_count; i-- > 0;)
        add_coast(f, f->lands + i, reversed);
}

/* ---- Places ---- */

/* How often a closed line winds around a place; *near: the place is so near to it that rounding may decide. */
static int wind(const uint64_t *points, size_t count, double x, double y, bool *near) {
    int turns = 0;
    for (size_t i = 0; i + 1 < count; i++) {
        const double ax = camber_osm_longitude(points[i]) - x, ay = camber_osm_latitude(points[i]) - y,
                     bx = camber_osm_longitude(points[i + 1]) - x, by = camber_osm_latitude(points[i + 1]) - y;
        const double side = ax * by - bx * ay, length = hypot(bx - ax, by - ay);
        *near |= fabs(side) < 3.0 * length && fmin(ax, bx) < 3.0 && fmax(ax, bx) > -3.0 && fmin(ay, by) < 3.0 &&
                 fmax(ay, by) > -3.0;
        if ((ay <= 0.0) != (by <= 0.0) && (side > 0.0) == (by > ay))
            turns += by > ay ? 1 : -1;
    }
    return turns;
}

/* Rings of the sea go either way; a hole takes away. */
static int count_sea(const camber_osm_assembly *sea, double x, double y, bool *near) {
    int count = 0;
    for (size_t i = 0; i < sea->ring_count; i++) {
        const camber_osm_ring *ring = sea->rings + i;
        assert_true(ring->count >= 4 && sea->places[ring->first] == sea->places[ring->first + ring->count - 1]);
        const int turns = wind(sea->places + ring->first, ring->count, x, y, near);
        assert_true(turns >= -1 && turns <= 1);
        count += ring->role == CAMBER_OSM_ROLE_INNER ? -abs(turns) : abs(turns);
    }
    return count;
}

static void fill(fixture *f, bool is_open) {
    f->coast.box = f->box;
    assert_int_equal(camber_osm_coast_fill(&f->coast, &f->sea), CAMBER_OK);
    assert_int_equal(f->sea.open, is_open);
    if (is_open)
        assert_int_equal(f->sea.ring_count, 0);
    for (size_t i = 1; i < f->sea.ring_count; i++)
        assert_true(f->sea.rings[i - 1].role <= f->sea.rings[i].role);
}

/* reversed: the sea is in the stars. Otherwise it is around them. */
static void expect_sea(fixture *f, bool reversed) {
    size_t looked_at = 0;
    for (int i = 0; i < PLACES; i++) {
        const double x = f->box.left + 5.0 + draw(f, (uint32_t)(f->box.right - f->box.left - 10)),
                     y = f->box.bottom + 5.0 + draw(f, (uint32_t)(f->box.top - f->box.bottom - 10));
        bool near = false;
        int in_star = 0;
        for (size_t k = 0; k < f->land_count; k++)
            in_star += wind(f->lands[k].points, f->lands[k].count + 1, x, y, &near) != 0;
        const int sea = count_sea(&f->sea, x, y, &near);
        if (near)
            continue;
        looked_at++;
        if (sea != (reversed ? in_star : !in_star))
            fail_msg("sea %d times at %.0f, %.0f, where %d stars are", sea, x, y, in_star);
    }
    assert_true(looked_at > PLACES / 2);
}

static void test_lands(void **state) {
    fixture *f = *state;
    for (int i = 0; i < 500; i++) {
        add_lands(f);
        camber_osm_coast_free(&f->coast);
        add_coasts(f, i % 2);
        fill(f, false);
        expect_sea(f, i % 2);
    }
}

/* Islands alone, an atoll with a lagoon in it, and a sea within land: no coast passes the box's sides. */
static void test_nothing_at_the_sides(void **state) {
    fixture *f = *state;
    f->box = (camber_osm_box){-1000000, 1000000, -1000000, 1000000};
    for (int i = 0; i < 20; i++) {
        add_lands(f);
        camber_osm_coast_free(&f->coast);
        add_coasts(f, i % 2);
        fill(f, false);
        expect_sea(f, i % 2);
    }
    const uint64_t atoll[5] = {camber_osm_place(-9000, -9000), camber_osm_place(9000, -9000),
                               camber_osm_place(9000, 9000), camber_osm_place(-9000, 9000),
                               camber_osm_place(-9000, -9000)},
                   lagoon[4] = {camber_osm_place(-3000, -3000), camber_osm_place(0, 3000),
                                camber_osm_place(3000, -3000), camber_osm_place(-3000, -3000)};
    bool near = false;
    camber_osm_coast_free(&f->coast);
    add_way(f, lagoon, 4);
    add_way(f, atoll, 5);
    fill(f, false);
    assert_int_equal(count_sea(&f->sea, 0, 0, &near), 1);
    assert_int_equal(count_sea(&f->sea, 6000, 6000, &near), 0);
    assert_int_equal(count_sea(&f->sea, 500000, 6000, &near), 1);
}

/* A coast from west to east, land in the north: all beyond the box is lost, or nothing is. */
static void test_ends(void **state) {
    fixture *f = *state;
    const uint64_t coast[5] = {camber_osm_place(500000, 200000), camber_osm_place(425000, 220000),
                               camber_osm_place(200000, 180000), camber_osm_place(-12000, 210000),
                               camber_osm_place(-90000, 200000)};
    uint64_t back[5];
    bool near = false;
    for (int i = 0; i < 5; i++)
        back[i] = coast[4 - i];
    for (int lost = 0; lost < 2; lost++) {
        camber_osm_coast_free(&f->coast);
        add_way(f, back + lost, 5 - 2 * (size_t)lost);
        fill(f, false);
        assert_int_equal(f->sea.ring_count, 1);
        assert_int_equal(count_sea(&f->sea, 100000, 100000, &near), 1);
        assert_int_equal(count_sea(&f->sea, -19900, -29900, &near), 1);
        assert_int_equal(count_sea(&f->sea, 429900, -29900, &near), 1);
        assert_int_equal(count_sea(&f->sea, 100000, 300000, &near), 0);
        assert_int_equal(count_sea(&f->sea, -19900, 409900, &near), 0);
    }
    camber_osm_coast_free(&f->coast); /* it ends in the middle */
    add_way(f, back, 3);
    fill(f, true);
    camber_osm_coast_free(&f->coast); /* a part goes the wrong way */
    add_way(f, back, 3);
    add_way(f, coast, 3);
    fill(f, true);
    const uint64_t other[2] = {camber_osm_place(-90000, 300000), camber_osm_place(500000, 300000)};
    camber_osm_coast_free(&f->coast); /* between the two is both sea and land */
    add_way(f, back, 5);
    add_way(f, other, 2);
    fill(f, true);
}

static void test_boxes(void **state) {
    fixture *f = *state;
    const camber_osm_box none[] = {{0}, {0, 0, 5, 9}, {5, 9, 1, 1}, {9, 5, 1, 2}};
    fill(f, false); /* no coast */
    assert_int_equal(f->sea.ring_count, 0);
    add_land(f, 2, 2);
    add_coasts(f, false);
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        f->box = none[i];
        fill(f, true);
    }
    f->box = (camber_osm_box){INT32_MIN + 1, INT32_MAX, INT32_MIN + 1, INT32_MAX};
    fill(f, false);
    assert_int_equal(f->sea.ring_count, 2);
    f->box = (camber_osm_box){700000, 800000, 0, 100000}; /* all of the coast lies outside */
    fill(f, false);
    assert_int_equal(f->sea.ring_count, 0);
}

/* A coast that only touches the box, or runs along its sides and through its corners. */
static void test_touches(void **state) {
    fixture *f = *state;
    bool near = false;
    f->box = (camber_osm_box){0, 1000, 0, 1000};
    const uint64_t touches[4] = {camber_osm_place(-500, -100), camber_osm_place(0, 500), camber_osm_place(-500, 900),
                                 camber_osm_place(-500, -100)};
    add_way(f, touches, 4);
    fill(f, false);
    assert_int_equal(f->sea.ring_count, 0);
    const uint64_t diagonal[3] = {camber_osm_place(-10, -10), camber_osm_place(500, 500), camber_osm_place(1010, 1010)};
    camber_osm_coast_free(&f->coast);
    add_way(f, diagonal, 3);
    fill(f, false);
    assert_int_equal(count_sea(&f->sea, 900, 100, &near), 1);
    assert_int_equal(count_sea(&f->sea, 100, 900, &near), 0);
}

/* Adds a way of pairs of coordinates. */
#define ADD(f, has_gaps, ...)                                                                                          \
    add_pairs(f, has_gaps, (const int32_t[]){__VA_ARGS__}, sizeof(int32_t[]){__VA_ARGS__} / sizeof(int32_t) / 2)
static void add_pairs(fixture *f, bool has_gaps, const int32_t *pairs, size_t count) {
    uint64_t places[16];
    assert_true(count <= 16);
    for (size_t i = 0; i < count; i++)
        places[i] = camber_osm_place(pairs[2 * i], pairs[2 * i + 1]);
    f->coast.box = f->box;
    assert_int_equal(camber_osm_coast_add(&f->coast, places, count, has_gaps), CAMBER_OK);
}

static void expect_at(fixture *f, double x, double y, bool is_sea) {
    bool near = false;
    const int count = count_sea(&f->sea, x, y, &near);
    if (near || count != is_sea)
        fail_msg("sea %d times at %.0f, %.0f", count, x, y);
}

/* A coast from east to west, land in the south. */
static void begin_south(fixture *f) {
    camber_osm_coast_free(&f->coast);
    f->box = (camber_osm_box){0, 100000, 0, 100000};
    ADD(f, false, 110000, 50000, -10000, 50000);
}

/* Lines that close, and are listed twice, lie where they cannot, or have no inside: nothing is flooded by them. */
static void test_closed(void **state) {
    fixture *f = *state;
    begin_south(f);
    for (int i = 0; i < 2; i++) {
        ADD(f, false, 10000, 70000, 20000, 70000, 20000, 80000, 10000, 70000); /* an island, in one way and in two */
        ADD(f, false, 50000, 70000, 60000, 70000, 60000, 80000);
        ADD(f, false, 60000, 80000, 50000, 70000);
    }
    ADD(f, false, 30000, 10000, 40000, 10000, 40000, 20000, 30000, 10000); /* an island on land */
    ADD(f, false, 70000, 60000, 80000, 70000, 80000, 60000, 70000, 60000); /* a sea in the sea */
    ADD(f, false, 90000, 10000, 95000, 20000, 95000, 10000, 90000, 10000); /* a sea in land */
    ADD(f, false, 5000, 90000, 9000, 90000, 5000, 90000);                  /* flat */
    ADD(f, false, 1000, 90000, 1000, 90000);                               /* a place */
    fill(f, false);
    expect_at(f, 18000, 74000, false);
    expect_at(f, 58000, 74000, false);
    expect_at(f, 38000, 14000, false);
    expect_at(f, 78000, 64000, true);
    expect_at(f, 94000, 14000, true);
    expect_at(f, 7000, 91000, true);
    expect_at(f, 50000, 40000, false);
    /* Without a coast that passes the sides, one that lies does not turn all over. */
    camber_osm_coast_free(&f->coast);
    ADD(f, false, 10000, 70000, 20000, 80000, 20000, 70000, 10000, 70000);
    ADD(f, false, 50000, 70000, 60000, 70000, 60000, 80000, 50000, 70000);
    fill(f, true);
}

/* A coast that comes in and leaves at one place of a side is an island there, or a sea. */
static void test_loop_at_side(void **state) {
    fixture *f = *state;
    for (int turned = 0; turned < 2; turned++) {
        const int32_t first = turned ? 80000 : 60000, second = turned ? 60000 : 80000;
        begin_south(f);
        ADD(f, false, 110000, 70000, 100000, 70000, 80000, second, 80000, first, 100000, 70000, 110000, 70001);
        fill(f, false);
        expect_at(f, 85000, 70000, turned ? true : false);
        expect_at(f, 50000, 70000, true);
        expect_at(f, 50000, 30000, false);
    }
}

/* Nodes beyond the box are lost between others: a way leaves at the top, and comes back in the west. */
static void test_gaps(void **state) {
    fixture *f = *state;
    f->box = (camber_osm_box){0, 100000, 0, 100000};
    ADD(f, true, 98000, 50000, 60000, 50000, 60000, 98000, 2000, 60000, 30000, 60000, 30000, 52000, 2000, 52000);
    fill(f, false);
    expect_at(f, 80000, 80000, true);
    expect_at(f, 15000, 56000, true);
    expect_at(f, 20000, 90000, false);
    expect_at(f, 50000, 70000, false);
    expect_at(f, 20000, 20000, false);
    /* It leaves in the east and comes back there: what lies between is land up to the side. */
    camber_osm_coast_free(&f->coast);
    ADD(f, true, 50000, 2000, 50000, 30000, 97000, 30000, 97000, 70000, 50000, 70000, 50000, 98000);
    fill(f, false);
    expect_at(f, 98500, 50000, false);
    expect_at(f, 80000, 15000, true);
    expect_at(f, 80000, 85000, true);
    expect_at(f, 98500, 20000, true);
}

/* One place has a hundred thousand ways: no slower than as many elsewhere. */
static void test_many_ways(void **state) {
    fixture *f = *state;
    begin_south(f);
    for (int i = 0; i < 100000; i++) {
        ADD(f, false, 50000, 70000, 50100 + i % 100, 70000, 50100, 70001 + i / 100, 50000, 70000);
        ADD(f, false, 50000, 70000, 50100 + i, 90000);
        ADD(f, false, 20100 + i, 90000, 50000, 70000);
    }
    assert_int_equal(camber_osm_coast_fill(&f->coast, &f->sea), CAMBER_OK);
}

static void test_memory(void **state) {
    fixture *f = *state;
    bool made = false;
    for (size_t refused = 1; !made; refused++) {
        f->random = 7;
        add_lands(f);
        camber_osm_coast_free(&f->coast);
        camber_osm_assembly_free(&f->sea);
        add_coasts(f, false);
        f->calls = 0;
        f->refuse_at = refused;
        const camber_status status = camber_osm_coast_fill(&f->coast, &f->sea);
        made = f->calls < refused;
        f->refuse_at = 0;
        assert_int_equal(status, made ? CAMBER_OK : CAMBER_ERROR_MEMORY);
        assert_true(refused < 1000);
    }
    expect_sea(f, false);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_lands, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_nothing_at_the_sides, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_ends, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_boxes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_touches, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_closed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_loop_at_side, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_gaps, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_many_ways, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_memory, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("coast", tests, NULL, NULL);
}
