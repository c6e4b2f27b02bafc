/* Labels where tiles meet, of real cities and of a made-up country: each label's box is known, and labels that are cut,
 * doubled or missing at a tile's edge are counted. The truth is the whole zoom, placed at once; against it stand tiles
 * that are placed by themselves, as a server does, and in blocks, as an archive does.
 *
 * Which labels are in which tile is compared for all tiles, and what is drawn of them for a sample: of each zoom some
 * squares of 8 x 8 tiles are compared: those that most labels touch, and others evenly. They begin in the middle of
 * metatiles, so that the edges of these are inside. The last test counts faults of labels that each tile places for its
 * own view, to see that there are some.
 *
 * CAMBER_SEAM_SQUARES: how many squares of each zoom (2). CAMBER_SEAM_MILLIONS: points of the country (1.5). */
#include "core.h"
#include "label_seams.h"

#include "camber_map.h"
#include "features/features.h"
#include "style/style.h"

#include <math.h>
#include <unistd.h>

enum { FIRST_ZOOM = 6, LAST_ZOOM = 16, TILE = 256, SIDE = 8, MOST_SQUARES = 64 };

typedef struct map {
    camber_style *style;
    camber_features *features;
    camber_label_things things;
} map;

static const char *data_folder(void) {
    const char *folder = getenv("CAMBER_DATA");
    return folder && folder[0] ? folder : NULL;
}

static double number_of(const char *variable, double otherwise) {
    const char *text = getenv(variable);
    return text && text[0] ? atof(text) : otherwise;
}

static map open_map(camber_context *context, const char *path, const char *style) {
    map m = {0};
    size_t size;
    const char *text = camber_style_get_text(style, CAMBER_THEME_LIGHT, &size);
    const camber_source_desc source = {.path = path};
    assert_int_equal(camber_style_parse(context, text, size, style, &m.style), CAMBER_OK);
    assert_int_equal(camber_features_create(context, m.style, &m.features), CAMBER_OK);
    assert_int_equal(camber_features_read_fonts(m.features, &(camber_fonts_desc){.no_system = true}, NULL), CAMBER_OK);
    assert_int_equal(camber_features_read(m.features, &source), CAMBER_OK);
    assert_int_equal(camber_label_things_find(m.features, NULL, &m.things), CAMBER_OK);
    return m;
}

static void close_map(map *m) {
    camber_label_things_free(&m->things);
    camber_features_destroy(m->features);
    camber_style_destroy(m->style);
}

/* ---- Labels of a zoom ---- */

typedef struct placed {
    int zoom, finest_level;
    camber_label_shelf shelf;
    camber_zoom_labels *labels;
} placed;

/* finest_level: of the squares that are drawn. block_things: as in camber_zoom_labels_desc. */
static void place(map *m, int zoom, int finest_level, size_t block_things, placed *p) {
    *p = (placed){.zoom = zoom, .finest_level = finest_level, .shelf.limit_bytes = (size_t)24 << 20};
    const camber_zoom_labels_desc desc = {.features = m->features,
                                          .things = &m->things,
                                          .shelf = &p->shelf,
                                          .zoom = zoom - 1.0,
                                          .finest_level = finest_level,
                                          .block_things = block_things};
    assert_int_equal(camber_zoom_labels_create(&desc, &p->labels), CAMBER_OK);
}

static camber_view view_of(int zoom, double column, double row, uint32_t side) {
    const double across = exp2(zoom);
    return (camber_view){.x = (column + 0.5 * side) / across,
                         .y = (row + 0.5 * side) / across,
                         .zoom = zoom - 1.0,
                         .scale_px = TILE * across,
                         .cosine = 1.0,
                         .ratio = 1.0,
                         .width = TILE * side,
                         .height = TILE * side};
}

static void draw(const placed *p, uint32_t column, uint32_t row, uint32_t side, camber_labels *labels) {
    const camber_label_square square = {p->finest_level, column >> (p->zoom - p->finest_level),
                                        row >> (p->zoom - p->finest_level)};
    const camber_view view = view_of(p->zoom, column, row, side);
    assert_int_equal(camber_zoom_labels_draw(p->labels, &square, &view, labels), CAMBER_OK);
}

/* ---- Which squares are compared ---- */

