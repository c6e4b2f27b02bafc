/* Layers of styles with sources of their own, as a scene draws them: order, strokes by feature, sources, translations.
 */
#include "map_picture.h"

#include <math.h>
#include <unistd.h>

enum { SIDE = 128 };

/* A source of lines from west to east at these latitudes, with properties; at zoom 4 a degree is 22.8 px about 0. */
#define LINE(latitude, properties)                                                                                     \
    "{\"type\": \"Feature\", \"properties\": {" properties "}, \"geometry\": {\"type\": \"LineString\", "              \
    "\"coordinates\": [[-20, " #latitude "], [20, " #latitude "]]}}"
#define LINES(...)                                                                                                     \
    "{\"type\": \"geojson\", \"data\": {\"type\": \"FeatureCollection\", \"features\": [" __VA_ARGS__ "]}}"

static map open_map(fixture *s, const char *sources, const char *layers, double bearing_deg) {
    camber_style *style = NULL;
    char json[8192];
    snprintf(json, sizeof json, "{\"version\": 8, \"zoom\": 4, \"bearing\": %g, \"sources\": {%s}, \"layers\": [%s]}",
             bearing_deg, sources, layers);
    if (camber_style_parse(s->context, json, strlen(json), "test", &style) != CAMBER_OK)
        fail_msg("%s", s->h.last);
    camber_scene_desc desc = {.view = camber_style_get_view(style)};
    desc.view.width = desc.view.height = SIDE;
    return map_open(s, style, &desc);
}

static void assert_pixel(const picture *p, uint32_t x, uint32_t y, double r, double g, double b, double a) {
    const double wanted[4] = {r, g, b, a};
    for (int c = 0; c < 4; c++)
        if (fabs(picture_value(p, x, y, c) - wanted[c]) > 2.5 / 255)
            fail_msg("pixel %u, %u, channel %d: %.3f, not %.3f", x, y, c, picture_value(p, x, y, c), wanted[c]);
}

static camber_stroke stroke_of(const map *m, size_t polyline) {
    size_t count;
    const camber_stroke *strokes = camber_scene_get_strokes(m->scene, &count);
    const uint32_t row = camber_scene_get_rows(m->scene)[polyline];
    assert_in_range(row, 0, count - 1);
    return strokes[row];
}

/* By the key, and those of one key in the order of the source. */
static void test_sort_key(void **state) {
    fixture *s = *state;
    const char *source =
        "\"s\": " LINES(LINE(0, "\"k\": 3, \"c\": \"#f00\"") "," LINE(0.05, "\"k\": 1, \"c\": \"#0f0\"") "," LINE(
            0.1, "\"k\": 2, \"c\": \"#00f\"") "," LINE(0.15, "\"k\": 1, \"c\": \"#ff0\"") "," LINE(0.2,
                                                                                                   "\"c\": \"#0ff\""));
    map m = open_map(s, source,
                     "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"layout\": {\"line-sort-key\": "
                     "[\"to-number\", [\"get\", \"k\"], 0]}, \"paint\": {\"line-width\": 20, \"line-color\": "
                     "[\"get\", \"c\"]}}",
                     0);
    const camber_lines *lines = camber_scene_get_lines(m.scene);
    assert_int_equal(lines->polyline_count, 5);
    /* North is up: the first drawn is the one without a key, then the two of key 1 as they come. */
    static const double latitudes[] = {0.2, 0.05, 0.15, 0.1, 0};
    for (size_t i = 0; i < 5; i++) {
        const double y = (double)lines->points[2 * lines->offsets[i] + 1];
        assert_true(fabs(y - (SIDE / 2 - latitudes[i] * 512 * 16 / 360)) < 0.1);
    }
    picture p = map_draw(s, &m);
    assert_pixel(&p, 64, 64, 1, 0, 0, 1); /* the largest key on top */
    picture_free(&p);
    map_close(&m);
}

