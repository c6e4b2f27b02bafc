/* PBF files as osmium reads them: in whatever packing, order and shape they have the same features. */
#include "file_reading.h"

#include "features/rings.h"
#include "osm/osm.h"

#include "pbf_file.h"

#include <math.h>

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
    it->on.style.schema.wants_areas = it->on.style.schema.wants_polygons = true;
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
    assert_true(camber_reader_takes(&camber_osm_reader, &desc));
    return camber_osm_reader.read(it->on.features, &desc, declined);
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
        snprintf(words, sizeof words, "compressed with %s, and this camber was built without", all[i / 4].name);
        expect_refused(it, words);
        assert_non_null(strstr(it->on.error, "pbf_compression=zlib"));
        print_message("built without %s\n", all[i / 4].name);
    }
    make_road(it, (pbf_packing){PBF_BZIP2, 0}, false);
    expect_refused(it, "compressed with bzip2");
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
            if (!camber_reader_takes(&camber_osm_reader, &(camber_source_desc){.path = it->on.path}))
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
            expect_refused(it, told ? "far more than its size" : "cannot be decompressed");
        }
    }
}

/* ---- Orders, and places on ways ---- */

enum { SIDE = 12, CITY_NODES = SIDE * SIDE };

typedef enum city_places {
    ON_NODES = 0,
    ON_WAYS, /* and on a few nodes */
    ON_BOTH,
    ON_EITHER, /* nodes of every second column have their places; ways have those of the others */
} city_places;

/* The way in which a file of the city is made. */
typedef struct city_form {
    const char *order; /* N, W, R: a block of nodes, ways, relations, which a small letter goes on with */
    unsigned packing;
    bool tells_no_size;
    city_places places;
    bool singly;     /* nodes one by one */
    bool has_others; /* blobs of another type between */
} city_form;

static int64_t city_id(int x, int y) {
    return 1000 + 7 * (y * SIDE + x);
}

static pbf_node city_node(int64_t id) {
    const int64_t n = (id - 1000) / 7;
    return (pbf_node){id, 76500000 + 10000 * (n % SIDE) + 100 * (n / SIDE), 437300000 + 9000 * (n / SIDE)};
}

static bool has_own_place(const city_form *form, int64_t id) {
    const int64_t n = (id - 1000) / 7;
    return form->places == ON_NODES || form->places == ON_BOTH || (form->places == ON_EITHER && n % SIDE % 2 == 0) ||
           n % 17 == 0;
}

static void city_nodes(fixture *it, const city_form *form, int first, int end) {
    pbf_node nodes[CITY_NODES];
    size_t count = 0;
    for (int i = first; i < end; i++) {
        const int64_t id = city_id(i % SIDE, i / SIDE);
        if (has_own_place(form, id) && form->singly)
            pbf_single(&it->block, city_node(id), NULL);
        else if (has_own_place(form, id))
            nodes[count++] = city_node(id);
    }
    if (count)
        pbf_dense(&it->block, nodes, count);
}

static void city_way(fixture *it, const city_form *form, int64_t id, const char *const *tags, size_t count,
                     const int64_t *ids) {
    pbf_node places[SIDE];
    for (size_t i = 0; i < count; i++) {
        places[i] = city_node(ids[i]);
        if (form->places == ON_EITHER && has_own_place(form, ids[i]))
            places[i] = (pbf_node){ids[i], INT32_MAX, INT32_MAX}; /* osmium's for a node that it did not find */
    }
    pbf_placed_way(&it->block, id, tags, ids, count, form->places == ON_NODES ? NULL : places);
}

/* A share of the ways: streets along columns and rows, houses; and, in the last, the two halves of a wood with a
 * clearing. */
