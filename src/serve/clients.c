/* A list of the open connections, and a thread that checks it periodically. It shuts down a connection that has taken
 * too long; the server then sees the end of the connection and closes it. */
#define _XOPEN_SOURCE 700

#include "serve/clients.h"

#include "base/clock.h"

#include <pthread.h>
#include <stdlib.h>
#include <sys/socket.h>

enum { LOOK_MS = 500 };

struct camber_clients {
    pthread_mutex_t mutex;
    pthread_cond_t stop;
    pthread_t thread;
    bool stops;
    double most_ms;
    camber_client *first;
    _Atomic int64_t count;
};

static void shut_late(camber_clients *clients) {
    const double now = camber_now_ms();
    for (camber_client *client = clients->first; client; client = client->next)
        if (client->phase != CAMBER_CLIENT_LISTENS && now - client->since_ms > clients->most_ms)
            (void)shutdown(client->socket, SHUT_RDWR);
}

static void *look(void *user) {
    camber_clients *clients = user;
    pthread_mutex_lock(&clients->mutex);
    while (!clients->stops) {
        const struct timespec end = camber_time_in(LOOK_MS);
        (void)pthread_cond_timedwait(&clients->stop, &clients->mutex, &end);
        shut_late(clients);
    }
    pthread_mutex_unlock(&clients->mutex);
    return NULL;
}

camber_clients *camber_clients_create(double seconds) {
    camber_clients *made = calloc(1, sizeof *made);
    if (!made)
        return NULL;
    made->most_ms = seconds * 1e3;
    pthread_mutex_init(&made->mutex, NULL);
    pthread_cond_init(&made->stop, NULL);
    if (pthread_create(&made->thread, NULL, look, made) == 0)
        return made;
    pthread_cond_destroy(&made->stop);
    pthread_mutex_destroy(&made->mutex);
    free(made);
    return NULL;
}

void camber_clients_destroy(camber_clients *clients) {
    if (!clients)
        return;
    pthread_mutex_lock(&clients->mutex);
    clients->stops = true;
    pthread_cond_signal(&clients->stop);
    pthread_mutex_unlock(&clients->mutex);
    pthread_join(clients->thread, NULL);
    while (clients->first)
        camber_clients_remove(clients, clients->first);
    pthread_cond_destroy(&clients->stop);
    pthread_mutex_destroy(&clients->mutex);
    free(clients);
}

camber_client *camber_clients_add(camber_clients *clients, int socket) {
    camber_client *client = calloc(1, sizeof *client);
    if (!client)
        return NULL;
    client->socket = socket;
    camber_client_enter(client, CAMBER_CLIENT_SENDS);
    pthread_mutex_lock(&clients->mutex);
    client->next = clients->first;
    if (client->next)
        client->next->before = client;
    clients->first = client;
    clients->count++;
    pthread_mutex_unlock(&clients->mutex);
    return client;
}

void camber_clients_remove(camber_clients *clients, camber_client *client) {
    if (!client)
        return;
    pthread_mutex_lock(&clients->mutex);
    *(client->before ? &client->before->next : &clients->first) = client->next;
    if (client->next)
        client->next->before = client->before;
    clients->count--;
    pthread_mutex_unlock(&clients->mutex);
    free(client);
}

void camber_client_enter(camber_client *client, camber_client_phase phase) {
    client->since_ms = camber_now_ms();
    client->phase = (int)phase;
}

int64_t camber_clients_count(const camber_clients *clients) {
    return clients->count;
}
