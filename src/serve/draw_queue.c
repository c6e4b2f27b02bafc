/* The queue of pictures to draw.
 *
 * A unit is a picture in progress: it is queued, is drawn, and keeps its pixels until another unit needs the memory.
 * Each unit has a list of the requests that wait for it. One thread draws the unit that has waited longest. Other
 * threads encode one tile at a time, for all requests of this tile. There are few units, so searching all of them takes
 * a microsecond. */
#define _XOPEN_SOURCE 700

#include "serve/draw_queue.h"

#include "base/clock.h"
#include "base/threads.h"

#include "camber_tiles.h"

#include <stdlib.h>
#include <string.h>

enum { LARGEST_PICTURE_PX = 2048, TILE_PX = 256 };
/* Whoever starts a server mostly asks for a picture at once, which must not wait for preparations. */
enum { FIRST_PREPARED_MS = 200 };

typedef enum unit_state {
    UNIT_FREE = 0,
    UNIT_QUEUED,
    UNIT_DRAWING,
    UNIT_DRAWN,
} unit_state;

typedef struct unit {
    unit_state state;
    camber_route_request request; /* of the first request */
    camber_tile_key key;          /* of the first tile of the metatile */
    uint64_t order;               /* the queue's clock when it was last requested or used */
    uint64_t generation;          /* generation of the cache when drawing began */
    camber_tile_request *tile_requests;
    size_t users; /* threads that are encoding tiles of the unit */
    camber_rendered_picture rendered;
} unit;

struct camber_draw_queue {
    camber_draw_queue_desc desc;
    pthread_mutex_t mutex;
    /* work: there is something to draw; picture: there is a tile to encode, or memory for a picture */
    pthread_cond_t work, picture;
    unit *units;
    size_t unit_count, queued;
    uint64_t clock;
    bool stops, woken;
    camber_threads threads; /* the first thread draws */
};

/* A thread that encodes, and its encoders, which are created when first needed. */
typedef struct encoding_thread {
    camber_draw_queue *queue;
    camber_context *context;
    camber_encoder *encoders[2][2]; /* [type][is opaque] */
} encoding_thread;

bool camber_rendered_picture_resize(camber_rendered_picture *rendered) {
    const size_t bytes = 4 * (size_t)rendered->width * rendered->height, step = CAMBER_PIXELS_ALIGNMENT;
    const size_t wanted = (bytes + step - 1) / step * step; /* aligned_alloc requires a multiple of the alignment */
    if (wanted <= rendered->capacity_bytes)
        return true;
    free(rendered->rgba);
    rendered->rgba = aligned_alloc(step, wanted);
    rendered->capacity_bytes = rendered->rgba ? wanted : 0;
    return rendered->rgba != NULL;
}

/* ---- Keys ---- */

uint32_t camber_draw_queue_side(uint32_t most, int zoom, uint32_t ratio) {
    uint32_t side = 1;
    for (int i = 0; i < zoom && 2 * side <= most && 2 * side * ratio * TILE_PX <= LARGEST_PICTURE_PX; i++)
        side *= 2;
    return side;
}

camber_tile_key camber_draw_queue_key(const camber_route_request *r) {
    return (camber_tile_key){(uint64_t)r->zoom << 56 | (uint64_t)r->column << 28 | r->row,
                             (uint64_t)r->ratio << 8 | (uint64_t)r->type << 1 | r->dark, r->map};
}

/* Returns the key of a metatile, which is the key of its first tile as PNG, whatever type is requested. */
static camber_tile_key key_of_picture(const camber_draw_queue *queue, const camber_route_request *request) {
    camber_route_request first = *request;
    const uint32_t side = camber_draw_queue_side(queue->desc.side, request->zoom, request->ratio);
    first.column -= first.column % side;
    first.row -= first.row % side;
    first.type = CAMBER_ROUTE_PNG;
    return camber_draw_queue_key(&first);
}

static bool is_static(const unit *u) {
    return u->request.route == CAMBER_ROUTE_STATIC;
}

/* ---- Units (the caller holds the mutex) ---- */

static void free_unit(unit *u) {
    const camber_rendered_picture kept = u->rendered;
    *u = (unit){.rendered = {.rgba = kept.rgba, .capacity_bytes = kept.capacity_bytes}};
}

