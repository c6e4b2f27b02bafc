/* A thread that accepts the connections of a socket. */
#ifndef CAMBER_SERVE_ACCEPTOR_H
#define CAMBER_SERVE_ACCEPTOR_H

#include <stdbool.h>

/* The acceptor's thread calls both functions. */
typedef struct camber_acceptor_desc {
    int socket; /* a blocking socket that listens; the acceptor closes it */
    /* while it returns false, connections wait in the system's queue. NULL: always true */
    bool (*has_room)(void *user);
    void (*take)(void *user, int connection); /* takes ownership of the connection */
    void *user;
} camber_acceptor_desc;

typedef struct camber_acceptor camber_acceptor;

/* Returns 0 or an errno; the socket is closed even if it fails. */
int camber_acceptor_create(const camber_acceptor_desc *desc, camber_acceptor **acceptor);
/* Stops listening. No connection is accepted after it has returned. */
void camber_acceptor_destroy(camber_acceptor *acceptor);

#endif
