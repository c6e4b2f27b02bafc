/* Makes TileJSON for the served content. Its member "camber" is for the page. */
#include "serve/tilejson.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The size of the picture with which viewers typically start, in CSS px, and the size of a tile. */
enum { VIEW_WIDTH = 1024, VIEW_HEIGHT = 768, TILE_WIDTH = 256, DEEPEST_CENTER = 15 };

static json_t *numbers(const double *values, size_t count) {
    json_t *array = json_array();
    for (size_t i = 0; array && i < count; i++)
        json_array_append_new(array, json_real(values[i]));
    return array;
}

static double mercator_y(double latitude) {
    const double angle = fmax(-85.05, fmin(85.05, latitude)) * 0.017453292519943295;
    return 0.5 - asinh(tan(angle)) / 6.283185307179586;
}

/* Finds the middle of the bounds, and the zoom that shows all of them. */
static void find_center(const camber_server_content *content, double center[3]) {
    const double *b = content->bounds;
    const double degrees = b[2] < b[0] ? b[2] - b[0] + 360.0 : b[2] - b[0]; /* they cross the antimeridian */
    const double across = fmax(degrees / 360.0, 1e-9), down = fmax(mercator_y(b[1]) - mercator_y(b[3]), 1e-9);
    const double zoom = floor(log2(fmin(VIEW_WIDTH / across, VIEW_HEIGHT / down) / TILE_WIDTH));
    center[0] = b[0] + 0.5 * degrees;
    center[0] -= center[0] > 180.0 ? 360.0 : 0.0;
    center[1] = 0.5 * (b[1] + b[3]);
    center[2] = fmax(content->min_zoom, fmin(zoom, fmin(content->max_zoom, DEEPEST_CENTER)));
}

/* Limits a zoom of an archive, which may be any number. */
static int limit_zoom(int zoom) {
    return zoom < 0 ? 0 : zoom > CAMBER_ROUTE_MOST_ZOOM ? CAMBER_ROUTE_MOST_ZOOM : zoom;
}

static json_t *describe_tiles(const camber_tilejson_desc *desc, const char *ending) {
    const size_t size = strlen(desc->url) + 64;
    char *text = malloc(size);
    if (!text)
        return NULL;
    snprintf(text, size, "%s%s/{z}/{x}/{y}.%s", desc->url, desc->below_dark ? "/dark" : "", ending);
    json_t *array = json_pack("[s]", text);
    free(text);
    return array;
}

/* Copies the layers of vector tiles, and the archive's description of itself. */
static void take_metadata(json_t *object, const char *metadata) {
    static const char *const taken[] = {"vector_layers", "description", "version", "legend"};
    json_t *about = metadata ? json_loads(metadata, 0, NULL) : NULL;
    for (size_t i = 0; i < sizeof taken / sizeof *taken; i++)
        if (json_object_get(about, taken[i]))
            json_object_set(object, taken[i], json_object_get(about, taken[i]));
    json_decref(about);
}

/* Reads a number, which is a string in MBTiles. */
static double read_number(const json_t *value) {
    return json_is_string(value) ? strtod(json_string_value(value), NULL) : json_number_value(value);
}

/* Returns the width of a tile in CSS px, as camber tiles records it in an archive. MapLibre reads it from TileJSON,
 * too, and assumes 512 if it is missing. */
static int find_tile_size(const camber_server_content *content) {
    json_t *about = content->metadata ? json_loads(content->metadata, 0, NULL) : NULL;
    const double size_px = read_number(json_object_get(about, "tileSize"));
    const double ratio = fmax(read_number(json_object_get(about, "ratio")), 1.0);
    json_decref(about);
    return size_px / ratio == 512.0 ? 512 : TILE_WIDTH;
}

static bool set(json_t *object, const char *name, json_t *value) {
    return json_object_set_new(object, name, value) == 0;
}

camber_body *camber_tilejson_create(const camber_tilejson_desc *desc) {
    const camber_server_content *content = desc->content;
    const char *ending = "png";
    camber_route_type type;
    double center[3] = {content->center[0], content->center[1], content->center[2]};
    if (content->reader && camber_route_find_type(camber_tiles_reader_get_info(content->reader)->type, &type))
        ending = camber_route_get_ending(type);
    if (content->has_bounds && !content->has_center)
        find_center(content, center);
    center[2] = limit_zoom((int)fmax(-1, fmin(center[2], CAMBER_ROUTE_MOST_ZOOM)));
    json_t *object = json_object();
    take_metadata(object, content->metadata);
    bool made = set(object, "tilejson", json_string("3.0.0")) && set(object, "scheme", json_string("xyz")) &&
                set(object, "tiles", describe_tiles(desc, ending)) &&
                set(object, "minzoom", json_integer(limit_zoom(content->min_zoom))) &&
                set(object, "maxzoom", json_integer(limit_zoom(content->max_zoom))) &&
                set(object, "tileSize", json_integer(find_tile_size(content))) &&
                set(object, "camber",
                    json_pack("{s:s?, s:b, s:i, s:b}", "theme", desc->theme, "drawn", !content->reader, "ratio_max",
                              content->reader ? 1 : (int)desc->most_ratio, "edit", desc->edits));
    if (content->name)
        made = made && set(object, "name", json_string(content->name));
    if (content->attribution)
        made = made && set(object, "attribution", json_string(content->attribution));
    if (content->has_bounds)
        made = made && set(object, "bounds", numbers(content->bounds, 4));
    if (content->has_bounds || content->has_center)
        made = made && set(object, "center", numbers(center, 3));
    char *text = made ? json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;
    camber_body *body = text ? camber_body_create(text, strlen(text)) : NULL;
    free(text);
    json_decref(object);
    return body;
}
