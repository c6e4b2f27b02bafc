/* The server's life cycle: sockets, daemons, the content, and shutdown.
 *
 * One thread accepts connections and distributes them to a pool of threads, which wait for requests with poll and
 * answer them. The draw queue has its own threads. libmicrohttpd 0.9.75 could accept connections itself, but each
 * connection would wake the whole pool. With epoll it loses events if more than 128 arrive at once, and occasionally
 * ends the process when it is stopped, because a thread and MHD_quiesce_daemon both remove the listening socket from
 * the set.
 *
 * On shutdown, no new connection is accepted, the requests in progress are answered with "Connection: close", and then
 * everything is freed. */
#define _XOPEN_SOURCE 700

#include "serve/server.h"

#include "base/threads.h"
#include "serve/answer.h"
#include "serve/gzip.h"
#include "serve/metatile_file.h"
#include "serve/page.h"
#include "serve/tilejson.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    DEFAULT_CACHE_BYTES = 256 << 20,
    DEFAULT_PX = 2048,
    DEFAULT_RATIO = 4,
    DEFAULT_SIDE = 1,
    RENDERD_SIDE =
        CAMBER_METATILE_FILE_SIDE, /* all tiles of a file are requested at once, so one picture should contain them */
    MOST_CONNECTIONS = 12000,
    MOST_METRICS_CONNECTIONS = 64,
    SPARE_DESCRIPTORS = 128, /* for files and drivers; half of the limit if it is low */
    LEAST_CONNECTIONS = 8,
    EVENT_DESCRIPTORS = 4, /* used by each thread that waits for sockets */
    CONNECTION_BYTES = 16 << 10,
    MOST_QUEUED = 128,
    MOST_PICTURES = 24, /* if each is one tile; fewer if they are metatiles */
    LEAST_PICTURES = 3, /* one is drawn while others are encoded */
    LONGEST_END_MS = 20000,
};

static const double MOST_SECONDS = 30; /* time limit for a phase of a connection */

/* ---- Daemons ---- */

static void notice_connection(void *user, struct MHD_Connection *connection, void **context,
                              enum MHD_ConnectionNotificationCode code) {
    camber_listener *listener = user;
    if (code == MHD_CONNECTION_NOTIFY_STARTED) {
        const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
        *context = info ? camber_clients_add(listener->server->clients, info->connect_fd) : NULL;
    } else {
        camber_request_leave(listener, *context);
        camber_clients_remove(listener->server->clients, *context);
        *context = NULL;
        listener->connections--;
    }
}

static bool has_room(void *user) {
    const camber_listener *listener = user;
    return listener->connections < listener->most_connections;
}

static void take_connection(void *user, int connection) {
    camber_listener *listener = user;
    struct sockaddr_storage address;
    socklen_t size = sizeof address;
    listener->connections++;
    if (getpeername(connection, (struct sockaddr *)&address, &size) != 0) {
        close(connection); /* the client has already disconnected */
        listener->connections--;
    } else if (MHD_add_connection(listener->daemon, connection, (struct sockaddr *)&address, size) != MHD_YES) {
        listener->connections--; /* it has been closed, too */
    }
}

/* How many connections each socket may have at once; others wait in the system's queue. */
typedef struct shares {
    unsigned page, metrics, renderd;
} shares;

static rlim_t raise_limit(rlim_t wanted) {
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0)
        return 256;
    const rlim_t before = limit.rlim_cur;
    if (before >= wanted || before >= limit.rlim_max)
        return before;
    limit.rlim_cur = limit.rlim_max < wanted ? limit.rlim_max : wanted;
    return setrlimit(RLIMIT_NOFILE, &limit) == 0 ? limit.rlim_cur : before;
}

/* Counts the open descriptors. The system gives each new descriptor the lowest free number. */
static rlim_t count_descriptors(void) {
    const int next = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (next >= 0)
        close(next);
    return next >= 0 ? (rlim_t)next : SPARE_DESCRIPTORS;
}

/* Reserves some descriptors for files and drivers, whatever the limit is, because PoCL ends the process if it cannot
 * get one. Returns false if there are too few. */
