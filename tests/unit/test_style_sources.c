/* The sources that a style names: where they lead, which tiles a view sees, and what of them becomes lines. */
#include "features/features.h"
#include "features/mercator.h"
#include "style/style.h"
#include "tilemaker.h"

#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

typedef struct fixture {
    camber_context *context;
    camber_style *style;
    camber_features *features;
    size_t errors, warnings;
    bool wants_id;
    char error[1024], warning[1024];
    char folder[64], base[96]; /* base: the style's file, which is not there */
} fixture;

static void take_log(void *user, camber_log_level level, const char *message) {
    fixture *it = user;
    it->errors += level == CAMBER_LOG_ERROR;
    it->warnings += level == CAMBER_LOG_WARNING;
    if (level == CAMBER_LOG_ERROR)
        snprintf(it->error, sizeof it->error, "%s", message);
    if (level == CAMBER_LOG_WARNING)
        snprintf(it->warning, sizeof it->warning, "%s", message);
}

static int set_up(void **state) {
    fixture *it = calloc(1, sizeof *it);
    assert_non_null(it);
    const camber_context_desc desc = {.log = take_log, .log_user = it};
    assert_int_equal(camber_context_create(&desc, &it->context), CAMBER_OK);
    snprintf(it->folder, sizeof it->folder, "/tmp/camber-test-XXXXXX");
    assert_non_null(mkdtemp(it->folder));
    snprintf(it->base, sizeof it->base, "%s/style.json", it->folder);
    *state = it;
    return 0;
}

static void forget(fixture *it) {
    camber_features_destroy(it->features);
    camber_style_destroy(it->style);
    it->features = NULL;
    it->style = NULL;
    it->errors = it->warnings = 0;
    it->error[0] = it->warning[0] = 0;
}

static int tear_down(void **state) {
    fixture *it = *state;
    DIR *folder = opendir(it->folder);
    for (struct dirent *entry; folder && (entry = readdir(folder)) != NULL;) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", it->folder, entry->d_name);
        if (entry->d_name[0] != '.')
            unlink(path);
    }
    if (folder)
        closedir(folder);
    rmdir(it->folder);
    forget(it);
    camber_context_destroy(it->context);
    free(it);
    return 0;
}

/* A style with these sources and layers, and its features in the view. */
static camber_status read_view(fixture *it, const char *sources, const char *layers, const camber_view_desc *view) {
    char text[4096];
    const int size =
        snprintf(text, sizeof text, "{\"version\": 8, \"sources\": {%s}, \"layers\": [%s]}", sources, layers);
    assert_true(size > 0 && (size_t)size < sizeof text);
    forget(it);
    if (camber_style_parse(it->context, text, (size_t)size, "style.json", &it->style) != CAMBER_OK)
        fail_msg("%s", it->error);
    it->style->schema.wants_id = it->style->schema.wants_id || it->wants_id;
    assert_int_equal(camber_features_create(it->context, it->style, &it->features), CAMBER_OK);
    it->warnings = 0;
    return camber_features_read_sources(it->features, view, it->base);
}

#define ROADS "{\"id\": \"l\", \"type\": \"line\", \"source\": \"s\", \"source-layer\": \"road\"}"
#define LINES "{\"id\": \"l\", \"type\": \"line\", \"source\": \"s\"}"

static void expect_ok(const fixture *it, camber_status status) {
    if (status != CAMBER_OK || it->errors)
        fail_msg("%s: %s", camber_status_get_name(status), it->error);
}

static const char *in_folder(const fixture *it, const char *name, char path[256]) {
    snprintf(path, 256, "%s/%s", it->folder, name);
    return path;
}

static void write_blob(const fixture *it, const char *name, blob *b) {
    char path[256];
    assert_true(blob_write(b, in_folder(it, name, path)));
    blob_free(b);
}

static void write_text(const fixture *it, const char *name, const char *text) {
    blob b = {0};
    blob_put(&b, text, strlen(text));
    write_blob(it, name, &b);
}

/* ---- Tiles of one line ---- */

/* A view of CSS pixels around a place in tiles of a zoom. */
static camber_view_desc view_at(double zoom, double x, double y, int tile_zoom, uint32_t width, uint32_t height) {
    camber_view_desc view = {.kind = CAMBER_VIEW_CENTER, .zoom = zoom, .width = width, .height = height};
    camber_mercator_unproject(x / exp2(tile_zoom), y / exp2(tile_zoom), &view.longitude, &view.latitude);
    return view;
}

/* units: of 1/4096 tile from the world's corner. The tile holds all of it, as one with a buffer without an end would.
 */
static blob tile_of(uint32_t column, uint32_t row, uint64_t id, const int *units, size_t count) {
    int local[64];
    blob tile = {0}, layer = begin_layer("road", 4096);
    assert_true(count <= 32);
    for (size_t i = 0; i < 2 * count; i++)
        local[i] = units[i] - (int)(i & 1 ? row : column) * 4096;
    put_feature(&layer, id, -1, 0, false, local, count);
    put_layer(&tile, &layer);
    return tile;
}

static void expect_units(const fixture *it, size_t polyline, double world, size_t count, const double *units) {
    const camber_features *set = it->features;
    assert_true(polyline < set->polyline_count);
    assert_int_equal(set->offsets[polyline + 1] - set->offsets[polyline], count);
    for (size_t i = 0; i < 2 * count; i++) {
        const double got = set->points[2 * set->offsets[polyline] + i] * world;
        if (fabs(got - units[i]) > 1e-6)
            fail_msg("polyline %zu, ordinate %zu: %.9g is not %.9g", polyline, i, got, units[i]);
    }
}

/* Crosses the middle of the four tiles of zoom 1, of which it touches three. */
static const int BENT[] = {3000, 3900, 4000, 3950, 4300, 4020, 4400, 5000};
static const double BENT_UNITS[] = {3000, 3900, 4000, 3950, 4300, 4020, 4400, 5000};

