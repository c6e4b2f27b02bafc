/* Features for symbol layers: every reader gives them beside those that are drawn, and what is drawn stays the same to
 * the last bit. */
#include "file_reading.h"

#include "features/mercator.h"
#include "formats/geojson.h"
#include "formats/mvt.h"
#include "map/plan.h"
#include "pbf_file.h"
#include "tilemaker.h"
#include "tiles/features_file.h"

#include <math.h>

static char *properties[] = {"highway", "name", "building"};
enum { HIGHWAY, NAME, BUILDING, PROPERTIES };
static camber_property_readers readers[] = {
    {UINT_MAX, UINT_MAX}, {CAMBER_KINDS_OF_LABELS, CAMBER_KINDS_OF_LABELS}, {UINT_MAX, UINT_MAX}};

/* Symbol layers take what has a name, and others everything. */
static bool takes(const camber_style *style, camber_geometry_kind kind, const char *source_layer,
                  const camber_feature_view *feature) {
    (void)style;
    (void)source_layer;
    return !camber_geometry_is_label(kind) || feature->values[NAME].type == CAMBER_VALUE_STRING;
}

static int set_up(void **state) {
    file_reading *it = calloc(1, sizeof *it);
    assert_non_null(it);
    reading_start(it, properties, PROPERTIES);
    camber_schema *schema = &it->style.schema;
    schema->property_readers = readers;
    schema->takes = takes;
    schema->wants_label_lines = schema->wants_label_areas = schema->wants_label_points = true;
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    reading_end(*state);
    free(*state);
    return 0;
}

static camber_features *create(file_reading *it, bool labels) {
    camber_features *set;
    assert_int_equal(camber_features_create(it->context, &it->style, &set), CAMBER_OK);
    it->errors = it->warnings = 0;
    it->error[0] = 0;
    if (labels)
        camber_features_want_labels(set);
    return set;
}

static camber_features *read_labelled(file_reading *it, const char *path, const camber_region *region, bool labels) {
    camber_features *set = create(it, labels);
    const camber_source_desc desc = {.path = path, .keep_apart = it->keep_apart};
    set->has_region = region != NULL;
    if (region)
        set->region = *region;
    expect_ok(it, camber_features_read(set, &desc));
    return set;
}

static const camber_feature_class *class_of(const camber_features *set, size_t polyline) {
    return &set->classes[set->feature_class[set->polyline_feature[polyline]]];
}

static const char *name_of(const camber_features *set, size_t polyline) {
    return set->values[class_of(set, polyline)->first_value + NAME].string;
}

/* Labels come last, and all before them is what a set without labels has. */
static void expect_drawn_alike(const camber_features *set, const camber_features *without) {
    const size_t count = without->polyline_count, points = without->point_count;
    assert_int_equal(camber_features_find_labels(set, 0), count);
    assert_int_equal(camber_features_find_labels(without, 0), count);
    assert_int_equal(camber_features_count_drawn(set), without->feature_count);
    camber_features_stats told = set->stats;
    told.input_bytes = without->stats.input_bytes;
    assert_true(told.skipped_features <= without->stats.skipped_features);
    told.skipped_features = without->stats.skipped_features;
    assert_memory_equal(&told, &without->stats, sizeof told);
    for (size_t p = 0; p < count; p++) {
        const camber_feature_class *one = class_of(set, p), *other = class_of(without, p);
        assert_int_equal(one->geometry, other->geometry);
        assert_int_equal(one->plain, other->plain);
        assert_null(name_of(set, p));
        expect_same_values(set->values + one->first_value, without->values + other->first_value, PROPERTIES);
    }
    if (count == 0)
        return;
    assert_memory_equal(set->points, without->points, 2 * points * sizeof *set->points);
    assert_memory_equal(set->importance, without->importance, points * sizeof *set->importance);
    assert_memory_equal(set->offsets, without->offsets, (count + 1) * sizeof *set->offsets);
    assert_memory_equal(set->feature_counts, without->feature_counts, count * sizeof *set->feature_counts);
    assert_memory_equal(set->polyline_feature, without->polyline_feature, count * sizeof *set->polyline_feature);
}

