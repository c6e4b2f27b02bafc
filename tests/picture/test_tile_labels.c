/* Labels in tiles: a tile that is drawn by itself is the cut of a picture of 8 x 8 tiles, but for a few bytes that
 * differ by one level if GL draws, which rounds by the picture. What kernels draw is compared to the byte by
 * test_same_tiles, and which labels are there, and where, to the last bit by test_zoom_labels. */
#include "pictures.h"

#include "camber_tiles.h"

#include <jansson.h>
#include <math.h>

static const char MONACO[] = CAMBER_TEST_DATA "/monaco/monaco.osm.pbf";
static const double MONACO_AT[2] = {7.4235, 43.7365}; /* longitude, latitude */

typedef struct labelled_map {
    camber_style *style;
    camber_features *features;
    camber_tiles_engine *whole, *single;
} labelled_map;

/* Keeps the layers of a shipped style that draw labels, and its background. more: another layer, or "". */
static camber_style *make_style(const fixture *s, const char *name, bool labels_only, const char *more) {
    size_t size;
    camber_style *style = NULL;
    const char *text = camber_style_get_text(name, CAMBER_THEME_LIGHT, &size);
    json_t *json = json_loadb(text, size, 0, NULL), *layers = json_object_get(json, "layers");
    assert_non_null(json);
    for (size_t i = json_array_size(layers); i-- > 0 && labels_only;) {
        const char *type = json_string_value(json_object_get(json_array_get(layers, i), "type"));
        if (strcmp(type, "symbol") != 0 && strcmp(type, "background") != 0)
            json_array_remove(layers, i);
    }
    if (*more)
        json_array_append_new(layers, json_loads(more, 0, NULL));
    char *kept = json_dumps(json, JSON_COMPACT);
    assert_int_equal(camber_style_parse(s->context, kept, strlen(kept), name, &style), CAMBER_OK);
    free(kept);
    json_decref(json);
    return style;
}

static void map_open(labelled_map *map, const fixture *s, camber_style *style, double ratio) {
    const camber_source_desc source = {.path = MONACO};
    camber_tiles_engine_desc desc = {
        .renderer = fixture_any(s), .device = s->on.device, .ratio = ratio, .simplify_px = 0.1, .threads = 2};
    *map = (labelled_map){.style = style};
    assert_int_equal(camber_features_create(s->context, style, &map->features), CAMBER_OK);
    assert_int_equal(camber_features_read_fonts(map->features, &(camber_fonts_desc){.no_system = true}, NULL),
                     CAMBER_OK);
    assert_int_equal(camber_features_read(map->features, &source), CAMBER_OK);
    assert_int_equal(camber_tiles_engine_create(map->features, &desc, &map->whole), CAMBER_OK);
    desc.on_demand_side = 1;
    assert_int_equal(camber_tiles_engine_create(map->features, &desc, &map->single), CAMBER_OK);
}

static void map_close(labelled_map *map) {
    camber_tiles_engine_destroy(map->single);
    camber_tiles_engine_destroy(map->whole);
    camber_features_destroy(map->features);
    camber_style_destroy(map->style);
}

typedef struct tile_counts {
    size_t tiles, drawn;  /* tiles compared, and those that show more than the background */
    size_t other, past_1; /* bytes that differ, and those that differ by more than one level */
    size_t bytes;
} tile_counts;

static void compare(const camber_tiles_picture *small, const camber_pixels *cut, const uint8_t *background,
                    tile_counts *counts) {
    const size_t row_bytes = (size_t)4 * cut->width;
    bool shows = false;
    for (size_t y = 0; y < cut->height; y++)
        for (size_t i = 0; i < row_bytes; i++) {
            const int drawn = small->rgba[row_bytes * y + i], other = cut->rgba[cut->stride_bytes * y + i];
            counts->other += drawn != other;
            counts->past_1 += abs(drawn - other) > 1;
            shows = shows || drawn != background[i % 4];
        }
    counts->bytes += row_bytes * cut->height;
    counts->tiles++;
    counts->drawn += shows;
}

