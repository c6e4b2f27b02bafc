/* The reader of OpenStreetMap's PBF files against GDAL's: the same features to the last bit, for real files and for
 * small ones with whatever a file may have; and damaged files. GDAL reads the same file behind /vsisubfile/. */
#include "file_reading.h"

#include "features/mercator.h"
#include "features/rings.h"
#include "osm/osm.h"

#include "pbf_file.h"

#include <dirent.h>

static char *roads[] = {"highway", "bridge", "tunnel", "layer", "building", "name"};
static char *nothing[] = {"no key, this"};

typedef struct fixture {
    file_reading on;
    const char *where;
    pbf_file file;
    pbf_block block;
    int64_t way_count; /* no two ways have one id */
} fixture;

static void use_style(fixture *it, char **properties, size_t count) {
    reading_use_style(&it->on, properties, count);
}

static int set_up(void **state) {
    fixture *it = calloc(1, sizeof *it);
    assert_non_null(it);
    reading_start(&it->on, roads, sizeof roads / sizeof *roads);
    in_folder(&it->on, "file");
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    fixture *it = *state;
    reading_end(&it->on);
    free(it);
    return 0;
}

static camber_features *read_file(fixture *it, camber_source_desc desc, camber_status *status) {
    camber_features *features;
    assert_int_equal(camber_features_create(it->on.context, &it->on.style, &features), CAMBER_OK);
    it->on.errors = it->on.warnings = 0;
    it->on.error[0] = 0;
    *status = camber_features_read(features, &desc);
    return features;
}

/* Reads the file both ways. takes: whether this reader reads it, or leaves it to GDAL. */
static size_t expect_as_gdal(fixture *it, const char *path, bool keep_apart, bool takes) {
    static const uint32_t threads[] = {1, 2, 7};
    char behind[1200];
    camber_status status, other;
    snprintf(behind, sizeof behind, "/vsisubfile/0_%d,%s", 1 << 30, path);
    camber_features *gdals =
        read_file(it, (camber_source_desc){.path = behind, .where = it->where, .keep_apart = keep_apart}, &status);
    const size_t count = gdals->feature_count, warnings = it->on.warnings;
    for (size_t i = 0; i < sizeof threads / sizeof *threads; i++) {
        const camber_source_desc desc = {
            .path = path, .where = it->where, .keep_apart = keep_apart, .threads = threads[i]};
        camber_features *features = read_file(it, desc, &other);
        if (other != status)
            fail_msg("%s: %s is not GDAL's %s: %s", path, camber_status_get_name(other), camber_status_get_name(status),
                     it->on.error);
        assert_int_equal(it->on.errors, status != CAMBER_OK);
        assert_int_equal(it->on.warnings, warnings);
        /* GDAL's reader does not count these. */
        features->stats.missing_nodes = features->stats.missing_ways = features->stats.dropped_relations = 0;
        expect_same(features, gdals);
        camber_features_destroy(features);
        bool declined = false;
        camber_features_create(it->on.context, &it->on.style, &features);
        assert_true(camber_reader_takes(&camber_osm_reader, &desc));
        (void)camber_osm_reader.read(features, &desc, &declined);
        assert_int_equal(declined, !takes);
        camber_features_destroy(features);
    }
    camber_features_destroy(gdals);
    return count;
}

/* ---- Real files ---- */

static void test_real_files(void **state) {
    static const char *const names[] = {"porto_portugal.osm.pbf",
                                        "liechtenstein-latest.osm.pbf",
                                        "baltimore.osm.pbf",
                                        "harrisburg.osm.pbf",
                                        "moorgate.osm.pbf",
                                        "columbus.osm.pbf",
                                        "nyc.osm.pbf",
                                        "Helsinki-1327152.osm.pbf",
                                        "spo_osm.pbf"};
    fixture *it = *state;
    const char *data = getenv("CAMBER_DATA");
    if (!data) {
        print_message("CAMBER_DATA is not set: real files are not read\n");
        skip();
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/data/%s", data, names[i]);
        it->on.style.schema.wants_polygons = i % 2 == 0;
        it->on.style.schema.directed = i % 3 == 0;
        const size_t apart = expect_as_gdal(it, path, true, true);
        print_message("%s: %zu features\n", names[i], apart);
        it->on.style.schema.wants_polygons = !it->on.style.schema.wants_polygons;
        const size_t lines = expect_as_gdal(it, path, false, true);
        assert_true(lines > 500);
        it->on.style.schema.wants_points = i % 4 == 1;
        if (it->on.style.schema.wants_points)
            print_message("%s: %zu of them points\n", names[i], expect_as_gdal(it, path, false, true) - lines);
        it->on.style.schema.wants_points = false;
    }
}

/* The areas of a set: their number, that of their rings, and the sum of these in squares of the world, twice. */
typedef struct area_sum {
    size_t features, rings;
    double area;
} area_sum;