/* Counts the labels of a kind; each has a name. */
static size_t count_labels(const camber_features *set, camber_geometry_kind kind) {
    size_t count = 0;
    for (size_t p = camber_features_find_labels(set, 0); p < set->polyline_count; p++) {
        assert_true(class_of(set, p)->labelled);
        assert_non_null(name_of(set, p));
        count += class_of(set, p)->geometry == kind;
    }
    return count;
}

static void expect_labels(const camber_features *set, size_t lines, size_t areas, size_t points) {
    const size_t got[] = {count_labels(set, CAMBER_GEOMETRY_LABEL_LINE), count_labels(set, CAMBER_GEOMETRY_LABEL_AREA),
                          count_labels(set, CAMBER_GEOMETRY_LABEL_POINT)};
    if (got[0] != lines || got[1] != areas || got[2] != points)
        fail_msg("%zu lines, %zu rings and %zu points are not %zu, %zu and %zu", got[0], got[1], got[2], lines, areas,
                 points);
}

/* Reads a file with labels and without; the caller destroys the one with labels. */
static camber_features *read_both(file_reading *it, const char *path, const camber_region *region) {
    camber_features *without = read_labelled(it, path, region, false);
    const size_t warnings = it->warnings;
    camber_features *set = read_labelled(it, path, region, true);
    assert_int_equal(it->warnings, warnings);
    expect_drawn_alike(set, without);
    camber_features_destroy(without);
    return set;
}

/* Sets what is drawn: areas, outlines, points, as bits of a number. */
static void draw(file_reading *it, int what) {
    it->style.schema.wants_areas = what & 1;
    it->style.schema.wants_polygons = what & 2;
    it->style.schema.wants_points = what & 4;
}

enum { DRAWN = 8 };

/* ---- OpenStreetMap ---- */

static const pbf_node nodes[] = {{1, 100000, 100000}, {2, 200000, 100000}, {3, 300000, 100000}, {4, 400000, 100000},
                                 {5, 400000, 200000}, {6, 300000, 200000}, {7, 250000, 300000}, {8, 900000, 900000}};
enum { NODES = sizeof nodes / sizeof *nodes };

static void write_pbf(file_reading *it, const char *name) {
    static const char *const elm[] = {"highway", "residential", "name", "Elm", NULL};
    static const char *const oak[] = {"highway", "residential", "name", "Oak", NULL};
    static const char *const lane[] = {"highway", "residential", NULL};
    static const char *const hall[] = {"building", "yes", "name", "Hall", NULL};
    static const char *const shed[] = {"building", "yes", NULL};
    static const char *const park[] = {"type", "multipolygon", "building", "yes", "name", "Park", NULL};
    static const char *const peak[] = {"name", "Peak", NULL};
    static const char *const tree[] = {"building", "tree", NULL};
    static const char *const *const tags[NODES] = {NULL, tree, NULL, NULL, NULL, NULL, peak, peak};
    pbf_file *file = calloc(1, sizeof *file);
    pbf_block *block = calloc(1, sizeof *block);
    assert_true(file && block);
    pbf_header(file, "DenseNodes");
    pbf_tagged(block, nodes, tags, NODES);
    pbf_end_block(file, block);
    pbf_way(block, 1, elm, (const int64_t[]){1, 2}, 2);
    pbf_way(block, 2, elm, (const int64_t[]){2, 3}, 2);
    pbf_way(block, 3, oak, (const int64_t[]){3, 4}, 2);
    pbf_way(block, 4, lane, (const int64_t[]){4, 5, 6}, 3);
    pbf_way(block, 5, hall, (const int64_t[]){3, 4, 5, 3}, 4);
    pbf_way(block, 6, shed, (const int64_t[]){3, 5, 6, 3}, 4);
    pbf_way(block, 7, NULL, (const int64_t[]){2, 7, 6, 2}, 4);
    pbf_end_block(file, block);
    pbf_relation(block, park, (const pbf_member[]){{7, "outer"}}, 1);
    pbf_end_block(file, block);
    write_file(it, name, file->bytes, file->size);
    free(block);
    free(file);
}

