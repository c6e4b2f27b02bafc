/* Runs `camber serve`: listens, reads the input, and then waits for signals while the server's threads draw.
 *
 * Several maps are read one after another, with one budget. SIGHUP reads input and style of each map again into a
 * second set, which replaces the first when it is complete. If reading fails, nothing changes. The reading has a thread
 * of its own, which is abandoned if its reader does not end. Both sets share the memory that the run may have. SIGTERM
 * finishes the requests in progress and ends the run; so does the loss of the device. */
#define _XOPEN_SOURCE 700

#include "cli/input.h"
#include "cli/verbs.h"

#if defined(CAMBER_MAP) && !defined(CAMBER_SERVE)

int camber_verb_serve(camber_session *session) {
    return camber_report_fail(session->report, CAMBER_EXIT_UNAVAILABLE,
                              "serve: this build has no server (CAMBER_SERVE); build it with libmicrohttpd "
                              "(Debian: libmicrohttpd-dev)");
}

#elif defined(CAMBER_MAP)

#include "base/base.h"
#include "base/threads.h"
#include "base/whole_file.h"
#include "serve/address.h"
#include "serve/server.h"

#include <errno.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* If the device fails to draw LOST_PICTURES pictures in a row, it is considered lost. */
enum { DEEPEST_ZOOM = 22, LOOK_MS = 200, BEAT_MS = 10000, LOST_PICTURES = 3 };
/* A reading that is given up ends when it next needs memory. If its library never does, the thread is abandoned. */
enum { LAST_WAIT_MS = 3000, LAST_WAIT_AT_END_MS = 500 };

typedef struct reading reading;
typedef struct rereading rereading;

/* A map: the inputs of one name, and the options with only these inputs. */
typedef struct served {
    char name[CAMBER_MAP_NAME_SIZE]; /* "": none */
    camber_options options;
    reading *current; /* what is served; NULL: nothing yet */
} served;

/* Requests that arrive as signals or as changes to the style that is edited. */
typedef struct wishes {
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    bool reload;
    atomic_bool stop; /* also read without the mutex */
    bool begins;      /* the input is being read for the first time, so there is nothing to finish yet */
    camber_guard *guard;
    const char *edited;   /* a file that is watched; NULL: none */
    struct stat about;    /* its state when it was last read */
    double beat_ms;       /* when listeners were last checked */
    int failed_pictures;  /* failures in a row, counted by the thread that draws */
    bool lost;            /* the device is lost: a reason to stop */
    atomic_bool given_up; /* the current reading takes too much time or memory; also read without the mutex */
    served *maps;         /* map_count of them */
    const char **names;   /* of the maps */
    const char **inputs;  /* of all maps */
    size_t map_count;
    rereading *left; /* a reading that was given up and has not ended yet; NULL: none */
} wishes;

/* One reading of the input. The first one is on the verb's session, and later ones have sessions of their own. */
struct reading {
    camber_session *session, own;
    camber_report report;
    camber_input input;
    camber_style *dark;
    camber_context *dark_context; /* the dark theme has a context and a report of its own while it is read */
    camber_report dark_report;
    int dark_status;
    camber_tiles_reader *reader;
    json_t *about; /* an archive's metadata */
    camber_server_content content;
    char name[256];
    const served *map;
    wishes *wishes;
};

/* A reading on its own thread. The mutex of the wishes guards the members that both threads use. */
struct rereading {
    reading *it;
    pthread_t thread;
    int status;
    bool done, is_left; /* is_left: the thread itself closes the reading */
};

/* ---- Signals ---- */

static bool heed(void *user, int number) {
    wishes *w = user;
    if (number != SIGHUP && number != SIGTERM)
        return false;
    pthread_mutex_lock(&w->mutex);
    if (number == SIGTERM && w->begins)
        camber_guard_end(w->guard, CAMBER_EXIT_DONE);
    w->reload = w->reload || number == SIGHUP;
    w->stop = w->stop || number == SIGTERM;
    pthread_cond_signal(&w->changed);
    pthread_mutex_unlock(&w->mutex);
    return true;
}

static void set_heed(camber_session *session, wishes *w) {
    camber_guard_lock(session->guard);
    session->guard->heed = w ? heed : NULL;
    session->guard->heed_user = w;
    camber_guard_unlock(session->guard);
}

