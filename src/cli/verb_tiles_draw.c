/* Runs `camber tiles INPUT... -o OUT`: reads the input, and draws a pyramid of tiles into an archive. A summary of
 * counts and times goes to standard error, or to standard output as JSON. */
#define _XOPEN_SOURCE 700

#include "cli/input.h"
#include "cli/shard.h"
#include "cli/tiles_files.h"
#include "cli/verbs.h"

#ifdef CAMBER_MAP

#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct job {
    camber_session *session;
    camber_input input;
    camber_shard shard;
    char output[4096], name[4096];
    camber_style *region_style;
    camber_features *region;
    camber_tiles_place *places;
    size_t place_count;
    camber_tiles_engine *engine;
    camber_tiles_schedule *schedule; /* NULL: the engine finds where lines are */
    camber_tiles_files files;
    bool is_left; /* the archive exists, with the finished units of an interrupted run */
    bool begun;   /* the archive has been started by this run */
    camber_tiles_stats stats;
    double load_ms, total_ms;
} job;

/* ---- The tiles to draw ---- */

/* Polygons are read as outlines, with a style that selects only them. */
static int read_region(job *j) {
    static const char style[] = "{\"version\":8,\"sources\":{},\"layers\":[{\"id\":\"region\",\"type\":\"line\","
                                "\"filter\":[\"==\",[\"geometry-type\"],\"Polygon\"]}]}";
    camber_session *session = j->session;
    const char *path = session->options->region;
    if (!path)
        return CAMBER_EXIT_DONE;
    const camber_source_desc desc = {.path = path, .keep_apart = true};
    camber_status status =
        camber_style_parse(session->context, style, sizeof style - 1, "the region's style", &j->region_style);
    if (status == CAMBER_OK)
        status = camber_features_create(session->context, j->region_style, &j->region);
    if (status == CAMBER_OK)
        status = camber_features_read(j->region, &desc);
    return camber_report_status(session->report, status);
}

static int add_line(job *j, const char *path, char *line, size_t number) {
    size_t length = strlen(line);
    while (length && strchr(" \t\r", line[length - 1]))
        line[--length] = 0;
    if (!length)
        return CAMBER_EXIT_DONE;
    if (!camber_options_parse_place(line, &j->places[j->place_count])) {
        for (char *c = line; *c; c++)
            *c = (unsigned char)*c < 0x20 || (unsigned char)*c >= 0x7f ? '?' : *c;
        return camber_report_fail(j->session->report, CAMBER_EXIT_DATA,
                                  "%s: line %zu, \"%.40s\", is not a tile; give zoom/column/row, as in 12/1950/1533",
                                  path, number, line);
    }
    j->place_count++;
    return CAMBER_EXIT_DONE;
}

/* Takes the tiles given by --tile, and those in the file of --renew. */
static int read_places(job *j) {
    const camber_options *options = j->session->options;
    const char *path = options->renewed;
    char *text = NULL;
    size_t size_bytes = 0, lines = 1;
    int status = CAMBER_EXIT_DONE;
    if (path)
        status = camber_input_read_all(j->session->report, path, &text, &size_bytes);
    for (size_t i = 0; i < size_bytes; i++)
        lines += text[i] == '\n';
    if (status == CAMBER_EXIT_DONE && !(j->places = calloc(lines + options->place_count, sizeof *j->places)))
        status = camber_report_status(j->session->report, CAMBER_ERROR_MEMORY);
    for (size_t i = 0; j->places && i < options->place_count; i++)
        j->places[j->place_count++] = options->places[i];
    char *line = text;
    for (size_t number = 1; status == CAMBER_EXIT_DONE && line && line < text + size_bytes; number++) {
        char *end = memchr(line, '\n', size_bytes - (size_t)(line - text));
        if (end)
            *end = 0;
        status = add_line(j, path, line, number);
        line = end ? end + 1 : NULL;
    }
    free(text);
    return status;
}

/* Sets the name of the archive: the output without its folder, extension and shard. */
static void find_name(job *j) {
    const camber_options *options = j->session->options;
    size_t length = strlen(options->output);
    while (length > 1 && options->output[length - 1] == '/')
        length--;
    size_t first = length;
    while (first > 0 && options->output[first - 1] != '/')
        first--;
    for (size_t i = length; i > first + 1 && length == strlen(options->output); i--)
        if (options->output[i - 1] == '.') {
            length = i - 1;
            break;
        }
    snprintf(j->name, sizeof j->name, "%.*s", (int)(length - first), options->output + first);
}

