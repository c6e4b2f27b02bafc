/* The styles that ship: each layer by itself draws what it is for and nothing else, and all of them in their order. */
#include "map_picture.h"
#include "tilemaker.h"

#include <jansson.h>
#include <math.h>
#include <unistd.h>

/* A picture of one tile's middle: lines from west to east, one under the other. */
enum { ZOOM = 15, WIDE = 96, HIGH = 1024, EXTENT = 4096, TILE_ZOOM = 14, MIDDLE = 1 << (TILE_ZOOM - 1) };

/* A feature in tiles of the schema. */
typedef struct thing {
    const char *name, *layer, *tags;
} thing;

static const thing things[] = {
    {"motorway", "transportation", "class=motorway oneway=1"},
    {"ramp", "transportation", "class=motorway ramp=1"},
    {"trunk", "transportation", "class=trunk"},
    {"primary", "transportation", "class=primary"},
    {"secondary", "transportation", "class=secondary"},
    {"tertiary", "transportation", "class=tertiary"},
    {"minor", "transportation", "class=minor"},
    {"ford", "transportation", "class=minor brunnel=ford"},
    {"service", "transportation", "class=service"},
    {"raceway", "transportation", "class=raceway"},
    {"viaduct", "transportation", "class=motorway brunnel=bridge"},
    {"overpass", "transportation", "class=minor brunnel=bridge"},
    {"underpass", "transportation", "class=primary brunnel=tunnel"},
    {"high-bridge", "transportation", "class=minor brunnel=bridge layer=2"},
    {"works", "transportation", "class=primary_construction"},
    {"path", "transportation", "class=path"},
    {"footbridge", "transportation", "class=path brunnel=bridge"},
    {"subway-path", "transportation", "class=path brunnel=tunnel"},
    {"track", "transportation", "class=track"},
    {"track-bridge", "transportation", "class=track brunnel=bridge"},
    {"rail", "transportation", "class=rail"},
    {"siding", "transportation", "class=rail service=siding"},
    {"rail-bridge", "transportation", "class=rail brunnel=bridge"},
    {"rail-tunnel", "transportation", "class=rail brunnel=tunnel"},
    {"transit", "transportation", "class=transit"},
    {"tram", "transportation", "class=tram"},
    {"tram-bridge", "transportation", "class=tram brunnel=bridge"},
    {"subway", "transportation", "class=transit brunnel=tunnel"},
    {"ferry", "transportation", "class=ferry"},
    {"pier", "transportation", "class=pier"},
    {"gondola", "transportation", "class=gondola"},
    {"river", "waterway", "class=river"},
    {"stream", "waterway", "class=stream"},
    {"ditch", "waterway", "class=ditch intermittent=1"},
    {"culvert", "waterway", "class=stream brunnel=tunnel"},
    {"country", "boundary", "admin_level=2 disputed=0 maritime=0"},
    {"disputed", "boundary", "admin_level=2 disputed=1"},
    {"state", "boundary", "admin_level=4 disputed=0"},
    {"town", "boundary", "admin_level=8"},
    {"quarter", "boundary", "admin_level=10"},
    {"sea", "boundary", "admin_level=2 maritime=1"},
    {"unlevelled", "boundary", "disputed=0"},
    {"runway", "aeroway", "class=runway"},
    {"taxiway", "aeroway", "class=taxiway"},
    {"apron", "aeroway", "class=apron"},
    {"name", "transportation_name", "class=motorway"},
};
enum { THINGS = sizeof things / sizeof *things };

/* The features of these that each layer draws. */
typedef struct drawn_by {
    const char *id, *draws;
} drawn_by;

