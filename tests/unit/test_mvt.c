/* Vector tiles' messages: geometry, tags and values as they stand, and what is damaged counted. */
#include "formats/mvt.h"
#include "style/style.h"
#include "tilemaker.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { ZOOM = 3 };

static char *properties[] = {"class", "width", "id2"};

typedef struct fixture {
    camber_context *context;
    struct camber_style style;
    camber_features *features;
    camber_tile_stitcher *tiles;
    camber_mvt *mvt;
} fixture;

static void begin(fixture *it) {
    static const char *const layers[] = {"road"};
    assert_int_equal(camber_features_create(it->context, &it->style, &it->features), CAMBER_OK);
    assert_int_equal(camber_tile_stitcher_create(it->context, ZOOM, &it->tiles), CAMBER_OK);
    const camber_mvt_desc desc = {.features = it->features,
                                  .stitcher = it->tiles,
                                  .layers = layers,
                                  .layer_count = 1,
                                  .wants_polygons = true,
                                  .wants_points = it->style.schema.wants_points};
    assert_int_equal(camber_mvt_create(it->context, &desc, &it->mvt), CAMBER_OK);
}

static void end(fixture *it) {
    camber_mvt_destroy(it->mvt);
    camber_tile_stitcher_destroy(it->tiles);
    camber_features_destroy(it->features);
}

static int set_up(void **state) {
    fixture *it = calloc(1, sizeof *it);
    assert_non_null(it);
    assert_int_equal(camber_context_create(NULL, &it->context), CAMBER_OK);
    it->style =
        (struct camber_style){.context = it->context, .schema = {.properties = properties, .property_count = 3}};
    begin(it);
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    fixture *it = *state;
    end(it);
    camber_context_destroy(it->context);
    free(it);
    return 0;
}

static void start_again(fixture *it) {
    end(it);
    begin(it);
}

/* Reads the tile 2/1 and frees it. */
static const camber_mvt_stats *read_tile(fixture *it, blob *tile) {
    const camber_tile_address place = {.zoom = ZOOM, .column = 2, .row = 1};
    assert_int_equal(camber_mvt_read(it->mvt, &place, tile->bytes, tile->size), CAMBER_OK);
    assert_int_equal(camber_tile_stitcher_finish(it->tiles, it->features), CAMBER_OK);
    blob_free(tile);
    return camber_mvt_get_stats(it->mvt);
}

/* points: units of 1/extent of the tile. */
static void expect(const fixture *it, size_t polyline, double extent, size_t count, const double *units) {
    const camber_features *set = it->features;
    assert_true(polyline < set->polyline_count);
    assert_int_equal(set->offsets[polyline + 1] - set->offsets[polyline], count);
    for (size_t i = 0; i < 2 * count; i++) {
        const double got = set->points[2 * set->offsets[polyline] + i] * 8, at = (i & 1 ? 1 : 2) + units[i] / extent;
        if (fabs(got - at) > 1e-12)
            fail_msg("polyline %zu, ordinate %zu: %.9g is not %.9g", polyline, i, got, at);
    }
}

static const camber_value *value_of(const fixture *it, size_t feature, size_t property) {
    const camber_features *set = it->features;
    return &set->values[set->classes[set->feature_class[feature]].first_value + property];
}

static void test_lines(void **state) {
    fixture *it = *state;
    const unsigned extents[] = {4096, 512, 3000, 8192, 0};
    for (size_t e = 0; e < sizeof extents / sizeof *extents; e++) {
        const double extent = extents[e] ? extents[e] : 4096;
        blob tile = {0}, layer = begin_layer("road", extents[e]), other = begin_layer("water", 4096);
        put_feature(&layer, 7, -1, 0, false, (int[]){10, 20, 30, 5, 100, 400}, 3);
        put_feature(&layer, 8, -1, 0, true, (int[]){10, 10, 90, 10, 90, 90}, 3);
        put_feature(&other, 9, -1, 0, false, (int[]){10, 20, 30, 5}, 2);
        put_layer(&tile, &other);
        put_layer(&tile, &layer);
        const camber_mvt_stats *stats = read_tile(it, &tile);
        assert_int_equal(stats->damaged_features, 0);
        assert_int_equal(it->features->polyline_count, 2);
        expect(it, 0, extent, 3, (double[]){10, 20, 30, 5, 100, 400});
        expect(it, 1, extent, 4, (double[]){10, 10, 90, 10, 90, 90, 10, 10});
        assert_int_equal(it->features->classes[it->features->feature_class[1]].geometry, CAMBER_GEOMETRY_POLYGON);
        assert_string_equal(it->features->layer_names[0], "road");
        start_again(it);
    }
}

