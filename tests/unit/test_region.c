/* Reading for a region: what touches it; the bounds of what a style asks for; files by their index against the same
 * features read whole, to the last bit. */
#include "file_reading.h"
#include "indexed_files.h"

#include "features/frontier.h"
#include "features/mercator.h"
#include "style/bounds.h"

#include <math.h>

static char *properties[] = {"highway"};

static int set_up(void **state) {
    file_reading *it = calloc(1, sizeof *it);
    assert_non_null(it);
    reading_start(it, properties, 1);
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    reading_end(*state);
    free(*state);
    return 0;
}

/* ---- Regions ---- */

static bool touches(camber_region region, double x0, double y0, double x1, double y1) {
    const double points[] = {x0, y0, x1, y1};
    return camber_region_touches(&region, points, 2);
}

static void test_touches(void **state) {
    const camber_region box = {0.2, 0.3, 0.4, 0.5};
    (void)state;
    assert_true(touches(box, 0.3, 0.4, 0.9, 0.9));
    assert_true(touches(box, 0.1, 0.4, 0.9, 0.4)); /* through it, with no point inside */
    assert_true(touches(box, 0.15, 0.42, 0.25, 0.55));
    assert_true(touches(box, 0.1, 0.3, 0.2, 0.3));     /* a corner */
    assert_true(touches(box, 0.4, 0.1, 0.4, 0.9));     /* along an edge */
    assert_false(touches(box, 0.1, 0.45, 0.25, 0.65)); /* beside a corner, with boxes that overlap */
    assert_false(touches(box, 0.1, 0.4, 0.19, 0.4));
    assert_false(touches(box, 0.3, 0.6, 0.3, 0.9));
    const double dot[] = {0.3, 0.4};
    assert_true(camber_region_touches(&box, dot, 1));
    assert_false(camber_region_touches(&box, dot, 0));
}

static void test_antimeridian(void **state) {
    static const camber_region both[] = {{-0.02, 0.3, 0.02, 0.5}, {0.98, 0.3, 1.02, 0.5}, {1.98, 0.3, 2.02, 0.5}};
    camber_region parts[2];
    (void)state;
    for (size_t i = 0; i < sizeof both / sizeof *both; i++) {
        assert_int_equal(camber_region_parts(&both[i], parts), 2);
        assert_true(touches(both[i], 0.99, 0.4, 0.97, 0.4));
        assert_true(touches(both[i], 0.01, 0.4, 0.03, 0.4));
        assert_false(touches(both[i], 0.03, 0.4, 0.97, 0.3));
        assert_true(camber_region_has_point(&both[i], (const double[]){1.0, 0.4}));
        assert_true(camber_region_has_point(&both[i], (const double[]){0.0, 0.4}));
        assert_false(camber_region_has_point(&both[i], (const double[]){0.5, 0.4}));
    }
    /* A region that begins at an edge of the world has what lies on the other edge, the same place. */
    const camber_region edge = {0.0, 0.3, 0.1, 0.5};
    assert_true(camber_region_has_point(&edge, (const double[]){1.0, 0.4}));
    assert_false(camber_region_has_point(&edge, (const double[]){0.99, 0.4}));
}

/* ---- Bounds ---- */

static double bound_of_width(const file_reading *it, const char *width, double zoom) {
    char text[1024];
    camber_style *style = NULL;
    snprintf(
        text, sizeof text,
        "{\"version\":8,\"sources\":{},\"layers\":[{\"id\":\"a\",\"type\":\"line\",\"paint\":{\"line-width\":%s}}]}",
        width);
    expect_ok(it, camber_style_parse(it->context, text, strlen(text), "style", &style));
    const double bound = camber_style_layer_bound(&style->layers[0], CAMBER_LINE_WIDTH, zoom);
    camber_style_destroy(style);
    return bound;
}

static void expect_bound(const file_reading *it, const char *width, double zoom, double expected) {
    const double bound = bound_of_width(it, width, zoom);
    if (bound != expected)
        fail_msg("%s at zoom %g: %g is not %g", width, zoom, bound, expected);
}

