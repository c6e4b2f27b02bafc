/* Labels of a whole zoom: pictures that are parts of a larger one have parts of the same labels, however the zoom is
 * divided, and none is cut, doubled or missing where two of them meet. */
#include "label_seams.h"
#include "town.h"

/* Zoom 4: the world is 8192 px wide, which is 8 px for each px of the town. A tile is 256 px wide. */
enum { ZOOM = 4, TILE = 256, TILES = 32, TILE_LEVEL = 5, ALL_LEVEL = 2, SHOWN = 8 };

#define HALOED(id, layout)                                                                                             \
    "{\"id\":\"" id "\",\"type\":\"symbol\",\"layout\":{\"text-field\":[\"get\",\"name\"]," layout                     \
    "},\"paint\":{\"text-halo-width\":2,\"text-halo-color\":\"#fff\"}}"

static const char EVERYTHING[] = NAMES("streets", "\"symbol-placement\":\"line\",\"text-size\":11,"
                                                  "\"symbol-spacing\":150") "," //
    ICONS("icons", "\"icon-padding\":1") ","                                    //
    NAMES("lakes", "\"text-size\":9,\"text-overlap\":\"cooperative\"") "," HALOED(
        "places", "\"text-variable-anchor\":[\"left\",\"right\",\"top\",\"bottom\"],\"text-radial-offset\":0.4,"
                  "\"text-size\":12,\"text-justify\":\"auto\",\"icon-image\":\"box\",\"icon-optional\":true");

/* Points and lines, so many that few of their labels find room. about: px of the town. */
static void add_crowd(town *t, uint32_t seed, double about_x, double about_y, bool backwards) {
    enum { POINTS = 900, LINES = 250 };
    typedef struct made {
        char name[24];
        double px[8];
        size_t count;
    } made;
    static made list[POINTS + LINES];
    for (size_t i = 0; i < POINTS + LINES; i++) {
        made *m = list + i;
        snprintf(m->name, sizeof m->name, "Name %u", (unsigned)(next_share(&seed) * 300.0));
        m->count = i < POINTS ? 1 : 4;
        m->px[0] = about_x + next_share(&seed) * 240.0 - 120.0;
        m->px[1] = about_y + next_share(&seed) * 240.0 - 120.0;
        for (size_t k = 1; k < m->count; k++) {
            m->px[2 * k] = m->px[2 * k - 2] + 8.0 * next_share(&seed);
            m->px[2 * k + 1] = m->px[2 * k - 1] + 8.0 * next_share(&seed) - 4.0;
        }
    }
    for (size_t i = 0; i < POINTS + LINES; i++) {
        const made *m = list + (backwards ? POINTS + LINES - 1 - i : i);
        add_feature(t, m->count == 1 ? CAMBER_GEOMETRY_LABEL_POINT : CAMBER_GEOMETRY_LABEL_LINE, m->name, m->px,
                    m->count);
    }
}

/* Things so far apart that no surroundings of a tile have all of them. */
static void add_outliers(town *t) {
    add_point(t, "North", 300.0, 10.0);
    add_point(t, "South", 500.0, 1010.0);
    add_point(t, "West", 200.0, 300.0);
    add_point(t, "East", 800.0, 300.0);
}

/* ---- The labels of a town ---- */

typedef struct placed_town {
    town *town;
    camber_label_things things;
    camber_label_shelf shelf;
    camber_zoom_labels *labels;
    int finest_level;
} placed_town;

static placed_town *place_town(town *t, int finest_level, size_t block_things) {
    placed_town *p = calloc(1, sizeof *p);
    assert_non_null(p);
    *p = (placed_town){.town = t, .finest_level = finest_level, .shelf.limit_bytes = 1 << 20};
    t->features.fonts = t->fonts;
    t->features.sprites = &t->sprites;
    assert_int_equal(camber_label_things_find(&t->features, NULL, &p->things), CAMBER_OK);
    const camber_zoom_labels_desc desc = {.features = &t->features,
                                          .things = &p->things,
                                          .shelf = &p->shelf,
                                          .zoom = ZOOM,
                                          .finest_level = finest_level,
                                          .block_things = block_things};
    assert_int_equal(camber_zoom_labels_create(&desc, &p->labels), CAMBER_OK);
    return p;
}

static void free_placed(placed_town *p) {
    camber_zoom_labels_destroy(p->labels);
    camber_label_things_free(&p->things);
    p->town->features.fonts = NULL;
    p->town->features.sprites = NULL;
    free(p);
}