/* Points are read where they are wanted: those of the tile, and of its buffer where the next tile is not read. */
static void test_points(void **state) {
    static const int units[] = {10, 20, -1, 20, 4095, 4095, 4096, 7, 10, -5, 10, 4100, -3, -3, 0, 0};
    static const struct {
        unsigned open_sides;
        size_t count;
        double points[16];
    } cases[] = {{0, 3, {10, 20, 4095, 4095, 0, 0}},
                 {CAMBER_SIDE_WEST, 4, {10, 20, -1, 20, 4095, 4095, 0, 0}},
                 {CAMBER_SIDE_EAST | CAMBER_SIDE_SOUTH, 5, {10, 20, 4095, 4095, 4096, 7, 10, 4100, 0, 0}},
                 {CAMBER_SIDE_NORTH | CAMBER_SIDE_WEST, 6, {10, 20, -1, 20, 4095, 4095, 10, -5, -3, -3, 0, 0}}};
    fixture *it = *state;
    for (size_t i = 0; i < 2 * sizeof cases / sizeof *cases; i++) {
        const size_t count = i % 2 ? cases[i / 2].count : 0;
        it->style.schema.wants_points = i % 2;
        start_again(it);
        blob tile = {0}, layer = begin_layer("road", 4096);
        put_points(&layer, units, 8);
        put_feature(&layer, 7, -1, 0, false, (int[]){10, 20, 30, 5}, 2);
        put_layer(&tile, &layer);
        const camber_tile_address place = {.zoom = ZOOM, .column = 2, .row = 1, .open_sides = cases[i / 2].open_sides};
        assert_int_equal(camber_mvt_read(it->mvt, &place, tile.bytes, tile.size), CAMBER_OK);
        assert_int_equal(camber_tile_stitcher_finish(it->tiles, it->features), CAMBER_OK);
        blob_free(&tile);
        assert_int_equal(camber_mvt_get_stats(it->mvt)->skipped_features, i % 2 == 0);
        assert_int_equal(it->features->polyline_count, count + 1);
        assert_int_equal(it->features->feature_count, count ? 2 : 1);
        for (size_t p = 0; p < count; p++) {
            expect(it, p, 4096, 1, cases[i / 2].points + 2 * p);
            assert_int_equal(camber_features_kind(it->features, p), CAMBER_GEOMETRY_POINT);
        }
    }
}

/* Values of all types, in the order in which the specification has them. */
static void test_values(void **state) {
    fixture *it = *state;
    blob tile = {0}, layer = begin_layer("road", 4096);
    put_key(&layer, "other");
    put_key(&layer, "width");
    blob values[7] = {{0}};
    const float small = 2.5f;
    const double large = 1e300;
    put_bytes(&values[0], 1, "text", 4);
    put_varint(&values[1], 2 << 3 | 5);
    blob_put(&values[1], &small, 4);
    put_varint(&values[2], 3 << 3 | 1);
    blob_put(&values[2], &large, 8);
    put_number(&values[3], 4, (uint64_t)-5);
    put_number(&values[4], 5, UINT64_C(1) << 40);
    put_number(&values[5], 6, 9); /* -5 in zigzag */
    put_number(&values[6], 7, 1);
    for (int i = 0; i < 7; i++) {
        put_message(&layer, 4, &values[i]);
        put_feature(&layer, (uint64_t)i + 1, 1, i, false, (int[]){10, 20 * i, 30, 20 * i}, 2);
    }
    put_feature(&layer, 8, 0, 0, false, (int[]){10, 200, 30, 200}, 2);
    put_layer(&tile, &layer);
    assert_int_equal(read_tile(it, &tile)->damaged_features, 0);
    assert_int_equal(it->features->feature_count, 8);
    const camber_value_type types[] = {CAMBER_VALUE_STRING, CAMBER_VALUE_NUMBER, CAMBER_VALUE_NUMBER,
                                       CAMBER_VALUE_NUMBER, CAMBER_VALUE_NUMBER, CAMBER_VALUE_NUMBER,
                                       CAMBER_VALUE_BOOL,   CAMBER_VALUE_NULL};
    const double numbers[] = {0, 2.5, 1e300, -5, 1099511627776.0, -5, 0, 0};
    for (size_t i = 0; i < 8; i++) {
        const camber_value *value = value_of(it, i, 1);
        assert_int_equal(value->type, types[i]);
        if (value->type == CAMBER_VALUE_NUMBER)
            assert_true(value->number == numbers[i]);
        assert_int_equal(value_of(it, i, 0)->type, CAMBER_VALUE_NULL);
    }
    assert_string_equal(value_of(it, 0, 1)->string, "text");
    assert_true(value_of(it, 6, 1)->boolean);
}