static bool share_descriptors(const camber_server_desc *desc, shares *made) {
    const rlim_t fixed = count_descriptors() + (rlim_t)EVENT_DESCRIPTORS * (desc->threads + 1);
    const rlim_t metrics = desc->metrics ? MOST_METRICS_CONNECTIONS : 0;
    const rlim_t renderd = desc->renderd ? CAMBER_RENDERD_MOST_CLIENTS : 0;
    const rlim_t most = raise_limit(fixed + SPARE_DESCRIPTORS + metrics + renderd + MOST_CONNECTIONS);
    const rlim_t free_ones = most > fixed ? most - fixed : 0;
    rlim_t left = free_ones - (free_ones / 2 < SPARE_DESCRIPTORS ? free_ones / 2 : SPARE_DESCRIPTORS);
    const rlim_t quarter = left / 4;
    *made = (shares){.metrics = (unsigned)(quarter < metrics ? quarter : metrics),
                     .renderd = (unsigned)(quarter < renderd ? quarter : renderd)};
    left -= made->metrics + made->renderd;
    made->page = (unsigned)(left < MOST_CONNECTIONS ? left : MOST_CONNECTIONS);
    return made->page >= LEAST_CONNECTIONS && made->page >= desc->threads && quarter > 0;
}

/* The page may load files of this server, and tiles and tiles.json from the public URL. */
static void write_url(camber_server *server) {
    if (server->desc.public_url)
        snprintf(server->url, sizeof server->url, "%s", server->desc.public_url);
    else
        snprintf(server->url, sizeof server->url, "http://%s", server->page.address);
    const char *url = server->url, *host = strstr(url, "://");
    const size_t length = host ? (size_t)(host - url) + 3 + strcspn(host + 3, "/") : 0;
    snprintf(server->policy, sizeof server->policy,
             "default-src 'none'; script-src 'self'; style-src 'self'; "
             "img-src 'self' data: %.*s; connect-src 'self' %.*s; base-uri 'none'; form-action 'none'",
             (int)length, url, (int)length, url);
}

/* Each thread of the pool may hold all connections, which the acceptor counts: a thread of libmicrohttpd 0.9.75 that
 * exceeds its own limit never releases a lock. Returns 0 or an errno. */
static int start_daemon(camber_listener *listener, unsigned threads, unsigned connections) {
    struct MHD_OptionItem pool[] = {{MHD_OPTION_THREAD_POOL_SIZE, (intptr_t)threads, NULL}, {MHD_OPTION_END, 0, NULL}};
    listener->daemon =
        MHD_start_daemon(MHD_USE_POLL_INTERNAL_THREAD | MHD_USE_NO_LISTEN_SOCKET | MHD_ALLOW_SUSPEND_RESUME, 0, NULL,
                         NULL, camber_request_answer, listener, MHD_OPTION_CONNECTION_LIMIT, threads * connections,
                         MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)CONNECTION_BYTES, MHD_OPTION_CONNECTION_TIMEOUT,
                         (unsigned)(2 * MOST_SECONDS), MHD_OPTION_URI_LOG_CALLBACK, camber_request_begin, listener,
                         MHD_OPTION_NOTIFY_COMPLETED, camber_request_end, listener, MHD_OPTION_NOTIFY_CONNECTION,
                         notice_connection, listener, MHD_OPTION_SIGPIPE_HANDLED_BY_APP, 1,
                         threads > 1 ? MHD_OPTION_ARRAY : MHD_OPTION_END, threads > 1 ? pool : NULL, MHD_OPTION_END);
    return listener->daemon ? 0 : errno == EMFILE ? EMFILE : EAGAIN; /* otherwise memory or threads are exhausted */
}

static int start(camber_listener *listener, const char *address, unsigned threads, unsigned connections) {
    const int listening = camber_address_listen(address, listener->address);
    if (listening < 0)
        return -listening;
    if (!listener->is_for_metrics)
        write_url(listener->server); /* before the first request can arrive */
    listener->most_connections = connections;
    const int cause = start_daemon(listener, threads, connections);
    if (cause) {
        close(listening);
        return cause;
    }
    const camber_acceptor_desc desc = {listening, has_room, take_connection, listener};
    return camber_acceptor_create(&desc, &listener->acceptor);
}

/* ---- Constant bodies ---- */

