/* Parses paths with a fixed table. Numbers are decimal, without signs, blanks or leading zeros, so that each tile has
 * only one path. Anything else makes a path unknown. */
#include "serve/route.h"

#include <math.h>
#include <string.h>

enum { MOST_DIGITS = 8, MOST_PITCH_DEG = 85, MOST_FRACTION_DIGITS = 15 };

/* The limit of Web Mercator; the centre of a picture must be within it. */
static const double MOST_LATITUDE = 85.051129, PI = 3.14159265358979323846;

static const struct {
    const char *ending, *other, *media_type;
} types[CAMBER_ROUTE_TYPES] = {
    [CAMBER_ROUTE_PNG] = {"png", NULL, "image/png"},
    [CAMBER_ROUTE_WEBP] = {"webp", NULL, "image/webp"},
    [CAMBER_ROUTE_JPEG] = {"jpg", "jpeg", "image/jpeg"},
    [CAMBER_ROUTE_AVIF] = {"avif", NULL, "image/avif"},
    [CAMBER_ROUTE_MVT] = {"pbf", "mvt", "application/vnd.mapbox-vector-tile"},
    [CAMBER_ROUTE_MLT] = {"mlt", NULL, "application/vnd.maplibre-vector-tile"},
    [CAMBER_ROUTE_GLB] = {"glb", NULL, "model/gltf-binary"},
};

const char *camber_route_get_name(camber_route route) {
    static const char *const names[CAMBER_ROUTES] = {"none",   "page",   "tilejson", "tile",    "tileset", "subtree",
                                                     "static", "health", "events",   "metrics", "index",   "folder"};
    return names[route];
}

const char *camber_route_get_media_type(camber_route_type type) {
    return types[type].media_type;
}

const char *camber_route_get_ending(camber_route_type type) {
    return types[type].ending;
}

bool camber_route_find_type(const char *name, camber_route_type *type) {
    for (int i = 0; i < CAMBER_ROUTE_TYPES; i++)
        if (strcmp(name, types[i].ending) == 0 || (types[i].other && strcmp(name, types[i].other) == 0)) {
            *type = (camber_route_type)i;
            return true;
        }
    return false;
}

/* ---- Parsing parts of a path ---- */

/* The rest of the path, which has not been parsed yet. */
typedef struct cursor {
    const char *at, *end;
} cursor;

static bool take(cursor *c, const char *word) {
    const size_t length = strlen(word);
    if ((size_t)(c->end - c->at) < length || memcmp(c->at, word, length) != 0)
        return false;
    c->at += length;
    return true;
}

static bool is_digit(const cursor *c) {
    return c->at < c->end && *c->at >= '0' && *c->at <= '9';
}

static bool take_count(cursor *c, uint32_t *count) {
    const char *first = c->at;
    uint32_t made = 0;
    while (is_digit(c) && c->at - first <= MOST_DIGITS)
        made = 10 * made + (uint32_t)(*c->at++ - '0');
    const ptrdiff_t digits = c->at - first;
    if (digits < 1 || digits > MOST_DIGITS || (*first == '0' && digits > 1))
        return false;
    *count = made;
    return true;
}

/* Parses a number between two bounds: digits, with an optional minus and an optional fraction. */
static bool take_number(cursor *c, double least, double most, double *number) {
    const bool negative = take(c, "-");
    uint32_t whole;
    if (!take_count(c, &whole))
        return false;
    double made = whole, unit = 1.0;
    if (take(c, ".")) {
        const char *first = c->at;
        double fraction = 0.0;
        for (; is_digit(c); c->at++) {
            fraction = 10.0 * fraction + (*c->at - '0');
            unit *= 10.0;
        }
        if (c->at == first || c->at - first > MOST_FRACTION_DIGITS)
            return false;
        made += fraction / unit;
    }
    made = negative ? -made : made;
    if (!(made >= least && made <= most))
        return false;
    *number = made;
    return true;
}