static area_sum sum_areas(const camber_features *set) {
    area_sum sum = {0};
    for (size_t p = 0; p < set->polyline_count; p++) {
        const double *first = set->points + 2 * set->offsets[p];
        if (camber_features_kind(set, p) != CAMBER_GEOMETRY_AREA)
            continue;
        sum.features += p == 0 || set->polyline_feature[p] != set->polyline_feature[p - 1];
        sum.rings++;
        sum.area += camber_ring_area(first, set->offsets[p + 1] - set->offsets[p]);
    }
    return sum;
}

/* Areas of closed ways and of relations: about as GDAL has them, which puts some more together where ways are missing,
 * and gives up others. */
static void test_real_areas(void **state) {
    static const char *const names[] = {"liechtenstein-latest.osm.pbf", "nyc.osm.pbf", "Helsinki-1327152.osm.pbf",
                                        "porto_portugal.osm.pbf"};
    fixture *it = *state;
    const char *data = getenv("CAMBER_DATA");
    if (!data) {
        print_message("CAMBER_DATA is not set: real files are not read\n");
        skip();
    }
    it->on.style.schema.wants_areas = true;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[1024], behind[1200];
        camber_status status;
        snprintf(path, sizeof path, "%s/data/%s", data, names[i]);
        snprintf(behind, sizeof behind, "/vsisubfile/0_%d,%s", 1 << 30, path);
        camber_features *features = read_file(it, (camber_source_desc){.path = path}, &status);
        expect_ok(&it->on, status);
        const area_sum own = sum_areas(features);
        camber_features_destroy(features);
        features = read_file(it, (camber_source_desc){.path = behind}, &status);
        expect_ok(&it->on, status);
        const area_sum gdals = sum_areas(features);
        camber_features_destroy(features);
        print_message("%s: %zu areas of %zu rings; GDAL: %zu of %zu, of which it is %.4f\n", names[i], own.features,
                      own.rings, gdals.features, gdals.rings, own.area / gdals.area);
        assert_true(own.features * 100 > gdals.features * 99 && own.features * 99 < gdals.features * 100);
        assert_true(own.rings * 100 > gdals.rings * 99 && own.rings * 99 < gdals.rings * 100);
        assert_true(own.area > 0.99 * gdals.area && own.area < 1.05 * gdals.area);
    }
}

/* ---- Small files ---- */

/* Nodes 10 to 15 in a row; 16 at the north pole; 20 and 21 on both sides of the antimeridian, 22 and 23 on
 * it. */
static const pbf_node nodes[] = {{10, 10000000, 20000000},  {11, 10100000, 20000000}, {12, 10200000, 20100000},
                                 {13, 10300000, 20200000},  {14, 10400000, 20300000}, {15, 10500000, 20400000},
                                 {16, 10500000, 900000000}, {20, 1799000000, 5},      {21, -1799000000, 5},
                                 {22, 1800000000, 7},       {23, -1800000000, 7}};
enum { NODES = sizeof nodes / sizeof *nodes };

static const char *const street[] = {"highway", "residential", "name", "A", NULL};
static const char *const house[] = {"building", "yes", NULL};

static void begin(fixture *it) {
    pbf_header(&it->file, "DenseNodes");
    pbf_dense(&it->block, nodes, NODES);
    pbf_end_block(&it->file, &it->block);
}

static void add_way(fixture *it, const char *const *tags, size_t count, const int64_t *ids) {
    pbf_way(&it->block, 1000 + it->way_count++, tags, ids, count);
}
#define WAY(it, tags, ...)                                                                                             \
    add_way(it, tags, sizeof(int64_t[]){__VA_ARGS__} / sizeof(int64_t), (const int64_t[]){__VA_ARGS__})

static size_t finish(fixture *it, bool takes) {
    if (it->block.groups.size)
        pbf_end_block(&it->file, &it->block);
    write_file(&it->on, "file", it->file.bytes, it->file.size);
    const size_t count = expect_as_gdal(it, it->on.path, true, takes);
    (void)expect_as_gdal(it, it->on.path, false, takes);
    return count;
}

