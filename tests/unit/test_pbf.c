/* PBF files as osmium reads them: in whatever packing, order and shape they have the same features. */
#include "file_reading.h"

#include "osm/osm.h"

#include "pbf_file.h"

static char *properties[] = {"highway", "building", "landuse", "name"};

typedef struct fixture {
    file_reading on;
    pbf_file file;
    pbf_block block;
} fixture;

static int set_up(void **state) {
    fixture *it = calloc(1, sizeof *it);
    assert_non_null(it);
    reading_start(&it->on, properties, sizeof properties / sizeof *properties);
    it->on.style.wants_areas = it->on.style.wants_polygons = true;
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    fixture *it = *state;
    reading_end(&it->on);
    free(it);
    return 0;
}

/* Reads the file that was written last. *declined: it is left to GDAL. */
static camber_status read_written(fixture *it, uint32_t threads, bool *declined) {
    start_again(&it->on);
    const camber_source_desc desc = {.path = it->on.path, .threads = threads};
    assert_true(camber_osm_reads(&desc));
    return camber_osm_read(it->on.features, &desc, declined);
}

static void write_road(fixture *it) {
    write_file(&it->on, "road.osm.pbf", it->file.bytes, it->file.size);
}

static void expect_refused(fixture *it, const char *words) {
    bool declined;
    write_road(it);
    assert_int_equal(read_written(it, 2, &declined), CAMBER_ERROR_INPUT);
    assert_int_equal(it->on.errors, 1);
    if (!strstr(it->on.error, words))
        fail_msg("\"%s\" is not in \"%s\"", words, it->on.error);
}

/* ---- Packings ---- */

static const char *const primary[] = {"highway", "primary", NULL};

/* A road of eight points. */
static void make_road(fixture *it, pbf_packing packing, bool has_index) {
    pbf_node nodes[8];
    int64_t ids[8];
    for (int i = 0; i < 8; i++) {
        ids[i] = i + 1;
        nodes[i] = (pbf_node){ids[i], 100000000 + 10000 * i, 500000000 + 10000 * (i % 2)};
    }
    pbf_header_as(&it->file, "DenseNodes", NULL, packing);
    pbf_dense(&it->block, nodes, 8);
    pbf_end_block_as(&it->file, &it->block, packing);
    if (has_index)
        pbf_content_as(&it->file, "IndexData", &(pbf_bytes){.bytes = "some index", .size = 10}, packing);
    pbf_way(&it->block, 1, primary, ids, 8);
    pbf_end_block_as(&it->file, &it->block, packing);
}

static void expect_road(fixture *it) {
    bool declined;
    write_road(it);
    expect_ok(&it->on, read_written(it, 2, &declined));
    assert_false(declined);
    assert_int_equal(it->on.features->feature_count, 1);
    assert_int_equal(it->on.features->point_count, 8);
}

/* Each packing, with and without the size that the blobs have unpacked, and with a blob of another type between. */
static void test_packings(void **state) {
    static const struct {
        unsigned field;
        const char *name;
    } all[] = {{PBF_RAW, "raw"}, {PBF_ZLIB, "zlib"}, {PBF_LZ4, "lz4"}, {PBF_ZSTD, "zstd"}, {PBF_LZMA, "lzma"}};
    fixture *it = *state;
    uint8_t bytes[100];
    for (size_t i = 0; i < 4 * (sizeof all / sizeof *all); i++) {
        const pbf_packing packing = {all[i / 4].field, i % 2};
        make_road(it, packing, i / 2 % 2);
        if (packing.field == PBF_RAW || pbf_pack(packing.field, bytes, 1, bytes + 1, 99)) {
            expect_road(it);
            continue;
        }
        char words[64];
        snprintf(words, sizeof words, "packed by %s, and this camber was built without", all[i / 4].name);
        expect_refused(it, words);
        assert_non_null(strstr(it->on.error, "pbf_compression=zlib"));
        print_message("built without %s\n", all[i / 4].name);
    }
    make_road(it, (pbf_packing){PBF_BZIP2, 0}, false);
    expect_refused(it, "packed by bzip2");
}

/* Damaged bytes of each packing, with the size told or not. */
static void test_damaged_packings(void **state) {
    static const unsigned fields[] = {PBF_ZLIB, PBF_LZ4, PBF_ZSTD, PBF_LZMA};
    fixture *it = *state;
    size_t refused = 0;
    for (size_t i = 0; i < 2 * (sizeof fields / sizeof *fields); i++) {
        make_road(it, (pbf_packing){fields[i / 2], i % 2}, false);
        for (size_t bit = 0; bit < 8 * it->file.size; bit += 3) {
            bool declined;
            it->file.bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
            write_road(it);
            it->file.bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
            if (!camber_osm_reads(&(camber_source_desc){.path = it->on.path}))
                continue;
            const camber_status status = read_written(it, 1, &declined);
            assert_true(status == CAMBER_OK || status == CAMBER_ERROR_INPUT);
            assert_int_equal(it->on.errors, status != CAMBER_OK);
            refused += status != CAMBER_OK;
        }
    }
    assert_true(refused > 200);
}

/* A blob may be packed as well as DEFLATE can, and a small one better. What would be far larger is refused. */
static void test_well_packed(void **state) {
    enum { NODES = 2000, WAYS = 6 };
    static pbf_node nodes[NODES];
    static int64_t ids[NODES];
    static uint8_t zeros[8 << 20], packed[1 << 16];
    static const unsigned fields[] = {PBF_ZSTD, PBF_LZMA};
    fixture *it = *state;
    bool declined;
    for (int i = 0; i < NODES; i++) {
        ids[i] = i + 1;
        nodes[i] = (pbf_node){ids[i], 10000000 + 100 * i, 20000000};
    }
    pbf_header(&it->file, "DenseNodes");
    pbf_dense(&it->block, nodes, NODES);
    pbf_end_block(&it->file, &it->block);
    for (int i = 0; i < WAYS; i++)
        pbf_way(&it->block, i, primary, ids, NODES);
    pbf_end_block(&it->file, &it->block);
    write_road(it);
    expect_ok(&it->on, read_written(it, 2, &declined));
    assert_int_equal(it->on.features->feature_count, WAYS);
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        const size_t size = pbf_pack(fields[i], zeros, sizeof zeros, packed, sizeof packed);
        for (int told = 0; told < 2 && size; told++) {
            pbf_bytes blob = {.size = 0};
            make_road(it, (pbf_packing){PBF_ZLIB, 0}, false);
            if (told)
                pbf_number(&blob, 2, sizeof zeros);
            pbf_field(&blob, fields[i], packed, size);
            pbf_blob(&it->file, "OSMData", &blob);
            expect_refused(it, told ? "far more than it is" : "does not unpack");
        }
    }
}

static void test_history(void **state) {
    fixture *it = *state;
    pbf_header(&it->file, "HistoricalInformation");
    pbf_dense(&it->block, &(pbf_node){1, 2, 3}, 1);
    pbf_end_block(&it->file, &it->block);
    expect_refused(it, "osmium time-filter");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_packings, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_damaged_packings, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_well_packed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_history, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
