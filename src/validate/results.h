/* Results of checks: a list that grows as checks end, in named groups. Whoever prints them is told of each check and of
 * each group by a callback. */
#ifndef CAMBER_VALIDATE_RESULTS_H
#define CAMBER_VALIDATE_RESULTS_H

#include <stdbool.h>
#include <stddef.h>

#if defined(__GNUC__)
#define CAMBER_RESULTS_FORMAT(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define CAMBER_RESULTS_FORMAT(format_index, first)
#endif

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
    char *picture;          /* the file that shows it; the results free it. NULL: none */
} camber_finding;

/* Bounds that pixels are held to, over those that an edge crosses. */
typedef struct camber_pixel_bounds {
    double mean;             /* in 255ths */
    double past_16, past_64; /* share of pixels that may differ by more */
} camber_pixel_bounds;

/* How far pixels are from the truth. */
typedef struct camber_pixel_error {
    camber_pixel_bounds of;
    size_t windows, pixels;
    int max;
} camber_pixel_error;

typedef struct camber_check {
    char name[512];
    const char *device, *backend; /* live as long as the results. backend NULL: none took part */
    camber_result result;
    char reason[512]; /* of a skip */
    double start_ms, ms;
    bool has_error; /* pixels were measured, and held against most */
    camber_pixel_error error;
    camber_pixel_bounds most;
    camber_finding finding;
} camber_check;

typedef struct camber_results camber_results;

/* Whom the results tell. Valid when zeroed: nobody. */
typedef struct camber_results_listener {
    /* A check has ended; number counts from 1. */
    void (*check)(void *user, const camber_check *check, size_t number);
    /* A group has ended that has checks: those from group_first on. */
    void (*group)(void *user, const camber_results *results);
    void *user;
} camber_results_listener;

struct camber_results {
    camber_results_listener listener;
    const char *only;   /* part of the names of the groups that are wanted. NULL: all are */
    size_t wanted;      /* groups so far */
    char group[256];    /* name of the group under way; "": none is open */
    size_t group_first; /* its first check */
    camber_check *list; /* count */
    size_t count, capacity, failed, skipped;
    bool full; /* memory ran out: the list is not whole */
};

/* A value as people read it: whole numbers to the last digit, floats so that they can be told apart. */
typedef struct camber_value_text {
    char text[32];
} camber_value_text;

camber_value_text camber_value_print(double value);

/* Ends the group before it: what is added from now on belongs to this one. Whether it is wanted. */
bool camber_results_group(camber_results *results, const char *format, ...) CAMBER_RESULTS_FORMAT(2, 3);
/* Ends the last group. */
void camber_results_end(camber_results *results);
/* Starts a check on a device and a back end, NULL where there is none: its clock and its name. */
camber_check camber_check_start(const char *device, const char *backend, const char *format, ...)
    CAMBER_RESULTS_FORMAT(3, 4);
/* Adds what came of a check. Takes over the finding's picture. */
void camber_results_add(camber_results *results, const camber_check *check);
/* Adds a check that cannot be made here. */
void camber_results_skip(camber_results *results, camber_check check, const char *reason);
void camber_results_close(camber_results *results);

#endif