static const drawn_by layers[] = {
    {"tiles-boundary-border-local", "town"},
    {"tiles-waterway-river", "river stream ditch"},
    {"tiles-transportation-pier-line", "pier"},
    {"tiles-aeroway-runway-line", "runway taxiway"},
    {"tiles-transportation-ferry-line", "ferry"},
    {"tiles-boundary-border-band", "country disputed"},
    {"tiles-boundary-border", "country disputed state"},
    {"tiles-transportation-works-line", "works"},
    {"tiles-transportation-tunnel-casing", "underpass"},
    {"tiles-transportation-tunnel-fill", "underpass"},
    {"tiles-transportation-ground-path", "path track"},
    {"tiles-transportation-ground-casing", "motorway ramp trunk primary secondary tertiary minor ford service raceway"},
    {"tiles-transportation-ground-fill", "motorway ramp trunk primary secondary tertiary minor ford service raceway"},
    {"tiles-transportation-rail", "rail siding transit tram"},
    {"tiles-transportation-rail-ties", "rail"},
    {"tiles-transportation-bridge-path-edge", "footbridge track-bridge"},
    {"tiles-transportation-bridge-path-bed", "footbridge track-bridge"},
    {"tiles-transportation-bridge-path", "footbridge track-bridge"},
    {"tiles-transportation-bridge-casing", "viaduct overpass"},
    {"tiles-transportation-bridge-fill", "viaduct overpass"},
    {"tiles-transportation-bridge-rail-edge", "rail-bridge tram-bridge"},
    {"tiles-transportation-bridge-rail-bed", "rail-bridge tram-bridge"},
    {"tiles-transportation-bridge-rail", "rail-bridge tram-bridge"},
    {"tiles-transportation-bridge-rail-ties", "rail-bridge"},
    {"tiles-transportation-bridge-2-path-edge", ""},
    {"tiles-transportation-bridge-2-path-bed", ""},
    {"tiles-transportation-bridge-2-path", ""},
    {"tiles-transportation-bridge-2-casing", "high-bridge"},
    {"tiles-transportation-bridge-2-fill", "high-bridge"},
    {"tiles-transportation-bridge-2-rail-edge", ""},
    {"tiles-transportation-bridge-2-rail-bed", ""},
    {"tiles-transportation-bridge-2-rail", ""},
    {"tiles-transportation-bridge-2-rail-ties", ""},
    {"tiles-transportation-lift-line", "gondola"},
    {"tiles-transportation-lift-line-ties", "gondola"},
};
enum { LAYERS = sizeof layers / sizeof *layers };

/* The same of lines of public transport, and of the map below them. */
static const thing lines[] = {
    {"subway", NULL, "mode=subway colour=#ff0000 tunnel=true"},
    {"tram", NULL, "mode=tram colour=green"},
    {"tram-tunnel", NULL, "mode=tram tunnel=true"},
    {"train", NULL, "mode=train colour=none"},
    {"works", NULL, "mode=subway colour=blue state=construction tunnel=true"},
    {"bus", NULL, "mode=bus"},
    {"trolleybus", NULL, "mode=trolleybus"},
    {"ferry", NULL, "mode=ferry"},
    {"river", NULL, "waterway=river"},
    {"street", NULL, "highway=secondary"},
};
enum { LINES = sizeof lines / sizeof *lines };

static const drawn_by line_layers[] = {
    {"base-river", "river"},
    {"base-street", "street"},
    {"ferry", "ferry"},
    {"bus-casing", "bus trolleybus"},
    {"bus", "bus trolleybus"},
    {"works-casing", "works"},
    {"works", "works"},
    {"casing", "subway tram tram-tunnel train"},
    {"line", "subway tram tram-tunnel train"},
    {"tunnel", "tram-tunnel"},
};
enum { LINE_LAYERS = sizeof line_layers / sizeof *line_layers };

static bool is_in(const char *name, const char *list) {
    const size_t length = strlen(name);
    for (const char *at = list; (at = strstr(at, name)) != NULL; at += length)
        if ((at == list || at[-1] == ' ') && (at[length] == 0 || at[length] == ' '))
            return true;
    return false;
}

/* ---- Tiles ---- */

/* "a=1 b=text" as keys and values of the layer, which has none yet but those of other features. */
static void put_tags(blob *layer, const char *tags, uint32_t *next, blob *words) {
    char copy[128], *save = NULL;
    snprintf(copy, sizeof copy, "%s", tags);
    for (char *tag = strtok_r(copy, " ", &save); tag; tag = strtok_r(NULL, " ", &save)) {
        char *value = strchr(tag, '=');
        *value++ = 0;
        put_key(layer, tag);
        if (*value >= '0' && *value <= '9') {
            blob number = {0};
            put_number(&number, 4, (uint64_t)atoi(value));
            put_message(layer, 4, &number);
        } else {
            put_text_value(layer, value);
        }
        put_varint(words, *next);
        put_varint(words, (*next)++);
    }
}