static void test_bounds(void **state) {
    const file_reading *it = *state;
    expect_bound(it, "7", 3, 7);
    expect_bound(it, "[\"interpolate\",[\"linear\"],[\"zoom\"],10,2,20,42]", 15, 22); /* the zoom alone: its value */
    expect_bound(it, "[\"match\",[\"get\",\"kind\"],\"a\",5,[\"b\",\"c\"],9,3]", 3, 9);
    expect_bound(it, "[\"case\",[\"has\",\"x\"],12,[\"==\",[\"get\",\"n\"],1000],8,1]", 3, 12);
    expect_bound(it, "[\"step\",[\"get\",\"lanes\"],2,4,30,6,5]", 3, 30);
    expect_bound(it, "[\"interpolate\",[\"exponential\",1.5],[\"zoom\"],5,[\"match\",[\"get\",\"k\"],\"a\",6,1],20,90]",
                 6, 90);
    expect_bound(it, "[\"*\",3,[\"match\",[\"get\",\"k\"],\"a\",6,1]]", 3, 18);
    expect_bound(it, "[\"+\",3,[\"match\",[\"get\",\"k\"],\"a\",6,1]]", 3, 9);
    expect_bound(it, "{\"property\":\"lanes\",\"type\":\"exponential\",\"stops\":[[1,2],[8,25]],\"default\":4}", 3, 25);
    /* Where it fails the default stands. */
    expect_bound(it, "[\"match\",[\"get\",\"kind\"],\"a\",0.5,0.25]", 3, 1);
    expect_bound(it, "[\"to-number\",[\"get\",\"width\"],2]", 3, INFINITY);
    expect_bound(it,
                 "[\"let\",\"n\",[\"to-number\",[\"get\",\"width\"],0],"
                 "[\"interpolate\",[\"linear\"],[\"zoom\"],5,[\"at\",[\"var\",\"n\"],[\"literal\",[2,3]]],"
                 "10,[\"at\",[\"var\",\"n\"],[\"literal\",[0,7]]]]]",
                 3, 7);
    expect_bound(it, "[\"let\",\"n\",[\"to-number\",[\"get\",\"width\"],0],[\"var\",\"n\"]]", 3, INFINITY);
    expect_bound(it, "[\"*\",0,[\"to-number\",[\"get\",\"width\"],2]]", 3, INFINITY);
    expect_bound(it,
                 "[\"interpolate\",[\"cubic-bezier\",0,1,1,0],[\"zoom\"],0,1,20,[\"match\",[\"get\",\"k\"],\"a\",6,1]]",
                 3, 6);
    expect_bound(it, "{\"property\":\"width\",\"type\":\"identity\"}", 3, INFINITY);
}

/* ---- Files by their index ---- */

static camber_features *read_region(file_reading *it, const char *path, const camber_region *region) {
    camber_features *features;
    const camber_source_desc desc = {.path = path, .keep_apart = it->keep_apart};
    assert_int_equal(camber_features_create(it->context, &it->style, &features), CAMBER_OK);
    features->has_region = region != NULL;
    if (region)
        features->region = *region;
    if (it->style.schema.wants_label_lines)
        camber_features_want_labels(features);
    expect_ok(it, camber_features_read(features, &desc));
    return features;
}

static camber_region region_of(double west, double south, double east, double north) {
    camber_region region;
    camber_mercator_project(west, north, &region.x0, &region.y0);
    camber_mercator_project(east, south, &region.x1, &region.y1);
    return region;
}

/* Returns how many lines were read for the region. far_point: whole files have a point outside, which is counted. */
static size_t expect_as_whole(file_reading *it, const char *indexed, const char *plain, const camber_region *region,
                              bool far_point) {
    camber_features *by_box = read_region(it, indexed, region), *whole = read_region(it, plain, region);
    expect_same_lines(by_box, whole);
    if (far_point) {
        assert_int_equal(by_box->stats.skipped_features, 0);
        assert_int_equal(whole->stats.skipped_features, 1);
    }
    const size_t count = by_box->polyline_count;
    camber_features_destroy(whole);
    camber_features_destroy(by_box);
    return count;
}

