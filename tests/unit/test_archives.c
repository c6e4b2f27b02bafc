/* The writer of archives: its bytes depend on tiles alone, equal tiles are stored once, neighbours are runs,
 * directories have leaves, tiles are renewed and removed, tilesets are verified; and GDAL, as another reader, shows the
 * pixels of MBTiles. */
#include "core.h"

#include "archive/archive.h"
#include "archive/pmtiles.h"
#include "archive/writer.h"
#include "camber_tiles.h"
#include "tile_maker.h"

#include <gdal.h>

typedef struct place {
    host host;
    camber_context *context;
    char folder[64];
} place;

static int set_up(void **state) {
    place *p = calloc(1, sizeof *p);
    assert_non_null(p);
    snprintf(p->folder, sizeof p->folder, "/tmp/camber-archives-XXXXXX");
    assert_non_null(mkdtemp(p->folder));
    p->context = host_context(&p->host);
    *state = p;
    return 0;
}

static int tear_down(void **state) {
    place *p = *state;
    char command[96];
    snprintf(command, sizeof command, "rm -rf '%s'", p->folder);
    assert_int_equal(system(command), 0);
    host_done(&p->host, p->context);
    free(p);
    return 0;
}

static camber_archive_writer *open_writer(place *p, const char *name, bool unites) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s", p->folder, name);
    camber_archive_desc desc = {.path = path, .type = CAMBER_TILE_PNG, .force = true, .unites = unites};
    camber_archive_writer *writer = NULL;
    assert_true(camber_archive_get_format(path, &desc.format));
    assert_int_equal(camber_archive_writer_create(p->context, &desc, &writer), CAMBER_OK);
    return writer;
}

static void add(camber_archive_writer *writer, uint64_t number, uint64_t value) {
    unsigned char bytes[MADE_TILE_BYTES];
    const int zoom = camber_archive_zoom(number);
    camber_tile_index tile;
    camber_pmtiles_locate(number - camber_archive_first(zoom), zoom, &tile.column, &tile.row);
    const size_t size = make_tile(value, bytes);
    assert_int_equal(camber_archive_writer_add(writer, zoom, tile, bytes, size), CAMBER_OK);
}

static void finish(camber_archive_writer *writer) {
    assert_int_equal(camber_archive_writer_finish(writer), CAMBER_OK);
    camber_archive_writer_destroy(writer);
}

static void read_all(place *p, const char *name, char **bytes, size_t *size) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s", p->folder, name);
    assert_int_equal(camber_read_file(p->context, path, CAMBER_NAMED_BY_CALLER, bytes, size), CAMBER_OK);
}

static void assert_same(place *p, const char *one, const char *other) {
    char *a, *b;
    size_t a_size, b_size;
    read_all(p, one, &a, &a_size);
    read_all(p, other, &b, &b_size);
    assert_int_equal(a_size, b_size);
    assert_memory_equal(a, b, a_size);
    camber_free(p->context, a);
    camber_free(p->context, b);
}

static camber_tiles_info *show(place *p, const char *name) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s", p->folder, name);
    camber_tiles_info *info = NULL;
    assert_int_equal(camber_tiles_show(p->context, path, &info), CAMBER_OK);
    return info;
}

static void assert_right(place *p, const char *name) {
    char path[128];
    camber_tiles_findings *found = NULL;
    snprintf(path, sizeof path, "%s/%s", p->folder, name);
    assert_int_equal(camber_tiles_verify(p->context, path, &found), CAMBER_OK);
    if (found->count)
        fail_msg("%s: %s", name, found->findings[0].message);
    camber_tiles_findings_destroy(found);
}