/* Draws side x side tiles, from this column and row on. */
static camber_labels draw(placed_town *p, uint32_t column, uint32_t row, uint32_t side, double ratio) {
    const camber_label_square square = {p->finest_level, column >> (TILE_LEVEL - p->finest_level),
                                        row >> (TILE_LEVEL - p->finest_level)};
    const camber_view view = {.x = (column + 0.5 * side) / TILES,
                              .y = (row + 0.5 * side) / TILES,
                              .zoom = ZOOM,
                              .scale_px = ratio * TILE * TILES,
                              .cosine = 1.0,
                              .ratio = ratio,
                              .width = (uint32_t)(ratio * TILE * side),
                              .height = (uint32_t)(ratio * TILE * side)};
    camber_labels labels;
    if (camber_zoom_labels_draw(p->labels, &square, &view, &labels) != CAMBER_OK)
        fail_msg("%s", p->town->last);
    return labels;
}

/* Compares each of 8 x 8 tiles with what the picture of all of them has there. The tiles come in an odd order. */
static seam_faults compare_tiles(placed_town *all, placed_town *single, uint32_t column, uint32_t row) {
    seam_faults f = {0};
    camber_labels whole = draw(all, column, row, SHOWN, 1.0);
    for (uint32_t i = 0; i < SHOWN * SHOWN; i++) {
        const uint32_t n = i * 37 % (SHOWN * SHOWN), x = n % SHOWN, y = n / SHOWN;
        camber_labels tile = draw(single, column + x, row + y, 1, 1.0);
        seam_compare(&whole, &tile, (camber_box){x * TILE, y * TILE, (x + 1) * TILE, (y + 1) * TILE}, &f);
        camber_labels_free(&tile);
    }
    camber_labels_free(&whole);
    return f;
}

static void test_tiles(void **state) {
    (void)state;
    static const size_t divided[] = {0, 100, 500};
    town *t = open_town(EVERYTHING);
    add_crowd(t, 3, 384.0, 640.0, false);
    add_outliers(t);
    placed_town *all = place_town(t, ALL_LEVEL, SIZE_MAX);
    for (size_t i = 0; i < sizeof divided / sizeof *divided; i++) {
        placed_town *single = place_town(t, TILE_LEVEL, divided[i]);
        const seam_faults f = compare_tiles(all, single, 8, 16);
        printf("# blocks of %zu things: %zu labels in tiles, %zu cross a border: %zu cut, %zu doubled, %zu missing, "
               "%zu of no picture\n",
               divided[i], f.shown, f.crossing, f.cut, f.doubled, f.missing, f.extra);
        assert_true(f.shown > 600 && f.crossing > 200);
        assert_int_equal(seam_count(&f), 0);
        free_placed(single);
    }
    free_placed(all);
    close_town(t);
}

/* ---- Kept blocks ---- */

enum { MOST_LISTED = 4096 };

typedef struct list {
    uint64_t looks[MOST_LISTED];
    size_t count;
} list;

static camber_status take(void *user, const camber_label_square *block, const camber_shown_label *label) {
    list *l = user;
    const double size = 1.0 / exp2(block->level);
    assert_true(seam_touches(&label->box, &(camber_box){block->column * size, block->row * size,
                                                        (block->column + 1) * size, (block->row + 1) * size}));
    assert_true(l->count < MOST_LISTED);
    for (size_t i = 0; i < l->count; i++)
        if (l->looks[i] == label->appearance)
            return CAMBER_OK; /* of another block, too */
    l->looks[l->count++] = label->appearance;
    return CAMBER_OK;
}

/* The surroundings that settle a tile settle tiles around it, too, which are not placed again; even if labels are
 * placed from south to north, and so depend on all that are south of them. Blocks of a given number of things never
 * grow, so here a tile that is not placed was settled with another one: of 64 tiles 17 or 18 are placed, and all if no
 * block is widened. */
static void test_chains(void **state) {
    (void)state;
    static const char *const orders[] = {"auto", "viewport-y"};
    size_t placed[2];
    for (int i = 0; i < 2; i++) {
        char layers[512];
        snprintf(layers, sizeof layers,
                 NAMES("names", "\"text-size\":12,\"text-allow-overlap\":false,"
                                "\"symbol-z-order\":\"%s\""),
                 orders[i]);
        town *t = open_town(layers);
        add_crowd(t, 21, 384.0, 640.0, false);
        add_outliers(t);
        placed_town *all = place_town(t, ALL_LEVEL, SIZE_MAX), *single = place_town(t, TILE_LEVEL, 1);
        const seam_faults f = compare_tiles(all, single, 8, 16);
        assert_true(f.shown > 200 && f.crossing > 100);
        assert_int_equal(seam_count(&f), 0);
        assert_true(single->shelf.placed < SHOWN * SHOWN / 2);
        placed[i] = single->shelf.placed;
        free_placed(single);
        free_placed(all);
        close_town(t);
    }
    printf("# 64 tiles: %zu blocks placed, %zu where labels depend on each other from south to north\n", placed[0],
           placed[1]);
}

