#define _XOPEN_SOURCE 700 /* SIGPOLL, SIGPROF, SIGVTALRM */

#include "cli/guard.h"

#include <poll.h>
#include <stddef.h>
#include <time.h>
#include <unistd.h>

/* What POSIX has end a process and another process, a terminal, a timer or a limit sends. SIGPIPE and SIGXFSZ are
 * failed writes here, and nobody waits for SIGKILL. */
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

/* A handler is given nothing but a number, so the guard that it serves has to lie here; for that one purpose. */
static _Atomic(camber_guard *) guard_of_faults;

/* Another thread may be making or removing a file just now: that takes no second, unless it is this thread that the
 * fault has stopped in it. Neither changes the list any more then. */
static void wait_for_others(camber_guard *guard) {
    for (int i = 0; i < 1000 && atomic_load(&guard->locked); i++)
        poll(NULL, 0, 1);
}

/* Calls what POSIX allows in a handler only. The handler stays while it runs, so that a fault of a second thread
 * does not end the process in between. */
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
    raise(number); /* as it would have ended, with a core where the system keeps one */
}

/* Only where nobody else has: sanitizers tell of a fault by handlers of their own. */
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

/* LLVM, in PoCL and Mesa, has handlers that remove its own files and put back what was there before. A fault then comes
 * again and meets this one; an abort does not. So this one goes first and calls LLVM's. One with SA_SIGINFO is a
 * sanitizer's or a run time's, which knows better. */
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

/* Nobody tells when a driver starts LLVM, so the thread looks now and then. */
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
        if (!stopping && !sigismember(&guard->ignored, number))
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
        /* nohup and a shell's & ask for a signal to be ignored, and a profiler has a handler: it stays theirs. SIGTERM
         * is waited for all the same, since it ends the guard, and then dropped. */
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

/* The thread is woken by a signal of its own, which the mark tells from one from outside. */
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