/* Ways of one street are one line by its name, and one line that is drawn goes on into the next street. */
static void test_osm(void **state) {
    file_reading *it = *state;
    char behind[256];
    write_pbf(it, "file.pbf");
    snprintf(behind, sizeof behind, "/vsisubfile/0_%d,%s", 1 << 20, it->path);
    for (int what = 0; what < 2 * DRAWN; what++) {
        draw(it, what);
        camber_features *set = read_both(it, what < DRAWN ? it->path : behind, NULL);
        const size_t first = camber_features_find_labels(set, 0);
        expect_labels(set, 2, 2, 2);
        for (size_t p = first; p < set->polyline_count; p++)
            if (strcmp(name_of(set, p), "Elm") == 0)
                assert_int_equal(set->offsets[p + 1] - set->offsets[p], 3);
        size_t lines = 0;
        for (size_t p = 0; p < first; p++)
            lines += camber_features_kind(set, p) == CAMBER_GEOMETRY_LINE;
        assert_int_equal(lines, 1);
        camber_features_destroy(set);
    }
    /* Only the kinds that the style wants. */
    for (int kind = 0; kind < 3; kind++) {
        it->style.schema.wants_label_lines = kind == 0;
        it->style.schema.wants_label_areas = kind == 1;
        it->style.schema.wants_label_points = kind == 2;
        draw(it, 0);
        camber_features *set = read_both(it, it->path, NULL);
        expect_labels(set, kind == 0 ? 2 : 0, kind == 1 ? 2 : 0, kind == 2 ? 2 : 0);
        camber_features_destroy(set);
    }
}

/* Labels outside of the region go, as lines do. */
static void test_region(void **state) {
    file_reading *it = *state;
    camber_region region;
    write_pbf(it, "file.pbf");
    draw(it, 7);
    camber_mercator_project(0.005, 0.04, &region.x0, &region.y0);
    camber_mercator_project(0.045, 0.005, &region.x1, &region.y1);
    camber_features *set = read_both(it, it->path, &region);
    expect_labels(set, 2, 2, 1);
    camber_features_destroy(set);
}

/* Both readers give the same labels of real files. */
static void test_real_files(void **state) {
    static const char *const names[] = {"nyc.osm.pbf", "liechtenstein-latest.osm.pbf"};
    file_reading *it = *state;
    const char *data = getenv("CAMBER_DATA");
    if (!data) {
        print_message("CAMBER_DATA is not set: real files are not read\n");
        skip();
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[1024], behind[1100];
        snprintf(path, sizeof path, "%s/data/%s", data, names[i]);
        snprintf(behind, sizeof behind, "/vsisubfile/0_%d,%s", 1 << 30, path);
        draw(it, 7);
        camber_features *set = read_both(it, path, NULL);
        print_message("%s: %zu lines, %zu rings and %zu points of labels, %zu classes\n", names[i],
                      count_labels(set, CAMBER_GEOMETRY_LABEL_LINE), count_labels(set, CAMBER_GEOMETRY_LABEL_AREA),
                      count_labels(set, CAMBER_GEOMETRY_LABEL_POINT), set->class_count);
        camber_features_destroy(set);
        /* GDAL puts some other relations together. */
        draw(it, 0);
        it->style.schema.wants_label_areas = false;
        set = read_both(it, path, NULL);
        camber_features *gdals = read_labelled(it, behind, NULL, true);
        expect_same_lines(set, gdals);
        assert_true(count_labels(set, CAMBER_GEOMETRY_LABEL_LINE) > 100);
        camber_features_destroy(gdals);
        camber_features_destroy(set);
        it->style.schema.wants_label_areas = true;
    }
}

/* ---- GeoJSON, by GDAL and as a source ---- */

#define FEATURE(properties, type, coordinates)                                                                         \
    "{\"type\":\"Feature\",\"properties\":{" properties "},\"geometry\":{\"type\":\"" type                             \
    "\",\"coordinates\":" coordinates "}}"
