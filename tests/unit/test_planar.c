/* Rings of multipolygons by geometry: unions of cells of a grid, whose sides are cut into ways at random. */
#include "core.h"

#include "osm/assemble.h"
#include "osm/node_set.h"

enum { SIDE = 7, CORNERS = SIDE + 1, MOST_EDGES = 2 * SIDE * CORNERS, STEP = 1000 };

typedef struct fixture {
    camber_context *context;
    camber_osm_assembly rings;
    uint32_t random;
    bool cells[SIDE][SIDE];
    /* Sides of cells that ways go along: to the east, and to the north, of each corner; how often. */
    int east[CORNERS][CORNERS], north[CORNERS][CORNERS];
    uint64_t places[8 * MOST_EDGES];
    camber_osm_piece pieces[4 * MOST_EDGES];
    size_t place_count, piece_count;
} fixture;

static int set_up(void **state) {
    fixture *it = calloc(1, sizeof *it);
    assert_non_null(it);
    assert_int_equal(camber_context_create(NULL, &it->context), CAMBER_OK);
    it->rings.context = it->context;
    it->random = 1;
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    fixture *it = *state;
    camber_osm_assembly_free(&it->rings);
    camber_context_destroy(it->context);
    free(it);
    return 0;
}

static uint32_t below(fixture *it, uint32_t count) {
    it->random = it->random * 1664525 + 1013904223;
    return (it->random >> 16) % count;
}

static uint64_t corner(int x, int y) {
    return camber_osm_place(STEP * (x - SIDE / 2), STEP * (y - SIDE / 2));
}

static bool is_cell(const fixture *it, int x, int y) {
    return x >= 0 && x < SIDE && y >= 0 && y < SIDE && it->cells[y][x];
}

/* Cells at random, and the sides between them and what is no cell. */
static void make_cells(fixture *it) {
    const uint32_t density = 2 + below(it, 6);
    for (int i = 0; i < SIDE * SIDE; i++)
        it->cells[i / SIDE][i % SIDE] = below(it, 10) < density;
    for (int y = 0; y < CORNERS; y++)
        for (int x = 0; x < CORNERS; x++) {
            it->east[y][x] = x < SIDE && is_cell(it, x, y) != is_cell(it, x, y - 1);
            it->north[y][x] = y < SIDE && is_cell(it, x, y) != is_cell(it, x - 1, y);
        }
}

/* Goes along a side that nobody has gone along. false: there is none. */
static bool step(fixture *it, int *x, int *y) {
    const uint32_t first = below(it, 4);
    for (uint32_t i = 0; i < 4; i++) {
        static const int dx[] = {1, 0, -1, 0}, dy[] = {0, 1, 0, -1};
        const uint32_t way = (first + i) % 4;
        const int x0 = way == 2 ? *x - 1 : *x, y0 = way == 3 ? *y - 1 : *y;
        if (x0 < 0 || y0 < 0)
            continue;
        int *left = way % 2 ? &it->north[y0][x0] : &it->east[y0][x0];
        if (*left == 0)
            continue;
        --*left;
        *x += dx[way];
        *y += dy[way];
        return true;
    }
    return false;
}

/* Cuts the sides into ways, which go straight on or turn where others meet them, and have any role. */
static void make_pieces(fixture *it) {
    it->place_count = it->piece_count = 0;
    for (int i = 0; i < CORNERS * CORNERS; i++)
        for (;;) {
            int x = i % CORNERS, y = i / CORNERS;
            const size_t first = it->place_count;
            it->places[it->place_count++] = corner(x, y);
            while (below(it, 8) && step(it, &x, &y))
                it->places[it->place_count++] = corner(x, y);
            const uint32_t count = (uint32_t)(it->place_count - first);
            if (count > 1)
                it->pieces[it->piece_count++] =
                    (camber_osm_piece){it->places + first, count, (camber_osm_role)below(it, 3)};
            else
                it->place_count = first;
            if (count == 1 && !it->east[i / CORNERS][i % CORNERS] && !it->north[i / CORNERS][i % CORNERS])
                break;
        }
}

/* Whether the middle of a cell lies in a ring. */
static bool lies_in(const camber_osm_assembly *rings, const camber_osm_ring *ring, int x, int y) {
    const double px = STEP * (x - SIDE / 2 + 0.5), py = STEP * (y - SIDE / 2 + 0.5);
    bool inside = false;
    for (size_t i = ring->first; i + 1 < ring->first + ring->count; i++) {
        const double x0 = camber_osm_longitude(rings->places[i]), y0 = camber_osm_latitude(rings->places[i]),
                     y1 = camber_osm_latitude(rings->places[i + 1]);
        if ((y0 > py) != (y1 > py) && x0 > px) /* sides are upright or level */
            inside = !inside;
    }
    return inside;
}

/* Rings are closed and simple, and the cells lie in one outer ring more than in holes. */
static void expect_cells(const fixture *it) {
    const camber_osm_assembly *rings = &it->rings;
    assert_false(rings->open);
    for (size_t r = 0; r < rings->ring_count; r++) {
        const camber_osm_ring *ring = &rings->rings[r];
        const uint64_t *places = rings->places + ring->first;
        assert_true(ring->count >= 5 && places[0] == places[ring->count - 1]);
        assert_true(r == 0 || rings->rings[r - 1].role <= ring->role);
        for (size_t i = 0; i + 1 < ring->count; i++)
            for (size_t k = i + 1; k + 1 < ring->count; k++)
                assert_true(places[i] != places[k]);
    }
    for (int i = 0; i < SIDE * SIDE; i++) {
        int around = 0;
        for (size_t r = 0; r < rings->ring_count; r++)
            if (lies_in(rings, &rings->rings[r], i % SIDE, i / SIDE))
                around += rings->rings[r].role == CAMBER_OSM_ROLE_OUTER ? 1 : -1;
        assert_int_equal(around, it->cells[i / SIDE][i % SIDE]);
    }
}

