/* Threads that do the same work in parallel. Each has its own number, counted from 0. */
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
    size_t count; /* threads that run */
} camber_threads;

/* Returns how many cores the process may use: those of its affinity, which containers and taskset limit. At least 1. */
size_t camber_cores_count(void);
/* Returns how many cores the quotas of the process's control group and of the groups above it pay for, which containers
 * set (cpu.max, or cpu.cfs_quota_us of version 1); SIZE_MAX: there is no quota. root is as in control_group.h. */
size_t camber_cores_paid(const char *root);
/* Returns how many threads to use: as many as asked for, or, if asked is 0, one per core that the process may use and
 * that its quota pays for. The result is at least 1 and at most CAMBER_MOST_THREADS. */
size_t camber_threads_count(size_t asked);
/* Starts count threads, each of which calls work(user, number) and ends when work returns. If the system cannot start
 * that many, fewer run. */
void camber_threads_start(camber_threads *threads, size_t count, void (*work)(void *user, size_t number), void *user);
/* Waits until all threads have ended. */
void camber_threads_join(camber_threads *threads);
/* Calls work(user, number) for each number below count, each on its own thread, and waits for all of them. The caller's
 * thread does the work of number 0, and then the work of the numbers for which the system could not start a thread. */
void camber_threads_run(size_t count, void (*work)(void *user, size_t number), void *user);

#endif
