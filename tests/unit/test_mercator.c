/* Web Mercator against values from outside this project. */
#include "features/mercator.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance))
        print_error("%.17g is not %.17g within %g\n", a, b, tolerance);
    assert_true(fabs(a - b) <= tolerance);
}

static void test_known_places(void **state) {
    (void)state;
    double x, y;
    camber_mercator_project(0, 0, &x, &y);
    near(x, 0.5, 0);
    near(y, 0.5, 1e-16);
    camber_mercator_project(-180, CAMBER_MERCATOR_LATITUDE, &x, &y);
    near(x, 0, 0);
    near(y, 0, 1e-15);
    camber_mercator_project(180, -CAMBER_MERCATOR_LATITUDE, &x, &y);
    near(x, 1, 0);
    near(y, 1, 1e-15);
    /* EPSG Guidance Note 7-2, 1024 "Popular Visualisation Pseudo-Mercator": 24 deg 22' 54.433" N, 100 deg 20' 0.000" W
     * is E -11169055.58 m, N 2800000.00 m. */
    camber_mercator_project(-(100 + 20 / 60.0), 24 + 22 / 60.0 + 54.433 / 3600.0, &x, &y);
    double map_x, map_y;
    camber_mercator_from_metres(-11169055.58, 2800000.00, &map_x, &map_y);
    near(x * 40075016.69, map_x * 40075016.69, 0.02);
    near(y * 40075016.69, map_y * 40075016.69, 0.02);
    /* OpenStreetMap wiki, "Slippy map tilenames": 51.51202 N, 0.02435 E is in tile 65544, 43582 of zoom 17. */
    camber_mercator_project(0.02435, 51.51202, &x, &y);
    assert_int_equal((int)floor(x * 131072), 65544);
    assert_int_equal((int)floor(y * 131072), 43582);
}

static void test_there_and_back(void **state) {
    (void)state;
    for (double latitude = -85; latitude <= 85; latitude += 0.37) {
        for (double longitude = -180; longitude <= 180; longitude += 7.3) {
            double x, y, back_longitude, back_latitude;
            camber_mercator_project(longitude, latitude, &x, &y);
            camber_mercator_unproject(x, y, &back_longitude, &back_latitude);
            near(back_longitude, longitude, 1e-13 * 180);
            /* y near 0 and 1 is steep: 1e-16 of it is 1e-14 degrees. */
            near(back_latitude, latitude, 1e-12);
        }
    }
}

/* Against the C library's functions; and many at once have the same bits as each by itself. */
static void test_many(void **state) {
    enum { COUNT = 1701 };
    static double longitudes[COUNT], latitudes[COUNT], points[2 * COUNT];
    const double pi = 3.14159265358979323846;
    (void)state;
    for (int i = 0; i < COUNT; i++) {
        longitudes[i] = (i - COUNT / 2) * 0.2109375;
        latitudes[i] = (i - COUNT / 2) * 0.05;
    }
    camber_mercator_project_many(longitudes, latitudes, COUNT, points);
    for (int i = 0; i < COUNT; i++) {
        double x, y;
        camber_mercator_project(longitudes[i], latitudes[i], &x, &y);
        near(points[2 * i], x, 0);
        near(points[2 * i + 1], y, 0);
        near(y, 0.5 - asinh(tan(latitudes[i] * (pi / 180.0))) / (2.0 * pi), 1e-15);
        near(points[2 * (COUNT - 1 - i) + 1] - 0.5, 0.5 - y, 2e-16);
    }
    static const double beyond[] = {90, -90, 91, -1000, NAN, INFINITY};
    for (size_t i = 0; i < sizeof beyond / sizeof *beyond; i++) {
        double x, y;
        camber_mercator_project(0, beyond[i], &x, &y);
        assert_true(isnan(y));
    }
}

/* A pixel at zoom 22 is 1 / (512 * 2^22) of the world; projection must be far finer. */
static void test_precision(void **state) {
    (void)state;
    const double pixel = 1 / (512.0 * 4194304.0);
    double x0, y0, x1, y1;
    camber_mercator_project(-122.03, 36.97, &x0, &y0);
    camber_mercator_project(-122.03 + 360 * pixel / 16, 36.97, &x1, &y1);
    near((x1 - x0) / pixel, 1.0 / 16, 1e-4);
    near(y1, y0, 0);
}

static void test_metres(void **state) {
    (void)state;
    double x, y;
    camber_mercator_from_metres(0, 0, &x, &y);
    near(x, 0.5, 0);
    near(y, 0.5, 0);
    camber_mercator_from_metres(-20037508.342789244, 20037508.342789244, &x, &y);
    near(x, 0, 1e-15);
    near(y, 0, 1e-15);
}

static void test_wrap(void **state) {
    (void)state;
    near(camber_mercator_wrap(0), 0, 0);
    near(camber_mercator_wrap(1), 1, 0);
    near(camber_mercator_wrap(0.25), 0.25, 0);
    near(camber_mercator_wrap(1.25), 0.25, 0);
    near(camber_mercator_wrap(-0.25), 0.75, 0);
    near(camber_mercator_wrap(-3.25), 0.75, 0);
    assert_true(camber_mercator_wrap(-1e-300) <= 1);
    assert_true(isnan(camber_mercator_wrap(NAN)));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_places), cmocka_unit_test(test_there_and_back), cmocka_unit_test(test_precision),
        cmocka_unit_test(test_metres),       cmocka_unit_test(test_wrap),           cmocka_unit_test(test_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
