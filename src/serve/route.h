/* Routes: what a request's method and path refer to.
 *
 *     /                                       the page
 *     /page/NAME                              a file of the page
 *     /tiles.json                             TileJSON
 *     /{z}/{x}/{y}[@Rx].{type}                a tile
 *     /tileset.json                           3D Tiles: the tileset of a folder of mesh tiles
 *     /subtrees/{z}.{x}.{y}.subtree           which tiles exist below one of its tiles
 *     /static/{lon},{lat},{zoom}[@bearing[,pitch]]/{w}x{h}[@Rx].{type}
 *     /static/{west},{south},{east},{north}/{w}x{h}[@Rx].{type}
 *     /static/auto/{w}x{h}[@Rx].{type}        a picture of any view; overlay.h has its query
 *     /health   /events   /metrics
 *
 * /dark before the path of a tile, a picture or tiles.json selects the built-in style's dark theme. If maps have names,
 * these paths, except /metrics, begin with /NAME, and / is a page that lists the maps; tiles and pictures also have
 * tileserver-gl's paths, /styles/NAME/[256/]{z}/{x}/{y}... and /styles/NAME/static/... There are no other paths: URLs
 * are never mapped to file paths. */
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
    CAMBER_ROUTE_INDEX,  /* the list of the maps, if they have names */
    CAMBER_ROUTE_FOLDER, /* a map's name without the slash after it */
    CAMBER_ROUTES,
} camber_route;

enum { CAMBER_ROUTE_MOST_ZOOM = 24 };
#define CAMBER_ROUTE_MOST_METRES 20037508.342789 /* half of Web Mercator's world */
#define CAMBER_ROUTE_NO_MAP UINT32_MAX

/* How a path says which part of the map its picture shows. */
typedef enum camber_route_view {
    CAMBER_ROUTE_CENTER = 0, /* longitude, latitude and map_zoom */
    CAMBER_ROUTE_BOUNDS,     /* bounds */
    CAMBER_ROUTE_AUTO,       /* what its overlay draws */
} camber_route_view;

/* Types of tiles, by the extension in the path. The first two can be drawn; an archive may contain any of them. */
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
    uint32_t most_px; /* limit of a picture's width and height, in device px */
    /* The maps' names, map_count of them; one of them may be "", which has the paths that begin with no other name.
     * NULL: one map without a name. */
    const char *const *maps;
    uint32_t map_count;
} camber_route_limits;

typedef struct camber_overlay camber_overlay;

typedef struct camber_route_request {
    camber_route route;
    uint32_t map; /* its index, or CAMBER_ROUTE_NO_MAP: all of them */
    bool dark;
    camber_route_type type;
    uint32_t ratio;
    int zoom; /* of a tile, or of a subtree's root */
    uint32_t column, row;
    double longitude, latitude, map_zoom, bearing_deg, pitch_deg; /* of a picture */
    uint32_t width, height;                                       /* CSS px */
    camber_route_view view;
    double bounds[4];              /* west, south, east, north in degrees */
    bool is_raw;                   /* the path and the query have metres of Web Mercator; here they are degrees */
    const camber_overlay *overlay; /* drawn over a picture; not the parser's. NULL: none */
    const char *name;              /* a file of the page, as a part of the path; "" is the page itself */
    size_t name_length;
    const char *reason; /* why the status is 400, a constant text. NULL: the picture exceeds the limits */
} camber_route_request;

/* Returns the name of a route, for metrics and logs. */
const char *camber_route_get_name(camber_route route);
/* Returns the media type of a type of tiles. */
const char *camber_route_get_media_type(camber_route_type type);
/* Returns the extension of a type of tiles, without a dot. */
const char *camber_route_get_ending(camber_route_type type);
/* Returns the longitude (axis 0) or the latitude (axis 1) of metres of Web Mercator. */
double camber_route_find_degrees(int axis, double metres);
/* Finds the type that has this name in archives. Returns false if no path exists for it. */
bool camber_route_find_type(const char *name, camber_route_type *type);

/* Parses a path exactly as it was received, before anything is unescaped. A '?' and what follows it are ignored. The
 * result depends only on the arguments, and nothing is allocated. Returns 200, 400 (a picture that exceeds the limits,
 * or a path below /static/ that is not a picture's), 404 (request->route is NONE) or 405. */
int camber_route_parse(const camber_route_limits *limits, const char *method, const char *path,
                       camber_route_request *request);

#endif
