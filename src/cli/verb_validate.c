/* Runs `camber validate`: every check on all devices and back ends of the machine. The checks are in src/validate; this
 * file reads their input, and prints their results. */
#include "cli/failure_folder.h"
#include "cli/input.h"
#include "cli/results_text.h"
#include "cli/verbs.h"

typedef struct run {
    camber_session *session;
    camber_input input;
    camber_output junit;
    camber_failure_folder folder;
    camber_tap tap;
    camber_validation validation;
} run;

/* ---- Callbacks of the checks ---- */

static void take_message(void *user, char *text, size_t size) {
    const run *r = user;
    char *error = r->session->report->error;
    snprintf(text, size, "%s", error);
    error[0] = 0;
}

static camber_status write_image(void *user, const camber_failure_image *image, char **path) {
    run *r = user;
    return camber_failure_folder_write(&r->folder, image, path);
}

/* How long the checks of one input take is not known. */
static void show_progress(void *user, size_t done, size_t count) {
    const run *r = user;
    r->session->report->has_steps = count > 1;
    if (count > 1)
        camber_report_step(r->session->report, "checking", "scenes", done, count);
    else
        camber_report_step(r->session->report, "checking", NULL, 0, 0);
}

/* ---- The input of the checks ---- */

static camber_validation_desc describe(run *r) {
    const camber_options *options = r->session->options;
    return (camber_validation_desc){
        .context = r->session->context,
        .host = {.take_message = take_message,
                 .write_image = options->pictures ? write_image : NULL,
                 .progress = show_progress,
                 .user = r},
        .listener = options->json ? (camber_results_listener){0} : camber_tap_listener(&r->tap),
        .match = options->device,
        .memory_bytes = options->memory_bytes,
        .backend = (camber_backend)options->backend,
        .rasterizer = (camber_rasterizer)options->draw,
        .method = options->method,
        .full = options->full,
        .coverage = (camber_coverage)options->coverage,
        .windows = options->windows,
        .only = options->only,
    };
}

static camber_validation_input input_of(run *r) {
    const camber_options *options = r->session->options;
    camber_input *input = &r->input;
    const camber_frame frame = camber_input_frame(input, NULL);
    camber_validation_input made = {.subject = {
                                        .name = options->polylines     ? options->polylines
                                                : options->input_count ? options->inputs[0]
                                                                       : options->style,
                                        .lines = *camber_input_lines(input),
                                        .rows = camber_input_rows(input),
                                        .keep_open = options->polylines != NULL,
                                        .polylines = camber_input_polylines(input),
                                        .width = frame.width,
                                        .height = frame.height,
                                    }};
    camber_subject *s = &made.subject;
    s->strokes = s->drawn_strokes = camber_input_strokes(input, &s->stroke_count);
    made.network = camber_input_network(input, &made.camera, &made.strokes);
#ifdef CAMBER_MAP
    if (input->filled) {
        made.frame = camber_scene_get_frame(input->filled, NULL);
        made.map = (camber_subject){.name = s->name,
                                    .lines = *camber_scene_get_lines(input->filled),
                                    .rows = camber_scene_get_rows(input->filled),
                                    .polylines = camber_scene_get_polylines(input->filled),
                                    .width = made.frame.width,
                                    .height = made.frame.height};
        made.map.strokes = made.map.drawn_strokes = camber_scene_get_strokes(input->filled, &made.map.stroke_count);
    }
#endif
    return made;
}

static int open_input(camber_input *input, camber_session *session) {
    int status = camber_input_open(input, session);
    if (status == CAMBER_EXIT_DONE)
        status = camber_input_project(input);
    if (status == CAMBER_EXIT_DONE && !input->filled)
        camber_input_warn_empty(input, "nothing is checked");
    return status;
}

/* ---- The verb ---- */

static bool is_given(const camber_options *options) {
    return options->polylines || options->input_count || options->style;
}

/* Opens what the options name, so that errors show before the work starts. */
static int prepare(run *r) {
    camber_session *session = r->session;
    const camber_options *options = session->options;
    int status = camber_failure_folder_check(session);
    if (status == CAMBER_EXIT_DONE && options->junit)
        status = camber_output_open(&r->junit, session->report, session->guard, options->junit, options->force);
    if (status == CAMBER_EXIT_DONE)
        status = camber_session_need(session, CAMBER_NEEDS_CONTEXT);
    if (status == CAMBER_EXIT_DONE && is_given(options))
        status = open_input(&r->input, session);
    return status;
}

static int check(run *r) {
    camber_session *session = r->session;
    const camber_options *options = session->options;
    if (!options->json)
        camber_tap_open(&r->tap, options->verbose, session->report);
    const camber_validation_desc desc = describe(r);
    camber_validation_input input = {0};
    const bool given = is_given(options);
    if (given)
        input = input_of(r);
    camber_status checked = camber_validation_run(&r->validation, &desc, given ? &input : NULL);
    camber_report_erase_bar(session->report);
    if (checked == CAMBER_OK && r->validation.results.full)
        checked = CAMBER_ERROR_MEMORY;
    int status = r->folder.exit_status ? r->folder.exit_status : camber_report_status(session->report, checked);
    if (status == CAMBER_EXIT_DONE && !r->validation.results.wanted)
        status = camber_report_fail(
            session->report, CAMBER_EXIT_USAGE,
            "--only %s: no group of checks has this in its name; a run without --only lists the groups", options->only);
    if (status != CAMBER_EXIT_DONE && !options->json)
        camber_tap_bail();
    return status;
}

/* Returns CAMBER_EXIT_CHECK if a check failed. */
static int print(run *r) {
    camber_session *session = r->session;
    const camber_results *results = &r->validation.results;
    int status = session->options->junit ? camber_junit_write(results, &r->junit) : CAMBER_EXIT_DONE;
    if (status == CAMBER_EXIT_DONE)
        status = session->options->json ? camber_results_print_json(results, session->report)
                                        : camber_tap_end(&r->tap, results, session->report);
    return status == CAMBER_EXIT_DONE && results->failed ? CAMBER_EXIT_CHECK : status;
}

static void say_done(const run *r) {
    const camber_results *results = &r->validation.results;
    camber_report *report = r->session->report;
    if (!r->session->options->full)
        camber_report_say(report, "--full draws by every method, with every join and cap on each back end, and with 1, "
                                  "8 and 16 lanes");
    camber_report_done(report, "validate", 0, camber_session_elapsed_ms(r->session),
                       "%s check%s, %s failed, %s skipped", camber_figure_count(results->count).text,
                       camber_plural(results->count), camber_figure_count(results->failed).text,
                       camber_figure_count(results->skipped).text);
}

int camber_verb_validate(camber_session *session) {
    run r = {.session = session, .folder = {.session = session}};
    int status = prepare(&r);
    if (status == CAMBER_EXIT_DONE)
        status = check(&r);
    if (status == CAMBER_EXIT_DONE)
        status = print(&r);
    if (r.validation.devices.count && (status == CAMBER_EXIT_DONE || status == CAMBER_EXIT_CHECK))
        say_done(&r);
    camber_validation_close(&r.validation);
    camber_input_close(&r.input);
    camber_output_discard(&r.junit);
    return status;
}
