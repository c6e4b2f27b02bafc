/* Triangles of areas: they cover what rings wind around, each place once. Random rings on a coarse grid touch, overlap
 * and cross themselves in all ways; points beside the grid are looked up in the rings and in the triangles. */
#include "map/triangulator.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { MOST_POINTS = 4096, UNIT = 128 };

typedef struct fixture {
    camber_context *context;
    camber_triangulator *triangulator;
    camber_ring_window window;
    float points[2 * MOST_POINTS]; /* px */
    size_t first[512];             /* ring_count + 1 */
    size_t ring_count;
    camber_triangles made;
    uint32_t random;
} fixture;

static int set_up(void **state) {
    static fixture f;
    f = (fixture){.window = {.half_width = 100.0f, .half_height = 100.0f, .units = UNIT}, .random = 1};
    assert_int_equal(camber_context_create(NULL, &f.context), CAMBER_OK);
    assert_int_equal(camber_triangulator_create(f.context, &f.triangulator), CAMBER_OK);
    *state = &f;
    return 0;
}

static int tear_down(void **state) {
    fixture *f = *state;
    camber_triangulator_destroy(f->triangulator);
    camber_context_destroy(f->context);
    return 0;
}

static uint32_t draw(fixture *f, uint32_t below) {
    f->random = f->random * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)(f->random >> 8) * below >> 24);
}

/* ---- Rings ---- */

static void begin(fixture *f) {
    f->ring_count = 0;
    f->first[0] = 0;
}

static void add(fixture *f, float x, float y) {
    const size_t at = f->first[f->ring_count + 1];
    assert_true(at < MOST_POINTS);
    f->points[2 * at] = x;
    f->points[2 * at + 1] = y;
    f->first[f->ring_count + 1] = at + 1;
}

static void open_ring(fixture *f) {
    f->first[f->ring_count + 1] = f->first[f->ring_count];
}

static void close_ring(fixture *f) {
    const float *start = f->points + 2 * f->first[f->ring_count];
    add(f, start[0], start[1]);
    f->ring_count++;
}

static void add_square(fixture *f, float x, float y, float side, bool hole) {
    open_ring(f);
    add(f, x, y);
    add(f, hole ? x : x + side, hole ? y + side : y);
    add(f, x + side, y + side);
    add(f, hole ? x + side : x, hole ? y : y + side);
    close_ring(f);
}

static void fill(fixture *f) {
    for (size_t i = 0; i < f->ring_count; i++)
        assert_int_equal(camber_triangulator_add(f->triangulator, f->points + 2 * f->first[i],
                                                 f->first[i + 1] - f->first[i], &f->window),
                         CAMBER_OK);
    assert_int_equal(camber_triangulator_fill(f->triangulator, &f->made), CAMBER_OK);
    assert_int_equal(f->made.index_count % 3, 0);
}

/* ---- Places ---- */

static double cross(double ax, double ay, double bx, double by, double x, double y) {
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax);
}

/* How often rings wind around a place in px; near: whether an edge is within some px. */
static int winding(const fixture *f, double x, double y, double px, bool *near) {
    int turns = 0;
    for (size_t r = 0; r < f->ring_count; r++)
        for (size_t i = f->first[r]; i + 1 < f->first[r + 1]; i++) {
            const double ax = (double)f->points[2 * i], ay = (double)f->points[2 * i + 1],
                         bx = (double)f->points[2 * i + 2], by = (double)f->points[2 * i + 3];
            const double side = cross(ax, ay, bx, by, x, y), dx = bx - ax, dy = by - ay, length = dx * dx + dy * dy;
            const double along = length > 0.0 ? fmin(fmax(((x - ax) * dx + (y - ay) * dy) / length, 0.0), 1.0) : 0.0;
            if (hypot(x - ax - along * dx, y - ay - along * dy) < px)
                *near = true;
            if ((ay <= y) != (by <= y) && (side > 0.0) == (by > ay))
                turns += by > ay ? 1 : -1;
        }
    return turns;
}

/* How many triangles have a place in px inside. */
static int count_triangles(const camber_triangles *made, double x, double y) {
    int count = 0;
    for (size_t i = 0; i < made->index_count; i += 3) {
        const camber_corner a = made->corners[made->indices[i]], b = made->corners[made->indices[i + 1]],
                            c = made->corners[made->indices[i + 2]];
        const double ux = UNIT * x, uy = UNIT * y;
        count += cross(a.x, a.y, b.x, b.y, ux, uy) < 0.0 && cross(b.x, b.y, c.x, c.y, ux, uy) < 0.0 &&
                 cross(c.x, c.y, a.x, a.y, ux, uy) < 0.0;
    }
    return count;
}

