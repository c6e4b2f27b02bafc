/* How many threads are used, and starting them.
 *
 * Input: the process's affinity, the CPU quotas of its control groups, and what the caller asks for. Output: a count,
 * and threads with numbers. Main idea: whoever cannot get as many threads as wanted does the rest of the work itself.
 */
#define _GNU_SOURCE /* sched_getaffinity */

#include "base/threads.h"

#include "base/control_group.h"

#include <sched.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <unistd.h>

size_t camber_cores_count(void) {
#ifdef __linux__
    cpu_set_t cores; /* fails on machines with more than CPU_SETSIZE of them */
    if (sched_getaffinity(0, sizeof cores, &cores) == 0)
        return (size_t)CPU_COUNT(&cores);
#endif
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online > 0 ? (size_t)online : 1;
}

/* Reads a file of a control group, which has one or two numbers; returns how many. */
static int read_numbers(const char *folder, const char *name, long long *first, long long *second) {
    char path[4200];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "re");
    const int count = file ? fscanf(file, "%lld %lld", first, second) : 0;
    if (file)
        fclose(file);
    return count;
}

/* Lowers *least to the cores that a control group's quota pays for, rounded up. Without a quota, version 2 says "max",
 * and version 1 -1. */
static void look_at_quota(void *least, const char *folder) {
    long long quota = 0, period = 0, none;
    size_t *cores = least;
    const bool is_told = read_numbers(folder, "cpu.max", &quota, &period) == 2 ||
                         (read_numbers(folder, "cpu.cfs_quota_us", &quota, &none) == 1 &&
                          read_numbers(folder, "cpu.cfs_period_us", &period, &none) == 1);
    if (!is_told || quota <= 0 || period <= 0)
        return;
    const unsigned long long paid = (unsigned long long)(quota / period + (quota % period != 0));
    *cores = paid < *cores ? (size_t)paid : *cores;
}

size_t camber_cores_paid(const char *root) {
    size_t least = SIZE_MAX;
    camber_control_group_visit(root, "cpu", look_at_quota, &least);
    return least;
}

/* With more threads than the quota pays for, the kernel would stop all of them in the middle of a launch, until the
 * next period. */
static size_t usable_cores(void) {
    const size_t cores = camber_cores_count(), paid = camber_cores_paid("");
    return cores < paid ? cores : paid;
}

size_t camber_threads_count(size_t asked) {
    const size_t wanted = asked ? asked : usable_cores();
    return wanted < CAMBER_MOST_THREADS ? wanted : CAMBER_MOST_THREADS;
}

static void *run_one(void *user) {
    const camber_thread *self = user;
    self->work(self->user, self->number);
    return NULL;
}

/* Starts the threads with the numbers from first to count - 1. */
static void start_from(camber_threads *threads, size_t first, size_t count, void (*work)(void *user, size_t number),
                       void *user) {
    threads->count = 0;
    for (size_t number = first; number < count && threads->count < CAMBER_MOST_THREADS; number++) {
        camber_thread *made = threads->threads + threads->count;
        *made = (camber_thread){.work = work, .user = user, .number = number};
        if (pthread_create(&made->id, NULL, run_one, made) != 0)
            return;
        threads->count++;
    }
}

void camber_threads_start(camber_threads *threads, size_t count, void (*work)(void *user, size_t number), void *user) {
    start_from(threads, 0, count, work, user);
}

void camber_threads_join(camber_threads *threads) {
    for (size_t i = 0; i < threads->count; i++)
        pthread_join(threads->threads[i].id, NULL);
    threads->count = 0;
}

void camber_threads_run(size_t count, void (*work)(void *user, size_t number), void *user) {
    camber_threads threads;
    start_from(&threads, 1, count, work, user);
    work(user, 0);
    for (size_t number = 1 + threads.count; number < count; number++)
        work(user, number);
    camber_threads_join(&threads);
}
