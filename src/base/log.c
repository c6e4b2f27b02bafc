/* Logging: a message becomes one line, which is passed to the callback. */
#include "base/base.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void log_list(camber_context *context, camber_log_level level, const char *format, va_list list) {
    if (!context->desc.log)
        return;
    /* Long enough for any path and cause. A build log is cut, but its beginning names the error. */
    char message[4096];
    vsnprintf(message, sizeof message, format, list);
    /* The message may quote a file, so it is made one line without control characters for a terminal. */
    for (char *c = message; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f)
            *c = ' ';
    context->desc.log(context->desc.log_user, level, message);
}

void camber_log(camber_context *context, camber_log_level level, const char *format, ...) {
    va_list list;
    va_start(list, format);
    log_list(context, level, format, list);
    va_end(list);
}

camber_status camber_fail(camber_context *context, camber_status status, const char *format, ...) {
    va_list list;
    va_start(list, format);
    log_list(context, CAMBER_LOG_ERROR, format, list);
    va_end(list);
    return status;
}

static void log_demoted(void *user, camber_log_level level, const char *message) {
    const camber_saved_log *kept = user;
    kept->log(kept->user, level == CAMBER_LOG_ERROR ? CAMBER_LOG_INFO : level, message);
}

void camber_log_demote_errors(camber_context *context, camber_saved_log *kept) {
    *kept = (camber_saved_log){context->desc.log, context->desc.log_user};
    if (!kept->log)
        return;
    context->desc.log = log_demoted;
    context->desc.log_user = kept;
}

void camber_log_restore(camber_context *context, const camber_saved_log *kept) {
    context->desc.log = kept->log;
    context->desc.log_user = kept->user;
}

void camber_progress_tell(camber_context *context, const camber_progress_info *progress) {
    if (context->desc.progress)
        context->desc.progress(context->desc.progress_user, progress);
}

void camber_progress(camber_context *context, const char *stage, double fraction) {
    camber_progress_tell(context, &(camber_progress_info){.stage = stage, .fraction = fraction});
}

void camber_progress_count(camber_context *context, const char *stage, const char *unit, uint64_t done,
                           uint64_t total) {
    camber_progress_tell(context, &(camber_progress_info){.stage = stage,
                                                          .fraction = total ? (double)done / (double)total : -1.0,
                                                          .unit = unit,
                                                          .done = done,
                                                          .total = total});
}
