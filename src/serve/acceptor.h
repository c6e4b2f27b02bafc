/* A thread that accepts the connections of a socket. */
#ifndef CAMBER_SERVE_ACCEPTOR_H
#define CAMBER_SERVE_ACCEPTOR_H

#include <stdbool.h>

/* Both are called by the acceptor's thread. */
typedef struct camber_acceptor_desc {
    int socket;                               /* it listens, and blocks; the acceptor closes it */
    bool (*has_room)(void *user);             /* without it connections wait in the system's queue. NULL: always */
    void (*take)(void *user, int connection); /* which is the callee's from then on */
    void *user;
} camber_acceptor_desc;

typedef struct camber_acceptor camber_acceptor;

/* Returns 0 or an errno; then the socket is closed, too. */
int camber_acceptor_create(const camber_acceptor_desc *desc, camber_acceptor **acceptor);
/* Stops listening; when it returns, no connection is taken any more. */
void camber_acceptor_destroy(camber_acceptor *acceptor);

#endif