static void city_ways(fixture *it, const city_form *form, int first, int end) {
    static const char *const street[] = {"highway", "residential", "name", "A", NULL}, *const house[] = {"building",
                                                                                                         "yes", NULL};
    for (int i = first; i < end; i++) {
        int64_t column[SIDE], row[SIDE];
        for (int k = 0; k < SIDE; k++) {
            column[k] = city_id(i, k);
            row[k] = city_id(k, i);
        }
        const int64_t corners[] = {city_id(i / 2, 3), city_id(i / 2 + 1, 3), city_id(i / 2 + 1, 4), city_id(i / 2, 4),
                                   city_id(i / 2, 3)};
        city_way(it, form, 100 + i, primary, SIDE, column);
        city_way(it, form, 200 + i, street, SIDE, row);
        if (i % 2)
            city_way(it, form, 300 + i, house, 5, corners);
    }
    if (end < SIDE)
        return;
    city_way(it, form, 400, NULL, 3, (const int64_t[]){city_id(1, 1), city_id(1, 9), city_id(5, 9)});
    city_way(it, form, 410, NULL, 3, (const int64_t[]){city_id(5, 9), city_id(5, 1), city_id(1, 1)});
    city_way(it, form, 420, NULL, 4, (const int64_t[]){city_id(2, 2), city_id(3, 2), city_id(3, 7), city_id(2, 2)});
}

static void city_relations(fixture *it) {
    static const char *const wood[] = {"type", "multipolygon", "landuse", "forest", NULL}, *const route[] = {
                                                                                               "type", "route", "name",
                                                                                               "B", NULL};
    pbf_relation(&it->block, route, (const pbf_member[]){{100, ""}, {201, ""}}, 2);
    pbf_relation(&it->block, wood, (const pbf_member[]){{400, "outer"}, {410, "outer"}, {420, "inner"}}, 3);
}

static int count_letter(const char *text, int letter) {
    int count = 0;
    for (; *text; text++)
        count += (*text | 32) == letter;
    return count;
}

static void make_city(fixture *it, const city_form *form) {
    const pbf_packing packing = {form->packing, form->tells_no_size};
    const int node_blocks = count_letter(form->order, 'n'), way_blocks = count_letter(form->order, 'w');
    int nodes = 0, ways = 0;
    pbf_header_as(&it->file, "DenseNodes", NULL, packing);
    for (const char *c = form->order; *c; c++) {
        if ((*c | 32) == 'n') {
            city_nodes(it, form, CITY_NODES * nodes / node_blocks, CITY_NODES * (nodes + 1) / node_blocks);
            nodes++;
        } else if ((*c | 32) == 'w') {
            city_ways(it, form, SIDE * ways / way_blocks, SIDE * (ways + 1) / way_blocks);
            ways++;
        } else {
            city_relations(it);
        }
        if (c[1] >= 'a')
            continue;
        pbf_end_block_as(&it->file, &it->block, packing);
        if (form->has_others)
            pbf_content_as(&it->file, "OtherData", &(pbf_bytes){.bytes = "others", .size = 6}, packing);
    }
    write_file(&it->on, "city.osm.pbf", it->file.bytes, it->file.size);
}

static void read_plain_city(fixture *it, camber_features **plain) {
    bool declined;
    make_city(it, &(city_form){"NWR", PBF_ZLIB});
    assert_int_equal(camber_features_create(it->on.context, &it->on.style, plain), CAMBER_OK);
    expect_ok(&it->on, camber_osm_reader.read(*plain, &(camber_source_desc){.path = it->on.path}, &declined));
    assert_false(declined);
    assert_int_equal((*plain)->feature_count, 2 * SIDE + SIDE / 2 * 2 + 1);
}