static const char collection[] =
    "{\"type\":\"FeatureCollection\",\"features\":[" FEATURE("\"highway\":\"a\",\"name\":\"Elm\"", "LineString", "[[0,0],[1,0]]") "," FEATURE("\"highway\":\"a\",\"name\":\"Elm\"", "LineString", "[[2,0],[1,0]]") "," FEATURE(
        "\"highway\":\"a\",\"name\":\"Oak\"", "LineString",
        "[[2,0],[3,0],[3,1]]") "," FEATURE("\"highway\":\"a\"", "LineString",
                                           "[[5,5],[6,6]]") "," FEATURE("\"building\":"
                                                                        "\"b\","
                                                                        "\"name\":"
                                                                        "\"Hall\"",
                                                                        "Polygon",
                                                                        "[[[0,0],[0,3]"
                                                                        ",[3,3],[3,0],"
                                                                        "[0,0]],[[1,1]"
                                                                        ",[2,1],"
                                                                        "[2,2],[1,1]]"
                                                                        "]") "," FEATURE("\"building\":"
                                                                                         "\"b\"",
                                                                                         "Polygon",
                                                                                         "[[[0,0],[0,3],[3,"
                                                                                         "3],[0,0]]]") "," FEATURE("\"n"
                                                                                                                   "ame"
                                                                                                                   "\":"
                                                                                                                   "\"P"
                                                                                                                   "eak"
                                                                                                                   "\"",
                                                                                                                   "Mul"
                                                                                                                   "tiP"
                                                                                                                   "oin"
                                                                                                                   "t",
                                                                                                                   "[["
                                                                                                                   "7,"
                                                                                                                   "7],"
                                                                                                                   "[8,"
                                                                                                                   "8]"
                                                                                                                   "]") "," FEATURE("\"highway\":\"c\"",
                                                                                                                                    "Point",
                                                                                                                                    "[4,4]") "]}";

static void test_geojson(void **state) {
    file_reading *it = *state;
    write_file(it, "file.geojson", collection, sizeof collection - 1);
    for (int what = 0; what < DRAWN; what++) {
        draw(it, what);
        for (int plain = 0; plain < 2; plain++) {
            it->style.schema.wants_plain = plain;
            camber_features *set = read_both(it, it->path, NULL);
            expect_labels(set, 2, 2, 2);
            camber_features_destroy(set);
        }
        it->style.schema.wants_plain = false;
    }
}

static camber_features *read_source(file_reading *it, json_t *root, bool labels, camber_geojson_stats *stats) {
    camber_features *set = create(it, labels);
    const camber_geojson_desc desc = {.what = "source", .root = root};
    expect_ok(it, camber_geojson_read(set, &desc, stats));
    expect_ok(it, camber_features_merge_and_weigh(set, 0, true, CAMBER_MERGE_STRAIGHT));
    camber_features_count(set);
    return set;
}

static void test_source(void **state) {
    file_reading *it = *state;
    json_t *root = json_loads(collection, 0, NULL);
    assert_non_null(root);
    for (int what = 0; what < DRAWN; what++) {
        camber_geojson_stats stats, others;
        draw(it, what);
        camber_features *set = read_source(it, root, true, &stats), *without = read_source(it, root, false, &others);
        expect_drawn_alike(set, without);
        expect_labels(set, 2, 2, 2);
        assert_memory_equal(stats.bounds, others.bounds, sizeof stats.bounds);
        assert_int_equal(stats.skipped_features, 0);
        assert_int_equal(others.skipped_features, what & 4 ? 0 : 2);
        camber_features_destroy(without);
        camber_features_destroy(set);
    }
    json_decref(root);
}

/* Two lines that end at one point become one line of labels, unless an icon shows which way they run. */
static void test_directions(void **state) {
    static const char meeting[] =
        "{\"type\": \"FeatureCollection\", \"features\": ["
        "{\"type\": \"Feature\", \"properties\": {\"name\": \"a\"}, \"geometry\": {\"type\": \"LineString\", "
        "\"coordinates\": [[0, 0], [1, 0]]}},"
        "{\"type\": \"Feature\", \"properties\": {\"name\": \"a\"}, \"geometry\": {\"type\": \"LineString\", "
        "\"coordinates\": [[2, 0], [1, 0]]}}]}";
    file_reading *it = *state;
    json_t *root = json_loads(meeting, 0, NULL);
    assert_non_null(root);
    draw(it, 0);
    for (size_t directed = 0; directed < 2; directed++) {
        camber_geojson_stats stats;
        it->style.schema.labels_directed = directed;
        camber_features *set = read_source(it, root, true, &stats);
        expect_labels(set, directed ? 2 : 1, 0, 0);
        camber_features_destroy(set);
    }
    json_decref(root);
}

