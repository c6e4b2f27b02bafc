/* Reports of style documents: all that is wrong, with its place, and what is drawn. */
#include "core.h"

#include "camber_map.h"

static camber_status check(camber_context *context, const char *json, camber_style_report **report) {
    return camber_style_check(context, json, strlen(json), "a.json", report);
}

static const camber_style_finding *find(const camber_style_report *report, const char *pointer, bool error) {
    for (size_t i = 0; i < report->finding_count; i++)
        if (strcmp(report->findings[i].pointer, pointer) == 0 && report->findings[i].error == error)
            return report->findings + i;
    return NULL;
}

static const char *const wrong =
    "{\"version\": 7, \"center\": [1], \"zoom\": \"a\", \"sprite\": 3, \"state\": {\"x\": 1}, \"constants\": {},"
    " \"sources\": {\"s\": {\"type\": \"vector\", \"url\": \"https://x/y\"}, \"t\": 4,"
    "  \"g\": {\"type\": \"geojson\", \"data\": \"a.geojson\"}, \"r\": {\"type\": \"raster\", \"url\": \"x\"}},"
    " \"layers\": ["
    "  {\"id\": \"a\", \"type\": \"line\", \"source\": \"q\", \"filter\": [\"foo\"],"
    "   \"paint\": {\"line-width\": \"x\", \"line-color\": 7, \"line-blurr\": 4, \"line-offset\": 3, \"line-cap\": 1},"
    "   \"layout\": {\"line-cap\": \"pointed\", \"visibility\": 3}},"
    "  {\"id\": \"a\", \"type\": \"fill-extrusion\"}, {\"type\": \"line\"}, {\"id\": \"r\", \"ref\": \"zz\"}, 5,"
    "  {\"id\": \"b\", \"type\": \"line\", \"source\": \"g\", \"minzoom\": 30, \"paint\": []},"
    "  {\"id\": \"c\", \"type\": \"line\", \"source\": \"s\", \"layout\": {\"line-join\": \"round\"}},"
    "  {\"id\": \"d\", \"ref\": \"c\", \"paint\": {\"line-opacity\": 2}}, {\"id\": \"e\", \"ref\": \"d\"},"
    "  {\"id\": \"f\", \"type\": \"line\", \"metadata\": {\"camber:overlap\": \"darken\", \"camber:repeat\": -1,"
    "   \"camber:tuck\": 1, \"camber:least-area\": 1001}}]}";

static void test_all_errors(void **state) {
    (void)state;
    static const char *const errors[] = {"/version",
                                         "/constants",
                                         "/center",
                                         "/zoom",
                                         "/sprite",
                                         "/state",
                                         "/sources/t",
                                         "/layers/0/source",
                                         "/layers/0/filter/0",
                                         "/layers/0/paint/line-width",
                                         "/layers/0/paint/line-color",
                                         "/layers/0/layout/line-cap",
                                         "/layers/0/layout/visibility",
                                         "/layers/1/id",
                                         "/layers/2",
                                         "/layers/3/ref",
                                         "/layers/4",
                                         "/layers/5/minzoom",
                                         "/layers/5/paint",
                                         "/layers/7/paint/line-opacity",
                                         "/layers/8/ref",
                                         "/layers/9/metadata/camber:overlap",
                                         "/layers/9/metadata/camber:repeat",
                                         "/layers/9/metadata/camber:tuck",
                                         "/layers/9/metadata/camber:least-area"};
    static const char *const warnings[] = {"/layers/0/paint/line-blurr", "/layers/0/paint/line-cap", "/layers/1",
                                           "/layers/6", "/layers/9"};
    host h;
    camber_context *context = host_context(&h);
    camber_style_report *report = NULL;
    assert_int_equal(check(context, wrong, &report), CAMBER_OK);
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++) {
        const camber_style_finding *finding = find(report, errors[i], true);
        if (!finding)
            fail_msg("no error at %s", errors[i]);
        if (!strstr(finding->message, "; "))
            fail_msg("no cure at %s: %s", errors[i], finding->message);
    }
    for (size_t i = 0; i < sizeof warnings / sizeof *warnings; i++)
        if (!find(report, warnings[i], false))
            fail_msg("no warning at %s", warnings[i]);
    assert_int_equal(report->error_count, sizeof errors / sizeof *errors);
    assert_int_equal(h.errors + h.warnings, 0);
    camber_style_report_destroy(report);
    host_done(&h, context);
}