/* Parses [@Rx].type at the end of the path. */
static bool take_ending(cursor *c, camber_route_request *r) {
    r->ratio = 1;
    if (take(c, "@") && (!take_count(c, &r->ratio) || !take(c, "x") || r->ratio < 1))
        return false;
    if (!take(c, "."))
        return false;
    char name[8];
    const size_t length = (size_t)(c->end - c->at);
    if (length >= sizeof name)
        return false;
    memcpy(name, c->at, length);
    name[length] = 0;
    return strlen(name) == length && camber_route_find_type(name, &r->type);
}

double camber_route_find_degrees(int axis, double metres) {
    const double angle = metres / CAMBER_ROUTE_MOST_METRES * PI;
    const double degrees = (axis ? atan(sinh(angle)) : angle) * 180.0 / PI;
    return axis ? fmax(-MOST_LATITUDE, fmin(MOST_LATITUDE, degrees)) : degrees;
}

/* ---- Routes ---- */

static const char SUBTREES[] = "subtrees/";

static bool take_place(cursor *c, const char *between, camber_route_request *r) {
    uint32_t zoom;
    if (!take_count(c, &zoom) || zoom > CAMBER_ROUTE_MOST_ZOOM || !take(c, between) || !take_count(c, &r->column) ||
        !take(c, between) || !take_count(c, &r->row) || r->column >> zoom || r->row >> zoom)
        return false;
    r->zoom = (int)zoom;
    return true;
}

static bool take_tile(cursor *c, const camber_route_limits *limits, camber_route_request *r) {
    r->route = CAMBER_ROUTE_TILE;
    return take_place(c, "/", r) && take_ending(c, r) && r->ratio <= limits->most_ratio;
}

static bool take_subtree(cursor *c, camber_route_request *r) {
    r->route = CAMBER_ROUTE_SUBTREE;
    return take_place(c, ".", r) && take(c, ".subtree") && c->at == c->end;
}

/* 3d-tiles-renderer 0.5 writes two slashes before the paths of files that a tileset at a server's root refers to. */
static bool take_of_tileset(cursor *c, const camber_route_limits *limits, camber_route_request *r) {
    return take(c, SUBTREES) ? take_subtree(c, r) : take_tile(c, limits, r) && r->type == CAMBER_ROUTE_GLB;
}

/* Parses a longitude (axis 0) or a latitude: degrees, or metres of Web Mercator. */
static bool take_coordinate(cursor *c, const camber_route_request *r, int axis, double *degrees) {
    const double most = r->is_raw ? CAMBER_ROUTE_MOST_METRES : axis ? MOST_LATITUDE : 180;
    if (!take_number(c, -most, most, degrees))
        return false;
    if (r->is_raw)
        *degrees = camber_route_find_degrees(axis, *degrees);
    return true;
}

static bool take_bounds(cursor *c, camber_route_request *r) {
    for (int i = 0; i < 4; i++)
        if ((i && !take(c, ",")) || !take_coordinate(c, r, i % 2, r->bounds + i))
            return false;
    return r->bounds[1] <= r->bounds[3];
}

static bool take_center(cursor *c, camber_route_request *r) {
    if (!take_coordinate(c, r, 0, &r->longitude) || !take(c, ",") || !take_coordinate(c, r, 1, &r->latitude) ||
        !take(c, ",") || !take_number(c, 0, CAMBER_ROUTE_MOST_ZOOM, &r->map_zoom))
        return false;
    return !take(c, "@") || (take_number(c, -360, 360, &r->bearing_deg) &&
                             (!take(c, ",") || take_number(c, 0, MOST_PITCH_DEG, &r->pitch_deg)));
}

/* Whether the view has the four numbers of bounds. */
static bool has_bounds(const cursor *c) {
    int commas = 0;
    for (const char *at = c->at; at < c->end && *at != '/' && *at != '@'; at++)
        commas += *at == ',';
    return commas == 3;
}

