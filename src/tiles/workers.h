/* One context for each of the caller's worker threads. */
#ifndef CAMBER_TILES_WORKERS_H
#define CAMBER_TILES_WORKERS_H

#include "base/base.h"
#include "base/threads.h"

typedef struct camber_workers {
    camber_context *context;   /* the caller's */
    camber_context **contexts; /* count of them; they share the caller's memory budget, and their log messages are
                                  passed to the caller */
    char (*messages)[512];     /* the last error of each; "": none */
    size_t count;
} camber_workers;

/* count: 0 means one per core. Returns CAMBER_ERROR_MEMORY. After a failure, camber_workers_free must be called too. */
camber_status camber_workers_make(camber_context *context, size_t count, camber_workers *workers);
void camber_workers_free(camber_workers *workers);
/* Logs the last error of a worker in the caller's context. Returns status. */
camber_status camber_workers_tell(const camber_workers *workers, size_t number, camber_status status);

#endif
