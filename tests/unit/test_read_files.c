/* Reading files: real ones against counts made by other programs, small ones written here, and bad ones. */
#include "file_reading.h"

#include "features/mercator.h"
#include "gdal/vector_file.h"

#include <gdal_utils.h>

#include <dirent.h>
#include <math.h>
#include <sys/stat.h>

static char *properties[] = {"highway", "type", "MTFCC", "bridge", "tunnel", "layer"};
enum { HIGHWAY, TYPE, MTFCC, BRIDGE, TUNNEL, LAYER, PROPERTIES };

typedef file_reading fixture;

static int set_up(void **state) {
    fixture *it = calloc(1, sizeof *it);
    assert_non_null(it);
    reading_start(it, properties, PROPERTIES);
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    fixture *it = *state;
    reading_end(it);
    free(it);
    return 0;
}

/* Reads a GeoJSON of one geometry into an empty set. */
static camber_status read_geometry(fixture *it, const char *geometry) {
    char text[2048];
    const int size = snprintf(text, sizeof text,
                              "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":{},"
                              "\"geometry\":%s}]}",
                              geometry);
    assert_true(size > 0 && (size_t)size < sizeof text);
    start_again(it);
    return read_path(it, write_file(it, "one.geojson", text, (size_t)size));
}

static const camber_value *value_of(const camber_features *set, size_t feature, size_t property) {
    return &set->values[set->classes[set->feature_class[feature]].first_value + property];
}

/* Features that no layer of the style takes, of data without a schema. */
static size_t count_plain(const camber_features *set) {
    size_t count = 0;
    for (size_t i = 0; i < set->feature_count; i++)
        count += set->classes[set->feature_class[i]].plain;
    return count;
}

/* Features with a value of the property. */
static size_t count_with(const camber_features *set, size_t property) {
    size_t count = 0;
    for (size_t i = 0; i < set->feature_count; i++)
        count += value_of(set, i, property)->type != CAMBER_VALUE_NULL;
    return count;
}

static void expect_degrees(const camber_features *set, size_t point, double longitude, double latitude) {
    double got[2];
    assert_true(point < set->point_count);
    camber_mercator_unproject(set->points[2 * point], set->points[2 * point + 1], &got[0], &got[1]);
    if (fabs(got[0] - longitude) > 1e-9 || fabs(got[1] - latitude) > 1e-9)
        fail_msg("point %zu: %.12g %.12g is not %.12g %.12g", point, got[0], got[1], longitude, latitude);
}

/* ---- The shipped tiles ---- */

/* Counted by a separate decoder of the tiles' protocol buffers: distinct ids of features of which some length lies
 * inside their tile, and that length in units of 1/2048 tile at zoom 15, each tile's part once. */
static void check_tiles(fixture *it, const char *path, size_t ids, double length, size_t property) {
    it->keep_apart = true;
    expect_ok(it, read_path(it, path));
    const camber_features *set = it->features;
    assert_int_equal(set->feature_count, ids);
    assert_int_equal(set->polyline_count, ids); /* each feature in one piece again */
    assert_int_equal(count_with(set, property), ids);
    assert_int_equal(count_plain(set), 0);
    double sum = 0;
    for (size_t i = 0; i < set->polyline_count; i++)
        for (size_t k = set->offsets[i] + 1; k < set->offsets[i + 1]; k++)
            sum += hypot(set->points[2 * k] - set->points[2 * k - 2], set->points[2 * k + 1] - set->points[2 * k - 1]);
    sum *= 2048 * 32768.0;
    assert_true(fabs(sum / length - 1) < 1e-5);
    /* Points that the tiles hold lie on their grid; what cutting made is gone but at the edges of the data. */
    size_t off_grid = 0;
    for (size_t i = 0; i < 2 * set->point_count; i++) {
        const double unit = set->points[i] * 2048 * 32768;
        off_grid += fabs(unit - floor(unit + 0.5)) > 1e-6;
    }
    assert_true(off_grid < set->point_count / 1000);
    const camber_features_stats stats = camber_features_get_stats(set);
    assert_int_equal(stats.damaged_features, 0);
    assert_int_equal(stats.polylines, set->polyline_count);
    assert_int_equal(stats.points, set->point_count);
    assert_true(stats.joined_pieces > 2000);
}

