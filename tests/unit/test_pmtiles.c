/* PMTiles: numbers along the curve, directories, archives written here and archives that lie. */
#include "archive/pmtiles.h"
#include "archive/tile_set.h"
#include "tilemaker.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <unistd.h>

#include <cmocka.h>

typedef struct fixture {
    camber_context *context;
    size_t errors;
    char error[512];
    char path[64];
    camber_bytes bytes;
} fixture;

static void take_log(void *user, camber_log_level level, const char *message) {
    fixture *it = user;
    if (level != CAMBER_LOG_ERROR)
        return;
    it->errors++;
    snprintf(it->error, sizeof it->error, "%s", message);
}

static int set_up(void **state) {
    fixture *it = calloc(1, sizeof *it);
    assert_non_null(it);
    const camber_context_desc desc = {.log = take_log, .log_user = it};
    assert_int_equal(camber_context_create(&desc, &it->context), CAMBER_OK);
    snprintf(it->path, sizeof it->path, "/tmp/camber-test-%ld.pmtiles", (long)getpid());
    it->bytes.context = it->context;
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    fixture *it = *state;
    unlink(it->path);
    camber_bytes_free(&it->bytes);
    camber_context_destroy(it->context);
    free(it);
    return 0;
}

/* ---- Numbers ---- */

/* The specification's own examples, and that the curve goes from each tile to a neighbour. */
static void test_numbers(void **state) {
    (void)state;
    assert_int_equal(camber_pmtiles_number(0, 0, 0), 0);
    assert_int_equal(camber_pmtiles_number(1, 0, 0), 1);
    assert_int_equal(camber_pmtiles_number(1, 0, 1), 2);
    assert_int_equal(camber_pmtiles_number(1, 1, 1), 3);
    assert_int_equal(camber_pmtiles_number(1, 1, 0), 4);
    assert_int_equal(camber_pmtiles_number(2, 0, 0), 5);
    assert_int_equal(camber_pmtiles_number(12, 3423, 1763), 19078479);
    uint32_t before[2] = {0, 0};
    for (uint64_t i = 0; i < 4096; i++) {
        uint32_t column, row;
        camber_pmtiles_locate(i, 6, &column, &row);
        assert_int_equal(camber_pmtiles_number(6, column, row), 1365 + i);
        if (i)
            assert_int_equal(abs((int)column - (int)before[0]) + abs((int)row - (int)before[1]), 1);
        before[0] = column;
        before[1] = row;
    }
    const uint32_t last = (UINT32_C(1) << 31) - 1;
    uint32_t column, row;
    const uint64_t first = camber_pmtiles_number(31, 0, 0);
    camber_pmtiles_locate(camber_pmtiles_number(31, last, 12345) - first, 31, &column, &row);
    assert_int_equal(column, last);
    assert_int_equal(row, 12345);
}

/* ---- Archives ---- */

static camber_status open_archive(fixture *it, const made_archive *a, camber_tile_set **set) {
    blob b = archive_of(a);
    assert_true(blob_write(&b, it->path));
    blob_free(&b);
    it->errors = 0;
    return camber_tile_set_open(it->context, it->path, CAMBER_NAMED_BY_CALLER, set);
}

static void free_archive(made_archive *a) {
    blob_free(&a->root);
    blob_free(&a->metadata);
    blob_free(&a->leaves);
    blob_free(&a->tiles);
}

/* The text of a tile; "" for none. */
static const char *text_of(fixture *it, camber_tile_set *set, int zoom, uint32_t column, uint32_t row) {
    const char *why;
    assert_int_equal(camber_tile_set_get(set, zoom, (camber_tile_index){column, row}, &it->bytes, &why), CAMBER_OK);
    if (why)
        return why;
    assert_true(camber_bytes_resize(&it->bytes, it->bytes.size_bytes + 1));
    it->bytes.data[it->bytes.size_bytes - 1] = 0;
    return (const char *)it->bytes.data;
}

static void pack(blob *b) {
    const blob made = gzip_of(b);
    free(b->bytes);
    *b = made;
}