static void test_cells(void **state) {
    fixture *it = *state;
    for (int n = 0; n < 3000; n++) {
        make_cells(it);
        make_pieces(it);
        assert_int_equal(camber_osm_assemble(&it->rings, it->pieces, it->piece_count, true), CAMBER_OK);
        expect_cells(it);
    }
    assert_true(it->rings.steps > 0);
}

/* Ways that go somewhere and back, which bound nothing. */
static void test_spikes(void **state) {
    fixture *it = *state;
    for (int n = 0; n < 1000; n++) {
        make_cells(it);
        for (int i = 0; i < 5; i++) {
            const uint32_t x = below(it, SIDE), y = below(it, SIDE);
            it->east[y][x] += 2;
            it->north[x][y] += 2;
        }
        make_pieces(it);
        assert_int_equal(camber_osm_assemble(&it->rings, it->pieces, it->piece_count, true), CAMBER_OK);
        expect_cells(it);
    }
}

static size_t count_role(const fixture *it, camber_osm_role role) {
    size_t count = 0;
    for (size_t r = 0; r < it->rings.ring_count; r++)
        count += it->rings.rings[r].role == role;
    return count;
}

/* Where rings cross, and where ways are missing, roles have the last word. */
static void test_roles(void **state) {
    fixture *it = *state;
    const uint64_t west[] = {corner(0, 0), corner(4, 0), corner(4, 4), corner(0, 4), corner(0, 0)};
    const uint64_t east[] = {corner(2, 2), corner(6, 2), corner(6, 6), corner(2, 6), corner(2, 2)};
    const uint64_t inside[] = {corner(1, 1), corner(2, 1), corner(1, 2), corner(1, 1)};
    camber_osm_piece pieces[] = {
        {west, 5, CAMBER_OSM_ROLE_OUTER}, {east, 5, CAMBER_OSM_ROLE_OUTER}, {inside, 4, CAMBER_OSM_ROLE_OUTER}};
    assert_int_equal(camber_osm_assemble(&it->rings, pieces, 3, true), CAMBER_OK);
    assert_int_equal(count_role(it, CAMBER_OSM_ROLE_OUTER), 2);
    assert_int_equal(camber_osm_assemble(&it->rings, pieces, 3, false), CAMBER_OK);
    assert_int_equal(count_role(it, CAMBER_OSM_ROLE_OUTER), 3);
    pieces[2].role = CAMBER_OSM_ROLE_INNER;
    assert_int_equal(camber_osm_assemble(&it->rings, pieces + 2, 1, true), CAMBER_OK);
    assert_int_equal(count_role(it, CAMBER_OSM_ROLE_OUTER), 1);
    /* Edges that cross where places come twice: the rings stay. */
    const uint64_t bow[] = {corner(0, 0), corner(4, 4), corner(4, 0), corner(0, 4), corner(0, 0)};
    const uint64_t fan[] = {corner(0, 0), corner(6, 1), corner(6, 2), corner(0, 0)};
    const camber_osm_piece crossing[] = {{bow, 5, CAMBER_OSM_ROLE_UNKNOWN}, {fan, 4, CAMBER_OSM_ROLE_OUTER}};
    assert_int_equal(camber_osm_assemble(&it->rings, crossing, 2, true), CAMBER_OK);
    assert_true(it->rings.ring_count >= 2);
    assert_int_equal(count_role(it, CAMBER_OSM_ROLE_UNKNOWN), 0);
    /* Nothing is left. */
    const uint64_t back[] = {corner(0, 0), corner(1, 0), corner(2, 1), corner(1, 0), corner(0, 0)},
                   point[] = {corner(1, 1), corner(1, 1)};
    const camber_osm_piece flat[] = {{back, 5, CAMBER_OSM_ROLE_OUTER}, {point, 2, CAMBER_OSM_ROLE_OUTER}};
    assert_int_equal(camber_osm_assemble(&it->rings, flat, 2, true), CAMBER_OK);
    assert_int_equal(it->rings.ring_count, 0);
}

/* The bound of looking for what lies in what is a file's, not a relation's: past it all rings without roles are outer
 * ones. */
static void test_bound(void **state) {
    fixture *it = *state;
    const uint64_t around[] = {corner(0, 0), corner(6, 0), corner(6, 6), corner(0, 6), corner(0, 0)};
    const uint64_t inside[] = {corner(1, 1), corner(2, 1), corner(1, 2), corner(1, 1)};
    const camber_osm_piece pieces[] = {{around, 5, CAMBER_OSM_ROLE_UNKNOWN}, {inside, 4, CAMBER_OSM_ROLE_UNKNOWN}};
    it->rings.steps = 0;
    size_t relations = 0;
    do {
        assert_int_equal(camber_osm_assemble(&it->rings, pieces, 2, false), CAMBER_OK);
        assert_int_equal(it->rings.ring_count, 2);
        if (relations++ == 0) {
            assert_true(it->rings.steps > 0 && count_role(it, CAMBER_OSM_ROLE_INNER) == 1);
            it->rings.steps *= ((size_t)1 << 28) / it->rings.steps; /* as many relations more, all but a few */
        }
    } while (count_role(it, CAMBER_OSM_ROLE_INNER) == 1 && relations < 100);
    assert_int_equal(count_role(it, CAMBER_OSM_ROLE_OUTER), 2);
    const size_t steps = it->rings.steps;
    assert_int_equal(camber_osm_assemble(&it->rings, pieces, 2, false), CAMBER_OK);
    assert_int_equal(it->rings.steps, steps);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_cells, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_spikes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_roles, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_bound, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
