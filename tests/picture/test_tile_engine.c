/* Tiles as an engine draws them, without files: what it says of tiles before it draws them, that they are cuts of a
 * scene's picture, and that lines go on across the antimeridian. */
#include "pictures.h"

#include "camber_tiles.h"
#include "features/features.h"

#include <math.h>

typedef struct made_map {
    camber_style *style;
    camber_features *features;
    camber_tiles_engine *engine;
} made_map;

static void map_open(made_map *it, const fixture *s, const char *layers) {
    char text[2048];
    uint32_t layer;
    *it = (made_map){0};
    snprintf(text, sizeof text, "{\"version\": 8, \"sources\": {\"s\": {\"type\": \"vector\"}}, \"layers\": [%s]}",
             layers);
    assert_int_equal(camber_style_parse(s->context, text, strlen(text), "style.json", &it->style), CAMBER_OK);
    assert_int_equal(camber_features_create(s->context, it->style, &it->features), CAMBER_OK);
    assert_int_equal(camber_features_find_layer(it->features, "", &layer), CAMBER_OK);
}

static void map_add(made_map *it, const double *points, size_t count) {
    uint32_t class;
    const camber_geometry_kind kind = count == 1 ? CAMBER_GEOMETRY_POINT : CAMBER_GEOMETRY_LINE;
    assert_int_equal(camber_features_find_class(it->features, 0, kind, NULL, &class), CAMBER_OK);
    assert_int_equal(camber_features_add_feature(it->features, class), CAMBER_OK);
    assert_int_equal(camber_features_add_polyline(it->features, points, count), CAMBER_OK);
}

static void map_start(made_map *it, const fixture *s, uint32_t threads) {
    const camber_tiles_engine_desc desc = {
        .renderer = fixture_any(s), .device = s->on.device, .simplify_px = 0.1, .threads = threads};
    assert_int_equal(camber_features_merge_and_weigh(it->features, 0, false, CAMBER_MERGE_ANY), CAMBER_OK);
    assert_int_equal(camber_tiles_engine_create(it->features, &desc, &it->engine), CAMBER_OK);
}

static void map_close(made_map *it) {
    camber_tiles_engine_destroy(it->engine);
    camber_features_destroy(it->features);
    camber_style_destroy(it->style);
}

static const char WIDE[] =
    "{\"id\": \"b\", \"type\": \"background\", \"paint\": {\"background-color\": \"#eee\"}},"
    "{\"id\": \"l\", \"type\": \"line\", \"source\": \"s\", \"layout\": {\"line-join\": \"miter\", \"line-cap\": "
    "\"square\"}, \"paint\": {\"line-width\": 22, \"line-offset\": 15, \"line-translate\": [9, -7]}}";

static const char CIRCLES[] =
    "{\"id\": \"b\", \"type\": \"background\", \"paint\": {\"background-color\": \"#eee\"}},"
    "{\"id\": \"c\", \"type\": \"circle\", \"source\": \"s\", \"paint\": {\"circle-radius\": 33, \"circle-opacity\": "
    "0.6, "
    "\"circle-stroke-width\": 5, \"circle-stroke-color\": \"#f00\", \"circle-translate\": [9, -7]}}";

static uint32_t random_below(uint32_t *state, uint32_t end) {
    *state = *state * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)(*state >> 8) * end >> 24);
}

/* Lines of few points in tiles of zoom 6, about the corner of four metatiles at column 32, row 24. */
static void add_random(made_map *it) {
    uint32_t state = 23;
    for (int i = 0; i < 24; i++) {
        double points[8];
        for (int k = 0; k < 8; k++)
            points[k] = (k % 2 ? 24.0 : 32.0) / 64.0 + ((double)random_below(&state, 2000) - 1000.0) / 64.0 / 250.0;
        map_add(it, points, 4);
        map_add(it, points + 2, 1); /* a point, which lines do not draw */
    }
}