/* All that ways may be, with each style. */
static void test_ways(void **state) {
    static const char *const square[] = {"highway", "pedestrian", "area", "yes", NULL};
    static const char *const loop[] = {"highway", "pedestrian", "building", "yes", NULL};
    static const char *const no_house[] = {"building", "No", "barrier", "wall", NULL};
    static const char *const twice[] = {"name", "A", "name", "B", "highway", "path", NULL};
    static const char *const strange[] = {"", "", "bridge", "", NULL};
    fixture *it = *state;
    for (int style = 0; style < 5; style++) {
        begin(it);
        it->on.style.schema.wants_polygons = style % 3 == 1;
        it->on.style.schema.wants_areas = style >= 3;
        if (style == 2)
            use_style(it, nothing, 1);
        WAY(it, street, 10, 11, 12);
        WAY(it, house, 10, 11, 12, 10);
        WAY(it, house, 10, 11, 10);          /* two segments are no area */
        WAY(it, house, 99, 10, 11, 12, 99);  /* closed, but for the node that is missing */
        WAY(it, house, 10, 98, 11, 12, 10);  /* still closed */
        WAY(it, square, 12, 13, 14, 12);     /* an area, as it says */
        WAY(it, loop, 12, 13, 14, 12);       /* other closed highways are lines */
        WAY(it, no_house, 12, 13, 14, 12);   /* "no" is no area */
        WAY(it, twice, 13, 14);              /* the last value counts */
        WAY(it, strange, 13, 15);            /* empty keys and values */
        WAY(it, NULL, 10, 15);               /* no tags */
        WAY(it, street, 10);                 /* one node */
        WAY(it, street, 97, 10, 96);         /* one node is known */
        WAY(it, street, 95, 94);             /* none is */
        WAY(it, street, 14, 14);             /* no length */
        WAY(it, street, 15, 16);             /* to the pole */
        WAY(it, street, 20, 21, 20, 22);     /* over the antimeridian and back */
        WAY(it, street, 22, 21);             /* from the antimeridian */
        WAY(it, street, 21, 20, 10, 11, 12); /* and on */
        WAY(it, street, 23, 22);             /* across the world */
        WAY(it, street, 20, 22, 23, 21);     /* over the antimeridian by points on it */
        WAY(it, house, 23, 22, 12, 23);
        const size_t count = finish(it, true);
        assert_int_equal(count, (style % 3 == 1 ? 18 : 14) + (style >= 3 ? 4 : 0)); /* four areas */
    }
}

static void test_nodes(void **state) {
    static const char *const wall[] = {"barrier", "wall", NULL};
    fixture *it = *state;
    /* Nodes by themselves, and nodes and ways in one block. */
    begin(it);
    pbf_single(&it->block, (pbf_node){30, 123456789, -98765432}, NULL);
    pbf_single(&it->block, (pbf_node){31, 123456780, -98765439}, NULL);
    WAY(it, wall, 30, 31, 10);
    assert_int_equal(finish(it, true), 1);
    /* In other units, which are rounded to 10^-7 degrees. */
    pbf_header(&it->file, "DenseNodes");
    pbf_dense(&it->block, (const pbf_node[]){{1, 10000001, 20000003}, {2, -77777777, 8888888}, {3, 1, -1}}, 3);
    pbf_number(&it->block.groups, 17, 137);
    pbf_number(&it->block.groups, 19, 1234567);
    pbf_number(&it->block.groups, 20, (uint64_t)INT64_C(-7654321));
    pbf_end_block(&it->file, &it->block);
    WAY(it, wall, 1, 2, 3);
    assert_int_equal(finish(it, true), 1);
    /* Ids out of order, which each node has alone. */
    pbf_header(&it->file, "DenseNodes");
    pbf_dense(&it->block, (const pbf_node[]){{70000, 1, 2}, {5, 10, 20}, {123456789012, 7, 7}}, 3);
    pbf_end_block(&it->file, &it->block);
    WAY(it, wall, 5, 70000);
    assert_int_equal(finish(it, true), 1);
}

/* Nodes with tags are points where the style wants them: dense ones and single ones, some on a way, some alone. */
static void test_points(void **state) {
    static const char *const elm[] = {"name", "Elm", NULL};
    static const char *const tree[] = {"name", "Oak", "bridge", "no", "name", "Elm", NULL};
    static const char *const other[] = {"created_by", "hand", NULL};
    static const char *const *const tags[NODES] = {tree, NULL, other, tree, NULL, NULL, tree, other, NULL, tree};
    fixture *it = *state;
    for (int round = 0; round < 8; round++) {
        it->on.style.schema.wants_points = round % 2;
        it->on.style.schema.wants_areas = round % 4 >= 2;
        it->where = round >= 4 ? "name = 'Elm'" : NULL;
        pbf_header(&it->file, "DenseNodes");
        pbf_tagged(&it->block, nodes, tags, NODES);
        pbf_dense(&it->block, (const pbf_node[]){{40, 5, 5}, {41, 6, 6}}, 2);
        pbf_single(&it->block, (pbf_node){50, -1234567891, 123456789}, tree);
        pbf_single(&it->block, (pbf_node){51, 77777777, 88888888}, NULL);
        pbf_end_block(&it->file, &it->block);
        /* In other units, which are not rounded to 10^-7 degrees. */
        pbf_tagged(&it->block, (const pbf_node[]){{61, 10000001, 20000003}, {62, -7777777, 8888888}},
                   (const char *const *const[]){tree, other}, 2);
        pbf_number(&it->block.groups, 17, 137);
        pbf_number(&it->block.groups, 19, 1234567);
        pbf_end_block(&it->file, &it->block);
        WAY(it, street, 10, 11, 12);
        WAY(it, elm, 61, 62);
        const size_t ways = round >= 4 ? 1 : 2, points = round >= 4 ? 6 : 9;
        assert_int_equal(finish(it, true), ways + (round % 2 ? points : 0));
    }
}

