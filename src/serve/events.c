/* Streams of events. A listener sleeps while it is up to date. A new event, a heartbeat or the end of the streams wakes
 * all listeners. */
#include "serve/events.h"

#include <jansson.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LISTENERS = 256, ERROR_BYTES = 1024, EVENT_BYTES = 8192, BLOCK_BYTES = 1024 };

typedef struct listener {
    camber_events *events;
    struct MHD_Connection *connection;
    struct listener *next, *before;
    unsigned state, beat; /* the last values that the listener was sent */
    bool sleeps;
    char text[EVENT_BYTES]; /* the text that is being sent: size bytes, of which the first `sent` have been sent */
    size_t sent, size;
} listener;

struct camber_events {
    pthread_mutex_t mutex;
    listener *first;
    size_t count;
    unsigned revision, beat;
    unsigned state;          /* counts revisions and errors */
    char error[ERROR_BYTES]; /* "": none */
    bool ended;
};

camber_events *camber_events_create(void) {
    camber_events *made = calloc(1, sizeof *made);
    if (made)
        pthread_mutex_init(&made->mutex, NULL);
    return made;
}

void camber_events_destroy(camber_events *events) {
    if (!events)
        return;
    pthread_mutex_destroy(&events->mutex);
    free(events);
}

/* ---- Publishing (the mutex is held in the first two functions) ---- */

static void wake_all(camber_events *events) {
    for (listener *one = events->first; one; one = one->next)
        if (one->sleeps) {
            one->sleeps = false;
            MHD_resume_connection(one->connection);
        }
}

static void write_event(const camber_events *events, listener *one) {
    json_t *data =
        json_pack("{s:i, s:s?}", "revision", (int)events->revision, "error", events->error[0] ? events->error : NULL);
    char *text = data ? json_dumps(data, JSON_ENSURE_ASCII) : NULL;
    const int size = snprintf(one->text, sizeof one->text, "event: style\ndata: %s\n\n", text ? text : "{}");
    one->sent = 0;
    one->size = size > 0 && (size_t)size < sizeof one->text ? (size_t)size : 0;
    free(text);
    json_decref(data);
}

void camber_events_tell(camber_events *events, const char *error) {
    pthread_mutex_lock(&events->mutex);
    if (error) {
        /* JSON requires UTF-8 */
        json_t *checked = json_string(error);
        snprintf(events->error, sizeof events->error, "%s", checked ? error : "the style cannot be read");
        json_decref(checked);
        for (size_t size = strlen(events->error); !(checked = json_string(events->error)) && size; size--)
            events->error[size - 1] = 0; /* the text may have been cut within a character */
        json_decref(checked);
    } else {
        events->error[0] = 0;
        events->revision++;
    }
    events->state++;
    wake_all(events);
    pthread_mutex_unlock(&events->mutex);
}

void camber_events_beat(camber_events *events) {
    pthread_mutex_lock(&events->mutex);
    events->beat++;
    wake_all(events);
    pthread_mutex_unlock(&events->mutex);
}

void camber_events_end(camber_events *events) {
    pthread_mutex_lock(&events->mutex);
    events->ended = true;
    wake_all(events);
    pthread_mutex_unlock(&events->mutex);
}

/* ---- A listener ---- */

/* libmicrohttpd calls this for more bytes. If it returns 0, the connection is suspended until there are some. */
static ssize_t give_bytes(void *user, uint64_t position, char *bytes, size_t most) {
    listener *one = user;
    camber_events *events = one->events;
    ssize_t given = 0;
    (void)position;
    pthread_mutex_lock(&events->mutex);
    if (one->sent == one->size && one->state != events->state) {
        one->state = events->state;
        write_event(events, one);
    } else if (one->sent == one->size && one->beat != events->beat) {
        one->sent = 0;
        one->size = (size_t)snprintf(one->text, sizeof one->text, ":\n\n");
    }
    one->beat = events->beat;
    if (events->ended) {
        given = MHD_CONTENT_READER_END_OF_STREAM;
    } else if (one->sent < one->size) {
        const size_t left = one->size - one->sent, size = left < most ? left : most;
        memcpy(bytes, one->text + one->sent, size);
        one->sent += size;
        given = (ssize_t)size;
    } else {
        one->sleeps = true;
        MHD_suspend_connection(one->connection);
    }
    pthread_mutex_unlock(&events->mutex);
    return given;
}

static void leave(void *user) {
    listener *one = user;
    camber_events *events = one->events;
    pthread_mutex_lock(&events->mutex);
    *(one->before ? &one->before->next : &events->first) = one->next;
    if (one->next)
        one->next->before = one->before;
    events->count--;
    pthread_mutex_unlock(&events->mutex);
    free(one);
}

struct MHD_Response *camber_events_listen(camber_events *events, struct MHD_Connection *connection) {
    listener *one = calloc(1, sizeof *one);
    if (!one)
        return NULL;
    one->events = events;
    one->connection = connection;
    pthread_mutex_lock(&events->mutex);
    const bool fits = events->count < MOST_LISTENERS;
    if (fits) {
        one->next = events->first;
        if (one->next)
            one->next->before = one;
        events->first = one;
        events->count++;
    }
    pthread_mutex_unlock(&events->mutex);
    if (!fits) {
        free(one);
        return NULL;
    }
    struct MHD_Response *response =
        MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, BLOCK_BYTES, give_bytes, one, leave);
    if (!response)
        leave(one);
    return response;
}
