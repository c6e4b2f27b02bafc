/* Style documents: the built-in ones against a list of road classes, and documents that are wrong. */
#include "style/properties.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct fixture {
    camber_context *context;
    camber_style *style;
    char error[4096], warning[4096]; /* the last of each */
    size_t error_count, warning_count;
    size_t allocations_left; /* counts down; at 0 allocation fails */
    size_t blocks;           /* live */
} fixture;

static void keep_message(void *user, camber_log_level level, const char *message) {
    fixture *f = user;
    if (level == CAMBER_LOG_ERROR) {
        snprintf(f->error, sizeof f->error, "%s", message);
        f->error_count++;
    } else if (level == CAMBER_LOG_WARNING) {
        snprintf(f->warning, sizeof f->warning, "%s", message);
        f->warning_count++;
    }
}

static void *reallocate(void *user, void *block, size_t size_bytes) {
    fixture *f = user;
    if (size_bytes == 0) {
        f->blocks -= block != NULL;
        free(block);
        return NULL;
    }
    if (f->allocations_left == 0)
        return NULL;
    f->allocations_left--;
    void *made = realloc(block, size_bytes);
    f->blocks += !block && made;
    return made;
}

static void setup(fixture *f) {
    memset(f, 0, sizeof *f);
    f->allocations_left = SIZE_MAX;
    const camber_context_desc desc = {
        .reallocate = reallocate, .allocator_user = f, .log = keep_message, .log_user = f, .cache_dir = ""};
    assert_int_equal(camber_context_create(&desc, &f->context), CAMBER_OK);
}

static void teardown(fixture *f) {
    camber_style_destroy(f->style);
    camber_context_destroy(f->context);
    assert_int_equal(f->blocks, 0);
}

static camber_status parse(fixture *f, const char *json) {
    return camber_style_parse(f->context, json, strlen(json), "roads.json", &f->style);
}

/* ---- Roads ---- */

typedef struct feature {
    const char *highway, *type, *mtfcc, *bridge, *tunnel, *layer, *footway; /* a digit is a number */
} feature;

enum { PROPERTY_LIMIT = 16 };

static camber_value text_value(const char *text) {
    if (text && (strcmp(text, "0") == 0 || strcmp(text, "1") == 0))
        return (camber_value){.type = CAMBER_VALUE_NUMBER, .number = text[0] - '0'};
    return (camber_value){.type = text ? CAMBER_VALUE_STRING : CAMBER_VALUE_NULL, .string = text};
}

static void set_values(const camber_style *style, const feature *road, camber_value *values) {
    const struct {
        const char *name;
        camber_value value;
    } known[] = {
        {"highway", text_value(road->highway)}, {"type", text_value(road->type)},
        {"MTFCC", text_value(road->mtfcc)},     {"bridge", text_value(road->bridge)},
        {"tunnel", text_value(road->tunnel)},   {"name", text_value(NULL)},
        {"FULLNAME", text_value(NULL)},         {"ref", text_value(NULL)},
        {"shield_text", text_value(NULL)},      {"layer", text_value(road->layer)},
        {"footway", text_value(road->footway)}, {"name:latin", text_value(NULL)},
    };
    assert_in_range(style->schema.property_count, 1, PROPERTY_LIMIT);
    for (size_t i = 0; i < style->schema.property_count; i++) {
        size_t k = 0;
        while (k < sizeof known / sizeof *known && strcmp(known[k].name, style->schema.properties[i]) != 0)
            k++;
        if (k == sizeof known / sizeof *known)
            fail_msg("the style reads %s", style->schema.properties[i]);
        values[i] = known[k].value;
    }
}

/* Writes the ids of the line layers that draw the road at a zoom. Each draws it visibly, or not at all. */
static void list_layers(const camber_style *style, const feature *road, double zoom, char ids[256]) {
    camber_value values[PROPERTY_LIMIT];
    set_values(style, road, values);
    const camber_feature_view view = {.values = values, .geometry_type = "LineString"};
    ids[0] = 0;
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = &style->layers[i];
        if (layer->kind != CAMBER_LAYER_LINE || layer->plain || !camber_style_layer_matches(layer, zoom, &view))
            continue;
        const camber_layer_paint paint = camber_style_layer_paint(layer, zoom, &view);
        assert_true(paint.width >= 0.0 && paint.width < 16384.0 && paint.color.a > 0.99f);
        if (paint.width > 0.0)
            snprintf(ids + strlen(ids), 256 - strlen(ids), "%s%s", *ids ? " " : "", layer->id);
    }
}

/* Close up, exactly these layers draw the road. */
static void check_road(const camber_style *style, const feature *road, const char *expected) {
    char ids[256];
    const char *name = road->highway ? road->highway : road->type ? road->type : road->mtfcc ? road->mtfcc : "-";
    list_layers(style, road, 18.0, ids);
    if (strcmp(ids, expected) != 0)
        fail_msg("%s is drawn by \"%s\", not by \"%s\"", name, ids, expected);
}

typedef enum road_kind { NO_ROAD, A_ROAD, A_WAY } road_kind;

/* from: the first whole zoom at which it is drawn. */
static const struct {
    const char *value;
    road_kind kind;
    int from;
} osm_classes[] = {
    {"motorway", A_ROAD, 0},       {"motorway_link", A_ROAD, 10},
    {"trunk", A_ROAD, 0},          {"trunk_link", A_ROAD, 10},
    {"primary", A_ROAD, 6},        {"primary_link", A_ROAD, 11},
    {"secondary", A_ROAD, 8},      {"secondary_link", A_ROAD, 11},
    {"tertiary", A_ROAD, 10},      {"tertiary_link", A_ROAD, 12},
    {"residential", A_ROAD, 12},   {"unclassified", A_ROAD, 12},
    {"living_street", A_ROAD, 12}, {"road", A_ROAD, 12},
    {"service", A_ROAD, 13},       {"pedestrian", A_ROAD, 13},
    {"track", A_WAY, 13},          {"footway", A_WAY, 15},
    {"cycleway", A_WAY, 14},       {"path", A_WAY, 14},
    {"bridleway", A_WAY, 14},      {"steps", A_WAY, 15},
    {"rail", NO_ROAD, 0},          {"proposed", NO_ROAD, 0},
    {"construction", NO_ROAD, 0},  {"abandoned", NO_ROAD, 0},
    {"platform", A_WAY, 17},       {"pier", NO_ROAD, 0},
    {"narrow_gauge", NO_ROAD, 0},  {"tram", NO_ROAD, 0},
    {"bus_stop", NO_ROAD, 0},      {"", NO_ROAD, 0},
    {"multipolygon", NO_ROAD, 0},
};

static const struct {
    const char *value;
    road_kind kind;
} tiger_classes[] = {
    {"S1100", A_ROAD},  {"S1200", A_ROAD},  {"S1400", A_ROAD},  {"S1500", A_WAY},  {"S1630", A_ROAD},
    {"S1640", A_ROAD},  {"S1710", A_WAY},   {"S1720", A_WAY},   {"S1730", A_ROAD}, {"S1740", A_ROAD},
    {"S1750", A_ROAD},  {"S1780", A_ROAD},  {"S1820", A_WAY},   {"S1830", A_WAY},  {"R1011", NO_ROAD},
    {"H3010", NO_ROAD}, {"L4010", NO_ROAD}, {"P0001", NO_ROAD},
};

/* The layers that draw a kind of road on a level. Paths in tunnels are left out. */
static const char *level_layers(char text[128], const char *level, road_kind kind) {
    text[0] = 0;
    if (kind == A_ROAD)
        snprintf(text, 128, "%s-casing %s-fill", level, level);
    else if (kind == A_WAY && strncmp(level, "bridge", 6) == 0)
        snprintf(text, 128, "%s-path-edge %s-path-bed %s-path", level, level, level);
    else if (kind == A_WAY && strcmp(level, "ground") == 0)
        snprintf(text, 128, "%s-path", level);
    return text;
}

static void check_roads(const camber_style *style) {
    char text[128];
    static const struct {
        const char *bridge, *tunnel, *layer, *level;
    } levels[] = {
        {NULL, NULL, NULL, "ground"},     {"no", "no", NULL, "ground"},
        {"0", "0", "1", "ground"},        {"yes", NULL, NULL, "bridge"},
        {"viaduct", "no", "1", "bridge"}, {"1", "0", "-1", "bridge"},
        {"yes", NULL, "odd", "bridge"},   {"yes", NULL, "2", "bridge-2"},
        {"yes", NULL, "3", "bridge-3"},   {"yes", NULL, "5", "bridge-3"},
        {NULL, "yes", "-1", "tunnel"},    {"no", "culvert", NULL, "tunnel"},
        {"0", "1", NULL, "tunnel"},       {"yes", "building_passage", NULL, "tunnel"},
    };
    for (size_t i = 0; i < sizeof osm_classes / sizeof *osm_classes; i++) {
        for (size_t l = 0; l < sizeof levels / sizeof *levels; l++) {
            feature road = {.highway = osm_classes[i].value,
                            .bridge = levels[l].bridge,
                            .tunnel = levels[l].tunnel,
                            .layer = levels[l].layer};
            const char *expected = level_layers(text, levels[l].level, osm_classes[i].kind);
            check_road(style, &road, expected);
            road.type = road.highway;
            road.highway = NULL;
            check_road(style, &road, expected);
        }
    }
    for (size_t i = 0; i < sizeof tiger_classes / sizeof *tiger_classes; i++)
        check_road(style, &(feature){.mtfcc = tiger_classes[i].value},
                   level_layers(text, "ground", tiger_classes[i].kind));
    check_road(style, &(feature){0}, "");
    /* A way's highway counts, whatever the type of the relation or attribute beside it. */
    check_road(style, &(feature){.highway = "primary", .type = "rail"}, "ground-casing ground-fill");
}

