/* A socket that speaks mod_tile's protocol, so that mod_tile and render_list can use camber in place of renderd. The
 * requested tiles are drawn and written as a metatile into a folder, from which mod_tile serves them. */
#ifndef CAMBER_SERVE_RENDERD_H
#define CAMBER_SERVE_RENDERD_H

#include "serve/draw_queue.h"

enum { CAMBER_RENDERD_MOST_CLIENTS = 64 };

typedef struct camber_renderd_desc {
    const char *socket, *folder; /* paths; the folder must exist */
    unsigned most_clients;       /* limit of connections. Beyond it, the client that has been silent for longest is
                                    disconnected. 0: the maximum */
    camber_draw_queue *queue;
    /* Whether the input has been read. Until then, requests are answered with "not done". */
    bool (*is_ready)(void *user);
    void (*failed)(void *user, const char *message); /* receives one line; several threads call it */
    void *user;                                      /* passed to both functions */
} camber_renderd_desc;

typedef struct camber_renderd camber_renderd;

/* Starts listening. If a process has ended without removing its socket, the socket is replaced. Returns 0 or an
 * errno. */
int camber_renderd_create(const camber_renderd_desc *desc, camber_renderd **renderd);
/* Finishes the requests in progress, and removes the socket. The queue must still be running. */
void camber_renderd_destroy(camber_renderd *renderd);

#endif