static int find_output(job *j) {
    camber_session *session = j->session;
    const camber_options *options = session->options;
    char message[512];
    struct stat about;
    int status = camber_shard_find(options, &j->shard, message, sizeof message);
    if (status != CAMBER_EXIT_DONE)
        return camber_report_fail(session->report, status, "%s", message);
    find_name(j);
    const bool fits = j->shard.count
                          ? camber_shard_name(options->output, &j->shard, j->output, sizeof j->output)
                          : snprintf(j->output, sizeof j->output, "%s", options->output) < (int)sizeof j->output;
    if (!fits)
        return camber_report_fail(session->report, CAMBER_EXIT_CREATE, "%s: is too long; choose a shorter name",
                                  options->output);
    if (options->dry_run)
        return CAMBER_EXIT_DONE;
    if (options->renewed && stat(j->output, &about) != 0)
        return camber_report_fail(session->report, CAMBER_EXIT_NO_INPUT,
                                  "%s: no such archive, and --renew needs an existing one; draw it first", j->output);
    j->files = (camber_tiles_files){.session = session, .first = 2}; /* finished units stay for --resume */
    status = options->renewed ? CAMBER_EXIT_DONE : camber_tiles_look_at_output(session, j->output);
    if (status == CAMBER_EXIT_DONE)
        status = camber_tiles_files_name(&j->files, j->output);
    j->is_left =
        status == CAMBER_EXIT_DONE && !options->resume && !options->renewed && stat(j->files.names[0], &about) == 0;
    return status;
}

/* ---- Drawing ---- */

static camber_tiles_engine_desc describe_engine(const job *j) {
    const camber_session *session = j->session;
    const camber_options *options = session->options;
    return (camber_tiles_engine_desc){.renderer = session->renderer,
                                      .device = session->device,
                                      .tile_size = options->tile_size == 1 ? 512 : 256,
                                      .ratio = options->view.ratio,
                                      .simplify_px = options->simplify_px,
                                      .coverage = (camber_coverage)options->coverage,
                                      .threads = options->threads,
                                      .meshes = options->format == CAMBER_FORMAT_GLB};
}

static camber_status read_for_part(void *user, camber_features *features, bool *done) {
    const job *j = user;
    const camber_tiles_engine_desc desc = describe_engine(j);
    const camber_status status =
        camber_tiles_schedule_read_for(j->schedule, features, &desc, j->shard.number, j->shard.count);
    return status == CAMBER_OK ? camber_tiles_schedule_load(j->schedule, features, done) : status;
}

/* Reads the schedule, or checks that it can be written. */
static int open_schedule(job *j) {
    camber_session *session = j->session;
    const camber_options *options = session->options;
    struct stat about;
    if (!options->schedule)
        return CAMBER_EXIT_DONE;
    if (options->dry_run && lstat(options->schedule, &about) == 0 && !options->force)
        return camber_report_fail(session->report, CAMBER_EXIT_CREATE,
                                  "%s: exists; name another file, or replace it with --force", options->schedule);
    if (options->dry_run)
        return CAMBER_EXIT_DONE;
    const camber_status status = camber_tiles_schedule_read(session->context, options->schedule, options->inputs,
                                                            options->input_count, &j->schedule);
    if (status == CAMBER_OK) {
        session->read_for = read_for_part;
        session->read_for_user = j;
    }
    return camber_report_status(session->report, status);
}

static int open_engine(job *j) {
    camber_session *session = j->session;
    const camber_tiles_engine_desc desc = describe_engine(j);
    return camber_report_status(session->report, camber_tiles_engine_create(j->input.features, &desc, &j->engine));
}

/* If a run ends early, reports that its finished tiles are kept. It does not handle the signal itself. A terminal or
 * pipe that accepts no output must not keep the process from ending. */
