/* The open connections, with a time limit for each phase: a client that is idle, or that sends its request or receives
 * its answer byte by byte, is disconnected. */
#ifndef CAMBER_SERVE_CLIENTS_H
#define CAMBER_SERVE_CLIENTS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

typedef enum camber_client_phase {
    CAMBER_CLIENT_SENDS = 0, /* no complete request has been received; it may be idle */
    CAMBER_CLIENT_TAKES,     /* its request is being answered */
    CAMBER_CLIENT_LISTENS,   /* it receives events, without a time limit */
} camber_client_phase;

enum { CAMBER_PATH_BYTES = 200 };

typedef struct camber_client {
    int socket;
    /* path of the incoming request, as it was received. "": it is longer than any route */
    char path[CAMBER_PATH_BYTES];
    uintptr_t path_end; /* address of the end of the received path */
    double start_ms;    /* when its first line was received */
    void *request;      /* the request that is being answered; NULL: none */
    atomic_int phase;
    _Atomic double since_ms;
    struct camber_client *next, *before;
} camber_client;

typedef struct camber_clients camber_clients;

/* seconds: the time limit for each phase. Returns NULL if there is no memory, or if no thread can be created. */
camber_clients *camber_clients_create(double seconds);
void camber_clients_destroy(camber_clients *clients);
/* Adds a connection that was opened. Returns NULL if there is no memory. */
camber_client *camber_clients_add(camber_clients *clients, int socket);
/* Removes a connection that is about to be closed. client may be NULL. */
void camber_clients_remove(camber_clients *clients, camber_client *client);
void camber_client_enter(camber_client *client, camber_client_phase phase);
int64_t camber_clients_count(const camber_clients *clients);

#endif
