/* Requests and their answers.
 *
 * The path is parsed exactly as it was received. If a tile is not in memory, it is requested from the draw queue. The
 * connection is suspended until a thread of the queue resumes it, and the request is then answered like any other.
 * Every answer has a body, which is held while it is sent. No part of a request is repeated in an answer. */
#define _GNU_SOURCE /* POLLRDHUP */

#include "serve/answer.h"

#include "serve/gzip.h"
#include "serve/overlay.h"
#include "serve/page.h"

#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { LARGEST_UNPACKED_BYTES = 64 << 20, MOST_POSTS = 8 };

typedef struct request {
    camber_listener *listener;
    struct MHD_Connection *connection;
    camber_client *client; /* contains the path, too */
    char method[8];
    camber_route_request route;
    camber_tile_request tile_request;
    camber_overlay *overlay; /* drawn over a picture. NULL: none */
    char *posted;            /* posted_bytes of a body. NULL: none */
    size_t posted_bytes;
    bool is_post, is_crowded; /* it is counted among the server's posts; there is no room for its body */
    bool begun, asked, refused;
    int status; /* the status that was sent; 0: none yet */
    size_t sent_bytes;
} request;

typedef struct reply {
    int status;
    camber_body *body; /* held for the answer */
    const char *media_type, *cache_control;
    bool has_page, has_variants; /* it needs the page's headers; it may be sent compressed to other clients */
    bool is_stream;              /* it is an event stream, and body is NULL */
    bool is_preflight;           /* it tells a browser what a page of another origin may send */
    char last_modified[CAMBER_DATE_SIZE];
    char location[64]; /* where the answer is instead; "": here */
} reply;

/* ---- Methods ---- */

static int parse_route(const request *r, const char *method, camber_route_request *route) {
    const camber_server_desc *desc = &r->listener->server->desc;
    const camber_route_limits limits = {desc->most_ratio, desc->most_px, desc->maps, desc->map_count};
    return camber_route_parse(&limits, method, r->client->path, route);
}

/* Whether the path is a picture's, which also takes POST. */
static bool takes_post(const request *r, camber_route_request *route) {
    return !r->listener->is_for_metrics && parse_route(r, "POST", route) != 405;
}

/* Returns the methods that the path takes. */
static const char *find_methods(const request *r) {
    camber_route_request route;
    return takes_post(r, &route) ? "GET, HEAD, POST, OPTIONS" : "GET, HEAD";
}

/* ---- Sending ---- */

static const char *header_of(const request *r, const char *name) {
    return MHD_lookup_connection_value(r->connection, MHD_HEADER_KIND, name);
}

static void release_body(void *body) {
    camber_body_release(body);
}

static bool is_known(const request *r, const reply *a) {
    const char *tags = header_of(r, MHD_HTTP_HEADER_IF_NONE_MATCH);
    if (tags)
        return strstr(tags, a->body->etag) != NULL || strcmp(tags, "*") == 0;
    const char *since = header_of(r, MHD_HTTP_HEADER_IF_MODIFIED_SINCE);
    return since && a->last_modified[0] && strcmp(since, a->last_modified) == 0;
}

static void add(struct MHD_Response *response, const char *name, const char *value) {
    (void)MHD_add_response_header(response, name, value);
}

static void add_headers(const request *r, const reply *a, struct MHD_Response *response) {
    const camber_server *server = r->listener->server;
    add(response, "X-Content-Type-Options", "nosniff");
    add(response, MHD_HTTP_HEADER_ACCESS_CONTROL_ALLOW_ORIGIN, server->desc.cors);
    add(response, MHD_HTTP_HEADER_CACHE_CONTROL, a->cache_control);
    if (a->media_type)
        add(response, MHD_HTTP_HEADER_CONTENT_TYPE, a->media_type);
    if (a->status == 405 || a->is_preflight)
        add(response, MHD_HTTP_HEADER_ALLOW, find_methods(r));
    if (a->is_preflight) {
        add(response, "Access-Control-Allow-Methods", find_methods(r));
        add(response, "Access-Control-Allow-Headers", MHD_HTTP_HEADER_CONTENT_TYPE);
        add(response, "Access-Control-Max-Age", "86400");
    }
    if (a->status == 503)
        add(response, MHD_HTTP_HEADER_RETRY_AFTER, "1");
    if ((a->status == 200 || a->status == 304) && !a->is_stream)
        add(response, MHD_HTTP_HEADER_ETAG, a->body->etag);
    if (a->last_modified[0])
        add(response, MHD_HTTP_HEADER_LAST_MODIFIED, a->last_modified);
    if (a->has_variants)
        add(response, MHD_HTTP_HEADER_VARY, MHD_HTTP_HEADER_ACCEPT_ENCODING);
    if (a->location[0])
        add(response, MHD_HTTP_HEADER_LOCATION, a->location);
    if (a->has_page) {
        add(response, "Content-Security-Policy", server->policy);
        add(response, "Referrer-Policy", "no-referrer");
    }
    if (server->stopping)
        add(response, MHD_HTTP_HEADER_CONNECTION, "close");
}

