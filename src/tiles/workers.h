/* Threads that work beside the caller's, each with a context of its own. */
#ifndef CAMBER_TILES_WORKERS_H
#define CAMBER_TILES_WORKERS_H

#include "base/base.h"

typedef struct camber_workers {
    camber_context *context;   /* the caller's */
    camber_context **contexts; /* count; they share the caller's budget, and their messages come to the caller */
    char (*messages)[512];     /* the last error of each; "": none */
    size_t count;
} camber_workers;

/* count: 0 is one a core. Returns CAMBER_ERROR_MEMORY. camber_workers_free frees also what a failure left. */
camber_status camber_workers_make(camber_context *context, size_t count, camber_workers *workers);
void camber_workers_free(camber_workers *workers);
/* Calls work(user, number) once for each worker, at the same time, and waits for all. One worker works on the caller's
 * thread. Returns the first failure, its message told. */
camber_status camber_workers_run(camber_workers *workers, camber_status (*work)(void *user, size_t number), void *user);
/* Tells the caller's context what a worker's context was told last. Returns status. */
camber_status camber_workers_tell(const camber_workers *workers, size_t number, camber_status status);

#endif