/* Whether the edited file has been saved since it was last checked. One that is missing or empty is just being saved.
 */
static bool was_saved(wishes *w) {
    struct stat about;
    if (!w->edited || stat(w->edited, &about) != 0 || about.st_size == 0)
        return false;
    const bool saved = about.st_ino != w->about.st_ino || about.st_size != w->about.st_size ||
                       about.st_mtim.tv_sec != w->about.st_mtim.tv_sec ||
                       about.st_mtim.tv_nsec != w->about.st_mtim.tv_nsec;
    w->about = about;
    return saved;
}

/* The caller holds the mutex. */
static void wait_for_ms(wishes *w, long ms) {
    const struct timespec end = camber_time_in(ms);
    (void)pthread_cond_timedwait(&w->changed, &w->mutex, &end);
}

/* Waits a moment, or for a signal. The caller holds the mutex. */
static void wait_a_moment(wishes *w) {
    if (w->edited)
        wait_for_ms(w, LOOK_MS);
    else
        pthread_cond_wait(&w->changed, &w->mutex);
}

/* Waits for a signal or a change. Returns true if the input must be read again, and false if the server must stop. */
static bool wait_for_wish(wishes *w, camber_server *server) {
    pthread_mutex_lock(&w->mutex);
    while (!w->stop && !w->reload) {
        wait_a_moment(w);
        w->reload = was_saved(w) || w->reload;
        if (w->edited && camber_now_ms() - w->beat_ms > BEAT_MS) {
            w->beat_ms = camber_now_ms();
            camber_server_beat(server);
        }
    }
    const bool reload = !w->stop;
    w->reload = false;
    pthread_mutex_unlock(&w->mutex);
    return reload;
}

/* ---- Reading ---- */

static void close_reading(void *owner) {
    reading *it = owner;
    camber_tiles_reader_destroy(it->reader);
    camber_input_close(&it->input);
    camber_style_destroy(it->dark);
    camber_context_destroy(it->dark_context);
    json_decref(it->about);
    if (it->session == &it->own)
        camber_session_close(&it->own);
    free(it);
}

/* Whether the input is an archive of tiles. An archive of vector tiles is drawn like a map; read_archive detects that.
 * Options for drawing may be meant for other maps, if there are several. */
static bool is_archive(const reading *it) {
    const camber_options *options = it->session->options;
    const char *path = options->input_count ? options->inputs[0] : "";
    struct stat about;
    const char *dot = strrchr(path, '.');
    const bool named = dot && (strcmp(dot, ".pmtiles") == 0 || strcmp(dot, ".mbtiles") == 0);
    const bool folder = stat(path, &about) == 0 && S_ISDIR(about.st_mode) && !(dot && strcmp(dot, ".gdb") == 0);
    const bool drawn = !*it->map->name && (options->style || options->theme >= 0 || options->layer || options->where);
    return options->input_count == 1 && !drawn && (named || folder);
}

/* The file that is shown: the input, or the style if its own sources are drawn. */
static const char *source_of(const camber_options *options) {
    return options->input_count ? options->inputs[0] : options->style;
}

/* The file's name up to its first dot. */
static void find_name(reading *it) {
    const camber_options *options = it->session->options;
    const char *path = source_of(options), *slash = strrchr(path, '/');
    const char *name = *it->map->name ? it->map->name : slash && slash[1] ? slash + 1 : path;
    const size_t length = *name == '.' ? strlen(name) : strcspn(name, "./");
    const char *own = json_string_value(json_object_get(it->about, "name"));
    json_t *text = options->name ? json_string(options->name) : own ? json_string(own) : json_stringn(name, length);
    const char *whole = text ? json_string_value(text) : "map";
    size_t kept = strnlen(whole, sizeof it->name - 1);
    while (kept && ((unsigned char)whole[kept] & 0xc0) == 0x80) /* no character is cut, which would not be UTF-8 */
        kept--;
    snprintf(it->name, sizeof it->name, "%.*s", (int)kept, whole);
    json_decref(text);
    it->content.name = it->name;
}

