/* Circle layers: pixels against the specification's formula for circles, computed in doubles one circle after another;
 * the order of circles, their corners of lines, and what a filter or a sort key makes of them. */
#include "map_picture.h"

#include <math.h>

enum { SIDE = 96 };

/* At zoom 4 a degree of longitude is 22.8 px, and one of latitude about as much. */
#define POINT(longitude, latitude, properties)                                                                         \
    "{\"type\": \"Feature\", \"properties\": {" properties                                                             \
    "}, \"geometry\": {\"type\": \"Point\", \"coordinates\": [" #longitude ", " #latitude "]}}"
#define FEATURES(...) "{\"type\": \"FeatureCollection\", \"features\": [" __VA_ARGS__ "]}"

static map open_map(fixture *s, const char *data, const char *layer, double pitch_deg) {
    camber_style *style = NULL;
    char json[4096];
    snprintf(
        json, sizeof json,
        "{\"version\": 8, \"zoom\": 4, \"pitch\": %g, \"sources\": {\"s\": {\"type\": \"geojson\", \"data\": %s}}, "
        "\"layers\": [{\"id\": \"c\", \"type\": \"circle\", \"source\": \"s\", %s}]}",
        pitch_deg, data, layer);
    if (camber_style_parse(s->context, json, strlen(json), "test", &style) != CAMBER_OK)
        fail_msg("%s", s->h.last);
    camber_scene_desc desc = {.view = camber_style_get_view(style)};
    desc.view.width = desc.view.height = SIDE;
    return map_open(s, style, &desc);
}

/* ---- The formula ---- */

/* A circle as the specification has it. Colours are straight, lengths in px, blur a share of the whole radius. */
typedef struct known_circle {
    double x, y, radius, stroke, blur;
    double fill[4], rim[4];
} known_circle;

static double smooth_step(double from, double to, double at) {
    const double t = fmin(fmax((at - from) / (to - from), 0), 1);
    return t * t * (3 - 2 * t);
}

/* Draws a circle over a premultiplied colour: it fades inwards from its whole radius, and its stroke from where that
 * begins, over the blur or a pixel. */
static void draw_circle(const known_circle *c, double x, double y, double color[4]) {
    const double whole = c->radius + c->stroke, fade = fmax(c->blur * whole, 1), r = hypot(x - c->x, y - c->y);
    const double shown = smooth_step(whole, whole - fade, r);
    const double rim = c->stroke > 0 ? smooth_step(c->radius - fade, c->radius, r) : 0;
    double over[4];
    for (int i = 0; i < 4; i++) {
        const double fill = c->fill[i] * (i < 3 ? c->fill[3] : 1), edge = c->rim[i] * (i < 3 ? c->rim[3] : 1);
        over[i] = shown * (fill + (edge - fill) * rim);
    }
    for (int i = 0; i < 4; i++)
        color[i] = over[i] + color[i] * (1 - over[3]);
}

/* The largest error of a pixel, and the mean of all. */
static void compare(const picture *p, const known_circle *circles, size_t count, const char *what, double most,
                    double mean) {
    double sum = 0, worst = 0;
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            double color[4] = {0, 0, 0, 0};
            for (size_t i = 0; i < count; i++)
                draw_circle(circles + i, x + 0.5, y + 0.5, color);
            for (int k = 0; k < 4; k++) {
                const double error = fabs(picture_value(p, x, y, k) - color[k]);
                sum += error / (4.0 * SIDE * SIDE);
                worst = fmax(worst, error);
            }
        }
    if (worst > most || sum > mean)
        fail_msg("%s: a pixel is %.3f off, and the mean is %.5f", what, worst, sum);
}

/* ---- One circle ---- */