static bool differs(const fixture *f, double x, double y, double slack) {
    bool near = false;
    const bool inside = winding(f, x, y, slack, &near) != 0;
    return !near && count_triangles(&f->made, x, y) != (inside ? 1 : 0);
}

/* Compares places of a square from 0 to side; those within `slack` px of an edge may be either. Where crossings were
 * rounded, triangles may overlap by a unit, so a place that differs must do so two units away, too. */
static void check_places(const fixture *f, double side, double step, double slack) {
    for (double y = 0.3719273 * step; y < side; y += step)
        for (double x = 0.4137141 * step; x < side; x += step)
            if (differs(f, x, y, slack) && (slack <= 0.0 || differs(f, x + 2.0 / UNIT, y + 1.0 / UNIT, slack)))
                fail_msg("%g, %g: %d triangles, %zu rings", x, y, count_triangles(&f->made, x, y), f->ring_count);
}

static double area_of(const camber_triangles *made) {
    double area = 0.0;
    for (size_t i = 0; i < made->index_count; i += 3) {
        const camber_corner a = made->corners[made->indices[i]], b = made->corners[made->indices[i + 1]],
                            c = made->corners[made->indices[i + 2]];
        const double own = -0.5 * cross(a.x, a.y, b.x, b.y, c.x, c.y);
        area += own;
    }
    return area / (UNIT * UNIT);
}

/* ---- The tests ---- */

static void test_squares(void **state) {
    fixture *f = *state;
    begin(f);
    add_square(f, 1, 1, 4, false);
    fill(f);
    assert_int_equal(f->made.index_count, 6);
    assert_int_equal(f->made.corner_count, 4);
    begin(f);
    add_square(f, 1, 1, 8, false);
    add_square(f, 3, 3, 2, true);
    add_square(f, 7, 7, 4, false);  /* overlaps by 4 */
    add_square(f, 9, 1, 4, false);  /* beside the first */
    add_square(f, 20, 20, 2, true); /* wound the other way */
    add_square(f, 30, 20, 2, false);
    add_square(f, 30, 20, 2, false); /* twice */
    fill(f);
    assert_true(fabs(area_of(&f->made) - (64 - 4 + 16 - 4 + 16 + 4 + 4)) < 1e-9);
    check_places(f, 40, 0.5, 0.0);
}

/* Nothing comes of what has no area, and of no rings. */
static void test_nothing(void **state) {
    fixture *f = *state;
    begin(f);
    fill(f);
    assert_int_equal(f->made.index_count, 0);
    open_ring(f);
    add(f, 1, 1);
    add(f, 9, 1);
    add(f, 5, 1);
    add(f, 5, 1.001f);
    close_ring(f);
    open_ring(f);
    add(f, 3, 3);
    close_ring(f);
    open_ring(f);
    add(f, 300, 3);
    add(f, 400, 3);
    add(f, 300, 50);
    close_ring(f);
    fill(f);
    assert_int_equal(f->made.index_count, 0);
    assert_int_equal(f->made.corner_count, 0);
}

/* A ring is cut at the window; one around it covers all of it with two triangles. */
static void test_window(void **state) {
    fixture *f = *state;
    const camber_ring_window whole = f->window;
    f->window =
        (camber_ring_window){.centre_x = 8.0, .centre_y = 4.0, .half_width = 8.0f, .half_height = 4.0f, .units = UNIT};
    begin(f);
    add_square(f, -500, -300, 999, false);
    fill(f);
    assert_int_equal(f->made.index_count, 6);
    assert_true(fabs(area_of(&f->made) - 16 * 8) < 1e-9);
    begin(f);
    add_square(f, 12, -2, 8, false);
    fill(f);
    assert_true(fabs(area_of(&f->made) - 4 * 6) < 1e-9);
    for (size_t i = 0; i < f->made.corner_count; i++)
        assert_true(f->made.corners[i].x >= 4 * UNIT && f->made.corners[i].x <= 8 * UNIT &&
                    f->made.corners[i].y >= -4 * UNIT && f->made.corners[i].y <= 2 * UNIT);
    f->window = whole;
}

static void add_ring(fixture *f, const float (*points)[2], size_t count) {
    open_ring(f);
    for (size_t i = 0; i < count; i++)
        add(f, points[i][0], points[i][1]);
    close_ring(f);
}

