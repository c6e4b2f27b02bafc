/* The progress of long work, as one line of a terminal: what is being done, a bar, counts, the rate and the time left.
 *
 *     drawing tiles   [###############               ]  50 %  1,800 of 3,600 tiles, 210/s, 0:08 left
 *
 * A caller shows it again and again; other lines erase it first. */
#ifndef CAMBER_CLI_PROGRESS_H
#define CAMBER_CLI_PROGRESS_H

#include "camber.h"

#include <stdbool.h>

/* How far the work was at a time. */
typedef struct camber_progress_mark {
    double ms, fraction;
    uint64_t done;
} camber_progress_mark;

/* Valid when zeroed. */
typedef struct camber_progress_bar {
    char stage[48];
    bool drawn;      /* the line is on the terminal */
    double drawn_ms; /* when it was last drawn */
    /* Rates are measured since `older`, which is 10 to 20 seconds ago, so that work that was found done already
     * (--resume) or that changes its pace is forgotten. */
    camber_progress_mark older, newer;
} camber_progress_bar;

/* Writes the line, which fits into columns - 1 characters. now_ms: of any clock that runs evenly. */
void camber_progress_write(camber_progress_bar *bar, const camber_progress_info *progress, double now_ms,
                           size_t columns, char *line, size_t size);

/* Draws the line on standard error, at most 20 times a second for each stage. */
void camber_progress_show(camber_progress_bar *bar, const camber_progress_info *progress);
/* Erases the line if it is drawn. */
void camber_progress_erase(camber_progress_bar *bar);

#endif
