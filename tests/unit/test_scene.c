/* Scenes: features under a view become polylines, rows, strokes, fills and networks. */
#include "camber_map.h"
#include "camber_network.h"
#include "features/features.h"
#include "map/plan_network.h"
#include "style/style.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* ---- Features by hand: one property, "kind" ---- */

enum { MOST = 4096, CLASSES = 60 };

typedef struct town {
    camber_context *context;
    camber_style *style;
    camber_features features;
    double points[2 * MOST];
    size_t offsets[MOST];
    uint32_t polyline_feature[MOST], feature_counts[MOST], feature_class[MOST];
    camber_feature_class classes[CLASSES];
    camber_value values[64];
    char *layer_names[2];
    char layer_text[2][16];
    int errors, warnings;
    char last[512];
} town;

static void take_log(void *user, camber_log_level level, const char *message) {
    town *t = user;
    t->errors += level == CAMBER_LOG_ERROR;
    t->warnings += level == CAMBER_LOG_WARNING;
    snprintf(t->last, sizeof t->last, "%s", message);
}

static size_t kind_index(const town *t) {
    size_t i = 0;
    while (i < t->style->schema.property_count && strcmp(t->style->schema.properties[i], "kind") != 0)
        i++;
    return i;
}

static void open_town(town *t, const char *layers) {
    memset(t, 0, sizeof *t);
    assert_int_equal(
        camber_context_create(&(camber_context_desc){.log = take_log, .log_user = t, .cache_dir = ""}, &t->context),
        CAMBER_OK);
    char json[4096];
    const int length = snprintf(json, sizeof json, "{\"version\":8,\"sources\":{},\"layers\":[%s]}", layers);
    assert_int_equal(camber_style_parse(t->context, json, (size_t)length, "test", &t->style), CAMBER_OK);
    strcpy(t->layer_text[0], "roads");
    strcpy(t->layer_text[1], "rails");
    t->layer_names[0] = t->layer_text[0];
    t->layer_names[1] = t->layer_text[1];
    t->features = (camber_features){.context = t->context,
                                    .style = t->style,
                                    .points = t->points,
                                    .offsets = t->offsets,
                                    .polyline_feature = t->polyline_feature,
                                    .feature_counts = t->feature_counts,
                                    .feature_class = t->feature_class,
                                    .classes = t->classes,
                                    .values = t->values,
                                    .layer_names = t->layer_names,
                                    .layer_count = 2};
}

static void close_town(town *t) {
    camber_style_destroy(t->style);
    camber_context_destroy(t->context);
}

static uint32_t add_class(town *t, const char *kind, uint32_t layer) {
    const size_t width = t->style->schema.property_count, c = t->features.class_count++;
    t->classes[c] = (camber_feature_class){.source = CAMBER_NO_SOURCE, .layer = layer, .first_value = c * width};
    assert_true((c + 1) * width <= sizeof t->values / sizeof *t->values);
    if (kind_index(t) < width)
        t->values[c * width + kind_index(t)] = (camber_value){.type = CAMBER_VALUE_STRING, .string = kind};
    return (uint32_t)c;
}

/* A feature of one polyline, in world coordinates. */
static void add_line(town *t, uint32_t class, const double *points, size_t count) {
    camber_features *f = &t->features;
    if (count)
        memcpy(t->points + 2 * f->point_count, points, 2 * count * sizeof *points);
    f->point_count += count;
    t->offsets[f->polyline_count + 1] = f->point_count;
    t->feature_counts[f->polyline_count] = 1;
    t->polyline_feature[f->polyline_count++] = (uint32_t)f->feature_count;
    t->feature_class[f->feature_count++] = class;
}

/* At zoom 1 and 1024 x 1024 around 0, 0 the world fills the picture: world = px / 1024. */
static void add_px(town *t, uint32_t class, const double *px, size_t count) {
    double points[2 * 64];
    for (size_t i = 0; i < 2 * count; i++)
        points[i] = px[i] / 1024.0;
    add_line(t, class, points, count);
}

static const camber_view_desc WORLD = {.kind = CAMBER_VIEW_CENTER, .zoom = 1.0};

static camber_scene *make_scene(town *t, camber_view_desc view) {
    camber_scene *scene = NULL;
    const camber_scene_desc desc = {.view = view};
    if (camber_scene_create(&t->features, &desc, &scene) != CAMBER_OK || camber_scene_project(scene) != CAMBER_OK)
        fail_msg("%s", t->last);
    return scene;
}

static camber_frame frame_of(camber_scene *scene) {
    return camber_scene_get_frame(scene, NULL);
}

static void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.9g is not %.9g within %g", a, b, tolerance);
}

#define LINE(id, filter, color, width)                                                                                 \
    "{\"id\":\"" id "\",\"type\":\"line\",\"filter\":" filter ",\"paint\":{\"line-color\":\"" color                    \
    "\",\"line-width\":" width "}}"
#define KIND(kind) "[\"==\",[\"get\",\"kind\"],\"" kind "\"]"
#define BACKGROUND(id, color)                                                                                          \
    "{\"id\":\"" id "\",\"type\":\"background\",\"paint\":{\"background-color\":\"" color "\"}}"

static double width_in(const camber_frame *frame, size_t pass, size_t row) {
    const camber_pass *p = frame->passes + pass;
    return row < p->paint_count ? (double)p->paints[row].width_px : 0.0;
}

/* ---- Passes ---- */