/* Nodes with tags that are cut off, or name strings that are not there. */
static void test_bad_points(void **state) {
    static const char *const tree[] = {"name", "Oak", NULL};
    static const uint8_t tags[][4] = {{1, 200, 1, 0}, {1, 2, 1, 200}, {1, 255, 255, 255}, {9, 9, 0, 0}};
    fixture *it = *state;
    it->on.style.schema.wants_points = true;
    for (size_t i = 0; i < sizeof tags / sizeof *tags; i++) {
        camber_status status;
        pbf_header(&it->file, "DenseNodes");
        pbf_dense(&it->block, nodes, 3);
        (void)pbf_string(&it->block, "name");
        (void)pbf_string(&it->block, "Oak");
        pbf_bytes dense = {.size = 0}, group = {.size = 0};
        pbf_field(&dense, 1, (const uint8_t[]){2, 2}, 2);
        pbf_field(&dense, 8, (const uint8_t[]){2, 2}, 2);
        pbf_field(&dense, 9, (const uint8_t[]){2, 2}, 2);
        pbf_field(&dense, 10, tags[i], sizeof tags[i]);
        pbf_message(&group, 2, &dense);
        pbf_message(&it->block.groups, 2, &group);
        pbf_end_block(&it->file, &it->block);
        WAY(it, tree, 10, 11);
        pbf_end_block(&it->file, &it->block);
        write_file(&it->on, "file", it->file.bytes, it->file.size);
        camber_features *set = read_file(it, (camber_source_desc){.path = it->on.path}, &status);
        assert_int_equal(status, CAMBER_ERROR_INPUT);
        assert_int_equal(it->on.errors, 1);
        assert_int_equal(set->feature_count, 0);
        camber_features_destroy(set);
    }
}

/* Steps of 16 bits and about them, forth and back, and ids so far apart that each has a leaf of its own. */
static void test_packing(void **state) {
    enum { STEPS = 8, MOST = 1800, FAR_IDS = 5 * MOST }; /* GDAL takes 2000 nodes of a way */
    static const int32_t steps[STEPS] = {32767, 32768, 32769, 65535, 65536, -32767, -32768, -32769};
    static pbf_node apart[FAR_IDS];
    static int64_t ids[FAR_IDS];
    fixture *it = *state;
    pbf_header(&it->file, "DenseNodes");
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++)
            pbf_dense(&it->block,
                      (const pbf_node[]){
                          {1000 + 100 * i + k, 10000000 + steps[i] / 2, 20000000 + steps[k] / 2},
                          {5000 + 100 * i + k, 10000000 + steps[i] / 2 - steps[i], 20000000 + steps[k] / 2 - steps[k]}},
                      2);
    pbf_end_block(&it->file, &it->block);
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++)
            WAY(it, street, 1000 + 100 * i + k, 5000 + 100 * i + k, 1000 + 100 * i + k);
    assert_int_equal(finish(it, true), STEPS * STEPS);
    uint32_t random = 1; /* GDAL refuses what packs too well */
    for (int i = 0; i < FAR_IDS; i++) {
        random = random * 1664525 + 1013904223;
        ids[i] = 1 + 1000 * (int64_t)i + random % 487;
        apart[i] = (pbf_node){ids[i], 10000000 + (random >> 20), 20000000 + (random >> 21)};
    }
    pbf_header(&it->file, "DenseNodes");
    pbf_dense(&it->block, apart, FAR_IDS);
    pbf_end_block(&it->file, &it->block);
    for (int first = 0; first < FAR_IDS; first += MOST)
        add_way(it, street, MOST, ids + first);
    add_way(it, street, MOST, ids + MOST / 2);
    assert_int_equal(finish(it, true), FAR_IDS / MOST + 1);
}

/* Where ways and relations begin is found in files of so many blobs of each. */
static void test_ends(void **state) {
    static const char *const relation[] = {"type", "multipolygon", NULL};
    fixture *it = *state;
    it->on.style.schema.wants_areas = true;
    for (int n = 0; n < 6 * 7 * 3; n++) {
        const int node_blobs = 1 + n / 3 % 7 * 2, way_blobs = 1 + n / 21 * 3, relation_blobs = n % 3 * 2;
        pbf_header(&it->file, "DenseNodes");
        for (int i = 0; i < node_blobs; i++) {
            pbf_dense(&it->block,
                      (const pbf_node[]){{10 * i, 10000000, 20000000}, {10 * i + 1, 10000000 + i, 20000001}}, 2);
            pbf_end_block(&it->file, &it->block);
        }
        for (int i = 0; i < way_blobs; i++) {
            WAY(it, street, 10 * (i % node_blobs), 10 * (i % node_blobs) + 1);
            pbf_end_block(&it->file, &it->block);
        }
        for (int i = 0; i < relation_blobs; i++) {
            pbf_relation(&it->block, relation, (const pbf_member[]){{1, "outer"}}, 1);
            pbf_end_block(&it->file, &it->block);
        }
        assert_int_equal(finish(it, true), way_blobs);
    }
}