/* Styles have these at their root beside what is drawn. */
static void test_root(void **state) {
    (void)state;
    static const struct {
        const char *json, *pointer;
    } cases[] = {
        {"\"id\": \"x\", \"owner\": \"y\", \"sky\": {}, \"projection\": {\"type\": \"mercator\"}", NULL},
        {"\"projection\": {\"type\": \"globe\"}", "/projection"},
        {"\"projection\": {\"type\": [\"step\", [\"zoom\"], \"globe\", 5, \"mercator\"]}", "/projection"},
        {"\"terrain\": {\"source\": \"dem\"}", "/terrain"},
        {"\"colour\": 3", "/colour"},
    };
    host h;
    camber_context *context = host_context(&h);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[512];
        camber_style_report *report = NULL;
        snprintf(json, sizeof json, "{\"version\": 8, \"sources\": {}, \"layers\": [], %s}", cases[i].json);
        assert_int_equal(check(context, json, &report), CAMBER_OK);
        assert_int_equal(report->error_count, 0);
        assert_int_equal(report->finding_count, cases[i].pointer ? 1 : 0);
        if (cases[i].pointer)
            assert_string_equal(report->findings[0].pointer, cases[i].pointer);
        camber_style_report_destroy(report);
    }
    host_done(&h, context);
}

/* Dots stand for the tucked ends of lines, so the lines must have ends that look like dots. */
static void test_tucks(void **state) {
    (void)state;
    static const struct {
        const char *layer;
        bool warns;
    } cases[] = {
        {"\"type\": \"line\", \"paint\": {\"line-opacity\": 0.5, \"line-border-width\": 1}", false},
        {"\"type\": \"line\", \"layout\": {\"line-sort-key\": 1}, \"paint\": {\"line-offset\": 3}", true},
        {"\"type\": \"line\", \"paint\": {\"line-gap-width\": 3}", true},
        {"\"type\": \"line\", \"paint\": {\"line-blur\": 3}", true},
        {"\"type\": \"line\", \"paint\": {\"line-dasharray\": [1, 2]}", true},
        {"\"type\": \"line\", \"paint\": {\"line-pattern\": \"p\"}", true},
        {"\"type\": \"line\", \"paint\": {\"line-gradient\": [\"interpolate\", [\"linear\"], "
         "[\"line-progress\"], 0, \"#f00\", 1, \"#00f\"]}",
         true},
        {"\"type\": \"fill\"", true},
    };
    host h;
    camber_context *context = host_context(&h);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[640];
        camber_style_report *report = NULL;
        snprintf(json, sizeof json,
                 "{\"version\": 8, \"sprite\": \"s\", \"sources\": {}, \"layers\": [{\"id\": \"a\", "
                 "\"metadata\": {\"camber:tuck\": true}, %s}]}",
                 cases[i].layer);
        assert_int_equal(check(context, json, &report), CAMBER_OK);
        assert_int_equal(report->error_count, 0);
        if ((find(report, "/layers/0/metadata/camber:tuck", false) != NULL) != cases[i].warns)
            fail_msg("%s: %s", cases[i].layer, cases[i].warns ? "no warning" : "a warning");
        camber_style_report_destroy(report);
    }
    host_done(&h, context);
}

