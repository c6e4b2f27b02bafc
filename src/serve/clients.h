/* Connections that are open, and how long each may take: one that is idle, or that sends its request or takes its
 * answer byte by byte, is closed after a time. */
#ifndef CAMBER_SERVE_CLIENTS_H
#define CAMBER_SERVE_CLIENTS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

typedef enum camber_client_phase {
    CAMBER_CLIENT_SENDS = 0, /* or is idle: no whole request is here */
    CAMBER_CLIENT_TAKES,     /* it is answered */
    CAMBER_CLIENT_LISTENS,   /* it takes events, without an end */
} camber_client_phase;

enum { CAMBER_PATH_BYTES = 200 };

typedef struct camber_client {
    int socket;
    char path[CAMBER_PATH_BYTES]; /* of the request that comes, as it came. "": it is longer than any route */
    uintptr_t path_end;           /* where the path as it came has its end */
    double start_ms;              /* when its first line was here */
    void *request;                /* that is being answered. NULL: none */
    atomic_int phase;
    _Atomic double since_ms;
    struct camber_client *next, *before;
} camber_client;

typedef struct camber_clients camber_clients;

/* seconds: that each phase may take. NULL: no memory, or no thread. */
camber_clients *camber_clients_create(double seconds);
void camber_clients_destroy(camber_clients *clients);
/* A connection has been opened. NULL: no memory. */
camber_client *camber_clients_add(camber_clients *clients, int socket);
/* It is about to be closed. client may be NULL. */
void camber_clients_remove(camber_clients *clients, camber_client *client);
void camber_client_enter(camber_client *client, camber_client_phase phase);
int64_t camber_clients_count(const camber_clients *clients);

#endif
