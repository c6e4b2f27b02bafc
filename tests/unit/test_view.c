/* Views of maps: fitted, centred and bounded, between longitude, latitude and pixels. */
#include "map/view.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const double CIRCUMFERENCE_M = 40075016.685578488; /* of EPSG:3857 */

typedef struct story {
    int lines;
    char last[512];
} story;

static void take_log(void *user, camber_log_level level, const char *message) {
    story *s = user;
    assert_int_equal(level, CAMBER_LOG_ERROR);
    s->lines++;
    snprintf(s->last, sizeof s->last, "%s", message);
}

static camber_context *make_context(story *s) {
    camber_context *context = NULL;
    *s = (story){0};
    assert_int_equal(
        camber_context_create(&(camber_context_desc){.log = take_log, .log_user = s, .cache_dir = ""}, &context),
        CAMBER_OK);
    return context;
}

static camber_view make_view(camber_view_desc desc) {
    story s;
    camber_context *context = make_context(&s);
    camber_view view;
    assert_int_equal(camber_view_create(context, &desc, &view), CAMBER_OK);
    assert_int_equal(s.lines, 0);
    camber_context_destroy(context);
    return view;
}

/* Degrees by the textbook, not by the code under test: Mercator's y is ln tan(pi/4 + lat/2). */
static void project(const camber_view *view, double longitude, double latitude, double *px) {
    const double pi = acos(-1.0);
    camber_view_project(view, (longitude + 180.0) / 360.0, 0.5 - log(tan(pi / 4 + latitude * pi / 360.0)) / (2 * pi),
                        px);
}

static void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.12g is not %.12g within %g", a, b, tolerance);
}

static void test_center(void **state) {
    (void)state;
    const camber_view view = make_view((camber_view_desc){.kind = CAMBER_VIEW_CENTER, .zoom = 1.0});
    assert_int_equal(view.width, 1024);
    assert_int_equal(view.height, 1024);
    double px[2];
    project(&view, -180.0, 0.0, px);
    assert_near(px[0], 0.0, 1e-9);
    assert_near(px[1], 512.0, 1e-9);
    project(&view, 90.0, -85.0511287798, px);
    assert_near(px[0], 768.0, 1e-9);
    assert_near(px[1], 1024.0, 1e-6);
    /* EPSG:3857 has 45 degrees north at 5621521.486192 m. */
    project(&view, 0.0, 45.0, px);
    assert_near(px[1], 512.0 - 1024.0 * 5621521.486192 / CIRCUMFERENCE_M, 1e-6);
}

static void test_size_and_ratio(void **state) {
    (void)state;
    const camber_view view = make_view((camber_view_desc){.kind = CAMBER_VIEW_CENTER,
                                                          .zoom = 3.0,
                                                          .longitude = 10.0,
                                                          .latitude = 50.0,
                                                          .width = 333,
                                                          .height = 200,
                                                          .ratio = 1.5});
    assert_int_equal(view.width, 500); /* 499.5 rounds up */
    assert_int_equal(view.height, 300);
    double centre[2], east[2];
    project(&view, 10.0, 50.0, centre);
    assert_near(centre[0], 250.0, 1e-9);
    assert_near(centre[1], 150.0, 1e-9);
    project(&view, 11.0, 50.0, east);
    assert_near(east[0] - centre[0], 512.0 * 8 * 1.5 / 360.0, 1e-9);
    double longitude, latitude;
    camber_view_center(&view, &longitude, &latitude);
    assert_near(longitude, 10.0, 1e-12);
    assert_near(latitude, 50.0, 1e-12);
}

static void test_bearing(void **state) {
    (void)state;
    camber_view view = make_view((camber_view_desc){.kind = CAMBER_VIEW_CENTER, .zoom = 4.0, .bearing_deg = 90.0});
    double px[2];
    project(&view, 1.0, 0.0, px); /* east is up, exactly */
    assert_true(px[0] == 512.0);
    assert_near(px[1], 512.0 - 512.0 * 16 / 360.0, 1e-9);
    view = make_view((camber_view_desc){.kind = CAMBER_VIEW_CENTER, .zoom = 4.0, .bearing_deg = -30.0});
    const double angle = -30.0 * acos(-1.0) / 180.0, far = 512.0 * 16 / 360.0;
    project(&view, 1.0, 0.0, px);
    assert_near(px[0], 512.0 + far * cos(angle), 1e-9);
    assert_near(px[1], 512.0 - far * sin(angle), 1e-9);
}

