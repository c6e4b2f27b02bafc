/* Pictures of tiles beside pictures of what was not cut: no cap, no gap and nothing drawn twice at their borders. */
#include "pictures.h"
#include "tilemaker.h"

#include "camber_map.h"
#include "features/mercator.h"

#include <unistd.h>

/* Wide and half transparent, so that what is drawn twice is darker. */
static const char PAINT[] = "\"layout\": {\"line-cap\": \"%s\", \"line-join\": \"round\"}, \"paint\": {\"line-width\": "
                            "%d, \"line-opacity\": 0.5%s}";

typedef struct sheet {
    camber_style *style;
    camber_features *features;
    camber_scene *scene;
    camber_mesh *mesh;
} sheet;

/* more: of the paint. */
static void sheet_open(sheet *it, const fixture *s, const char *source, const char *cap, int width_px,
                       const char *more) {
    char text[4096], paint[1024];
    *it = (sheet){0};
    snprintf(paint, sizeof paint, PAINT, cap, width_px, more);
    snprintf(text, sizeof text,
             "{\"version\": 8, \"sources\": {\"s\": %s}, \"layers\": [{\"id\": \"l\", \"type\": \"line\", \"source\": "
             "\"s\", "
             "%s%s}]}",
             source, strstr(source, "geojson") ? "" : "\"source-layer\": \"roads\", ", paint);
    assert_int_equal(camber_style_parse(s->context, text, strlen(text), "style.json", &it->style), CAMBER_OK);
    assert_int_equal(camber_features_create(s->context, it->style, &it->features), CAMBER_OK);
}

static picture sheet_draw(sheet *it, const fixture *s, const camber_view_desc *view) {
    const camber_scene_desc desc = {.view = *view};
    assert_int_equal(camber_scene_create(it->features, &desc, &it->scene), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->on.device, fixture_any(s), &it->mesh), CAMBER_OK);
    assert_int_equal(camber_scene_tessellate(it->scene, it->mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
    const camber_frame frame = camber_scene_get_frame(it->scene, it->mesh);
    return picture_draw(fixture_any(s), &frame);
}

static void sheet_close(sheet *it) {
    camber_mesh_destroy(it->mesh);
    camber_scene_destroy(it->scene);
    camber_features_destroy(it->features);
    camber_style_destroy(it->style);
}

static picture draw_sources(const fixture *s, const char *source, const char *cap, const char *more,
                            const camber_view_desc *view) {
    sheet it;
    sheet_open(&it, s, source, cap, 40, more);
    assert_int_equal(camber_features_read_sources(it.features, view, NULL), CAMBER_OK);
    const picture drawn = sheet_draw(&it, s, view);
    sheet_close(&it);
    return drawn;
}

static void expect_alike(const picture *a, const picture *b) {
    const difference d = picture_compare(a, b);
    assert_true(d.drawn > 1000);
    if (d.most > 1)
        fail_msg("%zu of %zu pixels differ by more than 8, by %d at most", d.past_8, d.drawn, d.most);
}

/* Through three tiles of zoom 1 about the middle of the world, in units of 1/4096 tile; tiles with a buffer of all. */
static const int BENT[] = {3000, 3900, 4000, 3950, 4300, 4020, 4400, 5000};

static void write_tiles(const char *path, uint64_t id) {
    made_tile tiles[3];
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t column = i > 0, row = i > 1;
        int local[8];
        for (int k = 0; k < 8; k++)
            local[k] = BENT[k] - 4096 * (int)(k & 1 ? row : column);
        blob tile = {0}, layer = begin_layer("roads", 4096);
        put_feature(&layer, id, -1, 0, false, local, 4);
        put_layer(&tile, &layer);
        tiles[i] = (made_tile){1, column, row, tile};
    }
    unlink(path);
    assert_true(write_mbtiles(path, tiles, 3, NULL));
    for (int i = 0; i < 3; i++)
        blob_free(&tiles[i].content);
}

