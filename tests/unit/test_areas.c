/* Areas: rings as every reader gives them, what is told of wrong ones, pieces of vector tiles that meet without a seam,
 * regions inside of areas, borders that neighbours share. */
#include "file_reading.h"
#include "tilemaker.h"

#include "features/mercator.h"
#include "features/rings.h"
#include "formats/geojson.h"
#include "formats/mvt.h"
#include "tiles/census.h"
#include "tiles/features_file.h"
#include "validate/random.h"

#include <math.h>

static char *properties[] = {"class"};

static int set_up(void **state) {
    file_reading *it = calloc(1, sizeof *it);
    assert_non_null(it);
    reading_start(it, properties, 1);
    it->style.schema.wants_areas = true;
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    reading_end(*state);
    free(*state);
    return 0;
}

static double ring_area(const camber_features *set, size_t polyline) {
    double sum = 0.0;
    for (size_t i = set->offsets[polyline]; i + 1 < set->offsets[polyline + 1]; i++) {
        const double *p = set->points + 2 * i;
        sum += p[0] * p[3] - p[2] * p[1];
    }
    return sum;
}

static bool is_closed(const camber_features *set, size_t polyline) {
    return memcmp(set->points + 2 * set->offsets[polyline], set->points + 2 * (set->offsets[polyline + 1] - 1),
                  2 * sizeof *set->points) == 0;
}

/* signs: of the areas of all rings, '+' and '-', with a blank before each other feature. */
static void expect_rings(const camber_features *set, const char *signs) {
    char got[64] = "";
    for (size_t p = 0, used = 0; p < set->polyline_count; p++) {
        assert_true(used + 3 < sizeof got);
        assert_int_equal(camber_features_kind(set, p), CAMBER_GEOMETRY_AREA);
        assert_true(is_closed(set, p));
        if (p > 0 && set->polyline_feature[p] != set->polyline_feature[p - 1])
            got[used++] = ' ';
        const double area = ring_area(set, p);
        got[used++] = area > 0.0 ? '+' : area < 0.0 ? '-' : '0';
    }
    assert_string_equal(got, signs);
}

static void expect_counts(const camber_features *set, size_t closed, size_t turned, size_t empty) {
    assert_int_equal(set->stats.closed_rings, closed);
    assert_int_equal(set->stats.turned_rings, turned);
    assert_int_equal(set->stats.empty_rings, empty);
}

/* ---- GeoJSON, as a file and as a source of a style ---- */

static void read_geometry(file_reading *it, const char *geometry) {
    char text[4096];
    const int size = snprintf(text, sizeof text, "{\"type\":\"Feature\",\"properties\":{},\"geometry\":%s}", geometry);
    assert_true(size > 0 && (size_t)size < sizeof text);
    start_again(it);
    expect_ok(it, read_path(it, write_file(it, "areas.geojson", text, (size_t)size)));
}

static void read_source(file_reading *it, const char *geometry, unsigned kinds) {
    camber_geojson_stats stats;
    json_t *root = json_loads(geometry, 0, NULL);
    assert_non_null(root);
    const camber_geojson_desc desc = {.what = "source", .root = root, .kinds = kinds};
    start_again(it);
    expect_ok(it, camber_geojson_read(it->features, &desc, &stats));
    json_decref(root);
}

#define SQUARE "[[0,0],[10,0],[10,10],[0,10],[0,0]]"
#define HOLE "[[2,2],[2,4],[4,4],[4,2],[2,2]]"
#define HOLE_AS_OUTER "[[2,2],[4,2],[4,4],[2,4],[2,2]]"
#define POLYGON(rings) "{\"type\":\"Polygon\",\"coordinates\":[" rings "]}"

typedef struct known_polygon {
    const char *geometry, *rings;
    size_t closed, turned, empty;
} known_polygon;