/* Files left to GDAL: it has rules of its own for them, or says why it cannot read them. */
static void test_declined(void **state) {
    fixture *it = *state;
    begin(it); /* a negative id */
    pbf_dense(&it->block, (const pbf_node[]){{-5, 1, 2}, {-4, 1, 3}}, 2);
    pbf_end_block(&it->file, &it->block);
    WAY(it, street, -5, -4);
    (void)finish(it, false);
    /* Another layer, no PBF, a file that is not there. */
    assert_false(camber_source_is_osm(&(camber_source_desc){.path = it->on.path, .layer = "multilinestrings"}));
    assert_true(camber_source_is_osm(&(camber_source_desc){.path = it->on.path, .layer = "lines"}));
    assert_false(camber_source_is_osm(&(camber_source_desc){.path = "/no/such/file.osm.pbf"}));
    assert_false(camber_source_is_osm(&(camber_source_desc){.path = "/tmp"}));
    write_file(&it->on, "file", "<osm version=\"0.6\"></osm>", 25);
    assert_false(camber_source_is_osm(&(camber_source_desc){.path = it->on.path}));
}

/* Filters that this reader knows, and those that it leaves to GDAL, which says what is wrong with the last. */
static void test_filters(void **state) {
    static const char *const bridge[] = {"highway", "Primary", "bridge", "yes", "name:en", "Bridge", NULL};
    static const char *const empty[] = {"highway", "", NULL};
    static const char *const known[] = {"highway = 'primary'",
                                        "highway='PRIMARY' AND bridge IS NOT NULL",
                                        "highway != 'residential' or building IN ('no','Yes')",
                                        "highway <> 'primary'",
                                        "\"name:en\" = 'bridge' OR (bridge IS NULL AND name = 'A')",
                                        "name IS NULL",
                                        "highway = ''",
                                        "barrier is null or highway in ('a') and name = 'A'"};
    static const char *const left[] = {"NOT (highway = 'primary')", "highway LIKE 'p%'",  "osm_id IS NOT NULL",
                                       "highway = bridge",          "name = 'it''s'",     "HIGHWAY = 'primary'",
                                       "highway = 'primary' and",   "highway = \"path\"", "lanes > 2"};
    fixture *it = *state;
    begin(it);
    WAY(it, street, 10, 11, 12);
    WAY(it, bridge, 12, 13);
    WAY(it, house, 10, 11, 12, 10);
    WAY(it, empty, 13, 14, 15);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        it->where = known[i];
        it->on.style.schema.wants_polygons = i % 2;
        assert_true(finish(it, true) > 0);
    }
    for (size_t i = 0; i < sizeof left / sizeof *left; i++)
        assert_false(camber_source_is_osm(&(camber_source_desc){.path = it->on.path, .where = left[i]}) &&
                     strcmp(left[i], "HIGHWAY = 'primary'") != 0);
    /* Keys that differ in case alone, and a filter that nothing passes: GDAL warns of that. */
    it->where = "HIGHWAY = 'primary'";
    (void)finish(it, false);
    it->where = "highway = 'path'";
    assert_int_equal(finish(it, false), 0);
    it->where = "hihgway IS NOT NULL";
    assert_int_equal(finish(it, false), 0);
    assert_int_equal(it->on.warnings, 1);
}

/* ---- Relations ---- */

/* A grid of nodes, 100 x + y, a hundredth of a degree apart. */
static void begin_grid_of(fixture *it, const int64_t box[4]) {
    pbf_node grid[100];
    for (int i = 0; i < 100; i++)
        grid[i] = (pbf_node){i / 10 * 100 + i % 10, 10000000 + i / 10 * 100000, 20000000 + i % 10 * 100000};
    pbf_header_of(&it->file, "DenseNodes", box);
    pbf_dense(&it->block, grid, 100);
    pbf_end_block(&it->file, &it->block);
}

static void begin_grid(fixture *it) {
    begin_grid_of(it, NULL);
}

static void grid_way(fixture *it, int64_t id, const char *const *tags, size_t count, const int64_t *ids) {
    pbf_way(&it->block, id, tags, ids, count);
}
#define GRID_WAY(it, id, tags, ...)                                                                                    \
    grid_way(it, id, tags, sizeof(int64_t[]){__VA_ARGS__} / sizeof(int64_t), (const int64_t[]){__VA_ARGS__})
#define RELATION(it, tags, ...)                                                                                        \
    pbf_relation(&(it)->block, tags, (const pbf_member[]){__VA_ARGS__},                                                \
                 sizeof(pbf_member[]){__VA_ARGS__} / sizeof(pbf_member))

/* The areas of all rings in squares of the grid, a feature in brackets; areas alone. */
static void list_areas(const camber_features *set, char *text, size_t size) {
    size_t used = 0;
    double shape[4] = {0};
    camber_mercator_project(1.0, 2.0, &shape[0], &shape[1]);
    camber_mercator_project(1.01, 2.01, &shape[2], &shape[3]);
    const double square = (shape[2] - shape[0]) * (shape[1] - shape[3]);
    text[0] = 0;
    for (size_t p = 0; p < set->polyline_count; p++) {
        if (camber_features_kind(set, p) != CAMBER_GEOMETRY_AREA)
            continue;
        const bool follows = p > 0 && set->polyline_feature[p] == set->polyline_feature[p - 1];
        double area = 0.0;
        for (size_t i = set->offsets[p]; i + 1 < set->offsets[p + 1]; i++) {
            const double *q = set->points + 2 * i, *o = set->points + 2 * set->offsets[p];
            area += 0.5 * ((q[0] - o[0]) * (q[3] - o[1]) - (q[2] - o[0]) * (q[1] - o[1]));
        }
        used += (size_t)snprintf(text + used, size - used, "%s%+.1f", follows ? "" : " ", area / square);
        assert_true(used < size);
    }
}