/* A GeoJSON source of a line in units of 1/8192 of the world. */
static void write_line(char *text, size_t size, const int *units, size_t count) {
    size_t used = (size_t)snprintf(text, size,
                                   "{\"type\": \"geojson\", \"lineMetrics\": true, \"data\": {\"type\": "
                                   "\"LineString\", \"coordinates\": [");
    for (size_t i = 0; i < count; i++) {
        double longitude, latitude;
        camber_mercator_unproject(units[2 * i] / 8192.0, units[2 * i + 1] / 8192.0, &longitude, &latitude);
        used += (size_t)snprintf(text + used, size - used, "%s[%.15g, %.15g]", i ? ", " : "", longitude, latitude);
    }
    snprintf(text + used, size - used, "]}}");
}

static void test_uncut(void **state) {
    const fixture *s = *state;
    static const char *const caps[] = {"butt", "round", "square"};
    char whole[1024], cut[256], path[64];
    write_line(whole, sizeof whole, BENT, 4);
    snprintf(path, sizeof path, "/tmp/camber-test-%ld.mbtiles", (long)getpid());
    snprintf(cut, sizeof cut, "{\"type\": \"vector\", \"url\": \"mbtiles://%s\"}", path);
    for (uint64_t id = 0; id < 2; id++) {
        write_tiles(path, id);
        for (int i = 0; i < 6; i++) {
            const camber_view_desc view = {.kind = CAMBER_VIEW_CENTER,
                                           .longitude = 0.5,
                                           .latitude = 1,
                                           .zoom = i < 3 ? 1 : 3.5,
                                           .bearing_deg = i < 3 ? 0 : 20,
                                           .width = 400,
                                           .height = 300};
            picture a = draw_sources(s, whole, caps[i % 3], "", &view),
                    b = draw_sources(s, cut, caps[i % 3], "", &view);
            expect_alike(&a, &b);
            picture_free(&a);
            picture_free(&b);
        }
    }
    unlink(path);
}

/* ---- Progress ---- */

/* The middle of a longer line, whose ends no view here sees. */
static const int LONG[] = {600, 2000, 3000, 3900, 4000, 3950, 4300, 4020, 4400, 5000, 7000, 7100};
static const char *const ALONG[] = {
    ", \"line-gradient\": [\"interpolate\", [\"linear\"], [\"line-progress\"], 0, \"red\", 0.45, \"lime\", 0.5, "
    "\"blue\", "
    "1, \"white\"]",
    ", \"line-gradient\": [\"step\", [\"line-progress\"], \"red\", 0.42, \"lime\", 0.46, \"blue\", 0.465, \"black\"]",
    ", \"line-trim-offset\": [0.44, 0.47]", ", \"line-dasharray\": [1.3, 0.9]"};

/* As tiles made of GeoJSON have it: each knows which part of the line its piece is. */
static void write_progress_tiles(const char *path) {
    double along[6] = {0};
    made_tile tiles[3];
    for (size_t i = 1; i < 6; i++)
        along[i] = along[i - 1] + hypot(LONG[2 * i] - LONG[2 * i - 2], LONG[2 * i + 1] - LONG[2 * i - 1]);
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t column = i > 0, row = i > 1;
        int local[8];
        for (int k = 0; k < 8; k++)
            local[k] = LONG[2 + k] - 4096 * (int)(k & 1 ? row : column);
        blob tile = {0}, layer = begin_layer("roads", 4096);
        put_key(&layer, "mapbox_clip_start");
        put_key(&layer, "mapbox_clip_end");
        put_double_value(&layer, along[1] / along[5]);
        put_double_value(&layer, along[4] / along[5]);
        put_tagged(&layer, 1, (uint32_t[]){0, 0, 1, 1}, 4, false, local, 4);
        put_layer(&tile, &layer);
        tiles[i] = (made_tile){1, column, row, tile};
    }
    unlink(path);
    assert_true(write_mbtiles(path, tiles, 3, NULL));
    for (int i = 0; i < 3; i++)
        blob_free(&tiles[i].content);
}