/* A line of two points, in degrees; k is its sort key and its colour. */
#define WAY(k, color, x0, y0, x1, y1)                                                                                  \
    "{\"type\": \"Feature\", \"properties\": {\"k\": " #k ", \"c\": \"" color "\"}, \"geometry\": {\"type\": "         \
    "\"LineString\", \"coordinates\": [[" #x0 ", " #y0 "], [" #x1 ", " #y1 "]]}}"

/* Round ends of layers that tuck them: the end of a line is at the picture's middle, and comes from the west. */
static void test_tucked_ends(void **state) {
    fixture *s = *state;
    static const struct {
        const char *ways;
        double past[4], beside[4]; /* the colour 6 px past the end, and 7 px south of that point's west */
    } cases[] = {
        {WAY(2, "#f00", -3, 0, 0, 0), {1, 0, 0, 1}, {1, 0, 0, 1}},
        {WAY(2, "#f00", 0, 0, 0, 0), {1, 0, 0, 1}, {1, 0, 0, 1}},
        {WAY(2, "#f00", -3, 0, 0, 0) "," WAY(1, "#00f", 0, 0, 3, 0), {0, 0, 1, 1}, {0, 0, 0, 0}},
        {WAY(2, "#f00", -3, 0, 0, 0) "," WAY(3, "#0f0", 0, 0, 3, 0), {0, 1, 0, 1}, {1, 0, 0, 1}},
        {WAY(2, "#f00", -3, 0, 0, 0) "," WAY(2, "#f00", 0, 0, 0, 3) "," WAY(2, "#f00", 0, 0, -3, 3),
         {1, 0, 0, 1},
         {1, 0, 0, 1}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char source[2048];
        snprintf(source, sizeof source, "\"s\": " LINES("%s"), cases[i].ways);
        map m =
            open_map(s, source,
                     "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"metadata\": {\"camber:tuck\": true}, "
                     "\"layout\": {\"line-cap\": \"round\", \"line-sort-key\": [\"get\", \"k\"]}, \"paint\": "
                     "{\"line-width\": [\"match\", [\"get\", \"k\"], 2, 20, 8], \"line-color\": [\"get\", \"c\"]}}",
                     0);
        picture p = map_draw(s, &m);
        const double *past = cases[i].past, *beside = cases[i].beside;
        assert_pixel(&p, 70, 63, past[0], past[1], past[2], past[3]);
        assert_pixel(&p, 66, 70, beside[0], beside[1], beside[2], beside[3]);
        picture_free(&p);
        map_close(&m);
    }
}

/* A line that a layer takes only at higher zooms than its lowest has round ends there. */
static void test_end_by_zoom(void **state) {
    fixture *s = *state;
    map m = open_map(s, "\"s\": " LINES(WAY(2, "#f00", -3, 0, 0, 0)),
                     "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"metadata\": {\"camber:tuck\": true}, "
                     "\"filter\": [\">=\", [\"zoom\"], 2], \"layout\": {\"line-cap\": \"round\"}, "
                     "\"paint\": {\"line-width\": 20, \"line-color\": \"#f00\"}}",
                     0);
    picture p = map_draw(s, &m);
    assert_pixel(&p, 70, 63, 1, 0, 0, 1);
    picture_free(&p);
    map_close(&m);
}

/* A dot would not lie on the line, so its layer does not tuck. */
static void test_offset_end(void **state) {
    fixture *s = *state;
    map m = open_map(s, "\"s\": " LINES(WAY(2, "#f00", -3, 0, 0, 0)),
                     "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"metadata\": {\"camber:tuck\": true}, "
                     "\"layout\": {\"line-cap\": \"round\"}, \"paint\": {\"line-width\": 20, \"line-offset\": 20, "
                     "\"line-color\": \"#f00\"}}",
                     0);
    picture p = map_draw(s, &m);
    assert_pixel(&p, 70, 83, 1, 0, 0, 1);
    assert_pixel(&p, 70, 63, 0, 0, 0, 0);
    picture_free(&p);
    map_close(&m);
}

#define SQUARE(color, x0, y0, x1, y1)                                                                                  \
    "{\"type\": \"Feature\", \"properties\": {\"c\": \"" color                                                         \
    "\"}, \"geometry\": {\"type\": \"Polygon\", \"coordinates\": "                                                     \
    "[[[" #x0 ", " #y0 "], [" #x1 ", " #y0 "], [" #x1 ", " #y1 "], [" #x0 ", " #y1 "], [" #x0 ", " #y0 "]]]}}"

/* Two squares beside the middle, of 21 and 187 px^2 at zoom 4; the size at the next lower whole zoom counts. */
static void test_least_area(void **state) {
    fixture *s = *state;
    static const struct {
        const char *least, *zoom;
        bool small, large;
    } cases[] = {{"0", "4", true, true},       {"20", "4", true, true},   {"22", "4", false, true},
                 {"22", "4.9", false, true},   {"22", "5", true, true},   {"188", "4", false, false},
                 {"188", "3.9", false, false}, {"22", "3.5", false, true}};
    static const char *const paints[] = {"\"fill-antialias\": false", "\"fill-outline-color\": [\"get\", \"c\"]"};
    enum { CASES = sizeof cases / sizeof *cases };
    for (size_t run = 0; run < 2 * CASES; run++) {
        const size_t i = run % CASES;
        char layer[512];
        snprintf(layer, sizeof layer,
                 "{\"id\": \"a\", \"type\": \"fill\", \"source\": \"s\", \"metadata\": {\"camber:least-area\": %s}, "
                 "\"paint\": {\"fill-color\": [\"get\", \"c\"], %s}}",
                 cases[i].least, paints[run / CASES]);
        map m =
            open_map(s, "\"s\": " LINES(SQUARE("#f00", -0.3, -0.1, -0.1, 0.1) "," SQUARE("#00f", 0.1, -0.3, 0.7, 0.3)),
                     layer, 0);
        camber_scene_desc desc = {.view = camber_style_get_view(m.style)};
        desc.view.zoom = atof(cases[i].zoom);
        desc.view.width = desc.view.height = SIDE;
        camber_scene_destroy(m.scene);
        assert_int_equal(camber_scene_create(m.features, &desc, &m.scene), CAMBER_OK);
        picture p = map_draw(s, &m);
        size_t red = 0, blue = 0;
        for (size_t k = 0; k < (size_t)SIDE * SIDE; k++) {
            red += p.rgba[4 * k] > 0;
            blue += p.rgba[4 * k + 2] > 0;
        }
        if ((red > 0) != cases[i].small || (blue > 0) != cases[i].large)
            fail_msg("%s, %s px^2 at zoom %s: %zu and %zu px", paints[run / CASES], cases[i].least, cases[i].zoom, red,
                     blue);
        picture_free(&p);
        map_close(&m);
    }
}

/* One layer, one pass, a stroke for each kind. */
static void test_strokes_by_feature(void **state) {
    fixture *s = *state;
    const char *source =
        "\"s\": " LINES(LINE(1, "\"cap\": \"round\", \"join\": \"bevel\", \"limit\": 3, \"w\": 4") "," LINE(
            0, "\"cap\": \"square\", \"join\": \"miter\", \"limit\": 5, \"w\": 4") "," LINE(-1, "\"cap\": \"pointed\", "
                                                                                                "\"w\": 6"));
    map m = open_map(
        s, source,
        "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"layout\": {\"line-cap\": [\"get\", \"cap\"], "
        "\"line-join\": [\"get\", \"join\"], \"line-miter-limit\": [\"get\", \"limit\"]}, \"paint\": "
        "{\"line-width\": [\"get\", \"w\"], \"line-gap-width\": 2}}",
        0);
    const camber_stroke first = stroke_of(&m, 0), second = stroke_of(&m, 1), third = stroke_of(&m, 2);
    assert_int_equal(first.cap, CAMBER_CAP_ROUND);
    assert_int_equal(first.join, CAMBER_JOIN_BEVEL);
    assert_int_equal(second.cap, CAMBER_CAP_SQUARE);
    assert_int_equal(second.join, CAMBER_JOIN_MITER);
    assert_true(fabsf(second.miter_limit - 5) < 1e-6f);
    assert_int_equal(third.cap, CAMBER_CAP_BUTT); /* what is no cap is the default */
    assert_int_equal(third.join, CAMBER_JOIN_MITER);
    assert_true(fabsf(third.miter_limit - 2) < 1e-6f);
    assert_true(fabsf(first.width_px - 10) < 1e-6f && fabsf(third.width_px - 14) < 1e-6f); /* two bands and the gap */
    assert_int_equal(camber_scene_get_frame(m.scene, NULL).pass_count, 1);
    map_close(&m);
}

static void test_sources(void **state) {
    fixture *s = *state;
    const char *sources = "\"s\": " LINES(LINE(1, "")) ", \"t\": " LINES(LINE(-1, ""));
    map m = open_map(s, sources,
                     "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-width\": 8, "
                     "\"line-color\": \"#f00\"}}, {\"id\": \"b\", \"type\": \"line\", \"source\": \"t\", \"paint\": "
                     "{\"line-width\": 8, \"line-color\": \"#00f\"}}, {\"id\": \"c\", \"type\": \"line\", \"source\": "
                     "\"s\", \"layout\": {\"visibility\": \"none\"}, \"paint\": {\"line-width\": 60}}",
                     0);
    picture p = map_draw(s, &m);
    assert_pixel(&p, 64, 41, 1, 0, 0, 1);
    assert_pixel(&p, 64, 86, 0, 0, 1, 1);
    assert_pixel(&p, 64, 64, 0, 0, 0, 0);
    picture_free(&p);
    map_close(&m);
}

/* The map's translation turns with it, the viewport's does not; a line far outside the picture is seen where it is
 * drawn inside. */
static void test_translate(void **state) {
    fixture *s = *state;
#define MOVED(anchor)                                                                                                  \
    "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-width\": 8, \"line-translate\": [0, "   \
    "300], \"line-translate-anchor\": \"" anchor "\"}}"
    const char *source = "\"s\": " LINES(LINE(13, ""));
    /* 13 degrees north are 299.0 px up at this zoom, which is 0.6 below the middle once moved by 300. */
    const double up = 256 * 16 / 3.14159265358979 * log(tan(3.14159265358979 / 4 + 13 * 3.14159265358979 / 360));
    const uint32_t row = (uint32_t)(64 + 300 - up);
    map m = open_map(s, source, MOVED("map"), 0);
    picture p = map_draw(s, &m);
    assert_pixel(&p, 64, row, 0, 0, 0, 1);
    assert_pixel(&p, 64, row + 8, 0, 0, 0, 0);
    picture_free(&p);
    map_close(&m);
    m = open_map(s, source, MOVED("map"), 180);
    p = map_draw(s, &m);
    assert_pixel(&p, 64, SIDE - 1 - row, 0, 0, 0, 1); /* all of it turned */
    assert_pixel(&p, 64, SIDE - 1 - row - 8, 0, 0, 0, 0);
    picture_free(&p);
    map_close(&m);
    m = open_map(s, source, MOVED("viewport"), 180);
    p = map_draw(s, &m);
    for (uint32_t y = 0; y < SIDE; y += 4)
        assert_pixel(&p, 64, y, 0, 0, 0, 0); /* farther down */
    picture_free(&p);
    map_close(&m);
}

static void test_layer_opacity(void **state) {
    fixture *s = *state;
    const char *source = "\"s\": " LINES(LINE(0, "\"c\": \"#f00\"") "," LINE(0.2, "\"c\": \"#00f\""));
    map m = open_map(
        s, source,
        "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-width\": 20, \"line-color\": "
        "[\"get\", \"c\"], \"line-layer-opacity\": 0.5}}",
        0);
    picture p = map_draw(s, &m);
    assert_pixel(&p, 64, 64, 0, 0, 0.5, 0.5); /* blue hides red, then both are half there */
    picture_free(&p);
    map_close(&m);
}

/* Lines over and beside each other, as the layer's metadata has it. Where opacity changes with the feature, those of
 * one opacity that follow each other are flattened together. */
static void test_overlap(void **state) {
    fixture *s = *state;
    static const struct {
        const char *overlap;
        double over,
            beside; /* where two translucent ones lie over each other; where opaque ones have half a pixel each */
    } cases[] = {{"", 0.5, 0.75}, {"flatten", 0.5, 0.75}, {"accumulate", 0.75, 0.75}, {"unite", 0.5, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char metadata[64] = "", layer[512];
        if (*cases[i].overlap)
            snprintf(metadata, sizeof metadata, "\"metadata\": {\"camber:overlap\": \"%s\"}, ", cases[i].overlap);
        snprintf(layer, sizeof layer,
                 "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", %s\"paint\": {\"line-width\": 21, "
                 "\"line-opacity\": [\"get\", \"o\"]}}",
                 metadata);
        /* 21 px are 0.922852 degrees. */
        map m = open_map(s,
                         "\"s\": " LINES(LINE(0, "\"o\": 0.5") "," LINE(0.2, "\"o\": 0.5") "," LINE(
                             -0.922852, "\"o\": 0.5") "," LINE(-0.7, "\"o\": 0.4")),
                         layer, 0);
        picture p = map_draw(s, &m);
        assert_pixel(&p, 64, 60, 0, 0, 0, cases[i].over);
        assert_pixel(&p, 64, 80, 0, 0, 0, 0.7); /* of two opacities, whatever the overlap */
        picture_free(&p);
        map_close(&m);
        m = open_map(s, "\"s\": " LINES(LINE(0, "\"o\": 1") "," LINE(-0.922852, "\"o\": 1")), layer, 0);
        p = map_draw(s, &m);
        assert_pixel(&p, 64, 74, 0, 0, 0, cases[i].beside);
        picture_free(&p);
        map_close(&m);
    }
}

/* As wide as the line itself; where the line is translucent, it is not seen through the border, nor the border through
 * it.
 */
static void test_border(void **state) {
    fixture *s = *state;
    static const struct {
        const char *paint;
        double edge[4], middle[4];
    } borders[] = {
        {"\"line-color\": \"#f00\", \"line-border-color\": \"#00f\"", {0, 0, 1, 1}, {1, 0, 0, 1}},
        {"\"line-color\": \"#f00\", \"line-border-color\": \"#00f\", \"line-opacity\": 0.5",
         {0, 0, 0.5, 0.5},
         {0.5, 0, 0, 0.5}},
        {"\"line-color\": \"#f00\", \"line-border-color\": \"#00f\", \"line-layer-opacity\": 0.5",
         {0, 0, 0.5, 0.5},
         {0.5, 0, 0, 0.5}},
        {"\"line-color\": \"#fff\"", {0.6, 0.6, 0.6, 1}, {1, 1, 1, 1}},    /* chosen: darker */
        {"\"line-color\": \"#000\"", {0.45, 0.45, 0.45, 1}, {0, 0, 0, 1}}, /* chosen: brighter */
    };
    for (size_t i = 0; i < sizeof borders / sizeof *borders; i++) {
        char layer[512];
        snprintf(layer, sizeof layer,
                 "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-width\": 20, "
                 "\"line-border-width\": [\"get\", \"b\"], %s}}",
                 borders[i].paint);
        map m = open_map(s, "\"s\": " LINES(LINE(0, "\"b\": 4") "," LINE(2, "\"b\": 0")), layer, 0);
        picture p = map_draw(s, &m);
        const double *edge = borders[i].edge, *middle = borders[i].middle;
        assert_pixel(&p, 64, 55, edge[0], edge[1], edge[2], edge[3]);
        assert_pixel(&p, 64, 72, edge[0], edge[1], edge[2], edge[3]);
        assert_pixel(&p, 64, 59, middle[0], middle[1], middle[2], middle[3]);
        assert_pixel(&p, 64, 64, middle[0], middle[1], middle[2], middle[3]);
        assert_pixel(&p, 64, 53, 0, 0, 0, 0);
        assert_pixel(&p, 64, 10, middle[0], middle[1], middle[2], middle[3]); /* 45.5 px up: without a border */
        assert_int_equal(camber_scene_get_info(m.scene).layers, 1);
        picture_free(&p);
        map_close(&m);
    }
}

/* A round join is a miter below the layer's limit where that shows: from 10 px on by the specification's limit. */
static void test_round_limit(void **state) {
    fixture *s = *state;
    static const struct {
        const char *layout;
        double width, limit;
    } cases[] = {{"", 8, 0},
                 {"", 20, 1.05},
                 {", \"line-round-limit\": 1.3", 8, 1.3},
                 {", \"line-round-limit\": [\"get\", \"limit\"]", 20, 1.5},
                 {", \"line-round-limit\": 1", 200, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char layer[512];
        snprintf(layer, sizeof layer,
                 "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"layout\": {\"line-join\": \"round\"%s}, "
                 "\"paint\": {\"line-width\": %g}}",
                 cases[i].layout, cases[i].width);
        map m = open_map(s, "\"s\": " LINES(LINE(0, "\"limit\": 1.5")), layer, 0);
        if (fabs((double)stroke_of(&m, 0).round_limit - cases[i].limit) > 1e-6)
            fail_msg("case %zu: a limit of %g", i, (double)stroke_of(&m, 0).round_limit);
        map_close(&m);
    }
}

/* Layers share polylines where their strokes agree, though one says by a function what the other says plainly. */
static void test_sharing(void **state) {
    fixture *s = *state;
    static const struct {
        const char *layout;
        size_t polylines;
    } others[] = {{"\"line-cap\": \"round\"", 1},
                  {"\"line-cap\": [\"step\", [\"zoom\"], \"butt\", 3, \"round\"], \"line-miter-limit\": 7", 1},
                  {"\"line-cap\": \"round\", \"line-join\": \"miter\", \"line-miter-limit\": 7", 2},
                  {"\"line-cap\": \"square\"", 2},
                  {"\"line-cap\": \"round\", \"line-sort-key\": 4", 2},
                  {"\"line-cap\": [\"get\", \"cap\"]", 2}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        char layers[1024];
        snprintf(layers, sizeof layers,
                 "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"layout\": {\"line-cap\": \"round\", "
                 "\"line-join\": "
                 "\"round\"}}, {\"id\": \"b\", \"type\": \"line\", \"source\": \"s\", \"layout\": {\"line-join\": "
                 "\"round\", %s}}",
                 others[i].layout);
        /* The second join is the later one in the document. */
        map m = open_map(s, "\"s\": " LINES(LINE(0, "\"cap\": \"butt\"")), layers, 0);
        if (camber_scene_get_lines(m.scene)->polyline_count != others[i].polylines)
            fail_msg("%s: %zu polylines", others[i].layout, camber_scene_get_lines(m.scene)->polyline_count);
        map_close(&m);
    }
}

/* ---- A style of many layers over a city ---- */

enum { LAYERS = 300 };

/* Casings and fills of kinds of roads, bridges and tunnels apart, each with a width that depends on zoom and feature.
 */
static void write_layers(char *json, size_t size) {
    static const char *const roads[] = {"footway",  "path",       "cycleway",    "steps",         "track",
                                        "service",  "pedestrian", "residential", "living_street", "unclassified",
                                        "tertiary", "secondary",  "primary",     "trunk",         "motorway"};
    static const char *const others[] = {"bridge", "tunnel", "oneway", "lit", "junction"};
    size_t used = (size_t)snprintf(json, size, "{\"version\": 8, \"layers\": [");
    for (size_t i = 0; i < LAYERS; i++) {
        const size_t road = i % 15, other = i / 15 % 5, fill = i / 75;
        used += (size_t)snprintf(json + used, size - used,
                                 "%s{\"id\": \"l%zu\", \"type\": \"line\", \"filter\": [\"all\", [\"in\", [\"get\", "
                                 "\"highway\"], [\"literal\", "
                                 "[\"%s\", \"%s_link\"]]], [%s [\"==\", [\"get\", \"%s\"], \"yes\"]%s], \"layout\": "
                                 "{\"line-cap\": \"round\", "
                                 "\"line-join\": \"round\"}, \"paint\": {\"line-color\": [\"match\", [\"get\", "
                                 "\"surface\"], \"asphalt\", \"#%zx%zx8\", "
                                 "\"#%zx9%zx\"], \"line-width\": [\"interpolate\", [\"exponential\", 1.5], [\"zoom\"], "
                                 "5, [\"case\", [\"==\", [\"get\", "
                                 "\"oneway\"], \"yes\"], 0.5, 1], 18, %zu]}}",
                                 i ? "," : "", i, roads[road], roads[road], fill % 2 ? "\"!\"," : "\"all\",",
                                 others[other], "]", road, other, other, road, 40 - 8 * fill);
    }
    snprintf(json + used, size - used, "]}");
}

static void test_many_layers(void **state) {
    fixture *s = *state;
    static char json[1 << 20];
    char path[1024];
    const char *data = getenv("CAMBER_DATA");
    snprintf(path, sizeof path, "%s/data/porto_portugal.osm.pbf", data ? data : "");
    if (!data || access(path, R_OK) != 0)
        skip();
    write_layers(json, sizeof json);
    map m = {0};
    if (camber_style_parse(s->context, json, strlen(json), "many", &m.style) != CAMBER_OK)
        fail_msg("%s", s->h.last);
    assert_int_equal(camber_features_create(s->context, m.style, &m.features), CAMBER_OK);
    assert_int_equal(camber_features_read(m.features, &(camber_source_desc){.path = path}), CAMBER_OK);
    const camber_scene_desc desc = {.use = CAMBER_SCENE_VIEWS};
    assert_int_equal(camber_scene_create(m.features, &desc, &m.scene), CAMBER_OK);
    /* A frame evaluates another zoom of the same features. */
    const camber_scene_info info = camber_scene_get_info(m.scene);
    const camber_view_desc view = {
        .kind = CAMBER_VIEW_CENTER, .longitude = info.longitude, .latitude = info.latitude, .zoom = info.zoom + 0.25};
    assert_int_equal(camber_scene_move(m.scene, &view), CAMBER_OK);
    camber_mesh *mesh = NULL;
    camber_frame_stats stats = {0};
    assert_int_equal(camber_mesh_create(s->on.device, fixture_any(s), &mesh), CAMBER_OK);
    assert_int_equal(camber_scene_tessellate(m.scene, mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
    const camber_frame frame = camber_scene_get_frame(m.scene, mesh);
    assert_int_equal(camber_renderer_render(fixture_any(s), &frame, NULL, NULL, &stats), CAMBER_OK);
    printf("%d layers: %zu bytes, %zu passes, %zu draw calls\n", LAYERS, strlen(json), frame.pass_count,
           stats.draw_calls);
    assert_in_range(frame.pass_count, 2, LAYERS);
    assert_in_range(stats.draw_calls, draws_in_cl() ? 0 : 1, draws_in_cl() ? 0 : 10);
    camber_mesh_destroy(mesh);
    map_close(&m);
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sort_key),
        cmocka_unit_test(test_tucked_ends),
        cmocka_unit_test(test_offset_end),
        cmocka_unit_test(test_end_by_zoom),
        cmocka_unit_test(test_strokes_by_feature),
        cmocka_unit_test(test_sources),
        cmocka_unit_test(test_translate),
        cmocka_unit_test(test_layer_opacity),
        cmocka_unit_test(test_many_layers),
        cmocka_unit_test(test_border),
        cmocka_unit_test(test_least_area),
        cmocka_unit_test(test_sharing),
        cmocka_unit_test(test_overlap),
        cmocka_unit_test(test_round_limit),
    };
    const int failed = cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
    return failed;
}
