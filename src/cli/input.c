/* The input of a verb: a map (files, a style, a view of them) or a file of polylines in pixels. Opening reads it.
 * Projecting makes the polylines, strokes and rows that the kernels read. The functions at the end return either kind
 * in the same form. Standard input is copied to a temporary file first, because OGR seeks. */
#include "cli/input.h"

#include "base/open_file.h"
#include "base/whole_file.h"
#include "cli/plain.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH_PX 2.0 /* the width of --polylines without --width-px */

/* ---- Polylines in pixels ---- */

/* Returns NULL with errno on failure; errno is 0 for a device or a pipe, which may be endless. A folder can be opened,
 * but reading it fails. */
static FILE *open_regular(const char *path) {
    struct stat about;
    const int opened = camber_open_file(path, &about);
    if (opened < 0)
        return NULL;
    if (S_ISREG(about.st_mode) || S_ISDIR(about.st_mode))
        return fdopen(opened, "rb");
    close(opened);
    errno = 0;
    return NULL;
}

int camber_input_read_all(camber_report *report, const char *path, char **bytes, size_t *size_bytes) {
    const bool standard = strcmp(path, "-") == 0;
    FILE *file = standard ? stdin : open_regular(path);
    if (!file && errno == 0)
        return camber_report_fail(report, CAMBER_EXIT_DATA,
                                  "%s: is a device or a pipe; copy its data to a file, or name - for standard input",
                                  path);
    if (!file)
        return camber_report_fail(report, errno == ENOENT || errno == ENOTDIR ? CAMBER_EXIT_NO_INPUT : CAMBER_EXIT_IO,
                                  "%s: %s; %s", path, strerror(errno), camber_file_cure(errno, "check the name"));
    char *block = NULL;
    size_t size = 0, capacity = 0, read = 0;
    bool held = true;
    do {
        if (size == capacity) {
            char *grown = capacity < SIZE_MAX / 4 ? realloc(block, capacity = capacity ? capacity * 2 : 65536) : NULL;
            held = grown != NULL;
            block = held ? grown : block;
        }
        read = held ? fread(block + size, 1, capacity - size, file) : 0;
        size += read;
    } while (read > 0);
    const int cause = ferror(file) ? errno : 0;
    if (!standard)
        fclose(file);
    if (held && !cause) {
        *bytes = block;
        *size_bytes = size;
        return CAMBER_EXIT_DONE;
    }
    free(block);
    if (!held)
        return camber_report_fail(report, CAMBER_EXIT_INTERNAL, "%s: too large for the memory; give it a smaller file",
                                  path);
    if (standard)
        return camber_report_input(report, cause);
    if (cause == EISDIR)
        return camber_report_fail(report, CAMBER_EXIT_DATA, "%s: is a folder; name a file", path);
    return camber_report_fail(report, CAMBER_EXIT_IO, "%s: %s; copy it elsewhere and try again", path, strerror(cause));
}