static void find_time(reading *it) {
    const camber_options *options = it->session->options;
    struct stat about;
    for (size_t i = 0; i <= options->input_count; i++) {
        const char *path = i < options->input_count ? options->inputs[i] : options->style;
        if (path && stat(path, &about) == 0 && about.st_mtime > it->content.modified)
            it->content.modified = about.st_mtime;
    }
}

static void tell_picture(void *owner, camber_status status) {
    const reading *it = owner;
    wishes *w = it->wishes;
    w->failed_pictures = status == CAMBER_ERROR_DEVICE ? w->failed_pictures + 1 : 0;
    if (status != CAMBER_OK)
        (void)camber_report_status(it->session->report, status);
    if (w->failed_pictures < LOST_PICTURES)
        return;
    pthread_mutex_lock(&w->mutex);
    w->lost = true;
    w->stop = true;
    pthread_cond_signal(&w->changed);
    pthread_mutex_unlock(&w->mutex);
}

/* Warns if nothing of the map is drawn at any zoom. A style's own sources are read on demand, so they are not
 * checked. */
static void tell_nothing(const reading *it) {
    char why[1024];
    camber_input_say_missing(&it->input);
    if (it->session->options->input_count && !it->content.has_bounds &&
        !camber_features_explain_nothing(it->input.features, 0, DEEPEST_ZOOM, why, sizeof why))
        camber_report_warn(it->session->report, "nothing is drawn: %s", why);
}

static void read_dark(void *user, size_t number) {
    reading *it = user;
    const char *base_path;
    camber_session session = {.options = it->session->options, .report = &it->dark_report, .context = it->dark_context};
    (void)number;
    it->dark_status = camber_input_make_style(&session, CAMBER_THEME_DARK, &it->dark, &base_path);
}

/* Reads the map, and the dark theme beside it on a second thread. That has its own context and report, because only one
 * thread at a time may use those. If both fail, the map's failure is told. */
static int read_themes(reading *it) {
    camber_context_desc desc = it->session->context->desc;
    camber_threads beside = {.count = 0};
    it->dark_report = (camber_report){.keeps = true};
    desc.log_user = &it->dark_report;
    desc.progress = NULL;
    if (camber_context_create(&desc, &it->dark_context) != CAMBER_OK)
        return camber_report_status(it->session->report, CAMBER_ERROR_MEMORY);
    camber_threads_start(&beside, 1, read_dark, it);
    const bool started = beside.count > 0;
    const int status = camber_input_open(&it->input, it->session);
    camber_threads_join(&beside);
    if (!started && status == CAMBER_EXIT_DONE)
        read_dark(it, 0);
    if (status == CAMBER_EXIT_DONE && it->dark_status != CAMBER_EXIT_DONE)
        return camber_report_fail(it->session->report, it->dark_status, "%s", it->dark_report.error);
    return status;
}

static int read_map(reading *it) {
    const camber_options *options = it->session->options;
    const bool themed = !options->style && options->theme < 0;
    const int status = themed ? read_themes(it) : camber_input_open(&it->input, it->session);
    if (status != CAMBER_EXIT_DONE)
        return status;
    it->content.source = (camber_map_source){.features = it->input.features,
                                             .styles = {it->input.style, it->dark},
                                             .simplify_px = options->simplify_px,
                                             .coverage = (camber_coverage)options->coverage,
                                             .threads = options->threads,
                                             .drawn = tell_picture,
                                             .close = close_reading,
                                             .owner = it};
    it->content.is_dark = options->theme == CAMBER_THEME_DARK;
    it->content.attribution = it->input.attribution;
    it->content.has_bounds = camber_features_get_drawn_bounds(it->input.features, 0, DEEPEST_ZOOM, it->content.bounds);
    it->content.max_zoom = DEEPEST_ZOOM;
    tell_nothing(it);
    return CAMBER_EXIT_DONE;
}