/* The first tile is placed by itself; if more are wanted, a large block around them is. */
static void test_growth(void **state) {
    (void)state;
    town *t = open_town(NAMES("names", "\"text-size\":12"));
    add_crowd(t, 21, 384.0, 640.0, false);
    placed_town *all = place_town(t, ALL_LEVEL, SIZE_MAX), *single = place_town(t, TILE_LEVEL, 0);
    camber_labels first = draw(single, 12, 20, 1, 1.0);
    assert_int_equal(single->shelf.placed, 1);
    camber_labels_free(&first);
    const seam_faults f = compare_tiles(all, single, 8, 16);
    assert_int_equal(seam_count(&f), 0);
    assert_int_equal(single->shelf.placed, 2);
    free_placed(single);
    free_placed(all);
    close_town(t);
}

/* If all things are around a tile, they are placed once for all tiles. */
static void test_few(void **state) {
    (void)state;
    town *t = open_town(EVERYTHING);
    for (int i = 0; i < 100; i++) {
        char name[16];
        snprintf(name, sizeof name, "Name %d", i);
        add_point(t, name, 350.0 + 7.0 * (i % 10), 610.0 + 6.0 * (i / 10));
    }
    placed_town *all = place_town(t, ALL_LEVEL, SIZE_MAX), *single = place_town(t, TILE_LEVEL, 0);
    camber_labels first = draw(single, 12, 20, 1, 1.0);
    camber_labels_free(&first);
    const seam_faults f = compare_tiles(all, single, 8, 16);
    assert_int_equal(single->shelf.placed, 1);
    assert_true(f.shown > 60);
    assert_int_equal(seam_count(&f), 0);
    free_placed(single);
    free_placed(all);
    close_town(t);
}

/* One limit holds for the blocks of all zooms. */
static void test_shelf(void **state) {
    (void)state;
    enum { ZOOMS = 4 };
    town *t = open_town(EVERYTHING);
    add_crowd(t, 23, 384.0, 640.0, false);
    placed_town *p = place_town(t, TILE_LEVEL, 0);
    camber_zoom_labels *zooms[ZOOMS];
    const camber_box around = {0.25, 0.5, 0.5, 0.75};
    size_t most = 0, kept[2];
    for (int limited = 0; limited < 2; limited++) {
        p->shelf.limit_bytes = limited ? most / 3 : SIZE_MAX / 4;
        for (int i = 0; i < ZOOMS; i++) {
            static list l;
            const camber_zoom_labels_desc desc = {.features = &t->features,
                                                  .things = &p->things,
                                                  .shelf = &p->shelf,
                                                  .zoom = ZOOM - 1 + i,
                                                  .finest_level = TILE_LEVEL};
            l.count = 0;
            assert_int_equal(camber_zoom_labels_create(&desc, zooms + i), CAMBER_OK);
            assert_int_equal(camber_zoom_labels_list(zooms[i], &around, take, &l), CAMBER_OK);
            assert_true(l.count > 0);
        }
        most = kept[limited] = p->shelf.held_bytes;
        for (int i = 0; i < ZOOMS; i++)
            camber_zoom_labels_destroy(zooms[i]);
        assert_true(p->shelf.held_bytes == 0 && !p->shelf.blocks);
    }
    assert_true(kept[0] > 0 && kept[1] > 0 && kept[1] <= kept[0] / 3);
    free_placed(p);
    close_town(t);
}

