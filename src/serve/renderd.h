/* A socket that speaks mod_tile's protocol, so that mod_tile and render_list find camber where they look for renderd.
 * What they ask for is drawn and written as a metatile into a folder, from which mod_tile serves it. */
#ifndef CAMBER_SERVE_RENDERD_H
#define CAMBER_SERVE_RENDERD_H

#include "serve/draw_queue.h"

enum { CAMBER_RENDERD_MOST_CLIENTS = 64 };

typedef struct camber_renderd_desc {
    const char *socket, *folder; /* paths; the folder is there */
    unsigned most_clients;       /* at once. Beyond that the one that has been silent for longest goes. 0: the most */
    camber_draw_queue *queue;
    /* Whether the input has been read; until then requests are told that they are not done. */
    bool (*is_ready)(void *user);
    void (*failed)(void *user, const char *message); /* one line. Several threads call it */
    void *user;                                      /* of both */
} camber_renderd_desc;

typedef struct camber_renderd camber_renderd;

/* Listens. A socket that a process which has ended left behind is replaced. Returns 0 or an errno. */
int camber_renderd_create(const camber_renderd_desc *desc, camber_renderd **renderd);
/* Ends what is begun, and removes the socket. The queue is running still. */
void camber_renderd_destroy(camber_renderd *renderd);

#endif