static void test_osm_tiles(void **state) {
    fixture *it = *state;
    check_tiles(it, CAMBER_TEST_DATA "/santa_cruz/osm.mbtiles", 10930, 5312697.096, TYPE);
    assert_null(camber_features_get_attribution(it->features)); /* its metadata does not say whose it is */
    assert_string_equal(it->features->layer_names[0], "roads");
    /* Numbers stay numbers. */
    assert_int_equal(value_of(it->features, 0, BRIDGE)->type, CAMBER_VALUE_NUMBER);
    assert_int_equal(value_of(it->features, 0, TYPE)->type, CAMBER_VALUE_STRING);
    assert_int_equal(value_of(it->features, 0, HIGHWAY)->type, CAMBER_VALUE_NULL);
}

static void test_tiger_tiles(void **state) {
    fixture *it = *state;
    check_tiles(it, CAMBER_TEST_DATA "/santa_cruz/tiger.mbtiles", 14069, 3323175.326, MTFCC);
    assert_null(camber_features_get_attribution(it->features));
}

/* Its buildings have five features that OGR cannot parse. */
static void test_damaged_features(void **state) {
    fixture *it = *state;
    it->style.schema.wants_polygons = true;
    const camber_source_desc desc = {.path = CAMBER_TEST_DATA "/santa_cruz/osm.mbtiles", .layer = "buildings"};
    expect_ok(it, camber_features_read(it->features, &desc));
    const camber_features_stats stats = camber_features_get_stats(it->features);
    assert_int_equal(stats.damaged_features, 5);
    assert_int_equal(it->warnings, 1);
    assert_int_equal(it->errors, 0);
    assert_true(stats.features > 4000);
    assert_int_equal(it->features->classes[it->features->feature_class[0]].geometry, CAMBER_GEOMETRY_POLYGON);
}

/* ---- Real data ---- */

typedef struct real_file {
    const char *name;
    size_t ways;   /* with a highway, or lines: PROVENANCE.md */
    size_t lost;   /* of which fewer than two nodes are in the extract: counted by a separate decoder */
    size_t points; /* PROVENANCE.md, without nodes that the extract lacks; 0: not counted */
} real_file;

static void test_real_files(void **state) {
    static const real_file files[] = {
        {"porto_portugal.osm.pbf", 51349, 39, 426961 - 39},
        {"liechtenstein-latest.osm.pbf", 4660, 0, 60675},
        {"baltimore.osm.pbf", 3844, 0, 23760},
        {"harrisburg.osm.pbf", 2514, 1, 21588 - 1},
        {"moorgate.osm.pbf", 623, 0, 2545},
        {"columbus.osm.pbf", 12006, 0, 94669},
        {"Helsinki-1327152.osm.pbf", 5810, 109, 0},
        {"nyc.osm.pbf", 17132, 94, 87205 - 94},
        {"spo_osm.pbf", 6000, 0, 31432},
        {"north-bayreuth.osm.gz", 2056, 0, 17020},
        {"beijing-2013.geojson", 20889, 0, 108697},
    };
    fixture *it = *state;
    const char *data = getenv("CAMBER_DATA");
    if (!data) {
        print_message("CAMBER_DATA is not set: real files are not read\n");
        skip();
    }
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/data/%s", data, files[i].name);
        it->style.schema.wants_polygons = true; /* squares are areas */
        start_again(it);
        it->keep_apart = true;
        expect_ok(it, read_path(it, path));
        const camber_features *set = it->features;
        size_t points = 0;
        for (size_t k = 0; k < set->polyline_count; k++)
            if (value_of(set, set->polyline_feature[k], HIGHWAY)->type != CAMBER_VALUE_NULL)
                points += set->offsets[k + 1] - set->offsets[k];
        print_message("%s: %zu ways, %zu points\n", files[i].name, count_with(set, HIGHWAY), points);
        assert_int_equal(count_with(set, HIGHWAY), files[i].ways - files[i].lost);
        if (files[i].points)
            assert_int_equal(points, files[i].points);
        const char *attribution = camber_features_get_attribution(set);
        assert_string_equal(
            attribution ? attribution : "none",
            strstr(files[i].name, ".osm") || strstr(files[i].name, "_osm") ? "(c) OpenStreetMap contributors" : "none");
        assert_int_equal(count_plain(set), 0);
    }
}

static void test_real_shapefile(void **state) {
    fixture *it = *state;
    const char *data = getenv("CAMBER_DATA");
    if (!data) {
        print_message("CAMBER_DATA is not set: real files are not read\n");
        skip();
    }
    char path[1024];
    snprintf(path, sizeof path, "%s/data/pittsburgh/edges.shp", data);
    it->keep_apart = it->style.schema.wants_plain = true;
    expect_ok(it, read_path(it, path));
    const camber_features *set = it->features;
    assert_int_equal(set->feature_count, 29834);
    assert_int_equal(set->point_count, 108927);
    assert_int_equal(count_plain(set), 29834); /* no attributes */
    assert_null(camber_features_get_attribution(set));
    /* UTM becomes Pittsburgh: 40.44 N, 80.0 W. */
    double longitude, latitude;
    camber_mercator_unproject(set->points[0], set->points[1], &longitude, &latitude);
    assert_true(fabs(longitude + 80.0) < 0.2 && fabs(latitude - 40.44) < 0.2);
}