/* The same city in each form. */
static void test_forms(void **state) {
    static const city_form forms[] = {
        {"NWR", PBF_RAW},
        {"Nwr", PBF_ZLIB},
        {"NNWWR", PBF_ZLIB, true},
        {"NWR", PBF_LZ4},
        {"NWR", PBF_LZ4, true, .singly = true},
        {"NWR", PBF_ZSTD, true, .has_others = true},
        {"NWR", PBF_LZMA},
        {"WRN", PBF_ZLIB}, /* Overpass's */
        {"WNR", PBF_ZLIB},
        {"RWN", PBF_ZLIB},
        {"RNW", PBF_ZLIB},
        {"NRW", PBF_ZLIB},
        {"Wrn", PBF_ZLIB},
        {"Rnw", PBF_ZLIB},
        {"RNw", PBF_ZLIB},
        {"Wnrnw", PBF_LZ4},
        {"NWNRW", PBF_ZLIB}, /* osmium cat of two files */
        {"RNNWWN", PBF_ZLIB, .has_others = true},
        {"NWR", PBF_ZLIB, .places = ON_WAYS}, /* osmium add-locations-to-ways */
        {"NWWR", PBF_ZLIB, .places = ON_BOTH},
        {"NNWWR", PBF_ZSTD, .places = ON_EITHER},
        {"WWR", PBF_ZLIB, .places = ON_WAYS},
        {"RWNW", PBF_LZ4, .places = ON_WAYS, .singly = true},
        {"NRWNW", PBF_ZLIB, .places = ON_EITHER},
    };
    static const uint32_t threads[] = {1, 2, 5};
    fixture *it = *state;
    uint8_t bytes[100];
    camber_features *plain;
    read_plain_city(it, &plain);
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        if (forms[i].packing != PBF_RAW && !pbf_pack(forms[i].packing, bytes, 1, bytes + 1, 99))
            continue;
        make_city(it, &forms[i]);
        for (size_t k = 0; k < sizeof threads / sizeof *threads; k++) {
            bool declined;
            expect_ok(&it->on, read_written(it, threads[k], &declined));
            if (declined || it->on.features->point_count != plain->point_count)
                fail_msg("%s, packing %u, places %d: %zu points, not %zu", forms[i].order, forms[i].packing,
                         (int)forms[i].places, it->on.features->point_count, plain->point_count);
            expect_same(it->on.features, plain);
        }
    }
    camber_features_destroy(plain);
}

/* Nodes and ways that a file names without having them are left out and counted; one without any node is refused. */
static void test_missing(void **state) {
    static const char *const wood[] = {"type", "multipolygon", "landuse", "forest", NULL};
    fixture *it = *state;
    bool declined;
    for (int some = 0; some < 2; some++) {
        pbf_header(&it->file, "DenseNodes");
        if (some)
            pbf_dense(&it->block, (const pbf_node[]){{1, 10, 20}, {2, 100010, 20}, {3, 100010, 100020}}, 3);
        pbf_way(&it->block, 1, primary, (const int64_t[]){7, 1, 2, 3, 8}, 5);
        pbf_way(&it->block, 2, primary, (const int64_t[]){8, 9}, 2);
        pbf_way(&it->block, 3, NULL, (const int64_t[]){1, 2, 3, 1}, 4);
        pbf_relation(&it->block, wood, (const pbf_member[]){{3, "outer"}, {4, "outer"}}, 2);
        pbf_relation(&it->block, wood, (const pbf_member[]){{5, "outer"}}, 1);
        pbf_end_block(&it->file, &it->block);
        if (!some) {
            expect_refused(it, "none of the 6 nodes to which its ways refer");
            continue;
        }
        write_road(it);
        expect_ok(&it->on, read_written(it, 2, &declined));
        const camber_features_stats stats = camber_features_get_stats(it->on.features);
        assert_int_equal(stats.missing_nodes, 3);
        assert_int_equal(stats.missing_ways, 2);
        assert_int_equal(stats.open_relations, 2);
        assert_int_equal(stats.dropped_relations, 1);
        assert_int_equal(stats.features, 2);
    }
}

/* GDAL reads other layers, and filters that this reader does not know: of a file that it knows. */
static void test_left_to_gdal(void **state) {
    static const struct {
        city_form form;
        const char *words; /* NULL: it is read */
    } all[] = {
        {{"NWR", PBF_ZLIB}, NULL},
        {{"NWR", PBF_RAW}, NULL},
        {{"NWR", PBF_LZ4}, "compression with lz4; compress it again with osmium cat"},
        {{"NWR", PBF_ZLIB, true}, "blobs without their size"},
        {{"NNWWR", PBF_ZLIB, .places = ON_WAYS}, "places on ways"},
        {{"WRN", PBF_ZLIB}, "osmium sort"},
        {{"Wnr", PBF_ZLIB}, "osmium sort"},
    };
    static const char *const wheres[] = {"highway LIKE 'prim%'", "highway = 'path'"};
    fixture *it = *state;
    uint8_t bytes[100];
    for (size_t i = 0; i < 3 * (sizeof all / sizeof *all); i++) {
        const char *words = all[i / 3].words;
        if (all[i / 3].form.packing != PBF_RAW && !pbf_pack(all[i / 3].form.packing, bytes, 1, bytes + 1, 99))
            continue;
        make_city(it, &all[i / 3].form);
        start_again(&it->on);
        const camber_source_desc desc = {.path = it->on.path,
                                         .layer = i % 3 == 0 ? "multipolygons" : NULL,
                                         .where = i % 3 ? wheres[i % 3 - 1] : NULL};
        const camber_status status = camber_features_read(it->on.features, &desc);
        if (!words || i % 3 == 2) {
            expect_ok(&it->on, status);
            assert_int_equal(it->on.warnings, i % 3 == 2); /* nothing passes, whoever reads it */
            assert_int_equal(it->on.features->feature_count > 0, i % 3 != 2);
            continue;
        }
        assert_int_equal(status, CAMBER_ERROR_INPUT);
        if (!strstr(it->on.error, words))
            fail_msg("\"%s\" is not in \"%s\"", words, it->on.error);
    }
}