static void write_bent(const fixture *it, const char *format, bool quadkey, bool south_first) {
    static const uint32_t touched[3][2] = {{0, 0}, {1, 0}, {1, 1}};
    for (int i = 0; i < 3; i++) {
        char name[64];
        blob tile = tile_of(touched[i][0], touched[i][1], 5, BENT, 4);
        if (quadkey)
            snprintf(name, sizeof name, format, touched[i][0] + 2 * touched[i][1]);
        else
            snprintf(name, sizeof name, format, touched[i][0], south_first ? 1 - touched[i][1] : touched[i][1]);
        write_blob(it, name, &tile);
    }
}

static void expect_bent(fixture *it, const char *source) {
    const camber_view_desc view = view_at(1.0, 1.0, 1.0, 1, 300, 300);
    expect_ok(it, read_view(it, source, ROADS, &view));
    assert_int_equal(it->warnings, 0);
    assert_int_equal(it->features->polyline_count, 1);
    assert_int_equal(it->features->stats.joined_pieces, 2);
    expect_units(it, 0, 8192, 4, BENT_UNITS);
    assert_int_equal(it->features->classes[0].source, 0);
}

static void expect_attribution(const fixture *it, const char *text) {
    const char *got = camber_features_get_attribution(it->features);
    if (text)
        assert_string_equal(got, text);
    else
        assert_null(got);
}

static void test_templates(void **state) {
    fixture *it = *state;
    char source[512];
    write_bent(it, "1-%u-%u.mvt", false, false);
    write_bent(it, "t%u.%u.pbf", false, true);
    write_bent(it, "q%u.pbf", true, false);
    expect_bent(it, "\"s\": {\"type\": \"vector\", \"maxzoom\": 1, \"tiles\": [\"{z}-{x}-{y}.mvt\"]}");
    expect_bent(it,
                "\"s\": {\"type\": \"vector\", \"maxzoom\": 1, \"scheme\": \"tms\", \"tiles\": [\"t{x}.{y}.pbf\"]}");
    expect_bent(it, "\"s\": {\"type\": \"vector\", \"maxzoom\": 1, \"tiles\": [\"t{x}.{-y}.pbf\"]}");
    expect_bent(it, "\"s\": {\"type\": \"vector\", \"maxzoom\": 1, \"tiles\": [\"q{quadkey}.pbf\"]}");
    snprintf(source, sizeof source,
             "\"s\": {\"type\": \"vector\", \"maxzoom\": 1, \"tiles\": [\"file://%s/{z}%%2d{x}%%2D{y}.mvt\"]}",
             it->folder);
    expect_bent(it, source);
    /* TileJSON, its paths from itself; what the style says comes first. */
    write_text(it, "tiles.json",
               "{\"tilejson\": \"2.2.0\", \"tiles\": [\"t{x}.{y}.pbf\"], \"maxzoom\": 14, \"scheme\": \"tms\", "
               "\"attribution\": \"A\"}");
    expect_bent(it, "\"s\": {\"type\": \"vector\", \"maxzoom\": 1, \"url\": \"tiles.json\"}");
    expect_attribution(it, "A");
}

static void test_archives(void **state) {
    fixture *it = *state;
    static const uint32_t touched[3][2] = {{0, 0}, {1, 0}, {1, 1}};
    made_tile tiles[3];
    made_archive archive = {.directory_compression = 1, .tile_compression = 1, .type = 1, .min_zoom = 1, .max_zoom = 1};
    made_entry entries[3] = {{1, 1, 0, 0}, {3, 1, 0, 0}, {4, 1, 0, 0}};
    for (int i = 0; i < 3; i++) {
        blob tile = tile_of(touched[i][0], touched[i][1], 5, BENT, 4);
        tiles[i] = (made_tile){1, touched[i][0], touched[i][1], gzip_of(&tile)};
        made_entry *entry = &entries[i == 0 ? 0 : i == 1 ? 2 : 1];
        entry->offset = archive.tiles.size;
        entry->size = tile.size;
        blob_put(&archive.tiles, tile.bytes, tile.size);
        blob_free(&tile);
    }
    char path[256], source[512];
    assert_true(write_mbtiles(in_folder(it, "a.mbtiles", path), tiles, 3,
                              "INSERT INTO metadata VALUES ('minzoom', '1'), ('maxzoom', '1'), ('format', 'pbf'), "
                              "('attribution', '<b>Tiles</b>')"));
    for (int i = 0; i < 3; i++)
        blob_free(&tiles[i].content);
    archive.root = directory_of(entries, 3);
    blob whole = archive_of(&archive);
    write_blob(it, "a.pmtiles", &whole);
    blob_free(&archive.root);
    blob_free(&archive.tiles);
    static const char *const forms[] = {"mbtiles://a.mbtiles", "a.mbtiles", "pmtiles://a.pmtiles", "a.pmtiles",
                                        "pmtiles://file://%s"};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        char url[300];
        snprintf(url, sizeof url, i == 4 ? "pmtiles://file://%s/a.pmtiles" : "%s", i == 4 ? it->folder : forms[i]);
        snprintf(source, sizeof source, "\"s\": {\"type\": \"vector\", \"url\": \"%s\"}", url);
        expect_bent(it, source);
        expect_attribution(it, i < 2 ? "Tiles" : NULL);
    }
    /* The style has the last word. */
    expect_bent(it, "\"s\": {\"type\": \"vector\", \"url\": \"a.mbtiles\", \"attribution\": \"Mine\"}");
    expect_attribution(it, "Mine");
    expect_bent(it, "\"s\": {\"type\": \"vector\", \"maxzoom\": 1, \"tiles\": [\"pmtiles://a.pmtiles/{z}/{x}/{y}\"]}");
    /* As input, too: both are read whole. */
    for (int i = 0; i < 2; i++) {
        forget(it);
        assert_int_equal(camber_style_create_builtin(it->context, CAMBER_THEME_LIGHT, &it->style), CAMBER_OK);
        assert_int_equal(camber_features_create(it->context, it->style, &it->features), CAMBER_OK);
        const camber_source_desc desc = {.path = in_folder(it, i ? "a.pmtiles" : "a.mbtiles", path)};
        assert_false(camber_source_needs_gdal(&desc) || camber_source_is_osm(&desc));
        expect_ok(it, camber_features_read(it->features, &desc));
        expect_units(it, 0, 8192, 4, BENT_UNITS);
        expect_attribution(it, i ? NULL : "Tiles");
        assert_int_equal(it->features->classes[0].source, CAMBER_NO_SOURCE);
    }
}

