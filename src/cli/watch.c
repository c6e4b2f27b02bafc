/* Ends a run that takes too much memory, or whose reader works too long without a result; or ends only a reading that
 * the run can do without. Libraries such as GDAL cannot be stopped from within a call, so the guard's thread checks
 * periodically and ends the process. The budget counts our own memory; this file checks the memory of the whole
 * process. */
#define _GNU_SOURCE /* pthread_getcpuclockid */

#include "cli/watch.h"

#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

/* Memory of OpenCL's compiler, GDAL and their caches. */
static const uint64_t LIBRARIES_BYTES = 512 << 20;
/* A parser takes half a minute for a gigabyte of GeoJSON and reports nothing until it is done. */
static const double READING_S = 6, READING_S_A_MB = 1, READING_S_UNKNOWN = 600;

/* The guard's lock protects the fields that both threads use. */
static void lock(camber_watch *watch) {
    camber_guard_lock(watch->guard);
}

static void unlock(camber_watch *watch) {
    camber_guard_unlock(watch->guard);
}

/* ---- Checking ---- */

static uint64_t resident_bytes(void) {
    unsigned long long all, resident = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (file && fscanf(file, "%llu %llu", &all, &resident) != 2)
        resident = 0;
    if (file)
        fclose(file);
    return resident * (uint64_t)sysconf(_SC_PAGESIZE);
}

/* Ends the process, or only what is being watched. */
static void end(camber_watch *watch, int exit_status) {
    if (!watch->give_up)
        camber_guard_end(watch->guard, camber_report_fail(watch->report, exit_status, "%s", watch->line));
    else
        watch->give_up(watch->give_up_user);
}

/* After a reading has been given up, a library may still hold its memory. At twice the limit the process ends. */
static void look_at_memory(camber_watch *watch) {
    const uint64_t held = resident_bytes();
    if (held <= LIBRARIES_BYTES)
        return;
    const uint64_t most = camber_budget_get_most_bytes(watch->budget);
    const bool given_up = watch->give_up && watch->line[0];
    if ((held - LIBRARIES_BYTES) / (given_up ? 2 : 1) <= most)
        return;
    snprintf(
        watch->line, sizeof watch->line,
        "memory: %.1f MB are in use, libraries included, and %.1f MB are allowed without those; give it less data, "
        "or allow more (--memory)",
        (double)held / 1e6, (double)most / 1e6);
    if (given_up)
        watch->give_up = NULL;
    end(watch, CAMBER_EXIT_INTERNAL);
}

static void look_at_reading(camber_watch *watch) {
    if (!watch->path || watch->line[0] || camber_clock_ms(watch->clock) - watch->beat_ms <= 1e3 * watch->allowed_s)
        return;
    snprintf(watch->line, sizeof watch->line,
             "%.200s: reading it has taken %.0f s and yields nothing more; get the file from a source that you "
             "trust, or convert it (ogr2ogr)",
             watch->path, watch->allowed_s);
    end(watch, CAMBER_EXIT_DATA);
}

static void look(void *watch) {
    camber_watch *self = watch;
    look_at_memory(self);
    look_at_reading(self);
}

/* ---- Starting and stopping ---- */

void camber_watch_start(camber_watch *watch, camber_guard *guard, camber_report *report, camber_budget *budget) {
    camber_guard_lock(guard);
    *watch = (camber_watch){.guard = guard,
                            .report = report,
                            .budget = budget,
                            .give_up = watch->give_up,
                            .give_up_user = watch->give_up_user,
                            .before = guard->look ? guard->look_user : NULL};
    guard->look = look;
    guard->look_user = watch;
    camber_guard_unlock(guard);
}

void camber_watch_stop(camber_watch *watch) {
    if (!watch->guard)
        return;
    lock(watch);
    camber_watch *top = watch->guard->look ? watch->guard->look_user : NULL;
    if (top == watch) {
        watch->guard->look = watch->before ? look : NULL;
        watch->guard->look_user = watch->before;
    }
    for (; top; top = top->before) /* a watch that was started later may already be active */
        if (top->before == watch)
            top->before = watch->before;
    unlock(watch);
}

void camber_watch_begin(camber_watch *watch, const char *path) {
    struct stat about;
    clockid_t clock;
    if (!watch->guard || pthread_getcpuclockid(pthread_self(), &clock) != 0)
        return;
    const bool is_known = stat(path, &about) == 0 && S_ISREG(about.st_mode);
    lock(watch);
    watch->path = path;
    watch->clock = clock;
    watch->allowed_s = is_known ? READING_S + READING_S_A_MB * (double)about.st_size / 1e6 : READING_S_UNKNOWN;
    watch->beat_ms = camber_clock_ms(clock);
    unlock(watch);
}

void camber_watch_beat(camber_watch *watch) {
    if (!watch->guard)
        return;
    lock(watch);
    if (watch->path)
        watch->beat_ms = camber_clock_ms(watch->clock);
    unlock(watch);
}

void camber_watch_end(camber_watch *watch) {
    if (!watch->guard)
        return;
    lock(watch);
    watch->path = NULL;
    unlock(watch);
}
