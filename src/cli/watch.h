/* Ends a run whose libraries take more than it may have: within a call of GDAL's there is no other way. */
#ifndef CAMBER_CLI_WATCH_H
#define CAMBER_CLI_WATCH_H

#include "cli/guard.h"
#include "cli/report.h"

/* Zeroed it watches nothing; started, what the process holds, and between begin and end the processor time that the
 * reading thread takes from one beat to the next. */
typedef struct camber_watch {
    camber_guard *guard;
    camber_report *report;
    camber_budget *budget;
    const char *path; /* that is read. NULL: nothing is */
    clockid_t clock;  /* of the thread that reads */
    double allowed_s, beat_s;
} camber_watch;

void camber_watch_start(camber_watch *watch, camber_guard *guard, camber_report *report, camber_budget *budget);
/* Before the budget goes. */
void camber_watch_stop(camber_watch *watch);
/* This thread reads a file from here on. */
void camber_watch_begin(camber_watch *watch, const char *path);
void camber_watch_beat(camber_watch *watch);
void camber_watch_end(camber_watch *watch);
#endif