/* Every corner of the bbox lies inside, and the tighter side is filled. */
static void check_bbox(camber_view_desc desc, double east) {
    const camber_view view = make_view(desc);
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 4; i++) {
        double px[2];
        project(&view, i & 1 ? east : desc.west, i & 2 ? desc.north : desc.south, px);
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], px[k]);
            high[k] = fmax(high[k], px[k]);
        }
    }
    const double size[2] = {view.width, view.height};
    double fill = 0.0;
    for (int k = 0; k < 2; k++) {
        assert_true(low[k] > -1e-6 && high[k] < size[k] + 1e-6);
        assert_near(low[k] + high[k], size[k], 1e-6);
        fill = fmax(fill, (high[k] - low[k]) / size[k]);
    }
    assert_near(fill, 1.0, 1e-9);
}

static void test_bbox(void **state) {
    (void)state;
    camber_view_desc desc = {.kind = CAMBER_VIEW_BBOX, .west = -122.1, .south = 36.9, .east = -121.9, .north = 37.1};
    check_bbox(desc, desc.east);
    desc.bearing_deg = 33.0;
    desc.width = 700;
    desc.height = 300;
    desc.ratio = 2.0;
    check_bbox(desc, desc.east);
    desc = (camber_view_desc){
        .kind = CAMBER_VIEW_BBOX, .west = -180, .south = -85.051129, .east = 180, .north = 85.051129};
    check_bbox((camber_view_desc){.kind = CAMBER_VIEW_BBOX, .west = 176, .south = -20, .east = -178, .north = -12},
               182);
    double longitude, latitude;
    camber_view view =
        make_view((camber_view_desc){.kind = CAMBER_VIEW_BBOX, .west = 176, .south = -20, .east = -176, .north = -12});
    camber_view_center(&view, &longitude, &latitude);
    assert_near(fabs(longitude), 180.0, 1e-9);
    view = make_view(desc);
    assert_near(view.zoom, 1.0, 1e-6);
    desc.width = desc.height = 64; /* the world does not fit at zoom 0 */
    view = make_view(desc);
    assert_near(view.zoom, -3.0, 1e-6);
    assert_true(camber_view_style_zoom(&view) == 0.0);
    view = make_view((camber_view_desc){.kind = CAMBER_VIEW_BBOX, .west = 3, .south = 4, .east = 3, .north = 4});
    assert_true(view.zoom == 24.0);
}

static void test_frame_fills(void **state) {
    (void)state;
    camber_view view = make_view((camber_view_desc){.kind = CAMBER_VIEW_FIT, .width = 400, .height = 800});
    camber_view_frame(&view, (camber_box){0.25, 0.5, 0.26, 0.505}, 0.96, 22.0);
    double a[2], b[2];
    camber_view_project(&view, 0.25, 0.5, a);
    camber_view_project(&view, 0.26, 0.505, b);
    assert_near(a[0], 8.0, 1e-6);
    assert_near(b[0], 392.0, 1e-6);
    assert_near(a[1] + b[1], 800.0, 1e-6);
    camber_view_frame(&view, (camber_box){0.25, 0.5, 0.25, 0.5}, 0.96, 22.0);
    assert_true(view.zoom == 22.0);
}

/* No jitter: at zoom 22 a float of world coordinates would be 128 px off. */
static void test_precision_at_zoom_22(void **state) {
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        const camber_view view = make_view((camber_view_desc){.kind = CAMBER_VIEW_CENTER,
                                                              .zoom = 22.0,
                                                              .longitude = -122.0308,
                                                              .latitude = 36.9741,
                                                              .bearing_deg = turned ? 17.0 : 0.0});
        const double step = 0.1 / (512.0 * 4194304.0);
        double worst = 0.0;
        for (int i = -4000; i < 4000; i++) {
            double a[2], b[2];
            camber_view_project(&view, view.x + i * step, view.y + i * step, a);
            camber_view_project(&view, view.x + (i + 1) * step, view.y + i * step, b);
            const float fa[2] = {(float)a[0], (float)a[1]}, fb[2] = {(float)b[0], (float)b[1]};
            worst = fmax(worst, fabs(hypot((double)(fb[0] - fa[0]), (double)(fb[1] - fa[1])) - 0.1));
        }
        assert_true(worst < 1e-4);
    }
}