/* floor(zoom), between the source's zooms. */
static void test_zooms(void **state) {
    fixture *it = *state;
    static const char source[] =
        "\"s\": {\"type\": \"vector\", \"minzoom\": 1, \"maxzoom\": 2, \"tiles\": [\"{z}.mvt\"]}";
    for (int zoom = 0; zoom < 4; zoom++) {
        char name[16];
        blob tile = tile_of(0, 0, 5, (int[]){100, 100, 200, 100 + zoom}, 2);
        snprintf(name, sizeof name, "%d.mvt", zoom);
        write_blob(it, name, &tile);
    }
    const double zooms[] = {0.0, 0.99, 1.0, 1.99, 2.0, 3.0, 9.5, 21.0};
    const int expected[] = {-1, -1, 1, 1, 2, 2, 2, 2};
    for (size_t i = 0; i < sizeof zooms / sizeof *zooms; i++) {
        const camber_view_desc view = view_at(zooms[i], 0.2, 0.2, 1, 64, 64);
        expect_ok(it, read_view(it, source, ROADS, &view));
        assert_int_equal(it->features->polyline_count, expected[i] < 0 ? 0 : 1);
        if (expected[i] >= 0)
            expect_units(it, 0, 4096 << expected[i], 2, (double[]){100, 100, 200, 100 + expected[i]});
    }
}

/* Tiles that the view does not see are not read, and lines go on as far as the buffer has them. */
static void test_seen_tiles(void **state) {
    fixture *it = *state;
    static const char source[] = "\"s\": {\"type\": \"vector\", \"maxzoom\": 2, \"tiles\": [\"{z}-{x}-{y}.mvt\"]}";
    const int across[] = {4000, 6000, 8400, 6000};
    for (uint32_t column = 0; column < 3; column++) {
        char name[32];
        blob tile = tile_of(column, 1, 5, across, 2);
        snprintf(name, sizeof name, "2-%u-1.mvt", column);
        write_blob(it, name, &tile);
    }
    camber_view_desc view = view_at(2.0, 1.5, 1.5, 2, 512, 512);
    expect_ok(it, read_view(it, source, ROADS, &view));
    expect_units(it, 0, 16384, 2, (double[]){4000, 6000, 8400, 6000});
    assert_int_equal(it->features->stats.joined_pieces, 0);
    view = view_at(2.0, 1.5, 1.5, 2, 520, 512);
    expect_ok(it, read_view(it, source, ROADS, &view));
    expect_units(it, 0, 16384, 2, (double[]){4000, 6000, 8400, 6000});
    assert_int_equal(it->features->stats.joined_pieces, 2);
    /* Turned by an eighth, the corners lie in the neighbours. */
    view = view_at(2.0, 1.5, 1.5, 2, 500, 500);
    view.bearing_deg = 45;
    expect_ok(it, read_view(it, source, ROADS, &view));
    assert_int_equal(it->features->stats.joined_pieces, 2);
    /* Tilted, it is wider where it sees farther. */
    view = view_at(2.0, 1.5, 1.5, 2, 500, 500);
    view.pitch_deg = 60;
    expect_ok(it, read_view(it, source, ROADS, &view));
    assert_int_equal(it->features->stats.joined_pieces, 2);
    /* Bounds leave the eastern tile out. */
    view = view_at(2.0, 1.5, 1.5, 2, 520, 512);
    expect_ok(it, read_view(it,
                            "\"s\": {\"type\": \"vector\", \"maxzoom\": 2, \"bounds\": [-180, -85, -5, 85], "
                            "\"tiles\": [\"{z}-{x}-{y}.mvt\"]}",
                            ROADS, &view));
    assert_int_equal(it->features->stats.joined_pieces, 1);
    /* None of its tiles there: empty, and said. */
    view = view_at(2.0, 3.5, 3.5, 2, 64, 64);
    expect_ok(it, read_view(it, source, ROADS, &view));
    assert_int_equal(it->features->polyline_count, 0);
    assert_int_equal(it->warnings, 1);
    assert_non_null(strstr(it->warning, "source \"s\""));
}

/* Points of a tile beside the view are read if circles reach into it from there, or may do so by what features say. */
static void test_circles_beside(void **state) {
    fixture *it = *state;
    static const char source[] = "\"s\": {\"type\": \"vector\", \"maxzoom\": 2, \"tiles\": [\"{z}-{x}-{y}.mvt\"]}";
    static const struct {
        const char *radius;
        size_t points;
    } cases[] = {{"5", 1}, {"20", 3}, {"[\"get\", \"r\"]", 3}, {"{\"stops\": [[2, 0], [8, 900]]}", 1}};
    for (uint32_t column = 0; column < 3; column++) {
        char name[32];
        blob tile = {0}, layer = begin_layer("road", 4096);
        put_points(&layer, (const int[]){2048, 2048}, 1);
        put_layer(&tile, &layer);
        snprintf(name, sizeof name, "2-%u-1.mvt", column);
        write_blob(it, name, &tile);
    }
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char layer[256];
        snprintf(layer, sizeof layer,
                 "{\"id\": \"c\", \"type\": \"circle\", \"source\": \"s\", \"source-layer\": \"road\", \"paint\": "
                 "{\"circle-radius\": %s}}",
                 cases[i].radius);
        camber_view_desc view = view_at(2.0, 1.5, 1.5, 2, 490, 490);
        expect_ok(it, read_view(it, source, layer, &view));
        assert_int_equal(it->features->point_count, cases[i].points);
        assert_int_equal(it->features->feature_count, cases[i].points);
    }
}