/* Sends the answer, and releases its body. */
static enum MHD_Result send_answer(request *r, reply *a) {
    static char nothing[1];
    if (a->status == 200 && strcmp(r->method, "POST") != 0 && is_known(r, a))
        a->status = 304;
    const bool empty = a->status == 304 || a->status == 204;
    struct MHD_Response *response = empty ? MHD_create_response_from_buffer(0, nothing, MHD_RESPMEM_PERSISTENT)
                                          : MHD_create_response_from_buffer_with_free_callback_cls(
                                                a->body->size_bytes, a->body->bytes, release_body, a->body);
    if (!response) {
        camber_body_release(a->body);
        return MHD_NO;
    }
    if (!empty && a->body->encoding)
        add(response, MHD_HTTP_HEADER_CONTENT_ENCODING, a->body->encoding);
    add_headers(r, a, response);
    r->status = a->status;
    r->sent_bytes = empty || strcmp(r->method, "HEAD") == 0 ? 0 : a->body->size_bytes;
    const enum MHD_Result queued = MHD_queue_response(r->connection, (unsigned)a->status, response);
    MHD_destroy_response(response); /* the connection holds it */
    if (empty)
        camber_body_release(a->body);
    return queued;
}

static enum MHD_Result send_error(request *r, int status) {
    const int index = status == 400 ? 0 : status == 404 ? 1 : status == 405 ? 2 : status == 500 ? 3 : 4;
    reply a = {.status = status,
               .body = camber_body_hold(r->listener->server->errors[index]),
               .media_type = "text/plain; charset=utf-8",
               .cache_control = "no-store"};
    return send_answer(r, &a);
}

/* Sends a 400 whose text says what is wrong with the request. */
static enum MHD_Result send_refusal(request *r, int status, const char *reason) {
    char text[512];
    const int length = snprintf(text, sizeof text, "%d %s\n", status, reason);
    reply a = {.status = status,
               .body = camber_body_create(text, (size_t)length < sizeof text ? (size_t)length : sizeof text - 1),
               .media_type = "text/plain; charset=utf-8",
               .cache_control = "no-store"};
    return a.body ? send_answer(r, &a) : MHD_NO;
}

/* Sends one of two bodies. The second is compressed, and may be NULL. */
static enum MHD_Result send_variant(request *r, reply *a, camber_body *const bodies[2]) {
    const bool gzip = bodies[1] && camber_accepts_gzip(header_of(r, MHD_HTTP_HEADER_ACCEPT_ENCODING));
    a->has_variants = bodies[1] != NULL;
    a->body = camber_body_hold(bodies[gzip]);
    return send_answer(r, a);
}

/* ---- Tiles ---- */

/* Returns the current content of the requested map, and holds only the bodies that it returns. */
static camber_content_view look(camber_server *server, const camber_route_request *route, camber_body *bodies[2]) {
    const bool dark = route->dark;
    pthread_mutex_lock(&server->mutex);
    const camber_content_view view = server->maps[route->map].view;
    for (int i = 0; bodies && i < 2; i++)
        bodies[i] = view.tilejson[dark][i] ? camber_body_hold(view.tilejson[dark][i]) : NULL;
    pthread_mutex_unlock(&server->mutex);
    return view;
}

static enum MHD_Result send_tile(request *r, const camber_content_view *view, camber_body *body) {
    reply a = {.status = 200,
               .body = body,
               .media_type = camber_route_get_media_type(r->route.type),
               .cache_control = r->listener->server->desc.edits ? "no-cache" : "public, max-age=300"};
    memcpy(a.last_modified, view->last_modified, sizeof a.last_modified);
    return send_answer(r, &a);
}

/* Reads a tile of the archive, or finds it in memory. *body is NULL if the archive does not have it. Returns false if
 * it cannot be read. */