/* ---- Vector tiles ---- */

enum { ZOOM = 3 };

/* Lines that cross from one tile into the next, a ring, and a point of the second tile that the first one has in its
 * buffer. move: how far the second tile's corner lies to the east, in units. */
static blob tile_with(int move) {
    blob tile = {0}, layer = begin_layer("road", 4096);
    put_key(&layer, "highway");
    put_key(&layer, "name");
    put_text_value(&layer, "a");
    put_text_value(&layer, "Elm");
    put_text_value(&layer, "Oak");
    const uint32_t elm[] = {0, 0, 1, 1}, oak[] = {0, 0, 1, 2};
    put_tagged(&layer, 0, elm, 4, false, (int[]){4000 - move, 100, 4200 - move, 100}, 2);
    put_tagged(&layer, 0, oak, 4, false, (int[]){3900 - move, 200, 4000 - move, 200, 4200 - move, 210}, 3);
    put_tagged(&layer, 0, oak, 2, false, (int[]){4000 - move, 300, 4200 - move, 300}, 2);
    put_tagged(&layer, 9, oak, 4, true, (int[]){4000 - move, 400, 4200 - move, 400, 4200 - move, 500}, 3);
    uint32_t words[8];
    blob feature = {0};
    put_packed(&feature, 2, elm, 4);
    put_number(&feature, 3, 1);
    words[0] = 1 | 2 << 3;
    words[1] = zigzag(4100 - move);
    words[2] = zigzag(50);
    words[3] = zigzag(-50);
    words[4] = zigzag(10);
    put_packed(&feature, 4, words, 5);
    put_message(&layer, 2, &feature);
    put_layer(&tile, &layer);
    return tile;
}

static camber_features *read_tiles(file_reading *it, bool labels) {
    static const char *const layers[] = {"road"};
    camber_features *set = create(it, labels);
    camber_tile_stitcher *drawn, *labelled = NULL;
    camber_mvt *mvt;
    assert_int_equal(camber_tile_stitcher_create(it->context, ZOOM, &drawn), CAMBER_OK);
    if (labels)
        assert_int_equal(camber_tile_stitcher_create(it->context, ZOOM, &labelled), CAMBER_OK);
    const camber_schema *schema = &it->style.schema;
    const camber_mvt_desc desc = {.features = set,
                                  .stitcher = drawn,
                                  .labels = labelled,
                                  .layers = layers,
                                  .layer_count = 1,
                                  .wants_areas = schema->wants_areas,
                                  .wants_polygons = schema->wants_polygons,
                                  .wants_points = schema->wants_points};
    assert_int_equal(camber_mvt_create(it->context, &desc, &mvt), CAMBER_OK);
    for (uint32_t i = 0; i < 2; i++) {
        blob tile = tile_with(i ? 4096 : 0);
        const camber_tile_address place = {.zoom = ZOOM, .column = 2 + i, .row = 1};
        assert_int_equal(camber_mvt_read(mvt, &place, tile.bytes, tile.size), CAMBER_OK);
        blob_free(&tile);
    }
    assert_int_equal(camber_mvt_get_stats(mvt)->damaged_features, 0);
    expect_ok(it, camber_tile_stitcher_finish(drawn, set));
    if (labels)
        expect_ok(it, camber_tile_stitcher_finish_labels(labelled, set));
    expect_ok(it, camber_features_merge_and_weigh(set, 0, false, CAMBER_MERGE_STRAIGHT));
    camber_features_count(set);
    camber_mvt_destroy(mvt);
    camber_tile_stitcher_destroy(labelled);
    camber_tile_stitcher_destroy(drawn);
    return set;
}