/* Each class begins at its zoom, and is drawn from there on. */
static void check_generalization(const camber_style *style) {
    char ids[256];
    for (size_t i = 0; i < sizeof osm_classes / sizeof *osm_classes; i++) {
        for (int zoom = 0; zoom <= 24 && osm_classes[i].kind != NO_ROAD; zoom++) {
            list_layers(style, &(feature){.highway = osm_classes[i].value}, zoom, ids);
            if ((*ids != 0) != (zoom >= osm_classes[i].from))
                fail_msg("%s at zoom %d is drawn by \"%s\"", osm_classes[i].value, zoom, ids);
        }
    }
    for (int zoom = 0; zoom <= 24; zoom++) {
        list_layers(style, &(feature){.highway = "footway", .footway = "sidewalk"}, zoom, ids);
        assert_string_equal(ids, zoom < 17 ? "" : "ground-path");
    }
}

static camber_layer_paint paint_of(const camber_style *style, const char *id, double zoom, const feature *road) {
    camber_value values[PROPERTY_LIMIT];
    set_values(style, road, values);
    const camber_feature_view view = {.values = values, .geometry_type = "LineString"};
    for (size_t i = 0; i < style->layer_count; i++)
        if (strcmp(style->layers[i].id, id) == 0)
            return camber_style_layer_paint(&style->layers[i], zoom, &view);
    fail_msg("no layer %s", id);
    return (camber_layer_paint){0};
}

/* Levels from the lowest to the highest, in each the paths, the casings and then the fills. A casing and its fill share
 * their features, and the casing is wider or not there. */
static void check_order(const camber_style *style) {
    static const char *const ids[] = {
        "background",    "tunnel-casing",      "tunnel-fill",       "ground-path",   "ground-casing",
        "ground-fill",   "bridge-path-edge",   "bridge-path-bed",   "bridge-path",   "bridge-casing",
        "bridge-fill",   "bridge-2-path-edge", "bridge-2-path-bed", "bridge-2-path", "bridge-2-casing",
        "bridge-2-fill", "bridge-3-path-edge", "bridge-3-path-bed", "bridge-3-path", "bridge-3-casing",
        "bridge-3-fill"};
    enum { COUNT = sizeof ids / sizeof *ids };
    assert_int_equal(style->layer_count, COUNT + 1 + 4); /* and what is drawn plainly, and names */
    assert_int_equal(style->layers[0].kind, CAMBER_LAYER_BACKGROUND);
    for (size_t i = 0; i < COUNT; i++) {
        assert_string_equal(style->layers[i].id, ids[i]);
        if (!strstr(ids[i], "-casing"))
            continue;
        const camber_style_layer *casing = &style->layers[i], *fill = casing + 1;
        assert_string_equal(casing->filter_key, fill->filter_key);
        const feature road = {.highway = "residential"};
        const camber_layer_paint paint = paint_of(style, casing->id, 14.0, &road);
        assert_int_equal(paint.join, CAMBER_JOIN_ROUND);
        assert_int_equal(paint.cap, CAMBER_CAP_ROUND);
        assert_true(casing->tucks);
        assert_int_equal(fill->tucks, strncmp(ids[i], "bridge", 6) != 0);
        assert_int_equal(paint_of(style, fill->id, 14.0, &road).cap, CAMBER_CAP_ROUND);
        for (double zoom = 14.0; zoom <= 24.0; zoom += 0.25)
            assert_true(paint_of(style, casing->id, zoom, &road).width >
                        paint_of(style, fill->id, zoom, &road).width + 0.5);
    }
}

/* Wider with zoom, and wider by class; minor classes are drawn first. */
static void check_widths(const camber_style *style) {
    static const char *const ranks[] = {"service", "residential", "tertiary", "secondary",
                                        "primary", "trunk",       "motorway"};
    for (double zoom = 4.0; zoom <= 22.0; zoom += 0.25) {
        for (size_t i = 0; i < sizeof ranks / sizeof *ranks; i++) {
            const feature road = {.highway = ranks[i]}, lesser = {.highway = ranks[i ? i - 1 : 0]};
            const camber_layer_paint paint = paint_of(style, "ground-fill", zoom, &road);
            assert_true(zoom >= 22.0 || paint_of(style, "ground-fill", zoom + 0.25, &road).width >= paint.width);
            const camber_layer_paint below = paint_of(style, "ground-fill", zoom, &lesser);
            assert_true(paint.width >= below.width && (i == 0 || paint.sort_key > below.sort_key));
        }
    }
}

static void test_roads(void **state) {
    (void)state;
    for (int theme = 0; theme < 2; theme++) {
        fixture f;
        size_t size_bytes;
        setup(&f);
        const camber_theme which = theme ? CAMBER_THEME_DARK : CAMBER_THEME_LIGHT;
        const char *text = camber_style_get_text("roads", which, &size_bytes);
        assert_int_equal(camber_style_parse(f.context, text, size_bytes, "roads", &f.style), CAMBER_OK);
        assert_int_equal(f.error_count + f.warning_count, 0);
        assert_false(f.style->schema.wants_polygons || f.style->schema.wants_areas);
        check_order(f.style);
        check_widths(f.style);
        check_roads(f.style);
        check_generalization(f.style);
        const camber_color paper = camber_style_layer_paint(&f.style->layers[0], 12.0, NULL).color;
        assert_true(paper.a > 0.99f && (paper.g > 0.5f) == (which == CAMBER_THEME_LIGHT));
        teardown(&f);
    }
}

/* ---- The built-in style ---- */

/* "true" is a boolean, and what begins as a number is one. */
static camber_value tag_value(const char *text) {
    char *end;
    const double number = strtod(text, &end);
    if (strcmp(text, "true") == 0)
        return (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = true};
    if (end != text)
        return (camber_value){.type = CAMBER_VALUE_NUMBER, .number = number};
    return (camber_value){.type = CAMBER_VALUE_STRING, .string = text};
}

/* A feature with some of a style's properties: "landuse=forest class=wood". */
static void set_tags(const camber_style *style, const char *tags, camber_value *values, char texts[128]) {
    memset(values, 0, style->schema.property_count * sizeof *values);
    snprintf(texts, 128, "%s", tags);
    for (char *tag = strtok(texts, " "); tag; tag = strtok(NULL, " ")) {
        char *value = strchr(tag, '=');
        size_t i = 0;
        *value++ = 0;
        while (i < style->schema.property_count && strcmp(style->schema.properties[i], tag) != 0)
            i++;
        if (i == style->schema.property_count)
            fail_msg("the style does not read %s", tag);
        values[i] = tag_value(value);
    }
}

/* Writes the ids of the layers of a kind that draw the feature, of a source layer or of any. */
static const char *drawn_by(const camber_style *style, camber_layer_kind kind, const char *source_layer,
                            const char *tags, char ids[256]) {
    camber_value values[64];
    char texts[128];
    assert_in_range(style->schema.property_count, 1, sizeof values / sizeof *values);
    set_tags(style, tags, values, texts);
    const camber_feature_view view = {.values = values,
                                      .geometry_type = kind == CAMBER_LAYER_FILL ? "Polygon" : "LineString"};
    ids[0] = 0;
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = style->layers + i;
        if (layer->kind != kind || layer->plain ||
            (layer->source_layer && strcmp(layer->source_layer, source_layer) != 0) ||
            !camber_style_layer_matches(layer, 16.0, &view))
            continue;
        snprintf(ids + strlen(ids), 256 - strlen(ids), "%s%s", *ids ? " " : "", layer->id);
    }
    return ids;
}

/* The city has all layers of the style of roads, to the byte and in their order, and rails between them. */
static void check_city_roads(camber_theme theme) {
    static const char begin[] = ",\n    {\"id\": \"";
    size_t size_bytes;
    const char *city = strstr(camber_style_get_text("city", theme, &size_bytes), ",\n    {\"id\": \"tunnel-casing\"");
    const char *roads = strstr(camber_style_get_text("roads", theme, &size_bytes), ",\n    {\"id\": \"tunnel-casing\"");
    size_t count = 0;
    assert_non_null(city);
    assert_non_null(roads);
    while (strncmp(roads, ",\n    {\"id\": \"plain-line\"", 24) != 0) {
        const char *end = strstr(roads + 1, begin);
        assert_non_null(end);
        while (strncmp(city, roads, (size_t)(end - roads)) != 0) {
            city = strstr(city + 1, begin);
            assert_non_null(city);
        }
        roads = end;
        count++;
    }
    assert_int_equal(count, 20);
}