static bool find_stored(camber_server *server, const camber_route_request *route, camber_body **body) {
    const camber_tile_key key = camber_draw_queue_key(route);
    const camber_tiles_place place = {route->zoom, route->column, route->row};
    const uint8_t *bytes = NULL;
    size_t size_bytes = 0;
    camber_served_map *map = server->maps + route->map;
    if ((*body = camber_tile_cache_get(server->cache, key)) != NULL)
        return true;
    pthread_mutex_lock(&map->reader_mutex);
    const uint64_t generation = camber_tile_cache_get_generation(server->cache, route->map);
    const camber_status status = camber_tiles_reader_read(map->reader, &place, &bytes, &size_bytes);
    *body = status == CAMBER_OK && size_bytes ? camber_body_create(bytes, size_bytes) : NULL;
    pthread_mutex_unlock(&map->reader_mutex);
    if (*body)
        camber_tile_cache_put(server->cache, key, *body, generation);
    return status == CAMBER_OK && (*body || size_bytes == 0);
}

/* A request for a missing tile within the zoom range gets a 204, because browsers log every 404. */
static enum MHD_Result send_nothing(request *r) {
    reply a = {.status = 204, .cache_control = "public, max-age=300"};
    return send_answer(r, &a);
}

/* Before a page of another origin posts GeoJSON, its browser asks whether it may. */
static enum MHD_Result send_preflight(request *r) {
    reply a = {.status = 204, .cache_control = "no-store", .is_preflight = true};
    return send_answer(r, &a);
}

static enum MHD_Result answer_stored(request *r, const camber_content_view *view) {
    camber_body *body = NULL;
    if (r->route.ratio != 1 || r->route.dark || r->route.type != view->type)
        return send_error(r, 404);
    if (!find_stored(r->listener->server, &r->route, &body))
        return send_error(r, 500);
    if (!body)
        return send_nothing(r);
    const bool packed = body->size_bytes > 1 && body->bytes[0] == 0x1f && body->bytes[1] == 0x8b;
    if (!packed)
        return send_tile(r, view, body);
    reply a = {.status = 200,
               .media_type = camber_route_get_media_type(r->route.type),
               .cache_control = "public, max-age=300"};
    memcpy(a.last_modified, view->last_modified, sizeof a.last_modified);
    /* Other requests share the stored body, whose encoding is not set. A copy has the encoding that is sent. */
    const bool takes = camber_accepts_gzip(header_of(r, MHD_HTTP_HEADER_ACCEPT_ENCODING));
    camber_body *sent =
        takes ? camber_body_create(body->bytes, body->size_bytes) : camber_body_gunzip(body, LARGEST_UNPACKED_BYTES);
    camber_body_release(body);
    if (!sent)
        return send_error(r, 500);
    sent->encoding = takes ? "gzip" : NULL;
    a.has_variants = true;
    a.body = sent;
    return send_answer(r, &a);
}

/* Answers with the tileset of a folder of mesh tiles. Its files are identified by numbers only. */
static enum MHD_Result answer_tileset(request *r) {
    const camber_content_view view = look(r->listener->server, &r->route, NULL);
    const bool is_root = r->route.route == CAMBER_ROUTE_TILESET;
    char name[64] = "tileset.json";
    if (!view.ready)
        return send_error(r, 503);
    if (!view.tileset)
        return send_error(r, 404);
    if (!is_root)
        snprintf(name, sizeof name, "subtrees/%d.%u.%u.subtree", r->route.zoom, r->route.column, r->route.row);
    reply a = {.status = 200,
               .body = camber_body_read(view.tileset, name),
               .media_type = is_root ? "application/json" : "application/octet-stream",
               .cache_control = "public, max-age=300"};
    memcpy(a.last_modified, view.last_modified, sizeof a.last_modified);
    return a.body ? send_answer(r, &a) : send_error(r, 404);
}

static void wake(camber_tile_request *tile_request) {
    const request *r = tile_request->user;
    MHD_resume_connection(r->connection);
}

/* Whether the client has closed its end of the connection, so that nobody would receive the answer. */
static bool has_left(const camber_tile_request *tile_request) {
    const request *r = tile_request->user;
    struct pollfd look_at = {.fd = r->client->socket, .events = POLLRDHUP};
    return poll(&look_at, 1, 0) == 1 && look_at.revents & (POLLRDHUP | POLLHUP | POLLERR);
}

