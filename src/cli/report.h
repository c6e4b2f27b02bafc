/* Messages of the tool: errors, warnings, progress bars, JSON. */
#ifndef CAMBER_CLI_REPORT_H
#define CAMBER_CLI_REPORT_H

#include "base/clock.h"
#include "cli/figures.h"
#include "cli/options.h"
#include "cli/progress.h"

#include <jansson.h>

#if defined(__GNUC__)
#define CAMBER_PRINTF(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define CAMBER_PRINTF(format_index, first)
#endif

typedef struct camber_report {
    bool quiet, verbose, json;
    bool bars;      /* standard error is a terminal, and the user wants progress bars */
    bool has_steps; /* the bar shows the verb's steps, and not what the library does during each of them */
    camber_progress_bar bar;
    bool terminal;      /* standard error is a terminal, and --quiet is not given */
    bool colors;        /* standard error is a terminal that shows colours, and NO_COLOR is not set */
    bool said_compiles; /* the message about a slow first compilation has been printed */
    const char *spool;  /* path of the copy of standard input, which messages call "standard input"; NULL: none */
    bool sealed;        /* the first failure has been reported; errors that follow from it are not printed */
    bool keeps;         /* failures are stored in error instead of being printed */
    char error[4096];   /* the library's last error message, which explains the status that a call returns */
} camber_report;

void camber_report_open(camber_report *report, const camber_options *options);

/* Callbacks of a context; user is the report. An error is stored until camber_report_status, because an error that the
 * library has recovered from is not an error of the tool. */
void camber_report_log(void *user, camber_log_level level, const char *message);
void camber_report_progress(void *user, const camber_progress_info *progress);
/* Shows the progress of a step of the tool, as camber_progress_fn: total 0: how many units there are is not known; unit
 * NULL: nothing is counted. */
void camber_report_step(camber_report *report, const char *stage, const char *unit, uint64_t done, uint64_t total);
void camber_report_erase_bar(camber_report *report);

/* Prints one line "camber: ..." on standard error and returns exit_status. */
int camber_report_fail(camber_report *report, int exit_status, const char *format, ...) CAMBER_PRINTF(3, 4);
/* Prints the message of a status; returns its exit status, 0 for CAMBER_OK. */
int camber_report_status(camber_report *report, camber_status status);
/* Reports that standard input cannot be read, for the reason in errno. Returns the exit status. */
int camber_report_input(camber_report *report, int cause);
void camber_report_warn(camber_report *report, const char *format, ...) CAMBER_PRINTF(2, 3);

/* Prints a line of text for people on standard error, unless --quiet is given. */
void camber_report_say(camber_report *report, const char *format, ...) CAMBER_PRINTF(2, 3);

/* Prints the last line of a verb, "OUT: WHAT, SIZE, TIME", unless --quiet or --json is given. size_bytes 0: without a
 * size. */
void camber_report_done(camber_report *report, const char *out, uint64_t size_bytes, double ms, const char *format, ...)
    CAMBER_PRINTF(5, 6);

/* Returns the plural ending of a noun: "s", or "" for a count of 1. */
const char *camber_plural(size_t count);

/* A JSON string; bytes that are not UTF-8 become '?'. */
json_t *camber_json_text(const char *text);
json_t *camber_json_count(size_t count);
/* Milliseconds, rounded to the microsecond. */
json_t *camber_json_ms(double milliseconds);
/* Prints the object on standard output and releases it. Returns CAMBER_EXIT_DONE, CAMBER_EXIT_INTERNAL (object is
 * NULL or incomplete) or CAMBER_EXIT_IO. */
int camber_report_json(camber_report *report, json_t *object);
/* Flushes standard output. Returns CAMBER_EXIT_IO if it could not be written. */
int camber_report_flush(camber_report *report);

/* Returns the peak memory of the process. */
size_t camber_peak_rss_bytes(void);

#endif