static void test_tiles(void **state) {
    file_reading *it = *state;
    for (int what = 0; what < DRAWN; what++) {
        draw(it, what);
        camber_features *set = read_tiles(it, true), *without = read_tiles(it, false);
        expect_drawn_alike(set, without);
        /* Lines are joined; of an area the larger piece is left; each point is in one tile. */
        expect_labels(set, 2, 1, 2);
        camber_features_destroy(without);
        camber_features_destroy(set);
    }
}

/* A rectangle, units of tiles. */
typedef struct made_area {
    const char *name;
    double x0, y0, x1, y1;
    bool hole; /* in its middle, half as wide and high */
} made_area;

static size_t put_rectangle(const double box[4], bool hole, double *points) {
    const double corners[10] = {box[0], box[1], box[2], box[1], box[2], box[3], box[0], box[3], box[0], box[1]};
    for (size_t i = 0; i < 5; i++)
        for (size_t axis = 0; axis < 2; axis++)
            points[2 * i + axis] = corners[2 * (hole ? 4 - i : i) + axis] / (1 << ZOOM);
    return 5;
}

/* Adds an area to a tile; the stitcher cuts it. */
static void add_to_tile(camber_tile_stitcher *labels, const made_area *a, uint32_t class_index, uint32_t column,
                        uint32_t row) {
    double points[20];
    const double quarter[2] = {0.25 * (a->x1 - a->x0), 0.25 * (a->y1 - a->y0)};
    const double outer[4] = {a->x0, a->y0, a->x1, a->y1};
    const double inner[4] = {a->x0 + quarter[0], a->y0 + quarter[1], a->x1 - quarter[0], a->y1 - quarter[1]};
    size_t ends[2];
    ends[0] = put_rectangle(outer, false, points);
    ends[1] = ends[0] + put_rectangle(inner, true, points + 2 * ends[0]);
    const camber_tile_feature feature = {.column = column, .row = row, .class_index = class_index, .area = true};
    const camber_tile_lines lines = {points, ends, a->hole ? 2 : 1};
    assert_int_equal(camber_tile_stitcher_add(labels, &feature, &lines), CAMBER_OK);
}

/* Reads areas from all tiles that they touch, in this or the other order. */
static camber_features *cut_areas(file_reading *it, const made_area *areas, size_t count, bool backwards) {
    camber_features *set = create(it, true);
    camber_tile_stitcher *labels;
    uint32_t layer;
    assert_int_equal(camber_tile_stitcher_create(it->context, ZOOM, &labels), CAMBER_OK);
    assert_int_equal(camber_features_find_layer(set, "road", &layer), CAMBER_OK);
    for (uint32_t i = 0; i < 16 * count; i++) {
        const uint32_t k = backwards ? 16 * (uint32_t)count - 1 - i : i, column = k % 4, row = k / 4 % 4;
        const made_area *a = areas + k / 16;
        camber_value values[PROPERTIES] = {{0}};
        uint32_t class_index;
        values[NAME].type = CAMBER_VALUE_STRING;
        assert_int_equal(camber_features_intern(set, a->name, &values[NAME].string), CAMBER_OK);
        assert_int_equal(camber_features_find_class(set, layer, CAMBER_GEOMETRY_LABEL_AREA, values, &class_index),
                         CAMBER_OK);
        if (a->x0 < column + 1 && a->x1 > column && a->y0 < row + 1 && a->y1 > row)
            add_to_tile(labels, a, class_index, column, row);
    }
    expect_ok(it, camber_tile_stitcher_finish_labels(labels, set));
    camber_tile_stitcher_destroy(labels);
    return set;
}

/* Expects that of the rings of some areas those are left that begin in these tiles. */
static void expect_pieces(file_reading *it, const made_area *areas, size_t count, const double (*boxes)[4],
                          size_t box_count) {
    for (int backwards = 0; backwards < 2; backwards++) {
        camber_features *set = cut_areas(it, areas, count, backwards);
        size_t found = 0;
        for (size_t p = 0; p < set->polyline_count; p++) {
            double box[4] = {INFINITY, INFINITY, -INFINITY, -INFINITY};
            for (size_t i = set->offsets[p]; i < set->offsets[p + 1]; i++)
                for (int axis = 0; axis < 2; axis++) {
                    const double at = set->points[2 * i + (size_t)axis] * (1 << ZOOM);
                    box[axis] = fmin(box[axis], at);
                    box[axis + 2] = fmax(box[axis + 2], at);
                }
            for (size_t b = 0; b < box_count; b++)
                found += memcmp(box, boxes[b], sizeof box) == 0;
        }
        assert_int_equal(set->polyline_count, box_count);
        assert_int_equal(found, box_count);
        camber_features_destroy(set);
    }
}