static void test_polygons(void **state) {
    static const known_polygon known[] = {
        {POLYGON(SQUARE "," HOLE), "+-", 0, 0, 0},
        {POLYGON(SQUARE "," HOLE_AS_OUTER), "+-", 0, 1, 0},
        {POLYGON("[[0,0],[0,10],[10,10],[10,0],[0,0]]," HOLE), "+-", 0, 1, 0},
        {POLYGON("[[0,0],[0,10],[10,10],[10,0],[0,0]]"), "+", 0, 0, 0},
        {POLYGON("[[0,0],[10,0],[10,10],[0,10]]," HOLE), "+-", 1, 0, 0},                /* open */
        {POLYGON(SQUARE ",[[2,2],[4,4],[2,2]]"), "+", 0, 0, 1},                         /* two points that differ */
        {POLYGON("[[0,0],[0,10],[0,5],[0,0]]," HOLE), "", 0, 0, 2},                     /* a hole in nothing */
        {POLYGON("[[0,0],[10,10],[10,0],[0,10],[0,0]]"), NULL, 0, 0, 0},                /* it crosses itself */
        {POLYGON("[[0,0],[10,0],[10,10],[20,10],[10,10],[0,10],[0,0]]"), "+", 0, 0, 0}, /* a spike */
        {POLYGON(SQUARE ",[[22,22],[24,22],[24,24],[22,24],[22,22]]"), "+-", 0, 1, 0},  /* a hole outside */
        {"{\"type\":\"MultiPolygon\",\"coordinates\":[[" SQUARE "," HOLE "],[" HOLE_AS_OUTER "]]}", "+-+", 0, 0, 0},
        {"{\"type\":\"GeometryCollection\",\"geometries\":[" POLYGON(SQUARE) "," POLYGON(HOLE) "]}", "++", 0, 0, 0}};
    file_reading *it = *state;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const known_polygon *one = &known[i];
        read_source(it, one->geometry, 0);
        expect_counts(it->features, one->closed, one->turned, one->empty);
        read_source(it, one->geometry, CAMBER_KIND_AREA);
        expect_counts(it->features, one->closed, one->turned, one->empty);
        if (one->rings) {
            expect_rings(it->features, one->rings);
            assert_true(it->features->feature_count == (*one->rings != 0));
        } else {
            assert_int_equal(it->features->polyline_count, 1);
        }
        if (one->rings && !*one->rings)
            continue;
        read_geometry(it, one->geometry);
        expect_counts(it->features, one->closed, one->turned, one->empty);
        if (one->rings)
            expect_rings(it->features, one->rings);
        assert_int_equal(it->warnings, one->closed > 0);
        assert_int_equal(it->features->stats.skipped_features, 0);
    }
}

/* ---- Rings that cross themselves ---- */

