#define _XOPEN_SOURCE 700

#include "tiles/workers.h"

#include <pthread.h>
#include <stdio.h>
#include <unistd.h>

enum { MOST_WORKERS = 256 };

static void keep_message(void *user, camber_log_level level, const char *message) {
    if (level == CAMBER_LOG_ERROR)
        snprintf(user, sizeof(char[512]), "%s", message);
}

camber_status camber_workers_make(camber_context *context, size_t count, camber_workers *workers) {
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    if (count == 0)
        count = cores > 0 ? (size_t)cores : 1;
    *workers = (camber_workers){.context = context, .count = count < MOST_WORKERS ? count : MOST_WORKERS};
    if (!(workers->messages = camber_alloc_zero(context, workers->count, sizeof *workers->messages)) ||
        !(workers->contexts = camber_alloc_zero(context, workers->count, sizeof *workers->contexts)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < workers->count; i++) {
        const camber_context_desc desc = {
            .log = keep_message, .log_user = workers->messages[i], .cache_dir = "", .budget = context->budget};
        const camber_status status = camber_context_create(&desc, &workers->contexts[i]);
        if (status != CAMBER_OK)
            return camber_fail(context, status, "a thread's context: out of memory; give the run more");
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

typedef struct worker_call {
    camber_status (*work)(void *user, size_t number);
    void *user;
    size_t number;
    camber_status status;
    pthread_t thread;
    bool runs;
} worker_call;

static void *run_one(void *user) {
    worker_call *call = user;
    call->status = call->work(call->user, call->number);
    return NULL;
}

/* Work whose thread cannot be made is done on the caller's. */
camber_status camber_workers_run(camber_workers *workers, camber_status (*work)(void *user, size_t number),
                                 void *user) {
    worker_call *calls = camber_alloc_zero(workers->context, workers->count, sizeof *calls);
    camber_status status = CAMBER_OK;
    if (!calls)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < workers->count; i++) {
        calls[i] = (worker_call){.work = work, .user = user, .number = i};
        calls[i].runs = i > 0 && pthread_create(&calls[i].thread, NULL, run_one, &calls[i]) == 0;
    }
    for (size_t i = 0; i < workers->count; i++)
        if (!calls[i].runs)
            run_one(&calls[i]);
    for (size_t i = 0; i < workers->count; i++) {
        if (calls[i].runs)
            pthread_join(calls[i].thread, NULL);
        if (status == CAMBER_OK && calls[i].status != CAMBER_OK)
            status = camber_workers_tell(workers, i, calls[i].status);
    }
    camber_free(workers->context, calls);
    return status;
}
