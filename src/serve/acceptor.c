/* A thread that accepts the connections of a socket, and ends when the socket is shut down. */
#define _GNU_SOURCE /* accept4 */

#include "serve/acceptor.h"

#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { LOOK_MS = 20 }; /* how often it checks whether there is room again */

struct camber_acceptor {
    camber_acceptor_desc desc;
    pthread_t thread;
    atomic_bool stopping;
};

static bool lacks_descriptors(int cause) {
    return cause == EMFILE || cause == ENFILE || cause == ENOBUFS || cause == ENOMEM;
}

static void *accept_all(void *user) {
    camber_acceptor *acceptor = user;
    const camber_acceptor_desc *desc = &acceptor->desc;
    const struct timespec pause = {.tv_nsec = LOOK_MS * 1000000L};
    while (!acceptor->stopping) {
        if (desc->has_room && !desc->has_room(desc->user)) {
            nanosleep(&pause, NULL);
            continue;
        }
        const int connection = accept4(desc->socket, NULL, NULL, SOCK_CLOEXEC), cause = errno;
        if (connection >= 0 && acceptor->stopping)
            close(connection);
        else if (connection >= 0)
            desc->take(desc->user, connection);
        else if (lacks_descriptors(cause))
            nanosleep(&pause, NULL); /* until a connection is closed */
        else if (cause != EINTR && cause != ECONNABORTED)
            break;
    }
    return NULL;
}

int camber_acceptor_create(const camber_acceptor_desc *desc, camber_acceptor **acceptor) {
    camber_acceptor *made = calloc(1, sizeof *made);
    int cause = made ? 0 : ENOMEM;
    if (made) {
        made->desc = *desc;
        cause = pthread_create(&made->thread, NULL, accept_all, made);
    }
    if (cause) {
        close(desc->socket);
        free(made);
        return cause;
    }
    *acceptor = made;
    return 0;
}

void camber_acceptor_destroy(camber_acceptor *acceptor) {
    if (!acceptor)
        return;
    acceptor->stopping = true;
    (void)shutdown(acceptor->desc.socket, SHUT_RDWR); /* wakes accept */
    pthread_join(acceptor->thread, NULL);
    close(acceptor->desc.socket);
    free(acceptor);
}