static int read_archive(reading *it) {
    const camber_options *options = it->session->options;
    camber_route_type type;
    camber_watch_begin(&it->session->watch, options->inputs[0]);
    const camber_status status = camber_tiles_reader_create(it->session->context, options->inputs[0], &it->reader);
    camber_watch_end(&it->session->watch);
    if (status != CAMBER_OK)
        return camber_report_status(it->session->report, status);
    const camber_tiles_info *info = camber_tiles_reader_get_info(it->reader);
    if (!camber_route_find_type(info->type, &type))
        return camber_report_fail(it->session->report, CAMBER_EXIT_DATA,
                                  "%s: neither it nor its first tile shows a type of tiles that can be served (png, "
                                  "webp, jpg, avif, pbf, mlt, glb); convert it",
                                  options->inputs[0]);
    if (type == CAMBER_ROUTE_MVT && strcmp(info->format, "folder") != 0) {
        camber_tiles_reader_destroy(it->reader);
        it->reader = NULL;
        return read_map(it);
    }
    it->about = json_loads(info->metadata, 0, NULL);
    const char *attribution = json_string_value(json_object_get(it->about, "attribution"));
    it->content.attribution = options->attribution ? options->attribution : attribution;
    const char *theme = json_string_value(json_object_get(it->about, "theme"));
    it->content.is_dark = theme && strcmp(theme, "dark") == 0;
    it->content.reader = it->reader;
    it->content.metadata = info->metadata;
    it->content.tileset = type == CAMBER_ROUTE_GLB && strcmp(info->format, "folder") == 0 ? options->inputs[0] : NULL;
    it->content.min_zoom = info->min_zoom;
    it->content.max_zoom = info->max_zoom;
    it->content.has_bounds = info->has_bounds;
    it->content.has_center = info->has_center;
    memcpy(it->content.bounds, info->bounds, sizeof info->bounds);
    memcpy(it->content.center, info->center, sizeof info->center);
    it->content.close = close_reading;
    it->content.owner = it;
    return CAMBER_EXIT_DONE;
}

/* Reads what the options name. */
static int read_input(reading *it) {
    int status = camber_session_need(it->session, CAMBER_NEEDS_CONTEXT);
    if (status == CAMBER_EXIT_DONE)
        status = is_archive(it) ? read_archive(it) : read_map(it);
    if (status == CAMBER_EXIT_DONE) {
        find_name(it);
        find_time(it);
    }
    return status;
}

/* ---- Reading again ---- */

