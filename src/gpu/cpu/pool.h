/* Threads that share the work-items of a launch. Each takes a run of work-items, a smaller one the fewer are left,
 * until all are taken. The thread that launches takes part, so that a pool without threads works, too. */
#ifndef CAMBER_GPU_CPU_POOL_H
#define CAMBER_GPU_CPU_POOL_H

#include "gpu/cpu/levels.h"

#include "base/base.h"

typedef struct camber_cpu_pool camber_cpu_pool;

/* A launch: work-items [0, count). */
typedef struct camber_cpu_work {
    camber_cpu_function *run;
    const void *args;
    size_t count;
} camber_cpu_work;

/* threads: including the one that launches. The others are started by the first launch that needs them; if the system
 * cannot start as many, fewer take part. */
camber_status camber_cpu_pool_create(camber_context *context, size_t threads, camber_cpu_pool **pool);
/* Ends the threads. pool may be NULL. */
void camber_cpu_pool_destroy(camber_cpu_pool *pool);
/* Runs all work-items and returns when they are done. Only one thread at a time may call it. */
void camber_cpu_pool_run(camber_cpu_pool *pool, const camber_cpu_work *work);

#endif