/* Over the antimeridian, a line in two tiles at the ends of the world is one. */
static void test_antimeridian(void **state) {
    fixture *it = *state;
    static const char source[] = "\"s\": {\"type\": \"vector\", \"maxzoom\": 2, \"tiles\": [\"{z}-{x}-{y}.mvt\"]}";
    blob west = tile_of(3, 1, 5, (int[]){16000, 6000, 17000, 6100}, 2);
    blob east = tile_of(0, 1, 5, (int[]){-384, 6000, 616, 6100}, 2);
    write_blob(it, "2-3-1.mvt", &west);
    write_blob(it, "2-0-1.mvt", &east);
    for (int i = 0; i < 2; i++) {
        camber_view_desc view = view_at(2.0, 4.0, 1.5, 2, 256, 256);
        view.longitude = i ? 180 : -180;
        expect_ok(it, read_view(it, source, ROADS, &view));
        assert_int_equal(it->features->polyline_count, 1);
        assert_int_equal(it->features->stats.joined_pieces, 1);
        const double x = it->features->points[0], y = it->features->points[2];
        assert_true(fabs(fabs(y - x) - 1000.0 / 16384) < 1e-9);
    }
}

/* Damage is counted and warned of with its tile, and the rest is there. */
static void test_damaged_tiles(void **state) {
    fixture *it = *state;
    static const char source[] = "\"s\": {\"type\": \"vector\", \"maxzoom\": 1, \"tiles\": [\"{z}-{x}-{y}.mvt\"]}";
    const camber_view_desc view = view_at(1.0, 1.0, 1.0, 1, 300, 300);
    write_bent(it, "1-%u-%u.mvt", false, false);
    blob tile = tile_of(1, 0, 5, BENT, 4), packed = gzip_of(&tile);
    packed.size -= 12;
    write_blob(it, "1-1-0.mvt", &packed);
    blob_free(&tile);
    expect_ok(it, read_view(it, source, ROADS, &view));
    assert_int_equal(it->features->stats.damaged_features, 1);
    assert_int_equal(it->warnings, 1);
    assert_non_null(strstr(it->warning, "tile 1/1/0: its compression is cut off"));
    assert_int_equal(it->features->polyline_count, 2);
    /* A hundred megabytes of zeros. */
    blob zeros = {.bytes = calloc(100 << 20, 1), .size = 100 << 20};
    packed = gzip_of(&zeros);
    blob_free(&zeros);
    write_blob(it, "1-1-0.mvt", &packed);
    assert_int_equal(read_view(it, source, ROADS, &view), CAMBER_ERROR_LIMIT);
    assert_non_null(strstr(it->error, "32 times"));
    write_text(it, "1-1-0.mvt", "<html>404</html>");
    expect_ok(it, read_view(it, source, ROADS, &view));
    assert_int_equal(it->features->stats.damaged_features, 1);
}

/* Four tiles of zoom 1: so many are cut off, the others whole. As MBTiles, as PMTiles and as files. */
static void write_some_damaged(const fixture *it, int damaged, const char *metadata) {
    made_tile tiles[4];
    made_entry entries[4];
    made_archive archive = {.directory_compression = 1, .tile_compression = 2, .type = 1, .min_zoom = 1, .max_zoom = 1};
    static const uint32_t numbers[4][2] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    char path[256], name[32];
    for (int i = 0; i < 4; i++) {
        blob tile = tile_of(numbers[i][0], numbers[i][1], 5, BENT, 4);
        tiles[i] = (made_tile){1, numbers[i][0], numbers[i][1], gzip_of(&tile)};
        tiles[i].content.size -= i < damaged ? 12 : 0;
        blob_free(&tile);
        entries[i] = (made_entry){(uint64_t)i + 1, 1, archive.tiles.size, tiles[i].content.size};
        blob_put(&archive.tiles, tiles[i].content.bytes, tiles[i].content.size);
    }
    unlink(in_folder(it, "d.mbtiles", path));
    assert_true(write_mbtiles(path, tiles, 4, metadata));
    archive.root = directory_of(entries, 4);
    blob whole = archive_of(&archive);
    write_blob(it, "d.pmtiles", &whole);
    blob_free(&archive.root);
    blob_free(&archive.tiles);
    for (int i = 0; i < 4; i++) {
        snprintf(name, sizeof name, "d-1-%u-%u.mvt", numbers[i][0], numbers[i][1]);
        write_blob(it, name, &tiles[i].content);
    }
}

static camber_status read_input(fixture *it, const char *name) {
    char path[256];
    forget(it);
    assert_int_equal(camber_style_create_builtin(it->context, CAMBER_THEME_LIGHT, &it->style), CAMBER_OK);
    assert_int_equal(camber_features_create(it->context, it->style, &it->features), CAMBER_OK);
    it->warnings = 0;
    return camber_features_read(it->features, &(camber_source_desc){.path = in_folder(it, name, path)});
}

static void expect_damage(const fixture *it, camber_status status) {
    if (status != CAMBER_ERROR_INPUT || it->errors != 1 || it->warnings ||
        !strstr(it->error, ": no feature can be read: tile 1/") || !strstr(it->error, "its compression is cut off; "))
        fail_msg("%s: %zu errors: %s, %zu warnings", camber_status_get_name(status), it->errors, it->error,
                 it->warnings);
    assert_int_equal(it->features->feature_count, 0);
    assert_int_equal(it->features->stats.damaged_features, 0);
}

/* Where every tile is damaged nothing was read, whatever the tiles lie in; one whole tile in view makes it a warning.
 */
static void test_all_tiles_damaged(void **state) {
    fixture *it = *state;
    static const char *const names[] = {"d.mbtiles", "d.pmtiles", "d-{z}-{x}-{y}.mvt"};
    static const char *const metadata[] = {NULL, "INSERT INTO metadata VALUES ('minzoom', '1'), ('maxzoom', '1'), "
                                                 "('json', '{\"vector_layers\": [{\"id\": \"road\"}]}')"};
    const camber_view_desc all = view_at(1.0, 1.0, 1.0, 1, 300, 300), corner = view_at(1.0, 0.1, 0.1, 1, 20, 20);
    for (int i = 0; i < 4; i++) {
        const bool are_all = i < 2;
        write_some_damaged(it, are_all ? 4 : 3, metadata[i % 2]);
        for (int k = 0; k < 3; k++) {
            char source[256];
            snprintf(source, sizeof source,
                     "\"s\": {\"type\": \"vector\", \"minzoom\": 1, \"maxzoom\": 1, \"%s\": %s\"%s\"%s}",
                     k < 2 ? "url" : "tiles", k < 2 ? "" : "[", names[k], k < 2 ? "" : "]");
            const camber_status seen = read_view(it, source, ROADS, &all);
            if (are_all)
                expect_damage(it, seen);
            else
                expect_ok(it, seen);
            assert_int_equal(it->warnings, !are_all);
            expect_damage(it, read_view(it, source, ROADS, &corner));
            if (k == 2)
                continue;
            const camber_status read = read_input(it, names[k]);
            if (are_all)
                expect_damage(it, read);
            else
                expect_ok(it, read);
        }
    }
}