static void test_projected_box_holds_its_points(void **state) {
    (void)state;
    const camber_view view = make_view((camber_view_desc){
        .kind = CAMBER_VIEW_CENTER, .zoom = 10.0, .longitude = 7.0, .latitude = 47.0, .bearing_deg = 128.0});
    const camber_box world = {view.x - 1e-3, view.y - 2e-4, view.x + 5e-4, view.y + 7e-4};
    const camber_box px = camber_view_project_box(&view, world);
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 4; i++) {
        double corner[2];
        camber_view_project(&view, i & 1 ? world.x1 : world.x0, i & 2 ? world.y1 : world.y0, corner);
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], corner[k]);
            high[k] = fmax(high[k], corner[k]);
        }
    }
    assert_near(px.x0, low[0], 1e-9);
    assert_near(px.y0, low[1], 1e-9);
    assert_near(px.x1, high[0], 1e-9);
    assert_near(px.y1, high[1], 1e-9);
}

/* The plane that a tilted camera sees: narrower than the picture at the bottom, wider at the top, and no farther than
 * 6.7 times the distance of the centre. */
static void test_pitch(void **state) {
    (void)state;
    for (int i = 0; i < 3; i++) {
        const double pitch_deg = i == 0 ? 0 : i == 1 ? 60 : 85, angle = pitch_deg * 3.14159265358979323846 / 180;
        const camber_view view = make_view((camber_view_desc){
            .kind = CAMBER_VIEW_CENTER, .zoom = 12.0, .pitch_deg = pitch_deg, .width = 600, .height = 400});
        double corners[8];
        camber_view_corners(&view, corners);
        for (int k = 0; k < 4; k++) {
            const double x = (corners[2 * k] - view.x) * view.scale_px,
                         y = (corners[2 * k + 1] - view.y) * view.scale_px;
            const double depth = 1 - y * sin(angle) / 600; /* the camera is 1.5 times the picture's height away */
            const double right = k == 1 || k == 2 ? 300 : -300, below = k > 1 ? 200 : -200;
            assert_near(x / depth, right, 1e-6);
            if (i < 2 || k > 1) {
                assert_near(y * cos(angle) / depth, below, 1e-6);
            } else {
                assert_near(depth, 1.01 / 0.15, 1e-6);
            }
        }
    }
}

static void test_bad_arguments(void **state) {
    (void)state;
    const camber_view_desc bad[] = {
        {.width = 65536},
        {.width = 40000, .ratio = 2.0},
        {.width = 65535, .height = 65535},
        {.width = 1, .ratio = 0.3},
        {.ratio = -1.0},
        {.ratio = NAN},
        {.ratio = INFINITY},
        {.bearing_deg = NAN},
        {.pitch_deg = NAN},
        {.pitch_deg = -1.0},
        {.pitch_deg = 85.1},
        {.kind = CAMBER_VIEW_CENTER, .zoom = -0.5},
        {.kind = CAMBER_VIEW_CENTER, .zoom = 24.1},
        {.kind = CAMBER_VIEW_CENTER, .zoom = NAN},
        {.kind = CAMBER_VIEW_CENTER, .latitude = 85.06},
        {.kind = CAMBER_VIEW_CENTER, .latitude = -90.0},
        {.kind = CAMBER_VIEW_CENTER, .longitude = INFINITY},
        {.kind = CAMBER_VIEW_BBOX, .west = NAN, .east = 1, .north = 1},
        {.kind = CAMBER_VIEW_BBOX, .west = 0, .east = 1, .south = 2, .north = 1},
        {.kind = CAMBER_VIEW_BBOX, .west = 0, .east = 1, .south = -86, .north = 1},
        {.kind = CAMBER_VIEW_BBOX, .west = -200, .east = 200, .north = 1},
        {.kind = CAMBER_VIEW_BBOX, .west = 300, .east = -300, .north = 1},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        story s;
        camber_context *context = make_context(&s);
        camber_view view = {.zoom = 77.0};
        assert_int_equal(camber_view_create(context, bad + i, &view), CAMBER_ERROR_ARGUMENT);
        assert_int_equal(s.lines, 1);
        assert_non_null(strstr(s.last, "; ")); /* the cure */
        assert_true(view.zoom == 77.0);
        camber_context_destroy(context);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_center),
        cmocka_unit_test(test_size_and_ratio),
        cmocka_unit_test(test_bearing),
        cmocka_unit_test(test_pitch),
        cmocka_unit_test(test_bbox),
        cmocka_unit_test(test_frame_fills),
        cmocka_unit_test(test_precision_at_zoom_22),
        cmocka_unit_test(test_projected_box_holds_its_points),
        cmocka_unit_test(test_bad_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