/* Writes the file, and reads it with areas by several threads. */
static void expect_areas(fixture *it, const char *areas, size_t open) {
    static const uint32_t threads[] = {1, 3};
    if (it->block.groups.size)
        pbf_end_block(&it->file, &it->block);
    write_file(&it->on, "file", it->file.bytes, it->file.size);
    for (size_t i = 0; i < 2; i++) {
        char got[256];
        bool declined;
        camber_features *features;
        assert_int_equal(camber_features_create(it->on.context, &it->on.style, &features), CAMBER_OK);
        const camber_source_desc desc = {.path = it->on.path, .where = it->where, .threads = threads[i]};
        expect_ok(&it->on, camber_osm_reader.read(features, &desc, &declined));
        assert_false(declined);
        list_areas(features, got, sizeof got);
        assert_string_equal(got, areas);
        assert_int_equal(features->stats.open_relations, open);
        assert_int_equal(features->stats.turned_rings, 0);
        camber_features_destroy(features);
    }
}

static const char *const wood[] = {"type", "multipolygon", "natural", "wood", NULL};

static void test_relations(void **state) {
    static const char *const bare[] = {"type", "multipolygon", NULL},
                             *const admin[] = {"type", "boundary", "x", "y", NULL},
                             *const route[] = {"type", "route", "x", "y", NULL};
    fixture *it = *state;
    it->on.style.schema.wants_areas = true;
    begin_grid(it);
    GRID_WAY(it, 1, NULL, 0, 500, 505); /* two halves of a square of 5 x 5, one of them turned */
    GRID_WAY(it, 2, NULL, 0, 5, 505);
    GRID_WAY(it, 3, street, 101, 102, 202, 201, 101); /* a hole, with a line of its own */
    GRID_WAY(it, 4, house, 600, 700, 701, 601, 600);  /* an area of its own */
    GRID_WAY(it, 5, NULL, 303, 403, 404, 304, 303);
    GRID_WAY(it, 6, NULL, 800, 900, 901);
    /* Relations in a block of their own. */
    pbf_end_block(&it->file, &it->block);
    RELATION(it, wood, {1, "outer"}, {2, "outer"}, {3, "inner"});
    RELATION(it, admin, {1, ""}, {5, ""}, {2, ""}, {4, ""}); /* roles by what lies in what */
    RELATION(it, wood, {6, "outer"});                        /* it does not close */
    RELATION(it, wood, {6, "outer"}, {5, "outer"});          /* one ring of two */
    RELATION(it, wood, {5, "outer"}, {77, "outer"});         /* a way that the file does not have */
    RELATION(it, route, {5, ""});
    RELATION(it, bare, {5, "outer"}); /* no tags anywhere */
    expect_areas(it, " +1.0 +25.0-1.0 +25.0+1.0-1.0 +1.0 +1.0", 3);
    it->where = "natural = 'wood'";
    expect_areas(it, " +25.0-1.0 +1.0 +1.0", 3);
    it->where = NULL;
    /* With other rings that touch: two holes and the outer ring at one node, in one block with the ways. */
    begin_grid(it);
    GRID_WAY(it, 1, NULL, 0, 400, 404, 4, 0);
    GRID_WAY(it, 2, NULL, 101, 201, 202);
    GRID_WAY(it, 3, NULL, 202, 102, 101);
    GRID_WAY(it, 4, NULL, 202, 302, 303);
    GRID_WAY(it, 5, NULL, 303, 203, 202);
    RELATION(it, wood, {2, "inner"}, {4, "inner"}, {1, "outer"}, {5, "inner"}, {3, "inner"});
    RELATION(it, wood, {2, ""}, {4, ""}, {1, ""}, {5, ""}, {3, ""});
    RELATION(it, wood, {2, "inner"}, {3, "outer"}, {1, "outer"}); /* a ring of two roles */
    expect_areas(it, " +16.0-1.0-1.0 +16.0-1.0-1.0 +16.0-1.0", 0);
}

/* Land in the south, and an island, which is an area of its own kind, too. */
static void add_coast(fixture *it, const int64_t box[4]) {
    static const char *const coast[] = {"natural", "coastline", NULL};
    begin_grid_of(it, box);
    GRID_WAY(it, 1, coast, 504, 404, 4);
    GRID_WAY(it, 2, coast, 206, 306, 307, 207, 206);
    GRID_WAY(it, 3, coast, 904, 504);
}

