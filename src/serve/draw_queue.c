/* The queue of pictures.
 *
 * A unit is a picture on its way: it waits, is drawn, and is kept with its pixels until another needs its room. Those
 * who ask hang on their unit. The thread that draws takes the unit that waits longest; threads that encode take one
 * tile at a time, for all who asked for it. Units are few, so that looking through all of them takes a microsecond. */
#define _XOPEN_SOURCE 700

#include "serve/draw_queue.h"

#include "base/clock.h"
#include "base/threads.h"

#include "camber_tiles.h"

#include <stdlib.h>
#include <string.h>

enum { LARGEST_PICTURE_PX = 2048, TILE_PX = 256 };

typedef enum unit_state {
    UNIT_FREE = 0,
    UNIT_QUEUED,
    UNIT_DRAWING,
    UNIT_DRAWN,
} unit_state;

typedef struct unit {
    unit_state state;
    camber_route_request request; /* of the one who asked first */
    camber_tile_key key;          /* of the metatile's first tile */
    uint64_t order;               /* when it was asked for, or used last */
    uint64_t generation;          /* of the cache, when drawing it began */
    camber_ask *asks;
    size_t users; /* threads that encode of it */
    camber_drawn drawn;
} unit;

struct camber_draw_queue {
    camber_draw_queue_desc desc;
    pthread_mutex_t mutex;
    pthread_cond_t work, picture; /* something to draw; to encode, or room */
    unit *units;
    size_t unit_count, queued;
    uint64_t clock;
    bool stops, woken;
    camber_threads threads; /* the first one draws */
};

/* A thread that encodes: its encoders, made when they are first needed. */
typedef struct encoding_thread {
    camber_draw_queue *drawing;
    camber_context *context;
    camber_encoder *encoders[2][2]; /* by type, and whether it is opaque */
} encoding_thread;

bool camber_drawn_resize(camber_drawn *drawn) {
    const size_t bytes = 4 * (size_t)drawn->width * drawn->height, step = CAMBER_PIXELS_ALIGNMENT;
    const size_t wanted = (bytes + step - 1) / step * step; /* as aligned_alloc wants it */
    if (wanted <= drawn->capacity_bytes)
        return true;
    free(drawn->rgba);
    drawn->rgba = aligned_alloc(step, wanted);
    drawn->capacity_bytes = drawn->rgba ? wanted : 0;
    return drawn->rgba != NULL;
}

/* ---- Names ---- */

uint32_t camber_draw_queue_side(uint32_t most, int zoom, uint32_t ratio) {
    uint32_t side = 1;
    for (int i = 0; i < zoom && 2 * side <= most && 2 * side * ratio * TILE_PX <= LARGEST_PICTURE_PX; i++)
        side *= 2;
    return side;
}

camber_tile_key camber_draw_queue_key(const camber_route_request *r) {
    return (camber_tile_key){(uint64_t)r->zoom << 56 | (uint64_t)r->column << 28 | r->row,
                             (uint64_t)r->ratio << 8 | (uint64_t)r->type << 1 | r->dark};
}

/* The key of a metatile is that of its first tile, whatever the type. */
static camber_tile_key key_of_picture(const camber_draw_queue *drawing, const camber_route_request *request) {
    camber_route_request first = *request;
    const uint32_t side = camber_draw_queue_side(drawing->desc.side, request->zoom, request->ratio);
    first.column -= first.column % side;
    first.row -= first.row % side;
    first.type = CAMBER_ROUTE_PNG;
    return camber_draw_queue_key(&first);
}

static bool is_static(const unit *u) {
    return u->request.route == CAMBER_ROUTE_STATIC;
}

/* ---- Units; the mutex is held ---- */

static void free_unit(unit *u) {
    const camber_drawn kept = u->drawn;
    *u = (unit){.drawn = {.rgba = kept.rgba, .capacity_bytes = kept.capacity_bytes}};
}

/* A unit whose picture will have, or has, the tile. NULL: none. */
static unit *find_unit(camber_draw_queue *drawing, const camber_route_request *request) {
    const camber_tile_key key = key_of_picture(drawing, request);
    const uint64_t generation = camber_tile_cache_get_generation(drawing->desc.cache);
    for (size_t i = 0; i < drawing->unit_count && request->route == CAMBER_ROUTE_TILE; i++) {
        unit *u = drawing->units + i;
        if (u->state != UNIT_FREE && !is_static(u) && u->key.place == key.place && u->key.look == key.look &&
            (u->state == UNIT_QUEUED || u->generation == generation))
            return u;
    }
    return NULL;
}