static void test_casings_and_fills_are_two_passes(void **state) {
    (void)state;
    town t;
    open_town(&t,
              BACKGROUND("land", "#ff0000") "," LINE("minor case", KIND("minor"), "#000", "8") "," LINE(
                  "major case", KIND("major"), "#000",
                  "12") "," LINE("minor", KIND("minor"), "#0f0", "6") "," LINE("major", KIND("major"), "#00f", "9"));
    const uint32_t major = add_class(&t, "major", 0), minor = add_class(&t, "minor", 0), other = add_class(&t, "x", 0);
    add_px(&t, major, (double[]){100, 100, 200, 100}, 2);
    add_px(&t, minor, (double[]){100, 200, 200, 200}, 2);
    add_px(&t, other, (double[]){100, 300, 200, 300}, 2);
    add_px(&t, major, (double[]){100, 400, 200, 400, 250, 450}, 3);
    camber_view_desc view = WORLD;
    view.ratio = 1.5;
    view.width = view.height = 1024;
    camber_scene *scene = make_scene(&t, view);
    const camber_scene_info info = camber_scene_get_info(scene);
    assert_int_equal(info.layers, 4);
    assert_int_equal(info.features, 3);
    assert_int_equal(info.polylines, 3);
    assert_int_equal(info.points, 7);
    assert_int_equal(info.points_in, 7);
    assert_int_equal(info.width, 1536);
    assert_true(info.opaque);

    /* Sets in the order of their first layers: minor, major; input order in a set. */
    const camber_lines *lines = camber_scene_get_lines(scene);
    const double wanted[7][2] = {{100, 200}, {200, 200}, {100, 100}, {200, 100}, {100, 400}, {200, 400}, {250, 450}};
    for (size_t i = 0; i < 7; i++) {
        assert_near((double)lines->points[2 * i], 1.5 * wanted[i][0], 1e-3);
        assert_near((double)lines->points[2 * i + 1], 1.5 * wanted[i][1], 1e-3);
    }
    assert_int_equal(lines->offsets[3], 7);
    assert_int_equal(camber_polylines_get_stats(camber_scene_get_polylines(scene)).kept_segments, 4);

    size_t stroke_count;
    const camber_stroke *strokes = camber_scene_get_strokes(scene, &stroke_count);
    assert_int_equal(stroke_count, 2);
    assert_near((double)strokes[0].width_px, 12, 1e-6);
    assert_near((double)strokes[1].width_px, 18, 1e-6);

    const camber_frame frame = frame_of(scene);
    assert_int_equal(frame.pass_count, 2);
    assert_true(frame.background.r == 1.0f && frame.background.g == 0.0f && frame.background.a == 1.0f);
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(frame.passes[i].first_polyline, 0);
        assert_int_equal(frame.passes[i].polyline_count, 3);
        assert_int_equal(frame.passes[i].paint_count, 2);
    }
    assert_near(width_in(&frame, 0, 0), 12, 1e-6);
    assert_near(width_in(&frame, 0, 1), 18, 1e-6);
    assert_near(width_in(&frame, 1, 0), 9, 1e-6);
    assert_near(width_in(&frame, 1, 1), 13.5, 1e-6);
    assert_true(frame.passes[1].paints[0].color.g == 1.0f && frame.passes[1].paints[1].color.b == 1.0f);
    camber_scene_destroy(scene);
    close_town(&t);
}

static void test_translucent_layers_stay_apart(void **state) {
    (void)state;
    town t;
    open_town(&t,
              LINE("a", KIND("a"), "rgba(0,0,0,0.5)", "8") "," LINE("b", KIND("b"), "rgba(0,0,0,0.5)", "8") "," LINE(
                  "c", KIND("c"), "#000", "8") "," LINE("d", KIND("d"), "#fff", "8") "," LINE("none", KIND("c"),
                                                                                              "rgba(0,0,0,0)", "30"));
    for (int i = 0; i < 4; i++)
        add_px(&t, add_class(&t, (const char *[]){"a", "b", "c", "d"}[i], 0),
               (double[]){100, 100 + 20 * i, 200, 100 + 20 * i}, 2);
    camber_scene *scene = make_scene(&t, WORLD);
    const camber_frame frame = frame_of(scene);
    assert_int_equal(frame.pass_count, 3);
    assert_int_equal(frame.passes[2].first_polyline, 2);
    assert_int_equal(frame.passes[2].polyline_count, 2);
    assert_int_equal(camber_scene_get_info(scene).layers, 4); /* a transparent layer draws nothing */
    assert_false(camber_scene_get_info(scene).opaque);
    size_t count;
    assert_near((double)camber_scene_get_strokes(scene, &count)[2].width_px, 8, 0); /* and widens nothing */
    camber_scene_destroy(scene);
    close_town(&t);
}

/* Rows by class: two widths in one layer, and a class that both layers paint alike shares its row with another. */
static void test_rows_follow_data(void **state) {
    (void)state;
    town t;
    open_town(
        &t, "{\"id\":\"all\",\"type\":\"line\",\"paint\":{\"line-width\":[\"match\",[\"get\",\"kind\"],\"a\",4,\"n\",0,"
            "9],\"line-color\":\"#123456\"}}");
    const uint32_t a = add_class(&t, "a", 0), b = add_class(&t, "b", 0), c = add_class(&t, "c", 1),
                   n = add_class(&t, "n", 0);
    const uint32_t classes[] = {b, a, n, c, a};
    for (int i = 0; i < 5; i++)
        add_px(&t, classes[i], (double[]){100, 100 + 20 * i, 200, 100 + 20 * i}, 2);
    camber_scene *scene = make_scene(&t, WORLD);
    size_t count;
    const camber_stroke *strokes = camber_scene_get_strokes(scene, &count);
    assert_int_equal(count, 2);
    assert_int_equal(camber_scene_get_info(scene).polylines, 4); /* a width of 0 draws nothing */
    assert_near((double)strokes[0].width_px + (double)strokes[1].width_px, 13, 1e-6);
    const camber_frame frame = frame_of(scene);
    assert_int_equal(frame.pass_count, 1);
    for (size_t row = 0; row < 2; row++)
        assert_near(width_in(&frame, 0, row), (double)strokes[row].width_px, 0);
    const double wanted_y[] = {100, 120, 160, 180};
    for (size_t i = 0; i < 4; i++)
        assert_near((double)camber_scene_get_lines(scene)->points[4 * i + 1], wanted_y[i], 1e-3);
    camber_scene_destroy(scene);
    close_town(&t);
}

/* As many rows as widths, however their hashes fall. */
static void test_rows_are_distinct(void **state) {
    (void)state;
    town t;
    open_town(&t, "{\"id\":\"all\",\"type\":\"line\",\"paint\":{\"line-width\":[\"to-number\",[\"get\",\"kind\"]]}}");
    for (int i = 0; i < CLASSES; i++) {
        const uint32_t c = add_class(&t, "", 0);
        t.values[c] = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = i + 1};
        add_px(&t, c, (double[]){100, 100, 200, 100}, 2);
    }
    camber_scene *scene = make_scene(&t, WORLD);
    size_t count;
    const camber_stroke *strokes = camber_scene_get_strokes(scene, &count);
    assert_int_equal(count, CLASSES);
    for (size_t i = 0; i < CLASSES; i++)
        assert_near((double)strokes[i].width_px, (double)i + 1, 0);
    camber_scene_destroy(scene);
    close_town(&t);
}

