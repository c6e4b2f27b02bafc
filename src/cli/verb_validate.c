/* camber validate: every check on everything that is here. */
#include "cli/input.h"
#include "cli/junit.h"
#include "cli/verbs.h"
#include "validate/checks.h"
#include "validate/scenes.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int check_subject(camber_validation *v, const camber_subject *s) {
    camber_results_group(&v->verdicts, "%s: meshes as the CPU twin's", s->name);
    int status = camber_check_meshes(v, s);
    camber_results_group(&v->verdicts, "%s: pictures as the CPU twin's", s->name);
    if (status == CAMBER_EXIT_DONE)
        status = camber_check_drawing(v, s);
    camber_results_group(&v->verdicts, "%s: pixels as the oracle's", s->name);
    if (status == CAMBER_EXIT_DONE)
        status = camber_check_pixels(v, s);
    camber_results_group(&v->verdicts, "%s: networks under five cameras", s->name);
    return status;
}

/* Of all widths at which a kernel or a shader does something else; pictures leave out what would cover all of them. */
static const camber_stroke builtin_strokes[CAMBER_SCENE_ROWS] = {
    {.width_px = 0.3f, .miter_limit = 1},
    {.width_px = 2, .miter_limit = 0},
    {.width_px = 9, .miter_limit = 10},
    {.width_px = 64, .miter_limit = 4, .round_limit = 1.3f},
    {.width_px = 1, .miter_limit = 2}};
/* The third is CAMBER_SCENE_WIDTH_ROW. */
static const camber_stroke builtin_drawn_strokes[CAMBER_SCENE_ROWS] = {
    {.width_px = 0.4f, .miter_limit = 1},
    {.width_px = 3, .miter_limit = 0},
    {CAMBER_SCENE_WIDTH_PX, 0, 0, 10},
    {.width_px = 20, .miter_limit = 4, .round_limit = 1.3f},
    {.width_px = 1, .miter_limit = 2}};

static int check_builtin(camber_validation *v, size_t number) {
    camber_made_scene scene;
    camber_polylines *polylines = NULL;
    camber_status made = CAMBER_ERROR_MEMORY;
    if (camber_builtin_make(number, &scene)) {
        const camber_polylines_desc desc = {.points = scene.points,
                                            .point_count = scene.point_count,
                                            .offsets = scene.offsets,
                                            .polyline_count = scene.polyline_count,
                                            .rows = scene.rows};
        made = camber_polylines_create(v->session->context, &desc, &polylines);
    }
    int status = camber_report_status(v->session->report, made);
    if (status == CAMBER_EXIT_DONE) {
        const camber_subject s = {
            .name = scene.name,
            .scene = scene.name,
            .lines = {scene.points, scene.offsets, scene.point_count, scene.polyline_count},
            .rows = scene.rows,
            .polylines = polylines,
            .strokes = builtin_strokes,
            .drawn_strokes = builtin_drawn_strokes,
            .stroke_count = CAMBER_SCENE_ROWS,
            .width = CAMBER_SCENE_SIDE_PX,
            .height = CAMBER_SCENE_SIDE_PX,
        };
        status = check_subject(v, &s);
        if (status == CAMBER_EXIT_DONE)
            status = camber_check_networks(v, &s, NULL, NULL, NULL);
    }
    camber_polylines_destroy(polylines);
    camber_builtin_free(&scene);
    return status;
}

static int check_input(camber_validation *v, camber_input *input) {
    const camber_options *options = v->session->options;
    const camber_frame frame = camber_input_frame(input, NULL);
    camber_subject s = {
        .name = options->polylines     ? options->polylines
                : options->input_count ? options->inputs[0]
                                       : options->style,
        .lines = *camber_input_lines(input),
        .rows = camber_input_rows(input),
        .keep_open = options->polylines != NULL,
        .polylines = camber_input_polylines(input),
        .width = frame.width,
        .height = frame.height,
    };
    s.strokes = s.drawn_strokes = camber_input_strokes(input, &s.stroke_count);
    const int status = check_subject(v, &s);
    if (status != CAMBER_EXIT_DONE)
        return status;
    camber_camera camera;
    camber_tessellation_desc strokes;
    camber_network *network = camber_input_network(input, &camera, &strokes);
    return camber_check_networks(v, &s, network, &camera, &strokes);
}

static int check_all(camber_validation *v, camber_input *input) {
    camber_session *session = v->session;
    const bool bars = !v->verdicts.tap || !isatty(STDOUT_FILENO); /* lines of TAP are progress enough */
    camber_results_group(&v->verdicts, "devices and back ends");
    int status = camber_checked_devices_open(&v->rigs, session, &v->verdicts);
    const size_t count = input ? 1 : camber_builtin_count();
    for (size_t i = 0; i < count && status == CAMBER_EXIT_DONE; i++) {
        if (bars)
            camber_report_progress(session->report, "checking", (double)i / (double)count);
        status = input ? check_input(v, input) : check_builtin(v, i);
    }
    camber_results_group(&v->verdicts, "lines beside others");
    if (status == CAMBER_EXIT_DONE && !input)
        status = camber_check_offsets(v);
    camber_results_group(&v->verdicts, "along lines: pixels");
    if (status == CAMBER_EXIT_DONE && !input)
        status = camber_check_along(v);
    camber_report_erase_bar(session->report);
    return status;
}

static int open_input(camber_input *input, camber_session *session) {
    int status = camber_input_open(input, session);
    if (status == CAMBER_EXIT_DONE)
        status = camber_input_project(input);
    if (status == CAMBER_EXIT_DONE)
        camber_input_warn_empty(input, "nothing is checked");
    return status;
}

static void say_what_was_left(const camber_validation *v) {
    const camber_options *options = v->session->options;
    camber_report_say(
        v->session->report, "%zu checks in %.0f s: %zu failed, %zu skipped%s", v->verdicts.count,
        (camber_clock_ms() - v->session->start_ms) / 1e3, v->verdicts.failed, v->verdicts.skipped,
        options->full
            ? ""
            : "; --full draws by every method, with every join and cap on each back end, and as GPUs draw, too");
}

int camber_verb_validate(camber_session *session) {
    const camber_options *options = session->options;
    camber_validation v = {.session = session};
    camber_input input = {0};
    camber_output junit = {0};
    const bool given = options->polylines || options->input_count || options->style;
    int status = camber_evidence_check(session);
    if (status == CAMBER_EXIT_DONE && options->junit)
        status = camber_output_open(&junit, session->report, session->guard, options->junit, options->force);
    if (status == CAMBER_EXIT_DONE)
        status = camber_session_need(session, CAMBER_NEEDS_CONTEXT);
    if (status == CAMBER_EXIT_DONE && given)
        status = open_input(&input, session);
    if (status == CAMBER_EXIT_DONE) {
        camber_results_open(&v.verdicts, session->report, !options->json, options->verbose);
        status = check_all(&v, given ? &input : NULL);
        if (status != CAMBER_EXIT_DONE)
            camber_results_bail(&v.verdicts);
    }
    if (status == CAMBER_EXIT_DONE && options->junit)
        status = camber_junit_write(&v.verdicts, &junit);
    if (status == CAMBER_EXIT_DONE)
        status = camber_results_print(&v.verdicts);
    if (v.rigs.count && (status == CAMBER_EXIT_DONE || status == CAMBER_EXIT_CHECK))
        say_what_was_left(&v);
    camber_results_close(&v.verdicts);
    camber_checked_devices_close(&v.rigs);
    camber_input_close(&input);
    camber_output_discard(&junit);
    return status;
}
