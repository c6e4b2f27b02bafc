/* Files that a signal must not leave behind. */
#ifndef CAMBER_CLI_GUARD_H
#define CAMBER_CLI_GUARD_H

#include <pthread.h>
#include <signal.h>
#include <stdbool.h>

#define CAMBER_GUARD_FILES 8

/* SIGINT and SIGTERM are blocked in every thread, and one thread waits for them: it removes the files and ends
 * the process with 130 or 143. So nothing has to be global, and a signal also ends a long call of a library. */
typedef struct camber_guard {
    pthread_mutex_t mutex;
    sigset_t signals, ignored, before;
    pthread_t thread;
    bool stopping;
    bool erase_bar;                  /* a progress bar may stand on standard error */
    char *paths[CAMBER_GUARD_FILES]; /* NULL: free */
} camber_guard;

/* Before other threads start. false where no thread can be made, and then signals end the process as they do by
 * default. */
bool camber_guard_start(camber_guard *guard, bool erase_bar);
/* After a start that returned true. */
void camber_guard_stop(camber_guard *guard);

/* Between these two, no signal ends the process. */
void camber_guard_lock(camber_guard *guard);
void camber_guard_unlock(camber_guard *guard);

/* With the guard locked. add keeps the pointer; false where CAMBER_GUARD_FILES are there already. */
bool camber_guard_add(camber_guard *guard, char *path);
void camber_guard_remove(camber_guard *guard, const char *path);

#endif
