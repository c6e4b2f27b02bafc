/* The HTTP server, based on libmicrohttpd: tiles, pictures, the page, health and metrics.
 *
 *     camber_server_create     listens at once; requests for tiles get a 503 until there is content
 *     camber_server_show       sets one of the maps, or an archive, or replaces it, without dropping requests
 *     camber_server_destroy    accepts no more connections, finishes the requests in progress, and stops
 *
 * Only one thread may call these functions. */
#ifndef CAMBER_SERVE_SERVER_H
#define CAMBER_SERVE_SERVER_H

#include "serve/painter.h"

#include <time.h>

/* A zeroed desc is valid. Strings belong to the caller and must outlive the server. */
typedef struct camber_server_desc {
    const char *listen;  /* ADDRESS:PORT; port 0: the system chooses one. NULL: 127.0.0.1:8080 */
    const char *metrics; /* ADDRESS:PORT of /metrics. NULL: none */
    /* base URL in tiles.json and in the page, without a trailing slash. NULL: derived from listen */
    const char *public_url;
    const char *cors;    /* origin whose pages may read answers. NULL: "*" */
    size_t cache_bytes;  /* 0: 256 MB */
    uint32_t most_px;    /* limit of a picture's width and height. 0: 2048 */
    uint32_t most_ratio; /* 1 to CAMBER_MAP_SOURCE_MOST_RATIO. 0: 4 */
    /* largest number of tiles on a side of a metatile. 0: 1, which suits random access; 8 with renderd */
    uint32_t side;
    uint32_t threads;      /* number of threads that answer, and of threads that encode. 0: one per core */
    const char *renderd;   /* path of a socket for mod_tile's protocol. NULL: none */
    const char *cache_dir; /* folder for tiles; with renderd, for the metatiles drawn for it. NULL: none */
    /* Names of the maps: map_count of them, unique, each the beginning of its map's paths (route.h). A map whose name
     * is another one's and then /dark is its dark theme, and so is "dark" beside "". NULL: one map without a name. */
    const char *const *maps;
    uint32_t map_count;
    const char *const *fonts; /* font_count folders with fonts for texts over pictures */
    size_t font_count;
    const char *icons;  /* path of a sprite with icons for markers, without its ending. NULL: none */
    bool edits;         /* the style is being edited, so browsers must revalidate every answer */
    bool logs_requests; /* log_request is called for each request */
    void (*log_request)(void *user, const char *line); /* line: JSON without a line break. Several threads call it */
    camber_log_fn *log;                                /* receives failures of drawing and encoding */
    void *user;                                        /* passed to both functions */
} camber_server_desc;

/* A map, or an archive if reader is not NULL, and its metadata. Strings are copied. */
typedef struct camber_server_content {
    camber_map_source source;
    camber_tiles_reader *reader;
    void (*close)(void *owner); /* closes the reader, as in camber_map_source. NULL: the caller does it */
    void *owner;
    const char *name, *attribution; /* NULL: none */
    const char *metadata;           /* of an archive: a JSON object. NULL: none */
    const char *tileset; /* folder with mesh tiles and their tileset.json; it must outlive the server. NULL: none */
    bool is_dark;        /* it has only the dark theme, or is an archive that is marked as dark */
    bool has_bounds, has_center;
    double bounds[4], center[3];
    int min_zoom, max_zoom;
    time_t modified; /* when the input was modified; 0: unknown */
} camber_server_content;

typedef struct camber_server camber_server;

/* Returns 0 or an errno. On failure, *failed is the address, socket or folder of the desc that cannot be used; NULL:
 * the cause is something else. */
int camber_server_create(const camber_server_desc *desc, camber_server **server, const char **failed);
void camber_server_destroy(camber_server *server);
/* Returns the URL of the page. */
const char *camber_server_get_url(const camber_server *server);
/* Return the addresses at which the server listens, with their ports. The address of /metrics is NULL if metrics are
 * not served. */
const char *camber_server_get_address(const camber_server *server);
const char *camber_server_get_metrics_address(const camber_server *server);
/* map: its index. Returns false if there is no memory; then the previous content stays, and the caller closes the new
 * one. */
bool camber_server_show(camber_server *server, uint32_t map, const camber_server_content *content);
/* While a style is edited: tells all listeners that it has been reloaded, or why that failed (error is not NULL). */
void camber_server_tell(camber_server *server, const char *error);
/* Detects listeners that have disconnected. Call it every few seconds. */
void camber_server_beat(camber_server *server);

#endif