static int open_polylines(camber_input *input) {
    camber_session *session = input->session;
    const char *path = session->options->polylines;
    char *bytes = NULL;
    size_t size_bytes = 0;
    const int status = camber_input_read_all(session->report, path, &bytes, &size_bytes);
    if (status != CAMBER_EXIT_DONE)
        return status;
    const camber_status parsed = camber_lines_parse(session->context, bytes, size_bytes,
                                                    strcmp(path, "-") == 0 ? "standard input" : path, &input->lines);
    free(bytes);
    if (parsed != CAMBER_OK)
        return camber_report_status(session->report, parsed);
    input->points_in = input->lines.point_count;
    for (size_t i = 0; i < input->lines.polyline_count; i++) {
        const uint32_t count = input->lines.offsets[i + 1] - input->lines.offsets[i];
        input->segments_in += count > 1 ? count - 1 : 0;
    }
    const double width_px = session->options->width_px > 0 ? session->options->width_px : WIDTH_PX;
    input->stroke = (camber_stroke){(float)width_px, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    input->paint = (camber_paint){.width_px = (float)width_px, .color = {0, 0, 0, 1}};
    return CAMBER_EXIT_DONE;
}

static camber_status project_polylines(camber_input *input) {
    camber_context *context = input->session->context;
    const double simplify_px = input->session->options->simplify_px;
    camber_polylines_destroy(input->polylines);
    camber_lines_destroy(&input->simplified);
    input->polylines = NULL;
    if (simplify_px > 0) {
        const camber_status status = camber_lines_simplify(context, &input->lines, simplify_px, &input->simplified);
        if (status != CAMBER_OK)
            return status;
    }
    const camber_lines *lines = camber_input_lines(input);
    const camber_polylines_desc desc = {.points = lines->points,
                                        .point_count = lines->point_count,
                                        .offsets = lines->offsets,
                                        .polyline_count = lines->polyline_count,
                                        .keep_open = true};
    return camber_polylines_create(context, &desc, &input->polylines);
}

static camber_frame polylines_frame(camber_input *input, camber_mesh *mesh) {
    const camber_view_desc *view = &input->session->options->view;
    input->pass = (camber_pass){.mesh = mesh, .paints = &input->paint, .paint_count = 1};
    return (camber_frame){.width = (uint32_t)(view->width * view->ratio + 0.5),
                          .height = (uint32_t)(view->height * view->ratio + 0.5),
                          .background = {1, 1, 1, 1},
                          .passes = &input->pass,
                          .pass_count = 1};
}

/* ---- Maps ---- */

#ifdef CAMBER_MAP
bool camber_input_ships(const char *name) {
    size_t size_bytes;
    return camber_style_get_text(name, CAMBER_THEME_LIGHT, &size_bytes) && access(name, F_OK) != 0;
}

static int fail_name(camber_session *session, const char *name) {
    char names[128] = "";
    const char *next;
    for (size_t i = 0; (next = camber_style_list(i)) != NULL; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i ? ", " : "", next);
    return camber_report_fail(session->report, CAMBER_EXIT_NO_INPUT,
                              "%s: neither a file nor a built-in style; name a style document, or one of: %s%s", name,
                              names, strcmp(name, "dark") == 0 ? "; --theme dark makes it dark" : "");
}

int camber_input_read_style(camber_session *session, const char *path, camber_theme theme, camber_style_input *style) {
    *style = (camber_style_input){.name = path};
    if (camber_input_ships(path)) {
        style->text = camber_style_get_text(path, theme, &style->size_bytes);
        return CAMBER_EXIT_DONE;
    }
    if (strcmp(path, "-") != 0 && !strchr(path, '/') && access(path, F_OK) != 0)
        return fail_name(session, path);
    const int status = camber_input_read_all(session->report, path, &style->bytes, &style->size_bytes);
    style->text = style->bytes;
    style->base_path = path;
    if (strcmp(path, "-") == 0) {
        style->name = "standard input";
        style->base_path = NULL;
    }
    return status;
}

static int translate(camber_session *session, camber_style_input *document, char **translated) {
    const camber_status status = camber_style_translate(session->context, document->text, document->size_bytes,
                                                        document->name, session->options->language, translated);
    if (status == CAMBER_OK) {
        document->text = *translated;
        document->size_bytes = strlen(*translated);
    }
    return camber_report_status(session->report, status);
}

/* The built-in style, or what it draws of extracts of OpenStreetMap if there is nothing else. */
static const char *builtin_text(const camber_options *options, camber_theme theme, size_t *size_bytes) {
    bool is_osm = options->input_count > 0;
    for (size_t i = 0; is_osm && i < options->input_count; i++) {
        const camber_source_desc desc = {.path = options->inputs[i], .layer = options->layer, .where = options->where};
        is_osm = camber_source_is_osm(&desc);
    }
    return camber_style_get_text(is_osm ? "city-osm" : camber_style_list(0), theme, size_bytes);
}

int camber_input_make_style(camber_session *session, camber_theme theme, camber_style **style, const char **base_path) {
    const camber_options *options = session->options;
    camber_style_input document = {.name = "the built-in style"};
    char *translated = NULL;
    int status = CAMBER_EXIT_DONE;
    if (options->style)
        status = camber_input_read_style(session, options->style, theme, &document);
    else
        document.text = builtin_text(options, theme, &document.size_bytes);
    if (status == CAMBER_EXIT_DONE && camber_plain_is_given(options))
        status = camber_plain_apply(session, &document);
    if (status == CAMBER_EXIT_DONE && options->language)
        status = translate(session, &document, &translated);
    if (status == CAMBER_EXIT_DONE) {
        *base_path = document.base_path;
        status = camber_report_status(session->report, camber_style_parse(session->context, document.text,
                                                                          document.size_bytes, document.name, style));
    }
    camber_style_free_text(session->context, translated);
    free(document.bytes);
    return status;
}

static int open_style(camber_input *input) {
    const int theme = input->session->options->theme;
    return camber_input_make_style(input->session, theme < 0 ? CAMBER_THEME_LIGHT : (camber_theme)theme, &input->style,
                                   &input->base_path);
}

/* Takes the parts of the view that the options do not set from the style. */
static void take_view(camber_input *input) {
    const camber_options *options = input->session->options;
    const camber_view_desc own = camber_style_get_view(input->style);
    camber_view_desc *view = &input->view;
    if (isnan(options->bearing_deg))
        view->bearing_deg = own.bearing_deg;
    if (isnan(options->pitch_deg) && (options->verb == CAMBER_VERB_RENDER || options->verb == CAMBER_VERB_BENCH))
        view->pitch_deg = own.pitch_deg;
    if (options->has_bbox || options->verb == CAMBER_VERB_SERVE)
        return;
    view->kind = CAMBER_VIEW_CENTER;
    if (isnan(options->zoom))
        view->zoom = own.zoom;
    if (!options->has_center) {
        view->longitude = own.longitude;
        view->latitude = own.latitude;
    }
}

/* Opens the device while files are read. If the view is fitted to the data, the zoom is not known yet, so the kernels
 * that it will need are unknown, too. */
static void start_opening(const camber_input *input) {
    const camber_view_desc *view = &input->view;
    const double zoom = view->kind == CAMBER_VIEW_CENTER ? view->zoom : NAN;
    const camber_outlook outlook = camber_style_get_effects(input->style, zoom) == 0 ? CAMBER_OUTLOOK_PLAIN
                                   : view->kind == CAMBER_VIEW_CENTER                ? CAMBER_OUTLOOK_RICH
                                                                                     : CAMBER_OUTLOOK_OPEN;
    camber_session_start(input->session, outlook, view->pitch_deg);
}

static int read_sources(camber_input *input) {
    return camber_report_status(input->session->report,
                                camber_features_read_sources(input->features, &input->view, input->base_path));
}

static int read_file(camber_input *input, const char *path) {
    camber_session *session = input->session;
    camber_spool copy = {0};
    if (strcmp(path, "-") == 0) {
        const int status = camber_spool_input(session->report, session->guard, &copy);
        if (status != CAMBER_EXIT_DONE)
            return status;
    }
    const camber_source_desc desc = {.path = copy.path ? copy.path : path,
                                     .layer = session->options->layer,
                                     .where = session->options->where,
                                     .threads = session->options->threads};
    session->report->spool = copy.path;
    camber_watch_begin(&session->watch, desc.path);
    const camber_status status = camber_features_read(input->features, &desc);
    camber_watch_end(&session->watch);
    session->report->spool = NULL;
    camber_spool_remove(session->guard, &copy);
    return camber_report_status(session->report, status);
}

/* Verbs that draw one picture read only what it needs. */
static int read_for_view(const camber_input *input, bool *done) {
    const camber_options *options = input->session->options;
    if (input->session->read_for)
        return camber_report_status(input->session->report,
                                    input->session->read_for(input->session->read_for_user, input->features, done));
    const bool one = options->verb == CAMBER_VERB_RENDER || options->verb == CAMBER_VERB_TESSELLATE;
    if (!one || options->input_count == 0)
        return CAMBER_EXIT_DONE;
    const camber_scene_desc desc = {.view = input->view, .simplify_px = options->simplify_px};
    return camber_report_status(input->session->report, camber_features_read_for(input->features, &desc));
}

/* Labels are drawn in pictures and in tiles that are pictures. */
static int read_fonts(const camber_input *input) {
    const camber_options *options = input->session->options;
    const bool pictures = options->verb == CAMBER_VERB_RENDER || options->verb == CAMBER_VERB_SERVE ||
                          (options->verb == CAMBER_VERB_TILES && options->format != CAMBER_FORMAT_GLB);
    if (!pictures || options->no_labels)
        return CAMBER_EXIT_DONE;
    const camber_fonts_desc desc = {.folders = options->fonts, .folder_count = options->font_count};
    return camber_report_status(input->session->report,
                                camber_features_read_fonts(input->features, &desc, input->base_path));
}

/* With --verbose: says how long the steps of reading took. */
static void say_times(const camber_input *input) {
    const camber_features_times times = camber_features_get_times(input->features);
    if (input->session->report->verbose)
        camber_report_say(input->session->report,
                          "reading: files %.1f ms, joining lines %.1f, importance of points %.1f", times.file_ms,
                          times.merge_ms, times.weigh_ms);
}

/* Makes the sheet that the options ask for, and the view that fits into it. */
static int open_page(camber_input *input) {
    const camber_options *options = input->session->options;
    if (!(options->paper_width_mm > 0.0))
        return CAMBER_EXIT_DONE;
    const camber_fonts_desc fonts = {.folders = options->fonts, .folder_count = options->font_count};
    const camber_page_desc desc = {.width_mm = options->paper_width_mm,
                                   .height_mm = options->paper_height_mm,
                                   .margin_mm = options->margin_mm,
                                   .dpi = options->dpi,
                                   .ratio = options->view.ratio,
                                   .title = options->title,
                                   .subtitle = options->subtitle,
                                   .scale_bar = options->scale_bar,
                                   .north_arrow = options->north_arrow,
                                   .grid = options->grid,
                                   .fonts = &fonts};
    const camber_status status = camber_page_create(input->session->context, &desc, &input->page);
    if (status == CAMBER_OK)
        camber_page_set_view(input->page, &input->view);
    return camber_report_status(input->session->report, status);
}

static int open_map(camber_input *input) {
    camber_session *session = input->session;
    const double start_ms = camber_now_ms();
    bool done = false;
    int status = open_page(input);
    if (status == CAMBER_EXIT_DONE)
        status = open_style(input);
    if (status == CAMBER_EXIT_DONE && session->options->input_count == 0)
        take_view(input);
    if (status == CAMBER_EXIT_DONE && session->opens_beside)
        start_opening(input);
    if (status == CAMBER_EXIT_DONE)
        status = camber_report_status(session->report,
                                      camber_features_create(session->context, input->style, &input->features));
    if (status == CAMBER_EXIT_DONE)
        status = read_fonts(input);
    if (status == CAMBER_EXIT_DONE)
        status = read_for_view(input, &done);
    for (size_t i = 0; !done && i < session->options->input_count && status == CAMBER_EXIT_DONE; i++)
        status = read_file(input, session->options->inputs[i]);
    if (status == CAMBER_EXIT_DONE && session->options->input_count == 0)
        status = read_sources(input);
    if (status == CAMBER_EXIT_DONE)
        status = camber_report_status(
            session->report, camber_features_read_sprites(input->features, input->view.ratio, input->base_path));
    if (status != CAMBER_EXIT_DONE)
        return status;
    const char *asked = session->options->attribution;
    input->attribution = asked ? (*asked ? asked : NULL) : camber_features_get_attribution(input->features);
    if (input->page && camber_page_set_credit(input->page, input->attribution) != CAMBER_OK)
        return CAMBER_EXIT_INTERNAL;
    const camber_features_stats stats = camber_features_get_stats(input->features);
    input->points_in = stats.points;
    input->segments_in = stats.points > stats.polylines ? stats.points - stats.polylines : 0;
    input->read_ms = camber_now_ms() - start_ms;
    say_times(input);
    return CAMBER_EXIT_DONE;
}

static bool has_areas(camber_scene *scene) {
    const camber_frame frame = camber_scene_get_frame(scene, NULL);
    for (size_t i = 0; i < frame.pass_count; i++)
        for (size_t k = 0; k < frame.passes[i].paint_count; k++)
            if (frame.passes[i].paints[k].fill)
                return true;
    return false;
}

static camber_status project_new(camber_input *input, const camber_scene_desc *desc) {
    const camber_status status = camber_scene_create(input->features, desc, &input->scene);
    return status == CAMBER_OK ? camber_scene_project(input->scene) : status;
}

/* Lines are checked without areas, and areas are checked with everything that is drawn. */
static camber_status project_validated(camber_input *input, camber_scene_desc desc) {
    const camber_status status = project_new(input, &desc);
    if (status != CAMBER_OK || !has_areas(input->scene))
        return status;
    input->filled = input->scene;
    input->scene = NULL;
    desc.use = CAMBER_SCENE_LINES;
    return project_new(input, &desc);
}

/* Only one picture of the network is drawn. If its lines are to be counted, they are made on the host, too, and then
 * freed. A page of vectors is drawn from the features, which therefore keep their points. */
static camber_status project_once(camber_input *input, const camber_scene_desc *desc) {
    const camber_options *options = input->session->options;
    const bool is_vector = camber_format_is_vector(options->format);
    camber_scene_desc once = *desc;
    once.use = CAMBER_SCENE_ONE_VIEW;
    camber_status status = is_vector ? camber_scene_create(input->features, &once, &input->scene)
                                     : camber_scene_create_last(input->features, &once, &input->scene);
    if (status != CAMBER_OK || !(is_vector || options->verbose || options->json))
        return status;
    status = camber_scene_project(input->scene);
    if (status == CAMBER_OK)
        input->drawn = camber_polylines_get_stats(camber_scene_get_polylines(input->scene));
    camber_scene_release_lines(input->scene);
    return status;
}

/* With --verbose: says how many points the scene keeps in memory for its own view and others. */
static void say_network(const camber_input *input) {
    camber_camera camera;
    camber_tessellation_desc desc;
    const camber_polylines_stats stats =
        camber_network_get_stats(camber_scene_get_network(input->scene, &camera, &desc));
    if (input->session->report->verbose)
        camber_report_say(input->session->report, "network: %s polyline%s, %s of %s points",
                          camber_figure_count(stats.polylines).text, camber_plural(stats.polylines),
                          camber_figure_count(stats.kept_points).text, camber_figure_count(stats.points).text);
}

static camber_status make_scene(camber_input *input) {
    const camber_verb verb = input->session->options->verb;
    const camber_scene_desc desc = {.view = input->view,
                                    .simplify_px = input->session->options->simplify_px,
                                    .use = verb == CAMBER_VERB_TESSELLATE ? CAMBER_SCENE_LINES : CAMBER_SCENE_VIEWS};
    if (verb == CAMBER_VERB_VALIDATE)
        return project_validated(input, desc);
    return verb == CAMBER_VERB_RENDER ? project_once(input, &desc) : project_new(input, &desc);
}

static camber_status project_map(camber_input *input) {
    if (input->scene)
        return camber_scene_move(input->scene, &input->view);
    const camber_status status = make_scene(input);
    if (status == CAMBER_OK)
        say_network(input);
    return status;
}
#endif

/* ---- Both ---- */

int camber_input_open(camber_input *input, camber_session *session) {
    *input = (camber_input){.session = session, .view = session->options->view};
#ifdef CAMBER_MAP
    if (!session->options->polylines)
        return open_map(input);
#endif
    return open_polylines(input);
}

void camber_input_close(camber_input *input) {
    if (!input->session)
        return;
#ifdef CAMBER_MAP
    camber_scene_destroy(input->scene);
    camber_scene_destroy(input->filled);
    camber_page_destroy(input->page);
    camber_features_destroy(input->features);
    camber_style_destroy(input->style);
#endif
    camber_polylines_destroy(input->polylines);
    camber_lines_destroy(&input->simplified);
    camber_lines_destroy(&input->lines);
    *input = (camber_input){0};
}

int camber_input_project(camber_input *input) {
    const double start_ms = camber_now_ms();
    camber_status status;
#ifdef CAMBER_MAP
    if (input->features)
        status = project_map(input);
    else
#endif
        status = project_polylines(input);
    input->scene_ms = camber_now_ms() - start_ms;
    return camber_report_status(input->session->report, status);
}

/* Whether the library has already reported why nothing is drawn: no feature passed the filter, or the style draws
 * none. */
static bool knows_why_empty(const camber_input *input) {
#ifdef CAMBER_MAP
    if (!input->features)
        return false;
    const size_t features = camber_features_get_stats(input->features).features;
    return features ? camber_scene_get_info(input->scene).undrawn == features : input->session->options->where != NULL;
#else
    (void)input;
    return false;
#endif
}

/* If the view is placed by options and contains nothing at all, its coordinates may have been swapped. */
static const char *likely_cause(const camber_input *input) {
#ifdef CAMBER_MAP
    const camber_view_kind placed = input->session->options->view.kind;
    if (input->features && camber_features_get_stats(input->features).features == 0)
        return placed == CAMBER_VIEW_CENTER ? " (--center is LON,LAT: the longitude comes first)"
               : placed == CAMBER_VIEW_BBOX ? " (--bbox is W,S,E,N: longitudes come first)"
                                            : "";
#else
    (void)input;
#endif
    return "";
}

void camber_input_warn_empty(const camber_input *input, const char *consequence) {
    if (input->drawn.polylines > 0 || knows_why_empty(input))
        return;
    const camber_polylines *polylines = camber_input_polylines(input);
    if (polylines && camber_polylines_get_stats(polylines).polylines > 0)
        return;
    char why[1024] = "no polylines";
#ifdef CAMBER_MAP
    const camber_scene_info scene = input->scene ? camber_scene_get_info(input->scene) : (camber_scene_info){0};
    const double zoom = scene.zoom;
    if (scene.labels > 0)
        return;
    if (input->features)
        (void)camber_features_explain_nothing(input->features, zoom, zoom, why, sizeof why);
#endif
    camber_report_warn(input->session->report, "%s: %s%s", consequence, why, likely_cause(input));
}

#ifdef CAMBER_MAP
void camber_input_say_missing(const camber_input *input) {
    const camber_features_stats read = camber_features_get_stats(input->features);
    char ways[96] = "";
    if (read.missing_ways > 0)
        snprintf(ways, sizeof ways, "%s%s way%s of multipolygons", read.missing_nodes > 0 ? ", " : "",
                 camber_figure_count(read.missing_ways).text, camber_plural(read.missing_ways));
    if (read.missing_nodes > 0)
        camber_report_say(input->session->report, "missing: %s node%s of ways%s",
                          camber_figure_count(read.missing_nodes).text, camber_plural(read.missing_nodes), ways);
    else if (ways[0])
        camber_report_say(input->session->report, "missing: %s", ways);
}

void camber_input_say_split(const camber_input *input) {
    const size_t splits = camber_features_get_stats(input->features).antimeridian_splits;
    if (splits > 0)
        camber_report_say(input->session->report,
                          "antimeridian: crossed %s time%s; segments of more than 180 degrees are drawn the short way "
                          "round the Earth",
                          camber_figure_count(splits).text, camber_plural(splits));
}
#endif

const camber_polylines *camber_input_polylines(const camber_input *input) {
#ifdef CAMBER_MAP
    if (input->scene)
        return camber_scene_project(input->scene) == CAMBER_OK ? camber_scene_get_polylines(input->scene) : NULL;
#endif
    return input->polylines;
}

const camber_lines *camber_input_lines(const camber_input *input) {
#ifdef CAMBER_MAP
    if (input->scene)
        return camber_scene_project(input->scene) == CAMBER_OK ? camber_scene_get_lines(input->scene) : NULL;
#endif
    return input->session->options->simplify_px > 0 ? &input->simplified : &input->lines;
}

const uint32_t *camber_input_rows(const camber_input *input) {
#ifdef CAMBER_MAP
    if (input->scene)
        return camber_scene_project(input->scene) == CAMBER_OK ? camber_scene_get_rows(input->scene) : NULL;
#endif
    (void)input;
    return NULL;
}

const camber_stroke *camber_input_strokes(const camber_input *input, size_t *count) {
#ifdef CAMBER_MAP
    if (input->scene)
        return camber_scene_get_strokes(input->scene, count);
#endif
    *count = 1;
    return &input->stroke;
}

camber_network *camber_input_network(const camber_input *input, camber_camera *camera, camber_tessellation_desc *desc) {
#ifdef CAMBER_MAP
    if (input->scene)
        return camber_scene_get_network(input->scene, camera, desc);
#endif
    (void)input;
    (void)camera;
    (void)desc;
    return NULL;
}

camber_frame camber_input_frame(camber_input *input, camber_mesh *mesh) {
    camber_frame frame;
#ifdef CAMBER_MAP
    if (input->scene)
        frame = camber_scene_get_frame(input->scene, mesh);
    else
#endif
        frame = polylines_frame(input, mesh);
    frame.coverage = (camber_coverage)input->session->options->coverage;
    return frame;
}

bool camber_input_opaque(const camber_input *input) {
#ifdef CAMBER_MAP
    if (input->scene)
        return camber_scene_get_info(input->scene).opaque;
#endif
    return input->polylines != NULL; /* polylines are drawn on white */
}

camber_status camber_input_tessellate(const camber_input *input, camber_mesh *mesh) {
    camber_tessellation_desc desc = {.method = camber_session_method(input->session)};
    camber_guard_go_first(input->session->guard);
#ifdef CAMBER_MAP
    /* Verbs that draw project on the device. Verbs that check results need the polylines to compare with. */
    const camber_verb verb = input->session->options->verb;
    if (input->scene && (verb == CAMBER_VERB_RENDER || verb == CAMBER_VERB_BENCH))
        return camber_scene_tessellate(input->scene, mesh, desc.method);
#endif
    desc.strokes = camber_input_strokes(input, &desc.stroke_count);
    return camber_mesh_tessellate(mesh, camber_input_polylines(input), &desc);
}