/* ---- Multipolygons ---- */

/* In squares of a hundredth of a degree, about. */
static double sum_areas(const camber_features *set, size_t *rings) {
    double sum = 0.0;
    *rings = 0;
    for (size_t p = 0; p < set->polyline_count; p++) {
        if (camber_features_kind(set, p) != CAMBER_GEOMETRY_AREA)
            continue;
        sum += camber_ring_area(set->points + 2 * set->offsets[p], set->offsets[p + 1] - set->offsets[p]);
        ++*rings;
    }
    return 0.5 * fabs(sum) * 36000.0 * 36000.0;
}

/* Ways of a multipolygon, by their corners in hundredths of a degree; areas have the corners' numbers as ids. */
static void add_way(fixture *it, int64_t id, size_t count, const int *corners) {
    int64_t ids[32];
    for (size_t i = 0; i < count; i++)
        ids[i] = 1 + corners[2 * i] * 100 + corners[2 * i + 1];
    pbf_way(&it->block, id, NULL, ids, count);
}
#define WAY(it, id, ...) add_way(it, id, sizeof(int[]){__VA_ARGS__} / sizeof(int) / 2, (const int[]){__VA_ARGS__})

static void begin_grid(fixture *it) {
    pbf_node nodes[100];
    for (int i = 0; i < 100; i++)
        nodes[i] = (pbf_node){1 + i / 10 * 100 + i % 10, i / 10 * 100000, i % 10 * 100000};
    pbf_header(&it->file, "DenseNodes");
    pbf_dense(&it->block, nodes, 100);
}

static void expect_area(fixture *it, double area, size_t rings) {
    bool declined;
    size_t count;
    pbf_end_block(&it->file, &it->block);
    write_road(it);
    expect_ok(&it->on, read_written(it, 2, &declined));
    const double sum = sum_areas(it->on.features, &count);
    if (fabs(sum - area) > 0.01 || count != rings)
        fail_msg("%zu rings of %.3f, not %zu of %.3f", count, sum, rings, area);
}

/* As libosmium assembles them: by geometry. */
static void test_touching_rings(void **state) {
    static const char *const wood[] = {"type", "multipolygon", "landuse", "forest", NULL};
    fixture *it = *state;
    /* osm-testdata's 766: a hole in two parts, whose way goes from one to the other and back. */
    begin_grid(it);
    WAY(it, 1, 6, 5, 4, 7, 2, 5, 4, 3, 4, 2, 7, 2, 7, 1, 1, 1, 1, 2, 4, 2, 4, 3, 6, 5);
    WAY(it, 2, 0, 0, 0, 8, 8, 8, 8, 0, 0, 0);
    pbf_relation(&it->block, wood, (const pbf_member[]){{1, "inner"}, {2, "outer"}}, 2);
    expect_area(it, 64.0 - 8.0 - 6.0, 3);
    /* Two holes that touch, each way going straight on where they do. */
    begin_grid(it);
    WAY(it, 1, 0, 0, 6, 0, 6, 6, 0, 6, 0, 0);
    WAY(it, 2, 2, 2, 2, 3, 3, 3, 4, 3, 4, 4);
    WAY(it, 3, 4, 4, 3, 4, 3, 3, 3, 2, 2, 2);
    pbf_relation(&it->block, wood, (const pbf_member[]){{1, "outer"}, {2, "inner"}, {3, "inner"}}, 3);
    expect_area(it, 36.0 - 2.0, 3);
    /* A hole that is called outer, and an island in it that is called inner. */
    begin_grid(it);
    WAY(it, 1, 0, 0, 6, 0, 6, 6, 0, 6, 0, 0);
    WAY(it, 2, 1, 1, 5, 1, 5, 5, 1, 5, 1, 1);
    WAY(it, 3, 2, 2, 3, 2, 3, 3, 2, 3, 2, 2);
    pbf_relation(&it->block, wood, (const pbf_member[]){{1, "inner"}, {2, "outer"}, {3, "inner"}}, 3);
    expect_area(it, 36.0 - 16.0 + 1.0, 3);
    /* Outer rings that have a side in common are one. */
    begin_grid(it);
    WAY(it, 1, 0, 0, 2, 0, 2, 2, 0, 2, 0, 0);
    WAY(it, 2, 2, 0, 4, 0, 4, 2, 2, 2, 2, 0);
    pbf_relation(&it->block, wood, (const pbf_member[]){{1, "outer"}, {2, "outer"}}, 2);
    expect_area(it, 8.0, 1);
}

