#include "cli/input.h"
#include "cli/verbs.h"

#ifdef CAMBER_MAP

#include <stdlib.h>
#include <string.h>

static bool write_out(void *user, const void *bytes, size_t size_bytes) {
    return fwrite(bytes, 1, size_bytes, user) == size_bytes;
}

static int evaluate(camber_session *session, const char *name, const char *bytes, size_t size_bytes) {
    const camber_sink sink = {.write = write_out, .user = stdout};
    const camber_status status = camber_style_evaluate(session->context, bytes, size_bytes, name, sink);
    if (status != CAMBER_OK)
        return camber_report_status(session->report, status);
    return camber_report_flush(session->report);
}

int camber_verb_style(camber_session *session) {
    const char *path = session->options->inputs[1];
    char *bytes = NULL;
    size_t size_bytes = 0;
    int status = camber_session_need(session, CAMBER_NEEDS_CONTEXT);
    if (status == CAMBER_EXIT_DONE)
        status = camber_input_read_all(session->report, path, &bytes, &size_bytes);
    if (status == CAMBER_EXIT_DONE)
        status = evaluate(session, strcmp(path, "-") == 0 ? "standard input" : path, bytes, size_bytes);
    free(bytes);
    return status;
}

#endif
