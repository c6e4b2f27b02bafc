/* Lines of a city in three classes, if asked with areas and names, as a style of camber's, as GeoJSON that Mapnik keeps
 * in memory, and as shapefiles with an index for renderd, whose Mapnik is older. */
#define _XOPEN_SOURCE 700 /* mkdtemp */

#include "pyramid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MAJOR "'motorway','trunk','primary','motorway_link','trunk_link','primary_link'"
#define MIDDLE "'secondary','tertiary','secondary_link','tertiary_link'"

enum { FIRST_ZOOM = 10, ZOOMS = 7 }; /* 10 to 16 */

/* From the lowest on: as a road map has them, a casing below all fills, both wider at higher zooms. */
static const struct {
    const char *name, *where, *color, *casing;
    double width_px[ZOOMS];
} classes[] = {
    {"minor",
     "highway IS NOT NULL AND highway NOT IN (" MAJOR "," MIDDLE ")",
     "#ffffff",
     "#c0b6a5",
     {0.5, 0.6, 0.8, 1.1, 1.7, 2.8, 5}},
    {"middle", "highway IN (" MIDDLE ")", "#fbe3a4", "#d0ac5e", {1, 1.2, 1.6, 2.1, 3, 4.4, 7.5}},
    {"major", "highway IN (" MAJOR ")", "#f6c177", "#c98a42", {1.3, 1.6, 2.1, 2.7, 3.8, 5.5, 9}},
};
static const double casing_px[ZOOMS] = {0.4, 0.5, 0.6, 0.8, 1.1, 1.4, 1.8};
enum { CLASSES = sizeof classes / sizeof *classes, LAYERS = 2 * CLASSES, COMMAND_SIZE = 4096 };
#define BACKGROUND "#f6f2ea"

/* Areas, from the lowest on. values "": any. */
static const struct {
    const char *name, *key, *values, *color;
    int first_zoom;
} areas[] = {
    {"fields", "landuse", "'grass','meadow','forest','farmland','cemetery'", "#dfe8cf", FIRST_ZOOM},
    {"wood", "natural", "'wood','scrub','grassland'", "#cfe0bd", FIRST_ZOOM},
    {"parks", "leisure", "'park','garden','pitch'", "#cde5bb", FIRST_ZOOM},
    {"water", "natural", "'water'", "#aaccdd", FIRST_ZOOM},
    {"buildings", "building", "", "#e0d6c8", 14},
};
enum { AREAS = sizeof areas / sizeof *areas };

/* Names, from the lowest on: those of streets along the lines of a class, and of places about points. */
#define PLACES "'city','town','village','suburb','quarter','neighbourhood','hamlet'"
#define FONT "Noto Sans Regular"
static const struct {
    const char *name; /* of the class */
    bool along;
    double size_px;
    int first_zoom;
} texts[] = {{"minor", true, 11, 15}, {"middle", true, 11, 13}, {"major", true, 12, 12}, {"places", false, 15, 10}};
enum { NAMES = sizeof texts / sizeof *texts, SPACING_PX = 250 };
static const double halo_px = 1.5;
#define NAME_COLOR "#333333"
#define HALO_COLOR "#ffffff"

/* Layers from the lowest on: the casings of all classes, then their fills. */
static double width_at(size_t layer, size_t zoom) {
    return classes[layer % CLASSES].width_px[zoom] + (layer < CLASSES ? casing_px[zoom] : 0);
}

static const char *color_of(size_t layer) {
    return layer < CLASSES ? classes[layer].casing : classes[layer % CLASSES].color;
}

/* ["motorway", ...] of SQL's list. */
static void add_names(json_t *array, const char *sql) {
    char names[512];
    snprintf(names, sizeof names, "%s", sql);
    for (char *name = strtok(names, "',"); name; name = strtok(NULL, "',"))
        json_array_append_new(array, json_string(name));
}

static json_t *make_filter(size_t at) {
    json_t *names = json_array();
    if (at != 1)
        add_names(names, MAJOR);
    if (at != 2)
        add_names(names, MIDDLE);
    json_t *match = json_pack("[s, [s, s], o, b, b]", "match", "get", "highway", names, at != 0, at == 0);
    return json_pack("[s, [s, s], o]", "all", "has", "highway", match);
}

/* Steps between a style's zooms: a tile of 256 px has one more. */
static json_t *make_widths(size_t layer) {
    json_t *step = json_pack("[s, [s], f]", "step", "zoom", width_at(layer, 0));
    for (size_t zoom = 1; zoom < ZOOMS; zoom++) {
        json_array_append_new(step, json_real(FIRST_ZOOM + (double)zoom - 1.5));
        json_array_append_new(step, json_real(width_at(layer, zoom)));
    }
    return step;
}