/* Where the style wants them: the id, a promoted one, and all properties as an object. */
static void test_ids_and_all(void **state) {
    fixture *it = *state;
    it->style.schema.wants_id = it->style.schema.wants_all_properties = true;
    blob tile = {0}, layer = begin_layer("road", 4096);
    put_key(&layer, "zeta");
    put_key(&layer, "alpha");
    put_text_value(&layer, "a");
    put_feature(&layer, 77, 0, 0, false, (int[]){10, 20, 30, 5}, 2);
    put_feature(&layer, 0, 1, 0, false, (int[]){10, 20, 30, 5}, 2);
    put_layer(&tile, &layer);
    read_tile(it, &tile);
    assert_int_equal(it->features->feature_count, 2);
    const camber_feature_class *first = &it->features->classes[it->features->feature_class[0]];
    const camber_feature_class *second = &it->features->classes[it->features->feature_class[1]];
    assert_int_equal(first->id.type, CAMBER_VALUE_NUMBER);
    assert_true(first->id.number == 77);
    assert_int_equal(second->id.type, CAMBER_VALUE_NULL);
    assert_int_equal(first->all->count, 1);
    assert_string_equal(camber_object_get(first->all, "zeta")->string, "a");
    assert_null(camber_object_get(first->all, "alpha"));
    assert_non_null(camber_object_get(second->all, "alpha"));
}

static void test_clips(void **state) {
    fixture *it = *state;
    static const char *const layers[] = {"road"};
    const camber_mvt_desc desc = {
        .features = it->features, .stitcher = it->tiles, .layers = layers, .layer_count = 1, .wants_progress = true};
    camber_mvt_destroy(it->mvt);
    assert_int_equal(camber_mvt_create(it->context, &desc, &it->mvt), CAMBER_OK);
    blob tile = {0}, layer = begin_layer("road", 4096);
    put_key(&layer, "mapbox_clip_end");
    put_double_value(&layer, 0.25);
    put_feature(&layer, 1, 0, 0, false, (int[]){10, 20, 30, 5}, 2);
    put_layer(&tile, &layer);
    read_tile(it, &tile);
    assert_non_null(it->features->progress);
    assert_true(it->features->progress[0] == 0.0f && it->features->progress[1] == 0.25f);
}

/* ---- Damage ---- */

static void expect_damage(fixture *it, const uint32_t *words, size_t count, bool ring, size_t polylines) {
    blob tile = {0}, layer = begin_layer("road", 4096), feature = {0};
    put_number(&feature, 3, ring ? 3 : 2);
    put_packed(&feature, 4, words, count);
    put_message(&layer, 2, &feature);
    put_layer(&tile, &layer);
    const camber_mvt_stats *stats = read_tile(it, &tile);
    assert_int_equal(stats->damaged_features, 1);
    assert_non_null(strstr(stats->damage, "tile 3/2/1, layer road: "));
    assert_int_equal(it->features->polyline_count, polylines);
    start_again(it);
}