static void test_indexed_files(void **state) {
    file_reading *it = *state;
    char source[128], indexed[128], plain[128];
    snprintf(source, sizeof source, "%s", in_folder(it, "source.json"));
    snprintf(plain, sizeof plain, "%s", in_folder(it, "plain.geojson"));
    for (size_t i = 0; i < INDEXED_FILES; i++) {
        const indexed_file *file = &indexed_files[i];
        const bool shapes = strcmp(file->format, "ESRI Shapefile") == 0;
        if (!GDALGetDriverByName(file->format) && i > 0)
            continue;
        network_write(source, 7.0, 46.0, 40, 1500, !shapes);
        snprintf(indexed, sizeof indexed, "%s", in_folder(it, file->name));
        indexed_file_write(file, source, indexed, plain);
        uint64_t seed = 7;
        size_t lines = 0, empty = 0, all = 0;
        for (int k = 0; k < 40; k++) {
            const double size = k % 4 == 0 ? 0.01 : k % 4 == 1 ? 0.3 : 1.5;
            const double west = camber_random_between(&seed, 6.5, 11.5),
                         south = camber_random_between(&seed, 45.8, 50.3);
            const camber_region region = region_of(west, south, west + size, south + 0.7 * size);
            it->style.schema.directed = k % 3 == 0;
            it->keep_apart = k % 5 == 0;
            const size_t count = expect_as_whole(it, indexed, plain, &region, !shapes);
            lines += count;
            empty += count == 0;
        }
        camber_features *whole = read_region(it, indexed, NULL);
        all = whole->polyline_count;
        camber_features_destroy(whole);
        print_message("%s: %zu lines in 40 regions, %zu of them empty; %zu in the file\n", file->name, lines, empty,
                      all);
        assert_true(lines > 500 && empty > 2 && empty < 30 && all > 400);
    }
}

static bool takes_all(const camber_style *style, camber_geometry_kind kind, const char *source_layer,
                      const camber_feature_view *feature) {
    (void)style;
    (void)kind;
    (void)source_layer;
    (void)feature;
    return true;
}

/* Labels have other classes than lines, and so others of their lines are merged. */
static void test_indexed_labels(void **state) {
    static camber_property_readers readers[] = {{CAMBER_KINDS_OF_LABELS, CAMBER_KINDS_OF_LABELS}};
    file_reading *it = *state;
    char source[128], indexed[128], plain[128];
    it->style.schema.wants_label_lines = it->style.schema.wants_label_areas = it->style.schema.wants_label_points =
        true;
    it->style.schema.property_readers = readers;
    it->style.schema.takes = takes_all;
    snprintf(source, sizeof source, "%s", in_folder(it, "source.json"));
    snprintf(plain, sizeof plain, "%s", in_folder(it, "plain.geojson"));
    snprintf(indexed, sizeof indexed, "%s", in_folder(it, "degrees.fgb"));
    for (int mosaic = 0; mosaic < 2; mosaic++) {
        uint64_t seed = 5;
        if (mosaic)
            mosaic_write(source, 7.0, 46.0);
        else
            network_write(source, 7.0, 46.0, 40, 1500, false);
        indexed_file_write(&indexed_files[0], source, indexed, plain);
        for (int k = 0; k < 8; k++) {
            const double size = k % 2 ? 0.3 : 1.2, west = camber_random_between(&seed, 6.8, 10.0),
                         south = camber_random_between(&seed, 45.8, 49.0);
            const camber_region region = region_of(west, south, west + size, south + 0.7 * size);
            it->style.schema.directed = k % 3 == 0;
            it->keep_apart = k % 4 == 0;
            it->style.schema.wants_areas = k % 3 == 1;
            (void)expect_as_whole(it, indexed, plain, &region, false);
        }
    }
}

/* Areas stay whole; one that the region lies in stays, too, and one in whose hole it lies does not. */
static void test_indexed_areas(void **state) {
    file_reading *it = *state;
    char source[128], indexed[128], plain[128];
    it->style.schema.wants_areas = true;
    snprintf(source, sizeof source, "%s", in_folder(it, "source.json"));
    snprintf(plain, sizeof plain, "%s", in_folder(it, "plain.geojson"));
    mosaic_write(source, 7.0, 46.0);
    for (size_t i = 0; i < INDEXED_FILES; i++) {
        if (!GDALGetDriverByName(indexed_files[i].format) && i > 0)
            continue;
        snprintf(indexed, sizeof indexed, "%s", in_folder(it, indexed_files[i].name));
        indexed_file_write(&indexed_files[i], source, indexed, plain);
        uint64_t seed = 11;
        for (int k = 0; k < 12; k++) {
            const double size = k % 3 == 0 ? 0.01 : k % 3 == 1 ? 0.2 : 0.9;
            const double west = camber_random_between(&seed, 6.8, 10.0),
                         south = camber_random_between(&seed, 45.8, 49.0);
            const camber_region region = region_of(west, south, west + size, south + 0.7 * size);
            it->style.schema.wants_polygons = k % 4 == 0;
            (void)expect_as_whole(it, indexed, plain, &region, false);
        }
        it->style.schema.wants_polygons = false;
        const camber_region middle = region_of(8.57, 47.57, 8.571, 47.571),
                            edge = region_of(7.37, 47.57, 7.371, 47.571), beside = region_of(6.9, 46.5, 6.95, 46.6);
        assert_int_equal(expect_as_whole(it, indexed, plain, &middle, false), 2); /* a square, and the large one */
        assert_int_equal(expect_as_whole(it, indexed, plain, &edge, false), 4);   /* and the ring, with its hole */
        assert_int_equal(expect_as_whole(it, indexed, plain, &beside, false), 0);
    }
}

