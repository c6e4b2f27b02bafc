/* Ends a run whose libraries take too much memory or time, because a call of GDAL cannot be stopped in another way. */
#ifndef CAMBER_CLI_WATCH_H
#define CAMBER_CLI_WATCH_H

#include "cli/guard.h"
#include "cli/report.h"

/* A zeroed watch does nothing. Once started, it watches the memory of the process. Between begin and end it also
 * watches the processor time that the reading thread takes from one beat to the next. If a watch is started while
 * another one is active, it replaces the other until it is stopped. */
typedef struct camber_watch {
    camber_guard *guard;
    camber_report *report;
    camber_budget *budget;
    /* Called once, with the guard locked, instead of ending the process, if the run can do without what is watched.
     * line contains the reason. NULL: the process ends. */
    void (*give_up)(void *user);
    void *give_up_user;
    char line[512];
    struct camber_watch *before; /* the watch that was active before */
    const char *path;            /* the file that is being read; NULL: none */
    clockid_t clock;             /* of the thread that reads */
    double allowed_s, beat_ms;
} camber_watch;

/* give_up and its user must be set before. */
void camber_watch_start(camber_watch *watch, camber_guard *guard, camber_report *report, camber_budget *budget);
/* Call it before the budget is destroyed. */
void camber_watch_stop(camber_watch *watch);
/* Says that this thread starts reading a file. */
void camber_watch_begin(camber_watch *watch, const char *path);
void camber_watch_beat(camber_watch *watch);
void camber_watch_end(camber_watch *watch);
#endif
