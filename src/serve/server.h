/* The HTTP server: tiles, pictures, the page, and what operators ask for, on libmicrohttpd.
 *
 *     camber_server_create     listens at once; tiles are answered with 503 until something is shown
 *     camber_server_show       a chart or an archive, and another in its place, without a request that is dropped
 *     camber_server_destroy    takes no more connections, ends what is begun, and stops
 *
 * One thread may call these. */
#ifndef CAMBER_SERVE_SERVER_H
#define CAMBER_SERVE_SERVER_H

#include "serve/painter.h"

#include <time.h>

/* A zeroed desc is valid. Texts are the caller's and must outlive the server. */
typedef struct camber_server_desc {
    const char *listen;     /* ADDRESS:PORT; port 0: the system chooses. NULL: 127.0.0.1:8080 */
    const char *metrics;    /* ADDRESS:PORT of /metrics. NULL: none */
    const char *public_url; /* that tiles.json and the page name, without a slash at its end. NULL: by listen */
    const char *cors;       /* origin that may read answers in other sites' pages. NULL: "*" */
    size_t cache_bytes;     /* 0: 256 MB */
    uint32_t most_px;       /* on a side of a picture. 0: 2048 */
    uint32_t most_ratio;    /* 1 to CAMBER_CHART_MOST_RATIO. 0: 4 */
    uint32_t side;       /* most tiles on a side of a metatile. 0: 1, which is best for random places; 8 with renderd */
    uint32_t threads;    /* that answer, and as many that encode. 0: one a core */
    const char *renderd; /* socket that speaks mod_tile's protocol. NULL: none */
    const char *cache_dir; /* folder of tiles; with renderd, of the metatiles that are drawn for it. NULL: none */
    bool edits;            /* the style is being edited: answers are never taken from a browser's cache unasked */
    bool logs_requests;    /* each request is told to log_request */
    void (*log_request)(void *user, const char *line); /* JSON, without a line's end. Several threads call it */
    camber_log_fn *log;                                /* of failures while drawing and encoding */
    void *user;                                        /* of both */
} camber_server_desc;

/* A chart, or an archive where reader is not NULL, and what to say of it. Texts are copied. */
typedef struct camber_shown {
    camber_chart chart;
    camber_tiles_reader *reader;
    void (*close)(void *owner); /* closes the reader, as camber_chart has it for a chart. NULL: the caller does so */
    void *owner;
    const char *name, *attribution; /* NULL: none */
    const char *metadata;           /* of an archive: a JSON object. NULL: none */
    const char *tileset; /* folder of mesh tiles and their tileset.json; it outlives the server. NULL: none */
    bool is_dark;        /* it is dark by itself: the dark theme and nothing else, or an archive that says so */
    bool has_bounds, has_center;
    double bounds[4], center[3];
    int min_zoom, max_zoom;
    time_t modified; /* of the input. 0: not told */
} camber_shown;

typedef struct camber_server camber_server;

/* Returns an errno, or 0. *failed: the address, socket or folder that it cannot use, which is the desc's; NULL:
 * something else. */
int camber_server_create(const camber_server_desc *desc, camber_server **server, const char **failed);
void camber_server_destroy(camber_server *server);
/* The URL of the page. */
const char *camber_server_get_url(const camber_server *server);
/* The addresses where it listens, with their ports; that of /metrics is NULL where there is none. */
const char *camber_server_get_address(const camber_server *server);
const char *camber_server_get_metrics_address(const camber_server *server);
/* false: no memory; what was shown stays, and the caller closes what it has. */
bool camber_server_show(camber_server *server, const camber_shown *shown);
/* Where the style is edited: tells those who listen that it was read anew, or why it could not be (error not NULL). */
void camber_server_tell(camber_server *server, const char *error);
/* Looks whether those who listen are still there; to be called every few seconds. */
void camber_server_beat(camber_server *server);

#endif