static bool take_view(cursor *c, camber_route_request *r) {
    if (take(c, "auto")) {
        r->view = CAMBER_ROUTE_AUTO;
        return true;
    }
    r->view = has_bounds(c) ? CAMBER_ROUTE_BOUNDS : CAMBER_ROUTE_CENTER;
    return r->view == CAMBER_ROUTE_BOUNDS ? take_bounds(c, r) : take_center(c, r);
}

/* Returns NULL, or why the path is not a picture's. */
static const char *take_picture(cursor *c, camber_route_request *r) {
    r->is_raw = take(c, "raw/");
    if (!take_view(c, r) || !take(c, "/"))
        return r->is_raw
                   ? "after raw/ the view is X,Y,ZOOM[@BEARING[,PITCH]], WEST,SOUTH,EAST,NORTH or auto, in metres of "
                     "Web Mercator, within 20037508.342789"
               : r->view == CAMBER_ROUTE_BOUNDS
                   ? "the bounds are WEST,SOUTH,EAST,NORTH in degrees, south first, within 180 and 85.051129"
                   : "the view is LON,LAT,ZOOM[@BEARING[,PITCH]], WEST,SOUTH,EAST,NORTH or auto; longitudes are within "
                     "180, latitudes within 85.051129, zooms 0 to 24, bearings within 360 and pitches 0 to 85";
    if (!take_count(c, &r->width) || !take(c, "x") || !take_count(c, &r->height) || r->width < 1 || r->height < 1)
        return "the size after the view is WIDTHxHEIGHT, in whole px from 1 to 99999999";
    if (!take_ending(c, r) || r->type > CAMBER_ROUTE_WEBP)
        return r->type == CAMBER_ROUTE_JPEG ? "pictures are not drawn as JPEG; ask for .png or .webp"
                                            : "the path ends in [@Rx].png or [@Rx].webp, with R a whole number";
    return NULL;
}

/* Any path that begins with /static/ is a picture, or an error that says what is wrong with it. */
static bool take_static(cursor *c, camber_route_request *r) {
    const char *reason = take_picture(c, r);
    r->route = CAMBER_ROUTE_STATIC;
    r->reason = reason;
    return true;
}

static bool is_too_large(const camber_route_request *r, const camber_route_limits *limits) {
    const uint64_t width = (uint64_t)r->width * r->ratio, height = (uint64_t)r->height * r->ratio;
    return r->route == CAMBER_ROUTE_STATIC &&
           (width > limits->most_px || height > limits->most_px || r->ratio > limits->most_ratio);
}

/* Parses letters, digits, dots, minus signs and underscores, not beginning with a dot. The table of files decides
 * whether the name exists. */
static bool take_name(cursor *c, camber_route_request *r) {
    r->route = CAMBER_ROUTE_PAGE;
    r->name = c->at;
    r->name_length = (size_t)(c->end - c->at);
    if (r->name_length < 1 || r->name_length > 64 || *c->at == '.')
        return false;
    for (; c->at < c->end; c->at++)
        if (!((*c->at >= 'a' && *c->at <= 'z') || (*c->at >= 'A' && *c->at <= 'Z') || is_digit(c) ||
              strchr("._-", *c->at)))
            return false;
    return true;
}

static bool take_word(cursor *c, const char *word, camber_route route, camber_route_request *r) {
    if ((size_t)(c->end - c->at) != strlen(word) || !take(c, word))
        return false;
    r->route = route;
    return true;
}

/* The length of a map's name if the path begins with it and a slash, or ends after it; else 0. */
static size_t match_name(const cursor *c, const char *name) {
    cursor rest = *c;
    return take(&rest, name) && (rest.at == rest.end || *rest.at == '/') ? strlen(name) : 0;
}

/* Finds the map whose name the path begins with: the longest one. Returns the length of its name. */
static size_t find_map(const cursor *c, const camber_route_limits *limits, camber_route_request *r) {
    size_t longest = 0;
    r->map = limits->map_count ? CAMBER_ROUTE_NO_MAP : 0;
    for (uint32_t i = 0; i < limits->map_count; i++) {
        const size_t length = match_name(c, limits->maps[i]);
        if (length > longest || (!*limits->maps[i] && !longest)) {
            longest = length;
            r->map = i;
        }
    }
    return longest;
}