/* Returns freed memory to the system. Otherwise glibc keeps small freed blocks, which count as the process's memory. */
static void give_memory_back(void) {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

/* The caller holds the guard's lock. */
static void give_up(void *user) {
    wishes *w = user;
    pthread_mutex_lock(&w->mutex);
    w->given_up = true;
    pthread_cond_signal(&w->changed);
    pthread_mutex_unlock(&w->mutex);
}

/* Prepares another reading. It shares the verb's memory with all content that is served meanwhile. */
static void begin_again(reading *it, const camber_session *verb) {
    const wishes *w = it->wishes;
    it->report = (camber_report){.quiet = verb->report->quiet, .verbose = verb->report->verbose, .keeps = true};
    it->own = (camber_session){
        .options = &it->map->options, .report = &it->report, .guard = verb->guard, .whole = verb->budget};
    if (it->map->current)
        it->own.watch = (camber_watch){.give_up = give_up, .give_up_user = it->wishes};
    for (size_t i = 0; i < w->map_count; i++) {
        const reading *current = w->maps[i].current;
        if (current && current->session == &current->own)
            it->own.beside_bytes += camber_budget_get_held_bytes(current->own.budget);
    }
    it->session = &it->own;
}

static void *read_beside(void *user) {
    rereading *r = user;
    wishes *w = r->it->wishes;
    const int status = read_input(r->it);
    pthread_mutex_lock(&w->mutex);
    const bool is_left = r->is_left;
    r->status = status;
    r->done = !is_left;
    pthread_cond_signal(&w->changed);
    pthread_mutex_unlock(&w->mutex);
    if (is_left) {
        close_reading(r->it);
        pthread_mutex_lock(&w->mutex);
        r->done = true;
        pthread_mutex_unlock(&w->mutex);
    }
    return NULL;
}

/* Waits until the reading has finished, or has been given up and has ended. Returns false if it is still running. */
static bool wait_for_reading(wishes *w, rereading *r) {
    pthread_mutex_lock(&w->mutex);
    while (!r->done && !w->given_up && !w->stop)
        pthread_cond_wait(&w->changed, &w->mutex);
    if (!r->done)
        camber_budget_allow(r->it->own.budget, 0);
    const double end_ms = camber_now_ms() + (w->stop ? LAST_WAIT_AT_END_MS : LAST_WAIT_MS);
    while (!r->done && camber_now_ms() < end_ms)
        wait_for_ms(w, LOOK_MS);
    r->is_left = !r->done;
    pthread_mutex_unlock(&w->mutex);
    return !r->is_left;
}

/* Returns false if an abandoned reading is still running. */
static bool join_left(wishes *w) {
    pthread_mutex_lock(&w->mutex);
    const bool done = !w->left || w->left->done;
    pthread_mutex_unlock(&w->mutex);
    if (!done || !w->left)
        return done;
    pthread_join(w->left->thread, NULL);
    free(w->left);
    w->left = NULL;
    return true;
}

/* Writes a line that explains why a reading failed. */
static void explain(const reading *it, bool given_up, int status, char *error, size_t error_size) {
    const char *why = given_up ? it->own.watch.line : it->report.error;
    const bool memory = !given_up && status == CAMBER_EXIT_INTERNAL;
    const char *what = !memory            ? ""
                       : it->map->current ? "reading again, while the previous map is served: "
                                          : "reading beside the other maps: ";
    snprintf(error, error_size, "%s%.*s%s", what, (int)error_size - 100, why, memory ? " (--memory)" : "");
}

/* Reads on a thread of its own. If it fails, error receives the reason. */
static int read_again(const camber_session *verb, reading *it, char *error, size_t error_size) {
    wishes *w = it->wishes;
    begin_again(it, verb);
    if (!join_left(w)) {
        snprintf(error, error_size, "an earlier reader of the input has not ended yet; restart the server to read now");
        close_reading(it);
        return CAMBER_EXIT_DATA;
    }
    w->given_up = false;
    rereading *r = calloc(1, sizeof *r);
    int status = r ? camber_session_need(it->session, CAMBER_NEEDS_CONTEXT) : CAMBER_EXIT_INTERNAL;
    if (r)
        *r = (rereading){.it = it};
    if (status != CAMBER_EXIT_DONE || pthread_create(&r->thread, NULL, read_beside, r) != 0) {
        snprintf(error, error_size, "reading again: out of memory, or of threads; allow more");
        free(r);
        close_reading(it);
        return CAMBER_EXIT_INTERNAL;
    }
    if (!wait_for_reading(w, r)) {
        explain(it, w->given_up, CAMBER_EXIT_DATA, error, error_size);
        w->left = r;
        return CAMBER_EXIT_DATA;
    }
    pthread_join(r->thread, NULL);
    status = r->status;
    free(r);
    camber_watch_stop(&it->own.watch);
    if (w->given_up && status == CAMBER_EXIT_DONE)
        status = CAMBER_EXIT_DATA;
    if (status != CAMBER_EXIT_DONE) {
        explain(it, w->given_up, status, error, error_size);
        close_reading(it);
        give_memory_back();
        return status;
    }
    it->report.keeps = false; /* from now on failures of pictures are printed */
    camber_budget_allow(it->own.budget, camber_budget_get_most_bytes(verb->budget));
    return CAMBER_EXIT_DONE;
}

/* Returns a hash of everything that tiles are drawn from, by which a folder identifies them. */
static uint64_t hash_input(const camber_map_source *source) {
    const double numbers[] = {source->simplify_px, (double)source->coverage,
                              (double)camber_renderer_get_rasterizer(source->renderer)};
    uint64_t hash = camber_features_get_hash(source->features);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        uint64_t word;
        memcpy(&word, numbers + i, sizeof word);
        hash = camber_mix(hash, word);
    }
    return hash;
}