/* A root with a tile, a run of three with one content, and a leaf with two tiles; with and without gzip. */
static made_archive make_archive(bool packed) {
    static const char *const texts[] = {"@zero", "@run", "@five", "@leaf last"};
    made_archive a = {.directory_compression = packed ? 2 : 1,
                      .tile_compression = packed ? 2 : 1,
                      .type = 1,
                      .max_zoom = 2,
                      .bounds = {-100000000, -200000000, 300000000, 400000000}};
    uint64_t offsets[4], sizes[4];
    for (int i = 0; i < 4; i++) {
        blob text = {0};
        blob_put(&text, texts[i], strlen(texts[i]));
        blob kept = packed ? gzip_of(&text) : text;
        offsets[i] = a.tiles.size;
        sizes[i] = kept.size;
        blob_put(&a.tiles, kept.bytes, kept.size);
        if (packed)
            blob_free(&text);
        blob_free(&kept);
    }
    const made_entry leaf[] = {{5, 1, offsets[2], sizes[2]}, {20, 1, offsets[3], sizes[3]}};
    a.leaves = directory_of(leaf, 2);
    static const char about[] =
        "{\"attribution\": \"(c) OpenStreetMap contributors\", \"vector_layers\": [{\"id\": \"road\"}]}";
    blob_put(&a.metadata, about, strlen(about));
    if (packed) {
        pack(&a.leaves);
        pack(&a.metadata);
    }
    const made_entry root[] = {{0, 1, offsets[0], sizes[0]}, {1, 3, offsets[1], sizes[1]}, {5, 0, 0, a.leaves.size}};
    a.root = directory_of(root, 3);
    if (packed)
        pack(&a.root);
    return a;
}

static void test_archive(void **state) {
    fixture *it = *state;
    for (int packed = 0; packed < 2; packed++) {
        made_archive a = make_archive(packed);
        camber_tile_set *set = NULL;
        assert_int_equal(open_archive(it, &a, &set), CAMBER_OK);
        assert_int_equal(set->min_zoom, 0);
        assert_int_equal(set->max_zoom, 2);
        assert_string_equal(set->attribution, "(c) OpenStreetMap contributors");
        assert_true(set->bounds[0] > -10.0001 && set->bounds[0] < -9.9999 && set->bounds[3] > 39.9999);
        assert_int_equal(json_array_size(set->layers), 1);
        assert_string_equal(text_of(it, set, 0, 0, 0), "@zero");
        assert_string_equal(text_of(it, set, 1, 0, 0), "@run");
        assert_string_equal(text_of(it, set, 1, 1, 1), "@run");
        assert_string_equal(text_of(it, set, 1, 1, 0), ""); /* number 4 */
        assert_string_equal(text_of(it, set, 2, 0, 0), "@five");
        assert_string_equal(text_of(it, set, 2, 3, 0), "@leaf last");
        assert_string_equal(text_of(it, set, 2, 1, 1), "");
        camber_tile_index *places;
        size_t count;
        assert_int_equal(camber_tile_set_list(set, 1, &places, &count), CAMBER_OK);
        assert_int_equal(count, 3);
        camber_free(it->context, places);
        assert_int_equal(camber_tile_set_list(set, 2, &places, &count), CAMBER_OK);
        assert_int_equal(count, 2);
        assert_int_equal(places[1].column, 3);
        assert_int_equal(places[1].row, 0);
        camber_free(it->context, places);
        camber_tile_set_close(set);
        free_archive(&a);
    }
}

/* ---- Lies ---- */

static void expect_refused_by(fixture *it, made_archive *a, camber_status status, const char *word) {
    camber_tile_set *set = NULL;
    assert_int_equal(open_archive(it, a, &set), status);
    assert_int_equal(it->errors, 1);
    if (!strstr(it->error, word))
        fail_msg("%s: no word of %s", it->error, word);
    free_archive(a);
}

static void expect_refused(fixture *it, made_archive *a, const char *word) {
    expect_refused_by(it, a, CAMBER_ERROR_INPUT, word);
}

static void test_refused(void **state) {
    fixture *it = *state;
    made_archive a = make_archive(false);
    a.type = 2;
    expect_refused(it, &a, "pictures");
    a = make_archive(false);
    a.tile_compression = 3;
    expect_refused(it, &a, "brotli");
    a = make_archive(false);
    a.max_zoom = 200;
    expect_refused(it, &a, "zooms");
    a = make_archive(false);
    blob_free(&a.root);
    put_varint(&a.root, UINT64_C(1) << 60);
    expect_refused(it, &a, "announces");
    a = make_archive(true);
    a.root.size /= 2;
    expect_refused(it, &a, "cut off");
    a = make_archive(false);
    const made_entry same[] = {{3, 1, 0, 1}, {3, 1, 0, 1}};
    blob_free(&a.root);
    a.root = directory_of(same, 2);
    expect_refused(it, &a, "order");
    /* 20 MB of nothing. */
    a = make_archive(true);
    blob zeros = {.bytes = calloc(20 << 20, 1), .size = 20 << 20};
    blob_free(&a.root);
    a.root = gzip_of(&zeros);
    blob_free(&zeros);
    expect_refused_by(it, &a, CAMBER_ERROR_LIMIT, "32 times");
    blob text = {0};
    blob_put(&text,
             "PMTiles\2 and nothing else, but long enough for a header of one hundred and twenty-seven bytes, "
             "which this is in all, is it not?",
             127);
    assert_true(blob_write(&text, it->path));
    camber_tile_set *set = NULL;
    assert_int_equal(camber_tile_set_open(it->context, it->path, CAMBER_NAMED_BY_CALLER, &set), CAMBER_ERROR_INPUT);
    text.size = 50;
    assert_true(blob_write(&text, it->path));
    assert_int_equal(camber_tile_set_open(it->context, it->path, CAMBER_NAMED_BY_CALLER, &set), CAMBER_ERROR_INPUT);
    blob_free(&text);
    unlink(it->path);
    assert_int_equal(camber_tile_set_open(it->context, it->path, CAMBER_NAMED_BY_CALLER, &set), CAMBER_ERROR_NOT_FOUND);
}