/* The tree of things finds what looking at all of them finds. */
static void test_tree(void **state) {
    (void)state;
    town *t = open_town(EVERYTHING);
    add_crowd(t, 25, 1000.0, 640.0, false); /* over the antimeridian */
    add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Long", (const double[]){-20.0, 5.0, 1030.0, 1000.0}, 2);
    camber_label_things all, few[2];
    assert_int_equal(camber_label_things_find(&t->features, NULL, &all), CAMBER_OK);
    uint32_t seed = 29;
    for (int i = 0; i < 200; i++) {
        const double x = 1.4 * next_share(&seed) - 0.2, y = next_share(&seed),
                     size = next_share(&seed) * (i % 2 ? 0.01 : 0.4);
        const camber_box box = {x, y, x + size, y + size};
        all.tree.codes = NULL; /* then it looks at all of them */
        camber_label_things plain = all;
        assert_int_equal(camber_label_things_select(&plain, &box, few), CAMBER_OK);
        assert_int_equal(camber_label_things_make_tree(&plain), CAMBER_OK);
        assert_int_equal(camber_label_things_select(&plain, &box, few + 1), CAMBER_OK);
        assert_int_equal(few[0].count, few[1].count);
        assert_int_equal(camber_label_things_touch(&plain, &box), few[0].count > 0);
        if (few[0].count)
            assert_memory_equal(few[0].items, few[1].items, few[0].count * sizeof *few[0].items);
        assert_memory_equal(few[0].class_first, few[1].class_first, (all.class_count + 1) * sizeof *all.class_first);
        camber_label_things_free(few);
        camber_label_things_free(few + 1);
        camber_free(t->context, plain.tree.codes);
        camber_free(t->context, plain.tree.order);
        camber_free(t->context, plain.tree.nodes);
    }
    camber_label_things_free(&all);
    close_town(t);
}

/* ---- The world's seam ---- */

/* East and west of the antimeridian are neighbours: a label on it is in the tiles of both sides, and of two labels that
 * meet there only one is shown, whether the world is placed as a whole or in small blocks. */
static void test_seam(void **state) {
    (void)state;
    town *t =
        open_town(NAMES("names", "\"text-size\":14,\"symbol-sort-key\":[\"match\",[\"get\",\"name\"],\"First\",0,1]"));
    add_point(t, "First", 1023.5, 400.0);
    add_point(t, "Second", 1.0, 400.0);
    add_point(t, "Third", 1023.0, 410.0);
    for (int whole = 0; whole < 2; whole++) {
        placed_town *p = place_town(t, TILE_LEVEL, whole ? SIZE_MAX : 0);
        camber_labels east = draw(p, TILES - 1, 12, 1, 1.0), west = draw(p, 0, 12, 1, 1.0);
        assert_int_equal(east.label_count, 2);
        assert_int_equal(west.label_count, 2);
        for (size_t i = 0; i < 2; i++) {
            assert_int_equal(east.labels[i].feature, west.labels[i].feature);
            assert_true(east.labels[i].feature != 1);
            assert_true(seam_same_box(&east.labels[i].box, &west.labels[i].box, TILE, 0.0));
        }
        camber_labels_free(&east);
        camber_labels_free(&west);
        free_placed(p);
    }
    close_town(t);
}

static void test_crowded_seam(void **state) {
    (void)state;
    town *t = open_town(EVERYTHING);
    add_crowd(t, 5, 1022.0, 640.0, false);
    add_outliers(t);
    placed_town *all = place_town(t, ALL_LEVEL, SIZE_MAX);
    placed_town *single = place_town(t, TILE_LEVEL, 0);
    const seam_faults east = compare_tiles(all, single, TILES - SHOWN, 16), west = compare_tiles(all, single, 0, 16);
    assert_true(east.shown > 300 && west.shown > 300);
    assert_int_equal(seam_count(&east), 0);
    assert_int_equal(seam_count(&west), 0);
    free_placed(single);
    free_placed(all);
    close_town(t);
}

/* ---- Order and ratio ---- */

static int compare_items(const void *a, const void *b) {
    return memcmp(&((const camber_label_item *)a)->x, &((const camber_label_item *)b)->x, 6 * sizeof(float));
}

static void test_shuffled(void **state) {
    (void)state;
    camber_labels labels[2];
    town *towns[2];
    placed_town *placed[2];
    for (int i = 0; i < 2; i++) {
        towns[i] = open_town(EVERYTHING);
        add_crowd(towns[i], 7, 384.0, 640.0, i == 1);
        placed[i] = place_town(towns[i], TILE_LEVEL, i ? 200 : 0);
        labels[i] = draw(placed[i], 12, 20, 1, 1.0);
        qsort(labels[i].items, labels[i].item_count, sizeof *labels[i].items, compare_items);
    }
    assert_true(labels[0].label_count > 20 && labels[0].label_count == labels[1].label_count);
    assert_int_equal(labels[0].item_count, labels[1].item_count);
    for (size_t i = 0; i < labels[0].item_count; i++)
        assert_memory_equal(&labels[0].items[i].x, &labels[1].items[i].x, 6 * sizeof(float));
    for (int i = 0; i < 2; i++) {
        camber_labels_free(labels + i);
        free_placed(placed[i]);
        close_town(towns[i]);
    }
}