static void check_city(const camber_style *style) {
    static const struct {
        const char *layer, *tags, *ids;
    } areas[] = {
        {"", "natural=water", "water"},
        {"", "waterway=riverbank", "water"},
        {"water", "class=ocean", "tiles-water-water"},
        {"", "landuse=forest", "wood"},
        {"", "natural=wood landuse=forest", "wood"},
        {"landcover", "class=wood", "tiles-landcover-wood"},
        {"", "leisure=park", "park"},
        {"landcover", "class=grass", "tiles-landcover-park"},
        {"", "natural=beach", "sand"},
        {"", "landuse=residential", "built"},
        {"landuse", "class=residential", "tiles-landuse-built"},
        {"", "landuse=retail", "commerce"},
        {"", "landuse=industrial", "industry"},
        {"", "landuse=farmland", "farm"},
        {"", "landuse=meadow", "field"},
        {"", "amenity=school", "campus"},
        {"", "amenity=school building=school", "campus building"},
        {"", "leisure=pitch", "pitch"},
        {"park", "class=national_park", "tiles-park-reserve"},
        {"", "aeroway=runway", "apron"},
        {"", "building=yes", "building"},
        {"", "building=no", ""},
        {"building", "", "tiles-building"},
        {"landuse", "kind=park", "tiles-landuse-park"},
        {"landuse", "kind=nature_reserve", "tiles-landuse-reserve"},
        {"landuse", "kind=grassland", "tiles-landuse-field"},
        {"landuse", "kind=pedestrian", "tiles-landuse-plaza"},
        {"landuse", "kind=runway", "tiles-landuse-apron"},
        {"landuse", "kind=platform", ""},
        {"landcover", "kind=urban_area", "tiles-landcover-built"},
        {"landcover", "kind=forest", "tiles-landcover-wood"},
        {"landcover", "kind=glacier", "tiles-landcover-ice"},
        {"water", "kind=ocean", "tiles-water-water"},
        {"buildings", "kind=building", "tiles-buildings"},
        {"earth", "kind=earth", ""},
        {"natural", "pmap:kind=wood natural=wood", "tiles-natural-wood"},
        {"natural", "pmap:kind=wetland natural=wetland", "tiles-natural-wetland"},
        {"landuse", "pmap:kind=park leisure=park", "tiles-landuse-park"},
        {"landuse", "pmap:kind=university amenity=university", "tiles-landuse-campus"},
        {"water", "pmap:kind=water natural=water", "tiles-water-water"},
        {"buildings", "pmap:kind=building", "tiles-buildings"},
        {"ocean", "", "tiles-ocean-water"},
        {"water_polygons", "kind=river", "tiles-water_polygons-water"},
        {"water_polygons", "kind=glacier", "tiles-water_polygons-ice"},
        {"land", "kind=forest", "tiles-land-wood"},
        {"land", "kind=garden", "tiles-land-park"},
        {"land", "kind=residential", "tiles-land-built"},
        {"land", "kind=industrial", "tiles-land-industry"},
        {"land", "kind=marsh", "tiles-land-wetland"},
        {"sites", "kind=hospital", "tiles-sites-campus"},
        {"sites", "kind=parking", ""},
        {"pier_polygons", "kind=groyne", "tiles-pier_polygons-pier"},
        {"street_polygons", "kind=pedestrian", "tiles-street_polygons-plaza"},
        {"street_polygons", "kind=taxiway", "tiles-street_polygons-apron"},
        {"bridges", "kind=bridge", "tiles-bridges-plaza"},
        {"", "highway=pedestrian", "plaza"},
        {"", "highway=residential", "plaza"},
        {"", "highway=motorway", ""},
        {"", "natural=coastline", ""},
    };
    static const struct {
        const char *layer, *tags, *ids;
    } lines[] = {
        {"", "waterway=river", "river"},
        {"", "waterway=stream tunnel=culvert", ""},
        {"waterway", "class=river", "tiles-waterway-river"},
        {"waterway", "class=river brunnel=tunnel", ""},
        {"", "railway=rail", "rail rail-ties"},
        {"", "railway=tram bridge=yes", "bridge-rail-edge bridge-rail-bed bridge-rail bridge-rail-ties"},
        {"", "railway=abandoned", ""},
        {"transportation", "class=rail", "tiles-transportation-rail tiles-transportation-rail-ties"},
        {"", "highway=primary", "ground-casing ground-fill"},
        {"transportation", "class=primary", "tiles-transportation-ground-casing tiles-transportation-ground-fill"},
        {"transportation", "class=minor brunnel=bridge layer=2",
         "tiles-transportation-bridge-2-casing tiles-transportation-bridge-2-fill"},
        {"transportation", "class=path", "tiles-transportation-ground-path"},
        {"transportation", "class=path subclass=steps", "tiles-transportation-ground-path"},
        {"transportation", "class=ferry", "tiles-transportation-ferry-line"},
        {"transportation", "class=primary_construction", "tiles-transportation-works-line"},
        {"water", "kind=river", "tiles-water-river"},
        {"water", "kind=reef", ""},
        {"roads", "kind=highway kind_detail=motorway", "tiles-roads-ground-casing tiles-roads-ground-fill"},
        {"roads", "kind=major_road kind_detail=primary_link", "tiles-roads-ground-casing tiles-roads-ground-fill"},
        {"roads", "kind=minor_road kind_detail=residential is_bridge=true",
         "tiles-roads-bridge-casing tiles-roads-bridge-fill"},
        {"roads", "kind=minor_road kind_detail=service is_tunnel=true",
         "tiles-roads-tunnel-casing tiles-roads-tunnel-fill"},
        {"roads", "kind=path kind_detail=sidewalk", "tiles-roads-ground-path"},
        {"roads", "kind=path kind_detail=track", "tiles-roads-ground-path"},
        {"roads", "kind=path kind_detail=pier", "tiles-roads-pier-line"},
        {"roads", "kind=rail kind_detail=tram", "tiles-roads-rail tiles-roads-rail-ties"},
        {"roads", "kind=rail kind_detail=subway is_tunnel=true", ""},
        {"roads", "kind=ferry", "tiles-roads-ferry-line"},
        {"physical_line", "pmap:kind=stream waterway=stream", "tiles-physical_line-river"},
        {"physical_line", "pmap:kind=stream waterway=stream pmap:level=-1", ""},
        {"physical_line", "pmap:kind=cliff natural=cliff", ""},
        {"roads", "pmap:kind=medium_road pmap:kind_detail=tertiary pmap:level=0",
         "tiles-roads-ground-casing tiles-roads-ground-fill"},
        {"roads", "pmap:kind=highway pmap:kind_detail=motorway_link pmap:level=1",
         "tiles-roads-bridge-casing tiles-roads-bridge-fill"},
        {"roads", "pmap:kind=major_road pmap:kind_detail=trunk pmap:level=-1",
         "tiles-roads-tunnel-casing tiles-roads-tunnel-fill"},
        {"transit", "pmap:kind=rail pmap:kind_detail=rail railway=rail pmap:level=1",
         "tiles-transit-bridge-rail-edge tiles-transit-bridge-rail-bed tiles-transit-bridge-rail "
         "tiles-transit-bridge-rail-ties"},
        {"transit", "pmap:kind=rail pmap:kind_detail=subway railway=subway pmap:level=-1", ""},
        {"water_lines", "kind=canal", "tiles-water_lines-river"},
        {"water_lines", "kind=ditch tunnel=true", ""},
        {"streets", "kind=trunk link=true", "tiles-streets-ground-casing tiles-streets-ground-fill"},
        {"streets", "kind=living_street bridge=true", "tiles-streets-bridge-casing tiles-streets-bridge-fill"},
        {"streets", "kind=primary bridge=true tunnel=true", "tiles-streets-tunnel-casing tiles-streets-tunnel-fill"},
        {"streets", "kind=footway", "tiles-streets-ground-path"},
        {"streets", "kind=narrow_gauge", "tiles-streets-rail tiles-streets-rail-ties"},
        {"streets", "kind=subway tunnel=true", ""},
        {"streets", "kind=runway", "tiles-streets-runway-line"},
        {"ferries", "kind=ferry", "tiles-ferries-ferry-line"},
        {"boundary", "admin_level=2", "tiles-boundary-border-band tiles-boundary-border"},
        {"boundary", "admin_level=2 maritime=1", ""},
        {"boundaries", "kind=region", "tiles-boundaries-border"},
        {"", "boundary=administrative admin_level=6", "border-local"},
        {"", "boundary=administrative admin_level=10", ""},
        {"", "route=ferry", "ferry-line"},
        {"", "man_made=pier", "pier-line"},
        {"", "aeroway=runway", "runway-line"},
        {"", "aerialway=gondola", "lift-line lift-line-ties"},
        {"", "barrier=hedge", "hedge-line"},
        {"transportation_name", "class=primary", ""},
        {"water_name", "class=lake", ""},
        {"", "building=yes", ""},
    };
    char ids[256];
    for (size_t i = 0; i < sizeof areas / sizeof *areas; i++)
        if (strcmp(drawn_by(style, CAMBER_LAYER_FILL, areas[i].layer, areas[i].tags, ids), areas[i].ids) != 0)
            fail_msg("%s is drawn by \"%s\", not by \"%s\"", areas[i].tags, ids, areas[i].ids);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        if (strcmp(drawn_by(style, CAMBER_LAYER_LINE, lines[i].layer, lines[i].tags, ids), lines[i].ids) != 0)
            fail_msg("%s is drawn by \"%s\", not by \"%s\"", lines[i].tags, ids, lines[i].ids);
}

static void test_builtin(void **state) {
    (void)state;
    for (int theme = 0; theme < 2; theme++) {
        fixture f;
        setup(&f);
        const camber_theme which = theme ? CAMBER_THEME_DARK : CAMBER_THEME_LIGHT;
        assert_string_equal(camber_style_list(0), "city");
        assert_int_equal(camber_style_create_builtin(f.context, which, &f.style), CAMBER_OK);
        assert_int_equal(f.error_count + f.warning_count, 0);
        /* Polygons are lines, too, because buildings have an edge; dashes have a direction. */
        assert_true(f.style->schema.wants_areas && f.style->schema.wants_polygons && f.style->schema.directed);
        assert_false(f.style->schema.wants_all_properties);
        check_city(f.style);
        check_city_roads(which);
        teardown(&f);
    }
}

/* ---- Fill layers ---- */

#define FILL_LAYER(more) "{\"version\": 8, \"layers\": [{\"id\": \"f\", \"type\": \"fill\", " more "}]}"

