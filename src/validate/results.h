/* What the checks of validate found: TAP as they or their groups end, JSON at the end, JUnit in junit.c. */
#ifndef CAMBER_VALIDATE_RESULTS_H
#define CAMBER_VALIDATE_RESULTS_H

#include "cli/report.h"

typedef enum camber_result {
    CAMBER_RESULT_PASSED,
    CAMBER_RESULT_FAILED,
    CAMBER_RESULT_SKIPPED,
} camber_result;

/* Where a check failed first. */
typedef struct camber_finding {
    const char *stage;      /* classify, scan, emit, ... */
    bool has_point;         /* polyline and point are known */
    size_t polyline, point; /* as in camber_point_stages */
    double x, y;            /* px */
    const char *field;      /* of what was compared */
    double got, expected;   /* its values */
    char what[256];         /* all of it in one line */
    char *picture;          /* the file that shows it; freed by the verdicts. NULL: none */
} camber_finding;

/* What pixels are held to, over those that an edge crosses. */
typedef struct camber_pixel_bounds {
    double mean;             /* in 255ths */
    double past_16, past_64; /* share of pixels that may differ by more */
} camber_pixel_bounds;

/* How far they are from the truth. */
typedef struct camber_pixel_error {
    camber_pixel_bounds of;
    size_t windows, pixels;
    int max;
} camber_pixel_error;

typedef struct camber_check {
    char name[512];
    const char *device, *backend; /* live as long as the verdicts. backend NULL: none took part */
    camber_result verdict;
    char reason[512]; /* of a skip */
    double start_ms, ms;
    bool has_error; /* pixels were measured, and held against most */
    camber_pixel_error error;
    camber_pixel_bounds most;
    camber_finding finding;
} camber_check;

/* A value as people read it: whole numbers to the last digit, floats so that they can be told apart. */
typedef struct camber_value_text {
    char text[32];
} camber_value_text;

camber_value_text camber_value_print(double value);

/* Bytes of the character at text, as reports may have it: UTF-8 that XML 1.0 allows. 0: it is none, and '?' stands for
 * its first byte. */
size_t camber_character_size(const char *character);

typedef struct camber_results {
    camber_report *report;
    bool tap; /* prints what comes of them: a line a group, or with each a line a check */
    bool each;
    char group[256]; /* of the checks from group_first on; "": none is open */
    size_t group_first, group_count;
    camber_check *list; /* count */
    size_t count, capacity, failed, skipped;
    bool full; /* of memory: the list is not whole */
} camber_results;

void camber_results_open(camber_results *verdicts, camber_report *report, bool tap, bool each);
/* What is added from now on is this group's. */
void camber_results_group(camber_results *verdicts, const char *format, ...) CAMBER_PRINTF(2, 3);
/* Starts a check on a device and a back end, NULL where there is none: its clock and its name. */
camber_check camber_check_start(const char *device, const char *backend, const char *format, ...) CAMBER_PRINTF(3, 4);
/* Adds what came of it. Takes over the finding's picture. */
void camber_results_add(camber_results *verdicts, const camber_check *check);
/* A check that cannot be made here. */
void camber_results_skip(camber_results *verdicts, camber_check check, const char *reason);
/* Ends the last group. TAP's word for an end before the last check. */
void camber_results_bail(camber_results *verdicts);
/* Ends the last group. TAP's plan, or JSON. Returns an exit status, its line printed; CAMBER_EXIT_CHECK where a check
 * failed. */
int camber_results_print(camber_results *verdicts);
void camber_results_close(camber_results *verdicts);

#endif
