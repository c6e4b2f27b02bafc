/* Results of validate as text: TAP as checks or their groups end, JSON at the end, JUnit's XML in a file. */
#ifndef CAMBER_CLI_RESULTS_TEXT_H
#define CAMBER_CLI_RESULTS_TEXT_H

#include "cli/output.h"
#include "validate/results.h"

/* Bytes of the character at text, as reports may have it: UTF-8 that XML 1.0 allows. 0: it is none, and '?' stands for
 * its first byte. */
size_t camber_character_size(const char *character);

/* ---- TAP: results_tap.c ---- */

typedef struct camber_tap {
    bool each;     /* a line a check, else a line a group */
    size_t groups; /* printed so far */
} camber_tap;

/* Prints the first line. */
void camber_tap_open(camber_tap *tap, bool each);
/* Prints what comes, for whom waits for the first failure. */
camber_results_listener camber_tap_listener(camber_tap *tap);
/* TAP's word for an end before the last check. */
void camber_tap_bail(void);
/* Prints the plan, which ends the text. Returns an exit status, its line printed. */
int camber_tap_end(const camber_tap *tap, const camber_results *results, camber_report *report);

/* ---- JSON and JUnit ---- */

/* Returns an exit status, its line printed. */
int camber_results_print_json(const camber_results *results, camber_report *report);
/* A suite a device and back end; output appears when it is whole. Returns an exit status, its line printed. */
int camber_junit_write(const camber_results *results, camber_output *output);

#endif