static void test_fill(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    assert_int_equal(parse(&f, FILL_LAYER("\"paint\": {}")), CAMBER_OK);
    const camber_feature_view bare = {.geometry_type = "Polygon"};
    const camber_layer_paint plain = camber_style_layer_paint(f.style->layers, 10.0, &bare);
    assert_int_equal(f.style->layers[0].kind, CAMBER_LAYER_FILL);
    assert_true(f.style->schema.wants_areas && !f.style->schema.wants_polygons);
    assert_true(plain.color.r <= 0.0f && plain.color.a >= 1.0f && plain.antialias && plain.border_color.a <= 0.0f);
    assert_true(plain.layer_opacity >= 1.0 && fabs(plain.translate[0]) + fabs(plain.translate[1]) <= 0.0);
    assert_int_equal(plain.translate_anchor, CAMBER_TRANSLATE_MAP);
    camber_style_destroy(f.style);

    assert_int_equal(
        parse(&f,
              FILL_LAYER(
                  "\"filter\": [\"==\", \"$type\", \"Polygon\"], \"layout\": {\"fill-sort-key\": [\"get\", \"k\"]}, "
                  "\"paint\": {\"fill-color\": [\"get\", \"c\"], \"fill-opacity\": {\"stops\": [[0, 0], [10, 0.5]]}, "
                  "\"fill-antialias\": [\"step\", [\"zoom\"], false, 10, true], \"fill-outline-color\": \"#f00\", "
                  "\"fill-translate\": [1, 2], \"fill-translate-anchor\": \"viewport\", "
                  "\"fill-layer-opacity\": 0.25, \"fill-color-transition\": {\"duration\": 1}}")),
        CAMBER_OK);
    assert_int_equal(f.error_count + f.warning_count, 0);
    assert_true(f.style->schema.wants_areas && f.style->schema.wants_polygons);
    assert_int_equal(f.style->schema.property_count, 2);
    camber_value values[2];
    const size_t key = strcmp(f.style->schema.properties[0], "k") == 0 ? 0 : 1;
    values[key] = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = 7.0};
    values[1 - key] = (camber_value){.type = CAMBER_VALUE_STRING, .string = "#0000ff"};
    const camber_feature_view view = {.values = values, .geometry_type = "Polygon"};
    assert_true(camber_style_layer_matches(f.style->layers, 10.0, &view));
    const camber_layer_paint paint = camber_style_layer_paint(f.style->layers, 10.0, &view);
    assert_true(fabs(paint.sort_key - 7.0) <= 0.0 && paint.color.b >= 1.0f && fabsf(paint.color.a - 0.5f) < 1e-6f);
    assert_true(paint.border_color.r >= 1.0f && fabsf(paint.border_color.a - 0.5f) < 1e-6f);
    assert_true(paint.antialias && !camber_style_layer_paint(f.style->layers, 9.0, &view).antialias);
    assert_true(fabs(paint.translate[1] - 2.0) <= 0.0 && paint.translate_anchor == CAMBER_TRANSLATE_VIEWPORT);
    assert_true(fabs(paint.layer_opacity - 0.25) <= 0.0);
    values[1 - key].string = "no colour";
    assert_true(camber_style_layer_paint(f.style->layers, 10.0, &view).color.b <= 0.0f);
    camber_style_destroy(f.style);

    /* A layer that nobody sees needs no areas. */
    assert_int_equal(parse(&f, FILL_LAYER("\"layout\": {\"visibility\": \"none\"}")), CAMBER_OK);
    assert_false(f.style->schema.wants_areas);
    teardown(&f);
}

/* ---- Circle layers ---- */

static void test_circle(void **state) {
    (void)state;
    fixture f;
    setup(&f);
#define CIRCLE_LAYER(more) "{\"version\": 8, \"layers\": [{\"id\": \"c\", \"type\": \"circle\", " more "}]}"
    assert_int_equal(parse(&f, CIRCLE_LAYER("\"paint\": {}")), CAMBER_OK);
    const camber_feature_view bare = {.geometry_type = "Point"};
    const camber_layer_paint plain = camber_style_layer_paint(f.style->layers, 10.0, &bare);
    assert_int_equal(f.style->layers[0].kind, CAMBER_LAYER_CIRCLE);
    assert_true(f.style->schema.wants_points && f.style->schema.wants_polygons && !f.style->schema.wants_areas);
    assert_true(fabs(plain.radius - 5.0) <= 0.0 && plain.stroke_width <= 0.0 && plain.color.a >= 1.0f);
    assert_true(plain.stroke_color.a >= 1.0f && plain.stroke_color.r <= 0.0f);
    assert_int_equal(plain.pitch_scale, CAMBER_TRANSLATE_MAP);
    assert_int_equal(plain.pitch_alignment, CAMBER_TRANSLATE_VIEWPORT);
    camber_style_destroy(f.style);

    assert_int_equal(
        parse(&f, CIRCLE_LAYER(
                      "\"filter\": [\"==\", \"$type\", \"Point\"], \"layout\": {\"circle-sort-key\": [\"get\", "
                      "\"r\"]}, \"paint\": {\"circle-radius\": [\"interpolate\", [\"linear\"], [\"zoom\"], 0, 1, 10, "
                      "[\"get\", \"r\"]], \"circle-opacity\": 0.5, \"circle-stroke-opacity\": 0.25, "
                      "\"circle-stroke-width\": {\"stops\": [[0, 0], [10, 2]]}, \"circle-stroke-color\": \"#f00\", "
                      "\"circle-pitch-alignment\": \"map\"}")),
        CAMBER_OK);
    assert_int_equal(f.error_count + f.warning_count, 0);
    assert_true(f.style->schema.wants_points && !f.style->schema.wants_polygons && f.style->schema.property_count == 1);
    const camber_value value = {.type = CAMBER_VALUE_NUMBER, .number = 7.0};
    const camber_feature_view view = {.values = &value, .geometry_type = "Point"};
    const camber_layer_paint paint = camber_style_layer_paint(f.style->layers, 10.0, &view);
    assert_true(fabs(paint.radius - 7.0) <= 0.0 && fabs(paint.sort_key - 7.0) <= 0.0);
    assert_true(fabs(paint.stroke_width - 2.0) <= 0.0 && fabsf(paint.color.a - 0.5f) < 1e-6f);
    assert_true(paint.stroke_color.r >= 1.0f && fabsf(paint.stroke_color.a - 0.25f) < 1e-6f);
    assert_int_equal(paint.pitch_alignment, CAMBER_TRANSLATE_MAP);
    camber_style_destroy(f.style);

    /* How overlaps come together is not the style's choice, and a layer that nobody sees wants nothing. */
    assert_int_equal(parse(&f, CIRCLE_LAYER("\"metadata\": {\"camber:overlap\": \"unite\"}")), CAMBER_OK);
    assert_int_equal(f.warning_count, 1);
    assert_non_null(strstr(f.warning, "circles are drawn on top of each other"));
    assert_int_equal(f.style->layers[0].overlap, CAMBER_OVERLAP_ACCUMULATE);
    assert_false(f.style->accumulates);
    camber_style_destroy(f.style);
    assert_int_equal(parse(&f, CIRCLE_LAYER("\"layout\": {\"visibility\": \"none\"}")), CAMBER_OK);
    assert_false(f.style->schema.wants_points || f.style->schema.wants_polygons);
    camber_style_destroy(f.style);
    assert_int_equal(parse(&f, CIRCLE_LAYER("\"paint\": {\"circle-radius\": -1}")), CAMBER_ERROR_INPUT);
    f.style = NULL;
    teardown(&f);
}