static void put_thing(blob *layer, const thing *it, const int units[4], uint32_t *next) {
    uint32_t words[16];
    int cursor[2] = {0, 0};
    blob feature = {0}, tags = {0};
    put_tags(layer, it->tags, next, &tags);
    put_message(&feature, 2, &tags);
    put_number(&feature, 3, 2);
    put_packed(&feature, 4, words, add_path(words, 0, units, 2, false, cursor));
    put_message(layer, 2, &feature);
}

static void make_folder(char folder[32], char path[64]) {
    snprintf(folder, 32, "/tmp/camber-test-XXXXXX");
    assert_non_null(mkdtemp(folder));
    snprintf(path, 64, "%s/map.mbtiles", folder);
}

static void remove_folder(const char *folder, const char *path) {
    unlink(path);
    rmdir(folder);
}

/* A set of one tile; units: the ends of each thing's line. */
static void write_tiles(const char *path, const thing *list, size_t count, int (*units)[4]) {
    static const char *const names[] = {"transportation", "waterway", "boundary", "aeroway", "transportation_name"};
    blob tile = {0};
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        blob layer = begin_layer(names[n], EXTENT);
        uint32_t next = 0;
        for (size_t i = 0; i < count; i++)
            if (strcmp(list[i].layer, names[n]) == 0)
                put_thing(&layer, list + i, units[i], &next);
        put_layer(&tile, &layer);
    }
    made_tile made = {TILE_ZOOM, MIDDLE, MIDDLE, gzip_of(&tile)};
    unlink(path);
    assert_true(write_mbtiles(path, &made, 1, "INSERT INTO metadata VALUES ('format', 'pbf'), ('maxzoom', '14');"));
    blob_free(&made.content);
    blob_free(&tile);
}

/* ---- Drawing ---- */

static json_t *style_of(const char *name, camber_theme theme) {
    size_t size_bytes;
    const char *text = camber_style_get_text(name, theme, &size_bytes);
    assert_non_null(text);
    json_t *style = json_loadb(text, size_bytes, 0, NULL);
    assert_non_null(style);
    return style;
}

static void set_tiles(json_t *style, const char *path) {
    json_t *source = json_object_get(json_object_get(style, "sources"), "openmaptiles");
    json_object_set_new(source, "url", json_sprintf("mbtiles://%s", path));
}

static picture draw(fixture *s, json_t *json, double zoom, uint32_t width, uint32_t height) {
    camber_style *style = NULL;
    char *text = json_dumps(json, JSON_COMPACT);
    if (camber_style_parse(s->context, text, strlen(text), "shipped", &style) != CAMBER_OK)
        fail_msg("%s", s->h.last);
    free(text);
    /* The tile is the one south-east of 0, 0; half of it is 0.0109863 degrees. */
    const double half = 360.0 / (1 << TILE_ZOOM) / 2;
    const camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_CENTER,
                                             .longitude = half,
                                             .latitude = -half,
                                             .zoom = zoom,
                                             .width = width,
                                             .height = height}};
    map m = map_open(s, style, &desc);
    picture p = map_draw(s, &m);
    assert_non_null(strstr(camber_features_get_attribution(m.features), "OpenStreetMap")); /* the sources say so */
    map_close(&m);
    return p;
}

/* ---- Each layer by itself ---- */

/* The row of one of so many lines. */
static uint32_t row_of(size_t number, size_t count) {
    return (uint32_t)(((double)number + 0.5) * HIGH / (double)count);
}

static json_t *layer_of(json_t *style, const char *id) {
    size_t i;
    json_t *layer;
    json_array_foreach(json_object_get(style, "layers"), i, layer) {
        if (strcmp(json_string_value(json_object_get(layer, "id")), id) == 0)
            return layer;
    }
    fail_msg("no layer %s", id);
    return NULL;
}