/* ---- Geometry ---- */

static void test_line(void **state) {
    fixture *it = *state;
    it->style.schema.wants_plain = true;
    expect_ok(it, read_geometry(it, "{\"type\":\"LineString\",\"coordinates\":[[13,52],[13.5,52.25],[13.5,52.25]]}"));
    assert_int_equal(it->features->polyline_count, 1);
    assert_int_equal(it->features->point_count, 3); /* the repeated one too */
    expect_degrees(it->features, 0, 13, 52);
    expect_degrees(it->features, 1, 13.5, 52.25);
    assert_int_equal(count_plain(it->features), 1);
    assert_int_equal(it->warnings, 0);
}

/* A column that a schema has, too, without a value that a layer takes: GPX has "type". Lines, areas and points of it
 * are plain. */
static void test_odd_columns(void **state) {
    static const char *const keys[] = {"type", "highway", "railway", "waterway", "bridge", "tunnel", "MTFCC", "class"};
    static const char *const values[] = {"null", "\"x\"", "7", "\"\""};
    static const char *const geometries[] = {"\"LineString\",\"coordinates\":[[1,1],[2,2]]",
                                             "\"Polygon\",\"coordinates\":[[[1,1],[2,1],[2,2],[1,1]]]",
                                             "\"Point\",\"coordinates\":[1,1]"};
    fixture *it = *state;
    camber_style *style = NULL;
    assert_int_equal(camber_style_create_builtin(it->context, CAMBER_THEME_LIGHT, &style), CAMBER_OK);
    for (size_t i = 0; i < sizeof keys / sizeof *keys * 12; i++) {
        char text[512];
        camber_features *features = NULL;
        const char *key = keys[i / 12], *value = values[i / 3 % 4];
        const int size = snprintf(text, sizeof text,
                                  "{\"type\":\"Feature\",\"properties\":{\"%s\":%s},\"geometry\":"
                                  "{\"type\":%s}}",
                                  key, value, geometries[i % 3]);
        const camber_source_desc desc = {.path = write_file(it, "one.geojson", text, (size_t)size)};
        assert_int_equal(camber_features_create(it->context, style, &features), CAMBER_OK);
        expect_ok(it, camber_features_read(features, &desc));
        if (features->feature_count == 0 || count_plain(features) != features->feature_count)
            fail_msg("%s: of %zu features %zu are plain", text, features->feature_count, count_plain(features));
        camber_features_destroy(features);
    }
    camber_style_destroy(style);
}

static void test_many_kinds(void **state) {
    fixture *it = *state;
    expect_ok(it,
              read_geometry(it, "{\"type\":\"MultiLineString\",\"coordinates\":[[[1,1],[2,2]],[[3,3],[4,4],[5,5]]]}"));
    assert_int_equal(it->features->feature_count, 1);
    assert_int_equal(it->features->polyline_count, 2);
    assert_int_equal(it->features->point_count, 5);
    expect_degrees(it->features, 2, 3, 3);

    const char *mixed =
        "{\"type\":\"GeometryCollection\",\"geometries\":[{\"type\":\"Point\",\"coordinates\":[1,1]},"
        "{\"type\":\"LineString\",\"coordinates\":[[1,1],[2,2]]},"
        "{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[4,0],[4,4],[0,0]],[[1,1],[2,1],[2,2],[1,1]]]}]}";
    expect_ok(it, read_geometry(it, mixed));
    assert_int_equal(it->features->polyline_count, 1);
    assert_int_equal(camber_features_get_stats(it->features).skipped_features, 1);
    assert_int_equal(it->warnings, 0); /* nobody asked for it */

    it->style.schema.wants_polygons = true;
    expect_ok(it, read_geometry(it, mixed));
    assert_int_equal(it->features->feature_count, 2); /* lines and outlines are of two classes */
    assert_int_equal(it->features->polyline_count, 3);
    assert_int_equal(it->features->classes[it->features->feature_class[0]].geometry, CAMBER_GEOMETRY_LINE);
    assert_int_equal(it->features->classes[it->features->feature_class[1]].geometry, CAMBER_GEOMETRY_POLYGON);
}