static void test_wrong_fills(void **state) {
    (void)state;
    static const struct {
        const char *json, *message;
    } cases[] = {
        {FILL_LAYER("\"paint\": {\"fill-opacity\": 2}"), "/layers/0/paint/fill-opacity: 2 is out of range"},
        {FILL_LAYER("\"paint\": {\"fill-color\": 3}"), "/layers/0/paint/fill-color: expected a colour"},
        {FILL_LAYER("\"paint\": {\"fill-antialias\": \"yes\"}"), "/layers/0/paint/fill-antialias: expected a boolean"},
        {FILL_LAYER("\"paint\": {\"fill-antialias\": [\"get\", \"a\"]}"), "fill-antialias cannot depend on features"},
        {FILL_LAYER("\"paint\": {\"fill-translate\": [1]}"), "/layers/0/paint/fill-translate"},
        {FILL_LAYER("\"paint\": {\"fill-translate-anchor\": \"sky\"}"), "\"sky\" is not a fill-translate-anchor"},
        {FILL_LAYER("\"paint\": {\"fill-layer-opacity\": [\"get\", \"a\"]}"), "cannot depend on features"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        fixture f;
        setup(&f);
        assert_int_equal(parse(&f, cases[i].json), CAMBER_ERROR_INPUT);
        if (!strstr(f.error, cases[i].message))
            fail_msg("%s: %s", cases[i].message, f.error);
        teardown(&f);
    }
    fixture f;
    setup(&f);
    assert_int_equal(parse(&f, FILL_LAYER("\"layout\": {\"fill-color\": \"red\"}, \"paint\": {\"line-width\": 2}")),
                     CAMBER_OK);
    assert_int_equal(f.warning_count, 2);
    teardown(&f);
}

/* ---- Documents ---- */

static void test_layer(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    const char *json =
        "\xef\xbb\xbf{\"version\": 8, \"sources\": {\"city\": {\"type\": \"vector\"}}, \"layers\": ["
        "{\"id\": \"paper\", \"type\": \"background\", \"paint\": {\"background-color\": \"red\","
        "  \"background-opacity\": 0.5}},"
        "{\"id\": \"roads\", \"type\": \"line\", \"source\": \"city\", \"source-layer\": \"transport\", \"minzoom\": 3,"
        "  \"maxzoom\": 15.5, \"filter\": [\"==\", \"highway\", \"primary\"], \"layout\": {\"line-cap\": \"square\","
        "  \"line-join\": \"bevel\", \"line-miter-limit\": 5}, \"paint\": {\"line-width\": [\"get\", \"w\"],"
        "  \"line-color\": \"rgba(0, 0, 255, 0.5)\", \"line-opacity\": 0.5}},"
        "{\"id\": \"plain\", \"type\": \"line\"},"
        "{\"id\": \"hidden\", \"type\": \"line\", \"layout\": {\"visibility\": \"none\"}},"
        "{\"id\": \"outlines\", \"type\": \"line\", \"filter\": [\"==\", \"$type\", \"Polygon\"]}]}";
    assert_int_equal(parse(&f, json), CAMBER_OK);
    assert_int_equal(f.error_count + f.warning_count, 0);
    assert_int_equal(f.style->layer_count, 5);
    assert_true(f.style->schema.wants_polygons);
    const camber_style_layer *paper = &f.style->layers[0], *roads = &f.style->layers[1], *plain = &f.style->layers[2];
    assert_true(fabsf(camber_style_layer_paint(paper, 0.0, NULL).color.a - 0.5f) < 1e-6f);
    assert_string_equal(roads->source, "city");
    assert_string_equal(roads->source_layer, "transport");
    assert_string_equal(roads->filter_key, "[\"==\",\"highway\",\"primary\"]");
    assert_int_equal(f.style->schema.property_count, 2);
    camber_value values[2];
    const size_t highway = strcmp(f.style->schema.properties[0], "highway") == 0 ? 0 : 1;
    values[highway] = (camber_value){.type = CAMBER_VALUE_STRING, .string = "primary"};
    values[1 - highway] = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = 7.0};
    const camber_feature_view view = {.values = values, .geometry_type = "LineString"};
    assert_true(camber_style_layer_matches(roads, 3.0, &view));
    assert_true(camber_style_layer_matches(roads, 15.4, &view));
    assert_false(camber_style_layer_matches(roads, 2.9, &view));
    assert_false(camber_style_layer_matches(roads, 15.5, &view));
    assert_true(camber_style_layer_matches(plain, 24.0, &view));
    assert_false(camber_style_layer_matches(&f.style->layers[3], 10.0, &view));
    camber_layer_paint paint = camber_style_layer_paint(roads, 10.0, &view);
    assert_int_equal(paint.cap, CAMBER_CAP_SQUARE);
    assert_int_equal(paint.join, CAMBER_JOIN_BEVEL);
    assert_true(fabs(paint.miter_limit - 5.0) < 1e-6);
    assert_true(fabs(paint.width - 7.0) < 1e-12 && fabsf(paint.color.a - 0.25f) < 1e-6f && paint.color.b >= 1.0f);
    /* A value that cannot be evaluated, or is no width, is the specification's default, and below 0 is 0. */
    values[1 - highway] = (camber_value){.type = CAMBER_VALUE_STRING, .string = "wide"};
    assert_true(fabs(camber_style_layer_paint(roads, 10.0, &view).width - 1.0) < 1e-12);
    values[1 - highway] = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = NAN};
    assert_true(fabs(camber_style_layer_paint(roads, 10.0, &view).width - 1.0) < 1e-12);
    values[1 - highway].number = -3.0;
    assert_true(fabs(camber_style_layer_paint(roads, 10.0, &view).width) < 1e-12);
    values[highway].string = "secondary";
    assert_false(camber_style_layer_matches(roads, 10.0, &view));
    assert_null(plain->source);
    assert_string_equal(plain->filter_key, "");
    paint = camber_style_layer_paint(plain, 10.0, &view);
    assert_int_equal(paint.cap, CAMBER_CAP_BUTT);
    assert_int_equal(paint.join, CAMBER_JOIN_MITER);
    assert_true(fabs(paint.width - 1.0) < 1e-12 && paint.color.a >= 1.0f && paint.color.r <= 0.0f);
    teardown(&f);
}

/* The state of the style says its default, that of features nothing. */
static void test_states(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    assert_int_equal(
        parse(
            &f,
            "{\"version\": 8, \"state\": {\"show\": {\"default\": "
            "\"none\"}}, \"layers\": ["
            "{\"id\": \"a\", \"type\": \"line\", \"layout\": {\"visibility\": [\"global-state\", \"show\"]}},"
            "{\"id\": \"b\", \"type\": \"line\", \"layout\": {\"visibility\": [\"global-state\", \"other\"]},"
            " \"paint\": {\"line-width\": [\"case\", [\"boolean\", [\"feature-state\", \"hover\"], false], 9, 4]}}]}"),
        CAMBER_OK);
    assert_int_equal(f.error_count + f.warning_count, 0);
    assert_false(f.style->layers[0].visible);
    assert_true(f.style->layers[1].visible);
    const camber_feature_view view = {.geometry_type = "LineString"};
    assert_true(fabs(camber_style_layer_paint(&f.style->layers[1], 5.0, &view).width - 4.0) < 1e-12);
    teardown(&f);
}

/* The layers that a zoom shows tell which kernels it takes. */
static void test_plain(void **state) {
    (void)state;
    static const char *const more[] = {
        "\"line-dasharray\": [2, 1]", "\"line-gap-width\": 2",          "\"line-blur\": 1",
        "\"line-pattern\": \"a\"",    "\"line-trim-offset\": [0, 0.5]", "\"line-border-width\": 1"};
    fixture f;
    for (size_t i = 0; i < sizeof more / sizeof *more; i++) {
        char json[512];
        setup(&f);
        snprintf(json, sizeof json,
                 "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"line\", \"paint\": {\"line-width\": 3}}, "
                 "{\"id\": \"b\", \"type\": \"line\", \"minzoom\": 5, \"maxzoom\": 9, \"paint\": {%s}}]}",
                 more[i]);
        assert_int_equal(parse(&f, json), CAMBER_OK);
        assert_int_not_equal(camber_style_get_effects(f.style, (double)NAN), 0);
        assert_int_not_equal(camber_style_get_effects(f.style, 5), 0);
        assert_int_equal(camber_style_get_effects(f.style, 4.9), 0);
        assert_int_equal(camber_style_get_effects(f.style, 9), 0);
        teardown(&f);
    }
    setup(&f);
    assert_int_equal(camber_style_create_builtin(f.context, CAMBER_THEME_LIGHT, &f.style), CAMBER_OK);
    assert_int_equal(camber_style_get_effects(f.style, (double)NAN), CAMBER_STYLE_EFFECT_DASH);
    teardown(&f);
}

/* The last dash of an odd list runs on into the first, as MapLibre draws it; one length is a solid line. */
static void test_odd_dashes(void **state) {
    (void)state;
    static const struct {
        const char *json;
        uint32_t count;
        float lengths[4];
    } samples[] = {{"[3, 1, 1]", 4, {3, 1, 1, 0}},
                   {"[\"step\", [\"zoom\"], [\"literal\", [3, 1, 1]], 9, [\"literal\", [2, 1]]]", 4, {3, 1, 1, 0}},
                   {"[3]", 0, {0}},
                   {"[0]", 0, {0}},
                   {"[3, 0]", 2, {3, 0}},
                   {"[3, 1, 1, 2]", 4, {3, 1, 1, 2}}};
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        char json[512];
        fixture f;
        setup(&f);
        snprintf(json, sizeof json,
                 "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"line\", \"paint\": "
                 "{\"line-dasharray\": %s}}]}",
                 samples[i].json);
        assert_int_equal(parse(&f, json), CAMBER_OK);
        assert_int_equal(f.warning_count, 0); /* it is for who checks a style to know */
        const camber_layer_dashes dashes = camber_style_layer_paint(f.style->layers, 5.0, NULL).dashes;
        assert_int_equal(dashes.count, samples[i].count);
        assert_memory_equal(dashes.lengths, samples[i].lengths, samples[i].count * sizeof(float));
        teardown(&f);
    }
}

static void test_warnings(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    assert_int_equal(parse(&f, "{\"version\": 8, \"layers\": ["
                               "{\"id\": \"a\", \"type\": \"heatmap\"}, {\"id\": \"b\", \"type\": \"heatmap\"},"
                               "{\"id\": \"c\", \"type\": \"line\", \"layout\": {\"line-shadow\": 3},"
                               "  \"paint\": {\"line-color-transition\": {\"duration\": 1}}},"
                               "{\"id\": \"d\", \"type\": \"line\", \"layout\": {\"line-shadow\": 4}}]}"),
                     CAMBER_OK);
    assert_int_equal(f.warning_count, 2);
    assert_string_equal(f.warning, "roads.json: /layers/2/layout/line-shadow: unknown property; the layer is drawn "
                                   "without it");
    assert_int_equal(f.style->layer_count, 2);
    teardown(&f);
    setup(&f);
    assert_int_equal(parse(&f, "{\"version\": 8, \"layers\": [{\"id\": \"c\", \"type\": \"line\", \"layout\": "
                               "{\"line-cap\": {\"stops\": [[0, \"butt\"], [10, \"round\"]]}, \"frob/ni~cate\": 3}}]}"),
                     CAMBER_OK);
    assert_int_equal(f.warning_count, 1);
    assert_string_equal(f.warning, "roads.json: /layers/0/layout/frob~1ni~0cate: unknown property; the layer is drawn "
                                   "without it");
    assert_int_equal(camber_style_layer_paint(f.style->layers, 9.9, NULL).cap, CAMBER_CAP_BUTT);
    assert_int_equal(camber_style_layer_paint(f.style->layers, 10.0, NULL).cap, CAMBER_CAP_ROUND);
    teardown(&f);
}

