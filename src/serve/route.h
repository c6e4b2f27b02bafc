/* Routes: what a request's method and path ask for.
 *
 *     /                                       the page
 *     /page/NAME                              a file of the page
 *     /tiles.json                             TileJSON
 *     /{z}/{x}/{y}[@Rx].{type}                a tile
 *     /tileset.json                           3D Tiles: of a folder of mesh tiles
 *     /subtrees/{z}.{x}.{y}.subtree           which of its tiles there are below one
 *     /static/{lon},{lat},{zoom}[@bearing[,pitch]]/{w}x{h}[@Rx].{type}
 *                                             a picture of any place
 *     /health   /events   /metrics
 *
 * /dark before a tile, a picture and tiles.json asks for the built-in style's dark theme. There are no other paths, and
 * files are found by numbers alone. */
#ifndef CAMBER_SERVE_ROUTE_H
#define CAMBER_SERVE_ROUTE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum camber_route {
    CAMBER_ROUTE_NONE = 0,
    CAMBER_ROUTE_PAGE,
    CAMBER_ROUTE_TILEJSON,
    CAMBER_ROUTE_TILE,
    CAMBER_ROUTE_TILESET,
    CAMBER_ROUTE_SUBTREE,
    CAMBER_ROUTE_STATIC,
    CAMBER_ROUTE_HEALTH,
    CAMBER_ROUTE_EVENTS,
    CAMBER_ROUTE_METRICS,
    CAMBER_ROUTES,
} camber_route;

enum { CAMBER_ROUTE_MOST_ZOOM = 24 };

/* Kinds of tiles by the endings of paths. The first two can be drawn, an archive may have any. */
typedef enum camber_route_type {
    CAMBER_ROUTE_PNG = 0,
    CAMBER_ROUTE_WEBP,
    CAMBER_ROUTE_JPEG,
    CAMBER_ROUTE_AVIF,
    CAMBER_ROUTE_MVT,
    CAMBER_ROUTE_MLT,
    CAMBER_ROUTE_GLB,
    CAMBER_ROUTE_TYPES,
} camber_route_type;

typedef struct camber_route_limits {
    uint32_t most_ratio;
    uint32_t most_px; /* on a side of a picture, in device px */
} camber_route_limits;

typedef struct camber_route_request {
    camber_route route;
    bool dark;
    camber_route_type type;
    uint32_t ratio;
    int zoom; /* of a tile, or of a subtree's root */
    uint32_t column, row;
    double longitude, latitude, map_zoom, bearing_deg, pitch_deg; /* of a picture */
    uint32_t width, height;                                       /* CSS px */
    const char *name; /* a file of the page, within the path; "" is the page itself */
    size_t name_length;
} camber_route_request;

/* The name of a route in metrics and logs. */
const char *camber_route_get_name(camber_route route);
/* The media type of a kind of tiles. */
const char *camber_route_get_media_type(camber_route_type type);
/* The ending of paths of a kind of tiles, without a dot. */
const char *camber_route_get_ending(camber_route_type type);
/* Finds the kind by the name that archives give it. false: it has no path. */
bool camber_route_find_type(const char *name, camber_route_type *type);

/* Parses a path as it came, before anything in it is unescaped; what follows a '?' is ignored. The same bytes give the
 * same answer, and nothing is allocated. Returns 200, 400 (a picture that is larger than the limits), 404
 * (request->route is NONE) or 405. */
int camber_route_parse(const camber_route_limits *limits, const char *method, const char *path,
                       camber_route_request *request);

#endif