static bool tell_kept(void *user, int number) {
    const job *j = user;
    struct stat about;
    struct pollfd errors = {.fd = STDERR_FILENO, .events = POLLOUT};
    if (number && (sigismember(&j->session->guard->ignored, number) || poll(&errors, 1, 0) != 1))
        return false;
    if (j->begun && !j->session->options->renewed && stat(j->files.names[0], &about) == 0 && about.st_size > 0)
        camber_report_warn(j->session->report, "%s: --resume%s continues with the finished tiles, which are kept in %s",
                           j->output, j->session->options->force ? " --force" : "", j->files.names[0]);
    return false;
}

static void heed_signals(job *j, bool heeds) {
    camber_guard *guard = j->session->guard;
    camber_guard_lock(guard);
    guard->heed = heeds ? tell_kept : NULL;
    guard->heed_user = j;
    camber_guard_unlock(guard);
}

/* From now on the archive belongs to this run. The remains of an earlier run are removed. */
static void begin(void *user) {
    job *j = user;
    if (j->is_left)
        camber_report_warn(j->session->report,
                           "%s: the finished tiles of an interrupted run are drawn again; --resume would keep them",
                           j->output);
    j->begun = true;
    camber_tiles_files_guard(&j->files);
    heed_signals(j, true);
}

/* Whether points take so much memory that they should be freed as early as possible, although PMTiles must then be
 * copied at the end. */
static bool has_many_points(const job *j) {
    enum { MANY_POINTS = 1 << 23 };
    return camber_features_get_stats(j->input.features).points > MANY_POINTS;
}

static camber_tiles_draw_desc describe(job *j) {
    const camber_options *options = j->session->options;
    const camber_view_desc *view = &options->view;
    return (camber_tiles_draw_desc){.output = j->output,
                                    .min_zoom = options->renewed && !options->has_zooms ? -1 : (int)options->min_zoom,
                                    .max_zoom = (int)options->max_zoom,
                                    .has_bbox = options->has_bbox,
                                    .bbox = {view->west, view->south, view->east, view->north},
                                    .region = j->region,
                                    .tiles = j->place_count ? j->places : NULL,
                                    .tile_count = j->place_count,
                                    .encoding = camber_format_encoding(options->format),
                                    .quality = (int)options->quality,
                                    .keep_empty = options->keep_empty,
                                    .force = options->force,
                                    .resume = options->resume,
                                    .renew = options->renewed != NULL,
                                    .dry_run = options->dry_run,
                                    .shard = j->shard.number,
                                    .shards = j->shard.count,
                                    .name = options->name ? options->name : j->name,
                                    .description = options->description,
                                    .attribution = options->attribution,
                                    .schedule = j->schedule,
                                    .schedule_path = options->dry_run ? options->schedule : NULL,
                                    .inputs = options->inputs,
                                    .input_count = options->input_count,
                                    .label_record = options->label_record,
                                    .spent = has_many_points(j) ? j->input.features : NULL,
                                    .begun = begin,
                                    .user = j};
}

/* West and east have probably been swapped: the result is the world without the intended box. */
static void warn_wide(const job *j) {
    const camber_view_desc *view = &j->session->options->view;
    const double width = view->east + 360.0 - view->west;
    if (j->session->options->has_bbox && view->west > view->east && width > 180.0)
        camber_report_warn(j->session->report,
                           "the box crosses the antimeridian, and is %g degrees wide; --bbox is W,S,E,N", width);
}

static int draw(job *j) {
    camber_session *session = j->session;
    int status = find_output(j);
    if (status == CAMBER_EXIT_DONE)
        status = camber_session_need(session, CAMBER_NEEDS_CONTEXT);
    if (status == CAMBER_EXIT_DONE)
        status = read_places(j);
    if (status == CAMBER_EXIT_DONE && session->options->renewed && j->place_count == 0)
        return CAMBER_EXIT_DONE; /* the list of tiles is empty */
    if (status == CAMBER_EXIT_DONE)
        warn_wide(j);
    if (status != CAMBER_EXIT_DONE)
        return status;
    session->opens_beside = true;
    status = open_schedule(j);
    if (status == CAMBER_EXIT_DONE)
        status = camber_input_open(&j->input, session);
    if (status == CAMBER_EXIT_DONE)
        status = read_region(j);
    j->load_ms = camber_now_ms() - session->start_ms;
    if (status == CAMBER_EXIT_DONE)
        status = camber_session_need(session, session->options->format == CAMBER_FORMAT_GLB ? CAMBER_NEEDS_DEVICE
                                                                                            : CAMBER_NEEDS_RENDERER);
    if (status == CAMBER_EXIT_DONE)
        status = open_engine(j);
    if (status != CAMBER_EXIT_DONE)
        return status;
    camber_guard_go_first(session->guard);
    const camber_tiles_draw_desc desc = describe(j);
    const camber_status drawn = camber_tiles_draw(j->engine, &desc, &j->stats);
    heed_signals(j, false);
    camber_report_erase_bar(session->report);
    if (drawn != CAMBER_OK)
        tell_kept(j, 0);
    camber_tiles_files_release(&j->files);
    return camber_report_status(session->report, drawn);
}