/* Pictures need a renderer, which is opened during the first reading. */
static int show(camber_session *verb, camber_server *server, wishes *w, size_t index) {
    served *map = w->maps + index;
    const bool first = !map->current && index == 0;
    reading *it = calloc(1, sizeof *it);
    char error[1024] = "";
    if (!it)
        return camber_report_status(verb->report, CAMBER_ERROR_MEMORY);
    it->wishes = w;
    it->map = map;
    it->session = verb;
    int status = first ? read_input(it) : read_again(verb, it, error, sizeof error);
    if (first && status != CAMBER_EXIT_DONE) {
        close_reading(it);
        return status;
    }
    if (status != CAMBER_EXIT_DONE) {
        camber_server_tell(server, error);
        return w->stop ? status : camber_report_fail(verb->report, status, "%s", error);
    }
    if (!it->reader)
        status = camber_session_need(verb, CAMBER_NEEDS_RENDERER);
    it->content.source.renderer = verb->renderer;
    it->content.source.device = verb->device;
    if (status == CAMBER_EXIT_DONE && !it->reader && verb->options->cache_dir && !verb->options->edit)
        it->content.source.input = hash_input(&it->content.source);
    if (status == CAMBER_EXIT_DONE && !camber_server_show(server, (uint32_t)index, &it->content))
        status = camber_report_status(verb->report, CAMBER_ERROR_MEMORY);
    if (status != CAMBER_EXIT_DONE) {
        close_reading(it);
        return status;
    }
    map->current = it;
    camber_server_tell(server, NULL);
    return CAMBER_EXIT_DONE;
}

/* ---- Serving ---- */

/* Called by several threads; a single call of stdio keeps each line whole. */
static void tell_request(void *user, const char *line) {
    (void)user;
    fprintf(stderr, "%s\n", line);
}

static void tell_failure(void *user, camber_log_level level, const char *message) {
    (void)user;
    if (level == CAMBER_LOG_ERROR)
        fprintf(stderr, "camber: %s\n", message);
}

/* Reads the icons of --icons, of both densities, so that a mistake in them is told now and not with each request. */
static int check_icons(camber_session *session) {
    const camber_context_desc desc = {.log = camber_report_log, .log_user = session->report, .cache_dir = ""};
    camber_context *context = NULL;
    camber_style *style = NULL;
    camber_features *features = NULL;
    json_t *document =
        json_pack("{s:i, s:s, s:{}, s:[{s:s, s:s, s:{s:s}}]}", "version", 8, "sprite", session->options->icons,
                  "sources", "layers", "id", "icons", "type", "background", "paint", "background-pattern", "icons");
    char *text = document ? json_dumps(document, JSON_COMPACT) : NULL;
    json_decref(document);
    if (!text)
        return camber_report_fail(session->report, CAMBER_EXIT_NO_INPUT, "--icons: give a path in UTF-8");
    camber_status status = camber_context_create(&desc, &context);
    if (status == CAMBER_OK)
        status = camber_style_parse(context, text, strlen(text), "--icons", &style);
    if (status == CAMBER_OK)
        status = camber_features_create(context, style, &features);
    for (int ratio = 1; ratio <= 2 && status == CAMBER_OK; ratio++)
        status = camber_features_read_sprites(features, ratio, NULL);
    camber_features_destroy(features);
    camber_style_destroy(style);
    camber_context_destroy(context);
    free(text);
    return camber_report_status(session->report, status);
}