/* Finds a unit whose picture contains, or will contain, the tile. Returns NULL if there is none. */
static unit *find_unit(camber_draw_queue *queue, const camber_route_request *request) {
    const camber_tile_key key = key_of_picture(queue, request);
    const uint64_t generation = camber_tile_cache_get_generation(queue->desc.cache, request->map);
    for (size_t i = 0; i < queue->unit_count && request->route == CAMBER_ROUTE_TILE; i++) {
        unit *u = queue->units + i;
        if (u->state != UNIT_FREE && !is_static(u) && u->key.place == key.place && u->key.look == key.look &&
            u->key.map == key.map && (u->state == UNIT_QUEUED || u->generation == generation))
            return u;
    }
    return NULL;
}

static unit *find_oldest(camber_draw_queue *queue, bool (*fits)(const unit *u)) {
    unit *oldest = NULL;
    for (size_t i = 0; i < queue->unit_count; i++) {
        unit *u = queue->units + i;
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
    return u->state == UNIT_DRAWN && u->tile_requests;
}

static bool is_kept(const unit *u) {
    return u->state == UNIT_DRAWN && !u->tile_requests && u->users == 0;
}

/* ---- Finishing requests (the caller does not hold the mutex) ---- */

static void tell(camber_tile_request *tile_requests, camber_tile_request_result result, camber_body *body) {
    for (camber_tile_request *tile_request = tile_requests, *next; tile_request; tile_request = next) {
        next = tile_request->next; /* done may free the request */
        tile_request->result = result;
        tile_request->body = body ? camber_body_hold(body) : NULL;
        tile_request->done(tile_request);
    }
}

/* Removes and returns the unit's requests for which `wanted` returns true. */
static camber_tile_request *take_requests(unit *u,
                                          bool (*wanted)(const camber_tile_request *tile_request, const void *by),
                                          const void *by) {
    camber_tile_request *taken = NULL, **end = &taken, **link = &u->tile_requests;
    while (*link) {
        camber_tile_request *tile_request = *link;
        if (!wanted(tile_request, by)) {
            link = &tile_request->next;
            continue;
        }
        *link = tile_request->next;
        tile_request->next = NULL;
        *end = tile_request;
        end = &tile_request->next;
    }
    return taken;
}

static bool is_gone(const camber_tile_request *tile_request, const void *by) {
    (void)by;
    return tile_request->is_gone && tile_request->is_gone(tile_request);
}

static bool is_same_tile(const camber_tile_request *tile_request, const void *by) {
    const camber_route_request *request = by;
    return tile_request->request.type == request->type && tile_request->request.column == request->column &&
           tile_request->request.row == request->row;
}

/* ---- Adding requests ---- */

bool camber_draw_queue_add(camber_draw_queue *queue, camber_tile_request *tile_request) {
    pthread_mutex_lock(&queue->mutex);
    unit *u = find_unit(queue, &tile_request->request);
    if (!u && !queue->stops && queue->queued < queue->desc.most_queued && (u = find_oldest(queue, is_free)) != NULL) {
        u->state = UNIT_QUEUED;
        u->request = tile_request->request;
        u->key = key_of_picture(queue, &tile_request->request);
        u->order = ++queue->clock;
        queue->desc.metrics->queued = (int64_t)++queue->queued;
        pthread_cond_signal(&queue->work);
    }
    const bool taken = u && !queue->stops;
    if (taken) {
        camber_tile_request **end = &u->tile_requests;
        while (*end)
            end = &(*end)->next;
        tile_request->next = NULL;
        *end = tile_request;
        if (u->state == UNIT_DRAWN) {
            u->order = ++queue->clock;
            pthread_cond_broadcast(&queue->picture);
        }
    } else {
        queue->desc.metrics->refused++;
    }
    pthread_mutex_unlock(&queue->mutex);
    return taken;
}

void camber_draw_queue_wake(camber_draw_queue *queue) {
    pthread_mutex_lock(&queue->mutex);
    queue->woken = true;
    pthread_cond_signal(&queue->work);
    pthread_mutex_unlock(&queue->mutex);
}

/* ---- The thread that draws ---- */

/* If the limit of pictures is reached, takes the pixels of the oldest kept picture. Returns false if all of them are
 * still being encoded. */
static bool find_room(camber_draw_queue *queue, unit *u) {
    size_t pictures = 0;
    for (size_t i = 0; i < queue->unit_count; i++)
        pictures += queue->units[i].state == UNIT_DRAWN;
    if (pictures < queue->desc.most_pictures)
        return true;
    unit *oldest = find_oldest(queue, is_kept);
    if (!oldest)
        return false;
    free(u->rendered.rgba);
    u->rendered = oldest->rendered;
    oldest->rendered = (camber_rendered_picture){0};
    free_unit(oldest);
    return true;
}

/* The mutex is held at the start and at the end, and released while the unit is drawn. */
static void draw_unit(camber_draw_queue *queue, unit *u) {
    u->state = UNIT_DRAWING;
    u->generation = camber_tile_cache_get_generation(queue->desc.cache, u->request.map);
    queue->desc.metrics->queued = (int64_t)--queue->queued;
    pthread_mutex_unlock(&queue->mutex);
    const double start_ms = camber_now_ms();
    const camber_status status = queue->desc.draw(queue->desc.user, &u->request, &u->rendered);
    camber_histogram_observe(&queue->desc.metrics->draw, 1e-3 * (camber_now_ms() - start_ms));
    pthread_mutex_lock(&queue->mutex);
    if (status == CAMBER_OK) {
        u->state = UNIT_DRAWN;
        u->order = ++queue->clock;
        pthread_cond_broadcast(&queue->picture);
        return;
    }
    camber_tile_request *tile_requests = u->tile_requests;
    free_unit(u);
    pthread_mutex_unlock(&queue->mutex);
    tell(tile_requests, CAMBER_TILE_REQUEST_FAILED, NULL);
    pthread_mutex_lock(&queue->mutex);
}

/* Drops the requests whose clients have disconnected, and draws the unit if others remain. */
static void serve_unit(camber_draw_queue *queue, unit *u) {
    camber_tile_request *gone = take_requests(u, is_gone, NULL);
    if (!u->tile_requests) {
        free_unit(u);
        queue->desc.metrics->queued = (int64_t)--queue->queued;
        queue->desc.metrics->dropped++;
        u = NULL;
    }
    if (gone) {
        pthread_mutex_unlock(&queue->mutex);
        tell(gone, CAMBER_TILE_REQUEST_DROPPED, NULL);
        pthread_mutex_lock(&queue->mutex);
    }
    if (!u)
        return;
    if (find_room(queue, u))
        draw_unit(queue, u);
    else
        pthread_cond_wait(&queue->picture, &queue->mutex);
}

static void run_drawing(camber_draw_queue *queue) {
    bool prepares = true;
    const struct timespec first = camber_time_in(FIRST_PREPARED_MS);
    pthread_mutex_lock(&queue->mutex);
    while (!queue->stops && !queue->woken && !find_oldest(queue, is_queued) &&
           pthread_cond_timedwait(&queue->work, &queue->mutex, &first) == 0)
        ;
    while (!queue->stops) {
        unit *u = find_oldest(queue, is_queued);
        if (u) {
            serve_unit(queue, u);
            continue;
        }
        prepares = prepares || queue->woken;
        queue->woken = false;
        if (!prepares) {
            pthread_cond_wait(&queue->work, &queue->mutex);
            continue;
        }
        pthread_mutex_unlock(&queue->mutex);
        prepares = queue->desc.prepare && queue->desc.prepare(queue->desc.user);
        pthread_mutex_lock(&queue->mutex);
    }
    pthread_mutex_unlock(&queue->mutex);
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

static camber_body *encode(encoding_thread *self, const camber_rendered_picture *rendered,
                           const camber_route_request *request) {
    const uint8_t *bytes;
    size_t size_bytes;
    const bool whole = request->route == CAMBER_ROUTE_STATIC;
    const size_t x = whole ? 0 : request->column % rendered->side, y = whole ? 0 : request->row % rendered->side;
    const size_t stride = 4 * (size_t)rendered->width;
    const camber_pixels pixels = {.rgba = rendered->rgba + stride * rendered->tile_px * y +
                                          4 * (size_t)rendered->tile_px * x,
                                  .width = whole ? rendered->width : rendered->tile_px,
                                  .height = whole ? rendered->height : rendered->tile_px,
                                  .stride_bytes = stride};
    camber_encoder *encoder = find_encoder(self, request->type, rendered->opaque);
    if (!encoder || camber_encoder_encode(encoder, &pixels, &bytes, &size_bytes) != CAMBER_OK)
        return NULL;
    return camber_body_create(bytes, size_bytes);
}

/* Encodes one tile of the unit for all requests of it. The mutex is held at the start and at the end, and released
 * while the tile is encoded. */
static void encode_one(encoding_thread *self, unit *u) {
    camber_draw_queue *queue = self->queue;
    const camber_route_request request = u->tile_requests->request;
    camber_tile_request *tile_requests = take_requests(u, is_same_tile, &request);
    u->users++;
    pthread_mutex_unlock(&queue->mutex);
    const double start_ms = camber_now_ms();
    camber_body *body = encode(self, &u->rendered, &request);
    camber_histogram_observe(&queue->desc.metrics->encode, 1e-3 * (camber_now_ms() - start_ms));
    if (body && request.route == CAMBER_ROUTE_TILE)
        camber_tile_cache_put(queue->desc.cache, camber_draw_queue_key(&request), body, u->generation);
    tell(tile_requests, body ? CAMBER_TILE_REQUEST_DONE : CAMBER_TILE_REQUEST_FAILED, body);
    camber_body_release(body);
    pthread_mutex_lock(&queue->mutex);
    u->users--;
    if (is_static(u) && is_kept(u)) { /* no other request will need it, and it may be large */
        free(u->rendered.rgba);
        u->rendered = (camber_rendered_picture){0};
        free_unit(u);
    }
    pthread_cond_broadcast(&queue->picture);
}

static void run_encoding(camber_draw_queue *queue) {
    encoding_thread self = {.queue = queue};
    const camber_context_desc desc = {.log = queue->desc.log, .log_user = queue->desc.log_user, .cache_dir = ""};
    if (camber_context_create(&desc, &self.context) != CAMBER_OK)
        self.context = NULL;
    pthread_mutex_lock(&queue->mutex);
    while (!queue->stops && self.context) {
        unit *u = find_oldest(queue, has_work);
        if (u)
            encode_one(&self, u);
        else
            pthread_cond_wait(&queue->picture, &queue->mutex);
    }
    pthread_mutex_unlock(&queue->mutex);
    for (int i = 0; i < 4; i++)
        camber_encoder_destroy(self.encoders[i / 2][i % 2]);
    camber_context_destroy(self.context);
}

/* ---- The queue ---- */

static void run(void *user, size_t number) {
    if (number == 0)
        run_drawing(user);
    else
        run_encoding(user);
}

/* At least one thread draws, and one encodes. */
static bool start_threads(camber_draw_queue *queue) {
    camber_threads_start(&queue->threads, 1 + (size_t)queue->desc.threads, run, queue);
    return queue->threads.count > 1;
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

void camber_draw_queue_stop(camber_draw_queue *queue) {
    pthread_mutex_lock(&queue->mutex);
    queue->stops = true;
    pthread_cond_broadcast(&queue->work);
    pthread_cond_broadcast(&queue->picture);
    pthread_mutex_unlock(&queue->mutex);
    camber_threads_join(&queue->threads);
    for (size_t i = 0; queue->units && i < queue->unit_count; i++) {
        camber_tile_request *tile_requests = queue->units[i].tile_requests;
        queue->units[i].tile_requests = NULL;
        tell(tile_requests, CAMBER_TILE_REQUEST_DROPPED, NULL);
    }
}

void camber_draw_queue_destroy(camber_draw_queue *queue) {
    if (!queue)
        return;
    camber_draw_queue_stop(queue);
    for (size_t i = 0; queue->units && i < queue->unit_count; i++)
        free(queue->units[i].rendered.rgba);
    pthread_cond_destroy(&queue->picture);
    pthread_cond_destroy(&queue->work);
    pthread_mutex_destroy(&queue->mutex);
    free(queue->units);
    free(queue);
}
