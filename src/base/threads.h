/* Threads that do the same work side by side. Each is called with a number of its own, from 0 on. */
#ifndef CAMBER_BASE_THREADS_H
#define CAMBER_BASE_THREADS_H

#include <pthread.h>
#include <stddef.h>

enum { CAMBER_MOST_THREADS = 256 };

typedef struct camber_thread {
    pthread_t id;
    void (*work)(void *user, size_t number);
    void *user;
    size_t number;
} camber_thread;

typedef struct camber_threads {
    camber_thread threads[CAMBER_MOST_THREADS];
    size_t count; /* that run */
} camber_threads;

/* The number of threads to use: the one asked for; 0: one a core. It is at least 1 and at most CAMBER_MOST_THREADS. */
size_t camber_threads_count(size_t asked);
/* Starts threads, which call work(user, number). If the system has no more, fewer than count run. They end when work
 * returns. */
void camber_threads_start(camber_threads *threads, size_t count, void (*work)(void *user, size_t number), void *user);
/* Waits until all have ended. */
void camber_threads_join(camber_threads *threads);
/* Calls work(user, number) for each number below count, on as many threads, and waits for all. Number 0 works on the
 * caller's thread; so do, after it, those for which the system has no thread. */
void camber_threads_run(size_t count, void (*work)(void *user, size_t number), void *user);

#endif