/* Single tiles of each format: those that are there, those that are not, and places that no archive has. */
static void test_single(void **state) {
    place *p = *state;
    static const char *const names[] = {"single.pmtiles", "single.mbtiles", "single/"};
    for (size_t i = 0; i < 3; i++) {
        char path[128];
        unsigned char wanted[MADE_TILE_BYTES];
        camber_tiles_reader *reader = NULL;
        camber_archive_writer *writer = open_writer(p, names[i], false);
        for (uint64_t k = 5; k < 21; k++) /* zoom 2 */
            if (k % 3)
                add(writer, k, made_tile_value(k));
        finish(writer);
        snprintf(path, sizeof path, "%s/%s", p->folder, names[i]);
        assert_int_equal(camber_tiles_reader_create(p->context, path, &reader), CAMBER_OK);
        const camber_tiles_info *info = camber_tiles_reader_get_info(reader);
        assert_string_equal(info->type, "png");
        assert_true(info->min_zoom == 2 && info->max_zoom == 2 && info->metadata[0] == '{');
        for (uint64_t k = 5; k < 21; k++) {
            camber_tiles_place where = {.zoom = 2};
            const uint8_t *bytes = NULL;
            size_t size_bytes = 77;
            camber_pmtiles_locate(k - 5, 2, &where.column, &where.row);
            assert_int_equal(camber_tiles_reader_read(reader, &where, &bytes, &size_bytes), CAMBER_OK);
            assert_int_equal(size_bytes, k % 3 ? make_tile(made_tile_value(k), wanted) : 0);
            if (size_bytes)
                assert_memory_equal(bytes, wanted, size_bytes);
        }
        const camber_tiles_place outside[] = {{25, 0, 0}, {-1, 0, 0}, {2, 4, 0}, {2, 0, 4}};
        for (size_t k = 0; k < 4; k++) {
            const uint8_t *bytes;
            size_t size_bytes;
            assert_int_equal(camber_tiles_reader_read(reader, &outside[k], &bytes, &size_bytes), CAMBER_ERROR_ARGUMENT);
            assert_story(&p->host, "there is no tile");
        }
        camber_tiles_reader_destroy(reader);
    }
    camber_tiles_reader *none = NULL;
    assert_int_equal(camber_tiles_reader_create(p->context, "/tmp/no-such.pmtiles", &none), CAMBER_ERROR_NOT_FOUND);
    assert_story(&p->host, "no-such.pmtiles");
    assert_null(none);
}

/* Forwards with units, backwards without, and at random with each tile twice: the last of them stays. */
static void test_order(void **state) {
    place *p = *state;
    enum { COUNT = 5000 };
    static const char *const names[] = {"a.pmtiles", "a.mbtiles", "b.pmtiles", "b.mbtiles", "c.pmtiles", "c.mbtiles"};
    for (size_t i = 0; i < 6; i++) {
        camber_archive_writer *writer = open_writer(p, names[i], false);
        for (uint64_t k = 0; k < COUNT; k++) {
            const uint64_t number = i < 2 ? k : i < 4 ? COUNT - 1 - k : k * 2147483647 % COUNT;
            if (i >= 4)
                add(writer, number, 77);
            add(writer, number, made_tile_value(number));
            if (i < 2 && k % 500 == 499)
                assert_int_equal(camber_archive_writer_end_unit(writer, k / 500), CAMBER_OK);
        }
        finish(writer);
        assert_right(p, names[i]);
        if (i > 1)
            assert_same(p, names[i % 2], names[i]);
    }
}

/* Types that MBTiles has no name for come back as what they were, and are right. */
static void test_meshes(void **state) {
    place *p = *state;
    static const char *const names[] = {"m.pmtiles", "m.mbtiles", "m/"};
    static const unsigned char glb[12] = "glTF\2\0\0\0\14\0\0";
    for (size_t i = 0; i < 3; i++) {
        char path[128];
        snprintf(path, sizeof path, "%s/%s", p->folder, names[i]);
        camber_archive_desc desc = {.path = path, .type = CAMBER_TILE_GLB};
        camber_archive_writer *writer = NULL;
        assert_true(camber_archive_get_format(path, &desc.format));
        assert_int_equal(camber_archive_writer_create(p->context, &desc, &writer), CAMBER_OK);
        assert_int_equal(camber_archive_writer_add(writer, 0, (camber_tile_index){0, 0}, glb, sizeof glb), CAMBER_OK);
        finish(writer);
        assert_right(p, names[i]);
        camber_tiles_info *info = show(p, names[i]);
        assert_string_equal(info->type, "glb");
        camber_tiles_info_destroy(info);
    }
}