static int listen_there(camber_session *session, const wishes *w, camber_server **server, char url[256]) {
    const camber_options *options = session->options;
    size_t length = options->public_url ? strlen(options->public_url) : 0;
    while (length && options->public_url[length - 1] == '/')
        length--;
    snprintf(url, 256, "%.*s", (int)length, options->public_url ? options->public_url : "");
    const camber_server_desc desc = {.listen = options->listen,
                                     .metrics = options->metrics,
                                     .public_url = length ? url : NULL,
                                     .cors = options->cors,
                                     .cache_bytes = (size_t)options->cache_bytes,
                                     .most_px = options->most_px,
                                     .most_ratio = options->most_ratio,
                                     .threads = options->threads,
                                     .renderd = options->renderd,
                                     .cache_dir = options->cache_dir,
                                     .maps = w->names,
                                     .map_count = (uint32_t)w->map_count,
                                     .fonts = options->fonts,
                                     .font_count = options->font_count,
                                     .icons = options->icons,
                                     .edits = options->edit != NULL,
                                     .logs_requests = options->verbose,
                                     .log_request = tell_request,
                                     .log = tell_failure};
    const char *failed = NULL;
    const int cause = camber_server_create(&desc, server, &failed);
    if (cause == EAGAIN)
        failed = NULL; /* the address is not the cause */
    if (cause && failed && failed == options->icons)
        return camber_report_fail(session->report, CAMBER_EXIT_NO_INPUT,
                                  "--icons %s: %s; give a sprite, as in icons/sprite for icons/sprite.json and "
                                  "icons/sprite.png",
                                  failed, cause == EINVAL ? "its .json lists no icons" : strerror(cause));
    if (cause == EINVAL && failed)
        return camber_report_fail(session->report, CAMBER_EXIT_USAGE,
                                  "%s: not an address; give a numeric one, as in 127.0.0.1:8080 or [::1]:8080", failed);
    if (cause && failed && failed == options->cache_dir)
        return camber_report_fail(session->report, CAMBER_EXIT_IO, "--cache-dir %s: %s; make the folder first", failed,
                                  strerror(cause));
    if (cause && failed && failed == options->renderd)
        return camber_report_fail(session->report, CAMBER_EXIT_IO,
                                  "--renderd %s: %s; give a socket that no other program uses, in a folder that exists",
                                  failed, strerror(cause));
    if (cause && failed)
        return camber_report_fail(session->report, CAMBER_EXIT_IO, "%s: %s; choose another port or address (--listen)",
                                  failed, strerror(cause));
    if (cause)
        return camber_report_fail(session->report, cause == EMFILE ? CAMBER_EXIT_IO : CAMBER_EXIT_INTERNAL,
                                  "serve: %s; %s", strerror(cause),
                                  camber_file_cure(cause, "give it more memory, or threads (ulimit -u)"));
    return options->icons ? check_icons(session) : CAMBER_EXIT_DONE;
}

/* A server that listens on all addresses has clients on other machines, which cannot use 127.0.0.1. */
static void tell_public_url(camber_session *session, const camber_server *server) {
    const char *address = camber_server_get_address(server);
    if (!session->options->public_url && (strncmp(address, "0.0.0.0:", 8) == 0 || strncmp(address, "[::]:", 5) == 0))
        camber_report_say(
            session->report,
            "tiles.json names %s, which other machines cannot reach; give the URL that they can with --public-url",
            camber_server_get_url(server));
}

/* Programs get the addresses as soon as the server listens; they ask /health whether it serves. */
static int announce(camber_session *session, const camber_server *server) {
    if (!session->options->json)
        return CAMBER_EXIT_DONE;
    json_t *object = json_pack("{s:s, s:s, s:s?}", "url", camber_server_get_url(server), "listen",
                               camber_server_get_address(server), "metrics", camber_server_get_metrics_address(server));
    return camber_report_json(session->report, object);
}

/* People get a URL that shows a map. */
static void tell_ready(camber_session *session, const camber_server *server) {
    const char *metrics = camber_server_get_metrics_address(server);
    tell_public_url(session, server);
    if (!session->options->json)
        camber_report_say(session->report, "%s/", camber_server_get_url(server));
    if (!session->options->json && metrics)
        camber_report_say(session->report, "http://%s/metrics", metrics);
    camber_report_say(session->report, "ready after %.2f s", 1e-3 * (camber_now_ms() - session->start_ms));
}

static void set_begins(wishes *w, bool begins) {
    pthread_mutex_lock(&w->mutex);
    w->begins = begins;
    pthread_mutex_unlock(&w->mutex);
}

/* Reads each map again. One that fails stays as it is. */
static void show_again(camber_session *session, camber_server *server, wishes *w) {
    for (size_t i = 0; i < w->map_count && !w->stop; i++) {
        const served *map = w->maps + i;
        const char *equals = *map->name ? "=" : "";
        if (show(session, server, w, i) == CAMBER_EXIT_DONE)
            camber_report_say(session->report, "reloaded %s%s%s", map->name, equals, source_of(&map->options));
        else if (!w->stop && *map->name)
            camber_report_say(session->report, "still serving the previous map of %s", map->name);
        else if (!w->stop)
            camber_report_say(session->report, "still serving the previous map");
    }
}