static bool make_errors(camber_server *server) {
    char large[128];
    const char *const texts[] = {large, "404 not found\n", "405 method not allowed\n", "500 internal error\n",
                                 "503 not now; try again\n"};
    snprintf(large, sizeof large,
             "400 the picture is too large: a side, times @R, is at most %u px (--max-size), and R %u (--max-ratio)\n",
             server->desc.most_px, server->desc.most_ratio);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        if (!(server->errors[i] = camber_body_create(texts[i], strlen(texts[i]))))
            return false;
    return true;
}

static bool make_page(camber_server *server) {
    if (!(server->page_bodies = calloc(2 * camber_page_file_count, sizeof(camber_body *))))
        return false;
    for (size_t i = 0; i < camber_page_file_count; i++) {
        camber_body **bodies = server->page_bodies + 2 * i;
        if (!(bodies[0] = camber_body_create(camber_page_files[i].bytes, camber_page_files[i].size)))
            return false;
    }
    return true;
}

static const char *const NO_NAMES[] = {""};

static camber_server_desc fill_in(const camber_server_desc *desc) {
    camber_server_desc made = *desc;
    made.listen = desc->listen ? desc->listen : "127.0.0.1:8080";
    made.cors = desc->cors ? desc->cors : "*";
    made.cache_bytes = desc->cache_bytes ? desc->cache_bytes : DEFAULT_CACHE_BYTES;
    made.most_px = desc->most_px ? desc->most_px : DEFAULT_PX;
    made.most_ratio = desc->most_ratio ? desc->most_ratio : DEFAULT_RATIO;
    made.maps = desc->map_count ? desc->maps : NO_NAMES;
    made.map_count = desc->map_count ? desc->map_count : 1;
    made.side = desc->side ? desc->side : desc->renderd ? RENDERD_SIDE : DEFAULT_SIDE;
    made.threads = (uint32_t)camber_threads_count(desc->threads);
    return made;
}

/* Whether a map is the dark theme of another. */
static bool is_dark_of(const char *dark, const char *light) {
    const size_t length = strlen(light);
    return strncmp(dark, light, length) == 0 && strcmp(dark + length, length ? "/dark" : "dark") == 0;
}

static bool make_maps(camber_server *server) {
    const uint32_t count = server->desc.map_count;
    if (!(server->maps = calloc(count, sizeof *server->maps)))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        camber_served_map *map = server->maps + i;
        map->name = server->desc.maps[i];
        pthread_mutex_init(&map->reader_mutex, NULL);
        for (uint32_t k = 0; k < count; k++) {
            map->is_dark = map->is_dark || is_dark_of(map->name, server->desc.maps[k]);
            map->has_dark = map->has_dark || is_dark_of(server->desc.maps[k], map->name);
        }
    }
    for (uint32_t i = 0; i < count; i++)
        if (!(server->maps[i].painter = camber_painter_create(server->cache, i, server->desc.side)))
            return false;
    return true;
}

static camber_status draw_map(void *user, const camber_route_request *request, camber_rendered_picture *rendered) {
    const camber_server *server = user;
    return camber_painter_draw(server->maps[request->map].painter, request, rendered);
}

static bool prepare_maps(void *user) {
    const camber_server *server = user;
    for (uint32_t i = 0; i < server->desc.map_count; i++)
        if (camber_painter_prepare(server->maps[i].painter))
            return true;
    return false;
}

/* Metatiles for mod_tile are drawn only if a map is served; an archive has its own tiles. */
static bool is_drawing(void *user) {
    camber_server *server = user;
    pthread_mutex_lock(&server->mutex);
    const bool ready = server->maps[0].view.ready && !server->maps[0].view.is_archive;
    pthread_mutex_unlock(&server->mutex);
    return ready;
}

static void tell_failure(void *user, const char *message) {
    const camber_server *server = user;
    if (server->desc.log)
        server->desc.log(server->desc.user, CAMBER_LOG_ERROR, message);
}

static int check_folder(const char *path) {
    struct stat about;
    if (stat(path, &about) != 0)
        return errno;
    return S_ISDIR(about.st_mode) ? 0 : ENOTDIR;
}