/* Pictures of twice the ratio have the same labels at the same places. */
static void test_ratio(void **state) {
    (void)state;
    town *t = open_town(EVERYTHING);
    add_crowd(t, 9, 384.0, 640.0, false);
    placed_town *p = place_town(t, TILE_LEVEL, 0);
    camber_labels once = draw(p, 12, 20, 1, 1.0), twice = draw(p, 12, 20, 1, 2.0);
    assert_true(once.label_count > 20 && once.label_count == twice.label_count);
    assert_int_equal(once.item_count, twice.item_count);
    for (size_t i = 0; i < once.item_count; i++) {
        const camber_label_item *a = once.items + i, *b = twice.items + i;
        const float apart = a->icon ? 1.0f : 0.0f; /* images that keep their size are on whole px */
        assert_true(a->glyph == b->glyph && 2.0f * a->xx == b->xx);
        assert_true(fabsf(2.0f * a->x - b->x) <= apart && fabsf(2.0f * a->y - b->y) <= apart);
        assert_true(2.0f * once.looks[a->look].halo_width_px == twice.looks[b->look].halo_width_px);
    }
    camber_labels_free(&once);
    camber_labels_free(&twice);
    free_placed(p);
    close_town(t);
}

/* A label that reaches too far from its anchor to be settled by its surroundings is left out. */
static void test_too_long(void **state) {
    (void)state;
    town *t = open_town(NAMES("names", "\"text-size\":220,\"text-max-width\":100"));
    add_point(t, "Short", 300.0, 600.0);
    add_point(t, "A long, long n.", 500.0, 600.0);
    placed_town *p = place_town(t, ALL_LEVEL, SIZE_MAX);
    camber_labels labels = draw(p, 8, 16, SHOWN, 1.0);
    assert_int_equal(labels.label_count, 1);
    assert_int_equal(labels.labels[0].feature, 0);
    assert_non_null(strstr(t->last, "A long, long n. of layer names reaches more than 512 px"));
    camber_labels_free(&labels);
    strcpy(t->last, "");
    labels = draw(p, 8, 16, SHOWN, 1.0);
    assert_string_equal(t->last, ""); /* once */
    camber_labels_free(&labels);
    free_placed(p);
    close_town(t);
}

/* Pixels may reach farther than the shapes that labels take up. A halo that does is as if the label were too long; one
 * that is not seen does not count. */
static void test_too_wide(void **state) {
    (void)state;
    static const char *const halos[] = {"450", "600", "1e9", "1e9,\"text-halo-color\":\"rgba(0,0,0,0)\""};
    static const size_t shown[] = {1, 0, 0, 1};
    for (size_t i = 0; i < sizeof halos / sizeof *halos; i++) {
        char layers[256];
        snprintf(layers, sizeof layers,
                 "{\"id\":\"names\",\"type\":\"symbol\",\"layout\":{\"text-field\":[\"get\",\"name\"]},\"paint\":{"
                 "\"text-halo-color\":\"#fff\",\"text-halo-width\":%s}}",
                 halos[i]);
        town *t = open_town(layers);
        add_point(t, "Short", 300.0, 600.0);
        placed_town *p = place_town(t, ALL_LEVEL, SIZE_MAX);
        camber_labels labels = draw(p, 8, 16, SHOWN, 1.0);
        assert_int_equal(labels.label_count, shown[i]);
        camber_labels_free(&labels);
        free_placed(p);
        close_town(t);
    }
}

/* ---- Lists ---- */

static int compare_looks(const void *a, const void *b) {
    const uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return p < q ? -1 : p > q;
}