/* Changes a bit of these bytes in a file that has them. */
static void flip(const char *path, const unsigned char *bytes, size_t size) {
    static unsigned char content[1 << 16];
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    const size_t count = fread(content, 1, sizeof content, file);
    size_t at = 0;
    while (at + size <= count && memcmp(content + at, bytes, size) != 0)
        at++;
    assert_true(at + size <= count);
    assert_int_equal(fseek(file, (long)(at + size - 1), SEEK_SET), 0);
    assert_int_equal(fputc(bytes[size - 1] ^ 1, file), bytes[size - 1] ^ 1);
    assert_int_equal(fclose(file), 0);
}

/* A mesh that is another one, and a mesh still. */
static void test_flipped_meshes(void **state) {
    place *p = *state;
    static const char *const names[] = {"f.pmtiles", "f.mbtiles", "f/"}, *const files[] = {"f.pmtiles", "f.mbtiles",
                                                                                           "f/0/0/0.glb"};
    static const unsigned char glb[] = "glTF\2\0\0\0\40\0\0\0of whatever numbers";
    for (size_t i = 0; i < 3; i++) {
        char path[128], file[128];
        camber_archive_writer *writer = NULL;
        camber_tiles_findings *found = NULL;
        snprintf(path, sizeof path, "%s/%s", p->folder, names[i]);
        snprintf(file, sizeof file, "%s/%s", p->folder, files[i]);
        camber_archive_desc desc = {.path = path, .type = CAMBER_TILE_GLB};
        assert_true(camber_archive_get_format(path, &desc.format));
        assert_int_equal(camber_archive_writer_create(p->context, &desc, &writer), CAMBER_OK);
        assert_int_equal(camber_archive_writer_add(writer, 0, (camber_tile_index){0, 0}, glb, sizeof glb), CAMBER_OK);
        finish(writer);
        assert_right(p, names[i]);
        flip(file, glb, sizeof glb);
        assert_int_equal(camber_tiles_verify(p->context, path, &found), CAMBER_OK);
        assert_int_equal(found->count, 1);
        assert_non_null(strstr(found->findings[0].message, "checksum"));
        camber_tiles_findings_destroy(found);
    }
}

static void make_meshes(place *p, const char *path) {
    static const camber_tile_index ends[] = {{0, 0}, {1, 0}, {1023, 1023}};
    static const unsigned char glb[12] = "glTF\2\0\0\0\14\0\0";
    const camber_archive_desc desc = {
        .path = path, .format = CAMBER_ARCHIVE_FOLDER, .type = CAMBER_TILE_GLB, .force = true};
    camber_archive_writer *writer = NULL;
    assert_int_equal(camber_archive_writer_create(p->context, &desc, &writer), CAMBER_OK);
    for (int zoom = 0; zoom < 10; zoom++)
        assert_int_equal(camber_archive_writer_add(writer, zoom, ends[0], glb, sizeof glb), CAMBER_OK);
    for (size_t i = 0; i < 3; i++)
        assert_int_equal(camber_archive_writer_add(writer, 10, ends[i], glb, sizeof glb), CAMBER_OK);
    finish(writer);
}