static void expect_background(const camber_tiles_picture *block, uint32_t x, uint32_t y) {
    camber_pixels pixels;
    camber_tiles_picture_get_tile(block, x, y, &pixels);
    for (size_t row = 0; row < pixels.height; row++)
        for (size_t i = 0; i < pixels.width; i++)
            if (memcmp(pixels.rgba + pixels.stride_bytes * row + 4 * i, block->background, 4) != 0)
                fail_msg("tile %d/%u/%u is said to be empty, and is not", block->zoom, block->column + x,
                         block->row + y);
}

/* Tiles that no line is said to touch show the background alone; most others show more. */
static void check_empty(const fixture *s, const char *layers) {
    made_map map;
    map_open(&map, s, layers);
    add_random(&map);
    map_start(&map, s, 0);
    uint8_t *rgba = malloc(camber_tiles_engine_get_picture_bytes(map.engine));
    assert_non_null(rgba);
    size_t empty = 0, touched = 0;
    for (int zoom = 0; zoom <= 7; zoom++) {
        const uint32_t tiles = 1u << zoom, step = zoom < 3 ? tiles : 8;
        for (uint32_t at = 0; at < (tiles / step) * (tiles / step); at++) {
            camber_tiles_picture looked, drawn;
            const uint32_t column = at % (tiles / step) * step, row = at / (tiles / step) * step;
            assert_int_equal(camber_tiles_engine_look(map.engine, zoom, column, row, &looked), CAMBER_OK);
            assert_true(looked.column == column && looked.row == row && looked.side == step);
            if (zoom > 4 && !looked.tiles)
                continue;
            assert_int_equal(camber_tiles_engine_draw(map.engine, zoom, column + step - 1, row, rgba, &drawn),
                             CAMBER_OK);
            assert_true(drawn.tiles == looked.tiles && drawn.has_background && drawn.rgba == rgba);
            for (uint32_t i = 0; i < step * step; i++) {
                const bool touches = drawn.tiles >> i & 1;
                touched += touches;
                empty += !touches;
                if (!touches)
                    expect_background(&drawn, i % step, i / step);
            }
        }
    }
    assert_true(touched > 50 && empty > 50);
    free(rgba);
    map_close(&map);
}

static void test_empty(void **state) {
    check_empty(*state, WIDE);
    check_empty(*state, CIRCLES);
}