static int start_all(camber_server *server, const char **failed) {
    const camber_server_desc *desc = &server->desc;
    *failed = desc->cache_dir;
    int cause = desc->cache_dir ? check_folder(desc->cache_dir) : 0;
    if (!cause && desc->icons) {
        *failed = desc->icons;
        cause = camber_overlay_icons_create(desc->icons, &server->icons);
    }
    if (cause)
        return cause;
    *failed = NULL;
    const uint32_t pictures = MOST_PICTURES / (desc->side * desc->side);
    const camber_draw_queue_desc queue = {.cache = server->cache,
                                          .metrics = &server->metrics,
                                          .draw = draw_map,
                                          .prepare = prepare_maps,
                                          .user = server,
                                          .side = desc->side,
                                          .threads = desc->threads,
                                          .most_queued = MOST_QUEUED,
                                          .most_pictures = pictures > LEAST_PICTURES ? pictures : LEAST_PICTURES,
                                          .log = desc->log,
                                          .log_user = desc->user};
    if (!(server->queue = camber_draw_queue_create(&queue)))
        return ENOMEM;
    shares most;
    if (!share_descriptors(desc, &most))
        return EMFILE;
    *failed = desc->metrics;
    cause = desc->metrics ? start(&server->metrics_page, desc->metrics, 1, most.metrics) : 0;
    if (cause)
        return cause;
    *failed = desc->listen;
    cause = start(&server->page, desc->listen, desc->threads, most.page);
    const camber_renderd_desc renderd = {.socket = desc->renderd,
                                         .folder = desc->cache_dir,
                                         .most_clients = most.renderd,
                                         .queue = server->queue,
                                         .is_ready = is_drawing,
                                         .failed = tell_failure,
                                         .user = server};
    if (!cause && desc->renderd) {
        *failed = desc->renderd;
        cause = camber_renderd_create(&renderd, &server->renderd);
    }
    return cause;
}

int camber_server_create(const camber_server_desc *desc, camber_server **server, const char **failed) {
    camber_server *made = calloc(1, sizeof *made);
    *failed = NULL;
    if (!made)
        return ENOMEM;
    made->desc = fill_in(desc);
    made->start_ms = camber_now_ms();
    made->page = (camber_listener){.server = made};
    made->metrics_page = (camber_listener){.server = made, .is_for_metrics = true};
    pthread_mutex_init(&made->mutex, NULL);
    int cause = ENOMEM;
    made->folder = (camber_tile_folder){.path = made->desc.cache_dir, .failed = tell_failure, .user = made};
    const bool has_folder = made->desc.cache_dir && !made->desc.renderd; /* with renderd, it belongs to mod_tile */
    if ((made->cache = camber_tile_cache_create(made->desc.cache_bytes, made->desc.map_count,
                                                has_folder ? &made->folder : NULL)) &&
        make_maps(made) && (made->clients = camber_clients_create(MOST_SECONDS)) &&
        (!desc->edits || (made->events = camber_events_create())) && make_errors(made) && make_page(made))
        cause = start_all(made, failed);
    if (cause) {
        camber_server_destroy(made);
        return cause;
    }
    *server = made;
    return 0;
}

/* ---- Shutdown ---- */

static void stop_accepting(camber_listener *listener) {
    camber_acceptor_destroy(listener->acceptor);
    listener->acceptor = NULL;
}

static void stop(camber_listener *listener) {
    stop_accepting(listener);
    if (listener->daemon)
        MHD_stop_daemon(listener->daemon);
}

static void wait_for_requests(const camber_server *server) {
    const struct timespec pause = {.tv_nsec = 5000000};
    const double end_ms = camber_now_ms() + LONGEST_END_MS;
    while (server->in_flight > 0 && camber_now_ms() < end_ms)
        nanosleep(&pause, NULL);
}

static void forget_view(camber_content_view *view) {
    for (int i = 0; i < 4; i++)
        camber_body_release(view->tilejson[i / 2][i % 2]);
}

static void destroy_maps(camber_server *server) {
    for (uint32_t i = 0; server->maps && i < server->desc.map_count; i++) {
        camber_served_map *map = server->maps + i;
        camber_painter_destroy(map->painter);
        if (map->reader && map->close_reader)
            map->close_reader(map->reader_owner);
        forget_view(&map->view);
        pthread_mutex_destroy(&map->reader_mutex);
    }
    free(server->maps);
}