static double side_of(const double *a, const double *b, const double *p) {
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/* Every two edges, one after the other. */
static bool any_two_cross(const double *points, size_t count) {
    for (size_t i = 0; i + 1 < count; i++)
        for (size_t k = 0; k < i; k++) {
            const double *a = points + 2 * i, *c = points + 2 * k;
            const bool parts = (side_of(a, a + 2, c) > 0) != (side_of(a, a + 2, c + 2) > 0);
            const bool is_parted = (side_of(c, c + 2, a) > 0) != (side_of(c, c + 2, a + 2) > 0);
            const bool next = i == k + 1 || (k == 0 && i + 2 == count);
            if (parts && is_parted && !next)
                return true;
        }
    return false;
}

/* A star of count points, whose first is its last; some with two of its points in each other's place. */
static void make_star(uint64_t *seed, double *points, size_t count, double least, bool swapped) {
    for (size_t i = 0; i + 1 < count; i++) {
        const double angle = 6.28 * (double)i / (double)(count - 1), radius = camber_random_between(seed, least, 0.4);
        points[2 * i] = 0.5 + radius * cos(angle);
        points[2 * i + 1] = 0.5 + radius * sin(angle);
    }
    if (swapped) {
        double *a = points + 2 * camber_random_below(seed, count - 1), kept[2], *b = points;
        memcpy(kept, a, sizeof kept);
        memcpy(a, b, sizeof kept);
        memcpy(b, kept, sizeof kept);
    }
    memcpy(points + 2 * (count - 1), points, 2 * sizeof *points);
}

static void test_crossing(void **state) {
    enum { MOST = 100001 };
    file_reading *it = *state;
    double *points = malloc(2 * MOST * sizeof *points);
    uint64_t seed = 5;
    size_t crossing = 0;
    assert_non_null(points);
    for (int i = 0; i < 2000; i++) {
        const size_t count = 4 + camber_random_below(&seed, 60);
        make_star(&seed, points, count, 0.2, i % 2);
        const bool crosses = any_two_cross(points, count);
        assert_int_equal(camber_ring_crosses(points, count), crosses);
        crossing += crosses;
    }
    assert_in_range(crossing, 500, 1000);
    make_star(&seed, points, MOST, 0.39999, false);
    assert_false(camber_ring_crosses(points, MOST));
    points[2 * 70000] = 0.95; /* far over to the other side */
    assert_true(camber_ring_crosses(points, MOST));
    free(points);
    read_geometry(it, POLYGON("[[0,0],[10,10],[10,0],[0,10],[0,0]]"));
    assert_int_equal(it->features->stats.crossing_rings, 1);
    read_geometry(it, POLYGON(SQUARE "," HOLE));
    assert_int_equal(it->features->stats.crossing_rings, 0);
}

/* ---- Spikes, and holes outside ---- */

static void expect_odd(file_reading *it, const char *geometry, size_t spiked, size_t outside) {
    read_geometry(it, geometry);
    assert_int_equal(it->features->stats.spiked_rings, spiked);
    assert_int_equal(it->features->stats.outside_holes, outside);
}

#define MULTI(polygons) "{\"type\":\"MultiPolygon\",\"coordinates\":[" polygons "]}"
#define ELSEWHERE "[[22,2],[22,4],[24,4],[24,2],[22,2]]"

static void test_odd(void **state) {
    static const double needle[] = {0, 0, 1, 0, 1, 1e-8, 0.3, 1e-8, 0.3, 1, 0, 0};
    static const double bar[] = {0, 0, 1, 0, 1, 1e-6, 0.3, 1e-6, 0.3, 1, 0, 0};
    static const double seam[] = {0.5, 0, 0, 0, 0, 1, 1, 1, 1, 0, 0.2, 0, 0.5, 0, 0.5, 0};
    static const double back[] = {0, 0, 0, 0, 1, 0, 1, 1, 1, 1, 2, 2, 2, 2, 1, 1, 0, 1, 0, 0};
    assert_false(camber_ring_has_spike(needle, 6)); /* two corners of its end, each a right angle */
    assert_false(camber_ring_has_spike(bar, 6));
    assert_true(camber_ring_has_spike(seam, 8));
    assert_true(camber_ring_has_spike(back, 10));
    file_reading *it = *state;
    expect_odd(it, POLYGON(SQUARE "," HOLE), 0, 0);
    expect_odd(it, POLYGON("[[0,0],[10,0],[10,10],[20,10],[10,10],[0,10],[0,0]]"), 1, 0);
    expect_odd(it, POLYGON("[[0,0],[10,0],[10,10],[30,10],[0,10],[0,0]]," HOLE), 1, 0); /* on along the ring */
    expect_odd(it, POLYGON(SQUARE "," ELSEWHERE), 0, 1);
    expect_odd(it, POLYGON(SQUARE "," HOLE "," ELSEWHERE "," ELSEWHERE), 0, 2);
    expect_odd(it, POLYGON(SQUARE ",[[0,0],[0,10],[10,10],[10,0],[0,0]]"), 0, 0); /* all of it */
    expect_odd(it, POLYGON(SQUARE ",[[10,2],[8,4],[10,6],[10,2]]"), 0, 0);        /* at its side */
    expect_odd(it, POLYGON(SQUARE ",[[10,2],[10,6],[12,4],[10,2]]"), 0, 1);       /* at it from outside */
    expect_odd(it, MULTI("[" SQUARE "," ELSEWHERE "],[[[20,0],[30,0],[30,10],[20,10],[20,0]]]"), 0, 0);
    expect_odd(it, MULTI("[" SQUARE "],[" ELSEWHERE "," HOLE "]"), 0, 0);
    expect_odd(it, MULTI("[" SQUARE "],[" ELSEWHERE ",[[42,2],[42,4],[44,4],[42,2]]]"), 0, 1);
}

/* How often a ring winds around a point, by the angles under which it sees the edges. */
static long turns_around(const double *points, size_t count, const double *at) {
    double turned = 0;
    for (size_t i = 0; i + 1 < count; i++) {
        const double ax = points[2 * i] - at[0], ay = points[2 * i + 1] - at[1];
        const double bx = points[2 * i + 2] - at[0], by = points[2 * i + 3] - at[1];
        turned += atan2(ax * by - ay * bx, ax * bx + ay * by);
    }
    return lround(turned / 6.283185307179586);
}

/* Small triangles in and beside stars, as GeoJSON has them. */
static void test_holes_of_stars(void **state) {
    enum { CORNERS = 24 };
    file_reading *it = *state;
    uint64_t seed = 11;
    size_t outside = 0;
    for (int i = 0; i < 300; i++) {
        double star[2 * CORNERS];
        char text[3000] = "[";
        size_t length = 1;
        make_star(&seed, star, CORNERS, 0.05, false);
        for (size_t k = 0; k < CORNERS; k++)
            length += (size_t)snprintf(text + length, sizeof text - length, "%s[%.17g,%.17g]", k ? "," : "",
                                       star[2 * k], star[2 * k + 1]);
        const double at[2] = {camber_random_between(&seed, 0.1, 0.9), camber_random_between(&seed, 0.1, 0.9)};
        snprintf(text + length, sizeof text - length, "],[[%.17g,%.17g],[%.17g,%.17g],[%.17g,%.17g],[%.17g,%.17g]]",
                 at[0], at[1], at[0], at[1] + 1e-4, at[0] + 1e-4, at[1], at[0], at[1]);
        char geometry[3200];
        snprintf(geometry, sizeof geometry, POLYGON("%s"), text);
        read_geometry(it, geometry);
        const bool is_outside = turns_around(star, CORNERS, at) == 0;
        assert_int_equal(it->features->stats.outside_holes, is_outside);
        outside += is_outside;
    }
    assert_in_range(outside, 50, 250);
}

/* ---- Kinds, points, the antimeridian, regions ---- */

/* Lines, outlines and areas are features of their own; what no layer draws is not read. */
static void test_kinds(void **state) {
    static const char both[] = "{\"type\":\"GeometryCollection\",\"geometries\":[" POLYGON(
        SQUARE) ",{\"type\":"
                "\"LineString\",\"coordinates\":[[1,1],[2,2]]}]}";
    file_reading *it = *state;
    read_geometry(it, both);
    assert_int_equal(it->features->feature_count, 2);
    assert_int_equal(camber_features_kind(it->features, 0), CAMBER_GEOMETRY_LINE);
    assert_int_equal(camber_features_kind(it->features, 1), CAMBER_GEOMETRY_AREA);
    it->style.schema.wants_polygons = true;
    read_geometry(it, both);
    assert_int_equal(it->features->feature_count, 3);
    assert_int_equal(camber_features_kind(it->features, 1), CAMBER_GEOMETRY_POLYGON);
    it->style.schema.wants_areas = false;
    read_geometry(it, both);
    assert_int_equal(it->features->feature_count, 2);
    read_source(it, both, 0);
    assert_int_equal(it->features->feature_count, 2);
    it->style.schema.wants_areas = true;
    read_source(it, both, 0);
    assert_int_equal(it->features->feature_count, 3);
    read_source(it, both, CAMBER_KIND_AREA);
    assert_int_equal(it->features->feature_count, 1);
    read_source(it, both, CAMBER_KIND_LINE | CAMBER_KIND_POLYGON);
    assert_int_equal(it->features->feature_count, 2);
}

/* A point that is not a number goes, and the ring goes on without it. */
static void test_invalid_points(void **state) {
    file_reading *it = *state;
    for (int outlines = 0; outlines < 2; outlines++) {
        it->style.schema.wants_polygons = outlines;
        read_geometry(it, POLYGON("[[0,0],[10,0],[NaN,5],[10,10],[0,10],[0,0]]"));
        assert_int_equal(it->features->stats.invalid_points, 1);
        const size_t last = it->features->polyline_count - 1;
        assert_int_equal(it->features->offsets[last + 1] - it->features->offsets[last], 5);
        assert_true(ring_area(it->features, last) > 0.0);
    }
}

/* A ring over the antimeridian goes on beyond the edge of the world; one around a pole goes on along the pole. */
static void test_antimeridian(void **state) {
    file_reading *it = *state;
    read_geometry(it, POLYGON("[[170,0],[-170,0],[-170,10],[170,10],[170,0]]"));
    expect_rings(it->features, "+");
    assert_true(fabs(ring_area(it->features, 0)) < 0.01);
    assert_int_equal(it->features->stats.antimeridian_splits, 1);
    const camber_region there = {0.98, 0.48, 0.99, 0.49}, east = {-0.01, 0.48, -0.005, 0.49},
                        west = {0.01, 0.48, 0.02, 0.49}, away = {0.5, 0.48, 0.51, 0.49};
    size_t next;
    assert_true(camber_features_touch(it->features, &there, 0, &next));
    assert_true(camber_features_touch(it->features, &east, 0, &next));
    assert_true(camber_features_touch(it->features, &west, 0, &next));
    assert_false(camber_features_touch(it->features, &away, 0, &next));
    static const char *const poles[] = {POLYGON("[[-180,-70],[-90,-75],[0,-70],[90,-75],[180,-70],[180,-90],[-180,-90],"
                                                "[-180,-70]]"),
                                        POLYGON("[[-150,-70],[-60,-70],[30,-70],[120,-70],[-150,-70]]")};
    for (size_t i = 0; i < 2; i++) {
        read_geometry(it, poles[i]);
        expect_rings(it->features, "+");
        double y;
        camber_mercator_project(0, -72, &(double){0}, &y);
        const camber_region pole = {0.4, 0.99, 0.41, 0.995}, equator = {0.4, 0.5, 0.41, 0.51};
        assert_true(camber_features_touch(it->features, &pole, 0, &next));
        assert_false(camber_features_touch(it->features, &equator, 0, &next));
        assert_true(ring_area(it->features, 0) > 2.0 * (1.0 - y) - 0.1);
    }
    read_geometry(it, POLYGON("[[-180,-80],[180,-80],[180,80],[-180,80],[-180,-80]]")); /* an ocean */
    assert_true(ring_area(it->features, 0) > 1.0);
}

/* ---- Regions ---- */

static void add_area(file_reading *it, const double *points, const size_t *counts, size_t rings) {
    uint32_t class_index;
    const camber_value value = {.type = CAMBER_VALUE_NULL};
    assert_int_equal(camber_features_find_class(it->features, 0, CAMBER_GEOMETRY_AREA, &value, &class_index),
                     CAMBER_OK);
    assert_int_equal(camber_features_add_feature(it->features, class_index), CAMBER_OK);
    for (size_t i = 0; i < rings; points += 2 * counts[i++])
        assert_int_equal(camber_features_add_polyline(it->features, points, counts[i]), CAMBER_OK);
}

/* A square with a square hole, and another square inside the hole. */
static const double island[] = {0.1, 0.1, 0.9, 0.1, 0.9, 0.9, 0.1, 0.9, 0.1, 0.1, /* clockwise as seen */
                                0.2, 0.2, 0.2, 0.8, 0.8, 0.8, 0.8, 0.2, 0.2, 0.2,
                                0.3, 0.3, 0.5, 0.3, 0.5, 0.5, 0.3, 0.5, 0.3, 0.3};
static const size_t island_counts[] = {5, 5, 5};

static void test_regions(void **state) {
    static const struct {
        camber_region region;
        bool meets;
    } known[] = {{{0.12, 0.12, 0.15, 0.15}, true},                                  /* inside, and no ring touches it */
                 {{0.6, 0.6, 0.7, 0.7}, false},                                     /* in the hole */
                 {{0.4, 0.4, 0.45, 0.45}, true},    {{0.75, 0.6, 0.85, 0.7}, true}, /* on the edge of the hole */
                 {{0.92, 0.5, 0.95, 0.6}, false},   {{1.12, 0.12, 1.15, 0.15}, true}, /* in the next world */
                 {{-0.88, 0.12, -0.85, 0.15}, true}};
    file_reading *it = *state;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        start_again(it);
        add_area(it, island, island_counts, 3);
        it->features->has_region = true;
        it->features->region = known[i].region;
        assert_int_equal(camber_features_merge_and_weigh(it->features, 0, true, CAMBER_MERGE_ANY), CAMBER_OK);
        if (it->features->polyline_count != (known[i].meets ? 3 : 0))
            fail_msg("region %zu: %zu rings", i, it->features->polyline_count);
        assert_int_equal(it->features->feature_count, known[i].meets);
    }
}