typedef struct touched {
    uint32_t column, row; /* of its first tile */
    size_t labels;
} touched;

typedef struct touched_list {
    int zoom;
    touched *items;
    size_t count, capacity;
} touched_list;

/* Notes in which square a label begins. */
static camber_status take(void *user, const camber_label_square *block, const camber_shown_label *label) {
    (void)block;
    touched_list *list = user;
    const double across = exp2(list->zoom), most = across - SIDE, half = 0.5 * SIDE;
    const double x = floor((label->box.x0 * across - half) / SIDE) * SIDE + half;
    const double y = floor((label->box.y0 * across - half) / SIDE) * SIDE + half;
    const uint32_t column = (uint32_t)fmin(fmax(x, 0.0), most), row = (uint32_t)fmin(fmax(y, 0.0), most);
    for (size_t i = 0; i < list->count; i++)
        if (list->items[i].column == column && list->items[i].row == row) {
            list->items[i].labels++;
            return CAMBER_OK;
        }
    if (list->count == list->capacity) {
        list->capacity = 2 * list->capacity + 64;
        list->items = realloc(list->items, list->capacity * sizeof *list->items);
        assert_non_null(list->items);
    }
    list->items[list->count++] = (touched){column, row, 1};
    return CAMBER_OK;
}

static int fuller(const void *a, const void *b) {
    const touched *p = a, *q = b;
    if (p->labels != q->labels)
        return p->labels > q->labels ? -1 : 1;
    return p->column != q->column ? (p->column < q->column ? -1 : 1) : p->row < q->row ? -1 : p->row > q->row;
}

/* ---- All tiles ---- */

typedef struct shown_pair {
    uint64_t tile, appearance;
} shown_pair;

typedef struct shown_list {
    int zoom;
    shown_pair *items;
    size_t count, capacity;
} shown_list;

/* Notes each tile of a block that a label touches. */
static camber_status take_tiles(void *user, const camber_label_square *block, const camber_shown_label *label) {
    shown_list *list = user;
    const double across = exp2(list->zoom), size = exp2(list->zoom - block->level);
    const double left = block->column * size, top = block->row * size;
    for (double y = fmax(floor(label->box.y0 * across), top); y < fmin(ceil(label->box.y1 * across), top + size); y++)
        for (double x = fmax(floor(label->box.x0 * across), left); x < fmin(ceil(label->box.x1 * across), left + size);
             x++) {
            if (list->count == list->capacity) {
                list->capacity = 2 * list->capacity + 1024;
                list->items = realloc(list->items, list->capacity * sizeof *list->items);
                assert_non_null(list->items);
            }
            list->items[list->count++] = (shown_pair){(uint64_t)y << 32 | (uint64_t)x, label->appearance};
        }
    return CAMBER_OK;
}

static int compare_pairs(const void *a, const void *b) {
    const shown_pair *p = a, *q = b;
    return p->tile != q->tile              ? (p->tile < q->tile ? -1 : 1)
           : p->appearance < q->appearance ? -1
                                           : p->appearance > q->appearance;
}

static shown_list list_all(const placed *p) {
    static const camber_box world = {0.0, 0.0, 1.0, 1.0};
    shown_list list = {.zoom = p->zoom};
    assert_int_equal(camber_zoom_labels_list(p->labels, &world, take_tiles, &list), CAMBER_OK);
    if (list.count)
        qsort(list.items, list.count, sizeof *list.items, compare_pairs);
    return list;
}

/* Counts the labels in all tiles of a zoom as blocks have them, and those that the whole zoom has otherwise. */
static void compare_lists(const placed *whole, const placed *blocks, size_t *shown, size_t *wrong) {
    shown_list a = list_all(whole), b = list_all(blocks);
    size_t i = 0, k = 0;
    while (i < a.count || k < b.count) {
        const int order = i == a.count ? 1 : k == b.count ? -1 : compare_pairs(a.items + i, b.items + k);
        *wrong += order != 0;
        i += order <= 0;
        k += order >= 0;
    }
    *shown += b.count;
    free(a.items);
    free(b.items);
}

/* ---- Comparing ---- */

typedef struct parts {
    const char *name;
    seam_faults faults;
} parts;

enum { BY_TILE, BY_PAIR, BY_BLOCK, WAYS };