static void test_no_lines(void **state) {
    fixture *it = *state;
    assert_int_equal(read_geometry(it, "{\"type\":\"Point\",\"coordinates\":[1,1]}"), CAMBER_ERROR_INPUT);
    assert_int_equal(it->errors, 1);
    assert_int_equal(read_geometry(it, "{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[4,0],[4,4],[0,0]]]}"),
                     CAMBER_ERROR_INPUT);
    assert_int_equal(it->errors, 1);
    static const char empty[] = "{\"type\":\"FeatureCollection\",\"features\":[]}";
    start_again(it);
    expect_ok(it, read_path(it, write_file(it, "empty.geojson", empty, sizeof empty - 1)));
    assert_int_equal(it->features->feature_count, 0);
}

static void test_not_numbers(void **state) {
    fixture *it = *state;
    static const char text[] = "{\"type\":\"FeatureCollection\",\"features\":["
                               "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"LineString\","
                               "\"coordinates\":[[0,0],[1,1],[NaN,2],[3,3],[4,4],[5,-1e999]]}},"
                               "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"LineString\","
                               "\"coordinates\":[[5,5],[6,6]]}}]}";
    expect_ok(it, read_path(it, write_file(it, "nan.geojson", text, sizeof text - 1)));
    assert_int_equal(it->features->feature_count, 2);
    assert_int_equal(it->features->polyline_count, 3);
    assert_int_equal(camber_features_get_stats(it->features).invalid_points, 2);
    expect_degrees(it->features, 1, 1, 1);
    expect_degrees(it->features, 2, 3, 3);
    assert_int_equal(it->features->polyline_feature[1], 0);
    assert_int_equal(it->features->polyline_feature[2], 1);
    assert_int_equal(it->warnings, 1);
}

static void test_latitude(void **state) {
    fixture *it = *state;
    expect_ok(it, read_geometry(it, "{\"type\":\"LineString\",\"coordinates\":[[0,80],[1,90],[2,-90],[3,-85]]}"));
    assert_int_equal(camber_features_get_stats(it->features).clamped_points, 2);
    expect_degrees(it->features, 1, 1, CAMBER_MERCATOR_LATITUDE);
    expect_degrees(it->features, 2, 2, -CAMBER_MERCATOR_LATITUDE);
    for (size_t i = 0; i < it->features->point_count; i++)
        assert_true(it->features->points[2 * i + 1] >= 0 && it->features->points[2 * i + 1] <= 1);
    /* Within the limit, and a last bit beyond the world by the formula. */
    expect_ok(it, read_geometry(it, "{\"type\":\"LineString\",\"coordinates\":[[0,85.0511287798066],"
                                    "[1,-85.0511287798066]]}"));
    assert_int_equal(camber_features_get_stats(it->features).clamped_points, 0);
    assert_true(it->features->points[1] >= 0 && it->features->points[3] <= 1);
}

static void test_antimeridian(void **state) {
    fixture *it = *state;
    expect_ok(it, read_geometry(it, "{\"type\":\"LineString\",\"coordinates\":[[170,0],[-170,0],[-160,10],[170,10]]}"));
    const camber_features *set = it->features;
    assert_int_equal(set->polyline_count, 3);
    assert_int_equal(camber_features_get_stats(set).antimeridian_splits, 2);
    assert_int_equal(set->point_count, 8);
    expect_degrees(set, 0, 170, 0);
    expect_degrees(set, 1, 180, 0);
    expect_degrees(set, 2, -180, 0);
    expect_degrees(set, 3, -170, 0);
    expect_degrees(set, 5, -180, 10);
    expect_degrees(set, 6, 180, 10);
    /* The same given beyond 180. */
    expect_ok(it, read_geometry(it, "{\"type\":\"LineString\",\"coordinates\":[[170,0],[190,0],[200,10],[170,10]]}"));
    assert_int_equal(it->features->polyline_count, 3);
    expect_degrees(it->features, 3, -170, 0);
    /* From one side of the meridian to its other: across the world, unless it comes from beside it. */
    expect_ok(it, read_geometry(it, "{\"type\":\"LineString\",\"coordinates\":[[-180,0],[180,0],[180,10],[-180,10]]}"));
    assert_int_equal(camber_features_get_stats(it->features).antimeridian_splits, 0);
    assert_int_equal(it->features->polyline_count, 1);
    expect_degrees(it->features, 0, -180, 0);
    expect_degrees(it->features, 1, 180, 0);
    expect_degrees(it->features, 3, -180, 10);
    expect_ok(it, read_geometry(it, "{\"type\":\"LineString\",\"coordinates\":[[170,0],[180,0],[-180,0],[-170,0]]}"));
    assert_int_equal(camber_features_get_stats(it->features).antimeridian_splits, 1);
    assert_int_equal(it->features->polyline_count, 2);
    assert_int_equal(it->features->point_count, 4);
    /* On the meridian itself there is nothing to split. */
    expect_ok(it, read_geometry(it, "{\"type\":\"LineString\",\"coordinates\":[[170,0],[180,0]]}"));
    assert_int_equal(it->features->polyline_count, 1);
    expect_degrees(it->features, 1, 180, 0);
    expect_ok(it, read_geometry(it, "{\"type\":\"LineString\",\"coordinates\":[[180,0],[-170,5],[-160,0]]}"));
    assert_int_equal(it->features->polyline_count, 1);
    assert_int_equal(it->features->point_count, 3);
    expect_degrees(it->features, 0, -180, 0);
    expect_ok(it, read_geometry(it, "{\"type\":\"LineString\",\"coordinates\":[[170,0],[-180,5]]}"));
    assert_int_equal(it->features->polyline_count, 1);
    assert_int_equal(it->features->point_count, 2);
    expect_degrees(it->features, 1, 180, 5);
}