/* ---- Errors ---- */

static void expect_error(fixture *it, camber_status expected, const char *source, const char *word) {
    const camber_view_desc view = view_at(1.0, 1.0, 1.0, 1, 64, 64);
    const camber_status status = read_view(it, source, LINES, &view);
    if (status != expected || it->errors != 1 ||
        !(strstr(it->error, "\"s\"") || strstr(it->error, "style.json: /sources/s: ")) || !strstr(it->error, word))
        fail_msg("%s: %s: %s", source, camber_status_get_name(status), it->error);
    assert_int_equal(it->features->polyline_count, 0);
    assert_int_equal(it->features->feature_count, 0);
}

static void test_errors(void **state) {
    fixture *it = *state;
    expect_error(it, CAMBER_ERROR_INPUT,
                 "\"s\": {\"type\": \"vector\", \"tiles\": [\"https://a.example/{z}/{x}/{y}.pbf\"]}", "download");
    expect_error(it, CAMBER_ERROR_INPUT, "\"s\": {\"type\": \"vector\", \"url\": \"http://a.example/t.json\"}",
                 "network");
    expect_error(it, CAMBER_ERROR_INPUT,
                 "\"s\": {\"type\": \"vector\", \"url\": \"pmtiles://https://a.example/a.pmtiles\"}", "network");
    expect_error(it, CAMBER_ERROR_INPUT, "\"s\": {\"type\": \"vector\", \"url\": \"mapbox://mapbox.streets\"}",
                 "network");
    expect_error(it, CAMBER_ERROR_INPUT, "\"s\": {\"type\": \"vector\", \"url\": \"gopher://x/y\"}", "gopher");
    expect_error(it, CAMBER_ERROR_INPUT, "\"s\": {\"type\": \"vector\"}", "tiles");
    expect_error(it, CAMBER_ERROR_INPUT,
                 "\"s\": {\"type\": \"vector\", \"minzoom\": 5, \"maxzoom\": 3, \"tiles\": [\"x\"]}", "minzoom");
    expect_error(it, CAMBER_ERROR_INPUT, "\"s\": {\"type\": \"geojson\"}", "data");
    expect_error(it, CAMBER_ERROR_INPUT, "\"s\": {\"type\": \"geojson\", \"data\": {\"type\": \"Topology\"}}",
                 "GeoJSON");
    expect_error(it, CAMBER_ERROR_INPUT, "\"s\": {\"type\": \"geojson\", \"data\": \"https://a.example/a.geojson\"}",
                 "network");
    write_text(it, "bad.json", "{\"type\": \"FeatureCollection\",\n \"features\": [}");
    expect_error(it, CAMBER_ERROR_INPUT, "\"s\": {\"type\": \"geojson\", \"data\": \"bad.json\"}", "line 2");
    expect_error(it, CAMBER_ERROR_INPUT,
                 "\"s\": {\"type\": \"geojson\", \"data\": {\"type\": \"FeatureCollection\", \"features\": "
                 "[{\"geometry\": {\"type\": \"Point\", \"coordinates\": [1, 1]}}, "
                 "{\"geometry\": {\"type\": \"LineString\", \"coordinates\": \"none\"}}]}}",
                 "no feature can be read: /features/1: coordinates that are not an array");
    write_text(it, "lone.json", "{\"tilejson\": \"3.0.0\"}");
    /* Files that are not there, or no sets of tiles, are named. */
    const camber_view_desc view = view_at(1.0, 1.0, 1.0, 1, 64, 64);
    assert_int_equal(read_view(it, "\"s\": {\"type\": \"geojson\", \"data\": \"none.json\"}", LINES, &view),
                     CAMBER_ERROR_NOT_FOUND);
    assert_non_null(strstr(it->error, "none.json"));
    assert_int_equal(read_view(it, "\"s\": {\"type\": \"vector\", \"url\": \"lone.json\"}", LINES, &view),
                     CAMBER_ERROR_INPUT);
    assert_non_null(strstr(it->error, "/lone.json: no \"tiles\""));
    assert_int_equal(read_view(it, "\"s\": {\"type\": \"vector\", \"url\": \"mbtiles://none.mbtiles\"}", LINES, &view),
                     CAMBER_ERROR_NOT_FOUND);
    write_text(it, "bad.mbtiles",
               "no database, but long enough to be read as one, if one does not look at how it begins");
    assert_int_equal(read_view(it, "\"s\": {\"type\": \"vector\", \"url\": \"bad.mbtiles\"}", LINES, &view),
                     CAMBER_ERROR_INPUT);
    char path[256];
    assert_true(
        write_mbtiles(in_folder(it, "png.mbtiles", path), NULL, 0, "INSERT INTO metadata VALUES ('format', 'png')"));
    assert_int_equal(read_view(it, "\"s\": {\"type\": \"vector\", \"url\": \"png.mbtiles\"}", LINES, &view),
                     CAMBER_ERROR_INPUT);
    assert_non_null(strstr(it->error, "png"));
    assert_true(write_mbtiles(in_folder(it, "empty.mbtiles", path), NULL, 0, NULL));
    assert_int_equal(read_view(it, "\"s\": {\"type\": \"vector\", \"url\": \"empty.mbtiles\"}", LINES, &view),
                     CAMBER_ERROR_INPUT);
    /* A source that no layer draws is left alone. */
    expect_ok(it, read_view(it,
                            "\"other\": {\"type\": \"vector\", \"url\": \"https://a.example\"}, "
                            "\"s\": {\"type\": \"geojson\", \"data\": {\"type\": \"LineString\", \"coordinates\": "
                            "[[0, 0], [1, 1]]}}",
                            LINES, &view));
    assert_int_equal(it->features->polyline_count, 1);
    assert_int_equal(it->features->classes[0].source, 1);
}