/* Any blocks list the same labels, and a label that has moved is another. */
static void test_list(void **state) {
    (void)state;
    static const size_t divided[] = {SIZE_MAX, 0, 150};
    static list lists[3];
    const camber_box world = {0.0, 0.0, 1.0, 1.0};
    town *t = open_town(EVERYTHING);
    add_crowd(t, 13, 384.0, 640.0, false);
    add_outliers(t);
    for (size_t i = 0; i < 3; i++) {
        placed_town *p = place_town(t, TILE_LEVEL, divided[i]);
        lists[i].count = 0;
        assert_int_equal(camber_zoom_labels_list(p->labels, &world, take, lists + i), CAMBER_OK);
        qsort(lists[i].looks, lists[i].count, sizeof *lists[i].looks, compare_looks);
        free_placed(p);
    }
    assert_true(lists[0].count > 100 && lists[0].count == lists[1].count && lists[0].count == lists[2].count);
    assert_memory_equal(lists[0].looks, lists[1].looks, lists[0].count * sizeof *lists[0].looks);
    assert_memory_equal(lists[0].looks, lists[2].looks, lists[0].count * sizeof *lists[0].looks);
    close_town(t);
}

/* Returns how the only label of a town looks whose text is made by this expression. */
static uint64_t look_of(const char *text) {
    static list l;
    const camber_box world = {0.0, 0.0, 1.0, 1.0};
    char layers[512];
    snprintf(layers, sizeof layers, "{\"id\":\"names\",\"type\":\"symbol\",\"layout\":{\"text-field\":%s}}", text);
    town *t = open_town(layers);
    add_point(t, "Name", 300.0, 600.0);
    placed_town *p = place_town(t, TILE_LEVEL, SIZE_MAX);
    l.count = 0;
    assert_int_equal(camber_zoom_labels_list(p->labels, &world, take, &l), CAMBER_OK);
    assert_int_equal(l.count, 1);
    free_placed(p);
    close_town(t);
    return l.looks[0];
}

/* A label whose words stay the same is another one if a section of its text looks different. */
static void test_sections(void **state) {
    (void)state;
    static const char *const texts[] = {
        "[\"format\",\"A\",{},\"b\",{}]",
        "[\"format\",\"A\",{},\"b\",{\"text-color\":\"#f00\"}]",
        "[\"format\",\"A\",{},\"b\",{\"text-color\":\"#00f\"}]",
        "[\"format\",\"A\",{},\"b\",{\"font-scale\":1.5}]",
        "[\"format\",\"A\",{},\"b\",{\"vertical-align\":\"top\"}]",
        "[\"format\",\"A\",{},\"b\",{\"text-font\":[\"literal\",[\"Noto Sans Bold\"]]}]",
    };
    enum { COUNT = sizeof texts / sizeof *texts };
    uint64_t looks[COUNT];
    for (size_t i = 0; i < COUNT; i++) {
        looks[i] = look_of(texts[i]);
        assert_true(looks[i] == look_of(texts[i]));
        for (size_t k = 0; k < i; k++)
            assert_true(looks[i] != looks[k]);
    }
}

/* Without memory placing fails, and leaves nothing behind. */
static void test_memory(void **state) {
    (void)state;
    town *t = open_town(EVERYTHING);
    add_crowd(t, 17, 384.0, 640.0, false);
    placed_town *p = place_town(t, TILE_LEVEL, 0);
    const camber_label_square square = {TILE_LEVEL, 12, 20};
    const camber_view view = {.x = 12.5 / TILES,
                              .y = 20.5 / TILES,
                              .zoom = ZOOM,
                              .scale_px = TILE * TILES,
                              .cosine = 1.0,
                              .ratio = 1.0,
                              .width = TILE,
                              .height = TILE};
    const uint64_t held = t->context->budget->held_bytes;
    camber_status status = CAMBER_ERROR_MEMORY;
    camber_labels labels;
    size_t failures = 0;
    for (uint64_t more = 0; status != CAMBER_OK; more += 4096 + more / 16) {
        camber_budget_allow(t->context->budget, held + more);
        status = camber_zoom_labels_draw(p->labels, &square, &view, &labels);
        assert_true(status == CAMBER_OK || status == CAMBER_ERROR_MEMORY);
        failures += status != CAMBER_OK;
        if (status != CAMBER_OK)
            camber_labels_free(&labels);
    }
    assert_true(failures > 10);
    camber_labels_free(&labels);
    free_placed(p);
    close_town(t);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tiles),    cmocka_unit_test(test_growth),       cmocka_unit_test(test_chains),
        cmocka_unit_test(test_few),      cmocka_unit_test(test_shelf),        cmocka_unit_test(test_tree),
        cmocka_unit_test(test_seam),     cmocka_unit_test(test_crowded_seam), cmocka_unit_test(test_shuffled),
        cmocka_unit_test(test_ratio),    cmocka_unit_test(test_too_long),     cmocka_unit_test(test_too_wide),
        cmocka_unit_test(test_sections), cmocka_unit_test(test_list),         cmocka_unit_test(test_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