/* The sea is water as a pond is, if the style looks at that, and the file says where its coast is whole. */
static void test_sea(void **state) {
    static char *natural[] = {"highway", "natural"};
    static const char *const old[] = {"type", "multipolygon", NULL};
    static const int64_t box[4] = {1005000000, 1085000000, 2085000000, 2005000000};
    fixture *it = *state;
    use_style(it, natural, sizeof natural / sizeof *natural);
    it->on.style.schema.wants_areas = true;
    add_coast(it, box);
    expect_areas(it, " +1.0 +36.0-1.0", 0);
    add_coast(it, box);
    RELATION(it, old, {2, "outer"}); /* in place of the way */
    expect_areas(it, " +1.0 +36.0-1.0", 0);
    it->on.warnings = 0;
    add_coast(it, NULL);
    expect_areas(it, " +1.0", 0);
    assert_int_equal(it->on.warnings, 2); /* once a number of threads */
    use_style(it, natural, 1);
    it->on.style.schema.wants_areas = true;
    add_coast(it, box);
    expect_areas(it, " +1.0", 0);
    assert_int_equal(it->on.warnings, 2);
}

/* An old relation: its outer ways have the tags, and are not filled by themselves. */
static void test_old_relations(void **state) {
    static const char *const bare[] = {"type", "multipolygon", NULL};
    fixture *it = *state;
    it->on.style.schema.wants_areas = true;
    for (int outlines = 0; outlines < 2; outlines++) {
        it->on.style.schema.wants_polygons = outlines;
        begin_grid(it);
        GRID_WAY(it, 1, house, 0, 500, 505, 5, 0);
        GRID_WAY(it, 2, NULL, 101, 102, 202, 201, 101);
        GRID_WAY(it, 3, house, 600, 700, 701, 601, 600);
        RELATION(it, bare, {1, "outer"}, {2, "inner"});
        expect_areas(it, " +1.0 +25.0-1.0", 0);
    }
}

static void test_no_lines(void **state) {
    fixture *it = *state;
    begin(it);
    assert_int_equal(finish(it, true), 0);
    begin(it);
    WAY(it, house, 10, 11, 12, 10);
    assert_int_equal(finish(it, true), 0); /* an error both ways: it has areas alone */
    pbf_header(&it->file, "DenseNodes");
    assert_int_equal(finish(it, true), 0);
}

/* ---- Damage ---- */

/* Reads what may be damaged: it reads or it does not, and says so once. */
static camber_status read_damaged(fixture *it, uint32_t threads) {
    camber_status status;
    bool declined;
    camber_features *features;
    const camber_source_desc desc = {.path = it->on.path, .threads = threads};
    assert_int_equal(camber_features_create(it->on.context, &it->on.style, &features), CAMBER_OK);
    it->on.errors = 0;
    if (!camber_reader_takes(&camber_osm_reader, &desc)) {
        camber_features_destroy(features);
        return CAMBER_ERROR_INPUT;
    }
    status = camber_osm_reader.read(features, &desc, &declined);
    assert_int_equal(it->on.errors, status != CAMBER_OK);
    assert_true(status == CAMBER_OK || status == CAMBER_ERROR_INPUT);
    if (status != CAMBER_OK || declined)
        assert_int_equal(features->polyline_count, 0);
    camber_features_destroy(features);
    return status;
}

static void make_small(fixture *it) {
    begin(it);
    for (int i = 0; i < 20; i++) {
        WAY(it, i % 3 ? street : house, 10, 11, 12, 13, 14, 10);
        WAY(it, street, 15, 10 + i % 5);
        if (i % 7 == 0)
            pbf_end_block(&it->file, &it->block);
    }
    pbf_end_block(&it->file, &it->block);
}

static void test_cut(void **state) {
    fixture *it = *state;
    make_small(it);
    size_t whole = 0;
    for (size_t size = 0; size <= it->file.size; size++) {
        write_file(&it->on, "file", it->file.bytes, size);
        whole += read_damaged(it, 2) == CAMBER_OK;
    }
    /* Between two blobs nothing is missing that could be told. */
    assert_int_equal(whole, 6);
}

static void test_flipped_bits(void **state) {
    fixture *it = *state;
    make_small(it);
    size_t refused = 0;
    for (size_t bit = 0; bit < 8 * it->file.size; bit += 7) {
        it->file.bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
        write_file(&it->on, "file", it->file.bytes, it->file.size);
        refused += read_damaged(it, 1 + (uint32_t)(bit % 3)) != CAMBER_OK;
        it->file.bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }
    assert_true(refused > it->file.size / 2);
}

/* The same within a block, where no checksum tells. */
static void test_flipped_blocks(void **state) {
    fixture *it = *state;
    static uint8_t bytes[sizeof it->file.bytes];
    begin(it);
    const size_t head = it->file.size;
    pbf_bytes content = {.size = 0};
    WAY(it, street, 10, 11, 12, 13);
    WAY(it, house, 10, 11, 12, 10);
    pbf_message(&content, 1, &it->block.strings);
    pbf_put(&content, it->block.groups.bytes, it->block.groups.size);
    it->block = (pbf_block){.string_count = 0};
    memcpy(bytes, it->file.bytes, head);
    for (size_t bit = 0; bit < 8 * content.size; bit++) {
        content.bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
        pbf_content(&it->file, "OSMData", &content, 0);
        write_file(&it->on, "file", it->file.bytes, it->file.size);
        (void)read_damaged(it, 2);
        it->file.size = head;
        content.bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }
}