static void test_not_degrees(void **state) {
    fixture *it = *state;
    assert_int_equal(read_geometry(it, "{\"type\":\"LineString\",\"coordinates\":[[575873,4467595],[575900,4467600]]}"),
                     CAMBER_ERROR_INPUT);
    assert_int_equal(it->errors, 1);
    assert_non_null(strstr(it->error, "not degrees"));
}

/* ---- Attributes ---- */

static void test_attributes(void **state) {
    fixture *it = *state;
    static const char text[] =
        "{\"type\":\"FeatureCollection\",\"features\":["
        "{\"type\":\"Feature\",\"properties\":{\"highway\":\"primary\",\"bridge\":true,\"layer\":1,\"Type\":\"x\"},"
        "\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[1,1],[2,2]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"highway\":null,\"bridge\":false,\"layer\":-2},"
        "\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[1,1],[2,2]]}},"
        "{\"type\":\"Feature\",\"properties\":{\"highway\":\"primary\",\"bridge\":true,\"layer\":1,\"name\":\"A\"},"
        "\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[1,1],[2,2]]}}]}";
    expect_ok(it, read_path(it, write_file(it, "a.geojson", text, sizeof text - 1)));
    const camber_features *set = it->features;
    assert_int_equal(set->feature_count, 3);
    assert_string_equal(value_of(set, 0, HIGHWAY)->string, "primary");
    assert_int_equal(value_of(set, 1, HIGHWAY)->type, CAMBER_VALUE_NULL);
    assert_int_equal(value_of(set, 0, BRIDGE)->type, CAMBER_VALUE_BOOL);
    assert_true(value_of(set, 0, BRIDGE)->boolean);
    assert_false(value_of(set, 1, BRIDGE)->boolean);
    assert_true(value_of(set, 1, LAYER)->number == -2);
    assert_int_equal(value_of(set, 0, TYPE)->type, CAMBER_VALUE_NULL); /* case counts */
    assert_int_equal(set->feature_class[0], set->feature_class[2]);    /* names are not kept */
    assert_int_equal(set->class_count, 2);
    assert_int_equal(count_plain(set), 0);

    start_again(it);
    const camber_source_desc desc = {.path = it->path, .where = "name = 'A'"};
    expect_ok(it, camber_features_read(it->features, &desc));
    assert_int_equal(it->features->feature_count, 1);
}

static const char osm_xml[] =
    "<osm version=\"0.6\">"
    "<node id=\"1\" lat=\"1\" lon=\"1\"/><node id=\"2\" lat=\"1\" lon=\"2\"/>"
    "<node id=\"3\" lat=\"2\" lon=\"2\"/><node id=\"4\" lat=\"2\" lon=\"1\"/>"
    "<way id=\"1\"><nd ref=\"1\"/><nd ref=\"2\"/><nd ref=\"3\"/><nd ref=\"1\"/>"
    "<tag k=\"highway\" v=\"pedestrian\"/><tag k=\"tourism\" v=\"yes\"/><tag k=\"bridge\" v=\"yes\"/></way>"
    "<way id=\"2\"><nd ref=\"1\"/><nd ref=\"2\"/><nd ref=\"3\"/><nd ref=\"1\"/><tag k=\"building\" v=\"yes\"/></way>"
    "<way id=\"3\"><nd ref=\"1\"/><nd ref=\"2\"/><tag k=\"building\" v=\"yes\"/></way>"
    "<way id=\"4\"><nd ref=\"1\"/><nd ref=\"2\"/><nd ref=\"3\"/><nd ref=\"1\"/><tag k=\"barrier\" v=\"wall\"/></way>"
    "<way id=\"5\"><nd ref=\"4\"/><nd ref=\"2\"/><tag k=\"highway\" v=\"primary\"/><tag k=\"lanes\" v=\"3\"/>"
    "<tag k=\"layer\" v=\"-1\"/></way>"
    "<way id=\"6\"><nd ref=\"1\"/><nd ref=\"2\"/><nd ref=\"3\"/><nd ref=\"1\"/>"
    "<tag k=\"highway\" v=\"pedestrian\"/><tag k=\"area\" v=\"yes\"/></way>"
    "</osm>";