/* The connection is suspended before the request is queued, because the answer may arrive at once. */
static enum MHD_Result request_tile(request *r) {
    r->asked = true;
    r->tile_request = (camber_tile_request){.request = r->route, .done = wake, .is_gone = has_left, .user = r};
    MHD_suspend_connection(r->connection);
    if (!camber_draw_queue_add(r->listener->server->queue, &r->tile_request)) {
        r->refused = true;
        MHD_resume_connection(r->connection);
    }
    return MHD_YES;
}

/* ---- Overlays of pictures ---- */

/* The parameters of a query, as libmicrohttpd decodes them. */
typedef struct query {
    camber_overlay_param *params;
    size_t count, capacity;
    bool is_broken; /* a parameter contains a zero byte, or there is no memory */
} query;

static enum MHD_Result add_param(void *user, enum MHD_ValueKind kind, const char *name, size_t name_size,
                                 const char *value, size_t value_size) {
    query *q = user;
    (void)kind;
    const char *text = value ? value : "";
    if (q->count == q->capacity) {
        const size_t capacity = q->capacity ? 2 * q->capacity : 16;
        camber_overlay_param *params = realloc(q->params, capacity * sizeof *params);
        if (!params) {
            q->is_broken = true;
            return MHD_NO;
        }
        q->params = params;
        q->capacity = capacity;
    }
    q->is_broken = q->is_broken || strlen(name) != name_size || (value && strlen(value) != value_size);
    q->params[q->count++] = (camber_overlay_param){name, text};
    return MHD_YES;
}

/* Makes what the request draws over its picture, and finds the picture's view. Returns 200 or an error's status. */
static int take_overlay(request *r, char reason[CAMBER_OVERLAY_REASON_SIZE]) {
    const camber_server_desc *server = &r->listener->server->desc;
    query q = {0};
    int status = 400;
    (void)MHD_get_connection_values_n(r->connection, MHD_GET_ARGUMENT_KIND, add_param, &q);
    const camber_overlay_desc desc = {.params = q.params,
                                      .param_count = q.count,
                                      .body = r->posted,
                                      .body_size = r->posted_bytes,
                                      .fonts = server->fonts,
                                      .font_count = server->font_count,
                                      .icons = r->listener->server->icons};
    if (r->is_crowded)
        status = 503;
    else if (q.is_broken)
        snprintf(reason, CAMBER_OVERLAY_REASON_SIZE, "the query has a zero byte");
    else if (r->posted_bytes > CAMBER_OVERLAY_MOST_BODY_BYTES)
        snprintf(reason, CAMBER_OVERLAY_REASON_SIZE, "the body has more than %d bytes", CAMBER_OVERLAY_MOST_BODY_BYTES);
    else if (strcmp(r->method, "POST") == 0 && !r->posted)
        snprintf(reason, CAMBER_OVERLAY_REASON_SIZE, "POST needs a body with GeoJSON");
    else
        status = camber_overlay_create(&desc, &r->route, &r->overlay, reason);
    free(q.params);
    r->route.overlay = r->overlay;
    return status;
}

/* Keeps a part of the body of a request, up to one byte more than it may have. GeoJSON takes many times its size until
 * it is drawn, so few requests may have a body at once. */
static void take_body(request *r, const char *bytes, size_t size) {
    const size_t most = CAMBER_OVERLAY_MOST_BODY_BYTES + 1;
    if (!r->is_post) {
        r->is_post = true;
        r->is_crowded = atomic_fetch_add(&r->listener->server->posts, 1) >= MOST_POSTS;
    }
    if (!r->is_crowded && !r->posted)
        r->is_crowded = !(r->posted = malloc(most));
    if (r->is_crowded)
        return;
    const size_t taken = size < most - r->posted_bytes ? size : most - r->posted_bytes;
    memcpy(r->posted + r->posted_bytes, bytes, taken);
    r->posted_bytes += taken;
}

static const char NO_PICTURES[] = "an archive's tiles are served as they are; /static draws a map, so serve that";

static const char NO_JPEG[] = "tiles are not drawn as JPEG; ask for .png or .webp";