/* The same with a relation. */
static void test_damaged_relations(void **state) {
    fixture *it = *state;
    it->on.style.schema.wants_areas = true;
    begin_grid(it);
    const size_t head = it->file.size;
    pbf_bytes content = {.size = 0};
    GRID_WAY(it, 1, NULL, 0, 500, 505);
    GRID_WAY(it, 2, street, 0, 5, 505);
    RELATION(it, wood, {1, "outer"}, {2, ""});
    pbf_message(&content, 1, &it->block.strings);
    pbf_put(&content, it->block.groups.bytes, it->block.groups.size);
    it->block = (pbf_block){.string_count = 0};
    for (size_t bit = 0; bit < 8 * content.size; bit++) {
        content.bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
        pbf_content(&it->file, "OSMData", &content, 0);
        write_file(&it->on, "file", it->file.bytes, it->file.size);
        (void)read_damaged(it, 2);
        it->file.size = head;
        content.bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }
}

static void expect_refused(fixture *it, const char *words) {
    write_file(&it->on, "file", it->file.bytes, it->file.size);
    assert_int_equal(read_damaged(it, 2), CAMBER_ERROR_INPUT);
    if (!strstr(it->on.error, words))
        fail_msg("\"%s\" is not in \"%s\"", words, it->on.error);
}

static void test_wrong_blobs(void **state) {
    static uint8_t zeros[200000], packed[1000];
    static const uint64_t sizes[] = {1 << 20, (32 << 20) + 1, UINT64_MAX};
    fixture *it = *state;
    uLongf size = sizeof packed;
    pbf_bytes blob = {.size = 0};
    assert_int_equal(compress(packed, &size, zeros, sizeof zeros), Z_OK);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        begin(it); /* a blob that says too much */
        blob.size = 0;
        pbf_number(&blob, 2, sizes[i]);
        pbf_field(&blob, 3, packed, size);
        pbf_blob(&it->file, "OSMData", &blob);
        expect_refused(it, "far more than its size");
    }
    begin(it); /* one that says too little */
    blob.size = 0;
    pbf_number(&blob, 2, 1000);
    pbf_field(&blob, 3, packed, size);
    pbf_blob(&it->file, "OSMData", &blob);
    expect_refused(it, "cannot be decompressed");
    begin(it);
    pbf_blob(&it->file, "", &(pbf_bytes){.size = 0});
    it->file.bytes[it->file.size - 4] = 0x7a; /* the type is another field */
    expect_refused(it, "a blob's header that is not valid");
    begin(it); /* a header of 2 GB */
    pbf_append(&it->file, "\x7f\xff\xff\xff and so on, and on", 22);
    expect_refused(it, "a blob's header that is not valid");
    begin(it); /* a node beyond the pole */
    pbf_dense(&it->block, (const pbf_node[]){{1, 0, 900000001}}, 1);
    pbf_end_block(&it->file, &it->block);
    expect_refused(it, "not on Earth");
}

/* Little memory ends it with a line about memory, whatever thread wanted it. */
static void test_memory(void **state) {
    fixture *it = *state;
    make_small(it);
    RELATION(it, wood, {1000, "outer"}, {1006, "inner"});
    pbf_end_block(&it->file, &it->block);
    write_file(&it->on, "file", it->file.bytes, it->file.size);
    it->on.style.schema.wants_areas = true;
    size_t failed = 0;
    for (uint64_t bytes = 4096; bytes < 600000; bytes += bytes / 8) {
        camber_budget *budget;
        camber_context *context;
        camber_features *features = NULL;
        camber_status status;
        bool declined = false;
        assert_int_equal(camber_budget_create(&(camber_budget_desc){.memory_bytes = bytes}, &budget), CAMBER_OK);
        const camber_context_desc desc = {.log = reading_log, .log_user = &it->on, .budget = budget};
        if (camber_context_create(&desc, &context) != CAMBER_OK) {
            camber_budget_destroy(budget);
            continue;
        }
        it->on.errors = 0;
        status = camber_features_create(context, &it->on.style, &features);
        if (status == CAMBER_OK)
            status =
                camber_osm_reader.read(features, &(camber_source_desc){.path = it->on.path, .threads = 3}, &declined);
        assert_true(status == CAMBER_OK || status == CAMBER_ERROR_MEMORY);
        assert_int_equal(it->on.errors, status != CAMBER_OK);
        failed += status != CAMBER_OK;
        camber_features_destroy(features);
        camber_context_destroy(context);
        assert_int_equal(camber_budget_get_held_bytes(budget), 0);
        camber_budget_destroy(budget);
    }
    assert_true(failed > 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_real_files, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_real_areas, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_ways, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_nodes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_points, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_bad_points, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_packing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_ends, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_declined, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_filters, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_relations, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_sea, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_old_relations, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_no_lines, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_cut, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_flipped_bits, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_flipped_blocks, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_damaged_relations, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_wrong_blobs, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_memory, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