static unit *find_oldest(camber_draw_queue *drawing, bool (*fits)(const unit *u)) {
    unit *oldest = NULL;
    for (size_t i = 0; i < drawing->unit_count; i++) {
        unit *u = drawing->units + i;
        if (fits(u) && (!oldest || u->order < oldest->order))
            oldest = u;
    }
    return oldest;
}

static bool is_free(const unit *u) {
    return u->state == UNIT_FREE;
}

static bool is_queued(const unit *u) {
    return u->state == UNIT_QUEUED;
}

static bool has_work(const unit *u) {
    return u->state == UNIT_DRAWN && u->asks;
}

static bool is_kept(const unit *u) {
    return u->state == UNIT_DRAWN && !u->asks && u->users == 0;
}

/* ---- Telling those who asked; no mutex is held ---- */

static void tell(camber_ask *asks, camber_ask_result result, camber_body *body) {
    for (camber_ask *ask = asks, *next; ask; ask = next) {
        next = ask->next; /* the ask may be gone once it is done */
        ask->result = result;
        ask->body = body ? camber_body_hold(body) : NULL;
        ask->done(ask);
    }
}

/* Takes out those of a unit that are wanted, or all others. */
static camber_ask *take_asks(unit *u, bool (*wanted)(const camber_ask *ask, const void *by), const void *by) {
    camber_ask *taken = NULL, **end = &taken, **link = &u->asks;
    while (*link) {
        camber_ask *ask = *link;
        if (!wanted(ask, by)) {
            link = &ask->next;
            continue;
        }
        *link = ask->next;
        ask->next = NULL;
        *end = ask;
        end = &ask->next;
    }
    return taken;
}

static bool is_gone(const camber_ask *ask, const void *by) {
    (void)by;
    return ask->is_gone && ask->is_gone(ask);
}

static bool is_same_tile(const camber_ask *ask, const void *by) {
    const camber_route_request *request = by;
    return ask->request.type == request->type && ask->request.column == request->column &&
           ask->request.row == request->row;
}

/* ---- Asking ---- */

bool camber_draw_queue_ask(camber_draw_queue *drawing, camber_ask *ask) {
    pthread_mutex_lock(&drawing->mutex);
    unit *u = find_unit(drawing, &ask->request);
    if (!u && !drawing->stops && drawing->queued < drawing->desc.most_queued &&
        (u = find_oldest(drawing, is_free)) != NULL) {
        u->state = UNIT_QUEUED;
        u->request = ask->request;
        u->key = key_of_picture(drawing, &ask->request);
        u->order = ++drawing->clock;
        drawing->desc.metrics->queued = (int64_t)++drawing->queued;
        pthread_cond_signal(&drawing->work);
    }
    const bool taken = u && !drawing->stops;
    if (taken) {
        camber_ask **end = &u->asks;
        while (*end)
            end = &(*end)->next;
        ask->next = NULL;
        *end = ask;
        if (u->state == UNIT_DRAWN) {
            u->order = ++drawing->clock;
            pthread_cond_broadcast(&drawing->picture);
        }
    } else {
        drawing->desc.metrics->refused++;
    }
    pthread_mutex_unlock(&drawing->mutex);
    return taken;
}

void camber_draw_queue_wake(camber_draw_queue *drawing) {
    pthread_mutex_lock(&drawing->mutex);
    drawing->woken = true;
    pthread_cond_signal(&drawing->work);
    pthread_mutex_unlock(&drawing->mutex);
}

/* ---- The thread that draws ---- */

/* Takes the pixels of a kept picture where all rooms are in use. false: all of them are still encoded. */
static bool find_room(camber_draw_queue *drawing, unit *u) {
    size_t pictures = 0;
    for (size_t i = 0; i < drawing->unit_count; i++)
        pictures += drawing->units[i].state == UNIT_DRAWN;
    if (pictures < drawing->desc.most_pictures)
        return true;
    unit *oldest = find_oldest(drawing, is_kept);
    if (!oldest)
        return false;
    free(u->drawn.rgba);
    u->drawn = oldest->drawn;
    oldest->drawn = (camber_drawn){0};
    free_unit(oldest);
    return true;
}