static int serve(camber_session *session, camber_server *server, wishes *w) {
    int status = announce(session, server);
    set_begins(w, true);
    for (size_t i = 0; i < w->map_count && status == CAMBER_EXIT_DONE; i++)
        status = show(session, server, w, i);
    set_begins(w, false);
    if (status != CAMBER_EXIT_DONE)
        return status;
    camber_guard_go_first(session->guard);
    tell_ready(session, server);
    while (wait_for_wish(w, server))
        show_again(session, server, w);
    if (w->lost)
        return camber_report_fail(
            session->report, CAMBER_EXIT_UNAVAILABLE,
            "serve: the device is lost; restart the server, or run it under a service manager that does");
    return CAMBER_EXIT_DONE;
}

/* ---- Maps ---- */

static size_t find_map(wishes *w, const char *name, size_t length) {
    size_t i = 0;
    while (i < w->map_count && (strlen(w->maps[i].name) != length || memcmp(w->maps[i].name, name, length) != 0))
        i++;
    if (i == w->map_count)
        snprintf(w->maps[w->map_count++].name, CAMBER_MAP_NAME_SIZE, "%.*s", (int)length, name);
    return i;
}

/* Takes the options for one map: its own inputs, and for a dark theme the dark theme of what is built in. */
static void take_options(served *map, const camber_options *options, const char **inputs) {
    const size_t length = strlen(map->name);
    const bool is_dark =
        length >= 4 && strcmp(map->name + length - 4, "dark") == 0 && (length == 4 || map->name[length - 5] == '/');
    map->options = *options;
    map->options.inputs = inputs;
    map->options.input_count = 0;
    if (is_dark && !options->style)
        map->options.theme = CAMBER_THEME_DARK;
    for (size_t i = 0; i < options->input_count; i++) {
        size_t name_length;
        const char *path = camber_options_split_input(options->inputs[i], &name_length);
        if (name_length == length && memcmp(options->inputs[i], map->name, length) == 0)
            inputs[map->options.input_count++] = path;
    }
}

/* Makes the list of maps, in the order in which they are named. Returns false if there is no memory. */
static bool make_maps(wishes *w, const camber_options *options) {
    const size_t most = options->input_count + 1;
    w->maps = calloc(most, sizeof *w->maps);
    w->names = calloc(most, sizeof *w->names);
    w->inputs = calloc(most, sizeof *w->inputs);
    if (!w->maps || !w->names || !w->inputs)
        return false;
    if (!options->input_count)
        (void)find_map(w, "", 0);
    for (size_t i = 0; i < options->input_count; i++) {
        size_t length;
        (void)camber_options_split_input(options->inputs[i], &length);
        (void)find_map(w, options->inputs[i], length);
    }
    const char **inputs = w->inputs;
    for (size_t i = 0; i < w->map_count; i++) {
        take_options(w->maps + i, options, inputs);
        inputs += w->maps[i].options.input_count;
        w->names[i] = w->maps[i].name;
    }
    return true;
}

static void free_maps(wishes *w) {
    free(w->maps);
    free(w->names);
    free(w->inputs);
}

int camber_verb_serve(camber_session *session) {
    const camber_options *options = session->options;
    wishes w = {.guard = session->guard, .edited = session->options->edit};
    camber_server *server = NULL;
    char url[256];
    pthread_mutex_init(&w.mutex, NULL);
    pthread_cond_init(&w.changed, NULL);
    (void)was_saved(&w); /* before reading, so that a change during the reading counts */
    session->opens_beside = true;
    set_heed(session, &w);
    int status = CAMBER_EXIT_DONE;
    if (make_maps(&w, options))
        session->options = &w.maps[0].options;
    else
        status = camber_report_status(session->report, CAMBER_ERROR_MEMORY);
    if (status == CAMBER_EXIT_DONE)
        status = listen_there(session, &w, &server, url);
    if (status == CAMBER_EXIT_DONE)
        status = serve(session, server, &w);
    camber_server_destroy(server);
    if (status == CAMBER_EXIT_DONE)
        camber_report_done(session->report, "serve", 0, camber_session_elapsed_ms(session),
                           "every request that had begun was answered");
    if (!join_left(&w)) { /* its library cannot be stopped in another way */
        camber_guard_lock(session->guard);
        camber_guard_end(session->guard, status);
    }
    set_heed(session, NULL);
    session->options = options;
    free_maps(&w);
    pthread_cond_destroy(&w.changed);
    pthread_mutex_destroy(&w.mutex);
    return status;
}

#endif