static void test_osm(void **state) {
    fixture *it = *state;
    expect_ok(it, read_path(it, write_file(it, "a.osm", osm_xml, sizeof osm_xml - 1)));
    const camber_features *set = it->features;
    assert_int_equal(set->feature_count, 4); /* all but the closed building and the square */
    assert_int_equal(camber_features_get_stats(set).skipped_features, 2);
    assert_int_equal(count_with(set, HIGHWAY), 2);
    assert_string_equal(value_of(set, 0, BRIDGE)->string, "yes");
    assert_string_equal(value_of(set, 3, LAYER)->string, "-1");
    assert_string_equal(camber_features_get_attribution(set), "(c) OpenStreetMap contributors");

    it->style.schema.wants_polygons = true;
    start_again(it);
    expect_ok(it, read_path(it, it->path));
    assert_int_equal(it->features->feature_count, 6);
    assert_int_equal(it->features->classes[it->features->feature_class[1]].geometry, CAMBER_GEOMETRY_POLYGON);
    assert_int_equal(it->features->classes[it->features->feature_class[5]].geometry, CAMBER_GEOMETRY_POLYGON);

    /* A key that only the filter names. */
    start_again(it);
    const camber_source_desc desc = {.path = it->path, .where = "lanes = '3'"};
    expect_ok(it, camber_features_read(it->features, &desc));
    assert_int_equal(it->features->feature_count, 1);
}

/* ---- Formats and coordinate systems, through GDAL's own converter ---- */

typedef struct conversion {
    const char *format, *name, *system;
} conversion;

static void test_conversions(void **state) {
    static const conversion conversions[] = {
        {"GPKG", "a.gpkg", "EPSG:4326"},
        {"GPKG", "b.gpkg", "EPSG:3857"},
        {"GPKG", "c.gpkg", "EPSG:25833"},
        {"GPKG", "d.gpkg", "EPSG:4258"},
        {"FlatGeobuf", "a.fgb", "EPSG:4326"},
        {"ESRI Shapefile", "a.shp", "EPSG:4326"},
        {"ESRI Shapefile", "b.shp", "EPSG:32633"},
        {"GeoJSON", "b.json", "EPSG:4326"},
        {"GML", "a.gml", "EPSG:4326"},
        {"SQLite", "a.sqlite", "EPSG:4326"},
    };
    fixture *it = *state;
    static const char text[] = "{\"type\":\"FeatureCollection\",\"features\":["
                               "{\"type\":\"Feature\",\"properties\":{\"highway\":\"primary\"},"
                               "\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[13,52],[13.5,52.25]]}}]}";
    char source[128], target[128];
    snprintf(source, sizeof source, "%s", write_file(it, "source.geojson", text, sizeof text - 1));
    GDALAllRegister();
    for (size_t i = 0; i < sizeof conversions / sizeof *conversions; i++) {
        const conversion *one = &conversions[i];
        if (!GDALGetDriverByName(one->format))
            continue;
        snprintf(target, sizeof target, "%s", in_folder(it, one->name));
        char *options[] = {(char[]){"-f"}, (char *)(uintptr_t)one->format, (char[]){"-t_srs"},
                           (char *)(uintptr_t)one->system, NULL};
        GDALVectorTranslateOptions *parsed = GDALVectorTranslateOptionsNew(options, NULL);
        GDALDatasetH from = GDALOpenEx(source, GDAL_OF_VECTOR, NULL, NULL, NULL);
        assert_non_null(from);
        GDALDatasetH to = GDALVectorTranslate(target, NULL, 1, &from, parsed, NULL);
        assert_non_null(to);
        GDALClose(to);
        GDALClose(from);
        GDALVectorTranslateOptionsFree(parsed);
        start_again(it);
        expect_ok(it, read_path(it, target));
        assert_int_equal(it->features->point_count, 2);
        /* Files round to a millimetre or so. */
        double longitude, latitude;
        camber_mercator_unproject(it->features->points[0], it->features->points[1], &longitude, &latitude);
        if (fabs(longitude - 13) > 1e-7 || fabs(latitude - 52) > 1e-7)
            fail_msg("%s in %s: %.12g %.12g", one->format, one->system, longitude, latitude);
        assert_string_equal(value_of(it->features, 0, HIGHWAY)->string, "primary");
    }
}

