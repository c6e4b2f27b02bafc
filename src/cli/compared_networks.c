/* Reads the files of compare into networks, and projects one network at a time. Polylines in pixels are one network; a
 * map is one network for each --where. The view is fitted to all networks together. */
#include "cli/compared_networks.h"

#include <stdlib.h>
#include <string.h>

/* Wide enough for joins to have a shape: the width of a main road on a street map. At 2 px an arc would be smaller than
 * a pixel. */
#define WIDTH_PX 8.0

/* ---- Polylines in pixels ---- */

static int open_polylines(camber_compared_networks *networks) {
    camber_session *session = networks->session;
    camber_input *input = &networks->input;
    int status = camber_input_open(input, session);
    if (status != CAMBER_EXIT_DONE)
        return status;
    input->stroke.width_px = (float)networks->width_px;
    const double simplify_px = session->options->simplify_px;
    const camber_lines *lines = simplify_px > 0 ? &networks->simplified : &input->lines;
    camber_status made = CAMBER_OK;
    if (simplify_px > 0)
        made = camber_lines_simplify(session->context, &input->lines, simplify_px, &networks->simplified);
    const camber_polylines_desc desc = {.points = lines->points,
                                        .point_count = lines->point_count,
                                        .offsets = lines->offsets,
                                        .polyline_count = lines->polyline_count,
                                        .keep_open = true};
    if (made == CAMBER_OK)
        made = camber_polylines_create(session->context, &desc, &networks->polylines);
    networks->count = 1;
    return camber_report_status(session->report, made);
}

static camber_compared_network polylines_network(const camber_compared_networks *networks) {
    const camber_session *session = networks->session;
    return (camber_compared_network){.name = session->options->polylines,
                                     .polylines = networks->polylines,
                                     .lines = session->options->simplify_px > 0 ? &networks->simplified
                                                                                : &networks->input.lines,
                                     .strokes = &networks->input.stroke,
                                     .stroke_count = 1,
                                     .keep_open = true};
}

/* ---- Maps ---- */

#ifdef CAMBER_MAP
/* All lines have the same style, because the methods are compared on the network's geometry, not on a map's design. */
static camber_status open_style(camber_compared_networks *networks) {
    static const char format[] =
        "{\"version\": 8, \"sources\": {}, \"layers\": [{\"id\": \"network\", \"type\": \"line\", \"source\": \"s\","
        " \"layout\": {\"line-join\": \"round\", \"line-cap\": \"butt\"},"
        " \"paint\": {\"line-width\": %.17g, \"line-color\": \"#000\"}}]}";
    char json[sizeof format + 32];
    const int size = snprintf(json, sizeof json, format, networks->width_px / networks->view.ratio);
    return camber_style_parse(networks->session->context, json, (size_t)size, "the networks' style", &networks->style);
}

/* Reads every input with the same filter. */
static camber_status read_features(camber_compared_networks *networks, const char *where, camber_features **features) {
    const camber_options *options = networks->session->options;
    camber_status status = camber_features_create(networks->session->context, networks->style, features);
    for (size_t i = 0; i < options->input_count && status == CAMBER_OK; i++) {
        const bool standard = strcmp(options->inputs[i], "-") == 0;
        const camber_source_desc desc = {.path = standard ? networks->copy.path : options->inputs[i],
                                         .layer = options->layer,
                                         .where = where,
                                         .threads = options->threads};
        networks->session->report->spool = networks->copy.path;
        status = camber_features_read(*features, &desc);
        networks->session->report->spool = NULL;
    }
    return status;
}

/* "(first) OR (second) OR ...", freed with free. NULL: out of memory. */
static char *any_of(const char *const *wheres, size_t count) {
    size_t size = 1;
    for (size_t i = 0; i < count; i++)
        size += strlen(wheres[i]) + sizeof "() OR ";
    char *text = malloc(size);
    size_t used = 0;
    for (size_t i = 0; i < count && text; i++)
        used += (size_t)snprintf(text + used, size - used, "%s(%s)", i ? " OR " : "", wheres[i]);
    return text;
}

