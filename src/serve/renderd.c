/* mod_tile's protocol over a Unix socket.
 *
 * A request is a struct in this machine's byte order: version, command, x, y, z; since version 2 also the map's name,
 * and since version 3 a media type and options. The answer is the same struct, with "done" or "not done" as its
 * command. Each connection has a thread, which requests the tiles of the metatile from the queue, waits for them, and
 * writes the file. */
#define _XOPEN_SOURCE 700

#include "serve/renderd.h"

#include "base/clock.h"
#include "serve/acceptor.h"
#include "serve/metatile_file.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

enum {
    MOST_CLIENTS = CAMBER_RENDERD_MOST_CLIENTS,
    NAME_SIZE = 41,
    MOST_ZOOM = 20,
    SIDE = CAMBER_METATILE_FILE_SIDE,
    LONGEST_SEND_MS = 30000, /* for receiving an answer; less when the server stops */
    LONGEST_LAST_SEND_MS = 1000,
    LEAST_WAIT_MS = 1000, /* a client that has sent nothing for this long can be replaced by another */
    LOOK_MS = 100,
};

typedef enum protocol_command {
    COMMAND_IGNORE = 0,
    COMMAND_RENDER,
    COMMAND_DIRTY, /* has no answer */
    COMMAND_DONE,
    COMMAND_NOT_DONE,
    COMMAND_RENDER_PRIO,
    COMMAND_RENDER_BULK,
    COMMAND_RENDER_LOW,
} protocol_command;

typedef struct protocol_message {
    int32_t version, command, x, y, z;
    char name[NAME_SIZE], media_type[NAME_SIZE], options[NAME_SIZE];
} protocol_message;

/* The sizes of the structs of versions 1, 2 and 3. */
static const size_t sizes[] = {0, 20, 64, sizeof(protocol_message)};

typedef struct renderd_client {
    camber_renderd *renderd;
    pthread_t thread;
    int socket;              /* -1: the slot is free */
    atomic_bool ends;        /* the thread has ended and can be joined */
    _Atomic double waits_ms; /* since when it has been waiting for a request; 0: it is answering one */
} renderd_client;

struct camber_renderd {
    camber_renderd_desc desc;
    size_t most_clients;
    camber_acceptor *acceptor;
    atomic_bool stopping;
    pthread_mutex_t mutex; /* guards clients' sockets */
    renderd_client clients[MOST_CLIENTS];
};

/* ---- A metatile ---- */

typedef struct metatile_request {
    pthread_mutex_t mutex;
    pthread_cond_t told;
    size_t left;
    camber_tile_request tile_requests[CAMBER_METATILE_FILE_TILES];
    camber_body *bodies[CAMBER_METATILE_FILE_TILES];
} metatile_request;

static void take(camber_tile_request *tile_request) {
    metatile_request *m = tile_request->user;
    pthread_mutex_lock(&m->mutex);
    m->bodies[tile_request - m->tile_requests] = tile_request->body;
    m->left--;
    pthread_cond_signal(&m->told);
    pthread_mutex_unlock(&m->mutex);
}

/* Requests one tile, and retries while the queue is full. */
static void request_tile(camber_renderd *renderd, metatile_request *m, size_t index,
                         const camber_route_request *first) {
    const struct timespec pause = {.tv_nsec = 2000000};
    camber_tile_request *tile_request = m->tile_requests + index;
    *tile_request = (camber_tile_request){.request = *first, .done = take, .user = m};
    tile_request->request.column += (uint32_t)(index / SIDE);
    tile_request->request.row += (uint32_t)(index % SIDE);
    pthread_mutex_lock(&m->mutex);
    m->left++;
    pthread_mutex_unlock(&m->mutex);
    while (!camber_draw_queue_add(renderd->desc.queue, tile_request)) {
        if (renderd->stopping) {
            tile_request->body = NULL;
            take(tile_request);
            return;
        }
        nanosleep(&pause, NULL);
    }
}

static int write_metatile(camber_renderd *renderd, const char *name, const camber_route_request *first) {
    metatile_request m = {.left = 0};
    const uint32_t tiles = first->zoom < 3 ? 1u << first->zoom : SIDE;
    bool whole = true;
    pthread_mutex_init(&m.mutex, NULL);
    pthread_cond_init(&m.told, NULL);
    for (size_t i = 0; i < CAMBER_METATILE_FILE_TILES; i++)
        if (i / SIDE < tiles && i % SIDE < tiles)
            request_tile(renderd, &m, i, first);
    pthread_mutex_lock(&m.mutex);
    while (m.left)
        pthread_cond_wait(&m.told, &m.mutex);
    pthread_mutex_unlock(&m.mutex);
    for (size_t i = 0; i < CAMBER_METATILE_FILE_TILES; i++)
        whole = whole && (m.bodies[i] || i / SIDE >= tiles || i % SIDE >= tiles);
    const camber_metatile_file file = {.folder = renderd->desc.folder,
                                       .name = name,
                                       .zoom = first->zoom,
                                       .column = first->column,
                                       .row = first->row,
                                       .tiles = m.bodies};
    const int cause = whole ? camber_metatile_file_write(&file) : 0;
    for (size_t i = 0; i < CAMBER_METATILE_FILE_TILES; i++)
        camber_body_release(m.bodies[i]);
    pthread_cond_destroy(&m.told);
    pthread_mutex_destroy(&m.mutex);
    if (cause) {
        char message[512];
        snprintf(message, sizeof message, "%s: %s; free some space, or make it writable", renderd->desc.folder,
                 strerror(cause));
        renderd->desc.failed(renderd->desc.user, message);
    }
    return whole && !cause;
}

