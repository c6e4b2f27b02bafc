/* Ends a run whose libraries take too much memory or time: a call of GDAL cannot be stopped in another way. */
#ifndef CAMBER_CLI_WATCH_H
#define CAMBER_CLI_WATCH_H

#include "cli/guard.h"
#include "cli/report.h"

/* A zeroed watch does nothing. Once started it watches the memory of the process. Between begin and end it also watches
 * the processor time that the reading thread takes from one beat to the next. */
typedef struct camber_watch {
    camber_guard *guard;
    camber_report *report;
    camber_budget *budget;
    const char *path; /* the file that is being read. NULL: none */
    clockid_t clock;  /* of the thread that reads */
    double allowed_s, beat_s;
} camber_watch;

void camber_watch_start(camber_watch *watch, camber_guard *guard, camber_report *report, camber_budget *budget);
/* Call it before the budget is destroyed. */
void camber_watch_stop(camber_watch *watch);
/* Tells that this thread starts to read a file. */
void camber_watch_begin(camber_watch *watch, const char *path);
void camber_watch_beat(camber_watch *watch);
void camber_watch_end(camber_watch *watch);
#endif