/* A view of a database that never ends, and another that picks one row of a million times a million. */
static void test_endless_database(void **state) {
    fixture *it = *state;
    const camber_view_desc view = view_at(1.0, 1.0, 1.0, 1, 64, 64);
    char path[256];
    assert_true(write_mbtiles(in_folder(it, "endless.mbtiles", path), NULL, 0,
                              "DROP TABLE metadata; CREATE VIEW metadata AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL "
                              "SELECT i + 1 FROM n) SELECT 'a' AS name, i AS value FROM n"));
    assert_int_equal(read_view(it, "\"s\": {\"type\": \"vector\", \"url\": \"endless.mbtiles\"}", LINES, &view),
                     CAMBER_ERROR_INPUT);
    assert_non_null(strstr(it->error, "recursion"));
    assert_true(write_mbtiles(in_folder(it, "product.mbtiles", path), NULL, 0,
                              "CREATE TABLE n (i); INSERT INTO n WITH RECURSIVE c(x) AS (SELECT 0 UNION ALL SELECT "
                              "x + 1 FROM c WHERE x < 999) SELECT x FROM c; DROP TABLE metadata; CREATE VIEW metadata "
                              "AS SELECT 'a' AS name, a.i AS value FROM n a, n b, n c, n d"));
    assert_int_equal(read_view(it, "\"s\": {\"type\": \"vector\", \"url\": \"product.mbtiles\"}", LINES, &view),
                     CAMBER_ERROR_LIMIT);
    assert_non_null(strstr(it->error, "too many steps"));
}

/* ---- GeoJSON ---- */

static const camber_value *value_of(const fixture *it, size_t feature, const char *name) {
    const camber_features *set = it->features;
    for (size_t i = 0; i < it->style->schema.property_count; i++)
        if (strcmp(it->style->schema.properties[i], name) == 0)
            return &set->values[set->classes[set->feature_class[feature]].first_value + i];
    fail_msg("no property %s", name);
    return NULL;
}

#define FEATURE(id, properties, geometry)                                                                              \
    "{\"type\": \"Feature\"" id ", \"properties\": {" properties "}, \"geometry\": " geometry "}"
#define LINE "{\"type\": \"LineString\", \"coordinates\": [[10, 20], [30, 40]]}"

static const char GEOJSON[] = "\"data\": {\"type\": \"FeatureCollection\", \"features\": ["
    /**/ FEATURE(", \"id\": 12", "\"a\": \"x\", \"n\": null, \"deep\": {\"list\": [1, \"two\", {\"k\": true}]}",
                 LINE) ","
    /**/ FEATURE(", \"id\": \"13\"", "\"a\": 2.5, \"name\": \"thirteen\"", LINE) ","
    /**/ FEATURE("", "\"a\": true, \"name\": \"ring\"",
                 "{\"type\": \"Polygon\", \"coordinates\": [[[0, 0], [9, 0], [9, 9], [0, 0]], [[1, 1], [2, 1], [2, 2], "
                 "[1, 1]]]}") ","
    /**/ FEATURE("", "", "null") ","
    /**/ FEATURE("", "", "{\"type\": \"Point\", \"coordinates\": [1, 2]}") ","
    /**/ FEATURE(
        "", "",
        "{\"type\": \"GeometryCollection\", \"geometries\": [" LINE
        ", {\"type\": \"MultiLineString\", \"coordinates\": [[[170, 0], [190, 10]], [[0, 89], [0, 91]]]}]}") ","
    /**/ FEATURE("", "\"a\": 1",
                 "{\"type\": \"LineString\", \"coordinates\": [[0, 0], [1e300, 0], \"no\", [5, 5]]}") "]}";

#define READS_ALL                                                                                                      \
    "{\"id\": \"l\", \"type\": \"line\", \"source\": \"s\", \"filter\": [\"all\", [\"has\", \"a\"], [\"has\", "        \
    "\"n\"], "                                                                                                         \
    "[\"has\", \"name\"], [\"!=\", [\"to-string\", [\"get\", \"deep\"]], \"\"]]}"

static void read_geojson(fixture *it, const char *options) {
    char source[4096];
    const camber_view_desc view = {.kind = CAMBER_VIEW_FIT};
    snprintf(source, sizeof source, "\"s\": {\"type\": \"geojson\"%s, %s}", options, GEOJSON);
    it->wants_id = true;
    expect_ok(it, read_view(it, source, READS_ALL, &view));
}

static const camber_value *id_of(const fixture *it, size_t feature) {
    return &it->features->classes[it->features->feature_class[feature]].id;
}

/* Where a style asks for directions, outlines go clockwise as seen and holes the other way, however they are written.
 */
static void test_winding(void **state) {
    fixture *it = *state;
    static const char *const styles[] = {
        LINES, "{\"id\": \"l\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-offset\": 3}}"};
    static const char *const written[] = {
        "[[[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]], [[3, 3], [6, 3], [6, 6], [3, 3]]]",
        "[[[0, 0], [0, 9], [9, 9], [9, 0], [0, 0]], [[3, 3], [6, 6], [6, 3], [3, 3]]]"};
    for (size_t i = 0; i < 4; i++) {
        char source[512];
        const camber_view_desc view = {.kind = CAMBER_VIEW_FIT};
        snprintf(source, sizeof source,
                 "\"s\": {\"type\": \"geojson\", \"data\": {\"type\": \"Polygon\", \"coordinates\": %s}}",
                 written[i % 2]);
        expect_ok(it, read_view(it, source, styles[i / 2], &view));
        assert_int_equal(it->features->polyline_count, 2);
        for (size_t k = 0; k < 2; k++) {
            const double *points = it->features->points;
            double area = 0;
            for (size_t n = it->features->offsets[k]; n + 1 < it->features->offsets[k + 1]; n++)
                area += points[2 * n] * points[2 * n + 3] - points[2 * n + 1] * points[2 * n + 2];
            const bool clockwise = i < 2 ? i == 1 : k == 0; /* y goes down */
            assert_true((area > 0) == clockwise);
        }
    }
}