/* A leaf that leads to itself, and a thousand entries of the root that all lead there. */
static void test_circles(void **state) {
    fixture *it = *state;
    made_archive a = make_archive(false);
    made_entry circle[1000];
    for (uint64_t i = 0; i < 1000; i++)
        circle[i] = (made_entry){i, 0, 0, 0};
    for (int round = 0; round < 3; round++) {
        blob leaf = directory_of(circle, 1000);
        for (size_t i = 0; i < 1000; i++)
            circle[i].size = leaf.size;
        blob_free(&a.leaves);
        a.leaves = leaf;
    }
    blob_free(&a.root);
    a.root = directory_of(circle, 1000);
    camber_tile_set *set = NULL;
    assert_int_equal(open_archive(it, &a, &set), CAMBER_OK);
    const char *why;
    assert_int_equal(camber_tile_set_get(set, 2, (camber_tile_index){1, 1}, &it->bytes, &why), CAMBER_ERROR_INPUT);
    assert_int_equal(it->errors, 1);
    camber_tile_index *places;
    size_t count;
    assert_int_equal(camber_tile_set_list(set, 2, &places, &count), CAMBER_ERROR_INPUT);
    assert_non_null(strstr(it->error, "cycle"));
    camber_tile_set_close(set);
    free_archive(&a);
}

/* Tiles past the end and runs beyond the zoom: that tile is damaged, or the run ends with the zoom. */
static void test_beyond(void **state) {
    fixture *it = *state;
    made_archive a = make_archive(false);
    const made_entry beyond[] = {
        {0, 1, UINT64_C(1) << 62, 5}, {1, UINT64_C(1) << 40, 0, 5}, {UINT64_C(1) << 50, UINT64_MAX, 0, UINT64_MAX}};
    blob_free(&a.root);
    a.root = directory_of(beyond, 3);
    camber_tile_set *set = NULL;
    assert_int_equal(open_archive(it, &a, &set), CAMBER_OK);
    assert_non_null(strstr(text_of(it, set, 0, 0, 0), "past the end"));
    assert_string_equal(text_of(it, set, 2, 3, 3), "@zero");
    camber_tile_index *places;
    size_t count;
    assert_int_equal(camber_tile_set_list(set, 2, &places, &count), CAMBER_OK);
    assert_int_equal(count, 16);
    camber_free(it->context, places);
    camber_tile_set_close(set);
    free_archive(&a);
}

/* Any byte of an archive another one: an error or tiles, and no crash. */
static void test_flipped(void **state) {
    fixture *it = *state;
    for (int packed = 0; packed < 2; packed++) {
        made_archive a = make_archive(packed);
        blob b = archive_of(&a);
        for (size_t i = 0; i < b.size; i++) {
            const unsigned char kept = b.bytes[i];
            b.bytes[i] ^= (unsigned char)(1u << i % 8 | 0x40);
            assert_true(blob_write(&b, it->path));
            b.bytes[i] = kept;
            camber_tile_set *set = NULL;
            it->errors = 0;
            const camber_status status = camber_tile_set_open(it->context, it->path, CAMBER_NAMED_BY_CALLER, &set);
            assert_int_equal(it->errors, status != CAMBER_OK);
            for (int zoom = 0; status == CAMBER_OK && zoom < 3; zoom++) {
                camber_tile_index *places = NULL;
                size_t count = 0;
                const char *why;
                if (camber_tile_set_list(set, zoom, &places, &count) != CAMBER_OK)
                    continue;
                for (size_t k = 0; k < count; k++)
                    (void)camber_tile_set_get(set, zoom, places[k], &it->bytes, &why);
                camber_free(it->context, places);
            }
            camber_tile_set_close(set);
        }
        blob_free(&b);
        free_archive(&a);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_numbers), TEST(test_archive), TEST(test_refused),
        TEST(test_circles), TEST(test_beyond),  TEST(test_flipped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