/* The same from a file for parts of a run, of boxes and of a region. */
static void test_saved(void **state) {
    file_reading *it = *state;
    add_area(it, island, island_counts, 3);
    add_area(it, (const double[]){0.95, 0.95, 0.96, 0.95, 0.96, 0.96, 0.95, 0.95}, (const size_t[]){4}, 1);
    assert_int_equal(camber_features_find_layer(it->features, "", &(uint32_t){0}), CAMBER_OK);
    assert_int_equal(camber_features_merge_and_weigh(it->features, 0, true, CAMBER_MERGE_ANY), CAMBER_OK);
    expect_ok(it, camber_features_save(it->features, 7, in_folder(it, "set"), true));
    for (int boxes = 0; boxes < 2; boxes++) {
        start_again(it);
        const camber_region box[2] = {{0.12, 0.12, 0.15, 0.15}, {0.6, 0.6, 0.7, 0.7}};
        it->features->has_region = !boxes;
        it->features->region = box[0];
        expect_ok(it, camber_features_load(it->features, box, boxes ? 2 : 0, 7, it->path));
        assert_int_equal(it->features->polyline_count, 3);
        expect_rings(it->features, "+-+");
    }
}

/* ---- Borders that neighbours share ---- */

enum { BORDER = 200 };

/* Two squares whose border wriggles, one on each side of it. */
static void test_shared_border(void **state) {
    file_reading *it = *state;
    double left[2 * (BORDER + 3)], right[2 * (BORDER + 3)];
    uint64_t seed = 5;
    for (size_t i = 0; i < BORDER; i++) {
        left[2 * i] = 0.5 + camber_random_between(&seed, -0.001, 0.001);
        left[2 * i + 1] = 0.2 + 0.001 * (double)i;
        memcpy(right + 2 * (BORDER - 1 - i), left + 2 * i, 2 * sizeof *left);
    }
    memcpy(left + 2 * BORDER, (const double[]){0.3, 0.4, 0.3, 0.2, left[0], left[1]}, 6 * sizeof *left);
    memcpy(right + 2 * BORDER, (const double[]){0.7, 0.2, 0.7, 0.4, right[0], right[1]}, 6 * sizeof *right);
    const size_t count = BORDER + 3;
    add_area(it, left, &count, 1);
    add_area(it, right, &count, 1);
    assert_int_equal(camber_features_merge_and_weigh(it->features, 0, true, CAMBER_MERGE_ANY), CAMBER_OK);
    assert_int_equal(it->features->polyline_count, 2);
    assert_int_equal(it->features->stats.merged_polylines, 0);
    const float *importance = it->features->importance;
    size_t kept = 0;
    for (size_t i = 0; i < BORDER; i++) {
        assert_memory_equal(it->features->points + 2 * i, it->features->points + 2 * (count + BORDER - 1 - i), 16);
        assert_true(importance[i] == importance[count + BORDER - 1 - i]);
        kept += importance[i] >= 0.0007f;
    }
    assert_true(kept > 2 && kept < BORDER / 2);
}