static json_t *make_match(const char *key, const char *sql) {
    json_t *values = json_array();
    add_names(values, sql);
    if (json_array_size(values) > 0)
        return json_pack("[s, [s, s], o, b, b]", "match", "get", key, values, 1, 0);
    json_decref(values);
    return json_pack("[s, s]", "has", key);
}

static void add_areas(json_t *layers) {
    for (size_t i = 0; i < AREAS; i++)
        json_array_append_new(layers,
                              json_pack("{s:s, s:s, s:i, s:o, s:{s:s}}", "id", areas[i].name, "type", "fill", "minzoom",
                                        areas[i].first_zoom - 1, "filter", make_match(areas[i].key, areas[i].values),
                                        "paint", "fill-color", areas[i].color));
}

static void add_texts(json_t *layers) {
    for (size_t i = 0; i < NAMES; i++) {
        char id[64];
        snprintf(id, sizeof id, "names of %s", texts[i].name);
        json_t *layout = json_pack("{s:s, s:[s, s], s:[s], s:f, s:i}", "symbol-placement",
                                   texts[i].along ? "line" : "point", "text-field", "get", "name", "text-font", FONT,
                                   "text-size", texts[i].size_px, "symbol-spacing", SPACING_PX);
        json_array_append_new(layers, json_pack("{s:s, s:s, s:i, s:o, s:o, s:{s:s, s:s, s:f}}", "id", id, "type",
                                                "symbol", "minzoom", texts[i].first_zoom - 1, "filter",
                                                texts[i].along ? make_filter(i) : make_match("place", PLACES), "layout",
                                                layout, "paint", "text-color", NAME_COLOR, "text-halo-color",
                                                HALO_COLOR, "text-halo-width", halo_px));
    }
}

static bool write_style(const bench_pyramid *p) {
    json_t *layers = json_pack("[{s:s, s:s, s:{s:s}}]", "id", "ground", "type", "background", "paint",
                               "background-color", BACKGROUND);
    if (p->labelled)
        add_areas(layers);
    for (size_t i = 0; i < LAYERS; i++) {
        char id[64];
        snprintf(id, sizeof id, "%s %s", classes[i % CLASSES].name, i < CLASSES ? "casing" : "fill");
        json_array_append_new(layers,
                              json_pack("{s:s, s:s, s:o, s:{s:s, s:s}, s:{s:s, s:o}}", "id", id, "type", "line",
                                        "filter", make_filter(i % CLASSES), "layout", "line-join", "round", "line-cap",
                                        "round", "paint", "line-color", color_of(i), "line-width", make_widths(i)));
    }
    if (p->labelled)
        add_texts(layers);
    json_t *style = json_pack("{s:i, s:{}, s:o}", "version", 8, "sources", "layers", layers);
    const bool written = json_dump_file(style, p->style, JSON_INDENT(1)) == 0;
    json_decref(style);
    return written;
}

bool bench_pyramid_open(bench_pyramid *p) {
    snprintf(p->folder, sizeof p->folder, "/tmp/camber_bench.XXXXXX");
    if (!mkdtemp(p->folder))
        return false;
    snprintf(p->style, sizeof p->style, "%s/lines.json", p->folder);
    return write_style(p);
}

void bench_pyramid_close(const bench_pyramid *p) {
    const char *const arguments[] = {"rm", "-r", p->folder, NULL};
    free(bench_child_run(arguments, NULL, NULL).output);
}

/* ---- Runs ---- */

json_t *bench_pyramid_draw(const bench *b, const bench_pyramid *p, const char *name, const char *const *options) {
    char output[128], low[16], high[16];
    const char *arguments[32] = {b->tool,      "tiles",  p->city,         "-o",     output,       "-f",
                                 "-q",         "--json", "--style",       p->style, "--min-zoom", low,
                                 "--max-zoom", high,     "--attribution", ""};
    size_t count = 16;
    snprintf(output, sizeof output, "%s/%s", p->folder, name);
    snprintf(low, sizeof low, "%d", p->min_zoom);
    snprintf(high, sizeof high, "%d", p->max_zoom);
    while (*options && count < sizeof arguments / sizeof *arguments - 1)
        arguments[count++] = *options++;
    (void)unlink(output); /* to replace the last run's would take time by its size, in one thread */
    const bench_child child = bench_child_run(arguments, NULL, NULL);
    json_t *said = child.output ? json_loads(child.output, 0, NULL) : NULL;
    free(child.output);
    if (child.status != 0 || !said) {
        fprintf(stderr, "camber tiles %s: exit status %d\n", output, child.status);
        json_decref(said);
        return NULL;
    }
    json_object_set_new(said, "wall_ms", json_real(child.wall_ms));
    return said;
}

