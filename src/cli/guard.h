/* A list of files that are removed however the process ends. */
#ifndef CAMBER_CLI_GUARD_H
#define CAMBER_CLI_GUARD_H

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>

#define CAMBER_GUARD_FILES 8

/* Signals that come from outside to end the process (SIGHUP, SIGINT, SIGTERM and their like) are blocked in every
 * thread, and one thread waits for them: it removes the files and ends the process with 128 + the signal's number. So a
 * signal also ends a long call of a library. Faults within the process (SIGSEGV, a driver's abort and their like) call
 * a handler in the thread that they stop: it removes the files and lets the fault end the process. */
typedef void camber_guard_handler(int number);

typedef struct camber_guard {
    pthread_mutex_t mutex;
    atomic_bool locked; /* whether the mutex is held, in a form that a handler may read */
    sigset_t signals, ignored, before;
    pthread_t thread;
    bool stopping;
    void (*look)(void *user); /* called by the thread periodically, with the guard locked; may be NULL */
    void *look_user;
    /* Handles a signal from outside, with the guard locked. Returns true if it has handled it; otherwise the process
     * ends. NULL: the process ends. */
    bool (*heed)(void *user, int number);
    void *heed_user;
    _Atomic(camber_guard_handler *)
        after_abort;                           /* a library's handler of aborts, called after the guard's. NULL: none */
    bool erase_bar;                            /* standard error may show a progress bar */
    _Atomic(char *) paths[CAMBER_GUARD_FILES]; /* NULL: free */
} camber_guard;

/* Starts the guard; call it before other threads start. Only one guard may run. Returns false if no thread could be
 * created; signals then end the process as they do by default. */
bool camber_guard_start(camber_guard *guard, bool erase_bar);
/* Call it only if start returned true. */
void camber_guard_stop(camber_guard *guard);

/* Puts the guard's handler of aborts before one that a driver has installed. The guard does this periodically; call it
 * when a driver has certainly been opened. Any thread may call it. */
void camber_guard_go_first(camber_guard *guard);

/* Between calls of these two functions, no signal from outside ends the process. */
void camber_guard_lock(camber_guard *guard);
void camber_guard_unlock(camber_guard *guard);

/* With the guard locked: removes the files and ends the process. */
void camber_guard_end(camber_guard *guard, int exit_status);
/* Call both with the guard locked. add keeps the pointer: free it after remove, when the guard is unlocked. add returns
 * false if there are already CAMBER_GUARD_FILES. */
bool camber_guard_add(camber_guard *guard, char *path);
void camber_guard_remove(camber_guard *guard, const char *path);

#endif