/* ---- Vector tiles ---- */

enum { ZOOM = 3 };

typedef struct tiles {
    camber_tile_stitcher *stitcher;
    camber_mvt *mvt;
} tiles;

static void tiles_begin(file_reading *it, tiles *t) {
    static const char *const layers[] = {"water"};
    start_again(it);
    assert_int_equal(camber_tile_stitcher_create(it->context, ZOOM, &t->stitcher), CAMBER_OK);
    const camber_mvt_desc desc = {
        .features = it->features, .stitcher = t->stitcher, .layers = layers, .layer_count = 1, .wants_areas = true};
    assert_int_equal(camber_mvt_create(it->context, &desc, &t->mvt), CAMBER_OK);
}

/* A tile with one area of an id: rings of so many points, without their last. */
static void tiles_add(const tiles *t, uint32_t column, uint32_t row, const int *units, const size_t *counts,
                      size_t rings) {
    blob tile = {0}, layer = begin_layer("water", 4096), feature = {0};
    uint32_t words[512];
    int cursor[2] = {0, 0};
    size_t used = 0;
    for (size_t i = 0; i < rings; units += 2 * counts[i++])
        used = add_path(words, used, units, counts[i], true, cursor);
    put_number(&feature, 1, 77);
    put_number(&feature, 3, 3);
    put_packed(&feature, 4, words, used);
    put_message(&layer, 2, &feature);
    put_layer(&tile, &layer);
    const camber_tile_address place = {
        .zoom = ZOOM, .column = column, .row = row, .open_sides = CAMBER_SIDE_WEST | CAMBER_SIDE_EAST};
    assert_int_equal(camber_mvt_read(t->mvt, &place, tile.bytes, tile.size), CAMBER_OK);
    blob_free(&tile);
}