static void test_circle(void **state) {
    fixture *s = *state;
    static const struct {
        const char *paint;
        known_circle circle;
        double most, mean; /* errors */
    } cases[] = {
        {"\"circle-radius\": 5", {.radius = 5, .fill = {0, 0, 0, 1}}, 0.2, 0.001},
        {"\"circle-radius\": 1", {.radius = 1, .fill = {0, 0, 0, 1}}, 0.3, 0.0002},
        {"\"circle-radius\": 0.6", {.radius = 0.6, .fill = {0, 0, 0, 1}}, 0.2, 0.0002},
        {"\"circle-radius\": 40, \"circle-color\": \"#f80\"",
         {.radius = 40, .fill = {1, 136 / 255.0, 0, 1}},
         0.2,
         0.002},
        {"\"circle-radius\": 20, \"circle-opacity\": 0.5", {.radius = 20, .fill = {0, 0, 0, 0.5}}, 0.1, 0.001},
        {"\"circle-radius\": 20, \"circle-blur\": 1", {.radius = 20, .blur = 1, .fill = {0, 0, 0, 1}}, 0.02, 0.001},
        {"\"circle-radius\": 8, \"circle-blur\": 0.3", {.radius = 8, .blur = 0.3, .fill = {0, 0, 0, 1}}, 0.05, 0.001},
        {"\"circle-radius\": 20, \"circle-blur\": 3", {.radius = 20, .blur = 3, .fill = {0, 0, 0, 1}}, 0.02, 0.001},
        {"\"circle-radius\": 10, \"circle-stroke-width\": 4, \"circle-color\": \"#fff\", \"circle-stroke-color\": "
         "\"#00f\"",
         {.radius = 10, .stroke = 4, .fill = {1, 1, 1, 1}, .rim = {0, 0, 1, 1}},
         0.2,
         0.002},
        {"\"circle-radius\": 10, \"circle-stroke-width\": 4, \"circle-opacity\": 0, \"circle-stroke-color\": \"#00f\"",
         {.radius = 10, .stroke = 4, .fill = {0, 0, 0, 0}, .rim = {0, 0, 1, 1}},
         0.2,
         0.002},
        {"\"circle-radius\": 10, \"circle-stroke-width\": 4, \"circle-opacity\": 0.6, \"circle-stroke-opacity\": 0.3",
         {.radius = 10, .stroke = 4, .fill = {0, 0, 0, 0.6}, .rim = {0, 0, 0, 0.3}},
         0.15,
         0.002},
        {"\"circle-radius\": 0, \"circle-stroke-width\": 7", {.stroke = 7, .rim = {0, 0, 0, 1}}, 0.2, 0.001},
        {"\"circle-radius\": 10, \"circle-stroke-width\": 0, \"circle-stroke-color\": \"#f00\"",
         {.radius = 10, .fill = {0, 0, 0, 1}},
         0.2,
         0.002},
        {"\"circle-radius\": 0", {.radius = 0}, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int place = 0; place < 2; place++) {
            char layer[512];
            snprintf(layer, sizeof layer, "\"paint\": {%s, \"circle-translate\": [%g, %g]}", cases[i].paint,
                     place ? 0.31 : 0, place ? -3.77 : 0);
            map m = open_map(s, FEATURES(POINT(0, 0, "")), layer, 0);
            picture p = map_draw(s, &m);
            known_circle circle = cases[i].circle;
            circle.x = SIDE / 2 + (place ? 0.31 : 0);
            circle.y = SIDE / 2 - (place ? 3.77 : 0);
            compare(&p, &circle, circle.radius + circle.stroke > 0, cases[i].paint, cases[i].most, cases[i].mean);
            picture_free(&p);
            map_close(&m);
        }
}

/* ---- Several circles ---- */

#define THREE                                                                                                          \
    FEATURES(POINT(-0.3, 0, "\"c\": \"#f00\", \"r\": 12, \"k\": 3") "," POINT(                                         \
        0, 0.3, "\"c\": \"#0f0\", \"r\": 9, \"k\": 1") "," POINT(0.3, 0, "\"c\": \"#00f\", \"r\": 10, \"k\": 2"))
#define DRIVEN "\"circle-color\": [\"get\", \"c\"], \"circle-radius\": [\"get\", \"r\"], \"circle-stroke-width\": 3"

static const double degree_px = 512.0 * 16.0 / 360.0;

/* Each circle is drawn with its stroke over those before it, and translucent ones are seen through each other. */
static void test_order(void **state) {
    fixture *s = *state;
    static const double colors[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, radii[3] = {12, 9, 10};
    static const size_t orders[2][3] = {{0, 1, 2}, {1, 2, 0}}; /* of the source, and by the key */
    for (int sorted = 0; sorted < 2; sorted++)
        for (int translucent = 0; translucent < 2; translucent++) {
            char layer[512];
            snprintf(layer, sizeof layer, "%s\"paint\": {" DRIVEN "%s}",
                     sorted ? "\"layout\": {\"circle-sort-key\": [\"get\", \"k\"]}, " : "",
                     translucent ? ", \"circle-opacity\": 0.5, \"circle-stroke-opacity\": 0.75" : "");
            map m = open_map(s, THREE, layer, 0);
            picture p = map_draw(s, &m);
            known_circle known[3];
            for (size_t i = 0; i < 3; i++) {
                const size_t k = orders[sorted][i];
                known[i] = (known_circle){.x = SIDE / 2 + ((double)k - 1) * 0.3 * degree_px,
                                          .y = SIDE / 2 - (k == 1 ? 0.3 * degree_px : 0),
                                          .radius = radii[k],
                                          .stroke = 3,
                                          .fill = {colors[k][0], colors[k][1], colors[k][2], translucent ? 0.5 : 1},
                                          .rim = {0, 0, 0, translucent ? 0.75 : 1}};
            }
            compare(&p, known, 3, layer, 0.25, 0.003);
            picture_free(&p);
            map_close(&m);
        }
}

/* Corners of lines and of outlines have circles too, each of them, and where an outline ends a second one, as in other
 * engines; a filter may leave them out. */
static void test_corners(void **state) {
    fixture *s = *state;
    static const char data[] = "{\"type\": \"GeometryCollection\", \"geometries\": ["
                               "{\"type\": \"LineString\", \"coordinates\": [[-1, 0], [-0.5, 0], [0, 0], [1, 0]]},"
                               "{\"type\": \"Polygon\", \"coordinates\": [[[-1, 1], [1, 1], [0, 1.5], [-1, 1]]]},"
                               "{\"type\": \"MultiPoint\", \"coordinates\": [[-1, -1], [1, -1]]}]}";
    static const double places[] = {-1, 0, -0.5, 0, 0, 0, 1, 0, -1, 1, 1, 1, 0, 1.5, -1, 1, -1, -1, 1, -1};
    static const struct {
        const char *filter;
        size_t first, count;
    } cases[] = {{"", 0, 10},
                 {"\"filter\": [\"==\", \"$type\", \"LineString\"], ", 0, 4},
                 {"\"filter\": [\"==\", \"$type\", \"Polygon\"], ", 4, 4},
                 {"\"filter\": [\"==\", \"$type\", \"Point\"], ", 8, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char layer[256];
        known_circle known[10];
        snprintf(layer, sizeof layer, "%s\"paint\": {\"circle-radius\": 4}", cases[i].filter);
        map m = open_map(s, data, layer, 0);
        picture p = map_draw(s, &m);
        for (size_t k = 0; k < cases[i].count; k++) {
            const double *at = places + 2 * (cases[i].first + k), angle = at[1] * 3.14159265358979 / 180;
            known[k] = (known_circle){.x = SIDE / 2 + at[0] * degree_px,
                                      .y = SIDE / 2 - log(tan(3.14159265358979 / 4 + angle / 2)) * degree_px * 180 /
                                                          3.14159265358979,
                                      .radius = 4,
                                      .fill = {0, 0, 0, 1}};
        }
        compare(&p, known, cases[i].count, layer, 0.2, 0.003);
        picture_free(&p);
        map_close(&m);
    }
}

/* With a pitch circles lie on the map, as wide as their distance makes them. */
static void test_pitch(void **state) {
    fixture *s = *state;
    map m = open_map(s, FEATURES(POINT(0, 0, "")), "\"paint\": {\"circle-radius\": 20}", 60);
    picture p = map_draw(s, &m);
    uint32_t wide = 0, high = 0;
    for (uint32_t i = 0; i < SIDE; i++) {
        wide += picture_value(&p, i, SIDE / 2, 3) > 0.5;
        high += picture_value(&p, SIDE / 2, i, 3) > 0.5;
    }
    assert_in_range(wide, 38, 40);
    assert_in_range(high, 19, 21);
    picture_free(&p);
    map_close(&m);
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_circle), cmocka_unit_test(test_order),
                                       cmocka_unit_test(test_corners), cmocka_unit_test(test_pitch)};
    return cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
}