/* ---- Bad input ---- */

static void expect_failure(fixture *it, camber_status expected, camber_status got) {
    if (got != expected)
        fail_msg("%s: %s and not %s (%s)", it->path, camber_status_get_name(got), camber_status_get_name(expected),
                 it->error);
    assert_int_equal(it->errors, 1);
    assert_int_equal(it->features->feature_count, 0);
    assert_int_equal(it->features->point_count, 0);
    assert_non_null(strstr(it->error, ": "));
    start_again(it);
}

static void test_bad_files(void **state) {
    fixture *it = *state;
    static const char *const names[] = {"a.osm.pbf", "a.osm",  "a.geojson", "a.shp",
                                        "a.mbtiles", "a.gpkg", "a.fgb",     "a.osm.gz"};
    expect_failure(it, CAMBER_ERROR_NOT_FOUND, read_path(it, "/no/such/file.osm.pbf"));
    expect_failure(it, CAMBER_ERROR_NOT_FOUND, read_path(it, "no such.osm.gz"));
    expect_failure(it, CAMBER_ERROR_INPUT, read_path(it, it->folder));
    unsigned char noise[4096];
    uint32_t random = 1;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        expect_failure(it, CAMBER_ERROR_INPUT, read_path(it, write_file(it, names[i], "", 0)));
        for (size_t k = 0; k < sizeof noise; k++)
            noise[k] = (unsigned char)((random = random * 1664525u + 1013904223u) >> 24);
        expect_failure(it, CAMBER_ERROR_INPUT, read_path(it, write_file(it, names[i], noise, sizeof noise)));
        unlink(it->path);
    }
    static const char deep[] = "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\"";
    expect_failure(it, CAMBER_ERROR_INPUT, read_path(it, write_file(it, "cut.geojson", deep, sizeof deep - 1)));
    expect_failure(it, CAMBER_ERROR_INPUT, read_path(it, write_file(it, "cut.osm", osm_xml, sizeof osm_xml - 200)));
}

static void test_bad_choices(void **state) {
    fixture *it = *state;
    const char *path = CAMBER_TEST_DATA "/santa_cruz/osm.mbtiles";
    const camber_source_desc no_layer = {.path = path, .layer = "rivers"};
    assert_int_equal(camber_features_read(it->features, &no_layer), CAMBER_ERROR_INPUT);
    assert_non_null(strstr(it->error, "roads"));
    start_again(it);
    const camber_source_desc bad_where = {.path = path, .where = "type ="};
    expect_failure(it, CAMBER_ERROR_ARGUMENT, camber_features_read(it->features, &bad_where));
    const camber_source_desc no_field = {.path = path, .where = "nonsense = 1"};
    expect_failure(it, CAMBER_ERROR_ARGUMENT, camber_features_read(it->features, &no_field));
    const camber_source_desc nothing = {.path = path, .where = "type = 'no such type'"};
    expect_ok(it, camber_features_read(it->features, &nothing));
    assert_int_equal(it->features->feature_count, 0);
}

/* A failure leaves what was read before. */
static void test_failure_keeps_the_set(void **state) {
    fixture *it = *state;
    expect_ok(it, read_path(it, write_file(it, "a.osm", osm_xml, sizeof osm_xml - 1)));
    const camber_features_stats before = camber_features_get_stats(it->features);
    assert_int_equal(read_path(it, write_file(it, "b.osm", osm_xml, sizeof osm_xml - 100)), CAMBER_ERROR_INPUT);
    const camber_features_stats after = camber_features_get_stats(it->features);
    assert_memory_equal(&before, &after, sizeof before);
    assert_int_equal(it->features->feature_count, before.features);
    expect_ok(it, read_path(it, in_folder(it, "a.osm")));
    assert_int_equal(it->features->feature_count, 2 * before.features);
    assert_int_equal(it->features->polyline_feature[it->features->polyline_count - 1], 2 * before.features - 1);
}

/* Real files cut off in the middle and damaged in the middle: an error or what is left of it, and never a word
 * from GDAL on standard error. */