static void test_damaged_geometry(void **state) {
    fixture *it = *state;
    const uint32_t move = 9, huge = UINT32_MAX & ~7u;
    expect_damage(it, (uint32_t[]){move, 2, 2, 2 | huge, 8, 8, 8, 8}, 8, false, 1);  /* 2^29 points */
    expect_damage(it, (uint32_t[]){1 | huge, 8, 8, 8}, 4, false, 0);                 /* 2^29 lines */
    expect_damage(it, (uint32_t[]){2 | 2 << 3, 8, 8, 8, 8}, 5, false, 0);            /* starts nowhere */
    expect_damage(it, (uint32_t[]){move, 2, 2, 3 | 1 << 3, 8, 8}, 6, false, 0);      /* no such command */
    expect_damage(it, (uint32_t[]){move, 2, 2}, 3, false, 0);                        /* a point */
    expect_damage(it, (uint32_t[]){move, 2, 2, 2 | 1 << 3, 8}, 5, false, 0);         /* half a point */
    expect_damage(it, (uint32_t[]){move, 2, 2, 2 | 1 << 3, 8, 8, 15}, 7, false, 1);  /* a closed line */
    expect_damage(it, (uint32_t[]){move, 2, 2, 2 | 2 << 3, 8, 8, 8, 0}, 8, true, 1); /* an open ring */
    expect_damage(it, (uint32_t[]){15}, 1, true, 0);                                 /* nothing to close */
    expect_damage(it, (uint32_t[]){2}, 1, false, 0);                                 /* no points at all */
    /* Coordinates as far as 32 bits go: cut at the border. */
    const uint32_t far[] = {move,           2, 2,          2 | 3 << 3,    UINT32_MAX, UINT32_MAX,
                            UINT32_MAX - 1, 0, UINT32_MAX, UINT32_MAX - 1};
    blob tile = {0}, layer = begin_layer("road", 1), feature = {0};
    put_number(&feature, 3, 2);
    put_packed(&feature, 4, far, sizeof far / sizeof *far);
    put_message(&layer, 2, &feature);
    put_layer(&tile, &layer);
    read_tile(it, &tile);
    for (size_t i = 0; i < it->features->point_count; i++)
        assert_true(it->features->points[2 * i] >= 0.25 && it->features->points[2 * i] <= 0.375);
}

static void test_damaged_tags(void **state) {
    fixture *it = *state;
    blob tile = {0}, layer = begin_layer("road", 4096);
    put_key(&layer, "class");
    put_text_value(&layer, "a");
    put_feature(&layer, 1, 0, 1, false, (int[]){10, 20, 30, 5}, 2);
    put_feature(&layer, 2, 1, 0, false, (int[]){10, 20, 30, 5}, 2);
    put_feature(&layer, 3, 0, 0, false, (int[]){10, 20, 30, 5}, 2);
    put_layer(&tile, &layer);
    assert_int_equal(read_tile(it, &tile)->damaged_features, 2);
    assert_int_equal(it->features->feature_count, 3);
    assert_string_equal(value_of(it, 2, 0)->string, "a");
}

static void test_damaged_layers(void **state) {
    fixture *it = *state;
    blob tile = {0}, layer = begin_layer("road", 4096), versioned = {0}, flat = begin_layer("road", 4096);
    put_bytes(&versioned, 1, "road", 4);
    put_number(&versioned, 15, 9);
    put_number(&flat, 5, 0); /* the last extent holds */
    put_bytes(&layer, 2, "\xff\xff\xff", 3);
    put_layer(&tile, &layer);
    put_layer(&tile, &versioned);
    put_layer(&tile, &flat);
    put_bytes(&tile, 3, "\x0a\xff\x01", 3);
    assert_int_equal(read_tile(it, &tile)->damaged_features, 4);
}

/* Whatever it is: a count, no crash, and next to no time. */
static void test_no_tiles(void **state) {
    fixture *it = *state;
    uint32_t random = 5;
    const camber_tile_address place = {.zoom = ZOOM};
    for (size_t round = 0; round < 2000; round++) {
        unsigned char noise[200];
        for (size_t i = 0; i < sizeof noise; i++)
            noise[i] = (unsigned char)((random = random * 1664525u + 1013904223u) >> 24);
        noise[0] = 0x1a; /* a layer */
        noise[1] = (unsigned char)(round % 190);
        assert_int_equal(camber_mvt_read(it->mvt, &place, noise, round % sizeof noise), CAMBER_OK);
    }
    assert_true(camber_mvt_get_stats(it->mvt)->damaged_features > 1000);
    /* Eight million layers of two bytes each ask for more memory than a tile may have. */
    blob tile = {0};
    for (size_t i = 0; i < (size_t)8 << 20; i++)
        put_bytes(&tile, 3, "", 0);
    const size_t before = camber_mvt_get_stats(it->mvt)->damaged_features;
    assert_int_equal(camber_mvt_read(it->mvt, &place, tile.bytes, tile.size), CAMBER_OK);
    assert_int_equal(camber_mvt_get_stats(it->mvt)->damaged_features, before + 1);
    blob_free(&tile);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_lines),        TEST(test_points),         TEST(test_values),
        TEST(test_ids_and_all),  TEST(test_clips),          TEST(test_damaged_geometry),
        TEST(test_damaged_tags), TEST(test_damaged_layers), TEST(test_no_tiles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
