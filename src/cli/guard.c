/* Removes temporary files however the process ends. One thread waits for signals from outside. A handler catches faults
 * such as SIGSEGV or a driver's abort. Both remove the files in the guard's list, and then let the process end with the
 * status or signal that it would have had. */
#define _XOPEN_SOURCE 700 /* SIGPOLL, SIGPROF, SIGVTALRM */

#include "cli/guard.h"

#include <poll.h>
#include <stddef.h>
#include <time.h>
#include <unistd.h>

/* Signals that end a process by default and that another process, a terminal, a timer or a limit sends. SIGPIPE and
 * SIGXFSZ are left out: they appear as failed writes. A process cannot wait for SIGKILL. */
static const int from_outside[] = {
    SIGHUP,  SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGALRM, SIGUSR1, SIGUSR2, SIGVTALRM, SIGPROF,
#ifdef SIGPOLL
    SIGPOLL,
#endif
#ifdef SIGPWR
    SIGPWR,
#endif
};
static const int faults[] = {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV};

enum { OUTSIDE_COUNT = sizeof from_outside / sizeof *from_outside, FAULT_COUNT = sizeof faults / sizeof *faults };

static void remove_files(camber_guard *guard) {
    for (int i = 0; i < CAMBER_GUARD_FILES; i++) {
        const char *path = atomic_load(&guard->paths[i]);
        if (path)
            unlink(path);
    }
    if (guard->erase_bar) {
        const char erase[] = "\r\033[K";
        const ssize_t written = write(STDERR_FILENO, erase, sizeof erase - 1);
        (void)written;
    }
}

/* ---- Faults ---- */

/* A handler receives a number and nothing else, so it needs this one global pointer to its guard. */
static _Atomic(camber_guard *) guard_of_faults;

/* Another thread may be adding or removing a file right now, which takes less than a second. If the fault stopped that
 * very thread, waiting is useless. In either case the list does not change afterwards. */
static void wait_for_others(camber_guard *guard) {
    for (int i = 0; i < 1000 && atomic_load(&guard->locked); i++)
        poll(NULL, 0, 1);
}

/* Calls only functions that POSIX allows in a handler. The handler stays installed while it runs, so that a fault in a
 * second thread does not end the process meanwhile. */
static void end_by_fault(int number) {
    camber_guard *guard = atomic_load(&guard_of_faults);
    if (guard) {
        wait_for_others(guard);
        remove_files(guard);
        camber_guard_handler *next = number == SIGABRT ? atomic_load(&guard->after_abort) : NULL;
        if (next)
            next(number);
    }
    signal(number, SIG_DFL);
    raise(number); /* end as without a handler, with a core file if the system writes one */
}

/* Installs the handler only if none is installed, because sanitizers report faults with handlers of their own. */
static void meet_faults(camber_guard *guard) {
    struct sigaction action = {.sa_handler = end_by_fault, .sa_flags = SA_ONSTACK};
    sigemptyset(&action.sa_mask);
    atomic_store(&guard_of_faults, guard);
    for (int i = 0; i < FAULT_COUNT; i++) {
        struct sigaction before;
        if (sigaction(faults[i], NULL, &before) == 0 && before.sa_handler == SIG_DFL)
            sigaction(faults[i], &action, NULL);
    }
}

/* LLVM (in PoCL and Mesa) installs handlers that remove its own files and restore the former handlers. A fault then
 * happens again and reaches this handler, but an abort does not. So this handler goes first and calls LLVM's. A handler
 * with SA_SIGINFO belongs to a sanitizer or a language's run time, and stays first. */
void camber_guard_go_first(camber_guard *guard) {
    struct sigaction action = {.sa_handler = end_by_fault, .sa_flags = SA_ONSTACK}, before;
    sigemptyset(&action.sa_mask);
    if (sigaction(SIGABRT, NULL, &before) != 0 || before.sa_flags & SA_SIGINFO || before.sa_handler == SIG_DFL ||
        before.sa_handler == SIG_IGN || before.sa_handler == end_by_fault)
        return;
    atomic_store(&guard->after_abort, before.sa_handler);
    sigaction(SIGABRT, &action, NULL);
}