static void tiles_end(file_reading *it, tiles *t) {
    assert_int_equal(camber_mvt_get_stats(t->mvt)->damaged_features, 0);
    assert_int_equal(camber_tile_stitcher_finish(t->stitcher, it->features), CAMBER_OK);
    camber_mvt_destroy(t->mvt);
    camber_tile_stitcher_destroy(t->stitcher);
}

/* Sums, over all edges on the line x, the way that they go along it: 0 where all take each other away. */
static double along_side(const camber_features *set, double x, double *length) {
    double sum = 0.0;
    *length = 0.0;
    for (size_t p = 0; p < set->polyline_count; p++)
        for (size_t i = set->offsets[p]; i + 1 < set->offsets[p + 1]; i++) {
            const double *a = set->points + 2 * i;
            if (a[0] != x || a[2] != x)
                continue;
            sum += a[3] - a[1];
            *length += fabs(a[3] - a[1]);
        }
    return sum;
}

/* Two tiles hold the same slanted area with their buffers, of 100 units and of 300: their pieces end on the side
 * between them, and their edges along it take each other away. */
static void test_pieces(void **state) {
    file_reading *it = *state;
    tiles t;
    tiles_begin(it, &t);
    tiles_add(&t, 2, 1, (const int[]){3000, 1000, 4196, 1300, 4196, 2300, 3000, 2000}, (const size_t[]){4}, 1);
    tiles_add(&t, 3, 1, (const int[]){-300, 1175, 600, 1401, 600, 2401, -300, 2175}, (const size_t[]){4}, 1);
    tiles_end(it, &t);
    const camber_features *set = it->features;
    expect_rings(set, "++"); /* one feature */
    double length;
    assert_true(fabs(along_side(set, 3.0 / 8.0, &length)) < 0.5 / 4096 / 8);
    assert_true(length > 1999.0 / 4096 / 8);
    for (size_t p = 0; p < 2; p++)
        for (size_t i = set->offsets[p]; i < set->offsets[p + 1]; i++)
            assert_true(p == 0 ? set->points[2 * i] <= 3.0 / 8.0 : set->points[2 * i] >= 3.0 / 8.0);
    /* Points on the side stay, however much is left out. */
    assert_int_equal(camber_features_merge_and_weigh(it->features, 0, true, CAMBER_MERGE_STRAIGHT), CAMBER_OK);
    camber_features_pin_borders(it->features, 0, ZOOM);
    size_t pinned = 0;
    for (size_t i = 0; i < set->point_count; i++)
        if (set->points[2 * i] == 3.0 / 8.0) {
            assert_true(set->importance[i] == INFINITY);
            pinned++;
        }
    assert_true(pinned >= 4);
    expect_counts(set, 0, 0, 0);
}