/* Compares the tiles of the metatile about Monaco. A tile that nothing touches must show the background alone. */
static tile_counts compare_zoom(labelled_map *map, int zoom) {
    uint8_t *one = malloc(camber_tiles_engine_get_picture_bytes(map->single));
    uint8_t *all = malloc(camber_tiles_engine_get_picture_bytes(map->whole));
    assert_true(one && all);
    tile_counts counts = {0};
    camber_tiles_picture large, small;
    const double pi = 3.14159265358979323846, latitude = MONACO_AT[1] * pi / 180.0;
    const uint32_t column = (uint32_t)((MONACO_AT[0] / 360.0 + 0.5) * exp2(zoom));
    const uint32_t row = (uint32_t)((0.5 - asinh(tan(latitude)) / (2.0 * pi)) * exp2(zoom));
    assert_int_equal(camber_tiles_engine_draw(map->whole, zoom, column, row, all, &large), CAMBER_OK);
    for (uint32_t n = 0; n < large.side * large.side; n++) {
        const uint32_t i = (n * 37 + 11) % (large.side * large.side), x = i % large.side, y = i / large.side;
        camber_pixels cut;
        camber_tiles_picture_get_tile(&large, x, y, &cut);
        assert_int_equal(camber_tiles_engine_draw(map->single, zoom, large.column + x, large.row + y, one, &small),
                         CAMBER_OK);
        const size_t drawn = counts.drawn;
        compare(&small, &cut, large.background, &counts);
        assert_true(small.tiles || counts.drawn == drawn);
        assert_true((large.tiles >> i & 1) || counts.drawn == drawn);
    }
    free(all);
    free(one);
    return counts;
}

/* more: another layer, or "". It is drawn at every other zoom. */
static void check_labels(const fixture *s, const char *more, double ratio) {
    labelled_map map;
    const int step = *more ? 2 : 1;
    map_open(&map, s, make_style(s, "city", true, more), ratio);
    for (int zoom = 12 + step; zoom <= 18; zoom += step) {
        const tile_counts counts = compare_zoom(&map, zoom);
        printf("# zoom %d, ratio %g: %zu of %zu tiles have labels; %zu bytes differ\n", zoom, ratio, counts.drawn,
               counts.tiles, counts.other);
        assert_true(counts.past_1 <= counts.bytes / 1000000 && counts.other <= counts.bytes / 100000);
        assert_true(counts.drawn > (zoom < 16 ? 0 : 8));
    }
    map_close(&map);
}

/* Texts along lines and about points. */
static void test_city(void **state) {
    check_labels(*state, "", 1.0);
}

/* The same on screens of twice the density, where a metatile is a quarter as large. */
static void test_ratio(void **state) {
    check_labels(*state, "", 2.0);
}

/* Texts that move about their anchors, with wide halos, some of which stand over others. */
static void test_variable(void **state) {
    check_labels(*state,
                 "{\"id\": \"more\", \"type\": \"symbol\", \"layout\": {\"text-field\": [\"get\", \"name\"], "
                 "\"text-variable-anchor\": [\"left\", \"right\", \"top\", \"bottom\"], \"text-radial-offset\": 0.6, "
                 "\"text-justify\": \"auto\", \"text-max-width\": 5, \"text-size\": 15, \"text-overlap\": "
                 "\"cooperative\"}, \"paint\": {\"text-halo-width\": 4, \"text-halo-blur\": 2, \"text-halo-color\": "
                 "\"#fd8\", \"text-color\": \"rgba(0, 0, 90, 0.6)\", \"text-translate\": [7, -9]}}",
                 1.0);
}

/* With everything else. */
static void test_map(void **state) {
    labelled_map map;
    map_open(&map, *state, make_style(*state, "city", false, ""), 1.0);
    for (int zoom = 15; zoom <= 17; zoom++) {
        const tile_counts counts = compare_zoom(&map, zoom);
        printf("# zoom %d: %zu bytes differ, %zu by more than one level\n", zoom, counts.other, counts.past_1);
        assert_true(counts.drawn > 0 && counts.past_1 <= counts.bytes / 100000);
    }
    map_close(&map);
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_city), cmocka_unit_test(test_ratio),
                                       cmocka_unit_test(test_variable), cmocka_unit_test(test_map)};
    return cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
}