/* Compares a square of tiles, in an odd order, with the same part of the whole zoom. */
static void compare_square(const placed *whole, const placed *ways, const touched *at, parts *found) {
    camber_labels all, part;
    draw(whole, at->column, at->row, SIDE, &all);
    for (uint32_t way = 0; way < WAYS; way++)
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            const uint32_t n = i * 37 % (SIDE * SIDE), x = n % SIDE, y = n / SIDE;
            draw(ways + way, at->column + x, at->row + y, 1, &part);
            seam_compare(&all, &part, (camber_box){x * TILE, y * TILE, (x + 1) * TILE, (y + 1) * TILE},
                         &found[way].faults);
            camber_labels_free(&part);
        }
    camber_labels_free(&all);
}

static void compare_zoom(map *m, int zoom, parts *found, size_t *shown, size_t *wrong) {
    static const camber_box world = {0.0, 0.0, 1.0, 1.0};
    const size_t most = (size_t)fmin(number_of("CAMBER_SEAM_SQUARES", 2.0), MOST_SQUARES);
    placed whole, ways[WAYS];
    touched_list list = {.zoom = zoom};
    place(m, zoom, 0, SIZE_MAX, &whole);
    place(m, zoom, zoom, 0, ways + BY_TILE);
    place(m, zoom, zoom - 1, 0, ways + BY_PAIR);
    place(m, zoom, zoom - 3, 2000, ways + BY_BLOCK);
    assert_int_equal(camber_zoom_labels_list(whole.labels, &world, take, &list), CAMBER_OK);
    if (list.count)
        qsort(list.items, list.count, sizeof *list.items, fuller);
    for (size_t i = 0; i < most && i < list.count; i++)
        compare_square(&whole, ways, list.items + (list.count <= most ? i : i * list.count / most), found);
    free(list.items);
    compare_lists(&whole, ways + BY_BLOCK, shown, wrong);
    for (int way = 0; way < WAYS; way++)
        camber_zoom_labels_destroy(ways[way].labels);
    camber_zoom_labels_destroy(whole.labels);
}

static void check_map(const char *name, const char *path, const char *style, size_t expected) {
    parts found[WAYS] = {{.name = "a tile"}, {.name = "2 x 2 tiles"}, {.name = "a block"}};
    size_t shown = 0, wrong = 0;
    host h;
    camber_context *context = host_context(&h);
    map m = open_map(context, path, style);
    for (int zoom = FIRST_ZOOM; zoom <= LAST_ZOOM; zoom++)
        compare_zoom(&m, zoom, found, &shown, &wrong);
    close_map(&m);
    host_done(&h, context);
    printf("# %s, %s: %zu labels in all tiles, %zu of them otherwise in the whole zoom\n", name, style, shown, wrong);
    assert_true(shown > expected);
    assert_int_equal(wrong, 0);
    for (int way = 0; way < WAYS; way++) {
        const seam_faults *f = &found[way].faults;
        printf("# %s, %s, placed by %s: %zu labels in tiles, %zu cross a border: %zu cut, %zu doubled, %zu missing, "
               "%zu of no picture\n",
               name, style, found[way].name, f->shown, f->crossing, f->cut, f->doubled, f->missing, f->extra);
        assert_true(f->shown > expected / 4 && f->crossing > expected / 10);
        assert_int_equal(seam_count(f), 0);
    }
}

static void test_city(const char *name, const char *file, bool has_transit) {
    char path[1024];
    snprintf(path, sizeof path, "%s/data/%s", data_folder(), file);
    check_map(name, path, "city", 600);
    check_map(name, path, "roads", 100);
    if (has_transit)
        check_map(name, path, "transit", 100);
}

static void test_porto(void **state) {
    (void)state;
    test_city("Porto", "porto_portugal.osm.pbf", false);
}

static void test_new_york(void **state) {
    (void)state;
    test_city("New York", "nyc.osm.pbf", true);
}

/* Vector tiles, which cut streets: their parts are joined before they are named. */
static void test_vector_tiles(void **state) {
    (void)state;
    char path[1024];
    snprintf(path, sizeof path, "%s/data/osm.mbtiles", data_folder());
    check_map("Santa Cruz", path, "city", 300);
}

