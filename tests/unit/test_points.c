/* Points, as readers of files and of a style's own sources give them: each is a line of one point. */
#include "file_reading.h"

#include "features/mercator.h"
#include "formats/geojson.h"

#include <math.h>

static char *properties[] = {"class"};

static int set_up(void **state) {
    file_reading *it = calloc(1, sizeof *it);
    assert_non_null(it);
    reading_start(it, properties, 1);
    it->style.schema.wants_points = true;
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    reading_end(*state);
    free(*state);
    return 0;
}

/* Reads a geometry as a file, by GDAL. */
static camber_status read_geometry(file_reading *it, const char *geometry) {
    char text[4096];
    const int size = snprintf(text, sizeof text, "{\"type\":\"Feature\",\"properties\":{},\"geometry\":%s}", geometry);
    assert_true(size > 0 && (size_t)size < sizeof text);
    start_again(it);
    return read_path(it, write_file(it, "points.geojson", text, (size_t)size));
}

/* Reads it as the source of a style. */
static camber_geojson_stats read_source(file_reading *it, const char *geometry) {
    camber_geojson_stats stats;
    json_t *root = json_loads(geometry, 0, NULL);
    assert_non_null(root);
    const camber_geojson_desc desc = {.what = "source", .root = root};
    start_again(it);
    expect_ok(it, camber_geojson_read(it->features, &desc, &stats));
    json_decref(root);
    return stats;
}

/* degrees: count pairs, in order. */
static void expect_points(const file_reading *it, const double *degrees, size_t count) {
    const camber_features *set = it->features;
    assert_int_equal(set->polyline_count, count);
    assert_int_equal(set->point_count, count);
    assert_int_equal(set->feature_count, count > 0);
    for (size_t i = 0; i < count; i++) {
        double x, y;
        camber_mercator_project(degrees[2 * i], degrees[2 * i + 1], &x, &y);
        assert_int_equal(camber_features_kind(set, i), CAMBER_GEOMETRY_POINT);
        assert_true(fabs(set->points[2 * i] - x) < 1e-12 && fabs(set->points[2 * i + 1] - y) < 1e-12);
    }
}

static void test_geojson(void **state) {
    static const struct {
        const char *geometry;
        size_t count;
        double degrees[6];
    } cases[] = {
        {"{\"type\":\"Point\",\"coordinates\":[10,20]}", 1, {10, 20}},
        {"{\"type\":\"Point\",\"coordinates\":[180,-80,7]}", 1, {180, -80}},
        {"{\"type\":\"MultiPoint\",\"coordinates\":[[10,20],[-30,40],[10,20]]}", 3, {10, 20, -30, 40, 10, 20}},
        {"{\"type\":\"GeometryCollection\",\"geometries\":[{\"type\":\"Point\",\"coordinates\":[1,2]},"
         "{\"type\":\"MultiPoint\",\"coordinates\":[[3,4],[5,6]]}]}",
         3,
         {1, 2, 3, 4, 5, 6}},
    };
    file_reading *it = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        expect_ok(it, read_geometry(it, cases[i].geometry));
        expect_points(it, cases[i].degrees, cases[i].count);
        assert_int_equal(read_source(it, cases[i].geometry).skipped_features, 0);
        expect_points(it, cases[i].degrees, cases[i].count);
    }
    /* A style that does not want them leaves them out. */
    it->style.schema.wants_points = false;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(read_source(it, cases[i].geometry).skipped_features, 1);
        expect_points(it, NULL, 0);
        assert_int_equal(read_geometry(it, cases[i].geometry), CAMBER_ERROR_INPUT);
    }
}