static void test_geojson(void **state) {
    fixture *it = *state;
    read_geojson(it, "");
    const camber_features *set = it->features;
    assert_int_equal(set->feature_count, 5);
    assert_int_equal(set->polyline_count, 8);
    assert_int_equal(set->stats.skipped_features, 2);
    assert_int_equal(set->stats.damaged_features, 1);
    assert_non_null(strstr(it->warning, "/features/6: a position"));
    double longitude, latitude;
    camber_mercator_unproject(set->points[2], set->points[3], &longitude, &latitude);
    assert_true(fabs(longitude - 30) < 1e-9 && fabs(latitude - 40) < 1e-9);
    assert_string_equal(value_of(it, 0, "a")->string, "x");
    assert_true(value_of(it, 1, "a")->number == 2.5);
    assert_int_equal(value_of(it, 2, "a")->type, CAMBER_VALUE_BOOL);
    assert_true(value_of(it, 0, "n")->type == CAMBER_VALUE_NULL && value_of(it, 0, "n")->boolean);
    assert_false(value_of(it, 1, "n")->boolean);
    const camber_value *deep = value_of(it, 0, "deep");
    assert_int_equal(deep->type, CAMBER_VALUE_OBJECT);
    const camber_value *list = camber_object_get(deep, "list");
    assert_int_equal(list->count, 3);
    assert_true(list->items[0].number == 1);
    assert_string_equal(list->items[1].string, "two");
    assert_true(camber_object_get(&list->items[2], "k")->boolean);
    assert_true(id_of(it, 0)->number == 12 && id_of(it, 1)->number == 13);
    assert_int_equal(id_of(it, 2)->type, CAMBER_VALUE_NULL);
    assert_int_equal(set->classes[set->feature_class[2]].geometry, CAMBER_GEOMETRY_POLYGON);
    assert_int_equal(set->offsets[3] - set->offsets[2], 4);
    /* Not split at the antimeridian, as in other engines, and held at the edge of the map. */
    const size_t beyond = set->offsets[5] + 1, pole = set->offsets[6];
    assert_true(set->points[2 * beyond] > 1.02);
    assert_true(set->points[2 * pole + 1] < 1e-9 && set->points[2 * pole + 1] > -1e-9);
}

static void test_geojson_options(void **state) {
    fixture *it = *state;
    read_geojson(it, ", \"generateId\": true");
    assert_true(id_of(it, 0)->number == 0 && id_of(it, 2)->number == 2);
    expect_attribution(it, NULL);
    read_geojson(it, ", \"attribution\": \"Mine\"");
    expect_attribution(it, "Mine");
    read_geojson(it, ", \"promoteId\": \"name\"");
    assert_int_equal(id_of(it, 0)->type, CAMBER_VALUE_NULL);
    assert_string_equal(id_of(it, 1)->string, "thirteen");
    read_geojson(it, ", \"filter\": [\"==\", [\"get\", \"name\"], \"ring\"]");
    assert_int_equal(it->features->feature_count, 1);
    assert_int_equal(it->features->classes[it->features->feature_class[0]].geometry, CAMBER_GEOMETRY_POLYGON);
    read_geojson(it, ", \"lineMetrics\": true, \"cluster\": true, \"tolerance\": 3, \"buffer\": 0");
    assert_int_equal(it->features->polyline_count, 8);
}

/* Numbers that JSON has no word for, as other programs write them: the point is left out and its line split there, and
 * texts that look like it stay. */
static void test_no_numbers(void **state) {
    fixture *it = *state;
    static const char source[] = "\"s\": {\"type\": \"geojson\", \"data\": \"odd.json\"}";
    static const char *const odd[] = {
        "NaN",    "nan",    "Infinity", "-Infinity", "1e400",
        "-1e400", "1E+999", "null",     "-12.5e309", "1797693134862315708145274237317e278"};
    const camber_view_desc view = {.kind = CAMBER_VIEW_FIT};
    char text[1024];
    for (size_t i = 0; i < 2 * sizeof odd / sizeof *odd; i++) {
        snprintf(text, sizeof text,
                 "\xef\xbb\xbf{\"type\": \"FeatureCollection\", \"features\": [" FEATURE(
                     "", "\"a\": \"NaN \\\" 1e400, Infinity\", \"n\": NaN, \"name\": %s",
                     "{\"type\": \"LineString\", \"coordinates\": [[0, 0], [1, 1], [%s, %s], [3,\n 3]]}") "]}",
                 i % 2 ? "1e400" : "-Infinity", i % 2 ? "2" : odd[i / 2], i % 2 ? odd[i / 2] : "2");
        write_text(it, "odd.json", text);
        expect_ok(it, read_view(it, source, READS_ALL, &view));
        const camber_features *set = it->features;
        assert_int_equal(set->polyline_count, 2);
        assert_int_equal(set->point_count, 3);
        assert_int_equal(set->stats.invalid_points, 1);
        assert_int_equal(set->stats.damaged_features, 0);
        assert_int_equal(it->warnings, 1);
        assert_non_null(strstr(it->warning, "source \"s\": 1 points are not numbers and are left out"));
        assert_string_equal(value_of(it, 0, "a")->string, "NaN \" 1e400, Infinity");
        assert_int_equal(value_of(it, 0, "n")->type, CAMBER_VALUE_NULL);
        assert_true(value_of(it, 0, "name")->number == (i % 2 ? 1e308 : -1e308));
    }
    /* A ring is split there as well, and has no area of its own. */
    write_text(it, "odd.json",
               "{\"type\": \"Polygon\", \"coordinates\": [[[0, 0], [9, 0], [NaN, 9], [0, 9], [0, 0]]]}");
    expect_ok(it, read_view(it, source, LINES, &view));
    assert_int_equal(it->features->polyline_count, 2);
    assert_int_equal(it->features->stats.damaged_features, 0);
    /* Other faults are said, with their place. */
    write_text(it, "odd.json", "{\"type\": \"LineString\",\n \"coordinates\": [[1e400, NaN], oops]}");
    expect_error(it, CAMBER_ERROR_INPUT, source, ": invalid token; get the file again");
    write_text(it, "odd.json", "\xff\xfe{");
    expect_error(it, CAMBER_ERROR_INPUT, source, "save it as UTF-8");
    /* TileJSON is read so too; a style is not, but for the mark. */
    write_text(it, "odd.json", "\xef\xbb\xbf{\"tiles\": [\"none-{z}-{x}-{y}\"], \"fillzoom\": NaN}");
    expect_ok(it, read_view(it, "\"s\": {\"type\": \"vector\", \"url\": \"odd.json\"}", ROADS, &view));
    static const char style[] = "\xef\xbb\xbf{\"version\": 8, \"zoom\": 1, \"sources\": {}, \"layers\": []}",
                      bad[] = "{\"version\": 8, \"zoom\": NaN, \"sources\": {}, \"layers\": []}";
    camber_style *parsed;
    assert_int_equal(camber_style_parse(it->context, style, strlen(style), "style", &parsed), CAMBER_OK);
    camber_style_destroy(parsed);
    assert_int_equal(camber_style_parse(it->context, bad, strlen(bad), "style", &parsed), CAMBER_ERROR_INPUT);
    assert_non_null(strstr(it->error, "near 'NaN'; correct the JSON there"));
}