/* A layer with an operator of the specification that is not supported is left out; the others are drawn. */
static void test_left_out(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    assert_int_equal(
        parse(&f,
              "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"symbol\", \"filter\": [\"all\", [\"within\", "
              "{\"type\": \"Polygon\", \"coordinates\": []}], [\"within\", {}]], \"layout\": {\"text-field\": \"x\"}},"
              "{\"id\": \"b\", \"type\": \"line\", \"paint\": {\"line-width\": [\"distance\", {}]}},"
              "{\"id\": \"c\", \"type\": \"symbol\", \"layout\": {\"text-field\": [\"resolved-locale\", "
              "[\"collator\", {}]]}}, {\"id\": \"d\", \"type\": \"line\", \"filter\": [\"==\", \"class\", "
              "\"within\"]}]}"),
        CAMBER_OK);
    assert_int_equal(f.error_count, 0);
    assert_int_equal(f.warning_count, 3);
    assert_string_equal(f.warning,
                        "roads.json: /layers/2/layout/text-field/0: \"resolved-locale\" is not supported, so the "
                        "layer is left out");
    assert_int_equal(f.style->layer_count, 1);
    assert_string_equal(f.style->layers[0].id, "d");
    teardown(&f);
}

/* Features whose label the zoom decides are read, whatever the zoom of the view that they are read for. */
static void test_filter_by_zoom(void **state) {
    (void)state;
    const camber_feature_view point = {.geometry_type = "Point"};
    fixture f;
    setup(&f);
    assert_int_equal(
        parse(&f, "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"symbol\", \"filter\": [\">=\", "
                  "[\"zoom\"], 5], \"layout\": {\"text-field\": \"x\"}}, {\"id\": \"b\", \"type\": \"symbol\", "
                  "\"filter\": [\"==\", [\"geometry-type\"], \"Polygon\"]}]}"),
        CAMBER_OK);
    assert_true(camber_style_layer_takes(f.style->layers, &point));
    assert_false(camber_style_layer_matches(f.style->layers, 4.9, &point));
    assert_true(camber_style_layer_matches(f.style->layers, 5.0, &point));
    assert_false(camber_style_layer_takes(f.style->layers + 1, &point));
    teardown(&f);
}

/* A line layer with one thing in it. */
#define LINE(rest) "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"line\", " rest "}]}"

static void test_wrong(void **state) {
    (void)state;
    static const struct {
        const char *json, *message;
    } samples[] = {
        {"", "line 1, column 0: "},
        {" \n ", "line 2, column "},
        {"{", "line 1, column 1: "},
        {"{\"version\": 8,\n \"layers\": [}", "line 2, column 13: "},
        {"{\"version\": 8, \"layers\": [{\"id\": \"ro", "line 1, column "},
        {"{\"version\": 8, \"layers\": [{\"id\": \"ro\xff\xfe\"}]}", "line 1, column "},
        {"{\"version\": 8, \"layers\": []} x", "line 1, column "},
        {"{\"version\": 1e999, \"layers\": []}", "line 1, column "},
        {"{\"version\": NaN, \"layers\": []}", "line 1, column "},
        {"\x01\x02\x03", "line 1, column "},
        {"3", "expected a style document, an object, found a number"},
        {"[]", "expected a style document, an object, found an array"},
        {"{}", "/version: expected the number 8"},
        {"{\"version\": \"8\", \"layers\": []}", "/version: expected the number 8"},
        {"{\"version\": 7, \"layers\": []}", "/version: expected the number 8"},
        {"{\"version\": 8}", "/layers: expected an array of layers"},
        {"{\"version\": 8, \"layers\": {}}", "/layers: expected an array of layers"},
        {"{\"version\": 8, \"sources\": 3, \"layers\": []}", "/sources: expected an object, found a number"},
        {"{\"version\": 8, \"layers\": [3]}", "/layers/0: expected a layer, an object, found a number"},
        {"{\"version\": 8, \"layers\": [{\"type\": \"line\"}]}", "/layers/0: the layer has no \"id\""},
        {"{\"version\": 8, \"layers\": [{\"id\": \"a\"}]}", "/layers/0: the layer has no \"type\""},
        {"{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"fill\"}, {\"id\": \"b\", \"type\": \"line\"}, "
         "{\"id\": \"a\", \"type\": \"line\"}]}",
         "/layers/2/id: \"a\" is also the id of /layers/0"},
        {LINE("\"paint\": {\"line-width\": \"2\"}"),
         "/layers/0/paint/line-width: expected a number or an expression, found a string"},
        {LINE("\"paint\": {\"line-width\": -1}"), "/layers/0/paint/line-width: -1 is out of range"},
        {LINE("\"paint\": {\"line-opacity\": 1.5}"), "/layers/0/paint/line-opacity: 1.5 is out of range; use 0 to 1"},
        {LINE("\"paint\": {\"line-color\": 3}"), "/layers/0/paint/line-color: expected a colour"},
        {LINE("\"paint\": {\"line-color\": \"sour\"}"), "/layers/0/paint/line-color: cannot be evaluated"},
        {LINE("\"paint\": []"), "/layers/0/paint: expected an object, found an array"},
        {LINE("\"layout\": 3"), "/layers/0/layout: expected an object, found a number"},
        {LINE("\"layout\": {\"line-cap\": \"pointed\"}"), "/layers/0/layout/line-cap: \"pointed\" is not a line-cap"},
        {LINE("\"paint\": {\"line-dasharray\": [-1, 2]}"), "/layers/0/paint/line-dasharray: -1 is out of range"},
        {LINE("\"paint\": {\"line-width\": [\"/\", 0, 0]}"), "/layers/0/paint/line-width: the number is NaN"},
        {LINE("\"paint\": {\"line-width\": [\"/\", 1, 0]}"), "/layers/0/paint/line-width: the number is infinite"},
        {LINE("\"paint\": {\"line-gap-width\": -1}"), "/layers/0/paint/line-gap-width: -1 is out of range"},
        {LINE("\"paint\": {\"line-translate\": [1]}"), "/layers/0/paint/line-translate: expected"},
        {LINE("\"paint\": {\"line-translate\": [\"get\", \"x\"]}"),
         "/layers/0/paint/line-translate: line-translate cannot depend on features"},
        {LINE("\"paint\": {\"line-translate-anchor\": \"moon\"}"), "/layers/0/paint/line-translate-anchor: \"moon\""},
        {LINE("\"paint\": {\"line-trim-offset\": [0, 2]}"), "/layers/0/paint/line-trim-offset: 2 is out of range"},
        {LINE("\"paint\": {\"line-layer-opacity\": [\"get\", \"x\"]}"), "/layers/0/paint/line-layer-opacity: "},
        {LINE("\"layout\": {\"line-sort-key\": \"x\"}"), "/layers/0/layout/line-sort-key: expected a number"},
        {LINE("\"ref\": \"a\""), "/layers/0/ref: the layer itself refers to another one"},
        {LINE("\"ref\": \"b\""), "/layers/0/ref: no layer has this id"},
        {"{\"version\": 8, \"constants\": {}, \"layers\": []}", "/constants: "},
        {"{\"version\": 8, \"center\": [1, \"x\"], \"layers\": []}", "/center: expected a position"},
        {"{\"version\": 8, \"zoom\": 99, \"layers\": []}", "/zoom: 99 is out of range"},
        {"{\"version\": 8, \"state\": {\"a\": 1}, \"layers\": []}", "/state: expected values with a default"},
        {"{\"version\": 8, \"sprite\": [{\"url\": \"x\"}], \"layers\": []}", "/sprite: expected a URL"},
        {LINE("\"layout\": {\"line-cap\": 3}"), "/layers/0/layout/line-cap: expected a string"},
        {LINE("\"layout\": {\"visibility\": true}"), "/layers/0/layout/visibility: expected \"visible\" or \"none\""},
        {LINE("\"layout\": {\"visibility\": [\"get\", \"x\"]}"),
         "/layers/0/layout/visibility: visibility cannot depend on"},
        {LINE("\"layout\": {\"visibility\": [\"zoom\"]}"), "/layers/0/layout/visibility: "},
        {LINE("\"paint\": {\"line-translate\": [\"feature-state\", \"x\"]}"), "/layers/0/paint/line-translate: "},
        {LINE("\"minzoom\": \"3\""), "/layers/0/minzoom: expected a number, found a string"},
        {LINE("\"maxzoom\": 25"), "/layers/0/maxzoom: 25 is out of range"},
        {LINE("\"source\": 3"), "/layers/0/source: expected a string, found a number"},
        {LINE("\"filter\": 3"), "/layers/0/filter: expected a filter, found a number"},
        {LINE("\"filter\": [\"==\", \"a\", [\"nope\"]]"), "/layers/0/filter/2/0: unknown operator \"nope\""},
        {"{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"background\", \"paint\": {\"background-color\": "
         "[\"get\", \"c\"]}}]}",
         "/layers/0/paint/background-color: background-color cannot depend on features"},
    };
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        fixture f;
        char start[256];
        setup(&f);
        assert_int_equal(parse(&f, samples[i].json), CAMBER_ERROR_INPUT);
        snprintf(start, sizeof start, "roads.json: %s", samples[i].message);
        if (f.error_count != 1 || strncmp(f.error, start, strlen(start)) != 0 || !strchr(f.error, ';'))
            fail_msg("%s: %zu errors, '%s', not '%s'", samples[i].json, f.error_count, f.error, start);
        assert_null(f.style);
        teardown(&f);
    }
}

/* ---- Hostile documents ---- */

typedef struct text {
    char *bytes;
    size_t size, capacity;
} text;