/* Paths that concern all maps. */
static bool take_common(cursor *c, camber_route_request *r) {
    return take_word(c, "", CAMBER_ROUTE_INDEX, r) || take_word(c, "health", CAMBER_ROUTE_HEALTH, r) ||
           take_word(c, "metrics", CAMBER_ROUTE_METRICS, r) || (take(c, "page/") && take_name(c, r));
}

static bool take_of_map(cursor *c, const camber_route_limits *limits, camber_route_request *r) {
    if (c->at == c->end) {
        r->route = CAMBER_ROUTE_PAGE;
        r->name = c->at;
        return true;
    }
    if (take(c, "/"))
        return take_of_tileset(c, limits, r);
    if (take(c, "page/"))
        return take_name(c, r);
    if (take(c, SUBTREES))
        return take_subtree(c, r);
    r->dark = take(c, "dark/");
    if (is_digit(c))
        return take_tile(c, limits, r);
    if (take(c, "static/"))
        return take_static(c, r);
    return take_word(c, "tiles.json", CAMBER_ROUTE_TILEJSON, r) ||
           (!r->dark &&
            (take_word(c, "tileset.json", CAMBER_ROUTE_TILESET, r) || take_word(c, "health", CAMBER_ROUTE_HEALTH, r) ||
             take_word(c, "events", CAMBER_ROUTE_EVENTS, r) || take_word(c, "metrics", CAMBER_ROUTE_METRICS, r)));
}

static const char STYLES[] = "styles/", SMALL_TILES[] = "256/";

/* Parses tileserver-gl's paths of the tiles and pictures of a map that has a name: /styles/NAME/... They are further
 * names of the map's own paths. A map that is itself called styles has precedence. */
static bool take_alias(cursor *c, const camber_route_limits *limits, camber_route_request *r) {
    cursor rest = *c;
    if (find_map(c, limits, r) || !take(&rest, STYLES))
        return false;
    const size_t length = find_map(&rest, limits, r);
    rest.at += length;
    if (!length || !take(&rest, "/"))
        return false;
    *c = rest;
    return true;
}

static bool take_of_alias(cursor *c, const camber_route_limits *limits, camber_route_request *r) {
    if (take(c, "static/"))
        return take_static(c, r);
    (void)take(c, SMALL_TILES);
    return take_tile(c, limits, r);
}

static bool take_path(cursor *c, const camber_route_limits *limits, camber_route_request *r) {
    if (!take(c, "/"))
        return false;
    if (take_alias(c, limits, r))
        return take_of_alias(c, limits, r);
    const size_t length = find_map(c, limits, r);
    c->at += length;
    if (length && c->at == c->end) {
        r->route = CAMBER_ROUTE_FOLDER;
        for (r->name = c->at; r->name[-1] != '/'; r->name--)
            ;
        r->name_length = (size_t)(c->at - r->name);
        return true;
    }
    c->at += length ? 1 : 0;
    return r->map == CAMBER_ROUTE_NO_MAP ? take_common(c, r) : take_of_map(c, limits, r);
}

int camber_route_parse(const camber_route_limits *limits, const char *method, const char *path,
                       camber_route_request *request) {
    cursor c = {path, path + strcspn(path, "?")};
    const bool posts = strcmp(method, "POST") == 0;
    *request = (camber_route_request){.name = ""};
    if (!posts && strcmp(method, "GET") != 0 && strcmp(method, "HEAD") != 0)
        return 405;
    const bool known = take_path(&c, limits, request);
    if (posts && !(known && request->route == CAMBER_ROUTE_STATIC)) {
        *request = (camber_route_request){.name = ""};
        return 405;
    }
    if (known)
        return request->reason || is_too_large(request, limits) ? 400 : 200;
    *request = (camber_route_request){.name = ""};
    return 404;
}