/* ---- Requests ---- */

/* A name becomes the name of a folder, so only letters, digits, - and _ are allowed. */
static bool is_name(const char *name) {
    const size_t length = strnlen(name, NAME_SIZE);
    return length >= 1 && length < NAME_SIZE &&
           strspn(name, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-") == length;
}

static bool take_message(const protocol_message *message, camber_route_request *first) {
    const char *type = message->media_type;
    const bool png = message->version < 3 || !*type || strncmp(type, "image/png", NAME_SIZE) == 0;
    if (message->z < 0 || message->z > MOST_ZOOM || message->x < 0 || message->y < 0 || message->x >> message->z ||
        message->y >> message->z || !is_name(message->name))
        return false;
    if (!png && (strncmp(type, "image/webp", NAME_SIZE) != 0 || !camber_encoding_is_built(CAMBER_ENCODING_WEBP)))
        return false;
    *first = (camber_route_request){.route = CAMBER_ROUTE_TILE,
                                    .type = png ? CAMBER_ROUTE_PNG : CAMBER_ROUTE_WEBP,
                                    .ratio = 1,
                                    .zoom = message->z,
                                    .column = (uint32_t)message->x / SIDE * SIDE,
                                    .row = (uint32_t)message->y / SIDE * SIDE};
    return true;
}

static bool draw(camber_renderd *renderd, const protocol_message *message) {
    camber_route_request first;
    const bool wanted = message->command == COMMAND_RENDER || message->command == COMMAND_DIRTY ||
                        (message->command >= COMMAND_RENDER_PRIO && message->command <= COMMAND_RENDER_LOW);
    if (!wanted || renderd->stopping || !renderd->desc.is_ready(renderd->desc.user) || !take_message(message, &first))
        return false;
    return write_metatile(renderd, message->name, &first);
}

static bool receive(int from, void *bytes, size_t size) {
    for (char *at = bytes; size > 0;) {
        const ssize_t got = recv(from, at, size, 0);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        at += got;
        size -= (size_t)got;
    }
    return true;
}

/* Reads a whole request. Version 1 has no name; then the name is mod_tile's default. */
static bool receive_message(int from, protocol_message *message) {
    *message = (protocol_message){.name = "default"};
    if (!receive(from, message, sizes[1]) || message->version < 1 || message->version > 3)
        return false;
    const size_t size = sizes[message->version];
    if (!receive(from, (char *)message + sizes[1], size - sizes[1]))
        return false;
    if (message->version == 2) /* in version 2, padding follows; version 3 has the media type in this place */
        message->media_type[0] = 0;
    return true;
}

/* Returns false if the client has disconnected, or does not receive the answer. */
static bool send_message(const renderd_client *client, const protocol_message *message) {
    const char *at = (const char *)message;
    size_t left = sizes[message->version];
    struct pollfd there = {.fd = client->socket, .events = POLLOUT};
    double begin_ms = camber_now_ms();
    bool stops = false;
    while (left > 0) {
        const ssize_t sent = send(client->socket, at, left, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent > 0) {
            at += sent;
            left -= (size_t)sent;
            continue;
        }
        if (sent == 0 || (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR))
            return false;
        if (!stops && client->renderd->stopping) {
            stops = true;
            begin_ms = camber_now_ms();
        }
        if (camber_now_ms() - begin_ms > (stops ? LONGEST_LAST_SEND_MS : LONGEST_SEND_MS))
            return false;
        (void)poll(&there, 1, LOOK_MS);
    }
    return true;
}

static void *serve_client(void *user) {
    renderd_client *client = user;
    protocol_message message;
    for (;;) {
        client->waits_ms = camber_now_ms();
        if (!receive_message(client->socket, &message))
            break;
        client->waits_ms = 0;
        const bool drawn = draw(client->renderd, &message);
        const bool silent = message.command == COMMAND_DIRTY;
        message.command = drawn ? COMMAND_DONE : COMMAND_NOT_DONE;
        if (!silent && !send_message(client, &message))
            break;
    }
    (void)shutdown(client->socket, SHUT_RDWR); /* it is closed when the slot is needed, or at the end */
    client->ends = true;
    return NULL;
}

/* ---- Connections ---- */

static void close_client(camber_renderd *renderd, renderd_client *client) {
    pthread_join(client->thread, NULL);
    pthread_mutex_lock(&renderd->mutex);
    close(client->socket);
    client->socket = -1;
    client->ends = false;
    pthread_mutex_unlock(&renderd->mutex);
}

/* Finds a free slot, or the slot of the client that has been silent for longest. Returns NULL if all clients are being
 * served. */
static renderd_client *find_room(camber_renderd *renderd) {
    renderd_client *place = NULL, *silent = NULL;
    for (size_t i = 0; i < renderd->most_clients; i++) {
        renderd_client *client = renderd->clients + i;
        if (client->socket >= 0 && client->ends)
            close_client(renderd, client);
        if (client->socket < 0)
            place = client;
        else if (client->waits_ms && (!silent || client->waits_ms < silent->waits_ms))
            silent = client;
    }
    if (place || !silent || camber_now_ms() - silent->waits_ms < LEAST_WAIT_MS)
        return place;
    (void)shutdown(silent->socket, SHUT_RDWR);
    close_client(renderd, silent);
    return silent;
}

/* If there are too many clients, the new connection is closed at once. */
static void take_client(void *user, int socket) {
    camber_renderd *renderd = user;
    renderd_client *place = find_room(renderd);
    if (place) {
        pthread_mutex_lock(&renderd->mutex);
        place->socket = socket;
        place->waits_ms = camber_now_ms();
        if (pthread_create(&place->thread, NULL, serve_client, place) != 0)
            place->socket = -1;
        pthread_mutex_unlock(&renderd->mutex);
    }
    if (!place || place->socket < 0)
        close(socket);
}

/* ---- The socket ---- */

/* Binds the socket. If nobody listens at a socket that exists at this path, it is removed first. */
static int bind_socket(int made, const struct sockaddr_un *address) {
    struct stat about;
    if (bind(made, (const struct sockaddr *)address, sizeof *address) == 0)
        return 0;
    if (errno != EADDRINUSE || lstat(address->sun_path, &about) != 0 || !S_ISSOCK(about.st_mode))
        return errno;
    const int probe = socket(AF_UNIX, SOCK_STREAM, 0);
    const bool used =
        probe < 0 || connect(probe, (const struct sockaddr *)address, sizeof *address) == 0 || errno != ECONNREFUSED;
    if (probe >= 0)
        close(probe);
    if (used || unlink(address->sun_path) != 0)
        return EADDRINUSE;
    return bind(made, (const struct sockaddr *)address, sizeof *address) == 0 ? 0 : errno;
}

static int listen_at(const char *path, int *made) {
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    if (strlen(path) >= sizeof address.sun_path)
        return ENAMETOOLONG;
    memcpy(address.sun_path, path, strlen(path) + 1);
    const int socket_made = socket(AF_UNIX, SOCK_STREAM, 0);
    if (socket_made < 0)
        return errno;
    int cause = fcntl(socket_made, F_SETFD, FD_CLOEXEC) == 0 ? bind_socket(socket_made, &address) : errno;
    if (!cause && listen(socket_made, MOST_CLIENTS) != 0)
        cause = errno;
    if (cause)
        close(socket_made);
    else
        *made = socket_made;
    return cause;
}

int camber_renderd_create(const camber_renderd_desc *desc, camber_renderd **renderd) {
    camber_renderd *made = calloc(1, sizeof *made);
    if (!made)
        return ENOMEM;
    made->desc = *desc;
    made->most_clients = desc->most_clients && desc->most_clients < MOST_CLIENTS ? desc->most_clients : MOST_CLIENTS;
    for (size_t i = 0; i < MOST_CLIENTS; i++)
        made->clients[i] = (renderd_client){.renderd = made, .socket = -1};
    pthread_mutex_init(&made->mutex, NULL);
    camber_acceptor_desc clients = {.take = take_client, .user = made};
    int cause = listen_at(desc->socket, &clients.socket);
    if (!cause)
        cause = camber_acceptor_create(&clients, &made->acceptor);
    if (cause) {
        camber_renderd_destroy(made);
        return cause;
    }
    *renderd = made;
    return 0;
}

void camber_renderd_destroy(camber_renderd *renderd) {
    if (!renderd)
        return;
    renderd->stopping = true;
    if (renderd->acceptor)
        (void)unlink(renderd->desc.socket);
    camber_acceptor_destroy(renderd->acceptor);
    for (size_t i = 0; i < MOST_CLIENTS; i++)
        if (renderd->clients[i].socket >= 0)
            (void)shutdown(renderd->clients[i].socket, SHUT_RD); /* its answer is still sent */
    for (size_t i = 0; i < MOST_CLIENTS; i++)
        if (renderd->clients[i].socket >= 0)
            close_client(renderd, renderd->clients + i);
    pthread_mutex_destroy(&renderd->mutex);
    free(renderd);
}
