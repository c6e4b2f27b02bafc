/* The tool `camber`: parses the command line, prepares the process, runs the verb under the guard, and returns its exit
 * status. */
#define _XOPEN_SOURCE 700 /* SIGXFSZ */

#include "cli/completion.h"
#include "cli/environment.h"
#include "cli/stack.h"
#include "cli/verbs.h"

#include <signal.h>
#include <stdio.h>

static int run(camber_session *session) {
    switch (session->options->verb) {
#ifdef CAMBER_MAP
    case CAMBER_VERB_RENDER: return camber_verb_render(session);
    case CAMBER_VERB_TESSELLATE: return camber_verb_tessellate(session);
    case CAMBER_VERB_STYLE: return camber_verb_style(session);
    case CAMBER_VERB_TILES: return camber_verb_tiles(session);
    case CAMBER_VERB_SERVE: return camber_verb_serve(session);
#else
    case CAMBER_VERB_RENDER:
    case CAMBER_VERB_TESSELLATE:
    case CAMBER_VERB_STYLE:
    case CAMBER_VERB_TILES:
    case CAMBER_VERB_SERVE: break; /* this build's parser does not accept these verbs */
#endif
    case CAMBER_VERB_COMPARE: return camber_verb_compare(session);
    case CAMBER_VERB_VALIDATE: return camber_verb_validate(session);
    case CAMBER_VERB_BENCH: return camber_verb_bench(session);
    case CAMBER_VERB_INFO: return camber_verb_info(session);
    case CAMBER_VERB_NONE: break;
    }
    return CAMBER_EXIT_INTERNAL;
}

static int run_guarded(void *user) {
    camber_session *session = user;
    camber_guard guard;
    if (!camber_environment_set(session->options))
        return camber_report_status(session->report, CAMBER_ERROR_MEMORY);
    if (session->options->verb != CAMBER_VERB_STYLE && !camber_environment_has_descriptors())
        return camber_report_fail(session->report, CAMBER_EXIT_IO, "too many open files; raise ulimit -n");
    const bool guarded = camber_guard_start(&guard, session->report->bars);
    session->guard = &guard;
    const int status = run(session);
    if (guarded && status != CAMBER_EXIT_DONE && camber_session_is_opening(session)) {
        /* After a failure no device is needed, so do not wait until it has been opened. */
        fflush(NULL);
        camber_guard_lock(&guard);
        camber_guard_end(&guard, status);
    }
    camber_session_close(session);
    camber_report_erase_bar(session->report);
    if (guarded)
        camber_guard_stop(&guard);
    return status;
}

int main(int argc, char **argv) {
    const double start_ms = camber_now_ms();
    camber_options options;
    camber_report report;
    char message[4096];
    camber_environment_fill_streams();
    int status = camber_options_parse(argc, argv, &options, message, sizeof message);
    camber_report_open(&report, &options);
    /* A reader that has gone away, and a file at its size limit, appear as failed writes and are reported as such. */
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    if (status != CAMBER_EXIT_DONE) {
        status = camber_report_fail(&report, status, "%s", message);
    } else if (options.help) {
        camber_options_help(options.verb, stdout);
        status = camber_report_flush(&report);
    } else if (options.version) {
        printf("camber %s\n", camber_version());
        status = camber_report_flush(&report);
    } else if (options.completion >= 0) {
        camber_completion_print((camber_shell)options.completion, stdout);
        status = camber_report_flush(&report);
    } else {
        camber_session session = {.options = &options, .report = &report, .start_ms = start_ms};
        status = camber_stack_run(run_guarded, &session);
    }
    camber_options_free(&options);
    return status;
}