static void test_source_layers_zooms_and_caps(void **state) {
    (void)state;
    town t;
    open_town(
        &t, "{\"id\":\"a\",\"type\":\"line\",\"source\":\"s\",\"source-layer\":\"rails\",\"paint\":{\"line-width\":2}},"
            "{\"id\":\"b\",\"type\":\"line\",\"minzoom\":1.5,\"paint\":{\"line-width\":3}},"
            "{\"id\":\"c\",\"type\":\"line\",\"maxzoom\":1,\"paint\":{\"line-width\":4}},"
            "{\"id\":\"d\",\"type\":\"line\",\"layout\":{\"visibility\":\"none\"}},"
            "{\"id\":\"e\",\"type\":\"line\",\"layout\":{\"line-cap\":\"square\",\"line-join\":\"bevel\"},"
            "\"paint\":{\"line-width\":1e9}},"
            "{\"id\":\"f\",\"type\":\"line\",\"layout\":{\"line-join\":\"miter\",\"line-miter-limit\":0.25}}");
    add_px(&t, add_class(&t, "x", 0), (double[]){100, 100, 200, 100}, 2);
    add_px(&t, add_class(&t, "x", 1), (double[]){100, 300, 200, 300}, 2);
    camber_scene *scene = make_scene(&t, WORLD);
    const camber_scene_info info = camber_scene_get_info(scene);
    assert_int_equal(info.layers, 3);
    assert_int_equal(info.polylines, 17 * (1 + 2 + 2)); /* so wide that it reaches in from eight worlds to each side */
    size_t count;
    const camber_stroke *strokes = camber_scene_get_strokes(scene, &count);
    assert_int_equal(count, 3);
    assert_int_equal(strokes[1].cap, CAMBER_CAP_SQUARE);
    assert_int_equal(strokes[1].join, CAMBER_JOIN_BEVEL);
    assert_near((double)strokes[1].width_px, 16384, 0);
    assert_int_equal(strokes[2].join, CAMBER_JOIN_MITER);
    assert_near((double)strokes[2].miter_limit, 1, 0);
    assert_near((double)camber_scene_get_lines(scene)->points[1], 300, 1e-3);
    camber_scene_destroy(scene);
    close_town(&t);
}

static void test_backgrounds(void **state) {
    (void)state;
    town t;
    open_town(&t, LINE("hidden", KIND("a"), "#000", "8") "," BACKGROUND("opaque", "#0000ff") "," BACKGROUND(
                      "half", "rgba(255,0,0,0.5)") "," LINE("shown", KIND("a"), "#000", "8"));
    add_px(&t, add_class(&t, "a", 0), (double[]){100, 100, 200, 100}, 2);
    camber_scene *scene = make_scene(&t, WORLD);
    const camber_frame frame = frame_of(scene);
    assert_int_equal(frame.pass_count, 1);
    assert_int_equal(camber_scene_get_info(scene).layers, 1);
    assert_near((double)frame.background.r, 0.5, 1e-6);
    assert_near((double)frame.background.b, 0.5, 1e-6);
    assert_near((double)frame.background.a, 1.0, 1e-6);
    assert_int_equal(t.warnings, 0);
    camber_scene_destroy(scene);
    close_town(&t);

    /* Those above lines are passes between theirs. */
    open_town(
        &t,
        BACKGROUND("land", "#0000ff") "," LINE("line", KIND("a"), "#000", "8") "," BACKGROUND(
            "half",
            "rgba(255,0,0,0.5)") "," BACKGROUND("none",
                                                "rgba(255,0,0,0)") "," LINE("upper", KIND("a"), "#fff",
                                                                            "4") "," BACKGROUND("veil",
                                                                                                "rgba(0,255,0,0.25)"));
    add_px(&t, add_class(&t, "a", 0), (double[]){100, 100, 200, 100}, 2);
    scene = make_scene(&t, WORLD);
    const camber_frame four = frame_of(scene);
    assert_int_equal(t.warnings, 0);
    assert_true(camber_scene_get_info(scene).opaque);
    assert_int_equal(four.pass_count, 4);
    assert_true(four.background.b == 1.0f && four.background.r == 0.0f);
    assert_near(width_in(&four, 0, 0), 8, 0);
    assert_true(four.passes[1].fill.color.r == 1.0f && four.passes[1].fill.color.a == 0.5f);
    assert_near(width_in(&four, 2, 0), 4, 0);
    assert_true(four.passes[3].fill.color.g == 1.0f && four.passes[3].fill.color.a == 0.25f);
    camber_scene_destroy(scene);
    close_town(&t);
}

/* ---- Areas ---- */

#define FILL(id, filter, rest) "{\"id\":\"" id "\",\"type\":\"fill\",\"filter\":" filter "," rest "}"
#define BLUE "\"paint\":{\"fill-color\":\"#00f\"}"

static const double SQUARE[] = {100, 100, 200, 100, 200, 200, 100, 200, 100, 100};

static uint32_t add_shape(town *t, const char *kind, camber_geometry_kind geometry) {
    const uint32_t class = add_class(t, kind, 0);
    t->classes[class].geometry = geometry;
    return class;
}

/* The pass's only paint that draws something. */
static camber_paint paint_of(const camber_pass *pass) {
    camber_paint found = {0};
    size_t count = 0;
    for (size_t i = 0; i < pass->paint_count; i++)
        if (pass->paints[i].fill || pass->paints[i].width_px > 0.0f) {
            found = pass->paints[i];
            count++;
        }
    assert_int_equal(count, 1);
    return found;
}