static enum MHD_Result answer_drawn(request *r) {
    camber_server *server = r->listener->server;
    const camber_content_view view = look(server, &r->route, NULL);
    const bool is_tile = r->route.route == CAMBER_ROUTE_TILE;
    if (r->asked && !r->refused && r->tile_request.result == CAMBER_TILE_REQUEST_DONE)
        return send_tile(r, &view, r->tile_request.body);
    if (r->asked)
        return send_error(r, !r->refused && r->tile_request.result == CAMBER_TILE_REQUEST_FAILED ? 500 : 503);
    if (!view.ready || server->stopping)
        return send_error(r, 503);
    if (view.is_archive)
        return is_tile ? answer_stored(r, &view) : send_refusal(r, 404, NO_PICTURES);
    if (r->route.type == CAMBER_ROUTE_JPEG)
        return send_refusal(r, 400, NO_JPEG);
    if (r->route.type > CAMBER_ROUTE_WEBP || (r->route.dark && !view.has_dark) ||
        (r->route.type == CAMBER_ROUTE_WEBP && !camber_encoding_is_built(CAMBER_ENCODING_WEBP)))
        return send_error(r, 404);
    char reason[CAMBER_OVERLAY_REASON_SIZE] = "";
    const int status = is_tile ? 200 : take_overlay(r, reason);
    if (status != 200)
        return status == 400 ? send_refusal(r, 400, reason) : send_error(r, status);
    camber_body *body = is_tile ? camber_tile_cache_get(server->cache, camber_draw_queue_key(&r->route)) : NULL;
    return body ? send_tile(r, &view, body) : request_tile(r);
}

/* ---- The other routes ---- */

/* Compresses the files of the page, which takes longer than a first tile should wait for. */
static void pack_page(camber_server *server) {
    pthread_mutex_lock(&server->mutex);
    for (size_t i = 0; i < camber_page_file_count && !server->page_is_packed; i++)
        server->page_bodies[2 * i + 1] = camber_body_gzip(server->page_bodies[2 * i]);
    server->page_is_packed = true;
    pthread_mutex_unlock(&server->mutex);
}

static enum MHD_Result answer_page(request *r) {
    camber_server *server = r->listener->server;
    pack_page(server);
    for (size_t i = 0; i < camber_page_file_count; i++) {
        const camber_page_file *file = camber_page_files + i;
        if (strlen(file->path) != r->route.name_length || strncmp(file->path, r->route.name, r->route.name_length) != 0)
            continue;
        reply a = {.status = 200, .media_type = file->content_type, .cache_control = "no-cache", .has_page = true};
        return send_variant(r, &a, server->page_bodies + 2 * i);
    }
    return send_error(r, 404);
}

static enum MHD_Result answer_tilejson(request *r) {
    camber_body *bodies[2];
    const camber_content_view view = look(r->listener->server, &r->route, bodies);
    reply a = {.status = 200, .media_type = "application/json", .cache_control = "no-cache"};
    memcpy(a.last_modified, view.last_modified, sizeof a.last_modified);
    const enum MHD_Result result = !view.ready  ? send_error(r, 503)
                                   : !bodies[0] ? send_error(r, 404)
                                                : send_variant(r, &a, bodies);
    camber_body_release(bodies[0]);
    camber_body_release(bodies[1]);
    return result;
}

static enum MHD_Result send_text(request *r, const char *text, size_t size_bytes, const char *media_type) {
    reply a = {.status = 200,
               .body = camber_body_create(text, size_bytes),
               .media_type = media_type,
               .cache_control = "no-store"};
    return a.body ? send_answer(r, &a) : MHD_NO;
}

/* Whether a map has been read. No map, or one without a name, whose paths are the server's own, stands for all. */
static bool is_ready(camber_server *server, uint32_t map) {
    const bool all = map == CAMBER_ROUTE_NO_MAP || !*server->maps[map].name;
    bool ready = true;
    pthread_mutex_lock(&server->mutex);
    for (uint32_t i = 0; i < server->desc.map_count; i++)
        ready = ready && (server->maps[i].view.ready || (!all && map != i));
    pthread_mutex_unlock(&server->mutex);
    return ready;
}

static enum MHD_Result answer_health(request *r) {
    static const char fine[] = "ok\n";
    camber_server *server = r->listener->server;
    return is_ready(server, r->route.map) && !server->stopping
               ? send_text(r, fine, sizeof fine - 1, "text/plain; charset=utf-8")
               : send_error(r, 503);
}

/* Returns the maps that have names, or NULL if there is no memory. */
static camber_map_metrics *list_maps(camber_server *server, uint32_t *count) {
    camber_map_metrics *maps = calloc(server->desc.map_count, sizeof *maps);
    *count = 0;
    pthread_mutex_lock(&server->mutex);
    for (uint32_t i = 0; maps && i < server->desc.map_count; i++) {
        const camber_served_map *map = server->maps + i;
        if (*map->name)
            maps[(*count)++] = (camber_map_metrics){map->name, map->view.ready, &map->requests};
    }
    pthread_mutex_unlock(&server->mutex);
    return maps;
}