/* An area that a tile is wholly inside of, with its buffer and with a hole around a corner. */
static void test_full_tile(void **state) {
    file_reading *it = *state;
    tiles t;
    tiles_begin(it, &t);
    tiles_add(&t, 2, 1,
              (const int[]){-64, -64, 4160, -64, 4160, 4160, -64, 4160, -20, -20, -20, 100, 100, 100, 100, -20},
              (const size_t[]){4, 4}, 2);
    tiles_end(it, &t);
    expect_rings(it->features, "+-");
    const double unit = 1.0 / 4096 / 8, side = 4096 * unit;
    assert_true(fabs(ring_area(it->features, 0) - 2.0 * side * side) < 1e-12);
    assert_true(fabs(ring_area(it->features, 1) + 2.0 * 100 * unit * 100 * unit) < 1e-12);
    assert_int_equal(it->features->offsets[1], 5);
    /* Beside the tile there is nothing, and nothing is counted. */
    tiles_begin(it, &t);
    tiles_add(&t, 2, 1, (const int[]){4100, 10, 4150, 10, 4150, 60, 4100, 60}, (const size_t[]){4}, 1);
    tiles_add(&t, 2, 1, (const int[]){4096, 10, 4150, 10, 4150, 60, 4096, 60}, (const size_t[]){4}, 1);
    tiles_end(it, &t);
    assert_int_equal(it->features->polyline_count, 0);
    expect_counts(it->features, 0, 0, 0);
}