/* Constants inside functions and expressions, and sources: each with its place. */
static void test_places(void **state) {
    (void)state;
#define PAINT(json) "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"paint\": {" json "}}"
#define FILL(json) "{\"id\": \"a\", \"type\": \"fill\", \"source\": \"s\", \"paint\": {" json "}}"
#define LAYOUT(json) "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"layout\": {" json "}}"
    static const struct {
        const char *source, *layer, *pointer;
        bool error;
    } cases[] = {
        {"", PAINT("\"line-dasharray\": [1, -2]"), "/layers/0/paint/line-dasharray", true},
        {"", PAINT("\"line-dasharray\": {\"stops\": [[3, [1, 1]], [5, [-1, 2]]]}"),
         "/layers/0/paint/line-dasharray/stops/1/1", true},
        {"", PAINT("\"line-dasharray\": [\"step\", [\"zoom\"], [\"literal\", [1, -2]], 4, [\"literal\", [1, 1]]]"),
         "/layers/0/paint/line-dasharray/2/1/1", true},
        {"",
         PAINT("\"line-dasharray\": [\"let\", \"v\", 1, [\"match\", [\"get\", \"x\"], 1, [\"literal\", [1, 1]], "
               "[\"literal\", [-1]]]]"),
         "/layers/0/paint/line-dasharray/3/4/1/0", true},
        {"", PAINT("\"line-dasharray\": [3, 1, 1]"), "/layers/0/paint/line-dasharray", false},
        {"", PAINT("\"line-dasharray\": {\"stops\": [[3, [1, 1]], [5, [3]]]}"),
         "/layers/0/paint/line-dasharray/stops/1/1", false},
        {"", PAINT("\"line-dasharray\": [\"step\", [\"zoom\"], [\"literal\", [1, 2]], 4, [\"literal\", [1, 1, 2]]]"),
         "/layers/0/paint/line-dasharray/4/1", false},
        {"", PAINT("\"line-dasharray\": [3, 1, 1, 2]"), NULL, false},
        {"", PAINT("\"line-width\": {\"stops\": [[5, 2], [10, 2], [10, 12]]}"), "/layers/0/paint/line-width/stops/2",
         false},
        {"",
         PAINT("\"line-width\": {\"property\": \"a\", \"type\": \"categorical\", \"stops\": [[\"x\", 2], [\"x\", 3]]}"),
         "/layers/0/paint/line-width/stops/1", false},
        {"", PAINT("\"line-opacity\": {\"stops\": [[1, 0], [2, 5]]}"), "/layers/0/paint/line-opacity/stops/1/1", true},
        {"", PAINT("\"line-opacity\": {\"property\": \"o\", \"type\": \"identity\", \"default\": 1}"), NULL, false},
        {"", PAINT("\"line-width\": [\"interpolate\", [\"linear\"], [\"zoom\"], 5, 1, 10, -4]"),
         "/layers/0/paint/line-width/6", false},
        {"", PAINT("\"line-width\": [\"coalesce\", [\"get\", \"w\"], [\"case\", [\"has\", \"x\"], 2, -1]]"),
         "/layers/0/paint/line-width/2/3", false},
        {"", LAYOUT("\"line-cap\": {\"stops\": [[0, \"butt\"], [5, \"pointed\"]]}"),
         "/layers/0/layout/line-cap/stops/1/1", true},
        {"", LAYOUT("\"line-join\": [\"match\", [\"get\", \"x\"], \"a\", \"pointed\", \"round\"]"),
         "/layers/0/layout/line-join/3", false},
        {"", LAYOUT("\"line-join\": [\"match\", [\"get\", \"pointed\"], \"pointed\", \"bevel\", \"round\"]"), NULL,
         false},
        {"", "{\"id\": \"a\", \"type\": \"line\", \"source\": \"s\", \"minzoom\": 9, \"maxzoom\": 4}", "/layers/0",
         false},
        {"", FILL("\"fill-color\": \"#fff\", \"fill-antialias\": false, \"fill-outline-color\": [\"get\", \"c\"]"),
         NULL, false},
        {"", FILL("\"fill-opacity\": [\"match\", [\"get\", \"x\"], 1, 0.5, 3]"), "/layers/0/paint/fill-opacity/4",
         false},
        {"", FILL("\"fill-opacity\": -1"), "/layers/0/paint/fill-opacity", true},
        {"", FILL("\"fill-sort-key\": 1"), "/layers/0/paint/fill-sort-key", false},
        {"", FILL("\"line-color\": \"#fff\""), "/layers/0/paint/line-color", false},
        {"", "{\"id\": \"a\", \"type\": \"fill\", \"source\": \"s\", \"minzoom\": 9, \"maxzoom\": 4}", "/layers/0",
         false},
        {", \"t\": {\"type\": \"raster-tiles\"}", PAINT(""), "/sources/t/type", true},
        {", \"t\": {\"type\": \"geojson\"}", PAINT(""), "/sources/t/data", true},
        {", \"t\": {\"type\": \"vector\", \"tiles\": \"x\"}", PAINT(""), "/sources/t/tiles", true},
        {", \"t\": {\"type\": \"vector\", \"url\": 3}", PAINT(""), "/sources/t/url", true},
        {", \"t\": {\"type\": \"vector\", \"url\": \"x\", \"bounds\": [1, 2]}", PAINT(""), "/sources/t/bounds", true},
        {", \"t\": {\"type\": \"vector\", \"url\": \"x\", \"scheme\": \"zyx\"}", PAINT(""), "/sources/t/scheme", true},
        {", \"t\": {\"type\": \"vector\", \"url\": \"x\", \"maxzoom\": -1}", PAINT(""), "/sources/t/maxzoom", true},
    };
    host h;
    camber_context *context = host_context(&h);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[2048];
        camber_style_report *report = NULL;
        snprintf(json, sizeof json,
                 "{\"version\": 8, \"sources\": {\"s\": {\"type\": \"geojson\", \"data\": \"x\"}%s}, \"layers\": [%s]}",
                 cases[i].source, cases[i].layer);
        assert_int_equal(check(context, json, &report), CAMBER_OK);
        if (report->finding_count != (cases[i].pointer != NULL))
            fail_msg("%s: %zu findings", cases[i].layer, report->finding_count);
        if (cases[i].pointer && !find(report, cases[i].pointer, cases[i].error))
            fail_msg("nothing at %s, but at %s: %s", cases[i].pointer, report->findings[0].pointer,
                     report->findings[0].message);
        if (cases[i].pointer && !strstr(report->findings[0].message, "; "))
            fail_msg("no cure: %s", report->findings[0].message);
        camber_style_report_destroy(report);
    }
    host_done(&h, context);
}