static void test_cut_files(void **state) {
    static const char *const names[] = {"moorgate.osm.pbf",     "columbus.osm.pbf", "north-bayreuth.osm.gz",
                                        "beijing-2013.geojson", "osm.mbtiles",      "tiger.mbtiles"};
    fixture *it = *state;
    const char *data = getenv("CAMBER_DATA");
    if (!data) {
        print_message("CAMBER_DATA is not set: real files are not cut\n");
        skip();
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[1024], *bytes;
        size_t size;
        snprintf(path, sizeof path, "%s/data/%s", data, names[i]);
        assert_int_equal(camber_read_file(it->context, path, CAMBER_NAMED_BY_CALLER, &bytes, &size), CAMBER_OK);
        for (size_t cut = 1; cut < 8; cut += 2) {
            start_again(it);
            const camber_status status = read_path(it, write_file(it, names[i], bytes, size / 8 * cut + 1));
            if (status != CAMBER_ERROR_INPUT)
                fail_msg("%s cut at %zu / 8: %s", names[i], cut, camber_status_get_name(status));
            assert_int_equal(it->errors, 1);
        }
        uint32_t random = 7;
        for (int k = 0; k < 40; k++) {
            random = random * 1664525u + 1013904223u;
            bytes[random % size] ^= (char)(random >> 20);
        }
        start_again(it);
        const camber_status status = read_path(it, write_file(it, names[i], bytes, size));
        assert_true(status == CAMBER_OK || status == CAMBER_ERROR_INPUT);
        assert_int_equal(it->errors, status == CAMBER_OK ? 0 : 1);
        camber_free(it->context, bytes);
    }
    /* Nothing is left beside what was written. */
    DIR *folder = opendir(it->folder);
    assert_non_null(folder);
    size_t files = 0;
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;)
        files += entry->d_name[0] != '.';
    closedir(folder);
    assert_int_equal(files, sizeof names / sizeof *names);
}

static void test_cut_shapefile(void **state) {
    static const char *const names[] = {"edges.shx", "edges.prj", "edges.shp"};
    fixture *it = *state;
    const char *data = getenv("CAMBER_DATA");
    if (!data) {
        print_message("CAMBER_DATA is not set: real files are not cut\n");
        skip();
    }
    for (size_t i = 0; i < 3; i++) {
        char path[1024], *bytes;
        size_t size;
        snprintf(path, sizeof path, "%s/data/pittsburgh/%s", data, names[i]);
        assert_int_equal(camber_read_file(it->context, path, CAMBER_NAMED_BY_CALLER, &bytes, &size), CAMBER_OK);
        write_file(it, names[i], bytes, i == 2 ? size / 3 : size);
        camber_free(it->context, bytes);
    }
    expect_failure(it, CAMBER_ERROR_INPUT, read_path(it, it->path));
}

static void take_progress(void *user, const camber_progress_info *progress) {
    double *last = user;
    assert_string_equal(progress->stage, "reading");
    assert_true(progress->fraction <= 1);
    *last = progress->fraction;
}

static void test_progress_and_formats(void **state) {
    (void)state;
    double last = -1;
    const camber_context_desc desc = {.progress = take_progress, .progress_user = &last};
    camber_context *context;
    assert_int_equal(camber_context_create(&desc, &context), CAMBER_OK);
    const struct camber_style style = {.context = context};
    camber_features *features;
    assert_int_equal(camber_features_create(context, &style, &features), CAMBER_OK);
    const camber_source_desc source = {.path = CAMBER_TEST_DATA "/santa_cruz/tiger.mbtiles"};
    assert_int_equal(camber_features_read(features, &source), CAMBER_OK);
    assert_true(last == 1);
    camber_features_destroy(features);
    camber_context_destroy(context);
    bool osm = false, geojson = false;
    for (size_t n = 0; camber_format_list(n); n++) {
        osm = osm || strcmp(camber_format_list(n), "OSM") == 0;
        geojson = geojson || strcmp(camber_format_list(n), "GeoJSON") == 0;
        assert_true(n < 1000);
    }
    assert_true(osm && geojson);
    assert_int_equal(strncmp(camber_gdal_get_version(), "GDAL ", 5), 0);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_osm_tiles),
        TEST(test_tiger_tiles),
        TEST(test_damaged_features),
        TEST(test_real_files),
        TEST(test_real_shapefile),
        TEST(test_line),
        TEST(test_odd_columns),
        TEST(test_many_kinds),
        TEST(test_no_lines),
        TEST(test_not_numbers),
        TEST(test_latitude),
        TEST(test_antimeridian),
        TEST(test_not_degrees),
        TEST(test_attributes),
        TEST(test_osm),
        TEST(test_conversions),
        TEST(test_bad_files),
        TEST(test_bad_choices),
        TEST(test_failure_keeps_the_set),
        TEST(test_cut_files),
        TEST(test_cut_shapefile),
        TEST(test_progress_and_formats),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