static enum MHD_Result answer_metrics(request *r) {
    camber_server *server = r->listener->server;
    uint32_t map_count;
    camber_map_metrics *maps = list_maps(server, &map_count);
    const camber_metrics_now now = {.maps = maps,
                                    .map_count = map_count,
                                    .cache = camber_tile_cache_get_stats(server->cache),
                                    .ready = is_ready(server, CAMBER_ROUTE_NO_MAP),
                                    .in_flight = server->in_flight,
                                    .uptime_s = 1e-3 * (camber_now_ms() - server->start_ms)};
    char *text = NULL;
    size_t size_bytes = 0;
    FILE *file = maps ? open_memstream(&text, &size_bytes) : NULL;
    enum MHD_Result result = MHD_NO;
    if (file) {
        server->metrics.connections = camber_clients_count(server->clients);
        camber_metrics_write(&server->metrics, &now, file);
        if (fclose(file) == 0)
            result = send_text(r, text, size_bytes, "text/plain; version=0.0.4; charset=utf-8");
    }
    free(text);
    free(maps);
    return result;
}

/* Answers with an endless stream, to which the time limit of connections does not apply. */
static enum MHD_Result answer_events(request *r) {
    const camber_server *server = r->listener->server;
    const bool head = strcmp(r->method, "HEAD") == 0;
    if (!server->events)
        return send_error(r, 404);
    struct MHD_Response *response =
        head || server->stopping ? NULL : camber_events_listen(server->events, r->connection);
    if (!response)
        return send_error(r, 503);
    const reply a = {.status = 200, .media_type = "text/event-stream", .cache_control = "no-store", .is_stream = true};
    add_headers(r, &a, response);
    r->status = a.status;
    camber_client_enter(r->client, CAMBER_CLIENT_LISTENS);
    const enum MHD_Result queued = MHD_queue_response(r->connection, (unsigned)a.status, response);
    MHD_destroy_response(response);
    return queued;
}

static void write_escaped(FILE *file, const char *text) {
    for (; *text; text++)
        if (strchr("<>&\"'", *text))
            fprintf(file, "&#%d;", *text);
        else
            fputc(*text, file);
}

static void write_entry(FILE *file, const camber_served_map *map) {
    fprintf(file, "<li><a href=\"%s/\">", map->name);
    write_escaped(file, *map->title ? map->title : map->name);
    fputs("</a>", file);
    if (*map->title && strcmp(map->title, map->name) != 0)
        fprintf(file, " <code>%s</code>", map->name);
    fputs(map->view.ready ? "</li>\n" : " is being read</li>\n", file);
}

/* The list of the maps. It repeats only names and titles, not the request. */
static enum MHD_Result answer_index(request *r) {
    camber_server *server = r->listener->server;
    char *text = NULL;
    size_t size_bytes = 0;
    FILE *file = open_memstream(&text, &size_bytes);
    if (!file)
        return MHD_NO;
    fputs("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<meta name=\"color-scheme\" content=\"light dark\">\n<title>Maps</title>\n"
          "<link rel=\"icon\" href=\"page/icon.svg\" type=\"image/svg+xml\">\n"
          "<link rel=\"stylesheet\" href=\"page/page.css\">\n"
          "</head>\n<body class=\"index\">\n<main>\n<h1>Maps</h1>\n<ul>\n",
          file);
    pthread_mutex_lock(&server->mutex);
    for (uint32_t i = 0; i < server->desc.map_count; i++)
        if (!server->maps[i].is_dark)
            write_entry(file, server->maps + i);
    pthread_mutex_unlock(&server->mutex);
    fputs("</ul>\n</main>\n</body>\n</html>\n", file);
    reply a = {.status = 200, .media_type = "text/html; charset=utf-8", .cache_control = "no-cache", .has_page = true};
    a.body = fclose(file) == 0 ? camber_body_create(text, size_bytes) : NULL;
    free(text);
    return a.body ? send_answer(r, &a) : MHD_NO;
}