/* Fill layers draw areas, line layers lines and outlines, in the style's order. */
static void test_areas_are_filled(void **state) {
    (void)state;
    town t;
    open_town(&t, LINE("below", KIND("a"), "#f00", "2") "," FILL("area", KIND("a"), BLUE) "," LINE("above", KIND("a"),
                                                                                                   "#0f0", "3"));
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_AREA), SQUARE, 5);
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_LINE), (double[]){300, 100, 400, 100}, 2);
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_POLYGON), SQUARE, 5);
    add_px(&t, add_shape(&t, "b", CAMBER_GEOMETRY_AREA), SQUARE, 5);
    camber_scene *scene = make_scene(&t, WORLD);
    const camber_frame frame = frame_of(scene);
    assert_int_equal(frame.pass_count, 3);
    assert_int_equal(camber_scene_get_info(scene).layers, 3);
    assert_int_equal(camber_scene_get_info(scene).undrawn, 1);
    assert_near((double)paint_of(frame.passes).width_px, 2, 0);
    assert_int_equal(frame.passes[0].polyline_count, 2); /* the line and the outline, in one set */
    const camber_paint area = paint_of(frame.passes + 1);
    assert_non_null(area.fill);
    assert_true(area.fill->color.b == 1.0f && area.fill->color.r == 0.0f && area.fill->color.a == 1.0f);
    assert_null(area.fill->image);
    assert_near((double)area.width_px, 0, 0);
    assert_int_equal(frame.passes[1].polyline_count, 1);
    assert_near((double)paint_of(frame.passes + 2).width_px, 3, 0);
    assert_null(paint_of(frame.passes + 2).fill);
    camber_scene_destroy(scene);
    close_town(&t);

    /* Backgrounds hide what lies below, and come between areas and lines. */
    open_town(&t, FILL("hidden", KIND("a"), BLUE) "," BACKGROUND("land", "#0f0") "," FILL(
                      "area", KIND("a"), BLUE) "," BACKGROUND("veil", "rgba(255,0,0,0.5)") "," LINE("line", KIND("a"),
                                                                                                    "#000", "2"));
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_AREA), SQUARE, 5);
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_LINE), (double[]){300, 100, 400, 100}, 2);
    scene = make_scene(&t, WORLD);
    const camber_frame three = frame_of(scene);
    assert_int_equal(three.pass_count, 3);
    assert_true(three.background.g == 1.0f);
    assert_non_null(paint_of(three.passes).fill);
    assert_int_equal(three.passes[1].kind, CAMBER_PASS_FILL);
    assert_near((double)paint_of(three.passes + 2).width_px, 2, 0);
    camber_scene_destroy(scene);
    close_town(&t);
}

/* The network is told which of its entries are rings to fill; a plan of lines only has none. */
static void test_entries_of_areas(void **state) {
    (void)state;
    town t;
    camber_zoom_plan *zoom = NULL;
    camber_plan_network network;
    open_town(&t, FILL("area", KIND("a"), BLUE) "," LINE("line", KIND("a"), "#0f0", "3"));
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_LINE), (double[]){300, 100, 400, 100}, 2);
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_AREA), SQUARE, 5);
    for (int lines_only = 0; lines_only < 2; lines_only++) {
        assert_int_equal(camber_zoom_plan_create_view(&t.features, &WORLD, 0.0, &zoom), CAMBER_OK);
        zoom->lines_only = lines_only == 1;
        assert_int_equal(camber_plan_network_create(zoom, &zoom->view, CAMBER_NETWORK_VIEWS, &zoom->plan.all, &network),
                         CAMBER_OK);
        const size_t count = network.first_entries[2];
        assert_int_equal(count, lines_only ? 3 : 3 * 2); /* in the worlds to both sides, too */
        for (size_t i = 0; i < count; i++) {
            const bool is_area = network.entries[i].polyline == 1;
            const camber_plan *plan = &zoom->plan;
            assert_int_equal(network.entries[i].is_area, is_area);
            assert_near((double)plan->strokes[plan->pair_rows[network.entries[i].row]].width_px, is_area ? 0 : 3, 0);
        }
        camber_plan_network_destroy(&network);
        camber_zoom_plan_destroy(zoom);
    }
    close_town(&t);
}

/* A window takes only the copies of the world that touch it. */
static void test_entries_of_windows(void **state) {
    (void)state;
    static const struct {
        double x;
        size_t count;
        double shift;
    } windows[] = {{0.35, 1, 0.0}, {-0.65, 1, -1.0}, {1.35, 1, 1.0}, {0.7, 0, 0.0}};
    static const uint32_t first[] = {0};
    town t;
    camber_zoom_plan *zoom = NULL;
    open_town(&t, LINE("line", KIND("a"), "#0f0", "3"));
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_LINE), (double[]){300, 100, 400, 100}, 2);
    const camber_zoom_desc desc = {.zoom = 1.0, .scale_px = 1024.0, .ratio = 1.0};
    assert_int_equal(camber_zoom_plan_create(&t.features, &desc, &zoom), CAMBER_OK);
    for (size_t i = 0; i < sizeof windows / sizeof *windows; i++) {
        camber_view window = zoom->view;
        camber_plan_entries listed = {0};
        camber_plan_network network;
        window.x = windows[i].x;
        window.width = window.height = 256;
        assert_int_equal(camber_plan_list(&t.features, &zoom->plan, first, 1, &listed), CAMBER_OK);
        assert_int_equal(camber_plan_network_create(zoom, &window, CAMBER_NETWORK_WINDOW, &listed, &network),
                         CAMBER_OK);
        assert_null(listed.entries);
        assert_int_equal(network.first_entries[1], windows[i].count);
        if (windows[i].count)
            assert_near(network.entries[0].shift_x, windows[i].shift, 0);
        camber_plan_network_destroy(&network);
    }
    camber_zoom_plan_destroy(zoom);
    close_town(&t);
}

/* Colour and opacity by feature: equal fills are one row, transparent ones are not drawn. */
static void test_fills_follow_data(void **state) {
    (void)state;
    town t;
    open_town(&t, FILL("area", "true",
                       "\"paint\":{\"fill-color\":[\"match\",[\"get\",\"kind\"],\"a\",\"#f00\",\"#00f\"],"
                       "\"fill-opacity\":[\"match\",[\"get\",\"kind\"],\"n\",0,\"c\",0.5,1]}"));
    static const char *const kinds[] = {"a", "b", "n", "c", "d"};
    for (int i = 0; i < 5; i++)
        add_px(&t, add_shape(&t, kinds[i], CAMBER_GEOMETRY_AREA), SQUARE, 5);
    camber_scene *scene = make_scene(&t, WORLD);
    size_t count;
    camber_scene_get_strokes(scene, &count);
    assert_int_equal(count, 3); /* a, b and d, c */
    assert_int_equal(camber_scene_get_info(scene).polylines, 4);
    const camber_frame frame = frame_of(scene);
    assert_int_equal(frame.pass_count, 1);
    assert_int_equal(frame.passes[0].paint_count, 3);
    const camber_paint *paints = frame.passes[0].paints;
    assert_true(paints[0].fill->color.r == 1.0f && paints[0].fill->color.a == 1.0f);
    assert_true(paints[1].fill->color.b == 1.0f && paints[1].fill->color.a == 1.0f);
    assert_true(paints[2].fill->color.b == 1.0f && paints[2].fill->color.a == 0.5f);
    camber_scene_destroy(scene);
    close_town(&t);
}