/* Relations that name the same long way again and again would take all memory, and minutes. */
static void test_many_uses(void **state) {
    static const char *const wood[] = {"type", "multipolygon", "landuse", "forest", NULL};
    enum { NODES = 4000, USES = 600 };
    static pbf_node nodes[NODES];
    static int64_t ids[NODES + 1];
    fixture *it = *state;
    bool declined;
    for (int i = 0; i < NODES; i++) {
        ids[i] = i + 1;
        nodes[i] = (pbf_node){ids[i], i < NODES / 2 ? 1000 * i : 1000 * (NODES - i), i < NODES / 2 ? 0 : 1000};
    }
    ids[NODES] = 1;
    for (int uses = USES / 20; uses <= USES; uses += USES - USES / 20) {
        pbf_header(&it->file, "DenseNodes");
        pbf_dense(&it->block, nodes, NODES);
        pbf_way(&it->block, 1, NULL, ids, NODES + 1);
        pbf_end_block(&it->file, &it->block);
        for (int i = 0; i < uses; i++)
            pbf_relation(&it->block, wood, (const pbf_member[]){{1, "outer"}}, 1);
        pbf_end_block(&it->file, &it->block);
        write_road(it);
        const camber_status status = read_written(it, 2, &declined);
        assert_int_equal(status, uses < USES ? CAMBER_OK : CAMBER_ERROR_LIMIT);
        assert_int_equal(it->on.errors, uses == USES);
    }
}

/* GDAL reads XML from front to back, and leaves ways out without a word if it meets a relation before their nodes. */
static void test_xml_order(void **state) {
    static const char *const elements[] = {
        ['n'] = "<node id='1' lat='35.9' lon='14.5'/><node id='2' lat='35.91' lon='14.5'/>\n",
        ['w'] = "<way id='1'><nd ref='1'/><nd ref='2'/><tag k='highway' v='primary'/></way>\n",
        ['r'] = "<relation id='1'><member type='way' ref='1' role=''/><tag k='type' v='route'/></relation>\n",
        ['c'] = "<!-- <relation id='1'> -->\n"};
    static const struct {
        const char *order;
        camber_status status;
        size_t warnings;
    } all[] = {{"nwr", CAMBER_OK, 0}, {"cnwr", CAMBER_OK, 0}, {"wrn", CAMBER_ERROR_INPUT, 0}, {"wn", CAMBER_OK, 1}};
    fixture *it = *state;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        char text[1000] = "<?xml version='1.0'?>\n<osm version='0.6'>\n";
        for (const char *c = all[i].order; *c; c++)
            strcat(text, elements[(unsigned char)*c]);
        strcat(text, "</osm>\n");
        write_file(&it->on, "road.osm", text, strlen(text));
        start_again(&it->on);
        assert_int_equal(read_path(&it->on, it->on.path), all[i].status);
        assert_int_equal(it->on.features->feature_count, all[i].status == CAMBER_OK);
        assert_int_equal(it->on.warnings, all[i].warnings);
        if (all[i].status != CAMBER_OK)
            assert_non_null(strstr(it->on.error, "osmium sort"));
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
        cmocka_unit_test_setup_teardown(test_forms, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_missing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_left_to_gdal, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_touching_rings, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_many_uses, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_xml_order, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_history, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