/* The page's paths are relative, so that the folder's name must end with a slash. */
static enum MHD_Result answer_folder(request *r) {
    static const char moved[] = "308 the map's page is below this path, with a slash after it\n";
    reply a = {.status = 308,
               .body = camber_body_create(moved, sizeof moved - 1),
               .media_type = "text/plain; charset=utf-8",
               .cache_control = "no-cache"};
    snprintf(a.location, sizeof a.location, "%.*s/", (int)r->route.name_length, r->route.name);
    return a.body ? send_answer(r, &a) : MHD_NO;
}

static enum MHD_Result answer(request *r) {
    if (r->listener->is_for_metrics != (r->route.route == CAMBER_ROUTE_METRICS))
        return send_error(r, 404);
    switch (r->route.route) {
    case CAMBER_ROUTE_PAGE: return answer_page(r);
    case CAMBER_ROUTE_TILEJSON: return answer_tilejson(r);
    case CAMBER_ROUTE_TILESET:
    case CAMBER_ROUTE_SUBTREE: return answer_tileset(r);
    case CAMBER_ROUTE_TILE:
    case CAMBER_ROUTE_STATIC: return answer_drawn(r);
    case CAMBER_ROUTE_HEALTH: return answer_health(r);
    case CAMBER_ROUTE_METRICS: return answer_metrics(r);
    case CAMBER_ROUTE_EVENTS: return answer_events(r);
    case CAMBER_ROUTE_INDEX: return answer_index(r);
    case CAMBER_ROUTE_FOLDER: return answer_folder(r);
    case CAMBER_ROUTE_NONE:
    case CAMBER_ROUTES: break;
    }
    return send_error(r, 404);
}

/* ---- Callbacks ---- */

static camber_client *client_of(struct MHD_Connection *connection) {
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info ? info->socket_context : NULL;
}

/* A target in absolute form names a server before its path. The name is ignored. */
static const char *find_path(const char *uri) {
    const size_t scheme = strncasecmp(uri, "http://", 7) == 0 ? 7 : strncasecmp(uri, "https://", 8) == 0 ? 8 : 0;
    const size_t name = scheme ? strcspn(uri + scheme, "/?") : 0;
    if (!name)
        return uri;
    const char *path = uri + scheme + name;
    return *path == '/' ? path : "/";
}

/* Copies the path into the client's memory. Nothing is allocated here, because libmicrohttpd drops requests without an
 * answer if this fails. */
void *camber_request_begin(void *user, const char *uri, struct MHD_Connection *connection) {
    camber_client *client = client_of(connection);
    (void)user;
    if (!client)
        return NULL;
    const char *path = find_path(uri);
    const size_t length = strcspn(path, "?");
    memset(client->path, 0, sizeof client->path);
    if (length < sizeof client->path)
        memcpy(client->path, path, length);
    client->path_end = (uintptr_t)uri + strlen(uri);
    client->start_ms = camber_now_ms();
    return NULL;
}

/* Called once the whole head of a request has been received. Returns NULL if memory is exhausted. */
static request *take_request(camber_listener *listener, struct MHD_Connection *connection) {
    camber_client *client = client_of(connection);
    request *r = client ? calloc(1, sizeof *r) : NULL;
    if (!r)
        return NULL;
    r->listener = listener;
    r->connection = connection;
    r->client = client;
    camber_request_leave(listener, client);
    client->request = r;
    listener->server->in_flight++;
    return r;
}

/* The version is one byte after the path, in the same buffer. If it is further away, the path contains a zero byte, and
 * we have received only its beginning. */
static bool is_whole(const request *r, const char *version) {
    enum { FARTHEST = 1 << 16 };
    const uintptr_t gap = (uintptr_t)version - r->client->path_end;
    return gap <= 1 || gap > FARTHEST;
}

static bool has_body(const request *r) {
    const char *length = header_of(r, MHD_HTTP_HEADER_CONTENT_LENGTH);
    return (length && strcmp(length, "0") != 0) || header_of(r, MHD_HTTP_HEADER_TRANSFER_ENCODING);
}

/* Whether the request's body is read: that of a picture's GeoJSON. */
static bool takes_body(const request *r, const char *method) {
    camber_route_request route;
    return strcmp(method, "POST") == 0 && !r->listener->is_for_metrics && parse_route(r, method, &route) == 200;
}