/* A layer of areas has an opacity, a translation, and an outline on top. */
static void test_fill_layers(void **state) {
    (void)state;
    town t;
    open_town(&t, FILL("moved", KIND("a"), "\"paint\":{\"fill-layer-opacity\":0.5,\"fill-translate\":[3,4]}") "," FILL(
                      "lined", KIND("a"),
                      "\"paint\":{\"fill-color\":\"#"
                      "00f\",\"fill-opacity\":0.5,"
                      "\"fill-outline-color\":\"#"
                      "f00\"}") "," FILL("hard", KIND("a"),
                                         "\"paint\":"
                                         "{\"fill-"
                                         "antialias"
                                         "\":false,"
                                         "\"fill-"
                                         "outline-"
                                         "color\":"
                                         "\"#f00\","
                                         "\"fill-"
                                         "opacity\":"
                                         "0}"));
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_AREA), SQUARE, 5);
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_POLYGON), SQUARE, 5);
    camber_view_desc view = WORLD;
    view.ratio = 2;
    view.bearing_deg = 90;
    camber_scene *scene = make_scene(&t, view);
    const camber_frame frame = frame_of(scene);
    assert_int_equal(frame.pass_count, 3);
    assert_int_equal(camber_scene_get_info(scene).layers, 2);
    const camber_paint moved = paint_of(frame.passes), lined = paint_of(frame.passes + 1),
                       outline = paint_of(frame.passes + 2);
    assert_near((double)frame.passes[0].opacity, 0.5, 1e-6);
    assert_near((double)moved.fill->color.a, 1, 0);
    assert_near((double)moved.translate_x_px, 8, 1e-5); /* turned with the map */
    assert_near((double)moved.translate_y_px, -6, 1e-5);
    assert_near((double)lined.fill->color.a, 0.5, 1e-6);
    assert_null(outline.fill);
    assert_near((double)outline.width_px, 2, 0); /* a CSS px */
    assert_near((double)outline.color.a, 0.5, 1e-6);
    assert_true(outline.color.r == 1.0f && outline.color.b == 0.0f);
    camber_scene_destroy(scene);
    close_town(&t);

    /* An opacity of the layer is one of both. */
    open_town(&t, FILL("group", KIND("a"), "\"paint\":{\"fill-layer-opacity\":0.5,\"fill-outline-color\":\"#f00\"}"));
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_AREA), SQUARE, 5);
    add_px(&t, add_shape(&t, "a", CAMBER_GEOMETRY_POLYGON), SQUARE, 5);
    scene = make_scene(&t, WORLD);
    const camber_frame group = frame_of(scene);
    assert_int_equal(group.pass_count, 1);
    assert_int_equal(group.passes[0].polyline_count, 2);
    assert_near((double)group.passes[0].opacity, 0.5, 1e-6);
    assert_non_null(group.passes[0].paints[0].fill);
    assert_near((double)group.passes[0].paints[1].width_px, 1, 0);
    camber_scene_destroy(scene);
    close_town(&t);
}

/* Areas with a lower key come first; those of one key stay in order. */
static void test_sorted_areas(void **state) {
    (void)state;
    town t;
    open_town(&t, FILL("area", "true", "\"layout\":{\"fill-sort-key\":[\"to-number\",[\"get\",\"kind\"]]}," BLUE));
    static const char *const kinds[] = {"2", "1", "3", "1"};
    for (int i = 0; i < 4; i++)
        add_px(&t, add_shape(&t, kinds[i], CAMBER_GEOMETRY_AREA),
               (double[]){100 + i, 100, 200, 100, 200, 200, 100 + i, 100}, 4);
    camber_scene *scene = make_scene(&t, WORLD);
    const camber_lines *lines = camber_scene_get_lines(scene);
    static const double wanted[] = {101, 103, 100, 102};
    assert_int_equal(lines->polyline_count, 4);
    for (size_t i = 0; i < 4; i++)
        assert_near((double)lines->points[2 * lines->offsets[i]], wanted[i], 1e-3);
    camber_scene_destroy(scene);
    close_town(&t);
}

/* An image lies on areas as it lies on the background, and moves with them. */
static void test_fill_patterns(void **state) {
    (void)state;
    town t;
    camber_view view;
    camber_plan plan;
    uint8_t rgba[4 * 8 * 4] = {0};
    camber_sprite_image image = {.name = (char[]){"dots"}, .width = 8, .height = 4, .pixel_ratio = 2};
    image.image = (camber_image){.rgba = rgba, .width = 8, .height = 4};
    open_town(&t, "{\"id\":\"below\",\"type\":\"background\",\"paint\":{\"background-pattern\":\"dots\"}}," FILL(
                      "area", "true",
                      "\"paint\":{\"fill-pattern\":[\"get\",\"kind\"],\"fill-opacity\":0.5,\"fill-color\":\"#f00\","
                      "\"fill-translate\":[5,7]}"));
    camber_sprites sprites = {.context = t.context, .images = &image, .image_count = 1};
    t.features.sprites = &sprites;
    add_px(&t, add_shape(&t, "dots", CAMBER_GEOMETRY_AREA), SQUARE, 5);
    add_px(&t, add_shape(&t, "none", CAMBER_GEOMETRY_AREA), SQUARE, 5);
    camber_view_desc seen = {.kind = CAMBER_VIEW_CENTER, .zoom = 3.25, .longitude = 11, .latitude = 47};
    assert_int_equal(camber_view_create(t.context, &seen, &view), CAMBER_OK);
    assert_int_equal(camber_plan_create(&t.features, &view, &plan), CAMBER_OK);
    assert_int_equal(plan.row_count, 1); /* an area whose image is missing is not drawn */
    assert_non_null(strstr(t.last, "none"));
    assert_false(plan.has_arc_length);
    for (int i = 0; i < 2; i++) {
        const camber_fill *area = plan.paints[0].fill, *below = &plan.patterns.fills[0].fill;
        assert_ptr_equal(area->image, &image.image);
        assert_near((double)area->color.a, 0.5, 1e-6);
        assert_near((double)area->width_px, 4 * exp2(0.25), 1e-4);
        assert_near((double)area->height_px, (double)below->height_px, 0);
        assert_near((double)area->x_px, (double)below->x_px + 5, 1e-4);
        assert_near((double)area->y_px, (double)below->y_px + 7, 1e-4);
        view.x += 1e-3;
        camber_plan_patterns_move(&plan.patterns, &view);
    }
    camber_plan_destroy(&plan);
    for (size_t i = 0; i < sprites.missing_count; i++)
        camber_free(t.context, sprites.missing[i]);
    camber_free(t.context, sprites.missing);
    close_town(&t);
}