/* Roles go by the sign of the first ring, and so does what is turned. */
static void test_tile_winding(void **state) {
    static const int clockwise[] = {100, 100,  900, 100,  900, 900,  100, 900,  200, 200, 200, 300, 300, 300, 300,
                                    200, 1000, 100, 1100, 100, 1100, 200, 1000, 200, 5,   5,   9,   9,   5,   5};
    static const size_t counts[] = {4, 4, 4, 3};
    file_reading *it = *state;
    int turned[24];
    tiles t;
    tiles_begin(it, &t);
    tiles_add(&t, 2, 1, clockwise, counts, 4);
    tiles_end(it, &t);
    expect_rings(it->features, "+-+");
    expect_counts(it->features, 0, 0, 1);
    for (size_t ring = 0; ring < 3; ring++)
        for (size_t i = 0; i < 4; i++)
            memcpy(turned + 2 * (4 * ring + i), clockwise + 2 * (4 * ring + 3 - i), 2 * sizeof *turned);
    tiles_begin(it, &t);
    tiles_add(&t, 2, 1, turned, counts, 3);
    tiles_end(it, &t);
    expect_rings(it->features, "+-+");
    expect_counts(it->features, 0, 3, 0);
}

/* Buildings of a city: each is cut by the sides of its tiles, and its pieces take each other away along them. */
static void test_real_tiles(void **state) {
    enum { DATA_ZOOM = 15 };
    file_reading *it = *state;
    const camber_source_desc desc = {.path = CAMBER_TEST_DATA "/santa_cruz/osm.mbtiles", .layer = "buildings"};
    expect_ok(it, camber_features_read(it->features, &desc));
    const camber_features *set = it->features;
    double sum = 0.0, length = 0.0, area = 0.0;
    for (size_t p = 0; p < set->polyline_count; p++) {
        assert_int_equal(camber_features_kind(set, p), CAMBER_GEOMETRY_AREA);
        assert_true(is_closed(set, p));
        area += ring_area(set, p);
        for (size_t i = set->offsets[p]; i + 1 < set->offsets[p + 1]; i++) {
            const double *a = set->points + 2 * i, x = ldexp(a[0], DATA_ZOOM);
            if (a[0] != a[2] || x != floor(x))
                continue;
            assert_true(set->importance[i] == INFINITY && set->importance[i + 1] == INFINITY);
            sum += a[3] - a[1];
            length += fabs(a[3] - a[1]);
        }
    }
    assert_true(set->feature_count > 4000 && set->polyline_count > set->feature_count);
    assert_true(area > 5e-9 && area < 5.2e-9); /* twice, in squares of the world */
    assert_true(length > 1e-4 && fabs(sum) < 1e-3 * length);
    assert_int_equal(set->stats.turned_rings, 0);
}

/* ---- Tiles that are drawn ---- */

static void expect_tile(const camber_census *census, uint32_t column, uint32_t row, size_t polylines) {
    const camber_metatile *found = camber_census_find(census, column / 2, row / 2);
    const uint64_t bit = UINT64_C(1) << (row % 2 * 2 + column % 2);
    if (polylines == 0) {
        assert_true(!found || !(found->tiles & bit));
        return;
    }
    assert_non_null(found);
    assert_true(found->tiles & bit);
    assert_int_equal(found->end - found->first, polylines);
}

/* Tiles that lie inside of rings have something to draw; one in a hole has the hole with its outer ring. */
static void test_census(void **state) {
    file_reading *it = *state;
    camber_workers workers;
    camber_census census;
    float reach = 0.0f;
    add_area(it, island, island_counts, 3);
    assert_int_equal(camber_features_set_importance(it->features, 0), CAMBER_OK);
    camber_zoom_plan plan = {.context = it->context, .features = it->features, .class_reach_px = &reach};
    plan.view.scale_px = 512.0 * 32.0;
    assert_int_equal(camber_workers_make(it->context, 2, &workers), CAMBER_OK);
    assert_int_equal(camber_census_make(&plan, 5, 2, &workers, &census), CAMBER_OK);
    expect_tile(&census, 4, 4, 1); /* 0.125 to 0.156: inside the square, and touched by nothing */
    expect_tile(&census, 5, 16, 1);
    expect_tile(&census, 20, 20, 2); /* in the hole */
    expect_tile(&census, 12, 12, 3); /* in the inner square */
    expect_tile(&census, 1, 1, 0);
    expect_tile(&census, 30, 16, 0);
    camber_census_free(&census);
    reach = -1.0f; /* not drawn */
    assert_int_equal(camber_census_make(&plan, 5, 2, &workers, &census), CAMBER_OK);
    expect_tile(&census, 4, 4, 0);
    camber_census_free(&census);
    camber_workers_free(&workers);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_polygons, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_crossing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_odd, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_holes_of_stars, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_kinds, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_invalid_points, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_antimeridian, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_regions, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_saved, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_shared_border, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_pieces, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_full_tile, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_tile_winding, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_real_tiles, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_census, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