double bench_pyramid_shell(const bench_pyramid *p, const char *command) {
    char whole[COMMAND_SIZE + 128];
    snprintf(whole, sizeof whole, "cd %s && { %s; }", p->folder, command);
    const char *const arguments[] = {"sh", "-c", whole, NULL};
    const bench_child child = bench_child_run(arguments, NULL, NULL);
    free(child.output);
    return child.status == 0 ? child.wall_ms : -1;
}

/* ---- Peers ---- */

/* Begins a rule whose scale lies within the bounds of zooms. */
static void begin_rule(int first_zoom, int last_zoom, FILE *file) {
    const double world = 559082264.028; /* scale denominator of zoom 0 with tiles of 256 px */
    fprintf(file,
            "<Rule><MinScaleDenominator>%.0f</MinScaleDenominator><MaxScaleDenominator>%.0f</MaxScaleDenominator>",
            0.7 * world / (double)(1 << last_zoom), 1.4 * world / (double)(1 << first_zoom));
}

/* Writes a rule for each zoom. Mapnik leaves out as much detail as camber does. */
static void write_line_rules(size_t layer, FILE *file) {
    for (int zoom = 0; zoom < ZOOMS; zoom++) {
        begin_rule(FIRST_ZOOM + zoom, FIRST_ZOOM + zoom, file);
        fprintf(file,
                "<LineSymbolizer stroke=\"%s\" stroke-width=\"%g\" stroke-linejoin=\"round\" "
                "stroke-linecap=\"round\" simplify=\"%g\"/></Rule>\n",
                color_of(layer), width_at(layer, (size_t)zoom), BENCH_SIMPLIFY_PX);
    }
}

static void write_area_rule(size_t area, FILE *file) {
    begin_rule(areas[area].first_zoom, FIRST_ZOOM + ZOOMS - 1, file);
    fprintf(file, "<PolygonSymbolizer fill=\"%s\" simplify=\"%g\"/></Rule>\n", areas[area].color, BENCH_SIMPLIFY_PX);
}

static void write_name_rule(size_t name, FILE *file) {
    begin_rule(texts[name].first_zoom, FIRST_ZOOM + ZOOMS - 1, file);
    fprintf(file,
            "<Filter>[name] != ''</Filter><TextSymbolizer face-name=\"" FONT "\" size=\"%g\" fill=\"" NAME_COLOR
            "\" halo-fill=\"" HALO_COLOR "\" halo-radius=\"%g\" placement=\"%s\" spacing=\"%d\" "
            "repeat-distance=\"%d\">[name]</TextSymbolizer></Rule>\n",
            texts[name].size_px, halo_px, texts[name].along ? "line" : "point", SPACING_PX, SPACING_PX / 2);
}

/* Whether the city has features of the name. */
static bool has_features(const bench_pyramid *p, const char *name) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s.shp", p->folder, name);
    return access(path, R_OK) == 0;
}

/* Ends a style and adds the layer that it draws. */
static void write_layer(const bench_pyramid *p, const char *id, const char *type, const char *source, FILE *file) {
    fprintf(file,
            "</Style>\n<Layer name=\"%s\" srs=\"epsg:3857\"><StyleName>%s</StyleName><Datasource>"
            "<Parameter name=\"type\">%s</Parameter><Parameter name=\"file\">%s/%s.%s</Parameter>"
            "</Datasource></Layer>\n",
            id, id, type, p->folder, source, strcmp(type, "shape") == 0 ? "shp" : type);
}

static bool write_map(const bench_pyramid *p, const char *type) {
    char path[128], id[64];
    snprintf(path, sizeof path, "%s/%s.xml", p->folder, type);
    FILE *file = fopen(path, "w");
    if (!file)
        return false;
    fprintf(file,
            "<Map srs=\"epsg:3857\" background-color=\"" BACKGROUND "\" font-directory=\"" CAMBER_BENCH_FONTS "\">\n");
    for (size_t i = 0; i < AREAS && p->labelled; i++) {
        if (!has_features(p, areas[i].name))
            continue;
        fprintf(file, "<Style name=\"%s\">", areas[i].name);
        write_area_rule(i, file);
        write_layer(p, areas[i].name, type, areas[i].name, file);
    }
    for (size_t i = 0; i < LAYERS; i++) {
        snprintf(id, sizeof id, "%zu", i);
        fprintf(file, "<Style name=\"%s\">", id);
        write_line_rules(i, file);
        write_layer(p, id, type, classes[i % CLASSES].name, file);
    }
    for (size_t i = NAMES; i-- > 0 && p->labelled;) { /* Mapnik places the first layer's names first */
        if (!has_features(p, texts[i].name))
            continue;
        snprintf(id, sizeof id, "names of %s", texts[i].name);
        fprintf(file, "<Style name=\"%s\">", id);
        write_name_rule(i, file);
        write_layer(p, id, type, texts[i].name, file);
    }
    fprintf(file, "</Map>\n");
    return fclose(file) == 0;
}