void camber_server_destroy(camber_server *server) {
    if (!server)
        return;
    server->stopping = true;
    stop_accepting(&server->page);
    if (server->events)
        camber_events_end(server->events);
    camber_renderd_destroy(server->renderd);
    wait_for_requests(server);
    if (server->queue)
        camber_draw_queue_stop(server->queue); /* resumes the connections that still wait */
    stop(&server->page);
    stop(&server->metrics_page);
    camber_draw_queue_destroy(server->queue);
    destroy_maps(server);
    camber_tile_cache_destroy(server->cache);
    camber_clients_destroy(server->clients);
    camber_events_destroy(server->events);
    camber_overlay_icons_destroy(server->icons);
    for (size_t i = 0; i < sizeof server->errors / sizeof *server->errors; i++)
        camber_body_release(server->errors[i]);
    for (size_t i = 0; server->page_bodies && i < 2 * camber_page_file_count; i++)
        camber_body_release(server->page_bodies[i]);
    free(server->page_bodies);
    pthread_mutex_destroy(&server->mutex);
    free(server);
}

/* ---- Content ---- */

const char *camber_server_get_url(const camber_server *server) {
    return server->url;
}

const char *camber_server_get_address(const camber_server *server) {
    return server->page.address;
}

const char *camber_server_get_metrics_address(const camber_server *server) {
    return server->desc.metrics ? server->metrics_page.address : NULL;
}

static bool describe(const camber_server *server, const camber_served_map *map, const camber_server_content *content,
                     camber_content_view *view) {
    const bool has_dark = !content->reader && content->source.styles[1] && !map->has_dark;
    char url[sizeof server->url + 128];
    snprintf(url, sizeof url, "%s%s%s", server->url, *map->name ? "/" : "", map->name);
    struct tm parts;
    *view = (camber_content_view){
        .ready = true, .is_archive = content->reader != NULL, .has_dark = has_dark, .tileset = content->tileset};
    if (content->modified && gmtime_r(&content->modified, &parts))
        (void)strftime(view->last_modified, sizeof view->last_modified, "%a, %d %b %Y %H:%M:%S GMT", &parts);
    for (int dark = 0; dark < (has_dark ? 2 : 1); dark++) {
        const camber_tilejson_desc desc = {.content = content,
                                           .url = url,
                                           .theme = map->has_dark                              ? "light"
                                                    : dark || content->is_dark || map->is_dark ? "dark"
                                                    : has_dark                                 ? "light"
                                                                                               : NULL,
                                           .below_dark = dark,
                                           .most_ratio = server->desc.most_ratio,
                                           .edits = server->desc.edits};
        if (!(view->tilejson[dark][0] = camber_tilejson_create(&desc)))
            return false;
        view->tilejson[dark][1] = camber_body_gzip(view->tilejson[dark][0]);
    }
    return true;
}

/* Replaces the archive. The mutex ensures that no tile is being read. */
static void exchange_reader(camber_server *server, uint32_t index, const camber_server_content *content) {
    camber_served_map *map = server->maps + index;
    pthread_mutex_lock(&map->reader_mutex);
    if (map->reader && map->close_reader)
        map->close_reader(map->reader_owner);
    map->reader = content->reader;
    map->close_reader = content->close;
    map->reader_owner = content->owner;
    camber_tile_cache_clear(server->cache, index, 0);
    pthread_mutex_unlock(&map->reader_mutex);
}

void camber_server_tell(camber_server *server, const char *error) {
    if (server->events)
        camber_events_tell(server->events, error);
}

void camber_server_beat(camber_server *server) {
    if (server->events)
        camber_events_beat(server->events);
}

bool camber_server_show(camber_server *server, uint32_t index, const camber_server_content *content) {
    camber_served_map *map = server->maps + index;
    camber_content_view view, before;
    if (!describe(server, map, content, &view)) {
        forget_view(&view);
        return false;
    }
    if (content->reader) {
        (void)camber_route_find_type(camber_tiles_reader_get_info(content->reader)->type, &view.type);
        exchange_reader(server, index, content);
    } else {
        camber_painter_put(map->painter, &content->source);
        camber_draw_queue_wake(server->queue);
    }
    pthread_mutex_lock(&server->mutex);
    before = map->view;
    map->view = view;
    snprintf(map->title, sizeof map->title, "%s", content->name ? content->name : "");
    pthread_mutex_unlock(&server->mutex);
    forget_view(&before);
    return true;
}