/* ---- Seams ---- */

/* The bent line from four tiles and from GeoJSON: the same points, so the same picture. */
static void test_seams(void **state) {
    fixture *it = *state;
    const camber_view_desc view = view_at(1.0, 1.0, 1.0, 1, 300, 300);
    char source[1024];
    size_t used =
        (size_t)snprintf(source, sizeof source,
                         "\"s\": {\"type\": \"geojson\", \"data\": {\"type\": \"LineString\", \"coordinates\": [");
    for (int i = 0; i < 4; i++) {
        double longitude, latitude;
        camber_mercator_unproject(BENT[2 * i] / 8192.0, BENT[2 * i + 1] / 8192.0, &longitude, &latitude);
        used += (size_t)snprintf(source + used, sizeof source - used, "%s[%.15g, %.15g]", i ? ", " : "", longitude,
                                 latitude);
    }
    snprintf(source + used, sizeof source - used, "]}}");
    expect_ok(it, read_view(it, source, LINES, &view));
    double whole[8];
    assert_int_equal(it->features->point_count, 4);
    memcpy(whole, it->features->points, sizeof whole);
    write_bent(it, "1-%u-%u.mvt", false, false);
    expect_bent(it, "\"s\": {\"type\": \"vector\", \"maxzoom\": 1, \"tiles\": [\"{z}-{x}-{y}.mvt\"]}");
    for (int i = 0; i < 8; i++)
        assert_true(fabs(it->features->points[i] - whole[i]) < 1e-12);
    /* Without ids, the pieces of one class find each other. */
    for (int i = 0; i < 3; i++) {
        static const uint32_t touched[3][2] = {{0, 0}, {1, 0}, {1, 1}};
        char name[32];
        blob tile = tile_of(touched[i][0], touched[i][1], 0, BENT, 4);
        snprintf(name, sizeof name, "1-%u-%u.mvt", touched[i][0], touched[i][1]);
        write_blob(it, name, &tile);
    }
    expect_bent(it, "\"s\": {\"type\": \"vector\", \"maxzoom\": 1, \"tiles\": [\"{z}-{x}-{y}.mvt\"]}");
}

/* Features that go straight on are one line, so that no seam shows where butt ends meet; but for what is drawn along
 * each. */
static void test_straight_on(void **state) {
    fixture *it = *state;
    static const char source[] =
        "\"s\": {\"type\": \"geojson\", \"data\": {\"type\": \"GeometryCollection\", \"geometries\": ["
        "{\"type\": \"LineString\", \"coordinates\": [[0, 0], [1, 0]]}, "
        "{\"type\": \"LineString\", \"coordinates\": [[2, 0], [1, 0]]}, "
        "{\"type\": \"LineString\", \"coordinates\": [[2, 0], [2, 1]]}]}}";
    const camber_view_desc view = view_at(1.0, 0.0, 1.0, 1, 300, 300);
    expect_ok(it, read_view(it, source, LINES, &view));
    assert_int_equal(it->features->polyline_count, 2);
    assert_int_equal(it->features->stats.merged_polylines, 1);
    expect_ok(it, read_view(it, source,
                            "{\"id\": \"l\", \"type\": \"line\", \"source\": \"s\", "
                            "\"paint\": {\"line-dasharray\": [2, 1]}}",
                            &view));
    assert_int_equal(it->features->polyline_count, 3);
}

/* Where no camera is given, the sources' bounds say what is read. */
static void test_fit(void **state) {
    fixture *it = *state;
    const camber_view_desc view = {.kind = CAMBER_VIEW_FIT, .width = 512, .height = 512};
    blob tile = tile_of(1, 1, 5, (int[]){4100, 4100, 4200, 4200}, 2);
    write_blob(it, "2-1-1.mvt", &tile);
    expect_ok(it, read_view(it,
                            "\"s\": {\"type\": \"vector\", \"bounds\": [-89, 30, -30, 66], "
                            "\"tiles\": [\"{z}-{x}-{y}.mvt\"]}",
                            ROADS, &view));
    assert_int_equal(it->features->polyline_count, 1);
    expect_ok(it, read_view(it, "\"s\": {\"type\": \"vector\", \"tiles\": [\"{z}-{x}-{y}.mvt\"]}", ROADS, &view));
    assert_int_equal(it->features->polyline_count, 0);
    const camber_view_desc bad = {.kind = CAMBER_VIEW_CENTER, .zoom = 99};
    assert_int_equal(read_view(it, "\"s\": {\"type\": \"vector\", \"tiles\": [\"x\"]}", ROADS, &bad),
                     CAMBER_ERROR_ARGUMENT);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_templates),  TEST(test_archives),         TEST(test_zooms),
        TEST(test_seen_tiles), TEST(test_antimeridian),     TEST(test_damaged_tiles),
        TEST(test_errors),     TEST(test_endless_database), TEST(test_geojson),
        TEST(test_winding),    TEST(test_geojson_options),  TEST(test_seams),
        TEST(test_fit),        TEST(test_straight_on),      TEST(test_all_tiles_damaged),
        TEST(test_no_numbers), TEST(test_circles_beside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