/* Rings that touch at one place alone: inside of one another, or beside. */
static void test_touching(void **state) {
    fixture *f = *state;
    static const float bent[][2] = {{0, 0}, {8, 0}, {8, 8}, {4, 8}, {4, 4}, {0, 4}};
    static const float inside[][3][2] = {
        {{6, 2}, {6, 6}, {2, 2}}, /* a side at the inner corner */
        {{4, 4}, {1, 3}, {3, 1}}, /* a corner there */
        {{0, 0}, {3, 1}, {1, 3}}, /* in an outer corner */
        {{4, 0}, {5, 2}, {3, 2}}, /* at a side */
    };
    static const float beside[][3][2] = {{{4, 4}, {3, 6}, {2, 5}}, {{8, 0}, {9, 2}, {9, 1}}, {{0, 4}, {1, 6}, {0, 6}}};
    for (size_t i = 0; i < 4; i++)
        for (size_t order = 0; order < 2; order++) {
            begin(f);
            if (order)
                add_ring(f, inside[i], 3);
            add_ring(f, bent, 6);
            if (!order)
                add_ring(f, inside[i], 3);
            fill(f);
            assert_true(fabs(area_of(&f->made) - 48.0) < 1e-9);
            check_places(f, 8.0, 0.25, 0.0);
        }
    for (size_t i = 0; i < 3; i++) {
        begin(f);
        add_ring(f, bent, 6);
        add_ring(f, beside[i], 3);
        fill(f);
        assert_int_equal(f->made.index_count, 15);
        check_places(f, 10.0, 0.25, 0.0);
    }
}

/* Rings of a few points of a coarse grid: they share corners and sides, and cross. */
static void test_random(void **state) {
    fixture *f = *state;
    for (uint32_t n = 0; n < 16000; n++) {
        const uint32_t grid = 3 + n % 4;
        begin(f);
        for (uint32_t rings = 1 + draw(f, 3); rings; rings--) {
            open_ring(f);
            for (uint32_t points = 3 + draw(f, n % 16 ? 4 : 9); points; points--)
                add(f, (float)draw(f, grid), (float)draw(f, grid));
            close_ring(f);
        }
        fill(f);
        check_places(f, grid - 1, 0.25, 2.0 / UNIT);
    }
}

/* Stars around a place do not cross themselves: their area is known, and so is the count of their triangles. */
static void test_stars(void **state) {
    fixture *f = *state;
    for (int n = 0; n < 600; n++) {
        const uint32_t points = 3 + draw(f, n % 8 ? 40 : 400);
        const double turn = 2.0 * acos(-1.0) / points;
        double area = 0.0;
        begin(f);
        open_ring(f);
        for (uint32_t i = 0; i < points; i++) {
            const double far = 4.0 + draw(f, 400) / 10.0, at = (n % 2 ? i : points - i) * turn;
            add(f, (float)(floor((50.0 + far * cos(at)) * UNIT) / UNIT),
                (float)(floor((50.0 + far * sin(at)) * UNIT) / UNIT));
        }
        close_ring(f);
        for (size_t i = 0; i < points; i++) {
            const float *p = f->points + 2 * i;
            area += 0.5 * ((double)p[0] * (double)p[3] - (double)p[2] * (double)p[1]);
        }
        fill(f);
        if (points < 100)
            assert_true(fabs(area_of(&f->made) - fabs(area)) < 1e-6);
        check_places(f, 100.0, 7.0, points < 100 ? 0.0 : 2.0 / UNIT);
    }
}

/* Streets of houses, turned, which share walls. */
static void test_streets(void **state) {
    fixture *f = *state;
    for (int n = 0; n < 40; n++) {
        const double angle = 0.1 * n, c = cos(angle), s = sin(angle);
        begin(f);
        for (int i = 0; i < 36; i++) {
            static const float corners[][2] = {{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 4}, {0, 4}};
            const double x = 3.0 * (i % 6), y = 6.0 * (i / 6);
            open_ring(f);
            for (size_t k = 0; k < 6; k++) {
                const double px = x + (double)corners[k][0] - 9.0, py = y + (double)corners[k][1] - 18.0;
                add(f, (float)(floor((40.0 + c * px - s * py) * UNIT) / UNIT),
                    (float)(floor((40.0 + s * px + c * py) * UNIT) / UNIT));
            }
            close_ring(f);
        }
        fill(f);
        check_places(f, 80.0, 1.0, 2.0 / UNIT);
        assert_true(fabs(area_of(&f->made) - 360.0) < 4.0);
        assert_true(f->made.index_count >= 3 * 4 * 36 - 3 * 36 && f->made.index_count < 3 * 8 * 36);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_squares),  cmocka_unit_test(test_nothing), cmocka_unit_test(test_window),
        cmocka_unit_test(test_touching), cmocka_unit_test(test_random),  cmocka_unit_test(test_stars),
        cmocka_unit_test(test_streets),
    };
    if (!camber_triangulator_is_available()) {
        print_message("no GLU (Debian: libglu1-mesa)\n");
        return 77;
    }
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