/* ---- Geometry ---- */

#define ALL "{\"id\":\"all\",\"type\":\"line\",\"layout\":{\"line-join\":\"round\"},\"paint\":{\"line-width\":20}}"

static void test_culling(void **state) {
    (void)state;
    town t;
    open_town(&t, ALL);
    const uint32_t c = add_class(&t, "a", 0);
    camber_view_desc view = WORLD;
    view.width = view.height = 256;                   /* the world's px 384 to 640 */
    add_px(&t, c, (double[]){400, 376, 500, 376}, 2); /* 8 px above: half of it shows */
    add_px(&t, c, (double[]){400, 370, 500, 370}, 2); /* 14 px above: nothing does */
    add_px(&t, c, (double[]){0, 0, 10, 900, 900, 1000, 5, 1000}, 4);
    add_px(&t, c, (double[]){290, 290, 740, 290, 740, 740, 290, 740, 290, 290}, 5); /* around it, box overlapping */
    camber_scene *scene = make_scene(&t, view);
    const camber_scene_info info = camber_scene_get_info(scene);
    assert_int_equal(info.polylines, 1);
    assert_int_equal(info.features, 1);
    assert_int_equal(info.points_in, 2);
    camber_scene_destroy(scene);
    /* A feature of two parts is one feature. */
    add_px(&t, c, (double[]){400, 400, 500, 400}, 2);
    add_px(&t, c, (double[]){400, 420, 500, 420}, 2);
    t.polyline_feature[5] = t.polyline_feature[4];
    t.feature_counts[5] = 0;
    scene = make_scene(&t, view);
    assert_int_equal(camber_scene_get_info(scene).polylines, 3);
    assert_int_equal(camber_scene_get_info(scene).features, 2);
    camber_scene_destroy(scene);
    close_town(&t);
}

static void test_clipping_keeps_lines_in_place(void **state) {
    (void)state;
    town t;
    open_town(&t, ALL);
    const uint32_t c = add_class(&t, "a", 0);
    /* Around the world at zoom 18, through the picture: 134 million px of line. */
    add_line(&t, c, (double[]){0.0, 0.4, 0.3, 0.401, 0.7, 0.403, 1.0, 0.4}, 4);
    const double x = 0.5, y = 0.402;
    const double pi = acos(-1.0);
    const camber_view_desc view = {.kind = CAMBER_VIEW_CENTER,
                                   .zoom = 18,
                                   .longitude = (x - 0.5) * 360,
                                   .latitude = atan(sinh(pi * (1 - 2 * y))) * 180 / pi,
                                   .bearing_deg = 20};
    camber_scene *scene = make_scene(&t, view);
    const camber_lines *lines = camber_scene_get_lines(scene);
    assert_int_equal(lines->polyline_count, 1);
    assert_int_equal(lines->point_count, 2);
    const double a[2] = {(double)lines->points[0], (double)lines->points[1]};
    const double b[2] = {(double)lines->points[2], (double)lines->points[3]};
    const double length = hypot(b[0] - a[0], b[1] - a[1]);
    /* It passes through the centre. */
    const double off = ((512 - a[0]) * (b[1] - a[1]) - (512 - a[1]) * (b[0] - a[0])) / length;
    assert_near(off, 0, 0.02);
    for (int i = 0; i < 4; i++)
        assert_true(fabs((double)lines->points[i]) < 1024 + 4096 + 100);
    assert_true(length > 1024);
    camber_scene_destroy(scene);
    close_town(&t);
}

static void test_rings_stay_closed(void **state) {
    (void)state;
    town t;
    open_town(&t, ALL);
    const uint32_t c = add_class(&t, "a", 0);
    add_px(&t, c, (double[]){500, 500, 520.3, 500.1, 510.7, 530.9, 500, 500}, 4);
    camber_view_desc view = WORLD;
    view.bearing_deg = 31.7;
    camber_scene *scene = make_scene(&t, view);
    assert_int_equal(camber_polylines_get_stats(camber_scene_get_polylines(scene)).rings, 1);
    camber_scene_destroy(scene);
    close_town(&t);
}

static void test_antimeridian(void **state) {
    (void)state;
    town t;
    open_town(&t, ALL);
    const uint32_t c = add_class(&t, "a", 0);
    add_line(&t, c, (double[]){0.99, 0.5, 1.0, 0.5}, 2);
    add_line(&t, c, (double[]){0.0, 0.5, 0.01, 0.5}, 2);
    add_line(&t, c, (double[]){0.0, 0.51, 1.0, 0.51}, 2);
    const camber_view_desc view = {.kind = CAMBER_VIEW_BBOX, .west = 170, .south = -10, .east = -170, .north = 10};
    camber_scene *scene = make_scene(&t, view);
    const camber_scene_info info = camber_scene_get_info(scene);
    assert_near(fabs(info.longitude), 180, 1e-9);
    const camber_lines *lines = camber_scene_get_lines(scene);
    assert_int_equal(lines->polyline_count, 4); /* the third from both sides */
    const double scale = 512 * exp2(info.zoom);
    assert_near((double)lines->points[0], 512 - 0.01 * scale, 1e-2);
    assert_near((double)lines->points[2], 512, 1e-3);
    assert_near((double)lines->points[4], 512, 1e-3);
    assert_near((double)lines->points[6], 512 + 0.01 * scale, 1e-2);
    assert_int_equal(info.features, 3);
    camber_scene_destroy(scene);

    /* Fitted: 7.2 degrees, not the world. */
    t.features.polyline_count = t.features.feature_count = 2;
    scene = make_scene(&t, (camber_view_desc){0});
    assert_near(fabs(camber_scene_get_info(scene).longitude), 180, 1e-9);
    assert_near(camber_scene_get_info(scene).zoom, log2(0.96 * 1024 / (512 * 0.02)), 1e-9);
    assert_int_equal(camber_scene_get_info(scene).polylines, 2);
    camber_scene_destroy(scene);
    close_town(&t);
}