/* Finds the view that shows all networks together. A single network may cover only a part of it. */
static camber_status fit_view(camber_compared_networks *networks) {
    const camber_options *options = networks->session->options;
    if (networks->count < 2 || networks->view.kind != CAMBER_VIEW_FIT)
        return CAMBER_OK;
    const camber_scene_desc desc = {.view = networks->view};
    camber_features *features = NULL;
    char *where = any_of(options->wheres, options->where_count);
    camber_status status = where ? read_features(networks, where, &features) : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        status = camber_scene_create(features, &desc, &networks->scene);
    if (status == CAMBER_OK) {
        const camber_scene_info info = camber_scene_get_info(networks->scene);
        networks->view.kind = CAMBER_VIEW_CENTER;
        networks->view.longitude = info.longitude;
        networks->view.latitude = info.latitude;
        networks->view.zoom = info.zoom;
    }
    camber_scene_destroy(networks->scene);
    networks->scene = NULL;
    camber_features_destroy(features);
    free(where);
    return status;
}

static bool reads_standard_input(const camber_options *options) {
    bool reads = false;
    for (size_t i = 0; i < options->input_count; i++)
        reads = reads || strcmp(options->inputs[i], "-") == 0;
    return reads;
}

static int open_maps(camber_compared_networks *networks) {
    camber_session *session = networks->session;
    const camber_options *options = session->options;
    const size_t count = options->where_count ? options->where_count : 1;
    if (reads_standard_input(options)) {
        const int spooled = camber_spool_input(session->report, session->guard, &networks->copy);
        if (spooled != CAMBER_EXIT_DONE)
            return spooled;
    }
    networks->view = options->view;
    camber_features **features = calloc(count, sizeof *features);
    if (!features)
        return camber_report_status(session->report, CAMBER_ERROR_MEMORY);
    networks->features = features;
    networks->count = count;
    camber_status status = open_style(networks);
    for (size_t i = 0; i < count && status == CAMBER_OK; i++)
        status = read_features(networks, options->wheres[i], &features[i]);
    if (status == CAMBER_OK)
        status = fit_view(networks);
    return camber_report_status(session->report, status);
}

static camber_status project_map(camber_compared_networks *networks, size_t i, camber_compared_network *network) {
    const camber_options *options = networks->session->options;
    const camber_scene_desc desc = {.view = networks->view, .simplify_px = options->simplify_px};
    camber_scene_destroy(networks->scene);
    networks->scene = NULL;
    camber_status status = camber_scene_create(networks->features[i], &desc, &networks->scene);
    if (status == CAMBER_OK)
        status = camber_scene_project(networks->scene);
    if (status != CAMBER_OK)
        return status;
    *network = (camber_compared_network){.name = options->where_count ? options->wheres[i] : options->inputs[0],
                                         .polylines = camber_scene_get_polylines(networks->scene),
                                         .lines = camber_scene_get_lines(networks->scene),
                                         .rows = camber_scene_get_rows(networks->scene)};
    networks->info = camber_scene_get_info(networks->scene);
    network->strokes = camber_scene_get_strokes(networks->scene, &network->stroke_count);
    return CAMBER_OK;
}
#endif

/* ---- Both ---- */

int camber_compared_networks_open(camber_compared_networks *networks, camber_session *session) {
    const camber_options *options = session->options;
    *networks = (camber_compared_networks){.session = session,
                                           .width = (uint32_t)(options->view.width * options->view.ratio + 0.5),
                                           .height = (uint32_t)(options->view.height * options->view.ratio + 0.5),
                                           .width_px = options->width_px > 0 ? options->width_px : WIDTH_PX};
    const int status = camber_session_need(session, CAMBER_NEEDS_CONTEXT);
    if (status != CAMBER_EXIT_DONE)
        return status;
#ifdef CAMBER_MAP
    if (!options->polylines)
        return open_maps(networks);
#endif
    return open_polylines(networks);
}

int camber_compared_networks_project(camber_compared_networks *networks, size_t i, camber_compared_network *network) {
#ifdef CAMBER_MAP
    if (networks->features)
        return camber_report_status(networks->session->report, project_map(networks, i, network));
#endif
    (void)i;
    *network = polylines_network(networks);
    return CAMBER_EXIT_DONE;
}

void camber_compared_networks_close(camber_compared_networks *networks) {
    camber_session *session = networks->session;
    if (!session)
        return;
#ifdef CAMBER_MAP
    camber_scene_destroy(networks->scene);
    for (size_t i = 0; i < networks->count && networks->features; i++)
        camber_features_destroy(networks->features[i]);
    free(networks->features);
    camber_style_destroy(networks->style);
    camber_spool_remove(session->guard, &networks->copy);
#endif
    camber_polylines_destroy(networks->polylines);
    if (session->context)
        camber_lines_destroy(&networks->simplified);
    camber_input_close(&networks->input);
    *networks = (camber_compared_networks){0};
}