static void append(text *t, const char *more) {
    const size_t length = strlen(more);
    if (t->size + length + 1 > t->capacity) {
        t->capacity = 2 * (t->size + length + 1);
        t->bytes = realloc(t->bytes, t->capacity);
        assert_non_null(t->bytes);
    }
    memcpy(t->bytes + t->size, more, length + 1);
    t->size += length;
}

static void test_nesting(void **state) {
    (void)state;
    for (size_t depth = 1000; depth <= 100000; depth *= 100) {
        fixture f;
        text t = {0};
        setup(&f);
        append(&t, "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"line\", \"filter\": ");
        for (size_t i = 0; i < depth; i++)
            append(&t, "[\"all\",");
        append(&t, "true");
        for (size_t i = 0; i < depth; i++)
            append(&t, "]");
        append(&t, "}]}");
        assert_int_equal(parse(&f, t.bytes), CAMBER_ERROR_INPUT);
        assert_int_equal(f.error_count, 1);
        assert_non_null(strstr(f.error, depth == 1000 ? "nested deeper than" : "depth"));
        /* Cut off at the deepest. */
        t.bytes[t.size / 2] = 0;
        assert_int_equal(parse(&f, t.bytes), CAMBER_ERROR_INPUT);
        free(t.bytes);
        teardown(&f);
    }
}

static void test_long_pointers(void **state) {
    (void)state;
    fixture f;
    text t = {0};
    setup(&f);
    append(&t, "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"line\", \"paint\": {\"line-width\": ");
    for (size_t i = 0; i < 500; i++)
        append(&t, "[\"+\", 1, ");
    append(&t, "1");
    for (size_t i = 0; i < 500; i++)
        append(&t, "]");
    append(&t, "}}]}");
    assert_int_equal(parse(&f, t.bytes), CAMBER_ERROR_INPUT);
    assert_non_null(strstr(f.error, "/layers/0/paint/line-width/2/2/"));
    assert_non_null(strstr(f.error, "/2/.../2/2/"));
    assert_non_null(strstr(f.error, ": nested deeper than 200 levels; flatten the expression"));
    assert_true(strlen(f.error) < 260);
    /* A key: its characters stay whole. */
    t.size = 0;
    append(&t, "{\"version\": 8, \"sources\": {\"");
    for (size_t i = 0; i < 1000; i++)
        append(&t, "\u00fc");
    append(&t, "~\": 7}, \"layers\": []}");
    assert_int_equal(parse(&f, t.bytes), CAMBER_ERROR_INPUT);
    assert_non_null(strstr(f.error, "/sources/\u00fc\u00fc"));
    assert_non_null(strstr(f.error, "\u00fc...\u00fc"));
    assert_non_null(strstr(f.error, "\u00fc~0: expected a source"));
    free(t.bytes);
    teardown(&f);
}

static void test_many(void **state) {
    (void)state;
    enum { MANY = 1000000 };
    fixture f;
    text t = {0};
    char one[64];
    setup(&f);
    append(&t, "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"line\", \"paint\": {\"line-width\": "
               "[\"interpolate\", [\"linear\"], [\"get\", \"n\"]");
    for (int i = 0; i < MANY; i++) {
        snprintf(one, sizeof one, ",%d,%d", i, 2 * i);
        append(&t, one);
    }
    append(&t, "]}}]}");
    assert_int_equal(parse(&f, t.bytes), CAMBER_OK);
    const camber_value value = {.type = CAMBER_VALUE_NUMBER, .number = 654321.25};
    const camber_feature_view view = {.values = &value, .geometry_type = "LineString"};
    assert_true(fabs(camber_style_layer_paint(f.style->layers, 10.0, &view).width - 1308642.5) < 1e-6);
    free(t.bytes);
    teardown(&f);
    /* More dashes than are drawn are told of, and so are numbers that are held to their range, some of them. */
    t = (text){0};
    setup(&f);
    append(&t, "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"line\", \"paint\": {\"line-width\": "
               "[\"step\", [\"zoom\"], 1");
    for (int i = 0; i < MANY; i++) {
        snprintf(one, sizeof one, ",%d,-1", i);
        append(&t, one);
    }
    append(&t, "], \"line-dasharray\": [1");
    for (int i = 0; i < MANY; i++)
        append(&t, ",1");
    append(&t, "]}}]}");
    assert_int_equal(parse(&f, t.bytes), CAMBER_OK);
    assert_int_equal(f.warning_count, 33);
    assert_non_null(strstr(f.warning, "there are 1000001 lengths, and only the first 128 are used"));
    free(t.bytes);
    teardown(&f);
}

/* 10^5 labels, one of them twice, and more properties than are kept. */
static void test_many_names(void **state) {
    (void)state;
    fixture f;
    text t = {0};
    char one[64];
    setup(&f);
    append(&t, "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"line\", \"filter\": [\"match\", [\"get\", "
               "\"n\"], [\"x77777\"");
    for (int i = 0; i < 100000; i++) {
        snprintf(one, sizeof one, ",\"x%d\"", i);
        append(&t, one);
    }
    append(&t, "], true, false]}]}");
    assert_int_equal(parse(&f, t.bytes), CAMBER_ERROR_INPUT);
    assert_non_null(strstr(f.error, "\"x77777\" occurs twice"));
    free(t.bytes);
    t = (text){0};
    append(&t, "{\"version\": 8, \"layers\": [{\"id\": \"a\", \"type\": \"line\", \"filter\": [\"any\"");
    for (int i = 0; i < 100000; i++) {
        snprintf(one, sizeof one, ",[\"has\",\"x%d\"]", i);
        append(&t, one);
    }
    append(&t, "]}]}");
    assert_int_equal(parse(&f, t.bytes), CAMBER_ERROR_INPUT);
    assert_non_null(strstr(f.error, "feature properties are read"));
    free(t.bytes);
    teardown(&f);
}

/* Every prefix and many single-byte changes of a document end in a status, with one error where they fail. */
static void test_damage(void **state) {
    (void)state;
    const char *json =
        LINE("\"filter\": [\"all\", [\"in\", \"h\", \"a\", 2], [\"!\", [\"has\", \"t\"]], [\"match\", "
             "[\"to-string\", [\"get\", \"b\"]], [\"\", \"0\"], true, false]], \"paint\": {\"line-width\": "
             "[\"interpolate\", [\"exponential\", 1.5], [\"zoom\"], 4, [\"+\", 1, 2], 22, 9], "
             "\"line-color\": {\"stops\": [[1, \"red\"], [2, \"hsl(1, 2%, 3%)\"]]}}");
    static const char bytes[] = "\"[]{},:0-9ae \\\x01\xff\x80";
    const size_t length = strlen(json);
    char *copy = malloc(length + 1);
    assert_non_null(copy);
    fixture f;
    setup(&f);
    assert_int_equal(parse(&f, json), CAMBER_OK);
    camber_style_destroy(f.style);
    f.style = NULL;
    for (size_t i = 0; i < length; i++) {
        memcpy(copy, json, length + 1);
        copy[i] = 0;
        assert_int_equal(parse(&f, copy), CAMBER_ERROR_INPUT);
        for (size_t b = 0; b + 1 < sizeof bytes; b++) {
            memcpy(copy, json, length + 1);
            copy[i] = bytes[b];
            f.error_count = 0;
            const camber_status status = parse(&f, copy);
            assert_true(status == CAMBER_OK || (status == CAMBER_ERROR_INPUT && f.error_count == 1));
            camber_style_destroy(f.style);
            f.style = NULL;
        }
    }
    free(copy);
    teardown(&f);
}

/* Filters of features that lack what is read, by type of geometry; a null that a feature has is no lack. */
static void test_absent_properties(void **state) {
    (void)state;
    static const struct {
        const char *filter;
        bool absent[3], null[3]; /* of points, lines, polygons */
    } cases[] = {
        {"[\"has\", \"a\"]", {false, false, false}, {true, true, true}},
        {"[\"!\", [\"has\", \"a\"]]", {true, true, true}, {false, false, false}},
        {"[\"all\", [\"!\", [\"has\", \"a\"]], [\"==\", [\"geometry-type\"], \"Polygon\"]]",
         {false, false, true},
         {false, false, false}},
        {"[\"any\", [\"has\", \"a\"], [\"==\", [\"geometry-type\"], \"LineString\"]]",
         {false, true, false},
         {true, true, true}},
        {"[\"==\", [\"coalesce\", [\"get\", \"a\"], \"x\"], \"x\"]", {true, true, true}, {true, true, true}},
        {"[\">\", [\"get\", \"a\"], 3]", {false, false, false}, {false, false, false}}, /* it fails */
        {"[\"has\", \"a\", [\"properties\"]]", {false, false, false}, {false, false, false}},
    };
    static const char *const types[] = {"Point", "LineString", "Polygon"};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[1024];
        fixture f;
        setup(&f);
        snprintf(json, sizeof json, LINE("\"source\": \"s\", \"filter\": %s"), cases[i].filter);
        assert_int_equal(parse(&f, json), CAMBER_OK);
        assert_true(f.style->schema.property_count <= 1);
        for (int k = 0; k < 3; k++) {
            camber_value value = {.type = CAMBER_VALUE_NULL};
            const camber_feature_view view = {.values = &value, .geometry_type = types[k]};
            assert_int_equal(camber_style_layer_matches(f.style->layers, 10.0, &view), cases[i].absent[k]);
            value.boolean = true;
            assert_int_equal(camber_style_layer_matches(f.style->layers, 10.0, &view), cases[i].null[k]);
        }
        teardown(&f);
    }
}

