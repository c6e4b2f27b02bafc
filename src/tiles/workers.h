/* Contexts of threads that work beside the caller's, one each. */
#ifndef CAMBER_TILES_WORKERS_H
#define CAMBER_TILES_WORKERS_H

#include "base/base.h"
#include "base/threads.h"

typedef struct camber_workers {
    camber_context *context;   /* the caller's */
    camber_context **contexts; /* count; they share the caller's budget, and their messages come to the caller */
    char (*messages)[512];     /* the last error of each; "": none */
    size_t count;
} camber_workers;

/* count: 0 is one a core. Returns CAMBER_ERROR_MEMORY. camber_workers_free frees also what a failure left. */
camber_status camber_workers_make(camber_context *context, size_t count, camber_workers *workers);
void camber_workers_free(camber_workers *workers);
/* Tells the caller's context what a worker's context was told last. Returns status. */
camber_status camber_workers_tell(const camber_workers *workers, size_t number, camber_status status);

#endif