/* Longitudes jump from 180 to -180; a line that does so lies all around the world in an index. */
static void test_indexed_antimeridian(void **state) {
    static const double regions[][4] = {
        {179.6, -0.6, 180.4, 0.4},  {-180.2, -0.3, -179.9, 0.1}, {179.5, -0.2, 179.9, 0.2}, {-180.0, -0.2, -179.7, 0.2},
        {179.99, -1.0, 180.0, 1.0}, {178.3, -0.1, 178.5, 0.1},   {539.9, -0.5, 540.3, 0.5}};
    file_reading *it = *state;
    char source[128], indexed[128], plain[128];
    snprintf(source, sizeof source, "%s", in_folder(it, "source.json"));
    snprintf(plain, sizeof plain, "%s", in_folder(it, "plain.geojson"));
    snprintf(indexed, sizeof indexed, "%s", in_folder(it, "both_sides.fgb"));
    network_write(source, 178.0, -2.0, 40, 1500, true);
    indexed_file_write(&indexed_files[0], source, indexed, plain);
    for (size_t i = 0; i < sizeof regions / sizeof *regions; i++) {
        const double *r = regions[i];
        const camber_region region = region_of(r[0], r[1], r[2], r[3]);
        assert_true(expect_as_whole(it, indexed, plain, &region, true) > 3);
    }
}

/* A filter goes along with the index, and a second file comes to the first. */
static void test_filter_and_two_files(void **state) {
    file_reading *it = *state;
    char source[128], indexed[128], plain[128];
    snprintf(source, sizeof source, "%s", in_folder(it, "source.json"));
    snprintf(plain, sizeof plain, "%s", in_folder(it, "plain.geojson"));
    snprintf(indexed, sizeof indexed, "%s", in_folder(it, "degrees.fgb"));
    network_write(source, 7.0, 46.0, 40, 1500, false);
    indexed_file_write(&indexed_files[0], source, indexed, plain);
    const camber_region region = region_of(8.0, 47.0, 8.8, 47.5);
    camber_features *sets[2];
    for (int i = 0; i < 2; i++) {
        const camber_source_desc primary = {.path = i ? indexed : plain, .where = "highway = 'primary'"},
                                 all = {.path = i ? indexed : plain};
        assert_int_equal(camber_features_create(it->context, &it->style, &sets[i]), CAMBER_OK);
        sets[i]->has_region = true;
        sets[i]->region = region;
        expect_ok(it, camber_features_read(sets[i], &primary));
        assert_int_equal(sets[i]->class_count, 1);
        expect_ok(it, camber_features_read(sets[i], &all));
        assert_int_equal(sets[i]->class_count, 3);
    }
    assert_true(sets[0]->polyline_count > 50);
    expect_same_lines(sets[1], sets[0]);
    for (int i = 0; i < 2; i++)
        camber_features_destroy(sets[i]);
}

/* Where the box has nothing but what is no line, the file is read whole, and says the same as without an index. */
static void test_no_lines(void **state) {
    static const char text[] = "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":"
                               "{\"highway\":\"x\"},\"geometry\":{\"type\":\"Point\",\"coordinates\":[8,47]}}]}";
    file_reading *it = *state;
    char source[128], indexed[128], plain[128], said[1024];
    snprintf(source, sizeof source, "%s", write_file(it, "source.json", text, sizeof text - 1));
    snprintf(plain, sizeof plain, "%s", in_folder(it, "plain.geojson"));
    snprintf(indexed, sizeof indexed, "%s", in_folder(it, "degrees.fgb"));
    indexed_file_write(&indexed_files[0], source, indexed, plain);
    start_again(it);
    const camber_status whole = read_path(it, indexed);
    snprintf(said, sizeof said, "%s", it->error);
    start_again(it);
    it->features->has_region = true;
    it->features->region = region_of(7.9, 46.9, 8.1, 47.1);
    assert_int_equal(read_path(it, indexed), whole);
    assert_int_equal(whole, CAMBER_ERROR_INPUT);
    assert_string_equal(it->error, said);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_touches, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_antimeridian, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_bounds, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_indexed_files, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_indexed_areas, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_indexed_labels, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_indexed_antimeridian, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_filter_and_two_files, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_no_lines, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