/* ---- The summary ---- */

static double cpu_ms(void) {
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) != 0)
        return 0.0;
    return 1e3 * (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-3 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static int print_json(const job *j) {
    const camber_tiles_stats *stats = &j->stats;
    const camber_options *options = j->session->options;
    json_t *object =
        json_pack("{s:o, s:b, s:b, s:i, s:i}", "output", camber_json_text(j->output), "dry_run", options->dry_run,
                  "done", stats->done, "min_zoom", (int)options->min_zoom, "max_zoom", (int)options->max_zoom);
    if (!object)
        return camber_report_json(j->session->report, NULL);
    const camber_features_stats read = camber_features_get_stats(j->input.features);
    const struct {
        const char *name;
        uint64_t count;
    } counts[] = {{"tiles", stats->tiles},
                  {"background_tiles", stats->background},
                  {"units", stats->units},
                  {"resumed_units", stats->resumed},
                  {"emptied_tiles", stats->emptied},
                  {"left_out_tiles", stats->left_out},
                  {"relabelled_tiles", stats->relabelled},
                  {"points", stats->points},
                  {"points_in", j->input.points_in},
                  {"bytes", stats->bytes},
                  {"shard", j->shard.number},
                  {"shards", j->shard.count},
                  {"missing_nodes", read.missing_nodes},
                  {"missing_ways", read.missing_ways},
                  {"dropped_relations", read.dropped_relations},
                  {"antimeridian_splits", read.antimeridian_splits},
                  {"peak_rss_bytes", camber_peak_rss_bytes()}};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        json_object_set_new(object, counts[i].name, camber_json_count((size_t)counts[i].count));
    const struct {
        const char *name;
        double ms;
    } times[] = {{"load_ms", j->load_ms},
                 {"census_ms", stats->census_ms},
                 {"make_ms", stats->make_ms},
                 {"draw_ms", stats->draw_ms},
                 {"wait_ms", stats->wait_ms},
                 {"write_ms", stats->write_ms},
                 {"encode_ms", stats->encode_ms},
                 {"encode_cpu_ms", stats->encode_cpu_ms},
                 {"cpu_ms", cpu_ms()},
                 {"total_ms", j->total_ms}};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++)
        json_object_set_new(object, times[i].name, camber_json_ms(times[i].ms));
    camber_session_describe(j->session, object);
    return camber_report_json(j->session->report, object);
}

/* Warns if there are no tiles. If there are several shards, one of them may have no tiles, which is not worth a
 * warning. */
static void warn_empty(const job *j) {
    const camber_options *options = j->session->options;
    if (j->stats.done || j->stats.units || j->shard.count || options->renewed)
        return;
    char why[1024];
    (void)camber_features_explain_nothing(j->input.features, options->min_zoom, options->max_zoom, why, sizeof why);
    camber_report_warn(j->session->report, "there are no tiles: %s%s", why,
                       j->place_count      ? " (--tile limits the tiles)"
                       : j->region         ? " (--region limits the tiles)"
                       : options->has_bbox ? " (--bbox is W,S,E,N: longitudes come first)"
                                           : "");
}

/* Warns of tiles in the list of --renew that are outside the archive. */
static void warn_left_out(const job *j) {
    const uint64_t count = j->stats.left_out;
    if (count)
        camber_report_warn(j->session->report,
                           "%s: %llu tile%s of the list %s outside its zooms and bounds, and left out; to include such "
                           "tiles, give --min-zoom, --max-zoom or --bbox",
                           j->output, (unsigned long long)count, camber_plural((size_t)count),
                           count == 1 ? "is" : "are");
}