/* Lines and points of one feature have a class each; none of them is merged, though points coincide. */
static void test_mixed(void **state) {
    static const char mixed[] = "{\"type\":\"GeometryCollection\",\"geometries\":[{\"type\":\"LineString\","
                                "\"coordinates\":[[0,0],[1,1],[2,1]]},{\"type\":\"MultiPoint\",\"coordinates\":"
                                "[[0,0],[2,1],[2,1]]},{\"type\":\"LineString\",\"coordinates\":[[2,1],[3,1]]}]}";
    file_reading *it = *state;
    for (int round = 0; round < 2; round++) {
        if (round == 0)
            expect_ok(it, read_geometry(it, mixed));
        else
            (void)read_source(it, mixed);
        const camber_features *set = it->features;
        assert_int_equal(set->feature_count, 2);
        assert_int_equal(set->classes[set->feature_class[0]].geometry, CAMBER_GEOMETRY_LINE);
        assert_int_equal(set->classes[set->feature_class[1]].geometry, CAMBER_GEOMETRY_POINT);
        size_t points = 0;
        for (size_t p = 0; p < set->polyline_count; p++)
            points += camber_features_kind(set, p) == CAMBER_GEOMETRY_POINT;
        assert_int_equal(points, 3);
    }
}

static void test_damage(void **state) {
    static const struct {
        const char *geometry;
        size_t damaged, invalid, points;
    } cases[] = {
        {"{\"type\":\"Point\",\"coordinates\":[\"a\",1]}", 1, 0, 0},
        {"{\"type\":\"Point\",\"coordinates\":[]}", 1, 0, 0},
        {"{\"type\":\"Feature\",\"geometry\":{\"type\":\"Point\",\"coordinates\":7}}", 1, 0, 0},
        {"{\"type\":\"Point\",\"coordinates\":[null,1]}", 0, 1, 0},
        {"{\"type\":\"MultiPoint\",\"coordinates\":[[1,1],[null,1],[3],[4,4]]}", 1, 1, 2},
        {"{\"type\":\"MultiPoint\",\"coordinates\":[[1,1],[1e5,1]]}", 1, 0, 1},
    };
    file_reading *it = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const camber_geojson_stats stats = read_source(it, cases[i].geometry);
        if (stats.damaged_features != cases[i].damaged || stats.invalid_points != cases[i].invalid ||
            it->features->point_count != cases[i].points)
            fail_msg("%s: %zu damaged, %zu invalid, %zu points", cases[i].geometry, stats.damaged_features,
                     stats.invalid_points, it->features->point_count);
    }
}

/* OpenStreetMap's XML: nodes with a tag are points, beside the lines and with their own class. */
static void test_xml(void **state) {
    static const char text[] =
        "<osm version=\"0.6\"><node id=\"1\" lat=\"10\" lon=\"20\"/><node id=\"2\" lat=\"11\" lon=\"21\">"
        "<tag k=\"class\" v=\"tree\"/></node><node id=\"3\" lat=\"12\" lon=\"22\"><tag k=\"other\" v=\"x\"/></node>"
        "<way id=\"1\"><nd ref=\"1\"/><nd ref=\"2\"/><tag k=\"class\" v=\"road\"/></way></osm>";
    file_reading *it = *state;
    for (int wanted = 0; wanted < 2; wanted++) {
        it->style.schema.wants_points = wanted;
        start_again(it);
        expect_ok(it, read_path(it, write_file(it, "points.osm", text, sizeof text - 1)));
        const camber_features *set = it->features;
        assert_int_equal(set->feature_count, wanted ? 3 : 1);
        assert_int_equal(camber_features_kind(set, set->polyline_count - 1), CAMBER_GEOMETRY_LINE);
        if (!wanted)
            continue;
        const camber_feature_class *tree = set->classes + set->feature_class[0];
        assert_int_equal(tree->geometry, CAMBER_GEOMETRY_POINT);
        assert_string_equal(set->layer_names[tree->layer], "points");
        assert_string_equal(set->values[tree->first_value].string, "tree");
        assert_false(tree->plain || tree->unsorted);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {TEST(test_geojson), TEST(test_mixed), TEST(test_damage), TEST(test_xml)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
