#include "cli/guard.h"

#include <stddef.h>
#include <unistd.h>

static void end_process(const camber_guard *guard, int number) {
    for (int i = 0; i < CAMBER_GUARD_FILES; i++)
        if (guard->paths[i])
            unlink(guard->paths[i]);
    if (guard->erase_bar) {
        const char erase[] = "\r\033[K";
        const ssize_t written = write(STDERR_FILENO, erase, sizeof erase - 1);
        (void)written;
    }
    _exit(128 + number);
}

static void *wait_for_signal(void *user) {
    camber_guard *guard = user;
    for (bool stopping = false; !stopping;) {
        int number = 0;
        if (sigwait(&guard->signals, &number) != 0)
            return NULL;
        pthread_mutex_lock(&guard->mutex);
        stopping = guard->stopping && number == SIGTERM;
        if (!stopping && !sigismember(&guard->ignored, number))
            end_process(guard, number);
        pthread_mutex_unlock(&guard->mutex);
    }
    return NULL;
}

bool camber_guard_start(camber_guard *guard, bool erase_bar) {
    *guard = (camber_guard){.erase_bar = erase_bar};
    pthread_mutex_init(&guard->mutex, NULL);
    sigemptyset(&guard->signals);
    sigemptyset(&guard->ignored);
    const int numbers[] = {SIGINT, SIGTERM};
    for (int i = 0; i < 2; i++) {
        /* nohup and a shell's & ask for a signal to be ignored, and waiting for it takes it all the same. */
        struct sigaction action;
        if (sigaction(numbers[i], NULL, &action) == 0 && action.sa_handler == SIG_IGN)
            sigaddset(&guard->ignored, numbers[i]);
        sigaddset(&guard->signals, numbers[i]);
    }
    pthread_sigmask(SIG_BLOCK, &guard->signals, &guard->before);
    if (pthread_create(&guard->thread, NULL, wait_for_signal, guard) == 0)
        return true;
    pthread_sigmask(SIG_SETMASK, &guard->before, NULL);
    return false;
}

/* The thread is woken by a signal of its own, which the mark tells from one from outside. */
void camber_guard_stop(camber_guard *guard) {
    pthread_mutex_lock(&guard->mutex);
    guard->stopping = true;
    pthread_mutex_unlock(&guard->mutex);
    pthread_kill(guard->thread, SIGTERM);
    pthread_join(guard->thread, NULL);
    pthread_sigmask(SIG_SETMASK, &guard->before, NULL);
    pthread_mutex_destroy(&guard->mutex);
}

void camber_guard_lock(camber_guard *guard) {
    pthread_mutex_lock(&guard->mutex);
}

void camber_guard_unlock(camber_guard *guard) {
    pthread_mutex_unlock(&guard->mutex);
}

bool camber_guard_add(camber_guard *guard, char *path) {
    for (int i = 0; i < CAMBER_GUARD_FILES; i++)
        if (!guard->paths[i]) {
            guard->paths[i] = path;
            return true;
        }
    return false;
}

void camber_guard_remove(camber_guard *guard, const char *path) {
    for (int i = 0; i < CAMBER_GUARD_FILES; i++)
        if (guard->paths[i] == path)
            guard->paths[i] = NULL;
}
