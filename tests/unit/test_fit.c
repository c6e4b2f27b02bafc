/* Views that are fitted to features: of extracts, on both sides of a meridian, and of next to nothing. */
#include "town.h"

#include "map/plan.h"

static const char lines_layer[] = "{\"id\":\"lines\",\"type\":\"line\",\"paint\":{\"line-width\":1}}";

/* Adds lines, 2 px long, in a square of 20 px. */
static void add_lines(town *t, uint32_t class, double x, double y, size_t count) {
    uint32_t seed = 1;
    for (size_t i = 0; i < count; i++) {
        const double at[2] = {x + 18.0 * next_share(&seed), y + 20.0 * next_share(&seed)};
        add_polyline(t, class, true, (const double[]){at[0], at[1], at[0] + 2.0, at[1]}, 2);
    }
    t->features.extract_end = t->features.polyline_count;
}

/* Adds a line from a point to one at its right. */
static void add_line(town *t, uint32_t class, double x, double y, double width) {
    add_polyline(t, class, true, (const double[]){x, y, x + width, y}, 2);
    t->features.extract_end = t->features.polyline_count;
}

static void fit(town *t) {
    camber_plan plan;
    see(t, (camber_view_desc){.kind = CAMBER_VIEW_FIT, .width = 400, .height = 400});
    assert_int_equal(camber_plan_fit(&t->features, &t->view, &plan), CAMBER_OK);
    camber_plan_destroy(&plan);
}

static bool sees(const town *t, double x, double y) {
    double at[2];
    camber_view_project(&t->view, x / WORLD, y / WORLD, at);
    return at[0] >= 0.0 && at[0] <= 400.0 && at[1] >= 0.0 && at[1] <= 400.0;
}

/* A line that reaches far beyond an extract is cut off, and lines near it are not. */
static void test_extract(void **state) {
    (void)state;
    town *t = open_town(lines_layer);
    const uint32_t class = add_class(t, CAMBER_GEOMETRY_LINE, "a");
    add_lines(t, class, 300.0, 500.0, 500);
    add_line(t, class, 310.0, 510.0, 200.0);
    add_line(t, class, 321.0, 510.0, 2.0);
    fit(t);
    assert_true(sees(t, 301.0, 501.0) && sees(t, 319.0, 519.0) && sees(t, 320.0, 510.0));
    assert_false(sees(t, 400.0, 510.0));
    close_town(t);
}

/* Few lines on the other side of a meridian are near all others, though they are in the other half of the world. */
static void test_meridians(void **state) {
    (void)state;
    for (int anti = 0; anti < 2; anti++)
        for (int east = 0; east < 2; east++) {
            town *t = open_town(lines_layer);
            const uint32_t class = add_class(t, CAMBER_GEOMETRY_LINE, "a");
            const double meridian = anti ? WORLD : WORLD / 2, wraps = anti && east ? WORLD : 0.0;
            const double far = meridian + (east ? -3.0 : 1.0) - (anti && !east ? WORLD : 0.0);
            add_lines(t, class, meridian + (east ? 0.0 : -20.0) - wraps, 500.0, 500);
            add_line(t, class, far, 510.0, 2.0);
            fit(t);
            const double seen_from = t->view.x > 1.0 || (anti && t->view.x > 0.5) ? WORLD : 0.0;
            assert_true(sees(t, anti && far < WORLD / 2 ? far + seen_from : far, 510.0));
            assert_true(t->view.zoom > 5.0);
            close_town(t);
        }
}

/* A point, the same line a thousand times, numbers that are none, nothing: the view is finite. */
static void test_little(void **state) {
    (void)state;
    for (int i = 0; i < 4; i++) {
        town *t = open_town(lines_layer);
        const uint32_t class = add_class(t, CAMBER_GEOMETRY_LINE, "a");
        for (size_t k = 0; k < (i == 1 ? 1000 : i == 3 ? 0 : 1); k++)
            add_line(t, class, i == 2 ? NAN : 300.0, i == 2 ? INFINITY : 500.0, i == 1 ? 1.0 : 0.0);
        fit(t);
        assert_true(isfinite(t->view.x) && isfinite(t->view.y) && isfinite(t->view.zoom));
        assert_true(i > 1 || sees(t, 300.0, 500.0));
        close_town(t);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_extract),
        cmocka_unit_test(test_meridians),
        cmocka_unit_test(test_little),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