/* An area that tiles cut has one label, in its largest piece. */
static void test_pieces(void **state) {
    file_reading *it = *state;
    const made_area lake = {"Lake", 0.5, 0.5, 2.25, 1.75, false};
    const double middle[][4] = {{1, 1, 2, 1.75}};
    expect_pieces(it, &lake, 1, middle, 1);

    /* Among pieces of the same size, the one that is farthest north, then west. */
    const made_area square = {"Square", 0.5, 0.5, 1.5, 1.5, false};
    const double first[][4] = {{0.5, 0.5, 1, 1}};
    expect_pieces(it, &square, 1, first, 1);

    /* A hole belongs to its piece, and is no part of its size: here it takes a quarter of the northern one. */
    const made_area ring = {"Ring", 1.125, 0.5, 1.875, 1.5, true};
    const double upper[][4] = {{1.125, 0.5, 1.875, 1}, {1.3125, 0.75, 1.6875, 1}};
    expect_pieces(it, &ring, 1, upper, 2);

    /* Areas of one name that do not meet, and areas of two names that do, have a label each. */
    const made_area apart[] = {{"Park", 0.25, 0.25, 0.5, 0.75, false}, {"Park", 1.25, 0.25, 1.5, 0.75, false},
                               {"Park", 0.75, 2, 1, 3, false},         {"Park", 1, 3, 1.5, 3.5, false},
                               {"Wood", 0.5, 1, 1, 1.5, false},        {"Field", 1, 1, 1.5, 1.5, false}};
    const double all[][4] = {{0.25, 0.25, 0.5, 0.75}, {1.25, 0.25, 1.5, 0.75}, {0.75, 2, 1, 3},
                             {1, 3, 1.5, 3.5},        {0.5, 1, 1, 1.5},        {1, 1, 1.5, 1.5}};
    expect_pieces(it, apart, 6, all, 6);
}

/* ---- Plans, bounds, other styles ---- */

/* Labels have neither rows nor entries, and nothing that they have is undrawn. */
static void test_plan(void **state) {
    static const char text[] =
        "{\"version\":8,\"sources\":{},\"layers\":[{\"id\":\"l\",\"type\":\"line\",\"filter\":[\"==\","
        "\"highway\",\"residential\"]}]}";
    file_reading *it = *state;
    camber_style *style;
    assert_int_equal(camber_style_parse(it->context, text, sizeof text - 1, "style.json", &style), CAMBER_OK);
    it->style.layers = style->layers;
    it->style.layer_count = style->layer_count;
    write_pbf(it, "file.pbf");
    draw(it, 7);
    camber_features *set = read_labelled(it, it->path, NULL, true), *without = read_labelled(it, it->path, NULL, false);
    const camber_view view = {
        .x = 0.5, .y = 0.5, .zoom = 15, .scale_px = 1e7, .cosine = 1, .ratio = 1, .width = 100, .height = 100};
    camber_plan plan, other;
    double bounds[4], others[4];
    assert_int_equal(camber_plan_create(set, &view, &plan), CAMBER_OK);
    assert_int_equal(camber_plan_create(without, &view, &other), CAMBER_OK);
    assert_int_equal(plan.pair_count, other.pair_count);
    assert_int_equal(plan.row_count, other.row_count);
    assert_int_equal(plan.undrawn, other.undrawn);
    assert_true(plan.undrawn > 0 && plan.pair_count > 0);
    const size_t count = other.all.first_entries[other.set_count];
    assert_int_equal(plan.all.first_entries[plan.set_count], count);
    assert_memory_equal(plan.all.entries, other.all.entries, count * sizeof *plan.all.entries);
    for (size_t c = 0; c < set->class_count; c++)
        if (camber_geometry_is_label(set->classes[c].geometry))
            assert_int_equal(plan.by_class.first[c], plan.by_class.first[c + 1]);
    assert_true(camber_features_get_bounds(set, bounds) && camber_features_get_bounds(without, others));
    assert_memory_equal(bounds, others, sizeof bounds);
    camber_plan_destroy(&other);
    camber_plan_destroy(&plan);
    camber_features_destroy(without);
    camber_features_destroy(set);
    it->style.layers = NULL;
    it->style.layer_count = 0;
    camber_style_destroy(style);
}

