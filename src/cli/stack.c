#define _GNU_SOURCE /* pthread_setattr_default_np */

#include "cli/stack.h"

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <sys/resource.h>

/* The usual limit of systems. PoCL has arrays of 64 KB on the stack, and the compilers that it and GL use need more. */
enum { ENOUGH_BYTES = 8 << 20 };

typedef struct job {
    int (*work)(void *user);
    void *user;
    int result;
} job;

static void *do_job(void *user) {
    job *it = user;
    it->result = it->work(it->user);
    return NULL;
}

static bool is_small(void) {
    struct rlimit limit;
    return getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < ENOUGH_BYTES;
}

/* glibc also uses this limit for threads that drivers start. */
static void widen_threads(const pthread_attr_t *attributes) {
#ifdef __GLIBC__
    pthread_setattr_default_np(attributes);
#else
    (void)attributes;
#endif
}

int camber_stack_run(int (*work)(void *user), void *user) {
    job it = {.work = work, .user = user};
    pthread_attr_t attributes;
    pthread_t thread;
    bool started = false;
    if (is_small() && pthread_attr_init(&attributes) == 0) {
        if (pthread_attr_setstacksize(&attributes, ENOUGH_BYTES) == 0) {
            widen_threads(&attributes);
            started = pthread_create(&thread, &attributes, do_job, &it) == 0;
        }
        pthread_attr_destroy(&attributes);
    }
    if (started)
        pthread_join(thread, NULL);
    else
        do_job(&it); /* no thread could be created, so work on this stack */
    return it.result;
}