/* Writes features of the city as NAME.geojson and, if there are any, NAME.shp. */
static bool write_features(const bench_pyramid *p, const char *name, const char *layer, const char *where,
                           const char *fields) {
    char command[COMMAND_SIZE];
    snprintf(command, sizeof command,
             "ogr2ogr -q -f GeoJSON %s.geojson %s %s -where \"%s\" -select %s -t_srs EPSG:3857 "
             "-lco COORDINATE_PRECISION=2 2>ogr.log && { ! grep -q coordinates %s.geojson || "
             "{ ogr2ogr -q -lco ENCODING=UTF-8 %s.shp %s.geojson 2>ogr.log && "
             "{ ! command -v shapeindex || shapeindex %s.shp 2>index.log; } } }",
             name, p->city, layer, where, fields, name, name, name, name);
    return bench_pyramid_shell(p, command) >= 0;
}

bool bench_pyramid_write_maps(const bench_pyramid *p) {
    char where[COMMAND_SIZE / 4];
    bool written = true;
    for (size_t i = 0; i < CLASSES && written; i++)
        written = write_features(p, classes[i].name, "lines", classes[i].where, "highway,name");
    for (size_t i = 0; i < AREAS && p->labelled && written; i++) {
        snprintf(where, sizeof where, *areas[i].values ? "%s IN (%s)" : "%s IS NOT NULL", areas[i].key,
                 areas[i].values);
        written = write_features(p, areas[i].name, "multipolygons", where, areas[i].key);
    }
    if (p->labelled && written)
        written = write_features(p, "places", "points", "place IN (" PLACES ")", "place,name");
    return written && write_map(p, "geojson") && write_map(p, "shape");
}

static json_t *run_peer(const char *const *arguments, const char *input) {
    const bench_child child = bench_child_run(arguments, NULL, input);
    json_t *said = child.status == 0 && child.output ? json_loads(child.output, 0, NULL) : NULL;
    free(child.output);
    return said;
}

json_t *bench_pyramid_mapnik(const bench_pyramid *p, const char *format, size_t runs) {
    char xml[128], box[128], low[16], high[16], count[16];
    static const char program[] = CAMBER_BENCH_PEERS "/mapnik_tiles.mjs";
    const char *const arguments[] = {"node", program, xml, box, low, high, format, count, NULL};
    snprintf(xml, sizeof xml, "%s/geojson.xml", p->folder);
    snprintf(box, sizeof box, "%.7f,%.7f,%.7f,%.7f", p->box[0], p->box[1], p->box[2], p->box[3]);
    snprintf(low, sizeof low, "%d", p->min_zoom);
    snprintf(high, sizeof high, "%d", p->max_zoom);
    snprintf(count, sizeof count, "%zu", runs);
    setenv("NODE_PATH", CAMBER_BENCH_NPM, 1);
    return run_peer(arguments, NULL);
}

/* The tile that a place lies in. */
static int tile_of(double share, int zoom) {
    const int last = (1 << zoom) - 1, tile = (int)floor(share * (1 << zoom));
    return tile < 0 ? 0 : tile > last ? last : tile;
}

static double share_of_latitude(double latitude) {
    const double pi = 3.14159265358979323846;
    return (1 - asinh(tan(latitude * pi / 180)) / pi) / 2;
}

json_t *bench_pyramid_renderd(const bench_pyramid *p, const char *format) {
    char xml[128], ranges[2048];
    size_t used = 0;
    static const char program[] = CAMBER_BENCH_PEERS "/renderd_tiles.sh";
    const char *const arguments[] = {"sh", program, p->folder, xml, format, NULL};
    snprintf(xml, sizeof xml, "%s/shape.xml", p->folder);
    for (int zoom = p->min_zoom; zoom <= p->max_zoom; zoom++)
        used +=
            (size_t)snprintf(ranges + used, sizeof ranges - used, "%d %d %d %d %d\n", zoom,
                             tile_of((p->box[0] + 180) / 360, zoom), tile_of((p->box[2] + 180) / 360, zoom),
                             tile_of(share_of_latitude(p->box[3]), zoom), tile_of(share_of_latitude(p->box[1]), zoom));
    return run_peer(arguments, ranges);
}