/* Vector tiles of OpenMapTiles, which tilemaker makes by the profile that Debian's package has. */
static void test_openmaptiles(void **state) {
    (void)state;
    static const char profile[] = "/usr/share/doc/tilemaker/examples/";
    char folder[64], path[96], command[4096];
    snprintf(command, sizeof command, "%sconfig-openmaptiles.json", profile);
    if (access(command, R_OK) != 0 || system("command -v tilemaker > /dev/null") != 0) {
        puts("# no tiles of OpenMapTiles: tilemaker is not installed (Debian: tilemaker)");
        return;
    }
    folder_make(folder);
    snprintf(path, sizeof path, "%s/porto.mbtiles", folder);
    snprintf(command, sizeof command,
             "tilemaker --input '%s/data/porto_portugal.osm.pbf' --output '%s' --config %sconfig-openmaptiles.json "
             "--process %sprocess-openmaptiles.lua > '%s/log' 2>&1",
             data_folder(), path, profile, profile, folder);
    assert_int_equal(system(command), 0);
    check_map("Porto's tiles", path, "openmaptiles", 3000);
    folder_remove(folder);
}

/* ---- The made-up country ---- */

static void test_country(void **state) {
    (void)state;
    static const char *const cities[] = {"porto_portugal", "liechtenstein-latest", "columbus"};
    char folder[64], path[96], command[4096];
    if (access(CAMBER_COUNTRY, X_OK) != 0) {
        puts("# no country: the benchmark is not built, or not with libosmium");
        return;
    }
    folder_make(folder);
    snprintf(path, sizeof path, "%s/country.osm.pbf", folder);
    int length =
        snprintf(command, sizeof command, "'%s' '%s' %g", CAMBER_COUNTRY, path, number_of("CAMBER_SEAM_MILLIONS", 1.5));
    for (size_t i = 0; i < sizeof cities / sizeof *cities; i++)
        length += snprintf(command + length, sizeof command - (size_t)length, " '%s/data/%s.osm.pbf'", data_folder(),
                           cities[i]);
    assert_int_equal(system(command), 0);
    check_map("the country", path, "city", 3000);
    folder_remove(folder);
}

/* ---- That there can be faults ---- */

/* Each tile places the labels of its own view, as servers do that know no more. */
static void test_views(void **state) {
    (void)state;
    enum { ZOOM = 15 };
    static const camber_box world = {0.0, 0.0, 1.0, 1.0};
    char path[1024];
    snprintf(path, sizeof path, "%s/data/porto_portugal.osm.pbf", data_folder());
    host h;
    camber_context *context = host_context(&h);
    map m = open_map(context, path, "city");
    touched_list list = {.zoom = ZOOM};
    seam_faults f = {0};
    camber_labels all, part;
    placed whole;
    place(&m, ZOOM, 0, SIZE_MAX, &whole);
    assert_int_equal(camber_zoom_labels_list(whole.labels, &world, take, &list), CAMBER_OK);
    qsort(list.items, list.count, sizeof *list.items, fuller);
    draw(&whole, list.items->column, list.items->row, SIDE, &all);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const uint32_t x = i % SIDE, y = i / SIDE;
        const camber_view view = view_of(ZOOM, list.items->column + x, list.items->row + y, 1);
        assert_int_equal(camber_labels_place(m.features, &view, m.features->fonts, m.features->sprites, &part),
                         CAMBER_OK);
        seam_compare(&all, &part, (camber_box){x * TILE, y * TILE, (x + 1) * TILE, (y + 1) * TILE}, &f);
        camber_labels_free(&part);
    }
    printf("# placed for the view of each tile: %zu labels: %zu cut, %zu missing, %zu of no picture\n", f.shown, f.cut,
           f.missing, f.extra);
    assert_true(f.missing > f.shown / 4);
    camber_labels_free(&all);
    free(list.items);
    camber_zoom_labels_destroy(whole.labels);
    close_map(&m);
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_porto),        cmocka_unit_test(test_new_york),
                                       cmocka_unit_test(test_vector_tiles), cmocka_unit_test(test_openmaptiles),
#ifdef CAMBER_COUNTRY
                                       cmocka_unit_test(test_country),
#endif
                                       cmocka_unit_test(test_views)};
    if (!data_folder()) {
        printf("CAMBER_DATA names no folder; skipped\n");
        return 77;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
