/* The server's inside: what its callbacks share, and the answers to requests. */
#ifndef CAMBER_SERVE_ANSWER_H
#define CAMBER_SERVE_ANSWER_H

#include "base/clock.h"
#include "serve/acceptor.h"
#include "serve/address.h"
#include "serve/clients.h"
#include "serve/events.h"
#include "serve/renderd.h"
#include "serve/server.h"
#include "serve/tile_folder.h"

#include <microhttpd.h>
#include <pthread.h>

enum { CAMBER_DATE_SIZE = 40 };

/* The chart or archive that is shown now, as requests see it. */
typedef struct camber_view_of_shown {
    bool ready, is_archive, has_dark;
    camber_route_type type;      /* of an archive's tiles */
    bool gzipped;                /* an archive's tiles are compressed */
    camber_body *tilejson[2][2]; /* light or the only one, and dark; plain and compressed. NULL: there is none */
    const char *tileset;         /* the folder with a tileset. NULL: there is none */
    char last_modified[CAMBER_DATE_SIZE]; /* "": not told */
} camber_view_of_shown;

/* A socket that listens, and what it serves. */
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
    camber_server_desc desc; /* defaults filled in */
    char url[256], policy[512];
    camber_listener page, metrics_page;
    camber_tile_cache *cache;
    camber_tile_folder folder; /* of the cache, where it has one */
    camber_painter *painter;
    camber_draw_queue *drawing;
    camber_clients *clients;
    camber_renderd *renderd; /* NULL: none */
    camber_events *events;   /* NULL: the style is not edited */
    camber_metrics metrics;
    double start_ms;
    atomic_bool stopping;
    _Atomic int64_t in_flight; /* requests that are here, and not answered yet */
    camber_body *errors[5];    /* texts of 400, 404, 405, 500 and 503 */
    camber_body **page_bodies; /* two a file: plain, compressed or NULL */
    pthread_mutex_t mutex;     /* of view */
    camber_view_of_shown view;
    pthread_mutex_t reader_mutex;
    camber_tiles_reader *reader; /* of an archive. NULL: none */
    void (*close_reader)(void *owner);
    void *reader_owner;
};

/* Callbacks of a daemon; user is its listener. */
void *camber_request_begin(void *user, const char *uri, struct MHD_Connection *connection);
enum MHD_Result camber_request_answer(void *user, struct MHD_Connection *connection, const char *url,
                                      const char *method, const char *version, const char *upload, size_t *upload_size,
                                      void **state);
void camber_request_end(void *user, struct MHD_Connection *connection, void **state,
                        enum MHD_RequestTerminationCode code);
/* The connection is about to be closed: ends what libmicrohttpd has not told the end of. client may be NULL. */
void camber_request_leave(camber_listener *listener, camber_client *client);

#endif