/* Gradients, trims and dashes run over what tiles cut, and tell the line that was there before. */
static void test_progress(void **state) {
    const fixture *s = *state;
    char whole[1024], cut[256], path[64];
    write_line(whole, sizeof whole, LONG, 6);
    snprintf(path, sizeof path, "/tmp/camber-test-%ld.mbtiles", (long)getpid());
    snprintf(cut, sizeof cut, "{\"type\": \"vector\", \"url\": \"mbtiles://%s\"}", path);
    write_progress_tiles(path);
    for (size_t i = 0; i < sizeof ALONG / sizeof *ALONG; i++) {
        const camber_view_desc view = {.kind = CAMBER_VIEW_CENTER,
                                       .longitude = 0.5,
                                       .latitude = 1,
                                       .zoom = 3.5,
                                       .bearing_deg = 20,
                                       .width = 400,
                                       .height = 300};
        picture a = draw_sources(s, whole, "butt", ALONG[i], &view), b = draw_sources(s, cut, "butt", ALONG[i], &view);
        const difference d = picture_compare(&a, &b);
        assert_true(d.drawn > 1000);
        if (d.most > 4) /* an edge's place is known to some hundredths of a pixel */
            fail_msg("%s: %zu of %zu pixels differ by more than 8, by %d at most", ALONG[i], d.past_8, d.drawn, d.most);
        picture_free(&a);
        picture_free(&b);
    }
    unlink(path);
}

/* The lines of Santa Cruz's tiles that a view sees, and all of them joined. */
static void test_all_tiles(void **state) {
    const fixture *s = *state;
    static const char path[] = CAMBER_TEST_DATA "/santa_cruz/osm.mbtiles";
    const camber_source_desc all = {.path = path, .layer = "roads", .keep_apart = true};
    char source[512];
    snprintf(source, sizeof source, "{\"type\": \"vector\", \"url\": \"mbtiles://%s\"}", path);
    for (int i = 0; i < 4; i++) {
        camber_view_desc view = {.kind = CAMBER_VIEW_CENTER,
                                 .longitude = -122.0268,
                                 .latitude = 36.9735,
                                 .zoom = 15.0 + i * 0.8,
                                 .bearing_deg = 35.0 * i,
                                 .width = 600,
                                 .height = 500};
        if (i == 3) {
            /* Just one tile, at whose borders lines go on. */
            view = (camber_view_desc){.kind = CAMBER_VIEW_CENTER, .zoom = 15, .width = 512, .height = 512};
            camber_mercator_unproject(5275.5 / 32768, 12757.5 / 32768, &view.longitude, &view.latitude);
        }
        sheet whole, seen;
        sheet_open(&whole, s, source, i ? "round" : "butt", 6, "");
        sheet_open(&seen, s, source, i ? "round" : "butt", 6, "");
        assert_int_equal(camber_features_read(whole.features, &all), CAMBER_OK);
        assert_int_equal(camber_features_read_sources(seen.features, &view, NULL), CAMBER_OK);
        assert_true(camber_features_get_stats(seen.features).polylines <
                    camber_features_get_stats(whole.features).polylines / 2);
        picture a = sheet_draw(&whole, s, &view), b = sheet_draw(&seen, s, &view);
        const difference d = picture_compare(&a, &b);
        assert_true(d.drawn > 10000);
        /* Where the tile's buffer ends, its lines are rounded to 1/2048 of it, which turns them by a hair. */
        /* Features of a style's sources that go straight on are one line; ends of others leave seams. */
        const bool seams_only = i < 3 && d.past_8 <= d.drawn / 1000;
        if (d.most > (i == 3 ? 64 : 2) && !seams_only)
            fail_msg("view %d: %zu of %zu pixels differ by more than 8, by %d at most", i, d.past_8, d.drawn, d.most);
        picture_free(&a);
        picture_free(&b);
        sheet_close(&whole);
        sheet_close(&seen);
    }
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_uncut), cmocka_unit_test(test_progress),
                                       cmocka_unit_test(test_all_tiles)};
    const int failed = cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
    return failed;
}