/* The pixels of a row that are covered, of WIDE. */
static uint32_t covered(const picture *p, uint32_t y) {
    uint32_t count = 0;
    for (uint32_t x = 0; x < p->width; x++)
        count += picture_value(p, x, y, 3) > 0.2;
    return count;
}

/* A style with data of things, each in its row. */
typedef struct rows {
    json_t *style;
    const thing *things;
    size_t count;
} rows;

static void check_layer(fixture *s, const rows *all, const drawn_by *expected) {
    json_t *one = json_deep_copy(all->style);
    json_t *layer = json_incref(layer_of(one, expected->id));
    const bool dashed = json_object_get(json_object_get(layer, "paint"), "line-dasharray") != NULL;
    json_object_set_new(one, "layers", json_pack("[o]", layer));
    picture p = draw(s, one, ZOOM, WIDE, HIGH);
    for (size_t i = 0; i < all->count; i++) {
        const uint32_t count = covered(&p, row_of(i, all->count));
        const bool wanted = is_in(all->things[i].name, expected->draws);
        if (wanted && (count == 0 || dashed != (count < WIDE)))
            fail_msg("%s: %s: %u of %u pixels", expected->id, all->things[i].name, count, WIDE);
        if (!wanted && count)
            fail_msg("%s: draws %s", expected->id, all->things[i].name);
    }
    free(p.rgba);
    json_decref(one);
}

/* All layers of lines stand in the table. */
static void check_layers(fixture *s, const rows *all, const drawn_by *expected, size_t count) {
    size_t i, line_count = 0;
    json_t *layer;
    json_array_foreach(json_object_get(all->style, "layers"), i, layer) {
        line_count += strcmp(json_string_value(json_object_get(layer, "type")), "line") == 0;
    }
    assert_int_equal(line_count, count);
    for (i = 0; i < count; i++)
        check_layer(s, all, expected + i);
}

static void write_sheet(const char *path) {
    int units[THINGS][4];
    for (size_t i = 0; i < THINGS; i++) {
        const int y = (int)((row_of(i, THINGS) + 0.5) * EXTENT / HIGH);
        memcpy(units[i], (int[]){0, y, EXTENT, y}, sizeof units[i]);
    }
    write_tiles(path, things, THINGS, units);
}

static void test_layers(void **state) {
    fixture *s = *state;
    char folder[32], path[64];
    make_folder(folder, path);
    write_sheet(path);
    for (int theme = 0; theme < 2; theme++) {
        json_t *style = style_of("openmaptiles", theme ? CAMBER_THEME_DARK : CAMBER_THEME_LIGHT);
        set_tiles(style, path);
        check_layers(s, &(rows){style, things, THINGS}, layers, LAYERS);
        json_decref(style);
    }
    remove_folder(folder, path);
}

/* "a=1 b=text c=true" as properties. */
static json_t *properties_of(const char *tags) {
    char copy[128], *save = NULL;
    json_t *properties = json_object();
    snprintf(copy, sizeof copy, "%s", tags);
    for (char *tag = strtok_r(copy, " ", &save); tag; tag = strtok_r(NULL, " ", &save)) {
        char *value = strchr(tag, '=');
        *value++ = 0;
        const bool number = strcmp(tag, "slot") == 0;
        json_object_set_new(properties, tag,
                            number                       ? json_real(atof(value))
                            : strcmp(value, "true") == 0 ? json_true()
                                                         : json_string(value));
    }
    return properties;
}

/* GeoJSON in place of the file, each line in its row of the picture. */
static void set_lines(json_t *style, const thing *list, size_t count) {
    json_t *features = json_array();
    const double degrees = 360.0 / (1 << TILE_ZOOM);
    for (size_t i = 0; i < count; i++) {
        const double latitude = -(row_of(i, count) + 0.5) / HIGH * degrees;
        json_array_append_new(features, json_pack("{ss, so, s{ss, s[[ff], [ff]]}}", "type", "Feature", "properties",
                                                  properties_of(list[i].tags), "geometry", "type", "LineString",
                                                  "coordinates", 0.0, latitude, degrees, latitude));
    }
    json_t *source = json_object_get(json_object_get(style, "sources"), "transit");
    json_object_set_new(source, "data", json_pack("{ss, so}", "type", "FeatureCollection", "features", features));
}