/* Tiles are cuts of the picture of a scene of one view, to the byte in a metatile. */
static void check_cuts(const fixture *s, const char *layers) {
    made_map map;
    map_open(&map, s, layers);
    add_random(&map);
    map_start(&map, s, 2);
    uint8_t *rgba = malloc(camber_tiles_engine_get_picture_bytes(map.engine));
    assert_non_null(rgba);
    camber_tiles_picture block;
    assert_int_equal(camber_tiles_engine_draw(map.engine, 6, 32, 24, rgba, &block), CAMBER_OK);
    double x = 36.0 / 64.0, y = 28.0 / 64.0, pi = 3.14159265358979323846;
    const camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_CENTER,
                                             .longitude = 360.0 * (x - 0.5),
                                             .latitude = atan(sinh(2.0 * pi * (0.5 - y))) * 180.0 / pi,
                                             .zoom = 5.0,
                                             .width = 2048,
                                             .height = 2048},
                                    .simplify_px = 0.1,
                                    .use = CAMBER_SCENE_ONE_VIEW};
    camber_scene *scene = NULL;
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_scene_create(map.features, &desc, &scene), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->on.device, fixture_any(s), &mesh), CAMBER_OK);
    assert_int_equal(camber_scene_tessellate(scene, mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
    const camber_frame frame = camber_scene_get_frame(scene, mesh);
    picture whole = picture_draw(fixture_any(s), &frame);
    assert_memory_equal(whole.rgba, rgba, (size_t)4 * 2048 * 2048);
    picture_free(&whole);
    camber_mesh_destroy(mesh);
    camber_scene_destroy(scene);
    free(rgba);
    map_close(&map);
}

static void test_cuts(void **state) {
    check_cuts(*state, WIDE);
    check_cuts(*state, CIRCLES);
}

/* Lines that bend gently about the middle of tile 6/36/28. */
static void add_waves(made_map *it) {
    for (int i = 0; i < 8; i++) {
        double points[2 * 200];
        for (int k = 0; k < 200; k++) {
            points[2 * k] = 36.5 / 64.0 + (k - 100) * 2e-4;
            points[2 * k + 1] = 28.5 / 64.0 + i * 3e-4 + 1e-3 * sin(0.05 * k + i);
        }
        map_add(it, points, 200);
    }
}

/* A tile by itself, and as a cut of a large picture. */
static void compare_on_demand(camber_tiles_engine *single, camber_tiles_engine *whole, int zoom, uint32_t column,
                              uint32_t row) {
    uint8_t *one = malloc(camber_tiles_engine_get_picture_bytes(single));
    uint8_t *all = malloc(camber_tiles_engine_get_picture_bytes(whole));
    assert_true(one && all);
    camber_tiles_picture small, large;
    camber_pixels pixels;
    bool shows = false;
    assert_int_equal(camber_tiles_engine_draw(single, zoom, column, row, one, &small), CAMBER_OK);
    assert_int_equal(camber_tiles_engine_draw(whole, zoom, column, row, all, &large), CAMBER_OK);
    assert_true(small.side == 1 && small.column == column && small.row == row && small.tiles == 1);
    camber_tiles_picture_get_tile(&large, column - large.column, row - large.row, &pixels);
    for (size_t y = 0; y < pixels.height; y++)
        for (size_t i = 0; i < (size_t)4 * pixels.width; i++) {
            const uint8_t cut = pixels.rgba[pixels.stride_bytes * y + i];
            const uint8_t drawn = one[(size_t)4 * pixels.width * y + i];
            assert_true(abs((int)cut - (int)drawn) <= 1);
            shows = shows || cut != large.background[i % 4];
        }
    assert_true(shows);
    free(one);
    free(all);
}

/* Single tiles are those of archives, also at zooms whose census is taken in larger tiles. */
static void test_on_demand(void **state) {
    fixture *s = *state;
    made_map map;
    map_open(&map, s, WIDE);
    add_waves(&map);
    map_start(&map, s, 2);
    const camber_tiles_engine_desc desc = {
        .renderer = fixture_any(s), .device = s->on.device, .simplify_px = 0.1, .threads = 2, .on_demand_side = 1};
    camber_tiles_engine *single = NULL;
    camber_tiles_picture far;
    assert_int_equal(camber_tiles_engine_create(map.features, &desc, &single), CAMBER_OK);
    assert_int_equal(camber_tiles_engine_get_picture_bytes(single), 4 * 256 * 256);
    /* Point 100 of the first line, at zooms of the one kind and of the other. */
    const double x = 36.5 / 64.0, y = 28.5 / 64.0 + 1e-3 * sin(5.0);
    for (int zoom = 6; zoom <= 20; zoom += 2)
        compare_on_demand(single, map.engine, zoom, (uint32_t)(x * exp2(zoom)), (uint32_t)(y * exp2(zoom)));
    assert_int_equal(camber_tiles_engine_look(single, 20, 0, 0, &far), CAMBER_OK);
    assert_int_equal(far.tiles, 0);
    const camber_tiles_draw_desc archive = {.output = "none.pmtiles", .max_zoom = 1};
    assert_int_equal(camber_tiles_draw(single, &archive, NULL), CAMBER_ERROR_ARGUMENT);
    assert_story(&s->h, "on_demand_side");
    camber_tiles_engine_destroy(single);
    map_close(&map);
}

/* A line just west of the antimeridian reaches over it. */
static void test_antimeridian(void **state) {
    const fixture *s = *state;
    made_map map;
    const double line[] = {1.0 - 2.0 / 8192.0, 0.30, 1.0 - 2.0 / 8192.0, 0.31};
    map_open(&map, s, "{\"id\": \"l\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-width\": 40}}");
    map_add(&map, line, 2);
    map_start(&map, s, 3);
    uint8_t *rgba = malloc(camber_tiles_engine_get_picture_bytes(map.engine));
    assert_non_null(rgba);
    camber_tiles_picture east, west;
    assert_int_equal(camber_tiles_engine_draw(map.engine, 5, 31, 9, rgba, &east), CAMBER_OK);
    const uint32_t y = 9 % 8 * 256 + 200;
    const size_t row_bytes = (size_t)4 * 2048;
    assert_true(east.tiles >> 15 & 1);
    assert_int_equal(rgba[row_bytes * y + 4 * 2047 + 3], 255);
    assert_int_equal(camber_tiles_engine_draw(map.engine, 5, 0, 9, rgba, &west), CAMBER_OK);
    assert_true(west.tiles >> 8 & 1);
    assert_int_equal(rgba[row_bytes * y + 3], 255); /* the line's middle lies 2 px west of 0, and it is 40 px wide */
    assert_int_equal(rgba[row_bytes * y + 4 * 17 + 3], 255);
    assert_int_equal(rgba[row_bytes * y + 4 * 19 + 3], 0);
    free(rgba);
    map_close(&map);
}

static void test_bad(void **state) {
    fixture *s = *state;
    made_map map;
    camber_tiles_picture block;
    camber_tiles_engine *none = NULL;
    map_open(&map, s, WIDE);
    map_start(&map, s, 1);
    assert_int_equal(camber_tiles_engine_look(map.engine, 25, 0, 0, &block), CAMBER_ERROR_ARGUMENT);
    assert_story(&s->h, "25/0/0");
    assert_int_equal(camber_tiles_engine_look(map.engine, 3, 8, 0, &block), CAMBER_ERROR_ARGUMENT);
    assert_story(&s->h, "3/8/0");
    const camber_tiles_engine_desc sizes[] = {
        {.renderer = fixture_any(s), .device = s->on.device, .tile_size = 100},
        {.renderer = fixture_any(s), .device = s->on.device, .ratio = 9.0},
        {.renderer = fixture_any(s), .device = s->on.device, .on_demand_side = 3},
        {.renderer = fixture_any(s), .device = s->on.device, .on_demand_side = 16},
        {.renderer = fixture_any(s), .device = s->on.device, .ratio = 0.2},
        {.renderer = fixture_any(s), .device = s->on.device, .simplify_px = -1.0}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        assert_int_equal(camber_tiles_engine_create(map.features, &sizes[i], &none), CAMBER_ERROR_ARGUMENT);
        assert_story(&s->h, "choose");
    }
    assert_null(none);
    assert_int_equal(camber_tiles_engine_look(map.engine, 3, 1, 1, &block), CAMBER_OK);
    assert_int_equal(block.tiles, 0);
    map_close(&map);
}

typedef struct attempted {
    const fixture *s;
    const camber_features *features;
    uint8_t *rgba;
} attempted;

static camber_status draw_picture(camber_context *context, void *user) {
    const attempted *it = user;
    const camber_tiles_engine_desc desc = {
        .renderer = fixture_any(it->s), .device = it->s->on.device, .simplify_px = 0.1, .threads = 2};
    camber_tiles_engine *engine = NULL;
    camber_tiles_picture picture_of;
    (void)context;
    camber_status status = camber_tiles_engine_create(it->features, &desc, &engine);
    if (status == CAMBER_OK)
        status = camber_tiles_engine_draw(engine, 2, 2, 1, it->rgba, &picture_of);
    camber_tiles_engine_destroy(engine);
    return status;
}

static void test_no_memory(void **state) {
    fixture *s = *state;
    made_map map;
    map_open(&map, s, WIDE);
    add_random(&map);
    assert_int_equal(camber_features_merge_and_weigh(map.features, 0, false, CAMBER_MERGE_ANY), CAMBER_OK);
    attempted it = {s, map.features, malloc((size_t)4 * 2048 * 2048)};
    assert_non_null(it.rgba);
    assert_int_equal(draw_picture(s->context, &it), CAMBER_OK); /* programs are built once */
    each_allocation_fails(&s->h, draw_picture, s->context, &it);
    free(it.rgba);
    map_close(&map);
}

static uint8_t *read_archive(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    uint8_t *bytes = malloc(1 << 22);
    assert_true(file && bytes);
    *size = fread(bytes, 1, 1 << 22, file);
    assert_true(*size > 1000 && *size < 1 << 22);
    fclose(file);
    return bytes;
}

/* A pyramid that drops points between zooms has the same bytes, unless lengths along lines are asked for: then none
 * goes. */
static void test_spent(void **state) {
    static const char *const layers[] = {
        WIDE, "{\"id\": \"l\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-dasharray\": [4, 2]}}"};
    fixture *s = *state;
    char folder[64], path[128];
    folder_make(folder);
    snprintf(path, sizeof path, "%s/x.pmtiles", folder);
    for (int i = 0; i < 2; i++) {
        uint8_t *bytes[2];
        size_t sizes[2], points[2];
        for (int spent = 0; spent < 2; spent++) {
            double wave[2 * 500];
            made_map map;
            map_open(&map, s, layers[i]);
            for (int k = 0; k < 500; k++) {
                wave[2 * k] = 0.4 + 0.0004 * k;
                wave[2 * k + 1] = 0.4 + 0.00001 * (k % 2) + 0.0001 * k;
            }
            map_add(&map, wave, 500);
            map_start(&map, s, 0);
            const camber_tiles_draw_desc desc = {.output = path,
                                                 .max_zoom = 7,
                                                 .encoding = CAMBER_ENCODING_PNG,
                                                 .force = true,
                                                 .spent = spent ? map.features : NULL};
            assert_int_equal(camber_tiles_draw(map.engine, &desc, NULL), CAMBER_OK);
            points[spent] = map.features->point_count;
            bytes[spent] = read_archive(path, &sizes[spent]);
            map_close(&map);
        }
        assert_true(sizes[0] == sizes[1] && memcmp(bytes[0], bytes[1], sizes[0]) == 0);
        assert_int_equal(points[0], 500);
        assert_true(i ? points[1] == 500 : points[1] < 100);
        free(bytes[1]);
        free(bytes[0]);
    }
    folder_remove(folder);
}

/* Renewing without a list draws all of the zooms, and of the same lines makes the same bytes. It is done at once. */
static void test_renewed(void **state) {
    fixture *s = *state;
    char folder[64], path[128];
    size_t sizes[2];
    double line[4] = {0.4, 0.4, 0.6, 0.5};
    camber_tiles_stats stats;
    made_map map;
    folder_make(folder);
    snprintf(path, sizeof path, "%s/x.pmtiles", folder);
    map_open(&map, s, WIDE);
    map_add(&map, line, 2);
    map_start(&map, s, 0);
    camber_tiles_draw_desc desc = {.output = path, .max_zoom = 7, .encoding = CAMBER_ENCODING_PNG};
    assert_int_equal(camber_tiles_draw(map.engine, &desc, NULL), CAMBER_OK);
    uint8_t *before = read_archive(path, &sizes[0]);
    desc.renew = true;
    assert_int_equal(camber_tiles_draw(map.engine, &desc, &stats), CAMBER_OK);
    uint8_t *after = read_archive(path, &sizes[1]);
    assert_true(stats.tiles > 8 && stats.emptied == 0 && stats.left_out == 0 && !stats.done);
    assert_true(sizes[0] == sizes[1] && memcmp(before, after, sizes[0]) == 0);
    desc.dry_run = true;
    assert_int_equal(camber_tiles_draw(map.engine, &desc, NULL), CAMBER_ERROR_ARGUMENT);
    assert_story(&s->h, "a dry run");
    map_close(&map);
    folder_remove(folder);
    free(after);
    free(before);
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_empty),     cmocka_unit_test(test_cuts),
                                       cmocka_unit_test(test_on_demand), cmocka_unit_test(test_antimeridian),
                                       cmocka_unit_test(test_bad),       cmocka_unit_test(test_no_memory),
                                       cmocka_unit_test(test_spent),     cmocka_unit_test(test_renewed)};
    return cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
}