static void test_no_jitter_at_zoom_22(void **state) {
    (void)state;
    town t;
    open_town(&t, ALL);
    const uint32_t c = add_class(&t, "a", 0);
    const double step = 0.1 / (512 * 4194304.0), x = 0.1610425, y = 0.3901;
    double points[2 * 1000];
    for (int i = 0; i < 1000; i++) {
        points[2 * i] = x + i * step;
        points[2 * i + 1] = y + i * step;
    }
    add_line(&t, c, points, 1000);
    const double pi = acos(-1.0);
    const camber_view_desc view = {.kind = CAMBER_VIEW_CENTER,
                                   .zoom = 22,
                                   .longitude = (x - 0.5) * 360,
                                   .latitude = atan(sinh(pi * (1 - 2 * y))) * 180 / pi};
    camber_scene *scene = make_scene(&t, view);
    const camber_lines *lines = camber_scene_get_lines(scene);
    assert_int_equal(lines->point_count, 1000);
    for (size_t i = 0; i + 1 < 1000; i++)
        for (size_t k = 0; k < 2; k++)
            assert_near((double)(lines->points[2 * i + 2 + k] - lines->points[2 * i + k]), 0.1, 1e-4);
    camber_scene_destroy(scene);
    close_town(&t);
}

static void test_simplification(void **state) {
    (void)state;
    town t;
    open_town(&t, ALL);
    double px[2 * 60];
    for (int i = 0; i < 60; i++) {
        px[2 * i] = 100 + 2 * i;
        px[2 * i + 1] = 100 + (i % 2) * 0.2;
    }
    add_px(&t, add_class(&t, "a", 0), px, 60);
    float importance[60];
    assert_int_equal(camber_importance_weigh(t.context, t.points, t.offsets, 1, importance), CAMBER_OK);
    t.features.importance = importance;
    camber_scene *scene = NULL;
    assert_int_equal(camber_scene_create(&t.features, &(camber_scene_desc){.view = WORLD, .simplify_px = 0.25}, &scene),
                     CAMBER_OK);
    assert_int_equal(camber_scene_get_info(scene).points, 0); /* not projected */
    assert_int_equal(camber_scene_project(scene), CAMBER_OK);
    assert_int_equal(camber_scene_get_info(scene).points, 2);
    assert_int_equal(camber_scene_get_info(scene).points_in, 60);
    camber_scene_destroy(scene);
    scene = make_scene(&t, WORLD);
    assert_int_equal(camber_scene_get_info(scene).points, 60);
    camber_scene_destroy(scene);
    close_town(&t);
}

/* Counts outlive the lines that were counted. */
static void test_released_lines(void **state) {
    (void)state;
    town t;
    open_town(&t, ALL);
    add_px(&t, add_class(&t, "a", 0), (const double[]){100, 100, 200, 120, 300, 100}, 3);
    camber_scene *scene = make_scene(&t, WORLD);
    const camber_scene_info before = camber_scene_get_info(scene);
    camber_scene_release_lines(scene);
    const camber_scene_info after = camber_scene_get_info(scene);
    assert_int_equal(after.layers, 1);
    assert_int_equal(after.features, 1);
    assert_int_equal(after.polylines, before.polylines);
    assert_int_equal(after.points, 3);
    assert_int_equal(after.points_in, 3);
    /* They come again when they are asked for. */
    assert_int_equal(camber_scene_project(scene), CAMBER_OK);
    assert_int_equal(camber_scene_get_lines(scene)->point_count, 3);
    camber_scene_destroy(scene);
    close_town(&t);
}

/* ---- Fitted views ---- */

static void test_fit_is_to_what_is_drawn(void **state) {
    (void)state;
    town t;
    open_town(&t, LINE("a", KIND("a"), "#000", "2"));
    const uint32_t a = add_class(&t, "a", 0), b = add_class(&t, "b", 0);
    add_line(&t, a, (double[]){0.30, 0.40, 0.31, 0.402}, 2);
    add_line(&t, b, (double[]){0.1, 0.1, 0.9, 0.9}, 2); /* not drawn */
    camber_scene *scene = make_scene(&t, (camber_view_desc){.width = 500, .height = 700});
    const camber_lines *lines = camber_scene_get_lines(scene);
    assert_int_equal(lines->polyline_count, 1);
    assert_near((double)lines->points[0], 10, 1e-3);
    assert_near((double)lines->points[2], 490, 1e-3);
    assert_near((double)lines->points[1] + (double)lines->points[3], 700, 1e-3);
    camber_scene_destroy(scene);
    /* Turned by a quarter it is as long the other way. */
    scene = make_scene(&t, (camber_view_desc){.width = 700, .height = 500, .bearing_deg = 90});
    assert_near((double)camber_scene_get_lines(scene)->points[1], 490, 1e-3);
    assert_near((double)camber_scene_get_lines(scene)->points[3], 10, 1e-3);
    camber_scene_destroy(scene);
    close_town(&t);
}

/* Small roads show from zoom 12 on. Around all data the zoom is below that, so only the large ones are fitted. */
static void test_fit_follows_the_zoom(void **state) {
    (void)state;
    town t;
    open_town(&t, "{\"id\":\"small\",\"type\":\"line\",\"minzoom\":12,\"filter\":" KIND("small") "}," LINE(
                      "large", KIND("large"), "#000", "2"));
    const uint32_t small = add_class(&t, "small", 0), large = add_class(&t, "large", 0);
    add_line(&t, small, (double[]){0.1, 0.5, 0.9, 0.5}, 2);
    add_line(&t, large, (double[]){0.50, 0.5, 0.51, 0.5}, 2);
    camber_scene *scene = make_scene(&t, (camber_view_desc){0});
    assert_near(camber_scene_get_info(scene).zoom, log2(0.96 * 1024 / (512 * 0.01)), 1e-9);
    assert_int_equal(camber_scene_get_info(scene).polylines, 1);
    camber_scene_destroy(scene);
    close_town(&t);
}