enum MHD_Result camber_request_answer(void *user, struct MHD_Connection *connection, const char *url,
                                      const char *method, const char *version, const char *upload, size_t *upload_size,
                                      void **state) {
    camber_listener *listener = user;
    request *r = *state ? *state : take_request(listener, connection);
    const size_t sent_bytes = *upload_size;
    (void)url;
    *upload_size = 0;
    if (!r)
        return MHD_NO;
    *state = r;
    if (r->status)
        return MHD_YES;
    if (r->asked)
        return answer_drawn(r);
    /* An answer at the first call closes the connection. That is right if the request has a body that nobody reads. */
    const bool takes = has_body(r) && takes_body(r, method);
    if (!r->begun && (takes || !has_body(r))) {
        r->begun = true;
        return MHD_YES;
    }
    if (takes && sent_bytes) {
        take_body(r, upload, sent_bytes);
        return MHD_YES;
    }
    camber_client_enter(r->client, CAMBER_CLIENT_TAKES);
    snprintf(r->method, sizeof r->method, "%.*s", (int)sizeof r->method - 1, method);
    int status = is_whole(r, version) ? parse_route(r, method, &r->route) : 404;
    if (status == 405 && strcmp(method, MHD_HTTP_METHOD_OPTIONS) == 0 && takes_post(r, &r->route))
        return send_preflight(r);
    /* An archive and the metrics have no pictures, so a path of a picture gets a 404 instead of a 400. */
    if (status == 400 && (listener->is_for_metrics || look(listener->server, &r->route, NULL).is_archive))
        status = 404;
    if (status == 400 && r->route.reason)
        return send_refusal(r, 400, r->route.reason);
    return status == 200 ? answer(r) : send_error(r, status);
}

/* ---- The log ---- */

static void append_json(char *text, size_t size, const char *from) {
    size_t at = strlen(text);
    for (; *from && at + 8 < size; from++) {
        const unsigned char c = (unsigned char)*from;
        if (c < 0x20 || c >= 0x7f || c == '"' || c == '\\')
            at += (size_t)snprintf(text + at, size - at, "\\u%04x", c);
        else
            text[at++] = (char)c;
    }
    text[at] = 0;
}

static void log_request(const request *r) {
    const camber_server *server = r->listener->server;
    char text[2048], date[32];
    struct timespec now;
    struct tm parts;
    clock_gettime(CLOCK_REALTIME, &now);
    if (!gmtime_r(&now.tv_sec, &parts) || !strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &parts))
        return;
    snprintf(text, sizeof text, "{\"time\":\"%s.%03ldZ\",\"method\":\"", date, now.tv_nsec / 1000000);
    append_json(text, sizeof text, r->method);
    snprintf(text + strlen(text), sizeof text - strlen(text), "\",\"path\":\"");
    append_json(text, sizeof text - 200, r->client->path);
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "\",\"route\":\"%s\",\"status\":%d,\"bytes\":%zu,\"ms\":%.3f}", camber_route_get_name(r->route.route),
             r->status, r->sent_bytes, camber_now_ms() - r->client->start_ms);
    server->desc.log_request(server->desc.user, text);
}

/* Counts a request for its map, if its path belongs to a map that has a name. */
static void count_request(camber_server *server, const request *r) {
    const bool is_of_map = r->route.route != CAMBER_ROUTE_NONE && r->route.map < server->desc.map_count;
    camber_served_map *map = is_of_map ? server->maps + r->route.map : NULL;
    camber_metrics_count_request(map && *map->name ? &map->requests : &server->metrics.requests, r->route.route,
                                 r->status);
}

void camber_request_end(void *user, struct MHD_Connection *connection, void **state,
                        enum MHD_RequestTerminationCode code) {
    camber_listener *listener = user;
    camber_server *server = listener->server;
    request *r = *state;
    (void)connection;
    (void)code;
    if (!r)
        return;
    count_request(server, r);
    server->metrics.sent_bytes += r->sent_bytes;
    if (server->desc.log_request && server->desc.logs_requests)
        log_request(r);
    camber_client_enter(r->client, CAMBER_CLIENT_SENDS);
    camber_overlay_destroy(r->overlay);
    free(r->posted);
    if (r->is_post)
        server->posts--;
    if (r->asked && !r->refused && r->status == 0) /* the tile arrived, but is not sent */
        camber_body_release(r->tile_request.body);
    r->client->request = NULL;
    free(r);
    *state = NULL;
    server->in_flight--;
}

void camber_request_leave(camber_listener *listener, camber_client *client) {
    void *left = client ? client->request : NULL;
    if (left)
        camber_request_end(listener, NULL, &left, MHD_REQUEST_TERMINATED_WITH_ERROR);
}