static void test_line_layers(void **state) {
    fixture *s = *state;
    for (int theme = 0; theme < 2; theme++) {
        json_t *style = style_of("transit", theme ? CAMBER_THEME_DARK : CAMBER_THEME_LIGHT);
        set_lines(style, lines, LINES);
        check_layers(s, &(rows){style, lines, LINES}, line_layers, LINE_LAYERS);
        json_decref(style);
    }
}

/* Lines have their own colours, and those without one, or with one that is none, the style's. */
static void test_line_colors(void **state) {
    fixture *s = *state;
    json_t *style = style_of("transit", CAMBER_THEME_LIGHT);
    set_lines(style, lines, LINES);
    picture p = draw(s, style, ZOOM, WIDE, HIGH);
    const uint32_t red = row_of(0, LINES), green = row_of(1, LINES), plain = row_of(3, LINES);
    assert_true(picture_value(&p, WIDE / 2, red, 0) > 0.99 && picture_value(&p, WIDE / 2, red, 1) < 0.01);
    assert_float_equal(picture_value(&p, WIDE / 2, green, 1), 128.0 / 255, 0.01);
    assert_true(picture_value(&p, WIDE / 2, green, 0) < 0.01);
    for (int c = 0; c < 3; c++) /* grey */
        assert_float_equal(picture_value(&p, WIDE / 2, plain, c), 0.4, 0.06);
    free(p.rgba);
    json_decref(style);
}

/* Lines of one street lie beside each other, from the left of their direction to its right. */
static void test_slots(void **state) {
    fixture *s = *state;
    static const thing street[] = {
        {"left", NULL, "mode=tram colour=#f00 slot=-1"},
        {"middle", NULL, "mode=tram colour=#0f0 slot=0"},
        {"right", NULL, "mode=tram colour=#00f slot=1"},
    };
    json_t *style = style_of("transit", CAMBER_THEME_LIGHT);
    json_t *all = json_array(), *source = json_object_get(json_object_get(style, "sources"), "transit");
    set_lines(style, street, 1); /* its features are in the middle of the picture */
    json_t *place =
        json_object_get(json_array_get(json_object_get(json_object_get(source, "data"), "features"), 0), "geometry");
    for (size_t i = 0; i < 3; i++)
        json_array_append_new(all, json_pack("{ss, so, sO}", "type", "Feature", "properties",
                                             properties_of(street[i].tags), "geometry", place));
    json_object_set_new(source, "data", json_pack("{ss, so}", "type", "FeatureCollection", "features", all));
    for (int backwards = 0; backwards < 2; backwards++) {
        picture p = draw(s, style, ZOOM, WIDE, HIGH);
        /* 6 px from middle to middle at zoom 15, and a pixel of the casing between. */
        for (int slot = -1; slot <= 1; slot++)
            for (int c = 0; c < 3; c++)
                assert_float_equal(picture_value(&p, WIDE / 2, (uint32_t)(HIGH / 2 + 6 * slot), c),
                                   (float)(c == (backwards ? 1 - slot : 1 + slot)), 0.02);
        for (int c = 0; c < 3; c++) {
            assert_true(picture_value(&p, WIDE / 2, HIGH / 2 - 3, c) > 0.3);
            assert_true(picture_value(&p, WIDE / 2, HIGH / 2 - 10, c) > 0.95); /* the casing's edge */
        }
        free(p.rgba);
        json_t *ends = json_object_get(place, "coordinates"), *first = json_incref(json_array_get(ends, 0));
        json_array_remove(ends, 0);
        json_array_append_new(ends, first);
    }
    json_decref(style);
}

/* ---- All layers ---- */

/* Whether two pixels have one colour. */
static bool same(const picture *p, uint32_t x, uint32_t y, uint32_t other_x, uint32_t other_y) {
    for (int c = 0; c < 3; c++)
        if (fabs(picture_value(p, x, y, c) - picture_value(p, other_x, other_y, c)) > 2.5 / 255)
            return false;
    return true;
}