static bool takes_elms(const camber_style *style, camber_geometry_kind kind, const char *source_layer,
                       const camber_feature_view *feature) {
    return takes(style, kind, source_layer, feature) &&
           (!camber_geometry_is_label(kind) || strcmp(feature->values[NAME].string, "Elm") == 0);
}

/* Another style may have the set if its symbol layers take the same. */
static void test_suit(void **state) {
    file_reading *it = *state;
    write_pbf(it, "file.pbf");
    camber_schema other = it->style.schema;
    for (int labels = 0; labels < 2; labels++) {
        camber_features *set = read_labelled(it, it->path, NULL, labels);
        assert_true(camber_features_suit(set, &other, &it->style));
        other.takes = takes_elms;
        assert_int_equal(camber_features_suit(set, &other, &it->style), !labels);
        other = it->style.schema;
        other.wants_label_points = false;
        assert_false(camber_features_suit(set, &other, &it->style));
        other = it->style.schema;
        camber_features_destroy(set);
    }
}

static double rank_alike(const camber_style *style, const char *source_layer, const camber_feature_view *feature) {
    (void)style;
    (void)source_layer;
    (void)feature;
    return 1.0;
}

static size_t count_ends(const camber_features *set) {
    size_t count = 0;
    for (size_t i = 0; i < set->feature_count; i++)
        count += set->classes[set->feature_class[i]].is_ends;
    return count;
}

/* A set that is kept in a file has its labels and its ends when it is loaded. */
static void test_saved(void **state) {
    file_reading *it = *state;
    char path[128];
    it->style.schema.rank_ends = rank_alike;
    write_pbf(it, "file.pbf");
    draw(it, 7);
    camber_features *set = read_labelled(it, it->path, NULL, true), *loaded = create(it, false);
    snprintf(path, sizeof path, "%s", in_folder(it, "kept"));
    expect_ok(it, camber_features_save(set, 7, path, true));
    expect_ok(it, camber_features_load(loaded, NULL, 0, 7, path));
    assert_true(loaded->wants_labels);
    expect_same_lines(loaded, set);
    expect_labels(loaded, 2, 2, 2);
    assert_int_equal(loaded->stats.features, set->stats.features);
    assert_int_equal(loaded->stats.points, set->stats.points);
    assert_true(count_ends(set) > 0);
    assert_int_equal(count_ends(loaded), count_ends(set));
    camber_features_destroy(loaded);
    camber_features_destroy(set);
}

static double width_read_for(file_reading *it, bool labels, double zoom) {
    const camber_scene_desc scene = {
        .view = {.kind = CAMBER_VIEW_CENTER, .longitude = 5, .latitude = 5, .zoom = zoom, .width = 200, .height = 200}};
    camber_features *set = create(it, labels);
    expect_ok(it, camber_features_read_for(set, &scene));
    assert_true(set->has_region);
    const double width = set->region.x1 - set->region.x0;
    camber_features_destroy(set);
    return width;
}

/* A label may reach into a picture from farther than a line, and the labels of a zoom depend on more around them. */
static void test_margin(void **state) {
    const double between = width_read_for(*state, true, 10.5) / width_read_for(*state, false, 10.5);
    const double whole = width_read_for(*state, true, 10) / width_read_for(*state, false, 10);
    assert_true(between > 1.5 && between < 4.0);
    assert_true(whole > between && whole < 12.0);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {TEST(test_osm),     TEST(test_region), TEST(test_real_files),
                                       TEST(test_geojson), TEST(test_source), TEST(test_directions),
                                       TEST(test_tiles),   TEST(test_pieces), TEST(test_plan),
                                       TEST(test_suit),    TEST(test_saved),  TEST(test_margin)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