/* Whichever allocation fails, nothing leaks and the status says so. */
static void test_memory(void **state) {
    (void)state;
    const char *json =
        LINE("\"source\": \"s\", \"filter\": [\"all\", [\"in\", \"h\", \"a\", 2], [\"match\", [\"to-string\", "
             "[\"get\", \"b\"]], [\"\", \"0\"], true, false]], \"layout\": {\"line-cap\": [\"to-string\", "
             "\"round\"]}, \"paint\": {\"line-width\": [\"step\", [\"zoom\"], 4, 5, 6]}");
    camber_status status = CAMBER_ERROR_MEMORY;
    for (size_t count = 0; status == CAMBER_ERROR_MEMORY; count++) {
        fixture f;
        setup(&f);
        f.allocations_left = count;
        status = parse(&f, json);
        assert_true(status == CAMBER_OK || status == CAMBER_ERROR_MEMORY);
        assert_true(status == CAMBER_OK || f.style == NULL);
        assert_true(status == CAMBER_OK || f.error_count == 1);
        if (status == CAMBER_OK) {
            assert_in_range(count, 20, 1000);
            assert_int_equal(camber_style_layer_paint(f.style->layers, 0.0, NULL).cap, CAMBER_CAP_ROUND);
        }
        teardown(&f);
    }
}

/* ---- The reference ---- */

/* Every property of line, fill and background layers in the specification's reference of August 2026, but visibility
 * and fill-layer-blend. */
static void test_reference(void **state) {
    (void)state;
    enum range { RANGE_ANY, RANGE_FROM_0, RANGE_UNIT };
    static const struct {
        const char *name;
        bool layout;
        camber_type type;
        const char *fallback;
        uint32_t length;
        enum range range;
        const char *depends; /* zoom, feature, line-progress, interpolated */
    } reference[] = {
        {"line-cap", true, CAMBER_TYPE_STRING, "\"butt\"", 0, RANGE_ANY, "zf"},
        {"line-join", true, CAMBER_TYPE_STRING, "\"miter\"", 0, RANGE_ANY, "zf"},
        {"line-miter-limit", true, CAMBER_TYPE_NUMBER, "2", 0, RANGE_ANY, "zfi"},
        {"line-round-limit", true, CAMBER_TYPE_NUMBER, "1.05", 0, RANGE_ANY, "zfi"},
        {"line-sort-key", true, CAMBER_TYPE_NUMBER, NULL, 0, RANGE_ANY, "zf"},
        {"line-opacity", false, CAMBER_TYPE_NUMBER, "1", 0, RANGE_UNIT, "zfi"},
        {"line-layer-opacity", false, CAMBER_TYPE_NUMBER, "1", 0, RANGE_UNIT, "zi"},
        {"line-color", false, CAMBER_TYPE_COLOR, "\"#000000\"", 0, RANGE_ANY, "zfi"},
        {"line-translate", false, CAMBER_TYPE_ARRAY, "[0, 0]", 2, RANGE_ANY, "zi"},
        {"line-translate-anchor", false, CAMBER_TYPE_STRING, "\"map\"", 0, RANGE_ANY, "z"},
        {"line-width", false, CAMBER_TYPE_NUMBER, "1", 0, RANGE_FROM_0, "zfi"},
        {"line-gap-width", false, CAMBER_TYPE_NUMBER, "0", 0, RANGE_FROM_0, "zfi"},
        {"line-offset", false, CAMBER_TYPE_NUMBER, "0", 0, RANGE_ANY, "zfi"},
        {"line-blur", false, CAMBER_TYPE_NUMBER, "0", 0, RANGE_FROM_0, "zfi"},
        {"line-dasharray", false, CAMBER_TYPE_ARRAY, NULL, 0, RANGE_FROM_0, "zf"},
        {"line-pattern", false, CAMBER_TYPE_IMAGE, NULL, 0, RANGE_ANY, "zf"},
        {"line-gradient", false, CAMBER_TYPE_COLOR, NULL, 0, RANGE_ANY, "pi"},
        {"fill-sort-key", true, CAMBER_TYPE_NUMBER, NULL, 0, RANGE_ANY, "zf"},
        {"fill-antialias", false, CAMBER_TYPE_BOOL, "true", 0, RANGE_ANY, "z"},
        {"fill-opacity", false, CAMBER_TYPE_NUMBER, "1", 0, RANGE_UNIT, "zfi"},
        {"fill-layer-opacity", false, CAMBER_TYPE_NUMBER, "1", 0, RANGE_UNIT, "zi"},
        {"fill-color", false, CAMBER_TYPE_COLOR, "\"#000000\"", 0, RANGE_ANY, "zfi"},
        {"fill-outline-color", false, CAMBER_TYPE_COLOR, NULL, 0, RANGE_ANY, "zfi"},
        {"fill-translate", false, CAMBER_TYPE_ARRAY, "[0, 0]", 2, RANGE_ANY, "zi"},
        {"fill-translate-anchor", false, CAMBER_TYPE_STRING, "\"map\"", 0, RANGE_ANY, "z"},
        {"fill-pattern", false, CAMBER_TYPE_IMAGE, NULL, 0, RANGE_ANY, "zf"},
        {"circle-sort-key", true, CAMBER_TYPE_NUMBER, NULL, 0, RANGE_ANY, "zf"},
        {"circle-radius", false, CAMBER_TYPE_NUMBER, "5", 0, RANGE_FROM_0, "zfi"},
        {"circle-color", false, CAMBER_TYPE_COLOR, "\"#000000\"", 0, RANGE_ANY, "zfi"},
        {"circle-blur", false, CAMBER_TYPE_NUMBER, "0", 0, RANGE_ANY, "zfi"},
        {"circle-opacity", false, CAMBER_TYPE_NUMBER, "1", 0, RANGE_UNIT, "zfi"},
        {"circle-translate", false, CAMBER_TYPE_ARRAY, "[0, 0]", 2, RANGE_ANY, "zi"},
        {"circle-translate-anchor", false, CAMBER_TYPE_STRING, "\"map\"", 0, RANGE_ANY, "z"},
        {"circle-pitch-scale", false, CAMBER_TYPE_STRING, "\"map\"", 0, RANGE_ANY, "z"},
        {"circle-pitch-alignment", false, CAMBER_TYPE_STRING, "\"viewport\"", 0, RANGE_ANY, "z"},
        {"circle-stroke-width", false, CAMBER_TYPE_NUMBER, "0", 0, RANGE_FROM_0, "zfi"},
        {"circle-stroke-color", false, CAMBER_TYPE_COLOR, "\"#000000\"", 0, RANGE_ANY, "zfi"},
        {"circle-stroke-opacity", false, CAMBER_TYPE_NUMBER, "1", 0, RANGE_UNIT, "zfi"},
        {"background-color", false, CAMBER_TYPE_COLOR, "\"#000000\"", 0, RANGE_ANY, "zi"},
        {"background-pattern", false, CAMBER_TYPE_IMAGE, NULL, 0, RANGE_ANY, "z"},
        {"background-opacity", false, CAMBER_TYPE_NUMBER, "1", 0, RANGE_UNIT, "zi"},
    };
    for (size_t i = 0; i < sizeof reference / sizeof *reference; i++) {
        const char *name = reference[i].name, *depends = reference[i].depends;
        const camber_layer_kind kind = name[0] == 'l'   ? CAMBER_LAYER_LINE
                                       : name[0] == 'f' ? CAMBER_LAYER_FILL
                                       : name[0] == 'c' ? CAMBER_LAYER_CIRCLE
                                                        : CAMBER_LAYER_BACKGROUND;
        const camber_property_row *row = camber_property_find(kind, reference[i].layout, name);
        if (!row) {
            fail_msg("%s is not known", name);
            return;
        }
        const camber_property *property = &row->property;
        assert_int_equal(property->type, reference[i].type);
        assert_int_equal(property->length, reference[i].length);
        assert_int_equal(!property->without_zoom, strchr(depends, 'z') != NULL);
        assert_int_equal(property->data_driven, strchr(depends, 'f') != NULL);
        assert_int_equal(property->line_progress, strchr(depends, 'p') != NULL);
        assert_int_equal(property->interpolated, strchr(depends, 'i') != NULL);
        assert_int_equal(property->fallback != NULL, reference[i].fallback != NULL);
        if (property->fallback)
            assert_string_equal(property->fallback, reference[i].fallback);
        assert_true(fabs(property->low) <= 0.0);
        assert_true(reference[i].range == RANGE_ANY    ? fabs(property->high) <= 0.0
                    : reference[i].range == RANGE_UNIT ? fabs(property->high - 1.0) <= 0.0
                                                       : property->high >= HUGE_VAL);
    }
}

/* Each property is one element of a set of properties. */
static void test_sets(void **state) {
    (void)state;
    for (unsigned one = 0; one < CAMBER_PROPERTIES; one++) {
        camber_property_set set = {{0}};
        camber_property_set_add(&set, (camber_property_id)one);
        for (unsigned other = 0; other < CAMBER_PROPERTIES; other++)
            assert_int_equal(camber_property_set_has(&set, (camber_property_id)other), one == other);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_roads),
        cmocka_unit_test(test_builtin),
        cmocka_unit_test(test_fill),
        cmocka_unit_test(test_wrong_fills),
        cmocka_unit_test(test_circle),
        cmocka_unit_test(test_layer),
        cmocka_unit_test(test_plain),
        cmocka_unit_test(test_odd_dashes),
        cmocka_unit_test(test_warnings),
        cmocka_unit_test(test_left_out),
        cmocka_unit_test(test_filter_by_zoom),
        cmocka_unit_test(test_states),
        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_wrong),
        cmocka_unit_test(test_nesting),
        cmocka_unit_test(test_many),
        cmocka_unit_test(test_many_names),
        cmocka_unit_test(test_damage),
        cmocka_unit_test(test_absent_properties),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_long_pointers),
        cmocka_unit_test(test_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