static void leave_faults(void) {
    for (int i = 0; i < FAULT_COUNT; i++) {
        struct sigaction action;
        if (sigaction(faults[i], NULL, &action) == 0 && action.sa_handler == end_by_fault)
            signal(faults[i], SIG_DFL);
    }
    atomic_store(&guard_of_faults, NULL);
}

/* ---- Signals from outside ---- */

/* A driver that starts LLVM does not announce it, so the thread checks periodically. */
static void *wait_for_signal(void *user) {
    camber_guard *guard = user;
    const struct timespec pause = {.tv_nsec = 100000000};
    for (bool stopping = false; !stopping;) {
        const int number = sigtimedwait(&guard->signals, NULL, &pause);
        camber_guard_go_first(guard);
        camber_guard_lock(guard);
        if (guard->look)
            guard->look(guard->look_user);
        if (number < 0) {
            camber_guard_unlock(guard);
            continue;
        }
        stopping = guard->stopping && number == SIGTERM;
        const bool heeded = guard->heed && guard->heed(guard->heed_user, number);
        if (!stopping && !heeded && !sigismember(&guard->ignored, number))
            camber_guard_end(guard, 128 + number);
        camber_guard_unlock(guard);
    }
    return NULL;
}

static void choose_signals(camber_guard *guard) {
    sigemptyset(&guard->signals);
    sigemptyset(&guard->ignored);
    for (int i = 0; i < OUTSIDE_COUNT; i++) {
        const int number = from_outside[i];
        struct sigaction action;
        if (sigaction(number, NULL, &action) != 0)
            continue;
        /* A signal that is ignored, as under nohup or a shell's &, or that a profiler handles, is left to them. The
         * thread waits for SIGTERM in any case, because it also ends the guard's thread, and drops it then. */
        const bool ends = action.sa_handler == SIG_DFL;
        if (ends || number == SIGTERM)
            sigaddset(&guard->signals, number);
        if (!ends)
            sigaddset(&guard->ignored, number);
    }
}

/* ---- The guard ---- */

bool camber_guard_start(camber_guard *guard, bool erase_bar) {
    *guard = (camber_guard){.erase_bar = erase_bar};
    pthread_mutex_init(&guard->mutex, NULL);
    meet_faults(guard);
    choose_signals(guard);
    pthread_sigmask(SIG_BLOCK, &guard->signals, &guard->before);
    if (pthread_create(&guard->thread, NULL, wait_for_signal, guard) == 0)
        return true;
    leave_faults();
    pthread_sigmask(SIG_SETMASK, &guard->before, NULL);
    return false;
}

/* A SIGTERM sent to the thread wakes it; the mark distinguishes it from one that comes from outside. */
void camber_guard_stop(camber_guard *guard) {
    camber_guard_lock(guard);
    guard->stopping = true;
    camber_guard_unlock(guard);
    pthread_kill(guard->thread, SIGTERM);
    pthread_join(guard->thread, NULL);
    leave_faults();
    pthread_sigmask(SIG_SETMASK, &guard->before, NULL);
    pthread_mutex_destroy(&guard->mutex);
}

void camber_guard_lock(camber_guard *guard) {
    pthread_mutex_lock(&guard->mutex);
    atomic_store(&guard->locked, true);
}

void camber_guard_unlock(camber_guard *guard) {
    atomic_store(&guard->locked, false);
    pthread_mutex_unlock(&guard->mutex);
}

void camber_guard_end(camber_guard *guard, int exit_status) {
    remove_files(guard);
    _exit(exit_status);
}

bool camber_guard_add(camber_guard *guard, char *path) {
    for (int i = 0; i < CAMBER_GUARD_FILES; i++)
        if (!atomic_load(&guard->paths[i])) {
            atomic_store(&guard->paths[i], path);
            return true;
        }
    return false;
}

void camber_guard_remove(camber_guard *guard, const char *path) {
    for (int i = 0; i < CAMBER_GUARD_FILES; i++)
        if (atomic_load(&guard->paths[i]) == path)
            atomic_store(&guard->paths[i], NULL);
}
