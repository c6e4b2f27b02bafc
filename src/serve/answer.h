/* Internals of the server: what its callbacks share, and the functions that answer requests. */
#ifndef CAMBER_SERVE_ANSWER_H
#define CAMBER_SERVE_ANSWER_H

#include "base/clock.h"
#include "serve/acceptor.h"
#include "serve/address.h"
#include "serve/clients.h"
#include "serve/events.h"
#include "serve/overlay.h"
#include "serve/renderd.h"
#include "serve/server.h"
#include "serve/tile_folder.h"

#include <microhttpd.h>
#include <pthread.h>

enum { CAMBER_DATE_SIZE = 40 };

/* The map or archive that is served now, as requests see it. */
typedef struct camber_content_view {
    bool ready, is_archive, has_dark;
    camber_route_type type;      /* type of an archive's tiles */
    bool gzipped;                /* the archive's tiles are compressed */
    camber_body *tilejson[2][2]; /* [dark][compressed]; [0] is the light theme or the only one. NULL: not available */
    const char *tileset;         /* the folder of a 3D Tiles tileset; NULL: none */
    char last_modified[CAMBER_DATE_SIZE]; /* "": unknown */
} camber_content_view;

/* A map that is served, or an archive. */
typedef struct camber_served_map {
    const char *name; /* "": it has no name */
    bool is_dark;     /* it is the dark theme of another map */
    bool has_dark;    /* another map is its dark theme */
    camber_painter *painter;
    camber_content_view view; /* guarded by the server's mutex */
    pthread_mutex_t reader_mutex;
    camber_tiles_reader *reader; /* of an archive; NULL: none */
    void (*close_reader)(void *owner);
    void *reader_owner;
    char title[256]; /* guarded by the server's mutex */
    camber_request_counts requests;
} camber_served_map;

/* A socket that listens, and which requests it serves. */
typedef struct camber_listener {
    camber_server *server;
    bool is_for_metrics;
    struct MHD_Daemon *daemon;
    camber_acceptor *acceptor;
    unsigned most_connections;
    atomic_uint connections;
    char address[CAMBER_ADDRESS_SIZE];
} camber_listener;

struct camber_server {
    camber_server_desc desc; /* with its defaults filled in */
    char url[256], policy[512];
    camber_listener page, metrics_page;
    camber_tile_cache *cache;
    camber_tile_folder folder; /* the cache's folder, if it has one */
    camber_served_map *maps;   /* desc.map_count of them */
    camber_draw_queue *queue;
    camber_clients *clients;
    camber_overlay_icons *icons; /* NULL: none but those that are built in */
    camber_renderd *renderd;     /* NULL: disabled */
    camber_events *events;       /* NULL: the style is not being edited */
    camber_metrics metrics;
    double start_ms;
    atomic_bool stopping;
    atomic_int posts;          /* requests that have a body */
    _Atomic int64_t in_flight; /* requests that have been received and not yet answered */
    camber_body *errors[5];    /* texts of 400, 404, 405, 500 and 503 */
    camber_body **page_bodies; /* two per file: plain, then compressed or NULL */
    bool page_is_packed;   /* whether they have been compressed: when the page is first asked for. mutex guards it */
    pthread_mutex_t mutex; /* guards the maps' views */
};

/* Callbacks of a daemon; user is its listener. */
void *camber_request_begin(void *user, const char *uri, struct MHD_Connection *connection);
enum MHD_Result camber_request_answer(void *user, struct MHD_Connection *connection, const char *url,
                                      const char *method, const char *version, const char *upload, size_t *upload_size,
                                      void **state);
void camber_request_end(void *user, struct MHD_Connection *connection, void **state,
                        enum MHD_RequestTerminationCode code);
/* Called before a connection is closed. Ends a request whose end libmicrohttpd has not reported. client may be NULL. */
void camber_request_leave(camber_listener *listener, camber_client *client);

#endif
