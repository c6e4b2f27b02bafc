/* Results of validate as text: TAP when checks or their groups end, JSON at the end, JUnit XML in a file. */
#ifndef CAMBER_CLI_RESULTS_TEXT_H
#define CAMBER_CLI_RESULTS_TEXT_H

#include "cli/output.h"
#include "validate/results.h"

/* Returns the number of bytes of the character at `character`, if it is UTF-8 that XML 1.0 allows. Returns 0 if not;
 * then '?' replaces its first byte. */
size_t camber_character_size(const char *character);

/* ---- TAP: results_tap.c ---- */

typedef struct camber_tap {
    bool each;             /* one line per check; otherwise one line per group */
    size_t groups;         /* printed so far */
    camber_report *report; /* its progress bar may be on the terminal that the lines go to */
} camber_tap;

/* Prints the first line. */
void camber_tap_open(camber_tap *tap, bool each, camber_report *report);
/* Returns a listener that prints each result at once, so that a reader need not wait for the end. */
camber_results_listener camber_tap_listener(camber_tap *tap);
/* Prints TAP's word for a run that ends before its last check. */
void camber_tap_bail(void);
/* Prints the plan, which ends the text. Returns an exit status; on failure a line has been printed. */
int camber_tap_end(const camber_tap *tap, const camber_results *results, camber_report *report);

/* ---- JSON and JUnit ---- */

/* Returns an exit status; on failure a line has been printed. */
int camber_results_print_json(const camber_results *results, camber_report *report);
/* Writes one suite per device and back end. Returns an exit status; on failure a line has been printed. */
int camber_junit_write(const camber_results *results, camber_output *output);

#endif
