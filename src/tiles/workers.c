#include "tiles/workers.h"

#include <stdio.h>

static void keep_message(void *user, camber_log_level level, const char *message) {
    if (level == CAMBER_LOG_ERROR)
        snprintf(user, sizeof(char[512]), "%s", message);
}

camber_status camber_workers_make(camber_context *context, size_t count, camber_workers *workers) {
    *workers = (camber_workers){.context = context, .count = camber_threads_count(count)};
    if (!(workers->messages = camber_alloc_zero(context, workers->count, sizeof *workers->messages)) ||
        !(workers->contexts = camber_alloc_zero(context, workers->count, sizeof *workers->contexts)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < workers->count; i++) {
        const camber_context_desc desc = {
            .log = keep_message, .log_user = workers->messages[i], .cache_dir = "", .budget = context->budget};
        const camber_status status = camber_context_create(&desc, &workers->contexts[i]);
        if (status != CAMBER_OK)
            return camber_fail(context, status, "a thread's context: out of memory; raise the memory limit");
    }
    return CAMBER_OK;
}

void camber_workers_free(camber_workers *workers) {
    if (!workers->context)
        return;
    for (size_t i = 0; workers->contexts && i < workers->count; i++)
        camber_context_destroy(workers->contexts[i]);
    camber_free(workers->context, workers->contexts);
    camber_free(workers->context, workers->messages);
    *workers = (camber_workers){0};
}

camber_status camber_workers_tell(const camber_workers *workers, size_t number, camber_status status) {
    const char *message = workers->messages[number];
    return camber_fail(workers->context, status, "%s", *message ? message : camber_status_get_name(status));
}