/* The mutex is held before and after, and not meanwhile. */
static void draw_unit(camber_draw_queue *drawing, unit *u) {
    u->state = UNIT_DRAWING;
    u->generation = camber_tile_cache_get_generation(drawing->desc.cache);
    drawing->desc.metrics->queued = (int64_t)--drawing->queued;
    pthread_mutex_unlock(&drawing->mutex);
    const double start_ms = camber_now_ms();
    const camber_status status = drawing->desc.draw(drawing->desc.user, &u->request, &u->drawn);
    camber_histogram_observe(&drawing->desc.metrics->draw, 1e-3 * (camber_now_ms() - start_ms));
    pthread_mutex_lock(&drawing->mutex);
    if (status == CAMBER_OK) {
        u->state = UNIT_DRAWN;
        u->order = ++drawing->clock;
        pthread_cond_broadcast(&drawing->picture);
        return;
    }
    camber_ask *asks = u->asks;
    free_unit(u);
    pthread_mutex_unlock(&drawing->mutex);
    tell(asks, CAMBER_ASK_FAILED, NULL);
    pthread_mutex_lock(&drawing->mutex);
}

/* Lets those go whose askers have left, and draws the unit for the others. */
static void serve_unit(camber_draw_queue *drawing, unit *u) {
    camber_ask *gone = take_asks(u, is_gone, NULL);
    if (!u->asks) {
        free_unit(u);
        drawing->desc.metrics->queued = (int64_t)--drawing->queued;
        drawing->desc.metrics->dropped++;
        u = NULL;
    }
    if (gone) {
        pthread_mutex_unlock(&drawing->mutex);
        tell(gone, CAMBER_ASK_DROPPED, NULL);
        pthread_mutex_lock(&drawing->mutex);
    }
    if (!u)
        return;
    if (find_room(drawing, u))
        draw_unit(drawing, u);
    else
        pthread_cond_wait(&drawing->picture, &drawing->mutex);
}

static void run_drawing(camber_draw_queue *drawing) {
    bool prepares = true;
    pthread_mutex_lock(&drawing->mutex);
    while (!drawing->stops) {
        unit *u = find_oldest(drawing, is_queued);
        if (u) {
            serve_unit(drawing, u);
            continue;
        }
        prepares = prepares || drawing->woken;
        drawing->woken = false;
        if (!prepares) {
            pthread_cond_wait(&drawing->work, &drawing->mutex);
            continue;
        }
        pthread_mutex_unlock(&drawing->mutex);
        prepares = drawing->desc.prepare && drawing->desc.prepare(drawing->desc.user);
        pthread_mutex_lock(&drawing->mutex);
    }
    pthread_mutex_unlock(&drawing->mutex);
}

/* ---- Threads that encode ---- */

static camber_encoder *find_encoder(encoding_thread *self, camber_route_type type, bool opaque) {
    camber_encoder **encoder = &self->encoders[type == CAMBER_ROUTE_WEBP][opaque];
    const camber_encoder_desc desc = {
        .encoding = type == CAMBER_ROUTE_WEBP ? CAMBER_ENCODING_WEBP : CAMBER_ENCODING_PNG, .opaque = opaque};
    if (!*encoder)
        (void)camber_encoder_create(self->context, &desc, encoder);
    return *encoder;
}

static camber_body *encode(encoding_thread *self, const camber_drawn *drawn, const camber_route_request *request) {
    const uint8_t *bytes;
    size_t size_bytes;
    const bool whole = request->route == CAMBER_ROUTE_STATIC;
    const size_t x = whole ? 0 : request->column % drawn->side, y = whole ? 0 : request->row % drawn->side;
    const size_t stride = 4 * (size_t)drawn->width;
    const camber_pixels pixels = {.rgba = drawn->rgba + stride * drawn->tile_px * y + 4 * (size_t)drawn->tile_px * x,
                                  .width = whole ? drawn->width : drawn->tile_px,
                                  .height = whole ? drawn->height : drawn->tile_px,
                                  .stride_bytes = stride};
    camber_encoder *encoder = find_encoder(self, request->type, drawn->opaque);
    if (!encoder || camber_encoder_encode(encoder, &pixels, &bytes, &size_bytes) != CAMBER_OK)
        return NULL;
    return camber_body_create(bytes, size_bytes);
}