/* Lines that cross in the middle of the picture: an upper line from west to east, a lower one from north to south. */
static const struct {
    const char *upper, *lower;
} crossings[] = {
    {"viaduct", "motorway"},    {"overpass", "primary"}, {"overpass", "rail"},     {"minor", "underpass"},
    {"primary", "secondary"},   {"motorway", "trunk"},   {"minor", "path"},        {"service", "river"},
    {"rail", "minor"},          {"minor", "state"},      {"rail-bridge", "river"}, {"tram-bridge", "viaduct"},
    {"high-bridge", "viaduct"}, {"primary", "ramp"},     {"minor", "ramp"},
};

static const thing *find_thing(const char *name) {
    for (size_t i = 0; i < THINGS; i++)
        if (strcmp(things[i].name, name) == 0)
            return things + i;
    fail_msg("no thing %s", name);
    return NULL;
}

/* The column through the middle has the upper line's colours where the lines cross, as elsewhere along it. */
static void check_crossing(fixture *s, json_t *style, const char *path, size_t number) {
    enum { SIDE = 256, REACH = 64 };
    const thing both[] = {*find_thing(crossings[number].upper), *find_thing(crossings[number].lower)};
    int units[2][4] = {{0, EXTENT / 2, EXTENT, EXTENT / 2}, {EXTENT / 2, 0, EXTENT / 2, EXTENT}};
    write_tiles(path, both, 2, units);
    picture p = draw(s, style, 17, SIDE, SIDE);
    const uint32_t middle = SIDE / 2;
    /* Dashes and ties are not the same everywhere: any place along the line will do. */
    bool found = false, is_seen = false, lower_seen = false;
    for (uint32_t x = REACH / 4; x < REACH; x++) {
        found = found || same(&p, middle, middle, x, middle);
        is_seen = is_seen || !same(&p, x, middle, 4, 4);
        lower_seen = lower_seen || !same(&p, middle, x, 4, 4);
    }
    if (!found || !is_seen || !lower_seen)
        fail_msg("%s over %s: %s", both[0].name, both[1].name, is_seen && lower_seen ? "hidden" : "not drawn");
    free(p.rgba);
}

/* How many pixels high the line of a thing is. */
static uint32_t height_of(const picture *p, const char *name) {
    const uint32_t y = row_of((size_t)(find_thing(name) - things), THINGS);
    uint32_t count = 0;
    for (uint32_t at = y - 10; at <= y + 10; at++)
        count += !same(p, WIDE / 2, at, 2, 2);
    return count;
}

static void test_crossings(void **state) {
    fixture *s = *state;
    char folder[32], path[64];
    make_folder(folder, path);
    for (int theme = 0; theme < 2; theme++) {
        json_t *style = style_of("openmaptiles", theme ? CAMBER_THEME_DARK : CAMBER_THEME_LIGHT);
        set_tiles(style, path);
        for (size_t i = 0; i < sizeof crossings / sizeof *crossings; i++)
            check_crossing(s, style, path, i);
        json_decref(style);
    }
    remove_folder(folder, path);
}

/* The more a road matters the wider it is, at any zoom; a ramp is narrower than its road. */
static void test_widths(void **state) {
    fixture *s = *state;
    static const char *const roads[] = {"service", "minor", "tertiary", "secondary", "primary", "trunk", "motorway"};
    enum { ROADS = sizeof roads / sizeof *roads };
    char folder[32], path[64];
    make_folder(folder, path);
    write_sheet(path);
    json_t *style = style_of("openmaptiles", CAMBER_THEME_LIGHT);
    set_tiles(style, path);
    picture p = draw(s, style, ZOOM, WIDE, HIGH);
    for (size_t i = 1; i < ROADS; i++)
        if (height_of(&p, roads[i]) < height_of(&p, roads[i - 1]) || height_of(&p, roads[i]) < 3)
            fail_msg("%s: %u px, %s: %u px", roads[i], height_of(&p, roads[i]), roads[i - 1],
                     height_of(&p, roads[i - 1]));
    assert_true(height_of(&p, "motorway") > height_of(&p, "minor") + 2);
    assert_true(height_of(&p, "ramp") < height_of(&p, "motorway"));
    assert_true(height_of(&p, "siding") < height_of(&p, "rail"));
    free(p.rgba);
    json_decref(style);
    remove_folder(folder, path);
}

