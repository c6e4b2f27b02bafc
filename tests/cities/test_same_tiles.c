/* The bytes of a tile depend only on the map, the style and the tile's place, not on the metatile that it is cut from:
 * metatiles of 8 x 8 tiles, as an archive is drawn in, against those of 4 x 4 and single tiles, as a server draws. Real
 * cities, with lines, areas, texts, dashes, patterns and icons as the shipped styles have them. */
#include "pictures.h"

#include "camber_tiles.h"

#include <math.h>

enum { FIRST_ZOOM = 10, LAST_ZOOM = 17 };

typedef struct city {
    const char *path; /* in the folder of CAMBER_DATA, unless it is absolute */
    double longitude, latitude;
} city;

static const city PORTO = {"data/porto_portugal.osm.pbf", -8.6109, 41.1496};
static const city NEW_YORK = {"data/nyc.osm.pbf", -74.0060, 40.7128};
static const city MONACO = {CAMBER_TEST_DATA "/monaco/monaco.osm.pbf", 7.4235, 43.7365};

typedef struct city_map {
    const city *of;
    camber_style *style;
    camber_features *features;
} city_map;

static camber_tiles_engine *open_engine(const fixture *s, const city_map *map, uint32_t ratio, uint32_t side) {
    const camber_tiles_engine_desc desc = {.renderer = s->on.renderer[CAMBER_FIXTURE_OPENCL],
                                           .device = s->on.device,
                                           .ratio = ratio,
                                           .simplify_px = 0.1,
                                           .threads = 2,
                                           .on_demand_side = side};
    camber_tiles_engine *engine = NULL;
    assert_int_equal(camber_tiles_engine_create(map->features, &desc, &engine), CAMBER_OK);
    return engine;
}

static bool map_open(city_map *map, const fixture *s, const city *of, const char *name, camber_theme theme) {
    char path[4096];
    size_t size;
    const char *folder = getenv("CAMBER_DATA"), *text = camber_style_get_text(name, theme, &size);
    *map = (city_map){.of = of};
    if (of->path[0] != '/' && (!folder || !folder[0]))
        return false;
    snprintf(path, sizeof path, "%s%s%s", of->path[0] == '/' ? "" : folder, of->path[0] == '/' ? "" : "/", of->path);
    const camber_source_desc source = {.path = path};
    assert_int_equal(camber_style_parse(s->context, text, size, name, &map->style), CAMBER_OK);
    assert_int_equal(camber_features_create(s->context, map->style, &map->features), CAMBER_OK);
    assert_int_equal(camber_features_read_fonts(map->features, &(camber_fonts_desc){.no_system = true}, NULL),
                     CAMBER_OK);
    assert_int_equal(camber_features_read(map->features, &source), CAMBER_OK);
    return true;
}

static void map_close(city_map *map) {
    camber_features_destroy(map->features);
    camber_style_destroy(map->style);
}

typedef struct differences {
    size_t tiles, other_tiles, bytes; /* tiles compared, those that differ, and by how many bytes */
    int most;
} differences;

/* Compares a small metatile with its cut of the large one. */
static void compare(const camber_tiles_picture *small, const camber_tiles_picture *large, differences *d) {
    for (uint32_t y = 0; y < small->side; y++)
        for (uint32_t x = 0; x < small->side; x++) {
            camber_pixels one, other;
            camber_tiles_picture_get_tile(small, x, y, &one);
            camber_tiles_picture_get_tile(large, small->column + x - large->column, small->row + y - large->row,
                                          &other);
            const size_t before = d->bytes;
            for (size_t row = 0; row < one.height; row++)
                for (size_t i = 0; i < 4 * (size_t)one.width; i++) {
                    const int a = one.rgba[one.stride_bytes * row + i], b = other.rgba[other.stride_bytes * row + i];
                    d->bytes += a != b;
                    d->most = abs(a - b) > d->most ? abs(a - b) : d->most;
                }
            d->tiles++;
            d->other_tiles += d->bytes > before;
        }
}

/* Compares all tiles of the metatile about the city's middle. */
static void compare_zoom(const city_map *map, camber_tiles_engine *whole, camber_tiles_engine *parts, int zoom,
                         differences *d) {
    uint8_t *large_rgba = malloc(camber_tiles_engine_get_picture_bytes(whole));
    uint8_t *small_rgba = malloc(camber_tiles_engine_get_picture_bytes(parts));
    assert_true(large_rgba && small_rgba);
    camber_tiles_picture large, small = {.side = 1};
    const double pi = 3.14159265358979323846, latitude = map->of->latitude * pi / 180.0;
    const uint32_t column = (uint32_t)((map->of->longitude / 360.0 + 0.5) * exp2(zoom));
    const uint32_t row = (uint32_t)((0.5 - asinh(tan(latitude)) / (2.0 * pi)) * exp2(zoom));
    assert_int_equal(camber_tiles_engine_draw(whole, zoom, column, row, large_rgba, &large), CAMBER_OK);
    assert_true(large.tiles);
    for (uint32_t y = 0; y < large.side; y += small.side)
        for (uint32_t x = 0; x < large.side; x += small.side) {
            assert_int_equal(camber_tiles_engine_draw(parts, zoom, large.column + x, large.row + y, small_rgba, &small),
                             CAMBER_OK);
            compare(&small, &large, d);
        }
    free(small_rgba);
    free(large_rgba);
}

static void check(const fixture *s, const city *of, const char *style, camber_theme theme, uint32_t ratio) {
    city_map map;
    if (!map_open(&map, s, of, style, theme))
        skip();
    camber_tiles_engine *whole = open_engine(s, &map, ratio, 0);
    for (uint32_t side = 1; side <= 4; side *= 4) {
        camber_tiles_engine *parts = open_engine(s, &map, ratio, side);
        differences all = {0};
        for (int zoom = FIRST_ZOOM; zoom <= LAST_ZOOM; zoom++) {
            differences d = {0};
            compare_zoom(&map, whole, parts, zoom, &d);
            printf("# zoom %d, metatiles of %u: %zu of %zu tiles differ, in %zu bytes, by up to %d\n", zoom, side,
                   d.other_tiles, d.tiles, d.bytes, d.most);
            all.other_tiles += d.other_tiles;
        }
        camber_tiles_engine_destroy(parts);
        assert_int_equal(all.other_tiles, 0);
    }
    camber_tiles_engine_destroy(whole);
    map_close(&map);
}

static void test_porto(void **state) {
    check(*state, &PORTO, "city", CAMBER_THEME_LIGHT, 1);
}

static void test_porto_dark(void **state) {
    check(*state, &PORTO, "city", CAMBER_THEME_DARK, 2);
}

static void test_porto_transit(void **state) {
    check(*state, &PORTO, "transit", CAMBER_THEME_LIGHT, 1);
}

static void test_new_york(void **state) {
    check(*state, &NEW_YORK, "city", CAMBER_THEME_LIGHT, 1);
}

static void test_monaco(void **state) {
    check(*state, &MONACO, "city", CAMBER_THEME_LIGHT, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_monaco), cmocka_unit_test(test_porto),
                                       cmocka_unit_test(test_porto_dark), cmocka_unit_test(test_porto_transit),
                                       cmocka_unit_test(test_new_york)};
    return FIXTURE_CL_RUN(tests);
}