static void test_nothing_to_draw(void **state) {
    (void)state;
    town t;
    open_town(&t, BACKGROUND("land", "#fff") "," LINE("a", KIND("a"), "#000", "2"));
    for (int round = 0; round < 3; round++) {
        if (round == 1)
            add_class(&t, "b", 0);
        if (round == 2)
            add_line(&t, 0, (double[]){0.3, 0.4, 0.31, 0.402}, 2);
        camber_scene *scene = make_scene(&t, (camber_view_desc){0});
        const camber_scene_info info = camber_scene_get_info(scene);
        assert_int_equal(info.polylines, 0);
        assert_int_equal(info.layers, 0);
        assert_true(info.opaque);
        assert_int_equal(frame_of(scene).pass_count, 0);
        assert_int_equal(frame_of(scene).width, 1024);
        assert_int_equal(camber_scene_get_lines(scene)->offsets[0], 0);
        camber_scene_destroy(scene);
    }
    assert_int_equal(t.errors, 0);
    close_town(&t);
}

static void test_bad_input(void **state) {
    (void)state;
    town t;
    open_town(&t, ALL);
    const uint32_t c = add_class(&t, "a", 0);
    add_line(&t, c, (double[]){(double)NAN, (double)NAN}, 1);
    add_line(&t, c, (double[]){0.3, 0.3, (double)NAN, 0.4, 0.5, (double)INFINITY, 0.6, 0.6}, 4);
    add_line(&t, c, NULL, 0);
    add_line(&t, c, (double[]){0.5, 0.5}, 1);
    camber_scene_destroy(make_scene(&t, WORLD));
    camber_scene_destroy(make_scene(&t, (camber_view_desc){0}));
    assert_int_equal(t.errors, 0);
    camber_scene *scene = NULL;
    for (int i = 0; i < 3; i++) {
        const camber_scene_desc bad = {.simplify_px = (double[]){-1, (double)NAN, 0}[i],
                                       .view = {.width = i == 2 ? 1000000 : 0}};
        assert_int_equal(camber_scene_create(&t.features, &bad, &scene), CAMBER_ERROR_ARGUMENT);
        assert_int_equal(t.errors, i + 1);
        assert_null(scene);
    }
    camber_scene_destroy(NULL);
    close_town(&t);
}

/* ---- Memory that runs out anywhere is reported, and nothing leaks ---- */

typedef struct allowance {
    long left, blocks;
} allowance;

static void *allow(void *user, void *block, size_t size_bytes) {
    allowance *a = user;
    if (size_bytes == 0) {
        a->blocks -= block != NULL;
        test_free(block);
        return NULL;
    }
    if (a->left-- <= 0)
        return NULL;
    a->blocks += block == NULL;
    return test_realloc(block, size_bytes);
}

static void test_out_of_memory(void **state) {
    (void)state;
    town t;
    open_town(&t, FILL("c", "true", "\"paint\":{\"fill-outline-color\":\"#f00\"}") "," LINE(
                      "a", KIND("a"), "#000", "2") "," LINE("b", KIND("b"), "#000",
                                                            "[\"interpolate\",[\"linear\"],[\"zoom\"],0,1,20,9]"));
    add_px(&t, add_shape(&t, "c", CAMBER_GEOMETRY_AREA), SQUARE, 5);
    add_px(&t, add_shape(&t, "c", CAMBER_GEOMETRY_POLYGON), SQUARE, 5);
    add_px(&t, add_class(&t, "a", 0), (double[]){100, 100, 200, 100, 300, 300}, 3);
    add_px(&t, add_class(&t, "b", 0), (double[]){100, 100, 200, 100}, 2);
    allowance a = {.left = 1000};
    camber_context *context = NULL;
    assert_int_equal(camber_context_create(
                         &(camber_context_desc){.reallocate = allow, .allocator_user = &a, .cache_dir = ""}, &context),
                     CAMBER_OK);
    t.features.context = context;
    const long resting = a.blocks;
    camber_status status = CAMBER_ERROR_MEMORY;
    for (long left = 0; status != CAMBER_OK; left++) {
        camber_scene *scene = NULL;
        a.left = left;
        status = camber_scene_create(&t.features, &(camber_scene_desc){0}, &scene);
        if (status == CAMBER_OK)
            status = camber_scene_project(scene);
        assert_true(status == CAMBER_ERROR_MEMORY || (status == CAMBER_OK && left > 10));
        camber_scene_destroy(scene);
        assert_int_equal(a.blocks, resting);
    }
    camber_context_destroy(context);
    close_town(&t);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_casings_and_fills_are_two_passes),
        cmocka_unit_test(test_translucent_layers_stay_apart),
        cmocka_unit_test(test_rows_follow_data),
        cmocka_unit_test(test_rows_are_distinct),
        cmocka_unit_test(test_source_layers_zooms_and_caps),
        cmocka_unit_test(test_backgrounds),
        cmocka_unit_test(test_areas_are_filled),
        cmocka_unit_test(test_entries_of_areas),
        cmocka_unit_test(test_entries_of_windows),
        cmocka_unit_test(test_fills_follow_data),
        cmocka_unit_test(test_fill_layers),
        cmocka_unit_test(test_sorted_areas),
        cmocka_unit_test(test_fill_patterns),
        cmocka_unit_test(test_culling),
        cmocka_unit_test(test_clipping_keeps_lines_in_place),
        cmocka_unit_test(test_rings_stay_closed),
        cmocka_unit_test(test_antimeridian),
        cmocka_unit_test(test_no_jitter_at_zoom_22),
        cmocka_unit_test(test_simplification),
        cmocka_unit_test(test_released_lines),
        cmocka_unit_test(test_fit_is_to_what_is_drawn),
        cmocka_unit_test(test_fit_follows_the_zoom),
        cmocka_unit_test(test_nothing_to_draw),
        cmocka_unit_test(test_bad_input),
        cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
