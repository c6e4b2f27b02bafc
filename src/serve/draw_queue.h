/* The queue of pictures to draw. All requests for tiles of one metatile wait for the same picture.
 *
 *     request -> [queued] -> drawn by one thread -> picture -> tiles encoded by others -> cache, and all requests
 *
 * The number of queued pictures is limited. A picture is dropped if nobody waits for it any more. The most recent
 * pictures are kept, so that a neighbouring tile only has to be cut and encoded. */
#ifndef CAMBER_SERVE_DRAW_QUEUE_H
#define CAMBER_SERVE_DRAW_QUEUE_H

#include "serve/metrics.h"

#include "camber_files.h"

typedef enum camber_tile_request_result {
    CAMBER_TILE_REQUEST_DONE = 0, /* body belongs to the caller, who must release it */
    CAMBER_TILE_REQUEST_FAILED,   /* it could not be drawn; the log has the reason */
    CAMBER_TILE_REQUEST_DROPPED,  /* the client has disconnected, or the queue has been stopped */
} camber_tile_request_result;

/* A request for a tile or picture, with its result. It must stay at the same address until done is called. */
typedef struct camber_tile_request {
    camber_route_request request; /* a tile or a static picture, as PNG or WebP */
    /* Called once, from one of the queue's threads, which holds no lock during the call. */
    void (*done)(struct camber_tile_request *tile_request);
    /* Whether nobody waits for the result any more. It must not call the queue. NULL: somebody always waits. */
    bool (*is_gone)(const struct camber_tile_request *tile_request);
    void *user;
    camber_tile_request_result result;
    camber_body *body;
    struct camber_tile_request *next; /* used by the queue */
} camber_tile_request;

/* A picture of side * side tiles of tile_px; a static picture has width x height px. */
typedef struct camber_rendered_picture {
    uint8_t *rgba;
    size_t capacity_bytes;
    uint32_t width, height; /* px */
    uint32_t side, tile_px;
    bool opaque; /* the alpha channel is not needed */
} camber_rendered_picture;

/* Allocates memory for a picture after its width and height have been set. Returns false if memory is exhausted. */
bool camber_rendered_picture_resize(camber_rendered_picture *rendered);

typedef struct camber_draw_queue_desc {
    camber_tile_cache *cache;
    camber_metrics *metrics;
    /* Draws the metatile of a tile, or a static picture. Both functions are called from one thread. */
    camber_status (*draw)(void *user, const camber_route_request *request, camber_rendered_picture *rendered);
    /* Prepares something that later requests will need; called while no request waits. Returns false if nothing is left
     * to prepare. */
    bool (*prepare)(void *user);
    void *user;
    uint32_t side;          /* largest number of tiles on a side of a metatile: a power of two, 8 at most */
    uint32_t threads;       /* number of threads that encode */
    uint32_t most_queued;   /* limit of queued pictures */
    uint32_t most_pictures; /* limit of pictures that are kept in memory */
    camber_log_fn *log;     /* for messages of the threads that encode */
    void *log_user;
} camber_draw_queue_desc;

typedef struct camber_draw_queue camber_draw_queue;

/* Returns how many tiles the metatile of a tile has on a side. */
uint32_t camber_draw_queue_side(uint32_t most, int zoom, uint32_t ratio);
camber_tile_key camber_draw_queue_key(const camber_route_request *request);

/* Returns NULL if there is no memory, or if no thread can be created. */
camber_draw_queue *camber_draw_queue_create(const camber_draw_queue_desc *desc);
/* Stops the threads. Requests that still wait end with CAMBER_TILE_REQUEST_DROPPED, and no more are accepted. */
void camber_draw_queue_stop(camber_draw_queue *queue);
/* Stops the queue first, unless that has been done. */
void camber_draw_queue_destroy(camber_draw_queue *queue);
/* Adds a request. Returns false if the queue is full; then done is not called. */
bool camber_draw_queue_add(camber_draw_queue *queue, camber_tile_request *tile_request);
/* Tells the queue that there is something to prepare. */
void camber_draw_queue_wake(camber_draw_queue *queue);

#endif