/* Encodes one tile of the unit for all who asked for it. The mutex is held before and after, and not meanwhile. */
static void encode_one(encoding_thread *self, unit *u) {
    camber_draw_queue *drawing = self->drawing;
    const camber_route_request request = u->asks->request;
    camber_ask *asks = take_asks(u, is_same_tile, &request);
    u->users++;
    pthread_mutex_unlock(&drawing->mutex);
    const double start_ms = camber_now_ms();
    camber_body *body = encode(self, &u->drawn, &request);
    camber_histogram_observe(&drawing->desc.metrics->encode, 1e-3 * (camber_now_ms() - start_ms));
    if (body && request.route == CAMBER_ROUTE_TILE)
        camber_tile_cache_put(drawing->desc.cache, camber_draw_queue_key(&request), body, u->generation);
    tell(asks, body ? CAMBER_ASK_DONE : CAMBER_ASK_FAILED, body);
    camber_body_release(body);
    pthread_mutex_lock(&drawing->mutex);
    u->users--;
    if (is_static(u) && is_kept(u)) { /* nobody else asks for it, and it may be large */
        free(u->drawn.rgba);
        u->drawn = (camber_drawn){0};
        free_unit(u);
    }
    pthread_cond_broadcast(&drawing->picture);
}

static void run_encoding(camber_draw_queue *drawing) {
    encoding_thread self = {.drawing = drawing};
    const camber_context_desc desc = {.log = drawing->desc.log, .log_user = drawing->desc.log_user, .cache_dir = ""};
    if (camber_context_create(&desc, &self.context) != CAMBER_OK)
        self.context = NULL;
    pthread_mutex_lock(&drawing->mutex);
    while (!drawing->stops && self.context) {
        unit *u = find_oldest(drawing, has_work);
        if (u)
            encode_one(&self, u);
        else
            pthread_cond_wait(&drawing->picture, &drawing->mutex);
    }
    pthread_mutex_unlock(&drawing->mutex);
    for (int i = 0; i < 4; i++)
        camber_encoder_destroy(self.encoders[i / 2][i % 2]);
    camber_context_destroy(self.context);
}

/* ---- The drawing ---- */

static void run(void *user, size_t number) {
    if (number == 0)
        run_drawing(user);
    else
        run_encoding(user);
}

/* One thread has to draw, and one to encode. */
static bool start_threads(camber_draw_queue *drawing) {
    camber_threads_start(&drawing->threads, 1 + (size_t)drawing->desc.threads, run, drawing);
    return drawing->threads.count > 1;
}

camber_draw_queue *camber_draw_queue_create(const camber_draw_queue_desc *desc) {
    camber_draw_queue *made = calloc(1, sizeof *made);
    if (!made)
        return NULL;
    made->desc = *desc;
    made->unit_count = (size_t)desc->most_queued + desc->most_pictures + 1;
    pthread_mutex_init(&made->mutex, NULL);
    pthread_cond_init(&made->work, NULL);
    pthread_cond_init(&made->picture, NULL);
    if ((made->units = calloc(made->unit_count, sizeof *made->units)) && start_threads(made))
        return made;
    camber_draw_queue_destroy(made);
    return NULL;
}

void camber_draw_queue_stop(camber_draw_queue *drawing) {
    pthread_mutex_lock(&drawing->mutex);
    drawing->stops = true;
    pthread_cond_broadcast(&drawing->work);
    pthread_cond_broadcast(&drawing->picture);
    pthread_mutex_unlock(&drawing->mutex);
    camber_threads_join(&drawing->threads);
    for (size_t i = 0; drawing->units && i < drawing->unit_count; i++) {
        camber_ask *asks = drawing->units[i].asks;
        drawing->units[i].asks = NULL;
        tell(asks, CAMBER_ASK_DROPPED, NULL);
    }
}

void camber_draw_queue_destroy(camber_draw_queue *drawing) {
    if (!drawing)
        return;
    camber_draw_queue_stop(drawing);
    for (size_t i = 0; drawing->units && i < drawing->unit_count; i++)
        free(drawing->units[i].drawn.rgba);
    pthread_cond_destroy(&drawing->picture);
    pthread_cond_destroy(&drawing->work);
    pthread_mutex_destroy(&drawing->mutex);
    free(drawing->units);
    free(drawing);
}
