/* Results of checks: a list in named groups, which grows as checks end. Callbacks report each check and each group to
 * the code that prints them. */
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

/* The first failure of a check. */
typedef struct camber_finding {
    const char *stage;      /* classify, scan, emit, ... */
    bool has_point;         /* polyline and point are known */
    size_t polyline, point; /* as in camber_point_stages */
    double x, y;            /* px */
    const char *field;      /* name of the value that was compared */
    double got, expected;   /* both values */
    char what[256];         /* a description in one line */
    char *picture;          /* path of an image that shows it; freed by the results. NULL: none */
} camber_finding;

/* Bounds for the errors of pixels, over the pixels that an edge crosses. */
typedef struct camber_pixel_bounds {
    double mean;             /* in 255ths */
    double past_16, past_64; /* shares of pixels that may differ by more than 16, and by more than 64 */
} camber_pixel_bounds;

/* Measured errors of pixels. */
typedef struct camber_pixel_error {
    camber_pixel_bounds of;
    size_t windows, pixels;
    int max;
} camber_pixel_error;

typedef struct camber_check {
    char name[512];
    const char *device, *backend; /* must live as long as the results. backend NULL: none was involved */
    camber_result result;
    char reason[512]; /* why it was skipped */
    double start_ms, ms;
    bool has_error; /* pixels were measured and compared with most */
    camber_pixel_error error;
    camber_pixel_bounds most;
    camber_finding finding;
} camber_check;

typedef struct camber_results camber_results;

/* Receives results. Valid when zeroed. */
typedef struct camber_results_listener {
    /* Called when a check has ended; number counts from 1. */
    void (*check)(void *user, const camber_check *check, size_t number);
    /* Called when a group with checks has ended; they begin at group_first. */
    void (*group)(void *user, const camber_results *results);
    void *user;
} camber_results_listener;

struct camber_results {
    camber_results_listener listener;
    const char *only;   /* only groups whose name contains this text are run; NULL: all */
    size_t wanted;      /* number of groups so far that are run */
    char group[256];    /* name of the current group; "": none is open */
    size_t group_first; /* index of its first check */
    camber_check *list; /* count of them */
    size_t count, capacity, failed, skipped;
    bool full; /* memory is exhausted, so the list is incomplete */
};

/* A value as text: whole numbers exactly, floats with enough digits to distinguish them. */
typedef struct camber_value_text {
    char text[32];
} camber_value_text;

camber_value_text camber_value_print(double value);

/* Ends the current group and starts a new one, to which the next checks belong. Returns whether it is to be run. */
bool camber_results_group(camber_results *results, const char *format, ...) CAMBER_RESULTS_FORMAT(2, 3);
/* Ends the last group. */
void camber_results_end(camber_results *results);
/* Starts a check's clock and sets its name. device and backend: NULL if none is involved. */
camber_check camber_check_start(const char *device, const char *backend, const char *format, ...)
    CAMBER_RESULTS_FORMAT(3, 4);
/* Adds the result of a check. Takes ownership of the finding's picture. */
void camber_results_add(camber_results *results, const camber_check *check);
/* Adds a check that cannot be run here. */
void camber_results_skip(camber_results *results, camber_check check, const char *reason);
void camber_results_close(camber_results *results);

#endif