/* ---- The tiles as input ---- */

static size_t read_file(fixture *s, const char *name, const char *path, const char *layer) {
    camber_style *style = NULL;
    camber_features *features = NULL;
    size_t size_bytes;
    const char *text = camber_style_get_text(name, CAMBER_THEME_LIGHT, &size_bytes);
    assert_int_equal(camber_style_parse(s->context, text, size_bytes, "shipped", &style), CAMBER_OK);
    assert_int_equal(camber_features_create(s->context, style, &features), CAMBER_OK);
    const camber_source_desc desc = {.path = path, .layer = layer, .keep_apart = true};
    assert_int_equal(camber_features_read(features, &desc), CAMBER_OK);
    const size_t count = camber_features_get_stats(features).features;
    camber_features_destroy(features);
    camber_style_destroy(style);
    return count;
}

/* A file that is given beside the style has its layers read that the style names: all but transportation_name, which
 * only labels need. */
static void test_file(void **state) {
    fixture *s = *state;
    char folder[32], path[64];
    size_t rivers = 0;
    make_folder(folder, path);
    write_sheet(path);
    for (size_t i = 0; i < THINGS; i++)
        rivers += strcmp(things[i].layer, "waterway") == 0;
    assert_int_equal(read_file(s, "openmaptiles", path, NULL), THINGS - 1);
    assert_int_equal(read_file(s, "openmaptiles", path, "waterway"), rivers);
    assert_int_equal(read_file(s, "city", path, NULL), THINGS - 1);
    remove_folder(folder, path);
}

/* ---- Documents ---- */

/* Nothing is wrong with them, and nothing of them is left out. */
static void test_documents(void **state) {
    fixture *s = *state;
    size_t size_bytes, count = 0;
    for (const char *name; (name = camber_style_list(count)) != NULL; count++)
        for (int theme = 0; theme < 2; theme++) {
            const char *text = camber_style_get_text(name, (camber_theme)theme, &size_bytes);
            camber_style_report *report = NULL;
            assert_non_null(text);
            assert_int_equal(camber_style_check(s->context, text, size_bytes, name, &report), CAMBER_OK);
            /* A style without sources is told so. */
            for (size_t i = 0; i < report->finding_count && (report->source_count || report->error_count); i++)
                fail_msg("%s: %s: %s", name, report->findings[i].pointer, report->findings[i].message);
            for (size_t i = 0; i < report->type_count; i++)
                assert_true(report->types[i].drawn);
            for (size_t i = 0; i < report->source_count; i++)
                assert_null(report->sources[i].trouble);
            camber_style_report_destroy(report);
        }
    assert_int_equal(count, 4);
    assert_null(camber_style_list(count));
    assert_null(camber_style_get_text("none", CAMBER_THEME_LIGHT, &size_bytes));
}

/* "city-osm" is "city" without the layers that name a layer of tiles. */
static void test_without_tiles(void **state) {
    (void)state;
    for (int theme = 0; theme < 2; theme++) {
        json_t *city = style_of("city", (camber_theme)theme), *osm = style_of("city-osm", (camber_theme)theme);
        json_t *list = json_object_get(city, "layers");
        const size_t all = json_array_size(list);
        for (size_t i = all; i-- > 0;)
            if (json_object_get(json_array_get(list, i), "source-layer"))
                json_array_remove(list, i);
        assert_true(json_array_size(list) > 50 && json_array_size(list) < all / 2);
        assert_true(json_equal(city, osm));
        json_decref(city);
        json_decref(osm);
    }
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_documents),   cmocka_unit_test(test_without_tiles), cmocka_unit_test(test_layers),
        cmocka_unit_test(test_line_layers), cmocka_unit_test(test_line_colors),   cmocka_unit_test(test_slots),
        cmocka_unit_test(test_crossings),   cmocka_unit_test(test_widths),        cmocka_unit_test(test_file),
    };
    const int failed = cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
    return failed;
}
