/* The queue of what is to be drawn: those who ask for tiles of one metatile wait for one picture.
 *
 *     ask -> [queued] -> drawn by one thread -> picture -> tiles encoded by others -> cache, and all who asked
 *
 * A bounded number of pictures may wait. One that nobody waits for any more is not drawn. The last pictures are kept,
 * so that a neighbour's tile is cut and encoded only. */
#ifndef CAMBER_SERVE_DRAW_QUEUE_H
#define CAMBER_SERVE_DRAW_QUEUE_H

#include "serve/metrics.h"

#include "camber_files.h"

typedef enum camber_ask_result {
    CAMBER_ASK_DONE = 0, /* body is the asker's to release */
    CAMBER_ASK_FAILED,   /* it could not be drawn; the log says why */
    CAMBER_ASK_DROPPED,  /* the asker was gone, or the drawing has been stopped */
} camber_ask_result;

/* A tile or picture that is asked for, and what became of it. It stays where it is until done is called. */
typedef struct camber_ask {
    camber_route_request request; /* a tile or a static picture, as PNG or WebP */
    /* Is called once, from a thread of the drawing, which holds no lock meanwhile. */
    void (*done)(struct camber_ask *ask);
    /* Whether nobody waits for it any more. It must not call the drawing. NULL: somebody does. */
    bool (*is_gone)(const struct camber_ask *ask);
    void *user;
    camber_ask_result result;
    camber_body *body;
    struct camber_ask *next; /* the drawing's */
} camber_ask;

/* A picture: side * side tiles of tile_px, or, for a static one, one of width x height. */
typedef struct camber_drawn {
    uint8_t *rgba;
    size_t capacity_bytes;
    uint32_t width, height; /* px */
    uint32_t side, tile_px;
    bool opaque; /* alpha is dropped */
} camber_drawn;

/* Makes room for a picture whose width and height are set. false: no memory. */
bool camber_drawn_resize(camber_drawn *drawn);

typedef struct camber_draw_queue_desc {
    camber_tile_cache *cache;
    camber_metrics *metrics;
    /* Draws the metatile of a tile, or a static picture. One thread calls both functions. */
    camber_status (*draw)(void *user, const camber_route_request *request, camber_drawn *drawn);
    /* Does a part of what later requests will need, while none waits. false: there is no more. */
    bool (*prepare)(void *user);
    void *user;
    uint32_t side;          /* most tiles on a side of a metatile: a power of two, 8 at most */
    uint32_t threads;       /* that encode */
    uint32_t most_queued;   /* pictures that may wait */
    uint32_t most_pictures; /* that are kept */
    camber_log_fn *log;     /* of the threads that encode */
    void *log_user;
} camber_draw_queue_desc;

typedef struct camber_draw_queue camber_draw_queue;

/* The tiles on a side of the metatile that has a tile. */
uint32_t camber_draw_queue_side(uint32_t most, int zoom, uint32_t ratio);
camber_tile_key camber_draw_queue_key(const camber_route_request *request);

/* NULL: no memory or no thread. */
camber_draw_queue *camber_draw_queue_create(const camber_draw_queue_desc *desc);
/* Ends the threads; those who still wait are told CAMBER_ASK_DROPPED, and nothing is taken any more. */
void camber_draw_queue_stop(camber_draw_queue *drawing);
/* Stops it, unless that is done. */
void camber_draw_queue_destroy(camber_draw_queue *drawing);
/* false: the queue is full, and done is not called. */
bool camber_draw_queue_ask(camber_draw_queue *drawing, camber_ask *ask);
/* There is something to prepare. */
void camber_draw_queue_wake(camber_draw_queue *drawing);

#endif