static void test_what_is_drawn(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_style_report *report = NULL;
    assert_int_equal(check(context, wrong, &report), CAMBER_OK);
    assert_int_equal(report->type_count, 2);
    assert_string_equal(report->types[0].type, "line");
    assert_int_equal(report->types[0].layers, 6); /* one by reference; what refers to that has none */
    assert_true(report->types[0].drawn);
    assert_string_equal(report->types[1].type, "fill-extrusion");
    assert_int_equal(report->types[1].layers, 1);
    assert_false(report->types[1].drawn);
    assert_int_equal(report->source_count, 3);
    assert_string_equal(report->sources[0].name, "s");
    assert_int_equal(report->sources[0].layers, 2);
    assert_non_null(strstr(report->sources[0].trouble, "network"));
    assert_string_equal(report->sources[1].name, "g");
    assert_int_equal(report->sources[1].layers, 1);
    assert_null(report->sources[1].trouble);
    assert_non_null(strstr(report->sources[2].trouble, "type"));
    camber_style_report_destroy(report);

    assert_int_equal(check(context, "{\"version\": 8,", &report), CAMBER_OK);
    assert_int_equal(report->error_count, 1);
    assert_string_equal(report->findings[0].pointer, "");
    assert_non_null(strstr(report->findings[0].message, "line 1, column"));
    camber_style_report_destroy(report);
    assert_int_equal(check(context, "3", &report), CAMBER_OK);
    assert_int_equal(report->error_count, 1);
    camber_style_report_destroy(report);
    host_done(&h, context);
}

static camber_status attempt(camber_context *context, void *user) {
    camber_style_report *report = NULL;
    const camber_status status = check(context, user, &report);
    assert_true((status == CAMBER_OK) == (report != NULL));
    camber_style_report_destroy(report);
    return status;
}

static void test_memory(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    char json[4096];
    snprintf(json, sizeof json, "%s", wrong);
    each_allocation_fails(&h, attempt, context, json);
    host_done(&h, context);
}

static void test_symbols(void **state) {
    (void)state;
    static const char *const json =
        "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"symbol\", \"metadata\": {\"camber:overlap\": "
        "\"unite\"}, \"layout\": {\"text-field\": \"{name}\", \"text-size\": -1, \"text-anchor\": \"middle\", "
        "\"text-sise\": 3, \"text-color\": \"red\"}, \"paint\": {\"icon-color\": [\"match\", [\"get\", \"k\"], \"a\", "
        "\"red\"]}}, {\"id\": \"b\", \"type\": \"symbol\"}, {\"id\": \"c\", \"type\": \"hillshade\"}]}";
    static const char *const errors[] = {"/layers/0/layout/text-size", "/layers/0/layout/text-anchor",
                                         "/layers/0/paint/icon-color"};
    static const char *const warnings[] = {"/layers/0/metadata/camber:overlap", "/layers/0/layout/text-sise",
                                           "/layers/0/layout/text-color", "/layers/2"};
    host h;
    camber_context *context = host_context(&h);
    camber_style_report *report = NULL;
    assert_int_equal(check(context, json, &report), CAMBER_OK);
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++)
        if (!find(report, errors[i], true))
            fail_msg("%s is not found", errors[i]);
    for (size_t i = 0; i < sizeof warnings / sizeof *warnings; i++)
        if (!find(report, warnings[i], false))
            fail_msg("%s is not found", warnings[i]);
    assert_int_equal(report->finding_count, 7);
    assert_string_equal(report->types[0].type, "symbol");
    assert_true(report->types[0].drawn && report->types[0].layers == 2);
    assert_false(report->types[1].drawn);
    camber_style_report_destroy(report);
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_all_errors), cmocka_unit_test(test_symbols),
                                       cmocka_unit_test(test_places),     cmocka_unit_test(test_root),
                                       cmocka_unit_test(test_tucks),      cmocka_unit_test(test_what_is_drawn),
                                       cmocka_unit_test(test_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