/* Verifying compares a folder's tileset with its tiles. */
static void test_tilesets(void **state) {
    place *p = *state;
    static const struct {
        const char *command, *told;
        bool error;
    } rows[] = {{"true", NULL, false},
                {"rm 10/1/0.glb", "subtrees/6.0.0.subtree does not list the tiles that exist", true},
                {"rm 10/1023/1023.glb", "subtrees/0.0.0.subtree does not list the tiles that exist", true},
                {"rm 10/1023/1023.glb", "subtrees/6.63.63.subtree lists no tile", true},
                {"cp subtrees/6.0.0.subtree subtrees/x", "subtrees/x lists no tile", true},
                {"rm subtrees/6.63.63.subtree", "subtrees/6.63.63.subtree is missing", true},
                {"rm -r subtrees", "subtrees/0.0.0.subtree is missing", true},
                {"rm tileset.json", "tileset.json is missing", false},
                {"echo {} >tileset.json", "tileset.json is not the one that camber tiles writes", false},
                {"echo { >tileset.json", "tileset.json is not JSON", true}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char path[128], command[256];
        camber_tiles_findings *found = NULL;
        bool told = !rows[i].told;
        snprintf(path, sizeof path, "%s/t/", p->folder);
        make_meshes(p, path);
        snprintf(command, sizeof command, "cd '%s' && %s", path, rows[i].command);
        assert_int_equal(system(command), 0);
        assert_int_equal(camber_tiles_verify(p->context, path, &found), CAMBER_OK);
        for (size_t k = 0; k < found->count && rows[i].told; k++)
            told |= strncmp(found->findings[k].message, rows[i].told, strlen(rows[i].told)) == 0 &&
                    found->findings[k].error == rows[i].error;
        assert_true(told && (rows[i].told || found->count == 0));
        camber_tiles_findings_destroy(found);
    }
}

static void test_runs(void **state) {
    place *p = *state;
    camber_archive_writer *writer = open_writer(p, "runs.pmtiles", false);
    for (uint64_t number = 0; number < 1 + 4 + 16; number++)
        add(writer, number, number < 10 ? 5 : number < 12 ? 6 : 5);
    finish(writer);
    camber_tiles_info *info = show(p, "runs.pmtiles");
    assert_int_equal(info->tiles, 21);
    assert_int_equal(info->entries, 3);
    assert_int_equal(info->contents, 2);
    camber_tiles_info_destroy(info);
    assert_right(p, "runs.pmtiles");
}

static void test_empty(void **state) {
    place *p = *state;
    static const char *const names[] = {"empty.pmtiles", "empty.mbtiles", "empty/"};
    for (size_t i = 0; i < 3; i++) {
        finish(open_writer(p, names[i], false));
        assert_right(p, names[i]);
        camber_tiles_info *info = show(p, names[i]);
        assert_int_equal(info->tiles, 0);
        camber_tiles_info_destroy(info);
    }
}

/* Entries that no root holds: there are leaves, and every tile is found through them. */
static void test_leaves(void **state) {
    place *p = *state;
    enum { COUNT = 40000 };
    camber_archive_writer *writer = open_writer(p, "leaves.pmtiles", false);
    for (uint64_t number = 0; number < COUNT; number++)
        add(writer, number, number * number % 1000003);
    finish(writer);
    assert_right(p, "leaves.pmtiles");
    char path[128];
    snprintf(path, sizeof path, "%s/leaves.pmtiles", p->folder);
    camber_tile_set *set = NULL;
    assert_int_equal(camber_tile_set_open_any(p->context, path, CAMBER_NAMED_BY_CALLER, &set), CAMBER_OK);
    const camber_pmtiles_header header = camber_pmtiles_get_file(set).header;
    assert_true(header.leaves.size > 0);
    assert_true(header.root.offset + header.root.size <= 16384);
    camber_bytes bytes = {.context = p->context};
    for (uint64_t number = 0; number < COUNT; number += 97) {
        unsigned char wanted[MADE_TILE_BYTES];
        const char *why;
        const int zoom = camber_archive_zoom(number);
        camber_tile_index tile;
        camber_pmtiles_locate(number - camber_archive_first(zoom), zoom, &tile.column, &tile.row);
        assert_int_equal(camber_tile_set_get(set, zoom, tile, &bytes, &why), CAMBER_OK);
        assert_int_equal(bytes.size_bytes, make_tile(number * number % 1000003, wanted));
        assert_memory_equal(bytes.data, wanted, bytes.size_bytes);
    }
    camber_bytes_free(&bytes);
    camber_tile_set_close(set);
}