/* With --verbose. */
static void print_times(const job *j) {
    const camber_tiles_stats *stats = &j->stats;
    camber_report *report = j->session->report;
    camber_report_say(report, "%s metatile%s, %s points", camber_figure_count(stats->units).text,
                      camber_plural((size_t)stats->units), camber_figure_count(stats->points).text);
    camber_report_say(report,
                      "load %.2f s, census %.2f, networks %.2f, draw %.2f, wait %.2f, write %.2f; in all %.2f s; "
                      "encoding took %.2f of %.2f s of all processors",
                      1e-3 * j->load_ms, 1e-3 * stats->census_ms, 1e-3 * stats->make_ms, 1e-3 * stats->draw_ms,
                      1e-3 * stats->wait_ms, 1e-3 * stats->write_ms, 1e-3 * j->total_ms, 1e-3 * stats->encode_cpu_ms,
                      1e-3 * cpu_ms());
    camber_session_say_memory(j->session);
}

static void print_counts(const job *j) {
    const camber_tiles_stats *stats = &j->stats;
    camber_report *report = j->session->report;
    camber_input_say_missing(&j->input);
    camber_input_say_split(&j->input);
    if (stats->emptied)
        camber_report_say(report, "%s tile%s removed, because nothing is there now",
                          camber_figure_count(stats->emptied).text, camber_plural((size_t)stats->emptied));
    if (stats->relabelled)
        camber_report_say(report, "%s tile%s of these not listed, but with other labels than before",
                          camber_figure_count(stats->relabelled).text, camber_plural((size_t)stats->relabelled));
    if (stats->resumed)
        camber_report_say(report, "%s metatile%s had been drawn before", camber_figure_count(stats->resumed).text,
                          camber_plural((size_t)stats->resumed));
    if (report->verbose)
        print_times(j);
}

/* An estimate has two digits. */
static uint64_t round_bytes(uint64_t bytes) {
    uint64_t step = 1;
    while (bytes / step >= 100)
        step *= 10;
    return (bytes + step / 2) / step * step;
}

static void print_text(const job *j) {
    const camber_tiles_stats *stats = &j->stats;
    const camber_options *options = j->session->options;
    camber_report *report = j->session->report;
    char what[96] = "";
    if (stats->done) {
        camber_report_done(report, j->output, 0, j->total_ms, "is complete; nothing to %s",
                           options->renewed ? "renew" : "do");
        return;
    }
    print_counts(j);
    if (options->dry_run) {
        char size[96] = "";
        if (!options->schedule) /* a dry run for a schedule draws no samples */
            snprintf(size, sizeof size, ", about %s", camber_figure_bytes(round_bytes(stats->bytes)).text);
        camber_report_done(report, j->output, 0, j->total_ms,
                           "would have at most %s tile%s in %s metatile%s, %s points%s; dry run",
                           camber_figure_count(stats->tiles).text, camber_plural((size_t)stats->tiles),
                           camber_figure_count(stats->units).text, camber_plural((size_t)stats->units),
                           camber_figure_count(stats->points).text, size);
        return;
    }
    if (options->renewed || stats->resumed)
        snprintf(what, sizeof what, "%s tile%s drawn, now ", camber_figure_count(stats->tiles).text,
                 camber_plural((size_t)stats->tiles));
    camber_tiles_say_done(j->session, j->output, what, stats->tiles, stats->bytes);
}

int camber_verb_tiles_draw(camber_session *session) {
    job *j = calloc(1, sizeof *j);
    if (!j)
        return camber_report_status(session->report, CAMBER_ERROR_MEMORY);
    j->session = session;
    int status = draw(j);
    j->total_ms = camber_now_ms() - session->start_ms;
    if (status == CAMBER_EXIT_DONE)
        warn_empty(j);
    if (status == CAMBER_EXIT_DONE)
        warn_left_out(j);
    if (status == CAMBER_EXIT_DONE && session->options->json)
        status = print_json(j);
    else if (status == CAMBER_EXIT_DONE)
        print_text(j);
    camber_tiles_engine_destroy(j->engine);
    camber_tiles_schedule_destroy(j->schedule);
    camber_features_destroy(j->region);
    camber_style_destroy(j->region_style);
    camber_input_close(&j->input);
    free(j->places);
    free(j);
    return status;
}

#endif