/* Tiles of an archive are replaced, added and removed: as if it had been drawn so. */
static void test_renew(void **state) {
    place *p = *state;
    static const char *const endings[] = {"pmtiles", "mbtiles", "d"};
    for (size_t i = 0; i < 3; i++) {
        char old[32], name[32], path[128];
        snprintf(old, sizeof old, "old.%s%s", endings[i], i == 2 ? "/" : "");
        snprintf(name, sizeof name, "new.%s%s", endings[i], i == 2 ? "/" : "");
        snprintf(path, sizeof path, "%s/%s", p->folder, old);
        camber_archive_writer *writer = open_writer(p, old, false);
        for (uint64_t number = 0; number < 85; number++)
            add(writer, number, number < 21 ? 3 : number);
        finish(writer);
        camber_archive *archive = NULL;
        assert_int_equal(camber_archive_open(p->context, path, &archive), CAMBER_OK);
        writer = open_writer(p, old, false);
        assert_int_equal(camber_archive_writer_take(writer, archive), CAMBER_OK);
        add(writer, 7, 1234);
        add(writer, 85, 4321);
        assert_int_equal(camber_archive_writer_remove(writer, 2, (camber_tile_index){0, 0}), CAMBER_OK);
        finish(writer);
        camber_archive_close(archive);
        writer = open_writer(p, name, false);
        for (uint64_t number = 0; number < 86; number++)
            if (number != 5)
                add(writer, number, number == 7 ? 1234 : number == 85 ? 4321 : number < 21 ? 3 : number);
        finish(writer);
        assert_right(p, old);
        if (i < 2)
            assert_same(p, old, name);
    }
}

/* GDAL opens MBTiles as a picture, and each pixel is that of the tile. */
static void test_gdal(void **state) {
    place *p = *state;
    enum { ZOOM = 5, SIDE = MADE_TILE_SIDE << ZOOM };
    char path[128];
    camber_archive_writer *writer = open_writer(p, "pixels.mbtiles", false);
    for (uint64_t number = camber_archive_first(ZOOM); number < camber_archive_first(ZOOM + 1); number++)
        add(writer, number, made_tile_value(number));
    finish(writer);
    snprintf(path, sizeof path, "%s/pixels.mbtiles", p->folder);
    GDALAllRegister();
    GDALDatasetH data = GDALOpenEx(path, GDAL_OF_RASTER | GDAL_OF_READONLY, NULL, NULL, NULL);
    assert_non_null(data);
    assert_int_equal(GDALGetRasterXSize(data), SIDE);
    assert_int_equal(GDALGetRasterYSize(data), SIDE);
    unsigned char *pixels = malloc((size_t)SIDE * SIDE);
    assert_non_null(pixels);
    assert_int_equal(
        GDALRasterIO(GDALGetRasterBand(data, 1), GF_Read, 0, 0, SIDE, SIDE, pixels, SIDE, SIDE, GDT_Byte, 0, 0),
        CE_None);
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            const uint64_t value = made_tile_value(camber_pmtiles_number(ZOOM, x / MADE_TILE_SIDE, y / MADE_TILE_SIDE));
            const unsigned bit = y % MADE_TILE_SIDE * MADE_TILE_SIDE + x % MADE_TILE_SIDE;
            assert_int_equal(pixels[(size_t)y * SIDE + x], value >> bit & 1 ? 255 : 16);
        }
    free(pixels);
    GDALClose(data);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_single, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_order, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_meshes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_flipped_meshes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_tilesets, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_runs, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_empty, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_leaves, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_renew, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_gdal, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
